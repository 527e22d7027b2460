"""A bed of springs and dashpots without tension under a straight base, :eq:`eq-bed`.

Along the base everything is linear: the compression u = delta - w of the springs, its rate
-v, the pressure p = k u - c v and the lever of a point. So each resultant is exact from the
values at both ends of the bearing part, without a division by the rotation. A place on the
base is a coordinate from 0 at the left end to 1 at the right end.
"""

from typing import Final, NamedTuple

from rockframe.compiled import inlined, kernel
from rockframe.dynamics.base import SIMULTANEOUS, Base, BaseForce, EndEvent, Guards, Variables
from rockframe.dynamics.body import BaseLine
from rockframe.dynamics.events import REENGAGEMENT, SEPARATION

# contact of an end of the base
DOWN: Final = 0  # below the level of the unloaded bed
RAISED: Final = 1
# contacts of both ends in one integer: left end + 2 * right end
LEFT_MASK: Final = 1  # mask of the left end
RIGHT_SHIFT: Final = 1  # shift to the right end
CONTACTS: Final = 4


class Ends(NamedTuple):
    """Compression of the bed under both ends [m]; upward speeds of these [m s^-1]."""

    u_left: float
    u_right: float
    v_left: float
    v_right: float


@inlined
def end_contact(contact: int, left: bool) -> int:
    """Return the contact of one end."""
    return contact & LEFT_MASK if left else contact >> RIGHT_SHIFT & LEFT_MASK


@inlined
def both_contacts(left: int, right: int) -> int:
    """Return the contacts of both ends in one integer."""
    return left + (right << RIGHT_SHIFT)


@inlined
def mean_product(f0: float, f1: float, g0: float, g1: float) -> float:
    """Return the mean of the product of two linear functions, by their values at both ends."""
    return (2.0 * (f0 * g0 + f1 * g1) + f0 * g1 + f1 * g0) / 6.0


@inlined
def interpolated(left: float, right: float, place: float) -> float:
    """Return a value between the ends of the base of a quantity that is linear along it."""
    return left + place * (right - left)


@inlined
def contact_start(near: float, far: float) -> float:
    """Return the distance, from the near end, beyond which a linear function is positive.

    As a share of the length of the base. It may be negative, down to -1, as a step may overshoot
    the instant at which the end starts to bear.
    """
    if near < far:
        return min(max(near / (near - far), -1.0), 1.0)
    return 1.0 if near <= 0.0 else -1.0


@inlined
def compressed_part(left: int, right: int, ends: Ends) -> tuple[float, float]:
    """Return the places between which the bed is compressed, from the contacts of both ends."""
    if left == RAISED and right == RAISED:
        return 0.0, 0.0
    start = contact_start(ends.u_left, ends.u_right) if left == RAISED else 0.0
    end = 1.0 - contact_start(ends.u_right, ends.u_left) if right == RAISED else 1.0
    return start, max(start, end)


@inlined
def contact_of_end(u: float) -> int:
    """Return the contact of an end, DOWN or RAISED, from the compression under it."""
    return DOWN if u > 0.0 else RAISED


class BedNumbers(NamedTuple):
    """A bed, per unit length of base and unit mass of the body on it."""

    stiffness: float  # k0/m [m^-1 s^-2]
    damping: float  # c0/m [m^-1 s^-1]
    settlement: float  # delta [m]
    width: float  # of the base, B [m]
    by_pressure: bool  # whether tension is cut off as well


class Bed(Base, BedNumbers):
    """A bed under a straight base: a :class:`rockframe.dynamics.base.Base`."""

    __slots__ = ()

    @kernel
    def contacts(self) -> int:
        """Return the number of contacts of both ends together."""
        return CONTACTS

    @kernel
    def end_guards(self) -> int:
        """Return the number of guards of an end."""
        return 1

    @inlined
    def in_flight(self) -> int:
        """Return the contact with both ends raised."""
        return both_contacts(RAISED, RAISED)

    @inlined
    def is_held(self, contact: int, left: bool) -> bool:
        """Whether an end is down."""
        return end_contact(contact, left) == DOWN

    @inlined
    def ends(self, line: BaseLine) -> Ends:
        """Return the compression under both ends, and its rate."""
        delta = self.settlement
        return Ends(delta - line.left, delta - line.right, line.left_speed, line.right_speed)

    @inlined
    def pressure(self, place: float, ends: Ends) -> float:
        """Return the pressure at a place of the base."""
        u = interpolated(ends.u_left, ends.u_right, place)
        return self.stiffness * u - self.damping * interpolated(ends.v_left, ends.v_right, place)

    @inlined
    def bearing_part(self, contact: int, ends: Ends) -> tuple[float, float]:
        """Return the places between which the base presses the bed."""
        start, end = compressed_part(end_contact(contact, True), end_contact(contact, False), ends)
        if not self.by_pressure:
            return start, end
        p0, p1 = self.pressure(start, ends), self.pressure(end, ends)
        if p0 < 0.0 < p1:
            start += (end - start) * p0 / (p0 - p1)
        elif p1 < 0.0 < p0:
            end -= (end - start) * p1 / (p1 - p0)
        elif p0 <= 0.0 and p1 <= 0.0:
            end = start
        return start, end

    @inlined
    def force(self, contact: int, line: BaseLine, own: Variables) -> BaseForce:
        """Return the bed's force, its generalised force on the rotation, and the dissipated power.

        Where the bed is compressed without pressing, its springs relax against their own dashpots.
        """
        ends = self.ends(line)
        start, end = self.bearing_part(contact, ends)
        v0 = interpolated(ends.v_left, ends.v_right, start)
        v1 = interpolated(ends.v_left, ends.v_right, end)
        p0, p1 = self.pressure(start, ends), self.pressure(end, ends)
        l0 = interpolated(line.left_lever, line.right_lever, start)
        l1 = interpolated(line.left_lever, line.right_lever, end)
        length = self.width * (end - start)
        dissipated = self.damping * length * mean_product(v0, v1, v0, v1)
        # without dashpots all of the compressed part presses
        if self.by_pressure and self.damping > 0.0:
            down, up = compressed_part(
                end_contact(contact, True), end_contact(contact, False), ends
            )
            dissipated += self.spring_power(down, up, ends) - self.spring_power(start, end, ends)
        return BaseForce(
            0.5 * length * (p0 + p1), length * mean_product(p0, p1, l0, l1), dissipated
        )

    @kernel
    def spring_power(self, start: float, end: float, ends: Ends) -> float:
        """Return the power that the springs release between two places of the bed."""
        u0 = interpolated(ends.u_left, ends.u_right, start)
        u1 = interpolated(ends.u_left, ends.u_right, end)
        v0 = interpolated(ends.v_left, ends.v_right, start)
        v1 = interpolated(ends.v_left, ends.v_right, end)
        return self.stiffness * self.width * (end - start) * mean_product(u0, u1, v0, v1)

    @kernel
    def energy(self, line: BaseLine, own: Variables) -> tuple[float, float]:
        """Return the energy of the compressed springs, and the energy less that at rest."""
        ends, delta = self.ends(line), self.settlement
        half = 0.5 * self.stiffness * self.width
        start, end = compressed_part(
            contact_of_end(ends.u_left), contact_of_end(ends.u_right), ends
        )
        u0 = interpolated(ends.u_left, ends.u_right, start)
        u1 = interpolated(ends.u_left, ends.u_right, end)
        stored = half * (end - start) * mean_product(u0, u1, u0, u1)
        if end - start < 1.0:
            return stored, stored - half * delta * delta
        # u^2 - delta^2 as a product, without cancellation
        return stored, half * mean_product(u0 - delta, u1 - delta, u0 + delta, u1 + delta)

    @inlined
    def guards_of(self, contact: int, left: bool, line: BaseLine, own: Variables) -> Guards:
        """Return the guard of an end, its level below or above the unloaded bed, and its rate."""
        scale = (1.0 if self.is_held(contact, left) else -1.0) / self.settlement
        level = line.left if left else line.right
        speed = line.left_speed if left else line.right_speed
        return Guards((scale * (self.settlement - level),), (-scale * speed,))

    @kernel
    def switch(
        self, contact: int, left: bool, which: int, line: BaseLine, own: Variables
    ) -> EndEvent:
        """Return the contact and the event after the guard of an end.

        Where both ends land, or leave, at the same instant one event switches both.
        """
        ends = self.ends(line)
        end, other = end_contact(contact, left), end_contact(contact, not left)
        level = abs(ends.u_right if left else ends.u_left)
        speed = ends.v_right if left else ends.v_left
        along = speed > 0.0 if end == DOWN else speed < 0.0
        symmetric = ends.u_left == ends.u_right and ends.v_left == ends.v_right
        if other == end and level <= SIMULTANEOUS * self.settlement and (along or symmetric):
            other = RAISED - other
        end = RAISED - end
        both = both_contacts(end, other) if left else both_contacts(other, end)
        return EndEvent(both, REENGAGEMENT if end == DOWN else SEPARATION, True)

    @kernel
    def level(self, left: bool, line: BaseLine, own: Variables) -> float:
        """Return how far below the unloaded bed an end is [m]."""
        return self.settlement - (line.left if left else line.right)

    @kernel
    def starting(self, line: BaseLine, own: Variables) -> int:
        """Return the contact at the start of a run."""
        ends = self.ends(line)
        return both_contacts(contact_of_end(ends.u_left), contact_of_end(ends.u_right))

    @kernel
    def resting_height(self, left: float, right: float, own: Variables) -> float:
        """Return the height of the ends' middle at which the bed carries the weight at rest.

        With one end raised, the bearing part is 2 sqrt(b delta/|sin a|) long.
        """
        tilt, middle = 0.5 * abs(left - right), 0.5 * (left + right)
        if tilt <= self.settlement:
            return 0.0 - middle
        return self.settlement + tilt - 2.0 * (tilt * self.settlement) ** 0.5 - middle

    @kernel
    def observed(self, contact: int, line: BaseLine, own: Variables) -> Variables:
        """Return reaction, length in contact, and the greater of the pressures at its ends."""
        ends = self.ends(line)
        start, end = self.bearing_part(contact, ends)
        left, right = self.pressure(start, ends), self.pressure(end, ends)
        greatest = max(left, right) if end > start else 0.0
        return self.force(contact, line, own).upward, self.width * (end - start), greatest


class Rigid(Bed):
    """A rigid base in a chain of bodies: a bed without forces; constraints hold its ends."""

    __slots__ = ()

    def starting(self, line: BaseLine, own: Variables) -> int:
        """Return the contact at the start of a run: an end that is, or moves, higher is raised."""
        higher = line.left - line.right or line.left_speed - line.right_speed
        return both_contacts(int(higher > 0.0), int(higher < 0.0))
