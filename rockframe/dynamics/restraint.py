"""The point of a base that is held horizontally: rules, pivots and their guard."""

from typing import Final

from rockframe.compiled import inlined, kernel

# rules
BY_CONTACT: Final = 0
LEADING_CORNER: Final = 1
CENTRE: Final = 2

# pivots: the point of the base that is held
PIVOT_CENTRE: Final = 0
PIVOT_RIGHT: Final = 1
PIVOT_LEFT: Final = 2


@kernel
def leading_pivot(rotation: float, tendency: float) -> int:
    """Give the pivot of the corner that a body leans to, or tends to."""
    leading = rotation if rotation != 0.0 else tendency
    if leading == 0.0:
        return PIVOT_CENTRE
    return PIVOT_RIGHT if leading > 0.0 else PIVOT_LEFT


@kernel
def pivot_of(
    rule: int, holds_left: bool, holds_right: bool, rotation: float, angular_velocity: float
) -> int:
    """Give the pivot that a rule asks of a body whose base bears somewhere."""
    if rule == BY_CONTACT:
        if not holds_left:
            return PIVOT_RIGHT
        if not holds_right:
            return PIVOT_LEFT
        return PIVOT_CENTRE
    if rule == LEADING_CORNER:
        return leading_pivot(rotation, angular_velocity)
    return PIVOT_CENTRE


@inlined
def pivot_guard(
    rule: int,
    pivot: int,
    scale: float,
    rotation: float,
    angular_velocity: float,
    angular_acceleration: float,
) -> tuple[float, float]:
    """Give the guard of the rule that the leading corner is held, and its rate."""
    if rule != LEADING_CORNER:
        return 1.0, 0.0
    if pivot == PIVOT_CENTRE:  # upright and at rest: whichever corner it leans to
        departure = angular_velocity if angular_velocity != 0.0 else angular_acceleration
        return -abs(rotation) / scale, -abs(departure) / scale
    side = (1.0 if pivot == PIVOT_RIGHT else -1.0) / scale
    return side * rotation, side * angular_velocity
