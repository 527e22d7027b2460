"""From runs to trials: between which intensities the capacity of each lies."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from rockframe.results.outcome import Generic
from rockframe.results.variables.studies import MOTION
from rockframe.signals.arrays import Array
from rockframe.studies.fragility.likelihood import Trials
from rockframe.studies.lines import SCALE


def trials_of_runs(
    exceeded: xr.DataArray, measures: Sequence[xr.DataArray], *, by_motion: bool
) -> tuple[Trials, int]:
    """Give the trials of runs, each of which exceeds a limit state or does not."""
    columns, verdict = flat(exceeded, measures)
    kept = ~np.isnan(verdict) & np.all(columns > 0.0, axis=1) & np.all(np.isfinite(columns), axis=1)
    cluster = motion_numbers(exceeded)[kept]
    motions = len(np.unique(cluster))
    logs, verdict = np.log(columns[kept]), verdict[kept]
    if not by_motion:  # what is alike is counted
        points, place = np.unique(logs, axis=0, return_inverse=True)
        size = len(points)
        over = np.bincount(place.ravel(), weights=verdict, minlength=size)
        every = np.bincount(place.ravel(), minlength=size).astype(np.float64)
        return Trials.of_verdicts(points, over.astype(np.float64), every), motions
    return Trials.of_verdicts(logs, verdict, np.ones(len(verdict)), cluster), motions


def trials_of_capacities(
    analysis: xr.Dataset, known: xr.DataArray, measures: Sequence[xr.DataArray]
) -> Trials:
    """Give the trials of a dynamic analysis: one for each motion, from its first exceedance."""
    scales = analysis[SCALE].to_numpy()
    below, above = first_brackets(analysis, known)
    has_lower, has_upper = below > 0.0, np.isfinite(above)
    ends: list[Array] = []
    for scale in (np.where(has_lower, below, scales[0]), np.where(has_upper, above, scales[-1])):
        columns = [_at_scales(measure, scale) for measure in measures]
        ends.append(np.log(np.column_stack(columns)))
    lower, upper = ends
    told = has_lower | has_upper
    weight = np.ones(int(told.sum()))
    return Trials(lower[told], upper[told], has_lower[told], has_upper[told], weight, None)


def first_brackets(analysis: xr.Dataset, known: xr.DataArray) -> tuple[Array, Array]:
    """Give for each motion the scales between which the limit state is first exceeded."""
    capacity = analysis["capacity_scale"].to_numpy()
    above = analysis["scale_above"].transpose(MOTION, "flip").to_numpy()
    below = analysis["scale_below"].transpose(MOTION, "flip").to_numpy()
    seen = known.transpose(MOTION, SCALE).to_numpy()
    largest = np.where(seen, analysis[SCALE].to_numpy(), 0.0).max(axis=1)
    lower = np.zeros(len(capacity))
    for k, least in enumerate(capacity):
        (at,) = np.nonzero(above[k] == least)
        lower[k] = below[k, at[0]] if len(at) else 0.0 if np.isfinite(least) else largest[k]
    return lower, np.where(np.isfinite(capacity), capacity, np.inf)


def flat(first: xr.DataArray, others: Sequence[xr.DataArray]) -> tuple[Array, Array]:
    """Lay numbers of runs out in rows."""
    rows = [
        other.broadcast_like(first).transpose(*first.dims).to_numpy().ravel().astype(np.float64)
        for other in others
    ]
    return np.column_stack(rows), first.to_numpy().ravel().astype(np.float64)


def motion_numbers(runs: xr.DataArray) -> Generic:
    """Give the number of the motion of each run, laid out in a row."""
    if MOTION not in runs.coords:
        return np.zeros(runs.size, dtype=np.intp)
    names = runs[MOTION].broadcast_like(runs).transpose(*runs.dims).to_numpy().ravel()
    return np.unique(names.astype(str), return_inverse=True)[1]


def _at_scales(measure: xr.DataArray, scales: Array) -> Array:
    """Give a measure of each motion at its scale; measures are powers of the scale."""
    if SCALE not in measure.dims:
        return np.broadcast_to(measure.to_numpy(), scales.shape)
    least = measure.isel({SCALE: 0}), measure.isel({SCALE: -1})
    near, far = (one.to_numpy() for one in least)
    ends = measure[SCALE].to_numpy()[[0, -1]]
    power = np.log(far / near) / np.log(ends[1] / ends[0])
    return near * (scales / ends[0]) ** power
