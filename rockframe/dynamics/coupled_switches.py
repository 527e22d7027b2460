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
from rockframe.dynamics.coupled import rates
from rockframe.dynamics.coupled_corners import (
    answered_speed,
    corner_level,
    corner_noise,
    corner_rate,
    end_rate,
    forceless,
    free_corner,
    rates_of,
    reaction,
    stop_end,
    take_share,
)
from rockframe.dynamics.coupled_impulses import land, repin_block, repin_cap
from rockframe.dynamics.coupled_layout import (
    CAP_HALF_HEIGHT,
    CAP_HORIZONTAL,
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
    RESTRAINT,
    RIGHT_GUARDS,
    ROTATION,
    SMALL,
    SOIL_GUARDS,
    SOIL_PIVOT_GUARD,
    bed_contact,
    bed_of,
    block_glides,
    block_pivot,
    cap_ends,
    cap_glides,
    cap_pivot,
    held_block_pivot,
    held_cap_pivot,
)
from rockframe.dynamics.coupled_motion import cap_sway, configuration
from rockframe.dynamics.gliding import blend, is_lifted, share_of_loss, share_until_lifted
from rockframe.dynamics.kinematics import (
    PIVOT_CENTRE,
    PIVOT_LEFT,
    PIVOT_RIGHT,
    end_accelerations,
    leading_pivot,
    sine_cosine_rise,
)
from rockframe.dynamics.pad import (
    CLEAR,
    CONTACTS,
    DISTURBED,
    ENGAGING,
    LEAVE,
    LEAVING,
    RELAXING,
    TOUCHING,
    both_corners,
    corners_in,
    force_rises,
    judged_anew,
    reaction_noise,
    released,
    switch_corner,
)
from rockframe.dynamics.protocol import (
    HORIZONTAL_REFERENCE,
    IMPACT,
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
from rockframe.dynamics.two_spring import MODES as BLOCK_MODES
from rockframe.dynamics.two_spring_switches import mode_of as block_mode_of
from rockframe.dynamics.winkler import mode_of as bed_mode_of


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
    new = mode + CONTACTS * (pivot - old)
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
    if which == LEAVE:
        memory[LAST_EVENT] = SEPARATION
        return let_fly(mode, 1.0, state, p)
    new = mode - CONTACTS * GLIDING
    first = gliding_corner(mode)
    repin_block(mode, new, state, p, memory)
    free_corner(first, -1.0, state, p)
    memory[LAST_EVENT] = PIVOT_CHANGE
    return new


@kernel
def gliding_corner(mode: int) -> int:
    """Give the corner of the block that glides, by its first guard."""
    return LEFT_GUARDS if gliding_side(mode % BLOCK_MODES) > 0.0 else RIGHT_GUARDS


@kernel
def let_fly(mode: int, direction: float, state: Vector, p: Vector) -> int:
    """Give the mode in which the gliding corner flies, with the speed of its pad or one beside."""
    first = gliding_corner(mode)
    if direction != 0.0:
        free_corner(first, direction, state, p)
    contact = released(corner_level(first, state, p), p[PAD_DAMPING], p[PAD_SETTLEMENT])
    left, right = corners_in(mode)
    corners = both_corners(
        contact if first == LEFT_GUARDS else left, contact if first == RIGHT_GUARDS else right
    )
    return mode - mode % BLOCK_MODES + corners


@kernel
def presses_in(
    mode: int, first: int, state: Vector, ground_x: float, ground_y: float, p: Vector
) -> bool:
    """Whether the force of a corner's pad would rise in a mode."""
    found = rates(mode, state, ground_x, ground_y, p)
    sine, cosine, _ = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    left, right = end_accelerations(
        p[HALF_HEIGHT], p[HALF_WIDTH], p[SMALL], sine, cosine, state[COORDINATES + ROTATION],
        found.normal, found.rotation,
    )  # fmt: skip
    acceleration = left if first == LEFT_GUARDS else right
    return force_rises(corner_rate(first, state, p), acceleration, p[PAD_STIFFNESS], p[PAD_DAMPING])


@kernel
def with_corners(mode: int, left: int, right: int, state: Vector, p: Vector) -> int:
    """Give the mode with other contacts of the block's corners, and the pivot of the rule."""
    spin = state[COORDINATES + ROTATION]
    block_mode = block_mode_of(left, right, state[ROTATION], spin, p[RESTRAINT])
    return block_mode + BLOCK_MODES * (mode // BLOCK_MODES)


@kernel
def after_separation(
    first: int, mode: int, left: int, right: int, ground_x: float, ground_y: float,
    state: Vector, p: Vector, memory: Vector,
) -> int:  # fmt: skip
    """Give the mode after corners have left their pads, and re-pin, as for pads on the ground."""
    new = with_corners(mode, left, right, state, p)
    if block_pivot(new) != block_pivot(mode):
        repin_block(mode, new, state, p, memory)
    on_left = first == LEFT_GUARDS
    contact = left if on_left else right
    noise = reaction_noise(math.hypot(p[HALF_WIDTH], p[HALF_HEIGHT]), p[PAD_SETTLEMENT])
    if contact != RELAXING or reaction(first, state, p) < -noise * p[GRAVITY]:
        return new
    if block_pivot(new) == FREE:
        was = corners_in(mode)
        alone = (was[1] if on_left else was[0]) != TOUCHING
        if alone and presses_in(new, first, state, ground_x, ground_y, p):
            touching = TOUCHING - contact
            new += both_corners(touching if on_left else 0, 0 if on_left else touching)
            return new + CONTACTS * (held_block_pivot(mode) + GLIDING)
    elif block_pivot(new) != block_pivot(mode):
        waits = LEAVING - RELAXING
        new += both_corners(waits if on_left else 0, 0 if on_left else waits)
    return new


@kernel
def hold_block(
    mode: int, new: int, first: int, target: float, state: Vector, p: Vector, memory: Vector
) -> bool:
    """Hold a block out of flight that has come down on one corner; give whether it glides.

    As :func:`rockframe.dynamics.single_body.repin_landing`, with `target` the speed at which
    the pad no longer presses.
    """
    before, lost = rates_of(state), memory[REPINNING_LOSS]
    speed = corner_rate(first, state, p) - target
    repin_block(mode, new, state, p, memory)
    after = corner_rate(first, state, p) - target
    noise = max(corner_noise(first, state, p), answered_speed(p))
    idle = target > 0.0 and after - speed <= noise  # no slip to stop: forces decide
    if idle or not is_lifted(speed, after, noise):
        return False
    share = share_until_lifted(speed, after)
    take_share(share, before, state)
    memory[REPINNING_LOSS] = blend(lost, memory[REPINNING_LOSS], share_of_loss(share))
    state[COORDINATES + NORMAL] += target - corner_rate(first, state, p)
    return True


@kernel
def switch_pad(
    mode: int, guard_index: int, ground_x: float, ground_y: float, state: Vector, p: Vector,
    memory: Vector,
) -> int:  # fmt: skip
    """Carry out a switch of a corner's contact with its pad."""
    left, right = corners_in(mode)
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
    memory[LAST_EVENT] = event
    if contact == CLEAR:
        # the crossed level is set exactly, so that rounding cannot land the corner again
        state[NORMAL] += p[PAD_SETTLEMENT] - corner_level(first, state, p)
    if event == SILENT:
        corners = both_corners(contact if on_left else other, other if on_left else contact)
        return mode - mode % CONTACTS + corners
    other = judged_anew(other)
    left = contact if on_left else other
    right = other if on_left else contact
    if event == SEPARATION:
        return after_separation(first, mode, left, right, ground_x, ground_y, state, p, memory)
    new = with_corners(mode, left, right, state, p)
    flies = block_pivot(mode) == FREE and not slides
    both = event == IMPACT and flies and other == TOUCHING
    if event == IMPACT:
        landing = LEFT_GUARDS if on_left or both else RIGHT_GUARDS
        state[NORMAL] += p[PAD_SETTLEMENT] - corner_level(landing, state, p)
    if flies and not both:
        target = forceless(first, state, p) if event == REENGAGEMENT else 0.0
        if hold_block(mode, new, first, target, state, p, memory):
            return new + CONTACTS * GLIDING
    elif block_pivot(new) != block_pivot(mode):
        repin_block(mode, new, state, p, memory)
    if event == REENGAGEMENT and reaction(first, state, p) < 0.0:
        # re-pinning sped the corner up beyond its pad: let go, it would come back without end
        waits = ENGAGING - TOUCHING
        new += both_corners(waits if on_left else 0, 0 if on_left else waits)
    if event == IMPACT:
        land(new, on_left or both, not on_left or both, state, p, memory)
    return new


@kernel
def undisturbed(mode: int, state: Vector, p: Vector) -> int:
    """Give the mode after what happened to one body has, maybe, disturbed a gliding other.

    An end that has got another speed no longer glides; it flies, and lands again at once if
    the speed is downwards.
    """
    if block_glides(mode):
        first = gliding_corner(mode)
        disturbance = abs(corner_rate(first, state, p) - forceless(first, state, p))
        noise = max(corner_noise(first, state, p), answered_speed(p))
        if disturbance > DISTURBED * noise:
            mode = let_fly(mode, 0.0, state, p)
        else:
            free_corner(first, 0.0, state, p)
    if cap_glides(mode):
        end = LEFT_END if bed_contact(mode)[0] == DOWN else RIGHT_END
        speed, noise = end_rate(end, state, p)
        if abs(speed) > DISTURBED * noise:
            return mode % BLOCK_MODES + BLOCK_MODES * (RAISED + 2 * RAISED)
        stop_end(end, 0.0, state, p)
    return mode


@kernel
def corners_judged_anew(mode: int) -> int:
    """Give the mode after an event of the cap, which changed the speeds of the corners."""
    left, right = corners_in(mode)
    return mode - mode % CONTACTS + both_corners(judged_anew(left), judged_anew(right))


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
        new = switch_pad(mode, guard_index, ground_x, ground_y, state, p, memory)
    elif guard_index in (PIVOT_GUARD, SOIL_PIVOT_GUARD):
        of_cap = guard_index == SOIL_PIVOT_GUARD
        new = switch_pivot(mode, of_cap, state, ground_x, p, memory)
    else:
        new = corners_judged_anew(switch_soil(mode, guard_index - SOIL_GUARDS, state, p, memory))
    return undisturbed(new, state, p)
