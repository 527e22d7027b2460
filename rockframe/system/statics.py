"""Statics of bodies: at rest, held at rotations, the work to reach these; vibration modes."""

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from rockframe.dynamics.base_numbers import BaseNumbers
from rockframe.dynamics.body_statics import Pose
from rockframe.dynamics.statics import StandingChain
from rockframe.errors import SolverError
from rockframe.signals.arrays import Array


@dataclass(frozen=True)
class Statics:
    """A body held at a rotation, in SI units.

    Parameters
    ----------
    vertical_displacement : float
        Displacement of the centre of mass from rest.
    base_moment : float
        Moment of the lowest base's vertical reactions about the middle of the base, against
        the rotation.
    restoring_moment : float
        Couple that holds the body at the rotation: the base moment less the weight's
        moment about the middle of the base.
    contact_state : str
        Name of the contact state.
    reactions : dict of str to float
        Forces and lengths of the bases by their names in the results' schema.
    """

    vertical_displacement: float
    base_moment: float
    restoring_moment: float
    contact_state: str
    reactions: dict[str, float] = field(default_factory=dict[str, float])


def static_values(values: Mapping[str, float]) -> dict[str, float]:
    """Return values of bases at rest by their names in the schema, which begin with `static_`."""
    return {f"static_{name}": value for name, value in values.items()}


def required_states(rotations: Sequence[float], states: Sequence[Statics | None]) -> list[Statics]:
    """Return the states at rotations; SolverError if there is none at one of them."""
    existing = list[Statics]()
    for rotation, state in zip(rotations, states, strict=True):
        if state is None:
            msg = (
                "no equilibrium was found with the highest body held at "
                f"{rotation:.6g} rad: what it stands on cannot carry the moment"
            )
            raise SolverError(msg)
        existing.append(state)
    return existing


@dataclass(frozen=True)
class SmallMotion:
    """Linear equations of small motion M q'' + C q' + K q = 0."""

    coordinates: tuple[str, ...]  # names of the coordinates
    mass: Array  # M, C and K in SI units
    damping: Array
    stiffness: Array
    # for a stack, the bodies whose coordinates follow one another, counted from 1 at the top
    bodies: tuple[int, ...] = field(default=(), kw_only=True)


LINEAR_ROTATION: Final = 2.0**-20
"""Rotation, over the one that the settlement allows, below which moments are taken as linear in it:
the difference of the forces at both ends loses too many digits there."""
SLOPE_ROTATION: Final = 2.0**-6
"""Rotation, over the same, at which the slope of the moments is found."""


@dataclass(frozen=True)
class StandingBodies:
    """Statics of stacked bodies, in SI units."""

    chain: StandingChain  # the bodies on their bases, per unit of the reference mass
    mass: float  # reference mass, that of the highest body [kg]
    bases: tuple[BaseNumbers, ...]  # bases of the bodies, from the top down

    @cached_property
    def rest(self) -> list[Pose] | None:
        """Equilibrium of the bodies under their weight; None if there is none."""
        return self.chain.rest()

    def held(self, rotations: Sequence[float]) -> list[Statics | None]:
        """Return states with the highest body held at rotations [rad]; None where none exists."""
        curve = self.chain.curve(rotations)
        states = [None if poses is None else self.statics_of(poses) for poses in curve]
        least = (
            LINEAR_ROTATION * self.chain.bodies[0].allowed_rotation
            if self.chain.rests_upright
            else 0.0
        )
        for i, (rotation, state) in enumerate(zip(rotations, states, strict=True)):
            if state is not None and abs(rotation) < least:
                states[i] = self._near_upright(rotation, state)
        return states

    def _near_upright(self, rotation: float, state: Statics) -> Statics:
        """Return a state with moments free of cancellation, by their slope, to fourth order."""
        step = SLOPE_ROTATION * self.chain.bodies[0].allowed_rotation
        near, far = required_states((step, 2.0 * step), self.held((step, 2.0 * step)))
        share = rotation / (6.0 * step)
        return replace(
            state,
            base_moment=share * (8.0 * near.base_moment - far.base_moment),
            restoring_moment=share * (8.0 * near.restoring_moment - far.restoring_moment),
        )

    def statics_of(self, poses: list[Pose]) -> Statics:
        """Return the quasi-static state of bodies from their equilibrium."""
        (part, *_), lowest = self.chain.bodies[0], poses[-1]
        body = self.chain.bodies[-1].part.body
        attitude = body.attitude(lowest.state.rotation)
        arm = body.height * attitude.sine + 0.5 * (body.left - body.right) * attitude.cosine
        held = [part.base.is_held(poses[0].mode.contact, left) for left in (True, False)]
        bears = "full" if all(held) else "left" if held[0] else "right"
        return Statics(
            vertical_displacement=self.chain.rise(poses),
            base_moment=self.mass * (lowest.normal_force * arm - lowest.force.moment),
            restoring_moment=-self.mass * self.chain.moments(poses)[0],
            contact_state=bears if poses[0].normal_force > 0.0 else "flight",
            reactions=self.reactions(poses),
        )

    def reactions(self, poses: list[Pose]) -> dict[str, float]:
        """Return the columns of the bases in an equilibrium, by the names of the schema."""
        values = dict[str, float]()
        for standing, pose, numbers in zip(self.chain.bodies, poses, self.bases, strict=True):
            if standing.corner:
                continue
            base = standing.part.base
            observed = base.observed(pose.mode.contact, pose.line, pose.own)
            for column, value in zip(numbers.columns, observed, strict=True):
                values[column.name] = (self.mass if column.per_mass else 1.0) * value
        if len(poses) > 1:
            values["cap_rotation"] = poses[-1].state.rotation
        return values

    def small_motion(self, poses: list[Pose]) -> tuple[Array, Array, Array]:
        """Return mass, damping and stiffness matrix about rest, for rotation and height of each."""
        from rockframe.dynamics.linearization import linearized_chain

        mass, damping, stiffness = linearized_chain(self.chain, poses)
        return self.mass * mass, self.mass * damping, self.mass * stiffness

    def motion_of_single_body(self, poses: list[Pose]) -> SmallMotion:
        """Return the equations of small motion about rest of a body alone on its base."""
        # height before rotation
        matrices = (matrix[::-1, ::-1] for matrix in self.small_motion(poses))
        return SmallMotion(("vertical_displacement", "rotation"), *matrices)


_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_GAUSS_RULE: Final[list[tuple[float, float]]] = [
    (0.5 + 0.5 * float(point), 0.5 * float(weight))
    for point, weight in zip(_POINTS, _WEIGHTS, strict=True)
]
"""Points and weights of the Gauss-Legendre rule on (0, 1)."""


RestoringMoments: TypeAlias = Callable[[list[float]], list[float]]
"""A function that gives restoring moments [N m] at rotations [rad]."""


def work_to(moments: RestoringMoments, end: float) -> float:
    """Return the work that slowly brings a body from upright to a rotation [rad] [J]."""
    values = moments([point * end for point, _ in _GAUSS_RULE])
    terms = (weight * moment for (_, weight), moment in zip(_GAUSS_RULE, values, strict=True))
    return end * sum(terms)


def work_against(moments: RestoringMoments, end: float) -> float:
    """Return the work up to a rotation against those moments that restore [J]."""
    values = moments([point * end for point, _ in _GAUSS_RULE])
    return sum(
        weight * max(end * moment, 0.0)
        for (_, weight), moment in zip(_GAUSS_RULE, values, strict=True)
    )


@dataclass(frozen=True)
class VibrationMode:
    """A mode: undamped frequency [rad s^-1] and damping ratio, NaN if it is unstable; shape."""

    angular_frequency: float
    damping_ratio: float
    shape: Array


def vibration_modes(motion: SmallMotion) -> list[VibrationMode]:
    """Return the modes of linear equations, from slow to fast; unstable ones first."""
    size = len(motion.coordinates)
    transition = np.block(
        [
            [np.zeros((size, size)), np.eye(size)],
            [
                -np.linalg.solve(motion.mass, motion.stiffness),
                -np.linalg.solve(motion.mass, motion.damping),
            ],
        ]
    )
    rates, vectors = np.linalg.eig(transition)
    modes: list[VibrationMode] = []
    real: list[int] = []
    for i, rate in enumerate(rates):
        if rate.imag > 0.0:
            frequency = abs(rate)
            modes.append(
                VibrationMode(frequency, -rate.real / frequency, _shape(vectors[:size, i]))
            )
        elif rate.imag == 0.0:
            real.append(i)
    real.sort(key=lambda i: float(rates[i].real), reverse=True)
    for first, second in _pair_real_eigenvalues(real, np.real(vectors[:size]), motion.mass):
        shape = _shape(vectors[:size, first])
        slow, fast = float(rates[first].real), float(rates[second].real)
        if slow * fast <= 0.0:
            modes.append(VibrationMode(math.nan, math.nan, shape))
            continue
        frequency = math.sqrt(slow * fast)
        modes.append(VibrationMode(frequency, -0.5 * (slow + fast) / frequency, shape))
    return sorted(modes, key=lambda mode: (not math.isnan(mode.angular_frequency),
                                           mode.angular_frequency))  # fmt: skip


def _pair_real_eigenvalues(real: list[int], shapes: Array, mass: Array) -> list[tuple[int, int]]:
    """Pair real eigenvalues whose shapes are most alike, in the inner product of the mass."""
    scaled = {i: shapes[:, i] / math.sqrt(shapes[:, i] @ mass @ shapes[:, i]) for i in real}
    alike = sorted(
        itertools.combinations(real, 2),
        key=lambda pair: -abs(float(scaled[pair[0]] @ mass @ scaled[pair[1]])),
    )
    free = set(real)
    pairs: list[tuple[int, int]] = []
    for pair in alike:
        if free.issuperset(pair):
            free.difference_update(pair)
            pairs.append(pair)
    return pairs


def _shape(vector: NDArray[np.complex128]) -> Array:
    """Return the real part of a complex shape, scaled so that its largest entry is 1."""
    return np.real(vector / vector[np.argmax(np.abs(vector))])
