"""Switches of a block on two pads: separation, landing, re-pinning.

Impact :eq:`eq-impact`, re-pinning :eq:`eq-repinning`, guards :eq:`eq-guards`.
"""

import math

from rockframe.compiled import Vector, callback, kernel
from rockframe.dynamics.kinematics import (
    PIVOT_CENTRE,
    end_accelerations,
    end_height,
    end_lever,
    pinned_point,
    pivot_of,
    reach_and_bend,
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
    SIMULTANEOUS,
    TOUCHING,
    both_corners,
    corners_in,
    force_rises,
    forceless_rate,
    judged_anew,
    least_speed,
    pad_force,
    reaction_noise,
    released,
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
    end_rate,
    repin,
    repin_landing,
    set_end_rate,
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
    airborne_corners,
    body_rates,
    glides,
    gliding_side,
    held_pivot,
    in_flight,
    pivot_in,
)


@kernel
def mode_of(left: int, right: int, rotation: float, spin: float, rule: float) -> int:
    """Give the mode of two corners' contacts, with the pivot of the restraint rule."""
    pivot = PIVOT_CENTRE
    if not airborne_corners(left, right):
        pivot = pivot_of(rule, left >= RELAXING, right >= RELAXING, rotation, spin)
    return both_corners(left, right) + CONTACTS * pivot


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
    pin = pinned_point(held_pivot(mode), p[HALF_WIDTH])
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
def forceless(first: int, state: Vector, p: Vector) -> float:
    """Give the speed at which a corner rises with its pad without a force between them."""
    level = corner_level(first, state, p)
    return forceless_rate(level, p[STIFFNESS], p[DAMPING], p[SETTLEMENT])


@kernel
def presses_in(
    mode: int, first: int, state: Vector, ground_x: float, ground_y: float, p: Vector
) -> bool:
    """Whether the force of a corner's pad would rise in a mode."""
    rates = body_rates(mode, state, ground_x, ground_y, p)
    sine, cosine, _ = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    left, right = end_accelerations(
        p[HALF_HEIGHT], p[HALF_WIDTH], p[SMALL], sine, cosine, state[COORDINATES + ROTATION],
        rates.vertical, rates.rotation,
    )  # fmt: skip
    acceleration = left if first == LEFT_GUARDS else right
    return force_rises(corner_rate(first, state, p), acceleration, p[STIFFNESS], p[DAMPING])


@kernel
def answered_speed(p: Vector) -> float:
    """Give the least speed that a pad answers with more than rounding noise."""
    size = math.hypot(p[HALF_WIDTH], p[HALF_HEIGHT])
    return least_speed(size, p[GRAVITY], p[DAMPING], p[SETTLEMENT])


@kernel
def end_gliding(which: int, mode: int, state: Vector, p: Vector, memory: Vector) -> int:
    """Let a gliding corner fly, or hold it as its slip has come to nought."""
    side = gliding_side(mode)
    first = LEFT_GUARDS if side > 0.0 else RIGHT_GUARDS
    level = corner_level(first, state, p)
    if level > (1.0 - SIMULTANEOUS) * p[SETTLEMENT]:
        state[VERTICAL] += p[SETTLEMENT] - level
    left, right = corners_in(mode)
    if which == LEAVE:
        set_end_rate(side, forceless(first, state, p), 1.0, answered_speed(p), state, p)
        memory[LAST_EVENT] = SEPARATION
        contact = released(corner_level(first, state, p), p[DAMPING], p[SETTLEMENT])
        return both_corners(contact if side > 0.0 else left, contact if side < 0.0 else right)
    repin(FREE, held_pivot(mode), state, p, memory)
    set_end_rate(side, forceless(first, state, p), -1.0, answered_speed(p), state, p)
    memory[LAST_EVENT] = PIVOT_CHANGE
    return mode - CONTACTS * GLIDING


@kernel
def after_separation(
    first: int, mode: int, left: int, right: int, ground_x: float, ground_y: float,
    state: Vector, p: Vector, memory: Vector,
) -> int:  # fmt: skip
    """Give the mode after corners have left, and re-pin; `left` and `right` are their contacts.

    A corner that the flight would press at once glides, :eq:`eq-leaving-into-flight`. One that
    the re-pinning of its own separation leaves pressing waits until its pad has let it go.
    """
    new = mode_of(left, right, state[ROTATION], state[COORDINATES + ROTATION], p[RESTRAINT])
    if pivot_in(new) != pivot_in(mode):
        repin(pivot_in(mode), pivot_in(new), state, p, memory)
    on_left = first == LEFT_GUARDS
    contact = left if on_left else right
    if contact != RELAXING:
        return new
    noise = reaction_noise(math.hypot(p[HALF_WIDTH], p[HALF_HEIGHT]), p[SETTLEMENT])
    if reaction(first, state, p) < -noise * p[GRAVITY]:
        return new
    if in_flight(new):
        was = corners_in(mode)
        alone = (was[1] if on_left else was[0]) != TOUCHING
        if alone and presses_in(new, first, state, ground_x, ground_y, p):
            touching = TOUCHING - contact
            new += both_corners(touching if on_left else 0, 0 if on_left else touching)
            return new + CONTACTS * (held_pivot(mode) + GLIDING)
    elif pivot_in(new) != pivot_in(mode):
        waits = LEAVING - RELAXING
        new += both_corners(waits if on_left else 0, 0 if on_left else waits)
    return new


@kernel
def judged_anew_in(mode: int, state: Vector, p: Vector) -> int:
    """Give the mode after something else than the corners' own events changed their speeds.

    A gliding corner that has got another speed than its pad flies, and lands again at once
    if it comes down.
    """
    if glides(mode):
        side = gliding_side(mode)
        first = LEFT_GUARDS if side > 0.0 else RIGHT_GUARDS
        _, rate, noise = end_rate(side, state, p)
        target = forceless(first, state, p)
        if abs(rate - target) <= DISTURBED * max(noise, answered_speed(p)):
            set_end_rate(side, target, 0.0, 0.0, state, p)
            return mode
        contact = released(corner_level(first, state, p), p[DAMPING], p[SETTLEMENT])
        left, right = corners_in(mode)
        return both_corners(contact if side > 0.0 else left, contact if side < 0.0 else right)
    left, right = corners_in(mode)
    return both_corners(judged_anew(left), judged_anew(right)) + CONTACTS * (mode // CONTACTS)


@callback(SWITCH)
@kernel
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
    left, right = corners_in(mode)
    if guard_index == PIVOT_GUARD:
        tilt = float(right - left)  # the pad of the corner that touches raises it
        pivot = turned_pivot(held_pivot(mode), tilt, state, ground_x, memory)
        if not glides(mode):
            repin(held_pivot(mode), pivot, state, p, memory)
        return mode + CONTACTS * (pivot - held_pivot(mode))
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
    memory[LAST_EVENT] = event
    if contact == CLEAR:
        # the crossed level is set exactly, so that rounding cannot land the corner again
        state[VERTICAL] += p[SETTLEMENT] - corner_level(first, state, p)
    if event == SILENT:
        corners = both_corners(contact if on_left else other, other if on_left else contact)
        return corners + CONTACTS * (mode // CONTACTS)
    other = judged_anew(other)
    left = contact if on_left else other
    right = other if on_left else contact
    if event == SEPARATION:
        return after_separation(first, mode, left, right, ground_x, ground_y, state, p, memory)
    new = mode_of(left, right, state[ROTATION], state[COORDINATES + ROTATION], p[RESTRAINT])
    both = event == IMPACT and in_flight(mode) and other == TOUCHING
    if event == IMPACT:
        landing = LEFT_GUARDS if on_left or both else RIGHT_GUARDS
        state[VERTICAL] += p[SETTLEMENT] - corner_level(landing, state, p)
    if in_flight(mode) and not both:
        side = LEFT_SIDE if on_left else RIGHT_SIDE
        target = forceless(first, state, p) if event == REENGAGEMENT else 0.0
        if repin_landing(pivot_in(new), side, target, answered_speed(p), state, p, memory):
            return new + CONTACTS * GLIDING
    elif pivot_in(new) != pivot_in(mode):
        repin(pivot_in(mode), pivot_in(new), state, p, memory)
    if event == REENGAGEMENT and reaction(first, state, p) < 0.0:
        # re-pinning sped the corner up beyond its pad: let go, it would come back without end
        waits = ENGAGING - TOUCHING
        new += both_corners(waits if on_left else 0, 0 if on_left else waits)
    if event == IMPACT:
        land(new, on_left or both, not on_left or both, state, p, memory)
    return new
