"""How sure a verdict is: runs beside a run, with other tolerances, parameters and scales."""

import math
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

from rockframe.errors import ModelWarning, RockframeError
from rockframe.simulation.beginning import Continuation
from rockframe.simulation.certification import Certificate, Certification
from rockframe.simulation.plan import Plan
from rockframe.solve.accuracy import LEVELS, Accuracy, AccuracyLevel
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
    bare = replace(plan, output_step=None, energies=(), stop_at_overturning=True)
    fell = overturned(summary)
    peak = summary.peak_rotation
    with warnings.catch_warnings():
        # the run itself has given them
        warnings.simplefilter("ignore", ModelWarning)
        tighter = run(system, replace(bare, accuracy=tightened(plan.accuracy)))
        nudged = [(words, run(other, bare)) for words, other in nudges(system, wanted.nudge)]
        boundary = nearest_change(system, bare, fell, wanted.reach, run)
    changed = [words for words, other in nudged if overturned(other) != fell]
    certificate = Certificate(
        converged=overturned(tighter) == fell,
        robust=not changed,
        margin=wanted.reach if boundary.scale is None else abs(boundary.scale - 1.0),
        peak_error=abs(tighter.peak_rotation - peak),
        peak_sensitivity=max((abs(other.peak_rotation - peak) for _, other in nudged), default=0.0),
        runs=1 + len(nudged) + boundary.runs,
        sentence="",
    )
    return replace(
        certificate, sentence=_sentence(certificate, fell, changed, boundary.scale, wanted, plan)
    )


def overturned(summary: "Summary") -> bool:
    """Whether a run overturned."""
    return not math.isnan(summary.overturning_time)


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
    """Where the verdict changes: the scale nearest to one, or None; and the runs it took."""

    scale: float | None
    runs: int


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
    count = 0

    def differs(change: float) -> bool:
        nonlocal count
        other = scaled(plan, 1.0 + change, system.setting.overturning_angle)
        if other is None:
            return False
        count += 1
        return overturned(run(system, other)) != fell

    before = 0.0
    for change in changes:
        sides = [sign for sign in (-1.0, 1.0) if differs(sign * change)]
        if sides:
            found = []
            for sign in sides:
                near, far = before, change
                for _ in range(HALVINGS):
                    middle = 0.5 * (near + far)
                    if differs(sign * middle):
                        far = middle
                    else:
                        near = middle
                found.append(1.0 + sign * far)
            return Boundary(min(found, key=lambda scale: abs(scale - 1.0)), count)
        before = change
    return Boundary(None, count)


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


def _sentence(
    certificate: Certificate,
    fell: bool,
    changed: list[str],
    scale: float | None,
    wanted: Certification,
    plan: Plan,
) -> str:
    verdict, other = ("overturns", "stands") if fell else ("stands", "overturns")
    what = "the motion" if plan.motion is not None else "the start"
    finer = f"a tolerance {1.0 / TIGHTER:g} times tighter"
    if plan.accuracy.rtol is None:
        finer = "steps by tolerance instead of fixed ones"
    doubts: list[str] = []
    if not certificate.converged:
        doubts.append(f"with {finer} it {other}")
    if changed:
        more = f" (and {len(changed) - 1} more)" if len(changed) > 1 else ""
        doubts.append(f"with the {changed[0]}{more} it {other}")
    if scale is not None and certificate.margin <= NEAR:
        way = "up" if scale > 1.0 else "down"
        doubts.append(f"with {what} scaled {way} by {100.0 * certificate.margin:.2g} % it {other}")
    if doubts:
        return f"Near the boundary: the body {verdict}, but {'; '.join(doubts)}."
    far = f"for every scale of {what} tried from {1 - wanted.reach:g} to {1 + wanted.reach:g}"
    if scale is not None:
        far = f"until {what} is scaled by {scale:.3g}"
    return (
        f"The body {verdict} also with {finer}, with every "
        f"parameter {100.0 * wanted.nudge:g} % larger or smaller, and {far}."
    )
