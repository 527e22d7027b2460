"""Whether a run in fixed steps is sure, by a second run with more steps, :eq:`eq-screened`."""

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

ADDED_STEPS: Final = 0.5
"""Additional steps of the second run, as a share of those of the first."""
IMPACT_COUNT_TOLERANCE: Final = 0.05
"""Relative difference of the numbers of impacts beyond which two runs took different courses."""
PEAK_TOLERANCE: Final = 0.01
"""Relative error of the peak up to which two runs without overturning took the same course."""
ENERGY_TOLERANCE: Final = 0.1
"""Relative error of the energy at overturning up to which two runs took the same course."""
MAX_PEAK_ERROR: Final = 0.05
"""Estimated relative error of a peak rotation beyond which a run warns."""
ROUNDED_PEAK: Final = 1e-9
"""Share of the overturning angle up to which a peak rotation is rounding, as after an uplift by a
ground acceleration that hardly exceeds what the body resists."""
_AGAIN: Final = "with 1.5 times as many steps"
_REMEDY: Final = f"repeat the run with accuracy='{AccuracyLevel.STANDARD}'"


@dataclass(frozen=True)
class Look:
    """The numbers of a run from which follows how sure its verdict is."""

    overturned: bool | None  # the verdict; None where the run was not finished
    share: float  # peak rotation over the overturning angle of its side [1]
    impacts: int  # number of impacts
    time: float  # time of overturning, NaN if it did not [s]
    left: float  # time from then to the end of the run [s]
    direction: int  # direction in which it overturned; 0 if it did not
    frequency: float  # omega of Eq. (6), the rate of growth near unstable equilibrium [rad s^-1]


def look_at(setting: Setting, summary: Summary, duration: float) -> Look:
    """Return the numbers of a run of some length [s] from which follows how sure its verdict is."""
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
    """Return the plan of the second run: with more steps in each interval of the motion."""
    value = max(substeps_of(plan.accuracy, system.model, plan.interval), 1)
    return replace(
        plan.without_outputs(), accuracy=Accuracy(substeps=value + math.ceil(ADDED_STEPS * value))
    )


def is_sure(first: Look, second: Look) -> bool:
    """Whether a verdict is farther from the other one than its error, :eq:`eq-screened`."""
    return is_clear(first, second) and not _other_impacts(first, second)


def is_together(first: Look, second: Look) -> bool:
    """Whether a verdict is clear, and both runs take the same course.

    With the same peak, or the same energy at overturning, they do even if their numbers of impacts
    differ: these are small impacts then.
    """
    if not is_clear(first, second):
        return False
    if first.overturned:
        apart = 2.0 * first.frequency * SAFETY * abs(first.time - second.time)
        close = apart < ENERGY_TOLERANCE
    else:
        close = SAFETY * abs(first.share - second.share) <= PEAK_TOLERANCE * first.share
    return close or not _other_impacts(first, second)


def _other_impacts(first: Look, second: Look) -> bool:
    """Whether the numbers of impacts show that two runs took different courses."""
    apart = abs(first.impacts - second.impacts)
    return apart > IMPACT_COUNT_TOLERANCE * max(first.impacts, second.impacts)


def is_clear(first: Look, second: Look) -> bool:
    """Whether a verdict is farther from the other one than its error, whatever the impacts."""
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
        # near unstable equilibrium the relative error of the energy follows from that of the time
        and 2.0 * first.frequency * error < 1.0
    )


def peak_error(first: Summary, second: Summary) -> float:
    """Estimate the error of the peak rotation of a run; NaN if a run is not finished [rad]."""
    if first.overturned is None or second.overturned is None:
        return math.nan
    return SAFETY * abs(first.peak_rotation - second.peak_rotation)


def doubts(setting: Setting, plan: Plan, first: Summary, second: Summary) -> Iterator[str]:
    """Say whether the verdict or the peak of a run in fixed steps is not sure."""
    if first.overturned is None:
        return
    mine, other = (look_at(setting, run, plan.duration) for run in (first, second))
    if (
        mine.overturned is other.overturned is False
        and max(mine.share, other.share) <= ROUNDED_PEAK
    ):
        return
    if not is_together(mine, other):
        yield f"{_AGAIN} {_ends(other)}: the verdict is not sure; {_REMEDY}"
    error = peak_error(first, second)
    if error > MAX_PEAK_ERROR * first.peak_rotation:
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
