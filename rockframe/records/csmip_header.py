"""What the text above the data of a CSMIP volume file says: channel, event, peak, length."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from rockframe.records.fixed import whole

if TYPE_CHECKING:
    from rockframe.records.source import Metadata

FIRST_LINE: Final = re.compile(
    r"^\s*(?:FILE\s+\d{0,6}\s+OF\s+)?(?:UN)?CORRECTED ACCELEROGRAM", re.IGNORECASE
)
"""Of a file, and of each channel; of a corrected one the second line, too."""

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


@dataclass(frozen=True)
class Stated:
    """A value as a header prints it."""

    text: str  # the number
    unit: str  # its unit, as record files spell it
    line: int  # where it stands, from 1


def channel_of(header: list[str], first: int) -> tuple[int | None, str, int]:
    """Find number and direction of a channel."""
    found: tuple[int | None, str, int] = (None, "", first + 1)
    for line, text in enumerate(header, start=first + 1):
        match = _CHANNEL.search(text)
        if match is None:
            continue
        name = match.group(2).strip()
        degrees = _DEGREES.match(name)
        found = (whole(match.group(1)), degrees.group(1) if degrees else name, line)
        if name:
            return found
    for line, text in enumerate(header, start=first + 1):
        match = _COMPONENT.search(text)
        if match is not None:
            return found[0], match.group(1), line
    return found


def peak_in_header(header: list[str], first: int, *, corrected: bool) -> Stated | None:
    """Find the peak of the acceleration; arguments as for :func:`channel_of`."""
    for line, text in enumerate(header, start=first + 1):
        match = _PEAK.search(f"{text} ")
        if match is not None:
            number, name, per_time = match.groups()
            return Stated(number, f"{name}{per_time or ''}".casefold(), line)
        match = None if corrected else _UNCORRECTED_PEAK.search(text)
        if match is not None:
            return Stated(match.group(1), "g", line)
    return None


def length_in_header(header: list[str], first: int) -> Stated | None:
    """Find the length of the record; arguments as for :func:`channel_of`."""
    for line, text in enumerate(header, start=first + 1):
        match = _LENGTH.search(text)
        if match is not None:
            return Stated(match.group(1), "s", line)
    return None


def is_corrected(header: list[str]) -> bool:
    """Tell whether the first line of a header calls the data corrected."""
    return any(_CORRECTED.match(text) for text in header)


def description(header: list[str]) -> Metadata:
    """Give what goes into the metadata."""
    lines = [text.strip() for text in header]
    metadata: Metadata = {}
    place = next((k for k, text in enumerate(lines) if FIRST_LINE.match(text)), 0)
    second = place + 1 < len(lines) and FIRST_LINE.match(lines[place + 1]) is not None
    if lines:
        metadata["description"] = "corrected" if is_corrected(lines) else "uncorrected"
    metadata |= _event(lines, place + (2 if second else 1))
    for number, text in enumerate(lines):
        station = _STATION.search(text)
        if station is None:
            continue
        if _COORDINATE.fullmatch(station.group(1)) is None:
            metadata["station"] = station.group(1)
        if number + 1 < len(lines) and lines[number + 1]:
            name = _WIDE_GAP.split(lines[number + 1])[0]
            if _PROCESSING.search(name) is None:
                metadata["station_name"] = name
        break
    location = next((match for text in lines if (match := _LOCATION.search(text))), None)
    if location is not None:
        metadata["sensor_location"] = " ".join(location.group(1).split())
    return metadata


def _event(lines: list[str], place: int) -> Metadata:
    # The two lines hold a name and a time, or, before an event is known, words about the
    # processing. What is neither a name nor a time is not passed off as one.
    name, time = "", ""
    for text in lines[place : place + 2]:
        told = _RECORD_OF.sub("", _WIDE_GAP.split(text.split("(")[0].strip())[0])
        if _DATE.search(told):
            time = time or told
        elif not name and _PROCESSING.search(told) is None and re.search("[a-z]{3}", told, re.I):
            name = told
    for text in lines:
        said = _OF_DATE.match(_WIDE_GAP.split(text)[0])
        if said is not None:
            name, time = name or said.group(1), time or said.group(2)
        origin = _ORIGIN.search(text)
        if origin is not None and not time and _DATE.search(origin.group(1)):
            time = origin.group(1).strip()
    found = {"event": " ".join(name.split()), "event_time": " ".join(time.split())}
    return {key: value for key, value in found.items() if value}
