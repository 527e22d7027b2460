"""How a quantity is written: one plain number, and a unit.

Whatever else stands in a text pint drops, and multiplies what is left: ``2'500 mm`` would be
2 times 500 mm. So a text is taken apart here, and pint only sees what has been understood.
"""

import re
from dataclasses import dataclass
from typing import Final

_DIGITS: Final = r"\d+(?:_\d+)*"
_NUMBER: Final = (
    rf"[-+]?(?:(?:{_DIGITS}(?:\.(?:{_DIGITS})?)?|\.{_DIGITS})(?:[eE][-+]?\d+)?"
    r"|nan\b|inf(?:inity)?\b)"
)
_NUMBER_AND_UNIT: Final = re.compile(rf"\s*(?P<number>{_NUMBER})\s*(?P<unit>.*)", re.DOTALL)

_SPELLINGS: Final = str.maketrans("⋅\N{MULTIPLICATION SIGN}[]", "**()")
_DOUBLE_STAR: Final = re.compile(r"\s*(?:\*\*|\^)\s*")
_RAISED: Final = re.compile(r"(?<=[^\W\d_)])⁻?[⁰¹²³⁴-⁹]+")
_PLAIN: Final = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
_POWER: Final = r"(?:\d{1,2}(?:\.\d*)?|\.\d+)(?![\d^])"
_UNIT: Final = re.compile(
    # a second number, or a power of a number or of a power: no unit has them, and pint would
    # compute even 9**9**9; nor is there a sign before anything but a power
    rf"(?:[^\W\d_]|_\d*|\^(?:[-+]?{_POWER}|\([-+]{_POWER}\))|[\s*·()%‰°]|/(?!/)|\.(?!\d))*"
)
_NAME: Final = re.compile(r"[^\W\d]\w*")
_FOREIGN: Final = re.compile(r"[^\s\w*/^()%‰°·.+⁻-]")


@dataclass(frozen=True)
class WrittenQuantity:
    """A text that is one number and a unit."""

    number: float  # the number
    unit: str  # the unit as it is written, empty where there is none

    @property
    def plain(self) -> str:
        """The same, in a spelling of which pint drops nothing."""
        return f"{self.number!r} {self.unit.translate(_SPELLINGS)}"


def number_and_unit(text: str) -> tuple[str, str] | None:
    """Part a text behind the number that it begins with."""
    parts = _NUMBER_AND_UNIT.fullmatch(text)
    return None if parts is None else (parts["number"], parts["unit"])


def parse_quantity(text: str) -> WrittenQuantity | None:
    """Read a text as one number and a unit."""
    parts = number_and_unit(text)
    if parts is None or not _is_unit(parts[1]):
        return None
    return WrittenQuantity(float(parts[0]), parts[1])


def foreign_sign(text: str) -> str | None:
    """Give the first sign that stands neither in numbers nor in units; None if all do."""
    found = _FOREIGN.search(text.translate(_SPELLINGS))
    if found is not None:
        return found[0]
    # such as a fraction or a lowered figure, which are digits and yet in no number
    return next((one for one in text if one.isnumeric() and not _is_figure(one)), None)


def _is_unit(text: str) -> bool:
    """Whether all of a text is names, powers, and what parts them; the names may be unknown."""
    plain = _DOUBLE_STAR.sub("^", text.translate(_SPELLINGS))
    plain = _RAISED.sub(lambda power: f"^{power[0].translate(_PLAIN)}", plain)
    names: list[str] = _NAME.findall(plain)
    return _UNIT.fullmatch(plain) is not None and all(name.isidentifier() for name in names)


def _is_figure(one: str) -> bool:
    return one.isdecimal() or one in "⁰¹²³⁴⁵⁶⁷⁸⁹"
