"""A bed of separate springs side by side under a straight base, with any force law.

Each spring touches the base, follows it without a force, or is clear of it. This contact, with the
state of its law, is a variable of the bed that changes at events only, so that the number of
contact states does not grow with the springs. An end is held as long as the outermost spring on its
side is not clear; both ends are held where only springs between the outermost ones are not clear.
"""

from typing import Any, Final, NamedTuple

from rockframe.compiled import Vector, constant, inlined, kernel, view_of, with_numbers
from rockframe.dynamics.base import (
    SIMULTANEOUS,
    Base,
    BaseForce,
    EndEvent,
    Guards,
    Variables,
    equilibrium_height,
)
from rockframe.dynamics.body import BaseLine
from rockframe.dynamics.events import REENGAGEMENT, SEPARATION, SILENT
from rockframe.dynamics.point_law import FREE, Point, point_at

# contact of a spring; its variable is this plus SPRING times the state of its law
TOUCHING: Final = 0
RELAXING: Final = 1  # pulled by its dashpot alone, it follows the base without a force
CLEAR: Final = 2
SPRING: Final = 3

# contacts of the bed: a bit for each raised end (1 the left one), or BETWEEN: inner springs only
RIGHT_RAISED: Final = 2
FLIGHT: Final = 3
BETWEEN: Final = 4
CONTACTS: Final = 5

# guards of a spring
CONTACT: Final = 0  # its contact ends, or begins
OTHER: Final = 1  # end of its law's state where it touches; return of its force where it relaxes
GUARDS: Final = 2


class SpringNumbers(NamedTuple):
    """Springs, per unit mass of the body on them."""

    law: Any  # of each, per unit length, a rockframe.dynamics.point_law.PointLaw
    places: tuple[float, ...]  # coordinates along the base from 0 (left end) to 1, ascending
    lengths: tuple[float, ...]  # length of base that each carries [m]
    settlement: float  # under the weight [m]
    rest_energy: float  # per unit length
    weight: float  # of the body [m s^-2]
    pressure: float  # under the weight, per unit length [s^-2]
    idle_guards: tuple[float, ...]  # guards of one end, all 1
    zero_rates: tuple[float, ...]  # rates of all variables, all 0


class Springs(Base, SpringNumbers):
    """Springs under a straight base: a :class:`rockframe.dynamics.base.Base`."""

    __slots__ = ()

    @kernel
    def contacts(self) -> int:
        """Return the number of contacts."""
        return CONTACTS

    @kernel
    def end_guards(self) -> int:
        """Return the number of guards of the springs on one side."""
        return len(self.idle_guards)

    @inlined
    def in_flight(self) -> int:
        """Return the contact with all springs clear."""
        return FLIGHT

    @inlined
    def is_held(self, contact: int, left: bool) -> bool:
        """Whether the outermost spring is not clear, or only springs between are not."""
        return contact == BETWEEN or (contact & (1 if left else RIGHT_RAISED)) == 0

    @inlined
    def variables(self) -> int:
        """Return the number of variables: the springs' contacts, then those of their laws."""
        return len(self.zero_rates)

    @inlined
    def read(self, state: Vector, first: int) -> Vector:
        """Read the variables."""
        return view_of(state, first, len(self.zero_rates))

    @inlined
    def law_variables(self, own: Vector, i: int) -> Any:
        """Return the variables of the law of one spring."""
        count = len(self.places)
        return self.law.of_point(view_of(own, count, len(self.zero_rates) - count), i)

    @inlined
    def point(self, i: int, line: BaseLine) -> Point:
        """Return compression and motion of the base at one spring."""
        return point_at(line, self.places[i], self.settlement)

    @kernel
    def contact_of(self, own: Vector) -> int:
        """Return the contact of the bed from the contacts of its springs."""
        last = len(self.places) - 1
        contact = 1 if int(own[0]) % SPRING == CLEAR else 0
        contact += RIGHT_RAISED if int(own[last]) % SPRING == CLEAR else 0
        if contact == FLIGHT:
            for i in range(last):
                if int(own[i]) % SPRING != CLEAR:
                    return BETWEEN
        return contact

    @inlined
    def force(self, contact: int, line: BaseLine, own: Vector) -> BaseForce:
        """Return the forces of all springs together."""
        upward = moment = dissipated = 0.0
        if contact == FLIGHT:
            return BaseForce(0.0, 0.0, 0.0)
        for i in range(len(self.places)):
            spring, state = int(own[i]) % SPRING, int(own[i]) // SPRING
            point, variables = self.point(i, line), self.law_variables(own, i)
            length = self.lengths[i]
            if spring == TOUCHING:
                force = length * self.law.force(state, point, variables)
                upward += force
                lever = line.left_lever + point.place * (line.right_lever - line.left_lever)
                moment += force * lever
                dissipated += length * self.law.power(state, point, variables)
            elif spring == RELAXING:  # the spring relaxes against its dashpot
                dissipated -= length * self.law.spring(point, variables) * point.speed
        return BaseForce(upward, moment, dissipated)

    @inlined
    def flow(self, contact: int, line: BaseLine, own: Vector) -> Variables:
        """Return the rates of the laws' variables; contacts change at events only."""
        rates = self.zero_rates
        count = self.law.variables()
        for i in range(len(self.places)):
            state = int(own[i]) // SPRING if int(own[i]) % SPRING == TOUCHING else FREE
            rates_of_law = self.law.rates(state, self.point(i, line), self.law_variables(own, i))
            rates = with_numbers(rates, len(self.places) + i * count, rates_of_law)
        return rates

    @kernel
    def energy(self, line: BaseLine, own: Vector) -> tuple[float, float]:
        """Return the energy of all springs, and the energy less that at rest."""
        stored = change = 0.0
        for i in range(len(self.places)):
            point, variables = self.point(i, line), self.law_variables(own, i)
            energy, less = 0.0, -self.rest_energy
            if point.pressed > self.law.sunk(variables):
                energy, less = self.law.energies(point, self.rest_energy, variables)
            stored += self.lengths[i] * energy
            change += self.lengths[i] * less
        return stored, change

    @inlined
    def spring_number(self, left: bool, which: int) -> int:
        """Return the number of the spring of a guard; guards of an end count from the outside."""
        return which // GUARDS if left else len(self.places) - 1 - which // GUARDS

    @inlined
    def guards_of(self, contact: int, left: bool, line: BaseLine, own: Vector) -> Guards:
        """Return the guards of the springs on one side, and their rates."""
        values, changes, count = self.idle_guards, constant(0.0, self.idle_guards), len(self.places)
        per_rest, per_force = 1.0 / self.settlement, 1.0 / self.pressure
        for k in range(len(self.idle_guards) // GUARDS if left else count // 2):
            i = self.spring_number(left, GUARDS * k)
            spring, state = int(own[i]) % SPRING, int(own[i]) // SPRING
            point, variables = self.point(i, line), self.law_variables(own, i)
            pressed = (point.pressed - self.law.sunk(variables)) * per_rest
            value, change = pressed, point.speed * per_rest
            other, other_change = 1.0, 0.0
            if spring == CLEAR:
                value, change = -value, -change
            else:
                force = self.law.force(state, point, variables) * per_force
                rate = self.law.force_rate(state, point, variables) * per_force
                if spring == RELAXING:
                    other, other_change = -force, -rate
                else:
                    if self.law.return_rate() > 0.0:
                        value, change = force, rate
                    other, other_change = self.law.guard(state, point, variables)
            values = with_numbers(values, GUARDS * k, (value, other))
            changes = with_numbers(changes, GUARDS * k, (change, other_change))
        return Guards(values, changes)

    @kernel
    def switch(self, contact: int, left: bool, which: int, line: BaseLine, own: Vector) -> EndEvent:
        """Switch a spring, with all others that make the same switch at the same instant."""
        i = self.spring_number(left, which)
        was, here = int(own[i]), self.point(i, line)
        for j in range(len(self.places)):
            other = self.point(j, line)
            near = abs(other.pressed - here.pressed) <= SIMULTANEOUS * self.settlement
            if j == i or (int(own[j]) == was and near and other.speed * here.speed >= 0.0):
                own[j] = self.spring_after(was, which % GUARDS, other, self.law_variables(own, j))
                self.law.settle(int(own[j]) // SPRING, other, self.law_variables(own, j))
        new, event = self.contact_of(own), SILENT
        held_left, held_right = self.is_held(new, True), self.is_held(new, False)
        was_left, was_right = self.is_held(contact, True), self.is_held(contact, False)
        if (was_left and not held_left) or (was_right and not held_right):
            event = SEPARATION
        elif (held_left and not was_left) or (held_right and not was_right):
            event = REENGAGEMENT
        outermost = which < GUARDS
        return EndEvent(new, event, outermost and event != SILENT)

    @kernel
    def spring_after(self, was: int, guard: int, point: Point, own: Any) -> float:
        """Return the variable of a spring after one of its guards has fallen."""
        spring, state = was % SPRING, was // SPRING
        if spring == TOUCHING and guard == OTHER:
            return float(TOUCHING + SPRING * ((state + 1) % self.law.states()))
        if spring == TOUCHING:
            below = point.pressed - self.law.sunk(own) > SIMULTANEOUS * self.settlement
            return float(RELAXING if below and self.law.return_rate() > 0.0 else CLEAR)
        return float(CLEAR if spring == RELAXING and guard == CONTACT else TOUCHING)

    @kernel
    def level(self, left: bool, line: BaseLine, own: Vector) -> float:
        """Return how far below its unloaded level the outermost spring on a side is [m]."""
        i = 0 if left else len(self.places) - 1
        return self.point(i, line).pressed - self.law.sunk(self.law_variables(own, i))

    @kernel
    def released(self, contact: int, left: bool, line: BaseLine, own: Vector) -> int:
        """Return the contact with all springs clear."""
        for i in range(len(self.places)):
            own[i] = float(CLEAR)
        return FLIGHT

    @kernel
    def starting(self, line: BaseLine, own: Vector) -> int:
        """Return the contact at the start of a run; springs pressed too much have yielded."""
        count = len(self.places)
        self.law.reset(view_of(own, count, len(self.zero_rates) - count))
        for i in range(count):
            point, variables = self.point(i, line), self.law_variables(own, i)
            self.law.settle(0, point, variables)
            own[i] = float(TOUCHING)
            if point.pressed <= self.law.sunk(variables):
                own[i] = float(CLEAR)
            elif self.law.return_rate() > 0.0 and self.law.force(0, point, variables) <= 0.0:
                own[i] = float(RELAXING)
        return self.contact_of(own)

    def resting_height(self, left: float, right: float, own: Any) -> float:
        """Return the height at which the springs carry the weight [m], found numerically."""
        return equilibrium_height(self, self.weight, 2.0 * self.settlement, (left, right), own)

    @kernel
    def observed(self, contact: int, line: BaseLine, own: Vector) -> Variables:
        """Return reaction, length in contact, greatest pressure, columns of outermost springs."""
        length = greatest = 0.0
        last = len(self.places) - 1
        for i in range(last + 1):
            if int(own[i]) % SPRING == TOUCHING:
                state, point = int(own[i]) // SPRING, self.point(i, line)
                length += self.lengths[i]
                greatest = max(greatest, self.law.force(state, point, self.law_variables(own, i)))
        law_columns = self.law_columns(0, line, own) + self.law_columns(last, line, own)
        return (self.force(contact, line, own).upward, length, greatest) + law_columns

    @kernel
    def law_columns(self, i: int, line: BaseLine, own: Vector) -> Variables:
        """Return the columns of the law of one spring."""
        state = int(own[i]) // SPRING if int(own[i]) % SPRING == TOUCHING else FREE
        return self.law.seen(state, self.point(i, line), self.law_variables(own, i))
