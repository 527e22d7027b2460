"""Files of the China Strong Motion Networks Centre: text, then numbers in free format.

One component in a file, below sixteen lines such as::

    COMP. EW
    UNCORRECTED ACCELERATION          UNIT: CM/SEC/SEC
    NO. OF POINTS:  12800  EQUALLY SPACED INTERVALS OF:  0.005  SEC
    PEAK VALUE:    -16.986   AT   27.06 SEC    DURATION:  64 SEC

Reference: the header of the files itself.
"""

from __future__ import annotations

import re
from typing import Final

from rockframe.records.checks import (
    check_asked_time_step,
    check_time_step,
    compare_length,
    compare_peak,
    settle_count,
)
from rockframe.records.components import UNKNOWN, FileComponent, choose_component, orientation_of
from rockframe.records.numbers import (
    NUMBER,
    ends_inside_number,
    free_format,
    last_fields,
    one_number,
)
from rockframe.records.record_file import Metadata, Record, Request, Source, quoted_first_line
from rockframe.records.unit_names import choose_unit

NAME: Final = "csmnc"
TITLE: Final = "file of the China Strong Motion Networks Centre"
SUFFIXES: Final = (".dat",)

_KIND: Final = re.compile(
    r"^\s*(?:UN)?(?:CORRECTED|PROCESSED) (ACCELERATION|VELOCITY|DISPLACEMENT)\s+UNIT:\s*(\S{1,20})",
    re.IGNORECASE,
)
_POINTS: Final = re.compile(
    rf"^\s*NO\. OF POINTS:\s*(\d{{1,9}})\s+EQUALLY SPACED INTERVALS OF:\s*({NUMBER})\s*SEC",
    re.IGNORECASE | re.ASCII,
)
_PEAK: Final = re.compile(rf"^\s*PEAK VALUE:\s*({NUMBER})", re.IGNORECASE | re.ASCII)
_LENGTH: Final = re.compile(rf"\bDURATION:\s*({NUMBER})\s*SEC", re.IGNORECASE | re.ASCII)
_COMPONENT: Final = re.compile(r"^\s*COMP\.?\s*(\S{1,12})", re.IGNORECASE)
_STATION: Final = re.compile(r"^\s*STATION:\s*(\S{1,12})", re.IGNORECASE)
_TIME: Final = re.compile(r"\b(\d{4}-\d{1,2}-\d{1,2} \d{1,2}:\d{2}:[\d.]{2,8}(?: [A-Z]{2,4})?)")
_NUMBERS: Final = re.compile(r"[-+.\dEeDd\s]*\d[-+.\dEeDd\s]*", re.ASCII)
_LONGEST_HEADER: Final = 40


def recognises(source: Source) -> bool:
    """Tell whether the lines with the kind and with the number of points stand near the top."""
    top = source.top(_LONGEST_HEADER)
    return any(map(_KIND.match, top)) and any(map(_POINTS.match, top))


def read(source: Source, request: Request) -> Record:
    """Read an acceleration."""
    top = source.top(_LONGEST_HEADER)
    kind, kind_line = _found(source, _KIND, "UNCORRECTED ACCELERATION   UNIT: CM/SEC/SEC")
    points, line = _found(source, _POINTS, "NO. OF POINTS: 12800 EQUALLY SPACED INTERVALS OF: ...")
    if kind.group(1).upper() != "ACCELERATION":
        found = f"a {kind.group(1).lower()}"
        raise source.refuse(found=found, expected="an acceleration", line=kind_line)
    time_step = one_number(points.group(2), source, line)
    check_time_step(source, time_step, line)
    check_asked_time_step(source, request, time_step, line)
    unit, as_read, warnings = choose_unit(source, request, kind.group(2), kind_line)
    first = next(
        (k for k in range(line, len(top)) if _NUMBERS.fullmatch(top[k])),
        len(top),
    )
    metadata: Metadata = {**_description(top), "unit_as_read": as_read}
    name, name_line = next(
        ((match.group(1), k) for k, text in enumerate(top, 1) if (match := _COMPONENT.match(text))),
        (None, None),
    )

    def samples() -> Record:
        values = free_format(source, first)
        if ends_inside_number(source, last_fields(source, first)):
            found = f"the end of the file inside a number ({values.size} samples)"
            raise source.refuse(found=found, expected="a complete file", line=source.last_line)
        counts, said = settle_count(
            source,
            declared=int(points.group(1)),
            counted=int(values.size),
            what="NO. OF POINTS",
            line=line,
        )
        for place, text in enumerate(top, start=1):
            peak, length = _PEAK.match(text), _LENGTH.search(text)
            if peak is not None:
                said += compare_peak(
                    source,
                    values,
                    unit,
                    printed=peak.group(1),
                    printed_unit=kind.group(2),
                    line=place,
                )
            if length is not None:
                said += compare_length(
                    source, values.size, time_step, printed=length.group(1), line=place
                )
        return Record(time_step, values, unit, {**metadata, **counts}, warnings=(*warnings, *said))

    direction = UNKNOWN if name is None else orientation_of(name)
    component = FileComponent(name, samples, direction, line=name_line)
    return choose_component(source, request, [component])


def _found(source: Source, pattern: re.Pattern[str], such_as: str) -> tuple[re.Match[str], int]:
    for line, text in enumerate(source.top(_LONGEST_HEADER), start=1):
        match = pattern.match(text)
        if match is not None:
            return match, line
    found = f"no such line below {quoted_first_line(source.start)}"
    raise source.refuse(found=found, expected=f"a line such as {such_as!r}", line=1)


def _description(top: list[str]) -> Metadata:
    metadata: Metadata = {}
    if len(top) > 2 and re.search("[A-Za-z]", top[2]):
        metadata["event"] = top[2].strip()
    time = _TIME.search(top[1]) if len(top) > 1 else None
    if time is not None:
        metadata["event_time"] = time.group(1)
    for text in top:
        station = _STATION.match(text)
        start = _TIME.search(text) if "RECORDER TIME" in text.upper() else None
        if station is not None:
            metadata["station"] = station.group(1)
        if start is not None:
            metadata["record_time"] = start.group(1)
        if _KIND.match(text):
            metadata["description"] = text.split("UNIT")[0].strip().lower()
    return metadata
