"""Text whose first numbers are no samples: how many there are, and the time step.

Either both in a line of their own, in any order, or one under the other::

    1559  0.02
    0.00630   0.00364   0.00099   0.00428   0.00758 ...

or the time step alone on top of one column.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from rockframe.records.checks import USUAL_TIME_STEPS
from rockframe.records.columns import COMMENT_MARKS, HEADER_LINES, Table
from rockframe.records.numbers import NUMBER, shape_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rockframe.records.source import Source

_WHOLE: Final = re.compile(r"\d{1,7}", re.ASCII)
_ONE_NUMBER: Final = re.compile(NUMBER, re.ASCII)
_FEWEST: Final = 4
_LOOKED_AT: Final = 20
_TIDY: Final = re.compile(r"0?\.0{0,4}[1-9]\d?(?:5|25|75)?0*", re.ASCII)


@dataclass(frozen=True)
class FirstLines:
    """A number of samples and a time step above the samples."""

    count: int  # number of samples
    time_step: float  # [s]
    line: int  # where they stand, from 1
    data_at: int  # index of the first line of samples, from 0


def find_first_lines(source: Source) -> FirstLines | None:
    """Look for a number of samples and a time step above the samples."""
    rows: list[tuple[int, list[str]]] = []
    for index, line in enumerate(source.top(3 * HEADER_LINES)):
        fields = line.split()
        if not fields or line.lstrip().startswith(COMMENT_MARKS):
            continue
        if all(_ONE_NUMBER.fullmatch(field) for field in fields):
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
        step = float(second.upper().replace("D", "E"))
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
    if len(fields) < _FEWEST or not low <= table.values[0, 0] <= high:
        return False
    shapes = {shape_of(field) for field in fields[1 : _LOOKED_AT + 1]}
    tidy = _TIDY.fullmatch(fields[0]) is not None
    return tidy and len(shapes) == 1 and shape_of(fields[0]) not in shapes
