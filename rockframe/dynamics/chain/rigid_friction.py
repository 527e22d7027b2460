"""A chain in which some bases have friction, and on others no body can slip.

Which corners bear and which bodies slip is found again when friction reaches its bound, when a slip
ends, and when a contact changes.
"""

import math
from typing import Final

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.body import with_accelerations
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.corners import PULLED
from rockframe.dynamics.chain.impact import JAMMED, Found, bearing_corners
from rockframe.dynamics.chain.motion import load_bodies
from rockframe.dynamics.chain.rigid import ADMISSIBLE, OTHER, TAKEN
from rockframe.dynamics.chain.rows import GUARDS, PLACES
from rockframe.dynamics.chain.slips import OFFSET, ROUNDING, STATIC
from rockframe.dynamics.chain.tried_slips import TriedSlips
from rockframe.dynamics.events import IMPACT, REST, SILENT, STICK
from rockframe.dynamics.on_base import HOLD, SLIP, Mode
from rockframe.dynamics.pads import CORNER_GUARDS
from rockframe.dynamics.protocol import HELD_PLACE, IMPACT_LOSS, LAST_EVENT, Ground
from rockframe.dynamics.switching import stop_negligible_rebound

FRICTION_ALONE: Final = -1
"""In place of the corner that leaves: only friction has changed."""


class SlippingRigidChain(TriedSlips):
    """Stacked bodies, some of which slip on their bases: a system."""

    __slots__ = ()

    @kernel
    def write_slip_guards(
        self, k: int, mode: int, state: Vector, values: Vector, changes: Vector
    ) -> None:
        """Write the guards of the friction that holds a body, and of its slip."""
        standing, i = self.body_mode(mode, k), GUARDS * k + 2 * CORNER_GUARDS
        size = self.number(k, at.FORCE_SIZE if self.is_rigid(k) else at.GRAVITY)
        held = self.friction_of(k, STATIC) == math.inf and not standing.slides
        if self.on_base(k).flies(standing.contact) or held:
            return
        if not standing.slides and self.is_rigid(k) and standing.contact & PULLED != 0:
            return
        found = self.guards_of_slip(k, mode, state, self.slopes(), self.pressed(k), size)
        values[i + HOLD], values[i + SLIP] = found.hold, found.slip
        changes[i + SLIP] = found.slip_rate

    @kernel
    def switch_body(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out the switch that a guard of a body calls for; return the new mode."""
        k, room = guard // GUARDS, self.places()
        which = guard - k * GUARDS - 2 * CORNER_GUARDS
        self.begin_event(memory)
        self.begin_slips(mode, state, memory)
        if which in (HOLD, SLIP) and (self.is_rigid(k) or self.is_slippery(k)):
            self.write_contacts(mode, state, memory)
            if which == HOLD:
                self.find_forces(mode, state, ground)
                thrust = room[k * PLACES + at.THRUST]
                room[k * PLACES + at.STARTS] = -math.copysign(1.0, thrust)
            else:
                self.end_slip(k, mode, state)
            new = self.rearrange(mode, state, ground, memory)
            memory[LAST_EVENT] = self.kind_of(k, mode, new)
            memory[HELD_PLACE + self.body_count] = k + 1.0
            if memory[LAST_EVENT] == STICK:  # once a body is held bounces may end
                new = self.rest_where_small(new, state, ground, memory)
                new = self.hold_as_far(new, state, ground, memory)
        elif self.is_slippery(k):
            new = self.switch_on_deformable_base(mode, guard, state, ground, memory)
        elif self.is_rigid(k):
            new = self.switch_contacts(mode, guard, state, ground, memory)
            if memory[LAST_EVENT] in (IMPACT, REST):
                new = self.stop_creep(mode, new, state, ground, memory)
            new = self.hold_as_far(new, state, ground, memory)
        else:  # a change of the held point may be an impact
            new = self.let_all_go(mode, state, memory)
            new = self.switch_contacts(new, guard, state, ground, memory)
            new = self.go_on(new, state, memory)
            new = self.hold_as_far(new, state, ground, memory)
        if memory[LAST_EVENT] not in (IMPACT, REST):
            new = self.let_wait(new, state, ground)
        self.end_slips(new, state, memory)
        return new

    @kernel
    def let_wait(self, mode: int, state: Vector, ground: Ground) -> int:
        """Mark ends as lifted off while still pressed, if new forces would return them immediately.

        As an end lifts off the held point changes, and with it the slips and the corners that bear.
        """
        for k in range(self.body_count):
            part, now = self.on_base(k), self.body_mode(mode, k)
            line, contact = part.body.base_line_at(self.state_of(k, state)), now.contact
            waits = self.is_slippery(k) and not part.flies(contact)
            for side in range(2):
                left = side == 0
                if waits and part.base.presses(contact, left, line, ()):
                    rises = self.end_accelerations(k, mode, state, ground)
                    line = with_accelerations(line, rises[0], rises[1])
                    if part.base.will_press(left, line, ()):
                        contact = part.base.waiting(contact, left)
            mode = self.with_body_mode(mode, k, Mode(contact, now.pivot, now.slides))
        return mode

    @kernel
    def stop_creep(
        self, before: int, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Hold bodies again whose slip on deformable bases after an impact is negligible.

        Then bounces may end, too.
        """
        new = mode
        for k in range(self.body_count):
            if self.is_slippery(k) and not self.body_mode(before, k).slides:
                new = self.stop_short_slip(k, new, state, ground, memory)
        return new if new == mode else self.rest_where_small(new, state, ground, memory)

    @kernel
    def stop_short_slip(
        self, k: int, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Hold a body whose slip on its deformable base is negligible; add that slip."""
        was_at = state[self.horizontal_of(k)]
        new = self.end_short_slip(k, mode, state, ground, memory)
        if new != mode:
            memory[self.kept(k) + OFFSET] += state[self.horizontal_of(k)] - was_at
            self.write_contacts(new, state, memory)
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
        new = self.switch_slippery(k, which, mode, state, ground, memory)
        if which < 2 * CORNER_GUARDS and memory[LAST_EVENT] == SILENT:
            return new
        if memory[LAST_EVENT] == IMPACT:
            if self.must_meet_anew(closed, new):
                part, left = self.on_base(k), which < CORNER_GUARDS
                ends = self.landed(k, left, mode, new)
                new = self.meet_anew(k, ends, closed, new, state, ground, memory)
                stop_negligible_rebound(self, part, k, left, new, state, ground, memory)
            for other in range(self.body_count):
                if not self.is_slippery(other):
                    new = self.disturb(other, new, state)
        new = self.go_on(new, state, memory)
        new = self.hold_as_far(new, state, ground, memory)
        if which < 2 * CORNER_GUARDS:
            left = which < CORNER_GUARDS
            if self.reverses_at_once(k, left, new, state, ground, memory):
                new = self.stop_short_slip(k, new, state, ground, memory)
                new = self.hold_as_far(new, state, ground, memory)
            new = self.wait(k, left, new, state, ground, memory)
        return new

    @kernel
    def begin_slips(self, mode: int, state: Vector, memory: Vector) -> None:
        """Store the slips of all bodies before an event, and note which of them slip."""
        self.keep_peaks(mode, state, memory)
        self.note_slips(mode)
        for k in range(self.body_count):
            memory[self.kept(k) + OFFSET] += self.point_of(k, mode, state, memory)
            self.places()[k * PLACES + at.STARTS] = 0.0

    @inlined
    def end_slips(self, mode: int, state: Vector, memory: Vector) -> None:
        """Continue the slips after an event from their stored values, maybe of new points."""
        for k in range(self.body_count):
            memory[self.kept(k) + OFFSET] -= self.point_of(k, mode, state, memory)
        self.keep_peaks(mode, state, memory)

    @kernel
    def hold_as_far(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Return the mode in which friction can hold the held bodies, and opposes other slips."""
        new, event = mode, memory[LAST_EVENT]
        for _ in range(self.body_count):
            self.find_forces(new, state, ground)
            amiss = False
            for k in range(self.body_count):
                amiss |= self.is_amiss(k, new, state)
                self.places()[k * PLACES + at.STARTS] = 0.0  # with other corners it may be held
            if not amiss:
                break
            new = self.rearrange(new, state, ground, memory)
            memory[LAST_EVENT] = event
        return new

    @kernel
    def is_amiss(self, k: int, mode: int, state: Vector) -> bool:
        """Whether friction cannot hold a body that is held, or acts along the slip."""
        part, standing = self.on_base(k), self.body_mode(mode, k)
        friction, room = self.friction_of(k, STATIC), self.places()
        if part.flies(standing.contact) or friction == math.inf:
            return False
        if standing.slides:
            rate, noise = self.slip_rate(k, mode, state)
            return self.sense(mode, k) * rate < -noise
        if self.is_rigid(k) and standing.contact & PULLED != 0:
            return False
        thrust, least = room[k * PLACES + at.THRUST], ROUNDING * self.number(k, at.FORCE_SIZE)
        if abs(thrust) <= friction * max(self.pressed(k), 0.0) + least:
            return False
        room[k * PLACES + at.STARTS] = -math.copysign(1.0, thrust)
        return True

    @kernel
    def let_slip_if_amiss(self, mode: int, state: Vector, ground: Ground) -> int:
        """Return the mode in which bodies slip that friction cannot hold."""
        room = self.places()
        for _ in range(self.body_count):
            self.find_forces(mode, state, ground)
            for k in range(self.body_count):
                if not self.body_mode(mode, k).slides and self.is_amiss(k, mode, state):
                    if k == self.body_count - 1:
                        self.free_lowest(mode, state)
                    mode = self.slipping(mode, k, float(room[k * PLACES + at.STARTS]))
        return mode

    @kernel
    def rearrange(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Return the mode whose corners and slips agree with the forces, found by trial of sets."""
        kept, before = HELD_PLACE + self.body_count, self.bearing(mode)
        self.write_contacts(mode, state, memory)  # of bodies that were held and may slip
        self.note_slips(mode)
        flying, pulled = self.with_bearing(mode, 0, 0), self.pulled(mode)
        closed, count, free = before | self.resting_corners(mode, state), 0, mode
        found = Found(before, 0, -1, 0)
        for _ in range(self.body_count):
            self.find_forces(flying, state, ground)
            found = bearing_corners(
                self, flying, closed & ~pulled, pulled, before, FRICTION_ALONE, state
            )
            if found.admissible > 0 or found.held != 0:
                break
            free = self.let_all_go(free, state, memory)
            flying = self.with_bearing(free, 0, 0)
            jammed = self.jam(flying, closed, before, state, memory)
            if jammed.admissible == 0:
                break
            before, pulled, count = jammed.taken, 0, max(count, jammed.admissible)
            closed = before | self.resting_corners(self.with_bearing(flying, before, 0), state)
        ways = found.admissible
        if found.admissible == 0 and found.held == 0:
            self.note_slips(mode)
            self.find_forces(mode, state, ground)
            for k in range(self.body_count):
                self.is_amiss(k, mode, state)
                starts = self.places()[k * PLACES + at.STARTS]
                if starts != 0.0:
                    self.places()[k * PLACES + at.SLIPS] = starts
        elif found.held == 0:
            noise = ROUNDING * self.number(0, at.GRAVITY)
            ways += self.other_ways(flying, found.taken, closed & ~pulled, noise, state)
        new = self.with_bearing(free, found.taken, pulled | found.held)
        self.hold_contacts(new, state, memory)
        new = self.as_tried(new, state, memory)
        # where several sets of impulses are admissible, motion is not unique either
        memory[kept + ADMISSIBLE] = max(ways, count if found.admissible > 0 else 0)
        memory[kept + TAKEN], memory[kept + OTHER] = found.taken, found.other
        return new

    @kernel
    def jam(self, flying: int, closed: int, before: int, state: Vector, memory: Vector) -> Found:
        """Stop slips by impulses, as no finite forces solve the equations, :eq:`eq-stack-jam`.

        Gives the corners that bear then. Where no set is admissible nothing is changed.
        """
        had = self.energies(flying, state).kinetic  # places the bodies, too
        load_bodies(self, 0.0, 0.0, self.places())
        found = bearing_corners(self, flying, closed, 0, before, JAMMED, state)
        if found.admissible == 0:
            return found
        self.change_velocities(state)
        stopped = self.with_bearing(flying, found.taken, 0)
        self.hold_contacts(stopped, state, memory)
        memory[IMPACT_LOSS] += had - self.energies(stopped, state).kinetic
        self.write_contacts(stopped, state, memory)
        for k in range(self.body_count):
            self.places()[k * PLACES + at.STARTS] = 0.0
        return found
