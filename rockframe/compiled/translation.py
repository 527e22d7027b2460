"""From Python functions to machine code: numba translates, LLVM assembles.

Imported only when some code is not on disk yet. The code that is made refers to
nothing in this process but functions of the C library, so that another process can
use it without numba.
"""

import re
from collections.abc import Callable, Iterator
from importlib import import_module
from typing import Any, Final

from rockframe.compiled.arrays import ARRAY_KINDS
from rockframe.compiled.machine_code import SYMBOL, target_machine
from rockframe.compiled.registry import KERNELS, Signature, field_kinds

# Their own annotations know neither all options nor types that are computed.
llvm: Final[Any] = import_module("llvmlite.binding")
numba: Final[Any] = import_module("numba")

# The kernels allocate nothing: without numba's reference counting, taking an
# array out of a tuple costs nothing (it was a quarter of the run time).
_OPTIONS: Final = {"error_model": "numpy", "_nrt": False}
# Helpers are called by compiled code alone: without the wrappers for other callers
# all is compiled in two thirds of the time.
_HELPER_OPTIONS: Final = _OPTIONS | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}

_SCALARS: Final[dict[str, Any]] = {
    "none": numba.void,
    "real": numba.float64,
    "integer": numba.int64,
}

# numba's types hold them by weak references
_dispatchers: Final[dict[Callable[..., Any], Any]] = {}

_LONG_NAME: Final = re.compile(r"[\w.$-]{200,}")
"""Names with types in them: LLVM cuts those of more than 1024 characters when it reads them."""

_REPORTING: Final = re.compile(r"^declare (.*@(?:Py|_Py|numba_|NRT_).*)$", re.MULTILINE)
"""A function by which numba reports exceptions."""

_INSIDE: Final = re.compile(r"inttoptr \(i64 \d{5,}")
"""An address in this process."""


def translate_callback(function: Callable[..., Any], signature: Signature) -> bytes:
    """Compile a function to machine code that takes its arrays by value.

    Parameters
    ----------
    function : callable
        Its source.
    signature : Signature
        Its types.

    Returns
    -------
    bytes
        An object file that defines the function as ``SYMBOL``.
    """
    _prepare_kernels()
    compiled = numba.cfunc(_callback_type(signature), **_OPTIONS)(function)
    return _object_code(compiled)


def translate_entry(
    function: Callable[..., Any], result: str, arguments: tuple[str | Signature | type, ...]
) -> bytes:
    """Compile a function to machine code that takes addresses and plain numbers.

    Parameters
    ----------
    function : callable
        Its source.
    result, arguments
        Its types, as in :func:`rockframe.compiled.entries.entry`.

    Returns
    -------
    bytes
        An object file that defines the function as ``SYMBOL``.
    """
    _prepare_kernels()
    words = _Words()
    tuples = {f"tuple_{i}": kind for i, kind in enumerate(arguments) if isinstance(kind, type)}
    taken = ", ".join(words.take(f"tuple_{i}", kind) for i, kind in enumerate(arguments))
    source = f"def routine({', '.join(words.names)}):\n    return function({taken})\n"
    scope: dict[str, Any] = {
        "function": numba.njit(**_HELPER_OPTIONS)(function),
        "carray": numba.carray,
    }
    made: dict[str, Any] = {}
    exec(source, scope | tuples, made)  # noqa: S102
    compiled = numba.cfunc(_SCALARS[result](*words.types), error_model="numpy")(made["routine"])
    return _object_code(compiled)


class _Words:
    """Arguments of a routine, and the expressions that make a function's arguments of them."""

    def __init__(self) -> None:
        self.names: list[str] = []
        self.types: list[Any] = []

    def take(self, tuple_name: str, kind: str | Signature | type) -> str:
        """Add the words of an argument; give the expression that puts it together."""
        if isinstance(kind, type):
            fields = ", ".join(self.take("", field) for field in field_kinds(kind))
            return f"{tuple_name}({fields})"
        if isinstance(kind, Signature):
            return self._word(_pointer_type(kind))
        if kind not in ARRAY_KINDS:
            return self._word(_SCALARS[kind])
        array = ARRAY_KINDS[kind]
        address = self._word(numba.types.CPointer(numba.from_dtype(array.dtype)))
        shape = [self._word(numba.int64) for _ in range(array.dimensions)]
        return f"carray({address}, ({', '.join(shape)},))"

    def _word(self, numba_type: Any) -> str:
        self.names.append(f"word_{len(self.names)}")
        self.types.append(numba_type)
        return self.names[-1]


def _array_type(kind: str) -> Any:
    array = ARRAY_KINDS[kind]
    return numba.types.Array(numba.from_dtype(array.dtype), array.dimensions, "C")


def _callback_type(signature: Signature) -> Any:
    arguments = (_SCALARS.get(kind) or _array_type(kind) for kind in signature.arguments)
    return _SCALARS[signature.result](*arguments)


def _pointer_type(signature: Signature) -> Any:
    return numba.types.ExternalFunctionPointer(_callback_type(signature), _no_pointer)


def _no_pointer(_: object) -> int:
    raise TypeError  # numba asks for it when a pointer comes as a Python object; none does


def _prepare_kernels() -> None:
    """Let numba compile the helper functions that it meets."""
    for function, into_caller in KERNELS.items():
        if function not in _dispatchers:
            dispatcher = numba.njit(**_HELPER_OPTIONS, forceinline=into_caller)(function)
            _dispatchers[function] = dispatcher
            # numba asks objects that it does not know by this attribute for their type
            function._numba_type_ = dispatcher._numba_type_  # type: ignore[attr-defined]


def _object_code(compiled: Any) -> bytes:
    """Assemble what numba made of a function, without what only numba itself could use."""
    short: dict[str, str] = {}
    text = _LONG_NAME.sub(
        lambda match: short.setdefault(match[0], f"long_name_{len(short)}"),
        compiled.inspect_llvm().replace(compiled.native_name, SYMBOL),
    )
    # the kernels raise nothing: what would report an exception is out of reach
    text = _REPORTING.sub(r"define \1 { call void @llvm.trap() unreachable }", text)
    module = llvm.parse_assembly(text + "\ndeclare void @llvm.trap()\n")
    module.verify()
    for defined in _definitions(module):
        if defined.name != SYMBOL:
            defined.linkage = "internal"
    machine = target_machine()
    builder = llvm.create_pass_builder(machine, llvm.PipelineTuningOptions(speed_level=3))
    builder.getModulePassManager().run(module, builder)
    left = str(module)
    if "@llvm.trap" in left or _INSIDE.search(left):
        msg = "it can raise an exception, or its code refers to objects of this process"
        raise RuntimeError(msg)
    return machine.emit_object(module)


def _definitions(module: Any) -> Iterator[Any]:
    for item in (*module.functions, *module.global_variables):
        if not item.is_declaration:
            yield item
