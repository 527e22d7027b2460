"""Cloud analysis: a straight line in logarithms, runs that overturn being treated separately."""

import math
from collections.abc import Iterable, Mapping
from typing import Any, Final, NamedTuple

import numpy as np
import xarray as xr

from rockframe.arguments import checked_integer
from rockframe.errors import StudyError
from rockframe.results.outcome import overturns
from rockframe.results.schema import build_dataset, with_labels, with_variables
from rockframe.results.variables.studies import MOTION
from rockframe.results.variables.variable import unit_of, unit_suffix_of
from rockframe.signals.arrays import AnyArray
from rockframe.studies.cloud_fit import MIN_RUNS, Cloud, curve_of_level
from rockframe.studies.confidence import BOUND_SUFFIXES, read_confidence
from rockframe.studies.fragility.labelling import with_stripes
from rockframe.studies.fragility.trials import (
    attributes_of_system,
    check_one_structure,
    flatten_like,
    motion_numbers,
)
from rockframe.studies.fragility.words import pooled_attribute
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
from rockframe.studies.sweeps.motions import MotionsLike
from rockframe.suggestions import with_hints
from rockframe.units import POSITIVE, RatioLike

_OWNER: Final = "cloud_analysis"
_REFERENCES: Final = "Jalayer et al. (2017), Earthquake Engng. Struct. Dyn. 46, 2639-2663"
_CURVE_POINTS: Final = 101


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
    nominal = read_confidence(confidence, owner=_OWNER)
    seed = checked_integer(seed, owner=_OWNER, name="seed", lowest=0)
    pooled_axes = check_one_structure(runs, pooled, [intensity], owner=_OWNER)
    measure = measure_of_runs(runs, intensity, period, motions, owner=_OWNER)
    values = scalar_of(runs, response, label, owner=_OWNER)
    listed = [limit for limit in listed_limits(limits, owner=_OWNER) if limit != OVERTURNING]
    requested = [_read_response(limit, values, _OWNER, "limits") for limit in listed]
    cloud = fit_cloud(runs, measure, values, least=least, owner=_OWNER)
    words = " ".join(filter(None, [response.replace("_", " "), label]))
    named = {f"{words} {value:g}{unit_suffix_of(values.attrs)}": value for value in requested}
    levels = named | {OVERTURNING: math.inf}
    dataset = _cloud_dataset(cloud, levels, measure, nominal, seed)
    for name in ("cloud_response", "response_limit"):
        dataset[name].attrs["units"] = unit_of(values.attrs)
    dataset.attrs |= {
        **attributes_of_system(runs),
        **period_attribute(runs, [intensity], period, owner=_OWNER),
        "intensity": str(measure.name),
        "response": response if label is None else f"{response} {label}",
        **pooled_attribute(pooled_axes),
    }
    return dataset.assign_attrs(verdict=_sentence(dataset, cloud.motions_repeat))


class CloudFit(NamedTuple):
    """A cloud, and the runs that are in it."""

    cloud: Cloud
    included: AnyArray  # whether each run is in it, in the order of the dimensions
    motions_repeat: bool  # whether motions were run more than once


def fit_cloud(
    runs: xr.Dataset, measure: xr.DataArray, values: xr.DataArray, *, least: Any, owner: str
) -> CloudFit:
    """Fit a cloud to the runs that have a verdict, an intensity and a response."""
    floor = 0.0 if least is None else _read_response(least, values, owner, "least")
    if MOTION not in runs.coords:
        msg = f"{owner}: found runs without motions; expected those of many motions"
        raise StudyError(msg)
    intensities, response, overturned = (
        flatten_like(array, runs["status"]).astype(np.float64)
        for array in (measure, values, overturns(runs))
    )
    response = np.abs(response)
    response = np.where(overturned == 1.0, np.inf, np.where(response < floor, 0.0, response))
    known = ~np.isnan(overturned) & ~np.isnan(response)
    known &= (intensities > 0.0) & np.isfinite(intensities)
    if (count := int(known.sum())) < MIN_RUNS:
        have = "1 run has" if count == 1 else f"{count} runs have"
        msg = f"{owner}: {have} a verdict and an intensity; {MIN_RUNS} are needed"
        raise StudyError(msg)
    used = motion_numbers(overturns(runs))[known]
    cloud = Cloud.fit(np.log(intensities[known]), response[known])
    return CloudFit(cloud, known, len(np.unique(used)) < len(used))


def _read_response(value: Any, values: xr.DataArray, owner: str, name: str) -> float:
    unit, words = unit_of(values.attrs), f"a value of {values.name}"
    return read_in_unit(value, unit, words, owner=owner, name=name, condition=POSITIVE)


def _cloud_dataset(
    runs: CloudFit, levels: Mapping[str, float], measure: xr.DataArray, confidence: float, seed: int
) -> xr.Dataset:
    """Label a cloud and its fragility against levels of the response, by their names."""
    cloud, of_bounds = runs.cloud, math.nan if runs.motions_repeat else confidence
    logs = np.linspace(cloud.logs.min(), cloud.logs.max(), _CURVE_POINTS)
    curves = [curve_of_level(cloud, level, logs, of_bounds, seed) for level in levels.values()]
    name, over = str(measure.name), {"limit_state": len(levels)}
    line, logistic = cloud.regression, cloud.overturning
    dataset = build_dataset(
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
        {"bands": "posterior", "trials": "cloud", "confidence": confidence,
         "references": _REFERENCES},
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
    dataset = with_variables(dataset, of_states, over=tuple(over))
    shares = {f"exceedance_probability{end}": points[:, k] for k, end in enumerate(BOUND_SUFFIXES)}
    dataset = with_variables(dataset, shares, over=(*over, name))
    dataset = with_labels(dataset, {name: (name, np.exp(logs), measure.attrs)})
    dataset = with_variables(dataset, {"limit_state": np.array(list(levels), dtype=object)})
    beyond = [(cloud.responses >= level).astype(np.float64) for level in levels.values()]
    counted = [(np.exp(cloud.logs)[:, None], verdict) for verdict in beyond]
    return with_stripes(dataset, counted, over, confidence, measure.attrs)


def _sentence(dataset: xr.Dataset, motions_repeat: bool) -> str:
    """Return the verdict in words: the line, and how many runs overturned."""
    words = measure_words(str(dataset.attrs["intensity"]), dataset.attrs.get(PERIOD_ATTRIBUTE))
    count, overturned = dataset.sizes["run"], int(dataset["cloud_overturned_count"])
    resting = int(dataset["resting_count"])
    response = str(dataset.attrs["response"]).replace("_", " ")
    text = f"Of {count} runs {overturned} overturned"
    text += f" and {resting} show no {response}" if resting else ""
    slope, dispersion = float(dataset["regression_slope"]), float(dataset["residual_dispersion"])
    if math.isnan(slope):
        text += "; those between are too few, or of one intensity, for a line"
    else:
        verb = "grows" if slope > 0.0 else "falls"
        text += f"; the {response} of the others {verb} with power {abs(slope):.3g} of {words}, "
        text += f"dispersion {dispersion:.3g}"
    left_out = int(dataset["left_out_count"].max())
    text += f"; {left_out} are left out, without a verdict or an intensity" if left_out else ""
    text += "; no bounds, for motions were run more than once" if motions_repeat else ""
    return f"{text}."
