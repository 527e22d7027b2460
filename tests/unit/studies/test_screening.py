"""Screened sweeps: fast runs, and runs by tolerance where a verdict is near its flip."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import RockframeError
from rockframe.simulation.certify.second_look import Look, is_sure
from rockframe.studies.sweeps import study
from rockframe.studies.sweeps.study import MIN_CASES_IN_LANES

pytestmark = [
    pytest.mark.wide,
    pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning"),
]

SYSTEM = rf.System(
    rf.Block.from_size(radius="2.5 m", slenderness=4.5, mass="20 t"),
    rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1),
)
AXES = {"scale": np.linspace(0.4, 1.1, 32).tolist(), "frequency_ratio": [10.0, 14.0, 20.0, 28.0]}
SCREENED = ("repeated", "verdict_changed")


def shaking(count=700):
    white = np.random.default_rng(8).normal(size=count)
    smooth = np.convolve(white, np.ones(6) / 6, "same")
    return rf.GroundMotion.from_arrays((6 * smooth, "m/s^2"), "0.02 s", name="noise")


@pytest.fixture(scope="module")
def runs():
    return {
        level: rf.sweep(SYSTEM, shaking(), **AXES, accuracy=level)
        for level in ("fast", "screen", "standard")
    }


STANDS = Look(
    overturned=False, share=0.6, impacts=20, time=np.nan, left=np.nan, direction=0, frequency=1.5
)
FALLS = Look(
    overturned=True, share=1.0, impacts=20, time=8.0, left=12.0, direction=1, frequency=1.5
)


def test_verdict_is_sure_beyond_three_times_its_error():
    # the clearance of a standing body is 0.4, or less in the finer run
    for share, sure in ((0.6, True), (0.67, True), (0.71, False), (0.52, True), (0.46, False)):
        assert is_sure(STANDS, replace(STANDS, share=share)) is sure
    # the energy of an overturning body changes by the share 2 omega dt
    for time, sure in ((8.0, True), (8.1, True), (8.12, False), (7.88, False)):
        assert is_sure(FALLS, replace(FALLS, time=time, left=20.0 - time)) is sure
    late = replace(FALLS, left=0.1)
    assert not is_sure(late, replace(late, time=8.04, left=0.06))
    for other in (
        replace(FALLS, direction=-1),
        replace(FALLS, impacts=22),
        replace(STANDS, share=0.99),
        replace(FALLS, overturned=None),
    ):
        assert not is_sure(FALLS, other)
    assert is_sure(FALLS, replace(FALLS, impacts=21))
    # the run with less time left, or with more impacts, decides
    soon = replace(FALLS, time=8.02, left=0.05)
    many, more = replace(FALLS, impacts=59), replace(FALLS, impacts=62)
    for first, second in ((FALLS, soon), (soon, FALLS)):
        assert not is_sure(first, second)
    for first, second in ((many, more), (more, many)):
        assert is_sure(first, second)


def test_screening_repeats_only_cases_near_a_flip_at_standard(runs):
    fast, screen, standard = (runs[level] for level in ("fast", "screen", "standard"))
    repeated = screen.repeated.astype(bool)
    assert 0 < int(repeated.sum()) < 0.1 * repeated.size
    for name in fast.data_vars:
        expected = xr.where(repeated, standard[name], fast[name])
        np.testing.assert_array_equal(screen[name], expected, err_msg=str(name))
    changed = fast.overturned != standard.overturned
    assert int(changed.sum()) > 0  # otherwise the test is void
    assert (screen.overturned == standard.overturned).all()
    np.testing.assert_array_equal(screen.verdict_changed, changed)
    assert {screen[name].dtype for name in SCREENED} == {np.dtype(bool)}
    assert not set(SCREENED) & set(fast.data_vars)
    words = f"{int(repeated.sum())} near a change of the verdict were run again with adaptive steps"
    assert words in screen.attrs["verdict"]
    assert f"changed {int(changed.sum())}." in screen.attrs["verdict"]
    assert screen.attrs["accuracy"] == "screen"


def test_screened_case_is_reproduced_alone(runs):
    screen = runs["screen"]
    for again in (True, False):
        place = np.argwhere(screen.repeated.to_numpy() == again)[0]
        dims = screen.repeated.dims
        labels = {dim: screen[dim].to_numpy()[k] for dim, k in zip(dims, place, strict=True)}
        alone = rf.case(screen, **labels).simulate()
        assert float(alone.peak_rotation) == float(screen.peak_rotation[tuple(place)])


def test_screening_does_not_depend_on_chunks_stores_or_lanes(runs, tmp_path, monkeypatch):
    monkeypatch.setattr(study, "COMPILING_SHARE", np.inf)
    cases = {**AXES, "scale": np.linspace(0.4, 1.1, 128).tolist()}
    lanes = rf.sweep(SYSTEM, shaking(), **cases, accuracy="screen")
    assert lanes.repeated.size >= MIN_CASES_IN_LANES
    stored = rf.sweep(SYSTEM, shaking(), **cases, accuracy="screen", chunk=57, store=tmp_path / "s")
    several = rf.open_study(tmp_path / "s")
    few = rf.sweep(SYSTEM, shaking(), **AXES, accuracy="screen", chunk=1)
    for one, other in ((lanes, stored), (stored, several), (runs["screen"], few)):
        xr.testing.assert_identical(one.drop_attrs(deep=False), other.drop_attrs(deep=False))


def test_repeated_cases_have_standard_histories(runs):
    repeated = runs["screen"].repeated.astype(bool)
    few = {**AXES, "scale": runs["screen"].scale[repeated.any(["frequency_ratio", "motion"])][:2]}
    few["scale"] = few["scale"].to_numpy().tolist()
    every = {
        level: rf.sweep(SYSTEM, shaking(), **few, accuracy=level, outputs=["rotation"])
        for level in ("fast", "screen", "standard")
    }
    expected = xr.where(
        every["screen"].repeated.astype(bool), every["standard"].rotation, every["fast"].rotation
    )
    xr.testing.assert_equal(every["screen"].rotation.drop_vars("message"), expected)


def test_cases_that_fail_are_not_screened():
    def scene(mass):
        if mass > 1.0:
            msg = "too heavy"
            raise ValueError(msg)
        return SYSTEM

    runs = rf.sweep(scene, shaking(60), mass=[1.0, 2.0], accuracy="screen")
    assert runs.repeated.squeeze().to_numpy().tolist()[0] == 0.0
    assert runs.repeated.isnull().squeeze().to_numpy().tolist() == [False, True]
    assert "too heavy" in str(runs.message.to_numpy())
    for alone in (SYSTEM.simulate, lambda motion, **how: rf.critical_scale(SYSTEM, motion, **how)):
        with pytest.raises(RockframeError, match=r"got 'screen'; sweeps, and analyses .* screen"):
            alone(shaking(60), accuracy="screen")


def on_rigid_ground():
    block = rf.Block(width="0.5 m", height="2 m", mass="400 kg")
    wall = rf.RearWall(side="left", restitution=-0.3)
    parts = {"held": (), "sliding": (rf.RigidGround(friction=0.4),), "wall": (wall,)}
    return {name: rf.System(block, *each) for name, each in parts.items()}


@pytest.mark.parametrize("name", on_rigid_ground())
def test_screening_on_rigid_ground_runs_all_cases_at_standard(name, tmp_path):
    system = on_rigid_ground()[name]
    axes = {"scale": np.linspace(0.3, 1.5, 24).tolist(), "gravity": ["9.81 m/s^2", "9.8 m/s^2"]}
    plain = rf.sweep(system, shaking(), **axes)
    for store in (None, tmp_path / "study"):
        found = rf.sweep(system, shaking(), **axes, accuracy="screen", store=store)
        xr.testing.assert_identical(
            found.drop_vars(SCREENED).drop_attrs(deep=False), plain.drop_attrs(deep=False)
        )
        for one in SCREENED:
            assert found[one].dims == plain.overturned.dims
            assert found[one].dtype == bool
            assert not found[one].any()
        assert found.attrs["accuracy"] == "standard"
        words = "all ran at 'standard', which costs less here than 'screen'."
        assert found.attrs["verdict"].endswith(words)
    alone = rf.case(found, scale=axes["scale"][9], gravity="9.8 m/s^2").simulate(outputs=None)
    assert alone.peak_rotation.item() == plain.peak_rotation.isel(scale=9, gravity=1).item()


def test_failed_cases_have_screening_gaps_on_rigid_ground():
    system = on_rigid_ground()["held"]
    runs = rf.sweep(system, shaking(60), height=(np.array([-1.0, 2.0]), "m"), accuracy="screen")
    assert runs.repeated.isnull().squeeze().to_numpy().tolist() == [True, False]
