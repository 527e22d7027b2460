"""Assembly of the model of a chain of bodies: sizes, bounds of its frequencies, initial state."""

import math
from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

import numpy as np

from rockframe.compiled import Vector
from rockframe.dynamics.base_numbers import BaseNumbers
from rockframe.dynamics.bed import both_contacts
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, BODY_DOF, ROTATION, VERTICAL
from rockframe.dynamics.body import BodyState
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
from rockframe.dynamics.on_base import BodyOnBase, Mode
from rockframe.dynamics.pads import CORNER_GUARDS, ROUNDING
from rockframe.dynamics.protocol import (
    BODY_COLUMNS,
    HELD_PLACE,
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
from rockframe.dynamics.vibrations import ChainBody, fastest_vibration, is_rigid, per_own_mass

ROUNDING_OF_FORCES: Final = 1e-14
"""Rounding noise of the forces that hold a body on a rigid base, over the weight on it [1]."""


class AtRest(NamedTuple):
    """Placement of a body at rest relative to what it stands on [rad, m]."""

    rotation: float
    vertical: float


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
    bodies: Sequence[ChainBody],
    mass: float,
    rest: Sequence[AtRest] | None = None,
    limits: Sequence[tuple[float, float]] = (),
    ties: Sequence[ChainLink] = (),
    start_height: Callable[[float], float] | None = None,
    frictions: Sequence[tuple[float, float, float]] = (),
) -> ContactModel:
    """Assemble the model of stacked bodies.

    Parameters
    ----------
    bodies : sequence of ChainBody
        From the top down.
    mass : float
        The reference mass, over which all masses and forces are given [kg].
    rest : sequence of AtRest, or None
        Placements of the bodies at rest; None if they all stand upright.
    limits : sequence of tuple of float
        Rotations to the left and to the right at which each body but the first overturns, with
        all above it; unless given, the rotations of these bodies are not checked [rad].
    ties : sequence of ChainLink
        Links between points of bodies, or to the ground.
    start_height : callable, optional
        From a rotation of the highest body to the height at which it starts there; unless
        given, that at which its base carries its weight.
    frictions : sequence of tuple of float
        Coefficients of friction of each base: static, kinetic and in impacts; empty where no base
        can slip, infinite for one that cannot.
    """
    top, count = bodies[0].body, len(bodies)
    bare = bare_chain(bodies, ties)
    alone = with_friction(bare, frictions) if frictions else bare
    system = with_links(alone, ties) if ties else alone
    fastest, damping_rate = fastest_vibration(bodies, ties)
    carried = np.cumsum([body.mass for body in bodies])
    starts = StartConditions(bodies, rest, start_height)
    if isinstance(system, LinkedBodies):
        mode, state, _ = _initial(system, starts, Start())
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
        initial=lambda start: _initial(system, starts, start),
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
    """Return typical sizes of the variables of links.

    Each link has as many variables as the law that has the most.
    """
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


class StartConditions(NamedTuple):
    """What the initial state is made from."""

    bodies: Sequence[ChainBody]
    rest: Sequence[AtRest] | None
    start_height: Callable[[float], float] | None


def _initial_placements(highest: BodyOnBase, starts: StartConditions, start: Start) -> list[AtRest]:
    """Return rotations and heights of all bodies: at rest, but of the highest as `start` says."""
    placements = list(starts.rest or [AtRest(0.0, 0.0)] * len(starts.bodies))
    if start.rotation is None and start.vertical_displacement is None:
        return placements
    below = sum(placement.rotation for placement in placements[1:])
    rotation = placements[0].rotation if start.rotation is None else start.rotation - below
    height = start.vertical_displacement
    if height is None and is_rigid(starts.bodies[0].base):
        height = 0.0  # the contact prescribes it
    elif height is None and starts.start_height is not None:
        height = starts.start_height(rotation)
    elif height is None:
        attitude = highest.body.attitude(rotation)
        lift = highest.body.left * attitude.sine, -highest.body.right * attitude.sine
        height = highest.base.resting_height(*lift, ()) - attitude.rise
    return [AtRest(rotation, height), *placements[1:]]


def _starting_contact(part: BodyOnBase, base: BaseNumbers, body: BodyState) -> int:
    if not is_rigid(base):
        return part.base.starting(part.body.base_line_at(body), ())
    side = body.rotation or body.angular_velocity
    return both_contacts(int(side > 0.0), int(side < 0.0))


def _write_start(
    system: Chain, k: int, body_mode: Mode, pin: float, body: BodyState, state: Vector,
    memory: Vector,
) -> None:  # fmt: skip
    """Write place, velocities and held point of body `k` to state and memory."""
    part, count = system.on_base(k), system.bodies()
    n, i, x = BODY_DOF * count, BEFORE_HORIZONTAL * k, system.horizontal_of(k)
    offset = system.row_value(k, at.UPRIGHT_OFFSET) if k + 1 < count else 0.0
    state[i + ROTATION], state[i + VERTICAL] = body.rotation, body.vertical
    state[n + i + ROTATION] = body.angular_velocity
    state[n + i + VERTICAL] = body.vertical_velocity
    memory[HELD_PLACE + k] = pin + offset
    free = part.is_free(body_mode)
    moves = isinstance(system, LinkedBodies) or k + 1 < count
    attitude = part.body.attitude(body.rotation)
    if moves or free:
        state[x] = pin + offset + part.body.about_pin(pin, attitude)
    if moves and not free:
        reach = part.body.reach(pin, attitude)
        state[n + x] = reach.derivative * body.angular_velocity


def _initial(system: Chain, starts: StartConditions, start: Start) -> tuple[int, Vector, Vector]:
    """Return mode, state and memory at the start: all at rest but body 0, as `start` says."""
    count = len(starts.bodies)
    state = np.zeros(2 * BODY_DOF * count + system.variables())
    memory = np.zeros(len(_memory_names(system)))
    system.reset_event(memory)
    placements, mode = _initial_placements(system.on_base(0), starts, start), 0
    for k, placement in enumerate(placements):
        moving = k == 0
        body = BodyState(
            placement.rotation, placement.vertical, 0.0, start.angular_velocity if moving else 0.0,
            start.vertical_velocity if moving else 0.0, 0.0,
        )  # fmt: skip
        # a body at rest upright has no side yet: it takes that of the body above
        leaning_body = body
        if body.rotation == 0.0 and k > 0:
            leaning_body = body._replace(rotation=placements[k - 1].rotation)
        part = system.on_base(k)
        body_mode = part.mode_for_contact(
            _starting_contact(part, starts.bodies[k].base, body), leaning_body
        )
        _write_start(
            system, k, body_mode, part.initial_pin(body_mode, leaning_body), body, state, memory
        )
        mode = system.with_body_mode(mode, k, body_mode)
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
