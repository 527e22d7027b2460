"""A base under a body of a chain: pads or a bed, as a number in the row of the body says."""

from functools import partial
from typing import Final, NamedTuple

from rockframe.compiled import Vector, call_of_either, inlined, kernel
from rockframe.dynamics.base import Base, Guards, Variables
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


_of_law: Final = partial(
    call_of_either, is_first=f"self.which == {ON_PADS}", first="self.pads()", second="self.bed()"
)
"""Makes a method that calls the one of its name of the pads or of the bed."""


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

    is_held = inlined(_of_law(Base.is_held))
    touches = inlined(_of_law(Base.touches))
    tilt = kernel(_of_law(Base.tilt))
    force = inlined(_of_law(Base.force))
    energy = kernel(_of_law(Base.energy))
    switch = kernel(_of_law(Base.switch))
    level = kernel(_of_law(Base.level))
    is_level = kernel(_of_law(Base.is_level))
    follows = inlined(_of_law(Base.follows))
    following_rate = inlined(_of_law(Base.following_rate))
    least_landing = kernel(_of_law(Base.least_landing))
    released = kernel(_of_law(Base.released))
    presses = kernel(_of_law(Base.presses))
    will_press = kernel(_of_law(Base.will_press))
    with_end = kernel(_of_law(Base.with_end))
    engaged = kernel(_of_law(Base.engaged))
    disturbed = kernel(_of_law(Base.disturbed))
    rebound = kernel(_of_law(Base.rebound))
