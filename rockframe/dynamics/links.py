"""Force laws of links between two points: ties, walls and loads, and how to write another one.

Elongation and rate of a link follow from its points, :eq:`eq-link`; its law gives the force. A law
is a named tuple of numbers per unit mass with some of the methods of :class:`LinkLaw`;
:func:`link_law` gives it the others. It may have **states**, such as slack and taut, which its
guards end, and **variables** of its own.
"""

import math
from dataclasses import dataclass
from typing import Any, Final, NamedTuple, TypeVar

from rockframe.compiled import Vector, filled, inlined, kernel
from rockframe.dynamics.events import (
    LINK_BREAKS,
    LINK_SLACK,
    LINK_TAUT,
    LINK_UNLOADS,
    LINK_YIELDS,
    SILENT,
)
from rockframe.dynamics.point_law import complete_law, methods_of_law
from rockframe.suggestions import with_hints

Law = TypeVar("Law")
REQUIRED: Final = ("force", "energy")
"""Methods that a law must give."""
INLINED_METHODS: Final = ("force", "power", "idles", "with_numbers")
"""Methods that are compiled into their callers."""
GUARDS: Final = 2
"""Guards of every link; a law may need fewer."""


class Stretch(NamedTuple):
    """Elongation of a link from the geometry in which it is defined [m], and its rates."""

    elongation: float
    rate: float  # its rate
    acceleration: float  # rate of the rate, where guards are evaluated; else 0
    given: float  # length in the reference geometry
    noise: float  # rounding of the elongation


class LinkEvent(NamedTuple):
    """What happens to a link as a guard falls through zero."""

    state: int
    event: int  # its kind; 0 for one that is not reported to users
    lost: float  # energy lost in the event, per unit mass


class LinkLaw:
    """The methods of a law; the first two are required, the others override defaults.

    `state` is the state of the law, `own` its variables, by their indices.
    """

    __slots__ = ()

    def force(self, state: int, stretch: Stretch, own: Vector) -> float:
        """Return the force with which the link pulls its points together."""
        raise NotImplementedError

    def energy(self, state: int, stretch: Stretch, own: Vector) -> float:
        """Return the stored energy."""
        raise NotImplementedError

    @inlined
    def power(self, state: int, stretch: Stretch, own: Vector) -> float:
        """Return the dissipated power."""
        return 0.0

    @inlined
    def variables(self) -> int:
        """Return the number of variables."""
        return 0

    @kernel
    def rates(self, state: int, stretch: Stretch, own: Vector, out: Vector) -> None:
        """Write the rates of the variables; by default they change at events only."""
        for i in range(self.variables()):
            out[i] = 0.0

    @inlined
    def states(self) -> int:
        """Return the number of states, counted from 0."""
        return 1

    @kernel
    def starting(self, stretch: Stretch, own: Vector) -> int:
        """Return the state at the start of a run; sets the variables."""
        return 0

    @kernel
    def guard(self, which: int, state: int, stretch: Stretch, own: Vector) -> tuple[float, float]:
        """Return a function that falls through zero where the state ends, and its rate.

        `which` is 0 or 1.
        """
        return 1.0, 0.0

    @kernel
    def switch(self, which: int, state: int, stretch: Stretch, own: Vector) -> LinkEvent:
        """Return what happens when a guard falls through zero; sets the variables."""
        return LinkEvent(state, SILENT, 0.0)

    @inlined
    def shown(self, state: int) -> int:
        """Return the state that users see, a :class:`~rockframe.dynamics.events.LinkState`."""
        return TAUT

    @inlined
    def idles(self, state: int) -> bool:
        """Whether the link has no force in a state, however it is stretched.

        Then it stores and dissipates nothing, its variables do not change, and its guards need
        no acceleration.
        """
        return False

    @inlined
    def number_count(self) -> int:
        """Return the number of the law's numbers."""
        return len(self)  # type: ignore[arg-type]

    @inlined
    def with_numbers(self, numbers: Vector) -> Any:
        """Return the law with other numbers, from an array."""
        return filled(self, numbers)


@with_hints()
def link_law(law: type[Law]) -> type[Law]:
    """Make a named tuple the law of a link: mark its methods, and give it those it lacks.

    Parameters
    ----------
    law : type
        A named tuple of floats with some of the methods of :class:`LinkLaw`.

    Returns
    -------
    type
        The same class.

    Raises
    ------
    ArgumentError
        It is no named tuple, lacks a method, or a field has the name of a method.
    """
    own, faults = methods_of_law(law, LinkLaw, REQUIRED)
    together = {"guard", "switch", "states"}
    if together & own.keys() and not together <= own.keys():
        faults.append(f"{law.__name__} has only some of states, guard and switch")
    return complete_law(law, own, faults, INLINED_METHODS.__contains__, [LinkLaw])


@link_law
class SteadyForce(NamedTuple):
    """A constant force along a fixed direction; its energy is the work done against it."""

    size: float  # per unit mass

    def force(self, state: int, stretch: Stretch, own: Vector) -> float:
        """Return the force."""
        return self.size

    def energy(self, state: int, stretch: Stretch, own: Vector) -> float:
        """Return the work against it."""
        return self.size * stretch.elongation


# states of a tie; a tie that pushes has, in place of slack, yielding in compression
SLACK: Final = 0
TAUT: Final = 1
YIELDING: Final = 2
BROKEN: Final = 3
YIELDING_PRESSED: Final = SLACK
# its number in the results, which differs from that of slack
SHOWN_PRESSED: Final = 4

LOWER: Final = 0
"""Guard of the end of a state by shortening, or by reversal."""
UPPER: Final = 1
"""Guard of the end of a state by lengthening."""
MARGIN: Final = 16.0
"""Margin of a state beyond its end, in roundings of the elongation: prevents repeated switches."""
TAUT_TOLERANCE: Final = 1e3
"""At the start a tie is taut if it is slack by less than this many roundings of elongation."""


@link_law
class Bumper(NamedTuple):
    """A spring and a dashpot in parallel behind a gap, which act only in contact."""

    stiffness: float  # k/m
    damping: float  # c/m
    gap: float  # elongation at which it is touched

    def force(self, state: int, stretch: Stretch, own: Vector) -> float:
        """Return k x + c x'."""
        if state == SLACK:
            return 0.0
        return self.stiffness * (stretch.elongation - self.gap) + self.damping * stretch.rate

    def energy(self, state: int, stretch: Stretch, own: Vector) -> float:
        """Return k x^2/2."""
        x = stretch.elongation - self.gap
        return 0.5 * self.stiffness * x * x if state != SLACK else 0.0

    def power(self, state: int, stretch: Stretch, own: Vector) -> float:
        """Return the power that the dashpot dissipates."""
        return self.damping * stretch.rate * stretch.rate if state != SLACK else 0.0

    def states(self) -> int:
        """Return 2: free and touched."""
        return 2

    def starting(self, stretch: Stretch, own: Vector) -> int:
        """Return the state at the start: touched if the gap is closed."""
        return TAUT if stretch.elongation - self.gap > TAUT_TOLERANCE * stretch.noise else SLACK

    def guard(self, which: int, state: int, stretch: Stretch, own: Vector) -> tuple[float, float]:
        """Return the distance of the point from the end of the state, and its rate."""
        x = stretch.elongation - self.gap
        if state == SLACK and which == UPPER:
            return -x, -stretch.rate
        if state == TAUT and which == LOWER:
            return x + MARGIN * stretch.noise, stretch.rate
        return 1.0, 0.0

    def switch(self, which: int, state: int, stretch: Stretch, own: Vector) -> LinkEvent:
        """Return the other state."""
        if state == SLACK:
            return LinkEvent(TAUT, LINK_TAUT, 0.0)
        return LinkEvent(SLACK, LINK_SLACK, 0.0)

    def shown(self, state: int) -> int:
        """Return the state that users see."""
        return state

    def idles(self, state: int) -> bool:
        """Whether it is free."""
        return state == SLACK


@dataclass(frozen=True)
class LinkNumbers:
    """A law of a link, with bounds and sizes that a model needs before the run.

    Parameters
    ----------
    law : named tuple
        A :func:`link_law`, per unit mass.
    stiffness, damping : float
        Greatest change of its force with elongation and with rate, per unit mass.
    variable_scales : tuple of float
        Typical sizes of its variables.
    """

    law: Any
    stiffness: float
    damping: float = 0.0
    variable_scales: tuple[float, ...] = ()


@link_law
class Tie(NamedTuple):
    """A spring that pulls, yields or breaks, beside a dashpot, :eq:`eq-tie`, :eq:`eq-tendon`."""

    stiffness: float  # k/m
    damping: float  # c/m
    slack: float  # elongation at which it becomes taut
    limit: float  # elongation of the spring at its strength
    brittle: float  # 1 if it breaks then, 0 if it yields
    pushes: float  # 1 if it also resists compression

    def spring_elongation(self, state: int, stretch: Stretch, own: Vector) -> float:
        """Return x of the spring: at its strength while it yields, zero while it is slack."""
        if state == YIELDING:
            return self.limit
        if state == SLACK:
            return -self.limit if self.pushes != 0.0 else 0.0
        return stretch.elongation - self.slack - own[0]  # less its variable, the yielding so far

    def force(self, state: int, stretch: Stretch, own: Vector) -> float:
        """Return k x + c l'."""
        if state == BROKEN:
            return 0.0
        x = self.spring_elongation(state, stretch, own)
        return self.stiffness * x + self.damping * stretch.rate

    def energy(self, state: int, stretch: Stretch, own: Vector) -> float:
        """Return k x^2/2."""
        x = 0.0 if state == BROKEN else self.spring_elongation(state, stretch, own)
        return 0.5 * self.stiffness * x * x

    def power(self, state: int, stretch: Stretch, own: Vector) -> float:
        """Return the power that dashpot and yielding dissipate."""
        if state == BROKEN:
            return 0.0
        lost = self.damping * stretch.rate * stretch.rate
        if state == YIELDING:
            lost += self.stiffness * self.limit * stretch.rate
        elif state == SLACK and self.pushes != 0.0:
            lost -= self.stiffness * self.limit * stretch.rate
        return lost

    def variables(self) -> int:
        """Return 1: the permanent elongation."""
        return 1

    def states(self) -> int:
        """Return 4."""
        return 4

    def starting(self, stretch: Stretch, own: Vector) -> int:
        """Return the state after slow loading up to here."""
        own[0] = 0.0
        x = stretch.elongation - self.slack
        state = TAUT
        if x > self.limit and self.brittle != 0.0:
            state = BROKEN
        elif x > self.limit:
            own[0], state = x - self.limit, YIELDING
        elif self.pushes != 0.0:
            if x < -self.limit and self.brittle != 0.0:
                state = BROKEN
            elif x < -self.limit:
                own[0], state = x + self.limit, YIELDING_PRESSED
        elif x < -TAUT_TOLERANCE * stretch.noise:
            state = SLACK
        return state

    def guard(self, which: int, state: int, stretch: Stretch, own: Vector) -> tuple[float, float]:
        """Return the elongation until the end of the state, or the rate that must not reverse."""
        x, value = stretch.elongation - self.slack - own[0], 1.0
        sign = -1.0 if which == UPPER else 1.0
        if state == TAUT and which == UPPER:
            value = self.limit - x
        elif state == TAUT and self.pushes != 0.0:
            value = x + self.limit
        elif state == TAUT:
            # a tie without unstretched length never becomes slack
            has_length = stretch.given + self.slack + own[0] > stretch.noise
            value = x + MARGIN * stretch.noise if has_length else math.inf
        elif state == YIELDING and which == LOWER:
            return self.reversal_guard(1.0, stretch)
        elif state == SLACK and which == UPPER:
            if self.pushes != 0.0:
                return self.reversal_guard(-1.0, stretch)
            value = -x
        else:
            sign = 0.0
        if sign == 0.0 or value == math.inf:
            return 1.0, 0.0
        return value, sign * stretch.rate

    def reversal_guard(self, sign: float, stretch: Stretch) -> tuple[float, float]:
        """Return the rate that must not reverse, times a time: guards of links are lengths."""
        time = sign / math.sqrt(self.stiffness)
        return time * stretch.rate, time * stretch.acceleration

    def switch(self, which: int, state: int, stretch: Stretch, own: Vector) -> LinkEvent:
        """Return the next state; the stored energy of a tie that breaks is lost."""
        x = stretch.elongation - self.slack
        if state == YIELDING:
            own[0] = x - self.limit + MARGIN * stretch.noise
            return LinkEvent(TAUT, LINK_UNLOADS, 0.0)
        if state == SLACK and self.pushes != 0.0:
            own[0] = x + self.limit - MARGIN * stretch.noise
            return LinkEvent(TAUT, LINK_UNLOADS, 0.0)
        if state == SLACK:
            return LinkEvent(TAUT, LINK_TAUT, 0.0)
        if which == LOWER and self.pushes == 0.0:
            return LinkEvent(SLACK, LINK_SLACK, 0.0)
        if self.brittle != 0.0:
            lost = 0.5 * self.stiffness * (x - own[0]) * (x - own[0])
            return LinkEvent(BROKEN, LINK_BREAKS, lost)
        return LinkEvent(YIELDING if which == UPPER else YIELDING_PRESSED, LINK_YIELDS, 0.0)

    def shown(self, state: int) -> int:
        """Return the state that users see."""
        return SHOWN_PRESSED if state == SLACK and self.pushes != 0.0 else state

    def idles(self, state: int) -> bool:
        """Whether it is broken, or slack without a dashpot."""
        slack = state == SLACK and self.pushes == 0.0 and self.damping == 0.0
        return state == BROKEN or slack
