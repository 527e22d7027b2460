"""A chain in which some bodies stand on rigid bases, beside others on pads and beds.

Corners lift off as their force falls to zero, and close by impacts, :eq:`eq-projection`.
"""

from typing import Final

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, ROTATION
from rockframe.dynamics.body import REST_AMPLITUDE
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.corner_guards import OPENING
from rockframe.dynamics.chain.corners import PULLED
from rockframe.dynamics.chain.impact import (
    BOTH,
    LEFT_ONLY,
    NEARLY_ZERO,
    RIGHT_ONLY,
    ROUNDING,
    bearing_corners,
    write_corners,
)
from rockframe.dynamics.chain.impulses import RigidImpulses
from rockframe.dynamics.chain.motion import load_bodies
from rockframe.dynamics.chain.rows import GUARDS
from rockframe.dynamics.events import FULL, IMPACT, REST, SEPARATION, SILENT, UPLIFT
from rockframe.dynamics.on_base import Mode
from rockframe.dynamics.pads import CORNER_GUARDS, REENGAGE
from rockframe.dynamics.protocol import (
    HELD_PLACE,
    IMPACT_LOSS,
    LAST_EVENT,
    REPINNING_LOSS,
    Ground,
)
from rockframe.dynamics.switching import (
    end_speed,
    lift_per_slip,
    rebounds_negligibly,
    stop_negligible_rebound,
)

# memory, behind the held places and the body of the last event
ADMISSIBLE: Final = 1  # number of admissible sets, or of slips, in the last event
TAKEN: Final = 2  # the set of corners that was taken
OTHER: Final = 3  # the next best set, or -1
KEPT: Final = ("admissible_sets", "set_taken", "other_set")
"""Names of these three."""


class RigidChain(RigidImpulses):
    """Stacked bodies, some of which stand on rigid bases: a system."""

    __slots__ = ()

    @inlined
    def begin_event(self, memory: Vector) -> None:
        """Reset the memory of the last event: by default one set of corners was admissible."""
        memory[HELD_PLACE + self.body_count] = 0.0
        memory[HELD_PLACE + self.body_count + ADMISSIBLE] = 1.0

    @inlined
    def behind_events(self) -> int:
        """Return the index in the memory behind the numbers of the last event."""
        return HELD_PLACE + self.body_count + 1 + len(KEPT)

    @inlined
    def switch_body(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out the switch that a guard of a body calls for; return the new mode."""
        self.begin_event(memory)
        return self.switch_contacts(mode, guard, state, ground, memory)

    @kernel
    def switch_contacts(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Let a corner lift off or land, or a body change its contact with a deformable base."""
        k, count = guard // GUARDS, self.body_count
        contact, which = self.body_mode(mode, k).contact, guard - k * GUARDS
        left = which < CORNER_GUARDS
        pulls = contact & PULLED != 0 and self.on_base(k).base.is_held(contact, left)
        if self.is_rigid(k) and pulls:
            self.write_contacts(mode, state, memory)
            opens = which % CORNER_GUARDS == OPENING
            corners = self.bearing(mode) & ~(BOTH << 2 * k) if opens else self.bearing(mode)
            new = self.with_bearing(mode, corners, self.pulled(mode) & ~(BOTH << 2 * k))
            self.keep_hold(new, state, memory)
            memory[LAST_EVENT] = SEPARATION if opens else SILENT
        elif self.is_rigid(k):
            new = self.switch_corner(k, left, mode, state, ground, memory)
        else:
            pinned, closed = memory[REPINNING_LOSS], self.closed_corners(mode, state)
            self.scale_impulses(0.0)
            if which in (REENGAGE, CORNER_GUARDS + REENGAGE):
                new = self.catch_up(mode, guard, state, ground, memory)
            else:
                new = self.switch_on_base(mode, guard, state, ground, memory)
            # the rule of restraint may change a held point without an impact: contacts stay
            if memory[LAST_EVENT] != IMPACT or not self.must_meet_anew(closed, new):
                return new
            ends = self.landed(k, left, mode, new)
            new = self.meet_anew(k, ends, closed, new, state, ground, memory)
            stop_negligible_rebound(self, self.on_base(k), k, left, new, state, ground, memory)
            # the impulse of the hold is a part of the blow then, and has been scaled with it
            memory[IMPACT_LOSS] += memory[REPINNING_LOSS] - pinned
            memory[REPINNING_LOSS] = pinned
        struck = memory[LAST_EVENT] in (IMPACT, REST)
        for other in range(count):
            if struck or not self.waits_on(other, new, state, ground):
                new = self.disturb(other, new, state)
        memory[HELD_PLACE + count] = k + 1.0
        return new

    @kernel
    def switch_corner(
        self, k: int, left: bool, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Let a corner lift off from a rigid base, or land on it; return the new mode."""
        part, standing = self.on_base(k), self.body_mode(mode, k)
        bore = part.base.is_held(standing.contact, left)
        self.write_contacts(mode, state, memory)
        before, landed = self.bearing(mode), 0
        if not bore:  # a corner past its base is moved back onto it, with its body
            landed = self.land(k, left, standing, state)
        closed = before | landed | self.resting_corners(mode, state)
        if bore:
            leaving = (LEFT_ONLY if left else RIGHT_ONLY) << 2 * k
            new = self.choose_bearing_corners(mode, closed, before, leaving, state, ground, memory)
            if self.bearing(new) == before & ~leaving and self.bears_alone(before, leaving):
                new = self.hold_if_jammed(k, left, mode, new, state, ground, memory)
            flies = part.flies(self.body_mode(new, k).contact)
            both = part.contact_state(standing) == FULL
            memory[LAST_EVENT] = UPLIFT if both and not flies else SEPARATION
            if self.pulled(new) & leaving != 0:
                memory[LAST_EVENT] = SILENT
            return new
        memory[LAST_EVENT] = IMPACT
        new = self.choose_bearing_corners(mode, closed, before, 0, state, ground, memory)
        new = self.hold_where_small(closed, new, state, ground, memory)
        return self.rest_where_small(new, state, ground, memory)

    @kernel
    def catch_up(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Let a pad that rises behind an end touch it again; return the new mode.

        After an impact elsewhere has slowed the end down, its pad presses it, but with a falling
        force. If holding the end would not last, and its impulse would throw a corner down that is
        at its rigid base, the end is not held: it is marked as one that lifts off while pressed.
        """
        k, left = guard // GUARDS, guard % GUARDS < CORNER_GUARDS
        part, was = self.on_base(k), self.body_mode(mode, k)
        waits = part.base.waiting(was.contact, left)
        holds = part.flies(was.contact) or waits == was.contact
        if holds or not self.presses_less(k, left, mode, state, ground):
            new = self.part_where_pulled(k, left, mode, state, ground, memory)
            return self.switch_on_base(new, guard, state, ground, memory)
        before = self.velocities(state)
        lost, place = memory[REPINNING_LOSS], memory[HELD_PLACE + k]
        new = self.switch_on_base(mode, guard, state, ground, memory)
        contact = self.body_mode(new, k).contact
        if contact != part.base.unpressed(contact, left) or not self.throws_down(new, state):
            return new
        self.blend_velocities(before, 0.0, state)
        memory[REPINNING_LOSS], memory[HELD_PLACE + k] = lost, place
        memory[LAST_EVENT] = SILENT
        return self.with_body_mode(mode, k, Mode(waits, was.pivot, was.slides))

    @kernel
    def part_where_pulled(
        self, k: int, left: bool, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Release corners that would be in tension if an end, reached by its pad, slid on it.

        Corners that bear react to the impulse of the hold as if they could pull. They are released
        if without them this impulse presses the end on its pad instead of lifting it.
        """
        part, was, body = self.on_base(k), self.body_mode(mode, k), self.state_of(k, state)
        if not part.flies(was.contact):
            return mode
        now = part.mode_for_contact(part.base.held(was.contact, left), body)
        now = Mode(now.contact, now.pivot, True)
        self.find_forces(self.with_body_mode(mode, k, now), state, ground)
        corners = self.bearing(mode)
        for corner in range(2 * self.body_count):
            least = NEARLY_ZERO * self.number(corner // 2, at.FORCE_SIZE)
            if self.corner_force(corner // 2, corner % 2 == 0) < -least:
                corners &= ~(1 << corner)
        if corners == self.bearing(mode):
            return mode
        parted = self.with_bearing(mode, corners, self.pulled(mode) & corners)
        reach = part.body.reach(part.body.pin(now.pivot), part.body.attitude(body.rotation))
        slip = body.horizontal_velocity - reach.derivative * body.angular_velocity
        if slip * lift_per_slip(self, part, k, self.with_body_mode(parted, k, now), state) <= 0.0:
            return mode
        self.write_contacts(mode, state, memory)
        self.hold_contacts(parted, state, memory)
        return parted

    @kernel
    def hold_where_small(
        self, closed: int, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Hold corners that were closed in an impact and whose rebound is negligible."""
        for corner in range(2 * self.body_count):
            if closed >> corner & 1 != 0:
                left = corner % 2 == 0
                mode = self.hold_if_small(corner // 2, left, mode, state, ground, memory)
        return mode

    @kernel
    def hold_if_small(
        self, k: int, left: bool, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Hold a corner of a body in flight if its rebound is negligible; return the mode."""
        part, corner = self.on_base(k), (LEFT_ONLY if left else RIGHT_ONLY) << 2 * k
        if not part.flies(self.body_mode(mode, k).contact):
            return mode
        speed, _ = end_speed(part, left, self.state_of(k, state))
        if not rebounds_negligibly(self, part, k, left, speed, mode, state, ground):
            return mode
        closed, pulled = self.bearing(mode) | corner, self.pulled(mode)
        held = self.let_stand(closed, pulled, mode, state, memory)
        self.find_forces(held, state, ground)
        if self.corner_force(k, left) < 0.0:
            held = self.with_bearing(mode, closed, pulled | corner)
        return held

    @kernel
    def hold_if_jammed(
        self, k: int, left: bool, mode: int, new: int, state: Vector, ground: Ground,
        memory: Vector,
    ) -> int:  # fmt: skip
        """Hold a corner that, held, was in tension and that, released, falls: neither is possible.

        Or of which the other corner of its body falls, practically at its base. Such a jam comes
        from the constraints that hold bodies along their bases.
        """
        rises, falls = self.end_accelerations(k, new, state, ground), False
        for side in range(2):
            fall = -rises[side]
            if left == (side == 0) or self.is_near(k, side == 0, fall, new, state):
                falls |= fall > ROUNDING * self.number(k, at.GRAVITY)
        if not falls:
            return new
        self.forget_slips(mode, False)  # slipping bodies continue to slip
        corners, pulled = self.bearing(mode), self.pulled(new)
        held = self.with_bearing(new, corners, pulled | corners & ~self.bearing(new))
        self.write_contacts(new, state, memory)
        self.hold_contacts(held, state, memory)
        self.find_forces(held, state, ground)
        if self.corner_force(k, left) < 0.0:
            return held
        self.write_contacts(held, state, memory)
        self.hold_contacts(new, state, memory)
        return new

    @kernel
    def let_stand(self, corners: int, pulled: int, mode: int, state: Vector, memory: Vector) -> int:
        """Let bodies stand on corners, by impulses that may be tension; return the new mode."""
        self.write_contacts(mode, state, memory)
        flying = self.with_bearing(mode, 0, 0)
        had = self.energies(flying, state).kinetic  # places the bodies, too
        load_bodies(self, 0.0, 0.0, self.places())
        write_corners(self, True, state)
        self.try_standing(flying, corners, state)
        self.change_velocities(state)
        new = self.with_bearing(mode, corners, pulled)
        self.hold_contacts(new, state, memory)
        memory[IMPACT_LOSS] += had - self.energies(new, state).kinetic
        return new

    @kernel
    def meet_anew(
        self, k: int, ends: int, closed: int, mode: int, state: Vector, ground: Ground,
        memory: Vector,
    ) -> int:  # fmt: skip
        """Undo impulses of rigid bases in an event elsewhere; find new ones, in compression only.

        They act at the corners `closed`. The blow at the ends of body `k` that have landed is
        scaled, so that it does not throw them up.
        """
        free = self.let_all_go(mode, state, memory)
        self.write_contacts(free, state, memory)
        had, flying = self.energies(free, state).kinetic, self.with_bearing(free, 0, 0)
        self.take_back(k, self.shares_of_blow(k, ends, flying, closed, state), flying, state)
        memory[IMPACT_LOSS] += had - self.energies(flying, state).kinetic
        event = memory[LAST_EVENT]
        new = self.choose_bearing_corners(free, closed, closed, 0, state, ground, memory)
        new = self.hold_where_small(closed, new, state, ground, memory)
        new = self.rest_where_small(new, state, ground, memory)
        memory[LAST_EVENT] = event
        return new

    @kernel
    def choose_bearing_corners(
        self, mode: int, closed: int, before: int, leaving: int, state: Vector, ground: Ground,
        memory: Vector,
    ) -> int:  # fmt: skip
        """Find which of the closed corners bear, and let these bear; return the new mode.

        After an impact if `leaving` is 0, else under new forces as that corner lifts off.
        """
        free = self.let_all_go(mode, state, memory) if leaving == 0 else mode
        flying, kept = self.with_bearing(free, 0, 0), HELD_PLACE + self.body_count
        had = self.energies(flying, state).kinetic  # places the bodies, too
        if leaving == 0:
            load_bodies(self, 0.0, 0.0, self.places())
        else:
            self.find_forces(flying, state, ground)
        pulled = 0 if leaving == 0 else self.pulled(mode)
        found = bearing_corners(self, flying, closed & ~pulled, pulled, before, leaving, state)
        taken, pulled = found.taken, pulled | found.held
        if found.admissible == 0 and found.held == 0:
            self.forget_slips(mode, leaving == 0)
            if leaving != 0 and self.bears_alone(before, leaving):
                taken, pulled = before, pulled | leaving
        if leaving == 0:
            self.change_velocities(state)
        new = self.with_bearing(free, taken, pulled)
        self.hold_contacts(new, state, memory)
        self.note_free_slips(new, state)
        new = self.go_on(new, state, memory) if leaving == 0 else self.as_tried(new, state, memory)
        memory[IMPACT_LOSS] += had - self.energies(new, state).kinetic
        memory[kept + ADMISSIBLE] = found.admissible
        memory[kept + TAKEN], memory[kept + OTHER] = taken, found.other
        return new

    @inlined
    def rest_where_small(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Let bodies come to rest, repeatedly: one at rest may let another come to rest."""
        new = mode
        for _ in range(self.body_count):
            new = self.rest_if_small(new, state, ground, memory)
        return new

    @kernel
    def rest_if_small(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Let bodies whose rebound is negligible come to rest, together or one by one."""
        n, corners, small, count = self.coordinates(), self.bearing(mode), 0, 0
        slope = self.find_forces(mode, state, ground)
        for k in range(self.body_count):
            first, bears = BEFORE_HORIZONTAL * k, corners >> 2 * k & BOTH
            if bears in (LEFT_ONLY, RIGHT_ONLY):
                side, rate = -1.0 if bears == LEFT_ONLY else 1.0, state[n + first + ROTATION]
                restoring = -side * slope[first + ROTATION]
                least = REST_AMPLITUDE * self.on_base(k).body.angle - abs(state[first + ROTATION])
                if restoring > 0.0 and rate * rate < 2.0 * restoring * least:
                    small |= BOTH << 2 * k
                    count += 1
        new = mode
        if count > 1:
            new = self.rest(small, mode, state, ground, memory)
        if new == mode:
            for k in range(self.body_count):
                if small >> 2 * k & BOTH != 0:
                    new = self.rest(BOTH << 2 * k, new, state, ground, memory)
        return new

    @kernel
    def rest(self, corners: int, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Let bodies stand on both corners if these are in compression; else give `mode`."""
        before, lost = self.velocities(state), memory[IMPACT_LOSS]
        all_of_them = self.bearing(mode) | corners
        resting = self.let_stand(all_of_them, 0, mode, state, memory)
        self.find_forces(resting, state, ground)
        least = 0.0
        for k in range(self.body_count):
            if corners >> 2 * k & BOTH != 0:
                least = min(least, self.corner_force(k, True), self.corner_force(k, False))
        if least >= 0.0:
            memory[LAST_EVENT] = REST
            return resting
        self.write_contacts(resting, state, memory)
        self.blend_velocities(before, 0.0, state)
        self.hold_contacts(mode, state, memory)
        memory[IMPACT_LOSS] = lost
        return mode
