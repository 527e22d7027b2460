"""How sure a verdict is: runs beside a run, by finer means, nudged and scaled."""

import math
import warnings
from dataclasses import replace
from typing import Final

import numpy as np

from rockframe.errors import ModelWarning, RockframeError, SolverError
from rockframe.simulation.beside import Beside, Run
from rockframe.simulation.certificate_words import sentence
from rockframe.simulation.certification import Certificate, Certification
from rockframe.simulation.finer import finer_plans
from rockframe.simulation.nudging import SceneAt, parameters, scaled, scales
from rockframe.simulation.plan import Plan
from rockframe.simulation.scan import Scan, scan
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

NONE: Final = Certificate(
    converged=False,
    robust=False,
    margin=math.nan,
    flip=math.nan,
    peak_error=math.nan,
    peak_sensitivity=math.nan,
    runs=0,
    resolution=RESOLUTION,
    sentence="No certificate: the run was not finished.",
)
"""Of a run without a verdict."""


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
        return NONE
    bare = replace(plan, output_step=None, requested=(), points=())
    with warnings.catch_warnings():
        # the run itself has given them
        warnings.simplefilter("ignore", ModelWarning)
        finer = [
            (words, run(system, other)) for words, other in finer_plans(system, bare, base.step)
        ]
        nudged = _nudged(system, bare, base, wanted, run)
        nearby = [shown for _, found in nudged for shown in found.tried.values()]
        spent = len(finer) + len(nearby)
        most = max(wanted.runs - spent, wanted.runs // 4)
        along = _scaled(system, bare, base, wanted, run, most)
    margin = along.margin if along.tried else math.nan
    followed = all(found.flip is None and found.followed for _, found in nudged)
    certificate = Certificate(
        converged=all(settles(base, other) for _, other in finer),
        robust=followed and not margin < wanted.nudge,
        margin=margin,
        flip=math.nan if along.flip is None else 1.0 + along.flip,
        peak_error=SAFETY * _farthest(base, [other for _, other in finer]),
        peak_sensitivity=_farthest(base, nearby),
        runs=spent + len(along.tried),
        resolution=RESOLUTION,
        sentence="",
    )
    text = sentence(certificate, base, finer, nudged, along, wanted, plan)
    return replace(certificate, sentence=text)


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
    stopping = replace(plan, stop_at_overturning=True)
    limits = system.setting.overturning_angles

    def look(change: float) -> Beside | None:
        other = scaled(stopping, 1.0 + change, limits)
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


def _farthest(base: Beside, others: list[Beside]) -> float:
    """Give the largest difference of peak rotations; NaN if a run was cut off before its own."""
    apart = [math.nan if one.overturned is None else abs(one.peak - base.peak) for one in others]
    return float(np.max(apart, initial=0.0))
