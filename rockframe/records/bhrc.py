"""Files of Iran's Building and Housing Research Center (BHRC), volume 1.

Three components one after another, each closed by a line ``/&``. Each has thirteen lines
of text, seven of integers, seven of reals, which may be cut at column 70, then ten numbers of
13 characters in a line. Real 7, the first of the second line, is the sampling rate.

Reference: Iran Strong Motion Network, the header of the files itself.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from rockframe.records.checks import check_asked_time_step, check_time_step, compare_length, surplus
from rockframe.records.components import (
    UNKNOWN,
    FileComponent,
    Orientation,
    azimuth_of,
    choose_component,
    orientation_of,
)
from rockframe.records.numbers import cell, fixed_width, one_number
from rockframe.records.record_file import Metadata, Record, Request, Source, quoted_first_line
from rockframe.records.unit_names import choose_unit

if TYPE_CHECKING:
    from rockframe.errors import RecordError

NAME: Final = "bhrc"
TITLE: Final = "BHRC file, Iran (volume 1)"
SUFFIXES: Final = (".v1",)

_FIRST_LINE: Final = re.compile(r"^\* VOL(\d)\S{0,4}\s+FILE:\s*(\S{1,20})", re.IGNORECASE)
_COMPONENT: Final = re.compile(r"^COMP\s+(\S{1,12})", re.IGNORECASE)
_POINTS: Final = re.compile(
    r"^NO\. OF POINTS\s*=\s*(\d{1,9})\s+DURATION\s*=\s*([.\d]{1,12})", re.IGNORECASE
)
_UNITS: Final = re.compile(r"^UNITS ARE SEC\w{0,4} AND (\S{1,12})", re.IGNORECASE)
_AZIMUTHS: Final = re.compile(r"\bAzimuth\s+L\s*(\d{1,3})\s+T\s*(\d{1,3})", re.IGNORECASE)
_ORIGIN: Final = re.compile(r"^Origin Time\s*:\s*(\S.{3,40}?)\s*$", re.IGNORECASE)
_STATION: Final = re.compile(r"^(\S.{0,60}?)\s{2,}Station\b")
_TEXT_LINES: Final = 13
_REALS: Final = 20
_DATA: Final = 27
_WIDTH: Final = 13
_PER_LINE: Final = 10
_REALS_PER_LINE: Final = 6
_RATE: Final = 7
_MOST_COMPONENTS: Final = 12


def recognises(source: Source) -> bool:
    """Tell whether the first line names volume and file."""
    return _FIRST_LINE.match(source.top(1)[0]) is not None


def read(source: Source, request: Request) -> Record:
    """Read the acceleration of one component, or of two."""
    starts: list[int] = []
    for index, line in enumerate(source.lines):
        if line.startswith("* VOL") and _FIRST_LINE.match(line[:80]):
            starts.append(index)
        if len(starts) > _MOST_COMPONENTS:
            expected = f"at most {_MOST_COMPONENTS} components"
            raise source.refuse(found="more", expected=expected, line=index + 1)
    if not starts:
        expected = "a first line such as '* VOL1DS FILE:  5526/01'"
        raise source.refuse(found=quoted_first_line(source.start), expected=expected, line=1)
    return choose_component(
        source, request, [_component(source, request, first) for first in starts]
    )


def _component(source: Source, request: Request, first: int) -> FileComponent:
    text = source.top(_TEXT_LINES, first)
    found = next(((k, m) for k, line in enumerate(text) if (m := _COMPONENT.match(line))), None)
    if found is None:
        raise _missing(source, first, "'COMP L1'")
    place, match = found
    name = match.group(1)

    def samples() -> Record:
        return _samples(source, request, first, text)

    return FileComponent(
        name,
        samples,
        _orientation(name, text),
        aliases=(name.rstrip("0123456789"),),
        line=first + place + 1,
    )


def _orientation(name: str, text: list[str]) -> Orientation:
    letter = name[:1].upper()
    if letter == "V":
        return orientation_of("V")
    said = next((match for line in text if (match := _AZIMUTHS.search(line))), None)
    if said is None or letter not in "LT":
        return UNKNOWN
    return azimuth_of(float(said.group(1 if letter == "L" else 2)))


def _samples(source: Source, request: Request, first: int, text: list[str]) -> Record:
    volume = _FIRST_LINE.match(text[0])
    if volume is None or volume.group(1) != "1":
        expected = "uncorrected accelerations (volume 1)"
        raise source.refuse(found=quoted_first_line(text[0]), expected=expected, line=first + 1)
    points, line = _line(source, first, text, _POINTS, "'NO. OF POINTS =   9472  DURATION = 47.36'")
    units, unit_line = _line(source, first, text, _UNITS, "'UNITS ARE SECONDS AND G/10'")
    unit, as_read, warnings = choose_unit(source, request, units.group(1), unit_line)
    time_step = _time_step(source, first)
    check_asked_time_step(source, request, time_step, first + _REALS + 2)
    count, data = int(points.group(1)), first + _DATA
    values = fixed_width(source, data, count, width=_WIDTH, per_line=_PER_LINE)
    warnings += compare_length(source, count, time_step, printed=points.group(2), line=line)
    warnings += surplus(source, data + -(-count // _PER_LINE), f"line {line}")
    metadata: Metadata = {"station": volume.group(2).split("/")[0], "unit_as_read": as_read}
    for one in text:
        origin, station = _ORIGIN.match(one), _STATION.match(one)
        if origin is not None:
            metadata["event_time"] = " ".join(origin.group(1).split())
            metadata["event"] = f"earthquake of {metadata['event_time']}"
        if station is not None:
            metadata["station_name"] = station.group(1)
    return Record(time_step, values, unit, metadata, warnings=tuple(warnings))


def _time_step(source: Source, first: int) -> float:
    printed = (
        cell(source, first + _REALS, _RATE, width=_WIDTH, per_line=_REALS_PER_LINE)
        or "no sampling rate (real 7)"
    )
    line = first + _REALS + 2
    rate = one_number(printed, source, line)
    if not rate > 0.0:
        found = f"a sampling rate of {rate!r} Hz (real 7)"
        raise source.refuse(found=found, expected="one above zero", line=line)
    time_step = 1.0 / rate
    check_time_step(source, time_step, line)
    return time_step


def _line(
    source: Source, first: int, text: list[str], pattern: re.Pattern[str], such_as: str
) -> tuple[re.Match[str], int]:
    for line, one in enumerate(text, start=first + 1):
        match = pattern.match(one)
        if match is not None:
            return match, line
    raise _missing(source, first, such_as)


def _missing(source: Source, first: int, such_as: str) -> RecordError:
    found = f"no such line among the {_TEXT_LINES} below"
    return source.refuse(found=found, expected=f"a line such as {such_as}", line=first + 1)
