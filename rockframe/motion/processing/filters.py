"""Butterworth filters."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from rockframe.signals.arrays import Array

_PADDING_PERIODS: Final = 1.5


def butterworth(
    dt: float,
    samples: Array,
    *,
    low: float | None,
    high: float | None,
    order: int,
    causal: bool = False,
    keep_padding: bool = False,
) -> Array:
    """Run a Butterworth filter over the zero-padded samples."""
    from scipy import signal as module

    signal: Any = module
    if low is None:
        corners: Any = high
        kind = "lowpass"
    elif high is None:
        corners, kind = low, "highpass"
    else:
        corners, kind = [low, high], "bandpass"
    sos = signal.butter(order, corners, btype=kind, fs=1.0 / dt, output="sos")
    lowest = min(corner for corner in (low, high) if corner is not None)
    padding = padding_samples(dt, lowest, order)
    rest = np.zeros(padding)
    if causal:  # at rest before the motion, which zeros would not change
        # but for one of them: a motion that starts with a jump rises to it from there
        once: Array = signal.sosfilt(sos, np.concatenate([[0.0], samples, rest]))
        return once if keep_padding else once[1 : samples.size + 1]
    padded = np.concatenate([rest, samples, rest])
    result: Array = signal.sosfiltfilt(sos, padded, padtype=None)
    return result if keep_padding else result[padding : padding + samples.size]


def padding_samples(dt: float, lowest: float, order: int) -> int:
    """Count the zeros to put at each end: 1.5 order/f of the lowest corner."""
    return math.ceil(_PADDING_PERIODS * order / (lowest * dt))
