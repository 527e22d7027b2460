"""A chain in which some bodies stand on rigid bases, beside others on pads and beds.

Corners lift off as their force falls to zero, and close by impacts, :eq:`eq-projection`.
"""

from typing import Final

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, ROTATION
from rockframe.dynamics.body import REST_AMPLITUDE
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.corner_guards import RELEASE_GUARD
from rockframe.dynamics.chain.corners import IN_TENSION
from rockframe.dynamics.chain.impact import (
    BOTH,
    LEFT_ONLY,
    NEARLY_ZERO,
    RIGHT_ONLY,
    ROUNDING,
    find_bearing_corners,
    write_trial_data,
)
from rockframe.dynamics.chain.impulses import RigidImpulses
from rockframe.dynamics.chain.motion import set_inertia_loads
from rockframe.dynamics.chain.rows import GUARDS
from rockframe.dynamics.events import FULL, IMPACT, REST, SEPARATION, SILENT, UPLIFT
from rockframe.dynamics.on_base import Mode
from rockframe.dynamics.pads import CORNER_GUARDS, ENGAGING, LEAVING, REENGAGE, TOUCHING
from rockframe.dynamics.protocol import HELD_PLACE, IMPACT_LOSS, LAST_EVENT, REPINNING_LOSS, Ground
from rockframe.dynamics.switching import (
    end_speed,
    lift_per_slip,
    rebounds_negligibly,
    stop_negligible_rebound,
)

# memory, behind the held places and the body of the last event
ADMISSIBLE_COUNT: Final = 1  # number of admissible sets, or of slips, in the last event
CHOSEN_CORNERS: Final = 2  # the set of corners that was chosen
NEXT_BEST_CORNERS: Final = 3  # the next best set, or -1
SET_MEMORY: Final = ("admissible_sets", "set_taken", "other_set")
"""Names of these three."""


class RigidChain(RigidImpulses):
    """Stacked bodies, some of which stand on rigid bases: a system."""

    __slots__ = ()

    @inlined
    def reset_event(self, memory: Vector) -> None:
        """Reset the memory of the last event: by default one set of corners was admissible."""
        memory[HELD_PLACE + self.body_count] = 0.0
        memory[HELD_PLACE + self.body_count + ADMISSIBLE_COUNT] = 1.0

    @inlined
    def event_memory_end(self) -> int:
        """Return the index in the memory behind the numbers of the last event."""
        return HELD_PLACE + self.body_count + 1 + len(SET_MEMORY)

    @inlined
    def switch_body(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out the switch that a guard of a body calls for; return the new mode."""
        self.reset_event(memory)
        return self.switch_contacts(mode, guard, state, ground, memory)

    @kernel
    def switch_contacts(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out a change of contact, at a corner on a rigid base or on a deformable base."""
        k, count = guard // GUARDS, self.body_count
        contact, which = self.body_mode(mode, k).contact, guard - k * GUARDS
        left = which < CORNER_GUARDS
        pulls = contact & IN_TENSION != 0 and self.on_base(k).base.is_held(contact, left)
        if self.is_rigid(k) and pulls:
            self.project_onto_contacts(mode, state, memory)
            opens = which % CORNER_GUARDS == RELEASE_GUARD
            corners, others = self.bearing_corners(mode), ~(BOTH << 2 * k)
            corners = corners & others if opens else corners
            new = self.with_bearing_corners(mode, corners, self.tension_corners(mode) & others)
            self.store_held_place(new, state, memory)
            memory[LAST_EVENT] = SEPARATION if opens else SILENT
        elif self.is_rigid(k):
            new = self.switch_corner(k, left, mode, state, ground, memory)
        else:
            pinned, closed = memory[REPINNING_LOSS], self.closed_corners(mode, state)
            self.scale_impulses(0.0)
            if which in (REENGAGE, CORNER_GUARDS + REENGAGE):
                new = self.reengage_end(mode, guard, state, ground, memory)
            else:
                new = self.switch_on_base(mode, guard, state, ground, memory)
            # the rule of restraint may change a held point without an impact: contacts stay
            if memory[LAST_EVENT] != IMPACT or not self.needs_new_impulses(closed, new):
                return new
            new = self.find_new_impulses(k, left, closed, mode, new, state, ground, memory)
            # the impulse of the hold is a part of the landing impulse, and has been scaled with it
            memory[IMPACT_LOSS] += memory[REPINNING_LOSS] - pinned
            memory[REPINNING_LOSS] = pinned
        struck = memory[LAST_EVENT] in (IMPACT, REST)
        for other in range(count):
            if struck or not self.keeps_leaving_contact(other, new, state, ground):
                new = self.disturbed_mode(other, new, state)
        memory[HELD_PLACE + count] = k + 1.0
        return new

    @kernel
    def switch_corner(
        self, k: int, left: bool, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Let a corner lift off from a rigid base, or land on it; return the new mode."""
        part, body_mode = self.on_base(k), self.body_mode(mode, k)
        was_bearing = part.base.is_held(body_mode.contact, left)
        self.project_onto_contacts(mode, state, memory)
        before, landed = self.bearing_corners(mode), 0
        if not was_bearing:  # a corner past its base is moved back onto it, with its body
            landed = self.move_onto_base(k, left, body_mode, state)
        closed = before | landed | self.resting_corners(mode, state)
        if was_bearing:
            leaving = (LEFT_ONLY if left else RIGHT_ONLY) << 2 * k
            new = self.choose_bearing_corners(mode, closed, before, leaving, state, ground, memory)
            if self.bearing_corners(new) == before & ~leaving and self.bears_alone(before, leaving):
                new = self.hold_jammed_corner(k, left, mode, new, state, ground, memory)
            flies = part.flies(self.body_mode(new, k).contact)
            both = part.contact_state(body_mode) == FULL
            memory[LAST_EVENT] = UPLIFT if both and not flies else SEPARATION
            if self.tension_corners(new) & leaving != 0:
                memory[LAST_EVENT] = SILENT
            return new
        memory[LAST_EVENT] = IMPACT
        new = self.choose_bearing_corners(mode, closed, before, 0, state, ground, memory)
        new = self.hold_small_rebounds(closed, new, state, ground, memory)
        return self.rest_repeatedly(new, state, ground, memory)

    @kernel
    def reengage_end(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Bring an end into contact again with a pad that has followed it; return the new mode.

        After an impact elsewhere has slowed the end down, its pad presses it, but with a falling
        force. If holding the end would not last, and its impulse would drive another corner into
        its rigid base, the end is not held: it is marked as one that lifts off while pressed.
        """
        k, left = guard // GUARDS, guard % GUARDS < CORNER_GUARDS
        part, was = self.on_base(k), self.body_mode(mode, k)
        waits = part.base.with_end(was.contact, left, LEAVING)
        holds = part.flies(was.contact) or waits == was.contact
        if holds or not self.has_falling_force(k, left, mode, state, ground):
            new = self.release_tension_corners(k, left, mode, state, ground, memory)
            return self.switch_on_base(new, guard, state, ground, memory)
        before = self.velocities(state)
        lost, place = memory[REPINNING_LOSS], memory[HELD_PLACE + k]
        new = self.switch_on_base(mode, guard, state, ground, memory)
        contact = self.body_mode(new, k).contact
        stays = contact == part.base.with_end(contact, left, ENGAGING)
        if not stays or not self.has_sinking_corner(new, state):
            return new
        self.blend_velocities(before, 0.0, state)
        memory[REPINNING_LOSS], memory[HELD_PLACE + k] = lost, place
        memory[LAST_EVENT] = SILENT
        return self.with_body_mode(mode, k, Mode(waits, was.pivot, was.slides))

    @kernel
    def release_tension_corners(
        self, k: int, left: bool, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Release corners that would be in tension if an end, reached by its pad, slid on it.

        The solution lets corners that bear react to the impulse of the hold in tension. They are
        released if without them this impulse presses the end on its pad instead of lifting it.
        """
        part, was, body = self.on_base(k), self.body_mode(mode, k), self.state_of(k, state)
        if not part.flies(was.contact):
            return mode
        sliding = part.mode_for_contact(part.base.with_end(was.contact, left, TOUCHING), body)
        sliding = Mode(sliding.contact, sliding.pivot, True)
        self.find_forces(self.with_body_mode(mode, k, sliding), state, ground)
        corners = self.bearing_corners(mode)
        for corner in range(2 * self.body_count):
            least = NEARLY_ZERO * self.row_value(corner // 2, at.FORCE_SCALE)
            if self.corner_force(corner // 2, corner % 2 == 0) < -least:
                corners &= ~(1 << corner)
        if corners == self.bearing_corners(mode):
            return mode
        parted = self.with_bearing_corners(mode, corners, self.tension_corners(mode) & corners)
        reach = part.body.reach_about(sliding.pivot, body.rotation)
        slip = body.horizontal_velocity - reach.derivative * body.angular_velocity
        if (
            slip * lift_per_slip(self, part, k, self.with_body_mode(parted, k, sliding), state)
            <= 0.0
        ):
            return mode
        self.project_onto_contacts(mode, state, memory)
        self.fix_held_points(parted, state, memory)
        return parted

    @kernel
    def hold_small_rebounds(
        self, closed: int, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Hold corners that were closed in an impact and whose rebound is negligible."""
        for corner in range(2 * self.body_count):
            if closed >> corner & 1 != 0:
                left = corner % 2 == 0
                mode = self.hold_small_rebound(corner // 2, left, mode, state, ground, memory)
        return mode

    @kernel
    def hold_small_rebound(
        self, k: int, left: bool, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Hold a corner of a body in flight if its rebound is negligible; return the mode."""
        part, corner = self.on_base(k), (LEFT_ONLY if left else RIGHT_ONLY) << 2 * k
        if not part.flies(self.body_mode(mode, k).contact):
            return mode
        speed, _ = end_speed(part, left, self.state_of(k, state))
        if not rebounds_negligibly(self, part, k, left, speed, mode, state, ground):
            return mode
        closed, in_tension = self.bearing_corners(mode) | corner, self.tension_corners(mode)
        held = self.stand_on_corners(closed, in_tension, mode, state, memory)
        self.find_forces(held, state, ground)
        if self.corner_force(k, left) < 0.0:
            held = self.with_bearing_corners(mode, closed, in_tension | corner)
        return held

    @kernel
    def hold_jammed_corner(
        self, k: int, left: bool, mode: int, new: int, state: Vector, ground: Ground,
        memory: Vector,
    ) -> int:  # fmt: skip
        """Hold a corner that is in tension if it is held and falls if it is released.

        Or one whose body has another corner that is practically at its base and falls. The
        constraints that hold bodies along their bases cause such a jam.
        """
        rises, falls = self.end_accelerations(k, new, state, ground), False
        for side in range(2):
            fall = -rises[side]
            if left == (side == 0) or self.is_closing(k, side == 0, fall, new, state):
                falls |= fall > ROUNDING * self.row_value(k, at.GRAVITY)
        if not falls:
            return new
        self.restore_trial_slips(mode, False)  # slipping bodies continue to slip
        corners, in_tension = self.bearing_corners(mode), self.tension_corners(new)
        in_tension |= corners & ~self.bearing_corners(new)
        held = self.with_bearing_corners(new, corners, in_tension)
        self.project_onto_contacts(new, state, memory)
        self.fix_held_points(held, state, memory)
        self.find_forces(held, state, ground)
        if self.corner_force(k, left) < 0.0:
            return held
        self.project_onto_contacts(held, state, memory)
        self.fix_held_points(new, state, memory)
        return new

    @kernel
    def stand_on_corners(
        self, corners: int, in_tension: int, mode: int, state: Vector, memory: Vector
    ) -> int:
        """Stop bodies on corners, by impulses that may be tension; return the new mode."""
        self.project_onto_contacts(mode, state, memory)
        flying = self.with_bearing_corners(mode, 0, 0)
        kinetic = self.energies(flying, state).kinetic  # places the bodies, too
        set_inertia_loads(self, 0.0, 0.0, self.workspace())
        write_trial_data(self, True, state)
        self.solve_standing(flying, corners, state)
        self.change_velocities(state)
        new = self.with_bearing_corners(mode, corners, in_tension)
        self.fix_held_points(new, state, memory)
        memory[IMPACT_LOSS] += kinetic - self.energies(new, state).kinetic
        return new

    @kernel
    def find_new_impulses(
        self, k: int, left: bool, closed: int, before: int, mode: int, state: Vector,
        ground: Ground, memory: Vector,
    ) -> int:  # fmt: skip
        """Undo impulses of rigid bases in an event elsewhere; find new ones, in compression only.

        They act at the corners `closed`. The impulse at the ends of body `k` that have landed is
        scaled, so that these do not rebound faster than restitution allows. `before` is the mode
        before the event.
        """
        part = self.on_base(k)
        both = part.flies(self.body_mode(before, k).contact)  # both ends may have landed together
        both &= part.base.is_held(self.body_mode(mode, k).contact, not left)
        ends = BOTH if both else LEFT_ONLY if left else RIGHT_ONLY
        free = self.release_all(mode, state, memory)
        self.project_onto_contacts(free, state, memory)
        kinetic, flying = self.energies(free, state).kinetic, self.with_bearing_corners(free, 0, 0)
        self.undo_impulses(k, self.landing_scales(k, ends, flying, closed, state), flying, state)
        memory[IMPACT_LOSS] += kinetic - self.energies(flying, state).kinetic
        event = memory[LAST_EVENT]
        new = self.choose_bearing_corners(free, closed, closed, 0, state, ground, memory)
        new = self.hold_small_rebounds(closed, new, state, ground, memory)
        new = self.rest_repeatedly(new, state, ground, memory)
        stop_negligible_rebound(self, part, k, left, new, state, ground, memory)
        memory[LAST_EVENT] = event
        return new

    @kernel
    def choose_bearing_corners(
        self, mode: int, closed: int, before: int, leaving: int, state: Vector, ground: Ground,
        memory: Vector,
    ) -> int:  # fmt: skip
        """Find which of the closed corners bear; return the mode in which they do.

        After an impact if `leaving` is 0, else under new forces as that corner lifts off.
        """
        free = self.release_all(mode, state, memory) if leaving == 0 else mode
        flying, sets = self.with_bearing_corners(free, 0, 0), HELD_PLACE + self.body_count
        kinetic = self.energies(flying, state).kinetic  # places the bodies, too
        if leaving == 0:
            set_inertia_loads(self, 0.0, 0.0, self.workspace())
        else:
            self.find_forces(flying, state, ground)
        in_tension = 0 if leaving == 0 else self.tension_corners(mode)
        corners = find_bearing_corners(
            self, flying, closed & ~in_tension, in_tension, before, leaving, state
        )
        chosen, in_tension = corners.chosen, in_tension | corners.held
        if corners.admissible == 0 and corners.held == 0:
            self.restore_trial_slips(mode, leaving == 0)
            if leaving != 0 and self.bears_alone(before, leaving):
                chosen, in_tension = before, in_tension | leaving
        if leaving == 0:
            self.change_velocities(state)
        new = self.with_bearing_corners(free, chosen, in_tension)
        self.fix_held_points(new, state, memory)
        self.write_free_slips(new, state)
        if leaving == 0:
            new = self.resume_slips(new, state, memory)
        else:
            new = self.with_deformable_slips(new, state, memory)
        memory[IMPACT_LOSS] += kinetic - self.energies(new, state).kinetic
        memory[sets + ADMISSIBLE_COUNT] = corners.admissible
        memory[sets + CHOSEN_CORNERS], memory[sets + NEXT_BEST_CORNERS] = chosen, corners.next_best
        return new

    @inlined
    def rest_repeatedly(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Bring bodies to rest, repeatedly: one at rest may allow another to come to rest."""
        new = mode
        for _ in range(self.body_count):
            new = self.rest_small_rebounds(new, state, ground, memory)
        return new

    @kernel
    def rest_small_rebounds(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Bring bodies whose rebound is negligible to rest, together or one by one."""
        n, corners, small, count = self.coordinates(), self.bearing_corners(mode), 0, 0
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
            new = self.rest_on_corners(small, mode, state, ground, memory)
        if new == mode:
            for k in range(self.body_count):
                if small >> 2 * k & BOTH != 0:
                    new = self.rest_on_corners(BOTH << 2 * k, new, state, ground, memory)
        return new

    @kernel
    def rest_on_corners(
        self, corners: int, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Bring bodies to rest on both corners if these are in compression; else return `mode`."""
        before, lost = self.velocities(state), memory[IMPACT_LOSS]
        all_of_them = self.bearing_corners(mode) | corners
        resting = self.stand_on_corners(all_of_them, 0, mode, state, memory)
        self.find_forces(resting, state, ground)
        least = 0.0
        for k in range(self.body_count):
            if corners >> 2 * k & BOTH != 0:
                least = min(least, self.corner_force(k, True), self.corner_force(k, False))
        if least >= 0.0:
            memory[LAST_EVENT] = REST
            return resting
        self.project_onto_contacts(resting, state, memory)
        self.blend_velocities(before, 0.0, state)
        self.fix_held_points(mode, state, memory)
        memory[IMPACT_LOSS] = lost
        return mode
