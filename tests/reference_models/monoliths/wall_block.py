"""A block before a wall on its left, integrated independently by SciPy's DOP853.

Of unit mass; x right, rotation q >= 0 clockwise about the right corner:

    q'' = -(R/I) [g sin(theta - q) + a(t) cos(theta - q)]

At q = 0 the rate is multiplied by a ratio -1 <= e <= 0. The ground is linear between samples,
and each of its pieces is integrated by itself. Where a bounce would stay below 1e-10 theta and
the ground holds the block, it rests until -a exceeds g tan(theta), found in the linear piece.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp

LEAST = 1e-10


@dataclass
class Run:
    """Rotations at the samples of the ground, times of impacts, and the verdict."""

    rotation: np.ndarray
    impacts: list[float] = field(default_factory=list)
    overturned: bool = False


def simulate(theta, radius, inertia, ratio, samples, step, *, gravity, start=(0.0, 0.0)):
    """Return the run of a block with its wall on the left."""
    count = len(samples)
    run = Run(np.full(count, np.nan))
    state, rocking = np.array(start, dtype=float), any(start)
    run.rotation[0] = state[0]
    lever = radius / inertia
    for k in range(count - 1):
        now, end = k * step, (k + 1) * step
        first, slope = samples[k], (samples[k + 1] - samples[k]) / step

        def ground(t, first=first, slope=slope, begin=now):
            return first + slope * (t - begin)

        def swing(t, q, ground=ground):
            return -lever * (gravity * math.sin(theta - q) + ground(t) * math.cos(theta - q))

        while now < end:
            if not rocking:
                begins = _start(ground, slope, now, end, gravity * math.tan(theta))
                if begins is None:
                    break
                now, state, rocking = begins, np.zeros(2), True
            now, state, struck, fell = _rock(swing, now, end, state, theta, step)
            if fell:
                run.overturned = True
                return run
            if not struck:
                continue
            run.impacts.append(now)
            pull = -swing(now, 0.0)
            state = np.array([0.0, ratio * state[1]])
            if pull >= 0.0 and state[1] ** 2 < 2.0 * LEAST * theta * max(pull, 1e-300):
                rocking, state = False, np.zeros(2)
        run.rotation[k + 1] = state[0]
    return run


def _start(ground, slope, now, end, needed):
    """Return the time at which the ground begins to tip the block within its piece, or None."""
    if -ground(now) > needed * (1.0 + 1e-13):
        return now
    if -ground(end) <= needed:
        return None
    return min(max(now, now + (ground(now) + needed) / -slope), end)


def _rock(swing, now, end, state, theta, step):
    """Integrate until the end of the piece, an impact or overturning."""
    pull = -swing(now, state[0])
    longest = step
    if pull > 0.0:  # steps must be shorter than a bounce
        rise = math.sqrt(state[1] ** 2 + 2.0 * pull * max(state[0], 0.0))
        longest = min(step, 0.3 * (state[1] + rise) / pull)

    longest = max(longest, 1e-12)
    stop = min(end, now + 5.0 * longest)

    def strikes(_, z):
        return z[0]

    def falls(_, z):
        return theta - z[0]

    strikes.terminal = falls.terminal = True
    strikes.direction = falls.direction = -1
    solution = solve_ivp(
        lambda t, z: (z[1], swing(t, z[0])), (now, stop), state, method="DOP853", rtol=1e-12,
        atol=1e-15, events=(strikes, falls), max_step=longest,
    )  # fmt: skip
    struck, fell = (len(times) > 0 for times in solution.t_events)
    return solution.t[-1], solution.y[:, -1].copy(), struck, fell
