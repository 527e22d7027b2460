"""Dynamic analyses over further axes: each structure has the capacities of a single analysis."""

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import SchemaError, StudyError

SYSTEM = rf.System(rf.Block(width="0.5 m", height="2 m", mass="300 kg"))
SUITE = {
    f"seed {k}": rf.GroundMotion.stochastic(6.5, "8 km", seed=k).window("8 s", "20 s")
    for k in range(3)
}
OPTIONS = {
    "scale": [2.0, 4.0, 8.0], "limits": ["uplift", 0.4], "free_vibration": "2 s",
    "accuracy": "fast", "resolution": 0.2, "bracket_width": 0.01,
}  # fmt: skip
LINES = ("capacity_scale", "capacity_resolution", "flip_count")


@pytest.fixture(scope="module")
def wide():
    """Return an analysis over two widths."""
    return rf.incremental_dynamic_analysis(
        SYSTEM, SUITE, width=["0.5 m", "0.7 m"], restitution=[0.75, 0.8], intensity="PGA", **OPTIONS
    )


def single_analysis(width: str, restitution: float) -> xr.Dataset:
    """Analyse one structure by itself."""
    system = rf.System(
        rf.Block(width=width, height="2 m", mass="300 kg"), rf.RigidGround(restitution=restitution)
    )
    return rf.incremental_dynamic_analysis(system, SUITE, intensity="PGA", **OPTIONS)


def test_each_structure_has_the_capacities_of_a_separate_analysis(wide):
    assert wide.capacity_scale.dims == ("limit_state", "width", "restitution", "motion")
    assert int(np.isfinite(wide.capacity_scale.isel(limit_state=-1)).sum()) > 0
    assert wide.censored_count.dims == ("limit_state", "width", "restitution")
    assert wide.peak_rotation.dims == ("width", "restitution", "scale", "motion")
    for width, restitution in ((0.5, 0.8), (0.7, 0.75)):
        one, part = (
            single_analysis(f"{width} m", restitution),
            wide.sel(width=width, restitution=restitution),
        )
        for name in LINES:
            np.testing.assert_array_equal(part[name], one[name])
        # the dimension of flips has the size of the structure with most flips
        below = part.scale_below.values[..., : one.sizes["flip"]]
        np.testing.assert_array_equal(below, one.scale_below)
        np.testing.assert_array_equal(
            part.peak_rotation.transpose(*one.peak_rotation.dims), one.peak_rotation
        )
    assert "12 lines, of 4 structures by width, restitution under 3 motions, " in wide.verdict
    case = rf.case(wide, width="0.7 m", restitution=0.75, scale=4.0, motion="seed 1")
    peak = wide.peak_rotation.sel(width=0.7, restitution=0.75, scale=4.0, motion="seed 1")
    assert case.simulate(outputs=None).peak_rotation.item() == peak.item()


@pytest.mark.parametrize("trials", ["runs", pytest.param("capacities", marks=pytest.mark.long)])
def test_each_structure_has_a_fragility_of_its_own(wide, trials):
    found = rf.fragility(wide, "PGA", trials=trials)
    assert found.median_intensity.dims == ("width", "restitution", "limit_state")
    one = rf.fragility(single_analysis("0.5 m", 0.8), "PGA", trials=trials)
    part = found.sel(width=0.5, restitution=0.8)
    for name in ("median_intensity", "dispersion", "trial_count", "fragility_status"):
        np.testing.assert_array_equal(part[name], one[name])
    pooled = rf.fragility(wide, "PGA", trials=trials, pooled=["width", "restitution"])
    every = found.trial_count.sum(["width", "restitution"])
    np.testing.assert_array_equal(pooled.trial_count, every)


def test_single_structure_can_be_plotted_and_has_fractiles(wide):
    with pytest.raises(SchemaError, match=r"by width \(2\), restitution \(2\)"):
        rf.plot.dynamic_analysis(wide)
    one = wide.isel(width=[0], restitution=[1])
    rf.plot.dynamic_analysis(one)
    curves = rf.fractile_curves(one, "PGA")
    same = rf.fractile_curves(single_analysis("0.5 m", 0.8), "PGA")
    np.testing.assert_array_equal(curves.intensity_fractile, same.intensity_fractile)


def test_subset_has_its_own_verdict(wide):
    assert wide.rockframe.verdict == wide.verdict
    one = wide.isel(width=0, restitution=1)
    assert one.rockframe.verdict == single_analysis("0.5 m", 0.8).verdict
    some = wide.isel(width=0, motion=[0, 2])
    assert some.rockframe.verdict.startswith("Of 4 lines, of 2 structures by restitution under 2")
    assert wide.isel(limit_state=[0]).rockframe.verdict  # of another limit state than overturning
    assert wide.isel(motion=0).rockframe.verdict.startswith("Of 12 of the 36 cases")


def test_the_system_may_be_a_function_of_the_axes(wide):
    def cabinet(width: object, kind: str, columns: int) -> rf.System:
        block = rf.Block(width=width, height="2 m", mass="300 kg")
        ground = rf.RigidGround(restitution=0.75 if kind == "worn" else 0.8)
        assert isinstance(columns, int)
        return rf.System(block, ground)

    found = rf.incremental_dynamic_analysis(
        cabinet,
        SUITE,
        axes={"width": ["0.5 m", "0.7 m"]},
        kind=["worn", "new"],
        columns=[3],
        **OPTIONS,
    )
    assert found.capacity_scale.dims == ("limit_state", "width", "kind", "columns", "motion")
    np.testing.assert_array_equal(found.capacity_scale.squeeze(), wide.capacity_scale.squeeze())


def test_study_of_axes_survives_store_and_netcdf(tmp_path, wide):
    axes = {"width": ["0.5 m", "0.7 m"], "restitution": [0.75, 0.8]}
    stored = rf.incremental_dynamic_analysis(
        SYSTEM, SUITE, axes=axes, store=tmp_path / "kept", intensity="PGA", **OPTIONS
    )
    xr.testing.assert_equal(stored.drop_vars("message"), wide.drop_vars("message"))
    stored.to_netcdf(tmp_path / "kept.nc")
    with xr.open_dataset(tmp_path / "kept.nc") as again:
        np.testing.assert_array_equal(again.capacity_scale, wide.capacity_scale)


@pytest.mark.parametrize(
    ("axes", "match"),
    [
        ({"widht": ["1 m"]}, "'widht' names no parameter; was 'width'"),
        ({"limit": [0.3]}, "was 'limits' meant"),
        ({"width": 1e-3}, "width needs a length"),
        ({"cases": {"width [m]": [1.0]}}, "takes no 'cases', as rf.sweep does"),
        ({"PGA": ["1 m/s^2"]}, "give scale alone"),
        ({"axes": 3}, "axes must be a mapping"),
        ({"axes": ["1 m"], "width": ["1 m"]}, "axes must be a mapping"),
        ({"peak_ground_acceleration": ["1 m/s^2"]}, "give scale alone"),
        ({"width": []}, "no values"),
        ({"width": ["1 m", "1 m"]}, "has the value 1.0 twice"),
        ({"width": ["1 m"], "radius": ["2 m"]}, "determine its size twice"),
    ],
)
def test_invalid_axes_are_refused(axes, match):
    with pytest.raises(StudyError, match=match):
        rf.incremental_dynamic_analysis(SYSTEM, SUITE, **axes, **OPTIONS)


def test_duplicate_axis_is_refused():
    with pytest.raises(TypeError, match="got 'width' twice"):
        rf.incremental_dynamic_analysis(SYSTEM, SUITE, axes={"width": ["1 m"]}, width=["2 m"])
