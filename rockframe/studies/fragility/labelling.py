"""The dataset of fragilities: fits, curves and counts."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.results.schema import build_dataset, with_labels, with_variables
from rockframe.results.variables.analyses import FragilityStatus
from rockframe.results.variables.variable import unit_of
from rockframe.signals.arrays import AnyArray, Array
from rockframe.studies.confidence import BOUND_SUFFIXES, clopper_pearson
from rockframe.studies.fragility.likelihood import Bands, Fit, boundary, fit, gap, jackknife
from rockframe.studies.fragility.trials import StructureTrials, Trials
from rockframe.studies.fragility.words import enough_trials

_REFERENCES: Final = "Baker (2015), Earthquake Spectra 31, 579-599"
_REFERENCES_OF_ORDERED: Final = "McCullagh (1980), J. Royal Statistical Soc. B 42, 109-142"
_CURVE_POINTS: Final = 101
"""Intensities at which a curve is given."""
_SURFACE_POINTS: Final = 41
"""Intensities of each of two measures."""
_STEEPEST_SLOPE: Final = 1e6
"""Slopes beyond which a dispersion counts as zero: rays of an unbounded region go far beyond."""
_MAX_STRIPES: Final = 30
_BINS: Final = 10
"""Groups into which intensities are sorted that differ from run to run."""
_INTENSITY_VARIABLES: Final = (
    "median_intensity", "median_intensity_lower_bound", "median_intensity_upper_bound",
    "separation_lower_intensity", "separation_upper_intensity", "stripe_intensity",
    "cloud_intensity",
)  # fmt: skip
"""Variables in the unit of the intensity."""
MeasureLabel = tuple[str, dict[str, Any]]
"""Name and attributes of an intensity measure."""


@dataclass(frozen=True)
class BoundSettings:
    """How bounds are found."""

    bands: Bands  # from what
    confidence: float  # of the bounds [1]

    def standard_errors(self, clusters: float = math.inf) -> float:
        """Return standard errors from an estimate to its bound, by Student's t of few clusters."""
        from scipy.special import ndtri, stdtrit

        share = 0.5 + 0.5 * self.confidence
        return float(ndtri(share) if math.isinf(clusters) else stdtrit(clusters - 1.0, share))


@dataclass(frozen=True, eq=False)
class _FittedTrials:
    """Trials with their fit, its region by profile, and whether there are bounds."""

    trials: Trials
    fit: Fit
    boundary: Array | None
    has_bounds: bool
    # if the trials of one measure are separated: the logarithms between which the median lies
    gap: tuple[float, float] | None

    @classmethod
    def from_trials(
        cls, structure: StructureTrials, settings: BoundSettings, given: Fit | None = None
    ) -> "_FittedTrials":
        """Fit, unless a fit is given, and find the region if it determines the bounds."""
        trials, fitted = structure.trials, given or fit(structure.trials, settings.bands)
        separation = None
        if fitted.status is FragilityStatus.SEPARATED and trials.measures == 1:
            separation = gap(trials) or (math.nan, math.nan)
        # capacities separated by an intensity are close by chance: bounds based on their closeness
        # would hold in few samples
        counted = trials.cluster is None and not np.any(trials.has_lower & trials.has_upper)
        bands = settings.bands if separation is None else Bands.PROFILE
        has_bounds = (separation is not None and counted) or fitted.status is FragilityStatus.FITTED
        has_bounds = has_bounds and enough_trials(bands, structure.independent) and fitted.complete
        edge = None
        if has_bounds and bands is Bands.PROFILE:
            edge = boundary(trials, fitted, settings.confidence)
        return cls(trials, fitted, edge, has_bounds, separation)


def fragility_dataset(
    structures: Sequence[StructureTrials],
    sizes: Mapping[str, int],
    measures: Sequence[MeasureLabel],
    settings: BoundSettings,
    attributes: Mapping[str, Any],
    fits: Sequence[Fit] | None = None,
) -> xr.Dataset:
    """Fit capacities of structures and limit states, unless fits are given, and label them."""
    rows = zip(structures, fits or [None] * len(structures), strict=True)
    every = [_FittedTrials.from_trials(structure, settings, given) for structure, given in rows]
    values: dict[str, Any] = {
        "fragility_status": [fitted.fit.status for fitted in every],
        "trial_count": [structure.trials.weight.sum() for structure in structures],
        "left_out_count": [structure.left_out for structure in structures],
        "independent_count": [structure.independent for structure in structures],
    }
    single_measure = len(measures) == 1
    if single_measure:
        rows = [_parameters(fitted, settings) for fitted in every]
        values |= {name: [row[name] for row in rows] for name in rows[0]}
    else:
        values["fitted_coefficient"] = [fitted.fit.coefficients for fitted in every]
        errors = [np.sqrt(np.diag(fitted.fit.covariance)) for fitted in every]
        values["fitted_coefficient_error"] = errors
    dataset = build_dataset(
        _reshaped(values, sizes),
        {**attributes, "bands": str(settings.bands), "confidence": settings.confidence,
         "references": _REFERENCES if fits is None else _REFERENCES_OF_ORDERED},
        over=tuple(sizes), title="Fragility of a rocking system", source="greatest likelihood",
    )  # fmt: skip
    if not single_measure:
        names = np.array(["intercept", *(name for name, _ in measures)], dtype=object)
        dataset = with_variables(dataset, {"coefficient": names})
    dataset = _with_curves(dataset, every, sizes, measures, settings)
    if single_measure:
        runs = [structure.runs for structure in structures if structure.runs is not None]
        runs = runs or _capacity_verdicts([structure.trials for structure in structures])
        dataset = with_stripes(dataset, runs, sizes, settings.confidence, measures[0][1])
    return dataset


def _reshaped(values: Mapping[str, Any], sizes: Mapping[str, int]) -> dict[str, AnyArray]:
    """Return values in a row as arrays over structures and limit states."""
    arrays = {name: np.asarray(value) for name, value in values.items()}
    return {n: array.reshape(*sizes.values(), *array.shape[1:]) for n, array in arrays.items()}


def _parameters(fitted: _FittedTrials, settings: BoundSettings) -> dict[str, float]:
    ends = (math.nan, math.nan)
    errors, log_errors, bounds = np.full(2, np.nan), np.full(2, np.nan), np.full((2, 2), np.nan)
    if fitted.gap is not None:
        # the likelihood increases as the dispersion decreases; all medians between the ends are
        # equally likely
        ends = fitted.gap
        log_median, spread = 0.5 * sum(ends), 0.0
    else:
        (log_median, log_spread), covariance = _log_parameters(fitted.fit)
        spread, log_errors = _exponential(log_spread), np.sqrt(np.diag(covariance))
        errors = log_errors * np.array([1.0, spread])
    if fitted.boundary is not None:
        bounds = _parameter_ranges(fitted.boundary)
    elif fitted.has_bounds:
        clusters = fitted.fit.clusters
        # a dispersion is positive: the interval is that of its logarithm
        middle = np.array([log_median, math.log(spread) + _log_dispersion_bias(clusters)])
        half_width: Array = settings.standard_errors(clusters) * log_errors
        bounds = middle[:, None] + half_width[:, None] * np.array([-1.0, 1.0])
        bounds[1] = [_exponential(bound) for bound in bounds[1]]
    return {
        "median_intensity": _exponential(log_median),
        "median_intensity_lower_bound": _exponential(bounds[0, 0]),
        "median_intensity_upper_bound": _exponential(bounds[0, 1]),
        "separation_lower_intensity": _exponential(ends[0]),
        "separation_upper_intensity": _exponential(ends[1]),
        "log_median_error": float(errors[0]),
        "dispersion": spread,
        "dispersion_lower_bound": float(bounds[1, 0]),
        "dispersion_upper_bound": float(bounds[1, 1]),
        "dispersion_error": float(errors[1]),
    }


def _exponential(log: float) -> float:
    """Return the exponential of a logarithm: infinite where the intensity hardly matters."""
    with np.errstate(over="ignore"):
        return float(np.exp(log))


def _log_parameters(fit: Fit) -> tuple[Array, Array]:
    """Return the logarithms of median and dispersion, and their covariance."""
    best = _log_median_dispersion(fit.coefficients)
    if fit.leave_one_out is not None and fit.complete:
        rows, multiplicity = fit.leave_one_out
        return best, jackknife(best, _log_median_dispersion(rows.T).T, multiplicity)
    intercept, slope = (float(coefficient) for coefficient in fit.coefficients)
    jacobian = np.array([[-1.0 / slope, intercept / slope**2], [0.0, -1.0 / slope]])
    return best, jacobian @ fit.covariance @ jacobian.T


def _log_median_dispersion(coefficients: Array) -> Array:
    intercept, slope = coefficients
    with np.errstate(invalid="ignore"):
        return np.stack([-intercept / slope, -np.log(slope)])


def _log_dispersion_bias(clusters: float) -> float:
    """Return the bias of the logarithm of a dispersion, :eq:`eq-fragility-dispersion-bias` [1]."""
    from scipy.special import digamma

    if math.isinf(clusters):
        return 0.0
    return 0.5 * (math.log(0.5 * clusters) - float(digamma(0.5 * (clusters - 1.0))))


def _parameter_ranges(boundary_points: Array) -> Array:
    """Return the ranges of log-median and dispersion in a region of the coefficients."""
    intercept, slope = boundary_points
    least = 0.0 if slope.max() > _STEEPEST_SLOPE else 1.0 / slope.max()
    if slope.min() <= 0.0:  # a curve that does not rise is likely enough, too
        return np.array([[-np.inf, np.inf], [least, np.inf]])
    medians = -intercept / slope
    return np.array([[medians.min(), medians.max()], [least, 1.0 / slope.min()]])


def _with_curves(
    dataset: xr.Dataset,
    every: Sequence[_FittedTrials],
    sizes: Mapping[str, int],
    measures: Sequence[MeasureLabel],
    settings: BoundSettings,
) -> xr.Dataset:
    """Add exceedance probabilities over the intensity, or over two of them."""
    from scipy.special import ndtr

    count = _CURVE_POINTS if len(measures) == 1 else _SURFACE_POINTS
    grids = {name: _intensity_grid(every, k, count) for k, (name, _) in enumerate(measures)}
    mesh = np.meshgrid(*grids.values(), indexing="ij")
    rows = np.stack([np.ones(mesh[0].size), *(np.log(intensity).ravel() for intensity in mesh)])
    shares = ndtr(np.stack([_eta(fitted, rows, settings) for fitted in every]))
    shares = shares.reshape(len(every), 3, *mesh[0].shape)
    values = {f"exceedance_probability{end}": shares[:, k] for k, end in enumerate(BOUND_SUFFIXES)}
    dataset = with_variables(dataset, _reshaped(values, sizes), over=(*sizes, *grids))
    return with_labels(dataset, {name: (name, grids[name], about) for name, about in measures})


def _eta(fitted: _FittedTrials, rows: Array, settings: BoundSettings) -> Array:
    """Return eta and its bounds where coefficients multiply `rows`; shape (3, intensities)."""
    if fitted.gap is not None:
        eta = np.where(rows[1] < 0.5 * sum(fitted.gap), -np.inf, np.inf)
    else:
        eta = fitted.fit.coefficients @ rows
    if fitted.boundary is not None:
        at = fitted.boundary.T @ rows
        return np.stack([eta, at.min(axis=0), at.max(axis=0)])
    half_width = np.full(len(eta), np.nan)
    if fitted.has_bounds:
        squares = np.einsum("ik,ij,jk->k", rows, fitted.fit.covariance, rows)
        half_width = settings.standard_errors(fitted.fit.clusters) * np.sqrt(squares)
    return np.stack([eta, eta - half_width, eta + half_width])


def with_stripes(
    dataset: xr.Dataset,
    counted: Sequence[tuple[Array, Array]],
    sizes: Mapping[str, int],
    confidence: float,
    measure: Mapping[str, Any],
) -> xr.Dataset:
    """Add the number of exceedances by groups of intensities, with Clopper-Pearson bounds.

    All intensities of the dataset get the unit among the attributes of their `measure`.
    """
    every = np.concatenate([columns[:, 0] for columns, _ in counted])
    every = np.unique(np.round(np.log(every[np.isfinite(every) & (every > 0.0)]), 9))
    if len(every) > _MAX_STRIPES:
        cuts = np.quantile(every, np.linspace(0.0, 1.0, _BINS + 1))
        middles = 0.5 * (cuts[1:] + cuts[:-1])
    else:
        middles = every
        cuts = np.concatenate([every, [np.inf]])
    cuts = cuts - 1e-8  # an intensity at a cut belongs above it, in spite of rounding
    size = len(middles)
    count, exceeded = np.zeros((2, len(counted), size), dtype=np.int64)
    for row, (columns, verdict) in enumerate(counted):
        is_valid = ~np.isnan(verdict) & (columns[:, 0] > 0.0) & np.isfinite(columns[:, 0])
        place = np.searchsorted(cuts, np.log(columns[is_valid, 0]), side="right") - 1
        place = np.clip(place, 0, max(size - 1, 0))
        count[row] = np.bincount(place, minlength=size)
        exceeded[row] = np.bincount(place, weights=verdict[is_valid], minlength=size)
    lower, upper = clopper_pearson(exceeded, count, confidence)
    with np.errstate(invalid="ignore"):
        fraction = exceeded / count
    values = {
        "stripe_trials": count,
        "stripe_exceedances": exceeded,
        "stripe_fraction": fraction,
        "stripe_fraction_lower_bound": lower,
        "stripe_fraction_upper_bound": upper,
    }
    dataset = with_variables(dataset, _reshaped(values, sizes), over=tuple(sizes))
    dataset = with_variables(dataset, {"stripe_intensity": np.exp(middles)})
    for name in _INTENSITY_VARIABLES:
        if name in dataset:
            dataset[name].attrs["units"] = unit_of(measure)
    return dataset


def _capacity_verdicts(trials: Sequence[Trials]) -> list[tuple[Array, Array]]:
    """Return verdicts on capacities at intensities that divide them into equal groups."""
    ends = np.concatenate([np.where(c.has_upper, c.upper[:, 0], c.lower[:, 0]) for c in trials])
    if not len(ends):
        return [(np.empty((0, 1)), np.empty(0)) for _ in trials]
    levels = np.unique(np.quantile(ends, np.linspace(0.05, 0.95, _BINS), method="nearest"))
    verdicts: list[tuple[Array, Array]] = []
    for capacities in trials:
        over = capacities.has_upper[:, None] & (capacities.upper[:, :1] <= levels)
        under = capacities.has_lower[:, None] & (capacities.lower[:, :1] >= levels)
        verdict = np.where(over, 1.0, np.where(under, 0.0, np.nan))
        columns = np.exp(np.broadcast_to(levels, verdict.shape))
        verdicts.append((columns.ravel()[:, None], verdict.ravel()))
    return verdicts


def _intensity_grid(every: Sequence[_FittedTrials], measure: int, count: int) -> Array:
    """Return intensities from the least to the greatest, with equal ratios."""
    ends = np.concatenate([fitted.trials.known_ends()[:, 1 + measure] for fitted in every])
    least, most = (float(ends.min()), float(ends.max())) if len(ends) else (-1.0, 1.0)
    reach = 0.0 if most > least else 1.0
    return np.exp(np.linspace(least - reach, most + reach, count))
