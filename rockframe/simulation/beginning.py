"""How a run begins: as an initial state tells, or where another run ended."""

import json
import math
from collections.abc import Mapping
from typing import Any, TypeAlias, cast

import numpy as np
import xarray as xr

from rockframe.components import InitialState
from rockframe.dynamics.protocol import Ending, Start
from rockframe.results.outcome import verdict_of
from rockframe.results.schema import SCHEMA_VERSION
from rockframe.system.assembly import Assembly

_ATTRIBUTE = "end_state"


Beginning: TypeAlias = InitialState | Ending
"""An initial state, or the end of another run of the same system."""


def start_of(beginning: Beginning) -> Start | Ending:
    """Give a beginning as the integrator takes it."""
    if isinstance(beginning, Ending):
        return beginning
    si = beginning.si
    return Start(si.rotation, si.angular_velocity, si.vertical_displacement, si.vertical_velocity)


def beginning_to_dict(beginning: Beginning) -> dict[str, Any]:
    """Give a beginning as plain values, fit for JSON."""
    if isinstance(beginning, Ending):
        return {"type": "Continuation", "ending": _plain(beginning)}
    return beginning.to_dict()


def end_attributes(ending: Ending) -> dict[str, str]:
    """Give the end of a run as an attribute that a later run can begin with."""
    return {_ATTRIBUTE: json.dumps(_plain(ending))}


def continuation_of(dataset: xr.Dataset, system: Assembly, faults: list[str]) -> Beginning:
    """Read where a run ended, or note why none can go on from there."""
    attributes: Mapping[str, Any] = cast("Mapping[str, Any]", dataset.attrs)
    if _ATTRIBUTE not in attributes or "system_json" not in attributes:
        faults.append("initial is a dataset that holds no end of a run; expected one of simulate()")
        return InitialState()
    if attributes.get("schema_version") != SCHEMA_VERSION:
        faults.append(
            f"initial is the end of a run of rockframe {attributes.get('rockframe_version')}, "
            "which kept states in another way; run it again"
        )
    stored: dict[str, Any] = json.loads(attributes[_ATTRIBUTE])
    ending = Ending(
        stored["mode"],
        np.array(stored["state"], dtype=np.float64),
        np.array(stored["memory"], dtype=np.float64),
    )
    passed = not math.isnan(float(attributes.get("overturning_time", math.nan)))
    if json.loads(attributes["system_json"]) != system.to_dict():
        faults.append("initial is the end of a run of another system")
    elif passed and not _came_back(dataset, system, ending):
        faults.append("initial is the end of a run that overturned")
    return ending


def _came_back(dataset: xr.Dataset, system: Assembly, ending: Ending) -> bool:
    """Whether a run that passed the overturning angle stands, and ends within it."""
    rotation = system.model.rotation_in(ending.state)
    within = abs(rotation) < system.setting.overturning_angles.on_side_of(rotation)
    return within and "status" in dataset and verdict_of(dataset) is False


def _plain(ending: Ending) -> dict[str, Any]:
    return {
        "mode": ending.mode,
        "state": ending.state.tolist(),
        "memory": ending.memory.tolist(),
    }
