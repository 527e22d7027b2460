"""Unit names as record files spell them.

Record files write ``g`` for the acceleration of gravity and ``gal`` for cm/s^2, which are otherwise
the gram and the gallon. This table is for units *of records* only; all other arguments of rockframe
are read by :mod:`rockframe.units`. The choice between the unit of the file and the argument
``unit`` is made here, too.
"""

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from rockframe.constants import STANDARD_GRAVITY
from rockframe.errors import ComponentError, UnitsError, short_repr
from rockframe.units import ACCELERATION, Measure, to_si

if TYPE_CHECKING:  # which imports this module
    from rockframe.records.reader import Request, Source


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
    return re.sub(spelt_out, lambda found: short[found[1]], text)


def acceleration_unit(name: str) -> RecordUnit | None:
    """Look up an acceleration unit by its name in a record; None if it is unknown."""
    return ACCELERATION_UNITS.get(normalised(name))


def other_quantity(name: str) -> str | None:
    """Return the other quantity of a unit name; None if it is unknown."""
    return OTHER_QUANTITIES.get(normalised(name))


def choose_unit(
    source: "Source", request: "Request", name: str | None, line: int | None
) -> tuple[RecordUnit, str, list[str]]:
    """Choose the unit of the samples from the file and the ``unit=`` argument.

    Parameters
    ----------
    source : Source
        File.
    request : Request
        Arguments of the caller.
    name : str or None
        Unit in the file, if any.
    line : int or None
        Its line number, from 1.

    Returns
    -------
    tuple of RecordUnit, str, list of str
        Unit, its name as read, warnings.

    Raises
    ------
    RecordError
        The unit of the file is unknown or not an acceleration, or there is none.

    Examples
    --------
    >>> from rockframe.records import Request, Source
    >>> unit, name, warnings = choose_unit(Source("a.sim", b"SIMPLE", ""), Request(), "gal", None)
    >>> unit.factor, name, warnings
    (0.01, 'gal', [])
    """
    known = None if name is None else acceleration_unit(name)
    if name is not None and known is None:
        other = other_quantity(name)
        if other is not None:
            raise source.refuse(found=f"{other} in {name}", expected="an acceleration", line=line)
    if request.unit is not None and request.unit_name is not None:
        warnings: list[str] = []
        if known is not None and not math.isclose(known.factor, request.unit.factor):
            where = source.path if line is None else f"{source.path}, line {line}"
            warnings.append(
                f"{where}: the unit of the file is {name!r}, but "
                f"unit={request.unit_name!r} was asked for and is used"
            )
        return request.unit, request.unit_name, warnings
    if name is None:
        raise source.refuse(
            found="no unit of the samples",
            expected="a unit in the header, or the argument unit, for example unit='g'",
        )
    if known is None:
        expected = "an acceleration unit such as g, gal, cm/s^2 or m/s^2 (or the argument unit)"
        raise source.refuse(found=f"the unknown unit {name!r}", expected=expected, line=line)
    return known, name, []


def argument_unit(unit: object, *, owner: str) -> RecordUnit:
    """Read the ``unit=`` argument for a record file."""
    text = str(unit)
    known = acceleration_unit(text)
    if known is not None:
        return known
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
