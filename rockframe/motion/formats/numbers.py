"""From text to numbers: a fast path, and a careful one that names the line at fault."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Final

import numpy as np

from rockframe.motion.formats.source import Source, shown

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rockframe.motion.samples import Array

NUMBER: Final = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][-+]?\d+)?"
_ONE_NUMBER: Final = re.compile(NUMBER, re.ASCII)
_SHAPE: Final = re.compile(r"[-+]?\d*(\.\d*)?(?:[EeDd][-+]?(\d+))?", re.ASCII)
_SAME_SHAPE: Final = 20
_FEWEST: Final = 4


def free_format(source: Source, first: int) -> Array:
    """Read all numbers from a line to the end of the file.

    Parameters
    ----------
    source : Source
        File.
    first : int
        Index of the first line of data, from 0.

    Returns
    -------
    ndarray, shape (n,)

    Raises
    ------
    RecordError
        A field is not a finite number, or numbers run together so that where
        one ends is not certain.
    """
    body = "\n".join(source.lines[first:])
    if "_" not in body and body.isascii():
        try:
            values = np.array(list(map(float, body.split())), dtype=np.float64)
        except ValueError:
            pass
        else:
            if np.isfinite(values).all():
                return values
    collected: list[float] = []
    for index in range(first, len(source.lines)):
        for field in source.lines[index].split():
            collected += _careful(field, source, index + 1)
    return np.array(collected, dtype=np.float64)


def number(text: str, source: Source, line: int) -> float:
    """Read one field that must be one finite number.

    Parameters
    ----------
    text : str
        Field.
    source : Source
        File, for the message.
    line : int
        Counted from 1.

    Returns
    -------
    float

    Raises
    ------
    RecordError
        Not a finite number.
    """
    if _ONE_NUMBER.fullmatch(text) is None:
        raise source.refuse(found=shown(text), expected="a number", line=line)
    value = float(text.upper().replace("D", "E"))
    if not math.isfinite(value):
        raise source.refuse(
            found=f"{shown(text)}, which overflows", expected="a finite number", line=line
        )
    return value


def ends_inside_number(text: str, fields: Sequence[str]) -> bool:
    """Tell whether a file stops in the middle of its last number.

    Parameters
    ----------
    text : str
        Of the file.
    fields : sequence of str
        The last numbers of the file, or of its last column, as printed.

    Returns
    -------
    bool
        True if nothing follows the last number, and it has fewer digits than
        the numbers before it, which all have the same.
    """
    if not text or text[-1].isspace():
        return False
    shapes = {_shape(field) for field in fields[-_SAME_SHAPE - 1 : -1]}
    if len(shapes) != 1 or len(fields) < _FEWEST:
        return False
    usual, last = shapes.pop(), _shape(fields[-1])
    return usual is not None and (last is None or last < usual)


def _shape(field: str) -> tuple[int, int] | None:
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
        raise source.refuse(found=shown(field), expected="a finite number", line=line)
    together = len(pieces) > 1
    if together and not all(piece[0] in "+-" and "." in piece for piece in pieces[1:]):
        found = f"{shown(field)}, numbers run together"
        raise source.refuse(
            found=found, expected="blanks, or signs, between the numbers", line=line
        )
    if together and "." not in pieces[0]:
        raise source.refuse(found=shown(field), expected="a finite number", line=line)
    return [number(piece, source, line) for piece in pieces]
