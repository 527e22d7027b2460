"""The runs of a chunk: from a job to arrays of scalars."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from rockframe.errors import RockframeError
from rockframe.results.outcome import Generic, scalars
from rockframe.results.schema import SCHEMA
from rockframe.results.variables.runs import RunStatus
from rockframe.results.variables.variable import TIME
from rockframe.simulation.run import NONE, Response, respond
from rockframe.studies.sweeps.cases_of_job import CasesOfJob
from rockframe.studies.sweeps.side_by_side import Finished, run_side_by_side
from rockframe.studies.sweeps.study import Histories, Job

NO_TEXT: Final = 0
"""Place of the text that says nothing, in the texts of a chunk."""
_STATUS: Final = "status"


@dataclass(frozen=True, eq=False)
class Rows:
    """What the cases of a chunk showed, in their order.

    Parameters
    ----------
    status : ndarray of int8, shape (cases,)
        How each run ended, or why there is none.
    scalars : dict of str to ndarray of float64, shape (cases,)
        By their names in the schema; NaN where a case has no result.
    histories : dict of str to ndarray of float64, shape (cases, times)
        The same; NaN beyond a run's end too.
    message : ndarray of int32, shape (cases,)
        Places in `texts`.
    texts : tuple of str
        What is said of cases, each once; the first says nothing.
    """

    status: Generic
    scalars: dict[str, Generic]
    histories: dict[str, Generic]
    message: Generic
    texts: tuple[str, ...]


def run_chunk(job: Job, stopped: Callable[[], bool] = lambda: False) -> Rows | None:
    """Run the cases of a job: side by side where they can, else one after the other.

    What a case shows depends on that case alone, and is what
    :meth:`rockframe.System.simulate` gives.

    Parameters
    ----------
    job : Job
        The cases.
    stopped : callable
        Whether to leave off; asked between cases.

    Returns
    -------
    Rows or None
        None where it was left off.
    """
    told = _Telling(len(job.motion_of_case), job.histories)
    cases = CasesOfJob(job)
    alone = set(range(len(job.motion_of_case)))
    for finished in run_side_by_side(cases, stopped):
        told.put_finished(finished)
        alone.discard(finished.case)
    for case in sorted(alone):
        if stopped():
            return None
        try:
            system, said, plan = cases.planned(case)
            told.put(case, respond(system, plan), said)
        except Exception as problem:  # whatever it is, it is this case's alone
            told.refuse(case, problem)
    return told.rows()


class _Telling:
    """Collects what cases show."""

    def __init__(self, count: int, histories: Histories | None) -> None:
        self._count = count
        self._kept = histories
        self._status = np.full(count, RunStatus.NOT_RUN, dtype=np.int8)
        self._scalars: dict[str, Generic] = {}
        self._histories: dict[str, Generic] = {}
        self._message = np.full(count, NO_TEXT, dtype=np.int32)
        self._texts: dict[str, int] = {NONE: NO_TEXT}

    def put(self, case: int, response: Response, said: list[str]) -> None:
        """Note a run; of one without a verdict only what is said of it."""
        summary = response.trajectory
        self._say(case, "; ".join([*said, *(text for _, text in response.cautions())]) or NONE)
        self._status[case] = summary.status
        if summary.overturned is None:
            return
        self._put_scalars(case, response.scalars)
        if self._kept is not None:
            self._put_histories(case, response.histories, self._kept)

    def put_finished(self, run: Finished) -> None:
        """Note a run that was made side by side with others."""
        self._say(run.case, "; ".join(run.said) or NONE)
        self._status[run.case] = run.summary.status
        self._put_scalars(run.case, scalars(run.summary, run.scales))

    def _put_scalars(self, case: int, values: Mapping[str, float]) -> None:
        for name, value in values.items():
            if name != _STATUS:
                self._of(self._scalars, name, ())[case] = value

    def _put_histories(self, case: int, values: dict[str, Generic], kept: Histories) -> None:
        time = values[TIME[0]]
        count = min(len(time), kept.count)
        # a run that ends between two times has its end as a time too
        count -= int(time[count - 1] != (count - 1) * kept.step)
        names = values if kept.names is None else kept.names
        for name in names:
            if name != TIME[0] and name in values and SCHEMA[name].dims == TIME:
                row = self._of(self._histories, name, (kept.count,))[case]
                row[:count] = values[name][:count]

    def refuse(self, case: int, problem: Exception) -> None:
        """Note why a case has no run."""
        words = str(problem) if isinstance(problem, RockframeError) else ""
        self._say(case, words or f"{type(problem).__name__}: {problem}")
        for column in (*self._scalars.values(), *self._histories.values()):
            column[case] = np.nan
        self._status[case] = RunStatus.REFUSED

    def rows(self) -> Rows:
        """Give what has been collected."""
        texts = tuple(self._texts)
        return Rows(self._status, self._scalars, self._histories, self._message, texts)

    def _say(self, case: int, text: str) -> None:
        self._message[case] = self._texts.setdefault(text, len(self._texts))

    def _of(self, columns: dict[str, Generic], name: str, shape: tuple[int, ...]) -> Generic:
        if name not in columns:
            columns[name] = np.full((self._count, *shape), np.nan)
        return columns[name]
