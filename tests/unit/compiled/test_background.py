"""Runs start in plain Python until machine code is compiled; results do not depend on this."""

import subprocess
import sys
from typing import NamedTuple

import numpy as np
import pytest

import rockframe as rf
from rockframe.compiled import (
    COMPILED,
    BoundFunction,
    Vector,
    bind,
    expecting_remaining,
    kernel,
    numbers_in,
    parallel,
)
from rockframe.compiled.entries import Entry
from rockframe.compiled.parallel import START_AFTER, START_AT_ONCE, BackgroundCompilation
from rockframe.errors import SolverWarning
from rockframe.solve import integrate

pytestmark = [
    pytest.mark.unit,
    pytest.mark.skipif(not COMPILED, reason="compilation is off in this run"),
]


AT_WORST = 8.0
NEEDED = AT_WORST / parallel.SAFETY_FACTOR
"""Time that the jobs of a test are said to take, at worst and on an idle machine [s]."""


class Compiler:
    """Replaces a process that compiles."""

    def __init__(self):
        self.ended = None

    def poll(self):
        return self.ended


class Job:
    """Replaces a job of some functions to compile."""

    def __init__(self, *calls, is_bound=True):
        self.is_stored = False
        self.is_bound = is_bound
        self.calls = set(calls)


@pytest.fixture
def jobs(monkeypatch):
    monkeypatch.setattr(parallel, "_compilers", [])
    monkeypatch.setattr(parallel, "processors", lambda: 2)
    monkeypatch.setattr(parallel, "estimate_wall_time", lambda jobs: NEEDED)
    return [Job(), Job()]


@pytest.fixture
def started(monkeypatch):
    """Return the list of started compilers."""
    compilers = []

    def start(jobs):
        compilers.append(Compiler())
        compilers[-1].jobs = jobs
        return compilers[-1]

    monkeypatch.setattr(parallel, "start_compiler", start)
    return compilers


def spend(compilation, seconds):
    compilation._seconds += seconds


def test_stored_code_is_loaded(jobs, started):
    for job in jobs:
        job.is_stored = True
    assert BackgroundCompilation(jobs).is_due()
    assert not started


def test_only_longer_run_starts_compiler(jobs, started):
    compilation = BackgroundCompilation(jobs)
    assert not compilation.is_due()
    spend(compilation, 0.9 * START_AFTER)
    assert not compilation.is_due()
    assert not started
    spend(compilation, 0.2 * START_AFTER)
    assert not compilation.is_due()
    assert not compilation.is_due()
    assert len(started) == 1
    for job in jobs:
        job.is_stored = True
    started[0].ended = 0
    assert compilation.is_due()


def test_run_with_long_remaining_time_compiles_too(jobs, started):
    compilation = BackgroundCompilation(jobs)
    with expecting_remaining(0.9 * START_AT_ONCE):
        assert not compilation.is_due()
    assert not started
    with expecting_remaining(0.99 * AT_WORST):
        assert not compilation.is_due()
        assert not compilation.is_due()
    with expecting_remaining(1.01 * AT_WORST):
        assert compilation.is_due()
    assert len(started) == 1


def test_a_run_that_is_nearly_over_waits_for_nothing(jobs, started):
    compilation = BackgroundCompilation(jobs)
    spend(compilation, 100.0)
    with expecting_remaining(0.1):
        assert not compilation.is_due()
        assert not compilation.is_due()


def test_entry_and_cheap_extra_jobs_are_compiled_after_needed_ones(started, monkeypatch):
    monkeypatch.setattr(parallel, "_compilers", [])
    monkeypatch.setattr(
        parallel, "estimate_seconds", lambda jobs: len(set().union(*(job.calls for job in jobs)))
    )
    needed, inside, other = Job("march", "slope"), Job("slope"), Job("slope", "switch")
    entry = Job("loop", is_bound=False)
    assert not BackgroundCompilation([needed], [inside, other, entry]).is_due(at_once=True)
    assert started[0].jobs == [inside, entry, needed]  # the last job is compiled first


def test_run_compiles_too_after_exceeding_compilation_time(jobs, started):
    compilation = BackgroundCompilation(jobs)
    spend(compilation, 7.9)
    assert not compilation.is_due()
    assert not compilation.is_due()
    spend(compilation, 0.2)
    assert compilation.is_due()
    assert len(started) == 1


def test_two_processes_compile_from_both_ends(jobs, started, monkeypatch):
    compiled = []

    class Stored(Job):
        file = None

        def make(self, waiting=None):
            compiled.append(self)
            return self

    monkeypatch.setattr(parallel, "_announce", lambda jobs: None)
    monkeypatch.setattr(
        parallel, "_process", lambda *words: pytest.fail("a third compiler was started")
    )
    monkeypatch.setattr(parallel, "_jobs_in", lambda order: order)
    parallel._compilers.append(Compiler())
    stored = [Stored(), Stored(), Stored()]
    assert parallel.compile_all(stored) == stored
    assert compiled == stored
    parallel.compile_all_of(stored)
    assert compiled[3:] == stored[::-1]


def test_lanes_start_compiler_before_any_run(jobs, started):
    assert not BackgroundCompilation(jobs).is_due(at_once=True)
    assert len(started) == 1


def test_run_compiles_itself_if_no_compiler_can_start(jobs, monkeypatch):
    monkeypatch.setattr(parallel, "start_compiler", lambda jobs: None)
    compilation = BackgroundCompilation(jobs)
    spend(compilation, 7.9)
    assert not compilation.is_due()
    spend(compilation, 0.2)
    assert compilation.is_due()
    assert BackgroundCompilation(jobs).is_due(at_once=True)


def test_dead_compiler_is_not_restarted(jobs, started):
    compilation = BackgroundCompilation(jobs)
    spend(compilation, 1.0)
    assert not compilation.is_due()
    started[0].ended = 1
    assert not compilation.is_due()
    spend(compilation, 8.0)
    assert compilation.is_due()
    assert len(started) == 1


def test_no_more_compilers_at_once_than_half_the_processors(jobs, started):
    first, second = BackgroundCompilation(jobs), BackgroundCompilation([Job()])
    for compilation in (first, second):
        spend(compilation, 1.0)
        assert not compilation.is_due()
    assert len(started) == 1
    started[0].ended = 0
    assert not second.is_due()
    assert len(started) == 2


def test_undescribable_job_is_compiled_immediately():
    class Broken:
        @property
        def is_stored(self):
            raise TypeError

    assert BackgroundCompilation([Broken()]).is_due()


class Slope(NamedTuple):
    slope: float


@kernel
def force_of(law: Slope, x: float) -> float:
    return law.slope * x


@kernel
def stored_in(law: Slope, x: float) -> float:
    return 0.5 * law.slope * x * x


def call_on(function: BoundFunction, values: Vector, numbers: Vector) -> int:
    values[0] = function.call(values[0], numbers)
    return 0


def test_non_waiting_entry_compiles_only_quick_code(tmp_path, monkeypatch):
    monkeypatch.setenv("ROCKFRAME_CACHE_DIR", str(tmp_path))
    force, stored = bind((force_of, stored_in), Slope(2.0))
    values, numbers = np.array([1.5]), numbers_in(Slope(2.0))
    Entry(call_on)(force, values, numbers)
    for function, compiled in ((force, True), (stored, False)):  # only the first is compiled
        later = Entry(call_on, waits=False)
        assert later(function, values, numbers) == 0
        (routine,) = later._routines.values()
        assert (routine.code is not None) is compiled
    assert values.tolist() == [36.0]


PADS = rf.TwoSpringSupport(stiffness="5 MN/m", damping_ratio=0.1)
BLOCK = rf.Block(width="0.5 m", height="2 m", mass="1 t")
RUN = """
import sys, time
import numpy as np
from rockframe.compiled import Vector, background_entry

@background_entry
def add_up(values: Vector) -> None:
    for _ in range(20_000):
        for i in range(len(values)):
            values[i] += 0.1 * i

if __name__ == "__main__":
    from slow import add_up
    codes, begun = [], time.monotonic()
    while time.monotonic() - begun < 120.0 and not (codes and codes[-1]):
        values = np.zeros(5)
        add_up(values)
        codes.append(any(routine.code for routine in add_up._routines.values()))
        time.sleep(0.05)  # another process needs the processor
        print(codes[-1], values.tolist())
"""


@pytest.mark.wide
def test_call_switches_to_machine_code_of_other_process(tmp_path):
    (tmp_path / "slow.py").write_text(RUN)
    environment = {"PYTHONPATH": ":".join(sys.path), "ROCKFRAME_CACHE_DIR": str(tmp_path / "code")}
    lines = subprocess.run(
        [sys.executable, "slow.py"], cwd=tmp_path, env=environment, check=True, text=True,
        capture_output=True,
    ).stdout.splitlines()  # fmt: skip
    code, values = zip(*(line.split(" ", 1) for line in lines), strict=True)
    if parallel.processors() > 1:
        assert code[0] == "False"
    assert code[-1] == "True"
    assert len(set(values)) == 1


@pytest.mark.parametrize(
    ("supports", "accuracy"),
    [
        ((), "standard"),
        ((PADS,), "fast"),
        pytest.param((), "fast", marks=pytest.mark.long),
        pytest.param((PADS,), "standard", marks=pytest.mark.long),
    ],
)
def test_pausing_run_gives_identical_results(monkeypatch, accuracy, supports):
    rng = np.random.default_rng(1)
    motion = rf.GroundMotion.from_arrays((5.0 * rng.normal(size=300), "m/s^2"), "0.02 s")
    system = rf.System(BLOCK, *supports)
    uninterrupted = system.simulate(motion, accuracy=accuracy, outputs=["energy"], duration="9 s")
    counts = []
    advance = integrate.advance

    def count_steps(*arguments):
        counts.append(advance(*arguments))
        return counts[-1]

    monkeypatch.setattr(integrate, "_steps_to_pause", lambda equations: 7)
    monkeypatch.setattr(integrate, "advance", count_steps)
    paused = system.simulate(motion, accuracy=accuracy, outputs=["energy"], duration="9 s")
    assert len(counts) > 20
    assert uninterrupted.drop_attrs().identical(paused.drop_attrs())
    assert uninterrupted.attrs["verdict"] == paused.attrs["verdict"]


def test_step_limit_ends_pausing_run(monkeypatch):
    motion = rf.GroundMotion.harmonic("1 m/s^2", "2 Hz", duration="5 s")
    system = rf.System(BLOCK, PADS)
    accuracy = rf.Accuracy(rtol=1e-9, max_steps=100)
    with pytest.warns(SolverWarning, match="limit of steps"):
        uninterrupted = system.simulate(motion, accuracy=accuracy)
    monkeypatch.setattr(integrate, "_steps_to_pause", lambda equations: 7)
    with pytest.warns(SolverWarning, match="limit of steps"):
        paused = system.simulate(motion, accuracy=accuracy)
    assert paused.drop_attrs().identical(uninterrupted.drop_attrs())
