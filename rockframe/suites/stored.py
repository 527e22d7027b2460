"""A suite as a labelled dataset, and back, bit for bit.

Motions differ in length: their samples are stored one after the other, with the number of samples
of each, as the contiguous ragged array of CF 9.3.3.
"""

import json
import math
from collections.abc import Callable, Mapping
from typing import Any, Final, TypeVar

import numpy as np
import xarray as xr

from rockframe.constants import CONVENTIONS
from rockframe.errors import ComponentError, RecordError, SchemaError
from rockframe.motion import GroundMotion
from rockframe.records import (
    LONG_NAMES,
    Source,
    is_netcdf,
    motion_of_arrays,
    opened_netcdf,
    stored_arrays,
)
from rockframe.results.joining import MOTION
from rockframe.results.schema import build_dataset
from rockframe.signals.motion import COEFFICIENTS
from rockframe.suites.columns import known_columns
from rockframe.suites.labelled_motions import LabelledMotions
from rockframe.suites.target import TargetSpectrum
from rockframe.units import Unit

_KIND: Final = "suite of ground motions"
Suite = TypeVar("Suite", bound=LabelledMotions)
_EXPECTED: Final = "a suite as MotionSuite.to_dataset().to_netcdf(...) writes it"
_MAX_NUMBERS: Final = 20_000_000
_NAME: Final = "motion_name"
_TARGET: Final = "target"
_STORED_BAND: Final = (0.01, 20.0)
"""Range of periods in which a target without bounds of its own is stored [s]."""
_PERIODS: Final = 501
_TEXTS: Final[dict[str, tuple[str, Callable[[GroundMotion], str]]]] = {
    # variable: meaning, value of a motion
    "motion_sha256": ("digest of time step and samples", lambda motion: motion.sha256),
    "metadata": (
        "what is known of the motion, as JSON",
        lambda motion: json.dumps({**motion.metadata}),
    ),
    "history": (
        "what was done to the motion, a line for each step",
        lambda motion: "\n".join(motion.history),
    ),
    "recipe": (
        "constructor and arguments of an analytic motion, as JSON",
        lambda motion: "" if motion.recipe is None else json.dumps({**motion.recipe}),
    ),
    _NAME: ("what titles and messages call the motion", lambda motion: motion.name),
}
_RAGGED_ARRAYS: Final = {
    # variable: dimension, count, words of the count
    "acceleration": ("sample", "sample_count", ""),
    "vertical_acceleration": ("vertical_sample", "vertical_sample_count", "vertical samples"),
    "acceleration_pieces": ("piece", "piece_count", "polynomials"),
    "vertical_acceleration_pieces": (
        "vertical_piece",
        "vertical_piece_count",
        "vertical polynomials",
    ),
}


def suite_dataset(suite: LabelledMotions) -> xr.Dataset:
    """Write a suite as a dataset that plain xarray can store."""
    motions = {**suite, **suite.verticals}
    dataset = build_dataset(
        known_columns(motions),
        {
            "Conventions": CONVENTIONS,
            "kind": _KIND,
            "verticals": len(suite.verticals),
            "unread": json.dumps(dict(suite.unread)),
            "remarks": json.dumps(list(suite.remarks)),
            **({} if suite.target is None else {_TARGET: json.dumps(_table_of(suite.target))}),
        },
        over=(MOTION,),
        title="Suite of ground motions",
        source="records and models of ground motions",
    )
    for name, (words, text_of) in _TEXTS.items():
        texts = np.array([text_of(motion) for motion in motions.values()])
        dataset[name] = (MOTION, texts, {"long_name": words})
    for name, (dim, count, words) in _RAGGED_ARRAYS.items():
        parts = [stored_arrays(motion.si)[name] for motion in motions.values()]
        present = [part for part in parts if part is not None]
        if not present:
            continue
        if words:
            counts = np.array([0 if part is None else len(part) for part in parts])
            attributes = {"long_name": f"number of {words}", "units": str(Unit.ONE)}
            dataset[count] = (MOTION, counts, attributes)
        dataset[count].attrs["sample_dimension"] = dim
        dims = (dim,) if present[0].ndim == 1 else (dim, "power")
        attributes = {"units": str(Unit.METRE_PER_SECOND_SQUARED), "long_name": LONG_NAMES[name]}
        dataset[name] = (dims, np.concatenate(present), attributes)
        dataset[name].encoding["_FillValue"] = None
    labels = {"long_name": "ground motion"}
    dataset = dataset.assign_coords({MOTION: (MOTION, list(motions), labels)})
    dataset[MOTION].encoding["_FillValue"] = None
    return dataset


def stored_motions(dataset: xr.Dataset) -> tuple[dict[str, GroundMotion], dict[str, Any]]:
    """Read what :func:`suite_dataset` wrote."""
    if dataset.attrs.get("kind") != _KIND:
        title = dataset.attrs.get("title", "a dataset of another kind")
        msg = f"found {title!r}; expected a dataset of MotionSuite.to_dataset"
        raise SchemaError(msg)
    try:
        motions = _motions(dataset)
        attributes: dict[str, Any] = {
            "verticals": int(dataset.attrs["verticals"]),
            "unread": dict(json.loads(dataset.attrs["unread"])),
            "remarks": tuple(json.loads(dataset.attrs["remarks"])),
        }
        if _TARGET in dataset.attrs:
            attributes[_TARGET] = _target_of(_mapping(dataset.attrs[_TARGET]))
    except (KeyError, TypeError, ValueError, ComponentError, AttributeError) as problem:
        if isinstance(problem, SchemaError):
            raise
        reason = f"there is no {problem}" if isinstance(problem, KeyError) else problem
        msg = f"found a suite that cannot be read ({reason}); expected {_EXPECTED}"
        raise SchemaError(msg) from problem
    return motions, attributes


def _table_of(target: TargetSpectrum) -> dict[str, Any]:
    """Return a target as a table: at its own periods, or at many if it is a formula."""
    logarithms = getattr(target.shape, "logarithms", None)
    low, high = np.clip(target.limits, *_STORED_BAND)
    seconds = (
        np.geomspace(low, high, _PERIODS) if logarithms is None else np.exp(np.array(logarithms))
    )
    values = target.at_seconds(seconds, owner=_TARGET)
    spread = None if target.deviation is None else target.deviations_at(seconds).tolist()
    table = {"periods": seconds.tolist(), "accelerations": values.tolist()}
    return {
        **table, "standard_deviations": spread, "damping_ratio": target.damping_ratio,
        "name": target.name,
    }  # fmt: skip


def _target_of(table: Mapping[str, Any]) -> TargetSpectrum:
    """Read a target from its table."""
    items = dict(table)
    periods = items.pop("periods"), str(Unit.SECOND)
    values = items.pop("accelerations"), str(Unit.METRE_PER_SECOND_SQUARED)
    return TargetSpectrum.from_table(periods, values, **items)


def is_stored_suite(source: Source) -> bool:
    """Return whether a file is a netCDF file of a suite."""
    if not is_netcdf(source):
        return False
    try:
        with opened_netcdf(source, _EXPECTED) as file:
            return getattr(file, "kind", None) == _KIND
    except RecordError:  # damaged: the reader of motions reports it
        return False


def stored_suite(source: Source, read: Callable[[xr.Dataset], Suite]) -> Suite:
    """Read the netCDF file of a suite."""
    from xarray.backends import NetCDF4DataStore

    try:
        with opened_netcdf(source, _EXPECTED) as file:
            # a file may declare more than it holds
            total = sum(math.prod(map(int, variable.shape)) for variable in file.variables.values())
            if total > _MAX_NUMBERS:
                expected = f"a suite of at most {_MAX_NUMBERS} numbers"
                raise source.refuse(found=f"{total} numbers declared", expected=expected)
            dataset = xr.open_dataset(NetCDF4DataStore(file), decode_times=False)
            return read(dataset.load())
    except SchemaError as problem:
        raise source.refuse(found=str(problem), expected=_EXPECTED) from problem


def _motions(dataset: xr.Dataset) -> dict[str, GroundMotion]:
    labels = [str(label) for label in dataset[MOTION].to_numpy()]
    texts = {
        name: [str(text) for text in dataset[name].to_numpy()] for name in _TEXTS if name in dataset
    }
    parts = {name: _split_samples(dataset, name, len(labels)) for name in _RAGGED_ARRAYS}
    steps = dataset["time_step"].to_numpy()
    motions: dict[str, GroundMotion] = {}
    for k, label in enumerate(labels):
        step = float(steps[k])
        samples, *others = (parts[name][k] for name in _RAGGED_ARRAYS)
        if samples is None:
            msg = f"{label!r} has no samples"
            raise SchemaError(msg)
        history = texts["history"][k]
        recipe = texts["recipe"][k]
        motion = GroundMotion(
            motion_of_arrays(step, samples, *others),
            name=texts.get(_NAME, labels)[k],  # former files have labels only
            metadata=_mapping(texts["metadata"][k]),
            history=tuple(history.split("\n")) if history else (),
            recipe=_mapping(recipe) if recipe else None,
        )
        if motion.sha256 != texts["motion_sha256"][k]:
            msg = f"found samples of {label!r} that were changed since; expected those written"
            raise SchemaError(msg)
        motions[label] = motion
    return motions


def _split_samples(dataset: xr.Dataset, name: str, count: int) -> list[np.ndarray | None]:
    """Cut the samples of all motions into those of each."""
    if name not in dataset.variables:
        return [None] * count
    values = dataset[name].to_numpy()
    if name.endswith("_pieces") and values.shape[1:] != (COEFFICIENTS,):
        msg = f"{name!r} has the shape {values.shape}"
        raise SchemaError(msg)
    counts = [int(size) for size in dataset[_RAGGED_ARRAYS[name][1]].to_numpy()]
    if min(counts) < 0 or sum(counts) != len(values):
        msg = f"{name!r} has {len(values)} rows, but its counts add up to {sum(counts)}"
        raise SchemaError(msg)
    ends = np.cumsum(counts)
    return [
        values[end - size : end] if size else None for size, end in zip(counts, ends, strict=True)
    ]


def _mapping(text: str) -> Mapping[str, Any]:
    loaded: object = json.loads(text)
    if not isinstance(loaded, dict):
        msg = "a text that is not a JSON object"
        raise SchemaError(msg)
    return dict(loaded)
