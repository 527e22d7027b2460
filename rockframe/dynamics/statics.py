"""Statics of bodies on one another, with the forces of their equations of motion.

Each body stands on the deck of the one beneath it. For given rotations on the bases, a base carries
the load above it, at a height that follows from its law; unbalanced moments remain,
:eq:`eq-static-chain`. All numbers are per unit mass.
"""

import math
from collections.abc import Sequence
from functools import partial
from typing import Final, NamedTuple, cast

import numpy as np

from rockframe.compiled import Matrix, Vector
from rockframe.dynamics.body_statics import (
    DISPLACEMENTS,
    ROUNDING,
    Pose,
    StandingBody,
    equilibrium_pose,
    pose_at_height,
    pose_on_corner,
)
from rockframe.dynamics.chain.link_rows import ChainLink
from rockframe.dynamics.equilibrium import (
    ChainEquilibrium,
    EquilibriumPath,
    HeldBodies,
    follow_equilibrium,
)
from rockframe.dynamics.link_statics import (
    LinkForce,
    LinkKinematics,
    is_broken,
    link_forces,
    link_kinematics,
)
from rockframe.dynamics.trigonometry import sine_cosine, versine

MAX_HEIGHT_CHANGE: Final = 10.0
"""Change of a body's height over its size beyond which no equilibrium is searched [1]."""
HEIGHT_TOLERANCE: Final = 1e-30
"""Absolute tolerance of a height, practically zero [m]."""
MAX_RESIDUAL: Final = 1e-6
"""Unbalanced force over the weight that is allowed, for links as stiff as rounding permits [1]."""


class StandingChain(NamedTuple):
    """Bodies that stand on one another, from the top down, and gravity along the lowest base.

    The forces of links are multiplied by `link_factor`.
    """

    bodies: tuple[StandingBody, ...]
    along_gravity: float = 0.0
    ties: tuple[ChainLink, ...] = ()
    link_factor: float = 1.0

    @property
    def rests_upright(self) -> bool:
        """Whether no load rotates the bodies away from upright."""
        level = self.along_gravity == 0.0 and not self.ties
        return level and all(one.offset == 0.0 for one in self.bodies)

    def scaled(self, share: float) -> "StandingChain":
        """Return the chain with a share of its slope, eccentricities and forces of links."""
        if share == 1.0:
            return self
        bodies = tuple(one.scaled(share) for one in self.bodies)
        return StandingChain(
            bodies, share * self.along_gravity, self.ties, share * self.link_factor
        )

    def gravity_components(self, rotations: Sequence[float]) -> list[tuple[float, float]]:
        """Return gravity normal to the deck under each body, and along it."""
        normal, along = self.bodies[0].part.body.gravity, self.along_gravity
        rotation_below, found = 0.0, [(normal, along)]
        for rotation in reversed(rotations[1:]):
            rotation_below += rotation
            sine, cosine = sine_cosine(rotation_below)
            found.append((normal * cosine + along * sine, along * cosine - normal * sine))
        return found[::-1]

    @property
    def weight(self) -> float:
        """The weight of all bodies on a level base."""
        return self.bodies[0].part.body.gravity * sum(one.mass for one in self.bodies)

    @property
    def sizes(self) -> Vector:
        """Typical sizes of rotation and height of each body on its base."""
        return np.ravel([(one.allowed_rotation, one.settlement) for one in self.bodies])

    def poses_at(self, rotations: Sequence[float]) -> list[Pose] | None:
        """Return the bodies at rotations on their bases; None where a base would be in tension."""
        if len(rotations) == 1:
            return self.curve(rotations)[0]
        poses = self._under_weight(rotations)
        if poses is None or not self.ties:
            return poses
        return self._path_end(self._grow_loads(poses, np.eye(len(rotations)).tolist()))

    def _has_broken(self, poses: Sequence[Pose]) -> bool:
        """Whether a link is broken in these poses."""
        found = self.link_forces(poses) if poses and self.ties else []
        return any(is_broken(one, of.elongation) for one, of in zip(self.ties, found, strict=False))

    def _single_body_at(self, rotation: float) -> list[Pose] | None:
        """Return a single body at a rotation, with links in their state after slow loading."""
        poses = self._under_weight([rotation])
        if poses is None or not self.ties:
            return poses
        if self.bodies[0].corner:
            return self._path_end(self._grow_loads(poses, [[1.0]]))
        return self._single_body_in_balance(poses[0])

    def _single_body_in_balance(self, pose: Pose) -> list[Pose] | None:
        """Return a single body at its rotation, its height found by bracketing.

        Newton's method fails where links yield or break, as these have no stiffness then.
        """
        from scipy.optimize import brentq

        standing, at = self.bodies[0], partial(self._pose_at_height, pose.state.rotation)
        here, far = pose.state.vertical, MAX_HEIGHT_CHANGE * standing.part.body.size()
        found, residual = at(here)
        if abs(residual) <= 4.0 * ROUNDING * self.weight:
            return found
        step = math.copysign(standing.settlement, residual)
        there = here + step
        while at(there)[1] * step > 0.0:
            step *= 2.0
            here, there = there, there + step
            if abs(step) > far:
                return None
        height = brentq(lambda height: at(height)[1], here, there, xtol=HEIGHT_TOLERANCE)
        found, residual = at(cast("float", height))
        return found if abs(residual) <= MAX_RESIDUAL * self.weight else None

    def _pose_at_height(self, rotation: float, height: float) -> tuple[list[Pose], float]:
        """Return a single body at a rotation and a height, and the upward force on it."""
        poses = self._with_arms([pose_at_height(self.bodies[0], rotation, height)])
        load = self.weights(poses)[0][1] + self.link_loads(poses)[1]
        return poses, float(poses[0].force.upward + load)

    def uplift_rotation(self, side: float) -> float:
        """Return rotation to a side at which an end of a single body with links lifts off [rad].

        NaN if there is none up to a right angle.
        """
        from scipy.optimize import brentq

        (standing,) = self.bodies

        def residual(rotation: float) -> float:
            start = pose_at_height(standing, rotation, 0.0)
            height = standing.part.base.level(side > 0.0, start.line, start.own)
            return self._pose_at_height(rotation, height)[1]

        far = side * standing.allowed_rotation
        while residual(far) < 0.0:
            far *= 2.0
            if abs(far) > 0.5 * math.pi:
                return math.nan
        return cast("float", brentq(residual, 0.0, far))

    def _under_weight(self, rotations: Sequence[float]) -> list[Pose] | None:
        """Return the bodies at rotations on their bases, without their links."""
        mass, found = 0.0, list[Pose]()
        gravity = self.gravity_components(rotations)
        for standing, rotation, (normal, _) in zip(self.bodies, rotations, gravity, strict=True):
            mass += standing.mass
            if not mass * normal > 0.0:
                return None
            found.append(equilibrium_pose(standing, rotation, mass * normal))
        return self._with_arms(found)

    def _with_arms(self, poses: Sequence[Pose]) -> list[Pose]:
        """Return the bodies with their heights over the bodies beneath them."""
        decks = [*(one.top for one in self.bodies[1:]), 0.0]
        return [
            one._replace(arm=deck + standing.part.body.height + one.state.vertical)
            for standing, one, deck in zip(self.bodies, poses, decks, strict=True)
        ]

    def poses_of(self, balance: ChainEquilibrium) -> list[Pose]:
        """Return the bodies on bases that carry the forces of a balance, or lifted off them."""
        places = zip(self.bodies, *(each.tolist() for each in balance[:3]), strict=True)
        return self._with_arms([
            equilibrium_pose(one, rotation, force) if force > 0.0
            else pose_at_height(one, rotation, height)
            for one, rotation, height, force in places
        ])  # fmt: skip

    def displaced(self, poses: Sequence[Pose], at: int, by: float) -> list[Pose]:
        """Return the bodies with one coordinate changed, the forces of their bases unchanged."""
        k, found = at // 2, [*poses]
        standing, now = self.bodies[k], poses[k]
        state = now.state._replace(**{DISPLACEMENTS[at % 2]: now.state[at % 2] + by})
        if standing.corner:
            found[k] = pose_on_corner(standing, state.rotation, now.normal_force)
        else:
            attitude = standing.part.body.attitude(state.rotation)
            reach, across = standing.centre_on_deck(attitude, now.mode.pivot)
            found[k] = now._replace(state=state, reach=reach, across=across)
        return self._with_arms(found)

    def constraint_matrix(self, poses: Sequence[Pose]) -> Matrix:
        """Return derivatives of coordinates by the free ones: on a corner no height is free."""
        found = np.eye(2 * len(poses))
        for k, (standing, pose) in enumerate(zip(self.bodies, poses, strict=True)):
            if standing.corner:
                found[2 * k + 1, 2 * k] = -standing.corner_lever(pose)
                found[2 * k + 1, 2 * k + 1] = 0.0
        return found

    def generalized_loads(self, poses: Sequence[Pose], of_links: Vector) -> Vector:
        """Return the generalised forces of weights and links on rotation and height of each body.

        A body that rests on a corner has none on its height: it follows from the rotation.
        """
        found = np.ravel(self.weights(poses)) + of_links
        for k, (standing, pose) in enumerate(zip(self.bodies, poses, strict=True)):
            if standing.corner:
                found[2 * k] -= standing.corner_lever(pose) * found[2 * k + 1]
                found[2 * k + 1] = 0.0
        return found

    def _path_end(self, path: EquilibriumPath | None) -> list[Pose] | None:
        """Return the bodies at the end of a path; corners of rigid bases carry the rest."""
        if path is None:
            return None
        poses = self.poses_of(path.equilibrium)
        loads = np.ravel(self.weights(poses))
        for force, one in zip(
            path.equilibrium.link_forces, self.link_kinematics(poses), strict=True
        ):
            loads -= force @ one.jacobian
        for k, (standing, one) in enumerate(zip(self.bodies, poses, strict=True)):
            if standing.corner:
                poses[k] = pose_on_corner(standing, one.state.rotation, -float(loads[2 * k + 1]))
        is_compressed = all(one.normal_force >= 0.0 for one in poses)
        return self._with_arms(poses) if is_compressed else None

    def link_kinematics(self, poses: Sequence[Pose]) -> list[LinkKinematics]:
        """Return displacements of the points of the links."""
        return link_kinematics(self.bodies, poses, self.ties)

    def link_forces(
        self, poses: Sequence[Pose], states: Sequence[int] | None = None,
        elongations: Sequence[float] | None = None,
    ) -> list[LinkForce]:  # fmt: skip
        """Return elongations and forces of the links."""
        return link_forces(self.bodies, poses, self.ties, states, elongations)

    def link_loads(self, poses: Sequence[Pose], states: Sequence[int] | None = None) -> Vector:
        """Return the generalised forces of links on rotation and height of each body."""
        found = np.zeros(2 * len(poses))
        for one in self.link_forces(poses, states):
            found += self.link_factor * one.loads
        return found

    def moments(self, poses: Sequence[Pose]) -> list[float]:
        """Return the generalised force on each body's rotation on its base."""
        weights = self.weights(poses)
        found = [pose.force.moment + of[0] for pose, of in zip(poses, weights, strict=True)]
        if self.ties:
            from_links = self.link_loads(poses)[::2].tolist()
            found = [moment + more for moment, more in zip(found, from_links, strict=True)]
        return found

    def weights(self, poses: Sequence[Pose]) -> list[tuple[float, float]]:
        """Return the generalised forces of all weights on rotation and height of each body."""
        found = list[tuple[float, float]]()
        mass = side = height = 0.0  # of what stands on a body, and its moments about the centre
        gravity = self.gravity_components([pose.state.rotation for pose in poses])
        for standing, pose, (normal, along) in zip(self.bodies, poses, gravity, strict=True):
            if mass > 0.0:  # from the axes of its deck to those of the one beneath
                sine, cosine = sine_cosine(pose.state.rotation)
                height += mass * standing.top
                side, height = side * cosine + height * sine, height * cosine - side * sine
            mass += standing.mass
            moment = normal * side - along * (height + mass * pose.reach.derivative)
            found.append((moment, -mass * normal))
            side += mass * pose.across
            height += mass * (standing.part.body.height + pose.state.vertical)
        return found

    def rise(self, poses: Sequence[Pose]) -> float:
        """Return the rise of the highest centre of mass from upright rest [m]."""
        found = rotation_below = top = 0.0
        for standing, pose in zip(self.bodies[::-1], poses[::-1], strict=True):
            sine, cosine = sine_cosine(rotation_below)
            if rotation_below != 0.0:
                drop = (top + standing.part.body.height) * versine(sine, cosine)
                found -= pose.across * sine + drop
            found += pose.state.vertical * cosine
            rotation_below, top = rotation_below + pose.state.rotation, standing.top
        return found

    def rest(self) -> list[Pose] | None:
        """Return the bodies at rest under their weight, :eq:`eq-tilted-rest`; None if they fall.

        Eccentricity and slope grow from zero, and the equilibrium is followed from upright: a chain
        that leans has a second equilibrium, farther out, which is unstable.
        """
        upright = self._under_weight([0.0] * len(self.bodies))
        if upright is None or self.rests_upright:
            return upright
        return self._path_end(self._grow_loads(upright, []))

    def curve(self, rotations: Sequence[float]) -> list[list[Pose] | None]:
        """Return the bodies while a couple holds the highest one at each of some rotations.

        Equilibrium is followed from upright to either side; None from where it ends.
        """
        one, every = len(self.bodies) == 1, range(len(rotations))
        found = [self._single_body_at(rotation) if one else None for rotation in rotations]
        # a link that is broken at one height of a body may be whole at another
        sought = [i for i in every if not one or self._has_broken(found[i] or [])]
        for side in (1.0, -1.0):
            here = [i for i in sought if math.copysign(1.0, rotations[i]) == side]
            path = self._upright_path() if here else None
            for i in sorted(here, key=lambda i: abs(rotations[i])):
                if path is None:
                    break
                path, poses = self.held_at(path, rotations[i])
                found[i] = poses or found[i]
        return found

    def _upright_path(self) -> EquilibriumPath | None:
        """Return the start of the curve: equilibrium under all loads, the highest body upright."""
        upright = self._under_weight([0.0] * len(self.bodies))
        loaded = None if upright is None else self._grow_loads(upright, [len(self.bodies) * [1.0]])
        return None if loaded is None else EquilibriumPath(0.0, loaded.equilibrium)

    def held_at(
        self, path: EquilibriumPath, rotation: float
    ) -> tuple[EquilibriumPath | None, list[Pose] | None]:
        """Return path and bodies at a rotation of the highest one, followed from a path so far."""
        highest, size = np.ones((1, len(self.bodies))), float(self.sizes[::2].min())
        further = follow_equilibrium(
            lambda at: HeldBodies(self, highest, np.array([at])), path, rotation, size
        )
        return further, self._path_end(further)

    def _grow_loads(
        self, poses: Sequence[Pose], rotation_weights: Sequence[Sequence[float]]
    ) -> EquilibriumPath | None:
        """Follow bodies as eccentricity, slope and links grow, with sums of rotations held."""
        rows = np.array(rotation_weights).reshape(-1, len(poses))
        start = ChainEquilibrium.from_poses(self, poses, len(rows))
        held = rows @ start.rotations
        return follow_equilibrium(
            lambda share: HeldBodies(self.scaled(share), rows, held), EquilibriumPath(0.0, start)
        )
