"""ESM and ITACA files (DYNA ASCII): lines ``KEY: value``, then one number per line.

The header of DYNA 1.0 to 1.2 has 64 lines or fewer. That of ITACA 1.1, which came
before, calls the component ``COMPONENT`` instead of ``STREAM``, its version
``DATA_VERSION``, and its data ``UNPROCESSED`` or ``PROCESSED ACCELERATION``.

Reference: Engineering Strong-Motion Database (ESM) and Italian Accelerometric
Archive (ITACA), ASCII format ``HEADER_FORMAT: DYNA 1.2``.
"""

from __future__ import annotations

import re
from typing import Final

from rockframe.records.checks import compare_length, compare_peak, settle_count
from rockframe.records.components import FileComponent, choose_component, orientation_of
from rockframe.records.keys import Keys, kept, needed_count, needed_step
from rockframe.records.numbers import (
    ends_inside_number,
    free_format,
    last_fields,
)
from rockframe.records.record_file import Metadata, Record, Request, Source, quoted_first_line
from rockframe.records.unit_names import choose_unit

NAME: Final = "esm"
TITLE: Final = "ESM or ITACA file (DYNA ASCII)"
SUFFIXES: Final = (".asc", ".dat")

PEAK_UNIT: Final = "cm/s^2"
"""Of the peak in the header, as its key says, whatever the samples are in."""

_KEY: Final = re.compile(r"^([A-Z][A-Z0-9_/^ ]{2,60}?)\s*:\s*(.*?)\s*$")
_MARKS: Final = frozenset(
    ("SAMPLING_INTERVAL_S", "NDATA", "STREAM", "DATABASE_VERSION", "DATA_VERSION")
)
_LONGEST_HEADER: Final = 120
_KEPT: Final = {
    "EVENT_NAME": "event",
    "EVENT_ID": "event_id",
    "NETWORK": "network",
    "STATION_CODE": "station",
    "STATION_NAME": "station_name",
    "DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS": "record_time",
    "BASELINE_CORRECTION": "baseline_correction",
    "PROCESSING": "processing",
}


def recognises(source: Source) -> bool:
    """Tell whether the keys that the format needs stand near the top."""
    keys = {match.group(1) for line in source.top(_LONGEST_HEADER) if (match := _KEY.match(line))}
    return len(_MARKS & keys) >= 2


def read(source: Source, request: Request) -> Record:
    """Read an acceleration."""
    header, first = _header(source)
    kind, kind_line = header.get("DATA_TYPE", ("", 0))
    if kind and kind.casefold().removeprefix("un").removeprefix("processed ") != "acceleration":
        found = f"DATA_TYPE {quoted_first_line(kind)}"
        raise source.refuse(found=found, expected="an acceleration", line=kind_line)
    time_step = needed_step(source, request, header, "SAMPLING_INTERVAL_S")
    unit_name, unit_line = header.get("UNITS", ("", 0))
    unit, as_read, warnings = choose_unit(source, request, unit_name or None, unit_line or None)
    declared, count_line = needed_count(source, header, "NDATA")
    metadata = {**_description(header), "unit_as_read": as_read}
    name, name_line = header.get("STREAM", header.get("COMPONENT", ("", 0)))

    def samples() -> Record:
        values = free_format(source, first)
        if ends_inside_number(source, last_fields(source, first)):
            found = f"the end of the file inside a number ({values.size} of {declared} samples)"
            raise source.refuse(found=found, expected="a complete file", line=source.last_line)
        counts, differing = settle_count(
            source, declared=declared, counted=int(values.size), what="NDATA", line=count_line
        )
        peak, peak_line = header.get("PGA_CM/S^2", ("", 0))
        length, length_line = header.get("DURATION_S", ("", 0))
        doubts = (
            *compare_peak(
                source, values, unit, printed=peak, printed_unit=PEAK_UNIT, line=peak_line
            ),
            *compare_length(source, values.size, time_step, printed=length, line=length_line),
        )
        said = (*warnings, *differing, *doubts)
        return Record(time_step, values, unit, {**metadata, **counts}, warnings=said)

    component = FileComponent(name or None, samples, orientation_of(name), line=name_line or None)
    return choose_component(source, request, [component])


def _header(source: Source) -> tuple[Keys, int]:
    header: Keys = {}
    for line, text in enumerate(source.top(_LONGEST_HEADER), start=1):
        match = _KEY.match(text)
        if match is not None:
            header.setdefault(match.group(1), (match.group(2), line))
        elif text.strip():
            return header, line - 1
    found = f"no data in the first {_LONGEST_HEADER} lines"
    expected = "numbers below a header of 64 lines"
    raise source.refuse(found=found, expected=expected, line=source.last_line)


def _description(header: Keys) -> Metadata:
    metadata = kept(header, _KEPT)
    day = header.get("EVENT_DATE_YYYYMMDD", ("", 0))[0]
    clock = header.get("EVENT_TIME_HHMMSS", ("", 0))[0]
    if day:
        metadata["event_time"] = f"{day}_{clock}" if clock else day
    return metadata
