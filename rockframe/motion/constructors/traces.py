"""Constructor of motions from what ObsPy holds in memory."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, Final, cast

from rockframe.errors import ComponentError, RecordWarning, shown
from rockframe.motion.quantities import argument_unit
from rockframe.records.checks import check_time_step, choose_unit
from rockframe.records.components import (
    FileComponent,
    choose_component,
    component_names,
    orientation_of,
)
from rockframe.records.instruments import codes_of
from rockframe.records.miniseed import by_channel, joined_traces
from rockframe.records.read import to_motion
from rockframe.records.record_file import Metadata, Record, Request, Source

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rockframe.motion.value import Made

_NEEDED: Final = ("id", "data", "stats")


def from_trace(
    kind: type[Made],
    trace: Any,
    unit: str | None = None,
    component: str | tuple[str, str] | None = None,
    *,
    name: str | None = None,
) -> Made:
    """Build a motion from an ObsPy Trace or Stream.

    Parameters
    ----------
    trace : obspy.Trace or obspy.Stream
        Of accelerations: with the response of the instrument removed.
    unit : str, optional
        Unit of the samples, which ObsPy does not know: ``"m/s^2"``, ``"gal"``, ... Not
        needed for a trace of gmprocess, which states it.
    component : str or pair of str, optional
        As for :meth:`read`; needed where a stream has more than one horizontal
        component.
    name : str, optional
        For titles and messages; the codes of the channel unless given.

    Returns
    -------
    GroundMotion
        Its metadata hold network, station, location, component and start.

    Raises
    ------
    RecordError
        No unit, a gap or an overlap, samples that are not finite, or no such component;
        the message lists those that there are.
    UnitsError
        `unit` is not an acceleration.
    ComponentError
        No trace and no stream, or `component` is neither a name nor a pair of names.

    Warns
    -----
    RecordWarning
        An unusual peak or time step, an offset, or a vertical component read as a
        horizontal one.

    Notes
    -----
    ObsPy itself is not imported: whatever has ``id``, ``data`` and ``stats`` as its traces
    do is read.
    """
    owner = f"{kind.__name__}.from_trace"
    horizontal, vertical = component_names(component, owner=owner)
    traces = [trace] if all(hasattr(trace, part) for part in _NEEDED) else _listed(trace, owner)
    source = Source(owner, b"", "")
    request = Request(
        unit=None if unit is None else argument_unit(unit, owner=owner),
        unit_name=None if unit is None else str(unit),
        component=horizontal,
        vertical=vertical,
    )
    channels = by_channel(traces)
    stations = {code.rsplit(".", 2)[0] for code in channels}
    record = choose_component(
        source,
        request,
        [
            _component(source, request, code, held, several=len(stations) > 1)
            for code, held in channels.items()
        ],
    )
    si, doubts = to_motion(source, record)
    for message in (*record.warnings, *doubts):
        warnings.warn(message, RecordWarning, stacklevel=2)
    codes = [record.metadata.get(key, "") for key in ("network", "station", "component")]
    said = f"built from a trace: {record.samples.size} samples at {record.time_step!r} s"
    return kind(
        si,
        name=name or ".".join(map(str, codes)),
        metadata=record.metadata,
        history=(said, *record.history),
    )


def _listed(stream: Any, owner: str) -> list[Any]:
    traces: list[Any] = []
    if hasattr(stream, "traces"):
        traces = list(cast("list[Any]", stream.traces))
    if not traces or not all(hasattr(one, part) for one in traces for part in _NEEDED):
        msg = (
            f"{owner}: trace needs an ObsPy Trace, or a Stream that holds one, got {shown(stream)}"
        )
        raise ComponentError(msg)
    return traces


def _component(
    source: Source, request: Request, code: str, traces: list[Any], *, several: bool
) -> FileComponent:
    network, station, location, channel = codes_of(code)
    about = {"network": network, "station": station, "sensor_location": location}

    def samples() -> Record:
        values, time_step, start = joined_traces(source, traces)
        check_time_step(source, time_step, None)
        unit, as_read, said = choose_unit(source, request, _stated_unit(traces[0].stats), None)
        metadata: Metadata = {key: value for key, value in about.items() if value}
        metadata |= {"record_time": start, "unit_as_read": as_read}
        return Record(time_step, values, unit, metadata, warnings=tuple(said))

    aliases = (code, channel)
    return FileComponent(
        code if several else channel, samples, orientation_of(channel), aliases=aliases
    )


def _stated_unit(stats: Mapping[str, Any]) -> str | None:
    """Give the unit that gmprocess keeps with a trace."""
    standard = stats.get("standard")
    unit = cast("Mapping[str, Any]", standard).get("units") if hasattr(standard, "get") else None
    return unit if isinstance(unit, str) and unit else None
