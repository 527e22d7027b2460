"""The linear oscillator under a ground acceleration that is a polynomial in every step.

All functions here use scaled variables of a step of length h: x = t/h from 0 to 1, displacement
u, velocity V = h du/dt, acceleration W = h^2 d2u/dt2. The equation of the oscillator is then
:eq:`eq-oscillator-step`, with the one parameter kappa = 2 pi h/T. Compiled where numba is
installed.

Under both horizontal components the displacement in a direction is that under the first times the
cosine, plus that under the second times the sine, :eq:`eq-rotated-displacement`: an oscillator is
followed once under each component, whatever the number of directions.

Arguments of the functions, by their names:

``pieces``, ``first``, ``second``
    Ground acceleration in every interval, shape (n, m): of the only, first or second component
    [m s^-2].
``still``
    Zeros, shape (12, m): the ground during a period after the motion.
``row``, ``part``, ``parts``
    An interval, and which of how many equal steps in it.
``force``
    h^2, the factor from a ground acceleration to the scaled force in the equation [s^2].
``kappa``, ``damping``
    2 pi h/T and the damping ratio [1].
``step``, ``free_step``
    Matrices of a step, shape (2, 2 + m), as filled by :func:`fill_step`; `free_step` after the
    motion.
``start``, ``end``
    u, V and W of the first component, then of the second, at both ends of a step, shape (6,) [m].
``directions``, ``few``
    Cosines and sines of all directions, shape (d, 2), and of some, shape (f, 2).
``most``
    Greatest absolute displacement so far in every direction, shape (d,), which is updated [m].
``shifted``
    Scratch, shape (m,).
"""

from typing import Any, Final

import numpy as np

from rockframe.compiled import Matrix, Vector, entry, inlined, kernel

STEPS_PER_PERIOD: Final = 12
"""Least number of steps in a period, for which intervals are split: kappa is at most 0.52."""

TERMS: Final = 24
"""Terms of the power series; 0.52^24/24! is 3e-31."""

QUANTITIES: Final = 3
"""Number of peaks: relative displacement, relative velocity, absolute acceleration."""

_NEWTON_STEPS: Final = 3
_TINY: Final = 1e-300


@kernel
def fill_step(kappa: float, damping: float, step: Matrix) -> None:
    """Compute the matrices of one step, :eq:`eq-step-matrices`, by :eq:`eq-step-series`.

    A column holds u and V at the end: of the first two, for u = 1 and for V = 1 at the start; of
    the others, for the forces h^2 a = x^0, x^1, ...
    """
    for column in range(step.shape[1]):
        term = 1.0 if column == 0 else 0.0
        following = 1.0 if column == 1 else 0.0
        value, slope = term + following, following
        for n in range(TERMS):
            new = -2.0 * damping * kappa * (n + 1) * following - kappa * kappa * term
            if n == column - 2:
                new -= 1.0
            new /= (n + 1) * (n + 2)
            value += new
            slope += (n + 2) * new
            term, following = following, new
        step[0, column], step[1, column] = value, slope


@kernel
def turning_value(
    value: Any, slope: Any, bend: Any, end_value: Any, end_slope: Any, end_bend: Any
) -> Any:
    """Find the extremum inside a step whose slopes differ in sign, :eq:`eq-step-extremum`."""
    rise = end_value - value - slope - 0.5 * bend
    turn = end_slope - slope - bend
    twist = end_bend - bend
    third = 10.0 * rise - 4.0 * turn + 0.5 * twist
    fourth = -15.0 * rise + 7.0 * turn - twist
    fifth = 6.0 * rise - 3.0 * turn + 0.5 * twist
    # the root of the parabola through both slopes and the first bend: that of the chord may be at
    # a bend of zero, where Newton's method leaves the step
    fall = -np.copysign(np.sqrt(np.maximum(0.0, bend * bend - 4.0 * turn * slope)), slope)
    plain = 1.0 * (bend * fall >= 0.0)  # of the two forms of the root that without cancellation
    at = (plain * -2.0 * slope + (1.0 - plain) * (fall - bend)) / (
        plain * (bend + fall) + (1.0 - plain) * 2.0 * turn
    )
    x = np.minimum(1.0, np.maximum(0.0, at))
    for _ in range(_NEWTON_STEPS):
        rate = slope + x * (bend + x * (3.0 * third + x * (4.0 * fourth + x * 5.0 * fifth)))
        change = bend + x * (6.0 * third + x * (12.0 * fourth + x * 20.0 * fifth))
        x = np.minimum(1.0, np.maximum(0.0, x - rate * change / (change * change + _TINY)))
    return value + x * (slope + x * (0.5 * bend + x * (third + x * (fourth + x * fifth))))


@kernel
def bound_of(end_value: Any, end_slope: Any, bend: Any, end_bend: Any) -> Any:
    """Bound the extrema inside a step, between its ends."""
    # half the greatest bend would do if the bend were linear
    return abs(end_value) + abs(end_slope) + np.maximum(abs(bend), abs(end_bend))


@kernel
def shift_piece(pieces: Matrix, row: int, part: int, parts: int, shifted: Vector) -> None:
    """Write the polynomial of an interval as one of the x of a part of it."""
    powers = pieces.shape[1]
    for j in range(powers):
        shifted[j] = pieces[row, j]
    start = part / parts
    for j in range(powers - 1):  # synthetic division: Taylor's expansion about the start
        for k in range(powers - 2, j - 1, -1):
            shifted[k] += start * shifted[k + 1]
    scale = 1.0
    for j in range(powers):
        shifted[j] *= scale
        scale /= parts


@kernel
def march_oscillator(
    pieces: Matrix,
    parts: int,
    force: float,
    kappa: float,
    damping: float,
    step: Matrix,
    shifted: Vector,
    state: Vector,
    peaks: Vector,
) -> None:
    """Follow one oscillator from interval to interval.

    `state`, u and V at the start, becomes that at the end [m]. `peaks`, the greatest absolute u, V
    and 2 xi kappa V + kappa^2 u so far, is updated [m].
    """
    stiffness, drag = kappa * kappa, 2.0 * damping * kappa
    powers = pieces.shape[1]
    uu, uv, u0, u1 = step[0, 0], step[0, 1], force * step[0, 2], force * step[0, 3]
    vu, vv, v0, v1 = step[1, 0], step[1, 1], force * step[1, 2], force * step[1, 3]
    u, v = state[0], state[1]
    pull = drag * v + stiffness * u
    share = 1.0 / parts
    most_u, most_v, most_pull = abs(u), abs(v), abs(pull)
    for row in range(pieces.shape[0]):
        for part in range(parts):
            if powers == 2:
                slope = end_slope = share * pieces[row, 1]
                ground = pieces[row, 0] + part * slope
                end_ground = ground + slope
                next_u = uu * u + uv * v + (u0 * ground + u1 * slope)
                next_v = vu * u + vv * v + (v0 * ground + v1 * slope)
            else:
                shift_piece(pieces, row, part, parts, shifted)
                ground, slope = shifted[0], shifted[1]
                end_ground, end_slope = ground, 0.0
                next_u, next_v = uu * u + uv * v + u0 * ground, vu * u + vv * v + v0 * ground
                for j in range(1, powers):
                    end_ground += shifted[j]
                    end_slope += j * shifted[j]
                    next_u += force * step[0, 2 + j] * shifted[j]
                    next_v += force * step[1, 2 + j] * shifted[j]
            next_pull = drag * next_v + stiffness * next_u
            # both ends from this step's own ground, which may jump between intervals
            w, next_w = -pull - force * ground, -next_pull - force * end_ground
            rate, next_rate = drag * w + stiffness * v, drag * next_w + stiffness * next_v
            most_u = max(most_u, abs(next_u))
            most_v = max(most_v, abs(next_v))
            most_pull = max(most_pull, abs(next_pull))
            if v * next_v < 0.0 and bound_of(next_u, next_v, w, next_w) > most_u:
                most_u = max(most_u, abs(turning_value(u, v, w, next_u, next_v, next_w)))
            jerk, next_jerk = -rate - force * slope, -next_rate - force * end_slope
            if w * next_w < 0.0 and bound_of(next_v, next_w, jerk, next_jerk) > most_v:
                most_v = max(most_v, abs(turning_value(v, w, jerk, next_v, next_w, next_jerk)))
            bend, next_bend = drag * jerk + stiffness * w, drag * next_jerk + stiffness * next_w
            if (
                rate * next_rate < 0.0
                and bound_of(next_pull, next_rate, bend, next_bend) > most_pull
            ):
                inside = turning_value(pull, rate, bend, next_pull, next_rate, next_bend)
                most_pull = max(most_pull, abs(inside))
            u, v, pull = next_u, next_v, next_pull
    state[0], state[1] = u, v
    peaks[0] = max(peaks[0], most_u)
    peaks[1] = max(peaks[1], most_v)
    peaks[2] = max(peaks[2], most_pull)


@kernel
def clear(peaks: Vector) -> None:
    """Set all peaks to zero."""
    for j in range(QUANTITIES):
        peaks[j] = 0.0


@entry
def march_all(
    pieces: Matrix,
    still: Matrix,
    time_step: float,
    damping: float,
    periods: Vector,
    step: Matrix,
    free_step: Matrix,
    shifted: Vector,
    state: Vector,
    peaks: Vector,
    found: Matrix,
) -> None:
    """Find the peaks of all oscillators, during the motion and in the period after it.

    `found`, shape (k, 3), is filled: greatest relative displacement [m], relative velocity
    [m s^-1] and absolute acceleration [m s^-2].
    """
    free = 2.0 * np.pi / STEPS_PER_PERIOD
    fill_step(free, damping, free_step)
    for k in range(periods.shape[0]):
        period = periods[k]
        parts = int(np.ceil(STEPS_PER_PERIOD * time_step / period))
        length, free_length = time_step / parts, period / STEPS_PER_PERIOD
        kappa = 2.0 * np.pi * length / period
        fill_step(kappa, damping, step)
        state[0] = state[1] = 0.0
        clear(peaks)
        march_oscillator(
            pieces, parts, length * length, kappa, damping, step, shifted, state, peaks
        )  # fmt: skip
        for j in range(QUANTITIES):
            found[k, j] = peaks[j] / length**j
        state[1] *= free_length / length
        clear(peaks)
        march_oscillator(still, 1, 0.0, free, damping, free_step, shifted, state, peaks)
        for j in range(QUANTITIES):
            found[k, j] = max(found[k, j], peaks[j] / free_length**j)


@kernel
def raise_peaks(
    directions: Matrix,
    start: Vector,
    end: Vector,
    most: Vector,
) -> float:
    """Update the peaks in all directions by those of one step; give the least peak [m]."""
    least = np.inf
    for d in range(directions.shape[0]):
        c, s = directions[d, 0], directions[d, 1]
        u, v, w = c * end[0] + s * end[3], c * end[1] + s * end[4], c * end[2] + s * end[5]
        most[d] = max(most[d], abs(u))
        before, bend = c * start[1] + s * start[4], c * start[2] + s * start[5]
        if before * v < 0.0 and bound_of(u, v, bend, w) > most[d]:
            inside = turning_value(c * start[0] + s * start[3], before, bend, u, v, w)
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

    `place` is 0 for the first component, 3 for the second; the accelerations of `start` are
    filled too.
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
    """Find the points of the oscillator's path that lie farthest out in a few directions.

    These points bound its peaks in all directions from below, so that most steps need not be
    examined in every direction. `reached`, shape (f, 3), is updated: the distance in each of these
    directions, and both displacements there [m].
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
    """Follow one oscillator under both components from interval to interval."""
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
            # no direction has a larger peak in this step
            bend = start[2] * start[2] + start[5] * start[5]
            reach = np.sqrt(max(bend, end[2] * end[2] + end[5] * end[5]))
            reach += np.sqrt(end[0] * end[0] + end[3] * end[3])
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
    """Find the peaks of all oscillators in all directions, in `found`, shape (k, d) [m]."""
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
