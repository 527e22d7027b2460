"""Assembly of the model of a block on a base on a cap on a base."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from rockframe.case_arrays import atan2, sqrt
from rockframe.compiled import Vector
from rockframe.dynamics.body_statics import equilibrium_pose, standing_body
from rockframe.dynamics.coupled.system import Coupled
from rockframe.dynamics.on_base import BodyOnBase
from rockframe.dynamics.protocol import MEMORY, ContactModel, Start
from rockframe.dynamics.single_body import (
    guard_tolerances,
    radius_of,
    rocking_rate,
    rounding_estimate,
)
from rockframe.dynamics.stacked import COLUMNS, CONTACTS, COORDINATES
from rockframe.dynamics.starting import (
    UPRIGHT,
    AtRest,
    StartingBody,
    starting_placements,
    write_start,
)
from rockframe.dynamics.vibrations import ChainBody, fastest_vibration


def system_of(block: ChainBody, cap: ChainBody) -> Coupled:
    """Return the system of a block on a cap."""
    return Coupled(
        BodyOnBase(block.body, block.base.law), BodyOnBase(cap.body, cap.base.law), cap.mass,
        cap.top, block.offset,
    )  # fmt: skip


def coupled(block: ChainBody, cap: ChainBody, mass: float, rest: Sequence[AtRest]) -> ContactModel:
    """Assemble the model of a block on a cap, per unit mass of the block [kg], from their rest."""
    body, system = block.body, system_of(block, cap)
    fastest, damping_rate = fastest_vibration((block, cap))
    return ContactModel(
        name="coupled",
        system=system,
        rotation_limits=(atan2(body.left, body.height), atan2(body.right, body.height)),
        rotation_weights=np.array([1.0, 0.0, 1.0, 0.0, 0.0, 0.0]),
        scales=_scales(block, cap),
        guard_tolerance=np.concatenate([guard_tolerances(block.base), guard_tolerances(cap.base)]),
        columns=(*COLUMNS, *block.base.columns, *cap.base.columns),
        contacts=CONTACTS,
        memory=(*MEMORY, "held_place_of_cap"),
        mass=mass,
        fastest_frequency=fastest,
        damping_rate=damping_rate,
        energy_scale=body.gravity * radius_of(body) * body.angle,
        initial=partial(_initial, system, rest),
        rounding=_rounding(block, cap, fastest),
    )


def _scales(block: ChainBody, cap: ChainBody) -> Vector:
    body, pads, soil = block.body, block.base, cap.base
    horizontal, rocking = radius_of(body) * body.angle, rocking_rate(body)
    on_pads = sqrt(pads.vertical_stiffness)
    on_soil = sqrt(soil.vertical_stiffness / (1.0 + cap.mass))
    sizes = np.array(
        [body.angle, pads.settlement, body.angle, soil.settlement, horizontal, horizontal]
    )
    rates = np.array([rocking, on_pads, rocking, on_soil, rocking, rocking])
    return np.concatenate([sizes, sizes * rates, pads.variable_scales, soil.variable_scales])


def _rounding(block: ChainBody, cap: ChainBody, fastest: float) -> Callable[[float], Vector]:
    """Estimate the rounding noise of each state variable, as :func:`rounding_estimate` does."""
    body, pads, soil = block.body, block.base, cap.base
    rotating = 0.5 * (body.left + body.right) / (body.inertia + body.height**2)
    sizes = radius_of(body), radius_of(cap.body)
    sensitivities = np.array([rotating, 1.0, 1.0 / sizes[1], 1.0, 1.0, 1.0])
    variables = len(pads.variable_scales) + len(soil.variable_scales)
    return rounding_estimate(
        sum(sizes), pads.settlement + soil.settlement, sensitivities, fastest, variables
    )


def _initial(system: Coupled, rest: Sequence[AtRest], start: Start) -> tuple[int, Vector, Vector]:
    """Return mode, state and memory at the start: the cap at rest, the block as stated."""
    state, memory = np.zeros(2 * COORDINATES + system.variables()), np.zeros(len(MEMORY) + 1)
    (upper, lower), block = system[:2], standing_body(system.upper)

    def height_at(rotation: float) -> float:
        return equilibrium_pose(block, rotation, block.part.body.gravity).state.vertical

    if start.rotation is None and all(placement == UPRIGHT for placement in rest):
        start = replace(start, rotation=0.0)  # a base of a user's own may rest at another height
    placements = starting_placements(rest, start, height_at)
    bodies = (
        StartingBody(upper, upper.base, system.offset), StartingBody(lower, lower.base, 0.0)
    )  # fmt: skip
    return write_start(system, bodies, placements, start, state, memory), state, memory
