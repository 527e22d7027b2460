"""Enclosures of the rocking motion over a step: Taylor's series with its remainder.

Lemmas :eq:`eq-proof-majorant`, :eq:`eq-proof-variation` and :eq:`eq-proof-sweep` of the manual.
"""

import math
from functools import cache
from typing import Final, NamedTuple

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
    product,
    total,
    upper,
)
from rockframe.proof.problem import (
    CornerNumbers,
    Deviations,
    GroundPiece,
    Undecided,
    acceleration,
    stiffness,
    strongest,
)
from rockframe.proof.states import SetOfStates, identity

HIGHEST: Final = 60
"""Largest order of the series; a step that needs more is halved."""
OF_STIFFNESS: Final = 4
"""Order of the polynomial for the stiffness in the equation of variation."""
_FINER: Final = 4
"""Bounds are rounded up to powers of the 4th root of 2, so that few majorants are computed."""


class Sweep(NamedTuple):
    """Enclosures of all states of a set over a span of time."""

    rotation: Ball
    rate: Ball
    acceleration: Ball


def sweep(state: Row, corner: CornerNumbers, during: GroundPiece, span: Ball) -> Sweep:
    """Enclose the motion over a span of times about 0, :eq:`eq-proof-sweep`.

    `during` encloses the ground at all times of the span.
    """
    rate = state[1] + span * (WITHIN_ONE * strongest(corner, during))
    pull = acceleration(state[0] + span * rate, corner, during)
    rate = state[1] + span * pull
    return Sweep(state[0] + span * rate, rate, pull)


@cache
def majorants(speed: int, forces: tuple[int, ...], precision: int) -> tuple[Row, Row, int]:
    """Bound the coefficients of rotation and of sine; give the order needed for a precision.

    `speed` and `forces` bound h omega and the coefficients of the forces times h^2, as exponents of
    2^(1/4). `precision` is in bits; the order is 0 where none suffices.
    """
    strong = [_raised(one) for one in forces]
    angle, wave = [ZERO, _raised(speed)], [ONE]
    least = ball(2) ** -precision
    for k in range(HIGHEST):
        angle.append(upper(product(strong, wave, k) / ((k + 1) * (k + 2))))
        if k > OF_STIFFNESS and angle[-1] < least:
            return angle, wave, k + 1
        turn = total([(j + 1) * angle[j + 1] for j in range(k + 1)], wave[::-1])
        wave.append(upper(turn / (k + 1)))
    return angle, wave, 0


def _raised(power: int) -> Ball:
    return upper(ball(2) ** (ball(power) / _FINER))


def _power(bound: Ball) -> int:
    value = float(upper(bound)) * (1.0 + 1e-9)
    return math.ceil(_FINER * math.log2(max(value, 1e-18)))


class Flow(NamedTuple):
    """Series of a rotation in x, from 0 to 1 over a step, with bounds."""

    length: Ball  # h
    angle: Row  # of alpha
    sine: Row  # of theta s - alpha
    cosine: Row
    remainder: Ball  # bound of the remainder: the next coefficient
    along: Row  # kappa h^2 times the acceleration along the base, in powers of x
    weight: Row  # likewise normal to it, with gravity
    force: Ball  # bound of h^2 f and of its derivative by alpha
    coarse: Ball  # bound of the terms of the stiffness beyond those in the equation of variation
    by_scale: "ByScale | None" = None

    def end(self) -> Row:
        """Enclose rotation and rate at the end."""
        order = len(self.angle)
        far = ball(0, self.remainder)
        rate = sum((k * one for k, one in enumerate(self.angle)), ZERO) + order * far
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
    along, weight, powers = list[Ball](), list[Ball](), list[int]()
    factor = h * h * corner.ratio
    for k in range(max(len(ground.along), len(ground.weight))):
        most = ZERO
        if k < len(ground.along):
            along.append(factor * ground.along[k])
            most += abs(during.along[k])
        if k < len(ground.weight):
            weight.append(factor * ground.weight[k])
            most += abs(during.weight[k])
        powers.append(_power(factor * most))
        factor *= h
    return along, weight, powers


def flow(
    start: Row, box: Row, corner: CornerNumbers, ground: GroundPiece, during: GroundPiece, h: Ball
) -> Flow:
    """Return the series of a rotation from a point, with bounds that hold for a box about it.

    The series are for the middles of all inputs, the bounds for all inputs.
    """
    along, weight, powers = _forces(corner, ground.middle, during, h)
    force = _raised(powers[0])
    speed = abs(h * box[1]) + force
    bounds, waves, order = majorants(_power(speed), tuple(powers), bits() - 8)
    if not (order and force < 0.5):
        message = "a step too long for its series"
        raise Undecided(message)
    sine, cosine, angle = _series(start, corner.middle(), along, weight, h, order)

    def left_out(of: list[int]) -> Ball:
        return total([_raised(one) for one in of], waves[OF_STIFFNESS + 1 :: -1])

    by_scale = None
    if ground.spread is not None and during.spread is not None:
        x, w, sizes = _forces(corner, ground.spread.by_scale, during.spread.by_scale, h)
        push = [-product(w, sine, k) - product(x, cosine, k) for k in range(OF_STIFFNESS + 1)]
        by_scale = ByScale(push, _raised(sizes[0]), left_out(sizes))
    return Flow(
        h, angle, sine, cosine, bounds[order + 1], along, weight, force, left_out(powers), by_scale
    )


def _series(
    start: Row, corner: CornerNumbers, along: Row, weight: Row, h: Ball, order: int
) -> tuple[Row, Row, Row]:
    """Return the coefficients of sine, cosine and rotation, by recursion."""
    first, second = (corner.angle * corner.sign - start[0]).sin_cos()
    sine, cosine, angle, turns = [first], [second], [start[0], h * start[1]], list[Ball]()
    for k in range(order - 1):
        pull = product(weight, sine, k) + product(along, cosine, k)
        angle.append(-pull / ((k + 1) * (k + 2)))
        turns.insert(0, (k + 1) * angle[k + 1])
        next_sine = -total(cosine, turns) / (k + 1)
        cosine.append(total(sine, turns) / (k + 1))
        sine.append(next_sine)
    return sine, cosine, angle


def variation(found: Flow, away: Row, lean: Ball, scale: Ball) -> tuple[Matrix, Row]:
    """Enclose the derivatives of the end of a step by its start and by the scale.

    They hold for all states up to `away` from the centre, and for angles theta and scales that
    differ by up to `lean` and `scale`, :eq:`eq-proof-variation` and :eq:`eq-proof-inputs`.
    """
    h, weight, along = found.length, found.weight, found.along
    stiff = [
        product(weight, found.cosine, k) - product(along, found.sine, k)
        for k in range(OF_STIFFNESS + 1)
    ]
    other = ZERO if found.by_scale is None else found.by_scale.force * upper(scale)
    farthest = 2 * (upper(away[0]) + h * upper(away[1])) + 2 * upper(lean) + other
    rest = found.coarse + found.force * farthest + other

    def column(start: Row, push: Row, error: Ball) -> Row:
        series = list(start)
        for k in range(OF_STIFFNESS + 1):
            more = push[k] if push else ZERO
            series.append((product(stiff, series, k) + more) / ((k + 1) * (k + 2)))
        size = [abs(one) for one in series]
        defect = rest * sum(size, ZERO) + error
        for i, one in enumerate(stiff):
            defect += abs(one) * sum(size[OF_STIFFNESS + 1 - i :], ZERO)
        bound = upper(defect)
        rate = sum((k * one for k, one in enumerate(series)), ZERO)
        return [sum(series, ZERO) + ball(0, bound), (rate + ball(0, 2 * bound)) / h]

    (a, b), (c, d) = column([ONE, ZERO], [], ZERO), column([ZERO, ONE], [], ZERO)
    matrix = [[a, c * h], [b, d * h]]
    pushed = found.by_scale
    if pushed is None:
        return matrix, [ZERO, ZERO]
    return matrix, column([ZERO, ZERO], pushed.push, pushed.coarse + pushed.force * farthest)


def advance(
    states: SetOfStates, corner: CornerNumbers, ground: GroundPiece, h: Ball
) -> tuple[SetOfStates, Sweep]:
    """Enclose a set at the end of a step, and all its states during the step.

    `ground` has the start of the step as its origin. A step that is too long raises `Undecided`.
    """
    span = UNIT * h
    during, box = ground.at(span), states.box()
    found = flow(states.centre, box, corner, ground, during, h)
    inputs = states.uncertain
    if not isinstance(inputs, Deviations):
        matrix, _ = variation(found, states.away(), ZERO, ZERO)
        return states.image(found.end(), matrix, [[], []]), sweep(box, corner, during, span)
    sign = corner.sign
    matrix, by_scale = variation(found, states.away(), inputs.angle(sign), inputs.scale)
    # the rotation is s theta less an angle whose equation does not contain theta
    by_angle = [sign * (1 - matrix[0][0]), -sign * matrix[1][0]]
    free = [
        list(Deviations.of(sign, scale=scale, angle=angle))
        for scale, angle in zip(by_scale, by_angle, strict=True)
    ]
    return states.image(found.end(), matrix, free), sweep(box, corner, during, span)


class ShortFlow(NamedTuple):
    """Derivatives of a flow that is short enough for them to be near the identity."""

    matrix: Matrix  # by the state
    angle: Ball  # of either component by theta
    scale: Ball  # of either component by the scale of the motion


def nearly_still(
    course: Sweep, corner: CornerNumbers, during: GroundPiece, length: Ball
) -> ShortFlow:
    """Enclose the derivatives of a short flow, :eq:`eq-proof-impact`."""
    stiff = upper(stiffness(course.rotation, corner, during))
    growth = upper((ONE.union(stiff) * upper(length)).expm1())
    longest = upper(length) * (1 + growth)
    by_scale = ZERO
    if during.spread is not None:
        by_scale = ball(0, upper(longest * strongest(corner, during.spread.by_scale)))
    matrix = [[each + ball(0, growth) for each in row] for row in identity(2)]
    return ShortFlow(matrix, ball(0, upper(longest * stiff)), by_scale)


def jerk(course: Sweep, corner: CornerNumbers, during: GroundPiece) -> Ball:
    """Enclose the third derivative of the rotation over a step; `during` is the ground in it."""
    return acceleration(course.rotation, corner, during.rates()) + course.rate * stiffness(
        course.rotation, corner, during
    )
