"""The table of a suite: what is known of each motion."""

import math
from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from rockframe.motion import GroundMotion
from rockframe.results.schema import SCHEMA
from rockframe.results.variables.suites import RECORDS

_COMPUTED: Final = ("time_step", "duration", "sample_count", "peak_ground_acceleration")
COLUMNS: Final = (*(row.name for row in RECORDS), "peak_ground_acceleration")
"""Columns that have a row in the schema, in order."""


def column(name: str, motion: GroundMotion) -> Any:
    """Give what is known of a motion."""
    if name in _COMPUTED:
        return _computed(name, motion)
    value = motion.metadata.get(name)
    if name == "azimuth" and isinstance(value, int | float):
        return math.radians(value)
    row = SCHEMA.get(name) if name in COLUMNS else None
    if row is not None and value is not None:
        return str(value) if row.dtype == "str" else _as_number(value)
    return value


def known_columns(motions: Mapping[str, GroundMotion]) -> dict[str, np.ndarray]:
    """Give the columns of the schema that are known of some motion."""
    found: dict[str, np.ndarray] = {}
    for name in COLUMNS:
        values = [column(name, motion) for motion in motions.values()]
        if all(value is None for value in values):
            continue
        kind = SCHEMA[name].dtype
        missing: Any = "" if kind == "str" else math.nan
        found[name] = np.array([missing if value is None else value for value in values])
    return found


def other_columns(motions: Mapping[str, GroundMotion]) -> dict[str, list[Any]]:
    """Give what else the files tell, by the keys of the metadata, None where they do not."""
    keys = dict.fromkeys(key for one in motions.values() for key in one.metadata)
    return {
        key: [one.metadata.get(key) for one in motions.values()]
        for key in keys
        if key not in COLUMNS
    }


def _computed(name: str, motion: GroundMotion) -> float | int:
    si = motion.si
    if name == "sample_count":
        return len(motion)
    return {"time_step": si.time_step, "duration": si.duration}.get(name, si.peak)


def _as_number(value: object) -> float | None:
    try:
        return float(str(value))
    except ValueError:
        return None
