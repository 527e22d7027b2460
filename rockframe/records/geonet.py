"""GeoNet (GNS Science) accelerograms, V1A and V2A: three components one after another.

Each component has 16 lines of text, 40 integers and 60 reals (ten of 8 characters in
a line), then its accelerations [mm/s^2], and, in a corrected file, its velocities and
displacements, which are skipped. Integers 31 and 34 to 36 count the digitised samples
and the accelerations, velocities and displacements; real 26 is the time step.

Reference: W. J. Cousins, "GNS Accelerogram Data Files, Standard Format", GNS Science,
22 January 2008; GeoNet, "Strong Motion File Formats".
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Final

from rockframe.records.checks import (
    check_asked_time_step,
    check_time_step,
    compare_length,
    compare_peak,
)
from rockframe.records.components import (
    UNKNOWN,
    VERTICAL,
    FileComponent,
    Orientation,
    azimuth_of,
    choose_component,
    orientation_of,
)
from rockframe.records.numbers import cell, fixed_width, header_count, header_number, whole
from rockframe.records.record_file import Metadata, Record, Request, Source, quoted_first_line
from rockframe.records.unit_names import choose_unit

NAME: Final = "geonet"
TITLE: Final = "GeoNet accelerogram (V1A, V2A)"
SUFFIXES: Final = (".v1a", ".v2a")

UNIT: Final = "mm/s^2"
"""Of the accelerations, by the specification."""

_FIRST_LINE: Final = re.compile(r"^\s*(un)?corrected accelerogram\b", re.IGNORECASE)
_COMPONENT: Final = re.compile(r"^\s*Component\s+(\S{1,12})", re.IGNORECASE)
_SITE: Final = re.compile(r"^\s*Site\s+(\S{1,12})", re.IGNORECASE)
_POINTS: Final = re.compile(r"Number of points\s+(\d{1,9})", re.IGNORECASE)
_INTERVAL: Final = re.compile(r"data at\s+([\d.]{1,9})\s+sec interval", re.IGNORECASE)
_PEAK: Final = re.compile(
    r"^\s*Acceleration:\s*peak\s+([-+.\d]{1,15})\s+(\S{1,10}/s/s)\b", re.IGNORECASE
)
_LENGTH: Final = re.compile(r"\bDuration\s+([.\d]{1,12})\s*sec", re.IGNORECASE)
_TEXT_LINES: Final = 16
_HEADER_LINES: Final = 26
_REALS: Final = 20
_LAYOUT: Final = {"width": 8, "per_line": 10}
_MOST_COMPONENTS: Final = 12
_DIGIT: Final = 5.1e-4


@dataclass(frozen=True)
class _Block:
    """One component: where it starts, and how many accelerations it has."""

    index: int
    count: int
    corrected: bool

    @property
    def integers(self) -> int:
        """Index of the first line of the integers."""
        return self.index + _TEXT_LINES

    @property
    def reals(self) -> int:
        """Index of the first line of the reals."""
        return self.index + _REALS

    @property
    def data(self) -> int:
        """Index of the first line of the accelerations."""
        return self.index + _HEADER_LINES


def recognises(source: Source) -> bool:
    """Tell whether the first line calls itself an accelerogram of GNS Science."""
    return any(_FIRST_LINE.match(line) and "GNS" in line for line in source.top(4))


def read(source: Source, request: Request) -> Record:
    """Read the acceleration of one component, or of two."""
    components = [_component(source, request, block) for block in _blocks(source)]
    return choose_component(source, request, components)


def _blocks(source: Source) -> list[_Block]:
    blocks: list[_Block] = []
    index = next((k for k, line in enumerate(source.top(4)) if _FIRST_LINE.match(line)), 0)
    while index < len(source.lines):
        text = source.top(1, index)[0]
        if blocks and not text.strip():
            index += 1
            continue
        first = _FIRST_LINE.match(text)
        if first is None or len(blocks) == _MOST_COMPONENTS:
            expected = "'Corrected accelerogram' or 'Uncorrected accelerogram'"
            if blocks:
                expected += (
                    f", the next component, or the end of the file (component {len(blocks)})"
                )
            raise source.refuse(found=quoted_first_line(text), expected=expected, line=index + 1)
        corrected = first.group(1) is None
        block = _Block(index, _count(source, index, corrected=corrected), corrected)
        blocks.append(block)
        counts = [block.count]
        if corrected:
            counts += [
                _quantity(source, block, 35, "velocities"),
                _quantity(source, block, 36, "displacements"),
            ]
        index = block.data + sum(-(-count // _LAYOUT["per_line"]) for count in counts)
    return blocks


def _count(source: Source, index: int, *, corrected: bool) -> int:
    block = _Block(index, 0, corrected)
    count = _quantity(source, block, 34, "accelerations")
    said = _POINTS.search("\n".join(source.top(_TEXT_LINES, index)))
    announced = None if said is None else int(said.group(1))
    if not corrected and count != announced:
        # an uncorrected file holds what was digitised
        digitised = _quantity(source, block, 31, "digitised samples")
        if count == 0 or digitised == announced:
            count = digitised
    if announced is not None and announced != count:
        found = f"{count} accelerations in the integers, {announced} points in the text"
        expected = "one number of samples"
        raise source.refuse(found=found, expected=expected, line=block.integers + 4)
    return count


def _quantity(source: Source, block: _Block, place: int, what: str) -> int:
    count = header_count(
        source, block.integers, place, **_LAYOUT, what=f"number of {what} (integer {place})"
    )
    if count < 0:
        line = block.integers + 4
        raise source.refuse(found=f"{count} {what}", expected="none or more", line=line)
    return count


def _component(source: Source, request: Request, block: _Block) -> FileComponent:
    text = source.top(_TEXT_LINES, block.index)
    line = block.index + 13
    found = next(
        ((k, match) for k, row in enumerate(text) if (match := _COMPONENT.match(row))), None
    )
    name, direction = "", UNKNOWN
    if found is not None:
        line, name = block.index + found[0] + 1, found[1].group(1)
        direction = orientation_of(name)
    if direction == UNKNOWN and found is not None and "vertical" in text[found[0]].casefold():
        direction = Orientation(vertical=VERTICAL)
    if direction == UNKNOWN:
        azimuth = whole(cell(source, block.integers, 28, **_LAYOUT))
        direction = UNKNOWN if azimuth is None else azimuth_of(float(azimuth))
        name = name or f"{azimuth}"

    def samples() -> Record:
        return _samples(source, request, block)

    return FileComponent(name, samples, direction, line=line)


def _samples(source: Source, request: Request, block: _Block) -> Record:
    line = block.reals + 3
    time_step = header_number(source, block.reals, 26, **_LAYOUT, what="time step (real 26)")
    check_time_step(source, time_step, line)
    said = _INTERVAL.search("\n".join(source.top(_TEXT_LINES, block.index)))
    if said is not None:
        printed = _number_or_none(said.group(1))
        if printed is None or not math.isclose(printed, time_step, rel_tol=1e-6, abs_tol=_DIGIT):
            stated = quoted_first_line(said.group(0))
            found = f"a time step of {time_step!r} s, and {stated} in the text"
            raise source.refuse(found=found, expected="one time step", line=line)
    check_asked_time_step(source, request, time_step, line)
    unit, as_read, warnings = choose_unit(source, request, UNIT, None)
    values = fixed_width(source, block.data, block.count, **_LAYOUT)
    for number, text in enumerate(source.top(_TEXT_LINES, block.index), start=block.index + 1):
        peak, length = _PEAK.match(text), _LENGTH.search(text)
        if peak is not None:
            printed, name = peak.groups()
            warnings += compare_peak(
                source, values, unit, printed=printed, printed_unit=name, line=number
            )
        if length is not None:
            warnings += compare_length(
                source, values.size, time_step, printed=length.group(1), line=number
            )
    metadata = {**_description(source, block), "unit_as_read": as_read}
    return Record(time_step, values, unit, metadata, warnings=tuple(warnings))


def _number_or_none(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def _description(source: Source, block: _Block) -> Metadata:
    text = [line.strip() for line in source.top(_TEXT_LINES, block.index)]
    metadata: Metadata = {"description": "corrected" if block.corrected else "uncorrected"}
    site = _SITE.match(text[1]) if len(text) > 1 else None
    if site is not None:
        metadata["station"] = site.group(1)
    for place, key in ((3, "station_name"), (7, "event"), (8, "event_time")):
        if len(text) >= place and text[place - 1]:
            metadata[key] = " ".join(text[place - 1].split())
    start = [
        header_count(source, block.integers, place, **_LAYOUT, what="start of the record")
        for place in (9, 10, 19, 20, 39, 40)
    ]
    year, month, day, hour, minute, thousandths = start
    metadata["record_time"] = (
        f"{year:04d}-{month:02d}-{day:02d}T{hour:02d}:{minute:02d}:{thousandths / 1000:06.3f}Z"
    )
    return metadata
