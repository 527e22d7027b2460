"""One step of fixed length in all lanes at once.

The loops over lanes hold nothing but arithmetic on one array, so that they are compiled to
instructions for several lanes at once. A lane does what :func:`rockframe.solve.march.march`
does in a quiet step, in the same order, to the last bit. A step that is not quiet is not
taken: the lane asks for the driver of single runs.
"""

from collections.abc import Callable
from typing import Final

from rockframe.compiled import (
    ReadOnlyMatrix,
    Vector,
    as_integers,
    inlined,
    lane_of,
    widest_registers,
)
from rockframe.dynamics.protocol import Ground, System
from rockframe.solve import layout as at
from rockframe.solve.fixed_step import fixed_step
from rockframe.solve.guards import may_fall, write_guards
from rockframe.solve.lanes import fields
from rockframe.solve.lanes.fields import Places, places_of
from rockframe.solve.lanes.intervals import enter_intervals
from rockframe.solve.march import SHORTEST, fit_step
from rockframe.solve.peaks import rotation_in_step
from rockframe.solve.schemes import rest_of
from rockframe.solve.workspace import TERMS

# what a call of step_lanes has found
ALL_QUIET: Final = 0
SOME_ASK: Final = 1  # the step of some lane is for the driver of single runs
SOME_WAIT: Final = 2  # some lane is at an end that is not just that of an interval; no step is made


@inlined
def choose_step(lanes: int, room: Vector) -> None:
    """Choose the length of the step in all lanes, and where its middle and end are."""
    for lane in range(lanes):
        clock, controls = lane_of(room, fields.CLOCK, lane), lane_of(room, fields.CONTROLS, lane)
        own = lane_of(room, fields.OWN, lane)
        remaining = own[fields.LENGTH] - clock[at.INTO_INTERVAL]
        asked = fit_step(min(clock[at.NEXT_STEP], controls[at.MAX_STEP]), remaining)
        h = min(asked, own[fields.LONGEST])
        place, share = clock[at.INTO_INTERVAL] / controls[at.TIME_STEP], h / controls[at.TIME_STEP]
        clock[at.ASKED] = asked
        own[fields.STEP] = h
        own[fields.PLACE_MIDDLE] = place + 0.5 * share
        own[fields.PLACE_END] = place + 1.0 * share


@inlined
def evaluate_ground(
    lanes: int, room: Vector, degree: int, first: int, middle: int, end: int
) -> None:
    """Evaluate the polynomials of one direction in the middle and at the end of the step."""
    if degree == 1:  # of records; at places that are known when this is compiled
        for lane in range(lanes):
            own, ground = lane_of(room, fields.OWN, lane), lane_of(room, fields.GROUND, lane)
            own[middle] = ground[first + 1] * own[fields.PLACE_MIDDLE] + ground[first]
            own[end] = ground[first + 1] * own[fields.PLACE_END] + ground[first]
        return
    for lane in range(lanes):
        own, ground = lane_of(room, fields.OWN, lane), lane_of(room, fields.GROUND, lane)
        own[middle] = own[end] = ground[first + degree]
    for j in range(degree - 1, -1, -1):
        for lane in range(lanes):
            own, ground = lane_of(room, fields.OWN, lane), lane_of(room, fields.GROUND, lane)
            coefficient = ground[first + j]
            own[middle] = own[middle] * own[fields.PLACE_MIDDLE] + coefficient
            own[end] = own[end] * own[fields.PLACE_END] + coefficient


@inlined
def take_step(system: System, room: Vector, lane: int) -> bool:
    """Take one lane to the end of its step; give whether that ended in numbers."""
    there = places_of(system)
    own, whole = lane_of(room, fields.OWN, lane), as_integers(room)
    mode = system.without_sliding(lane_of(whole, fields.COUNTERS, lane)[at.MODE])
    count = lane_of(whole, fields.OWN_WHOLE, lane)[fields.ACTIVE]
    return fixed_step(
        system, mode, count, own[fields.STEP],
        Ground(own[fields.MIDDLE_X], own[fields.MIDDLE_Y]),
        Ground(own[fields.END_X], own[fields.END_Y]),
        lane_of(room, there.state, lane), lane_of(room, there.first, lane),
        lane_of(room, there.new, lane), lane_of(room, there.last, lane),
        lane_of(room, there.stage, lane), lane_of(room, there.works, lane),
    )  # fmt: skip


@inlined
def is_quiet(system: System, room: Vector, lane: int) -> bool:
    """Whether nothing happens in a lane's step but motion; its guards are written."""
    there = places_of(system)
    own, whole = lane_of(room, fields.OWN, lane), as_integers(room)
    clock, counters = lane_of(room, fields.CLOCK, lane), lane_of(whole, fields.COUNTERS, lane)
    state, new = lane_of(room, there.state, lane), lane_of(room, there.new, lane)
    limits = lane_of(room, fields.LIMITS, lane)
    after, h, size = lane_of(room, there.after, lane), own[fields.STEP], system.coordinates()
    mode = counters[at.MODE]
    ground = Ground(own[fields.END_X], own[fields.END_Y])
    held = system.without_sliding(mode)
    found = system.guards_in(held, new, lane_of(room, there.last, lane), ground)
    write_guards(system, found, new, limits, after)
    falls = may_fall(system, h, lane_of(room, there.before, lane), after)
    rotation = rotation_in_step(size, limits, state, new)
    peaks = rotation.may_peak(h, clock[at.PEAK_LEFT], clock[at.PEAK_RIGHT])
    spent = counters[at.STEPS] + counters[at.REJECTED] >= counters[at.MAX_STEPS]
    return not (falls | peaks | spent | system.some_end_slides(mode))


@inlined
def account_for(system: System, room: Vector, lane: int) -> None:
    """Write what a step changes in the account of its run, should it be taken."""
    there = places_of(system)
    own, whole = lane_of(room, fields.OWN, lane), as_integers(room)
    clock, controls = lane_of(room, fields.CLOCK, lane), lane_of(room, fields.CONTROLS, lane)
    start, end, works, new = (
        lane_of(room, there.state, lane), lane_of(room, there.new, lane),
        lane_of(room, there.works, lane), lane_of(room, there.clock, lane),
    )  # fmt: skip
    limits, h, size = lane_of(room, fields.LIMITS, lane), own[fields.STEP], system.coordinates()
    rotation = rotation_in_step(size, limits, start, end)
    flight, flies = clock[at.FLIGHT_TIME], lane_of(whole, fields.OWN_WHOLE, lane)[fields.FLIES]
    supplied = clock[at.SUPPLIED] + works[1]
    new[at.INTO_INTERVAL] = clock[at.INTO_INTERVAL] + h
    new[at.NEXT_STEP] = rest_of(clock[at.ASKED], h, SHORTEST * controls[at.DURATION], controls)
    new[at.FLIGHT_TIME] = flight + h if flies == 1 else flight
    new[at.PEAK_LEFT] = max(clock[at.PEAK_LEFT], rotation.largest_left())
    new[at.PEAK_RIGHT] = max(clock[at.PEAK_RIGHT], rotation.largest_right())
    new[at.DISSIPATED] = clock[at.DISSIPATED] + works[0]
    new[at.SUPPLIED] = supplied
    new[at.LARGEST_MOVED] = max(clock[at.LARGEST_MOVED], abs(supplied))
    new[at.GROUND_X] = own[fields.END_X]
    new[at.GROUND_Y] = own[fields.END_Y]


@inlined
def take_steps(lanes: int, room: Vector, there: Places) -> None:
    """Make the end of a step the start of the next one, in all lanes."""
    for i in range(lanes * (there.new - there.state)):
        room[lanes * there.state + i] = room[lanes * there.new + i]
    for i in range(lanes * at.OF_STEPS):
        room[lanes * fields.CLOCK + i] = room[lanes * there.clock + i]
    for lane in range(lanes):
        lane_of(as_integers(room), fields.COUNTERS, lane)[at.STEPS] += 1


@inlined
def take_step_if_quiet(system: System, room: Vector, lane: int) -> None:
    """Make the end of a step the start of the next one where it is taken.

    Bit by bit: numbers that are written under a condition take their time on processors
    without registers for conditions.
    """
    there, whole = places_of(system), as_integers(room)
    taken = lane_of(whole, fields.OWN_WHOLE, lane)[fields.TAKEN]
    start, end = lane_of(whole, there.state, lane), lane_of(whole, there.new, lane)
    clock, new = lane_of(whole, fields.CLOCK, lane), lane_of(whole, there.clock, lane)
    for i in range(there.new - there.state):
        start[i] = (end[i] & taken) | (start[i] & ~taken)
    for i in range(at.OF_STEPS):
        clock[i] = (new[i] & taken) | (clock[i] & ~taken)
    lane_of(whole, fields.COUNTERS, lane)[at.STEPS] -= taken


@inlined
def step_lanes(
    system_of: Callable[[Vector], System], lanes: int, room: Vector, pieces_x: ReadOnlyMatrix,
    pieces_y: ReadOnlyMatrix,
) -> int:  # fmt: skip
    """Take all lanes that are at the end of an interval to the next, and make a step in all.

    Parameters
    ----------
    system_of : callable
        Gives the system of the numbers of a lane.
    lanes : int
        How many there are; loops of a length that is known are written out, not vectorised.
    room : ndarray
        All lanes, laid out in :mod:`rockframe.solve.lanes.fields`.
    pieces_x, pieces_y : ndarray
        The ground's polynomials of all motions.

    Returns
    -------
    int
        `ALL_QUIET`, `SOME_ASK` or `SOME_WAIT`.
    """
    widest_registers()
    if enter_intervals(lanes, room, pieces_x, pieces_y) == 1:
        return SOME_WAIT
    degree_x, degree_y = pieces_x.shape[1] - 1, pieces_y.shape[1] - 1
    there = places_of(system_of(lane_of(room, 0, 0)))
    choose_step(lanes, room)
    evaluate_ground(lanes, room, degree_x, 0, fields.MIDDLE_X, fields.END_X)
    if len(pieces_y) > 0:
        evaluate_ground(lanes, room, degree_y, TERMS, fields.MIDDLE_Y, fields.END_Y)
    for lane in range(lanes):
        system = system_of(lane_of(room, there.numbers, lane))
        done = take_step(system, room, lane)
        lane_of(as_integers(room), fields.OWN_WHOLE, lane)[fields.ASKS] = 0 if done else 1
    some = 0
    for lane in range(lanes):
        system = system_of(lane_of(room, there.numbers, lane))
        own = lane_of(as_integers(room), fields.OWN_WHOLE, lane)
        quiet = is_quiet(system, room, lane) & (own[fields.ASKS] == 0)
        asks = 0 if quiet else own[fields.BUSY]
        own[fields.TAKEN] = -1 if quiet else 0
        own[fields.ASKS] = asks
        some |= asks
    for lane in range(lanes):
        account_for(system_of(lane_of(room, there.numbers, lane)), room, lane)
    if some == 0:
        take_steps(lanes, room, there)
        return ALL_QUIET
    for lane in range(lanes):
        take_step_if_quiet(system_of(lane_of(room, there.numbers, lane)), room, lane)
    return SOME_ASK
