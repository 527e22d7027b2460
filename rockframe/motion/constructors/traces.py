"""Constructor of motions from what ObsPy holds in memory."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, Final, cast

from rockframe.errors import ComponentError, RecordWarning, shown
from rockframe.records import read_traces, request_of

if TYPE_CHECKING:
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
    asked = request_of(owner=owner, unit=unit, component=component)
    traces = [trace] if all(hasattr(trace, part) for part in _NEEDED) else _listed(trace, owner)
    reading = read_traces(traces, asked, owner=owner)
    for message in reading.warnings:
        warnings.warn(message, RecordWarning, stacklevel=2)
    codes = [reading.metadata.get(key, "") for key in ("network", "station", "component")]
    return kind(
        reading.si,
        name=name or ".".join(map(str, codes)),
        metadata=reading.metadata,
        history=reading.history,
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
