"""A body from its outline in the plane of rocking, or a cylinder."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from rockframe.components.alternatives import OneOf
from rockframe.components.shapes.standing import (
    ROUNDING,
    BaseSegment,
    ComponentType,
    OutlineCorner,
    PlaneMass,
    PointsLike,
    read_mass,
    read_points,
    shaped_body,
)
from rockframe.errors import ComponentError
from rockframe.signals.arrays import Array
from rockframe.suggestions import with_hints
from rockframe.units import (
    DENSITY,
    LENGTH,
    MASS,
    POSITIVE,
    THICKNESS,
    Measure,
    QuantityLike,
    degrees_text,
    to_si,
)

_THIN: Final = 1e-12  # thickness over size below which an outline has no area


def polygon_properties(points: Array) -> tuple[float, float, float, float]:
    """Return area, centroid and mean square distance from it, from :eq:`eq-polygon-area` on.

    The points are the corners in order, clockwise or anticlockwise. The sums follow from Green's
    theorem and are exact (Steger 1996). They use coordinates from the middle of the polygon,
    divided by its size, so that a distant origin costs no digits.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    middle, size = 0.5 * (low + high), extent(points)
    x, y = ((points - middle) / size).T
    twice = _twice_areas(x, y)
    area = 0.5 * math.fsum(twice)  # negative if clockwise
    across = math.fsum((x + np.roll(x, -1)) * twice) / (6.0 * area)
    up = math.fsum((y + np.roll(y, -1)) * twice) / (6.0 * area)
    x, y = x - across, y - up
    polar = math.fsum(_twice_areas(x, y) * (_mean_squares(x) + _mean_squares(y))) / 12.0
    centroid = float(middle[0] + size * across), float(middle[1] + size * up)
    return abs(area) * size * size, *centroid, polar / area * size * size


def extent(points: Array) -> float:
    """Return the greater of width and height [m]."""
    return float(np.ptp(points, axis=0).max())


def is_flat(points: Array) -> bool:
    """Tell whether all points lie on one line, up to rounding."""
    size = extent(points)
    if not 0.0 < size < math.inf:
        return True
    spread = np.linalg.svd((points - points.mean(axis=0)) / size, compute_uv=False)
    return bool(spread[-1] <= _THIN * len(points))


def find_reversal(points: Array) -> int | None:
    """Find a corner at which an outline turns back on itself, if there is one."""
    before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    along = (before * after).sum(axis=1)
    reversals = np.flatnonzero((along < 0.0) & (np.abs(cross) <= -_THIN * along))
    return int(reversals[0]) if len(reversals) else None


def find_crossing(points: Array) -> tuple[int, int] | None:
    """Find two edges that cross or touch, other than neighbours, if there are any."""
    starts, ends = points, np.roll(points, -1, axis=0)
    left, low = np.minimum(starts, ends).T.copy()
    right, high = np.maximum(starts, ends).T.copy()
    count = len(points)
    for edge in range(count - 2):
        # the last edge is a neighbour of the first
        others = slice(edge + 2, count - 1 if edge == 0 else count)
        near = (left[others] <= right[edge]) & (right[others] >= left[edge])
        near &= (low[others] <= high[edge]) & (high[others] >= low[edge])
        nearby = edge + 2 + np.flatnonzero(near)
        if not len(nearby):
            continue
        start, end = starts[edge], ends[edge]
        apart = _side(start, end, starts[nearby]) * _side(start, end, ends[nearby])
        other_way = _side(starts[nearby], ends[nearby], start) * _side(
            starts[nearby], ends[nearby], end
        )
        crossed = nearby[(apart <= 0.0) & (other_way <= 0.0)]
        if len(crossed):
            return edge, int(crossed[0])
    return None


def _mean_squares(x: Array) -> Array:
    """Return six times the mean square over the triangle of the origin and each edge."""
    # in an order that gives the same rounding in both directions
    ahead = np.roll(x, -1)
    return (x * x + ahead * ahead) + x * ahead


def _twice_areas(x: Array, y: Array) -> Array:
    """Return twice the area between the origin and each edge."""
    return x * np.roll(y, -1) - np.roll(x, -1) * y


def _side(start: Array, end: Array, point: Array) -> npt.NDArray[Any]:
    """Tell on which side of a line through two points a third one lies: 1, 0 or -1."""
    along, aside = end - start, point - start
    return np.sign(along[..., 0] * aside[..., 1] - along[..., 1] * aside[..., 0])


def outline_mass(
    points: object, values: Mapping[str, object], owner: str, name: str
) -> tuple[PlaneMass, list[OutlineCorner]]:
    """Read an outline, check that it is a simple polygon, and give its mass and corners."""
    read = read_points(points, owner=owner, name=name)
    # points that repeat the one before are left out; the first follows the last
    distinct = [k for k in range(len(read)) if (read[k] != read[k - 1]).any()]
    corners = [
        OutlineCorner(f"{name}[{k}]", float(read[k, 0]), float(read[k, 1])) for k in distinct
    ]
    _check_simple(read[distinct], corners, owner)
    area, x, y, mean_square = polygon_properties(read[distinct])
    mass = read_mass(values, area, owner=owner)
    return PlaneMass(mass, x, y, mass * mean_square), corners


def _check_simple(points: Array, corners: Sequence[OutlineCorner], owner: str) -> None:
    if len(points) < 3:
        msg = f"{owner}: an outline needs three different points or more, got {len(points)}"
        raise ComponentError(msg)
    if is_flat(points):
        msg = f"{owner}: the outline has no area: all its points lie on one line"
        raise ComponentError(msg)
    scaled = (points - points.mean(axis=0)) / extent(points)
    back = find_reversal(scaled)
    if back is not None:
        msg = f"{owner}: the outline turns back on itself at {_corner_text(corners[back])}"
        raise ComponentError(msg)
    both = find_crossing(scaled)
    if both is not None:
        first, second = (
            f"from {_corner_text(corners[k])} to {_corner_text(corners[(k + 1) % len(corners)])}"
            for k in both
        )
        msg = (
            f"{owner}: the outline crosses or touches itself: its edge {first} meets that "
            f"{second}; are the points in their order around the body?"
        )
        raise ComponentError(msg)


def _raise_single_point_base(corners: Sequence[OutlineCorner], owner: str) -> None:
    heights = np.array([corner.y for corner in corners])
    first, second = (int(k) for k in np.argsort(heights, kind="stable")[:2])
    low, next_low = corners[first], corners[second]
    rise, run = next_low.y - low.y, next_low.x - low.x
    msg = (
        f"{owner}: the outline stands on one point, {_corner_text(low)}; the next lowest, "
        f"{_corner_text(next_low)}, is {rise:.4g} m higher. A base needs two lowest points at one "
        "height"
    )
    if (second - first) % len(corners) in (1, len(corners) - 1):
        slope = math.copysign(math.atan2(rise, abs(run)), run)
        msg += (
            f": the edge between these is inclined by {degrees_text(slope)}; rotate the outline "
            f"until it is level, and for ground with this slope give System(..., "
            f"inclination='{math.degrees(slope):.4g} deg')"
        )
    raise ComponentError(msg)


def _corner_text(corner: OutlineCorner) -> str:
    return f"{corner.words} ({corner.x:.6g} m, {corner.y:.6g} m)"


@with_hints()
def from_outline(
    cls: type[ComponentType],
    points: PointsLike,
    *,
    unit: str | None = None,
    density: QuantityLike | None = None,
    depth: QuantityLike | None = None,
    mass: QuantityLike | None = None,
) -> ComponentType:
    """Build a body from its outline in the plane of rocking.

    Parameters
    ----------
    points : sequence of (x, y), or array with a unit
        Corners of the outline in order, clockwise or anticlockwise: pairs of lengths, a
        Quantity of shape (n, 2), or such an array and a unit; x to the right, y upwards,
        from any origin. The first corner need not be repeated [m].
    unit : str, optional
        Unit of points that are bare numbers.
    density, depth : str or Quantity, optional
        Mass per volume [kg m^-3], and size perpendicular to the plane [m].
    mass : str or Quantity, optional
        Mass, instead of both, distributed evenly over the outline [kg].

    Returns
    -------
    Block

    Raises
    ------
    UnitsError
        A coordinate or another value has no unit, or one of the wrong kind.
    ComponentError
        The outline has fewer than three points or no area, crosses or touches itself, or
        stands on a single point; the centre of mass is not above the base; not exactly
        one of mass and density is given; or as for :class:`Block`.

    Warns
    -----
    ModelWarning
        A corner beyond the base would touch the ground before the body overturns; the
        model ignores this contact.

    Notes
    -----
    The base extends from the leftmost to the rightmost of the lowest corners, so that a body
    with feet stands on these. Heights that differ by 1e-9 of the size or less count as equal.
    Mass, centre of mass and moment of inertia are exact, :eq:`eq-polygon-inertia`. An inclined
    base is refused.

    Examples
    --------
    >>> from rockframe import Block
    >>> wall = Block.from_outline(
    ...     [("0 m", "0 m"), ("0.6 m", "0 m"), ("0.2 m", "2 m"), ("0 m", "2 m")],
    ...     density="2400 kg/m^3",
    ...     depth="1 m",
    ... )
    >>> round(wall.mass.m_as("kg"), 6), round(wall.eccentricity.m_as("m"), 4)
    (1920.0, -0.0833)
    """
    owner = f"{cls.__name__}.from_outline"
    written = points if unit is None else (points, unit)
    values = {"mass": mass, "density": density, "depth": depth}
    body_mass, corners = outline_mass(written, values, owner, "points")
    ground, top = (of(corner.y for corner in corners) for of in (min, max))
    slack = ROUNDING * extent(np.array([(corner.x, corner.y) for corner in corners]))
    lowest = [corner.x for corner in corners if corner.y <= ground + slack]
    if max(lowest) - min(lowest) <= slack:
        _raise_single_point_base(corners, owner)
    return shaped_body(
        cls, body_mass, BaseSegment(min(lowest), max(lowest), ground), top, corners, owner
    )


@with_hints()
def cylinder(
    cls: type[ComponentType],
    *,
    diameter: QuantityLike,
    height: QuantityLike,
    mass: QuantityLike | None = None,
    density: QuantityLike | None = None,
    wall_thickness: QuantityLike | None = None,
) -> ComponentType:
    """Build a circular cylinder that rocks in a plane, such as a drum or a column.

    Parameters
    ----------
    diameter, height : str or Quantity
        Outer size [m].
    mass : str or Quantity, optional
        Mass [kg].
    density : str or Quantity, optional
        Mass per volume, instead of `mass` [kg m^-3].
    wall_thickness : str or Quantity, optional
        Wall thickness of a tube that is open at both ends; solid unless given [m].

    Returns
    -------
    Block

    Raises
    ------
    UnitsError
        A value has no unit, or one of the wrong kind.
    ComponentError
        A value is out of range, not exactly one of mass and density is given, or as for
        :class:`Block`.

    Notes
    -----
    The moment of inertia is :eq:`eq-cylinder-inertia`. A real cylinder that lands on its base
    rolls on along its rim, out of the plane (Srinivasan and Ruina 2008). The model keeps it in
    the plane, where it rocks from one end of a diameter to the other.

    Examples
    --------
    >>> from rockframe import Block
    >>> drum = Block.cylinder(diameter="1 m", height="3 m", density="2700 kg/m^3")
    >>> round(drum.mass.m_as("t"), 3), round(drum.shape_factor, 3)
    (6.362, 3.077)
    """
    owner = f"{cls.__name__}.cylinder"

    def positive(value: object, name: str, measure: Measure) -> float:
        return to_si(value, measure, owner=owner, name=name, condition=POSITIVE)

    outer, inner = 0.5 * positive(diameter, "diameter", LENGTH), 0.0
    top = positive(height, "height", LENGTH)
    if wall_thickness is not None:
        thickness = positive(wall_thickness, "wall_thickness", THICKNESS)
        if thickness >= outer:
            msg = (
                f"{owner}: wall_thickness must be less than half the diameter, {outer:.6g} m, got "
                f"{thickness:.6g} m; leave it out for a solid cylinder"
            )
            raise ComponentError(msg)
        inner = outer - thickness
    OneOf("mass", "density").check({"mass": mass, "density": density}, owner)
    if mass is not None:
        total_mass = positive(mass, "mass", MASS)
    else:
        area = math.pi * (outer - inner) * (outer + inner)
        total_mass = positive(density, "density", DENSITY) * (area * top)
    inertia = total_mass * (3.0 * (outer * outer + inner * inner) + top * top) / 12.0
    body_mass = PlaneMass(total_mass, 0.0, 0.5 * top, inertia)
    return shaped_body(cls, body_mass, BaseSegment(-outer, outer, 0.0), top, (), owner)
