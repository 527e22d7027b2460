"""Impulses in the coupled system: landings, and restraints that take hold.

Momentum is projected as for two pads on the ground and for a bed: :eq:`eq-coupled-impulse`.
"""

from rockframe.compiled import Vector, kernel
from rockframe.dynamics.coupled_corners import corner_lever, corner_rate
from rockframe.dynamics.coupled_layout import (
    ALONG,
    CAP_HALF_HEIGHT,
    CAP_HALF_WIDTH,
    CAP_HORIZONTAL,
    CAP_MASS,
    CAP_ROTATION,
    CAP_VERTICAL,
    COORDINATES,
    LEFT_GUARDS,
    NORMAL,
    RESTITUTION,
    RIGHT_GUARDS,
    ROTATION,
    SMALL,
    block_pivot,
    cap_pivot,
)
from rockframe.dynamics.coupled_motion import (
    Motion,
    along_rate,
    cap_position,
    cap_sway,
    configuration,
    solve_motion,
)
from rockframe.dynamics.kinematics import about_pin, pinned_point
from rockframe.dynamics.protocol import HORIZONTAL_REFERENCE, IMPACT_LOSS, REPINNING_LOSS
from rockframe.dynamics.single_body import FREE


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
