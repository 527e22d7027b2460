"""Studies check whether a base would slide, as single runs do."""

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.compiled import COMPILED
from rockframe.errors import ModelWarning
from rockframe.studies.sweeps import study

BLOCK = rf.Block(width="0.6 m", height="1.8 m", mass="180 kg")
SLIPPERY = rf.System(BLOCK, rf.RigidGround(friction=0.2), sliding="checked")
ROUGH = rf.System(BLOCK, rf.RigidGround(friction=10), sliding="checked")
PULSE = rf.GroundMotion.sine_pulse("4 m/s^2", "1.2 Hz")
SLIDES = "the block would slide from"


def messages_of(runs):
    """Return the message of each case."""
    return runs.message.to_numpy().squeeze()


def test_friction_warning_does_not_depend_on_histories():
    with pytest.warns(ModelWarning, match=f"{SLIDES} .* has 0.2, ") as caught:
        run = SLIPPERY.simulate(PULSE, free_vibration="3 s")
    with pytest.warns(ModelWarning, match=f"{SLIDES} .* has 0.2, ") as again:
        bare = SLIPPERY.simulate(PULSE, free_vibration="3 s", outputs=None)
    assert [str(one.message) for one in again] == [str(one.message) for one in caught]
    assert bare.attrs["cautions"] == run.attrs["cautions"]
    assert bare.peak_friction_demand.item() == run.peak_friction_demand.item()
    assert "time" not in bare.sizes
    without = rf.System(BLOCK).simulate(PULSE, free_vibration="3 s", outputs=None)
    assert "peak_friction_demand" not in without
    for name in without.data_vars:
        np.testing.assert_array_equal(bare[name], without[name])


@pytest.mark.parametrize(
    "base",
    [
        rf.RigidGround(friction=0.2),
        rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1, friction=0.2),
        rf.WinklerSoil(stiffness="6 MPa", damping_ratio=0.2, friction=0.2),
    ],
)
def test_sweep_cases_report_the_friction_of_single_runs(base):
    system = rf.System(BLOCK, base, sliding="checked")
    frictions = [0.1, 0.5, 10.0]
    most = f"({SLIDES}|the run ends while)"  # on soil more cases end in motion than would slide
    with pytest.warns(ModelWarning, match=f"cases have a result to be careful with.*{most}"):
        runs = rf.sweep(system, PULSE, friction=frictions, scale=[0.5, 1.0], accuracy="standard")
    for (scale, friction), text in zip(
        [(scale, friction) for friction in frictions for scale in (0.5, 1.0)],
        messages_of(runs.transpose("friction", "scale", ...)).ravel(),
        strict=True,
    ):
        case = rf.case(runs, friction=friction, scale=scale)
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("rockframe.simulation.run.warn", lambda *_: None)
            alone = case.simulate()
        assert alone.attrs["cautions"] == text
        peak = runs.peak_friction_demand.sel(friction=friction, scale=scale).item()
        assert alone.peak_friction_demand.item() == peak
        assert (peak > friction) == (SLIDES in text)
        for name in ("would_slide", "sliding_time", "sliding_duration"):
            found = runs[name].sel(friction=friction, scale=scale).squeeze()
            np.testing.assert_array_equal(found, alone[name])
        assert runs.would_slide.sel(friction=friction, scale=scale).item() == (peak > friction)
    slide = int(runs.would_slide.sum())
    assert 0 < slide < 6
    assert f"; {slide} would slide and {6 - slide} would not" in runs.attrs["verdict"]
    assert rf.table(runs).would_slide.sum() == slide


@pytest.mark.wide
@pytest.mark.skipif(not COMPILED, reason="lanes are compiled")
@pytest.mark.parametrize("accuracy", ["fast", "screen"])
def test_friction_limited_cases_run_outside_lanes(monkeypatch, accuracy):
    def scene(slippery):
        return SLIPPERY if slippery else rf.System(BLOCK)

    found = []
    monkeypatch.setattr(study, "COMPILING_SHARE", np.inf)
    for fewest in (1, 10**9):
        monkeypatch.setattr(study, "MIN_CASES_IN_LANES", fewest)
        with pytest.warns(ModelWarning, match=SLIDES):
            runs = rf.sweep(
                scene, PULSE, slippery=[False, True], scale=[0.1, 0.5, 1.0, 3.0], accuracy=accuracy
            )
        found.append(runs)
    lanes, alone = found
    assert lanes.drop_attrs().identical(alone.drop_attrs())
    held, free = (lanes.sel(slippery=one) for one in (True, False))
    assert [SLIDES in text for text in messages_of(held)] == [False, True, True, True]
    assert (free.message == "none").all()
    np.testing.assert_array_equal(held.peak_rotation, free.peak_rotation)


def test_analyses_count_the_runs_that_would_slide():
    scales = [0.3, 0.5, 1.0, 1.6]
    ignored = pytest.warns(ModelWarning, match=SLIDES)
    with ignored:
        runs = rf.sweep(SLIPPERY, PULSE, scale=scales, accuracy="standard")
        analysis = rf.incremental_dynamic_analysis(SLIPPERY, PULSE, scale=scales)
    slide = int(runs.would_slide.sum())
    assert 0 < slide < 4
    words = f"n {slide} of 4 runs"
    assert f"; i{words} of the scan the block would slide first." in analysis.attrs["verdict"]
    ending = "the block would slide first; these count as if it were held."
    assert f" I{words} {ending}" in rf.fragility(runs).attrs["verdict"]
    capacities = rf.fragility(analysis, trials="capacities")
    assert f" I{words} of the scan {ending}" in capacities.attrs["verdict"]
    held = rf.critical_scale(ROUGH, PULSE, largest=1.6, scales=20, runs=40)
    assert f"; in none of {held.scale.size} runs the block" in held.attrs["verdict"]
    needed = rf.sweep(ROUGH, PULSE, scale=held.scale.values).peak_friction_demand
    friction = float(needed.median())
    slide = int((needed > friction).sum())
    assert 0 < slide < held.scale.size
    base = rf.RigidGround(friction=friction)
    checked = rf.System(BLOCK, base, sliding="checked")
    with ignored:
        found = rf.critical_scale(checked, PULSE, largest=1.6, scales=20, runs=40)
    words = f"; in {slide} of {held.scale.size} runs the block would slide first."
    assert words in found.attrs["verdict"]
    free = rf.critical_scale(rf.System(BLOCK), PULSE, largest=1.6, scales=20, runs=40)
    assert "slide" not in free.attrs["verdict"]
    xr.testing.assert_identical(free.scale, found.scale)
    xr.testing.assert_identical(free.peak_rotation, found.peak_rotation)


def test_analyses_warn_of_sliding():
    with pytest.warns(ModelWarning, match=SLIDES):
        rf.incremental_dynamic_analysis(SLIPPERY, PULSE, scale=[0.5, 1.0])
    with pytest.warns(ModelWarning, match=SLIDES):
        found = rf.critical_scale(SLIPPERY, PULSE, scales=20, runs=40)
    assert SLIDES in found.attrs["cautions"]
    with pytest.warns(ModelWarning, match=SLIDES):
        found = rf.critical_scale(SLIPPERY, PULSE, largest=0.9, scales=20, runs=40)
    assert np.isnan(found.critical_scale)
    assert SLIDES in found.attrs["cautions"]
    found = rf.critical_scale(rf.System(BLOCK), PULSE, largest=0.9, scales=20, runs=40)
    assert "cautions" not in found.attrs


def test_analyses_report_slip_over_tried_scales():
    """A block that slides instead of rocking stands at any scale; its slip is reported."""
    low = rf.Block(width="1 m", height="2 m", mass="1 t")
    slides = rf.System(low, rf.RigidGround(friction=0.2))
    pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    how = {"accuracy": "fast", "progress": False}
    scales = [0.5, 1.0, 1.5, 2.0]
    farthest = float(rf.sweep(slides, pulse, scale=scales, **how).peak_slip.max())
    words = f"a body slid, by {farthest:.3g} m at most."
    analysis = rf.incremental_dynamic_analysis(slides, [pulse], scale=scales, resolution=1, **how)
    assert f"; in 3 of 4 runs of the scan {words}" in analysis.verdict
    found = rf.critical_scale(slides, pulse, largest=2, scales=5, runs=5, **how)
    assert float(found.uplift_scale) == pytest.approx(0.2 * 9.80665 / 2.5)  # from slip on
    assert f"; in 4 of 5 runs {words}" in found.verdict
