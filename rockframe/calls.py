"""Calls of constructors that do not fit them, in the names that users know."""

from collections.abc import Mapping
from inspect import Parameter, Signature, isfunction, signature
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypeVar

Kind = TypeVar("Kind", bound=type)


class CheckedCall:
    """A class whose constructor says what it takes when it is called with something else.

    The check stands in ``__new__``, so that the constructor itself needs no wrapper.
    """

    __slots__ = ()
    __signature__: ClassVar[Signature]

    usage: ClassVar[str | None] = None
    """How objects are built, where it is not by calling the class."""

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        # for help(), which would show that of __new__
        known = signature(cls.__init__)
        cls.__signature__ = known.replace(parameters=list(known.parameters.values())[1:])

    if not TYPE_CHECKING:  # where the constructor's own signature counts

        def __new__(cls, *positional: object, **named: object) -> Self:
            """Refuse arguments that do not fit the constructor.

            Raises
            ------
            TypeError
                Arguments without a name that need one, unknown ones, or missing ones.
            """
            fault = _fault(cls.__signature__.parameters, len(positional), named)
            if fault:
                name, known = cls.__name__, cls.__signature__.parameters
                usage = f"{fault}; write {name}({_written(known)})"
                if cls.usage is not None:
                    usage = f"it is not built by calling it; write {cls.usage}"
                msg = f"{name}: {usage}"
                raise TypeError(msg)
            return super().__new__(cls)


def public_names(kind: Kind) -> Kind:
    """Name inherited methods by the class that users know, for Python's own messages."""
    for base in kind.__mro__:
        if base.__module__.partition(".")[0] != __name__.partition(".")[0]:
            continue
        for name, held in vars(base).items():
            function = getattr(held, "__func__", held)
            if isfunction(function) and not name.startswith("_"):
                function.__qualname__ = f"{kind.__qualname__}.{name}"
                function.__module__ = kind.__module__  # where pickle looks for that name
    return kind


def _fault(known: Mapping[str, Parameter], count: int, named: Mapping[str, object]) -> str:
    """Say what is wrong with the arguments of a call; nothing if they fit."""
    kinds = [one.kind for one in known.values()]
    places = [name for name, one in known.items() if one.kind is Parameter.POSITIONAL_OR_KEYWORD]
    if count > len(places) and Parameter.VAR_POSITIONAL not in kinds:
        return "arguments are given by name" if not places else "too many arguments without a name"
    by_name = {
        name
        for name, one in known.items()
        if one.kind in (Parameter.POSITIONAL_OR_KEYWORD, Parameter.KEYWORD_ONLY)
    }
    unknown = [name for name in named if name not in by_name]
    if unknown and Parameter.VAR_KEYWORD not in kinds:
        return f"got an unexpected keyword argument {' and '.join(map(repr, unknown))}"
    missing = [
        name
        for name, one in known.items()
        if name in by_name
        and one.default is Parameter.empty
        and name not in named
        and name not in places[:count]
    ]
    verb = "is" if len(missing) == 1 else "are"
    return f"{' and '.join(missing)} {verb} missing" if missing else ""


def _written(known: Mapping[str, Parameter]) -> str:
    """Write the arguments of a call, those that may be left out in brackets."""
    needed: list[str] = []
    optional: list[str] = []
    for name, one in known.items():
        if one.kind is Parameter.VAR_POSITIONAL:
            needed.append(f"*{name}")
        elif one.default is Parameter.empty:
            needed.append(f"{name}=...")
        else:
            optional.append(f"{name}=...")
    if not optional:
        return ", ".join(needed)
    return f"{', '.join(needed)}[{', ' if needed else ''}{', '.join(optional)}]"
