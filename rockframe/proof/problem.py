"""What a proof is about: a block and its ground, in balls about the floats that a run takes."""

from dataclasses import dataclass, field
from itertools import zip_longest
from typing import NamedTuple

from rockframe.dynamics.rigid_ground import BlockOnRigidGround, RockingCorner
from rockframe.proof.balls import ZERO, Ball, Row, ball, hull, moved, upper
from rockframe.signals.motion import Motion, Slope
from rockframe.system.bodies import OverturningAngles


class Undecided(Exception):  # noqa: N818  (an answer, no error)
    """Nothing is proved, for the reason that it gives."""


class CornerNumbers(NamedTuple):
    """A corner that a block rocks on, by numbers of the law :eq:`eq-rigid-rocking`."""

    sign: int  # of the rotation
    angle: Ball  # theta
    ratio: Ball  # R0/(I_O/m + R0^2) [1/m]
    restitution: Ball  # of an impact on this corner
    limit: Ball  # rotation that is called overturning

    @classmethod
    def of(
        cls, sign: int, corner: RockingCorner, limit: float, tolerance: float
    ) -> "CornerNumbers":
        """Take the floats of a run, and a tolerance of the restitution."""
        ratio = ball(corner.radius) / ball(corner.inertia)
        restitution = ball(corner.restitution) + ball(0, tolerance)
        return cls(sign, ball(corner.angle), ratio, restitution, ball(limit))


class GroundPiece(NamedTuple):
    """Acceleration along the base, and gravity with that normal to it: polynomials of time."""

    along: Row
    weight: Row

    def at(self, time: Ball) -> "GroundPiece":
        """Give the polynomials about another time; about all times of a ball."""
        return GroundPiece(moved(self.along, time), moved(self.weight, time))


@dataclass(frozen=True)
class Shaking:
    """A motion of the ground, which is exactly a polynomial between two samples."""

    motion: Motion
    scale: Ball
    slope: Slope
    still_step: float  # length of the intervals after the motion, when the ground is still [s]
    _known: dict[int, GroundPiece] = field(default_factory=dict[int, GroundPiece], kw_only=True)

    @property
    def count(self) -> int:
        """Number of intervals of the motion."""
        return self.motion.horizontal.samples.size - 1

    def length(self, number: int) -> Ball:
        """Give the length of an interval [s]."""
        return ball(self.motion.time_step if number < self.count else self.still_step)

    def time(self, number: int, after: Ball) -> Ball:
        """Give the time since the first sample [s]."""
        moving, still = min(number, self.count), max(0, number - self.count)
        return moving * ball(self.motion.time_step) + still * ball(self.still_step) + after

    def ground(self, number: int) -> GroundPiece:
        """Give the ground in an interval, by the time since its start, :eq:`eq-incline-ground`."""
        number = min(number, self.count)
        if number not in self._known:
            self._known[number] = _ground(self, number)
        return self._known[number]

    def ground_over(self, number: int, after: Ball, span: Ball) -> GroundPiece:
        """Enclose all values of the ground over a span of time from an instant of an interval."""
        along, weight = list[Ball](), list[Ball]()
        while True:
            left = self.length(number) - after
            inside = ZERO.union(span) if span < left else ZERO.union(left)
            values = self.ground(number).at(after + inside)
            along.append(values.along[0])
            weight.append(values.weight[0])
            if span < left:
                return GroundPiece([hull(along)], [hull(weight)])
            span, number, after = span - left, number + 1, ZERO


@dataclass(frozen=True)
class Problem(Shaking):
    """A block under a motion."""

    right: CornerNumbers
    left: CornerNumbers
    frequency: float  # p of the faster corner [1/s]

    @classmethod
    def of(
        cls,
        block: BlockOnRigidGround,
        motion: Motion,
        slope: Slope,
        limits: OverturningAngles,
        scale: float,
        tolerance: float,
        still_step: float,
    ) -> "Problem":
        """Take the floats of a run; the intervals of rest are given times p."""
        fastest = max(one.radius / one.inertia for one in (block.left, block.right))
        frequency = (slope.gravity * fastest) ** 0.5
        return cls(
            motion, ball(scale), slope, still_step / frequency,
            CornerNumbers.of(1, block.right, limits.right, tolerance),
            CornerNumbers.of(-1, block.left, limits.left, tolerance), frequency,
        )  # fmt: skip

    def corner(self, sign: int) -> CornerNumbers:
        """Give the corner that bears while the rotation has a sign."""
        return self.right if sign > 0 else self.left


def _ground(problem: Shaking, number: int) -> GroundPiece:
    inclination, gravity = ball(problem.slope.inclination), ball(problem.slope.gravity)
    across, up = (_component(problem, number, vertical=one) for one in (False, True))
    if problem.slope.level:
        return GroundPiece(across, [gravity + up[0], *up[1:]])
    sine, cosine = inclination.sin_cos()
    pairs = list(zip_longest(across, up, fillvalue=ZERO))
    along = [x * cosine + y * sine for x, y in pairs]
    weight = [y * cosine - x * sine for x, y in pairs]
    return GroundPiece(
        [along[0] + gravity * sine, *along[1:]], [weight[0] + gravity * cosine, *weight[1:]]
    )


def _component(problem: Shaking, number: int, *, vertical: bool) -> Row:
    """Give a component of the motion as a polynomial of time."""
    motion = problem.motion
    signal = motion.vertical if vertical else motion.horizontal
    if signal is None or number >= problem.count:
        return [ZERO]
    if signal.polynomials is None:
        first, last = (ball(float(signal.samples[number + each])) for each in (0, 1))
        row = [first, last - first]
    else:
        row = [ball(float(each)) for each in signal.polynomials[number]]
    step = problem.length(number)
    return [problem.scale * each / step**power for power, each in enumerate(row)]


def acceleration(rotation: Ball, corner: CornerNumbers, ground: GroundPiece) -> Ball:
    """Give the angular acceleration, of the ground at the start of its polynomials."""
    sine, cosine = (corner.angle * corner.sign - rotation).sin_cos()
    return -corner.ratio * (ground.weight[0] * sine + ground.along[0] * cosine)


def stiffness(rotation: Ball, corner: CornerNumbers, ground: GroundPiece) -> Ball:
    """Give the derivative of the angular acceleration with respect to the rotation."""
    sine, cosine = (corner.angle * corner.sign - rotation).sin_cos()
    return corner.ratio * (ground.weight[0] * cosine - ground.along[0] * sine)


def strongest(corner: CornerNumbers, ground: GroundPiece) -> Ball:
    """Bound the angular acceleration at any rotation and its derivative, :eq:`eq-proof-field`."""
    return upper(corner.ratio * (abs(ground.weight[0]) + abs(ground.along[0])))
