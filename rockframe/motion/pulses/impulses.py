"""Impulses of a stated, short length."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from rockframe.errors import ComponentError
from rockframe.motion.pulses.sampling import hermite_pieces
from rockframe.signals import Motion, Signal
from rockframe.signals.signal import MAXIMUM_SAMPLES

INTERVALS_PER_IMPULSE: Final = 16
"""Pieces per impulse. One would do, but the samples alone should show it, too."""

_ROUNDING: Final = 1e-9


def impulse_duration(*, interval: float, longest: float, owner: str) -> float:
    """Give the longest duration of which `interval` is a whole multiple."""
    if longest > interval:
        msg = (
            f"{owner}: pulse_duration = {longest:.6g} s must not exceed "
            f"interval = {interval:.6g} s; the impulses would overlap"
        )
        raise ComponentError(msg)
    if interval / longest * INTERVALS_PER_IMPULSE > MAXIMUM_SAMPLES:
        msg = (
            f"{owner}: pulse_duration = {longest:.6g} s is too short to be sampled over "
            f"interval = {interval:.6g} s"
        )
        raise ComponentError(msg)
    return interval / math.ceil(interval / longest * (1.0 - _ROUNDING))


def opposite_impulses(*, velocity: float, interval: float, duration: float) -> Motion:
    """Build two opposite impulses of the shape :eq:`eq-impulse`."""
    between = (round(interval / duration) - 1) * INTERVALS_PER_IMPULSE
    step = 1.0 / INTERVALS_PER_IMPULSE
    u = np.arange(INTERVALS_PER_IMPULSE + 1) * step
    height = 30.0 * velocity / duration
    with np.errstate(over="ignore", invalid="ignore"):
        value = height * (u * (1.0 - u)) ** 2
        slope = height * 2.0 * u * (1.0 - u) * (1.0 - 2.0 * u) * step
        curvature = height * 2.0 * (1.0 - 6.0 * u * (1.0 - u)) * step**2
        pieces = hermite_pieces(value, slope, curvature)
    rest = np.zeros((between, pieces.shape[1]))
    samples = np.concatenate([value[:-1], np.zeros(between + 1), -value[1:]])
    return Motion(Signal(duration * step, samples, np.concatenate([pieces, rest, -pieces])))
