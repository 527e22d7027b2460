"""What an earthquake radiates: moment, corner frequency, spectrum."""

from __future__ import annotations

import math
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


def seismic_moment(magnitude: float) -> float:
    """Compute the seismic moment, :eq:`eq-seismic-moment` (Hanks and Kanamori 1979).

    Parameters
    ----------
    magnitude : float
        Moment magnitude [1].

    Returns
    -------
    float
        [N m]
    """
    return 10.0 ** (1.5 * magnitude + 9.05)


def corner_frequency(moment: float, stress_drop: float, shear_wave_velocity: float) -> float:
    """Compute the corner frequency, :eq:`eq-corner-frequency` (Brune 1970, 1971).

    Parameters
    ----------
    moment : float
        Seismic moment [N m].
    stress_drop : float
        Stress drop [Pa].
    shear_wave_velocity : float
        Of the crust at the source [m s^-1].

    Returns
    -------
    float
        [Hz]
    """
    return CORNER * shear_wave_velocity * math.cbrt(stress_drop / moment)


def displacement_level(moment: float, shear_wave_velocity: float, density: float) -> float:
    """Compute the level of the displacement spectrum of long waves, :eq:`eq-source-level`.

    Parameters
    ----------
    moment : float
        Seismic moment [N m].
    shear_wave_velocity : float
        Of the crust at the source [m s^-1].
    density : float
        Of the crust at the source [kg m^-3].

    Returns
    -------
    float
        At the reference distance, without attenuation [m s].
    """
    share = RADIATION_PATTERN * PARTITION * FREE_SURFACE
    sphere = 4.0 * math.pi * density * shear_wave_velocity**3 * REFERENCE_DISTANCE
    return share * moment / sphere


def source_shape(frequency: Array, corner: float) -> Array:
    """Compute the omega-squared shape of the displacement spectrum, :eq:`eq-source-shape`.

    Parameters
    ----------
    frequency : ndarray
        [Hz]
    corner : float
        Corner frequency [Hz].

    Returns
    -------
    ndarray
        1 for long waves [1].
    """
    return 1.0 / (1.0 + (frequency / corner) ** 2)
