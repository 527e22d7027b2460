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
from rockframe.solve.equations import has_powers
from rockframe.solve.evaluation import InlinedEquations, put_guards
from rockframe.solve.lanes import fields
from rockframe.solve.lanes.fields import (
    RECORD_DEGREE,
    FieldIndices,
    enter_intervals,
    evaluate_ground,
    field_indices,
)
from rockframe.solve.march import SHORTEST_STEP, fit_step, rotation_in_step, some_guard_may_fall
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
    adapted_step,
    make_fixed_step,
    next_step,
    remaining_step,
    write_coordinate_errors,
    write_first_stage,
    write_rate_errors,
    write_stage_coordinates,
    write_stage_rates,
    write_works,
)
from rockframe.solve.workspace import ground_may_peak, steps_made


@inlined
def is_sliding(system: Equations, data: Vector, lane: int) -> bool:
    """Whether an end slides in a lane."""
    return system.some_end_slides(lane_of(as_integers(data), fields.COUNTERS, lane)[at.MODE])


@inlined
def is_quiet(system: Equations, data: Vector, lane: int) -> bool:
    """Whether a lane's step is quiet; writes the guards at its end."""
    indices = field_indices(system)
    own, integers = lane_of(data, fields.OWN, lane), as_integers(data)
    clock, counters = lane_of(data, fields.CLOCK, lane), lane_of(integers, fields.COUNTERS, lane)
    state, new = lane_of(data, indices.state, lane), lane_of(data, indices.new_state, lane)
    limits = lane_of(data, fields.LIMITS, lane)
    after, h = lane_of(data, indices.new_guards, lane), own[fields.STEP]
    ground = Ground(own[fields.STAGE_X], own[fields.STAGE_Y])
    held = system.without_sliding(counters[at.MODE])
    guards = system.guards_in(held, new, lane_of(data, indices.new_slope, lane), ground)
    put_guards(system, guards, new, limits, after)
    falls = some_guard_may_fall(system, h, lane_of(data, indices.guards, lane), after)
    rotation = rotation_in_step(0, system.coordinates(), limits, state, new)
    peaks = rotation.may_peak(h, clock[at.PEAK_LEFT], clock[at.PEAK_RIGHT])
    return not (falls | peaks | is_sliding(system, data, lane))


@kernel
def leave_ground_peaks(
    lanes: int, data: Vector, pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix
) -> int:
    """Leave to the driver steps without motion in which the ground may have a peak; give 1 if any.

    At rest the guards follow the ground alone, and may fall inside such a step.
    """
    some = 0
    degree_x, degree_y = pieces_x.shape[1] - 1, pieces_y.shape[1] - 1
    for lane in range(lanes):
        own = lane_of(as_integers(data), fields.OWN_INTEGERS, lane)
        x = degree_x if own[fields.COUNT_X] > 0 else 0
        y = degree_y if own[fields.COUNT_Y] > 0 else 0
        rests = (own[fields.MOVING] == 0) & (own[fields.BUSY] == 1)
        if rests and ground_may_peak(x, y, lane_of(data, fields.GROUND, lane)):
            own[fields.ACCEPTED] = 0
            own[fields.NEEDS_DRIVER] = some = 1
    return some


@inlined
def has_reached_step_limit(data: Vector, lane: int) -> bool:
    """Whether a lane has made all the steps that its run may make."""
    counters = lane_of(as_integers(data), fields.COUNTERS, lane)
    return steps_made(counters) >= counters[at.MAX_STEPS]


@inlined
def write_new_clock(system: Equations, data: Vector, lane: int) -> None:
    """Write the clock of a lane's run after its step, but for the length of the next step."""
    indices = field_indices(system)
    own, integers = lane_of(data, fields.OWN, lane), as_integers(data)
    clock = lane_of(data, fields.CLOCK, lane)
    start, end, works, new = (
        lane_of(data, indices.state, lane), lane_of(data, indices.new_state, lane),
        lane_of(data, indices.works, lane), lane_of(data, indices.clock, lane),
    )  # fmt: skip
    limits, h = lane_of(data, fields.LIMITS, lane), own[fields.STEP]
    rotation = rotation_in_step(0, system.coordinates(), limits, start, end)
    flight = clock[at.FLIGHT_TIME]
    flies = lane_of(integers, fields.OWN_INTEGERS, lane)[fields.IN_FLIGHT]
    supplied = clock[at.SUPPLIED] + works[1]
    new[at.INTO_INTERVAL] = clock[at.INTO_INTERVAL] + h
    new[at.FLIGHT_TIME] = flight + h if flies == 1 else flight
    new[at.PEAK_LEFT] = max(clock[at.PEAK_LEFT], rotation.left)
    new[at.PEAK_RIGHT] = max(clock[at.PEAK_RIGHT], rotation.right)
    new[at.DISSIPATED] = clock[at.DISSIPATED] + works[0]
    new[at.SUPPLIED] = supplied
    new[at.LARGEST_ENERGY] = max(clock[at.LARGEST_ENERGY], abs(supplied))
    new[at.GROUND_X] = own[fields.STAGE_X]
    new[at.GROUND_Y] = own[fields.STAGE_Y]


@inlined
def accept_steps(lanes: int, data: Vector, indices: FieldIndices) -> None:
    """Make the end of a step the start of the next one, in all lanes."""
    for i in range(lanes * (indices.new_state - indices.state)):
        data[lanes * indices.state + i] = data[lanes * indices.new_state + i]
    for i in range(lanes * at.STEP_CLOCK):
        data[lanes * fields.CLOCK + i] = data[lanes * indices.clock + i]
    for lane in range(lanes):
        lane_of(as_integers(data), fields.COUNTERS, lane)[at.STEPS] += 1


@inlined
def accept_step_if_quiet(system: Equations, data: Vector, lane: int) -> None:
    """Make the end of a step the start of the next one in a lane where it is accepted.

    By bitwise operations: writing under a condition is slow on processors without mask
    registers.
    """
    indices, integers = field_indices(system), as_integers(data)
    accepted_bits = lane_of(integers, fields.OWN_INTEGERS, lane)[fields.ACCEPTED]
    start, end = lane_of(integers, indices.state, lane), lane_of(integers, indices.new_state, lane)
    clock, new = lane_of(integers, fields.CLOCK, lane), lane_of(integers, indices.clock, lane)
    for i in range(indices.new_state - indices.state):
        start[i] = (end[i] & accepted_bits) | (start[i] & ~accepted_bits)
    for i in range(at.STEP_CLOCK):
        clock[i] = (new[i] & accepted_bits) | (clock[i] & ~accepted_bits)
    lane_of(integers, fields.COUNTERS, lane)[at.STEPS] -= accepted_bits


@inlined
def choose_step(data: Vector, lane: int) -> None:
    """Choose the length of a lane's step."""
    clock, controls = lane_of(data, fields.CLOCK, lane), lane_of(data, fields.CONTROLS, lane)
    own = lane_of(data, fields.OWN, lane)
    remaining = own[fields.LENGTH] - clock[at.INTO_INTERVAL]
    requested = fit_step(min(clock[at.NEXT_STEP], controls[at.MAX_STEP]), remaining)
    clock[at.REQUESTED] = requested
    own[fields.STEP] = min(requested, own[fields.LONGEST_STEP])


@inlined
def make_step(scheme: FixedSteps, system: Equations, data: Vector, lane: int) -> bool:
    """Make the step of one lane; return whether its end is finite."""
    indices = field_indices(system)
    own, integers = lane_of(data, fields.OWN, lane), as_integers(data)
    mode = system.without_sliding(lane_of(integers, fields.COUNTERS, lane)[at.MODE])
    count = lane_of(integers, fields.OWN_INTEGERS, lane)[fields.MOVING]
    return make_fixed_step(
        scheme, InlinedEquations(system), mode, count, own[fields.STEP],
        Ground(own[fields.MIDDLE_X], own[fields.MIDDLE_Y]),
        Ground(own[fields.STAGE_X], own[fields.STAGE_Y]),
        lane_of(data, indices.state, lane), lane_of(data, indices.slope, lane),
        lane_of(data, indices.new_state, lane), lane_of(data, indices.new_slope, lane),
        lane_of(data, indices.stages, lane), lane_of(data, indices.works, lane),
    )  # fmt: skip


@inlined
def write_fixed_step_clock(system: Equations, data: Vector, lane: int) -> None:
    """Write the clock of a lane's run after its step of fixed length."""
    clock, controls = lane_of(data, fields.CLOCK, lane), lane_of(data, fields.CONTROLS, lane)
    h = lane_of(data, fields.OWN, lane)[fields.STEP]
    new = lane_of(data, field_indices(system).clock, lane)
    write_new_clock(system, data, lane)
    new[at.NEXT_STEP] = remaining_step(
        clock[at.REQUESTED], h, SHORTEST_STEP * controls[at.DURATION], controls
    )


@inlined
def step_lanes(
    system_of: Callable[[Vector], Equations], lanes: int, data: Vector,
    pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix,
) -> int:  # fmt: skip
    """Move lanes at the end of an interval to the next, then make a step of fixed length in all."""
    return step_lanes_with(FixedSteps(math.inf), system_of, lanes, data, pieces_x, pieces_y)


@inlined
def step_lanes_by_rates(
    system_of: Callable[[Vector], Equations], lanes: int, data: Vector,
    pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix,
) -> int:  # fmt: skip
    """Do what :func:`step_lanes` does, for equations that give powers apart."""
    return step_lanes_with(FixedStepsByRates(math.inf), system_of, lanes, data, pieces_x, pieces_y)


@inlined
def step_lanes_with(
    scheme: FixedSteps, system_of: Callable[[Vector], Equations], lanes: int, data: Vector,
    pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix,
) -> int:  # fmt: skip
    """Do what :func:`step_lanes` does, by a scheme; lanes hold their longest steps themselves."""
    widest_registers()
    if enter_intervals(lanes, data, pieces_x, pieces_y) == 1:
        return fields.NO_STEP_MADE
    indices = field_indices(system_of(lane_of(data, 0, 0)))
    for lane in range(lanes):
        choose_step(data, lane)
    evaluate_ground(lanes, data, pieces_x, pieces_y, 0.5, fields.MIDDLE_X, fields.MIDDLE_Y)
    evaluate_ground(lanes, data, pieces_x, pieces_y, 1.0, fields.STAGE_X, fields.STAGE_Y)
    for lane in range(lanes):
        system = system_of(lane_of(data, indices.numbers, lane))
        finite = make_step(scheme, system, data, lane)
        lane_of(as_integers(data), fields.OWN_INTEGERS, lane)[fields.REJECTED] = 0 if finite else 1
    some_need_driver = 0
    for lane in range(lanes):
        system = system_of(lane_of(data, indices.numbers, lane))
        own = lane_of(as_integers(data), fields.OWN_INTEGERS, lane)
        quiet = is_quiet(system, data, lane) & (own[fields.REJECTED] == 0)
        quiet = quiet & (not has_reached_step_limit(data, lane))
        needs_driver = 0 if quiet else own[fields.BUSY]
        own[fields.ACCEPTED] = -1 if quiet else 0
        own[fields.NEEDS_DRIVER] = needs_driver
        some_need_driver |= needs_driver
    if max(pieces_x.shape[1], pieces_y.shape[1]) > RECORD_DEGREE + 1:
        some_need_driver |= leave_ground_peaks(lanes, data, pieces_x, pieces_y)
    for lane in range(lanes):
        write_fixed_step_clock(system_of(lane_of(data, indices.numbers, lane)), data, lane)
    if some_need_driver == 0:
        accept_steps(lanes, data, indices)
        return fields.ALL_QUIET
    for lane in range(lanes):
        accept_step_if_quiet(system_of(lane_of(data, indices.numbers, lane)), data, lane)
    return fields.SOME_NEED_DRIVER


@inlined
def begin_step(system: Equations, data: Vector, lane: int) -> None:
    """Choose the length of a lane's step, and write its first stage."""
    choose_step(data, lane)
    indices = field_indices(system)
    write_first_stage(
        system, lane_of(data, indices.state, lane), lane_of(data, indices.slope, lane),
        lane_of(data, indices.stages, lane),
    )  # fmt: skip


@inlined
def write_lane_coordinates(
    system: Equations, data: Vector, lane: int, weights: tuple[float, ...]
) -> None:
    """Write the coordinates of a lane's stage."""
    indices = field_indices(system)
    write_stage_coordinates(
        system, lane_of(as_integers(data), fields.OWN_INTEGERS, lane)[fields.MOVING],
        lane_of(data, fields.OWN, lane)[fields.STEP], weights,
        lane_of(data, indices.state, lane), lane_of(data, indices.stages, lane),
        lane_of(data, indices.new_state, lane),
    )  # fmt: skip


@inlined
def write_lane_rates(
    system: Equations, data: Vector, lane: int, weights: tuple[float, ...]
) -> None:
    """Write the velocities and variables of a lane's stage."""
    indices = field_indices(system)
    write_stage_rates(
        system, lane_of(as_integers(data), fields.OWN_INTEGERS, lane)[fields.MOVING],
        lane_of(data, fields.OWN, lane)[fields.STEP], weights,
        lane_of(data, indices.state, lane), lane_of(data, indices.stages, lane),
        lane_of(data, indices.new_state, lane),
    )  # fmt: skip


@inlined
def evaluate_stage(system: Equations, data: Vector, lane: int) -> None:
    """Write the slope of a lane's stage."""
    indices, own = field_indices(system), lane_of(data, fields.OWN, lane)
    mode = lane_of(as_integers(data), fields.COUNTERS, lane)[at.MODE]
    slope = system.accelerate(
        system.without_sliding(mode), lane_of(data, indices.new_state, lane),
        Ground(own[fields.STAGE_X], own[fields.STAGE_Y]),
    )  # fmt: skip
    put(slope, 0, lane_of(data, indices.new_slope, lane))


@kernel
def evaluate_stages(
    system_of: Callable[[Vector], Equations], lanes: int, data: Vector,
    pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix, s: int,
) -> None:  # fmt: skip
    """Write the slopes of stage `s` in all lanes; not inlined, so that equations compile once."""
    indices = field_indices(system_of(lane_of(data, 0, 0)))
    system = system_of(lane_of(data, indices.numbers, 0))
    slope = system.coordinates() + system.variables() + POWERS
    stage = indices.stages + STAGES * system.coordinates() + s * slope
    evaluate_ground(lanes, data, pieces_x, pieces_y, NODES[s], fields.STAGE_X, fields.STAGE_Y)
    for lane in range(lanes):
        evaluate_stage(system_of(lane_of(data, indices.numbers, lane)), data, lane)
    for i in range(lanes * slope):
        data[lanes * stage + i] = data[lanes * indices.new_slope + i]


@inlined
def make_stage(
    system_of: Callable[[Vector], Equations], lanes: int, data: Vector,
    pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix, weights: tuple[float, ...],
) -> None:  # fmt: skip
    """Make the stage that follows from some weights in all lanes."""
    indices = field_indices(system_of(lane_of(data, 0, 0)))
    for lane in range(lanes):
        write_lane_coordinates(system_of(lane_of(data, indices.numbers, lane)), data, lane, weights)
    for lane in range(lanes):
        write_lane_rates(system_of(lane_of(data, indices.numbers, lane)), data, lane, weights)
    evaluate_stages(system_of, lanes, data, pieces_x, pieces_y, len(weights))


@inlined
def write_lane_coordinate_errors(system: Equations, data: Vector, lane: int) -> None:
    """Write the errors of a lane's coordinates."""
    indices, h = field_indices(system), lane_of(data, fields.OWN, lane)[fields.STEP]
    stages, works = lane_of(data, indices.stages, lane), lane_of(data, indices.works, lane)
    write_coordinate_errors(system, h, stages, works)


@inlined
def write_lane_rate_errors(system: Equations, data: Vector, lane: int) -> None:
    """Write the errors of a lane's velocities and variables."""
    indices, h = field_indices(system), lane_of(data, fields.OWN, lane)[fields.STEP]
    stages, works = lane_of(data, indices.stages, lane), lane_of(data, indices.works, lane)
    write_rate_errors(system, h, stages, works)


@inlined
def end_step(system: Equations, data: Vector, lane: int) -> None:
    """Write the works of a lane's step, and its largest error over the error allowed."""
    indices, own = field_indices(system), lane_of(data, fields.OWN, lane)
    clock, works = lane_of(data, fields.CLOCK, lane), lane_of(data, indices.works, lane)
    write_works(
        system, own[fields.STEP], lane_of(data, indices.stages, lane),
        lane_of(data, indices.new_slope, lane), works,
    )  # fmt: skip
    scale = max(clock[at.LARGEST_TERM], clock[at.DISSIPATED], abs(clock[at.SUPPLIED]))
    clock[at.ERROR_NORM] = StepsByTolerance(math.inf).error_norm_of(
        system, lane_of(as_integers(data), fields.OWN_INTEGERS, lane)[fields.MOVING], True,
        scale, lane_of(data, indices.new_state, lane), works,
        lane_of(data, indices.reference, lane), lane_of(data, fields.CONTROLS, lane),
    )  # fmt: skip


@inlined
def accept_or_reject(data: Vector, lane: int) -> int:
    """Accept a lane's step, refuse it, or leave it to the driver; return 0 if it is accepted.

    Sliding is left to the driver, whatever the error: lanes compute their steps without it.
    """
    own = lane_of(as_integers(data), fields.OWN_INTEGERS, lane)
    within_tolerance = lane_of(data, fields.CLOCK, lane)[at.ERROR_NORM] <= 1.0
    busy = own[fields.BUSY]
    for_driver = has_reached_step_limit(data, lane) | (own[fields.NEEDS_DRIVER] == 1)
    accepted = (own[fields.ACCEPTED] != 0) & within_tolerance & (not for_driver)
    rejected = (not within_tolerance) & (not for_driver)
    own[fields.ACCEPTED] = -1 if accepted else 0
    own[fields.REJECTED] = busy if rejected else 0
    own[fields.NEEDS_DRIVER] = 0 if accepted | rejected else busy
    return 0 if accepted else busy


@inlined
def update_reference(system: Equations, data: Vector, lane: int) -> None:
    """Raise the largest size so far of each element of the state, where the step is accepted."""
    indices = field_indices(system)
    accepted = lane_of(as_integers(data), fields.OWN_INTEGERS, lane)[fields.ACCEPTED] != 0
    new, reference = lane_of(data, indices.new_state, lane), lane_of(data, indices.reference, lane)
    for i in range(2 * system.coordinates() + system.variables()):
        size = abs(new[i])
        reference[i] = max(reference[i], size if accepted else 0.0)


@inlined
def choose_next_step(data: Vector, lane: int, indices: FieldIndices) -> int:
    """Choose a lane's next step after one accepted or refused; return 1 if the driver is needed."""
    clock, controls = lane_of(data, fields.CLOCK, lane), lane_of(data, fields.CONTROLS, lane)
    integers = lane_of(as_integers(data), fields.OWN_INTEGERS, lane)
    h, error_norm = lane_of(data, fields.OWN, lane)[fields.STEP], clock[at.ERROR_NORM]
    if integers[fields.REJECTED] == 1:
        h_next = next_step(h, h, error_norm)
        if h_next <= SHORTEST_STEP * controls[at.DURATION]:
            integers[fields.NEEDS_DRIVER] = 1
            return 1
        clock[at.NEXT_STEP] = h_next
        lane_of(as_integers(data), fields.COUNTERS, lane)[at.REJECTED] += 1
    elif integers[fields.ACCEPTED] != 0:
        new = lane_of(data, indices.clock, lane)
        new[at.NEXT_STEP] = adapted_step(h, clock[at.NEXT_STEP], error_norm, controls)
    return int(integers[fields.NEEDS_DRIVER])


@inlined
def step_lanes_by_tolerance(
    system_of: Callable[[Vector], Equations], lanes: int, data: Vector,
    pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix,
) -> int:  # fmt: skip
    """Move lanes at the end of an interval to the next, then try a step by tolerance in all."""
    widest_registers()
    if enter_intervals(lanes, data, pieces_x, pieces_y) == 1:
        return fields.NO_STEP_MADE
    indices = field_indices(system_of(lane_of(data, 0, 0)))
    for lane in range(lanes):
        begin_step(system_of(lane_of(data, indices.numbers, lane)), data, lane)
    make_stage(system_of, lanes, data, pieces_x, pieces_y, STAGE_1)
    make_stage(system_of, lanes, data, pieces_x, pieces_y, STAGE_2)
    make_stage(system_of, lanes, data, pieces_x, pieces_y, STAGE_3)
    make_stage(system_of, lanes, data, pieces_x, pieces_y, STAGE_4)
    make_stage(system_of, lanes, data, pieces_x, pieces_y, STAGE_5)
    make_stage(system_of, lanes, data, pieces_x, pieces_y, STAGE_6)
    for lane in range(lanes):
        write_lane_coordinate_errors(system_of(lane_of(data, indices.numbers, lane)), data, lane)
    for lane in range(lanes):
        write_lane_rate_errors(system_of(lane_of(data, indices.numbers, lane)), data, lane)
    for lane in range(lanes):
        end_step(system_of(lane_of(data, indices.numbers, lane)), data, lane)
    for lane in range(lanes):
        system = system_of(lane_of(data, indices.numbers, lane))
        own = lane_of(as_integers(data), fields.OWN_INTEGERS, lane)
        own[fields.ACCEPTED] = -1 if is_quiet(system, data, lane) else 0
        own[fields.NEEDS_DRIVER] = 1 if is_sliding(system, data, lane) else 0
    if max(pieces_x.shape[1], pieces_y.shape[1]) > RECORD_DEGREE + 1:
        leave_ground_peaks(lanes, data, pieces_x, pieces_y)
    not_accepted = 0
    for lane in range(lanes):
        not_accepted |= accept_or_reject(data, lane)
    for lane in range(lanes):
        system = system_of(lane_of(data, indices.numbers, lane))
        write_new_clock(system, data, lane)
        update_reference(system, data, lane)
    some_need_driver = 0
    for lane in range(lanes):
        some_need_driver |= choose_next_step(data, lane, indices)
    if not_accepted == 0:
        accept_steps(lanes, data, indices)
        return fields.ALL_QUIET
    for lane in range(lanes):
        accept_step_if_quiet(system_of(lane_of(data, indices.numbers, lane)), data, lane)
    return fields.SOME_NEED_DRIVER if some_need_driver == 1 else fields.ALL_QUIET


def steps_in_lanes(system: Equations, *, fixed_steps: bool) -> Callable[..., int]:
    """Return the function that makes a step in all lanes, for a system and a kind of steps."""
    if not fixed_steps:
        return step_lanes_by_tolerance
    return step_lanes_by_rates if has_powers(system) else step_lanes
