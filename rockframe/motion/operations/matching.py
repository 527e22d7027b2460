"""Matching of the response spectrum of a ground motion to a target."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final, Protocol, runtime_checkable

import numpy as np

from rockframe.errors import ComponentError, RecordWarning, short_repr, warn
from rockframe.motion.matching.iteration import (
    MatchingGoal,
    MatchResult,
    match,
    matching_changes,
    unusual_changes,
)
from rockframe.motion.operations.derived import derived_motion, dropped_pieces_note
from rockframe.motion.processing.samples import time_step_for_period, warn_of_coarse_samples
from rockframe.motion.value import MotionType, replaced
from rockframe.signals import Signal
from rockframe.signals.arrays import Array
from rockframe.signals.spectra import check_cost
from rockframe.suggestions import with_hints
from rockframe.units import PERIOD, Condition, QuantityLike, RatioLike, to_ratio, to_si_values

USUAL_PERIODS: Final = ("0.1 s", "2 s")
USUAL_TOLERANCE: Final = 0.05
"""Default range of periods, and default tolerance [1], of matching."""

_TOLERANCE: Final = Condition("from 0.01 to 0.5", lambda value: 0.01 <= value <= 0.5)
_DAMPING: Final = Condition("from 0.01 to 0.5", lambda value: 0.01 <= value <= 0.5)
"""Spectra of less damping need too many wavelets; with more damping there is no resonance."""

_MIN_STEPS: Final = 4
"""Fewest time steps in the shortest period: fewer samples do not represent a wavelet."""

_MIN_PERIODS: Final = 3
"""Least duration of the motion over the longest period, so that a wavelet fits in [1]."""

_MAX_NUMBERS: Final = 5_000_000
"""Largest product of samples and periods; beyond it matching takes minutes and gigabytes."""

_ROUNDING: Final = 1e-9
_EXAMPLE: Final = "rf.TargetSpectrum.eurocode_8('0.2 g_0', 'B')"


@runtime_checkable
class Target(Protocol):
    """A target spectrum for matching, such as a :class:`rockframe.TargetSpectrum`."""

    @property
    def name(self) -> str:
        """Name for titles and messages."""
        ...

    @property
    def damping_ratio(self) -> float:
        """Damping ratio of the oscillators [1]."""
        ...

    def at_seconds(self, seconds: Array, *, owner: str) -> Array:
        """Return the pseudo-spectral accelerations [m s^-2] at periods [s]."""
        ...


@with_hints(damping_ratio="the target has one")
def matched(
    motion: MotionType,
    target: Target,
    *,
    periods: Sequence[QuantityLike] = USUAL_PERIODS,
    tolerance: RatioLike = USUAL_TOLERANCE,
) -> MotionType:
    """Match the response spectrum to a target by wavelets that are added in the time domain.

    Parameters
    ----------
    target : TargetSpectrum
        Target; its damping ratio, from 0.01 to 0.5, is that of the oscillators.
    periods : sequence of two str or Quantity, optional
        Shortest and longest period of the range in which the spectrum is matched. The shortest
        is at least four time steps, the longest at most a third of the duration [s].
    tolerance : float, optional
        Greatest misfit of the pseudo-spectral acceleration in the range, over the target; from
        0.01 to 0.5 [1].

    Returns
    -------
    GroundMotion
        Motion of the same length. The horizontal component is scaled and then matched; the
        vertical one is unchanged. The metadata state the result: ``largest_spectral_misfit`` and
        ``mean_spectral_misfit`` over the target, ``spectral_misfit``
        (:eq:`eq-spectral-misfit`), ``scale_factor``, ``matching_steps``, and ``target_reached``,
        1 or 0. They state the changes of the scaled motion, each as ``..._before_matching`` and
        ``..._after_matching``: ``peak_ground_acceleration``, ``peak_ground_velocity``,
        ``peak_ground_displacement`` and ``pulse_indicator`` (:eq:`eq-pulse-indicator`).
        ``spectral_growth_beyond_range`` is the greatest growth of the spectrum between the
        longest period and five times that, at ``period_of_spectral_growth``. A motion within
        the tolerance is not changed.

    Raises
    ------
    UnitsError
        Periods without a unit, or with one of another kind; a tolerance that is not a ratio.
    ComponentError
        Not a target, or one that is undefined or not above zero somewhere in the range; a damping
        ratio, range or tolerance out of bounds; a motion without acceleration, one that is too
        short, or one so long that matching would take minutes.

    Warns
    -----
    RecordWarning
        The tolerance is not reached, and the best motion found is returned. Or the shortest
        period is less than ten time steps. Or a peak, or the spectrum beyond the range, has grown
        by a factor above 1.5, or the motion has become pulse-like (indicator above 0.85).

    Notes
    -----
    The method is that of Al Atik and Abrahamson (2010). Improved tapered cosine wavelets, which
    keep velocity and displacement at the end, are added at the times of the peaks of the
    oscillators. Groups of periods are included from the shortest to the longest.

    Examples
    --------
    >>> import rockframe as rf
    >>> record = rf.GroundMotion.example("loma-prieta").window("5 s", "20 s")
    >>> target = rf.TargetSpectrum.eurocode_8("0.1 g_0", "B")
    >>> matched = record.matched(target, periods=("0.2 s", "0.5 s"))
    >>> matched.metadata["largest_spectral_misfit"] <= 0.05
    True
    """
    owner, si = f"{type(motion).__name__}.matched", motion.si
    goal = _goal(target, periods, tolerance, owner)
    _check_motion(motion, si.horizontal, goal, owner)
    result = match(si.horizontal, goal)
    reached = result.misfit <= goal.tolerance
    words = _words(target, goal, result)
    scaled = si.horizontal
    if result.signal is not scaled:
        samples = result.scale_factor * scaled.samples
        scaled = replace(scaled, samples=samples, polynomials=None)
    changed = matching_changes(scaled, result.signal, goal)
    added = {**_attributes_of(motion, target, result), "target_reached": int(reached), **changed}
    if not reached:
        worst = float(goal.checked[np.abs(result.ratios - 1.0).argmax()])
        msg = (
            f"{owner}: {motion.name!r} is {100.0 * result.misfit:.3g} % from {target.name!r} at "
            f"{worst:.3g} s, and {100.0 * result.mean_misfit:.2g} % on "
            f"average; {100.0 * goal.tolerance:.3g} % was not reached in {result.steps} steps. "
            "Another record, a narrower range of periods or a wider tolerance may help"
        )
        warn(msg, RecordWarning)
    grown = unusual_changes(changed)
    if grown:
        msg = (
            f"{owner}: the wavelets have changed {motion.name!r} beyond its spectrum: "
            f"{', '.join(grown)}. Such a motion may overturn what the scaled one does not: take a "
            "record whose spectrum is closer to the target, or a narrower range of periods"
        )
        warn(msg, RecordWarning)
    if result.signal is si.horizontal:
        metadata, history = {**motion.metadata, **added}, (*motion.history, words)
        return replaced(motion, metadata=metadata, history=history)
    across = replace(si, horizontal=result.signal)
    return derived_motion(motion, across, words, *dropped_pieces_note(si), metadata=added)


def _goal(target: object, periods: object, tolerance: RatioLike, owner: str) -> MatchingGoal:
    if not isinstance(target, Target):
        msg = f"{owner}: target needs a TargetSpectrum, got {short_repr(target)}; write {_EXAMPLE}"
        raise ComponentError(msg)
    seconds = to_si_values(periods, PERIOD, owner=owner, name="periods")
    if len(seconds) != 2 or not 0.0 < seconds[0] < seconds[1] < math.inf:
        msg = (
            f"{owner}: periods must be the shortest and the longest, above zero and increasing, "
            f"for example ('0.1 s', '2 s'), got {short_repr(periods)}"
        )
        raise ComponentError(msg)
    damping = to_ratio(
        target.damping_ratio, owner=owner, name="target.damping_ratio", condition=_DAMPING
    )
    within = to_ratio(tolerance, owner=owner, name="tolerance", condition=_TOLERANCE)
    shortest, longest = seconds
    goal = MatchingGoal(
        lambda at: target.at_seconds(at, owner=owner), shortest, longest, damping, within
    )
    target_values = goal.spectrum(goal.checked)
    if not (np.isfinite(target_values).all() and (target_values > 0.0).all()):
        worst = float(
            goal.checked[int(np.argmin(np.where(target_values > 0.0, target_values, -math.inf)))]
        )
        msg = f"{owner}: {target.name!r} must be above zero, which it is not at {worst:.4g} s"
        raise ComponentError(msg)
    return goal


def _check_motion(motion: Any, signal: Signal, goal: MatchingGoal, owner: str) -> None:
    if not np.any(signal.pieces):
        msg = f"{owner}: {motion.name!r} has no acceleration; it cannot be matched"
        raise ComponentError(msg)
    step, shortest, longest = signal.time_step, goal.shortest, goal.longest
    if shortest < _MIN_STEPS * step * (1.0 - _ROUNDING):
        msg = (
            f"{owner}: the shortest period, {shortest:.4g} s, must be {_MIN_STEPS} time steps or "
            f"more, {_MIN_STEPS * step:.4g} s; resample the motion, for example "
            f"resampled('{time_step_for_period(step, shortest):.4g} s')"
        )
        raise ComponentError(msg)
    if signal.duration < _MIN_PERIODS * longest:
        msg = (
            f"{owner}: the motion must be {_MIN_PERIODS} times as long as the longest period, "
            f"{longest:.4g} s; it is {signal.duration:.4g} s long"
        )
        raise ComponentError(msg)
    check_cost(signal, goal.checked, owner=owner)
    numbers = goal.matched.size * signal.samples.size
    if numbers > _MAX_NUMBERS:
        msg = (
            f"{owner}: {signal.samples.size} samples at {goal.matched.size} periods are too many; "
            f"expected at most {_MAX_NUMBERS // goal.matched.size} samples: cut the strong part "
            "out with window(), or resample it"
        )
        raise ComponentError(msg)
    warn_of_coarse_samples([replace(signal, polynomials=None)], shortest, owner=owner)


def _attributes_of(
    motion: Any, target: Target, result: MatchResult
) -> dict[str, str | float | int]:
    before = motion.metadata.get("scale_factor")
    factor = result.scale_factor * (before if isinstance(before, int | float) else 1.0)
    return {
        "target_spectrum": target.name,
        "scale_factor": factor,
        "spectral_misfit": float(np.sqrt((np.log(result.ratios) ** 2).mean())),
        "largest_spectral_misfit": result.misfit,
        "mean_spectral_misfit": result.mean_misfit,
        "matching_steps": result.steps,
    }


def _words(target: Target, goal: MatchingGoal, result: MatchResult) -> str:
    where = (
        f"{target.name}, damping ratio {goal.damping_ratio:.6g}, from {goal.shortest:.6g} s to "
        f"{goal.longest:.6g} s"
    )
    close = (
        f"the spectrum is within {100.0 * result.misfit:.3g} % of the target, "
        f"{100.0 * result.mean_misfit:.2g} % on the average"
    )
    if result.steps == 0 and result.scale_factor == 1.0:
        return f"not changed to match {where}: {close}"
    return (
        f"scaled by {result.scale_factor!r} and matched to {where}, in {result.steps} steps with "
        f"tapered cosine wavelets (Al Atik and Abrahamson 2010): {close}"
    )
