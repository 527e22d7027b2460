"""Conversion of quantities to floats in SI units.

The application registry of pint is used and never changed. Quantities are converted by unit
*strings*, so that a registry that another library has set works, too.
"""

import math
import re
import threading
from collections.abc import Iterable, Sequence
from contextlib import suppress
from decimal import Context, Decimal
from numbers import Real
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import pint
from pint.facets.plain import PlainQuantity

from rockframe.errors import ComponentError, UnitsError, short_repr
from rockframe.units.kinds import Condition, Measure, Unit
from rockframe.units.spelling import (
    AMBIGUOUS,
    foreign_quantity_hint,
    misread_unit_hint,
    number_and_unit,
    pint_spelling,
    related_kind_hint,
)

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

Quantity: TypeAlias = PlainQuantity[Any]
"""Every quantity of pint, in a form that type checkers can follow, unlike pint.Quantity."""
QuantityLike: TypeAlias = str | Quantity | tuple[float, str]
"""A number with its unit: ``"0.3 m"``, ``(0.3, "m")``, or a Quantity of pint."""
RatioLike: TypeAlias = float | str | Quantity

_DAMPING_UNITS: Final = (Unit.NEWTON_SECOND_PER_METRE, Unit.PASCAL_SECOND)
_GRAVITY_SYMBOLS: Final = ("g", "G", "g0")
"""Usual symbols of the acceleration of gravity, which pint calls ``g_0``."""
_DECIMAL_CONTEXT: Final = Context(prec=64)
_MAX_FACTOR_LENGTH: Final = 12
"""Characters of a conversion factor that is exact with few digits: 0.45359237 kg, 1e-06 m."""


_registry_lock = threading.Lock()


def unit_registry() -> Any:
    """Return the application registry of pint, built by one thread while others wait."""
    registry: Any = pint.get_application_registry()
    with _registry_lock:
        registry.Quantity  # noqa: B018 - pint builds its registry at the first access
    return registry


def quantity(value: "float | npt.NDArray[np.float64]", measure: Measure) -> Quantity:
    """Make a quantity of pint from a value in SI units."""
    return unit_registry().Quantity(value, str(measure.unit))


def to_si(
    value: object,
    measure: Measure,
    *,
    owner: str,
    name: str,
    condition: "Condition | None" = None,
) -> float:
    """Convert an argument to a float in SI units; raise an error if that is not possible."""
    number = _parse_si(value, measure)
    if number is not None:
        return _check_value(number, value, condition, owner=owner, name=name)
    argument = _parse(value, measure, owner=owner, name=name)
    _check_kind(argument, value, measure, owner=owner, name=name)
    magnitude = _si_magnitude(argument, str(measure.unit))
    if not isinstance(magnitude, Real) and getattr(magnitude, "ndim", 1) != 0:
        msg = (
            f"{owner}: {name} needs {measure.name}, one value only, got {short_repr(value)}; "
            f"{measure.example_of(name)}"
        )
        raise UnitsError(msg)
    return _check_value(float(magnitude), value, condition, owner=owner, name=name)


def to_si_values(value: object, measure: Measure, *, owner: str, name: str) -> list[float]:
    """Convert an argument of one or several values to floats in SI units."""
    if isinstance(value, pint.Quantity):
        argument: Any = value
        quantities = argument if getattr(argument.magnitude, "ndim", 0) == 1 else [argument]
        return [to_si(quantity, measure, owner=owner, name=name) for quantity in quantities]
    if isinstance(value, str) or getattr(value, "ndim", 1) == 0:
        return [to_si(value, measure, owner=owner, name=name)]
    if isinstance(value, Iterable):
        items: list[Any] = list(value)
        alone = isinstance(items[0], str | pint.Quantity | None) if items else True
        if len(items) == 2 and isinstance(items[1], str) and not alone:
            check_attached_unit(items[0], items[1], owner=owner, name=name)
            factor = to_si(f"1 {items[1]}", measure, owner=owner, name=name)
            numbers: Any = items[0]
            single = getattr(numbers, "ndim", 1) == 0 or not isinstance(items[0], Iterable)
            if single or not hasattr(numbers, "tolist"):
                numbers = [numbers] if single else list(numbers)
            floats: list[Any] = numbers if isinstance(numbers, list) else numbers.tolist()
            if all(type(number) is float for number in floats):
                read = decimal_products(floats, factor)
                if all(map(math.isfinite, read)):
                    return read
            return [  # one by one, with checks
                _scaled_number(number, factor, items[1], owner=owner, name=name)
                for number in numbers
            ]
        return [to_si(item, measure, owner=owner, name=name) for item in items]
    return [to_si(value, measure, owner=owner, name=name)]


def attached_unit(values: object) -> str | None:
    """Return the unit that an array carries: as a Quantity, or in an attribute ``units``."""
    held: Any = values
    attributes = getattr(held, "attrs", None)
    # arrays of numpy have data too, which those of dates do not give
    for quantity in (held, None if attributes is None else getattr(held, "data", None)):
        if isinstance(quantity, pint.Quantity):
            return f"{quantity.units:~}"
    unit = (attributes or {}).get("units")
    return unit if isinstance(unit, str) else None


def check_attached_unit(values: object, unit: str, *, owner: str, name: str) -> None:
    """Refuse an array that carries another unit than the one given with it."""
    attached = attached_unit(values)
    if attached is None or attached == unit:
        return
    units = unit_registry()
    try:  # powers as UDUNITS writes them
        both = [
            units.Quantity(1, re.sub(r"(?<=[A-Za-z])(?=-?\d)", "^", u)) for u in (attached, unit)
        ]
        same = bool(both[0].is_compatible_with(both[1]) and both[0] == both[1])
    except Exception:  # pint raises many unrelated types
        same = False
    if not same:
        msg = (
            f"{owner}: {name} has the unit {attached!r}, but {unit!r} is given with it; give "
            "values without a unit of their own"
        )
        raise UnitsError(msg)


def _scaled_number(number: Any, factor: float, unit: str, *, owner: str, name: str) -> float:
    """Convert one of several values that have a common unit."""
    _check_mask(number, owner=owner, name=name)
    if getattr(number, "ndim", None) == 0:
        number = number.item()
    if isinstance(number, str):
        with suppress(ValueError):
            number = float(number)
    if isinstance(number, bool) or not isinstance(number, Real):
        msg = (
            f"{owner}: {name} needs numbers only, as their common unit {unit!r} is given; "
            f"got {short_repr(number)}"
        )
        raise UnitsError(msg)
    return _check_value(
        _decimal_product(_float(number), factor), number, None, owner=owner, name=name
    )


def _check_mask(number: Any, *, owner: str, name: str) -> None:
    """Refuse a masked number, whose value would be read as zero."""
    if getattr(number, "ndim", None) == 0 and bool(getattr(number, "mask", False)):
        msg = f"{owner}: {name} has masked values; fill them in first"
        raise ComponentError(msg)


def _float(number: Real | Decimal) -> float:
    """Convert a number to a float; one beyond its range becomes infinite."""
    try:
        return float(number)
    except OverflowError:
        return math.inf


def _si_magnitude(value: Any, unit: str) -> Any:
    """Convert a magnitude to an SI unit; a single number without rounding by the factor."""
    number = value.magnitude
    if getattr(number, "ndim", None) == 0:  # other registries may make arrays of single numbers
        number = number.item()
    if not isinstance(number, Real | Decimal):
        return value.m_as(unit)
    size = float(type(value)(1, value.units).m_as(unit))
    rounded = float(f"{size:.15g}")  # a foot of 0.30479999999999996 m is 0.3048 m
    short = len(repr(rounded)) <= _MAX_FACTOR_LENGTH
    return _decimal_product(_float(number), rounded if short else size)


def _decimal_product(number: float, factor: float) -> float:
    """Multiply a number by a conversion factor in decimal arithmetic: 70 cm are 0.7 m.

    The product of the floats would be 0.7000000000000001 m.
    """
    written = repr(factor)
    if not math.isfinite(number) or len(written) > _MAX_FACTOR_LENGTH:
        return number * factor
    return float(_DECIMAL_CONTEXT.multiply(Decimal(repr(number)), Decimal(written))) + 0.0


def decimal_products(numbers: Sequence[float], factor: float) -> list[float]:
    """Multiply many numbers by a factor; for a power of ten only the exponents change."""
    if factor == 1.0:
        return [number + 0.0 for number in numbers]
    written = repr(factor)
    _, digits, power = Decimal(written).as_tuple()
    is_power_of_ten = "".join(map(str, digits)).rstrip("0") == "1"
    if not is_power_of_ten or len(written) > _MAX_FACTOR_LENGTH or not isinstance(power, int):
        return [_decimal_product(number, factor) for number in numbers]
    exponent = f"e{power + len(digits) - 1}"
    return [
        float(text + exponent) + 0.0
        if text[-1].isdigit() and "e" not in text
        else _decimal_product(float(text), factor)
        for text in map(repr, numbers)
    ]


def to_ratio(
    value: object,
    *,
    owner: str,
    name: str,
    condition: "Condition | None" = None,
    example: str = "0.1",
) -> float:
    """Convert a pure ratio: a bare number, or a dimensionless quantity such as ``"5 %"``."""
    number: object = value
    ratio = Measure("a pure ratio", Unit.ONE, example)
    if isinstance(value, str | pint.Quantity):
        argument = _parse(value, ratio, owner=owner, name=name)
        _check_kind(argument, value, ratio, owner=owner, name=name)
        number = _si_magnitude(argument, "")
    if isinstance(number, bool) or not isinstance(number, Real):
        msg = (
            f"{owner}: {name} needs a pure ratio (a bare number), got {short_repr(value)}; "
            f"{ratio.example_of(name)}"
        )
        raise UnitsError(msg)
    return _check_value(_float(number), value, condition, owner=owner, name=name)


def read_number(value: object, measure: Measure, *, owner: str, name: str) -> float:
    """Read one value, which is a ratio where the unit of its measure is 1."""
    if measure.unit == Unit.ONE:
        return to_ratio(value, owner=owner, name=name)
    return to_si(value, measure, owner=owner, name=name)


def _parse_si(value: object, measure: Measure) -> float | None:
    """Read a text in the SI unit, which needs no conversion; None for any other."""
    parts = number_and_unit(value) if isinstance(value, str) else None
    return float(parts[0]) if parts is not None and parts[1] == measure.unit else None


def _parse(value: object, measure: Measure, *, owner: str, name: str) -> Quantity:
    if isinstance(value, pint.Quantity):
        _check_mask(value.magnitude, owner=owner, name=name)
        return value
    value = _pair_as_text(value)
    needed = f"{owner}: {name} needs {measure.needed}"
    example = measure.example_of(name)
    if not isinstance(value, str):
        kind = "a bare number" if isinstance(value, Real) else f"a {type(value).__name__}"
        share = (
            "; a ratio to critical damping is damping_ratio"
            if measure.unit in _DAMPING_UNITS
            else ""
        )
        why = foreign_quantity_hint(value) or f"{kind} has no unit{share}"
        if isinstance(value, tuple):
            why = "one number and its unit are needed"
        msg = f"{needed}, got {short_repr(value)} ({why}); {example}"
        raise UnitsError(msg)
    value = _with_gravity_unit(value, measure)
    for pattern, words in AMBIGUOUS:
        if re.search(pattern, value):
            msg = f"{needed}, got {short_repr(value)} ({words}); {example}"
            raise UnitsError(msg)
    written = pint_spelling(value)
    if written is None:
        hint = misread_unit_hint(value, measure)
        expected = "a number" if measure.unit == Unit.ONE else "one number and a unit"
        msg = f"{needed}, got {short_repr(value)}, which is not {expected}{hint}; {example}"
        raise UnitsError(msg)
    try:
        return unit_registry().Quantity(written)
    except Exception as problem:  # pint's parser raises many unrelated types
        hint = misread_unit_hint(value, measure)
        msg = f"{needed}, got {short_repr(value)}, whose unit cannot be read{hint}; {example}"
        raise UnitsError(msg) from problem


def _with_gravity_unit(text: str, measure: Measure) -> str:
    """Read ``g``, otherwise the gram, as the acceleration of gravity in accelerations."""
    parts = number_and_unit(text)
    gravity = (
        measure.unit == Unit.METRE_PER_SECOND_SQUARED and parts and parts[1] in _GRAVITY_SYMBOLS
    )
    return f"{parts[0]} g_0" if parts and gravity else text


def _pair_as_text(value: object) -> object:
    """Join a pair of number and unit, ``(0.3, "m")``, to one text; keep any other value."""
    if not isinstance(value, tuple):
        return value
    pair: tuple[Any, ...] = value  # pyright: ignore[reportUnknownVariableType]
    number, unit = pair if len(pair) == 2 else (None, None)
    if isinstance(number, bool) or not isinstance(number, Real) or not isinstance(unit, str):
        return pair
    try:
        return f"{float(number)!r} {unit}"
    except OverflowError:  # beyond the range of floats
        return f"{math.inf} {unit}"


def _check_kind(
    argument: Quantity, value: object, measure: Measure, *, owner: str, name: str
) -> None:
    reference = type(argument)(1, "" if measure.unit == Unit.ONE else str(measure.unit))
    try:
        same_kind = argument.is_compatible_with(reference) and _root_units(argument) == _root_units(
            reference
        )
    except Exception:  # offset units such as degC cannot be compared
        same_kind = False
    if same_kind:
        return
    unit = f"{argument.units:~}" or "no unit"
    unit_needed = "" if measure.unit == Unit.ONE else f" in a unit such as {measure.unit}"
    text = str(value)
    hint = related_kind_hint(argument, text, measure) or misread_unit_hint(text, measure)
    msg = (
        f"{owner}: {name} needs {measure.name}{unit_needed}, got {short_repr(text)} ({unit})"
        f"{hint}; {measure.example_of(name)}"
    )
    raise UnitsError(msg)


def _root_units(value: Any) -> dict[str, float]:
    # For pint the radian is dimensionless, so that a ratio would pass for an angle and rad/s for
    # Hz (a factor of 2 pi); the root units differ. They are those of one unit, as a huge value
    # would overflow.
    unit_value: Any = type(value)(1, value.units)
    return {unit: float(power) for unit, power in unit_value.to_root_units().unit_items()}


def _check_value(
    number: float, value: object, condition: Condition | None, *, owner: str, name: str
) -> float:
    if not math.isfinite(number):
        msg = f"{owner}: {name} must be finite, got {short_repr(str(value))}"
        raise ComponentError(msg)
    if condition is not None and not condition.holds(number):
        hint = condition.hint(str(value))
        msg = f"{owner}: {name} must be {condition.words}, got {short_repr(str(value))}{hint}"
        raise ComponentError(msg)
    return number
