"""A single case of a sweep."""

import math
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from os import PathLike
from pathlib import Path
from typing import Any, Final, cast

import numpy as np
import xarray as xr

from rockframe.arguments import json_attribute
from rockframe.components import InitialState
from rockframe.errors import SchemaError, StudyError, did_you_mean, short_repr
from rockframe.motion import GroundMotion
from rockframe.results.joining import SWEEP_ATTRIBUTES, described_motions
from rockframe.results.schema import labels_in_unit
from rockframe.results.variables.studies import MOTION, REPEATED
from rockframe.simulation.system import System
from rockframe.solve.accuracy import LEVELS, Accuracy
from rockframe.studies.sweeps.axes import SYSTEM_AXES, Axis, Changes, described_axes
from rockframe.studies.sweeps.chunk import REPEATED_LEVEL
from rockframe.studies.sweeps.motions import full_name, motion_number, motion_of_case, named_motions
from rockframe.studies.sweeps.scenes import SweptScene, scene_of
from rockframe.studies.sweeps.store import Store
from rockframe.studies.sweeps.study import cached_study
from rockframe.studies.sweeps.sweep import open_study
from rockframe.suggestions import suggests_names, with_hints
from rockframe.units import Measure, Unit, read_number

NOT_GIVEN: Final = "must be given, as motions="
"""Words on a record that neither the result nor the process has."""
_OWNER: Final = "case"
_MAX_LISTED: Final = 6
"""Values that a message lists."""


@suggests_names
@dataclass(frozen=True)
class SweepCase:
    """A case of a sweep: its system, its motion, and the arguments of its run.

    Parameters
    ----------
    system : System
        The scene with the values of the case.
    motion : GroundMotion or None
        Scaled as in the case; None where the ground stands still.
    options : dict
        Further arguments of :meth:`rockframe.System.simulate`.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> alone = SweepCase(system, pulse, {"free_vibration": "1 s"})
    >>> f"{float(alone.simulate().peak_relative_rotation):.2f}"
    '0.28'
    """

    system: System
    motion: GroundMotion | None
    options: dict[str, Any] = field(default_factory=dict[str, Any])

    def simulate(self, **changes: Any) -> xr.Dataset:
        """Run the case alone, with its histories.

        Parameters
        ----------
        **changes
            Arguments of :meth:`rockframe.System.simulate`, instead of those of the sweep;
            without them the scalars are those of the sweep, to the last bit.

        Returns
        -------
        xarray.Dataset
        """
        return self.system.simulate(self.motion, **{**self.options, **changes})


@with_hints()
def case(
    runs: "xr.Dataset | str | PathLike[str]",
    *,
    scene: object = None,
    motions: object = None,
    **labels: Any,
) -> SweepCase:
    """Return a case of a sweep, to be run alone.

    Parameters
    ----------
    runs : xarray.Dataset, or path
        Result of :func:`rockframe.sweep`, also one read from a file, or the folder in which
        a sweep is kept.
    scene : callable, optional
        The scene of the sweep if that was a function; required if this process did not run the
        sweep.
    motions : GroundMotion, or iterable or mapping of them, optional
        The records of the sweep; required if neither the dataset nor this process has them.
    **labels
        A value along each axis, as in the result or with a unit; ``motion`` by its name or its
        number. An axis with a single or already selected value may be omitted.

    Returns
    -------
    SweepCase

    Raises
    ------
    SchemaError
        The dataset is not the result of a sweep.
    StudyError
        There is no such case; or the function or the motion must be given.
    AssemblyError
        The case cannot be assembled, which is why it has no result.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> pulse = rf.GroundMotion.sine_pulse("2 m/s^2", "1 Hz")
    >>> runs = rf.sweep(system, pulse, scale=[1.0, 1.4])
    >>> alone = rf.case(runs, scale=1.4).simulate()
    >>> float(alone.peak_rotation) == float(runs.peak_rotation.sel(scale=1.4).squeeze())
    True
    """
    dataset = _read_runs(runs)
    attributes: Mapping[str, Any] = cast("Mapping[str, Any]", dataset.attrs)
    if not set(SWEEP_ATTRIBUTES) <= set(attributes):
        msg = (
            f"{_OWNER}: found a dataset that is no sweep; expected the result of rf.sweep, or of "
            "rf.concat where sweeps differ along one axis, or in their motions, alone"
        )
        raise SchemaError(msg)
    full = {
        name if name in dataset.dims else full_name(name): label for name, label in labels.items()
    }
    axes = described_axes(dataset, owner=_OWNER)
    indices = _indices_of_case(dataset, full, {axis.name: axis.unit for axis in axes})
    values: dict[Axis, Any] = {}
    for axis in axes:
        value = _value(dataset, axis.name, indices, axis.unit)
        values[replace(axis, values=np.array([value]))] = value
    name = _value(dataset, MOTION, indices)
    motion = known_motions(dataset, motions, names=[name], needed=True).get(name)
    swept = _scene(scene, dataset, _OWNER)
    of_scene = {axis: value for axis, value in values.items() if axis.changes in SYSTEM_AXES}
    system = swept.system(of_scene)
    motion = system.motion if motion is None else motion
    options = json_attribute(dataset, "run_json", _read_options, owner=_OWNER)
    start = {
        axis.parameter: value for axis, value in values.items() if axis.changes is Changes.START
    }
    options["initial"] = options["initial"].with_si(start)
    for axis, value in values.items():
        if axis.changes is Changes.MOTION and motion is not None:
            motion = motion_of_case(motion, axis.name, value, attributes.get("spectral_period"))
    if REPEATED in dataset and _value_at(dataset[REPEATED], indices) == 1.0:
        options["accuracy"] = LEVELS[REPEATED_LEVEL]
    return SweepCase(system, motion, options)


def _read_runs(runs: object) -> xr.Dataset:
    """Read the argument ``runs``."""
    if isinstance(runs, xr.Dataset):
        return runs
    if isinstance(runs, str | PathLike):
        return open_study(runs)  # pyright: ignore[reportUnknownArgumentType]
    msg = (
        f"{_OWNER}: runs must be the result of rf.sweep or the folder of its store, got "
        f"{short_repr(runs)}"
    )
    raise SchemaError(msg)


def _read_options(described: Mapping[str, Any]) -> dict[str, Any]:
    """Read the arguments of the runs of a sweep."""
    options = {name: value for name, value in described.items() if value is not None}
    options["initial"] = InitialState.from_dict(options["initial"])
    options["accuracy"] = Accuracy(**options["accuracy"])
    options["points"] = options.get("points") or None
    return options


def system_of_case(dataset: xr.Dataset, *, owner: str) -> System:
    """Return the system of a sweep, with the values of those axes along which one was selected."""
    values: dict[Axis, Any] = {}
    for axis in described_axes(dataset, owner=owner):
        if axis.changes not in SYSTEM_AXES:
            continue
        labels = _coordinate(dataset, axis.name, owner)
        if labels.size == 1:
            value = labels_in_unit(labels, axis.unit, owner=owner).item()
            values[replace(axis, values=np.array([value]))] = value
    return _scene(None, dataset, owner).system(values)


def _indices_of_case(
    dataset: xr.Dataset, labels: dict[str, Any], units: Mapping[str, str | None]
) -> dict[str, int]:
    """Return the index of the case along each dimension."""
    dims = [str(dim) for dim in dataset["status"].dims]
    fixed = [str(name) for name in dataset.coords if not dataset[name].dims]
    unknown = [name for name in labels if name not in (*dims, *fixed)]
    missing = [name for name in dims if name not in labels and dataset.sizes[name] > 1]
    faults = [
        f"there is no axis {name!r}; there are {', '.join(dims)}"
        f"{did_you_mean(name, (*dims, *fixed))}"
        for name in unknown
    ]
    faults += [f"give a value of {name!r}" for name in missing]
    if faults:
        msg = f"{_OWNER}: {'; '.join(faults)}"
        raise StudyError(msg)
    indices = {
        name: _index_of(dataset[name], name, value, units.get(name))
        for name, value in labels.items()
    }
    return {name: indices.get(name, 0) for name in dims}


def _index_of(labels: xr.DataArray, name: str, requested: Any, unit: str | None) -> int:
    values = np.atleast_1d(labels.to_numpy())
    if name == MOTION:
        return motion_number(requested, values.tolist(), owner=_OWNER)
    near = ""
    if values.dtype.kind == "f":
        if isinstance(requested, int | float | np.number):
            number = math.inf
            with suppress(OverflowError):  # of a whole number larger than any float
                number = float(requested)
        else:
            label_unit = Unit(labels.attrs["units"] if unit is None else unit)
            values = np.atleast_1d(labels_in_unit(labels, label_unit, owner=_OWNER).to_numpy())
            measure = Measure("a value", label_unit, f"{values[0]:g} {label_unit}")
            number = read_number(requested, measure, owner=_OWNER, name=name)
        nearest = int(np.argmin(np.abs(values - number)))
        if np.isclose(values[nearest], number, rtol=1e-9, atol=0.0):
            return nearest
        near = f"; the nearest is {values[nearest]}"
    else:
        typed = str(requested).strip().casefold()  # as whole numbers and truth values are typed
        for place, label in enumerate(values.tolist()):
            if label == requested or (
                isinstance(requested, str) and str(label).casefold() == typed
            ):
                return place
    few = ", ".join(str(value) for value in values[:_MAX_LISTED].tolist())
    more = f", ...{near}" if len(values) > _MAX_LISTED else ""
    msg = f"{_OWNER}: {name} has no {short_repr(requested)}; it has {few}{more}"
    raise StudyError(msg)


def _value(
    dataset: xr.Dataset, name: str, indices: Mapping[str, int], unit: str | None = None
) -> Any:
    """Return the value of a coordinate in the case, also if it was selected before."""
    labels = labels_in_unit(_coordinate(dataset, name, _OWNER), unit, owner=_OWNER)
    return _value_at(labels, indices)


def _coordinate(dataset: xr.Dataset, name: str, owner: str) -> xr.DataArray:
    if name not in dataset.coords:
        msg = f"{owner}: found a sweep without its coordinate {name!r}; expected it, or its case"
        raise SchemaError(msg)
    return dataset[name]


def _value_at(labels: xr.DataArray, indices: Mapping[str, int]) -> Any:
    return labels.isel({dim: indices[str(dim)] for dim in labels.dims}).item()


def _scene(given: object, dataset: xr.Dataset, owner: str) -> SweptScene:
    swept = None if given is None else scene_of(given)
    attributes = cast("Mapping[str, Any]", dataset.attrs)
    if "system_json" in attributes:
        return scene_of(json_attribute(dataset, "system_json", System.from_dict, owner=owner))
    if swept is not None:
        return swept
    if (known := cached_study(attributes)) is not None:
        return known.scene
    advice = "give it as scene="
    if owner != _OWNER:  # which takes no scene
        advice = "give rf.case(dataset, scene=...).simulate() instead of the case"
    msg = f"{owner}: the scene was the function {attributes.get('function')}; {advice}"
    raise StudyError(msg)


def known_motions(
    runs: xr.Dataset,
    value: object = None,
    *,
    names: Iterable[str] | None = None,
    needed: bool = False,
    owner: str = _OWNER,
) -> dict[str, GroundMotion]:
    """Return the available motions of a sweep, or those of some names, before they were scaled."""
    attributes: Mapping[str, Any] = cast("Mapping[str, Any]", runs.attrs)
    described = described_motions(runs, owner=owner)
    if names is None:
        used = set(runs[MOTION].to_numpy().astype(str).ravel().tolist()) if MOTION in runs else None
        names = [name for name in described if used is None or name in used]
    study, stored = cached_study(attributes), _store_of(runs)
    available = {} if study is None else study.motions
    if stored is not None:
        available = stored.motions()
    given = {} if value is None else named_motions(value)
    records = {motion.sha256: motion for motion in given.values()}
    motions: dict[str, GroundMotion] = {}
    for name in names:
        if name not in described:
            msg = f"{owner}: the sweep had no motion {name!r}; there are {', '.join(described)}"
            raise SchemaError(msg)
        description = described[name]
        if description is None:
            continue
        if (known := available.get(name)) is not None:
            motions[name] = known
        elif description.get("constructor"):
            motions[name] = GroundMotion.from_dict(description)
        elif description["sha256"] in records:
            motions[name] = records[description["sha256"]]
        elif needed:
            has = NOT_GIVEN if value is None else "is not among those given"
            digest = description["sha256"][:12]
            msg = f"{owner}: the record {description['name']!r} (sha256 {digest}...) {has}"
            raise StudyError(msg)
    return motions


def _store_of(runs: xr.Dataset) -> Store | None:
    """Return the folder that a dataset was opened from, if it was and holds its study."""
    try:
        store = Store.open(Path(str(runs.encoding.get("source", ""))))
    except StudyError:
        return None
    return store if store.digest == runs.attrs.get("study_sha256") else None
