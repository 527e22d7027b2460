"""Functions that Python calls and that run as machine code where numba is installed."""

import ctypes
import os
from collections.abc import Callable, Iterator, Sequence
from functools import update_wrapper
from importlib.util import find_spec
from typing import Any, Final, cast

from rockframe.compiled.arrays import ARRAY_KINDS
from rockframe.compiled.machine_code import load
from rockframe.compiled.registry import CALLBACKS, Function, Signature, field_kinds, name_of

COMPILED: Final = os.environ.get("ROCKFRAME_COMPILE", "1") != "0" and find_spec("numba") is not None
"""Whether the kernels are compiled."""

_SCALARS: Final = {"real": ctypes.c_double, "integer": ctypes.c_int64, "none": None}


def entry(result: str, *arguments: str | Signature | type) -> Callable[[Function], Function]:
    """Compile a function called from Python, with all its types fixed beforehand.

    Parameters
    ----------
    result : str
        Type of the result.
    *arguments : str, Signature or type
        Types of the arguments; a signature stands for a callback, a class for a
        named tuple whose fields are annotated with the types of
        :mod:`rockframe.compiled.arrays`.
    """

    def make_entry(function: Function) -> Function:
        return cast("Function", Entry(function, result, arguments)) if COMPILED else function

    return make_entry


class Entry:
    """A compiled function, with arguments checked before their addresses are handed over.

    Parameters
    ----------
    function : callable
        Its source.
    result, arguments
        As in :func:`entry`.
    """

    def __init__(
        self,
        function: Callable[..., Any],
        result: str,
        arguments: tuple[str | Signature | type, ...],
    ) -> None:
        self._result = result
        self._arguments = arguments
        self._kinds: tuple[str | Signature | tuple[str, ...], ...] = ()
        self._routine: Callable[..., Any] | None = None
        self._function = function
        update_wrapper(self, function)

    def __call__(self, *arguments: Any) -> Any:
        """Run the machine code.

        Raises
        ------
        TypeError
            An array is of another type than the code was made for.
        """
        routine = self._routine or self._prepare()
        words: list[Any] = []
        for kind, argument in zip(self._kinds, arguments, strict=True):
            if isinstance(kind, str):
                words += self._words(kind, argument)
            elif isinstance(kind, Signature):
                words.append(address_of(argument, kind))
            else:
                for field, value in zip(kind, argument, strict=True):
                    words += self._words(field, value)
        return routine(*words)

    def _prepare(self) -> Callable[..., Any]:
        function, result, arguments = self._function, self._result, self._arguments

        def translate() -> bytes:
            from rockframe.compiled.translation import translate_entry

            return translate_entry(function, result, arguments)

        self._kinds = tuple(
            field_kinds(argument) if isinstance(argument, type) else argument
            for argument in arguments
        )
        prototype = ctypes.CFUNCTYPE(_SCALARS[result], *_word_types(self._kinds))
        self._routine = prototype(load(function, translate))
        return self._routine

    def _words(self, name: str, value: Any) -> Sequence[Any]:
        kind = ARRAY_KINDS.get(name)
        if kind is None:
            return (value,)
        flags = value.flags
        if (
            value.dtype != kind.dtype
            or value.ndim != kind.dimensions
            or not flags.c_contiguous
            or not (flags.writeable or kind.read_only)
        ):
            msg = (
                f"{name_of(self._function)} needs a {name}: {kind.dimensions} dimensions of "
                f"{kind.dtype} in C order{'' if kind.read_only else ', writeable'}; got "
                f"{value.ndim} of {value.dtype}, {'' if flags.c_contiguous else 'not '}in C "
                f"order, {'' if flags.writeable else 'not '}writeable"
            )
            raise TypeError(msg)
        return (value.ctypes.data, *value.shape)


def address_of(function: Callable[..., Any], signature: Signature) -> int:
    """Give the address of a callback's machine code.

    Raises
    ------
    TypeError
        The function is no callback of this signature.
    """
    if CALLBACKS.get(function) != signature:
        msg = f"{name_of(function)} is no callback of the signature {signature}"
        raise TypeError(msg)

    def translate() -> bytes:
        from rockframe.compiled.translation import translate_callback

        return translate_callback(function, signature)

    return load(function, translate)


def _word_types(kinds: Sequence[str | Signature | tuple[str, ...]]) -> Iterator[Any]:
    for kind in kinds:
        if isinstance(kind, tuple):
            yield from _word_types(kind)
        elif isinstance(kind, Signature):
            yield ctypes.c_void_p
        elif kind in ARRAY_KINDS:
            yield ctypes.c_void_p
            yield from [ctypes.c_int64] * ARRAY_KINDS[kind].dimensions
        else:
            yield _SCALARS[kind]
