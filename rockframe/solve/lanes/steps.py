"""Steps in all lanes at once, of a fixed length or of the Dormand-Prince pair.

The loops over lanes hold nothing but arithmetic on one array, so that they are compiled to
instructions for several lanes at once. A lane does what :func:`rockframe.solve.march.march`
does in a quiet step (one without event, reversal beyond the peaks or sliding), in the same order
and with the same bits. A step that is not quiet is not accepted: the driver of single runs makes
it.
"""

import math
from collections.abc import Callable

from rockframe.compiled import (
    ReadOnlyMatrix,
    Vector,
    as_integers,
    inlined,
    kernel,
    lane_of,
    put,
    widest_registers,
)
from rockframe.dynamics.protocol import POWERS, Equations, Ground
from rockframe.solve import workspace as at
from rockframe.solve.equations import gives_powers
from rockframe.solve.evaluation import CompiledIn, put_guards
from rockframe.solve.lanes import fields
from rockframe.solve.lanes.fields import (
    RECORDED,
    Places,
    enter_intervals,
    evaluate_ground,
    places_of,
)
from rockframe.solve.march import SHORTEST, fit_step, may_fall, rotation_in_step
from rockframe.solve.schemes import (
    NODES,
    STAGE_1,
    STAGE_2,
    STAGE_3,
    STAGE_4,
    STAGE_5,
    STAGE_6,
    STAGES,
    FixedSteps,
    FixedStepsByRates,
    StepsByTolerance,
    adapted,
    begin_stages,
    end_works,
    errors_of_places,
    errors_of_rates,
    fixed_step,
    next_step,
    rest_of,
    stage_places,
    stage_rates,
)
from rockframe.solve.workspace import may_turn


@inlined
def slides(system: Equations, room: Vector, lane: int) -> bool:
    """Whether an end slides in a lane."""
    return system.some_end_slides(lane_of(as_integers(room), fields.COUNTERS, lane)[at.MODE])


@inlined
def is_quiet(system: Equations, room: Vector, lane: int) -> bool:
    """Whether a lane's step is quiet; writes the guards at its end."""
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
    rotation = rotation_in_step(0, system.coordinates(), limits, state, new)
    peaks = rotation.may_peak(h, clock[at.PEAK_LEFT], clock[at.PEAK_RIGHT])
    return not (falls | peaks | slides(system, room, lane))


@kernel
def leave_turns(
    lanes: int, room: Vector, pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix
) -> int:
    """Leave to the driver steps without motion in which the ground may have a peak; give 1 if any.

    At rest the guards follow the ground alone, and may fall inside such a step.
    """
    found = 0
    degree_x, degree_y = pieces_x.shape[1] - 1, pieces_y.shape[1] - 1
    for lane in range(lanes):
        own = lane_of(as_integers(room), fields.OWN_WHOLE, lane)
        x = degree_x if own[fields.COUNT_X] > 0 else 0
        y = degree_y if own[fields.COUNT_Y] > 0 else 0
        rests = (own[fields.ACTIVE] == 0) & (own[fields.BUSY] == 1)
        if rests and may_turn(x, y, lane_of(room, fields.GROUND, lane)):
            own[fields.TAKEN] = 0
            own[fields.ASKS] = found = 1
    return found


@inlined
def is_spent(room: Vector, lane: int) -> bool:
    """Whether a lane has made all the steps that its run may make."""
    counters = lane_of(as_integers(room), fields.COUNTERS, lane)
    return counters[at.STEPS] + counters[at.REJECTED] >= counters[at.MAX_STEPS]


@inlined
def account_for(system: Equations, room: Vector, lane: int) -> None:
    """Write the clock of a lane's run after its step, but for the length of the next step."""
    there = places_of(system)
    own, whole = lane_of(room, fields.OWN, lane), as_integers(room)
    clock = lane_of(room, fields.CLOCK, lane)
    start, end, works, new = (
        lane_of(room, there.state, lane), lane_of(room, there.new, lane),
        lane_of(room, there.works, lane), lane_of(room, there.clock, lane),
    )  # fmt: skip
    limits, h = lane_of(room, fields.LIMITS, lane), own[fields.STEP]
    rotation = rotation_in_step(0, system.coordinates(), limits, start, end)
    flight, flies = clock[at.FLIGHT_TIME], lane_of(whole, fields.OWN_WHOLE, lane)[fields.FLIES]
    supplied = clock[at.SUPPLIED] + works[1]
    new[at.INTO_INTERVAL] = clock[at.INTO_INTERVAL] + h
    new[at.FLIGHT_TIME] = flight + h if flies == 1 else flight
    new[at.PEAK_LEFT] = max(clock[at.PEAK_LEFT], rotation.left)
    new[at.PEAK_RIGHT] = max(clock[at.PEAK_RIGHT], rotation.right)
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
    """Make the end of a step the start of the next one in a lane where it is accepted.

    By bitwise operations: writing under a condition is slow on processors without mask
    registers.
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
def choose_step(room: Vector, lane: int) -> None:
    """Choose the length of a lane's step."""
    clock, controls = lane_of(room, fields.CLOCK, lane), lane_of(room, fields.CONTROLS, lane)
    own = lane_of(room, fields.OWN, lane)
    remaining = own[fields.LENGTH] - clock[at.INTO_INTERVAL]
    requested = fit_step(min(clock[at.NEXT_STEP], controls[at.MAX_STEP]), remaining)
    clock[at.ASKED] = requested
    own[fields.STEP] = min(requested, own[fields.LONGEST])


@inlined
def make_step(scheme: FixedSteps, system: Equations, room: Vector, lane: int) -> bool:
    """Make the step of one lane; return whether its end is finite."""
    there = places_of(system)
    own, whole = lane_of(room, fields.OWN, lane), as_integers(room)
    mode = system.without_sliding(lane_of(whole, fields.COUNTERS, lane)[at.MODE])
    count = lane_of(whole, fields.OWN_WHOLE, lane)[fields.ACTIVE]
    return fixed_step(
        scheme, CompiledIn(system), mode, count, own[fields.STEP],
        Ground(own[fields.MIDDLE_X], own[fields.MIDDLE_Y]),
        Ground(own[fields.NOW_X], own[fields.NOW_Y]),
        lane_of(room, there.state, lane), lane_of(room, there.first, lane),
        lane_of(room, there.new, lane), lane_of(room, there.last, lane),
        lane_of(room, there.stages, lane), lane_of(room, there.works, lane),
    )  # fmt: skip


@inlined
def account_for_rest(system: Equations, room: Vector, lane: int) -> None:
    """Write the clock of a lane's run after its step of fixed length."""
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
    """Move lanes at the end of an interval to the next, then make a step of fixed length in all."""
    return step_lanes_in(FixedSteps(math.inf), system_of, lanes, room, pieces_x, pieces_y)


@inlined
def step_lanes_by_rates(
    system_of: Callable[[Vector], Equations], lanes: int, room: Vector, pieces_x: ReadOnlyMatrix,
    pieces_y: ReadOnlyMatrix,
) -> int:  # fmt: skip
    """Do what :func:`step_lanes` does, for equations that give powers apart."""
    return step_lanes_in(FixedStepsByRates(math.inf), system_of, lanes, room, pieces_x, pieces_y)


@inlined
def step_lanes_in(
    scheme: FixedSteps, system_of: Callable[[Vector], Equations], lanes: int, room: Vector,
    pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix,
) -> int:  # fmt: skip
    """Do what :func:`step_lanes` does, by a scheme; lanes hold their longest steps themselves."""
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
        done = make_step(scheme, system, room, lane)
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
    if max(pieces_x.shape[1], pieces_y.shape[1]) > RECORDED + 1:
        some |= leave_turns(lanes, room, pieces_x, pieces_y)
    for lane in range(lanes):
        account_for_rest(system_of(lane_of(room, there.numbers, lane)), room, lane)
    if some == 0:
        take_steps(lanes, room, there)
        return fields.ALL_QUIET
    for lane in range(lanes):
        take_step_if_quiet(system_of(lane_of(room, there.numbers, lane)), room, lane)
    return fields.SOME_ASK


@inlined
def begin_step(system: Equations, room: Vector, lane: int) -> None:
    """Choose the length of a lane's step, and write its first stage."""
    choose_step(room, lane)
    there = places_of(system)
    begin_stages(
        system, lane_of(room, there.state, lane), lane_of(room, there.first, lane),
        lane_of(room, there.stages, lane),
    )  # fmt: skip


@inlined
def write_places(system: Equations, room: Vector, lane: int, weights: tuple[float, ...]) -> None:
    """Write the coordinates of a lane's stage."""
    there = places_of(system)
    stage_places(
        system, lane_of(as_integers(room), fields.OWN_WHOLE, lane)[fields.ACTIVE],
        lane_of(room, fields.OWN, lane)[fields.STEP], weights, lane_of(room, there.state, lane),
        lane_of(room, there.stages, lane), lane_of(room, there.new, lane),
    )  # fmt: skip


@inlined
def write_rates(system: Equations, room: Vector, lane: int, weights: tuple[float, ...]) -> None:
    """Write the velocities and variables of a lane's stage."""
    there = places_of(system)
    stage_rates(
        system, lane_of(as_integers(room), fields.OWN_WHOLE, lane)[fields.ACTIVE],
        lane_of(room, fields.OWN, lane)[fields.STEP], weights, lane_of(room, there.state, lane),
        lane_of(room, there.stages, lane), lane_of(room, there.new, lane),
    )  # fmt: skip


@inlined
def evaluate_stage(system: Equations, room: Vector, lane: int) -> None:
    """Write the slope of a lane's stage."""
    there, own = places_of(system), lane_of(room, fields.OWN, lane)
    mode = lane_of(as_integers(room), fields.COUNTERS, lane)[at.MODE]
    found = system.accelerate(
        system.without_sliding(mode), lane_of(room, there.new, lane),
        Ground(own[fields.NOW_X], own[fields.NOW_Y]),
    )  # fmt: skip
    put(found, 0, lane_of(room, there.last, lane))


@kernel
def evaluate_stages(
    system_of: Callable[[Vector], Equations], lanes: int, room: Vector, pieces_x: ReadOnlyMatrix,
    pieces_y: ReadOnlyMatrix, s: int,
) -> None:  # fmt: skip
    """Write the slopes of stage `s` in all lanes; not inlined, so that equations compile once."""
    there = places_of(system_of(lane_of(room, 0, 0)))
    system = system_of(lane_of(room, there.numbers, 0))
    slope = system.coordinates() + system.variables() + POWERS
    stage = there.stages + STAGES * system.coordinates() + s * slope
    evaluate_ground(lanes, room, pieces_x, pieces_y, NODES[s], fields.NOW_X, fields.NOW_Y)
    for lane in range(lanes):
        evaluate_stage(system_of(lane_of(room, there.numbers, lane)), room, lane)
    for i in range(lanes * slope):
        room[lanes * stage + i] = room[lanes * there.last + i]


@inlined
def make_stage(
    system_of: Callable[[Vector], Equations], lanes: int, room: Vector, pieces_x: ReadOnlyMatrix,
    pieces_y: ReadOnlyMatrix, weights: tuple[float, ...],
) -> None:  # fmt: skip
    """Make the stage that follows from some weights in all lanes."""
    there = places_of(system_of(lane_of(room, 0, 0)))
    for lane in range(lanes):
        write_places(system_of(lane_of(room, there.numbers, lane)), room, lane, weights)
    for lane in range(lanes):
        write_rates(system_of(lane_of(room, there.numbers, lane)), room, lane, weights)
    evaluate_stages(system_of, lanes, room, pieces_x, pieces_y, len(weights))


@inlined
def write_errors_of_places(system: Equations, room: Vector, lane: int) -> None:
    """Write the errors of a lane's coordinates."""
    there, h = places_of(system), lane_of(room, fields.OWN, lane)[fields.STEP]
    stages, works = lane_of(room, there.stages, lane), lane_of(room, there.works, lane)
    errors_of_places(system, h, stages, works)


@inlined
def write_errors_of_rates(system: Equations, room: Vector, lane: int) -> None:
    """Write the errors of a lane's velocities and variables."""
    there, h = places_of(system), lane_of(room, fields.OWN, lane)[fields.STEP]
    stages, works = lane_of(room, there.stages, lane), lane_of(room, there.works, lane)
    errors_of_rates(system, h, stages, works)


@inlined
def end_step(system: Equations, room: Vector, lane: int) -> None:
    """Write the works of a lane's step, and its largest error over the error allowed."""
    there, own = places_of(system), lane_of(room, fields.OWN, lane)
    clock, works = lane_of(room, fields.CLOCK, lane), lane_of(room, there.works, lane)
    end_works(
        system, own[fields.STEP], lane_of(room, there.stages, lane),
        lane_of(room, there.last, lane), works,
    )  # fmt: skip
    scale = max(clock[at.LARGEST_TERM], clock[at.DISSIPATED], abs(clock[at.SUPPLIED]))
    clock[at.EXCESS] = StepsByTolerance(math.inf).excess_of(
        system, lane_of(as_integers(room), fields.OWN_WHOLE, lane)[fields.ACTIVE], True, scale,
        lane_of(room, there.new, lane), works, lane_of(room, there.reference, lane),
        lane_of(room, fields.CONTROLS, lane),
    )  # fmt: skip


@inlined
def judge(room: Vector, lane: int) -> int:
    """Accept a lane's step, refuse it, or leave it to the driver; return 0 if it is accepted.

    Sliding is left to the driver, whatever the error: lanes compute their steps without it.
    """
    own = lane_of(as_integers(room), fields.OWN_WHOLE, lane)
    accepted = lane_of(room, fields.CLOCK, lane)[at.EXCESS] <= 1.0
    busy, for_driver = own[fields.BUSY], is_spent(room, lane) | (own[fields.ASKS] == 1)
    taken = (own[fields.TAKEN] != 0) & accepted & (not for_driver)
    refused = (not accepted) & (not for_driver)
    own[fields.TAKEN] = -1 if taken else 0
    own[fields.REFUSED] = busy if refused else 0
    own[fields.ASKS] = 0 if taken | refused else busy
    return 0 if taken else busy


@inlined
def keep_sizes(system: Equations, room: Vector, lane: int) -> None:
    """Raise the largest size so far of each element of the state, where the step is accepted."""
    there = places_of(system)
    taken = lane_of(as_integers(room), fields.OWN_WHOLE, lane)[fields.TAKEN] != 0
    new, reference = lane_of(room, there.new, lane), lane_of(room, there.reference, lane)
    for i in range(2 * system.coordinates() + system.variables()):
        size = abs(new[i])
        reference[i] = max(reference[i], size if taken else 0.0)


@inlined
def choose_next(room: Vector, lane: int, there: Places) -> int:
    """Choose a lane's next step after one accepted or refused; return 1 if the driver is needed."""
    clock, controls = lane_of(room, fields.CLOCK, lane), lane_of(room, fields.CONTROLS, lane)
    whole = lane_of(as_integers(room), fields.OWN_WHOLE, lane)
    h, excess = lane_of(room, fields.OWN, lane)[fields.STEP], clock[at.EXCESS]
    if whole[fields.REFUSED] == 1:
        h_next = next_step(h, h, excess)
        if h_next <= SHORTEST * controls[at.DURATION]:
            whole[fields.ASKS] = 1
            return 1
        clock[at.NEXT_STEP] = h_next
        lane_of(as_integers(room), fields.COUNTERS, lane)[at.REJECTED] += 1
    elif whole[fields.TAKEN] != 0:
        new = lane_of(room, there.clock, lane)
        new[at.NEXT_STEP] = adapted(h, clock[at.NEXT_STEP], excess, controls)
    return int(whole[fields.ASKS])


@inlined
def step_lanes_by_tolerance(
    system_of: Callable[[Vector], Equations], lanes: int, room: Vector, pieces_x: ReadOnlyMatrix,
    pieces_y: ReadOnlyMatrix,
) -> int:  # fmt: skip
    """Move lanes at the end of an interval to the next, then try a step by tolerance in all."""
    widest_registers()
    if enter_intervals(lanes, room, pieces_x, pieces_y) == 1:
        return fields.SOME_WAIT
    there = places_of(system_of(lane_of(room, 0, 0)))
    for lane in range(lanes):
        begin_step(system_of(lane_of(room, there.numbers, lane)), room, lane)
    make_stage(system_of, lanes, room, pieces_x, pieces_y, STAGE_1)
    make_stage(system_of, lanes, room, pieces_x, pieces_y, STAGE_2)
    make_stage(system_of, lanes, room, pieces_x, pieces_y, STAGE_3)
    make_stage(system_of, lanes, room, pieces_x, pieces_y, STAGE_4)
    make_stage(system_of, lanes, room, pieces_x, pieces_y, STAGE_5)
    make_stage(system_of, lanes, room, pieces_x, pieces_y, STAGE_6)
    for lane in range(lanes):
        write_errors_of_places(system_of(lane_of(room, there.numbers, lane)), room, lane)
    for lane in range(lanes):
        write_errors_of_rates(system_of(lane_of(room, there.numbers, lane)), room, lane)
    for lane in range(lanes):
        end_step(system_of(lane_of(room, there.numbers, lane)), room, lane)
    for lane in range(lanes):
        system = system_of(lane_of(room, there.numbers, lane))
        own = lane_of(as_integers(room), fields.OWN_WHOLE, lane)
        own[fields.TAKEN] = -1 if is_quiet(system, room, lane) else 0
        own[fields.ASKS] = 1 if slides(system, room, lane) else 0
    if max(pieces_x.shape[1], pieces_y.shape[1]) > RECORDED + 1:
        leave_turns(lanes, room, pieces_x, pieces_y)
    others = 0
    for lane in range(lanes):
        others |= judge(room, lane)
    for lane in range(lanes):
        system = system_of(lane_of(room, there.numbers, lane))
        account_for(system, room, lane)
        keep_sizes(system, room, lane)
    some = 0
    for lane in range(lanes):
        some |= choose_next(room, lane, there)
    if others == 0:
        take_steps(lanes, room, there)
        return fields.ALL_QUIET
    for lane in range(lanes):
        take_step_if_quiet(system_of(lane_of(room, there.numbers, lane)), room, lane)
    return fields.SOME_ASK if some == 1 else fields.ALL_QUIET


def steps_in_lanes(system: Equations, *, fixed_steps: bool) -> Callable[..., int]:
    """Return the function that makes a step in all lanes, for a system and a kind of steps."""
    if not fixed_steps:
        return step_lanes_by_tolerance
    return step_lanes_by_rates if gives_powers(system) else step_lanes
