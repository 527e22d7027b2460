"""Tapers: smooth beginnings and ends."""

from __future__ import annotations

import numpy as np

from rockframe.signals.arrays import Array


def tapered(samples: Array, intervals: float) -> Array:
    """Let a motion grow from zero and fade to zero along half a cosine."""
    place = np.arange(samples.size)
    from_end = np.minimum(place, samples.size - 1 - place)
    share = np.minimum(from_end / intervals, 1.0)
    return samples * np.sin(0.5 * np.pi * share) ** 2
