"""Numbers of components in SI units, and properties that give them their units back."""

from types import SimpleNamespace
from typing import Any, NoReturn, Self, overload

from rockframe.units import Measure, Quantity, quantity


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
