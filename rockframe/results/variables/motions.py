"""Variables of ground motions: histories, measures, spectra; of pairs, and of sets of records."""

from typing import Final

from rockframe.results.variables.variable import FREQUENCY, OSCILLATOR, PERIOD, TIME, rows_over

MEASURES: Final = (
    *rows_over(
        TIME,
        ground_velocity="horizontal ground velocity [m s^-1]",
        ground_displacement="horizontal ground displacement [m]",
        vertical_ground_velocity="vertical ground velocity, upwards [m s^-1]",
        vertical_ground_displacement="vertical ground displacement, upwards [m]",
    ),
    *rows_over(
        (),
        peak_ground_acceleration="greatest absolute ground acceleration [m s^-2]",
        peak_ground_velocity="greatest absolute ground velocity [m s^-1]",
        peak_ground_displacement="greatest absolute ground displacement [m]",
        arias_intensity="Arias intensity [m s^-1]",
        cumulative_absolute_velocity="cumulative absolute velocity [m s^-1]",
        standardized_cumulative_absolute_velocity="cumulative absolute velocity of the seconds "
        "that reach 0.025 g [m s^-1]",
        significant_duration_5_75="time from 5 to 75 % of the Arias intensity [s]",
        significant_duration_5_95="time from 5 to 95 % of the Arias intensity [s]",
        bracketed_duration="time from the first to the last exceedance of the threshold [s]",
        housner_spectrum_intensity="pseudo-velocity spectrum integrated from 0.1 s to 2.5 s [m]",
        mean_period="mean period of the Fourier spectrum [s]",
        predominant_velocity_period="period at the peak of the pseudo-velocity spectrum [s]",
        uplift_acceleration="ground acceleration at which the block on rigid ground lifts off "
        "[m s^-2]",
        uplift_duration="time during which the ground acceleration exceeds that of uplift [s]",
        relative_peak_ground_acceleration="peak ground acceleration over that of uplift",
        relative_peak_ground_velocity="peak ground velocity times the block's frequency over the "
        "acceleration of uplift",
        relative_predominant_frequency="angular frequency of the peak of the pseudo-velocity "
        "spectrum over the block's",
        relative_pulse_frequency="angular frequency of the pulse over the block's",
    ),
    *rows_over(
        OSCILLATOR,
        spectral_displacement="greatest absolute relative displacement [m]",
        spectral_velocity="greatest absolute relative velocity [m s^-1]",
        absolute_spectral_acceleration="greatest absolute acceleration of the oscillator, the "
        "ground's included [m s^-2]",
        pseudo_spectral_velocity="pseudo-spectral velocity [m s^-1]",
        pseudo_spectral_acceleration="pseudo-spectral acceleration [m s^-2]",
    ),
    *rows_over(
        FREQUENCY,
        fourier_amplitude="absolute value of the Fourier transform of the acceleration [m s^-1]",
        fourier_phase="phase of the Fourier transform of the acceleration [rad]",
    ),
)
"""Of a motion, and of a motion for a block."""


DIRECTIONS: Final = (
    *rows_over(
        OSCILLATOR,
        median_rotated_acceleration="median over all directions of the pseudo-spectral "
        "acceleration (RotD50) [m s^-2]",
        greatest_rotated_acceleration="greatest over all directions of the pseudo-spectral "
        "acceleration (RotD100) [m s^-2]",
        geometric_mean_acceleration="geometric mean of the pseudo-spectral accelerations of the "
        "components [m s^-2]",
        direction_of_greatest="direction of the greatest pseudo-spectral acceleration, from the "
        "first component on [rad]",
        vertical_spectral_acceleration="pseudo-spectral acceleration of the vertical component "
        "[m s^-2]",
        vertical_to_horizontal_ratio="vertical over median horizontal pseudo-spectral acceleration",
    ),
    *rows_over(
        (),
        major_axis_angle="direction of the major axis, from the first component [rad]",
        major_arias_intensity="Arias intensity along the major axis [m s^-1]",
        minor_arias_intensity="Arias intensity along the minor axis [m s^-1]",
        average_spectral_acceleration="geometric mean over periods of the pseudo-spectral "
        "acceleration [m s^-2]",
        average_geometric_mean_acceleration="geometric mean over periods of the geometric mean of "
        "both components [m s^-2]",
        average_median_rotated_acceleration="geometric mean over periods of the median over all "
        "directions [m s^-2]",
    ),
)
"""Of two horizontal components."""

_OF_MATCHING: Final = {
    "peak_ground_acceleration": ("greatest absolute ground acceleration", " [m s^-2]"),
    "peak_ground_velocity": ("greatest absolute ground velocity", " [m s^-1]"),
    "peak_ground_displacement": ("greatest absolute ground displacement", " [m]"),
    "pulse_indicator": ("pulse indicator of Baker", ""),
}
"""What is compared before and after a spectrum is matched."""

RECORDS: Final = rows_over(
    (),
    record=("name of the record, common to components recorded together", str),
    axis=("place in the record: H1, H2 or V", str),
    record_sequence_number="number of the record in the NGA databases",
    event=("earthquake", str),
    year="year of the earthquake",
    magnitude="magnitude of the earthquake",
    mechanism=("mechanism of the rupture", str),
    station=("station", str),
    component=("component by the name in its file", str),
    azimuth="direction of the component, clockwise from north [rad]",
    rupture_distance="closest distance to the rupture [m]",
    joyner_boore_distance="closest distance to the projection of the rupture on the surface [m]",
    shear_wave_velocity_30="shear-wave velocity of the uppermost 30 m, averaged over the time of "
    "travel [m s^-1]",
    lowest_usable_frequency="frequency below which the record is not usable [Hz]",
    stated_pulse_period="period of the pulse as its source states [s]",
    time_step="time between samples [s]",
    duration="time from the first to the last sample [s]",
    sample_count=("number of samples", int),
    scale_factor="factor by which the motion was scaled",
    spectral_misfit="root mean square of the logarithm of scaled spectrum over target",
    largest_spectral_misfit="greatest distance of the matched spectrum from the target, over the "
    "target",
    mean_spectral_misfit="mean distance of the matched spectrum from the target, over the target",
    **{
        f"{name}_{when}_matching": f"{meaning} {when} the spectrum was matched{unit}"
        for name, (meaning, unit) in _OF_MATCHING.items()
        for when in ("before", "after")
    },
    spectral_growth_beyond_range="greatest ratio of matched to scaled spectrum beyond the range of "
    "periods",
    period_of_spectral_growth="period of the greatest ratio of matched to scaled spectrum [s]",
)
"""Of a motion in a suite; in datasets over ``motion``."""

TARGETS: Final = (
    *rows_over(
        PERIOD,
        target_spectral_acceleration="pseudo-spectral acceleration of the target [m s^-2]",
        target_standard_deviation="standard deviation of the logarithm of the target spectrum",
        scaled_spectral_acceleration="pseudo-spectral acceleration of the scaled motion [m s^-2]",
        set_median_acceleration="geometric mean over the set of the scaled pseudo-spectral "
        "accelerations [m s^-2]",
        set_standard_deviation="standard deviation over the set of the logarithm of the scaled "
        "spectra",
    ),
    *rows_over((), set_misfit="root mean square of the misfit of the set, with its spread"),
)
"""Of a set of motions beside a target spectrum."""
