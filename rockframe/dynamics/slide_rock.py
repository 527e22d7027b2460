"""A block that slides, rocks and flies on rigid ground with friction: its events, and its model.

Page "Sliding" of the manual. As a guard falls to zero another mode of
:mod:`rockframe.dynamics.slide_motion` follows; an impact also changes the rates,
:eq:`eq-slide-impact`.
"""

import math

import numpy as np

from rockframe.case_arrays import atan2, hypot, sqrt
from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics import events
from rockframe.dynamics.body import REST_AMPLITUDE
from rockframe.dynamics.coulomb import ImpulseResponse, coulomb_impulse
from rockframe.dynamics.events import IMPACT, REST, SEPARATION, SILENT, UPLIFT
from rockframe.dynamics.protocol import IMPACT_LOSS, LAST_EVENT, ContactModel, Ground, Start
from rockframe.dynamics.slide_motion import (
    COLUMNS,
    FLIES_LEFT,
    FLIES_RIGHT,
    FULL,
    HELD,
    LANDING,
    ON_LEFT,
    ON_RIGHT,
    PEAK_LEFT,
    PEAK_RIGHT,
    PRESSING,
    REMEMBERED,
    RISE,
    ROTATION,
    ROUNDING,
    SIZE,
    SLIP,
    SLIPS,
    SLIPS_LEFT,
    SLIPS_RIGHT,
    STOPPING,
    TIPS_LEFT,
    TO_LEFT,
    TO_RIGHT,
    Loads,
    SlideMotion,
)
from rockframe.dynamics.trigonometry import sine_cosine


class SlideSwitches(SlideMotion):
    """Switches of mode, and impacts, of a block. A mixin of systems."""

    __slots__ = ()

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Return the mode after a guard has fallen; after an impact also the rates."""
        return self.switch_contact(mode, guard, state, ground, memory)

    @inlined
    def switch_contact(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Return the mode after a guard of bearing or slip has fallen."""
        bears = self.bears_in(mode)
        if bears >= FLIES_RIGHT:
            new = self.come_down(mode, guard, state, ground, memory)
            if self.bears_in(new) < FLIES_RIGHT:
                self.keep_slip(state, memory)
            return new
        self.keep_slip(state, memory)
        if guard == LANDING:
            return self.roll_over(mode, state, ground, memory)
        if guard == STOPPING:
            state[SIZE + SLIP] = 0.0
        tips = FULL
        if bears == FULL:
            tips = ON_RIGHT if guard == PRESSING else ON_LEFT if guard == TIPS_LEFT else FULL
        if bears != FULL and guard == PRESSING:  # its force is zero but for rounding
            new = self.with_contact(mode, SLIPS * (bears + FLIES_RIGHT - ON_RIGHT))
        else:
            new = self.go_on(mode, state, ground, guard in (SLIPS_RIGHT, SLIPS_LEFT), tips)
        memory[LAST_EVENT] = self.kind_of(mode, new)
        return new

    @inlined
    def keep_slip(self, state: Vector, memory: Vector) -> None:
        """Update the largest slips to either side."""
        memory[PEAK_LEFT] = max(memory[PEAK_LEFT], -state[SLIP])
        memory[PEAK_RIGHT] = max(memory[PEAK_RIGHT], state[SLIP])

    @kernel
    def go_on(self, mode: int, state: Vector, ground: Ground, lets_go: bool, tips: int) -> int:
        """Return the mode that follows without an impact, from the forces on the block.

        With `lets_go` friction holds no longer; `tips` is the corner over which it tips, if known.
        """
        bears, loads = self.bears_in(mode), self.loads(mode, state, ground)
        if bears >= FLIES_RIGHT:
            return mode
        if bears == FULL:
            return self.with_contact(mode, self.standing(state, loads, lets_go, tips))
        return self.with_contact(mode, self.leaning(bears, state, loads, lets_go))

    @inlined
    def kind_of(self, old: int, new: int) -> int:
        """Return the kind of event by which one mode follows another without an impact."""
        bore, bears = self.bears_in(old), self.bears_in(new)
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
    def standing(self, state: Vector, loads: Loads, lets_go: bool, tips: int) -> int:
        """Return the bearing and slip of a block upright on its base, :eq:`eq-slide-start`.

        With `lets_go` friction holds no longer; `tips` is the corner over which it tips.
        """
        across, weight, slip = loads.across, loads.weight, state[SIZE + SLIP]
        if weight <= ROUNDING * self.gravity:
            return SLIPS * (FLIES_LEFT if across > 0.0 else FLIES_RIGHT)
        if slip == 0.0:
            over = tips if tips != FULL else self.tips_over(across, loads)
            if over == FULL and not lets_go and abs(across) <= self.static * weight:
                return SLIPS * FULL + HELD
            if over != FULL and self.static == math.inf:
                return self.leaning(over, state, loads, False)
            if over != FULL:
                held = self.contact(SLIPS * over, state, loads)
                if abs(held.along) <= self.static * held.normal:
                    return SLIPS * over + HELD
        sense = math.copysign(1.0, slip if slip != 0.0 else -across)
        over = tips if slip != 0.0 else FULL
        if over == FULL:
            over = self.tips_over(-sense * self.kinetic * weight, loads)
        return SLIPS * over + (TO_RIGHT if sense > 0.0 else TO_LEFT)

    @inlined
    def tips_over(self, along: float, loads: Loads) -> int:
        """Return the corner over which a force of the ground on the whole base tips the block."""
        tips = self.height * along - loads.turning
        if self.right * loads.weight + tips < 0.0:
            return ON_RIGHT
        return ON_LEFT if self.left * loads.weight - tips < 0.0 else FULL

    @kernel
    def leaning(self, bears: int, state: Vector, loads: Loads, lets_go: bool) -> int:
        """Return bearing and slip that follow for a block on one corner: held, slipping, flight."""
        slip, corner = state[SIZE + SLIP], SLIPS * bears
        flies = corner + SLIPS * (FLIES_RIGHT - ON_RIGHT)
        held = self.contact(corner + HELD, state, loads)
        holds = self.static == math.inf
        rises = self.free_rise(bears, state, loads) >= -ROUNDING * self.gravity
        if rises and not (holds and held.normal > 0.0):
            return flies
        if holds:
            return corner + HELD
        if slip != 0.0:
            return corner + (TO_RIGHT if slip > 0.0 else TO_LEFT)
        if not lets_go and abs(held.along) <= self.static * held.normal:
            return corner + HELD
        first, second = (TO_LEFT, TO_RIGHT) if held.along > 0.0 else (TO_RIGHT, TO_LEFT)
        if self.starts(corner + first, state, loads):
            return corner + first
        # where neither grows the event came too early, and the corner stays held
        return corner + (second if self.starts(corner + second, state, loads) else HELD)

    @inlined
    def starts(self, mode: int, state: Vector, loads: Loads) -> bool:
        """Whether a slip in the sense of a mode would grow."""
        return self.sense(mode) * self.contact(mode, state, loads).slip > -ROUNDING * self.gravity

    @kernel
    def strike(
        self, beside: float, above: float, lever: float, slip: float, sinking: float
    ) -> tuple[float, float]:
        """Return the impulses along and normal to the ground that stop a corner.

        The normal one acts at a distance of `lever` times `beside` from the centre of mass.
        """
        inertia, friction = self.inertia, self.impulsive
        mixed, along = -beside * above / inertia, 1.0 + above * above / inertia
        answers = ImpulseResponse(
            1.0 + lever * beside * beside / inertia, mixed, lever * mixed, along
        )
        if friction == math.inf and slip * mixed < sinking * along:
            friction = self.kinetic  # holding the corner would take tension of the ground
        return coulomb_impulse(answers, slip, sinking, friction)

    @kernel
    def struck(self, bears: int, state: Vector, speeds: tuple[float, float], lever: float) -> None:
        """Write the rates after an impact on a corner: slip and rise become those of it."""
        side, rate = self.side(bears), state[SIZE + ROTATION]
        beside, above = self.reach(side, state[ROTATION])
        across, up = speeds
        along, normal = self.strike(beside, above, lever, across - above * rate, up + beside * rate)
        rate += (lever * beside * normal - above * along) / self.inertia
        slip = across + along - above * rate
        # rounding noise of a slip that has ended
        noise = ROUNDING * (abs(across) + abs(along) + abs(above * rate))
        state[SIZE + SLIP] = slip if abs(slip) > noise else 0.0
        state[SIZE + ROTATION] = rate
        state[SIZE + RISE] = up + beside * rate if normal == 0.0 else 0.0

    @kernel
    def lie_flat(self, state: Vector, across: float, up: float) -> None:
        """Stop a block that lands on its whole base; the slip that friction leaves continues."""
        left = abs(across) - self.impulsive * -up if self.impulsive < math.inf else 0.0
        lasts = left > 0.0 and not self.creeps(left)
        state[SIZE + SLIP] = math.copysign(left, across) if lasts else 0.0
        state[SIZE + ROTATION] = state[SIZE + RISE] = state[ROTATION] = state[RISE] = 0.0

    @kernel
    def roll_over(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Strike the ground with the other corner; continue rocking about it, or on the whole base.

        From rocking about a held corner the corner that strikes slips as in :eq:`eq-slide-through`.
        """
        bore = self.bears_in(mode)
        new = ON_LEFT if bore == ON_RIGHT else ON_RIGHT
        before, turned = self.kinetic_energy(mode, state), self.with_contact(mode, SLIPS * new)
        state[ROTATION] = 0.0
        across, up = self.speeds(mode, state)
        lever = self.right_lever if new == ON_RIGHT else self.left_lever
        self.struck(new, state, (across, up), lever)
        memory[LAST_EVENT] = IMPACT
        if self.side(bore) * state[SIZE + ROTATION] >= 0.0:  # a block so wide lands flat
            self.lie_flat(state, across, up)
            after = self.standing(state, self.loads(turned, state, ground), False, FULL)
        else:
            loads = self.loads(turned, state, ground)
            after = self.leaning(new, state, loads, False)
            slip, rate, rise = state[SIZE + SLIP], state[SIZE + ROTATION], state[SIZE + RISE]
            leans, stands = after, False
            if self.creeps(slip):
                state[SIZE + SLIP] = 0.0
                leans = after if self.bears_in(after) >= FLIES_RIGHT else SLIPS * new + HELD
            if self.rebounds_little(leans, state, loads):
                state[SIZE + ROTATION] = 0.0
                if state[SIZE + SLIP] != 0.0:  # the bounces end with the momentum across the ground
                    self.lie_flat(state, across, up)
                base = self.standing(state, self.loads(turned, state, ground), False, FULL)
                # no rest where the ground acceleration tips the block over a corner
                if base // SLIPS == FULL:
                    memory[LAST_EVENT] = REST
                bounces = self.bears_in(after) >= FLIES_RIGHT
                stands = base // SLIPS == FULL or (bounces and base // SLIPS == bore)
                after = base if stands else after
            if not stands:
                state[SIZE + SLIP], state[SIZE + ROTATION], state[SIZE + RISE] = slip, rate, rise
        memory[IMPACT_LOSS] += before - self.kinetic_energy(after, state)
        return self.with_contact(mode, after)

    @inlined
    def creeps(self, slip: float) -> bool:
        """Whether the rate of a slip after an impact is negligible."""
        return slip * slip < REST_AMPLITUDE * self.gravity * self.height

    @inlined
    def rebounds_little(self, mode: int, state: Vector, loads: Loads) -> bool:
        """Whether the rise of the corner that has borne, until it comes back, is negligible.

        Links may lift the other corner meanwhile.
        """
        bears, rate = self.bears_in(mode), state[SIZE + ROTATION]
        if bears == FULL:
            return False
        side, found = self.side(bears), self.contact(mode, state, loads)
        restoring = -side * found.rotation - found.rise / (self.left + self.right)
        most = REST_AMPLITUDE * math.atan2(self.distance(side), self.height)
        return restoring > 0.0 and rate * rate < 2.0 * restoring * most

    @kernel
    def come_down(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Strike the ground with a corner after a flight, or with the whole base."""
        flew = self.bears_in(mode)
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
            new = self.standing(state, self.loads(mode, state, ground), False, FULL)
        else:
            bears = own
            if guard == STOPPING:
                bears = other
                half, _ = sine_cosine(0.5 * state[ROTATION])
                state[SLIP] += 2.0 * side * width * half * half
            state[RISE] = 0.0
            self.struck(bears, state, (across, up), 1.0)
            touched = self.with_contact(mode, SLIPS * bears)
            new = self.leaning(bears, state, self.loads(touched, state, ground), False)
            if state[SIZE + RISE] > 0.0 and not self.stays_if_small(bears, touched, state, ground):
                new = SLIPS * (bears + FLIES_RIGHT - ON_RIGHT)
        memory[IMPACT_LOSS] += before - self.kinetic_energy(new, state)
        return self.with_contact(mode, new)

    @kernel
    def stays_if_small(self, bears: int, mode: int, state: Vector, ground: Ground) -> bool:
        """Stop a corner that has struck and rises negligibly; return whether it was stopped.

        It is stopped if, free, it would fall back, and if the other corner is clear of the ground.
        """
        rise, side = state[SIZE + RISE], self.side(bears)
        fall = -self.free_rise(bears, state, self.loads(mode, state, ground))
        small = rise * rise < 2.0 * fall * REST_AMPLITUDE * (self.left + self.right)
        leans = side * state[ROTATION] > REST_AMPLITUDE * math.atan2(
            self.distance(side), self.height
        )
        if fall <= 0.0 or not small or not leans:
            return False
        beside, above = self.reach(side, state[ROTATION])
        state[SIZE + ROTATION] -= beside * rise / (self.inertia + beside * beside + above * above)
        state[SIZE + RISE] = 0.0
        return True


class SlideRock(SlideSwitches):
    """A block on rigid ground with friction, per unit mass: a system."""

    __slots__ = ()


def ill_posed_friction(inertia: float, square: float) -> float:
    """Return the least coefficient at which a slipping corner may jam, :eq:`eq-slide-painleve`.

    `inertia` is that about the centre of mass over the mass [m^2]; `square` is the square of the
    distance between the centre of mass and the corner [m^2].
    """
    ratio = inertia / square
    return 2.0 * sqrt(ratio * (1.0 + ratio))


def impulse_lever(*, restitution: float, own: float, width: float, about_foot: float) -> float:
    """Return the lever of the impulse as a block rocks onto its other corner, :eq:`eq-slide-lever`.

    It is over the distance `own` of the striking corner from the foot of the centre of mass [m];
    `about_foot` is the inertia about that foot over the mass [m^2].
    """
    lost = 1.0 - restitution
    return lost * about_foot / (own * (width - lost * own))


def slide_rock(system: SlideRock, *, mass: float) -> ContactModel:
    """Assemble the model of a block that slides and rocks, from its mass [kg]."""
    gravity = system.gravity
    least = min(system.left, system.right)
    angle, radius = atan2(least, system.height), hypot(least, system.height)
    frequency = sqrt(gravity * radius / (system.inertia + radius * radius))
    size = np.array([angle, least, least])

    def initial(start: Start) -> tuple[int, Vector, Vector]:
        rotation, rate = start.rotation or 0.0, start.angular_velocity
        leans = rotation or rate
        bears = FULL if leans == 0.0 else ON_RIGHT if leans > 0.0 else ON_LEFT
        state = np.array([rotation, 0.0, 0.0, rate, 0.0, 0.0])
        return SLIPS * bears + HELD, state, np.zeros(len(REMEMBERED))

    return ContactModel(
        name="sliding on rigid ground",
        system=system,
        rotation_limits=(angle, angle),
        rotation_weights=np.array([1.0, 0.0, 0.0]),
        scales=np.concatenate([size, frequency * size]),
        guard_tolerance=np.array([1e-15, 1e-15, *(1e-14,) * 4]),
        columns=COLUMNS,
        memory=REMEMBERED,
        mass=mass,
        fastest_frequency=frequency,
        damping_rate=0.0,
        energy_scale=gravity * radius * angle,
        initial=initial,
    )
