"""ASDF, the Adaptable Seismic Data Format, as gmprocess writes it: waveforms in HDF5.

Under ``Waveforms/NET.STA`` each piece of a channel is an array called
``NET.STA.LOC.CHA__start__end__tag`` with its sampling rate and its start in nanoseconds since
1970. The tag ends in the label of the processing, or in ``unprocessed``. The format has no field
for a unit; gmprocess states it in ``AuxiliaryData/StreamSupplementalStats``. Counts are converted
to accelerations by the StationXML in the file, or by a given one.

The arrays are read through netCDF4, which is installed in any case.

Reference: L. Krischer et al., "An Adaptable Seismic Data Format", Geophysical Journal
International 207(2), 2016; U.S. Geological Survey, gmprocess, "Workspace".
"""

import json
import math
import re
from collections import Counter
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Any, Final, cast

import numpy as np

from rockframe.records.checks import checked_time_step
from rockframe.records.components import FileComponent, choose_component, orientation_of
from rockframe.records.instruments import (
    InstrumentResponse,
    InstrumentResponses,
    check_finite,
    check_unit_or_response,
    find_response,
    metadata_of_codes,
    record_from_counts,
    stated_unit,
)
from rockframe.records.reader import (
    MAXIMUM_SAMPLES,
    Format,
    Metadata,
    Record,
    Request,
    Source,
    choose_unit,
    damaged_file_errors,
    source_of,
    wrong_beginning_error,
)
from rockframe.signals.arrays import Array

_MAGIC: Final = b"\x89HDF\r\n\x1a\n"
_MARKS: Final = (b"Waveforms", b"file_format")
_NODES: Final = {b"SNOD": 4, b"OHDR": 1}  # marks of nodes, and the approximate objects in each
_MAX_OBJECTS: Final = 5_500
_WAVEFORM: Final = re.compile(
    r"(\w{1,8}\.\w{1,8}\.[\w-]{0,8}\.\w{1,8})__([\dT:.Z-]{10,40})__([\dT:.Z-]{10,40})__(\S{1,80})"
)
_STATISTICS: Final = "StreamSupplementalStats"
_LARGEST_TEXT: Final = 4 * 2**20
_COUNTS: Final = re.compile(r"counts?\b", re.IGNORECASE)
_KIND: Final = "an HDF5 file"
_EXPECTED: Final = "an ASDF file with waveforms"
_EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC).replace(tzinfo=None)


@dataclass(frozen=True)
class _Waveform:
    """One array of the file: its name, codes, tag and group."""

    name: str
    codes: str
    tag: str
    group: str

    @property
    def channel(self) -> str:
        """The last of the codes."""
        return self.codes.rpartition(".")[2]


def _recognises(source: Source) -> bool:
    return source.data.startswith(_MAGIC) and all(mark in source.data for mark in _MARKS)


def _read(source: Source, request: Request) -> Record:
    if not _recognises(source):
        raise wrong_beginning_error(source, _EXPECTED)
    check_unit_or_response(source, request)
    objects = sum(source.data.count(mark) * per_node for mark, per_node in _NODES.items())
    if objects > _MAX_OBJECTS:
        found = f"about {objects} groups and arrays"
        expected = f"at most {_MAX_OBJECTS}; open larger files with pyasdf and use from_trace"
        raise source.refuse(found=found, expected=expected)
    import netCDF4

    with damaged_file_errors(source, _KIND, _EXPECTED):
        # the file stays open, as components are read one by one
        file = netCDF4.Dataset("asdf", memory=source.data)
        file.set_auto_maskandscale(False)
        components = _components(source, request, file)
    return choose_component(source, request, components)


def _components(source: Source, request: Request, file: Any) -> list[FileComponent]:
    waveforms = [
        _Waveform(name, match.group(1), match.group(4), station)
        for station, group in file.groups["Waveforms"].groups.items()
        for name in group.variables
        if (match := _WAVEFORM.fullmatch(name)) is not None
    ]
    if not waveforms:
        raise source.refuse(found="no waveforms", expected=_EXPECTED)
    stations = {waveform.group for waveform in waveforms}
    tags = {waveform.tag for waveform in waveforms}

    pieces = Counter((waveform.codes, waveform.tag) for waveform in waveforms)

    def component(waveform: _Waveform) -> FileComponent:
        short = waveform.channel if len(stations) == 1 else waveform.codes

        def samples() -> Record:
            count = pieces[waveform.codes, waveform.tag]
            if request.every and count > 1:  # asked for by its whole name a piece is read
                found = f"{count} pieces of {waveform.codes} {waveform.tag}"
                raise source.refuse(found=found, expected="a channel without gaps")
            with damaged_file_errors(source, _KIND, _EXPECTED):
                return _samples(source, request, file, waveform)

        return FileComponent(
            short if len(tags) == 1 else f"{short} {waveform.tag}",
            samples,
            orientation_of(waveform.channel),
            aliases=(
                waveform.name,
                waveform.codes,
                waveform.channel,
                f"{waveform.codes} {waveform.tag}",
            ),
        )

    return [component(waveform) for waveform in waveforms]


def _samples(source: Source, request: Request, file: Any, waveform: _Waveform) -> Record:
    variable = file.groups["Waveforms"].groups[waveform.group].variables[waveform.name]
    values = _values(source, waveform, variable)
    rate = float(variable.getncattr("sampling_rate"))
    if not (math.isfinite(rate) and rate > 0.0):
        found = f"a sampling rate of {rate!r} Hz for {waveform.name}"
        raise source.refuse(found=found, expected="one above zero")
    time_step = float(f"{1.0 / rate:.12g}")
    checked_time_step(source, request, time_step, None)
    start = _EPOCH + timedelta(microseconds=int(variable.getncattr("starttime")) // 1000)
    metadata: Metadata = {
        **metadata_of_codes(waveform.codes),
        "processing": waveform.tag,
        "record_time": f"{start.isoformat()}Z",
    }
    stated = None if request.unit is not None else _stated_unit(file, waveform)
    if stated is not None and _COUNTS.search(stated) is None:
        unit, as_read, _ = choose_unit(source, request, stated, None)
        metadata["unit_as_read"] = as_read
        return Record(time_step, values, unit, metadata)
    response = (
        None if request.unit is not None else _response(source, request, file, waveform, start)
    )
    missing = (
        f"no unit of {waveform.name}, and no response of the instrument",
        "the argument unit, which is 'cm/s^2' for what gmprocess has processed, or StationXML, "
        "for counts",
    )
    return record_from_counts(source, request, values, time_step, metadata, response, missing)


def _values(source: Source, waveform: _Waveform, variable: Any) -> Array:
    count, *more = map(int, variable.shape)
    kind = variable.datatype
    if more or not 2 <= count <= MAXIMUM_SAMPLES:
        expected = f"2 to {MAXIMUM_SAMPLES} samples in a row"
        raise source.refuse(
            found=f"{waveform.name} of the shape {variable.shape}", expected=expected
        )
    if not isinstance(kind, np.dtype) or cast("np.dtype[Any]", kind).kind not in "fiu":
        raise source.refuse(
            found=f"{waveform.name} without numbers", expected="whole or real numbers"
        )
    values = np.asarray(variable[:], dtype=np.float64)
    check_finite(source, values)
    return values


def _stated_unit(file: Any, waveform: _Waveform) -> str | None:
    """Find the unit that gmprocess states for a stream; None if there is none."""
    groups = file.groups.get("AuxiliaryData")
    for name in (_STATISTICS, waveform.group):
        groups = None if groups is None else groups.groups.get(name)
    if groups is None:
        return None
    # the channels of a stream have the same tag, and codes that differ in the last letter
    start = f"{waveform.codes[:-1]}_{waveform.tag}"
    text = _text_in(groups, start)
    if text is None:
        return None
    try:
        stated: Any = json.loads(text.decode("utf-8", "replace"))
    except (ValueError, RecursionError):
        return None
    return stated_unit(stated.get("standard")) if isinstance(stated, dict) else None


def _response(
    source: Source, request: Request, file: Any, waveform: _Waveform, start: datetime
) -> InstrumentResponse | None:
    if request.response is not None:
        return InstrumentResponses(source, request).find(waveform.codes, start)
    xml = _text_in(file.groups["Waveforms"].groups[waveform.group], "StationXML")
    return (
        None if xml is None else find_response(source_of(source.path, xml), waveform.codes, start)
    )


def _text_in(group: Any, name: str) -> bytes | None:
    """Return a text that is stored as an array of bytes; None if it is missing or too long."""
    variable = group.variables.get(name)
    if variable is None or math.prod(map(int, variable.shape)) > _LARGEST_TEXT:
        return None
    return np.asarray(variable[:]).astype(np.uint8).tobytes()


ASDF: Final = Format(
    "asdf",
    "ASDF file (HDF5), as of gmprocess",
    (".h5", ".asdf"),
    _recognises,
    _read,
    binary=True,
    holds="any number",
    unit="stated by gmprocess, or counts",
)
