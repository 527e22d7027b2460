"""Checks of arguments without a unit: one of a few words, a text, a whole number, or a dataset."""

from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from enum import StrEnum
from inspect import signature
from operator import index
from typing import Any, SupportsIndex, TypeVar, cast

import xarray as xr

from rockframe.errors import ComponentError, SchemaError, nearest, shown

Words = TypeVar("Words", bound=StrEnum)


def by_words(given: Mapping[Any, Any], *, owner: str) -> dict[str, Any]:
    """Convert the keys of a mapping, such as numbers, to strings that differ."""
    found = {str(key): value for key, value in given.items()}
    if len(found) < len(given):
        words = [str(key) for key in given]
        twice = next(word for word in words if words.count(word) > 1)
        msg = f"{owner}: two entries are called {twice!r}; expected names that differ"
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


def one_of_names(given: object, known: Iterable[str], *, owner: str, name: str) -> str:
    """Read an argument that is one of some names."""
    listed = list(known)
    if isinstance(given, str) and given in listed:
        return given
    near = nearest(given, listed)
    msg = f"{owner}: {name} must be one of {', '.join(map(repr, listed))}, got {shown(given)}{near}"
    raise ComponentError(msg)


def several(given: object, *, owner: str, name: str, of: str) -> list[Any]:
    """Read an argument that is a sequence; a single text counts as one of one element."""
    if isinstance(given, str):
        return [given]
    if isinstance(given, Iterable) and not isinstance(given, Mapping | bytes):
        with suppress(TypeError):  # for example an array without dimensions
            return list(cast("Iterable[Any]", given))
    msg = f"{owner}: {name} must be a list of {of}, got {shown(given)}"
    raise ComponentError(msg)


def by_names(given: object, *, owner: str, name: str, example: str) -> Mapping[str, Any]:
    """Read an argument that is a mapping with texts as keys."""
    plain = isinstance(given, Mapping) and not isinstance(given, xr.Dataset)
    if plain and all(isinstance(key, str) for key in cast("Mapping[Any, Any]", given)):
        return cast("Mapping[str, Any]", given)
    msg = f"{owner}: {name} must be a mapping, such as {example}, got {shown(given)}"
    raise ComponentError(msg)


def function_of(given: object, *arguments: str, owner: str, name: str) -> Callable[..., Any]:
    """Read an argument that is a function of some positional arguments."""
    wanted = f"a function of {' and '.join(arguments)}"
    if not callable(given):
        msg = f"{owner}: {name} must be {wanted}, got {shown(given)}"
        raise ComponentError(msg)
    try:
        takes = signature(given)
    except ValueError:  # no signature, as of functions of NumPy
        return given
    try:
        takes.bind(*arguments)
    except TypeError as problem:
        msg = f"{owner}: {name} must be {wanted}, got {shown(given)}: {problem}"
        raise ComponentError(msg) from None
    return given


def truth(given: object, *, owner: str, name: str) -> bool:
    """Read an argument that is True or False."""
    if isinstance(given, bool):
        return given
    msg = f"{owner}: {name} must be True or False, got {shown(given)}"
    raise ComponentError(msg)


def whole_number(
    given: object, *, owner: str, name: str, lowest: int, highest: int | None = None
) -> int:
    """Read an argument that is a whole number of Python or NumPy."""
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
