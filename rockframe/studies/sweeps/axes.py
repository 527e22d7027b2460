"""Axes of a sweep, their values, and the resulting cases."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, partial
from numbers import Real
from typing import Any, Final, cast

import numpy as np
import pint
import xarray as xr

from rockframe.arguments import json_attribute
from rockframe.errors import ComponentError, UnitsError, short_repr
from rockframe.results.variables.studies import CASE, MOTION
from rockframe.signals.arrays import AnyArray, Array
from rockframe.simulation.provenance import SYSTEM_AXES as SYSTEM_AXES
from rockframe.simulation.provenance import Changes as Changes
from rockframe.units import (
    Measure,
    Unit,
    attached_unit,
    check_attached_unit,
    decimal_products,
    read_number,
    to_ratio,
    to_si_values,
)

OWNER: Final = "sweep"


@dataclass(frozen=True, eq=False)
class Axis:
    """Something that varies from case to case."""

    name: str  # as the user wrote it; the dimension, or the column, of the result
    values: AnyArray  # numbers in SI units, or words
    unit: str | None  # of the numbers; None for words and truth values
    long_name: str  # what it is
    changes: Changes  # what the values change
    parameter: str  # which parameter, option or argument
    slot: str = ""  # of the part whose parameter it is; empty otherwise

    def attributes(self) -> dict[str, str]:
        """Return the CF attributes of the coordinate."""
        unit = {} if self.unit is None else {"units": self.unit}
        return {"long_name": self.long_name, **unit}

    def to_dict(self) -> dict[str, str | None]:
        """Return all but the values, fit for JSON."""
        described = vars(self) | {"changes": str(self.changes)}
        return {name: value for name, value in described.items() if name != "values"}

    @classmethod
    def from_dict(cls, described: Mapping[str, Any], values: AnyArray) -> "Axis":
        """Return the axis that :meth:`to_dict` described."""
        return cls(values=values, **{**described, "changes": Changes(described["changes"])})


def described_axes(dataset: xr.Dataset, *, owner: str) -> list[Axis]:
    """Return the axes of a sweep, without their values; none of a run."""
    return json_attribute(
        dataset,
        "axes_json",
        lambda axes: [Axis.from_dict(axis, np.empty(0)) for axis in axes],
        owner=owner,
        default="[]",
    )


def read_numbers(value: object, measure: Measure, name: str, *, owner: str = OWNER) -> AnyArray:
    """Read the values of an axis that has a unit, or is a pure number."""
    value = _with_own_unit(value)
    if measure.unit == Unit.ONE:
        if (pair := _values_and_unit(value)) is not None:
            check_attached_unit(*pair, owner=owner, name=name)
            factor = to_ratio(f"1 {pair[1]}", owner=owner, name="unit")
            if np.ma.isMaskedArray(pair[0]) and np.ma.getmaskarray(pair[0]).any():
                msg = f"{owner}: {name} has masked values; fill them in first"
                raise ComponentError(msg)
            value = decimal_products([float(number) for number in as_list(pair[0])], factor)
        numbers = as_list(_as_python(value))
        if not all(type(number) is float and math.isfinite(number) for number in numbers):
            read = partial(to_ratio, owner=owner, name=name, example=measure.example)
            numbers = [read(number) for number in numbers]
    else:
        _refuse_bare_numbers(value, measure, name, owner)
        numbers = to_si_values(_as_python(value), measure, owner=owner, name=name)
    return np.array(numbers, dtype=np.float64)


def _with_own_unit(value: object) -> object:
    """Return an array that has an attribute ``units`` with that unit, and an iterator as a list."""
    if isinstance(value, Iterator):
        return list(cast("Iterator[object]", value))
    unit = None if isinstance(value, pint.Quantity | tuple) else attached_unit(value)
    return value if unit in (None, "", str(Unit.ONE)) else (value, unit)


def _refuse_bare_numbers(value: object, measure: Measure, name: str, owner: str) -> None:
    """Refuse numbers without a unit, and say how to give several numbers a unit."""
    first = next(iter(as_list(value)), None)
    if isinstance(value, tuple) or not isinstance(first, Real | np.number):
        return
    msg = (
        f"{owner}: {name} needs {measure.needed}, got bare numbers; write for example "
        f"{name}=(values, {str(measure.unit)!r}) or {name}=[{measure.example!r}, ...]"
    )
    raise UnitsError(msg)


def read_words(value: object, read: Callable[[object], object]) -> AnyArray:
    """Read the values of an axis that are words."""
    return np.array([str(read(word)) for word in as_list(value)])


def read_free_values(
    value: object, name: str, *, owner: str = OWNER, expected: str = ""
) -> tuple[AnyArray, str | None]:
    """Read values for an argument whose meaning only the user knows."""
    value = _with_own_unit(value)
    unit = _unit_of(value)
    if unit is not None:  # one of several quantities, such as g, is taken as the expected one
        measure = _measure_of(unit, name, owner, expected)
        return read_numbers(value, measure, name, owner=owner), str(measure.unit)
    items = _as_python(as_list(value))
    array = np.array(items)
    if array.ndim != 1 or array.dtype.kind not in "ifbU":  # whole numbers beyond int64 are "u"
        msg = (
            f"{owner}: {name} needs numbers, words or quantities in a row, got {short_repr(value)}"
        )
        raise ComponentError(msg)
    # words among numbers, and truth values, which would become numbers
    if len({(isinstance(item, str), isinstance(item, bool)) for item in items}) > 1:
        msg = f"{owner}: {name} needs values of one sort, got {short_repr(value)}"
        raise ComponentError(msg)
    if array.dtype.kind == "i":
        return array.astype(np.int64), str(Unit.ONE)
    if array.dtype.kind == "f":
        measure = Measure("a number", Unit.ONE, "2")
        return read_numbers(items, measure, name, owner=owner), str(Unit.ONE)
    return array, None


def read_in_unit_of(measure: str, unit: str, value: object, name: str, *, owner: str) -> Array:
    """Read values of an argument, which must be in the unit of a measure."""
    values, own_unit = read_free_values(value, name, owner=owner, expected=unit)
    if own_unit != unit:
        msg = f"{owner}: {measure} is in {unit}, got {short_repr(value)}"
        raise UnitsError(msg)
    return np.asarray(values, dtype=np.float64)


def _values_and_unit(value: object) -> tuple[Any, str] | None:
    """Return values and their unit, if one unit was given for all of them."""
    pair = cast("tuple[Any, ...]", value) if isinstance(value, tuple) else ()
    if len(pair) == 2 and isinstance(pair[1], str) and not isinstance(pair[0], str):
        return pair
    return None


def _unit_of(value: object) -> str | None:
    """Return the unit of the given values; None for bare numbers and words."""
    if (pair := _values_and_unit(value)) is not None:
        return pair[1]
    first = next(iter(as_list(value)), None)
    if isinstance(value, pint.Quantity):
        first = value
    if isinstance(first, pint.Quantity):
        return f"{first.units:~}" or None
    if isinstance(first, str):
        number, _, unit = first.strip().partition(" ")
        with suppress(ValueError):  # a word
            float(number)
            return unit or None
    return None


def _measure_of(unit: str, name: str, owner: str, expected: str) -> Measure:
    """Find the kind of quantity that has a unit, the expected one before all others."""
    for known in sorted(Unit, key=lambda candidate: candidate != expected):
        measure = Measure("a quantity", known, f"1 {known}")
        with suppress(UnitsError, ComponentError):
            read_number(f"1 {unit}", measure, owner=owner, name=name)
            return measure
    known = ", ".join(str(candidate) for candidate in Unit)
    msg = f"{owner}: {name} has the unit {short_repr(unit)}; expected that of a quantity in {known}"
    raise UnitsError(msg)


def as_list(value: object) -> list[Any]:
    """Return values as a sequence; a single value becomes a sequence of one."""
    if isinstance(value, str | bytes) or not isinstance(value, Iterable):
        return [value]
    if getattr(value, "ndim", 1) == 0:  # arrays and quantities of one value only seem to be a row
        return [value]
    return list(cast("Iterable[Any]", value))


def _as_python(value: Any) -> Any:
    """Convert numbers of numpy and pandas to Python numbers."""
    if hasattr(value, "to_numpy"):
        value = value.to_numpy()
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, list):
        items = cast("list[Any]", value)
        return [item.item() if isinstance(item, np.generic) else item for item in items]
    return value


def faults_of_values(name: str, values: AnyArray) -> list[str]:
    """Tell what is wrong with the values of an axis."""
    distinct, counts = np.unique(values, return_counts=True)
    if not len(distinct):
        return [f"axis {name!r} has no values"]
    twice = distinct[counts > 1]
    return [f"axis {name!r} has the value {twice[0]!s} twice"] if len(twice) else []


MAX_CASES: Final = 1_000_000_000


@dataclass(frozen=True, eq=False)
class Grid:
    """All combinations of values, or of the rows of a table and further values."""

    axes: tuple[Axis, ...]  # with a dimension each
    columns: tuple[Axis, ...]  # of the table, all of one length
    motions: int  # number of motions
    # number of the motion of each row of the table; else the motions have a dimension
    motion_column: AnyArray | None = None

    @cached_property
    def sizes(self) -> dict[str, int]:
        """Dimensions of the result, in their order, and their lengths."""
        rows = len(self.columns[0].values) if self.columns else None
        if self.motion_column is not None:
            rows = len(self.motion_column)
        table = {} if rows is None else {CASE: rows}
        of_axes = {axis.name: len(axis.values) for axis in self.axes}
        motions = {MOTION: self.motions} if self.motion_column is None else {}
        return {**table, **of_axes, **motions}

    @property
    def count(self) -> int:
        """Number of cases."""
        return math.prod(self.sizes.values())

    @cached_property
    def order(self) -> tuple[str, ...]:
        """Dimensions in the order in which cases run, the last one varying fastest."""
        # neighbours share their motion and its scale as far as possible: each is prepared once
        scales = [axis.name for axis in self.axes if axis.changes is Changes.MOTION]
        other_axes = [axis.name for axis in self.axes if axis.changes is not Changes.MOTION]
        return tuple(n for n in (MOTION, *scales, CASE, *other_axes) if n in self.sizes)

    @property
    def shape(self) -> list[int]:
        """Lengths of the dimensions in that order."""
        return [self.sizes[name] for name in self.order]

    def indices(self, cases: range | AnyArray) -> dict[str, AnyArray]:
        """Return the places along all dimensions of cases, by their numbers in order of running."""
        indices = np.unravel_index(np.asarray(cases, dtype=np.int64), self.shape)
        return dict(zip(self.order, indices, strict=True))

    def case_numbers(self, key: Sequence[Any]) -> AnyArray:
        """Return the numbers of cases at places, slices or sequences of places along dimensions."""
        numbers = np.zeros((), dtype=np.int64)
        for (name, size), index in zip(self.sizes.items(), key, strict=True):
            later = self.order[self.order.index(name) + 1 :]
            step = math.prod(self.sizes[dim] for dim in later)
            places = range(*index.indices(size)) if isinstance(index, slice) else index
            numbers = np.add.outer(numbers, np.asarray(places, dtype=np.int64) % size * step)
        return numbers

    def in_dimension_order(self, values: AnyArray) -> AnyArray:
        """Rearrange values from the order of running to that of the dimensions."""
        unraveled = values.reshape([*self.shape, *values.shape[1:]])
        axes = [self.order.index(name) for name in self.sizes]
        other_axes = range(len(axes), unraveled.ndim)
        return np.ascontiguousarray(unraveled.transpose([*axes, *other_axes]))

    def values_of_cases(self, cases: range | AnyArray) -> tuple[tuple[Axis, AnyArray], ...]:
        """Return for each axis its values in some cases."""
        indices = self.indices(cases)
        of_axes = [(axis, axis.values[indices[axis.name]]) for axis in self.axes]
        rows = [(axis, axis.values[indices[CASE]]) for axis in self.columns]
        return (*of_axes, *rows)

    def motions_of(self, cases: range | AnyArray) -> AnyArray:
        """Return the numbers of the motions of some cases."""
        indices = self.indices(cases)
        if self.motion_column is not None:
            return self.motion_column[indices[CASE]]
        return indices[MOTION]


@dataclass(frozen=True)
class Chunk:
    """Some cases, by their numbers in the order of running."""

    number: int
    cases: range

    @classmethod
    def of(cls, number: int, count: int, size: int) -> "Chunk":
        """Return a chunk of a size, of a number of cases; the last may be shorter."""
        first = number * size
        return cls(number, range(first, min(first + size, count)))


def chunks_of(count: int, size: int) -> list[Chunk]:
    """Cut cases into chunks of a size."""
    return [Chunk.of(number, count, size) for number in range(-(-count // size))]
