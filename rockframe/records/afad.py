"""Files of Turkey's Disaster and Emergency Management Presidency (AFAD) until 2018.

Lines ``KEY : value``, then the names of three columns, then the columns::

    NUMBER OF DATA          : 13494
    SAMPLING INTERVAL (sec) : 0.01
    RAW PGA VALUES (gal)    : (N-S) 21.838512 (E-W) 26.042589 (U-D) 9.799439
           N-S          E-W          U-D

The samples are in the unit of the peaks. Later files are those of ESM.

Reference: the header of the files itself.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from rockframe.records.checks import compare_peak, settle_count
from rockframe.records.components import UNKNOWN, FileComponent, choose_component, orientation_of
from rockframe.records.keys import Keys, kept, needed_count, needed_step, read_keys
from rockframe.records.numbers import (
    NUMBER,
    ends_inside_number,
    free_format,
    last_fields,
)
from rockframe.records.record_file import Metadata, Record, Request, Source, quoted_first_line
from rockframe.records.unit_names import choose_unit

if TYPE_CHECKING:
    from rockframe.signals.arrays import Array

NAME: Final = "afad"
TITLE: Final = "AFAD file, Turkey, in three columns"
SUFFIXES: Final = (".txt",)

_STEP: Final = "SAMPLING INTERVAL (sec)"
_COUNT: Final = "NUMBER OF DATA"
_PEAKS: Final = re.compile(r"^RAW PGA VALUES? \((\S{1,12})\)$", re.IGNORECASE)
_PEAK: Final = re.compile(rf"\(\s*([A-Z-]{{1,6}})\s*\)\s*({NUMBER})", re.IGNORECASE | re.ASCII)
_LONGEST_HEADER: Final = 40
_KEPT: Final = {
    "STATION ID": "station",
    "PLACE": "station_name",
    "EARTHQUAKE DATE": "event_time",
    "RECORD TIME": "record_time",
    "RECORDER TYPE": "instrument",
}


def recognises(source: Source) -> bool:
    """Tell whether the keys that the format needs stand near the top."""
    return {_STEP, _COUNT} <= set(read_keys(source.top(_LONGEST_HEADER)))


def read(source: Source, request: Request) -> Record:
    """Read the acceleration of one column, or of two."""
    header = read_keys(source.top(_LONGEST_HEADER))
    time_step = needed_step(source, request, header, _STEP)
    declared, count_line = needed_count(source, header, _COUNT)
    names, first = _columns(source)
    peaks, unit_name, peaks_line = _peaks(header)
    unit, as_read, warnings = choose_unit(source, request, unit_name, peaks_line)
    about: Metadata = {**kept(header, _KEPT), "unit_as_read": as_read}
    if "event_time" in about:
        about["event"] = f"earthquake of {about['event_time']}"
    tables: list[Array] = []

    def samples(place: int) -> Record:
        if not tables:
            tables.append(_table(source, first, len(names)))
        values = tables[0][:, place].copy()
        counts, differing = settle_count(
            source, declared=declared, counted=values.size, what=_COUNT, line=count_line
        )
        doubts = compare_peak(
            source,
            values,
            unit,
            printed=peaks.get(names[place], ""),
            printed_unit=unit_name or "",
            line=peaks_line or 1,
        )
        said = (*warnings, *differing, *doubts)
        return Record(time_step, values, unit, {**about, **counts}, warnings=said)

    components = [
        FileComponent(name, lambda place=place: samples(place), orientation_of(name), line=first)
        for place, name in enumerate(names)
    ]
    return choose_component(source, request, components)


def _columns(source: Source) -> tuple[list[str], int]:
    for index, text in enumerate(source.top(_LONGEST_HEADER)):
        names = text.split()
        if len(names) > 1 and all(orientation_of(name) != UNKNOWN for name in names):
            return names, index + 1
    expected = "a line with the names of the columns, such as 'N-S E-W U-D'"
    raise source.refuse(
        found=f"no columns below {quoted_first_line(source.start)}", expected=expected, line=1
    )


def _peaks(header: Keys) -> tuple[dict[str, str], str | None, int | None]:
    for key, (text, line) in header.items():
        match = _PEAKS.match(key)
        if match is not None:
            return dict(_PEAK.findall(text)), match.group(1), line
    return {}, None, None


def _table(source: Source, first: int, columns: int) -> Array:
    for index in range(first, source.last_line):
        fields = len(source.lines[index].split())
        if fields != columns:
            found, expected = f"{fields} fields", f"{columns}, one for each component"
            raise source.refuse(found=found, expected=expected, line=index + 1)
    values = free_format(source, first)
    if values.size % columns or values.size < columns:
        found, expected = f"{values.size} numbers", f"{columns} in each line"
        raise source.refuse(found=found, expected=expected, line=source.last_line)
    if ends_inside_number(source, last_fields(source, first)[columns - 1 :: columns]):
        found = f"the end of the file inside a number ({values.size // columns} samples)"
        raise source.refuse(found=found, expected="a complete file", line=source.last_line)
    return values.reshape(-1, columns)
