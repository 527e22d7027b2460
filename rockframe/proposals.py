"""What is answered to names that there are not: of arguments, of methods and values, of functions.

Python says that there is no such name. Here it is said too which one may have been meant, by an
error of rockframe, whose traceback in notebooks is the line that was wrong.
"""

from abc import ABCMeta
from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from inspect import Parameter, signature
from types import FunctionType
from typing import TYPE_CHECKING, Any, Final, NoReturn, TypeVar, cast

from rockframe.errors import ArgumentError, unexpected_argument, unknown_attribute

Function = TypeVar("Function", bound=Callable[..., Any])
Class = TypeVar("Class", bound=type)
_BOUND: Final = {
    "self": "", "cls": "", "kind": "rockframe.motion.", "motion": "rockframe.motion.",
    "suite": "rockframe.suites.",
}  # fmt: skip
"""What methods have first, which nobody gives by name; and where functions are methods."""


def hinted(**hints: str) -> Callable[[Function], Function]:
    """Say more of arguments that a function does not take: hints, or which one was meant."""

    def decorate(function: Function) -> Function:
        parameters = list(signature(function).parameters.values())
        by_name = (Parameter.POSITIONAL_OR_KEYWORD, Parameter.KEYWORD_ONLY)
        known = [one.name for one in parameters if one.kind in by_name]
        home = _BOUND.get(parameters[0].name) if parameters else None
        bound = home is not None and function.__module__.startswith(home)
        listed = known[1:] if bound else known
        any_name = any(one.kind is one.VAR_KEYWORD for one in parameters)

        @wraps(function)
        def call(*given: Any, **named: Any) -> Any:
            for name in named:
                if name in hints:
                    msg = f"{function.__qualname__}() takes no {name!r}: {hints[name]}"
                    raise ArgumentError(msg)
                if name not in known and not any_name:
                    words = f"{function.__qualname__}()"
                    raise unexpected_argument(words, name, listed)
            try:
                return function(*given, **named)
            except TypeError as problem:
                raise_refused(problem, [*listed, "what has a name"] if any_name else listed)
                raise

        call.hints = hints  # type: ignore[attr-defined]
        return cast("Function", call)

    return decorate


def hints_of(function: Callable[..., Any]) -> Mapping[str, str] | None:
    """Give the hints of a function that is :func:`hinted`; None of any other."""
    return getattr(function, "hints", None)


def raise_refused(problem: TypeError, listed: Iterable[str]) -> None:
    """Say what a function takes, if the call itself was refused: if nothing of it was run."""
    trace = problem.__traceback__
    if trace is None or trace.tb_next is not None:
        return
    names = ", ".join(listed)
    taken = f". It takes {names}" if names else ". It takes no arguments"
    msg = f"{problem}{taken}"
    raise ArgumentError(msg) from None


def proposing(kind: Class) -> Class:
    """Let a class propose what was meant by arguments and attributes that it does not have.

    Methods that a class inherits are those of a class that proposes too.
    """
    for name, one in list(vars(kind).items()):
        if name.startswith("_") and name != "__init__":
            continue
        if isinstance(one, classmethod | staticmethod):
            function: Any = cast("Any", one).__func__
            if _is_plain(function):
                setattr(kind, name, type(one)(hinted()(function)))
        elif _is_plain(one):
            setattr(kind, name, hinted()(one))
    if not any("__getattr__" in vars(one) for one in kind.__mro__):
        kind.__getattr__ = _no_attribute
    return kind


def _is_plain(one: object) -> bool:
    return isinstance(one, FunctionType) and hints_of(one) is None


def _no_attribute(self: object, name: str) -> NoReturn:
    if any(name in vars(one) for one in type(self).__mro__):  # a property that failed
        object.__getattribute__(self, name)
    # what programs ask for begins with an underscore, such as what dir() itself does
    known = () if name.startswith("_") else dir(self)
    raise unknown_attribute(type(self).__name__, name, known)


class Proposing(ABCMeta):
    """What classes are made by whose constructors are proposed, too, where they are misspelt.

    Classes that are derived from them may be abstract.
    """

    if not TYPE_CHECKING:  # or no name would be unknown to type checkers

        def __getattr__(cls, name: str) -> NoReturn:
            raise unknown_attribute(cls.__name__, name, dir(cls))

    def __dir__(cls) -> list[str]:
        return [name for name in super().__dir__() if name != "_abc_impl"]


def attributes_of(module: str, names: Iterable[str]) -> Callable[[str], NoReturn]:
    """Give what a module calls ``__getattr__``: it proposes one of its public names."""
    known, owner = list(names), f"module {module!r}"

    def no_attribute(name: str) -> NoReturn:
        raise unknown_attribute(owner, name, known)

    return no_attribute
