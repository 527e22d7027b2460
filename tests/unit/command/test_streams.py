"""Standard streams: pipes, JSON, colours, progress, interrupts, closed pipes."""

import io
import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import xarray as xr
from matplotlib.animation import FFMpegWriter

import rockframe as rf
from rockframe.command import analyses, figures, report, runs, streams
from rockframe.command.commands import COMMANDS
from rockframe.command.files.templates import TEMPLATES
from rockframe.command.shared import RUN_KIND
from rockframe.errors import FileError
from rockframe.studies.sweeps import execution
from rockframe.writing import write_file

pytestmark = pytest.mark.unit


class Terminal(io.StringIO):
    """A stream that acts as a terminal."""

    def isatty(self):
        return True


@pytest.mark.usefixtures("no_pictures")
def test_scene_and_result_can_be_piped(run_with_input, folder):
    scene = Path("scene.toml").read_bytes()
    code, result, err = run_with_input(scene, "run", "-", "-o", "-")
    assert code == 0
    assert "Verdict: Did not overturn" in err
    Path("piped.nc").write_bytes(result)
    with xr.open_dataset("piped.nc") as stored:
        block = rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t")
        pulse = rf.GroundMotion.sine_pulse("-5 m/s^2", "2 Hz")
        expected = rf.System(block).simulate(pulse, free_vibration="5 s")
        assert float(stored.peak_rotation) == float(expected.peak_rotation)
    for form, begins in (("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")):
        code, picture, _ = run_with_input(result, "plot", "-", "-o", "-", "--format", form)
        assert (code, picture[: len(begins)]) == (0, begins)
    code, page, _ = run_with_input(result, "report", "-", "-o", "-", "--no-certificate")
    assert (code, page[:15].lower()) == (0, b"<!doctype html>")
    code, page, _ = run_with_input(scene, "animate", "-", "-o", "-")
    assert (code, page[:15].lower()) == (0, b"<!doctype html>")


def test_record_can_be_piped(run_with_input, folder):
    record = Path("record.AT2").read_bytes()
    code, table, _ = run_with_input(record, "convert", "-", "--to", "csv", "-o", "-")
    assert code == 0
    assert table.splitlines()[0] == b"time [s],acceleration [m s^-2]"
    for words in (
        ["run", "scene.toml", "-m", "-"],
        ["motion", "-"],
        ["fragility", "scene.toml", "-"],
    ):
        assert run_with_input(record, *words)[0] == 0
    code, table, _ = run_with_input(b"", "motion", "record.AT2", "--csv", "-", "-q")
    assert table.startswith(b"motion,")


def test_json_output_contains_all_numbers_with_units(run_command):
    code, out, err = run_command("run", "scene.toml", "--json", "-o", "out.nc")
    answer = json.loads(out)
    assert (code, err) == (0, "")
    assert answer["exit_code"] == 0
    assert answer["files"] == {"results": "out.nc"}
    numbers = answer["numbers"]
    with xr.open_dataset("out.nc") as stored:
        assert answer["verdict"] == stored.attrs["verdict"]
        scalars = [str(name) for name, variable in stored.data_vars.items() if not variable.dims]
        assert set(scalars) <= set(numbers)
        assert numbers["peak_rotation"] == {"value": float(stored.peak_rotation), "unit": "rad"}
    assert numbers["overturned"] == {"value": False}
    assert numbers["overturning_direction"]["value"] == "none"
    assert numbers["overturning_time"] == {"value": None, "unit": "s"}  # there is none


def test_warnings_appear_in_json_but_not_with_quiet(run_command, folder):
    text = TEMPLATES["block"].replace(
        'accuracy = "standard"', "accuracy = { rtol = 1e-9, max_steps = 20 }"
    )
    Path("short.toml").write_text(text)
    code, out, err = run_command("run", "short.toml", "--json")
    answer = json.loads(out)
    assert code == answer["exit_code"] == 1
    assert answer["warnings"]
    assert f"warning: {answer['warnings'][0]}" in err
    code, out, err = run_command("run", "short.toml", "-q")
    assert (code, err) == (1, "")
    assert [line.split(":")[0] for line in out.splitlines()] == ["Verdict"]


def test_verbose_option_prints_all_numbers(run_command):
    plain = run_command("run", "scene.toml")[1]
    out = run_command("-v", "run", "scene.toml")[1]
    assert out.startswith(plain)
    assert re.search(r"^  peak_rotation: 0\.0821\d* rad$", out, re.MULTILINE)


@pytest.mark.parametrize(
    ("environment", "coloured"),
    [({}, True), ({"NO_COLOR": "1"}, False), ({"NO_COLOR": ""}, True), ({"TERM": "dumb"}, False)],
)
def test_messages_are_coloured_only_on_capable_terminals(environment, coloured, monkeypatch):
    for name in ("NO_COLOR", "TERM"):
        monkeypatch.delenv(name, raising=False)
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(sys, "stderr", Terminal())
    streams.print_message("rockframe run", "no")
    assert ("\x1b[" in sys.stderr.getvalue()) == coloured
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    streams.print_message("rockframe run", "no")
    assert sys.stderr.getvalue() == "rockframe run: no\n"


ANALYSES = {
    "study": ["study", "study.toml"],
    "critical": ["critical", "scene.toml", "--runs", "30"],
    "fragility": ["fragility", "scene.toml"],
    "ida": ["ida", "scene.toml", "--scales", "1,2,3"],
    "map": ["map", "scene.toml", "--amplitude", "2,4 m/s^2", "--frequency", "1,2 Hz"],
}


@pytest.mark.parametrize(
    "name",
    [
        "study",
        "critical",
        "fragility",
        pytest.param("ida", marks=pytest.mark.wide),
        pytest.param("map", marks=pytest.mark.long),
    ],
)
def test_progress_is_shown_only_on_a_terminal(name, run_command, monkeypatch):
    Path("study.toml").write_text('scene = "scene.toml"\n[axes]\nscale = [1.0, 2.0]\n')
    monkeypatch.setattr(streams, "_DELAY", 0.0)
    monkeypatch.setattr(streams, "_UPDATE_INTERVAL", 0.0)
    monkeypatch.delenv("TERM", raising=False)
    assert "runs (" not in run_command(*ANALYSES[name])[2]
    for quiet in ((), ("-q",)):
        monkeypatch.setattr(sys, "stderr", Terminal())
        assert run_command(*ANALYSES[name], *quiet)[0] == 0
        progress = sys.stderr.getvalue()
        assert ("runs (100 %)" in progress) == (not quiet)
        assert not progress or progress.endswith("\r\x1b[K")


@pytest.mark.parametrize("name", ["study", "fragility", "ida", "map"])
def test_interrupted_analysis_exits_with_code_130(name, run_command, monkeypatch):
    Path("study.toml").write_text('scene = "scene.toml"\n[axes]\nscale = [1.0, 2.0]\n')
    run_chunk, calls = execution.run_chunk, []
    before = signal.getsignal(signal.SIGINT)

    def interrupted(*arguments, **keywords):
        calls.append(arguments)
        if len(calls) == 1:
            os.kill(os.getpid(), signal.SIGINT)
        return run_chunk(*arguments, **keywords)

    monkeypatch.setattr(execution, "run_chunk", interrupted)
    code, out, _ = run_command(*ANALYSES[name], "--json")
    assert code == json.loads(out)["exit_code"] == 130
    assert signal.getsignal(signal.SIGINT) is before


def test_binary_output_to_a_terminal_is_refused(run_command, monkeypatch):
    monkeypatch.setattr(sys, "stdout", Terminal())
    monkeypatch.setattr(runs, "simulate_scene", lambda *_, **__: pytest.fail("a run was made"))
    code, _, err = run_command("run", "scene.toml", "-o", "-")
    assert (code, "the standard output is a terminal" in err) == (2, True)


UNWRITABLE = {
    "animate scene.toml -o none/x.html": "there is no folder 'none'",
    "animate scene.toml -o x.mp4": "needs the program ffmpeg",
    "animate scene.toml -o x.html --speed 2": "--speed is for films",
    "animate scene.toml -o mine.html": "not a player that rockframe wrote",
    "report run.nc --check circolare_2019 confidence_factor=1.35 -o x.pdf": "ends in .html",
    "run scene.toml -o - --json": "the answer in JSON goes to the standard output already",
    "critical scene.toml -o - --picture -": "another file goes to the standard output already",
}
if sys.platform == "linux":  # where no user can write
    UNWRITABLE["run scene.toml -o /proc/x.nc"] = "it cannot be written"


@pytest.mark.parametrize(("words", "fault"), UNWRITABLE.items())
def test_outputs_are_checked_before_the_computation(words, fault, run_command, monkeypatch):
    assert run_command("run", "scene.toml", "-o", "run.nc")[0] == 0
    Path("mine.html").write_text("mine")

    def computes(*_, **__):
        pytest.fail("the computation began")

    for module in (figures, runs):
        monkeypatch.setattr(module, "simulate_scene", computes)
    monkeypatch.setattr(analyses, "critical_scale", computes)
    monkeypatch.setattr(report, "call_typed", computes)
    monkeypatch.setattr(FFMpegWriter, "isAvailable", lambda: False)
    code, _, err = run_command(*words.split())
    assert (code, fault in err) == (2, True)


@pytest.mark.parametrize("form", [[], pytest.param(["--json"], marks=pytest.mark.long)])
def test_output_file_survives_closed_pipe(form, folder, uncompiled):
    with subprocess.Popen(
        [sys.executable, "-m", "rockframe", "run", "scene.toml", "-o", "out.nc", *form],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=uncompiled,
    ) as process:  # fmt: skip
        process.stdout.close()
        assert process.stderr.read() == b""
    assert process.returncode == 0
    assert Path("out.nc").is_file()


def test_every_command_takes_json(run_command):
    for command in COMMANDS:
        out = run_command(command.name, "--help")[1]
        assert "--json" in out
    assert json.loads(run_command("template", "--json")[1])["text"] == TEMPLATES["block"]
    assert json.loads(run_command("describe", "scene.toml", "--json")[1])["model"] == "rigid ground"
    measures = json.loads(run_command("motion", "record.AT2", "--json")[1])["numbers"]
    assert measures["peak_ground_acceleration"]["value"] == [pytest.approx(4.0)]


@pytest.mark.skipif(sys.platform == "win32", reason="a shell of POSIX closes the streams")
@pytest.mark.parametrize("closed", ["1", "2"])
def test_closed_streams_are_not_replaced_by_others(closed, uncompiled):
    done = subprocess.run(
        ["/bin/sh", "-c", f"exec {sys.executable} -m rockframe describe missing.toml {closed}>&-"],
        capture_output=True, text=True, env=uncompiled, check=False,
    )  # fmt: skip
    message = "rockframe describe: missing.toml: there is no such file\n"
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == ("" if closed == "2" else message)


@pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="names are text there")
def test_netcdf_in_a_folder_whose_name_is_no_text(folder):
    place = folder / os.fsdecode(b"Stra\xdfe")
    place.mkdir()
    with pytest.raises(FileError, match="its name cannot be written as utf-8"):
        write_file(place / "out.nc", RUN_KIND, xr.Dataset().to_netcdf)
    assert not [*place.iterdir()]


def test_warnings_of_records_name_nothing_of_python(run_command, folder):
    (folder / "records").mkdir()
    rf.GroundMotion.sine_pulse("-4 m/s^2", "1 Hz").to_at2("records/one.AT2")
    (folder / "records" / "broken.AT2").write_text("no record\n")
    code, _, err = run_command("motion", "records")
    assert (code, "1 file not read (broken.AT2: " in err) == (0, True)
    assert "suite." not in err
