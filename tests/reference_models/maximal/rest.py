"""Static equilibrium of a body with an eccentric centre of mass.

The tilt determines where the resultant of the base acts; at rest it acts under the weight.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq, root

from . import layout as at
from .scene import Scene

SHARES = 400


class NoRestError(Exception):
    """The body falls by its own weight."""


@dataclass(frozen=True)
class Rest:
    """Rotations of both bodies relative to their bases, and heights of the middles of the bases."""

    lower_angle: float = 0.0
    lower_height: float = 0.0
    angle: float = 0.0
    height: float = 0.0


def lowered(small: bool, point: float, level: float, angle: float) -> float:
    """Return how far the centre of mass moves across as a body tilts about a point of its base."""
    if small:
        return level * angle
    return level * math.sin(angle) + point * (1.0 - math.cos(angle))


def rest_of(scene: Scene, p: np.ndarray) -> Rest:
    """Return the position of rest of the bodies.

    Raises
    ------
    NoRestError
    """
    if scene.eccentricity == 0.0:
        return Rest()
    if scene.kind == "bed":
        return Rest(*_alone(scene, p, lower=True))
    if scene.kind == "pads":
        return Rest(0.0, 0.0, *_alone(scene, p, lower=False))
    if scene.kind == "cascade":
        return Rest(*_alone(scene, p, lower=True), *_alone(scene, p, lower=False))
    return _both(scene, p)


def _sizes(angle: float, small: bool) -> tuple[float, float]:
    return (angle, 1.0) if small else (math.sin(angle), math.cos(angle))


def _pads_push(p: np.ndarray, sine: float) -> float:
    """Return the distance of the pads' resultant to the right of the middle."""
    b = p[at.HALF_WIDTH]
    return float(np.clip(b * b * sine / p[at.SETTLEMENT], -b, b))


def _bed_push(p: np.ndarray, sine: float) -> tuple[float, float]:
    """Return the distance of the bed's resultant to the right, and the height of the middle."""
    b, delta = p[at.LOWER_HALF_WIDTH], p[at.BED_SETTLEMENT]
    raised = b * abs(sine)
    if raised <= delta:
        return b * b * sine / (3.0 * delta), 0.0
    # triangular pressure over the bearing length
    length = 2.0 * b * math.sqrt(delta / raised)
    return math.copysign(b - length / 3.0, sine), (math.sqrt(raised) - math.sqrt(delta)) ** 2


def _first_root(residual: Callable[[float], float], edge: float) -> float:
    """Return the first angle on the way to `edge` where `lack` has risen to zero."""
    last = 0.0
    for share in np.linspace(0.0, edge, SHARES + 1)[1:]:
        if residual(float(share)) > 0.0:
            return brentq(residual, last, float(share), xtol=1e-300, rtol=1e-15)
        last = float(share)
    raise NoRestError


def _alone(scene: Scene, p: np.ndarray, lower: bool) -> tuple[float, float]:
    level = p[at.LOWER_HEIGHT if lower else at.HALF_HEIGHT]
    eccentricity = p[at.LOWER_ECCENTRICITY if lower else at.ECCENTRICITY]
    b = p[at.LOWER_HALF_WIDTH if lower else at.HALF_WIDTH]
    side = math.copysign(1.0, eccentricity)

    def residual(angle: float) -> float:
        sine, cosine = _sizes(angle, scene.small)
        push = _bed_push(p, sine)[0] if lower else _pads_push(p, sine)
        return side * ((push - eccentricity) * cosine - level * sine)

    angle = _first_root(residual, side * math.atan((b - side * eccentricity) / level))
    return angle, _bed_push(p, _sizes(angle, scene.small)[0])[1] if lower else 0.0


def _both(scene: Scene, p: np.ndarray) -> Rest:
    """Return the rest of cap and block: of the block on the cap, and of both on the soil."""
    b, h, e = p[at.HALF_WIDTH], p[at.HALF_HEIGHT], p[at.ECCENTRICITY]
    weight, cap = p[at.MASS], p[at.LOWER_MASS]

    def residuals(angles: np.ndarray) -> np.ndarray:
        tilt, angle = (float(each) for each in angles)
        lean, upright = math.sin(tilt), math.cos(tilt)
        sine, cosine = _sizes(angle, scene.small)
        # the pads carry only the normal component of the weight: tilts have more effect
        push = b * b * sine / (p[at.SETTLEMENT] * upright)
        point = (b * math.copysign(1.0, angle) if scene.rule == "leading-corner" else 0.0) - e
        slope = h if scene.small else h * cosine + point * sine
        on_cap = upright * (h * sine + (e - push) * cosine) + lean * slope
        # heights of the middle of the block's base and of its centre of mass over the cap
        middle = p[at.SETTLEMENT] * (1.0 - upright)
        rise = 0.5 * h * angle**2 if scene.small else h * (1.0 - math.cos(angle))
        far = p[at.TOP] + h + middle - rise - e * sine
        across = far * lean + (e + lowered(scene.small, point, h, angle)) * upright
        sunk, turned = _sizes(tilt, scene.small)
        under, _ = _bed_push(p, sunk)
        on_soil = weight * across - (weight + cap) * (under * turned - p[at.LOWER_HEIGHT] * sunk)
        return np.array([on_cap / h, on_soil / (weight * h)])

    angles = root(residuals, np.array(_guess(scene, p)), tol=1e-15).x
    if not np.max(np.abs(residuals(angles))) < 1e-12:
        raise NoRestError
    tilt, angle = (float(each) for each in angles)
    if b * abs(_sizes(angle, scene.small)[0]) > p[at.SETTLEMENT] * math.cos(tilt):
        raise NoRestError
    height = _bed_push(p, _sizes(tilt, scene.small)[0])[1]
    return Rest(tilt, height, angle, p[at.SETTLEMENT] * (1.0 - math.cos(tilt)))


def _guess(scene: Scene, p: np.ndarray) -> tuple[float, float]:
    """Return the angles for small rotation: the cap leans as if the block stood upright on it."""
    b, h, e = p[at.HALF_WIDTH], p[at.HALF_HEIGHT], p[at.ECCENTRICITY]
    both = p[at.MASS] + p[at.LOWER_MASS]
    level = (p[at.MASS] * (2.0 * p[at.LOWER_HEIGHT] + h) + p[at.LOWER_MASS] * p[at.TOP]) / both
    firm = p[at.LOWER_HALF_WIDTH] ** 2 / (3.0 * p[at.BED_SETTLEMENT]) - level
    tilt = p[at.MASS] * e / both / firm
    return tilt, (e + h * tilt) / (b * b / p[at.SETTLEMENT] - h)
