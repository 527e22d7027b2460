"""A planned sweep, from its chunks to the labelled dataset, in memory or in a folder."""

import math
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Final

import xarray as xr

from rockframe.arguments import whole_number
from rockframe.compiled import COMPILED
from rockframe.errors import SolverWarning, StudyError, shown, warn
from rockframe.simulation.run import respond
from rockframe.studies.sweeps.axes import OWNER, Chunk, chunks_of
from rockframe.studies.sweeps.case import remember
from rockframe.studies.sweeps.cases_of_job import CasesOfJob
from rockframe.studies.sweeps.chunk import CaseResults
from rockframe.studies.sweeps.claims import Claims
from rockframe.studies.sweeps.execution import ProgressBar, run_chunks, workers_of
from rockframe.studies.sweeps.known import KnownCases
from rockframe.studies.sweeps.labelling import sweep_dataset, sweep_labels
from rockframe.studies.sweeps.lazily import lazy_dataset
from rockframe.studies.sweeps.store import Store, begin_with
from rockframe.studies.sweeps.study import Study
from rockframe.studies.sweeps.words import cases_verdict, not_screened, say_what_is_missing
from rockframe.system.own_base import OwnBase
from rockframe.system.own_scene import OwnScene

_LARGEST_CHUNK: Final = 1_000_000
_DAY: Final = 86_400.0
"""A day [s]."""
_GLIMPSE: Final = 1e-3
"""Share of a run that tells whether its law can be compiled."""
_LOOK: Final = 1.0
"""Time between two looks at what other jobs have run [s]."""


def run_study(
    study: Study,
    bar: ProgressBar,
    *,
    store: "str | PathLike[str] | None" = None,
    executor: Executor | None = None,
    chunk: int | None = None,
    known: "Sequence[str | PathLike[str]]" = (),
) -> xr.Dataset:
    """Run the cases of a study that are not kept yet, and label all of them."""
    workers = workers_of(executor)
    as_python = _runs_as_python(study) if chunk is None else not COMPILED
    size = (
        study.chunk_size(workers, as_python=as_python)
        if chunk is None
        else whole_number(chunk, owner=OWNER, name="chunk", lowest=1, highest=_LARGEST_CHUNK)
    )
    _say_how_long(study, workers, as_python=as_python, kept=store is not None)
    remember(study)
    if store is None and known:
        msg = "known cases are copied into the store of the sweep; give store='a folder'"
        raise StudyError(msg)
    others = KnownCases(study, map(folder_of, known))
    if store is None:
        dataset, unfinished = _in_memory(study, size, executor, bar)
    else:
        dataset, unfinished = _kept(study, folder_of(store), size, executor, bar, others)
    if unfinished:
        warn(f"{OWNER}: interrupted; {unfinished}", SolverWarning)
    if not study.lazy:
        dataset = not_screened(dataset) if study.handed_over else dataset
        say_what_is_missing(dataset)
    return dataset


def _say_how_long(study: Study, workers: int, *, as_python: bool, kept: bool) -> None:
    """Warn of what takes more than a day."""
    days = study.grid.count * study.time_of_case(as_python=as_python) / workers / _DAY
    if days > 1.0:
        ways = "several jobs on it share the work" if kept else "with one a kill would not lose it"
        warn(
            f"{OWNER}: {study.grid.count} cases take about {days:.2g} days with {workers} workers, "
            f"by the lengths of the motions; {'the' if kept else 'there is no'} store: {ways}",
            SolverWarning,
        )


def _runs_as_python(study: Study) -> bool:
    """Whether the first case runs in plain Python, as with a law that cannot be compiled."""
    if not COMPILED:
        return True
    try:
        system, _, plan = CasesOfJob(study.job(range(1))).planned(0)
        own = any(isinstance(part, OwnBase) for part in system.parts.structural())
        if not own and not isinstance(system.setting, OwnScene):
            return False
        glimpse = replace(plan.bare(), duration=_GLIMPSE * plan.duration)
        return respond(system, glimpse).trajectory.as_python
    except Exception:  # of which its run tells
        return False


def _in_memory(
    study: Study, size: int, executor: Executor | None, bar: ProgressBar
) -> tuple[xr.Dataset, str]:
    """Give the results, and of an interrupted study how far it came."""
    found: list[tuple[range, CaseResults]] = []
    bar.expect(study.grid.count)

    def take(one: Chunk, rows: CaseResults) -> None:
        found.append((one.cases, rows))
        bar.update(len(one.cases))

    chunks = chunks_of(study.grid.count, size)
    whole = run_chunks(chunks, lambda one: study.job(one.cases), take, executor)
    dataset = sweep_dataset(sweep_labels(study), sorted(found, key=lambda one: one[0].start))
    return dataset, "" if whole else cases_verdict(dataset)


def _kept(
    study: Study,
    folder: Path,
    size: int,
    executor: Executor | None,
    bar: ProgressBar,
    others: KnownCases,
) -> tuple[xr.Dataset, str]:
    """Give the results, and of an interrupted study how far it came."""
    kept = Store.of_study(folder, study, size)
    every = kept.chunks()
    missing = [one for one in every if not kept.has(one)]
    some = len(missing) < len(every)
    if missing:
        kept.check()
    if some:  # before hours of work
        for _ in kept.found():
            pass
    done = study.grid.count - sum(len(one.cases) for one in missing)
    bar.expect(study.grid.count, done)

    claims = Claims(folder)

    def take(one: Chunk, rows: CaseResults) -> None:
        kept.put(one, others.filled(one, rows))
        claims.let_go(one.number)
        bar.update(len(one.cases))

    free = _free(begin_with(missing) if some else missing, kept, others, claims, bar)
    try:
        whole = run_chunks(
            free, lambda one: study.job(others.lacking(one)), take, executor, claims.live
        )
    finally:
        claims.let_all_go()
    if whole:
        claims.clear()
    if not study.lazy:
        dataset = stored_dataset(kept)
        return dataset, "" if whole else cases_verdict(dataset)
    run = sum(len(one.cases) for one in every if kept.has(one))
    some = "" if whole else f"{run} of {study.grid.count} cases have been run, and are kept"
    return lazy_dataset(kept), some


def _free(
    missing: list[Chunk], kept: Store, others: KnownCases, claims: Claims, bar: ProgressBar
) -> Iterator[Chunk | None]:
    """Give the chunks that no other job has, as they are claimed; None while others have them.

    Chunks of which all is known from other studies are kept here, and given to nobody.
    """
    looked = -math.inf
    while missing:
        if time.monotonic() - looked < _LOOK:
            yield None
            continue
        looked, later = time.monotonic(), list[Chunk]()
        for one in missing:
            if not kept.has(one) and not len(others.lacking(one)):
                kept.put(one, others.filled(one, None))
            mine = not kept.has(one) and claims.take(one.number)
            if kept.has(one):  # another job has run it, maybe a moment ago
                claims.let_go(one.number)
                bar.update(len(one.cases))
            elif mine:
                yield one
            else:
                later.append(one)
        missing = later


def stored_dataset(kept: Store) -> xr.Dataset:
    """Give what a folder holds as a dataset."""
    dataset = sweep_dataset(kept.labels(), kept.found())
    return dataset.assign_attrs(kept.provenance())


def folder_of(path: object, *, owner: str = "") -> Path:
    """Read the argument ``store``, of a function that is named in messages, if there is one."""
    if isinstance(path, str | PathLike):
        return Path(path)  # pyright: ignore[reportUnknownArgumentType]
    words = f"store must be the path of a folder, got {shown(path)}"
    raise StudyError(f"{owner}: {words}" if owner else words)
