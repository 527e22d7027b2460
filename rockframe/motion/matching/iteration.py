"""Iteration of adjustments until the spectrum matches the target, and a comparison of motions."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockframe.motion.matching.adjustment import OscillatorPeaks, Oscillators, make_adjustment
from rockframe.motion.processing import velocity_pulses
from rockframe.signals import Signal
from rockframe.signals.arrays import Array
from rockframe.signals.integrals import ground_path
from rockframe.signals.motion import absolute_peak, knots_of
from rockframe.signals.spectra import pseudo_spectra, spectral_peaks

_SPACING: Final = 0.5
"""Relative distance of matched periods over the damping ratio: a fourth of a resonance's width."""

_MIN_SPACING: Final = 0.0125
_MAX_SPACING: Final = 0.05
"""Limits of the relative distance of matched periods [1]."""

_CHECKED_PER_MATCHED: Final = 8
"""Number of periods of the checked spectrum for each matched period."""

_DECADES_PER_PASS: Final = 0.45
"""Range of periods that each pass adds, in decades."""

_STEPS_PER_PASS: Final = 10
"""Most adjustments in a pass."""

_STEPS_BETWEEN_CHECKS: Final = 6
_MAX_CHECKS: Final = 12
"""Adjustments between checks of the whole spectrum, and most checks."""

_PATIENCE: Final = 3
_MIN_REDUCTION: Final = 0.95
"""The iteration ends after this number of checks that do not reduce the misfit by this factor."""

_MATCHED_MISFIT: Final = 0.6
"""Misfit to reach at matched periods, over the tolerance [1]."""

_CHECKED_MISFIT: Final = 0.95
"""Misfit to reach in the checked spectrum, which has cusps, over the tolerance [1]."""

_ADDED_MISFIT: Final = 0.8
"""Misfit over the tolerance above which a checked period is added to the matched ones [1]."""

_FIRST_REGULARISATION: Final = 1e-2
_MIN_REGULARISATION: Final = 1e-5
"""Regularisation of the first adjustment of a pass, and its least value [1]."""

_INCREASE_FACTOR: Final = 5.0
_DECREASE_FACTOR: Final = 0.3
"""Factors of the regularisation after a failed and after a full adjustment [1]."""

_STEP_LENGTHS: Final = (1.0, 0.5, 0.25)
"""Fractions of an adjustment that are tried."""

_MAX_TRIALS: Final = 4
"""Most regularisations that are tried before a pass ends."""

_POWER: Final = 4.0
"""Exponent of the misfits in the norm that every adjustment reduces; large ones dominate."""


class MatchingGoal(NamedTuple):
    """Target, range and tolerance of matching."""

    spectrum: Callable[[Array], Array]  # pseudo-accelerations [m s^-2] at periods [s]
    shortest: float  # range of matched periods [s]
    longest: float
    damping_ratio: float  # damping ratio of the oscillators [1]
    tolerance: float  # greatest misfit, over the target [1]

    @property
    def matched(self) -> Array:
        """The periods at which wavelets are added, shape (k,) [s]."""
        spacing = min(max(_SPACING * self.damping_ratio, _MIN_SPACING), _MAX_SPACING)
        count = math.ceil(math.log(self.longest / self.shortest) / math.log1p(spacing)) + 1
        return np.geomspace(self.shortest, self.longest, max(count, 2))

    @property
    def checked(self) -> Array:
        """The periods at which the spectrum is checked, shape (c,) [s]."""
        count = _CHECKED_PER_MATCHED * (self.matched.size - 1) + 1
        return np.geomspace(self.shortest, self.longest, count)

    def ratios(self, signal: Signal) -> Array:
        """Return the spectrum over the target at the checked periods, shape (c,) [1]."""
        periods = self.checked
        displacement = spectral_peaks(signal, periods, self.damping_ratio)[:, 0]
        return pseudo_spectra(signal, periods, displacement)[1] / self.spectrum(periods)


class MatchResult(NamedTuple):
    """The best motion found, with its spectrum."""

    signal: Signal  # the motion
    scale_factor: float  # factor applied before wavelets were added [1]
    ratios: Array  # spectrum over the target at the checked periods [1]
    steps: int  # number of adjustments

    @property
    def misfit(self) -> float:
        """The greatest misfit over the target [1]."""
        return float(np.abs(self.ratios - 1.0).max())

    @property
    def mean_misfit(self) -> float:
        """The mean misfit over the target [1]."""
        return float(np.abs(self.ratios - 1.0).mean())


def match(signal: Signal, goal: MatchingGoal) -> MatchResult:
    """Scale a motion, and add wavelets until its spectrum matches the target."""
    best = MatchResult(signal, 1.0, goal.ratios(signal), 0)
    if best.misfit <= goal.tolerance:
        return best
    factor = math.exp(-float(np.log(best.ratios).mean()))
    best = _checked(goal, signal, factor * signal.samples, factor, 0)
    periods = goal.matched
    run = _Iteration(signal.time_step, best.signal.samples, goal, periods)
    passes = max(1, math.ceil(math.log10(goal.longest / goal.shortest) / _DECADES_PER_PASS))
    for limit in np.geomspace(goal.shortest, goal.longest, passes + 1)[1:-1]:
        run.improve(periods <= limit, _STEPS_PER_PASS)
        run.reset_regularisation()
    stalled_checks, before = 0, math.inf
    for _ in range(_MAX_CHECKS):
        done = run.improve(np.ones(periods.size, dtype=bool), _STEPS_BETWEEN_CHECKS)
        current = _checked(goal, signal, run.samples, factor, run.steps)
        best = min(best, current, key=lambda state: state.misfit)
        if best.misfit < _MIN_REDUCTION * before:
            stalled_checks, before = 0, best.misfit
        else:
            stalled_checks += 1
        if best.misfit <= _CHECKED_MISFIT * goal.tolerance or stalled_checks >= _PATIENCE:
            break
        if done:
            exceeding = np.abs(current.ratios - 1.0) > _ADDED_MISFIT * goal.tolerance
            more = np.union1d(periods, goal.checked[exceeding])
            if more.size == periods.size:
                break
            periods = more
            run = _Iteration(signal.time_step, run.samples, goal, periods, run.steps)
    return best


def _checked(
    goal: MatchingGoal, signal: Signal, samples: Array, factor: float, steps: int
) -> MatchResult:
    made = Signal(signal.time_step, samples, name=signal.name)
    return MatchResult(made, factor, goal.ratios(made), steps)


class _Iteration:
    """State of the iteration: the motion, and the response of oscillators to it."""

    def __init__(
        self, time_step: float, samples: Array, goal: MatchingGoal, periods: Array, steps: int = 0
    ) -> None:
        self.samples = samples
        self.steps = steps
        self._regularisation = _FIRST_REGULARISATION
        self._target_misfit = _MATCHED_MISFIT * goal.tolerance
        self._targets = goal.spectrum(periods)
        self._oscillators = Oscillators(periods, goal.damping_ratio, time_step)
        self._histories = self._oscillators.histories(samples)
        self._peaks = self._oscillators.peaks(samples, self._histories)

    def reset_regularisation(self) -> None:
        """Reset the regularisation."""
        self._regularisation = _FIRST_REGULARISATION

    def improve(self, chosen: NDArray[np.bool_], most: int) -> bool:
        """Make adjustments for some oscillators; tell whether further ones would not help."""
        for _ in range(most):
            misfits = np.abs(self._peaks.spectrum[chosen] / self._targets[chosen] - 1.0)
            if misfits.max() <= self._target_misfit or not self._step(chosen):
                return True
        return False

    def _step(self, chosen: NDArray[np.bool_]) -> bool:
        """Make the first adjustment that reduces the misfit; tell whether there was one."""
        count = self.samples.size
        looked_at = self._peaks.select(chosen, self._targets)
        adjustment = make_adjustment(self._oscillators, looked_at, self._targets, count)
        before = self._objective(self._peaks, chosen)
        for _ in range(_MAX_TRIALS):
            added = adjustment.wavelets @ adjustment.amplitudes(self._regularisation)
            response = self._oscillators.histories(added)
            for length in _STEP_LENGTHS:
                samples = self.samples + length * added
                histories = self._histories + length * response
                peaks = self._oscillators.peaks(samples, histories)
                if self._objective(peaks, chosen) < before:
                    self.samples, self._histories, self._peaks = samples, histories, peaks
                    self.steps += 1
                    if length == 1.0:
                        decreased = _DECREASE_FACTOR * self._regularisation
                        self._regularisation = max(decreased, _MIN_REGULARISATION)
                    return True
            self._regularisation *= _INCREASE_FACTOR
        return False

    def _objective(self, peaks: OscillatorPeaks, chosen: NDArray[np.bool_]) -> float:
        """Return the mean fourth power of ln(spectrum / target)."""
        logarithms = np.log(peaks.spectrum[chosen] / self._targets[chosen])
        return float((np.abs(logarithms) ** _POWER).mean())


MAX_USUAL_GROWTH: Final = 1.5
"""Growth factor above which a warning is issued [1]."""

_PERIOD_RANGE_BEYOND: Final = 5.0
_PERIODS: Final = 24
"""Last period beyond the range, over the longest in it [1], and number of periods up to it."""

_MIN_STEPS: Final = 4.0
_PULSES: Final = (0.25, 15.0)
"""Fewest time steps in the shortest period of a pulse; range of these periods [s]."""

PEAKS: Final = tuple(f"peak_ground_{what}" for what in ("acceleration", "velocity", "displacement"))
INDICATOR: Final = "pulse_indicator"
GROWTH: Final = "spectral_growth_beyond_range"
GROWTH_PERIOD: Final = "period_of_spectral_growth"


def matching_changes(before: Signal, after: Signal, goal: MatchingGoal) -> dict[str, float]:
    """Compare a motion before and after its matching."""
    changes: dict[str, float] = {}
    for when, signal in (("before", before), ("after", after)):
        velocity, displacement = ground_path(signal)
        for name, pieces in zip(PEAKS, (signal.pieces, velocity, displacement), strict=True):
            changes[f"{name}_{when}_matching"] = absolute_peak(pieces)
        changes[f"{INDICATOR}_{when}_matching"] = _indicator(knots_of(velocity), signal.time_step)
    periods = np.geomspace(goal.longest, _PERIOD_RANGE_BEYOND * goal.longest, _PERIODS + 1)[1:]
    old, new = (
        spectral_peaks(version, periods, goal.damping_ratio)[:, 0] for version in (before, after)
    )
    growth = new / old
    most = int(growth.argmax())
    return {**changes, GROWTH: float(growth[most]), GROWTH_PERIOD: float(periods[most])}


def unusual_changes(changes: dict[str, float]) -> list[str]:
    """Say which peaks have grown unusually, and whether the motion has become a pulse."""
    words: list[str] = []
    for name in PEAKS:
        old, new = (changes[f"{name}_{when}_matching"] for when in ("before", "after"))
        if new > MAX_USUAL_GROWTH * old:
            words.append(f"{name.replace('_', ' ')} {new / old:.3g} times")
    if changes[GROWTH] > MAX_USUAL_GROWTH:
        words.append(
            f"spectrum {changes[GROWTH]:.3g} times at {changes[GROWTH_PERIOD]:.3g} s, beyond the "
            "range"
        )
    old, new = (changes[f"{INDICATOR}_{when}_matching"] for when in ("before", "after"))
    if new > velocity_pulses.MIN_INDICATOR >= old:
        words.append(f"a velocity pulse where none was (indicator {old:.2g}, now {new:.2g})")
    return words


def _indicator(velocity: Array, time_step: float) -> float:
    shortest, longest = _PULSES
    periods = velocity_pulses.period_range(max(shortest, _MIN_STEPS * time_step), longest)
    return velocity_pulses.extract_pulse(velocity, time_step, periods)[-1].indicator
