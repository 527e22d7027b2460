"""A body from its outline in the plane of rocking."""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from rockframe.components.shapes.masses import PlaneMass
from rockframe.components.shapes.polygon import (
    crossing,
    extent_of,
    is_flat,
    region,
    turning_back,
)
from rockframe.components.shapes.reading import read_mass, read_points
from rockframe.components.shapes.standing import (
    ROUNDING,
    OutlineCorner,
    ShapedBody,
    Stance,
    shaped_body,
)
from rockframe.errors import ComponentError
from rockframe.signals.arrays import Array


def outline_body(points: object, given: Mapping[str, object], owner: str) -> ShapedBody:
    """Find how a body of a given outline stands."""
    whole, corners = outline_mass(points, given, owner, "points")
    ground = min(corner.y for corner in corners)
    slack = ROUNDING * _size(corners)
    lowest = [corner.x for corner in corners if corner.y <= ground + slack]
    if max(lowest) - min(lowest) <= slack:
        _refuse_single(corners, owner)
    top = max(corner.y for corner in corners)
    stance = Stance(min(lowest), max(lowest), ground)
    return shaped_body(whole, stance, top, corners, owner)


def outline_mass(
    points: object, given: Mapping[str, object], owner: str, name: str
) -> tuple[PlaneMass, list[OutlineCorner]]:
    """Read an outline, check that it is a simple polygon, and give its mass and corners."""
    read = read_points(points, owner=owner, name=name)
    # a point that repeats the one before, as the last may repeat the first, is no corner
    kept = [k for k in range(len(read)) if (read[k] != read[k - 1]).any()]
    corners = [OutlineCorner(f"{name}[{k}]", float(read[k, 0]), float(read[k, 1])) for k in kept]
    _check_simple(read[kept], corners, owner)
    inside = region(read[kept])
    mass = read_mass(given, inside.area, owner=owner)
    return PlaneMass(mass, inside.x, inside.y, mass * inside.mean_square), corners


def _check_simple(points: Array, corners: Sequence[OutlineCorner], owner: str) -> None:
    if len(points) < 3:
        msg = f"{owner}: an outline needs three different points or more, got {len(points)}"
        raise ComponentError(msg)
    if is_flat(points):
        msg = f"{owner}: the outline has no area: all its points lie on one line"
        raise ComponentError(msg)
    scaled = (points - points.mean(axis=0)) / extent_of(points)
    back = turning_back(scaled)
    if back is not None:
        msg = f"{owner}: the outline turns back on itself at {_at(corners[back])}"
        raise ComponentError(msg)
    both = crossing(scaled)
    if both is not None:
        first, second = (
            f"from {_at(corners[k])} to {_at(corners[(k + 1) % len(corners)])}" for k in both
        )
        msg = (
            f"{owner}: the outline crosses or touches itself: its edge {first} meets that "
            f"{second}; are the points in their order around the body?"
        )
        raise ComponentError(msg)


def _refuse_single(corners: Sequence[OutlineCorner], owner: str) -> None:
    heights = np.array([corner.y for corner in corners])
    first, second = (int(k) for k in np.argsort(heights, kind="stable")[:2])
    low, next_low = corners[first], corners[second]
    rise, run = next_low.y - low.y, next_low.x - low.x
    msg = (
        f"{owner}: the outline stands on one point, {_at(low)}; the next lowest, {_at(next_low)}, "
        f"is {rise:.4g} m higher. A base needs two lowest points at one height"
    )
    if (second - first) % len(corners) in (1, len(corners) - 1):
        slope = math.copysign(math.degrees(math.atan2(rise, abs(run))), run)
        msg += (
            f": the edge between these is inclined by {slope:.4g} deg; turn the outline until it "
            f"is level, and where the ground slopes so give System(..., inclination='{slope:.4g} "
            "deg')"
        )
    raise ComponentError(msg)


def _at(corner: OutlineCorner) -> str:
    return f"{corner.words} ({corner.x:.6g} m, {corner.y:.6g} m)"


def _size(corners: Sequence[OutlineCorner]) -> float:
    return extent_of(np.array([(corner.x, corner.y) for corner in corners]))
