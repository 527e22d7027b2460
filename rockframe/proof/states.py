"""Sets of states in a representation that avoids the wrapping effect (Lohner)."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from flint import arb_mat

from rockframe.proof.balls import ONE, ZERO, Ball, Matrix, Row, ball, dot, matrix_product


class SetOfStates(NamedTuple):
    """The set c + P q + Q r of :eq:`eq-proof-set`, for any number of coordinates and rates."""

    centre: Row  # c
    by_inputs: Matrix  # P, derivative of the states by the uncertain inputs
    uncertain: Sequence[Ball]  # q, the uncertain inputs less their middles
    axes: Matrix  # Q
    remainder: Row  # r

    @classmethod
    def from_box(cls, state: Row, uncertain: Sequence[Ball]) -> "SetOfStates":
        """Return the box of a state as a set that does not depend on the uncertain inputs."""
        centre = [each.mid() for each in state]
        by_inputs = [[ZERO] * len(uncertain) for _ in centre]
        remainder = [each - middle for each, middle in zip(state, centre, strict=True)]
        return cls(centre, by_inputs, uncertain, identity(len(state)), remainder)

    def deviations(self) -> Row:
        """Enclose the distances from the centre."""
        return [
            dot(by_inputs, self.uncertain) + dot(axis, self.remainder)
            for by_inputs, axis in zip(self.by_inputs, self.axes, strict=True)
        ]

    def influences(self) -> list[float]:
        """Return the largest change of the first component by each uncertain input."""
        pairs = zip(self.by_inputs[0], self.uncertain, strict=True)
        return [float((row * one).abs_upper()) for row, one in pairs]

    def box(self) -> Row:
        """Enclose each component of the states."""
        return [
            one + deviations for one, deviations in zip(self.centre, self.deviations(), strict=True)
        ]

    def image(self, centre: Row, matrix: Matrix, by_inputs: Matrix) -> "SetOfStates":
        """Enclose the image of a map, by the mean value theorem :eq:`eq-proof-set`.

        `centre` encloses the image of the centre, `matrix` and `by_inputs` the derivatives over the
        whole set with respect to the state and to the uncertain inputs.
        """
        start = [each.mid() for each in centre]
        remainders = [each - middle for each, middle in zip(centre, start, strict=True)]
        middles = self.by_inputs
        if self.uncertain:
            by_inputs = [
                [one + other for one, other in zip(row, more, strict=True)]
                for row, more in zip(matrix_product(matrix, self.by_inputs), by_inputs, strict=True)
            ]
            middles = [[each.mid() for each in row] for row in by_inputs]
            for i, (row, middle) in enumerate(zip(by_inputs, middles, strict=True)):
                remainders[i] += dot(
                    [a - b for a, b in zip(row, middle, strict=True)], self.uncertain
                )
        mapped_axes = matrix_product(matrix, self.axes)
        axes, back = _orthogonal_axes(mapped_axes, self.remainder)
        remainder = [
            dot(row, self.remainder) + dot(line, remainders)
            for row, line in zip(matrix_product(back, mapped_axes), back, strict=True)
        ]
        return SetOfStates(start, middles, self.uncertain, axes, remainder)


def identity(size: int) -> Matrix:
    """Return the unit matrix."""
    return [[ONE if i == j else ZERO for j in range(size)] for i in range(size)]


def _orthogonal_axes(mapped_axes: Matrix, remainder: Row) -> tuple[Matrix, Matrix]:
    """Return nearly orthogonal axes, the first along the longest edge, and their inverse."""
    sizes = [float(each.abs_upper()) + 1e-300 for each in remainder]
    edges = [[float(each.mid()) * sizes[j] for j, each in enumerate(row)] for row in mapped_axes]
    lengths = [math.hypot(*column) for column in zip(*edges, strict=True)]
    if not (max(lengths) > 0.0 and math.isfinite(sum(lengths))):
        return identity(len(remainder)), identity(len(remainder))
    if len(remainder) == 2:
        j = 0 if lengths[0] >= lengths[1] else 1
        x, y = (ball(row[j] / lengths[j]) for row in edges)
        norm = x * x + y * y
        return [[x, -y], [y, x]], [[x / norm, y / norm], [-y / norm, x / norm]]
    order = np.argsort(lengths)[::-1]
    found = np.linalg.qr(np.array(edges)[:, order] / max(lengths))[0]
    axes = [[ball(float(each)) for each in row] for row in found]
    inverse: Matrix = arb_mat(axes).inv().table()
    return axes, inverse
