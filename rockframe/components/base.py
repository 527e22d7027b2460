"""The base class of components: values, immutability, equality, text, documented parameters."""

from collections.abc import Collection, Iterable, Mapping
from inspect import Parameter as Argument
from inspect import Signature
from textwrap import fill
from typing import Any, ClassVar, Final, Generic, Self, dataclass_transform

from rockframe.arguments import checked_list, checked_mapping
from rockframe.components.alternatives import OneOf, changed_arguments
from rockframe.components.parameters import (
    REQUIRED,
    Count,
    Declared,
    Numbers,
    Parameter,
    Position,
    Ratio,
    SIValues,
    Text,
    checked_si,
)
from rockframe.errors import (
    OWNERS_BY_ARGUMENT,
    ArgumentError,
    ComponentError,
    ModelWarning,
    did_you_mean,
    short_repr,
    unexpected_argument,
    warn,
)
from rockframe.notebook import Polygon, html_summary, readable_arguments, shapes_svg
from rockframe.shared_arguments import with_section
from rockframe.suggestions import Immutable, suggests_names
from rockframe.units import to_ratio

_LATER_SECTIONS: Final = (
    "Other Parameters", "Attributes", "Methods", "Raises", "Warns", "See Also", "Notes",
    "References", "Examples",
)  # fmt: skip
"""Sections of a docstring that follow that on parameters."""
_WIDTH: Final = 79
_INDENT: Final = "    "


def _parameter_row(parameter: Declared[Any, Any, Any]) -> str:
    optional = "" if parameter.default is REQUIRED else ", optional"
    unit = f"[{parameter.unit}]"
    text = parameter.words.replace(unit, unit.replace(" ", "~"))  # not broken between lines
    lines = fill(text, _WIDTH, initial_indent=_INDENT, subsequent_indent=_INDENT)
    words = lines.replace(unit.replace(" ", "~"), unit)
    return f"{parameter.name} : {parameter.written_as}{optional}\n{words}"


@dataclass_transform(
    kw_only_default=True, field_specifiers=(Parameter, Ratio, Text, Count, Position)
)
@suggests_names
class Component(Immutable, Generic[Numbers]):
    """An immutable value object with the parameters that its class declares.

    A class of components declares each parameter once, as an attribute:
    :class:`~rockframe.components.Parameter` (with a unit),
    :class:`~rockframe.components.Ratio`, :class:`~rockframe.components.Choice` or
    :class:`~rockframe.components.Text`. The attribute ``alternatives`` lists those that replace
    one another. Constructor, checks, properties and the methods below follow from these. Type
    checkers know the constructor by the annotations, as of a dataclass (PEP 681).

    All values are in SI units. The attribute ``given`` has the arguments of the constructor, and
    ``si`` the numbers that the equations need.

    Examples
    --------
    >>> from rockframe.components import Component, Parameter, Ratio
    >>> from rockframe.units import FORCE, POSITIVE
    >>> class Buffer(Component):
    ...     strength: Parameter = Parameter(FORCE, POSITIVE, doc="Force at which it breaks.")
    ...     friction: Ratio[float] = Ratio(doc="Coefficient of friction.", default=0.3)
    >>> buffer = Buffer(strength="3 kN")
    >>> buffer
    Buffer(strength='3000.0 N', friction=0.3)
    >>> print(buffer.replace(strength="4 kN").strength.to("kN"))
    4.0 kilonewton
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
    si: Numbers

    noun: ClassVar[str] = "component"
    alternatives: ClassVar[tuple[OneOf, ...]] = ()
    _declared: ClassVar[Mapping[str, Declared[Any, Any, Any]]] = {}

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        own = {name: value for name, value in vars(cls).items() if isinstance(value, Declared)}
        for name in own:
            if hasattr(Component, name):
                msg = f"{cls.__qualname__}: {name!r} is reserved: every component has it"
                raise ComponentError(msg)
        cls._declared = {**cls._declared, **own}
        if own and "__init__" not in vars(cls):
            cls.__init__ = _constructor(cls)
        suggests_names(cls)
        if cls.__doc__ is not None and cls._declared:
            rows = "\n".join(map(_parameter_row, cls._declared.values()))
            cls.__doc__ = with_section(cls.__doc__, "Parameters", rows, _LATER_SECTIONS)
        _register(cls)

    def __init__(self, **values: object) -> None:
        self._set_arguments(values)
        self._warn()

    def _warn(self) -> None:
        for caution in self.cautions():
            warn(caution, ModelWarning)

    def cautions(self) -> list[str]:
        """Return the warnings of the constructor about unusual values.

        Returns
        -------
        list of str
            One text for each, with the name of the component.
        """
        return [f"{type(self).__name__}: {words}" for words in self._cautions()]

    def _set_arguments(self, values: Mapping[str, object]) -> None:
        """Check and store the arguments of the constructor."""
        arguments = self._with_defaults(values)
        owner = self._owner(arguments)
        self._check(arguments, owner)
        self._set_values(
            {
                name: parameter.accept(arguments[name], owner)
                for name, parameter in self._declared.items()
            }
        )

    @classmethod
    def _with_defaults(cls, values: Mapping[str, object]) -> dict[str, object]:
        """Add defaults to arguments; refuse unknown and missing ones as Python does."""
        declared = cls.declared()
        call = f"{cls.__qualname__}.__init__()"
        for name in values:
            if name not in declared:
                raise unexpected_argument(call, name, declared)
        missing = [
            repr(name)
            for name, parameter in declared.items()
            if parameter.default is REQUIRED and name not in values
        ]
        if missing:
            count = (
                f"{len(missing)} required keyword-only argument{'s' if len(missing) > 1 else ''}"
            )
            if len(missing) > 2:
                missing = [", ".join(missing[:-1]) + ",", missing[-1]]
            msg = f"{call} missing {count}: {' and '.join(missing)}"
            raise ArgumentError(msg)
        defaults = {name: parameter.default_argument for name, parameter in declared.items()}
        return {**defaults, **values}

    def _set_values(self, values: Mapping[str, object]) -> None:
        """Store values in SI units, and the numbers derived from them."""
        items = SIValues(**values)
        object.__setattr__(self, "given", items)
        object.__setattr__(self, "si", self._numbers(items))

    @classmethod
    def _owner(cls, values: Mapping[str, object]) -> str:
        """Return the name of the component for messages."""
        return cls.__name__

    def _check(self, values: Mapping[str, object], owner: str) -> None:
        """Refuse arguments that exclude one another."""
        for alternative in self.alternatives:
            alternative.check(values, owner)

    def _numbers(self, numbers: SIValues) -> Any:
        """Return the numbers for the equations; refuse values that do not fit together."""
        return numbers

    def _cautions(self) -> list[str]:
        """Return a text for each unusual value."""
        values = vars(self.given)
        cautions = [
            parameter.caution(values[name])
            for name, parameter in self._declared.items()
            if values[name] is not None
        ]
        return [words for words in cautions if words is not None]

    def _arguments(self) -> dict[str, float | str]:
        """Return arguments of the constructor for an equal component."""
        values = vars(self.given)
        written = {
            name: None if values[name] is None else parameter.write(values[name])
            for name, parameter in self._declared.items()
        }
        return {name: value for name, value in written.items() if value is not None}

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Component) or type(other) is not type(self):
            return NotImplemented
        return self._arguments() == other._arguments()

    def __hash__(self) -> int:
        return hash((type(self), tuple(self._arguments().items())))

    def __repr__(self) -> str:
        argument = ", ".join(f"{name}={value!r}" for name, value in self._arguments().items())
        return f"{type(self).__name__}({argument})"

    def _shapes(self) -> list[Polygon]:
        """Return the polygons that notebooks draw, to scale; none if it has no shape."""
        return []

    def _repr_html_(self) -> str:
        shapes = self._shapes()
        svg = shapes_svg(shapes) if shapes else ""
        return html_summary(type(self).__name__, readable_arguments(self._arguments()), svg)

    def __reduce__(self) -> tuple[object, ...]:
        return (type(self).from_dict, (self._arguments(),))

    def to_dict(self) -> dict[str, float | str]:
        """Return the constructor's arguments in SI units, with the class under ``type``.

        Returns
        -------
        dict
            Plain strings and floats, fit for JSON.
        """
        return {"type": type(self).__name__, **self._arguments()}

    @classmethod
    def from_dict(cls, arguments: Mapping[str, float | str]) -> Self:
        """Build the component from the result of :meth:`to_dict`, without warnings.

        Parameters
        ----------
        arguments : mapping
            Arguments of the constructor.

        Returns
        -------
        Component

        Raises
        ------
        ComponentError
            The mapping describes a component of another class.
        TypeError, UnitsError, ComponentError
            As the constructor.
        """
        part = object.__new__(cls)
        part._set_arguments(cls._arguments_from(arguments))
        return part

    @classmethod
    def _arguments_from(cls, description: Mapping[str, float | str]) -> dict[str, Any]:
        """Return the arguments in a description; refuse one of another class."""
        description = checked_mapping(
            description,
            owner=f"{cls.__name__}.from_dict",
            name="description",
            example=f"that of {cls.__name__}.to_dict()",
        )
        kind = description.get("type", cls.__name__)
        if kind != cls.__name__:
            msg = (
                f"{cls.__name__}.from_dict: expected a {cls.__name__}, got the description of a "
                f"component of type {short_repr(kind)}; component_from_dict builds any"
            )
            raise ComponentError(msg)
        return {name: value for name, value in description.items() if name != "type"}

    def replace(self, **changes: Any) -> Self:
        """Build a component with some parameters changed.

        Parameters
        ----------
        **changes
            Arguments of the constructor. An argument replaces its alternative: a stiffness,
            for example, replaces a frequency ratio. None means not given.

        Returns
        -------
        Component

        Raises
        ------
        TypeError, UnitsError, ComponentError
            As the constructor.
        """
        return type(self)(**changed_arguments(self._arguments(), changes, self.alternatives))

    @classmethod
    def declared(cls) -> Mapping[str, Declared[Any, Any, Any]]:
        """Return the declarations of all parameters by name.

        Returns
        -------
        mapping
        """
        return cls._declared

    @classmethod
    def varied(cls) -> Mapping[str, Declared[Any, Any, Any]]:
        """Return the declarations of all quantities that :meth:`with_si` takes, by name.

        Returns
        -------
        mapping
            All parameters, and in some classes quantities that determine several of them.
        """
        return cls._declared

    def too_many(self, changed: Collection[str]) -> tuple[str, ...]:
        """Name changed quantities that together overdetermine the parameters.

        Parameters
        ----------
        changed : collection of str
            Names of changed quantities, out of :meth:`varied`.

        Returns
        -------
        tuple of str
            Empty, unless a class has quantities that determine several parameters.
        """
        return ()

    def left_behind(self, changed: Collection[str]) -> tuple[str, ...]:
        """Name given parameters that depend on changed ones but would keep their values.

        Parameters
        ----------
        changed : collection of str
            Names of changed parameters.

        Returns
        -------
        tuple of str
            Names of parameters; empty for most classes.
        """
        for name in checked_list(changed, owner=type(self).__name__, name="changed", of="names"):
            self._check_name(name, self.varied() or self.parameters())
        return ()

    def with_si(self, values: Mapping[str, Any]) -> Self:
        """Build a component with some parameters changed, without warnings.

        Parameters
        ----------
        values : mapping of str to float or str
            Numbers in SI units, and words, by the names of parameters. A value replaces its
            alternative, as in :meth:`replace`.

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
        values = checked_mapping(values, owner=f"{kind}.with_si", name="values", example=example)
        if not values:
            return self
        for name in values:
            self._check_name(name, self._declared)
        removed = dict.fromkeys(
            name for alternative in self.alternatives for name in alternative.displaced(values)
        )
        changed = {**vars(self.given), **removed, **values}
        owner = self._owner(changed)
        for name, value in values.items():
            changed[name] = checked_si(self._declared[name], value, owner)
        part = object.__new__(type(self))
        part._check(changed, owner)
        part._set_values(changed)
        return part

    def parameters(self) -> tuple[str, ...]:
        """Name the arguments that are numbers other than zero, with a unit or without.

        Returns
        -------
        tuple of str
        """
        return tuple(
            name
            for name, value in self._arguments().items()
            if self._declared[name].single and _leading_number(value)
        )

    def with_scaled(self, name: str, factor: float) -> Self:
        """Build a component with one argument multiplied by a factor.

        Parameters
        ----------
        name : str
            One of :meth:`parameters`.
        factor : float
            Ratio of the new value to the old one [1].

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
        """Raise an error for the name of an unknown parameter."""
        listed = list(known)
        if isinstance(name, str) and name in listed:
            return
        called, has = f"{short_repr(name)}{did_you_mean(name, listed)}", ", ".join(listed) or "none"
        msg = f"{type(self).__name__}: no parameter is called {called} (it has {has})"
        raise ComponentError(msg)


COMPONENT_CLASSES: Final[dict[str, type[Component]]] = {}
"""The classes of components by their names."""


def _register(kind: type[Component]) -> None:
    """Make a class known by its name."""
    registered = COMPONENT_CLASSES.setdefault(kind.__name__, kind)
    full, other = (f"{part.__module__}.{part.__qualname__}" for part in (kind, registered))
    if full != other:
        msg = (
            f"{full}: another component has this name, {other}; descriptions refer to components "
            "by name, so rename one of them"
        )
        raise ComponentError(msg)
    COMPONENT_CLASSES[kind.__name__] = kind
    for name in kind.declared():
        OWNERS_BY_ARGUMENT.setdefault(name, {})[kind.__name__] = None


def _constructor(kind: type[Component]) -> Any:
    """Make a constructor with the signature of the declarations."""

    def __init__(self: Component, *positional: object, **values: object) -> None:  # noqa: N807
        if positional:
            names = ", ".join(kind.declared())
            call, count = f"{kind.__qualname__}.__init__()", 1 + len(positional)
            msg = f"{call} takes 1 positional argument but {count} were given. It takes {names}"
            raise ArgumentError(msg)
        Component.__init__(self, **values)

    __init__.hints = {}  # type: ignore[attr-defined]  # it explains unknown arguments itself

    arguments = [parameter.argument for parameter in kind.declared().values()]
    this = Argument("self", Argument.POSITIONAL_OR_KEYWORD)
    signature = Signature([this, *arguments], return_annotation=None)
    __init__.__signature__ = signature  # type: ignore[attr-defined]
    __init__.__qualname__ = f"{kind.__qualname__}.__init__"
    __init__.__module__ = kind.__module__
    return __init__


def _leading_number(value: float | str) -> float:
    """Return the number in an argument; zero for a word."""
    if not isinstance(value, str):
        return value
    try:
        return float(value.partition(" ")[0])
    except ValueError:
        return 0.0
