"""USGS SMC files: 11 lines of text, 48 integers, 50 reals, comments, data; fixed width.

Integers are eight in a line, 10 characters each, reals five of 15, data eight of 10.
Integer 16 is the number of comment lines, integer 17 the number of samples, real 2
the sampling rate; what is not known is -32768 or 1.7E38 (integer 1 and real 1 repeat
these marks). Without a sampling rate the data are pairs of time and acceleration.

Reference: U.S. Geological Survey, National Strong-Motion Program, "SMC- and
BBF-format Data Files" (smcfmt.txt), sections 3 and 4.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Final

from rockframe.records.checks import check_asked_time_step, check_time_step, compare_peak, surplus
from rockframe.records.components import (
    DOWNWARDS,
    UNKNOWN,
    UPWARDS,
    FileComponent,
    Orientation,
    azimuth_of,
    choose_component,
    orientation_of,
)
from rockframe.records.numbers import (
    NUMBER,
    cell,
    fixed_width,
    header_count,
    header_number,
    whole,
    with_e,
)
from rockframe.records.record_file import Metadata, Record, Request, Source, quoted_first_line
from rockframe.records.unit_names import choose_unit

if TYPE_CHECKING:
    from rockframe.records.unit_names import RecordUnit
    from rockframe.signals.arrays import Array

NAME: Final = "smc"
TITLE: Final = "USGS SMC file"
SUFFIXES: Final = (".smc",)

UNIT: Final = "cm/sec/sec"
"""Of the data, by the specification."""

UNKNOWN_KIND: Final = "UNKNOWN"
"""Kind 0, of files whose maker did not say what they hold."""

_KIND: Final = re.compile(
    r"^\s*([0-6])\s+((?:UN)?CORRECTED ACCELEROGRAM|VELOCITY|DISPLACEMENT|"
    r"RESPONSE SPECTRA|FOURIER\b.{0,40}|UNKNOWN)",
    re.IGNORECASE,
)
_NAMED: Final = re.compile(r"\bcomponent[ \t]*=[ \t]*(\S{1,12})", re.IGNORECASE)
_STATION: Final = re.compile(r"\bstation\s*=\s*(.{0,60}?)\s*(?:\bcomponent\s*=|$)", re.IGNORECASE)
_EVENT: Final = re.compile(r"^\s*(\d{4})\s+(\d{1,2})\s+(\d{1,2})\s+(\d{1,4})?\s*(.{0,60})$")
_INTEGERS: Final = 11
_REALS: Final = 17
_COMMENTS: Final = 27
_INTEGER_LAYOUT: Final = {"width": 10, "per_line": 8}
_REAL_LAYOUT: Final = {"width": 15, "per_line": 5}
_DATA_LAYOUT: Final = {"width": 10, "per_line": 8}
_UNKNOWN_INTEGER: Final = -32768
_UNKNOWN_REAL: Final = 1.7e38
_FASTEST: Final = 1e5
_PEAKS: Final = (30, 32)
_REAL: Final = re.compile(NUMBER, re.ASCII)
_HORIZONTAL: Final = 90
_DOWN: Final = 180


def recognises(source: Source) -> bool:
    """Tell whether the first line is one of the format's own."""
    return _KIND.match(source.top(1)[0]) is not None


def read(source: Source, request: Request) -> Record:
    """Read an accelerogram."""
    _check_kind(source)
    name, direction = _component(source)

    def samples() -> Record:
        return _samples(source, request)

    component = FileComponent(name, samples, direction, aliases=_aliases(direction), line=6)
    return choose_component(source, request, [component])


def _check_kind(source: Source) -> None:
    match = _KIND.match(source.top(1)[0])
    if match is None:
        expected = "a first line such as '2 CORRECTED ACCELEROGRAM'"
        raise source.refuse(found=quoted_first_line(source.start), expected=expected, line=1)
    if not _is_accelerogram(match):
        found = f"{quoted_first_line(match.group(0))}, which is no accelerogram"
        raise source.refuse(found=found, expected="an acceleration", line=1)


def _is_accelerogram(match: re.Match[str]) -> bool:
    return "ACCELEROGRAM" in match.group(2).upper() or match.group(2).upper() == UNKNOWN_KIND


def _component(source: Source) -> tuple[str | None, Orientation]:
    said = _NAMED.search("\n".join(source.top(_INTEGERS)))
    name = said.group(1) if said else None
    direction = orientation_of(name or "")
    if direction != UNKNOWN:
        return name, direction
    # where the text does not tell: integer 13 is the angle from the vertical, 14 the azimuth
    slope = whole(cell(source, _INTEGERS, 13, **_INTEGER_LAYOUT))
    azimuth = whole(cell(source, _INTEGERS, 14, **_INTEGER_LAYOUT))
    if slope == 0:
        return name or "UP", Orientation(vertical=UPWARDS)
    if slope == _DOWN:
        return name or "DOWN", Orientation(vertical=DOWNWARDS)
    if slope == _HORIZONTAL and azimuth is not None:
        return name or str(azimuth), azimuth_of(float(azimuth))
    return name, UNKNOWN


def _aliases(direction: Orientation) -> tuple[str, ...]:
    return () if direction.azimuth is None else (f"{direction.azimuth:g}",)


def _samples(source: Source, request: Request) -> Record:
    comments = header_count(
        source, _INTEGERS, 16, **_INTEGER_LAYOUT, what="number of comment lines (integer 16)"
    )
    count = header_count(
        source, _INTEGERS, 17, **_INTEGER_LAYOUT, what="number of samples (integer 17)"
    )
    if comments == _UNKNOWN_INTEGER:
        comments = 0
    first = _COMMENTS + comments
    if comments < 0 or first >= len(source.lines):
        found = f"{comments} comment lines announced in a file of {len(source.lines)} lines"
        expected = "a header of 27 lines, the comments, then the data"
        raise source.refuse(found=found, expected=expected, line=13)
    for index, line in enumerate(source.top(comments, _COMMENTS), start=_COMMENTS + 1):
        if not line.startswith("|"):
            found = f"{quoted_first_line(line)} among {comments} comment lines"
            raise source.refuse(found=found, expected="a line that begins with '|'", line=index)
    time_step = _time_step(source)
    check_asked_time_step(source, request, time_step, _REALS + 1)
    unit, as_read, warnings = choose_unit(source, request, UNIT, None)
    values = fixed_width(source, first, count, **_DATA_LAYOUT)
    problem = whole(cell(source, _INTEGERS, 18, **_INTEGER_LAYOUT))
    kind = _KIND.match(source.top(1)[0])
    if kind is not None and kind.group(2).upper() == UNKNOWN_KIND:
        words = f"{source.path}, line 1: the file does not say what it holds; an accelerogram "
        warnings.append(f"{words}in {as_read} is assumed")
    warnings += _doubts(source, values, unit)
    warnings += surplus(
        source, first + -(-count // _DATA_LAYOUT["per_line"]), "integer 17 (line 14)"
    )
    if problem == 1:
        words = f"{source.path}, line 14: the file marks a problem (integer 18); see its comments"
        warnings.append(words)
    metadata = {**_description(source), "unit_as_read": as_read}
    return Record(time_step, values, unit, metadata, warnings=tuple(warnings))


def _doubts(source: Source, values: Array, unit: RecordUnit) -> list[str]:
    """Hold the largest of the peaks in reals 30 and 32 against the samples."""
    printed = [cell(source, _REALS, place, **_REAL_LAYOUT) for place in _PEAKS]
    stated = [abs(float(with_e(text))) for text in printed if _REAL.fullmatch(text)]
    known = [value for value in stated if value < _UNKNOWN_REAL / 10.0]
    if len(known) < len(_PEAKS):
        return []
    peak, line = f"{max(known):.9g}", _REALS + 1 + (_PEAKS[0] - 1) // _REAL_LAYOUT["per_line"]
    return compare_peak(source, values, unit, printed=peak, printed_unit=UNIT, line=line)


def _time_step(source: Source) -> float:
    line = _REALS + 1
    rate = header_number(source, _REALS, 2, **_REAL_LAYOUT, what="sampling rate (real 2)")
    if math.isclose(rate, _UNKNOWN_REAL):
        found = "no sampling rate (real 2): pairs of time and acceleration, unevenly sampled"
        expected = "an evenly sampled record, such as the corrected one of the set"
        raise source.refuse(found=found, expected=expected, line=line)
    if not 0.0 < rate <= _FASTEST:
        found = f"a sampling rate of {rate!r} per second"
        expected = f"a rate above zero, at most {_FASTEST:g} per second"
        raise source.refuse(found=found, expected=expected, line=line)
    time_step = 1.0 / rate
    check_time_step(source, time_step, line)
    return time_step


def _description(source: Source) -> Metadata:
    lines = source.top(_INTEGERS)
    match = _KIND.match(lines[0])
    metadata: Metadata = {"description": match.group(2).casefold() if match else ""}
    code = lines[2].strip().rstrip("*").strip() if len(lines) > 2 else ""
    if code:
        metadata["station"] = code
    for line in lines[3:]:
        event = _EVENT.match(line.rstrip())
        if event is not None and "event" not in metadata:
            year, month, day, clock, name = event.groups()
            if name:
                metadata["event"] = name.strip()
            time = f"T{clock.zfill(4)[:2]}:{clock.zfill(4)[2:]}" if clock else ""
            metadata["event_time"] = f"{year}-{month.zfill(2)}-{day.zfill(2)}{time}"
        station = _STATION.search(line)
        if station is not None and station.group(1):
            metadata["station_name"] = station.group(1)
    return metadata
