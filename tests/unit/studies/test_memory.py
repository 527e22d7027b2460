"""Memory of a study: estimated before it begins, and refused if there is not enough."""

import tracemalloc

import numpy as np
import pytest

import rockframe as rf
from rockframe.errors import SolverWarning, StudyError
from rockframe.studies.sweeps import planning

SYSTEM = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
PULSE = rf.GroundMotion.sine_pulse("3 m/s^2", "1 Hz")
SPREAD = {"scale": ("lognormal", 1.0, 0.4)}
MANY = 30_000


@pytest.mark.parametrize(
    "study",
    [
        lambda: rf.sweep(
            SYSTEM, PULSE, scale=np.arange(1.0, MANY), height=(np.arange(1.0, MANY), "m")
        ),
        lambda: rf.probability_of_overturning(SYSTEM, PULSE, spread=SPREAD, cases=900_000_000),
        lambda: rf.subset_simulation(SYSTEM, PULSE, spread=SPREAD, cases=9_000_000),
        lambda: rf.rocking_spectrum(
            SYSTEM, PULSE, periods=(np.linspace(2, 3, 200), "s"),
            slenderness=np.linspace(3, 4, 50),
        ),
        lambda: rf.overturning_map(
            SYSTEM, rf.GroundMotion.sine_pulse, amplitude=(np.linspace(1, 2, 20_000), "m/s^2"),
            frequency=(np.linspace(1, 2, 50), "Hz"),
        ),
    ],
)  # fmt: skip
def test_study_larger_than_memory_is_refused_before_running(study, monkeypatch):
    monkeypatch.setattr(planning, "available_memory", lambda: 2e6)
    with pytest.raises(StudyError, match=r"cases need about .* [GM]B of memory .*; 2 MB are ava"):
        study()


def test_study_using_most_of_memory_warns(monkeypatch):
    monkeypatch.setattr(planning, "available_memory", lambda: 7e4)
    with pytest.warns(SolverWarning, match=r"sweep: 100 cases need about 0.058 MB of memory"):
        runs = rf.sweep(SYSTEM, PULSE, scale=np.linspace(0.1, 1, 100), free_vibration="5 s")
    assert runs.overturned.notnull().all()


def test_estimated_memory_matches_measured_memory(monkeypatch):
    motions = [PULSE, PULSE.scaled(1.1)]
    sizes = []  # of scalars, of histories, of both, and available
    monkeypatch.setattr(planning, "available_memory", lambda: 1e12)
    shown = planning._size_words
    monkeypatch.setattr(planning, "_size_words", lambda size: sizes.append(size) or shown(size))
    arguments = {
        "scale": np.linspace(0.1, 0.2, 40), "outputs": ["rotation", "base_shear"],
        "output_step": "1 ms", "duration": "5 s", "progress": False,
    }  # fmt: skip
    rf.sweep(SYSTEM, motions, **{**arguments, "scale": [0.1, 0.2]})  # warm-up
    sizes.clear()
    tracemalloc.start()
    try:
        rf.sweep(SYSTEM, motions, **arguments)
        taken = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert taken == pytest.approx(sizes[2], rel=0.3)
    assert sizes[2] > 1.5e7


def test_available_memory_is_the_smallest_limit(monkeypatch, tmp_path):
    machine, most, now, parts = (tmp_path / name for name in ("meminfo", "max", "current", "stat"))
    monkeypatch.setattr(planning, "_MEMINFO", machine)
    monkeypatch.setattr(planning, "_CGROUP_FILES", ((most, now, parts),))
    assert planning.available_memory() > 1e7  # of the machine, or infinite
    machine.write_text("MemTotal: 9 kB\nMemAvailable:   4000 kB\n")
    assert planning.available_memory() == 4096e3
    most.write_text("max\n")
    now.write_text("1000000\n")
    assert planning.available_memory() == 4096e3
    most.write_text("3000000\n")
    assert planning.available_memory() == 2e6
    most.write_text("900000\n")
    assert planning.available_memory() == 0.0
    parts.write_text("file 800000\ninactive_file 600000\n")  # contents of files can be dropped
    assert planning.available_memory() == 5e5
    parts.write_text("inactive_file 0\ntotal_inactive_file 700000\n")
    assert planning.available_memory() == 6e5
