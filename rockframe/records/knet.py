"""K-NET and KiK-net ASCII files: 17 header lines, then counts, eight in a line.

An acceleration is a count times the scale factor, ``3920(gal)/6182761``, less the offset of the
instrument. The mean of the whole record is subtracted, as NIED does for the peak in line 15. Times
are Japan Standard Time. The record time in line 10 is 15 s late, by the delay of the trigger. A
KiK-net direction is a number: 1 to 3 for the sensor in the borehole, 4 to 6 for that at the surface
(NS, EW, UD).

Reference: National Research Institute for Earth Science and Disaster Resilience
(NIED), "About K-NET ASCII format" and "KiK-net data format".
"""

import math
import re
from datetime import datetime, timedelta
from typing import Final

import numpy as np

from rockframe.records.checks import checked_count
from rockframe.records.components import FileComponent, choose_component, orientation_of
from rockframe.records.headers import (
    Keys,
    required_rate,
    required_value,
    value_or_empty,
    without_empty_values,
)
from rockframe.records.numbers import (
    NUMBER,
    cut_off_error,
    free_format,
    last_fields,
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
from rockframe.signals.arrays import Array

UNIT: Final = "gal"

_KEYS: Final = (
    "Origin Time",
    "Station Code",
    "Record Time",
    "Sampling Freq(Hz)",
    "Duration Time(s)",
    "Dir.",
    "Scale Factor",
    "Max. Acc. (gal)",
    "Max Acc. (gal)",
    "Memo.",
)
_HEADER_LINES: Final = 24
_SCALE: Final = re.compile(rf"({NUMBER})\s*\(gal\)\s*/\s*({NUMBER})", re.ASCII)
_KIK_NET: Final = {
    "1": ("NS1", "borehole"),
    "2": ("EW1", "borehole"),
    "3": ("UD1", "borehole"),
    "4": ("NS2", "surface"),
    "5": ("EW2", "surface"),
    "6": ("UD2", "surface"),
}
_PRINTED_TIME: Final = "%Y/%m/%d %H:%M:%S"
_ZONE: Final = "+09:00"
_DELAY: Final = timedelta(seconds=15)
_PER_LINE: Final = 8
_PEAK_TOLERANCE: Final = 0.01
_PEAK_DIGIT: Final = 1e-3


def _recognises(source: Source) -> bool:
    keys = set(_header(source)[0])
    return {"Scale Factor", "Sampling Freq(Hz)"} <= keys


def _read(source: Source, request: Request) -> Record:
    header, first = _header(source)
    rate = required_rate(source, request, header, "Sampling Freq(Hz)")
    scale = _scale(source, header)
    unit, as_read, warnings = choose_unit(source, request, UNIT, header["Scale Factor"][1])
    metadata = {**_description(header), "unit_as_read": as_read}
    direction, line = required_value(source, header, "Dir.")
    name, place = _KIK_NET.get(direction, (direction, ""))
    if place:
        metadata["sensor_location"] = place

    def samples() -> Record:
        counts, held, differing = _counts(source, header, first, rate)
        offset = math.fsum(counts) / counts.size
        values = (counts - offset) * scale
        words = _compare_peak(source, header, values)
        described: Metadata = {**metadata, **held, "gal_per_count": scale, "offset_removed": offset}
        history = (
            f"counts times the scale factor {header['Scale Factor'][0]}, "
            f"less their mean of {offset:.9g} counts ({offset * scale:.6g} gal)",
        )
        messages = (*warnings, *differing, *words)
        return Record(1.0 / rate, values, unit, described, history, messages)

    component = FileComponent(
        name,
        samples,
        orientation_of(name.rstrip("12") if place else name),
        channel=int(direction) if place else None,
        aliases=(direction,),
        line=line,
    )
    return choose_component(source, request, [component])


def _header(source: Source) -> tuple[Keys, int]:
    header: Keys = {}
    for line, text in enumerate(source.top(_HEADER_LINES), start=1):
        for key in _KEYS:
            if text.startswith(key):
                header.setdefault(key, (text[len(key) :].strip(), line))
        if text.startswith("Memo."):
            return header, line
    return header, 17


def _scale(source: Source, header: Keys) -> float:
    text, line = required_value(source, header, "Scale Factor")
    match = _SCALE.fullmatch(text)
    if match is not None:
        over, under = (required_number(part, source, line) for part in match.groups())
        if under > 0.0 and over > 0.0 and math.isfinite(over / under):
            return over / under
    found = f"a scale factor of {quoted_first_line(text)}"
    expected = "a ratio above zero such as 3920(gal)/6182761"
    raise source.refuse(found=found, expected=expected, line=line)


def _counts(
    source: Source, header: Keys, first: int, rate: float
) -> tuple[Array, Metadata, list[str]]:
    counts = free_format(source, first)
    fractions = np.flatnonzero(counts != np.round(counts))
    if fractions.size:
        found = f"{counts[fractions[0]]:.9g} as sample {int(fractions[0]) + 1}"
        line = first + int(fractions[0]) // _PER_LINE + 1
        raise source.refuse(found=found, expected="counts, which are whole numbers", line=line)
    duration, line = required_value(source, header, "Duration Time(s)")
    announced = required_number(duration, source, line) * rate
    if not 0.0 < announced < 1e12:
        found = f"a duration of {quoted_first_line(duration)} s"
        raise source.refuse(found=found, expected="a length above zero", line=line)
    declared = round(announced)
    lengths, differing = checked_count(
        source, declared=declared, counted=int(counts.size), what="Duration Time", line=line
    )
    fields = last_fields(source, first)
    open_end = bool(source.lines[-1]) and not source.lines[-1][-1].isspace()
    # a truncated whole number can only be recognised by its length
    if (
        open_end
        and counts.size <= declared
        and len(fields[-1]) < min(map(len, fields[:-1]), default=0)
    ):
        raise cut_off_error(source, f"{counts.size} of {declared} samples")
    return counts, lengths, differing


def _compare_peak(source: Source, header: Keys, values: Array) -> list[str]:
    printed, line = header.get("Max. Acc. (gal)", header.get("Max Acc. (gal)", ("", 1)))
    if not printed:
        return []
    stated, peak = required_number(printed, source, line), float(np.max(np.abs(values)))
    if abs(peak - stated) <= _PEAK_TOLERANCE * abs(stated) + _PEAK_DIGIT:
        return []
    return [
        f"{source.path}, line {line}: the header gives a peak of {stated:g} gal, but the samples "
        f"less their mean have {peak:.6g} gal"
    ]


def _description(header: Keys) -> Metadata:
    origin, recorded = value_or_empty(header, "Origin Time"), value_or_empty(header, "Record Time")
    described = {
        "station": value_or_empty(header, "Station Code"),
        "event": origin and f"earthquake of {origin} JST",
        "event_time": origin and (_iso(origin) or f"{origin} JST"),
        "record_time": recorded and (_iso(recorded, _DELAY) or f"{recorded} JST, less 15 s"),
    }
    return without_empty_values(described)


def _iso(printed: str, delay: timedelta = timedelta(0)) -> str | None:
    try:
        moment = datetime.strptime(printed, _PRINTED_TIME) - delay
    except (ValueError, OverflowError):
        return None
    return moment.isoformat() + _ZONE


KNET: Final = Format(
    "k-net",
    "K-NET or KiK-net file (ASCII)",
    (
        *(".ns", ".ew", ".ud"),
        *(".ns1", ".ew1", ".ud1", ".ns2", ".ew2", ".ud2"),
    ),
    _recognises,
    _read,
    holds="one",
    unit="gal per count, in the header",
)
