"""The functions that can be compiled, and what is known of them.

All of them stay plain Python functions: called from Python they run as Python.
Machine code is made and used by the entries, :mod:`rockframe.compiled.entries`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, TypeVar, get_args, get_type_hints

Function = TypeVar("Function", bound=Callable[..., Any])


@dataclass(frozen=True, init=False)
class Signature:
    """Fixed signature of a callback, by which the integrator can call any model.

    Parameters
    ----------
    result : str
        Type of the result.
    *arguments : str
        Types of the arguments.
    """

    result: str
    arguments: tuple[str, ...]

    def __init__(self, result: str, *arguments: str) -> None:
        object.__setattr__(self, "result", result)
        object.__setattr__(self, "arguments", arguments)


KERNELS: Final[dict[Callable[..., Any], bool]] = {}
"""Helper functions, and whether each is compiled into its callers."""

CALLBACKS: Final[dict[Callable[..., Any], Signature]] = {}
"""Functions whose address can be taken, with their signatures."""


def kernel(function: Function) -> Function:
    """Mark a helper function of compiled ones."""
    KERNELS[function] = False
    return function


def inlined(function: Function) -> Function:
    """Mark a helper function of every step, compiled into its callers.

    A tuple of arrays is passed word by word, a hundred words a call; the few
    functions that every step calls are spared that.
    """
    KERNELS[function] = True
    return function


def callback(signature: Signature) -> Callable[[Function], Function]:
    """Mark a function that compiled ones call by its address."""

    def mark(function: Function) -> Function:
        CALLBACKS[function] = signature
        return function

    return mark


def field_kinds(tuple_type: type) -> tuple[str, ...]:
    """Give the names of the types of a named tuple's fields."""
    plain = {int: "integer", float: "real"}
    hints = get_type_hints(tuple_type, include_extras=True).values()
    return tuple(plain.get(hint) or get_args(hint)[1] for hint in hints)


def name_of(function: Callable[..., Any]) -> str:
    """Give the full name of a function."""
    return f"{function.__module__}.{function.__qualname__}"
