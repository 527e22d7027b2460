"""Capacities against several limit states with one dispersion, whose curves do not cross.

A run shows how many of the limit states, each of which includes those before it, it exceeds: an
ordered verdict. Its likelihood, :eq:`eq-fragility-ordered`, is log-concave in the intercepts and
the slope that all have.
"""

import math
from collections.abc import Sequence

import numpy as np

from rockframe.errors import StudyError
from rockframe.results.variables.analyses import FragilityStatus
from rockframe.signals.arrays import AnyArray, Array
from rockframe.studies.fragility.likelihood import (
    SAME_INTENSITY,
    ZERO_SLOPE,
    Bands,
    Fit,
    cluster_sums,
    interval_information,
    interval_scores,
    jackknife,
    log_interval_probability,
    sandwich,
)


def ordered_fits(
    logs: Array, verdicts: Array, motions: AnyArray, names: Sequence[str], bands: Bands
) -> list[Fit]:
    """Fit all limit states at once; each run must exceed them from the lightest on."""
    for k in range(1, len(names)):
        count = int(((verdicts[k] == 1.0) & (verdicts[k - 1] == 0.0)).sum())
        if count:
            msg = (
                f"fragility: a common dispersion needs limit states that include one another; "
                f"{count} runs exceed {names[k]!r} and not {names[k - 1]!r}"
            )
            raise StudyError(msg)
    shares = verdicts.mean(axis=1) if verdicts.shape[1] else np.zeros(len(names))
    informative = (shares > 0.0) & (shares < 1.0)
    nothing = FragilityStatus.NONE_EXCEEDED, FragilityStatus.ALL_EXCEEDED
    fits = [Fit.none(nothing[int(share > 0.0)], 1) for share in shares]
    if not informative.any():
        return fits
    # limit states exceeded by the same runs have the same capacity
    _, ranks = np.unique(shares[informative], return_inverse=True)
    ranks = ranks.max() - ranks
    first = [int(np.flatnonzero(ranks == k)[0]) for k in range(ranks.max() + 1)]
    count = np.asarray(verdicts[informative][first].sum(axis=0), dtype=np.intp)
    one_intensity = np.ptp(logs) <= SAME_INTENSITY
    best = None if one_intensity else _maximum_likelihood(logs, count, len(first))
    if best is None or best[-1] * float(logs.std()) <= ZERO_SLOPE:
        status = FragilityStatus.SEPARATED if best is None else FragilityStatus.NOT_RISING
        status = FragilityStatus.ONE_INTENSITY if one_intensity else status
        for state in np.flatnonzero(informative):
            fits[state] = Fit.none(status, 1)
        return fits
    covariance, rows = _covariance(logs, count, motions, best, bands)
    observed = interval_information(*_ends(logs, count, best))
    for state, rank in zip(np.flatnonzero(informative), ranks, strict=True):
        pair = np.array([rank, len(best) - 1])
        square = np.ix_(pair, pair)
        leave_one_out = None if rows is None else (rows[:, pair], np.ones(len(rows)))
        fits[state] = Fit(
            FragilityStatus.FITTED, best[pair], observed[square], covariance[square], leave_one_out
        )
    return fits


def _ends(logs: Array, count: AnyArray, at: Array) -> tuple[Array, Array, Array, Array]:
    """Return the factors of the coefficients at both ends of each verdict, and eta there."""
    states = len(at) - 1
    upper, lower = np.zeros((2, len(logs), len(at)))
    rows = np.arange(len(logs))
    over, under = count > 0, count < states
    upper[rows[over], count[over] - 1] = 1.0
    lower[rows[under], count[under]] = 1.0
    upper[over, -1], lower[under, -1] = logs[over], logs[under]
    eta_upper = np.where(over, upper @ at, np.inf)
    eta_lower = np.where(under, lower @ at, -np.inf)
    return upper, lower, eta_upper, eta_lower


def _log_likelihood(logs: Array, count: AnyArray, at: Array) -> float:
    """Return the log-likelihood, :eq:`eq-fragility-ordered`; minus infinity if out of order."""
    *_, upper, lower = _ends(logs, count, at)
    if np.any(upper <= lower):
        return -math.inf
    return float(log_interval_probability(upper, lower).sum())


_MAX_STEPS = 100
_SEPARATED_SLOPE = 1e4
"""Slope, over the spread of the intensities, from which on trials are as good as separated."""


def _maximum_likelihood(
    logs: Array, count: AnyArray, states: int, start: Array | None = None
) -> Array | None:
    """Find the greatest likelihood by Newton's method; None for separated trials."""
    from scipy.special import ndtri

    middle, spread = float(logs.mean()), float(logs.std())
    if spread <= SAME_INTENSITY:
        return None
    scaled = (logs - middle) / spread
    if start is None:
        shares = np.array([(count > k).mean() for k in range(states)])
        if not np.all(np.diff(np.concatenate([[1.0], shares, [0.0]])) < 0.0):
            return None
        at = np.append(ndtri(shares), 1.0)
    else:
        at = np.append(start[:-1] + start[-1] * middle, start[-1] * spread)
    value = _log_likelihood(scaled, count, at)
    for _ in range(_MAX_STEPS):
        ends = _ends(scaled, count, at)
        slope = interval_scores(*ends).sum(axis=0)
        step = np.linalg.lstsq(interval_information(*ends), slope)[0]
        size = 1.0
        while size > 1e-10:
            if _log_likelihood(scaled, count, at + size * step) >= value - 1e-12:
                break
            size *= 0.5
        at = at + size * step
        value = _log_likelihood(scaled, count, at)
        if not np.isfinite(at).all() or at[-1] > _SEPARATED_SLOPE:
            return None
        if np.abs(step).max() <= 1e-11 * max(1.0, float(np.abs(at).max())):
            break
    else:
        return None
    return np.append(at[:-1] - at[-1] * middle / spread, at[-1] / spread)


def _covariance(
    logs: Array, count: AnyArray, motions: AnyArray, best: Array, bands: Bands
) -> tuple[Array, Array | None]:
    """Return covariance by motions, :eq:`eq-fragility-sandwich`, :eq:`eq-fragility-jackknife`."""
    if bands is Bands.SANDWICH:
        ends = _ends(logs, count, best)
        inverse = np.asarray(np.linalg.inv(interval_information(*ends)), dtype=np.float64)
        summed = cluster_sums(interval_scores(*ends), motions)
        return sandwich(inverse, summed, np.ones(len(summed))), None
    names, place = np.unique(motions, return_inverse=True)
    rows = np.full((len(names), len(best)), np.nan)
    for k in range(len(names)):
        is_other = place != k
        if (found := _fit_without_motion(logs[is_other], count[is_other], best)) is not None:
            rows[k] = found
    return jackknife(best, rows, np.ones(len(names))), rows


def _fit_without_motion(logs: Array, count: AnyArray, best: Array) -> Array | None:
    """Find the greatest likelihood of some of the runs, from that of all; None without one."""
    # Limit states between which none of these runs ends have one capacity: their intercepts would
    # pass one another without end, since no run requires them to be in order.
    states = len(best) - 1
    kinds, kind = np.unique(count, return_inverse=True)
    # no run is left, all exceed the first limit state, or none the last
    if not kinds.size or not (kinds[0] == 0 and kinds[-1] == states):
        return None
    place = np.searchsorted(kinds, np.arange(states), side="right") - 1
    first = np.searchsorted(place, np.arange(len(kinds) - 1))
    coefficients = _maximum_likelihood(logs, kind, len(first), best[[*first, states]])
    return None if coefficients is None else coefficients[[*place, len(first)]]
