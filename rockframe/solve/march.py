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
from rockframe.solve.evaluation import ByAddress, Called, CompiledIn
from rockframe.solve.schemes import (
    Counted,
    Evaluated,
    FixedSteps,
    FixedStepsByRates,
    StepsByTolerance,
    adapted,
    next_step,
    rest_of,
)
from rockframe.solve.workspace import (
    LEFT_LIMIT,
    RIGHT_LIMIT,
    TERMS,
    WEIGHTS,
    KnownMode,
    Pieces,
    Progress,
    Span,
    StepArrays,
    StepTable,
    ground_in,
    has_no_room,
    keep_row,
    load_interval,
    may_turn,
)

DIP_MARGIN: Final = 0.02
"""A dip of a guard's cubic is searched for negative values where its minimum is below this share
of the guard's variation in the step."""
DOUBT: Final = 1.01 * DIP_MARGIN
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
    return (lowest < DOUBT * (abs(change) + abs(end_change))) | (end < 0.0)


@inlined
def may_fall(system: Counted, h: float, before: Vector, after: Vector) -> bool:
    """Whether some guard is negative after a step, or may have dipped below zero inside it."""
    found, guards = False, system.guards() + 1
    for i in range(guards):
        found |= may_dip(before[i], h * before[guards + i], after[i], h * after[guards + i])
    return found


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
        ahead = 0.5 * h * max(abs(self.start_rate), abs(self.end_rate))
        rises = self.right + ahead > right if self.start_rate > 0.0 else self.left + ahead > left
        return (self.start_rate * self.end_rate < 0.0) & rises


@inlined
def rotation_in_step(
    row: int, size: int, limits: Vector, state: Vector, new: Vector
) -> RotationInStep:
    """Return the rotation whose limits begin at `row` of `limits`, at both ends of a step."""
    r0 = v0 = r1 = v1 = 0.0
    for i in range(size):
        r0 += limits[row + WEIGHTS + i] * state[i]
        v0 += limits[row + WEIGHTS + i] * state[size + i]
        r1 += limits[row + WEIGHTS + i] * new[i]
        v1 += limits[row + WEIGHTS + i] * new[size + i]
    return RotationInStep(r0, v0, r1, v1, max(-r0, -r1), max(r0, r1))


@inlined
def other_may_peak(
    size: int, limits: Vector, h: float, state: Vector, new: Vector, share: float
) -> bool:
    """Whether another body may come nearer to its limit inside a step than any has come so far."""
    found, row = False, WEIGHTS + size
    while row < len(limits):
        rotation = rotation_in_step(row, size, limits, state, new)
        found |= rotation.may_peak(
            h, share * limits[row + LEFT_LIMIT], share * limits[row + RIGHT_LIMIT]
        )
        row += WEIGHTS + size
    return found


@inlined
def other_share(size: int, limits: Vector, state: Vector) -> float:
    """Return the largest ratio of another body's rotation to its limit; 0 without other bodies."""
    share, row = 0.0, WEIGHTS + size
    while row < len(limits):
        rotation = 0.0
        for i in range(size):
            rotation += limits[row + WEIGHTS + i] * state[i]
        share = max(share, -rotation / limits[row + LEFT_LIMIT])
        share = max(share, rotation / limits[row + RIGHT_LIMIT])
        row += WEIGHTS + size
    return share


Scheme: TypeAlias = FixedSteps | StepsByTolerance

# reasons for which a march ends
AT_END: Final = 0  # the end of the run is reached
JUMPED: Final = 1  # the ground acceleration has jumped between two intervals
GUARDED: Final = 2  # a step was made in which a guard falls or may fall
# a step was made that contains an output time, or a reversal, or that fills the table of steps
TO_BE_SEEN: Final = 3
EXHAUSTED: Final = 4  # the number of steps PAUSE_AT is reached
TOO_SMALL: Final = 5  # no step was small enough
PAUSED: Final = 6  # the end of the interval LAST_INTERVAL is reached
TRIED: Final = 7  # a trial step was made

SHORTEST: Final = 1e-14
"""Shortest step, as a share of the run's duration."""
JUMP: Final = 1e-12
"""Relative difference of the ground acceleration at a sample above which it is a jump."""


@inlined
def jumps(now: float, before: float) -> bool:
    """Whether the ground acceleration jumped between two intervals."""
    return abs(now - before) > JUMP * abs(now)


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
    scheme: Scheme, system: Evaluated, known: KnownMode, trial: float, pieces: Pieces,
    progress: Progress, steps: StepTable, arrays: StepArrays,
) -> int:  # fmt: skip
    """Make steps until something happens that the driver must handle.

    Parameters
    ----------
    scheme : Scheme
        The method of a step.
    system : Evaluated
        The equations.
    known : KnownMode
        The mode and its meaning.
    trial : float
        Length of a single trial step; 0 to continue with the run [s].
    pieces : Pieces
        Polynomials of the ground acceleration.
    progress : Progress
        Settings and progress; ``counters[HALF]`` tells which half of ``both_ends`` is the start.
    steps : StepTable
        Table of steps.
    arrays : StepArrays
        Arrays of a step.

    Returns
    -------
    int
        Why it ended, such as ``AT_END``.
    """
    mode, count = known.mode, known.moving
    controls, clock, counters = progress.controls, progress.clock, progress.counters
    ends, stages, works, reference, limits, ground = arrays
    kept, codes = steps.values, steps.codes
    size = system.coordinates()
    width = 2 * size + system.variables()
    slope_end = width + size + system.variables() + POWERS
    stride = slope_end + 2 * (system.guards() + 1)
    half = counters[at.HALF]
    index, tau, h_next = counters[at.INTERVAL], clock[at.INTO_INTERVAL], clock[at.NEXT_STEP]
    time_step = controls[at.TIME_STEP]
    intervals = max(len(pieces.x), len(pieces.y))
    fixed, shortest = controls[at.RTOL] == at.FIXED_STEPS, SHORTEST * controls[at.DURATION]
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
            degree_y = load_interval(index, pieces.y, TERMS, ground)
            if jumps(ground[0], clock[at.GROUND_X]) or jumps(ground[TERMS], clock[at.GROUND_Y]):
                result = JUMPED
                break
            continue
        tried = counters[at.STEPS] + counters[at.REJECTED]
        if tried >= counters[at.PAUSE_AT] and trial == 0.0:
            result = EXHAUSTED
            break
        requested = fit_step(min(h_next, controls[at.MAX_STEP]), remaining)
        h = trial if trial > 0.0 else min(requested, scheme.longest)
        span = Span(h, tau / time_step, h / time_step, degree_x, degree_y)
        here, there = half * stride, stride - half * stride
        state, new = view_from(ends, here), view_from(ends, there)
        first, last = view_from(ends, here + width), view_from(ends, there + width)
        before, after = view_from(ends, here + slope_end), view_from(ends, there + slope_end)
        done = scheme.make_step(
            system, mode, count, span, ground, state, first, new, last, stages, works
        )
        now = ground_in(1.0, span, ground)
        system.write_guards(mode, new, last, now, limits, after)
        if trial > 0.0:
            return TRIED
        scale = max(clock[at.LARGEST_TERM], clock[at.DISSIPATED], abs(clock[at.SUPPLIED]))
        excess = scheme.excess_of(system, count, done, scale, new, works, reference, controls)
        if not excess <= 1.0:
            counters[at.REJECTED] += 1
            h_next = next_step(h, h, excess)
            if h_next <= shortest:
                result = TOO_SMALL
                break
            continue
        rotation = rotation_in_step(0, size, limits, state, new)
        peaks = rotation.may_peak(h, clock[at.PEAK_LEFT], clock[at.PEAK_RIGHT])
        peaks |= other_may_peak(size, limits, h, state, new, clock[at.OTHER_SHARE])
        found = may_fall(system, h, before, after)
        if count == 0:  # guards follow the ground alone, and have no rates
            found |= may_turn(degree_x, degree_y, ground)
        seen = begin + tau + h >= clock[at.NEXT_OUTPUT] or has_no_room(codes, counters)
        if found or peaks or seen:
            clock[at.STEP], clock[at.ASKED], clock[at.EXCESS] = h, requested, excess
            result = GUARDED if found else TO_BE_SEEN
            break
        if fixed:
            h_next = rest_of(requested, h, shortest, controls)
        else:
            h_next = adapted(h, h_next, excess, controls)
            for i in range(width):
                reference[i] = max(reference[i], abs(new[i]))
        tau += h
        if len(codes) > 0:
            keep_row(
                begin + tau, h, mode, now, width, slope_end - width - POWERS, new, last, counters,
                kept, codes,
            )  # fmt: skip
        clock[at.PEAK_LEFT] = max(clock[at.PEAK_LEFT], rotation.left)
        clock[at.PEAK_RIGHT] = max(clock[at.PEAK_RIGHT], rotation.right)
        nearest = other_share(size, limits, new)
        clock[at.OTHER_SHARE] = max(clock[at.OTHER_SHARE], nearest)
        if known.contact == FLIGHT:
            clock[at.FLIGHT_TIME] += h
        clock[at.DISSIPATED] += works[0]
        clock[at.SUPPLIED] += works[1]
        clock[at.LARGEST_MOVED] = max(clock[at.LARGEST_MOVED], abs(clock[at.SUPPLIED]))
        clock[at.GROUND_X], clock[at.GROUND_Y] = now.x, now.y
        counters[at.STEPS] += 1
        half = 1 - half
    counters[at.HALF] = half
    counters[at.INTERVAL] = index
    counters[at.DEGREE_X], counters[at.DEGREE_Y] = degree_x, degree_y
    clock[at.INTO_INTERVAL], clock[at.NEXT_STEP] = tau, h_next
    return result


@kernel
def march_fixed(
    equations: CompiledIn | ByAddress, called: Called, known: KnownMode, trial: float,
    pieces: Pieces, progress: Progress, steps: StepTable, arrays: StepArrays,
) -> int:  # fmt: skip
    """Make steps of fixed length, see :func:`march`."""
    system, scheme = equations.evaluated(called), FixedSteps(known.longest)
    return march(scheme, system, known, trial, pieces, progress, steps, arrays)


@kernel
def march_fixed_by_rates(
    equations: CompiledIn | ByAddress, called: Called, known: KnownMode, trial: float,
    pieces: Pieces, progress: Progress, steps: StepTable, arrays: StepArrays,
) -> int:  # fmt: skip
    """Make steps of fixed length of equations that give powers apart, see :func:`march`."""
    system, scheme = equations.evaluated(called), FixedStepsByRates(known.longest)
    return march(scheme, system, known, trial, pieces, progress, steps, arrays)


@kernel
def march_by_tolerance(
    equations: CompiledIn | ByAddress, called: Called, known: KnownMode, trial: float,
    pieces: Pieces, progress: Progress, steps: StepTable, arrays: StepArrays,
) -> int:  # fmt: skip
    """Make steps of the Dormand-Prince pair, see :func:`march`."""
    system, scheme = equations.evaluated(called), StepsByTolerance(math.inf)
    return march(scheme, system, known, trial, pieces, progress, steps, arrays)
