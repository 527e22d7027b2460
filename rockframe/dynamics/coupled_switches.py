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
from rockframe.dynamics.coupled_corners import (
    bed_mode_of,
    block_mode_of,
    corner_level,
    corner_noise,
    corner_rate,
    end_rate,
    rates_of,
    reaction,
    stop_corner,
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
    leading_pivot,
    sine_cosine_rise,
)
from rockframe.dynamics.pad import CLEAR, ENGAGING, LEAVE, TOUCHING, least_speed, switch_corner
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

DISTURBED = 1e3
"""Speed of a gliding end, over its rounding noise, from which on it no longer glides."""


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
