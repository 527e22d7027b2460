"""Constructors of motions from uneven times, data frames and traces of ObsPy."""

from __future__ import annotations

from collections.abc import Hashable
from enum import StrEnum
from typing import Any, Final, cast

import numpy as np

from rockframe.arguments import checked_choice
from rockframe.errors import ComponentError, RecordWarning, did_you_mean, short_repr, warn
from rockframe.motion.constructors.records import SAME_STEP, motion_of_reading, warn_of_reading
from rockframe.motion.processing.samples import sample_times
from rockframe.motion.quantities import (
    ArrayLike,
    accelerations_to_si,
    relative_seconds,
    times_to_si,
)
from rockframe.motion.value import UNNAMED, MotionType
from rockframe.records import (
    DOWNWARDS,
    MAXIMUM_SAMPLES,
    SENSE,
    USUAL_TIME_STEPS,
    Metadata,
    argument_unit,
    orientation_of,
    read_traces,
    request_of,
    uniform_step,
)
from rockframe.signals import Motion
from rockframe.signals.arrays import Array
from rockframe.suggestions import with_hints
from rockframe.units import POSITIVE, TIME_STEP, QuantityLike, to_si

_COARSER: Final = 1.5


class UnevenInterpolation(StrEnum):
    """Interpolation of an acceleration between uneven times."""

    LINEAR = "linear"
    CUBIC = "cubic"


_METHOD_NOTES: Final = {
    UnevenInterpolation.LINEAR: "straight lines between them",
    UnevenInterpolation.CUBIC: "a cubic spline through them",
}


@with_hints()
def from_times(
    kind: type[MotionType],
    times: ArrayLike,
    acceleration: ArrayLike,
    time_step: QuantityLike,
    vertical: ArrayLike | None = None,
    *,
    interpolation: UnevenInterpolation | str = UnevenInterpolation.LINEAR,
    name: str | None = None,
) -> MotionType:
    """Build a motion from accelerations at uneven times, interpolated at an even time step.

    Parameters
    ----------
    times : Quantity, (sequence, unit), DataArray or dates, shape (n,)
        Increasing times; dates and time differences (NumPy, pandas) need no unit [s].
    acceleration : Quantity, (sequence, unit) or DataArray, shape (n,)
        Horizontal acceleration at these times [m s^-2].
    time_step : str or Quantity
        Time step of the motion [s].
    vertical : Quantity, (sequence, unit) or DataArray, shape (n,), optional
        Vertical acceleration, upwards, at the same times [m s^-2].
    interpolation : {"linear", "cubic"}, optional
        Straight lines between the times, or a cubic spline.
    name : str, optional
        Name for titles and messages.

    Returns
    -------
    GroundMotion
        It starts at the first time; its history states the interpolation.

    Raises
    ------
    UnitsError
        An array or the time step has no unit, or a wrong one.
    ComponentError
        Times that do not increase, arrays that are not finite or of different lengths, another
        interpolation, or a time step that gives fewer than two samples or too many.

    Warns
    -----
    RecordWarning
        `time_step` is longer than most intervals between the times, so that higher frequencies
        are lost and aliased.

    Examples
    --------
    >>> from rockframe.motion import GroundMotion
    >>> digitised = GroundMotion.from_times(
    ...     ([0.0, 0.03, 0.05, 0.1], "s"), ([0.0, 0.3, 0.1, 0.0], "m/s^2"), "0.01 s"
    ... )
    >>> digitised.acceleration.m.round(3).tolist()
    [0.0, 0.1, 0.2, 0.3, 0.2, 0.1, 0.08, 0.06, 0.04, 0.02, 0.0]
    """
    owner = f"{kind.__name__}.from_times"
    between = checked_choice(UnevenInterpolation, interpolation, owner=owner, name="interpolation")
    step = to_si(time_step, TIME_STEP, owner=owner, name="time_step", condition=POSITIVE)
    instants = times_to_si(times, owner=owner, name="times")
    length = float(instants[-1] - instants[0])
    if not step <= length or length / step > MAXIMUM_SAMPLES:
        msg = (
            f"{owner}: time_step = {step:.6g} s must give 2 to {MAXIMUM_SAMPLES} samples of "
            f"{length:.6g} s"
        )
        raise ComponentError(msg)
    grid = sample_times(length, step)
    read: list[Array] = []
    for label, array in (("acceleration", acceleration), ("vertical", vertical)):
        if array is None:
            continue
        values = accelerations_to_si(array, owner=owner, name=label)
        if values.size != instants.size or not np.isfinite(values).all():
            msg = (
                f"{owner}: {label} has {values.size} samples at {instants.size} times; it needs "
                "one finite sample for each time"
            )
            raise ComponentError(msg)
        read.append(_interpolated(instants - instants[0], values, grid, between))
    gaps = np.diff(instants)
    if step > _COARSER * float(np.median(gaps)):
        words = (
            f"{owner}: time_step = {step:.6g} s is longer than the intervals between the times "
            f"(mostly {np.median(gaps):.6g} s); use a shorter one, then resampled, which filters"
        )
        warn(words, RecordWarning)
    words = (
        f"built from {instants.size} samples {gaps.min():.6g} s to {gaps.max():.6g} s apart, "
        f"{_METHOD_NOTES[between]}, read off every {step!r} s"
    )
    return kind(
        Motion.of_samples(step, *read), name=UNNAMED if name is None else name, history=(words,)
    )


def _interpolated(times: Array, values: Array, grid: Array, between: UnevenInterpolation) -> Array:
    if between is UnevenInterpolation.LINEAR:
        return np.interp(grid, times, values)
    from scipy.interpolate import CubicSpline  # slow to import, and needed only here

    spline: Any = CubicSpline(times, values)
    return np.asarray(spline(grid), dtype=np.float64)


@with_hints()
def from_frame(
    kind: type[MotionType],
    frame: Any,
    unit: str,
    component: str | None = None,
    vertical: str | None = None,
    *,
    time: str | None = None,
    time_step: QuantityLike | None = None,
    name: str | None = None,
) -> MotionType:
    """Build a motion from columns of a pandas DataFrame.

    Parameters
    ----------
    frame : pandas.DataFrame
        Data with one row for each sample.
    unit : str
        Unit of the accelerations as record files spell it: ``"g"``, ``"gal"``, ...
    component : str, optional
        Column with the horizontal acceleration; needed if there is more than one column.
    vertical : str, optional
        Column with the vertical acceleration; the sign of one called ``"DWN"`` or ``"down"`` is
        reversed.
    time : str, optional
        Column with the times, in seconds or as dates; by default the index is used if it consists
        of dates or real numbers.
    time_step : str or Quantity, optional
        Time step, needed without times [s].
    name : str, optional
        Name for titles and messages.

    Returns
    -------
    GroundMotion

    Raises
    ------
    UnitsError
        `unit` is not an acceleration, or `time_step` not a time.
    ComponentError
        Not a data frame; no such column or several; neither times nor a time step; times that
        contradict the time step or are uneven (see :meth:`from_times`); or samples that are not
        finite numbers.

    Warns
    -----
    RecordWarning
        The times have an unusual step, for example because they are in milliseconds.

    Examples
    --------
    >>> import pandas as pd
    >>> from rockframe.motion import GroundMotion
    >>> frame = pd.DataFrame({"t": [0.0, 0.01, 0.02], "N": [0.0, 0.1, -0.1]})
    >>> GroundMotion.from_frame(frame, "g", "N", time="t").metadata["azimuth"]
    0.0
    """
    owner = f"{kind.__name__}.from_frame"
    if not (hasattr(frame, "columns") and hasattr(frame, "index") and hasattr(frame, "loc")):
        msg = f"{owner}: frame needs a pandas DataFrame, got {short_repr(frame)}"
        raise ComponentError(msg)
    record_unit = argument_unit(unit, owner=owner)
    for what, label in (("component", component), ("vertical", vertical), ("time", time)):
        if label is not None and not isinstance(cast("object", label), Hashable):
            msg = f"{owner}: {what} must name a column, got {short_repr(label)}"
            raise ComponentError(msg)
        if label is not None and list(frame.columns).count(label) > 1:
            msg = f"{owner}: {what} must name one column, and several are called {label!r}"
            raise ComponentError(msg)
    labels = [label for label in frame.columns if label not in (time, vertical)]
    if component is None and len(labels) != 1:
        listed = ", ".join(repr(label) for label in labels[:10]) or "none"
        msg = f"{owner}: component must name one of the columns {listed}"
        raise ComponentError(msg)
    chosen = labels[0] if component is None else component
    across = _column(frame, chosen, owner, "component") * record_unit.factor
    step = _step(frame, time, time_step, owner)
    metadata: Metadata = {"component": str(chosen), "unit_as_read": str(unit)}
    direction = orientation_of(str(chosen))
    if direction.azimuth is not None:
        metadata["azimuth"] = direction.azimuth
    if direction.vertical is not None:
        metadata[SENSE] = direction.vertical
    history = [f"built from the column {chosen} of a data frame: {across.size} samples"]
    upwards = None
    if vertical is not None:
        upwards = _column(frame, vertical, owner, "vertical") * record_unit.factor
        metadata["vertical_component"] = str(vertical)
        if orientation_of(str(vertical)).vertical == DOWNWARDS:
            upwards = -upwards
            history.append(f"component {vertical} turned over: positive upwards")
    si = Motion.of_samples(step, across, upwards)
    return kind(
        si, name=str(chosen) if name is None else name, metadata=metadata, history=tuple(history)
    )


def _column(frame: Any, label: object, owner: str, argument: str) -> Array:
    if label not in frame.columns:
        listed = ", ".join(repr(column) for column in list(frame.columns)[:10])
        near = did_you_mean(label, map(str, frame.columns))
        msg = f"{owner}: {argument} {short_repr(label)} is none of the columns {listed}{near}"
        raise ComponentError(msg)
    values = np.asarray(frame[label])
    if values.ndim != 1 or values.dtype.kind not in "fiu" or not np.isfinite(values).all():
        msg = f"{owner}: the column {label!r} must hold finite numbers, without gaps"
        raise ComponentError(msg)
    return values.astype(np.float64)


def _step(frame: Any, time: str | None, time_step: QuantityLike | None, owner: str) -> float:
    requested = None
    if time_step is not None:
        requested = to_si(time_step, TIME_STEP, owner=owner, name="time_step", condition=POSITIVE)
    if time is None:
        axis = frame.index
    elif time in frame.columns:
        axis = frame[time]
        if getattr(axis.dtype, "kind", "") not in "mM":
            try:
                axis = np.asarray(axis, dtype=np.float64)
            except (TypeError, ValueError) as problem:
                msg = f"{owner}: the column {time!r} must hold times, in seconds or as dates"
                raise ComponentError(msg) from problem
    else:
        near = did_you_mean(time, map(str, frame.columns))
        msg = f"{owner}: time {short_repr(time)} is none of the columns{near}"
        raise ComponentError(msg)
    times = relative_seconds(axis)
    if times is None:
        if requested is None:
            msg = f"{owner}: the frame has no times; give time, or time_step='0.01 s'"
            raise ComponentError(msg)
        return requested
    printed = [repr(value) for value in cast("list[float]", times.tolist())]
    stored = frame.index if time is None else frame[time]
    precision = np.float32 if stored.dtype == np.float32 else np.float64
    step, misfit = uniform_step(times, printed, precision)
    if misfit is not None:
        msg = (
            f"{owner}: the times are not even ({printed[misfit]} s after {printed[misfit - 1]} s); "
            "use from_times, which resamples"
        )
        raise ComponentError(msg)
    if requested is not None and not np.isclose(requested, step, rtol=SAME_STEP, atol=0.0):
        msg = f"{owner}: the times have the step {step:.9g} s, but time_step is {requested:.9g} s"
        raise ComponentError(msg)
    short, long = USUAL_TIME_STEPS
    if requested is None and not short <= step <= long:
        words = f"the times have the step {step:.6g} s (usual: {short:g} s to {long:g} s)"
        warn(f"{owner}: {words}; are they in seconds?", RecordWarning)
    return step


_NEEDED: Final = ("id", "data", "stats")


@with_hints()
def from_trace(
    kind: type[MotionType],
    trace: Any,
    unit: str | None = None,
    component: str | tuple[str, str] | None = None,
    *,
    name: str | None = None,
) -> MotionType:
    """Build a motion from an ObsPy Trace or Stream.

    Parameters
    ----------
    trace : obspy.Trace or obspy.Stream
        Accelerations, after removal of the instrument response.
    unit : str, optional
        Unit of the samples, which ObsPy does not have: ``"m/s^2"``, ``"gal"``, ... Not needed
        for a trace of gmprocess, which states it.
    component : str or pair of str, optional
        As for :meth:`read`; needed for a stream with more than one horizontal component.
    name : str, optional
        Name for titles and messages; by default the codes of the channel.

    Returns
    -------
    GroundMotion
        Its metadata have network, station, location, component and start.

    Raises
    ------
    RecordError
        No unit, a gap or an overlap, samples that are not finite, or no such component; the
        message lists the components.
    UnitsError
        `unit` is not an acceleration.
    ComponentError
        Not a trace or stream, or `component` is neither a name nor a pair of names.

    Warns
    -----
    RecordWarning
        An unusual peak or time step, an offset, or a vertical component read as a
        horizontal one.

    Notes
    -----
    ObsPy is not imported: any object with the attributes ``id``, ``data`` and ``stats`` of its
    traces can be read.

    Examples
    --------
    >>> from obspy import read  # doctest: +SKIP
    >>> trace = read("record.mseed")[0]  # doctest: +SKIP
    >>> GroundMotion.from_trace(trace, unit="m/s^2").name  # doctest: +SKIP
    'XX.ABC.HNE'
    """
    owner = f"{kind.__name__}.from_trace"
    requested = request_of(owner=owner, unit=unit, component=component)
    traces = [trace] if all(hasattr(trace, part) for part in _NEEDED) else _listed(trace, owner)
    reading = read_traces(traces, requested, owner=owner)
    warn_of_reading(reading)
    codes = [reading.metadata.get(key, "") for key in ("network", "station", "component")]
    return motion_of_reading(kind, reading, ".".join(map(str, codes)) if name is None else name)


def _listed(stream: Any, owner: str) -> list[Any]:
    traces: list[Any] = list(getattr(stream, "traces", ()))
    if not traces or not all(hasattr(trace, part) for trace in traces for part in _NEEDED):
        msg = (
            f"{owner}: trace needs an ObsPy Trace, or a Stream that holds one, got "
            f"{short_repr(stream)}"
        )
        raise ComponentError(msg)
    return traces
