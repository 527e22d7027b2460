"""Synthetic accelerograms of the stochastic point source.

The target spectrum is that of source, path and site: radiation, attenuation in the crust, and
amplification and diminution near the surface. Windowed noise is given this spectrum.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import Final, cast

import numpy as np

from rockframe.signals.arrays import Array

RADIATION_PATTERN: Final = 0.55
"""Radiation pattern of shear waves, mean over the focal sphere [1] (Boore and Thompson 2015)."""

PARTITION: Final = 0.707
"""Fraction of the amplitude in one of two horizontal components [1] (Boore and Thompson 2015)."""

FREE_SURFACE: Final = 2.0
"""A free surface doubles an arriving wave [1] (Boore and Thompson 2015)."""

REFERENCE_DISTANCE: Final = 1_000.0
"""Distance at which the spectrum of the source is given [m] (Boore 2003)."""

CORNER: Final = 0.4906
"""Factor of the corner frequency [1]: Brune's circular crack, 2.34/(2 pi) cbrt(16/7).

In Boore (2003) it is 4.906e6, for km/s, bar and dyn cm.
"""


LOWER_CORNER: Final = (2.181, -0.496)
"""Lower of two corner frequencies: log10(f/Hz) = a + b M (Atkinson and Silva 2000)."""

SHARE_OF_UPPER: Final = (0.605, -0.255)
"""Weight of the upper one in the spectrum: log10 = a + b M (Atkinson and Silva 2000)."""


class Corners(StrEnum):
    """Number of corner frequencies in the spectrum of the source."""

    ONE = "one corner"
    TWO = "two corners"


def source_shape(frequency: Array, corner: float) -> Array:
    """Compute the omega-squared shape of the displacement spectrum, :eq:`eq-source-shape`."""
    return 1.0 / (1.0 + (frequency / corner) ** 2)


KILOMETRE: Final = 1_000.0

SMALL_FAULT: Final = (-1.72, 0.43)
"""Saturation length of smaller earthquakes: log10(h/km) = a + b M (Yenier and Atkinson 2014)."""

LARGE_FAULT: Final = (-0.405, 0.235)
"""Saturation length of larger earthquakes (Yenier and Atkinson 2015)."""

TRANSITION: Final = 2.0
"""Width of the transition between them, in magnitudes (Boore and Thompson 2015)."""

SPREADING_BREAK: Final = 40.0 * KILOMETRE
"""Distance up to which waves spread as 1/R, beyond it as R^-0.5 [m] (Raoof et al. 1999)."""

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
"""Distance beyond which the path duration is extrapolated [m]."""


def saturation_length(magnitude: float) -> float:
    """Compute the effective distance of a fault at zero distance, :eq:`eq-saturation` [m]."""
    (a, b), (c, d) = SMALL_FAULT, LARGE_FAULT
    start = (c - a) / (b - d) - 0.5 * TRANSITION
    within = min(max(magnitude - start, 0.0), TRANSITION)
    beyond = max(magnitude - start - TRANSITION, 0.0)
    flattening = (b - d) * (within**2 / (2.0 * TRANSITION) + beyond)
    return KILOMETRE * 10.0 ** (a + b * magnitude - flattening)


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
    """Compute the duration that the path adds to the motion, :eq:`eq-duration` [s]."""
    kilometres, seconds = zip(*PATH_DURATIONS, strict=True)
    beyond = max(distance - LARGEST_DISTANCE, 0.0) / KILOMETRE
    return float(np.interp(distance / KILOMETRE, kilometres, seconds)) + FINAL_SLOPE * beyond


class Site(StrEnum):
    """Ground of the site, by the mean shear-wave velocity of the upper 30 m [m s^-1]."""

    ROCK_760 = "rock 760"
    ROCK_620 = "rock 620"


AMPLIFICATIONS: Final = {
    Site.ROCK_760: (
        (0.010, 1.00), (0.015, 1.01), (0.021, 1.02), (0.031, 1.02), (0.045, 1.04),
        (0.065, 1.06), (0.095, 1.09), (0.138, 1.13), (0.200, 1.18), (0.291, 1.25),
        (0.423, 1.32), (0.615, 1.41), (0.894, 1.51), (1.301, 1.64), (1.892, 1.80),
        (2.751, 1.99), (4.000, 2.18), (5.817, 2.38), (8.459, 2.56), (12.301, 2.75),
        (17.889, 2.95), (26.014, 3.17), (37.830, 3.42), (55.012, 3.68), (80.000, 3.96),
    ),
    Site.ROCK_620: (
        (0.001, 1.00), (0.009, 1.01), (0.025, 1.03), (0.049, 1.06), (0.081, 1.10),
        (0.150, 1.19), (0.370, 1.39), (0.680, 1.58), (1.110, 1.77), (2.360, 2.24),
        (5.250, 2.75), (60.300, 4.49),
    ),
}  # fmt: skip
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


@dataclass(frozen=True)
class PointSource:
    """Parameters of the stochastic model: an earthquake and a site.

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
    site: Site = Site.ROCK_760  # ground of the site
    corners: Corners = Corners.ONE  # corner frequencies of the source

    @property
    def moment(self) -> float:
        """Seismic moment, :eq:`eq-seismic-moment` (Hanks and Kanamori 1979) [N m]."""
        return 10.0 ** (1.5 * self.magnitude + 9.05)

    @property
    def corner_frequency(self) -> float:
        """Single corner frequency, :eq:`eq-corner-frequency` (Brune 1970, 1971) [Hz]."""
        return CORNER * self.shear_wave_velocity * math.cbrt(self.stress_drop / self.moment)

    @property
    def two_corners(self) -> tuple[float, float, float]:
        """Both corners of a large fault [Hz], weight of the upper one [1], :eq:`eq-two-corners`."""
        (a, b), (c, d) = LOWER_CORNER, SHARE_OF_UPPER
        lower = 10.0 ** (a + b * self.magnitude)
        share = 10.0 ** (c + d * self.magnitude)
        square = (self.corner_frequency**2 - (1.0 - share) * lower**2) / share
        if not square > lower**2:
            msg = f"no upper corner above the lower one of {lower:.4g} Hz"
            raise ArithmeticError(msg)
        return lower, math.sqrt(square), share

    @property
    def lowest_corner(self) -> float:
        """The corner frequency, or the lower of two [Hz]."""
        has_one_corner = self.corners is Corners.ONE
        return self.corner_frequency if has_one_corner else self.two_corners[0]

    @property
    def effective_distance(self) -> float:
        """Distance of the equivalent point source, :eq:`eq-effective-distance` [m]."""
        return math.hypot(self.distance, saturation_length(self.magnitude))

    @property
    def duration(self) -> float:
        """Duration of source and path together, :eq:`eq-duration` [s]."""
        if self.corners is Corners.ONE:
            of_source = 1.0 / self.corner_frequency
        else:
            lower, upper, _ = self.two_corners
            of_source = 0.5 / lower + 0.5 / upper
        return of_source + path_duration(self.effective_distance)

    @property
    def displacement_level(self) -> float:
        """Displacement spectrum of the source at low frequencies, :eq:`eq-source-level` [m s]."""
        share = RADIATION_PATTERN * PARTITION * FREE_SURFACE
        sphere = 4.0 * math.pi * self.density * self.shear_wave_velocity**3 * REFERENCE_DISTANCE
        return share * self.moment / sphere

    def shape(self, frequency: Array) -> Array:
        """Return the shape of the source spectrum; with two corners :eq:`eq-two-corner-shape`."""
        if self.corners is Corners.ONE:
            return source_shape(frequency, self.corner_frequency)
        lower, upper, share = self.two_corners
        of_lower, of_upper = source_shape(frequency, lower), source_shape(frequency, upper)
        return (1.0 - share) * of_lower + share * of_upper

    def displacement_spectrum(self, frequency: Array) -> Array:
        """Compute the Fourier amplitude of the displacement, :eq:`eq-target-spectrum`."""
        distance = self.effective_distance
        return (
            self.displacement_level
            * self.shape(frequency)
            * geometric_spreading(distance)
            * crustal_attenuation(frequency, distance, self.quality_factor, self.quality_exponent)
            * amplification(frequency, self.site)
            * diminution(frequency, self.kappa)
        )

    def acceleration_spectrum(self, frequency: Array) -> Array:
        """Compute the Fourier amplitude of the acceleration, like :meth:`displacement_spectrum`."""
        return (2.0 * math.pi * frequency) ** 2 * self.displacement_spectrum(frequency)


WINDOW_PEAK: Final = 0.2
"""Time of the peak of the window, over its length [1] (Boore 2003)."""

WINDOW_END: Final = 0.05
"""Value of the window at its end, over its peak [1] (Boore 2003)."""

WINDOW_LENGTH: Final = 2.12
"""Length of the window over the duration of source and path [1] (Boore and Thompson 2015)."""

SHORTEST_FADE: Final = 1.0
"""Shortest time in which the motion fades in, and out [s]."""


def accelerogram(source: PointSource, time_step: float, seed: int, stream: int = 0) -> Array:
    """Draw windowed noise with the target spectrum, :eq:`eq-noise-spectrum`, :eq:`eq-faded`."""
    from scipy import fft

    window = exponential_window(WINDOW_LENGTH * source.duration, time_step)
    noise = window * normal_numbers(window.size, seed, stream)
    fade = math.ceil(max(1.0 / source.lowest_corner, SHORTEST_FADE) / time_step)
    count = window.size + 2 * fade
    # twice as long as needed, so that the circular convolution does not wrap around
    points = cast("int", fft.next_fast_len(2 * count, real=True))
    padded = np.zeros(points)
    padded[fade : fade + noise.size] = noise / math.sqrt(float(noise @ noise))
    frequency = np.arange(points // 2 + 1) / (points * time_step)
    # noise of unit mean square times the target; the division turns sums into integrals over time
    spectrum = np.fft.rfft(padded) * source.displacement_spectrum(frequency) / time_step
    rate = 2j * math.pi * frequency
    displacement, velocity, acceleration = (
        np.fft.irfft(spectrum * rate**order, points)[:count] for order in range(3)
    )
    step, slope, curvature = fade_window(count, fade, time_step)
    return step * acceleration + 2.0 * slope * velocity + curvature * displacement


def exponential_window(length: float, time_step: float) -> Array:
    """Sample the window of Saragoni and Hart (1974), :eq:`eq-window`."""
    power = -WINDOW_PEAK * math.log(WINDOW_END)
    power /= 1.0 + WINDOW_PEAK * (math.log(WINDOW_PEAK) - 1.0)
    count = math.floor(length / time_step) + 1
    time: Array = np.arange(count, dtype=np.float64) * time_step
    over_peak = time / (WINDOW_PEAK * length)
    return (over_peak * np.exp(1.0 - over_peak)) ** power


def normal_numbers(count: int, seed: int, stream: int) -> Array:
    """Draw normally distributed numbers that are the same in every version of NumPy.

    Only the raw output of a bit generator is stable (NEP 19); ``Generator.normal`` may change.
    It is converted to uniform numbers, :eq:`eq-uniform`, and by the inverse of the cumulative
    distribution to normal ones.
    """
    from scipy import special

    bits = np.random.PCG64(np.random.SeedSequence(seed, spawn_key=(stream,)))
    leading = np.right_shift(np.asarray(bits.random_raw(count), dtype=np.uint64), np.uint64(11))
    return cast("Array", special.ndtri((leading.astype(np.float64) + 0.5) * 2.0**-53))


def fade_window(count: int, fade: int, time_step: float) -> tuple[Array, Array, Array]:
    """Return a smooth step up at the start and down at the end, and derivatives, :eq:`eq-step`."""
    x = np.minimum(np.arange(fade + 1) / fade, 1.0)
    rises = (
        x**3 * (10.0 - 15.0 * x + 6.0 * x**2),
        30.0 * x**2 * (1.0 - x) ** 2,
        60.0 * x * (1.0 - x) * (1.0 - 2.0 * x),
    )
    levels = (1.0, 0.0, 0.0)
    steps: list[Array] = []
    for order, (rise, level) in enumerate(zip(rises, levels, strict=True)):
        values = np.full(count, level)
        values[: fade + 1] = rise / (fade * time_step) ** order
        values[-fade - 1 :] = (-1.0) ** order * values[fade::-1]
        steps.append(values)
    return steps[0], steps[1], steps[2]
