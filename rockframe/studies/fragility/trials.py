"""Trials: the data on capacities of structures from runs and dynamic analyses.

The structures of a sweep are fitted separately. A trial gives the intensities between which a
capacity lies: below the intensity of a run that exceeds a limit state, above that of a run that
does not, and within a bracket of a dynamic analysis.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
import pandas as pd
import xarray as xr

from rockframe.arguments import checked_list
from rockframe.errors import ComponentError, SchemaError, StudyError, first_along, short_repr
from rockframe.results.variables.studies import CASE, MOTION
from rockframe.signals.arrays import AnyArray, Array
from rockframe.studies.intensities import column_of_runs
from rockframe.studies.sweeps.axes import Changes, described_axes
from rockframe.studies.sweeps.labelling import cautions_attribute
from rockframe.studies.sweeps.motions import SCALE

Labelled = TypeVar("Labelled", xr.DataArray, xr.Dataset)


@dataclass(frozen=True, eq=False)
class Structures:
    """The structures of a sweep, distinguished by everything except motion and intensity."""

    # for each dimension over which structures differ, the number of the structure at each place
    groups: Mapping[str, AnyArray]
    coordinates: Mapping[str, xr.Variable]  # what distinguishes them

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of structures along each dimension."""
        return tuple(int(group.max()) + 1 for group in self.groups.values())

    def parts(self, values: Labelled) -> Iterator[Labelled]:
        """Return what belongs to each structure, the last dimension fastest."""
        for number in np.ndindex(self.shape):
            groups = zip(self.groups.items(), number, strict=True)
            chosen = {dim: np.flatnonzero(group == k) for (dim, group), k in groups}
            yield values.isel(chosen, missing_dims="ignore")


def structures_of(
    runs: xr.Dataset, pooled: Sequence[str], measures: Sequence[object], *, owner: str
) -> Structures:
    """Find the structures of a sweep."""
    axes = [axis.name for axis in described_axes(runs, owner=owner)]
    own_measures = _own_measures(runs, measures)
    changed = _structural_axes(runs, own_measures, owner=owner)
    dims = [str(dim) for dim in runs["status"].dims]
    differing = [name for name in changed if name in runs.coords or name in dims]
    missing = [name for name in changed if name not in differing]
    if missing and CASE in dims:
        msg = f"{owner}: found a sweep without its coordinate {missing[0]!r}"
        raise SchemaError(msg)
    known_dims = {
        str(dim) for name in (MOTION, *axes, *own_measures) if name in runs.variables
        for dim in runs[name].dims
    }  # fmt: skip
    unknown_dims = [
        dim for dim in dims if dim not in {*known_dims, *axes, *own_measures, MOTION, CASE}
    ]
    if unknown_dims and len(own_measures) < len(measures):
        msg = (
            f"{owner}: the sweep had no dimension {', '.join(map(repr, unknown_dims))}; datasets "
            "that were put together tell the motions of the first alone: fit each of them, or "
            "give the intensity as a DataArray"
        )
        raise StudyError(msg)
    names = runs.indexes.get(MOTION, pd.Index([]))
    if not names.is_unique:
        twice = str(min(names[names.duplicated()]))
        msg = f"{owner}: the motion {twice!r} stands twice along 'motion'"
        raise StudyError(msg)
    known = [*(name for name in differing if runs[name].dims), *unknown_dims]
    if CASE in pooled and CASE in dims:  # stands for all columns of its table
        columns = [name for name in known if CASE in runs[name].dims]
        pooled = [*(name for name in pooled if name != CASE), *columns]
    _check_pooled(pooled, (*changed, *unknown_dims), known, owner)
    not_pooled = [name for name in known if name not in pooled]
    scalar_names = [name for name in differing if not runs[name].dims]
    structures = _group_structures(runs, dims, not_pooled, scalar_names)
    sizes = [np.bincount(group).max() for group in structures.groups.values()]
    other_sizes = [runs.sizes[dim] for dim in dims if dim not in structures.groups]
    if np.prod(structures.shape) > 1 and np.prod([*sizes, *other_sizes]) == 1:
        msg = (
            f"{owner}: each run has a structure of its own, for {', '.join(not_pooled)} differ "
            f"from run to run; pooled={tuple(not_pooled)} takes all of them for one"
        )
        raise ComponentError(msg)
    return structures


def check_one_structure(
    runs: xr.Dataset, pooled: object, measures: Sequence[object], *, owner: str
) -> list[str]:
    """Refuse runs of several structures, except over the axes `pooled`, which are returned."""
    pooled = checked_list(pooled, owner=owner, name="pooled", of="names")
    changed = _structural_axes(runs, _own_measures(runs, measures), owner=owner)
    several = [
        name
        for name in changed
        if name in runs.coords and len(pd.unique(runs[name].to_numpy().ravel())) > 1
    ]
    _check_pooled(pooled, (*changed, CASE), several, owner)
    names = [name for name in several if name not in pooled]
    if CASE in pooled:  # stands for all columns of its table
        names = [name for name in names if CASE not in runs[name].dims]
    if names:
        pick = f"pick one, for example {first_along('runs', names[0])}, or " * (
            names[0] in runs.dims
        )
        msg = (
            f"{owner}: the runs are of several structures, by {', '.join(names)}; {pick}take all "
            f"of them for one, by pooled={tuple(names)}"
        )
        raise StudyError(msg)
    return pooled


def attributes_of_system(runs: xr.Dataset, *, changed: bool | None = None) -> dict[str, Any]:
    """Return attributes of runs: their system, which a sweep may have changed, and cautions."""
    if changed is None:
        changed = any(name in runs.coords for name in _structural_axes(runs, owner="the runs"))
    names = ("model",) if changed else ("model", "system_json")
    about = {name: runs.attrs[name] for name in names if name in runs.attrs}
    return about | cautions_attribute(runs)


def _check_pooled(
    pooled: Sequence[str], known: Sequence[str], differing: Sequence[str], owner: str
) -> None:
    """Refuse to pool names that are not axes."""
    wrong = [name for name in pooled if name not in known]
    if wrong:
        msg = (
            f"{owner}: pooled names {', '.join(map(short_repr, wrong))}; what differs in these "
            f"runs beside motion and intensity: {', '.join(differing) or 'nothing'}"
        )
        raise ComponentError(msg)


def _own_measures(runs: xr.Dataset, values: Sequence[object]) -> list[str]:
    """Return names of intensities that are arrays, along the axis of that name if there is one."""
    columns = [column_of_runs(runs, value) for value in values]
    return [
        str(column.name) for column in columns if isinstance(column, xr.DataArray)
        and (column.name not in runs.coords or set(runs[column.name].dims) <= set(column.dims))
    ]  # fmt: skip


def _structural_axes(runs: xr.Dataset, own: Sequence[str] = (), *, owner: str) -> list[str]:
    """Return the axes along which structures differ."""
    axes = described_axes(runs, owner=owner)
    return [a.name for a in axes if a.name not in own and a.changes is not Changes.MOTION]


def _group_structures(
    runs: xr.Dataset, dims: Sequence[str], not_pooled: Sequence[str], scalar_names: Sequence[str]
) -> Structures:
    """Return the structures, numbered along each dimension, with their labels."""
    groups: dict[str, AnyArray] = {}
    coordinates = {
        str(name): runs[name].variable
        for name in (*scalar_names, *not_pooled)
        if name in runs.coords and runs[name].ndim != 1
    }
    for dim in dims:
        columns = [name for name in not_pooled if name in runs.coords and runs[name].dims == (dim,)]
        shared = dim in not_pooled or any(
            dim in coordinate.dims for coordinate in coordinates.values()
        )
        if not columns and not shared:
            continue
        # without a column each place is a structure of its own; otherwise equal rows are of one
        table = pd.DataFrame({name: runs[name].to_numpy() for name in columns})
        places = np.arange(runs.sizes[dim])
        if not shared:
            places = table.groupby(columns, sort=False, dropna=False).ngroup().to_numpy()
        groups[dim] = places
        first = np.unique(groups[dim], return_index=True)[1]
        # labels of a dimension with several levels cannot be stored in a file
        plain = dim in runs.coords and runs.indexes[dim].nlevels == 1
        for name in (*columns, *([dim] if plain else [])):
            values = runs[name]
            coordinates[name] = xr.Variable(dim, values.to_numpy()[first], values.attrs)
    return Structures(groups, coordinates)


@dataclass(frozen=True, eq=False)
class Trials:
    """What is known of capacities."""

    # logarithms of the intensities between which the capacity lies; any number where an end is open
    lower: Array
    upper: Array
    has_lower: AnyArray  # which ends there are
    has_upper: AnyArray
    weight: Array  # how often the trial was made
    # trials of one cluster, such as those under one motion, depend on one another; None where no
    # two of them do
    cluster: AnyArray | None

    @classmethod
    def from_verdicts(
        cls, logs: Array, exceeded: Array, trials: Array, cluster: AnyArray | None = None
    ) -> "Trials":
        """Return the trials of counts."""
        ends = np.concatenate([logs, logs])
        is_upper = np.repeat([True, False], len(logs))
        weight = np.concatenate([exceeded, trials - exceeded]).astype(np.float64)
        numbers = None if cluster is None else np.tile(cluster, 2)
        return cls(ends, ends, ~is_upper, is_upper, weight, numbers).with_weights(weight)

    def with_weights(self, weight: Array) -> "Trials":
        """Return the trials that have a weight above zero, with that weight."""
        used = weight > 0.0
        return Trials(
            self.lower[used], self.upper[used], self.has_lower[used], self.has_upper[used],
            weight[used], None if self.cluster is None else self.cluster[used],
        )  # fmt: skip

    @property
    def measures(self) -> int:
        """Number of intensity measures."""
        return self.lower.shape[1]

    @cached_property
    def design(self) -> tuple[Array, Array]:
        """Ones and logarithms of the upper and the lower ends; an open end has zeros."""
        ones = np.ones(len(self.weight))
        upper = np.column_stack([ones, self.upper]) * self.has_upper[:, None]
        return upper, np.column_stack([ones, self.lower]) * self.has_lower[:, None]

    def known_ends(self, sign: float = 1.0) -> Array:
        """Return the rows of all upper ends, and those of all lower ones with a sign."""
        upper, lower = self.design
        return np.concatenate([upper[self.has_upper], sign * lower[self.has_lower]])


@dataclass(frozen=True, eq=False)
class StructureTrials:
    """The data on one structure and one limit state."""

    trials: Trials  # what is known of its capacity
    # intensities, and whether they were exceeded, of each run; None of capacities
    runs: tuple[Array, Array] | None
    left_out: int  # how many runs or capacities are no trials
    independent: int  # how many trials, or motions of trials, are independent


def trials_of_runs(
    exceeded: xr.DataArray, measures: Sequence[xr.DataArray], *, by_motion: bool
) -> StructureTrials:
    """Return the trials of runs, each of which exceeds a limit state or does not."""
    columns = np.column_stack(
        [flatten_like(measure, exceeded).astype(np.float64) for measure in measures]
    )
    verdict = exceeded.to_numpy().ravel().astype(np.float64)
    runs = columns, verdict
    used = ~np.isnan(verdict) & np.all(columns > 0.0, axis=1) & np.all(np.isfinite(columns), axis=1)
    cluster = motion_numbers(exceeded)[used]
    motions = len(np.unique(cluster))
    logs, verdict = np.log(columns[used]), verdict[used]
    if not by_motion:  # what is alike is counted
        points, place, every = np.unique(logs, axis=0, return_inverse=True, return_counts=True)
        over = np.bincount(place.ravel(), weights=verdict).astype(np.float64)
        trials = Trials.from_verdicts(points, over, every.astype(np.float64))
    else:
        trials = Trials.from_verdicts(logs, verdict, np.ones(len(verdict)), cluster)
    return StructureTrials(trials, runs, int((~used).sum()), motions)


def trials_of_capacities(
    analysis: xr.Dataset, known: xr.DataArray, measures: Sequence[xr.DataArray]
) -> StructureTrials:
    """Return the trials of an analysis, one for each line, from its first exceedance."""
    sizes = {str(dim): size for dim, size in known.sizes.items() if dim != SCALE}
    scales = analysis[SCALE].to_numpy()
    below, above = _first_brackets(analysis, known, sizes)
    has_lower, has_upper = below > 0.0, np.isfinite(above)
    rows = [_rows_of_lines(measure, sizes, SCALE) for measure in measures]
    lower, upper = (
        np.log(np.column_stack([at_scales(row, scales, scale) for row in rows]))
        for scale in (np.where(has_lower, below, scales[0]), np.where(has_upper, above, scales[-1]))
    )
    bounded = (has_lower | has_upper).astype(np.float64)
    trials = Trials(lower, upper, has_lower, has_upper, bounded, None).with_weights(bounded)
    count = len(trials.weight)
    return StructureTrials(trials, None, len(bounded) - count, count)


def _first_brackets(
    analysis: xr.Dataset, known: xr.DataArray, sizes: Mapping[str, int]
) -> tuple[Array, Array]:
    """Return for each line the scales between which the limit state is first exceeded."""
    capacity = _rows_of_lines(analysis["capacity_scale"], sizes)[:, 0]
    above, below = (
        _rows_of_lines(analysis[f"scale_{end}"], sizes, "flip") for end in ("above", "below")
    )
    seen = _rows_of_lines(known, sizes, SCALE)
    largest = np.where(seen, analysis[SCALE].to_numpy(), 0.0).max(axis=1)
    lower = np.zeros(len(capacity))
    for k, least in enumerate(capacity):
        (at,) = np.nonzero(above[k] == least)
        lower[k] = below[k, at[0]] if len(at) else 0.0 if np.isfinite(least) else largest[k]
    return lower, np.where(np.isfinite(capacity), capacity, np.inf)


def _rows_of_lines(values: xr.DataArray, sizes: Mapping[str, int], along: str = "") -> AnyArray:
    """Arrange values in a row for each line, along a dimension; one value each without it."""
    missing = {dim: size for dim, size in sizes.items() if dim not in values.dims}
    last = [along] if along in values.dims else []
    laid = values.variable.set_dims({**missing, **values.sizes}).transpose(*sizes, *last)
    count = math.prod(sizes.values())
    return laid.to_numpy().reshape((count, values.sizes[along] if last else 1))


def flatten_like(values: xr.DataArray, like: xr.DataArray) -> AnyArray:
    """Arrange values in a row, in the order of others that have at least their dimensions."""
    return values.broadcast_like(like).transpose(*like.dims).to_numpy().ravel()


def motion_numbers(runs: xr.DataArray) -> AnyArray:
    """Return the number of the motion of each run, laid out in a row."""
    if MOTION not in runs.coords:
        return np.zeros(runs.size, dtype=np.intp)
    return np.unique(flatten_like(runs[MOTION], runs).astype(str), return_inverse=True)[1]


def at_scales(measure: AnyArray, known: Array, scales: Array | float) -> Array:
    """Return a measure at other scales; it is a power of the scale."""
    near, far = measure[..., 0], measure[..., -1]
    if measure.shape[-1] == 1:
        return near
    power = np.log(far / near) / np.log(known[-1] / known[0])
    return near * (scales / known[0]) ** power
