"""What a measured history shows without a model: its swings, and how their peaks decay."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from rockframe.errors import ComponentError
from rockframe.identification.measured import History, MeasuredPeaks
from rockframe.signals.arrays import Array

_LEVEL: Final = 0.1
"""Share of the first rotation that a swing must exceed: what is smaller may be noise."""
_TOP: Final = 0.8
"""Share of a swing's peak above which a parabola is laid through the samples."""
_FEWEST: Final = 5
"""Samples that such a parabola needs."""


@dataclass(frozen=True)
class Swings:
    """The swings of a measured history."""

    # the release and the peak of every complete swing after it. That of the release has no time: it
    # stands in a plateau, or at the first sample
    peaks: MeasuredPeaks
    crossing: float  # when the rotation first passes through zero [s]
    # median after that, which a rotation that dies out has where the gauge reads zero [rad]
    offset: float


def swings_of(history: History, owner: str) -> Swings:
    """Find the swings of a measured history."""
    time, rotation = history.time, history.rotation
    offset = _offset(rotation)
    swing = rotation - offset
    first = float(np.median(swing[:3]))
    side = np.where(np.abs(swing) > _LEVEL * abs(first), np.sign(swing), 0.0)
    marked = np.flatnonzero(side)
    turns = np.flatnonzero(np.diff(side[marked]))
    if turns.size == 0 or first == 0.0:
        msg = (
            f"{owner}: nothing rocks: the measured rotation, from {rotation[0]:.6g} rad at the "
            "start, never passes to the other side; give a history of a block that was tilted "
            "and let go"
        )
        raise ComponentError(msg)
    before, after = marked[turns[0]], marked[turns[0] + 1]
    share = swing[before] / (swing[before] - swing[after])
    crossing = float(time[before] + share * (time[after] - time[before]))
    sizes, times = [float(rotation[0])], [math.nan]
    # the last swing may be cut off
    for start, end in zip(marked[turns[:-1] + 1], marked[turns[1:]], strict=True):
        inside = slice(int(start), int(end) + 1)
        when, size = _top(time[inside], swing[inside])
        times.append(when)
        sizes.append(size + offset)
    rotation = np.array(sizes)
    return Swings(
        MeasuredPeaks(rotation, np.sign(rotation - offset), np.array(times)), crossing, offset
    )


def restitution_of(peaks: Array, theta: Array, pull: Array, *, small_rotation: bool) -> float:
    """Give the restitution with which peaks decay on rigid ground.

    By :eq:`eq-rigid-decay`, with the overturning angle of the side of each peak, and the pull of
    gravity on the corner there, p^2, over that of any corner.
    """
    size = np.clip(np.abs(peaks), 1e-9 * theta, theta)
    if small_rotation:
        energy, slope = size * (theta - 0.5 * size), theta - size
    else:
        energy = 2.0 * np.sin(theta - 0.5 * size) * np.sin(0.5 * size)
        slope = np.sin(theta - size)
    weights = energy / np.maximum(slope, 1e-3 * theta)
    gradient = np.polyfit(np.arange(size.size), np.log(pull * energy), 1, w=weights)[0]
    return float(math.exp(0.5 * gradient))


def _offset(rotation: Array) -> float:
    """Give the median after the first swing has begun."""
    first = float(np.median(rotation[:3]))
    left = np.flatnonzero(rotation * np.sign(first) < 0.5 * abs(first))
    return float(np.median(rotation[left[0] :])) if left.size else 0.0


def _top(time: Array, swing: Array) -> tuple[float, float]:
    """Give time and rotation of a swing's peak, of a parabola where there are samples for it."""
    highest = int(np.argmax(np.abs(swing)))
    when, size = float(time[highest]), float(swing[highest])
    near = np.flatnonzero(np.abs(swing) > _TOP * abs(size))
    if near.size < _FEWEST:
        return when, size
    along = time[near] - when
    square, slope, value = (float(one) for one in np.polyfit(along, swing[near], 2))
    if square * size >= 0.0 or not along[0] <= -0.5 * slope / square <= along[-1]:
        return when, size
    return when - 0.5 * slope / square, value - 0.25 * slope * slope / square
