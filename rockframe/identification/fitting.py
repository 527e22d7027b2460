"""The steps of a fit: start values, and then the peaks, or the history."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rockframe.identification.least_squares import Solution, minimize
from rockframe.identification.measured import History, MeasuredPeaks
from rockframe.identification.prediction import Prediction
from rockframe.identification.swings import Swings
from rockframe.identification.unknowns import Circumstance, Unknown, started_at
from rockframe.signals.arrays import Array

_FIRST_WEIGHT: Final = 0.01
"""Noise that is assumed before residuals tell it: a share of the first peak, and of the time
between two peaks."""
_LEAST_WEIGHT: Final = 1e-9
"""The same share below which noise is not told from rounding."""
_ROUGH: Final = 1e-3
"""Tolerance of a fit that gives start values."""
_FEWEST_PEAKS: Final = 3
"""Peaks of a history, that of the release among them, from which it is worth while to fit them."""
_WEIGHTINGS: Final = 4
"""How often the noise of rotations and of times is estimated anew from their residuals."""


@dataclass(frozen=True)
class Weights:
    """Standard deviations by which the residuals of peaks are divided."""

    rotation: float  # of the peaks' rotations and of their times [rad], [s]
    time: float


def fit_history(
    prediction: Prediction,
    measured: History,
    swings: Swings,
    unknowns: Sequence[Unknown],
) -> Solution:
    """Fit a history, every sample with the same weight."""

    def residuals(values: Array) -> Array:
        return prediction.history(values, measured) - measured.rotation

    starts = [list(unknowns)]
    if swings.peaks.rotation.size >= _FEWEST_PEAKS:
        misfit = _misfit_of(prediction, swings.peaks, _first_weights(swings.peaks))
        starts.append(started_at(unknowns, _fit_roughly(misfit, unknowns).values))
    fits = [_fit_roughly(residuals, start) for start in starts]
    best = min(fits, key=lambda fit: float(fit.residuals @ fit.residuals))
    return minimize(residuals, started_at(unknowns, best.values))


def fit_peaks(
    prediction: Prediction, measured: MeasuredPeaks, unknowns: Sequence[Unknown]
) -> Solution:
    """Fit peaks, each with that of the same number.

    Rotations and times, where there are times, are weighted by the noise that their residuals
    show, :eq:`eq-fit-peaks`.
    """
    sizes = weights = _first_weights(measured)
    misfit = _misfit_of(prediction, measured, weights)
    solution = minimize(misfit, started_at(unknowns, _fit_roughly(misfit, unknowns).values))
    for _ in range(0 if measured.time is None else _WEIGHTINGS):
        weights = _reweighted(solution, weights, measured, sizes)
        misfit = _misfit_of(prediction, measured, weights)
        solution = minimize(misfit, started_at(unknowns, solution.values))
    return solution


def _fit_roughly(residuals: Callable[[Array], Array], unknowns: Sequence[Unknown]) -> Solution:
    """Fit the circumstances first, so that the parameters are not led astray by them."""
    values = np.array([one.start for one in unknowns])
    where = [index for index, one in enumerate(unknowns) if one.name in tuple(Circumstance)]

    def of_circumstances(found: Array) -> Array:
        every = values.copy()
        every[where] = found
        return residuals(every)

    if where:
        free = [unknowns[index] for index in where]
        values[where] = minimize(of_circumstances, free, tolerance=_ROUGH).values
    return minimize(residuals, started_at(unknowns, values), tolerance=_ROUGH)


def _first_weights(measured: MeasuredPeaks) -> Weights:
    swing = 1.0
    if measured.time is not None:
        swing = float(np.mean(np.diff(measured.time[np.isfinite(measured.time)])))
    return Weights(_FIRST_WEIGHT * float(np.max(np.abs(measured.rotation))), _FIRST_WEIGHT * swing)


def _misfit_of(
    prediction: Prediction, measured: MeasuredPeaks, weights: Weights
) -> Callable[[Array], Array]:
    """Give the residuals of the peaks over their weights, as a function of the unknowns."""

    def misfit(values: Array) -> Array:
        times, rotation = prediction.peaks(values, measured)
        found = (rotation - measured.rotation) / weights.rotation
        if measured.time is None:
            return found
        known = np.isfinite(measured.time)
        return np.concatenate([found, (times - measured.time)[known] / weights.time])

    return misfit


def _reweighted(
    solution: Solution, weights: Weights, measured: MeasuredPeaks, sizes: Weights
) -> Weights:
    """Estimate the noise of rotations and of times from their residuals."""
    count = measured.rotation.size
    # each of both bears its share of the unknowns
    share = math.sqrt(solution.residuals.size / (solution.residuals.size - solution.values.size))
    least = _LEAST_WEIGHT / _FIRST_WEIGHT
    rotations, times = solution.residuals[:count], solution.residuals[count:]
    return Weights(
        max(share * _rms(rotations) * weights.rotation, least * sizes.rotation),
        max(share * _rms(times) * weights.time, least * sizes.time),
    )


def _rms(values: Array) -> float:
    return math.sqrt(float(np.mean(values**2)))
