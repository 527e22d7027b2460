"""The vocabulary of functions that can be compiled: marks, array types, tuples, lanes.

Marked functions and methods stay plain Python: called from Python they run as Python. Methods are
those of named tuples of numbers, and belong to their classes: other classes may have fields, or
other methods, of the same name.

Runs in lanes share one array, ordered by fields: element ``field * LANES + lane`` is a field of one
lane. A loop over all lanes that reads and writes only such an array is compiled to instructions for
several lanes at once.
"""

import inspect
import os
from collections.abc import Callable
from contextvars import ContextVar
from typing import Annotated, Any, Final, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

Vector: TypeAlias = NDArray[np.float64]
Matrix: TypeAlias = NDArray[np.float64]
ReadOnlyMatrix: TypeAlias = Annotated[NDArray[np.float64], "not written to"]
Integers: TypeAlias = NDArray[np.int64]
IntegerMatrix: TypeAlias = NDArray[np.int64]


Function = TypeVar("Function", bound=Callable[..., Any])

KERNELS: Final[dict[Callable[..., Any], bool]] = {}
"""Marked functions, and whether each is compiled into its callers."""


PURPOSE: Final = ContextVar("purpose", default="this")
"""What needs the machine code that is compiled, for messages."""
PYTHON_SECONDS: Final[list[float]] = [0.0]
"""Time that entries, and functions that they call back, have spent in plain Python [s]."""
REMAINING_SECONDS: Final = ContextVar("remaining_seconds", default=0.0)
"""Remaining time in plain Python that the caller expects; 0 where it is unknown [s]."""
AFTER_CALL: Final = ContextVar[Callable[[], None]]("after_call", default=lambda: None)
"""What is called after each bound function that plain Python calls, or that is plain Python."""


def kernel(function: Function) -> Function:
    """Mark a function, or a method of a named tuple, that compiled code may call."""
    KERNELS[function] = False
    return function


def inlined(function: Function) -> Function:
    """Mark a function or method to be compiled into its callers: the few that every step calls."""
    KERNELS[function] = True
    return function


def call_of_either(method: Callable[..., Any], is_first: str, first: str, second: str) -> Any:
    """Return a method, yet unmarked, that calls the one of its name of one of two objects.

    Which one, and both objects, are written as expressions of `self`.
    """
    name, (own, *others) = method.__name__, inspect.signature(method).parameters
    call = f"{name}({', '.join(others)})"
    scope: dict[str, Any] = {}
    exec(  # noqa: S102 - compiled code does not look up methods by names in variables
        f"def {name}({', '.join([own, *others])}):\n"
        f"    return {first}.{call} if {is_first} else {second}.{call}\n",
        scope,
    )
    written: Any = scope[name]
    written.__module__, written.__qualname__ = method.__module__, method.__qualname__
    written.__doc__ = method.__doc__
    return written


def is_method(function: Callable[..., Any]) -> bool:
    """Whether a marked function was defined in the body of a class."""
    holder = function.__qualname__.rpartition(".")[0]
    return bool(holder) and not holder.endswith("<locals>")


Array = TypeVar("Array", bound=NDArray[Any])
Bundle = TypeVar("Bundle")


def constant(value: float, like: tuple[float, ...]) -> tuple[float, ...]:
    """Return a tuple as long as another one, with one number in all places."""
    return (value,) * len(like)


def put(numbers: tuple[float, ...] | Vector, first: int, out: Vector) -> None:
    """Write a tuple, or an array, into an array, from an index on."""
    for i, number in enumerate(numbers):
        out[first + i] = number


def with_numbers(
    numbers: tuple[float, ...], first: int, others: tuple[float, ...]
) -> tuple[float, ...]:
    """Return a copy of a tuple in which other numbers replace some, from an index on."""
    return (*numbers[:first], *others, *numbers[first + len(others) :])


def filled(like: Bundle, numbers: Vector) -> Bundle:
    """Return a named tuple of the class of another one, filled with numbers from an array."""
    kind: Any = type(like)
    return kind(*numbers[: len(kind._fields)])


def view_from(array: Vector, first: int) -> Vector:
    """Return the part of an array from an index on; no copy."""
    return array[first:]


def view_of(array: Array, first: int, count: int) -> Array:
    """Return some elements of an array, or rows of a matrix, from an index on; no copy."""
    some: Any = array[first : first + count]
    return some


Numbers = TypeVar("Numbers", Vector, Integers)

LANES: Final = 16
"""Number of lanes: they fill two of the widest registers, or four of the usual ones."""


def lane_of(data: Numbers, field: int, lane: int) -> Numbers:
    """Return the fields of one lane, from a field on, as an array; no copy."""
    fields: Numbers = data[field * LANES + lane :: LANES]
    return fields


def as_integers(array: Vector) -> Integers:
    """Return a view of an array as integers of the same memory."""
    return array.view("int64")


def widest_registers() -> None:
    """Let the calling function be compiled for the widest registers of the processor."""


def processors() -> int:
    """Return the number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def tuple_from(structure: tuple[Any, ...]) -> Callable[[Vector], Any]:
    """Return the function that makes a tuple of some structure from a vector of its numbers."""

    def tuple_and_end(
        kind: Any, parts: tuple[Any, ...], numbers: Vector, first: int
    ) -> tuple[Any, int]:
        elements: list[Any] = []
        for part in parts:
            if isinstance(part, tuple):
                value, first = tuple_and_end(part[0], part[1:], numbers, first)
            elif part is np.ndarray:  # all that are left
                value, first = numbers[first:], len(numbers)
            else:
                value, first = part(numbers[first]), first + 1
            elements.append(value)
        return (tuple(elements) if kind is tuple else kind(*elements)), first

    return lambda numbers: tuple_and_end(structure[0], structure[1:], numbers, 0)[0]
