"""Trials of capacities: what runs and dynamic analyses tell of them.

A trial tells between which intensities the capacity lies: of a run that exceeds a limit state it
lies below the intensity of the run, of one that does not above it, and a dynamic analysis
encloses it in a bracket.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from rockframe.results.outcome import Generic
from rockframe.results.variables.studies import MOTION
from rockframe.signals.arrays import Array
from rockframe.studies.lines import SCALE


@dataclass(frozen=True, eq=False)
class Trials:
    """What is known of capacities."""

    # logarithms of the intensities between which the capacity lies; any number where an end is open
    lower: Array
    upper: Array
    has_lower: Generic  # which ends there are
    has_upper: Generic
    weight: Array  # how often the trial was made
    # trials of one cluster, such as those under one motion, depend on one another; None where no
    # two of them do
    cluster: Generic | None

    @classmethod
    def of_verdicts(
        cls, logs: Array, exceeded: Array, trials: Array, cluster: Generic | None = None
    ) -> "Trials":
        """Give the trials of counts."""
        both = np.concatenate([logs, logs])
        over = np.repeat([True, False], len(logs))
        weight = np.concatenate([exceeded, trials - exceeded]).astype(np.float64)
        kept = weight > 0.0
        numbers = None if cluster is None else np.tile(cluster, 2)[kept]
        return cls(both[kept], both[kept], ~over[kept], over[kept], weight[kept], numbers)

    def of_weights(self, weight: Array) -> "Trials":
        """Give the trials that have a weight above zero, with that weight."""
        kept = weight > 0.0
        return Trials(
            self.lower[kept], self.upper[kept], self.has_lower[kept], self.has_upper[kept],
            weight[kept], None if self.cluster is None else self.cluster[kept],
        )  # fmt: skip

    @property
    def measures(self) -> int:
        """Number of intensity measures."""
        return self.lower.shape[1]


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
) -> tuple[Trials, int]:
    """Give the trials of a dynamic analysis, one for each line, from its first exceedance.

    A line is a motion, and a value of all else that is taken for one population. Their number is
    given, too.
    """
    sizes = {str(dim): size for dim, size in known.sizes.items() if dim != SCALE}
    scales = analysis[SCALE].to_numpy()
    below, above = _first_brackets(analysis, known, sizes)
    has_lower, has_upper = below > 0.0, np.isfinite(above)
    rows = [_in_lines(measure, sizes, SCALE) for measure in measures]
    lower, upper = (
        np.log(np.column_stack([_at_scales(row, scales, scale) for row in rows]))
        for scale in (np.where(has_lower, below, scales[0]), np.where(has_upper, above, scales[-1]))
    )
    told = has_lower | has_upper
    weight = np.ones(int(told.sum()))
    found = Trials(lower[told], upper[told], has_lower[told], has_upper[told], weight, None)
    return found, len(told)


def _first_brackets(
    analysis: xr.Dataset, known: xr.DataArray, sizes: Mapping[str, int]
) -> tuple[Array, Array]:
    """Give for each line the scales between which the limit state is first exceeded."""
    capacity = _in_lines(analysis["capacity_scale"], sizes)[:, 0]
    above, below = (
        _in_lines(analysis[f"scale_{end}"], sizes, "flip") for end in ("above", "below")
    )
    seen = _in_lines(known, sizes, SCALE)
    largest = np.where(seen, analysis[SCALE].to_numpy(), 0.0).max(axis=1)
    lower = np.zeros(len(capacity))
    for k, least in enumerate(capacity):
        (at,) = np.nonzero(above[k] == least)
        lower[k] = below[k, at[0]] if len(at) else 0.0 if np.isfinite(least) else largest[k]
    return lower, np.where(np.isfinite(capacity), capacity, np.inf)


def _in_lines(values: xr.DataArray, sizes: Mapping[str, int], along: str = "") -> Generic:
    """Lay values out in a row for each line, along a dimension; of one value each without it."""
    lacking = {dim: size for dim, size in sizes.items() if dim not in values.dims}
    own = [along] if along in values.dims else []
    laid = values.variable.set_dims({**lacking, **values.sizes}).transpose(*sizes, *own)
    count = math.prod(sizes.values())
    return laid.to_numpy().reshape((count, values.sizes[along] if own else 1))


def flat(first: xr.DataArray, others: Sequence[xr.DataArray]) -> tuple[Array, Array]:
    """Lay numbers of runs out in rows."""
    rows = [laid_out(other, first).astype(np.float64) for other in others]
    return np.column_stack(rows), first.to_numpy().ravel().astype(np.float64)


def laid_out(values: xr.DataArray, like: xr.DataArray) -> Generic:
    """Lay values out in a row, in the order of others, whose dimensions are theirs or more."""
    return values.broadcast_like(like).transpose(*like.dims).to_numpy().ravel()


def motion_numbers(runs: xr.DataArray) -> Generic:
    """Give the number of the motion of each run, laid out in a row."""
    if MOTION not in runs.coords:
        return np.zeros(runs.size, dtype=np.intp)
    return np.unique(laid_out(runs[MOTION], runs).astype(str), return_inverse=True)[1]


def _at_scales(measure: Generic, known: Array, scales: Array) -> Array:
    """Give a measure of each line at its scale; measures are powers of the scale."""
    near, far = measure[:, 0], measure[:, -1]
    if measure.shape[1] == 1:
        return near
    power = np.log(far / near) / np.log(known[-1] / known[0])
    return near * (scales / known[0]) ** power
