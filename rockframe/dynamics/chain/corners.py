"""Corners that bear on rigid bases: their constraints, and the placement they fix.

A corner that bears is held, normal to the base and along it, by forces that are solved for,
:eq:`eq-chain-solution`. Coordinates that a contact constrains are computed from those that it
leaves free, so that no drift builds up.
"""

import math
from typing import Final

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.base import SIMULTANEOUS, Variables
from rockframe.dynamics.bed import DOWN, RAISED, both_contacts
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, ROTATION, VERTICAL
from rockframe.dynamics.body import PIVOT_CENTRE, PIVOT_LEFT, PIVOT_RIGHT, Attitude, BodyState
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.any_base import ON_RIGID
from rockframe.dynamics.chain.impact import BOTH, LEFT_ONLY, RIGHT_ONLY, Trial, solve_trial
from rockframe.dynamics.chain.motion import FREE, add_constraint, normal_coriolis
from rockframe.dynamics.chain.rows import BODY_STRIDE, CONSTRAINT_STRIDE
from rockframe.dynamics.chain.system import Chain
from rockframe.dynamics.on_base import Mode
from rockframe.dynamics.pads import CORNER
from rockframe.dynamics.protocol import HELD_PLACE, Ground

NO_CONSTRAINT: Final = -1.0
"""In place of the number of a constraint."""
IN_TENSION: Final = CORNER
"""Added to the contact of a body whose corner is constrained though its force is one of tension:
released, it would fall back onto the base immediately."""
LEFT_CORNERS: Final = 0x55555555
"""The left corners of sixteen bodies, as a set."""
REST_TOLERANCE: Final = 1e-13
"""Share of a body's size, or of its speed of fall, below which a corner is at its base."""


class RigidCorners(Chain):
    """Stacked bodies, some of which stand on rigid bases. A mixin of systems."""

    __slots__ = ()

    @inlined
    def is_rigid(self, k: int) -> bool:
        """Whether a body stands on a rigid base."""
        return self.row_value(k, at.LAW) == ON_RIGID

    @inlined
    def half_bandwidth(self) -> int:
        """Return the half-width of the band of the matrix: those farther apart share no body."""
        return 5

    @kernel
    def bearing_corners(self, mode: int) -> int:
        """Return the set of corners on rigid bases that bear in a mode."""
        bearing = 0
        for k in range(self.body_count):
            if self.is_rigid(k):
                part, contact = self.on_base(k), self.body_mode(mode, k).contact
                bearing |= (1 if part.base.is_held(contact, True) else 0) << 2 * k
                bearing |= (2 if part.base.is_held(contact, False) else 0) << 2 * k
        return bearing

    @kernel
    def tension_corners(self, mode: int) -> int:
        """Return the set of corners that are held in a mode though they do not press."""
        in_tension, bearing = 0, self.bearing_corners(mode)
        for k in range(self.body_count):
            if self.is_rigid(k) and self.body_mode(mode, k).contact & IN_TENSION != 0:
                in_tension |= bearing & BOTH << 2 * k
        return in_tension

    @inlined
    def bears_alone(self, corners: int, corner: int) -> bool:
        """Whether a corner bears without the other one of its body."""
        even = corner & LEFT_CORNERS != 0
        return corners & (corner << 1 if even else corner >> 1) == 0

    @kernel
    def with_bearing_corners(self, mode: int, corners: int, in_tension: int) -> int:
        """Return the mode in which `corners` bear; those in `in_tension` are only held."""
        new = mode
        for k in range(self.body_count):
            if self.is_rigid(k):
                bears = corners >> 2 * k & BOTH
                contact = both_contacts(
                    DOWN if bears & LEFT_ONLY else RAISED, DOWN if bears & RIGHT_ONLY else RAISED
                )
                contact += IN_TENSION if in_tension >> 2 * k & BOTH != 0 else 0
                pivot = PIVOT_CENTRE
                if bears == LEFT_ONLY:
                    pivot = PIVOT_LEFT
                elif bears == RIGHT_ONLY:
                    pivot = PIVOT_RIGHT
                new = self.with_body_mode(new, k, Mode(contact, pivot, False))
                new = self.with_rigid_slip(k, bears, new)
        return new

    @kernel
    def constrained_state(self, k: int, body_mode: Mode, state: Vector) -> BodyState:
        """Return placement and rates of a body, with those that its contacts prescribe computed."""
        body, part = self.state_of(k, state), self.on_base(k)
        if not self.is_rigid(k) or part.flies(body_mode.contact):
            return body
        left = part.base.is_held(body_mode.contact, True)
        if left and part.base.is_held(body_mode.contact, False):
            return BodyState(0.0, 0.0, body.horizontal, 0.0, 0.0, body.horizontal_velocity)
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
    def add_corner_constraints(
        self, k: int, count: int, mode: int, state: Vector, moves: bool, work: Vector, rows: Vector
    ) -> int:
        """Add the constraints of corners that bear on a rigid base, :eq:`eq-rigid-corner`."""
        i, part, body_mode = k * BODY_STRIDE, self.on_base(k), self.body_mode(mode, k)
        work[i + at.LEFT_CONSTRAINT] = work[i + at.RIGHT_CONSTRAINT] = NO_CONSTRAINT
        if not self.is_rigid(k) or part.flies(body_mode.contact):
            return count
        body, a = self.constrained_state(k, body_mode, state), i + at.ATTITUDE
        attitude = Attitude(work[a], work[a + 1], work[a + 2])
        line = part.body.base_line(body, attitude)
        rate = body.angular_velocity if moves else 0.0
        bends = part.body.end_accelerations(attitude, rate, 0.0, 0.0)
        for side in range(2):
            if part.base.is_held(body_mode.contact, side == 0):
                lever = line.left_lever if side == 0 else line.right_lever
                prescribed = -normal_coriolis(i, work) - bends[side]
                add_constraint(self, count, k, 0.0, 1.0, lever, prescribed, work, rows)
                work[i + at.LEFT_CONSTRAINT + side] = count
                sense = self.sense_or_zero(mode, k) if moves else 0.0
                self.add_corner_friction(k, count, sense, work[i + at.PIVOT_ARM], False, work, rows)
                count += 1
        return count

    @inlined
    def trial_sense(self, k: int) -> float:
        """Return the sense of slip of a body on its rigid base in the present trial: 0, held."""
        return 0.0

    @inlined
    def sense_or_zero(self, mode: int, k: int) -> float:
        """Return the sense of slip of a body on its rigid base in a mode: 0, none slips here."""
        return 0.0

    @inlined
    def add_corner_friction(
        self, k: int, which: int, sense: float, reach: float, impulsive: bool, work: Vector,
        rows: Vector,
    ) -> None:  # fmt: skip
        """Add friction to the force of a corner that slips: none slips here."""

    @inlined
    def friction_loss(self, k: int, which: int, state: Vector, work: Vector, rows: Vector) -> float:
        """Return the energy that friction takes in an impact at a corner that slips: 0."""
        return 0.0

    @inlined
    def with_rigid_slip(self, k: int, bears: int, mode: int) -> int:
        """Return the mode with the slip of a body on its rigid base: none slips here."""
        return mode

    @inlined
    def restore_trial_slips(self, mode: int, impulsive: bool) -> None:
        """Restore the slips of a mode for the next trial: none slips here."""

    @inlined
    def write_free_slips(self, mode: int, state: Vector) -> None:
        """Write the senses in which bodies in flight would slip on landing: none slips here."""

    @inlined
    def write_slip_guards(
        self, k: int, mode: int, state: Vector, values: Vector, changes: Vector
    ) -> None:
        """Write the guards of friction: there is none here."""

    @inlined
    def release_all(self, mode: int, state: Vector, memory: Vector) -> int:
        """Return the mode itself: friction holds no bodies here that could be released, or slip."""
        return mode

    resume_slips = with_deformable_slips = release_all

    @inlined
    def add_trial_constraint(
        self, k: int, count: int, body_mode: Mode, state: Vector, work: Vector, rows: Vector
    ) -> int:
        """Add the constraint of a body on a deformable base, in a trial of corners."""
        return self.add_hold_or_slide(k, count, body_mode, state, work, rows)

    @inlined
    def try_corners(
        self, mode: int, subset: int, closed: int, impulsive: bool, noise: float, state: Vector
    ) -> Trial:
        """Solve with a set of the closed corners bearing, each held against sliding."""
        return solve_trial(self, mode, subset, closed, False, impulsive, noise, state)

    @inlined
    def try_all_slips(
        self, mode: int, subset: int, closed: int, noise: float, state: Vector
    ) -> Trial:
        """Try other slips with a set of closed corners that bear: none slips here."""
        return Trial(0, math.inf)

    try_stopping_slips = try_all_slips

    @inlined
    def solve_standing(self, mode: int, corners: int, state: Vector) -> None:
        """Find impulses by which bodies stand on a set of corners, each held against sliding."""
        solve_trial(self, mode, corners, corners, False, True, 0.0, state)

    @kernel
    def complete_solution(self, work: Vector, out: Vector) -> None:
        """Write the friction of slipping bodies; set accelerations to zero in full contact."""
        for k in range(self.body_count):
            i = k * BODY_STRIDE
            left, right = work[i + at.LEFT_CONSTRAINT], work[i + at.RIGHT_CONSTRAINT]
            if not self.is_rigid(k) or (left == NO_CONSTRAINT and right == NO_CONSTRAINT):
                continue
            if work[i + at.HOLD_STATE] == FREE:
                press = self.corner_force(k, True) + self.corner_force(k, False)
                work[i + at.TANGENTIAL_FORCE] = work[i + at.FRICTION_RATIO] * press
            if left != NO_CONSTRAINT and right != NO_CONSTRAINT:
                first = BEFORE_HORIZONTAL * k
                out[first + ROTATION] = out[first + VERTICAL] = 0.0
                if work[i + at.HOLD_STATE] != FREE:
                    out[self.horizontal_of(k)] = 0.0

    @kernel
    def corner_force(self, k: int, left: bool) -> float:
        """Return the normal force, or impulse, of a corner on a rigid base in the last solution."""
        i = k * BODY_STRIDE + (at.LEFT_CONSTRAINT if left else at.RIGHT_CONSTRAINT)
        which = self.workspace()[i]
        if which == NO_CONSTRAINT:
            return 0.0
        return float(self.constraints()[int(which) * CONSTRAINT_STRIDE + at.FORCE])

    @kernel
    def accelerate(self, mode: int, state: Vector, ground: Ground) -> Vector:
        """Return accelerations and powers, solved without the bodies at rest on the ground."""
        moving = self.moving_body_count(mode)
        if moving == self.body_count:
            return self.find_forces(mode, state, ground)
        if moving == 0 and self.variables() == 0:
            out = self.slopes()
            for i in range(len(out)):
                out[i] = 0.0
            return out
        return self.accelerate_bodies(moving, mode, state, ground)

    @inlined
    def moving_body_count(self, mode: int) -> int:
        """Return how many bodies, from the top, may move: those below rest on the ground."""
        moving, bearing = self.body_count, self.bearing_corners(mode)
        for k in range(self.body_count - 1, -1, -1):
            if bearing >> 2 * k & BOTH != BOTH or self.body_mode(mode, k).slides:
                break
            moving = k
        return moving

    @inlined
    def base_columns(self, k: int, mode: int, body: BodyState) -> Variables:
        """Return the base's columns in the results: of a rigid one, the forces of its corners."""
        if self.is_rigid(k):
            return self.corner_force(k, True), self.corner_force(k, False), 0.0
        return self.deformable_base_columns(k, mode, body)

    @inlined
    def position_from_pin(
        self, k: int, body_mode: Mode, held: float, state: Vector
    ) -> tuple[float, float]:
        """Return place of a body along its base, and its rate, from the place of its held point."""
        law, body = self.on_base(k).body, self.constrained_state(k, body_mode, state)
        reach = law.reach_about(body_mode.pivot, body.rotation)
        place = held + law.from_pivot(body_mode.pivot, body.rotation)
        return place, reach.derivative * body.angular_velocity

    @kernel
    def resting_corners(self, mode: int, state: Vector) -> int:
        """Return the set of corners on rigid bases that touch their base and are at rest."""
        resting = 0
        for k in range(self.body_count):
            if self.is_rigid(k):
                body = self.constrained_state(k, self.body_mode(mode, k), state)
                resting |= self.level_corners(k, body) << 2 * k
        return resting

    @inlined
    def closed_corners(self, mode: int, state: Vector) -> int:
        """Return the closed corners: those that bear, and others that touch their base at rest."""
        return self.bearing_corners(mode) | self.resting_corners(mode, state)

    @kernel
    def level_corners(self, k: int, body: BodyState) -> int:
        """Return the set of corners of a body that touch its base and are at rest, bits 1 and 2."""
        law, corners = self.on_base(k).body, 0
        line, size = law.base_line_at(body), law.size()
        level, speed = REST_TOLERANCE * size, REST_TOLERANCE * math.sqrt(law.gravity * size)
        if abs(line.left) <= level and abs(line.left_speed) <= speed:
            corners |= LEFT_ONLY
        if abs(line.right) <= level and abs(line.right_speed) <= speed:
            corners |= RIGHT_ONLY
        return corners

    @kernel
    def move_onto_base(self, k: int, left: bool, body_mode: Mode, state: Vector) -> int:
        """Move a landing corner exactly onto its base; return the set of corners that touch it."""
        part, first = self.on_base(k), BEFORE_HORIZONTAL * k
        line = part.body.base_line_at(self.state_of(k, state))
        both = not part.flies(body_mode.contact)
        both |= abs(line.left - line.right) <= SIMULTANEOUS * part.body.angle * part.body.size()
        if both:
            state[first + ROTATION] = state[first + VERTICAL] = 0.0
            return BOTH << 2 * k
        state[first + VERTICAL] -= line.left if left else line.right
        return (LEFT_ONLY if left else RIGHT_ONLY) << 2 * k

    @kernel
    def project_onto_contacts(self, mode: int, state: Vector, memory: Vector) -> None:
        """Write to the state the coordinates and rates that contacts with rigid bases prescribe."""
        n = self.coordinates()
        for k in range(self.body_count):
            part, body_mode = self.on_base(k), self.body_mode(mode, k)
            if self.is_rigid(k) and not part.flies(body_mode.contact):
                body = self.constrained_state(k, body_mode, state)
                first = BEFORE_HORIZONTAL * k
                state[first + ROTATION], state[first + VERTICAL] = body.rotation, body.vertical
                state[n + first + ROTATION] = body.angular_velocity
                state[n + first + VERTICAL] = body.vertical_velocity
                if not body_mode.slides:
                    place, rate = self.position_from_pin(
                        k, body_mode, memory[HELD_PLACE + k], state
                    )
                    self.set_horizontal(k, place, rate, state)

    @kernel
    def fix_held_points(self, mode: int, state: Vector, memory: Vector) -> None:
        """Store the present places of the held points of a mode, with consistent velocities."""
        for k in range(self.body_count):
            part, body_mode = self.on_base(k), self.body_mode(mode, k)
            if self.is_rigid(k) and not part.is_free(body_mode):
                rotation = self.constrained_state(k, body_mode, state).rotation
                away = part.body.from_pivot(body_mode.pivot, rotation)
                memory[HELD_PLACE + k] = state[self.horizontal_of(k)] - away
        self.project_onto_contacts(mode, state, memory)
        self.store_held_place(mode, state, memory)

    @inlined
    def store_held_place(self, mode: int, state: Vector, memory: Vector) -> None:
        """Write the place of the lowest held point to the state: nothing reads it here."""
