"""USGS SMC files: 11 lines of text, 48 integers, 50 reals, comments, data; fixed width.

There are eight integers of 10 characters in a line, five reals of 15 and eight samples of 10.
Integer 16 is the number of comment lines, integer 17 the number of samples, real 2 the sampling
rate. Unknown values are -32768 or 1.7E38 (integer 1 and real 1 repeat these marks). Without a
sampling rate the data are pairs of time and acceleration.

Reference: U.S. Geological Survey, National Strong-Motion Program, "SMC- and
BBF-format Data Files" (smcfmt.txt), sections 3 and 4.
"""

import math
import re
from typing import Final

from rockframe.records.checks import (
    StatedValue,
    checked_time_step,
    make_record,
    surplus_rows_warning,
)
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
    ONE_NUMBER,
    Fields,
    FixedWidth,
    integer_or_none,
    with_exponent_e,
)
from rockframe.records.reader import (
    Format,
    Metadata,
    Record,
    Request,
    Source,
    choose_unit,
    quoted_first_line,
)

UNIT: Final = "cm/sec/sec"
"""Unit of the data, by the specification."""

UNKNOWN_KIND: Final = "UNKNOWN"
"""Kind 0, of files that do not state their quantity."""

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
_INTEGER_LAYOUT: Final = FixedWidth(10, 8)
_REAL_LAYOUT: Final = FixedWidth(15, 5)
_DATA_LAYOUT: Final = FixedWidth(10, 8)
_UNKNOWN_INTEGER: Final = -32768
_UNKNOWN_REAL: Final = 1.7e38
_FASTEST: Final = 1e5
_PEAKS: Final = (30, 32)
_HORIZONTAL: Final = 90
_DOWN: Final = 180


def _recognises(source: Source) -> bool:
    return _KIND.match(source.top(1)[0]) is not None


def _read(source: Source, request: Request) -> Record:
    kind = _kind(source)
    integers = Fields(source, _INTEGER_LAYOUT, _INTEGERS)
    name, direction = _component(source, integers)
    component = FileComponent(
        name,
        lambda: _samples(source, request, kind, integers),
        direction,
        aliases=() if direction.azimuth is None else (f"{direction.azimuth:g}",),
        line=6,
    )
    return choose_component(source, request, [component])


def _kind(source: Source) -> str:
    match = _KIND.match(source.top(1)[0])
    if match is None:
        expected = "a first line such as '2 CORRECTED ACCELEROGRAM'"
        raise source.refuse(found=quoted_first_line(source.start), expected=expected, line=1)
    kind = match.group(2)
    if "ACCELEROGRAM" not in kind.upper() and kind.upper() != UNKNOWN_KIND:
        found = f"{quoted_first_line(match.group(0))}, which is no accelerogram"
        raise source.refuse(found=found, expected="an acceleration", line=1)
    return kind


def _component(source: Source, integers: Fields) -> tuple[str | None, Orientation]:
    match = _NAMED.search("\n".join(source.top(_INTEGERS)))
    name = match.group(1) if match else None
    direction = orientation_of(name or "")
    if direction != UNKNOWN:
        return name, direction
    # if not in the text: integer 13 is the angle from the vertical, 14 the azimuth
    slope, azimuth = (integer_or_none(integers.cell(place)) for place in (13, 14))
    if slope == 0:
        return name or "UP", Orientation(vertical=UPWARDS)
    if slope == _DOWN:
        return name or "DOWN", Orientation(vertical=DOWNWARDS)
    if slope == _HORIZONTAL and azimuth is not None:
        return name or str(azimuth), azimuth_of(float(azimuth))
    return name, UNKNOWN


def _samples(source: Source, request: Request, kind: str, integers: Fields) -> Record:
    comments = integers.count(16, "number of comment lines (integer 16)")
    count = integers.count(17, "number of samples (integer 17)")
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
    reals = Fields(source, _REAL_LAYOUT, _REALS)
    time_step = _time_step(source, request, reals)
    chosen = choose_unit(source, request, UNIT, None)
    values = _DATA_LAYOUT.read(source, first, count)
    messages, what = [], "integer 17 (line 14)"
    surplus = surplus_rows_warning(
        source, first + _DATA_LAYOUT.rows(count), what, len(source.lines)
    )
    if kind.upper() == UNKNOWN_KIND:
        words = f"{source.path}, line 1: the file does not state its quantity; an accelerogram "
        messages = [f"{words}in {chosen[1]} is assumed"]
    if integer_or_none(integers.cell(18)) == 1:
        words = f"{source.path}, line 14: the file marks a problem (integer 18); see its comments"
        surplus.append(words)
    stated, metadata = _stated_peak(reals), _description(source, kind)
    return make_record(
        source,
        values,
        time_step,
        chosen,
        metadata,
        warnings_before=messages,
        stated=stated,
        warnings_after=surplus,
    )


def _stated_peak(reals: Fields) -> list[StatedValue]:
    """Return the larger of the peaks in reals 30 and 32."""
    printed = [reals.cell(place) for place in _PEAKS]
    stated = [abs(float(with_exponent_e(text))) for text in printed if ONE_NUMBER.fullmatch(text)]
    peaks = [value for value in stated if value < _UNKNOWN_REAL / 10.0]
    if len(peaks) < len(_PEAKS):
        return []
    return [StatedValue(f"{max(peaks):.9g}", UNIT, reals.line(_PEAKS[0]))]


def _time_step(source: Source, request: Request, reals: Fields) -> float:
    line, rate = reals.line(2), reals.number(2, "sampling rate (real 2)")
    if math.isclose(rate, _UNKNOWN_REAL):
        found = "no sampling rate (real 2): pairs of time and acceleration, unevenly sampled"
        expected = "an evenly sampled record, such as the corrected one of the set"
        raise source.refuse(found=found, expected=expected, line=line)
    if not 0.0 < rate <= _FASTEST:
        found = f"a sampling rate of {rate!r} per second"
        expected = f"a rate above zero, at most {_FASTEST:g} per second"
        raise source.refuse(found=found, expected=expected, line=line)
    checked_time_step(source, request, 1.0 / rate, line)
    return 1.0 / rate


def _description(source: Source, kind: str) -> Metadata:
    lines = source.top(_INTEGERS)
    metadata: Metadata = {"description": kind.casefold()}
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


SMC: Final = Format(
    "smc",
    "USGS SMC file",
    (".smc",),
    _recognises,
    _read,
    holds="one",
    unit="cm/s², by the specification",
)
