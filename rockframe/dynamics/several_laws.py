"""Links of several laws in one scene: a law that represents one of several."""

from collections.abc import Sequence
from typing import Any, Final, NamedTuple

from rockframe.compiled import Vector, view_from
from rockframe.dynamics.links import (
    Bumper,
    LinkEvent,
    SteadyForce,
    Stretch,
    Tie,
    link_law,
)


@link_law
class EitherLaw(NamedTuple):
    """A law that is one of two, or nested, one of several. Each link follows one of them."""

    which: float  # 0 for the first
    first: Any
    second: Any

    def force(self, state: int, stretch: Stretch, own: Vector) -> float:
        """Return the force of the law."""
        if self.which == 0.0:
            return self.first.force(state, stretch, own)
        return self.second.force(state, stretch, own)

    def energy(self, state: int, stretch: Stretch, own: Vector) -> float:
        """Return the stored energy."""
        if self.which == 0.0:
            return self.first.energy(state, stretch, own)
        return self.second.energy(state, stretch, own)

    def power(self, state: int, stretch: Stretch, own: Vector) -> float:
        """Return the dissipated power."""
        if self.which == 0.0:
            return self.first.power(state, stretch, own)
        return self.second.power(state, stretch, own)

    def variables(self) -> int:
        """Return the number of variables, the larger of both laws."""
        return max(self.first.variables(), self.second.variables())

    def rates(self, state: int, stretch: Stretch, own: Vector, out: Vector) -> None:
        """Write the rates of its variables; zero for those that the law does not have."""
        for i in range(len(out)):
            out[i] = 0.0
        if self.which == 0.0:
            self.first.rates(state, stretch, own, out)
        else:
            self.second.rates(state, stretch, own, out)

    def states(self) -> int:
        """Return the number of states, the larger of both laws."""
        return max(self.first.states(), self.second.states())

    def starting(self, stretch: Stretch, own: Vector) -> int:
        """Return the state at the start of a run; sets the variables."""
        if self.which == 0.0:
            return self.first.starting(stretch, own)
        return self.second.starting(stretch, own)

    def guard(self, which: int, state: int, stretch: Stretch, own: Vector) -> tuple[float, float]:
        """Return a guard of the law, and its rate."""
        if self.which == 0.0:
            return self.first.guard(which, state, stretch, own)
        return self.second.guard(which, state, stretch, own)

    def switch(self, which: int, state: int, stretch: Stretch, own: Vector) -> LinkEvent:
        """Return the event as a guard falls through zero; sets the variables."""
        if self.which == 0.0:
            return self.first.switch(which, state, stretch, own)
        return self.second.switch(which, state, stretch, own)

    def shown(self, state: int) -> int:
        """Return the state that users see."""
        if self.which == 0.0:
            return self.first.shown(state)
        return self.second.shown(state)

    def idles(self, state: int) -> bool:
        """Whether it does nothing in a state."""
        return self.first.idles(state) if self.which == 0.0 else self.second.idles(state)

    def number_count(self) -> int:
        """Return the number of numbers of both laws, and of `which`."""
        return 1 + self.first.number_count() + self.second.number_count()

    def with_numbers(self, numbers: Vector) -> Any:
        """Return the law with other numbers, from an array."""
        second_numbers = 1 + self.first.number_count()
        return EitherLaw(
            numbers[0],
            self.first.with_numbers(view_from(numbers, 1)),
            self.second.with_numbers(view_from(numbers, second_numbers)),
        )


def combined_law(laws: Sequence[Any], own: Any) -> Any:
    """Return a law that may be any of `laws`, of different classes, and here is `own`."""
    first, *others = laws
    if not others:
        return own
    if type(own) is type(first):
        return EitherLaw(0.0, own, combined_law(others, others[0]))
    return EitherLaw(1.0, first, combined_law(others, own))


BUILT_IN: Final = (Tie(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), Bumper(0.0, 0.0, 0.0), SteadyForce(0.0))
"""A law of each class that restrainers, tendons, walls and loads follow."""


def law_prototypes(laws: Sequence[Any]) -> list[Any]:
    """Return a law of each class that links of these laws may follow.

    If one class of `BUILT_IN` is among them all of these are returned, so that any mixture of them
    runs by the same machine code.
    """
    prototypes = {type(law): law for law in laws}
    if any(type(law) in prototypes for law in BUILT_IN):
        own = [law for law_class, law in prototypes.items() if law_class not in map(type, BUILT_IN)]
        return [*BUILT_IN, *own]
    return list(prototypes.values())
