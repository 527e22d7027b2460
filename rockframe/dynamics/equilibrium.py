"""Equilibrium of bodies on one another by Newton's method, continued as loads or a rotation grow.

Unknowns are coordinates, forces of links and couples that hold rotations, :eq:`eq-static-steps`:
the force of a practically rigid link follows from the equilibrium of the bodies, not from its
elongation, which is lost in rounding.
"""

import math
from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

import numpy as np

from rockframe.compiled import Matrix, Vector
from rockframe.dynamics.body_statics import (
    DIFFERENCE_STEP,
    DISPLACEMENTS,
    ROUNDING,
    STENCIL,
    Pose,
    base_derivatives,
)
from rockframe.dynamics.chain.link_rows import ChainLink
from rockframe.dynamics.link_statics import LinkForce, is_broken, static_link_force
from rockframe.dynamics.loaded_chain import LoadedChain

MAX_ITERATIONS: Final = 40
"""Largest number of steps of Newton's method."""
TOLERANCE: Final = 1e-12
"""Change of a coordinate in the last step, over the sum of its value and its size [1]."""
MAX_ROTATION_STEP: Final = 0.05
"""Largest difference of a rotation from its prediction, and largest step of Newton's [rad]."""
MIN_STEP: Final = 1e-3
"""Least step along the path, over its length, or over the size of what changes [1]."""
MIN_SHARE: Final = 2.0**-30
"""Least share of a step's elongation that a link without stiffness so far takes [1]."""
FORCE_TOLERANCE_RATIO: Final = 1e3
"""Last change of a link's force over the weight, allowed as a multiple of TOLERANCE [1]."""
DIVERGED: Final = 1e9
"""Change of a coordinate over its size at which a step has failed [1]."""
REVERSAL: Final = 0.25
"""Share of the last step that a step must undo for steps to be halved [1]."""
MIN_DAMPING: Final = 2.0**-6
"""Least share of a step after halving [1]."""
MAX_FORCE_CHANGE: Final = 0.25
"""Largest change of force in a step of a link without stiffness so far, over the weight [1]."""
SECANT: Final = ((1.0, 0.5),)
"""Stencil of a first derivative of second order, which is enough for a step of Newton's."""


class HeldBodies(NamedTuple):
    """Bodies under their loads, and rotations that couples hold."""

    chain: LoadedChain
    rotation_weights: Matrix  # weights of the rotations on bases in each rotation that is held
    rotations: Vector


class ChainEquilibrium(NamedTuple):
    """An equilibrium: rotations of bodies, from the top down, forces of bases and of links."""

    rotations: Vector
    heights: Vector  # used where a base carries nothing
    normal_forces: Vector  # normal forces of bases
    elongations: Vector  # elongations of links at which their laws give their forces
    link_forces: Matrix  # forces of links, to the right and up
    couples: Vector  # couples that hold rotations, against them

    @property
    def positions(self) -> tuple[Vector, Vector, Vector]:
        """Rotations, heights and normal forces, from which the poses of the bodies follow."""
        return self.rotations, self.heights, self.normal_forces

    @classmethod
    def from_poses(
        cls, chain: LoadedChain, poses: Sequence[Pose], held: int = 1
    ) -> "ChainEquilibrium":
        """Return the equilibrium of poses, without couples as yet on `held` rotations."""
        links = chain.link_forces(poses)
        return cls(
            np.array([pose.state.rotation for pose in poses]),
            np.array([pose.state.vertical for pose in poses]),
            np.array([pose.normal_force for pose in poses]),
            np.array([link.elongation for link in links]),
            np.array([link.force * link.direction for link in links]).reshape(-1, 2),
            np.zeros(held),
        )


class EquilibriumPath(NamedTuple):
    """An equilibrium on a path, and the one before it."""

    at: float
    equilibrium: ChainEquilibrium
    before: "tuple[float, ChainEquilibrium] | None" = None

    def extrapolated(self, at: float) -> ChainEquilibrium:
        """Return a prediction of the equilibrium further on, by linear extrapolation."""
        if self.before is None:
            return self.equilibrium
        share = (at - self.at) / (self.at - self.before[0])
        pairs = zip(self.equilibrium, self.before[1], strict=True)
        return ChainEquilibrium(*(now + share * (now - before) for now, before in pairs))


def follow_equilibrium(
    held: Callable[[float], HeldBodies],
    path: EquilibriumPath,
    to: float = 1.0,
    size: float = math.inf,
) -> EquilibriumPath | None:
    """Follow a stable equilibrium along a path; None where it ends.

    `size` is the length of the path within which, about, an end of a base lifts off.
    """
    step = length = to - path.at
    least_to_break = MIN_STEP * abs(length)
    least = min(least_to_break, MIN_STEP * size)
    while path.at != to:
        after = to if abs(to - path.at) <= abs(step) else path.at + step
        bodies, guess = held(after), path.extrapolated(after)
        equilibrium = find_equilibrium(bodies, guess)
        if (
            equilibrium is not None
            and _max_abs(equilibrium.rotations - guess.rotations) > MAX_ROTATION_STEP
        ):
            equilibrium = None
        # bodies may be in equilibrium, too, with a link broken that is not
        breaks = equilibrium is not None and _link_breaks(
            bodies.chain, path.equilibrium, equilibrium
        )
        if equilibrium is None or (breaks and abs(step) >= least_to_break):
            if abs(step) < least:
                return None
            step *= 0.5
        elif breaks:
            path, step = EquilibriumPath(after, equilibrium), to - after
        else:
            path, step = (
                EquilibriumPath(after, equilibrium, (path.at, path.equilibrium)),
                2.0 * step,
            )
    return path


def find_equilibrium(held: HeldBodies, guess: ChainEquilibrium) -> ChainEquilibrium | None:
    """Return a stable equilibrium near a guess, by Newton's steps.

    Heights follow from the forces of bases, so that contact may be lost within a step.
    """
    equilibrium, poses = guess, held.chain.poses_of(*guess.positions)
    damped, before = 1.0, np.zeros(2 * len(guess.rotations))
    for count in range(MAX_ITERATIONS):
        now = _Step(held, poses, equilibrium)
        if not now.is_bounded:
            return None
        if now.has_converged and count == 0:
            return guess if now.is_stable() else None
        # alternating contacts or links would make the steps oscillate
        reverses = now.step @ before < -REVERSAL * (before @ before)
        damped = max(0.5 * damped, MIN_DAMPING) if reverses else min(1.0, 2.0 * damped)
        before = now.step
        share = min(damped, MAX_ROTATION_STEP / max(_max_abs(now.step[::2]), MAX_ROTATION_STEP))
        equilibrium = now.after(share)
        if share == 1.0 and now.has_converged:
            return equilibrium if now.is_stable() else None
        poses = held.chain.poses_of(*equilibrium.positions)
    return None


def load_stiffness(
    chain: LoadedChain, poses: Sequence[Pose],
    of_links: Callable[[Sequence[Pose]], Vector],
    stencil: Sequence[tuple[float, float]] = STENCIL,
) -> Matrix:  # fmt: skip
    """Return minus the derivatives of the generalised forces of weights and links."""
    stiffness = np.zeros((2 * len(poses), 2 * len(poses)))
    for at, size in enumerate(chain.sizes):
        step = DIFFERENCE_STEP * size
        for steps, weight in stencil:
            before, after = (
                chain.generalized_loads(others, of_links(others))
                for others in (
                    chain.displaced(poses, at, by) for by in (-steps * step, steps * step)
                )
            )
            stiffness[:, at] += weight / step * (before - after)
    return stiffness


def base_stiffness(chain: LoadedChain, poses: Sequence[Pose], *, from_rest: bool = False) -> Matrix:
    """Return minus the derivatives of the generalised forces of bases, zero for rigid ones.

    With loads that grow `from_rest`, variables of a base's own follow them.
    """
    stiffness = np.zeros((2 * len(poses), 2 * len(poses)))
    for k, (standing, pose) in enumerate(zip(chain.bodies, poses, strict=True)):
        if not standing.corner:
            own = slice(2 * k, 2 * k + 2)
            jacobians = [
                base_derivatives(standing, pose, name, from_rest=from_rest)
                for name in DISPLACEMENTS
            ]
            stiffness[own, own] = np.array(jacobians).T
    return stiffness


def _link_breaks(chain: LoadedChain, before: ChainEquilibrium, after: ChainEquilibrium) -> bool:
    """Whether a link breaks between two equilibria."""
    pairs = zip(chain.ties, before.elongations.tolist(), after.elongations.tolist(), strict=True)
    return any(is_broken(tie, now) and not is_broken(tie, was) for tie, was, now in pairs)


def _max_abs(values: Vector) -> float:
    """Return the greatest absolute value."""
    return float(np.abs(values).max())


class _StiffDirection(NamedTuple):
    """A direction in which a link has stiffness, so that its force is an unknown."""

    link: int
    direction: Vector
    compliance: float
    misfit: float  # difference of its force from that of its law, as an elongation


class _Step:
    """One step of Newton's method from a guess, :eq:`eq-static-steps`."""

    def __init__(self, held: HeldBodies, poses: Sequence[Pose], guess: ChainEquilibrium) -> None:
        self.held, self.chain, self.poses, self.guess = held, held.chain, poses, guess
        self.coordinates = np.array([value for pose in poses for value in pose.state[:2]])
        self.sizes = held.chain.sizes
        self.links = held.chain.link_forces(poses, elongations=guess.elongations.tolist())
        self.link_forces = guess.link_forces.copy()
        self.stiff_directions = [
            stiff
            for i, link_force in enumerate(self.links)
            for stiff in self._stiff_directions_of(i, link_force)
        ]
        # derivatives of coordinates by the free ones, over the sizes of these
        self.constraint = held.chain.constraint_matrix(poses) * self.sizes
        self.free = self.constraint.any(axis=0)
        self.constraint = self.constraint[:, self.free]
        self.base_stiffness = base_stiffness(held.chain, poses, from_rest=True)
        self.matrix, misfits = self._equations()
        try:
            solution = np.linalg.solve(self.matrix, misfits)
        except np.linalg.LinAlgError:
            solution = np.full(len(misfits), math.nan)
        self.is_bounded = bool((np.abs(solution) < DIVERGED).all())
        if self.is_bounded:
            self.step = self.constraint @ solution[: self.free.sum()]
            forces = held.chain.weight * solution[self.free.sum() :]
            self._set_link_changes(forces[: len(self.stiff_directions)].tolist())
            couples = forces[len(self.stiff_directions) :]
            self.couple_change = self.sizes[1] / self.sizes[0] * couples

    def _set_link_changes(self, forces: Sequence[float]) -> None:
        """Set the changes of links in this step, and whether it is the last one."""
        allowed = TOLERANCE * (np.abs(self.coordinates) + self.sizes)
        # rotations are added up: none is more accurate than the rounding of the greatest one
        rounding_of_rotations = ROUNDING * _max_abs(self.coordinates[::2])
        allowed += rounding_of_rotations * self.sizes / np.repeat(self.sizes[::2], 2)
        self.has_converged = bool((np.abs(self.step) <= allowed).all())
        self.force_change = np.zeros_like(self.link_forces)
        self.elongation_change = [
            float(kinematics.direction @ kinematics.jacobian @ self.step)
            + kinematics.elongation
            - stretch
            for kinematics, stretch in zip(self.links, self.guess.elongations.tolist(), strict=True)
        ]
        for stiff, force in zip(self.stiff_directions, forces, strict=True):
            self.force_change[stiff.link] += force * stiff.direction
        for i, (link, kinematics) in enumerate(zip(self.chain.ties, self.links, strict=True)):
            rounding = FORCE_TOLERANCE_RATIO * TOLERANCE * self.chain.weight
            as_predicted = _max_abs(self.force_change[i]) <= rounding
            if not kinematics.coincide:
                self.elongation_change[i], as_predicted = self._elongation_change(
                    link, kinematics, i, rounding
                )
            self.has_converged = self.has_converged and as_predicted

    def _elongation_change(
        self, link: ChainLink, link_force: LinkForce, i: int, rounding: float
    ) -> tuple[float, bool]:
        """Return change of a link's elongation, and whether its force is then the predicted one.

        Where the link only begins to have stiffness the change is kept small.
        """
        share, more = 1.0, self.elongation_change[i]
        stretch = float(self.guess.elongations[i])

        def force_error(more: float) -> float:
            predicted = link_force.force + link_force.stiffness * more
            return self.chain.link_factor * abs(static_link_force(link, stretch + more) - predicted)

        rounding += TOLERANCE * self.chain.link_factor * link_force.stiffness * abs(stretch)
        as_predicted = force_error(more) <= rounding
        while link_force.stiffness <= 0.0 and share > MIN_SHARE:
            if force_error(share * more) <= MAX_FORCE_CHANGE * self.chain.weight:
                break
            share *= 0.5
        return share * more, as_predicted

    def after(self, share: float) -> ChainEquilibrium:
        """Return the next guess, after a share of the step."""
        new = self.coordinates + share * self.step
        normal_forces = np.array([pose.normal_force for pose in self.poses])
        normal_forces -= share * (self.base_stiffness @ self.step)[1::2]
        elongations = self.guess.elongations + share * np.array(self.elongation_change)
        link_forces = self.link_forces + share * self.force_change
        couples = self.guess.couples + share * self.couple_change
        return ChainEquilibrium(
            new[::2], new[1::2], normal_forces, elongations, link_forces, couples
        )

    def _stiff_directions_of(self, i: int, link_force: LinkForce) -> list[_StiffDirection]:
        """Return directions in which a link has stiffness; in others its law gives its force."""
        force = self.chain.link_factor * link_force.force
        stiffness = self.chain.link_factor * link_force.stiffness
        along, pull = link_force.direction, self.link_forces[i].copy()
        self.link_forces[i] = force * along
        if not link_force.coincide:
            misfit = link_force.elongation - float(self.guess.elongations[i])
            return [_StiffDirection(i, along, 1.0 / stiffness, misfit)] if stiffness > 0.0 else []
        if not along.any():  # points that coincide without force may part in any direction
            directions = np.eye(2) if stiffness > 0.0 else ()
            return [_StiffDirection(i, direction, 1.0 / stiffness, 0.0) for direction in directions]
        stiff = list[_StiffDirection]()
        if stiffness > 0.0:
            tension = float(pull @ along)
            self.link_forces[i] = tension * along
            stiff.append(_StiffDirection(i, along, 1.0 / stiffness, (force - tension) / stiffness))
        if force > 0.0:  # a taut link also has stiffness across
            across = np.array([-along[1], along[0]])
            beside, compliance = float(pull @ across), math.hypot(*link_force.displacement) / force
            self.link_forces[i] += beside * across
            stiff.append(_StiffDirection(i, across, compliance, -beside * compliance))
        return stiff

    def _loads(self, poses: Sequence[Pose]) -> Vector:
        """Return the generalised forces of links, of fixed sizes, as bodies move."""
        loads = np.zeros(2 * len(poses))
        points = self.chain.link_kinematics(poses)
        for pull, here, there in zip(self.link_forces, self.links, points, strict=True):
            force = pull
            if here.direction.any() and not here.coincide:
                force = (pull @ here.direction) * there.direction
            loads -= force @ there.jacobian
        return loads

    def _equations(self) -> tuple[Matrix, Vector]:
        """Return matrix and right-hand side of the equations, symmetrical and non-dimensional."""
        chain, weight, free, sizes = self.chain, self.chain.weight, self.free, self.sizes
        energy = weight * sizes[1]
        forces = chain.generalized_loads(self.poses, self._loads(self.poses))
        for k, (standing, pose) in enumerate(zip(chain.bodies, self.poses, strict=True)):
            if not standing.corner:
                forces[2 * k : 2 * k + 2] += pose.force.moment, pose.force.upward
        forces[::2] -= self.guess.couples @ self.held.rotation_weights
        inner = self.base_stiffness + load_stiffness(chain, self.poses, self._loads, SECANT)
        inner *= sizes * sizes[:, None] / energy
        jacobians = [
            weight / energy * stiff.direction @ self.links[stiff.link].jacobian
            for stiff in self.stiff_directions
        ]
        rotation_weights = np.zeros((len(self.held.rotation_weights), len(sizes)))
        rotation_weights[:, ::2] = self.held.rotation_weights / sizes[0]
        tight = np.array([*jacobians, *rotation_weights]).reshape(-1, len(sizes)) @ self.constraint
        soft = [-stiff.compliance * weight**2 / energy for stiff in self.stiff_directions]
        matrix = np.block(
            [
                [inner[np.ix_(free, free)], tight.T],
                [tight, np.diag([*soft, *np.zeros(len(rotation_weights))])],
            ]
        )
        off = self.held.rotations / sizes[0] - rotation_weights @ self.coordinates
        misfits = [-stiff.misfit * weight / energy for stiff in self.stiff_directions]
        return matrix, np.array([*(sizes * forces / energy)[free], *misfits, *off])

    def is_stable(self) -> bool:
        """Whether the equilibrium is stable: as many positive eigenvalues as free coordinates."""
        return bool((np.linalg.eigvalsh(self.matrix) > 0.0).sum() == self.free.sum())
