"""How sure a verdict is: runs beside a run, by finer means, nudged and scaled."""

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from rockframe.errors import ModelWarning, RockframeError, SolverError
from rockframe.simulation.beside import Beside, Run
from rockframe.simulation.certificate_words import sentence
from rockframe.simulation.certification import Certification
from rockframe.simulation.finer import finer_plans
from rockframe.simulation.nudging import SceneAt, parameters, scaled, scales
from rockframe.simulation.plan import Plan
from rockframe.simulation.scan import NOT_TRIED, Scan, scan
from rockframe.solve.accuracy import FEWEST
from rockframe.system.assembly import Assembly

SAFETY: Final = 3.0
"""Error that a run may have, over its largest difference from a run by finer means."""
RESOLUTION: Final = 0.004
"""Length of an interval of scales that is not looked into, over its distance from one."""
NUDGE_RESOLUTION: Final = 0.06
"""The same of the values of a parameter, over the distance from its own."""
INSIDE: Final = (0.5, 1.0)
"""Shares of the nudge by which a parameter is changed first."""
PER_PARAMETER: Final = (4, 14)
"""Least and most runs for one parameter."""
FOR_PARAMETERS: Final = 0.6
"""Share of all runs that may go to parameters."""


@dataclass(frozen=True)
class Certificate:
    """A run, and what the runs beside it showed; none where it was not finished.

    Parameters
    ----------
    wanted : Certification
        What was to be tried.
    plan : Plan
        The run's arguments.
    base : Beside
        What the run showed.
    finer : sequence of (str, Beside)
        Runs by finer means, with these in words.
    nudged : sequence of (str, Scan)
        Runs with a parameter changed, with its name in words.
    along : Scan
        Runs with a scaled motion or start.
    """

    wanted: Certification
    plan: Plan
    base: Beside
    finer: Sequence[tuple[str, Beside]] = ()
    nudged: Sequence[tuple[str, Scan]] = ()
    along: Scan = NOT_TRIED

    @property
    def finished(self) -> bool:
        """Whether the run has a verdict."""
        return self.base.overturned is not None

    @property
    def converged(self) -> bool:
        """Whether the verdict is that of every run by finer means, by more than they differ."""
        return self.finished and all(settles(self.base, other) for _, other in self.finer)

    @property
    def robust(self) -> bool:
        """Whether no change of a parameter or the scale up to the nudge has another verdict.

        Nor is one to be feared between the changes that were tried.
        """
        followed = all(found.flip is None and found.followed for _, found in self.nudged)
        least = min(self.wanted.nudge, self.wanted.reach)
        return self.finished and followed and not self.margin < least

    @property
    def margin(self) -> float:
        """Largest change of scale up to which no other verdict was found; NaN if none was tried."""
        return self.along.margin if self.along.tried else math.nan

    @property
    def flip(self) -> float:
        """Scale nearest to one that was found to change the verdict; NaN if none."""
        return math.nan if self.along.flip is None else 1.0 + self.along.flip

    @property
    def peak_error(self) -> float:
        """Largest difference from the peak by finer means, times a safety factor [rad]."""
        return SAFETY * self._farthest([other for _, other in self.finer])

    @property
    def peak_sensitivity(self) -> float:
        """Largest difference from the peak with a nudged parameter [rad]."""
        return self._farthest([shown for _, found in self.nudged for shown in found.tried.values()])

    def _farthest(self, others: list[Beside]) -> float:
        """Give the largest difference of peaks; NaN if a run was cut off before its own."""
        apart = [
            math.nan if one.overturned is None else abs(one.peak - self.base.peak)
            for one in (self.base, *others)
        ]
        return float(np.max(apart))

    @property
    def runs(self) -> int:
        """Number of runs beside."""
        return len(self.finer) + _number_of_runs(self.nudged) + len(self.along.tried)

    @property
    def sentence(self) -> str:
        """All this in words."""
        return sentence(self, self.values())

    def values(self) -> dict[str, float | bool]:
        """Give the scalars by their names in the schema."""
        return {
            "verdict_converged": self.converged,
            "verdict_robust": self.robust,
            "verdict_margin": self.margin,
            "verdict_flip_scale": self.flip,
            "peak_error_estimate": self.peak_error,
            "peak_sensitivity": self.peak_sensitivity,
        }

    def attributes(self) -> dict[str, str | float | int]:
        """Give what a dataset says of the certificate."""
        return {
            "certificate": self.sentence,
            "certificate_nudge": self.wanted.nudge,
            "certificate_reach": self.wanted.reach,
            "certificate_resolution": RESOLUTION,
            "certificate_runs": self.runs,
        }


def certify(
    system: Assembly, plan: Plan, base: Beside, wanted: Certification, run: Run
) -> Certificate:
    """Make the certificate of a run.

    Parameters
    ----------
    system : Assembly
        The scene.
    plan : Plan
        The run's arguments.
    base : Beside
        What the run showed.
    wanted : Certification
        What to try.
    run : callable
        Makes a run and tells what it showed.

    Returns
    -------
    Certificate
    """
    if base.overturned is None:
        return Certificate(wanted, plan, base)
    bare = plan.bare()
    with warnings.catch_warnings():
        # the run itself has given them
        warnings.simplefilter("ignore", ModelWarning)
        finer = [
            (words, run(system, other)) for words, other in finer_plans(system, bare, base.step)
        ]
        nudged = _nudged(system, bare, base, wanted, run)
        most = max(wanted.runs - len(finer) - _number_of_runs(nudged), wanted.runs // 4)
        along = _scaled(system, bare, base, wanted, run, most)
    return Certificate(wanted, plan, base, finer, nudged, along)


def _nudged(
    system: Assembly, plan: Plan, base: Beside, wanted: Certification, run: Run
) -> list[tuple[str, Scan]]:
    """Change every parameter up and down, at the nudge and inside it."""
    every = list(parameters(system))
    fewest, most = PER_PARAMETER
    share = int(FOR_PARAMETERS * wanted.runs) // max(len(every), 1)
    row = [share * wanted.nudge for share in INSIDE]
    count = min(max(share, fewest), most)

    def along(scene_at: SceneAt) -> Scan:
        def look(change: float) -> Beside | None:
            scene = scene_at(change)
            return None if scene is None else _run_beside(scene, plan, run)

        return scan(look, base, row, most=count, resolution=NUDGE_RESOLUTION, close_in=False)

    return [(words, along(scene_at)) for words, scene_at in every]


def _scaled(
    system: Assembly, plan: Plan, base: Beside, wanted: Certification, run: Run, most: int
) -> Scan:
    """Scale the motion, or the start."""
    limits = system.setting.overturning_angles

    def look(change: float) -> Beside | None:
        other = scaled(plan, 1.0 + change, limits)
        return None if other is None else run(system, other)

    row = scales(wanted.nudge, wanted.reach)
    return scan(look, base, row, most=most, resolution=RESOLUTION)


def _run_beside(system: Assembly, plan: Plan, run: Run) -> Beside | None:
    """Run a nudged scene; with a sub-step more where those given have become too few."""
    try:
        return run(system, plan)
    except SolverError:
        return run(system, replace(plan, accuracy=replace(plan.accuracy, substeps=FEWEST)))
    except RockframeError:  # the start does not fit the nudged scene
        return None


def settles(base: Beside, finer: Beside) -> bool:
    """Whether a run by finer means has the verdict of a run, by more than they differ."""
    if not base.alike(finer):
        return False
    pairs = zip(base.clearances, finer.clearances, strict=True)
    return all(SAFETY * abs(a - b) < a for a, b in pairs)


def _number_of_runs(nudged: Sequence[tuple[str, Scan]]) -> int:
    return sum(len(found.tried) for _, found in nudged)
