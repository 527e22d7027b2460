"""One step of fixed length in all lanes at once.

The loops over lanes hold nothing but arithmetic on one array, so that they are compiled to
instructions for several lanes at once. A lane does what :func:`rockframe.solve.march.march`
does in a quiet step, in the same order, to the last bit. A step that is not quiet is not
taken: the lane asks for the driver of single runs.
"""

from collections.abc import Callable

from rockframe.compiled import (
    ReadOnlyMatrix,
    Vector,
    as_integers,
    inlined,
    lane_of,
    widest_registers,
)
from rockframe.dynamics.protocol import Equations, Ground
from rockframe.solve import layout as at
from rockframe.solve.fixed_step import fixed_step
from rockframe.solve.lanes import fields
from rockframe.solve.lanes.fields import places_of
from rockframe.solve.lanes.ground import evaluate_ground
from rockframe.solve.lanes.intervals import enter_intervals
from rockframe.solve.lanes.taking import (
    account_for,
    is_quiet,
    is_spent,
    take_step_if_quiet,
    take_steps,
)
from rockframe.solve.march import SHORTEST, fit_step
from rockframe.solve.schemes import rest_of


@inlined
def choose_step(room: Vector, lane: int) -> None:
    """Choose the length of a lane's step."""
    clock, controls = lane_of(room, fields.CLOCK, lane), lane_of(room, fields.CONTROLS, lane)
    own = lane_of(room, fields.OWN, lane)
    remaining = own[fields.LENGTH] - clock[at.INTO_INTERVAL]
    asked = fit_step(min(clock[at.NEXT_STEP], controls[at.MAX_STEP]), remaining)
    clock[at.ASKED] = asked
    own[fields.STEP] = min(asked, own[fields.LONGEST])


@inlined
def make_step(system: Equations, room: Vector, lane: int) -> bool:
    """Take one lane to the end of its step; give whether that ended in numbers."""
    there = places_of(system)
    own, whole = lane_of(room, fields.OWN, lane), as_integers(room)
    mode = system.without_sliding(lane_of(whole, fields.COUNTERS, lane)[at.MODE])
    count = lane_of(whole, fields.OWN_WHOLE, lane)[fields.ACTIVE]
    return fixed_step(
        system, mode, count, own[fields.STEP],
        Ground(own[fields.MIDDLE_X], own[fields.MIDDLE_Y]),
        Ground(own[fields.NOW_X], own[fields.NOW_Y]),
        lane_of(room, there.state, lane), lane_of(room, there.first, lane),
        lane_of(room, there.new, lane), lane_of(room, there.last, lane),
        lane_of(room, there.stages, lane), lane_of(room, there.works, lane),
    )  # fmt: skip


@inlined
def account_for_rest(system: Equations, room: Vector, lane: int) -> None:
    """Write what a step changes in the account of its run, with what is left of the sub-step."""
    clock, controls = lane_of(room, fields.CLOCK, lane), lane_of(room, fields.CONTROLS, lane)
    h = lane_of(room, fields.OWN, lane)[fields.STEP]
    new = lane_of(room, places_of(system).clock, lane)
    account_for(system, room, lane)
    new[at.NEXT_STEP] = rest_of(clock[at.ASKED], h, SHORTEST * controls[at.DURATION], controls)


@inlined
def step_lanes(
    system_of: Callable[[Vector], Equations], lanes: int, room: Vector, pieces_x: ReadOnlyMatrix,
    pieces_y: ReadOnlyMatrix,
) -> int:  # fmt: skip
    """Take all lanes that are at the end of an interval to the next, and make a step in all."""
    widest_registers()
    if enter_intervals(lanes, room, pieces_x, pieces_y) == 1:
        return fields.SOME_WAIT
    there = places_of(system_of(lane_of(room, 0, 0)))
    for lane in range(lanes):
        choose_step(room, lane)
    evaluate_ground(lanes, room, pieces_x, pieces_y, 0.5, fields.MIDDLE_X, fields.MIDDLE_Y)
    evaluate_ground(lanes, room, pieces_x, pieces_y, 1.0, fields.NOW_X, fields.NOW_Y)
    for lane in range(lanes):
        system = system_of(lane_of(room, there.numbers, lane))
        done = make_step(system, room, lane)
        lane_of(as_integers(room), fields.OWN_WHOLE, lane)[fields.REFUSED] = 0 if done else 1
    some = 0
    for lane in range(lanes):
        system = system_of(lane_of(room, there.numbers, lane))
        own = lane_of(as_integers(room), fields.OWN_WHOLE, lane)
        quiet = is_quiet(system, room, lane) & (own[fields.REFUSED] == 0)
        quiet = quiet & (not is_spent(room, lane))
        asks = 0 if quiet else own[fields.BUSY]
        own[fields.TAKEN] = -1 if quiet else 0
        own[fields.ASKS] = asks
        some |= asks
    for lane in range(lanes):
        account_for_rest(system_of(lane_of(room, there.numbers, lane)), room, lane)
    if some == 0:
        take_steps(lanes, room, there)
        return fields.ALL_QUIET
    for lane in range(lanes):
        take_step_if_quiet(system_of(lane_of(room, there.numbers, lane)), room, lane)
    return fields.SOME_ASK
