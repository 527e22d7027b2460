"""Events of a body on its base: separation, landing, change of the held point, sliding.

Written once for all scenes. `system` is all bodies together, which gives the response of their
velocities to an impulse; `part` is the body in question with its base, and `k` its number in the
system. Re-pinning, the impulse of a new held point: :eq:`eq-repinning`; impact :eq:`eq-impact`,
partial hold :eq:`eq-partial-hold`, leaving :eq:`eq-leaving-into-flight`.
"""

from rockframe.compiled import Vector, kernel
from rockframe.dynamics.bodies import Bodies
from rockframe.dynamics.body import (
    PIVOT_CENTRE,
    PIVOT_LEFT,
    PIVOT_RIGHT,
    BodyState,
    leading_pivot,
    with_accelerations,
)
from rockframe.dynamics.events import (
    IMPACT,
    PIVOT_CHANGE,
    REENGAGEMENT,
    SEPARATION,
    SILENT,
)
from rockframe.dynamics.on_base import (
    HOLD,
    LIFT_OFF_NOISE,
    PIVOT,
    SLIP,
    BodyOnBase,
    Mode,
    blend,
    is_lifted,
    share_at_lift_off,
    speed_noise,
)
from rockframe.dynamics.pads import ENGAGING, LEAVING, TOUCHING
from rockframe.dynamics.protocol import (
    HELD_PLACE,
    IMPACT_LOSS,
    LAST_EVENT,
    REPINNING_LOSS,
    Ground,
)


@kernel
def has_same_hold(part: BodyOnBase, first: Mode, second: Mode) -> bool:
    """Whether two modes hold a body at the same point, or both at none."""
    if part.is_free(first) or part.is_free(second):
        return part.is_free(first) and part.is_free(second)
    return first.pivot == second.pivot


@kernel
def end_speed(part: BodyOnBase, left: bool, state: BodyState) -> tuple[float, float]:
    """Return the speed of an end of the base, and its rounding noise."""
    line = part.body.base_line_at(state)
    lever = line.left_lever if left else line.right_lever
    noise = speed_noise(state.vertical_velocity, lever, state.angular_velocity)
    return line.left_speed if left else line.right_speed, noise


@kernel
def set_end_speed(
    system: Bodies, part: BodyOnBase, k: int, left: bool, speed: float, direction: float,
    state: Vector,
) -> None:  # fmt: skip
    """Set the speed of an end to `speed`, shifted by its rounding noise in a direction."""
    present, noise = end_speed(part, left, system.state_of(k, state))
    shift = direction * max(noise, part.base.least_landing())
    system.shift_vertical(k, 0.0, speed + shift - present, state)


@kernel
def following_speed(system: Bodies, part: BodyOnBase, k: int, left: bool, state: Vector) -> float:
    """Return the upward speed of an end that moves with its base without a force [m s^-1]."""
    line = part.body.base_line_at(system.state_of(k, state))
    own = part.base.read(state, system.base_variable_index(k))
    return part.base.following_speed(left, line, own)


@kernel
def repin(
    system: Bodies, part: BodyOnBase, k: int, old: int, new: int, state: Vector, memory: Vector
) -> float:
    """Project the momentum on the horizontal restraint of a new mode, :eq:`eq-repinning`.

    Return the impulse of the restraint; the energy lost is half its product with the slip that it
    stops.
    """
    body = system.state_of(k, state)
    attitude = part.body.attitude(body.rotation)
    place = system.centre_position(k, old, state, memory)
    velocity = part.horizontal_velocity(system.body_mode(old, k), body, attitude)
    mode = system.body_mode(new, k)
    if part.is_free(mode):
        system.set_horizontal(k, place, velocity, state)
        return 0.0
    pin = part.body.pin(mode.pivot)
    memory[HELD_PLACE + k] = place - part.body.about_pin(pin, attitude)
    slip = velocity - part.body.reach(pin, attitude).derivative * body.angular_velocity
    response = system.response(k, new, 0.0, 0.0, slip, state)
    system.respond(k, new, response, state)
    memory[REPINNING_LOSS] -= 0.5 * response.restraint * slip
    return response.restraint


@kernel
def lift_per_slip(system: Bodies, part: BodyOnBase, k: int, mode: int, state: Vector) -> float:
    """Return the upward speed of a sliding end by a hold's impulse that adds a slip of 1 [1]."""
    was = system.body_mode(mode, k)
    held = system.with_body_mode(mode, k, Mode(was.contact, was.pivot, False))
    line = part.body.base_line_at(system.state_of(k, state))
    left = part.base.is_held(was.contact, True)
    response = system.response(k, held, 0.0, 0.0, -1.0, state)
    lever = line.left_lever if left else line.right_lever
    return response.vertical + lever * response.rotation


@kernel
def apply_impact(
    system: Bodies, part: BodyOnBase, k: int, mode: int, left: bool, right: bool, state: Vector,
    memory: Vector,
) -> None:  # fmt: skip
    """Reduce the speeds of the landing ends by the factors eps, :eq:`eq-impact`."""
    line = part.body.base_line_at(system.state_of(k, state))
    gain_left = -(1.0 - part.base.rebound(True)) * min(line.left_speed, 0.0)
    gain_right = -(1.0 - part.base.rebound(False)) * min(line.right_speed, 0.0)
    # changes of the ends' speeds by unit impulses at either end
    at_left = system.response(k, mode, 1.0, line.left_lever, 0.0, state)
    at_right = system.response(k, mode, 1.0, line.right_lever, 0.0, state)
    left_left = at_left.vertical + line.left_lever * at_left.rotation
    right_right = at_right.vertical + line.right_lever * at_right.rotation
    mixed = at_right.vertical + line.left_lever * at_right.rotation
    on_left = on_right = 0.0
    if left and right:
        determinant = left_left * right_right - mixed * mixed
        on_left = (right_right * gain_left - mixed * gain_right) / determinant
        on_right = (left_left * gain_right - mixed * gain_left) / determinant
    elif left:
        on_left = gain_left / left_left
    else:
        on_right = gain_right / right_right
    moment = on_left * line.left_lever + on_right * line.right_lever
    response = system.response(k, mode, on_left + on_right, moment, 0.0, state)
    system.respond(k, mode, response, state)
    system.record_impulse(k, on_left + on_right, moment, 0.0)
    # work of the impulses, at the mean of each end's speeds before and after
    after = part.body.base_line_at(system.state_of(k, state))
    memory[IMPACT_LOSS] -= 0.5 * (
        on_left * (line.left_speed + after.left_speed)
        + on_right * (line.right_speed + after.right_speed)
    )


@kernel
def repin_at_landing(
    system: Bodies, part: BodyOnBase, k: int, old: int, new: int, left: bool, target: float,
    state: Vector, memory: Vector,
) -> bool:  # fmt: skip
    """Hold a body that lands on one end after flight; return whether it slides.

    The hold's impulse ends where the end has reached the speed `target`, at which the base no
    longer presses, :eq:`eq-partial-hold`.
    """
    speed, _ = end_speed(part, left, system.state_of(k, state))
    before = system.velocities(state)
    lost, place = memory[REPINNING_LOSS], memory[HELD_PLACE + k]
    old_horizontal = system.state_of(k, state).horizontal
    hold = repin(system, part, k, old, new, state, memory)
    body = system.state_of(k, state)
    held_speed, noise = end_speed(part, left, body)
    speed, after = speed - target, held_speed - target
    noise = max(noise, part.base.least_landing())
    idle = target > 0.0 and after - speed <= noise  # no slip to stop: forces decide
    if idle or not is_lifted(speed, after, noise):
        return False
    share = share_at_lift_off(speed, after)
    attitude = part.body.attitude(body.rotation)
    held = part.horizontal_velocity(system.body_mode(new, k), body, attitude)
    system.set_horizontal(k, old_horizontal, held, state)
    system.blend_velocities(before, share, state)
    system.record_impulse(k, 0.0, 0.0, share * hold)
    memory[HELD_PLACE + k] = place
    # a share of a plastic impulse takes more than this share of the energy
    memory[REPINNING_LOSS] = blend(lost, memory[REPINNING_LOSS], share * (2.0 - share))
    end, _ = end_speed(part, left, system.state_of(k, state))
    system.shift_vertical(k, 0.0, target - end, state)
    return True


@kernel
def rebounds_negligibly(
    system: Bodies, part: BodyOnBase, k: int, left: bool, speed: float, mode: int, state: Vector,
    ground: Ground,
) -> bool:  # fmt: skip
    """Whether an end with this upward speed falls back after a negligible rise."""
    rises = system.end_accelerations(k, mode, state, ground)
    return part.body.returns_at_once(speed, -(rises[0] if left else rises[1]))


@kernel
def stop_negligible_rebound(
    system: Bodies, part: BodyOnBase, k: int, left: bool, mode: int, state: Vector, ground: Ground,
    memory: Vector,
) -> None:  # fmt: skip
    """Stop an end whose rebound after landing is negligible, by an impulse."""
    line = part.body.base_line_at(system.state_of(k, state))
    speed, lever = line.left_speed, line.left_lever
    if not left:
        speed, lever = line.right_speed, line.right_lever
    if speed <= 0.0 or not rebounds_negligibly(system, part, k, left, speed, mode, state, ground):
        return
    response = system.response(k, mode, 1.0, lever, 0.0, state)
    impulse = -speed / (response.vertical + lever * response.rotation)
    response = system.response(k, mode, impulse, impulse * lever, 0.0, state)
    system.respond(k, mode, response, state)
    memory[IMPACT_LOSS] -= 0.5 * impulse * speed


@kernel
def mode_after_separation(
    system: Bodies, part: BodyOnBase, k: int, left: bool, mode: int, new: int, state: Vector,
    ground: Ground, memory: Vector,
) -> int:  # fmt: skip
    """Return the mode after an end has lifted off, with its new held point.

    An end that its base would press again in flight slides, :eq:`eq-leaving-into-flight`. If the
    impulse of the new held point leaves it pressed, it lifts off once its base has lost its force.
    If this impulse would end its rise, the end would be held again at the same instant, endlessly:
    then it stays held without a force if its base presses, or else rises with the old held point.
    """
    was, new_body_mode = system.body_mode(mode, k), system.body_mode(new, k)
    repins = not has_same_hold(part, was, new_body_mode)
    before = system.velocities(state)
    lost, place = memory[REPINNING_LOSS], memory[HELD_PLACE + k]
    if repins:
        repin(system, part, k, mode, new, state, memory)
    flies = part.flies(new_body_mode.contact)
    line = part.body.base_line_at(system.state_of(k, state))
    own = part.base.read(state, system.base_variable_index(k))
    presses = part.base.presses(new_body_mode.contact, left, line, own)
    speed, noise = end_speed(part, left, system.state_of(k, state))
    rises = not repins or flies or speed > noise
    if rises and repins and not flies:
        rises = not rebounds_negligibly(system, part, k, left, speed, new, state, ground)
    if not rises:
        system.blend_velocities(before, 0.0, state)
        memory[REPINNING_LOSS], memory[HELD_PLACE + k] = lost, place
        if not presses:
            return system.with_body_mode(new, k, Mode(new_body_mode.contact, was.pivot, was.slides))
        memory[LAST_EVENT] = SILENT
        speed = following_speed(system, part, k, left, state)
        set_end_speed(system, part, k, left, speed, 1.0, state)
        contact = part.base.with_end(was.contact, left, ENGAGING)
        return system.with_body_mode(mode, k, Mode(contact, was.pivot, was.slides))
    if presses and flies and not part.base.touches(was.contact, not left):
        rises = system.end_accelerations(k, new, state, ground)
        if part.base.will_press(left, with_accelerations(line, rises[0], rises[1]), own):
            contact = part.base.with_end(new_body_mode.contact, left, TOUCHING)
            return system.with_body_mode(new, k, Mode(contact, was.pivot, True))
    elif presses and repins and not flies:
        waiting = part.base.with_end(new_body_mode.contact, left, LEAVING)
        return system.with_body_mode(new, k, Mode(waiting, new_body_mode.pivot, False))
    return new


@kernel
def switch_end(
    system: Bodies, part: BodyOnBase, k: int, left: bool, which: int, mode: int, state: Vector,
    ground: Ground, memory: Vector,
) -> int:  # fmt: skip
    """Carry out the switch of an end's contact with its base; return the new mode."""
    was = system.body_mode(mode, k)
    line = part.body.base_line_at(system.state_of(k, state))
    own = part.base.read(state, system.base_variable_index(k))
    event = part.base.switch(was.contact, left, which, line, own)
    memory[LAST_EVENT] = event.event
    if event.crossed:
        # the crossed level is set exactly, so that rounding cannot undo the switch
        system.shift_vertical(k, part.base.level(left, line, own), 0.0, state)
    if event.event == SILENT:
        return system.with_body_mode(mode, k, Mode(event.contact, was.pivot, was.slides))
    new_body_mode = part.mode_for_contact(event.contact, system.state_of(k, state))
    new = system.with_body_mode(mode, k, new_body_mode)
    if event.event == SEPARATION:
        return mode_after_separation(system, part, k, left, mode, new, state, ground, memory)
    flies = part.flies(was.contact)
    both = flies and part.base.is_held(new_body_mode.contact, not left)
    if flies and not both:
        target = 0.0
        if event.event == REENGAGEMENT:
            target = following_speed(system, part, k, left, state)
        if repin_at_landing(system, part, k, mode, new, left, target, state, memory):
            return system.with_body_mode(
                new, k, Mode(new_body_mode.contact, new_body_mode.pivot, True)
            )
    elif not has_same_hold(part, was, new_body_mode):
        repin(system, part, k, mode, new, state, memory)
    if event.event == REENGAGEMENT:
        line = part.body.base_line_at(system.state_of(k, state))
        contact = part.base.engaged(new_body_mode.contact, left, line, own)
        return system.with_body_mode(new, k, Mode(contact, new_body_mode.pivot, False))
    if event.event == IMPACT:
        apply_impact(system, part, k, new, left or both, both or not left, state, memory)
        stop_negligible_rebound(system, part, k, left, new, state, ground, memory)
    return new


@kernel
def next_pivot(
    system: Bodies, part: BodyOnBase, k: int, mode: int, state: Vector, ground: Ground
) -> int:
    """Return the next leading corner, to which the body leans or, from upright rest, will lean."""
    was = system.body_mode(mode, k)
    if was.pivot != PIVOT_CENTRE:
        return PIVOT_LEFT if was.pivot == PIVOT_RIGHT else PIVOT_RIGHT
    body = system.state_of(k, state)
    direction = body.angular_velocity
    if direction == 0.0 and part.body.left == part.body.right:
        direction = system.incipient_rotation(k, mode, state, ground)
    if direction == 0.0:
        # its own weight rotates a body whose centre of mass is to the side, and dampers any body
        rises = system.end_accelerations(k, mode, state, ground)
        direction = rises[0] - rises[1]
    return leading_pivot(body.rotation, direction)


@kernel
def change_pivot(
    system: Bodies, part: BodyOnBase, k: int, mode: int, state: Vector, ground: Ground,
    memory: Vector,
) -> int:  # fmt: skip
    """Change the leading corner, and with it the held point; return the new mode."""
    was, pivot = system.body_mode(mode, k), next_pivot(system, part, k, mode, state, ground)
    memory[LAST_EVENT] = SILENT
    if was.pivot != PIVOT_CENTRE:
        memory[LAST_EVENT] = PIVOT_CHANGE
        system.set_upright(k, state)
    new = system.with_body_mode(mode, k, Mode(was.contact, pivot, was.slides))
    if not was.slides:
        repin(system, part, k, mode, new, state, memory)
    return new


@kernel
def stop_sliding(
    system: Bodies, part: BodyOnBase, k: int, lifts: bool, mode: int, state: Vector, memory: Vector
) -> int:
    """Let a sliding end lift off, or hold it when its slip is zero; return the new mode."""
    was = system.body_mode(mode, k)
    left = part.base.is_held(was.contact, True)
    line = part.body.base_line_at(system.state_of(k, state))
    own = part.base.read(state, system.base_variable_index(k))
    if part.base.is_level(left, line, own):
        system.shift_vertical(k, part.base.level(left, line, own), 0.0, state)
    speed = following_speed(system, part, k, left, state)
    if lifts:
        set_end_speed(system, part, k, left, speed, 1.0, state)
        memory[LAST_EVENT] = SEPARATION
        return lift_off(system, part, k, mode, state)
    new = system.with_body_mode(mode, k, Mode(was.contact, was.pivot, False))
    repin(system, part, k, mode, new, state, memory)
    set_end_speed(system, part, k, left, speed, -1.0, state)
    memory[LAST_EVENT] = PIVOT_CHANGE
    return new


@kernel
def lift_off(system: Bodies, part: BodyOnBase, k: int, mode: int, state: Vector) -> int:
    """Return the mode after a sliding end has lifted off."""
    was = system.body_mode(mode, k)
    left = part.base.is_held(was.contact, True)
    line = part.body.base_line_at(system.state_of(k, state))
    contact = part.base.released(
        was.contact, left, line, part.base.read(state, system.base_variable_index(k))
    )
    return system.with_body_mode(mode, k, Mode(contact, PIVOT_CENTRE, False))


@kernel
def recheck_sliding(system: Bodies, part: BodyOnBase, k: int, mode: int, state: Vector) -> int:
    """Return the mode after an event that may have changed the speed of a sliding end.

    An end whose speed differs from that of its base lifts off; if it moves down it lands at once.
    """
    was = system.body_mode(mode, k)
    if not was.slides:
        return mode
    left = part.base.is_held(was.contact, True)
    speed, noise = end_speed(part, left, system.state_of(k, state))
    target = following_speed(system, part, k, left, state)
    if abs(speed - target) <= LIFT_OFF_NOISE * max(noise, part.base.least_landing()):
        system.shift_vertical(k, 0.0, target - speed, state)
        return mode
    return lift_off(system, part, k, mode, state)


@kernel
def mode_after_disturbance(
    system: Bodies, part: BodyOnBase, k: int, mode: int, state: Vector
) -> int:
    """Return the mode after an event of another body has changed the speeds of this one."""
    was = system.body_mode(mode, k)
    if was.slides:
        return recheck_sliding(system, part, k, mode, state)
    contact = part.base.disturbed(was.contact)
    return system.with_body_mode(mode, k, Mode(contact, was.pivot, False))


@kernel
def switch_mode(
    system: Bodies, part: BodyOnBase, k: int, which: int, mode: int, state: Vector, ground: Ground,
    memory: Vector,
) -> int:  # fmt: skip
    """Carry out the switch that a guard of a body calls for; return the new mode."""
    count = part.base.end_guards()
    if which == 2 * count + PIVOT:
        new = change_pivot(system, part, k, mode, state, ground, memory)
    elif which == 2 * count + HOLD:
        new = stop_sliding(system, part, k, True, mode, state, memory)
    elif which == 2 * count + SLIP:
        new = stop_sliding(system, part, k, False, mode, state, memory)
    else:
        left = which < count
        new = switch_end(
            system, part, k, left, which if left else which - count, mode, state, ground, memory
        )
    return recheck_sliding(system, part, k, new, state)
