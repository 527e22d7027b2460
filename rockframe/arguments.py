"""Arguments without a unit: one of a few words, a text, a whole number, or a dataset."""

from collections.abc import Callable, Mapping
from enum import StrEnum
from functools import wraps
from inspect import Parameter, signature
from operator import index
from typing import Any, Final, SupportsIndex, TypeVar, cast

import xarray as xr

from rockframe.errors import ComponentError, SchemaError, nearest, shown, unexpected_argument

Words = TypeVar("Words", bound=StrEnum)
Function = TypeVar("Function", bound=Callable[..., Any])
_BOUND: Final = ("self", "cls", "kind", "motion")
"""What methods have first, which nobody gives by name."""


def hinted(**hints: str) -> Callable[[Function], Function]:
    """Say more of arguments that a function does not take: hints, or which one was meant."""

    def decorate(function: Function) -> Function:
        first, *rest = signature(function).parameters.values()
        by_name = (Parameter.POSITIONAL_OR_KEYWORD, Parameter.KEYWORD_ONLY)
        known = [one.name for one in (first, *rest) if one.kind in by_name]
        listed = known[1:] if first.name in _BOUND else known
        any_name = any(one.kind is one.VAR_KEYWORD for one in rest)

        @wraps(function)
        def call(*given: Any, **named: Any) -> Any:
            for name in named:
                if name in hints:
                    msg = f"{function.__qualname__}() takes no {name!r}: {hints[name]}"
                    raise TypeError(msg)
                if name not in known and not any_name:
                    words = f"{function.__qualname__}()"
                    raise unexpected_argument(words, name, listed)
            return function(*given, **named)

        call.hints = hints  # type: ignore[attr-defined]
        return cast("Function", call)

    return decorate


def hints_of(function: Callable[..., Any]) -> Mapping[str, str]:
    """Give the hints of a function that is :func:`hinted`; none of any other."""
    return getattr(function, "hints", {})


def by_words(given: Mapping[Any, Any], *, owner: str) -> dict[str, Any]:
    """Read a mapping whose keys are labels, also numbers, as a mapping of words."""
    found = {str(key): value for key, value in given.items()}
    if len(found) < len(given):
        words = [str(key) for key in given]
        twice = next(word for word in words if words.count(word) > 1)
        msg = f"{owner}: two are called {twice!r}; expected names that differ"
        raise ComponentError(msg)
    return found


def one_of_words(kind: type[Words], given: object, *, owner: str, name: str) -> Words:
    """Read an argument that is one of a few words."""
    try:
        return kind(str(given))
    except ValueError:
        known = " or ".join(repr(str(one)) for one in kind)
        near = nearest(given, map(str, kind))
        msg = f"{owner}: {name} must be {known}, got {shown(given)}{near}"
        raise ComponentError(msg) from None


def text(given: object, *, owner: str, name: str) -> str:
    """Read an argument that is a text."""
    if isinstance(given, str):
        return given
    msg = f"{owner}: {name} must be a text, got {shown(given)}"
    raise ComponentError(msg)


def truth(given: object, *, owner: str, name: str) -> bool:
    """Read an argument that is True or False."""
    if isinstance(given, bool):
        return given
    msg = f"{owner}: {name} must be True or False, got {shown(given)}"
    raise ComponentError(msg)


def whole_number(
    given: object, *, owner: str, name: str, lowest: int, highest: int | None = None
) -> int:
    """Read an argument that is a whole number, Python's or numpy's."""
    try:
        number = None if isinstance(given, bool) else index(cast("SupportsIndex", given))
    except TypeError:
        number = None
    if number is not None and lowest <= number and (highest is None or number <= highest):
        return number
    wanted = f", {lowest} or more" if highest is None else f" from {lowest} to {highest}"
    msg = f"{owner}: {name} must be a whole number{wanted}, got {shown(given)}"
    raise ComponentError(msg)


def checked_dataset(given: object, *, owner: str) -> xr.Dataset:
    """Read an argument that is a dataset."""
    if isinstance(given, xr.Dataset):
        return given
    msg = (
        f"{owner}: found {shown(given)}; expected a dataset: open a file with xr.open_dataset first"
    )
    raise SchemaError(msg)
