"""The name of a motion for readers, with what was done to it, and its HTML for notebooks."""

import math
import re
from collections.abc import Iterable, Mapping
from typing import Any, Final

import numpy as np

from rockframe.constants import STANDARD_GRAVITY
from rockframe.notebook import html_summary, sparkline
from rockframe.signals import Motion

HISTORY_SEPARATOR: Final = "; "
"""Separator between the steps of the history of a motion."""
_SCALED_STEP: Final = re.compile(r"scaled by (\S+)(?: to .*)?")
_PROCESSING_WORDS: Final = {
    "window from ": "cut",
    "tapered over ": "tapered",
    "resampled from ": "resampled",
    "Butterworth filter ": "filtered",
    "baseline corrected": "baseline corrected",
    "rotated by ": "rotated",
    "absolute acceleration of a floor": "at a floor",
    "the pulse alone": "the pulse alone",
    "the pulse taken out": "the pulse taken out",
}
"""Beginnings of the steps of a history that change a motion, and the words for its name."""
_FLOOR_STEP: Final = re.compile(r"absolute acceleration of a floor, floor (\d+) ")
_MATCHED_STEP: Final = re.compile(r"scaled by \S+ and matched to ")


def display_name(name: str, history: Iterable[str]) -> str:
    """Return the name of a motion, preceded by its factor and followed by its processing."""
    steps = list(history)
    factors = [_SCALED_STEP.fullmatch(step) for step in steps]
    factor = math.prod(float(match[1]) for match in factors if match is not None)
    named = ", ".join([name, *dict.fromkeys(filter(None, map(_processing_word, steps)))])
    return named if factor == 1.0 else f"{factor:.6g} times {named}"


def motion_words(attributes: Mapping[Any, Any]) -> str:
    """Return the name of a result's motion, and the factor by which it was scaled."""
    history = str(attributes.get("motion_history", "")).split(HISTORY_SEPARATOR)
    return display_name(str(attributes.get("motion", "")), history)


def _processing_word(step: str) -> str:
    """Return the word for a step of a history that changes a motion; nothing for another."""
    if _MATCHED_STEP.match(step):
        return "matched"
    if floor := _FLOOR_STEP.match(step):
        return f"at floor {floor[1]}"
    return next((words for start, words in _PROCESSING_WORDS.items() if step.startswith(start)), "")


_SHOWN_METADATA: tuple[str, ...] = ("event", "station", "component")
"""Metadata that notebooks show, if the file has them."""


def motion_html(title: str, si: Motion, metadata: Mapping[str, Any]) -> str:
    """Return title, curve and numbers of a motion as HTML."""
    samples = np.asarray(si.horizontal.samples)
    rows: dict[str, Any] = {
        "peak": peak_text(si),
        "duration": f"{(samples.size - 1) * si.time_step:.6g} s",
        "samples": f"{samples.size}, each {si.time_step:.6g} s",
    }
    if si.vertical is not None:
        vertical_peak = float(np.abs(np.asarray(si.vertical.samples)).max(initial=0.0))
        rows["vertical peak"] = _acceleration_text(vertical_peak)
    rows |= {name: str(metadata[name]) for name in _SHOWN_METADATA if name in metadata}
    return f"<div>{html_summary(title, rows)}{sparkline(samples.tolist())}</div>"


def peak_text(si: Motion) -> str:
    """Return the largest horizontal acceleration of the samples as a text."""
    samples = np.asarray(si.horizontal.samples)
    return _acceleration_text(float(np.abs(samples).max(initial=0.0)))


def _acceleration_text(peak: float) -> str:
    return f"{peak:.4g} m/s² ({peak / STANDARD_GRAVITY:.3g} g)"
