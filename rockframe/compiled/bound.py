"""Bound functions: functions whose first argument, a tuple of numbers, is fixed.

Compiled code calls a bound function by its address, whatever the class of the tuple: the last
argument is a vector of the numbers of the tuple.
"""

from collections.abc import Callable, Iterator
from typing import Any, cast

import numpy as np

from rockframe.compiled.callbacks import call_machine_code, python_callback
from rockframe.compiled.language import AFTER_CALL, Vector, tuple_from
from rockframe.compiled.sources import BoundSource, bound_source


def numbers_in(bundle: Any) -> Vector:
    """Return the numbers of a tuple and of the tuples in it, one after the other.

    The elements of an array, which may be the last element of a tuple, are copied, so that each run
    has its own.
    """
    return np.array([float(value) for value in elements_of(bundle)], dtype=np.float64)


def elements_of(bundle: Any) -> Iterator[Any]:
    """Return the elements of a tuple and of the tuples in it, one after the other."""
    for value in bundle:
        if isinstance(value, tuple | np.ndarray):
            yield from elements_of(value)
        else:
            yield value


def structure_of(bundle: Any) -> tuple[Any, ...]:
    """Return the class of a tuple and, in their order, the types of its elements."""
    return (type(bundle), *(
        structure_of(value) if isinstance(value, tuple) else type(value) for value in bundle
    ))  # fmt: skip


class BoundFunction:
    """A function bound to a tuple: called in plain Python, or by entries as machine code.

    It may stand in for another one until it pays to compile that.
    """

    __slots__ = ("_bundle", "fallback_for", "source")

    def __init__(
        self, source: BoundSource, bundle: Any, fallback_for: "BoundFunction | None" = None
    ) -> None:
        self.source = source
        self._bundle = bundle
        self.fallback_for = fallback_for

    def call(self, *arguments: Any) -> Any:
        """Call the function with its tuple, the numbers of which are the last argument."""
        if self.source.address:
            result = call_machine_code(self.source, [*_words_of(arguments)])
        else:
            result = self.source.function(self._bundle, *arguments[:-1])
        AFTER_CALL.get()()
        return result


def _words_of(argument: Any) -> Iterator[Any]:
    """Return the words that pass an argument to machine code."""
    if isinstance(argument, tuple):
        for part in cast("tuple[Any, ...]", argument):
            yield from _words_of(part)
    elif isinstance(argument, memoryview | np.ndarray):
        array = np.asarray(argument)
        yield array.__array_interface__["data"][0]
        yield from array.shape
    elif isinstance(argument, BoundFunction):
        yield argument.source.address or python_callback(argument.source).address
    else:
        yield argument


def bind(
    functions: tuple[Callable[..., Any], ...],
    bundle: Any,
    *,
    rarely_called: bool = False,
    fallback_for: BoundFunction | None = None,
) -> tuple[BoundFunction, ...]:
    """Bind functions to the tuple that is their first argument.

    Functions that are `rarely_called` may run as plain Python. If there is an array in the tuple,
    all of them share one copy of it.
    """
    structure, bundle = structure_of(bundle), _with_own_arrays(bundle)
    return tuple(
        BoundFunction(bound_source(function, structure, False, rarely_called), bundle, fallback_for)
        for function in functions
    )


def _with_own_arrays(value: Any) -> Any:
    """Return a tuple with copies of the arrays in it and in the tuples in it."""
    if isinstance(value, tuple):
        parts = map(_with_own_arrays, cast("tuple[Any, ...]", value))
        return value._make(parts) if hasattr(value, "_make") else tuple(parts)  # type: ignore[attr-defined]
    return value.copy() if isinstance(value, np.ndarray) else value


def bind_in_lanes(function: Callable[..., Any], bundle: Any) -> BoundFunction:
    """Bind a function to the class of a tuple; each lane has its own numbers of it."""
    structure = structure_of(bundle)
    return BoundFunction(bound_source(function, structure, True, False), tuple_from(structure))
