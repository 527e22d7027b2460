"""Which verdicts of fast runs are sure: what half as many steps again show of the same cases."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Final

from rockframe.results.outcome import peak_of
from rockframe.simulation.certificate import SAFETY
from rockframe.simulation.plan import Plan, length_of
from rockframe.solve.accuracy import LEVELS, Accuracy, AccuracyLevel
from rockframe.solve.integrate import STILL_INTERVAL
from rockframe.solve.substeps import substeps_of
from rockframe.studies.sweeps.cases_of_job import CasesOfJob
from rockframe.studies.sweeps.runs import each_run
from rockframe.studies.sweeps.side_by_side import Finished
from rockframe.system.assembly import Assembly

SCREEN: Final = "screen"
"""What stands for the accuracy of screened sweeps."""
FIRST: Final = AccuracyLevel.FAST
"""Level at which all cases run."""
AGAIN: Final = AccuracyLevel.STANDARD
"""Level at which cases run again whose verdict is in doubt."""
MORE: Final = 0.5
"""Share of steps by which the second look at a case has more of them."""
OTHER_COURSE: Final = 0.05
"""Share of their number by which the impacts of both runs differ if they took another course."""


@dataclass(frozen=True)
class Look:
    """What a run of a case tells of its verdict.

    Parameters
    ----------
    overturned : bool or None
        The verdict; None where the run was not finished.
    share : float
        Of the peak rotation in the overturning angle of its side [1].
    impacts : int
        Their number.
    time, left : float
        When it overturned, and how much of the run was left then; NaN if it did not [s].
    direction : int
        In which it overturned; 0 if it did not.
    frequency : float
        omega of Eq. (6), at which a body leaves its unstable equilibrium [rad s^-1].
    """

    overturned: bool | None
    share: float
    impacts: int
    time: float
    left: float
    direction: int
    frequency: float


def look_at(cases: CasesOfJob, run: Finished) -> Look:
    """Take from a run of a case what tells of its verdict."""
    setting, summary = run.system.setting, run.summary
    time = summary.overturning_time
    return Look(
        summary.overturned,
        peak_of(summary, setting.overturning_angles).share,
        summary.impact_count,
        time,
        length_of(cases.job.arguments, cases.unscaled(run.case)) - time,
        summary.overturning_direction,
        setting.body.frequency_at(setting.gravity),
    )


def in_doubt(
    cases: CasesOfJob, first: Mapping[int, Look], stopped: Callable[[], bool]
) -> list[int]:
    """Run cases a second time, and give those whose verdict is not sure.

    Parameters
    ----------
    cases : CasesOfJob
        All cases of a job.
    first : mapping of int to Look
        What their first runs told.
    stopped : callable
        Whether to leave off; asked between cases.

    Returns
    -------
    list of int
    """
    doubtful = set(first)
    for run in each_run(cases.changed(second_look), sorted(first), stopped):
        if isinstance(run, Finished) and is_sure(first[run.case], look_at(cases, run)):
            doubtful.discard(run.case)
    return sorted(doubtful)


def second_look(system: Assembly, plan: Plan) -> Plan:
    """Give the same run with more steps in each interval of the motion, by at least one.

    Parameters
    ----------
    system : Assembly
        The scene.
    plan : Plan
        Of the first run, with fixed steps.

    Returns
    -------
    Plan
        Without histories.
    """
    interval = STILL_INTERVAL if plan.motion is None else plan.motion.si.time_step
    given = max(substeps_of(plan.accuracy, system.model, interval), 1)
    accuracy = Accuracy(substeps=given + math.ceil(MORE * given))
    return replace(plan.bare(), accuracy=accuracy)


def repeated(_: Assembly, plan: Plan) -> Plan:
    """Give the same run by tolerance."""
    return replace(plan, accuracy=LEVELS[AGAIN])


def is_sure(first: Look, second: Look) -> bool:
    """Whether a verdict is farther from its flip than its error, :eq:`eq-screened`.

    Parameters
    ----------
    first, second : Look
        The run of a case, and the same with more steps.

    Returns
    -------
    bool
    """
    if first.overturned is None or first.overturned != second.overturned:
        return False
    apart = abs(first.impacts - second.impacts)
    if apart > OTHER_COURSE * max(first.impacts, second.impacts):
        return False
    if not first.overturned:
        error = SAFETY * abs(first.share - second.share)
        return error < 1.0 - max(first.share, second.share)
    error = SAFETY * abs(first.time - second.time)
    return (
        first.direction == second.direction
        and error < min(first.left, second.left)
        # near the unstable equilibrium the time tells of the energy: its error over itself
        and 2.0 * first.frequency * error < 1.0
    )
