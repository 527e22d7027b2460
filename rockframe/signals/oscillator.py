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
``h_squared``
    h^2, the factor from a ground acceleration to the scaled force in the equation [s^2].
``kappa``, ``damping``
    2 pi h/T and the damping ratio [1].
``step``, ``free_step``
    Matrices of a step, shape (2, 2 + m), as filled by :func:`fill_step`; `free_step` after the
    motion.
``start``, ``end``
    u, V and W of the first component, then of the second, at both ends of a step, shape (6,) [m].
``directions``, ``sample_directions``
    Cosines and sines of all directions, shape (d, 2), and of some, shape (f, 2).
``peaks``
    Greatest absolute displacement so far in every direction, shape (d,), which is updated [m];
    those of :func:`march_oscillator` are described there.
``shifted``
    Scratch, shape (m,).
"""

from typing import Any, Final

import numpy as np

from rockframe.compiled import Matrix, Vector, entry, inlined, kernel

STEPS_PER_PERIOD: Final = 12
"""Least number of steps in a period, for which intervals are split: kappa is at most 0.52."""

SERIES_TERMS: Final = 24
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
        for n in range(SERIES_TERMS):
            new = -2.0 * damping * kappa * (n + 1) * following - kappa * kappa * term
            if n == column - 2:
                new -= 1.0
            new /= (n + 1) * (n + 2)
            value += new
            slope += (n + 2) * new
            term, following = following, new
        step[0, column], step[1, column] = value, slope


@kernel
def step_extremum(
    value: Any, slope: Any, second: Any, end_value: Any, end_slope: Any, end_second: Any
) -> Any:
    """Find the extremum inside a step whose slopes differ in sign, :eq:`eq-step-extremum`."""
    d_value = end_value - value - slope - 0.5 * second
    d_slope = end_slope - slope - second
    d_second = end_second - second
    third = 10.0 * d_value - 4.0 * d_slope + 0.5 * d_second
    fourth = -15.0 * d_value + 7.0 * d_slope - d_second
    fifth = 6.0 * d_value - 3.0 * d_slope + 0.5 * d_second
    # the root of the parabola through both slopes and the first second derivative: that of the
    # chord may be at a second derivative of zero, where Newton's method leaves the step
    root = -np.copysign(np.sqrt(np.maximum(0.0, second * second - 4.0 * d_slope * slope)), slope)
    # of the two forms of the root that without cancellation
    first_form = 1.0 * (second * root >= 0.0)
    at = (first_form * -2.0 * slope + (1.0 - first_form) * (root - second)) / (
        first_form * (second + root) + (1.0 - first_form) * 2.0 * d_slope
    )
    x = np.minimum(1.0, np.maximum(0.0, at))
    for _ in range(_NEWTON_STEPS):
        rate = slope + x * (second + x * (3.0 * third + x * (4.0 * fourth + x * 5.0 * fifth)))
        change = second + x * (6.0 * third + x * (12.0 * fourth + x * 20.0 * fifth))
        x = np.minimum(1.0, np.maximum(0.0, x - rate * change / (change * change + _TINY)))
    return value + x * (slope + x * (0.5 * second + x * (third + x * (fourth + x * fifth))))


@kernel
def extremum_bound(end_value: Any, end_slope: Any, second: Any, end_second: Any) -> Any:
    """Bound the extrema inside a step, between its ends."""
    # half the greatest second derivative would do if that were linear
    return abs(end_value) + abs(end_slope) + np.maximum(abs(second), abs(end_second))


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
    h_squared: float,
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
    uu, uv, u0, u1 = step[0, 0], step[0, 1], h_squared * step[0, 2], h_squared * step[0, 3]
    vu, vv, v0, v1 = step[1, 0], step[1, 1], h_squared * step[1, 2], h_squared * step[1, 3]
    u, v = state[0], state[1]
    total = drag * v + stiffness * u
    share = 1.0 / parts
    peak_u, peak_v, peak_total = abs(u), abs(v), abs(total)
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
                    next_u += h_squared * step[0, 2 + j] * shifted[j]
                    next_v += h_squared * step[1, 2 + j] * shifted[j]
            next_total = drag * next_v + stiffness * next_u
            # both ends from this step's own ground, which may jump between intervals
            w, next_w = -total - h_squared * ground, -next_total - h_squared * end_ground
            rate, next_rate = drag * w + stiffness * v, drag * next_w + stiffness * next_v
            peak_u = max(peak_u, abs(next_u))
            peak_v = max(peak_v, abs(next_v))
            peak_total = max(peak_total, abs(next_total))
            if v * next_v < 0.0 and extremum_bound(next_u, next_v, w, next_w) > peak_u:
                peak_u = max(peak_u, abs(step_extremum(u, v, w, next_u, next_v, next_w)))
            jerk, next_jerk = -rate - h_squared * slope, -next_rate - h_squared * end_slope
            if w * next_w < 0.0 and extremum_bound(next_v, next_w, jerk, next_jerk) > peak_v:
                peak_v = max(peak_v, abs(step_extremum(v, w, jerk, next_v, next_w, next_jerk)))
            second, next_second = drag * jerk + stiffness * w, drag * next_jerk + stiffness * next_w
            if (
                rate * next_rate < 0.0
                and extremum_bound(next_total, next_rate, second, next_second) > peak_total
            ):
                extremum = step_extremum(total, rate, second, next_total, next_rate, next_second)
                peak_total = max(peak_total, abs(extremum))
            u, v, total = next_u, next_v, next_total
    state[0], state[1] = u, v
    peaks[0] = max(peaks[0], peak_u)
    peaks[1] = max(peaks[1], peak_v)
    peaks[2] = max(peaks[2], peak_total)


@kernel
def clear_peaks(peaks: Vector) -> None:
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
    all_peaks: Matrix,
) -> None:
    """Find the peaks of all oscillators, during the motion and in the period after it.

    `all_peaks`, shape (k, 3), is filled: greatest relative displacement [m], relative velocity
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
        clear_peaks(peaks)
        march_oscillator(
            pieces, parts, length * length, kappa, damping, step, shifted, state, peaks
        )  # fmt: skip
        for j in range(QUANTITIES):
            all_peaks[k, j] = peaks[j] / length**j
        state[1] *= free_length / length
        clear_peaks(peaks)
        march_oscillator(still, 1, 0.0, free, damping, free_step, shifted, state, peaks)
        for j in range(QUANTITIES):
            all_peaks[k, j] = max(all_peaks[k, j], peaks[j] / free_length**j)


@kernel
def update_direction_peaks(
    directions: Matrix,
    start: Vector,
    end: Vector,
    peaks: Vector,
) -> float:
    """Update the peaks in all directions by those of one step; give the least peak [m]."""
    least = np.inf
    for d in range(directions.shape[0]):
        c, s = directions[d, 0], directions[d, 1]
        u, v, w = c * end[0] + s * end[3], c * end[1] + s * end[4], c * end[2] + s * end[5]
        peaks[d] = max(peaks[d], abs(u))
        before, second = c * start[1] + s * start[4], c * start[2] + s * start[5]
        if before * v < 0.0 and extremum_bound(u, v, second, w) > peaks[d]:
            extremum = step_extremum(c * start[0] + s * start[3], before, second, u, v, w)
            peaks[d] = max(peaks[d], abs(extremum))
        least = min(least, peaks[d])
    return least


@inlined
def step_component(
    pieces: Matrix,
    row: int,
    part: int,
    parts: int,
    h_squared: float,
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
        next_u += h_squared * (step[0, 2] * before + step[0, 3] * slope)
        next_v += h_squared * (step[1, 2] * before + step[1, 3] * slope)
    else:
        shift_piece(pieces, row, part, parts, shifted)
        before, ground = shifted[0], 0.0
        for j in range(pieces.shape[1]):
            ground += shifted[j]
            next_u += h_squared * step[0, 2 + j] * shifted[j]
            next_v += h_squared * step[1, 2 + j] * shifted[j]
    start[place + 2] = -drag * v - stiffness * u - h_squared * before
    end[place], end[place + 1] = next_u, next_v
    end[place + 2] = -drag * next_v - stiffness * next_u - h_squared * ground


@kernel
def find_outermost_points(
    first: Matrix,
    second: Matrix,
    parts: int,
    h_squared: float,
    kappa: float,
    damping: float,
    step: Matrix,
    shifted: Vector,
    start: Vector,
    end: Vector,
    sample_directions: Matrix,
    outermost: Matrix,
) -> None:
    """Find the points of the oscillator's path that lie farthest out in a few directions.

    These points bound its peaks in all directions from below, so that most steps need not be
    examined in every direction. `outermost`, shape (f, 3), is updated: the distance in each of
    these directions, and both displacements there [m].
    """
    least = 0.0
    for row in range(first.shape[0]):
        for part in range(parts):
            step_component(
                first, row, part, parts, h_squared, kappa, damping, step, shifted, 0, start, end
            )
            step_component(
                second, row, part, parts, h_squared, kappa, damping, step, shifted, 3, start, end
            )
            if end[0] * end[0] + end[3] * end[3] > least * least:
                least = np.inf
                for d in range(sample_directions.shape[0]):
                    distance = abs(
                        sample_directions[d, 0] * end[0] + sample_directions[d, 1] * end[3]
                    )
                    if distance > outermost[d, 0]:
                        outermost[d, 0], outermost[d, 1], outermost[d, 2] = distance, end[0], end[3]
                    least = min(least, outermost[d, 0])
            for j in range(6):
                start[j] = end[j]


@kernel
def march_pair(
    first: Matrix,
    second: Matrix,
    parts: int,
    h_squared: float,
    kappa: float,
    damping: float,
    step: Matrix,
    shifted: Vector,
    start: Vector,
    end: Vector,
    directions: Matrix,
    peaks: Vector,
) -> None:
    """Follow one oscillator under both components from interval to interval."""
    least = np.inf
    for d in range(directions.shape[0]):
        least = min(least, peaks[d])
    for row in range(first.shape[0]):
        for part in range(parts):
            step_component(
                first, row, part, parts, h_squared, kappa, damping, step, shifted, 0, start, end
            )
            step_component(
                second, row, part, parts, h_squared, kappa, damping, step, shifted, 3, start, end
            )
            # no direction has a larger peak in this step
            square = start[2] * start[2] + start[5] * start[5]
            reach = np.sqrt(max(square, end[2] * end[2] + end[5] * end[5]))
            reach += np.sqrt(end[0] * end[0] + end[3] * end[3])
            reach += np.sqrt(end[1] * end[1] + end[4] * end[4])
            if reach > least:
                least = update_direction_peaks(directions, start, end, peaks)
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
    sample_directions: Matrix,
    outermost: Matrix,
    peaks: Vector,
    all_peaks: Matrix,
) -> None:
    """Find the peaks of all oscillators in all directions, in `all_peaks`, shape (k, d) [m]."""
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
        for d in range(sample_directions.shape[0]):
            outermost[d, 0] = outermost[d, 1] = outermost[d, 2] = 0.0
        find_outermost_points(
            first, second, parts, length * length, kappa, damping, step, shifted, start, end,
            sample_directions, outermost,
        )  # fmt: skip
        for j in range(6):
            start[j] = 0.0
        for d in range(directions.shape[0]):
            peaks[d] = 0.0
            for place in range(sample_directions.shape[0]):
                distance = (
                    directions[d, 0] * outermost[place, 1] + directions[d, 1] * outermost[place, 2]
                )
                peaks[d] = max(peaks[d], abs(distance))
        march_pair(
            first, second, parts, length * length, kappa, damping, step, shifted, start, end,
            directions, peaks,
        )  # fmt: skip
        change = period / STEPS_PER_PERIOD / length
        start[1] *= change
        start[4] *= change
        march_pair(
            still, still, 1, 0.0, free, damping, free_step, shifted, start, end, directions, peaks
        )
        for d in range(directions.shape[0]):
            all_peaks[k, d] = peaks[d]
