"""A ground motion as a labelled dataset, and back, bit for bit."""

from __future__ import annotations

import json
from collections.abc import Container, Mapping
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np
import xarray as xr

from rockframe.arguments import checked_dataset
from rockframe.constants import CONVENTIONS
from rockframe.errors import ComponentError, SchemaError
from rockframe.signals import Motion, Signal
from rockframe.signals.arrays import OWNER, Array
from rockframe.signals.signal import VERTICAL
from rockframe.units import Unit

if TYPE_CHECKING:
    from rockframe.motion.value import Made, MotionValue

LONG_NAMES: Final = {
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
    """A dataset that holds no motion."""

    def __init__(self, found: str, expected: str = _A_MOTION) -> None:
        self.found = found
        self.expected = expected
        super().__init__(found, expected)

    def __str__(self) -> str:
        return f"found {self.found}; expected {self.expected}"


def check_no_result(attributes: Container[str]) -> None:
    """Refuse the result of a system, by the attributes of its dataset."""
    if _RESULT_ATTRIBUTE in attributes:
        found = "the result of a system"
        raise NoMotionError(found, _OF_A_RESULT)


def to_dataset(motion: MotionValue) -> xr.Dataset:
    """Write the motion as a dataset that plain xarray can store.

    Returns
    -------
    xarray.Dataset
        ``acceleration`` (and ``vertical_acceleration``) over ``time``, with
        units, name, metadata and history.
    """
    si = motion.si
    components = {"acceleration": si.horizontal, "vertical_acceleration": si.vertical}
    present = {name: signal for name, signal in components.items() if signal is not None}
    held = {name: signal.samples for name, signal in present.items()} | {
        f"{name}_pieces": signal.polynomials for name, signal in present.items()
    }
    variables: dict[str, Any] = {
        name: (
            "time" if values.ndim == 1 else _PIECES_DIMS,
            values.copy(),
            {"units": str(Unit.METRE_PER_SECOND_SQUARED), "long_name": LONG_NAMES[name]},
        )
        for name, values in held.items()
        if values is not None
    }
    time = np.arange(len(motion)) * si.time_step
    # no axis and no standard name: CF 4.4 keeps them for times since a date
    axis = {"units": str(Unit.SECOND), "long_name": "time from the first sample"}
    attributes: dict[str, str | float] = {
        "Conventions": CONVENTIONS,
        "title": f"Ground motion {motion.name}",
        "motion_name": motion.name,
        "motion_sha256": motion.sha256,
        "time_step": si.time_step,
        "metadata": json.dumps(dict(motion.metadata)),
    }
    if motion.history:
        attributes["history"] = "\n".join(motion.history)
    if motion.recipe is not None:
        attributes["recipe"] = json.dumps(dict(motion.recipe))
    dataset = xr.Dataset(variables, coords={"time": ("time", time, axis)}, attrs=attributes)
    for name in (*variables, "time"):
        dataset[name].encoding["_FillValue"] = None
    return dataset


def from_dataset(kind: type[Made], dataset: xr.Dataset) -> Made:
    """Read what :meth:`to_dataset` wrote, bit for bit.

    Parameters
    ----------
    dataset : xarray.Dataset
        With ``acceleration`` over ``time``.

    Returns
    -------
    GroundMotion

    Raises
    ------
    SchemaError
        Not such a dataset, or its samples were changed since.
    """
    return kind(**stored_motion(checked_dataset(dataset, owner=f"{kind.__name__}.from_dataset")))


def stored_motion(dataset: xr.Dataset) -> dict[str, Any]:
    """Read what :func:`to_dataset` wrote, part by part."""
    check_no_result(dataset.attrs)
    for name in ("acceleration", "time"):
        if name not in dataset.variables:
            found = f"no variable {name!r}"
            raise NoMotionError(found)
    attributes: dict[str, Any] = {str(key): value for key, value in dataset.attrs.items()}
    try:
        si = _motion(dataset, _time_step(dataset, attributes))
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


def _motion(dataset: xr.Dataset, time_step: float) -> Motion:
    across, upwards = (_values(dataset, name) for name in ("acceleration", "vertical_acceleration"))
    pieces, vertical_pieces = (
        _values(dataset, name) for name in ("acceleration_pieces", "vertical_acceleration_pieces")
    )
    horizontal = Signal(time_step, cast("Array", across), pieces)
    if upwards is not None:
        return Motion(horizontal, Signal(time_step, upwards, vertical_pieces, name=VERTICAL))
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
