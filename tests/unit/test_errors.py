"""How messages show values, and how errors are raised and pickled."""

import copy
import pickle
import subprocess
import sys
import traceback

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe import errors
from rockframe.errors import (
    MAX_SHOWN_LENGTH,
    AssemblyError,
    FileError,
    RecordError,
    RockframeError,
    StudyError,
    short_repr,
)

pytestmark = pytest.mark.unit


@pytest.mark.parametrize("value", [4, "4 m", None, [1, 2], np.array([0.1]), rf.Block, 1j])
def test_short_values_are_shown_by_repr(value):
    assert short_repr(value) == repr(value)


@pytest.mark.parametrize("value", [list(range(5000)), "m" * 5000, dict.fromkeys(range(5000))])
def test_long_values_are_cut(value):
    assert len(short_repr(value)) == MAX_SHOWN_LENGTH
    assert short_repr(value).endswith("...")
    assert short_repr(value)[:20] == repr(value)[:20]


def test_arrays_and_datasets_are_shown_by_their_type():
    assert short_repr(np.linspace(0.0, 1.0, 5000)) == "a ndarray of shape (5000,)"
    assert short_repr(xr.DataArray(np.zeros(3), dims="x")) == "a DataArray of shape (3,)"
    assert short_repr(rf.GroundMotion.sine_pulse().to_dataset()) == "a Dataset"


@pytest.mark.parametrize(
    "call",
    [
        lambda long: rf.intensity_measures(long),
        lambda long: rf.System(long),
        lambda long: rf.System(rf.Block(width="2 m", height="8 m", mass="4 t"), rotation=long),
        lambda long: rf.Block(width=long, height="8 m", mass="4 t"),
        lambda long: rf.Block(width="2 m", height="8 m", mass="4 t", shape_factor=long),
        lambda long: rf.response_spectrum(rf.GroundMotion.sine_pulse(), damping_ratios=long),
        lambda long: rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.1, separation=long),
        lambda long: rf.GroundMotion.from_arrays(str(long), "0.01 s"),
        lambda long: rf.GroundMotion.sine_pulse().baseline_corrected(order=long),
    ],
)
def test_messages_truncate_long_values(call):
    with pytest.raises(RockframeError) as caught:
        call([0.05] * 5000)
    assert max(len(line) for line in str(caught.value).splitlines()) < 4 * MAX_SHOWN_LENGTH


OF_MANY_FAULTS = {
    AssemblyError: lambda: AssemblyError(["no block", "two pads"], ["block", "block, pads"]),
    RecordError: lambda: RecordError("a.AT2", found="a word", expected="a number", line=3),
    FileError: lambda: FileError("a.toml", [(None, "empty"), (3, "no unit")]),
    StudyError: lambda: StudyError("no axis", "no motion"),
}


@pytest.mark.parametrize("again", [lambda one: pickle.loads(pickle.dumps(one)), copy.copy])  # noqa: S301
@pytest.mark.parametrize("kind", [getattr(errors, name) for name in dir(errors)])
def test_errors_survive_pickling_and_copying(kind, again):
    error = OF_MANY_FAULTS.get(kind, lambda: kind("out of range"))()
    other = again(error)
    assert type(other) is kind
    assert str(other) == str(error)
    assert other.args == error.args
    assert vars(other) == vars(error)


class Console:
    """A substitute for IPython, which takes the traceback of an error and renders it."""

    InteractiveTB = None

    def get_ipython(self):
        return self

    def structured_traceback(self, kind, error, trace):
        assert error.__cause__ is None  # it would be rendered too, with its lines
        assert error.__context__ is None
        return [kind.__name__, *(name for _, _, name, _ in traceback.extract_tb(trace))]


@pytest.mark.parametrize(
    "misuse",
    [
        lambda: rf.Block(width="0.8 m", height="4", mass="2 t"),
        lambda: rf.System(rf.RigidGround()),
        lambda: rf.plot.response(3),
        lambda: rf.GroundMotion.read("nowhere.AT2"),
        lambda: rf.System.from_dict({"parts": [{"type": "Block", "widht": 3}]}),
        lambda: rf.Block(widht="0.8 m"),
        lambda: rf.sweep(),
        lambda: rf.plot.respones,
        lambda: rf.GroundMotion.sine_puls(),
        lambda: rf.MotionSuite([rf.GroundMotion.sine_pulse()])["none"],
    ],
    ids=[
        "units",
        "assembly",
        "figure",
        "file",
        "cause",
        "argument",
        "call",
        "module",
        "class",
        "label",
    ],
)
def test_notebooks_show_the_line_that_was_wrong_and_no_other(misuse, monkeypatch):
    console = Console()
    console.InteractiveTB = console
    monkeypatch.setitem(sys.modules, "IPython", console)
    with pytest.raises(RockframeError) as caught:
        misuse()
    this_test = "test_notebooks_show_the_line_that_was_wrong_and_no_other"
    name, *frames = caught.value._render_traceback_()
    assert name == caught.type.__name__
    assert frames == [this_test, "<lambda>"]
    traceback_names = [one.name for one in caught.traceback]
    assert len(traceback_names) > 2  # the complete traceback is still available


def test_ipython_shows_only_the_wrong_line():
    pytest.importorskip("IPython", reason="IPython is not installed")
    code = """
from IPython.core.interactiveshell import InteractiveShell
shell = InteractiveShell.instance(colors="nocolor")
shell.run_cell("import rockframe as rf")
shell.run_cell("rf.Block(width='0.8 m', height='4', mass='2 t')")
"""
    ran = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=120
    )
    assert "needs a length" in ran.stdout
    assert "rf.Block(width" in ran.stdout
    assert "reading.py" not in ran.stdout
    assert ran.stdout.count("Cell") + ran.stdout.count("<ipython-input") == 1


@pytest.mark.parametrize("dim", ["motion", "Block.mass"])
def test_the_way_to_pick_a_value_is_valid_for_every_dimension(dim):
    runs = xr.Dataset({"peak": ((dim, "scale"), [[1.0, 2.0], [3.0, 4.0]])})
    picked = eval(errors.first_along("runs", dim), {"runs": runs})  # noqa: S307
    assert picked["peak"].values.tolist() == [1.0, 2.0]


def test_messages_on_several_structures_pick_one_by_valid_code():
    block = rf.Block(width="0.25 m", height="1 m", mass="100 kg")
    runs = rf.sweep(
        rf.System(block),
        rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz"),
        axes={"Block.height": ["0.9 m", "1 m"]},
        scale=[1, 2],
        width=["0.2 m", "0.3 m"],
        progress=False,
    )
    found = rf.fragility(runs, "PGA", limits=[])
    with pytest.raises(errors.ComponentError, match=r"fragility\.isel\(\{'Block\.height': 0\}\)"):
        rf.export.to_pelicun(found, "block", demand="Peak Ground Acceleration")
    with pytest.raises(errors.SchemaError, match=r"rf\.case gives a single case"):
        rf.plot.sweep(runs.isel({"Block.height": 0, "scale": 0, "width": 0, "motion": 0}))
