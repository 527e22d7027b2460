"""A bed of springs and dashpots without tension under a straight base, :eq:`eq-bed`.

Functions of plain numbers, for a block as for a cap. Along the base everything is
linear: the compression u = delta - w of the springs, its rate -v, the pressure
p = k u - c v and the lever of a point. So each resultant is exact from the values at
both ends of the bearing part, without a division by the rotation. A place on the base
is its share of the way from the left end (0) to the right end (1).
"""

from typing import Final, NamedTuple

from rockframe.compiled import inlined, kernel
from rockframe.dynamics.protocol import REENGAGEMENT, SEPARATION

# an end of the base
DOWN: Final = 0  # below the level of the unloaded bed
RAISED: Final = 1

# A bed's mode is left end + 2 * right end + 4 * gliding + 8 * pivot. Gliding: the end that is
# down only touches, and the hold gives way, see :mod:`rockframe.dynamics.gliding`.
GLIDING: Final = 1
PIVOT_FACTOR: Final = 8
BED_MODES: Final = 24

# guards of a bed
LEFT_END: Final = 0
RIGHT_END: Final = 1
SLIP: Final = 2  # of a base that glides
BED_GUARDS: Final = 3

SIMULTANEOUS: Final = 1e-9
"""Share of the settlement within which both ends land, or both leave, together."""


class Bed(NamedTuple):
    """Properties of a bed, per unit length of base."""

    stiffness: float
    damping: float
    settlement: float
    by_pressure: float  # 1 where tension is cut off as well, else 0


class Ends(NamedTuple):
    """The base's ends: compression of the bed under them, and its rate with opposite sign."""

    u_left: float
    u_right: float
    v_left: float
    v_right: float


@inlined
def mean_product(f0: float, f1: float, g0: float, g1: float) -> float:
    """Give the mean of the product of two linear functions, by their values at both ends."""
    return (2.0 * (f0 * g0 + f1 * g1) + f0 * g1 + f1 * g0) / 6.0


@inlined
def between(left: float, right: float, place: float) -> float:
    """Give a linear function of the base at a place."""
    return left + place * (right - left)


@inlined
def first_place(near: float, far: float) -> float:
    """Give the place from which on a linear function is positive, seen from its near end.

    Goes on beyond the end, up to one length of the base, so that a step may overshoot
    the instant at which the end starts to bear.
    """
    if near < far:
        return min(max(near / (near - far), -1.0), 1.0)
    return 1.0 if near <= 0.0 else -1.0


@inlined
def compressed_part(left: int, right: int, ends: Ends) -> tuple[float, float]:
    """Give the places between which the base is down, by its ends' modes."""
    if left == RAISED and right == RAISED:
        return 0.0, 0.0
    start = first_place(ends.u_left, ends.u_right) if left == RAISED else 0.0
    end = 1.0 - first_place(ends.u_right, ends.u_left) if right == RAISED else 1.0
    return start, max(start, end)


@inlined
def pressure(place: float, ends: Ends, bed: Bed) -> float:
    """Give the pressure at a place of the base."""
    u = between(ends.u_left, ends.u_right, place)
    return bed.stiffness * u - bed.damping * between(ends.v_left, ends.v_right, place)


@inlined
def bearing_part(left: int, right: int, gliding: int, ends: Ends, bed: Bed) -> tuple[float, float]:
    """Give the places between which the base bears."""
    start, end = compressed_part(left, right, ends)
    if gliding == GLIDING:
        return start, start
    if bed.by_pressure == 0.0:
        return start, end
    p0 = pressure(start, ends, bed)
    p1 = pressure(end, ends, bed)
    if p0 < 0.0 < p1:
        start += (end - start) * p0 / (p0 - p1)
    elif p1 < 0.0 < p0:
        end -= (end - start) * p1 / (p1 - p0)
    elif p0 <= 0.0 and p1 <= 0.0:
        end = start
    return start, end


@inlined
def bed_resultants(
    left: int,
    right: int,
    gliding: int,
    ends: Ends,
    bed: Bed,
    width: float,
    lever_left: float,
    lever_right: float,
) -> tuple[float, float, float]:
    """Give the bed's force, its generalised force on the rotation, and what dashpots burn.

    The levers are those of the base's ends. Where the base is down without bearing,
    the springs under it feed their own dashpots.
    """
    start, end = bearing_part(left, right, gliding, ends, bed)
    k, c = bed.stiffness, bed.damping
    v0 = between(ends.v_left, ends.v_right, start)
    v1 = between(ends.v_left, ends.v_right, end)
    p0 = k * between(ends.u_left, ends.u_right, start) - c * v0
    p1 = k * between(ends.u_left, ends.u_right, end) - c * v1
    l0 = between(lever_left, lever_right, start)
    l1 = between(lever_left, lever_right, end)
    length = width * (end - start)
    force = 0.5 * length * (p0 + p1)
    moment = length * mean_product(p0, p1, l0, l1)
    burnt = c * length * mean_product(v0, v1, v0, v1)
    # without dashpots all that is down bears
    if bed.by_pressure != 0.0 and c > 0.0 and gliding != GLIDING:
        down = compressed_part(left, right, ends)
        burnt += spring_power(down, ends, k, width) - spring_power((start, end), ends, k, width)
    return force, moment, burnt


@kernel
def spring_power(part: tuple[float, float], ends: Ends, stiffness: float, width: float) -> float:
    """Give the power that the springs of a part of the bed give away."""
    start, end = part
    u0 = between(ends.u_left, ends.u_right, start)
    u1 = between(ends.u_left, ends.u_right, end)
    v0 = between(ends.v_left, ends.v_right, start)
    v1 = between(ends.v_left, ends.v_right, end)
    return stiffness * width * (end - start) * mean_product(u0, u1, v0, v1)


@kernel
def bed_energy(ends: Ends, bed: Bed, width: float) -> tuple[float, float]:
    """Give the energy of the compressed springs, and that less the energy at rest."""
    delta = bed.settlement
    half = 0.5 * bed.stiffness * width
    start, end = compressed_part(end_state(ends.u_left), end_state(ends.u_right), ends)
    u0 = between(ends.u_left, ends.u_right, start)
    u1 = between(ends.u_left, ends.u_right, end)
    stored = half * (end - start) * mean_product(u0, u1, u0, u1)
    if end - start < 1.0:
        return stored, stored - half * delta * delta
    # u^2 - delta^2 as a product, to all digits
    return stored, half * mean_product(u0 - delta, u1 - delta, u0 + delta, u1 + delta)


@inlined
def end_state(u: float) -> int:
    """Give whether an end is down or raised."""
    return DOWN if u > 0.0 else RAISED


@inlined
def bed_guards(left: int, right: int, ends: Ends, settlement: float) -> tuple[float, ...]:
    """Give the guards of the ends, then their rates."""
    left_sign = (1.0 if left == DOWN else -1.0) / settlement
    right_sign = (1.0 if right == DOWN else -1.0) / settlement
    return (
        left_sign * ends.u_left,
        right_sign * ends.u_right,
        -left_sign * ends.v_left,
        -right_sign * ends.v_right,
    )


@kernel
def switch_bed(which: int, left: int, right: int, ends: Ends, bed: Bed) -> tuple[int, int, int]:
    """Give the ends' states and the event after a guard.

    An end that lands together with the other one, or leaves together with it, takes
    it along if that moves so, too.
    """
    on_left = which == LEFT_END
    end = left if on_left else right
    other = right if on_left else left
    level = abs(ends.u_right if on_left else ends.u_left)
    speed = ends.v_right if on_left else ends.v_left
    along = speed > 0.0 if end == DOWN else speed < 0.0
    symmetric = ends.u_left == ends.u_right and ends.v_left == ends.v_right
    if other == end and level <= SIMULTANEOUS * bed.settlement and (along or symmetric):
        other = RAISED - other
    end = RAISED - end
    event = REENGAGEMENT if end == DOWN else SEPARATION
    return end if on_left else other, other if on_left else end, event


@kernel
def airborne(left: int, right: int) -> bool:
    """Whether the base is in flight."""
    return left == RAISED and right == RAISED


@kernel
def equilibrium_middle(sine: float, half_width: float, settlement: float) -> float:
    """Give the rise of the base's middle at which the bed carries the weight at rest.

    With one end raised, the bearing part is 2 sqrt(b delta/|sin a|) long.
    """
    tilt = half_width * abs(sine)
    if tilt <= settlement:
        return 0.0
    return settlement + tilt - 2.0 * (tilt * settlement) ** 0.5
