"""Modes of small motion about rest: frequencies, damping ratios and shapes."""

import itertools
import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rockframe.signals.arrays import Array


@dataclass(frozen=True)
class SmallMotion:
    """Linear equations of small motion M q'' + C q' + K q = 0."""

    coordinates: tuple[str, ...]  # names of the coordinates
    mass: Array  # SI units
    damping: Array
    stiffness: Array
    # of a stack, whose coordinates are those of these bodies in turn, counted from 1 at the top
    bodies: tuple[int, ...] = field(default=(), kw_only=True)


@dataclass(frozen=True)
class VibrationMode:
    """A mode: frequency without damping, damping ratio, and shape.

    The frequency and the damping ratio of a mode that does not return are NaN.
    """

    angular_frequency: float
    damping_ratio: float
    shape: Array


def modes_of(motion: SmallMotion) -> list[VibrationMode]:
    """Give the modes, from slow to fast."""
    size = len(motion.coordinates)
    transition = np.block(
        [
            [np.zeros((size, size)), np.eye(size)],
            [
                -np.linalg.solve(motion.mass, motion.stiffness),
                -np.linalg.solve(motion.mass, motion.damping),
            ],
        ]
    )
    rates, vectors = np.linalg.eig(transition)
    modes: list[VibrationMode] = []
    real: list[int] = []
    for i, rate in enumerate(rates):
        if rate.imag > 0.0:
            frequency = abs(rate)
            modes.append(
                VibrationMode(frequency, -rate.real / frequency, _shape(vectors[:size, i]))
            )
        elif rate.imag == 0.0:
            real.append(i)
    real.sort(key=lambda i: float(rates[i].real), reverse=True)
    for first, second in _pairs(real, np.real(vectors[:size]), motion.mass):
        shape = _shape(vectors[:size, first])
        slow, quick = float(rates[first].real), float(rates[second].real)
        if slow * quick <= 0.0:
            modes.append(VibrationMode(math.nan, math.nan, shape))
            continue
        frequency = math.sqrt(slow * quick)
        modes.append(VibrationMode(frequency, -0.5 * (slow + quick) / frequency, shape))
    return sorted(modes, key=lambda mode: (not math.isnan(mode.angular_frequency),
                                           mode.angular_frequency))  # fmt: skip


def _pairs(real: list[int], shapes: Array, mass: Array) -> list[tuple[int, int]]:
    """Join real rates whose shapes are most alike, in the measure of the mass."""
    scaled = {i: shapes[:, i] / math.sqrt(shapes[:, i] @ mass @ shapes[:, i]) for i in real}
    alike = sorted(
        itertools.combinations(real, 2),
        key=lambda pair: -abs(float(scaled[pair[0]] @ mass @ scaled[pair[1]])),
    )
    free = set(real)
    pairs: list[tuple[int, int]] = []
    for pair in alike:
        if free.issuperset(pair):
            free.difference_update(pair)
            pairs.append(pair)
    return pairs


def _shape(vector: NDArray[np.complex128]) -> Array:
    """Give the real part of a shape, turned so that its largest entry is 1."""
    return np.real(vector / vector[np.argmax(np.abs(vector))])
