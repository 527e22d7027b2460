"""Datasets that need no run: equilibrium at rest, quasi-static rotation, modes of small motion."""

import math
from collections.abc import Iterable

import numpy as np
import xarray as xr

from rockframe.dynamics.events import ContactState
from rockframe.errors import AssemblyError, ComponentError, short_repr
from rockframe.results.outcome import slope_attributes
from rockframe.results.schema import SCHEMA, Results, build_dataset
from rockframe.signals.arrays import AnyArray
from rockframe.system.assembly import Assembly
from rockframe.system.statics import vibration_modes
from rockframe.units import ANGLE, to_si_values


def equilibrium(system: Assembly) -> xr.Dataset:
    """Return settlements and reactions at rest, and the bounds of full contact."""
    setting = system.setting
    values: dict[str, float] = {
        name: value for name, value in setting.equilibrium().items() if name in SCHEMA
    }
    if setting.leans:
        left, right = setting.overturning_angles
        values |= {
            "left_overturning_angle": left,
            "right_overturning_angle": right,
            "rest_rotation": setting.rest_rotation,
        }
    values["overturning_angle"] = setting.overturning_angle
    values["uplift_angle"] = setting.uplift_angle
    return _labelled(system, values, "Rest", "vertical equilibrium")


def moment_rotation(system: Assembly, angles: object) -> xr.Dataset:
    """Return the quasi-static moments at given rotations."""
    held_at = to_si_values(angles, ANGLE, owner="moment_rotation", name="angles")
    if not len(held_at):
        msg = f"moment_rotation: angles must be one or more, got {short_repr(angles)}"
        raise ComponentError(msg)
    states = system.setting.held_at(held_at)
    values: dict[str, AnyArray] = {
        "angle": np.array(held_at),
        "restoring_moment": _column(state.restoring_moment for state in states),
        "base_moment": _column(state.base_moment for state in states),
        "held_vertical_displacement": _column(state.vertical_displacement for state in states),
        "held_contact_state": np.array(
            [ContactState[state.contact_state.upper()] for state in states]
        ),
    }
    for name in states[0].reactions if states else ():
        if f"held_{name}" in SCHEMA:
            values[f"held_{name}"] = _column(state.reactions[name] for state in states)
    return _labelled(system, values, "Moment and rotation", "vertical equilibrium")


def _column(numbers: Iterable[float]) -> AnyArray:
    return np.array(list(numbers)) + 0.0  # no negative zeros


def frequencies(system: Assembly) -> xr.Dataset:
    """Return the modes of small motion about rest."""
    motion = system.setting.small_motion()
    if motion is None:
        raise AssemblyError([system.setting.without_small_motion()])
    modes = vibration_modes(motion)
    rate = np.array([mode.angular_frequency for mode in modes])
    values: dict[str, AnyArray] = {
        "mode": np.arange(1, len(modes) + 1),
        "angular_frequency": rate,
        "frequency": rate / (2.0 * math.pi),
        "period": 2.0 * math.pi / rate,
        "damping_ratio": np.array([mode.damping_ratio for mode in modes]),
    }
    shapes = np.array([mode.shape for mode in modes])
    if motion.bodies:
        values["body"] = np.array(motion.bodies)
    names = list(dict.fromkeys(motion.coordinates))
    for row, name in enumerate(names):
        values[f"{name}_shape"] = shapes[:, row :: len(names)] if motion.bodies else shapes[:, row]
    return _labelled(system, values, "Modes of small motion", "eigenvalues")


def _labelled(system: Assembly, values: Results, title: str, source: str) -> xr.Dataset:
    attributes = {
        "model": system.setting.model,
        "model_description": system.description,
        **slope_attributes(system.options.slope),
        "system_json": system.json,
    }
    return build_dataset(values, attributes, title=title, source=source)
