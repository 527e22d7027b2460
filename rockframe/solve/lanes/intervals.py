"""From one interval of the motion to the next, in all lanes at once.

What is not just the end of an interval, such as the end of the motion or a jump of the ground,
is left to the driver of single runs.
"""

from rockframe.compiled import ReadOnlyMatrix, Vector, as_integers, inlined, lane_of
from rockframe.solve import layout as at
from rockframe.solve.lanes import fields
from rockframe.solve.march import SHORTEST, jumps
from rockframe.solve.workspace import TERMS


@inlined
def is_at_end(room: Vector, lane: int) -> bool:
    """Whether a lane has a run, and has come to the end of an interval."""
    own, clock = lane_of(room, fields.OWN, lane), lane_of(room, fields.CLOCK, lane)
    shortest = SHORTEST * lane_of(room, fields.CONTROLS, lane)[at.DURATION]
    busy = lane_of(as_integers(room), fields.OWN_WHOLE, lane)[fields.BUSY] == 1
    return busy & (own[fields.LENGTH] - clock[at.INTO_INTERVAL] <= shortest)


@inlined
def comes_to_next(room: Vector, lane: int) -> bool:
    """Whether a lane is at the end of an interval, and behind it lies another like it."""
    whole, controls = as_integers(room), lane_of(room, fields.CONTROLS, lane)
    own, numbers = lane_of(room, fields.OWN, lane), lane_of(whole, fields.OWN_WHOLE, lane)
    index, length = lane_of(whole, fields.COUNTERS, lane)[at.INTERVAL], own[fields.LENGTH]
    x, y = numbers[fields.COUNT_X], numbers[fields.COUNT_Y]
    goes_on = index * controls[at.TIME_STEP] + length < controls[at.DURATION]
    moves = (index + 1 < x) & ((index + 1 < y) | (y == 0))
    return is_at_end(room, lane) & goes_on & moves


@inlined
def load_next(
    room: Vector, lane: int, pieces: ReadOnlyMatrix, count: int, row: int, first: int
) -> None:
    """Write the polynomial of a lane's next interval, in a direction in which it moves."""
    own = lane_of(as_integers(room), fields.OWN_WHOLE, lane)
    index = lane_of(as_integers(room), fields.COUNTERS, lane)[at.INTERVAL] + 1
    ground = lane_of(room, fields.GROUND, lane)
    if own[fields.ENTERS] == 1 and index < own[count]:
        for j in range(pieces.shape[1]):
            ground[first + j] = pieces[own[row] + index, j]


@inlined
def enter_next(room: Vector, lane: int) -> int:
    """Take a lane to its next interval, unless the ground jumps; give whether it has to wait."""
    whole = as_integers(room)
    clock, controls = lane_of(room, fields.CLOCK, lane), lane_of(room, fields.CONTROLS, lane)
    own, numbers = lane_of(room, fields.OWN, lane), lane_of(whole, fields.OWN_WHOLE, lane)
    counters, ground = lane_of(whole, fields.COUNTERS, lane), lane_of(room, fields.GROUND, lane)
    waits = is_at_end(room, lane)
    leaps = jumps(ground[0], clock[at.GROUND_X]) | jumps(ground[TERMS], clock[at.GROUND_Y])
    enters = (numbers[fields.ENTERS] == 1) & (not leaps)
    index, into, length = counters[at.INTERVAL], clock[at.INTO_INTERVAL], own[fields.LENGTH]
    rest = controls[at.DURATION] - (index + 1) * controls[at.TIME_STEP]
    following = min(controls[at.TIME_STEP], rest)
    counters[at.INTERVAL] = index + 1 if enters else index
    clock[at.INTO_INTERVAL] = 0.0 if enters else into
    own[fields.LENGTH] = following if enters else length
    return 1 if waits & (not enters) else 0


@inlined
def enter_intervals(
    lanes: int, room: Vector, pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix
) -> int:
    """Take all lanes that are at the end of an interval to the next; give whether some wait."""
    for lane in range(lanes):
        own = lane_of(as_integers(room), fields.OWN_WHOLE, lane)
        own[fields.ENTERS] = 1 if comes_to_next(room, lane) else 0
    for lane in range(lanes):
        load_next(room, lane, pieces_x, fields.COUNT_X, fields.FIRST_X, 0)
    if len(pieces_y) > 0:
        for lane in range(lanes):
            load_next(room, lane, pieces_y, fields.COUNT_Y, fields.FIRST_Y, TERMS)
    some = 0
    for lane in range(lanes):
        some |= enter_next(room, lane)
    return some
