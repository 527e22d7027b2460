"""The ground acceleration inside one interval of the motion, as a polynomial."""

from rockframe.compiled import ReadOnlyMatrix, Vector, inlined
from rockframe.dynamics.protocol import Ground
from rockframe.solve.workspace import TERMS, Span


@inlined
def load_interval(index: int, pieces: ReadOnlyMatrix, first: int, coefficients: Vector) -> int:
    """Write the polynomial of one direction in interval `index`; give its degree.

    The polynomial is in u, from 0 to 1 over the interval. A direction without
    samples, and the time after the last sample, have a ground that stands still.
    """
    if index >= len(pieces):
        coefficients[first] = 0.0
        return 0
    coefficients[first] = pieces[index, 0]
    coefficients[first + 1] = pieces[index, 1]
    for j in range(2, pieces.shape[1]):
        coefficients[first + j] = pieces[index, j]
    return pieces.shape[1] - 1


@inlined
def polynomial(u: float, degree: int, first: int, coefficients: Vector) -> float:
    """Give a polynomial, of which the coefficients stand from index `first` on."""
    value = coefficients[first + degree]
    for j in range(degree - 1, -1, -1):
        value = value * u + coefficients[first + j]
    return value


@inlined
def ground_in(fraction: float, span: Span, coefficients: Vector) -> Ground:
    """Give the ground acceleration at a fraction of a step."""
    u = span.u + fraction * span.du
    return Ground(
        polynomial(u, span.degree_x, 0, coefficients),
        polynomial(u, span.degree_y, TERMS, coefficients),
    )
