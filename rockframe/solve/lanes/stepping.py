"""One step of fixed length in all lanes at once.

The loops over lanes hold nothing but arithmetic on one array, so that they are compiled to
instructions for several lanes at once. A lane does what :func:`rockframe.solve.march.march`
does in a quiet step, in the same order, to the last bit. A step that is not quiet is not
taken: the lane asks for the driver of single runs.
"""

from collections.abc import Callable

from rockframe.compiled import Vector, as_integers, inlined, lane_of, widest_registers
from rockframe.dynamics.protocol import Ground, System
from rockframe.solve import layout as at
from rockframe.solve.fixed_step import fixed_step
from rockframe.solve.guards import WEIGHTS, may_fall, write_guards
from rockframe.solve.lanes import fields
from rockframe.solve.lanes.fields import places_of
from rockframe.solve.march import SHORTEST, fit_step
from rockframe.solve.schemes import rest_of
from rockframe.solve.workspace import TERMS

NO_VERTICAL = -1
"""Degree of a vertical motion that no lane has."""


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
    mode = lane_of(whole, fields.COUNTERS, lane)[at.MODE]
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
    found = system.guards_held(mode, new, lane_of(room, there.last, lane), ground)
    write_guards(system, found, new, limits, after)
    falls = may_fall(system, h, lane_of(room, there.before, lane), after)
    r0 = v0 = r1 = v1 = 0.0
    for i in range(size):
        r0 += limits[WEIGHTS + i] * state[i]
        v0 += limits[WEIGHTS + i] * state[size + i]
        r1 += limits[WEIGHTS + i] * new[i]
        v1 += limits[WEIGHTS + i] * new[size + i]
    ahead = 0.5 * h * max(abs(v0), abs(v1))
    rises_right = max(r0, r1) + ahead > clock[at.PEAK_RIGHT]
    rises_left = max(-r0, -r1) + ahead > clock[at.PEAK_LEFT]
    rises = rises_right if v0 > 0.0 else rises_left
    spent = counters[at.STEPS] + counters[at.REJECTED] >= counters[at.MAX_STEPS]
    return not (falls | ((v0 * v1 < 0.0) & rises) | spent | system.some_end_slides(mode))


@inlined
def take_end(system: System, room: Vector, lane: int, quiet: bool) -> None:
    """Make the end of a quiet step the start of the next one."""
    there = places_of(system)
    start, end = lane_of(room, there.state, lane), lane_of(room, there.new, lane)
    for i in range(there.new - there.state):
        start[i] = end[i] if quiet else start[i]


@inlined
def accept(system: System, room: Vector, lane: int, quiet: bool) -> None:
    """Take the end of a quiet step for what is reached; leave everything else as it is."""
    there = places_of(system)
    own, whole = lane_of(room, fields.OWN, lane), as_integers(room)
    clock, controls = lane_of(room, fields.CLOCK, lane), lane_of(room, fields.CONTROLS, lane)
    counters = lane_of(whole, fields.COUNTERS, lane)
    start, end, works = (
        lane_of(room, there.state, lane), lane_of(room, there.new, lane),
        lane_of(room, there.works, lane),
    )  # fmt: skip
    limits, h, size = lane_of(room, fields.LIMITS, lane), own[fields.STEP], system.coordinates()
    r0 = r1 = 0.0
    for i in range(size):
        r0 += limits[WEIGHTS + i] * start[i]
        r1 += limits[WEIGHTS + i] * end[i]
    left = max(clock[at.PEAK_LEFT], max(-r0, -r1))
    right = max(clock[at.PEAK_RIGHT], max(r0, r1))
    following = rest_of(clock[at.ASKED], h, SHORTEST * controls[at.DURATION], controls)
    flown = clock[at.FLIGHT_TIME] + h
    supplied = clock[at.SUPPLIED] + works[1]
    flies = lane_of(whole, fields.OWN_WHOLE, lane)[fields.FLIES] == 1
    clock[at.PEAK_LEFT] = left if quiet else clock[at.PEAK_LEFT]
    clock[at.PEAK_RIGHT] = right if quiet else clock[at.PEAK_RIGHT]
    clock[at.NEXT_STEP] = following if quiet else clock[at.NEXT_STEP]
    into = clock[at.INTO_INTERVAL] + h
    clock[at.INTO_INTERVAL] = into if quiet else clock[at.INTO_INTERVAL]
    clock[at.FLIGHT_TIME] = flown if quiet & flies else clock[at.FLIGHT_TIME]
    dissipated = clock[at.DISSIPATED] + works[0]
    clock[at.DISSIPATED] = dissipated if quiet else clock[at.DISSIPATED]
    clock[at.SUPPLIED] = supplied if quiet else clock[at.SUPPLIED]
    moved = max(clock[at.LARGEST_MOVED], abs(supplied))
    clock[at.LARGEST_MOVED] = moved if quiet else clock[at.LARGEST_MOVED]
    clock[at.GROUND_X] = own[fields.END_X] if quiet else clock[at.GROUND_X]
    clock[at.GROUND_Y] = own[fields.END_Y] if quiet else clock[at.GROUND_Y]
    counters[at.STEPS] += 1 if quiet else 0


@inlined
def step_lanes(
    system_of: Callable[[Vector], System], lanes: int, room: Vector, degree_x: int, degree_y: int
) -> int:
    """Make a step in all lanes.

    Parameters
    ----------
    system_of : callable
        Gives the system of the numbers of a lane.
    lanes : int
        How many there are; loops of a length that is known are written out, not vectorised.
    room : ndarray
        All lanes, laid out in :mod:`rockframe.solve.lanes.fields`.
    degree_x, degree_y : int
        Highest degree of the ground's polynomials; `NO_VERTICAL` where all are still.

    Returns
    -------
    int
        Whether some lane asks for the driver of single runs.
    """
    widest_registers()
    there = places_of(system_of(lane_of(room, 0, 0)))
    choose_step(lanes, room)
    evaluate_ground(lanes, room, degree_x, 0, fields.MIDDLE_X, fields.END_X)
    if degree_y != NO_VERTICAL:
        evaluate_ground(lanes, room, degree_y, TERMS, fields.MIDDLE_Y, fields.END_Y)
    for lane in range(lanes):
        system = system_of(lane_of(room, there.numbers, lane))
        done = take_step(system, room, lane)
        lane_of(as_integers(room), fields.OWN_WHOLE, lane)[fields.ASKS] = 0 if done else 1
    some = 0
    for lane in range(lanes):
        system = system_of(lane_of(room, there.numbers, lane))
        quiet = is_quiet(system, room, lane)
        own = lane_of(as_integers(room), fields.OWN_WHOLE, lane)
        quiet = quiet & (own[fields.ASKS] == 0)
        accept(system, room, lane, quiet)
        take_end(system, room, lane, quiet)
        asks = 0 if quiet else own[fields.BUSY]
        own[fields.ASKS] = asks
        some |= asks
    return some
