"""Functions of a tuple of numbers, bound to one such tuple.

Compiled code calls them by their address, whatever the class of the tuple: its numbers are
the elements of the last argument, a vector.
"""

from collections.abc import Callable, Iterator
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rockframe.compiled.called_back import CalledBack
from rockframe.compiled.language import Vector, tuple_from

if TYPE_CHECKING:
    from rockframe.compiled.jobs import Job


def numbers_in(bundle: Any) -> Vector:
    """Give the numbers of a tuple and of the tuples in it, one after the other.

    An array, with which a tuple may end, is copied: each run works in its own.
    """
    return np.array([float(value) for value in elements_of(bundle)], dtype=np.float64)


def elements_of(bundle: Any) -> Iterator[Any]:
    """Give the elements of a tuple and of the tuples in it, one after the other."""
    for value in bundle:
        if isinstance(value, tuple | np.ndarray):
            yield from elements_of(value)
        else:
            yield value


def structure_of(bundle: Any) -> tuple[Any, ...]:
    """Give the class of a tuple and, in their order, the kinds of what it holds."""
    return (type(bundle), *(
        structure_of(value) if isinstance(value, tuple) else type(value) for value in bundle
    ))  # fmt: skip


class Signature:
    """Numba's signature of a function, which is looked up in each call of an entry: hashed once."""

    def __init__(self, value: Any) -> None:
        self.value = value
        self._hash = hash(value)

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        return self is other or (isinstance(other, Signature) and self.value == other.value)


_shared = cache(Signature)


class Source:
    """A function and the structure of a tuple that it can be bound to.

    One that is called seldom may run as plain Python until it is worth compiling.
    """

    def __init__(
        self, function: Callable[..., Any], structure: tuple[Any, ...], in_lanes: bool, seldom: bool
    ) -> None:
        self.function = function
        self.structure = structure
        self.in_lanes = in_lanes
        self.is_seldom_called = seldom
        self.code: Any = None  # once it has been compiled
        self.address = 0  # of that
        self.failed = False  # to be compiled
        self.seconds_called_back = 0.0

    @cached_property
    def job(self) -> "Job":
        """What is compiled of it."""
        from rockframe.compiled.jobs import Job

        return Job(self.function, self.structure, True, self.in_lanes)

    @cached_property
    def called_back(self) -> CalledBack:
        """What machine code calls where there is none of this."""
        return CalledBack(self)

    @cached_property
    def signature(self) -> Signature:
        """Its signature; functions of equal signatures share one."""
        from rockframe.compiled.jobs import signature_of

        return _shared(signature_of(self.function))


_source = cache(Source)


class Bound:
    """A function bound to a tuple: plain Python, and what entries call in its place."""

    __slots__ = ("_bundle", "source")

    def __init__(self, source: Source, bundle: Any) -> None:
        self.source = source
        self._bundle = bundle

    def call(self, *arguments: Any) -> Any:
        """Call the function with the tuple in place of its numbers, the last argument."""
        return self.source.function(self._bundle, *arguments[:-1])


def bound(
    functions: tuple[Callable[..., Any], ...], bundle: Any, *, seldom: bool = False
) -> tuple[Bound, ...]:
    """Bind functions to the tuple that is their first argument; say if they are called seldom.

    They share a copy of an array with which it may end.
    """
    structure = structure_of(bundle)
    if isinstance(bundle, tuple) and isinstance(bundle[-1], np.ndarray):
        bundle = type(bundle)(*bundle[:-1], bundle[-1].copy())  # type: ignore[call-arg]
    return tuple(Bound(_source(one, structure, False, seldom), bundle) for one in functions)


def bound_in_lanes(function: Callable[..., Any], bundle: Any) -> Bound:
    """Bind a function to the class of a tuple, of which each lane has its own."""
    structure = structure_of(bundle)
    return Bound(_source(function, structure, True, False), tuple_from(structure))
