"""A base under a body of a chain: pads or a bed, as a number in the row of the body says."""

from typing import Final, NamedTuple

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.base import Base, BaseForce, EndEvent, Guards, Variables
from rockframe.dynamics.bed import Bed
from rockframe.dynamics.body import BaseLine
from rockframe.dynamics.pads import CORNER_GUARDS, ElasticPads
from rockframe.dynamics.point_law import Viscoelastic

ON_PADS: Final = 0
ON_BED: Final = 1
ON_RIGID: Final = 2  # a bed without stiffness: constraints hold its ends
MAX_LAW_NUMBERS: Final = 10
"""Numbers of a law, as many as the longest takes, which is that of pads."""


class LawNumbers(NamedTuple):
    """Which law a base has, and its numbers."""

    which: int
    numbers: Vector


class AnyBase(Base, LawNumbers):
    """A base whose law is chosen at run time, so that one machine code serves all laws."""

    __slots__ = ()

    @inlined
    def pads(self) -> ElasticPads:
        """Return the pads."""
        n = self.numbers
        law = Viscoelastic(n[0], n[1])
        return ElasticPads(law, n[2], n[3], n[4], n[5], n[6], n[7], n[8], n[9])

    @inlined
    def bed(self) -> Bed:
        """Return the bed."""
        n = self.numbers
        return Bed(n[0], n[1], n[2], n[3], n[4] != 0.0)

    @kernel
    def end_guards(self) -> int:
        """Return the number of guards of an end on pads; on a bed all but the first are idle."""
        return CORNER_GUARDS

    @inlined
    def guards_of(self, contact: int, left: bool, line: BaseLine, own: Variables) -> Guards:
        """Return the guards of an end, and their rates; on a bed all but the first are idle."""
        if self.which == ON_PADS:
            return self.pads().guards_of(contact, left, line, own)
        guards = self.bed().guards_of(contact, left, line, own)
        return Guards((guards.values[0], 1.0, 1.0), (guards.changes[0], 0.0, 0.0))

    @kernel
    def observed(self, contact: int, line: BaseLine, own: Variables) -> Variables:
        """Return the values of the base's columns in the results, with 0 where pads have none."""
        if self.which == ON_PADS:
            left, right = self.pads().observed(contact, line, own)
            return left, right, 0.0
        return self.bed().observed(contact, line, own)

    @inlined
    def is_held(self, contact: int, left: bool) -> bool:
        """Whether an end is held."""
        if self.which == ON_PADS:
            return self.pads().is_held(contact, left)
        return self.bed().is_held(contact, left)

    @inlined
    def touches(self, contact: int, left: bool) -> bool:
        """Whether an end is held, with a force that acts as long as it is compressive."""
        if self.which == ON_PADS:
            return self.pads().touches(contact, left)
        return self.bed().touches(contact, left)

    @kernel
    def tilt(self, contact: int) -> float:
        """Return the sign of the rotation that begins in a contact from upright rest, or 0."""
        if self.which == ON_PADS:
            return self.pads().tilt(contact)
        return self.bed().tilt(contact)

    @inlined
    def force(self, contact: int, line: BaseLine, own: Variables) -> BaseForce:
        """Return force, moment and dissipated power of the base."""
        if self.which == ON_PADS:
            return self.pads().force(contact, line, own)
        return self.bed().force(contact, line, own)

    @kernel
    def energy(self, line: BaseLine, own: Variables) -> tuple[float, float]:
        """Return the elastic energy, and how much more that is than at rest."""
        if self.which == ON_PADS:
            return self.pads().energy(line, own)
        return self.bed().energy(line, own)

    @kernel
    def switch(
        self, contact: int, left: bool, which: int, line: BaseLine, own: Variables
    ) -> EndEvent:
        """Return what follows when the guard `which` of an end falls through zero."""
        if self.which == ON_PADS:
            return self.pads().switch(contact, left, which, line, own)
        return self.bed().switch(contact, left, which, line, own)

    @kernel
    def level(self, left: bool, line: BaseLine, own: Variables) -> float:
        """Return how far below its level of separation from the base an end is [m]."""
        if self.which == ON_PADS:
            return self.pads().level(left, line, own)
        return self.bed().level(left, line, own)

    @kernel
    def is_level(self, left: bool, line: BaseLine, own: Variables) -> bool:
        """Whether an end in sliding contact is at its level of separation, but for rounding."""
        if self.which == ON_PADS:
            return self.pads().is_level(left, line, own)
        return self.bed().is_level(left, line, own)

    @inlined
    def follows(self, contact: int, left: bool) -> int:
        """Return the contact with an end in sliding contact: it touches the base without force."""
        if self.which == ON_PADS:
            return self.pads().follows(contact, left)
        return self.bed().follows(contact, left)

    @inlined
    def following_rate(self) -> float:
        """Return the rate at which a base without force returns to its level [s^-1]."""
        if self.which == ON_PADS:
            return self.pads().following_rate()
        return self.bed().following_rate()

    @kernel
    def least_landing(self) -> float:
        """Return the speed of a landing below which the base's force is rounding noise [m s^-1]."""
        if self.which == ON_PADS:
            return self.pads().least_landing()
        return self.bed().least_landing()

    @kernel
    def released(self, contact: int, left: bool, line: BaseLine, own: Variables) -> int:
        """Return the contact after an end that touched the base without force has lifted off."""
        if self.which == ON_PADS:
            return self.pads().released(contact, left, line, own)
        return self.bed().released(contact, left, line, own)

    @kernel
    def presses(self, contact: int, left: bool, line: BaseLine, own: Variables) -> bool:
        """Whether the base still presses an end that has just lifted off."""
        if self.which == ON_PADS:
            return self.pads().presses(contact, left, line, own)
        return self.bed().presses(contact, left, line, own)

    @kernel
    def will_press(self, left: bool, line: BaseLine, own: Variables) -> bool:
        """Whether the force of the base on an end would rise with the line's accelerations."""
        if self.which == ON_PADS:
            return self.pads().will_press(left, line, own)
        return self.bed().will_press(left, line, own)

    @kernel
    def with_end(self, contact: int, left: bool, end: int) -> int:
        """Return the contact with another contact of an end, where the base tells these apart."""
        if self.which == ON_PADS:
            return self.pads().with_end(contact, left, end)
        return self.bed().with_end(contact, left, end)

    @kernel
    def engaged(self, contact: int, left: bool, line: BaseLine, own: Variables) -> int:
        """Return the contact after an end has landed and the restraint has caught its body."""
        if self.which == ON_PADS:
            return self.pads().engaged(contact, left, line, own)
        return self.bed().engaged(contact, left, line, own)

    @kernel
    def disturbed(self, contact: int) -> int:
        """Return the contact after an event elsewhere has changed the speeds of the ends."""
        if self.which == ON_PADS:
            return self.pads().disturbed(contact)
        return self.bed().disturbed(contact)

    @kernel
    def rebound(self, left: bool) -> float:
        """Return the coefficient of restitution of an end that lands with an impact [1]."""
        if self.which == ON_PADS:
            return self.pads().rebound(left)
        return self.bed().rebound(left)

    @kernel
    def starting(self, line: BaseLine, own: Variables) -> int:
        """Return the contact at the start of a run."""
        if self.which == ON_PADS:
            return self.pads().starting(line, own)
        return self.bed().starting(line, own)

    @kernel
    def resting_height(self, left: float, right: float, own: Variables) -> float:
        """Return the height at which the base carries the body at rest [m]."""
        if self.which == ON_PADS:
            return self.pads().resting_height(left, right, own)
        return self.bed().resting_height(left, right, own)
