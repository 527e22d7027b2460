"""Force laws of a point of a base, for pads and springs, and how to write another one.

Two pads, or a bed of many springs, determine when a point touches the base, moves with it without
a force, or is clear of it. A law gives the force on a point that touches. It is a named tuple of
numbers per unit mass with some of the methods of :class:`PointLaw`; :func:`point_law` gives it the
others.

The force depends on the **compression** of the point: its depth below the level of the base before
it was ever loaded. A law may have **states**, such as elastic and yielding, which its guard ends,
and **variables** of its own, all zero at the start.
"""

import inspect
from collections.abc import Callable, Collection, Iterable
from typing import Any, Final, NamedTuple, TypeVar

from rockframe.compiled import Vector, inlined, kernel, view_of
from rockframe.dynamics.base import Variables
from rockframe.dynamics.body import BaseLine
from rockframe.dynamics.protocol import Guards
from rockframe.errors import ArgumentError, short_repr
from rockframe.suggestions import with_hints

Law = TypeVar("Law")
FREE: Final = -1
"""In place of the state of a point that does not touch."""
REQUIRED: Final = ("spring", "force_rate", "energy")
"""Methods that a law must give."""


class Point(NamedTuple):
    """A point of a base line, and the motion of the whole line."""

    pressed: float  # compression [m]
    speed: float  # rate of the compression [m s^-1]
    acceleration: float  # its second rate [m s^-2]; 0 where it is not known yet
    rise: float  # height above the place at rest
    settlement: float  # compression at that place
    place: float  # coordinate along the base, 0 at its left end, 1 at its right end
    line: BaseLine


@inlined
def point_at(line: BaseLine, place: float, settlement: float) -> Point:
    """Return compression and motion of the point at a place between the ends."""
    rise = line.left + place * (line.right - line.left)
    speed = line.left_speed + place * (line.right_speed - line.left_speed)
    change = line.left_acceleration + place * (line.right_acceleration - line.left_acceleration)
    return Point(settlement - rise, -speed, -change, rise, settlement, place, line)


class PointLaw:
    """The methods of a law; the first three are required, the others override defaults.

    `state` is the state of the law, `own` its variables at the point, by their indices.
    """

    __slots__ = ()

    def spring(self, point: Point, own: Any) -> float:
        """Return the elastic force, by which the stored energy grows with the compression."""
        raise NotImplementedError

    def force_rate(self, state: int, point: Point, own: Any) -> float:
        """Return the rate of the force."""
        raise NotImplementedError

    def energy(self, point: Point, own: Any) -> float:
        """Return the stored energy of a point below the unloaded level."""
        raise NotImplementedError

    @inlined
    def force(self, state: int, point: Point, own: Any) -> float:
        """Return the force on a point that touches; by default the elastic force alone."""
        return self.spring(point, own)

    @inlined
    def power(self, state: int, point: Point, own: Any) -> float:
        """Return the power that is dissipated at a point that touches."""
        return 0.0

    @inlined
    def sunk(self, own: Any) -> float:
        """Return the permanent compression: how far the unloaded level has sunk [m]."""
        return 0.0

    @inlined
    def return_rate(self) -> float:
        """Return the rate at which the base returns without a force; 0 if immediately [s^-1]."""
        return 0.0

    @inlined
    def variables(self) -> int:
        """Return the number of variables."""
        return 0

    @inlined
    def rates(self, state: int, point: Point, own: Any) -> Variables:
        """Return the rates of the variables; the state is `FREE` where the point does not touch."""
        return ()

    @inlined
    def states(self) -> int:
        """Return the number of states, counted from 0."""
        return 1

    @inlined
    def guard(self, state: int, point: Point, own: Any) -> tuple[float, float]:
        """Return a function that falls through zero where the law changes state, and its rate.

        It is evaluated for points that touch; any other event of a point sets the
        law to state 0.
        """
        return 1.0, 0.0

    @kernel
    def settle(self, state: int, point: Point, own: Any) -> None:
        """Correct variables that are out of range at a switch, or at the start of a run."""

    @inlined
    def seen(self, state: int, point: Point, own: Any) -> Variables:
        """Return the law's columns in the results, besides the force."""
        return ()

    @inlined
    def energies(self, point: Point, at_rest: float, own: Any) -> tuple[float, float]:
        """Return the stored energy, and the energy less that at rest, `at_rest`.

        A law may give the difference without cancellation.
        """
        stored = self.energy(point, own)
        return stored, stored - at_rest

    @inlined
    def read(self, state: Vector, first: int, points: int) -> Any:
        """Read the variables of some points from a state, from index `first` on."""
        return ()

    @inlined
    def of_point(self, own: Any, i: int) -> Any:
        """Return the variables of point `i` among those read."""
        return ()

    @kernel
    def reset(self, own: Any) -> None:
        """Set the variables of some points to zero."""

    @inlined
    def guards(self, state: int, point: Point, own: Any) -> Guards:
        """Return the guards of the law's state at a point that touches."""
        return Guards((), ())


class _WithVariables:
    """Methods of laws with variables."""

    @inlined
    def read(self: Any, state: Vector, first: int, points: int) -> Any:
        return view_of(state, first, points * self.variables())

    @inlined
    def of_point(self: Any, own: Vector, i: int) -> Vector:
        return view_of(own, i * self.variables(), self.variables())

    @kernel
    def reset(self: Any, own: Vector) -> None:
        for i in range(len(own)):
            own[i] = 0.0


class _WithGuard:
    """Methods of laws with states."""

    @inlined
    def guards(self: Any, state: int, point: Point, own: Any) -> Guards:
        value, change = self.guard(state, point, own)
        return Guards((value,), (change,))


def methods_of_law(
    law: type[Law], known: type, required: Collection[str]
) -> tuple[dict[str, Any], list[str]]:
    """Return a law's own methods, and what is wrong with its class and the names of its fields."""
    if not isinstance(law, type):  # pyright: ignore[reportUnnecessaryIsInstance]
        msg = f"a law is a NamedTuple, got {short_repr(law)}"
        raise ArgumentError(msg)
    own = {name: method for name, method in vars(law).items() if inspect.isfunction(method)}
    fields = getattr(law, "_fields", None)
    faults = [] if fields is not None else [f"{law.__name__} is no NamedTuple"]
    faults += [f"{law.__name__} has no method {name}" for name in required if name not in own]
    faults += [
        f"{law.__name__} has a field {name!r}, which is a method of laws; give it another name"
        for name in sorted(set(fields or ()).intersection(vars(known)))
        if not name.startswith("_")
    ]
    return own, faults


def complete_law(
    law: type[Law], own: dict[str, Any], faults: list[str], inline: Callable[[str], bool],
    parts: Iterable[type],
) -> type[Law]:  # fmt: skip
    """Return a law without faults, its methods marked for compiling, with those it lacks."""
    if faults:
        raise ArgumentError("; ".join(faults))
    for name, method in own.items():
        if not name.startswith("_"):
            (inlined if inline(name) else kernel)(method)
    for part in parts:
        for name, method in vars(part).items():
            if not name.startswith("_") and name not in vars(law):
                setattr(law, name, method)
    return law


@with_hints()
def point_law(law: type[Law]) -> type[Law]:
    """Make a named tuple a law: mark its methods for compiling, and give it those it lacks.

    Parameters
    ----------
    law : type
        A named tuple of numbers with some of the methods of :class:`PointLaw`.

    Returns
    -------
    type
        The same class.

    Raises
    ------
    ArgumentError
        It is no named tuple, lacks a method, or a field has the name of a method.
    """
    own, faults = methods_of_law(law, PointLaw, REQUIRED)
    if ("states" in own) != ("guard" in own) or ("variables" in own) != ("rates" in own):
        faults.append(f"{law.__name__} has only one of states and guard, or variables and rates")
    parts = {_WithVariables: "variables" in own, _WithGuard: "guard" in own, PointLaw: True}
    mixins = (part for part, is_needed in parts.items() if is_needed)
    return complete_law(law, own, faults, lambda name: name != "settle", mixins)


@point_law
class Viscoelastic(NamedTuple):
    """A linear spring beside a linear dashpot, :eq:`eq-pad-force`."""

    stiffness: float  # k/m
    damping: float  # c/m

    def spring(self, point: Point, own: Variables) -> float:
        """Return k u."""
        return self.stiffness * point.pressed

    def force(self, state: int, point: Point, own: Variables) -> float:
        """Return k u + c u'."""
        return self.stiffness * point.pressed + self.damping * point.speed

    def force_rate(self, state: int, point: Point, own: Variables) -> float:
        """Return k u' + c u''."""
        return self.stiffness * point.speed + self.damping * point.acceleration

    def power(self, state: int, point: Point, own: Variables) -> float:
        """Return the power that the dashpot dissipates."""
        return self.damping * point.speed * point.speed

    def energy(self, point: Point, own: Variables) -> float:
        """Return k u^2/2."""
        return 0.5 * self.stiffness * point.pressed * point.pressed

    def energies(self, point: Point, at_rest: float, own: Variables) -> tuple[float, float]:
        """Return the energy of the spring, and the energy less that at rest, as a product."""
        change = point.rise * (0.5 * point.rise - point.settlement)
        return self.energy(point, own), self.stiffness * change

    def return_rate(self) -> float:
        """Return k/c."""
        return self.stiffness / self.damping if self.damping > 0.0 else 0.0
