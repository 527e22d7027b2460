"""The same oscillator under both horizontal components, looked at in every direction.

The equations are linear: the displacement in a direction is the sum of those of the components,
times cosine and sine, :eq:`eq-rotated-displacement`. So both are followed once, whatever the
number of directions. Compiled where numba is installed.
"""

import numpy as np

from rockframe.compiled import Matrix, Vector, entry, inlined, kernel
from rockframe.signals.oscillator import (
    STEPS_PER_PERIOD,
    fill_step,
    shift_piece,
    turning_value,
)


@kernel
def raise_peaks(
    directions: Matrix,
    start: Vector,
    end: Vector,
    most: Vector,
) -> float:
    """Raise the peaks in all directions by those of one step.

    Parameters
    ----------
    directions : ndarray, shape (d, 2)
        Cosines and sines.
    start, end : ndarray, shape (6,)
        Displacement u, velocity V and acceleration W of the first component, then of the
        second, at both ends of the step [m].
    most : ndarray, shape (d,)
        Greatest absolute displacement so far; raised [m].

    Returns
    -------
    float
        The least of these.
    """
    least = np.inf
    for d in range(directions.shape[0]):
        c, s = directions[d, 0], directions[d, 1]
        u, v = c * end[0] + s * end[3], c * end[1] + s * end[4]
        # a turn inside the step lies no higher than the end and the slope there
        if abs(u) + abs(v) > most[d]:
            most[d] = max(most[d], abs(u))
            before = c * start[1] + s * start[4]
            if before * v < 0.0:
                inside = turning_value(
                    c * start[0] + s * start[3],
                    before,
                    c * start[2] + s * start[5],
                    u,
                    v,
                    c * end[2] + s * end[5],
                )
                most[d] = max(most[d], abs(inside))
        least = min(least, most[d])
    return least


@inlined
def follow_component(
    pieces: Matrix,
    row: int,
    part: int,
    parts: int,
    force: float,
    kappa: float,
    damping: float,
    step: Matrix,
    shifted: Vector,
    place: int,
    start: Vector,
    end: Vector,
) -> None:
    """Follow the oscillator under one component over one step.

    Parameters
    ----------
    pieces : ndarray, shape (n, m)
        Acceleration of the ground in every interval [m s^-2].
    row, part, parts : int
        Interval, and which of how many equal parts of it.
    force : float
        h^2, by which the acceleration becomes a force [s^2].
    kappa, damping : float
        2 pi h/T and the damping ratio [1].
    step : ndarray, shape (2, 2 + m)
        As filled by :func:`fill_step`.
    shifted : ndarray, shape (m,)
        Scratch.
    place : int
        0 for the first component, 3 for the second.
    start, end : ndarray, shape (6,)
        State before, whose accelerations are filled, and after [m].
    """
    u, v = start[place], start[place + 1]
    drag, stiffness = 2.0 * damping * kappa, kappa * kappa
    next_u, next_v = step[0, 0] * u + step[0, 1] * v, step[1, 0] * u + step[1, 1] * v
    if pieces.shape[1] == 2:
        slope = pieces[row, 1] / parts
        before = pieces[row, 0] + part * slope
        ground = before + slope
        next_u += force * (step[0, 2] * before + step[0, 3] * slope)
        next_v += force * (step[1, 2] * before + step[1, 3] * slope)
    else:
        shift_piece(pieces, row, part, parts, shifted)
        before, ground = shifted[0], 0.0
        for j in range(pieces.shape[1]):
            ground += shifted[j]
            next_u += force * step[0, 2 + j] * shifted[j]
            next_v += force * step[1, 2 + j] * shifted[j]
    start[place + 2] = -drag * v - stiffness * u - force * before
    end[place], end[place + 1] = next_u, next_v
    end[place + 2] = -drag * next_v - stiffness * next_u - force * ground


@kernel
def outermost(
    first: Matrix,
    second: Matrix,
    parts: int,
    force: float,
    kappa: float,
    damping: float,
    step: Matrix,
    shifted: Vector,
    start: Vector,
    end: Vector,
    few: Matrix,
    reached: Matrix,
) -> None:
    """Find the points that the oscillator reaches furthest out in a few directions.

    What it reaches there bounds its peaks in all directions from below, so that most steps
    need not be looked at in every direction.

    Parameters
    ----------
    first, second, parts, force, kappa, damping, step, shifted, start, end
        As for :func:`march_pair`.
    few : ndarray, shape (f, 2)
        Cosines and sines of the directions.
    reached : ndarray, shape (f, 3)
        How far it comes, and both displacements there; raised [m].
    """
    least = 0.0
    for row in range(first.shape[0]):
        for part in range(parts):
            follow_component(
                first, row, part, parts, force, kappa, damping, step, shifted, 0, start, end
            )
            follow_component(
                second, row, part, parts, force, kappa, damping, step, shifted, 3, start, end
            )
            if end[0] * end[0] + end[3] * end[3] > least * least:
                least = np.inf
                for d in range(few.shape[0]):
                    far = abs(few[d, 0] * end[0] + few[d, 1] * end[3])
                    if far > reached[d, 0]:
                        reached[d, 0], reached[d, 1], reached[d, 2] = far, end[0], end[3]
                    least = min(least, reached[d, 0])
            for j in range(6):
                start[j] = end[j]


@kernel
def march_pair(
    first: Matrix,
    second: Matrix,
    parts: int,
    force: float,
    kappa: float,
    damping: float,
    step: Matrix,
    shifted: Vector,
    start: Vector,
    end: Vector,
    directions: Matrix,
    most: Vector,
) -> None:
    """Follow one oscillator under both components from interval to interval.

    Parameters
    ----------
    first, second : ndarray, shape (n, m)
        Accelerations of the ground in every interval [m s^-2].
    parts, force, kappa, damping, step, shifted
        As for :func:`follow_component`.
    start, end : ndarray, shape (6,)
        State at the start; scratch [m].
    directions : ndarray, shape (d, 2)
        Cosines and sines.
    most : ndarray, shape (d,)
        Greatest absolute displacement in every direction; raised [m].
    """
    least = np.inf
    for d in range(directions.shape[0]):
        least = min(least, most[d])
    for row in range(first.shape[0]):
        for part in range(parts):
            follow_component(
                first, row, part, parts, force, kappa, damping, step, shifted, 0, start, end
            )
            follow_component(
                second, row, part, parts, force, kappa, damping, step, shifted, 3, start, end
            )
            # in no direction is there more than this
            reach = np.sqrt(end[0] * end[0] + end[3] * end[3])
            reach += np.sqrt(end[1] * end[1] + end[4] * end[4])
            if reach > least:
                least = raise_peaks(directions, start, end, most)
            for j in range(6):
                start[j] = end[j]


@entry
def march_pairs(
    first: Matrix,
    second: Matrix,
    still: Matrix,
    time_step: float,
    damping: float,
    periods: Vector,
    directions: Matrix,
    step: Matrix,
    free_step: Matrix,
    shifted: Vector,
    start: Vector,
    end: Vector,
    few: Matrix,
    reached: Matrix,
    most: Vector,
    found: Matrix,
) -> None:
    """Find the peaks of all oscillators in all directions.

    Parameters
    ----------
    first, second : ndarray, shape (n, m)
        Accelerations of the ground in every interval [m s^-2].
    still : ndarray, shape (12, m)
        Zeros: the ground during a period after the motion.
    time_step : float
        Length of an interval [s].
    damping : float
        Damping ratio [1].
    periods : ndarray, shape (k,)
        Periods, greater than zero [s].
    directions : ndarray, shape (d, 2)
        Cosines and sines.
    step, free_step : ndarray, shape (2, 2 + m)
        Scratch.
    shifted : ndarray, shape (m,)
        Scratch.
    start, end : ndarray, shape (6,)
        Scratch.
    few : ndarray, shape (f, 2)
        Some of the directions.
    reached, most : ndarray, shape (f, 3) and (d,)
        Scratch.
    found : ndarray, shape (k, d)
        Filled: greatest relative displacement [m].
    """
    free = 2.0 * np.pi / STEPS_PER_PERIOD
    fill_step(free, damping, free_step)
    for k in range(periods.shape[0]):
        period = periods[k]
        parts = int(np.ceil(STEPS_PER_PERIOD * time_step / period))
        length = time_step / parts
        kappa = 2.0 * np.pi * length / period
        fill_step(kappa, damping, step)
        for j in range(6):
            start[j] = 0.0
        for d in range(few.shape[0]):
            reached[d, 0] = reached[d, 1] = reached[d, 2] = 0.0
        outermost(
            first, second, parts, length * length, kappa, damping, step, shifted, start, end, few,
            reached,
        )  # fmt: skip
        for j in range(6):
            start[j] = 0.0
        for d in range(directions.shape[0]):
            most[d] = 0.0
            for place in range(few.shape[0]):
                far = directions[d, 0] * reached[place, 1] + directions[d, 1] * reached[place, 2]
                most[d] = max(most[d], abs(far))
        march_pair(
            first, second, parts, length * length, kappa, damping, step, shifted, start, end,
            directions, most,
        )  # fmt: skip
        change = period / STEPS_PER_PERIOD / length
        start[1] *= change
        start[4] *= change
        march_pair(
            still, still, 1, 0.0, free, damping, free_step, shifted, start, end, directions, most
        )
        for d in range(directions.shape[0]):
            found[k, d] = most[d]
