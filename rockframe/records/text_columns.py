"""Columns of numbers in text, and the lines above them.

If columns have no names, one record with several values in each line looks like several records in
columns. The order of reading differs: in one record a number is followed by that to its right, and
the last of a line by the first of the next; in columns it is followed by the number below.

The first numbers may be the number of samples and the time step instead of samples. Both are in
one line, in any order, or one below the other::

    1559  0.02
    0.00630   0.00364   0.00099   0.00428   0.00758 ...

or the time step alone on top of one column.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from rockframe.errors import RecordError
from rockframe.records.checks import USUAL_TIME_STEPS
from rockframe.records.numbers import (
    NUMBER,
    ONE_NUMBER,
    digit_counts,
    floats_or_none,
    is_plain_number_text,
    required_number,
    too_many_samples_error,
    with_exponent_e,
)
from rockframe.records.reader import HEADER_WIDTH, MAXIMUM_SAMPLES, Source, quoted_first_line
from rockframe.signals.arrays import Array

HEADER_LINES: Final = 20
_MAX_COMMENTS: Final = 2_000
_LAST: Final = 50
_MAX_NUMBERS: Final = 900_000
COMMENT_MARKS: Final = ("#", "%")

_ANY_NUMBER: Final = re.compile(rf"{NUMBER}|[-+]?\d*,\d+(?:[EeDd][-+]?\d+)?", re.ASCII)
_WHOLE_OR_COMMA: Final = r"[-+]?\d+(?:,\d+)?(?:[EeDd][-+]?\d+)?"
_SPREAD: Final = re.compile(rf"{_WHOLE_OR_COMMA}(?:\s+{_WHOLE_OR_COMMA})+", re.ASCII)
_GLUED_COMMA: Final = re.compile(r"\d,\d")
# with a decimal point, which dates do not have
_LIKE_NUMBERS: Final = re.compile(r"[-+\dEeDd*,;\s]*\.[-+.\dEeDd*,;\s]*", re.ASCII)
_NOT_A_WORD: Final = re.compile(r"[-+.\d*]|(?:nan|inf|infinity)$", re.IGNORECASE)


@dataclass(frozen=True)
class Table:
    """Columns of numbers and the lines above them."""

    values: Array  # the numbers
    first_fields: list[str]  # first column as printed, with decimal points
    last_fields: list[str]  # the last numbers of the last column, as printed
    lines: Sequence[int]  # line number of each row, from 1
    header: list[tuple[int, str]]  # number and text of header lines and comments above the numbers
    separator: str | None  # ``";"``, ``","`` or None for blanks and tabs
    rest: list[str]  # fields of an incomplete last row, which is not in `values`


def read_table(source: Source, most_columns: int) -> Table:
    """Read columns of numbers."""
    header, lines, rows = _split_lines(source)
    if len(rows) > MAXIMUM_SAMPLES:
        raise too_many_samples_error(source, len(rows), line=lines[MAXIMUM_SAMPLES])
    body = "\n".join(rows)
    decimal_comma = _has_decimal_commas(source, lines, rows, body)
    separator = ";" if ";" in body else "," if "," in body and not decimal_comma else None
    columns = len(_split(rows[0], separator))
    _check_header(source, header, separator, columns)
    if columns > most_columns:
        expected = f"at most {most_columns}: the time, if any, and accelerations"
        raise source.refuse(found=f"{columns} columns", expected=expected, line=lines[0])
    if columns * len(rows) > _MAX_NUMBERS:
        found = f"{columns} columns of {len(rows)} rows"
        raise source.refuse(found=found, expected=f"at most {_MAX_NUMBERS} numbers in all")
    if decimal_comma:
        rows = [text.replace(",", ".") for text in rows]
    plain = is_plain_number_text(body)
    del body
    last_row = _split(rows[-1], separator)
    if len(last_row) < columns and len(rows) > 1:
        rows = rows[:-1]
    else:
        last_row = []
    fields = _fields(source, rows, lines, separator, columns)
    values = floats_or_none(fields) if plain else None
    if values is None:
        checked = [
            required_number(field.strip(), source, lines[place // columns])
            for place, field in enumerate(fields)
        ]
        values = np.array(checked, dtype=np.float64)
    return Table(
        values.reshape(len(rows), columns),
        [field.strip() for field in fields[::columns]],
        [field.strip() for field in fields[columns - 1 :: columns][-_LAST:]],
        lines,
        header,
        separator,
        last_row,
    )


def check_last_row(source: Source, table: Table) -> None:
    """Refuse columns with an incomplete last row."""
    if table.rest:
        raise _uneven_row_error(source, table.rest, table.values.shape[1], table.lines, -1)


def interruption_warnings(source: Source, table: Table) -> list[str]:
    """Warn of blank or comment lines among numbers without times, which may be two records."""
    apart = np.diff(table.lines)
    places = np.flatnonzero(apart != apart[:1])  # the lines of some files are all two apart
    if not places.size:
        return []
    line = table.lines[int(places[0])] + 1
    interruption = next((text for text in source.lines[line - 1 : line + 2] if text.strip()), "")
    what = (
        quoted_first_line(interruption)
        if interruption.lstrip().startswith(COMMENT_MARKS)
        else "a blank line"
    )
    return [
        f"{source.path}, line {line}: {what} among the numbers, in {places.size} places; the "
        "numbers before and after it are read as one record"
    ]


def split_header(text: str, separator: str | None) -> list[str]:
    """Split a header line into the names of columns."""
    names = text.lstrip("#% \t")
    if separator is None:
        # names of columns may contain blanks, so wider gaps are tried first
        wide = [part for part in re.split(r"\t+|\s{2,}|[,;]", names.strip()) if part.strip()]
        return [part.strip() for part in wide] if len(wide) > 1 else names.split()
    return [part.strip().strip("\"'") for part in names.split(separator)]


def _split_lines(source: Source) -> tuple[list[tuple[int, str]], list[int], list[str]]:
    header, first = _header(source)
    lines: list[int] = []
    rows: list[str] = []
    for line, raw in enumerate(source.lines[first:], start=first + 1):
        text = raw.strip()
        if text and not text.startswith(COMMENT_MARKS):
            lines.append(line)
            rows.append(text)
    return header, lines, rows


def _header(source: Source) -> tuple[list[tuple[int, str]], int]:
    header: list[tuple[int, str]] = []
    words = 0
    for index, raw in enumerate(source.lines):
        text = raw.strip()
        if not text:
            continue
        comment = text.startswith(COMMENT_MARKS)
        if not comment and _looks_numeric(text):
            return header, index
        words += not comment
        if words > HEADER_LINES or len(header) >= _MAX_COMMENTS:
            break
        header.append((index + 1, text[:HEADER_WIDTH]))
    found = f"no row of numbers below {quoted_first_line(source.start)}"
    expected = f"columns of numbers below at most {HEADER_LINES} header lines"
    raise source.refuse(found=found, expected=expected, line=header[0][0] if header else 1)


def _looks_numeric(text: str) -> bool:
    parts = [part for part in re.split(r"[;\s]+", text) if part]
    return bool(parts) and all(
        _ANY_NUMBER.fullmatch(part)
        or all(not piece or ONE_NUMBER.fullmatch(piece) for piece in part.split(","))
        for part in parts
    )


def _has_decimal_commas(source: Source, lines: list[int], rows: list[str], body: str) -> bool:
    if "," not in body:
        return False
    comma = next(place for place, text in enumerate(rows) if "," in text)
    if ";" in body:
        if "." in body:
            point = next(place for place, text in enumerate(rows) if "." in text)
            found = (
                f"a comma inside {quoted_first_line(rows[comma])}, a point in line {lines[point]}"
            )
            expected = "one decimal sign throughout"
            raise source.refuse(found=found, expected=expected, line=lines[comma])
        return True
    if "." in body or _GLUED_COMMA.search(body) is None:
        return False
    if not all(map(_SPREAD.fullmatch, rows)):
        where = quoted_first_line(rows[comma])
        found = f"{where}, where the comma may be a decimal sign or a separator"
        expected = "decimal points, or ';' between columns with decimal commas"
        raise source.refuse(found=found, expected=expected, line=lines[comma])
    return True


def _fields(
    source: Source, rows: list[str], lines: list[int], separator: str | None, columns: int
) -> list[str]:
    fields: list[str] = []
    for place, text in enumerate(rows):
        parts = text.split() if separator is None else text.removesuffix(separator).split(separator)
        if len(parts) != columns:
            raise _uneven_row_error(source, parts, columns, lines, place)
        fields += parts
    return fields


def _uneven_row_error(
    source: Source, parts: list[str], columns: int, lines: Sequence[int], place: int
) -> RecordError:
    """Build the error for a row with another number of fields."""
    found = f"{len(parts)} fields ({quoted_first_line(' '.join(parts))})"
    expected = f"{columns} fields, as in line {lines[0]}"
    return source.refuse(found=found, expected=expected, line=lines[place])


def _split(text: str, separator: str | None) -> list[str]:
    if separator is None:
        return text.split()
    return [part.strip() for part in text.removesuffix(separator).split(separator)]


def _check_header(
    source: Source, header: list[tuple[int, str]], separator: str | None, columns: int
) -> None:
    # a damaged first row must not be taken for a header line
    for line, text in header:
        if text.startswith(COMMENT_MARKS):
            continue
        parts = _split(text, separator)
        odd = [part for part in parts if not ONE_NUMBER.fullmatch(part)]
        mixed = len(parts) == columns and len(odd) < columns
        single = len(text.split()) == 1 and separator is None
        if mixed or (single and _NOT_A_WORD.match(text)):
            raise source.refuse(
                found=quoted_first_line(odd[0] if odd else text), expected="a number", line=line
            )
        whole_row = len(parts) == columns and all(_NOT_A_WORD.match(part) for part in parts)
        if whole_row or (len(parts) > 1 and _LIKE_NUMBERS.fullmatch(text)):
            raise source.refuse(found=quoted_first_line(text), expected="numbers", line=line)


BY_ROWS: Final = "row by row"
"""Value of the argument ``component`` for one record with several values in each line."""

ROWS: Final = "rows"
COLUMNS: Final = "columns"

_PIECES: Final = 32
_MIN_ROWS: Final = 64
"""Number of pieces of a table whose means are compared; fewest rows for a decision."""

# These bounds recognise 93 % of 112 recorded components, each written into 2 to 12 columns, and
# take none of them for columns. They take none of 3170 tables of two to twelve simultaneous
# components for one record. Some of these are from floors of one building, and some have only each
# second to twentieth sample, so that they resemble noise.
_SURE: Final = 5.0  # standard errors
_SMOOTHER: Final = 0.2
_ROUGHER: Final = 0.1
_ALIKE: Final = 0.4
_APART: Final = 0.3
_EQUAL: Final = (0.5, 1.5)


def reading_order(values: Array) -> Literal["rows", "columns"] | None:
    """Tell whether a table is one record, row by row, or has one in each column."""
    rows, columns = values.shape
    if rows < _MIN_ROWS:
        return None
    flat = values.ravel() - values.mean()
    count = (rows - 1) * columns
    before, after, below = flat[:count], flat[1 : count + 1], flat[columns:]
    steps = ((after - before) ** 2).reshape(-1, columns)
    down = ((below - before) ** 2).reshape(-1, columns).sum(axis=1)
    along = steps.sum(axis=1)
    if not along.any():
        return None
    # all rows have the same weight, as those of strong motion are few
    smoothness = _share(down - along, down + along)
    size = (before**2 + after**2).reshape(-1, columns)
    likeness = _share(2.0 * (before * after).reshape(-1, columns), size)
    shares = _share(steps, along[:, None])[along > 0.0].mean(axis=0) * columns
    smoother, sure = _mean(smoothness[:, None])
    alike, certain = _mean(likeness)
    surely = abs(float(sure[0])) > _SURE
    least, most = _EQUAL
    if surely and smoother[0] > _SMOOTHER and alike.min() > _ALIKE and certain.min() > _SURE:
        return ROWS if shares.min() > least and shares.max() < most else None
    if surely and smoother[0] < -_ROUGHER and np.abs(alike).min() < _APART:
        return COLUMNS
    return None


def _share(part: Array, whole: Array) -> Array:
    """Return the ratio of two arrays; zero where the denominator is zero."""
    return np.divide(part, whole, out=np.zeros_like(part), where=whole > 0.0)


def _mean(values: Array) -> tuple[Array, Array]:
    """Return the means of columns, and their ratios to the standard errors."""
    pieces = np.array([piece.mean(axis=0) for piece in np.array_split(values, _PIECES)])
    mean = pieces.mean(axis=0)
    error = pieces.std(axis=0, ddof=1) / np.sqrt(_PIECES)
    return mean, mean / np.maximum(error, np.finfo(np.float64).tiny)


_WHOLE: Final = re.compile(r"\d{1,7}", re.ASCII)
_MIN_FIELDS: Final = 4
_INSPECTED_LINES: Final = 20
_ROUND_STEP: Final = re.compile(r"0?\.0{0,4}[1-9]\d?(?:5|25|75)?0*", re.ASCII)


@dataclass(frozen=True)
class FirstLines:
    """A number of samples and a time step above the samples."""

    count: int  # number of samples
    time_step: float  # time step [s]
    line: int  # number of their first line, from 1
    data_at: int  # index of the first line of samples, from 0


def find_first_lines(source: Source) -> FirstLines | None:
    """Find a number of samples and a time step above the samples; None without them."""
    rows: list[tuple[int, list[str]]] = []
    for index, line in enumerate(source.top(3 * HEADER_LINES)):
        fields = line.split()
        if not fields or line.lstrip().startswith(COMMENT_MARKS):
            continue
        if all(ONE_NUMBER.fullmatch(field) for field in fields):
            rows.append((index, fields))
        elif rows:
            break
        if len(rows) == 3:
            break
    if len(rows) < 2:
        return None
    one_line = len(rows[0][1]) == 2
    two_lines = len(rows) > 2 and len(rows[0][1]) == len(rows[1][1]) == 1
    if not (one_line or two_lines):
        return None
    head = rows[0][1] if one_line else [rows[0][1][0], rows[1][1][0]]
    below = rows[1 if one_line else 2]
    for first, second in (head, head[::-1]):
        step = float(with_exponent_e(second))
        low, high = USUAL_TIME_STEPS
        if _WHOLE.fullmatch(first) is None or int(first) < 2 or not low <= step <= high:
            continue
        held = sum(len(line.split()) for line in source.lines[below[0] :])
        count = int(first)
        apart = len(below[1]) != len(rows[0][1])
        if held == count or (apart and len(below[1]) > 2):
            return FirstLines(count, step, rows[0][0] + 1, below[0])
    return None


def looks_like_step(table: Table) -> bool:
    """Tell whether the first number of one column looks like a time step, not a sample."""
    fields: Sequence[str] = table.first_fields
    low, high = USUAL_TIME_STEPS
    if len(fields) < _MIN_FIELDS or not low <= table.values[0, 0] <= high:
        return False
    shapes = {digit_counts(field) for field in fields[1 : _INSPECTED_LINES + 1]}
    tidy = _ROUND_STEP.fullmatch(fields[0]) is not None
    return tidy and len(shapes) == 1 and digit_counts(fields[0]) not in shapes
