"""The fit of a cloud: a line in logarithms, logistic curves, and their posterior curves."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from rockframe.results.variables.analyses import FragilityStatus
from rockframe.signals.arrays import AnyArray, Array
from rockframe.studies.confidence import normal_scores
from rockframe.studies.fragility.likelihood import SAME_INTENSITY

MIN_RUNS: Final = 4
"""Least number of runs in a regression, so that its dispersion can be estimated."""
_POSTERIOR_DRAWS: Final = 4000
"""Random draws of the coefficients, for bounds."""
_SEARCH_MARGIN: Final = 3.0
"""Range beyond the intensities of the runs in which medians are searched, as a logarithm."""
_SEARCH_POINTS: Final = 601


@dataclass(frozen=True, eq=False)
class Regression:
    """A straight line through the logarithms of responses, :eq:`eq-cloud-line`."""

    intercept: float
    slope: float
    dispersion: float  # standard deviation of the residuals
    determination: float
    covariance: Array  # of intercept and slope
    dof: int  # degrees of freedom of the residuals
    residuals: Array

    @classmethod
    def fit(cls, logs: Array, responses: Array) -> "Regression":
        """Fit by least squares."""
        design = np.column_stack([np.ones(len(logs)), logs])
        (intercept, slope), *_ = np.linalg.lstsq(design, responses)
        residuals = responses - design @ np.array([intercept, slope])
        dof = len(logs) - 2
        squares = float(residuals @ residuals)
        total = float(((responses - responses.mean()) ** 2).sum())
        variance = squares / dof
        return cls(
            float(intercept), float(slope), math.sqrt(variance),
            1.0 - squares / total if total > 0.0 else 0.0,
            np.asarray(variance * np.linalg.inv(design.T @ design), dtype=np.float64), dof,
            residuals,
        )  # fmt: skip

    def draw_coefficients(self, rng: np.random.Generator, count: int) -> tuple[Array, Array, Array]:
        """Draw intercepts, slopes and dispersions of the posterior, :eq:`eq-cloud-posterior`."""
        scale = np.sqrt(self.dof / rng.chisquare(self.dof, count))
        root = np.linalg.cholesky(self.covariance)
        about = rng.standard_normal((count, 2)) @ root.T * scale[:, None]
        return self.intercept + about[:, 0], self.slope + about[:, 1], self.dispersion * scale


NO_LINE: Final = Regression(
    math.nan, math.nan, math.nan, math.nan, np.full((2, 2), math.nan), 0, np.empty(0)
)
"""Coefficients where there is no line: NaN."""


@dataclass(frozen=True, eq=False)
class Logistic:
    """The probability of a verdict, :eq:`eq-logistic`; where no fit exists 1, 0, or a step."""

    status: FragilityStatus
    coefficients: Array  # intercept and slope; of a step the logarithm in the middle of the gap
    covariance: Array

    def probability(self, logs: Array) -> Array:
        """Return the probability at logarithms of intensities."""
        from scipy.special import expit

        if self.status is FragilityStatus.NONE_EXCEEDED:
            return np.zeros(np.shape(logs))
        if self.status is FragilityStatus.ALL_EXCEEDED:
            return np.ones(np.shape(logs))
        if self.status is FragilityStatus.SEPARATED:
            return (np.asarray(logs) > self.coefficients[0]).astype(np.float64)
        return np.asarray(expit(self.coefficients[0] + self.coefficients[1] * logs))

    def draw_curves(self, logs: Array, rng: np.random.Generator, count: int) -> Array:
        """Draw curves from the posterior of the coefficients; shape (count, intensities)."""
        from scipy.special import expit

        if self.status is not FragilityStatus.FITTED:
            return np.broadcast_to(self.probability(logs), (count, len(logs)))
        root = np.linalg.cholesky(self.covariance)
        drawn = self.coefficients + rng.standard_normal((count, 2)) @ root.T
        return np.asarray(expit(drawn[:, :1] + drawn[:, 1:] * logs))


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

    result: Any = optimize.minimize(
        value, np.zeros(2), method="trust-exact", jac=slope, hess=curvature, options={"gtol": 1e-10}
    )
    unscale = np.array([[1.0, -middle / spread], [0.0, 1.0 / spread]])
    best = unscale @ result.x
    covariance = unscale @ np.linalg.inv(curvature(result.x)) @ unscale.T
    return Logistic(FragilityStatus.FITTED, best, np.asarray(covariance, dtype=np.float64))


@dataclass(frozen=True, eq=False)
class Cloud:
    """Runs, each under one motion, and the line and logistic curves fitted to them."""

    logs: Array  # of the intensity
    responses: Array  # infinite where the block overturned, zero where it stayed at rest
    regression: Regression  # of the runs in between; `NO_LINE` if these are too few
    overturning: Logistic
    moving: Logistic  # of runs that did not overturn: whether anything moved

    @classmethod
    def fit(cls, logs: Array, responses: Array) -> "Cloud":
        """Fit a line, and logistic curves for overturning and for staying at rest."""
        overturned, moved = np.isinf(responses), responses > 0.0
        between = moved & ~overturned
        enough = between.sum() >= MIN_RUNS and np.ptp(logs[between]) > SAME_INTENSITY
        line = Regression.fit(logs[between], np.log(responses[between])) if enough else NO_LINE
        moving = fit_logistic(logs[~overturned], moved[~overturned])
        return cls(logs, responses, line, fit_logistic(logs, overturned), moving)

    @property
    def is_regressed(self) -> AnyArray:
        """Which runs moved and did not overturn."""
        return (self.responses > 0.0) & np.isfinite(self.responses)

    def log_likelihoods(self) -> Array:
        """Return the logarithm of the likelihood of each run, :eq:`eq-cloud-likelihood`."""
        if self.regression is NO_LINE:
            return np.full(len(self.logs), np.nan)
        overturning = self.overturning.probability(self.logs)
        moving = self.moving.probability(self.logs)
        overturned, dispersion = np.isinf(self.responses), self.regression.dispersion
        log_likelihoods = np.where(
            overturned,
            np.log(np.maximum(overturning, 1e-300)),
            np.log1p(-np.minimum(overturning, 1.0 - 1e-16)),
        )
        probability = np.where(self.responses > 0.0, moving, 1.0 - moving)
        log_likelihoods[~overturned] += np.log(np.maximum(probability[~overturned], 1e-300))
        normalized = self.regression.residuals / dispersion
        log_likelihoods[self.is_regressed] += -0.5 * (
            normalized**2 + math.log(2.0 * math.pi)
        ) - math.log(dispersion)
        return log_likelihoods

    def probabilities(self, logs: Array, level: float) -> Array:
        """Return the probability that a level is exceeded, :eq:`eq-cloud-fragility`."""
        overturning, line = self.overturning.probability(logs), self.regression
        if math.isinf(level):
            return overturning
        moving = self.moving.probability(logs)
        of_line = line.intercept, line.slope, line.dispersion
        return _exceedance_probability(overturning, moving, of_line, logs, level)

    def draw_curves(self, logs: Array, level: float, rng: np.random.Generator, count: int) -> Array:
        """Draw fragility curves from the posterior; shape (count, intensities)."""
        overturning = self.overturning.draw_curves(logs, rng, count)
        if self.regression is NO_LINE or math.isinf(level):
            return overturning
        moving = self.moving.draw_curves(logs, rng, count)
        of_line = [drawn[:, None] for drawn in self.regression.draw_coefficients(rng, count)]
        return _exceedance_probability(overturning, moving, of_line, logs, level)


def _exceedance_probability(
    overturning: Array, moving: Array, coefficients: Sequence[Any], logs: Array, level: float
) -> Array:
    """Return the probability beyond a level: of overturning, of moving, and by the line."""
    from scipy.special import ndtr

    intercept, slope, dispersion = coefficients
    regressed = np.asarray(ndtr((intercept + slope * logs - math.log(level)) / dispersion))
    return overturning + (1.0 - overturning) * moving * regressed


def curve_of_level(
    cloud: Cloud, level: float, logs: Array, confidence: float, seed: int
) -> tuple[FragilityStatus, Array, Array, Array]:
    """Return status, probabilities at intensities, median and dispersion, each with its bounds."""
    status, (least, most) = _status(cloud, level), (cloud.logs.min(), cloud.logs.max())
    wide = np.linspace(least - _SEARCH_MARGIN, most + _SEARCH_MARGIN, _SEARCH_POINTS)
    middle, spread = _median_dispersion(cloud.probabilities(wide, level)[None], wide)
    points = np.full((3, len(logs)), np.nan)
    points[0] = cloud.probabilities(logs, level)
    medians, spreads = np.full((2, 3), np.nan)
    if status not in (FragilityStatus.FITTED, FragilityStatus.SEPARATED):
        return status, points, medians, spreads
    medians[0], spreads[0] = np.exp(middle[0]), spread[0]
    if status is FragilityStatus.SEPARATED:
        medians[0], spreads[0] = np.exp(cloud.overturning.coefficients[0]), 0.0
    elif not math.isnan(confidence):
        tails = 0.5 * (1.0 - confidence), 0.5 * (1.0 + confidence)
        rng = np.random.default_rng(seed)
        drawn = cloud.draw_curves(np.concatenate([logs, wide]), level, rng, _POSTERIOR_DRAWS)
        points[1:] = np.quantile(drawn[:, : len(logs)], tails, axis=0)
        estimates = _median_dispersion(drawn[:, len(logs) :], wide)
        # a median beyond the searched range is infinite, or zero where all of the curve lies above
        every = [np.where(np.isnan(values), np.inf, values) for values in estimates]
        every[0][np.all(drawn[:, len(logs) :] >= 0.5, axis=1)] = -np.inf
        medians[1:] = np.exp(np.quantile(every[0], tails, method="inverted_cdf"))
        spreads[1:] = np.quantile(every[1], tails, method="inverted_cdf")
    return status, points, medians, spreads


def _status(cloud: Cloud, level: float) -> FragilityStatus:
    """Return whether a limit state has a fragility, or why not."""
    if math.isinf(level):
        status = cloud.overturning.status
        falls = status is FragilityStatus.FITTED and not cloud.overturning.coefficients[1] > 0.0
        return FragilityStatus.NOT_RISING if falls else status
    if cloud.regression is NO_LINE:
        return FragilityStatus.NO_TRIALS
    parted = FragilityStatus.NOT_RISING in (cloud.overturning.status, cloud.moving.status)
    rises = cloud.regression.slope > 0.0 and not parted
    return FragilityStatus.FITTED if rises else FragilityStatus.NOT_RISING


def _median_dispersion(curves: Array, logs: Array) -> tuple[Array, Array]:
    """Return the logarithms at which curves reach one half, and their dispersions."""
    eta = normal_scores(curves)
    at = [_crossings(eta, logs, level) for level in (-1.0, 0.0, 1.0)]
    return at[1], 0.5 * (at[2] - at[0])


def _crossings(eta: Array, logs: Array, level: float) -> Array:
    """Return where curves first rise above a level; NaN where they do not."""
    above = eta >= level
    right = np.argmax(above, axis=1)
    crosses = above.any(axis=1) & (right > 0)
    right = np.maximum(right, 1)
    rows = np.arange(len(eta))
    low, high = eta[rows, right - 1], eta[rows, right]
    with np.errstate(invalid="ignore", divide="ignore"):
        at = logs[right - 1] + (level - low) / (high - low) * (logs[right] - logs[right - 1])
    return np.where(crosses, at, np.nan)
