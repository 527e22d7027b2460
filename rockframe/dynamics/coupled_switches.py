"""Switches of a block on pads on a cap on soil.

The rules are those of two pads on the ground and of a bed; momentum is projected, and
impulses act, in the coupled system: :eq:`eq-coupled-impulse`.
"""

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
    answered_speed,
    corner_noise,
    corner_rate,
    end_rate,
    forceless,
    free_corner,
    rates_of,
    stop_end,
    take_share,
)
from rockframe.dynamics.coupled_impulses import repin_block, repin_cap
from rockframe.dynamics.coupled_layout import (
    CAP_HALF_HEIGHT,
    CAP_HORIZONTAL,
    CAP_ROTATION,
    CAP_VERTICAL,
    COORDINATES,
    PIVOT_GUARD,
    RESTRAINT,
    ROTATION,
    SMALL,
    SOIL_GUARDS,
    SOIL_PIVOT_GUARD,
    bed_contact,
    bed_of,
    block_glides,
    cap_ends,
    cap_glides,
    cap_pivot,
    held_block_pivot,
    held_cap_pivot,
)
from rockframe.dynamics.coupled_motion import cap_sway, configuration
from rockframe.dynamics.coupled_pad_switches import gliding_corner, let_fly, switch_pad
from rockframe.dynamics.gliding import blend, is_lifted, share_of_loss, share_until_lifted
from rockframe.dynamics.kinematics import (
    PIVOT_CENTRE,
    PIVOT_LEFT,
    PIVOT_RIGHT,
    leading_pivot,
    sine_cosine_rise,
)
from rockframe.dynamics.pad import (
    CONTACTS,
    DISTURBED,
    both_corners,
    corners_in,
    judged_anew,
)
from rockframe.dynamics.protocol import (
    HORIZONTAL_REFERENCE,
    LAST_EVENT,
    PIVOT_CHANGE,
    REPINNING_LOSS,
    SEPARATION,
    SILENT,
    SOIL_CONTACT,
    SOIL_PIVOT_CHANGE,
    SOIL_SEPARATION,
    SWITCH,
)
from rockframe.dynamics.two_spring import MODES as BLOCK_MODES
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
