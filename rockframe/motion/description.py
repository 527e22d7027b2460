"""A ground motion from its description; its name for readers; its HTML for notebooks."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from typing import Any, Final

import numpy as np

from rockframe.constants import STANDARD_GRAVITY
from rockframe.errors import SchemaError, did_you_mean, short_repr
from rockframe.motion.constructors.analytic import PULSES
from rockframe.motion.value import MotionType, MotionValue
from rockframe.notebook import html_summary, sparkline
from rockframe.signals import Motion, Signal
from rockframe.signals.motion import VERTICAL

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
        step, vertical_arrays = description["time_step"], description["vertical"]
        horizontal = Signal(step, **_arrays(description["horizontal"]))
        vertical = (
            None
            if vertical_arrays is None
            else Signal(step, **_arrays(vertical_arrays), name=VERTICAL)
        )
        motion = kind(
            Motion(horizontal, vertical),
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
