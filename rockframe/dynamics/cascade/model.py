"""Assembly of a cascade from the models of its two bodies."""

from collections.abc import Callable
from dataclasses import replace
from typing import cast

import numpy as np

from rockframe.compiled import Vector
from rockframe.dynamics.cascade.system import COLUMNS, Cascade
from rockframe.dynamics.protocol import BODY_COLUMNS, HELD_PLACE, MEMORY, ContactModel, Start
from rockframe.dynamics.single_body import SingleBody
from rockframe.dynamics.stacked import CONTACTS


def cascade(
    first: ContactModel,
    second: ContactModel,
    *,
    top: float,  # of the cap above the centre of mass of the first body [m]
    cap_centre: float,  # likewise [m]
    offset: float,  # distance of this centre of mass to the right of the middle of the cap [m]
    rest_rotation: float,  # of the first body [rad]
) -> ContactModel:
    """Assemble a cascade of block and cap as one body on the soil, and of the block on its base."""
    ratio = first.mass / second.mass
    lower_part, upper_part = (cast("SingleBody", stage.system).part for stage in (first, second))
    system = Cascade(upper_part, lower_part, ratio, top, cap_centre, offset)
    body_columns = len(BODY_COLUMNS)
    under = tuple(replace(column, mass_ratio=ratio) for column in first.columns[body_columns:])

    def initial(start: Start) -> tuple[int, Vector, Vector]:
        lower, below, memory = first.initial(Start())
        rotation = start.rotation
        on_cap = start if rotation is None else replace(start, rotation=rotation - rest_rotation)
        upper, above, upper_memory = second.initial(on_cap)
        mode = upper + system.upper.modes() * lower
        return mode, _interleaved(above, below), np.append(upper_memory, memory[HELD_PLACE])

    return ContactModel(
        name="cascade",
        system=system,
        rotation_limits=second.rotation_limits,
        rotation_weights=np.array([1.0, 0.0, 1.0, 0.0, 0.0, 0.0]),
        scales=_interleaved(second.scales, first.scales),
        guard_tolerance=np.concatenate([second.guard_tolerance, first.guard_tolerance]),
        columns=(*COLUMNS, *second.columns[body_columns:], *under),
        selects=True,
        contacts=CONTACTS,
        memory=(*MEMORY, "held_place_of_first"),
        mass=second.mass,
        fastest_frequency=max(first.fastest_frequency, second.fastest_frequency),
        damping_rate=max(first.damping_rate, second.damping_rate),
        energy_scale=second.energy_scale,
        initial=initial,
        rounding=_rounding(first, second),
    )


def _interleaved(second: Vector, first: Vector) -> Vector:
    """Join arrays of both bodies in the order of the state of the cascade."""
    coordinates = (second[0], second[1], first[0], first[1], second[2], first[2])
    rates = (second[3], second[4], first[3], first[4], second[5], first[5])
    return np.array([*coordinates, *rates, *second[6:], *first[6:]])


def _rounding(first: ContactModel, second: ContactModel) -> Callable[[float], Vector] | None:
    below, above = first.rounding, second.rounding
    if below is None or above is None:
        return None

    def noise(rotation: float) -> Vector:
        return _interleaved(above(rotation), below(0.0))

    return noise
