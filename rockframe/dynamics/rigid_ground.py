"""A block on rigid ground (Housner), section "Rigid ground" of the theory manual.

The ground gives no force by its compression: it constrains the block to rotate about one corner.
Equation of motion :eq:`eq-rigid-rocking`, impact :eq:`eq-rigid-impact`, energies
:eq:`eq-rigid-energy`. All quantities per unit mass.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from rockframe.case_arrays import atan2, hypot, sqrt, tan
from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.base import Guards
from rockframe.dynamics.body import REST_AMPLITUDE
from rockframe.dynamics.events import FULL, IMPACT, LEFT, REST, RIGHT, UPLIFT
from rockframe.dynamics.protocol import (
    BODY_COLUMNS,
    CORNER_REACTIONS,
    IMPACT_LOSS,
    LAST_EVENT,
    MEMORY,
    ContactModel,
    Energies,
    Ground,
    OnRigidGround,
    Slope,
    Start,
)
from rockframe.dynamics.trigonometry import sine_cosine

# modes; rocking on the right corner has alpha > 0
RESTING: Final = 0
ON_RIGHT: Final = 1
ON_LEFT: Final = 2
MODES: Final = 3

# guards
IMPACT_GUARD: Final = 0
UPLIFT_ON_RIGHT: Final = 1
UPLIFT_ON_LEFT: Final = 2
GUARDS: Final = 3

COLUMNS: Final = (*BODY_COLUMNS, *CORNER_REACTIONS)


# indices of columns that systems built on this one change
_COLUMN_NAMES: Final = [column.name for column in COLUMNS]
BASE_SHEAR: Final = _COLUMN_NAMES.index("base_shear")
HORIZONTAL_REACTION: Final = _COLUMN_NAMES.index("horizontal_reaction")
VERTICAL_REACTION: Final = _COLUMN_NAMES.index("vertical_reaction")
LEFT_REACTION: Final = _COLUMN_NAMES.index("left_reaction")
RIGHT_REACTION: Final = _COLUMN_NAMES.index("right_reaction")


class RockingCorner(NamedTuple):
    """A corner that a block rotates about, seen from its centre of mass."""

    angle: float  # theta, of the line to the corner with the vertical
    radius: float  # R0 [m]
    inertia: float  # I_O/m + R0^2 [m^2]
    tangent: float  # tan theta; theta for small rotation
    restitution: float  # eps, of the angular velocity in an impact on it


class RockingNumbers(NamedTuple):
    """The numbers of a block on rigid ground, per unit mass."""

    left: RockingCorner
    right: RockingCorner
    gravity: float  # g
    small: bool  # whether sines and cosines are expanded
    wall: float = 0.0  # side of a wall behind the block, -1 left, 1 right; 0 for none
    wall_restitution: float = 0.0  # ratio of the angular velocities at an impact on base and wall
    wall_share: float = 0.0  # h over the height at which the block at rest touches the wall


class BlockOnRigidGround(RockingNumbers, OnRigidGround):
    """A block on rigid ground, per unit mass: a system."""

    __slots__ = ()

    @kernel
    def coordinates(self) -> int:
        """Return 1, the rotation."""
        return 1

    @kernel
    def guards(self) -> int:
        """Return the number of guards."""
        return GUARDS

    @kernel
    def modes(self) -> int:
        """Return the number of modes."""
        return MODES

    @inlined
    def moving_in(self, mode: int) -> int:
        """Return 1 while the block rocks, 0 at rest."""
        return 0 if mode == RESTING else 1

    @inlined
    def contact_state_of(self, mode: int, k: int) -> int:
        """Return the contact state: which corner bears, or both."""
        if mode == RESTING:
            return FULL
        return RIGHT if mode == ON_RIGHT else LEFT

    @inlined
    def corner(self, mode: int) -> RockingCorner:
        """Return the corner that bears in a mode; the right one at rest."""
        return self.left if mode == ON_LEFT else self.right

    @inlined
    def side(self, mode: int) -> float:
        """Return s = sgn(alpha) of a rocking mode, 0 at rest."""
        if mode == RESTING:
            return 0.0
        return 1.0 if mode == ON_RIGHT else -1.0

    @inlined
    def lean_sine_cosine(self, mode: int, rotation: float) -> tuple[float, float]:
        """Return the sine and cosine of theta s - alpha, or their small-rotation forms."""
        angle = self.corner(mode).angle * self.side(mode) - rotation
        if self.small:
            return angle, 1.0
        return sine_cosine(angle)

    @inlined
    def angular_acceleration(self, mode: int, rotation: float, ground: Ground) -> float:
        """Return the angular acceleration of Housner's block, :eq:`eq-rigid-rocking`."""
        corner = self.corner(mode)
        sine, cosine = self.lean_sine_cosine(mode, rotation)
        moment = (self.gravity + ground.y) * sine + ground.x * cosine
        return -corner.radius * moment / corner.inertia

    @inlined
    def accelerate(self, mode: int, state: Vector, ground: Ground) -> tuple[float, ...]:
        """Return acceleration, dashpot power (none) and input power."""
        if mode == RESTING:
            return 0.0, 0.0, 0.0
        sine, cosine = self.lean_sine_cosine(mode, state[0])
        supplied = -self.corner(mode).radius * (ground.x * cosine + ground.y * sine) * state[1]
        return self.angular_acceleration(mode, state[0], ground), 0.0, supplied

    @inlined
    def powers(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> tuple[float, float]:
        """Return the two powers of :meth:`accelerate`."""
        rates = self.accelerate(mode, state, ground)
        return rates[1], rates[2]

    @inlined
    def guards_in(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Return the guards of impact while rocking, and of uplift while at rest."""
        if mode == RESTING:
            weight = self.gravity + ground.y
            right = (weight * self.right.tangent + ground.x) / self.gravity
            left = (weight * self.left.tangent - ground.x) / self.gravity
            right, left = right if self.wall <= 0.0 else 1.0, left if self.wall >= 0.0 else 1.0
            return Guards((1.0, right, left), (0.0, 0.0, 0.0))
        scale = self.side(mode) / self.corner(mode).angle
        return Guards((scale * state[0], 1.0, 1.0), (scale * state[1], 0.0, 0.0))

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Lift off from rest, or rock on the other corner after an impact, or come to rest."""
        return self.switch_with_restoring(mode, guard, state, ground, memory, 0.0)

    @kernel
    def switch_with_restoring(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector, extra: float
    ) -> int:
        """Carry out :meth:`switch`, with an `extra` angular acceleration towards rest."""
        if mode == RESTING:
            memory[LAST_EVENT] = UPLIFT
            if self.wall != 0.0:
                return ON_RIGHT if self.wall < 0.0 else ON_LEFT
            if (
                self.gravity + ground.y <= 0.0
            ):  # no weight left: the ground acceleration determines the side
                return ON_LEFT if ground.x > 0.0 else ON_RIGHT
            return ON_RIGHT if guard == UPLIFT_ON_RIGHT else ON_LEFT
        before = state[1]
        new = ON_LEFT if mode == ON_RIGHT else ON_RIGHT
        after = self.corner(new).restitution * before
        if self.wall != 0.0:  # it continues to rock about the same corner, away from the wall
            new, after = mode, self.wall_restitution * before
        state[0] = 0.0
        restoring = extra - self.side(new) * self.angular_acceleration(new, 0.0, ground)
        rebound = after * after / (2.0 * restoring) if restoring > 0.0 else math.inf
        # no rest where the ground acceleration tips the block back over the corner it has left
        may_rest = self.side(mode) * self.angular_acceleration(mode, 0.0, ground) <= extra
        memory[LAST_EVENT] = IMPACT
        if may_rest and rebound < REST_AMPLITUDE * self.corner(new).angle:
            memory[LAST_EVENT] = REST
            after, new = 0.0, RESTING
        old, new_inertia = self.corner(mode).inertia, self.corner(new).inertia
        memory[IMPACT_LOSS] += 0.5 * (old * before * before - new_inertia * after * after)
        state[1] = after
        return new

    @inlined
    def wall_reactions(self, tilt: float, weight: float, ground: Ground) -> tuple[float, float]:
        """Return the difference of the reactions of both corners, and the base shear, at a wall.

        A ground acceleration that would tip the block into the wall presses its top against it.
        """
        shear = ground.x
        if self.wall < 0.0 and tilt > weight:
            tilt = weight
            shear -= self.wall_share * (ground.x - weight * self.left.tangent)
        if self.wall > 0.0 and tilt < -weight:
            tilt = -weight
            shear -= self.wall_share * (ground.x + weight * self.right.tangent)
        return tilt, shear

    @kernel
    def centre_rise(self, mode: int, rotation: float) -> float:
        """Return the rise of the centre of mass, R0 [cos(theta - a) - cos theta] [m]."""
        corner, angle = self.corner(mode), abs(rotation)
        if self.small:
            return corner.radius * angle * (corner.angle - 0.5 * angle)
        sine, _ = sine_cosine(corner.angle - 0.5 * angle)
        half, _ = sine_cosine(0.5 * angle)
        return 2.0 * corner.radius * sine * half

    @kernel
    def energies(self, mode: int, state: Vector) -> Energies:
        """Return kinetic and gravity energy, :eq:`eq-rigid-energy`; nothing is elastic."""
        kinetic = 0.5 * self.corner(mode).inertia * state[1] * state[1]
        return Energies(kinetic, self.gravity * self.centre_rise(mode, state[0]), 0.0, 0.0)

    @kernel
    def observe(
        self, mode: int, state: Vector, slope: Slope, ground: Ground, memory: Vector
    ) -> tuple[float, ...]:
        """Return motion of the centre of mass, resultant reactions, and those of both corners."""
        rotation, rate = state[0], state[1]
        weight = self.gravity + ground.y
        height = self.centre_rise(mode, rotation)
        if mode == RESTING:
            # moments about the foot of the centre of mass: N_R s_R - N_L s_L = -m h x_g''
            tangents = self.left.tangent + self.right.tangent
            tilt = (2.0 * ground.x + weight * (self.right.tangent - self.left.tangent)) / tangents
            tilt, shear = self.wall_reactions(tilt, weight, ground)
            left, right = 0.5 * (weight + tilt), 0.5 * (weight - tilt)
            rest = (rotation, rate, height, 0.0, 0.0, shear)
            return rest + (0.0, 0.0, 0.0, 0.0, shear, weight, left, right)
        corner = self.corner(mode)
        sine, cosine = self.lean_sine_cosine(mode, rotation)
        initial_sine, _ = sine_cosine(corner.angle)
        x = corner.radius * (self.side(mode) * initial_sine - sine)
        horizontal = corner.radius * (cosine * slope[0] + sine * rate * rate)
        if self.small:
            x, horizontal = corner.radius * rotation, corner.radius * slope[0]
        rise = corner.radius * (sine * slope[0] - cosine * rate * rate)
        normal, shear = weight + rise, horizontal + ground.x
        left, right = (normal, 0.0) if mode == ON_LEFT else (0.0, normal)
        across, up = corner.radius * cosine * rate, corner.radius * sine * rate
        motion = (rotation, rate, height, up, x, shear)
        return motion + (across, slope[0], horizontal, rise, shear, normal, left, right)


def rocking_corner(
    *,
    distance: float,  # horizontal, of the centre of mass from the corner [m]
    height: float,  # of the centre of mass [m]
    inertia: float,  # of the block about the corner, over its mass [m^2]
    restitution: float,  # as of `RockingCorner`
    small_rotation: bool,
) -> RockingCorner:
    """Return a corner about which a block rotates."""
    angle = atan2(distance, height)
    tangent = angle if small_rotation else tan(angle)
    return RockingCorner(angle, hypot(distance, height), inertia, tangent, restitution)


def rigid_ground(
    left: RockingCorner, right: RockingCorner, *, mass: float, small_rotation: bool, gravity: float
) -> ContactModel:
    """Assemble the model of a block on rigid ground, of a mass [kg], under gravity [m s^-2]."""
    frequency = max(sqrt(gravity * corner.radius / corner.inertia) for corner in (left, right))
    least = left if left.angle < right.angle else right

    def initial(start: Start) -> tuple[int, Vector, Vector]:
        rotation, rate = start.rotation or 0.0, start.angular_velocity
        direction = rotation or rate
        mode = RESTING if direction == 0.0 else (ON_RIGHT if direction > 0.0 else ON_LEFT)
        return mode, np.array([rotation, rate]), np.zeros(len(MEMORY))

    return ContactModel(
        name="rigid ground",
        system=BlockOnRigidGround(left, right, gravity, small_rotation),
        rotation_limits=(left.angle, right.angle),
        rotation_weights=np.ones(1),
        scales=least.angle * np.array([1.0, frequency]),
        guard_tolerance=np.array([1e-15, 1e-14, 1e-14]),
        columns=COLUMNS,
        mass=mass,
        fastest_frequency=frequency,
        damping_rate=0.0,
        energy_scale=gravity * least.radius * least.angle,
        initial=initial,
    )
