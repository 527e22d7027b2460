"""Motions that this package wrote itself: ``to_dataset().to_netcdf(path)``.

The motion comes back as it was, to the last bit, with its own name, metadata and
history. Nothing of the file is added to them: the metadata still name the file and
the digest that the motion was first read from.
"""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np
import xarray as xr

from rockframe.errors import RecordError
from rockframe.motion.readers.checks import check_asked_time_step
from rockframe.motion.readers.components import FileComponent, choose_component
from rockframe.motion.readers.orientation import UNKNOWN, orientation_of
from rockframe.motion.readers.source import Record, Request, Source, StoredMotion
from rockframe.motion.unit_names import RecordUnit

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rockframe.signals import Motion

NAME: Final = "netcdf"
TITLE: Final = "netCDF file of a motion, written by rockframe"
SUFFIXES: Final = (".nc",)
BINARY: Final = True

_MAGIC: Final = (b"CDF\x01", b"CDF\x02", b"CDF\x05", b"\x89HDF\r\n\x1a\n")
_VARIABLES: Final = (
    "time",
    "acceleration",
    "vertical_acceleration",
    "acceleration_pieces",
    "vertical_acceleration_pieces",
)
_MOST_NUMBERS: Final = 4_000_000
_MOST_VARIABLES: Final = 100
_EXPECTED: Final = "a motion as GroundMotion.to_dataset().to_netcdf(...) writes it"
_SI: Final = RecordUnit("m/s^2", 1.0)


def recognises(source: Source) -> bool:
    """Tell whether the file begins as netCDF or HDF5 files do."""
    return source.data.startswith(_MAGIC)


def read(source: Source, request: Request) -> StoredMotion:
    """Read a motion that was stored."""
    if not recognises(source):
        found = f"a file that begins with {source.data[:8]!r}"
        raise source.refuse(found=found, expected=_EXPECTED)
    stored = _stored(source)
    _compare(source, request, stored)
    return stored


def _stored(source: Source) -> StoredMotion:
    import netCDF4
    from xarray.backends import NetCDF4DataStore

    from rockframe.motion.dataset import NoMotionError, check_no_result, stored_motion

    try:
        with warnings.catch_warnings():
            # nothing that a damaged file makes the libraries say is of use
            warnings.simplefilter("ignore")
            # before xarray, which loads the axes at once: a file may declare more than it holds
            with netCDF4.Dataset("in memory", memory=source.data) as file:
                check_no_result(file.ncattrs())
                _check_declared(source, file.variables)
                # undecoded: the numbers as they were written
                dataset = xr.open_dataset(NetCDF4DataStore(file), decode_cf=False)
                arguments = stored_motion(_only_motion(dataset).load())
    except RecordError:
        raise
    except NoMotionError as problem:
        raise source.refuse(found=problem.found, expected=problem.expected) from problem
    except Exception as problem:
        # the libraries fail on damaged files in ways that they do not document
        found = f"a netCDF file that cannot be read ({type(problem).__name__})"
        raise source.refuse(found=found, expected=_EXPECTED) from problem
    si = cast("Motion", arguments["si"])
    metadata = cast("dict[str, Any]", arguments["metadata"])
    for key, value in metadata.items():
        finite = not isinstance(value, float) or math.isfinite(value)
        if isinstance(value, bool) or not isinstance(value, str | int | float) or not finite:
            found = f"the metadata {key!r} of the motion, {value!r}"
            raise source.refuse(found=found, expected="strings and numbers")
    return StoredMotion(
        si,
        arguments.get("name"),
        metadata,
        tuple(arguments["history"]),
        arguments["recipe"],
    )


def _only_motion(dataset: Any) -> Any:
    return dataset[[name for name in _VARIABLES if name in dataset.variables]]


def _check_declared(source: Source, variables: Mapping[str, Any]) -> None:
    if len(variables) > _MOST_VARIABLES:
        found = f"{len(variables)} variables"
        raise source.refuse(found=found, expected=_EXPECTED)
    # of all variables: those that are not read are axes of those that are, or nothing of ours
    total = sum(math.prod(map(int, variable.shape)) for variable in variables.values())
    if total > _MOST_NUMBERS:
        expected = f"a motion of at most {_MOST_NUMBERS} numbers in all"
        raise source.refuse(found=f"{total} numbers declared", expected=expected)
    for name in _VARIABLES:
        kind = variables[name].datatype if name in variables else np.dtype(np.float64)
        if not isinstance(kind, np.dtype) or kind.kind not in "fiu":
            found = f"a variable {name!r} that holds no numbers"
            raise source.refuse(found=found, expected=_EXPECTED)


def _compare(source: Source, request: Request, stored: StoredMotion) -> None:
    check_asked_time_step(source, request, stored.si.time_step, None)
    if request.unit is not None and not math.isclose(request.unit.factor, 1.0):
        found = "a stored motion in m/s^2"
        expected = f"accelerations in the unit {request.unit_name!r} that was asked for"
        raise source.refuse(found=found, expected=expected)
    if request.component is None:
        return
    components = [
        _placeholder(stored, key)
        for key, signal in (
            ("component", stored.si.horizontal),
            ("vertical_component", stored.si.vertical),
        )
        if signal is not None
    ]
    choose_component(source, request, components)


def _placeholder(stored: StoredMotion, key: str) -> FileComponent:
    given = stored.metadata.get(key)
    name = None if given is None else str(given)
    record = Record(stored.si.time_step, np.zeros(2), _SI, {})
    direction = UNKNOWN if name is None else orientation_of(name)
    return FileComponent(name, lambda: record, direction)
