"""Compilation jobs: a module of a few lines for each function and structure of its arguments.

numba stores machine code beside the module that defines a function, and discards it when that
file changes. It does not look at the files of functions that are called from there: a digest of
these files is part of the name of the folder that the module is written to (`store.py`).
"""

import inspect
import logging
import sys
import sysconfig
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cache, cached_property
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Annotated, Any, Final, get_origin, get_type_hints

import numpy as np

from rockframe.compiled import store
from rockframe.compiled.buffers import BufferType, buffer_of
from rockframe.compiled.calls import (
    OPTIONS,
    CodeType,
    code_at,
    numba,
    register_inlined,
    register_kernels,
)
from rockframe.compiled.language import KERNELS, Integers, ReadOnlyMatrix, Vector, view_from
from rockframe.compiled.linking import late_linking
from rockframe.compiled.passes import raises_exceptions

VECTOR: Final = BufferType(numba.float64, 1, True)
"""Numba's type of a vector in compiled code."""
NUMBA_TYPES: Final[dict[Any, Any]] = {
    int: numba.int64,
    float: numba.float64,
    Vector: VECTOR,
    Integers: BufferType(numba.int64, 1, True),
    ReadOnlyMatrix: BufferType(numba.float64, 2, False),
    type(None): numba.void,
}
"""Numba's types of what bound functions take and give."""


class SourceWriter:
    """Writes the source by which a module makes the arguments of a function."""

    def __init__(self) -> None:
        self.types: list[Any] = []  # numba's types of the words that are passed
        self.scope: dict[str, Any] = {}  # names that the source uses
        self.comments: list[str] = []  # comments on what the source depends on but does not show

    def tuple_of(self, structure: tuple[Any, ...]) -> str:
        """Return the expression that makes a tuple of the elements of ``numbers``.

        An array, the last element of a tuple, takes the rest of them.
        """
        kind, *parts = structure
        arguments: list[str] = []
        for part in parts:
            if isinstance(part, tuple):
                arguments.append(self.tuple_of(part))
                continue
            self.types.append(part)
            if part is np.ndarray:
                arguments.append(f"{self._name(view_from)}(numbers, {len(self.types) - 1})")
                continue
            number = f"numbers[{len(self.types) - 1}]"
            arguments.append({bool: f"{number} != 0.0", int: f"int({number})"}.get(part, number))
        if kind is tuple:
            return f"({''.join(f'{part}, ' for part in arguments)})"
        return f"{self._name(kind)}({', '.join(arguments)})"

    def argument(self, structure: Any) -> str:
        """Return the expression that makes an argument from words."""
        if isinstance(structure, tuple) and isinstance(structure[0], type):
            parts = ", ".join(self.argument(part) for part in structure[1:])
            return f"{self._name(structure[0])}({parts})"
        word = f"word_{len(self.types)}"
        if isinstance(structure, str):
            self.types.append({"real": numba.float64, "integer": numba.int64}[structure])
            return word
        if structure[0] == "function":
            self.types.append(numba.int64)
            cast = f"code_{len(self.types)}"
            self.scope[cast] = code_at(structure[1].value)
            self.comments.append(f"# {cast}: {structure[1].value}\n")
            return f"{cast}({word})"
        dtype, dimensions, writeable = structure
        element = numba.from_dtype(np.dtype(dtype))
        self.types.append(numba.types.Array(element, dimensions, "C", readonly=not writeable))
        return f"buffer_of({word})"

    def _name(self, kind: Any) -> str:
        name = kind.__name__
        while self.scope.setdefault(name, kind) is not kind:
            name += "_"
        return name


class _StoreLocator:
    """Tells numba where machine code of the store is: also if it can be read only.

    numba itself keeps none in such a folder, and takes another one if its own settings name it.
    """

    def __init__(self, file: Path) -> None:
        self._file = file

    @classmethod
    def from_function(cls, _: Any, file: str) -> "_StoreLocator | None":
        """Return the locator of a module of the store, None for any other."""
        return cls(Path(file)) if store.is_module(Path(file)) else None

    def ensure_cache_path(self) -> None:
        """Do nothing: the store has made the folder."""

    def get_cache_path(self) -> str:
        """Return the folder."""
        return str(store.code_folder(self._file))

    def get_source_stamp(self) -> str:
        """Return what changes with the sources: they are in the names of the module and folder."""
        return self._file.stem

    def get_disambiguator(self) -> str:
        """Return what distinguishes functions of the same name: there is only one."""
        return "1"


_caching: Final[Any] = import_module("numba.core.caching").CompileResultCacheImpl
if hasattr(_caching, "_locator_classes"):  # not of numba's interface: without it numba looks itself
    _caching._locator_classes = [_StoreLocator, *_caching._locator_classes]
_logger = logging.getLogger("rockframe")
_warned: Final[set[str]] = set()

_SECONDS_OF_BYTE: Final = 1.7e-4
"""Time to compile a byte of Python's bytecode, of a function and all that it calls [s].

Measured with numba 0.68 for blocks on pads, coupled, and in stacks: the processor time for each of
the first jobs of a run was 0.8 to 1.3 times this estimate.
"""


def signature_of(function: Callable[..., Any]) -> Any:
    """Return numba's signature of a function to be bound to a tuple, from its annotations."""
    names = list(inspect.signature(function).parameters)[1:]
    hints = get_type_hints(function, include_extras=True)
    return _numba_type_of(hints["return"])(*(_numba_type_of(hints[name]) for name in names), VECTOR)


def _numba_type_of(hint: Any) -> Any:
    """Return numba's type of an annotation, of a named tuple by the annotations of its fields.

    A bound function is annotated with the function, ``Annotated[BoundFunction, function]``.
    """
    if hint in NUMBA_TYPES:
        return NUMBA_TYPES[hint]
    if get_origin(hint) is Annotated:
        return CodeType(signature_of(*hint.__metadata__))
    fields = get_type_hints(hint, include_extras=True)
    return numba.types.BaseTuple.from_types(
        [_numba_type_of(fields[name]) for name in hint._fields], hint
    )


@dataclass(frozen=True)
class Job:
    """A function to compile for one structure of its arguments."""

    function: Callable[..., Any]  # its source
    # of a bound function, that of its tuple, :func:`rockframe.compiled.bound.structure_of`; of an
    # entry, that of all arguments, as :class:`rockframe.compiled.entries.Entry` describes it
    structure: tuple[Any, ...]
    is_bound: bool  # whether it is a bound function
    in_lanes: bool = False  # whether it is bound to the class of a tuple, not to one tuple

    @cached_property
    def _written(self) -> tuple[str, dict[str, Any], Any]:
        """Text of the module, the names in it, and the signature of its function."""
        writer = SourceWriter()
        if self.is_bound:
            names = list(inspect.signature(self.function).parameters)[1:]
            expression = writer.tuple_of(self.structure)
            if self.in_lanes:
                text = (
                    f"@inlined\ndef system_of(numbers):\n    return {expression}\n\n\n"
                    f"def run({', '.join(names)}, numbers):\n"
                    f"    return function({', '.join(['system_of', *names])})\n"
                )
                scope = writer.scope | {"inlined": register_inlined}
                return text, scope, signature_of(self.function)
            text = (
                f"def run({', '.join(names)}, numbers):\n"
                f"    return function({', '.join([expression, *names])})\n"
            )
            return text, writer.scope, signature_of(self.function)
        arguments = ", ".join(writer.argument(part) for part in self.structure)
        words = ", ".join(f"word_{i}" for i in range(len(writer.types)))
        text = f"def run({words}):\n    return function({arguments})\n{''.join(writer.comments)}"
        returns_integer = get_type_hints(self.function)["return"] is int
        signature = (numba.int64 if returns_integer else numba.void)(*writer.types)
        return text, writer.scope | {"buffer_of": buffer_of}, signature

    @cached_property
    def file(self) -> Path | None:
        """The module's file; None where it cannot be stored."""
        text, scope, signature = self._written
        classes = [kind for kind in scope.values() if isinstance(kind, type)]
        text = f"{text}\n# {signature}\n# for {_machine()}\n"
        return store.module_file(self.function, text, classes)

    @cached_property
    def calls(self) -> set[Any]:
        """All marked functions that are compiled for it."""
        structure = self.structure if self.is_bound else ("arguments", *self.structure)
        return callees_of(self.function, classes_of_structure(structure))

    @cached_property
    def seconds(self) -> float:
        """About how long it takes to compile [s]."""
        return estimate_seconds([self])

    @property
    def is_stored(self) -> bool:
        """Whether its machine code is stored."""
        return self.file is not None and store.has_code(self.file)

    def make(self, waiting: Callable[[], bool] = lambda: True) -> Any:
        """Return the compiled function: loaded from the store, or compiled now."""
        file = self.file
        if file is not None and self.is_stored:
            try:
                return self._loaded(file)
            except Exception:  # damaged, or of another compiler: reading it may raise anything
                _warn_once(f"machine code in {file.parent} was damaged, and is compiled anew")
        register_kernels()
        if file is None:
            return self._compiled(keep=False)
        with store.lock_while_compiling(file, waiting):
            with suppress(Exception):  # another process may have stored it meanwhile
                return self._loaded(file)
            if not store.has_removed_code(file):
                return self._compiled(keep=False)
            try:
                code = self._compiled(keep=True)
                store.complete_code(file)
            except OSError as problem:  # the disk may be full
                _warn_once(
                    f"machine code cannot be kept in {file.parent} ({problem.strerror}), and is "
                    "made anew each time"
                )
                return self._compiled(keep=False)
            return code

    def _loaded(self, file: Path) -> Any:
        store.check_code(file)
        return self._compiled(keep=True)

    def _compiled(self, *, keep: bool) -> Any:
        # a bound function would print its exceptions, and go on
        for called in self.calls if self.is_bound else ():
            if raises_exceptions(called):
                msg = f"{called.__qualname__} raises an exception"
                raise numba.TypingError(msg)
        text, scope, signature = self._written
        name = self.file.stem if self.file else f"{self.function.__name__}_{len(sys.modules)}"
        module = ModuleType(name)
        module.__dict__.update(scope, function=self.function)
        sys.modules[name] = module  # where numba looks for it when it reads its store
        place = str(self.file) if self.file else f"<{name}>"
        exec(compile(text, place, "exec"), module.__dict__)  # noqa: S102
        options = {**OPTIONS, "cache": True} if keep else OPTIONS
        with late_linking(), cached_operators():
            if self.is_bound:
                return numba.cfunc(signature, **options)(module.__dict__["run"])
            return numba.njit(signature, nogil=True, **options)(module.__dict__["run"])


@cache
def _machine() -> str:
    """Return the compiler, Python and the processor that machine code is for."""
    codegen = import_module("numba.core.registry").cpu_target.target_context.codegen()
    python = sysconfig.get_config_var("SOABI")
    return f"numba {numba.__version__}, {python}, {codegen.magic_tuple()}"


def estimate_seconds(jobs: Sequence[Job]) -> float:
    """Estimate how long jobs take one after another; functions they share count once [s]."""
    functions = set[Any]().union(*(job.calls for job in jobs))
    return _SECONDS_OF_BYTE * sum(len(function.__code__.co_code) for function in functions)


@contextmanager
def cached_operators() -> Generator[None]:
    """Let numba resolve an operator on numbers of some types only once in this block.

    By default it searches all definitions of an operator, including numpy's, at each use: a twelfth
    of the time of a compilation.
    """
    kind, numbers = numba.types.Function, (numba.types.Number, numba.types.Boolean)
    resolve = kind.get_call_type
    resolved: dict[Any, Any] = {}

    def cached(operator: Any, context: Any, arguments: Any, keywords: Any) -> Any:
        if keywords or not all(isinstance(argument, numbers) for argument in arguments):
            return resolve(operator, context, arguments, keywords)
        key = operator, tuple(arguments)
        if key not in resolved:
            resolved[key] = resolve(operator, context, arguments, keywords)
        return resolved[key]

    kind.get_call_type = cached
    try:
        yield
    finally:
        del kind.get_call_type


def classes_of_structure(structure: tuple[Any, ...]) -> set[type]:
    """Return the classes of a tuple and of the tuples in it."""
    kind, *parts = structure
    classes = {kind} if isinstance(kind, type) else set[type]()
    return classes.union(*(classes_of_structure(part) for part in parts if isinstance(part, tuple)))


def callees_of(function: Any, kinds: set[type]) -> set[Any]:
    """Return a function and all marked ones it may call; methods of `kinds` by their names."""
    callees, waiting = set[Any](), [function]
    while waiting:
        caller = waiting.pop()
        if caller in callees:
            continue
        callees.add(caller)
        for name in caller.__code__.co_names:
            named = [caller.__globals__.get(name), *(getattr(kind, name, None) for kind in kinds)]
            waiting += [
                candidate
                for candidate in named
                if inspect.isfunction(candidate) and candidate in KERNELS
            ]
    return callees


def _warn_once(text: str) -> None:
    if text not in _warned:
        _warned.add(text)
        _logger.warning(text)
