"""Reading of masses and points of shapes, and the base of a body on level ground."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from numbers import Real
from typing import Any, Final, TypeAlias, TypeVar

import numpy as np
import pint

from rockframe.arguments import is_iterable
from rockframe.components.alternatives import OneOf
from rockframe.components.base import Component
from rockframe.errors import (
    ComponentError,
    ModelWarning,
    UnitsError,
    collected_warnings,
    short_repr,
    warn,
)
from rockframe.signals.arrays import Array
from rockframe.units import (
    DENSITY,
    INERTIA,
    LENGTH,
    MASS,
    POSITIVE,
    Quantity,
    QuantityLike,
    check_attached_unit,
    quantity_text,
    to_si,
)


@dataclass(frozen=True)
class PlaneMass:
    """A mass with its centre and its moment of inertia, in SI units."""

    mass: float
    x: float  # coordinates of its centre of mass, to the right
    y: float  # and upwards
    inertia: float  # about its centre of mass


Mass = TypeVar("Mass", bound=PlaneMass)


def mass_weighted_mean(masses: Sequence[Mass], value: Callable[[Mass], float]) -> float:
    """Return the mean of a value, weighted by mass."""
    # every fraction is at most 1, so that masses of any magnitude do not overflow
    total = sum(mass.mass for mass in masses)
    return math.fsum(value(mass) * (mass.mass / total) for mass in masses)


def centre_of_mass(masses: Sequence[PlaneMass]) -> tuple[float, float]:
    """Return the coordinates of the common centre of masses, :eq:`eq-parts-centre` [m]."""
    return mass_weighted_mean(masses, lambda mass: mass.x), mass_weighted_mean(
        masses, lambda mass: mass.y
    )


def combined_mass(masses: Sequence[PlaneMass]) -> PlaneMass:
    """Combine masses to one, by the parallel-axis theorem, :eq:`eq-parts-inertia`."""
    x, y = centre_of_mass(masses)
    total = sum(mass.mass for mass in masses)
    squares = mass_weighted_mean(
        masses, lambda mass: mass.inertia / mass.mass + math.hypot(mass.x - x, mass.y - y) ** 2
    )
    return PlaneMass(total, x, y, total * squares)


PointLike: TypeAlias = tuple[QuantityLike, QuantityLike]
PointsLike: TypeAlias = (
    Iterable[PointLike] | Iterable[tuple[float, float]] | Quantity | tuple[Any, str]
)

MASS_ALTERNATIVES: Final = OneOf("mass", ("density", "depth"))


def read_points(value: object, *, owner: str, name: str) -> Array:
    """Read points from pairs of lengths or an array with a unit, shape (n, 2) [m]."""
    message = (
        f"{owner}: {name} needs pairs of lengths, such as [('0 m', '0 m'), ('1 m', '0 m'), ...], "
        "or numbers of shape (n, 2) with their unit, (points, 'm')"
    )
    if isinstance(value, pint.Quantity):
        quantity: Any = value
        factor = to_si(type(quantity)(1, quantity.units), LENGTH, owner=owner, name=name)
        return _point_array(quantity.magnitude, factor, message)
    if isinstance(value, str | Mapping) or not is_iterable(value):
        msg = f"{message}; got {short_repr(value)}"
        raise ComponentError(msg)
    points: list[Any] = list(value)
    if len(points) == 2 and isinstance(points[1], str) and not isinstance(points[0], str):
        check_attached_unit(points[0], points[1], owner=owner, name=name)
        return _point_array(
            points[0], to_si(f"1 {points[1]}", LENGTH, owner=owner, name=name), message
        )
    if isinstance(value, np.ndarray) or _is_bare(points):
        msg = f"{message}; got {short_repr(value)}, bare numbers"
        raise UnitsError(msg)
    pairs = [read_point(point, owner=owner, name=f"{name}[{k}]") for k, point in enumerate(points)]
    return np.array(pairs, dtype=np.float64).reshape(-1, 2)


def _is_bare(points: list[Any]) -> bool:
    """Whether points are pairs of numbers without a unit."""
    return bool(points) and all(
        isinstance(point, list | tuple)
        and all(isinstance(coordinate, Real) for coordinate in point)
        for point in points
    )


def read_point(value: object, *, owner: str, name: str) -> tuple[float, float]:
    """Read a pair of lengths, or a Quantity of shape (2,) [m]."""
    pair: list[Any] = []
    if is_iterable(value) and not isinstance(value, str | Mapping):
        pair = list(value)
    if len(pair) != 2:
        msg = (
            f"{owner}: {name} needs two lengths, such as ('0.2 m', '1.5 m'), got "
            f"{short_repr(value)}"
        )
        raise ComponentError(msg)
    x, y = (
        to_si(coordinate, LENGTH, owner=owner, name=f"{name}[{k}]")
        for k, coordinate in enumerate(pair)
    )
    return x, y


def read_mass(values: Mapping[str, object], area: float, *, owner: str) -> float:
    """Read a mass, or compute it from density, depth and the area in the plane [kg]."""
    MASS_ALTERNATIVES.check(values, owner)

    def positive(name: str, measure: Any) -> float:
        return to_si(values[name], measure, owner=owner, name=name, condition=POSITIVE)

    if values.get("mass") is not None:
        return positive("mass", MASS)
    mass = positive("density", DENSITY) * (positive("depth", LENGTH) * area)
    if 0.0 < mass < math.inf:
        return mass
    msg = f"{owner}: density, depth and area give a mass of {mass:.4g} kg"
    raise ComponentError(msg)


def _point_array(values: object, factor: float, message: str) -> Array:
    try:
        array = np.asarray(values)
    except (ValueError, TypeError):  # rows of different lengths, or not an array
        array = np.array([None])
    if array.dtype.kind not in "fiu" or array.ndim != 2 or array.shape[1] != 2:
        found = f"shape {array.shape}" if array.dtype.kind in "fiu" else short_repr(values)
        msg = f"{message}; got {found}"
        raise ComponentError(msg)
    points = np.asarray(array, dtype=np.float64) * factor
    if not np.isfinite(points).all():
        msg = f"{message}; got a number that is not finite"
        raise ComponentError(msg)
    return points


ROUNDING: Final = 1e-9
"""Difference over the size of the body up to which heights count as equal [1]."""
MIN_ECCENTRICITY: Final = 1e-12
"""Eccentricity over the width of the base up to which it counts as zero [1]."""

ComponentType = TypeVar("ComponentType", bound=Component)


@dataclass(frozen=True)
class OutlineCorner:
    """A point of a body that may touch the ground, with its name."""

    words: str
    x: float
    y: float


@dataclass(frozen=True)
class BaseSegment:
    """Ends of the base and level of the ground [m]."""

    left: float
    right: float
    ground: float

    @property
    def middle(self) -> float:
        """Coordinate of the middle between the ends [m]."""
        return 0.5 * (self.left + self.right)

    def touching_angle(self, corner: OutlineCorner, side: float) -> float:
        """Return the rotation at which a corner touches the ground, :eq:`eq-touching-angle` [rad].

        It holds for a corner beyond the end of the base about which the body rocks; no other
        corner touches the ground before a rotation by a right angle.
        """
        end = self.right if side > 0.0 else self.left
        beyond = side * (corner.x - end)
        if beyond <= ROUNDING * (self.right - self.left):
            return 0.5 * math.pi
        return math.atan2(corner.y - self.ground, beyond)

    def overturning_angle(self, mass: PlaneMass, side: float) -> float:
        """Return the rotation at which the centre of mass is above an end of the base [rad]."""
        end = self.right if side > 0.0 else self.left
        return math.atan2(side * (end - mass.x), mass.y - self.ground)


def shaped_body(
    kind: Callable[..., ComponentType],
    mass: PlaneMass,
    base: BaseSegment,
    top: float,
    corners: Sequence[OutlineCorner],
    owner: str,
) -> ComponentType:
    """Make a block from mass and base; refuse a centre of mass that is not above the base.

    `top` is the height of the highest point [m]; `corners` may touch the ground beyond the base.
    """
    if not base.left < mass.x < base.right:
        msg = (
            f"{owner}: the body would fall on its own: its centre of mass, at x = {mass.x:.6g} m, "
            f"is not above its base, which extends from {base.left:.6g} m to "
            f"{base.right:.6g} m"
        )
        raise ComponentError(msg)
    width, eccentricity = base.right - base.left, mass.x - base.middle
    arguments = {
        "width": quantity_text(width, LENGTH),
        "height": quantity_text(top - base.ground, LENGTH),
        "mass": quantity_text(mass.mass, MASS),
        "inertia": quantity_text(mass.inertia, INERTIA),
        "centre_height": quantity_text(mass.y - base.ground, LENGTH),
    }
    if abs(eccentricity) > MIN_ECCENTRICITY * width:
        arguments["eccentricity"] = quantity_text(eccentricity, LENGTH)
    with collected_warnings():  # a body wider than its base may exceed the bound of its inertia
        body = kind(**arguments)
    for caution in _contact_warnings(mass, base, corners):
        warn(f"{owner}: {caution}", ModelWarning)
    return body


def _contact_warnings(
    mass: PlaneMass, base: BaseSegment, corners: Sequence[OutlineCorner]
) -> Iterator[str]:
    for side, word in ((1.0, "right"), (-1.0, "left")):
        limit = base.overturning_angle(mass, side)
        corner = min(
            corners, key=lambda candidate: base.touching_angle(candidate, side), default=None
        )
        angle = limit if corner is None else base.touching_angle(corner, side)
        if corner is not None and angle < limit:
            yield (
                f"leaning to the {word}, {corner.words}, at ({corner.x:.6g} m, {corner.y:.6g} m), "
                f"touches the ground at {angle:.4g} rad, before the overturning angle of that "
                f"side, {limit:.4g} rad; the model ignores this contact"
            )
