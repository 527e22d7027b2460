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
    UNKNOWN,
    add_constraint,
    coriolis_along,
    coriolis_normal,
    forget_trial,
    of_both,
    solve_motion,
    write_direction,
)
from rockframe.dynamics.chain.rows import CONSTRAINT, MOST_CONSTRAINTS, PLACES

LEFT_ONLY: Final = 1
RIGHT_ONLY: Final = 2
BOTH: Final = 3

ALL_TRIED: Final = 10
"""With this many closed corners or fewer, every subset of them is a candidate."""
NEIGHBOURS: Final = 3
"""With more, candidates of the first round differ from the solution of :eq:`eq-sticking` in at
most this many corners."""
MOST_TRIED: Final = 16
"""With this many closed corners or fewer, the second round takes every other subset."""
FAR_NEIGHBOURS: Final = 5
"""With more, candidates of the second round differ in at most this many corners."""
NOISE: Final = 1e-11
"""Rounding noise of impulses, or of speeds, over the sum of all of them [1]."""
ROUNDING: Final = 1e-12
"""Rounding noise of accelerations over gravity [1]."""
NEARLY_ZERO: Final = 1e-5
"""Acceleration of a corner over gravity that counts as zero as its force comes to zero [1]."""
JAMMED: Final = -2
"""In place of the corner that leaves: no finite forces solve, and impulses must stop a slip."""
ALL_WAYS: Final = 4
"""Number of the round of candidates in which all combinations of slips are tried."""
MOST_PIVOTS: Final = 1000
"""Most changes of the set in the search with sticking assumed, which needs a few."""


class Attempt(NamedTuple):
    """Outcome for a candidate set: the first corner at fault, or -1; energy lost in the impact."""

    fault: int
    loss: float


class Found(NamedTuple):
    """The set of corners that bear, the number of admissible sets, and the next best, or -1.

    `held` is the corner that must be held though it does not press, where none is admissible, or 0.
    """

    taken: int
    admissible: int
    other: int
    held: int


@kernel
def size_of(corners: int) -> int:
    """Return the number of corners in a set."""
    rest, count = corners, 0
    while rest > 0:
        count += rest & 1
        rest >>= 1
    return count


class Near(NamedTuple):
    """The subsets of `closed` that differ from `reference` in at most `most` corners."""

    closed: int
    reference: int
    most: int


@kernel
def next_set(start: int, near: Near) -> int:
    """Return the highest number of a set that is not above `start`; -1 if there is none.

    `start` is the number of all closed corners, or that of a set less one.
    """
    some = start & near.closed if start >= 0 else -1
    while some >= 0:
        rest = some ^ near.reference
        for _ in range(size_of(rest) - near.most - 1):
            rest &= rest - 1
        corner = rest & -rest  # the highest corner in which the sets must not differ
        if size_of(rest) <= near.most:
            break
        above = some & ~(2 * corner - 1)
        if some & corner != 0:
            some = above | near.reference & (corner - 1)
            break
        some = (above - 1) & near.closed if above > 0 else -1
    return some


@inlined
def trial_of(bears: int, holds: int, sense: float, impulsive: bool) -> float:
    """Return the code of a body's constraints in a trial, by which equal trials are recognized."""
    return bears + 4.0 * holds + 16.0 * (sense + 1.0) + (64.0 if impulsive else 0.0)


@inlined
def bear(
    system: Any, k: int, count: int, bears: int, holds: int, sense: float, impulsive: bool,
    room: Vector, rows: Vector,
) -> int:  # fmt: skip
    """Add the constraints of a body on a rigid base; return the number of all so far."""
    i = k * PLACES
    room[i + at.LEFT_CORNER] = room[i + at.RIGHT_CORNER] = -1.0
    if holds == 0:
        return count
    # where both corners are closed all points of the base move with one velocity
    pivot = 0 if holds == LEFT_ONLY else 1
    reach, stays = room[i + at.REACHES + pivot], room[i + at.STAYS + pivot]
    for side in range(2):
        if bears >> side & 1 != 0:
            lever, rests = room[i + at.LEVERS + side], room[i + at.RESTS + side]
            add_constraint(system, count, k, 0.0, 1.0, lever, rests, room, rows)
            room[i + at.LEFT_CORNER + side] = count
            system.rub(k, count, sense, reach, impulsive, room, rows)
            count += 1
    if sense == 0.0:
        room[i + at.HOLDS_ALONG] = count
        add_constraint(system, count, k, 1.0, 0.0, -reach, stays, room, rows)
        count += 1
    return count


@kernel
def attempt(
    system: Any, mode: int, some: int, closed: int, sticks: bool, impulsive: bool, noise: float,
    state: Vector,
) -> Attempt:  # fmt: skip
    """Solve with the set `some` of the closed corners constrained, and check the solution.

    Bodies fly in `mode`. Solves for impulses, or for forces under the loads in the workspace. With
    `sticks` every body with a closed corner is held along its base, else only those that bear.
    Speeds or accelerations up to `noise` are rounding.
    """
    room, rows = system.places(), system.constraints()
    count, start, same = 0, 0, True
    # from the bottom up: successive candidates differ in the highest bodies
    for k in range(system.body_count - 1, -1, -1):
        i, standing = k * PLACES, system.body_mode(mode, k)
        bears, touches = some >> 2 * k & BOTH, closed >> 2 * k & BOTH
        holds = touches | bears if sticks else bears
        sense = 0.0 if sticks else system.slip_sense(k)
        tried = trial_of(bears, holds, sense, impulsive) if system.is_rigid(k) else UNKNOWN
        if same and tried == room[i + at.TRIED] and tried != UNKNOWN:
            count = start = int(room[i + at.CONSTRAINTS])
            continue
        same, room[i + at.TRIED] = False, tried
        if not system.is_rigid(k):
            if not impulsive:
                count = system.hold_as_tried(k, count, standing, state, room, rows)
            elif room[i + at.HELD] != FREE:
                add_constraint(system, count, k, 1.0, 0.0, -room[i + at.REACH], 0.0, room, rows)
                count += 1
        else:
            count = bear(system, k, count, bears, holds, sense, impulsive, room, rows)
        room[i + at.CONSTRAINTS] = count
    solve_motion(
        system, system.body_count, start, count, system.band(), room, rows, system.matrix()
    )
    loss = pressing = 0.0
    for which in range(count):
        first = which * CONSTRAINT
        force, k = rows[first + at.FORCE], int(rows[first + at.BODY])
        loss += 0.5 * force * rows[first + at.VALUE]
        if system.is_rigid(k):
            loss += system.lost_by_friction(k, which, state, room, rows)
        pressing += abs(force)
    fault = first_fault(system, some, closed, impulsive, NOISE * pressing, noise)
    return Attempt(fault, loss)


@kernel
def write_corners(system: Any, impulsive: bool, state: Vector) -> None:
    """Write what all trials have in common: levers, and the values prescribed at rest."""
    room = system.places()
    forget_trial(system, room)
    for k in range(system.body_count):
        if system.is_rigid(k):
            i, part, body = k * PLACES, system.on_base(k), system.state_of(k, state)
            attitude, rate = part.body.attitude(body.rotation), body.angular_velocity
            line = part.body.base_line(body, attitude)
            bends = part.body.end_accelerations(attitude, rate, 0.0, 0.0)
            room[i + at.LEVERS], room[i + at.LEVERS + 1] = line.left_lever, line.right_lever
            room[i + at.RESTS], room[i + at.RESTS + 1] = -line.left_speed, -line.right_speed
            for side in range(2):
                pin = part.body.pin(PIVOT_LEFT if side == 0 else PIVOT_RIGHT)
                reach = part.body.reach(pin, attitude)
                room[i + at.REACHES + side] = reach.derivative
                room[i + at.STAYS + side] = reach.derivative * rate - body.horizontal_velocity
                if not impulsive:
                    along = coriolis_along(i, room) + reach.second_derivative * rate * rate
                    room[i + at.STAYS + side] = along
                    room[i + at.RESTS + side] = -coriolis_normal(i, room) - bends[side]


@kernel
def first_fault(
    system: Any, some: int, closed: int, impulsive: bool, least: float, noise: float
) -> int:
    """Return the first corner that is at fault by :eq:`eq-admissible`; -1 if none is."""
    room, rows, above = system.places(), system.constraints(), 0.0
    for corner in range(2 * system.body_count):
        k, side = corner // 2, corner % 2
        if side == 0:  # the mass that the body's base carries
            above += system.number(k, at.MASS)
        if closed >> corner & 1 == 0:
            continue
        if some >> corner & 1 != 0:
            which = int(room[k * PLACES + at.LEFT_CORNER + side])
            # where no corner closes all impulses are rounding
            none = noise * above if impulsive else 0.0
            if rows[which * CONSTRAINT + at.FORCE] < -least - none:
                return corner
            continue
        # as a corner parts under new forces, both its force and its acceleration are zero
        least_rise = noise if impulsive else -noise
        if free_rise(system, k, side) <= least_rise:
            return corner
    return -1


@kernel
def free_rise(system: Any, k: int, side: int) -> float:
    """Return upward velocity, or acceleration, of a free corner by the last solution."""
    room, rows, i = system.places(), system.constraints(), k * PLACES + side
    keeps = (MOST_CONSTRAINTS * system.body_count - 1) * CONSTRAINT + at.KEEPS  # a row without use
    write_direction(system, k, 0.0, 1.0, room[i + at.LEVERS], keeps, room, rows)
    return float(of_both(system.body_count, k, keeps, room, rows) - room[i + at.RESTS])


@kernel
def noise_of(system: Any, closed: int, impulsive: bool, state: Vector) -> float:
    """Return the rounding noise of the speeds of corners, or of their accelerations."""
    room, scale = system.places(), 0.0
    if not impulsive:
        return NEARLY_ZERO * system.number(0, at.GRAVITY)
    for corner in range(2 * system.body_count):
        if closed >> corner & 1 != 0:
            k = corner // 2
            i, body = k * PLACES + corner % 2, system.state_of(k, state)
            scale += abs(room[i + at.RESTS]) + abs(room[i + at.LEVERS] * body.angular_velocity)
            scale += abs(body.horizontal_velocity)
    return NOISE * scale


@kernel
def bearing_corners(
    system: Any, mode: int, closed: int, pulled: int, before: int, leaving: int, state: Vector
) -> Found:
    """Find the closed corners that bear, beside those in `pulled`, which are held in any case.

    After an impact (`leaving` 0): the admissible set that loses the least energy; if there is none,
    the solution with sticking assumed, which is unique. Under new forces, as the force of the
    corner `leaving` has come to zero or, if it is negative, friction has changed: the admissible
    set nearest to `before`, which bore so far; if there is none, first all combinations of slips
    are tried, then sets of which one corner is held though it does not press. If `leaving` is
    JAMMED, impulses have to stop a slip.
    """
    impulsive, count = leaving in (0, JAMMED), size_of(closed)
    write_corners(system, impulsive, state)
    noise, near = noise_of(system, closed, impulsive, state), Near(closed, closed, count)
    far = near
    if count > ALL_TRIED:
        reference = with_sticking(system, mode, closed, impulsive, noise, state)
        near = Near(closed, reference, NEIGHBOURS)
        far = Near(closed, reference, count if count <= MOST_TRIED else FAR_NEIGHBOURS)
    taken, other, admissible, held = -1, -1, 0, 0
    must_press = ~before | max(leaving, 0)  # the leaving corner, too, if it is to bear on
    lowest = second = math.inf
    # first sets that are admissible within rounding; in each round first the near ones
    for trial in range(2 if impulsive else 1 + ALL_WAYS):
        if trial % 2 == 1 and count <= ALL_TRIED:
            continue  # there are no sets farther off
        tried = near if trial % 2 == 0 else far
        some = next_set(closed, tried)
        way = JAMMED if leaving == JAMMED else trial
        least = noise if impulsive or trial > 1 else ROUNDING * system.number(0, at.GRAVITY)
        while some >= 0:
            bears = some | pulled
            if leaving <= 0 or bears != before:
                found = try_set(system, way, mode, bears, closed, impulsive, least, state)
                if found.fault < 0 and (impulsive or all_press(system, bears & must_press)):
                    loss = found.loss if impulsive else float(size_of(bears ^ before))
                    admissible += 1
                    if loss < lowest:
                        other, second, taken, lowest = taken, lowest, bears, loss
                    elif loss < second:
                        other, second = bears, loss
            some = next_set(some - 1, tried)
        if admissible > 0:  # its solution stays in the workspace
            try_set(system, way, mode, taken, closed, impulsive, least, state)
            return Found(taken, admissible, other, 0)
    if impulsive:
        taken = with_sticking(system, mode, closed, impulsive, noise, state)
    else:
        taken, held = with_one_held(system, mode, near, pulled, before, leaving, noise, state)
        if held == 0:
            taken = before if leaving < 0 else before & ~leaving
    return Found(taken, admissible, other, held)


@kernel
def try_set(
    system: Any, way: int, mode: int, some: int, closed: int, impulsive: bool, noise: float,
    state: Vector,
) -> Attempt:  # fmt: skip
    """Let a set of the closed corners bear, and find the slips in the given way."""
    if way == JAMMED:
        return system.try_stops(mode, some, closed, noise, state)
    if way == ALL_WAYS:
        return system.try_all_slips(mode, some, closed, noise, state)
    return system.try_corners(mode, some, closed, impulsive, noise, state)


@kernel
def with_one_held(
    system: Any, mode: int, near: Near, pulled: int, before: int, leaving: int, noise: float,
    state: Vector,
) -> tuple[int, int]:  # fmt: skip
    """Return a set of corners, one of which is held though it does not press, and that corner.

    It is the only corner of its body in the set. Without it the set would not be admissible: the
    corner would fall back, or another one would have to pull. If there are several such sets, the
    one nearest to `before` is taken, preferably with `leaving` as the held corner. The corner is 0
    if there is none.
    """
    taken, held, least, closed = before, 0, math.inf, near.closed
    some, follower = before & closed, closed  # `before` comes first and excludes most others
    while some >= 0:
        for corner in range(2 * system.body_count):
            one, bears = 1 << corner, some | pulled
            distance = 2 * size_of(bears ^ before) + (0 if one == leaving else 1)
            if some & one == 0 or not system.bears_alone(some, one) or distance >= least:
                continue
            found = system.try_corners(mode, bears, closed & ~one, False, noise, state)
            pulls = system.corner_force(corner // 2, corner % 2 == 0) < 0.0
            if found.fault < 0 and pulls and all_press(system, bears & ~before & ~one):
                free = system.try_corners(mode, bears & ~one, closed, False, noise, state)
                if free.fault >= 0:
                    taken, held, least = bears, one, distance
        some = next_set(follower, near)
        follower = some - 1
    if held != 0:
        system.try_corners(mode, taken, closed & ~held, False, noise, state)
    return taken, held


@kernel
def all_press(system: Any, corners: int) -> bool:
    """Whether the forces of all of some corners are compression, beyond rounding."""
    for corner in range(2 * system.body_count):
        if corners >> corner & 1 != 0:
            k = corner // 2
            least = NEARLY_ZERO * system.number(k, at.FORCE_SIZE)
            if system.corner_force(k, corner % 2 == 0) < least:
                return False
    return True


@kernel
def with_sticking(
    system: Any, mode: int, closed: int, impulsive: bool, noise: float, state: Vector
) -> int:
    """Return the set of corners that bear by :eq:`eq-sticking`, found by least-index pivoting."""
    some = closed
    for _ in range(MOST_PIVOTS):
        found = attempt(system, mode, some, closed, True, impulsive, noise, state)
        if found.fault < 0:
            break
        some ^= 1 << found.fault
    return some
