"""Mean annual rate of exceeding a limit state, from a fragility and a hazard curve."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final, cast

import numpy as np
import xarray as xr
from numpy.polynomial.legendre import leggauss

from rockframe.arguments import checked_dataset, checked_function
from rockframe.errors import (
    ComponentError,
    ModelWarning,
    SchemaError,
    UnitsError,
    short_repr,
    warn,
)
from rockframe.results.schema import build_dataset, with_labels, with_variables
from rockframe.results.variables.analyses import FragilityStatus
from rockframe.results.variables.studies import CAUTIONS
from rockframe.results.variables.variable import unit_of, unit_suffix_of
from rockframe.signals.arrays import Array
from rockframe.studies.confidence import normal_scores
from rockframe.studies.fragility.likelihood import log_interval_probability
from rockframe.studies.fragility.words import in_own_units, measures_of
from rockframe.studies.intensities import PERIOD_ATTRIBUTE, measure_words
from rockframe.studies.sweeps.axes import read_free_values, read_in_unit_of
from rockframe.suggestions import with_hints
from rockframe.units import POSITIVE, Unit, check_attached_unit, to_ratio

_OWNER: Final = "annual_rate"
_REFERENCES: Final = "Cornell (1996), 11th World Conf. Earthquake Eng., paper 2122"
_COLUMNS: Final = ("intensity", "rate"), ("intensity", "probability", "years")
_MAX_STEP: Final = 0.02
"""Longest part of an integral, as a logarithm of intensity; a polynomial fits well within it."""
_GAUSS_POINTS: Final = 5
"""Points of Gauss-Legendre integration in each part."""
_FUNCTION_POINTS: Final = 400
"""Number of intensities at which a hazard given as a function is evaluated."""
_BINS: Final = 40
"""Number of bins of intensity for the contributions to the rate."""
_QUANTILES: Final = (0.05, 0.5, 0.95)
_WARNING_SHARE: Final = 0.01
"""Share of the rate beyond the hazard curve above which a warning is given [1]."""
_EXTRAPOLATION_RANGE: Final = 12.0
"""Least range over which the ends of the hazard curve are extrapolated, as a logarithm of
intensity."""
_NEGLIGIBLE: Final = 30.0
"""Fall of the rate, as a logarithm, after which the rest is negligible."""
_GREATEST_EXPONENT: Final = 600.0
"""Greatest exponent of a power law over its range, whose exponential is still finite."""


@dataclass(frozen=True, eq=False)
class HazardCurve:
    """Mean annual rates of exceeding intensities, linear in logarithms between points."""

    intensities: Array  # ascending, in the unit of the measure
    rates: Array  # descending [1/year]

    def slopes(self) -> Array:
        """Return the exponents of the power laws between the points [1]."""
        return -np.diff(np.log(self.rates)) / np.diff(np.log(self.intensities))

    def extrapolations(self) -> tuple["HazardCurve", "HazardCurve"]:
        """Return extrapolations of the curve below and above, by its first and last power law."""
        first, last = self.slopes()[[0, -1]].tolist()
        # above, a flat curve falls slowly
        reach = min(max(_EXTRAPOLATION_RANGE, _NEGLIGIBLE / last), _GREATEST_EXPONENT)
        growth, fall = (
            min(slope * length, _GREATEST_EXPONENT)
            for slope, length in ((first, _EXTRAPOLATION_RANGE), (last, reach))
        )
        below = self.rates[0] * np.array([math.exp(growth), 1.0])
        above = self.rates[-1] * np.array([1.0, math.exp(-fall)])
        return (
            HazardCurve(
                self.intensities[0] / np.array([math.exp(_EXTRAPOLATION_RANGE), 1.0]), below
            ),
            HazardCurve(self.intensities[-1] * np.array([1.0, math.exp(reach)]), above),
        )


@with_hints()
def annual_rate(
    fragility: xr.Dataset,
    hazard: Mapping[str, Any] | xr.DataArray | Callable[[Array], Any],
    *,
    between: Any = None,
) -> xr.Dataset:
    """Compute the mean annual rate of exceeding limit states, and the contributing intensities.

    Parameters
    ----------
    fragility : xarray.Dataset
        Result of :func:`rockframe.fragility` or :func:`rockframe.cloud_analysis`, over one
        measure.
    hazard : mapping, DataArray or callable
        Mean annual rate at which the site exceeds values of that measure. A table: ``{"intensity":
        ([0.1, 0.2, 0.5], "g_0"), "rate": [1e-2, 3e-3, 2e-4]}``, or with ``"probability"`` and
        ``"years"`` instead of ``"rate"``, for the probability of at least one exceedance in that
        many years. Or a DataArray of rates whose only dimension has the intensities, with their
        unit. Or a function of an array of intensities in SI units. Rates without a unit are numbers
        a year [year^-1].
    between : (sequence, unit), Quantity or sequence of str, optional
        Range of intensities in which a hazard given as a function is valid.

    Returns
    -------
    xarray.Dataset
        Over structures and ``limit_state``: ``annual_rate``, with the rates by the upper and lower
        bounds of the curve; ``unreached_rate_below`` and ``unreached_rate_above``, the rates beyond
        the ends of the hazard curve if it is extrapolated; ``outside_trials_share``. Over
        ``contributing_intensity`` too: ``rate_share``. Over ``quantile``: ``quantile_intensity``,
        below which that share of the rate arises. The attribute ``verdict`` is a summary in words.

    Raises
    ------
    SchemaError
        The dataset is not a fragility over one measure.
    UnitsError, ComponentError
        The hazard has another unit or none, does not decrease, or is of an unsupported type.

    Warns
    -----
    ModelWarning
        More than 1 % of the rate lies beyond the hazard curve.

    Notes
    -----
    :eq:`eq-annual-rate`, Cornell (1996). Between the points of a table the hazard is a power law, a
    straight line on logarithmic axes, and the integral over each part is exact for a lognormal
    capacity, :eq:`eq-rate-of-part`. The rates of both bounds use each bounding curve as a whole,
    and so lie farther apart than bounds of the rate of the same confidence.

    Examples
    --------
    >>> import rockframe as rf
    >>> levels = ([0.2, 0.3, 0.4, 0.6, 0.7, 0.8, 0.9, 1.0], "g_0")
    >>> counts = {"intensity": levels, "exceeded": [0, 0, 0, 4, 6, 13, 12, 16], "trials": 40}
    >>> curve = rf.fragility(counts, "PGA")
    >>> found = rf.annual_rate(
    ...     curve, lambda a: 1e-4 * (a / 9.81) ** -2.5, between=["0.01 g_0", "20 g_0"]
    ... )
    >>> f"{found.annual_rate.item():.2e}"
    '1.48e-04'
    """
    curves = checked_dataset(fragility, owner=_OWNER)
    measure = _intensity_measure(curves)
    curves = in_own_units(curves, measure, owner=_OWNER)
    curve = read_hazard(hazard, curves[measure], between)
    status = curves["fragility_status"]
    dims = tuple(map(str, status.dims))
    places = (dict(zip(status.dims, place, strict=True)) for place in np.ndindex(status.shape))
    rows = [_rate_of_state(curves.isel(place), curve, measure) for place in places]
    arrays = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    dataset = build_dataset(
        {name: array.reshape((*status.shape, *array.shape[1:])) for name, array in arrays.items()},
        {"references": _REFERENCES}, over=dims, title="Annual rate of exceeding limit states",
        source="integral of a fragility over a hazard curve",
    )  # fmt: skip
    labels = {
        "contributing_intensity": np.sqrt(_bin_edges(curve)[1:] * _bin_edges(curve)[:-1]),
        "quantile": np.array(_QUANTILES),
    }
    coordinates = [str(name) for name in curves.coords if set(curves[name].dims) <= set(dims)]
    dataset = with_labels(dataset, {name: curves[name].variable for name in coordinates})
    dataset = with_variables(dataset, labels)
    for name in ("quantile_intensity", "contributing_intensity"):
        dataset[name].attrs["units"] = unit_of(curves[measure].attrs)
    known = curves.attrs
    attributes = {key: known[key] for key in (PERIOD_ATTRIBUTE, "model", CAUTIONS) if key in known}
    attributes |= {"intensity": measure, "confidence": known.get("confidence", math.nan)}
    dataset = dataset.assign_attrs(attributes)
    _warn_beyond_curve(dataset, curve)
    return dataset.assign_attrs(verdict=_sentence(dataset))


def read_hazard(value: object, measure: xr.DataArray, between: object) -> HazardCurve:
    """Read a hazard curve over a measure, and refuse one that does not descend."""
    name, unit = str(measure.name), unit_of(measure.attrs)
    if callable(value):
        if between is None:
            msg = f"{_OWNER}: a hazard that is a function needs between, such as ('0.01 g_0', ...)"
            raise ComponentError(msg)
        ends = _read_intensities(between, name, unit)
        if len(ends) != 2 or not 0.0 < ends[0] < ends[1]:
            msg = f"{_OWNER}: between must be two intensities that rise, got {short_repr(between)}"
            raise ComponentError(msg)
        values = np.geomspace(float(ends[0]), float(ends[1]), _FUNCTION_POINTS)
        rate = checked_function(value, "intensities", owner=_OWNER, name="hazard")
        rates = np.broadcast_to(np.asarray(rate(values), dtype=np.float64), values.shape)
    elif isinstance(value, xr.DataArray) and value.ndim == 1:
        (dim,) = value.dims
        pair = value[dim].to_numpy(), unit_of(value[dim].attrs)
        values = _read_intensities(pair, name, unit)
        rates = _read_numbers(value, "rate", Unit.PER_YEAR)
    elif isinstance(value, Mapping):
        table = cast("Mapping[str, Any]", value)
        if set(table) not in map(set, _COLUMNS):
            expected = " or ".join(", ".join(map(repr, names)) for names in _COLUMNS)
            found = ", ".join(map(short_repr, table))
            msg = f"{_OWNER}: a table of hazard has {expected}; found {found}"
            raise ComponentError(msg)
        values = _read_intensities(table["intensity"], name, unit)
        rates = _read_rates(table)
    else:
        expected = "a table, a DataArray or a function"
        msg = f"{_OWNER}: hazard must be {expected}, got {short_repr(value)}"
        raise ComponentError(msg)
    if rates.shape != values.shape or len(values) < 2:
        msg = (
            f"{_OWNER}: a hazard curve needs two intensities or more, with a rate each; found "
            f"{values.size} and {rates.size}"
        )
        raise ComponentError(msg)
    is_valid = np.all(np.diff(values) > 0.0) and np.all(np.diff(rates) < 0.0)
    if not (is_valid and values[0] > 0.0 and rates[-1] > 0.0 and math.isfinite(rates[0])):
        msg = (
            f"{_OWNER}: in a hazard curve intensities above zero rise, and rates above zero fall; "
            f"found {short_repr(values.tolist())} and {short_repr(rates.tolist())}"
        )
        raise ComponentError(msg)
    return HazardCurve(values, rates)


def _read_intensities(value: object, name: str, unit: str) -> Array:
    pair = cast("tuple[Any, ...]", value) if isinstance(value, tuple) else ()
    own_measure = unit == Unit.ONE or unit not in map(str, Unit)
    if len(pair) == 2 and pair[1] == unit and own_measure:
        check_attached_unit(pair[0], unit, owner=_OWNER, name="intensity")
        return np.asarray(read_free_values(list(pair[0]), "intensity", owner=_OWNER)[0], float)
    return read_in_unit_of(name, unit, value, "intensity", owner=_OWNER)


def _read_numbers(value: object, name: str, unit: Unit) -> Array:
    """Return plain numbers, or values with a unit of the kind of `unit` as numbers in it."""
    held = value
    if isinstance(value, xr.DataArray):
        given = unit_of(value.attrs)
        held = value.to_numpy() if given == Unit.ONE else (value.to_numpy(), given)
    numbers, own_unit = read_free_values(held, name, owner=_OWNER, expected=unit)
    if own_unit not in (unit, Unit.ONE):
        kinds = f"plain numbers{'' if unit == Unit.ONE else f' or values in {unit}'}"
        msg = f"{_OWNER}: {name} needs {kinds}, got {short_repr(value)}"
        raise UnitsError(msg)
    return np.asarray(numbers, dtype=np.float64)


def _read_rates(table: Mapping[str, Any]) -> Array:
    """Return rates; from probabilities in some years by a Poisson process."""
    if "rate" in table:
        return _read_numbers(table["rate"], "rate", Unit.PER_YEAR)
    years = to_ratio(table["years"], owner=_OWNER, name="years", condition=POSITIVE, example="50")
    chance = _read_numbers(table["probability"], "probability", Unit.ONE)
    if np.any(chance <= 0.0) or np.any(chance >= 1.0):
        given = short_repr(chance.tolist())
        msg = f"{_OWNER}: probabilities must be above 0 and below 1, got {given}"
        raise ComponentError(msg)
    return -np.log1p(-chance) / years


def _intensity_measure(dataset: xr.Dataset) -> str:
    """Return the one measure of a fragility."""
    if "exceedance_probability" not in dataset or "fragility_status" not in dataset:
        msg = f"{_OWNER}: found no fragility; expected one of rf.fragility or rf.cloud_analysis"
        raise SchemaError(msg)
    several = measures_of(dataset)
    if len(several) != 1:
        msg = f"{_OWNER}: found a fragility over {' and '.join(several)}; expected one measure"
        raise SchemaError(msg)
    return several[0]


_WITH_FRAGILITY: Final = (FragilityStatus.FITTED, FragilityStatus.SEPARATED)


def _rate_of_state(fragility: xr.Dataset, curve: HazardCurve, measure: str) -> dict[str, Any]:
    """Return rate and contributions of one limit state; NaN without a fragility."""
    names = (
        "annual_rate", "annual_rate_lower_bound", "annual_rate_upper_bound",
        "unreached_rate_below", "unreached_rate_above", "outside_trials_share",
    )  # fmt: skip
    if int(fragility["fragility_status"]) not in _WITH_FRAGILITY:
        sizes = {"rate_share": _BINS, "quantile_intensity": len(_QUANTILES)}
        none = {name: np.full(size, np.nan) for name, size in sizes.items()}
        return dict.fromkeys(names, np.nan) | none
    edges, parts = _contributions(fragility, curve)
    rate = float(parts.sum())
    with np.errstate(invalid="ignore"):  # a rate of zero has no shares
        cumulative = np.concatenate([[0.0], np.cumsum(parts)]) / rate
    logs = np.log(edges)
    of_bounds = (fragility[f"exceedance_probability_{end}_bound"] for end in ("lower", "upper"))
    bounds = (
        math.nan if np.isnan(bound).any() else float(_integrated(bound, *_subdivided(curve)).sum())
        for bound in of_bounds
    )
    outside = (float(_contributions(fragility, end)[1].sum()) for end in curve.extrapolations())
    least, most = np.interp(np.log(_range_of_trials(fragility, measure)), logs, cumulative)
    numbers = rate, *bounds, *outside, 1.0 - (most - least)
    return dict(zip(names, numbers, strict=True)) | {
        "rate_share": np.diff(np.interp(np.log(_bin_edges(curve)), logs, cumulative)),
        "quantile_intensity": np.exp(np.interp(_QUANTILES, cumulative, logs)),
    }


def _range_of_trials(fragility: xr.Dataset, measure: str) -> tuple[float, float]:
    """Return the least and the greatest intensity of trials; a stripe may be a group of them."""
    along, stripes = fragility[measure].to_numpy(), fragility["stripe_intensity"].to_numpy()
    (tried,) = np.nonzero(fragility["stripe_trials"].to_numpy() > 0)
    first, last = tried[[0, -1]]
    return (
        float(along[0] if first == 0 else stripes[first]),
        float(along[-1] if last == len(stripes) - 1 else stripes[last]),
    )


def _bin_edges(curve: HazardCurve) -> Array:
    return np.geomspace(curve.intensities[0], curve.intensities[-1], _BINS + 1)


def _contributions(fragility: xr.Dataset, curve: HazardCurve) -> tuple[Array, Array]:
    """Return intensities, and the contributions to the rate between them [1/year]."""
    edges, rates, slopes = _subdivided(curve)
    if "median_intensity" in fragility and "logistic_slope" not in fragility:
        median, spread = float(fragility["median_intensity"]), float(fragility["dispersion"])
        return edges, lognormal_rates(median, spread, edges, rates, slopes)
    return edges, _integrated(fragility["exceedance_probability"], edges, rates, slopes)


def lognormal_rates(
    median: float, spread: float, edges: Array, rates: Array, slopes: Array
) -> Array:
    """Return the rate of a lognormal capacity in parts of a power law, :eq:`eq-rate-of-part`."""
    from scipy.special import ndtr

    eta = np.where(edges < median, -np.inf, np.inf)
    if spread > 0.0:
        with np.errstate(divide="ignore"):
            eta = np.log(edges / median) / spread
    # where the power law of a part is steep, the hazard at the median is large and the share of
    # capacities within the part is small: their logarithms are added
    shift = slopes * spread
    at_median = np.log(rates[:-1]) + slopes * np.log(edges[:-1] / median)
    with np.errstate(invalid="ignore"):  # without a spread eta is infinite
        within = log_interval_probability(eta[1:] + shift, eta[:-1] + shift)
    power_law_share = np.exp(at_median + 0.5 * shift**2 + within)
    return power_law_share - ndtr(eta[1:]) * rates[1:] + ndtr(eta[:-1]) * rates[:-1]


def _subdivided(curve: HazardCurve) -> tuple[Array, Array, Array]:
    """Cut the curve into parts; give their ends, the rates there, and the slopes between."""
    logs = np.log(curve.intensities)
    counts = np.maximum(1, np.ceil(np.diff(logs) / _MAX_STEP)).astype(int)
    ends = [
        np.linspace(low, high, count, endpoint=False)
        for low, high, count in zip(logs[:-1], logs[1:], counts, strict=True)
    ]
    fine = np.concatenate([*ends, logs[-1:]])
    rates = np.exp(np.interp(fine, logs, np.log(curve.rates)))
    return np.exp(fine), rates, np.repeat(curve.slopes(), counts)


def _integrated(curve: xr.DataArray, edges: Array, rates: Array, slopes: Array) -> Array:
    """Integrate any probability, given by a curve, over the parts of the hazard."""
    nodes, weights = leggauss(_GAUSS_POINTS)
    logs = np.log(edges)
    half = 0.5 * np.diff(logs)
    at = (0.5 * (logs[1:] + logs[:-1]))[:, None] + half[:, None] * nodes
    density = (slopes * rates[:-1])[:, None] * np.exp(-slopes[:, None] * (at - logs[:-1, None]))
    return half * ((_interpolated(curve, at) * density) @ weights)


def _interpolated(curve: xr.DataArray, at: Array) -> Array:
    """Return the probability at log intensities: linear in normal scores, extrapolated."""
    from scipy.special import ndtr

    with np.errstate(invalid="ignore"):
        eta = normal_scores(curve.to_numpy())
    logs = np.log(curve[curve.dims[0]].to_numpy())
    slope = [(eta[k] - eta[k - 1]) / (logs[k] - logs[k - 1]) for k in (1, len(logs) - 1)]
    score = np.interp(at, logs, eta)
    score = np.where(at < logs[0], eta[0] + max(slope[0], 0.0) * (at - logs[0]), score)
    score = np.where(at > logs[-1], eta[-1] + max(slope[1], 0.0) * (at - logs[-1]), score)
    return ndtr(score)


def _warn_beyond_curve(dataset: xr.Dataset, curve: HazardCurve) -> None:
    """Warn if a part of the rate lies beyond the ends of the hazard curve."""
    unit = unit_suffix_of(dataset["quantile_intensity"].attrs)
    ends = {"below": curve.intensities[0], "above": curve.intensities[-1]}
    missing: list[str] = []
    for side, end in ends.items():
        with np.errstate(invalid="ignore", divide="ignore"):
            rate = dataset["annual_rate"] + dataset[f"unreached_rate_{side}"]
            share = float((dataset[f"unreached_rate_{side}"] / rate).max(skipna=True))
        if share > _WARNING_SHARE:
            percentage = f"{100.0 * share:.2g} % of the rate"
            missing.append(f"{side} {end:.4g}{unit}, where it ends, {percentage}")
    if missing:
        warn(
            f"{_OWNER}: the hazard curve does not reach where the limit states are exceeded: if it "
            f"goes on as it ends, there lie {' and '.join(missing)}; give a longer one",
            ModelWarning,
        )


def verdict_of_rates(dataset: xr.Dataset) -> str:
    """Say the annual rate; of a part of the rates, that of the part."""
    whole = {"quantile_intensity", "outside_trials_share"} <= set(dataset)
    if not whole or dataset.sizes.get("quantile") != len(_QUANTILES):
        return str(dataset.attrs.get("verdict", ""))
    return _sentence(dataset)


def _sentence(dataset: xr.Dataset) -> str:
    """Return the verdict in words: rate of the last limit state, and contributing intensities."""
    last = dataset.isel(limit_state=-1) if "limit_state" in dataset.dims else dataset
    state = str(last["limit_state"].item()) if "limit_state" in last.coords else "what was counted"
    rates = np.atleast_1d(last["annual_rate"].to_numpy()).ravel()
    known = rates[~np.isnan(rates)]
    if not len(known):
        text = f"There is no fragility against {state}, and so no rate."
        rates = dataset["annual_rate"]
        others = rates.notnull().any([dim for dim in rates.dims if dim != "limit_state"])
        if "limit_state" in others.dims and others.any():
            text += f" {_sentence(dataset.isel(limit_state=np.flatnonzero(others)[-1:]))}"
        return text
    measure = measure_words(str(dataset.attrs["intensity"]), dataset.attrs.get(PERIOD_ATTRIBUTE))
    unit = unit_suffix_of(dataset["quantile_intensity"].attrs)
    if len(known) > 1:
        return f"Annual rate of {state}: from {known.min():.3g} to {known.max():.3g}."
    if known[0] == 0.0:
        return f"Annual rate of {state}: 0 within the hazard curve."
    if len(rates) > 1:  # the others have no fragility
        rate = last["annual_rate"]
        place = np.unravel_index(int(np.nanargmax(rate.to_numpy())), rate.shape)
        last = last.isel(dict(zip(rate.dims, place, strict=True)))
        state += f", of the one of {len(rates)} structures that has a fragility"
    low, _, high = last["quantile_intensity"].to_numpy().ravel()
    years = float(f"{1.0 / known[0]:.4g}")
    text = f"Annual rate of {state}: {known[0]:.3g}, a return period of {years:.12g} years; "
    text += f"nine tenths of it come from {measure} between {low:.3g} and {high:.3g}{unit}"
    outside = float(last["outside_trials_share"].max())
    if outside > _WARNING_SHARE:
        text += f", {100.0 * outside:.2g} % from intensities beyond those of the runs"
    return f"{text}."
