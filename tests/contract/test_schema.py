"""The schema of all variables: names, units, flags."""

import re

import cf_units
import cf_xarray.units
import numpy as np
import pint
import pytest

from rockframe.results.schema import ENERGIES, SCHEMA

pytestmark = pytest.mark.contract

# dimensions in kg, m, s, rad of all documented variables
DIMENSIONS = {
    "time": (0, 0, 1, 0),
    "rotation": (0, 0, 0, 1),
    "angular_velocity": (0, 0, -1, 1),
    "vertical_displacement": (0, 1, 0, 0),
    "vertical_velocity": (0, 1, -1, 0),
    "horizontal_displacement": (0, 1, 0, 0),
    "relative_rotation": (0, 0, 0, 0),
    "relative_vertical_displacement": (0, 0, 0, 0),
    "ground_acceleration": (0, 1, -2, 0),
    "vertical_ground_acceleration": (0, 1, -2, 0),
    "base_shear": (1, 1, -2, 0),
    "left_reaction": (1, 1, -2, 0),
    "right_reaction": (1, 1, -2, 0),
    "soil_reaction": (1, 1, -2, 0),
    "contact_length": (0, 1, 0, 0),
    "cap_rotation": (0, 0, 0, 1),
    "cap_angular_velocity": (0, 0, -1, 1),
    "cap_vertical_displacement": (0, 1, 0, 0),
    "cap_vertical_velocity": (0, 1, -1, 0),
    "cap_acceleration": (0, 1, -2, 0),
    "cap_vertical_acceleration": (0, 1, -2, 0),
    "rotation_on_cap": (0, 0, 0, 1),
    "vertical_displacement_on_cap": (0, 1, 0, 0),
    "horizontal_velocity": (0, 1, -1, 0),
    "angular_acceleration": (0, 0, -2, 1),
    "horizontal_acceleration": (0, 1, -2, 0),
    "vertical_acceleration": (0, 1, -2, 0),
    "absolute_horizontal_acceleration": (0, 1, -2, 0),
    "absolute_vertical_acceleration": (0, 1, -2, 0),
    "horizontal_reaction": (1, 1, -2, 0),
    "vertical_reaction": (1, 1, -2, 0),
    "base_overturning_moment": (1, 2, -2, 0),
    "friction_demand": (0, 0, 0, 0),
    "soil_friction_demand": (0, 0, 0, 0),
    "toe_pressure": (1, 0, -2, 0),
    "event_horizontal_impulse": (1, 1, -1, 0),
    "event_vertical_impulse": (1, 1, -1, 0),
    "point_x": (0, 1, 0, 0),
    "point_y": (0, 1, 0, 0),
    "point_horizontal_displacement": (0, 1, 0, 0),
    "point_vertical_displacement": (0, 1, 0, 0),
    "point_horizontal_acceleration": (0, 1, -2, 0),
    "point_vertical_acceleration": (0, 1, -2, 0),
    "peak_point_horizontal_displacement": (0, 1, 0, 0),
    "peak_point_vertical_displacement": (0, 1, 0, 0),
    "peak_point_horizontal_acceleration": (0, 1, -2, 0),
    "peak_point_vertical_acceleration": (0, 1, -2, 0),
    "peak_friction_demand": (0, 0, 0, 0),
    "peak_friction_demand_time": (0, 0, 1, 0),
    "peak_friction_demand_duration": (0, 0, 1, 0),
    "sliding_time": (0, 0, 1, 0),
    "sliding_duration": (0, 0, 1, 0),
    "peak_impulsive_friction_demand": (0, 0, 0, 0),
    "peak_base_shear": (1, 1, -2, 0),
    "residual_rotation": (0, 0, 0, 1),
    "residual_settlement": (0, 1, 0, 0),
    "peak_settlement": (0, 1, 0, 0),
    "kinetic_energy": (1, 2, -2, 0),
    "potential_energy": (1, 2, -2, 0),
    "elastic_energy": (1, 2, -2, 0),
    "dissipated_energy": (1, 2, -2, 0),
    "impact_energy": (1, 2, -2, 0),
    "repinning_energy": (1, 2, -2, 0),
    "input_energy": (1, 2, -2, 0),
    "event_time": (0, 0, 1, 0),
    "event_rotation": (0, 0, 0, 1),
    "angular_velocity_before": (0, 0, -1, 1),
    "angular_velocity_after": (0, 0, -1, 1),
    "overturning_time": (0, 0, 1, 0),
    "peak_rotation": (0, 0, 0, 1),
    "peak_relative_rotation": (0, 0, 0, 0),
    "first_uplift_time": (0, 0, 1, 0),
    "impact_count": (0, 0, 0, 0),
    "flight_time": (0, 0, 1, 0),
    "energy_residual": (0, 0, 0, 0),
    "overturning_angle": (0, 0, 0, 1),
    "uplift_angle": (0, 0, 0, 1),
    "angle": (0, 0, 0, 1),
    "restoring_moment": (1, 2, -2, 0),
    "base_moment": (1, 2, -2, 0),
    "held_vertical_displacement": (0, 1, 0, 0),
    "held_left_reaction": (1, 1, -2, 0),
    "held_right_reaction": (1, 1, -2, 0),
    "held_soil_reaction": (1, 1, -2, 0),
    "held_contact_length": (0, 1, 0, 0),
    "held_cap_rotation": (0, 0, 0, 1),
    "pad_settlement": (0, 1, 0, 0),
    "soil_settlement": (0, 1, 0, 0),
    "static_left_reaction": (1, 1, -2, 0),
    "static_right_reaction": (1, 1, -2, 0),
    "static_soil_reaction": (1, 1, -2, 0),
    "uplift_moment": (1, 2, -2, 0),
    "soil_uplift_moment": (1, 2, -2, 0),
    "mode": (0, 0, 0, 0),
    "angular_frequency": (0, 0, -1, 1),
    "frequency": (0, 0, -1, 0),
    "period": (0, 0, 1, 0),
    "damping_ratio": (0, 0, 0, 0),
    "verdict_margin": (0, 0, 0, 0),
    "peak_error_estimate": (0, 0, 0, 1),
    "peak_sensitivity": (0, 0, 0, 1),
    "run_time": (0, 0, 1, 0),
    "run_time_least": (0, 0, 1, 0),
    "run_time_greatest": (0, 0, 1, 0),
    "numerical_peak_error": (0, 0, 0, 0),
    "numerical_history_error": (0, 0, 0, 0),
    "event_time_error": (0, 0, 1, 0),
    "peak_error": (0, 0, 0, 0),
    "history_error": (0, 0, 0, 0),
    "ground_velocity": (0, 1, -1, 0),
    "ground_displacement": (0, 1, 0, 0),
    "vertical_ground_velocity": (0, 1, -1, 0),
    "vertical_ground_displacement": (0, 1, 0, 0),
    "peak_ground_acceleration": (0, 1, -2, 0),
    "peak_ground_velocity": (0, 1, -1, 0),
    "peak_ground_displacement": (0, 1, 0, 0),
    "arias_intensity": (0, 1, -1, 0),
    "cumulative_absolute_velocity": (0, 1, -1, 0),
    "standardized_cumulative_absolute_velocity": (0, 1, -1, 0),
    "significant_duration_5_75": (0, 0, 1, 0),
    "significant_duration_5_95": (0, 0, 1, 0),
    "bracketed_duration": (0, 0, 1, 0),
    "housner_spectrum_intensity": (0, 1, 0, 0),
    "mean_period": (0, 0, 1, 0),
    "predominant_velocity_period": (0, 0, 1, 0),
    "uplift_acceleration": (0, 1, -2, 0),
    "uplift_duration": (0, 0, 1, 0),
    "relative_peak_ground_acceleration": (0, 0, 0, 0),
    "relative_peak_ground_velocity": (0, 0, 0, 0),
    "relative_predominant_frequency": (0, 0, 0, 0),
    "relative_pulse_frequency": (0, 0, 0, 0),
    "spectral_displacement": (0, 1, 0, 0),
    "spectral_velocity": (0, 1, -1, 0),
    "absolute_spectral_acceleration": (0, 1, -2, 0),
    "pseudo_spectral_velocity": (0, 1, -1, 0),
    "pseudo_spectral_acceleration": (0, 1, -2, 0),
    "fourier_amplitude": (0, 1, -1, 0),
    "fourier_phase": (0, 0, 0, 1),
    "critical_scale": (0, 0, 0, 0),
    "followed_scale": (0, 0, 0, 0),
    "largest_gap": (0, 0, 0, 0),
    "uplift_scale": (0, 0, 0, 0),
    "scale_below": (0, 0, 0, 0),
    "scale_above": (0, 0, 0, 0),
    "scale": (0, 0, 0, 0),
    "fitted_value": (0, 0, 0, 0),
    "standard_error": (0, 0, 0, 0),
    "lower_confidence_bound": (0, 0, 0, 0),
    "upper_confidence_bound": (0, 0, 0, 0),
    "start_value": (0, 0, 0, 0),
    "initial_rotation": (0, 0, 0, 1),
    "initial_rotation_error": (0, 0, 0, 1),
    "release_time": (0, 0, 1, 0),
    "release_time_error": (0, 0, 1, 0),
    "gauge_offset": (0, 0, 0, 1),
    "gauge_offset_error": (0, 0, 0, 1),
    "correlation": (0, 0, 0, 0),
    "measured_rotation": (0, 0, 0, 1),
    "fitted_rotation": (0, 0, 0, 1),
    "rotation_residual": (0, 0, 0, 1),
    "measured_peak_rotation": (0, 0, 0, 1),
    "fitted_peak_rotation": (0, 0, 0, 1),
    "peak_rotation_residual": (0, 0, 0, 1),
    "measured_peak_time": (0, 0, 1, 0),
    "fitted_peak_time": (0, 0, 1, 0),
    "peak_time_residual": (0, 0, 1, 0),
    "rotation_rms_residual": (0, 0, 0, 1),
    "time_rms_residual": (0, 0, 1, 0),
    "residual_autocorrelation": (0, 0, 0, 0),
    "trial_count": (0, 0, 0, 0),
    "case": (0, 0, 0, 0),
    "rotation_limit": (0, 0, 0, 0),
    "capacity_scale": (0, 0, 0, 0),
    "capacity_resolution": (0, 0, 0, 0),
    "censored_count": (0, 0, 0, 0),
    "dispersion": (0, 0, 0, 0),
    "exceedance_probability": (0, 0, 0, 0),
    "velocity_to_acceleration_ratio": (0, 0, 1, 0),
    "amplitude": (0, 1, -2, 0),
    "amplitude_below": (0, 1, -2, 0),
    "amplitude_above": (0, 1, -2, 0),
    "impacts_before_overturning": (0, 0, 0, 0),
    "rocking_period": (0, 0, 1, 0),
    "slenderness": (0, 0, 0, 0),
    "overturning_probability": (0, 0, 0, 0),
    "cumulative_probability": (0, 0, 0, 0),
    "record_sequence_number": (0, 0, 0, 0),
    "year": (0, 0, 0, 0),
    "magnitude": (0, 0, 0, 0),
    "azimuth": (0, 0, 0, 1),
    "rupture_distance": (0, 1, 0, 0),
    "joyner_boore_distance": (0, 1, 0, 0),
    "shear_wave_velocity_30": (0, 1, -1, 0),
    "lowest_usable_frequency": (0, 0, -1, 0),
    "stated_pulse_period": (0, 0, 1, 0),
    "time_step": (0, 0, 1, 0),
    "duration": (0, 0, 1, 0),
    "sample_count": (0, 0, 0, 0),
    "scale_factor": (0, 0, 0, 0),
    "spectral_misfit": (0, 0, 0, 0),
    "median_rotated_acceleration": (0, 1, -2, 0),
    "greatest_rotated_acceleration": (0, 1, -2, 0),
    "geometric_mean_acceleration": (0, 1, -2, 0),
    "direction_of_greatest": (0, 0, 0, 1),
    "vertical_spectral_acceleration": (0, 1, -2, 0),
    "vertical_to_horizontal_ratio": (0, 0, 0, 0),
    "major_axis_angle": (0, 0, 0, 1),
    "major_arias_intensity": (0, 1, -1, 0),
    "minor_arias_intensity": (0, 1, -1, 0),
    "average_spectral_acceleration": (0, 1, -2, 0),
    "average_geometric_mean_acceleration": (0, 1, -2, 0),
    "average_median_rotated_acceleration": (0, 1, -2, 0),
    "target_spectral_acceleration": (0, 1, -2, 0),
    "target_standard_deviation": (0, 0, 0, 0),
    "scaled_spectral_acceleration": (0, 1, -2, 0),
    "set_median_acceleration": (0, 1, -2, 0),
    "set_standard_deviation": (0, 0, 0, 0),
    "set_misfit": (0, 0, 0, 0),
}
DIMENSION_NAMES = {
    "restrainer",
    "run",
    "measure",
    "covariate",
    "response_level",
    "contributing_intensity",
    "body",
    "time",
    "sample_after_end",
    "event",
    "point",
    "angle",
    "mode",
    "damping_ratio",
    "period",
    "frequency",
    "flip",
    "scale",
    "sampling_level",
    "parameter",
    "unknown",
    "other_unknown",
    "peak",
    "case",
    "motion",
    "limit_state",
    "stripe",
    "coefficient",
    "boundary",
    "amplitude",
    "rocking_period",
    "slenderness",
    "sequence",
    "earthquake",
    "rank",
    "quantile",
}
PLAIN = pint.UnitRegistry(cache_folder=None)
FLAGS = {
    "contact_state",
    "soil_contact_state",
    "held_contact_state",
    "event_kind",
    "overturning_direction",
    "status",
    "outcome",
    "fit_status",
    "fragility_status",
}

WITH_UNIT = [row for row in SCHEMA.values() if row.unit is not None]


def test_schema_contains_documented_variables():
    assert set(DIMENSIONS) | FLAGS | {"overturned"} <= set(SCHEMA)
    assert set(ENERGIES) <= set(SCHEMA)
    assert set(ENERGIES) == {name for name in SCHEMA if name.endswith("_energy")}


@pytest.mark.parametrize("text", sorted({row.attributes()["units"] for row in WITH_UNIT}))
def test_udunits_and_pint_agree_on_a_unit(text):
    udunits = cf_units.Unit(text)
    assert not udunits.is_unknown()
    for registry in (PLAIN, cf_xarray.units.units):
        unit = registry.Unit(text)
        size = registry.Quantity(1.0, unit).to_base_units()
        assert size.magnitude == pytest.approx(1.0, rel=1e-15)
        base = {"kilogram": "kg", "meter": "m", "second": "s", "radian": "rad"}
        powers = {base[name]: power for name, power in size.unit_items()}
        again = " ".join(f"{name}{power:g}" for name, power in powers.items()) or "1"
        assert udunits == cf_units.Unit(again)
        assert udunits.convert(1.0, cf_units.Unit(again)) == 1.0


def test_units_have_the_dimensions_of_their_quantities():
    symbols = ("kg", "m", "s", "rad")
    for name, powers in DIMENSIONS.items():
        text = SCHEMA[name].attributes()["units"]
        expected = " ".join(
            f"{symbol}{power}" for symbol, power in zip(symbols, powers, strict=True) if power
        )
        unit = cf_units.Unit(text)
        assert unit.convert(1.0, cf_units.Unit(expected or "1")) == 1.0, name
        # in UDUNITS the radian is dimensionless; only the spelling differs
        assert ("rad" in text) == bool(powers[3]), name


def test_units_have_agreed_spelling():
    word = r"(kg|m|s|rad|Hz|N|J)(\^-?[1-9])?"
    for row in WITH_UNIT:
        text = row.attributes()["units"]
        assert text == "1" or re.fullmatch(rf"{word}( {word})*", text), row.name


def test_names_are_full_words():
    for name, row in SCHEMA.items():
        assert name == row.name
        assert re.fullmatch(r"[a-z]+(_[a-z]+|_\d+)*", name)
        assert row.long_name, name
        assert row.long_name == row.long_name.strip(), name
        assert not row.long_name.endswith("."), name
        assert set(row.dims) <= DIMENSION_NAMES, name
        assert "standard_name" not in row.attributes(), name


def test_long_names_are_unique():
    words = [row.long_name for row in SCHEMA.values()]
    assert len(set(words)) == len(words)


def test_long_names_stand_alone():
    other_row = r"\b(which it does|on it does|the same of|its rate|(error|bound|period) of that)\b"
    words = {name: row.long_name for name, row in SCHEMA.items()}
    assert [name for name, said in words.items() if re.search(other_row, said)] == []


def test_flags_follow_cf():
    for name, row in SCHEMA.items():
        attributes = row.attributes()
        if row.flags is None:
            assert ("flag_values" in attributes) == (row.dtype == "bool"), name
            assert (row.unit is None) == (row.dtype in ("bool", "str")), name
            assert row.dtype in ("float64", "int64", "bool", "str"), name
            continue
        assert row.dtype == "int8", name
        assert "units" not in attributes, name
        values = attributes["flag_values"]
        assert isinstance(values, np.ndarray), name
        assert values.dtype == np.int8, name
        meanings = attributes["flag_meanings"].split(" ")
        assert len(meanings) == len(values) == len(set(meanings)) == len(set(values.tolist()))
        assert all(re.fullmatch(r"[A-Za-z0-9_.+@-]+", meaning) for meaning in meanings), name


@pytest.mark.parametrize(
    ("name", "dims"),
    [
        ("contact_state", ("time",)),
        ("soil_contact_state", ("time",)),
        ("contact_state_before", ("event",)),
        ("soil_contact_state_after", ("event",)),
        ("held_contact_state", ("angle",)),
    ],
)
def test_contact_states_have_the_agreed_names(name, dims):
    row = SCHEMA[name]
    assert row.dims == dims
    attributes = row.attributes()
    assert attributes["flag_meanings"] == "full left right flight"
    assert attributes["flag_values"].tolist() == [0, 1, 2, 3]


def test_booleans_are_cf_flags():
    attributes = SCHEMA["overturned"].attributes()
    assert attributes["flag_values"].dtype == np.int8
    assert attributes["flag_values"].tolist() == [0, 1]
    assert attributes["flag_meanings"] == "false true"


def test_soil_events_have_own_names():
    meanings = SCHEMA["event_kind"].attributes()["flag_meanings"].split()
    assert {"soil_separation", "soil_contact", "soil_pivot_change"} <= set(meanings)
