"""Guards of corners on rigid bases: the force of one that bears, the gap of another.

A corner that is held though it does not press has a guard of its fall if it were released.
"""

import math
from typing import Final

from rockframe.compiled import Vector, inlined, kernel, put
from rockframe.dynamics.base import Guards
from rockframe.dynamics.bed import RAISED, both_contacts
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.corners import IN_TENSION, NO_CONSTRAINT, RigidCorners
from rockframe.dynamics.chain.rows import BODY_STRIDE, GUARDS
from rockframe.dynamics.on_base import Mode
from rockframe.dynamics.pads import CORNER_GUARDS
from rockframe.dynamics.protocol import Ground, Slope

RELEASE_GUARD: Final = 1
"""Guard of the fall of a corner that is held without pressing, behind that of its force."""


class CornerGuards(RigidCorners):
    """Stacked bodies, some of which stand on rigid bases, with their guards. A mixin of systems."""

    __slots__ = ()

    @inlined
    def find_corner_forces(self, mode: int, state: Vector, ground: Ground) -> None:
        """Find the forces of corners on rigid bases, unless those in the workspace are valid."""
        if not self.forces_are_valid(mode, state, ground):
            self.find_forces(mode, state, ground)

    @kernel
    def guards_of_bodies(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Write the guards of each body in turn, and their rates."""
        values, changes = self.guard_workspace(0), self.guard_workspace(1)
        self.find_corner_forces(mode, state, ground)
        for k in range(self.body_count):
            if self.is_rigid(k):
                self.write_corner_guards(k, self.body_mode(mode, k), state, values, changes)
                self.write_slip_guards(k, mode, state, values, changes)
            elif self.is_slippery(k):
                self.write_inactive_guards(k, values, changes)
                self.write_slip_guards(k, mode, state, values, changes)
        for k in range(self.body_count):
            body_mode = self.body_mode(mode, k)
            if self.is_rigid(k) and body_mode.contact & IN_TENSION != 0:
                left = self.on_base(k).base.is_held(body_mode.contact, True)
                i = GUARDS * k + (0 if left else CORNER_GUARDS)
                values[i] = -values[i]
                # it stays held if, released, it would fall, or others would be in tension or close
                falls = self.fall_if_released(k, left, mode, state, ground)
                values[i + RELEASE_GUARD] = max(falls, self.largest_tension(mode))
        slides = self.some_end_slides(mode)
        for k in range(self.body_count):
            if not self.is_rigid(k):
                guards = self.guards_on_base(k, slides, mode, state, slope, ground)
                put(guards.values, GUARDS * k, values)
                put(guards.changes, GUARDS * k, changes)
        return Guards(values, changes)

    @kernel
    def largest_tension(self, mode: int) -> float:
        """Return largest tension in a corner that bears in the last solution, over FORCE_SCALE."""
        most = -math.inf
        for k in range(self.body_count):
            if self.is_rigid(k) and self.body_mode(mode, k).contact & IN_TENSION == 0:
                for side in range(2):
                    if (
                        self.workspace()[k * BODY_STRIDE + at.LEFT_CONSTRAINT + side]
                        != NO_CONSTRAINT
                    ):
                        pull = -self.corner_force(k, side == 0) / self.row_value(k, at.FORCE_SCALE)
                        most = max(most, pull)
        return most

    @kernel
    def fall_if_released(
        self, k: int, left: bool, mode: int, state: Vector, ground: Ground
    ) -> float:
        """Return the downward acceleration of a held corner if it were released, over gravity.

        Maximum over this corner and those that practically touch their bases but do not bear.
        """
        lowest, most = self.body_count - 1, -math.inf
        x = self.horizontal_of(lowest)
        held, still = state[x], state[self.coordinates() + x]
        if k == lowest:
            self.write_lowest_position(mode, state)
        free = self.with_body_mode(mode, k, Mode(both_contacts(RAISED, RAISED), 0, False))
        free = self.with_overcome_friction(free, state, ground)
        for other in range(self.body_count):
            if self.is_rigid(other):
                rises = self.end_accelerations(other, free, state, ground)
                for side in range(2):
                    released = other == k and left == (side == 0)
                    if released or self.is_closing(other, side == 0, -rises[side], free, state):
                        most = max(most, -rises[side] / self.row_value(other, at.GRAVITY))
        self.set_horizontal(lowest, held, still, state)
        return most

    @kernel
    def is_closing(self, k: int, left: bool, fall: float, mode: int, state: Vector) -> bool:
        """Whether a corner that does not bear is practically at its base and falls onto it."""
        part, body_mode = self.on_base(k), self.body_mode(mode, k)
        line = part.body.base_line_at(self.constrained_state(k, body_mode, state))
        level, speed = line.left, line.left_speed
        if not left:
            level, speed = line.right, line.right_speed
        near = level < part.body.least_rise() and part.body.returns_at_once(speed, fall)
        return near and not part.base.is_held(body_mode.contact, left)

    @kernel
    def has_sinking_corner(self, mode: int, state: Vector) -> bool:
        """Whether a corner that is at its rigid base, but does not bear, moves down."""
        for k in range(self.body_count):
            part, body_mode = self.on_base(k), self.body_mode(mode, k)
            line = part.body.base_line_at(self.constrained_state(k, body_mode, state))
            for side in range(2):
                gap, speed = line.left, line.left_speed
                if side == 1:
                    gap, speed = line.right, line.right_speed
                bears = not self.is_rigid(k) or part.base.is_held(body_mode.contact, side == 0)
                if not bears and gap < part.body.least_rise() and speed < 0.0:
                    return True
        return False

    @inlined
    def write_lowest_position(self, mode: int, state: Vector) -> None:
        """Write place and rate of the lowest body; while held, its state has the held point's."""
        k, x = self.body_count - 1, self.horizontal_of(self.body_count - 1)
        body_mode = self.body_mode(mode, k)
        if not self.on_base(k).is_free(body_mode):
            place, rate = self.position_from_pin(k, body_mode, state[x], state)
            self.set_horizontal(k, place, rate, state)

    @inlined
    def with_overcome_friction(self, mode: int, state: Vector, ground: Ground) -> int:
        """Return the mode in which bodies slip that friction cannot hold: it holds all here."""
        return mode

    @kernel
    def write_corner_guards(
        self, k: int, body_mode: Mode, state: Vector, values: Vector, changes: Vector
    ) -> None:
        """Write the guards of both corners: the force of one that bears, the gap of another."""
        part, body = self.on_base(k), self.constrained_state(k, body_mode, state)
        line, force_size = part.body.base_line_at(body), self.row_value(k, at.FORCE_SCALE)
        flies, resting = part.flies(body_mode.contact), self.level_corners(k, body)
        self.write_inactive_guards(k, values, changes)
        for side in range(2):
            i = GUARDS * k + CORNER_GUARDS * side
            if part.base.is_held(body_mode.contact, side == 0):
                values[i] = self.corner_force(k, side == 0) / force_size
                continue
            if flies:
                size = part.body.size()
                values[i] = (line.left if side == 0 else line.right) / size
                changes[i] = (line.left_speed if side == 0 else line.right_speed) / size
            else:
                scale = (1.0 if side == 0 else -1.0) / part.body.angle
                values[i], changes[i] = scale * body.rotation, scale * body.angular_velocity
            if resting >> side & 1 != 0:  # rounding must not close a corner
                values[i], changes[i] = abs(values[i]), 0.0

    @inlined
    def write_inactive_guards(self, k: int, values: Vector, changes: Vector) -> None:
        """Write guards of a body that do not fall."""
        for i in range(GUARDS):
            values[GUARDS * k + i], changes[GUARDS * k + i] = 1.0, 0.0
