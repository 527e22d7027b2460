"""The runs of a job's cases: together, side by side, or one by one; and which of them run again."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final

from rockframe.errors import PLEASE_REPORT
from rockframe.simulation.certify.second_look import Look, is_sure, look_at, second_look
from rockframe.simulation.plan import Plan, run_length
from rockframe.simulation.run import respond
from rockframe.solve.accuracy import LEVELS, AccuracyLevel
from rockframe.studies.sweeps.cases_of_job import CasesOfJob
from rockframe.studies.sweeps.lanes import (
    Failed,
    Finished,
    FinishedTogether,
    run_side_by_side,
    run_together,
    when_compiled,
)
from rockframe.system.assembly import Assembly


def each_run(
    cases: CasesOfJob,
    which: Sequence[int],
    stopped: Callable[[], bool],
    patience: float | None,
) -> Iterator[Finished | FinishedTogether | Failed]:
    """Run cases."""
    alone = set(which)
    faults: dict[int, Exception] = {}
    if patience is not None:
        ready = when_compiled(patience)
        for several in run_together(cases, which, stopped, ready):
            if isinstance(several, Finished):
                alone.discard(several.case)
            else:
                alone.difference_update(several.cases.tolist())
            yield several
        for found in run_side_by_side(cases, sorted(alone), stopped, ready):
            if isinstance(found, Failed):
                faults[found.case] = found.problem
            else:
                alone.discard(found.case)
                yield found
    for case in sorted(alone):
        if stopped():
            return
        try:
            system, said, plan = cases.planned(case)
            response = respond(system, plan)
            if case in faults:  # that it alone does not have
                said = [*said, _not_beside_others(faults[case])]
            yield Finished(case, system, response.trajectory, said, response)
        except Exception as problem:  # whatever it is, it is this case's alone
            yield Failed(case, problem)


def _not_beside_others(problem: Exception) -> str:
    """Say of a case that ran alone why it did not run in a lane."""
    kind = type(problem).__name__
    return f"its run beside others failed ({kind}: {problem}), and it ran alone: {PLEASE_REPORT}"


SCREEN: Final = "screen"
"""What stands for the accuracy of screened sweeps."""
FIRST: Final = AccuracyLevel.FAST
"""Level at which all cases run."""
AGAIN: Final = AccuracyLevel.STANDARD
"""Level at which cases run again whose verdict is in doubt."""


def looks_of(
    cases: CasesOfJob, run: Finished | FinishedTogether | Failed
) -> list[tuple[int, Look]]:
    """Take from runs what tells of the verdict of each case."""
    if isinstance(run, FinishedTogether):
        return run.looks()
    if isinstance(run, Failed):
        return []
    duration = run_length(cases.job.arguments, cases.unscaled(run.case))
    return [(run.case, look_at(run.system.setting, run.summary, duration))]


def in_doubt(
    cases: CasesOfJob, first: Mapping[int, Look], stopped: Callable[[], bool]
) -> list[int]:
    """Run cases a second time, and give those whose verdict is not sure."""
    doubtful = set(first)
    for run in each_run(cases.changed(second_look), sorted(first), stopped, cases.job.patience):
        for case, look in looks_of(cases, run):
            if is_sure(first[case], look):
                doubtful.discard(case)
    return sorted(doubtful)


def repeated(_: Assembly, plan: Plan) -> Plan:
    """Give the same run by tolerance."""
    return replace(plan, accuracy=LEVELS[AGAIN])
