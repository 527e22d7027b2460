"""Tuples of numbers, of any length, in compiled code as in Python."""

from typing import Any, TypeVar

from numpy.typing import NDArray

from rockframe.compiled.arrays import Vector

Array = TypeVar("Array", bound=NDArray[Any])
Bundle = TypeVar("Bundle")


def constant(value: float, like: tuple[float, ...]) -> tuple[float, ...]:
    """Give a tuple as long as another one, of one number."""
    return (value,) * len(like)


def put(numbers: tuple[float, ...] | Vector, first: int, out: Vector) -> None:
    """Write a tuple, or an array, into an array, from an index on."""
    for i, number in enumerate(numbers):
        out[first + i] = number


def with_numbers(
    numbers: tuple[float, ...], first: int, others: tuple[float, ...]
) -> tuple[float, ...]:
    """Give a tuple with others in place of some of its numbers, from an index on."""
    return (*numbers[:first], *others, *numbers[first + len(others) :])


def filled(like: Bundle, numbers: Vector) -> Bundle:
    """Give a named tuple of the class of another one, filled with numbers from an array."""
    kind: Any = type(like)
    return kind(*numbers[: len(kind._fields)])


def part_of(array: Vector, first: int) -> Vector:
    """Give an array from an index on; no copy."""
    return array[first:]


def stretch(array: Array, first: int, count: int) -> Array:
    """Give some elements of an array, or rows of a matrix, from an index on; no copy."""
    some: Any = array[first : first + count]
    return some
