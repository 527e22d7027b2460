"""Variables of ground motions: histories, intensity measures, spectra; of two at right angles."""

from typing import Final

from rockframe.results.variables.variable import FREQUENCY, OSCILLATOR, TIME, Variable, number
from rockframe.units import Unit

MEASURES: Final = (
    Variable("ground_velocity", TIME, Unit.METRE_PER_SECOND, "horizontal ground velocity"),
    Variable("ground_displacement", TIME, Unit.METRE, "horizontal ground displacement"),
    Variable(
        "vertical_ground_velocity",
        TIME,
        Unit.METRE_PER_SECOND,
        "vertical ground velocity, upwards",
    ),
    Variable(
        "vertical_ground_displacement", TIME, Unit.METRE, "vertical ground displacement, upwards"
    ),
    Variable(
        "peak_ground_acceleration",
        (),
        Unit.METRE_PER_SECOND_SQUARED,
        "greatest absolute ground acceleration",
    ),
    Variable(
        "peak_ground_velocity", (), Unit.METRE_PER_SECOND, "greatest absolute ground velocity"
    ),
    Variable("peak_ground_displacement", (), Unit.METRE, "greatest absolute ground displacement"),
    Variable("arias_intensity", (), Unit.METRE_PER_SECOND, "Arias intensity"),
    Variable(
        "cumulative_absolute_velocity", (), Unit.METRE_PER_SECOND, "cumulative absolute velocity"
    ),
    Variable(
        "standardized_cumulative_absolute_velocity",
        (),
        Unit.METRE_PER_SECOND,
        "cumulative absolute velocity of the seconds that reach 0.025 g",
    ),
    Variable(
        "significant_duration_5_75",
        (),
        Unit.SECOND,
        "time from 5 to 75 % of the Arias intensity",
    ),
    Variable(
        "significant_duration_5_95",
        (),
        Unit.SECOND,
        "time from 5 to 95 % of the Arias intensity",
    ),
    Variable(
        "bracketed_duration",
        (),
        Unit.SECOND,
        "time from the first to the last exceedance of the threshold",
    ),
    Variable(
        "housner_spectrum_intensity",
        (),
        Unit.METRE,
        "pseudo-velocity spectrum integrated from 0.1 s to 2.5 s",
    ),
    Variable("mean_period", (), Unit.SECOND, "mean period of the Fourier spectrum"),
    Variable(
        "predominant_velocity_period",
        (),
        Unit.SECOND,
        "period at the peak of the pseudo-velocity spectrum",
    ),
    Variable(
        "uplift_acceleration",
        (),
        Unit.METRE_PER_SECOND_SQUARED,
        "ground acceleration at which the block on rigid ground lifts off",
    ),
    Variable(
        "uplift_duration",
        (),
        Unit.SECOND,
        "time during which the ground acceleration exceeds that of uplift",
    ),
    number("relative_peak_ground_acceleration", "peak ground acceleration over that of uplift"),
    number(
        "relative_peak_ground_velocity",
        "peak ground velocity times the block's frequency over the acceleration of uplift",
    ),
    number(
        "relative_predominant_frequency",
        "angular frequency of the peak of the pseudo-velocity spectrum over the block's",
    ),
    number("relative_pulse_frequency", "angular frequency of the pulse over the block's"),
    Variable(
        "spectral_displacement", OSCILLATOR, Unit.METRE, "greatest absolute relative displacement"
    ),
    Variable(
        "spectral_velocity",
        OSCILLATOR,
        Unit.METRE_PER_SECOND,
        "greatest absolute relative velocity",
    ),
    Variable(
        "absolute_spectral_acceleration",
        OSCILLATOR,
        Unit.METRE_PER_SECOND_SQUARED,
        "greatest absolute acceleration of the oscillator, the ground's included",
    ),
    Variable(
        "pseudo_spectral_velocity", OSCILLATOR, Unit.METRE_PER_SECOND, "pseudo-spectral velocity"
    ),
    Variable(
        "pseudo_spectral_acceleration",
        OSCILLATOR,
        Unit.METRE_PER_SECOND_SQUARED,
        "pseudo-spectral acceleration",
    ),
    Variable(
        "fourier_amplitude",
        FREQUENCY,
        Unit.METRE_PER_SECOND,
        "absolute value of the Fourier transform of the acceleration",
    ),
    Variable(
        "fourier_phase",
        FREQUENCY,
        Unit.RADIAN,
        "phase of the Fourier transform of the acceleration",
    ),
)
"""Of a motion, and of a motion for a block."""


DIRECTIONS: Final = (
    Variable(
        "median_rotated_acceleration",
        OSCILLATOR,
        Unit.METRE_PER_SECOND_SQUARED,
        "median over all directions of the pseudo-spectral acceleration (RotD50)",
    ),
    Variable(
        "greatest_rotated_acceleration",
        OSCILLATOR,
        Unit.METRE_PER_SECOND_SQUARED,
        "greatest over all directions of the pseudo-spectral acceleration (RotD100)",
    ),
    Variable(
        "geometric_mean_acceleration",
        OSCILLATOR,
        Unit.METRE_PER_SECOND_SQUARED,
        "geometric mean of the pseudo-spectral accelerations of the components",
    ),
    Variable(
        "direction_of_greatest",
        OSCILLATOR,
        Unit.RADIAN,
        "direction of the greatest pseudo-spectral acceleration, from the first component on",
    ),
    Variable(
        "vertical_spectral_acceleration",
        OSCILLATOR,
        Unit.METRE_PER_SECOND_SQUARED,
        "pseudo-spectral acceleration of the vertical component",
    ),
    number(
        "vertical_to_horizontal_ratio",
        "vertical over median horizontal pseudo-spectral acceleration",
        OSCILLATOR,
    ),
    Variable(
        "major_axis_angle", (), Unit.RADIAN, "direction of the major axis, from the first component"
    ),
    Variable(
        "major_arias_intensity", (), Unit.METRE_PER_SECOND, "Arias intensity along the major axis"
    ),
    Variable(
        "minor_arias_intensity", (), Unit.METRE_PER_SECOND, "Arias intensity along the minor axis"
    ),
    Variable(
        "average_spectral_acceleration",
        (),
        Unit.METRE_PER_SECOND_SQUARED,
        "geometric mean over periods of the pseudo-spectral acceleration",
    ),
    Variable(
        "average_geometric_mean_acceleration",
        (),
        Unit.METRE_PER_SECOND_SQUARED,
        "geometric mean over periods of the geometric mean of both components",
    ),
    Variable(
        "average_median_rotated_acceleration",
        (),
        Unit.METRE_PER_SECOND_SQUARED,
        "geometric mean over periods of the median over all directions",
    ),
)
"""Of two horizontal components."""
