"""Assembly of the model of a chain of bodies: sizes, bounds of its frequencies, initial state."""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Final, NamedTuple

import numpy as np

from rockframe.compiled import Vector
from rockframe.dynamics.base_numbers import BaseNumbers
from rockframe.dynamics.bed import both_contacts
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, BODY_DOF, ROTATION, VERTICAL
from rockframe.dynamics.body import BodyState
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.friction import SlippingChain
from rockframe.dynamics.chain.link_rows import LINK_MOMENT, ChainLink
from rockframe.dynamics.chain.linked import Linked
from rockframe.dynamics.chain.linked_chain import ChainLinks, RestOnGround, linked
from rockframe.dynamics.chain.rigid import KEPT, RigidChain
from rockframe.dynamics.chain.rigid_friction import SlippingRigidChain
from rockframe.dynamics.chain.rows import GUARDS, OBSERVED, lists_of, row_of
from rockframe.dynamics.chain.slips import SlippingBodies, coefficients
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


def chain_of(links: Sequence[ChainBody], ties: Sequence[ChainLink] = ()) -> Chain:
    """Return the system of stacked bodies, from the top down, without their ties."""
    kind = RigidChain if any(is_rigid(one.base) for one in links) else Chain
    rows = [row_of(one.body, one.base, one.mass, one.top, one.offset) for one in links]
    for row in rows:
        row[at.FORCE_SIZE] = max(row[at.FORCE_SIZE], rounding_of_ties(ties) / ROUNDING_OF_FORCES)
    return kind(*lists_of(rows))


def slipping(bare: Chain, frictions: Sequence[tuple[float, float, float]]) -> Chain:
    """Return the system `bare`, of bases without slip, with friction on the bases."""
    gives = not isinstance(bare, RigidChain) and all(math.isfinite(one[0]) for one in frictions)
    kind = SlippingChain if gives else SlippingRigidChain
    return kind(bare.body_count, np.concatenate([bare.rows, coefficients(frictions)]))


def chain(
    links: Sequence[ChainBody],
    mass: float,
    rest: Sequence[AtRest] | None = None,
    limits: Sequence[tuple[float, float]] = (),
    ties: Sequence[ChainLink] = (),
    held: Callable[[float], float] | None = None,
    frictions: Sequence[tuple[float, float, float]] = (),
) -> ContactModel:
    """Assemble the model of stacked bodies.

    Parameters
    ----------
    links : sequence of ChainBody
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
    held : callable, optional
        From a rotation of the highest body to the height at which it starts there; unless
        given, that at which its base carries its weight.
    frictions : sequence of tuple of float
        Coefficients of friction of each base: static, kinetic and in impacts; empty where no base
        can slip, infinite for one that cannot.
    """
    top, count = links[0].body, len(links)
    bare = chain_of(links, ties)
    alone = slipping(bare, frictions) if frictions else bare
    system = linked(alone, ties) if ties else alone
    fastest, damping_rate = fastest_vibration(links, ties)
    carried = np.cumsum([one.mass for one in links])
    starts = Starts(links, rest, held)
    if isinstance(system, ChainLinks):
        mode, state, _ = _initial(system, starts, Start())
        system.keep_energies(mode, state)
    tied = links_shown(ties)
    scales = scales_of_links(system, ties) if isinstance(system, ChainLinks) else []
    return ContactModel(
        name="stack",
        system=system,
        rotation_limits=(math.atan2(top.left, top.height), math.atan2(top.right, top.height)),
        rotation_weights=_weights(count, 0),
        scales=np.append(_scales(links), scales),
        guard_tolerance=np.concatenate([
            *(_tolerance(one.base, on / one.mass) for one, on in zip(links, carried, strict=True)),
            *(tie_tolerance(one) for one in ties),
        ]),
        columns=(
            *(column for k in range(count) for column in _columns(links[k].base, k)),
            *(
                Column(column_of(name, k))
                for k in range(count if frictions else 0)
                for name in ("slip", "slip_velocity")
            ),
            *columns_of_ties(len(ties), tied),
        ),
        memory=(
            *MEMORY, *(f"held_place_of_{k}" for k in range(1, count)), "body_of_event",
            *(KEPT if isinstance(system, RigidChain) else ()),
            *(
                f"{name}_of_{k}"
                for k in range(count if frictions else 0)
                for name in ("slip_offset", "peak_slip_left", "peak_slip_right")
            ),
            *(("link_of_event",) if ties else ()),
        ),
        shows_bodies=count > 1,
        links=tied,
        selects=True,
        mass=mass,
        fastest_frequency=fastest,
        damping_rate=damping_rate,
        energy_scale=sum(
            one.mass * one.body.gravity * radius_of(one.body) * one.body.angle for one in links
        ),
        initial=lambda start: _initial(system, starts, start),
        rounding=None if all(is_rigid(one.base) for one in links) else rounding_estimate(
            sum(radius_of(one.body) for one in links),
            sum(one.base.settlement for one in links),
            _answers(links), fastest, len(scales),
        ),
        other_limits=np.array(
            [each for k, both in enumerate(limits, 1) for each in (*both, *_weights(count, k))]
        ),
    )  # fmt: skip


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
    found = guard_tolerances(base)
    ends = len(base.end_tolerance)
    if ends == CORNER_GUARDS:
        return found
    all_of_them = np.full(GUARDS, ROUNDING)
    all_of_them[[0, CORNER_GUARDS]] = base.end_tolerance[0]
    return all_of_them


def _columns(base: BaseNumbers, k: int) -> tuple[Column, ...]:
    """Return the columns of body `k`; those of body 0 have the names of any scene."""
    own = (*BODY_COLUMNS, Column("rotation_on_base"), Column("vertical_displacement_on_base"))
    unused = tuple(Column(f"unused_{i}") for i in range(OBSERVED - len(base.columns)))
    return tuple(
        Column(column_of(one.name, k), one.per_mass, one.mass_ratio)
        for one in (*own, *base.columns, *unused)
    )


def rounding_of_ties(ties: Sequence[ChainLink]) -> float:
    """Return the noise in forces of corners from the rounding of the lengths of stiff ties."""
    return ROUNDING * sum(one.numbers.stiffness * one.reach for one in ties)


def links_shown(ties: Sequence[ChainLink]) -> int:
    """Return the number of links in the results: all but loads, which come last."""
    return sum(not isinstance(one.numbers.law, SteadyForce) for one in ties)


def scales_of_links(system: Linked, ties: Sequence[ChainLink]) -> list[float]:
    """Return typical sizes of the variables of links.

    Each link has as many variables as the law that has the most.
    """
    each = system.law.variables()
    return [size for one in ties for size in (*one.numbers.variable_scales, *[1.0] * each)[:each]]


def tie_tolerance(tie: ChainLink) -> Vector:
    """Return the rounding noise of a link's guards."""
    return np.full(GUARDS_OF_LINK, ROUNDING * tie.reach)


def columns_of_ties(ties: int, shown: int) -> Iterator[Column]:
    """Return the columns of links; users do not see those of loads, which come last."""
    for i in range(ties):
        kind = "restrainer" if i < shown else "unused_load"
        yield Column(column_of(f"{kind}_force", i), per_mass=True)
        yield Column(column_of(f"{kind}_elongation", i))
        yield Column(column_of(f"{kind}_state", i))
    if ties:
        yield Column(LINK_MOMENT, per_mass=True)


def _scales(links: Sequence[ChainBody]) -> Vector:
    places, sways, place_rates, sway_rates, carried = [], [], [], [], 0.0
    for one in links:
        carried += one.mass
        sway, rate = radius_of(one.body) * one.body.angle, rocking_rate(per_own_mass(one))
        rise, vertical = one.base.settlement, math.sqrt(one.base.vertical_stiffness / carried)
        if is_rigid(one.base):
            rise, vertical = sway * one.body.angle, rate
        places += [one.body.angle, rise]
        place_rates += [rate, vertical]
        sways.append(sway)
        sway_rates.append(rate)
    sizes, rates = np.array([*places, *sways]), np.array([*place_rates, *sway_rates])
    return np.concatenate([sizes, sizes * rates])


def _answers(links: Sequence[ChainBody]) -> Vector:
    places = []
    for one in links:
        body = per_own_mass(one)
        places += [0.5 * (body.left + body.right) / (body.inertia + body.height**2), 1.0]
    return np.array([*places, *np.ones(len(links))])


class Starts(NamedTuple):
    """What the initial state is made from."""

    links: Sequence[ChainBody]
    rest: Sequence[AtRest] | None
    held: Callable[[float], float] | None


def _placed(highest: BodyOnBase, starts: Starts, start: Start) -> list[AtRest]:
    """Return rotations and heights of all bodies: at rest, but of the highest as `start` says."""
    placed = list(starts.rest or [AtRest(0.0, 0.0)] * len(starts.links))
    if start.rotation is None and start.vertical_displacement is None:
        return placed
    below = sum(one.rotation for one in placed[1:])
    rotation = placed[0].rotation if start.rotation is None else start.rotation - below
    height = start.vertical_displacement
    if height is None and is_rigid(starts.links[0].base):
        height = 0.0  # the contact prescribes it
    elif height is None and starts.held is not None:
        height = starts.held(rotation)
    elif height is None:
        attitude = highest.body.attitude(rotation)
        lift = highest.body.left * attitude.sine, -highest.body.right * attitude.sine
        height = highest.base.resting_height(*lift, ()) - attitude.rise
    return [AtRest(rotation, height), *placed[1:]]


def _starting_contact(part: BodyOnBase, base: BaseNumbers, body: BodyState) -> int:
    if not is_rigid(base):
        return part.base.starting(part.body.base_line_at(body), ())
    side = body.rotation or body.angular_velocity
    return both_contacts(int(side > 0.0), int(side < 0.0))


def _write_start(
    system: Chain, k: int, standing: Mode, pin: float, body: BodyState, state: Vector,
    memory: Vector,
) -> None:  # fmt: skip
    """Write place, velocities and held point of body `k` to state and memory."""
    part, count = system.on_base(k), system.bodies()
    n, i, x = BODY_DOF * count, BEFORE_HORIZONTAL * k, system.horizontal_of(k)
    offset = system.number(k, at.BESIDE) if k + 1 < count else 0.0
    state[i + ROTATION], state[i + VERTICAL] = body.rotation, body.vertical
    state[n + i + ROTATION] = body.angular_velocity
    state[n + i + VERTICAL] = body.vertical_velocity
    memory[HELD_PLACE + k] = pin + offset
    free = part.is_free(standing)
    moves = isinstance(system, ChainLinks) or k + 1 < count
    attitude = part.body.attitude(body.rotation)
    if moves or free:
        state[x] = pin + offset + part.body.about_pin(pin, attitude)
    if moves and not free:
        reach = part.body.reach(pin, attitude)
        state[n + x] = reach.derivative * body.angular_velocity


def _initial(system: Chain, starts: Starts, start: Start) -> tuple[int, Vector, Vector]:
    """Return mode, state and memory at the start: all at rest but body 0, as `start` says."""
    count = len(starts.links)
    state = np.zeros(2 * BODY_DOF * count + system.variables())
    memory = np.zeros(len(MEMORY) + count)
    placed, mode = _placed(system.on_base(0), starts, start), 0
    for k, one in enumerate(placed):
        moving = k == 0
        body = BodyState(
            one.rotation, one.vertical, 0.0, start.angular_velocity if moving else 0.0,
            start.vertical_velocity if moving else 0.0, 0.0,
        )  # fmt: skip
        # a body at rest upright has no side yet: it takes that of the body above
        leaning = body
        if body.rotation == 0.0 and k > 0:
            leaning = body._replace(rotation=placed[k - 1].rotation)
        part = system.on_base(k)
        standing = part.mode_for_contact(
            _starting_contact(part, starts.links[k].base, body), leaning
        )
        _write_start(system, k, standing, part.initial_pin(standing, leaning), body, state, memory)
        mode = system.with_body_mode(mode, k, standing)
    if isinstance(system, RigidChain):
        memory = np.concatenate([memory, [1.0, 0.0, 0.0]])
        system.write_contacts(mode, state, memory)
    if isinstance(system, RestOnGround):
        system.keep_hold(mode, state, memory)
    if isinstance(system, SlippingBodies):
        places = [system.point_of(k, mode, state, memory) for k in range(count)]
        memory = np.concatenate([memory, *([-place, 0.0, 0.0] for place in places)])
    if isinstance(system, ChainLinks):
        memory = np.append(memory, 0.0)
        mode = system.start_links(mode, state)
    return mode, state, memory
