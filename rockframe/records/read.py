"""Reading of a file to a record in SI units: format, reader, checks, provenance."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Final, cast

import numpy as np

from rockframe.errors import RecordError, RockframeError
from rockframe.records.checks import check_missing_values, check_time_step, plausibility_warnings
from rockframe.records.components import (
    EveryComponentError,
    FileComponent,
    choose_component,
    read_component_named,
    requested_components,
)
from rockframe.records.files import PathLike, RecordLike, read_source
from rockframe.records.known_formats import (
    WITH_RESPONSE,
    Format,
    added_reader_error,
    format_by_name,
    recognised_format,
)
from rockframe.records.miniseed import components_of_traces
from rockframe.records.reader import (
    MAXIMUM_SAMPLES,
    Metadata,
    Record,
    Request,
    Source,
    StoredMotion,
    base_name,
)
from rockframe.records.unit_names import RecordUnit, argument_unit
from rockframe.signals import Motion
from rockframe.signals.arrays import Array
from rockframe.units import POSITIVE, TIME_STEP, QuantityLike, to_si

_ANYTHING: Final = Request()


@dataclass(frozen=True)
class Reading:
    """A record that was read, converted and checked."""

    si: Motion  # in SI units
    metadata: Metadata  # contents of the header, and name and digest of the file
    history: tuple[str, ...]  # sentences about the reading and processing
    warnings: tuple[str, ...] = ()  # the caller issues them
    name: str | None = None  # name of a stored motion
    recipe: Mapping[str, Any] | None = None  # recipe of a stored analytic motion
    file: str = ""  # name of the file, without its folder
    vertical: bool = False  # whether it is a vertical component, read alone


def request_of(
    *,
    owner: str = "request_of",
    unit: str | None = None,
    time_step: QuantityLike | None = None,
    component: str | tuple[str, str] | None = None,
    response: PathLike | None = None,
) -> Request:
    """Check the arguments of a caller for a reader; messages begin with `owner`."""
    horizontal, vertical = requested_components(component, owner=owner)
    return Request(
        unit=None if unit is None else argument_unit(unit, owner=owner),
        unit_name=None if unit is None else str(unit),
        time_step=None
        if time_step is None
        else to_si(time_step, TIME_STEP, owner=owner, name="time_step", condition=POSITIVE),
        component=horizontal,
        vertical=vertical,
        response=None if response is None else str(response),
    )


def read_record(
    given: RecordLike, format_name: str | None = None, request: Request = _ANYTHING
) -> Reading:
    """Read one component of a record file, or a horizontal one with the vertical one."""
    chosen = None if format_name is None else format_by_name(str(format_name))
    source = read_source(given)
    entry = chosen or recognised_format(source)
    if request.response is not None and entry.own and entry.name not in WITH_RESPONSE:
        kinds = ", ".join(WITH_RESPONSE)
        expected = f"a file of counts ({kinds}), to which the argument response applies"
        raise source.refuse(found=f"a {entry.title}", expected=expected)
    return _reading(entry, source, _read(entry, source, request))


def read_components(
    source: Source, format_name: str | None = None, request: Request = _ANYTHING
) -> list[Reading | RecordError]:
    """Read all components of a file."""
    entry = format_by_name(format_name) if format_name is not None else recognised_format(source)
    try:
        return [_reading(entry, source, _read(entry, source, replace(request, every=True)))]
    except EveryComponentError as error:
        components = error.components
    results = [_read_or_error(entry, source, component) for component in components]
    refused = [result for result in results if isinstance(result, RecordError)]
    if len(refused) == len(results):
        raise refused[0]
    return results


def read_traces(traces: list[Any], request: Request, *, owner: str) -> Reading:
    """Read traces in memory, such as those of ObsPy, with ``id``, ``data`` and ``stats``."""
    source = Source(owner, b"", "")
    record = choose_component(source, request, components_of_traces(source, request, traces))
    si, doubts = to_motion(source, record)
    text = f"built from a trace: {record.samples.size} samples at {record.time_step!r} s"
    return Reading(si, record.metadata, (text, *record.history), (*record.warnings, *doubts))


def _read_or_error(
    entry: Format, source: Source, component: FileComponent
) -> Reading | RecordError:
    """Read a component, or give the error."""
    try:
        reading = _reading(entry, source, read_component_named(source, component))
    except RecordError as problem:
        where = f"{problem.path}, {component.label}"
        return RecordError(where, found=problem.found, expected=problem.expected, line=problem.line)
    return replace(reading, vertical=component.orientation.vertical is not None)


def _reading(entry: Format, source: Source, record: Record | StoredMotion) -> Reading:
    base = base_name(source.path)
    if isinstance(record, StoredMotion):
        return Reading(**vars(record), file=base)
    si, doubts = to_motion(source, record)
    metadata = {
        **record.metadata,
        "format": entry.name,
        "source_file": base,
        "source_sha256": source.sha256,
    }
    step = (
        f"read {base} ({entry.title}, unit {record.metadata.get('unit_as_read', '')}): "
        f"{record.samples.size} samples at {record.time_step!r} s"
    )
    messages = tuple(dict.fromkeys((*record.warnings, *doubts)))
    return Reading(si, metadata, (step, *record.history), messages, file=base)


def to_motion(source: Source, record: Record) -> tuple[Motion, list[str]]:
    """Check a record and convert it to SI units."""
    check_time_step(source, record.time_step, None)
    held = [part for part in (record.samples, record.vertical) if part is not None]
    doubts: list[str] = []
    for samples in held:
        check_missing_values(source, samples)
        doubts += plausibility_warnings(source, record.time_step, samples, record.unit)
    accelerations = [_in_si(source, samples, record.unit) for samples in held]
    return Motion.of_samples(record.time_step, *accelerations), doubts


def _read(entry: Format, source: Source, request: Request) -> Record | StoredMotion:
    if entry.own:
        return entry.read(source, request)
    try:
        record = entry.read(source, request)
        return _checked(record)
    except RockframeError:
        raise
    except Exception as problem:
        # a reader that a user added: any exception means a file that it cannot read
        raise added_reader_error(source, entry, problem) from problem


def _checked(record: object) -> Record:
    if not isinstance(record, Record):
        msg = f"it returned {type(record).__name__}, not a Record"
        raise TypeError(msg)
    if not isinstance(cast("object", record.unit), RecordUnit) or not record.unit.factor > 0.0:
        msg = f"its unit is {record.unit!r}"
        raise TypeError(msg)
    step = cast("object", record.time_step)
    if isinstance(step, bool) or not isinstance(step, int | float):
        msg = f"its time_step is {step!r}"
        raise TypeError(msg)
    samples = _checked_samples(record.samples)
    vertical = None if record.vertical is None else _checked_samples(record.vertical)
    if vertical is not None and vertical.size != samples.size:
        msg = f"its components have {samples.size} and {vertical.size} samples"
        raise ValueError(msg)
    for key, value in record.metadata.items():
        plain = isinstance(cast("object", value), str | int | float)
        if not plain or (isinstance(value, float) and not math.isfinite(value)):
            msg = f"its metadata {key!r} is neither a string nor a number"
            raise TypeError(msg)
    return replace(record, samples=samples, vertical=vertical)


def _checked_samples(value: object) -> Array:
    samples = np.asarray(value, dtype=np.float64)
    if samples.ndim != 1 or not 2 <= samples.size <= MAXIMUM_SAMPLES:
        msg = f"its samples have the shape {samples.shape}"
        raise ValueError(msg)
    if not np.isfinite(samples).all():
        msg = "its samples are not all finite"
        raise ValueError(msg)
    return samples


def _in_si(source: Source, samples: Array, unit: RecordUnit) -> Array:
    with np.errstate(over="ignore"):
        acceleration = samples * unit.factor
    if not np.isfinite(acceleration).all():
        raise source.refuse(found="accelerations that overflow", expected="finite accelerations")
    return acceleration
