"""What is kept of each of many runs: the fields of a row, and of a lane; the ground in all lanes.

A row holds a whole run, one number after the other, so that the driver of single runs works
on it as it stands. A lane holds the same fields between those of its neighbours.

Lanes go from one interval of the motion to the next at once. What is not just the end of an
interval, such as the end of the motion or a jump of the ground, is left to the driver of single
runs.
"""

from typing import Final, NamedTuple

from rockframe.compiled import ReadOnlyMatrix, Vector, as_integers, inlined, lane_of
from rockframe.dynamics.protocol import POWERS, Equations
from rockframe.solve import workspace as at
from rockframe.solve.march import SHORTEST, WEIGHTS, jumps
from rockframe.solve.schemes import STAGES
from rockframe.solve.workspace import ERRORS, TERMS

# what lanes need beside the clock, controls and counters of a run
LENGTH: Final = 0  # of the interval
LONGEST: Final = 1  # stable step in the mode
STEP: Final = 2  # length of the step
PLACE: Final = 3  # in the interval, from 0 to 1, at which the ground is evaluated
MIDDLE_X: Final = 4  # ground acceleration in the middle of a step of fixed length
MIDDLE_Y: Final = 5
NOW_X: Final = 6  # at a stage; at last at the end of the step
NOW_Y: Final = 7
REALS: Final = 8

# the same in whole numbers
BUSY: Final = 0  # whether the lane has a run
ACTIVE: Final = 1  # leading coordinates that move
FLIES: Final = 2
ASKS: Final = 3  # whether the last step is for the driver of single runs
FIRST_X: Final = 4  # row of the first interval in the polynomials of all motions
COUNT_X: Final = 5  # intervals of the motion
FIRST_Y: Final = 6
COUNT_Y: Final = 7
STATUS: Final = 8
TAKEN: Final = 9  # all bits where the last step is taken, none where not
ENTERS: Final = 10  # whether the lane comes to its next interval
REFUSED: Final = 11  # whether the error of the last step was too large
WHOLES: Final = 12

# what a step in all lanes has found
ALL_QUIET: Final = 0
SOME_ASK: Final = 1  # the step of some lane is for the driver of single runs
SOME_WAIT: Final = 2  # some lane is at an end that is not just that of an interval; no step is made

CLOCK: Final = 0
COUNTERS: Final = CLOCK + at.CLOCK
CONTROLS: Final = COUNTERS + at.COUNTERS
OWN: Final = CONTROLS + at.CONTROLS
OWN_WHOLE: Final = OWN + REALS
GROUND: Final = OWN_WHOLE + WHOLES
LIMITS: Final = GROUND + 2 * TERMS
"""Places of what every system has; the rest depends on its size."""


class Places(NamedTuple):
    """Places of fields that depend on the size of a system."""

    reference: int  # largest size so far of each variable
    state: int  # at the start of a step; both ends of a step stand together
    first: int
    before: int
    new: int
    last: int
    after: int
    end: int  # of both
    stages: int
    works: int
    clock: int  # at the end of a step, as far as steps change it
    numbers: int  # of the system; behind them memory and tolerances, which only rows have


@inlined
def places_of(system: Equations) -> Places:
    """Give where the fields of a system are."""
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
    """Write the acceleration at a fraction of the step in all lanes to two of their own fields."""
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
    """Whether a lane is at the end of an interval, and behind it lies another like it."""
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
    """Write the polynomial of a lane's next interval, in a direction in which it moves."""
    own = lane_of(as_integers(room), OWN_WHOLE, lane)
    index = lane_of(as_integers(room), COUNTERS, lane)[at.INTERVAL] + 1
    ground = lane_of(room, GROUND, lane)
    if own[ENTERS] == 1 and index < own[count]:
        for j in range(pieces.shape[1]):
            ground[first + j] = pieces[own[row] + index, j]


@inlined
def enter_next(room: Vector, lane: int) -> int:
    """Take a lane to its next interval, unless the ground jumps; give whether it has to wait."""
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
    """Take all lanes that are at the end of an interval to the next; give whether some wait."""
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
