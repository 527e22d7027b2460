"""The header of a COSMOS block: numbers at their places, unknown ones as None."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Final

from rockframe.records.fixed import whole
from rockframe.records.numbers import one_number
from rockframe.records.source import Source, quoted_first_line

_INTEGERS: Final = re.compile(
    r"(\d{1,4})\s+Integer-header values follow on\s+(\d{1,4})\s+lines?,?"
    r"\s*Format\s*=?\s*\(\s*(\d{1,3})I(\d{1,3})\)",
    re.IGNORECASE,
)
_REALS: Final = re.compile(
    r"(\d{1,4})\s+Real-header values follow on\s+(\d{1,4})\s+lines?,?"
    r"\s*Format\s*=?\s*\(\s*(\d{1,3})[FEG](\d{1,3})\.\d{1,3}\)",
    re.IGNORECASE,
)
_COMMENTS: Final = re.compile(r"(\d{1,6})\s+Comment line", re.IGNORECASE)
_UNKNOWN: Final = re.compile(r"unspecified:\s*(-?\d{1,8})\s*,?\s*(-?[\d.]{1,12})")
_USUAL_UNKNOWN: Final = (-999, -999.0)
_MOST_COMMENTS: Final = 200


@dataclass(frozen=True)
class Header:
    """Header of one block of a COSMOS file."""

    source: Source  # file
    start: int  # index of the block's first line, from 0
    text_lines: int  # how many lines of text it begins with
    integers_at: int  # index of the first line of the integers and of the reals
    reals_at: int
    integer_columns: int  # their layout
    integer_width: int
    real_columns: int
    real_width: int
    integer_count: int  # how many there are
    real_count: int
    comments: tuple[str, ...]  # comment lines
    data_at: int  # index of the line that announces the data
    unknown: tuple[int, float]  # what stands for an integer and for a real that is not known

    def line(self, place: int) -> str:
        """Give a text line, from 1; empty if there is none."""
        inside = 1 <= place <= self.text_lines
        return self.source.top(1, self.start + place - 1)[0] if inside else ""

    def integer(self, place: int) -> int | None:
        """Give an integer header value, from 1; None if it is unknown."""
        if not 1 <= place <= self.integer_count:
            return None
        row, column = divmod(place - 1, self.integer_columns)
        line = self.source.lines[self.integers_at + row]
        text = line[column * self.integer_width : (column + 1) * self.integer_width]
        value = whole(text)
        if value is None and text.strip():
            raise self.source.refuse(
                found=f"{quoted_first_line(text)} for integer header {place}",
                expected="a whole number",
                line=self.integers_at + row + 1,
            )
        return None if value == self.unknown[0] else value

    def real(self, place: int) -> float | None:
        """Give a real header value, from 1; None if it is unknown."""
        if not 1 <= place <= self.real_count:
            return None
        row, column = divmod(place - 1, self.real_columns)
        line = self.source.lines[self.reals_at + row]
        text = line[column * self.real_width : (column + 1) * self.real_width].strip()
        if not text:
            return None
        value = one_number(text, self.source, self.reals_at + row + 1)
        return None if math.isclose(value, self.unknown[1]) else value

    def real_line(self, place: int) -> int:
        """Give the line of a real header value, both from 1."""
        return self.reals_at + (place - 1) // self.real_columns + 1


def read_header(source: Source, start: int, end: int, text_lines: int) -> Header:
    """Read the header of a block."""
    at = start + text_lines
    integers, integers_at, reals_line = _section(source, at, end, _INTEGERS, "integer header")
    reals, reals_at, comments_line = _section(source, reals_line, end, _REALS, "real header")
    comments: tuple[str, ...] = ()
    data_at = comments_line
    said = _COMMENTS.search(source.top(1, comments_line)[0]) if comments_line < end else None
    if said is not None:
        first = comments_line + 1
        data_at = min(first + int(said.group(1)), end)
        comments = tuple(source.top(min(data_at - first, _MOST_COMMENTS), first))
    return Header(
        source=source,
        start=start,
        text_lines=min(text_lines, end - start),
        integers_at=integers_at,
        reals_at=reals_at,
        integer_columns=integers[1],
        integer_width=integers[2],
        real_columns=reals[1],
        real_width=reals[2],
        integer_count=integers[0],
        real_count=reals[0],
        comments=comments,
        data_at=data_at,
        unknown=_unknown(source.top(text_lines, start)),
    )


def _section(
    source: Source, at: int, end: int, announcement: re.Pattern[str], what: str
) -> tuple[tuple[int, int, int], int, int]:
    # one line of slack: some files have a text line more than they announce
    for index in (at, at + 1, at - 1):
        if not 0 <= index < end:
            continue
        match = announcement.search(source.top(1, index)[0])
        if match is None:
            continue
        count, lines, columns, width = (int(group) for group in match.groups())
        first = index + 1
        if columns < 1 or width < 1 or count > lines * columns or first + lines > end:
            found = f"{count} values on {lines} lines of {columns} ({what})"
            expected = "as many lines as these values need, and as many as follow"
            raise source.refuse(found=found, expected=expected, line=index + 1)
        return (count, columns, width), first, first + lines
    index = min(max(at, 0), end - 1)
    raise source.refuse(
        found=quoted_first_line(source.lines[index]),
        expected=f"the line that announces the {what}, such as '100 Integer-header values "
        "follow on 10 lines, Format= (10I8)'"
        if announcement is _INTEGERS
        else f"the line that announces the {what}, such as '100 Real-header values follow on "
        "20 lines, Format= (5F15.6)'",
        line=index + 1,
    )


def _unknown(lines: list[str]) -> tuple[int, float]:
    for line in reversed(lines):
        match = _UNKNOWN.search(line)
        if match is None:
            continue
        try:
            return int(match.group(1)), float(match.group(2).rstrip("."))
        except ValueError:  # two decimal points
            continue
    return _USUAL_UNKNOWN
