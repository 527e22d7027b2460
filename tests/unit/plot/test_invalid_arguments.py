"""Error messages for invalid arguments of plot functions."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.errors import ComponentError, SchemaError

PULSE = rf.GroundMotion.sine_pulse("2 m/s^2", "2 Hz")
BLOCK = rf.Block(width="1 m", height="6 m", mass="10 t")
SYSTEM = rf.System(BLOCK, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1))
TARGET = rf.TargetSpectrum.eurocode_8("0.2 g_0")

ARGUMENTS = {
    "run": lambda: SYSTEM.simulate(PULSE),
    "bare run": lambda: SYSTEM.simulate(PULSE, outputs=None),
    "sweep": lambda: rf.sweep(SYSTEM, PULSE, scale=[1.0, 2.0]),
    "rungs": lambda: rf.tradeoff(
        SYSTEM, PULSE, models=["two pads"], accuracies=["fast"], repeats=1
    ),
    "response spectra": lambda: rf.response_spectrum(PULSE, (["0.1", "1"], "s")),
    "Fourier spectrum": lambda: rf.fourier_spectrum(PULSE),
    "ground": lambda: rf.measures.velocity_and_displacement(PULSE),
    "measures": lambda: rf.intensity_measures(PULSE),
    "set": lambda: rf.MotionSuite({"pulse": PULSE}).scaling_to(TARGET, bounds=None),
    "rest": SYSTEM.equilibrium,
    "rotation": lambda: SYSTEM.simulate(PULSE)["rotation"],
    "nothing": xr.Dataset,
    "motion": lambda: PULSE,
    "system": lambda: SYSTEM,
    "file": lambda: "run.nc",
    "path": lambda: Path("run.nc"),
    "None": lambda: None,
    "numbers": lambda: [1.0, 2.0],
}
WORDS = {
    "run": ("a Dataset with the result of a run", "rf.plot.response draws it"),
    "bare run": ("the result of a run without histories", "outputs=() instead of None"),
    "sweep": ("a Dataset with many runs", "rf.plot.sweep draws it"),
    "rungs": ("a Dataset with a comparison of models", "rf.plot.tradeoff draws it"),
    "response spectra": ("a Dataset with response spectra", "rf.plot.spectra draws them from"),
    "Fourier spectrum": ("a Dataset with a Fourier spectrum", "rf.plot.spectra draws it from"),
    "ground": ("velocity and displacement of the ground", "rf.plot.motion draws them from"),
    "measures": ("a Dataset with the title 'Intensity measures'",),
    "set": ("a Dataset with a set of motions and", "rf.plot.selection draws it"),
    "rest": ("a Dataset with the title 'Rest'",),
    "rotation": ("a DataArray, 'rotation'", "the whole Dataset"),
    "nothing": ("a Dataset of another kind",),
    "motion": ("a GroundMotion, 'sine", "rf.plot.motion and rf.plot.spectra draw it"),
    "system": ("a System", "rf.plot.response(system.simulate(motion))"),
    "file": ("got 'run.nc'", "open the file first"),
    "path": ("got 'run.nc'", "open the file first"),
    "None": ("got None",),
    "numbers": ("a value of type list",),
}
PLOTS = {
    "response": (rf.plot.response, "run", "the result of one run with histories", SchemaError),
    "selection": (rf.plot.selection, "set", "a set of motions and its target", SchemaError),
    "tradeoff": (rf.plot.tradeoff, "rungs", "a comparison of models", SchemaError),
    "motion": (rf.plot.motion, "motion", "a GroundMotion", ComponentError),
    "spectra": (rf.plot.spectra, "motion", "a GroundMotion", ComponentError),
}


@pytest.fixture(scope="module")
def arguments():
    return {name: make() for name, make in ARGUMENTS.items()}


@pytest.mark.parametrize("name", PLOTS)
def test_error_names_the_argument_and_the_matching_plot_function(name, arguments):
    draw, accepted, needed, error = PLOTS[name]
    for kind in ARGUMENTS:
        if kind == accepted:
            draw(arguments[kind])
            continue
        with pytest.raises(error) as caught:
            draw(arguments[kind])
        message = str(caught.value)
        assert message.startswith(f"rf.plot.{name} needs {needed}"), kind
        for words in WORDS[kind]:
            assert words in message, kind
        assert "\n" not in message
        assert len(message) < 250


def test_sweep_of_two_axes_and_one_motion_is_plotted():
    system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    pulse = rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz")
    runs = rf.sweep(system, pulse, scale=[1.0, 2.0, 3.0], height=["3 m", "4 m"], accuracy="fast")
    assert runs.peak_rotation.ndim == 3
    axes = rf.plot.sweep(runs, "peak_rotation")
    assert len(axes.get_lines()) >= 2
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [
        "height 3 m",
        "height 4 m",
    ]
    several = xr.concat([runs, runs.assign_coords(motion=["other"])], "motion", data_vars="all")
    with pytest.raises(SchemaError, match=r"has 3 .*isel"):
        rf.plot.sweep(several, "peak_rotation")


def test_error_for_a_path_suggests_the_reader():
    with pytest.raises(SchemaError, match=r"rf\.plot\.response\(xr\.open_dataset\('run\.nc'\)\)"):
        rf.plot.response("run.nc")
    with pytest.raises(ComponentError, match=r"rf\.plot\.motion\(rf\.GroundMotion\.read\('a'\)\)"):
        rf.plot.motion("a")


def test_reopened_run_is_plotted(arguments, tmp_path):
    for name, draw in (("run", rf.plot.response), ("rungs", rf.plot.tradeoff)):
        arguments[name].to_netcdf(tmp_path / "stored.nc")
        with xr.open_dataset(tmp_path / "stored.nc") as stored:
            draw(stored)


def test_response_requires_a_single_complete_run(arguments):
    both = xr.concat([arguments["run"], arguments["run"]], "scale", data_vars="all")
    with pytest.raises(SchemaError, match=r"several runs over scale; .* dataset\.isel\(scale=0\)"):
        rf.plot.response(both)
    rf.plot.response(both.isel(scale=0))
    with pytest.raises(SchemaError, match="got one of a single instant; simulate for longer"):
        rf.plot.response(SYSTEM.simulate(duration="1e-9 s"))
    with pytest.raises(SchemaError, match="lacks 'contact_state', 'uplift_angle'"):
        rf.plot.response(arguments["run"].drop_vars(["uplift_angle", "contact_state"]))
    with pytest.raises(SchemaError, match=r"rf\.plot\.tradeoff needs .* lacks 'history_error'"):
        rf.plot.tradeoff(arguments["rungs"].drop_vars("history_error"))


def test_a_window_outside_the_motion_is_refused():
    """It ended in an error of an empty sequence, or in a figure without the history."""
    for motions in (PULSE, [PULSE, PULSE.scaled(2.0)]):
        for draw in (rf.plot.motion, rf.plot.spectra):
            with pytest.raises(ComponentError, match=r"the window holds 0 of the motion's samples"):
                draw(motions, window=("100 s", None))


def test_damaged_descriptions_in_a_dataset_are_named(arguments, tmp_path):
    """They ended in an error of Python's reader of JSON."""
    run = arguments["run"]
    with pytest.raises(SchemaError, match=r"rf\.plot\.state: .*'system_json'.* is damaged"):
        rf.plot.state(run.assign_attrs(system_json="{"))
    assert "overturn" in run.assign_attrs(system_json="{").rockframe._repr_html_()
    with pytest.raises(SchemaError, match=r"report: .*'project_json' is damaged"):
        rf.report(run.assign_attrs(project_json="{"), tmp_path / "r.html")


def test_spectra_of_a_set_have_one_damping_ratio_and_a_period():
    """Several ratios, and no period but zero, ended in errors of other libraries."""
    with pytest.raises(ComponentError, match=r"damping_ratio must be one number, got \[0\.02"):
        rf.plot.suite([PULSE], damping_ratio=[0.02, 0.05])
    with pytest.raises(ComponentError, match=r"suite: found no period above zero"):
        rf.plot.suite([PULSE], ["0 s"])


def test_a_target_of_another_damping_ratio_is_labelled_with_it():
    """It stood beside spectra of 5 % as if it were of the same damping."""
    words = {}
    for ratio in (0.05, 0.08):
        target = rf.TargetSpectrum.eurocode_8("0.2 g_0", damping_ratio=ratio)
        words[ratio] = rf.plot.suite([PULSE], target=target).get_legend_handles_labels()[1][-1]
    assert words == {0.05: "target", 0.08: "target, 8 % damping"}


def test_a_panel_given_twice_is_refused(arguments):
    """The first of the two remained empty."""
    with pytest.raises(ComponentError, match=r"each once, got \('rotation', 'rotation'\)"):
        rf.plot.response(arguments["run"], panels=("rotation", "rotation"))


def test_converted_histories_are_plotted_in_their_unit():
    """Rotations in degrees are not divided by an overturning angle in radians."""
    system = rf.System(rf.Block(width="0.6 m", height="2 m", mass="400 kg"))
    run = system.simulate(rf.GroundMotion.sine_pulse("-4 m/s^2", "1.5 Hz"), free_vibration="1 s")
    converted = run.assign(rotation=np.rad2deg(run.rotation).assign_attrs(units="deg"))
    converted = converted.assign_coords(time=("time", 1000 * run.time.values, {"units": "ms"}))
    plotted = [
        rf.plot.response(dataset, panels="rotation").figure.axes[0].lines[0].get_xydata()
        for dataset in (converted, run)
    ]
    np.testing.assert_allclose(*plotted, rtol=1e-12, atol=1e-15)
