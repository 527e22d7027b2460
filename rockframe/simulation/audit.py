"""Whether a run is a solution: what is said of one whose energies do not balance."""

from collections.abc import Callable
from dataclasses import replace
from typing import Final

from rockframe.simulation.beside import Beside
from rockframe.simulation.plan import Plan
from rockframe.solve.accuracy import LEVELS, AccuracyLevel
from rockframe.solve.trajectory import Summary
from rockframe.system.assembly import Assembly

BY_TOLERANCE: Final = 1e-3
"""Residual beyond which steps by tolerance give no solution; sound ones stay below 1e-5."""
FIXED: Final = 0.5
"""The same of fixed steps, whose works are less exact than their motion: sound ones reach 0.3."""
DOUBTFUL: Final = 1e-2
"""Residual of fixed steps beyond which it takes a run by tolerance to tell."""
DOUBTFUL_ON_SPRINGS: Final = 0.04
"""The same on a base that gives way, where works are less exact: of 40 000 random runs none
reached it, and those with half of it were wrong no more often than those with none."""
PEAK: Final = 0.01
"""Share by which the peak rotation of a sound run may differ from that."""

UNFELT: Final = 1e-4
"""Share of the overturning angle up to which a peak, or a difference of peaks, says nothing of the
verdict: the energies of such motion are errors as small as any step is allowed to make."""


def doubtful(system: Assembly) -> float:
    """Give the residual of fixed steps beyond which it takes a run by tolerance to tell."""
    return DOUBTFUL if system.setting.settlement is None else DOUBTFUL_ON_SPRINGS


def unbalanced(
    system: Assembly,
    plan: Plan,
    summary: Summary,
    base: Callable[[], Beside],
    run: Callable[[Plan], Beside],
) -> str | None:
    """Say that a run is no solution, where its energies show it.

    Parameters
    ----------
    system : Assembly
        The scene.
    plan : Plan
        The run's arguments.
    summary : Summary
        What became of it.
    base : callable
        Tells what it showed; called only where the energies are out of balance.
    run : callable
        Makes a run of the same scene; called only where the energies leave it open.

    Returns
    -------
    str or None
        What was found and what to do; None of a run that may be used.
    """
    residual, by_tolerance = summary.energy_residual, plan.accuracy.substeps is None
    if residual <= (BY_TOLERANCE if by_tolerance else doubtful(system)):
        return None
    shown = base()
    if shown.overturned is None:
        return None
    unfelt = shown.peak_share <= UNFELT
    if unfelt and by_tolerance:
        return None
    found = f"the energies are out of balance by {residual:.2g} of the largest"
    if by_tolerance:
        return f"{found}: this is no solution; repeat the run with a tighter tolerance"
    remedy = f"repeat the run with accuracy='{AccuracyLevel.STANDARD}'"
    if residual > FIXED and not unfelt:
        return f"{found}: this is no solution; {remedy}"
    standard = LEVELS[AccuracyLevel.STANDARD]
    other = run(replace(plan.bare(), accuracy=standard))
    if other.overturned is None:
        return None
    difference = abs(other.peak - shown.peak)
    if shown.alike(other) and difference <= PEAK * other.peak:
        return None
    if unfelt and other.overturned is False and other.peak_share <= UNFELT:
        return None
    ends = "overturns" if other.overturned else f"has a peak rotation of {other.peak:.4g} rad"
    return (
        f"{found}, and steps by tolerance give another course, which {ends}: this is no "
        f"solution; {remedy}"
    )
