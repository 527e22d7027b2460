"""Many runs at once: the public functions, and a planned sweep from its chunks to the dataset."""

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import suppress
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any, Final

import xarray as xr

from rockframe.arguments import checked_bool, checked_integer, checked_list
from rockframe.compiled import COMPILED
from rockframe.components import InitialState
from rockframe.errors import ModelWarning, SolverWarning, StudyError, short_repr, warn
from rockframe.shared_arguments import with_documented_arguments
from rockframe.simulation.run import compute_response
from rockframe.simulation.system import System
from rockframe.solve.accuracy import AccuracyLevel
from rockframe.studies.sweeps.arguments import SweepArguments
from rockframe.studies.sweeps.axes import OWNER, Chunk, chunks_of
from rockframe.studies.sweeps.chunk import CaseResults
from rockframe.studies.sweeps.claims import Claims
from rockframe.studies.sweeps.execution import (
    ProgressBar,
    progress_bar,
    run_chunks,
    workers_of_executor,
)
from rockframe.studies.sweeps.known_cases import KnownCases
from rockframe.studies.sweeps.labelling import (
    cases_verdict,
    mark_not_screened,
    sweep_dataset,
    sweep_labels,
    warn_of_missing_results,
)
from rockframe.studies.sweeps.lazy_dataset import lazy_dataset
from rockframe.studies.sweeps.motions import MotionsLike
from rockframe.studies.sweeps.planning import plan_study
from rockframe.studies.sweeps.store import Store, staggered
from rockframe.studies.sweeps.study import CasesOfJob, Study, SweepJob, cache_study
from rockframe.suggestions import with_hints
from rockframe.system.options import Overturning, OverturningLike, PointsLike, SweepAccuracyLike
from rockframe.system.own_base import OwnBase
from rockframe.system.own_scene import OwnScene
from rockframe.units import QuantityLike
from rockframe.version import __version__

_MAX_CHUNK: Final = 1_000_000
_DAY: Final = 86_400.0
"""A day [s]."""
_TRIAL_SHARE: Final = 1e-3
"""Duration of a trial run, which shows whether a law can be compiled, over that of a run [1]."""
_CHECK_INTERVAL: Final = 1.0
"""Time between two checks of the chunks run by other jobs [s]."""


@with_hints()
@with_documented_arguments(SweepArguments)
def sweep(
    scene: System | Callable[..., System],
    motions: MotionsLike | None = None,
    *,
    axes: Mapping[str, Any] | None = None,
    cases: Any = None,
    period: QuantityLike | None = None,
    duration: QuantityLike | None = None,
    free_vibration: QuantityLike | None = None,
    initial: InitialState | None = None,
    accuracy: SweepAccuracyLike = AccuracyLevel.STANDARD,
    output_step: QuantityLike | None = None,
    outputs: Sequence[str] | None = None,
    points: PointsLike | None = None,
    overturning: OverturningLike = Overturning.STOP,
    store: str | PathLike[str] | None = None,
    executor: Executor | None = None,
    chunk: int | None = None,
    progress: bool | None = None,
    known: str | PathLike[str] | Sequence[str | PathLike[str]] = (),
    **more_axes: Any,
) -> xr.Dataset:
    """Run a scene at all combinations of values, or at all rows of a table.

    Parameters
    ----------
    scene : System or callable
        A system whose parts have the parameters named by the axes; or a function that takes the
        axes by name and returns a System.
    motions : GroundMotion, or sequence or mapping of them, optional
        Each motion is combined with all cases; a HorizontalPair counts as its two components. By
        default the motion among the parts of the system, or of the systems that the function
        returns.
    axes : mapping of str to values, optional
        Axes whose names are not valid keywords, such as ``"Block.mass"``, or coincide with
        arguments of this function.
    cases : pandas.DataFrame or mapping of str to values, optional
        A table with a row for each case and a column for each axis, with units in the headers
        (``width [m]``) or in the values. A column ``motion`` selects motions by name or number.
    period : str or Quantity, optional
        Period of the oscillator of ``pseudo_spectral_acceleration`` [s].
    output_step : str or Quantity, optional
        Spacing of the histories [s]. The default is the time step of the motions, the shortest one
        if they differ.
    outputs : sequence of str, optional
        Histories that are kept: names and groups. An empty sequence keeps those that every run has,
        including those of points. None keeps none.
    points : mapping of str to (str or Quantity, str or Quantity), optional
        Points of the body, as for :meth:`rockframe.System.simulate`. Peaks of their displacements
        and absolute accelerations are returned over ``point``, and their histories if `outputs`
        keeps them [m].
    overturning : {"stop", "continue"}, optional
        Whether a run ends when the rotation reaches the overturning angle, or continues until the
        block lies flat.
    known : str or path, or sequence of them, optional
        Stores of other sweeps that differ only in motions and in values of the axes. Their cases
        are copied into `store` and not run again.
    **more_axes : values
        Axes: a parameter of one part (``frequency_ratio``), an option of the system (``gravity``),
        an argument of the function, an initial value (``initial_rotation``), or a scaling of the
        motion: ``scale``, ``peak_ground_acceleration`` (or ``PGA``), ``peak_ground_velocity``
        (``PGV``) or ``pseudo_spectral_acceleration`` (``SA``). Values with a unit are ``([1, 2],
        "m")``, a Quantity, or ``["1 m", "2 m"]``.

    Returns
    -------
    xarray.Dataset
        All scalars of a run, over ``case`` if there is a table, the axes in the order given, and
        ``motion``; histories also over ``time``. If a case could not be assembled or finished, its
        scalars are NaN, ``status`` marks it, and the coordinate ``message`` says why. Truth values,
        flags and counts are floats if there are such gaps. Screened sweeps have ``repeated`` and
        ``verdict_changed``.

    Raises
    ------
    StudyError
        The sweep cannot be planned, with all faults listed; its store belongs to another sweep, is
        damaged or cannot be written; or the executor failed.
    ComponentError
        `executor`, `chunk` or `progress` is invalid.

    Warns
    -----
    SolverWarning
        Cases have no result, or were not run because of an interrupt (Ctrl-C). The sweep will take
        more than a day. The result does not fit into memory and is opened lazily from the store.
    ModelWarning
        Values are unusual, or results must be used with care.

    Notes
    -----
    The result of a case depends on that case alone, not on its chunk or on the number of workers.
    It equals the result of ``simulate`` to the last bit; :func:`rockframe.case` returns any case.

    Examples
    --------
    >>> import rockframe as rf
    >>> block = rf.Block.from_size(radius="5 m", slenderness=4, mass="50 t")
    >>> system = rf.System(block, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10))
    >>> pulse = rf.GroundMotion.sine_pulse("-9.81 m/s^2", "1 Hz")
    >>> runs = rf.sweep(system, pulse, scale=[0.4, 0.8], frequency_ratio=[10, 20, 40])
    >>> dict(runs.overturned.sizes)
    {'scale': 2, 'frequency_ratio': 3, 'motion': 1}
    """
    named = axes is None or isinstance(axes, Mapping)  # pyright: ignore[reportUnnecessaryIsInstance]
    if not named:
        fault = f"axes must be a mapping of names to values, got {short_repr(axes)}"
        msg = f"{fault}; write for example axes={{'Block.mass': ['1 t', '2 t']}}"
        raise StudyError(msg)
    values = dict(axes or {})
    twice = sorted(set(values) & set(more_axes))
    if twice:
        raise StudyError(*(f"axis {name!r} is given twice" for name in twice))
    study = plan_study(
        scene,
        motions,
        {**values, **more_axes},
        cases,
        period=period,
        duration=duration,
        free_vibration=free_vibration,
        initial=initial,
        accuracy=accuracy,
        output_step=output_step,
        outputs=outputs,
        points=points,
        overturning=overturning,
        stored=store is not None,
    )
    cache_study(study)
    with progress_bar(progress, owner=OWNER) as bar:
        sources = [known] if isinstance(known, PathLike) else checked_list(
            known, owner=OWNER, name="known", of="folders"
        )  # fmt: skip
        dataset, _ = run_study(
            study, bar, store=store, executor=executor, chunk=chunk, known=sources
        )
        return dataset


@with_hints()
def open_study(path: str | PathLike[str], *, lazy: bool = False) -> xr.Dataset:
    """Read the stored results of a sweep, even while it runs.

    Parameters
    ----------
    path : str or path
        The `store` of a :func:`rockframe.sweep`.
    lazy : bool, optional
        Whether numbers are read from the folder only when they are used, for studies larger than
        memory. Truth values, flags and counts are then floats. If dask is installed the variables
        are dask arrays.

    Returns
    -------
    xarray.Dataset
        As returned by the sweep; the status of cases that have not run yet is ``not_run``.

    Raises
    ------
    StudyError
        There is no study, it is damaged, or its format cannot be read.

    Warns
    -----
    ModelWarning
        The study was run by another version of rockframe, whose numbers may differ.

    Examples
    --------
    >>> import rockframe as rf
    >>> so_far = rf.open_study("study")  # doctest: +SKIP
    >>> so_far.verdict  # doctest: +SKIP
    """
    stored = Store.open(read_folder(path))
    if stored.version != __version__:
        warn(
            f"open_study: {stored.folder} was run by rockframe {stored.version}, whose numbers may "
            f"be others than those of this one, {__version__}",
            ModelWarning,
        )
    return stored_dataset(stored, lazy=checked_bool(lazy, owner="open_study", name="lazy"))


def run_study(
    study: Study,
    bar: ProgressBar,
    *,
    store: str | PathLike[str] | None = None,
    executor: Executor | None = None,
    chunk: int | None = None,
    known: Sequence[str | PathLike[str]] = (),
) -> tuple[xr.Dataset, bool]:
    """Run the cases of a study that are not kept yet; return the dataset, and whether all ran."""
    workers = workers_of_executor(executor)
    as_python = not COMPILED
    if chunk is None:
        as_python = _runs_as_python(study)
        chunk = study.chunk_size(workers, as_python=as_python)
    size = checked_integer(chunk, owner=OWNER, name="chunk", lowest=1, highest=_MAX_CHUNK)
    _warn_of_long_study(study, workers, as_python=as_python, stored=store is not None)
    if store is None and known:
        msg = "known cases are copied into the store of the sweep; give store='a folder'"
        raise StudyError(msg)
    known_cases = KnownCases(study, map(read_folder, known))
    if store is None:
        dataset, unfinished = _run_in_memory(study, size, executor, bar)
    else:
        stored = Store.open_or_create(read_folder(store), study, size)
        dataset, unfinished = _run_with_store(study, stored, executor, bar, known_cases)
    if unfinished:
        warn(f"{OWNER}: interrupted; {unfinished}", SolverWarning)
    if not study.lazy:
        dataset = mark_not_screened(dataset) if study.screening_skipped else dataset
        histories = study.histories
        warn_of_missing_results(dataset, () if histories is None else histories.names or ())
    return dataset, not unfinished


def _warn_of_long_study(study: Study, workers: int, *, as_python: bool, stored: bool) -> None:
    """Warn of sweeps that take more than a day."""
    days = study.grid.count * study.time_of_case(as_python=as_python) / workers / _DAY
    if days > 1.0:
        advice = "there is no store: with one a kill would not lose it"
        if stored:
            advice = "the store: several jobs on it share the work"
        warn(
            f"{OWNER}: {study.grid.count} cases take about {days:.2g} days with {workers} workers, "
            f"by the lengths of the motions; {advice}",
            SolverWarning,
        )


def _runs_as_python(study: Study) -> bool:
    """Whether the first case runs in plain Python, as with a law that cannot be compiled."""
    if not COMPILED:
        return True
    try:
        system, _, plan = CasesOfJob(study.job(range(1))).plan(0)
        has_own_base = any(isinstance(part, OwnBase) for part in system.parts.structural())
        if not has_own_base and not isinstance(system.setting, OwnScene):
            return False
        trial = replace(plan.without_outputs(), duration=_TRIAL_SHARE * plan.duration)
        return compute_response(system, trial).trajectory.as_python
    except Exception:  # reported by the run of the case
        return False


def _run_in_memory(
    study: Study, size: int, executor: Executor | None, bar: ProgressBar
) -> tuple[xr.Dataset, str]:
    """Return the results, and of an interrupted study how far it came."""
    results: list[tuple[range, CaseResults]] = []
    bar.expect(study.grid.count)

    def collect(chunk: Chunk, rows: CaseResults) -> None:
        results.append((chunk.cases, rows))
        bar.update(len(chunk.cases))

    chunks = chunks_of(study.grid.count, size)
    completed = run_chunks(chunks, lambda chunk: study.job(chunk.cases), collect, executor)
    results.sort(key=lambda result: result[0].start)
    dataset = sweep_dataset(sweep_labels(study), results)
    return dataset, "" if completed else cases_verdict(dataset)


def _run_with_store(
    study: Study,
    stored: Store,
    executor: Executor | None,
    bar: ProgressBar,
    known_cases: KnownCases,
) -> tuple[xr.Dataset, str]:
    """Return the results, and of an interrupted study how far it came."""
    every = stored.chunks()
    missing = [chunk for chunk in every if not stored.has(chunk)]
    some = len(missing) < len(every)
    if missing:
        stored.check_writable()
    if some:  # before hours of work
        stored.labels()
        for _ in stored.results():
            pass
    done = study.grid.count - sum(len(chunk.cases) for chunk in missing)
    bar.expect(study.grid.count, done)

    claims = Claims(stored.folder)

    def collect(chunk: Chunk, rows: CaseResults) -> None:
        stored.put(chunk, known_cases.merge(chunk, rows))
        claims.release(chunk.number)
        bar.update(len(chunk.cases))

    def job_of(chunk: Chunk) -> SweepJob:
        return study.job(known_cases.missing_cases(chunk))

    missing = staggered(missing) if some else missing
    claimed = _claimed_chunks(missing, stored, known_cases, claims, bar)
    try:
        completed = run_chunks(claimed, job_of, collect, executor, claims.renew)
    finally:
        claims.release_all()
    if completed:
        claims.clear()
    dataset = stored_dataset(stored, lazy=study.lazy)
    if completed or not study.lazy:
        return dataset, "" if completed else cases_verdict(dataset)
    run = sum(len(chunk.cases) for chunk in every if stored.has(chunk))
    return dataset, f"{run} of {study.grid.count} cases have been run, and are kept"


def _claimed_chunks(
    missing: list[Chunk], stored: Store, known_cases: KnownCases, claims: Claims, bar: ProgressBar
) -> Iterator[Chunk | None]:
    """Return the chunks that no other job has, as they are claimed; None while others have them."""
    checked = -math.inf
    while missing:
        if time.monotonic() - checked < _CHECK_INTERVAL:
            yield None
            continue
        checked, later = time.monotonic(), list[Chunk]()
        for chunk in missing:
            if not stored.has(chunk) and not len(known_cases.missing_cases(chunk)):
                # it is fully known from other studies
                stored.put(chunk, known_cases.merge(chunk, None))
            claimed = not stored.has(chunk) and claims.take(chunk.number)
            if stored.has(chunk):  # another job has run it, maybe a moment ago
                claims.release(chunk.number)
                bar.update(len(chunk.cases))
            elif claimed:
                yield chunk
            else:
                later.append(chunk)
        missing = later


def stored_dataset(stored: Store, *, lazy: bool) -> xr.Dataset:
    """Return what a folder holds as a dataset, by which its motions are found again."""
    dataset = lazy_dataset(stored) if lazy else sweep_dataset(stored.labels(), stored.results())
    dataset = dataset.assign_attrs(stored.provenance())
    dataset.encoding["source"] = str(stored.folder)  # as of a dataset that was read from a file
    return dataset


def read_folder(path: object, *, owner: str = "") -> Path:
    """Read the argument ``store``, of a function that is named in messages, if there is one."""
    if isinstance(path, str | PathLike) and str(path) and "\0" not in str(path):
        with suppress(RuntimeError):  # of a user without a home
            # a program may change its folder while it runs, or before it reads lazily
            return Path(path).expanduser().absolute()  # pyright: ignore[reportUnknownArgumentType]
    words = f"store must be the path of a folder, got {short_repr(path)}"
    raise StudyError(f"{owner}: {words}" if owner else words)
