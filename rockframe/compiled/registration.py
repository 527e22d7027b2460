"""Making marked functions known to numba, by its documented extension interface.

Imported only where numba is.
"""

from collections.abc import Callable
from importlib import import_module
from typing import Any, Final

from rockframe.compiled.decorators import KERNELS, is_method

# numba's own annotations are partial
numba: Final[Any] = import_module("numba")
extending: Final[Any] = import_module("numba.extending")
templates: Final[Any] = import_module("numba.core.typing.templates")

OPTIONS: Final = {"error_model": "numpy"}
HELPER: Final = OPTIONS | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""Division by zero gives infinities and NaN, as numpy's, and is not checked for."""

_known: Final[set[Callable[..., Any]]] = set()
"""Functions and methods that numba has been told of."""
_ANYTHING: Final = numba.types.VarArg(numba.types.Any)
_methods: Final[dict[Callable[..., Any], Any]] = {}
"""How numba finds the types of a method's call."""


def register_kernels() -> None:
    """Make all functions and methods known that were marked since the last time."""
    for function, into_caller in list(KERNELS.items()):
        if function not in _known:
            _known.add(function)
            extending.register_jitable(**HELPER, forceinline=into_caller)(function)
            if is_method(function):
                _register_method(function)


def register_inlined(function: Callable[..., Any]) -> Callable[..., Any]:
    """Make one more function known, which is compiled into its callers."""
    registered: Callable[..., Any] = extending.register_jitable(**HELPER, forceinline=True)(
        function
    )
    return registered


def _register_method(function: Callable[..., Any]) -> None:
    """Let numba call a method as the function that it is, its object the first argument."""
    name = f"{function.__module__}.{function.__qualname__}"

    class Call(templates.AbstractTemplate):
        key = (name, function)

        def generic(self, arguments: Any, keywords: Any) -> Any:
            kind = self.context.resolve_value_type(function)
            found = kind.get_call_type(self.context, (self.this, *arguments), keywords)
            return found and found.as_method()

    @extending.lower_builtin(Call.key, numba.types.BaseNamedTuple, _ANYTHING)
    def call(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        kind = context.typing_context.resolve_value_type(function)
        found = kind.get_call_type(context.typing_context, signature.args, {})
        code = context.get_function(kind, found)
        context.add_linking_libs(getattr(code, "libs", ()))
        return code(builder, values)

    _methods[function] = Call


@templates.infer_getattr
class _MethodsOfTuples(templates.AttributeTemplate):
    """Methods of a named tuple are those of its class; its fields come first."""

    key = numba.types.BaseNamedTuple

    def generic_resolve(self, kind: Any, name: str) -> Any:
        found = None if name in kind.fields else getattr(kind.instance_class, name, None)
        call = _methods.get(found) if callable(found) else None
        return call and numba.types.BoundFunction(call, kind)
