"""Which corners on rigid bases bear: after an impact, :eq:`eq-projection`, or under new forces.

Corners are counted from the top down, those of each body from the left: corner ``2 k`` is the left
one of body ``k``. A set of them is a whole number, a bit for each.
"""

import math
from typing import Any, Final, NamedTuple

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.body import PIVOT_LEFT, PIVOT_RIGHT
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.motion import (
    FREE,
    NOT_ELIMINATED,
    add_constraint,
    combined_acceleration,
    normal_coriolis,
    reset_elimination,
    solve_motion,
    tangential_coriolis,
    write_jacobian,
)
from rockframe.dynamics.chain.rows import BODY_STRIDE, CONSTRAINT_STRIDE, MAX_CONSTRAINTS

LEFT_ONLY: Final = 1
RIGHT_ONLY: Final = 2
BOTH: Final = 3

FIRST_EXHAUSTIVE_COUNT: Final = 10
"""With this many closed corners or fewer, every subset of them is a candidate."""
FIRST_MAX_DIFFERENCES: Final = 3
"""With more, candidates of the first round differ from the solution of :eq:`eq-sticking` in at
most this many corners."""
LAST_EXHAUSTIVE_COUNT: Final = 16
"""With this many closed corners or fewer, the second round takes every other subset."""
LAST_MAX_DIFFERENCES: Final = 5
"""With more, candidates of the second round differ in at most this many corners."""
NOISE: Final = 1e-11
"""Rounding noise of impulses, or of speeds, over the sum of all of them [1]."""
ROUNDING: Final = 1e-12
"""Rounding noise of accelerations over gravity [1]."""
NEARLY_ZERO: Final = 1e-5
"""Acceleration of a corner over gravity that counts as zero as its force comes to zero [1]."""
JAMMED: Final = -2
"""In place of the leaving corner: no finite forces solve, and impulses must stop a slip."""
ALL_SLIPS_ROUND: Final = 4
"""Number of the round of candidates in which all combinations of slips are tried."""
MAX_PIVOTS: Final = 1000
"""Most changes of the set in the search with sticking assumed, which needs a few."""


class Trial(NamedTuple):
    """Outcome for a candidate set: the first corner that violates a condition, or -1, and loss."""

    violation: int
    loss: float


class BearingCorners(NamedTuple):
    """The corners that bear."""

    chosen: int  # the set of them
    admissible: int  # number of admissible sets
    next_best: int  # the next best set, or -1
    held: int  # where none is admissible, a corner that is held though it does not press; else 0


@kernel
def bit_count(corners: int) -> int:
    """Return the number of members of a set, which has a bit for each."""
    rest, count = corners, 0
    while rest > 0:
        count += rest & 1
        rest >>= 1
    return count


class NearbySubsets(NamedTuple):
    """The subsets of `closed` that differ from `reference` in at most a number of corners."""

    closed: int
    reference: int
    max_differences: int


@kernel
def next_subset(start: int, near: NearbySubsets) -> int:
    """Return the highest number of a set that is not above `start`; -1 if there is none.

    `start` is the number of all closed corners, or that of a set less one.
    """
    subset = start & near.closed if start >= 0 else -1
    while subset >= 0:
        rest = subset ^ near.reference
        for _ in range(bit_count(rest) - near.max_differences - 1):
            rest &= rest - 1
        corner = rest & -rest  # the highest corner in which the sets must not differ
        if bit_count(rest) <= near.max_differences:
            break
        above = subset & ~(2 * corner - 1)
        if subset & corner != 0:
            subset = above | near.reference & (corner - 1)
            break
        subset = (above - 1) & near.closed if above > 0 else -1
    return subset


@inlined
def add_rigid_base_constraints(
    system: Any, k: int, count: int, bears: int, held: int, sense: float, impulsive: bool,
    work: Vector, rows: Vector,
) -> int:  # fmt: skip
    """Add the constraints of a body on a rigid base; return the number of all so far."""
    i = k * BODY_STRIDE
    work[i + at.LEFT_CONSTRAINT] = work[i + at.RIGHT_CONSTRAINT] = -1.0
    if held == 0:
        return count
    # where both corners are closed all points of the base move with one velocity
    pivot = 0 if held == LEFT_ONLY else 1
    reach, stays = work[i + at.CORNER_ARMS + pivot], work[i + at.TANGENTIAL_PRESCRIBED + pivot]
    for side in range(2):
        if bears >> side & 1 != 0:
            lever, rests = work[i + at.CORNER_LEVERS + side], work[i + at.NORMAL_PRESCRIBED + side]
            add_constraint(system, count, k, 0.0, 1.0, lever, rests, work, rows)
            work[i + at.LEFT_CONSTRAINT + side] = count
            system.add_corner_friction(k, count, sense, reach, impulsive, work, rows)
            count += 1
    if sense == 0.0:
        work[i + at.TANGENTIAL_CONSTRAINT] = count
        add_constraint(system, count, k, 1.0, 0.0, -reach, stays, work, rows)
        count += 1
    return count


@kernel
def solve_trial(
    system: Any, mode: int, subset: int, closed: int, sticks: bool, impulsive: bool, noise: float,
    state: Vector,
) -> Trial:  # fmt: skip
    """Solve with a `subset` of the closed corners constrained, and check the solution.

    Bodies fly in `mode`. Solves for impulses, or for forces under the loads in the workspace. With
    `sticks` every body with a closed corner is held along its base, else only those that bear.
    Speeds or accelerations up to `noise` are rounding.
    """
    work, rows = system.workspace(), system.constraints()
    count, start, same = 0, 0, True
    # from the bottom up: successive candidates differ in the highest bodies
    for k in range(system.body_count - 1, -1, -1):
        i, body_mode = k * BODY_STRIDE, system.body_mode(mode, k)
        bears, touches = subset >> 2 * k & BOTH, closed >> 2 * k & BOTH
        held = touches | bears if sticks else bears
        sense = 0.0 if sticks else system.trial_sense(k)
        tried = NOT_ELIMINATED  # or a code by which equal trials of a body are recognized
        if system.is_rigid(k):
            tried = bears + 4.0 * held + 16.0 * (sense + 1.0) + (64.0 if impulsive else 0.0)
        if same and tried == work[i + at.TRIAL_CODE] and tried != NOT_ELIMINATED:
            count = start = int(work[i + at.CONSTRAINT_COUNT])
            continue
        same, work[i + at.TRIAL_CODE] = False, tried
        if not system.is_rigid(k):
            if not impulsive:
                count = system.add_trial_constraint(k, count, body_mode, state, work, rows)
            elif work[i + at.HOLD_STATE] != FREE:
                add_constraint(system, count, k, 1.0, 0.0, -work[i + at.PIVOT_ARM], 0.0, work, rows)
                count += 1
        else:
            count = add_rigid_base_constraints(
                system, k, count, bears, held, sense, impulsive, work, rows
            )
        work[i + at.CONSTRAINT_COUNT] = count
    band, matrix = system.half_bandwidth(), system.constraint_matrix()
    solve_motion(system, system.body_count, start, count, band, work, rows, matrix)
    loss = pressing = 0.0
    for which in range(count):
        first = which * CONSTRAINT_STRIDE
        force, k = rows[first + at.FORCE], int(rows[first + at.CONSTRAINED_BODY])
        loss += 0.5 * force * rows[first + at.PRESCRIBED]
        if system.is_rigid(k):
            loss += system.friction_loss(k, which, state, work, rows)
        pressing += abs(force)
    violation = first_violation(system, subset, closed, impulsive, NOISE * pressing, noise)
    return Trial(violation, loss)


@kernel
def write_trial_data(system: Any, impulsive: bool, state: Vector) -> None:
    """Write what all trials have in common: levers, and the values prescribed at rest."""
    work = system.workspace()
    reset_elimination(system, work)
    for k in range(system.body_count):
        if system.is_rigid(k):
            i, part, body = k * BODY_STRIDE, system.on_base(k), system.state_of(k, state)
            attitude, rate = part.body.attitude(body.rotation), body.angular_velocity
            line = part.body.base_line(body, attitude)
            bends = part.body.end_accelerations(attitude, rate, 0.0, 0.0)
            work[i + at.CORNER_LEVERS] = line.left_lever
            work[i + at.CORNER_LEVERS + 1] = line.right_lever
            work[i + at.NORMAL_PRESCRIBED] = -line.left_speed
            work[i + at.NORMAL_PRESCRIBED + 1] = -line.right_speed
            for side in range(2):
                pin = part.body.pin(PIVOT_LEFT if side == 0 else PIVOT_RIGHT)
                reach = part.body.reach(pin, attitude)
                work[i + at.CORNER_ARMS + side] = reach.derivative
                work[i + at.TANGENTIAL_PRESCRIBED + side] = (
                    reach.derivative * rate - body.horizontal_velocity
                )
                if not impulsive:
                    along = tangential_coriolis(i, work) + reach.second_derivative * rate * rate
                    work[i + at.TANGENTIAL_PRESCRIBED + side] = along
                    work[i + at.NORMAL_PRESCRIBED + side] = -normal_coriolis(i, work) - bends[side]


@kernel
def first_violation(
    system: Any, subset: int, closed: int, impulsive: bool, least: float, noise: float
) -> int:
    """Return the first corner that violates :eq:`eq-admissible`; -1 if none does."""
    work, rows, above = system.workspace(), system.constraints(), 0.0
    for corner in range(2 * system.body_count):
        k, side = corner // 2, corner % 2
        if side == 0:  # the mass that the body's base carries
            above += system.row_value(k, at.MASS)
        if closed >> corner & 1 == 0:
            continue
        if subset >> corner & 1 != 0:
            which = int(work[k * BODY_STRIDE + at.LEFT_CONSTRAINT + side])
            # where no corner closes all impulses are rounding
            none = noise * above if impulsive else 0.0
            if rows[which * CONSTRAINT_STRIDE + at.FORCE] < -least - none:
                return corner
            continue
        # as a corner separates under new forces, both its force and its acceleration are zero
        least_rise = noise if impulsive else -noise
        if free_corner_rise(system, k, side) <= least_rise:
            return corner
    return -1


@kernel
def free_corner_rise(system: Any, k: int, side: int) -> float:
    """Return upward velocity, or acceleration, of a free corner by the last solution."""
    work, rows, i = system.workspace(), system.constraints(), k * BODY_STRIDE + side
    unused = MAX_CONSTRAINTS * system.body_count - 1  # a row that no constraint needs
    jacobian = unused * CONSTRAINT_STRIDE + at.JACOBIAN
    write_jacobian(system, k, 0.0, 1.0, work[i + at.CORNER_LEVERS], jacobian, work, rows)
    rise = combined_acceleration(system.body_count, k, jacobian, work, rows)
    return float(rise - work[i + at.NORMAL_PRESCRIBED])


@kernel
def trial_noise(system: Any, closed: int, impulsive: bool, state: Vector) -> float:
    """Return the rounding noise of the speeds of corners, or of their accelerations."""
    work, scale = system.workspace(), 0.0
    if not impulsive:
        return NEARLY_ZERO * system.row_value(0, at.GRAVITY)
    for corner in range(2 * system.body_count):
        if closed >> corner & 1 != 0:
            k = corner // 2
            i, body = k * BODY_STRIDE + corner % 2, system.state_of(k, state)
            speed = work[i + at.CORNER_LEVERS] * body.angular_velocity
            scale += abs(work[i + at.NORMAL_PRESCRIBED]) + abs(speed)
            scale += abs(body.horizontal_velocity)
    return NOISE * scale


@kernel
def find_bearing_corners(
    system: Any, mode: int, closed: int, in_tension: int, before: int, leaving: int, state: Vector
) -> BearingCorners:
    """Find the closed corners that bear, beside those `in_tension`, which are held in any case.

    After an impact (`leaving` 0): the admissible set that loses the least energy; if there is none,
    the solution with sticking assumed, which is unique. Under new forces, as the force of the
    corner `leaving` has come to zero or, if it is negative, friction has changed: the admissible
    set nearest to `before`, which bore so far; if there is none, first all combinations of slips
    are tried, then sets of which one corner is held though it does not press. If `leaving` is
    JAMMED, impulses have to stop a slip.
    """
    impulsive, count = leaving in (0, JAMMED), bit_count(closed)
    write_trial_data(system, impulsive, state)
    noise = trial_noise(system, closed, impulsive, state)
    near = NearbySubsets(closed, closed, count)
    far = near
    if count > FIRST_EXHAUSTIVE_COUNT:
        reference = find_sticking_corners(system, mode, closed, impulsive, noise, state)
        near = NearbySubsets(closed, reference, FIRST_MAX_DIFFERENCES)
        differences = count if count <= LAST_EXHAUSTIVE_COUNT else LAST_MAX_DIFFERENCES
        far = NearbySubsets(closed, reference, differences)
    chosen, other, admissible, held = -1, -1, 0, 0
    must_press = ~before | max(leaving, 0)  # the leaving corner, too, if it is to bear on
    lowest = second = math.inf
    # first sets that are admissible within rounding; in each round first the near ones
    for trial_round in range(2 if impulsive else 1 + ALL_SLIPS_ROUND):
        if trial_round % 2 == 1 and count <= FIRST_EXHAUSTIVE_COUNT:
            continue  # there are no sets farther off
        tried = near if trial_round % 2 == 0 else far
        subset = next_subset(closed, tried)
        search = JAMMED if leaving == JAMMED else trial_round
        least = (
            noise if impulsive or trial_round > 1 else ROUNDING * system.row_value(0, at.GRAVITY)
        )
        while subset >= 0:
            bears = subset | in_tension
            if leaving <= 0 or bears != before:
                trial = solve_subset(system, search, mode, bears, closed, impulsive, least, state)
                if trial.violation < 0 and (
                    impulsive or all_in_compression(system, bears & must_press)
                ):
                    loss = trial.loss if impulsive else float(bit_count(bears ^ before))
                    admissible += 1
                    if loss < lowest:
                        other, second, chosen, lowest = chosen, lowest, bears, loss
                    elif loss < second:
                        other, second = bears, loss
            subset = next_subset(subset - 1, tried)
        if admissible > 0:  # its solution stays in the workspace
            solve_subset(system, search, mode, chosen, closed, impulsive, least, state)
            return BearingCorners(chosen, admissible, other, 0)
    if impulsive:
        chosen = find_sticking_corners(system, mode, closed, impulsive, noise, state)
    else:
        chosen, held = find_held_corner(
            system, mode, near, in_tension, before, leaving, noise, state
        )
        if held == 0:
            chosen = before if leaving < 0 else before & ~leaving
    return BearingCorners(chosen, admissible, other, held)


@kernel
def solve_subset(
    system: Any, search: int, mode: int, subset: int, closed: int, impulsive: bool, noise: float,
    state: Vector,
) -> Trial:  # fmt: skip
    """Solve with a set of the closed corners bearing, and search for the slips."""
    if search == JAMMED:
        return system.try_stopping_slips(mode, subset, closed, noise, state)
    if search == ALL_SLIPS_ROUND:
        return system.try_all_slips(mode, subset, closed, noise, state)
    return system.try_corners(mode, subset, closed, impulsive, noise, state)


@kernel
def find_held_corner(
    system: Any, mode: int, near: NearbySubsets, in_tension: int, before: int, leaving: int,
    noise: float, state: Vector,
) -> tuple[int, int]:  # fmt: skip
    """Return a set of corners, one of which is held though it does not press, and that corner.

    It is the only corner of its body in the set. Without it the set would not be admissible: the
    corner would fall back, or another one would be in tension. Of several such sets the one
    nearest to `before` is chosen, preferably with `leaving` as the held corner. The corner is 0
    if there is none.
    """
    chosen, held, least, closed = before, 0, math.inf, near.closed
    subset, follower = before & closed, closed  # `before` comes first and excludes most others
    while subset >= 0:
        for corner in range(2 * system.body_count):
            corner_bit, bears = 1 << corner, subset | in_tension
            distance = 2 * bit_count(bears ^ before) + (0 if corner_bit == leaving else 1)
            if (
                subset & corner_bit == 0
                or not system.bears_alone(subset, corner_bit)
                or distance >= least
            ):
                continue
            trial = system.try_corners(mode, bears, closed & ~corner_bit, False, noise, state)
            pulls = system.corner_force(corner // 2, corner % 2 == 0) < 0.0
            if (
                trial.violation < 0
                and pulls
                and all_in_compression(system, bears & ~before & ~corner_bit)
            ):
                free = system.try_corners(mode, bears & ~corner_bit, closed, False, noise, state)
                if free.violation >= 0:
                    chosen, held, least = bears, corner_bit, distance
        subset = next_subset(follower, near)
        follower = subset - 1
    if held != 0:
        system.try_corners(mode, chosen, closed & ~held, False, noise, state)
    return chosen, held


@kernel
def all_in_compression(system: Any, corners: int) -> bool:
    """Whether all corners of a set are in compression, beyond rounding."""
    for corner in range(2 * system.body_count):
        if corners >> corner & 1 != 0:
            k = corner // 2
            least = NEARLY_ZERO * system.row_value(k, at.FORCE_SCALE)
            if system.corner_force(k, corner % 2 == 0) < least:
                return False
    return True


@kernel
def find_sticking_corners(
    system: Any, mode: int, closed: int, impulsive: bool, noise: float, state: Vector
) -> int:
    """Return the set of corners that bear by :eq:`eq-sticking`, found by least-index pivoting."""
    subset = closed
    for _ in range(MAX_PIVOTS):
        trial = solve_trial(system, mode, subset, closed, True, impulsive, noise, state)
        if trial.violation < 0:
            break
        subset ^= 1 << trial.violation
    return subset
