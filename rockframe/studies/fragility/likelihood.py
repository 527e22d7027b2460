"""Lognormal capacities fitted to trials by maximum likelihood.

With `eta` = intercept + slopes · ln(intensity) the likelihood of a trial
is Phi(eta at the upper end) - Phi(eta at the lower end), :eq:`eq-fragility-likelihood`. It is
log-concave in the coefficients, so that there is one maximum, or none.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any, Final, cast

import numpy as np

from rockframe.results.variables.analyses import FragilityStatus
from rockframe.signals.arrays import AnyArray, Array
from rockframe.studies.fragility.trials import Trials

RAY_COUNT: Final = 360
"""Rays on which the boundary of a confidence region is found."""
ZERO_SLOPE: Final = 1e-9
"""Slope, over the spread of the logarithms of intensities, up to which it is a rounding error."""
SAME_INTENSITY: Final = 1e-9
"""Range of logarithms of intensities up to which it is a rounding error: they are one intensity, as
those of motions that were scaled to it."""
_DOUBLINGS: Final = 30
"""Number of times that the length of a ray is doubled; if its end is then still within the region,
the region is unbounded along the ray."""
_MAX_VALUES: Final = 2_000_000
"""Largest number of values in memory at once."""


class Bands(StrEnum):
    """Where confidence bands come from."""

    PROFILE = "profile"
    SANDWICH = "sandwich"
    JACKKNIFE = "jackknife"


@dataclass(frozen=True, eq=False)
class Fit:
    """The coefficients at which the likelihood is greatest."""

    status: FragilityStatus  # whether there are any
    coefficients: Array  # intercept and slopes
    information: Array  # the observed one: curvature of the log-likelihood at its maximum
    covariance: Array  # of the coefficients
    # coefficients without each cluster in turn, and how many clusters are alike; NaN without a fit
    leave_one_out: tuple[Array, Array] | None = None

    @property
    def complete(self) -> bool:
        """Whether there is also a fit without each cluster, if those were requested."""
        return self.leave_one_out is None or bool(np.isfinite(self.leave_one_out[0]).all())

    @property
    def clusters(self) -> float:
        """Number of clusters of a jackknife; infinite for other fits."""
        return math.inf if self.leave_one_out is None else float(self.leave_one_out[1].sum())

    @classmethod
    def none(cls, status: FragilityStatus, measures: int) -> "Fit":
        """Return the fit of trials for which no maximum-likelihood fit exists."""
        square = np.full((1 + measures,) * 2, np.nan)
        return cls(status, square[0], square, square)


def fit(trials: Trials, bands: Bands) -> Fit:
    """Find the most likely coefficients, and their covariance by the given `bands`."""
    fitted = _maximum_likelihood(trials)
    if fitted.status is not FragilityStatus.FITTED:
        return fitted
    if bands is Bands.SANDWICH:
        of_trial, weight = scores(trials, fitted.coefficients), trials.weight
        of_cluster = of_trial / weight[:, None]
        if trials.cluster is not None:
            of_cluster = cluster_sums(of_trial, trials.cluster)
            weight = np.ones(len(of_cluster))
        return replace(fitted, covariance=sandwich(fitted.covariance, of_cluster, weight))
    if bands is Bands.JACKKNIFE:
        subsets = list(_leave_one_out(trials))
        rows = np.array([_refit(subset, fitted.coefficients) for subset, _ in subsets])
        leave_one_out = rows, np.array([alike for _, alike in subsets])
        covariance = jackknife(fitted.coefficients, *leave_one_out)
        return replace(fitted, covariance=covariance, leave_one_out=leave_one_out)
    return fitted


def sandwich(inverse: Array, cluster_scores: Array, weight: Array) -> Array:
    """Return the covariance from the scores of clusters, :eq:`eq-fragility-sandwich`.

    It is NaN for a single cluster, whose scatter is not known.
    """
    count = float(weight.sum())
    if count <= 1.0:
        return np.full(inverse.shape, np.nan)
    products = cluster_scores.T @ (weight[:, None] * cluster_scores)
    return inverse @ (products * (count / (count - 1.0))) @ inverse


def cluster_sums(of_trial: Array, cluster: AnyArray) -> Array:
    """Sum rows over the trials of each cluster."""
    names, place = np.unique(cluster, return_inverse=True)
    summed = np.zeros((len(names), of_trial.shape[1]))
    np.add.at(summed, place, of_trial)
    return summed


def jackknife(best: Array, rows: Array, multiplicity: Array) -> Array:
    """Return the covariance from rows without one cluster each, :eq:`eq-fragility-jackknife`.

    It is NaN for a single cluster, as in :func:`sandwich`.
    """
    count = float(multiplicity.sum())
    if count <= 1.0:
        return np.full((best.size, best.size), np.nan)
    differences = rows - best
    return (count - 1.0) / count * (differences.T @ (multiplicity[:, None] * differences))


def _leave_one_out(trials: Trials) -> Iterator[tuple[Trials, float]]:
    """Return the trials without each cluster, or each trial, in turn, and how many are alike."""
    if trials.cluster is None:
        for row, weight in enumerate(trials.weight):
            remaining = trials.weight.copy()
            remaining[row] -= 1.0
            yield trials.with_weights(remaining), float(weight)
        return
    for name in np.unique(trials.cluster):
        yield trials.with_weights(np.where(trials.cluster == name, 0.0, trials.weight)), 1.0


def _refit(trials: Trials, start: Array) -> Array:
    """Return the most likely coefficients, by Newton's method if they are near known ones."""
    at = start
    for _ in range(20):
        step = np.linalg.lstsq(information(trials, at), scores(trials, at).sum(axis=0))[0]
        at = at + step
        far = np.abs(at - start).max() > 2.0 * np.abs(start).max()
        if far or not np.isfinite(step).all():
            break
        if np.abs(step).max() <= 1e-10 * np.abs(at).max():
            return at
    return _maximum_likelihood(trials).coefficients


def _maximum_likelihood(trials: Trials) -> Fit:
    """Find the greatest likelihood, with the covariance of independent trials."""
    from scipy import linalg, optimize

    reason = _why_no_maximum(trials)
    if reason is FragilityStatus.SEPARATED and trials.measures == 1 and gap(trials) is None:
        reason = FragilityStatus.NOT_RISING
    if reason is not None:
        return Fit.none(reason, trials.measures)
    ends = trials.known_ends()
    middle, spread = ends[:, 1:].mean(axis=0), ends[:, 1:].std(axis=0)
    size = 1 + trials.measures
    # coefficients of measures that are centred and have unit spread are of similar size
    unscale = np.eye(size)
    unscale[0, 1:] = -middle / spread
    unscale[np.arange(1, size), np.arange(1, size)] = 1.0 / spread

    def value(scaled: Array) -> float:
        return -float(log_likelihood(trials, (unscale @ scaled)[:, None])[0])

    def slope(scaled: Array) -> Array:
        return -unscale.T @ scores(trials, unscale @ scaled).sum(axis=0)

    def curvature(scaled: Array) -> Array:
        return unscale.T @ information(trials, unscale @ scaled) @ unscale

    start = np.concatenate([[0.0], np.full(trials.measures, 1.0 / math.sqrt(trials.measures))])
    result: Any = optimize.minimize(
        value, start, method="trust-exact", jac=slope, hess=curvature,
        options={"gtol": 1e-9 * float(trials.weight.sum()), "maxiter": 500},
    )  # fmt: skip
    scaled = cast("Array", result.x)
    for _ in range(3):  # the last digits
        scaled = scaled - linalg.solve(curvature(scaled), slope(scaled), assume_a="pos")
    best = unscale @ scaled
    if trials.measures == 1 and scaled[1] <= ZERO_SLOPE:
        return Fit.none(FragilityStatus.NOT_RISING, trials.measures)
    observed = information(trials, best)
    return Fit(FragilityStatus.FITTED, best, observed, linalg.inv(observed))


def log_likelihood(trials: Trials, coefficients: Array) -> Array:
    """Return the logarithm of the likelihood, :eq:`eq-fragility-likelihood`."""
    return trials.weight @ log_interval_probability(*_etas(trials, coefficients))


def scores(trials: Trials, coefficients: Array) -> Array:
    """Return the slope of each trial's share in the log-likelihood."""
    return trials.weight[:, None] * interval_scores(*_ends(trials, coefficients))


def information(trials: Trials, coefficients: Array) -> Array:
    """Return observed information, the curvature of the log-likelihood with its sign changed."""
    return interval_information(*_ends(trials, coefficients), trials.weight)


def interval_scores(upper: Array, lower: Array, eta_upper: Array, eta_lower: Array) -> Array:
    """Return the derivatives by the coefficients of the logarithms of shares between two ends.

    `upper` and `lower` are the factors of the coefficients at the ends; an open end has zeros and
    an infinite eta.
    """
    at_upper, at_lower = _densities(eta_upper, eta_lower)
    return at_upper[:, None] * upper - at_lower[:, None] * lower


def interval_information(
    upper: Array, lower: Array, eta_upper: Array, eta_lower: Array, weight: Array | float = 1.0
) -> Array:
    """Return minus the second derivatives of the sum of the weighted log shares."""
    at_upper, at_lower = _densities(eta_upper, eta_lower)
    eta_upper, eta_lower = (np.where(np.isfinite(x), x, 0.0) for x in (eta_upper, eta_lower))
    of_upper = weight * at_upper * (eta_upper + at_upper)
    of_lower = weight * at_lower * (at_lower - eta_lower)
    of_both = weight * at_upper * at_lower
    crossed = upper.T @ (of_both[:, None] * lower)
    return (
        upper.T @ (of_upper[:, None] * upper)
        + lower.T @ (of_lower[:, None] * lower)
        - crossed
        - crossed.T
    )


def boundary(trials: Trials, fitted: Fit, level: float) -> Array:
    """Return the boundary of the region :eq:`eq-fragility-region`, for a fit of one measure.

    The range of any function of the coefficients in this region is its interval by profile
    likelihood. The likelihood of separated trials has a bound but no maximum, and the region is
    unbounded towards small dispersions: its boundary is set there where the dispersion is almost
    zero. This likelihood is itself the probability of the verdicts, so that both coefficients are
    rejected together, where it is below a share of its bound, :eq:`eq-fragility-separated`.
    """
    from scipy import linalg
    from scipy.special import chdtri

    separated = fitted.status is FragilityStatus.SEPARATED
    drop = float(chdtri(1.0, 1.0 - level))
    best, observed = fitted.coefficients, fitted.information
    if separated:
        # n trials can be separated in n - 1 ways, of which each may reject the true coefficients
        drop = 2.0 * math.log((float(trials.weight.sum()) - 1.0) / (1.0 - level))
        best, observed, greatest = _point_within_region(trials, 0.25 * drop)
    else:
        greatest = float(log_likelihood(trials, best[:, None])[0])
    angle = np.linspace(0.0, 2.0 * np.pi, RAY_COUNT, endpoint=False)
    root = linalg.cholesky(observed, lower=True)
    rays = linalg.solve_triangular(root.T, np.array([np.cos(angle), np.sin(angle)]))
    length = np.full(RAY_COUNT, math.sqrt(drop))
    block = max(1, _MAX_VALUES // len(trials.weight))
    for first in range(0, RAY_COUNT, block):
        part = slice(first, first + block)
        ray, reach = rays[:, part], length[part]

        def excess(reach: Array, ray: Array = ray) -> Array:
            at = best[:, None] + reach * ray
            return 2.0 * (greatest - log_likelihood(trials, at)) - drop

        inner, outer = np.zeros(reach.shape), np.full(reach.shape, np.inf)
        for _ in range(_DOUBLINGS):  # lengthen each ray until its end is outside the region
            beyond = excess(reach)
            # the likelihood is zero where the upper end of a bracket is below its lower end
            impossible, inside = ~np.isfinite(beyond), beyond < 0.0
            if not (impossible | inside).any():
                break
            inner, outer = np.where(inside, reach, inner), np.where(impossible, reach, outer)
            further = np.minimum(2.0 * reach, 0.5 * (inner + outer))
            reach = np.where(impossible | inside, further, reach)
        for _ in range(60):  # Newton's method: of a convex function it converges from above
            over = excess(reach)
            at_upper, at_lower = _densities(*_etas(trials, best[:, None] + reach * ray))
            upper, lower = trials.design
            slope = -2.0 * (trials.weight @ (at_upper * (upper @ ray) - at_lower * (lower @ ray)))
            step = np.divide(over, slope, out=np.zeros_like(over), where=over > 0.0)
            reach = np.maximum(reach - step, 1e-3 * reach)
            if np.all(np.abs(step) <= 1e-10 * reach):
                break
        length[part] = reach
    edge = best[:, None] + length * rays
    if not separated:
        return edge
    far = np.stack([np.array([-end, 1.0]) for end in gap(trials) or (0.0, 0.0)], axis=1)
    return np.concatenate([edge, best[:, None] + 2.0**_DOUBLINGS * far], axis=1)


def _point_within_region(trials: Trials, drop: float) -> tuple[Array, Array, float]:
    """Return coefficients of separated trials, the information there, and the bound.

    At the coefficients twice the log-likelihood is at most `drop` below the bound.
    """
    from scipy.special import ndtri

    low, high = gap(trials) or (0.0, 0.0)
    at_gap, bound = 0.0, 0.0
    if low == high:  # where some trials exceed: their share is the most likely probability there
        over = float(trials.weight[trials.has_upper & (trials.upper[:, 0] == low)].sum())
        under = float(trials.weight[trials.has_lower & (trials.lower[:, 0] == low)].sum())
        share = over / (over + under)
        at_gap, bound = float(ndtri(share)), over * math.log(share) + under * math.log1p(-share)
    median, slope = 0.5 * (low + high), 1.0
    while True:  # the likelihood increases with the slope
        at = np.array([at_gap - slope * median, slope])
        if not 2.0 * (bound - float(log_likelihood(trials, at[:, None])[0])) > drop:
            return at, information(trials, at), bound
        slope *= 1.1


def gap(trials: Trials) -> tuple[float, float] | None:
    """Return the logarithms of the intensities between which all capacities may lie."""
    least = float(trials.upper[trials.has_upper].min(initial=np.inf))
    most = float(trials.lower[trials.has_lower].max(initial=-np.inf))
    return (most, least) if most <= least else None


def _why_no_maximum(trials: Trials) -> FragilityStatus | None:
    """Say why the likelihood has no maximum: some change of the coefficients never lowers it."""
    from scipy import optimize

    if not len(trials.weight):
        return FragilityStatus.NO_TRIALS
    if not trials.has_upper.any():
        return FragilityStatus.NONE_EXCEEDED
    if not trials.has_lower.any():
        return FragilityStatus.ALL_EXCEEDED
    ends = trials.known_ends()
    rounding = SAME_INTENSITY * math.sqrt(len(ends))
    if np.linalg.matrix_rank(ends - ends.mean(axis=0), rounding) < trials.measures:
        return FragilityStatus.ONE_INTENSITY
    signed = np.unique(trials.known_ends(-1.0), axis=0)
    result: Any = optimize.linprog(
        -signed.sum(axis=0), A_ub=-signed, b_ub=np.zeros(len(signed)), bounds=(-1.0, 1.0)
    )
    return FragilityStatus.SEPARATED if -result.fun > 1e-9 * np.abs(signed).sum() else None


def _etas(trials: Trials, coefficients: Array) -> tuple[Array, Array]:
    """Return eta at both ends, infinite where one is open; shape (trials, sets)."""
    upper, lower = trials.design
    eta_upper = np.where(trials.has_upper[:, None], upper @ coefficients, np.inf)
    eta_lower = np.where(trials.has_lower[:, None], lower @ coefficients, -np.inf)
    return eta_upper, eta_lower


def _ends(trials: Trials, coefficients: Array) -> tuple[Array, Array, Array, Array]:
    """Return the factors of the coefficients at both ends, and eta there."""
    eta_upper, eta_lower = _etas(trials, coefficients[:, None])
    return *trials.design, eta_upper[:, 0], eta_lower[:, 0]


def _densities(upper: Array, lower: Array) -> tuple[Array, Array]:
    """Return the densities at both ends over the share between."""
    share = log_interval_probability(upper, lower)
    return np.exp(_log_density(upper) - share), np.exp(_log_density(lower) - share)


def log_interval_probability(upper: Array, lower: Array) -> Array:
    """Return ln(Phi(upper) - Phi(lower)), to the last digits in both tails."""
    from scipy.special import log_ndtr

    # in the upper tail the complementary distribution keeps the digits
    upper_tail = lower + upper > 0.0
    high = log_ndtr(np.where(upper_tail, -lower, upper))
    low = log_ndtr(np.where(upper_tail, -upper, lower))
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        return high + np.log(-np.expm1(np.where(np.isneginf(low), -np.inf, low - high)))


def _log_density(eta: Array) -> Array:
    """Return the logarithm of the density of the normal distribution."""
    return -0.5 * (eta * eta + math.log(2.0 * math.pi))
