"""Traces as ObsPy holds them: those of a channel joined, and the channels named."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from rockframe.records.source import MAXIMUM_SAMPLES, Source

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rockframe.signals.arrays import Array


def by_channel(traces: Iterable[Any]) -> dict[str, list[Any]]:
    """Sort traces by their channel."""
    channels: dict[str, list[Any]] = {}
    for trace in traces:
        channels.setdefault(".".join(codes_of(str(trace.id))), []).append(trace)
    return channels


def codes_of(name: str) -> tuple[str, str, str, str]:
    """Take ``NET.STA.LOC.CHA`` apart; what is missing is empty, and so is a location ``--``."""
    network, station, location, channel = (*name.split("."), "", "", "", "")[:4]
    return network, station, location_code(location), channel


def location_code(given: str) -> str:
    """Give the code of a sensor's location; two hyphens or blanks stand for none."""
    return given.strip(" -")


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
    if not np.isfinite(counts).all():
        raise source.refuse(found="samples that are not finite", expected="finite samples")
    return counts, time_step, str(first.starttime)
