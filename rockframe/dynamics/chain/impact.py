"""Which corners on rigid bases bear: after an impact, :eq:`eq-projection`, or under new forces.

Corners are counted from the top down, those of each body from the left: corner ``2 k`` is the left
one of body ``k``. A set of them is a whole number, a bit for each.
"""

import math
from typing import Any, Final, NamedTuple

from rockframe.compiled import Vector, kernel
from rockframe.dynamics.body import PIVOT_LEFT, PIVOT_RIGHT
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.motion import (
    FREE,
    add_constraint,
    coriolis_along,
    coriolis_normal,
    of_both,
    solve_motion,
    write_direction,
)
from rockframe.dynamics.chain.rows import CONSTRAINT, MOST_CONSTRAINTS, PLACES

LEFT_ONLY: Final = 1
RIGHT_ONLY: Final = 2
BOTH: Final = 3

ALL_TRIED: Final = 10
"""Closed corners up to which every subset of them is tried."""
NEIGHBOURS: Final = 3
"""Of more, corners in which the subsets differ from the one with sticking assumed."""
NOISE: Final = 1e-11
"""Share of all impulses, or of all speeds, that is rounding."""
NEARLY_ZERO: Final = 1e-5
"""Acceleration of a corner as its force comes to zero, over gravity."""
MOST_PIVOTS: Final = 1000
"""Changes of the set in the search with sticking assumed, which needs a few."""


class Attempt(NamedTuple):
    """What became of a set of corners: one that pulls or closes, or -1; the energy lost."""

    fault: int
    loss: float


class Found(NamedTuple):
    """The set that bears, how many others would do, and the next best of them, or -1."""

    taken: int
    admissible: int
    other: int


@kernel
def size_of(corners: int) -> int:
    """Give the number of corners in a set."""
    rest, count = corners, 0
    while rest > 0:
        count += rest & 1
        rest >>= 1
    return count


@kernel
def attempt(
    system: Any, mode: int, some: int, closed: int, sticks: bool, impulsive: bool, noise: float,
    state: Vector,
) -> Attempt:  # fmt: skip
    """Let a set of the closed corners bear; their bodies are free in the mode.

    Velocities change by impulses, or accelerations follow from the loads in the rooms. With
    `sticks` every body with a closed corner is held along its base, else those that bear. Speeds
    or accelerations up to `noise` are rounding.
    """
    room, rows = system.places(), system.constraints()
    count = 0
    for k in range(system.body_count):
        i, standing = k * PLACES, system.part_mode(mode, k)
        if not system.is_rigid(k):
            if not impulsive:
                count = system.hold_as_tried(k, count, standing, state, room, rows)
            elif room[i + at.HELD] != FREE:
                add_constraint(system, count, k, 1.0, 0.0, -room[i + at.REACH], 0.0, room, rows)
                count += 1
            continue
        room[i + at.LEFT_CORNER] = room[i + at.RIGHT_CORNER] = -1.0
        bears, touches = some >> 2 * k & BOTH, closed >> 2 * k & BOTH
        holds = touches | bears if sticks else bears
        if holds == 0:
            continue
        body, part = system.state_of(k, state), system.on_base(k)
        # where both corners are closed all points of the base move alike
        pivot = PIVOT_LEFT if holds == LEFT_ONLY else PIVOT_RIGHT
        reach = part.body.reach(part.body.pin(pivot), part.body.attitude(body.rotation))
        sense = 0.0 if sticks else system.slip_sense(k)
        for side in range(2):
            if bears >> side & 1 != 0:
                lever, wanted = corner_row(system, k, side == 0, impulsive, state, room)
                add_constraint(system, count, k, 0.0, 1.0, lever, wanted, room, rows)
                room[i + at.LEFT_CORNER + side] = count
                system.rub(k, count, sense, reach.rate, impulsive, room, rows)
                count += 1
        if sense == 0.0:
            rate = body.angular_velocity
            wanted = coriolis_along(i, room) + reach.bend * rate * rate
            if impulsive:
                wanted = reach.rate * rate - body.horizontal_velocity
            room[i + at.HOLDS_ALONG] = count
            add_constraint(system, count, k, 1.0, 0.0, -reach.rate, wanted, room, rows)
            count += 1
    solve_motion(system, count, system.band(), room, rows, system.matrix())
    loss = pressing = 0.0
    for which in range(count):
        first = which * CONSTRAINT
        force, k = rows[first + at.FORCE], int(rows[first + at.BODY])
        loss += 0.5 * force * rows[first + at.VALUE]
        if system.is_rigid(k):
            loss += system.lost_by_friction(k, which, state, room, rows)
        pressing += abs(force)
    fault = first_fault(system, some, closed, impulsive, NOISE * pressing, noise, state)
    return Attempt(fault, loss)


@kernel
def corner_row(
    system: Any, k: int, left: bool, impulsive: bool, state: Vector, room: Vector
) -> tuple[float, float]:
    """Give the lever of a corner, and the change of its speed that makes it rest on its base."""
    i, part, body = k * PLACES, system.on_base(k), system.state_of(k, state)
    attitude = part.body.attitude(body.rotation)
    line = part.body.base_line(body, attitude)
    lever = line.left_lever if left else line.right_lever
    if impulsive:
        return lever, -(line.left_speed if left else line.right_speed)
    bends = part.body.end_accelerations(attitude, body.angular_velocity, 0.0, 0.0)
    return lever, -coriolis_normal(i, room) - (bends[0] if left else bends[1])


@kernel
def first_fault(
    system: Any, some: int, closed: int, impulsive: bool, least: float, noise: float, state: Vector
) -> int:
    """Give the first corner that is at fault by :eq:`eq-admissible`; -1 if none is."""
    room, rows = system.places(), system.constraints()
    spare = MOST_CONSTRAINTS * system.body_count - 1  # a corner is left free, so there is room
    for corner in range(2 * system.body_count):
        if closed >> corner & 1 == 0:
            continue
        k, side = corner // 2, corner % 2
        if some >> corner & 1 != 0:
            which = int(room[k * PLACES + at.LEFT_CORNER + side])
            if rows[which * CONSTRAINT + at.FORCE] < -least:
                return corner
            continue
        lever, wanted = corner_row(system, k, side == 0, impulsive, state, room)
        keeps = spare * CONSTRAINT + at.KEEPS
        write_direction(system, k, 0.0, 1.0, lever, keeps, room, rows)
        # under new forces a corner parts as its force is zero, and so is its acceleration
        least_rise = noise if impulsive else -noise
        if of_both(system, k, keeps, room, rows) - wanted <= least_rise:
            return corner
    return -1


@kernel
def noise_of(system: Any, closed: int, impulsive: bool, state: Vector) -> float:
    """Give the rounding noise of the speeds of corners, or of their accelerations."""
    room, scale = system.places(), 0.0
    if not impulsive:
        return NEARLY_ZERO * system.number(0, at.GRAVITY)
    for corner in range(2 * system.body_count):
        if closed >> corner & 1 != 0:
            k = corner // 2
            body = system.state_of(k, state)
            lever, wanted = corner_row(system, k, corner % 2 == 0, True, state, room)
            scale += abs(wanted) + abs(lever * body.angular_velocity)
            scale += abs(body.horizontal_velocity)
    return NOISE * scale


@kernel
def bearing_corners(
    system: Any, mode: int, closed: int, pulled: int, before: int, leaving: int, state: Vector
) -> Found:
    """Find the corners that bear, of those that are closed, beside those that are held anyway.

    After an impact the admissible set that loses the least energy. Where one of those that bore
    before is `leaving`, since its force has come to zero, the admissible one nearest to those.
    Where no set is admissible, that of the problem with sticking assumed, which has one solution.
    Where friction alone has changed, `leaving` is negative.
    """
    impulsive = leaving == 0
    reference, noise = closed, noise_of(system, closed, impulsive, state)
    many = size_of(closed) > ALL_TRIED
    if many:
        reference = with_sticking(system, mode, closed, impulsive, noise, state)
    taken, other, admissible = -1, -1, 0
    least = second = math.inf
    some = closed
    while some >= 0:
        near, bears = not many or size_of(some ^ reference) <= NEIGHBOURS, some | pulled
        if near and (leaving <= 0 or bears != before):
            found = system.try_corners(mode, bears, closed, impulsive, noise, state)
            if found.fault < 0 and (impulsive or all_press(system, bears & ~before)):
                loss = found.loss if impulsive else float(size_of(bears ^ before))
                admissible += 1
                if loss < least:
                    other, second, taken, least = taken, least, bears, loss
                elif loss < second:
                    other, second = bears, loss
        some = (some - 1) & closed if some > 0 else -1
    if admissible > 0:
        system.try_corners(mode, taken, closed, impulsive, noise, state)
    elif impulsive:
        taken = with_sticking(system, mode, closed, impulsive, noise, state)
    else:
        taken = before if leaving < 0 else before & ~leaving
    return Found(taken, admissible, other)


@kernel
def all_press(system: Any, corners: int) -> bool:
    """Whether corners that have not borne would press under new forces, beyond rounding."""
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
    """Find the corners that bear by :eq:`eq-sticking`, by least-index pivots."""
    some = closed
    for _ in range(MOST_PIVOTS):
        found = attempt(system, mode, some, closed, True, impulsive, noise, state)
        if found.fault < 0:
            break
        some ^= 1 << found.fault
    return some
