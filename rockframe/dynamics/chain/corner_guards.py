"""Guards of corners on rigid bases: the force of one that bears, the gap of another.

A corner that is held though it does not press has a guard of its fall if it were released.
"""

import math
from typing import Final

from rockframe.compiled import Vector, inlined, kernel, put
from rockframe.dynamics.base import Guards
from rockframe.dynamics.bed import RAISED, both_contacts
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.corners import NONE, PULLED, RigidCorners
from rockframe.dynamics.chain.rows import GUARDS, PLACES
from rockframe.dynamics.on_base import Mode
from rockframe.dynamics.pads import CORNER_GUARDS
from rockframe.dynamics.protocol import Ground, Slope

OPENING: Final = 1
"""Guard of the fall of a corner that is held without pressing, behind that of its force."""


class CornerGuards(RigidCorners):
    """Stacked bodies, some of which stand on rigid bases, with their guards. A mixin of systems."""

    __slots__ = ()

    @inlined
    def find_corner_forces(self, mode: int, state: Vector, ground: Ground) -> None:
        """Find the forces of corners on rigid bases, unless those in the workspace are valid."""
        if not self.forces_stand(mode, state, ground):
            self.find_forces(mode, state, ground)

    @kernel
    def guards_of_bodies(self, mode: int, state: Vector, slope: Slope, ground: Ground) -> Guards:
        """Write the guards of each body in turn, and their rates."""
        values, changes = self.guard_room(0), self.guard_room(1)
        self.find_corner_forces(mode, state, ground)
        for k in range(self.body_count):
            if self.is_rigid(k):
                self.write_corner_guards(k, self.body_mode(mode, k), state, values, changes)
                self.write_slip_guards(k, mode, state, values, changes)
            elif self.is_slippery(k):
                self.write_idle(k, values, changes)
                self.write_slip_guards(k, mode, state, values, changes)
        for k in range(self.body_count):
            standing = self.body_mode(mode, k)
            if self.is_rigid(k) and standing.contact & PULLED != 0:
                left = self.on_base(k).base.is_held(standing.contact, True)
                i = GUARDS * k + (0 if left else CORNER_GUARDS)
                values[i] = -values[i]
                # it stays held if, released, it would fall, or others would pull or close
                falls = self.fall_if_let_go(k, left, mode, state, ground)
                values[i + OPENING] = max(falls, self.most_pull(mode))
        slides = self.some_end_slides(mode)
        for k in range(self.body_count):
            if not self.is_rigid(k):
                found = self.guards_on_base(k, slides, mode, state, slope, ground)
                put(found.values, GUARDS * k, values)
                put(found.changes, GUARDS * k, changes)
        return Guards(values, changes)

    @kernel
    def most_pull(self, mode: int) -> float:
        """Return largest tension in a corner that bears in the last solution, over FORCE_SIZE."""
        most = -math.inf
        for k in range(self.body_count):
            if self.is_rigid(k) and self.body_mode(mode, k).contact & PULLED == 0:
                for side in range(2):
                    if self.places()[k * PLACES + at.LEFT_CORNER + side] != NONE:
                        pull = -self.corner_force(k, side == 0) / self.number(k, at.FORCE_SIZE)
                        most = max(most, pull)
        return most

    @kernel
    def fall_if_let_go(self, k: int, left: bool, mode: int, state: Vector, ground: Ground) -> float:
        """Return the downward acceleration of a held corner if it were released, over gravity.

        Maximum over this corner and those that practically touch their bases but do not bear.
        """
        lowest, most = self.body_count - 1, -math.inf
        x = self.horizontal_of(lowest)
        held, still = state[x], state[self.coordinates() + x]
        if k == lowest:
            self.free_lowest(mode, state)
        free = self.with_body_mode(mode, k, Mode(both_contacts(RAISED, RAISED), 0, False))
        free = self.let_slip_if_amiss(free, state, ground)
        for other in range(self.body_count):
            if self.is_rigid(other):
                rises = self.end_accelerations(other, free, state, ground)
                for side in range(2):
                    let_go = other == k and left == (side == 0)
                    if let_go or self.is_near(other, side == 0, -rises[side], free, state):
                        most = max(most, -rises[side] / self.number(other, at.GRAVITY))
        self.set_horizontal(lowest, held, still, state)
        return most

    @kernel
    def is_near(self, k: int, left: bool, fall: float, mode: int, state: Vector) -> bool:
        """Whether a corner that does not bear is practically at its base and falls onto it."""
        part, standing = self.on_base(k), self.body_mode(mode, k)
        line = part.body.base_line_at(self.standing_state(k, standing, state))
        level, speed = line.left, line.left_speed
        if not left:
            level, speed = line.right, line.right_speed
        near = level < part.body.least_rise() and part.body.returns_at_once(speed, fall)
        return near and not part.base.is_held(standing.contact, left)

    @kernel
    def throws_down(self, mode: int, state: Vector) -> bool:
        """Whether a corner that is at its rigid base, but does not bear, moves down."""
        for k in range(self.body_count):
            part, standing = self.on_base(k), self.body_mode(mode, k)
            line = part.body.base_line_at(self.standing_state(k, standing, state))
            for side in range(2):
                gap, speed = line.left, line.left_speed
                if side == 1:
                    gap, speed = line.right, line.right_speed
                bears = not self.is_rigid(k) or part.base.is_held(standing.contact, side == 0)
                if not bears and gap < part.body.least_rise() and speed < 0.0:
                    return True
        return False

    @inlined
    def free_lowest(self, mode: int, state: Vector) -> None:
        """Write place and rate of the lowest body; while held, its state has the held point's."""
        k, x = self.body_count - 1, self.horizontal_of(self.body_count - 1)
        standing = self.body_mode(mode, k)
        if not self.on_base(k).is_free(standing):
            place, rate = self.sway_at(k, standing, state[x], state)
            self.set_horizontal(k, place, rate, state)

    @inlined
    def let_slip_if_amiss(self, mode: int, state: Vector, ground: Ground) -> int:
        """Return the mode in which bodies slip that friction cannot hold: it holds all here."""
        return mode

    @kernel
    def write_corner_guards(
        self, k: int, standing: Mode, state: Vector, values: Vector, changes: Vector
    ) -> None:
        """Write the guards of both corners: the force of one that bears, the gap of another."""
        part, body = self.on_base(k), self.standing_state(k, standing, state)
        line, force_size = part.body.base_line_at(body), self.number(k, at.FORCE_SIZE)
        flies, resting = part.flies(standing.contact), self.level_corners(k, body)
        self.write_idle(k, values, changes)
        for side in range(2):
            i = GUARDS * k + CORNER_GUARDS * side
            if part.base.is_held(standing.contact, side == 0):
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
    def write_idle(self, k: int, values: Vector, changes: Vector) -> None:
        """Write guards of a body that do not fall."""
        for i in range(GUARDS):
            values[GUARDS * k + i], changes[GUARDS * k + i] = 1.0, 0.0
