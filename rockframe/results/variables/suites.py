"""Variables of suites: what is known of records, and sets beside a target."""

from typing import Final

from rockframe.results.variables.variable import PERIOD, Variable, count, number
from rockframe.units import Unit

RECORDS: Final = (
    Variable("record", (), None, "components of one name were recorded together", dtype="str"),
    Variable("axis", (), None, "place in the record: H1, H2 or V", dtype="str"),
    number("record_sequence_number", "number of the record in the NGA databases"),
    Variable("event", (), None, "earthquake", dtype="str"),
    number("year", "year of the earthquake"),
    number("magnitude", "magnitude of the earthquake"),
    Variable("mechanism", (), None, "mechanism of the rupture", dtype="str"),
    Variable("station", (), None, "station", dtype="str"),
    Variable("component", (), None, "component by the name in its file", dtype="str"),
    Variable("azimuth", (), Unit.RADIAN, "direction of the component, clockwise from north"),
    Variable("rupture_distance", (), Unit.METRE, "closest distance to the rupture"),
    Variable(
        "joyner_boore_distance", (), Unit.METRE, "closest distance to the rupture seen from above"
    ),
    Variable(
        "shear_wave_velocity_30",
        (),
        Unit.METRE_PER_SECOND,
        "shear-wave velocity of the uppermost 30 m, averaged over the time of travel",
    ),
    Variable(
        "lowest_usable_frequency", (), Unit.HERTZ, "frequency below which the record is not usable"
    ),
    Variable("stated_pulse_period", (), Unit.SECOND, "period of the pulse as its source states"),
    Variable("time_step", (), Unit.SECOND, "time between samples"),
    Variable("duration", (), Unit.SECOND, "time from the first to the last sample"),
    count("sample_count", "number of samples"),
    number("scale_factor", "factor by which the motion was scaled"),
    number("spectral_misfit", "root mean square of the logarithm of scaled spectrum over target"),
    number(
        "largest_spectral_misfit",
        "greatest distance of the matched spectrum from the target, over the target",
    ),
    number(
        "mean_spectral_misfit",
        "mean distance of the matched spectrum from the target, over the target",
    ),
    *(
        Variable(f"{name}_{when}_matching", (), unit, f"{words} {when} the spectrum was matched")
        for name, unit, words in (
            (
                "peak_ground_acceleration",
                Unit.METRE_PER_SECOND_SQUARED,
                "greatest absolute ground acceleration",
            ),
            (
                "peak_ground_velocity",
                Unit.METRE_PER_SECOND,
                "greatest absolute ground velocity",
            ),
            ("peak_ground_displacement", Unit.METRE, "greatest absolute ground displacement"),
            ("pulse_indicator", Unit.ONE, "pulse indicator of Baker"),
        )
        for when in ("before", "after")
    ),
    number(
        "spectral_growth_beyond_range",
        "greatest ratio of matched to scaled spectrum beyond the range of periods",
    ),
    Variable("period_of_spectral_growth", (), Unit.SECOND, "period of that ratio"),
)
"""Of a motion in a suite; in datasets over ``motion``."""

TARGETS: Final = (
    Variable(
        "target_spectral_acceleration",
        PERIOD,
        Unit.METRE_PER_SECOND_SQUARED,
        "pseudo-spectral acceleration that is aimed at",
    ),
    number(
        "target_standard_deviation",
        "standard deviation of the logarithm of the spectrum that is aimed at",
        PERIOD,
    ),
    Variable(
        "scaled_spectral_acceleration",
        PERIOD,
        Unit.METRE_PER_SECOND_SQUARED,
        "pseudo-spectral acceleration of the scaled motion",
    ),
    Variable(
        "set_median_acceleration",
        PERIOD,
        Unit.METRE_PER_SECOND_SQUARED,
        "geometric mean over the set of the scaled pseudo-spectral accelerations",
    ),
    number(
        "set_standard_deviation",
        "standard deviation over the set of the logarithm of the scaled spectra",
        PERIOD,
    ),
    number("set_misfit", "root mean square of the misfit of the set, with its spread"),
)
"""Of a set of motions beside a target spectrum."""
