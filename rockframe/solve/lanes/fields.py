"""The fields of a run in lanes: meaning and index of each number; the ground in all lanes.

A row holds a whole run, one number after the other, so that the driver of single runs can work
on it. The lane data hold the same fields, each for sixteen runs next to one another.

At the end of an interval of the motion all lanes move to the next one together. The end of the
motion, the end of a run and jumps of the ground are left to the driver of single runs.
"""

from typing import Final, NamedTuple

from rockframe.compiled import ReadOnlyMatrix, Vector, as_integers, inlined, lane_of
from rockframe.dynamics.protocol import POWERS, Equations
from rockframe.solve import workspace as at
from rockframe.solve.march import SHORTEST_STEP, is_jump
from rockframe.solve.schemes import STAGES
from rockframe.solve.workspace import MAX_TERMS, STATE_ERRORS, WEIGHTS

# real numbers of a lane (OWN), beside the clock and controls of a run
LENGTH: Final = 0  # length of the interval of the motion [s]
LONGEST_STEP: Final = 1  # longest fixed step that is stable in the mode [s]
STEP: Final = 2  # length of the step [s]
POSITION: Final = 3  # where in the interval the ground is evaluated, from 0 to 1
MIDDLE_X: Final = 4  # ground acceleration in the middle of a step of fixed length [m s^-2]
MIDDLE_Y: Final = 5
STAGE_X: Final = 6  # at the present stage; after the last one, at the end of the step [m s^-2]
STAGE_Y: Final = 7
REALS: Final = 8

# whole numbers of a lane (OWN_WHOLE), beside the counters of a run
BUSY: Final = 0  # whether the lane has a run
MOVING: Final = 1  # leading coordinates that move
IN_FLIGHT: Final = 2  # whether the mode is flight
NEEDS_DRIVER: Final = 3  # whether the driver of single runs must make the last step
FIRST_X: Final = 4  # row of the motion's first interval in the polynomials of all motions
COUNT_X: Final = 5  # number of intervals of the motion
FIRST_Y: Final = 6
COUNT_Y: Final = 7
STATUS: Final = 8  # how the run ended
ACCEPTED: Final = 9  # all bits set where the last step is accepted, none where it is not
ENTERS_NEXT: Final = 10  # whether the lane moves to its next interval
REJECTED: Final = 11  # whether the error of the last step was too large
INTEGERS: Final = 12

# results of a step in all lanes
ALL_QUIET: Final = 0  # no lane needs the driver of single runs
SOME_NEED_DRIVER: Final = 1  # some lane needs it for its step
NO_STEP_MADE: Final = 2  # no step was made: some lane needs it at the end of its interval

# indices of the fields that every system has; the rest depends on its size
CLOCK: Final = 0
COUNTERS: Final = CLOCK + at.CLOCK
CONTROLS: Final = COUNTERS + at.COUNTERS
OWN: Final = CONTROLS + at.CONTROLS
OWN_INTEGERS: Final = OWN + REALS
GROUND: Final = OWN_INTEGERS + INTEGERS
LIMITS: Final = GROUND + 2 * MAX_TERMS


class FieldIndices(NamedTuple):
    """Indices of the fields that depend on the size of a system."""

    reference: int  # largest size so far of each element of the state
    state: int  # the start of a step: state, slope, guards and their rates
    slope: int
    guards: int
    new_state: int  # the end of a step, likewise
    new_slope: int
    new_guards: int
    end: int  # the first field behind both
    stages: int
    works: int
    clock: int  # the first `STEP_CLOCK` numbers of the clock, at the end of a step
    numbers: int  # numbers of the system; memory and tolerances, which only rows have, follow


@inlined
def field_indices(system: Equations) -> FieldIndices:
    """Return the indices of the fields of a system."""
    size, variables, guards = system.coordinates(), system.variables(), system.guards() + 1
    width, slope = 2 * size + variables, size + variables + POWERS
    reference = LIMITS + WEIGHTS + size
    state = reference + width
    half = width + slope + 2 * guards
    new, stages = state + half, state + 2 * half
    works = stages + STAGES * (size + slope)
    clock = works + STATE_ERRORS + width
    return FieldIndices(
        reference, state, state + width, state + width + slope, new, new + width,
        new + width + slope, stages, stages, works, clock, clock + at.STEP_CLOCK,
    )  # fmt: skip


RECORD_DEGREE: Final = 1
"""Degree of the polynomials of a motion that is a record."""


@inlined
def evaluate_ground(
    lanes: int, data: Vector, pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix,
    fraction: float, x: int, y: int,
) -> None:  # fmt: skip
    """Write the ground acceleration at a fraction of the step to the own fields `x` and `y`."""
    for lane in range(lanes):
        clock, controls = lane_of(data, CLOCK, lane), lane_of(data, CONTROLS, lane)
        own = lane_of(data, OWN, lane)
        start = clock[at.INTO_INTERVAL] / controls[at.TIME_STEP]
        share = own[STEP] / controls[at.TIME_STEP]
        own[POSITION] = start + fraction * share
    evaluate_polynomials(lanes, data, pieces_x.shape[1] - 1, 0, x)
    if len(pieces_y) > 0:
        evaluate_polynomials(lanes, data, pieces_y.shape[1] - 1, MAX_TERMS, y)


@inlined
def evaluate_polynomials(lanes: int, data: Vector, degree: int, first: int, out: int) -> None:
    """Evaluate the polynomials of one direction."""
    if degree == RECORD_DEGREE:  # at places that are known when this is compiled
        for lane in range(lanes):
            own, ground = lane_of(data, OWN, lane), lane_of(data, GROUND, lane)
            own[out] = ground[first + 1] * own[POSITION] + ground[first]
        return
    for lane in range(lanes):
        own, ground = lane_of(data, OWN, lane), lane_of(data, GROUND, lane)
        own[out] = ground[first + degree]
    for j in range(degree - 1, -1, -1):
        for lane in range(lanes):
            own, ground = lane_of(data, OWN, lane), lane_of(data, GROUND, lane)
            own[out] = own[out] * own[POSITION] + ground[first + j]


@inlined
def is_at_end(data: Vector, lane: int) -> bool:
    """Whether a lane has a run, and has come to the end of an interval."""
    own, clock = lane_of(data, OWN, lane), lane_of(data, CLOCK, lane)
    shortest = SHORTEST_STEP * lane_of(data, CONTROLS, lane)[at.DURATION]
    busy = lane_of(as_integers(data), OWN_INTEGERS, lane)[BUSY] == 1
    return busy & (own[LENGTH] - clock[at.INTO_INTERVAL] <= shortest)


@inlined
def enters_next_interval(data: Vector, lane: int) -> bool:
    """Whether a lane is at the end of an interval after which run and motion continue."""
    integers, controls = as_integers(data), lane_of(data, CONTROLS, lane)
    own, numbers = lane_of(data, OWN, lane), lane_of(integers, OWN_INTEGERS, lane)
    index, length = lane_of(integers, COUNTERS, lane)[at.INTERVAL], own[LENGTH]
    x, y = numbers[COUNT_X], numbers[COUNT_Y]
    run_continues = index * controls[at.TIME_STEP] + length < controls[at.DURATION]
    motion_continues = (index + 1 < x) & ((index + 1 < y) | (y == 0))
    return is_at_end(data, lane) & run_continues & motion_continues


@inlined
def load_next_interval(
    data: Vector, lane: int, pieces: ReadOnlyMatrix, count: int, row: int, first: int
) -> None:
    """Write the polynomial of one direction in the next interval, if the lane moves to it."""
    own = lane_of(as_integers(data), OWN_INTEGERS, lane)
    index = lane_of(as_integers(data), COUNTERS, lane)[at.INTERVAL] + 1
    ground = lane_of(data, GROUND, lane)
    if own[ENTERS_NEXT] == 1 and index < own[count]:
        for j in range(pieces.shape[1]):
            ground[first + j] = pieces[own[row] + index, j]


@inlined
def enter_next_interval(data: Vector, lane: int) -> int:
    """Move a lane to its next interval unless the ground jumps; return 1 if it waits, else 0."""
    integers = as_integers(data)
    clock, controls = lane_of(data, CLOCK, lane), lane_of(data, CONTROLS, lane)
    own, numbers = lane_of(data, OWN, lane), lane_of(integers, OWN_INTEGERS, lane)
    counters, ground = lane_of(integers, COUNTERS, lane), lane_of(data, GROUND, lane)
    waits = is_at_end(data, lane)
    ground_jumps = is_jump(ground[0], clock[at.GROUND_X]) | is_jump(
        ground[MAX_TERMS], clock[at.GROUND_Y]
    )
    enters = (numbers[ENTERS_NEXT] == 1) & (not ground_jumps)
    index, into, length = counters[at.INTERVAL], clock[at.INTO_INTERVAL], own[LENGTH]
    remaining = controls[at.DURATION] - (index + 1) * controls[at.TIME_STEP]
    next_length = min(controls[at.TIME_STEP], remaining)
    counters[at.INTERVAL] = index + 1 if enters else index
    clock[at.INTO_INTERVAL] = 0.0 if enters else into
    own[LENGTH] = next_length if enters else length
    return 1 if waits & (not enters) else 0


@inlined
def enter_intervals(
    lanes: int, data: Vector, pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix
) -> int:
    """Move all lanes at the end of an interval to the next; return 1 if some must wait, else 0."""
    for lane in range(lanes):
        own = lane_of(as_integers(data), OWN_INTEGERS, lane)
        own[ENTERS_NEXT] = 1 if enters_next_interval(data, lane) else 0
    for lane in range(lanes):
        load_next_interval(data, lane, pieces_x, COUNT_X, FIRST_X, 0)
    if len(pieces_y) > 0:
        for lane in range(lanes):
            load_next_interval(data, lane, pieces_y, COUNT_Y, FIRST_Y, MAX_TERMS)
    some_wait = 0
    for lane in range(lanes):
        some_wait |= enter_next_interval(data, lane)
    return some_wait
