"""The wavelets that are added to a motion: improved tapered cosines (Al Atik and Abrahamson)."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from rockframe.signals.arrays import Array

WIDTH: Final = 1.178
"""Width of the taper at a period of one second [s] (Al Atik and Abrahamson 2010)."""

WIDTH_POWER: Final = 0.93
"""Power of the period with which it grows [1] (the same)."""

REACH: Final = 4.0
"""Widths after which a wavelet is taken for over: 10^-7 of its height are left [1]."""

_ROOM: Final = 3.0
"""Widths for which there must be room before the end of the motion; else it is narrower [1]."""

_NARROWEST: Final = 0.5
"""Least width over the period, at which the wavelet still swings once to both sides [1]."""

_FADE: Final = 0.25
"""Share of the period in which what reaches an end of the motion fades [1]."""


class Wavelet(NamedTuple):
    """A wavelet at the samples of a motion."""

    first: int  # the sample at which it begins
    values: Array  # from there on; zero elsewhere [1]

    @property
    def samples(self) -> slice:
        """The samples where it is not zero."""
        return slice(self.first, self.first + self.values.size)


def width_of(period: float) -> float:
    """Compute the width of the taper, :eq:`eq-taper-width` [s]."""
    return WIDTH * period**WIDTH_POWER


def lead_of(period: float, damping_ratio: float) -> float:
    """Compute how long before the oscillator the wavelet peaks, :eq:`eq-wavelet-lead` [s]."""
    share = math.sqrt(1.0 - damping_ratio**2)
    return math.atan2(share, damping_ratio) * period / (2.0 * math.pi * share)


def wavelet_at(
    peak_time: float, period: float, damping_ratio: float, *, time_step: float, count: int
) -> Wavelet:
    """Make the wavelet under which an oscillator peaks at a time, :eq:`eq-tapered-cosine`."""
    duration = (count - 1) * time_step
    edge = _NARROWEST * period
    centre = min(max(peak_time - lead_of(period, damping_ratio), edge), duration - edge)
    room = min(centre, duration - centre)
    width = max(min(width_of(period), room / _ROOM), edge)
    first = max(math.ceil((centre - REACH * width) / time_step), 0)
    last = min(math.floor((centre + REACH * width) / time_step), count - 1)
    times = np.arange(first, last + 1) * time_step
    place = (times - centre) / width
    from_end = np.minimum(times, duration - times) / (_FADE * period)
    taper = np.exp(-(place**2)) * np.sin(0.5 * math.pi * np.clip(from_end, 0.0, 1.0)) ** 2
    frequency = 2.0 * math.pi / period * math.sqrt(1.0 - damping_ratio**2)
    cosine = np.cos(frequency * (times - centre))
    uneven = taper * place
    zeroth, first_moment, second = taper.sum(), uneven.sum(), uneven @ place
    driven, driven_unevenly = taper @ cosine, uneven @ cosine
    determinant = zeroth * second - first_moment**2
    mean = (second * driven - first_moment * driven_unevenly) / determinant
    slope = (zeroth * driven_unevenly - first_moment * driven) / determinant
    return Wavelet(first, taper * (cosine - mean - slope * place))
