"""A ground motion as a description and as a dataset, and back."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.arguments import checked_bool, checked_dataset
from rockframe.constants import CONVENTIONS
from rockframe.errors import SchemaError, did_you_mean, short_repr
from rockframe.motion.constructors.analytic import PULSES
from rockframe.motion.value import UNNAMED, MotionType, MotionValue
from rockframe.records import LONG_NAMES, motion_of_arrays, stored_arrays, stored_motion
from rockframe.signals import Signal
from rockframe.units import Unit

CONSTRUCTORS: Final = (*PULSES, "stochastic")
"""Constructors that a description may name."""

OPERATIONS: Final = (
    "window",
    "scaled",
    "resampled",
    "filtered",
    "baseline_corrected",
    "with_vertical",
    "rotated",
    "through_storeys",
)
"""Operations that a description may name."""


def to_dict(motion: MotionValue, *, samples: bool = False) -> dict[str, Any]:
    """Describe the motion: an analytic one completely, a record by its digest.

    Parameters
    ----------
    samples : bool
        Whether the description of a record contains its samples, metadata and history.

    Returns
    -------
    dict
        Values for JSON: constructor and arguments of an analytic motion, with the
        ``operations`` on it since; ``constructor`` is None for a motion that is known by its
        samples only.

    Examples
    --------
    >>> import rockframe as rf
    >>> rf.GroundMotion.half_sine_pulse("3 m/s^2", "0.5 s").to_dict()["constructor"]
    'half_sine_pulse'
    """
    kind = {"type": type(motion).__name__}
    if motion.recipe is not None:
        return {**kind, **motion.recipe}
    known = {**kind, "constructor": None, "name": motion.name, "sha256": motion.sha256}
    if not checked_bool(samples, owner=f"{type(motion).__name__}.to_dict", name="samples"):
        return known
    return {
        **known,
        "metadata": dict(motion.metadata),
        "history": list(motion.history),
        "time_step": motion.si.time_step,
        "horizontal": _signal_as_dict(motion.si.horizontal),
        "vertical": None if motion.si.vertical is None else _signal_as_dict(motion.si.vertical),
    }


def _signal_as_dict(signal: Signal) -> dict[str, list[Any]]:
    arrays = {"samples": signal.samples, "polynomials": signal.polynomials}
    return {name: array.tolist() for name, array in arrays.items() if array is not None}


def from_dict(kind: type[MotionType], description: Mapping[str, Any]) -> MotionType:
    """Build the motion from the result of :meth:`to_dict`.

    Parameters
    ----------
    description : mapping
        Result of :meth:`to_dict`.

    Returns
    -------
    GroundMotion

    Raises
    ------
    SchemaError
        The description is of a record without its samples, or does not fit a constructor.

    Examples
    --------
    >>> import rockframe as rf
    >>> pulse = rf.GroundMotion.half_sine_pulse("3 m/s^2", "0.5 s")
    >>> rf.GroundMotion.from_dict(pulse.to_dict()) == pulse
    True
    """
    if not isinstance(description, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance]
        msg = (
            f"{kind.__name__}.from_dict: found {short_repr(description)}; expected what to_dict "
            "gives"
        )
        raise SchemaError(msg)
    arguments = {key: value for key, value in description.items() if key != "type"}
    constructor = arguments.pop("constructor", None)
    if constructor is None and "horizontal" in arguments:
        return _from_samples(kind, arguments)
    operations = arguments.pop("operations", ())
    if constructor is None:
        known = " and ".join(
            f"{key} {arguments[key]}" for key in ("name", "sha256") if key in arguments
        )
        msg = (
            f"found only {known or 'a description'} of a record without its samples; read the "
            "record itself"
        )
        raise SchemaError(msg)
    if constructor not in CONSTRUCTORS:
        found = f"{short_repr(constructor)}{did_you_mean(constructor, CONSTRUCTORS)}"
        msg = f"found the constructor {found}; expected one of {', '.join(CONSTRUCTORS)}"
        raise SchemaError(msg)
    if constructor == "stochastic":
        # older descriptions leave out one corner, which was the default
        arguments.setdefault("source", "one corner")
    try:
        motion = getattr(kind, constructor)(**arguments)
        for operation in operations:
            name, values = _name_and_arguments(operation)
            if values.get("other") is not None:
                values = {**values, "other": from_dict(kind, values["other"])}
            motion = getattr(motion, name)(**values)
    except TypeError as problem:
        msg = f"found arguments that do not fit {constructor} or its operations: {problem}"
        raise SchemaError(msg) from problem
    return motion


def _name_and_arguments(operation: object) -> tuple[str, Mapping[str, Any]]:
    """Read one operation of a description."""
    if not isinstance(operation, Mapping) or len(operation) != 1:
        found = f"{short_repr(operation)}; expected one name with its arguments"
        msg = f"found the operation {found}, as in {{'scaled': {{'factor': 2}}}}"
        raise SchemaError(msg)
    ((name, values),) = operation.items()
    if name not in OPERATIONS:
        found = f"{short_repr(name)}{did_you_mean(name, OPERATIONS)}"
        msg = f"found the operation {found}; expected one of {', '.join(OPERATIONS)}"
        raise SchemaError(msg)
    if not isinstance(values, Mapping):
        found = f"{short_repr(values)}; expected names and values"
        msg = f"found the arguments of the operation {name!r} to be {found}"
        raise SchemaError(msg)
    return name, values


def _from_samples(kind: type[MotionType], description: Mapping[str, Any]) -> MotionType:
    """Build a motion from its samples, and compare these with the digest."""
    try:
        across, up = (_arrays(description[name] or {}) for name in ("horizontal", "vertical"))
        pieces = across.get("polynomials"), up.get("polynomials")
        motion = kind(
            motion_of_arrays(
                description["time_step"], across["samples"], up.get("samples"), *pieces
            ),
            name=description["name"],
            metadata=description["metadata"],
            history=tuple(description["history"]),
        )
        digest = description["sha256"]
    except (KeyError, TypeError, ValueError, AttributeError) as problem:
        msg = f"found a description that holds no ground motion: {problem}"
        raise SchemaError(msg) from problem
    if motion.sha256 != digest:
        msg = "found samples that differ from those of the digest 'sha256'; expected the same"
        raise SchemaError(msg)
    return motion


def _arrays(described: Mapping[str, Any]) -> dict[str, Any]:
    return {name: np.array(values, dtype=np.float64) for name, values in described.items()}


_PIECES_DIMS: Final = ("interval", "power")


def to_dataset(motion: MotionValue) -> xr.Dataset:
    """Convert the motion to a dataset that xarray can store.

    Returns
    -------
    xarray.Dataset
        ``acceleration`` (and ``vertical_acceleration``) over ``time``, with
        units, name, metadata and history.

    Examples
    --------
    >>> import rockframe as rf
    >>> rf.GroundMotion.half_sine_pulse("3 m/s^2", "0.5 s").to_dataset().sizes["time"]
    65
    """
    si = motion.si
    variables: dict[str, Any] = {
        name: (
            "time" if values.ndim == 1 else _PIECES_DIMS,
            values.copy(),
            {"units": str(Unit.METRE_PER_SECOND_SQUARED), "long_name": LONG_NAMES[name]},
        )
        for name, values in stored_arrays(si).items()
        if values is not None
    }
    time = np.arange(len(motion)) * si.time_step
    # no axis and no standard name: CF 4.4 reserves them for times since a date
    axis = {"units": str(Unit.SECOND), "long_name": "time from the first sample"}
    attributes: dict[str, str | float] = {
        "Conventions": CONVENTIONS,
        "title": f"Ground motion {motion.name}",
        "motion_name": motion.name,
        "motion_sha256": motion.sha256,
        "time_step": si.time_step,
        "metadata": json.dumps(dict(motion.metadata)),
    }
    if motion.history:
        attributes["history"] = "\n".join(motion.history)
    if motion.recipe is not None:
        attributes["recipe"] = json.dumps(dict(motion.recipe))
    dataset = xr.Dataset(variables, coords={"time": ("time", time, axis)}, attrs=attributes)
    for name in (*variables, "time"):
        dataset[name].encoding["_FillValue"] = None
    return dataset


def from_dataset(kind: type[MotionType], dataset: xr.Dataset) -> MotionType:
    """Build the motion from the result of :meth:`to_dataset`, identical bit for bit.

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset with ``acceleration`` over ``time``.

    Returns
    -------
    GroundMotion

    Raises
    ------
    SchemaError
        The dataset is not of this form, or its samples have been changed.

    Examples
    --------
    >>> import rockframe as rf
    >>> pulse = rf.GroundMotion.half_sine_pulse("3 m/s^2", "0.5 s")
    >>> rf.GroundMotion.from_dataset(pulse.to_dataset()) == pulse
    True
    """
    stored = stored_motion(checked_dataset(dataset, owner=f"{kind.__name__}.from_dataset"))
    return kind(**vars(replace(stored, name=stored.name or UNNAMED)))
