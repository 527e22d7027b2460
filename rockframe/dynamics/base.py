"""The interface of a deformable base: forces, contacts and events under the ends of a body.

A base is a named tuple of its parameters, per unit mass, with the methods below. It knows the
ends of the body's base line, not the body, so that any body can stand on any base. The argument
`left` is true for the left end.

The **contact** of a base is a whole number of its own, below :meth:`Base.contacts`. An end
that *is held* presses the base, or is about to; if neither end is held, the body flies. The
base's own variables obey first-order equations, and follow the coordinates in the state.
"""

from collections.abc import Callable
from typing import Any, Final, NamedTuple, TypeAlias, cast

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.body import BaseLine
from rockframe.dynamics.protocol import Guards as Guards
from rockframe.errors import AssemblyError

Variables: TypeAlias = tuple[float, ...]
"""A base's own variables, as many as it needs; an empty tuple if it has none."""
SIMULTANEOUS: Final = 1e-9
"""Share of the settlement within which ends land, or leave, together."""
_DEEPEST: Final = 1e18
"""Compression, over its estimate, that is tried before a base is refused [1]."""
_LARGEST_EXCESS: Final = 1e-6
"""Error of the force of a base in equilibrium over the weight on it [1]."""


class BaseForce(NamedTuple):
    """What a base does to the body on it, per unit mass."""

    upward: float  # force [m s^-2]
    moment: float  # generalised force on the rotation [m^2 s^-2]
    dissipated: float  # power [m^2 s^-3]


class EndEvent(NamedTuple):
    """What follows when a guard of an end has fallen through zero."""

    contact: int  # of the base from then on
    event: int  # an EventKind of rockframe.dynamics.events
    crossed: bool  # whether the end is at the level where it separates from the base, or lands


class Base:
    """A deformable base under both ends of a body's base line. A mixin of named tuples.

    Methods that raise `NotImplementedError` must be defined. The others are implemented for a base
    without own variables that holds ends below its unloaded level, and whose force does not jump
    as an end lands or lifts off.
    """

    __slots__ = ()

    def contacts(self) -> int:
        """Return the number of contacts."""
        raise NotImplementedError

    def end_guards(self) -> int:
        """Return the number of guards that each end has."""
        raise NotImplementedError

    def is_held(self, contact: int, left: bool) -> bool:
        """Whether an end is held."""
        raise NotImplementedError

    def force(self, contact: int, line: BaseLine, own: Any) -> BaseForce:
        """Return force, moment and dissipated power of the base if a body moves as `line`."""
        raise NotImplementedError

    def energy(self, line: BaseLine, own: Any) -> tuple[float, float]:
        """Return the elastic energy, and how much more that is than at rest [m^2 s^-2]."""
        raise NotImplementedError

    def guards_of(self, contact: int, left: bool, line: BaseLine, own: Any) -> Guards:
        """Return the guards of an end, and their rates; `line` includes the accelerations here.

        A guard is positive as long as the contact lasts; one without meaning in the contact is 1,
        with a rate of 0.
        """
        raise NotImplementedError

    def switch(self, contact: int, left: bool, which: int, line: BaseLine, own: Any) -> EndEvent:
        """Return what follows when the guard `which` of an end falls through zero.

        Own variables that jump are changed in `own`.
        """
        raise NotImplementedError

    def level(self, left: bool, line: BaseLine, own: Any) -> float:
        """Return how far below its level of separation from the base an end is [m]."""
        raise NotImplementedError

    def starting(self, line: BaseLine, own: Any) -> int:
        """Return the contact at the start of a run, and set the base's own variables."""
        raise NotImplementedError

    def resting_height(self, left: float, right: float, own: Any) -> float:
        """Return the height h at which the base carries the body at rest [m].

        The ends are then at the heights h + `left` and h + `right`.
        """
        raise NotImplementedError

    def observed(self, contact: int, line: BaseLine, own: Any) -> Variables:
        """Return the values of the base's columns in the results."""
        raise NotImplementedError

    @inlined
    def touches(self, contact: int, left: bool) -> bool:
        """Whether an end is held, with a force that acts as long as it is compressive."""
        return self.is_held(contact, left)

    @kernel
    def tilt(self, contact: int) -> float:
        """Return the sign of the rotation that begins in a contact from upright rest, or 0."""
        left = 1.0 if self.is_held(contact, True) else 0.0
        return left - (1.0 if self.is_held(contact, False) else 0.0)

    @inlined
    def variables(self) -> int:
        """Return the number of variables of the base's own."""
        return 0

    @inlined
    def read(self, state: Vector, first: int) -> Any:
        """Return the base's own variables, which begin at an index of the state."""
        return ()

    @inlined
    def flow(self, contact: int, line: BaseLine, own: Any) -> Variables:
        """Return the rates of the base's own variables."""
        return ()

    @kernel
    def is_level(self, left: bool, line: BaseLine, own: Any) -> bool:
        """Whether an end in sliding contact is at its level of separation, but for rounding."""
        return True

    @inlined
    def follows(self, contact: int, left: bool) -> int:
        """Return the contact with an end in sliding contact: it touches the base without force."""
        return self.in_flight()

    def in_flight(self) -> int:
        """Return the contact in which no end is held."""
        raise NotImplementedError

    @inlined
    def following_rate(self) -> float:
        """Return the rate at which a base without force returns to its level [s^-1]."""
        return 0.0

    @kernel
    def following_speed(self, left: bool, line: BaseLine, own: Any) -> float:
        """Return the upward speed at which an unloaded base rises, :eq:`eq-forceless` [m s^-1]."""
        return self.following_rate() * self.level(left, line, own)

    @inlined
    def least_landing(self) -> float:
        """Return the speed of a landing below which the base's force is rounding noise [m s^-1]."""
        return 0.0

    @kernel
    def released(self, contact: int, left: bool, line: BaseLine, own: Any) -> int:
        """Return the contact after an end that touched the base without force has lifted off."""
        return self.in_flight()

    @kernel
    def presses(self, contact: int, left: bool, line: BaseLine, own: Any) -> bool:
        """Whether the base still presses an end that has just lifted off."""
        return False

    @kernel
    def will_press(self, left: bool, line: BaseLine, own: Any) -> bool:
        """Whether the force of the base on an end would rise with the line's accelerations."""
        return False

    @kernel
    def with_end(self, contact: int, left: bool, end: int) -> int:
        """Return the contact with another contact of an end, where the base tells these apart.

        `end` is `TOUCHING`, `LEAVING` or `ENGAGING` of :mod:`rockframe.dynamics.pads`.
        """
        return contact

    @kernel
    def engaged(self, contact: int, left: bool, line: BaseLine, own: Any) -> int:
        """Return the contact after an end has landed and its body is held by the restraint."""
        return contact

    @kernel
    def disturbed(self, contact: int) -> int:
        """Return the contact after an event elsewhere has changed the speeds of the ends."""
        return contact

    @kernel
    def rebound(self, left: bool) -> float:
        """Return the coefficient of restitution of an end that lands with an impact [1]."""
        return 1.0


def positive_root(function: Callable[[float], float], start: float, owner: str) -> float:
    """Return the depth at which an excess of force over the weight is zero, searched from `start`.

    The excess is an increasing function that is negative at zero; `owner` is its law.
    """
    from scipy.optimize import root_scalar

    missing, deepest = -function(0.0), start * _DEEPEST
    if missing <= 0.0:
        msg = f"{owner}: the base carries the weight on it without compression"
        raise AssemblyError([msg])
    unbalanced = AssemblyError([f"{owner}: no compression of the base carries the weight on it"])
    while not function(start) > 0.0:
        start *= 2.0
        if not start < deepest:
            raise unbalanced
    depth = float(root_scalar(function, bracket=(0.0, start), xtol=1e-18, rtol=1e-14).root)
    if abs(function(depth)) > _LARGEST_EXCESS * missing:  # the force jumps there
        raise unbalanced
    return depth


def equilibrium_height(
    base: Base, weight: float, depth: float, ends: tuple[float, float], own: Any
) -> float:
    """Return the height [m] at which a base carries a weight, searched near a settlement `depth`.

    `ends` are the heights of both ends above it; `own` is set to the variables at a start there.
    """

    def excess(height: float) -> float:
        line = BaseLine(height + ends[0], height + ends[1], 0.0, 0.0, 0.0, 0.0)
        return float(base.force(base.starting(line, own), line, own).upward) - weight

    highest, owner = depth - min(ends), type(cast("Any", base).law).__name__
    return highest - positive_root(lambda down: excess(highest - down), depth, owner)
