"""Steps on end, until something happens; guards of a step, and whether one may fall inside it.

Written for any system and compiled for each, so that the equations are compiled into the loop;
the driver calls it by its address, and sees to all that is not a quiet step.
"""

import math
from typing import Any, Final, NamedTuple, TypeAlias

from rockframe.compiled import Integers, ReadOnlyMatrix, Vector, inlined, kernel, part_of, put
from rockframe.dynamics.protocol import POWERS, Equations, Ground, Guards, Slope
from rockframe.solve import workspace as at
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
from rockframe.solve.workspace import TERMS, Span, ground_in, has_no_room, keep_row, load_interval

LEFT_LIMIT: Final = 0
RIGHT_LIMIT: Final = 1
"""Places of the limits of the rotation; the weights of the coordinates in it stand behind, then
the same of other rotations that have limits."""
WEIGHTS: Final = 2


DIP_MARGIN: Final = 0.02
"""Share of a guard's variation in a step below which a predicted dip is looked into."""
DOUBT: Final = 1.01 * DIP_MARGIN
"""The same for a bound of the dip, with room for rounding."""
THIRD: Final = 1.0 / 3.0


@inlined
def guards_at(
    system: Equations, mode: int, state: Vector, slope: Vector, ground_x: float, ground_y: float,
    limits: Vector, out: Vector,
) -> None:  # fmt: skip
    """Write the guards of a state, see :func:`put_guards`; of several limits the nearest."""
    found = system.guards_in(mode, state, slope, Ground(ground_x, ground_y))
    put_guards(system, found, state, limits, out)
    size, last = system.coordinates(), system.guards()
    row = WEIGHTS + size
    while row < len(limits):
        rotation = rate = 0.0
        for i in range(size):
            rotation += limits[row + WEIGHTS + i] * state[i]
            rate += limits[row + WEIGHTS + i] * state[size + i]
        left = rotation <= 0.0
        apart = (
            limits[row + LEFT_LIMIT] + rotation if left else limits[row + RIGHT_LIMIT] - rotation
        )
        if apart < out[last]:
            out[last], out[2 * last + 1] = apart, rate if left else -rate
        row += WEIGHTS + size


@inlined
def put_guards(
    system: Equations, found: Guards, state: Vector, limits: Vector, out: Vector
) -> None:
    """Write guards, then their rates; the last is the distance of the rotation from its limit."""
    size, last = system.coordinates(), system.guards()
    rotation = rate = 0.0
    for i in range(size):
        rotation += limits[WEIGHTS + i] * state[i]
        rate += limits[WEIGHTS + i] * state[size + i]
    left = rotation <= 0.0
    put(found.values, 0, out)
    put(found.changes, last + 1, out)
    out[last] = limits[LEFT_LIMIT] + rotation if left else limits[RIGHT_LIMIT] - rotation
    out[2 * last + 1] = rate if left else -rate


class CompiledIn(NamedTuple):
    """Equations that are compiled into the loop of steps."""

    system: Any

    @inlined
    def coordinates(self) -> int:
        """Give the number of coordinates."""
        return self.system.coordinates()

    @inlined
    def variables(self) -> int:
        """Give the number of variables of first order."""
        return self.system.variables()

    @inlined
    def guards(self) -> int:
        """Give the number of guards."""
        return self.system.guards()

    @inlined
    def write_slope(
        self, mode: int, state: Vector, ground: Ground, first: int, out: Vector
    ) -> None:
        """Write accelerations, rates of variables and powers, from an index on."""
        put(self.system.accelerate(mode, state, ground), first, out)

    @inlined
    def write_guards(
        self, mode: int, state: Vector, slope: Vector, ground: Ground, limits: Vector, out: Vector
    ) -> None:
        """Write guards, then their rates, see :func:`guards_at`."""
        guards_at(self.system, mode, state, slope, ground.x, ground.y, limits, out)

    @inlined
    def powers(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> tuple[float, float]:
        """Give the powers at the rates of a state, of equations that give them."""
        return self.system.powers(mode, state, slope, ground)


@inlined
def may_dip(start: float, change: float, end: float, end_change: float) -> bool:
    """Whether a guard with these rates, by its step, is negative at its end or may be inside it.

    The cubic through values and rates is nowhere below its lowest Bernstein coefficient, however
    it begins and ends; divided by the place in the step, where it begins at zero, it has the
    same ones but for factors.
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
    """A rotation and its rate at the start and at the end of a step."""

    start: float
    start_rate: float
    end: float
    end_rate: float
    left: float  # largest to either side at the ends
    right: float

    @inlined
    def may_peak(self, h: float, left: float, right: float) -> bool:
        """Whether it reverses within a step of length h, and may do so beyond its peaks so far."""
        ahead = 0.5 * h * max(abs(self.start_rate), abs(self.end_rate))
        rises = self.right + ahead > right if self.start_rate > 0.0 else self.left + ahead > left
        return (self.start_rate * self.end_rate < 0.0) & rises


@inlined
def rotation_in_step(
    row: int, size: int, limits: Vector, state: Vector, new: Vector
) -> RotationInStep:
    """Give a rotation, a weighted sum of the coordinates, by the place of its limits."""
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
    """Whether another rotation may come nearer to its limit inside a step than it has come."""
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
    """Give the largest share of another rotation in its limit; zero where there is none."""
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

# why a march ended
AT_END: Final = 0  # of the run
JUMPED: Final = 1  # the ground, from one interval to the next
GUARDED: Final = 2  # a step was made, and some guard asks for a closer look
# a step was made that holds an output time, or a reversal, or is the last that there is room for
TO_BE_SEEN: Final = 3
EXHAUSTED: Final = 4  # the steps after which it was asked to stop
TOO_SMALL: Final = 5  # no step was small enough
PAUSED: Final = 6  # the end of the interval at which it was asked to stop
TRIED: Final = 7  # a step that was only tried

SHORTEST: Final = 1e-14
"""Shortest step, as a share of the run's duration."""
JUMP: Final = 1e-12
"""Share of the ground acceleration by which it must differ to have jumped at a sample."""


@inlined
def jumps(now: float, before: float) -> bool:
    """Whether the ground acceleration jumped between two intervals."""
    return abs(now - before) > JUMP * abs(now)


@inlined
def fit_step(h: float, remaining: float) -> float:
    """Give a step that ends on the interval's end, or leaves a fair rest of it."""
    if h >= 0.999999 * remaining:
        return remaining
    return min(h, 0.5 * remaining)


@inlined
def interval_length(index: int, intervals: int, controls: Vector) -> float:
    """Give the length of an interval of the motion; of the rest of the run behind the last."""
    rest = controls[at.DURATION] - index * controls[at.TIME_STEP]
    return min(controls[at.TIME_STEP], rest) if index < intervals else rest


@inlined
def march(
    scheme: Scheme, system: Evaluated, mode: int, count: int, flies: int, trial: float,
    pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix, ends: Vector, stages: Vector, works: Vector,
    reference: Vector, limits: Vector, ground: Vector, controls: Vector, clock: Vector,
    counters: Integers, kept: Vector, codes: Integers,
) -> int:  # fmt: skip
    """Make steps until something happens that the driver must see to.

    Parameters
    ----------
    scheme : Scheme
        Way to step.
    system : Evaluated
        The equations.
    mode, count, flies : int
        Contact mode, how many leading coordinates move in it, and whether it is flight.
    trial : float
        Length of a step that is only tried; 0 to go on [s].
    pieces_x, pieces_y : ndarray
        Ground motion.
    ends : ndarray
        State, slope and guards with their rates at both ends of a step; ``counters[HALF]``
        tells which half is the start.
    stages, works : ndarray
        Room for stages; the energies dissipated and put in by a step, the error of their
        difference, and the errors of everything in the state.
    reference, limits : ndarray
        Largest size so far of each variable; limits of the rotation.
    ground : ndarray
        Coefficients of the ground motion in the interval.
    controls, clock, counters : ndarray
        Settings and progress, laid out in :mod:`rockframe.solve.workspace`.
    kept, codes : ndarray
        Table of steps, see :class:`rockframe.solve.workspace.StepTable`.

    Returns
    -------
    int
        Why it ended.
    """
    size = system.coordinates()
    width = 2 * size + system.variables()
    slope_end = width + size + system.variables() + POWERS
    stride = slope_end + 2 * (system.guards() + 1)
    half = counters[at.HALF]
    index, tau, h_next = counters[at.INTERVAL], clock[at.INTO_INTERVAL], clock[at.NEXT_STEP]
    time_step = controls[at.TIME_STEP]
    intervals = max(len(pieces_x), len(pieces_y))
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
            degree_x = load_interval(index, pieces_x, 0, ground)
            degree_y = load_interval(index, pieces_y, TERMS, ground)
            if jumps(ground[0], clock[at.GROUND_X]) or jumps(ground[TERMS], clock[at.GROUND_Y]):
                result = JUMPED
                break
            continue
        tried = counters[at.STEPS] + counters[at.REJECTED]
        if tried >= counters[at.PAUSE_AT] and trial == 0.0:
            result = EXHAUSTED
            break
        asked = fit_step(min(h_next, controls[at.MAX_STEP]), remaining)
        h = trial if trial > 0.0 else min(asked, scheme.longest)
        span = Span(h, tau / time_step, h / time_step, degree_x, degree_y)
        here, there = half * stride, stride - half * stride
        state, new = part_of(ends, here), part_of(ends, there)
        first, last = part_of(ends, here + width), part_of(ends, there + width)
        before, after = part_of(ends, here + slope_end), part_of(ends, there + slope_end)
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
        seen = begin + tau + h >= clock[at.NEXT_OUTPUT] or has_no_room(codes, counters)
        if found or peaks or seen:
            clock[at.STEP], clock[at.ASKED], clock[at.EXCESS] = h, asked, excess
            result = GUARDED if found else TO_BE_SEEN
            break
        if fixed:
            h_next = rest_of(asked, h, shortest, controls)
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
        if flies == 1:
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
    system: Equations, mode: int, count: int, flies: int, longest: float, trial: float,
    pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix, ends: Vector, stages: Vector, works: Vector,
    reference: Vector, limits: Vector, ground: Vector, controls: Vector, clock: Vector,
    counters: Integers, kept: Vector, codes: Integers,
) -> int:  # fmt: skip
    """Make steps of fixed length, see :func:`march`."""
    return march(
        FixedSteps(longest), CompiledIn(system), mode, count, flies, trial, pieces_x,
        pieces_y, ends, stages, works, reference, limits, ground, controls, clock, counters, kept,
        codes,
    )  # fmt: skip


@kernel
def march_fixed_by_rates(
    system: Equations, mode: int, count: int, flies: int, longest: float, trial: float,
    pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix, ends: Vector, stages: Vector, works: Vector,
    reference: Vector, limits: Vector, ground: Vector, controls: Vector, clock: Vector,
    counters: Integers, kept: Vector, codes: Integers,
) -> int:  # fmt: skip
    """Make such steps, of equations that give powers at any rates; see :func:`march`."""
    return march(
        FixedStepsByRates(longest), CompiledIn(system), mode, count, flies, trial, pieces_x,
        pieces_y, ends, stages, works, reference, limits, ground, controls, clock, counters, kept,
        codes,
    )  # fmt: skip


@kernel
def march_by_tolerance(
    system: Equations, mode: int, count: int, flies: int, longest: float, trial: float,
    pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix, ends: Vector, stages: Vector, works: Vector,
    reference: Vector, limits: Vector, ground: Vector, controls: Vector, clock: Vector,
    counters: Integers, kept: Vector, codes: Integers,
) -> int:  # fmt: skip
    """Make steps of the Dormand-Prince pair, see :func:`march`."""
    return march(
        StepsByTolerance(math.inf), CompiledIn(system), mode, count, flies, trial, pieces_x,
        pieces_y, ends, stages, works, reference, limits, ground, controls, clock, counters, kept,
        codes,
    )  # fmt: skip
