"""Corners of the block and ends of the cap: levels, rates and reactions."""

import math

from rockframe.compiled import Vector, kernel
from rockframe.dynamics.bed import LEFT_END
from rockframe.dynamics.coupled_layout import (
    CAP_HALF_HEIGHT,
    CAP_HALF_WIDTH,
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
    ROTATION,
    SMALL,
)
from rockframe.dynamics.gliding import blend, speed_noise
from rockframe.dynamics.kinematics import end_height, end_lever, sine_cosine_rise
from rockframe.dynamics.pad import SIMULTANEOUS, forceless_rate, least_speed, pad_force


@kernel
def corner_level(first: int, state: Vector, p: Vector) -> float:
    """Give a corner's height above its place at rest on the cap."""
    side = 1.0 if first == LEFT_GUARDS else -1.0
    lift = end_height(side, p[HALF_HEIGHT], p[HALF_WIDTH], p[SMALL], state[ROTATION])
    return state[NORMAL] + lift


@kernel
def corner_lever(first: int, state: Vector, p: Vector) -> float:
    """Give the rate of a corner's height with psi."""
    side = 1.0 if first == LEFT_GUARDS else -1.0
    return end_lever(side, p[HALF_HEIGHT], p[HALF_WIDTH], p[SMALL], state[ROTATION])


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
def forceless(first: int, state: Vector, p: Vector) -> float:
    """Give the speed at which a corner rises with its pad without a force between them."""
    level = corner_level(first, state, p)
    return forceless_rate(level, p[PAD_STIFFNESS], p[PAD_DAMPING], p[PAD_SETTLEMENT])


@kernel
def answered_speed(p: Vector) -> float:
    """Give the least speed that a pad answers with more than rounding noise."""
    size = math.hypot(p[HALF_WIDTH], p[HALF_HEIGHT])
    return least_speed(size, p[GRAVITY], p[PAD_DAMPING], p[PAD_SETTLEMENT])


@kernel
def free_corner(first: int, direction: float, state: Vector, p: Vector) -> None:
    """Give a corner the speed at which its pad does not press, or one that rounding keeps beside.

    One that has risen to the pad's level is set there exactly.
    """
    level = corner_level(first, state, p)
    if level > (1.0 - SIMULTANEOUS) * p[PAD_SETTLEMENT]:
        state[NORMAL] += p[PAD_SETTLEMENT] - level
    beside = 0.0
    if direction != 0.0:
        beside = direction * max(corner_noise(first, state, p), answered_speed(p))
    target = forceless(first, state, p) + beside
    state[COORDINATES + NORMAL] += target - corner_rate(first, state, p)


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
