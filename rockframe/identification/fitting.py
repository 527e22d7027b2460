"""Fit by least squares: first improved start values, then the fit of the peaks or the history."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final, cast

import numpy as np

from rockframe.identification.measured import History, MeasuredPeaks, Swings
from rockframe.identification.prediction import Circumstance, Prediction, Unknown, with_starts
from rockframe.signals.arrays import Array

DIFFERENCE_STEP: Final = 1e-4
"""Step of the differences for derivatives, as a share of an unknown's size.

Runs are accurate to some 1e-8 of the rotation, so that smaller steps would suffice. But residuals
have kinks where contact changes, and a derivative near a kink should include both sides. Steps
above 1e-3 are too long for the end of a decay, where the phase depends most on the parameters."""
_FIRST_STEP: Final = 0.05
"""Longest first step, as a share of an unknown's size: a longer one may reach another minimum."""
FINAL_TOLERANCE: Final = 1e-10
"""Tolerance of the final fit."""
MAX_EVALUATIONS: Final = 100
"""Number of trials after which a fit is given up, without those for derivatives."""
_SINGULAR_RATIO: Final = 1e-7
"""Ratio of singular values below which the effects of unknowns cannot be separated."""
_NO_EFFECT: Final = 1e-8
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
    has_effect: Any  # which unknowns have an effect on the residuals
    degrees_of_freedom: float  # degrees of freedom from which the noise is known

    @property
    def norms(self) -> Array:
        """Norms of the derivatives by each unknown, 1 for unknowns without effect."""
        return np.where(self.has_effect, np.linalg.norm(self.jacobian, axis=0), 1.0)

    @property
    def directions(self) -> Array:
        """The derivatives over their norms, zero for unknowns without effect."""
        return np.where(self.has_effect, self.jacobian, 0.0) / self.norms

    def leverages(self) -> Array:
        """Return how much of each residual the unknowns take up; the sum is their number."""
        left, singular, _ = np.linalg.svd(self.directions, full_matrices=False)
        return np.sum(left[:, singular > _SINGULAR_RATIO * singular[0]] ** 2, axis=1)


@dataclass(frozen=True)
class Uncertainty:
    """Uncertainty of the values of a fit."""

    standard_error: Array  # NaN where the data do not determine the value
    correlation: Array  # correlation of the errors of the values
    half_width: float  # half-width of the confidence interval in standard errors


def minimize(
    residuals: Callable[[Array], Array],
    unknowns: Sequence[Unknown],
    *,
    tolerance: float = FINAL_TOLERANCE,
) -> Solution:
    """Find the values of the unknowns that minimise the sum of the squared residuals."""
    # imported here, since the import is slow and few scripts need it
    from scipy.optimize import least_squares

    start, scale, lower, upper = (
        np.array([getattr(unknown, name) for unknown in unknowns])
        for name in ("start", "scale", "lower", "upper")
    )

    def values_at(point: Array) -> Array:
        return np.clip(start + scale * (point - _FIRST_STEP), lower, upper)

    def misfit(point: Array) -> Array:
        return residuals(values_at(point))

    least, greatest = ((bound - start) / scale + _FIRST_STEP for bound in (lower, upper))

    def jacobian(point: Array) -> Any:
        columns: list[Array] = []
        for index in range(start.size):
            down, up = point.copy(), point.copy()
            down[index] = max(point[index] - DIFFERENCE_STEP, least[index])
            up[index] = min(point[index] + DIFFERENCE_STEP, greatest[index])
            columns.append((misfit(up) - misfit(down)) / (up[index] - down[index]))
        return np.stack(columns, axis=1)

    # SciPy limits the first step by the distance of the start from zero
    result = least_squares(
        misfit,
        np.full(start.size, _FIRST_STEP),
        jac=cast("Any", jacobian),
        bounds=(least, greatest),
        ftol=tolerance,
        xtol=tolerance,
        gtol=tolerance,
        max_nfev=MAX_EVALUATIONS,
    )
    norms = np.linalg.norm(result.jac, axis=0)
    has_effect = norms > _NO_EFFECT * np.max(norms)
    # rounding moves an unknown without effect: it keeps its start value
    values = np.where(has_effect, values_at(result.x), start)
    distance = np.minimum(values - lower, upper - values) / scale
    return Solution(
        values=values,
        jacobian=np.asarray(result.jac) / scale,
        residuals=np.asarray(result.fun),
        status=int(result.status),
        evaluations=int(result.nfev),
        at_bound=has_effect & (distance < _AT_BOUND),
        has_effect=has_effect,
        degrees_of_freedom=result.fun.size - result.x.size,
    )


def uncertainty_of(solution: Solution, confidence: float) -> Uncertainty:
    """Estimate the errors of a fit's values from its residuals, :eq:`eq-fit-covariance`."""
    from scipy.special import stdtrit

    count, size = solution.jacobian.shape
    degrees_of_freedom = count - size
    half_width = float(stdtrit(solution.degrees_of_freedom, 0.5 * (1.0 + confidence)))
    _, singular, rows = np.linalg.svd(solution.directions, full_matrices=False)
    determined = singular > _SINGULAR_RATIO * singular[0]
    # an unknown with a share in a direction that the data do not determine is itself undetermined
    undetermined = ~solution.has_effect | (np.sum(rows[~determined] ** 2, axis=0) > _SINGULAR_RATIO)
    inverse = (rows[determined].T / singular[determined] ** 2) @ rows[determined]
    variance = float(solution.residuals @ solution.residuals) / degrees_of_freedom
    spread = np.sqrt(np.diag(inverse))
    error = math.sqrt(variance) * spread / solution.norms
    products = np.outer(spread, spread)
    correlation = np.full_like(inverse, math.nan)
    np.divide(inverse, products, out=correlation, where=products > 0.0)
    correlation[undetermined, :] = correlation[:, undetermined] = math.nan
    return Uncertainty(np.where(undetermined, math.nan, error), correlation, half_width)


_INITIAL_NOISE: Final = 0.01
"""Noise that is assumed before it is estimated from residuals, as a share of the largest peak and
of the mean time between two peaks."""
_MIN_NOISE: Final = 1e-9
"""Least noise, as the same share: less cannot be distinguished from rounding."""
_ROUGH_TOLERANCE: Final = 1e-3
"""Tolerance of a fit that gives start values."""
_MIN_PEAKS: Final = 3
"""Least number of peaks of a history, including the release, for a fit of start values to them."""
_REWEIGHTINGS: Final = 4
"""Number of times that the noise of rotations and of times is estimated from their residuals."""


def fit_history(
    prediction: Prediction, measured: History, swings: Swings, unknowns: Sequence[Unknown]
) -> Solution:
    """Fit a history with the same weight for every sample."""

    def residuals(values: Array) -> Array:
        return prediction.history(values, measured) - measured.rotation

    starts = [list(unknowns)]
    if swings.peaks.rotation.size >= _MIN_PEAKS:
        misfit = _peak_residuals(prediction, swings.peaks, _initial_noise(swings.peaks))
        starts.append(with_starts(unknowns, _fit_roughly(misfit, unknowns).values))
    fits = [_fit_roughly(residuals, start) for start in starts]
    best = min(fits, key=lambda fit: float(fit.residuals @ fit.residuals))
    return minimize(residuals, with_starts(unknowns, best.values))


def fit_peaks(
    prediction: Prediction, measured: MeasuredPeaks, unknowns: Sequence[Unknown]
) -> Solution:
    """Fit peaks, the n-th of the run to the n-th that was measured, :eq:`eq-fit-peaks`."""
    initial = noise = _initial_noise(measured)
    misfit = _peak_residuals(prediction, measured, noise)
    solution = minimize(misfit, with_starts(unknowns, _fit_roughly(misfit, unknowns).values))
    if measured.time is None:
        return solution
    for _ in range(_REWEIGHTINGS):  # rotations and times are weighted by their noise
        rotations, times = _by_kind(solution.residuals, measured)
        squares = np.array([float(rotations @ rotations), float(times @ times)])
        estimated = np.sqrt(squares / _degrees_of_freedom(solution, measured)) * noise
        noise = np.maximum(estimated, _MIN_NOISE / _INITIAL_NOISE * initial)
        misfit = _peak_residuals(prediction, measured, noise)
        solution = minimize(misfit, with_starts(unknowns, solution.values))
    freedom = float(_degrees_of_freedom(solution, measured).min())
    return replace(solution, degrees_of_freedom=freedom)


def _fit_roughly(residuals: Callable[[Array], Array], unknowns: Sequence[Unknown]) -> Solution:
    """Fit roughly, first the circumstances alone, whose errors would distort the parameters."""
    values = np.array([unknown.start for unknown in unknowns])
    where = [index for index, unknown in enumerate(unknowns) if unknown.name in tuple(Circumstance)]

    def of_circumstances(estimates: Array) -> Array:
        every = values.copy()
        every[where] = estimates
        return residuals(every)

    if where:
        free = [unknowns[index] for index in where]
        values[where] = minimize(of_circumstances, free, tolerance=_ROUGH_TOLERANCE).values
    return minimize(residuals, with_starts(unknowns, values), tolerance=_ROUGH_TOLERANCE)


def _initial_noise(measured: MeasuredPeaks) -> Array:
    """Return the noise of rotations [rad] and of times [s] that is assumed at first."""
    mean_interval = 1.0
    if measured.time is not None:
        mean_interval = float(np.mean(np.diff(measured.time[np.isfinite(measured.time)])))
    return _INITIAL_NOISE * np.array([np.max(np.abs(measured.rotation)), mean_interval])


def _peak_residuals(
    prediction: Prediction, measured: MeasuredPeaks, noise: Array
) -> Callable[[Array], Array]:
    """Return the residuals of the peaks over their noise as a function of the unknowns."""

    def misfit(values: Array) -> Array:
        times, rotation = prediction.peaks(values, measured)
        rotation_residuals = (rotation - measured.rotation) / noise[0]
        if measured.time is None:
            return rotation_residuals
        known = np.isfinite(measured.time)
        return np.concatenate([rotation_residuals, (times - measured.time)[known] / noise[1]])

    return misfit


def _by_kind(values: Array, measured: MeasuredPeaks) -> tuple[Array, Array]:
    """Part values of all residuals into those of rotations and of times."""
    return values[: measured.rotation.size], values[measured.rotation.size :]


def _degrees_of_freedom(solution: Solution, measured: MeasuredPeaks) -> Array:
    """Return the degrees of freedom of rotations and of times, at least 1."""
    kinds = _by_kind(solution.leverages(), measured)
    return np.array([max(1.0, of.size - float(np.sum(of))) for of in kinds])
