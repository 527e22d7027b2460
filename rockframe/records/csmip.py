"""CSMIP volume files (V1, V2): text, integers, reals, then data in fixed width.

A file is a sequence of such blocks, one for each channel, each closed by a line ``/&``. A block of
volume 2 has acceleration, velocity and displacement; only the acceleration is read. It is
announced by a line in one of these forms::

    1138 POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)
    7500 points of accel data equally spaced at  .010 sec, in cm/sec2. (8f10.6)
    1887 POINTS OF ACC DATA EQUALLY SPACED AT   .020 SEC.  IN UNITS CM/SEC/SEC
   13200 Accelerogram points at 200 pts/sec in units of g .      Format: (8f9.6)

The third is that of the University of Southern California, which sometimes omits the unit; it is
then the unit of the peak in the text.

The original form of volume 1, also of that university and of RENADIC, Chile, has pairs of time and
acceleration instead, five in a line, below 100 integers and 50 reals. The text states their number
and units::

    NO. OF POINTS =   3500  RECORD LENGTH = 35.000 SEC
    UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  = -0.051 G, AT   3.910 SEC

Many were digitised by hand, at uneven times. Such files are refused.

Reference: A. F. Shakal and M. J. Huang, "Standard Tape Format for CSMIP
Strong-Motion Data Tapes", Report OSMS 85-03, California Division of Mines and
Geology, 1985.
"""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Final

from rockframe.errors import RecordError
from rockframe.records.checks import (
    LENGTH,
    StatedValue,
    check_requested_time_step,
    check_time_step,
    checked_time_step,
    make_record,
    surplus_rows_warning,
    truncation_warning,
)
from rockframe.records.components import FileComponent, choose_component, orientation_of
from rockframe.records.headers import first_match, without_empty_values
from rockframe.records.numbers import FixedWidth, integer_or_none, number_or_none, uniform_step
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

FIRST_LINE: Final = re.compile(
    r"^\s*(?:FILE\s+\d{0,6}\s+OF\s+)?(?:UN)?CORRECTED ACCELEROGRAM", re.IGNORECASE
)
"""First line of a file, and of each channel; in corrected files also the second line."""

_CORRECTED: Final = re.compile(r"^\s*CORRECTED ACCELEROGRAM", re.IGNORECASE)
_CHANNEL: Final = re.compile(
    r"\bCHA?N\s+(\d{1,4})\s*:\s*(.{0,30}?)\s*(?:\(|FROM\b|LOCATION|$)", re.IGNORECASE
)
_COMPONENT: Final = re.compile(r"\bCOMP\s+(\S{1,12})", re.IGNORECASE)
_DEGREES: Final = re.compile(r"^(\d{1,3})\s*DEG\S{0,5}$", re.IGNORECASE)
_LOCATION: Final = re.compile(r"\bLOCATION\s*:\s*(.{1,60})", re.IGNORECASE)
_STATION: Final = re.compile(r"\bSTATION\s+(?:NO\.?|USC\s?#)\s*(\S{1,20})", re.IGNORECASE)
_COORDINATE: Final = re.compile(r"[\d.]+[NSEW],?", re.IGNORECASE)
_PEAK: Final = re.compile(
    r"\bPEAK ACCELERATION\s*=\s*([-+.\d]{1,20})\s+(CM|G)S?(/S[^\s]{0,12})?\s", re.IGNORECASE
)
_UNCORRECTED_PEAK: Final = re.compile(r"\bMAX\s*=\s*([-+.\d]{1,20})\s*G\s*,\s*AT", re.IGNORECASE)
_LENGTH: Final = re.compile(
    r"\b(?:RECORD LENGTH|DURATION)\s*=\s*([.\d]{1,12})\s*(?:SEC|$)", re.IGNORECASE
)
_PROCESSING: Final = re.compile(
    r"process|\bvol\.?\s?[123]\b|[av]vol[12]|filter|prelim|to be determined|automatic|\bs/n\b",
    re.IGNORECASE,
)
_RECORD_OF: Final = re.compile(r"^(?:RECORD|RCRD) OF\s+", re.IGNORECASE)
_OF_DATE: Final = re.compile(r"^(.{3,80}?\bEARTHQUAKE)\s+OF\s+(\S.{3,40})$", re.IGNORECASE)
_ORIGIN: Final = re.compile(r"\(ORIGIN[^:]{0,12}:\s*([^)]{4,40})\)", re.IGNORECASE)
_DATE: Final = re.compile(
    r"\b\d{1,4}[/-]\d{1,2}[/-]\d{2,4}\b|"
    r"\b(?:JAN|FEB|MAR|APR|MAY|JUN|JUL|AUG|SEP|OCT|NOV|DEC)[A-Z]{0,6}\.?\s+\d|"
    r"\b\d{1,2}\s+(?:JAN|FEB|MAR|APR|MAY|JUN|JUL|AUG|SEP|OCT|NOV|DEC)",
    re.IGNORECASE,
)
_WIDE_GAP: Final = re.compile(r"\s{3,}")


def channel_of(header: list[str], first: int) -> tuple[int | None, str, int]:
    """Find number and direction of a channel."""
    channel: tuple[int | None, str, int] = (None, "", first + 1)
    for line, text in enumerate(header, start=first + 1):
        match = _CHANNEL.search(text)
        if match is None:
            continue
        name = match.group(2).strip()
        degrees = _DEGREES.match(name)
        channel = (integer_or_none(match.group(1)), degrees.group(1) if degrees else name, line)
        if name:
            return channel
    component = first_match(_COMPONENT, header, first + 1)
    return channel if component is None else (channel[0], component[0][1], component[1])


def _peak_in_header(header: list[str], first: int) -> StatedValue | None:
    corrected = is_corrected(header)
    for line, text in enumerate(header, start=first + 1):
        match = _PEAK.search(f"{text} ")
        if match is not None:
            number, name, per_time = match.groups()
            return StatedValue(number, f"{name}{per_time or ''}".casefold(), line)
        match = None if corrected else _UNCORRECTED_PEAK.search(text)
        if match is not None:
            return StatedValue(match.group(1), "g", line)
    return None


def _stated(header: list[str], first: int) -> list[StatedValue]:
    """Return peak and length of a record, if its header states them."""
    peak, length = _peak_in_header(header, first), first_match(_LENGTH, header, first + 1)
    stated = [] if peak is None else [peak]
    return stated if length is None else [*stated, StatedValue(length[0][1], LENGTH, length[1])]


def is_corrected(header: list[str]) -> bool:
    """Tell whether the first line of a header calls the data corrected."""
    return any(_CORRECTED.match(text) for text in header)


def description(header: list[str]) -> Metadata:
    """Return the metadata in a header."""
    lines = [text.strip() for text in header]
    metadata: Metadata = {}
    place = next((k for k, text in enumerate(lines) if FIRST_LINE.match(text)), 0)
    second = place + 1 < len(lines) and FIRST_LINE.match(lines[place + 1]) is not None
    if lines:
        metadata["description"] = "corrected" if is_corrected(lines) else "uncorrected"
    metadata |= _event(lines, place + (2 if second else 1))
    match_and_line = first_match(_STATION, lines)
    if match_and_line is not None:
        station, below = match_and_line
        if _COORDINATE.fullmatch(station.group(1)) is None:
            metadata["station"] = station.group(1)
        if below < len(lines) and lines[below]:
            name = _WIDE_GAP.split(lines[below])[0]
            if _PROCESSING.search(name) is None:
                metadata["station_name"] = name
    location = first_match(_LOCATION, lines)
    if location is not None:
        metadata["sensor_location"] = " ".join(location[0][1].split())
    return metadata


def _event(lines: list[str], place: int) -> Metadata:
    # The two lines have a name and a time, or, before an event is known, words about the
    # processing, which must not be taken for a name or a time.
    name, time = "", ""
    for text in lines[place : place + 2]:
        entry = _RECORD_OF.sub("", _WIDE_GAP.split(text.split("(")[0].strip())[0])
        if _DATE.search(entry):
            time = time or entry
        elif not name and _PROCESSING.search(entry) is None and re.search("[a-z]{3}", entry, re.I):
            name = entry
    for text in lines:
        date = _OF_DATE.match(_WIDE_GAP.split(text)[0])
        if date is not None:
            name, time = name or date.group(1), time or date.group(2)
        origin = _ORIGIN.search(text)
        if origin is not None and not time and _DATE.search(origin.group(1)):
            time = origin.group(1).strip()
    return without_empty_values(
        {"event": " ".join(name.split()), "event_time": " ".join(time.split())}
    )


_POINTS: Final = re.compile(r"\bNO\. OF POINTS\s*=\s*(\d{1,9})", re.IGNORECASE)
_UNITS: Final = re.compile(
    r"\bUNITS\b.{0,20}?\bARE\s+SEC(?:ONDS)?\s+AND\s+([^\s,;]{1,12})", re.IGNORECASE
)
_WHOLE_NUMBERS: Final = re.compile(r"[-\d\s]*\d[-\d\s]*", re.ASCII)
_REAL_NUMBERS: Final = re.compile(r"[-.\d\s]*\.[-.\d\s]*", re.ASCII)
_FULL: Final = 10
_REALS: Final = 50
_PAIR_WIDTHS: Final = range(6, 11)
_MAX_PAIR_HEADER_LINES: Final = 80


@dataclass(frozen=True)
class Pairs:
    """Number, unit and place of the pairs of one channel."""

    count: int  # number of pairs
    unit: str  # unit of the accelerations, as in the text
    unit_line: int  # line with the unit, from 1
    data_at: int  # index of the first line of pairs, from 0

    @property
    def end_index(self) -> int:
        """Index of the first line after them, from 0."""
        return self.data_at + -(-2 * self.count // _FULL)


def find_pairs(source: Source, first: int, end: int) -> Pairs | None:
    """Find pairs between the first line of a channel and that of the next one."""
    top = [line.rstrip() for line in source.top(min(_MAX_PAIR_HEADER_LINES, end - first), first)]
    points, units = first_match(_POINTS, top), first_match(_UNITS, top, 0)
    if points is None or units is None:
        return None
    place = units[1]
    while place < len(top) and _WHOLE_NUMBERS.fullmatch(top[place]) is None:
        place += 1
    while place < len(top) and _WHOLE_NUMBERS.fullmatch(top[place]):
        place += 1
    reals = 0
    while place < len(top) and reals < _REALS and _REAL_NUMBERS.fullmatch(top[place]):
        reals += len(top[place].split())
        place += 1
    if reals < _REALS or place >= len(top):
        return None
    unit = units[0][1].rstrip(".")
    return Pairs(int(points[0][1]), unit, first + units[1] + 1, first + place)


def read_pairs(source: Source, pairs: Pairs) -> tuple[float, Array]:
    """Read pairs that are evenly spaced."""
    line = source.lines[pairs.data_at].rstrip()
    per_line = min(_FULL, 2 * pairs.count)
    width, indent = divmod(len(line), max(per_line, 1))
    if width not in _PAIR_WIDTHS or indent > 1 or line[:indent].strip():
        raise source.refuse(
            found=f"a line of {len(line)} characters ({quoted_first_line(line)})",
            expected=f"{per_line} numbers of one width, pairs of time and acceleration",
            line=pairs.data_at + 1,
        )
    layout = FixedWidth(width, _FULL, indent)
    values = layout.read(source, pairs.data_at, 2 * pairs.count).reshape(-1, 2)
    rows = source.lines[pairs.data_at : pairs.end_index]
    printed = [
        row[indent + place : indent + place + width].strip()
        for row in rows
        for place in range(0, len(row.rstrip()) - indent, 2 * width)
    ]
    time_step, misfit = uniform_step(values[:, 0], printed)
    if misfit is not None:
        found = f"the time {printed[misfit]} after {printed[misfit - 1]}, unevenly sampled"
        expected = "even times, as in the corrected record of the set, or after from_times"
        place = pairs.data_at + 2 * misfit // _FULL + 1
        raise source.refuse(found=found, expected=expected, line=place)
    return time_step, values[:, 1].copy()


_SMC: Final = re.compile(r"^\s*\d\s")
_SPECTRA: Final = re.compile(r"^\s*RESPONSE AND FOURIER", re.IGNORECASE)
_DATA_LINE: Final = re.compile(
    r"^\s*(\d{1,12})\s+(?:POINTS OF ACC(?:EL\S{0,10})? DATA EQUALLY SPACED AT\s+"
    r"([\d.]{1,12})\s+SEC|ACCELEROGRAM POINTS AT\s+([\d.]{1,12})\s+(?:PTS|POINTS|SAMPLES)/SEC)",
    re.IGNORECASE,
)
_OTHER_SERIES: Final = re.compile(r"^\s*(\d{1,12})\s+POINTS OF (?:VEL|DISP)", re.IGNORECASE)
_MAX_DATA_LINE_LENGTH: Final = 200
_UNIT: Final = re.compile(
    r"(?:\bUNITS?\s*(?:[:=]|\bOF\b)?\s*|,\s*IN\s+)\(?([^\s(),;:=]{1,20})", re.IGNORECASE
)
_LAYOUT: Final = re.compile(r"\(\s*(\d{1,3})F(\d{1,3})\.\d{1,2}\s*\)", re.IGNORECASE)
_INTERVAL: Final = re.compile(r"EQUALLY-SPACED INTERVALS OF\s+([\d.]{1,12})\s+SEC", re.IGNORECASE)
_MAX_HEADER_LINES: Final = 200
_MAX_CHANNELS: Final = 500
_SECOND_LINE: Final = 10  # lines in which a first line may be followed by a second of its kind
_PER_LINE: Final = 8
_WIDTHS: Final = range(7, 16)


@dataclass(frozen=True)
class _Block:
    """One channel: its header lines, and the line that announces its accelerations."""

    first: int
    header: list[str]
    line: int
    count: int
    interval: str
    rate: str


def _recognises(source: Source) -> bool:
    first = next((line for line in source.top(4) if line.strip()), "")
    named = FIRST_LINE.match(first) is not None and "GNS" not in first
    return (named and _SMC.match(first) is None) or _SPECTRA.match(first) is not None


def _read(source: Source, request: Request) -> Record:
    if _SPECTRA.match(source.top(1)[0]):
        found = "response spectra (volume 3)"
        raise source.refuse(found=found, expected="an acceleration (volume 1 or 2)", line=1)
    blocks = _blocks(source)
    cut = _ends_inside(source)
    components: list[FileComponent] = []
    empty = 0
    for first, end in pairwise(_starts(source, blocks)):
        held = [block for block in blocks if first <= block.line < end]
        pairs = None if blocks else find_pairs(source, first, end)
        for block in held:
            read = partial(_samples, source, request, block, cut)
            components.append(_named(block.header, block.first, read))
        if pairs is not None:
            components.append(_component_of_pairs(source, request, first, pairs))
        elif not held:
            empty += 1
            components.append(_without_data(source, first, end))
        _check_number(source, len(components), first + 1)
    if empty == len(components):
        raise _no_data_error(source, source.start, 1)
    return choose_component(source, request, components)


def _ends_inside(source: Source) -> list[str]:
    """Say of a file that it ends inside velocities or displacements, which are not read."""
    for line in range(len(source.lines), 0, -1):
        text = source.lines[line - 1][:_MAX_DATA_LINE_LENGTH]
        match = _OTHER_SERIES.match(text) if "points" in text.casefold() else None
        if match is not None:
            layout = _LAYOUT.search(text)
            per_line = _PER_LINE if layout is None else max(int(layout.group(1)), 1)
            rows = FixedWidth(1, per_line).rows(int(match.group(1)))
            return truncation_warning(source, line, rows)
    return []


def _starts(source: Source, blocks: list[_Block]) -> list[int]:
    """Return the indices of the first lines of channels, and that of the line after the file."""
    named = [
        index
        for index, line in enumerate(source.lines)
        if "accelerogram" in line[:60].casefold() and FIRST_LINE.match(line[:200])
    ]
    if blocks and not (named and named[0] < blocks[0].line):
        named.insert(0, blocks[0].first)
    apart = [b for a, b in pairwise((-_SECOND_LINE - 1, *named)) if b > a + _SECOND_LINE]
    return [*apart, len(source.lines)]


def _without_data(source: Source, first: int, end: int) -> FileComponent:
    """Return a channel that has only a header, and whose reading raises an error."""

    def samples() -> Record:
        raise _no_data_error(source, source.lines[first], first + 1)

    return _named(source.top(min(end - first, _MAX_HEADER_LINES), first), first, samples)


def _no_data_error(source: Source, text: str, line: int) -> RecordError:
    found = f"no evenly sampled accelerations below {quoted_first_line(text)}"
    expected = "a line such as '1138 points of accel data equally spaced at .020 sec'"
    return source.refuse(found=found, expected=expected, line=line)


def _blocks(source: Source) -> list[_Block]:
    blocks: list[_Block] = []
    first = 0
    for index, line in enumerate(source.lines):
        if "/&" in line[:10]:
            first = index + 1
            continue
        if "points" not in line[:40].casefold():
            continue  # fast: most lines have only numbers
        match = _DATA_LINE.match(line[:_MAX_DATA_LINE_LENGTH])
        if match is not None:
            start = max(first, index - _MAX_HEADER_LINES)
            header = source.top(index - start, start)
            count, interval, rate = match.groups()
            blocks.append(_Block(start, header, index, int(count), interval or "", rate or ""))
            first = index + 1
        _check_number(source, len(blocks), index + 1)
    return blocks


def _check_number(source: Source, channels: int, line: int) -> None:
    if channels > _MAX_CHANNELS:
        expected = f"at most {_MAX_CHANNELS} channels"
        raise source.refuse(found="more channels", expected=expected, line=line)


def _named(header: list[str], first: int, samples: Callable[[], Record]) -> FileComponent:
    channel, name, line = channel_of(header, first)
    return FileComponent(
        name or (None if channel is None else f"channel {channel}"),
        samples,
        orientation_of(name),
        channel=channel,
        line=line,
    )


def _samples(source: Source, request: Request, block: _Block, cut: list[str]) -> Record:
    text = source.top(1, block.line)[0]
    match = _UNIT.search(text)
    name, line = match.group(1).rstrip(".") if match else None, block.line + 1
    peak = _peak_in_header(block.header, block.first)
    if name is None and peak is not None:
        name, line = peak.unit, peak.line
    chosen = choose_unit(source, request, name, line)
    line = block.line + 1
    time_step = _time_step(source, block)
    check_requested_time_step(source, request, time_step, line)
    layout = _layout(source, block, text)
    values = layout.read(source, line, block.count)
    surplus = [*surplus_rows_warning(source, line + layout.rows(block.count), f"line {line}"), *cut]
    stated, metadata = _stated(block.header, block.first), description(block.header)
    return make_record(
        source, values, time_step, chosen, metadata, stated=stated, warnings_after=surplus
    )


def _component_of_pairs(
    source: Source, request: Request, first: int, pairs: Pairs
) -> FileComponent:
    header = source.top(min(pairs.data_at - first, _MAX_HEADER_LINES), first)

    def samples() -> Record:
        chosen = choose_unit(source, request, pairs.unit, pairs.unit_line)
        time_step, values = read_pairs(source, pairs)
        checked_time_step(source, request, time_step, pairs.data_at + 1)
        stated = _stated(header, first)
        surplus = surplus_rows_warning(source, pairs.end_index, "'NO. OF POINTS'")
        metadata = description(header)
        return make_record(
            source, values, time_step, chosen, metadata, stated=stated, warnings_after=surplus
        )

    return _named(header, first, samples)


def _time_step(source: Source, block: _Block) -> float:
    line = block.line + 1
    time_step = _seconds(source, block.interval or block.rate, line)
    if block.rate:
        if not time_step > 0.0:
            found = f"{time_step!r} points per second"
            raise source.refuse(found=found, expected="a rate above zero", line=line)
        time_step = 1.0 / time_step
    check_time_step(source, time_step, line)
    for number, text in enumerate(block.header, start=block.first + 1):
        match = _INTERVAL.search(text)
        if match is None:
            continue
        stated_step = _seconds(source, match.group(1), number)
        if not math.isclose(stated_step, time_step, rel_tol=1e-6):
            raise source.refuse(
                found=f"intervals of {time_step!r} s and, in line {number}, of {stated_step!r} s",
                expected="one time step",
                line=line,
            )
    return time_step


def _seconds(source: Source, text: str, line: int) -> float:
    seconds = number_or_none(text)
    if seconds is None:
        found = f"an interval of {quoted_first_line(text)} s"
        raise source.refuse(found=found, expected="a time step", line=line)
    return seconds


def _layout(source: Source, block: _Block, text: str) -> FixedWidth:
    match = _LAYOUT.search(text)
    if match is not None:
        return FixedWidth(int(match.group(2)), int(match.group(1)))
    # older files do not state it: eight in a line, 9 characters each in volume 1, 10 in volume 2;
    # it follows from the length of a full line
    per_line = min(_PER_LINE, max(block.count, 1))
    first = source.lines[block.line + 1].rstrip() if block.line + 1 < len(source.lines) else ""
    width, remainder = divmod(len(first), per_line)
    if remainder or width not in _WIDTHS:
        raise source.refuse(
            found=f"a line of {len(first)} characters ({quoted_first_line(first)})",
            expected=f"{per_line} numbers of one width",
            line=block.line + 2,
        )
    return FixedWidth(width, _PER_LINE)


CSMIP: Final = Format(
    "csmip",
    "CSMIP volume file (V1, V2), also of USC and RENADIC",
    (".v1", ".v2", ".raw"),
    _recognises,
    _read,
    holds="any number",
    unit="in the data line, or in the header",
)
