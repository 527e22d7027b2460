"""What a base that gives way is to the body on it.

A base is a named tuple of its parameters, per unit mass, with the methods below. It knows the
ends of the body's base line, not the body: any body stands on any base. What is said of one
end holds for the left one where `left` is true.

The **contact** of a base is a whole number of its own, below :meth:`Base.contacts`. An end
that *is held* bears, or is about to; where neither is, the body flies. Variables of its own,
with rates of first order, stand in the state behind the coordinates.
"""

from collections.abc import Callable
from typing import Any, Final, NamedTuple, TypeAlias

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.body import BaseLine
from rockframe.dynamics.protocol import Guards as Guards

Variables: TypeAlias = tuple[float, ...]
"""Numbers, of which a base has as many as it needs; an empty tuple if none."""
SIMULTANEOUS: Final = 1e-9
"""Share of the settlement within which ends land, or leave, together."""


class BaseForce(NamedTuple):
    """What a base does to the body on it, per unit mass."""

    upward: float  # force
    moment: float  # generalised force on the rotation
    dissipated: float  # power


class EndEvent(NamedTuple):
    """What a base's switch has made of it."""

    contact: int
    event: int  # an EventKind of rockframe.dynamics.events
    crossed: bool  # whether the end is at the level where it parts from the base, or meets it


class Base:
    """A base that gives way, under both ends of a body's base line. A mixin of named tuples.

    The first methods are to be given. The others are those of a base without variables, whose
    ends are held below its unloaded level, and which lands and lets go without a jump of its
    force.
    """

    __slots__ = ()

    def contacts(self) -> int:
        """Give the number of contacts."""
        raise NotImplementedError

    def end_guards(self) -> int:
        """Give the number of guards that each end has."""
        raise NotImplementedError

    def is_held(self, contact: int, left: bool) -> bool:
        """Whether an end is held."""
        raise NotImplementedError

    def force(self, contact: int, line: BaseLine, own: Any) -> BaseForce:
        """Give force, moment and dissipated power."""
        raise NotImplementedError

    def energy(self, line: BaseLine, own: Any) -> tuple[float, float]:
        """Give the stored energy, and that less the energy at rest."""
        raise NotImplementedError

    def guards_of(self, contact: int, left: bool, line: BaseLine, own: Any) -> Guards:
        """Give the guards of an end, and their rates; the line has the accelerations, too.

        A guard is positive as long as the contact lasts; those without meaning are 1, with a
        rate of 0.
        """
        raise NotImplementedError

    def switch(self, contact: int, left: bool, which: int, line: BaseLine, own: Any) -> EndEvent:
        """Give what happens when a guard of an end, by its number, falls through zero.

        The base's own variables are set where they change.
        """
        raise NotImplementedError

    def level(self, left: bool, line: BaseLine, own: Any) -> float:
        """Give how much higher than an end the level is at which it parts from the base."""
        raise NotImplementedError

    def starting(self, line: BaseLine, own: Any) -> int:
        """Give the contact at the start of a run, and set the base's own variables."""
        raise NotImplementedError

    def resting_height(self, left: float, right: float, own: Any) -> float:
        """Give the height at which the base carries the body at rest.

        `left` and `right` are the heights of the ends above the height that is looked for.
        """
        raise NotImplementedError

    def observed(self, contact: int, line: BaseLine, own: Any) -> Variables:
        """Give what users see of the base."""
        raise NotImplementedError

    @inlined
    def touches(self, contact: int, left: bool) -> bool:
        """Whether an end is held and its force counts as long as it presses."""
        return self.is_held(contact, left)

    @kernel
    def tilt(self, contact: int) -> float:
        """Give the side to which the contact will rotate a body that is upright and at rest."""
        left = 1.0 if self.is_held(contact, True) else 0.0
        return left - (1.0 if self.is_held(contact, False) else 0.0)

    @inlined
    def variables(self) -> int:
        """Give the number of variables of the base's own."""
        return 0

    @inlined
    def read(self, state: Vector, first: int) -> Any:
        """Read the base's own variables from a state, from an index on."""
        return ()

    @inlined
    def flow(self, contact: int, line: BaseLine, own: Any) -> Variables:
        """Give the rates of the base's own variables."""
        return ()

    @kernel
    def is_level(self, left: bool, line: BaseLine, own: Any) -> bool:
        """Whether an end that slides has come to the level where it parts, but for rounding."""
        return True

    @inlined
    def follows(self, contact: int, left: bool) -> int:
        """Give the contact in which an end that slides takes part: it touches without force."""
        return self.in_flight()

    def in_flight(self) -> int:
        """Give the contact in which no end is held."""
        raise NotImplementedError

    @inlined
    def following_rate(self) -> float:
        """Give the rate at which a base without force returns to its level [s^-1]."""
        return 0.0

    @kernel
    def following_speed(self, left: bool, line: BaseLine, own: Any) -> float:
        """Give the speed of an end that the base follows without a force, :eq:`eq-forceless`."""
        return self.following_rate() * self.level(left, line, own)

    @inlined
    def least_landing(self) -> float:
        """Give the speed of a landing below which the base's answer is rounding noise."""
        return 0.0

    @kernel
    def released(self, contact: int, left: bool, line: BaseLine, own: Any) -> int:
        """Give the contact after an end that touched without force has left."""
        return self.in_flight()

    @kernel
    def presses(self, contact: int, left: bool, line: BaseLine, own: Any) -> bool:
        """Whether the base still presses an end that has just left."""
        return False

    @kernel
    def will_press(self, left: bool, line: BaseLine, own: Any) -> bool:
        """Whether the force of the base on an end would rise with the line's accelerations."""
        return False

    @kernel
    def held(self, contact: int, left: bool) -> int:
        """Give the contact with an end that touches; asked where the base presses one that left."""
        return contact

    @kernel
    def waiting(self, contact: int, left: bool) -> int:
        """Give the contact of an end that has left while the base still presses it."""
        return contact

    @kernel
    def unpressed(self, contact: int, left: bool) -> int:
        """Give the contact of an end that stays held though the base has ceased to press it."""
        return contact

    @kernel
    def engaged(self, contact: int, left: bool, line: BaseLine, own: Any) -> int:
        """Give the contact after an end has come back and its body has been held."""
        return contact

    @kernel
    def disturbed(self, contact: int) -> int:
        """Give the contact after something else than an event of its own changed the speeds."""
        return contact

    @kernel
    def rebound(self, left: bool) -> float:
        """Give the restitution of an end that lands with an impact."""
        return 1.0


def root_above_zero(function: Callable[[float], float], start: float) -> float:
    """Give where a function that is negative at zero, and grows, comes to zero."""
    from scipy.optimize import root_scalar

    while function(start) <= 0.0:
        start *= 2.0
    found = root_scalar(function, bracket=(0.0, start), xtol=1e-18, rtol=1e-14)
    return float(found.root)


def height_under(
    base: Base, weight: float, depth: float, ends: tuple[float, float], own: Any
) -> float:
    """Give the height at which a base carries a weight, found by numbers.

    Parameters
    ----------
    base : Base
        The base.
    weight : float
        On it, per unit mass [m s^-2].
    depth : float
        Its settlement, about [m].
    ends : tuple of float
        Heights of the ends above the height that is looked for [m].
    own : Variables
        The base's own variables, which are set to those of a start.

    Returns
    -------
    float
        [m]
    """

    def excess(height: float) -> float:
        line = BaseLine(height + ends[0], height + ends[1], 0.0, 0.0, 0.0, 0.0)
        return float(base.force(base.starting(line, own), line, own).upward) - weight

    highest = depth - min(ends)
    return highest - root_above_zero(lambda down: excess(highest - down), depth)
