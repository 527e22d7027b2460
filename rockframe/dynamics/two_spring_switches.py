"""What happens when a pad's guard falls through zero: separation, landing, re-pinning.

Re-pinning :eq:`eq-repinning`, impact :eq:`eq-impact`. All quantities per unit mass.
"""

from typing import Final

from rockframe.compiled import Vector, callback, kernel
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
    SWITCH,
)
from rockframe.dynamics.two_spring import (
    BY_CONTACT,
    CLEAR,
    COORDINATES,
    DAMPING,
    ENGAGING,
    HALF_HEIGHT,
    HALF_WIDTH,
    HORIZONTAL,
    INERTIA,
    LEADING_CORNER,
    LEAVE,
    PIVOT_CENTRE,
    PIVOT_GUARD,
    PIVOT_LEFT,
    PIVOT_RIGHT,
    RELAXING,
    RESTITUTION,
    RESTRAINT,
    RIGHT_GUARDS,
    ROTATION,
    SETTLEMENT,
    TOUCHING,
    TURN,
    VERTICAL,
    about_pin,
    horizontal_position,
    in_flight,
    pad_force,
    pinned_point,
    reach_and_bend,
    sine_cosine_rise,
)

SIMULTANEOUS: Final = 1e-9
"""Share of the settlement within which both corners land, or both leave, together."""


@kernel
def leading_pivot(rotation: float, tendency: float) -> int:
    """Give the pivot of the corner that a block leans to, or tends to."""
    leading = rotation if rotation != 0.0 else tendency
    if leading == 0.0:
        return PIVOT_CENTRE
    return PIVOT_RIGHT if leading > 0.0 else PIVOT_LEFT


@kernel
def mode_of(left: int, right: int, rotation: float, spin: float, p: Vector) -> int:
    """Give the mode of two corners' contacts, with the pivot of the restraint rule."""
    pivot = PIVOT_CENTRE
    if left < RELAXING or right < RELAXING:
        if p[RESTRAINT] == BY_CONTACT:
            if left >= RELAXING:
                pivot = PIVOT_RIGHT
            elif right >= RELAXING:
                pivot = PIVOT_LEFT
        elif p[RESTRAINT] == LEADING_CORNER:
            pivot = leading_pivot(rotation, spin)
    return left + 4 * right + 16 * pivot


@kernel
def corner_level(first: int, state: Vector, p: Vector) -> float:
    """Give a corner's height above its place at rest, y_I."""
    sine, _, rise = sine_cosine_rise(p, state[ROTATION])
    side = 1.0 if first == LEAVE else -1.0
    return state[VERTICAL] + rise + side * p[HALF_WIDTH] * sine


@kernel
def corner_lever(first: int, state: Vector, p: Vector) -> float:
    """Give l_I = dy_I/da."""
    sine, cosine, _ = sine_cosine_rise(p, state[ROTATION])
    side = 1.0 if first == LEAVE else -1.0
    return p[HALF_HEIGHT] * sine + side * p[HALF_WIDTH] * cosine


@kernel
def released(first: int, state: Vector, p: Vector) -> int:
    """Give the contact of a corner that has just left: relaxing, or clear at once."""
    below = p[SETTLEMENT] - corner_level(first, state, p)
    if p[DAMPING] > 0.0 and below > 1e-12 * p[SETTLEMENT]:
        return RELAXING
    return CLEAR


@kernel
def repin(old: int, new: int, state: Vector, p: Vector, memory: Vector) -> None:
    """Project the momentum on the new horizontal restraint, :eq:`eq-repinning`."""
    position = horizontal_position(old, state, p, memory)
    rotation = state[ROTATION]
    spin = state[COORDINATES + ROTATION]
    sine, cosine, _ = sine_cosine_rise(p, rotation)
    if in_flight(old):
        sway = state[COORDINATES + HORIZONTAL]
    else:
        reach, _ = reach_and_bend(p, pinned_point(old, p), sine, cosine)
        sway = reach * spin
    if in_flight(new):
        state[HORIZONTAL] = position
        state[COORDINATES + HORIZONTAL] = sway
        return
    pin = pinned_point(new, p)
    memory[HORIZONTAL_REFERENCE] = position - about_pin(pin, rotation, p)
    reach, _ = reach_and_bend(p, pin, sine, cosine)
    # the constraint's impulse does no work on what it lets through: the loss is
    # that of the slip between the old sway and the new one
    slip = sway - reach * spin
    inertia = p[INERTIA] + reach * reach
    state[COORDINATES + ROTATION] = (p[INERTIA] * spin + reach * sway) / inertia
    memory[REPINNING_LOSS] += 0.5 * p[INERTIA] * slip * slip / inertia


@kernel
def land(mode: int, left: bool, right: bool, state: Vector, p: Vector, memory: Vector) -> None:
    """Reduce the speeds of the landing corners to eps times what they were, :eq:`eq-impact`."""
    sine, cosine, _ = sine_cosine_rise(p, state[ROTATION])
    reach, _ = reach_and_bend(p, pinned_point(mode, p), sine, cosine)
    inertia = p[INERTIA] + reach * reach
    speed = state[COORDINATES + VERTICAL]
    spin = state[COORDINATES + ROTATION]
    lever_left = corner_lever(LEAVE, state, p)
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
def reaction(first: int, state: Vector, p: Vector) -> float:
    """Give the reaction of a touching corner, :eq:`eq-pad-force`."""
    rate = (
        state[COORDINATES + VERTICAL]
        + corner_lever(first, state, p) * state[COORDINATES + ROTATION]
    )
    return pad_force(corner_level(first, state, p), rate, p)


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
    rotation = state[ROTATION]
    spin = state[COORDINATES + ROTATION]
    if guard_index == PIVOT_GUARD:
        old_pivot = mode >> 4
        if old_pivot == PIVOT_CENTRE:  # the first lean decides; at rest the ground does
            pivot = leading_pivot(rotation, spin if spin != 0.0 else -ground_x)
            memory[LAST_EVENT] = SILENT
        else:
            state[ROTATION] = 0.0
            pivot = PIVOT_LEFT if old_pivot == PIVOT_RIGHT else PIVOT_RIGHT
            memory[LAST_EVENT] = PIVOT_CHANGE
        new = left + 4 * right + 16 * pivot
        repin(mode, new, state, p, memory)
        return new
    first = LEAVE if guard_index < RIGHT_GUARDS else RIGHT_GUARDS
    contact = left if first == LEAVE else right
    event = REENGAGEMENT
    land_left = False
    land_right = False
    if contact == RELAXING and guard_index == first + LEAVE:
        contact = CLEAR
        event = SILENT
    elif contact == ENGAGING and guard_index == first + TURN:
        contact = TOUCHING
        event = SILENT
    elif contact < RELAXING:
        contact = released(first, state, p)
        event = SEPARATION
    else:
        if contact == CLEAR:
            event = IMPACT
            land_left = first == LEAVE
            land_right = not land_left
        contact = TOUCHING
    if first == LEAVE:
        left = contact
    else:
        right = contact
    other = RIGHT_GUARDS if first == LEAVE else LEAVE
    if event == IMPACT and in_flight(mode):
        gap = corner_level(other, state, p) - p[SETTLEMENT]
        other_contact = right if first == LEAVE else left
        if other_contact == CLEAR and abs(gap) <= SIMULTANEOUS * p[SETTLEMENT]:
            left = TOUCHING
            right = TOUCHING
            land_left = True
            land_right = True
    elif event == SEPARATION:
        other_contact = right if first == LEAVE else left
        if other_contact == TOUCHING and reaction(other, state, p) <= 0.0:
            left = released(LEAVE, state, p)
            right = released(RIGHT_GUARDS, state, p)
    if contact == CLEAR:
        # the crossed level is set exactly, so that rounding cannot land the corner again
        state[VERTICAL] += p[SETTLEMENT] - corner_level(first, state, p)
    new = mode_of(left, right, rotation, spin, p)
    if in_flight(new) != in_flight(mode) or (new >> 4) != (mode >> 4):
        repin(mode, new, state, p, memory)
    if event == REENGAGEMENT and reaction(first, state, p) < 0.0:
        # re-pinning sped the corner up beyond its pad: let go, it would come back without end
        new += ENGAGING - TOUCHING if first == LEAVE else 4 * (ENGAGING - TOUCHING)
    if event == IMPACT:
        landing = LEAVE if land_left else RIGHT_GUARDS
        state[VERTICAL] += p[SETTLEMENT] - corner_level(landing, state, p)
        land(new, land_left, land_right, state, p, memory)
    memory[LAST_EVENT] = event
    return new
