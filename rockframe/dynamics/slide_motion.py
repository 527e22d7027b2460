"""How a block slides, rocks and flies on rigid ground with friction, page "Sliding".

One set of equations, :eq:`eq-slide-planar`, of slip, rotation and rise: the mode says which of
them move, and whether friction holds or opposes the slip. All quantities per unit mass.
"""

import math
from typing import Final, NamedTuple

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics import events
from rockframe.dynamics.base import Guards
from rockframe.dynamics.protocol import (
    BODY_COLUMNS,
    CORNER_REACTIONS,
    MEMORY,
    Column,
    Energies,
    Ground,
    Numbers,
    OnRigidGround,
    Slope,
)
from rockframe.dynamics.trigonometry import sine_cosine

# which corners bear: both, one, or none; the number of a mode is three times this plus the slip
FULL: Final = 0
ON_RIGHT: Final = 1
ON_LEFT: Final = 2
FLIGHT_RIGHT: Final = 3  # coordinates are those of the right corner
FLIGHT_LEFT: Final = 4
BEARINGS: Final = 5
HELD: Final = 0
TO_RIGHT: Final = 1
TO_LEFT: Final = 2
SLIP_STATES: Final = 3
MODES: Final = BEARINGS * SLIP_STATES

# the state: rotation [rad], slip and rise of the bearing corner from its place at rest [m]; rates
ROTATION: Final = 0
SLIP: Final = 1
RISE: Final = 2
DOF: Final = 3  # coordinates, and the index of the first rate

# guards
LANDING: Final = 0  # while one corner bears, of the other one; in flight of the mode's own one
STOPPING: Final = 1  # end of the slip; in flight landing of the other corner
NORMAL_FORCE: Final = 2  # force on the corner that bears; on the whole base, tipping to the right
TIPPING_LEFT: Final = 3
SLIP_RIGHT: Final = 4
SLIP_LEFT: Final = 5
GUARDS: Final = 6

PEAK_LEFT: Final = len(MEMORY)
PEAK_RIGHT: Final = PEAK_LEFT + 1
SLIDE_MEMORY: Final = (*MEMORY, "peak_slip_left", "peak_slip_right")
"""The memory: that of every system, then the largest slips. A slip reverses at events only."""

ROUNDING: Final = 1e-12
"""Rounding noise of accelerations over gravity, and of heights over the block's size [1]."""

COLUMNS: Final = (*BODY_COLUMNS, *CORNER_REACTIONS, Column("slip"), Column("slip_velocity"))


class Contact(NamedTuple):
    """Accelerations of slip, rotation and rise, and force of the ground on the block."""

    slip: float
    rotation: float
    rise: float
    along: float
    normal: float


class Loads(NamedTuple):
    """Loads but the ground's reactions, with inertia forces of the ground's motion, over mass."""

    along: float  # load along the ground, as the reaction that balances it [m s^-2]
    weight: float  # load normal to the ground, downwards [m s^-2]
    moment: float  # moment about the centre of mass [m^2 s^-2]


class SlideNumbers(NamedTuple):
    """The numbers of a block on rigid ground with friction, per unit mass."""

    left: float  # from the foot of the centre of mass to the left corner
    right: float
    height: float  # of the centre of mass
    inertia: float  # about the centre of mass
    static: float  # coefficients of friction; infinite where the ground holds the block
    kinetic: float
    impulsive: float  # in impacts; infinite: no slip of the striking corner
    left_lever: float  # of the impulse on the left corner as it strikes, eq-slide-lever [1]
    right_lever: float
    gravity: float


class SlideMotion(OnRigidGround, SlideNumbers):
    """Motion, guards, energies and columns of a block. A mixin of systems."""

    __slots__ = ()

    @kernel
    def coordinates(self) -> int:
        """Return 3: rotation, slip, rise."""
        return DOF

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
        """Return the number of coordinates that move: the first of rotation, slip, rise."""
        bearing, slips = self.bearing_in(mode), 0 if mode % SLIP_STATES == HELD else 1
        if bearing >= FLIGHT_RIGHT:
            return DOF
        return 2 * slips if bearing == FULL else 1 + slips

    @inlined
    def contact_state_of(self, mode: int, k: int) -> int:
        """Return the contact state: which corner bears, both, or none."""
        bearing = self.bearing_in(mode)
        if bearing == FULL:
            return events.FULL
        if bearing >= FLIGHT_RIGHT:
            return events.FLIGHT
        return events.RIGHT if bearing == ON_RIGHT else events.LEFT

    @inlined
    def bearing_in(self, mode: int) -> int:
        """Return the bearing corners of a mode, whose number may include states of links."""
        return mode // SLIP_STATES % BEARINGS

    @inlined
    def with_contact(self, mode: int, contact: int) -> int:
        """Return the mode with another bearing and slip, in one number `contact`."""
        return mode - mode % MODES + contact

    @inlined
    def side(self, bearing: int) -> float:
        """Return 1 where coordinates are those of the right corner, -1 of the left one."""
        return -1.0 if bearing in (ON_LEFT, FLIGHT_LEFT) else 1.0

    @inlined
    def slip_sign(self, mode: int) -> float:
        """Return the sign of the slip, 0 where friction holds."""
        slip = mode % SLIP_STATES
        return 0.0 if slip == HELD else 1.0 if slip == TO_RIGHT else -1.0

    @inlined
    def distance(self, side: float) -> float:
        """Return the distance of a corner from the foot of the centre of mass [m]."""
        return self.right if side > 0.0 else self.left

    @inlined
    def centre_from_corner(self, side: float, rotation: float) -> tuple[float, float]:
        """Return the place of the centre of mass to the right of a corner, and above it [m]."""
        sine, cosine = sine_cosine(rotation)
        away = side * self.distance(side)
        return self.height * sine - away * cosine, self.height * cosine + away * sine

    @inlined
    def loads(self, mode: int, state: Vector, ground: Ground) -> Loads:
        """Return the loads on the block: weight and inertia forces of the ground's motion."""
        return Loads(ground.x, self.gravity + ground.y, 0.0)

    @inlined
    def contact(self, mode: int, state: Vector, loads: Loads) -> Contact:
        """Return the motion in a mode, :eq:`eq-slide-planar` under its constraints.

        For a corner that slips this is :eq:`eq-slide-rocking`.
        """
        bearing, sign = self.bearing_in(mode), self.slip_sign(mode)
        across, weight, moment = loads
        if bearing == FULL:
            along = across if sign == 0.0 else -sign * self.kinetic * weight
            return Contact(along - across, 0.0, 0.0, along, weight)
        arm_x, arm_y = self.centre_from_corner(self.side(bearing), state[ROTATION])
        square = state[DOF + ROTATION] * state[DOF + ROTATION]
        pressing = weight - arm_y * square
        if bearing >= FLIGHT_RIGHT:
            angular = moment / self.inertia
            slip = arm_x * square - across - arm_y * angular
            return Contact(slip, angular, arm_x * angular - pressing, 0.0, 0.0)
        if sign == 0.0:
            inertia = self.inertia + arm_x * arm_x + arm_y * arm_y
            angular = (weight * arm_x - across * arm_y + moment) / inertia
            along = across + arm_y * angular - arm_x * square
            return Contact(0.0, angular, 0.0, along, pressing - arm_x * angular)
        arm = arm_x + sign * self.kinetic * arm_y
        angular = (pressing * arm + moment) / (self.inertia + arm_x * arm)
        normal = pressing - arm_x * angular
        along = -sign * self.kinetic * normal
        slip = along - across - arm_y * angular + arm_x * square
        return Contact(slip, angular, 0.0, along, normal)

    @inlined
    def free_acceleration(self, bearing: int, state: Vector, loads: Loads) -> float:
        """Return the upward acceleration of a corner if the ground did not act on it."""
        flies = bearing + FLIGHT_RIGHT - ON_RIGHT
        return self.contact(SLIP_STATES * flies, state, loads).rise

    @inlined
    def centre_velocity(self, mode: int, state: Vector) -> tuple[float, float]:
        """Return the velocity of the centre of mass relative to the ground."""
        arm_x, arm_y = self.centre_from_corner(self.side(self.bearing_in(mode)), state[ROTATION])
        rate = state[DOF + ROTATION]
        return state[DOF + SLIP] + arm_y * rate, state[DOF + RISE] - arm_x * rate

    @inlined
    def accelerate(self, mode: int, state: Vector, ground: Ground) -> Numbers:
        """Return accelerations, the power that friction dissipates, and that of the ground."""
        if mode == HELD:
            return 0.0, 0.0, 0.0, 0.0, 0.0
        return self.accelerations(mode, state, ground, self.loads(mode, state, ground))

    @inlined
    def accelerations(
        self, mode: int, state: Vector, ground: Ground, loads: Loads
    ) -> tuple[float, float, float, float, float]:
        """Return the values of :meth:`accelerate` under given loads."""
        contact = self.contact(mode, state, loads)
        across, up = self.centre_velocity(mode, state)
        supplied = -ground.x * across - ground.y * up
        dissipated = -contact.along * state[DOF + SLIP]
        return contact.rotation, contact.slip, contact.rise, dissipated, supplied

    @inlined
    def powers(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> tuple[float, float]:
        """Return the two powers of :meth:`accelerate`; the compiler merges both evaluations."""
        rates = self.accelerate(mode, state, ground)
        return rates[DOF], rates[DOF + 1]

    @inlined
    def guards_in(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Return the guards of the block, :eq:`eq-slide-guards`."""
        loads = self.loads(mode, state, ground)
        scale, size = 1.0 / self.gravity, 1.0 / (self.left + self.right)
        bearing, sign, rate = self.bearing_in(mode), self.slip_sign(mode), state[DOF + ROTATION]
        side = self.side(bearing)
        landing = falling = stopping = slowing = pressing = left = to_right = to_left = 1.0
        if bearing >= FLIGHT_RIGHT:
            sine, cosine = sine_cosine(state[ROTATION])
            landing, falling = size * state[RISE], size * state[DOF + RISE]
            stopping, slowing = landing + side * sine, falling + side * cosine * rate
        else:
            if bearing != FULL:
                landing, falling = side * state[ROTATION], side * rate
            contact = self.contact(mode, state, loads)
            if sign != 0.0:
                speed = 1.0 / math.sqrt(self.gravity * self.height)
                # rounding must not stop a slip that starts
                slowing = speed * (sign * slope[SLIP] + ROUNDING * self.gravity)
                stopping = speed * sign * state[DOF + SLIP]
                pressing = scale * contact.normal
            elif self.static < math.inf:
                limit = self.static * contact.normal
                to_right, to_left = scale * (limit + contact.along), scale * (limit - contact.along)
            elif bearing != FULL:  # a corner that would fall back is held, in tension
                pressing = scale * max(
                    contact.normal, -self.free_acceleration(bearing, state, loads)
                )
            if bearing == FULL:
                tipping = contact.along - loads.moment / self.height
                pressing = scale * (self.right / self.height * contact.normal + tipping)
                left = scale * (self.left / self.height * contact.normal - tipping)
        values = landing, stopping, pressing, left, to_right, to_left
        return Guards(values, (falling, slowing, 0.0, 0.0, 0.0, 0.0))

    guards_of_block = guards_in

    @kernel
    def kinetic_energy(self, mode: int, state: Vector) -> float:
        """Return the kinetic energy relative to the ground."""
        across, up = self.centre_velocity(mode, state)
        rate = state[DOF + ROTATION]
        return 0.5 * (across * across + up * up + self.inertia * rate * rate)

    @kernel
    def centre_rise(self, mode: int, state: Vector) -> float:
        """Return the rise of the centre of mass, without cancellation [m]."""
        sine, _ = sine_cosine(state[ROTATION])
        half, _ = sine_cosine(0.5 * state[ROTATION])
        side = self.side(self.bearing_in(mode))
        return state[RISE] + side * self.distance(side) * sine - 2.0 * self.height * half * half

    @kernel
    def energies(self, mode: int, state: Vector) -> Energies:
        """Return kinetic and gravity energy of the block without links; nothing is elastic."""
        kinetic = self.kinetic_energy(mode, state)
        return Energies(kinetic, self.gravity * self.centre_rise(mode, state), 0.0, 0.0)

    energies_of_bodies = energies

    @kernel
    def observe(
        self, mode: int, state: Vector, slope: Slope, ground: Ground, memory: Vector
    ) -> Numbers:
        """Return the motion of the centre of mass, the reactions, and the slip."""
        loads = self.loads(mode, state, ground)
        bearing, rotation, rate = self.bearing_in(mode), state[ROTATION], state[DOF + ROTATION]
        side = self.side(bearing)
        arm_x, _ = self.centre_from_corner(side, rotation)
        across, up = self.centre_velocity(mode, state)
        horizontal, rise = self.centre_acceleration(mode, state, slope)
        shear, normal = horizontal + loads.along, rise + loads.weight
        left, right = (0.0, normal) if side > 0.0 else (normal, 0.0)
        if bearing == FULL:
            width = self.left + self.right
            tipping = self.height * shear - loads.moment
            left = (self.right * normal + tipping) / width
            right = (self.left * normal - tipping) / width
        place = state[SLIP] + (side * self.distance(side) + arm_x)
        lift = self.centre_rise(mode, state)
        body = rotation, rate, lift, up, place, shear, across, slope[ROTATION], horizontal, rise
        return body + (shear, normal, left, right, state[SLIP], state[DOF + SLIP])

    columns_of_block = observe

    @inlined
    def centre_acceleration(self, mode: int, state: Vector, slope: Slope) -> tuple[float, float]:
        """Return the acceleration of the centre of mass relative to the ground, from a slope."""
        arm_x, arm_y = self.centre_from_corner(self.side(self.bearing_in(mode)), state[ROTATION])
        square = state[DOF + ROTATION] * state[DOF + ROTATION]
        horizontal = slope[SLIP] + arm_y * slope[ROTATION] - arm_x * square
        return horizontal, slope[RISE] - arm_x * slope[ROTATION] - arm_y * square
