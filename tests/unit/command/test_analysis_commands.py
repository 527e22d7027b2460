"""Analysis commands give the results of the functions."""

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import rockframe as rf
from rockframe.command.files.templates import TEMPLATES

pytestmark = pytest.mark.unit

BLOCK = rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t")
AFTER = {"free_vibration": "5 s"}


@pytest.fixture
def records(folder):
    """Return a folder of records of different strengths."""
    (folder / "records").mkdir()
    for number in range(5):
        pulse = rf.GroundMotion.sine_pulse(f"{-3 - 0.6 * number} m/s^2", "1 Hz")
        pulse.to_at2(f"records/{number}.AT2")
    return rf.read_suite("records")


def test_critical_command_equals_critical_scale(run_command):
    arguments = ("critical", "scene.toml", "-m", "record.AT2", "--runs", "60", "--largest", "3")
    code, out, _ = run_command(*arguments, "-o", "c.nc", "--picture", "c.svg")
    assert code == 0
    record = rf.GroundMotion.read("record.AT2")
    expected = rf.critical_scale(
        rf.System(BLOCK), record, largest=3.0, runs=60, scales=60, intensity="PGA", **AFTER
    )
    assert f"Verdict: {expected.attrs['verdict']}" in out
    with xr.open_dataset("c.nc") as stored:
        assert float(stored.critical_scale) == float(expected.critical_scale)
    peak = float(expected.peak_ground_acceleration)
    assert f"peak ground acceleration {peak:.4g} m s^-2" in out
    assert Path("c.svg").stat().st_size > 1000
    code, out, _ = run_command(*arguments, "--json")
    answer = json.loads(out)
    assert answer["numbers"]["critical_scale"] == {
        "value": float(expected.critical_scale), "unit": "1",
    }  # fmt: skip
    assert answer["numbers"]["scale_above"]["dims"] == ["flip"]
    assert answer["numbers"]["peak_ground_acceleration"]["unit"] == "m s^-2"
    assert answer["verdict"] == expected.attrs["verdict"]


def test_a_scene_that_does_not_fall_has_no_critical_scale(run_command):
    code, out, _ = run_command("critical", "scene.toml", "--runs", "10", "--largest", "1", "--json")
    answer = json.loads(out)
    assert code == 0
    assert answer["numbers"]["critical_scale"]["value"] is None
    assert "shaking" not in answer


def test_fragility_command_prints_the_verdict_first(run_command, records):
    arguments = ("--scales", "0.5:2:0.25", "--accuracy", "fast")
    code, out, _ = run_command(
        "fragility", "scene.toml", "records", *arguments, "-o", "f.nc", "--picture", "f.png"
    )
    assert code == 0
    runs = rf.sweep(
        rf.System(BLOCK), dict(records), scale=np.arange(0.5, 2.1, 0.25), accuracy="fast", **AFTER
    )
    expected = rf.fragility(runs)
    assert out.splitlines()[0] == f"Verdict: {expected.attrs['verdict']}"
    with xr.open_dataset("f.nc") as stored:
        assert np.array_equal(stored.median_intensity, expected.median_intensity, equal_nan=True)
    assert Path("f.png").read_bytes().startswith(b"\x89PNG")


def test_fragility_command_uses_existing_runs(run_command, records):
    Path("study.toml").write_text(
        'scene = "scene.toml"\nmotions = ["records"]\nstore = "kept"\n'
        "[axes]\nscale = [0.5, 1.0, 1.5, 2.0]\n"
    )
    assert run_command("study", "study.toml", "-o", "runs.nc")[0] == 0
    verdicts = set()
    for source in ("study.toml", "runs.nc", "kept"):
        code, out, _ = run_command("fragility", source, "--limits", "uplift,0.5", "--json")
        assert code == 0
        answer = json.loads(out)
        verdicts.add(answer["verdict"])
        states = answer["numbers"]["limit_state"]["value"]
        assert states == ["uplift", "rotation 0.5", "overturning"]
    assert len(verdicts) == 1
    code, _, problem = run_command("fragility", "runs.nc", "--scales", "1,2")
    assert (code, "its runs are finished" in problem) == (2, True)


def test_ida_command_lists_capacity_of_each_record(run_command, records):
    code, out, _ = run_command(
        "ida", "scene.toml", "records", "--scales", "0.5,1,1.5,2", "-o", "i.nc", "--csv", "i.csv",
        "--picture", "i.svg",
    )  # fmt: skip
    assert code == 0
    expected = rf.incremental_dynamic_analysis(
        rf.System(BLOCK), dict(records), scale=[0.5, 1, 1.5, 2], intensity="PGA", **AFTER
    )
    assert f"Verdict: {expected.attrs['verdict']}" in out
    rows = Path("i.csv").read_text().splitlines()
    capacities = [float(row.split(",")[2]) for row in rows[1:]]
    assert capacities == expected.capacity_scale.to_numpy().ravel().tolist()
    code, _, problem = run_command("plot", "i.nc", "-o", "again.svg")
    assert code == 0
    Path("wide.toml").write_text('scene = "scene.toml"\n[axes]\nwidth = ["0.7 m", "0.9 m"]\n')
    code, out, _ = run_command(
        "ida", "wide.toml", "records", "--scales", "0.5,1,1.5,2", "-o", "w.nc"
    )
    assert (code, "2 structures by width" in out) == (0, True)
    with xr.open_dataset("w.nc") as wide:
        assert wide.capacity_scale.dims == ("limit_state", "width", "motion")
    code, _, problem = run_command("plot", "w.nc", "-o", "again.svg", "--overwrite")
    assert (code, "analysis.isel(width=0)" in problem) == (2, True)
    Path("rows.csv").write_text("width [m]\n0.7\n0.9\n")
    Path("rows.toml").write_text('scene = "scene.toml"\ncases = "rows.csv"\n')
    sweep_table = '[axes]\nscale = [1, 2]\n[sweep]\nknown = ["a"]\n'
    Path("more.toml").write_text(f'scene = "scene.toml"\n{sweep_table}')
    code, _, problem = run_command("ida", "more.toml", "records")
    assert (code, "takes no 'known' stores" in problem) == (2, True)
    code, _, problem = run_command("ida", "rows.toml", "records")
    assert (code, "no table of cases" in problem) == (2, True)


def test_map_command_prints_boundaries_at_each_frequency(run_command):
    arguments = ("--amplitude", "2:8:2 m/s^2", "--frequency", "0.5,2 Hz", "--accuracy", "fast")
    code, out, _ = run_command("map", "scene.toml", *arguments, "-o", "m.nc", "--picture", "m.png")
    assert code == 0
    pulse = rf.GroundMotion.sine_pulse("-5 m/s^2", "2 Hz")
    expected = rf.overturning_map(
        rf.System(BLOCK), pulse, amplitude=([2, 4, 6, 8], "m/s^2"),
        frequency=([0.5, 2], "Hz"), accuracy="fast", **AFTER,
    )  # fmt: skip
    first = float(expected.amplitude_above.isel(frequency=0, boundary=0))
    assert f"{first:.4g} overturns after" in out
    assert "Pulse:   sine pulse, cycles: 1\n" in out
    assert "none: stands throughout" in out
    with xr.open_dataset("m.nc") as stored:
        assert stored.amplitude_above.equals(expected.amplitude_above)
    assert run_command("map", "scene.toml", *arguments[:4], "--accuracy", "screen")[0] == 0
    code, out, _ = run_command("map", "scene.toml", *arguments, "--pulse", "cosine_pulse")
    assert (code, "Pulse:   cosine pulse" in out) == (0, True)


def test_map_command_takes_a_harmonic_motion_of_the_scene(run_command, folder):
    """Its duration, a text with a unit, ended in an error of Python; so did operations."""
    arguments = ("--amplitude", "2,8 m/s^2", "--frequency", "2 Hz", "--accuracy", "fast")
    scene = TEMPLATES["block"].replace('"sine_pulse"', '"harmonic"\nduration = "2 s"')
    (folder / "harmonic.toml").write_text(scene)
    code, out, _ = run_command("map", "harmonic.toml", *arguments)
    assert (code, "Pulse:   harmonic, duration: 2.0 s\n" in out) == (0, True)
    scaled = "operations = [{ scaled = { factor = 2 } }]\n[run]"
    (folder / "scaled.toml").write_text(TEMPLATES["block"].replace("[run]", scaled))
    code, _, problem = run_command("map", "scaled.toml", *arguments)
    assert (code, "pulse needs an amplitude and a frequency" in problem) == (2, True)


def test_map_command_replaces_no_pulse_of_the_scene_by_another(run_command, folder):
    """A map of sine pulses was printed for all of these."""
    arguments = ("--amplitude", "2,8 m/s^2", "--frequency", "2 Hz", "--accuracy", "fast")
    before, after = TEMPLATES["block"].split("[motion]", maxsplit=1)[0], "\n[run]\n"
    for pulse, expected in (
        ('"ricker_wavelet"\namplitude = "5 m/s^2"\nperiod = "2 s"', 0),
        ('"type_a_pulse"\nvelocity = "1 m/s"\nperiod = "2 s"', 2),
    ):
        scene = f"{before}[motion]\nconstructor = {pulse}{after}"
        (folder / "other.toml").write_text(scene + 'free_vibration = "5 s"')
        code, out, problem = run_command("map", "other.toml", *arguments)
        assert code == expected
        assert ("Pulse:   ricker wavelet" in out) == (code == 0)
        assert ("pulse needs an amplitude and a frequency or a period" in problem) == (code == 2)
        assert "lambda" not in problem
        assert run_command("map", "other.toml", *arguments, "--pulse", "sine_pulse")[0] == 0


@pytest.mark.usefixtures("records")
def test_pictures_of_several_motions_need_the_name_of_a_file(run_command):
    """The message was about a file called --1."""
    code, _, problem = run_command("motion", "records", "--picture", "-")
    assert (code, "-: 5 pictures do not fit into it; name" in problem) == (2, True)


def test_animate_command_writes_page_and_film(run_command):
    assert run_command("run", "scene.toml", "-o", "out.nc")[0] == 0
    code, out, _ = run_command("animate", "out.nc", "-o", "run.html", "--title", "A <tower>")
    assert (code, "Page: run.html" in out) == (0, True)
    page = Path("run.html").read_text()
    assert "A &lt;tower&gt;" in page
    assert len(page) < 200_000
    code, out, _ = run_command(
        "animate", "scene.toml", "-m", "record.AT2", "-o", "run.gif",
        "--window", "0 s", "1 s", "--speed", "5",
    )  # fmt: skip
    assert (code, "Film: run.gif" in out) == (0, True)
    assert Path("run.gif").read_bytes().startswith(b"GIF89a")


@pytest.mark.parametrize("form", ["csv", "nc", "at2"])
def test_converted_records_preserve_the_motion(run_command, folder, form):
    ending = {"at2": "AT2"}.get(form, form)
    code, *_ = run_command("convert", "record.AT2", "-o", f"other.{ending}", "--unit", "g")
    assert code == 0
    before, after = (rf.GroundMotion.read(name) for name in ("record.AT2", f"other.{ending}"))
    assert after.si.time_step == before.si.time_step
    assert after.si.horizontal.samples == pytest.approx(before.si.horizontal.samples, rel=1e-6)


def test_many_records_go_into_a_folder_or_one_file(run_command, records):
    code, *_ = run_command("convert", "records", "--to", "csv", "-o", "tables")
    assert code == 0
    assert sorted(path.name for path in Path("tables").iterdir()) == [f"{k}.csv" for k in range(5)]
    assert run_command("convert", "records", "-o", "all.nc")[0] == 0
    restored = rf.read_suite("all.nc")
    assert {motion.sha256 for motion in restored.values()} == {
        motion.sha256 for motion in records.values()
    }
    assert run_command("convert", "records", "-o", "all.nc")[0] == 0  # the input file is replaced
    code, _, problem = run_command("convert", "records", "-o", "one.AT2")
    assert (code, "5 motions do not fit into one file" in problem) == (2, True)
    assert not Path("one.AT2").exists()


def test_statue_template_equals_the_python_system(run_command):
    _, out, _ = run_command("template", "statue")
    Path("statue.toml").write_text(out)
    assert run_command("run", "statue.toml", "-o", "statue.nc")[0] == 0
    outline = [[0.05, 0], [0.65, 0], [0.55, 0.8], [0.60, 1.5], [0.35, 2.0], [0.15, 1.4]]
    statue = rf.Block.from_outline(outline, unit="m", density="2600 kg/m^3", depth="0.5 m")
    plinth = rf.Block(width="1.0 m", height="1.1 m", mass="2600 kg")
    pads = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.10)
    system = rf.System(rf.Stack(statue, plinth, interfaces=[pads]), pads)
    pulse = rf.GroundMotion.sine_pulse("-3 m/s^2", "1.5 Hz")
    with xr.open_dataset("statue.nc") as stored:
        expected = system.simulate(pulse, free_vibration="5 s")
        assert float(stored.peak_rotation) == float(expected.peak_rotation)


def test_serve_command_prints_its_address_and_exits_on_interrupt(run_command, monkeypatch):
    served, opened = [], []

    def ends(server):
        served.append(server)
        raise KeyboardInterrupt  # as Ctrl-C does

    monkeypatch.setattr("rockframe.serve.server.Server.serve_forever", ends)
    monkeypatch.setattr("webbrowser.open", opened.append)
    code, _, err = run_command("serve", "record.AT2", "--port", "0", "--browse")
    assert code == 130
    (server,) = served
    assert opened == [server.address]
    assert server.address in err
    assert server.record.keys["file"].endswith("record.AT2")
    assert server.record.motion.peak_acceleration.to("m/s^2").magnitude == pytest.approx(4.0)
    for words, message in (
        (("nothing.AT2",), "nothing.AT2"),
        (("-",), "give a file in the place of '-'"),
        (("--port", "70000"), "port 70000 cannot be opened"),
    ):
        code, _, err = run_command("serve", *words)
        assert code == 2
        assert message in err
    assert len(served) == 1


@pytest.mark.usefixtures("records")
def test_fragility_of_runs_takes_records_or_the_store(run_command, folder, monkeypatch):
    words = 'scene = "scene.toml"\nmotions = ["records"]\nstore = "kept"\n[axes]\nscale = [1, 2]\n'
    (folder / "study.toml").write_text(words)
    assert run_command("study", "study.toml", "-o", "runs.nc")[0] == 0
    monkeypatch.setattr("rockframe.studies.sweeps.study._cache", {})
    code, _, err = run_command("fragility", "runs.nc")
    assert code == 2
    assert "runs.nc: the record " in err
    assert "is not in this result; name the records after it, or the store" in err
    assert "motions=" not in err
    assert run_command("fragility", "runs.nc", "--unit", "g")[0] == 2  # nothing to read by it
    verdicts = set()
    for words in (("kept",), ("runs.nc", "records")):
        code, out, _ = run_command("fragility", *words, "--json")
        assert code == 0
        verdicts.add(json.loads(out)["verdict"])
    assert len(verdicts) == 1
