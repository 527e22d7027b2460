"""Commands: output, files and exit codes."""

import itertools
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.command import analyses, parser
from rockframe.command.commands import COMMANDS
from rockframe.command.completion import script
from rockframe.command.files.studies import read_study
from rockframe.command.files.templates import TEMPLATES
from rockframe.studies.sweeps import execution

pytestmark = pytest.mark.unit


@pytest.mark.usefixtures("no_pictures")
def test_a_run_from_the_template_to_the_report(run_command, folder):
    code, out, _ = run_command("template")
    assert (code, out) == (0, TEMPLATES["block"])
    code, out, _ = run_command("describe", "scene.toml")
    assert code == 0
    assert "Model: rigid ground" in out
    assert '[block]  width = "0.8 m", height = "3.2 m", mass = "5500.0 kg"' in out
    assert "cycles: 1: 129 samples at 0.00390625 s, 0.5 s long, peak 5 m/s^2 (0.51 g)" in out
    code, out, _ = run_command("run", "scene.toml", "-o", "out.nc")
    assert code == 0
    assert "Verdict: Did not overturn" in out
    with xr.open_dataset("out.nc") as stored:
        block = rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t")
        pulse = rf.GroundMotion.sine_pulse("-5 m/s^2", "2 Hz")
        expected = rf.System(block).simulate(pulse, free_vibration="5 s")
        assert float(stored.peak_rotation) == float(expected.peak_rotation)
    code, out, _ = run_command("plot", "out.nc", "-o", "out.png")
    assert code == 0
    assert (folder / "out.png").read_bytes().startswith(b"\x89PNG")
    forces = ("--panels", "base_shear", "ground", "--units", "force=kN", "acceleration=g")
    assert run_command("plot", "out.nc", "-o", "out.svg", *forces)[0] == 0
    code, _, problem = run_command("plot", "out.nc", "-o", "out.svg", "--panels", "base_sheer")
    assert (code, "was 'base_shear' meant?" in problem) == (2, True)
    code, _, problem = run_command("report", "out.nc", "-o", "out.pdf")
    assert (code, "a browser prints the page into a PDF" in problem) == (2, True)
    code, out, _ = run_command("report", "out.nc", "--no-certificate", "--title", "A <tower>")
    assert code == 0
    assert "A &lt;tower&gt;" in (folder / "out.html").read_text()


@pytest.mark.usefixtures("no_pictures")
def test_study_of_records_with_unlike_time_steps_is_reported(run_command, folder):
    (folder / "records").mkdir()
    for step in ("0.01 s", "0.02 s"):
        motion = rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz").resampled(step)
        motion.to_at2(f"records/every {step}.AT2")
    (folder / "study.toml").write_text(
        'scene = "scene.toml"\nmotions = ["records"]\noutput = "runs.nc"\n'
        '[axes]\nscale = [1.0]\n[sweep]\noutputs = ["base_shear"]\n'
    )
    code, _, err = run_command("study", "study.toml")
    assert code == 0
    assert "time steps from 0.01 s to 0.02 s; histories are kept every 0.01 s" in err
    code, out, _ = run_command("report", "runs.nc", "--motions", "records", "--units", "force=kN")
    assert (code, out) == (0, "Report: runs.html\n")
    page = (folder / "runs.html").read_text()
    assert "peak base shear [kN]" in page
    assert "The worst case in full" in page


def test_record_table_without_unit_requires_unit_option(run_command, folder):
    rows = "\n".join(f"{0.01 * k:.2f},{0.1 * (k % 3)}" for k in range(50))
    (folder / "x.csv").write_text(f"{rows}\n")
    code, _, problem = run_command("motion", "x.csv")
    assert code == 2
    assert problem.count("--unit 'g'") == 1
    code, _, problem = run_command("motion", "x.csv", "--unit", "g")
    assert code == 0


@pytest.mark.usefixtures("no_pictures")
def test_scaled_motion_is_printed_with_its_factor(run_command, folder):
    run_command("template")
    code, out, _ = run_command("run", "scene.toml", "-o", "out.nc", "--scale", "3")
    assert code == 0
    assert "Motion:  3 times sine pulse, -5 m/s^2, 2 Hz" in out
    with xr.open_dataset("out.nc") as stored:
        assert stored.attrs["motion"].startswith("sine pulse, -5 m/s^2, 2 Hz")  # names the motion
    run_command("report", "out.nc", "--no-certificate")
    assert "3 times sine pulse, -5 m/s^2, 2 Hz" in (folder / "out.html").read_text()


def test_result_file_as_scene_is_refused(run_command):
    run_command("template")
    run_command("run", "scene.toml", "-o", "out.nc")
    code, _, problem = run_command("certify", "out.nc")
    assert code == 2
    assert "out.nc: this is no text; expected a scene or a study in TOML" in problem
    assert "rockframe report" in problem


def test_options_override_the_scene(run_command):
    options = [
        "run",
        "scene.toml",
        "-o",
        "out.nc",
        "--free-vibration",
        "1 s",
        "--accuracy",
        "1e-6",
    ]
    code, *_ = run_command(*options, "--motion", "record.AT2", "--scale", "0.5")
    assert code == 0
    with xr.open_dataset("out.nc") as stored:
        assert float(abs(stored.ground_acceleration).max()) == pytest.approx(2.0, rel=1e-3)
        assert float(stored.time[-1]) == pytest.approx(2.0, abs=0.02)
        assert stored.attrs["solver_rtol"] == 1e-6
    code, *_ = run_command("run", "scene.toml", "-o", "out.nc", "--duration", "0.7 s")
    assert code == 0
    with xr.open_dataset("out.nc") as stored:
        assert float(stored.time[-1]) == pytest.approx(0.7, abs=0.01)
    scene = Path("scene.toml").read_text()
    Path("short.toml").write_text(re.sub('free_vibration = "[^"]*"', 'duration = "0.7 s"', scene))
    for options, end in (([], 0.7), (["--free-vibration", "1.5 s"], 2.0)):
        code, *_ = run_command("run", "short.toml", "-o", "out.nc", *options)
        assert code == 0
        with xr.open_dataset("out.nc") as stored:
            assert float(stored.time[-1]) == pytest.approx(end, abs=0.02)


def test_certificate_is_printed_and_stored(run_command):
    code, out, _ = run_command("certify", "scene.toml", "--runs", "60", "-o", "sure.nc")
    assert code == 0
    assert "Certificate: The body stands" in out
    with xr.open_dataset("sure.nc") as stored:
        assert bool(stored.verdict_robust)


def test_motions_are_listed_with_their_measures(run_command, folder):
    rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz").to_at2("other.AT2")
    code, out, _ = run_command(
        "motion", "record.AT2", "other.AT2", "--picture", "m.png", "--csv", "m.csv"
    )
    assert code == 0
    assert "peak ground acceleration [m s^-2]" in out
    assert {"m-1.png", "m-2.png"} <= {path.name for path in folder.iterdir()}
    assert (folder / "m.csv").read_text().count("\n") == 3
    code, *_ = run_command("motion", "record.AT2", "--picture", "m.svg")
    assert code == 0
    assert (folder / "m.svg").exists()


def test_table_of_many_motions_is_wrapped(run_command, folder):
    for number in range(1, 12):
        pulse = rf.GroundMotion.sine_pulse(f"{number} m/s^2", "1 Hz")
        pulse.to_at2(f"a_record_with_a_name_{number}.AT2")
    code, out, _ = run_command("motion", *sorted(path.name for path in folder.glob("a_*.AT2")))
    assert code == 0
    lines = out.splitlines()
    assert max(map(len, lines)) <= 100
    parts = out.split("\n\n")
    assert len(parts) > 1  # the labels of the rows are repeated
    assert all(part.count("a_record_with_a_name_11") == 1 for part in parts)
    assert " ".join(out.split()).count("[m s^-1]") == 4
    assert all("\\" not in line and line == line.rstrip() for line in lines)


def test_error_for_missing_unit_mentions_the_option_once(run_command, folder):
    (folder / "index.txt").write_text("\n".join(f"{0.01 * k:.2f}" for k in range(200)))
    code, _, error = run_command(
        "run", "scene.toml", "--motion", "index.txt", "--time-step", "0.01 s"
    )
    assert code == 2
    assert error.count("--unit") == 1
    assert "unit='g'" not in error


def test_finished_study_is_not_run_again(run_command, folder):
    (folder / "study.toml").write_text(TEMPLATES["study"].replace('accuracy = "fast"', "chunk = 5"))
    code, out, _ = run_command("study", "study.toml", "--csv", "runs.csv")
    assert code == 0
    assert "Of all 12 cases of the sweep" in out
    assert (folder / "runs.csv").read_text().count("\n") == 13
    paths = sorted((folder / "study").rglob("*"))
    before = {path: path.stat().st_mtime_ns for path in paths if path.is_file()}
    assert run_command("study", "study.toml")[0] == 0
    assert all(path.stat().st_mtime_ns == modified for path, modified in before.items())
    with xr.open_dataset("study.nc") as runs:
        assert dict(runs.overturned.sizes) == {"scale": 4, "width": 3, "motion": 1}
        case = rf.case(runs, scale=2.0, width=0.7).simulate()
        assert bool(case.overturned) == bool(runs.overturned.sel(scale=2.0, width=0.7).item())


@pytest.mark.parametrize("store", ["my kept", None])
def test_interrupted_study_prints_the_command_to_resume(run_command, folder, monkeypatch, store):
    template = TEMPLATES["study"].replace('accuracy = "fast"', "chunk = 2")
    lines = [line for line in template.splitlines() if not line.startswith("store")]
    (folder / "study.toml").write_text("\n".join(lines))
    words = ["study", "study.toml", "--csv", "runs.csv", *(["--store", store] if store else [])]
    run_chunk, calls = execution.run_chunk, itertools.count()

    def interrupted(*arguments, **keywords):
        if next(calls) == 3:
            raise KeyboardInterrupt
        return run_chunk(*arguments, **keywords)

    with monkeypatch.context() as patch:
        patch.setattr(execution, "run_chunk", interrupted)
        code, out, problem = run_command(*words)
    assert code == 130
    assert "have not been run" in out
    if store is None:
        assert "has to be run again; with a store it could continue: rockframe study" in problem
        assert problem.endswith("study.toml --csv runs.csv --store study\n")
    else:
        command = problem.splitlines()[-1].partition("command continues it: ")[2]
        assert shlex.split(command) == ["rockframe", *words]
        files = [path for path in (folder / store).iterdir() if path.is_file()]
        modified = {path: path.stat().st_mtime_ns for path in files}
        code, out, _ = run_command(*shlex.split(command)[1:])
        assert code == 0
        assert "not been run" not in out
        assert all(path.stat().st_mtime_ns == time for path, time in modified.items())

    def interrupted_at_once(*arguments, **keywords):
        raise KeyboardInterrupt

    monkeypatch.setattr(analyses, "sweep", interrupted_at_once)
    code, _, problem = run_command(*words)
    assert code == 130
    assert "rockframe study study.toml --csv runs.csv --store " in problem


@pytest.mark.usefixtures("no_pictures")
def test_a_table_of_cases_is_read(run_command, folder):
    (folder / "cases.csv").write_text("width [m],scale\n0.7,1\n0.8,2\n")
    (folder / "study.toml").write_text('scene = "scene.toml"\ncases = "cases.csv"\n')
    assert run_command("study", "study.toml", "-o", "runs.nc")[0] == 0
    with xr.open_dataset("runs.nc") as runs:
        assert runs.sizes["case"] == 2
        assert np.isfinite(runs.peak_rotation).all()
    words = ["report", "runs.nc", "--case", "case=1", "--no-certificate", "-o", "one.html"]
    assert run_command(*words)[0] == 0
    assert "0.8 m" in (folder / "one.html").read_text()


@pytest.mark.usefixtures("no_pictures")
def test_study_can_be_reported_whole_or_by_case(run_command, folder):
    (folder / "study.toml").write_text(
        'scene = "scene.toml"\n[axes]\nscale = [1.0, 2.0]\nwidth = ["0.7 m", "0.8 m"]\n'
    )
    assert run_command("study", "study.toml", "-o", "runs.nc")[0] == 0
    for words, message in (
        (["--units", "force"], "--units: expected NAME=VALUE, such as force=kN"),
        (["--units", "force=kg"], "units['force'] needs a force"),
        (["--case", "scale"], "expected NAME=VALUE"),
        (["--case", "scale=3", "width=0.7 m"], "scale has no '3'"),
        (["--case", "scale=2"], "width"),
    ):
        code, _, err = run_command("report", "runs.nc", *words)
        assert (code, message in err) == (2, True), err
    arguments = ["--case", "scale=2", "width=0.7 m", "--no-certificate", "-o", "case.html"]
    assert run_command("report", "runs.nc", *arguments)[0] == 0
    with xr.open_dataset("runs.nc") as runs:
        verdict = rf.case(runs, scale=2.0, width="0.7 m").simulate().attrs["verdict"]
    assert verdict in (folder / "case.html").read_text()
    assert run_command("report", "runs.nc", "--units", "angle=deg")[0] == 0
    assert "The worst case in full" in (folder / "runs.html").read_text()


@pytest.mark.usefixtures("no_pictures")
def test_study_report_accepts_records_target_and_checks(run_command, folder, monkeypatch):
    (folder / "records").mkdir()
    for seed in (1, 2):
        motion = rf.GroundMotion.stochastic(6.5, "20 km", seed=seed).window("2 s", "8 s")
        motion.to_at2(folder / "records" / f"{seed}.AT2")
    (folder / "study.toml").write_text(
        'scene = "scene.toml"\nmotions = ["records/*.AT2"]\n'
        '[axes]\nscale = [1.0, 2.0]\n[sweep]\naccuracy = "fast"\n'
    )
    assert run_command("study", "study.toml", "-o", "runs.nc")[0] == 0
    monkeypatch.setattr("rockframe.studies.sweeps.study._cache", {})  # as in another process
    one = ["--case", "scale=2", "motion=1", "-o", "one.html", "--no-certificate"]
    code, _, err = run_command("report", "runs.nc", *one)
    assert (code, "as motions=" in err) == (2, False)
    assert err.startswith("rockframe report: runs.nc: the record '1' ")
    assert "must be given, by --motions" in err
    assert run_command("report", "runs.nc", "--motions", "records", *one)[0] == 0
    spectrum = ["--target", "eurocode_8", "ground_acceleration=0.2 g_0", "ground_type=B"]
    check = ["--check", "circolare_2019", "confidence_factor=1.2"]
    component = ["--check", "asce_7_22", "spectral_acceleration=1"]
    arguments = ["--motions", "records", *spectrum, *check, *component]
    assert run_command("report", "runs.nc", *arguments)[0] == 0
    text = (folder / "runs.html").read_text()
    for message in ("Target: Eurocode 8, type 1, ground B", "spectral misfit", "FC</td>",
                 '<td class="value">1.2</td>', "C8.7.1.2.1.9", "tipping: "):  # fmt: skip
        assert message in text, message
    (folder / "ntc.csv").write_text("period [s],acceleration [g_0]\n0.1,0.5\n1,0.3\n4,0.05\n")
    table = ["--target", "ntc.csv", "damping_ratio=0.08"]
    assert run_command("report", "runs.nc", "--motions", "records", *table)[0] == 0
    assert "Target: ntc. Compared at 40 periods from 0.1 s" in (folder / "runs.html").read_text()
    assert "8 % damping" in (folder / "runs.html").read_text()
    assert run_command("run", "scene.toml", "-o", "out.nc")[0] == 0
    assert run_command("report", "out.nc", "--no-certificate", *check)[0] == 0
    assert "dynamic, SLV: " in (folder / "out.html").read_text()
    (folder / "bad.csv").write_text("T [s],Sa [g]\n0.1,0.5\n")
    for words, message in (
        (["--target", "eurocode8"], "known are eurocode_8, asce_7; was 'eurocode_8' meant?"),
        (["--target", "asce_7", "one=2 g_0"], "has no 'one'"),
        (["--target", "asce_7"], "needs short_period_acceleration=..."),
        (["--target", "bad.csv"], "found the columns T [s], Sa [g]; expected columns 'period [s]'"),
        (["--target", "none.csv"], "the table cannot be read"),
        (["--check", "circolare_2019"], "needs the motions of the result"),
        (["--check", "circolare_2019", "limit_state=SLX", "--motions", "records"], "'SLV', 'SLC'"),
        (["--check", "asce"], "known are circolare_2019, asce_7_22"),
    ):
        code, _, err = run_command("report", "runs.nc", *words)
        assert (code, message in err) == (2, True), err


@pytest.mark.usefixtures("no_pictures")
def test_project_table_of_a_scene_appears_in_reports(run_command, folder):
    scene = (folder / "scene.toml").read_text()
    project = '[project]\nobject = "Tower"\ndate = 2026-11-24\n'
    (folder / "scene.toml").write_text(f"{scene}\n{project}")
    assert run_command("run", "scene.toml", "-o", "out.nc")[0] == 0
    assert run_command("report", "out.nc", "--no-certificate")[0] == 0
    text = (folder / "out.html").read_text()
    assert "Tower" in text
    assert "2026-11-24" in text
    (folder / "study.toml").write_text('scene = "scene.toml"\n[axes]\nscale = [1.0]\n')
    assert run_command("study", "study.toml", "-o", "runs.nc")[0] == 0
    assert run_command("report", "runs.nc")[0] == 0
    assert "Tower" in (folder / "runs.html").read_text()
    own = 'scene = "scene.toml"\n[axes]\nscale = [1.0]\n[project]\nobject = "All towers"\n'
    (folder / "study.toml").write_text(own)
    assert "All towers" in read_study("study.toml").project
    (folder / "study.toml").write_text(f"{own}[run]\naccuracy = 'fast'\n")
    assert "belong in [sweep]" in run_command("study", "study.toml")[2]
    checks = (
        'checks = ["circolare_2019 confidence_factor=1.2", "asce_7_22 spectral_acceleration=1"]'
    )
    (folder / "scene.toml").write_text(f"{scene}\n{project}{checks}\n")
    assert run_command("run", "scene.toml", "-o", "out.nc")[0] == 0
    assert run_command("report", "out.nc", "--no-certificate")[0] == 0
    text = (folder / "out.html").read_text()
    assert '<td>FC</td><td class="value">1.2</td>' in text
    assert "tipping: " in text
    with xr.open_dataset("out.nc") as stored:
        rf.report(stored, "python.html", certify=False)
    text = (folder / "python.html").read_text()
    assert "Not checked</strong>Requested: circolare_2019 confidence_factor=1.2; asce_7_22" in text
    for wrong, message in (
        ("circolare", "known are circolare_2019, asce_7_22; was 'circolare_2019' meant?"),
        ("circolare_2019 factor=1", "circolare_2019 has no 'factor'"),
        ("asce_7_22", "asce_7_22 needs spectral_acceleration=..."),
        ("", "found an empty check"),
    ):
        (folder / "scene.toml").write_text(f'{scene}\n[project]\nchecks = ["{wrong}"]\n')
        code, _, err = run_command("run", "scene.toml")
        assert (code, message in err) == (2, True), err
    (folder / "scene.toml").write_text(f"{scene}\n[project]\nobjekt = 'Tower'\n")
    code, _, err = run_command("run", "scene.toml")
    assert code == 2
    assert "project has no entry 'objekt'; was 'object' meant?" in err


WRONG = {
    "nothing": ([], "usage: rockframe"),
    "no command": (["fly"], "invalid choice: 'fly'"),
    "no argument": (["run"], "scene.toml"),
    "no scene": (["run", "none.toml"], "none.toml: there is no such file"),
    "no record": (["run", "scene.toml", "-m", "none.AT2"], "none.AT2: found no such file"),
    "no accuracy": (["run", "scene.toml", "--accuracy", "best"], "'fast', 'standard'"),
    "no unit": (["run", "scene.toml", "--free-vibration", "3"], "free_vibration needs a time"),
    "no folder": (["run", "scene.toml", "-o", "none/out.nc"], "there is no folder 'none'"),
    "a folder": (["run", "scene.toml", "-o", "."], "this is a folder"),
    "no dataset": (["plot", "scene.toml", "-o", "x.png"], "no netCDF file"),
    "no result": (["report", "none.nc"], "none.nc: there is no such file"),
    "no study": (["study", "scene.toml"], "a study needs [axes]"),
    "a study": (
        ["run", "study.toml"],
        "run: study.toml, line 3: 'axes' belongs to a study, which 'rockframe study' runs",
    ),
    "a broken scene": (["describe", "broken.toml"], "broken.toml, line 2: "),
}


@pytest.mark.parametrize("name", WRONG)
def test_errors_are_printed_without_a_traceback(name, run_command, folder):
    (folder / "broken.toml").write_text("[block]\nwidth = 3\n")
    (folder / "study.toml").write_text(
        'scene = "scene.toml"\nstore = "kept"\n[axes]\nscale = [1]\n'
    )
    words, expected = WRONG[name]
    code, out, err = run_command(*words)
    assert code == 2
    assert expected in out + err
    assert err.count("unknown key") == 0
    assert "Traceback" not in err


def test_unsuitable_results_are_refused(run_command, folder):
    rf.intensity_measures(rf.GroundMotion.sine_pulse()).to_netcdf("measures.nc")
    code, _, err = run_command("plot", "measures.nc", "-o", "x.png")
    assert (code, "no function of rf.plot draws" in err) == (2, True)
    code, _, err = run_command("report", "measures.nc")
    assert (code, "no result of a run" in err) == (2, True)
    run_command("run", "scene.toml", "-o", "out.nc")
    code, _, err = run_command("plot", "out.nc", "-o", "x.xyz")
    assert (code, "xyz" in err) == (2, True)


def test_unfinished_run_exits_with_code_1(run_command, folder):
    text = TEMPLATES["block"].replace(
        'accuracy = "standard"', "accuracy = { rtol = 1e-9, max_steps = 20 }"
    )
    (folder / "short.toml").write_text(text)
    code, out, err = run_command("run", "short.toml")
    assert code == 1
    assert "warning:" in err
    assert "Verdict:" in out


def test_a_traceback_is_shown_on_request(run_command):
    code, _, err = run_command("run", "none.toml", "--debug")
    assert code == 2
    assert "Traceback" in err
    assert "FileError" in err


def test_help_examples_are_valid_commands(run_command):
    code, out, _ = run_command("--help")
    assert code == 0
    for command in COMMANDS:
        assert command.name in out
        code, help_text, _ = run_command(command.name, "--help")
        assert code == 0
        assert "examples:" in help_text
        assert "exit codes:" in help_text
        built = parser.build_parser()
        for line in command.examples.splitlines():
            if line.startswith("  rockframe "):
                typed_line = re.split("   | [<>] ", line.strip())[0]
                words = shlex.split(typed_line)[1:]
                assert parser.unknown_word_message(words) is None
                assert built.parse_args(words).command == command.name


def test_usage_errors_carry_their_own_message(capsys):
    lines = (["run"], "required: scene.toml"), (["map", "a.toml"], "required: --amplitude")
    parsers = [parser.build_parser() for _ in lines]
    problems = []
    for command_parser, (line, _) in zip(parsers, lines, strict=True):
        with pytest.raises(parser.UsageError) as caught:
            command_parser.parse_args(line)
        problems.append(caught.value)
    written = capsys.readouterr().err
    for problem, (_, words) in zip(problems, lines, strict=True):
        assert words in str(problem)
        assert str(problem) in written


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_names_every_command_and_option(shell):
    text = script(shell)
    for command in COMMANDS:
        assert command.name in text
        for argument in command.arguments:
            for name in argument.names:
                if name.startswith("--"):
                    assert name.removeprefix("--") in text
    if shutil.which(shell):
        check = {"bash": ["-n"], "zsh": ["-n"], "fish": ["--no-execute"]}[shell]
        subprocess.run([shell, *check], input=text, text=True, check=True)


@pytest.mark.skipif(shutil.which("bash") is None, reason="there is no bash")
def test_bash_completes(tmp_path):
    (tmp_path / "done.sh").write_text(script("bash"))

    def completed(*words):
        quoted = " ".join(f"'{word}'" for word in words)
        program = (
            f"source done.sh; COMP_WORDS=({quoted}); COMP_CWORD={len(words) - 1}; _rockframe; "
            'printf "%s\\n" "${COMPREPLY[@]}"'
        )
        done = subprocess.run(
            [shutil.which("bash"), "-c", program],
            capture_output=True, text=True, check=True, cwd=tmp_path,
        )  # fmt: skip
        return done.stdout.split()

    assert completed("rockframe", "re") == ["report"]
    assert completed("rockframe", "run", "--acc") == ["--accuracy"]
    assert completed("rockframe", "run", "scene") == []  # bash itself completes files
    assert completed("rockframe", "convert", "") == []
    assert completed("rockframe", "convert", "--to", "") == ["at2", "csv", "nc"]
    assert completed("rockframe", "completion", "") == ["bash", "zsh", "fish"]


@pytest.mark.skipif(
    shutil.which("bash") is None or sys.platform == "win32", reason="no bash or no terminal"
)
def test_bash_quotes_names_of_files(tmp_path):
    (tmp_path / "done.sh").write_text(script("bash"))
    (tmp_path / "my scene.toml").touch()
    try:
        master, terminal = os.openpty()
    except OSError as problem:
        pytest.skip(f"no pseudo-terminal: {problem}")
    lines = "source done.sh; rockframe() { printf '<%s>' \"$@\"; }\nrockframe run my\t\nexit\n"
    os.write(master, lines.encode())
    with subprocess.Popen(
        [shutil.which("bash"), "--norc", "--noprofile", "-i"], cwd=tmp_path,
        stdin=terminal, stdout=terminal, stderr=subprocess.DEVNULL, start_new_session=True,
    ) as bash:  # fmt: skip
        bash.wait(timeout=60)
    written = os.read(master, 100_000).decode()
    os.close(terminal)
    os.close(master)
    assert "<run><my scene.toml>" in written


@pytest.mark.parametrize(("shell", "place"), [("zsh", "'*:file:_files'"), ("fish", " -l to ")])
def test_values_of_option_are_completed_behind_it_only(shell, place):
    (line,) = (row for row in script(shell).splitlines() if "convert" in row and "at2" in row)
    assert place in line


def test_it_runs_as_a_module():
    done = subprocess.run(
        [sys.executable, "-m", "rockframe", "--version"],
        capture_output=True, text=True, check=True, timeout=60,
    )  # fmt: skip
    assert done.stdout.strip() == f"rockframe {rf.__version__}"


def test_certificate_settings_are_read_from_the_scene(run_command, folder):
    settings = "\n[run.certify]\nnudge = 0.02\nruns = 60\n"
    (folder / "far.toml").write_text(TEMPLATES["block"] + settings)
    code, out, _ = run_command("certify", "far.toml")
    assert (code, "up to 2 %" in " ".join(out.split())) == (0, True)
    code, out, _ = run_command("certify", "far.toml", "--nudge", "0.005", "--json")
    answer = json.loads(out)
    assert "up to 0.5 %" in answer["certificate"]
    assert answer["certificate_runs"] <= 60


def test_case_option_refuses_repeated_or_unknown_axes(run_command, folder):
    (folder / "study.toml").write_text('scene = "scene.toml"\n[axes]\nscale = [1, 2]\n')
    assert run_command("study", "study.toml", "-o", "runs.nc")[0] == 0
    arguments = ("report", "runs.nc", "--no-certificate", "--case")
    code, _, problem = run_command(*arguments, "scale=1", "scale=2")
    assert (code, "--case: found scale twice" in problem) == (2, True)
    code, _, problem = run_command(*arguments, "scale=1", "motions=2")
    assert (code, "there is no axis 'motions'" in problem) == (2, True)
    code, _, problem = run_command("report", "runs.nc", "--motion", "record.AT2")
    assert (code, "a study takes motions=" in problem) == (2, True)


@pytest.mark.usefixtures("no_pictures")
def test_report_on_a_store_uses_its_full_name(run_command, folder, monkeypatch):
    (folder / "study.toml").write_text('scene = "scene.toml"\n[axes]\nscale = [1, 2]\n')
    assert run_command("study", "study.toml", "--store", "kept.1")[0] == 0
    arguments = ("report", "--no-certificate")
    assert run_command(*arguments, "kept.1")[:2] == (0, "Report: kept.1.html\n")
    monkeypatch.chdir(folder / "kept.1")
    assert run_command(*arguments, ".")[:2] == (0, f"Report: {folder / 'kept.1.html'}\n")


def test_answers_in_json_have_no_negative_zero(run_command):
    code, out, _ = run_command("run", "scene.toml", "--scale", "0", "--json")
    assert code == 0
    assert "-0.0," not in out


@pytest.mark.usefixtures("folder")
def test_conversion_warns_of_a_dropped_vertical_component(run_command):
    pulse = rf.GroundMotion.sine_pulse("3 m/s^2", "2 Hz")
    pulse.with_vertical(pulse.scaled(0.5)).to_dataset().to_netcdf("both.nc")
    code, _, err = run_command("convert", "both.nc", "-o", "both.AT2")
    assert (code, "the vertical component is left out" in err) == (0, True)
    code, _, err = run_command("convert", "both.nc", "-o", "both.csv")
    assert (code, err) == (0, "")


@pytest.mark.usefixtures("no_pictures")
@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("run short.toml", "Not finished"),
        ("certify short.toml", "No certificate: the run was not finished"),
        ("critical short.toml --runs 5", "Verdict: No run could be finished; 5 scales tried"),
        ("fragility short.toml record.AT2 --scales 1,2", "no fit, no trials"),
        ("ida short.toml record.AT2 --scales 1,2", "2 of 2 runs of the scan have no verdict"),
        ("map short.toml --amplitude '4,5 m/s^2' --frequency '1 Hz'", "2 of 2 without a verdict"),
        ("animate short.toml -o x.html", "Not finished"),
    ],
)
def test_commands_with_unfinished_runs_exit_with_code_1(words, expected, run_command):
    text = TEMPLATES["block"].replace('"standard"', "{ rtol = 1e-8, max_steps = 20 }")
    Path("short.toml").write_text(text)
    code, out, _ = run_command(*shlex.split(words))
    assert (code, expected in " ".join(out.split())) == (1, True)
    assert "stands throughout" not in out


def test_commands_that_read_a_result_repeat_its_cautions(run_command, folder):
    moving = TEMPLATES["block"].replace('free_vibration = "5 s"', 'duration = "0.55 s"')
    (folder / "moving.toml").write_text(moving.replace('"-5 m/s^2"', '"-14 m/s^2"'))
    words = "warning: the run ends while the body, which counts as standing, still has the energy"
    for command in ("run moving.toml -o out.nc", "plot out.nc -o x.png", "animate out.nc -o x.html",
                    "report out.nc --no-certificate"):  # fmt: skip
        code, _, err = run_command(*command.split())
        assert (code, words in " ".join(err.split())) == (0, True), command


def test_plot_of_three_axes_is_refused_with_an_alternative(run_command, folder):
    axes = '[axes]\nscale = [1, 2]\nwidth = ["0.8 m", "0.9 m"]\nheight = ["3 m", "3.2 m"]\n'
    (folder / "study.toml").write_text(f'scene = "scene.toml"\n{axes}')
    run_command("template")
    assert run_command("study", "study.toml", "-o", "runs.nc")[0] == 0
    code, _, err = run_command("plot", "runs.nc", "-o", "runs.png")
    assert code == 2
    assert "runs.nc: found a study with more than 2 axes" in err
    assert "(scale, width, height)" in err
    assert "'rockframe report' lists its cases" in err


def test_a_study_of_two_axes_and_one_motion_is_drawn(run_command, folder):
    (folder / "study.toml").write_text(TEMPLATES["study"])
    assert run_command("study", "study.toml")[0] == 0
    assert run_command("plot", "study.nc", "-o", "study.png")[0] == 0


def test_axis_of_a_stack_part_is_refused_for_a_file(run_command, folder):
    axes = '[axes]\nwidth = ["0.8 m", "0.9 m"]\n'
    (folder / "study.toml").write_text(f'scene = "statue.toml"\n{axes}')
    (folder / "statue.toml").write_text(TEMPLATES["statue"])
    code, _, err = run_command("study", "study.toml")
    assert code == 2
    assert "a part of the Stack; no file of a study varies it: write a scene for each" in err
    assert "function" not in err


@pytest.mark.parametrize(
    "name", ["run", "certify", "critical", "animate", "fragility", "ida", "map"]
)
def test_help_offers_the_accuracies_that_a_command_takes(name, run_command):
    _, text, _ = run_command(name, "--help")
    assert ("screen" in text) == (name in {"fragility", "ida", "map"})
