"""Statics of links between bodies: elongations, forces, and generalised forces on the bodies.

A link is in the state that slow loading up to its elongation brings it into. Its force does work
on every rotation and height between its points, :eq:`eq-link-statics`.
"""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from rockframe.compiled import Matrix, Vector
from rockframe.dynamics.chain.link_rows import GROUND, ChainLink
from rockframe.dynamics.events import LinkState
from rockframe.dynamics.links import Stretch
from rockframe.dynamics.standing import Stand, StandingBody
from rockframe.dynamics.trigonometry import sine_cosine, versine

Ends = tuple[tuple[float, float], tuple[float, float]]
"""Both points of a link (x, y) [m]."""

STEP = 1e-3
"""Step of the rate for the derivative of a link's force by it [m s^-1]."""
SMALL = 1e-6
"""Step of the elongation for the derivative of a link's force, over the size of bodies [1]."""


class Tied(NamedTuple):
    """Force and geometry of a link between bodies at rest."""

    force: float  # with which it pulls
    state: int
    stiffness: float  # derivative of the force by the elongation
    damping: float  # derivative of the force by the rate of elongation
    elongation: float
    way: Matrix  # derivatives of `moved` by all coordinates
    direction: Vector  # unit, from the second to the first; zero where they meet without force
    moved: Vector  # displacement of its first point relative to its second [m]
    meets: bool  # whether both points coincide as it is given

    @property
    def loads(self) -> Vector:
        """Generalised forces on rotation and height of each body on its base."""
        found: Vector = -self.force * (self.direction @ self.way)
        return found

    @property
    def damping_matrix(self) -> Matrix:
        """Damping matrix of its dashpot, along the link or, where points meet, in any direction."""
        along = self.direction @ self.way
        if self.direction.any():
            return self.damping * np.outer(along, along)
        return self.damping * self.way.T @ self.way


class _Frame(NamedTuple):
    """Displacement and rotation of a body, and the axes of the deck beneath it."""

    place: Vector
    sine: float  # of its rotation
    cosine: float
    along: Vector
    normal: Vector


class Reached(NamedTuple):
    """Motion of the first point of a link relative to its second."""

    moved: Vector  # displacement from where it is given [m]
    way: Matrix  # derivatives of this by all coordinates
    direction: Vector  # unit vector away from the second point; zero where both meet


def reached(
    bodies: Sequence[StandingBody], stands: Sequence[Stand], ties: Sequence[ChainLink]
) -> list[Reached]:
    """Return the relative displacements of the points of links, for given places of bodies."""
    frames, found = _frames(bodies, stands) if ties else [], list[Reached]()
    for one in ties:
        on, on_way = _point(one.on, one.on_point, stands, frames)
        to, to_way = _point(one.to, one.to_point, stands, frames)
        found.append(_reached(one, on - to, on_way - to_way))
    return found


def tied(
    bodies: Sequence[StandingBody],
    stands: Sequence[Stand],
    ties: Sequence[ChainLink],
    states: Sequence[int] | None = None,
    stretches: Sequence[float] | None = None,
) -> list[Tied]:
    """Return elongations and forces of links, for given places of bodies.

    With `stretches` the forces are those of these elongations instead.
    """
    none = [None] * len(ties)
    points = reached(bodies, stands, ties)
    each = zip(ties, points, states or none, none if stretches is None else stretches, strict=True)
    return [pulled(*one) for one in each]


def pulled(
    tie: ChainLink, point: Reached, state: int | None = None, stretch: float | None = None
) -> Tied:
    """Return elongation and force of a link; `stretch` is an elongation for the force alone."""
    moved, way, direction = point
    apart, along, meets = np.array(tie.apart), any(tie.along), False
    if along:
        elongation = float(direction @ moved)
    else:
        length, meets = math.hypot(*(apart + moved)) + math.hypot(*apart), not apart.any()
        elongation = float((2.0 * apart + moved) @ moved) / length if length else 0.0
    found = _answer(tie, elongation if stretch is None or meets else stretch, state)
    if not direction.any() and found[0] != 0.0:
        direction = np.array([0.0, 1.0])
    return Tied(*found, elongation, way, direction, moved, meets)


def force_at(tie: ChainLink, elongation: float) -> float:
    """Return the force of a link after slow loading to an elongation."""
    return _answer(tie, elongation, None)[0]


def is_broken(tie: ChainLink, elongation: float) -> bool:
    """Whether a link is broken after slow loading to an elongation."""
    law: Any = tie.numbers.law
    return bool(law.shown(_answer(tie, elongation, None)[1]) == LinkState.BROKEN)


def _answer(
    tie: ChainLink, elongation: float, state: int | None
) -> tuple[float, int, float, float]:
    """Return a link's force, its state, and the force's derivatives by elongation and rate."""
    law: Any = tie.numbers.law
    length, reach = math.hypot(*tie.apart), tie.reach
    stretch, own = Stretch(elongation, 0.0, 0.0, length, 1e-15 * reach), np.zeros(law.variables())
    starting = law.starting(stretch, own)
    found = starting if state is None else state
    steps = {"elongation": SMALL * (reach or 1.0), "rate": STEP}
    changes = [
        0.5 * (more - less) / step
        for name, step in steps.items()
        for more, less in [[
            law.force(found, stretch._replace(**{name: getattr(stretch, name) + by}), own)
            for by in (step, -step)
        ]]
    ]  # fmt: skip
    return law.force(found, stretch, own), found, changes[0], changes[1]


def _reached(tie: ChainLink, moved: Vector, way: Matrix) -> Reached:
    """Return relative displacement, its derivatives and the direction of a link."""
    if any(tie.along):
        return Reached(moved, way, np.array(tie.along))
    now = np.array(tie.apart) + moved
    length = math.hypot(*now)
    return Reached(moved, way, now / length if length else np.zeros(2))


def at_rest(ties: Sequence[ChainLink]) -> list[Tied]:
    """Return elongations and forces of links in the geometry in which they are given."""
    return [pulled(one, _reached(one, np.zeros(2), np.zeros((2, 1)))) for one in ties]


def rocked(
    ties: Sequence[ChainLink], ends: Sequence[Ends], upper: int, pivot: tuple[float, float],
    rotation: float,
) -> list[Tied]:  # fmt: skip
    """Return elongations and forces of links as some bodies rotate as one about a fixed point.

    These are the bodies from the top down to `upper`. `ends` are both points of each link, upright.
    """
    sine, lacks = math.sin(rotation), 2.0 * math.sin(0.5 * rotation) ** 2
    found = list[Tied]()
    for tie, both in zip(ties, ends, strict=True):
        moved, way = np.zeros(2), np.zeros((2, 1))
        for k, end, sign in ((tie.on, both[0], 1.0), (tie.to, both[1], -1.0)):
            if GROUND < k <= upper:
                x, y = end[0] - pivot[0], end[1] - pivot[1]
                turned = np.array([y * sine - x * lacks, -x * sine - y * lacks])
                moved += sign * turned
                way[:, 0] += sign * np.array([y + turned[1], -x - turned[0]])
        found.append(pulled(tie, _reached(tie, moved, way)))
    return found


def _frames(bodies: Sequence[StandingBody], stands: Sequence[Stand]) -> list[_Frame]:
    """Return displacements of bodies from where they are given, and their axes."""
    found, place, turned = list[_Frame](), np.zeros(2), 0.0
    sine, cosine = 0.0, 1.0
    for k in range(len(stands) - 1, -1, -1):
        stand, body = stands[k], bodies[k].part.body
        fixed = bodies[k + 1].top + body.height if k + 1 < len(stands) else body.height
        along, normal = np.array([cosine, -sine]), np.array([sine, cosine])
        lacks = versine(sine, cosine)
        lift = np.array([fixed * sine, -fixed * lacks])  # of what is fixed normal to the base
        beside = bodies[k].beside
        slid = (stand.across - beside) * along + beside * np.array([-lacks, -sine])
        place = place + slid + lift + stand.state.vertical * normal
        turned += stand.state.rotation
        sine, cosine = sine_cosine(turned)
        found.append(_Frame(place, sine, cosine, along, normal))
    return found[::-1]


def _point(
    k: int, point: tuple[float, float], stands: Sequence[Stand], frames: Sequence[_Frame]
) -> tuple[Vector, Matrix]:
    """Return the displacement of a point of a body, and its derivatives by all coordinates."""
    way = np.zeros((2, 2 * len(stands)))
    if k == GROUND:
        return np.zeros(2), way
    one = frames[k]
    lacks = versine(one.sine, one.cosine)
    x, y = point
    turned = np.array([y * one.sine - x * lacks, -x * one.sine - y * lacks])
    # from the centre of mass of each body below, as that rotates
    arm = np.array([x, y]) + turned
    for j in range(k, len(stands)):
        frame = frames[j]
        far = arm if j == k else arm + _between(k, j, stands, frames)
        way[:, 2 * j] = stands[j].reach.derivative * frame.along + np.array([far[1], -far[0]])
        way[:, 2 * j + 1] = frame.normal
    return one.place + turned, way


def _between(k: int, j: int, stands: Sequence[Stand], frames: Sequence[_Frame]) -> Vector:
    """Return the place of the centre of mass of body k from that of body j below it."""
    return sum(
        (stands[i].across * frames[i].along + stands[i].arm * frames[i].normal
         for i in range(k, j)), start=np.zeros(2),
    )  # fmt: skip
