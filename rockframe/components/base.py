"""What all components share: values, immutability, equality, text; words on their parameters."""

import re
from collections.abc import Collection, Iterable, Mapping
from inspect import Parameter as Argument
from inspect import Signature, cleandoc
from textwrap import fill
from typing import Any, ClassVar, Final, NoReturn, Self

from rockframe.arguments import by_names, several
from rockframe.components.alternatives import OneOf
from rockframe.components.parameters import DERIVED, REQUIRED, Declared, SIValues
from rockframe.components.registry import register_class
from rockframe.errors import (
    AccessError,
    ArgumentError,
    ComponentError,
    ModelWarning,
    nearest,
    shown,
    unexpected_argument,
    warn,
)
from rockframe.many import Many, isfinite
from rockframe.notebook import Polygon, arguments_in_words, card, drawing
from rockframe.proposals import Proposing, proposing
from rockframe.units import to_ratio

_SECTION: Final = re.compile(r"^\w[\w ]*\n-{3,}$", re.MULTILINE)
_WIDTH: Final = 79
_INDENT: Final = "    "


def with_parameters(text: str, declared: Iterable[Declared[Any, Any]]) -> str:
    """Insert the section "Parameters" where numpydoc has it."""
    rows = [_row(parameter) for parameter in declared]
    clean = cleandoc(text)
    found = _SECTION.search(clean)
    if not rows or (found and found[0].startswith("Parameters\n")):
        return text
    place = found.start() if found else len(clean)
    section = "\n".join(["Parameters", "----------", *rows])
    return f"{clean[:place].rstrip()}\n\n{section}\n\n{clean[place:]}".rstrip() + "\n"


def _row(parameter: Declared[Any, Any]) -> str:
    optional = "" if parameter.default is REQUIRED else ", optional"
    unit = f"[{parameter.unit}]"
    whole = parameter.words.replace(unit, unit.replace(" ", "~"))  # not broken between lines
    lines = fill(whole, _WIDTH, initial_indent=_INDENT, subsequent_indent=_INDENT)
    words = lines.replace(unit.replace(" ", "~"), unit)
    return f"{parameter.name} : {parameter.written_as}{optional}\n{words}"


@proposing
class Component(metaclass=Proposing):
    """A frozen value object, made of the parameters that its class declares.

    A class of components declares each of its parameters once, as an attribute:
    :class:`~rockframe.components.Parameter` (with a unit),
    :class:`~rockframe.components.Ratio`, :class:`~rockframe.components.Choice` or
    :class:`~rockframe.components.Text`; and in ``alternatives`` which of them stand for
    one another. All else follows: constructor, checks, properties, and what is below.

    A component keeps its values in SI units: as they were given in ``given``, and as the
    equations need them in ``si``.

    Examples
    --------
    >>> from rockframe.components import Component, Parameter, Ratio
    >>> from rockframe.units import FORCE, POSITIVE
    >>> class Buffer(Component):
    ...     strength = Parameter(FORCE, POSITIVE, doc="Force at which it breaks.")
    ...     friction = Ratio(doc="Coefficient of friction.", default=0.3)
    >>> buffer = Buffer(strength="3 kN")
    >>> buffer
    Buffer(strength='3000.0 N', friction=0.3)
    >>> buffer.replace(strength="4 kN").strength.to("kN")
    <Quantity(4.0, 'kilonewton')>
    >>> buffer.parameters(), [*Buffer.declared()] == [*Buffer.varied()]
    (('strength', 'friction'), True)
    >>> Buffer.from_dict(buffer.to_dict()) == buffer.with_scaled("friction", 1.0)
    True
    >>> buffer.with_si({"friction": 0.4}).friction, buffer.cautions()
    (0.4, [])
    >>> buffer.left_behind(["strength"]), buffer.too_many(["strength"])
    ((), ())
    """

    __slots__ = ("given", "si")
    given: SIValues
    si: Any

    noun: ClassVar[str] = "component"
    alternatives: ClassVar[tuple[OneOf, ...]] = ()
    _declared: ClassVar[Mapping[str, Declared[Any, Any]]] = {}

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        own = {name: one for name, one in vars(cls).items() if isinstance(one, Declared)}
        for name in own:
            if hasattr(Component, name):
                msg = f"{cls.__qualname__}: {name!r} means something else for all components"
                raise ComponentError(msg)
        cls._declared = {**cls._declared, **own}
        if own and "__init__" not in vars(cls):
            cls.__init__ = _constructor(cls)
        proposing(cls)
        if cls.__doc__ is not None:
            cls.__doc__ = with_parameters(cls.__doc__, cls._declared.values())
        register_class(cls)

    def __init__(self, **given: object) -> None:
        self._fill(given)
        self._warn()

    def _warn(self) -> None:
        for caution in self.cautions():
            warn(caution, ModelWarning)

    def cautions(self) -> list[str]:
        """Say what is unusual about the values, as building the component warned.

        Returns
        -------
        list of str
            Of each what it is and of which component; none of usual values.
        """
        return [f"{type(self).__name__}: {words}" for words in self._cautions()]

    def _fill(self, given: Mapping[str, object]) -> None:
        """Check and keep the arguments of the constructor."""
        every = _every_argument(type(self), given)
        owner = self._owner(every)
        self._check(every, owner)
        self._hold({name: one.accept(every[name], owner) for name, one in self._declared.items()})

    def _hold(self, values: Mapping[str, object]) -> None:
        """Keep values in SI units, and what follows from them."""
        given = SIValues(**values)
        object.__setattr__(self, "given", given)
        object.__setattr__(self, "si", self._numbers(given))

    @classmethod
    def _owner(cls, given: Mapping[str, object]) -> str:
        """Name the component in messages."""
        return cls.__name__

    def _check(self, given: Mapping[str, object], owner: str) -> None:
        """Refuse arguments that do not go together."""
        for alternative in self.alternatives:
            alternative.check(given, owner)

    def _numbers(self, given: SIValues) -> Any:
        """Give the numbers that the equations need; refuse values that do not fit together."""
        return given

    def _cautions(self) -> list[str]:
        """Say what is unusual about the values."""
        values = vars(self.given)
        found = [
            one.caution(values[name])
            for name, one in self._declared.items()
            if values[name] is not None
        ]
        return [words for words in found if words is not None]

    def _arguments(self) -> dict[str, float | str]:
        """Give the arguments from which the constructor builds an equal component."""
        values = vars(self.given)
        written = {
            name: None if values[name] is None else one.write(values[name])
            for name, one in self._declared.items()
        }
        return {name: value for name, value in written.items() if value is not None}

    def __setattr__(self, name: str, value: object) -> NoReturn:
        msg = f"{type(self).__name__} is immutable; build a new one to change {name}"
        raise AccessError(msg)

    def __delattr__(self, name: str) -> NoReturn:
        msg = f"{type(self).__name__} is immutable; {name} cannot be deleted"
        raise AccessError(msg)

    def __dir__(self) -> list[str]:
        return [name for name in super().__dir__() if not name.startswith("_")]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Component) or type(other) is not type(self):
            return NotImplemented
        return self._arguments() == other._arguments()

    def __hash__(self) -> int:
        return hash((type(self), tuple(self._arguments().items())))

    def __repr__(self) -> str:
        given = ", ".join(f"{name}={value!r}" for name, value in self._arguments().items())
        return f"{type(self).__name__}({given})"

    def _shapes(self) -> list[Polygon]:
        """Give what notebooks draw of the component, to scale; nothing unless it has a shape."""
        return []

    def _repr_html_(self) -> str:
        shapes = self._shapes()
        drawn = drawing(shapes) if shapes else ""
        return card(type(self).__name__, arguments_in_words(self._arguments()), drawn)

    def __reduce__(self) -> tuple[object, ...]:
        return (type(self).from_dict, (self._arguments(),))

    def to_dict(self) -> dict[str, float | str]:
        """Give the constructor's arguments in SI units, with the class under ``type``.

        Returns
        -------
        dict
            Plain strings and floats, fit for JSON.
        """
        return {"type": type(self).__name__, **self._arguments()}

    @classmethod
    def from_dict(cls, arguments: Mapping[str, float | str]) -> Self:
        """Build the component that :meth:`to_dict` described, without its warnings.

        Parameters
        ----------
        arguments : mapping
            Of the constructor.

        Returns
        -------
        Component

        Raises
        ------
        ComponentError
            It describes a component of another class.
        TypeError, UnitsError, ComponentError
            As the constructor.
        """
        part = object.__new__(cls)
        part._fill(cls._described(arguments))
        return part

    @classmethod
    def _described(cls, description: Mapping[str, float | str]) -> dict[str, Any]:
        """Give the arguments in a description; refuse that of another class."""
        description = by_names(
            description,
            owner=f"{cls.__name__}.from_dict",
            name="description",
            example=f"that of {cls.__name__}.to_dict()",
        )
        kind = description.get("type", cls.__name__)
        if kind != cls.__name__:
            msg = (
                f"{cls.__name__}.from_dict: expected a {cls.__name__}, got the description of a "
                f"component of type {shown(kind)}; component_from_dict builds any"
            )
            raise ComponentError(msg)
        return {name: value for name, value in description.items() if name != "type"}

    def replace(self, **changes: Any) -> Self:
        """Build a component of which some parameters are others.

        Parameters
        ----------
        **changes
            Arguments of the constructor. One that stands for another, such as a stiffness
            for a frequency ratio, takes its place; None is as if it were not given.

        Returns
        -------
        Component

        Raises
        ------
        TypeError, UnitsError, ComponentError
            As the constructor.
        """
        return type(self)(**replaced(self._arguments(), changes, self.alternatives))

    @classmethod
    def declared(cls) -> Mapping[str, Declared[Any, Any]]:
        """Give the declarations of all parameters by their names.

        Returns
        -------
        mapping
        """
        return cls._declared

    @classmethod
    def varied(cls) -> Mapping[str, Declared[Any, Any]]:
        """Give the declarations of all that :meth:`with_si` takes, by their names.

        Returns
        -------
        mapping
            Those of all parameters; and of what stands for several of them, where a class has
            such.
        """
        return cls._declared

    def too_many(self, changed: Collection[str]) -> tuple[str, ...]:
        """Name what determines the same parameters more than once.

        Parameters
        ----------
        changed : collection of str
            Names of what becomes another, of those in :meth:`varied`.

        Returns
        -------
        tuple of str
            None, unless a class has names that stand for several parameters.
        """
        return ()

    def left_behind(self, changed: Collection[str]) -> tuple[str, ...]:
        """Name what would stay as it was given, although it goes with what is changed.

        Parameters
        ----------
        changed : collection of str
            Names of parameters that become others.

        Returns
        -------
        tuple of str
            Names of parameters; none, unless a class tells of such.
        """
        for name in several(changed, owner=type(self).__name__, name="changed", of="names"):
            self._check_name(name, self.varied() or self.parameters())
        return ()

    def with_si(self, values: Mapping[str, Any]) -> Self:
        """Build a component of which some parameters are others, without warnings.

        Parameters
        ----------
        values : mapping of str to float or str
            Numbers in SI units, and words, by the names of parameters. One that stands for
            another takes its place, as with :meth:`replace`.

        Returns
        -------
        Component

        Raises
        ------
        ComponentError
            A value is out of range, or does not fit the others.
        """
        example = "{'width': 0.8}"
        kind = type(self).__name__
        values = by_names(values, owner=f"{kind}.with_si", name="values", example=example)
        if not values:
            return self
        for name in values:
            self._check_name(name, self._declared)
        gone = dict.fromkeys(name for each in self.alternatives for name in each.displaced(values))
        changed = {**vars(self.given), **gone, **values}
        owner = self._owner(changed)
        for name, value in values.items():
            one = self._declared[name]
            holds: Any = _is_finite if one.condition is None else one.condition.holds
            if not isinstance(value, float | Many) or not holds(value):
                # which also says what is wrong
                plain = isinstance(value, str) or one.measure is None
                written = value if plain else one.write(value)
                changed[name] = one.read(written, owner)
        part = object.__new__(type(self))
        part._check(changed, owner)
        part._hold(changed)
        return part

    def parameters(self) -> tuple[str, ...]:
        """Name the arguments that are numbers other than zero, with a unit or without.

        Returns
        -------
        tuple of str
        """
        return tuple(name for name, value in self._arguments().items() if _number_in(value))

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
        self._check_name(name, self.parameters())
        ratio = to_ratio(factor, owner=type(self).__name__, name="factor", example="1.1")
        return self.with_si({name: ratio * vars(self.given)[name]})

    def _check_name(self, name: object, known: Iterable[str]) -> None:
        """Refuse a parameter that there is not."""
        listed = list(known)
        if isinstance(name, str) and name in listed:
            return
        called, has = f"{shown(name)}{nearest(name, listed)}", ", ".join(listed) or "none"
        msg = f"{type(self).__name__}: no parameter is called {called} (it has {has})"
        raise ComponentError(msg)


def replaced(
    arguments: Mapping[str, float | str],
    changes: Mapping[str, Any],
    alternatives: tuple[OneOf, ...],
) -> dict[str, Any]:
    """Give arguments with some changed, without those that the changes stand for."""
    gone = {name for each in alternatives for name in each.displaced(changes)}
    return {**{name: value for name, value in arguments.items() if name not in gone}, **changes}


def _every_argument(kind: type[Component], given: Mapping[str, object]) -> dict[str, object]:
    """Add defaults to arguments; refuse unknown and missing ones as Python does."""
    declared = kind._declared  # pyright: ignore[reportPrivateUsage]
    call = f"{kind.__qualname__}.__init__()"
    for name in given:
        if name not in declared:
            raise unexpected_argument(call, name, declared)
    missing = [
        repr(name)
        for name, one in declared.items()
        if one.default is REQUIRED and name not in given
    ]
    if missing:
        count = f"{len(missing)} required keyword-only argument{'s' if len(missing) > 1 else ''}"
        msg = f"{call} missing {count}: {' and '.join(missing)}"
        raise ArgumentError(msg)
    defaults = {name: _default(one, None) for name, one in declared.items()}
    return {**defaults, **given}


def _default(one: Declared[Any, Any], required: object) -> object:
    if one.default is REQUIRED:
        return required
    return None if one.default is DERIVED else one.default


def _constructor(kind: type[Component]) -> Any:
    """Make a constructor with the signature that the declarations give."""

    def __init__(self: Component, *strange: object, **given: object) -> None:  # noqa: N807
        if strange:
            names = ", ".join(kind._declared)  # pyright: ignore[reportPrivateUsage]
            call, count = f"{kind.__qualname__}.__init__()", 1 + len(strange)
            msg = f"{call} takes 1 positional argument but {count} were given. It takes {names}"
            raise ArgumentError(msg)
        Component.__init__(self, **given)

    __init__.hints = {}  # type: ignore[attr-defined]  # it answers itself, also of derived classes

    arguments = [
        Argument(
            name,
            Argument.KEYWORD_ONLY,
            default=_default(one, Argument.empty),
            annotation=one.annotation,
        )
        for name, one in kind._declared.items()  # pyright: ignore[reportPrivateUsage]
    ]
    this = Argument("self", Argument.POSITIONAL_OR_KEYWORD)
    __init__.__signature__ = Signature([this, *arguments])  # type: ignore[attr-defined]
    __init__.__qualname__ = f"{kind.__qualname__}.__init__"
    __init__.__module__ = kind.__module__
    return __init__


def _is_finite(value: object) -> bool:
    """Whether a value is a number that is finite; words and counts have to be read."""
    return isinstance(value, float | Many) and isfinite(value)


def _number_in(value: float | str) -> float:
    """Give the number of an argument, zero if it is a word."""
    if not isinstance(value, str):
        return value
    try:
        return float(value.partition(" ")[0])
    except ValueError:
        return 0.0
