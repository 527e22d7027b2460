"""How quantities are written: numbers and units in texts, and what a wrong one probably meant."""

import math
import re
from typing import Any, Final

from rockframe.errors import short_repr
from rockframe.units.kinds import BED_STIFFNESS, FREQUENCY, SUBGRADE_MODULUS, TIME, Measure, Unit

_DIGITS: Final = r"\d+(?:_\d+)*"
_NUMBER: Final = (
    rf"[-+]?(?:(?:{_DIGITS}(?:\.(?:{_DIGITS})?)?|\.{_DIGITS})(?:[eE][-+]?\d+)?"
    r"|nan\b|inf(?:inity)?\b)"
)
_NUMBER_AND_UNIT: Final = re.compile(
    # the unit 1/s is that of /s
    rf"\s*(?P<number>{_NUMBER})\s*(?:(?<=\s)1\s*(?=/\s*[^\W\d]))?(?P<unit>.*)",
    re.DOTALL,
)

_SPELLINGS: Final = str.maketrans("⋅\N{MULTIPLICATION SIGN}[]", "**()")
_DOUBLE_STAR: Final = re.compile(r"\s*(?:\*\*|\^)\s*")
_SUPERSCRIPTS: Final = re.compile(r"(?<=[^\W\d_)])⁻?[⁰¹²³⁴-⁹]+")
PLAIN_POWERS: Final = "-0123456789"
SUPERSCRIPT_POWERS: Final = "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"
_FROM_SUPERSCRIPTS: Final = str.maketrans(SUPERSCRIPT_POWERS, PLAIN_POWERS)
_POWER: Final = r"(?:\d{1,2}(?:\.\d*)?|\.\d+)(?![\d^])"
_UNIT: Final = re.compile(
    # excluded are a second number and a power of a number or of a power: no unit has them, and
    # pint would even compute 9**9**9; a sign may only precede a power
    rf"(?:[^\W\d_]|_\d*|\^(?:[-+]?{_POWER}|\([-+]{_POWER}\))|[\s*·()%‰°]|/(?!/)|\.(?!\d))*"
)
_DOT_OF_PRODUCT: Final = re.compile(r"\.(?=\s*(?:[^\W\d]|\())")
_DOT_OF_ABBREVIATION: Final = re.compile(r"\.(?!\d)")
_NAME: Final = re.compile(r"[^\W\d]\w*")
_INVALID_CHARACTER: Final = re.compile(r"[^\s\w*/^()%‰°·.+⁻-]")


DEGREE: Final = "°"


def quantity_text(value: float, measure: Measure) -> str:
    """Write a number in SI units with its unit, with all digits."""
    return f"{value!r} {measure.unit}"


def degrees_text(radians: float, digits: int = 4) -> str:
    """Write an angle in degrees."""
    return f"{math.degrees(radians):.{digits}g}{DEGREE}"


def angle_words(radians: float) -> str:
    """Write an angle in radians and degrees."""
    return f"{radians:.6g} rad ({degrees_text(radians)})"


def number_and_unit(text: str) -> tuple[str, str] | None:
    """Split a text after the number with which it begins."""
    parts = _NUMBER_AND_UNIT.fullmatch(text)
    return None if parts is None else (parts["number"], parts["unit"])


def pint_spelling(text: str) -> str | None:
    """Rewrite one number and its unit so that pint drops nothing; None for any other text."""
    parts = number_and_unit(text)
    if parts is None or not _is_unit(parts[1]):
        return None
    # versions of pint differ in what they make of dots
    unit = _DOT_OF_PRODUCT.sub("*", parts[1].translate(_SPELLINGS))
    return f"{float(parts[0])!r} {_DOT_OF_ABBREVIATION.sub('', unit)}"


def invalid_character(text: str) -> str | None:
    """Return the first character that occurs in no number and no unit; None if there is none."""
    match = _INVALID_CHARACTER.search(text.translate(_SPELLINGS))
    if match is not None:
        return match[0]
    # for example a fraction or a subscript: numeric characters that occur in no number
    others = (
        character
        for character in text
        if not character.isdecimal() and character not in SUPERSCRIPT_POWERS
    )
    return next(filter(str.isnumeric, others), None)


def _is_unit(text: str) -> bool:
    """Whether a text consists of names, powers and operators; the names may be unknown."""
    plain = _DOUBLE_STAR.sub("^", text.translate(_SPELLINGS))
    plain = _SUPERSCRIPTS.sub(lambda power: f"^{power[0].translate(_FROM_SUPERSCRIPTS)}", plain)
    names: list[str] = _NAME.findall(plain)
    return _UNIT.fullmatch(plain) is not None and all(name.isidentifier() for name in names)


_MASS_UNITS: Final = (Unit.KILOGRAM, Unit.KILOGRAM_PER_CUBIC_METRE, Unit.KILOGRAM_METRE_SQUARED)
_MISREAD_UNITS: Final = (
    # (pattern, unit of the argument or None for any, what is wrong)
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
    (r"[A-Za-z]-?\d", None, "powers need '^', as in 'm/s^2'"),
)
AMBIGUOUS: Final = (
    # pint reads these without an error, but rarely as they were meant
    (r",", "a decimal point is written '.'; pint would drop the comma"),
    (
        r"\d\s*[^\w\s,.*/^()%+-]\s*\d",
        "a number is written without separators; pint would multiply its parts",
    ),
    (
        r"\d\s+(?!1\s*/\s*[^\W\d])[\d.]",
        "a number is written without spaces; pint would multiply its parts",
    ),
    (
        r"\b(?:k|M|G|kilo|mega|giga)?tons?\b",
        "'ton' is the US short ton of 907 kg; the tonne is written 't'",
    ),
)


def foreign_quantity_hint(value: object) -> str:
    """Say how to convert a quantity of another library; nothing for other values."""
    home = type(value).__module__.partition(".")[0]
    unit = next((attribute for attribute in ("unit", "units") if hasattr(value, attribute)), None)
    if unit is None or not hasattr(value, "value"):
        return ""
    return (
        f"a {type(value).__name__} of {home}, where one of pint is needed; give it as "
        f"(q.value, str(q.{unit}))"
    )


def related_kind_hint(value: Any, text: str, measure: Measure) -> str:
    """Say how to convert a quantity of a related kind to the one that is needed, or nothing."""
    return (
        _weight_hint(value, text, measure)
        or _subgrade_hint(value, measure)
        or _period_hint(value, measure)
    )


def _weight_hint(value: Any, text: str, measure: Measure) -> str:
    """Say how to get the mass from a weight that was given for a mass."""
    if measure.unit not in _MASS_UNITS:
        return ""
    over_g = re.search(r"/\s*g$", text)  # read as the gram
    try:
        is_weight = value.is_compatible_with(f"{measure.unit} m s^-2{' g^-1' if over_g else ''}")
    except Exception:  # offset units such as degC cannot be compared
        return ""
    if over_g:
        return f" ('g' is the gram there; write {short_repr(f'{text}_0')})" if is_weight else ""
    return (
        f" (a force is no mass; divide it by g_0: {short_repr(f'{text}/g_0')})" if is_weight else ""
    )


def _subgrade_hint(value: Any, measure: Measure) -> str:
    """Name the constructor for a subgrade modulus that was given for the stiffness of a bed."""
    if measure.unit != BED_STIFFNESS.unit or not _is_in(value, SUBGRADE_MODULUS.unit):
        return ""
    return (
        " (a subgrade modulus; WinklerSoil.from_subgrade_modulus(modulus, depth=...) multiplies "
        "it by the depth of the base)"
    )


def _period_hint(value: Any, measure: Measure) -> str:
    """Return the frequency of a period that was given for a frequency."""
    if measure.unit != FREQUENCY.unit or not _is_in(value, TIME.unit):
        return ""
    seconds = float(value.m_as(str(TIME.unit)))
    if not seconds > 0.0:
        return ""
    return f" (a period; its frequency is {short_repr(f'{1.0 / seconds:.6g} {FREQUENCY.unit}')})"


def _is_in(value: Any, unit: Unit) -> bool:
    try:
        return value.is_compatible_with(str(unit)) and getattr(value.magnitude, "ndim", 0) == 0
    except Exception:  # offset units such as degC cannot be compared
        return False


def misread_unit_hint(text: str, measure: Measure) -> str:
    """Say which unit was probably meant, or nothing."""
    parts = number_and_unit(text)
    text = text if parts is None else parts[1]
    for pattern, meant, words in _MISREAD_UNITS:
        if meant in (None, measure.unit) and re.search(pattern, text):
            return f" ({words})"
    sign = invalid_character(text)
    if sign is not None:
        return f" ({short_repr(sign)} occurs in no number and in no unit)"
    if measure is FREQUENCY:
        return " (a cyclic frequency in Hz is the angular one in rad/s divided by 2 pi)"
    return ""
