"""Polygons: area, centroid, second moment, and whether they are simple."""

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from rockframe.signals.arrays import Array

_THIN: Final = 1e-12  # of the size: what is thinner has no area


@dataclass(frozen=True)
class Region:
    """Area inside a polygon, its centroid, and how far it is spread about that."""

    area: float
    x: float
    y: float
    mean_square: float
    """Mean square distance from the centroid, the polar second moment over the area [m^2]."""


def region(points: Array) -> Region:
    """Integrate over a simple polygon, :eq:`eq-polygon-area` to :eq:`eq-polygon-inertia`.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        Corners in their order, either way round; the first is not repeated [m].

    Returns
    -------
    Region

    Notes
    -----
    Exact sums by Green's theorem (Steger 1996), about the middle of the polygon and in parts of
    its size, so that a far origin costs no digits.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    middle, size = 0.5 * (low + high), extent_of(points)
    x, y = ((points - middle) / size).T
    area, across, up = _first_moments(x, y)
    x, y = x - across, y - up
    polar = math.fsum(_twice(x, y) * (_squares(x) + _squares(y))) / 12.0
    return Region(
        area=abs(area) * size * size,
        x=float(middle[0] + size * across),
        y=float(middle[1] + size * up),
        mean_square=polar / area * size * size,
    )


def extent_of(points: Array) -> float:
    """Give the greater of width and height [m]."""
    return float(np.ptp(points, axis=0).max())


def is_flat(points: Array) -> bool:
    """Tell whether all points lie on one line, but for rounding."""
    size = extent_of(points)
    if not 0.0 < size < math.inf:
        return True
    spread = np.linalg.svd((points - points.mean(axis=0)) / size, compute_uv=False)
    return bool(spread[-1] <= _THIN * len(points))


def turning_back(points: Array) -> int | None:
    """Find a corner at which an outline turns back on itself, if there is one."""
    before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    along = (before * after).sum(axis=1)
    found = np.flatnonzero((along < 0.0) & (np.abs(cross) <= -_THIN * along))
    return int(found[0]) if len(found) else None


def crossing(points: Array) -> tuple[int, int] | None:
    """Find two edges that cross or touch, other than neighbours, if there are any."""
    starts, ends = points, np.roll(points, -1, axis=0)
    left, low = np.minimum(starts, ends).T.copy()
    right, high = np.maximum(starts, ends).T.copy()
    count = len(points)
    for one in range(count - 2):
        # the last edge is a neighbour of the first
        others = slice(one + 2, count - 1 if one == 0 else count)
        near = (left[others] <= right[one]) & (right[others] >= left[one])
        near &= (low[others] <= high[one]) & (high[others] >= low[one])
        nearby = one + 2 + np.flatnonzero(near)
        if not len(nearby):
            continue
        start, end = starts[one], ends[one]
        apart = _side(start, end, starts[nearby]) * _side(start, end, ends[nearby])
        other_way = _side(starts[nearby], ends[nearby], start) * _side(
            starts[nearby], ends[nearby], end
        )
        found = nearby[(apart <= 0.0) & (other_way <= 0.0)]
        if len(found):
            return one, int(found[0])
    return None


def _first_moments(x: Array, y: Array) -> tuple[float, float, float]:
    """Give the area, negative if clockwise, and the centroid."""
    twice = _twice(x, y)
    area = 0.5 * math.fsum(twice)
    across = math.fsum((x + np.roll(x, -1)) * twice) / (6.0 * area)
    up = math.fsum((y + np.roll(y, -1)) * twice) / (6.0 * area)
    return area, across, up


def _squares(x: Array) -> Array:
    """Give six times the mean square over the triangle of the origin and each edge."""
    # in an order that is the same either way round
    ahead = np.roll(x, -1)
    return (x * x + ahead * ahead) + x * ahead


def _twice(x: Array, y: Array) -> Array:
    """Give twice the area between the origin and each edge."""
    return x * np.roll(y, -1) - np.roll(x, -1) * y


def _side(start: Array, end: Array, point: Array) -> npt.NDArray[Any]:
    """Tell on which side of a line through two points a third one lies: 1, 0 or -1."""
    along, aside = end - start, point - start
    return np.sign(along[..., 0] * aside[..., 1] - along[..., 1] * aside[..., 0])
