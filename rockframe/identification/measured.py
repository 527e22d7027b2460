"""Measured data, read and checked: a history of the rotation, or its peaks."""

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
from rockframe.units import ANGLE, TIME, Measure, angle_words, check_attached_unit, to_si

OWNER: Final = "fit_free_decay"
_EXAMPLE_UNITS: Final = {"rotation": "deg", "time": "s"}
_HISTORY: Final = (
    "write measured=((times, 's'), (rotations, 'deg')), or give a DataArray over time with units, "
    "or a DataFrame with two columns such as 'time [s]' and 'rotation [deg]'"
)
_PEAKS: Final = (
    "write peaks=([6.0, 5.2, 4.6], 'deg'), or with their times peaks=((times, 's'), "
    "(rotations, 'deg'))"
)


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
        return bool(self.sides[0] != self.sides[-1] or np.any(np.diff(self.sides)))


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
        angle, limit = (angle_words(float(one[first])) for one in (measured.rotation, theta))
        msg = (
            f"{OWNER}: {_datum_words(measured, first)} is {angle}, not below the overturning angle "
            f"{limit}; check the unit, and the size of the block"
        )
        raise ComponentError(msg)


def _pair_of_arrays(value: object) -> tuple[object, object] | None:
    """Return the two items of a pair of arrays with units, or None of anything else."""
    if isinstance(value, pd.DataFrame):
        return _pair_of_columns(value)
    if not isinstance(value, tuple | list):
        return None
    items = cast("tuple[object, ...]", value)
    if len(items) != 2 or any(isinstance(item, str | float | int) for item in items):
        return None
    return items[0], items[1]


_UNIT_IN_NAME: Final = re.compile(r".*\[(.+)\]\s*")


def _pair_of_columns(frame: pd.DataFrame) -> tuple[object, object] | None:
    """Return both columns of a DataFrame, with the units in their names."""
    units = [_UNIT_IN_NAME.fullmatch(str(name)) for name in frame.columns]
    if len(units) != 2 or units[0] is None or units[1] is None:
        return None
    time, rotation = (frame.iloc[:, number].to_numpy() for number in range(2))
    return (time, units[0][1]), (rotation, units[1][1])


def _read_array(value: object, measure: Measure, name: str) -> Array:
    """Convert an array with a unit to SI units, and check it."""
    unit: object = None
    values: object = value
    if isinstance(value, xr.DataArray):
        values, unit = value.to_numpy(), value.attrs.get("units")
        if unit is None and isinstance(value.data, pint.Quantity):
            values, unit = value.data.magnitude, str(value.data.units)
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
        example = _EXAMPLE_UNITS["time" if measure is TIME else "rotation"]
        msg = (
            f"{OWNER}: {name} needs an array with a unit such as {example}, got "
            f"{short_repr(value)}; "
            f"write for example (values, {example!r})"
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


def _datum_words(measured: History | MeasuredPeaks, index: int) -> str:
    if isinstance(measured, History):
        return f"the rotation measured at {measured.time[index]:.6g} s"
    return f"peak {index + 1}"
