"""Balls of real numbers, by python-flint: the arithmetic of proofs.

A ball holds a middle and a radius; what is computed of balls holds every number that could have
been computed of numbers inside them. A comparison of balls is true only where it is so for all of
them.
"""

from collections.abc import Sequence
from operator import mul
from typing import Any, Final, TypeAlias

from flint import arb, ctx

Ball: TypeAlias = Any
"""A number known within a radius, ``flint.arb``."""
Row: TypeAlias = list[Ball]
Matrix: TypeAlias = list[Row]

ball: Final[Any] = arb
"""Give the ball of a number, exactly that of a float; with a second number for its radius."""
ZERO: Final[Ball] = arb(0)
ONE: Final[Ball] = arb(1)
UNIT: Final[Ball] = ZERO.union(ONE)
"""All numbers from 0 to 1."""
WITHIN_ONE: Final[Ball] = arb(0, 1)


def working_precision(bits: int) -> Any:
    """Give the context in which the middles of balls have so many bits."""
    return ctx.workprec(bits)


def bits() -> int:
    """Give the bits of the middles."""
    return ctx.prec


def upper(one: Ball) -> Ball:
    """Give the least number that no absolute value in a ball exceeds, as a ball."""
    return arb(one.abs_upper())


def total(one: Sequence[Ball], other: Sequence[Ball]) -> Ball:
    """Sum the products of two rows, as far as the shorter one goes."""
    return sum(map(mul, one, other), ZERO)


def product(one: Row, other: Row, order: int) -> Ball:
    """Give the coefficient of an order of the product of two power series."""
    return sum(map(mul, one, other[order::-1]), ZERO)


def value(coefficients: Row, at: Ball) -> Ball:
    """Evaluate a polynomial, lowest power first."""
    result = ZERO
    for each in reversed(coefficients):
        result = result * at + each
    return result


def slope(coefficients: Row) -> Row:
    """Give the derivative of a polynomial."""
    return [each * power for power, each in enumerate(coefficients)][1:]


def moved(coefficients: Row, by: Ball) -> Row:
    """Give a polynomial about another point: its Taylor coefficients there."""
    if len(coefficients) == 2:
        return [coefficients[0] + coefficients[1] * by, coefficients[1]]
    row = list(coefficients)
    for start in range(len(row) - 1):
        for each in range(len(row) - 2, start - 1, -1):
            row[each] = row[each] + by * row[each + 1]
    return row


def hull(balls: Row) -> Ball:
    """Give the least ball that holds others."""
    result = balls[0]
    for each in balls[1:]:
        result = result.union(each)
    return result


def times(one: Matrix, other: Matrix) -> Matrix:
    """Multiply two matrices."""
    columns = list(zip(*other, strict=True))
    return [[sum(map(mul, row, column), ZERO) for column in columns] for row in one]
