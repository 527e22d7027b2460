"""Switches of a block on pads on a cap on soil.

The rules are those of two pads on the ground and of a bed; momentum is projected, and
impulses act, in the coupled system: :eq:`eq-coupled-impulse`.
"""

import math

from rockframe.compiled import Vector, callback, kernel
from rockframe.dynamics.bed import (
    DOWN,
    LEFT_END,
    PIVOT_FACTOR,
    RAISED,
    RIGHT_END,
    SLIP,
    airborne,
    switch_bed,
)
from rockframe.dynamics.bed import GLIDING as BED_GLIDING
from rockframe.dynamics.coupled import (
    ALONG,
    BLOCK_MODES,
    CAP_HALF_HEIGHT,
    CAP_HALF_WIDTH,
    CAP_HORIZONTAL,
    CAP_MASS,
    CAP_ROTATION,
    CAP_VERTICAL,
    COORDINATES,
    GRAVITY,
    HALF_HEIGHT,
    HALF_WIDTH,
    LEFT_GUARDS,
    NORMAL,
    PAD_DAMPING,
    PAD_SETTLEMENT,
    PAD_STIFFNESS,
    PIVOT_GUARD,
    RESTITUTION,
    RESTRAINT,
    RIGHT_GUARDS,
    ROTATION,
    SMALL,
    SOIL_GUARDS,
    SOIL_PIVOT_GUARD,
    Motion,
    along_rate,
    bed_contact,
    bed_of,
    block_glides,
    block_pivot,
    cap_ends,
    cap_glides,
    cap_pivot,
    cap_position,
    cap_sway,
    configuration,
    held_block_pivot,
    held_cap_pivot,
    solve_motion,
)
from rockframe.dynamics.gliding import (
    blend,
    is_lifted,
    share_of_loss,
    share_until_lifted,
    speed_noise,
)
from rockframe.dynamics.kinematics import (
    PIVOT_CENTRE,
    PIVOT_LEFT,
    PIVOT_RIGHT,
    about_pin,
    leading_pivot,
    pinned_point,
    pivot_of,
    sine_cosine_rise,
)
from rockframe.dynamics.pad import (
    CLEAR,
    ENGAGING,
    LEAVE,
    RELAXING,
    TOUCHING,
    least_speed,
    pad_force,
    switch_corner,
)
from rockframe.dynamics.protocol import (
    HORIZONTAL_REFERENCE,
    IMPACT,
    IMPACT_LOSS,
    LAST_EVENT,
    PIVOT_CHANGE,
    REENGAGEMENT,
    REPINNING_LOSS,
    SEPARATION,
    SILENT,
    SOIL_CONTACT,
    SOIL_PIVOT_CHANGE,
    SOIL_SEPARATION,
    SWITCH,
)
from rockframe.dynamics.single_body import FREE
from rockframe.dynamics.two_spring import GLIDING, gliding_side

DISTURBED = 1e3
"""Speed of a gliding end, over its rounding noise, from which on it no longer glides."""


@kernel
def block_mode_of(left: int, right: int, rotation: float, spin: float, rule: float) -> int:
    """Give the block's part of a mode."""
    pivot = PIVOT_CENTRE
    if left < RELAXING or right < RELAXING:
        pivot = pivot_of(rule, left >= RELAXING, right >= RELAXING, rotation, spin)
    return left + 4 * right + 16 * pivot


@kernel
def bed_mode_of(left: int, right: int, rotation: float, spin: float, rule: float) -> int:
    """Give the bed's part of a mode."""
    pivot = PIVOT_CENTRE
    if not airborne(left, right):
        pivot = pivot_of(rule, left == RAISED, right == RAISED, rotation, spin)
    return left + 2 * right + PIVOT_FACTOR * pivot


@kernel
def corner_level(first: int, state: Vector, p: Vector) -> float:
    """Give a corner's height above its place at rest on the cap."""
    sine, _, rise = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    side = 1.0 if first == LEFT_GUARDS else -1.0
    return state[NORMAL] + rise + side * p[HALF_WIDTH] * sine


@kernel
def corner_lever(first: int, state: Vector, p: Vector) -> float:
    """Give the rate of a corner's height with psi."""
    sine, cosine, _ = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    side = 1.0 if first == LEFT_GUARDS else -1.0
    return p[HALF_HEIGHT] * sine + side * p[HALF_WIDTH] * cosine


@kernel
def corner_rate(first: int, state: Vector, p: Vector) -> float:
    """Give a corner's speed away from the cap."""
    lever = corner_lever(first, state, p)
    return state[COORDINATES + NORMAL] + lever * state[COORDINATES + ROTATION]


@kernel
def corner_noise(first: int, state: Vector, p: Vector) -> float:
    """Give the rounding noise of a corner's speed."""
    lever = corner_lever(first, state, p)
    return speed_noise(state[COORDINATES + NORMAL], lever, state[COORDINATES + ROTATION])


@kernel
def stop_corner(first: int, direction: float, state: Vector, p: Vector) -> None:
    """Take a corner's speed to nought, or to the side of it that rounding cannot leave."""
    noise = corner_noise(first, state, p)
    state[COORDINATES + NORMAL] += direction * noise - corner_rate(first, state, p)


@kernel
def end_rate(end: int, state: Vector, p: Vector) -> tuple[float, float]:
    """Give the speed of an end of the cap's base, and its rounding noise."""
    sine, cosine, _ = sine_cosine_rise(p[CAP_HALF_HEIGHT], p[SMALL], state[CAP_ROTATION])
    side = 1.0 if end == LEFT_END else -1.0
    lever = p[CAP_HALF_HEIGHT] * sine + side * p[CAP_HALF_WIDTH] * cosine
    speed = state[COORDINATES + CAP_VERTICAL]
    spin = state[COORDINATES + CAP_ROTATION]
    return speed + lever * spin, speed_noise(speed, lever, spin)


@kernel
def stop_end(end: int, direction: float, state: Vector, p: Vector) -> None:
    """Take the speed of an end of the cap's base to nought, or beside it."""
    speed, noise = end_rate(end, state, p)
    state[COORDINATES + CAP_VERTICAL] += direction * noise - speed


@kernel
def rates_of(state: Vector) -> tuple[float, float, float, float, float, float]:
    """Give all rates, to go back to."""
    n = COORDINATES
    return state[n], state[n + 1], state[n + 2], state[n + 3], state[n + 4], state[n + 5]


@kernel
def take_share(
    share: float, before: tuple[float, float, float, float, float, float], state: Vector
) -> None:
    """Take back all but a share of what an impulse did to the rates."""
    for i in range(COORDINATES):
        j = COORDINATES + i
        state[j] = blend(before[i], state[j], share)


@kernel
def reaction(first: int, state: Vector, p: Vector) -> float:
    """Give the reaction of a touching corner, :eq:`eq-pad-force`."""
    level = corner_level(first, state, p)
    rate = corner_rate(first, state, p)
    return pad_force(level, rate, p[PAD_STIFFNESS], p[PAD_DAMPING], p[PAD_SETTLEMENT])


@kernel
def kick(
    mode: int,
    press: float,
    moment: float,
    swing: float,
    drift: float,
    state: Vector,
    p: Vector,
) -> Motion:
    """Change the velocities by impulses, or by a slip that a restraint stops.

    Equation :eq:`eq-coupled-impulse`; arguments as in
    :func:`rockframe.dynamics.coupled.solve_motion`.
    """
    place = configuration(mode, state, p)
    across = state[ALONG]
    change = solve_motion(place, across, press, moment, 0.0, 0.0, swing, drift, 0.0, 0.0, p)
    s, c = place.sine, place.cosine
    normal = s * change.cap_horizontal + c * change.cap_vertical
    along = c * change.cap_horizontal - s * change.cap_vertical
    state[COORDINATES + CAP_VERTICAL] += change.cap_vertical
    state[COORDINATES + CAP_ROTATION] += change.cap_rotation
    state[COORDINATES + NORMAL] += press - normal + across * change.cap_rotation
    state[COORDINATES + ROTATION] += change.rotation
    if place.block_free:
        state[COORDINATES + ALONG] -= along + place.arm * change.cap_rotation
    else:
        state[COORDINATES + ALONG] = place.slide * state[COORDINATES + ROTATION]
    if place.cap_free:
        state[COORDINATES + CAP_HORIZONTAL] += change.cap_horizontal
    return change


@kernel
def repin_block(old: int, new: int, state: Vector, p: Vector, memory: Vector) -> None:
    """Project the momentum on the block's new restraint on the cap."""
    slip = along_rate(configuration(old, state, p), state)
    if block_pivot(new) == FREE:
        state[COORDINATES + ALONG] = slip
        return
    place = configuration(new, state, p)
    slip -= place.slide * state[COORDINATES + ROTATION]
    change = kick(new, 0.0, 0.0, 0.0, -slip, state, p)
    memory[REPINNING_LOSS] -= 0.5 * change.thrust * slip


@kernel
def repin_cap(old: int, new: int, state: Vector, p: Vector, memory: Vector) -> None:
    """Project the momentum on the cap's new restraint on the soil."""
    position = cap_position(old, state, p, memory)
    slip = cap_sway(configuration(old, state, p), state)
    pivot = cap_pivot(new)
    if pivot == FREE:
        state[CAP_HORIZONTAL] = position
        state[COORDINATES + CAP_HORIZONTAL] = slip
        return
    pin = pinned_point(pivot, p[CAP_HALF_WIDTH])
    memory[HORIZONTAL_REFERENCE] = position - about_pin(
        p[CAP_HALF_HEIGHT], p[SMALL], pin, state[CAP_ROTATION]
    )
    place = configuration(new, state, p)
    slip -= place.reach * state[COORDINATES + CAP_ROTATION]
    change = kick(new, 0.0, 0.0, -slip, 0.0, state, p)
    impulse = place.cosine * change.thrust + p[CAP_MASS] * change.cap_horizontal
    memory[REPINNING_LOSS] -= 0.5 * impulse * slip


@kernel
def land(mode: int, left: bool, right: bool, state: Vector, p: Vector, memory: Vector) -> None:
    """Reduce the speeds of the landing corners to eps times what they were."""
    lever_left = corner_lever(LEFT_GUARDS, state, p)
    lever_right = corner_lever(RIGHT_GUARDS, state, p)
    before_left = corner_rate(LEFT_GUARDS, state, p)
    before_right = corner_rate(RIGHT_GUARDS, state, p)
    # what unit impulses at either corner do to the corners' speeds
    place = configuration(mode, state, p)
    s, c, across = place.sine, place.cosine, state[ALONG]
    unit = solve_motion(place, across, 1.0, lever_left, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, p)
    lift = 1.0 - s * unit.cap_horizontal - c * unit.cap_vertical + across * unit.cap_rotation
    left_left = lift + lever_left * unit.rotation
    unit = solve_motion(place, across, 1.0, lever_right, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, p)
    lift = 1.0 - s * unit.cap_horizontal - c * unit.cap_vertical + across * unit.cap_rotation
    mixed = lift + lever_left * unit.rotation
    right_right = lift + lever_right * unit.rotation
    drop_left = (p[RESTITUTION] - 1.0) * min(before_left, 0.0)
    drop_right = (p[RESTITUTION] - 1.0) * min(before_right, 0.0)
    impulse_left = 0.0
    impulse_right = 0.0
    if left and right:
        determinant = left_left * right_right - mixed * mixed
        impulse_left = (right_right * drop_left - mixed * drop_right) / determinant
        impulse_right = (left_left * drop_right - mixed * drop_left) / determinant
    elif left:
        impulse_left = drop_left / left_left
    else:
        impulse_right = drop_right / right_right
    moment = impulse_left * lever_left + impulse_right * lever_right
    kick(mode, impulse_left + impulse_right, moment, 0.0, 0.0, state, p)
    # work of the impulses, at the mean of each corner's speeds before and after
    after_left = corner_rate(LEFT_GUARDS, state, p)
    after_right = corner_rate(RIGHT_GUARDS, state, p)
    memory[IMPACT_LOSS] -= 0.5 * (
        impulse_left * (before_left + after_left) + impulse_right * (before_right + after_right)
    )


@kernel
def turned(pivot: int, coordinate: int, tendency: float, state: Vector) -> int:
    """Give the pivot after the guard of the leading corner has fallen."""
    if pivot != PIVOT_CENTRE:
        state[coordinate] = 0.0
        return PIVOT_LEFT if pivot == PIVOT_RIGHT else PIVOT_RIGHT
    spin = state[COORDINATES + coordinate]
    pivot = leading_pivot(state[coordinate], spin if spin != 0.0 else tendency)
    # a first guess will do: a body that leans the other way changes it at once
    return PIVOT_RIGHT if pivot == PIVOT_CENTRE else pivot


@kernel
def switch_pivot(
    mode: int, of_cap: bool, state: Vector, ground_x: float, p: Vector, memory: Vector
) -> int:
    """Change the corner that leads, of the block or of the cap."""
    if of_cap:
        old = held_cap_pivot(mode)
        tendency = -ground_x if ground_x != 0.0 else state[ROTATION]
        pivot = turned(old, CAP_ROTATION, tendency, state)
        new = mode + BLOCK_MODES * PIVOT_FACTOR * (pivot - old)
        if not cap_glides(mode):
            repin_cap(mode, new, state, p, memory)
        memory[LAST_EVENT] = SILENT if old == PIVOT_CENTRE else SOIL_PIVOT_CHANGE
        return new
    old = held_block_pivot(mode)
    tendency = -ground_x if ground_x != 0.0 else -state[COORDINATES + CAP_ROTATION]
    pivot = turned(old, ROTATION, tendency, state)
    new = mode + 16 * (pivot - old)
    if not block_glides(mode):
        repin_block(mode, new, state, p, memory)
    memory[LAST_EVENT] = SILENT if old == PIVOT_CENTRE else PIVOT_CHANGE
    return new


@kernel
def switch_soil(mode: int, which: int, state: Vector, p: Vector, memory: Vector) -> int:
    """Carry out a switch of the cap's contact with the soil."""
    left, right, gliding = bed_contact(mode)
    if gliding == BED_GLIDING and (which == SLIP or (left if which == LEFT_END else right) == DOWN):
        return end_cap_gliding(mode, which, state, p, memory)
    lands = gliding != BED_GLIDING and airborne(left, right)
    sine, cosine, rise = sine_cosine_rise(p[CAP_HALF_HEIGHT], p[SMALL], state[CAP_ROTATION])
    ends = cap_ends(state, p, sine, cosine, rise)
    left, right, event = switch_bed(which, left, right, ends, bed_of(p))
    memory[LAST_EVENT] = SOIL_SEPARATION if event == SEPARATION else SOIL_CONTACT
    state[CAP_VERTICAL] += ends.u_left if which == LEFT_END else ends.u_right
    spin = state[COORDINATES + CAP_ROTATION]
    bed_mode = bed_mode_of(left, right, state[CAP_ROTATION], spin, p[RESTRAINT])
    new = mode % BLOCK_MODES + BLOCK_MODES * bed_mode
    if cap_pivot(new) == cap_pivot(mode):
        return new
    before, lost, reference = rates_of(state), memory[REPINNING_LOSS], memory[HORIZONTAL_REFERENCE]
    end_speed, _ = end_rate(which, state, p)
    repin_cap(mode, new, state, p, memory)
    if lands and left != right:
        after, noise = end_rate(which, state, p)
        if is_lifted(end_speed, after, noise):
            share = share_until_lifted(end_speed, after)
            held = cap_sway(configuration(new, state, p), state)
            state[COORDINATES + CAP_HORIZONTAL] = held
            take_share(share, before, state)
            memory[REPINNING_LOSS] = blend(lost, memory[REPINNING_LOSS], share_of_loss(share))
            memory[HORIZONTAL_REFERENCE] = reference
            stop_end(which, 0.0, state, p)
            return new + 4 * BLOCK_MODES * BED_GLIDING
    return new


@kernel
def end_cap_gliding(mode: int, which: int, state: Vector, p: Vector, memory: Vector) -> int:
    """Let a gliding end of the cap fly, or hold it as its slip has come to nought."""
    left, _, _ = bed_contact(mode)
    end = LEFT_END if left == DOWN else RIGHT_END
    sine, cosine, rise = sine_cosine_rise(p[CAP_HALF_HEIGHT], p[SMALL], state[CAP_ROTATION])
    ends = cap_ends(state, p, sine, cosine, rise)
    state[CAP_VERTICAL] += ends.u_left if end == LEFT_END else ends.u_right
    if which != SLIP:
        stop_end(end, 1.0, state, p)
        memory[LAST_EVENT] = SOIL_SEPARATION
        return mode % BLOCK_MODES + BLOCK_MODES * (RAISED + 2 * RAISED)
    new = mode - 4 * BLOCK_MODES * BED_GLIDING
    repin_cap(mode, new, state, p, memory)
    stop_end(end, -1.0, state, p)
    memory[LAST_EVENT] = SOIL_PIVOT_CHANGE
    return new


@kernel
def end_block_gliding(mode: int, which: int, state: Vector, p: Vector, memory: Vector) -> int:
    """Let a gliding corner of the block fly, or hold it as its slip has come to nought."""
    block_mode = mode % BLOCK_MODES
    on_left = gliding_side(block_mode) > 0.0
    first = LEFT_GUARDS if on_left else RIGHT_GUARDS
    state[NORMAL] += p[PAD_SETTLEMENT] - corner_level(first, state, p)
    if which == LEAVE:
        stop_corner(first, 1.0, state, p)
        memory[LAST_EVENT] = SEPARATION
        left = CLEAR if on_left else mode & 3
        right = (mode >> 2) & 3 if on_left else CLEAR
        return mode - block_mode + left + 4 * right
    new = mode - 16 * GLIDING
    repin_block(mode, new, state, p, memory)
    stop_corner(first, -1.0, state, p)
    memory[LAST_EVENT] = PIVOT_CHANGE
    return new


@kernel
def switch_pad(mode: int, guard_index: int, state: Vector, p: Vector, memory: Vector) -> int:
    """Carry out a switch of a corner's contact with its pad."""
    left = mode & 3
    right = (mode >> 2) & 3
    on_left = guard_index < RIGHT_GUARDS
    first = LEFT_GUARDS if on_left else RIGHT_GUARDS
    second = RIGHT_GUARDS if on_left else LEFT_GUARDS
    slides = block_glides(mode)
    if slides and (left if on_left else right) == TOUCHING:
        return end_block_gliding(mode, guard_index - first, state, p, memory)
    contact, other, event = switch_corner(
        guard_index - first,
        left if on_left else right,
        right if on_left else left,
        corner_level(first, state, p),
        corner_level(second, state, p),
        corner_rate(first, state, p),
        corner_rate(second, state, p),
        reaction(first, state, p),
        reaction(second, state, p),
        p[PAD_DAMPING],
        p[PAD_SETTLEMENT],
    )
    lands = event == IMPACT and block_pivot(mode) == FREE and not slides
    both = lands and other == TOUCHING
    left = contact if on_left else other
    right = other if on_left else contact
    if contact == CLEAR:
        # the crossed level is set exactly, so that rounding cannot land the corner again
        state[NORMAL] += p[PAD_SETTLEMENT] - corner_level(first, state, p)
    spin = state[COORDINATES + ROTATION]
    block_mode = block_mode_of(left, right, state[ROTATION], spin, p[RESTRAINT])
    memory[LAST_EVENT] = event
    if slides and event == SILENT:
        block_mode = left + 4 * right + 16 * ((mode % BLOCK_MODES) >> 4)
    new = block_mode + BLOCK_MODES * (mode // BLOCK_MODES)
    if block_pivot(new) != block_pivot(mode):
        before, lost = rates_of(state), memory[REPINNING_LOSS]
        speed = corner_rate(first, state, p)
        repin_block(mode, new, state, p, memory)
        if lands and not both:
            size = math.hypot(p[HALF_WIDTH], p[HALF_HEIGHT])
            least = least_speed(size, p[GRAVITY], p[PAD_DAMPING], p[PAD_SETTLEMENT])
            after = corner_rate(first, state, p)
            if is_lifted(speed, after, max(corner_noise(first, state, p), least)):
                share = share_until_lifted(speed, after)
                take_share(share, before, state)
                memory[REPINNING_LOSS] = blend(lost, memory[REPINNING_LOSS], share_of_loss(share))
                state[NORMAL] += p[PAD_SETTLEMENT] - corner_level(first, state, p)
                stop_corner(first, 0.0, state, p)
                return new + 16 * GLIDING
    if event == REENGAGEMENT and reaction(first, state, p) < 0.0:
        # re-pinning sped the corner up beyond its pad: let go, it would come back without end
        new += ENGAGING - TOUCHING if on_left else 4 * (ENGAGING - TOUCHING)
    if event == IMPACT:
        land_left = on_left or both
        landing = LEFT_GUARDS if land_left else RIGHT_GUARDS
        state[NORMAL] += p[PAD_SETTLEMENT] - corner_level(landing, state, p)
        land(new, land_left, not on_left or both, state, p, memory)
    return new


@kernel
def undisturbed(mode: int, state: Vector, p: Vector) -> int:
    """Give the mode after what happened to one body has, maybe, disturbed a gliding other.

    An end that has got a speed no longer glides; it flies, and lands again at once if the
    speed is downwards.
    """
    if block_glides(mode):
        block_mode = mode % BLOCK_MODES
        first = LEFT_GUARDS if gliding_side(block_mode) > 0.0 else RIGHT_GUARDS
        if abs(corner_rate(first, state, p)) > DISTURBED * corner_noise(first, state, p):
            left = CLEAR if first == LEFT_GUARDS else mode & 3
            right = CLEAR if first == RIGHT_GUARDS else (mode >> 2) & 3
            mode += left + 4 * right - block_mode
        else:
            stop_corner(first, 0.0, state, p)
    if cap_glides(mode):
        end = LEFT_END if bed_contact(mode)[0] == DOWN else RIGHT_END
        speed, noise = end_rate(end, state, p)
        if abs(speed) > DISTURBED * noise:
            return mode % BLOCK_MODES + BLOCK_MODES * (RAISED + 2 * RAISED)
        stop_end(end, 0.0, state, p)
    return mode


@callback(SWITCH)
def switch(
    mode: int,
    guard_index: int,
    state: Vector,
    ground_x: float,
    ground_y: float,
    p: Vector,
    memory: Vector,
) -> int:
    """Carry out the switch that a guard calls for; give the new mode."""
    if guard_index < PIVOT_GUARD:
        new = switch_pad(mode, guard_index, state, p, memory)
    elif guard_index in (PIVOT_GUARD, SOIL_PIVOT_GUARD):
        of_cap = guard_index == SOIL_PIVOT_GUARD
        new = switch_pivot(mode, of_cap, state, ground_x, p, memory)
    else:
        new = switch_soil(mode, guard_index - SOIL_GUARDS, state, p, memory)
    return undisturbed(new, state, p)
