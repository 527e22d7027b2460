"""What a base that gives way is to the body on it.

A base is a named tuple of its parameters, per unit mass, with the methods below. It knows the
ends of the body's base line, not the body: any body stands on any base. What is said of one
end holds for the left one where `left` is true.

The **contact** of a base is a whole number of its own, below :meth:`Base.contacts`. An end
that *is held* bears, or is about to; where neither is, the body flies. Variables of its own,
with rates of first order, stand in the state behind the coordinates.
"""

from typing import Any, NamedTuple, Protocol, TypeAlias

from rockframe.compiled import Vector
from rockframe.dynamics.body import BaseLine
from rockframe.dynamics.protocol import Guards as Guards

Variables: TypeAlias = tuple[float, ...]
"""Numbers, of which a base has as many as it needs; an empty tuple if none."""


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


class Base(Protocol):
    """A base that gives way, under both ends of a body's base line."""

    def contacts(self) -> int:
        """Give the number of contacts."""
        ...

    def end_guards(self) -> int:
        """Give the number of guards that each end has."""
        ...

    def is_held(self, contact: int, left: bool) -> bool:
        """Whether an end is held."""
        ...

    def touches(self, contact: int, left: bool) -> bool:
        """Whether an end is held and its force counts as long as it presses."""
        ...

    def tilt(self, contact: int) -> float:
        """Give the side to which the contact will rotate a body that is upright and at rest."""
        ...

    def variables(self) -> int:
        """Give the number of variables of the base's own."""
        ...

    def read(self, state: Vector, first: int) -> Any:
        """Read the base's own variables from a state, from an index on."""
        ...

    def flow(self, contact: int, line: BaseLine, own: Any) -> Variables:
        """Give the rates of the base's own variables."""
        ...

    def force(self, contact: int, line: BaseLine, own: Any) -> BaseForce:
        """Give force, moment and dissipated power."""
        ...

    def energy(self, line: BaseLine, own: Any) -> tuple[float, float]:
        """Give the stored energy, and that less the energy at rest."""
        ...

    def guards_of(
        self, contact: int, left: bool, line: BaseLine, acceleration: float, own: Any
    ) -> Guards:
        """Give the guards of an end, and their rates.

        A guard is positive as long as the contact lasts; those without meaning are 1, with a
        rate of 0. `acceleration` is that of the end, upwards.
        """
        ...

    def switch(self, contact: int, left: bool, which: int, line: BaseLine, own: Any) -> EndEvent:
        """Give what happens when a guard of an end, by its number, falls through zero."""
        ...

    def variables_after(self, was: int, contact: int, line: BaseLine, own: Any) -> Any:
        """Give the base's own variables after a switch of contact, as :meth:`read` gives them."""
        ...

    def level(self, left: bool, line: BaseLine, own: Any) -> float:
        """Give how much higher than an end the level is at which it parts from the base."""
        ...

    def is_level(self, left: bool, line: BaseLine, own: Any) -> bool:
        """Whether an end that slides has come to that level, but for rounding."""
        ...

    def follows(self, contact: int, left: bool) -> int:
        """Give the contact in which an end that slides takes part: it touches without force."""
        ...

    def following_speed(self, left: bool, line: BaseLine, own: Any) -> float:
        """Give the speed of an end that the base follows without a force between them."""
        ...

    def following_rate(self) -> float:
        """Give the rate at which a base without force returns to its level [s^-1]."""
        ...

    def least_landing(self) -> float:
        """Give the speed of a landing below which the base's answer is rounding noise."""
        ...

    def released(self, contact: int, left: bool, line: BaseLine, own: Any) -> int:
        """Give the contact after an end that touched without force has left."""
        ...

    def presses(self, contact: int, left: bool, line: BaseLine, own: Any) -> bool:
        """Whether the base still presses an end that has just left."""
        ...

    def will_press(self, left: bool, line: BaseLine, acceleration: float, own: Any) -> bool:
        """Whether the force of the base on an end would rise with an acceleration."""
        ...

    def held(self, contact: int, left: bool) -> int:
        """Give the contact with an end that touches."""
        ...

    def waiting(self, contact: int, left: bool) -> int:
        """Give the contact of an end that has left while the base still presses it."""
        ...

    def unpressed(self, contact: int, left: bool) -> int:
        """Give the contact of an end that stays held though the base has ceased to press it."""
        ...

    def engaged(self, contact: int, left: bool, line: BaseLine, own: Any) -> int:
        """Give the contact after an end has come back and its body has been held."""
        ...

    def disturbed(self, contact: int) -> int:
        """Give the contact after something else than an event of its own changed the speeds."""
        ...

    def rebound(self, left: bool) -> float:
        """Give the restitution of an end that lands with an impact."""
        ...

    def starting(self, line: BaseLine, own: Any) -> int:
        """Give the contact at the start of a run."""
        ...

    def resting_height(self, left: float, right: float, own: Any) -> float:
        """Give the height at which the base carries the body at rest.

        `left` and `right` are the heights of the ends above the height that is looked for.
        """
        ...

    def observed(self, contact: int, line: BaseLine, own: Any) -> Variables:
        """Give what users see of the base."""
        ...
