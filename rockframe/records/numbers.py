"""From text to numbers: a fast path, and a careful one that names the line at fault."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Final

import numpy as np

from rockframe.records.source import MAXIMUM_SAMPLES, Source, quoted_first_line

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rockframe.errors import RecordError
    from rockframe.signals.arrays import Array

# written so that no digit can be matched in two ways: a failed match stays linear
NUMBER: Final = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[EeDd][-+]?\d+)?"
_ONE_NUMBER: Final = re.compile(NUMBER, re.ASCII)
_SHAPE: Final = re.compile(r"[-+]?\d*(\.\d*)?(?:[EeDd][-+]?(\d+))?", re.ASCII)
_SAME_SHAPE: Final = 20
_FEWEST: Final = 4
_CHUNK: Final = 2**20


def free_format(source: Source, first: int, end: int | None = None) -> Array:
    """Read all numbers from a line to the end of the file, or to another line."""
    parts: list[Array] = []
    count = 0
    for start, stop in _chunks(source, first, len(source.lines) if end is None else end):
        part = _fields(source, start, stop)
        count += part.size
        if count > MAXIMUM_SAMPLES:
            raise too_many(source, count, line=stop)
        parts.append(part)
    return np.concatenate(parts) if parts else np.empty(0)


def too_many(source: Source, count: int, line: int | None = None) -> RecordError:
    """Build the error for more samples than a record can have."""
    expected = f"at most {MAXIMUM_SAMPLES} samples"
    return source.refuse(found=f"{count} or more numbers", expected=expected, line=line)


def floats(fields: Sequence[str]) -> Array | None:
    """Convert fields at once; None if one of them is not a plain finite number."""
    try:
        values = np.fromiter(map(float, fields), dtype=np.float64, count=len(fields))
    except ValueError:
        return None
    return values if np.isfinite(values).all() else None


def is_plain(text: str) -> bool:
    """Tell whether text is free of what Python takes for a number and files do not."""
    return text.isascii() and "_" not in text


def one_number(text: str, source: Source, line: int) -> float:
    """Read one field that must be one finite number."""
    if _ONE_NUMBER.fullmatch(text) is None:
        raise source.refuse(found=quoted_first_line(text), expected="a number", line=line)
    value = float(text.upper().replace("D", "E"))
    if not math.isfinite(value):
        raise source.refuse(
            found=f"{quoted_first_line(text)}, which overflows",
            expected="a finite number",
            line=line,
        )
    return value


def ends_inside_number(source: Source, fields: Sequence[str]) -> bool:
    """Tell whether a file stops in the middle of its last number."""
    last_line = source.lines[-1]
    if not last_line or last_line[-1].isspace():
        return False
    if len(source.lines) > 1 and len(last_line) == len(source.lines[-2]) and " 0" in last_line[-2:]:
        return False
    shapes = {shape_of(field) for field in fields[-_SAME_SHAPE - 1 : -1]}
    if len(shapes) != 1 or len(fields) < _FEWEST:
        return False
    usual, last = shapes.pop(), shape_of(fields[-1])
    return usual is not None and (last is None or last < usual)


def last_fields(source: Source, first: int, count: int = _SAME_SHAPE + 1) -> list[str]:
    """Give the last fields of a file, as printed."""
    fields: list[str] = []
    for line in reversed(source.lines[first:]):
        fields = line.split()[-count:] + fields
        if len(fields) >= count:
            break
    return fields[-count:]


def _chunks(source: Source, first: int, last: int) -> Iterator[tuple[int, int]]:
    # in pieces, so that the fields of a long file are never all in memory
    start, size = first, 0
    for index in range(first, last):
        size += len(source.lines[index]) + 1
        if size >= _CHUNK:
            yield start, index + 1
            start, size = index + 1, 0
    if start < last:
        yield start, last


def _fields(source: Source, first: int, end: int) -> Array:
    body = " ".join(source.lines[first:end])
    fields = body.split()
    if len(fields) > MAXIMUM_SAMPLES:
        raise too_many(source, len(fields), line=end)
    values = floats(fields) if is_plain(body) else None
    if values is not None:
        return values
    collected: list[Array] = []
    for index in range(first, end):
        fields = source.lines[index].split()
        # D is how Fortran writes the exponent of a double
        values = (
            floats([with_e(field) for field in fields]) if is_plain(source.lines[index]) else None
        )
        if values is None:
            pieces = [piece for field in fields for piece in _careful(field, source, index + 1)]
            values = np.array(pieces, dtype=np.float64)
        collected.append(values)
    return np.concatenate(collected)


def with_e(field: str) -> str:
    """Write the exponent of a number as Python does."""
    return field.replace("D", "E").replace("d", "e")


def shape_of(field: str) -> tuple[int, int] | None:
    """Count the digits of the exponent and behind the point; None if it is no number."""
    match = _SHAPE.fullmatch(field)
    if match is None:
        return None
    decimals, exponent = match.groups()
    return len(exponent or ""), len(decimals or "")


def _careful(field: str, source: Source, line: int) -> list[float]:
    # Fortran writes fixed-width numbers without a blank between them when they
    # fill their width. A sign then shows where the next one starts; without a
    # sign, or without a decimal point, that place is a guess.
    pieces: list[str] = []
    position = 0
    for match in _ONE_NUMBER.finditer(field):
        if match.start() != position:
            break
        pieces.append(match.group())
        position = match.end()
    if position != len(field) or not pieces:
        raise source.refuse(found=quoted_first_line(field), expected="a finite number", line=line)
    together = len(pieces) > 1
    if together and not all(piece[0] in "+-" and "." in piece for piece in pieces[1:]):
        found = f"{quoted_first_line(field)}, numbers run together"
        raise source.refuse(
            found=found, expected="blanks, or signs, between the numbers", line=line
        )
    if together and "." not in pieces[0]:
        raise source.refuse(found=quoted_first_line(field), expected="a finite number", line=line)
    return [one_number(piece, source, line) for piece in pieces]
