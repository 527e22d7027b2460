"""Making marked functions known to numba, by its documented extension interface.

Imported only where numba is.
"""

import inspect
from collections.abc import Callable
from importlib import import_module
from typing import Any, Final

from rockframe.compiled.marks import KERNELS, METHODS, is_method
from rockframe.compiled.sources import fields_of_package

# numba's own annotations are partial
numba: Final[Any] = import_module("numba")
extending: Final[Any] = import_module("numba.extending")

OPTIONS: Final = {"error_model": "numpy"}
HELPER: Final = OPTIONS | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""Division by zero gives infinities and NaN, as numpy's, and is not checked for."""

_known: Final[set[Any]] = set()
"""Functions, and names of methods, that numba has been told of."""


def register_kernels() -> None:
    """Make all functions, and all names of methods, known that were marked since the last time."""
    methods = method_names()
    for function, into_caller in list(KERNELS.items()):
        key = function.__name__ if is_method(function) else function
        if key in _known or (is_method(function) and key not in methods):
            continue
        _known.add(key)
        options = {**HELPER, "forceinline": into_caller}
        if is_method(function):
            _register_method(function.__name__, METHODS[function.__name__], options)
        else:
            extending.register_jitable(**options)(function)


def register_inlined(function: Callable[..., Any]) -> Callable[..., Any]:
    """Make one more function known, which is compiled into its callers."""
    registered: Callable[..., Any] = extending.register_jitable(**HELPER, forceinline=True)(
        function
    )
    return registered


def method_names() -> set[str]:
    """Give the names of methods that numba is told of.

    Those from outside the package give way to the fields of its named tuples, which numba
    would take for them; see :func:`clashes_of`.
    """
    own = {function.__name__ for function in KERNELS if _is_own(function.__module__)}
    foreign = METHODS.keys() - own
    return (METHODS.keys() & own) | (foreign - fields_of_package() if foreign else set())


def clashes_of(kind: Any) -> set[str]:
    """Give the names of a class of named tuples that numba would take for something else.

    Parameters
    ----------
    kind : type
        Of named tuples.

    Returns
    -------
    set of str
        Fields that are called like a method, and methods like a field of the package.
    """
    known, fields = method_names(), set(kind._fields)
    methods = {name for name in METHODS if name not in fields and hasattr(kind, name)}
    return (known & fields) | (methods - known)


def _is_own(module: str) -> bool:
    return module.partition(".")[0] == __name__.partition(".")[0]


def _register_method(name: str, count: int, options: dict[str, Any]) -> None:
    registered = extending.overload_method(
        numba.types.BaseNamedTuple, name, strict=False, jit_options=options
    )
    registered(_chooser(name, count))


def _chooser(name: str, count: int) -> Callable[..., Any]:
    """Give the function by which numba finds the method of an object's class.

    numba asks it with as many arguments as the method takes, and reads their number from
    its signature.
    """

    def choose(self: Any, *_: Any) -> Callable[..., Any] | None:
        return getattr(self.instance_class, name, None)

    names = ["self", *(f"argument_{i}" for i in range(1, count))]
    either = inspect.Parameter.POSITIONAL_OR_KEYWORD
    arguments = [inspect.Parameter(name, either) for name in names]
    choose.__signature__ = inspect.Signature(arguments)  # type: ignore[attr-defined]
    return choose
