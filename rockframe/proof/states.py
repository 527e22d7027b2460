"""Sets of states in a representation that avoids the wrapping effect (Lohner)."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from flint import arb_mat

from rockframe.proof.balls import ONE, ZERO, Ball, Matrix, Row, ball, times, total


class SetOfStates(NamedTuple):
    """The set c + P q + Q r of :eq:`eq-proof-set`, for any number of coordinates and rates."""

    centre: Row  # c
    inputs: Matrix  # P, derivative of the states by the uncertain inputs
    uncertain: Sequence[Ball]  # q, the uncertain inputs less their middles
    axes: Matrix  # Q
    rest: Row  # r

    @classmethod
    def about(cls, state: Row, uncertain: Sequence[Ball]) -> "SetOfStates":
        """Return the box of a state as a set that does not depend on the uncertain inputs."""
        centre = [each.mid() for each in state]
        free = [[ZERO] * len(uncertain) for _ in centre]
        rest = [each - middle for each, middle in zip(state, centre, strict=True)]
        return cls(centre, free, uncertain, identity(len(state)), rest)

    def away(self) -> Row:
        """Enclose the distances from the centre."""
        return [
            total(inputs, self.uncertain) + total(axis, self.rest)
            for inputs, axis in zip(self.inputs, self.axes, strict=True)
        ]

    def influences(self) -> list[float]:
        """Return the largest change of the first component by each uncertain input."""
        pairs = zip(self.inputs[0], self.uncertain, strict=True)
        return [float((row * one).abs_upper()) for row, one in pairs]

    def box(self) -> Row:
        """Enclose each component of the states."""
        return [one + away for one, away in zip(self.centre, self.away(), strict=True)]

    def image(self, centre: Row, matrix: Matrix, free: Matrix) -> "SetOfStates":
        """Enclose the image of a map, by the mean value theorem :eq:`eq-proof-set`.

        `centre` encloses the image of the centre, `matrix` and `free` the derivatives over the
        whole set with respect to the state and to the uncertain inputs.
        """
        start = [each.mid() for each in centre]
        left = [each - middle for each, middle in zip(centre, start, strict=True)]
        middles = self.inputs
        if self.uncertain:
            inputs = [
                [one + other for one, other in zip(row, more, strict=True)]
                for row, more in zip(times(matrix, self.inputs), free, strict=True)
            ]
            middles = [[each.mid() for each in row] for row in inputs]
            for i, (row, middle) in enumerate(zip(inputs, middles, strict=True)):
                left[i] += total([a - b for a, b in zip(row, middle, strict=True)], self.uncertain)
        turned = times(matrix, self.axes)
        axes, back = _axes(turned, self.rest)
        rest = [
            total(row, self.rest) + total(line, left)
            for row, line in zip(times(back, turned), back, strict=True)
        ]
        return SetOfStates(start, middles, self.uncertain, axes, rest)


def identity(size: int) -> Matrix:
    """Return the unit matrix."""
    return [[ONE if i == j else ZERO for j in range(size)] for i in range(size)]


def _axes(turned: Matrix, rest: Row) -> tuple[Matrix, Matrix]:
    """Return nearly orthogonal axes, the first along the longest edge, and their inverse."""
    sizes = [float(each.abs_upper()) + 1e-300 for each in rest]
    edges = [[float(each.mid()) * sizes[j] for j, each in enumerate(row)] for row in turned]
    lengths = [math.hypot(*column) for column in zip(*edges, strict=True)]
    if not (max(lengths) > 0.0 and math.isfinite(sum(lengths))):
        return identity(len(rest)), identity(len(rest))
    if len(rest) == 2:
        j = 0 if lengths[0] >= lengths[1] else 1
        x, y = (ball(row[j] / lengths[j]) for row in edges)
        norm = x * x + y * y
        return [[x, -y], [y, x]], [[x / norm, y / norm], [-y / norm, x / norm]]
    order = np.argsort(lengths)[::-1]
    found = np.linalg.qr(np.array(edges)[:, order] / max(lengths))[0]
    axes = [[ball(float(each)) for each in row] for row in found]
    inverse: Matrix = arb_mat(axes).inv().table()
    return axes, inverse
