"""The structures of a sweep, which are fitted apart."""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import xarray as xr

from rockframe.arguments import several
from rockframe.errors import ComponentError, SchemaError, StudyError, shown
from rockframe.results.outcome import Generic
from rockframe.results.variables.studies import CASE, MOTION
from rockframe.studies.sweeps.axes import Changes

Values = TypeVar("Values", xr.DataArray, xr.Dataset)


@dataclass(frozen=True, eq=False)
class Structures:
    """The structures of a sweep: what differs beside motion and intensity tells them apart."""

    # for each dimension over which structures differ, the number of the structure at each place
    groups: Mapping[str, Generic]
    coordinates: Mapping[str, xr.Variable]  # what they are told apart by
    names: tuple[str, ...]  # what differs from one to another

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of structures along each dimension."""
        return tuple(int(group.max()) + 1 for group in self.groups.values())

    def parts(self, values: Values) -> Iterator[Values]:
        """Give what belongs to each structure, the last dimension fastest."""
        places = [
            [np.flatnonzero(group == k) for k in range(size)]
            for group, size in zip(self.groups.values(), self.shape, strict=True)
        ]
        for number in np.ndindex(self.shape):
            chosen = {
                dim: each[k] for dim, each, k in zip(self.groups, places, number, strict=True)
            }
            yield values.isel(chosen, missing_dims="ignore")


def structures_of(
    runs: xr.Dataset, pooled: Iterable[str], given: Sequence[object], *, owner: str
) -> Structures:
    """Find the structures of a sweep."""
    asked = several(pooled, owner=owner, name="pooled", of="names")
    axes = {one["name"]: one["changes"] for one in json.loads(runs.attrs["axes_json"])}
    own = [str(one.name) for one in given if isinstance(one, xr.DataArray)]
    changed = [name for name in axes if name not in own and axes[name] != Changes.MOTION]
    dims = [str(dim) for dim in runs["status"].dims]
    differing = [name for name in changed if name in runs.coords or name in dims]
    lost = [name for name in changed if name not in differing]
    if lost and CASE in dims:
        msg = f"{owner}: found a sweep without its coordinate {lost[0]!r}, which tells cases apart"
        raise SchemaError(msg)
    explained = {
        str(dim) for name in (MOTION, *axes, *own) if name in runs.variables
        for dim in runs[name].dims
    }  # fmt: skip
    foreign = [dim for dim in dims if dim not in {*explained, *axes, *own, MOTION, CASE}]
    _check_motions(runs, foreign, owner, named=len(own) < len(given))
    known = [*(name for name in differing if runs[name].dims), *foreign]
    if CASE in asked and CASE in dims:  # stands for all columns of its table
        columns = [name for name in known if CASE in runs[name].dims]
        asked = [*(one for one in asked if one != CASE), *columns]
    wrong = [one for one in asked if one not in (*changed, *foreign)]
    if wrong:
        msg = (
            f"{owner}: pooled names {', '.join(map(shown, wrong))}; what differs in these runs "
            f"beside motion and intensity: {', '.join(known) or 'nothing'}"
        )
        raise ComponentError(msg)
    kept = [name for name in known if name not in asked]
    alone = [name for name in differing if not runs[name].dims]
    found = _grouped(runs, dims, kept, alone)
    sizes = [np.bincount(group).max() for group in found.groups.values()]
    rest = [runs.sizes[dim] for dim in dims if dim not in found.groups]
    if np.prod(found.shape) > 1 and np.prod([*sizes, *rest]) == 1:
        msg = (
            f"{owner}: each run has a structure of its own, for {', '.join(kept)} differ from run "
            f"to run; pooled={tuple(kept)} takes all of them for one"
        )
        raise ComponentError(msg)
    return found


def _check_motions(runs: xr.Dataset, foreign: Sequence[str], owner: str, *, named: bool) -> None:
    """Refuse datasets that were put together so that nobody knows which motions were run."""
    if foreign and named:
        msg = (
            f"{owner}: the sweep had no dimension {', '.join(map(repr, foreign))}; datasets that "
            "were put together tell the motions of the first alone: fit each of them, or give the "
            "intensity as a DataArray"
        )
        raise StudyError(msg)
    if MOTION in runs.dims and MOTION in runs.coords:
        names, count = np.unique(runs[MOTION].to_numpy().astype(str), return_counts=True)
        if count.max(initial=0) > 1:
            msg = f"{owner}: the motion {str(names[count > 1][0])!r} stands twice along 'motion'"
            raise StudyError(msg)


def _grouped(
    runs: xr.Dataset, dims: Sequence[str], kept: Sequence[str], alone: Sequence[str]
) -> Structures:
    """Give structures numbers along each dimension, and labels."""
    groups: dict[str, Generic] = {}
    coordinates = {
        str(name): runs[name].variable
        for name in (*alone, *kept)
        if name in runs.coords and runs[name].ndim != 1
    }
    for dim in dims:
        columns = [name for name in kept if name in runs.coords and runs[name].dims == (dim,)]
        shared = dim in kept or any(dim in one.dims for one in coordinates.values())
        if not columns and not shared:
            continue
        first, group = _alike([runs[name].to_numpy() for name in columns], runs.sizes[dim], shared)
        groups[dim] = group
        # a dimension of several levels has no labels that a file can keep
        plain = dim in runs.coords and runs.indexes[dim].nlevels == 1
        for name in (*columns, *([dim] if plain else [])):
            values = runs[name]
            coordinates[name] = xr.Variable(dim, values.to_numpy()[first], values.attrs)
    return Structures(groups, coordinates, tuple(kept))


def _alike(columns: Sequence[Generic], size: int, apart: bool) -> tuple[Generic, Generic]:
    """Give the first place of each group of like rows, and the group of each place."""
    if apart:
        return np.arange(size), np.arange(size)
    numbers = [np.unique(one.astype(str) if one.dtype == object else one, return_inverse=True)[1]
               for one in columns]  # fmt: skip
    _, first, group = np.unique(
        np.column_stack(numbers), axis=0, return_index=True, return_inverse=True
    )
    order = np.argsort(first)
    return first[order], np.argsort(order)[group.ravel()]
