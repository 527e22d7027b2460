"""Plans of the further runs of a certificate: of higher accuracy, and with changed inputs."""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Final

from rockframe.dynamics.protocol import Ending
from rockframe.errors import RockframeError
from rockframe.motion import GroundMotion
from rockframe.motion.processing.samples import divided_signal
from rockframe.simulation.plan import Plan
from rockframe.solve.accuracy import LEVELS, Accuracy, AccuracyLevel
from rockframe.system.assembly import Assembly, assemble_parts
from rockframe.system.bodies import OverturningAngles

FIRST_SHARES: Final = (0.25, 0.5)
"""First changes of scale, as shares of the nudge."""
SCALE_RATIO: Final = 1.25
"""Ratio of each further change of scale to the one before it, a geometric sequence."""
MAX_SPACING: Final = 0.04
"""Largest distance between two changes of scale, over the reach."""

SceneAt = Callable[[float], Assembly | None]


def parameters(system: Assembly) -> Iterator[tuple[str, SceneAt]]:
    """Return the name of each parameter, and a function that gives the scene with it changed."""
    parts = system.parts

    def changed(slot: str, name: str) -> SceneAt:
        def at(change: float) -> Assembly | None:
            try:
                part = parts[slot].with_scaled(name, 1.0 + change)
                return assemble_parts(parts.replace(**{slot: part}, motion=None), system.options)
            except RockframeError:
                return None

        return at

    named = parts.named_links
    labels = {id(link): name for name, link in named} if len(named) > 1 else {}
    for slot, part in parts.components.items():
        owner = labels.get(id(part), f"the {part.noun}")
        for name in part.parameters():
            if name == "friction" and not system.setting.slides:  # it changes no motion
                continue
            yield f"{name.replace('_', ' ')} of {owner}", changed(slot, name)


def scales(nudge: float, reach: float) -> list[float]:
    """Return the first changes of scale to try, from a share of the nudge up to the reach."""
    row = [share * nudge for share in FIRST_SHARES if share * nudge < reach]
    place = min(nudge, reach)
    while place < reach:
        row.append(place)
        place += min((SCALE_RATIO - 1.0) * place, MAX_SPACING * reach)
    if len(row) > 1 and reach - row[-1] < 0.5 * (row[-1] - row[-2]):
        row.pop()
    return [*row, reach]


def scaled_plan(plan: Plan, scale: float, limits: OverturningAngles) -> Plan | None:
    """Scale the motion of a run or, without one, its start; None if that is not possible."""
    if plan.motion is not None:
        return replace(plan, motion=plan.motion.scaled(scale))
    start = plan.initial
    if isinstance(start, Ending):
        return None
    if not start.si.rotation and start.si.angular_velocity == 0.0:
        return None
    try:
        for name in ("rotation", "angular_velocity"):
            if name in start.parameters():
                start = start.with_scaled(name, scale)
    except RockframeError:
        return None
    rotation = start.si.rotation or 0.0
    if abs(rotation) >= limits.on_side_of(rotation):
        return None
    return replace(plan, initial=start)


TIGHTER: Final = 0.01
"""Tolerance of a finer run, over that of the run."""
TIGHTEST: Final = 1e-13
"""Smallest tolerance of a finer run: below it rounding errors dominate."""
SHORTER: Final = 2.7
"""Step of the run over the longest step of a finer one; not an integer, so that steps do not end
at the same times."""
DIVISIONS: Final = (3, 4, 8)
"""Numbers of parts into which the intervals of the motion are divided."""
MAX_SUBSTEPS: Final = 10**6
MAX_STEPS_PER_PERIOD: Final = 1e4


def finer_plans(system: Assembly, plan: Plan, step: float) -> Iterator[tuple[str, Plan]]:
    """Return the plans of finer runs, each with what is finer, by the mean step of the run [s]."""
    accuracy = plan.accuracy
    yield tolerance_words(accuracy), replace(plan, accuracy=with_tighter_tolerance(accuracy))
    yield (
        f"steps {SHORTER:g} times shorter",
        replace(plan, accuracy=with_shorter_steps(accuracy, system, step, plan.interval)),
    )
    if plan.motion is None:
        return
    for parts in DIVISIONS:
        try:
            motion = divide_intervals(plan.motion, parts)
        except RockframeError:  # more samples than a motion may have
            continue
        yield f"every interval of the motion divided into {parts}", replace(plan, motion=motion)


def tolerance_words(accuracy: Accuracy) -> str:
    """Say what is finer in a run of :func:`with_tighter_tolerance` settings."""
    if accuracy.rtol is None:
        return "adaptive steps instead of fixed ones"
    if accuracy.rtol <= TIGHTEST:
        return "the same tolerance"
    return f"a tolerance {min(1.0 / TIGHTER, accuracy.rtol / TIGHTEST):.3g} times tighter"


def with_tighter_tolerance(accuracy: Accuracy) -> Accuracy:
    """Return settings with a tighter tolerance, or with a tolerance instead of fixed sub-steps."""
    if accuracy.rtol is None:
        return LEVELS[AccuracyLevel.STANDARD]
    return replace(accuracy, rtol=max(TIGHTER * accuracy.rtol, TIGHTEST))


def with_shorter_steps(
    accuracy: Accuracy, system: Assembly, step: float, interval: float
) -> Accuracy:
    """Return settings with shorter steps than the mean one of a run; interval of its motion [s]."""
    shorter = step / SHORTER
    if accuracy.substeps is not None:
        value = accuracy.substeps if isinstance(accuracy.substeps, int) else 1
        substeps = math.ceil(max(interval / shorter, SHORTER * value))
        return replace(accuracy, substeps=min(substeps, MAX_SUBSTEPS))
    period = 2.0 * math.pi / system.model.fastest_frequency
    per_period = max(period / shorter, SHORTER * accuracy.steps_per_period)
    return replace(accuracy, steps_per_period=min(per_period, MAX_STEPS_PER_PERIOD))


def divide_intervals(motion: GroundMotion, parts: int) -> GroundMotion:
    """Return the same function of time, with each interval divided into parts."""
    return GroundMotion(
        motion.si.each(lambda signal: divided_signal(signal, parts)), name=motion.name
    )
