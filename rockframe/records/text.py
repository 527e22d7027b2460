"""Plain text: columns of numbers, optionally with a column of times."""

import math
import re
from dataclasses import replace
from typing import Final

import numpy as np

from rockframe.records.checks import (
    check_requested_time_step,
    check_time_step,
    checked_time_step,
    make_record,
)
from rockframe.records.components import FileComponent, choose_component
from rockframe.records.numbers import (
    all_numbers,
    check_end,
    last_fields,
    required_number,
    too_many_samples_error,
    uniform_step,
)
from rockframe.records.reader import (
    MAXIMUM_SAMPLES,
    Format,
    Metadata,
    Record,
    Request,
    Source,
    choose_unit,
)
from rockframe.records.text_columns import (
    BY_ROWS,
    COLUMNS,
    HEADER_LINES,
    ROWS,
    FirstLines,
    Table,
    check_last_row,
    find_first_lines,
    interruption_warnings,
    looks_like_step,
    read_table,
    reading_order,
)
from rockframe.records.text_header import (
    TextColumn,
    acceleration_columns,
    column_names,
    has_times,
    is_direction,
    is_rising,
    stated_peaks,
    stated_step,
    time_scale,
    unit_of_header,
)
from rockframe.signals.arrays import Array

MAX_COLUMNS: Final = 12

_AGREEMENT: Final = 1e-3
_ROUNDING: Final = 1e-6


def _recognises(source: Source) -> bool:
    return any(re.match(r"\s*[-+.\d]", line) for line in source.top(4 * HEADER_LINES))


def _read(source: Source, request: Request) -> Record:
    first_lines = find_first_lines(source)
    if first_lines is not None:
        return _counted(source, request, first_lines)
    table = read_table(source, MAX_COLUMNS)
    rows, columns = table.values.shape
    if rows < 2:
        found = "one row of numbers"
        raise source.refuse(found=found, expected="at least two samples", line=table.lines[0])
    names, line = column_names(source, table)
    timed = has_times(table, names)
    held = acceleration_columns(source, table, names, line, timed=timed)
    metadata: Metadata = {}
    if table.header:
        metadata["description"] = table.header[0][1].lstrip("#% \t")
    if columns > 1 and not (timed and (names or is_rising(table))):
        order = None if any(map(is_direction, names)) else reading_order(table.values)
        requested = (request.component or "").strip().casefold() == BY_ROWS
        if order == ROWS or (requested and order != COLUMNS):
            return _row_by_row(source, request, table, metadata)
        no_component_requested = request.every or request.component is None
        if order is None and no_component_requested and not names and not timed:
            found = f"{columns} columns without names, which may be one record, row by row"
            expected = f"component={BY_ROWS!r}, or a column such as component={held[0].name!r}"
            raise source.refuse(found=found, expected=expected, line=table.lines[0])
    check_last_row(source, table)
    check_end(source, table.last_fields, f"{rows} samples", table.lines[-1])
    warnings: list[str] = []
    first = 0
    if timed:
        scale = time_scale(source, table, names)
        time_step = _step(source, table, scale)
        check_requested_time_step(source, request, time_step, table.lines[1])
        warnings += _compare_step(source, table, time_step)
        start = float(table.values[0, 0]) * scale
        if start != 0.0:
            metadata["start_time"] = start
    else:
        time_step = _step_without_times(source, request, table)
        first, warnings = _first_sample(source, request, table)
        warnings += interruption_warnings(source, table)

    def samples(column: TextColumn) -> Record:
        values = table.values[first:, column.place].copy()
        return _record(source, request, table, column, time_step, values, metadata, warnings)

    if len(held) == 1 and columns <= 2:
        only = FileComponent(None, lambda: samples(held[0]))
        return choose_component(source, request, [only])
    components = [
        FileComponent(
            column.name,
            lambda column=column: samples(column),
            column.orientation,
            channel=place,
            line=line,
        )
        for place, column in enumerate(held, start=1)
    ]
    return choose_component(source, request, components)


def _row_by_row(source: Source, request: Request, table: Table, metadata: Metadata) -> Record:
    """Read a record that has several values in each line."""
    columns = table.values.shape[1]
    last_values = [required_number(field, source, table.lines[-1]) for field in table.rest]
    values = np.append(table.values.ravel(), last_values)
    if values.size > MAXIMUM_SAMPLES:
        raise too_many_samples_error(source, values.size, line=table.lines[-1])
    words = f"{values.size} samples, {columns} to a line"
    if request.component is not None and request.component.strip().casefold() != BY_ROWS:
        found = f"one record of {words}, row by row"
        expected = f"component={BY_ROWS!r}, or no component"
        raise source.refuse(found=found, expected=expected, line=table.lines[0])
    check_end(source, last_fields(source, table.lines[0] - 1), f"{values.size} samples")
    time_step = _step_without_times(source, request, table)
    single = replace(table, values=values[:, np.newaxis], rest=[])

    def samples() -> Record:
        only, warnings = TextColumn(0, ""), interruption_warnings(source, table)
        record = _record(source, request, single, only, time_step, values, metadata, warnings)
        return replace(record, history=(*record.history, f"{words}, read row by row"))

    return choose_component(source, request, [FileComponent(None, samples, aliases=(BY_ROWS,))])


def _record(
    source: Source,
    request: Request,
    table: Table,
    column: TextColumn,
    time_step: float,
    values: Array,
    metadata: Metadata,
    warnings: list[str],
) -> Record:
    name, line = column.unit, None
    if name is None or table.values.shape[1] <= 2:
        name, line = unit_of_header(source, table, requested=request.unit is not None)
    chosen = choose_unit(source, request, name, line)
    described: Metadata = {"unit_as_read": chosen[1], **metadata}
    stated = stated_peaks(table.header) if table.values.shape[1] <= 2 else []
    return make_record(
        source, values, time_step, chosen, described, stated=stated, warnings_after=warnings
    )


def _counted(source: Source, request: Request, head: FirstLines) -> Record:
    check_requested_time_step(source, request, head.time_step, head.line)

    def samples() -> Record:
        chosen = choose_unit(source, request, None, None)
        values = all_numbers(source, head.data_at)
        count = (head.count, "the number in front", head.line)
        record = make_record(source, values, head.time_step, chosen, {}, count=count)
        above = [text.strip() for text in source.top(head.line - 1) if text.strip()]
        metadata = record.metadata
        if above:
            metadata["description"] = above[0].lstrip("#% \t")
        history = (f"{head.count} samples and a time step, as line {head.line} says",)
        return replace(record, history=history)

    return choose_component(source, request, [FileComponent(None, samples)])


def _step_without_times(source: Source, request: Request, table: Table) -> float:
    stated = stated_step(table.header)
    if stated is not None:
        time_step, line = stated
        checked_time_step(source, request, time_step, line)
        return time_step
    if request.time_step is None:
        found = f"{'one column' if table.values.shape[1] == 1 else 'accelerations'} and no times"
        example = "time_step='0.005 s'"
        if table.values.shape[1] == 1 and looks_like_step(table):
            found += f", below {table.first_fields[0]}, which looks like a time step"
            example = f"time_step='{table.first_fields[0]} s'"
        expected = f"a column of times, or the argument time_step such as {example}"
        raise source.refuse(found=found, expected=expected)
    check_time_step(source, request.time_step, None)
    return request.time_step


def _first_sample(source: Source, request: Request, table: Table) -> tuple[int, list[str]]:
    """Return the row of the first sample, which may be below a time step, and warnings."""
    requested = request.time_step
    if requested is None or table.values.shape[1] > 1 or stated_step(table.header) is not None:
        return 0, []
    number, line = table.first_fields[0], table.lines[0]
    where = f"{source.path}, line {line}: {number} is"
    same = math.isclose(float(table.values[0, 0]), requested, rel_tol=_ROUNDING)
    if same and looks_like_step(table):
        return 1, [f"{where} the time step, as time_step says, and not read as a sample"]
    if same:
        return 0, [f"{where} the time step in time_step, but it is read as a sample"]
    if looks_like_step(table):
        raise source.refuse(
            found=f"{number} above the samples, which looks like a time step",
            expected=f"the {requested!r} s given by the argument time_step, or no such line",
            line=line,
        )
    return 0, []


def _step(source: Source, table: Table, scale: float) -> float:
    step, misfit = uniform_step(table.values[:, 0], table.first_fields)
    if misfit is not None:
        before, after = table.first_fields[misfit - 1 : misfit + 1]
        found = f"the time {after} after {before}"
        expected = f"a uniform time step (here about {step:.6g}); resample the record first"
        raise source.refuse(found=found, expected=expected, line=table.lines[misfit])
    # 15 digits, so that 5.3 ms are exactly the float 0.0053, without the error of 5.3 * 1e-3
    seconds = step if math.isclose(scale, 1.0) else float(f"{step * scale:.15g}")
    check_time_step(source, seconds, table.lines[1])
    return seconds


def _compare_step(source: Source, table: Table, time_step: float) -> list[str]:
    stated = stated_step(table.header)
    if stated is None or math.isclose(stated[0], time_step, rel_tol=_AGREEMENT):
        return []
    return [
        f"{source.path}, line {stated[1]}: the header states a time step of {stated[0]:g} s, "
        f"but the times are {time_step:g} s apart; the times are used"
    ]


TEXT: Final = Format(
    "text",
    "text or CSV, columns of accelerations, with or without the time",
    (".txt", ".csv", ".dat", ".tsv", ".asc"),
    _recognises,
    _read,
    holds="one or several",
    unit="in the header, or unit",
)
