"""Files of Taiwan's Central Weather Administration (formerly Bureau): columns in fixed width.

Header lines begin with ``#`` and state the columns with their signs, their width and the unit.
Times are local (UTC + 8 h). Example::

    # StationCode: XYZ
    # StartTime(GMT+08): 2018/02/06-23:50:29.000
    # RecordLength(sec): 120
    # SampleRate(Hz): 50
    # AmplitudeUnit:  gal. DCoffset(corr)
    # DataSequence: Time U(+); N(+); E(+)
    # Data: 4F10.3

Reference: the header of the files itself; the columns follow ``#DataSequence``.
"""

import re
from functools import cache, partial
from typing import Final

import numpy as np

from rockframe.records.checks import StatedValue, make_record
from rockframe.records.components import (
    FileComponent,
    Orientation,
    choose_component,
    orientation_of,
)
from rockframe.records.headers import (
    Keys,
    renamed_keys,
    required_rate,
    required_value,
    value_or_empty,
    without_empty_values,
)
from rockframe.records.numbers import FixedWidth, number_or_none, required_number, rows_below
from rockframe.records.reader import (
    Format,
    Metadata,
    Record,
    Request,
    Source,
    choose_unit,
    quoted_first_line,
)
from rockframe.signals.arrays import Array

_KEY: Final = re.compile(r"^#\s*([A-Za-z][A-Za-z ]{2,40}?)\s*(\([^()]{0,20}\))?\s*:\s*(.*?)\s*$")
_MARKS: Final = frozenset(("stationcode", "samplerate", "datasequence", "amplitudeunit"))
_COLUMN: Final = re.compile(r"([A-Za-z]{1,8})\s*(?:\(\s*([-+])\s*\))?")
_LAYOUT: Final = re.compile(r"(\d{1,2})F(\d{1,2})\.(\d{1,2})", re.IGNORECASE)
_UNIT: Final = re.compile(r"\s*([^\s.,;()]{1,12})(.*)")
_PEAKS: Final = re.compile(
    r"^#\s*AmplitudeMAX\.?\s*([A-Za-z]{1,8})\s*:\s*([-+.\d]{1,12})\s*~\s*([-+.\d]{1,12})\s*$",
    re.IGNORECASE,
)
_MAX_HEADER_LINES: Final = 60
_METADATA_KEYS: Final = {
    "stationcode": "station",
    "stationname": "station_name",
    "instrumentkind": "instrument",
}


def _recognises(source: Source) -> bool:
    return len(_MARKS & set(_header(source)[0])) >= 2


def _read(source: Source, request: Request) -> Record:
    header, first = _header(source)
    rate = required_rate(source, request, header, "samplerate")
    unit_text, unit_line = required_value(source, header, "amplitudeunit")
    named = _UNIT.match(unit_text)
    chosen = choose_unit(source, request, named.group(1) if named else None, unit_line)
    columns, columns_line = _columns(source, header)
    metadata: Metadata = {**_description(header), "unit_as_read": chosen[1]}
    if named is not None and "dcoffset(corr)" in named.group(2).casefold().replace(" ", ""):
        metadata["baseline_correction"] = named.group(2).strip(" .")

    table = cache(partial(_table, source, header, first, len(columns) + 1, rate))

    def samples(place: int) -> Record:
        values = table()[:, place].copy()
        count = _announced(source, header, rate)
        stated = _stated_peak(source, columns[place - 1][0], chosen[1])
        return make_record(source, values, 1.0 / rate, chosen, metadata, count=count, stated=stated)

    components = [
        FileComponent(name, partial(samples, place), direction, line=columns_line)
        for place, (name, direction) in enumerate(columns, start=1)
    ]
    return choose_component(source, request, components)


def _table(source: Source, header: Keys, first: int, columns: int, rate: float) -> Array:
    """Read the rows of numbers, times in the first column."""
    rows = rows_below(source, first)
    text, line = required_value(source, header, "data")
    match = _LAYOUT.match(text)
    if match is None or int(match.group(1)) != columns:
        raise source.refuse(
            found=f"the layout {quoted_first_line(text)}",
            expected=f"{columns} columns, such as '{columns}F10.3'",
            line=line,
        )
    layout = FixedWidth(int(match.group(2)), columns)
    values = layout.read(source, first, rows * columns).reshape(rows, columns)
    expected = values[0, 0] + np.arange(rows) / rate
    digit = 0.51 * 10.0 ** -int(match.group(3)) + 1e-9
    wrong = np.flatnonzero(np.abs(values[:, 0] - expected) > digit)
    if wrong.size:
        row = int(wrong[0])
        raise source.refuse(
            found=f"the time {values[row, 0]:g} s in row {row + 1}",
            expected=f"{expected[row]:g} s, by the sampling rate of {rate:g} Hz",
            line=first + row + 1,
        )
    return values


def _announced(source: Source, header: Keys, rate: float) -> tuple[int, str, int] | None:
    """Return the number of samples that follows from the length of the record, if it is stated."""
    if "recordlength" not in header:
        return None
    text, line = header["recordlength"]
    announced = required_number(text, source, line) * rate
    return (round(announced), "RecordLength", line) if 0.0 < announced < 1e12 else None


def _header(source: Source) -> tuple[Keys, int]:
    header: Keys = {}
    lines = source.top(_MAX_HEADER_LINES)
    for line, text in enumerate(lines, start=1):
        if text.strip() and not text.startswith("#"):
            return header, line - 1
        match = _KEY.match(text)
        if match is not None:
            key = match.group(1).replace(" ", "").casefold()
            header.setdefault(key, (match.group(3), line))
    return header, len(lines)


def _columns(source: Source, header: Keys) -> tuple[list[tuple[str, Orientation]], int]:
    text, line = required_value(source, header, "datasequence")
    names = _COLUMN.findall(text)
    if len(names) < 2 or names[0][0].casefold() != "time":
        found = f"the columns {quoted_first_line(text)}"
        raise source.refuse(found=found, expected="the time, then the components", line=line)
    columns: list[tuple[str, Orientation]] = []
    for name, sign in names[1:]:
        direction = orientation_of(name)
        if sign == "-":
            direction = direction.reversed()
        columns.append((name if sign != "-" else f"-{name}", direction))
    return columns, line


def _stated_peak(source: Source, name: str, unit: str) -> list[StatedValue]:
    """Return the larger of the largest and the smallest value of a column, as printed."""
    for line, text in enumerate(source.top(_MAX_HEADER_LINES), start=1):
        match = _PEAKS.match(text)
        if match is not None and match.group(1).casefold() == name.lstrip("-").casefold():
            printed = max(match.groups()[1:], key=lambda text: abs(number_or_none(text) or 0.0))
            return [StatedValue(printed, unit, line)]
    return []


def _description(header: Keys) -> Metadata:
    origin, start = value_or_empty(header, "origintime"), value_or_empty(header, "starttime")
    times = {
        "event": origin and f"earthquake of {origin} (GMT+08)",
        "event_time": origin and f"{origin} (GMT+08)",
        "record_time": start and f"{start} (GMT+08)",
    }
    return renamed_keys(header, _METADATA_KEYS) | without_empty_values(times)


CWA: Final = Format(
    "cwa",
    "file of the Central Weather Administration, Taiwan",
    (".dat", ".txt"),
    _recognises,
    _read,
    holds="three",
    unit="in the header",
)
