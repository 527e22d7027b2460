"""The dataset of fragilities: fits, curves and what was counted."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, cast

import numpy as np
import xarray as xr

from rockframe.results.dataset import build_dataset
from rockframe.results.variables.analyses import LIMIT_STATE, FragilityStatus
from rockframe.signals.arrays import Array
from rockframe.studies.confidence import clopper_pearson
from rockframe.studies.fragility.likelihood import Bands, Fit, Trials, boundary, fit, gap
from rockframe.studies.intensities import PERIOD_OF, in_words

_POINTS: Final = 101
"""Intensities at which a curve is given."""
_SIDE: Final = 41
"""Intensities of each of two measures."""
_MOST_STRIPES: Final = 30
_BINS: Final = 10
"""Groups into which intensities are sorted that differ from run to run."""
_TITLE: Final = "Fragility of a rocking system"
_OF_INTENSITY: Final = (
    "median_intensity", "median_intensity_lower_bound", "median_intensity_upper_bound",
    "stripe_intensity",
)  # fmt: skip
"""Variables in the unit of the intensity."""
Labels = tuple[str, dict[str, Any]]
"""Name and attributes of an intensity measure."""


@dataclass(frozen=True)
class Means:
    """How bounds are found.

    Parameters
    ----------
    bands : Bands
        From what.
    confidence : float
        Of the bounds [1].
    """

    bands: Bands
    confidence: float

    @property
    def deviations(self) -> float:
        """Standard errors from an estimate to its bound."""
        from scipy.special import ndtri

        return float(ndtri(0.5 + 0.5 * self.confidence))


def labelled(
    trials: Sequence[Trials],
    counted: Sequence[tuple[Array, Array]],
    measures: Sequence[Labels],
    means: Means,
    last: str,
    period: float | None,
) -> xr.Dataset:
    """Fit capacities, and label what is found.

    Parameters
    ----------
    trials : sequence of Trials
        Of each limit state.
    counted : sequence of (ndarray, ndarray)
        Intensities, and whether they were exceeded, of each run; none of capacities.
    measures : sequence of (str, dict)
        Names and attributes of the intensity measures.
    means : Means
        How bounds are found.
    last : str
        The last limit state, in words.
    period : float or None
        Of the oscillator of a spectral intensity [s].

    Returns
    -------
    xarray.Dataset
    """
    fits = [fit(each, means.bands) for each in trials]
    one = len(measures) == 1
    attributes: dict[str, str | float | int] = {
        "verdict": _sentence(fits[-1], measures, last, period),
        "bands": means.bands.name.lower(),
        "confidence": means.confidence,
    }
    if period is not None:
        attributes[PERIOD_OF] = period
    status = {"fragility_status": np.array([each.status for each in fits])}
    dataset = build_dataset(
        status, attributes, over=LIMIT_STATE, title=_TITLE, source="greatest likelihood"
    )
    if one:
        (labels,) = measures
        dataset = _with_parameters(dataset, trials, fits, means)
        dataset = _with_curves(dataset, trials, fits, labels, means)
        pairs = counted or _decided(trials)
        dataset = _with_stripes(dataset, pairs, means)
        unit = labels[1].get("units")
        for name in _OF_INTENSITY:
            if name in dataset and unit is not None:
                dataset[name].attrs["units"] = unit
    else:
        dataset = _with_coefficients(dataset, fits, measures)
        dataset = _with_surface(dataset, trials, fits, measures, means)
    return dataset


def _with_parameters(
    dataset: xr.Dataset, trials: Sequence[Trials], fits: Sequence[Fit], means: Means
) -> xr.Dataset:
    """Add medians and dispersions."""
    rows: dict[str, list[float]] = {}
    for each, found in zip(trials, fits, strict=True):
        for name, value in _parameters(each, found, means).items():
            rows.setdefault(name, []).append(value)
    values = {name: np.array(row) for name, row in rows.items()}
    return dataset.assign(build_dataset(values, {}, over=LIMIT_STATE).data_vars)


def _parameters(trials: Trials, found: Fit, means: Means) -> dict[str, float]:
    if found.status is FragilityStatus.SEPARATED:
        return _step(trials)
    intercept, slope = (float(one) for one in found.coefficients)
    log_median, spread = -intercept / slope, 1.0 / slope
    turn = np.array([[-1.0 / slope, intercept / slope**2], [0.0, -1.0 / slope**2]])
    errors = np.sqrt(np.diag(turn @ found.covariance @ turn.T))
    bounds = np.full((2, 2), np.nan)
    if found.status is FragilityStatus.FITTED and means.bands is Bands.PROFILE:
        edge = boundary(trials, found, means.confidence)
        bounds = _extremes(edge)
    elif found.status is FragilityStatus.FITTED:
        reach = means.deviations * errors
        bounds = np.array([[log_median], [spread]]) + reach[:, None] * np.array([-1.0, 1.0])
        # a dispersion is above zero: its logarithm has the interval
        bounds[1] = spread * np.exp(reach[1] / spread * np.array([-1.0, 1.0]))
    return {
        "median_intensity": math.exp(log_median),
        "median_intensity_lower_bound": float(np.exp(bounds[0, 0])),
        "median_intensity_upper_bound": float(np.exp(bounds[0, 1])),
        "log_median_error": float(errors[0]),
        "dispersion": spread,
        "dispersion_lower_bound": float(bounds[1, 0]),
        "dispersion_upper_bound": float(bounds[1, 1]),
        "dispersion_error": float(errors[1]),
    }


def _step(trials: Trials) -> dict[str, float]:
    """Give the capacity of all trials alike, in the gap that parts those that exceed."""
    ends = gap(trials) or (math.nan, math.nan)
    return {
        "median_intensity": math.exp(0.5 * sum(ends)),
        "median_intensity_lower_bound": math.exp(ends[0]),
        "median_intensity_upper_bound": math.exp(ends[1]),
        "log_median_error": math.nan,
        "dispersion": 0.0,
        "dispersion_lower_bound": math.nan,
        "dispersion_upper_bound": math.nan,
        "dispersion_error": math.nan,
    }


def _extremes(edge: Array) -> Array:
    """Give the ranges of log-median and dispersion in a region of the coefficients."""
    intercept, slope = edge
    if slope.min() <= 0.0:  # also what does not rise is likely enough
        return np.array([[-np.inf, np.inf], [1.0 / slope.max(), np.inf]])
    medians = -intercept / slope
    return np.array([[medians.min(), medians.max()], [1.0 / slope.max(), 1.0 / slope.min()]])


def _with_curves(
    dataset: xr.Dataset,
    trials: Sequence[Trials],
    fits: Sequence[Fit],
    labels: Labels,
    means: Means,
) -> xr.Dataset:
    """Add exceedance probabilities over the intensity."""
    name, attributes = labels
    values = _spaced(trials, 0, _POINTS)
    rows = np.stack([np.ones(_POINTS), np.log(values)])
    curves = [_curve(each, found, rows, means) for each, found in zip(trials, fits, strict=True)]
    return dataset.assign(_probabilities(np.stack(curves, axis=1), name)).assign_coords(
        {name: (name, values, attributes)}
    )


def _curve(trials: Trials, found: Fit, rows: Array, means: Means) -> Array:
    """Give eta and its bounds at intensities."""
    if found.status is FragilityStatus.SEPARATED:
        low, high = gap(trials) or (math.nan, math.nan)
        ends = np.array([[0.5 * (low + high)], [high], [low]])
        return np.where(rows[1] < ends, -np.inf, np.inf)
    eta = found.coefficients @ rows
    if found.status is FragilityStatus.FITTED and means.bands is Bands.PROFILE:
        at = boundary(trials, found, means.confidence).T @ rows
        return np.stack([eta, at.min(axis=0), at.max(axis=0)])
    return _with_errors(eta, rows, found, means)


def _with_errors(eta: Array, rows: Array, found: Fit, means: Means) -> Array:
    """Give eta and its bounds by the covariance of the coefficients."""
    reach = means.deviations * np.sqrt(np.einsum("ik,ij,jk->k", rows, found.covariance, rows))
    return np.stack([eta, eta - reach, eta + reach])


def _with_surface(
    dataset: xr.Dataset,
    trials: Sequence[Trials],
    fits: Sequence[Fit],
    measures: Sequence[Labels],
    means: Means,
) -> xr.Dataset:
    """Add exceedance probabilities over two intensities."""
    sides = [_spaced(trials, k, _SIDE) for k in range(len(measures))]
    mesh = np.meshgrid(*sides, indexing="ij")
    rows = np.stack([np.ones(_SIDE**2), *(np.log(one).ravel() for one in mesh)])
    etas = [_with_errors(each.coefficients @ rows, rows, each, means) for each in fits]
    shape = (3, len(fits), *mesh[0].shape)
    names = [name for name, _ in measures]
    found = _probabilities(np.stack(etas, axis=1).reshape(shape), *names)
    coordinates = {
        name: (name, side, attributes)
        for (name, attributes), side in zip(measures, sides, strict=True)
    }
    return dataset.assign(found).assign_coords(coordinates)


def _with_coefficients(
    dataset: xr.Dataset, fits: Sequence[Fit], measures: Sequence[Labels]
) -> xr.Dataset:
    """Add the coefficients of fits over several measures."""
    names = ["intercept", *(name for name, _ in measures)]
    added = build_dataset(
        {
            "fitted_coefficient": np.stack([one.coefficients for one in fits]),
            "fitted_coefficient_error": np.sqrt(
                np.stack([np.diag(one.covariance) for one in fits])
            ),
        },
        {},
        over=LIMIT_STATE,
    )
    labels = build_dataset({"coefficient": np.array(names, dtype=object)}, {})
    return dataset.assign(added.data_vars).assign_coords(labels.coords)


def _probabilities(etas: Array, *measures: str) -> dict[str, xr.Variable]:
    from scipy.special import ndtr

    value, lower, upper = ndtr(etas)
    values = {
        "exceedance_probability": value,
        "exceedance_probability_lower_bound": lower,
        "exceedance_probability_upper_bound": upper,
    }
    built = build_dataset(values, {}, over=(*LIMIT_STATE, *measures))
    return {str(name): built[name].variable for name in built.data_vars}


def _with_stripes(
    dataset: xr.Dataset, counted: Sequence[tuple[Array, Array]], means: Means
) -> xr.Dataset:
    """Add how many exceeded, by groups of intensities, with the bounds of Clopper and Pearson."""
    every = np.concatenate([columns[:, 0] for columns, _ in counted])
    every = np.unique(np.round(np.log(every[np.isfinite(every) & (every > 0.0)]), 9))
    if len(every) > _MOST_STRIPES:
        cuts = np.quantile(every, np.linspace(0.0, 1.0, _BINS + 1))
        middles = 0.5 * (cuts[1:] + cuts[:-1])
    else:
        middles = every
        cuts = np.concatenate([every, [np.inf]]) - 1e-8
    size = len(middles)
    count, over = np.zeros((2, len(counted), size), dtype=np.int64)
    for row, (columns, verdict) in enumerate(counted):
        kept = ~np.isnan(verdict) & (columns[:, 0] > 0.0)
        place = np.searchsorted(cuts, np.log(columns[kept, 0]), side="right") - 1
        place = np.clip(place, 0, max(size - 1, 0))
        count[row] = np.bincount(place, minlength=size)
        over[row] = np.bincount(place, weights=verdict[kept], minlength=size)
    lower, upper = clopper_pearson(over, count, means.confidence)
    with np.errstate(invalid="ignore"):
        fraction = over / count
    values = {
        "stripe_trials": count,
        "stripe_exceedances": over,
        "stripe_fraction": fraction,
        "stripe_fraction_lower_bound": lower,
        "stripe_fraction_upper_bound": upper,
    }
    of_states = build_dataset(values, {}, over=LIMIT_STATE)
    of_all = build_dataset({"stripe_intensity": np.exp(middles)}, {})
    return dataset.assign(of_states.data_vars).assign(of_all.data_vars)


def _decided(trials: Sequence[Trials]) -> list[tuple[Array, Array]]:
    """Give verdicts on capacities at some intensities, which part them into equal groups."""
    every = [np.where(each.has_upper, each.upper[:, 0], each.lower[:, 0]) for each in trials]
    ends = np.concatenate(every)
    if not len(ends):
        return [(np.empty((0, 1)), np.empty(0)) for _ in trials]
    levels = np.unique(np.quantile(ends, np.linspace(0.05, 0.95, _BINS), method="nearest"))
    found: list[tuple[Array, Array]] = []
    for each in trials:
        over = each.has_upper[:, None] & (each.upper[:, :1] <= levels)
        under = each.has_lower[:, None] & (each.lower[:, :1] >= levels)
        verdict = np.where(over, 1.0, np.where(under, 0.0, np.nan))
        columns = np.exp(np.broadcast_to(levels, verdict.shape))
        found.append((columns.ravel()[:, None], verdict.ravel()))
    return found


def _spaced(trials: Sequence[Trials], measure: int, count: int) -> Array:
    """Give intensities from the least to the greatest, with equal ratios."""
    ends = np.concatenate(
        [
            values[has, measure]
            for each in trials
            for values, has in ((each.lower, each.has_lower), (each.upper, each.has_upper))
        ]
    )
    least, most = (float(ends.min()), float(ends.max())) if len(ends) else (-1.0, 1.0)
    reach = 0.0 if most > least else 1.0
    return np.exp(np.linspace(least - reach, most + reach, count))


def _sentence(last: Fit, measures: Sequence[Labels], state: str, period: float | None) -> str:
    """Tell what was fitted to the last limit state."""
    names = " and ".join(in_words(name, period) for name, _ in measures)
    if last.status is not FragilityStatus.FITTED:
        why = last.status.name.lower().replace("_", " ")
        return f"Against {state} no lognormal capacity fits over {names}: {why}."
    if len(measures) > 1:
        return f"Capacity against {state} fitted over {names}."
    intercept, slope = (float(one) for one in last.coefficients)
    unit = cast("str", measures[0][1].get("units", ""))
    return (
        f"Capacity against {state}: median {names} {math.exp(-intercept / slope):.4g} {unit}, "
        f"dispersion {1.0 / slope:.3g}."
    )
