"""CSMIP volume 1 as it was first written: pairs of time and acceleration.

So are the files of the University of Southern California and of RENADIC, Chile. Below
the text stand 100 integers and 50 reals, then the pairs, five in a line; the text says how
many there are, and in which units::

    NO. OF POINTS =   3500  RECORD LENGTH = 35.000 SEC
    UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  = -0.051 G, AT   3.910 SEC

Many were digitised by hand, at uneven times. Those are refused.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from rockframe.records.fixed import fixed_width
from rockframe.records.source import Source, quoted_first_line
from rockframe.records.timing import uniform_step

if TYPE_CHECKING:
    from rockframe.signals.arrays import Array

_POINTS: Final = re.compile(r"\bNO\. OF POINTS\s*=\s*(\d{1,9})", re.IGNORECASE)
_UNITS: Final = re.compile(
    r"\bUNITS\b.{0,20}?\bARE\s+SEC(?:ONDS)?\s+AND\s+([^\s,;]{1,12})", re.IGNORECASE
)
_WHOLE_NUMBERS: Final = re.compile(r"[-\d\s]*\d[-\d\s]*", re.ASCII)
_REAL_NUMBERS: Final = re.compile(r"[-.\d\s]*\.[-.\d\s]*", re.ASCII)
_FULL: Final = 10
_REALS: Final = 50
_WIDTHS: Final = range(6, 11)
_LONGEST_HEADER: Final = 80


@dataclass(frozen=True)
class Pairs:
    """Where the pairs of one channel stand."""

    count: int  # how many
    unit: str  # of the accelerations, as the text names it
    unit_line: int  # where it does, from 1
    data_at: int  # index of their first line, from 0

    @property
    def behind(self) -> int:
        """Index of the first line behind them, from 0."""
        return self.data_at + -(-2 * self.count // _FULL)


def find_pairs(source: Source, first: int) -> Pairs | None:
    """Look for pairs below a channel's first line."""
    top = [line.rstrip() for line in source.top(_LONGEST_HEADER, first)]
    points = next((m for line in top if (m := _POINTS.search(line))), None)
    units = next(((k, m) for k, line in enumerate(top) if (m := _UNITS.search(line))), None)
    if points is None or units is None:
        return None
    place = units[0]
    while place < len(top) and _WHOLE_NUMBERS.fullmatch(top[place]) is None:
        place += 1
    while place < len(top) and _WHOLE_NUMBERS.fullmatch(top[place]):
        place += 1
    reals = 0
    while place < len(top) and reals < _REALS and _REAL_NUMBERS.fullmatch(top[place]):
        reals += len(top[place].split())
        place += 1
    if reals < _REALS or place >= len(top):
        return None
    unit = units[1].group(1).rstrip(".")
    return Pairs(int(points.group(1)), unit, first + units[0] + 1, first + place)


def read_pairs(source: Source, pairs: Pairs) -> tuple[float, Array]:
    """Read pairs that are evenly spaced."""
    line = source.lines[pairs.data_at].rstrip()
    per_line = min(_FULL, 2 * pairs.count)
    width, indent = divmod(len(line), max(per_line, 1))
    if width not in _WIDTHS or indent > 1 or line[:indent].strip():
        raise source.refuse(
            found=f"a line of {len(line)} characters ({quoted_first_line(line)})",
            expected=f"{per_line} numbers of one width, pairs of time and acceleration",
            line=pairs.data_at + 1,
        )
    layout = {"width": width, "per_line": _FULL, "indent": indent}
    values = fixed_width(source, pairs.data_at, 2 * pairs.count, **layout).reshape(-1, 2)
    rows = source.lines[pairs.data_at : pairs.behind]
    printed = [
        row[indent + place : indent + place + width].strip()
        for row in rows
        for place in range(0, len(row.rstrip()) - indent, 2 * width)
    ]
    time_step, misfit = uniform_step(values[:, 0], printed)
    if misfit is not None:
        found = f"the time {printed[misfit]} after {printed[misfit - 1]}, unevenly sampled"
        expected = "even times; the corrected record of the set, or from_times, has them"
        place = pairs.data_at + 2 * misfit // _FULL + 1
        raise source.refuse(found=found, expected=expected, line=place)
    return time_step, values[:, 1].copy()
