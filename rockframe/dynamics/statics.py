"""Equilibrium of bodies on one another: at rest, and with rotations that a couple holds.

All numbers are per unit mass.
"""

import math
from collections.abc import Sequence
from functools import partial
from typing import Final, cast

import numpy as np

from rockframe.dynamics.body_statics import ROUNDING, Pose, pose_at_height, pose_on_corner
from rockframe.dynamics.equilibrium import (
    ChainEquilibrium,
    EquilibriumPath,
    HeldBodies,
    follow_equilibrium,
)
from rockframe.dynamics.link_statics import is_broken
from rockframe.dynamics.loaded_chain import LoadedChain

MAX_HEIGHT_CHANGE: Final = 10.0
"""Change of a body's height over its size beyond which no equilibrium is searched [1]."""
HEIGHT_TOLERANCE: Final = 1e-30
"""Absolute tolerance of a height, practically zero [m]."""
MAX_RESIDUAL: Final = 1e-6
"""Unbalanced force over the weight that is allowed, for links as stiff as rounding permits [1]."""


class StandingChain(LoadedChain):
    """Bodies that stand on one another, from the top down, and their equilibria."""

    __slots__ = ()

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
        forces = self.link_forces(poses) if poses and self.ties else []
        return any(
            is_broken(tie, of.elongation) for tie, of in zip(self.ties, forces, strict=False)
        )

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
        body, residual = at(here)
        if abs(residual) <= 4.0 * ROUNDING * self.weight:
            return body
        step = math.copysign(standing.settlement, residual)
        beyond = here + step
        while at(beyond)[1] * step > 0.0:
            step *= 2.0
            here, beyond = beyond, beyond + step
            if abs(step) > far:
                return None
        height = brentq(lambda height: at(height)[1], here, beyond, xtol=HEIGHT_TOLERANCE)
        body, residual = at(cast("float", height))
        return body if abs(residual) <= MAX_RESIDUAL * self.weight else None

    def _pose_at_height(self, rotation: float, height: float) -> tuple[list[Pose], float]:
        """Return a single body at a rotation and a height, and the upward force on it."""
        poses = self._with_arms([pose_at_height(self.bodies[0], rotation, height)])
        load = self.weights(poses)[0][1] + self.link_loads(poses)[1]
        return poses, float(poses[0].force.upward + load)

    def uplift_rotation(self, side: float) -> float:
        """Return rotation to a side [rad] at which an end of one linked body lifts; NaN if none."""
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

    def _path_end(self, path: EquilibriumPath | None) -> list[Pose] | None:
        """Return the bodies at the end of a path; corners of rigid bases carry the rest."""
        if path is None:
            return None
        poses = self.poses_of(*path.equilibrium.positions)
        loads = np.ravel(self.weights(poses))
        for force, pose in zip(
            path.equilibrium.link_forces, self.link_kinematics(poses), strict=True
        ):
            loads -= force @ pose.jacobian
        for k, (standing, pose) in enumerate(zip(self.bodies, poses, strict=True)):
            if standing.corner:
                poses[k] = pose_on_corner(standing, pose.state.rotation, -float(loads[2 * k + 1]))
        is_compressed = all(pose.normal_force >= 0.0 for pose in poses)
        return self._with_arms(poses) if is_compressed else None

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
        is_single, every = len(self.bodies) == 1, range(len(rotations))
        curve = [self._single_body_at(rotation) if is_single else None for rotation in rotations]
        # a link that is broken at one height of a body may be whole at another
        sought = [i for i in every if not is_single or self._has_broken(curve[i] or [])]
        for side in (1.0, -1.0):
            here = [i for i in sought if math.copysign(1.0, rotations[i]) == side]
            path = self._upright_path() if here else None
            for i in sorted(here, key=lambda i: abs(rotations[i])):
                if path is None:
                    break
                path, poses = self.held_at(path, rotations[i])
                curve[i] = poses or curve[i]
        return curve

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
