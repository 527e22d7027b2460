"""Unit names as record files spell them.

Record files write ``g`` for the acceleration of gravity and ``gal`` for cm/s^2, which are otherwise
the gram and the gallon. This table is for units *of records* only; all other arguments of rockframe
are read by :mod:`rockframe.units`.
"""

import re
from dataclasses import dataclass
from typing import Final

from rockframe.constants import STANDARD_GRAVITY
from rockframe.errors import ComponentError, UnitsError, short_repr
from rockframe.units import ACCELERATION, Measure, to_si


@dataclass(frozen=True)
class RecordUnit:
    """An acceleration unit of a record."""

    spelling: str  # spelling for `rockframe.units`
    factor: float  # value of one unit [m s^-2]


_G: Final = RecordUnit("g_0", STANDARD_GRAVITY)
_MILLI_G: Final = RecordUnit("1e-3 g_0", 1e-3 * STANDARD_GRAVITY)
_PER_CENT_G: Final = RecordUnit("1e-2 g_0", 1e-2 * STANDARD_GRAVITY)
_TENTH_G: Final = RecordUnit("1e-1 g_0", 1e-1 * STANDARD_GRAVITY)
_GAL: Final = RecordUnit("cm/s^2", 0.01)
_MILLI_GAL: Final = RecordUnit("1e-3 cm/s^2", 1e-5)

_METRES: Final = {
    **{"m": 1.0, "cm": 0.01, "mm": 0.001, "um": 1e-6, "nm": 1e-9},
    **{"in": 0.0254, "ft": 0.3048},
}
_PER_SECOND_SQUARED: Final = tuple(
    pattern.format(second=second)
    for second in ("s", "sec")
    for pattern in (
        "/{second}2",
        "/{second}^2",
        "/{second}/{second}",
        "/({second}^2)",
        "/({second}*{second})",
        "{second}-2",
        "{second}^-2",
        "{second}^(-2)",
    )
)

_TRY_UNIT: Final = Measure("an acceleration", ACCELERATION.unit, "m/s^2")

ACCELERATION_UNITS: Final[dict[str, RecordUnit]] = {
    **dict.fromkeys(("g", "g's", "gs", "g0", "g_0", "gravity", "standard_gravity"), _G),
    **dict.fromkeys(("mg", "milli-g", "millig", "g/1000"), _MILLI_G),
    **dict.fromkeys(("%g", "g/100"), _PER_CENT_G),
    **dict.fromkeys(("g/10",), _TENTH_G),
    **dict.fromkeys(("gal", "gals", "galileo"), _GAL),
    **dict.fromkeys(("mgal", "milligal"), _MILLI_GAL),
    **{
        f"{length}{per_second_squared}": RecordUnit(f"{length}/s^2", factor)
        for length, factor in _METRES.items()
        for per_second_squared in _PER_SECOND_SQUARED
    },
}
"""Acceleration units by name: lower case, no blanks, powers with ``^``."""

OTHER_QUANTITIES: Final[dict[str, str]] = {
    **{f"{length}/{s}": "a velocity" for length in _METRES for s in ("s", "sec")},
    **{f"{length}{s}-1": "a velocity" for length in _METRES for s in ("s", "s^")},
    **dict.fromkeys(_METRES.keys() - {"nm", "um"}, "a displacement"),  # NM is New Mexico, too
}
"""Units of other quantities than an acceleration, spelt as above."""


STATED_UNIT: Final = r"\bunits?\s*(?:\bof\b|\bare\b|\bis\b|[:=])\s*"
SLASHED: Final = r"(?:\s{0,3}[/*^]\s{0,3}[^\s()\[\],;]{1,12}){0,4}"
"""Patterns of the words before a unit in a header, and of its parts after slashes and signs
of multiplication, with blanks between them."""


def normalised(name: str) -> str:
    """Spell a unit name as the tables here do."""
    text = re.sub(r"\s+", "", name.casefold())
    text = text.replace("**", "^").replace("²", "^2").replace("·", "").replace("⁻^2", "^-2")
    text = re.sub(r"^[µμ]m", "um", text)
    short = {"centi": "cm", "milli": "mm", "micro": "um", "nano": "nm", None: "m"}
    spelt_out = r"^(centi|milli|micro|nano)?met(?:er|re)s?(?=/|s|$)"
    return re.sub(spelt_out, lambda match: short[match[1]], text)


def acceleration_unit(name: str) -> RecordUnit | None:
    """Look up an acceleration unit by its name in a record; None if it is unknown."""
    return ACCELERATION_UNITS.get(normalised(name))


def other_quantity(name: str) -> str | None:
    """Return the other quantity of a unit name; None if it is unknown."""
    return OTHER_QUANTITIES.get(normalised(name))


def argument_unit(unit: object, *, owner: str) -> RecordUnit:
    """Read the ``unit=`` argument for a record file."""
    text = str(unit)
    parsed = acceleration_unit(text)
    if parsed is not None:
        return parsed
    msg = (
        f"{owner}: unit needs the unit of an acceleration, got {short_repr(text)}; "
        "write for example unit='g', unit='cm/s^2' or unit='m/s^2'"
    )
    try:
        factor = to_si(f"1 {text}", _TRY_UNIT, owner=owner, name="unit")
    except (UnitsError, ComponentError) as problem:
        raise UnitsError(msg) from problem
    if not factor > 0.0:
        raise UnitsError(msg)
    return RecordUnit(text, factor)
