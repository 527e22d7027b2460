"""Conversion of arrays of quantities to SI units."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, NamedTuple, TypeAlias, TypeGuard, cast

import numpy as np
import numpy.typing as npt
import pint
import xarray as xr

from rockframe.errors import ComponentError, UnitsError, short_repr
from rockframe.records import acceleration_unit
from rockframe.signals.arrays import Array
from rockframe.units import (
    ACCELERATION,
    TIME,
    Quantity,
    check_attached_unit,
    foreign_quantity_hint,
    to_si,
)

ArrayLike: TypeAlias = Quantity | xr.DataArray | tuple[Sequence[float] | npt.NDArray[Any], str]

_EXAMPLE: Final = "(values, 'm/s^2')"


def accelerations_to_si(value: object, *, owner: str, name: str) -> Array:
    """Convert an argument to an array of accelerations [m s^-2]; raise an error otherwise."""
    if isinstance(value, xr.DataArray):
        if _is_quantity(value.data):
            return accelerations_to_si(value.data, owner=owner, name=name)
        unit: object = value.attrs.get("units")
        if not isinstance(unit, str):
            msg = (
                f"{owner}: {name} needs accelerations with a unit, got a DataArray without "
                f"a 'units' attribute; set for example {name}.attrs['units'] = 'm s-2'"
            )
            raise UnitsError(msg)
        return _scaled(value.values, _unit_factor(unit, owner, name, udunits=True), owner, name)
    if _is_quantity(value):
        argument = cast("Any", value)
        factor = to_si(type(argument)(1, argument.units), ACCELERATION, owner=owner, name=name)
        return _scaled(argument.magnitude, factor, owner, name)
    if _has_unit(value):
        check_attached_unit(value[0], value[1], owner=owner, name=name)
        return _scaled(value[0], _unit_factor(value[1], owner, name), owner, name)
    if isinstance(value, str):
        found = f"{short_repr(value)}, which is one value"
    else:
        found = foreign_quantity_hint(value) or f"a {type(value).__name__} without a unit"
    msg = (
        f"{owner}: {name} needs an array of accelerations with a unit such as "
        f"{ACCELERATION.unit}, got {found}; write for example {name}={_EXAMPLE}"
    )
    raise UnitsError(msg)


def times_to_si(value: object, *, owner: str, name: str) -> Array:
    """Convert an argument to an array of increasing times [s]; raise an error otherwise."""
    values: object
    factor = 1.0
    if getattr(getattr(value, "dtype", None), "kind", "") in {"m", "M"}:
        values = relative_seconds(value)
        if values is None:
            msg = f"{owner}: {name} needs two or more dates, and none missing"
            raise ComponentError(msg)
    elif isinstance(value, xr.DataArray):
        unit, _ = _unit_and_origin(value.attrs.get("units", ""))
        factor = to_si(f"1 {unit}", TIME, owner=owner, name=name)
        values = value.values
    elif _is_quantity(value):
        argument = cast("Any", value)
        factor = to_si(type(argument)(1, argument.units), TIME, owner=owner, name=name)
        values = argument.magnitude
    elif _has_unit(value):
        check_attached_unit(value[0], value[1], owner=owner, name=name)
        factor = to_si(f"1 {value[1]}", TIME, owner=owner, name=name)
        values = value[0]
    else:
        msg = (
            f"{owner}: {name} needs an array of times with a unit such as {TIME.unit}, got "
            f"{short_repr(value)}; write for example {name}=(values, 's')"
        )
        raise UnitsError(msg)
    times = _scaled(values, factor, owner, name)
    if times.size < 2 or not np.isfinite(times).all() or not (np.diff(times) > 0.0).all():
        msg = f"{owner}: {name} needs two or more finite times, in increasing order"
        raise ComponentError(msg)
    return times


def _unit_factor(unit: str, owner: str, name: str, *, udunits: bool = False) -> float:
    known = acceleration_unit(unit)
    if udunits and known is not None and known.spelling.endswith("/s^2"):
        return known.factor  # 'm s-2', 'm/s2': UDUNITS spellings, usual in attributes
    try:
        return to_si(f"1 {unit}", ACCELERATION, owner=owner, name=name)
    except UnitsError as problem:
        better = "m/s^2" if known is None else known.spelling
        msg = (
            f"{owner}: {name} needs the unit of an acceleration such as {ACCELERATION.unit}, "
            f"got {short_repr(unit)}; write for example {name}=(values, {better!r})"
        )
        raise UnitsError(msg) from problem


def _scaled(values: object, factor: float, owner: str, name: str) -> Array:
    if np.ma.isMaskedArray(values) and np.ma.getmaskarray(cast("Any", values)).any():
        msg = f"{owner}: {name} has masked samples; fill them in first"
        raise ComponentError(msg)
    try:
        array: npt.NDArray[Any] = np.asarray(values)
    except ValueError as problem:  # ragged
        msg = f"{owner}: {name} needs a one-dimensional array of numbers"
        raise ComponentError(msg) from problem
    if array.dtype.kind not in "fiu" or array.ndim != 1:
        msg = (
            f"{owner}: {name} needs a one-dimensional array of real numbers, "
            f"got {array.ndim} dimensions of {array.dtype}"
        )
        raise ComponentError(msg)
    with np.errstate(over="ignore"):
        return np.asarray(array, dtype=np.float64) * factor


def _is_quantity(value: object) -> bool:
    module: Any = pint  # pint.Quantity is generic, which strict type checkers cannot follow
    return isinstance(value, module.Quantity)


def _has_unit(value: object) -> TypeGuard[tuple[object, str]]:
    """Tell whether something is a pair of values and a unit."""
    return isinstance(value, tuple) and len(value) == 2 and isinstance(value[1], str)  # pyright: ignore[reportUnknownArgumentType]


def _unit_and_origin(unit: object) -> tuple[str, str]:
    """Divide the unit of times since a date, as UDUNITS writes it."""
    spelling, _, origin = str(unit).partition(" since ")
    return spelling, origin


class TimeAxis(NamedTuple):
    """Times of an array."""

    seconds: Array  # from the first time [s]
    start: float  # first time from the origin [s]
    origin: str  # what the start counts from, as far as the axis states it


def attached_times(value: object) -> TimeAxis | None:
    """Return the times that an array has itself: a time axis, or the index of a Series."""
    held = cast("tuple[object, ...]", value)[0] if isinstance(value, tuple) and value else value
    if isinstance(held, xr.DataArray):
        if held.dims != ("time",) or "time" not in held.coords:
            return None
        axis = held["time"]
        is_time = axis.dtype.kind in "iu" and "units" in axis.attrs  # else they may be row numbers
        times = axis.values.astype(np.float64) if is_time else axis.values
        return _time_axis(times, axis.attrs.get("units", "s"))
    if _is_quantity(held):
        held = cast("Any", held).magnitude
    index = getattr(held, "index", None)
    if not hasattr(held, "iloc") or index is None:  # no pandas Series
        return None
    return _time_axis(index, "s")


def relative_seconds(axis: object) -> Array | None:
    """Convert an axis, in seconds or dates, to seconds from its first time; None for another."""
    times = _time_axis(axis, "s")
    return None if times is None else times.seconds


def _time_axis(axis: object, unit: object) -> TimeAxis | None:
    """Read an axis in a unit, or of dates; None if it is no time axis."""
    value: Any = axis
    if getattr(getattr(axis, "dtype", None), "tz", None) is not None:
        import pandas as pd

        value = pd.DatetimeIndex(value).tz_convert("UTC").tz_localize(None)
    values: npt.NDArray[Any] = np.asarray(value)
    if values.ndim != 1 or values.size < 2:
        return None
    if values.dtype.kind in "mM":
        if np.isnat(values).any():
            return None
        second = np.timedelta64(1, "s")
        zero = np.zeros(1, values.dtype)
        return TimeAxis(
            (values - values[0]) / second, float((values[:1] - zero)[0] / second), values.dtype.kind
        )
    if values.dtype.kind != "f":
        return None
    spelling, origin = _unit_and_origin(unit)
    try:
        scale = to_si(f"1 {spelling}", TIME, owner="relative_seconds", name="unit")
    except UnitsError:  # such as numbers of samples
        return None
    seconds = (values - values[0]).astype(np.float64) * scale
    return TimeAxis(seconds, float(values[0]) * scale, origin)
