"""The course of a set of states from the first sample to what is sure for ever."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from rockframe.proof.balls import UNIT, ZERO, Ball, Row, ball, slope, value
from rockframe.proof.flow import Sweep, advance, flow, jerk
from rockframe.proof.impacts import Struck, resting_after, struck
from rockframe.proof.problem import CornerNumbers, GroundPiece, Problem, Undecided
from rockframe.proof.standing import lifts
from rockframe.proof.states import SetOfStates

SHORTEST: Final = 2.0**-30
"""Step over an interval of the motion below which nothing is decided any more."""
FINE: Final = 2.0**-6
"""Share of an interval in steps of which the overturning angle is approached."""
WIDEST: Final = 0.3
"""Width of a set, over theta, beyond which nothing is told of it any more."""
AT_KNOT: Final = 1e-10
"""Share of an interval within which an impact is taken to be at its end."""
SLOW: Final = 0.02
"""Speed after an impact, over p, below which coming to rest is tried."""
LONGEST_TAIL: Final = 60.0
"""Time after the motion, times p, after which a block near its crest is given up."""
_SAMPLES: Final = 24
_HALVINGS: Final = 40
_NARROWINGS: Final = 60

Watch = Callable[[int, Ball, int, Row], None]
"""Is told every enclosure: number of the interval, time in it, side (0 at rest), box."""


@dataclass
class Course:
    """Where the set is; times are those since the start of an interval of the motion."""

    problem: Problem
    watch: Watch | None = None
    uncertain: Row = field(default_factory=list[Ball])
    number: int = 0  # of the interval
    after: Ball = ZERO  # its start
    sign: int = 0  # of the rotation; 0 at rest
    states: SetOfStates = field(default_factory=lambda: SetOfStates.about([ZERO, ZERO], []))
    fresh: bool = False  # whether it has just left the upright position
    beyond: tuple[Ball, Ball] | None = None  # when it may first be beyond the overturning angle
    impacts: int = 0
    widest: float = 0.0

    @property
    def corner(self) -> CornerNumbers:
        """The corner that bears."""
        return self.problem.corner(self.sign)

    @property
    def time(self) -> Ball:
        """Time since the first sample [s]."""
        return self.problem.time(self.number, self.after)

    def start(self, rotation: float, rate: float) -> None:
        """Begin at rest, or in motion."""
        if rotation == 0.0 and rate == 0.0:
            return
        self.sign = 1 if (rotation or rate) > 0.0 else -1
        self.fresh = rotation == 0.0
        self.states = SetOfStates.about([ball(rotation), ball(rate)], self.uncertain)

    def overturns(self) -> bool:
        """Go on until it is sure whether it overturns; `beyond` is then when."""
        while True:
            verdict = self._stands() if self.sign == 0 else self._rocks()
            if verdict is not None:
                return verdict

    # ---- standing

    def _stands(self) -> bool | None:
        """Stand to the end of an interval, or lift, :eq:`eq-proof-uplift`; tell if it stays."""
        ground = self.problem.ground(self.number).at(self.after)
        left = self.problem.length(self.number) - self.after
        lift = lifts(self.problem, ground, left)
        if lift is None:
            if self.number >= self.problem.count:
                return False
            self._move(left, to_end=True)
            return None
        at, self.sign = lift
        ground, length = ground.at(at), left - at
        still = SetOfStates.about([ZERO, ZERO], self.uncertain)
        for halvings in range(_HALVINGS):
            try:
                self.states, sweep = advance(still, self.corner, ground, length)
            except Undecided:
                length = (length / 2).mid()
                continue
            rises = sweep.acceleration * self.sign > 0
            during = ground.at(UNIT * length)
            below = sweep.rotation * self.sign < self.corner.limit
            if below and (rises or jerk(sweep, self.corner, during) * self.sign > 0):
                self.fresh = False
                self._move(at + length, to_end=halvings == 0)
                return None
            length = (length / 2).mid()
        message = "an uplift of which it is not sure to which side it goes"
        raise Undecided(message)

    # ---- rocking

    def _rocks(self) -> bool | None:
        """Make one step, and the impact at its end if there is one."""
        corner, length = self.corner, self.problem.length(self.number)
        ground = self.problem.ground(self.number).at(self.after)
        left = length - self.after
        strike = self._predicted(ground, left)
        to_end = strike is None or float((left - strike).mid()) < AT_KNOT * float(length)
        step: Ball = left if to_end else strike
        strikes = strike is not None
        shorter, at_sample = step, False
        impact: Struck | None = None
        while True:
            try:
                new, sweep = self._step(ground, step, strikes=strikes)
                near = self._nears(new, sweep)
                if not (near and float(step.mid()) > FINE * float(length)):
                    if strikes:
                        impact = self._struck(new, ground.at(step), step, left, to_end=to_end)
                    break
            except Undecided:
                if float(step.mid()) < SHORTEST * float(length):
                    raise
                if self.uncertain and not at_sample:  # some may strike before, some after it
                    step, to_end, strikes, at_sample = left, True, True, True
                    continue
            shorter = (shorter / 2).mid()
            step, to_end, strikes = shorter, False, False
        if near and self.beyond is None:
            self.beyond = self.time, self.time
        if self.beyond is not None and new.box()[0] * self.sign > corner.limit:
            self._narrow(ground, step, rises=sweep.rate * self.sign > 0)
            return True
        self.states, self.fresh = new if impact is None else impact.states, strikes
        if impact is not None:
            self.sign, self.impacts = -self.sign, self.impacts + 1
        self._move(step, to_end=to_end)
        if impact is not None:
            self._come_to_rest(impact)
        return self._settled() if self.number >= self.problem.count and self.sign else None

    def _move(self, step: Ball, *, to_end: bool) -> None:
        self.number, self.after = (self.number + 1, ZERO) if to_end else (
            self.number, self.after + step
        )  # fmt: skip
        box = self.states.box()
        radius = box[0].rad()
        self.widest = max(self.widest, float(radius))
        if self.watch is not None:
            self.watch(self.number, self.after, self.sign, box)
        if self.sign and not radius < WIDEST * self.corner.angle:
            message = "the enclosure has become as wide as the rotations themselves"
            raise Undecided(message)

    def _predicted(self, ground: GroundPiece, left: Ball) -> Ball | None:
        """Guess when the middle of the set strikes, None if not; nothing is proved by it."""
        span, centre, corner = float(left.mid()), self.states.centre, self.corner
        place, rate = (float(each.mid()) * self.sign for each in centre)
        pull = float(abs(ground.weight[0]).upper() + abs(ground.along[0]).upper())
        most = 2.0 * float(corner.ratio.mid()) * pull
        if not self.fresh and place > abs(rate) * span + most * span * span:
            return None
        for _ in range(_HALVINGS):
            try:
                during = ground.at(UNIT * left)
                exact = flow(centre, self.states.box(), corner, ground, during, left).angle
                break
            except Undecided:
                left = (left / 2).mid()
        else:
            return None
        exact = [each.mid() for each in exact]
        row = [float(each) * self.sign for each in exact]
        row = row[1:] if self.fresh else row
        places = (k / _SAMPLES for k in range(1, _SAMPLES + 1))
        high = next((x for x in places if _value(row, x) <= 0.0), None)
        if high is None:
            return None
        low = max(0.0, high - 1.0 / _SAMPLES)
        for _ in range(_NARROWINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if _value(row, middle) > 0.0 else (low, middle)
        guess, rates = ball(0.5 * (low + high)), slope(exact)
        for _ in range(6):
            change: Ball = (value(exact, guess) / value(rates, guess)).mid()
            if not abs(change) < guess / 2:
                break
            guess = (guess - change).mid()
        return (guess * left).mid() if guess < 1 else left

    def _step(self, ground: GroundPiece, step: Ball, *, strikes: bool) -> tuple[SetOfStates, Sweep]:
        """Step, and prove that the rotation keeps its sign until an impact near the end."""
        new, sweep = advance(self.states, self.corner, ground, step)
        # a rotation that is positive at the start, :eq:`eq-proof-sign`
        s = self.sign
        stays = sweep.rotation * s > 0 or sweep.rate * s > 0
        falls = sweep.rate * s < 0 or sweep.acceleration * s < 0
        if strikes and falls:
            return new, sweep
        if strikes or not (stays or (falls and new.box()[0] * s > 0)):
            message = "whether the block meets the ground is not resolved"
            raise Undecided(message)
        return new, sweep

    def _nears(self, new: SetOfStates, sweep: Sweep) -> bool:
        """Tell whether the overturning angle may be reached in a step."""
        s, limit = self.sign, self.corner.limit
        if sweep.rotation * s < limit:
            return False
        steady = sweep.rate * s > 0 or sweep.rate * s < 0
        ends = self.states.box()[0], new.box()[0]
        return not (steady and all(one * s < limit for one in ends))

    def _narrow(self, ground: GroundPiece, step: Ball, *, rises: bool) -> None:
        """Narrow the interval in which the overturning angle is first reached."""
        begin, low, high = self.time, ZERO, step
        assert self.beyond is not None  # noqa: S101
        if rises and self.states.box()[0] * self.sign < self.corner.limit:
            for _ in range(_NARROWINGS):
                middle = ((low + high) / 2).mid()
                there = advance(self.states, self.corner, ground, middle)[0].box()[0] * self.sign
                if there < self.corner.limit:
                    low = middle
                elif there > self.corner.limit:
                    high = middle
                else:
                    break
        first = begin + low if self.beyond[0] >= begin else self.beyond[0]
        self.beyond = first, begin + high

    def _struck(
        self, states: SetOfStates, ground: GroundPiece, step: Ball, left: Ball, *, to_end: bool
    ) -> Struck:
        """Let the set strike the ground at the end of a step."""
        following = self.problem.ground(self.number + 1) if to_end else ground
        new = self.problem.corner(-self.sign)
        impact = struck(states, self.corner, new, ground, following)
        near = impact.at.contains(0) or abs(impact.at) < 2 * AT_KNOT * self.problem.length(
            self.number
        )
        if not (near if to_end else step + impact.at < left):
            message = "an impact at a sample of the motion"
            raise Undecided(message)
        return impact

    def _come_to_rest(self, impact: Struck) -> None:
        """Let a slow block under a weak motion come to rest."""
        problem = self.problem
        if float(impact.speed) > SLOW * problem.frequency or self.number >= problem.count:
            return
        span = resting_after(impact, problem, self.number, self.after)
        if span is None:
            return
        self.sign, self.states = 0, SetOfStates.about([ZERO, ZERO], [])
        self.after += span
        while not self.after < problem.length(self.number):
            if not self.after >= problem.length(self.number):
                message = "a rest at a sample of the motion"
                raise Undecided(message)
            self.after, self.number = self.after - problem.length(self.number), self.number + 1

    # ---- what is sure

    def _settled(self) -> bool | None:
        """Tell whether a block on still ground stands for ever, :eq:`eq-proof-energy`."""
        problem, near, far = self.problem, self.corner, self.problem.corner(-self.sign)
        still = problem.ground(self.number)
        rotation, rate = self.states.box()
        energy = rate * rate / 2 + _potential(rotation, near, still)
        steep = [_potential(one.limit * one.sign, one, still) for one in (near, far)]
        e, back = far.restitution, near.restitution
        lasting = energy < steep[0] and e * e * energy < steep[1] and e * back <= 1
        if lasting and rotation * self.sign < near.limit:
            if self.beyond is not None:
                message = "whether it passed its overturning angle is not resolved"
                raise Undecided(message)
            return False
        tail = problem.time(self.number, ZERO) - problem.time(problem.count, ZERO)
        if tail * problem.frequency > LONGEST_TAIL:
            message = "after the motion it stays near its crest"
            raise Undecided(message)
        return None


def _potential(rotation: Ball, corner: CornerNumbers, still: GroundPiece) -> Ball:
    """Give the energy at a rotation over that at none, for a block that turns on one corner."""
    lean = corner.angle * corner.sign
    rise = (lean - rotation).cos() - lean.cos()
    shift = (lean - rotation).sin() - lean.sin()
    return corner.ratio * (still.weight[0] * rise - still.along[0] * shift)


def _value(row: list[float], at: float) -> float:
    result = 0.0
    for each in reversed(row):
        result = result * at + each
    return result
