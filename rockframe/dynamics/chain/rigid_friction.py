"""A chain in which some bases have friction, and on others no body can slip.

Which corners bear and which bodies slip is found again when friction reaches its bound, when a slip
ends, and when a contact changes.
"""

import math
from typing import Final

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.body import with_accelerations
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.corners import IN_TENSION
from rockframe.dynamics.chain.impact import (
    JAMMED,
    ROUNDING,
    BearingCorners,
    find_bearing_corners,
)
from rockframe.dynamics.chain.motion import set_inertia_loads
from rockframe.dynamics.chain.rigid import ADMISSIBLE_COUNT, CHOSEN_CORNERS, NEXT_BEST_CORNERS
from rockframe.dynamics.chain.rows import BODY_STRIDE, GUARDS
from rockframe.dynamics.chain.slip_trials import SlipTrials
from rockframe.dynamics.chain.slips import OFFSET, STATIC
from rockframe.dynamics.events import IMPACT, REST, SILENT, STICK
from rockframe.dynamics.on_base import HOLD, SLIP, Mode
from rockframe.dynamics.pads import CORNER_GUARDS, LEAVING
from rockframe.dynamics.protocol import HELD_PLACE, IMPACT_LOSS, LAST_EVENT, Ground

FRICTION_CHANGED: Final = -1
"""In place of the leaving corner: only friction has changed."""


class SlippingRigidChain(SlipTrials):
    """Stacked bodies, some of which slip on their bases: a system."""

    __slots__ = ()

    @kernel
    def write_slip_guards(
        self, k: int, mode: int, state: Vector, values: Vector, changes: Vector
    ) -> None:
        """Write the guards of the friction that holds a body, and of its slip."""
        body_mode, i = self.body_mode(mode, k), GUARDS * k + 2 * CORNER_GUARDS
        size = self.row_value(k, at.FORCE_SCALE if self.is_rigid(k) else at.GRAVITY)
        held = self.friction_coefficient(k, STATIC) == math.inf and not body_mode.slides
        if self.on_base(k).flies(body_mode.contact) or held:
            return
        if not body_mode.slides and self.is_rigid(k) and body_mode.contact & IN_TENSION != 0:
            return
        guards = self.slip_guards(k, mode, state, self.slopes(), self.normal_force(k), size)
        values[i + HOLD], values[i + SLIP] = guards.hold, guards.slip
        changes[i + SLIP] = guards.slip_rate

    @kernel
    def switch_body(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out the switch that a guard of a body calls for; return the new mode."""
        k, work = guard // GUARDS, self.workspace()
        which = guard - k * GUARDS - 2 * CORNER_GUARDS
        self.reset_event(memory)
        self.store_slips(mode, state, memory)
        if which in (HOLD, SLIP) and (self.is_rigid(k) or self.is_slippery(k)):
            self.project_onto_contacts(mode, state, memory)
            if which == HOLD:
                self.find_forces(mode, state, ground)
                thrust = work[k * BODY_STRIDE + at.TANGENTIAL_FORCE]
                work[k * BODY_STRIDE + at.STARTING_SENSE] = -math.copysign(1.0, thrust)
            else:
                self.stop_slip(k, mode, state)
            new = self.find_contacts_and_slips(mode, state, ground, memory)
            memory[LAST_EVENT] = self.slip_event(k, mode, new)
            memory[HELD_PLACE + self.body_count] = k + 1.0
            if memory[LAST_EVENT] == STICK:  # once a body is held, rebounds may end
                new = self.rest_repeatedly(new, state, ground, memory)
                new = self.with_consistent_slips(new, state, ground, memory)
        elif self.is_slippery(k):
            new = self.switch_on_deformable_base(mode, guard, state, ground, memory)
        elif self.is_rigid(k):
            new = self.switch_contacts(mode, guard, state, ground, memory)
            if memory[LAST_EVENT] in (IMPACT, REST):
                new = self.stop_short_slips(mode, new, state, ground, memory)
            new = self.with_consistent_slips(new, state, ground, memory)
        else:  # a change of the held point may be an impact
            new = self.release_all(mode, state, memory)
            new = self.switch_contacts(new, guard, state, ground, memory)
            new = self.resume_slips(new, state, memory)
            new = self.with_consistent_slips(new, state, ground, memory)
        if memory[LAST_EVENT] not in (IMPACT, REST):
            new = self.mark_leaving_ends(new, state, ground)
        self.restore_slips(new, state, memory)
        return new

    @kernel
    def mark_leaving_ends(self, mode: int, state: Vector, ground: Ground) -> int:
        """Mark ends as lifted off while still pressed, if new forces would return them immediately.

        As an end lifts off the held point changes, and with it the slips and the corners that bear.
        """
        for k in range(self.body_count):
            part, body_mode = self.on_base(k), self.body_mode(mode, k)
            line, contact = part.body.base_line_at(self.state_of(k, state)), body_mode.contact
            waits = self.is_slippery(k) and not part.flies(contact)
            for side in range(2):
                left = side == 0
                if waits and part.base.presses(contact, left, line, ()):
                    rises = self.end_accelerations(k, mode, state, ground)
                    line = with_accelerations(line, rises[0], rises[1])
                    if part.base.will_press(left, line, ()):
                        contact = part.base.with_end(contact, left, LEAVING)
            mode = self.with_body_mode(mode, k, Mode(contact, body_mode.pivot, body_mode.slides))
        return mode

    @kernel
    def stop_short_slips(
        self, before: int, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Hold bodies again whose slip on deformable bases after an impact is negligible.

        After that, rebounds may end, too.
        """
        new = mode
        for k in range(self.body_count):
            if self.is_slippery(k) and not self.body_mode(before, k).slides:
                new = self.stop_short_slip(k, new, state, ground, memory)
        return new if new == mode else self.rest_repeatedly(new, state, ground, memory)

    @kernel
    def stop_short_slip(
        self, k: int, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Hold a body whose slip on its deformable base is negligible; add that slip."""
        was_at = state[self.horizontal_of(k)]
        new = self.end_short_slip(k, mode, state, ground, memory)
        if new != mode:
            memory[self.slip_memory(k) + OFFSET] += state[self.horizontal_of(k)] - was_at
            self.project_onto_contacts(new, state, memory)
        return new

    @kernel
    def switch_on_deformable_base(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out a contact switch of a body that may slip on a deformable base."""
        k = guard // GUARDS
        which, closed = guard - k * GUARDS, self.closed_corners(mode, state)
        self.scale_impulses(0.0)
        memory[HELD_PLACE + self.body_count] = k + 1.0
        new = self.switch_with_friction(k, which, mode, state, ground, memory)
        if which < 2 * CORNER_GUARDS and memory[LAST_EVENT] == SILENT:
            return new
        if memory[LAST_EVENT] == IMPACT:
            if self.needs_new_impulses(closed, new):
                left = which < CORNER_GUARDS
                new = self.find_new_impulses(k, left, closed, mode, new, state, ground, memory)
            for other in range(self.body_count):
                if not self.is_slippery(other):
                    new = self.disturbed_mode(other, new, state)
        new = self.resume_slips(new, state, memory)
        new = self.with_consistent_slips(new, state, ground, memory)
        if which < 2 * CORNER_GUARDS:
            left = which < CORNER_GUARDS
            if self.reverses_immediately(k, left, new, state, ground, memory):
                new = self.stop_short_slip(k, new, state, ground, memory)
                new = self.with_consistent_slips(new, state, ground, memory)
            new = self.with_intermediate_contact(k, left, new, state, ground, memory)
        return new

    @kernel
    def store_slips(self, mode: int, state: Vector, memory: Vector) -> None:
        """Store the slips of all bodies before an event, and note which of them slip."""
        self.update_peak_slips(mode, state, memory)
        self.restore_trial_slips(mode, False)
        for k in range(self.body_count):
            memory[self.slip_memory(k) + OFFSET] += self.contact_point(k, mode, state, memory)
            self.workspace()[k * BODY_STRIDE + at.STARTING_SENSE] = 0.0

    @inlined
    def restore_slips(self, mode: int, state: Vector, memory: Vector) -> None:
        """Continue the slips after an event from their stored values."""
        for k in range(self.body_count):
            memory[self.slip_memory(k) + OFFSET] -= self.contact_point(k, mode, state, memory)
        self.update_peak_slips(mode, state, memory)

    @kernel
    def with_consistent_slips(
        self, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Return the mode in which friction can hold the held bodies, and opposes other slips."""
        new, event = mode, memory[LAST_EVENT]
        for _ in range(self.body_count):
            self.find_forces(new, state, ground)
            violated = False
            for k in range(self.body_count):
                violated |= self.violates_friction(k, new, state)
                # with other corners it may be held
                self.workspace()[k * BODY_STRIDE + at.STARTING_SENSE] = 0.0
            if not violated:
                break
            new = self.find_contacts_and_slips(new, state, ground, memory)
            memory[LAST_EVENT] = event
        return new

    @kernel
    def violates_friction(self, k: int, mode: int, state: Vector) -> bool:
        """Whether friction cannot hold a held body, or acts in the sense of the slip."""
        part, body_mode = self.on_base(k), self.body_mode(mode, k)
        friction, work = self.friction_coefficient(k, STATIC), self.workspace()
        if part.flies(body_mode.contact) or friction == math.inf:
            return False
        if body_mode.slides:
            rate, noise = self.slip_rate(k, mode, state)
            return self.sense(mode, k) * rate < -noise
        if self.is_rigid(k) and body_mode.contact & IN_TENSION != 0:
            return False
        thrust = work[k * BODY_STRIDE + at.TANGENTIAL_FORCE]
        least = ROUNDING * self.row_value(k, at.FORCE_SCALE)
        if abs(thrust) <= friction * max(self.normal_force(k), 0.0) + least:
            return False
        work[k * BODY_STRIDE + at.STARTING_SENSE] = -math.copysign(1.0, thrust)
        return True

    @kernel
    def with_overcome_friction(self, mode: int, state: Vector, ground: Ground) -> int:
        """Return the mode in which bodies slip that friction cannot hold."""
        work = self.workspace()
        for _ in range(self.body_count):
            self.find_forces(mode, state, ground)
            for k in range(self.body_count):
                if not self.body_mode(mode, k).slides and self.violates_friction(k, mode, state):
                    if k == self.body_count - 1:
                        self.write_lowest_position(mode, state)
                    sense = float(work[k * BODY_STRIDE + at.STARTING_SENSE])
                    mode = self.with_slip_sense(mode, k, sense)
        return mode

    @kernel
    def find_contacts_and_slips(
        self, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Return the mode whose corners and slips agree with the forces, by trial of sets."""
        sets, before = HELD_PLACE + self.body_count, self.bearing_corners(mode)
        self.project_onto_contacts(mode, state, memory)  # of bodies that were held and may slip
        self.restore_trial_slips(mode, False)
        flying, in_tension = self.with_bearing_corners(mode, 0, 0), self.tension_corners(mode)
        closed, count, free = before | self.resting_corners(mode, state), 0, mode
        corners = BearingCorners(before, 0, -1, 0)
        for _ in range(self.body_count):
            self.find_forces(flying, state, ground)
            corners = find_bearing_corners(
                self, flying, closed & ~in_tension, in_tension, before, FRICTION_CHANGED, state
            )
            if corners.admissible > 0 or corners.held != 0:
                break
            free = self.release_all(free, state, memory)
            flying = self.with_bearing_corners(free, 0, 0)
            jammed = self.stop_jammed_slips(flying, closed, before, state, memory)
            if jammed.admissible == 0:
                break
            before, in_tension, count = jammed.chosen, 0, max(count, jammed.admissible)
            stopped = self.with_bearing_corners(flying, before, 0)
            closed = before | self.resting_corners(stopped, state)
        ways = corners.admissible
        if corners.admissible == 0 and corners.held == 0:
            self.restore_trial_slips(mode, False)
            self.find_forces(mode, state, ground)
            for k in range(self.body_count):
                self.violates_friction(k, mode, state)
                starts = self.workspace()[k * BODY_STRIDE + at.STARTING_SENSE]
                if starts != 0.0:
                    self.workspace()[k * BODY_STRIDE + at.SLIP_SENSE] = starts
        elif corners.held == 0:
            noise = ROUNDING * self.row_value(0, at.GRAVITY)
            ways += self.count_other_solutions(
                flying, corners.chosen, closed & ~in_tension, noise, state
            )
        new = self.with_bearing_corners(free, corners.chosen, in_tension | corners.held)
        self.fix_held_points(new, state, memory)
        new = self.with_deformable_slips(new, state, memory)
        # where several sets of impulses are admissible, motion is not unique either
        memory[sets + ADMISSIBLE_COUNT] = max(ways, count if corners.admissible > 0 else 0)
        memory[sets + CHOSEN_CORNERS] = corners.chosen
        memory[sets + NEXT_BEST_CORNERS] = corners.next_best
        return new

    @kernel
    def stop_jammed_slips(
        self, flying: int, closed: int, before: int, state: Vector, memory: Vector
    ) -> BearingCorners:
        """Stop slips by impulses, as no finite forces solve the equations, :eq:`eq-stack-jam`.

        Returns the corners that bear. If no set is admissible, nothing is changed.
        """
        kinetic = self.energies(flying, state).kinetic  # places the bodies, too
        set_inertia_loads(self, 0.0, 0.0, self.workspace())
        corners = find_bearing_corners(self, flying, closed, 0, before, JAMMED, state)
        if corners.admissible == 0:
            return corners
        self.change_velocities(state)
        stopped = self.with_bearing_corners(flying, corners.chosen, 0)
        self.fix_held_points(stopped, state, memory)
        memory[IMPACT_LOSS] += kinetic - self.energies(stopped, state).kinetic
        self.project_onto_contacts(stopped, state, memory)
        for k in range(self.body_count):
            self.workspace()[k * BODY_STRIDE + at.STARTING_SENSE] = 0.0
        return corners
