"""Comparison of intensity measures: efficiency, sufficiency, relative sufficiency."""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final, cast

import numpy as np
import pandas as pd
import xarray as xr

from rockframe.arguments import checked_list
from rockframe.errors import ComponentError, StudyError, short_repr
from rockframe.results.schema import build_dataset, with_variables
from rockframe.results.variables.studies import MOTION
from rockframe.signals.arrays import Array
from rockframe.studies.cloud import CloudFit, fit_cloud
from rockframe.studies.cloud_fit import NO_LINE, Cloud
from rockframe.studies.fragility.trials import check_one_structure, flatten_like
from rockframe.studies.intensities import (
    PERIOD_ATTRIBUTE,
    PeriodLike,
    aligned_with_runs,
    column_of_runs,
    measure_of_runs,
    measure_words,
    period_attribute,
)
from rockframe.studies.limit_states import check_runs, scalar_of
from rockframe.studies.sweeps.labelling import cautions_attribute
from rockframe.studies.sweeps.motions import MotionsLike
from rockframe.suggestions import with_hints

_OWNER: Final = "compare_intensities"
_REFERENCES: Final = (
    "Luco and Cornell (2007), Earthquake Spectra 23, 357-392; Jalayer et al. (2012), J. Eng. Mech. "
    "138, 307-316"
)
_SIGNIFICANCE: Final = 0.05
"""p-value below which a slope of the residuals is reported as significant [1]."""
_ROUNDING: Final = 1e-9
"""Relative difference of two ratios up to which they are equal [1]."""
Covariates = Mapping[str, Any]
"""Numbers of the motions by name: in order of motions, by their labels, or over ``motion``."""


@with_hints()
def compare_intensities(
    runs: xr.Dataset,
    measures: Iterable[str | tuple[str, PeriodLike] | xr.DataArray],
    *,
    response: str = "peak_relative_rotation",
    label: str | None = None,
    against: Sequence[str] | Covariates = (),
    least: Any = None,
    motions: MotionsLike | None = None,
    pooled: Iterable[str] = (),
) -> xr.Dataset:
    """Compare intensity measures by how well each predicts the response.

    Parameters
    ----------
    runs : xarray.Dataset
        Result of a sweep over many motions, usually as they were recorded.
    measures : iterable of str, (str, period) or DataArray
        As for :func:`rockframe.fragility`; spectral ones with their period, such as
        ``("SA", "1 s")``, or ``("Sa_avg", (numpy.linspace(0.5, 3, 26), "s"))``.
    response : str, optional
        The scalar of the runs that is the response.
    label : str, optional
        Point, body or restrainer whose response is used, if there are several.
    against : sequence of str, or mapping of str to values, optional
        Covariates on which the response should not depend for a given measure: names of coordinates
        of the runs; or a mapping of names to values for the motions, in the order of the motions,
        by their labels, such as columns of the table of a suite, or as a DataArray over ``motion``.
    least : float, str or Quantity, optional
        Response below which a run counts as one in which nothing moved. The default is zero.
    motions : GroundMotion, or sequence or mapping of them, optional
        The records; required if neither the dataset nor this process has them.
    pooled : iterable of str, optional
        As for :func:`rockframe.cloud_analysis`.

    Returns
    -------
    xarray.Dataset
        Over ``measure``: ``regression_slope``, ``residual_dispersion``, ``efficiency_ratio``,
        ``determination``, ``relative_sufficiency`` and its standard error; over ``covariate`` too
        ``sufficiency_slope`` and ``sufficiency_p_value``. Also the number of runs of each kind.
        :func:`rockframe.table` converts it to a table.

    Raises
    ------
    ComponentError, UnitsError
        An argument is out of range, or names an unknown measure, scalar or coordinate.
    SchemaError
        The dataset is not the result of a sweep.
    StudyError
        Too few runs lie between rest and overturning to fit a line, or they are of several
        structures that are not `pooled`.

    Notes
    -----
    Luco and Cornell (2007). The line is that of :func:`rockframe.cloud_analysis`. A measure is
    *efficient* if the ``residual_dispersion`` is small; to compare measures with different powers,
    use the ``efficiency_ratio``, the dispersion of the intensity at a response (Padgett et al.,
    2008). It is *sufficient* if the residuals do not depend on magnitude or distance: the
    ``sufficiency_p_value`` is that of the slope of a straight line through the residuals over the
    covariate as given (for a distance, give its logarithm). A small value is evidence against the
    measure; a large one means little if there are few runs. The relative sufficiency (Jalayer et
    al., 2012), :eq:`eq-relative-sufficiency`, is the mean information in bits about the response of
    a run, overturning and rest included, that a measure provides beyond the first measure.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.3 m", height="1.5 m", mass="200 kg"))
    >>> distances = range(2, 22)
    >>> motions = [rf.GroundMotion.stochastic(7.0, f"{d} km", seed=d) for d in distances]
    >>> runs = rf.sweep(system, motions, accuracy="fast", progress=False)
    >>> found = rf.compare_intensities(
    ...     runs, ["PGA", "PGV"], against={"distance": list(distances)}, least=0.001
    ... )
    >>> dict(found.sufficiency_p_value.sizes)
    {'measure': 2, 'covariate': 1}
    """
    runs = check_runs(runs, owner=_OWNER)
    values = scalar_of(runs, response, label, owner=_OWNER)
    named, fits = list[str](), list[CloudFit]()
    given_measures = [measures] if isinstance(measures, xr.DataArray) else measures
    every = checked_list(given_measures, owner=_OWNER, name="measures", of="measures")
    listed = [_measure_and_period(item) for item in every]
    check_one_structure(runs, pooled, [given for given, _ in listed], owner=_OWNER)
    for given, period in listed:
        measure = measure_of_runs(runs, given, period, motions, owner=_OWNER)
        attributes = period_attribute(runs, [given], period, owner=_OWNER)
        fits.append(fit_cloud(runs, measure, values, least=least, owner=_OWNER))
        cloud = fits[-1].cloud
        if cloud.regression is NO_LINE:
            msg = (
                f"{_OWNER}: {cloud.is_regressed.sum()} of {len(cloud.responses)} runs have a "
                f"response and did not overturn, too few for a line over {measure.name}; give "
                "more motions, or others"
            )
            raise StudyError(msg)
        named.append(measure_words(str(measure.name), attributes.get(PERIOD_ATTRIBUTE)))
    if not fits or any(not np.array_equal(fits[0].included, fit.included) for fit in fits):
        msg = f"{_OWNER}: measures must be one or more, all known of the same runs, got {named}"
        raise ComponentError(msg)
    if len(set(named)) < len(named):
        msg = f"{_OWNER}: measures are named twice: {', '.join(named)}"
        raise ComponentError(msg)
    covariates: dict[str, Array] = {}
    for name, array in _read_covariates(runs, against).items():
        try:
            numbers = flatten_like(array, runs["status"]).astype(np.float64)
        except (TypeError, ValueError) as problem:
            msg = f"{_OWNER}: {name!r} has no numbers, but words or objects; it is no covariate"
            raise ComponentError(msg) from problem
        covariates[name] = numbers[fits[0].included]
    dataset = _comparison_dataset(named, [fit.cloud for fit in fits], covariates)
    words = response if label is None else f"{response} {label}"
    about = {"response": words, "verdict": _sentence(dataset), **cautions_attribute(runs)}
    return dataset.assign_attrs(about)


def _measure_and_period(value: object) -> tuple[Any, Any]:
    if isinstance(value, tuple):
        pair = cast("tuple[Any, ...]", value)
        if len(pair) == 2 and isinstance(pair[0], str):
            return pair[0], pair[1]
        msg = f"{_OWNER}: a measure with a period is ('SA', '1 s'), got {short_repr(value)}"
        raise ComponentError(msg)
    return value, None


def _read_covariates(
    runs: xr.Dataset, values: Sequence[str] | Covariates
) -> dict[str, xr.DataArray]:
    """Read what the response should not depend on: numbers of the motions by their names."""
    if isinstance(values, Mapping):
        given = {str(name): numbers for name, numbers in values.items()}
        return {name: _covariate_of_runs(runs, name, numbers) for name, numbers in given.items()}
    covariates: dict[str, xr.DataArray] = {}
    for name in checked_list(values, owner=_OWNER, name="against", of="names"):
        column = column_of_runs(runs, name)
        if not isinstance(column, xr.DataArray) or not set(column.dims) <= set(runs["status"].dims):
            msg = f"{_OWNER}: against names {short_repr(name)}, which is no coordinate of the runs"
            raise ComponentError(msg)
        covariates[str(name)] = column
    return covariates


def _covariate_of_runs(runs: xr.Dataset, name: str, value: Any) -> xr.DataArray:
    """Return the numbers of the motions to the runs."""
    if isinstance(value, xr.DataArray):
        return aligned_with_runs(runs, value.rename(name), "covariate", owner=_OWNER)
    labels = runs[MOTION].to_numpy().astype(str)
    if isinstance(value, Mapping | pd.Series):
        table = dict(cast("Any", value).items())
        missing = [str(label) for label in np.unique(labels) if label not in table]
        if missing:
            msg = f"{_OWNER}: against has no {name} of the motion {missing[0]!r}"
            raise ComponentError(msg)
        values = [table[str(label)] for label in labels.ravel()]
    else:
        values = checked_list(value, owner=_OWNER, name=f"against[{name!r}]", of="numbers")
        if runs[MOTION].dims != (MOTION,) or len(values) != labels.size:
            msg = (
                f"{_OWNER}: against has {len(values)} numbers of {name} for {labels.size} motions; "
                "give one for each of them, in their order, or by their labels"
            )
            raise ComponentError(msg)
    numbers = np.array(values).reshape(labels.shape)
    return xr.DataArray(numbers, dims=runs[MOTION].dims, coords=runs[MOTION].coords)


def _comparison_dataset(
    names_of_measures: Sequence[str], clouds: Sequence[Cloud], covariates: Mapping[str, Array]
) -> xr.Dataset:
    """Return a dataset of the results of all measures."""
    lines = [cloud.regression for cloud in clouds]
    log_likelihoods = np.stack([cloud.log_likelihoods() for cloud in clouds])
    information = (log_likelihoods - log_likelihoods[0]) / math.log(2.0)
    count = log_likelihoods.shape[1]
    values: dict[str, Any] = {
        "regression_slope": [line.slope for line in lines],
        "residual_dispersion": [line.dispersion for line in lines],
        "efficiency_ratio": [
            line.dispersion / line.slope if line.slope > 0.0 else np.inf for line in lines
        ],
        "determination": [line.determination for line in lines],
        "relative_sufficiency": information.mean(axis=1),
        "relative_sufficiency_error": information.std(axis=1, ddof=1) / math.sqrt(count),
        "line_count": [len(line.residuals) for line in lines],
        "cloud_overturned_count": [np.isinf(cloud.responses).sum() for cloud in clouds],
        "resting_count": [(cloud.responses == 0.0).sum() for cloud in clouds],
    }
    names = {"measure": np.array(list(names_of_measures), dtype=object)}
    if covariates:
        columns = covariates.values()
        tested = np.array([[_residual_trend(one, x) for x in columns] for one in clouds])
        values |= {"sufficiency_slope": tested[..., 0], "sufficiency_p_value": tested[..., 1]}
        names["covariate"] = np.array(list(covariates), dtype=object)
    dataset = build_dataset(
        {name: np.array(column) for name, column in values.items()},
        {"references": _REFERENCES}, over=("measure",),
        title="Comparison of intensity measures", source="least squares and logistic regression",
    )  # fmt: skip
    return with_variables(dataset, names)


def _residual_trend(cloud: Cloud, covariate: Array) -> tuple[float, float]:
    """Return the slope of the residuals over a covariate, and its p-value."""
    from scipy.stats import linregress

    values = covariate[cloud.is_regressed]
    known = np.isfinite(values)
    if known.sum() < 3 or np.ptp(values[known]) == 0.0:
        return math.nan, math.nan
    trend: Any = linregress(values[known], cloud.regression.residuals[known])
    return float(trend.slope), float(trend.pvalue)


def _sentence(dataset: xr.Dataset) -> str:
    """Return the verdict in words: the most efficient measure, and those not sufficient."""
    ratio = dataset["efficiency_ratio"]
    text = f"Of {dataset.sizes['measure']} measures "
    if np.isfinite(ratio).any():
        best = int(np.nanargmin(ratio.to_numpy()))
        words = f"{dataset['measure'][best].item()} is the most efficient"
        # as of runs under one motion at several scales, whose measures are proportional
        if ratio.size > 1 and bool((ratio <= ratio.min() * (1.0 + _ROUNDING)).all()):
            words = "all are equally efficient"
        text += f"{words}, with {float(ratio.min()):.3g} of dispersion over power"
    else:
        text += "none is efficient: the response grows with none of them"
    if "sufficiency_p_value" in dataset:
        p_value = dataset["sufficiency_p_value"]
        dependent = [
            f"{p_value['measure'][k].item()} with {p_value['covariate'][j].item()}"
            for k, j in np.argwhere(p_value.to_numpy() < _SIGNIFICANCE)
        ]
        named = ", ".join(dependent) or "none"
        text += f"; residuals go with a covariate (p < {_SIGNIFICANCE:g}): {named}"
    return f"{text}."
