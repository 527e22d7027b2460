"""Switches of the corners of a block on pads on a cap on soil.

As for two pads on the ground, :mod:`rockframe.dynamics.two_spring_switches`; momentum is
projected, and impulses act, in the coupled system: :eq:`eq-coupled-impulse`.
"""

import math

from rockframe.compiled import Vector, kernel
from rockframe.dynamics.coupled import rates
from rockframe.dynamics.coupled_corners import (
    answered_speed,
    corner_level,
    corner_noise,
    corner_rate,
    forceless,
    free_corner,
    rates_of,
    reaction,
    take_share,
)
from rockframe.dynamics.coupled_impulses import land, repin_block
from rockframe.dynamics.coupled_layout import (
    COORDINATES,
    GRAVITY,
    HALF_HEIGHT,
    HALF_WIDTH,
    LEFT_GUARDS,
    NORMAL,
    PAD_DAMPING,
    PAD_SETTLEMENT,
    PAD_STIFFNESS,
    RESTRAINT,
    RIGHT_GUARDS,
    ROTATION,
    SMALL,
    block_glides,
    block_pivot,
    held_block_pivot,
)
from rockframe.dynamics.gliding import blend, is_lifted, share_of_loss, share_until_lifted
from rockframe.dynamics.kinematics import (
    end_accelerations,
    sine_cosine_rise,
)
from rockframe.dynamics.pad import (
    CLEAR,
    CONTACTS,
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
    IMPACT,
    LAST_EVENT,
    PIVOT_CHANGE,
    REENGAGEMENT,
    REPINNING_LOSS,
    SEPARATION,
    SILENT,
)
from rockframe.dynamics.single_body import FREE
from rockframe.dynamics.two_spring import GLIDING, gliding_side
from rockframe.dynamics.two_spring import MODES as BLOCK_MODES
from rockframe.dynamics.two_spring_switches import mode_of as block_mode_of


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
