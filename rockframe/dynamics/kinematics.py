"""Kinematics of a rigid body that stands on a base, :eq:`eq-kinematics`.

Functions of plain numbers, for a block as for a cap: half height h (of the centre
of mass above the base), half width b, rotation a. `small` is 1 where the kinematics
are expanded to second order in the rotation, else 0.
"""

import math
from typing import Final

from rockframe.compiled import inlined, kernel

# restraint rules
BY_CONTACT: Final = 0
LEADING_CORNER: Final = 1
CENTRE: Final = 2

# pivots: the point of the base that is held horizontally
PIVOT_CENTRE: Final = 0  # e = 0
PIVOT_RIGHT: Final = 1  # e = +b
PIVOT_LEFT: Final = 2  # e = -b


@kernel
def sine_cosine_rise(
    half_height: float, small: float, rotation: float
) -> tuple[float, float, float]:
    """Give sin a, cos a and h(1 - cos a), or their small-rotation forms."""
    if small != 0.0:
        return rotation, 1.0, 0.5 * half_height * rotation * rotation
    sine = math.sin(rotation)
    cosine = math.cos(rotation)
    # sin^2/(1 + cos) keeps its digits at small rotation; past a right angle 1 - cos does
    if cosine > 0.0:
        return sine, cosine, half_height * sine * sine / (1.0 + cosine)
    return sine, cosine, half_height * (1.0 - cosine)


@kernel
def pinned_point(pivot: int, half_width: float) -> float:
    """Give e, the base coordinate of the horizontally restrained point."""
    if pivot == PIVOT_RIGHT:
        return half_width
    if pivot == PIVOT_LEFT:
        return -half_width
    return 0.0


@kernel
def reach_and_bend(
    half_height: float, small: float, pin: float, sine: float, cosine: float
) -> tuple[float, float]:
    """Give dx/da and d2x/da2 of the centre of mass about the pinned point."""
    if small != 0.0:
        return half_height, 0.0
    return half_height * cosine + pin * sine, pin * cosine - half_height * sine


@kernel
def about_pin(half_height: float, small: float, pin: float, rotation: float) -> float:
    """Give h sin a - e cos a, the centre of mass seen from the pinned point."""
    if small != 0.0:
        return half_height * rotation
    return half_height * math.sin(rotation) - pin * math.cos(rotation)


@kernel
def end_height(
    side: float, half_height: float, half_width: float, small: float, rotation: float
) -> float:
    """Give h(1 - cos a) +/- b sin a: how a rotation lifts the left (side 1) or right end (-1)."""
    sine, _, rise = sine_cosine_rise(half_height, small, rotation)
    return rise + side * half_width * sine


@kernel
def end_lever(
    side: float, half_height: float, half_width: float, small: float, rotation: float
) -> float:
    """Give h sin a +/- b cos a, the rate of that with the rotation."""
    sine, cosine, _ = sine_cosine_rise(half_height, small, rotation)
    return half_height * sine + side * half_width * cosine


@inlined
def end_accelerations(
    half_height: float,
    half_width: float,
    small: float,
    sine: float,
    cosine: float,
    spin: float,
    lift: float,
    turn: float,
) -> tuple[float, float]:
    """Give the vertical accelerations of the base's left and right ends.

    `lift` and `turn` are those of the centre of mass and of the rotation; the levers
    change by l' = h cos a -/+ b sin a.
    """
    arch = half_height if small != 0.0 else half_height * cosine
    twist = 0.0 if small != 0.0 else half_width * sine
    middle = lift + half_height * sine * turn + arch * spin * spin
    tilt = half_width * cosine * turn - twist * spin * spin
    return middle + tilt, middle - tilt


@kernel
def leading_pivot(rotation: float, tendency: float) -> int:
    """Give the pivot of the corner that a body leans to, or tends to."""
    leading = rotation if rotation != 0.0 else tendency
    if leading == 0.0:
        return PIVOT_CENTRE
    return PIVOT_RIGHT if leading > 0.0 else PIVOT_LEFT


@kernel
def pivot_of(rule: float, left_free: bool, right_free: bool, rotation: float, spin: float) -> int:
    """Give the pivot that a restraint rule asks of a body whose base bears somewhere."""
    if rule == BY_CONTACT:
        if left_free:
            return PIVOT_RIGHT
        if right_free:
            return PIVOT_LEFT
        return PIVOT_CENTRE
    if rule == LEADING_CORNER:
        return leading_pivot(rotation, spin)
    return PIVOT_CENTRE


@kernel
def pivot_guard(
    rule: float, pivot: int, angle: float, rotation: float, spin: float, turn: float
) -> tuple[float, float]:
    """Give the guard of the rule that the leading corner is held, and its rate."""
    if rule != LEADING_CORNER:
        return 1.0, 0.0
    if pivot == PIVOT_CENTRE:  # upright and at rest: whichever corner it leans to
        departure = spin if spin != 0.0 else turn
        return -abs(rotation) / angle, -abs(departure) / angle
    side = 1.0 if pivot == PIVOT_RIGHT else -1.0
    return side * rotation / angle, side * spin / angle
