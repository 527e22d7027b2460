"""Files of RESORCE and SIGMA (``.cor.acc``): lines ``KEY : value``, then five numbers in a line.

The numbers fill their width, so that they run together where they are negative::

    Time Increment (s)            : 0.005
    Number of Data                : 12400
    PGA (m/s/s)                   : 1.0022000E-02
    Accelaration time series in m/s/s
     4.1965000E-05 4.1963000E-05 4.1971000E-05 4.1993000E-05 4.2032000E-05

Reference: the header of the files itself (the spelling of "acceleration" is theirs).
"""

from __future__ import annotations

import re
from typing import Final

from rockframe.records.checks import compare_peak, surplus
from rockframe.records.components import FileComponent, choose_component, orientation_of
from rockframe.records.keys import kept, needed_count, needed_step, read_keys
from rockframe.records.numbers import fixed_width
from rockframe.records.record_file import Metadata, Record, Request, Source, quoted_first_line
from rockframe.records.unit_names import choose_unit

NAME: Final = "resorce"
TITLE: Final = "RESORCE file (.cor.acc)"
SUFFIXES: Final = (".acc",)

_STEP: Final = "Time Increment (s)"
_COUNT: Final = "Number of Data"
_SERIES: Final = re.compile(r"^\s*acc?el\w{3,10} time series in (\S{1,20})", re.IGNORECASE)
_PEAK: Final = re.compile(r"^PGA \((\S{1,20})\)$", re.IGNORECASE)
_LONGEST_HEADER: Final = 40
_LAYOUT: Final = {"width": 14, "per_line": 5}
_KEPT: Final = {
    "Event Date & Time": "event_time",
    "Network": "network",
    "Processing Info": "processing",
}


def recognises(source: Source) -> bool:
    """Tell whether the keys that the format needs stand near the top."""
    return {_STEP, _COUNT} <= set(read_keys(source.top(_LONGEST_HEADER)))


def read(source: Source, request: Request) -> Record:
    """Read an acceleration."""
    header = read_keys(source.top(_LONGEST_HEADER))
    time_step = needed_step(source, request, header, _STEP)
    count, _ = needed_count(source, header, _COUNT)
    unit_name, line = _series(source)
    unit, as_read, warnings = choose_unit(source, request, unit_name, line)
    metadata: Metadata = {**kept(header, _KEPT), "unit_as_read": as_read}
    code, _, place = header.get("Station Code / Name", ("", 0))[0].partition("/")
    if code.strip():
        metadata["station"] = code.strip()
    if place.strip():
        metadata["station_name"] = place.strip()
    if "event_time" in metadata:
        metadata["event"] = f"earthquake of {metadata['event_time']}"
    name, name_line = header.get("Orientation", ("", 0))

    def samples() -> Record:
        values = fixed_width(source, line, count, **_LAYOUT)
        said = [*warnings, *surplus(source, line + -(-count // _LAYOUT["per_line"]), _COUNT)]
        for key, (printed, peak_line) in header.items():
            match = _PEAK.match(key)
            if match is not None:
                said += compare_peak(
                    source,
                    values,
                    unit,
                    printed=printed,
                    printed_unit=match.group(1),
                    line=peak_line,
                )
        return Record(time_step, values, unit, metadata, warnings=tuple(said))

    component = FileComponent(name or None, samples, orientation_of(name), line=name_line or None)
    return choose_component(source, request, [component])


def _series(source: Source) -> tuple[str, int]:
    for line, text in enumerate(source.top(_LONGEST_HEADER), start=1):
        match = _SERIES.match(text)
        if match is not None:
            return match.group(1), line
    found = f"no line with the unit below {quoted_first_line(source.start)}"
    expected = "'Accelaration time series in m/s/s' above the numbers"
    raise source.refuse(found=found, expected=expected, line=1)
