"""Links of several laws in one scene: a law that represents one of several."""

from collections.abc import Sequence
from functools import partial
from typing import Any, Final, NamedTuple

from rockframe.compiled import Vector, call_of_either, view_from
from rockframe.dynamics.links import Bumper, LinkLaw, SteadyForce, Stretch, Tie, link_law

_of_law: Final = partial(
    call_of_either, is_first="self.which == 0.0", first="self.first", second="self.second"
)
"""Makes a method that calls the one of its name of the first law or of the second."""


@link_law
class EitherLaw(NamedTuple):
    """A law that is one of two, or nested, one of several. Each link follows one of them."""

    which: float  # 0 for the first
    first: Any
    second: Any

    force = _of_law(LinkLaw.force)
    energy = _of_law(LinkLaw.energy)
    power = _of_law(LinkLaw.power)
    starting = _of_law(LinkLaw.starting)
    guard = _of_law(LinkLaw.guard)
    switch = _of_law(LinkLaw.switch)
    shown = _of_law(LinkLaw.shown)
    idles = _of_law(LinkLaw.idles)

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
