"""Errors for unknown names of arguments, attributes and functions, which propose a similar name.

Python states only that a name does not exist. These errors of rockframe propose a known one; their
traceback in notebooks shows only the user's own lines.
"""

from abc import ABCMeta
from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from inspect import Parameter, signature
from types import FunctionType
from typing import (
    TYPE_CHECKING,
    Any,
    Concatenate,
    Final,
    Generic,
    NoReturn,
    ParamSpec,
    TypeVar,
    cast,
)

from rockframe.errors import (
    OWNERS_BY_ARGUMENT,
    AccessError,
    ArgumentError,
    named_by_own_part,
    unexpected_argument,
    unknown_attribute,
)

Function = TypeVar("Function", bound=Callable[..., Any])
Class = TypeVar("Class", bound=type)
Made = TypeVar("Made")
Arguments = ParamSpec("Arguments")
_MODULES_BY_FIRST_PARAMETER: Final = {
    "self": "", "cls": "", "kind": "rockframe.motion.", "motion": "rockframe.motion.",
    "suite": "rockframe.suites.",
}  # fmt: skip
"""First parameters of methods, which a call never names, and the modules of such functions."""


def with_hints(**hints: str) -> Callable[[Function], Function]:
    """Make a function explain unknown arguments: by the hint for a name, or by a similar name."""

    def decorate(function: Function) -> Function:
        parameters = list(signature(function).parameters.values())
        by_name = (Parameter.POSITIONAL_OR_KEYWORD, Parameter.KEYWORD_ONLY)
        known = [parameter.name for parameter in parameters if parameter.kind in by_name]
        home = _MODULES_BY_FIRST_PARAMETER.get(parameters[0].name) if parameters else None
        bound = home is not None and function.__module__.startswith(home)
        listed = known[1:] if bound else known
        any_name = any(parameter.kind is parameter.VAR_KEYWORD for parameter in parameters)

        @wraps(function)
        def call(*values: Any, **named: Any) -> Any:
            for name in named:
                if name in hints:
                    msg = f"{function.__qualname__}() takes no {name!r}: {hints[name]}"
                    raise ArgumentError(msg)
                if name not in known and not any_name:
                    words = f"{function.__qualname__}()"
                    raise unexpected_argument(words, name, listed)
            try:
                return function(*values, **named)
            except Exception as problem:
                if isinstance(problem, TypeError):
                    raise_call_error(
                        problem, [*listed, "further named arguments"] if any_name else listed
                    )
                by_part = named_by_own_part(problem)
                if by_part is not problem:
                    raise by_part.with_traceback(problem.__traceback__) from None
                raise

        call.hints = hints  # type: ignore[attr-defined]
        return cast("Function", call)

    return decorate


def hints_of(function: Callable[..., Any]) -> Mapping[str, str] | None:
    """Return the hints of a function decorated by :func:`with_hints`; None for any other."""
    return getattr(function, "hints", None)


def raise_call_error(problem: TypeError, listed: Iterable[str]) -> None:
    """List the arguments of a function if the call itself failed, before any line of it ran."""
    trace = problem.__traceback__
    if trace is None or trace.tb_next is not None:
        return
    names = ", ".join(listed)
    expected = f". It takes {names}" if names else ". It takes no arguments"
    msg = f"{problem}{expected}"
    raise ArgumentError(msg) from None


def suggests_names(kind: Class) -> Class:
    """Make the methods of a class propose similar arguments, and the class similar attributes.

    A base class of it must be decorated, too: inherited methods are left as they are.
    """
    for name, member in list(vars(kind).items()):
        if name.startswith("_") and name != "__init__":
            continue
        bound = isinstance(member, classmethod | staticmethod)
        function: Any = cast("Any", member).__func__ if bound else member
        if not isinstance(function, FunctionType):
            continue
        if name != "__init__":
            for argument in (name.removeprefix("from_"), *list(signature(function).parameters)[1:]):
                OWNERS_BY_ARGUMENT.setdefault(argument, {})[f"{kind.__name__}.{name}"] = None
        if hints_of(function) is None:
            checked = with_hints()(function)
            setattr(kind, name, type(member)(checked) if bound else checked)
    if not any("__getattr__" in vars(base) for base in kind.__mro__):
        kind.__getattr__ = _raise_no_attribute
    return kind


def _raise_no_attribute(self: object, name: str) -> NoReturn:
    if any(name in vars(base) for base in type(self).__mro__):  # a property that failed
        object.__getattribute__(self, name)
    # programs, and dir() itself, look up names that begin with an underscore
    known = () if name.startswith("_") else dir(self)
    raise unknown_attribute(type(self).__name__, name, known)


if TYPE_CHECKING:

    class Constructor(Generic[Arguments]):
        """A function as a class method that makes objects; for mypy `classmethod` makes Any."""

        def __init__(self, function: Callable[Concatenate[type[Any], Arguments], Any], /) -> None:
            """Take the function; its first argument is the class."""

        def __get__(self, instance: object, kind: type[Made], /) -> Callable[Arguments, Made]:
            """Return the function of the other arguments, which makes an object of the class."""
            ...

else:
    Constructor = classmethod


class SuggestingMeta(ABCMeta):
    """Metaclass of classes, abstract ones too, that propose a name for a misspelt constructor."""

    if not TYPE_CHECKING:  # or no name would be unknown to type checkers

        def __getattr__(cls, name: str) -> NoReturn:
            raise unknown_attribute(cls.__name__, name, dir(cls))

    def __dir__(cls) -> list[str]:
        return [name for name in super().__dir__() if name != "_abc_impl"]


class Immutable(metaclass=SuggestingMeta):
    """A value whose attributes cannot be changed; ``dir`` lists the public ones."""

    __slots__ = ()

    def __setattr__(self, name: str, value: object) -> NoReturn:
        msg = f"{type(self).__name__} is immutable; build a new one to change {name}"
        raise AccessError(msg)

    def __delattr__(self, name: str) -> NoReturn:
        msg = f"{type(self).__name__} is immutable; {name} cannot be deleted"
        raise AccessError(msg)

    def __dir__(self) -> list[str]:
        return [name for name in super().__dir__() if not name.startswith("_")]


def public_names(
    module: str, names: list[str]
) -> tuple[Callable[[str], NoReturn], Callable[[], list[str]]]:
    """Return ``__getattr__`` and ``__dir__`` of a module, for proposals of its public names."""
    owner = f"module {module!r}"

    def no_attribute(name: str) -> NoReturn:
        raise unknown_attribute(owner, name, names)

    return no_attribute, lambda: names
