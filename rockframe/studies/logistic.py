"""Logistic regression of a verdict on the logarithm of an intensity."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from rockframe.results.variables.analyses import FragilityStatus
from rockframe.signals.arrays import AnyArray, Array
from rockframe.studies.fragility.likelihood import SAME_INTENSITY


@dataclass(frozen=True, eq=False)
class Logistic:
    """The probability of a verdict, :eq:`eq-logistic`; where no fit exists 1, 0, or a step."""

    status: FragilityStatus
    coefficients: Array  # intercept and slope; of a step the logarithm in the middle of the gap
    covariance: Array

    def probability(self, logs: Array) -> Array:
        """Return the probability at logarithms of intensities."""
        return self._evaluate(self.coefficients, logs)

    def draw_curves(self, logs: Array, rng: np.random.Generator, count: int) -> Array:
        """Draw curves from the posterior of the coefficients; shape (count, intensities)."""
        if self.status is not FragilityStatus.FITTED:
            return np.broadcast_to(self.probability(logs), (count, len(logs)))
        root = np.linalg.cholesky(self.covariance)
        drawn = self.coefficients + rng.standard_normal((count, 2)) @ root.T
        return self._evaluate(drawn.T[:, :, None], logs)

    def _evaluate(self, coefficients: Array, logs: Array) -> Array:
        from scipy.special import expit

        if self.status is FragilityStatus.NONE_EXCEEDED:
            return np.zeros(np.shape(logs))
        if self.status is FragilityStatus.ALL_EXCEEDED:
            return np.ones(np.shape(logs))
        if self.status is FragilityStatus.SEPARATED:
            return (np.asarray(logs) > coefficients[0]).astype(np.float64)
        return np.asarray(expit(coefficients[0] + coefficients[1] * logs))


def fit_logistic(logs: Array, verdict: AnyArray) -> Logistic:
    """Find the most likely coefficients; the log-likelihood is concave, so that there is one."""
    from scipy import optimize
    from scipy.special import expit, log_expit

    undefined = np.full(2, np.nan), np.full((2, 2), np.nan)
    exceeded = verdict.astype(bool)
    if not exceeded.any():
        return Logistic(FragilityStatus.NONE_EXCEEDED, *undefined)
    if exceeded.all():
        return Logistic(FragilityStatus.ALL_EXCEEDED, *undefined)
    if np.ptp(logs) <= SAME_INTENSITY:
        return Logistic(FragilityStatus.ONE_INTENSITY, *undefined)
    least, most = float(logs[exceeded].min()), float(logs[~exceeded].max())
    if most <= least:
        middle = np.array([0.5 * (most + least), np.inf])
        return Logistic(FragilityStatus.SEPARATED, middle, undefined[1])
    if float(logs[exceeded].max()) <= float(logs[~exceeded].min()):
        return Logistic(FragilityStatus.NOT_RISING, *undefined)
    middle, spread = float(logs.mean()), float(logs.std())
    design = np.column_stack([np.ones(len(logs)), (logs - middle) / spread])
    sign = np.where(exceeded, 1.0, -1.0)

    def value(at: Array) -> float:
        return -float(log_expit(sign * (design @ at)).sum())

    def slope(at: Array) -> Array:
        return -design.T @ (sign * expit(-sign * (design @ at)))

    def curvature(at: Array) -> Array:
        share = expit(design @ at)
        return design.T @ ((share * (1.0 - share))[:, None] * design)

    found: Any = optimize.minimize(
        value, np.zeros(2), method="trust-exact", jac=slope, hess=curvature, options={"gtol": 1e-10}
    )
    unscale = np.array([[1.0, -middle / spread], [0.0, 1.0 / spread]])
    best = unscale @ found.x
    covariance = unscale @ np.linalg.inv(curvature(found.x)) @ unscale.T
    return Logistic(FragilityStatus.FITTED, best, np.asarray(covariance, dtype=np.float64))
