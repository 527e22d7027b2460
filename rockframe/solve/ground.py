"""The ground acceleration inside one interval of the motion, as a polynomial."""

from rockframe.compiled import Matrix, Vector, kernel

TERMS = 6
"""Coefficients per direction; a record needs two, an analytic pulse six."""


@kernel
def load_interval(
    index: int,
    samples: Vector,
    pieces: Matrix,
    first: int,
    coefficients: Vector,
) -> int:
    """Write the polynomial of one direction in interval `index`; give its degree.

    The polynomial is in u, from 0 to 1 over the interval. A direction without
    samples, and the time after the last sample, have a ground that stands still.
    """
    for j in range(TERMS):
        coefficients[first + j] = 0.0
    if index >= len(samples) - 1:
        return 0
    if len(pieces) > 0:
        for j in range(TERMS):
            coefficients[first + j] = pieces[index, j]
        return TERMS - 1
    coefficients[first] = samples[index]
    coefficients[first + 1] = samples[index + 1] - samples[index]
    return 1


@kernel
def ground_acceleration(u: float, degree: int, first: int, coefficients: Vector) -> float:
    """Give the ground acceleration at u of the interval."""
    value = coefficients[first + degree]
    for j in range(degree - 1, -1, -1):
        value = value * u + coefficients[first + j]
    return value
