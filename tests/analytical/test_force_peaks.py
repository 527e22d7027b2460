"""Peaks of forces do not depend on where samples are."""

import numpy as np
import pytest

import rockframe as rf

BLOCK = rf.Block(width="1 m", height="4 m", mass="10 t")
PADS = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.1)
SOIL = rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0.2)
CAP = rf.CushionCap(height="0.6 m", mass="6 t", width="1.4 m")
SCENES = {
    "rigid ground": rf.System(BLOCK),
    "pads": rf.System(BLOCK, PADS),
    "bed": rf.System(BLOCK, SOIL),
    "stack": rf.System(BLOCK, PADS, CAP, SOIL),
    "cascade": rf.System(BLOCK, PADS, CAP, SOIL, coupling="cascade"),
    "inclined": rf.System(BLOCK, PADS, inclination="2 deg"),
}
PULSE = rf.GroundMotion.sine_pulse("4 m/s^2", "1.5 Hz").resampled("20 ms")
TOP = {"top": ("0.5 m", "4 m"), "base": ("0 m", "0 m")}
PEAKS = ("peak_base_shear", "peak_friction_demand", "peak_point_horizontal_acceleration",
         "peak_point_vertical_acceleration", "peak_point_vertical_displacement")  # fmt: skip
STEPS = ("1 ms", "5 ms", "20 ms")


@pytest.fixture(scope="module", params=SCENES)
def scene(request):
    return SCENES[request.param]


@pytest.mark.parametrize("accuracy", ["standard", pytest.param("fast", marks=pytest.mark.long)])
def test_peaks_do_not_depend_on_the_output_step(scene, accuracy):
    runs = [
        scene.simulate(
            PULSE, duration="1.5 s", output_step=step, points=TOP, accuracy=accuracy,
            overturning="continue",
        )
        for step in STEPS
    ]  # fmt: skip
    for name in PEAKS:
        first, *others = (run[name].values for run in runs)
        for other in others:
            np.testing.assert_array_equal(other, first)


@pytest.mark.parametrize("accuracy", ["standard", pytest.param("fast", marks=pytest.mark.long)])
def test_force_peaks_match_finely_sampled_histories(scene, accuracy):
    run = scene.simulate(
        PULSE, duration="1.5 s", output_step="0.05 ms", points=TOP, accuracy=accuracy,
        outputs=("friction_demand",),
    )  # fmt: skip
    for name in PEAKS:
        history = run[{"peak_friction_demand": "friction_demand"}.get(name, name[5:])]
        sampled, peaks = np.abs(history).max("time").values, run[name].values
        finite = np.isfinite(peaks)
        assert (peaks >= (1.0 - 1e-5) * sampled).all(), name
        # near a pole samples miss the peak
        if name != "peak_friction_demand" or (sampled < 2.0).all():
            assert (peaks <= (1.0 + 1e-3) * sampled)[finite].all(), (name, peaks, sampled)


def test_sweep_peaks_equal_single_run_peaks_for_any_output_step():
    runs = [
        rf.sweep(
            SCENES["pads"], PULSE, scale=[0.6, 1.0], points=TOP, duration="1.5 s",
            output_step=step, outputs=outputs,
        ).squeeze("motion")
        for step in STEPS for outputs in (None, ("base_shear",))
    ]  # fmt: skip
    for scale in (0.6, 1.0):
        alone = SCENES["pads"].simulate(PULSE.scaled(scale), duration="1.5 s", points=TOP)
        for name in PEAKS:
            for run in runs:
                np.testing.assert_array_equal(run[name].sel(scale=scale), alone[name])


def test_force_peak_just_before_end_of_ground_step_is_found():
    """The ground has a step between samples: the force is largest just before it ends."""
    hold = rf.GroundMotion.from_arrays(([0.0, 1.0, 1.0, 1.0], "m/s^2"), "50 ms")
    run = rf.System(BLOCK).simulate(hold, duration="1 s", output_step="0.4 s")
    assert run.peak_base_shear == pytest.approx(1e4, rel=1e-12)
    assert run.peak_friction_demand == pytest.approx(1.0 / 9.80665, rel=1e-12)


def test_step_table_growth_does_not_change_results(monkeypatch):
    unlimited = SCENES["pads"].simulate(PULSE, duration="1.5 s", points=TOP)
    monkeypatch.setattr("rockframe.solve.integrate.STEP_ROWS", 1)
    monkeypatch.setattr("rockframe.solve.integrate.STEPS_PER_INTERVAL", 0.0)
    grown = SCENES["pads"].simulate(PULSE, duration="1.5 s", points=TOP)
    assert grown.drop_attrs().identical(unlimited.drop_attrs())


@pytest.mark.wide
@pytest.mark.parametrize("base", [PADS, SOIL], ids=["pads", "bed"])
def test_force_peaks_of_held_base_do_not_depend_on_friction(base):
    """A base that never slips has the forces of a held one, for any friction."""

    def peaks(friction):
        system = rf.System(BLOCK, base.replace(friction=friction))
        run = system.simulate(PULSE, duration="1.5 s", points=TOP, outputs=None)
        return [float(np.max(run[name])) for name in PEAKS]

    held = peaks(None)
    for friction in (0.5, 4.0):
        assert peaks(friction) == pytest.approx(held, rel=2e-4)
