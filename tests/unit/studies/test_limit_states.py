"""Limit states on variables of runs."""

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import ComponentError, SchemaError, UnitsError

BLOCK = rf.Block(width="0.5 m", height="2 m", mass="400 kg")
SUITE = [rf.GroundMotion.stochastic(6.5, "10 km", seed=k) for k in range(6)]
HOW = {"accuracy": "fast", "progress": False}
ROOF = ("peak_point_horizontal_acceleration", "6 m/s^2", "top")


@pytest.fixture(scope="module")
def runs():
    return rf.sweep(
        rf.System(BLOCK), SUITE, scale=[0.5, 1.0, 2.0, 3.0, 4.0],
        points={"foot": ("0 m", "0.1 m"), "top": ("0 m", "2 m")}, **HOW,
    )  # fmt: skip


def test_runs_exceed_where_the_variable_does(runs):
    found = rf.fragility(runs, limits=[0.3, ROOF])
    name = "peak point horizontal acceleration top 6 m s^-2"
    assert found.limit_state.values.tolist() == ["rotation 0.3", name, "overturning"]
    assert np.isnan(found.rotation_limit.values).tolist() == [False, True, False]
    peaks = runs["peak_point_horizontal_acceleration"].sel(point="top")
    over = (abs(peaks) >= 6.0) | (runs.overturned == 1.0)
    assert 0 < int(over.sum()) < over.size
    counted = found.sel(limit_state=name)
    assert int(counted.stripe_exceedances.sum()) == int(over.sum())
    assert int(counted.trial_count) == over.size
    rotation = rf.fragility(runs, limits=[("peak_relative_rotation", 0.3)]).isel(limit_state=0)
    assert rotation.median_intensity == found.median_intensity[0]


def test_a_dynamic_analysis_narrows_them_too():
    """A slip of so many metres is exceeded between two runs that tell it."""
    slides = rf.System(BLOCK, rf.RigidGround(friction=0.1))
    found = rf.incremental_dynamic_analysis(
        slides, SUITE[:2], scale=[1.0, 2.0, 4.0], limits=[("peak_slip", "1 cm")], **HOW
    )
    capacity = found.capacity_scale.isel(limit_state=0)
    assert found.limit_state.values[0] == "peak slip 0.01 m"
    assert np.isfinite(capacity).any()
    for name, least in zip(found.motion.values, capacity.values, strict=True):
        if np.isfinite(least):
            around = rf.sweep(slides, SUITE[:2], scale=[least * (1 - 2e-3), least], **HOW)
            slips = around.peak_slip.sel(motion=name).values
            assert slips[0] < 0.01 <= slips[1]
    again = rf.fragility(found, trials="capacities")
    assert again.limit_state.values.tolist() == found.limit_state.values.tolist()
    one = rf.fragility(found.isel(limit_state=[0]))
    assert one.limit_state.values.tolist() == ["peak slip 0.01 m"]


def test_what_is_missing_is_named(runs):
    for wrong, kind, match in (
        (("peak_slip", "5 cm"), SchemaError, "the runs have no 'peak_slip"),
        (("peak_slip", "5 kg"), UnitsError, "peak_slip"),
        (("girth", 1), ComponentError, "no variable 'girth'; give one such as in \\('peak_slip'"),
        (ROOF[:2], ComponentError, "is of point; give one of 'foot', 'top'"),
        ((*ROOF[:2], "roof"), ComponentError, "got 'roof'"),
    ):
        with pytest.raises(kind, match=match):
            rf.fragility(runs, limits=[wrong])


def test_cases_without_a_result_exceed_nothing(runs):
    lacking = runs.assign(overturned=runs.overturned.astype(float)).copy(deep=True)
    for name in ("peak_relative_rotation", "peak_point_horizontal_acceleration"):
        lacking[name][{"motion": 0}] = np.nan
    lacking["overturned"][{"motion": 0}] = np.nan
    found = rf.fragility(lacking, limits=[ROOF]).isel(limit_state=0)
    assert int(found.left_out_count) == runs.sizes["scale"]
    assert isinstance(found, xr.Dataset)
