"""A block that slides, rocks and flies on rigid ground with friction, page "Sliding".

One set of equations, :eq:`eq-slide-planar`, of slip, rotation and rise: the mode says which of
them move, and whether friction holds or opposes the slip. All quantities per unit mass.
"""

import math
from typing import Final, NamedTuple

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics import events
from rockframe.dynamics.base import Guards
from rockframe.dynamics.coulomb import ImpulseResponse, coulomb_impulse
from rockframe.dynamics.events import IMPACT, REST, SEPARATION, SILENT, UPLIFT
from rockframe.dynamics.protocol import (
    BODY_COLUMNS,
    IMPACT_LOSS,
    LAST_EVENT,
    MEMORY,
    Column,
    Energies,
    Ground,
    Slope,
)
from rockframe.dynamics.rigid_ground import REST_AMPLITUDE
from rockframe.dynamics.trigonometry import sine_cosine

# what bears: both corners, one, or none; a mode is three times this, and the slip
FULL: Final = 0
ON_RIGHT: Final = 1
ON_LEFT: Final = 2
FLIES_RIGHT: Final = 3  # coordinates are those of the right corner
FLIES_LEFT: Final = 4
BEARINGS: Final = 5
HELD: Final = 0
TO_RIGHT: Final = 1
TO_LEFT: Final = 2
SLIPS: Final = 3

# the state: slip and rise of the corner that bears, from its place at rest, and the rotation
SLIP: Final = 0
ROTATION: Final = 1
RISE: Final = 2
SIZE: Final = 3

# guards
LANDING: Final = 0  # of the other corner while one bears, of the own one in flight
STOPPING: Final = 1  # of the slip; in flight landing of the other corner
PRESSING: Final = 2  # on the right corner: at rest, it tips over it; of the corner that slips
TIPS_LEFT: Final = 3
SLIPS_RIGHT: Final = 4
SLIPS_LEFT: Final = 5
GUARDS: Final = 6

PEAK_LEFT: Final = len(MEMORY)
PEAK_RIGHT: Final = PEAK_LEFT + 1
REMEMBERED: Final = (*MEMORY, "peak_slip_left", "peak_slip_right")
"""Behind what every system keeps: the largest slips. A slip turns round at events alone."""

ROUNDING: Final = 1e-12
"""Accelerations over gravity, and heights over the block's size, that are rounding."""

COLUMNS: Final = (
    *BODY_COLUMNS,
    Column("left_reaction", per_mass=True),
    Column("right_reaction", per_mass=True),
    Column("slip"),
    Column("slip_velocity"),
)


class Contact(NamedTuple):
    """Accelerations of slip, rotation and rise, and force of the ground on the block."""

    slip: float
    rotation: float
    rise: float
    along: float
    normal: float


class SlideRock(NamedTuple):
    """A block on rigid ground with friction, per unit mass: a system."""

    left: float  # from the foot of the centre of mass to both corners
    right: float
    height: float  # of the centre of mass
    inertia: float  # about the centre of mass
    static: float  # coefficients of friction
    kinetic: float
    impulsive: float  # that of impacts; infinite where they hold the corner that strikes
    left_lever: float  # of the impulse of a block that rolls over, eq-slide-lever, by its corner
    right_lever: float
    gravity: float

    @inlined
    def bodies(self) -> int:
        """Give 1, the number of bodies."""
        return 1

    @kernel
    def coordinates(self) -> int:
        """Give 3: slip, rotation, rise."""
        return SIZE

    @kernel
    def variables(self) -> int:
        """Give 0."""
        return 0

    @kernel
    def guards(self) -> int:
        """Give the number of guards."""
        return GUARDS

    @kernel
    def modes(self) -> int:
        """Give the number of modes."""
        return BEARINGS * SLIPS

    @inlined
    def moving_in(self, mode: int) -> int:
        """Give how many of slip, rotation and rise change, in this order."""
        bears = mode // SLIPS
        if bears == FULL:
            return 0 if mode == HELD else 1
        return SIZE if bears >= FLIES_RIGHT else 2

    @inlined
    def contact_state_of(self, mode: int, k: int) -> int:
        """Give which corner bears."""
        bears = mode // SLIPS
        if bears == FULL:
            return events.FULL
        if bears >= FLIES_RIGHT:
            return events.FLIGHT
        return events.RIGHT if bears == ON_RIGHT else events.LEFT

    @inlined
    def relaxation_in(self, mode: int) -> float:
        """Give 0: no constraint decays."""
        return 0.0

    @kernel
    def some_end_slides(self, mode: int) -> bool:
        """Give False: of ends on springs, of which there are none."""
        return False

    @inlined
    def without_sliding(self, mode: int) -> int:
        """Give the mode itself."""
        return mode

    @inlined
    def side(self, bears: int) -> float:
        """Give 1 where coordinates are those of the right corner, -1 of the left one."""
        return -1.0 if bears in (ON_LEFT, FLIES_LEFT) else 1.0

    @inlined
    def sense(self, mode: int) -> float:
        """Give the sign of the slip, 0 where friction holds."""
        slip = mode % SLIPS
        return 0.0 if slip == HELD else 1.0 if slip == TO_RIGHT else -1.0

    @inlined
    def distance(self, side: float) -> float:
        """Give how far a corner is from the foot of the centre of mass."""
        return self.right if side > 0.0 else self.left

    @inlined
    def reach(self, side: float, rotation: float) -> tuple[float, float]:
        """Give the place of the centre of mass to the right of a corner, and above it."""
        sine, cosine = sine_cosine(rotation)
        away = side * self.distance(side)
        return self.height * sine - away * cosine, self.height * cosine + away * sine

    @inlined
    def contact(self, mode: int, state: Vector, ground: Ground) -> Contact:
        """Give the motion in a mode, :eq:`eq-slide-planar` under its constraints.

        Of a corner that slips it is :eq:`eq-slide-rocking`.
        """
        bears, sense = mode // SLIPS, self.sense(mode)
        weight = self.gravity + ground.y
        if bears == FULL:
            along = ground.x if sense == 0.0 else -sense * self.kinetic * weight
            return Contact(along - ground.x, 0.0, 0.0, along, weight)
        beside, above = self.reach(self.side(bears), state[ROTATION])
        square = state[SIZE + ROTATION] * state[SIZE + ROTATION]
        pressing = weight - above * square
        if bears >= FLIES_RIGHT:
            return Contact(beside * square - ground.x, 0.0, -pressing, 0.0, 0.0)
        if sense == 0.0:
            inertia = self.inertia + beside * beside + above * above
            turning = (weight * beside - ground.x * above) / inertia
            along = ground.x + above * turning - beside * square
            return Contact(0.0, turning, 0.0, along, pressing - beside * turning)
        arm = beside + sense * self.kinetic * above
        turning = pressing * arm / (self.inertia + beside * arm)
        normal = pressing - beside * turning
        along = -sense * self.kinetic * normal
        slip = along - ground.x - above * turning + beside * square
        return Contact(slip, turning, 0.0, along, normal)

    @inlined
    def speeds(self, mode: int, state: Vector) -> tuple[float, float]:
        """Give the velocity of the centre of mass relative to the ground."""
        beside, above = self.reach(self.side(mode // SLIPS), state[ROTATION])
        rate = state[SIZE + ROTATION]
        return state[SIZE + SLIP] + above * rate, state[SIZE + RISE] - beside * rate

    @inlined
    def accelerate(self, mode: int, state: Vector, ground: Ground) -> tuple[float, ...]:
        """Give accelerations, what friction dissipates, and what the ground puts in."""
        if mode == HELD:
            return 0.0, 0.0, 0.0, 0.0, 0.0
        found = self.contact(mode, state, ground)
        across, up = self.speeds(mode, state)
        supplied = -ground.x * across - ground.y * up
        lost = -found.along * state[SIZE + SLIP]
        return found.slip, found.rotation, found.rise, lost, supplied

    @inlined
    def powers(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> tuple[float, float]:
        """Give the powers of :meth:`accelerate` alone, which the compiler merges with it."""
        found = self.accelerate(mode, state, ground)
        return found[SIZE], found[SIZE + 1]

    @inlined
    def guards_in(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Give the guards, :eq:`eq-slide-guards`."""
        scale, size = 1.0 / self.gravity, 1.0 / (self.left + self.right)
        bears, sense, rate = mode // SLIPS, self.sense(mode), state[SIZE + ROTATION]
        side = self.side(bears)
        landing = falling = stopping = slowing = pressing = left = to_right = to_left = 1.0
        if bears >= FLIES_RIGHT:
            sine, cosine = sine_cosine(state[ROTATION])
            landing, falling = size * state[RISE], size * state[SIZE + RISE]
            stopping, slowing = landing + side * sine, falling + side * cosine * rate
        else:
            if bears != FULL:
                landing, falling = side * state[ROTATION], side * rate
            found = self.contact(mode, state, ground)
            if sense != 0.0:
                speed = 1.0 / math.sqrt(self.gravity * self.height)
                # a slip that starts is not stopped by rounding
                slowing = speed * (sense * slope[SLIP] + ROUNDING * self.gravity)
                stopping = speed * sense * state[SIZE + SLIP]
                pressing = scale * found.normal
            else:
                most = self.static * found.normal
                to_right, to_left = scale * (most + found.along), scale * (most - found.along)
            if bears == FULL:
                pressing = scale * (self.right / self.height * found.normal + found.along)
                left = scale * (self.left / self.height * found.normal - found.along)
        values = landing, stopping, pressing, left, to_right, to_left
        return Guards(values, (falling, slowing, 0.0, 0.0, 0.0, 0.0))

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Give the mode after a guard has fallen; after an impact also the rates."""
        bears = mode // SLIPS
        if bears < FLIES_RIGHT:
            memory[PEAK_LEFT] = max(memory[PEAK_LEFT], -state[SLIP])
            memory[PEAK_RIGHT] = max(memory[PEAK_RIGHT], state[SLIP])
        if bears >= FLIES_RIGHT:
            return self.come_down(mode, guard, state, ground, memory)
        if guard == LANDING:
            return self.roll_over(mode, state, ground, memory)
        if guard == STOPPING:
            state[SIZE + SLIP] = 0.0
        lets_go = guard in (SLIPS_RIGHT, SLIPS_LEFT)
        if bears == FULL:
            tips = ON_RIGHT if guard == PRESSING else ON_LEFT if guard == TIPS_LEFT else FULL
            new = self.standing(state, ground, lets_go, tips)
        else:
            new = self.leaning(bears, state, ground, lets_go)
        memory[LAST_EVENT] = self.kind_of(mode, new)
        return new

    @inlined
    def kind_of(self, old: int, new: int) -> int:
        """Give the kind of event by which one mode follows another without an impact."""
        bore, bears = old // SLIPS, new // SLIPS
        if bears >= FLIES_RIGHT:
            return SEPARATION
        if bore == FULL and bears != FULL:
            return UPLIFT
        if old == new:
            return SILENT
        if new % SLIPS == HELD:
            return events.STICK
        return events.SLIP if old % SLIPS == HELD else events.REVERSAL

    @kernel
    def standing(self, state: Vector, ground: Ground, lets_go: bool, tips: int) -> int:
        """Give how a block upright on its base goes on, :eq:`eq-slide-start`.

        Friction that `lets_go` does not hold the base; `tips` is the corner over which it tips.
        """
        weight, slip = self.gravity + ground.y, state[SIZE + SLIP]
        if weight <= ROUNDING * self.gravity:
            return SLIPS * (FLIES_LEFT if ground.x > 0.0 else FLIES_RIGHT)
        if slip == 0.0:
            over = tips if tips != FULL else self.tips_over(ground.x, weight)
            if over == FULL and not lets_go and abs(ground.x) <= self.static * weight:
                return SLIPS * FULL + HELD
            if over != FULL:
                held = self.contact(SLIPS * over, state, ground)
                if abs(held.along) <= self.static * held.normal:
                    return SLIPS * over + HELD
        sense = math.copysign(1.0, slip if slip != 0.0 else -ground.x)
        over = self.tips_over(-sense * self.kinetic * weight, weight)
        return SLIPS * over + (TO_RIGHT if sense > 0.0 else TO_LEFT)

    @inlined
    def tips_over(self, along: float, weight: float) -> int:
        """Give the corner over which a force of the ground on the whole base tips the block."""
        if self.right * weight + self.height * along < 0.0:
            return ON_RIGHT
        return ON_LEFT if self.left * weight - self.height * along < 0.0 else FULL

    @kernel
    def leaning(self, bears: int, state: Vector, ground: Ground, lets_go: bool) -> int:
        """Give how a block on one corner goes on: held, slipping, or in flight."""
        slip, corner = state[SIZE + SLIP], SLIPS * bears
        flies = corner + SLIPS * (FLIES_RIGHT - ON_RIGHT)
        if self.contact(flies, state, ground).rise >= -ROUNDING * self.gravity:
            return flies
        if slip != 0.0:
            return corner + (TO_RIGHT if slip > 0.0 else TO_LEFT)
        held = self.contact(corner + HELD, state, ground)
        if not lets_go and abs(held.along) <= self.static * held.normal:
            return corner + HELD
        first, second = (TO_LEFT, TO_RIGHT) if held.along > 0.0 else (TO_RIGHT, TO_LEFT)
        if self.starts(corner + first, state, ground):
            return corner + first
        # found too early, it would stick again
        return corner + (second if self.starts(corner + second, state, ground) else HELD)

    @inlined
    def starts(self, mode: int, state: Vector, ground: Ground) -> bool:
        """Whether a slip in the sense of a mode would grow."""
        return self.sense(mode) * self.contact(mode, state, ground).slip > -ROUNDING * self.gravity

    @kernel
    def strike(
        self, beside: float, above: float, lever: float, slip: float, sinking: float
    ) -> tuple[float, float]:
        """Give the impulses along and normal to the ground that stop a corner.

        The normal one acts at `lever` times `beside` from the centre of mass.
        """
        inertia, friction = self.inertia, self.impulsive
        mixed, along = -beside * above / inertia, 1.0 + above * above / inertia
        answers = ImpulseResponse(
            1.0 + lever * beside * beside / inertia, mixed, lever * mixed, along
        )
        if friction == math.inf and slip * mixed < sinking * along:
            friction = self.kinetic  # to hold the corner the ground would have to pull
        return coulomb_impulse(answers, slip, sinking, friction)

    @kernel
    def struck(self, bears: int, state: Vector, speeds: tuple[float, float], lever: float) -> None:
        """Give the state the rates after an impact on a corner, and its slip the place of that."""
        side, rate = self.side(bears), state[SIZE + ROTATION]
        beside, above = self.reach(side, state[ROTATION])
        across, up = speeds
        along, normal = self.strike(beside, above, lever, across - above * rate, up + beside * rate)
        rate += (lever * beside * normal - above * along) / self.inertia
        slip = across + along - above * rate
        # what rounding leaves of a slip that has ended
        noise = ROUNDING * (abs(across) + abs(along) + abs(above * rate))
        state[SIZE + SLIP] = slip if abs(slip) > noise else 0.0
        state[SIZE + ROTATION], state[SIZE + RISE] = rate, 0.0

    @kernel
    def kinetic_energy(self, mode: int, state: Vector) -> float:
        """Give the kinetic energy relative to the ground."""
        across, up = self.speeds(mode, state)
        rate = state[SIZE + ROTATION]
        return 0.5 * (across * across + up * up + self.inertia * rate * rate)

    @kernel
    def lie_flat(self, state: Vector, across: float, up: float) -> None:
        """Stop a block that lands on its whole base, which slips as far as friction lets it."""
        left = abs(across) - self.impulsive * -up if self.impulsive < math.inf else 0.0
        lasts = left > 0.0 and not self.creeps(left)
        state[SIZE + SLIP] = math.copysign(left, across) if lasts else 0.0
        state[SIZE + ROTATION] = state[SIZE + RISE] = state[ROTATION] = state[RISE] = 0.0

    @kernel
    def roll_over(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Strike the ground with the other corner, and go on about it or on the whole base.

        From rocking about a held corner the corner that strikes slips as in :eq:`eq-slide-through`.
        """
        bore = mode // SLIPS
        new = ON_LEFT if bore == ON_RIGHT else ON_RIGHT
        before = self.kinetic_energy(mode, state)
        state[ROTATION] = 0.0
        across, up = self.speeds(mode, state)
        lever = self.right_lever if new == ON_RIGHT else self.left_lever
        self.struck(new, state, (across, up), lever)
        memory[LAST_EVENT] = IMPACT
        if self.side(bore) * state[SIZE + ROTATION] >= 0.0:  # so wide that it lands flat
            self.lie_flat(state, across, up)
            after = self.standing(state, ground, False, FULL)
        else:
            after = self.leaning(new, state, ground, False)
            slip, rate = state[SIZE + SLIP], state[SIZE + ROTATION]
            leans = after
            if self.creeps(slip):
                state[SIZE + SLIP], leans = 0.0, SLIPS * new + HELD
            if self.rebounds_little(leans, state, ground):
                state[SIZE + ROTATION] = 0.0
                base = self.standing(state, ground, False, FULL)
                # a ground that tips the block over either corner allows no rest
                if base // SLIPS == FULL:
                    after = base
                    memory[LAST_EVENT] = REST
            if memory[LAST_EVENT] != REST:
                state[SIZE + SLIP], state[SIZE + ROTATION] = slip, rate
        memory[IMPACT_LOSS] += before - self.kinetic_energy(after, state)
        return after

    @inlined
    def creeps(self, slip: float) -> bool:
        """Whether the rate of a slip after an impact is too low to be told."""
        return slip * slip < REST_AMPLITUDE * self.gravity * self.height

    @inlined
    def rebounds_little(self, mode: int, state: Vector, ground: Ground) -> bool:
        """Whether a rebound is too low to be told."""
        bears, rate = mode // SLIPS, state[SIZE + ROTATION]
        if bears not in (ON_RIGHT, ON_LEFT):
            return False
        side = self.side(bears)
        restoring = -side * self.contact(mode, state, ground).rotation
        most = REST_AMPLITUDE * math.atan2(self.distance(side), self.height)
        return restoring > 0.0 and rate * rate < 2.0 * restoring * most

    @kernel
    def come_down(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Strike the ground with a corner after a flight, or with the whole base."""
        flew = mode // SLIPS
        own = ON_RIGHT if flew == FLIES_RIGHT else ON_LEFT
        other = ON_LEFT if own == ON_RIGHT else ON_RIGHT
        side, width = self.side(flew), self.left + self.right
        before = self.kinetic_energy(mode, state)
        across, up = self.speeds(mode, state)
        sine, cosine = sine_cosine(state[ROTATION])
        rate = state[SIZE + ROTATION]
        memory[LAST_EVENT] = IMPACT
        apart, parting = state[RISE] + side * width * sine, state[SIZE + RISE]
        parting += side * width * cosine * rate
        lowest = max(abs(state[RISE]), abs(apart))
        if lowest < ROUNDING * width and state[SIZE + RISE] <= 0.0 and parting <= 0.0:
            self.lie_flat(state, across, up)
            new = self.standing(state, ground, False, FULL)
        else:
            bears = own
            if guard == STOPPING:
                bears = other
                half, _ = sine_cosine(0.5 * state[ROTATION])
                state[SLIP] += 2.0 * side * width * half * half
            state[RISE] = 0.0
            self.struck(bears, state, (across, up), 1.0)
            new = self.leaning(bears, state, ground, False)
        memory[IMPACT_LOSS] += before - self.kinetic_energy(new, state)
        return new

    @kernel
    def centre_rise(self, mode: int, state: Vector) -> float:
        """Give the rise of the centre of mass, to all digits."""
        sine, _ = sine_cosine(state[ROTATION])
        half, _ = sine_cosine(0.5 * state[ROTATION])
        side = self.side(mode // SLIPS)
        return state[RISE] + side * self.distance(side) * sine - 2.0 * self.height * half * half

    @kernel
    def energies(self, mode: int, state: Vector) -> Energies:
        """Give kinetic and gravity energy; nothing is elastic."""
        kinetic = self.kinetic_energy(mode, state)
        return Energies(kinetic, self.gravity * self.centre_rise(mode, state), 0.0, 0.0)

    @kernel
    def observe(
        self, mode: int, state: Vector, slope: Slope, ground: Ground, memory: Vector
    ) -> tuple[float, ...]:
        """Give the motion of the centre of mass, the reactions, and the slip."""
        bears, rotation, rate = mode // SLIPS, state[ROTATION], state[SIZE + ROTATION]
        side = self.side(bears)
        beside, above = self.reach(side, rotation)
        across, up = self.speeds(mode, state)
        square = rate * rate
        sway = slope[SLIP] + above * slope[ROTATION] - beside * square
        rise = slope[RISE] - beside * slope[ROTATION] - above * square
        shear, bearing = sway + ground.x, rise + self.gravity + ground.y
        left, right = (0.0, bearing) if side > 0.0 else (bearing, 0.0)
        if bears == FULL:
            width = self.left + self.right
            left = (self.right * bearing + self.height * shear) / width
            right = (self.left * bearing - self.height * shear) / width
        place = state[SLIP] + (side * self.distance(side) + beside)
        lift = self.centre_rise(mode, state)
        body = rotation, rate, lift, up, place, shear, across, slope[ROTATION], sway, rise
        return body + (shear, bearing, left, right, state[SLIP], state[SIZE + SLIP])
