"""Motions that this package has stored by ``to_dataset().to_netcdf(path)``.

The motion is read without loss, with its name, metadata and history. Nothing is added: the
metadata still have the name and digest of the file from which the motion was first read.
"""

import json
import math
from collections.abc import Container, Generator, Mapping
from contextlib import contextmanager
from typing import Any, Final, cast

import numpy as np
import xarray as xr

from rockframe.errors import ComponentError, SchemaError
from rockframe.records.checks import check_requested_time_step
from rockframe.records.components import FileComponent, choose_component, orientation_of
from rockframe.records.reader import (
    Format,
    Record,
    Request,
    Source,
    StoredMotion,
    damaged_file_errors,
    wrong_beginning_error,
)
from rockframe.records.unit_names import RecordUnit
from rockframe.signals import Motion, Signal
from rockframe.signals.arrays import OWNER, Array
from rockframe.signals.motion import VERTICAL
from rockframe.units import Unit

LONG_NAMES: Final = {
    "acceleration": "horizontal ground acceleration",
    "vertical_acceleration": "vertical ground acceleration, upwards",
    "acceleration_pieces": "polynomials of the horizontal ground acceleration between samples",
    "vertical_acceleration_pieces": (
        "polynomials of the vertical ground acceleration between samples"
    ),
}
_MAGIC: Final = (b"CDF\x01", b"CDF\x02", b"CDF\x05", b"\x89HDF\r\n\x1a\n")
_VARIABLES: Final = ("time", *LONG_NAMES)
_MAX_NUMBERS: Final = 4_000_000
_MAX_VARIABLES: Final = 100
_EXPECTED: Final = "a motion as GroundMotion.to_dataset().to_netcdf(...) writes it"
_SI: Final = RecordUnit("m/s^2", 1.0)
_EVEN: Final = 1e-6
_UNEVEN: Final = 0.01
"""Greatest deviation of a time over the duration, and over the time step, which add up [1]."""
_OF_SUITES: Final = "sample_count"
_A_SUITE: Final = "a suite of motions"
_ONE_MOTION: Final = "one motion; rockframe.read_suite reads suites"
_A_MOTION: Final = "a dataset of GroundMotion.to_dataset"
_RESULT_ATTRIBUTE: Final = "system_json"
_OF_A_RESULT: Final = (
    "a motion; the motion of a result is "
    "rockframe.System.from_dataset(xarray.open_dataset(path)).motion"
)


class NoMotionError(SchemaError):
    """A dataset does not contain a motion."""

    def __init__(self, found: str, expected: str = _A_MOTION) -> None:
        self.found = found
        self.expected = expected
        super().__init__(found, expected)

    def __str__(self) -> str:
        return f"found {self.found}; expected {self.expected}"


def check_no_result(attributes: Container[str]) -> None:
    """Refuse a dataset that is the result of a system, by its attributes."""
    if _RESULT_ATTRIBUTE in attributes:
        found = "the result of a system"
        raise NoMotionError(found, _OF_A_RESULT)


def is_netcdf(source: Source) -> bool:
    """Tell whether the file begins like a netCDF or HDF5 file."""
    return source.data.startswith(_MAGIC)


@contextmanager
def opened_netcdf(source: Source, expected: str) -> Generator[Any]:
    """Open a netCDF file in memory; refuse a damaged one."""
    import netCDF4

    with (
        damaged_file_errors(source, "a netCDF file", expected),
        netCDF4.Dataset("in memory", memory=source.data) as file,
    ):
        yield file


def _read(source: Source, request: Request) -> StoredMotion:
    if not is_netcdf(source):
        raise wrong_beginning_error(source, _EXPECTED)
    stored = _stored(source)
    _compare(source, request, stored)
    return stored


def _stored(source: Source) -> StoredMotion:
    from xarray.backends import NetCDF4DataStore

    try:
        # checked before xarray loads the axes: a file may declare more than it contains
        with opened_netcdf(source, _EXPECTED) as file:
            check_no_result(file.ncattrs())
            if _OF_SUITES in file.variables:
                raise NoMotionError(_A_SUITE, _ONE_MOTION)
            _check_declared(source, file.variables)
            # not decoded: the numbers as they were written
            dataset = xr.open_dataset(NetCDF4DataStore(file), decode_cf=False)
            held = [name for name in _VARIABLES if name in file.variables]
            stored = stored_motion(dataset[held].load())
    except NoMotionError as problem:
        raise source.refuse(found=problem.found, expected=problem.expected) from problem
    for key, value in cast("dict[str, Any]", stored.metadata).items():
        finite = not isinstance(value, float) or math.isfinite(value)
        if isinstance(value, bool) or not isinstance(value, str | int | float) or not finite:
            found = f"the metadata {key!r} of the motion, {value!r}"
            raise source.refuse(found=found, expected="strings and numbers")
    return stored


def _check_declared(source: Source, variables: Mapping[str, Any]) -> None:
    if len(variables) > _MAX_VARIABLES:
        found = f"{len(variables)} variables"
        raise source.refuse(found=found, expected=_EXPECTED)
    # of all variables: others are axes of those that are read, or not of this package
    total = sum(math.prod(map(int, variable.shape)) for variable in variables.values())
    if total > _MAX_NUMBERS:
        expected = f"a motion of at most {_MAX_NUMBERS} numbers in all"
        raise source.refuse(found=f"{total} numbers declared", expected=expected)
    for name in _VARIABLES:
        kind = variables[name].datatype if name in variables else np.dtype(np.float64)
        if not isinstance(kind, np.dtype) or kind.kind not in "fiu":
            found = f"a variable {name!r} without numbers"
            raise source.refuse(found=found, expected=_EXPECTED)


def _compare(source: Source, request: Request, stored: StoredMotion) -> None:
    check_requested_time_step(source, request, stored.si.time_step, None)
    if request.unit is not None and not math.isclose(request.unit.factor, 1.0):
        found = "a stored motion in m/s^2"
        expected = f"accelerations in the unit {request.unit_name!r} of the argument unit"
        raise source.refuse(found=found, expected=expected)
    if request.component is None:
        return
    keys = ("component",) if stored.si.vertical is None else ("component", "vertical_component")
    values = [stored.metadata.get(key) for key in keys]
    names = [None if name is None else str(name) for name in values]
    nothing = Record(stored.si.time_step, np.zeros(2), _SI, {})
    components = [
        FileComponent(name, lambda: nothing, orientation_of(name or "")) for name in names
    ]
    choose_component(source, request, components)


def stored_motion(dataset: xr.Dataset) -> StoredMotion:
    """Read the parts of a motion from the result of :func:`to_dataset`."""
    check_no_result(dataset.attrs)
    for name in ("acceleration", "time"):
        if name not in dataset.variables:
            found = f"no variable {name!r}"
            raise NoMotionError(found)
    attributes: dict[str, Any] = {str(key): value for key, value in dataset.attrs.items()}
    try:
        arrays: Any = [_values(dataset, name) for name in LONG_NAMES]
        si = motion_of_arrays(_time_step(dataset, attributes), *arrays)
    except (ComponentError, TypeError, ValueError) as problem:
        if isinstance(problem, SchemaError):
            raise
        found = f"a dataset that holds no ground motion: {problem}"
        raise NoMotionError(found) from problem
    written = attributes.get("motion_sha256")
    if written is not None and written != si.digest:
        found = "samples that differ from those of the digest 'motion_sha256'"
        expected = "the same; delete this attribute if they were changed on purpose"
        raise NoMotionError(found, expected)
    history = str(attributes.get("history", ""))
    return StoredMotion(
        si,
        str(attributes["motion_name"]) if "motion_name" in attributes else None,
        _mapping(attributes, "metadata") or {},
        tuple(history.split("\n")) if history else (),
        # without the digest the recipe may no longer give these samples
        None if written is None else _mapping(attributes, "recipe"),
    )


def stored_arrays(si: Motion) -> dict[str, Array | None]:
    """Return samples and polynomials of both components, by the names of stored variables."""
    vertical = si.vertical
    return {
        "acceleration": si.horizontal.samples,
        "vertical_acceleration": None if vertical is None else vertical.samples,
        "acceleration_pieces": si.horizontal.polynomials,
        "vertical_acceleration_pieces": None if vertical is None else vertical.polynomials,
    }


def motion_of_arrays(
    time_step: float,
    samples: Array,
    vertical: Array | None,
    pieces: Array | None,
    vertical_pieces: Array | None,
) -> Motion:
    """Build a motion from the arrays of :func:`stored_arrays`."""
    horizontal = Signal(time_step, samples, pieces)
    if vertical is not None:
        return Motion(horizontal, Signal(time_step, vertical, vertical_pieces, name=VERTICAL))
    if vertical_pieces is not None:
        msg = f"{OWNER}: vertical_pieces without vertical samples"
        raise ComponentError(msg)
    return Motion(horizontal)


def _values(dataset: xr.Dataset, name: str) -> Array | None:
    if name not in dataset.variables:
        return None
    variable = dataset[name]
    unit = variable.attrs.get("units")
    if unit != str(Unit.METRE_PER_SECOND_SQUARED):
        expected = str(Unit.METRE_PER_SECOND_SQUARED)
        found = f"{name!r} in units {unit!r}"
        raise NoMotionError(found, repr(expected))
    return np.asarray(variable.values, dtype=np.float64)


def _time_step(dataset: xr.Dataset, attributes: Mapping[str, Any]) -> float:
    time = np.asarray(dataset["time"].values)
    if time.dtype.kind == "m":  # as some versions of xarray decode seconds
        time = time / np.timedelta64(1, "s")
    stated = "time_step" in attributes
    if time.size < 2 and not stated:
        found = "fewer than two times"
        raise NoMotionError(found, "a sampled motion")
    duration = float(time[-1] - time[0])
    step = float(attributes["time_step"]) if stated else duration / (time.size - 1)
    even = time[0] + step * np.arange(time.size)
    tolerance = _UNEVEN * step + _EVEN * abs(duration)
    if step > 0.0 and not np.allclose(time, even, rtol=0.0, atol=tolerance):
        if not stated:
            found = "an uneven time axis"
            raise NoMotionError(found, "a uniform time step")
        found = f"times that do not have the step of the attribute 'time_step', {step!r} s"
        expected = "the same; delete this attribute if they were changed on purpose"
        raise NoMotionError(found, expected)
    return step


def _mapping(attributes: Mapping[str, Any], name: str) -> dict[str, Any] | None:
    text = attributes.get(name)
    if text is None:
        return None
    try:
        loaded: object = json.loads(str(text))
    except ValueError as problem:
        found = f"an attribute {name!r} that is not JSON"
        raise NoMotionError(found) from problem
    if not isinstance(loaded, dict):
        found = f"an attribute {name!r} that is not a JSON object"
        raise NoMotionError(found)
    return cast("dict[str, Any]", loaded)


NETCDF: Final = Format(
    "netcdf",
    "netCDF file of a motion, written by rockframe",
    (".nc",),
    is_netcdf,
    _read,
    binary=True,
    holds="one, or one and the vertical",
    unit="m/s²",
)
