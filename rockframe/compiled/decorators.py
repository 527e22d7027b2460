"""The functions and methods that compiled code may call.

All of them stay plain Python: called from Python they run as Python. Methods are those of
named tuples of numbers, and belong to their classes: other classes may have fields, or other
methods, of the same name.
"""

from collections.abc import Callable
from typing import Any, Final, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])

KERNELS: Final[dict[Callable[..., Any], bool]] = {}
"""Marked functions, and whether each is compiled into its callers."""


def kernel(function: Function) -> Function:
    """Mark a function, or a method of a named tuple, that compiled code may call."""
    KERNELS[function] = False
    return function


def inlined(function: Function) -> Function:
    """Mark a function, or a method, that is compiled into its callers.

    For the few that every step calls.
    """
    KERNELS[function] = True
    return function


def is_method(function: Callable[..., Any]) -> bool:
    """Whether a marked function was defined in the body of a class."""
    holder = function.__qualname__.rpartition(".")[0]
    return bool(holder) and not holder.endswith("<locals>")
