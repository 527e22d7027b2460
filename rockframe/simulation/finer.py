"""The same run by finer means: a tighter tolerance, shorter steps, a motion cut finer."""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from rockframe.errors import RockframeError
from rockframe.motion import GroundMotion
from rockframe.motion.processing.sampling import divided
from rockframe.simulation.plan import Plan
from rockframe.solve.accuracy import LEVELS, Accuracy, AccuracyLevel
from rockframe.solve.integrate import STILL_INTERVAL
from rockframe.system.assembly import Assembly

TIGHTER: Final = 0.01
"""Tolerance of a finer run, over that of the run."""
TIGHTEST: Final = 1e-13
"""Tolerance beyond which rounding rules."""
SHORTER: Final = 2.7
"""Step of the run over the longest of a finer one; no whole number, so that steps end elsewhere."""
CUTS: Final = (3, 4, 8)
"""Parts into which the intervals of the motion are cut."""
MOST_SUBSTEPS: Final = 10**6
MOST_PER_PERIOD: Final = 1e4


def finer_plans(system: Assembly, plan: Plan, step: float) -> Iterator[tuple[str, Plan]]:
    """Give the same run by finer means, each independent of the others.

    Parameters
    ----------
    system : Assembly
        The scene.
    plan : Plan
        The run's arguments.
    step : float
        Average length of its steps [s].

    Yields
    ------
    str, Plan
        What is finer, in words, and the arguments.
    """
    accuracy = plan.accuracy
    interval = STILL_INTERVAL if plan.motion is None else plan.motion.si.time_step
    yield tolerance_words(accuracy), replace(plan, accuracy=tightened(accuracy))
    yield (
        f"steps {SHORTER:g} times shorter",
        replace(plan, accuracy=shortened(accuracy, system, step, interval)),
    )
    if plan.motion is None:
        return
    for parts in CUTS:
        try:
            motion = cut(plan.motion, parts)
        except RockframeError:  # more samples than a motion may have
            continue
        yield f"every interval of the motion cut into {parts}", replace(plan, motion=motion)


def tolerance_words(accuracy: Accuracy) -> str:
    """Say what is finer in a run of :func:`tightened` settings."""
    if accuracy.rtol is None:
        return "steps by tolerance instead of fixed ones"
    if accuracy.rtol <= TIGHTEST:
        return "the same tolerance"
    return f"a tolerance {min(1.0 / TIGHTER, accuracy.rtol / TIGHTEST):.3g} times tighter"


def tightened(accuracy: Accuracy) -> Accuracy:
    """Give finer settings: a tighter tolerance, or one instead of fixed sub-steps."""
    if accuracy.rtol is None:
        return LEVELS[AccuracyLevel.STANDARD]
    return replace(accuracy, rtol=max(TIGHTER * accuracy.rtol, TIGHTEST))


def shortened(accuracy: Accuracy, system: Assembly, step: float, interval: float) -> Accuracy:
    """Give settings whose longest step is shorter than the run's steps were on average.

    Parameters
    ----------
    accuracy : Accuracy
        The run's settings.
    system : Assembly
        The scene.
    step : float
        Average length of the run's steps [s].
    interval : float
        Time between the motion's samples [s].

    Returns
    -------
    Accuracy
    """
    wanted = step / SHORTER
    if accuracy.substeps is not None:
        given = accuracy.substeps if isinstance(accuracy.substeps, int) else 1
        substeps = math.ceil(max(interval / wanted, SHORTER * given))
        return replace(accuracy, substeps=min(substeps, MOST_SUBSTEPS))
    period = 2.0 * math.pi / system.model.fastest_frequency
    per_period = max(period / wanted, SHORTER * accuracy.steps_per_period)
    return replace(accuracy, steps_per_period=min(per_period, MOST_PER_PERIOD))


def cut(motion: GroundMotion, parts: int) -> GroundMotion:
    """Give the same function of time by shorter intervals.

    Parameters
    ----------
    motion : GroundMotion
        The motion.
    parts : int
        Parts of each interval.

    Returns
    -------
    GroundMotion
        Straight lines stay straight lines, polynomials the same polynomials.
    """
    return GroundMotion(motion.si.each(lambda one: divided(one, parts)), name=motion.name)
