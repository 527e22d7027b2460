"""Invalid values of any type are refused with errors of rockframe."""

import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import rockframe as rf
from rockframe.command.files.templates import TEMPLATES
from rockframe.command.main import main
from rockframe.errors import RockframeError

pytestmark = pytest.mark.unit
BLOCK = rf.Block(width="0.8 m", height="4 m", mass="2 t")
SYSTEM = rf.System(BLOCK)
PULSE = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
RECORD = rf.GroundMotion.from_arrays(([0.0, 1.0, 0.0] * 20, "m/s^2"), "0.01 s", name="record")
NOTHING = (object(), [None], {"a": None}, 1j, b"x", pd.DataFrame(), lambda: 0, 10**400)
"""What no argument can be."""
NUMBERS_OF = xr.Dataset({"a": ("x", [1.0, 2.0])})
TEXTS = (3, *NOTHING)
NUMBERS = ("x", "", float("nan"), "nan m", *NOTHING)


@pytest.fixture(scope="module")
def run():
    return SYSTEM.simulate(PULSE, accuracy="fast")


@pytest.fixture(scope="module")
def runs():
    return rf.sweep(SYSTEM, PULSE, scale=[0.5, 1.0], accuracy="fast", progress=False)


def swept(**arguments):
    return rf.sweep(SYSTEM, PULSE, progress=False, **arguments)


MISUSES = {
    "width": (lambda v: rf.Block(width=v, height="4 m", mass="2 t"), NUMBERS),
    "shape factor": (
        lambda v: rf.Block(width="1 m", height="4 m", mass="2 t", shape_factor=v), NUMBERS
    ),
    "parts": (lambda v: rf.System(BLOCK, v), (None, 3, "x", *NOTHING)),
    "option": (lambda v: rf.System(BLOCK, rotation=v), (None, *TEXTS)),
    "inclination": (lambda v: rf.System(BLOCK, inclination=v), NUMBERS),
    "motion": (lambda v: SYSTEM.simulate(v), ("x", 3, *NOTHING)),
    "duration": (lambda v: SYSTEM.simulate(PULSE, duration=v), (3, *NUMBERS)),
    "outputs": (lambda v: SYSTEM.simulate(PULSE, outputs=v), (3, "x", [3], object(), 1j, 10**400)),
    "points": (lambda v: SYSTEM.simulate(PULSE, points=v), (3, "x", [3], {3: 3}, {"a": 3}, 1j)),
    "accuracy": (lambda v: SYSTEM.simulate(PULSE, accuracy=v), (None, *NUMBERS)),
    "initial": (lambda v: SYSTEM.simulate(PULSE, initial=v), (3, "x", *NOTHING)),
    "certify": (lambda v: SYSTEM.simulate(PULSE, certify=v), (3, "x", *NOTHING)),
    "tolerance": (lambda v: rf.Accuracy(rtol=v), (None, *NUMBERS)),
    "steps": (lambda v: rf.Accuracy(substeps=v), (None, 1.5, *NUMBERS)),
    "axes": (lambda v: swept(axes=v), (3, "x", [None], {"nope": [1]}, {3: [1]}, *NOTHING)),
    "unit of an axis": (lambda v: swept(width=([1.0], v)), (3, "s", "", *NOTHING)),
    "values of an axis": (
        lambda v: swept(width=(v, "m")),
        (["a"], [None], [True], [1j], [[1, 2]], ["1 m"], [object()], [10**400], [float("nan")]),
    ),
    "scale": (lambda v: swept(scale=v), ("x", ["a"], [[1]], {"a": 1}, *NOTHING)),
    "cases": (
        lambda v: swept(cases=v),
        (
            3, "x", [1], [{"scale": 1}], {3: [1]}, {"scale": None}, {"scale": "x"},
            {"scale": ["x"]}, {"scale": [[1]]}, {"scale": [1, 2], "width": ["1 m"]},
            {"width [m]": ["1 m"]},
            {"width [m]": [None]}, {"width [m]": [True]}, {"width [m]": [1j]},
            {"width [m]": [[1, 2]]},
            {"width [s]": [1]}, {"motion": ["none"]}, {"": [1]}, pd.Series([1.0]),
            pd.DataFrame({3: [1.0]}), pd.DataFrame([[1.0, 2.0]], columns=["scale", "scale"]),
            *NOTHING,
        ),
    ),
    "motions": (lambda v: rf.sweep(SYSTEM, v, scale=[1.0], progress=False), ("x", 3, *NOTHING)),
    "scene": (lambda v: rf.sweep(v, PULSE, scale=[1.0], progress=False), (3, "x", object(), 1j)),
    "samples": (
        lambda v: rf.GroundMotion.from_arrays(v, "0.01 s"),
        (3, "x", ([1, "a"], "m/s^2"), ([1, 2], 3), ([[1, 2]], "m/s^2"), ([], "m/s^2"), *NOTHING),
    ),
    "name": (lambda v: rf.GroundMotion.from_arrays(([0.0, 1.0], "m/s^2"), "0.01 s", name=v), TEXTS),
    "time step": (lambda v: rf.GroundMotion.from_arrays(([0.0, 1.0], "m/s^2"), v), (3, *NUMBERS)),
    "magnitude": (lambda v: rf.GroundMotion.stochastic(v, "5 km", seed=1), NUMBERS),
    "factor": (lambda v: PULSE.scaled(v), NUMBERS),
    "window": (lambda v: PULSE.window(v, "1 s"), (3, *NUMBERS)),
    "vertical": (lambda v: RECORD.with_vertical(v), (3, "x", *NOTHING)),
    "file": (lambda v: rf.GroundMotion.read(v), (None, 3, "none", "", "a\0b", *NOTHING)),
    "a motion described": (
        rf.GroundMotion.from_dict,
        (None, 3, "x", {}, {"constructor": 3}, {"constructor": []}, *NOTHING),
    ),
    "a system described": (
        rf.System.from_dict,
        (None, 3, "x", {}, {"parts": 3}, {"parts": [3]}, {"parts": [{}]}, *NOTHING),
    ),
    "AT2": (lambda v: RECORD.to_at2(v), (None, 3, "", "x.txt", "none/x.AT2", "a\0.AT2", *NOTHING)),
    "suite": (lambda v: rf.read_suite(v), (None, 3, "none", *NOTHING)),
    "measures": (lambda v: rf.intensity_measures(v), (None, 3, "x", *NOTHING)),
    "periods": (lambda v: rf.response_spectrum(PULSE, periods=v), (3, "x", *NOTHING)),
    "table": (rf.table, (None, 3, "x", *NOTHING)),
    "concat": (rf.concat, (None, 3, "x", [], [3], *NOTHING)),
    "case": (rf.case, (None, 3, "none", xr.Dataset(), *NOTHING)),
    "study": (rf.open_study, (None, 3, "none", *NOTHING)),
    "fragility": (rf.fragility, (None, 3, "x", xr.Dataset(), *NOTHING)),
    "critical scale": (
        lambda v: rf.critical_scale(SYSTEM, v, progress=False), (None, 3, "x", *NOTHING)
    ),
    "figure": (rf.plot.response, (None, 3, "x", xr.Dataset(), *NOTHING)),
    "points drawn": (lambda v: rf.plot.scene(SYSTEM, points=v), (3, "x", NUMBERS_OF, *NOTHING)),
    "legend drawn": (lambda v: rf.plot.scene(SYSTEM, legend=v), (3, "x", NUMBERS_OF, *NOTHING)),
    "outline": (
        lambda v: rf.Block.from_outline(v, unit="m", density="2 t/m^3", depth="1 m"),
        (3, "x", NUMBERS_OF, *NOTHING),
    ),
    "scene drawn": (rf.plot.scene, (None, 3, "x", *NOTHING)),
}  # fmt: skip
OF_RESULTS = {
    "title of a report": (lambda run, v: rf.report(run, "r.html", title=v, certify=False), TEXTS),
    "certify": (lambda run, v: rf.report(run, "r.html", certify=v), (None, 1, "no", *NOTHING)),
    "overwrite": (
        lambda run, v: rf.report(run, "r.html", certify=False, overwrite=v),
        (None, 1, "no", *NOTHING),
    ),
    "path": (
        lambda run, v: rf.report(run, v, certify=False),
        (None, 3, "", "x.nc", "none/r.html", "a\0.html", *NOTHING),
    ),
    "figure's title": (lambda run, v: rf.plot.response(run, title=v), TEXTS),
    "figure's unit": (lambda run, v: rf.plot.response(run, rotation=v), (3, "m", *NOTHING)),
    "panels": (lambda run, v: rf.plot.response(run, panels=v), (3, "x", NUMBERS_OF, *NOTHING)),
    "axes": (lambda run, v: rf.plot.response(run, ax=v), (3, "x", NUMBERS_OF, *NOTHING)),
    "events": (lambda run, v: rf.plot.response(run, events=v), (3, "x", NUMBERS_OF, *NOTHING)),
    "units of histories": (
        lambda run, v: rf.plot.response(run, units=v), (3, "x", NUMBERS_OF, *NOTHING)
    ),
    "contents": (rf.table, (None, 3, "x", *NOTHING)),
    "labels": (
        lambda run, v: rf.concat([run, run], "run", v), (3, "ab", [1], object(), 1j, 10**400)
    ),
    "a system that cannot be read": (
        lambda run, v: rf.System.from_dataset(run.assign_attrs(system_json=v)),
        (3, "{", "3", "[]"),
    ),
    "a motion that cannot be read": (
        lambda run, v: rf.System.from_dataset(run.assign_attrs(motion_json=v)),
        (3, "{", "3", "[]"),
    ),
    "several runs in some": (
        lambda run, v: rf.report(run.assign(status=("x", v)), "r.html"),
        ([1, 2],),
    ),
}  # fmt: skip


def refused(call, *values):
    """Make a call that must be refused; return what is wrong if it is not."""
    try:
        call(*values)
    except RockframeError as problem:
        return "" if len(str(problem)) > 20 else f"says only {problem}"
    except Exception as problem:  # a fault
        return f"{type(problem).__name__}: {problem}"
    return "was taken"


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", MISUSES)
def test_invalid_values_are_refused(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    call, values = MISUSES[name]
    faults = {repr(value)[:60]: refused(call, value) for value in values}
    assert not {value: words for value, words in faults.items() if words}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", OF_RESULTS)
def test_invalid_values_are_refused_for_results(name, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    call, values = OF_RESULTS[name]
    faults = {repr(value)[:60]: refused(call, run, value) for value in values}
    assert not {value: words for value, words in faults.items() if words}
    assert list(tmp_path.iterdir()) == []


def test_missing_sweep_labels_are_refused(runs):
    for label in (7.0, "x", "1 m", 10**400, None, [1.0, 2.0]):
        assert refused(lambda value: rf.case(runs, scale=value), label) == ""


SCENE = TEMPLATES["block"].split("[run]", maxsplit=1)[0] + '[run]\naccuracy = "fast"\n'
STUDY = 'scene = "scene.toml"\nmotions = ["record.AT2"]\n'
AXIS = f"{STUDY}[axes]\nscale = [1.0]\n"
FILES = {
    "describe": [
        "x", "[block]", "block = 3", "[[block]]", "modules = 3", "modules = [3]",
        'modules = ["none.py"]', SCENE + "[pads]\n", SCENE + "[soil]\nstiffness = 3\n",
        SCENE + "[system]\nrestraint = 3\n", SCENE.replace("sine_pulse", "nope"),
        SCENE.replace('"sine_pulse"', "[3]"), *(
            f"{SCENE}{words}\n"
            for words in (
                "points = 3", "outputs = 3", "initial = 3", "initial = { rotation = 3 }",
                "certify = 3", "certify = { runs = -3 }", 'output_step = "0 s"',
                "duration = 1979-05-27", "free_vibration = nan", "nope = 3",
            )
        ), *(
            SCENE.replace('"fast"', words) for words in ("[]", '{ rtol = "x" }', "nan", "3", "true")
        ), *(
            SCENE.replace("[motion]", f"[motion]\noperations = {words}")
            for words in ("3", "[3]", "[{ scaled = 3 }]", '[{ scaled = { factor = "x" } }]',
                          "[{ with_vertical = { other = 3 } }]", "[{ nope = {} }]")
        ), *(
            f"{SCENE.split('[motion]')[0]}[motion]\nfile = {words}\n"
            for words in ('"none"', '"kept"', '""', '"noise"', '"empty"', '"a\\u0000b"', "3",
                          '"record.AT2"\ncomponent = 3', '"record.AT2"\ntime_step = []')
        ), *(
            f"[block]\n{words}\n"
            for words in ("type = 3", 'type = "Cube"', "constructor = 3",
                          'constructor = "from_dict"',
                          'constructor = "from_outline"\npoints = 3', "width = []", "width = {}")
        ),
    ],
    "study": [
        STUDY + "axes = 3\n", *(
            f"{STUDY}[axes]\n{words}\n"
            for words in (
                'scale = "x"', "scale = []", "scale = [[1]]", 'scale = ["a"]', "nope = [1]",
                "scale = [1979-05-27]", "width = [1]", 'width = { values = ["a"], unit = "m" }',
                "width = { values = [1], unit = 3 }", "width = {}", "scale = [1, 1]",
                'width = { values = [1979-05-27], unit = "m" }',
            )
        ), *(
            f"{STUDY}cases = {words}\n"
            for words in ("3", '"none.csv"', '"noise"', '"empty"', '"kept"', '"record.AT2"')
        ), *(
            f"{words}\n{AXIS}"
            for words in (
                "store = 3", 'store = "scene.toml"', 'store = "scene.toml/x"', "output = 3",
                'output = "kept"', 'output = "a\\u0000.nc"', "sweep = 3", "[block]\nwidth = 3",
            )
        ), *(
            AXIS.replace('"scene.toml"', words)
            for words in ("3", '"none"', '"kept"', '"noise"', '"a\\u0000"')
        ), *(
            AXIS.replace('["record.AT2"]', words)
            for words in ("3", "[]", "[3]", '["noise"]', '["*.zip"]', '["kept"]', "[{}]",
                          '["a\\u0000"]')
        ), *(
            f"{AXIS}[sweep]\n{words}\n"
            for words in ("chunk = 0", 'chunk = "x"', "accuracy = 3", "outputs = 3", "duration = 3",
                          "nope = 3", "initial = 3", "points = [3]")
        ),
    ],
}  # fmt: skip
NO_FILES = ("none", "empty", "noise", "kept", "/")
LINES = (
    *(f"run {name}" for name in (*NO_FILES, "record.AT2", "out.nc")),
    *(f"plot {name} -o x.png" for name in (*NO_FILES, "scene.toml", "cut.nc")),
    *(f"report {name}" for name in (*NO_FILES, "scene.toml", "cut.nc", ".")),
    *(f"motion {name}" for name in (*NO_FILES[:-1], "scene.toml", "out.nc")),
    "plot out.nc -o x.png --title $a_{$", "run scene.toml --duration 1_s --free-vibration 1_s",
    *(
        f"run scene.toml {words}"
        for words in (
            "--scale x", "--scale nan", "--scale inf", "--accuracy 0", "--accuracy nan",
            "--free-vibration x", "--free-vibration 3", "--duration 0_s", "--duration 1_m",
            "--motion record.AT2 --component NS", "--motion record.AT2 --unit s", "--motion none",
            "--motion out.nc", "--nope", "-o", "-o out.txt", "scene.toml",
        )
    ),
    *(
        f"certify scene.toml {words}"
        for words in ("--nudge x", "--nudge -1", "--nudge nan", "--reach -1", "--runs 1.5")
    ),
    *(f"study study.toml --{words}" for words in ("csv", "store scene.toml", "store scene.toml/x")),
    "study study.toml --store=",
    *(f"motion record.AT2 {words}" for words in ("--picture .png", "--time-step x", "none")),
    "", "fly", "template nope", "completion", "completion tcsh", "plot out.nc", "report",
)  # fmt: skip


@pytest.fixture
def folder(tmp_path, monkeypatch, run):
    """Change to a folder with a scene, a study, a record, a result, and invalid files."""
    monkeypatch.chdir(tmp_path)
    Path("scene.toml").write_text(SCENE)
    Path("study.toml").write_text(AXIS)
    RECORD.to_at2("record.AT2")
    run.to_netcdf("out.nc")
    Path("cut.nc").write_bytes(Path("out.nc").read_bytes()[:3000])
    Path("noise").write_bytes(np.arange(256, dtype=np.uint8).tobytes() * 20)
    Path("empty").touch()
    Path("kept").mkdir()
    return tmp_path


def fault_of_refusal(words, capsys):
    """Run a command; return what is wrong with its refusal."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        code = main(words)
    output = "".join(capsys.readouterr())
    return code != 2 or "Traceback" in output or len(output) < 30


def test_invalid_command_lines_are_refused(folder, capsys):
    commands = {line: [word.replace("_", " ") for word in line.split()] for line in LINES}
    assert not [line for line, words in commands.items() if fault_of_refusal(words, capsys)]


@pytest.mark.parametrize("command", FILES)
def test_invalid_files_are_refused(command, folder, capsys):
    wrong = []
    for text in FILES[command]:
        Path("wrong.toml").write_text(text)
        if fault_of_refusal([command, "wrong.toml"], capsys):
            wrong.append(text)
    assert not wrong


def test_misuse_tables_have_hundreds_of_entries():
    in_python = sum(len(values) for _, values in (MISUSES | OF_RESULTS).values())
    assert in_python > 200
    assert len(LINES) + sum(map(len, FILES.values())) > 150
