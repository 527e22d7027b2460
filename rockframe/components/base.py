"""What all components share: immutability, equality, repr and the way to text and back."""

import warnings
from collections.abc import Mapping
from typing import Any, ClassVar, Generic, Self, TypeVar

from rockframe.calls import CheckedCall
from rockframe.errors import ComponentError, ModelWarning, SchemaError, shown
from rockframe.units import Measure, quantity

SI = TypeVar("SI")

_COMPONENT_TYPES: dict[str, "type[Component[Any]]"] = {}


class Component(CheckedCall, Generic[SI]):
    """A frozen value object.

    A component keeps its numbers twice: as the constructor's arguments in SI
    units (:meth:`to_dict`, from which it can be built again), and as the plain
    SI floats ``si`` that the equations need. Public properties give quantities
    with units.
    """

    __slots__ = ("_arguments", "si")
    si: SI
    _arguments: dict[str, float | str]

    noun: ClassVar[str] = "component"

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        _COMPONENT_TYPES[cls.__name__] = cls

    def _freeze(self, si: SI, arguments: Mapping[str, float | str | None]) -> None:
        object.__setattr__(self, "si", si)
        given = {name: value for name, value in arguments.items() if value is not None}
        object.__setattr__(self, "_arguments", given)

    def __setattr__(self, name: str, value: object) -> None:
        msg = f"{type(self).__name__} is immutable; build a new one to change {name}"
        raise AttributeError(msg)

    def __delattr__(self, name: str) -> None:
        msg = f"{type(self).__name__} is immutable; {name} cannot be deleted"
        raise AttributeError(msg)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, type(self)):
            return NotImplemented
        return self._arguments == other._arguments

    def __hash__(self) -> int:
        return hash((type(self).__name__, tuple(self._arguments.items())))

    def __repr__(self) -> str:
        given = ", ".join(f"{name}={value!r}" for name, value in self._arguments.items())
        return f"{type(self).__name__}({given})"

    def __reduce__(self) -> tuple[object, ...]:
        return (component_from_dict, (self.to_dict(),))

    def to_dict(self) -> dict[str, float | str]:
        """Give the constructor's arguments in SI units, with the class under ``type``.

        Returns
        -------
        dict
            Plain strings and floats, fit for JSON.
        """
        return {"type": type(self).__name__, **self._arguments}

    def parameters(self) -> tuple[str, ...]:
        """Name the arguments that are numbers other than zero, with a unit or without.

        Returns
        -------
        tuple of str
        """
        return tuple(name for name, value in self._arguments.items() if _number_in(value))

    def with_scaled(self, name: str, factor: float) -> Self:
        """Build a component of which one argument is larger or smaller.

        Parameters
        ----------
        name : str
            One of :meth:`parameters`.
        factor : float
            New value over old [1].

        Returns
        -------
        Component

        Raises
        ------
        ComponentError
            No such parameter, or its new value is out of range.
        """
        if name not in self.parameters():
            known = ", ".join(self.parameters())
            msg = f"{type(self).__name__}: no parameter is called {shown(name)} (it has {known})"
            raise ComponentError(msg)
        value = self._arguments[name]
        number = factor * _number_in(value)
        unit = value.partition(" ")[2] if isinstance(value, str) else ""
        changed = f"{number!r} {unit}" if isinstance(value, str) else number
        return self.from_dict({**self._arguments, name: changed})

    @classmethod
    def from_dict(cls, arguments: Mapping[str, float | str]) -> Self:
        """Build the component that :meth:`to_dict` described."""
        with warnings.catch_warnings():
            # they came when the component was new
            warnings.simplefilter("ignore", ModelWarning)
            return cls(**arguments)


def component_from_dict(description: Mapping[str, float | str]) -> "Component[Any]":
    """Build any component from its :meth:`Component.to_dict`.

    Parameters
    ----------
    description : mapping
        As written by :meth:`Component.to_dict`.

    Returns
    -------
    Component

    Raises
    ------
    SchemaError
        ``type`` is missing or unknown.
    """
    kind = description.get("type")
    if not isinstance(kind, str) or kind not in _COMPONENT_TYPES:
        known = ", ".join(sorted(_COMPONENT_TYPES))
        msg = f"found a component of type {shown(kind)}; expected one of {known}"
        raise SchemaError(msg)
    arguments = {name: value for name, value in description.items() if name != "type"}
    return _COMPONENT_TYPES[kind].from_dict(arguments)


def with_unit(value: float | None, measure: Measure) -> str | None:
    """Write an SI value so that the constructor reads the same float back."""
    return None if value is None else f"{value!r} {measure.unit}"


def _number_in(value: float | str) -> float:
    """Give the number of an argument, zero if it is a word."""
    if not isinstance(value, str):
        return value
    try:
        return float(value.partition(" ")[0])
    except ValueError:
        return 0.0


class SIProperty:
    """A read-only property: the float ``si.<name>`` as a quantity with its unit.

    Parameters
    ----------
    measure : Measure
        Kind of quantity, which fixes the unit.
    doc : str
        Docstring of the property.
    """

    def __init__(self, measure: Measure, doc: str) -> None:
        self._measure = measure
        self.__doc__ = f"{doc} [{measure.unit}]"

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, instance: Any, owner: type | None = None) -> Any:
        if instance is None:
            return self
        return quantity(getattr(instance.si, self._name), self._measure)
