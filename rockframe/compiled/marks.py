"""The functions and methods that compiled code may call.

All of them stay plain Python: called from Python they run as Python. Methods are those of
named tuples of numbers, and are told apart by the class of their object; methods of one
name take equally many arguments, by position.
"""

import inspect
from collections.abc import Callable
from typing import Any, Final, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])

KERNELS: Final[dict[Callable[..., Any], bool]] = {}
"""Marked functions, and whether each is compiled into its callers."""


METHODS: Final[dict[str, int]] = {}
"""Names of marked methods, and how many arguments each takes."""


def kernel(function: Function) -> Function:
    """Mark a function, or a method of a named tuple, that compiled code may call.

    Raises
    ------
    TypeError
        A marked method of that name takes another number of arguments.
    """
    return _marked(function, into_caller=False)


def inlined(function: Function) -> Function:
    """Mark a function, or a method, that is compiled into its callers.

    For the few that every step calls. Of methods of one name the first one decides.
    """
    return _marked(function, into_caller=True)


def _marked(function: Function, *, into_caller: bool) -> Function:
    if is_method(function):
        count = len(inspect.signature(function).parameters)
        known = METHODS.setdefault(function.__name__, count)
        if known != count:
            msg = (
                f"{function.__module__}.{function.__qualname__} takes {count} arguments, but "
                f"other methods of that name that can be compiled take {known}; give it another "
                "name"
            )
            raise TypeError(msg)
    KERNELS[function] = into_caller
    return function


def is_method(function: Callable[..., Any]) -> bool:
    """Whether a marked function was defined in the body of a class."""
    holder = function.__qualname__.rpartition(".")[0]
    return bool(holder) and not holder.endswith("<locals>")
