"""The least scale that overturns: labels, brackets, options, measures, refusals."""

import itertools
import math
import warnings
from contextlib import nullcontext
from importlib import import_module

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import (
    AssemblyError,
    ComponentError,
    ModelWarning,
    RecordWarning,
    SolverError,
    SolverWarning,
    UnitsError,
)
from rockframe.simulation.run import compute_summary

BLOCK = rf.Block(width="0.8 m", height="3.6 m", mass="4 t")
RIGID = rf.System(BLOCK)
ON_PADS = rf.System(BLOCK, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1))
ON_SOIL = rf.System(BLOCK, rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2))
SHAKING = rf.GroundMotion.stochastic(6.5, "8 km", seed=4, source="one corner").scaled(
    peak="3 m/s^2"
)
PULSE = rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz")
FEW_RUNS = {"scales": 30, "runs": 60, "free_vibration": "3 s", "accuracy": "fast"}
CASES = {
    "rigid ground": (RIGID, SHAKING, FEW_RUNS),
    "pads, from a start": (
        ON_PADS,
        SHAKING,
        {**FEW_RUNS, "initial": rf.InitialState(rotation="0.05 rad"), "accuracy": "standard"},
    ),
    "soil, a pulse": (ON_SOIL, PULSE, {**FEW_RUNS, "bracket_width": 1e-6}),
    "pads, until it lies flat": (ON_PADS, PULSE, {**FEW_RUNS, "overturning": "continue"}),
}
RUN_OPTIONS = ("free_vibration", "initial", "accuracy", "overturning")


MODULE = import_module("rockframe.studies.critical_scale")  # `rf` has the function by that name


@pytest.fixture(scope="module")
def found():
    return {
        name: rf.critical_scale(system, motion, **options)
        for name, (system, motion, options) in CASES.items()
    }


def overturns(response):
    """Return whether a run overturned, under its option `overturning`."""
    lies_flat = response.status.flag_meanings.split().index("toppled")
    going_on = '"overturning": "continue"' in response.attrs["run_json"]
    return response.status.item() == lies_flat if going_on else bool(response.overturned)


def test_bracket_ends_have_the_reported_verdicts(found):
    flips = 0
    for name, (system, motion, options) in CASES.items():
        result, run_options = (
            found[name],
            {key: options[key] for key in RUN_OPTIONS if key in options},
        )
        for below, above, falls in zip(
            result.scale_below.values, result.scale_above.values, result.overturns_above.values,
            strict=True,
        ):  # fmt: skip
            assert above - below <= result.bracket_width * above
            for scale, expected in ((below, not falls), (above, falls)):
                run = system.simulate(
                    motion.scaled(scale), **run_options, outputs=None, second_look=False
                )
                assert overturns(run) == expected, (name, scale)
            flips += 1
        assert result.overturns_above[0].item()
        assert result.critical_scale.item() == result.scale_above[0].item()
    assert flips > len(CASES)


def test_every_tried_scale_is_reported(found):
    for name, (system, motion, options) in CASES.items():
        result, run_options = (
            found[name],
            {key: options[key] for key in RUN_OPTIONS if key in options},
        )
        assert (np.diff(result.scale) > 0.0).all()
        assert result.scale[-1].item() == 4.0
        for k in range(0, result.scale.size, 9):
            scale = result.scale[k].item()
            with warnings.catch_warnings():  # runs near a flip warn
                warnings.simplefilter("ignore", SolverWarning)
                run = system.simulate(motion.scaled(scale), **run_options, outputs=None)
            assert result.outcome[k].item() == int(overturns(run)), (name, scale)
            assert result.peak_rotation[k].item() == run.peak_rotation.item()
            assert result.status[k].item() == run.status.item()
        # flips lie between neighbours of different verdict
        assert np.count_nonzero(np.diff(result.outcome)) == result.flip.size


@pytest.mark.long
def test_a_mirrored_motion_gives_the_same_scales():
    for system in (RIGID, ON_PADS):
        one, other = (
            rf.critical_scale(system, motion, **FEW_RUNS)
            for motion in (SHAKING, SHAKING.scaled(-1.0))
        )
        xr.testing.assert_equal(one, other)


def test_critical_scale_search_starts_at_uplift_or_slip_scale(found):
    result = found["rigid ground"]
    acceleration = rf.intensity_measures(SHAKING, block=BLOCK).uplift_acceleration.item()
    peak = rf.intensity_measures(SHAKING).peak_ground_acceleration.item()
    assert result.uplift_scale.item() == pytest.approx(acceleration / peak, rel=1e-12)
    assert result.scale[0].item() == result.uplift_scale.item()
    assert result.peak_rotation[0].item() == pytest.approx(0.0, abs=1e-9)
    for name in CASES:
        if name != "rigid ground":
            assert np.isnan(found[name].uplift_scale)
            assert found[name].scale[0].item() == 0.0
    leaning = rf.critical_scale(
        RIGID, SHAKING, initial=rf.InitialState(rotation="0.01 rad"), **FEW_RUNS
    )
    lifted = rf.critical_scale(RIGID, SHAKING.with_vertical(SHAKING.scaled(0.5)), **FEW_RUNS)
    assert np.isnan([leaning.uplift_scale, lifted.uplift_scale]).all()
    # or the scale of first slip, by the friction of the ground less its slope
    for friction, slope in ((0.1, 0.0), (9.0, 0.0), (0.1, 0.02), (0.1, 0.2)):
        ground = rf.RigidGround(friction=friction, kinetic_friction=min(friction, 1.0))
        with pytest.warns(ModelWarning) if slope > friction else nullcontext():
            slides = rf.System(BLOCK, ground, inclination=f"{slope!r} rad")
        least = max(0.0, math.tan(math.atan(min(friction, 0.8 / 3.6)) - slope))
        either = slides.setting.onset_accelerations
        assert min(either) == pytest.approx(9.80665 * least, rel=1e-12)
    slippery = rf.System(BLOCK, rf.RigidGround(friction=0.1))
    slid = rf.critical_scale(slippery, SHAKING, **FEW_RUNS)
    assert slid.uplift_scale.item() == pytest.approx(0.1 * 9.80665 / peak, rel=1e-12)
    never = rf.critical_scale(RIGID, SHAKING, largest=0.5 * result.uplift_scale.item(), **FEW_RUNS)
    assert never.scale.size == 1


def test_a_block_that_never_overturns_has_no_critical_scale():
    result = rf.critical_scale(
        RIGID, PULSE, largest=1.0, intensity="peak_ground_acceleration", **FEW_RUNS
    )
    assert np.isnan(result.critical_scale)
    assert np.isnan(result.peak_ground_acceleration)
    assert result.peak_ground_acceleration.attrs["units"] == "m s^-2"
    assert result.flip.size == 0
    assert result.verdict == "Did not overturn up to 1 times the motion; 1 scale tried up to 1."


def test_block_overturning_without_motion_has_zero_critical_scale():
    start = rf.InitialState(angular_velocity="3 rad/s")
    result = rf.critical_scale(ON_PADS, PULSE, initial=start, **FEW_RUNS)
    assert result.critical_scale.item() == 0.0
    assert result.verdict.startswith("Overturns without the motion")


def test_cautions_about_scales_name_no_absent_ones():
    with pytest.warns(SolverWarning, match="still has the energy to overturn"):
        result = rf.critical_scale(RIGID, PULSE, scales=20, runs=20)
    assert result.cautions.startswith("critical_scale: at ")
    assert not result.cautions.endswith("none")


def test_unfinished_runs_have_no_verdict():
    limit = rf.Accuracy(rtol=1e-6, max_steps=400)
    options = {**FEW_RUNS, "accuracy": limit, "scales": 20, "runs": 20}
    with pytest.warns(SolverWarning, match="could not be finished") as caught:
        result = rf.critical_scale(RIGID, SHAKING, **options)
    assert caught[0].filename == __file__
    meanings = result.outcome.flag_meanings.split()
    undecided = result.outcome == meanings.index("undecided")
    assert undecided.any()
    assert (undecided == (result.status >= 3)).all()
    assert "no verdict" in result.verdict
    assert "could not be finished" in result.cautions
    assert result.followed_scale.item() <= result.scale.where(undecided).min().item()


@pytest.mark.long
def test_the_critical_scale_as_an_intensity(found):
    critical = found["soil, a pulse"].critical_scale.item()
    options = CASES["soil, a pulse"][2]
    powers = {"peak_ground_acceleration": 1, "arias_intensity": 2, "mean_period": 0}
    for name, power in powers.items():
        result = rf.critical_scale(ON_SOIL, PULSE, intensity=name, **options)
        one = rf.intensity_measures(PULSE)[name]
        assert result.critical_scale.item() == critical
        assert result[name].item() == pytest.approx(critical**power * one.item(), rel=1e-9)
        assert result[name].attrs == one.attrs
        assert result.intensity == name
        if name == "peak_ground_acceleration":
            short = rf.critical_scale(ON_SOIL, PULSE, intensity="PGA", **options)
            xr.testing.assert_identical(short.drop_attrs(), result.drop_attrs())
    name = "pseudo_spectral_acceleration"
    result = rf.critical_scale(
        ON_SOIL, PULSE, intensity=name, period="0.5 s", damping_ratio=0.02, **options
    )
    one = rf.response_spectrum(PULSE, ["0.5 s"], 0.02)[name].item()
    assert result[name].item() == pytest.approx(critical * one, rel=1e-9)
    assert (result.period.item(), result.damping_ratio.item()) == (0.5, 0.02)
    relative = "relative_peak_ground_acceleration"
    result = rf.critical_scale(ON_SOIL, PULSE, intensity=relative, **options)
    expected = rf.intensity_measures(PULSE.scaled(critical), block=BLOCK)[relative].item()
    assert result[relative].item() == expected


def test_critical_scale_dataset_survives_netcdf_round_trip(found, tmp_path):
    for result in found.values():
        result.to_netcdf(tmp_path / "critical.nc")
        with xr.open_dataset(tmp_path / "critical.nc") as again:
            xr.testing.assert_identical(again.load(), result)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RecordWarning)
                system = rf.System.from_dataset(again)
            assert system.assembly.to_dict() in [case[0].to_dict() for case in CASES.values()]
        assert result.Conventions == "CF-1.11"
        assert result.motion_sha256 in (SHAKING.sha256, PULSE.sha256)


def test_invalid_critical_scale_arguments_are_refused():
    wrong = [
        ({"largest": 0.0}, ComponentError, "largest must be greater than zero"),
        ({"largest": "4 m"}, UnitsError, "largest"),
        ({"scales": 1}, ComponentError, "scales must be a whole number from 2"),
        ({"scales": 50, "runs": 40}, ComponentError, "runs must be a whole number from 50"),
        ({"bracket_width": 0.0}, ComponentError, "bracket_width must be from 1e-12 to 0.1"),
        ({"intensity": "Sa(1.0)"}, ComponentError, r"write intensity='SA', period='1.0 s'"),
        ({"intensity": "Sa_avg(0.2)"}, ComponentError, "must be one of"),
        ({"intensity": "PGX"}, ComponentError, "must be one of .*peak_ground_acceleration"),
        ({"intensity": "uplift_acceleration"}, ComponentError, "must be one of"),
        ({"intensity": "spectral_displacement"}, ComponentError, "needs a period"),
        (
            {"intensity": "arias_intensity", "period": "1 s"},
            ComponentError,
            "'arias_intensity' has no period",
        ),
        ({"period": "1 s"}, ComponentError, "give intensity too"),
        ({"duration": "1 s", "free_vibration": "1 s"}, AssemblyError, "not both"),
        ({"overturning": "fall"}, AssemblyError, "overturning"),
        ({"accuracy": "best"}, SolverError, "accuracy"),
    ]
    for arguments, error, words in wrong:
        with pytest.raises(error, match=words):
            rf.critical_scale(RIGID, PULSE, **arguments)
    with pytest.raises(ComponentError, match="no motion to scale"):
        rf.critical_scale(RIGID)
    with pytest.raises(ComponentError, match="system needs a System"):
        rf.critical_scale(BLOCK, PULSE)


def test_interrupt_returns_completed_runs(monkeypatch):
    calls = itertools.count()

    def interrupted(*args):
        if next(calls) == 17:
            raise KeyboardInterrupt
        return compute_summary(*args)

    options = {"scales": 20, "runs": 30, "free_vibration": "5 s", "accuracy": "fast"}
    monkeypatch.setattr(MODULE, "compute_summary", interrupted)
    with pytest.warns(SolverWarning, match="critical_scale: interrupted; .*17 scales"):
        found = rf.critical_scale(ON_PADS, PULSE, **options)
    assert found.sizes["scale"] == 17
    assert found.followed_scale <= found.scale.max()
    assert "then interrupted. Beyond 0.2105 some are more than 1 % apart" in found.verdict
    monkeypatch.undo()
    complete = rf.critical_scale(ON_PADS, PULSE, **options)
    same = complete.sel(scale=found.scale)
    np.testing.assert_array_equal(found.peak_rotation, same.peak_rotation)
