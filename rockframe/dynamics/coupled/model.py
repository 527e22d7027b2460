"""Assembly of the model of a block on a base on a cap on a base."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Final, NamedTuple

import numpy as np

from rockframe.case_arrays import atan2, sqrt
from rockframe.compiled import Vector
from rockframe.dynamics.bodies import ROTATION, VERTICAL
from rockframe.dynamics.body import BodyState
from rockframe.dynamics.coupled.system import Coupled
from rockframe.dynamics.on_base import BodyOnBase
from rockframe.dynamics.protocol import HELD_PLACE, MEMORY, ContactModel, Start
from rockframe.dynamics.single_body import (
    guard_tolerances,
    radius_of,
    rocking_rate,
    rounding_estimate,
    starting_state,
)
from rockframe.dynamics.stacked import (
    COLUMNS,
    CONTACTS,
    COORDINATES,
    HORIZONTAL,
    LOWER,
    LOWER_HORIZONTAL,
    LOWER_ROTATION,
    LOWER_VERTICAL,
    UPPER,
)
from rockframe.dynamics.vibrations import ChainBody, fastest_vibration


class StackRest(NamedTuple):
    """Placement of a block, relative to the cap, and of the cap, both at rest."""

    rotation: float
    vertical: float
    cap_rotation: float
    cap_vertical: float


UPRIGHT: Final = StackRest(0.0, 0.0, 0.0, 0.0)
"""Rest of symmetric bodies on a level base."""


def system_of(block: ChainBody, cap: ChainBody) -> Coupled:
    """Return the system of a block on a cap."""
    return Coupled(
        BodyOnBase(block.body, block.base.law), BodyOnBase(cap.body, cap.base.law), cap.mass,
        cap.top, block.offset,
    )  # fmt: skip


def coupled(block: ChainBody, cap: ChainBody, mass: float, rest: StackRest) -> ContactModel:
    """Assemble the model of a block on a base on a cap on a base.

    Parameters
    ----------
    block, cap : ChainBody
        Block and cap on their bases, per unit mass of the block.
    mass : float
        Mass of the block [kg].
    rest : StackRest
        Placement of block and cap at rest, :meth:`rockframe.dynamics.statics.StandingChain.rest`.
    """
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


def state_at(
    system: Coupled, place: StackRest, rate: float = 0.0, vertical_velocity: float = 0.0
) -> tuple[int, Vector, Vector]:
    """Return mode, state and memory of a block on a cap at a placement, the cap at rest.

    `rate` and `vertical_velocity` are those of the block.
    """
    state = np.zeros(2 * COORDINATES + system.variables())
    memory = np.zeros(len(MEMORY) + 1)
    upper, lower = system.upper, system.lower
    block = BodyState(place.rotation, place.vertical, 0.0, rate, vertical_velocity, 0.0)
    cap = BodyState(place.cap_rotation, place.cap_vertical, 0.0, 0.0, 0.0, 0.0)
    contact = upper.base.starting(upper.body.base_line_at(block), system.upper_own(state))
    under = lower.base.starting(lower.body.base_line_at(cap), system.lower_own(state))
    block_mode = upper.mode_for_contact(contact, block)
    # a cap at rest upright has no side yet: it takes that of the block
    leaning = cap if cap.rotation != 0.0 else block
    cap_mode = lower.mode_for_contact(under, leaning)
    pin, offset = upper.initial_pin(block_mode, block), system.offset
    attitude = upper.body.attitude(block.rotation)
    state[ROTATION], state[VERTICAL] = block.rotation, block.vertical
    state[LOWER_ROTATION], state[LOWER_VERTICAL] = cap.rotation, cap.vertical
    state[COORDINATES + ROTATION] = block.angular_velocity
    state[COORDINATES + VERTICAL] = block.vertical_velocity
    state[HORIZONTAL] = pin + offset + upper.body.about_pin(pin, attitude)
    if not upper.is_free(block_mode):
        reach = upper.body.reach(pin, attitude)
        state[COORDINATES + HORIZONTAL] = reach.derivative * block.angular_velocity
    memory[HELD_PLACE + UPPER] = pin + offset
    cap_pin = lower.initial_pin(cap_mode, leaning)
    memory[HELD_PLACE + LOWER] = cap_pin
    if lower.is_free(cap_mode):
        leant = lower.body.attitude(cap.rotation)
        state[LOWER_HORIZONTAL] = cap_pin + lower.body.about_pin(cap_pin, leant)
    return system.with_body_mode(upper.number_of(block_mode), LOWER, cap_mode), state, memory


def _initial(system: Coupled, rest: StackRest, start: Start) -> tuple[int, Vector, Vector]:
    """Return mode, state and memory at the start: the cap at rest, the block as stated."""
    place = rest
    is_stated = start.rotation is not None or start.vertical_displacement is not None
    if is_stated or rest == UPRIGHT:
        rotation = rest.rotation
        if start.rotation is not None:
            rotation = start.rotation - rest.cap_rotation
        own = system.upper.base.read(np.zeros(system.variables()), 0)
        block, _ = starting_state(system.upper, replace(start, rotation=rotation), own)
        place = rest._replace(rotation=block.rotation, vertical=block.vertical)
    return state_at(system, place, start.angular_velocity, start.vertical_velocity)
