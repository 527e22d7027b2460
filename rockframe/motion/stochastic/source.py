"""What an earthquake radiates: moment, corner frequency, spectrum."""

from __future__ import annotations

import math
from enum import StrEnum
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from rockframe.signals.arrays import Array

RADIATION_PATTERN: Final = 0.55
"""Average of the shear waves over the focal sphere [1] (Boore and Thompson 2015)."""

PARTITION: Final = 0.707
"""Share of one of two horizontal components [1] (Boore and Thompson 2015)."""

FREE_SURFACE: Final = 2.0
"""A free surface doubles an arriving wave [1] (Boore and Thompson 2015)."""

REFERENCE_DISTANCE: Final = 1_000.0
"""Distance at which the spectrum of the source is given [m] (Boore 2003)."""

CORNER: Final = 0.4906
"""Factor of the corner frequency [1]: Brune's circular crack, 2.34/(2 pi) cbrt(16/7).

Boore (2003) has it as 4.906e6, for km/s, bar and dyn cm.
"""


LOWER_CORNER: Final = (2.181, -0.496)
"""Lower of two corner frequencies: log10(f/Hz) = a + b M (Atkinson and Silva 2000)."""

SHARE_OF_UPPER: Final = (0.605, -0.255)
"""Share of the upper one in the spectrum: log10 = a + b M (Atkinson and Silva 2000)."""


class Corners(StrEnum):
    """How many corner frequencies the spectrum of the source has."""

    ONE = "one corner"
    TWO = "two corners"


def seismic_moment(magnitude: float) -> float:
    """Compute the seismic moment, :eq:`eq-seismic-moment` (Hanks and Kanamori 1979)."""
    return 10.0 ** (1.5 * magnitude + 9.05)


def corner_frequency(moment: float, stress_drop: float, shear_wave_velocity: float) -> float:
    """Compute the corner frequency, :eq:`eq-corner-frequency` (Brune 1970, 1971)."""
    return CORNER * shear_wave_velocity * math.cbrt(stress_drop / moment)


def displacement_level(moment: float, shear_wave_velocity: float, density: float) -> float:
    """Compute the level of the displacement spectrum of long waves, :eq:`eq-source-level`."""
    share = RADIATION_PATTERN * PARTITION * FREE_SURFACE
    sphere = 4.0 * math.pi * density * shear_wave_velocity**3 * REFERENCE_DISTANCE
    return share * moment / sphere


def source_shape(frequency: Array, corner: float) -> Array:
    """Compute the omega-squared shape of the displacement spectrum, :eq:`eq-source-shape`."""
    return 1.0 / (1.0 + (frequency / corner) ** 2)


def two_corners(magnitude: float, corner: float) -> tuple[float, float, float]:
    """Compute the corner frequencies of a large fault, :eq:`eq-two-corners`."""
    (a, b), (c, d) = LOWER_CORNER, SHARE_OF_UPPER
    lower = 10.0 ** (a + b * magnitude)
    share = 10.0 ** (c + d * magnitude)
    square = (corner**2 - (1.0 - share) * lower**2) / share
    if not square > lower**2:
        msg = f"no upper corner above the lower one of {lower:.4g} Hz"
        raise ArithmeticError(msg)
    return lower, math.sqrt(square), share


def two_corner_shape(frequency: Array, corners: tuple[float, float, float]) -> Array:
    """Compute the shape of a displacement spectrum with two corners, :eq:`eq-two-corner-shape`."""
    lower, upper, share = corners
    of_lower, of_upper = source_shape(frequency, lower), source_shape(frequency, upper)
    return (1.0 - share) * of_lower + share * of_upper
