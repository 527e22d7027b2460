"""A batch of runs in lanes: quiet steps of all lanes together, all else one run at a time.

`steps.py` makes a step in all lanes. A run that reaches an event is copied from its lane to its
row; the driver of single runs continues it to the end of its interval, and it is copied back. The
results of a run depend neither on its lane, nor on its neighbours, nor on when it starts.
"""

from typing import NamedTuple

from rockframe.compiled import (
    LANES,
    BoundFunction,
    Integers,
    ReadOnlyMatrix,
    Vector,
    as_integers,
    entry,
    inlined,
    kernel,
    lane_of,
    view_of,
)
from rockframe.dynamics.events import FLIGHT
from rockframe.solve import workspace as at
from rockframe.solve.driver import run_to_pause
from rockframe.solve.equations import BoundEquations, unpack_mode
from rockframe.solve.lanes import fields
from rockframe.solve.lanes.fields import is_at_end
from rockframe.solve.march import interval_length, is_jump
from rockframe.solve.workspace import (
    MAX_TERMS,
    WEIGHTS,
    EventTable,
    Output,
    Pieces,
    Progress,
    Workspace,
)


class BatchSizes(NamedTuple):
    """Sizes of the rows of a batch."""

    rows: int  # number of rows, one for each run
    width: int  # length of a row
    state: int  # index of the state, behind which slope and guards of a step's start stand
    half: int  # number of fields of a step's start
    numbers: int  # index of a system's numbers
    number_count: int  # their number
    memory: int  # length of a system's memory


class Batch(NamedTuple):
    """The runs to make, and all that they share."""

    shape: BatchSizes
    rows: Vector  # of all runs, one row after the other
    data: Vector  # the lanes: element ``field * LANES + lane``
    row_of_lane: Integers  # the row of each lane, then the next row to start
    pieces: Pieces  # ground acceleration of all motions, one below the other
    equations: BoundEquations  # those of one of the systems; all are of one class
    output: Output  # without rows
    events: EventTable  # scratch: events are not kept
    w: Workspace  # scratch for a step of a single run


@inlined
def copy_to_lane(batch: Batch, row: Vector, lane: int, first: int, count: int) -> None:
    """Copy fields of a row into a lane."""
    inside = lane_of(batch.data, first, lane)
    for i in range(count):
        inside[i] = row[first + i]


@inlined
def copy_to_row(batch: Batch, row: Vector, lane: int, count: int) -> None:
    """Copy the first fields of a lane into a row."""
    inside = lane_of(batch.data, 0, lane)
    for i in range(count):
        row[i] = inside[i]


@inlined
def row_equations(batch: Batch, row: Vector) -> BoundEquations:
    """Return the equations of a row's system."""
    bound, shape = batch.equations, batch.shape
    return BoundEquations(
        march=bound.march, slope=bound.slope, powers=bound.powers, columns=bound.columns,
        guards=bound.guards, switch=bound.switch, energies=bound.energies,
        mode_properties=bound.mode_properties,
        numbers=view_of(row, shape.numbers, shape.number_count),
        coordinate_count=bound.coordinate_count, variable_count=bound.variable_count,
        guard_count=bound.guard_count,
    )  # fmt: skip


@inlined
def write_mode(batch: Batch, row: Vector) -> None:
    """Write what a run's mode means for its steps to its row."""
    counters = as_integers(view_of(row, fields.COUNTERS, at.COUNTERS))
    integers = as_integers(view_of(row, fields.OWN_INTEGERS, fields.INTEGERS))
    unpacked = unpack_mode(row_equations(batch, row), counters[at.MODE], batch.w.scratch)
    integers[fields.MOVING] = unpacked.moving
    integers[fields.IN_FLIGHT] = int(unpacked.contact == FLIGHT)
    row[fields.OWN + fields.LONGEST_STEP] = unpacked.longest_step


@inlined
def write_ground(row_of_pieces: int, pieces: ReadOnlyMatrix, first: int, ground: Vector) -> None:
    """Write the polynomial of one interval into a lane."""
    for j in range(pieces.shape[1]):
        ground[first + j] = pieces[row_of_pieces, j]


@inlined
def write_still_ground(terms: int, first: int, ground: Vector) -> None:
    """Write the polynomial of ground that stands still; -0 + x is x, whatever the sign of x."""
    ground[first] = 0.0
    for j in range(1, terms):
        ground[first + j] = -0.0


@inlined
def load_ground(batch: Batch, index: int, integers: Integers, ground: Vector) -> None:
    """Write the ground motion of an interval into a lane."""
    x, y = batch.pieces.x, batch.pieces.y
    if index < integers[fields.COUNT_X]:
        write_ground(integers[fields.FIRST_X] + index, x, 0, ground)
    else:
        write_still_ground(x.shape[1], 0, ground)
    if index < integers[fields.COUNT_Y]:
        write_ground(integers[fields.FIRST_Y] + index, y, MAX_TERMS, ground)
    else:
        write_still_ground(y.shape[1], MAX_TERMS, ground)


@inlined
def enter_interval(batch: Batch, lane: int) -> bool:
    """Move a lane to its next interval; return whether the single-run driver must continue."""
    data = batch.data
    clock, controls = lane_of(data, fields.CLOCK, lane), lane_of(data, fields.CONTROLS, lane)
    own, ground = lane_of(data, fields.OWN, lane), lane_of(data, fields.GROUND, lane)
    counters = lane_of(as_integers(data), fields.COUNTERS, lane)
    integers = lane_of(as_integers(data), fields.OWN_INTEGERS, lane)
    length, index = own[fields.LENGTH], counters[at.INTERVAL]
    intervals = max(integers[fields.COUNT_X], integers[fields.COUNT_Y])
    begin = index * controls[at.TIME_STEP]
    if index >= intervals or begin + length >= controls[at.DURATION]:
        return True  # the run has come to its end
    index += 1
    counters[at.INTERVAL] = index
    clock[at.INTO_INTERVAL] = 0.0
    own[fields.LENGTH] = interval_length(index, intervals, controls)
    load_ground(batch, index, integers, ground)
    if is_jump(ground[0], clock[at.GROUND_X]) or is_jump(ground[MAX_TERMS], clock[at.GROUND_Y]):
        counters[at.STALE] = 1
        return True
    return False


@kernel
def run_alone(batch: Batch, row: Vector) -> int:
    """Run on to the end of the interval, or of the run, by the driver of single runs."""
    shape, equations, w = batch.shape, batch.equations, batch.w
    counters = as_integers(view_of(row, fields.COUNTERS, at.COUNTERS))
    integers = as_integers(view_of(row, fields.OWN_INTEGERS, fields.INTEGERS))
    width, slope, guards = len(w.inner_state), len(w.inner_powers), len(w.inner_guards)
    size = equations.coordinate_count
    state, new = shape.state, shape.state + shape.half
    behind = shape.numbers + shape.number_count
    own = Workspace(
        view_of(row, state, 2 * shape.half),
        view_of(row, state, width), view_of(row, state + width, slope),
        view_of(row, state + width + slope, guards),
        view_of(row, new, width), view_of(row, new + width, slope),
        view_of(row, new + width + slope, guards),
        w.stages, w.works, view_of(row, state - width, width),
        view_of(row, fields.LIMITS, WEIGHTS + size), w.inner_state,
        w.inner_slope, w.inner_guards, w.inner_powers, w.ground, w.scratch,
    )  # fmt: skip
    tolerance = view_of(row, behind + shape.memory, equations.guard_count + 1)
    pieces = Pieces(
        view_of(batch.pieces.x, integers[fields.FIRST_X], integers[fields.COUNT_X]),
        view_of(batch.pieces.y, integers[fields.FIRST_Y], integers[fields.COUNT_Y]),
    )
    progress = Progress(
        view_of(row, fields.CONTROLS, at.CONTROLS), view_of(row, fields.CLOCK, at.CLOCK), counters
    )
    counters[at.LAST_INTERVAL] = counters[at.INTERVAL]
    result = at.TABLE_FULL
    while result == at.TABLE_FULL:  # events are counted, and not kept
        counters[at.EVENTS] = 0
        result = run_to_pause(
            row_equations(batch, row), tolerance, view_of(row, behind, shape.memory), pieces,
            progress, batch.output, batch.events, own,
        )  # fmt: skip
    return result


@inlined
def return_to_lane(batch: Batch, row: Vector, lane: int, everything: bool) -> None:
    """Copy a run that has paused into a lane: everything, or only fields that have changed."""
    shape = batch.shape
    counters = as_integers(view_of(row, fields.COUNTERS, at.COUNTERS))
    integers = as_integers(view_of(row, fields.OWN_INTEGERS, fields.INTEGERS))
    controls = view_of(row, fields.CONTROLS, at.CONTROLS)
    write_mode(batch, row)
    intervals = max(integers[fields.COUNT_X], integers[fields.COUNT_Y])
    row[fields.OWN + fields.LENGTH] = interval_length(counters[at.INTERVAL], intervals, controls)
    if everything:
        copy_to_lane(batch, row, lane, 0, shape.numbers + shape.number_count)
    else:
        copy_to_lane(batch, row, lane, 0, fields.CONTROLS)
        copy_to_lane(batch, row, lane, fields.OWN, fields.GROUND - fields.OWN)
        copy_to_lane(batch, row, lane, fields.LIMITS, shape.state - fields.LIMITS + shape.half)


@kernel
def start_next_run(batch: Batch, lane: int) -> None:
    """Start the next run, if one is left, and copy it to a lane after its first interval."""
    shape = batch.shape
    lane_of(as_integers(batch.data), fields.OWN_INTEGERS, lane)[fields.BUSY] = 0
    while batch.row_of_lane[LANES] < shape.rows:
        k = batch.row_of_lane[LANES]
        batch.row_of_lane[LANES] += 1
        batch.row_of_lane[lane] = k
        row = view_of(batch.rows, k * shape.width, shape.width)
        result = run_alone(batch, row)
        if result == at.PAUSED:
            return_to_lane(batch, row, lane, True)
            return
        as_integers(view_of(row, fields.OWN_INTEGERS, fields.INTEGERS))[fields.STATUS] = result


@kernel
def continue_alone(batch: Batch, lane: int) -> None:
    """Run a lane's run alone to the end of its interval; start another one if it ends there."""
    shape = batch.shape
    row = view_of(batch.rows, batch.row_of_lane[lane] * shape.width, shape.width)
    copy_to_row(batch, row, lane, shape.state + shape.half)
    result = run_alone(batch, row)
    if result == at.PAUSED:
        return_to_lane(batch, row, lane, False)
        return
    as_integers(view_of(row, fields.OWN_INTEGERS, fields.INTEGERS))[fields.STATUS] = result
    start_next_run(batch, lane)


@kernel
def drive_lanes(batch: Batch) -> int:
    """Run lanes alone that need the driver, and move all into an interval; return how many run."""
    busy = 0
    for lane in range(LANES):
        own = lane_of(as_integers(batch.data), fields.OWN_INTEGERS, lane)
        if own[fields.NEEDS_DRIVER] == 1:
            own[fields.NEEDS_DRIVER] = 0
            continue_alone(batch, lane)
        while is_at_end(batch.data, lane) and enter_interval(batch, lane):
            continue_alone(batch, lane)
        busy += own[fields.BUSY]
    return busy


@entry
def advance_batch(batch: Batch, steps: BoundFunction) -> None:
    """Make all runs of a batch."""
    for lane in range(LANES):
        start_next_run(batch, lane)
    outcome = fields.NO_STEP_MADE
    while outcome == fields.ALL_QUIET or drive_lanes(batch) > 0:
        outcome = steps.call(
            LANES, batch.data, batch.pieces.x, batch.pieces.y, batch.equations.numbers
        )
