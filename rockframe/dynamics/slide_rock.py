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
    DOF,
    FLIGHT_LEFT,
    FLIGHT_RIGHT,
    FULL,
    HELD,
    LANDING,
    NORMAL_FORCE,
    ON_LEFT,
    ON_RIGHT,
    PEAK_LEFT,
    PEAK_RIGHT,
    RISE,
    ROTATION,
    ROUNDING,
    SLIDE_MEMORY,
    SLIP,
    SLIP_LEFT,
    SLIP_RIGHT,
    SLIP_STATES,
    STOPPING,
    TIPPING_LEFT,
    TO_LEFT,
    TO_RIGHT,
    Loads,
    SlideMotion,
)
from rockframe.dynamics.trigonometry import sine_cosine


class SlideRock(SlideMotion):
    """A block on rigid ground with friction, per unit mass: a system."""

    __slots__ = ()

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Return the mode after a guard of bearing or slip; an impact also changes the rates."""
        bearing = self.bearing_in(mode)
        if bearing >= FLIGHT_RIGHT:
            new = self.land(mode, guard, state, ground, memory)
            if self.bearing_in(new) < FLIGHT_RIGHT:
                self.record_slip(state, memory)
            return new
        self.record_slip(state, memory)
        if guard == LANDING:
            return self.rock_over(mode, state, ground, memory)
        if guard == STOPPING:
            state[DOF + SLIP] = 0.0
        tipped = FULL
        if bearing == FULL:
            tipped = (
                ON_RIGHT if guard == NORMAL_FORCE else ON_LEFT if guard == TIPPING_LEFT else FULL
            )
        if bearing != FULL and guard == NORMAL_FORCE:  # its force is zero but for rounding
            new = self.with_contact(mode, SLIP_STATES * (bearing + FLIGHT_RIGHT - ON_RIGHT))
        else:
            new = self.next_mode(mode, state, ground, guard in (SLIP_RIGHT, SLIP_LEFT), tipped)
        memory[LAST_EVENT] = self.event_between(mode, new)
        return new

    switch_body = switch

    @inlined
    def record_slip(self, state: Vector, memory: Vector) -> None:
        """Update the largest slips to either side."""
        memory[PEAK_LEFT] = max(memory[PEAK_LEFT], -state[SLIP])
        memory[PEAK_RIGHT] = max(memory[PEAK_RIGHT], state[SLIP])

    @kernel
    def next_mode(
        self, mode: int, state: Vector, ground: Ground, gives_way: bool, tipped: int
    ) -> int:
        """Return the mode that follows without an impact, from the forces on the block.

        With `gives_way` friction no longer holds; `tipped` is the corner over which it tips.
        """
        bearing, loads = self.bearing_in(mode), self.loads(mode, state, ground)
        if bearing >= FLIGHT_RIGHT:
            return mode
        if bearing == FULL:
            return self.with_contact(mode, self.mode_on_base(state, loads, gives_way, tipped))
        return self.with_contact(mode, self.mode_on_corner(bearing, state, loads, gives_way))

    @inlined
    def event_between(self, old: int, new: int) -> int:
        """Return the kind of event by which one mode follows another without an impact."""
        old_bearing, bearing = self.bearing_in(old), self.bearing_in(new)
        if bearing >= FLIGHT_RIGHT:
            return SEPARATION
        if old_bearing == FULL and bearing != FULL:
            return UPLIFT
        if old == new:
            return SILENT
        if new % SLIP_STATES == HELD:
            return events.STICK
        return events.SLIP if old % SLIP_STATES == HELD else events.REVERSAL

    @kernel
    def mode_on_base(self, state: Vector, loads: Loads, gives_way: bool, tipped: int) -> int:
        """Return the bearing and slip of a block upright on its base, :eq:`eq-slide-start`.

        With `gives_way` friction no longer holds; `tipped` is the corner over which it tips.
        """
        across, weight, slip = loads.along, loads.weight, state[DOF + SLIP]
        if weight <= ROUNDING * self.gravity:
            return SLIP_STATES * (FLIGHT_LEFT if across > 0.0 else FLIGHT_RIGHT)
        if slip == 0.0:
            over = tipped if tipped != FULL else self.tipping_corner(across, loads)
            if over == FULL and not gives_way and abs(across) <= self.static * weight:
                return SLIP_STATES * FULL + HELD
            if over != FULL and self.static == math.inf:
                return self.mode_on_corner(over, state, loads, False)
            if over != FULL:
                held = self.contact(SLIP_STATES * over, state, loads)
                if abs(held.along) <= self.static * held.normal:
                    return SLIP_STATES * over + HELD
        sign = math.copysign(1.0, slip if slip != 0.0 else -across)
        over = tipped if slip != 0.0 else FULL
        if over == FULL:
            over = self.tipping_corner(-sign * self.kinetic * weight, loads)
        return SLIP_STATES * over + (TO_RIGHT if sign > 0.0 else TO_LEFT)

    @inlined
    def tipping_corner(self, along: float, loads: Loads) -> int:
        """Return the corner over which a force of the ground on the whole base tips the block."""
        tipping = self.height * along - loads.moment
        if self.right * loads.weight + tipping < 0.0:
            return ON_RIGHT
        return ON_LEFT if self.left * loads.weight - tipping < 0.0 else FULL

    @kernel
    def mode_on_corner(self, bearing: int, state: Vector, loads: Loads, gives_way: bool) -> int:
        """Return bearing and slip that follow for a block on one corner: held, slipping, flight."""
        slip, corner = state[DOF + SLIP], SLIP_STATES * bearing
        flies = corner + SLIP_STATES * (FLIGHT_RIGHT - ON_RIGHT)
        held = self.contact(corner + HELD, state, loads)
        holds = self.static == math.inf
        rises = self.free_acceleration(bearing, state, loads) >= -ROUNDING * self.gravity
        if rises and not (holds and held.normal > 0.0):
            return flies
        if holds:
            return corner + HELD
        if slip != 0.0:
            return corner + (TO_RIGHT if slip > 0.0 else TO_LEFT)
        if not gives_way and abs(held.along) <= self.static * held.normal:
            return corner + HELD
        first, second = (TO_LEFT, TO_RIGHT) if held.along > 0.0 else (TO_RIGHT, TO_LEFT)
        if self.slip_grows(corner + first, state, loads):
            return corner + first
        # where neither grows the event was too early, and the corner remains held
        return corner + (second if self.slip_grows(corner + second, state, loads) else HELD)

    @inlined
    def slip_grows(self, mode: int, state: Vector, loads: Loads) -> bool:
        """Whether a slip in the sense of a mode would grow."""
        return (
            self.slip_sign(mode) * self.contact(mode, state, loads).slip > -ROUNDING * self.gravity
        )

    @kernel
    def impact_impulses(
        self, arm_x: float, arm_y: float, lever: float, slip: float, normal_velocity: float
    ) -> tuple[float, float]:
        """Return the impulses along and normal to the ground that stop a corner.

        The normal one acts at a distance of `lever` times `arm_x` from the centre of mass.
        """
        inertia, friction = self.inertia, self.impulsive
        mixed, along = -arm_x * arm_y / inertia, 1.0 + arm_y * arm_y / inertia
        answers = ImpulseResponse(
            1.0 + lever * arm_x * arm_x / inertia, mixed, lever * mixed, along
        )
        if friction == math.inf and slip * mixed < normal_velocity * along:
            friction = self.kinetic  # holding the corner would take tension of the ground
        return coulomb_impulse(answers, slip, normal_velocity, friction)

    @kernel
    def apply_impact(
        self, bearing: int, state: Vector, speeds: tuple[float, float], lever: float
    ) -> None:
        """Write the rates after an impact on a corner, whose slip and rise they then include."""
        side, rate = self.side(bearing), state[DOF + ROTATION]
        arm_x, arm_y = self.centre_from_corner(side, state[ROTATION])
        across, up = speeds
        along, normal = self.impact_impulses(
            arm_x, arm_y, lever, across - arm_y * rate, up + arm_x * rate
        )
        rate += (lever * arm_x * normal - arm_y * along) / self.inertia
        slip = across + along - arm_y * rate
        # rounding noise of a slip that has ended
        noise = ROUNDING * (abs(across) + abs(along) + abs(arm_y * rate))
        state[DOF + SLIP] = slip if abs(slip) > noise else 0.0
        state[DOF + ROTATION] = rate
        state[DOF + RISE] = up + arm_x * rate if normal == 0.0 else 0.0

    @kernel
    def land_flat(self, state: Vector, across: float, up: float) -> None:
        """Stop a block that lands on its whole base, but for the slip that friction cannot stop."""
        left = abs(across) - self.impulsive * -up if self.impulsive < math.inf else 0.0
        lasts = left > 0.0 and not self.is_slip_negligible(left)
        state[DOF + SLIP] = math.copysign(left, across) if lasts else 0.0
        state[DOF + ROTATION] = state[DOF + RISE] = state[ROTATION] = state[RISE] = 0.0

    @kernel
    def rock_over(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Strike the ground with the other corner; continue rocking about it, or on the whole base.

        From rocking about a held corner the corner that strikes slips as in :eq:`eq-slide-through`.
        """
        old_bearing = self.bearing_in(mode)
        new = ON_LEFT if old_bearing == ON_RIGHT else ON_RIGHT
        before = self.kinetic_energy(mode, state)
        touched = self.with_contact(mode, SLIP_STATES * new)
        state[ROTATION] = 0.0
        across, up = self.centre_velocity(mode, state)
        lever = self.right_lever if new == ON_RIGHT else self.left_lever
        self.apply_impact(new, state, (across, up), lever)
        memory[LAST_EVENT] = IMPACT
        if self.side(old_bearing) * state[DOF + ROTATION] >= 0.0:  # a block so wide lands flat
            self.land_flat(state, across, up)
            after = self.mode_on_base(state, self.loads(touched, state, ground), False, FULL)
        else:
            loads = self.loads(touched, state, ground)
            after = self.mode_on_corner(new, state, loads, False)
            slip, rate, rise = state[DOF + SLIP], state[DOF + ROTATION], state[DOF + RISE]
            trial, rests = after, False
            if self.is_slip_negligible(slip):
                state[DOF + SLIP] = 0.0
                trial = (
                    after if self.bearing_in(after) >= FLIGHT_RIGHT else SLIP_STATES * new + HELD
                )
            if self.is_rebound_negligible(trial, state, loads):
                state[DOF + ROTATION] = 0.0
                if state[DOF + SLIP] != 0.0:  # the bounces end as in a flat landing
                    self.land_flat(state, across, up)
                base = self.mode_on_base(state, self.loads(touched, state, ground), False, FULL)
                # no rest where the ground acceleration tips the block over a corner
                rest_bearing = base // SLIP_STATES
                if rest_bearing == FULL:
                    memory[LAST_EVENT] = REST
                bounces = self.bearing_in(after) >= FLIGHT_RIGHT
                rests = rest_bearing == FULL or (bounces and rest_bearing == old_bearing)
                after = base if rests else after
            if not rests:
                state[DOF + SLIP], state[DOF + ROTATION], state[DOF + RISE] = slip, rate, rise
        memory[IMPACT_LOSS] += before - self.kinetic_energy(after, state)
        return self.with_contact(mode, after)

    @inlined
    def is_slip_negligible(self, slip: float) -> bool:
        """Whether the rate of a slip after an impact is negligible."""
        return slip * slip < REST_AMPLITUDE * self.gravity * self.height

    @inlined
    def is_rebound_negligible(self, mode: int, state: Vector, loads: Loads) -> bool:
        """Whether the rise of the corner that has just lifted, until it falls back, is negligible.

        Links may lift the other corner meanwhile.
        """
        bearing, rate = self.bearing_in(mode), state[DOF + ROTATION]
        if bearing == FULL:
            return False
        side, contact = self.side(bearing), self.contact(mode, state, loads)
        restoring = -side * contact.rotation - contact.rise / (self.left + self.right)
        limit = REST_AMPLITUDE * math.atan2(self.distance(side), self.height)
        return restoring > 0.0 and rate * rate < 2.0 * restoring * limit

    @kernel
    def land(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Strike the ground with a corner after a flight, or with the whole base."""
        old_bearing = self.bearing_in(mode)
        own = ON_RIGHT if old_bearing == FLIGHT_RIGHT else ON_LEFT
        other = ON_LEFT if own == ON_RIGHT else ON_RIGHT
        side, width = self.side(old_bearing), self.left + self.right
        before = self.kinetic_energy(mode, state)
        across, up = self.centre_velocity(mode, state)
        sine, cosine = sine_cosine(state[ROTATION])
        rate = state[DOF + ROTATION]
        memory[LAST_EVENT] = IMPACT
        other_rise, other_speed = state[RISE] + side * width * sine, state[DOF + RISE]
        other_speed += side * width * cosine * rate
        lowest = max(abs(state[RISE]), abs(other_rise))
        if lowest < ROUNDING * width and state[DOF + RISE] <= 0.0 and other_speed <= 0.0:
            self.land_flat(state, across, up)
            new = self.mode_on_base(state, self.loads(mode, state, ground), False, FULL)
        else:
            bearing = own
            if guard == STOPPING:
                bearing = other
                half, _ = sine_cosine(0.5 * state[ROTATION])
                state[SLIP] += 2.0 * side * width * half * half
            state[RISE] = 0.0
            self.apply_impact(bearing, state, (across, up), 1.0)
            touched = self.with_contact(mode, SLIP_STATES * bearing)
            new = self.mode_on_corner(bearing, state, self.loads(touched, state, ground), False)
            if state[DOF + RISE] > 0.0 and not self.stop_small_rise(
                bearing, touched, state, ground
            ):
                new = SLIP_STATES * (bearing + FLIGHT_RIGHT - ON_RIGHT)
        memory[IMPACT_LOSS] += before - self.kinetic_energy(new, state)
        return self.with_contact(mode, new)

    @kernel
    def stop_small_rise(self, bearing: int, mode: int, state: Vector, ground: Ground) -> bool:
        """Stop a corner that has struck and rises negligibly; return whether it was stopped.

        It is stopped if, free, it would fall back, and if the other corner is clear of the ground.
        """
        rise, side = state[DOF + RISE], self.side(bearing)
        fall = -self.free_acceleration(bearing, state, self.loads(mode, state, ground))
        small = rise * rise < 2.0 * fall * REST_AMPLITUDE * (self.left + self.right)
        leans = side * state[ROTATION] > REST_AMPLITUDE * math.atan2(
            self.distance(side), self.height
        )
        if fall <= 0.0 or not small or not leans:
            return False
        arm_x, arm_y = self.centre_from_corner(side, state[ROTATION])
        state[DOF + ROTATION] -= arm_x * rise / (self.inertia + arm_x * arm_x + arm_y * arm_y)
        state[DOF + RISE] = 0.0
        return True


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
        direction = rotation or rate
        bearing = FULL if direction == 0.0 else ON_RIGHT if direction > 0.0 else ON_LEFT
        state = np.array([rotation, 0.0, 0.0, rate, 0.0, 0.0])
        return SLIP_STATES * bearing + HELD, state, np.zeros(len(SLIDE_MEMORY))

    return ContactModel(
        name="sliding on rigid ground",
        system=system,
        rotation_limits=(angle, angle),
        rotation_weights=np.array([1.0, 0.0, 0.0]),
        scales=np.concatenate([size, frequency * size]),
        guard_tolerance=np.array([1e-15, 1e-15, *(1e-14,) * 4]),
        columns=COLUMNS,
        memory=SLIDE_MEMORY,
        mass=mass,
        fastest_frequency=frequency,
        damping_rate=0.0,
        energy_scale=gravity * radius * angle,
        initial=initial,
    )
