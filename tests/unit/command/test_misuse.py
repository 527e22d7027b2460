"""Each kind of misuse gives a message with the error, its place and a remedy."""

import json
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.command.files.templates import TEMPLATES
from rockframe.command.main import main

pytestmark = pytest.mark.unit

WORDS = {
    # commands and options
    "rnu scene.toml": "was 'run' meant?",
    "Run scene.toml": "'Run' is no command; was 'run' meant?",
    "frobnicate": "'frobnicate' is no command. There are template, ",
    "simulate scene.toml": "was 'run' meant?",
    "sweep study.toml": "was 'study' meant?",
    "critcal scene.toml": "was 'critical' meant?",
    "run scene.toml --outptu x.nc": "was '--output' meant?",
    "run scene.toml --Json": "was '--json' meant?",
    "run scene.toml --nudge 0.1": "no option --nudge here; certify takes it",
    "--motion record.AT2 run scene.toml": "no option --motion before the command",
    "run scene.toml --dt 0.01": "was '--time-step' meant?",
    "run scene.toml -z": "there is no option -z",
    "template sta": "was 'stack' or 'statue' meant?",
    "completion bahs": "was 'bash' meant?",
    "run": "required: scene.toml",
    "map scene.toml --frequency '1 Hz'": "required: --amplitude",
    "run scene.toml other.toml": "other.toml",
}
VALUES = {
    # values of options
    "run still.toml --scale 2": "--scale 2 multiplies a motion, and there is no motion",
    "animate still.toml --scale 2 -o x.html": "--scale 2 multiplies a motion",
    "certify scene.toml --proved --nudge 0.01": "which --proved replaces",
    "fragility scene.toml record.AT2 --store ''": "no name of a folder after --store",
    "ida scene.toml record.AT2 --store ''": "no name of a folder after --store",
    "map scene.toml --amplitude '1 g' --frequency '1 Hz' --store ''": "no name of a folder",
    "plot run.nc -o x.png --units force=kN force=N": "--units: found force twice",
    "run scene.toml --scale half": "expected a number such as 1.5, got 'half'",
    "run scene.toml --accuracy standrad": "was 'standard' meant?",
    "run scene.toml --free-vibration 5": "--free-vibration '20 s'",
    "critical scene.toml --runs many": "expected a whole number such as 100, got 'many'",
    "critical scene.toml --runs 1": "runs must be a whole number from 2",
    "critical scene.toml --largest -1": "largest must be greater than zero",
    "critical scene.toml --intensity PGAA": "was 'PGA'",
    "critical scene.toml --intensity SA": "needs a period, for example --period '0.5 s'",
    "critical scene.toml --period '1 s' --intensity PGA": "has no period",
    "fragility scene.toml record.AT2 --scales 1:2": "as from:to:step",
    "fragility scene.toml record.AT2 --limits impact_count=1.2.3": "got '1.2.3'",
    "fragility scene.toml record.AT2 --limits impact_count=inf": "impact_count must be finite",
    "fragility scene.toml record.AT2 --scales 1:2:0": "as from:to:step",
    "fragility scene.toml record.AT2 --scales '1,2 m'": "without a unit",
    "fragility scene.toml record.AT2 --scales 0,5": "got 0, 5 from '0,5'; commas separate numbers",
    "fragility scene.toml record.AT2 --scales 0:2:1": "numbers other than zero, got 0, 1, 2",
    "ida scene.toml --scales 0,25:4:0,25": "listed with commas, decimals with a point",
    "map scene.toml --amplitude '0,5 m/s^2' --frequency '1 Hz'": "decimals have a point, as in 0.5",
    "fragility scene.toml record.AT2 --limits peak_slop=1": "was 'peak_slip'",
    "ida scene.toml --limits uplift,0.x": "got '0.x'",
    "ida scene.toml --limits peak_slip": "'peak_slip=5 cm'",
    "map scene.toml --amplitude 1,2 --frequency '1 Hz'": "followed by their unit",
    "map scene.toml --amplitude '1,2 m' --frequency '1 Hz'": "--amplitude '9.81 m/s^2'",
    "map scene.toml --amplitude '1 g' --frequency '1 Hz' --pulse sine_puls": "was 'sine_pulse'",
    "animate scene.toml -o x.gif --window 1 2": "--window '2 s' '8 s'",
    "animate scene.toml -o x.html --speed 2": "--speed is for films",
    "motion record.AT2 --unit furlong": "furlong",
}
FILES = {
    # files that are read or written
    "run none.toml": "none.toml: there is no such file",
    "run .": "this is a folder",
    "run bytes.toml": "this is no text",
    "run record.AT2": "line 1: this is no TOML",
    "critical still.toml": "there is no motion; name a record with --motion",
    "fragility still.toml": "there are no motions; name records",
    "fragility scene.toml nowhere": "no such file or folder, 'nowhere'",
    "fragility run.nc": "found a single run, which is no sweep",
    "animate record.nc -o x.html": "needs the result of one run",
    "animate scene.toml -o x.avi": "ends in .gif or .mp4 or .html",
    "animate run.nc -o x.html --scale 2": "this is a result, which has run",
    "convert record.AT2 -o x.xyz": "the ending gives no format",
    "convert record.AT2 --to csv -o none/deep": "this folder cannot be made",
    "convert scene.toml -o x.AT2": "no format recognises",
    "critical scene.toml -o run.nc": "not the result of a critical scale that rockframe wrote",
    "critical scene.toml --picture x.txt": "ends in .png or .svg or .pdf",
    "run scene.toml -o x.nc -m scene.toml": "no format recognises",
    "report run.nc --motions record.AT2": "found motions=, which is for a study",
    "report run.nc --case scale=1": "expected a study, which has axes",
    "plot run.nc -o scene.toml": "ends in .png or .svg or .pdf",
    "run scene.toml -o shut/x.nc": "shut",
}
STREAMS = {
    # standard streams in place of files
    "run - -m -": "a scene is read from it already",
    "run - --json -o -": "the answer in JSON goes to the standard output already",
    "critical - -o - --picture -": "another file goes to the standard output already",
    "convert record.AT2 -o -": "a format such as --to at2",
    "plot - -o x.png": "this is no netCDF file",
    "motion -": "standard input: found no horizontal component",
    "report -": "name the report with -o report.html",
}


def split(words):
    return shlex.split(words)


@pytest.fixture(scope="module")
def run_files(tmp_path_factory):
    """Return the result of the scene and its record as netCDF."""
    place = tmp_path_factory.mktemp("made")
    (place / "scene.toml").write_text(TEMPLATES["block"])
    assert main(["run", str(place / "scene.toml"), "-o", str(place / "run.nc")]) == 0
    rf.GroundMotion.sine_pulse("-4 m/s^2", "1 Hz").to_dataset().to_netcdf(place / "record.nc")
    return {name: (place / name).read_bytes() for name in ("run.nc", "record.nc")}


def test_a_result_whose_values_are_damaged_is_refused(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    runs = xr.Dataset({"rotation": ("time", np.zeros(1000))})
    runs.to_netcdf("run.nc", encoding={"rotation": {"zlib": True}})
    content = bytearray(Path("run.nc").read_bytes())
    start = content.rindex(b"\x78\x5e")  # of compressed values
    content[start : start + 8] = bytes(8)
    Path("run.nc").write_bytes(content)
    assert main(["report", "run.nc"]) == 2
    assert "run.nc: this is no netCDF file" in capsys.readouterr().err


@pytest.fixture
def files(folder, run_files):
    """Return files of all kinds."""
    Path("bytes.toml").write_bytes(bytes(range(256)))
    Path("still.toml").write_text(Path("scene.toml").read_text().split("[motion]")[0])
    for name, content in run_files.items():
        Path(name).write_bytes(content)
    Path("shut").mkdir()
    Path("shut").chmod(0o500)
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


@pytest.mark.parametrize("words", [*WORDS, *VALUES, *FILES])
def test_misuse_prints_an_error_and_leaves_files_unchanged(words, run_command, files, folder):
    if words.endswith("shut/x.nc") and os.access("shut", os.W_OK):
        pytest.skip("this user may write everywhere")
    code, out, err = run_command(*split(words))
    assert code == 2
    assert {**WORDS, **VALUES, **FILES}[words] in err
    assert "Traceback" not in out + err
    left = {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    assert left == files


@pytest.mark.parametrize("words", STREAMS)
def test_misuse_of_streams_prints_an_error(words, run_with_input, folder):
    code, out, err = run_with_input(Path("scene.toml").read_bytes(), *split(words))
    assert code == 2
    assert STREAMS[words] in err
    assert b"Traceback" not in out


def test_json_output_contains_the_error(run_command):
    code, out, err = run_command("run", "none.toml", "--json")
    answer = json.loads(out)
    assert answer["error"] == "none.toml: there is no such file"
    assert answer["exit_code"] == code == 2
    assert err == "rockframe run: none.toml: there is no such file\n"


@pytest.mark.parametrize("words", WORDS)
def test_json_output_contains_usage_errors(words, run_command):
    code, out, err = run_command(*split(words), "--json")
    answer = json.loads(out)
    assert answer["exit_code"] == code == 2
    assert WORDS[words] in answer["error"]
    assert answer["error"] in err


SCENES = {
    # file: line and message
    '[block]\nwidth = "1 m"\nheight = 3\nmass = "1 t"\n': (3, 'write for example height = "4 m"'),
    '[block]\nwidth = "1 m"\nheight = "3 m"\nmas = "1 t"\n': (4, "was 'mass' meant?"),
    '[blok]\nwidth = "1 m"\n': (1, "was 'block' meant?"),
    '[block]\ntype = "Blok"\n': (2, "was 'Block' meant?"),
    '[block]\nconstructor = "from_outlin"\n': (2, "was 'from_outline'"),
    "{block}[system]\nrestraint = 'center'\n": (6, "was 'centre' meant?"),
    "{block}[run]\naccuracy = 'quick'\nfree_vibratoin = '1 s'\n": (7, "was 'free_vibration'"),
    "{block}[run]\naccuracy = 'standrad'\nfree_vibratoin = '1 s'\n": (6, "was 'standard' meant?"),
    "{block}[run]\noutputs = ['energis']\n": (6, "energis"),
    "{block}[motion]\nconstructor = 'sin_pulse'\n": (6, "was 'sine_pulse'"),
    "{block}[motion]\nfile = 'record.AT2'\n[[motion.operations]]\nscald = {{factor = 2}}\n": (
        8, "was 'scaled' meant?",
    ),
    "[stack]\n[[stack.bodies]]\nwidth = '1 m'\nheight = '1 m'\nmass = '1 kg'\n[[stack.bodies]]\n"
    "width = '2 m'\nheight = '1 m'\nmass = '1 s'\n[[stack.interfaces]]\ntype = 'RigidGrund'\n": (
        9, "mass needs a mass",
    ),
    "[stack]\ninterfaces = []\nbodies = 'two'\n": (3, "[[stack.bodies]] above each"),
    "[block]\nconstructor = 'from_parts'\n[block.parts.a]\nwidth = '1 m'\nheight = '1 m'\n"
    "mass = '1 kg'\nunit = 'm'\n": (7, "'unit'"),
    "[frame]\ncolumns = 3\nbeam_mass = '1 t'\n[frame.column]\nwidth = '1 m'\nheigth = '3 m'\n": (
        6, "was 'height' meant?",
    ),
}  # fmt: skip
PLAIN = '[block]\nwidth = "0.8 m"\nheight = "3.2 m"\nmass = "5.5 t"\n'


@pytest.mark.parametrize("text", SCENES)
def test_scene_errors_have_line_numbers(text, run_command):
    line, words = SCENES[text]
    Path("wrong.toml").write_text(text.format(block=PLAIN) if "{block}" in text else text)
    code, _, err = run_command("run", "wrong.toml", "--duration", "1 s")
    assert code == 2
    messages = [message for message in err.splitlines() if f"wrong.toml, line {line}: " in message]
    assert any(words in message for message in messages), err


@pytest.mark.parametrize(
    ("axes", "line", "words"),
    [
        ("scale = [1]\nwidht = ['1 m']\n", 5, "was 'width' meant?"),
        ("scale = [1]\n\nwidth = ['1 s']\n", 6, 'width = "4 m"'),
        ("scale = ['one']\n", 4, "scale"),
        ("Block.width = ['1 m']\n", 4, 'in quotation marks: "Block.width" = [...]'),
    ],
)
def test_study_errors_have_line_numbers(axes, line, words, run_command):
    Path("study.toml").write_text(f'scene = "scene.toml"\n\n[axes]\n{axes}')
    for command in ("study", "fragility"):
        code, _, err = run_command(command, "study.toml")
        assert code == 2
        assert f"study.toml, line {line}: " in err
        assert words in err


def test_other_encodings_and_line_endings_are_read(run_command):
    text = f'# Caf\u00e9\n{PLAIN}[run]\nduration = "1 s"\n'
    for encoding, newline in (("utf-8-sig", "\n"), ("utf-16", "\r\n"), ("utf-8", "\r\n")):
        Path("other.toml").write_text(text, encoding=encoding, newline=newline)
        code, out, err = run_command("run", "other.toml")
        assert (code, err) == (0, "")
        assert "Verdict: " in out
    Path("other.toml").write_text(text, encoding="latin-1")
    code, out, err = run_command("run", "other.toml")
    assert code == 0
    assert "other.toml, line 1: found '\u00e9' in the old encoding of Windows" in err
    for encoding in ("utf-8-sig", "utf-16", "utf-8"):
        wrong = text.replace('"3.2 m"', '"3.2 s"')
        Path("other.toml").write_text(wrong, encoding=encoding, newline="\r\n")
        code, _, err = run_command("run", "other.toml")
        assert (code, "other.toml, line 4: " in err) == (2, True)


@pytest.mark.skipif(shutil.which("sh") is None, reason="there is no shell")
@pytest.mark.parametrize(
    ("words", "code"),
    [
        pytest.param("run scene.toml >&-", 0, marks=pytest.mark.wide),
        pytest.param("run - <&-", 2, marks=pytest.mark.long),
        pytest.param("run scene.toml 2>&-", 0, marks=pytest.mark.long),
    ],
)
def test_closed_streams_cause_no_traceback(words, code, folder, uncompiled):
    done = subprocess.run(
        [shutil.which("sh"), "-c", f"{sys.executable} -m rockframe {words}"],
        capture_output=True, text=True, check=False, cwd=folder, env=uncompiled,
    )  # fmt: skip
    assert done.returncode == code, done
    assert "Traceback" not in done.stderr
