"""Statics of links between bodies: elongations, forces, and generalised forces on the bodies.

A link is in the state that follows from slow loading up to its elongation. Its force does work
on every rotation and height between its points, :eq:`eq-link-statics`.
"""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from rockframe.compiled import Matrix, Vector
from rockframe.dynamics.body_statics import Pose, StandingBody
from rockframe.dynamics.chain.link_rows import GROUND, ChainLink
from rockframe.dynamics.events import LinkState
from rockframe.dynamics.links import Stretch
from rockframe.dynamics.trigonometry import sine_cosine, versine

Ends = tuple[tuple[float, float], tuple[float, float]]
"""Both points of a link (x, y) [m]."""

RATE_STEP = 1e-3
"""Step of the rate for the derivative of a link's force by it [m s^-1]."""
ELONGATION_STEP = 1e-6
"""Step of the elongation for the derivative of a link's force, over the size of bodies [1]."""


class LinkForce(NamedTuple):
    """Force and geometry of a link between bodies at rest."""

    force: float  # with which it pulls
    state: int
    stiffness: float  # derivative of the force by the elongation
    damping: float  # derivative of the force by the rate of elongation
    elongation: float
    jacobian: Matrix  # derivatives of `displacement` by all coordinates
    direction: Vector  # unit, from the second to the first; zero where they coincide without force
    displacement: Vector  # displacement of its first point relative to its second [m]
    coincide: bool  # whether both points coincide in the reference geometry

    @property
    def loads(self) -> Vector:
        """Generalised forces on rotation and height of each body on its base."""
        loads: Vector = -self.force * (self.direction @ self.jacobian)
        return loads

    @property
    def damping_matrix(self) -> Matrix:
        """Damping matrix of its dashpot, along the link, or in any direction if points coincide."""
        along = self.direction @ self.jacobian
        if self.direction.any():
            return self.damping * np.outer(along, along)
        return self.damping * self.jacobian.T @ self.jacobian


class _Frame(NamedTuple):
    """Displacement and rotation of a body, and the axes of the deck beneath it."""

    place: Vector
    sine: float  # of its rotation
    cosine: float
    along: Vector
    normal: Vector


class LinkKinematics(NamedTuple):
    """Motion of the first point of a link relative to its second."""

    displacement: Vector  # displacement from the reference geometry [m]
    jacobian: Matrix  # derivatives of this by all coordinates
    direction: Vector  # unit vector away from the second point; zero where both coincide


def link_kinematics(
    bodies: Sequence[StandingBody], poses: Sequence[Pose], ties: Sequence[ChainLink]
) -> list[LinkKinematics]:
    """Return the relative displacements of the points of links, from the poses of bodies."""
    frames, kinematics = _frames(bodies, poses) if ties else [], list[LinkKinematics]()
    for tie in ties:
        on, on_jacobian = _point(tie.on, tie.on_point, poses, frames)
        to, to_jacobian = _point(tie.to, tie.to_point, poses, frames)
        kinematics.append(_relative_motion(tie, on - to, on_jacobian - to_jacobian))
    return kinematics


def link_forces(
    bodies: Sequence[StandingBody],
    poses: Sequence[Pose],
    ties: Sequence[ChainLink],
    states: Sequence[int] | None = None,
    elongations: Sequence[float] | None = None,
) -> list[LinkForce]:
    """Return elongations and forces of links at poses; forces of other `elongations`, if given."""
    default = [None] * len(ties)
    points = link_kinematics(bodies, poses, ties)
    others = default if elongations is None else elongations
    rows = zip(ties, points, states or default, others, strict=True)
    return [link_force(*row) for row in rows]


def link_force(
    tie: ChainLink,
    point: LinkKinematics,
    state: int | None = None,
    of_elongation: float | None = None,
) -> LinkForce:
    """Return elongation and force of a link; the force may be that of another elongation."""
    displacement, jacobian, direction = point
    apart, along, coincide = np.array(tie.separation), any(tie.along), False
    if along:
        elongation = float(direction @ displacement)
    else:
        length, coincide = math.hypot(*(apart + displacement)) + math.hypot(*apart), not apart.any()
        elongation = float((2.0 * apart + displacement) @ displacement) / length if length else 0.0
    in_law = elongation if of_elongation is None or coincide else of_elongation
    values = _law_values(tie, in_law, state)
    if not direction.any() and values[0] != 0.0:
        direction = np.array([0.0, 1.0])
    return LinkForce(*values, elongation, jacobian, direction, displacement, coincide)


def static_link_force(tie: ChainLink, elongation: float) -> float:
    """Return the force of a link after slow loading to an elongation."""
    return _law_values(tie, elongation, None)[0]


def is_broken(tie: ChainLink, elongation: float) -> bool:
    """Whether a link is broken after slow loading to an elongation."""
    law: Any = tie.numbers.law
    return bool(law.shown(_law_values(tie, elongation, None)[1]) == LinkState.BROKEN)


def _law_values(
    tie: ChainLink, elongation: float, state: int | None
) -> tuple[float, int, float, float]:
    """Return a link's force, its state, and the force's derivatives by elongation and rate."""
    law: Any = tie.numbers.law
    length, reach = math.hypot(*tie.separation), tie.length_scale
    stretch, own = Stretch(elongation, 0.0, 0.0, length, 1e-15 * reach), np.zeros(law.variables())
    starting = law.starting(stretch, own)
    law_state = starting if state is None else state
    steps = {"elongation": ELONGATION_STEP * (reach or 1.0), "rate": RATE_STEP}
    changes = [
        0.5 * (more - less) / step
        for name, step in steps.items()
        for more, less in [[
            law.force(law_state, stretch._replace(**{name: getattr(stretch, name) + by}), own)
            for by in (step, -step)
        ]]
    ]  # fmt: skip
    return law.force(law_state, stretch, own), law_state, changes[0], changes[1]


def _relative_motion(tie: ChainLink, displacement: Vector, jacobian: Matrix) -> LinkKinematics:
    """Return relative displacement, its derivatives and the direction of a link."""
    if any(tie.along):
        return LinkKinematics(displacement, jacobian, np.array(tie.along))
    separation = np.array(tie.separation) + displacement
    length = math.hypot(*separation)
    return LinkKinematics(displacement, jacobian, separation / length if length else np.zeros(2))


def links_at_rest(ties: Sequence[ChainLink]) -> list[LinkForce]:
    """Return elongations and forces of links in the reference geometry."""
    return [link_force(tie, _relative_motion(tie, np.zeros(2), np.zeros((2, 1)))) for tie in ties]


def links_of_rocking_bodies(
    ties: Sequence[ChainLink], ends: Sequence[Ends], upper: int, pivot: tuple[float, float],
    rotation: float,
) -> list[LinkForce]:  # fmt: skip
    """Return elongations and forces of links as some bodies rotate as one about a fixed point.

    These are the bodies from the top down to `upper`. `ends` are both points of each link, upright.
    """
    sine, vers = math.sin(rotation), 2.0 * math.sin(0.5 * rotation) ** 2
    forces = list[LinkForce]()
    for tie, both in zip(ties, ends, strict=True):
        displacement, jacobian = np.zeros(2), np.zeros((2, 1))
        for k, end, sign in ((tie.on, both[0], 1.0), (tie.to, both[1], -1.0)):
            if GROUND < k <= upper:
                x, y = end[0] - pivot[0], end[1] - pivot[1]
                shift = np.array([y * sine - x * vers, -x * sine - y * vers])
                displacement += sign * shift
                jacobian[:, 0] += sign * np.array([y + shift[1], -x - shift[0]])
        forces.append(link_force(tie, _relative_motion(tie, displacement, jacobian)))
    return forces


def _frames(bodies: Sequence[StandingBody], poses: Sequence[Pose]) -> list[_Frame]:
    """Return displacements of bodies from the reference geometry, and their axes."""
    frames, place, rotation = list[_Frame](), np.zeros(2), 0.0
    sine, cosine = 0.0, 1.0
    for k in range(len(poses) - 1, -1, -1):
        pose, body = poses[k], bodies[k].part.body
        fixed = bodies[k + 1].top + body.height if k + 1 < len(poses) else body.height
        along, normal = np.array([cosine, -sine]), np.array([sine, cosine])
        vers = versine(sine, cosine)
        # shift of the centre of mass by rotation of the fixed distance normal to the base
        shift_normal = np.array([fixed * sine, -fixed * vers])
        offset = bodies[k].offset
        shift_along = (pose.across - offset) * along + offset * np.array([-vers, -sine])
        place = place + shift_along + shift_normal + pose.state.vertical * normal
        rotation += pose.state.rotation
        sine, cosine = sine_cosine(rotation)
        frames.append(_Frame(place, sine, cosine, along, normal))
    return frames[::-1]


def _point(
    k: int, point: tuple[float, float], poses: Sequence[Pose], frames: Sequence[_Frame]
) -> tuple[Vector, Matrix]:
    """Return the displacement of a point of a body, and its derivatives by all coordinates."""
    jacobian = np.zeros((2, 2 * len(poses)))
    if k == GROUND:
        return np.zeros(2), jacobian
    axes = frames[k]
    vers = versine(axes.sine, axes.cosine)
    x, y = point
    shift = np.array([y * axes.sine - x * vers, -x * axes.sine - y * vers])
    # from the centre of mass of each body below, as that rotates
    arm = np.array([x, y]) + shift
    for j in range(k, len(poses)):
        frame = frames[j]
        far = arm if j == k else arm + _centre_offset(k, j, poses, frames)
        jacobian[:, 2 * j] = poses[j].reach.derivative * frame.along + np.array([far[1], -far[0]])
        jacobian[:, 2 * j + 1] = frame.normal
    return axes.place + shift, jacobian


def _centre_offset(k: int, j: int, poses: Sequence[Pose], frames: Sequence[_Frame]) -> Vector:
    """Return the centre of mass of body k relative to that of body j below it."""
    return sum(
        (poses[i].across * frames[i].along + poses[i].arm * frames[i].normal
         for i in range(k, j)), start=np.zeros(2),
    )  # fmt: skip
