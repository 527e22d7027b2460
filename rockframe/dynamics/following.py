"""Equilibrium that is followed while loads or a rotation grow: Newton's steps along a path."""

import math
from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

import numpy as np

from rockframe.compiled import Matrix, Vector

TRIES: Final = 20
"""Newton's steps after which an equilibrium is not found."""
STEP: Final = 1e-3
"""By which rotations are moved for slopes, over their sizes."""
CLOSE: Final = 1e-12
"""Last change of a rotation, over itself and its size."""
NEAR: Final = 0.05
"""Change of a rotation from what is foreseen, and by Newton's steps, that is too large [rad]."""
LEAST_STEP: Final = 1e-3
"""Least share of the path by which equilibrium is followed."""

Turning = Callable[[float, Sequence[float]], list[float] | None]
"""Moments that vanish in equilibrium, by the place on the path and by rotations."""


class Sizes(NamedTuple):
    """What is small."""

    rotations: Vector  # their typical sizes
    moment: float  # that is rounding


class Path(NamedTuple):
    """An equilibrium on a path, and how it goes on."""

    at: float
    place: Vector  # rotations
    slope: Vector  # their change along the path

    @classmethod
    def origin(cls, count: int) -> "Path":
        """Give the beginning: all upright."""
        return cls(0.0, np.zeros(count), np.zeros(count))


def followed(turning: Turning, sizes: Sizes, path: Path, to: float = 1.0) -> Path | None:
    """Follow a stable equilibrium along a path; None where it ends."""
    way = to - path.at
    step, least = way, LEAST_STEP * abs(way)
    while path.at != to:
        ahead = to if abs(to - path.at) <= abs(step) else path.at + step
        guess = path.place + path.slope * (ahead - path.at)
        found = _balanced(lambda there, at=ahead: turning(at, there), guess, sizes)
        if found is not None and np.abs(found - guess).max() <= NEAR:
            path = Path(ahead, found, (found - path.place) / (ahead - path.at))
        elif abs(step) < least:
            return None
        else:
            step *= 0.5
    return path


def _balanced(
    moments: Callable[[list[float]], list[float] | None], guess: Vector, sizes: Sizes
) -> Vector | None:
    """Give a stable root of moments near a guess, by Newton's steps with the slopes of secants."""

    def at(place: Vector) -> Vector:
        found = moments(place.tolist())
        return np.full(len(place), math.nan) if found is None else np.array(found)

    def slopes_at(place: Vector) -> Matrix:
        steps = STEP * sizes.rotations
        moves = np.diag(steps)
        return np.array([at(place + move) - at(place - move) for move in moves]).T / (2.0 * steps)

    place, value, slopes = guess, at(guess), slopes_at(guess)
    for _ in range(TRIES):
        if not _finite(value, slopes) or not np.linalg.det(slopes):
            return None
        move = np.linalg.solve(slopes, -value)
        furthest = np.abs(move).max()
        if furthest > NEAR:
            move *= NEAR / furthest
        before, place = value, place + move
        value = at(place)
        if (np.abs(move) <= CLOSE * (np.abs(place) + sizes.rotations)).all():
            break
        slopes = slopes + np.outer(value - before - slopes @ move, move) / (move @ move)
    if not np.abs(value).max() <= sizes.moment:
        return None
    if len(place) > 1:  # a secant is the slope where there is but one rotation
        slopes = slopes_at(place)
    stable = _finite(slopes) and np.linalg.eigvalsh(slopes + slopes.T).max() < 0.0
    return place if stable else None


def _finite(*values: Matrix) -> bool:
    """Whether bases carry the bodies, and carry them a little beside too."""
    return all(bool(np.isfinite(one).all()) for one in values)
