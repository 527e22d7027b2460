"""How a body stands on level ground: the ends of its base, and what else would touch."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeVar

from rockframe.components.base import Component
from rockframe.components.shapes.reading import PlaneMass
from rockframe.errors import ComponentError, ModelWarning, collected_warnings, warn
from rockframe.units import INERTIA, LENGTH, MASS

ROUNDING: Final = 1e-9
"""Relative to a body's size: heights that differ by less are one."""
CENTRED: Final = 1e-12
"""Relative to the base: a centre of mass that is less beside its middle is above it."""

Made = TypeVar("Made", bound=Component)


@dataclass(frozen=True)
class OutlineCorner:
    """A point of a body that may touch the ground, and what it is called."""

    words: str
    x: float
    y: float


@dataclass(frozen=True)
class Stance:
    """Ends of the base and level of the ground [m]."""

    left: float
    right: float
    ground: float

    @property
    def middle(self) -> float:
        """Between the ends [m]."""
        return 0.5 * (self.left + self.right)

    def touching_angle(self, corner: OutlineCorner, side: float) -> float:
        """Give the rotation at which a corner comes down, :eq:`eq-touching-angle` [rad].

        That is for a corner beyond the end of the base about which the body rocks; no other
        comes down before the body has turned by a right angle.
        """
        end = self.right if side > 0.0 else self.left
        beyond = side * (corner.x - end)
        if beyond <= ROUNDING * (self.right - self.left):
            return 0.5 * math.pi
        return math.atan2(corner.y - self.ground, beyond)

    def overturning_angle(self, whole: PlaneMass, side: float) -> float:
        """Give the rotation at which the centre of mass is above an end of the base [rad]."""
        end = self.right if side > 0.0 else self.left
        return math.atan2(side * (end - whole.x), whole.y - self.ground)


def shaped_body(
    kind: Callable[..., Made],
    whole: PlaneMass,
    stance: Stance,
    top: float,
    corners: Sequence[OutlineCorner],
    owner: str,
) -> Made:
    """Make a block of its mass and base; refuse a centre of mass that is not above the base.

    `top` is the height of the highest point [m]; `corners` may touch the ground beside the base.
    """
    if not stance.left < whole.x < stance.right:
        msg = (
            f"{owner}: the body would fall on its own: its centre of mass, at x = {whole.x:.6g} m, "
            f"is not above its base, which goes from {stance.left:.6g} m to {stance.right:.6g} m"
        )
        raise ComponentError(msg)
    width, beside = stance.right - stance.left, whole.x - stance.middle
    arguments = {
        "width": _written(width, LENGTH),
        "height": _written(top - stance.ground, LENGTH),
        "mass": _written(whole.mass, MASS),
        "inertia": _written(whole.inertia, INERTIA),
        "centre_height": _written(whole.y - stance.ground, LENGTH),
    }
    if abs(beside) > CENTRED * width:
        arguments["eccentricity"] = _written(beside, LENGTH)
    with collected_warnings():  # it may reach out beside its base, beyond the bound of its inertia
        made = kind(**arguments)
    for caution in _touching(whole, stance, corners):
        warn(f"{owner}: {caution}", ModelWarning)
    return made


def _touching(whole: PlaneMass, stance: Stance, corners: Sequence[OutlineCorner]) -> Iterator[str]:
    for side, word in ((1.0, "right"), (-1.0, "left")):
        limit = stance.overturning_angle(whole, side)
        corner = min(corners, key=lambda one: stance.touching_angle(one, side), default=None)
        angle = limit if corner is None else stance.touching_angle(corner, side)
        if corner is not None and angle < limit:
            yield (
                f"leaning to the {word}, {corner.words}, at ({corner.x:.6g} m, {corner.y:.6g} m), "
                f"touches the ground at {angle:.4g} rad, before the overturning angle of that "
                f"side, {limit:.4g} rad; the model lets it through"
            )


def _written(value: float, measure: Any) -> str:
    return f"{float(value)!r} {measure.unit}"
