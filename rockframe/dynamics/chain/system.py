"""A chain of bodies as a system: its guards, its switches of contact, and its columns."""

from rockframe.compiled import Vector, inlined, kernel, put
from rockframe.dynamics.base import Guards, Variables
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, ROTATION, VERTICAL
from rockframe.dynamics.body import BodyState, with_accelerations
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.moving import MovingBodies
from rockframe.dynamics.chain.rows import BASE_COLUMNS, BODY_STRIDE, COLUMNS, GUARDS
from rockframe.dynamics.events import IMPACT
from rockframe.dynamics.on_base import HOLD, IDLE_GUARDS, SLIP, Mode, SlidingGuards
from rockframe.dynamics.pads import CORNER_GUARDS, LEAVING, corner_contact
from rockframe.dynamics.protocol import HELD_PLACE, LAST_EVENT, Ground, Slope
from rockframe.dynamics.switching import (
    lift_per_slip,
    mode_after_disturbance,
    recheck_sliding,
    switch_mode,
)


class Chain(MovingBodies):
    """Stacked bodies, from the top down: a system."""

    __slots__ = ()

    @inlined
    def body_guard_count(self) -> int:
        """Return the number of guards of all bodies."""
        return GUARDS * self.body_count

    @kernel
    def guards(self) -> int:
        """Return the number of guards, of each body in turn."""
        return self.body_guard_count()

    @kernel
    def contact_state_of(self, mode: int, k: int) -> int:
        """Return the contact state of a body."""
        return self.on_base(k).contact_state(self.body_mode(mode, k))

    @kernel
    def some_end_slides(self, mode: int) -> bool:
        """Whether an end of some body is in sliding contact."""
        slides = False
        for k in range(self.body_count):
            slides |= self.body_mode(mode, k).slides and not self.is_slippery(k)
        return slides

    @kernel
    def without_sliding(self, mode: int) -> int:
        """Return the mode itself: nothing is compiled for it."""
        return mode

    @kernel
    def guards_in(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Return the guards of each body in turn, and their rates."""
        return self.guards_of_bodies(mode, state, slope, ground)

    @kernel
    def guards_of_bodies(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Write the guards of each body in turn, and their rates."""
        values, changes = self.guard_workspace(0), self.guard_workspace(1)
        slides = self.some_end_slides(mode)
        for k in range(self.body_count):
            guards = self.guards_on_base(k, slides, mode, state, slope, ground)
            put(guards.values, GUARDS * k, values)
            put(guards.changes, GUARDS * k, changes)
        return Guards(values, changes)

    @inlined
    def guards_on_base(
        self, k: int, slides: bool, mode: int, state: Vector, slope: Slope, ground: Ground
    ) -> Guards:
        """Return the guards of a body on a deformable base, and their rates."""
        part, body_mode, body = self.on_base(k), self.body_mode(mode, k), self.state_of(k, state)
        first, sliding = BEFORE_HORIZONTAL * k, IDLE_GUARDS
        vertical, angular = slope[first + VERTICAL], slope[first + ROTATION]
        if self.is_slippery(k):  # these guards have been written before
            values, changes = self.guard_workspace(0), self.guard_workspace(1)
            i = GUARDS * k + 2 * CORNER_GUARDS
            sliding = SlidingGuards(values[i + HOLD], values[i + SLIP], changes[i + SLIP])
            body_mode = Mode(body_mode.contact, body_mode.pivot, False)
        elif slides and body_mode.slides:
            rise = lift_per_slip(self, part, k, mode, state)
            self.forces_from_slope(mode, state, slope, ground)
            push = self.workspace()[k * BODY_STRIDE + at.TANGENTIAL_FORCE]
            horizontal = slope[self.horizontal_of(k)]
            sliding = part.sliding_guards(body_mode, body, angular, horizontal, push, rise)
        return part.guards_with(body_mode, body, (), vertical, angular, sliding)

    @kernel
    def switch(self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Carry out the switch that a guard calls for; return the new mode."""
        return self.switch_body(mode, guard, state, ground, memory)

    @inlined
    def switch_body(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out the switch that a guard of a body calls for; return the new mode."""
        return self.switch_on_base(mode, guard, state, ground, memory)

    @inlined
    def reset_event(self, memory: Vector) -> None:
        """Reset the memory of the last event: the number of its body."""
        memory[HELD_PLACE + self.body_count] = 0.0

    @inlined
    def event_memory_end(self) -> int:
        """Return the index in the memory behind the numbers of the last event."""
        return HELD_PLACE + self.body_count + 1

    @inlined
    def switch_on_base(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out the switch of a body on a deformable base."""
        k = guard // GUARDS
        new = switch_mode(self, self.on_base(k), k, guard - k * GUARDS, mode, state, ground, memory)
        for above in range(k):
            if memory[LAST_EVENT] == IMPACT or not self.keeps_leaving_contact(
                above, new, state, ground
            ):
                new = self.disturbed_mode(above, new, state)
        for below in range(k + 1, self.body_count):
            if not self.is_rigid(below) and not self.is_slippery(below):
                new = recheck_sliding(self, self.on_base(below), below, new, state)
        memory[HELD_PLACE + self.body_count] = k + 1.0
        return new

    @kernel
    def keeps_leaving_contact(self, k: int, mode: int, state: Vector, ground: Ground) -> bool:
        """Whether an end that lifted off while pressed keeps this contact after an event elsewhere.

        It does as long as the force of its pad decreases, unless the event is an impact.
        """
        contact = self.body_mode(mode, k).contact
        for side in range(2):
            if not self.is_rigid(k) and corner_contact(contact, side == 0) == LEAVING:
                return self.has_falling_force(k, side == 0, mode, state, ground)
        return False

    @kernel
    def has_falling_force(
        self, k: int, left: bool, mode: int, state: Vector, ground: Ground
    ) -> bool:
        """Whether the force of a deformable base on an end does not rise."""
        part, rises = self.on_base(k), self.end_accelerations(k, mode, state, ground)
        line = part.body.base_line_at(self.state_of(k, state))
        return not part.base.will_press(left, with_accelerations(line, rises[0], rises[1]), ())

    @kernel
    def disturbed_mode(self, k: int, mode: int, state: Vector) -> int:
        """Return the mode after an event of another body has changed the speeds of this one."""
        if self.is_rigid(k):
            return mode
        part, was = self.on_base(k), self.body_mode(mode, k)
        if self.is_slippery(k):
            contact = part.base.disturbed(was.contact)
            return self.with_body_mode(mode, k, Mode(contact, was.pivot, was.slides))
        return mode_after_disturbance(self, part, k, mode, state)

    @kernel
    def observe_bodies(
        self, mode: int, state: Vector, slope: Slope, ground: Ground, memory: Vector
    ) -> Vector:
        """Write motion and forces of each body in turn, from the top down, and of its base."""
        out = self.column_workspace()
        self.find_corner_forces(mode, state, ground)
        self.forces_from_slope(mode, state, slope, ground)
        work = self.workspace()
        shear = work[(self.body_count - 1) * BODY_STRIDE + at.TANGENTIAL_FORCE]
        rotation = rate = rise = x = 0.0
        for k in range(self.body_count - 1, -1, -1):
            i, j, body_mode = k * BODY_STRIDE, COLUMNS * k, self.body_mode(mode, k)
            body = self.constrained_state(k, body_mode, state)
            rotation += body.rotation
            rate += body.angular_velocity
            rise = self.rise_of(k, rise, body.vertical, work)
            sine, cosine = work[i + at.SINE], work[i + at.COSINE]
            if k + 1 < self.body_count:
                x += work[i + at.NORMAL] * sine + work[i + at.TANGENTIAL] * cosine
                x -= self.row_value(k, at.UPRIGHT_OFFSET)
            else:
                x = self.centre_position(k, mode, state, memory)
            out[j], out[j + 1], out[j + 2], out[j + 3] = rotation, rate, rise, work[i + at.SPEED_Y]
            out[j + 4], out[j + 5], out[j + 6] = x, shear, work[i + at.SPEED_X]
            out[j + 7] = work[i + at.ANGULAR_ACCELERATION]
            out[j + 8], out[j + 9] = work[i + at.ACCELERATION_X], work[i + at.ACCELERATION_Y]
            out[j + 10], out[j + 11] = work[i + at.TANGENTIAL_FORCE], work[i + at.NORMAL_FORCE]
            out[j + 12], out[j + 13] = body.rotation, body.vertical
            put(self.base_columns(k, mode, body), j + COLUMNS - BASE_COLUMNS, out)
            self.write_slip_columns(k, mode, state, memory, out)
        return out

    observe = observe_bodies

    @inlined
    def write_slip_columns(
        self, k: int, mode: int, state: Vector, memory: Vector, out: Vector
    ) -> None:
        """Write slip and rate of slip of a body on its base: none slips here."""

    @inlined
    def find_corner_forces(self, mode: int, state: Vector, ground: Ground) -> None:
        """Find the forces of corners on rigid bases: there are none here."""

    @inlined
    def base_columns(self, k: int, mode: int, body: BodyState) -> Variables:
        """Return the base's columns in the results."""
        return self.deformable_base_columns(k, mode, body)

    @kernel
    def deformable_base_columns(self, k: int, mode: int, body: BodyState) -> Variables:
        """Return the columns of a deformable base in the results."""
        part = self.on_base(k)
        line = part.body.base_line_at(body)
        return part.base.observed(self.contact_with_force(k, mode), line, ())
