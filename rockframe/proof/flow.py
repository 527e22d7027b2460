"""Sets of states of a block on rigid ground, and their images after a step.

The sets have a representation that avoids the wrapping effect (Lohner). The rocking motion over a
step is enclosed by Taylor's series with its remainder: lemmas :eq:`eq-proof-majorant`,
:eq:`eq-proof-variation` and :eq:`eq-proof-sweep` of the manual.
"""

import math
from collections.abc import Sequence
from functools import cache
from typing import Final, NamedTuple

import numpy as np
from flint import arb_mat

from rockframe.proof.balls import (
    ONE,
    UNIT,
    WITHIN_ONE,
    ZERO,
    Ball,
    Matrix,
    Row,
    ball,
    bits,
    cauchy_product,
    dot,
    magnitude,
    matrix_product,
)
from rockframe.proof.problem import (
    CornerNumbers,
    Deviations,
    GroundPiece,
    acceleration,
    acceleration_bound,
    require,
    stiffness,
)

MAX_ORDER: Final = 60
"""Largest order of the series; a step that needs more is halved."""
STIFFNESS_ORDER: Final = 4
"""Order of the polynomial for the stiffness in the equation of variation."""
_FINER: Final = 4
"""Bounds are rounded up to powers of the 4th root of 2, so that few majorants are computed."""


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
        centre = [component.mid() for component in state]
        by_inputs = [[ZERO] * len(uncertain) for _ in centre]
        remainder = [component - middle for component, middle in zip(state, centre, strict=True)]
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
        return [float((row * deviation).abs_upper()) for row, deviation in pairs]

    def box(self) -> Row:
        """Enclose each component of the states."""
        return [
            middle + deviations
            for middle, deviations in zip(self.centre, self.deviations(), strict=True)
        ]

    def image(self, centre: Row, matrix: Matrix, by_inputs: Matrix) -> "SetOfStates":
        """Enclose the image of a map, by the mean value theorem :eq:`eq-proof-set`.

        `centre` encloses the image of the centre, `matrix` and `by_inputs` the derivatives over the
        whole set with respect to the state and to the uncertain inputs.
        """
        start = [component.mid() for component in centre]
        remainders = [component - middle for component, middle in zip(centre, start, strict=True)]
        middles = self.by_inputs
        if self.uncertain:
            by_inputs = [
                [derivative + direct for derivative, direct in zip(row, more, strict=True)]
                for row, more in zip(matrix_product(matrix, self.by_inputs), by_inputs, strict=True)
            ]
            middles = [[derivative.mid() for derivative in row] for row in by_inputs]
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
    sizes = [float(component.abs_upper()) + 1e-300 for component in remainder]
    edges = [
        [float(component.mid()) * sizes[j] for j, component in enumerate(row)]
        for row in mapped_axes
    ]
    lengths = [math.hypot(*column) for column in zip(*edges, strict=True)]
    if not (max(lengths) > 0.0 and math.isfinite(sum(lengths))):
        return identity(len(remainder)), identity(len(remainder))
    if len(remainder) == 2:
        j = 0 if lengths[0] >= lengths[1] else 1
        x, y = (ball(row[j] / lengths[j]) for row in edges)
        norm = x * x + y * y
        return [[x, -y], [y, x]], [[x / norm, y / norm], [-y / norm, x / norm]]
    order = np.argsort(lengths)[::-1]
    basis = np.linalg.qr(np.array(edges)[:, order] / max(lengths))[0]
    axes = [[ball(float(component)) for component in row] for row in basis]
    inverse: Matrix = arb_mat(axes).inv().table()
    return axes, inverse


class MotionBounds(NamedTuple):
    """Enclosures of all states of a set over a span of time."""

    rotation: Ball
    rate: Ball
    acceleration: Ball


def bound_motion(
    state: Row, corner: CornerNumbers, during: GroundPiece, span: Ball
) -> MotionBounds:
    """Enclose the motion over a span of times about 0, :eq:`eq-proof-sweep`.

    `during` encloses the ground at all times of the span.
    """
    rate = state[1] + span * (WITHIN_ONE * acceleration_bound(corner, during))
    pull = acceleration(state[0] + span * rate, corner, during)
    rate = state[1] + span * pull
    return MotionBounds(state[0] + span * rate, rate, pull)


@cache
def majorants(speed: int, forces: tuple[int, ...], precision: int) -> tuple[Row, Row, int]:
    """Bound the coefficients of rotation and of sine; give the order needed for a precision.

    `speed` and `forces` bound h omega and the coefficients of the forces times h^2, as exponents of
    2^(1/4). `precision` is in bits; the order is 0 where none suffices.
    """
    strong = [_root_power(force) for force in forces]
    angle, sine = [ZERO, _root_power(speed)], [ONE]
    least = ball(2) ** -precision
    for k in range(MAX_ORDER):
        angle.append(magnitude(cauchy_product(strong, sine, k) / ((k + 1) * (k + 2))))
        if k > STIFFNESS_ORDER and angle[-1] < least:
            return angle, sine, k + 1
        sine_rate = dot([(j + 1) * angle[j + 1] for j in range(k + 1)], sine[::-1])
        sine.append(magnitude(sine_rate / (k + 1)))
    return angle, sine, 0


def _root_power(power: int) -> Ball:
    return magnitude(ball(2) ** (ball(power) / _FINER))


def _exponent_of(bound: Ball) -> int:
    value = float(magnitude(bound)) * (1.0 + 1e-9)
    return math.ceil(_FINER * math.log2(max(value, 1e-18)))


class Flow(NamedTuple):
    """Series of a rotation in x, from 0 to 1 over a step, with bounds."""

    length: Ball  # h
    angle: Row  # of alpha
    sine: Row  # of theta s - alpha
    cosine: Row
    remainder: Ball  # bound of the remainder: the next coefficient
    along: Row  # kappa h^2 times the acceleration along the base, in powers of x
    normal: Row  # likewise normal to it, with gravity
    force: Ball  # bound of h^2 f and of its derivative by alpha
    coarse: Ball  # bound of the terms of the stiffness beyond those in the equation of variation
    by_scale: "ByScale | None" = None

    def end(self) -> Row:
        """Enclose rotation and rate at the end."""
        order = len(self.angle)
        far = ball(0, self.remainder)
        rate = (
            sum((k * coefficient for k, coefficient in enumerate(self.angle)), ZERO) + order * far
        )
        return [sum(self.angle, ZERO) + far, rate / self.length]


class ByScale(NamedTuple):
    """Series of the derivative of h^2 f by the scale of the motion, with bounds."""

    push: Row
    force: Ball  # bound of the derivative
    coarse: Ball  # bound of the terms beyond those of the series


def _forces(
    corner: CornerNumbers, ground: GroundPiece, during: GroundPiece, h: Ball
) -> tuple[Row, Row, list[int]]:
    """Return kappa h^2 times the ground in powers of x, and exponents that bound it over a step."""
    along, normal, powers = list[Ball](), list[Ball](), list[int]()
    factor = h * h * corner.ratio
    for k in range(max(len(ground.along), len(ground.normal))):
        most = ZERO
        if k < len(ground.along):
            along.append(factor * ground.along[k])
            most += abs(during.along[k])
        if k < len(ground.normal):
            normal.append(factor * ground.normal[k])
            most += abs(during.normal[k])
        powers.append(_exponent_of(factor * most))
        factor *= h
    return along, normal, powers


def flow(
    start: Row, box: Row, corner: CornerNumbers, ground: GroundPiece, during: GroundPiece, h: Ball
) -> Flow:
    """Return the series of a rotation from a point, with bounds that hold for a box about it.

    The series are for the middles of all inputs, the bounds for all inputs.
    """
    along, normal, powers = _forces(corner, ground.middle, during, h)
    force = _root_power(powers[0])
    speed = abs(h * box[1]) + force
    bounds, sine_bounds, order = majorants(_exponent_of(speed), tuple(powers), bits() - 8)
    require(order > 0 and force < 0.5, "a step too long for its series")
    sine, cosine, angle = _series(start, corner.middle(), along, normal, h, order)

    def left_out(of: list[int]) -> Ball:
        return dot([_root_power(size) for size in of], sine_bounds[STIFFNESS_ORDER + 1 :: -1])

    by_scale = None
    if ground.spread is not None and during.spread is not None:
        x, w, sizes = _forces(corner, ground.spread.by_scale, during.spread.by_scale, h)
        push = [
            -cauchy_product(w, sine, k) - cauchy_product(x, cosine, k)
            for k in range(STIFFNESS_ORDER + 1)
        ]
        by_scale = ByScale(push, _root_power(sizes[0]), left_out(sizes))
    return Flow(
        h, angle, sine, cosine, bounds[order + 1], along, normal, force, left_out(powers), by_scale
    )


def _series(
    start: Row, corner: CornerNumbers, along: Row, normal: Row, h: Ball, order: int
) -> tuple[Row, Row, Row]:
    """Return the coefficients of sine, cosine and rotation, by recursion."""
    first, second = (corner.angle * corner.sign - start[0]).sin_cos()
    sine, cosine, angle, rotation_rates = [first], [second], [start[0], h * start[1]], list[Ball]()
    for k in range(order - 1):
        pull = cauchy_product(normal, sine, k) + cauchy_product(along, cosine, k)
        angle.append(-pull / ((k + 1) * (k + 2)))
        rotation_rates.insert(0, (k + 1) * angle[k + 1])
        next_sine = -dot(cosine, rotation_rates) / (k + 1)
        cosine.append(dot(sine, rotation_rates) / (k + 1))
        sine.append(next_sine)
    return sine, cosine, angle


def variation(step: Flow, away: Row, lean: Ball, scale: Ball) -> tuple[Matrix, Row]:
    """Enclose the derivatives of the end of a step by its start and by the scale.

    They hold for all states up to `away` from the centre, and for angles theta and scales that
    differ by up to `lean` and `scale`, :eq:`eq-proof-variation` and :eq:`eq-proof-inputs`.
    """
    h, normal, along = step.length, step.normal, step.along
    stiff = [
        cauchy_product(normal, step.cosine, k) - cauchy_product(along, step.sine, k)
        for k in range(STIFFNESS_ORDER + 1)
    ]
    by_scale = ZERO if step.by_scale is None else step.by_scale.force * magnitude(scale)
    farthest = 2 * (magnitude(away[0]) + h * magnitude(away[1])) + 2 * magnitude(lean) + by_scale
    neglected = step.coarse + step.force * farthest + by_scale

    def column(start: Row, push: Row, error: Ball) -> Row:
        series = list(start)
        for k in range(STIFFNESS_ORDER + 1):
            more = push[k] if push else ZERO
            series.append((cauchy_product(stiff, series, k) + more) / ((k + 1) * (k + 2)))
        size = [abs(coefficient) for coefficient in series]
        defect = neglected * sum(size, ZERO) + error
        for i, factor in enumerate(stiff):
            defect += abs(factor) * sum(size[STIFFNESS_ORDER + 1 - i :], ZERO)
        bound = magnitude(defect)
        rate = sum((k * coefficient for k, coefficient in enumerate(series)), ZERO)
        return [sum(series, ZERO) + ball(0, bound), (rate + ball(0, 2 * bound)) / h]

    (a, b), (c, d) = column([ONE, ZERO], [], ZERO), column([ZERO, ONE], [], ZERO)
    matrix = [[a, c * h], [b, d * h]]
    pushed = step.by_scale
    if pushed is None:
        return matrix, [ZERO, ZERO]
    return matrix, column([ZERO, ZERO], pushed.push, pushed.coarse + pushed.force * farthest)


def advance(
    states: SetOfStates, corner: CornerNumbers, ground: GroundPiece, h: Ball
) -> tuple[SetOfStates, MotionBounds]:
    """Enclose a set at the end of a step, and all its states during the step.

    `ground` has the start of the step as its origin. A step that is too long raises `Undecided`.
    """
    span = UNIT * h
    during, box = ground.at(span), states.box()
    step = flow(states.centre, box, corner, ground, during, h)
    inputs = states.uncertain
    if not isinstance(inputs, Deviations):
        matrix, _ = variation(step, states.deviations(), ZERO, ZERO)
        return states.image(step.end(), matrix, [[], []]), bound_motion(box, corner, during, span)
    sign = corner.sign
    matrix, by_scale = variation(step, states.deviations(), inputs.angle(sign), inputs.scale)
    # the rotation is s theta less an angle whose equation does not contain theta
    by_angle = [sign * (1 - matrix[0][0]), -sign * matrix[1][0]]
    free = [
        list(Deviations.of(sign, scale=scale, angle=angle))
        for scale, angle in zip(by_scale, by_angle, strict=True)
    ]
    return states.image(step.end(), matrix, free), bound_motion(box, corner, during, span)


class ShortFlow(NamedTuple):
    """Derivatives of a flow that is short enough for them to be near the identity."""

    matrix: Matrix  # by the state
    angle: Ball  # of either component by theta
    scale: Ball  # of either component by the scale of the motion


def short_flow(
    motion: MotionBounds, corner: CornerNumbers, during: GroundPiece, length: Ball
) -> ShortFlow:
    """Enclose the derivatives of a short flow, :eq:`eq-proof-impact`."""
    stiff = magnitude(stiffness(motion.rotation, corner, during))
    growth = magnitude((ONE.union(stiff) * magnitude(length)).expm1())
    longest = magnitude(length) * (1 + growth)
    by_scale = ZERO
    if during.spread is not None:
        by_scale = ball(0, magnitude(longest * acceleration_bound(corner, during.spread.by_scale)))
    matrix = [[entry + ball(0, growth) for entry in row] for row in identity(2)]
    return ShortFlow(matrix, ball(0, magnitude(longest * stiff)), by_scale)


def jerk(motion: MotionBounds, corner: CornerNumbers, during: GroundPiece) -> Ball:
    """Enclose the third derivative of the rotation over a step; `during` is the ground in it."""
    return acceleration(motion.rotation, corner, during.rates()) + motion.rate * stiffness(
        motion.rotation, corner, during
    )
