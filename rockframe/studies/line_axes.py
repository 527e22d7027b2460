"""Axes of an analysis along scales of motions: each combination of their values is a line."""

import math
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, cast

import numpy as np
import xarray as xr

from rockframe.errors import RockframeError, StudyError, did_you_mean, short_repr
from rockframe.results.schema import with_labels
from rockframe.results.variables.studies import CASE
from rockframe.signals.arrays import AnyArray
from rockframe.studies.sweeps.arguments import SWEEP_ARGUMENT_NAMES
from rockframe.studies.sweeps.axes import Axis, Changes, faults_of_values
from rockframe.studies.sweeps.scenes import SweptScene
from rockframe.units import Unit


@dataclass(frozen=True, eq=False)
class LineAxes:
    """Axes other than the scale of the motions."""

    axes: tuple[Axis, ...] = ()

    @property
    def sizes(self) -> dict[str, int]:
        """The dimensions of the axes, in order, and their lengths."""
        return {axis.name: len(axis.values) for axis in self.axes}

    def columns(
        self, rows: Mapping[str, tuple[AnyArray, str]] = MappingProxyType({})
    ) -> dict[str, tuple[AnyArray, str]]:
        """Return a table of all combinations of values for each of some rows; last axis fastest."""
        places = np.indices(tuple(self.sizes.values()))
        count = math.prod(self.sizes.values())
        repeats = max((len(values) for values, _ in rows.values()), default=1)
        table = {name: (np.repeat(values, count), unit) for name, (values, unit) in rows.items()}
        return table | {
            axis.name: (np.tile(axis.values[place.ravel()], repeats), axis.unit or str(Unit.ONE))
            for axis, place in zip(self.axes, places, strict=True)
        }

    @property
    def labels(self) -> dict[str, xr.Variable]:
        """Their values, by their names."""
        return {
            axis.name: xr.Variable(axis.name, axis.values, axis.attributes()) for axis in self.axes
        }

    def unstack(self, runs: xr.Dataset) -> xr.Dataset:
        """Return the runs with the dimensions of the axes instead of the rows of the table."""
        return unstack_cases(runs, self.sizes, self.labels) if self.axes else runs


def unstack_cases(
    runs: xr.Dataset, sizes: Mapping[str, int], labels: Mapping[str, xr.Variable]
) -> xr.Dataset:
    """Return a dataset with several dimensions in place of the rows of a table."""
    variables: dict[Hashable, xr.Variable] = {}
    for name, variable in runs.variables.items():
        if name == CASE or name in labels:
            continue
        wide = variable.unstack({CASE: dict(sizes)}) if CASE in variable.dims else variable
        other_dims = [dim for dim in wide.dims if dim not in sizes]
        variables[name] = wide.transpose(*(dim for dim in sizes if dim in wide.dims), *other_dims)
    made = xr.Dataset(variables, attrs=runs.attrs)
    made = made.set_coords([name for name in runs.coords if name in variables])
    return with_labels(made, labels)


def read_line_axes(
    value: object,
    scene: SweptScene,
    *,
    owner: str,
    argument_names: Iterable[str],
    own_axes: Sequence[Axis] = (),
) -> LineAxes:
    """Read the axes of an analysis; argument names are for proposals."""
    if value is None:
        return LineAxes()
    if not isinstance(value, Mapping):
        msg = f"{owner}: axes must be a mapping of names to values, got {short_repr(value)}"
        raise StudyError(msg)
    line_axes, faults = list[Axis](), list[str]()
    for name, values in cast("Mapping[Any, Any]", value).items():
        if name in SWEEP_ARGUMENT_NAMES:
            faults.append(f"{owner} takes no {name!r}, as rf.sweep does")
            continue
        try:
            line_axes.append(scene.axis(str(name), values))
        except RockframeError as problem:
            reasons = problem.faults if isinstance(problem, StudyError) else (str(problem),)
            argument = did_you_mean(name, argument_names)
            faults += [
                reason if argument in reason else f"{reason}{argument}" for reason in reasons
            ]
    for axis in line_axes:
        if axis.changes is Changes.MOTION:
            faults.append(f"axis {axis.name!r} scales the motion, as scale does; give scale alone")
        faults += faults_of_values(axis.name, axis.values)
    faults += scene.faults([*own_axes, *line_axes])
    if faults:
        raise StudyError(*faults)
    return LineAxes(tuple(line_axes))
