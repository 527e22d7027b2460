"""Constructors of records: from files, from examples in the package, and from arrays."""

from __future__ import annotations

import io
import tomllib
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import PurePath
from typing import Any, Final, cast

import numpy as np

from rockframe.arguments import checked_text
from rockframe.errors import (
    ComponentError,
    RecordWarning,
    UnitsError,
    did_you_mean,
    short_repr,
    warn,
)
from rockframe.motion.quantities import ArrayLike, accelerations_to_si, attached_times
from rockframe.motion.value import UNNAMED, MotionType, replaced
from rockframe.records import PathLike, Reading, RecordLike, read_record, request_of
from rockframe.signals import Motion
from rockframe.signals.arrays import Array
from rockframe.suggestions import with_hints
from rockframe.units import POSITIVE, TIME_STEP, QuantityLike, to_si

SAME_STEP: Final = 1e-6
"""Relative difference up to which the step of times is that of an argument [1]."""
_UNEVEN: Final = 0.01
_SAME_START: Final = 0.1
"""Greatest distance of the starts of two components over the time step [1]."""


@with_hints()
def read(
    kind: type[MotionType],
    path: RecordLike,
    format: str | None = None,  # noqa: A002
    component: str | tuple[str, str] | None = None,
    unit: str | None = None,
    *,
    time_step: QuantityLike | None = None,
    response: PathLike | None = None,
) -> MotionType:
    """Read a record file.

    Parameters
    ----------
    path : str, path-like, bytes or file object
        Path of a file (``~`` is the home folder), its bytes, or an open file. It may be packed
        by gzip, or be the only file of a zip or tar archive; :func:`rockframe.read_suite` reads
        archives of several.
    format : str, optional
        Name of one of :func:`rockframe.motion.formats`; recognised from the file by default.
    component : str or pair of str, optional
        Component by its name in the file (``"HNE"``, ``"S16W"``), its direction (``"N"``,
        ``"090"``, ``"U"``) or its number (``"channel 3"``); a pair is a horizontal component
        with the vertical one. Needed for a file with more than one horizontal component.
        ``"row by row"`` is for a text without names in which one record has several values in
        each line.
    unit : str, optional
        Unit of the samples, if the file does not state it: ``"g"``, ``"gal"``, ``"cm/s^2"``, ...
        Here ``g`` is the acceleration of gravity.
    time_step : str or Quantity, optional
        Time step of a column of samples without times [s].
    response : str or path-like, optional
        StationXML file with the response of the instrument, for counts (miniSEED, SAC, ASDF); by
        default searched in the folder of the file.

    Returns
    -------
    GroundMotion
        Its metadata have the name and digest of the file, and the event, station, component and
        unit that it states; its history lists the processing.

    Raises
    ------
    RecordError
        The file cannot be read as a ground-motion record, or has no such
        component; the message lists those that it has.
    UnitsError
        `unit` is not an acceleration, or `time_step` not a time.
    ComponentError
        `format` is unknown, `component` neither a name nor a pair of names,
        or `time_step` is not positive.

    Warns
    -----
    RecordWarning
        The file slightly contradicts itself or an argument (such as a stated peak and the
        samples); its peak, offset or time step is unusual; or its only component is vertical.

    Examples
    --------
    >>> import tempfile
    >>> import rockframe as rf
    >>> path = f"{tempfile.mkdtemp()}/record.AT2"
    >>> rf.GroundMotion.sine_pulse("3 m/s^2", "2 Hz").to_at2(path)
    >>> print(rf.GroundMotion.read(path).peak_acceleration.to("m/s^2").round(3))
    3.0 meter / second ** 2
    """
    requested = request_of(
        owner=f"{kind.__name__}.read",
        unit=unit,
        time_step=time_step,
        component=component,
        response=response,
    )
    reading = read_record(path, format, requested)
    warn_of_reading(reading)
    return motion_of_reading(kind, reading, reading.name or PurePath(reading.file).stem)


def warn_of_reading(reading: Reading) -> None:
    """Issue the warnings of a reading."""
    for message in reading.warnings:
        warn(message, RecordWarning)


def motion_of_reading(kind: type[MotionType], reading: Reading, name: str) -> MotionType:
    """Make a motion of what was read."""
    return kind(
        reading.si,
        name=name,
        metadata=reading.metadata,
        history=reading.history,
        recipe=reading.recipe,
    )


@with_hints()
def from_arrays(
    kind: type[MotionType],
    acceleration: ArrayLike,
    time_step: QuantityLike | None = None,
    vertical: ArrayLike | None = None,
    *,
    name: str | None = None,
) -> MotionType:
    """Build a motion from arrays with a unit.

    Parameters
    ----------
    acceleration : Quantity, (sequence, unit) or DataArray, shape (n,)
        Horizontal acceleration; a DataArray needs the attribute ``units`` [m s^-2]. If a
        DataArray, or a pandas Series as the sequence, has times, these must agree with
        `time_step`.
    time_step : str or Quantity
        Time between samples, required [s].
    vertical : Quantity, (sequence, unit) or DataArray, shape (n,), optional
        Vertical acceleration, upwards [m s^-2].
    name : str, optional
        Name for titles and messages.

    Returns
    -------
    GroundMotion

    Raises
    ------
    UnitsError
        An array or the time step has no unit, or a wrong one.
    ComponentError
        An array is not finite or not one-dimensional, both have different lengths or starts, or
        times of an array are uneven or of another step.

    Examples
    --------
    >>> import rockframe as rf
    >>> samples = ([0.0, 1.2, -2.5, 0.4], "m/s^2")
    >>> motion = rf.GroundMotion.from_arrays(samples, time_step="0.02 s", name="shaken")
    >>> print(motion.peak_acceleration)
    2.5 meter / second ** 2
    """
    owner = f"{kind.__name__}.from_arrays"
    if time_step is None:
        across = accelerations_to_si(acceleration, owner=owner, name="acceleration")
        msg = (
            f"{owner}: time_step needs {TIME_STEP.needed}, the time between the {across.size} "
            f"samples, and none was given; {TIME_STEP.example_of('time_step')}"
        )
        raise UnitsError(msg)
    step = to_si(time_step, TIME_STEP, owner=owner, name="time_step", condition=POSITIVE)
    across = accelerations_to_si(acceleration, owner=owner, name="acceleration")
    upwards = None
    if vertical is not None:
        upwards = accelerations_to_si(vertical, owner=owner, name="vertical")
        if upwards.size != across.size:
            msg = (
                f"{owner}: acceleration has {across.size} samples, vertical {upwards.size}; "
                "give both the same length, or use with_vertical, which pads"
            )
            raise ComponentError(msg)
    starts: list[tuple[str, float]] = []
    for label, array in (("acceleration", acceleration), ("vertical", vertical)):
        times = attached_times(array)
        if times is not None:
            _check_times(times.seconds, step, owner=owner, label=label)
            starts.append((times.origin, times.start))
    _check_starts(starts, step, owner=owner)
    called = UNNAMED if name is None else checked_text(name, owner=owner, name="name") or UNNAMED
    words = f"built from arrays: {across.size} samples at {step!r} s"
    return kind(Motion.of_samples(step, across, upwards), name=called, history=(words,))


def _check_times(times: Array, step: float, *, owner: str, label: str) -> None:
    """Refuse times of an array that disagree with the time step given with it."""
    declared = float(times[-1]) / (times.size - 1)
    apart = np.abs(times - declared * np.arange(times.size))
    if not np.isclose(declared, step, rtol=SAME_STEP, atol=0.0) and apart.max() <= _UNEVEN * step:
        msg = (
            f"{owner}: the time axis of {label} has the step {declared:.9g} s, "
            f"but time_step is {step:.9g} s"
        )
        raise ComponentError(msg)
    if apart.max() > _UNEVEN * step:
        msg = (
            f"{owner}: the time axis of {label} is not even (sample {int(apart.argmax())} is "
            f"{apart.max():.3g} s from an even spacing); use from_times, which resamples"
        )
        raise ComponentError(msg)


def _check_starts(starts: list[tuple[str, float]], step: float, *, owner: str) -> None:
    """Refuse times of two arrays that begin at different instants of one origin."""
    if len(starts) < 2 or starts[0][0] != starts[1][0]:
        return
    late = starts[1][1] - starts[0][1]
    if abs(late) > _SAME_START * step:
        msg = (
            f"{owner}: the times of vertical start {abs(late):.4g} s "
            f"{'after' if late > 0.0 else 'before'} those of acceleration; cut both to one start"
        )
        raise ComponentError(msg)


_PROVENANCE: Final = "provenance.toml"


@with_hints()
def example(
    kind: type[MotionType],
    name: str = "loma-prieta",
    component: str | tuple[str, str] | None = None,
) -> MotionType:
    """Read a recorded motion that comes with rockframe.

    Parameters
    ----------
    name : {"loma-prieta", "waipukurau"}, optional
        The record: San Francisco, 1295 Shafter Avenue, in the Loma Prieta earthquake of 1989,
        0.11 g; or Waipawa in a small earthquake near Waipukurau, New Zealand, in 2018, 0.02 g.
    component : str or pair of str, optional
        As for :meth:`read`, if the file has several: ``"S16W"``, ``"S74E"`` and ``"Up"`` of
        Waipukurau, of which the second is the default.

    Returns
    -------
    GroundMotion
        As published, neither scaled nor corrected. Its metadata have `source`, `processing`,
        `licence`, `attribution` and `reference`; its history has the attribution, too.

    Raises
    ------
    ComponentError
        There is no such record; the message lists the records.
    RecordError
        The record has no such component.

    Examples
    --------
    >>> import rockframe as rf
    >>> motion = rf.GroundMotion.example("loma-prieta")
    >>> print(motion.peak_acceleration.to("g_0").round(3))
    0.106 standard_gravity
    """
    folder = resources.files("rockframe.motion") / "embedded"
    records = record_sources(folder)
    record = records.get(name) if isinstance(cast("object", name), str) else None
    if record is None:
        known = ", ".join(repr(key) for key in records)
        got = f"{short_repr(name)}{did_you_mean(name, records)}"
        msg = f"{kind.__name__}.example: name must be one of {known}, got {got}"
        raise ComponentError(msg)
    file = io.BytesIO((folder / record["file"]).read_bytes())
    file.name = record["file"]
    motion = read(kind, file, component=record["component"] if component is None else component)
    metadata: dict[str, Any] = record["metadata"]
    source = f"source: {metadata['attribution']}; {metadata['licence']}"
    return replaced(
        motion,
        name=record["name"],
        metadata={**motion.metadata, **metadata},
        history=(*motion.history, source),
    )


def record_sources(folder: Traversable) -> dict[str, Any]:
    """Read the sources of the records in a folder, by name."""
    return tomllib.loads((folder / _PROVENANCE).read_text(encoding="utf-8"))
