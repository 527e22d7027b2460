"""The course of a set of states on rigid ground, from the first sample to a proved verdict."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final

from rockframe.dynamics.rigid_ground import BlockOnRigidGround
from rockframe.proof.balls import UNIT, ZERO, Ball, Row, ball, slope, upper, value
from rockframe.proof.bounces import Instant, Lifted, settle
from rockframe.proof.flow import Sweep, advance, flow, jerk, sweep
from rockframe.proof.impacts import Struck, struck
from rockframe.proof.problem import CornerNumbers, Deviations, GroundPiece, Problem, Undecided
from rockframe.proof.sets import concluded, proved
from rockframe.proof.standing import lifts_in
from rockframe.proof.states import SetOfStates
from rockframe.proof.verdict import EXACT, Proof, Tolerances
from rockframe.signals import Motion
from rockframe.signals.motion import Slope
from rockframe.system.bodies import OverturningAngles

SHORTEST: Final = 2.0**-30
"""Step over an interval of the motion below which a proof is given up."""
FINE: Final = 2.0**-6
"""Step near the overturning angle, over an interval of the motion."""
FINE_OF_SET: Final = 2.0**-3
"""Step near the overturning angle for a set of inputs, whose times of overturning differ anyway."""
WIDEST: Final = 0.3
"""Radius of a set, over theta, beyond which a proof is given up."""
AT_KNOT: Final = 1e-10
"""Share of an interval within which an impact is taken to be at its end."""
SLOW: Final = 0.02
"""Rate after an impact, over p, below which it is tried to prove that bounces end in rest."""
LONGEST_TAIL: Final = 60.0
"""Time after the motion, times p, after which a proof is given up: the block is near its crest."""
STILL_STEP: Final = 0.1
"""Length of the intervals of still ground after a motion, times p."""
_LAW: Final = "Housner's law"
_UNSURE: Final = "an uplift of which it is not sure to which side it goes"
_SAMPLES: Final = 24
_HALVINGS: Final = 40
_NARROWINGS: Final = 60

Watch = Callable[[int, Ball, int, Row], None]
"""A function called with each enclosure: interval, time in it, side (0 at rest), box."""


@dataclass
class Course:
    """The set of states that is followed; times are since the start of an interval [s]."""

    problem: Problem
    watch: Watch | None = None
    uncertain: Sequence[Ball] = ()  # uncertain inputs less their middles
    number: int = 0  # number of the present interval of the motion
    after: Ball = ZERO  # time since its start
    sign: int = 0  # sign of the rotation; 0 at rest
    states: SetOfStates = field(default_factory=lambda: SetOfStates.about([ZERO, ZERO], []))
    fresh: bool = False  # whether it has just left the upright position
    beyond: tuple[Ball, Ball] | None = None  # from when to when it may pass the overturning angle
    impact: Struck | None = None  # its last impact, as long as members may still have it
    impacts: int = 0  # number of impacts enclosed one by one
    widest: float = 0.0  # largest radius of a rotation so far [rad]

    @property
    def corner(self) -> CornerNumbers:
        """The corner that bears."""
        return self.problem.corner(self.sign)

    @property
    def time(self) -> Ball:
        """Time since the first sample [s]."""
        return self.problem.time(self.number, self.after)

    def start(self, rotation: float, rate: float) -> None:
        """Set the state at the start: rotation [rad] and rate [rad s^-1]."""
        if rotation == 0.0 and rate == 0.0:
            return
        self.sign = 1 if (rotation or rate) > 0.0 else -1
        self.fresh = rotation == 0.0
        self.states = SetOfStates.about([ball(rotation), ball(rate)], self.uncertain)

    def overturns(self) -> bool:
        """Follow the set until it is proved whether it overturns; `beyond` holds the time.

        Raises `Undecided` if that cannot be proved.
        """
        while True:
            verdict = self._stands() if self.sign == 0 else self._rocks()
            if verdict is not None:
                return verdict

    # ---- standing

    def _stands(self) -> bool | None:
        """Follow a block at rest to the end of an interval or to uplift, :eq:`eq-proof-uplift`.

        Gives False if it stays at rest for ever, else None.
        """
        problem = self.problem
        ground, left = problem.ground(self.number).at(self.after), self._left()
        lift = lifts_in(problem, self.number, ground, left)
        if lift is None:
            if self.number >= problem.count:
                return False
            self._move(left, to_end=True)
            return None
        at, self.sign = lift
        latest = ball(at.upper())
        if at < left:
            during, ground = ground.at(at), ground.at(latest)
        elif not problem.joins(self.number):
            raise Undecided(_UNSURE)
        else:  # some members lift before the sample, some after it
            self.number, self.after, latest = self.number + 1, ZERO, latest - left
            following = problem.ground(self.number)
            before = ground.at(ball(at.lower()).union(left))
            during = before.united(following.at(ZERO.union(latest)))
            ground, left = following.at(latest), self._left()
        start, length = self._lifted(during, at.upper() - at.lower()), left - latest
        for halvings in range(_HALVINGS):
            try:
                self.states, swept = advance(start, self.corner, ground, length)
            except Undecided:
                length = (length / 2).mid()
                continue
            rises = swept.acceleration * self.sign > 0
            during = ground.at(UNIT * length)
            below = swept.rotation * self.sign < self.corner.limit
            if below and (rises or jerk(swept, self.corner, during) * self.sign > 0):
                self.fresh = False
                self._move(latest + length, to_end=halvings == 0)
                return None
            length = (length / 2).mid()
        raise Undecided(_UNSURE)

    def _left(self) -> Ball:
        """Return the time to the end of the interval."""
        return self.problem.length(self.number) - self.after

    def _lifted(self, during: GroundPiece, waited: Ball) -> SetOfStates:
        """Enclose all members at the time at which the last one lifts, :eq:`eq-proof-lifted`."""
        still = [ZERO, ZERO]
        if waited > 0:
            third = jerk(sweep(still, self.corner, during, UNIT * waited), self.corner, during)
            if not third * self.sign > 0:
                raise Undecided(_UNSURE)
            risen = [waited**3 / 6, waited**2 / 2]
            still = [UNIT * (upper(third) * each) * self.sign for each in risen]
        return SetOfStates.about(still, self.uncertain)

    # ---- rocking

    def _rocks(self) -> bool | None:
        """Make one step and, if there is one, the impact at its end; give a verdict or None."""
        corner, length = self.corner, self.problem.length(self.number)
        fine = (FINE_OF_SET if self.uncertain else FINE) * float(length)
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
                new, swept = self._step(ground, step, strikes=strikes)
                near = self._nears(new, swept)
                if not (near and float(step.mid()) > fine):
                    if strikes:
                        impact = self._struck(new, ground.at(step), step, left, to_end=to_end)
                    break
            except Undecided:
                if float(step.mid()) < SHORTEST * float(length):
                    if self._bounce(lift=True):
                        return None
                    raise
                if self.uncertain and not at_sample:  # members may strike before and after it
                    step, to_end, strikes, at_sample = left, True, True, True
                    continue
            shorter = (shorter / 2).mid()
            step, to_end, strikes = shorter, False, False
        if near and self.beyond is None:
            self.beyond = self.time, self.time
        if self.beyond is not None and new.box()[0] * self.sign > corner.limit:
            self._narrow(ground, step, rises=swept.rate * self.sign > 0)
            return True
        self.states, self.fresh = new if impact is None else impact.states, strikes
        if impact is not None:
            self.sign, self.impacts = -self.sign, self.impacts + 1
        self._move(step, to_end=to_end)
        if impact is not None:
            self.impact = impact
            self._bounce()
        elif self.impact is not None:  # some members may not have struck yet
            late = self.impact.at - step
            self.impact = None if late < 0 else self.impact._replace(at=late)
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
        """Estimate when the middle of the set strikes, None if it does not; proves nothing."""
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
        high = next((x for x in places if value(row, x) <= 0.0), None)
        if high is None:
            return None
        low = max(0.0, high - 1.0 / _SAMPLES)
        for _ in range(_NARROWINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if value(row, middle) > 0.0 else (low, middle)
        guess, rates = ball(0.5 * (low + high)), slope(exact)
        for _ in range(6):
            change: Ball = (value(exact, guess) / value(rates, guess)).mid()
            if not abs(change) < guess / 2:
                break
            guess = (guess - change).mid()
        return (guess * left).mid() if guess < 1 else left

    def _step(self, ground: GroundPiece, step: Ball, *, strikes: bool) -> tuple[SetOfStates, Sweep]:
        """Make a step, and prove that the rotation keeps its sign until an impact near its end."""
        new, swept = advance(self.states, self.corner, ground, step)
        # the sign stays that of the start, :eq:`eq-proof-sign`
        s = self.sign
        stays = swept.rotation * s > 0 or swept.rate * s > 0
        falls = swept.rate * s < 0 or swept.acceleration * s < 0
        if strikes and falls:
            return new, swept
        if strikes or not (stays or (falls and new.box()[0] * s > 0)):
            message = "whether the block meets the ground is not resolved"
            raise Undecided(message)
        return new, swept

    def _nears(self, new: SetOfStates, swept: Sweep) -> bool:
        """Whether the overturning angle may be reached in a step."""
        s, limit = self.sign, self.corner.limit
        if swept.rotation * s < limit:
            return False
        steady = swept.rate * s > 0 or swept.rate * s < 0
        ends = self.states.box()[0], new.box()[0]
        return not (steady and all(one * s < limit for one in ends))

    def _narrow(self, ground: GroundPiece, step: Ball, *, rises: bool) -> None:
        """Narrow down `beyond`, the time at which the overturning angle is first reached."""
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
        """Enclose the set after its impacts near the end of a step."""
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

    def _bounce(self, *, lift: bool = False) -> bool:
        """Prove that slow bounces end in rest or, if `lift`, in uplift; give whether they do.

        The set is at rest, or lifted, then.
        """
        problem, (height, speed) = self.problem, self.states.box()
        if self.impact is not None:
            height, speed = height.union(self.impact.height), speed.union(self.impact.speed)
        height, speed = upper(height), upper(speed)
        if float(speed) > SLOW * problem.frequency or self.number >= problem.count:
            return False
        try:
            found = settle(problem, Instant(self.number, self.after), height, speed)
        except Undecided:  # by the motion of the ground; the course may continue without this proof
            return False
        if found is None or (isinstance(found, Lifted) and not lift):
            return False
        if isinstance(found, Lifted):
            self.sign, (self.number, self.after) = found.sign, found.instant
            self.states = SetOfStates.about(found.box, self.uncertain)
        else:
            self.sign, (self.number, self.after) = 0, found
            self.states = SetOfStates.about([ZERO, ZERO], [])
        self.impact, self.fresh = None, False
        return True

    # ---- end of the motion

    def _settled(self) -> bool | None:
        """Return False if it stands for ever on still ground, else None, :eq:`eq-proof-energy`."""
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
    """Return the potential energy at a rotation on a corner less that upright, over the inertia."""
    lean = corner.angle * corner.sign
    rise = (lean - rotation).cos() - lean.cos()
    shift = (lean - rotation).sin() - lean.sin()
    return corner.ratio * (still.weight[0] * rise - still.along[0] * shift)


def prove_block(
    block: BlockOnRigidGround,
    motion: Motion,
    slope: Slope,
    limits: OverturningAngles,
    start: tuple[float, float],
    *,
    scale: float = 1.0,
    within: Tolerances = EXACT,
    watch: Watch | None = None,
) -> Proof:
    """Prove the verdict of a block on rigid ground, from a start: rotation and angular velocity.

    The proof is for all inputs within the tolerances; `watch` is called with each enclosure.
    """

    def attempt(inputs: Deviations) -> tuple[Proof, list[float]]:
        problem = Problem.of(block, motion, slope, limits, scale, inputs, STILL_STEP)
        course = Course(problem, watch, () if inputs.exact else inputs.spread())
        course.start(*start)
        return concluded(course, scale, _LAW), course.states.influences()

    return proved(attempt, within)
