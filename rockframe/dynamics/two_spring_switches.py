"""Switches of a block on two pads: separation, landing, re-pinning.

Impact :eq:`eq-impact`, re-pinning :eq:`eq-repinning`, guards :eq:`eq-guards`.
"""

import math

from rockframe.compiled import Vector, callback, kernel
from rockframe.dynamics.kinematics import (
    PIVOT_CENTRE,
    end_height,
    end_lever,
    pinned_point,
    pivot_of,
    reach_and_bend,
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
    IMPACT,
    IMPACT_LOSS,
    LAST_EVENT,
    PIVOT_CHANGE,
    REENGAGEMENT,
    SEPARATION,
    SILENT,
    SWITCH,
)
from rockframe.dynamics.single_body import (
    COORDINATES,
    FREE,
    GRAVITY,
    HALF_HEIGHT,
    HALF_WIDTH,
    INERTIA,
    LEFT_SIDE,
    RESTRAINT,
    RIGHT_SIDE,
    ROTATION,
    SMALL,
    VERTICAL,
    repin,
    repin_landing,
    stop_end,
    turned_pivot,
)
from rockframe.dynamics.two_spring import (
    DAMPING,
    GLIDING,
    LEFT_GUARDS,
    PIVOT_GUARD,
    RESTITUTION,
    RIGHT_GUARDS,
    SETTLEMENT,
    STIFFNESS,
    glides,
    gliding_side,
    in_flight,
    pivot_in,
)


@kernel
def mode_of(left: int, right: int, rotation: float, spin: float, p: Vector) -> int:
    """Give the mode of two corners' contacts, with the pivot of the restraint rule."""
    pivot = PIVOT_CENTRE
    if left < RELAXING or right < RELAXING:
        pivot = pivot_of(p[RESTRAINT], left >= RELAXING, right >= RELAXING, rotation, spin)
    return left + 4 * right + 16 * pivot


@kernel
def corner_level(first: int, state: Vector, p: Vector) -> float:
    """Give a corner's height above its place at rest, y_I."""
    side = 1.0 if first == LEFT_GUARDS else -1.0
    lift = end_height(side, p[HALF_HEIGHT], p[HALF_WIDTH], p[SMALL], state[ROTATION])
    return state[VERTICAL] + lift


@kernel
def corner_lever(first: int, state: Vector, p: Vector) -> float:
    """Give l_I = dy_I/da."""
    side = 1.0 if first == LEFT_GUARDS else -1.0
    return end_lever(side, p[HALF_HEIGHT], p[HALF_WIDTH], p[SMALL], state[ROTATION])


@kernel
def land(mode: int, left: bool, right: bool, state: Vector, p: Vector, memory: Vector) -> None:
    """Reduce the speeds of the landing corners to eps times what they were, :eq:`eq-impact`."""
    sine, cosine, _ = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    pin = pinned_point(mode >> 4, p[HALF_WIDTH])
    reach, _ = reach_and_bend(p[HALF_HEIGHT], p[SMALL], pin, sine, cosine)
    inertia = p[INERTIA] + reach * reach
    speed = state[COORDINATES + VERTICAL]
    spin = state[COORDINATES + ROTATION]
    lever_left = corner_lever(LEFT_GUARDS, state, p)
    lever_right = corner_lever(RIGHT_GUARDS, state, p)
    drop_left = (1.0 - p[RESTITUTION]) * min(speed + lever_left * spin, 0.0)
    drop_right = (1.0 - p[RESTITUTION]) * min(speed + lever_right * spin, 0.0)
    impulse_left = 0.0
    impulse_right = 0.0
    mass_left = 1.0 + lever_left * lever_left / inertia
    mass_right = 1.0 + lever_right * lever_right / inertia
    if left and right:
        mixed = 1.0 + lever_left * lever_right / inertia
        determinant = mass_left * mass_right - mixed * mixed
        impulse_left = (mixed * drop_right - mass_right * drop_left) / determinant
        impulse_right = (mixed * drop_left - mass_left * drop_right) / determinant
    elif left:
        impulse_left = -drop_left / mass_left
    else:
        impulse_right = -drop_right / mass_right
    state[COORDINATES + VERTICAL] += impulse_left + impulse_right
    state[COORDINATES + ROTATION] += (
        impulse_left * lever_left + impulse_right * lever_right
    ) / inertia
    # work of the impulses, at the mean of each corner's speeds before and after
    after = state[COORDINATES + VERTICAL]
    turned = state[COORDINATES + ROTATION]
    memory[IMPACT_LOSS] -= 0.5 * impulse_left * (
        speed + after + lever_left * (spin + turned)
    ) + 0.5 * impulse_right * (speed + after + lever_right * (spin + turned))


@kernel
def corner_rate(first: int, state: Vector, p: Vector) -> float:
    """Give a corner's speed upwards."""
    lever = corner_lever(first, state, p)
    return state[COORDINATES + VERTICAL] + lever * state[COORDINATES + ROTATION]


@kernel
def reaction(first: int, state: Vector, p: Vector) -> float:
    """Give the reaction of a touching corner, :eq:`eq-pad-force`."""
    rate = corner_rate(first, state, p)
    level = corner_level(first, state, p)
    return pad_force(level, rate, p[STIFFNESS], p[DAMPING], p[SETTLEMENT])


@kernel
def end_gliding(which: int, mode: int, state: Vector, p: Vector, memory: Vector) -> int:
    """Let a gliding corner fly, or hold it as its slip has come to nought."""
    side = gliding_side(mode)
    first = LEFT_GUARDS if side > 0.0 else RIGHT_GUARDS
    state[VERTICAL] += p[SETTLEMENT] - corner_level(first, state, p)
    if which == LEAVE:
        stop_end(side, 1.0, state, p)
        memory[LAST_EVENT] = SEPARATION
        return (CLEAR if side > 0.0 else mode & 3) + 4 * (CLEAR if side < 0.0 else mode >> 2 & 3)
    pivot = (mode >> 4) - GLIDING
    repin(FREE, pivot, state, p, memory)
    stop_end(side, -1.0, state, p)
    memory[LAST_EVENT] = PIVOT_CHANGE
    return mode - 16 * GLIDING


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
    left = mode & 3
    right = (mode >> 2) & 3
    if guard_index == PIVOT_GUARD:
        tilt = float(right - left)  # the pad of the corner that touches raises it
        pivot = turned_pivot((mode >> 4) % GLIDING, tilt, state, ground_x, memory)
        if glides(mode):
            return left + 4 * right + 16 * (pivot + GLIDING)
        repin(mode >> 4, pivot, state, p, memory)
        return left + 4 * right + 16 * pivot
    rotation = state[ROTATION]
    spin = state[COORDINATES + ROTATION]
    on_left = guard_index < RIGHT_GUARDS
    first = LEFT_GUARDS if on_left else RIGHT_GUARDS
    second = RIGHT_GUARDS if on_left else LEFT_GUARDS
    if glides(mode) and (left if on_left else right) == TOUCHING:
        return end_gliding(guard_index - first, mode, state, p, memory)
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
        p[DAMPING],
        p[SETTLEMENT],
    )
    both = event == IMPACT and in_flight(mode) and other == TOUCHING
    left = contact if on_left else other
    right = other if on_left else contact
    if contact == CLEAR:
        # the crossed level is set exactly, so that rounding cannot land the corner again
        state[VERTICAL] += p[SETTLEMENT] - corner_level(first, state, p)
    new = mode_of(left, right, rotation, spin, p)
    memory[LAST_EVENT] = event
    if glides(mode) and event == SILENT:
        return left + 4 * right + 16 * (mode >> 4)
    if event == IMPACT and in_flight(mode) and not both:
        side = LEFT_SIDE if on_left else RIGHT_SIDE
        state[VERTICAL] += p[SETTLEMENT] - corner_level(first, state, p)
        size = math.hypot(p[HALF_WIDTH], p[HALF_HEIGHT])
        least = least_speed(size, p[GRAVITY], p[DAMPING], p[SETTLEMENT])
        if repin_landing(pivot_in(new), side, least, state, p, memory):
            return new + 16 * GLIDING
    elif pivot_in(new) != pivot_in(mode):
        repin(pivot_in(mode), pivot_in(new), state, p, memory)
    if event == REENGAGEMENT and reaction(first, state, p) < 0.0:
        # re-pinning sped the corner up beyond its pad: let go, it would come back without end
        new += ENGAGING - TOUCHING if on_left else 4 * (ENGAGING - TOUCHING)
    if event == IMPACT:
        land_left = on_left or both
        landing = LEFT_GUARDS if land_left else RIGHT_GUARDS
        state[VERTICAL] += p[SETTLEMENT] - corner_level(landing, state, p)
        land(new, land_left, not on_left or both, state, p, memory)
    return new
