"""Tuples of numbers, of any length, in compiled code as in Python."""

from rockframe.compiled.arrays import Vector


def constant(value: float, like: tuple[float, ...]) -> tuple[float, ...]:
    """Give a tuple as long as another one, of one number."""
    return (value,) * len(like)


def put(numbers: tuple[float, ...], first: int, out: Vector) -> None:
    """Write a tuple into an array, from an index on."""
    for i, number in enumerate(numbers):
        out[first + i] = number


def some_negative(numbers: tuple[float, ...]) -> bool:
    """Whether some number is below zero."""
    return any(number < 0.0 for number in numbers)


def some_reversed(before: Vector, first: int, now: tuple[float, ...]) -> bool:
    """Whether some number was below zero, in an array from an index on, and now is above."""
    return any(before[first + i] < 0.0 < number for i, number in enumerate(now))


def part_of(array: Vector, first: int) -> Vector:
    """Give an array from an index on; no copy."""
    return array[first:]
