"""Plain text: one column (acceleration) or two (time, acceleration)."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Final

from rockframe.motion.readers.checks import (
    check_asked_time_step,
    check_time_step,
    choose_unit,
)
from rockframe.motion.readers.columns import HEADER_LINES, Table, read_table, split_header
from rockframe.motion.readers.components import Component, choose_component
from rockframe.motion.readers.numbers import ends_inside_number
from rockframe.motion.readers.source import Metadata, Record, Request, Source, shown
from rockframe.motion.readers.timing import uniform_step
from rockframe.motion.unit_names import acceleration_unit, other_quantity

if TYPE_CHECKING:
    from collections.abc import Iterator

NAME: Final = "text"
TITLE: Final = "text or CSV, one column (acceleration) or two (time, acceleration)"
SUFFIXES: Final = (".txt", ".csv", ".dat", ".tsv", ".asc")

TIME_UNITS: Final = {
    **dict.fromkeys(("s", "sec", "secs", "sec.", "second", "seconds"), 1.0),
    **dict.fromkeys(("ms", "msec", "millisecond", "milliseconds"), 1e-3),
}

# brackets inside brackets once, as in [1/(s^2)]; no blank can be matched in two ways
_BRACKETED: Final = re.compile(r"[(\[{]([^()\[\]{}]*(?:\([^()]*\)[^()\[\]{}]*)?)[)\]}]")
_STATED: Final = re.compile(
    r"\bunits?\s*(?:\bof\b|\bare\b|\bis\b|[:=])\s*[(\[]?\s*([^\s()\[\],;]+)", re.IGNORECASE
)
_ACCELERATION_NAME: Final = re.compile(r"\W*(acc|a\b|ag\b)", re.IGNORECASE)
_TIME_NAME: Final = re.compile(r"\W*(time|t)\b", re.IGNORECASE)
_OTHER_KIND: Final = re.compile(r"(?<![a-z])(vel|disp)", re.IGNORECASE)


def recognises(source: Source) -> bool:
    """Tell whether a row of numbers stands near the top."""
    return any(re.match(r"\s*[-+.\d]", line) for line in source.top(4 * HEADER_LINES))


def read(source: Source, request: Request) -> Record:
    """Read one or two columns of numbers.

    Parameters
    ----------
    source : Source
        File.
    request : Request
        What the caller asked for.

    Returns
    -------
    Record

    Raises
    ------
    RecordError
        Not one or two columns of numbers, an uneven time step, or no unit.
    """
    table = read_table(source, most_columns=2)
    rows, columns = table.values.shape
    if rows < 2:
        found = "one row of numbers"
        raise source.refuse(found=found, expected="at least two samples", line=table.lines[0])
    if ends_inside_number(source, table.last_fields):
        found = f"the end of the file inside a number ({rows} samples)"
        raise source.refuse(found=found, expected="a complete file", line=table.lines[-1])
    names = _column_names(source, table)
    unit_name, unit_line = _acceleration_unit(source, table, asked=request.unit is not None)
    unit, as_read, warnings = choose_unit(source, request, unit_name, unit_line)
    metadata: Metadata = {"unit_as_read": as_read}
    if table.header:
        metadata["description"] = table.header[0][1].lstrip("#% \t")
    if columns == 1:
        time_step = _asked_step(source, request)
    else:
        scale = _time_scale(source, table, names)
        time_step = _step(source, table, scale)
        check_asked_time_step(source, request, time_step, table.lines[1])
        start = float(table.values[0, 0]) * scale
        if start != 0.0:
            metadata["start_time"] = start
    samples = table.values[:, -1].copy()
    record = Record(time_step, samples, unit, metadata, warnings=tuple(warnings))
    return choose_component(source, request, [Component(None, lambda: record)])


def _asked_step(source: Source, request: Request) -> float:
    if request.time_step is None:
        raise source.refuse(
            found="one column and no times",
            expected="a column of times, or the argument time_step such as time_step='0.005 s'",
        )
    check_time_step(source, request.time_step, None)
    return request.time_step


def _step(source: Source, table: Table, scale: float) -> float:
    step, misfit = uniform_step(table.values[:, 0], table.first_fields)
    if misfit is not None:
        before, after = table.first_fields[misfit - 1 : misfit + 1]
        found = f"the time {after} after {before}"
        expected = f"a uniform time step (here about {step:.6g}); resample the record first"
        raise source.refuse(found=found, expected=expected, line=table.lines[misfit])
    # 15 digits: a step of 5.3 ms is the float 0.0053, without the rounding of 5.3 * 1e-3
    seconds = step if math.isclose(scale, 1.0) else float(f"{step * scale:.15g}")
    check_time_step(source, seconds, table.lines[1])
    return seconds


def _column_names(source: Source, table: Table) -> list[str]:
    columns = table.values.shape[1]
    for line, text in reversed(table.header):
        names = split_header(text, table.separator)
        if len(names) != columns:
            continue
        last = names[-1]
        if _OTHER_KIND.search(last) and not _ACCELERATION_NAME.match(last):
            raise source.refuse(
                found=f"the column {shown(last)}", expected="an acceleration", line=line
            )
        if columns == 2 and (_ACCELERATION_NAME.match(names[0]) or _TIME_NAME.match(last)):
            found = f"the columns {names[0]!r}, {last!r}"
            raise source.refuse(
                found=found, expected="the time first, then the acceleration", line=line
            )
        return names
    return []


def _time_scale(source: Source, table: Table, names: list[str]) -> float:
    for name in names[:1]:
        for unit in _in_brackets(name):
            known = TIME_UNITS.get(unit.casefold())
            if known is None:
                line = table.header[-1][0]
                found = f"the unit {unit!r} of the times"
                raise source.refuse(
                    found=found, expected="seconds (s) or milliseconds (ms)", line=line
                )
            return known
        if name.casefold() in TIME_UNITS:
            return TIME_UNITS[name.casefold()]
    units = {
        TIME_UNITS[unit.casefold()]
        for _, text in table.header
        for unit in _in_brackets(text)
        if unit.casefold() in TIME_UNITS
    }
    return units.pop() if len(units) == 1 else 1.0


def _acceleration_unit(
    source: Source, table: Table, *, asked: bool
) -> tuple[str | None, int | None]:
    unknown: tuple[str, int] | None = None
    other: tuple[str, int] | None = None
    known: list[tuple[str, int, float]] = []
    for line, name, certain in _unit_candidates(table):
        unit = acceleration_unit(name)
        if unit is not None:
            known.append((name, line, unit.factor))
        elif certain and name.casefold() not in TIME_UNITS:
            if other_quantity(name) is not None:
                other = other or (name, line)
            else:
                unknown = unknown or (name, line)
    if known:
        name, line, factor = known[0]
        differing = [entry for entry in known if not math.isclose(entry[2], factor)]
        if differing and not asked:
            found = f"the units {name!r} and {differing[0][0]!r} (line {differing[0][1]})"
            raise source.refuse(found=found, expected="one unit, or the argument unit", line=line)
        return name, line
    return other or unknown or (None, None)


def _unit_candidates(table: Table) -> Iterator[tuple[int, str, bool]]:
    # nearest the numbers first; in brackets, after the word "unit", or as a field
    # of its own; "certain" is a name that must be a unit
    columns = table.values.shape[1]
    for position, (line, text) in enumerate(reversed(table.header)):
        fields = split_header(text, table.separator)
        is_unit = [_is_unit(field) for field in fields]
        for field, unit in zip(fields, is_unit, strict=True):
            if unit and ("/" in field or (all(is_unit) and len(fields) == columns)):
                yield line, field, True
        for name in _STATED.findall(text):
            yield line, name.rstrip("."), True
        in_brackets = _in_brackets(text)
        for name in in_brackets:
            yield line, name, position == 0 and name == in_brackets[-1]


def _in_brackets(text: str) -> list[str]:
    return [name.strip() for name in _BRACKETED.findall(text)]


def _is_unit(name: str) -> bool:
    known = acceleration_unit(name) is not None or other_quantity(name) is not None
    return known or name.casefold() in TIME_UNITS
