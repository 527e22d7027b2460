"""Statistics of ensembles: how a result is distributed over motions or cases."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr

from rockframe.arguments import checked_dataset
from rockframe.errors import ComponentError, SchemaError, shown
from rockframe.results.dataset import build_dataset
from rockframe.signals.arrays import Array
from rockframe.studies.confidence import clopper_pearson, read_level
from rockframe.units import Condition, to_ratio

if TYPE_CHECKING:
    from rockframe.units import RatioLike

_OWNER: Final = "ensemble_statistics"
_SHARE: Final = Condition("above 0 and below 1", lambda value: 0.0 < value < 1.0)


def ensemble_statistics(
    runs: "xr.Dataset | xr.DataArray",
    name: str = "peak_relative_rotation",
    *,
    quantiles: "Sequence[RatioLike]" = (0.16, 0.5, 0.84),
    confidence: "RatioLike" = 0.95,
) -> xr.Dataset:
    """Give the empirical distribution of a result, with bands.

    Parameters
    ----------
    runs : xarray.Dataset or DataArray
        Of a sweep; all its cases are one ensemble: pick those that are meant before.
        Or values, such as measured ones.
    name : str, optional
        Which variable.
    quantiles : sequence of float, optional
        Shares of the distribution whose values are wanted [1].
    confidence : float, optional
        Of all bounds [1].

    Returns
    -------
    xarray.Dataset
        Over ``rank``: ``ordered_value``, ``cumulative_probability`` with bounds that hold at each
        value (Clopper and Pearson), and bounds that hold everywhere at once (``simultaneous``,
        Kolmogorov). Over ``quantile``: ``quantile_value``, with bounds by order
        statistics, infinite where the ensemble is too small.

    Raises
    ------
    SchemaError
        No dataset, or no such variable.
    ComponentError
        An argument is out of range, or there are no values.

    Notes
    -----
    All bounds hold whatever the distribution, for independent members. Cases without a
    result are left out. Runs that stop at the overturning angle have a
    ``peak_relative_rotation`` of 1, which stands for all that is more.

    A model that misses single tests may still give their distribution (Bachmann et al., 2018):
    compare the bands of both.

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
    level = read_level(confidence, owner=_OWNER)
    shares = np.array(
        [
            to_ratio(one, owner=_OWNER, name="quantiles", condition=_SHARE, example="0.5")
            for one in quantiles
        ]
    )
    values = _values(runs, name)
    ordered = np.sort(values.to_numpy().ravel().astype(np.float64))
    ordered = ordered[~np.isnan(ordered)]
    if not len(ordered):
        msg = f"{_OWNER}: {values.name} has no values"
        raise ComponentError(msg)
    lower, upper = _quantile_bounds(ordered, shares, level)
    found = build_dataset(
        {
            **_distribution(ordered, level),
            "quantile": shares,
            "quantile_value": np.quantile(ordered, shares, method="inverted_cdf"),
            "quantile_value_lower_bound": lower,
            "quantile_value_upper_bound": upper,
            "member_count": len(ordered),
        },
        {"variable": str(values.name), "confidence": level},
        title="Statistics of an ensemble",
        source="empirical distribution",
    )
    for one in ("ordered_value", *(f"quantile_value{end}" for end in ("", *_ENDS))):
        found[one].attrs |= {key: values.attrs[key] for key in ("units",) if key in values.attrs}
    return found


_ENDS: Final = ("_lower_bound", "_upper_bound")


def _values(runs: Any, name: str) -> xr.DataArray:
    if isinstance(runs, xr.DataArray):
        return runs
    dataset = checked_dataset(runs, owner=_OWNER)
    if name not in dataset:
        msg = f"{_OWNER}: found no {shown(name)}; expected one of {', '.join(map(str, dataset))}"
        raise SchemaError(msg)
    return dataset[name]


def _distribution(ordered: Array, level: float) -> dict[str, Array]:
    """Give the share of members up to each value, and its bounds."""
    from scipy.stats import kstwo

    count = len(ordered)
    up_to = np.searchsorted(ordered, ordered, side="right").astype(np.float64)
    lower, upper = clopper_pearson(up_to, np.full(count, float(count)), level)
    reach = float(kstwo.ppf(level, count))
    share = up_to / count
    return {
        "ordered_value": ordered,
        "cumulative_probability": share,
        "cumulative_probability_lower_bound": lower,
        "cumulative_probability_upper_bound": upper,
        "simultaneous_lower_bound": np.maximum(share - reach, 0.0),
        "simultaneous_upper_bound": np.minimum(share + reach, 1.0),
    }


def _quantile_bounds(ordered: Array, shares: Array, level: float) -> tuple[Array, Array]:
    """Give the members between which quantiles lie: the number below one is binomial."""
    from scipy.stats import binom

    count, tail = len(ordered), 0.5 * (1.0 - level)
    padded = np.concatenate([[-np.inf], ordered, [np.inf]])
    # P(at least k members below) for the lower end, at most for the upper one
    low = binom.ppf(tail, count, shares).astype(int)
    high = binom.ppf(1.0 - tail, count, shares).astype(int) + 1
    return padded[low], padded[np.minimum(high, count + 1)]
