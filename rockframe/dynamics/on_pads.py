"""Laws of one's own that are pads but for some of it: what yields, wears or changes with time.

Each end may have states of its own, such as elastic and yielding, which one guard tells apart.
The contact of such a law is that of pads, and behind it, CONTACTS times larger, both states.
"""

from typing import Any, TypeVar

from rockframe.compiled import inlined, kernel
from rockframe.dynamics.base import BaseForce, EndEvent, Guards
from rockframe.dynamics.body import BaseLine
from rockframe.dynamics.events import SILENT
from rockframe.dynamics.pads import CONTACTS, CORNER_GUARDS

Law = TypeVar("Law")


def on_pads(law: type[Law]) -> type[Law]:
    """Give a law the methods of pads, but for those that it has itself.

    Parameters
    ----------
    law : type
        A named tuple with a field ``pads``, the :class:`~rockframe.dynamics.pads.Pads` at the
        start of a run, and the method ``now(own)``, the pads as they are with the law's own
        variables. With variables it has ``variables``, ``read`` and ``flow``, too; with states
        of an end, ``states()``, how many, and ``end_guard(contact, left, line, acceleration,
        own)``, a guard and its rate: where it falls through zero the end goes on to its next
        state. Whatever else happens to an end puts it into state 0.

    Returns
    -------
    type
        The same class.
    """
    for name, method in vars(_OnPads).items():
        if not name.startswith("_") and name not in vars(law):
            setattr(law, name, method)
    return law


class _OnPads:
    """The methods; `self` is the law."""

    pads: Any
    now: Any

    @kernel
    def states(self) -> int:
        return 1

    @kernel
    def end_guard(
        self, contact: int, left: bool, line: BaseLine, acceleration: float, own: Any
    ) -> tuple[float, float]:
        return 1.0, 0.0

    @inlined
    def state_of_end(self, contact: int, left: bool) -> int:
        """Give the state of an end."""
        both = contact // CONTACTS
        return both % self.states() if left else both // self.states()

    @kernel
    def with_state(self, contact: int, left: bool, state: int) -> int:
        """Give the contact with another state of an end."""
        step = CONTACTS if left else CONTACTS * self.states()
        return contact + step * (state - self.state_of_end(contact, left))

    @kernel
    def contacts(self) -> int:
        return CONTACTS * self.states() * self.states()

    @kernel
    def end_guards(self) -> int:
        return CORNER_GUARDS + 1

    @kernel
    def variables(self) -> int:
        return 0

    @kernel
    def read(self, state: Any, first: int) -> Any:
        return ()

    @kernel
    def flow(self, contact: int, line: BaseLine, own: Any) -> Any:
        return ()

    @inlined
    def is_held(self, contact: int, left: bool) -> bool:
        return self.pads.is_held(contact % CONTACTS, left)

    @inlined
    def touches(self, contact: int, left: bool) -> bool:
        return self.pads.touches(contact % CONTACTS, left)

    @kernel
    def tilt(self, contact: int) -> float:
        return self.pads.tilt(contact % CONTACTS)

    @inlined
    def force(self, contact: int, line: BaseLine, own: Any) -> BaseForce:
        return self.now(own).force(contact % CONTACTS, line, ())

    @kernel
    def energy(self, line: BaseLine, own: Any) -> tuple[float, float]:
        return self.now(own).energy(line, ())

    @inlined
    def guards_of(
        self, contact: int, left: bool, line: BaseLine, acceleration: float, own: Any
    ) -> Guards:
        found = self.now(own).guards_of(contact % CONTACTS, left, line, acceleration, ())
        value, change = self.end_guard(contact, left, line, acceleration, own)
        return Guards(found.values + (value,), found.changes + (change,))

    @kernel
    def switch(self, contact: int, left: bool, which: int, line: BaseLine, own: Any) -> EndEvent:
        state = self.state_of_end(contact, left)
        if which == CORNER_GUARDS:
            following = (state + 1) % self.states()
            return EndEvent(self.with_state(contact, left, following), SILENT, False)
        found = self.now(own).switch(contact % CONTACTS, left, which, line, ())
        kept = contact - contact % CONTACTS
        new = self.with_state(found.contact + kept, left, 0)
        return EndEvent(new, found.event, found.crossed)

    @kernel
    def variables_after(self, was: int, contact: int, line: BaseLine, own: Any) -> Any:
        return own

    @kernel
    def level(self, left: bool, line: BaseLine, own: Any) -> float:
        return self.now(own).level(left, line, ())

    @kernel
    def is_level(self, left: bool, line: BaseLine, own: Any) -> bool:
        return self.now(own).is_level(left, line, ())

    @inlined
    def follows(self, contact: int, left: bool) -> int:
        follows = self.pads.follows(contact % CONTACTS, left)
        return follows + contact - contact % CONTACTS

    @kernel
    def following_speed(self, left: bool, line: BaseLine, own: Any) -> float:
        return self.now(own).following_speed(left, line, ())

    @inlined
    def following_rate(self) -> float:
        return self.pads.following_rate()

    @kernel
    def least_landing(self) -> float:
        return self.pads.least_landing()

    @kernel
    def released(self, contact: int, left: bool, line: BaseLine, own: Any) -> int:
        released = self.now(own).released(contact % CONTACTS, left, line, ())
        return released + contact - contact % CONTACTS

    @kernel
    def presses(self, contact: int, left: bool, line: BaseLine, own: Any) -> bool:
        return self.now(own).presses(contact % CONTACTS, left, line, ())

    @kernel
    def will_press(self, left: bool, line: BaseLine, acceleration: float, own: Any) -> bool:
        return self.now(own).will_press(left, line, acceleration, ())

    @kernel
    def held(self, contact: int, left: bool) -> int:
        return self.pads.held(contact % CONTACTS, left) + contact - contact % CONTACTS

    @kernel
    def waiting(self, contact: int, left: bool) -> int:
        return self.pads.waiting(contact % CONTACTS, left) + contact - contact % CONTACTS

    @kernel
    def unpressed(self, contact: int, left: bool) -> int:
        return self.pads.unpressed(contact % CONTACTS, left) + contact - contact % CONTACTS

    @kernel
    def engaged(self, contact: int, left: bool, line: BaseLine, own: Any) -> int:
        engaged = self.now(own).engaged(contact % CONTACTS, left, line, ())
        return engaged + contact - contact % CONTACTS

    @kernel
    def disturbed(self, contact: int) -> int:
        return self.pads.disturbed(contact % CONTACTS) + contact - contact % CONTACTS

    @kernel
    def rebound(self, left: bool) -> float:
        return self.pads.rebound(left)

    @kernel
    def starting(self, line: BaseLine, own: Any) -> int:
        return self.now(own).starting(line, ())

    @kernel
    def resting_height(self, left: float, right: float, own: Any) -> float:
        return self.now(own).resting_height(left, right, ())

    @kernel
    def observed(self, contact: int, line: BaseLine, own: Any) -> Any:
        return self.now(own).observed(contact % CONTACTS, line, ())
