"""Attributes of a result that describe its motion and system, and rebuilding of both from them."""

import json
from collections.abc import Iterable, Mapping
from enum import StrEnum
from typing import Any, Final

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rockframe.arguments import checked_mapping, json_attribute
from rockframe.components import Component, InitialState, component_from_dict
from rockframe.errors import RecordWarning, SchemaError, did_you_mean, short_repr, warn
from rockframe.motion import GroundMotion
from rockframe.motion.display import HISTORY_SEPARATOR
from rockframe.solve.accuracy import Accuracy
from rockframe.units import TIME, Unit, quantity_text

_AFTER_END: Final = "_after_end"
"""Suffix of the names of samples of the motion that follow the histories."""


class Changes(StrEnum):
    """What the values of an axis of a sweep change."""

    PART = "part"
    OPTION = "option"
    MOTION = "motion"
    START = "start"
    ARGUMENT = "argument"


SYSTEM_AXES: Final = (Changes.PART, Changes.OPTION, Changes.ARGUMENT)
"""What changes the system."""


def motion_attributes(motion: GroundMotion | None) -> dict[str, str | float | int]:
    """Return attributes by which a motion can be recognised and, where possible, rebuilt."""
    if motion is None:
        return {"motion": "none"}
    numbers = motion.si
    return {
        "motion": motion.name,
        "motion_sha256": numbers.digest,
        "motion_time_step": numbers.time_step,
        "motion_samples": int(numbers.horizontal.samples.size),
        "motion_json": json.dumps(motion.to_dict()),
        "motion_history": HISTORY_SEPARATOR.join(motion.history),
    }


def system_text(dataset: xr.Dataset, *, owner: str) -> str:
    """Return the JSON text of a result's system; refuse a case of a sweep that changes it."""
    of_system = json_attribute(
        dataset,
        "axes_json",
        lambda axes: [str(axis["name"]) for axis in axes if axis["changes"] in SYSTEM_AXES],
        owner=owner,
        default="[]",
    )
    changed = [name for name in of_system if name in dataset.coords and not dataset[name].dims]
    if changed:
        msg = (
            f"the dataset is of a part of a sweep over {', '.join(changed)}, whose system need not "
            "be the one that was swept; rf.case(dataset).system is that of a case"
        )
        raise SchemaError(msg)
    text = dataset.attrs.get("system_json")
    if not isinstance(text, str):
        msg = "the dataset has no attribute 'system_json'; expected a result of simulate()"
        raise SchemaError(msg)
    return text


def motion_after_end(
    motion: GroundMotion | None, histories: Mapping[str, NDArray[Any]]
) -> dict[str, NDArray[Any]]:
    """Return the samples of a motion that the histories lack since the run ended early.

    With them the result contains a motion that is given by samples alone.
    """
    if motion is None or motion.recipe is not None or "time" not in histories:
        return {}
    count = _count_on_samples(histories["time"], motion.si.time_step)
    if count < min(len(histories["time"]) - 1, len(motion)) or count >= len(motion):
        return {}
    both = {"ground": motion.si.horizontal, "vertical_ground": motion.si.vertical}
    return {
        f"{name}_acceleration{_AFTER_END}": signal.samples[count:].copy()
        for name, signal in both.items()
        if signal is not None
    }


def _count_on_samples(time: NDArray[Any], step: float) -> int:
    """Count the leading times of histories that coincide with samples of a motion."""
    same = time == np.arange(len(time)) * step
    return len(time) if bool(same.all()) else int(np.argmin(same))


def motion_from_dataset(dataset: xr.Dataset) -> GroundMotion | None:
    """Return the motion of a result: rebuilt from its description, or read from the histories."""
    text = dataset.attrs.get("motion_json")
    if text is None:
        return None
    description = json.loads(text)
    if description.get("constructor"):
        return GroundMotion.from_dict(description)
    motion, reason = _from_histories(dataset)
    if motion is None:
        warn(
            f"the motion {dataset.attrs['motion']!r} (sha256 "
            f"{str(dataset.attrs['motion_sha256'])[:12]}...) cannot be had from this dataset: "
            f"{reason}; the system comes without a motion, give it to simulate()",
            RecordWarning,
        )
    return motion


def _from_histories(dataset: xr.Dataset) -> tuple[GroundMotion | None, str]:
    """Read a motion from the histories, or say why that cannot be done."""
    step = float(dataset.attrs["motion_time_step"])
    count = int(dataset.attrs["motion_samples"])
    if "time" not in dataset or "ground_acceleration" not in dataset:
        return None, "it holds no history of the ground acceleration"
    time = dataset["time"].to_numpy()
    common = min(count, _count_on_samples(time, step))
    rest = f"ground_acceleration{_AFTER_END}"
    if common < min(count, len(time) - (rest in dataset)):
        return None, f"its times are not the motion's samples, {step:g} s apart from zero"
    if common + (dataset[rest].size if rest in dataset else 0) < count:
        return None, f"its histories end before the motion, which has {count} samples"
    unit = str(Unit.METRE_PER_SECOND_SQUARED)
    components = {
        name: (_joined(dataset, variable, common), unit)
        for name, variable in (
            ("acceleration", "ground_acceleration"),
            ("vertical", "vertical_ground_acceleration"),
        )
        if variable in dataset
    }
    motion = GroundMotion.from_arrays(
        time_step=quantity_text(step, TIME), name=str(dataset.attrs["motion"]), **components
    )
    if motion.sha256 != dataset.attrs["motion_sha256"]:
        return None, "its ground acceleration is not what the run had"
    return motion, ""


def _joined(dataset: xr.Dataset, name: str, count: int) -> NDArray[Any]:
    """Return a component of a motion: samples of the histories, and those after their end."""
    parts = [dataset[name].to_numpy()[:count]]
    if f"{name}{_AFTER_END}" in dataset:
        parts.append(dataset[f"{name}{_AFTER_END}"].to_numpy())
    return np.concatenate(parts)


def parts_and_options(
    description: object, arguments: Iterable[str]
) -> tuple[list[Component | GroundMotion], dict[str, Any]]:
    """Return the parts and options in a description of a system, which takes these arguments."""
    described = checked_mapping(
        description, owner="System", name="description", example="that of to_dict()"
    )
    value = described.get("motion")
    motion = [] if value is None else [GroundMotion.from_dict(value)]
    if "parts" not in described:
        msg = "found no 'parts'; expected a list of them, as to_dict() gives it"
        raise SchemaError(msg)
    known = [name for name in arguments if name != "parts"]
    allowed = (*known, "parts", "motion")
    strange = [
        f"{short_repr(name)}{did_you_mean(name, allowed)}"
        for name in described
        if name not in allowed
    ]
    if strange:
        msg = f"found {', '.join(strange)}; expected parts, motion, {', '.join(known)}"
        raise SchemaError(msg)
    options = {name: str(described[name]) for name in known if name in described}
    return [*map(component_from_dict, described["parts"]), *motion], options


def arguments_of_run(dataset: xr.Dataset) -> dict[str, Any]:
    """Return the arguments of the run that made a result, without `outputs`."""
    try:
        described = json.loads(dataset.attrs["run_json"])
        initial, accuracy = described["initial"], Accuracy(**described["accuracy"])
        if initial["type"] != InitialState.__name__:
            msg = "the run began where another run ended, of which only the end is known"
            raise SchemaError(msg)
        return {
            "duration": described["duration"],
            "initial": InitialState.from_dict(initial),
            "accuracy": accuracy,
            "overturning": described["overturning"],
        }
    except (KeyError, TypeError, ValueError) as problem:
        if isinstance(problem, SchemaError):
            raise
        msg = f"the dataset does not describe a run: {problem}"
        raise SchemaError(msg) from problem
