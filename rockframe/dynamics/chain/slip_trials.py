"""Which corners on rigid bases bear and which bodies slip, found together.

The row of a body says whether its base is rigid or deformable, and has friction. On a rigid base
friction holds the body up to its bound, :eq:`eq-stack-friction`; beyond, the force at each corner
that bears includes kinetic friction, :eq:`eq-stack-slip`. On a deformable base the normal force is
known, :eq:`eq-mixed-slips`. Conditions are :eq:`eq-mixed-conditions` under new forces,
:eq:`eq-stack-impact` after an impact.
"""

import math
from typing import Final

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.body import PIVOT_LEFT, PIVOT_RIGHT
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.corners import NO_CONSTRAINT
from rockframe.dynamics.chain.impact import (
    BOTH,
    LEFT_ONLY,
    NOISE,
    ROUNDING,
    Trial,
    bit_count,
    solve_trial,
)
from rockframe.dynamics.chain.motion import (
    add_constraint,
    combined_acceleration,
    tangential_coriolis,
    write_jacobian,
)
from rockframe.dynamics.chain.rigid import RigidChain
from rockframe.dynamics.chain.rows import BODY_STRIDE, CONSTRAINT_STRIDE, MAX_CONSTRAINTS
from rockframe.dynamics.chain.slippery import SlipperyBases
from rockframe.dynamics.chain.slips import IMPULSIVE, KINETIC, MAX_SLIP_CHANGES, STATIC
from rockframe.dynamics.on_base import SPEED_ROUNDING, Mode

NO_PIVOT: Final = -1
"""In place of a pivot, where a body neither slips nor is held by friction."""
FRICTIONLESS: Final = 0.5
"""In place of a sense of 1, of a slip on which friction does not act."""
MAX_COMBINATIONS: Final = 81
"""Most combinations of slips tried for a set of corners; each base is held or slips to a side."""


class SlipTrials(SlipperyBases, RigidChain):
    """Trials of corners on rigid bases with bodies that may slip. A mixin of systems."""

    __slots__ = ()

    @inlined
    def trial_sense(self, k: int) -> float:
        """Return the sense of slip of a body on its base in the present trial: 0, held."""
        return float(self.workspace()[k * BODY_STRIDE + at.SLIP_SENSE])

    @inlined
    def sense_or_zero(self, mode: int, k: int) -> float:
        """Return the sense of slip of a body on its base in a mode; 0 if it does not slip."""
        if (self.is_rigid(k) or self.is_slippery(k)) and self.body_mode(mode, k).slides:
            return self.sense(mode, k)
        return 0.0

    @inlined
    def restore_trial_slips(self, mode: int, impulsive: bool) -> None:
        """Restore the slips of a mode for the next trial; none in an impact, where all are held."""
        for k in range(self.body_count):
            sense = 0.0 if impulsive else self.sense_or_zero(mode, k)
            self.workspace()[k * BODY_STRIDE + at.SLIP_SENSE] = sense

    @kernel
    def with_rigid_slip(self, k: int, bears: int, mode: int) -> int:
        """Return the mode with the slip of a body on its rigid base in the last trial."""
        sense = self.trial_sense(k)
        if bears != 0 and sense != 0.0:
            return self.with_slip_sense(mode, k, sense)
        value = self.body_mode_count() * 2**k
        return mode - mode // value % 2 * value

    @kernel
    def with_deformable_slips(self, mode: int, state: Vector, memory: Vector) -> int:
        """Return the mode with the slips on deformable bases of the last trial."""
        for k in range(self.body_count):
            if self.is_slippery(k) and not self.on_base(k).flies(self.body_mode(mode, k).contact):
                mode = self.with_slip(k, self.trial_sense(k), mode, state, memory)
        return mode

    @kernel
    def add_trial_constraint(
        self, k: int, count: int, body_mode: Mode, state: Vector, work: Vector, rows: Vector
    ) -> int:
        """Hold a body on a deformable base, or load it by friction, in the present trial."""
        if not self.is_slippery(k) or self.on_base(k).flies(body_mode.contact):
            return self.add_hold_or_slide(k, count, body_mode, state, work, rows)
        i, sense = k * BODY_STRIDE, self.trial_sense(k)
        self.set_friction_load(k, sense, work)
        if sense == 0.0:
            prescribed = tangential_coriolis(i, work) + work[i + at.PIVOT_CENTRIPETAL]
            arm = work[i + at.PIVOT_ARM]
            add_constraint(self, count, k, 1.0, 0.0, -arm, prescribed, work, rows)
            work[i + at.TANGENTIAL_CONSTRAINT] = count
            count += 1
        return count

    @inlined
    def bearing_pivot(self, bears: int) -> int:
        """Return the pivot at the corners that bear: if both do, they have the same velocity."""
        return PIVOT_LEFT if bears == LEFT_ONLY else PIVOT_RIGHT

    @inlined
    def normal_force(self, k: int) -> float:
        """Return the normal force of a body's base on it, or its impulse."""
        if self.is_rigid(k):
            return self.corner_force(k, True) + self.corner_force(k, False)
        return float(self.workspace()[k * BODY_STRIDE + at.NORMAL_FORCE])

    @kernel
    def write_free_slips(self, mode: int, state: Vector) -> None:
        """Write the senses in which bodies in flight over rigid bases would slip on landing."""
        bearing, work = self.bearing_corners(mode), self.workspace()
        for k in range(self.body_count):
            if self.is_rigid(k) and bearing >> 2 * k & BOTH == 0:
                rate, noise = self.pivot_slip_rate(k, self.bearing_pivot(BOTH), state)
                slips = abs(rate) > noise and self.friction_coefficient(k, IMPULSIVE) < math.inf
                work[k * BODY_STRIDE + at.SLIP_SENSE] = math.copysign(1.0, rate) if slips else 0.0

    @kernel
    def add_corner_friction(
        self, k: int, which: int, sense: float, reach: float, impulsive: bool, work: Vector,
        rows: Vector,
    ) -> None:  # fmt: skip
        """Add friction to the force of a corner that slips, :eq:`eq-stack-slip`."""
        direction, i, ratio = which * CONSTRAINT_STRIDE + at.FORCE_DIRECTION, k * BODY_STRIDE, 0.0
        if abs(sense) == 1.0:
            ratio = -sense * self.friction_coefficient(k, IMPULSIVE if impulsive else KINETIC)
            x, y = ratio * work[i + at.COSINE], -ratio * work[i + at.SINE]
            rows[direction] += x
            rows[direction + 1] += y
            rows[direction + 2] -= ratio * reach
            rows[which * CONSTRAINT_STRIDE + at.UNSYMMETRIC] = 1.0
            if k + 1 < self.body_count:
                rows[direction + 3] -= x
                rows[direction + 4] -= y
                rows[direction + 5] += ratio * (reach - work[i + at.NORMAL])
        work[i + at.FRICTION_RATIO] = ratio

    @kernel
    def friction_loss(self, k: int, which: int, state: Vector, work: Vector, rows: Vector) -> float:
        """Return the energy that friction takes in an impact at a corner that slips."""
        first, ratio = which * CONSTRAINT_STRIDE, work[k * BODY_STRIDE + at.FRICTION_RATIO]
        if ratio == 0.0:
            return 0.0
        # both corners have the same slip where both bear
        left = work[k * BODY_STRIDE + at.LEFT_CONSTRAINT] != NO_CONSTRAINT
        slip, _ = self.pivot_slip_rate(k, PIVOT_LEFT if left else PIVOT_RIGHT, state)
        direction = first + at.FORCE_DIRECTION
        excess = combined_acceleration(self.body_count, k, direction, work, rows)
        excess -= rows[first + at.PRESCRIBED]
        return float(-rows[first + at.FORCE] * (ratio * slip + 0.5 * excess))

    @kernel
    def needs_new_impulses(self, closed: int, mode: int) -> bool:
        """Whether impulses must be found again: friction or tension acted.

        Or a closed corner had no impulse, as it did not bear before.
        """
        work = self.workspace()
        for k in range(self.body_count):
            i = k * BODY_STRIDE
            acts = work[i + at.LEFT_IMPULSE] != 0.0 or work[i + at.RIGHT_IMPULSE] != 0.0
            if acts and self.friction_coefficient(k, IMPULSIVE) < math.inf:
                return True
        return self.has_tension_impulse() or closed != self.bearing_corners(mode)

    @kernel
    def try_corners(
        self, mode: int, subset: int, closed: int, impulsive: bool, noise: float, state: Vector
    ) -> Trial:
        """Solve with a set of the closed corners bearing; find which bodies slip, base by base.

        In an impact the velocities after it decide. Under new forces, slipping bodies continue to
        slip, and held ones start to slip if friction cannot hold them.
        """
        self.write_first_slips(mode, subset, impulsive, state)
        trial = Trial(0, math.inf)
        most = MAX_SLIP_CHANGES * self.body_count
        # where static friction leads to no solution, kinetic friction decides what is held
        for tries in range(2 * most):
            coefficient = IMPULSIVE if impulsive else STATIC if tries < most else KINETIC
            trial = solve_trial(self, mode, subset, closed, False, impulsive, noise, state)
            k = self.correct_one_slip(mode, subset, closed, impulsive, coefficient, noise, state)
            if k < 0:
                return trial
        return Trial(max(trial.violation, 0), math.inf)

    @kernel
    def write_first_slips(self, mode: int, subset: int, impulsive: bool, state: Vector) -> int:
        """Write the first slips of a trial; return the set of bodies whose slip is undecided."""
        work, undecided = self.workspace(), 0
        for k in range(self.body_count):
            i, pivot = k * BODY_STRIDE, self.trial_pivot(k, mode, subset, impulsive)
            work[i + at.SLIP_SENSE] = 0.0
            slips = pivot != NO_PIVOT and self.friction_coefficient(k, STATIC) < math.inf
            if slips and not impulsive:
                work[i + at.SLIP_SENSE] = work[i + at.STARTING_SENSE]
                rate, least = self.slip_before_trial(k, pivot, mode, state)
                if abs(rate) > least:
                    work[i + at.SLIP_SENSE] = math.copysign(1.0, rate)
                else:
                    undecided |= 1 << k
        return undecided

    @kernel
    def try_all_slips(
        self, mode: int, subset: int, closed: int, noise: float, state: Vector
    ) -> Trial:
        """Solve with a set of the closed corners bearing and the first consistent slips.

        The search base by base may fail where the slip of one body, say of an end on pads, makes
        another base push harder the more its slip is resisted.
        """
        undecided = self.write_first_slips(mode, subset, False, state)
        for combination in range(min(3 ** bit_count(undecided), MAX_COMBINATIONS)):
            self.write_combination(combination, undecided)
            trial = solve_trial(self, mode, subset, closed, False, False, noise, state)
            k = self.correct_one_slip(mode, subset, closed, False, STATIC, noise, state)
            if trial.violation < 0 and k < 0:
                return trial
        return Trial(0, math.inf)

    @inlined
    def write_combination(self, combination: int, bodies: int) -> None:
        """Write the slips of a set of bodies: digits of `combination` in base 3."""
        for k in range(self.body_count):
            if bodies >> k & 1 != 0:
                self.workspace()[k * BODY_STRIDE + at.SLIP_SENSE] = float((combination + 1) % 3 - 1)
                combination //= 3

    @kernel
    def trial_combination(self) -> int:
        """Return the number, in base 3, of the slips of all bodies in the present trial."""
        combination = 0
        for k in range(self.body_count - 1, -1, -1):
            sense = int(self.workspace()[k * BODY_STRIDE + at.SLIP_SENSE])
            combination = 3 * combination + sense % 3
        return combination

    @kernel
    def count_other_solutions(
        self, mode: int, subset: int, closed: int, noise: float, state: Vector
    ) -> int:
        """Count the consistent combinations of slips on a set of corners other than the last one.

        A body that friction can hold, with the slips of the others unchanged, does not count as
        slipping: where only one body may slip there is one combination.
        """
        work, solutions, taken = self.workspace(), 0, self.trial_combination()
        undecided = self.write_first_slips(mode, subset, False, state)
        count = min(3 ** bit_count(undecided), MAX_COMBINATIONS)
        for combination in range(count if bit_count(undecided) > 1 else 0):
            self.write_combination(combination, undecided)
            counts = self.trial_combination() != taken
            counts = counts and self.is_admissible(mode, subset, closed, noise, state)
            for k in range(self.body_count):
                slips = work[k * BODY_STRIDE + at.SLIP_SENSE]
                if counts and undecided >> k & 1 != 0 and slips != 0.0:
                    work[k * BODY_STRIDE + at.SLIP_SENSE] = 0.0
                    held = solve_trial(self, mode, subset, closed, False, False, noise, state)
                    friction = self.friction_coefficient(k, STATIC)
                    counts = held.violation >= 0 or self.exceeds_friction(k, friction, False)
                    work[k * BODY_STRIDE + at.SLIP_SENSE] = slips
            solutions += 1 if counts else 0
        self.write_combination(taken, 2**self.body_count - 1)
        solve_trial(self, mode, subset, closed, False, False, noise, state)
        return solutions

    @kernel
    def is_admissible(
        self, mode: int, subset: int, closed: int, noise: float, state: Vector
    ) -> bool:
        """Whether a set of bearing corners with the present slips is admissible."""
        combination = self.trial_combination()
        trial = solve_trial(self, mode, subset, closed, False, False, noise, state)
        k = self.correct_one_slip(mode, subset, closed, False, STATIC, noise, state)
        self.write_combination(combination, 2**self.body_count - 1)
        return trial.violation < 0 and k < 0

    @kernel
    def solve_standing(self, mode: int, corners: int, state: Vector) -> None:
        """Find the impulses by which bodies stand on corners: some slip, others are held.

        A body whose slip would be reversed is held, too, since friction only opposes slip.
        Friction does not act at a base in tension, where it would drive the slip.
        """
        work, changed = self.workspace(), True
        self.write_slips_before_impact(mode, corners, state)
        while changed:
            changed = False
            solve_trial(self, mode, corners, corners, False, True, 0.0, state)
            for k in range(self.body_count):
                sense = work[k * BODY_STRIDE + at.SLIP_SENSE]
                if sense != 0.0:
                    pivot = self.trial_pivot(k, mode, corners, True)
                    rate, least = self.pivot_slip_rate(k, pivot, state)
                    after = self.slip_acceleration(k, pivot, True, state) + rate
                    if sense * after < -abs(sense) * (least + SPEED_ROUNDING * abs(after)):
                        work[k * BODY_STRIDE + at.SLIP_SENSE] = 0.0
                        changed = True
                    elif abs(sense) == 1.0 and self.normal_force(k) < 0.0:
                        work[k * BODY_STRIDE + at.SLIP_SENSE] = FRICTIONLESS * sense
                        changed = True

    @kernel
    def try_stopping_slips(
        self, mode: int, subset: int, closed: int, noise: float, state: Vector
    ) -> Trial:
        """Solve for impulses at a set of closed corners that stop a slip, each slip in turn."""
        work = self.workspace()
        for stopped in range(self.body_count):
            self.write_slips_before_impact(mode, subset, state)
            if work[stopped * BODY_STRIDE + at.SLIP_SENSE] == 0.0:
                continue
            work[stopped * BODY_STRIDE + at.SLIP_SENSE] = 0.0
            for _ in range(MAX_SLIP_CHANGES * self.body_count):
                trial = solve_trial(self, mode, subset, closed, False, True, noise, state)
                k = self.correct_one_slip(mode, subset, closed, True, IMPULSIVE, noise, state)
                if k < 0:
                    if trial.violation < 0 and work[stopped * BODY_STRIDE + at.SLIP_SENSE] == 0.0:
                        return trial
                    break
        return Trial(0, math.inf)

    @kernel
    def write_slips_before_impact(self, mode: int, subset: int, state: Vector) -> None:
        """Write the senses of the slips before an impact, of bodies that may slip in it."""
        for k in range(self.body_count):
            pivot, i = self.trial_pivot(k, mode, subset, True), k * BODY_STRIDE
            self.workspace()[i + at.SLIP_SENSE] = 0.0
            if pivot != NO_PIVOT and self.friction_coefficient(k, IMPULSIVE) < math.inf:
                rate, least = self.pivot_slip_rate(k, pivot, state)
                if abs(rate) > least:
                    self.workspace()[i + at.SLIP_SENSE] = math.copysign(1.0, rate)

    @inlined
    def trial_pivot(self, k: int, mode: int, subset: int, impulsive: bool) -> int:
        """Return the pivot at which a body is held or slips in a trial of corners, or `NO_PIVOT`.

        On a deformable base friction has no part in impacts.
        """
        bears, body_mode = subset >> 2 * k & BOTH, self.body_mode(mode, k)
        if self.is_rigid(k):
            return NO_PIVOT if bears == 0 else self.bearing_pivot(bears)
        idle = impulsive or self.on_base(k).flies(body_mode.contact)
        return NO_PIVOT if idle or not self.is_slippery(k) else body_mode.pivot

    @inlined
    def slip_before_trial(
        self, k: int, pivot: int, mode: int, state: Vector
    ) -> tuple[float, float]:
        """Return the velocity of slip before a trial of corners, and its rounding noise."""
        if not self.is_rigid(k) and not self.body_mode(mode, k).slides:
            return 0.0, 0.0  # held: the state need not have its velocity
        return self.pivot_slip_rate(k, pivot, state)

    @kernel
    def correct_one_slip(
        self, mode: int, subset: int, closed: int, impulsive: bool, coefficient: int, noise: float,
        state: Vector,
    ) -> int:  # fmt: skip
        """Correct the slip of one body in the present trial, and return its number; else -1.

        A held body slips if friction, of number `coefficient`, cannot hold it; a slipping one
        is held if it does not slip. Accelerations up to `noise` count as zero.
        """
        work = self.workspace()
        for k in range(self.body_count):
            i, pivot = k * BODY_STRIDE, self.trial_pivot(k, mode, subset, impulsive)
            friction = self.friction_coefficient(k, coefficient)
            in_tension = self.is_rigid(k) and subset & closed & BOTH << 2 * k == 0
            if pivot == NO_PIVOT or friction == math.inf or in_tension:
                continue
            sense = work[i + at.SLIP_SENSE]
            if sense == 0.0:
                if self.exceeds_friction(k, friction, impulsive):
                    work[i + at.SLIP_SENSE] = -math.copysign(1.0, self.holding_force(k))
                    return k
            else:
                rate, least = self.slip_before_trial(k, pivot, mode, state)
                if impulsive or abs(rate) <= least:
                    after = self.slip_acceleration(k, pivot, impulsive, state)
                    if impulsive:
                        after, least = after + rate, least + SPEED_ROUNDING * abs(after)
                    else:  # as it starts to slip, friction is what holds it
                        least = noise
                    if sense * after < -least:
                        work[i + at.SLIP_SENSE] = 0.0
                        return k
        return -1

    @inlined
    def holding_force(self, k: int) -> float:
        """Return the force along its base that holds a body in the present trial."""
        which = int(self.workspace()[k * BODY_STRIDE + at.TANGENTIAL_CONSTRAINT])
        return float(self.constraints()[which * CONSTRAINT_STRIDE + at.FORCE])

    @kernel
    def exceeds_friction(self, k: int, friction: float, impulsive: bool) -> bool:
        """Whether the force that holds a body in the present trial exceeds its friction."""
        press = self.normal_force(k)
        least = NOISE * abs(press)
        if not impulsive:  # a body that has just started to slip is not held at the bound
            least = ROUNDING * self.row_value(k, at.FORCE_SCALE)
            starts = self.workspace()[k * BODY_STRIDE + at.STARTING_SENSE] != 0.0
            least = -least if starts else least
        return abs(self.holding_force(k)) > friction * max(press, 0.0) + least

    @kernel
    def slip_acceleration(self, k: int, pivot: int, impulsive: bool, state: Vector) -> float:
        """Return the acceleration of the slip of a point, or its change in an impact."""
        i, part, body = k * BODY_STRIDE, self.on_base(k), self.state_of(k, state)
        work, rows, rate = self.workspace(), self.constraints(), body.angular_velocity
        reach = part.body.reach_about(pivot, body.rotation)
        spare = MAX_CONSTRAINTS * self.body_count - 1  # a slipping body has no hold: free
        jacobian = spare * CONSTRAINT_STRIDE + at.JACOBIAN
        write_jacobian(self, k, 1.0, 0.0, -reach.derivative, jacobian, work, rows)
        acceleration = combined_acceleration(self.body_count, k, jacobian, work, rows)
        if impulsive:
            return acceleration
        return acceleration - tangential_coriolis(i, work) - reach.second_derivative * rate * rate
