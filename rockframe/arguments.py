"""Checks of arguments without a unit: one of a few words, a text, a whole number, or a dataset."""

import json
from collections.abc import Callable, Generator, Iterable, Mapping
from contextlib import contextmanager
from enum import StrEnum
from inspect import Parameter, Signature, signature
from operator import index
from typing import Any, SupportsIndex, TypeGuard, TypeVar, cast

import xarray as xr

from rockframe.errors import ComponentError, SchemaError, did_you_mean, short_repr

Option = TypeVar("Option", bound=StrEnum)
Value = TypeVar("Value")


def with_string_keys(
    values: Mapping[Any, Any] | list[tuple[Any, Any]], *, owner: str
) -> dict[str, Any]:
    """Convert the keys of a mapping or of its items, such as numbers, to strings that differ."""
    items = [*values.items()] if isinstance(values, Mapping) else values
    named = {str(key): value for key, value in items}
    if len(named) < len(items):
        words = [str(key) for key, _ in items]
        repeated = next(word for word in words if words.count(word) > 1)
        msg = f"{owner}: two entries are called {repeated!r}; expected names that differ"
        raise ComponentError(msg)
    return named


def checked_choice(kind: type[Option], value: object, *, owner: str, name: str) -> Option:
    """Read an argument that is one of a few words."""
    try:
        return kind(str(value))
    except ValueError:
        choices = " or ".join(repr(str(member)) for member in kind)
        near = did_you_mean(value, map(str, kind))
        msg = f"{owner}: {name} must be {choices}, got {short_repr(value)}{near}"
        raise ComponentError(msg) from None


def checked_text(value: object, *, owner: str, name: str) -> str:
    """Read an argument that is a text."""
    if isinstance(value, str):
        return value
    msg = f"{owner}: {name} must be a text, got {short_repr(value)}"
    raise ComponentError(msg)


def checked_name(value: object, known: Iterable[str], *, owner: str, name: str) -> str:
    """Read an argument that is one of some names."""
    listed = list(known)
    if isinstance(value, str) and value in listed:
        return value
    near = did_you_mean(value, listed)
    msg = (
        f"{owner}: {name} must be one of {', '.join(map(repr, listed))}, got "
        f"{short_repr(value)}{near}"
    )
    raise ComponentError(msg)


def is_iterable(value: object) -> TypeGuard[Iterable[Any]]:
    """Whether a value has elements; arrays and quantities without dimensions only seem to."""
    return isinstance(value, Iterable) and getattr(value, "ndim", 1) != 0


def checked_list(value: object, *, owner: str, name: str, of: str) -> list[Any]:
    """Read an argument that is a sequence; a single text counts as a sequence of one element."""
    if isinstance(value, str):
        return [value]
    if is_iterable(value) and not isinstance(value, Mapping | bytes):
        return list(value)
    msg = f"{owner}: {name} must be a list of {of}, got {short_repr(value)}"
    raise ComponentError(msg)


def checked_mapping(value: object, *, owner: str, name: str, example: str) -> Mapping[str, Any]:
    """Read an argument that is a mapping with texts as keys."""
    plain = isinstance(value, Mapping) and not isinstance(value, xr.Dataset)
    if plain and all(isinstance(key, str) for key in cast("Mapping[Any, Any]", value)):
        return cast("Mapping[str, Any]", value)
    msg = f"{owner}: {name} must be a mapping, such as {example}, got {short_repr(value)}"
    raise ComponentError(msg)


def call_signature(function: Callable[..., Any]) -> Signature:
    """Return the arguments of a function; one that only passes on its own has those it wraps."""
    called = signature(function, follow_wrapped=False)
    kinds = {parameter.kind for parameter in called.parameters.values()}
    passes_on = kinds and kinds <= {Parameter.VAR_POSITIONAL, Parameter.VAR_KEYWORD}
    return signature(function) if passes_on else called


def checked_function(value: object, *arguments: str, owner: str, name: str) -> Callable[..., Any]:
    """Read an argument that is a function of some positional arguments."""
    expected = f"a function of {' and '.join(arguments)}"
    if not callable(value):
        msg = f"{owner}: {name} must be {expected}, got {short_repr(value)}"
        raise ComponentError(msg)
    try:
        parameters = call_signature(value)
    except ValueError:  # no signature, as of functions of NumPy
        return value
    try:
        parameters.bind(*arguments)
    except TypeError as problem:
        msg = f"{owner}: {name} must be {expected}, got {short_repr(value)}: {problem}"
        raise ComponentError(msg) from None
    return value


def checked_bool(value: object, *, owner: str, name: str) -> bool:
    """Read an argument that is True or False."""
    if isinstance(value, bool):
        return value
    msg = f"{owner}: {name} must be True or False, got {short_repr(value)}"
    raise ComponentError(msg)


def checked_integer(
    value: object, *, owner: str, name: str, lowest: int, highest: int | None = None
) -> int:
    """Read an argument that is a whole number of Python or NumPy."""
    try:
        number = None if isinstance(value, bool) else index(cast("SupportsIndex", value))
    except TypeError:
        number = None
    if number is not None and lowest <= number and (highest is None or number <= highest):
        return number
    limits = f", {lowest} or more" if highest is None else f" from {lowest} to {highest}"
    msg = f"{owner}: {name} must be a whole number{limits}, got {short_repr(value)}"
    raise ComponentError(msg)


def checked_dataset(value: object, *, owner: str) -> xr.Dataset:
    """Read an argument that is a dataset."""
    if isinstance(value, xr.Dataset):
        return value
    msg = (
        f"{owner}: found {short_repr(value)}; expected a dataset: open a file with xr.open_dataset "
        "first"
    )
    raise SchemaError(msg)


@contextmanager
def damage_reported(words: str) -> Generator[None]:
    """Raise a SchemaError that begins with these words for exceptions of damaged descriptions."""
    try:
        yield
    except (ValueError, LookupError, TypeError, AttributeError) as problem:
        reason = f"there is no {problem}" if isinstance(problem, KeyError) else problem
        if isinstance(problem, json.JSONDecodeError):
            reason = f"its JSON cannot be read: {problem}"
        msg = f"{words}: {reason}"
        raise SchemaError(msg) from problem


def read_attribute(
    dataset: xr.Dataset,
    name: str,
    read: Callable[[Any], Value],
    *,
    owner: str,
    default: object = None,
) -> Value:
    """Read an attribute of a dataset, which users may have changed; needed without a default."""
    with damage_reported(f"{owner}: the dataset's attribute {name!r} is damaged"):
        return read(dataset.attrs[name] if default is None else dataset.attrs.get(name, default))


def json_attribute(
    dataset: xr.Dataset,
    name: str,
    read: Callable[[Any], Value],
    *,
    owner: str,
    default: str | None = None,
) -> Value:
    """Read what the JSON in an attribute of a dataset describes."""
    return read_attribute(
        dataset, name, lambda text: read(json.loads(str(text))), owner=owner, default=default
    )
