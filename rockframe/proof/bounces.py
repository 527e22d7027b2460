"""Small bounces at the end of rocking: bounds of all members of a set, whatever their order.

If excursions are smaller than the width of a set of states, its members strike at different times
and single impacts cannot be enclosed. Their speeds and heights can: :eq:`eq-proof-bounces`.
"""

from dataclasses import dataclass, replace
from typing import Final, NamedTuple

from rockframe.proof.balls import UNIT, ZERO, Ball, Row, ball, hull, magnitude
from rockframe.proof.problem import (
    GroundPiece,
    Problem,
    acceleration,
    acceleration_bound,
    require,
    stiffness,
)
from rockframe.proof.uplift import find_uplift

_MAX_WINDOWS: Final = 200
"""Largest number of windows, of at most an interval each, over which bounces are followed."""
_MAX_GUESSES: Final = 12
_UPLIFT_TIME: Final = 1.5
"""Time by which all members have lifted, over the time of their last impacts."""


class Instant(NamedTuple):
    """A time, by the number of its interval of the motion and the time since its start [s]."""

    interval: int
    elapsed: Ball

    def later(self, problem: Problem, span: Ball) -> "Instant":
        """Return the instant after a span of time [s]."""
        interval, elapsed = self.interval, self.elapsed + span
        while not elapsed < problem.length(interval):
            require(
                elapsed >= problem.length(interval),
                "small bounces that end at a sample of the motion",
            )
            elapsed, interval = elapsed - problem.length(interval), interval + 1
        return Instant(interval, elapsed)


class UpliftState(NamedTuple):
    """The state of all members after they have lifted to one side, without further impact."""

    instant: Instant
    sign: int  # of the rotation
    box: Row  # enclosure of rotation and rate


@dataclass(frozen=True)
class RestoringAcceleration:
    """Bounds of the angular acceleration back to upright on one corner, over a window of time."""

    least: Ball  # its least value; negative where the ground lifts the block
    most: Ball  # its largest absolute value
    growth_rate: Ball  # bound of the rate at which it grows

    @classmethod
    def of(
        cls, problem: Problem, sign: int, height: Ball, ground: GroundPiece
    ) -> "RestoringAcceleration":
        """Bound it for all rotations up to `height`, and for all values of the ground."""
        corner = problem.corner(sign)
        rotation = UNIT * height * sign
        restoring = -sign * acceleration(rotation, corner, ground)
        grows = -sign * acceleration(rotation, corner, ground.rates())
        growth_rate = ball(grows.upper()) if grows.upper() > 0 else ZERO
        return cls(ball(restoring.lower()), magnitude(restoring), growth_rate)


def follow_bounces(
    problem: Problem, instant: Instant, height: Ball, speed: Ball
) -> "Instant | UpliftState | None":
    """Follow bounces from bounds of rotation and rate until all members rest, or all have lifted.

    Returns the instant after which all are at rest, or their state after lifting, or None if
    neither is proved.
    """
    ground = problem.ground(instant.interval).at(instant.elapsed)
    both_sides = [RestoringAcceleration.of(problem, sign, height, ground) for sign in (1, -1)]
    if not all(restoring.least > 0 for restoring in both_sides):
        return None
    energetic = (
        speed * speed + 2 * height * hull([restoring.most for restoring in both_sides])
    ).sqrt()
    bounds = _Bounds(problem, magnitude(height), magnitude(energetic))
    for _ in range(_MAX_WINDOWS):
        if instant.interval >= problem.count:
            return None
        left = problem.length(instant.interval) - instant.elapsed
        ground = problem.ground(instant.interval).at(instant.elapsed)
        lift = find_uplift(problem, instant.interval, ground, left)
        longest = left if lift is None else ZERO.max(lift[0].lower())
        window = longest
        for _ in range(_MAX_GUESSES):
            bounds_or_uplift = bounds.after_window(ground.at(UNIT * window), window)
            if bounds_or_uplift is not None:
                break
            window = (window / 2).mid()
        else:
            return None
        if isinstance(bounds_or_uplift, _Bounds):
            bounds = bounds_or_uplift
        else:
            return instant.later(problem, bounds_or_uplift)
        is_longest = window is longest
        if is_longest and lift is None:
            bounds = bounds.after_jump(instant.interval)
            instant = Instant(instant.interval + 1, ZERO)
        else:
            instant = instant.later(problem, window)
        if is_longest and lift is not None:
            if lift[0].is_zero():  # a jump of the ground lifts it, not a rise from zero
                return None
            delay = lift[0].upper() - lift[0].lower()
            return _uplift_state(problem, instant, lift[1], ball(delay), bounds)
    return None


@dataclass(frozen=True)
class _Bounds:
    """Bounds of all members: of the rotation, and of the speed that is still to be lost."""

    problem: Problem
    height: Ball  # bound of the rotation [rad]
    remaining_speed: Ball  # bound of the angular velocity that is still to be lost [s^-1]

    @property
    def restitution(self) -> Ball:
        """The greater coefficient of restitution of both corners."""
        return magnitude(self.problem.right.restitution.union(self.problem.left.restitution))

    @property
    def speed(self) -> Ball:
        """Bound of the speed now, and of the speed at the next impact."""
        return magnitude(self.remaining_speed / self.restitution)

    def after_jump(self, interval: int) -> "_Bounds":
        """Return the bounds after an interval, at whose end the ground may jump."""
        if self.problem.is_continuous_after(interval):
            return self
        before = self.problem.ground(interval).at(self.problem.length(interval))
        after = self.problem.ground(interval + 1)
        change = GroundPiece(
            [after.along[0] - before.along[0]], [after.normal[0] - before.normal[0]]
        )
        corners = self.problem.right, self.problem.left
        most = hull([acceleration_bound(corner, change) for corner in corners])
        return replace(
            self,
            remaining_speed=magnitude(
                self.remaining_speed + (2 * self.height * magnitude(most)).sqrt()
            ),
        )

    def after_window(self, ground: GroundPiece, window: Ball) -> "_Bounds | Ball | None":
        """Follow the members over a window, :eq:`eq-proof-bounces`.

        Returns the bounds at its end, or the time after which all are at rest [s], or None if
        the window is too long.
        """
        e = self.restitution
        reach = magnitude(self.height + 2 * self.speed * window)
        both_sides = [
            RestoringAcceleration.of(self.problem, sign, reach, ground) for sign in (1, -1)
        ]
        limits = self.problem.right.limit, self.problem.left.limit
        if not (e < 1 and all(reach < limit for limit in limits)):
            return None
        growth, uplift_bound = ZERO, ZERO
        for restoring in both_sides:
            if restoring.least > 0:
                growth = magnitude(growth.union(restoring.growth_rate / restoring.least))
            elif restoring.growth_rate > 0:
                return None
            else:  # the window ends as the ground begins to lift the block
                uplift_bound = magnitude(uplift_bound.union(-restoring.least))
        root = magnitude((growth * window / (2 * e)).exp())
        left = magnitude(
            (self.remaining_speed + (2 * uplift_bound * reach).sqrt() + uplift_bound * window)
            * root
        )
        if not left <= 2 * self.remaining_speed:  # else they may go beyond `reach`
            return None
        least = ball(hull([restoring.least for restoring in both_sides]).lower())
        if least > 0:
            lost = (1 - e) * least / 2
            resting_time = magnitude(left / lost)
            if resting_time < window:
                return resting_time
            left = magnitude(left - lost * window)
            low = magnitude((left / e) ** 2 / (2 * least))
            reach = low if low < reach else reach
        return _Bounds(self.problem, reach, left)


def _uplift_state(
    problem: Problem, instant: Instant, sign: int, delay: Ball, bounds: _Bounds
) -> UpliftState | None:
    """Follow all members from the first time at which the ground lifts any of them, to one side.

    `bounds` hold at that time, `delay` is how much later the last one lifts; :eq:`eq-proof-swept`.
    """
    corner, speed = problem.corner(sign), bounds.speed
    span = 2 * delay + speed / problem.frequency
    for _ in range(_MAX_GUESSES):
        ground = problem.ground_over(instant.interval, instant.elapsed, span)
        lifting = sign * acceleration(ZERO, corner, ground.rates())
        if not lifting > 0:
            return None
        slowest, fastest = ball(lifting.lower()), magnitude(lifting)
        reach = magnitude(bounds.height + (3 * speed + fastest * span * span) * span)
        back = RestoringAcceleration.of(problem, -sign, reach, ground)
        stiff = stiffness(UNIT * reach * sign, corner, ground)
        limits = problem.right.limit, problem.left.limit
        if not (back.least > 0 and stiff > 0 and all(reach < limit for limit in limits)):
            return None
        root = magnitude((back.growth_rate / back.least * span / 2).exp())
        down = magnitude((speed + fastest * delay * delay) * root)
        last = magnitude((2 * down / slowest).sqrt() + 2 * down * root / back.least)
        up = magnitude(speed * root + (fastest * span / 2 + magnitude(stiff) * reach) * span)
        if not (root < 2 and bounds.height + up * span < reach):
            return None
        needed = delay + _UPLIFT_TIME * last
        if needed < span:
            end = instant.later(problem, span)
            if not all(
                problem.is_continuous_after(interval)
                for interval in range(instant.interval, end.interval)
            ):
                return None
            elapsed = span - delay
            slow = slowest * (elapsed * elapsed - last * last) / 2
            rates = ball(slow.lower()).union(up)
            return UpliftState(end, sign, [sign * UNIT * reach, sign * rates])
        span = (needed * 5 / 4).mid()
    return None
