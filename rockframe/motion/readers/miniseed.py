"""miniSEED, through ObsPy: counts, made accelerations by the response of the instrument.

The counts are divided by the overall sensitivity of an accelerometer (StationXML,
``InstrumentSensitivity``, input unit M/S**2), after their mean is subtracted: the
response is taken as flat, which it is from zero to near the corner of the instrument.
A seismometer, whose sensitivity is to velocity, is refused.

References: Federation of Digital Seismograph Networks, "SEED Reference Manual",
version 2.4, and "FDSN StationXML". ObsPy is imported only here, when such a file is
read.
"""

from __future__ import annotations

import importlib
import io
import math
import re
import warnings
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from rockframe.errors import RecordError
from rockframe.motion.readers.checks import (
    check_asked_time_step,
    check_time_step,
)
from rockframe.motion.readers.components import Component, choose_component
from rockframe.motion.readers.orientation import UNKNOWN, Orientation, orientation_of
from rockframe.motion.readers.source import (
    MAXIMUM_SAMPLES,
    Metadata,
    Record,
    Request,
    Source,
)
from rockframe.motion.readers.station_xml import Response, Responses

if TYPE_CHECKING:
    from rockframe.signals.arrays import Array

NAME: Final = "miniseed"
TITLE: Final = "miniSEED file (through ObsPy)"
SUFFIXES: Final = (".mseed", ".miniseed", ".ms", ".seed")
BINARY: Final = True

# sequence number, kind, then the codes of station, location, channel and network
_RECORD: Final = re.compile(rb"[0-9 ]{6}[DRQM][ \x00]([A-Z0-9 ]{12})")
_SHORTEST_RECORD: Final = 128
_VERSION_3: Final = b"MS\x03"
_INSTALL: Final = "ObsPy to read miniSEED; install it with: pip install 'rockframe[records]'"
_EXPECTED: Final = "miniSEED records that are complete"
_MOST_SAMPLES_IN_ALL: Final = 4_000_000
_MOST_TRACES: Final = 2_000
_MOST_CHANNELS: Final = 1_000


def recognises(source: Source) -> bool:
    """Tell whether the file begins with the header of a data record."""
    data = source.data
    return _RECORD.match(data) is not None or data.startswith(_VERSION_3)


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
        ObsPy is not installed, the file is damaged or has gaps, or there is
        neither a response nor a unit.
    """
    if not recognises(source):
        found = f"a file that begins with {source.data[:8]!r}"
        raise source.refuse(found=found, expected=_EXPECTED)
    if request.unit is not None and request.response is not None:
        found = "the arguments unit and response"
        raise source.refuse(found=found, expected="one of them: accelerations, or counts")
    channels = _channels(source)
    responses = None if request.unit is not None else Responses(source, request)
    stations = {name.rsplit(".", 2)[0] for name in channels}
    components = [
        _component(source, request, name, traces, responses, several=len(stations) > 1)
        for name, traces in channels.items()
    ]
    return choose_component(source, request, components)


def _obspy(source: Source) -> Any:
    """Import ObsPy, or say how to get it.

    Parameters
    ----------
    source : Source
        File, for the message.

    Returns
    -------
    module
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return importlib.import_module("obspy")
    except ImportError as problem:
        found = "miniSEED, and no ObsPy in this Python"
        raise source.refuse(found=found, expected=_INSTALL) from problem


def _check_count(source: Source) -> None:
    # ObsPy takes long over many channels; records begin at multiples of the shortest one
    places = range(0, len(source.data), _SHORTEST_RECORD)
    names = {match.group(1) for at in places if (match := _RECORD.match(source.data, at))}
    if len(names) > _MOST_CHANNELS:
        expected = f"at most {_MOST_CHANNELS} in a file"
        raise source.refuse(found=f"{len(names)} channels", expected=expected)


def _channels(source: Source) -> dict[str, list[Any]]:
    obspy = _obspy(source)
    _check_count(source)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            # the headers first: they may announce more than fits in memory
            announced = obspy.read(io.BytesIO(source.data), format="MSEED", headonly=True)
            total = sum(int(trace.stats.npts) for trace in announced)
            if total > _MOST_SAMPLES_IN_ALL or len(announced) > _MOST_TRACES:
                expected = f"at most {_MOST_SAMPLES_IN_ALL} in {_MOST_TRACES} pieces"
                found = f"{total} samples in {len(announced)} pieces"
                raise source.refuse(found=found, expected=expected)
            stream = obspy.read(io.BytesIO(source.data), format="MSEED")
    except RecordError:
        raise
    except Exception as problem:
        # ObsPy and the library under it fail on damaged files in many ways
        found = f"miniSEED that cannot be read ({type(problem).__name__})"
        raise source.refuse(found=found, expected=_EXPECTED) from problem
    channels: dict[str, list[Any]] = {}
    for trace in stream:
        channels.setdefault(str(trace.id), []).append(trace)
    if not channels:
        raise source.refuse(found="no data records", expected=_EXPECTED)
    return channels


def _component(
    source: Source,
    request: Request,
    name: str,
    traces: list[Any],
    responses: Responses | None,
    *,
    several: bool,
) -> Component:
    network, station, location, channel = (*name.split("."), "", "", "", "")[:4]
    first = min(traces, key=lambda trace: trace.stats.starttime)
    response = problem = None
    if responses is not None:
        try:
            response = responses.of(name, first.stats.starttime)
        except RecordError as refusal:  # of no matter if another channel is read
            problem = refusal
    direction = UNKNOWN if response is None else response.orientation
    if direction == UNKNOWN:
        direction = orientation_of(channel) if len(channel) == 3 else Orientation()
    metadata: Metadata = {"network": network, "station": station, "location": location}

    def samples() -> Record:
        if problem is not None:
            raise problem
        return _samples(source, request, traces, response, metadata)

    return Component(name if several else channel, samples, direction, aliases=(name, channel))


def _samples(
    source: Source,
    request: Request,
    traces: list[Any],
    response: Response | None,
    metadata: Metadata,
) -> Record:
    counts, time_step, start = _joined(source, traces)
    check_time_step(source, time_step, None)
    check_asked_time_step(source, request, time_step, None)
    about: Metadata = {key: value for key, value in metadata.items() if value}
    about["record_time"] = start
    if request.unit is not None and request.unit_name is not None:
        about["unit_as_read"] = request.unit_name
        history = (f"the samples taken as accelerations in {request.unit_name}, as asked for",)
        return Record(time_step, counts, request.unit, about, history)
    if response is None:
        found = "counts, and no response of the instrument"
        expected = (
            "StationXML beside the file or as the argument response, or the argument unit if "
            "the samples are accelerations"
        )
        raise source.refuse(found=found, expected=expected)
    offset = float(math.fsum(counts) / counts.size)
    about |= {
        "unit_as_read": "counts",
        "sensitivity": response.sensitivity,
        "offset_removed": offset,
        "response_file": response.file,
        "response_sha256": response.sha256,
    }
    history = (
        f"counts less their mean of {offset:.9g}, divided by the sensitivity of "
        f"{response.sensitivity:.9g} counts per {response.unit.spelling} ({response.file}); "
        "the response of the instrument is taken as flat",
    )
    return Record(
        time_step, (counts - offset) / response.sensitivity, response.unit, about, history
    )


def _joined(source: Source, traces: list[Any]) -> tuple[Array, float, str]:
    traces = sorted(traces, key=lambda trace: trace.stats.starttime)
    first = traces[0].stats
    time_step = float(f"{float(first.delta):.12g}")
    parts: list[Array] = []
    count = 0
    for trace in traces:
        rate = float(trace.stats.sampling_rate)
        if not math.isclose(rate, float(first.sampling_rate), rel_tol=1e-6):
            found = f"sampling rates of {float(first.sampling_rate):g} Hz and {rate:g} Hz"
            raise source.refuse(found=found, expected="one sampling rate in a channel")
        shift = float(trace.stats.starttime - first.starttime) - count * time_step
        if abs(shift) > 0.5 * time_step:
            what = "gap" if shift > 0.0 else "overlap"
            found = f"a {what} of {abs(shift):.6g} s before {trace.stats.starttime}"
            raise source.refuse(found=found, expected="a channel without gaps and overlaps")
        data = np.asarray(trace.data)
        if data.ndim != 1 or data.dtype.kind not in "iuf":
            found = f"samples of the kind {data.dtype}"
            raise source.refuse(found=found, expected="whole or real numbers")
        parts.append(data.astype(np.float64))
        count += data.size
    if not 2 <= count <= MAXIMUM_SAMPLES:
        expected = f"2 to {MAXIMUM_SAMPLES} samples in a channel"
        raise source.refuse(found=f"{count} samples", expected=expected)
    counts = np.concatenate(parts)
    if not np.isfinite(counts).all():
        raise source.refuse(found="samples that are not finite", expected="finite samples")
    return counts, time_step, str(first.starttime)
