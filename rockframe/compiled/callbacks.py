"""Calls of machine code from plain Python, and of Python from machine code.

Functions that are called at events only, and the loops around those that steps call, may take half
of the time of compilation, but a small part of the time of a run. As long as it does not pay to
compile them, they run as Python: machine code calls them like any bound function, by an address,
and they call machine code so. A buffer is passed as its address and its lengths, a tuple as its
elements.
"""

import ctypes
import inspect
import threading
from collections.abc import Callable
from functools import cache
from time import perf_counter
from typing import Annotated, Any, Final, get_origin, get_type_hints

from rockframe.compiled.language import (
    AFTER_CALL,
    PYTHON_SECONDS,
    Integers,
    ReadOnlyMatrix,
    Vector,
    tuple_from,
)
from rockframe.compiled.sources import BoundSource

_WORD: Final = ctypes.c_int64
_NUMBERS: Final[dict[Any, Any]] = {int: _WORD, float: ctypes.c_double, type(None): None}
"""C types of numbers, and of no result."""
_BUFFERS: Final[dict[Any, tuple[Any, str, int]]] = {
    Vector: (ctypes.c_double, "d", 1),
    Integers: (_WORD, "q", 1),
    ReadOnlyMatrix: (ctypes.c_double, "d", 2),
}
"""C type of the elements of buffers, its format character, and the number of dimensions."""


class _Raised(threading.local):
    """The first exception of a function that machine code called back in this thread."""

    first: BaseException | None = None


_raised: Final = _Raised()


class PythonCallback:
    """A bound function that runs as plain Python and has an address for machine code to call."""

    def __init__(self, source: BoundSource) -> None:
        make_tuple = tuple_from(source.structure)
        types = _argument_types(source)

        def callback(*words: Any) -> Any:
            started = perf_counter()
            try:
                *arguments, numbers = _arguments(types, words)
                return source.function(make_tuple(numbers), *arguments)
            except BaseException as raised:  # machine code knows no exceptions: raised after it
                _raised.first = _raised.first or raised
                return 0
            finally:
                seconds = perf_counter() - started
                source.fallback_seconds += seconds
                PYTHON_SECONDS[0] += seconds
                AFTER_CALL.get()()

        self._c_function = c_signature(source)(callback)
        self.address = ctypes.cast(self._c_function, ctypes.c_void_p).value or 0


python_callback = cache(PythonCallback)
"""The Python function that machine code calls as long as a bound function is not compiled."""


def _arguments(types: list[Any], words: tuple[Any, ...]) -> list[Any]:
    """Return the arguments of a call from the words passed; arrays are memory views."""
    arguments: list[Any] = []
    place = 0
    for type_ in types:
        if type_ in _NUMBERS:
            arguments.append(words[place])
            place += 1
            continue
        element, letter, dimensions = _BUFFERS[type_]
        address, *lengths = words[place : place + 1 + dimensions]
        place += 1 + dimensions
        count = lengths[0] if dimensions == 1 else lengths[0] * lengths[1]
        memory: Any = memoryview((element * count).from_address(address)).cast("B")
        arguments.append(memory.cast(letter) if dimensions == 1 else memory.cast(letter, lengths))
    return arguments


def _argument_types(source: BoundSource) -> list[Any]:
    """Return the annotations of what a bound function is called with."""
    hints = get_type_hints(source.function, include_extras=True)
    names = [*inspect.signature(source.function).parameters][1:]
    return [*(hints[name] for name in names), Vector]


def c_signature(source: BoundSource) -> Any:
    """Return the C type of a bound function."""
    words = [word for type_ in _argument_types(source) for word in _words_of_type(type_)]
    return ctypes.CFUNCTYPE(_NUMBERS[get_type_hints(source.function)["return"]], *words)


def _words_of_type(type_: Any) -> list[Any]:
    """Return the C types of the words that pass an argument."""
    if type_ in _NUMBERS:
        return [_NUMBERS[type_]]
    if type_ in _BUFFERS:
        return [_WORD] * (1 + _BUFFERS[type_][2])
    if get_origin(type_) is Annotated:  # a bound function
        return [_WORD]
    hints = get_type_hints(type_, include_extras=True)
    return [word for name in type_._fields for word in _words_of_type(hints[name])]


def call_machine_code(source: BoundSource, words: list[Any]) -> Any:
    """Call a bound function that is compiled, from plain Python, with the words to pass."""
    return run_and_raise(_machine_code(source, source.address), words)


@cache
def _machine_code(source: BoundSource, address: int) -> Callable[..., Any]:
    return c_signature(source)(address)


def run_and_raise(routine: Callable[..., Any], words: list[Any]) -> Any:
    """Run machine code, then raise the first exception of a function that it called back."""
    before, _raised.first = _raised.first, None
    result = routine(*words)
    raised, _raised.first = _raised.first, before
    if raised is not None:
        raise raised
    return result
