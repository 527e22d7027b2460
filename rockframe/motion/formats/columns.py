"""Columns of numbers in text: separators, decimal commas, headers and comments."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from rockframe.motion.formats.numbers import NUMBER, number
from rockframe.motion.formats.source import Source, shown

if TYPE_CHECKING:
    from rockframe.motion.samples import Array

HEADER_LINES: Final = 20
COMMENT_MARKS: Final = ("#", "%")

_NUMBER: Final = re.compile(NUMBER, re.ASCII)
_ANY_NUMBER: Final = re.compile(rf"{NUMBER}|[-+]?\d*,\d+(?:[EeDd][-+]?\d+)?", re.ASCII)
_DECIMAL_COMMA: Final = re.compile(r"[-+]?\d*,\d+(?:[EeDd][-+]?\d+)?", re.ASCII)
_WHOLE_OR_COMMA: Final = re.compile(r"[-+]?\d+(?:,\d+)?(?:[EeDd][-+]?\d+)?", re.ASCII)
_GLUED_COMMA: Final = re.compile(r"\d,\d")
_NOT_A_WORD: Final = re.compile(r"[-+.\d*]|(?:nan|inf|infinity)$", re.IGNORECASE)


@dataclass(frozen=True)
class Table:
    """Columns of numbers and the lines above them.

    Parameters
    ----------
    values : ndarray, shape (n, columns)
        The numbers.
    fields : list of list of str
        As printed, with decimal points.
    lines : list of int
        Line of each row, from 1.
    header : list of tuple of int and str
        Line and text of header lines and of comments above the numbers.
    separator : str or None
        ``";"``, ``","`` or None for blanks and tabs.
    """

    values: Array
    fields: list[list[str]]
    lines: list[int]
    header: list[tuple[int, str]]
    separator: str | None


def read_table(source: Source) -> Table:
    """Read columns of numbers.

    Parameters
    ----------
    source : Source
        File.

    Returns
    -------
    Table

    Raises
    ------
    RecordError
        No numbers, a field that is not a number, rows of different length, or
        commas that can be read in two ways.
    """
    header, rows = _divide(source)
    decimal_comma = _has_decimal_commas(source, rows)
    separator = _separator(rows, decimal_comma=decimal_comma)
    fields = [_split(text, separator) for _, text in rows]
    _check_header(source, header, separator, len(fields[0]))
    for (line, text), row in zip(rows, fields, strict=True):
        if len(row) != len(fields[0]):
            found = f"{len(row)} fields ({shown(text)})"
            expected = f"{len(fields[0])} fields, as in line {rows[0][0]}"
            raise source.refuse(found=found, expected=expected, line=line)
    if decimal_comma:
        fields = [[field.replace(",", ".") for field in row] for row in fields]
    lines = [line for line, _ in rows]
    values = _numbers(source, fields, lines)
    return Table(values, fields, lines, header, separator)


def split_header(text: str, separator: str | None) -> list[str]:
    """Split a header line into the names of columns.

    Parameters
    ----------
    text : str
        Line, perhaps with a comment mark.
    separator : str or None
        Of the numbers.

    Returns
    -------
    list of str
    """
    names = text.lstrip("#% \t")
    if separator is None:
        # names of columns have blanks inside, so look for wider gaps first
        wide = [part for part in re.split(r"\t+|\s{2,}|[,;]", names.strip()) if part.strip()]
        return [part.strip() for part in wide] if len(wide) > 1 else names.split()
    return [part.strip().strip("\"'") for part in names.split(separator)]


def _divide(source: Source) -> tuple[list[tuple[int, str]], list[tuple[int, str]]]:
    header: list[tuple[int, str]] = []
    rows: list[tuple[int, str]] = []
    for line, raw in enumerate(source.lines, start=1):
        text = raw.strip()
        if not text:
            continue
        comment = text.startswith(COMMENT_MARKS)
        if comment or not (rows or _looks_numeric(text)):
            if not rows:
                header.append((line, text))
        else:
            rows.append((line, text))
        if (
            not rows
            and sum(not mark.startswith(COMMENT_MARKS) for _, mark in header) > HEADER_LINES
        ):
            break
    if not rows:
        found = f"no row of numbers below {shown(source.text)}"
        expected = f"one or two columns of numbers below at most {HEADER_LINES} header lines"
        raise source.refuse(found=found, expected=expected, line=header[0][0] if header else 1)
    return header, rows


def _looks_numeric(text: str) -> bool:
    parts = [part for part in re.split(r"[;\s]+", text) if part]
    return bool(parts) and all(
        _ANY_NUMBER.fullmatch(part)
        or all(not piece or _NUMBER.fullmatch(piece) for piece in part.split(","))
        for part in parts
    )


def _has_decimal_commas(source: Source, rows: list[tuple[int, str]]) -> bool:
    first_comma = next(((line, text) for line, text in rows if "," in text), None)
    if first_comma is None:
        return False
    first_point = next(((line, text) for line, text in rows if "." in text), None)
    if any(";" in text for _, text in rows):
        for line, text in rows:
            for part in (piece.strip() for piece in text.split(";")):
                if "," in part and not _DECIMAL_COMMA.fullmatch(part):
                    raise source.refuse(found=shown(part), expected="a number", line=line)
        if first_point is not None:
            found = f"a comma inside {shown(first_comma[1])}, a point in line {first_point[0]}"
            expected = "one decimal sign throughout"
            raise source.refuse(found=found, expected=expected, line=first_comma[0])
        return True
    if first_point is not None:
        return False
    spread = all(
        len(text.split()) > 1 and all(_WHOLE_OR_COMMA.fullmatch(part) for part in text.split())
        for _, text in rows
    )
    glued = any(_GLUED_COMMA.search(text) for _, text in rows)
    if glued and not spread:
        found = f"{shown(first_comma[1])}, where the comma may be a decimal sign or a separator"
        expected = "decimal points, or ';' between columns with decimal commas"
        raise source.refuse(found=found, expected=expected, line=first_comma[0])
    return spread and glued


def _separator(rows: list[tuple[int, str]], *, decimal_comma: bool) -> str | None:
    if any(";" in text for _, text in rows):
        return ";"
    if not decimal_comma and any("," in text for _, text in rows):
        return ","
    return None


def _split(text: str, separator: str | None) -> list[str]:
    if separator is None:
        return text.split()
    return [part.strip() for part in text.removesuffix(separator).split(separator)]


def _check_header(
    source: Source, header: list[tuple[int, str]], separator: str | None, columns: int
) -> None:
    # a damaged first row must not pass for a header line and be lost
    for line, text in header:
        if text.startswith(COMMENT_MARKS):
            continue
        parts = _split(text, separator)
        odd = [part for part in parts if not _NUMBER.fullmatch(part)]
        mixed = len(parts) == columns and len(odd) < columns
        single = len(text.split()) == 1 and separator is None
        if mixed or (single and _NOT_A_WORD.match(text)):
            raise source.refuse(
                found=shown(odd[0] if odd else text), expected="a number", line=line
            )
        if len(parts) == columns and all(_NOT_A_WORD.match(part) for part in parts):
            raise source.refuse(found=shown(text), expected="numbers", line=line)


def _numbers(source: Source, fields: list[list[str]], lines: list[int]) -> Array:
    flat = [field for row in fields for field in row]
    joined = "".join(flat)
    if joined.isascii() and "_" not in joined:
        try:
            values = np.array(list(map(float, flat)), dtype=np.float64)
        except ValueError:
            pass
        else:
            if np.isfinite(values).all():
                return values.reshape(len(fields), -1)
    checked = [
        [number(field, source, line) for field in row]
        for row, line in zip(fields, lines, strict=True)
    ]
    return np.array(checked, dtype=np.float64)
