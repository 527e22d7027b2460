"""A chain in which some bodies stand on rigid bases, beside others on pads and beds.

A corner that bears on a rigid base is held, normal to the base and along it, by forces that are
solved for, :eq:`eq-chain-solution`. What a contact does not let move follows from what it does,
so that nothing drifts. Corners part where their force falls through zero, and close by impacts,
:eq:`eq-projection`.
"""

import math
from typing import Final

from rockframe.compiled import Vector, inlined, kernel, put
from rockframe.dynamics.base import SIMULTANEOUS, Guards, Variables
from rockframe.dynamics.bed import DOWN, RAISED, both_contacts
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, ROTATION, VERTICAL
from rockframe.dynamics.body import BodyState
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.impact import (
    BOTH,
    LEFT_ONLY,
    NOISE,
    RIGHT_ONLY,
    attempt,
    bearing_corners,
)
from rockframe.dynamics.chain.motion import (
    add_constraint,
    coriolis_normal,
    load_bodies,
    place_bodies,
    write_relative,
)
from rockframe.dynamics.chain.rows import CONSTRAINT, GUARDS, PLACES
from rockframe.dynamics.chain.system import Chain
from rockframe.dynamics.events import FULL, IMPACT, REST, SEPARATION, SILENT, UPLIFT
from rockframe.dynamics.on_base import Mode, VelocityChange
from rockframe.dynamics.pads import CORNER, CORNER_GUARDS
from rockframe.dynamics.protocol import HELD_PLACE, IMPACT_LOSS, LAST_EVENT, Ground, Slope
from rockframe.dynamics.restraint import PIVOT_CENTRE, PIVOT_LEFT, PIVOT_RIGHT
from rockframe.dynamics.rigid_ground import REST_AMPLITUDE
from rockframe.dynamics.sliding import blend
from rockframe.dynamics.switching import disturbed

NONE: Final = -1.0
"""In place of the number of a constraint."""
PULLED: Final = CORNER
"""In the contact of a body whose corner is held though it does not press: free, it would come
back at once."""
OPENING: Final = 1
"""Guard of such a corner, behind that of its force: that it would come back."""
EVERY_LEFT: Final = 0x5555
"""The left corners of eight bodies."""
LEVEL: Final = 1e-13
"""Share of a body's size, or of its speed of fall, below which a corner is at its base."""

# memory, behind the held places and the body of the last event
ADMISSIBLE: Final = 1  # sets of corners that might have borne after the last event
TAKEN: Final = 2  # the set that did
OTHER: Final = 3  # the next best, or -1
KEPT: Final = ("admissible_sets", "set_taken", "other_set")
"""Names of these."""


class RigidChain(Chain):
    """Bodies upon one another of which some stand on rigid bases: a system."""

    __slots__ = ()

    @inlined
    def is_rigid(self, k: int) -> bool:
        """Whether a body stands on a rigid base."""
        return self.number(k, at.LAW) == at.ON_RIGID

    @inlined
    def begin_event(self, memory: Vector) -> None:
        """Forget what the last event left: unless told, one set of corners was admissible."""
        memory[HELD_PLACE + self.body_count + ADMISSIBLE] = 1.0

    @inlined
    def link_place(self) -> int:
        """Give the place of the last event's link in the memory of a chain that has links."""
        return HELD_PLACE + self.body_count + 1 + len(KEPT)

    @inlined
    def band(self) -> int:
        """Give how far apart constraints that have a body in common may stand."""
        return 5

    @kernel
    def standing_state(self, k: int, standing: Mode, state: Vector) -> BodyState:
        """Give placement and rates of a body as its contacts allow them."""
        body, part = self.state_of(k, state), self.on_base(k)
        if not self.is_rigid(k) or part.flies(standing.contact):
            return body
        left = part.base.is_held(standing.contact, True)
        if left and part.base.is_held(standing.contact, False):
            return BodyState(0.0, 0.0, body.horizontal, 0.0, 0.0, 0.0)
        lowered = BodyState(
            body.rotation, 0.0, body.horizontal, body.angular_velocity, 0.0,
            body.horizontal_velocity,
        )  # fmt: skip
        line = part.body.base_line_at(lowered)
        level, speed = (line.left, line.left_speed) if left else (line.right, line.right_speed)
        return BodyState(
            body.rotation, -level, body.horizontal, body.angular_velocity, -speed,
            body.horizontal_velocity,
        )  # fmt: skip

    @kernel
    def add_corners(
        self, k: int, count: int, standing: Mode, state: Vector, moves: bool, room: Vector,
        rows: Vector,
    ) -> int:  # fmt: skip
        """Add the constraints of corners that bear on a rigid base, :eq:`eq-rigid-corner`."""
        i, part = k * PLACES, self.on_base(k)
        room[i + at.LEFT_CORNER] = room[i + at.RIGHT_CORNER] = NONE
        if not self.is_rigid(k) or part.flies(standing.contact):
            return count
        body = self.standing_state(k, standing, state)
        attitude = part.body.attitude(body.rotation)
        line = part.body.base_line(body, attitude)
        rate = body.angular_velocity if moves else 0.0
        bends = part.body.end_accelerations(attitude, rate, 0.0, 0.0)
        for side in range(2):
            if part.base.is_held(standing.contact, side == 0):
                lever = line.left_lever if side == 0 else line.right_lever
                wanted = -coriolis_normal(i, room) - bends[side]
                add_constraint(self, count, k, 0.0, 1.0, lever, wanted, room, rows)
                room[i + at.LEFT_CORNER + side] = count
                count += 1
        return count

    @inlined
    def stand_still(self, room: Vector, out: Vector) -> None:
        """Take rounding from the accelerations of bodies in full contact with a rigid base."""
        for k in range(self.body_count):
            i = k * PLACES
            full = room[i + at.LEFT_CORNER] != NONE and room[i + at.RIGHT_CORNER] != NONE
            if self.is_rigid(k) and full:
                first = BEFORE_HORIZONTAL * k
                out[first + ROTATION] = out[first + VERTICAL] = 0.0
                out[self.horizontal_of(k)] = 0.0

    @kernel
    def corner_force(self, k: int, left: bool) -> float:
        """Give the force at a corner on a rigid base, or its impulse, as solved for last."""
        i = k * PLACES + (at.LEFT_CORNER if left else at.RIGHT_CORNER)
        which = self.places()[i]
        if which == NONE:
            return 0.0
        return float(self.constraints()[int(which) * CONSTRAINT + at.FORCE])

    @inlined
    def find_corner_forces(self, mode: int, state: Vector, ground: Ground) -> None:
        """Find the forces of corners on rigid bases."""
        self.accelerate(mode, state, ground)

    @inlined
    def observed_base(self, k: int, standing: Mode, body: BodyState) -> Variables:
        """Give what users see of a base: of a rigid one, the forces of its corners."""
        if self.is_rigid(k):
            return self.corner_force(k, True), self.corner_force(k, False), 0.0
        return self.on_base(k).observed_base(standing, body, ())

    @kernel
    def guards_of_bodies(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Write the guards of each body in turn, and their rates."""
        values, changes = self.guard_room(0), self.guard_room(1)
        self.accelerate(mode, state, ground)
        for k in range(self.body_count):
            if self.is_rigid(k):
                self.write_corner_guards(k, self.part_mode(mode, k), state, values, changes)
        for k in range(self.body_count):
            standing = self.part_mode(mode, k)
            if self.is_rigid(k) and standing.contact & PULLED != 0:
                left = self.on_base(k).base.is_held(standing.contact, True)
                i = GUARDS * k + (0 if left else CORNER_GUARDS)
                values[i] = -values[i]
                free = self.with_part(mode, k, Mode(both_contacts(RAISED, RAISED), 0, False))
                rises = self.end_accelerations(k, free, state, ground)
                values[i + OPENING] = -rises[0 if left else 1] / self.number(k, at.GRAVITY)
        slides = self.some_end_slides(mode)
        for k in range(self.body_count):
            if not self.is_rigid(k):
                found = self.guards_on_base(k, slides, mode, state, slope, ground)
                put(found.values, GUARDS * k, values)
                put(found.changes, GUARDS * k, changes)
        return Guards(values, changes)

    @kernel
    def write_corner_guards(
        self, k: int, standing: Mode, state: Vector, values: Vector, changes: Vector
    ) -> None:
        """Write the guards of both corners: the force of one that bears, the gap of another."""
        part, body = self.on_base(k), self.standing_state(k, standing, state)
        line, weight = part.body.base_line_at(body), self.number(k, at.MASS) * part.body.gravity
        flies = part.flies(standing.contact)
        for i in range(GUARDS):
            values[GUARDS * k + i], changes[GUARDS * k + i] = 1.0, 0.0
        for side in range(2):
            i = GUARDS * k + CORNER_GUARDS * side
            if part.base.is_held(standing.contact, side == 0):
                values[i] = self.corner_force(k, side == 0) / weight
            elif flies:
                size = part.body.size()
                values[i] = (line.left if side == 0 else line.right) / size
                changes[i] = (line.left_speed if side == 0 else line.right_speed) / size
            else:
                scale = (1.0 if side == 0 else -1.0) / part.body.angle
                values[i], changes[i] = scale * body.rotation, scale * body.angular_velocity

    @kernel
    def respond(self, k: int, mode: int, response: VelocityChange, state: Vector) -> None:
        """Change the velocities by the last response, and keep the impulses of rigid bases."""
        self.add_slopes(state)
        room, rows = self.places(), self.constraints()
        for j in range(self.body_count):
            i, last = j * PLACES, -1
            for side in range(2):
                which = int(room[i + at.LEFT_CORNER + side])
                if which >= 0:
                    room[i + at.LEFT_IMPULSE + side] += rows[which * CONSTRAINT + at.FORCE]
                    self.keep_impulse(j, which, room, rows)
                    last = which
            if last >= 0:  # the hold along the base stands behind its corners
                self.keep_impulse(j, last + 1, room, rows)

    @kernel
    def keep_impulse(self, k: int, which: int, room: Vector, rows: Vector) -> None:
        """Add the impulse of a constraint of a rigid base to those that bodies have got."""
        first = which * CONSTRAINT
        force, holds = rows[first + at.FORCE], first + at.HOLDS
        for body in range(k, min(k + 2, self.body_count)):
            i = body * PLACES + at.IMPULSE_X
            for j in range(3):
                room[i + j] += force * rows[holds + j]
            holds += 3

    @kernel
    def scale_impulses(self, share: float) -> None:
        """Keep a share of the impulses of rigid bases."""
        room = self.places()
        for k in range(self.body_count):
            for j in range(at.IMPULSES):
                room[k * PLACES + at.LEFT_IMPULSE + j] *= share

    @kernel
    def blend_velocities(
        self, before: tuple[float, ...] | Vector, share: float, state: Vector
    ) -> None:
        """Take back all but a share of what has changed the velocities since."""
        n = self.coordinates()
        for i in range(n):
            state[n + i] = blend(before[i], state[n + i], share)
        self.scale_impulses(share)

    @kernel
    def some_pull(self) -> bool:
        """Whether a corner on a rigid base would have had to pull in an event beside it."""
        room, least, all_of_them = self.places(), 0.0, 0.0
        for k in range(self.body_count):
            for side in range(2):
                impulse = room[k * PLACES + at.LEFT_IMPULSE + side]
                least, all_of_them = min(least, impulse), all_of_them + abs(impulse)
        return least < -NOISE * all_of_them

    @kernel
    def switch_body(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out the switch that a guard of a body calls for; give the new mode."""
        k, count = guard // GUARDS, self.body_count
        self.begin_event(memory)
        contact, which = self.part_mode(mode, k).contact, guard - k * GUARDS
        left = which < CORNER_GUARDS
        if (
            self.is_rigid(k)
            and contact & PULLED != 0
            and (self.on_base(k).base.is_held(contact, left))
        ):
            self.write_contacts(mode, state, memory)
            opens = which % CORNER_GUARDS == OPENING
            corners = self.bearing(mode) & ~(BOTH << 2 * k) if opens else self.bearing(mode)
            new = self.with_bearing(mode, corners, self.pulled(mode) & ~(BOTH << 2 * k))
            memory[LAST_EVENT] = SEPARATION if opens else SILENT
        elif self.is_rigid(k):
            new = self.switch_corner(k, left, mode, state, ground, memory)
        else:
            self.scale_impulses(0.0)
            new = self.switch_on_base(mode, guard, state, ground, memory)
            # a change of a held point is the rule's, and no blow: contacts stay as they are
            if memory[LAST_EVENT] != IMPACT or not self.some_pull():
                return new
            new = self.meet_anew(new, state, ground, memory)
        for other in range(count):
            if not self.is_rigid(other):
                new = disturbed(self, self.on_base(other), other, new, state)
        memory[HELD_PLACE + count] = k + 1.0
        return new

    @kernel
    def switch_corner(
        self, k: int, left: bool, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Let a corner part from a rigid base, or land on it."""
        part, standing = self.on_base(k), self.part_mode(mode, k)
        bore = part.base.is_held(standing.contact, left)
        self.write_contacts(mode, state, memory)
        before = self.bearing(mode)
        closed = before | self.resting_corners(mode, state)
        if bore:
            leaving = (LEFT_ONLY if left else RIGHT_ONLY) << 2 * k
            new = self.let_bear(mode, closed, before, leaving, state, ground, memory)
            flies = part.flies(self.part_mode(new, k).contact)
            both = part.shown_contact(standing) == FULL
            memory[LAST_EVENT] = UPLIFT if both and not flies else SEPARATION
            if self.pulled(new) & leaving != 0:
                memory[LAST_EVENT] = SILENT
            return new
        closed |= self.land(k, left, standing, state)
        memory[LAST_EVENT] = IMPACT
        new = self.let_bear(mode, closed, before, 0, state, ground, memory)
        return self.rest_where_small(new, state, ground, memory)

    @kernel
    def meet_anew(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Take back what rigid bases did in an event beside them, and let them press only."""
        room = self.places()
        self.write_contacts(mode, state, memory)
        had, before = self.energies(mode, state).kinetic, self.bearing(mode)
        flying = self.with_bearing(mode, 0, 0)
        place_bodies(self, flying, state, room)
        for k in range(self.body_count):
            i = k * PLACES
            room[i + at.LOAD_X] = -room[i + at.IMPULSE_X]
            room[i + at.LOAD_Y] = -room[i + at.IMPULSE_Y]
            room[i + at.LOAD_MOMENT] = -room[i + at.IMPULSE_MOMENT]
        attempt(self, flying, 0, 0, False, True, 0.0, state)
        self.change_velocities(state)
        memory[IMPACT_LOSS] += had - self.energies(flying, state).kinetic
        event = memory[LAST_EVENT]
        new = self.let_bear(mode, before, before, 0, state, ground, memory)
        new = self.rest_where_small(new, state, ground, memory)
        memory[LAST_EVENT] = event
        return new

    @kernel
    def let_bear(
        self, mode: int, closed: int, before: int, leaving: int, state: Vector, ground: Ground,
        memory: Vector,
    ) -> int:  # fmt: skip
        """Let those of the closed corners bear that can; give the new mode.

        After an impact, unless a corner is leaving.
        """
        flying, kept = self.with_bearing(mode, 0, 0), HELD_PLACE + self.body_count
        had = self.energies(flying, state).kinetic  # places the bodies, too
        if leaving == 0:
            load_bodies(self, 0.0, 0.0, self.places())
        else:
            self.accelerate(flying, state, ground)
        pulled = 0 if leaving == 0 else self.pulled(mode)
        found = bearing_corners(self, flying, closed & ~pulled, pulled, before, leaving, state)
        taken = found.taken
        if leaving == 0:
            self.change_velocities(state)
        elif found.admissible == 0 and self.bears_alone(before, leaving):
            taken, pulled = before, pulled | leaving
        new = self.with_bearing(mode, taken, pulled)
        self.hold_contacts(new, state, memory)
        memory[IMPACT_LOSS] += had - self.energies(new, state).kinetic
        memory[kept + ADMISSIBLE] = found.admissible
        memory[kept + TAKEN], memory[kept + OTHER] = taken, found.other
        return new

    @kernel
    def change_velocities(self, state: Vector) -> None:
        """Change the velocities by what impulses have done, which stands in the rooms."""
        room = self.places()
        for k in range(self.body_count):
            i = k * PLACES
            room[i + at.RISE] = room[i + at.SWAY] = room[i + at.FRAME_RATE] = 0.0
        write_relative(self, room, self.slopes())
        self.add_slopes(state)

    @inlined
    def rest_where_small(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Let bodies come to rest, of which one at rest may let another come to rest."""
        new = mode
        for _ in range(self.body_count):
            new = self.rest_if_small(new, state, ground, memory)
        return new

    @kernel
    def rest_if_small(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Let bodies whose rebound is below all that counts come to rest, together or alone."""
        n, corners, small, count = self.coordinates(), self.bearing(mode), 0, 0
        slope = self.accelerate(mode, state, ground)
        for k in range(self.body_count):
            first, bears = BEFORE_HORIZONTAL * k, corners >> 2 * k & BOTH
            if bears in (LEFT_ONLY, RIGHT_ONLY) and state[first + ROTATION] == 0.0:
                side, rate = -1.0 if bears == LEFT_ONLY else 1.0, state[n + first + ROTATION]
                restoring = -side * slope[first + ROTATION]
                least = REST_AMPLITUDE * self.on_base(k).body.angle
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
        """Let bodies stand on both corners, if these press then; else give the mode as it is."""
        before, lost = self.velocities(state), memory[IMPACT_LOSS]
        self.write_contacts(mode, state, memory)
        all_of_them = self.bearing(mode) | corners
        flying, resting = self.with_bearing(mode, 0, 0), self.with_bearing(mode, all_of_them, 0)
        had = self.energies(flying, state).kinetic
        load_bodies(self, 0.0, 0.0, self.places())
        attempt(self, flying, all_of_them, all_of_them, False, True, 0.0, state)
        self.change_velocities(state)
        self.hold_contacts(resting, state, memory)
        memory[IMPACT_LOSS] += had - self.energies(resting, state).kinetic
        self.accelerate(resting, state, ground)
        least = 0.0
        for k in range(self.body_count):
            if corners >> 2 * k & BOTH != 0:
                least = min(least, self.corner_force(k, True), self.corner_force(k, False))
        if least >= 0.0:
            memory[LAST_EVENT] = REST
            return resting
        self.blend_velocities(before, 0.0, state)
        self.hold_contacts(mode, state, memory)
        memory[IMPACT_LOSS] = lost
        return mode

    @kernel
    def bearing(self, mode: int) -> int:
        """Give the corners on rigid bases that bear in a mode."""
        found = 0
        for k in range(self.body_count):
            if self.is_rigid(k):
                part, contact = self.on_base(k), self.part_mode(mode, k).contact
                found |= (1 if part.base.is_held(contact, True) else 0) << 2 * k
                found |= (2 if part.base.is_held(contact, False) else 0) << 2 * k
        return found

    @kernel
    def pulled(self, mode: int) -> int:
        """Give the corners that are held in a mode though they do not press."""
        found, bearing = 0, self.bearing(mode)
        for k in range(self.body_count):
            if self.is_rigid(k) and self.part_mode(mode, k).contact & PULLED != 0:
                found |= bearing & BOTH << 2 * k
        return found

    @inlined
    def bears_alone(self, corners: int, one: int) -> bool:
        """Whether a corner bears without the other one of its body."""
        even = one & EVERY_LEFT != 0
        return corners & (one << 1 if even else one >> 1) == 0

    @kernel
    def with_bearing(self, mode: int, corners: int, pulled: int) -> int:
        """Give the mode in which some corners on rigid bases bear, some of them only held."""
        new = mode
        for k in range(self.body_count):
            if self.is_rigid(k):
                bears = corners >> 2 * k & BOTH
                contact = both_contacts(
                    DOWN if bears & LEFT_ONLY else RAISED, DOWN if bears & RIGHT_ONLY else RAISED
                )
                contact += PULLED if pulled >> 2 * k & BOTH != 0 else 0
                pivot = PIVOT_CENTRE
                if bears == LEFT_ONLY:
                    pivot = PIVOT_LEFT
                elif bears == RIGHT_ONLY:
                    pivot = PIVOT_RIGHT
                new = self.with_part(new, k, Mode(contact, pivot, False))
        return new

    @kernel
    def resting_corners(self, mode: int, state: Vector) -> int:
        """Give the corners that have been left, and are still where they were."""
        found = 0
        for k in range(self.body_count):
            if self.is_rigid(k):
                part, standing = self.on_base(k), self.part_mode(mode, k)
                body = self.standing_state(k, standing, state)
                line, size = part.body.base_line_at(body), part.body.size()
                level = LEVEL * size
                speed = LEVEL * math.sqrt(part.body.gravity * size)
                if abs(line.left) <= level and abs(line.left_speed) <= speed:
                    found |= LEFT_ONLY << 2 * k
                if abs(line.right) <= level and abs(line.right_speed) <= speed:
                    found |= RIGHT_ONLY << 2 * k
        return found

    @kernel
    def land(self, k: int, left: bool, standing: Mode, state: Vector) -> int:
        """Put a corner that lands on its base; give the corners that are there then."""
        part, first = self.on_base(k), BEFORE_HORIZONTAL * k
        line = part.body.base_line_at(self.state_of(k, state))
        both = not part.flies(standing.contact)
        both |= abs(line.left - line.right) <= SIMULTANEOUS * part.body.angle * part.body.size()
        if both:
            state[first + ROTATION] = state[first + VERTICAL] = 0.0
            return BOTH << 2 * k
        state[first + VERTICAL] -= line.left if left else line.right
        return (LEFT_ONLY if left else RIGHT_ONLY) << 2 * k

    @kernel
    def write_contacts(self, mode: int, state: Vector, memory: Vector) -> None:
        """Write to the state what follows from the contacts with rigid bases."""
        n = self.coordinates()
        for k in range(self.body_count):
            part, standing = self.on_base(k), self.part_mode(mode, k)
            if self.is_rigid(k) and not part.flies(standing.contact):
                body = self.standing_state(k, standing, state)
                pin, first = part.body.pin(standing.pivot), BEFORE_HORIZONTAL * k
                reach = part.body.reach(pin, part.body.attitude(body.rotation))
                state[first + ROTATION], state[first + VERTICAL] = body.rotation, body.vertical
                state[n + first + ROTATION] = body.angular_velocity
                state[n + first + VERTICAL] = body.vertical_velocity
                place = memory[HELD_PLACE + k] + part.body.about_pin(pin, body.rotation)
                self.set_sway(k, place, reach.rate * body.angular_velocity, state)

    @kernel
    def hold_contacts(self, mode: int, state: Vector, memory: Vector) -> None:
        """Hold bodies where they are by the contacts of a mode, whose velocities they have."""
        for k in range(self.body_count):
            part, standing = self.on_base(k), self.part_mode(mode, k)
            if self.is_rigid(k) and not part.flies(standing.contact):
                pin, place = part.body.pin(standing.pivot), state[self.horizontal_of(k)]
                rotation = self.standing_state(k, standing, state).rotation
                memory[HELD_PLACE + k] = place - part.body.about_pin(pin, rotation)
        self.write_contacts(mode, state, memory)
