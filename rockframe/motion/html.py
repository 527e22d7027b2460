"""Motions as notebooks show them."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rockframe.constants import STANDARD_GRAVITY
from rockframe.motion.shown_name import shown_name
from rockframe.notebook import card, curve

if TYPE_CHECKING:
    from rockframe.motion.value import MotionValue

_TOLD: tuple[str, ...] = ("event", "station", "component")
"""Metadata that stand on a card, where a file told them."""


def motion_html(motion: "MotionValue") -> str:
    """Give name, curve and numbers of a motion as HTML."""
    si = motion.si
    samples = np.asarray(si.horizontal.samples)
    rows: dict[str, Any] = {
        "peak": peak_words(motion),
        "duration": f"{(samples.size - 1) * si.time_step:.6g} s",
        "samples": f"{samples.size}, each {si.time_step:.6g} s",
    }
    if si.vertical is not None:
        upwards = float(np.abs(np.asarray(si.vertical.samples)).max(initial=0.0))
        rows["vertical peak"] = _in_gravity(upwards)
    rows |= {name: str(motion.metadata[name]) for name in _TOLD if name in motion.metadata}
    drawn = curve(samples.tolist())
    title = f"{type(motion).__name__}: {shown_name(motion.name, motion.history)}"
    return f"<div>{card(title, rows)}{drawn}</div>"


def peak_words(motion: "MotionValue") -> str:
    """Tell the largest horizontal acceleration."""
    samples = np.asarray(motion.si.horizontal.samples)
    return _in_gravity(float(np.abs(samples).max(initial=0.0)))


def _in_gravity(peak: float) -> str:
    return f"{peak:.4g} m/s² ({peak / STANDARD_GRAVITY:.3g} g)"
