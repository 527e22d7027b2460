"""Numbers in fixed width, as Fortran writes them: never split at blanks."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

import numpy as np

from rockframe.records.numbers import floats, is_plain, one_number, too_many, with_e
from rockframe.records.source import MAXIMUM_SAMPLES, Source, quoted_first_line

if TYPE_CHECKING:
    from rockframe.signals.arrays import Array

_LONGEST_COUNT: Final = 12
_WHOLE: Final = re.compile(r"[-+]?\d+", re.ASCII)


def fixed_width(
    source: Source, first: int, count: int, *, width: int, per_line: int, indent: int = 0
) -> Array:
    """Read numbers of one width that stand side by side."""
    if width < 1 or per_line < 1:
        found = f"a layout of {per_line} numbers of {width} characters in a line"
        raise source.refuse(found=found, expected="one or more of each", line=first)
    if count < 2:
        found = f"{count} samples announced"
        raise source.refuse(found=found, expected="two or more", line=first)
    if count > MAXIMUM_SAMPLES:
        raise too_many(source, count, line=first)
    needed = -(-count // per_line)
    lines = [line.rstrip()[indent:] for line in source.lines[first : first + needed]]
    if len(lines) < needed or not lines[-1]:
        held = min(sum(len(line) // width for line in lines), count - 1)
        raise source.refuse(
            found=f"the end of the file after {held} samples",
            expected=f"{count} samples",
            line=source.last_line,
        )
    full = width * per_line
    last = width * (count - per_line * (needed - 1))
    for index, line in enumerate(lines):
        length = full if index < needed - 1 else last
        if len(line) != length:
            fields = length // width
            raise source.refuse(
                found=f"{len(line)} characters ({quoted_first_line(line)})",
                expected=f"{length}: {fields} numbers of {width} characters",
                line=first + index + 1,
            )
    body = "".join(lines)
    fields = [body[place : place + width] for place in range(0, len(body), width)]
    if is_plain(body):
        for attempt in (fields, map(with_e, fields)):
            values = floats(list(attempt))
            if values is not None:
                return values
    checked = [
        one_number(field.strip(), source, first + index // per_line + 1)
        for index, field in enumerate(fields)
    ]
    return np.array(checked, dtype=np.float64)


def cell(source: Source, first: int, place: int, *, width: int, per_line: int) -> str:
    """Give one field of a header of fixed width, without blanks around it."""
    row, column = divmod(place - 1, per_line)
    if first + row >= len(source.lines):
        return ""
    return source.lines[first + row][column * width : (column + 1) * width].strip()


def header_number(
    source: Source, first: int, place: int, *, width: int, per_line: int, what: str
) -> float:
    """Read one number of a header of fixed width."""
    text = cell(source, first, place, width=width, per_line=per_line)
    line = first + (place - 1) // per_line + 1
    if not text:
        raise source.refuse(found=f"no {what}", expected=f"a number ({what})", line=line)
    return one_number(text, source, line)


def header_count(
    source: Source, first: int, place: int, *, width: int, per_line: int, what: str
) -> int:
    """Read one whole number of a header of fixed width, like :func:`header_number`."""
    text = cell(source, first, place, width=width, per_line=per_line)
    line = first + (place - 1) // per_line + 1
    value = whole(text)
    if value is None:
        found = f"{quoted_first_line(text)} for the {what}"
        raise source.refuse(found=found, expected="a whole number", line=line)
    return value


def whole(text: str) -> int | None:
    """Read a whole number; None if it is none, or too long to be one."""
    text = text.strip()
    if len(text) > _LONGEST_COUNT or _WHOLE.fullmatch(text) is None:
        return None
    return int(text)
