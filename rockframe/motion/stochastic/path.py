"""What becomes of the waves between source and site: distance, spreading, attenuation."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from rockframe.motion.stochastic.source import REFERENCE_DISTANCE

if TYPE_CHECKING:
    from rockframe.signals.arrays import Array

KILOMETRE: Final = 1_000.0

SMALL_FAULT: Final = (-1.72, 0.43)
"""Saturation length of smaller earthquakes: log10(h/km) = a + b M (Yenier and Atkinson 2014)."""

LARGE_FAULT: Final = (-0.405, 0.235)
"""The same of larger ones (Yenier and Atkinson 2015)."""

TRANSITION: Final = 2.0
"""Width of the passage from one to the other, in magnitudes (Boore and Thompson 2015)."""

SPREADING_BREAK: Final = 40.0 * KILOMETRE
"""Waves spread as 1/R up to here, as R^-0.5 beyond [m] (Raoof et al. 1999)."""

QUALITY_VELOCITY: Final = 3_500.0
"""Velocity for which the quality factor was determined [m s^-1] (Boore and Thompson 2015)."""

PATH_DURATIONS: Final = (
    (0.0, 0.0),
    (7.0, 2.4),
    (45.0, 8.4),
    (125.0, 10.9),
    (175.0, 17.4),
    (270.0, 34.2),
)
"""Distance [km] and path duration [s] (Boore and Thompson 2014)."""

FINAL_SLOPE: Final = 0.156
"""Growth of the path duration beyond the last distance [s/km] (Boore and Thompson 2014)."""

LARGEST_DISTANCE: Final = PATH_DURATIONS[-1][0] * KILOMETRE
"""Beyond it the path duration is extrapolated [m]."""


def saturation_length(magnitude: float) -> float:
    """Compute how far away a large fault seems, seen from itself, :eq:`eq-saturation`."""
    (a, b), (c, d) = SMALL_FAULT, LARGE_FAULT
    start = (c - a) / (b - d) - 0.5 * TRANSITION
    within = min(max(magnitude - start, 0.0), TRANSITION)
    beyond = max(magnitude - start - TRANSITION, 0.0)
    bend = (b - d) * (within**2 / (2.0 * TRANSITION) + beyond)
    return KILOMETRE * 10.0 ** (a + b * magnitude - bend)


def effective_distance(distance: float, magnitude: float) -> float:
    """Compute the distance of the equivalent point source, :eq:`eq-effective-distance`."""
    return math.hypot(distance, saturation_length(magnitude))


def geometric_spreading(distance: float) -> float:
    """Compute the geometric spreading, :eq:`eq-spreading`."""
    beyond = max(distance / SPREADING_BREAK, 1.0)
    return REFERENCE_DISTANCE / min(distance, SPREADING_BREAK) / math.sqrt(beyond)


def crustal_attenuation(
    frequency: Array, distance: float, quality_factor: float, quality_exponent: float
) -> Array:
    """Compute the attenuation in the crust, :eq:`eq-attenuation`, Q(f) = Q0 (f/Hz)^n."""
    waves = frequency ** (1.0 - quality_exponent) * distance / QUALITY_VELOCITY
    return np.exp(-math.pi * waves / quality_factor)


def path_duration(distance: float) -> float:
    """Compute how much the path lengthens the motion, :eq:`eq-duration`."""
    kilometres, seconds = zip(*PATH_DURATIONS, strict=True)
    beyond = max(distance - LARGEST_DISTANCE, 0.0) / KILOMETRE
    return float(np.interp(distance / KILOMETRE, kilometres, seconds)) + FINAL_SLOPE * beyond
