"""SAC: a header of 632 bytes, then the samples as 32-bit floats, in either byte order.

The header has 70 floats, 40 integers and 192 characters; -12345 marks an unknown value. It has no
field for the unit. Integer 17 (IDEP) may state that the samples are accelerations, by the manual in
nm/s^2, but few files follow this. The unit comes from the argument ``unit``, or, for counts, from
StationXML.

The header is simple enough to be read here, so that no other package is needed.

Reference: Incorporated Research Institutions for Seismology, "SAC User's Manual", SAC
Data File Format, header versions 6 and 7.
"""

import math
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from typing import Final

import numpy as np

from rockframe.records.checks import checked_time_step
from rockframe.records.components import (
    DOWNWARDS,
    UPWARDS,
    FileComponent,
    Orientation,
    azimuth_of,
    choose_component,
    orientation_of,
)
from rockframe.records.headers import without_empty_values
from rockframe.records.instruments import (
    InstrumentResponses,
    check_finite,
    check_unit_or_response,
    location_code,
    record_from_counts,
)
from rockframe.records.reader import (
    MAXIMUM_SAMPLES,
    Format,
    Metadata,
    Record,
    Request,
    Source,
    wrong_beginning_error,
)
from rockframe.signals.arrays import Array

_FLOATS: Final = 70
_INTEGERS: Final = 40
_HEADER: Final = 632
_TEXT: Final = 440
_SAMPLE: Final = 4
_UNKNOWN: Final = -12345
_VERSIONS: Final = (6, 7)
_FOOTER: Final = 176  # footer of version 7: 22 doubles [byte]
_MAX_TIME_STEP: Final = 1e4
_TIME_SERIES: Final = 1
_KINDS: Final = {6: "a displacement", 7: "a velocity", 50: "volts"}
_LEVEL: Final = 5.0
_AGREEMENT: Final = 1e-3
_EXPECTED: Final = "a SAC file of evenly spaced samples"
_MISSING: Final = (
    "samples without a unit, of which SAC has none",
    "the argument unit, for example unit='m/s^2', or, of counts, StationXML",
)

# places in the header, from 0: floats, integers, and words of 8 characters
_DELTA, _SMALLEST, _LARGEST, _BEGIN, _END = 0, 1, 2, 5, 6
_AZIMUTH, _INCIDENCE = 57, 58
_VERSION, _POINTS, _TYPE, _KIND, _EVEN = 6, 9, 15, 16, 35
_STATION, _EVENT, _LOCATION, _COMPONENT, _NETWORK = 0, 1, 3, 20, 21


@dataclass(frozen=True)
class _Header:
    """The header in the byte order of the file."""

    order: str
    floats: Array
    integers: Array
    text: bytes

    def known(self, place: int) -> float | None:
        """Return a float, or None if it is not known."""
        value = float(self.floats[place])
        return None if not math.isfinite(value) or math.isclose(value, _UNKNOWN) else value

    def word(self, place: int, count: int = 1) -> str:
        """Return a text of some words of 8 characters, up to its first zero; empty if unknown."""
        data = self.text[8 * place : 8 * (place + count)].split(b"\x00")[0]
        text = "".join(c for c in data.decode("latin-1") if c.isprintable()).strip()
        return "" if set(text.split()) <= {str(_UNKNOWN)} else text


def _recognises(source: Source) -> bool:
    return _header(source) is not None


def _read(source: Source, request: Request) -> Record:
    header = _header(source)
    if header is None:
        raise wrong_beginning_error(source, _EXPECTED)
    check_unit_or_response(source, request)
    kind, series = int(header.integers[_KIND]), int(header.integers[_TYPE])
    if series not in (_TIME_SERIES, _UNKNOWN) or header.integers[_EVEN] == 0:
        found = "a spectrum, or samples that are not evenly spaced"
        raise source.refuse(found=found, expected=_EXPECTED)
    if kind in _KINDS:
        raise source.refuse(found=f"{_KINDS[kind]} (IDEP {kind})", expected="an acceleration")
    name = header.word(_COMPONENT) or None

    def samples() -> Record:
        return _samples(source, request, header, name or "")

    component = FileComponent(name, samples, _orientation(header, name or ""))
    return choose_component(source, request, [component])


def _header(source: Source) -> _Header | None:
    data = source.data
    if len(data) < _HEADER:
        return None
    for order in "<>":
        integers = np.frombuffer(data, f"{order}i4", _INTEGERS, 4 * _FLOATS)
        if integers[_VERSION] not in _VERSIONS or integers[_EVEN] not in (0, 1):
            continue
        with np.errstate(invalid="ignore"):  # the bytes may be arbitrary
            floats = np.frombuffer(data, f"{order}f4", _FLOATS).astype(np.float64)
        if integers[_POINTS] > 0 and 0.0 < floats[_DELTA] < _MAX_TIME_STEP:
            return _Header(order, floats, integers, data[_TEXT:_HEADER])
    return None


def _samples(source: Source, request: Request, header: _Header, name: str) -> Record:
    count = int(header.integers[_POINTS])
    held = (len(source.data) - _HEADER) // _SAMPLE
    if not 2 <= count <= MAXIMUM_SAMPLES:
        expected = f"2 to {MAXIMUM_SAMPLES} samples"
        raise source.refuse(found=f"{count} samples announced", expected=expected)
    if held < count:
        found = f"the end of the file after {held} samples"
        raise source.refuse(found=found, expected=f"{count} samples")
    # 7 digits recover the decimal step from which the 32-bit float was made
    time_step = float(f"{header.floats[_DELTA]:.7g}")
    checked_time_step(source, request, time_step, None)
    with np.errstate(invalid="ignore"):
        values = np.frombuffer(source.data, f"{header.order}f4", count, _HEADER).astype(np.float64)
    check_finite(source, values)
    metadata, start = _description(header)
    response = None
    if request.unit is None and start is not None:
        codes = (header.word(_NETWORK), header.word(_STATION), header.word(_LOCATION), name)
        response = InstrumentResponses(source, request).find(".".join(codes), start)
    record = record_from_counts(source, request, values, time_step, metadata, response, _MISSING)
    return replace(record, warnings=tuple(_header_warnings(source, header, values, time_step)))


def _header_warnings(source: Source, header: _Header, values: Array, time_step: float) -> list[str]:
    doubts: list[str] = []
    stated = [header.known(place) for place in (_SMALLEST, _LARGEST)]
    size = float(np.max(np.abs(values)))
    for what, printed, is_there in zip(
        ("smallest", "largest"), stated, (values.min(), values.max()), strict=True
    ):
        if printed is not None and abs(printed - is_there) > _AGREEMENT * size:
            doubts.append(
                f"{source.path}: the header states {printed:.6g} as the {what} sample, but the "
                f"samples have {is_there:.6g}"
            )
    surplus = len(source.data) - _HEADER - _SAMPLE * values.size
    if surplus not in (0, _FOOTER):
        doubts.append(f"{source.path}: {surplus} bytes after the last sample are not read")
    begin, end = header.known(_BEGIN), header.known(_END)
    if begin is not None and end is not None:
        length = (values.size - 1) * time_step
        if abs(end - begin - length) > 2.0 * time_step + _AGREEMENT * length:
            doubts.append(
                f"{source.path}: the header states a length of {end - begin:.6g} s, but "
                f"{values.size} samples at {time_step:g} s last {length:.6g} s"
            )
    return doubts


def _orientation(header: _Header, name: str) -> Orientation:
    azimuth, incidence = header.known(_AZIMUTH), header.known(_INCIDENCE)
    if incidence is not None and abs(incidence) <= _LEVEL:
        return Orientation(vertical=UPWARDS)
    if incidence is not None and abs(incidence - 180.0) <= _LEVEL:
        return Orientation(vertical=DOWNWARDS)
    if incidence is not None and azimuth is not None and abs(incidence - 90.0) <= _LEVEL:
        return azimuth_of(azimuth % 360.0 if azimuth < 0.0 else azimuth)
    return orientation_of(name)


def _description(header: _Header) -> tuple[Metadata, datetime | None]:
    words = {
        "network": header.word(_NETWORK),
        "station": header.word(_STATION),
        "sensor_location": location_code(header.word(_LOCATION)),
        "event": header.word(_EVENT, 2),
    }
    metadata = without_empty_values(words)
    year, day, hour, minute, second, thousandth = (int(n) for n in header.integers[:6])
    try:
        reference = datetime(year, 1, 1, tzinfo=UTC).replace(tzinfo=None)
        start = reference + timedelta(
            days=day - 1,
            hours=hour,
            minutes=minute,
            seconds=second + (header.known(_BEGIN) or 0.0),
            milliseconds=thousandth,
        )
    except (ValueError, OverflowError):
        return metadata, None
    if _UNKNOWN in (day, hour, minute, second):
        return metadata, None
    metadata["record_time"] = f"{start.isoformat()}Z"
    return metadata, start


SAC: Final = Format(
    "sac",
    "SAC file (binary)",
    (".sac",),
    _recognises,
    _read,
    binary=True,
    holds="one",
    unit="unit, or counts",
)
