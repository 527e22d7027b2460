"""Bound functions: functions whose first argument, a tuple of numbers, is fixed.

Compiled code calls a bound function by its address, whatever the class of the tuple: the last
argument is a vector of the numbers of the tuple.
"""

from collections.abc import Callable, Iterator
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, cast

import numpy as np

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


class BoundSource:
    """A function and the structure of the tuples that it is bound to: what is compiled once.

    A function that is rarely called may run as plain Python until it pays to compile it.
    """

    def __init__(
        self,
        function: Callable[..., Any],
        structure: tuple[Any, ...],
        in_lanes: bool,
        rarely_called: bool,
    ) -> None:
        self.function = function
        self.structure = structure
        self.in_lanes = in_lanes
        self.is_rarely_called = rarely_called
        self.code: Any = None  # the compiled function, or None
        self.address = 0  # its address, or 0
        self.failed = False  # whether it could not be compiled
        self.fallback_seconds = 0.0  # time spent in what stands in for its machine code [s]

    @cached_property
    def job(self) -> "Job":
        """The job that compiles it."""
        from rockframe.compiled.jobs import Job

        return Job(self.function, self.structure, True, self.in_lanes)

    @cached_property
    def signature(self) -> Signature:
        """Its signature; functions of equal signatures share one."""
        from rockframe.compiled.jobs import signature_of

        return _shared(signature_of(self.function))


_bound_source = cache(BoundSource)


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
        """Call the function with its tuple; the last argument, the tuple's numbers, is ignored."""
        return self.source.function(self._bundle, *arguments[:-1])


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
        BoundFunction(
            _bound_source(function, structure, False, rarely_called), bundle, fallback_for
        )
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
    return BoundFunction(_bound_source(function, structure, True, False), tuple_from(structure))
