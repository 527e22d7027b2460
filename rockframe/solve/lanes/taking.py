"""Whether the steps of lanes are quiet, and how their ends become the starts of the next ones."""

from rockframe.compiled import Vector, as_integers, inlined, lane_of
from rockframe.dynamics.protocol import Equations, Ground
from rockframe.solve import layout as at
from rockframe.solve.guards import may_fall, put_guards
from rockframe.solve.lanes import fields
from rockframe.solve.lanes.fields import Places, places_of
from rockframe.solve.peaks import rotation_in_step


@inlined
def slides(system: Equations, room: Vector, lane: int) -> bool:
    """Whether an end slides in a lane."""
    return system.some_end_slides(lane_of(as_integers(room), fields.COUNTERS, lane)[at.MODE])


@inlined
def is_quiet(system: Equations, room: Vector, lane: int) -> bool:
    """Whether nothing happens in a lane's step but motion; its guards are written."""
    there = places_of(system)
    own, whole = lane_of(room, fields.OWN, lane), as_integers(room)
    clock, counters = lane_of(room, fields.CLOCK, lane), lane_of(whole, fields.COUNTERS, lane)
    state, new = lane_of(room, there.state, lane), lane_of(room, there.new, lane)
    limits = lane_of(room, fields.LIMITS, lane)
    after, h = lane_of(room, there.after, lane), own[fields.STEP]
    ground = Ground(own[fields.NOW_X], own[fields.NOW_Y])
    held = system.without_sliding(counters[at.MODE])
    found = system.guards_in(held, new, lane_of(room, there.last, lane), ground)
    put_guards(system, found, new, limits, after)
    falls = may_fall(system, h, lane_of(room, there.before, lane), after)
    rotation = rotation_in_step(system, limits, state, new)
    peaks = rotation.may_peak(h, clock[at.PEAK_LEFT], clock[at.PEAK_RIGHT])
    return not (falls | peaks | slides(system, room, lane))


@inlined
def is_spent(room: Vector, lane: int) -> bool:
    """Whether a lane has made all the steps that it may make."""
    counters = lane_of(as_integers(room), fields.COUNTERS, lane)
    return counters[at.STEPS] + counters[at.REJECTED] >= counters[at.MAX_STEPS]


@inlined
def account_for(system: Equations, room: Vector, lane: int) -> None:
    """Write what a step that is taken changes in the account of its run, but the next step."""
    there = places_of(system)
    own, whole = lane_of(room, fields.OWN, lane), as_integers(room)
    clock = lane_of(room, fields.CLOCK, lane)
    start, end, works, new = (
        lane_of(room, there.state, lane), lane_of(room, there.new, lane),
        lane_of(room, there.works, lane), lane_of(room, there.clock, lane),
    )  # fmt: skip
    limits, h = lane_of(room, fields.LIMITS, lane), own[fields.STEP]
    rotation = rotation_in_step(system, limits, start, end)
    flight, flies = clock[at.FLIGHT_TIME], lane_of(whole, fields.OWN_WHOLE, lane)[fields.FLIES]
    supplied = clock[at.SUPPLIED] + works[1]
    new[at.INTO_INTERVAL] = clock[at.INTO_INTERVAL] + h
    new[at.FLIGHT_TIME] = flight + h if flies == 1 else flight
    new[at.PEAK_LEFT] = max(clock[at.PEAK_LEFT], rotation.largest_left())
    new[at.PEAK_RIGHT] = max(clock[at.PEAK_RIGHT], rotation.largest_right())
    new[at.DISSIPATED] = clock[at.DISSIPATED] + works[0]
    new[at.SUPPLIED] = supplied
    new[at.LARGEST_MOVED] = max(clock[at.LARGEST_MOVED], abs(supplied))
    new[at.GROUND_X] = own[fields.NOW_X]
    new[at.GROUND_Y] = own[fields.NOW_Y]


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
def take_step_if_quiet(system: Equations, room: Vector, lane: int) -> None:
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
