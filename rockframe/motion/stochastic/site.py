"""What the last kilometres below the site do: amplification, and loss of high frequencies."""

from __future__ import annotations

import math
from enum import StrEnum
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from rockframe.signals.arrays import Array


class Site(StrEnum):
    """Ground of the site, by the mean shear-wave velocity of its upper 30 m in m/s."""

    ROCK_760 = "rock 760"
    ROCK_620 = "rock 620"


AMPLIFICATIONS: Final = {
    Site.ROCK_760: (
        (0.010, 1.00),
        (0.015, 1.01),
        (0.021, 1.02),
        (0.031, 1.02),
        (0.045, 1.04),
        (0.065, 1.06),
        (0.095, 1.09),
        (0.138, 1.13),
        (0.200, 1.18),
        (0.291, 1.25),
        (0.423, 1.32),
        (0.615, 1.41),
        (0.894, 1.51),
        (1.301, 1.64),
        (1.892, 1.80),
        (2.751, 1.99),
        (4.000, 2.18),
        (5.817, 2.38),
        (8.459, 2.56),
        (12.301, 2.75),
        (17.889, 2.95),
        (26.014, 3.17),
        (37.830, 3.42),
        (55.012, 3.68),
        (80.000, 3.96),
    ),
    Site.ROCK_620: (
        (0.001, 1.00),
        (0.009, 1.01),
        (0.025, 1.03),
        (0.049, 1.06),
        (0.081, 1.10),
        (0.150, 1.19),
        (0.370, 1.39),
        (0.680, 1.58),
        (1.110, 1.77),
        (2.360, 2.24),
        (5.250, 2.75),
        (60.300, 4.49),
    ),
}
"""Frequency [Hz] and amplification [1].

Over crust of 3500 m/s and 2720 kg/m^3: Boore (2016) for 760 m/s; Boore and Joyner (1997),
with the densities of Boore (2016), for 620 m/s.
"""


def amplification(frequency: Array, site: Site) -> Array:
    """Interpolate the amplification between the crust and the surface, :eq:`eq-amplification`."""
    knots, values = np.transpose(AMPLIFICATIONS[site])
    return np.exp(np.interp(frequency, knots, np.log(values)))


def diminution(frequency: Array, kappa: float) -> Array:
    """Compute the loss of high frequencies, :eq:`eq-kappa` (Anderson and Hough 1984)."""
    return np.exp(-math.pi * kappa * frequency)
