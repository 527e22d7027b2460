"""How sure a verdict is: runs beside a run, with other tolerances, parameters and scales."""

import math
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from rockframe.errors import ModelWarning, RockframeError, SolverError
from rockframe.simulation.beginning import Continuation
from rockframe.simulation.certification import Certificate, Certification
from rockframe.simulation.plan import Plan
from rockframe.solve.accuracy import FEWEST, LEVELS, Accuracy, AccuracyLevel
from rockframe.system.assembly import Assembly

if TYPE_CHECKING:
    from rockframe.solve.trajectory import Summary

TIGHTER: Final = 0.01
"""Tolerance of the run beside, over that of the run."""
TIGHTEST: Final = 1e-13
"""Tolerance beyond which rounding rules."""
FIRST_SCALE: Final = 1e-3
"""First change of the scale that is tried, and the resolution of a margin."""
SCALES: Final = 12
"""Changes of the scale that are tried, to each side, in a geometric row."""
HALVINGS: Final = 6
"""Bisections of the interval in which the verdict changes."""
NEAR: Final = 0.01
"""A margin up to which a verdict is called near the boundary [1]."""

NONE: Final = Certificate(
    converged=False,
    robust=False,
    margin=math.nan,
    peak_error=math.nan,
    peak_sensitivity=math.nan,
    runs=0,
    sentence="No certificate: the run was not finished.",
)
"""Of a run without a verdict."""

Run = Callable[[Assembly, Plan], "Summary"]


def certify(
    system: Assembly, plan: Plan, summary: "Summary", wanted: Certification, run: Run
) -> Certificate:
    """Make the certificate of a run.

    Parameters
    ----------
    system : Assembly
        The scene.
    plan : Plan
        The run's arguments.
    summary : Summary
        What became of it.
    wanted : Certification
        What to try.
    run : callable
        Makes a run and gives what became of it.

    Returns
    -------
    Certificate
    """
    fell = summary.overturned
    if fell is None:
        return NONE
    bare = replace(plan, output_step=None, energies=())
    stopping = replace(bare, stop_at_overturning=True)
    peak = summary.peak_rotation
    with warnings.catch_warnings():
        # the run itself has given them
        warnings.simplefilter("ignore", ModelWarning)
        tighter = run(system, replace(bare, accuracy=tightened(plan.accuracy)))
        nudged = [
            (words, _run_beside(other, bare, run)) for words, other in nudges(system, wanted.nudge)
        ]
        boundary = nearest_change(system, stopping, fell, wanted.reach, run)
    distances = [_distance(other, peak) for _, other in nudged]
    changed = [(words, other.overturned) for words, other in nudged if other.overturned != fell]
    certificate = Certificate(
        converged=tighter.overturned == fell,
        robust=not changed,
        margin=boundary.margin(wanted.reach),
        peak_error=_distance(tighter, peak),
        peak_sensitivity=float(np.max(distances, initial=0.0)),
        runs=1 + len(nudged) + boundary.runs,
        sentence="",
    )
    doubts = list(_doubts(certificate, tighter.overturned, changed, boundary, plan))
    return replace(certificate, sentence=_sentence(fell, doubts, boundary, wanted, plan))


def _run_beside(system: Assembly, plan: Plan, run: Run) -> "Summary":
    """Run a nudged scene; with a sub-step more where those given have become too few."""
    try:
        return run(system, plan)
    except SolverError:
        return run(system, replace(plan, accuracy=replace(plan.accuracy, substeps=FEWEST)))


def _distance(other: "Summary", peak: float) -> float:
    """Give the difference of a peak rotation; NaN if the run was cut off before its peak."""
    return math.nan if other.overturned is None else abs(other.peak_rotation - peak)


def tightened(accuracy: Accuracy) -> Accuracy:
    """Give finer settings: a tighter tolerance, or one instead of fixed sub-steps."""
    if accuracy.rtol is None:
        return LEVELS[AccuracyLevel.STANDARD]
    return replace(accuracy, rtol=max(TIGHTER * accuracy.rtol, TIGHTEST))


def nudges(system: Assembly, nudge: float) -> Iterator[tuple[str, Assembly]]:
    """Give the scene with each of its parameters a little smaller, and a little larger.

    A change that makes parts misfit is left out.

    Parameters
    ----------
    system : Assembly
        The scene.
    nudge : float
        Relative change [1].

    Yields
    ------
    str, Assembly
        What was changed, in words, and the scene.
    """
    description = system.to_dict()
    options = {name: str(value) for name, value in description.items() if name != "parts"}
    parts = system.parts.structural()
    for place, part in enumerate(parts):
        for name in part.parameters():
            for change in (-nudge, nudge):
                try:
                    changed = part.with_scaled(name, 1.0 + change)
                    together = [*parts[:place], changed, *parts[place + 1 :]]
                    scene = type(system)(*together, **options)
                except RockframeError:
                    continue
                words = f"{name.replace('_', ' ')} of the {part.noun} {100.0 * change:+.3g} %"
                yield words, scene


@dataclass(frozen=True)
class Boundary:
    """Where the verdict changes.

    Parameters
    ----------
    scale : float or None
        The scale nearest to one with another verdict, if there is one.
    overturned : bool or None
        That verdict; None where the run was not finished.
    runs : int
        Number of runs that it took.
    """

    scale: float | None
    overturned: bool | None
    runs: int

    def margin(self, reach: float) -> float:
        """Give its distance, or the reach of what was tried; NaN if nothing was."""
        if self.runs == 0:
            return math.nan
        return reach if self.scale is None else abs(self.scale - 1.0)


def nearest_change(system: Assembly, plan: Plan, fell: bool, reach: float, run: Run) -> Boundary:
    """Find the scale of the motion nearest to one that changes the verdict.

    Overturning is no monotonic function of the scale: scales in a geometric row are tried
    to both sides, and the first interval in which the verdict changes is bisected.

    Parameters
    ----------
    system : Assembly
        The scene.
    plan : Plan
        The run's arguments.
    fell : bool
        Whether the run overturned.
    reach : float
        Largest relative change of the scale [1].
    run : callable
        Makes a run and gives what became of it.

    Returns
    -------
    Boundary
    """
    changes = [FIRST_SCALE * (reach / FIRST_SCALE) ** (k / (SCALES - 1)) for k in range(SCALES)]
    verdicts: dict[float, bool | None] = {}

    def differs(change: float) -> bool:
        other = scaled(plan, 1.0 + change, system.setting.overturning_angle)
        if other is None:
            return False
        verdicts[change] = run(system, other).overturned
        return verdicts[change] != fell

    before = 0.0
    for change in changes:
        sides = [sign for sign in (-1.0, 1.0) if differs(sign * change)]
        if sides:
            found: list[float] = []
            for sign in sides:
                near, far = before, change
                for _ in range(HALVINGS):
                    middle = 0.5 * (near + far)
                    if differs(sign * middle):
                        far = middle
                    else:
                        near = middle
                found.append(sign * far)
            nearest = min(found, key=abs)
            return Boundary(1.0 + nearest, verdicts[nearest], len(verdicts))
        before = change
    return Boundary(None, None, len(verdicts))


def scaled(plan: Plan, scale: float, theta: float) -> Plan | None:
    """Scale what drives a run: its motion, or without one its start; None if it cannot be."""
    if plan.motion is not None:
        return replace(plan, motion=plan.motion.scaled(scale))
    start = plan.initial
    if isinstance(start, Continuation):
        return None
    if start.si.rotation == 0.0 and start.si.angular_velocity == 0.0:
        return None
    try:
        for name in ("rotation", "angular_velocity"):
            if name in start.parameters():
                start = start.with_scaled(name, scale)
    except RockframeError:
        return None
    if abs(start.si.rotation) >= theta:
        return None
    return replace(plan, initial=start)


def _doubts(
    certificate: Certificate,
    tighter: bool | None,
    changed: list[tuple[str, bool | None]],
    boundary: Boundary,
    plan: Plan,
) -> Iterator[str]:
    """Say which runs beside ended otherwise."""
    if not certificate.converged:
        yield f"with {_finer(plan)} {_ends(tighter)}"
    if changed:
        (words, other), more = changed[0], len(changed) - 1
        yield f"with the {words}{f' (and {more} more)' if more else ''} {_ends(other)}"
    if boundary.scale is not None and certificate.margin <= NEAR:
        way = "up" if boundary.scale > 1.0 else "down"
        share = f"{100.0 * certificate.margin:.2g} %"
        yield f"with {_driver(plan)} scaled {way} by {share} {_ends(boundary.overturned)}"


def _sentence(
    fell: bool, doubts: list[str], boundary: Boundary, wanted: Certification, plan: Plan
) -> str:
    verdict = "overturns" if fell else "stands"
    if doubts:
        return f"Near the boundary: the body {verdict}, but {'; '.join(doubts)}."
    text = f"The body {verdict} also with {_finer(plan)}"
    nudged = f"with every parameter {100.0 * wanted.nudge:g} % larger or smaller"
    if boundary.runs == 0:
        return f"{text} and {nudged}."
    what = _driver(plan)
    far = f"for every scale of {what} tried from {1 - wanted.reach:g} to {1 + wanted.reach:g}"
    if boundary.scale is not None:
        far = f"until {what} is scaled by {boundary.scale:.3g}"
    return f"{text}, {nudged}, and {far}."


def _ends(fell: bool | None) -> str:
    if fell is None:
        return "the run cannot be finished"
    return "it overturns" if fell else "it stands"


def _driver(plan: Plan) -> str:
    return "the motion" if plan.motion is not None else "the start"


def _finer(plan: Plan) -> str:
    if plan.accuracy.rtol is None:
        return "steps by tolerance instead of fixed ones"
    return f"a tolerance {1.0 / TIGHTER:g} times tighter"
