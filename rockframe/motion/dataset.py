"""A ground motion as a labelled dataset, and back, bit for bit."""

from __future__ import annotations

import json
from collections.abc import Container, Mapping
from typing import TYPE_CHECKING, Any, Final, TypeAlias, cast

import numpy as np
import xarray as xr

from rockframe.errors import ComponentError, SchemaError
from rockframe.motion.samples import Array, MotionSI
from rockframe.units import Unit

if TYPE_CHECKING:
    from rockframe.motion.value import MotionValue

Recipe: TypeAlias = "Mapping[str, str | float] | None"

_LONG_NAMES: Final = {
    "acceleration": "horizontal ground acceleration",
    "vertical_acceleration": "vertical ground acceleration, upwards",
    "acceleration_pieces": "polynomials of the horizontal ground acceleration between samples",
    "vertical_acceleration_pieces": (
        "polynomials of the vertical ground acceleration between samples"
    ),
}
_PIECES_DIMS: Final = ("interval", "power")
_EVEN: Final = 1e-6
_A_MOTION: Final = "a dataset of GroundMotion.to_dataset"
_RESULT_ATTRIBUTE: Final = "system_json"
_OF_A_RESULT: Final = (
    "a motion; the motion of a result is "
    "rockframe.System.from_dataset(xarray.open_dataset(path)).motion"
)


class NoMotionError(SchemaError):
    """A dataset that holds no motion.

    Parameters
    ----------
    found, expected : str
        As of a :class:`~rockframe.RecordError`, which names the file besides.
    """

    def __init__(self, found: str, expected: str = _A_MOTION) -> None:
        self.found = found
        self.expected = expected
        super().__init__(found, expected)

    def __str__(self) -> str:
        return f"found {self.found}; expected {self.expected}"


def check_no_result(attributes: Container[str]) -> None:
    """Refuse the result of a system, by the attributes of its dataset.

    Raises
    ------
    NoMotionError
        It is one.
    """
    if _RESULT_ATTRIBUTE in attributes:
        found = "the result of a system"
        raise NoMotionError(found, _OF_A_RESULT)


def to_dataset(motion: MotionValue, recipe: Recipe) -> xr.Dataset:
    """Write a motion as a dataset.

    Parameters
    ----------
    motion : MotionValue
        Motion.
    recipe : mapping or None
        Constructor and arguments of an analytic motion.

    Returns
    -------
    xarray.Dataset
    """
    si = motion.si
    held = {
        "acceleration": si.acceleration,
        "vertical_acceleration": si.vertical,
        "acceleration_pieces": si.pieces,
        "vertical_acceleration_pieces": si.vertical_pieces,
    }
    variables: dict[str, Any] = {
        name: (
            "time" if values.ndim == 1 else _PIECES_DIMS,
            values.copy(),
            {"units": str(Unit.METRE_PER_SECOND_SQUARED), "long_name": _LONG_NAMES[name]},
        )
        for name, values in held.items()
        if values is not None
    }
    time = np.arange(len(motion)) * si.time_step
    axis = {"units": str(Unit.SECOND), "long_name": "time", "axis": "T"}
    attributes: dict[str, str | float] = {
        "Conventions": "CF-1.11",
        "title": f"Ground motion {motion.name}",
        "motion_name": motion.name,
        "motion_sha256": motion.sha256,
        "time_step": si.time_step,
        "metadata": json.dumps(dict(motion.metadata)),
    }
    if motion.history:
        attributes["history"] = "\n".join(motion.history)
    if recipe is not None:
        attributes["recipe"] = json.dumps(dict(recipe))
    dataset = xr.Dataset(variables, coords={"time": ("time", time, axis)}, attrs=attributes)
    for name in (*variables, "time"):
        dataset[name].encoding["_FillValue"] = None
    return dataset


def from_dataset(dataset: xr.Dataset) -> dict[str, Any]:
    """Read what :func:`to_dataset` wrote.

    Parameters
    ----------
    dataset : xarray.Dataset
        With ``acceleration`` over ``time``; the rest as far as it is there.

    Returns
    -------
    dict
        Arguments of the motion's constructor.

    Raises
    ------
    SchemaError
        A variable is missing, in another unit or of another shape, or the
        samples are not those that the digest was written for.
    """
    check_no_result(dataset.attrs)
    for name in ("acceleration", "time"):
        if name not in dataset.variables:
            found = f"no variable {name!r}"
            raise NoMotionError(found)
    attributes: dict[str, Any] = {str(key): value for key, value in dataset.attrs.items()}
    try:
        si = MotionSI(
            time_step=_time_step(dataset, attributes),
            acceleration=cast("Array", _values(dataset, "acceleration")),
            vertical=_values(dataset, "vertical_acceleration"),
            pieces=_values(dataset, "acceleration_pieces"),
            vertical_pieces=_values(dataset, "vertical_acceleration_pieces"),
        )
    except (ComponentError, TypeError, ValueError) as problem:
        if isinstance(problem, SchemaError):
            raise
        found = f"a dataset that holds no ground motion: {problem}"
        raise NoMotionError(found) from problem
    written = attributes.get("motion_sha256")
    if written is not None and written != si.digest():
        found = "samples that differ from those the attribute 'motion_sha256' was written for"
        expected = "the same; delete the attribute if they were changed on purpose"
        raise NoMotionError(found, expected)
    history = str(attributes.get("history", ""))
    arguments: dict[str, Any] = {
        "si": si,
        "metadata": _mapping(attributes, "metadata") or {},
        "history": tuple(history.split("\n")) if history else (),
        # without the digest nothing says that the recipe still gives these samples
        "recipe": None if written is None else _mapping(attributes, "recipe"),
    }
    if "motion_name" in attributes:
        arguments["name"] = str(attributes["motion_name"])
    return arguments


def _values(dataset: xr.Dataset, name: str) -> Array | None:
    if name not in dataset.variables:
        return None
    variable = dataset[name]
    unit = variable.attrs.get("units")
    if unit != str(Unit.METRE_PER_SECOND_SQUARED):
        wanted = str(Unit.METRE_PER_SECOND_SQUARED)
        found = f"{name!r} in units {unit!r}"
        raise NoMotionError(found, repr(wanted))
    return np.asarray(variable.values, dtype=np.float64)


def _time_step(dataset: xr.Dataset, attributes: Mapping[str, Any]) -> float:
    if "time_step" in attributes:
        return float(attributes["time_step"])
    time = np.asarray(dataset["time"].values, dtype=np.float64)
    if time.size < 2:
        found = "fewer than two times"
        raise NoMotionError(found, "a sampled motion")
    step = float((time[-1] - time[0]) / (time.size - 1))
    if not np.all(np.abs(np.diff(time) - step) <= _EVEN * abs(step)):
        found = "an uneven time axis"
        raise NoMotionError(found, "a uniform time step")
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
