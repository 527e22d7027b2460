"""Switches of a block on pads on a cap on soil.

The rules are those of two pads on the ground and of a bed; momentum is projected, and
impulses act, in the coupled system: :eq:`eq-coupled-impulse`.
"""

from rockframe.compiled import Vector, callback, kernel
from rockframe.dynamics.bed import (
    LEFT_END,
    PIVOT_FACTOR,
    RAISED,
    RIGHT_END,
    nothing_bears,
    switch_bed,
)
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
    block_pivot,
    cap_ends,
    cap_pivot,
    cap_position,
    cap_sway,
    configuration,
    solve_motion,
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
    RELAXING,
    TOUCHING,
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


@kernel
def block_mode_of(left: int, right: int, rotation: float, spin: float, rule: float) -> int:
    """Give the block's part of a mode."""
    pivot = PIVOT_CENTRE
    if left < RELAXING or right < RELAXING:
        pivot = pivot_of(rule, left >= RELAXING, right >= RELAXING, rotation, spin)
    return left + 4 * right + 16 * pivot


@kernel
def bed_mode_of(
    left: int, right: int, loose: int, rotation: float, spin: float, rule: float
) -> int:
    """Give the bed's part of a mode."""
    pivot = PIVOT_CENTRE
    if not nothing_bears(left, right, loose):
        pivot = pivot_of(rule, left == RAISED, right == RAISED, rotation, spin)
    return left + 2 * right + 4 * loose + PIVOT_FACTOR * pivot


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
        old = cap_pivot(mode)
        tendency = -ground_x if ground_x != 0.0 else state[ROTATION]
        pivot = turned(old, CAP_ROTATION, tendency, state)
        new = mode + BLOCK_MODES * PIVOT_FACTOR * (pivot - old)
        repin_cap(mode, new, state, p, memory)
        memory[LAST_EVENT] = SILENT if old == PIVOT_CENTRE else SOIL_PIVOT_CHANGE
        return new
    old = block_pivot(mode)
    tendency = -ground_x if ground_x != 0.0 else -state[COORDINATES + CAP_ROTATION]
    pivot = turned(old, ROTATION, tendency, state)
    new = mode + 16 * (pivot - old)
    repin_block(mode, new, state, p, memory)
    memory[LAST_EVENT] = SILENT if old == PIVOT_CENTRE else PIVOT_CHANGE
    return new


@kernel
def switch_soil(mode: int, which: int, state: Vector, p: Vector, memory: Vector) -> int:
    """Carry out a switch of the cap's contact with the soil."""
    left, right, loose = bed_contact(mode)
    sine, cosine, rise = sine_cosine_rise(p[CAP_HALF_HEIGHT], p[SMALL], state[CAP_ROTATION])
    ends = cap_ends(state, p, sine, cosine, rise)
    left, right, loose, event = switch_bed(which, left, right, loose, ends, bed_of(p))
    if which == LEFT_END:
        state[CAP_VERTICAL] += ends.u_left
    elif which == RIGHT_END:
        state[CAP_VERTICAL] += ends.u_right
    spin = state[COORDINATES + CAP_ROTATION]
    bed_mode = bed_mode_of(left, right, loose, state[CAP_ROTATION], spin, p[RESTRAINT])
    new = mode % BLOCK_MODES + BLOCK_MODES * bed_mode
    if cap_pivot(new) != cap_pivot(mode):
        repin_cap(mode, new, state, p, memory)
    memory[LAST_EVENT] = event
    if event == SEPARATION:
        memory[LAST_EVENT] = SOIL_SEPARATION
    elif event == REENGAGEMENT:
        memory[LAST_EVENT] = SOIL_CONTACT
    return new


@kernel
def switch_pad(mode: int, guard_index: int, state: Vector, p: Vector, memory: Vector) -> int:
    """Carry out a switch of a corner's contact with its pad."""
    left = mode & 3
    right = (mode >> 2) & 3
    on_left = guard_index < RIGHT_GUARDS
    first = LEFT_GUARDS if on_left else RIGHT_GUARDS
    second = RIGHT_GUARDS if on_left else LEFT_GUARDS
    contact, other, event = switch_corner(
        guard_index - first,
        left if on_left else right,
        right if on_left else left,
        corner_level(first, state, p),
        corner_level(second, state, p),
        reaction(second, state, p),
        p[PAD_DAMPING],
        p[PAD_SETTLEMENT],
    )
    both = event == IMPACT and block_pivot(mode) == FREE and other == TOUCHING
    left = contact if on_left else other
    right = other if on_left else contact
    if contact == CLEAR:
        # the crossed level is set exactly, so that rounding cannot land the corner again
        state[NORMAL] += p[PAD_SETTLEMENT] - corner_level(first, state, p)
    spin = state[COORDINATES + ROTATION]
    block_mode = block_mode_of(left, right, state[ROTATION], spin, p[RESTRAINT])
    new = block_mode + BLOCK_MODES * (mode // BLOCK_MODES)
    if block_pivot(new) != block_pivot(mode):
        repin_block(mode, new, state, p, memory)
    if event == REENGAGEMENT and reaction(first, state, p) < 0.0:
        # re-pinning sped the corner up beyond its pad: let go, it would come back without end
        new += ENGAGING - TOUCHING if on_left else 4 * (ENGAGING - TOUCHING)
    if event == IMPACT:
        land_left = on_left or both
        landing = LEFT_GUARDS if land_left else RIGHT_GUARDS
        state[NORMAL] += p[PAD_SETTLEMENT] - corner_level(landing, state, p)
        land(new, land_left, not on_left or both, state, p, memory)
    memory[LAST_EVENT] = event
    return new


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
        return switch_pad(mode, guard_index, state, p, memory)
    if guard_index in (PIVOT_GUARD, SOIL_PIVOT_GUARD):
        of_cap = guard_index == SOIL_PIVOT_GUARD
        return switch_pivot(mode, of_cap, state, ground_x, p, memory)
    return switch_soil(mode, guard_index - SOIL_GUARDS, state, p, memory)
