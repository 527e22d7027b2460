"""The runs of a chunk: from a job to arrays of scalars.

Cases run together, side by side, or one by one; those of screened sweeps whose verdict is in doubt
run again.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import Any, Final

import numpy as np

from rockframe.case_arrays import CaseIndices
from rockframe.errors import PLEASE_REPORT, words_of
from rockframe.results.schema import SCHEMA
from rockframe.results.variables.requests import POINT_TIME
from rockframe.results.variables.runs import RunStatus
from rockframe.results.variables.studies import REPEATED, VERDICT_CHANGED
from rockframe.results.variables.variable import TIME
from rockframe.signals.arrays import AnyArray
from rockframe.simulation.certify.second_look import Look, is_sure, look_at, second_look
from rockframe.simulation.plan import run_length
from rockframe.simulation.run import NONE, compute_response, in_motion, run_scalars
from rockframe.simulation.soundness import STILL_MOVING
from rockframe.solve.accuracy import LEVELS, AccuracyLevel
from rockframe.studies.sweeps.lanes import (
    Failed,
    Finished,
    FinishedGroup,
    compilation_check,
    run_assembled_singly,
    run_assembled_together,
)
from rockframe.studies.sweeps.study import MIN_CASES_IN_LANES, CasesOfJob, Histories, SweepJob

SCREEN: Final = "screen"
"""The accuracy argument of screened sweeps."""
FIRST_LEVEL: Final = AccuracyLevel.FAST
"""Level at which all cases run."""
REPEATED_LEVEL: Final = AccuracyLevel.STANDARD
"""Level at which cases with a doubtful verdict run again."""
NO_TEXT: Final = 0
"""Place of the empty text in the texts of a chunk."""
DRIVER: Final = "driver"
"""Column that records how cases were run; it is not a result and in no dataset."""


class Driver(IntEnum):
    """How a case was run."""

    ALONE = 0
    IN_LANES = 1
    AS_PYTHON = 2


@dataclass(frozen=True, eq=False)
class CaseResults:
    """The results of the cases of a chunk, in order."""

    status: AnyArray  # how each run ended, or why there is none
    # by their names in the schema, and `DRIVER`; NaN where a case has no result
    scalars: dict[str, AnyArray]
    histories: dict[str, AnyArray]  # the same; NaN beyond a run's end too
    message: AnyArray  # places in `texts`
    texts: tuple[str, ...]  # messages of cases, each once; the first is empty


def _assign(
    columns: dict[str, AnyArray], count: int, name: str, where: Any, values: AnyArray | float
) -> None:
    """Put values of some cases, or of one, into a column."""
    extra = np.shape(values)[np.ndim(where) if not isinstance(where, slice) else 1 :]
    if name not in columns:
        columns[name] = np.full((count, *extra), np.nan)
    old = columns[name]
    # cases may have different numbers of bodies or restrainers: there is room for the most
    shape = tuple(map(max, old.shape[1:], extra))
    if old.shape[1:] != shape:
        columns[name] = np.full((count, *shape), np.nan)
        columns[name][tuple(map(slice, old.shape))] = old
    columns[name][(where, *map(slice, extra))] = values


class CollectedResults:
    """Collected results of cases; NaN and no text where there is none yet."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._status = np.full(count, RunStatus.NOT_RUN, dtype=np.int8)
        self._scalars: dict[str, AnyArray] = {}
        self._histories: dict[str, AnyArray] = {}
        self._message = np.full(count, NO_TEXT, dtype=np.int32)
        self._texts: dict[str, int] = {NONE: NO_TEXT}

    def put_rows(self, here: Any, rows: CaseResults, which: Any = slice(None)) -> None:
        """Put some of the cases of a chunk into their places."""
        self._status[here] = rows.status[which]
        # texts in the order of their cases, however these were cut into chunks
        message = rows.message[which]
        for first in sorted(np.unique(message, return_index=True)[1]):
            self._texts.setdefault(rows.texts[message[first]], len(self._texts))
        places = np.array([self._texts.get(text, NO_TEXT) for text in rows.texts])
        self._message[here] = places[message]
        for collected, value in ((self._scalars, rows.scalars), (self._histories, rows.histories)):
            for name, values in value.items():
                _assign(collected, self._count, name, here, values[which])

    def rows(self) -> CaseResults:
        """Return the collected results."""
        texts = tuple(self._texts)
        return CaseResults(self._status, self._scalars, self._histories, self._message, texts)


def run_cases(
    cases: CasesOfJob,
    which: Sequence[int],
    stopped: Callable[[], bool],
    compile_timeout: float | None,
) -> Iterator[Finished | FinishedGroup | Failed]:
    """Run cases together, side by side or alone, and give the outcome of each or of a group."""
    remaining = set(which)
    faults: dict[int, Exception] = {}
    if compile_timeout is not None:
        ready = compilation_check(compile_timeout)
        for several in run_assembled_together(cases, which, stopped, ready):
            ran = [several.case] if isinstance(several, Finished) else several.cases.tolist()
            remaining.difference_update(ran)
            yield several
        for outcome in run_assembled_singly(cases, sorted(remaining), stopped, ready):
            if isinstance(outcome, Failed):
                faults[outcome.case] = outcome.problem
            else:
                remaining.discard(outcome.case)
                yield outcome
    for case in sorted(remaining):
        if stopped():
            return
        try:
            system, messages, plan = cases.plan(case)
            response = compute_response(system, plan)
            if (fault := faults.get(case)) is not None:  # that it alone does not have
                text = f"its run in lanes failed ({type(fault).__name__}: {fault})"
                messages = [*messages, f"{text}, and it ran alone: {PLEASE_REPORT}"]
            yield Finished(case, system, response.trajectory, messages, response)
        except Exception as problem:  # any error affects only this case
            yield Failed(case, problem)


def verdict_looks(
    cases: CasesOfJob, run: Finished | FinishedGroup | Failed
) -> list[tuple[int, Look]]:
    """Take the indications of each case's verdict from runs."""
    if isinstance(run, FinishedGroup):
        return run.looks()
    if isinstance(run, Failed):
        return []
    duration = run_length(cases.job.arguments, cases.unscaled_motion(run.case))
    return [(run.case, look_at(run.system.setting, run.summary, duration))]


def run_chunk(job: SweepJob, stopped: Callable[[], bool] = lambda: False) -> CaseResults | None:
    """Run the cases of a job; each result equals that of :meth:`rockframe.System.simulate`."""
    cases = CasesOfJob(job)
    collected = _Collector(len(cases), job)
    looks: dict[int, Look] = {}
    for run in run_cases(cases, range(len(cases)), stopped, job.compile_timeout):
        collected.add(run)
        if job.screened:
            looks.update(verdict_looks(cases, run))
    if job.screened and not stopped():
        again = cases.with_change(second_look)
        sure = {
            case
            for run in run_cases(again, sorted(looks), stopped, job.compile_timeout)
            for case, look in verdict_looks(cases, run)
            if is_sure(looks[case], look)
        }
        doubtful = sorted(set(looks) - sure)
        collected.add_screening(looks, doubtful)
        compile_timeout = None
        if job.compile_timeout is not None and len(doubtful) >= MIN_CASES_IN_LANES:
            compile_timeout = job.compile_timeout * len(doubtful) / len(cases)
        again = cases.with_change(lambda _, plan: replace(plan, accuracy=LEVELS[REPEATED_LEVEL]))
        for run in run_cases(again, doubtful, stopped, compile_timeout):
            collected.add(run)
            collected.add_comparison(looks, verdict_looks(cases, run))
    return None if stopped() else collected.rows()


def _cautions_and_scalars(run: Finished) -> tuple[list[str], Mapping[str, AnyArray | float]]:
    """Return the warnings of a run, and its scalars with how it was run."""
    if run.response is not None:
        driver = Driver.AS_PYTHON if run.response.trajectory.as_python else Driver.ALONE
        cautions = [text for _, text in run.response.cautions()]
        return cautions, {DRIVER: driver, **run.response.scalars}
    missing: list[str] = []
    scalars = run_scalars(run.system, run.summary, missing)
    moving = [STILL_MOVING] if in_motion(run.system, run.summary, missing) else []
    return [*moving, *missing], {DRIVER: Driver.IN_LANES, **scalars}


class _Collector(CollectedResults):
    """Collects the results of cases as they are run."""

    def __init__(self, count: int, job: SweepJob) -> None:
        super().__init__(count)
        self._histories_kept, self._restrainers = job.histories, job.restrainers

    def add(self, run: Finished | FinishedGroup | Failed) -> None:
        """Note runs; for one without a verdict only its message."""
        if isinstance(run, Failed):
            self._add_failure(run.case, run.problem)
        elif isinstance(run, FinishedGroup):
            self._add_group(run)
        else:
            try:
                self._add_finished(run)
            except Exception as problem:  # as in the run itself
                self._add_failure(run.case, problem)

    def _add_finished(self, run: Finished) -> None:
        case, response = run.case, run.response
        if self._status[case] != RunStatus.NOT_RUN:  # of a first run
            self._clear(case)
        cautions, scalars = _cautions_and_scalars(run)
        if self._restrainers and "peak_restrainer_force" in scalars:
            names = run.system.setting.link_names
            if names != self._restrainers:
                cautions = [*cautions, f"its restrainers are {', '.join(names)}, not as labelled"]
        self._set_message(case, "; ".join([*run.warnings, *cautions]) or NONE)
        self._status[case] = run.summary.status
        if run.summary.overturned is None:
            self._clear(case)
            return
        self._put_scalars(case, scalars)
        if self._histories_kept is not None and response is not None and response.outputs.values:
            self._put_histories(case, response.outputs.values, self._histories_kept)

    def _add_group(self, run: FinishedGroup) -> None:
        if np.any(self._status[run.cases] != RunStatus.NOT_RUN):  # of a first run
            self._clear(run.cases)
        self._set_message(run.cases, "; ".join(run.warnings) or NONE)
        self._status[run.cases] = run.status
        self._put_scalars(run.cases, {DRIVER: Driver.IN_LANES, **run.scalars})

    def add_screening(self, every: Iterable[int], doubtful: Iterable[int]) -> None:
        """Note which cases were screened, and whose verdict was in doubt."""
        for case in every:
            self._put_scalars(case, {REPEATED: 0.0, VERDICT_CHANGED: 0.0})
        for case in doubtful:
            self._put_scalars(case, {REPEATED: 1.0})

    def add_comparison(self, first: Mapping[int, Look], again: Iterable[tuple[int, Look]]) -> None:
        """Note whether the verdicts of cases differ from the first ones."""
        for case, look in again:
            verdict = look.overturned
            changed = verdict is not None and verdict is not first[case].overturned
            self._put_scalars(case, {REPEATED: 1.0, VERDICT_CHANGED: float(changed)})

    def _put_scalars(self, case: int | CaseIndices, values: Mapping[str, AnyArray | float]) -> None:
        for name, value in values.items():
            if name == "status":  # which has a place of its own
                continue
            # a value that is equal in several cases has no row for each
            row = value if np.ndim(value) else np.broadcast_to(value, np.shape(case))
            _assign(self._scalars, self._count, name, case, row)

    def _put_histories(self, case: int, values: dict[str, AnyArray], histories: Histories) -> None:
        time = values[TIME[0]]
        count = min(len(time), histories.count)
        # a run that ends between two times has its end as a time too
        count -= int(time[count - 1] != (count - 1) * histories.step)
        names = values if histories.names is None else histories.names
        for name in names:
            if name != TIME[0] and name in values and SCHEMA[name].dims in (TIME, POINT_TIME):
                row = np.full((*values[name].shape[:-1], histories.count), np.nan)
                row[..., :count] = values[name][..., :count]
                _assign(self._histories, self._count, name, case, row)

    def _add_failure(self, case: int, problem: Exception) -> None:
        """Note why a case has no run."""
        if isinstance(problem, MemoryError):  # which says nothing of the case
            raise problem
        self._set_message(case, words_of(problem))
        self._clear(case)
        self._status[case] = RunStatus.REFUSED

    def _clear(self, case: int | CaseIndices) -> None:
        for column in (*self._scalars.values(), *self._histories.values()):
            column[case] = np.nan

    def _set_message(self, case: int | CaseIndices, text: str) -> None:
        self._message[case] = self._texts.setdefault(text, len(self._texts))
