"""Assembly of the model of a chain of bodies: sizes, bounds of its frequencies, initial state."""

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Final

import numpy as np

from rockframe.compiled import Vector
from rockframe.dynamics.base_numbers import BaseNumbers
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, BODY_DOF, ROTATION
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.friction import SlippingChain
from rockframe.dynamics.chain.link_rows import MOMENT_OF_LINKS, ChainLink, link_columns
from rockframe.dynamics.chain.linked import LinkMechanics
from rockframe.dynamics.chain.linked_chain import LinkedBodies, LinkedRigidChain, with_links
from rockframe.dynamics.chain.returned import with_workspace
from rockframe.dynamics.chain.rigid import SET_MEMORY, RigidChain
from rockframe.dynamics.chain.rigid_friction import SlippingRigidChain
from rockframe.dynamics.chain.rows import BASE_COLUMNS, GUARDS, body_row, chain_numbers
from rockframe.dynamics.chain.slips import OFFSET, SlippingBodies
from rockframe.dynamics.chain.system import Chain
from rockframe.dynamics.links import GUARDS as GUARDS_OF_LINK
from rockframe.dynamics.links import SteadyForce
from rockframe.dynamics.pads import CORNER_GUARDS, ROUNDING
from rockframe.dynamics.protocol import (
    BODY_COLUMNS,
    MEMORY,
    Column,
    ContactModel,
    Start,
    column_of,
)
from rockframe.dynamics.single_body import (
    guard_tolerances,
    radius_of,
    rocking_rate,
    rounding_estimate,
)
from rockframe.dynamics.starting import (
    UPRIGHT,
    AtRest,
    StartingBody,
    starting_placements,
    write_start,
)
from rockframe.dynamics.vibrations import ChainBody, fastest_vibration, is_rigid, per_own_mass

ROUNDING_OF_FORCES: Final = 1e-14
"""Rounding noise of the forces that hold a body on a rigid base, over the weight on it [1]."""


def bare_chain(bodies: Sequence[ChainBody], ties: Sequence[ChainLink] = ()) -> Chain:
    """Return the system of stacked bodies, from the top down, without their ties."""
    kind = RigidChain if any(is_rigid(body.base) for body in bodies) else Chain
    rows = [body_row(body.body, body.base, body.mass, body.top, body.offset) for body in bodies]
    for row in rows:
        row[at.FORCE_SCALE] = max(
            row[at.FORCE_SCALE], link_force_rounding(ties) / ROUNDING_OF_FORCES
        )
    return with_workspace(kind(*chain_numbers(rows)))


def with_friction(bare: Chain, frictions: Sequence[tuple[float, float, float]]) -> Chain:
    """Return the system `bare`, of bases without slip, with friction on the bases."""
    deformable = not isinstance(bare, RigidChain) and all(
        math.isfinite(friction[0]) for friction in frictions
    )
    kind = SlippingChain if deformable else SlippingRigidChain
    array = np.concatenate([bare.rows[: bare.workspace_end()], np.ravel(frictions)])
    return with_workspace(kind(bare.body_count, array))


def chain_model(
    bodies: Sequence[ChainBody],  # from the top down
    mass: float,  # the reference mass, over which all masses and forces are given [kg]
    rest: Sequence[AtRest] | None = None,  # None if all bodies stand upright
    # rotations to both sides at which each body but the first overturns, with all above it, if
    # these are checked [rad]
    limits: Sequence[tuple[float, float]] = (),
    ties: Sequence[ChainLink] = (),  # links between points of bodies, or to the ground
    # height at which the highest body starts at a rotation, if not that for its weight alone
    start_height: Callable[[float], float] | None = None,
    # static, kinetic and impulsive, of each base: infinite for one that cannot slip, empty if none
    frictions: Sequence[tuple[float, float, float]] = (),
) -> ContactModel:
    """Assemble the model of stacked bodies."""
    top, count = bodies[0].body, len(bodies)
    bare = bare_chain(bodies, ties)
    alone = with_friction(bare, frictions) if frictions else bare
    system = with_links(alone, ties) if ties else alone
    fastest, damping_rate = fastest_vibration(bodies, ties)
    carried = np.cumsum([body.mass for body in bodies])
    height_at = start_height or partial(_resting_height, bodies[0])
    initial = partial(_initial, system, bodies, rest or [UPRIGHT] * count, height_at)
    if isinstance(system, LinkedBodies):
        mode, state, _ = initial(Start())
        system.store_rest_energies(mode, state)
    tied = visible_links(ties)
    scales = link_scales(system, ties) if isinstance(system, LinkedBodies) else []
    return ContactModel(
        name="stack",
        system=system,
        rotation_limits=(math.atan2(top.left, top.height), math.atan2(top.right, top.height)),
        rotation_weights=_weights(count, 0),
        scales=np.append(_scales(bodies), scales),
        guard_tolerance=np.concatenate([
            *(
                _tolerance(body.base, load / body.mass)
                for body, load in zip(bodies, carried, strict=True)
            ),
            *(link_guard_tolerance(tie) for tie in ties),
        ]),
        columns=(
            *(column for k in range(count) for column in _columns(bodies[k].base, k)),
            *(
                Column(column_of(name, k))
                for k in range(count if frictions else 0)
                for name in ("slip", "slip_velocity")
            ),
            *link_columns(len(ties), tied), *((MOMENT_OF_LINKS,) if ties else ()),
        ),
        memory=_memory_names(system),
        shows_bodies=count > 1,
        links=tied,
        selects=True,
        mass=mass,
        fastest_frequency=fastest,
        damping_rate=damping_rate,
        energy_scale=sum(
            body.mass * body.body.gravity * radius_of(body.body) * body.body.angle
            for body in bodies
        ),
        initial=initial,
        rounding=None if all(is_rigid(body.base) for body in bodies) else rounding_estimate(
            sum(radius_of(body.body) for body in bodies),
            sum(body.base.settlement for body in bodies),
            _unit_responses(bodies), fastest, len(scales),
        ),
        other_limits=np.array(
            [each for k, both in enumerate(limits, 1) for each in (*both, *_weights(count, k))]
        ),
    )  # fmt: skip


def _memory_names(system: Chain) -> tuple[str, ...]:
    """Return the names of the numbers that a chain remembers."""
    count = system.body_count
    names = [*MEMORY, *(f"held_place_of_{k}" for k in range(1, count)), "body_of_event"]
    if isinstance(system, RigidChain):
        names += SET_MEMORY
    if isinstance(system, SlippingBodies):
        names += [
            f"{name}_of_{k}"
            for k in range(count)
            for name in ("slip_offset", "peak_slip_left", "peak_slip_right")
        ]
    return (*names, "link_of_event") if isinstance(system, LinkedBodies) else tuple(names)


def _weights(count: int, k: int) -> Vector:
    """Return weights of the coordinates in the rotation of body `k`: its own and those below."""
    weights = np.zeros(BODY_DOF * count)
    first = BEFORE_HORIZONTAL * k + ROTATION
    weights[first : BEFORE_HORIZONTAL * count : BEFORE_HORIZONTAL] = 1.0
    return weights


def _tolerance(base: BaseNumbers, carried: float) -> Vector:
    """Return the rounding noise of a body's guards; each end of a bed uses one guard."""
    if is_rigid(base):
        return np.full(GUARDS, ROUNDING_OF_FORCES * carried)
    tolerances = guard_tolerances(base)
    ends = len(base.end_tolerance)
    if ends == CORNER_GUARDS:
        return tolerances
    all_of_them = np.full(GUARDS, ROUNDING)
    all_of_them[[0, CORNER_GUARDS]] = base.end_tolerance[0]
    return all_of_them


def _columns(base: BaseNumbers, k: int) -> tuple[Column, ...]:
    """Return the columns of body `k`; those of body 0 have the names of any scene."""
    own = (*BODY_COLUMNS, Column("rotation_on_base"), Column("vertical_displacement_on_base"))
    unused = tuple(Column(f"unused_{i}") for i in range(BASE_COLUMNS - len(base.columns)))
    return tuple(
        Column(column_of(column.name, k), column.per_mass, column.mass_ratio)
        for column in (*own, *base.columns, *unused)
    )


def link_force_rounding(ties: Sequence[ChainLink]) -> float:
    """Return the noise in forces of corners from the rounding of the lengths of stiff ties."""
    return ROUNDING * sum(tie.numbers.stiffness * tie.length_scale for tie in ties)


def visible_links(ties: Sequence[ChainLink]) -> int:
    """Return the number of links in the results: all but loads, which come last."""
    return sum(not isinstance(tie.numbers.law, SteadyForce) for tie in ties)


def link_scales(system: LinkMechanics, ties: Sequence[ChainLink]) -> list[float]:
    """Return typical sizes of the variables of links, as many each as the law has with the most."""
    count = system.law.variables()
    return [size for tie in ties for size in (*tie.numbers.variable_scales, *[1.0] * count)[:count]]


def link_guard_tolerance(tie: ChainLink) -> Vector:
    """Return the rounding noise of a link's guards."""
    return np.full(GUARDS_OF_LINK, ROUNDING * tie.length_scale)


def _scales(bodies: Sequence[ChainBody]) -> Vector:
    places, sways, place_rates, sway_rates, carried = [], [], [], [], 0.0
    for body in bodies:
        carried += body.mass
        sway, rate = radius_of(body.body) * body.body.angle, rocking_rate(per_own_mass(body))
        rise, vertical = body.base.settlement, math.sqrt(body.base.vertical_stiffness / carried)
        if is_rigid(body.base):
            rise, vertical = sway * body.body.angle, rate
        places += [body.body.angle, rise]
        place_rates += [rate, vertical]
        sways.append(sway)
        sway_rates.append(rate)
    sizes, rates = np.array([*places, *sways]), np.array([*place_rates, *sway_rates])
    return np.concatenate([sizes, sizes * rates])


def _unit_responses(bodies: Sequence[ChainBody]) -> Vector:
    places = []
    for body in map(per_own_mass, bodies):
        places += [0.5 * (body.left + body.right) / (body.inertia + body.height**2), 1.0]
    return np.array([*places, *np.ones(len(bodies))])


def _resting_height(highest: ChainBody, rotation: float) -> float:
    """Return the height at which the base of the highest body carries its weight at a rotation."""
    if is_rigid(highest.base):
        return 0.0  # the contact prescribes it
    attitude = highest.body.attitude(rotation)
    lift = highest.body.left * attitude.sine, -highest.body.right * attitude.sine
    return highest.base.law.resting_height(*lift, ()) - attitude.rise


def _initial(
    system: Chain, bodies: Sequence[ChainBody], rest: Sequence[AtRest],
    height_at: Callable[[float], float], start: Start,
) -> tuple[int, Vector, Vector]:  # fmt: skip
    """Return mode, state and memory at the start: all at rest but body 0, as `start` says."""
    count = len(bodies)
    state = np.zeros(2 * BODY_DOF * count + system.variables())
    memory = np.zeros(len(_memory_names(system)))
    system.reset_event(memory)
    standing = [
        StartingBody(system.on_base(k), body.base.law, body.offset if k + 1 < count else 0.0)
        for k, body in enumerate(bodies)
    ]
    mode = write_start(
        system, standing, starting_placements(rest, start, height_at), start, state, memory,
        isinstance(system, LinkedBodies),
    )  # fmt: skip
    if isinstance(system, RigidChain):
        system.project_onto_contacts(mode, state, memory)
    if isinstance(system, LinkedRigidChain):
        system.store_held_place(mode, state, memory)
    if isinstance(system, SlippingBodies):
        for k in range(count):
            place = system.contact_point(k, mode, state, memory)
            memory[system.slip_memory(k) + OFFSET] = -place
    if isinstance(system, LinkedBodies):
        mode = system.start_links(mode, state)
    return mode, state, memory
