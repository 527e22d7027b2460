"""Identity of a study, field by field: studies that differ in anything have different digests."""

import hashlib
import inspect
import json
import sys
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from types import CodeType
from typing import Any, Final, cast

import numpy as np

from rockframe.components import Component
from rockframe.errors import StudyError, short_repr
from rockframe.motion import GroundMotion
from rockframe.signals.arrays import AnyArray

_PACKAGE: Final = __name__.partition(".")[0]


def description_of(value: object) -> Any:
    """Describe a value for JSON, so that different values have different descriptions."""
    if value is None or isinstance(value, str | bool | int | float):
        return value
    if isinstance(value, np.generic):
        return description_of(value.item())
    if isinstance(value, np.ndarray):
        return _digest_of_array(cast("AnyArray", value))
    if isinstance(value, GroundMotion):
        return digest_of(description_of(value.si))
    if isinstance(value, Component):
        return {
            **value.to_dict(),
            "given": description_of(vars(value.given)),
            **_source_of_class(type(value)),
        }
    if is_dataclass(value) and not isinstance(value, type):
        names = [field.name for field in fields(value) if field.compare]
        entries = {name: description_of(getattr(value, name)) for name in names}
        return {"kind": type(value).__name__, **entries}
    if isinstance(value, Mapping):
        items = cast("Mapping[Any, Any]", value).items()
        return [[description_of(key), description_of(entry)] for key, entry in items]
    if isinstance(value, tuple | list):
        return [description_of(entry) for entry in cast("list[Any]", value)]
    if callable(value):
        return _describe_function(value)
    msg = (
        f"found {short_repr(value)}, which cannot be recognised in another process; "
        "expected numbers, words, arrays, motions, components or dataclasses of them"
    )
    raise StudyError(msg)


def digest_of(described: object) -> str:
    """Return sha256 of what :func:`description_of` has described; the order of entries counts."""
    return hashlib.sha256(json.dumps(described).encode()).hexdigest()


def difference(first: object, second: object) -> list[str]:
    """Name the entries in which two descriptions differ, with nested ones in brackets."""
    a, b = _named_entries(first), _named_entries(second)
    names: list[str] = []
    for name in dict.fromkeys([*a, *b]):
        if name in a and name in b and a[name] == b[name]:
            continue
        inside = difference(a.get(name), b.get(name)) if name in a and name in b else []
        names.append(f"{name} ({', '.join(inside)})" if inside else name)
    if not names and list(a) != list(b):
        return ["in their order"]
    return names


def _named_entries(described: object) -> dict[str, Any]:
    """Return named entries of a description: a dataclass, a mapping, or a list of named items."""
    if isinstance(described, dict):
        return cast("dict[str, Any]", described)
    rows = cast("list[Any]", described) if isinstance(described, list) else []
    if rows and all(isinstance(row, dict) and "name" in row for row in rows):
        return {row["name"]: row for row in rows}
    if rows and all(isinstance(row, list) and len(row) == 2 for row in rows):
        return {str(name): value for name, value in rows}
    return {}


def _digest_of_array(values: AnyArray) -> str:
    if values.dtype.kind in "OU":
        return digest_of([list(values.shape), values.astype(str).tolist()])
    little = values.astype(values.dtype.newbyteorder("<"))
    about = f"{little.dtype.str}{little.shape}".encode()
    return hashlib.sha256(about + little.tobytes()).hexdigest()


def _describe_function(function: Callable[..., object]) -> dict[str, str]:
    """Name a function, with a digest of its source, or else of its compiled code."""
    try:
        written = inspect.getsource(function)
    except (OSError, TypeError):
        written = _describe_code(getattr(function, "__code__", None))
    return {"function": name_of_function(function), "source": digest_of(written)}


def _describe_code(code: CodeType | None) -> list[Any]:
    """Describe compiled code, and the code of functions inside it."""
    if code is None:
        return []
    constants = [_describe_code(c) if isinstance(c, CodeType) else repr(c) for c in code.co_consts]
    return [code.co_code.hex(), code.co_names, constants]


def name_of_function(function: Callable[..., object]) -> str:
    """Return the name of a function, or else of its class."""
    return getattr(function, "__qualname__", type(function).__name__)


@cache
def _source_of_class(kind: type) -> dict[str, str]:
    """Describe the source of a class from outside rockframe, with everything defined beside it."""
    # the equations of a user's base are the classes, functions and constants beside its component
    texts: list[Any] = []
    left_out = {_PACKAGE, *sys.stdlib_module_names}  # Python's own, such as `typing.Generic`
    for base in kind.__mro__:
        module = inspect.getmodule(base)
        if module is None or module.__name__.partition(".")[0] in left_out:
            continue
        texts.append(_describe_function(base))
        for name, value in sorted(vars(module).items()):
            if callable(value) and getattr(value, "__module__", None) == module.__name__:
                texts.append(_describe_function(value))
            # those of a script or a notebook are many, and most do not belong to the base
            elif isinstance(value, int | float | str) and module.__name__ != "__main__":
                texts += [] if name.startswith("__") else [[name, value]]
    return {"written": digest_of(texts)} if texts else {}
