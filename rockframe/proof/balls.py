"""Balls of real numbers, by python-flint: the arithmetic of proofs.

A ball is an interval given by its middle and its radius. The result of an operation on balls
contains every result of the operation on numbers inside them. A comparison of balls is true only
if it is true for all numbers inside them.
"""

from collections.abc import Generator, Sequence
from contextlib import contextmanager
from operator import mul
from threading import RLock
from typing import Any, Final, TypeAlias

from flint import arb, ctx

Ball: TypeAlias = Any
"""A real number within an interval, ``flint.arb``."""
Row: TypeAlias = list[Ball]
Matrix: TypeAlias = list[Row]

ball: Final[Any] = arb
"""Makes the ball of a number, of a float exactly; a second number is its radius, else 0."""
ZERO: Final[Ball] = arb(0)
ONE: Final[Ball] = arb(1)
UNIT: Final[Ball] = ZERO.union(ONE)
"""All numbers from 0 to 1."""
WITHIN_ONE: Final[Ball] = arb(0, 1)


_precision_lock: Final = RLock()


@contextmanager
def working_precision(bits: int) -> Generator[None]:
    """Set how many bits the middles of balls have in this block, which one thread runs at a time.

    python-flint has one precision for all threads.
    """
    with _precision_lock, ctx.workprec(bits):
        yield


def bits() -> int:
    """Return the present number of bits of the middles."""
    return ctx.prec


def magnitude(value: Ball) -> Ball:
    """Return the largest absolute value in a ball, rounded up, as an exact ball."""
    return arb(value.abs_upper())


def dot(left: Sequence[Ball], right: Sequence[Ball]) -> Ball:
    """Return the sum of products of two rows, up to the end of the shorter one."""
    return sum(map(mul, left, right), ZERO)


def cauchy_product(left: Row, right: Row, order: int) -> Ball:
    """Return the coefficient of some order in the product of two power series."""
    return sum(map(mul, left, right[order::-1]), ZERO)


def polynomial_value(coefficients: Row, at: Ball) -> Ball:
    """Evaluate a polynomial, lowest power first."""
    result: Ball = 0
    for coefficient in reversed(coefficients):
        result = result * at + coefficient
    return result


def derivative_of(coefficients: Row) -> Row:
    """Return the derivative of a polynomial."""
    return [coefficient * power for power, coefficient in enumerate(coefficients)][1:]


def taylor_shift(coefficients: Row, shift: Ball) -> Row:
    """Return a polynomial about another point: its Taylor coefficients there."""
    if len(coefficients) == 2:
        return [coefficients[0] + coefficients[1] * shift, coefficients[1]]
    row = list(coefficients)
    for start in range(len(row) - 1):
        for power in range(len(row) - 2, start - 1, -1):
            row[power] = row[power] + shift * row[power + 1]
    return row


def hull(balls: Row) -> Ball:
    """Return a ball that contains others."""
    result = balls[0]
    for part in balls[1:]:
        result = result.union(part)
    return result


def matrix_product(left: Matrix, right: Matrix) -> Matrix:
    """Multiply two matrices."""
    columns = list(zip(*right, strict=True))
    return [[sum(map(mul, row, column), ZERO) for column in columns] for row in left]
