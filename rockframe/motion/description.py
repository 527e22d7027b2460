"""A ground motion as a description and as a dataset, and back; its name and HTML for readers."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.arguments import checked_bool, checked_dataset
from rockframe.constants import CONVENTIONS, STANDARD_GRAVITY
from rockframe.errors import SchemaError, did_you_mean, short_repr
from rockframe.motion.constructors.analytic import PULSES
from rockframe.motion.value import UNNAMED, MotionType, MotionValue
from rockframe.notebook import html_summary, sparkline
from rockframe.records import LONG_NAMES, motion_of_arrays, stored_arrays, stored_motion
from rockframe.signals import Signal
from rockframe.units import Unit

_SCALED_STEP: Final = re.compile(r"scaled by (\S+)(?: to .*)?")
_PROCESSING_WORDS: Final = {
    "window from ": "cut",
    "tapered over ": "tapered",
    "resampled from ": "resampled",
    "Butterworth filter ": "filtered",
    "baseline corrected": "baseline corrected",
    "rotated by ": "rotated",
    "absolute acceleration of a floor": "at a floor",
}
"""Beginnings of the steps of a history that change a motion, and the words for its name."""
_FLOOR_STEP: Final = re.compile(r"absolute acceleration of a floor, floor (\d+) ")
_MATCHED_STEP: Final = re.compile(r"scaled by \S+ and matched to ")


def display_name(name: str, history: Iterable[str]) -> str:
    """Return the name of a motion, preceded by its factor and followed by its processing."""
    steps = list(history)
    factors = [_SCALED_STEP.fullmatch(step) for step in steps]
    factor = math.prod(float(found[1]) for found in factors if found is not None)
    named = ", ".join([name, *dict.fromkeys(filter(None, map(_processing_word, steps)))])
    return named if factor == 1.0 else f"{factor:.6g} times {named}"


def _processing_word(step: str) -> str:
    """Return the word for a step of a history that changes a motion; nothing for another."""
    if _MATCHED_STEP.match(step):
        return "matched"
    if floor := _FLOOR_STEP.match(step):
        return f"at floor {floor[1]}"
    return next((words for start, words in _PROCESSING_WORDS.items() if step.startswith(start)), "")


_SHOWN_METADATA: tuple[str, ...] = ("event", "station", "component")
"""Metadata that notebooks show, if the file has them."""


def motion_html(motion: MotionValue) -> str:
    """Return name, curve and numbers of a motion as HTML."""
    si = motion.si
    samples = np.asarray(si.horizontal.samples)
    rows: dict[str, Any] = {
        "peak": peak_text(motion),
        "duration": f"{(samples.size - 1) * si.time_step:.6g} s",
        "samples": f"{samples.size}, each {si.time_step:.6g} s",
    }
    if si.vertical is not None:
        vertical_peak = float(np.abs(np.asarray(si.vertical.samples)).max(initial=0.0))
        rows["vertical peak"] = _acceleration_text(vertical_peak)
    rows |= {
        name: str(motion.metadata[name]) for name in _SHOWN_METADATA if name in motion.metadata
    }
    drawn = sparkline(samples.tolist())
    title = f"{type(motion).__name__}: {display_name(motion.name, motion.history)}"
    return f"<div>{html_summary(title, rows)}{drawn}</div>"


def peak_text(motion: MotionValue) -> str:
    """Return the largest horizontal acceleration of the samples as a text."""
    samples = np.asarray(motion.si.horizontal.samples)
    return _acceleration_text(float(np.abs(samples).max(initial=0.0)))


def _acceleration_text(peak: float) -> str:
    return f"{peak:.4g} m/s² ({peak / STANDARD_GRAVITY:.3g} g)"


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
            ((name, values),) = operation.items()
            if name not in OPERATIONS:
                found = f"{short_repr(name)}{did_you_mean(name, OPERATIONS)}"
                msg = f"found the operation {found}; expected one of {', '.join(OPERATIONS)}"
                raise SchemaError(msg)
            if values.get("other") is not None:
                values = {**values, "other": from_dict(kind, values["other"])}
            motion = getattr(motion, name)(**values)
    except TypeError as problem:
        msg = f"found arguments that do not fit {constructor} or its operations: {problem}"
        raise SchemaError(msg) from problem
    return motion


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
