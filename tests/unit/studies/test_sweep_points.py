"""Points of the body in sweeps: peaks over `point`, and histories on request."""

import math

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import AssemblyError, SolverWarning, StudyError
from rockframe.studies.sweeps import planning

BLOCK = rf.Block(width="0.8 m", height="3.6 m", mass="4 t")
ON_PADS = rf.System(BLOCK, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1))
ON_GROUND = rf.System(BLOCK, rf.RigidGround())
PULSE = rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz")
SHAKING = rf.GroundMotion.stochastic(6.0, "10 km", seed=4).window("0 s", "8 s")
MOTIONS = {"pulse": PULSE, "shaking": SHAKING}
POINTS = {"roof": ("0 m", "3.6 m"), "shelf": ("20 cm", "1 m"), "toe": ("0.4 m", "0 m")}
PEAKS = [
    f"peak_point_{name}"
    for name in (
        "horizontal_displacement", "vertical_displacement", "horizontal_acceleration",
        "vertical_acceleration",
    )
]  # fmt: skip
FAST = {"accuracy": "fast", "free_vibration": "1 s"}
SCALES = [0.3, 0.5, 1.5]

REQUESTED = ["point_vertical_acceleration", "rotation"]


def case_alone(runs, **labels):
    """Return the single run of a case, and the case in the sweep."""
    return rf.case(runs, **labels).simulate(), runs.sel(labels)


@pytest.mark.parametrize(
    ("system", "outputs"),
    [
        (ON_PADS, ()),
        (ON_GROUND, None),
        (ON_GROUND, REQUESTED),
        pytest.param(ON_PADS, None, marks=pytest.mark.long),
        pytest.param(ON_PADS, REQUESTED, marks=pytest.mark.long),
        pytest.param(ON_GROUND, (), marks=pytest.mark.long),
    ],
)
def test_peaks_at_points_equal_single_runs(system, outputs):
    runs = rf.sweep(
        system, MOTIONS, scale=SCALES, points=POINTS, outputs=outputs, output_step="0.02 s",
        **FAST,
    )  # fmt: skip
    assert runs[PEAKS[0]].dims == ("scale", "motion", "point")
    assert runs.point.values.tolist() == list(POINTS)
    assert runs.point_x.values.tolist() == [0.0, 0.2, 0.4]
    histories = [name for name in runs.data_vars if "time" in runs[name].dims]
    at_points = {name for name in histories if "point" in runs[name].dims}
    if outputs is None:
        assert not histories
    elif outputs:
        assert set(histories) == set(outputs)
        assert at_points == {"point_vertical_acceleration"}
    else:
        assert {name.removeprefix("peak_") for name in PEAKS} == at_points < set(histories)
    for scale in SCALES:
        for motion in MOTIONS:
            one, part = case_alone(runs, scale=scale, motion=motion)
            for name in (*PEAKS, "peak_base_shear", "residual_rotation", "peak_rotation"):
                np.testing.assert_array_equal(part[name], one[name])
            for name in histories:
                # a run that overturns also has its end as a time
                own = one[name].isel(time=np.isin(one.time, runs.time))
                held = part[name].isel(time=slice(own.sizes["time"]))
                np.testing.assert_array_equal(held, own)
                assert part[name].isel(time=slice(own.sizes["time"], None)).isnull().all()


def test_point_peaks_match_dense_histories_up_to_overturning():
    point = {"roof": POINTS["roof"]}
    for scale in (0.5, 1.5):
        going_on = {"overturning": "continue", "duration": "6 s"}
        coarse = ON_PADS.simulate(PULSE.scaled(scale), points=point, outputs=None, **going_on)
        fine = ON_PADS.simulate(
            PULSE.scaled(scale), points=point, output_step="0.0002 s", **going_on
        )
        assert coarse.overturned == (scale == 1.5)
        until = math.inf if scale < 1.0 else coarse.overturning_time.item()
        standing = fine.isel(time=fine.time.values <= until)
        for name in PEAKS:
            dense = abs(standing[name.removeprefix("peak_")]).max().item()
            assert fine[name].item() == pytest.approx(dense, rel=1e-3)
            assert coarse[name].item() == pytest.approx(dense, rel=0.02)
        assert "time" not in coarse.dims
        assert coarse.run_json.count('"outputs": null') == 1


def test_pivot_corner_does_not_move():
    start = rf.InitialState(rotation="0.05 rad")
    half, height = 0.4, 3.6
    found = ON_GROUND.simulate(
        initial=start, duration="0.2 s", outputs=None, points={
            "right": ("0.4 m", "0 m"), "left": ("-0.4 m", "0 m"), "top": ("0.4 m", "3.6 m"),
        },
    )  # fmt: skip
    across, up = found[PEAKS[0]], found[PEAKS[1]]
    assert across.sel(point="right").item() == pytest.approx(0.0, abs=1e-15)
    # at the start the other corner is highest: a rotation about the right one, by hand
    assert up.sel(point="left").item() == pytest.approx(2 * half * math.sin(0.05), rel=1e-12)
    assert across.sel(point="top").item() == pytest.approx(height * math.sin(0.05), rel=1e-12)


def test_points_survive_stores_screening_chunks_and_tables(tmp_path):
    options = {"scale": SCALES, "points": POINTS, "outputs": ["point_horizontal_acceleration"]}
    plain = rf.sweep(ON_PADS, PULSE, **options, **FAST)
    stored = rf.sweep(ON_PADS, PULSE, **options, **FAST, store=tmp_path / "study", chunk=1)
    again = rf.open_study(tmp_path / "study")
    for one in (stored, again):
        xr.testing.assert_identical(one.drop_attrs(deep=False), plain.drop_attrs(deep=False))
    part = tmp_path / "study" / "chunk-000001.arrays"
    part.unlink()
    gap = rf.open_study(tmp_path / "study")
    assert gap[PEAKS[0]].isnull().all("point").sum() == 1
    for path in (tmp_path / "study").glob("chunk*"):
        path.unlink()
    assert rf.open_study(tmp_path / "study")[PEAKS[2]].dims == ("scale", "motion", "point")
    screened = rf.sweep(ON_PADS, PULSE, scale=SCALES, points=POINTS, accuracy="screen")
    for scale in SCALES:
        one, found = case_alone(screened, scale=scale)
        for name in PEAKS:
            np.testing.assert_array_equal(found[name].squeeze(), one[name])
    assert len(rf.table(plain)) == len(SCALES)
    assert "point" in rf.table(plain, "histories").index.names
    plain.to_netcdf(tmp_path / "runs.nc")
    with xr.open_dataset(tmp_path / "runs.nc") as read:
        xr.testing.assert_equal(read[PEAKS], plain[PEAKS])


def test_cases_without_a_run_have_no_peaks():
    with pytest.warns(SolverWarning, match="1 of 2 cases have no result"):
        runs = rf.sweep(ON_PADS, PULSE, height=["1e200 m", "3.6 m"], points=POINTS, **FAST)
    lacking = runs[PEAKS].isel(height=0).to_array()
    assert lacking.isnull().all()
    assert runs[PEAKS].isel(height=1).to_array().notnull().all()


def test_invalid_points_are_refused():
    with pytest.raises(StudyError) as caught:
        rf.sweep(ON_PADS, PULSE, scale=[1.0], points={"roof": ("1 kg", "2 m"), "shelf": "1 m"})
    assert "points['roof']" in str(caught.value)
    assert "point 'shelf' needs two lengths" in str(caught.value)
    with pytest.raises(StudyError, match=r"'point_vertical_acceleration' is of points, and there"):
        rf.sweep(ON_PADS, PULSE, scale=[1.0], outputs=["point_vertical_acceleration"])
    with pytest.raises(AssemblyError, match="is of points, and there are none"):
        ON_PADS.simulate(PULSE, outputs=["point_vertical_acceleration"])
    with pytest.raises(StudyError, match="axis 'point' has the name of a result"):
        rf.sweep(lambda point: ON_PADS, PULSE, point=[1.0])


def test_more_values_than_memory_has_are_refused(monkeypatch):
    monkeypatch.setattr(planning, "available_memory", lambda: 4e5)
    arguments = {"scale": SCALES, "points": POINTS, "free_vibration": "1 s"}
    names = ["point_vertical_acceleration", "rotation"]
    with pytest.raises(
        StudyError, match=r"3 cases need .*histories of 4001 times .*longer output_step"
    ):
        rf.sweep(ON_PADS, PULSE, **arguments, outputs=names, output_step="0.5 ms")
    rf.sweep(ON_PADS, PULSE, **arguments, outputs=["rotation"])
    monkeypatch.setattr(planning, "available_memory", lambda: 1e3)
    with pytest.raises(StudyError, match=r"3 cases need .*peaks at 3 points .*name fewer points"):
        rf.sweep(ON_PADS, PULSE, **arguments)
