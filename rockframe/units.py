"""The unit boundary: quantities come in here and leave as SI floats.

The shared pint application registry is used and never changed; quantities are
converted by unit *strings*, so that a registry swapped by another library
does no harm.
"""

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from enum import StrEnum
from numbers import Real
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import pint

from rockframe.errors import ComponentError, UnitsError, shown

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

QuantityLike: TypeAlias = str | pint.Quantity[Any] | tuple[float, str]
"""A number with its unit: ``"0.3 m"``, ``(0.3, "m")``, or a Quantity of pint."""
RatioLike: TypeAlias = float | str | pint.Quantity[Any]


class Unit(StrEnum):
    """Every unit string of rockframe, in a spelling that pint and UDUNITS both parse."""

    ONE = "1"
    METRE = "m"
    CUBIC_METRE = "m^3"
    SECOND = "s"
    KILOGRAM = "kg"
    RADIAN = "rad"
    HERTZ = "Hz"
    METRE_PER_SECOND = "m s^-1"
    METRE_PER_SECOND_SQUARED = "m s^-2"
    RADIAN_PER_SECOND = "rad s^-1"
    RADIAN_PER_SECOND_SQUARED = "rad s^-2"
    KILOGRAM_METRE_SQUARED = "kg m^2"
    KILOGRAM_PER_CUBIC_METRE = "kg m^-3"
    NEWTON = "N"
    NEWTON_METRE = "N m"
    NEWTON_SECOND = "N s"
    NEWTON_PER_METRE = "N m^-1"
    NEWTON_SECOND_PER_METRE = "N s m^-1"
    JOULE = "J"
    PASCAL = "Pa"
    PASCAL_SECOND = "Pa s"
    PASCAL_PER_METRE = "Pa m^-1"


@dataclass(frozen=True)
class Measure:
    """A kind of physical quantity that an argument can ask for."""

    name: str
    unit: Unit
    example: str

    def like(self, example: str) -> "Measure":
        """Give the same kind with an example that fits other arguments."""
        return replace(self, example=example)

    @property
    def needed(self) -> str:
        """The kind, and that it needs a unit, in words."""
        return self.name if self.unit == Unit.ONE else f"{self.name} with a unit"

    def example_of(self, argument: str) -> str:
        """Show how an argument is written."""
        written = self.example if self.unit == Unit.ONE else repr(self.example)
        return f"write for example {argument}={written}"


LENGTH: Final = Measure("a length", Unit.METRE, "4 m")
MASS: Final = Measure("a mass", Unit.KILOGRAM, "99 t")
DENSITY: Final = Measure("a density", Unit.KILOGRAM_PER_CUBIC_METRE, "2500 kg/m^3")
INERTIA: Final = Measure("a moment of inertia", Unit.KILOGRAM_METRE_SQUARED, "1.2e6 kg*m^2")
THICKNESS: Final = LENGTH.like("0.3 m")
TIME: Final = Measure("a time", Unit.SECOND, "20 s")
TIME_STEP: Final = TIME.like("0.01 s")
PERIOD: Final = TIME.like("0.5 s")
ANGLE: Final = Measure("an angle", Unit.RADIAN, "0.1 rad")
ANGULAR_VELOCITY: Final = Measure("an angular velocity", Unit.RADIAN_PER_SECOND, "0.2 rad/s")
VELOCITY: Final = Measure("a velocity", Unit.METRE_PER_SECOND, "0.1 m/s")
ACCELERATION: Final = Measure("an acceleration", Unit.METRE_PER_SECOND_SQUARED, "9.81 m/s^2")
FREQUENCY: Final = Measure("a cyclic frequency", Unit.HERTZ, "1 Hz")
FORCE: Final = Measure("a force", Unit.NEWTON, "100 kN")
STIFFNESS: Final = Measure("a stiffness", Unit.NEWTON_PER_METRE, "12 MN/m")
DAMPING: Final = Measure("a damping coefficient", Unit.NEWTON_SECOND_PER_METRE, "80 kN*s/m")
BED_STIFFNESS: Final = Measure("a stiffness per length of base", Unit.PASCAL, "9 MPa")
BED_DAMPING: Final = Measure("a damping per length of base", Unit.PASCAL_SECOND, "400 kN*s/m^2")
SUBGRADE_MODULUS: Final = Measure("a subgrade modulus", Unit.PASCAL_PER_METRE, "20 MN/m^3")

_HEAVY: Final = (Unit.KILOGRAM, Unit.KILOGRAM_PER_CUBIC_METRE, Unit.KILOGRAM_METRE_SQUARED)
_MISREAD_UNITS: Final = (
    # (pattern, unit it is meant for or None for any, what is wrong)
    (
        r"(?<![A-Za-z_])g(?![A-Za-z_0])",
        Unit.METRE_PER_SECOND_SQUARED,
        "'g' is the gram; the acceleration of gravity is written 'g_0'",
    ),
    (
        r"(?<![A-Za-z_])(?:G|[Gg]_?[0n])(?![A-Za-z_0-9])",
        Unit.METRE_PER_SECOND_SQUARED,
        "the acceleration of gravity is written 'g_0'",
    ),
    (
        r"(?<![A-Za-z_])gal\b",
        Unit.METRE_PER_SECOND_SQUARED,
        "'gal' is the gallon; the galileo (cm/s^2) is written 'Gal'",
    ),
    (r"\bnp\.", None, "a NumPy number was written with its type; write float(...) of it"),
    (r"[A-Za-z]\d", None, "powers need '^', as in 'm/s^2'"),
)
_AMBIGUOUS: Final = (
    # read without complaint by pint, but rarely as the writer meant it
    (r",", "a decimal point is written '.'; pint would drop the comma"),
    (r"\d\s+[\d.]", "a number is written without blanks; pint would multiply its parts"),
    (
        r"\b(?:k|M|G|kilo|mega|giga)?tons?\b",
        "'ton' is the US short ton of 907 kg; the tonne is written 't'",
    ),
)
_NUMBER: Final = r"[-+]?(?:(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|nan\b|inf(?:inity)?\b)"
_NUMBER_AND_UNIT: Final = re.compile(rf"\s*(?P<number>{_NUMBER})\s*(?P<unit>.*)", re.DOTALL)
_NO_UNIT: Final = re.compile(
    # a second number, or a power of a number or of a power: no unit has them, and
    # pint would compute even 9**9**9
    r"^\^|(?:^|[\s/(*])[\d.]|\^[-+]?(?:\d{3}|\d+\^)|[A-Za-z]\d"
)
_POWER: Final = re.compile(r"\s*(?:\*\*|\^)\s*")


def quantity(value: "float | npt.NDArray[np.float64]", measure: Measure) -> pint.Quantity[Any]:
    """Give an SI value its unit back.

    Parameters
    ----------
    value : float or ndarray
        Value in the SI unit of `measure`.
    measure : Measure
        Kind of quantity.

    Returns
    -------
    pint.Quantity
        In the shared application registry.
    """
    return pint.get_application_registry().Quantity(value, str(measure.unit))


def to_si(
    value: object,
    measure: Measure,
    *,
    owner: str,
    name: str,
    condition: "Condition | None" = None,
) -> float:
    """Convert an argument to a float in SI units, or refuse it.

    Parameters
    ----------
    value : str or pint.Quantity
        What the user gave.
    measure : Measure
        What the argument needs.
    owner, name : str
        Class (or function) and argument, for the message.
    condition : Condition, optional
        Range that the value must lie in.

    Returns
    -------
    float
        Finite value in the SI unit of `measure`.

    Raises
    ------
    UnitsError
        No unit, an unknown unit, or a unit of another kind.
    ComponentError
        Not finite, or outside `condition`.
    """
    number = _in_si(value, measure)
    if number is not None:
        return _check_value(number, value, condition, owner=owner, name=name)
    given = _parse(value, measure, owner=owner, name=name)
    _check_kind(given, value, measure, owner=owner, name=name)
    magnitude = given.m_as(str(measure.unit))
    if not isinstance(magnitude, Real) and getattr(magnitude, "ndim", 1) != 0:
        msg = (
            f"{owner}: {name} needs {measure.name}, one value only, got {shown(value)}; "
            f"{measure.example_of(name)}"
        )
        raise UnitsError(msg)
    return _check_value(float(magnitude), value, condition, owner=owner, name=name)


def to_si_values(value: object, measure: Measure, *, owner: str, name: str) -> list[float]:
    """Convert an argument that holds one or several values to floats in SI units.

    Parameters
    ----------
    value : (sequence, unit), pint.Quantity, or sequence of str or Quantity
        What the user gave; the values in one dimension.
    measure : Measure
        What the argument needs.
    owner, name : str
        Class (or function) and argument, for the message.

    Returns
    -------
    list of float

    Raises
    ------
    UnitsError
        No unit, an unknown unit, or a unit of another kind.
    ComponentError
        Not finite.
    """
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
            return [
                _check_value(float(number) * factor, number, None, owner=owner, name=name)
                for number in numbers
            ]
        return [to_si(item, measure, owner=owner, name=name) for item in items]
    return [to_si(value, measure, owner=owner, name=name)]


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
    """Convert a pure ratio (bare number, or a dimensionless quantity such as ``"5 %"``).

    Parameters
    ----------
    value : float, str or pint.Quantity
        What the user gave.
    owner, name : str
        Class and argument, for the message.
    condition : Condition, optional
        Range that the value must lie in.
    example : str, optional
        A number that makes sense for the argument, for the message.

    Returns
    -------
    float

    Raises
    ------
    UnitsError
        Not a pure ratio.
    ComponentError
        Not finite, or outside `condition`.
    """
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
    return _check_value(float(number), value, condition, owner=owner, name=name)


@dataclass(frozen=True)
class Condition:
    """A range that a value must lie in, with the words for it."""

    words: str
    holds: Callable[[float], bool]
    hint: Callable[[str], str] = lambda _: ""
    """What may have been meant by a value outside it, as it was written."""
    bounds: tuple[float, float] = (-math.inf, math.inf)
    """Numbers between which the range lies, for searches inside it."""


POSITIVE: Final = Condition("greater than zero", lambda value: value > 0.0, bounds=(0.0, math.inf))
NOT_NEGATIVE: Final = Condition("zero or more", lambda value: value >= 0.0, bounds=(0.0, math.inf))
UNIT_INTERVAL: Final = Condition(
    "above 0 and at most 1", lambda value: 0.0 < value <= 1.0, bounds=(0.0, 1.0)
)


def _in_si(value: object, measure: Measure) -> float | None:
    """Read a value that is in the SI unit already: most are, and need no conversion."""
    if not isinstance(value, str) or not value.endswith(measure.unit):
        return None
    parts = _NUMBER_AND_UNIT.fullmatch(value)
    if parts is None or parts["unit"] != measure.unit:
        return None
    return float(parts["number"])


def _parse(value: object, measure: Measure, *, owner: str, name: str) -> pint.Quantity[Any]:
    if isinstance(value, pint.Quantity):
        return value
    value = _joined(value)
    needed = f"{owner}: {name} needs {measure.needed}"
    example = measure.example_of(name)
    if not isinstance(value, str):
        kind = "a bare number" if isinstance(value, Real) else f"a {type(value).__name__}"
        why = foreign_quantity(value) or f"{kind} has no unit"
        if isinstance(value, tuple):
            why = "one number and its unit are needed"
        msg = f"{needed}, got {shown(value)} ({why}); {example}"
        raise UnitsError(msg)
    for pattern, words in _AMBIGUOUS:
        if re.search(pattern, value):
            msg = f"{needed}, got {shown(value)} ({words}); {example}"
            raise UnitsError(msg)
    parts = _NUMBER_AND_UNIT.fullmatch(value)
    if parts is None or _NO_UNIT.search(_POWER.sub("^", parts["unit"])):
        hint = _misread(value, measure)
        wanted = "a number" if measure.unit == Unit.ONE else "one number and a unit"
        msg = f"{needed}, got {shown(value)}, which is not {wanted}{hint}; {example}"
        raise UnitsError(msg)
    try:
        return pint.get_application_registry().Quantity(value)
    except Exception as problem:  # pint's parser raises many unrelated types
        hint = _misread(value, measure)
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


def foreign_quantity(value: object) -> str:
    """Say how a quantity of another library is given; nothing of what is none.

    Parameters
    ----------
    value : object
        What the user gave.

    Returns
    -------
    str
    """
    home = type(value).__module__.partition(".")[0]
    unit = next((one for one in ("unit", "units") if hasattr(value, one)), None)
    if unit is None or not hasattr(value, "value"):
        return ""
    return (
        f"a {type(value).__name__} of {home}, and quantities are those of pint; give it as "
        f"(q.value, str(q.{unit}))"
    )


def _check_kind(
    given: pint.Quantity[Any], value: object, measure: Measure, *, owner: str, name: str
) -> None:
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
        f"{_other_kind(given, str(value), measure) or _misread(str(value), measure)}; "
        f"{measure.example_of(name)}"
    )
    raise UnitsError(msg)


def _roots(given: Any) -> dict[str, float]:
    # pint calls the radian dimensionless, so that a ratio would pass for an
    # angle and rad/s for Hz (a factor of 2 pi); the root units tell them apart.
    # Of one unit, not of the value: a huge one would overflow.
    one: Any = type(given)(1.0, given.units)
    return {unit: float(power) for unit, power in one.to_root_units().unit_items()}


def _weight(given: Any, text: str, measure: Measure) -> str:
    """Say how a mass follows from a weight, where one was given for a mass."""
    if measure.unit not in _HEAVY:
        return ""
    try:
        heavy = given.is_compatible_with(f"{measure.unit} m s^-2")
    except Exception:  # as in _check_kind
        return ""
    return f" (a force is no mass; divide it by g_0: {shown(f'{text}/g_0')})" if heavy else ""


def _other_kind(given: Any, text: str, measure: Measure) -> str:
    """Say how what is needed follows from a related quantity, where that was given."""
    return _weight(given, text, measure) or _subgrade(given, measure) or _period(given, measure)


def _subgrade(given: Any, measure: Measure) -> str:
    """Say what takes the subgrade modulus, where it was given for the stiffness of a bed."""
    if measure.unit != BED_STIFFNESS.unit or not _is_in(given, SUBGRADE_MODULUS.unit):
        return ""
    return (
        " (a subgrade modulus; WinklerSoil.from_subgrade_modulus(modulus, depth=...) multiplies "
        "it by the depth of the base)"
    )


def _period(given: Any, measure: Measure) -> str:
    """Give the frequency of a period, where that was given."""
    if measure.unit != FREQUENCY.unit or not _is_in(given, TIME.unit):
        return ""
    seconds = float(given.m_as(str(TIME.unit)))
    if not seconds > 0.0:
        return ""
    return f" (a period; its frequency is {shown(f'{1.0 / seconds:.6g} {FREQUENCY.unit}')})"


def _is_in(given: Any, unit: Unit) -> bool:
    try:
        return given.is_compatible_with(str(unit)) and getattr(given.magnitude, "ndim", 0) == 0
    except Exception:  # as in _check_kind
        return False


def _misread(text: str, measure: Measure) -> str:
    parts = _NUMBER_AND_UNIT.fullmatch(text)
    text = text if parts is None else parts["unit"]
    for pattern, meant, words in _MISREAD_UNITS:
        if meant in (None, measure.unit) and re.search(pattern, text):
            return f" ({words})"
    if measure is FREQUENCY:
        return " (a cyclic frequency in Hz is the angular one in rad/s divided by 2 pi)"
    return ""


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
