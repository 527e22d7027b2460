"""Enclosures of the rocking motion over a step: Taylor's series with its remainder.

Lemmas :eq:`eq-proof-majorant`, :eq:`eq-proof-variation` and :eq:`eq-proof-set` of the manual.
"""

import math
from functools import cache
from operator import mul
from typing import Final, NamedTuple

from flint import arb, ctx

from rockframe.proof.problem import ZERO, Ball, BearingCorner, Line, Undecided, fastest

ONE: Final[Ball] = arb(1)
UNIT: Final[Ball] = ZERO.union(ONE)
HIGHEST: Final = 44
"""Order of the series beyond which a step is halved."""
_OF_SLOPE: Final = 4
"""Order of the stiffness in the equation of variation."""
_FINER: Final = 4
"""Parts of a factor of two to which bounds are rounded up, so that few majorants are made."""


class TooLong(Exception):  # noqa: N818  (a step to be halved, no error)
    """A step over which the series does not serve."""


@cache
def majorants(
    speed: int, force: int, rise: int, precision: int
) -> tuple[list[Ball], list[Ball], int]:
    """Bound the coefficients of rotation and of sine, and give the order that a precision takes.

    The bounds are of h omega, of the forces times h^2 and of their change; powers of 2^(1/4).
    """
    fast, strong, steep = (_raised(one) for one in (speed, force, rise))
    angle, wave = [ZERO, fast], [ONE]
    least = arb(2) ** -precision
    order = 0
    for k in range(HIGHEST):
        pull = strong * wave[k] + (steep * wave[k - 1] if k else ZERO)
        angle.append(arb((pull / ((k + 1) * (k + 2))).upper()))
        turn: Ball = sum(((j + 1) * angle[j + 1] * wave[k - j] for j in range(k + 1)), ZERO)
        wave.append(arb((turn / (k + 1)).upper()))
        if k > _OF_SLOPE and angle[-1] < least:
            order = k + 1
            break
    return angle, wave, order


def _raised(power: int) -> Ball:
    return arb((arb(2) ** (arb(power) / _FINER)).upper())


def _power(bound: Ball) -> int:
    value = float(bound.abs_upper()) * (1.0 + 1e-9)
    return math.ceil(_FINER * math.log2(max(value, 1e-18)))


def product(a: list[Ball], b: list[Ball]) -> Ball:
    """Give a coefficient of the product of two series, of which one is reversed."""
    return sum(map(mul, a, b), ZERO)


class Course(NamedTuple):
    """Series of a rotation in the share x of a step, and what bounds it."""

    length: Ball  # h
    angle: list[Ball]  # of alpha
    sine: list[Ball]  # of theta s - alpha
    cosine: list[Ball]
    remainder: Ball  # bound of the next coefficient
    force: Ball  # bound of h^2 f and of its derivative by alpha
    coarse: Ball  # bound of the stiffness that is left out
    forces: tuple[Ball, Ball, Ball, Ball]  # h^2 rate times weight, its rise, along, its rise

    def end(self) -> tuple[Ball, Ball]:
        """Enclose rotation and rate at the end."""
        order = len(self.angle)
        far = arb(0, self.remainder)
        rate = sum((k * one for k, one in enumerate(self.angle)), ZERO) + order * far
        return sum(self.angle, ZERO) + far, rate / self.length


def course(
    side: BearingCorner, line: Line, start: tuple[Ball, Ball], box: list[Ball], h: Ball
) -> Course:
    """Give the series of a rotation from a point, with bounds that hold of a box about it.

    Raises
    ------
    TooLong
        The step is to be halved.
    """
    first, last = line.at, line.over(h)
    most = arb(fastest(side, first).union(fastest(side, last)).upper())
    scale = h * h * side.rate
    weight, along = scale * first.weight, scale * first.along
    more, further = scale * h * line.slope.weight, scale * h * line.slope.along
    force = arb((h * h * most).upper())
    if not force < 0.5:
        raise TooLong
    speed = abs(h * box[1]) + force
    keys = _power(speed), _power(force), _power(abs(more) + abs(further))
    bounds, waves, order = majorants(*keys, ctx.prec - 8)
    if not order:
        raise TooLong
    lean = side.sign * side.angle - start[0]
    sine, cosine, angle, turns = [lean.sin()], [lean.cos()], [start[0], h * start[1]], []
    for k in range(order - 1):
        pull = weight * sine[k] + along * cosine[k]
        if k:
            pull += more * sine[k - 1] + further * cosine[k - 1]
        angle.append(-pull / ((k + 1) * (k + 2)))
        turns.append((k + 1) * angle[k + 1])
        back = turns[::-1]
        sine, cosine = (
            [*sine, -product(cosine, back) / (k + 1)],
            [*cosine, product(sine, back) / (k + 1)],
        )
    left_out = _raised(keys[1]) * waves[_OF_SLOPE + 1] + _raised(keys[2]) * waves[_OF_SLOPE]
    return Course(
        h, angle, sine, cosine, bounds[order + 1], force, left_out, (weight, more, along, further)
    )


def variation(found: Course, radius: tuple[Ball, Ball]) -> list[list[Ball]]:
    """Enclose the derivative of the end by the start, of all within a radius."""
    h, (weight, more, along, further) = found.length, found.forces
    stiff: list[Ball] = []
    for k in range(_OF_SLOPE + 1):
        one = weight * found.cosine[k] - along * found.sine[k]
        if k:
            one += more * found.cosine[k - 1] - further * found.sine[k - 1]
        stiff.append(one)
    away = 2 * (radius[0] + h * radius[1])
    rest = found.coarse + found.force * away
    columns: list[tuple[Ball, Ball]] = []
    for start in ([ONE, ZERO], [ZERO, ONE]):
        series = list(start)
        for k in range(_OF_SLOPE + 1):
            series.append(product(stiff[: k + 1], series[k::-1]) / ((k + 1) * (k + 2)))
        size = [abs(one) for one in series]
        defect = rest * sum(size, ZERO)
        for i, one in enumerate(stiff):
            defect += abs(one) * sum(size[_OF_SLOPE + 1 - i :], ZERO)
        bound = defect.upper()
        rate = sum((k * one for k, one in enumerate(series)), ZERO)
        columns.append((sum(series, ZERO) + arb(0, bound), rate + arb(0, 2 * bound)))
    (a, b), (c, d) = columns
    return [[a, c * h], [b / h, d]]


class StateSet(NamedTuple):
    """A set of states, centre + axes times spread, :eq:`eq-proof-set`."""

    centre: list[Ball]
    axes: list[list[Ball]]
    spread: list[Ball]

    def box(self) -> list[Ball]:
        """Enclose rotation and rate."""
        return [one + product(axis, self.spread) for one, axis in zip(*self[:2], strict=True)]

    def radius(self) -> tuple[Ball, Ball]:
        """Bound the distances from the centre."""
        away = (arb(product(axis, self.spread).abs_upper()) for axis in self.axes)
        first, second = away
        return first, second

    def mapped(self, image: tuple[Ball, Ball], slope: list[list[Ball]]) -> "StateSet":
        """Give the image, from that of the centre and the derivative over the set."""
        turned = [
            [product(row, [self.axes[0][j], self.axes[1][j]]) for j in (0, 1)] for row in slope
        ]
        sizes = [float(one.abs_upper()) + 1e-300 for one in self.spread]
        axes = _axes([[float(turned[i][j].mid()) * sizes[j] for j in (0, 1)] for i in (0, 1)])
        centre = [one.mid() for one in image]
        rest = [one - middle for one, middle in zip(image, centre, strict=True)]
        norm = axes[0][0] * axes[0][0] + axes[1][0] * axes[1][0]
        back = [[axes[j][i] / norm for j in (0, 1)] for i in (0, 1)]
        spread = [
            product([product(row, [turned[0][j], turned[1][j]]) for j in (0, 1)], self.spread)
            + product(row, rest)
            for row in back
        ]
        return StateSet(centre, axes, spread)


def point(rotation: Ball, rate: Ball) -> StateSet:
    """Give a set of one state, but for the radii of its balls."""
    middle = [rotation.mid(), rate.mid()]
    return StateSet(middle, [[ONE, ZERO], [ZERO, ONE]], [rotation - middle[0], rate - middle[1]])


def _axes(columns: list[list[float]]) -> list[list[Ball]]:
    """Give perpendicular axes, of equal length, the first along the longer column."""
    lengths = [math.hypot(columns[0][j], columns[1][j]) for j in (0, 1)]
    j = 0 if lengths[0] >= lengths[1] else 1
    if not 0.0 < lengths[j] < math.inf:
        return [[ONE, ZERO], [ZERO, ONE]]
    x, y = arb(columns[0][j] / lengths[j]), arb(columns[1][j] / lengths[j])
    return [[x, -y], [y, x]]


def stepped(
    side: BearingCorner, line: Line, states: StateSet, h: Ball
) -> tuple[StateSet, Course, list[Ball]]:
    """Enclose the end of a step, and the rotations and rates over it.

    Raises
    ------
    TooLong
        The step is to be halved.
    """
    box = states.box()
    found = course(side, line, (states.centre[0], states.centre[1]), box, h)
    slope = variation(found, states.radius())
    after = states.mapped(found.end(), slope)
    share = arb(0, found.force.upper())
    rates = box[1] + share * UNIT / h
    rotations = box[0] + UNIT * h * box[1] + share / 2
    return after, found, [rotations, rates]


def narrow(states: StateSet, limit: Ball) -> None:
    """Refuse a set as wide as the rotations that are to be told apart.

    Raises
    ------
    Undecided
        It is.
    """
    if not 3 * states.radius()[0] < limit:
        msg = "the enclosure has become as wide as the rotations themselves"
        raise Undecided(msg)
