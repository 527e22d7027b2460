"""Which verdicts of fast runs are sure: what half as many steps again show of the same cases."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final

from rockframe.simulation.plan import Plan, run_length
from rockframe.simulation.second_look import Look, is_sure, look_at, second_look
from rockframe.solve.accuracy import LEVELS, AccuracyLevel
from rockframe.studies.sweeps.cases_of_job import CasesOfJob
from rockframe.studies.sweeps.side_by_side import Finished, each_run
from rockframe.system.assembly import Assembly

SCREEN: Final = "screen"
"""What stands for the accuracy of screened sweeps."""
FIRST: Final = AccuracyLevel.FAST
"""Level at which all cases run."""
AGAIN: Final = AccuracyLevel.STANDARD
"""Level at which cases run again whose verdict is in doubt."""


def look_at_case(cases: CasesOfJob, run: Finished) -> Look:
    """Take from a run of a case what tells of its verdict."""
    duration = run_length(cases.job.arguments, cases.unscaled(run.case))
    return look_at(run.system.setting, run.summary, duration)


def in_doubt(
    cases: CasesOfJob, first: Mapping[int, Look], stopped: Callable[[], bool]
) -> list[int]:
    """Run cases a second time, and give those whose verdict is not sure."""
    doubtful = set(first)
    for run in each_run(cases.changed(second_look), sorted(first), stopped, cases.job.patience):
        if isinstance(run, Finished) and is_sure(first[run.case], look_at_case(cases, run)):
            doubtful.discard(run.case)
    return sorted(doubtful)


def repeated(_: Assembly, plan: Plan) -> Plan:
    """Give the same run by tolerance."""
    return replace(plan, accuracy=LEVELS[AGAIN])
