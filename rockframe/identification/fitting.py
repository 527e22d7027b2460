"""Fit by least squares: first improved start values, then the fit of the peaks or the history."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final, cast

import numpy as np

from rockframe.identification.measured import History, MeasuredPeaks
from rockframe.identification.prediction import Prediction
from rockframe.identification.swings import Swings
from rockframe.identification.unknowns import Circumstance, Unknown, started_at
from rockframe.signals.arrays import Array

DIFFERENCE: Final = 1e-4
"""Step of the differences for derivatives, as a share of an unknown's size.

Runs are accurate to some 1e-8 of the rotation, so that smaller steps would suffice. But residuals
have kinks where contact changes, and a derivative near a kink should include both sides. Steps
above 1e-3 are too long for the end of a decay, where the phase depends most on the parameters."""
_FIRST_STEP: Final = 0.05
"""Longest first step, as a share of an unknown's size: a longer one may reach another minimum."""
TIGHT: Final = 1e-10
"""Tolerance of the final fit."""
MOST_EVALUATIONS: Final = 100
"""Number of trials after which a fit is given up, without those for derivatives."""
_SINGULAR: Final = 1e-7
"""Ratio of singular values below which the effects of unknowns cannot be separated."""
_UNSEEN: Final = 1e-8
"""Share of the greatest derivative below which the effect of an unknown is rounding."""
_AT_BOUND: Final = 1e-5
"""Distance from a bound, as a share of an unknown's size, within which it is at the bound."""


@dataclass(frozen=True)
class Solution:
    """Values, residuals and derivatives at the end of a fit."""

    values: Array  # in SI units
    jacobian: Array  # derivatives of the weighted residuals
    residuals: Array  # weighted
    status: int  # of :func:`scipy.optimize.least_squares`
    evaluations: int  # number of trials, without those for derivatives
    at_bound: Any  # which unknowns are at a bound
    seen: Any  # which unknowns have an effect on the residuals
    freedom: float  # degrees of freedom from which the noise is known

    @property
    def lengths(self) -> Array:
        """Norms of the derivatives by each unknown, 1 for unknowns without effect."""
        return np.where(self.seen, np.linalg.norm(self.jacobian, axis=0), 1.0)

    @property
    def directions(self) -> Array:
        """The derivatives over their norms, zero for unknowns without effect."""
        return np.where(self.seen, self.jacobian, 0.0) / self.lengths

    def leverages(self) -> Array:
        """Return how much of each residual the unknowns take up; the sum is their number."""
        left, singular, _ = np.linalg.svd(self.directions, full_matrices=False)
        return np.sum(left[:, singular > _SINGULAR * singular[0]] ** 2, axis=1)


@dataclass(frozen=True)
class Uncertainty:
    """Uncertainty of the values of a fit."""

    standard_error: Array  # NaN where the data do not determine the value
    correlation: Array  # correlation of the errors of the values
    reach: float  # half-width of the confidence interval in standard errors


def minimize(
    residuals: Callable[[Array], Array],
    unknowns: Sequence[Unknown],
    *,
    tolerance: float = TIGHT,
) -> Solution:
    """Find the values of the unknowns that minimise the sum of the squared residuals."""
    # imported here, since the import is slow and few scripts need it
    from scipy.optimize import least_squares

    start, scale, lower, upper = (
        np.array([getattr(one, name) for one in unknowns])
        for name in ("start", "scale", "lower", "upper")
    )

    def values_at(point: Array) -> Array:
        return np.clip(start + scale * (point - _FIRST_STEP), lower, upper)

    def misfit(point: Array) -> Array:
        return residuals(values_at(point))

    least, greatest = ((bound - start) / scale + _FIRST_STEP for bound in (lower, upper))

    def slopes(point: Array) -> Any:
        columns: list[Array] = []
        for index in range(start.size):
            down, up = point.copy(), point.copy()
            down[index] = max(point[index] - DIFFERENCE, least[index])
            up[index] = min(point[index] + DIFFERENCE, greatest[index])
            columns.append((misfit(up) - misfit(down)) / (up[index] - down[index]))
        return np.stack(columns, axis=1)

    # SciPy limits the first step by the distance of the start from zero
    found = least_squares(
        misfit,
        np.full(start.size, _FIRST_STEP),
        jac=cast("Any", slopes),
        bounds=(least, greatest),
        ftol=tolerance,
        xtol=tolerance,
        gtol=tolerance,
        max_nfev=MOST_EVALUATIONS,
    )
    length = np.linalg.norm(found.jac, axis=0)
    seen = length > _UNSEEN * np.max(length)
    # rounding moves an unknown without effect: it keeps its start value
    values = np.where(seen, values_at(found.x), start)
    room = np.minimum(values - lower, upper - values) / scale
    return Solution(
        values=values,
        jacobian=np.asarray(found.jac) / scale,
        residuals=np.asarray(found.fun),
        status=int(found.status),
        evaluations=int(found.nfev),
        at_bound=seen & (room < _AT_BOUND),
        seen=seen,
        freedom=found.fun.size - found.x.size,
    )


def uncertainty_of(solution: Solution, confidence: float) -> Uncertainty:
    """Estimate the errors of a fit's values from its residuals, :eq:`eq-fit-covariance`."""
    from scipy.special import stdtrit

    count, size = solution.jacobian.shape
    freedom = count - size
    reach = float(stdtrit(solution.freedom, 0.5 * (1.0 + confidence)))
    _, singular, rows = np.linalg.svd(solution.directions, full_matrices=False)
    determined = singular > _SINGULAR * singular[0]
    # an unknown with a share in a direction that the data do not determine is itself undetermined
    lost = ~solution.seen | (np.sum(rows[~determined] ** 2, axis=0) > _SINGULAR)
    inverse = (rows[determined].T / singular[determined] ** 2) @ rows[determined]
    variance = float(solution.residuals @ solution.residuals) / freedom
    spread = np.sqrt(np.diag(inverse))
    error = math.sqrt(variance) * spread / solution.lengths
    correlation = inverse / np.where(spread > 0.0, np.outer(spread, spread), 1.0)
    correlation[lost, :] = correlation[:, lost] = math.nan
    return Uncertainty(np.where(lost, math.nan, error), correlation, reach)


_FIRST_WEIGHT: Final = 0.01
"""Noise that is assumed before it is estimated from residuals, as a share of the largest peak and
of the mean time between two peaks."""
_LEAST_WEIGHT: Final = 1e-9
"""Least noise, as the same share: less cannot be distinguished from rounding."""
_ROUGH: Final = 1e-3
"""Tolerance of a fit that gives start values."""
_FEWEST_PEAKS: Final = 3
"""Least number of peaks of a history, including the release, for a fit of start values to them."""
_WEIGHTINGS: Final = 4
"""Number of times that the noise of rotations and of times is estimated from their residuals."""


@dataclass(frozen=True)
class Weights:
    """Standard deviations by which the residuals of peaks are divided."""

    rotation: float  # of the rotations of peaks [rad]
    time: float  # of the times of peaks [s]


def fit_history(
    prediction: Prediction,
    measured: History,
    swings: Swings,
    unknowns: Sequence[Unknown],
) -> Solution:
    """Fit a history with the same weight for every sample."""

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
    """Fit peaks, the n-th of the run to the n-th that was measured.

    Rotations and times, where there are times, are weighted by their noise, which is estimated
    from the residuals, :eq:`eq-fit-peaks`.
    """
    sizes = weights = _first_weights(measured)
    misfit = _misfit_of(prediction, measured, weights)
    solution = minimize(misfit, started_at(unknowns, _fit_roughly(misfit, unknowns).values))
    if measured.time is None:
        return solution
    for _ in range(_WEIGHTINGS):
        weights = _reweighted(solution, weights, measured, sizes)
        misfit = _misfit_of(prediction, measured, weights)
        solution = minimize(misfit, started_at(unknowns, solution.values))
    return replace(solution, freedom=min(_freedoms(solution, measured)))


def _fit_roughly(residuals: Callable[[Array], Array], unknowns: Sequence[Unknown]) -> Solution:
    """Fit roughly, first the circumstances alone, whose errors would distort the parameters."""
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
    """Return the weighted residuals of the peaks as a function of the unknowns."""

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
    least = _LEAST_WEIGHT / _FIRST_WEIGHT
    kinds = solution.residuals[:count], solution.residuals[count:]
    rotation, time = (
        math.sqrt(float(of @ of) / freedom)
        for of, freedom in zip(kinds, _freedoms(solution, measured), strict=True)
    )
    return Weights(
        max(rotation * weights.rotation, least * sizes.rotation),
        max(time * weights.time, least * sizes.time),
    )


def _freedoms(solution: Solution, measured: MeasuredPeaks) -> tuple[float, float]:
    """Return the degrees of freedom of rotations and of times, at least 1."""
    leverages, count = solution.leverages(), measured.rotation.size
    kinds = leverages[:count], leverages[count:]
    rotation, time = (max(1.0, of.size - float(np.sum(of))) for of in kinds)
    return rotation, time
