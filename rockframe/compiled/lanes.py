"""Many runs side by side: one array that holds everything of all of them, field by field.

Element ``field * LANES + lane`` is a field of one lane. A loop over all lanes that reads and
writes nothing but such an array is compiled to instructions for several lanes at once.
"""

from collections.abc import Callable
from typing import Any, Final, TypeVar

from rockframe.compiled.arrays import Integers, Vector

Numbers = TypeVar("Numbers", Vector, Integers)

LANES: Final = 16
"""Lanes of a batch: two of the widest registers, four of the usual ones."""


def lane_of(room: Numbers, field: int, lane: int) -> Numbers:
    """Give the fields of one lane, from a field on; no copy."""
    fields: Numbers = room[field * LANES + lane :: LANES]
    return fields


def as_integers(array: Vector) -> Integers:
    """Give the same memory as whole numbers."""
    return array.view("int64")


def widest_registers() -> None:
    """Have the function that calls this compiled for the widest registers there are."""


def tuple_from(structure: tuple[Any, ...]) -> Callable[[Vector], Any]:
    """Give the function that makes a tuple of numbers in a vector."""

    def made(kind: Any, parts: tuple[Any, ...], numbers: Vector, first: int) -> tuple[Any, int]:
        taken: list[Any] = []
        for part in parts:
            if isinstance(part, tuple):
                value, first = made(part[0], part[1:], numbers, first)
            else:
                value, first = part(numbers[first]), first + 1
            taken.append(value)
        return (tuple(taken) if kind is tuple else kind(*taken)), first

    return lambda numbers: made(structure[0], structure[1:], numbers, 0)[0]
