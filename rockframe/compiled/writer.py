"""How arguments of compiled functions are put together from words, as source text."""

from typing import Any, Final

import numpy as np

from rockframe.compiled.arrays import Integers, ReadOnlyMatrix, Vector
from rockframe.compiled.buffers import BufferType
from rockframe.compiled.calls import code_at
from rockframe.compiled.registration import numba
from rockframe.compiled.tuples import part_of

VECTOR: Final = BufferType(numba.float64, 1, True)
"""Numba's type of a vector in compiled code."""
KINDS: Final[dict[Any, Any]] = {
    int: numba.int64,
    float: numba.float64,
    Vector: VECTOR,
    Integers: BufferType(numba.int64, 1, True),
    ReadOnlyMatrix: BufferType(numba.float64, 2, False),
    type(None): numba.void,
}
"""Numba's types of what bound functions take and give."""


class Writer:
    """Writes how arguments are put together, and what that needs."""

    def __init__(self) -> None:
        self.kinds: list[Any] = []
        self.scope: dict[str, Any] = {}
        self.notes: list[str] = []  # what the text depends on and does not show

    def tuple_of(self, structure: tuple[Any, ...]) -> str:
        """Give the expression that makes a tuple of the elements of ``numbers``.

        An array takes all that are left.
        """
        kind, *parts = structure
        taken: list[str] = []
        for part in parts:
            if isinstance(part, tuple):
                taken.append(self.tuple_of(part))
                continue
            self.kinds.append(part)
            if part is np.ndarray:
                taken.append(f"{self._name(part_of)}(numbers, {len(self.kinds) - 1})")
                continue
            number = f"numbers[{len(self.kinds) - 1}]"
            taken.append({bool: f"{number} != 0.0", int: f"int({number})"}.get(part, number))
        if kind is tuple:
            return f"({''.join(f'{part}, ' for part in taken)})"
        return f"{self._name(kind)}({', '.join(taken)})"

    def argument(self, structure: Any) -> str:
        """Give the expression of an argument of words."""
        if isinstance(structure, tuple) and isinstance(structure[0], type):
            parts = ", ".join(self.argument(part) for part in structure[1:])
            return f"{self._name(structure[0])}({parts})"
        word = f"word_{len(self.kinds)}"
        if isinstance(structure, str):
            self.kinds.append({"real": numba.float64, "integer": numba.int64}[structure])
            return word
        if structure[0] == "function":
            self.kinds.append(numba.int64)
            cast = f"code_{len(self.kinds)}"
            self.scope[cast] = code_at(structure[1].value)
            self.notes.append(f"# {cast}: {structure[1].value}\n")
            return f"{cast}({word})"
        dtype, dimensions, writeable = structure
        element = numba.from_dtype(np.dtype(dtype))
        self.kinds.append(numba.types.Array(element, dimensions, "C", readonly=not writeable))
        return f"buffer_of({word})"

    def _name(self, kind: Any) -> str:
        name = kind.__name__
        while self.scope.setdefault(name, kind) is not kind:
            name += "_"
        return name
