"""The fields of a run in lanes: meaning and index of each number; the ground in all lanes.

A row holds a whole run, one number after the other, so that the driver of single runs can work
on it. The room of the lanes holds the same fields, each for sixteen runs next to one another.

At the end of an interval of the motion all lanes move to the next one together. The end of the
motion, the end of a run and jumps of the ground are left to the driver of single runs.
"""

from typing import Final, NamedTuple

from rockframe.compiled import ReadOnlyMatrix, Vector, as_integers, inlined, lane_of
from rockframe.dynamics.protocol import POWERS, Equations
from rockframe.solve import workspace as at
from rockframe.solve.march import SHORTEST, jumps
from rockframe.solve.schemes import STAGES
from rockframe.solve.workspace import ERRORS, TERMS, WEIGHTS

# real numbers of a lane (OWN), beside the clock and controls of a run
LENGTH: Final = 0  # length of the interval of the motion [s]
LONGEST: Final = 1  # longest fixed step that is stable in the mode [s]
STEP: Final = 2  # length of the step [s]
PLACE: Final = 3  # where in the interval the ground is evaluated, from 0 to 1
MIDDLE_X: Final = 4  # ground acceleration in the middle of a step of fixed length [m s^-2]
MIDDLE_Y: Final = 5
NOW_X: Final = 6  # at the present stage; after the last one, at the end of the step [m s^-2]
NOW_Y: Final = 7
REALS: Final = 8

# whole numbers of a lane (OWN_WHOLE), beside the counters of a run
BUSY: Final = 0  # whether the lane has a run
ACTIVE: Final = 1  # leading coordinates that move
FLIES: Final = 2  # whether the mode is flight
ASKS: Final = 3  # whether the driver of single runs must make the last step
FIRST_X: Final = 4  # row of the motion's first interval in the polynomials of all motions
COUNT_X: Final = 5  # number of intervals of the motion
FIRST_Y: Final = 6
COUNT_Y: Final = 7
STATUS: Final = 8  # how the run ended
TAKEN: Final = 9  # all bits set where the last step is accepted, none where it is not
ENTERS: Final = 10  # whether the lane moves to its next interval
REFUSED: Final = 11  # whether the error of the last step was too large
WHOLES: Final = 12

# results of a step in all lanes
ALL_QUIET: Final = 0  # no lane needs the driver of single runs
SOME_ASK: Final = 1  # some lane needs it for its step
SOME_WAIT: Final = 2  # no step was made: some lane needs it at the end of its interval

# indices of the fields that every system has; the rest depends on its size
CLOCK: Final = 0
COUNTERS: Final = CLOCK + at.CLOCK
CONTROLS: Final = COUNTERS + at.COUNTERS
OWN: Final = CONTROLS + at.CONTROLS
OWN_WHOLE: Final = OWN + REALS
GROUND: Final = OWN_WHOLE + WHOLES
LIMITS: Final = GROUND + 2 * TERMS


class Places(NamedTuple):
    """Indices of the fields that depend on the size of a system."""

    reference: int  # largest size so far of each element of the state
    state: int  # the start of a step: state, slope, guards and their rates
    first: int
    before: int
    new: int  # the end of a step, likewise
    last: int
    after: int
    end: int  # the first field behind both
    stages: int
    works: int
    clock: int  # the first `OF_STEPS` numbers of the clock, at the end of a step
    numbers: int  # numbers of the system; memory and tolerances, which only rows have, follow


@inlined
def places_of(system: Equations) -> Places:
    """Return the indices of the fields of a system."""
    size, variables, guards = system.coordinates(), system.variables(), system.guards() + 1
    width, slope = 2 * size + variables, size + variables + POWERS
    reference = LIMITS + WEIGHTS + size
    state = reference + width
    half = width + slope + 2 * guards
    new, stages = state + half, state + 2 * half
    works = stages + STAGES * (size + slope)
    clock = works + ERRORS + width
    return Places(
        reference, state, state + width, state + width + slope, new, new + width,
        new + width + slope, stages, stages, works, clock, clock + at.OF_STEPS,
    )  # fmt: skip


RECORDED: Final = 1
"""Degree of the polynomials of a motion that is a record."""


@inlined
def evaluate_ground(
    lanes: int, room: Vector, pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix,
    fraction: float, x: int, y: int,
) -> None:  # fmt: skip
    """Write the ground acceleration at a fraction of the step to the own fields `x` and `y`."""
    for lane in range(lanes):
        clock, controls = lane_of(room, CLOCK, lane), lane_of(room, CONTROLS, lane)
        own = lane_of(room, OWN, lane)
        place = clock[at.INTO_INTERVAL] / controls[at.TIME_STEP]
        share = own[STEP] / controls[at.TIME_STEP]
        own[PLACE] = place + fraction * share
    evaluate(lanes, room, pieces_x.shape[1] - 1, 0, x)
    if len(pieces_y) > 0:
        evaluate(lanes, room, pieces_y.shape[1] - 1, TERMS, y)


@inlined
def evaluate(lanes: int, room: Vector, degree: int, first: int, out: int) -> None:
    """Evaluate the polynomials of one direction."""
    if degree == RECORDED:  # at places that are known when this is compiled
        for lane in range(lanes):
            own, ground = lane_of(room, OWN, lane), lane_of(room, GROUND, lane)
            own[out] = ground[first + 1] * own[PLACE] + ground[first]
        return
    for lane in range(lanes):
        own, ground = lane_of(room, OWN, lane), lane_of(room, GROUND, lane)
        own[out] = ground[first + degree]
    for j in range(degree - 1, -1, -1):
        for lane in range(lanes):
            own, ground = lane_of(room, OWN, lane), lane_of(room, GROUND, lane)
            own[out] = own[out] * own[PLACE] + ground[first + j]


@inlined
def is_at_end(room: Vector, lane: int) -> bool:
    """Whether a lane has a run, and has come to the end of an interval."""
    own, clock = lane_of(room, OWN, lane), lane_of(room, CLOCK, lane)
    shortest = SHORTEST * lane_of(room, CONTROLS, lane)[at.DURATION]
    busy = lane_of(as_integers(room), OWN_WHOLE, lane)[BUSY] == 1
    return busy & (own[LENGTH] - clock[at.INTO_INTERVAL] <= shortest)


@inlined
def comes_to_next(room: Vector, lane: int) -> bool:
    """Whether a lane is at the end of an interval after which run and motion continue."""
    whole, controls = as_integers(room), lane_of(room, CONTROLS, lane)
    own, numbers = lane_of(room, OWN, lane), lane_of(whole, OWN_WHOLE, lane)
    index, length = lane_of(whole, COUNTERS, lane)[at.INTERVAL], own[LENGTH]
    x, y = numbers[COUNT_X], numbers[COUNT_Y]
    goes_on = index * controls[at.TIME_STEP] + length < controls[at.DURATION]
    moves = (index + 1 < x) & ((index + 1 < y) | (y == 0))
    return is_at_end(room, lane) & goes_on & moves


@inlined
def load_next(
    room: Vector, lane: int, pieces: ReadOnlyMatrix, count: int, row: int, first: int
) -> None:
    """Write the polynomial of one direction in the next interval, if the lane moves to it."""
    own = lane_of(as_integers(room), OWN_WHOLE, lane)
    index = lane_of(as_integers(room), COUNTERS, lane)[at.INTERVAL] + 1
    ground = lane_of(room, GROUND, lane)
    if own[ENTERS] == 1 and index < own[count]:
        for j in range(pieces.shape[1]):
            ground[first + j] = pieces[own[row] + index, j]


@inlined
def enter_next(room: Vector, lane: int) -> int:
    """Move a lane to its next interval unless the ground jumps; return 1 if it waits, else 0."""
    whole = as_integers(room)
    clock, controls = lane_of(room, CLOCK, lane), lane_of(room, CONTROLS, lane)
    own, numbers = lane_of(room, OWN, lane), lane_of(whole, OWN_WHOLE, lane)
    counters, ground = lane_of(whole, COUNTERS, lane), lane_of(room, GROUND, lane)
    waits = is_at_end(room, lane)
    leaps = jumps(ground[0], clock[at.GROUND_X]) | jumps(ground[TERMS], clock[at.GROUND_Y])
    enters = (numbers[ENTERS] == 1) & (not leaps)
    index, into, length = counters[at.INTERVAL], clock[at.INTO_INTERVAL], own[LENGTH]
    rest = controls[at.DURATION] - (index + 1) * controls[at.TIME_STEP]
    following = min(controls[at.TIME_STEP], rest)
    counters[at.INTERVAL] = index + 1 if enters else index
    clock[at.INTO_INTERVAL] = 0.0 if enters else into
    own[LENGTH] = following if enters else length
    return 1 if waits & (not enters) else 0


@inlined
def enter_intervals(
    lanes: int, room: Vector, pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix
) -> int:
    """Move all lanes at the end of an interval to the next; return 1 if some must wait, else 0."""
    for lane in range(lanes):
        own = lane_of(as_integers(room), OWN_WHOLE, lane)
        own[ENTERS] = 1 if comes_to_next(room, lane) else 0
    for lane in range(lanes):
        load_next(room, lane, pieces_x, COUNT_X, FIRST_X, 0)
    if len(pieces_y) > 0:
        for lane in range(lanes):
            load_next(room, lane, pieces_y, COUNT_Y, FIRST_Y, TERMS)
    some = 0
    for lane in range(lanes):
        some |= enter_next(room, lane)
    return some
