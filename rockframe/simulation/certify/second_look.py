"""Whether a run by fixed steps is sure: what half as many steps again show, :eq:`eq-screened`."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

from rockframe.results.outcome import peak_share
from rockframe.results.variables.runs import Direction
from rockframe.simulation.certify.certificate import SAFETY
from rockframe.simulation.plan import Plan
from rockframe.solve.accuracy import Accuracy, AccuracyLevel, substeps_of
from rockframe.solve.trajectory import Summary
from rockframe.system.assembly import Assembly
from rockframe.system.setting import Setting

MORE: Final = 0.5
"""Share of steps by which the second look at a run has more of them."""
OTHER_COURSE: Final = 0.05
"""Share of their number by which the impacts of both runs differ if they took another course."""
SAME_PEAK: Final = 0.01
"""Error of a peak, over itself, up to which a body that stands took the same course to it."""
SAME_FALL: Final = 0.1
"""The same of the energy with which a body overturned."""
OFF: Final = 0.05
"""Estimated error of a peak rotation beyond which a run says so, over that peak."""
_AGAIN: Final = "with half as many steps again"
_REMEDY: Final = f"repeat the run with accuracy='{AccuracyLevel.STANDARD}'"


@dataclass(frozen=True)
class Look:
    """What a run tells of its verdict."""

    overturned: bool | None  # the verdict; None where the run was not finished
    share: float  # of the peak rotation in the overturning angle of its side [1]
    impacts: int  # their number
    time: float  # when it overturned, and how much of the run was left then; NaN if it did not [s]
    left: float
    direction: int  # in which it overturned; 0 if it did not
    frequency: float  # omega of Eq. (6), at which a body leaves its unstable equilibrium [rad s^-1]


def look_at(setting: Setting, summary: Summary, duration: float) -> Look:
    """Take from a run of some length [s] what tells of its verdict."""
    time = summary.verdict_time
    return Look(
        summary.overturned,
        peak_share(summary, setting.overturning_angles),
        summary.impact_count,
        time,
        duration - time,
        summary.verdict_direction,
        setting.body.frequency_at(setting.gravity),
    )


def second_look(system: Assembly, plan: Plan) -> Plan:
    """Give the same run with more steps in each interval of the motion, by at least one."""
    given = max(substeps_of(plan.accuracy, system.model, plan.interval), 1)
    return replace(plan.bare(), accuracy=Accuracy(substeps=given + math.ceil(MORE * given)))


def is_sure(first: Look, second: Look) -> bool:
    """Whether a verdict is farther from its flip than its error, :eq:`eq-screened`."""
    return is_clear(first, second) and not _other_impacts(first, second)


def is_together(first: Look, second: Look) -> bool:
    """Whether a verdict is so, and its peak or fall the same: other impacts are small ones then."""
    if not is_clear(first, second):
        return False
    if first.overturned:
        apart = 2.0 * first.frequency * SAFETY * abs(first.time - second.time)
        close = apart < SAME_FALL
    else:
        close = SAFETY * abs(first.share - second.share) <= SAME_PEAK * first.share
    return close or not _other_impacts(first, second)


def _other_impacts(first: Look, second: Look) -> bool:
    """Whether the numbers of impacts tell of another course."""
    apart = abs(first.impacts - second.impacts)
    return apart > OTHER_COURSE * max(first.impacts, second.impacts)


def is_clear(first: Look, second: Look) -> bool:
    """Whether a verdict is farther from its flip than its error, whatever the impacts."""
    if first.overturned is None or first.overturned != second.overturned:
        return False
    if not first.overturned:
        left = 1.0 - first.share, 1.0 - second.share  # below zero if it came back from beyond
        error = SAFETY * abs(first.share - second.share)
        return left[0] * left[1] > 0.0 and error < min(map(abs, left))
    error = SAFETY * abs(first.time - second.time)
    return (
        first.direction == second.direction
        and error < min(first.left, second.left)
        # near the unstable equilibrium the time tells of the energy: its error over itself
        and 2.0 * first.frequency * error < 1.0
    )


def peak_error(first: Summary, second: Summary) -> float:
    """Estimate the error of the peak rotation of a run; NaN where one was cut off [rad]."""
    if first.overturned is None or second.overturned is None:
        return math.nan
    return SAFETY * abs(first.peak_rotation - second.peak_rotation)


def doubts(setting: Setting, plan: Plan, first: Summary, second: Summary) -> Iterator[str]:
    """Say what is not sure of a run by fixed steps."""
    if first.overturned is None:
        return
    mine, other = (look_at(setting, one, plan.duration) for one in (first, second))
    if not is_together(mine, other):
        yield f"{_AGAIN} {_ends(other)}: the verdict is not sure; {_REMEDY}"
    error = peak_error(first, second)
    if error > OFF * first.peak_rotation:
        yield (
            f"{_AGAIN} its peak rotation is {second.peak_rotation:.4g} rad, not "
            f"{first.peak_rotation:.4g}: it is not sure; {_REMEDY}"
        )


def _ends(look: Look) -> str:
    """Say how a run ended."""
    if look.overturned is None:
        return "the run cannot be finished"
    if not look.overturned:
        return f"the body stands, its peak {100.0 * look.share:.4g} % of the overturning angle"
    return (
        f"the body overturns to the {Direction(look.direction).name.lower()} at {look.time:.3f} s"
    )
