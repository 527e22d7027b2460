"""Running a sweep: failing cases, histories, executors, interrupts, and single cases."""

import _thread
import itertools
import json
import logging
import os
import signal
import sys
import threading
import time
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import nullcontext
from multiprocessing import get_context

import numpy as np
import pytest
import xarray as xr
from interrupting import Interrupting
from records import record_path

import rockframe as rf
from rockframe.compiled import COMPILED
from rockframe.errors import (
    ComponentError,
    ModelWarning,
    SchemaError,
    SolverWarning,
    StudyError,
    UnitsError,
)
from rockframe.results.variables.runs import RunStatus
from rockframe.simulation import run as of_a_run
from rockframe.simulation.soundness import STILL_MOVING
from rockframe.solve.workspace import Status
from rockframe.studies.sweeps import execution, labelling
from rockframe.studies.sweeps import study as studies_at_hand
from rockframe.studies.sweeps.axes import SYSTEM_AXES, Changes

BLOCK = rf.Block(width="0.8 m", height="3.6 m", mass="4 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
SYSTEM = rf.System(BLOCK, PADS)
PULSE = rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz")
SHAKING = rf.GroundMotion.stochastic(6.0, "10 km", seed=4).window("0 s", "8 s")
FAST = {"accuracy": "fast", "free_vibration": "1 s"}


def are_equal(one, other):
    """Return whether two sweeps are equal bit for bit, apart from the time of day."""
    one, other = one.copy(), other.copy()
    del one.attrs["history"], other.attrs["history"]
    assert one.identical(other)
    for name, variable in one.variables.items():
        assert (
            variable.dtype.kind in "OU" or variable.values.tobytes() == other[name].values.tobytes()
        )
    return True


def on_pads(frequency_ratio, height):
    return rf.System(BLOCK.replace(height=height), PADS.replace(frequency_ratio=frequency_ratio))


def example_sweep(**means):
    """Sweep with failures, two motions, and histories."""
    return rf.sweep(
        on_pads, {"pulse": PULSE, "shaking": SHAKING}, scale=[0.5, 1.0, 2.0],
        frequency_ratio=[10, 15], height=["1e200 m", "3 m", "4 m"], **FAST,
        outputs=["rotation", "contact_state"], output_step="0.05 s", **means,
    )  # fmt: skip


@pytest.fixture(scope="module")
def reference_sweep():
    with (
        pytest.warns(SolverWarning, match="12 of 36 cases have no result"),
        ThreadPoolExecutor(1) as one,
    ):
        return example_sweep(executor=one, chunk=36)


POOLS = {
    "own threads": nullcontext,
    "one thread": lambda: ThreadPoolExecutor(1),
    "eight threads": lambda: ThreadPoolExecutor(8),
    "two processes": lambda: ProcessPoolExecutor(2, mp_context=get_context("spawn")),
}


@pytest.mark.parametrize(
    "who",
    [
        "own threads",
        pytest.param("one thread", marks=pytest.mark.long),
        "eight threads",
        pytest.param("two processes", marks=pytest.mark.wide),
    ],
)
@pytest.mark.filterwarnings("ignore::rockframe.errors.SolverWarning")
def test_cases_do_not_depend_on_chunks_or_executor(reference_sweep, who):
    with POOLS[who]() as pool:
        for chunk in (7, 1000) if who == "two processes" else (1, 7, 1000):
            assert are_equal(example_sweep(chunk=chunk, executor=pool), reference_sweep)


def test_failed_cases_are_gaps_with_a_message(reference_sweep):
    refused = reference_sweep.sel(height=1e200)
    assert (refused.status == RunStatus.REFUSED).all()
    messages = reference_sweep.message
    assert messages.dims == reference_sweep.status.dims
    assert all("moment of inertia" in text for text in messages.sel(height=1e200).values.ravel())
    assert set(messages.sel(height=[3.0, 4.0]).values.ravel()) <= {"none", STILL_MOVING}
    for name in labelling.COMMON_SCALARS:
        assert reference_sweep[name].dtype == np.float64
        assert refused[name].isnull().all()
    rest = reference_sweep.sel(height=[3.0, 4.0])
    assert rest.overturned.notnull().all()
    assert reference_sweep.attrs["verdict"].endswith("; 12 have no result.")
    assert "12 have" in reference_sweep.attrs["verdict"]
    with pytest.raises(ComponentError, match="moment of inertia"):
        rf.case(reference_sweep, scale=1.0, frequency_ratio=10, height=1e200, motion="pulse")


def test_histories_share_a_time_axis(reference_sweep):
    assert reference_sweep.rotation.dims == (*reference_sweep.status.dims, "time")
    assert "angular_velocity" not in reference_sweep
    np.testing.assert_array_equal(reference_sweep.time, np.arange(reference_sweep.time.size) * 0.05)
    assert reference_sweep.time[-1].item() == pytest.approx(9.0)
    for motion, end in (("pulse", 2.0), ("shaking", 9.0)):
        case = rf.case(reference_sweep, scale=1.0, frequency_ratio=15, height=4.0, motion=motion)
        alone = case.simulate()
        case = reference_sweep.sel(scale=1.0, frequency_ratio=15, height=4.0, motion=motion)
        assert alone.time[-1].item() == pytest.approx(end)
        for name in ("rotation", "contact_state"):
            np.testing.assert_array_equal(case[name][: alone.time.size], alone[name])
            assert case[name][alone.time.size :].isnull().all()
        scalars = [name for name in case.data_vars if not case[name].dims and name in alone]
        assert len(scalars) > 10
        for name in scalars:
            np.testing.assert_array_equal(case[name], alone[name], err_msg=name)


def test_run_ending_between_samples_adds_no_time():
    runs = rf.sweep(
        SYSTEM, PULSE, scale=[3.0], outputs=(), output_step="0.1 s", free_vibration="3 s"
    )
    assert runs.overturned.all()
    alone = rf.case(runs).simulate()
    inside = alone.time < alone.time[-1]
    assert alone.time[-1].item() % 0.1 != 0.0
    samples = runs.rotation.squeeze().dropna("time")
    np.testing.assert_array_equal(samples, alone.rotation[inside])
    assert {"left_reaction", "base_shear", "peak_base_shear"} <= set(runs.data_vars)
    assert runs.peak_base_shear.item() == alone.peak_base_shear.item()


def test_unfinished_runs_have_a_status():
    few = rf.Accuracy(rtol=1e-6, max_steps=450)
    with pytest.warns(
        SolverWarning, match=r"1 of 2 cases have no result.*limit of steps"
    ) as caught:
        runs = rf.sweep(SYSTEM, PULSE, scale=[0.5, 1.2], accuracy=few, duration="3 s")
    assert len(caught) == 1
    first, second = runs.isel(motion=0, scale=0), runs.isel(motion=0, scale=1)
    broken = first if first.status == Status.STEP_LIMIT else second
    assert broken.status.item() == Status.STEP_LIMIT
    assert broken.peak_rotation.isnull()
    assert "limit of steps" in broken.message.item()


def test_sweep_statuses_extend_run_statuses():
    own = {one.name: int(one) for one in RunStatus}
    assert {one.name: int(one) for one in Status}.items() <= own.items()
    assert set(own) - {one.name for one in Status} == {"REFUSED", "NOT_RUN"}


def test_warnings_of_runs_are_stored_and_summarized():
    lifting = PULSE.with_vertical(PULSE.scaled(6.0))
    system = rf.System(BLOCK)
    with pytest.warns(
        ModelWarning, match="1 of 2 cases have a result to be careful with"
    ) as caught:
        runs = rf.sweep(system, [PULSE, lifting], scale=[1.0], **FAST)
    assert len(caught) == 1
    text = runs.message[0, 1].item()
    with pytest.warns(ModelWarning):
        assert system.simulate(lifting, **FAST, outputs=None).attrs["cautions"] == text
    assert runs.peak_rotation.notnull().all()


@pytest.mark.parametrize(
    "scene", [SYSTEM, lambda frequency_ratio: on_pads(frequency_ratio, "3.6 m")]
)
def test_warnings_of_scenes_are_stored(scene):
    with pytest.warns(
        ModelWarning, match="1 of 2 cases have a result to be careful with"
    ) as caught:
        runs = rf.sweep(scene, PULSE, frequency_ratio=[5, 20], **FAST)
    assert len(caught) == 1
    assert "too soft to hold" in runs.message.values[0, 0]
    assert runs.message.values[1, 0] == "none"


def test_exception_in_scene_function_fails_only_its_case():
    def scene(width):
        if width.m_as("m") > 1.0:
            1 / 0  # noqa: B018
        return rf.System(BLOCK, PADS) if width.m_as("m") > 0.5 else None

    with pytest.warns(SolverWarning, match="2 of 3"):
        runs = rf.sweep(scene, PULSE, width=["0.4 m", "0.8 m", "1.2 m"], **FAST)
    messages = runs.message.values[:, 0].tolist()
    assert "must return a System, got None" in messages[0]
    assert messages[1:] == ["none", "ZeroDivisionError: division by zero"]
    assert runs.status.values[:, 0].tolist() == [RunStatus.REFUSED, 0, RunStatus.REFUSED]


@pytest.mark.wide
@pytest.mark.skipif(not COMPILED, reason="plain Python holds the interpreter")
def test_compiled_integration_releases_the_gil():
    record = rf.GroundMotion.from_arrays(
        (np.random.default_rng(1).normal(size=400_000), "m/s^2"), "0.005 s"
    )
    plan = {"accuracy": "reference", "outputs": None}
    SYSTEM.simulate(PULSE, **plan)
    longest, running = [0.0], threading.Event()

    def look():
        running.wait()
        last = time.perf_counter()
        while running.is_set():
            time.sleep(0.001)
            now = time.perf_counter()
            longest[0], last = max(longest[0], now - last), now

    watcher = threading.Thread(target=look)
    watcher.start()
    running.set()
    begun = time.perf_counter()
    SYSTEM.simulate(record, **plan)
    took = time.perf_counter() - begun
    running.clear()
    watcher.join()
    assert took > 0.5
    assert longest[0] < 0.5 * took


def test_interrupt_returns_finished_cases():
    scales = np.linspace(0.1, 2.0, 20)
    with pytest.warns(SolverWarning) as caught:
        runs = rf.sweep(SYSTEM, PULSE, scale=scales, **FAST, chunk=3, executor=Interrupting(4))
    assert "interrupted" in str(caught[0].message)
    assert "8 of 20 cases have not been run" in str(caught[1].message)
    assert (runs.status[:12] == 0).all()
    assert (runs.status[12:] == RunStatus.NOT_RUN).all()
    assert runs.peak_rotation[12:].isnull().all()
    complete = rf.sweep(SYSTEM, PULSE, scale=scales, **FAST)
    np.testing.assert_array_equal(runs.peak_rotation[:12], complete.peak_rotation[:12])


@pytest.mark.wide
@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_sigint_interrupts_own_threads(request):
    calls = itertools.count()

    def scene(height):
        if next(calls) == 100:
            os.kill(os.getpid(), signal.SIGINT)
        time.sleep(0.01)
        return on_pads(20, height)

    # a background process of a shell ignores the signal
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    request.addfinalizer(lambda: signal.signal(signal.SIGINT, before))
    rf.sweep(scene, PULSE, height=([3.0], "m"), **FAST)  # loads machine code, or compiles it
    heights = np.linspace(3.0, 4.0, 2000)
    with pytest.warns(SolverWarning, match="not been run"):
        runs = rf.sweep(scene, PULSE, height=(heights, "m"), **FAST, chunk=5)
    done = runs.status == 0
    assert 0 < int(done.sum()) < 2000
    assert runs.peak_rotation.where(done, drop=True).notnull().all()


def test_interrupt_does_not_wait_for_a_compilation(monkeypatch, request):
    """A thread that compiles looks at nothing else before it has its code."""
    compiles, compiled = threading.Event(), threading.Event()

    def compiling_chunk(job, stopped):
        compiles.set()
        assert compiled.wait(60.0)

    def interrupt():
        assert compiles.wait(60.0)
        time.sleep(0.3)  # the thread has started, and its caller waits for results
        _thread.interrupt_main()

    monkeypatch.setattr(execution, "run_chunk", compiling_chunk)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    request.addfinalizer(lambda: signal.signal(signal.SIGINT, before))
    request.addfinalizer(compiled.set)
    threading.Thread(target=interrupt).start()
    began = time.perf_counter()
    with pytest.warns(SolverWarning, match="not been run"):
        rf.sweep(SYSTEM, PULSE, scale=[1.0, 2.0], **FAST)
    assert time.perf_counter() - began < 30.0


class Broken(Executor):
    def submit(self, function, /, *arguments, **options):
        found = Future()
        found.set_exception(OSError("the worker has died"))
        return found


def test_failing_executor_raises():
    with pytest.raises(StudyError, match="OSError: the worker has died"):
        rf.sweep(SYSTEM, PULSE, scale=[1.0], executor=Broken(), **FAST)
    with ProcessPoolExecutor(1) as pool, pytest.raises(StudyError, match="must be importable"):
        rf.sweep(lambda width: SYSTEM, PULSE, width=["1 m"], executor=pool, **FAST)


def test_dask_runs_it_too():
    distributed = pytest.importorskip("distributed", reason="dask.distributed is not installed")
    logging.getLogger("distributed").setLevel(logging.ERROR)
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as all_,
        distributed.Client(all_) as client,
    ):
        scales = np.linspace(0.1, 2.0, 9)
        runs = rf.sweep(
            SYSTEM, PULSE, scale=scales, executor=client.get_executor(), chunk=2, **FAST
        )
    assert are_equal(runs, rf.sweep(SYSTEM, PULSE, scale=scales, **FAST))


def test_a_bar_counts_the_cases(capsys):
    pytest.importorskip("tqdm", reason="tqdm is not installed")
    rf.sweep(SYSTEM, PULSE, scale=[0.5, 1.0], progress=None, **FAST)
    rf.sweep(SYSTEM, PULSE, scale=[0.5, 1.0], progress=False, **FAST)
    assert capsys.readouterr().err == ""
    rf.sweep(SYSTEM, PULSE, scale=[0.5, 0.6, 0.8, 1.0], chunk=1, progress=True, **FAST)
    shown = capsys.readouterr().err
    assert "sweep: 100%" in shown
    assert "4/4" in shown


def test_missing_tqdm_raises_only_if_progress_is_requested(monkeypatch):
    monkeypatch.setitem(sys.modules, "tqdm", None)
    assert rf.sweep(SYSTEM, PULSE, scale=[0.5], **FAST).status.item() == 0
    with pytest.raises(ComponentError, match=r"rockframe\[progress\]"):
        rf.sweep(SYSTEM, PULSE, scale=[0.5], progress=True, **FAST)


@pytest.mark.filterwarnings("ignore::rockframe.errors.RecordWarning")
def test_case_is_found_by_labels_motions_and_scene(tmp_path, monkeypatch):
    record = rf.GroundMotion.read(record_path("ElCentro1940_Peknold.AT2")).window("0 s", "4 s")
    runs = rf.sweep(SYSTEM, [PULSE, record], scale=[1.0, 2.0], **FAST)
    runs.to_netcdf(tmp_path / "runs.nc")
    # as in another process
    monkeypatch.setattr(studies_at_hand, "_cache", type(studies_at_hand._cache)())
    with xr.open_dataset(tmp_path / "runs.nc") as again:
        assert (
            rf.case(again, scale=2.0, motion=0).simulate().peak_rotation == runs.peak_rotation[1, 0]
        )
        with pytest.raises(StudyError, match="must be given, as motions="):
            rf.case(again, scale=2.0, motion=1)
        with pytest.raises(StudyError, match="is not among those given"):
            rf.case(again, scale=2.0, motion=1, motions=PULSE)
        found = rf.case(again, scale=2.0, motion=record.name, motions=[PULSE, record])
        assert found.simulate().peak_rotation == runs.peak_rotation[1, 1]
        assert rf.System.from_dataset(again) == SYSTEM
    made = rf.sweep(on_pads, PULSE, frequency_ratio=[10, 20], height=["3.6 m"], **FAST)
    studies_at_hand._cache.clear()
    with pytest.raises(StudyError, match="the function on_pads; give it as scene="):
        rf.case(made, frequency_ratio=10)
    alone = rf.case(made, frequency_ratio=10, scene=on_pads)
    assert alone.simulate().peak_rotation == made.peak_rotation[0, 0, 0]


def test_unknown_history_of_a_sweep_warns():
    options = {"scale": [0.5, 1.0], "duration": "0.1 s", "accuracy": "fast"}
    with pytest.warns(ModelWarning, match="outputs names 'slip', which no scene of the cases has"):
        runs = rf.sweep(SYSTEM, PULSE, outputs=["slip", "rotation"], **options)
    assert runs.rotation.dims == ("scale", "motion", "time")
    with pytest.raises(StudyError, match="a sweep keeps histories over time alone, and at points"):
        rf.sweep(SYSTEM, PULSE, outputs=["body_rotation"], **options)


def test_analysis_rounds_do_not_evict_records_of_sweeps(monkeypatch):
    monkeypatch.setattr(studies_at_hand, "_CACHE_SIZE", 2)
    pulse = np.sin(np.linspace(0.0, 2.0 * np.pi, 51))
    record, rigid = rf.GroundMotion.from_arrays((pulse, "m/s^2"), "0.02 s"), rf.System(BLOCK)
    runs = rf.sweep(rigid, record, **FAST)
    analysis = rf.incremental_dynamic_analysis(rigid, record, scale=[1.0, 20.0], **FAST)
    assert analysis.capacity_scale.max() < 20.0  # further rounds have found it
    assert rf.case(runs).motion.sha256 == record.sha256
    assert rf.case(analysis, scale=20.0).motion.sha256 == record.scaled(20.0).sha256


def test_a_case_may_be_picked_from_a_part_of_a_sweep():
    motions = {"one": PULSE, "two": PULSE.scaled(1.5), "three": PULSE.scaled(2.0)}
    table = {"width": ["0.7 m", "0.8 m", "0.9 m"]}
    runs = rf.sweep(SYSTEM, motions, cases=table, scale=[0.5, 1.0, 1.5], **FAST)
    part = runs.isel(case=[2, 1], motion=[0, 2]).sel(scale=1.5)
    case = rf.case(part, case=1, motion="three")
    assert case.motion == motions["three"].scaled(1.5)
    assert case.system.parts.block.si.width == 0.8
    assert rf.case(part, case=1, motion=1, scale=1.5).motion == case.motion
    assert rf.case(part.isel(case=0, motion=1)).system.parts.block.si.width == 0.9
    peak = part.sel(case=1, motion="three").peak_rotation.item()
    assert case.simulate().peak_rotation.item() == peak
    with pytest.raises(StudyError, match=r"scale has no 0\.5; it has 1\.5"):
        rf.case(part, case=1, motion=1, scale=0.5)
    with pytest.raises(SchemaError, match="without its coordinate 'scale'"):
        rf.case(part.drop_vars("scale"), case=1, motion=1)


def test_missing_cases_are_refused():
    runs = rf.sweep(SYSTEM, PULSE, scale=[1.0, 2.0], width=["0.7 m", "0.8 m"], **FAST)
    for labels, words in (
        ({"scale": 1.0}, "give a value of 'width'"),
        (
            {"scale": 1.0, "depth": 2.0},
            "no axis 'depth'; there are .*, motion; was 'width' meant",
        ),
        ({"scale": 1.5, "width": "0.7 m"}, "scale has no 1.5; it has 1.0, 2.0"),
        ({"scale": 1.0, "width": 0.7, "motion": 1}, "there is no motion 1; expected a name"),
        ({"scale": 1.0, "width": 0.7, "motion": [0]}, r"there is no motion \[0\]; expected a name"),
    ):
        with pytest.raises(StudyError, match=words):
            rf.case(runs, **labels)
    part = runs.isel(width=0, scale=0)
    assert rf.case(part, motion="0").motion == rf.case(part, motion=0).motion
    for wanted in (1, "1"):  # the name of the first as in tables, and the position of the second
        two = rf.sweep(SYSTEM, {"01": PULSE, "02": PULSE.scaled(2)}, **FAST)
        with pytest.raises(StudyError, match="give the name, '01'"):
            rf.case(two, motion=wanted)
    with pytest.raises(UnitsError, match="width"):
        rf.case(runs, scale=1.0, width="0.7 kg")
    with pytest.raises(SchemaError, match="no sweep"):
        rf.case(SYSTEM.simulate(PULSE, **FAST), scale=1.0)


def test_integrator_is_called_once_per_case(monkeypatch):
    calls = []
    integrate = of_a_run.integrate
    monkeypatch.setattr(
        of_a_run, "integrate", lambda *a, **k: calls.append(1) or integrate(*a, **k)
    )
    rf.sweep(SYSTEM, PULSE, scale=[0.5, 1.0], damping_ratio=[0.1, 0.2, 0.3], **FAST)
    assert len(calls) == 6


def test_initial_state_axes_set_the_start_of_runs(monkeypatch):
    from rockframe.studies.sweeps import study

    axes = {
        "initial_rotation": ["-2 deg", "0.5 deg", "3 deg"],
        "initial_angular_velocity": ([0.0, 0.2], "rad/s"),
        "frequency_ratio": [15.0, 25.0],
    }
    system = rf.System(
        rf.Block(width="0.8 m", height="3.6 m", mass="4 t"),
        rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1),
    )
    found = []
    monkeypatch.setattr(study, "COMPILING_SHARE", np.inf)
    for fewest in (1, 10**9):
        monkeypatch.setattr(study, "MIN_CASES_IN_LANES", fewest)
        start = rf.InitialState(vertical_velocity="0.01 m/s")
        runs = rf.sweep(system, None, **axes, duration="3 s", initial=start, accuracy="fast")
        found.append(runs.drop_attrs(deep=False))
    xr.testing.assert_identical(*found)
    assert runs.initial_rotation.attrs == {"long_name": "initial rotation", "units": "rad"}
    for labels in (
        {"initial_rotation": "3 deg", "initial_angular_velocity": 0.2, "frequency_ratio": 15},
        {"initial_rotation": "-2 deg", "initial_angular_velocity": 0.0, "frequency_ratio": 25},
    ):
        one = rf.case(runs, **labels)
        angle = float(rf.InitialState(rotation=labels["initial_rotation"]).si.rotation)
        same = rf.System(
            system.parts.block,
            rf.TwoSpringSupport(frequency_ratio=labels["frequency_ratio"], damping_ratio=0.1),
        ).simulate(
            duration="3 s",
            initial=rf.InitialState(
                rotation=f"{angle!r} rad",
                angular_velocity=f"{labels['initial_angular_velocity']} rad/s",
                vertical_velocity="0.01 m/s",
            ),
            accuracy="fast",
        )
        alone = one.simulate()
        assert float(alone.rotation[0]) == angle
        picked = runs.sel(
            initial_rotation=angle,
            initial_angular_velocity=labels["initial_angular_velocity"],
            frequency_ratio=labels["frequency_ratio"],
        ).squeeze()
        for run in (alone, same):
            assert float(run.peak_rotation) == float(picked.peak_rotation)
    with pytest.warns(SolverWarning, match="not below the overturning angle"):
        rf.sweep(system, initial_rotation=["40 deg"], duration="1 s", accuracy="fast")
    with pytest.raises(StudyError, match="initial_rotation needs an angle"):
        rf.sweep(system, initial_rotation=[0.1], duration="1 s")


@pytest.mark.parametrize(
    ("axis", "changes"),
    [
        ({"width": ["0.8 m", "1 m"]}, Changes.PART),
        ({"gravity": ["9.81 m/s^2", "1.62 m/s^2"]}, Changes.OPTION),
        ({"scale": [0.5, 1.0]}, Changes.MOTION),
        ({"initial_rotation": ["0 rad", "0.01 rad"]}, Changes.START),
    ],
)
def test_subset_of_a_sweep_does_not_return_a_wrong_system(axis, changes):
    """Axes that change the system leave the unchanged system in the attributes."""
    runs = rf.sweep(SYSTEM, PULSE, **axis, **FAST)
    (name,) = axis
    kinds = {one["name"]: one["changes"] for one in json.loads(runs.attrs["axes_json"])}
    assert kinds[name] == changes
    assert rf.System.from_dataset(runs) == SYSTEM
    picked = runs.isel({name: 1, "motion": 0})
    if changes not in SYSTEM_AXES:
        assert rf.System.from_dataset(picked) == SYSTEM
    else:
        with pytest.raises(SchemaError, match=f"part of a sweep over {name}, .*rf.case"):
            rf.System.from_dataset(picked)
        assert rf.case(picked).system != SYSTEM
