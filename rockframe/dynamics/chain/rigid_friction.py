"""A chain in which bodies slip on rigid bases, beside others that pads and beds hold.

A body is held along its rigid base as long as friction can, :eq:`eq-stack-friction`, and slips
otherwise: then the force at each corner that bears has friction in it, :eq:`eq-stack-slip`. Which
corners bear and which bases slip is found together, under new forces as after an impact,
:eq:`eq-stack-impact`.
"""

import math
from typing import Final

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, ROTATION, VERTICAL
from rockframe.dynamics.body import PIVOT_LEFT, PIVOT_RIGHT
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.corners import NONE, PULLED
from rockframe.dynamics.chain.impact import (
    BOTH,
    LEFT_ONLY,
    NEARLY_ZERO,
    NOISE,
    RIGHT_ONLY,
    Attempt,
    attempt,
    bearing_corners,
)
from rockframe.dynamics.chain.motion import FREE, coriolis_along, of_both, write_direction
from rockframe.dynamics.chain.rigid import ADMISSIBLE, OTHER, TAKEN, RigidChain
from rockframe.dynamics.chain.rows import CONSTRAINT, GUARDS, MODES, MOST_CONSTRAINTS, PLACES
from rockframe.dynamics.chain.slips import (
    IMPULSIVE,
    KINETIC,
    OFFSET,
    ROUNDING,
    STATIC,
    SlippingBodies,
)
from rockframe.dynamics.on_base import HOLD, SLIP
from rockframe.dynamics.pads import CORNER_GUARDS
from rockframe.dynamics.protocol import HELD_PLACE, LAST_EVENT, Ground
from rockframe.dynamics.sliding import NOISE as NOISE_OF_SLIP

FRICTION_ALONE: Final = -1
"""In place of the corner that leaves: what friction does has changed."""
TRIES: Final = 6
"""Changes of what slips, of each body, after which a set of corners is given up."""


class SlippingRigidChain(SlippingBodies, RigidChain):
    """Bodies upon one another of which some slip on rigid bases: a system."""

    __slots__ = ()

    @inlined
    def slip_sense(self, k: int) -> float:
        """Give the sense in which a body slips on its rigid base as corners are tried: 0, held."""
        return float(self.places()[k * PLACES + at.SLIPS])

    @inlined
    def sense_in(self, mode: int, k: int) -> float:
        """Give the sense in which a body slips on its rigid base in a mode; 0 if it does not."""
        if self.is_rigid(k) and self.part_mode(mode, k).slides:
            return self.sense(mode, k)
        return 0.0

    @kernel
    def note_slips(self, mode: int) -> None:
        """Note which bodies slip on rigid bases in a mode."""
        room = self.places()
        for k in range(self.body_count):
            room[k * PLACES + at.SLIPS] = self.sense_in(mode, k)

    @inlined
    def forget_slips(self, mode: int, impulsive: bool) -> None:
        """Go back to what slipped in a mode; nothing does where all is held in an impact."""
        self.note_slips(mode)
        if impulsive:
            for k in range(self.body_count):
                self.places()[k * PLACES + at.SLIPS] = 0.0

    @kernel
    def standing_on(self, k: int, bears: int, mode: int) -> int:
        """Give the mode in which a body slips on its base, if it does."""
        sense = self.slip_sense(k)
        if bears != 0 and sense != 0.0:
            return self.slipping(mode, k, sense)
        value = MODES**self.body_count * 2**k
        return mode - mode // value % 2 * value

    @kernel
    def slip_on(self, k: int, bears: int, state: Vector) -> tuple[float, float]:
        """Give the velocity of slip at the corners that bear, and its rounding noise."""
        part, body = self.on_base(k), self.state_of(k, state)
        pin = part.body.pin(PIVOT_LEFT if bears == LEFT_ONLY else PIVOT_RIGHT)
        about = part.body.reach(pin, part.body.attitude(body.rotation)).rate * body.angular_velocity
        sway = body.horizontal_velocity
        return sway - about, NOISE_OF_SLIP * (abs(sway) + abs(about))

    @kernel
    def note_free_slips(self, mode: int, state: Vector) -> None:
        """Note in which sense bodies that no corner bears would slip on landing."""
        bearing, room = self.bearing(mode), self.places()
        for k in range(self.body_count):
            if self.is_rigid(k) and bearing >> 2 * k & BOTH == 0:
                rate, noise = self.slip_on(k, BOTH, state)
                slips = abs(rate) > noise and self.friction_of(k, IMPULSIVE) < math.inf
                room[k * PLACES + at.SLIPS] = math.copysign(1.0, rate) if slips else 0.0

    @kernel
    def rub(
        self, k: int, which: int, sense: float, reach: float, impulsive: bool, room: Vector,
        rows: Vector,
    ) -> None:  # fmt: skip
        """Let the force of a corner that slips have friction, :eq:`eq-stack-slip`."""
        holds, i, ratio = which * CONSTRAINT + at.HOLDS, k * PLACES, 0.0
        if sense != 0.0:
            ratio = -sense * self.friction_of(k, IMPULSIVE if impulsive else KINETIC)
            x, y = ratio * room[i + at.COSINE], -ratio * room[i + at.SINE]
            rows[holds] += x
            rows[holds + 1] += y
            rows[holds + 2] -= ratio * reach
            if k + 1 < self.body_count:
                rows[holds + 3] -= x
                rows[holds + 4] -= y
                rows[holds + 5] += ratio * (reach - room[i + at.ARM])
        room[i + at.RUBS] = ratio

    @kernel
    def stand_still(self, room: Vector, out: Vector) -> None:
        """Write the friction of bodies that slip; of others take rounding from accelerations."""
        for k in range(self.body_count):
            i = k * PLACES
            left, right = room[i + at.LEFT_CORNER], room[i + at.RIGHT_CORNER]
            if not self.is_rigid(k) or (left == NONE and right == NONE):
                continue
            if room[i + at.HELD] == FREE:
                press = self.corner_force(k, True) + self.corner_force(k, False)
                room[i + at.THRUST] = room[i + at.RUBS] * press
            if left != NONE and right != NONE:
                first = BEFORE_HORIZONTAL * k
                out[first + ROTATION] = out[first + VERTICAL] = 0.0
                if room[i + at.HELD] != FREE:
                    out[self.horizontal_of(k)] = 0.0

    @kernel
    def lost_by_friction(
        self, k: int, which: int, state: Vector, room: Vector, rows: Vector
    ) -> float:
        """Give the energy that friction takes in an impact at a corner that slips."""
        first, ratio = which * CONSTRAINT, room[k * PLACES + at.RUBS]
        if ratio == 0.0:
            return 0.0
        # the same at both corners, where both bear
        left = room[k * PLACES + at.LEFT_CORNER] != NONE
        slip, _ = self.slip_on(k, LEFT_ONLY if left else RIGHT_ONLY, state)
        leaned = of_both(self, k, first + at.HOLDS, room, rows) - rows[first + at.VALUE]
        return float(-rows[first + at.FORCE] * (ratio * slip + 0.5 * leaned))

    @kernel
    def must_meet_anew(self) -> bool:
        """Whether rigid bases that have friction, or would have to pull, did something."""
        room = self.places()
        for k in range(self.body_count):
            i = k * PLACES
            acts = room[i + at.LEFT_IMPULSE] != 0.0 or room[i + at.RIGHT_IMPULSE] != 0.0
            if acts and self.friction_of(k, IMPULSIVE) < math.inf:
                return True
        return self.some_pull()

    # which corners bear, and what slips ------------------------------------------------------

    @kernel
    def try_corners(
        self, mode: int, some: int, closed: int, impulsive: bool, noise: float, state: Vector
    ) -> Attempt:
        """Let a set of the closed corners bear, and find which of their bodies slip.

        In an impact by the velocities after it; under new forces what slips goes on, and what is
        held slips where friction cannot hold it.
        """
        room = self.places()
        for k in range(self.body_count):
            i, bears = k * PLACES, some >> 2 * k & BOTH
            room[i + at.SLIPS] = 0.0
            if self.is_rigid(k) and bears != 0 and not impulsive:
                rate, least = self.slip_on(k, bears, state)
                room[i + at.SLIPS] = room[i + at.STARTS]
                if abs(rate) > least:
                    room[i + at.SLIPS] = math.copysign(1.0, rate)
        found = Attempt(0, math.inf)
        for _ in range(TRIES * self.body_count):
            found = attempt(self, mode, some, closed, False, impulsive, noise, state)
            k = self.otherwise(some, closed, impulsive, state)
            if k < 0:
                return found
        return Attempt(max(found.fault, 0), math.inf)

    @kernel
    def otherwise(self, some: int, closed: int, impulsive: bool, state: Vector) -> int:
        """Change how a body is tried that friction cannot hold, or that does not slip; else -1."""
        room, rows = self.places(), self.constraints()
        for k in range(self.body_count):
            i, bears = k * PLACES, some >> 2 * k & BOTH
            friction = self.friction_of(k, IMPULSIVE if impulsive else STATIC)
            if not self.is_rigid(k) or bears & closed >> 2 * k == 0 or friction == math.inf:
                continue
            sense = room[i + at.SLIPS]
            if sense == 0.0:
                press = self.corner_force(k, True) + self.corner_force(k, False)
                last = max(room[i + at.LEFT_CORNER], room[i + at.RIGHT_CORNER])
                thrust = rows[(int(last) + 1) * CONSTRAINT + at.FORCE]
                least = NOISE * abs(press)
                if not impulsive:
                    least = ROUNDING * self.number(k, at.FORCE_SIZE)
                if abs(thrust) > friction * max(press, 0.0) + least:
                    room[i + at.SLIPS] = -math.copysign(1.0, thrust)
                    return k
            else:
                rate, least = self.slip_on(k, bears, state)
                if impulsive or abs(rate) <= least:
                    after = self.slips_on(k, bears, impulsive, state)
                    if impulsive:
                        after, least = after + rate, least + NOISE_OF_SLIP * abs(after)
                    else:  # as it starts to slip, friction is what holds it
                        least = NEARLY_ZERO * self.number(k, at.GRAVITY)
                    if sense * after < -least:
                        room[i + at.SLIPS] = 0.0
                        return k
        return -1

    @kernel
    def slips_on(self, k: int, bears: int, impulsive: bool, state: Vector) -> float:
        """Give the acceleration of slip at the corners that bear, or its change in an impact."""
        i, part, body = k * PLACES, self.on_base(k), self.state_of(k, state)
        room, rows, rate = self.places(), self.constraints(), body.angular_velocity
        pin = part.body.pin(PIVOT_LEFT if bears == LEFT_ONLY else PIVOT_RIGHT)
        reach = part.body.reach(pin, part.body.attitude(body.rotation))
        spare = MOST_CONSTRAINTS * self.body_count - 1  # what slips is not held, so there is room
        keeps = spare * CONSTRAINT + at.KEEPS
        write_direction(self, k, 1.0, 0.0, -reach.rate, keeps, room, rows)
        found = of_both(self, k, keeps, room, rows)
        if impulsive:
            return found
        return found - coriolis_along(i, room) - reach.bend * rate * rate

    # events ----------------------------------------------------------------------------------

    @kernel
    def write_slip_guards(
        self, k: int, mode: int, state: Vector, values: Vector, changes: Vector
    ) -> None:
        """Write the guards of the friction that holds a body, and of its slip."""
        part, standing, body = self.on_base(k), self.part_mode(mode, k), self.state_of(k, state)
        i, friction = GUARDS * k + 2 * CORNER_GUARDS, self.friction_of(k, STATIC)
        if part.flies(standing.contact):
            return
        if standing.slides:
            out, rate, sense = self.slopes(), body.angular_velocity, self.sense(mode, k)
            reach = part.body.reach(
                part.body.pin(standing.pivot), part.body.attitude(body.rotation)
            )
            scale = 1.0 / math.sqrt(part.body.gravity * part.body.size())
            change = out[self.horizontal_of(k)] - reach.bend * rate * rate
            change -= reach.rate * out[BEFORE_HORIZONTAL * k + ROTATION]
            values[i + SLIP] = scale * sense * (body.horizontal_velocity - reach.rate * rate)
            # a slip that starts is not stopped by rounding
            changes[i + SLIP] = scale * (sense * change + ROUNDING * part.body.gravity)
        elif friction < math.inf and standing.contact & PULLED == 0:
            press = self.corner_force(k, True) + self.corner_force(k, False)
            left = friction * max(press, 0.0) - abs(self.places()[k * PLACES + at.THRUST])
            values[i + HOLD] = left / self.number(k, at.FORCE_SIZE)

    @kernel
    def switch_body(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out the switch that a guard of a body calls for; give the new mode."""
        k, room = guard // GUARDS, self.places()
        which = guard - k * GUARDS - 2 * CORNER_GUARDS
        self.begin_event(memory)
        self.begin_slips(mode, state, memory)
        if self.is_rigid(k) and which in (HOLD, SLIP):
            self.write_contacts(mode, state, memory)
            if which == HOLD:
                self.accelerate(mode, state, ground)
                thrust = room[k * PLACES + at.THRUST]
                room[k * PLACES + at.STARTS] = -math.copysign(1.0, thrust)
            else:
                self.end_slip(k, mode, state)
            new = self.rearrange(mode, state, ground, memory)
            memory[LAST_EVENT] = self.kind_of(k, mode, new)
            memory[HELD_PLACE + self.body_count] = k + 1.0
        else:
            new = self.switch_contacts(mode, guard, state, ground, memory)
            new = self.hold_as_far(new, state, ground, memory)
        self.end_slips(new, state, memory)
        return new

    @kernel
    def begin_slips(self, mode: int, state: Vector, memory: Vector) -> None:
        """Remember how far all bodies have slipped, and which of them slip."""
        self.keep_peaks(mode, state, memory)
        self.note_slips(mode)
        for k in range(self.body_count):
            memory[self.kept(k) + OFFSET] += self.point_of(k, mode, state, memory)
            self.places()[k * PLACES + at.STARTS] = 0.0

    @inlined
    def end_slips(self, mode: int, state: Vector, memory: Vector) -> None:
        """Let slips go on from what they were, of points that may be others."""
        for k in range(self.body_count):
            memory[self.kept(k) + OFFSET] -= self.point_of(k, mode, state, memory)

    @kernel
    def hold_as_far(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Give the mode after an event in which friction holds what it can, and opposes slip."""
        new, event = mode, memory[LAST_EVENT]
        for _ in range(self.body_count):
            self.accelerate(new, state, ground)
            amiss = False
            for k in range(self.body_count):
                amiss |= self.is_amiss(k, new, state)
            if not amiss:
                break
            new = self.rearrange(new, state, ground, memory)
            memory[LAST_EVENT] = event
        return new

    @kernel
    def is_amiss(self, k: int, mode: int, state: Vector) -> bool:
        """Whether friction cannot hold a body that is held, or acts along the slip."""
        part, standing = self.on_base(k), self.part_mode(mode, k)
        if not self.is_rigid(k) or part.flies(standing.contact):
            return False
        if standing.slides:
            rate, noise = self.slip_rate(k, mode, state)
            return self.sense(mode, k) * rate < -noise
        friction, room = self.friction_of(k, STATIC), self.places()
        if friction == math.inf or standing.contact & PULLED != 0:
            return False
        press = self.corner_force(k, True) + self.corner_force(k, False)
        thrust, least = room[k * PLACES + at.THRUST], ROUNDING * self.number(k, at.FORCE_SIZE)
        if abs(thrust) <= friction * max(press, 0.0) + least:
            return False
        room[k * PLACES + at.STARTS] = -math.copysign(1.0, thrust)
        return True

    @kernel
    def rearrange(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Give the mode in which the forces have what bears and what slips as it is then."""
        kept, before = HELD_PLACE + self.body_count, self.bearing(mode)
        self.note_slips(mode)
        flying, pulled = self.with_bearing(mode, 0, 0), self.pulled(mode)
        closed = before | self.resting_corners(mode, state)
        self.accelerate(flying, state, ground)
        found = bearing_corners(
            self, flying, closed & ~pulled, pulled, before, FRICTION_ALONE, state
        )
        if found.admissible == 0:
            self.note_slips(mode)
            for k in range(self.body_count):
                starts = self.places()[k * PLACES + at.STARTS]
                if starts != 0.0:
                    self.places()[k * PLACES + at.SLIPS] = starts
        new = self.with_bearing(mode, found.taken, pulled)
        self.hold_contacts(new, state, memory)
        memory[kept + ADMISSIBLE] = found.admissible
        memory[kept + TAKEN], memory[kept + OTHER] = found.taken, found.other
        return new
