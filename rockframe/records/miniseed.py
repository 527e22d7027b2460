"""miniSEED files, through ObsPy, and traces in memory.

The mean of the counts is subtracted, and they are divided by the overall sensitivity of an
accelerometer (StationXML, ``InstrumentSensitivity``, input unit M/S**2). The response is assumed
to be flat, as it is from zero to near the corner frequency of the instrument. A seismometer, whose
sensitivity is to velocity, is refused.

References: Federation of Digital Seismograph Networks, "SEED Reference Manual",
version 2.4, and "FDSN StationXML". ObsPy is imported only here, when such a file is
read.
"""

import importlib
import io
import math
import re
import struct
import sys
import warnings
from collections.abc import Generator, Iterable
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from typing import Any, Final, NamedTuple

import numpy as np

from rockframe.errors import RecordError
from rockframe.records.checks import check_time_step, checked_time_step
from rockframe.records.components import UNKNOWN, FileComponent, choose_component, orientation_of
from rockframe.records.instruments import (
    InstrumentResponses,
    check_finite,
    check_unit_or_response,
    codes_of,
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
    wrong_beginning_error,
)
from rockframe.signals.arrays import Array

# sequence number, kind, then the codes of station, location (or --), channel and network
_RECORD: Final = re.compile(rb"[0-9 ]{6}[DRQM][ \x00]([A-Z0-9 ]{5}(?:[A-Z0-9 ]{2}|--)[A-Z0-9 ]{5})")
_SHORTEST_RECORD: Final = 128
_HEADER: Final = 48
_FIELDS: Final = "HHBBBxHHhh"  # start, number of samples, factor and multiplier of the rate
_APART: Final = 2.0  # samples; the start may be rounded, with a correction in another field
_VERSION_3: Final = b"MS\x03"
_INSTALL: Final = "ObsPy to read miniSEED; install it with: pip install 'rockframe[records]'"
_EXPECTED: Final = "miniSEED records that are complete"
_MAX_TOTAL_SAMPLES: Final = 4_000_000
_MAX_TRACES: Final = 2_000
_MAX_CHANNELS: Final = 1_000


def _recognises(source: Source) -> bool:
    data = source.data
    return _RECORD.match(data) is not None or data.startswith(_VERSION_3)


def _read(source: Source, request: Request) -> Record:
    if not _recognises(source):
        raise wrong_beginning_error(source, _EXPECTED)
    check_unit_or_response(source, request)
    channels, damage = _channels(source)
    responses = None if request.unit is not None else InstrumentResponses(source, request)
    components = [
        _component(source, request, name, label, channels[name], responses, damage)
        for name, label in _labels(channels).items()
    ]
    return choose_component(source, request, components)


def _labels(channels: Iterable[str]) -> dict[str, str]:
    """Label channels by all codes, or by the channel code alone for a single station."""
    several = len({name.rsplit(".", 2)[0] for name in channels}) > 1
    return {name: name if several else codes_of(name)[3] for name in channels}


def _obspy(source: Source) -> Any:
    """Import ObsPy; the error states how to install it."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return importlib.import_module("obspy")
    except ImportError as problem:
        found = "miniSEED, and no ObsPy in this Python"
        raise source.refuse(found=found, expected=_INSTALL) from problem


def _check_pieces(source: Source) -> None:
    """Refuse more channels or pieces than ObsPy joins in a second; only headers are read."""
    ends: dict[bytes, float] = {}
    pieces = 0
    data = source.data
    # records begin at multiples of the shortest one
    for at in range(0, len(data) - _HEADER, _SHORTEST_RECORD):
        match = _RECORD.match(data, at)
        if match is None:
            continue
        name = match.group(1)
        order = ">" if 1900 <= int.from_bytes(data[at + 20 : at + 22], "big") <= 2100 else "<"
        year, day, hour, minute, second, tenths, count, factor, multiplier = struct.unpack_from(
            order + _FIELDS, data, at + 20
        )
        start = ((year * 366.0 + day) * 24.0 + hour) * 3600.0 + minute * 60.0 + second
        start += 1e-4 * tenths
        rate = _rate(factor, multiplier)
        # the first day of a year is counted as a new piece
        pieces += name not in ends or abs(start - ends[name]) * rate > _APART
        ends[name] = start + (count / rate if rate else 0.0)
        if len(ends) > _MAX_CHANNELS:
            expected = "a file of one event or station"
            raise source.refuse(found=f"more than {_MAX_CHANNELS} channels", expected=expected)
        if pieces > _MAX_TRACES:
            expected = "channels without gaps and overlaps"
            raise source.refuse(found=f"more than {_MAX_TRACES} pieces", expected=expected)


def _rate(factor: int, multiplier: int) -> float:
    """Return the samples per second; negative numbers mean periods and divisors."""
    over = float(factor) if factor >= 0 else -1.0 / factor
    if multiplier < 0:
        return -over / multiplier
    return over * multiplier if multiplier else over


@contextmanager
def _collect_obspy_warnings() -> Generator[list[warnings.WarningMessage]]:
    """Collect the warnings of ObsPy about damaged files instead of printing them."""
    # ObsPy raises errors in callbacks of its C library. Python cannot propagate them and prints
    # them; the returned data show the damage, too
    hook = sys.unraisablehook
    sys.unraisablehook = lambda _: None
    try:
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            yield warned
    finally:
        sys.unraisablehook = hook


_MISFIT: Final = re.compile(r"(\S{1,40})_[DRQM]: .{0,20}integrity check for (\w{1,12}) failed")
_SKIPPED: Final = re.compile(r"Will skip bytes (\d{1,12}) to (\d{1,12})")


class _Damage(NamedTuple):
    """Damage that the library under ObsPy reports without an error."""

    # encoding by channel, for channels with a record whose last sample is not the stated one:
    # compressed samples are differences, so that a wrong one shifts all later samples
    misfits: dict[str, str]
    skipped: int  # number of bytes between and after records

    @classmethod
    def of(cls, messages: Iterable[warnings.WarningMessage]) -> "_Damage":
        """Read the warnings of ObsPy."""
        texts = [str(message.message) for message in messages]
        misfits = [match for text in texts if (match := _MISFIT.search(text)) is not None]
        skipped = [match for text in texts if (match := _SKIPPED.search(text)) is not None]
        return cls(
            {".".join(codes_of(match[1].replace("_", "."))): match[2] for match in misfits},
            sum(int(match[2]) - int(match[1]) + 1 for match in skipped),
        )


def _channels(source: Source) -> tuple[dict[str, list[Any]], _Damage]:
    obspy = _obspy(source)
    _check_pieces(source)
    with damaged_file_errors(source, "miniSEED", _EXPECTED), _collect_obspy_warnings() as warned:
        # the headers first: they may announce more than fits in memory
        announced = obspy.read(io.BytesIO(source.data), format="MSEED", headonly=True)
        total = sum(int(trace.stats.npts) for trace in announced)
        if total > _MAX_TOTAL_SAMPLES or len(announced) > _MAX_TRACES:
            expected = f"at most {_MAX_TOTAL_SAMPLES} in {_MAX_TRACES} pieces"
            found = f"{total} samples in {len(announced)} pieces"
            raise source.refuse(found=found, expected=expected)
        warned.clear()  # the second reading gives the same warnings
        stream = obspy.read(io.BytesIO(source.data), format="MSEED")
    channels = by_channel(stream)
    if not channels:
        raise source.refuse(found="no data records", expected=_EXPECTED)
    return channels, _Damage.of(warned)


def _component(
    source: Source,
    request: Request,
    name: str,
    label: str,
    traces: list[Any],
    responses: InstrumentResponses | None,
    damage: _Damage,
) -> FileComponent:
    channel = codes_of(name)[3]
    first = min(traces, key=lambda trace: trace.stats.starttime)
    response = problem = None
    if responses is not None:
        try:
            response = responses.find(name, first.stats.starttime.datetime)
        except RecordError as refusal:  # of no matter if another channel is read
            problem = refusal
    direction = UNKNOWN if response is None else response.orientation
    if direction == UNKNOWN:
        direction = orientation_of(channel) if len(channel) == 3 else UNKNOWN

    def samples() -> Record:
        if problem is not None:
            raise problem
        if name in damage.misfits:
            samples = f"{damage.misfits[name]} samples of {name}"
            found = f"{samples} that end at another value than their record states"
            raise source.refuse(found=found, expected="miniSEED records that are not damaged")
        counts, time_step, start = joined_traces(source, traces)
        checked_time_step(source, request, time_step, None)
        metadata: Metadata = {**metadata_of_codes(name), "record_time": start}
        record = record_from_counts(source, request, counts, time_step, metadata, response)
        if not damage.skipped:
            return record
        words = f"{source.path}: {damage.skipped} bytes that are no miniSEED record are not read"
        return replace(record, warnings=(*record.warnings, words))

    return FileComponent(label, samples, direction, aliases=(name, channel))


def by_channel(traces: Iterable[Any]) -> dict[str, list[Any]]:
    """Group traces by channel."""
    channels: dict[str, list[Any]] = {}
    for trace in traces:
        channels.setdefault(".".join(codes_of(str(trace.id))), []).append(trace)
    return channels


def joined_traces(source: Source, traces: list[Any]) -> tuple[Array, float, str]:
    """Join the traces of one channel."""
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
        if np.ma.is_masked(trace.data):
            raise source.refuse(found="masked samples", expected="a channel without gaps")
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
    check_finite(source, counts)
    return counts, time_step, str(first.starttime)


def components_of_traces(
    source: Source, request: Request, traces: list[Any]
) -> list[FileComponent]:
    """Return the channels of traces in memory as components."""
    channels = by_channel(traces)

    def samples(name: str) -> Record:
        traces_of_channel = channels[name]
        values, time_step, start = joined_traces(source, traces_of_channel)
        check_time_step(source, time_step, None)
        stated = stated_unit(traces_of_channel[0].stats.get("standard"))
        unit, as_read, messages = choose_unit(source, request, stated, None)
        metadata = {**metadata_of_codes(name), "record_time": start, "unit_as_read": as_read}
        return Record(time_step, values, unit, metadata, warnings=tuple(messages))

    return [
        FileComponent(
            label, partial(samples, name), orientation_of(channel), aliases=(name, channel)
        )
        for name, label in _labels(channels).items()
        for channel in codes_of(name)[3:]
    ]


MINISEED: Final = Format(
    "miniseed",
    "miniSEED file (through ObsPy)",
    (".mseed", ".miniseed", ".ms", ".seed"),
    _recognises,
    _read,
    binary=True,
    holds="any number",
    unit="counts",
)
