"""The loop of steps between events, and whether a guard may fall inside a step.

It is compiled once for all systems, whose equations it calls, and can also be compiled for a
structure of systems, with the equations in it (`evaluation.py`). The driver (`driver.py`) calls the
loop by its address, and handles each step in which more happens than motion; `schemes.py` makes a
single step.
"""

import math
from typing import Final, NamedTuple, TypeAlias

from rockframe.compiled import Vector, inlined, kernel, view_from
from rockframe.dynamics.events import FLIGHT
from rockframe.dynamics.protocol import POWERS
from rockframe.solve import workspace as at
from rockframe.solve.evaluation import CalledEquations, EquationsByAddress, InlinedEquations
from rockframe.solve.schemes import (
    FixedSteps,
    FixedStepsByRates,
    HasSizes,
    StepEquations,
    StepsByTolerance,
    adapted_step,
    next_step,
    remaining_step,
)
from rockframe.solve.workspace import (
    LEFT_LIMIT,
    MAX_TERMS,
    RIGHT_LIMIT,
    WEIGHTS,
    Pieces,
    Progress,
    Span,
    StepArrays,
    StepTable,
    UnpackedMode,
    append_row,
    ground_in_step,
    ground_may_peak,
    is_full,
    load_interval,
    steps_made,
)

DIP_MARGIN: Final = 0.02
"""A dip of a guard's cubic is searched for negative values where its minimum is below this share
of the guard's variation in the step."""
DIP_BOUND: Final = 1.01 * DIP_MARGIN
"""The same share for a lower bound of that minimum, with room for rounding."""
THIRD: Final = 1.0 / 3.0


@inlined
def may_dip(start: float, change: float, end: float, end_change: float) -> bool:
    """Whether a guard is negative at the end of a step, or may be so inside it.

    `change` and `end_change` are its rates at both ends, per step. The cubic through values and
    rates is nowhere below its lowest Bernstein coefficient. Where the guard begins at zero, so is
    the cubic over the place in the step, whose coefficients are the same but for factors.
    """
    lowest = min(start + THIRD * change, end - THIRD * end_change)
    return (lowest < DIP_BOUND * (abs(change) + abs(end_change))) | (end < 0.0)


@inlined
def some_guard_may_fall(system: HasSizes, h: float, guards: Vector, new_guards: Vector) -> bool:
    """Whether some guard is negative after a step, or may have dipped below zero inside it."""
    some, count = False, system.guards() + 1
    for i in range(count):
        some |= may_dip(guards[i], h * guards[count + i], new_guards[i], h * new_guards[count + i])
    return some


class RotationInStep(NamedTuple):
    """A rotation [rad] and its rate [rad s^-1] at the start and at the end of a step."""

    start: float
    start_rate: float
    end: float
    end_rate: float
    left: float  # larger rotation to the left of both ends; negative if both are to the right
    right: float  # likewise to the right

    @inlined
    def may_peak(self, h: float, left: float, right: float) -> bool:
        """Whether it reverses in a step of length h, possibly beyond its peaks so far."""
        reach = 0.5 * h * max(abs(self.start_rate), abs(self.end_rate))
        rises = self.right + reach > right if self.start_rate > 0.0 else self.left + reach > left
        return (self.start_rate * self.end_rate < 0.0) & rises


@inlined
def rotation_in_step(
    row: int, size: int, limits: Vector, state: Vector, new_state: Vector
) -> RotationInStep:
    """Return the rotation whose limits begin at `row` of `limits`, at both ends of a step."""
    r0 = v0 = r1 = v1 = 0.0
    for i in range(size):
        r0 += limits[row + WEIGHTS + i] * state[i]
        v0 += limits[row + WEIGHTS + i] * state[size + i]
        r1 += limits[row + WEIGHTS + i] * new_state[i]
        v1 += limits[row + WEIGHTS + i] * new_state[size + i]
    return RotationInStep(r0, v0, r1, v1, max(-r0, -r1), max(r0, r1))


@inlined
def other_rotation_may_peak(
    size: int, limits: Vector, h: float, state: Vector, new_state: Vector, ratio: float
) -> bool:
    """Whether another body may come nearer to its limit inside a step than any has come so far."""
    some, row = False, WEIGHTS + size
    while row < len(limits):
        rotation = rotation_in_step(row, size, limits, state, new_state)
        some |= rotation.may_peak(
            h, ratio * limits[row + LEFT_LIMIT], ratio * limits[row + RIGHT_LIMIT]
        )
        row += WEIGHTS + size
    return some


@inlined
def other_rotation_ratio(size: int, limits: Vector, state: Vector) -> float:
    """Return the largest ratio of another body's rotation to its limit; 0 without other bodies."""
    ratio, row = 0.0, WEIGHTS + size
    while row < len(limits):
        rotation = 0.0
        for i in range(size):
            rotation += limits[row + WEIGHTS + i] * state[i]
        ratio = max(ratio, -rotation / limits[row + LEFT_LIMIT])
        ratio = max(ratio, rotation / limits[row + RIGHT_LIMIT])
        row += WEIGHTS + size
    return ratio


Scheme: TypeAlias = FixedSteps | StepsByTolerance

# reasons for which a march ends
AT_END: Final = 0  # the end of the run is reached
GROUND_JUMPED: Final = 1  # the ground acceleration has jumped between two intervals
GUARD_MAY_FALL: Final = 2  # a step was made in which a guard falls or may fall
# a step was made that contains an output time, or a reversal, or that fills the table of steps
OUTPUT_OR_PEAK: Final = 3
EXHAUSTED: Final = 4  # the number of steps PAUSE_AT is reached
TOO_SMALL: Final = 5  # no step was small enough
PAUSED: Final = 6  # the end of the interval LAST_INTERVAL is reached
TRIAL_MADE: Final = 7  # a trial step was made

SHORTEST_STEP: Final = 1e-14
"""Shortest step, as a share of the run's duration."""
JUMP_TOLERANCE: Final = 1e-12
"""Relative difference of the ground acceleration at a sample above which it is a jump."""


@inlined
def is_jump(now: float, before: float) -> bool:
    """Whether the ground acceleration jumped between two intervals."""
    return abs(now - before) > JUMP_TOLERANCE * abs(now)


@inlined
def fit_step(h: float, remaining: float) -> float:
    """Return the step h, changed so that it ends with the interval or leaves no tiny rest."""
    if h >= 0.999999 * remaining:
        return remaining
    return min(h, 0.5 * remaining)


@inlined
def interval_length(index: int, intervals: int, controls: Vector) -> float:
    """Return length of an interval of the motion, or of the rest of the run after the motion."""
    rest = controls[at.DURATION] - index * controls[at.TIME_STEP]
    return min(controls[at.TIME_STEP], rest) if index < intervals else rest


@inlined
def march(
    scheme: Scheme, system: StepEquations, unpacked: UnpackedMode, trial: float, pieces: Pieces,
    progress: Progress, steps: StepTable, arrays: StepArrays,
) -> int:  # fmt: skip
    """Make steps until something happens that the driver must handle; return why, as ``AT_END``.

    `trial` is the length of a single trial step, or 0 to continue with the run [s].
    ``progress.counters[HALF]`` tells which half of ``arrays.ends`` is the start of the next step.
    """
    mode, count = unpacked.mode, unpacked.moving
    controls, clock, counters = progress.controls, progress.clock, progress.counters
    ends, stages, works, reference, limits, ground = arrays
    values, codes = steps.values, steps.codes
    size = system.coordinates()
    width = 2 * size + system.variables()
    slope_end = width + size + system.variables() + POWERS
    stride = slope_end + 2 * (system.guards() + 1)
    half = counters[at.HALF]
    index, tau, h_next = counters[at.INTERVAL], clock[at.INTO_INTERVAL], clock[at.NEXT_STEP]
    time_step = controls[at.TIME_STEP]
    intervals = max(len(pieces.x), len(pieces.y))
    fixed, shortest = controls[at.RTOL] == at.FIXED_STEPS, SHORTEST_STEP * controls[at.DURATION]
    degree_x, degree_y = counters[at.DEGREE_X], counters[at.DEGREE_Y]
    begin, length = index * time_step, interval_length(index, intervals, controls)
    result = AT_END
    while True:
        remaining = length - tau
        if remaining <= shortest and trial == 0.0:
            if index >= intervals or begin + length >= controls[at.DURATION]:
                break
            if index >= counters[at.LAST_INTERVAL]:
                result = PAUSED
                break
            index += 1
            tau = 0.0
            begin, length = index * time_step, interval_length(index, intervals, controls)
            degree_x = load_interval(index, pieces.x, 0, ground)
            degree_y = load_interval(index, pieces.y, MAX_TERMS, ground)
            if is_jump(ground[0], clock[at.GROUND_X]) or is_jump(
                ground[MAX_TERMS], clock[at.GROUND_Y]
            ):
                result = GROUND_JUMPED
                break
            continue
        if steps_made(counters) >= counters[at.PAUSE_AT] and trial == 0.0:
            result = EXHAUSTED
            break
        requested = fit_step(min(h_next, controls[at.MAX_STEP]), remaining)
        h = trial if trial > 0.0 else min(requested, scheme.longest_step)
        span = Span(h, tau / time_step, h / time_step, degree_x, degree_y)
        start, end = half * stride, stride - half * stride
        state, new_state = view_from(ends, start), view_from(ends, end)
        slope, new_slope = view_from(ends, start + width), view_from(ends, end + width)
        guards, new_guards = view_from(ends, start + slope_end), view_from(ends, end + slope_end)
        finite = scheme.make_step(
            system, mode, count, span, ground, state, slope, new_state, new_slope, stages, works
        )
        ground_now = ground_in_step(1.0, span, ground)
        system.write_guards(mode, new_state, new_slope, ground_now, limits, new_guards)
        if trial > 0.0:
            return TRIAL_MADE
        scale = max(clock[at.LARGEST_TERM], clock[at.DISSIPATED], abs(clock[at.SUPPLIED]))
        error_norm = scheme.error_norm_of(
            system, count, finite, scale, new_state, works, reference, controls
        )
        if not error_norm <= 1.0:
            counters[at.REJECTED] += 1
            h_next = next_step(h, h, error_norm)
            if h_next <= shortest:
                result = TOO_SMALL
                break
            continue
        rotation = rotation_in_step(0, size, limits, state, new_state)
        peaks = rotation.may_peak(h, clock[at.PEAK_LEFT], clock[at.PEAK_RIGHT])
        peaks |= other_rotation_may_peak(
            size, limits, h, state, new_state, clock[at.OTHER_ROTATION_RATIO]
        )
        guard_falls = some_guard_may_fall(system, h, guards, new_guards)
        if count == 0:  # guards follow the ground alone, and have no rates
            guard_falls |= ground_may_peak(degree_x, degree_y, ground)
        output_due = begin + tau + h >= clock[at.NEXT_OUTPUT] or is_full(codes, counters)
        if guard_falls or peaks or output_due:
            clock[at.STEP], clock[at.REQUESTED], clock[at.ERROR_NORM] = h, requested, error_norm
            result = GUARD_MAY_FALL if guard_falls else OUTPUT_OR_PEAK
            break
        if fixed:
            h_next = remaining_step(requested, h, shortest, controls)
        else:
            h_next = adapted_step(h, h_next, error_norm, controls)
            for i in range(width):
                reference[i] = max(reference[i], abs(new_state[i]))
        tau += h
        if len(codes) > 0:
            append_row(
                begin + tau, h, mode, ground_now, width, slope_end - width - POWERS, new_state,
                new_slope, counters, values, codes,
            )  # fmt: skip
        clock[at.PEAK_LEFT] = max(clock[at.PEAK_LEFT], rotation.left)
        clock[at.PEAK_RIGHT] = max(clock[at.PEAK_RIGHT], rotation.right)
        ratio = other_rotation_ratio(size, limits, new_state)
        clock[at.OTHER_ROTATION_RATIO] = max(clock[at.OTHER_ROTATION_RATIO], ratio)
        if unpacked.contact == FLIGHT:
            clock[at.FLIGHT_TIME] += h
        clock[at.DISSIPATED] += works[0]
        clock[at.SUPPLIED] += works[1]
        clock[at.LARGEST_ENERGY] = max(clock[at.LARGEST_ENERGY], abs(clock[at.SUPPLIED]))
        clock[at.GROUND_X], clock[at.GROUND_Y] = ground_now.x, ground_now.y
        counters[at.STEPS] += 1
        half = 1 - half
    counters[at.HALF] = half
    counters[at.INTERVAL] = index
    counters[at.DEGREE_X], counters[at.DEGREE_Y] = degree_x, degree_y
    clock[at.INTO_INTERVAL], clock[at.NEXT_STEP] = tau, h_next
    return result


@kernel
def march_fixed(
    equations: InlinedEquations | EquationsByAddress, called: CalledEquations,
    unpacked: UnpackedMode, trial: float, pieces: Pieces, progress: Progress, steps: StepTable,
    arrays: StepArrays,
) -> int:  # fmt: skip
    """Make steps of fixed length, see :func:`march`."""
    system, scheme = equations.resolved(called), FixedSteps(unpacked.longest_step)
    return march(scheme, system, unpacked, trial, pieces, progress, steps, arrays)


@kernel
def march_fixed_by_rates(
    equations: InlinedEquations | EquationsByAddress, called: CalledEquations,
    unpacked: UnpackedMode, trial: float, pieces: Pieces, progress: Progress, steps: StepTable,
    arrays: StepArrays,
) -> int:  # fmt: skip
    """Make steps of fixed length of equations that give powers apart, see :func:`march`."""
    system, scheme = equations.resolved(called), FixedStepsByRates(unpacked.longest_step)
    return march(scheme, system, unpacked, trial, pieces, progress, steps, arrays)


@kernel
def march_by_tolerance(
    equations: InlinedEquations | EquationsByAddress, called: CalledEquations,
    unpacked: UnpackedMode, trial: float, pieces: Pieces, progress: Progress, steps: StepTable,
    arrays: StepArrays,
) -> int:  # fmt: skip
    """Make steps of the Dormand-Prince pair, see :func:`march`."""
    system, scheme = equations.resolved(called), StepsByTolerance(math.inf)
    return march(scheme, system, unpacked, trial, pieces, progress, steps, arrays)
