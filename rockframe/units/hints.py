"""What may have been meant by a value whose unit does not fit."""

import re
from typing import Any, Final

from rockframe.errors import shown
from rockframe.units.kinds import (
    BED_STIFFNESS,
    FREQUENCY,
    SUBGRADE_MODULUS,
    TIME,
    Measure,
    Unit,
)
from rockframe.units.written import foreign_sign, number_and_unit

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
_SHARE: Final = (Unit.NEWTON_SECOND_PER_METRE, Unit.PASCAL_SECOND)
AMBIGUOUS: Final = (
    # read without complaint by pint, but rarely as the writer meant it
    (r",", "a decimal point is written '.'; pint would drop the comma"),
    (
        r"\d\s*[^\w\s,.*/^()%+-]\s*\d",
        "a number is written without marks between its digits; pint would multiply its parts",
    ),
    (r"\d\s+[\d.]", "a number is written without blanks; pint would multiply its parts"),
    (
        r"\b(?:k|M|G|kilo|mega|giga)?tons?\b",
        "'ton' is the US short ton of 907 kg; the tonne is written 't'",
    ),
)


def foreign_quantity(value: object) -> str:
    """Say how a quantity of another library is given; nothing of what is none."""
    home = type(value).__module__.partition(".")[0]
    unit = next((one for one in ("unit", "units") if hasattr(value, one)), None)
    if unit is None or not hasattr(value, "value"):
        return ""
    return (
        f"a {type(value).__name__} of {home}, and quantities are those of pint; give it as "
        f"(q.value, str(q.{unit}))"
    )


def _weight(given: Any, text: str, measure: Measure) -> str:
    """Say how a mass follows from a weight, where one was given for a mass."""
    if measure.unit not in _HEAVY:
        return ""
    try:
        heavy = given.is_compatible_with(f"{measure.unit} m s^-2")
    except Exception:  # offset units such as degC cannot be compared
        return ""
    return f" (a force is no mass; divide it by g_0: {shown(f'{text}/g_0')})" if heavy else ""


def other_kind(given: Any, text: str, measure: Measure) -> str:
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
    except Exception:  # offset units such as degC cannot be compared
        return False


def without_unit(measure: Measure) -> str:
    """Say which argument takes the bare number that was given for one with a unit."""
    if measure.unit in _SHARE:
        return "; a share of critical damping is a damping_ratio"
    return ""


def misread(text: str, measure: Measure) -> str:
    """Say which unit was probably meant; nothing if that is not known."""
    parts = number_and_unit(text)
    text = text if parts is None else parts[1]
    for pattern, meant, words in _MISREAD_UNITS:
        if meant in (None, measure.unit) and re.search(pattern, text):
            return f" ({words})"
    sign = foreign_sign(text)
    if sign is not None:
        return f" ({shown(sign)} stands in no number and in no unit)"
    if measure is FREQUENCY:
        return " (a cyclic frequency in Hz is the angular one in rad/s divided by 2 pi)"
    return ""
