"""Swings of a measured history, and the decay of their peaks, found without a model."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from rockframe.errors import ComponentError
from rockframe.identification.measured import OWNER, History, MeasuredPeaks
from rockframe.signals.arrays import Array

_MIN_SWING: Final = 0.1
"""Share of the first rotation that a swing must exceed: smaller ones may be noise."""
_PARABOLA_SHARE: Final = 0.8
"""Share of a swing's peak above which a parabola is fitted to the samples."""
_MIN_SAMPLES: Final = 5
"""Least number of samples for such a parabola."""


@dataclass(frozen=True)
class Swings:
    """The swings of a measured history."""

    # the release and the peaks of all complete swings after it; the release has no time, since the
    # rotation is constant before it, or it precedes the first sample
    peaks: MeasuredPeaks
    crossing: float  # time at which the rotation first passes through zero [s]
    # median of the rotation from the first swing on, the reading of the gauge at rest [rad]
    offset: float


def swings_of(history: History) -> Swings:
    """Find the swings of a measured history."""
    time, rotation = history.time, history.rotation
    offset = _offset(rotation)
    swing = rotation - offset
    first = float(np.median(swing[:3]))
    side = np.where(np.abs(swing) > _MIN_SWING * abs(first), np.sign(swing), 0.0)
    marked = np.flatnonzero(side)
    side_changes = np.flatnonzero(np.diff(side[marked]))
    if side_changes.size == 0 or first == 0.0:
        msg = (
            f"{OWNER}: nothing rocks: the measured rotation, from {rotation[0]:.6g} rad at the "
            "start, never passes to the other side; give a history of a block that was tilted "
            "and let go"
        )
        raise ComponentError(msg)
    before, after = marked[side_changes[0]], marked[side_changes[0] + 1]
    share = swing[before] / (swing[before] - swing[after])
    crossing = float(time[before] + share * (time[after] - time[before]))
    sizes, times = [float(rotation[0])], [math.nan]
    # without the last swing, which may be incomplete
    for start, end in zip(marked[side_changes[:-1] + 1], marked[side_changes[1:]], strict=True):
        inside = slice(int(start), int(end) + 1)
        when, size = _peak_of_swing(time[inside], swing[inside])
        times.append(when)
        sizes.append(size + offset)
    rotation = np.array(sizes)
    return Swings(
        MeasuredPeaks(rotation, np.sign(rotation - offset), np.array(times)), crossing, offset
    )


def restitution_of(
    peaks: Array, theta: Array, frequency_ratio: Array, *, small_rotation: bool
) -> float:
    """Estimate the coefficient of restitution from the decay of peaks on rigid ground.

    The estimate is by :eq:`eq-rigid-decay`. `theta` is the overturning angle on the side of each
    peak, and `frequency_ratio` is p^2 about the corner on that side over p^2 about the right one.
    """
    size = np.clip(np.abs(peaks), 1e-9 * theta, theta)
    if small_rotation:
        energy, slope = size * (theta - 0.5 * size), theta - size
    else:
        energy = 2.0 * np.sin(theta - 0.5 * size) * np.sin(0.5 * size)
        slope = np.sin(theta - size)
    weights = energy / np.maximum(slope, 1e-3 * theta)
    gradient = np.polyfit(np.arange(size.size), np.log(frequency_ratio * energy), 1, w=weights)[0]
    return float(math.exp(0.5 * gradient))


def _offset(rotation: Array) -> float:
    """Return the median of the rotation after it first falls below half its initial value."""
    first = float(np.median(rotation[:3]))
    decayed = np.flatnonzero(rotation * np.sign(first) < 0.5 * abs(first))
    return float(np.median(rotation[decayed[0] :])) if decayed.size else 0.0


def _peak_of_swing(time: Array, swing: Array) -> tuple[float, float]:
    """Return time and rotation of a swing's peak, by a parabola where it has enough samples."""
    highest = int(np.argmax(np.abs(swing)))
    when, size = float(time[highest]), float(swing[highest])
    near = np.flatnonzero(np.abs(swing) > _PARABOLA_SHARE * abs(size))
    if near.size < _MIN_SAMPLES:
        return when, size
    along = time[near] - when
    square, slope, value = (float(one) for one in np.polyfit(along, swing[near], 2))
    if square * size >= 0.0 or not along[0] <= -0.5 * slope / square <= along[-1]:
        return when, size
    return when - 0.5 * slope / square, value - 0.25 * slope * slope / square
