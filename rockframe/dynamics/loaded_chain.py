"""Bodies on one another under their weights and the forces of links, at given positions.

The forces are those of the equations of motion. Each body stands on the deck of the one beneath it.
At given rotations on the bases, a base carries the load above it, at a height that follows from its
law; unbalanced moments remain, :eq:`eq-static-chain`. All numbers are per unit mass.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rockframe.compiled import Matrix, Vector
from rockframe.dynamics.body_statics import (
    DISPLACEMENTS,
    Pose,
    StandingBody,
    equilibrium_pose,
    pose_at_height,
    pose_on_corner,
)
from rockframe.dynamics.chain.link_rows import ChainLink
from rockframe.dynamics.link_statics import (
    LinkForce,
    LinkKinematics,
    link_forces,
    link_kinematics,
)
from rockframe.dynamics.trigonometry import sine_cosine, versine


class LoadedChain(NamedTuple):
    """Bodies that stand on one another, from the top down, and gravity along the lowest base."""

    bodies: tuple[StandingBody, ...]
    along_gravity: float = 0.0
    ties: tuple[ChainLink, ...] = ()
    link_factor: float = 1.0  # of the forces of links

    @property
    def rests_upright(self) -> bool:
        """Whether no load rotates the bodies away from upright."""
        level = self.along_gravity == 0.0 and not self.ties
        return level and all(body.offset == 0.0 for body in self.bodies)

    def scaled(self, share: float) -> "LoadedChain":
        """Return the chain with a share of its slope, eccentricities and forces of links."""
        if share == 1.0:
            return self
        return self._replace(
            bodies=tuple(body.scaled(share) for body in self.bodies),
            along_gravity=share * self.along_gravity,
            link_factor=share * self.link_factor,
        )

    def gravity_components(self, rotations: Sequence[float]) -> list[tuple[float, float]]:
        """Return gravity normal to the deck under each body, and along it."""
        normal, along = self.bodies[0].part.body.gravity, self.along_gravity
        rotation_below, components = 0.0, [(normal, along)]
        for rotation in reversed(rotations[1:]):
            rotation_below += rotation
            sine, cosine = sine_cosine(rotation_below)
            components.append((normal * cosine + along * sine, along * cosine - normal * sine))
        return components[::-1]

    @property
    def weight(self) -> float:
        """The weight of all bodies on a level base."""
        return self.bodies[0].part.body.gravity * sum(body.mass for body in self.bodies)

    @property
    def sizes(self) -> Vector:
        """Typical sizes of rotation and height of each body on its base."""
        return np.ravel([(body.allowed_rotation, body.settlement) for body in self.bodies])

    def _under_weight(self, rotations: Sequence[float]) -> list[Pose] | None:
        """Return the bodies at rotations on their bases, without their links."""
        mass, poses = 0.0, list[Pose]()
        gravity = self.gravity_components(rotations)
        for standing, rotation, (normal, _) in zip(self.bodies, rotations, gravity, strict=True):
            mass += standing.mass
            if not mass * normal > 0.0:
                return None
            poses.append(equilibrium_pose(standing, rotation, mass * normal))
        return self._with_arms(poses)

    def _with_arms(self, poses: Sequence[Pose]) -> list[Pose]:
        """Return the bodies with their heights over the bodies beneath them."""
        decks = [*(body.top for body in self.bodies[1:]), 0.0]
        return [
            pose._replace(arm=deck + standing.part.body.height + pose.state.vertical)
            for standing, pose, deck in zip(self.bodies, poses, decks, strict=True)
        ]

    def poses_of(self, rotations: Vector, heights: Vector, forces: Vector) -> list[Pose]:
        """Return the bodies on bases that carry normal forces, or at heights if lifted off them."""
        numbers = (rotations.tolist(), heights.tolist(), forces.tolist())
        places = zip(self.bodies, *numbers, strict=True)
        return self._with_arms([
            equilibrium_pose(standing, rotation, force) if force > 0.0
            else pose_at_height(standing, rotation, height)
            for standing, rotation, height, force in places
        ])  # fmt: skip

    def displaced(self, poses: Sequence[Pose], at: int, by: float) -> list[Pose]:
        """Return the bodies with one coordinate changed, the forces of their bases unchanged."""
        k, displaced = at // 2, [*poses]
        standing, pose = self.bodies[k], poses[k]
        state = pose.state._replace(**{DISPLACEMENTS[at % 2]: pose.state[at % 2] + by})
        if standing.corner:
            displaced[k] = pose_on_corner(standing, state.rotation, pose.normal_force)
        else:
            attitude = standing.part.body.attitude(state.rotation)
            reach, across = standing.centre_on_deck(attitude, pose.mode.pivot)
            displaced[k] = pose._replace(state=state, reach=reach, across=across)
        return self._with_arms(displaced)

    def constraint_matrix(self, poses: Sequence[Pose]) -> Matrix:
        """Return derivatives of coordinates by the free ones: on a corner no height is free."""
        matrix = np.eye(2 * len(poses))
        for k, (standing, pose) in enumerate(zip(self.bodies, poses, strict=True)):
            if standing.corner:
                matrix[2 * k + 1, 2 * k] = -standing.corner_lever(pose)
                matrix[2 * k + 1, 2 * k + 1] = 0.0
        return matrix

    def weights(self, poses: Sequence[Pose]) -> list[tuple[float, float]]:
        """Return the generalised forces of all weights on rotation and height of each body."""
        forces = list[tuple[float, float]]()
        mass = side = height = 0.0  # of what stands on a body, and its moments about the centre
        gravity = self.gravity_components([pose.state.rotation for pose in poses])
        for standing, pose, (normal, along) in zip(self.bodies, poses, gravity, strict=True):
            if mass > 0.0:  # from the axes of its deck to those of the one beneath
                sine, cosine = sine_cosine(pose.state.rotation)
                height += mass * standing.top
                side, height = side * cosine + height * sine, height * cosine - side * sine
            mass += standing.mass
            moment = normal * side - along * (height + mass * pose.reach.derivative)
            forces.append((moment, -mass * normal))
            side += mass * pose.across
            height += mass * (standing.part.body.height + pose.state.vertical)
        return forces

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
        loads = np.zeros(2 * len(poses))
        for link in self.link_forces(poses, states):
            loads += self.link_factor * link.loads
        return loads

    def generalized_loads(self, poses: Sequence[Pose], of_links: Vector) -> Vector:
        """Return the generalised forces of weights and links on rotation and height of each body.

        A body that rests on a corner has none on its height: it follows from the rotation.
        """
        loads = np.ravel(self.weights(poses)) + of_links
        for k, (standing, pose) in enumerate(zip(self.bodies, poses, strict=True)):
            if standing.corner:
                loads[2 * k] -= standing.corner_lever(pose) * loads[2 * k + 1]
                loads[2 * k + 1] = 0.0
        return loads

    def moments(self, poses: Sequence[Pose]) -> list[float]:
        """Return the generalised force on each body's rotation on its base."""
        weights = self.weights(poses)
        moments = [pose.force.moment + of[0] for pose, of in zip(poses, weights, strict=True)]
        if self.ties:
            from_links = self.link_loads(poses)[::2].tolist()
            moments = [moment + more for moment, more in zip(moments, from_links, strict=True)]
        return moments

    def rise(self, poses: Sequence[Pose]) -> float:
        """Return the rise of the highest centre of mass from upright rest [m]."""
        rise = rotation_below = top = 0.0
        for standing, pose in zip(self.bodies[::-1], poses[::-1], strict=True):
            sine, cosine = sine_cosine(rotation_below)
            if rotation_below != 0.0:
                drop = (top + standing.part.body.height) * versine(sine, cosine)
                rise -= pose.across * sine + drop
            rise += pose.state.vertical * cosine
            rotation_below, top = rotation_below + pose.state.rotation, standing.top
        return rise
