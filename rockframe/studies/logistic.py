"""Logistic regression of a verdict on the logarithm of an intensity."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from rockframe.results.outcome import Generic
from rockframe.results.variables.analyses import FragilityStatus
from rockframe.signals.arrays import Array


@dataclass(frozen=True, eq=False)
class Logistic:
    """The probability of a verdict, :eq:`eq-logistic`; where no fit exists 1, 0, or a step."""

    status: FragilityStatus
    coefficients: Array  # intercept and slope; of a step the logarithm in the middle of the gap
    covariance: Array

    def at(self, logs: Array) -> Array:
        """Return the probability at logarithms of intensities."""
        return self._of(self.coefficients, logs)

    def drawn(self, logs: Array, rng: np.random.Generator, count: int) -> Array:
        """Draw curves from the posterior of the coefficients; shape (count, intensities)."""
        if self.status is not FragilityStatus.FITTED:
            return np.broadcast_to(self.at(logs), (count, len(logs)))
        root = np.linalg.cholesky(self.covariance)
        drawn = self.coefficients + rng.standard_normal((count, 2)) @ root.T
        return self._of(drawn.T[:, :, None], logs)

    def _of(self, coefficients: Array, logs: Array) -> Array:
        from scipy.special import expit

        if self.status is FragilityStatus.NONE_EXCEEDED:
            return np.zeros(np.shape(logs))
        if self.status is FragilityStatus.ALL_EXCEEDED:
            return np.ones(np.shape(logs))
        if self.status is FragilityStatus.SEPARATED:
            return (np.asarray(logs) > coefficients[0]).astype(np.float64)
        return np.asarray(expit(coefficients[0] + coefficients[1] * logs))


def fit_logistic(logs: Array, verdict: Generic) -> Logistic:
    """Find the most likely coefficients; the log-likelihood is concave, so that there is one."""
    from scipy import optimize
    from scipy.special import expit, log_expit

    nothing = np.full(2, np.nan), np.full((2, 2), np.nan)
    over = verdict.astype(bool)
    if not over.any():
        return Logistic(FragilityStatus.NONE_EXCEEDED, *nothing)
    if over.all():
        return Logistic(FragilityStatus.ALL_EXCEEDED, *nothing)
    least, most = float(logs[over].min()), float(logs[~over].max())
    if most <= least:
        middle = np.array([0.5 * (most + least), np.inf])
        return Logistic(FragilityStatus.SEPARATED, middle, nothing[1])
    if float(logs[over].max()) <= float(logs[~over].min()):
        return Logistic(FragilityStatus.NOT_RISING, *nothing)
    middle, spread = float(logs.mean()), float(logs.std())
    design = np.column_stack([np.ones(len(logs)), (logs - middle) / spread])
    sign = np.where(over, 1.0, -1.0)

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
    back = np.array([[1.0, -middle / spread], [0.0, 1.0 / spread]])
    best = back @ found.x
    covariance = back @ np.linalg.inv(curvature(found.x)) @ back.T
    return Logistic(FragilityStatus.FITTED, best, np.asarray(covariance, dtype=np.float64))
