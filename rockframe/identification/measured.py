"""Measured data, read and checked: a history of the rotation with its swings, or peaks."""

import math
import re
from dataclasses import dataclass
from typing import Any, Final, cast

import numpy as np
import pandas as pd
import pint
import xarray as xr

from rockframe.errors import ComponentError, UnitsError, short_repr
from rockframe.signals.arrays import Array
from rockframe.system.bodies import OverturningAngles
from rockframe.units import (
    ANGLE,
    TIME,
    Measure,
    angle_words,
    attached_unit,
    check_attached_unit,
    to_si,
)

OWNER: Final = "fit_free_decay"
_HISTORY: Final = (
    "write measured=((times, 's'), (rotations, 'deg')), or give a DataArray over time with units, "
    "or a DataFrame with two columns such as 'time [s]' and 'rotation [deg]'"
)
_PEAKS: Final = (
    "write peaks=([6.0, 5.2, 4.6], 'deg'), or with their times peaks=((times, 's'), "
    "(rotations, 'deg'))"
)
_UNIT_IN_NAME: Final = re.compile(r".*\[(.+)\]\s*")


@dataclass(frozen=True)
class History:
    """A measured history of the rotation."""

    time: Array  # [s]
    rotation: Array  # [rad]

    @property
    def count(self) -> int:
        """Number of data."""
        return self.rotation.size

    @property
    def span(self) -> float:
        """Time from the first to the last sample [s]."""
        return float(self.time[-1] - self.time[0])


@dataclass(frozen=True)
class MeasuredPeaks:
    """Successive peaks of a rotation, of which the first is the release."""

    rotation: Array  # with signs or without, as they were measured [rad]
    sides: Array  # signs of `rotation`: all 1 where peaks are without signs
    time: Array | None = None  # NaN where a time is not known [s]

    @property
    def count(self) -> int:
        """Number of data."""
        return self.rotation.size + (0 if self.time is None else int(np.isfinite(self.time).sum()))

    @property
    def signed(self) -> bool:
        """Whether the peaks have signs, and are not absolute values."""
        return bool(np.any(np.diff(self.sides)))


def read_history(value: object) -> History:
    """Read a history of the rotation, with its times."""
    if isinstance(value, xr.DataArray):
        name = value.dims[0] if value.ndim == 1 else None
        if name is None or name not in value.coords:
            msg = (
                f"{OWNER}: measured needs one dimension with times as its coordinate, got "
                f"{short_repr(value)}; {_HISTORY}"
            )
            raise ComponentError(msg)
        return History(*_times_and_rotations(value[name], value))
    pair = _pair_of_arrays(value)
    if pair is None:
        msg = f"{OWNER}: measured needs times and rotations, got {short_repr(value)}; {_HISTORY}"
        raise UnitsError(msg)
    return History(*_times_and_rotations(*pair))


def read_peaks(value: object) -> MeasuredPeaks:
    """Read successive peaks of the rotation, with or without times."""
    pair = _pair_of_arrays(value)
    if pair is not None:
        times, rotation = _times_and_rotations(*pair)
        peaks = MeasuredPeaks(rotation, np.sign(rotation), times)
    elif isinstance(value, tuple | pint.Quantity):
        rotation = _read_array(cast("object", value), ANGLE, "peaks")
        peaks = MeasuredPeaks(rotation, np.sign(rotation))
    else:
        msg = f"{OWNER}: peaks needs rotations with a unit, got {short_repr(value)}; {_PEAKS}"
        raise UnitsError(msg)
    if peaks.rotation.size < 2:
        msg = f"{OWNER}: found one peak, the release; expected those of the swings after it, too"
        raise ComponentError(msg)
    side_changes = np.diff(peaks.sides)
    if not np.all(peaks.sides) or (peaks.signed and not np.all(side_changes)):
        msg = (
            f"{OWNER}: peaks must alternate in sign, from one swing to the next, or all be given "
            f"without a sign, and none be zero; got {short_repr(peaks.rotation.tolist())} rad"
        )
        raise ComponentError(msg)
    return peaks


def check_below_overturning(measured: History | MeasuredPeaks, angles: OverturningAngles) -> None:
    """Refuse rotations at or beyond overturning, and those of unknown side."""
    if isinstance(measured, MeasuredPeaks) and not measured.signed and angles.left != angles.right:
        msg = (
            f"{OWNER}: peaks without their signs do not tell the sides of an eccentric block; give "
            "them with their signs, negative to the left"
        )
        raise ComponentError(msg)
    theta = np.where(measured.rotation < 0.0, angles.left, angles.right)
    beyond = np.flatnonzero(np.abs(measured.rotation) >= theta)
    if beyond.size:
        first = int(beyond[0])
        datum = f"peak {first + 1}"
        if isinstance(measured, History):
            datum = f"the rotation measured at {measured.time[first]:.6g} s"
        angle, limit = (angle_words(float(values[first])) for values in (measured.rotation, theta))
        msg = (
            f"{OWNER}: {datum} is {angle}, not below the overturning angle "
            f"{limit}; check the unit, and the size of the block"
        )
        raise ComponentError(msg)


def _pair_of_arrays(value: object) -> tuple[object, object] | None:
    """Return the two items of a pair of arrays with units, or None of anything else."""
    if isinstance(value, pd.DataFrame):  # with the units in the names of its columns
        units = [_UNIT_IN_NAME.fullmatch(str(name)) for name in value.columns]
        if len(units) != 2 or units[0] is None or units[1] is None:
            return None
        time, rotation = (value.iloc[:, number].to_numpy() for number in range(2))
        return (time, units[0][1]), (rotation, units[1][1])
    if not isinstance(value, tuple | list):
        return None
    items = cast("tuple[object, ...]", value)
    if len(items) != 2 or any(isinstance(item, str | float | int) for item in items):
        return None
    return items[0], items[1]


def _read_array(value: object, measure: Measure, name: str) -> Array:
    """Convert an array with a unit to SI units, and check it."""
    unit: object = None
    values: object = value
    if isinstance(value, xr.DataArray):
        values, unit = value.to_numpy(), attached_unit(value)
    elif isinstance(value, pint.Quantity):
        quantity = cast("Any", value)
        values, unit = quantity.magnitude, str(quantity.units)
    elif isinstance(value, tuple):
        pair = cast("tuple[object, ...]", value)
        if len(pair) == 2:
            values, unit = pair
            if isinstance(unit, str):
                check_attached_unit(values, unit, owner=OWNER, name=name)
    if not isinstance(unit, str):
        example = "s" if measure is TIME else "deg"
        msg = (
            f"{OWNER}: {name} needs an array with a unit such as {example}, got "
            f"{short_repr(value)}; write for example (values, {example!r})"
        )
        raise UnitsError(msg)
    factor = to_si(f"1 {unit}", measure, owner=OWNER, name=name)
    try:
        array: Any = np.ma.filled(np.ma.asarray(values, dtype=np.float64), math.nan)
    except (TypeError, ValueError) as problem:
        msg = f"{OWNER}: {name} needs numbers, got {short_repr(values)}"
        raise ComponentError(msg) from problem
    if array.ndim != 1 or array.size == 0:
        msg = f"{OWNER}: {name} needs a one-dimensional array of numbers, got {short_repr(values)}"
        raise ComponentError(msg)
    wrong = np.flatnonzero(~np.isfinite(array))
    if wrong.size:
        msg = (
            f"{OWNER}: {name} must be finite, got {float(array[wrong[0]])} at index "
            f"{int(wrong[0])}, one of {wrong.size} such; leave out samples that are missing"
        )
        raise ComponentError(msg)
    return factor * array


def _times_and_rotations(times: object, rotations: object) -> tuple[Array, Array]:
    """Read rotations and their times, which must increase."""
    time = _read_array(times, TIME, "time")
    rotation = _read_array(rotations, ANGLE, "rotation")
    if time.size != rotation.size:
        msg = f"{OWNER}: there are {time.size} times and {rotation.size} rotations"
        raise ComponentError(msg)
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if back.size:
        first = int(back[0])
        msg = (
            f"{OWNER}: times must increase, got {time[first]:.6g} s and then "
            f"{time[first + 1]:.6g} s at index {first + 1}"
        )
        raise ComponentError(msg)
    return time, rotation


_MIN_SWING: Final = 0.1
"""Share of the first rotation that a swing must exceed: smaller ones may be noise."""
_PARABOLA_SHARE: Final = 0.8
"""Share of a swing's peak above which a parabola is fitted to the samples."""
_MIN_SAMPLES: Final = 5
"""Least number of samples for such a parabola."""


@dataclass(frozen=True)
class Swings:
    """The swings of a measured history, or of measured peaks."""

    # the release and the peaks of all complete swings after it; the release has no time, since the
    # rotation is constant before it, or it precedes the first sample
    peaks: MeasuredPeaks
    crossing: float = math.nan  # time at which the rotation first passes through zero [s]
    # median of the rotation from the first swing on, the reading of the gauge at rest [rad]
    offset: float = 0.0


def swings_of(history: History) -> Swings:
    """Find the swings of a measured history."""
    time, rotation = history.time, history.rotation
    first = float(np.median(rotation[:3]))
    # the offset is the median after the rotation first falls below half its initial value
    decayed = np.flatnonzero(rotation * np.sign(first) < 0.5 * abs(first))
    offset = float(np.median(rotation[decayed[0] :])) if decayed.size else 0.0
    swing = rotation - offset
    first = float(np.median(swing[:3]))
    side = np.where(np.abs(swing) > _MIN_SWING * abs(first), np.sign(swing), 0.0)
    marked = np.flatnonzero(side)
    side_changes = np.flatnonzero(np.diff(side[marked]))
    if side_changes.size == 0 or first == 0.0:
        msg = (
            f"{OWNER}: nothing rocks: the measured rotation, from {rotation[0]:.6g} rad at the "
            "start, never passes to the other side; give a history of a block that was tilted "
            "and released"
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
    peaks = np.array(sizes)
    measured = MeasuredPeaks(peaks, np.sign(peaks - offset), np.array(times))
    return Swings(measured, crossing, offset)


def restitution_of(
    peaks: Array, theta: Array, frequency_ratio: Array, *, small_rotation: bool
) -> float:
    """Estimate restitution from the decay of peaks on rigid ground, :eq:`eq-rigid-decay`.

    `theta` is the overturning angle on the side of each peak, and `frequency_ratio` is p^2 about
    the corner on that side over p^2 about the right one.
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


def _peak_of_swing(time: Array, swing: Array) -> tuple[float, float]:
    """Return time and rotation of a swing's peak, by a parabola where it has enough samples."""
    highest = int(np.argmax(np.abs(swing)))
    when, size = float(time[highest]), float(swing[highest])
    near = np.flatnonzero(np.abs(swing) > _PARABOLA_SHARE * abs(size))
    if near.size < _MIN_SAMPLES:
        return when, size
    along = time[near] - when
    square, slope, value = (float(coefficient) for coefficient in np.polyfit(along, swing[near], 2))
    if square * size >= 0.0 or not along[0] <= -0.5 * slope / square <= along[-1]:
        return when, size
    return when - 0.5 * slope / square, value - 0.25 * slope * slope / square
