"""Late linking: functions that only compiled code calls are optimised once, within their entry.

By default numba optimises each function together with all that it calls and makes machine code of
it, although only that of the entry is ever run. Here a library of numba stays unoptimised until an
address in it is needed, or code outside of rockframe links it; it is then linked with all that it
calls and optimised as a whole. The operations and their order stay the same, and with them each bit
of each result.

numba does not document this: an untested version of it compiles in its ordinary way.
"""

from collections.abc import Generator
from contextlib import contextmanager
from importlib import import_module
from typing import Any, Final

from rockframe.compiled.calls import numba

TESTED: Final = ((0, 61), (0, 68))
"""First and last version of numba that this was tested with."""

_codegen: Final[Any] = import_module("numba.core.codegen")
_registry: Final[Any] = import_module("numba.core.registry")
_lock: Final[Any] = import_module("numba.core.compiler_lock").global_compiler_lock

IS_SUPPORTED: Final[bool] = TESTED[0] <= tuple(numba.version_info[:2]) <= TESTED[1] and all(
    hasattr(_codegen.JITCodeLibrary, name)
    for name in (
        "add_linking_library", "finalize", "get_pointer_to_function", "codegen",
        "_get_module_for_linking", "_optimize_functions", "_optimize_final_module",
    )
)  # fmt: skip
"""Whether this version of numba allows late linking."""


class _LateLibrary(_codegen.JITCodeLibrary):
    """A library of numba that is linked and optimised when an address in it is needed."""

    def __init__(self, *arguments: Any, **words: Any) -> None:
        super().__init__(*arguments, **words)
        self._environments: list[tuple[str, Any]] = []

    @property
    def codegen(self) -> Any:
        """The object that stores environments of functions: this one until it is linked."""
        return self._codegen if self._finalized else self

    def set_env(self, name: str, environment: Any) -> None:
        """Keep the environment of a function until the library is linked."""
        self._environments.append((name, environment))

    def add_linking_library(self, library: Any) -> None:
        """Link a library, whatever its state."""
        if isinstance(library, _LateLibrary):
            self._linking_libraries.append(library)
        else:
            super().add_linking_library(library)

    def get_pointer_to_function(self, name: str) -> int:
        """Return the address of a function; 0 where this library has none of that name."""
        if not self._finalized and not any(
            name == function.name and not function.is_declaration
            for function in self._final_module.functions
        ):
            return 0
        address: int = super().get_pointer_to_function(name)
        return address

    def finalize(self) -> None:
        """Link the library from its own code and all that it calls."""
        self._linking_libraries = _callers_first(self)
        super().finalize()
        self._shared_module = None  # the code as it was before linking
        for library in (self, *self._linking_libraries):
            for name, environment in getattr(library, "_environments", ()):
                if self._codegen._engine.is_symbol_defined(name):
                    self._codegen.set_env(name, environment)

    def _optimize_functions(self, module: Any) -> None:
        """Leave functions unoptimised: they are optimised together with their callers."""
        module.data_layout = self._codegen._data_layout

    def _optimize_final_module(self) -> None:
        """Optimise once; numba does so twice, to remove reference counting that is not needed."""
        created = self._codegen._module_pass_manager()
        passes, *words = (
            created if isinstance(created, tuple) else (created,)
        )  # older numbas give one alone
        passes.run(self._final_module, *words)

    def _get_module_for_linking(self) -> Any:
        if self._finalized:
            return super()._get_module_for_linking()
        if self._shared_module is None:
            self._shared_module = self._final_module.clone()
            for function in self._shared_module.functions:
                if not function.is_declaration and function.linkage.name == "external":
                    function.linkage = "linkonce_odr"
        return self._shared_module


def _callers_first(library: Any) -> list[Any]:
    """Return all libraries that a library calls, callers before what they call."""
    seen: set[Any] = set()
    ordered: list[Any] = []

    def visit(caller: Any) -> None:
        for called in caller._linking_libraries:
            if called not in seen:
                seen.add(called)
                if not called._finalized:
                    visit(called)
                ordered.append(called)

    visit(library)
    return ordered[::-1]


@contextmanager
def late_linking() -> Generator[None]:
    """Let numba make libraries that are linked late in this block; it holds numba's lock."""
    if not IS_SUPPORTED:
        yield
        return
    with _lock:
        codegen = _registry.cpu_target.target_context.codegen()
        before = codegen._library_class
        codegen._library_class = _LateLibrary
        try:
            yield
        finally:
            codegen._library_class = before
