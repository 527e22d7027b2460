"""One step in time, and the guards in it."""

from typing import NamedTuple

import numpy as np
from reference_models.maximal.compiling import compiled, within
from reference_models.maximal.excitation import ground
from reference_models.maximal.guard_search import SAMPLES, dip
from reference_models.maximal.runge_kutta import ERROR_WEIGHT, MATRIX, NODES, STAGES, WEIGHTS

from .forces import accelerate, powers
from .guards import evaluate
from .scene import WORKS


class Motion(NamedTuple):
    """A motion of the ground, see `ground`."""

    shape: np.ndarray
    across: np.ndarray
    upwards: np.ndarray


class Path(NamedTuple):
    """Arrays of one step: derivatives, states at its ends, and guards."""

    slopes: np.ndarray
    first: np.ndarray
    last: np.ndarray
    new: np.ndarray
    trial: np.ndarray
    scale: np.ndarray  # size of a tolerated error
    guards: np.ndarray
    noise: np.ndarray
    armed: np.ndarray
    samples: np.ndarray


def path_of(states: int, guards: int) -> Path:
    """Return work arrays for a step."""
    vectors = [np.zeros(states) for _ in range(5)]
    return Path(
        np.zeros((STAGES, states)), *vectors, np.zeros(guards), np.zeros(guards),
        np.zeros(guards, dtype=np.bool_), np.zeros((SAMPLES + 1, guards)),
    )  # fmt: skip


@within
def rates(t, z, piece, motion, stack, contact, room, slope):
    """Fill in the derivative of the state: rates, accelerations and the powers of both works."""
    gx, gy = ground(t, piece, motion.shape, motion.across, motion.upwards)
    accelerate(z, gx, gy, stack, contact, room)
    count = stack.inverse.size
    for j in range(count):
        slope[j], slope[count + j] = z[count + j], room.out[j]
    slope[2 * count], slope[2 * count + 1] = powers(z, gx, gy, stack, contact, room)


@compiled
def step(t, h, z, piece, motion, stack, contact, room, path, new):
    """Take one step; give the greatest difference of both orders over `path.scale`.

    `path.first` is the derivative at the start; `new` is filled with the state at the end.
    """
    slopes = path.slopes
    slopes[0] = path.first
    for i in range(1, STAGES):
        for j in range(z.size):
            total = 0.0
            for k in range(i):
                total += MATRIX[i, k] * slopes[k, j]
            new[j] = z[j] + h * total
        rates(t + NODES[i] * h, new, piece, motion, stack, contact, room, slopes[i])
    worst = 0.0
    for j in range(z.size):
        total = 0.0
        for k in range(5, STAGES):
            total += WEIGHTS[k] * slopes[k, j]
        new[j] = z[j] + h * total
        if j < z.size - WORKS:
            off = slopes[0, j] + slopes[10, j] - slopes[11, j] - slopes[12, j]
            worst = max(worst, abs(h * ERROR_WEIGHT * off) / path.scale[j])
    return worst


@within
def sample_guards(t, h, z, piece, motion, stack, contact, room, path):
    """Fill in the guards at equally spaced times of a step.

    In between, positions are quintics through positions, rates and accelerations of both ends,
    rates are cubics through rates and accelerations. They only locate candidates, which are
    then evaluated by separate steps.
    """
    new, first, last, inner = path.new, path.first, path.last, path.trial
    count = stack.inverse.size
    for m in range(SAMPLES + 1):
        u = m / SAMPLES
        for j in range(count):
            v = count + j
            r = new[j] - z[j] - h * z[v] - 0.5 * h * h * first[v]
            d, a0, a1 = new[v] - z[v], h * first[v], h * last[v]
            q, w = h * (d - a0), h * (a1 - a0)
            c3 = 10.0 * r - 4.0 * q + 0.5 * w
            c4 = -15.0 * r + 7.0 * q - w
            c5 = 6.0 * r - 3.0 * q + 0.5 * w
            inner[j] = z[j] + u * h * (z[v] + 0.5 * u * a0) + u * u * u * (c3 + u * (c4 + u * c5))
            inner[v] = z[v] + u * (a0 + u * (3.0 * d - 2.0 * a0 - a1 + u * (a0 + a1 - 2.0 * d)))
        if m == SAMPLES:
            inner[:] = new
        gx, gy = ground(t + u * h, piece, motion.shape, motion.across, motion.upwards)
        evaluate(inner, gx, gy, stack, contact, room, path.samples[m])


@compiled
def value_at(x, slot, t, z, piece, motion, stack, contact, room, path):
    """Return a guard after a step of length x."""
    step(t, x, z, piece, motion, stack, contact, room, path, path.trial)
    gx, gy = ground(t + x, piece, motion.shape, motion.across, motion.upwards)
    evaluate(path.trial, gx, gy, stack, contact, room, path.guards)
    return path.guards[slot]


@within
def may_fall(path):
    """Tell whether a guard is negative at a sample, or may be negative between two."""
    samples, noise = path.samples, path.noise
    for k in range(noise.size):
        for m in range(SAMPLES + 1):
            if samples[m, k] < 0.0 or dip(samples, k, m, 0)[1] > 0:
                return True
            if not path.armed[k] and samples[m, k] <= noise[k]:
                return True
    return False
