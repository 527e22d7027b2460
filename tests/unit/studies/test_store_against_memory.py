"""Analyses of a stored study equal those in memory, whatever its motions are called.

Names are unsorted and motions differ in length, so that mistaken motions change results.
"""

import inspect
import json
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest
from stored_sweep import assert_identical

import rockframe as rf
from rockframe.errors import ComponentError, StudyError
from rockframe.studies.sweeps import study as studies_at_hand
from rockframe.studies.sweeps.store import read_arrays, write_arrays

pytestmark = [
    pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning"),
    pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning"),
]

SYSTEM = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
NOISE = np.random.default_rng(5).normal(size=400)


def record(count, size):
    return rf.GroundMotion.from_arrays((size * NOISE[:count], "m/s^2"), "0.01 s", name="noise")


MOTIONS = {
    "weak": rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz"),
    "strong": rf.GroundMotion.sine_pulse("9 m/s^2", "1 Hz"),
    "10": record(400, 2.0),
    "9": record(150, 5.0),
    "Ärger / 第1": record(300, 3.0).with_vertical(record(300, 1.0)),
    "a": rf.GroundMotion.half_sine_pulse("6 m/s^2", "0.4 s"),
}
TABLE = pd.DataFrame(
    {"motion": ["strong", "10", "weak", "9", "a"], "scale": [1.0, 1.2, 0.9, 2.0, 1.5]}
)


def swept(**run):
    return rf.sweep(SYSTEM, MOTIONS, scale=[1.0, 1.5], chunk=2, **run)


def with_histories(**run):
    return rf.sweep(
        SYSTEM, MOTIONS, scale=[0.8], height=["1 m", "2 m"], chunk=5, outputs=["rotation"],
        output_step="0.01 s", points={"top": ("0 m", "2 m"), "a": ("0 m", "1 m")}, **run,
    )  # fmt: skip


def of_table(**run):
    return rf.sweep(SYSTEM, MOTIONS, cases=TABLE, height=["2 m", "1 m"], chunk=3, **run)


def dynamic_analysis(**run):
    return rf.incremental_dynamic_analysis(
        SYSTEM, MOTIONS, scale=[0.5, 1, 2], intensity="PGA", bracket_width=0.05, **run
    )


def mapped(**run):
    return rf.overturning_map(
        SYSTEM, rf.GroundMotion.sine_pulse, amplitude=([2, 4, 8], "m/s^2"),
        frequency=([0.8, 2, 10], "Hz"), bracket_width=0.05, **run,
    )  # fmt: skip


SIZES = {"periods": ([2, 4], "s"), "slenderness": [3, 4]}
SPREAD = {"scale": ("lognormal", 1.5, 0.4), "height": ("uniform", "1.8 m", "2.2 m")}
ANALYSES = {
    "sweep": [swept, with_histories, of_table],
    "incremental_dynamic_analysis": [dynamic_analysis],
    "overturning_map": [mapped],
    "rocking_spectrum": [lambda **run: rf.rocking_spectrum(SYSTEM, MOTIONS, **SIZES, **run)],
    "overturning_spectrum": [
        lambda **run: rf.overturning_spectrum(
            SYSTEM, MOTIONS, scale=[0.5, 1, 2], bracket_width=0.05, periods=([2, 4], "s"), **run
        )
    ],
    "probability_of_overturning": [
        lambda **run: rf.probability_of_overturning(
            SYSTEM, MOTIONS, spread=SPREAD, cases=24, **run
        )
    ],
    "subset_simulation": [
        lambda **run: rf.subset_simulation(
            SYSTEM, MOTIONS, spread=SPREAD, limit=0.9, cases=60, levels=2, **run
        )
    ],
    "earthquake_sequences": [
        lambda **run: rf.earthquake_sequences(
            SYSTEM,
            {"zwei": [record(400, 2.0), record(150, 5.0)], "10": [record(99, 1.0)],
             "9": [record(250, 4.0), record(400, 3.0)]},
            pause="1 s", **run,
        )
    ],
}  # fmt: skip
"""By the names of functions that have a store."""


def test_every_analysis_with_a_store_is_tested():
    public = {name: getattr(rf, name) for name in rf.__all__}
    functions = {name: one for name, one in public.items() if inspect.isfunction(one)}
    having = {
        name for name, one in functions.items() if "store" in inspect.signature(one).parameters
    }
    assert having == set(ANALYSES)


@pytest.mark.wide
@pytest.mark.parametrize(
    "run", [pytest.param(run, id=f"{name} {k}") for name, several in ANALYSES.items()
            for k, run in enumerate(several)],
)  # fmt: skip
def test_stored_study_equals_study_in_memory(run, tmp_path):
    plain = run(accuracy="fast", progress=False)
    for _ in range(2):  # run, then read
        assert_identical(run(accuracy="fast", progress=False, store=tmp_path / "study"), plain)
    chunks = sorted(tmp_path.rglob("chunk-*.arrays"))
    chunks[len(chunks) // 2].unlink()
    assert_identical(run(accuracy="fast", progress=False, store=tmp_path / "study"), plain)


@pytest.mark.parametrize("run", ANALYSES["sweep"])
def test_reopened_study_and_its_cases_equal_those_in_memory(run, tmp_path, monkeypatch):
    plain = run(accuracy="fast")
    run(accuracy="fast", store=tmp_path / "study")
    assert_identical(rf.open_study(tmp_path / "study"), plain)
    monkeypatch.setattr(studies_at_hand, "_cache", type(studies_at_hand._cache)())
    for place in np.ndindex(*plain.status.shape):
        one = plain.isel(dict(zip(plain.status.dims, place, strict=True)))
        labels = {name: one[name].item() for name in plain.status.dims}
        found = rf.case(tmp_path / "study", **labels)
        scale = one.scale.item()
        assert found.motion.sha256 == MOTIONS[one.motion.item()].scaled(scale).sha256
        again = found.simulate(outputs=None)
        assert again.peak_rotation.item() == one.peak_rotation.item()


@pytest.mark.long
def test_cases_are_found_by_motion_name_in_another_process(tmp_path):
    plain = swept(store=tmp_path / "study")
    output = subprocess.run(
        [sys.executable, "-W", "ignore", "-c",
         "import json, sys, rockframe as rf\n"
         "runs = rf.open_study(sys.argv[1])\n"
         "print(json.dumps({name: [runs.peak_rotation.sel(motion=name, scale=1.0).item(),\n"
         "    rf.case(sys.argv[1], scale=1.0, motion=name).simulate().peak_rotation.item()]\n"
         "    for name in runs.motion.values}))",
         str(tmp_path / "study")],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    expected = {
        name: [plain.peak_rotation.sel(motion=name, scale=1.0).item()] * 2 for name in MOTIONS
    }
    assert json.loads(output.stdout) == expected


def test_reordered_motions_are_refused_by_the_store(tmp_path):
    swept(store=tmp_path / "study")
    turned = dict(reversed(MOTIONS.items()))
    with pytest.raises(StudyError, match=r"differs in motions \(in their order\)"):
        rf.sweep(SYSTEM, turned, scale=[1.0, 1.5], store=tmp_path / "study")


def test_old_store_formats_are_refused(tmp_path):
    swept(store=tmp_path / "study")
    head = tmp_path / "study" / "study.json"
    text = head.read_text()
    assert '"format": 3' in text
    for former in (1, 2):
        head.write_text(text.replace('"format": 3', f'"format": {former}'))
        for read in (rf.open_study, lambda path: swept(store=path)):
            with pytest.raises(StudyError, match=r"not tell for certain whose results .* again"):
                read(tmp_path / "study")


def test_stored_mappings_retain_their_order(tmp_path):
    described = {"b": 1, "a": {"z": 1, "c": [2, {"y": 1, "d": 2}]}}
    write_arrays(tmp_path / "one", described, {"b": np.zeros(1), "a": np.ones(2)})
    again, arrays = read_arrays(tmp_path / "one")
    assert json.dumps(again) == json.dumps(described)
    assert list(arrays) == ["b", "a"]


def test_numeric_motion_names_are_unambiguous():
    one, other = MOTIONS["weak"], MOTIONS["strong"]
    with pytest.raises(StudyError, match="two entries are called '1'"):
        rf.sweep(SYSTEM, {1: one, "1": other}, scale=[1.0])
    with pytest.raises(ComponentError, match="two entries are called '1'"):
        rf.MotionSuite({1: one, "1": other})
    with pytest.raises(ComponentError, match="two entries are called '1'"):
        rf.earthquake_sequences(SYSTEM, {1: [one], "1": [other]})
    crossed = {1: one, 0: other}
    with pytest.raises(StudyError, match="0 is the name of one motion, and the place of another"):
        rf.sweep(SYSTEM, crossed, cases={"motion": [0, 1], "scale": [1.0, 1.0]})
    runs = rf.sweep(SYSTEM, crossed, cases={"motion": ["0", "1"], "scale": [1.0, 1.0]})
    assert runs.motion.values.tolist() == ["0", "1"]
    for k, motion in enumerate((other, one)):
        alone = SYSTEM.simulate(motion, outputs=None)
        assert runs.peak_rotation[k].item() == alone.peak_rotation.item()
    with pytest.raises(StudyError, match="case: 1 is the name of one motion"):
        rf.case(rf.sweep(SYSTEM, crossed), motion=1)
