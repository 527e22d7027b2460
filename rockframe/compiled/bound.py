"""Bound functions: functions whose first argument, a tuple of numbers, is fixed.

Compiled code calls a bound function by its address, whatever the class of the tuple: the last
argument is a vector of the numbers of the tuple.
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


class Signature:
    """Numba's signature of a function, with its hash, which each call of an entry uses."""

    def __init__(self, value: Any) -> None:
        self.value = value
        self._hash = hash(value)

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        return self is other or (isinstance(other, Signature) and self.value == other.value)


_shared = cache(Signature)


class Source:
    """A function and the structure of the tuples that it is bound to: what is compiled once.

    A function that is called seldom may run as plain Python until it pays to compile it.
    """

    def __init__(
        self, function: Callable[..., Any], structure: tuple[Any, ...], in_lanes: bool, seldom: bool
    ) -> None:
        self.function = function
        self.structure = structure
        self.in_lanes = in_lanes
        self.is_seldom_called = seldom
        self.code: Any = None  # the compiled function, or None
        self.address = 0  # its address, or 0
        self.failed = False  # whether it could not be compiled
        self.seconds_without = 0.0  # time spent in what stands in for its machine code [s]

    @cached_property
    def job(self) -> "Job":
        """The job that compiles it."""
        from rockframe.compiled.jobs import Job

        return Job(self.function, self.structure, True, self.in_lanes)

    @cached_property
    def called_back(self) -> CalledBack:
        """The Python function that machine code calls as long as this is not compiled."""
        return CalledBack(self)

    @cached_property
    def signature(self) -> Signature:
        """Its signature; functions of equal signatures share one."""
        from rockframe.compiled.jobs import signature_of

        return _shared(signature_of(self.function))


_source = cache(Source)


class Bound:
    """A function bound to a tuple: called in plain Python, or by entries as machine code.

    It may stand in for another one until it pays to compile that.
    """

    __slots__ = ("_bundle", "source", "stands_for")

    def __init__(self, source: Source, bundle: Any, stands_for: "Bound | None" = None) -> None:
        self.source = source
        self._bundle = bundle
        self.stands_for = stands_for

    def call(self, *arguments: Any) -> Any:
        """Call the function with its tuple; the last argument, the tuple's numbers, is ignored."""
        return self.source.function(self._bundle, *arguments[:-1])


def bound(
    functions: tuple[Callable[..., Any], ...],
    bundle: Any,
    *,
    seldom: bool = False,
    stands_for: Bound | None = None,
) -> tuple[Bound, ...]:
    """Bind functions to the tuple that is their first argument; `seldom` if rarely called.

    If the last element of the tuple is an array, all of them share one copy of it.
    """
    structure = structure_of(bundle)
    if isinstance(bundle, tuple) and isinstance(bundle[-1], np.ndarray):
        bundle = type(bundle)(*bundle[:-1], bundle[-1].copy())  # type: ignore[call-arg]
    return tuple(
        Bound(_source(one, structure, False, seldom), bundle, stands_for) for one in functions
    )


def bound_in_lanes(function: Callable[..., Any], bundle: Any) -> Bound:
    """Bind a function to the class of a tuple; each lane has its own numbers of it."""
    structure = structure_of(bundle)
    return Bound(_source(function, structure, True, False), tuple_from(structure))
