"""CSMIP volume files (V1, V2): text, integers, reals, then data in fixed width.

A file is a row of such blocks, one per channel, each closed by a line ``/&``. A
block of volume 2 holds acceleration, velocity and displacement; only the
acceleration is read. Each announces itself in one of these ways::

    1138 POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)
    7500 points of accel data equally spaced at  .010 sec, in cm/sec2. (8f10.6)
    1887 POINTS OF ACC DATA EQUALLY SPACED AT   .020 SEC.  IN UNITS CM/SEC/SEC
   13200 Accelerogram points at 200 pts/sec in units of g .      Format: (8f9.6)

The third is that of the University of Southern California, which leaves the unit away
at times: it is then the unit of the peak that the text states. Older files of volume 1
hold pairs of time and acceleration; see :mod:`rockframe.records.csmip_pairs`.

Reference: A. F. Shakal and M. J. Huang, "Standard Tape Format for CSMIP
Strong-Motion Data Tapes", Report OSMS 85-03, California Division of Mines and
Geology, 1985.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from rockframe.records.checks import (
    check_asked_time_step,
    check_time_step,
    choose_unit,
)
from rockframe.records.components import FileComponent, choose_component
from rockframe.records.csmip_header import (
    FIRST_LINE,
    channel_of,
    description,
    is_corrected,
    length_in_header,
    peak_in_header,
)
from rockframe.records.csmip_pairs import Pairs, find_pairs, read_pairs
from rockframe.records.fixed import fixed_width
from rockframe.records.orientation import Orientation, orientation_of
from rockframe.records.source import Record, Request, Source, quoted_first_line
from rockframe.records.stated import compare_length, compare_peak, surplus

if TYPE_CHECKING:
    from collections.abc import Callable

    from rockframe.errors import RecordError
    from rockframe.records.unit_names import RecordUnit
    from rockframe.signals.arrays import Array

NAME: Final = "csmip"
TITLE: Final = "CSMIP volume file (V1, V2), also of USC and RENADIC"
SUFFIXES: Final = (".v1", ".v2", ".raw")

_SMC: Final = re.compile(r"^\s*\d\s")
_SPECTRA: Final = re.compile(r"^\s*RESPONSE AND FOURIER", re.IGNORECASE)
_DATA_LINE: Final = re.compile(
    r"^\s*(\d{1,12})\s+(?:POINTS OF ACC(?:EL\S{0,10})? DATA EQUALLY SPACED AT\s+"
    r"([\d.]{1,12})\s+SEC|ACCELEROGRAM POINTS AT\s+([\d.]{1,12})\s+(?:PTS|POINTS|SAMPLES)/SEC)",
    re.IGNORECASE,
)
_UNIT: Final = re.compile(
    r"(?:\bUNITS?\s*(?:[:=]|\bOF\b)?\s*|,\s*IN\s+)\(?([^\s(),;:=]{1,20})", re.IGNORECASE
)
_LAYOUT: Final = re.compile(r"\(\s*(\d{1,3})F(\d{1,3})\.\d{1,2}\s*\)", re.IGNORECASE)
_INTERVAL: Final = re.compile(r"EQUALLY-SPACED INTERVALS OF\s+([\d.]{1,12})\s+SEC", re.IGNORECASE)
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
    rate: str


def recognises(source: Source) -> bool:
    """Tell whether the first line calls itself an accelerogram, without SMC's digit."""
    first = next((line for line in source.top(4) if line.strip()), "")
    named = FIRST_LINE.match(first) is not None and "GNS" not in first
    return (named and _SMC.match(first) is None) or _SPECTRA.match(first) is not None


def read(source: Source, request: Request) -> Record:
    """Read the acceleration of one channel, or of two."""
    if _SPECTRA.match(source.top(1)[0]):
        found = "response spectra (volume 3)"
        raise source.refuse(found=found, expected="an acceleration (volume 1 or 2)", line=1)
    components = [_component(source, request, block) for block in _blocks(source)]
    components = components or _components_of_pairs(source, request)
    if not components:
        found = f"no evenly sampled accelerations below {quoted_first_line(source.start)}"
        expected = "a line such as '1138 points of accel data equally spaced at .020 sec'"
        raise source.refuse(found=found, expected=expected, line=1)
    return choose_component(source, request, components)


def _blocks(source: Source) -> list[_Block]:
    blocks: list[_Block] = []
    first = 0
    for index, line in enumerate(source.lines):
        if "/&" in line[:10]:
            first = index + 1
            continue
        if "points" not in line[:40].casefold():
            continue  # most lines hold numbers: see at once that this one does
        match = _DATA_LINE.match(line[:200])
        if match is not None:
            start = max(first, index - _LONGEST_HEADER)
            header = source.top(index - start, start)
            count, interval, rate = match.groups()
            blocks.append(_Block(start, header, index, int(count), interval or "", rate or ""))
            first = index + 1
        if len(blocks) > _MOST_CHANNELS:
            raise _too_many(source, index + 1)
    return blocks


def _too_many(source: Source, line: int) -> RecordError:
    expected = f"at most {_MOST_CHANNELS} channels"
    return source.refuse(found="more channels", expected=expected, line=line)


def _component(source: Source, request: Request, block: _Block) -> FileComponent:
    def samples() -> Record:
        return _samples(source, request, block)

    return _named(block.header, block.first, samples)


def _named(header: list[str], first: int, samples: Callable[[], Record]) -> FileComponent:
    channel, name, line = channel_of(header, first)
    return FileComponent(
        name or (None if channel is None else f"channel {channel}"),
        samples,
        orientation_of(name) if name else Orientation(),
        channel=channel,
        line=line,
    )


def _samples(source: Source, request: Request, block: _Block) -> Record:
    line = block.line + 1
    text = source.top(1, block.line)[0]
    said = _UNIT.search(text)
    name = said.group(1).rstrip(".") if said else None
    peak = peak_in_header(block.header, block.first, corrected=is_corrected(block.header))
    if name is None and peak is not None:
        name, line = peak.unit, peak.line
    unit, as_read, warnings = choose_unit(source, request, name, line)
    line = block.line + 1
    time_step = _time_step(source, block)
    check_asked_time_step(source, request, time_step, line)
    per_line, width = _layout(source, block, text)
    values = fixed_width(source, line, block.count, width=width, per_line=per_line)
    behind = surplus(source, line + -(-block.count // per_line), f"line {line}")
    doubts = _doubts(source, block.header, block.first, time_step, values, unit)
    metadata = {**description(block.header), "unit_as_read": as_read}
    return Record(time_step, values, unit, metadata, warnings=(*warnings, *doubts, *behind))


def _doubts(
    source: Source,
    header: list[str],
    first: int,
    time_step: float,
    values: Array,
    unit: RecordUnit,
) -> list[str]:
    doubts: list[str] = []
    peak = peak_in_header(header, first, corrected=is_corrected(header))
    if peak is not None:
        doubts += compare_peak(
            source, values, unit, printed=peak.text, printed_unit=peak.unit, line=peak.line
        )
    length = length_in_header(header, first)
    if length is not None:
        doubts += compare_length(
            source, values.size, time_step, printed=length.text, line=length.line
        )
    return doubts


def _components_of_pairs(source: Source, request: Request) -> list[FileComponent]:
    components: list[FileComponent] = []
    last = -2
    for index, line in enumerate(source.lines):
        if "accelerogram" not in line[:60].casefold() or FIRST_LINE.match(line[:200]) is None:
            continue
        pairs = None if index == last + 1 else find_pairs(source, index)
        last = index
        if pairs is not None:
            components.append(_component_of_pairs(source, request, index, pairs))
        if len(components) > _MOST_CHANNELS:
            raise _too_many(source, index + 1)
    return components


def _component_of_pairs(
    source: Source, request: Request, first: int, pairs: Pairs
) -> FileComponent:
    header = source.top(min(pairs.data_at - first, _LONGEST_HEADER), first)

    def samples() -> Record:
        unit, as_read, warnings = choose_unit(source, request, pairs.unit, pairs.unit_line)
        time_step, values = read_pairs(source, pairs)
        line = pairs.data_at + 1
        check_time_step(source, time_step, line)
        check_asked_time_step(source, request, time_step, line)
        doubts = _doubts(source, header, first, time_step, values, unit)
        doubts += surplus(source, pairs.behind, "'NO. OF POINTS'")
        metadata = {**description(header), "unit_as_read": as_read}
        return Record(time_step, values, unit, metadata, warnings=(*warnings, *doubts))

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
        found = f"an interval of {quoted_first_line(text)} s"
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
            found=f"a line of {len(first)} characters ({quoted_first_line(first)})",
            expected=f"{per_line} numbers of one width",
            line=block.line + 2,
        )
    return _PER_LINE, width
