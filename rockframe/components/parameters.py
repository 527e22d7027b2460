"""Parameters of components; each is declared once, as an attribute of the class."""

import re
from enum import Enum, StrEnum
from inspect import Parameter as Argument
from types import SimpleNamespace
from typing import (
    TYPE_CHECKING,
    Any,
    ClassVar,
    Final,
    Generic,
    Literal,
    NoReturn,
    Self,
    TypeAlias,
    TypeVar,
    overload,
)

import numpy as np

from rockframe.arguments import checked_bool, checked_choice
from rockframe.case_arrays import CaseArray, isfinite
from rockframe.errors import AccessError, ComponentError, short_repr
from rockframe.suggestions import with_hints
from rockframe.units import (
    LENGTH,
    NOT_NEGATIVE,
    Condition,
    Measure,
    Quantity,
    QuantityLike,
    RatioLike,
    Unit,
    quantity,
    quantity_text,
    to_ratio,
    to_si,
)


class Missing(Enum):
    """Defaults of parameters without a default value."""

    REQUIRED = "it must be given"
    DERIVED = "it follows from others if it is not given; the property always has a value"


REQUIRED: Final = Missing.REQUIRED
DERIVED: Final = Missing.DERIVED
Derived: TypeAlias = Literal[Missing.DERIVED] | None
"""Type of the default ``DERIVED``."""

PublicValue = TypeVar("PublicValue")
Accepted = TypeVar("Accepted")
if TYPE_CHECKING:
    from typing_extensions import TypeVar as TypeVarWithDefault

    Default = TypeVarWithDefault("Default", default=Missing)
    Numbers = TypeVarWithDefault("Numbers", default=Any)
else:
    Default, Numbers = TypeVar("Default"), TypeVar("Numbers")
Option = TypeVar("Option", bound=StrEnum)


class Declared(Generic[PublicValue, Accepted, Default]):
    """A parameter of a component: an argument of its constructor, and a property.

    Parameters
    ----------
    measure : Measure or None
        Kind of quantity.
    condition : Condition or None
        Range in which the value must lie.
    doc : str
        Description in one sentence; range and unit are added.
    default : object
        Default value, as users write it; None for an optional parameter, ``DERIVED`` for one
        that follows from others if it is not given.
    """

    single: ClassVar[bool] = True  # whether a value is one number or word, so that axes can vary it
    name: str
    written_as: str
    annotation: Any

    def __init__(
        self,
        measure: Measure | None = None,
        condition: Condition | None = None,
        *,
        doc: str,
        default: Default = REQUIRED,
    ) -> None:
        for name, value, kind in (
            ("measure", measure, Measure), ("condition", condition, Condition), ("doc", doc, str)
        ):  # fmt: skip
            missing = value is None and name != "doc"
            if not missing and not isinstance(value, kind):
                expected = "a text" if kind is str else f"a rockframe.units.{kind.__name__}"
                msg = f"{type(self).__name__}: {name} must be {expected}, got {short_repr(value)}"
                raise ComponentError(msg)
        self.measure = measure
        self.condition = condition
        self.default = default
        self.unit = "" if measure is None else str(measure.unit)
        limits = "" if condition is None else f"; {condition.words}"
        unit = f" [{self.unit}]" if self.unit else ""
        self.__doc__ = self.words = f"{doc.removesuffix('.')}{limits}{unit}."

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, instance: None, owner: type) -> Self: ...
    @overload
    def __get__(
        self: "Declared[PublicValue, Accepted, None]", instance: object, owner: type
    ) -> PublicValue | None: ...
    @overload
    def __get__(self, instance: object, owner: type) -> PublicValue: ...
    def __get__(self, instance: Any, owner: type) -> Any:
        if instance is None:
            return self
        source = instance.si if self.default is DERIVED else instance.given
        value = getattr(source, self.name)
        return None if value is None else self.public(value)

    def __set__(self, instance: object, value: Accepted | Default) -> NoReturn:
        msg = f"{type(instance).__name__} is immutable; build a new one to change {self.name}"
        raise AccessError(msg)

    @property
    def default_argument(self) -> Any:
        """The default in the signature; `inspect.Parameter.empty` for a required one."""
        if self.default is REQUIRED:
            return Argument.empty
        return None if self.default is DERIVED else self.default

    @property
    def argument(self) -> Argument:
        """The argument in the signature of the constructor."""
        kind = self.annotation | None if self.default_argument is None else self.annotation
        return Argument(
            self.name, Argument.KEYWORD_ONLY, default=self.default_argument, annotation=kind
        )

    def accept(self, value: object, owner: str) -> Any:
        """Read an argument that may be None if it is optional; messages begin with `owner`."""
        missing = value is None and self.default in (None, DERIVED)
        return None if missing else self.read(value, owner)

    def read(self, value: object, owner: str) -> Any:
        """Read an argument and give its value in SI units."""
        raise NotImplementedError

    def write(self, value: Any) -> float | str | None:
        """Write a value in a form that :meth:`read` reads; None for a default left out."""
        return value

    def public(self, value: Any) -> Any:
        """Return a value for users, with its unit."""
        return value

    def caution(self, value: Any) -> str | None:
        """Return a text on an unusual value, None for a usual one."""
        return None


def checked_si(parameter: Declared[Any, Any, Any], value: Any, owner: str) -> Any:
    """Return a number in SI units that is in range; anything else is read as an argument."""
    has_unit, number = parameter.measure is not None, isinstance(value, float) and parameter.single
    holds: Any = isfinite if parameter.condition is None else parameter.condition.holds
    if (isinstance(value, CaseArray) or (has_unit and number)) and holds(value):
        return value
    point = isinstance(value, tuple)
    written = has_unit and not isinstance(value, str) and (parameter.single or point)
    return parameter.read(parameter.write(value) if written else value, owner)


class Parameter(Declared[Quantity, QuantityLike, Default]):
    """A parameter with a unit.

    Parameters
    ----------
    measure : Measure
        Kind of quantity, with its unit and an example for messages.
    condition : Condition, optional
        Range in which the value must lie.
    doc : str
        Description in one sentence; range and unit are added.
    default : str, optional
        Default value; None for an optional parameter, ``DERIVED`` for one that follows from
        others if it is not given.

    Examples
    --------
    >>> from rockframe.components import Component
    >>> from rockframe.units import FORCE
    >>> class Anchor(Component):
    ...     strength: Parameter = Parameter(FORCE, doc="Force at which it breaks.")
    >>> print(Anchor(strength="3 kN").strength)
    3000.0 newton
    >>> strength = Anchor.declared()["strength"]
    >>> strength.accept("3 kN", "Anchor"), strength.read("3 kN", "Anchor"), strength.write(3000.0)
    (3000.0, 3000.0, '3000.0 N')
    >>> print(strength.public(3000.0), strength.caution(3000.0))
    3000.0 newton None
    """

    written_as = "str or Quantity"
    annotation = QuantityLike
    measure: Measure

    @with_hints()
    def __init__(
        self,
        measure: Measure,
        condition: Condition | None = None,
        *,
        doc: str,
        default: Default = REQUIRED,
    ) -> None:
        super().__init__(measure, condition, doc=doc, default=default)

    def read(self, value: object, owner: str) -> float:
        """Convert to SI units, with :func:`rockframe.units.to_si`."""
        return to_si(value, self.measure, owner=owner, name=self.name, condition=self.condition)

    def write(self, value: float) -> str:
        """Write the number with its unit."""
        return quantity_text(value, self.measure)

    def public(self, value: float) -> Quantity:
        """Return the number with its unit."""
        return quantity(value, self.measure)


class Ratio(Declared[float, RatioLike, Default]):
    """A parameter that is a pure number.

    Parameters
    ----------
    condition : Condition, optional
        Range in which the value must lie.
    doc : str
        Description in one sentence; its range is added.
    default : float, optional
        Default value; None for an optional parameter, ``DERIVED`` for one that follows from
        others if it is not given.
    example : str, optional
        A realistic value, for messages.

    Examples
    --------
    >>> from rockframe.components import Component
    >>> class Slab(Component):
    ...     friction: Ratio[float] = Ratio(doc="Coefficient of friction.", default=0.3)
    >>> Slab(friction="40 %").friction, Slab().friction
    (0.4, 0.3)
    >>> friction = Slab.declared()["friction"]
    >>> friction.read("40 %", "Slab"), friction.write(0.4), friction.public(0.4)
    (0.4, 0.4, 0.4)
    """

    written_as = "float"
    annotation = RatioLike
    measure: Measure

    @with_hints()
    def __init__(
        self,
        condition: Condition | None = None,
        *,
        doc: str,
        default: Default = REQUIRED,
        example: str = "0.1",
    ) -> None:
        measure = Measure("a pure ratio", Unit.ONE, example)
        super().__init__(measure, condition, doc=doc, default=default)

    def read(self, value: object, owner: str) -> float:
        """Convert to a pure number, with :func:`rockframe.units.to_ratio`."""
        example = self.measure.example
        return to_ratio(
            value, owner=owner, name=self.name, condition=self.condition, example=example
        )


class Choice(Declared[Option, Accepted, Option]):
    """A parameter that is one of a few words; descriptions leave out the default.

    Parameters
    ----------
    default : StrEnum
        Default value; its class has all words.
    doc : str
        Description in one sentence.

    Examples
    --------
    >>> from enum import StrEnum
    >>> from rockframe.components import Component
    >>> Side = StrEnum("Side", ["LEFT", "RIGHT"])
    >>> class Latch(Component):
    ...     side: Choice[Side, str] = Choice(Side.LEFT, doc="Where it is.")
    >>> Latch(side="right"), Latch(side="left")
    (Latch(side='right'), Latch())
    >>> side = Latch.declared()["side"]
    >>> side.read("right", "Latch") is Side.RIGHT, side.write(Side.RIGHT)
    (True, 'right')
    """

    @with_hints()
    def __init__(self, default: Option, *, doc: str) -> None:
        if not isinstance(default, StrEnum):  # pyright: ignore[reportUnnecessaryIsInstance]
            msg = (
                f"Choice: default must be one of the words of a StrEnum, got {short_repr(default)}"
            )
            raise ComponentError(msg)
        super().__init__(doc=doc, default=default)
        self.annotation = type(default) | str
        self.written_as = "{" + ", ".join(f'"{word}"' for word in type(default)) + "}"

    def read(self, value: object, owner: str) -> Option:
        """Find the word, with :func:`rockframe.arguments.checked_choice`."""
        return checked_choice(type(self.default), value, owner=owner, name=self.name)

    def write(self, value: Option) -> str | None:
        """Write the word; None for the default."""
        return None if value is self.default else str(value)


class Text(Declared[str, str, Default]):
    """A parameter that is a text.

    Parameters
    ----------
    doc : str
        Description in one sentence.
    default : None, optional
        For an optional parameter.

    Examples
    --------
    >>> from rockframe.components import Component
    >>> class Bolt(Component):
    ...     name: Text[None] = Text(doc="What it is called.", default=None)
    >>> Bolt(name="B1").name, Bolt().name, Bolt.declared()["name"].read("B2", "Bolt")
    ('B1', None, 'B2')
    """

    written_as = "str"
    annotation = str

    @with_hints()
    def __init__(self, *, doc: str, default: Default = REQUIRED) -> None:
        super().__init__(doc=doc, default=default)

    def read(self, value: object, owner: str) -> str:
        """Check that the argument is a text.

        Raises
        ------
        ComponentError
            Not a text, or an empty one.
        """
        if isinstance(value, str) and value.strip():
            return value
        missing = ", or None" if self.default is None else ""
        msg = (
            f"{owner}: {self.name} must be a text that is not empty{missing}, got "
            f"{short_repr(value)}"
        )
        raise ComponentError(msg)


class Flag(Declared[bool, bool, bool]):
    """A parameter that is true or false; descriptions leave out the default."""

    written_as = "bool"
    annotation = bool

    def read(self, value: object, owner: str) -> bool:
        """Read a truth value, or the word ``true`` or ``false``."""
        if isinstance(value, np.bool_):
            value = bool(value)
        elif isinstance(value, str):
            value = _BOOLEANS.get(value, value)
        return checked_bool(value, owner=owner, name=self.name)

    def write(self, value: bool) -> str | None:
        """Write the word; None for the default."""
        return None if value is self.default else str(value).lower()


MAX_COUNT: Final = 1_000_000
"""Largest plausible count."""

_BOOLEANS: Final = {"true": True, "false": False}


class Count(Declared[int, int, Default]):
    """A parameter that is a positive whole number."""

    written_as = "int"
    annotation = int

    def read(self, value: object, owner: str) -> int:
        """Read the number."""
        number = value if not isinstance(value, bool) else None
        if isinstance(number, int | np.integer | float) and 1 <= number <= MAX_COUNT:
            count = int(number)
            if count == number:
                return count
        msg = f"{owner}: {self.name} must be a whole number from 1 on, got {short_repr(value)}"
        raise ComponentError(msg)

    def write(self, value: int) -> int | None:
        """Write the number; None for the default."""
        return None if value == self.default else value


class Position(Declared[tuple[Quantity, Quantity], tuple[QuantityLike, QuantityLike], Missing]):
    """A parameter that is a point: its coordinates to the right and upwards."""

    single = False
    written_as = "tuple of str or Quantity"
    annotation = tuple[QuantityLike, QuantityLike]

    def __init__(self, *, doc: str) -> None:
        super().__init__(LENGTH.like('("-0.5 m", "3 m")'), doc=doc)

    def read(self, value: object, owner: str) -> tuple[float, float]:
        """Convert to SI units."""
        written = _POSITION.fullmatch(value) if isinstance(value, str) else None
        if written is not None:
            value = tuple(f"{coordinate} m" for coordinate in written.groups())
        pair: list[Any] = list(value) if isinstance(value, tuple | list) else []
        if len(pair) != 2:
            msg = (
                f'{owner}: {self.name} must be a point such as ("-0.5 m", "3 m"), to the right '
                f"and above, got {short_repr(value)}"
            )
            raise ComponentError(msg)
        x, y = (
            to_si(coordinate, LENGTH, owner=owner, name=f"{self.name}[{k}]")
            for k, coordinate in enumerate(pair)
        )
        return x, y

    def write(self, value: tuple[float, float]) -> str:
        """Write the numbers with their unit, in a form that :meth:`read` reads."""
        return f"({value[0]!r}, {value[1]!r}) m"

    def public(self, value: tuple[float, float]) -> tuple[Quantity, Quantity]:
        """Return the numbers with their unit."""
        return quantity(value[0], LENGTH), quantity(value[1], LENGTH)


_POSITION: Final = re.compile(r"\((\S+), (\S+)\) m")


class SIValues(SimpleNamespace):
    """Values in SI units by name, None if not given; immutable."""

    def __setattr__(self, name: str, value: object) -> NoReturn:
        msg = f"values of a component are immutable; {name} cannot be set"
        raise AccessError(msg)

    def __delattr__(self, name: str) -> NoReturn:
        msg = f"values of a component are immutable; {name} cannot be deleted"
        raise AccessError(msg)


CRITICAL_DAMPING_RATIO: Final = 1.0
"""Damping ratio of critical damping, above which there is no oscillation [1]."""


class DampingRatio(Ratio[None]):
    """A damping ratio that replaces a damping coefficient; one above 1 causes a warning.

    Parameters
    ----------
    doc : str
        Description in one sentence.
    """

    @with_hints()
    def __init__(self, *, doc: str) -> None:
        super().__init__(NOT_NEGATIVE, doc=doc, default=None)

    def caution(self, value: float) -> str | None:
        """Ask whether a value above 1 was meant in per cent."""
        if value <= CRITICAL_DAMPING_RATIO:
            return None
        return (
            f"{self.name} = {value:.6g} is {100.0 * value:.6g} % of critical; "
            f"was '{value:.6g} %' meant?"
        )
