"""The spectrum and the duration that a motion has on the average."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rockframe.motion.stochastic import path, site, source

if TYPE_CHECKING:
    from rockframe.signals.arrays import Array


@dataclass(frozen=True)
class PointSource:
    """An earthquake, seen from a site: all that the stochastic model knows of both.

    The defaults are those of Boore and Thompson (2015) for active crustal regions.
    """

    magnitude: float  # moment magnitude [1]
    distance: float  # closest distance to the rupture [m]
    stress_drop: float = 10e6  # stress drop [Pa]
    shear_wave_velocity: float = 3_500.0  # of the crust at the source [m s^-1]
    density: float = 2_720.0  # of the crust at the source [kg m^-3]
    quality_factor: float = 180.0  # Q0 of the crust, at 1 Hz [1]
    quality_exponent: float = 0.45  # n of Q(f) = Q0 (f/Hz)^n [1]
    kappa: float = 0.035  # loss of high frequencies at the site [s]
    site: site.Site = site.Site.ROCK_760  # ground of the site
    corners: source.Corners = source.Corners.ONE  # corner frequencies of the source

    @property
    def moment(self) -> float:
        """Seismic moment [N m]."""
        return source.seismic_moment(self.magnitude)

    @property
    def corner_frequency(self) -> float:
        """Corner frequency of a source that has one [Hz]."""
        return source.corner_frequency(self.moment, self.stress_drop, self.shear_wave_velocity)

    @property
    def two_corners(self) -> tuple[float, float, float]:
        """Corner frequencies [Hz] and the share of the upper one [1], of a source with two."""
        return source.two_corners(self.magnitude, self.corner_frequency)

    @property
    def lowest_corner(self) -> float:
        """The corner frequency, or the lower of two [Hz]."""
        one = self.corners is source.Corners.ONE
        return self.corner_frequency if one else self.two_corners[0]

    @property
    def effective_distance(self) -> float:
        """Distance of the point source that stands for the rupture [m]."""
        return path.effective_distance(self.distance, self.magnitude)

    @property
    def duration(self) -> float:
        """Duration of source and path together, :eq:`eq-duration` [s]."""
        if self.corners is source.Corners.ONE:
            of_source = 1.0 / self.corner_frequency
        else:
            lower, upper, _ = self.two_corners
            of_source = 0.5 / lower + 0.5 / upper
        return of_source + path.path_duration(self.effective_distance)

    def displacement_spectrum(self, frequency: Array) -> Array:
        """Compute the Fourier amplitude of the displacement, :eq:`eq-target-spectrum`."""
        level = source.displacement_level(self.moment, self.shear_wave_velocity, self.density)
        distance = self.effective_distance
        if self.corners is source.Corners.ONE:
            shape = source.source_shape(frequency, self.corner_frequency)
        else:
            shape = source.two_corner_shape(frequency, self.two_corners)
        return (
            level
            * shape
            * path.geometric_spreading(distance)
            * path.crustal_attenuation(
                frequency, distance, self.quality_factor, self.quality_exponent
            )
            * site.amplification(frequency, self.site)
            * site.diminution(frequency, self.kappa)
        )

    def acceleration_spectrum(self, frequency: Array) -> Array:
        """Compute the Fourier amplitude of the acceleration, like :meth:`displacement_spectrum`."""
        return (2.0 * math.pi * frequency) ** 2 * self.displacement_spectrum(frequency)
