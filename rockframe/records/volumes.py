"""Files of GeoNet and BHRC: components one after another, in fixed width.

Each component has text, integers, reals, then data.

References: W. J. Cousins, "GNS Accelerogram Data Files, Standard Format", GNS Science,
22 January 2008; GeoNet, "Strong Motion File Formats"; Iran Strong Motion Network, the headers of
the files themselves.
"""

import math
import re
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from rockframe.records.checks import (
    LENGTH,
    StatedValue,
    check_requested_time_step,
    check_time_step,
    checked_time_step,
    make_record,
    surplus_rows_warning,
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
from rockframe.records.headers import first_match, required_match
from rockframe.records.numbers import (
    Fields,
    FixedWidth,
    integer_or_none,
    number_or_none,
    required_number,
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

_MAX_COMPONENTS: Final = 12

# GeoNet (GNS Science), V1A and V2A: 16 lines of text, 40 integers and 60 reals (ten of 8
# characters in a line), then the accelerations [mm/s^2], and, in a corrected file, the velocities
# and displacements, which are skipped. Integers 31 and 34 to 36 count the digitised samples and
# the accelerations, velocities and displacements; real 26 is the time step.

_GEONET_UNIT: Final = "mm/s^2"
_GEONET_FIRST: Final = re.compile(r"^\s*(un)?corrected accelerogram\b", re.IGNORECASE)
_GEONET_NAME: Final = re.compile(r"^\s*Component\s+(\S{1,12})", re.IGNORECASE)
_SITE: Final = re.compile(r"^\s*Site\s+(\S{1,12})", re.IGNORECASE)
_COUNT: Final = re.compile(r"Number of points\s+(\d{1,9})", re.IGNORECASE)
_INTERVAL: Final = re.compile(r"data at\s+([\d.]{1,9})\s+sec interval", re.IGNORECASE)
_PEAK: Final = re.compile(
    r"^\s*Acceleration:\s*peak\s+([-+.\d]{1,15})\s+(\S{1,10}/s/s)\b", re.IGNORECASE
)
_DURATION: Final = re.compile(r"\bDuration\s+([.\d]{1,12})\s*sec", re.IGNORECASE)
_GEONET_TEXT: Final = 16
_GEONET_LAYOUT: Final = FixedWidth(8, 10)
_DIGIT: Final = 5.1e-4


@dataclass(frozen=True)
class _Block:
    """One component."""

    source: Source
    index: int  # index of its first line
    corrected: bool  # whether the data are corrected

    @property
    def text(self) -> list[str]:
        """The lines of text."""
        return self.source.top(_GEONET_TEXT, self.index)

    @property
    def integers(self) -> Fields:
        """The integers of the header."""
        return Fields(self.source, _GEONET_LAYOUT, self.index + _GEONET_TEXT)

    @property
    def data(self) -> int:
        """Index of the first line of the accelerations."""
        return self.index + 26

    def quantity(self, place: int, what: str) -> int:
        """Read a number of samples, which may be zero."""
        count = self.integers.count(place, f"number of {what} (integer {place})")
        if count < 0:
            line = self.integers.line(place)
            raise self.source.refuse(found=f"{count} {what}", expected="none or more", line=line)
        return count


def _is_geonet(source: Source) -> bool:
    return any(_GEONET_FIRST.match(line) and "GNS" in line for line in source.top(4))


def _read_geonet(source: Source, request: Request) -> Record:
    components = [_geonet_component(request, *block) for block in _geonet_blocks(source)]
    return choose_component(source, request, components)


def _geonet_blocks(source: Source) -> list[tuple[_Block, int]]:
    """Find the components and the number of their accelerations."""
    blocks: list[tuple[_Block, int]] = []
    index = next((k for k, line in enumerate(source.top(4)) if _GEONET_FIRST.match(line)), 0)
    while index < len(source.lines):
        text = source.top(1, index)[0]
        if blocks and not text.strip():
            index += 1
            continue
        first = _GEONET_FIRST.match(text)
        if first is None or len(blocks) == _MAX_COMPONENTS:
            expected = "'Corrected accelerogram' or 'Uncorrected accelerogram'"
            if blocks:
                expected += (
                    f", the next component, or the end of the file (component {len(blocks)})"
                )
            raise source.refuse(found=quoted_first_line(text), expected=expected, line=index + 1)
        block = _Block(source, index, corrected=first[1] is None)
        counts = [_geonet_count(block)]
        blocks.append((block, counts[0]))
        if block.corrected:
            counts += [block.quantity(35, "velocities"), block.quantity(36, "displacements")]
        index = block.data + sum(map(_GEONET_LAYOUT.rows, counts))
        if index > source.last_line:
            # if a line is missing, the next one takes its place, even one of velocities
            found = f"the end of the file in component {len(blocks)}"
            expected = f"{index} lines, with all of its numbers"
            raise source.refuse(found=found, expected=expected, line=source.last_line)
    return blocks


def _geonet_count(block: _Block) -> int:
    count = block.quantity(34, "accelerations")
    match = _COUNT.search("\n".join(block.text))
    announced = None if match is None else int(match[1])
    if not block.corrected and count != announced:
        # the samples of an uncorrected file are the digitised ones
        digitised = block.quantity(31, "digitised samples")
        if count == 0 or digitised == announced:
            count = digitised
    if announced is not None and announced != count:
        found = f"{count} accelerations in the integers, {announced} points in the text"
        expected = "one number of samples"
        line = block.integers.line(34)
        raise block.source.refuse(found=found, expected=expected, line=line)
    return count


def _geonet_component(request: Request, block: _Block, count: int) -> FileComponent:
    match_and_line = first_match(_GEONET_NAME, block.text, block.index + 1)
    name, direction, line = "", UNKNOWN, block.index + 13
    if match_and_line is not None:
        match, line = match_and_line
        name, direction = match[1], orientation_of(match[1])
        if direction == UNKNOWN and "vertical" in match.string.casefold():
            direction = Orientation(vertical=VERTICAL)
    if direction == UNKNOWN:
        azimuth = integer_or_none(block.integers.cell(28))
        direction = UNKNOWN if azimuth is None else azimuth_of(float(azimuth))
        name = name or f"{azimuth}"
    return FileComponent(name, lambda: _geonet_samples(request, block, count), direction, line=line)


def _geonet_samples(request: Request, block: _Block, count: int) -> Record:
    source, text = block.source, block.text
    reals = Fields(source, _GEONET_LAYOUT, block.index + 20)
    line, time_step = reals.line(26), reals.number(26, "time step (real 26)")
    check_time_step(source, time_step, line)
    interval = _INTERVAL.search("\n".join(text))
    if interval is not None:
        printed = number_or_none(interval[1])
        if printed is None or not math.isclose(printed, time_step, rel_tol=1e-6, abs_tol=_DIGIT):
            stated_step = quoted_first_line(interval[0])
            found = f"a time step of {time_step!r} s, and {stated_step} in the text"
            raise source.refuse(found=found, expected="one time step", line=line)
    check_requested_time_step(source, request, time_step, line)
    chosen = choose_unit(source, request, _GEONET_UNIT, None)
    values = _GEONET_LAYOUT.read(source, block.data, count)
    stated: list[StatedValue] = []
    for number, row in enumerate(text, start=block.index + 1):
        peak, length = _PEAK.match(row), _DURATION.search(row)
        if peak is not None:
            stated.append(StatedValue(peak[1], peak[2], number))
        if length is not None:
            stated.append(StatedValue(length[1], LENGTH, number))
    return make_record(source, values, time_step, chosen, _geonet_description(block), stated=stated)


def _geonet_description(block: _Block) -> Metadata:
    text = [line.strip() for line in block.text]
    metadata: Metadata = {"description": "corrected" if block.corrected else "uncorrected"}
    site = _SITE.match(text[1]) if len(text) > 1 else None
    if site is not None:
        metadata["station"] = site[1]
    for place, key in ((3, "station_name"), (7, "event"), (8, "event_time")):
        if len(text) >= place and text[place - 1]:
            metadata[key] = " ".join(text[place - 1].split())
    year, month, day, hour, minute, thousandths = (
        block.integers.count(place, "start of the record") for place in (9, 10, 19, 20, 39, 40)
    )
    metadata["record_time"] = (
        f"{year:04d}-{month:02d}-{day:02d}T{hour:02d}:{minute:02d}:{thousandths / 1000:06.3f}Z"
    )
    return metadata


GEONET: Final = Format(
    "geonet",
    "GeoNet accelerogram (V1A, V2A)",
    (".v1a", ".v2a"),
    _is_geonet,
    _read_geonet,
    holds="three",
    unit="mm/s², by the specification",
)


# Iran's Building and Housing Research Center (BHRC), volume 1: three components, each closed by a
# line ``/&``. Each has thirteen lines of text, seven of integers and seven of reals, which may be
# cut at column 70, then data, ten numbers of 13 characters in a line. Real 7, the first of the
# second line, is the sampling rate.

_BHRC_FIRST: Final = re.compile(r"^\* VOL(\d)\S{0,4}\s+FILE:\s*(\S{1,20})", re.IGNORECASE)
_BHRC_NAME: Final = re.compile(r"^COMP\s+(\S{1,12})", re.IGNORECASE)
_POINTS: Final = re.compile(
    r"^NO\. OF POINTS\s*=\s*(\d{1,9})\s+DURATION\s*=\s*([.\d]{1,12})", re.IGNORECASE
)
_UNITS: Final = re.compile(r"^UNITS ARE SEC\w{0,4} AND (\S{1,12})", re.IGNORECASE)
_AZIMUTHS: Final = re.compile(r"\bAzimuth\s+L\s*(\d{1,3})\s+T\s*(\d{1,3})", re.IGNORECASE)
_ORIGIN: Final = re.compile(r"^Origin Time\s*:\s*(\S.{3,40}?)\s*$", re.IGNORECASE)
_STATION: Final = re.compile(r"^(\S.{0,60}?)\s{2,}Station\b")
_BHRC_TEXT: Final = 13
_BHRC_REALS_AT: Final = 20
_BHRC_DATA_AT: Final = 27
_BHRC_REALS: Final = FixedWidth(13, 6)
_BHRC_LAYOUT: Final = FixedWidth(13, 10)
_RATE: Final = 7


def _is_bhrc(source: Source) -> bool:
    return _BHRC_FIRST.match(source.top(1)[0]) is not None


def _read_bhrc(source: Source, request: Request) -> Record:
    starts: list[int] = []
    named = 0
    for index, line in enumerate(source.lines):
        if line.startswith("* VOL") and _BHRC_FIRST.match(line[:80]):
            starts.append(index)
        named += _BHRC_NAME.match(line[:80]) is not None
        if named > len(starts) > 0:
            # else it would be skipped like other lines after the samples
            found = f"{quoted_first_line(line)}, the second below one first line"
            expected = "a line such as '* VOL1DS FILE:  5526/01' above each component"
            raise source.refuse(found=found, expected=expected, line=index + 1)
        if len(starts) > _MAX_COMPONENTS:
            expected = f"at most {_MAX_COMPONENTS} components"
            raise source.refuse(found="more", expected=expected, line=index + 1)
    if not starts:
        expected = "a first line such as '* VOL1DS FILE:  5526/01'"
        raise source.refuse(found=quoted_first_line(source.start), expected=expected, line=1)
    components = [
        _bhrc_component(source, request, first, end)
        for first, end in pairwise((*starts, len(source.lines)))
    ]
    return choose_component(source, request, components)


def _bhrc_component(source: Source, request: Request, first: int, end: int) -> FileComponent:
    text = source.top(_BHRC_TEXT, first)
    match, line = required_match(source, _BHRC_NAME, text, "COMP L1", first + 1)
    name = match[1]
    return FileComponent(
        name,
        lambda: _bhrc_samples(source, request, first, end, text),
        _bhrc_orientation(name, text),
        aliases=(name.rstrip("0123456789"),),
        line=line,
    )


def _bhrc_orientation(name: str, text: list[str]) -> Orientation:
    letter = name[:1].upper()
    if letter == "V":
        return orientation_of("V")
    stated = first_match(_AZIMUTHS, text)
    if stated is None or letter not in "LT":
        return UNKNOWN
    return azimuth_of(float(stated[0][1 if letter == "L" else 2]))


def _bhrc_samples(
    source: Source, request: Request, first: int, end: int, text: list[str]
) -> Record:
    volume = _BHRC_FIRST.match(text[0])
    if volume is None or volume[1] != "1":
        expected = "uncorrected accelerations (volume 1)"
        raise source.refuse(found=quoted_first_line(text[0]), expected=expected, line=first + 1)
    such_as = "NO. OF POINTS =   9472  DURATION = 47.36"
    points, line = required_match(source, _POINTS, text, such_as, first + 1)
    such_as = "UNITS ARE SECONDS AND G/10"
    units, unit_line = required_match(source, _UNITS, text, such_as, first + 1)
    chosen = choose_unit(source, request, units[1], unit_line)
    time_step = _bhrc_time_step(source, request, first)
    count, data = int(points[1]), first + _BHRC_DATA_AT
    values = _BHRC_LAYOUT.read(source, data, count)
    metadata: Metadata = {"station": volume[2].split("/")[0], "unit_as_read": chosen[1]}
    for row in text:
        origin, station = _ORIGIN.match(row), _STATION.match(row)
        if origin is not None:
            metadata["event_time"] = " ".join(origin[1].split())
            metadata["event"] = f"earthquake of {metadata['event_time']}"
        if station is not None:
            metadata["station_name"] = station[1]
    stated = [StatedValue(points[2], LENGTH, line)]
    surplus = surplus_rows_warning(source, data + _BHRC_LAYOUT.rows(count), f"line {line}", end)
    return make_record(
        source, values, time_step, chosen, metadata, stated=stated, warnings_after=surplus
    )


def _bhrc_time_step(source: Source, request: Request, first: int) -> float:
    reals = Fields(source, _BHRC_REALS, first + _BHRC_REALS_AT)
    line = reals.line(_RATE)
    rate = required_number(reals.cell(_RATE) or "no sampling rate (real 7)", source, line)
    if not rate > 0.0:
        found = f"a sampling rate of {rate!r} Hz (real 7)"
        raise source.refuse(found=found, expected="one above zero", line=line)
    checked_time_step(source, request, 1.0 / rate, line)
    return 1.0 / rate


BHRC: Final = Format(
    "bhrc",
    "BHRC file, Iran (volume 1)",
    (".v1",),
    _is_bhrc,
    _read_bhrc,
    holds="three",
    unit="in the header",
)
