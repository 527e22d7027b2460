"""Cloud analysis: a straight line in logarithms, runs that overturn being treated separately."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np
import xarray as xr

from rockframe.arguments import checked_integer, checked_list
from rockframe.errors import StudyError
from rockframe.results.outcome import overturns
from rockframe.results.schema import build_dataset, with_labels, with_variables
from rockframe.results.variables.analyses import FragilityStatus
from rockframe.results.variables.studies import MOTION
from rockframe.results.variables.variable import unit_of, unit_suffix_of
from rockframe.signals.arrays import AnyArray, Array
from rockframe.studies.confidence import normal_scores, read_level
from rockframe.studies.fragility.labelling import BOUND_SUFFIXES, with_stripes
from rockframe.studies.fragility.likelihood import SAME_INTENSITY
from rockframe.studies.fragility.trials import (
    attributes_of_system,
    check_one_structure,
    flatten_like,
    motion_numbers,
)
from rockframe.studies.fragility.words import POOLED_ATTRIBUTE
from rockframe.studies.intensities import (
    PERIOD_ATTRIBUTE,
    PeriodLike,
    measure_of_runs,
    measure_words,
    period_attribute,
)
from rockframe.studies.limit_states import (
    OVERTURNING,
    check_runs,
    listed_limits,
    read_in_unit,
    scalar_of,
)
from rockframe.studies.logistic import Logistic, fit_logistic
from rockframe.studies.sweeps.motions import MotionsLike
from rockframe.suggestions import with_hints
from rockframe.units import POSITIVE, RatioLike

_OWNER: Final = "cloud_analysis"
_MIN_RUNS: Final = 4
"""Least number of runs in a regression, so that its dispersion can be estimated."""
_CURVE_POINTS: Final = 101
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


_NO_LINE: Final = Regression(
    math.nan, math.nan, math.nan, math.nan, np.full((2, 2), math.nan), 0, np.empty(0)
)


@dataclass(frozen=True, eq=False)
class Cloud:
    """Runs, each under one motion, and the line and logistic curves fitted to them."""

    logs: Array  # of the intensity
    responses: Array  # infinite where the block overturned, zero where it stayed at rest
    regression: Regression | None  # of the runs in between; None if these are too few
    overturning: Logistic
    moving: Logistic  # of runs that did not overturn: whether anything moved

    @classmethod
    def fit(cls, logs: Array, responses: Array) -> "Cloud":
        """Fit a line, and logistic curves for overturning and for staying at rest."""
        overturned, moved = np.isinf(responses), responses > 0.0
        between = moved & ~overturned
        enough = between.sum() >= _MIN_RUNS and np.ptp(logs[between]) > SAME_INTENSITY
        regression = Regression.fit(logs[between], np.log(responses[between])) if enough else None
        return cls(
            logs,
            responses,
            regression,
            fit_logistic(logs, overturned),
            fit_logistic(logs[~overturned], moved[~overturned]),
        )

    @property
    def is_regressed(self) -> AnyArray:
        """Which runs moved and did not overturn."""
        return (self.responses > 0.0) & np.isfinite(self.responses)

    def log_likelihoods(self) -> Array:
        """Return the logarithm of the likelihood of each run, :eq:`eq-cloud-likelihood`."""
        if self.regression is None:
            return np.full(len(self.logs), np.nan)
        overturning = self.overturning.probability(self.logs)
        moving = self.moving.probability(self.logs)
        overturned, dispersion = np.isinf(self.responses), self.regression.dispersion
        found = np.where(
            overturned,
            np.log(np.maximum(overturning, 1e-300)),
            np.log1p(-np.minimum(overturning, 1.0 - 1e-16)),
        )
        probability = np.where(self.responses > 0.0, moving, 1.0 - moving)
        found[~overturned] += np.log(np.maximum(probability[~overturned], 1e-300))
        normalized = self.regression.residuals / dispersion
        found[self.is_regressed] += -0.5 * (normalized**2 + math.log(2.0 * math.pi)) - math.log(
            dispersion
        )
        return found

    def probabilities(self, logs: Array, level: float) -> Array:
        """Return the probability that a level is exceeded, :eq:`eq-cloud-fragility`."""
        overturning, line = self.overturning.probability(logs), self.regression or _NO_LINE
        if math.isinf(level):
            return overturning
        coefficients = line.intercept, line.slope, line.dispersion
        moving = self.moving.probability(logs)
        return _exceedance_probability(overturning, moving, coefficients, logs, level)

    def draw_curves(self, logs: Array, level: float, rng: np.random.Generator, count: int) -> Array:
        """Draw fragility curves from the posterior; shape (count, intensities)."""
        overturning = self.overturning.draw_curves(logs, rng, count)
        if self.regression is None or math.isinf(level):
            return overturning
        moving = self.moving.draw_curves(logs, rng, count)
        coefficients = [one[:, None] for one in self.regression.draw_coefficients(rng, count)]
        return _exceedance_probability(overturning, moving, coefficients, logs, level)


def _exceedance_probability(
    overturning: Array, moving: Array, coefficients: Sequence[Any], logs: Array, level: float
) -> Array:
    """Return the probability beyond a level: of overturning, of moving, and by the line."""
    from scipy.special import ndtr

    intercept, slope, dispersion = coefficients
    regressed = np.asarray(ndtr((intercept + slope * logs - math.log(level)) / dispersion))
    return overturning + (1.0 - overturning) * moving * regressed


@with_hints()
def cloud_analysis(
    runs: xr.Dataset,
    intensity: str | xr.DataArray = "PGA",
    *,
    response: str = "peak_relative_rotation",
    label: str | None = None,
    limits: Iterable[Any] = (0.1, 0.5),
    least: Any = None,
    period: PeriodLike | None = None,
    motions: MotionsLike | None = None,
    pooled: Iterable[str] = (),
    confidence: RatioLike = 0.95,
    seed: int = 0,
) -> xr.Dataset:
    """Fit a line to responses under many motions, each at one scale, and give the fragility.

    Parameters
    ----------
    runs : xarray.Dataset
        Result of a sweep over many motions, usually as they were recorded.
    intensity : str or DataArray, optional
        Measure, as for :func:`rockframe.fragility`.
    response : str, optional
        The scalar of the runs that is the response.
    label : str, optional
        Point, body or restrainer whose response is used, if there are several.
    limits : iterable, optional
        Levels of the response, with a unit if it has one: limit states in addition to overturning.
    least : float, str or Quantity, optional
        Response below which a run counts as one in which nothing moved, with a unit if it has one.
        The default is zero.
    period : str or Quantity, or several, optional
        Period of a spectral intensity [s].
    motions : GroundMotion, or sequence or mapping of them, optional
        The records; required if neither the dataset nor this process has them.
    pooled : iterable of str, optional
        Axes whose values are treated as one structure, as for :func:`rockframe.fragility`.
    confidence : float, optional
        Confidence level of all bounds [1].
    seed : int, optional
        Seed of the random numbers for the bounds.

    Returns
    -------
    xarray.Dataset
        ``regression_intercept``, ``regression_slope``, ``residual_dispersion``, ``determination``
        of the runs that moved and did not overturn; ``logistic_intercept`` and ``logistic_slope``
        of overturning. Over ``limit_state``: ``median_intensity``, ``dispersion`` and
        ``exceedance_probability``, with bounds, as for a fragility. Over ``run``:
        ``cloud_intensity`` and ``cloud_response``, infinite where a run overturned. The attribute
        ``verdict`` is a summary in words.

    Raises
    ------
    ComponentError, UnitsError
        An argument is out of range, has a wrong unit, or names an unknown measure or scalar.
    SchemaError
        Not the result of a sweep.
    StudyError
        The runs are of several structures that are not `pooled`, or they have no verdicts.

    Notes
    -----
    This is the modified cloud analysis of Jalayer et al. (2017). For runs that do not overturn, the
    logarithm of the response is normally distributed about a straight line in the logarithm of the
    intensity, :eq:`eq-cloud-line`; overturning is logistic, :eq:`eq-cloud-fragility`. The response
    of a block that stays at rest on rigid ground has no logarithm, and that of a block that hardly
    rises is not informative, so `least` should be given; the probability that a standing block has
    moved is logistic too. If the intensity separates the two kinds of runs without overlap, the
    probability is a step in the middle of the gap. The median is the intensity at which the
    probability is one half, and the dispersion is half the logarithm of the ratio of the
    intensities at 84 and 16 %. If no run overturns or rests, the curve is lognormal, and both are
    its parameters.

    Bounds are quantiles of curves whose coefficients are drawn from their posterior distribution
    (the robust fragility of Jalayer et al., 2015), :eq:`eq-cloud-posterior`. If motions were run
    more than once, the runs are dependent and there are no bounds.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    >>> motions = [rf.GroundMotion.stochastic(6.5, f"{d} km", seed=d) for d in range(2, 22)]
    >>> runs = rf.sweep(system, motions, accuracy="fast", progress=False)
    >>> found = rf.cloud_analysis(runs, "PGV", limits=[0.2])
    >>> found.limit_state.values.tolist()
    ['peak relative rotation 0.2', 'overturning']
    """
    runs = check_runs(runs, owner=_OWNER)
    level = read_level(confidence, owner=_OWNER)
    seed = checked_integer(seed, owner=_OWNER, name="seed", lowest=0)
    pooled_axes = checked_list(pooled, owner=_OWNER, name="pooled", of="names")
    check_one_structure(runs, pooled_axes, [intensity], owner=_OWNER)
    measure = measure_of_runs(runs, intensity, period, motions, owner=_OWNER)
    values = scalar_of(runs, response, label, owner=_OWNER)
    levels = listed_limits(limits, owner=_OWNER)
    requested = [_read_level(one, values, _OWNER, "limits") for one in levels if one != OVERTURNING]
    found = fit_cloud(runs, measure, values, least=least, owner=_OWNER)
    words = " ".join(filter(None, [response.replace("_", " "), label]))
    named = {f"{words} {one:g}{unit_suffix_of(values.attrs)}": one for one in requested}
    dataset = _cloud_dataset(found, named | {OVERTURNING: math.inf}, measure, level, seed)
    for one in ("cloud_response", "response_limit"):
        dataset[one].attrs["units"] = unit_of(values.attrs)
    dataset.attrs |= {
        **attributes_of_system(runs),
        **period_attribute(runs, [intensity], period, owner=_OWNER),
        "intensity": str(measure.name),
        "response": response if label is None else f"{response} {label}",
        **({POOLED_ATTRIBUTE: ", ".join(pooled_axes)} if pooled_axes else {}),
    }
    return dataset.assign_attrs(verdict=_sentence(dataset, found.motions_repeat))


class CloudFit(NamedTuple):
    """A cloud, and the runs that are in it."""

    cloud: Cloud
    included: AnyArray  # whether each run is in it, in the order of the dimensions
    motions_repeat: bool  # whether motions were run more than once


def fit_cloud(
    runs: xr.Dataset, measure: xr.DataArray, values: xr.DataArray, *, least: Any, owner: str
) -> CloudFit:
    """Fit a cloud to the runs that have a verdict, an intensity and a response."""
    floor = 0.0 if least is None else _read_level(least, values, owner, "least")
    if MOTION not in runs.coords:
        msg = f"{owner}: found runs without motions; expected those of many motions"
        raise StudyError(msg)
    intensities, response, overturned = (
        flatten_like(one, runs["status"]).astype(np.float64)
        for one in (measure, values, overturns(runs))
    )
    response = np.abs(response)
    response = np.where(overturned == 1.0, np.inf, np.where(response < floor, 0.0, response))
    known = (
        ~np.isnan(overturned) & (intensities > 0.0) & np.isfinite(intensities) & ~np.isnan(response)
    )
    if known.sum() < _MIN_RUNS:
        count = int(known.sum())
        msg = (
            f"{owner}: {count} run{'s have' if count != 1 else ' has'} a verdict and an intensity; "
            f"{_MIN_RUNS} are needed"
        )
        raise StudyError(msg)
    used = motion_numbers(overturns(runs))[known]
    cloud = Cloud.fit(np.log(intensities[known]), response[known])
    return CloudFit(cloud, known, len(np.unique(used)) < len(used))


def _read_level(value: Any, values: xr.DataArray, owner: str, name: str) -> float:
    unit, words = unit_of(values.attrs), f"a value of {values.name}"
    return read_in_unit(value, unit, words, owner=owner, name=name, condition=POSITIVE)


def _curve(
    cloud: Cloud, level: float, logs: Array, confidence: float, seed: int
) -> tuple[FragilityStatus, Array, Array, Array]:
    """Return status, probabilities at some intensities, median and dispersion of a level.

    Each with its bounds, NaN where confidence is.
    """
    status = _status(cloud, level)
    wide = np.linspace(
        cloud.logs.min() - _SEARCH_MARGIN, cloud.logs.max() + _SEARCH_MARGIN, _SEARCH_POINTS
    )
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
        each = _median_dispersion(drawn[:, len(logs) :], wide)
        # a median beyond the searched range is infinite, or zero where all of the curve lies above
        every = [np.where(np.isnan(one), np.inf, one) for one in each]
        every[0][np.all(drawn[:, len(logs) :] >= 0.5, axis=1)] = -np.inf
        medians[1:] = np.exp(np.quantile(every[0], tails, method="inverted_cdf"))
        spreads[1:] = np.quantile(every[1], tails, method="inverted_cdf")
    return status, points, medians, spreads


def _status(cloud: Cloud, level: float) -> FragilityStatus:
    """Return whether a limit state has a fragility, or why not."""
    if math.isinf(level):
        rises = cloud.overturning.status is not FragilityStatus.FITTED
        rises = rises or cloud.overturning.coefficients[1] > 0.0
        return cloud.overturning.status if rises else FragilityStatus.NOT_RISING
    if cloud.regression is None:
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
    found = above.any(axis=1) & (right > 0)
    right = np.maximum(right, 1)
    rows = np.arange(len(eta))
    low, high = eta[rows, right - 1], eta[rows, right]
    with np.errstate(invalid="ignore", divide="ignore"):
        at = logs[right - 1] + (level - low) / (high - low) * (logs[right] - logs[right - 1])
    return np.where(found, at, np.nan)


def _cloud_dataset(
    runs: CloudFit, levels: Mapping[str, float], measure: xr.DataArray, confidence: float, seed: int
) -> xr.Dataset:
    """Label a cloud and its fragility against levels of the response, by their names."""
    cloud, of_bounds = runs.cloud, math.nan if runs.motions_repeat else confidence
    logs = np.linspace(cloud.logs.min(), cloud.logs.max(), _CURVE_POINTS)
    curves = [_curve(cloud, level, logs, of_bounds, seed) for level in levels.values()]
    name, over = str(measure.name), {"limit_state": len(levels)}
    line, logistic = cloud.regression or _NO_LINE, cloud.overturning
    found = build_dataset(
        {
            "regression_intercept": line.intercept,
            "regression_slope": line.slope,
            "regression_slope_error": math.sqrt(line.covariance[1, 1]),
            "residual_dispersion": line.dispersion,
            "determination": line.determination,
            "logistic_intercept": logistic.coefficients[0],
            "logistic_slope": logistic.coefficients[1],
            "logistic_slope_error": math.sqrt(logistic.covariance[1, 1]),
            "cloud_overturned_count": np.isinf(cloud.responses).sum(),
            "resting_count": (cloud.responses == 0.0).sum(),
            "cloud_intensity": np.exp(cloud.logs),
            "cloud_response": cloud.responses,
        },
        {"bands": "posterior", "trials": "cloud", "confidence": confidence},
        title="Cloud analysis", source="least squares and logistic regression",
    )  # fmt: skip
    status, *of_curves = zip(*curves, strict=True)
    points, medians, spreads = map(np.stack, of_curves)
    of_states = {"fragility_status": np.array(status),
                 "response_limit": np.array([*levels.values()])}  # fmt: skip
    for k, end in enumerate(BOUND_SUFFIXES):
        of_states[f"median_intensity{end}"] = medians[:, k]
        of_states[f"dispersion{end}"] = spreads[:, k]
    of_states["trial_count"] = np.full(len(levels), len(cloud.logs))
    of_states["left_out_count"] = np.full(len(levels), int((~runs.included).sum()))
    found = with_variables(found, of_states, over=tuple(over))
    shares = {f"exceedance_probability{end}": points[:, k] for k, end in enumerate(BOUND_SUFFIXES)}
    found = with_variables(found, shares, over=(*over, name))
    found = with_labels(found, {name: (name, np.exp(logs), measure.attrs)})
    found = with_variables(found, {"limit_state": np.array(list(levels), dtype=object)})
    counted = [
        (np.exp(cloud.logs)[:, None], (cloud.responses >= level).astype(np.float64))
        for level in levels.values()
    ]
    return with_stripes(found, counted, over, confidence, measure.attrs)


def _sentence(found: xr.Dataset, motions_repeat: bool) -> str:
    """Return the verdict in words: the line, and how many runs overturned."""
    words = measure_words(str(found.attrs["intensity"]), found.attrs.get(PERIOD_ATTRIBUTE))
    count, overturned = found.sizes["run"], int(found["cloud_overturned_count"])
    resting = int(found["resting_count"])
    response = str(found.attrs["response"]).replace("_", " ")
    text = f"Of {count} runs {overturned} overturned"
    text += f" and {resting} show no {response}" if resting else ""
    if math.isnan(float(found["regression_slope"])):
        text += "; those between are too few, or of one intensity, for a line"
    else:
        text += (
            f"; the {response} of the others grows with "
            f"power {float(found['regression_slope']):.3g} of {words}, dispersion "
            f"{float(found['residual_dispersion']):.3g}"
        )
    left_out = int(found["left_out_count"].max())
    text += f"; {left_out} are left out, without a verdict or an intensity" if left_out else ""
    text += "; no bounds, for motions were run more than once" if motions_repeat else ""
    return f"{text}."
