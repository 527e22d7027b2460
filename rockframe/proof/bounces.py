"""Small bounces at the end of rocking: bounds of all members of a set, whatever their order.

If excursions are smaller than the width of a set of states, its members strike at different times
and single impacts cannot be enclosed. Their speeds and heights can: :eq:`eq-proof-bounces`.
"""

from dataclasses import dataclass, replace
from typing import Final, NamedTuple

from rockframe.proof.balls import UNIT, ZERO, Ball, Row, ball, hull, upper
from rockframe.proof.problem import (
    GroundPiece,
    Problem,
    Undecided,
    acceleration,
    stiffness,
    strongest,
)
from rockframe.proof.standing import lifts_in

_WINDOWS: Final = 200
"""Largest number of windows, of at most an interval each, over which bounces are followed."""
_GUESSES: Final = 12
_LIFTING: Final = 1.5
"""Time by which all members have lifted, over the time of their last impacts."""


class Instant(NamedTuple):
    """A time, by the number of its interval of the motion and the time since its start [s]."""

    number: int
    after: Ball

    def later(self, problem: Problem, span: Ball) -> "Instant":
        """Return the instant after a span of time [s]."""
        number, after = self.number, self.after + span
        while not after < problem.length(number):
            if not after >= problem.length(number):
                message = "small bounces that end at a sample of the motion"
                raise Undecided(message)
            after, number = after - problem.length(number), number + 1
        return Instant(number, after)


class Lifted(NamedTuple):
    """The state of all members after they have lifted to one side, without further impact."""

    instant: Instant
    sign: int  # of the rotation
    box: Row  # enclosure of rotation and rate


@dataclass(frozen=True)
class Pull:
    """Bounds of the angular acceleration back to upright on one corner, over a window of time."""

    least: Ball  # its least value; negative where the ground lifts the block
    most: Ball  # its largest absolute value
    faster: Ball  # bound of the rate at which it grows

    @classmethod
    def of(cls, problem: Problem, sign: int, height: Ball, ground: GroundPiece) -> "Pull":
        """Bound it for all rotations up to `height`, and for all values of the ground."""
        corner = problem.corner(sign)
        rotation = UNIT * height * sign
        pull = -sign * acceleration(rotation, corner, ground)
        grows = -sign * acceleration(rotation, corner, ground.rates())
        faster = ball(grows.upper()) if grows.upper() > 0 else ZERO
        return cls(ball(pull.lower()), upper(pull), faster)


def settle(
    problem: Problem, instant: Instant, height: Ball, speed: Ball
) -> "Instant | Lifted | None":
    """Follow bounces from bounds of rotation and rate until all members rest, or all have lifted.

    Returns the instant after which all are at rest, or their state after lifting, or None if
    neither is proved.
    """
    ground = problem.ground(instant.number).at(instant.after)
    pulls = [Pull.of(problem, sign, height, ground) for sign in (1, -1)]
    if not all(pull.least > 0 for pull in pulls):
        return None
    energetic = (speed * speed + 2 * height * hull([pull.most for pull in pulls])).sqrt()
    bounds = _Bounds(problem, upper(height), upper(energetic))
    for _ in range(_WINDOWS):
        if instant.number >= problem.count:
            return None
        left = problem.length(instant.number) - instant.after
        ground = problem.ground(instant.number).at(instant.after)
        lift = lifts_in(problem, instant.number, ground, left)
        longest = left if lift is None else ZERO.max(lift[0].lower())
        window = longest
        for _ in range(_GUESSES):
            found = bounds.over(ground.at(UNIT * window), window)
            if found is not None:
                break
            window = (window / 2).mid()
        else:
            return None
        if isinstance(found, _Bounds):
            bounds = found
        else:
            return instant.later(problem, found)
        whole = window is longest
        if whole and lift is None:
            bounds = bounds.jumped(instant.number)
            instant = Instant(instant.number + 1, ZERO)
        else:
            instant = instant.later(problem, window)
        if whole and lift is not None:
            waited = lift[0].upper() - lift[0].lower()
            return _lifted(problem, instant, lift[1], ball(waited), bounds)
    return None


@dataclass(frozen=True)
class _Bounds:
    """Bounds of all members: of the rotation, and of the speed that is still to be lost."""

    problem: Problem
    height: Ball  # bound of the rotation [rad]
    left: Ball  # bound of the angular velocity that is still to be lost [s^-1]

    @property
    def restitution(self) -> Ball:
        """The greater coefficient of restitution of both corners."""
        return upper(self.problem.right.restitution.union(self.problem.left.restitution))

    @property
    def speed(self) -> Ball:
        """Bound of the speed now, and of the speed at the next impact."""
        return upper(self.left / self.restitution)

    def jumped(self, number: int) -> "_Bounds":
        """Return the bounds after an interval, at whose end the ground may jump."""
        if self.problem.joins(number):
            return self
        before = self.problem.ground(number).at(self.problem.length(number))
        after = self.problem.ground(number + 1)
        change = GroundPiece(
            [after.along[0] - before.along[0]], [after.weight[0] - before.weight[0]]
        )
        corners = self.problem.right, self.problem.left
        most = hull([strongest(corner, change) for corner in corners])
        return replace(self, left=upper(self.left + (2 * self.height * upper(most)).sqrt()))

    def over(self, ground: GroundPiece, window: Ball) -> "_Bounds | Ball | None":
        """Follow the members over a window, :eq:`eq-proof-bounces`.

        Returns the bounds at its end, or the time after which all are at rest [s], or None if
        the window is too long.
        """
        e = self.restitution
        reach = upper(self.height + 2 * self.speed * window)
        pulls = [Pull.of(self.problem, sign, reach, ground) for sign in (1, -1)]
        limits = self.problem.right.limit, self.problem.left.limit
        if not (e < 1 and all(reach < limit for limit in limits)):
            return None
        growth, push = ZERO, ZERO
        for pull in pulls:
            if pull.least > 0:
                growth = upper(growth.union(pull.faster / pull.least))
            elif pull.faster > 0:
                return None
            else:  # the window ends as the ground begins to lift the block
                push = upper(push.union(-pull.least))
        root = upper((growth * window / (2 * e)).exp())
        left = upper((self.left + (2 * push * reach).sqrt() + push * window) * root)
        if not left <= 2 * self.left:  # else they may go beyond `reach`
            return None
        least = ball(min((pull.least.lower() for pull in pulls), key=float))
        if least > 0:
            lost = (1 - e) * least / 2
            rest = upper(left / lost)
            if rest < window:
                return rest
            left = upper(left - lost * window)
            low = upper((left / e) ** 2 / (2 * least))
            reach = low if low < reach else reach
        return _Bounds(self.problem, reach, left)


def _lifted(
    problem: Problem, instant: Instant, sign: int, waited: Ball, bounds: _Bounds
) -> Lifted | None:
    """Follow all members from the first time at which the ground lifts any of them, to one side.

    `bounds` hold at that time, `waited` is how much later the last one lifts; :eq:`eq-proof-swept`.
    """
    corner, speed = problem.corner(sign), bounds.speed
    span = 2 * waited + speed / problem.frequency
    for _ in range(_GUESSES):
        ground = problem.ground_over(instant.number, instant.after, span)
        lifting = sign * acceleration(ZERO, corner, ground.rates())
        if not lifting > 0:
            return None
        slowest, fastest = ball(lifting.lower()), upper(lifting)
        reach = upper(bounds.height + (3 * speed + fastest * span * span) * span)
        back = Pull.of(problem, -sign, reach, ground)
        stiff = stiffness(UNIT * reach * sign, corner, ground)
        limits = problem.right.limit, problem.left.limit
        if not (back.least > 0 and stiff > 0 and all(reach < limit for limit in limits)):
            return None
        root = upper((back.faster / back.least * span / 2).exp())
        down = upper((speed + fastest * waited * waited) * root)
        last = upper((2 * down / slowest).sqrt() + 2 * down * root / back.least)
        up = upper(speed * root + (fastest * span / 2 + upper(stiff) * reach) * span)
        if not (root < 2 and bounds.height + up * span < reach):
            return None
        needed = waited + _LIFTING * last
        if needed < span:
            end = instant.later(problem, span)
            if not all(problem.joins(number) for number in range(instant.number, end.number)):
                return None
            after = span - waited
            slow = slowest * (after * after - last * last) / 2
            rates = ball(slow.lower()).union(up)
            return Lifted(end, sign, [sign * UNIT * reach, sign * rates])
        span = (needed * 5 / 4).mid()
    return None
