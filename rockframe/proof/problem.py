"""The problem of a proof: a block and its ground, in balls around the floats of a run."""

from dataclasses import dataclass, field
from itertools import zip_longest
from typing import NamedTuple

from rockframe.dynamics.rigid_ground import BlockOnRigidGround, RockingCorner
from rockframe.proof.balls import ONE, ZERO, Ball, Row, ball, magnitude, taylor_shift
from rockframe.signals.motion import Incline, Motion
from rockframe.system.bodies import OverturningAngles


class Undecided(Exception):  # noqa: N818  (a result, no error)
    """Nothing is proved; the message is the reason."""


def require(proved: bool, reason: str) -> None:
    """Raise `Undecided` unless a condition is proved; a comparison of balls may be neither."""
    if not proved:
        raise Undecided(reason)


class Deviations(NamedTuple):
    """Deviations of inputs, of the block and its motion, from the given ones, as balls."""

    left_restitution: Ball = ZERO
    right_restitution: Ball = ZERO
    scale: Ball = ZERO
    left_angle: Ball = ZERO  # theta, with the limit of the rotation [rad]
    right_angle: Ball = ZERO

    @classmethod
    def within(cls, restitution: float, scale: float, angle: float) -> "Deviations":
        """Return the deviations within tolerances."""
        e, factor, lean = (ball(0, tolerance) for tolerance in (restitution, scale, angle))
        return cls(e, e, factor, lean, lean)

    @classmethod
    def of(
        cls,
        sign: int,
        *,
        restitution: Ball = ZERO,
        angle: Ball = ZERO,
        other_angle: Ball = ZERO,
        scale: Ball = ZERO,
    ) -> "Deviations":
        """Make deviations by the corner that bears at a sign of the rotation, and the other one."""
        if sign > 0:
            return cls(ZERO, restitution, scale, other_angle, angle)
        return cls(restitution, ZERO, scale, angle, other_angle)

    @property
    def exact(self) -> bool:
        """Whether all of them are single numbers."""
        return all(deviation.is_exact() for deviation in self)

    def halves(self, influences: list[float]) -> "tuple[Deviations, Deviations]":
        """Halve the set along the input of greatest influence, or the widest if none has any."""
        sizes = influences if any(influences) else [float(deviation.rad()) for deviation in self]
        j = sizes.index(max(sizes))
        half = self[j].rad() / 2
        low, high = (self[j].mid() + sign * half + ball(0, half) for sign in (-1, 1))
        name = self._fields[j]
        return self._replace(**{name: low}), self._replace(**{name: high})

    def restitution(self, sign: int) -> Ball:
        """Return the deviation of the restitution of the corner that bears at a sign."""
        return self.right_restitution if sign > 0 else self.left_restitution

    def angle(self, sign: int) -> Ball:
        """Return the deviation of the angle of the corner that bears at a sign of rotation."""
        return self.right_angle if sign > 0 else self.left_angle


class CornerNumbers(NamedTuple):
    """A corner on which a block rocks, by the numbers of :eq:`eq-rigid-rocking`."""

    sign: int  # of the rotation
    angle: Ball  # theta [rad]
    ratio: Ball  # R0/(I_O/m + R0^2) [1/m]
    restitution: Ball  # coefficient of restitution of an impact on this corner
    limit: Ball  # rotation that counts as overturning [rad]

    @classmethod
    def of(
        cls, sign: int, corner: RockingCorner, limit: float, inputs: Deviations
    ) -> "CornerNumbers":
        """Make a corner from the floats of a run and the deviations from them."""
        ratio = ball(corner.radius) / ball(corner.inertia)
        restitution = ball(corner.restitution) + inputs.restitution(sign)
        lean = inputs.angle(sign)
        return cls(sign, ball(corner.angle) + lean, ratio, restitution, ball(limit) + lean)

    def middle(self) -> "CornerNumbers":
        """Return the corner with the middles of its uncertain numbers."""
        return self._replace(angle=self.angle.mid(), restitution=self.restitution.mid())


class GroundPiece(NamedTuple):
    """Ground acceleration along the base, and normal to it plus gravity: polynomials of time."""

    along: Row
    normal: Row
    spread: "GroundSpread | None" = None  # None where the scale is a single number

    def at(self, time: Ball) -> "GroundPiece":
        """Return the polynomials about another time, or about all times of a ball [s]."""
        spread = None if self.spread is None else self.spread.at(time)
        return GroundPiece(taylor_shift(self.along, time), taylor_shift(self.normal, time), spread)

    def rates(self) -> "GroundPiece":
        """Return the rates of both accelerations at the origin of the polynomials."""
        along, normal = ([*row[1:2], ZERO][:1] for row in (self.along, self.normal))
        return GroundPiece(along, normal)

    def union(self, other: "GroundPiece") -> "GroundPiece":
        """Enclose the coefficients of both this and another piece."""
        spread = None
        if self.spread is not None and other.spread is not None:
            middle = self.spread.middle.union(other.spread.middle)
            spread = GroundSpread(middle, self.spread.by_scale.union(other.spread.by_scale))
        rows = ((self.along, other.along), (self.normal, other.normal))
        along, normal = (
            [a.union(b) for a, b in zip_longest(*pair, fillvalue=ZERO)] for pair in rows
        )
        return GroundPiece(along, normal, spread)

    @property
    def middle(self) -> "GroundPiece":
        """The ground for the middle of the scales."""
        return self if self.spread is None else self.spread.middle


class GroundSpread(NamedTuple):
    """The dependence of the ground on the scale of the motion."""

    middle: GroundPiece  # for the middle of the scales
    by_scale: GroundPiece  # derivative by the scale

    def at(self, time: Ball) -> "GroundSpread":
        """Return the polynomials about another time."""
        return GroundSpread(self.middle.at(time), self.by_scale.at(time))


@dataclass(frozen=True)
class PiecewiseGround:
    """A motion of the ground, a polynomial between two samples, and still ground after it."""

    motion: Motion
    scale: Ball
    slope: Incline
    still_step: float  # length of the intervals of still ground after the motion [s]
    _known: dict[int, GroundPiece] = field(default_factory=dict[int, GroundPiece], kw_only=True)

    @property
    def count(self) -> int:
        """Number of intervals of the motion."""
        return self.motion.horizontal.samples.size - 1

    def length(self, interval: int) -> Ball:
        """Return the length of an interval [s]."""
        return ball(self.motion.time_step if interval < self.count else self.still_step)

    def time(self, interval: int, elapsed: Ball) -> Ball:
        """Return the time since the first sample [s]."""
        moving, still = min(interval, self.count), max(0, interval - self.count)
        return moving * ball(self.motion.time_step) + still * ball(self.still_step) + elapsed

    def is_continuous_after(self, interval: int) -> bool:
        """Whether the ground acceleration is proved continuous at the end of an interval."""
        components = [
            component for component in (self.motion.horizontal, self.motion.vertical) if component
        ]
        lines = all(component.polynomials is None for component in components)
        ends = interval == self.count - 1 and any(
            component.samples[-1] != 0.0 for component in components
        )
        return interval >= self.count or (lines and not ends)

    def ground(self, interval: int) -> GroundPiece:
        """Return the ground in an interval, by time since its start, :eq:`eq-incline-ground`."""
        interval = min(interval, self.count)
        if interval not in self._known:
            gravity = ball(self.slope.gravity)
            piece = self._scaled_ground(interval, self.scale, gravity)
            if not self.scale.is_exact():
                middle = self._scaled_ground(interval, self.scale.mid(), gravity)
                by_scale = self._scaled_ground(interval, ONE, ZERO)
                piece = piece._replace(spread=GroundSpread(middle, by_scale))
            self._known[interval] = piece
        return self._known[interval]

    def _scaled_ground(self, interval: int, scale: Ball, gravity: Ball) -> GroundPiece:
        across, up = (
            self._component(interval, scale, vertical=vertical) for vertical in (False, True)
        )
        if self.slope.level:
            return GroundPiece(across, [gravity + up[0], *up[1:]])
        sine, cosine = ball(self.slope.inclination).sin_cos()
        pairs = list(zip_longest(across, up, fillvalue=ZERO))
        along = [x * cosine + y * sine for x, y in pairs]
        normal = [y * cosine - x * sine for x, y in pairs]
        return GroundPiece(
            [along[0] + gravity * sine, *along[1:]], [normal[0] + gravity * cosine, *normal[1:]]
        )

    def _component(self, interval: int, scale: Ball, *, vertical: bool) -> Row:
        """Return a component of the motion as a polynomial of time."""
        signal = self.motion.vertical if vertical else self.motion.horizontal
        if signal is None or interval >= self.count:
            return [ZERO]
        if signal.polynomials is None:
            first, last = (ball(float(signal.samples[interval + end])) for end in (0, 1))
            row = [first, last - first]
        else:
            row = [ball(float(coefficient)) for coefficient in signal.polynomials[interval]]
        step = self.length(interval)
        return [scale * coefficient / step**power for power, coefficient in enumerate(row)]

    def ground_over(self, interval: int, elapsed: Ball, span: Ball) -> GroundPiece:
        """Enclose the ground at all times of a span that starts in an interval [s]."""
        enclosure: GroundPiece | None = None
        while True:
            left = self.length(interval) - elapsed
            inside = ZERO.union(span) if span < left else ZERO.union(left)
            piece = self.ground(interval).at(elapsed + inside)
            enclosure = piece if enclosure is None else enclosure.union(piece)
            if span < left:
                return enclosure
            span, interval, elapsed = span - left, interval + 1, ZERO


@dataclass(frozen=True)
class Problem(PiecewiseGround):
    """A block under a motion."""

    right: CornerNumbers
    left: CornerNumbers
    frequency: float  # p of the faster corner [1/s]

    @classmethod
    def of(
        cls,
        block: BlockOnRigidGround,
        motion: Motion,
        slope: Incline,
        limits: OverturningAngles,
        scale: float,
        inputs: Deviations,
        still_step: float,
    ) -> "Problem":
        """Make a problem from the floats of a run and the deviations from them.

        `still_step` is times p here.
        """
        fastest = max(corner.radius / corner.inertia for corner in (block.left, block.right))
        frequency = (slope.gravity * fastest) ** 0.5
        return cls(
            motion, ball(scale) + inputs.scale, slope, still_step / frequency,
            CornerNumbers.of(1, block.right, limits.right, inputs),
            CornerNumbers.of(-1, block.left, limits.left, inputs), frequency,
        )  # fmt: skip

    def uncertain(self) -> Deviations:
        """Return the deviations of the inputs from the middles of their balls."""
        left, right = self.left, self.right
        inputs = left.restitution, right.restitution, self.scale, left.angle, right.angle
        return Deviations(*(value - value.mid() for value in inputs))

    def corner(self, sign: int) -> CornerNumbers:
        """Return the corner that bears while the rotation has a sign."""
        return self.right if sign > 0 else self.left


def acceleration(rotation: Ball, corner: CornerNumbers, ground: GroundPiece) -> Ball:
    """Return the angular acceleration, with the ground at the origin of its polynomials."""
    sine, cosine = (corner.angle * corner.sign - rotation).sin_cos()
    return -corner.ratio * (ground.normal[0] * sine + ground.along[0] * cosine)


def stiffness(rotation: Ball, corner: CornerNumbers, ground: GroundPiece) -> Ball:
    """Return the derivative of the angular acceleration with respect to the rotation."""
    sine, cosine = (corner.angle * corner.sign - rotation).sin_cos()
    return corner.ratio * (ground.normal[0] * cosine - ground.along[0] * sine)


def acceleration_bound(corner: CornerNumbers, ground: GroundPiece) -> Ball:
    """Bound the angular acceleration at any rotation and its derivative, :eq:`eq-proof-field`."""
    return magnitude(corner.ratio * (abs(ground.normal[0]) + abs(ground.along[0])))
