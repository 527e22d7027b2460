"""Python functions that machine code calls back, as long as it does not pay to compile them.

Functions that are called at events only may take half of the time of compilation, but a thousandth
of the time of a run. Compiled code calls them like any bound function, by an address; a buffer is
passed as its address and its lengths.
"""

import ctypes
import inspect
import threading
from collections.abc import Callable
from functools import cache
from time import perf_counter
from typing import Any, Final, get_type_hints

from rockframe.compiled.bound import BoundSource
from rockframe.compiled.language import Integers, ReadOnlyMatrix, Vector, tuple_from

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
        hints = get_type_hints(source.function, include_extras=True)
        names = [*inspect.signature(source.function).parameters][1:]
        types = [*(hints[name] for name in names), Vector]
        words: list[Any] = []
        for kind in types:
            words += [_NUMBERS[kind]] if kind in _NUMBERS else [_WORD] * (1 + _BUFFERS[kind][2])

        def callback(*words: Any) -> Any:
            started = perf_counter()
            try:
                *arguments, numbers = _arguments(types, words)
                return source.function(make_tuple(numbers), *arguments)
            except BaseException as raised:  # machine code knows no exceptions: raised after it
                _raised.first = _raised.first or raised
                return 0
            finally:
                source.fallback_seconds += perf_counter() - started

        self._c_function = ctypes.CFUNCTYPE(_NUMBERS[hints["return"]], *words)(callback)
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


def run_and_raise(routine: Callable[..., Any], words: list[Any]) -> Any:
    """Run machine code, then raise the first exception of a function that it called back."""
    _raised.first = None
    result = routine(*words)
    raised, _raised.first = _raised.first, None
    if raised is not None:
        raise raised
    return result
