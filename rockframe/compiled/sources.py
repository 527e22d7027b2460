"""What is compiled once: a function and the structure of its arguments.

All calls with arguments of this structure share its machine code.
"""

from collections.abc import Callable
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rockframe.compiled.jobs import Job


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


class CompilationUnit:
    """A function and the structure of its arguments: compiled once, or Python until that pays."""

    def __init__(
        self,
        function: Callable[..., Any],
        structure: tuple[Any, ...],
        *,
        is_bound: bool = False,
        in_lanes: bool = False,
    ) -> None:
        self.function = function
        self.structure = structure
        self.is_bound = is_bound
        self.in_lanes = in_lanes
        self.code: Any = None  # the compiled function, or None
        self.failed = False  # whether it could not be compiled
        self.fallback_seconds = 0.0  # time spent in what stands in for its machine code [s]

    @cached_property
    def job(self) -> "Job":
        """The job that compiles it."""
        from rockframe.compiled.jobs import Job

        return Job(self.function, self.structure, self.is_bound, self.in_lanes)

    def take(self, code: Any) -> None:
        """Use a compiled function from now on."""
        self.code = code


class BoundSource(CompilationUnit):
    """A function to be bound to tuples, and the structure of these."""

    def __init__(
        self,
        function: Callable[..., Any],
        structure: tuple[Any, ...],
        in_lanes: bool,
        rarely_called: bool,
    ) -> None:
        super().__init__(function, structure, is_bound=True, in_lanes=in_lanes)
        self.is_rarely_called = rarely_called
        self.address = 0  # the address of the compiled function, or 0

    def take(self, code: Any) -> None:
        """Use a compiled function from now on."""
        super().take(code)
        self.address = code.address

    @cached_property
    def signature(self) -> Signature:
        """Its signature; functions of equal signatures share one."""
        from rockframe.compiled.jobs import signature_of

        return _shared(signature_of(self.function))


bound_source = cache(BoundSource)
"""Returns the source of a function and a structure; equal ones share one."""
