"""The unit boundary: quantities come in here and leave as SI floats.

The shared pint application registry is used and never changed; quantities are
converted by unit *strings*, so that a registry swapped by another library
does no harm.
"""

import math
import re
from collections.abc import Iterable
from contextlib import suppress
from fractions import Fraction
from numbers import Real
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import pint
from pint.facets.plain import PlainQuantity

from rockframe.errors import ComponentError, UnitsError, shown
from rockframe.units.hints import (
    AMBIGUOUS,
    foreign_quantity,
    misread,
    other_kind,
    without_unit,
)
from rockframe.units.kinds import Condition, Measure, Unit
from rockframe.units.written import number_and_unit, parse_quantity

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

Quantity: TypeAlias = PlainQuantity[Any]
"""Every quantity of pint, as type checkers can follow it; pint.Quantity itself they cannot."""
QuantityLike: TypeAlias = str | Quantity | tuple[float, str]
"""A number with its unit: ``"0.3 m"``, ``(0.3, "m")``, or a Quantity of pint."""
RatioLike: TypeAlias = float | str | Quantity

_LONGEST_FACTOR: Final = 12
"""Letters of a unit's size that is a number of few digits, such as 0.45359237 kg or 1e-06 m."""


def quantity(value: "float | npt.NDArray[np.float64]", measure: Measure) -> Quantity:
    """Give an SI value its unit back."""
    return pint.get_application_registry().Quantity(value, str(measure.unit))


def to_si(
    value: object,
    measure: Measure,
    *,
    owner: str,
    name: str,
    condition: "Condition | None" = None,
) -> float:
    """Convert an argument to a float in SI units, or refuse it."""
    number = _in_si(value, measure)
    if number is not None:
        return _check_value(number, value, condition, owner=owner, name=name)
    given = _parse(value, measure, owner=owner, name=name)
    _check_kind(given, value, measure, owner=owner, name=name)
    magnitude = _converted(given, measure)
    if not isinstance(magnitude, Real) and getattr(magnitude, "ndim", 1) != 0:
        msg = (
            f"{owner}: {name} needs {measure.name}, one value only, got {shown(value)}; "
            f"{measure.example_of(name)}"
        )
        raise UnitsError(msg)
    return _check_value(float(magnitude), value, condition, owner=owner, name=name)


def to_si_values(value: object, measure: Measure, *, owner: str, name: str) -> list[float]:
    """Convert an argument that holds one or several values to floats in SI units."""
    if isinstance(value, str):
        return [to_si(value, measure, owner=owner, name=name)]
    if isinstance(value, pint.Quantity):
        given: Any = value
        return [to_si(one, measure, owner=owner, name=name) for one in _each(given)]
    if isinstance(value, Iterable):
        items: list[Any] = list(value)
        if len(items) == 2 and isinstance(items[1], str) and not isinstance(items[0], str):
            factor = to_si(f"1 {items[1]}", measure, owner=owner, name=name)
            numbers = items[0] if isinstance(items[0], Iterable) else [items[0]]
            return [_times(number, factor, items[1], owner=owner, name=name) for number in numbers]
        return [to_si(item, measure, owner=owner, name=name) for item in items]
    return [to_si(value, measure, owner=owner, name=name)]


def _times(number: Any, factor: float, unit: str, *, owner: str, name: str) -> float:
    """Convert one of several values whose unit is given for all."""
    if getattr(number, "ndim", None) == 0:
        number = number.item()
    if isinstance(number, str):
        with suppress(ValueError):
            number = float(number)
    if isinstance(number, bool) or not isinstance(number, Real):
        msg = (
            f"{owner}: {name} needs numbers where their unit, {unit!r}, is given for all of them; "
            f"got {shown(number)}"
        )
        raise UnitsError(msg)
    return _check_value(_product(_float(number), factor), number, None, owner=owner, name=name)


def _float(number: Real) -> float:
    """Give a number as a float, infinite where it is larger than any."""
    try:
        return float(number)
    except OverflowError:
        return math.inf


def _converted(given: Any, measure: Measure) -> Any:
    """Convert a magnitude, as long as it is one number, as it is written."""
    unit, number = str(measure.unit), given.magnitude
    if getattr(number, "ndim", None) == 0:  # registries that others set make arrays of numbers
        number = number.item()
    if not isinstance(number, int | float):
        return given.m_as(unit)
    return _product(float(number), float(type(given)(1.0, given.units).m_as(unit)))


def _product(number: float, factor: float) -> float:
    """Multiply a number by the size of its unit as both are written: 70 cm are 0.7 m.

    The product of the floats is 0.7000000000000001 m.
    """
    written = repr(factor)
    if not math.isfinite(number) or len(written) > _LONGEST_FACTOR:
        return number * factor
    try:
        return float(Fraction(repr(number)) * Fraction(written))
    except OverflowError:
        return math.copysign(math.inf, number)


def _each(given: Any) -> Iterable[Any]:
    return given if getattr(given.magnitude, "ndim", 0) == 1 else [given]


def to_ratio(
    value: object,
    *,
    owner: str,
    name: str,
    condition: "Condition | None" = None,
    example: str = "0.1",
) -> float:
    """Convert a pure ratio (bare number, or a dimensionless quantity such as ``"5 %"``)."""
    number: object = value
    ratio = Measure("a pure ratio", Unit.ONE, example)
    if isinstance(value, str | pint.Quantity):
        given = _parse(value, ratio, owner=owner, name=name)
        _check_kind(given, value, ratio, owner=owner, name=name)
        magnitude: Any = given.m_as("")
        number = magnitude.item() if getattr(magnitude, "ndim", 1) == 0 else magnitude
    if isinstance(number, bool) or not isinstance(number, Real):
        msg = (
            f"{owner}: {name} needs a pure ratio (a bare number), got {shown(value)}; "
            f"{ratio.example_of(name)}"
        )
        raise UnitsError(msg)
    return _check_value(_float(number), value, condition, owner=owner, name=name)


def _in_si(value: object, measure: Measure) -> float | None:
    """Read a value that is in the SI unit already: most are, and need no conversion."""
    if not isinstance(value, str) or not value.endswith(measure.unit):
        return None
    parts = number_and_unit(value)
    if parts is None or parts[1] != measure.unit:
        return None
    return float(parts[0])


def _parse(value: object, measure: Measure, *, owner: str, name: str) -> Quantity:
    if isinstance(value, pint.Quantity):
        return value
    value = _joined(value)
    needed = f"{owner}: {name} needs {measure.needed}"
    example = measure.example_of(name)
    if not isinstance(value, str):
        kind = "a bare number" if isinstance(value, Real) else f"a {type(value).__name__}"
        why = foreign_quantity(value) or f"{kind} has no unit{without_unit(measure)}"
        if isinstance(value, tuple):
            why = "one number and its unit are needed"
        msg = f"{needed}, got {shown(value)} ({why}); {example}"
        raise UnitsError(msg)
    for pattern, words in AMBIGUOUS:
        if re.search(pattern, value):
            msg = f"{needed}, got {shown(value)} ({words}); {example}"
            raise UnitsError(msg)
    written = parse_quantity(value)
    if written is None:
        hint = misread(value, measure)
        wanted = "a number" if measure.unit == Unit.ONE else "one number and a unit"
        msg = f"{needed}, got {shown(value)}, which is not {wanted}{hint}; {example}"
        raise UnitsError(msg)
    try:
        return pint.get_application_registry().Quantity(written.plain)
    except Exception as problem:  # pint's parser raises many unrelated types
        hint = misread(value, measure)
        msg = f"{needed}, got {shown(value)}, whose unit cannot be read{hint}; {example}"
        raise UnitsError(msg) from problem


def _joined(value: object) -> object:
    """Write a number beside its unit, ``(0.3, "m")``, as one text; leave all else as it is."""
    if not isinstance(value, tuple):
        return value
    pair: tuple[Any, ...] = value  # pyright: ignore[reportUnknownVariableType]
    number, unit = pair if len(pair) == 2 else (None, None)
    if isinstance(number, bool) or not isinstance(number, Real) or not isinstance(unit, str):
        return pair
    return f"{float(number)!r} {unit}"


def _check_kind(given: Quantity, value: object, measure: Measure, *, owner: str, name: str) -> None:
    wanted = type(given)(1.0, "" if measure.unit == Unit.ONE else str(measure.unit))
    try:
        same_kind = given.is_compatible_with(wanted) and _roots(given) == _roots(wanted)
    except Exception:  # offset units such as degC cannot be compared
        same_kind = False
    if same_kind:
        return
    unit = f"{given.units:~}" or "no unit"
    unit_needed = "" if measure.unit == Unit.ONE else f" in a unit such as {measure.unit}"
    msg = (
        f"{owner}: {name} needs {measure.name}{unit_needed}, got {shown(str(value))} ({unit})"
        f"{other_kind(given, str(value), measure) or misread(str(value), measure)}; "
        f"{measure.example_of(name)}"
    )
    raise UnitsError(msg)


def _roots(given: Any) -> dict[str, float]:
    # pint calls the radian dimensionless, so that a ratio would pass for an
    # angle and rad/s for Hz (a factor of 2 pi); the root units tell them apart.
    # Of one unit, not of the value: a huge one would overflow.
    one: Any = type(given)(1.0, given.units)
    return {unit: float(power) for unit, power in one.to_root_units().unit_items()}


def _check_value(
    number: float, value: object, condition: Condition | None, *, owner: str, name: str
) -> float:
    if not math.isfinite(number):
        msg = f"{owner}: {name} must be finite, got {shown(str(value))}"
        raise ComponentError(msg)
    if condition is not None and not condition.holds(number):
        hint = condition.hint(str(value))
        msg = f"{owner}: {name} must be {condition.words}, got {shown(str(value))}{hint}"
        raise ComponentError(msg)
    return number
