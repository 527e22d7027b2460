"""Statistics of ensembles: how a result is distributed over motions or cases."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final, cast

import numpy as np
import xarray as xr

from rockframe.arguments import checked_dataset, checked_list
from rockframe.errors import ComponentError, SchemaError, did_you_mean, short_repr
from rockframe.results.schema import build_dataset
from rockframe.results.variables.studies import MOTION
from rockframe.signals.arrays import Array
from rockframe.studies.confidence import (
    BOUND_SUFFIXES,
    clopper_pearson,
    read_confidence,
    read_shares,
)
from rockframe.studies.fragility.trials import flatten_like
from rockframe.studies.probability import SAMPLING_ATTRIBUTE
from rockframe.studies.sweeps.labelling import cautions_attribute
from rockframe.suggestions import with_hints
from rockframe.units import RatioLike

_OWNER: Final = "ensemble_statistics"
_REFERENCES: Final = "Clopper and Pearson (1934), Biometrika 26, 404-413"


@with_hints()
def ensemble_statistics(
    runs: xr.Dataset | xr.DataArray,
    name: str = "peak_relative_rotation",
    *,
    quantiles: Sequence[RatioLike] = (0.16, 0.5, 0.84),
    pooled: Iterable[str] = (),
    confidence: RatioLike = 0.95,
) -> xr.Dataset:
    """Compute the empirical distribution of a result, with bands.

    Parameters
    ----------
    runs : xarray.Dataset or DataArray
        Result of a sweep over motions, or of drawn cases; first select a value along each further
        axis, or name the axes in `pooled`. Or values, such as measured ones, that form one
        ensemble.
    name : str, optional
        The variable whose distribution is computed.
    quantiles : sequence of float, optional
        Probabilities of the quantiles [1].
    pooled : iterable of str, optional
        Dimensions of a sweep other than its motions whose runs also belong to the ensemble.
    confidence : float, optional
        Confidence level of all bounds [1].

    Returns
    -------
    xarray.Dataset
        Over ``rank``: ``ordered_value``, ``cumulative_probability`` with pointwise bounds (Clopper
        and Pearson) and simultaneous bounds (``simultaneous``, Kolmogorov). Over ``quantile``:
        ``quantile_value``, with bounds by order statistics, infinite if the ensemble is too small.
        Bounds are NaN if several members are of one motion. The attribute ``verdict`` gives the
        numbers of members and of cases left out.

    Raises
    ------
    SchemaError
        The input is no dataset, or has no such variable.
    ComponentError
        An argument is out of range, there are no values, or the sweep has axes other than motions.

    Notes
    -----
    All bounds hold for any distribution if the members are independent. Cases without a result are
    left out and counted. Runs that stop at the overturning angle have a ``peak_relative_rotation``
    of 1, however large it would have become.

    A model that does not reproduce single tests may still reproduce their distribution (Bachmann et
    al., 2018); compare the bands of both.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.5 m", height="2 m", mass="400 kg"))
    >>> motions = [rf.GroundMotion.stochastic(6.5, "10 km", seed=k) for k in range(20)]
    >>> runs = rf.sweep(system, motions, scale=[3.0], accuracy="fast")
    >>> found = rf.ensemble_statistics(runs)
    >>> found.sizes["rank"]
    20
    """
    requested = read_confidence(confidence, owner=_OWNER)
    shares = read_shares(quantiles, "quantiles", owner=_OWNER)
    values = _values_of(runs, name)
    if values.dtype.kind not in "biuf":
        msg = f"{_OWNER}: {values.name!r} has no numbers, but words or objects"
        raise ComponentError(msg)
    pooled_axes = checked_list(pooled, owner=_OWNER, name="pooled", of="names")
    unknown = [name for name in pooled_axes if name not in {*values.dims, *values.coords}]
    if unknown:
        known = ", ".join(map(str, values.dims)) or "no dimension"
        msg = f"{_OWNER}: pooled names {unknown[0]!r}; {values.name} goes over {known}"
        raise ComponentError(msg)
    level = np.nan if _members_depend(values, runs.attrs, pooled_axes) else requested
    ordered = np.sort(values.to_numpy().ravel().astype(np.float64))
    ordered = ordered[~np.isnan(ordered)]
    if not len(ordered):
        msg = f"{_OWNER}: {values.name} has no values"
        raise ComponentError(msg)
    left_out = values.size - len(ordered)
    missing = f"; {left_out} without a result are left out" if left_out else ""
    bounds = f"bands of confidence {requested:g}"
    if np.isnan(level):
        bounds = "no bounds, for several members are of one motion"
    lower, upper = _quantile_bounds(ordered, shares, level)
    dataset = build_dataset(
        {
            **_empirical_distribution(ordered, level),
            "quantile": shares,
            "quantile_value": np.quantile(ordered, shares, method="inverted_cdf"),
            "quantile_value_lower_bound": lower,
            "quantile_value_upper_bound": upper,
            "member_count": len(ordered),
            "left_out_count": left_out,
        },
        {
            "variable": str(values.name),
            "confidence": requested,
            "references": _REFERENCES,
            "verdict": f"{len(ordered)} members{missing}; {bounds}",
            **cautions_attribute(values.coords.to_dataset()),
        },
        title="Statistics of an ensemble",
        source="empirical distribution",
    )
    if "units" in values.attrs:
        for variable in ("ordered_value", *(f"quantile_value{end}" for end in BOUND_SUFFIXES)):
            dataset[variable].attrs["units"] = values.attrs["units"]
    return dataset


def _values_of(runs: Any, name: str) -> xr.DataArray:
    if isinstance(runs, xr.DataArray):
        return runs
    dataset = checked_dataset(runs, owner=_OWNER)
    if not isinstance(cast("Any", name), str) or name not in dataset:
        known = [str(variable) for variable in dataset]
        unknown = f"{short_repr(name)}{did_you_mean(name, known)}"
        msg = f"{_OWNER}: found no {unknown}; expected one of {', '.join(known)}"
        raise SchemaError(msg)
    return dataset[name]


def _members_depend(
    values: xr.DataArray, attributes: Mapping[Any, Any], pooled: Sequence[str]
) -> bool:
    """Whether members of a sweep depend on one another; refuses axes not named in `pooled`."""
    if "axes_json" not in attributes or SAMPLING_ATTRIBUTE in attributes:
        return False
    dims = [str(dim) for dim, size in values.sizes.items() if size > 1 and dim != MOTION]
    unnamed = [dim for dim in dims if dim not in pooled]
    if unnamed:
        msg = (
            f"{_OWNER}: the sweep goes over {', '.join(unnamed)} beside motions; pick a value of "
            f"each, or take all for one ensemble with pooled={tuple(unnamed)}"
        )
        raise ComponentError(msg)
    if not dims or MOTION not in values.coords:
        return bool(dims)
    names = flatten_like(values[MOTION], values)[values.notnull().to_numpy().ravel()]
    return len(set(names.tolist())) < len(names)


def _empirical_distribution(ordered: Array, level: float) -> dict[str, Array]:
    """Return the share of members up to each value, and its bounds."""
    from scipy.stats import kstwo

    count = len(ordered)
    up_to = np.searchsorted(ordered, ordered, side="right").astype(np.float64)
    lower, upper = clopper_pearson(up_to, np.full(count, float(count)), level)
    half_width = float(kstwo.ppf(level, count))
    share = up_to / count
    return {
        "ordered_value": ordered,
        "cumulative_probability": share,
        "cumulative_probability_lower_bound": lower,
        "cumulative_probability_upper_bound": upper,
        "simultaneous_lower_bound": np.maximum(share - half_width, 0.0),
        "simultaneous_upper_bound": np.minimum(share + half_width, 1.0),
    }


def _quantile_bounds(ordered: Array, shares: Array, level: float) -> Array:
    """Return the members between which quantiles lie: the number below one is binomial."""
    from scipy.stats import binom

    if np.isnan(level):
        return np.full((2, len(shares)), np.nan)
    count, tail = len(ordered), 0.5 * (1.0 - level)
    padded = np.concatenate([[-np.inf], ordered, [np.inf]])
    # lower end by P(at least k members below), upper end by P(at most k)
    low = binom.ppf(tail, count, shares).astype(int)
    high = binom.ppf(1.0 - tail, count, shares).astype(int) + 1
    return np.stack([padded[low], padded[np.minimum(high, count + 1)]])
