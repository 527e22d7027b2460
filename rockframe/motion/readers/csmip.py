"""CSMIP volume files (V1, V2): text, integers, reals, then data in fixed width.

A file is a row of such blocks, one per channel, each closed by a line ``/&``. A
block of volume 2 holds acceleration, velocity and displacement; only the
acceleration is read. Each announces itself::

    1138 POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)
    7500 points of accel data equally spaced at  .010 sec, in cm/sec2. (8f10.6)

Reference: A. F. Shakal and M. J. Huang, "Standard Tape Format for CSMIP
Strong-Motion Data Tapes", Report OSMS 85-03, California Division of Mines and
Geology, 1985.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Final

from rockframe.motion.readers.checks import (
    check_asked_time_step,
    check_time_step,
    choose_unit,
)
from rockframe.motion.readers.components import Component, choose_component
from rockframe.motion.readers.fixed import fixed_width, whole
from rockframe.motion.readers.orientation import Orientation, orientation_of
from rockframe.motion.readers.source import Metadata, Record, Request, Source, shown

NAME: Final = "csmip"
TITLE: Final = "CSMIP volume file (V1, V2)"
SUFFIXES: Final = (".v1", ".v2", ".raw")

_FIRST_LINE: Final = re.compile(r"^\s*(UN)?CORRECTED ACCELEROGRAM", re.IGNORECASE)
_SMC: Final = re.compile(r"^\s*\d\s")
_SPECTRA: Final = re.compile(r"^\s*RESPONSE AND FOURIER", re.IGNORECASE)
_DATA_LINE: Final = re.compile(
    r"^\s*(\d{1,12})\s+POINTS OF (ACCEL|VELOC|DISPL)\S{0,10} DATA EQUALLY SPACED AT\s+"
    r"([\d.]{1,12})\s+SEC",
    re.IGNORECASE,
)
_UNIT: Final = re.compile(r"(?:UNITS?\s*[:=]\s*|,\s*IN\s+)\(?([^\s(),;]{1,20})", re.IGNORECASE)
_LAYOUT: Final = re.compile(r"\(\s*(\d{1,3})F(\d{1,3})\.\d{1,2}\s*\)", re.IGNORECASE)
_CHANNEL: Final = re.compile(
    r"\bCHA?N\s+(\d{1,4})\s*:\s*(.{0,30}?)\s*(?:\(|FROM\b|LOCATION|$)", re.IGNORECASE
)
_LOCATION: Final = re.compile(r"\bLOCATION\s*:\s*(.{1,60})", re.IGNORECASE)
_STATION: Final = re.compile(r"\bSTATION NO\.?\s*(\S{1,20})", re.IGNORECASE)
_INTERVAL: Final = re.compile(r"EQUALLY-SPACED INTERVALS OF\s+([\d.]{1,12})\s+SEC", re.IGNORECASE)
_DEGREES: Final = re.compile(r"^(\d{1,3})\s*DEG\S{0,5}$", re.IGNORECASE)
_LONGEST_HEADER: Final = 200
_MOST_CHANNELS: Final = 500
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


def recognises(source: Source) -> bool:
    """Tell whether the first line calls itself an accelerogram, without SMC's digit."""
    first = next((line for line in source.top(4) if line.strip()), "")
    named = _FIRST_LINE.match(first) is not None and "GNS" not in first
    return (named and _SMC.match(first) is None) or _SPECTRA.match(first) is not None


def read(source: Source, request: Request) -> Record:
    """Read the acceleration of one channel, or of two.

    Parameters
    ----------
    source : Source
        File.
    request : Request
        What the caller asked for.

    Returns
    -------
    Record

    Raises
    ------
    RecordError
        Not a CSMIP file, spectra (volume 3), no evenly sampled acceleration in
        it, an unknown unit, or cut short.
    """
    if _SPECTRA.match(source.top(1)[0]):
        found = "response spectra (volume 3)"
        raise source.refuse(found=found, expected="an acceleration (volume 1 or 2)", line=1)
    blocks = _blocks(source)
    if not blocks:
        found = f"no evenly sampled accelerations below {shown(source.start)}"
        expected = "a line such as '1138 points of accel data equally spaced at .020 sec'"
        raise source.refuse(found=found, expected=expected, line=1)
    components = [_component(source, request, block) for block in blocks]
    return choose_component(source, request, components)


def _blocks(source: Source) -> list[_Block]:
    blocks: list[_Block] = []
    first = 0
    for index, line in enumerate(source.lines):
        if "/&" in line[:10]:
            first = index + 1
            continue
        if "points of" not in line[:40].casefold():
            continue  # most lines hold numbers: see at once that this one does
        match = _DATA_LINE.match(line[:200])
        if match is not None and match.group(2).upper() == "ACCEL":
            start = max(first, index - _LONGEST_HEADER)
            header = source.top(index - start, start)
            blocks.append(_Block(start, header, index, int(match.group(1)), match.group(3)))
            first = index + 1
        if len(blocks) > _MOST_CHANNELS:
            expected = f"at most {_MOST_CHANNELS} channels"
            raise source.refuse(found="more channels", expected=expected, line=index + 1)
    return blocks


def _component(source: Source, request: Request, block: _Block) -> Component:
    channel, name, line = _channel(block)

    def samples() -> Record:
        return _samples(source, request, block)

    return Component(
        name or (None if channel is None else f"channel {channel}"),
        samples,
        orientation_of(name) if name else Orientation(),
        channel=channel,
        line=line,
    )


def _channel(block: _Block) -> tuple[int | None, str, int]:
    found: tuple[int | None, str, int] = (None, "", block.first + 1)
    for line, text in enumerate(block.header, start=block.first + 1):
        match = _CHANNEL.search(text)
        if match is None:
            continue
        name = match.group(2).strip()
        degrees = _DEGREES.match(name)
        found = (whole(match.group(1)), degrees.group(1) if degrees else name, line)
        if name:
            break
    return found


def _samples(source: Source, request: Request, block: _Block) -> Record:
    line = block.line + 1
    text = source.top(1, block.line)[0]
    said = _UNIT.search(text)
    name = said.group(1).rstrip(".") if said else None
    unit, as_read, warnings = choose_unit(source, request, name, line)
    time_step = _time_step(source, block)
    check_asked_time_step(source, request, time_step, line)
    per_line, width = _layout(source, block, text)
    values = fixed_width(source, line, block.count, width=width, per_line=per_line)
    metadata = {**_description(block), "unit_as_read": as_read}
    return Record(time_step, values, unit, metadata, warnings=tuple(warnings))


def _time_step(source: Source, block: _Block) -> float:
    line = block.line + 1
    time_step = _seconds(source, block.interval, line)
    check_time_step(source, time_step, line)
    for number, text in enumerate(block.header, start=block.first + 1):
        match = _INTERVAL.search(text)
        if match is None:
            continue
        other = _seconds(source, match.group(1), number)
        if not math.isclose(other, time_step, rel_tol=1e-6):
            raise source.refuse(
                found=f"intervals of {time_step!r} s and, in line {number}, of {other!r} s",
                expected="one time step",
                line=line,
            )
    return time_step


def _seconds(source: Source, text: str, line: int) -> float:
    try:
        return float(text)
    except ValueError:
        found = f"an interval of {shown(text)} s"
        raise source.refuse(found=found, expected="a time step", line=line) from None


def _layout(source: Source, block: _Block, text: str) -> tuple[int, int]:
    said = _LAYOUT.search(text)
    if said is not None:
        return int(said.group(1)), int(said.group(2))
    # not said in the older files: eight in a line, 9 characters each in volume 1,
    # 10 in volume 2; a full line tells
    per_line = min(_PER_LINE, max(block.count, 1))
    first = source.lines[block.line + 1].rstrip() if block.line + 1 < len(source.lines) else ""
    width, rest = divmod(len(first), per_line)
    if rest or width not in _WIDTHS:
        raise source.refuse(
            found=f"a line of {len(first)} characters ({shown(first)})",
            expected=f"{per_line} numbers of one width",
            line=block.line + 2,
        )
    return _PER_LINE, width


def _description(block: _Block) -> Metadata:
    lines = [text.strip() for text in block.header]
    metadata: Metadata = {}
    place = next((k for k, text in enumerate(lines) if _FIRST_LINE.match(text)), 0)
    corrected = place + 1 < len(lines) and _FIRST_LINE.match(lines[place + 1]) is not None
    event = place + (2 if corrected else 1)
    if place < len(lines) and lines[place]:
        metadata["description"] = "corrected" if corrected else "uncorrected"
    if event < len(lines) and lines[event]:
        metadata["event"] = " ".join(lines[event].split())
    if event + 1 < len(lines) and lines[event + 1]:
        metadata["event_time"] = " ".join(lines[event + 1].split("(")[0].split())
    for number, text in enumerate(lines):
        station = _STATION.search(text)
        if station is not None:
            metadata["station"] = station.group(1)
            if number + 1 < len(lines) and lines[number + 1]:
                metadata["station_name"] = re.split(r"\s{3,}", lines[number + 1])[0]
            break
    for text in lines:
        location = _LOCATION.search(text)
        if location is not None:
            metadata["sensor_location"] = " ".join(location.group(1).split())
            break
    return metadata
