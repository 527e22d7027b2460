"""Numbers of components in SI units; damping ratios and coefficients of friction."""

from types import SimpleNamespace
from typing import Any, Final, NoReturn, Self, overload

from rockframe.components.parameters import Ratio
from rockframe.errors import ComponentError
from rockframe.units import NOT_NEGATIVE, Measure, Quantity, quantity


class SIValues(SimpleNamespace):
    """Values in SI units by their names; None of what was not given. Immutable."""

    def __setattr__(self, name: str, value: object) -> NoReturn:
        msg = f"values of a component are immutable; {name} cannot be set"
        raise AttributeError(msg)

    def __delattr__(self, name: str) -> NoReturn:
        msg = f"values of a component are immutable; {name} cannot be deleted"
        raise AttributeError(msg)


class SIProperty:
    """A read-only property: the float ``si.<name>`` as a quantity with its unit."""

    def __init__(self, measure: Measure, doc: str) -> None:
        self._measure = measure
        self.__doc__ = f"{doc} [{measure.unit}]"

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, instance: None, owner: type) -> Self: ...
    @overload
    def __get__(self, instance: object, owner: type) -> Quantity: ...
    def __get__(self, instance: Any, owner: type) -> Any:
        if instance is None:
            return self
        return quantity(getattr(instance.si, self._name), self._measure)


class Friction(Ratio[None]):
    """A coefficient of friction at rest."""

    def __init__(self, *, of: str) -> None:
        words = (
            f"Coefficient of friction under {of} while it does not slip; without one it is held."
        )
        super().__init__(NOT_NEGATIVE, doc=words, default=None, example="0.5")


class KineticFriction(Ratio[None]):
    """A coefficient of friction of slip."""

    def __init__(self) -> None:
        words = "Coefficient of friction of slip; that at rest unless given."
        super().__init__(NOT_NEGATIVE, doc=words, default=None, example="0.45")


def check_frictions(owner: str, given: SIValues) -> SIValues:
    """Refuse a friction of slip without one at rest, or above it."""
    static, kinetic = given.friction, given.kinetic_friction
    if kinetic is not None and (static is None or kinetic > static):
        found = "none is given" if static is None else f"that is {static:.6g}"
        msg = (
            f"{owner}: kinetic_friction, here {kinetic:.6g}, is at most the friction at rest, and "
            f"{found}"
        )
        raise ComponentError(msg)
    return given


CRITICAL: Final = 1.0
"""Damping ratio beyond which nothing vibrates [1]."""


class DampingRatio(Ratio[None]):
    """A damping ratio that stands for a damping coefficient; a large one brings a warning.

    Parameters
    ----------
    doc : str
        What it is, in a sentence.
    """

    def __init__(self, *, doc: str) -> None:
        super().__init__(NOT_NEGATIVE, doc=doc, default=None)

    def caution(self, value: float) -> str | None:
        """Ask whether per cent were meant, above 1."""
        if value <= CRITICAL:
            return None
        return (
            f"{self.name} = {value:.6g} is {100.0 * value:.6g} % of critical; "
            f"was '{value:.6g} %' meant?"
        )
