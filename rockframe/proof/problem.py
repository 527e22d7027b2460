"""What a proof is about: a block, its ground and its start, as balls about doubles."""

from dataclasses import dataclass
from typing import Any, Final, NamedTuple, TypeAlias

from flint import arb

from rockframe.signals import Motion
from rockframe.signals.slope import Slope

Ball: TypeAlias = Any
"""A number known within a radius, ``flint.arb``."""

ZERO: Final[Ball] = arb(0)


class Undecided(Exception):  # noqa: N818  (an answer, no error)
    """Nothing is proved, for the reason that it gives."""


class BearingCorner(NamedTuple):
    """The corner that a block rocks on, by numbers of the law :eq:`eq-rigid-rocking`."""

    sign: int  # of the rotation
    angle: Ball  # theta
    rate: Ball  # R0/(I_O/m + R0^2) [1/m]
    restitution: Ball  # of an impact on this corner
    limit: Ball  # rotation that is called overturning


class GroundBalls(NamedTuple):
    """Acceleration along the base and apparent gravity normal to it [m s^-2]."""

    along: Ball
    weight: Ball


class Line(NamedTuple):
    """The ground from a knot to the next: values at the knot, and slopes in time."""

    at: GroundBalls
    slope: GroundBalls

    def over(self, time: Ball) -> GroundBalls:
        """Give the ground at a time from the knot, or over an interval of them."""
        return GroundBalls(
            *(one + rise * time for one, rise in zip(self.at, self.slope, strict=True))
        )


@dataclass(frozen=True)
class Problem:
    """A block under a ground whose acceleration is joined by straight lines between knots.

    Parameters
    ----------
    right, left : BearingCorner
        Of the block.
    step : Ball
        Between knots [s].
    knots : sequence of GroundBalls
        At the samples.
    still : GroundBalls
        After the last sample.
    """

    right: BearingCorner
    left: BearingCorner
    step: Ball
    knots: list[GroundBalls]
    still: GroundBalls

    @property
    def last(self) -> int:
        """Number of the last knot, after which the ground is still."""
        return len(self.knots) - 1

    def side(self, sign: int) -> BearingCorner:
        """Give the side of a sign of the rotation."""
        return self.right if sign > 0 else self.left

    def line(self, k: int) -> Line:
        """Give the ground after a knot."""
        if not 0 <= k < self.last:
            return Line(self.still, GroundBalls(ZERO, ZERO))
        start, end = self.knots[k], self.knots[k + 1]
        return Line(
            start, GroundBalls(*((b - a) / self.step for a, b in zip(start, end, strict=True)))
        )

    def over(self, k: int, begin: Ball, end: Ball) -> GroundBalls:
        """Enclose the ground from one time after a knot to another, over further knots too."""
        line = self.line(k)
        found = [line.over(begin), *([self.line(k - 1).over(self.step)] if not begin >= 0 else [])]
        rest, j = end, k
        while not rest <= self.step:
            found.append(self.line(j).over(self.step))
            j += 1
            rest = rest - self.step
            found.append(self.line(j).at)
        found.append(self.line(j).over(rest))
        if not begin >= 0:  # an impact beside a knot
            found.append(self.line(k - 1).over(self.step + begin))
        along, weight = found[0]
        for one in found[1:]:
            along, weight = along.union(one.along), weight.union(one.weight)
        return GroundBalls(along, weight)


def ground_at_samples(
    motion: Motion, slope: Slope, scale: float
) -> tuple[list[GroundBalls], GroundBalls]:
    """Give the ground at the samples of a record, and after them, :eq:`eq-incline-ground`."""
    inclination, gravity, factor = arb(slope.inclination), arb(slope.gravity), arb(scale)
    sine, cosine = inclination.sin(), inclination.cos()
    still = GroundBalls(gravity * sine, gravity * cosine)
    across = [factor * arb(value) for value in motion.horizontal.samples.tolist()]
    if motion.vertical is None:
        up = [ZERO] * len(across)
    else:
        up = [factor * arb(value) for value in motion.vertical.samples.tolist()]
    if slope.level:
        return [GroundBalls(a, gravity + b) for a, b in zip(across, up, strict=True)], still
    return [
        GroundBalls(still.along + a * cosine + b * sine, still.weight + b * cosine - a * sine)
        for a, b in zip(across, up, strict=True)
    ], still


def acceleration(side: BearingCorner, ground: GroundBalls, rotation: Ball) -> Ball:
    """Enclose the angular acceleration, :eq:`eq-rigid-rocking`."""
    lean = side.sign * side.angle - rotation
    return -side.rate * (ground.weight * lean.sin() + ground.along * lean.cos())


def fastest(side: BearingCorner, ground: GroundBalls) -> Ball:
    """Bound the angular acceleration at any rotation and its derivative, :eq:`eq-proof-field`."""
    return arb((side.rate * (abs(ground.weight) + abs(ground.along))).upper())
