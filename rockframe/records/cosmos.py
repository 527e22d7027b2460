"""COSMOS strong-motion data files: text, integers, reals, comments, data; fixed width.

A file is a sequence of such blocks, one for each channel and quantity. Only accelerations are
read. The time step is real header 62, in milliseconds.

Reference: Consortium of Organizations for Strong-Motion Observation Systems,
"COSMOS Strong Motion Data Format", version 1.20, August 15, 2001.
"""

import math
import re
from dataclasses import dataclass
from typing import Final

from rockframe.records.checks import (
    StatedValue,
    check_requested_time_step,
    check_time_step,
    make_record,
    surplus_rows_warning,
    truncation_warning,
)
from rockframe.records.components import (
    DOWNWARDS,
    UPWARDS,
    VERTICAL,
    FileComponent,
    Orientation,
    azimuth_of,
    choose_component,
    orientation_of,
)
from rockframe.records.headers import first_match
from rockframe.records.numbers import Fields, FixedWidth, integer_or_none
from rockframe.records.reader import (
    Format,
    Metadata,
    Record,
    Request,
    Source,
    choose_unit,
    quoted_first_line,
)
from rockframe.records.unit_names import acceleration_unit

MILLISECOND: Final = 1e-3

ACCELERATION: Final = 1
"""Integer header 2 for an acceleration."""

QUANTITIES: Final = {
    2: "a velocity",
    3: "a displacement",
    4: "a relative displacement",
    10: "an angular acceleration",
    11: "an angular velocity",
    12: "an angular displacement",
    20: "a pressure",
    21: "a pressure",
    30: "a strain",
    31: "a strain",
}
"""Integer header 2 for other quantities."""

UNITS: Final = {
    2: "g",
    4: "cm/sec^2",
    5: "cm/sec",
    6: "cm",
    7: "in/sec^2",
    8: "in/sec",
    9: "in",
    10: "gal",
    11: "mg",
    12: "micro g",
    50: "counts",
    51: "volts",
}
"""Units by integer header 3, which is also the number after ``units=``."""

ORIENTATIONS: Final = {
    400: Orientation(vertical=UPWARDS),
    401: Orientation(vertical=DOWNWARDS),
    402: Orientation(vertical=VERTICAL),
}
"""Directions by integer header 54, unless it is an azimuth from 1 to 360 degrees."""

_INTEGERS: Final = re.compile(
    r"(\d{1,4})\s+Integer-header values follow on\s+(\d{1,4})\s+lines?,?"
    r"\s*Format\s*=?\s*\(\s*(\d{1,3})I(\d{1,3})\)",
    re.IGNORECASE,
)
_REALS: Final = re.compile(
    r"(\d{1,4})\s+Real-header values follow on\s+(\d{1,4})\s+lines?,?"
    r"\s*Format\s*=?\s*\(\s*(\d{1,3})[FEG](\d{1,3})\.\d{1,3}\)",
    re.IGNORECASE,
)
_OF_INTEGERS: Final = (
    "integer header", "100 Integer-header values follow on 10 lines, Format= (10I8)",
)  # fmt: skip
_OF_REALS: Final = (
    "real header", "100 Real-header values follow on 20 lines, Format= (5F15.6)",
)  # fmt: skip
_COMMENTS: Final = re.compile(r"(\d{1,6})\s+Comment line", re.IGNORECASE)
_UNKNOWN: Final = re.compile(r"unspecified:\s*(-?\d{1,8})\s*,?\s*(-?[\d.]{1,12})")
_USUAL_UNKNOWN: Final = (-999, -999.0)
_MAX_COMMENTS: Final = 200


@dataclass(frozen=True)
class _Header:
    """Header of one channel and quantity."""

    text: list[str]  # first lines of text
    integers: Fields
    reals: Fields
    integer_count: int
    real_count: int
    comments: str  # comment lines
    data_at: int  # index of the line that announces the data
    end: int  # index of the line after the block
    unknown: tuple[int, float]  # marks of an unknown integer and an unknown real

    def line(self, place: int) -> str:
        """Return a text line by its number from 1; empty if it is missing."""
        return self.text[place - 1] if place <= len(self.text) else ""

    def integer(self, place: int) -> int | None:
        """Return an integer header by its number from 1; None if it is unknown."""
        if place > self.integer_count or not self.integers.cell(place):
            return None
        value = self.integers.count(place, f"integer header {place}")
        return None if value == self.unknown[0] else value

    def real(self, place: int) -> float | None:
        """Return a real header by its number from 1; None if it is unknown."""
        if place > self.real_count or not self.reals.cell(place):
            return None
        value = self.reals.number(place, f"real header {place}")
        return None if math.isclose(value, self.unknown[1]) else value


def _read_header(source: Source, start: int, end: int, text_lines: int) -> _Header:
    at = start + text_lines
    integers, integer_count, at = _section(source, at, end, _INTEGERS, *_OF_INTEGERS)
    reals, real_count, comments_line = _section(source, at, end, _REALS, *_OF_REALS)
    comments, data_at = "", comments_line
    match = _COMMENTS.search(source.top(1, comments_line)[0]) if comments_line < end else None
    if match is not None:
        first = comments_line + 1
        data_at = min(first + int(match.group(1)), end)
        comments = "\n".join(source.top(min(data_at - first, _MAX_COMMENTS), first))
    text = source.top(min(text_lines, end - start), start)
    unknown = _unknown(source.top(text_lines, start))
    return _Header(
        text, integers, reals, integer_count, real_count, comments, data_at, end, unknown
    )


def _section(
    source: Source, at: int, end: int, announcement: re.Pattern[str], what: str, such_as: str
) -> tuple[Fields, int, int]:
    """Return the fields of a section, their number, and the index of the line below them."""
    # one line of tolerance: some files have one more line of text than they announce
    for index in (at, at + 1, at - 1):
        if not 0 <= index < end:
            continue
        match = announcement.search(source.top(1, index)[0])
        if match is None:
            continue
        count, lines, columns, width = (int(group) for group in match.groups())
        first = index + 1
        if columns < 1 or width < 1 or count > lines * columns or first + lines > end:
            found = f"{count} values on {lines} lines of {columns} ({what})"
            expected = "as many lines as these values need, and as many as follow"
            raise source.refuse(found=found, expected=expected, line=index + 1)
        return Fields(source, FixedWidth(width, columns), first), count, first + lines
    index = min(max(at, 0), end - 1)
    found = quoted_first_line(source.lines[index])
    expected = f"the line that announces the {what}, such as '{such_as}'"
    raise source.refuse(found=found, expected=expected, line=index + 1)


def _unknown(lines: list[str]) -> tuple[int, float]:
    for line in reversed(lines):
        match = _UNKNOWN.search(line)
        if match is None:
            continue
        try:
            return int(match.group(1)), float(match.group(2).rstrip("."))
        except ValueError:  # two decimal points
            continue
    return _USUAL_UNKNOWN


_FIRST_LINE: Final = re.compile(r"^(.{0,60}?)\(Format v?(\d[\d.]{0,8}) with (\d{1,3}) text", re.I)
_DATA_LINE: Final = re.compile(
    r"^\s*(\d{1,12})\s+(\S.{0,40}?)\s*\bpts\b.{0,60}?\bunits\s*=\s*([^,=]{0,40}?)\s*,?"
    r"\s*Format\s*=\s*\(\s*(\d{0,4})\s*[A-Z](\d{1,3})(?:\.\d{1,3}[A-Z]?\d{0,2})?\s*\)",
    re.IGNORECASE,
)
_UNIT_CODE: Final = re.compile(r"^(.*?)\s*\(\s*(\d{1,3})\s*\)$")
_CHANNEL: Final = re.compile(r"Chan\s*(\S{1,8}?)\s*:\s*(.{0,30}?)\s*(?:\(|$)", re.IGNORECASE)
_SCNL: Final = re.compile(r"\bSCNL>?:?\s*(\w{1,8})\.(\w{1,8})\.(\w{1,8})\.(\S{1,8})")
_STATION: Final = re.compile(r"\bCode:\s*(\S{1,20})\s*(.{0,60})")
_START: Final = re.compile(r"start time:\s*(\S.{0,30}?)\s*(?:\(|RcrdId|$)", re.IGNORECASE)
_DAY: Final = re.compile(r"(?:Mon|Tue|Wed|Thu|Fri|Sat|Sun)\w{0,6}[ ,]+\w{3}", re.IGNORECASE)
_LENGTH_SHARE: Final = 0.01
_FIRST_LINE_WIDTH: Final = 120
_MAX_BLOCKS: Final = 1_500


@dataclass(frozen=True)
class _Block:
    """One channel and quantity: its range of lines, and the statements of its first line."""

    index: int
    end: int
    kind: str
    text_lines: int


def _recognises(source: Source) -> bool:
    return any(_FIRST_LINE.search(line) for line in source.top(4))


def _read(source: Source, request: Request) -> Record:
    blocks = _blocks(source)
    if not blocks:
        found = f"{quoted_first_line(source.start)}"
        expected = (
            "a first line such as 'Corrected acceleration (Format v01.20 with 13 text lines)'"
        )
        raise source.refuse(found=found, expected=expected, line=1)
    accelerations = [block for block in blocks if "accel" in block.kind.casefold()]
    if not accelerations:
        kinds = ", ".join(sorted({quoted_first_line(block.kind) for block in blocks})[:4])
        expected = "an acceleration"
        raise source.refuse(found=f"only {kinds}", expected=expected, line=blocks[0].index + 1)
    cut = [] if blocks[-1] in accelerations else _ends_inside(source, blocks[-1])
    components = [_component(source, request, block, cut) for block in accelerations]
    return choose_component(source, request, components)


def _ends_inside(source: Source, block: _Block) -> list[str]:
    """Say of a file that it ends inside a block, whatever that holds."""
    for line, text in enumerate(source.lines[block.index : block.end], start=block.index + 1):
        match = _DATA_LINE.match(text) if "pts" in text else None
        if match is not None:
            layout = FixedWidth(int(match.group(5)), max(int(match.group(4) or 1), 1))
            return truncation_warning(source, line, layout.rows(int(match.group(1))))
    return truncation_warning(source, block.index + 1, len(source.lines))


def _blocks(source: Source) -> list[_Block]:
    starts: list[tuple[int, re.Match[str]]] = []
    data_lines = 0
    for index, line in enumerate(source.lines):
        top = line[:_FIRST_LINE_WIDTH].casefold()
        data_lines += "pts" in top and _DATA_LINE.match(line) is not None
        if data_lines > len(starts) > 0:
            # else it would be skipped like other lines after the samples
            found = f"{quoted_first_line(line)}, the second in this block"
            expected = "a first line with '(Format v01.20 with ... text lines)' above each"
            raise source.refuse(found=found, expected=expected, line=index + 1)
        if "(format v" in top:
            match = _FIRST_LINE.search(line)
            if match is not None:
                starts.append((index, match))
            if len(starts) > _MAX_BLOCKS:
                expected = f"at most {_MAX_BLOCKS} channels and quantities"
                raise source.refuse(found="more of them", expected=expected, line=index + 1)
    ends = [*(index for index, _ in starts), len(source.lines)][1:]
    return [
        _Block(index, end, match.group(1).strip(), int(match.group(3)))
        for (index, match), end in zip(starts, ends, strict=True)
    ]


def _component(source: Source, request: Request, block: _Block, cut: list[str]) -> FileComponent:
    header = _read_header(source, block.index, block.end, block.text_lines)
    channel, direction = _channel(header)
    code = _SCNL.search(header.comments)
    name = code.group(2) if code else direction or f"channel {channel or '?'}"
    aliases = [direction] if direction else []
    if code:
        aliases.append(".".join((code.group(3), code.group(1), code.group(4), code.group(2))))
    return FileComponent(
        name,
        lambda: _samples(source, request, header, cut),
        _orientation(header, direction, code.group(2) if code else ""),
        channel=channel,
        aliases=tuple(aliases),
        line=min(block.index + 9, block.end),
    )


def _channel(header: _Header) -> tuple[int | None, str]:
    match = _CHANNEL.search(header.line(9))
    if match is None:
        return None, ""
    direction = match.group(2).strip()
    return integer_or_none(match.group(1)), "" if direction.casefold() == "other" else direction


def _orientation(header: _Header, direction: str, code: str) -> Orientation:
    seed = orientation_of(code)
    if seed.vertical is not None:  # some files state an azimuth for a vertical channel
        return seed
    azimuth = header.integer(54)
    if azimuth in ORIENTATIONS:
        return ORIENTATIONS[azimuth]
    if azimuth is not None and 1 <= azimuth <= 360:
        return azimuth_of(float(azimuth))
    stated = orientation_of(direction)
    return stated if stated != Orientation() else seed


def _samples(source: Source, request: Request, header: _Header, cut: list[str]) -> Record:
    line, match = _data_line(source, header)
    quantity = header.integer(2)
    if quantity is not None and quantity != ACCELERATION and quantity in QUANTITIES:
        found = f"{QUANTITIES[quantity]} (code {quantity})"
        raise source.refuse(found=found, expected="an acceleration", line=header.integers.line(2))
    name = _unit_name(source, request, header, match.group(3), line)
    chosen = choose_unit(source, request, name, line)
    count = int(match.group(1))
    time_step = _time_step(source, header, count)
    check_requested_time_step(source, request, time_step, header.reals.line(62))
    layout = FixedWidth(int(match.group(5)), int(match.group(4) or 1))
    values = layout.read(source, line, count)
    peak = header.real(64)
    stated: list[StatedValue] = []
    if peak is not None and quantity == ACCELERATION:
        peak_unit = chosen[1] if request.unit is None else name
        stated.append(StatedValue(f"{peak:.12g}", peak_unit, header.reals.line(64)))
    surplus = [
        *surplus_rows_warning(source, line + layout.rows(count), f"line {line}", header.end),
        *cut,
    ]
    metadata = _description(header)
    return make_record(
        source, values, time_step, chosen, metadata, stated=stated, warnings_after=surplus
    )


def _data_line(source: Source, header: _Header) -> tuple[int, re.Match[str]]:
    match_and_line = first_match(_DATA_LINE, source.top(3, header.data_at), header.data_at + 1)
    if match_and_line is not None:
        return match_and_line[1], match_and_line[0]
    index = min(header.data_at, len(source.lines) - 1)
    first = quoted_first_line(source.lines[index])
    expected = "a line such as '42000 acceleration pts, ..., units=cm/sec2(04),Format=(8F10.3)'"
    raise source.refuse(found=first, expected=expected, line=index + 1)


def _unit_name(source: Source, request: Request, header: _Header, text: str, line: int) -> str:
    match = _UNIT_CODE.match(text)
    name = (match.group(1) if match else text).strip().rstrip(".")
    code = integer_or_none(match.group(2)) if match else header.integer(3)
    known, by_code = acceleration_unit(name), acceleration_unit(UNITS.get(code or 0, ""))
    agree = known is None or by_code is None or math.isclose(known.factor, by_code.factor)
    if request.unit is None and not agree:
        found = f"the unit {name!r} with the code {code}, which is {UNITS[code or 0]}"
        raise source.refuse(found=found, expected="one unit, or the argument unit", line=line)
    return name or UNITS.get(code or 0, "")


def _time_step(source: Source, header: _Header, count: int) -> float:
    line = header.reals.line(62)
    milliseconds = header.real(62)
    if milliseconds is None:
        found = "no sample interval (real header 62)"
        raise source.refuse(found=found, expected="the interval in milliseconds", line=line)
    # 15 digits, so that 5 ms are exactly the float 0.005, without the rounding error of 5 * 1e-3
    time_step = float(f"{milliseconds * MILLISECOND:.15g}")
    check_time_step(source, time_step, line)
    length = header.real(63)
    if length is not None and length > 0.0:
        # by the specification the length is count dt; (count - 1) dt occurs, too
        misfit = min(abs(length - count * time_step), abs(length - (count - 1) * time_step))
        if misfit > max(2.0 * time_step, _LENGTH_SHARE * length):
            raise source.refuse(
                found=f"{count} samples at {time_step!r} s in {length:g} s (real headers 62, 63)",
                expected="a sample interval in milliseconds that agrees with the length",
                line=line,
            )
    return time_step


def _description(header: _Header) -> Metadata:
    metadata: Metadata = {"description": header.line(1).split("(")[0].strip()}
    event = re.sub(r"^(?:Record|Rcrd) of\s+", "", header.line(2).strip(), flags=re.IGNORECASE)
    if _DAY.match(event):  # before an event is known, the field has the day of the record
        metadata["event_time"] = event
    elif event:
        metadata["event"] = event
    origin = header.line(4).strip()
    if origin.casefold().startswith("origin:") and re.search(r"\d", origin):
        metadata["event_time"] = " ".join(origin[7:].split())
    station = _STATION.search(header.line(5))
    if station is not None:
        metadata["station"] = station.group(1)
        if station.group(2).strip():
            metadata["station_name"] = " ".join(station.group(2).split())
    start = _START.search(header.line(8))
    if start is not None:
        metadata["record_time"] = start.group(1)
    return metadata


COSMOS: Final = Format(
    "cosmos",
    "COSMOS v1.20 file (V1, V2)",
    (".v1c", ".v2c", ".v1", ".v2"),
    _recognises,
    _read,
    holds="any number",
    unit="in the data line, name and code",
)
