"""Files of Taiwan's Central Weather Administration (once Bureau): columns in fixed width.

Header lines begin with ``#`` and name the columns, their signs, their width and the
unit. Times are local (UTC + 8 h). Example::

    # StationCode: XYZ
    # StartTime(GMT+08): 2018/02/06-23:50:29.000
    # RecordLength(sec): 120
    # SampleRate(Hz): 50
    # AmplitudeUnit:  gal. DCoffset(corr)
    # DataSequence: Time U(+); N(+); E(+)
    # Data: 4F10.3

Reference: the header of the files itself; the columns follow ``#DataSequence``.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

import numpy as np

from rockframe.records.checks import (
    check_asked_time_step,
    check_time_step,
    compare_peak,
    settle_count,
)
from rockframe.records.components import (
    DOWNWARDS,
    FileComponent,
    Orientation,
    azimuth_of,
    choose_component,
    orientation_of,
)
from rockframe.records.keys import Keys, kept, needed, needed_rate
from rockframe.records.numbers import fixed_width, one_number
from rockframe.records.record_file import Metadata, Record, Request, Source, quoted_first_line
from rockframe.records.unit_names import choose_unit

if TYPE_CHECKING:
    from rockframe.records.unit_names import RecordUnit
    from rockframe.signals.arrays import Array

NAME: Final = "cwa"
TITLE: Final = "file of the Central Weather Administration, Taiwan"
SUFFIXES: Final = (".dat", ".txt")

_KEY: Final = re.compile(r"^#\s*([A-Za-z][A-Za-z ]{2,40}?)\s*(\([^()]{0,20}\))?\s*:\s*(.*?)\s*$")
_MARKS: Final = frozenset(("stationcode", "samplerate", "datasequence", "amplitudeunit"))
_COLUMN: Final = re.compile(r"([A-Za-z]{1,8})\s*(?:\(\s*([-+])\s*\))?")
_LAYOUT: Final = re.compile(r"(\d{1,2})F(\d{1,2})\.(\d{1,2})", re.IGNORECASE)
_UNIT: Final = re.compile(r"\s*([^\s.,;()]{1,12})(.*)")
_PEAKS: Final = re.compile(
    r"^#\s*AmplitudeMAX\.?\s*([A-Za-z]{1,8})\s*:\s*([-+.\d]{1,12})\s*~\s*([-+.\d]{1,12})\s*$",
    re.IGNORECASE,
)
_LONGEST_HEADER: Final = 60
_KEPT: Final = {
    "stationcode": "station",
    "stationname": "station_name",
    "instrumentkind": "instrument",
}


def recognises(source: Source) -> bool:
    """Tell whether the keys that the format needs stand near the top."""
    return len(_MARKS & set(_header(source)[0])) >= 2


def read(source: Source, request: Request) -> Record:
    """Read the acceleration of one column, or of two."""
    header, first = _header(source)
    rate, rate_line = needed_rate(source, header, "samplerate")
    time_step = 1.0 / rate
    check_time_step(source, time_step, rate_line)
    check_asked_time_step(source, request, time_step, rate_line)
    unit_text, unit_line = needed(source, header, "amplitudeunit")
    named = _UNIT.match(unit_text)
    unit, as_read, warnings = choose_unit(
        source, request, named.group(1) if named else None, unit_line
    )
    columns, columns_line = _columns(source, header)
    metadata: Metadata = {**_description(header), "unit_as_read": as_read}
    if named is not None and "dcoffset(corr)" in named.group(2).casefold().replace(" ", ""):
        metadata["baseline_correction"] = named.group(2).strip(" .")
    table = _Table(source, header, first, len(columns) + 1, rate)

    def reader(place: int) -> Record:
        values = table.read()
        name = columns[place - 1][0]
        doubts = _compare_peaks(source, name, values[:, place], unit, as_read)
        said = (*warnings, *table.warnings, *doubts)
        about: Metadata = {**metadata, **table.metadata}
        return Record(time_step, values[:, place].copy(), unit, about, warnings=said)

    components = [
        FileComponent(
            name,
            lambda place=place: reader(place),
            direction,
            line=columns_line,
        )
        for place, (name, direction) in enumerate(columns, start=1)
    ]
    return choose_component(source, request, components)


class _Table:
    """The rows of numbers, read once however many columns are wanted."""

    def __init__(
        self,
        source: Source,
        header: Keys,
        first: int,
        columns: int,
        rate: float,
    ) -> None:
        self._source = source
        self._header = header
        self._first = first
        self._columns = columns
        self._rate = rate
        self._values: Array | None = None
        self.metadata: Metadata = {}
        self.warnings: tuple[str, ...] = ()

    def read(self) -> Array:
        """Give the table, times in the first column."""
        if self._values is None:
            self._values = self._read()
        return self._values

    def _read(self) -> Array:
        source = self._source
        rows = source.last_line - self._first
        if rows < 2:
            found = f"{max(rows, 0)} rows of numbers"
            raise source.refuse(found=found, expected="two or more", line=source.last_line)
        width, digit = self._layout()
        values = fixed_width(
            source, self._first, rows * self._columns, width=width, per_line=self._columns
        ).reshape(rows, self._columns)
        expected = values[0, 0] + np.arange(rows) / self._rate
        wrong = np.flatnonzero(np.abs(values[:, 0] - expected) > digit)
        if wrong.size:
            row = int(wrong[0])
            raise source.refuse(
                found=f"the time {values[row, 0]:g} s in row {row + 1}",
                expected=f"{expected[row]:g} s, by the sampling rate of {self._rate:g} Hz",
                line=self._first + row + 1,
            )
        if "recordlength" in self._header:
            text, line = self._header["recordlength"]
            announced = one_number(text, source, line) * self._rate
            if 0.0 < announced < 1e12:
                self.metadata, said = settle_count(
                    source, declared=round(announced), counted=rows, what="RecordLength", line=line
                )
                self.warnings = tuple(said)
        return values

    def _layout(self) -> tuple[int, float]:
        text, line = needed(self._source, self._header, "data")
        match = _LAYOUT.match(text)
        if match is None or int(match.group(1)) != self._columns:
            raise self._source.refuse(
                found=f"the layout {quoted_first_line(text)}",
                expected=f"{self._columns} columns, such as '{self._columns}F10.3'",
                line=line,
            )
        return int(match.group(2)), 0.51 * 10.0 ** -int(match.group(3)) + 1e-9


def _header(source: Source) -> tuple[Keys, int]:
    header: Keys = {}
    lines = source.top(_LONGEST_HEADER)
    for line, text in enumerate(lines, start=1):
        if text.strip() and not text.startswith("#"):
            return header, line - 1
        match = _KEY.match(text)
        if match is not None:
            key = match.group(1).replace(" ", "").casefold()
            header.setdefault(key, (match.group(3), line))
    return header, len(lines)


def _columns(source: Source, header: Keys) -> tuple[list[tuple[str, Orientation]], int]:
    text, line = needed(source, header, "datasequence")
    names = _COLUMN.findall(text)
    if len(names) < 2 or names[0][0].casefold() != "time":
        found = f"the columns {quoted_first_line(text)}"
        raise source.refuse(found=found, expected="the time, then the components", line=line)
    columns: list[tuple[str, Orientation]] = []
    for name, sign in names[1:]:
        direction = orientation_of(name)
        if sign == "-" and direction.vertical is not None:
            direction = Orientation(vertical=DOWNWARDS)
        elif sign == "-" and direction.azimuth is not None:
            direction = azimuth_of((direction.azimuth + 180.0) % 360.0)
        columns.append((name if sign != "-" else f"-{name}", direction))
    return columns, line


def _compare_peaks(
    source: Source, name: str, values: Array, unit: RecordUnit, unit_name: str
) -> list[str]:
    for line, text in enumerate(source.top(_LONGEST_HEADER), start=1):
        match = _PEAKS.match(text)
        if match is not None and match.group(1).casefold() == name.lstrip("-").casefold():
            # the largest and the smallest value
            larger = max(match.groups()[1:], key=lambda printed: _size(printed))
            return compare_peak(
                source, values, unit, printed=larger, printed_unit=unit_name, line=line
            )
    return []


def _size(printed: str) -> float:
    try:
        return abs(float(printed))
    except ValueError:
        return 0.0


def _description(header: Keys) -> Metadata:
    metadata = kept(header, _KEPT)
    origin = header.get("origintime", ("", 0))[0]
    if origin:
        metadata["event"] = f"earthquake of {origin} (GMT+08)"
        metadata["event_time"] = f"{origin} (GMT+08)"
    start = header.get("starttime", ("", 0))[0]
    if start:
        metadata["record_time"] = f"{start} (GMT+08)"
    return metadata
