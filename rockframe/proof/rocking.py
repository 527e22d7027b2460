"""The course of a set of states on rigid ground, from the first sample to a proved verdict."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final

from rockframe.dynamics.rigid_ground import BlockOnRigidGround
from rockframe.proof.balls import (
    UNIT,
    ZERO,
    Ball,
    Row,
    ball,
    derivative_of,
    magnitude,
    polynomial_value,
)
from rockframe.proof.bounces import Instant, UpliftState, follow_bounces
from rockframe.proof.flow import MotionBounds, SetOfStates, advance, bound_motion, flow, jerk
from rockframe.proof.impacts import ImpactEnclosure, enclose_impact
from rockframe.proof.problem import (
    CornerNumbers,
    Deviations,
    GroundPiece,
    Problem,
    Undecided,
    require,
)
from rockframe.proof.sets import prove_for_set, prove_verdict
from rockframe.proof.uplift import find_uplift
from rockframe.proof.verdict import EXACT, Proof, Tolerances
from rockframe.signals import Motion
from rockframe.signals.motion import Incline
from rockframe.system.bodies import OverturningAngles

SHORTEST_STEP: Final = 2.0**-30
"""Step over an interval of the motion below which a proof is given up."""
FINE_STEP: Final = 2.0**-20
"""Step near the overturning angle, over an interval of the motion."""
FINE_STEP_OF_SET: Final = 2.0**-3
"""Step near the overturning angle for a set of inputs, whose times of overturning differ anyway."""
MAX_RADIUS: Final = 0.3
"""Radius of a set, over theta, beyond which a proof is given up."""
AT_INTERVAL_END: Final = 1e-10
"""Share of an interval within which an impact is taken to be at its end."""
SLOW_IMPACT: Final = 0.02
"""Rate after an impact, over p, below which it is tried to prove that bounces end in rest."""
MAX_TIME_AFTER_MOTION: Final = 60.0
"""Time after the motion, times p, after which a proof is given up: the block is near its crest."""
STILL_STEP: Final = 0.1
"""Length of the intervals of still ground after a motion, times p."""
_LAW: Final = "Housner's law"
_UNKNOWN_SIDE: Final = "an uplift of which it is not sure to which side it goes"
_SAMPLES: Final = 24
_HALVINGS: Final = 40
_NARROWINGS: Final = 60

Callback = Callable[[int, Ball, int, Row], None]
"""A function called with each enclosure: interval, time in it, side (0 at rest), box."""


@dataclass
class RockingProver:
    """The set of states that is followed; times are since the start of an interval [s]."""

    problem: Problem
    callback: Callback | None = None
    uncertain: Sequence[Ball] = ()  # uncertain inputs less their middles
    interval: int = 0  # number of the present interval of the motion
    elapsed: Ball = ZERO  # time since its start
    sign: int = 0  # sign of the rotation; 0 at rest
    states: SetOfStates = field(default_factory=lambda: SetOfStates.from_box([ZERO, ZERO], []))
    just_lifted: bool = False  # whether it has just left the upright position
    # from when to when it may pass the overturning angle
    overturning_time: tuple[Ball, Ball] | None = None
    last_impact: ImpactEnclosure | None = None  # as long as members may still have it
    impacts: int = 0  # number of impacts enclosed one by one
    largest_radius: float = 0.0  # largest radius of a rotation so far [rad]

    @property
    def corner(self) -> CornerNumbers:
        """The corner that bears."""
        return self.problem.corner(self.sign)

    @property
    def time(self) -> Ball:
        """Time since the first sample [s]."""
        return self.problem.time(self.interval, self.elapsed)

    def start(self, rotation: float, rate: float) -> None:
        """Set the state at the start: rotation [rad] and rate [rad s^-1]."""
        if rotation == 0.0 and rate == 0.0:
            return
        self.sign = 1 if (rotation or rate) > 0.0 else -1
        self.just_lifted = rotation == 0.0
        self.states = SetOfStates.from_box([ball(rotation), ball(rate)], self.uncertain)

    def overturns(self) -> bool:
        """Follow the set until it is proved whether it overturns, and when.

        Raises `Undecided` if that cannot be proved.
        """
        while True:
            verdict = self._follow_rest() if self.sign == 0 else self._follow_rocking()
            if verdict is not None:
                passed = "whether it passed its overturning angle is not resolved"
                require(verdict or self.overturning_time is None, passed)
                return verdict

    # ---- standing

    def _follow_rest(self) -> bool | None:
        """Follow a block at rest to the end of an interval or to uplift, :eq:`eq-proof-uplift`.

        Gives False if it stays at rest for ever, else None.
        """
        problem = self.problem
        ground, left = problem.ground(self.interval).at(self.elapsed), self._time_left()
        lift = find_uplift(problem, self.interval, ground, left)
        if lift is None:
            if self.interval >= problem.count:
                return False
            self._advance_to(left, to_end=True)
            return None
        at, self.sign = lift
        latest = ball(at.upper())
        if at < left:
            during, ground = ground.at(at), ground.at(latest)
        elif not problem.is_continuous_after(self.interval):
            raise Undecided(_UNKNOWN_SIDE)
        else:  # some members lift before the sample, some after it
            self.interval, self.elapsed, latest = self.interval + 1, ZERO, latest - left
            following = problem.ground(self.interval)
            before = ground.at(ball(at.lower()).union(left))
            during = before.union(following.at(ZERO.union(latest)))
            ground, left = following.at(latest), self._time_left()
        start, length = self._lifted_states(during, at.upper() - at.lower()), left - latest
        for halvings in range(_HALVINGS):
            try:
                self.states, bounds = advance(start, self.corner, ground, length)
            except Undecided:
                length = (length / 2).mid()
                continue
            rises = bounds.acceleration * self.sign > 0
            during = ground.at(UNIT * length)
            below = bounds.rotation * self.sign < self.corner.limit
            if below and (rises or jerk(bounds, self.corner, during) * self.sign > 0):
                self.just_lifted = False
                self._advance_to(latest + length, to_end=halvings == 0)
                return None
            length = (length / 2).mid()
        raise Undecided(_UNKNOWN_SIDE)

    def _time_left(self) -> Ball:
        """Return the time to the end of the interval."""
        return self.problem.length(self.interval) - self.elapsed

    def _lifted_states(self, during: GroundPiece, delay: Ball) -> SetOfStates:
        """Enclose all members at the time at which the last one lifts, :eq:`eq-proof-lifted`."""
        still = [ZERO, ZERO]
        if delay > 0:
            third = jerk(
                bound_motion(still, self.corner, during, UNIT * delay), self.corner, during
            )
            require(third * self.sign > 0, _UNKNOWN_SIDE)
            risen = [delay**3 / 6, delay**2 / 2]
            still = [UNIT * (magnitude(third) * factor) * self.sign for factor in risen]
        return SetOfStates.from_box(still, self.uncertain)

    # ---- rocking

    def _follow_rocking(self) -> bool | None:
        """Make one step and, if there is one, the impact at its end; give a verdict or None."""
        corner, length = self.corner, self.problem.length(self.interval)
        fine = (FINE_STEP_OF_SET if self.uncertain else FINE_STEP) * float(length)
        ground = self.problem.ground(self.interval).at(self.elapsed)
        left = length - self.elapsed
        impact_time = self._predict_impact(ground, left)
        to_end = impact_time is None or float((left - impact_time).mid()) < AT_INTERVAL_END * float(
            length
        )
        step: Ball = left if to_end else impact_time
        ends_at_impact = impact_time is not None
        shorter, at_sample = step, False
        impact: ImpactEnclosure | None = None
        while True:
            try:
                new, bounds = self._make_step(ground, step, ends_at_impact=ends_at_impact)
                near = self._may_overturn(new, bounds)
                if not near or float(step.mid()) <= fine or self._passes_limit(new, bounds):
                    if ends_at_impact:
                        impact = self._apply_impact(new, ground.at(step), step, left, to_end=to_end)
                    break
            except Undecided:
                if float(step.mid()) < SHORTEST_STEP * float(length):
                    if self._settle_bounces(lift=True):
                        return None
                    raise
                if self.uncertain and not at_sample:  # members may strike before and after it
                    step, to_end, ends_at_impact, at_sample = left, True, True, True
                    continue
            shorter = (shorter / 2).mid()
            step, to_end, ends_at_impact = shorter, False, False
        if new.box()[0] * self.sign > corner.limit:
            self._enclose_overturning_time(ground, step, passes=self._passes_limit(new, bounds))
            return True
        if near and self.overturning_time is None:
            self.overturning_time = self.time, self.time
        self.states, self.just_lifted = new if impact is None else impact.states, ends_at_impact
        if impact is not None:
            self.sign, self.impacts = -self.sign, self.impacts + 1
        self._advance_to(step, to_end=to_end)
        if impact is not None:
            self.last_impact = impact
            self._settle_bounces()
        elif self.last_impact is not None:  # some members may not have struck yet
            late = self.last_impact.at - step
            self.last_impact = None if late < 0 else self.last_impact._replace(at=late)
        return self._is_safe() if self.interval >= self.problem.count and self.sign else None

    def _advance_to(self, step: Ball, *, to_end: bool) -> None:
        self.interval, self.elapsed = (self.interval + 1, ZERO) if to_end else (
            self.interval, self.elapsed + step
        )  # fmt: skip
        box = self.states.box()
        radius = box[0].rad()
        self.largest_radius = max(self.largest_radius, float(radius))
        if self.callback is not None:
            self.callback(self.interval, self.elapsed, self.sign, box)
        if self.sign:
            wide = "the enclosure has become as wide as the rotations themselves"
            require(radius < MAX_RADIUS * self.corner.angle, wide)

    def _predict_impact(self, ground: GroundPiece, left: Ball) -> Ball | None:
        """Estimate when the middle of the set strikes, None if it does not; proves nothing."""
        span, centre, corner = float(left.mid()), self.states.centre, self.corner
        place, rate = (float(component.mid()) * self.sign for component in centre)
        pull = float(abs(ground.normal[0]).upper() + abs(ground.along[0]).upper())
        most = 2.0 * float(corner.ratio.mid()) * pull
        if not self.just_lifted and place > abs(rate) * span + most * span * span:
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
        exact = [coefficient.mid() for coefficient in exact]
        row = [float(coefficient) * self.sign for coefficient in exact]
        row = row[1:] if self.just_lifted else row
        places = (k / _SAMPLES for k in range(1, _SAMPLES + 1))
        high = next((x for x in places if polynomial_value(row, x) <= 0.0), None)
        if high is None:
            return None
        low = max(0.0, high - 1.0 / _SAMPLES)
        for _ in range(_NARROWINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if polynomial_value(row, middle) > 0.0 else (low, middle)
        guess, rates = ball(0.5 * (low + high)), derivative_of(exact)
        for _ in range(6):
            change: Ball = (polynomial_value(exact, guess) / polynomial_value(rates, guess)).mid()
            if not abs(change) < guess / 2:
                break
            guess = (guess - change).mid()
        return (guess * left).mid() if guess < 1 else left

    def _make_step(
        self, ground: GroundPiece, step: Ball, *, ends_at_impact: bool
    ) -> tuple[SetOfStates, MotionBounds]:
        """Make a step, and prove that the rotation keeps its sign until an impact near its end."""
        new, bounds = advance(self.states, self.corner, ground, step)
        # the sign stays that of the start, :eq:`eq-proof-sign`
        s = self.sign
        stays = bounds.rotation * s > 0 or bounds.rate * s > 0
        falls = bounds.rate * s < 0 or bounds.acceleration * s < 0
        if ends_at_impact and falls:
            return new, bounds
        keeps_sign = not ends_at_impact and (stays or (falls and new.box()[0] * s > 0))
        require(keeps_sign, "whether the block meets the ground is not resolved")
        return new, bounds

    def _may_overturn(self, new: SetOfStates, bounds: MotionBounds) -> bool:
        """Whether the overturning angle may be reached in a step."""
        s, limit = self.sign, self.corner.limit
        if bounds.rotation * s < limit:
            return False
        steady = bounds.rate * s > 0 or bounds.rate * s < 0
        ends = self.states.box()[0], new.box()[0]
        return not (steady and all(end * s < limit for end in ends))

    def _passes_limit(self, new: SetOfStates, bounds: MotionBounds) -> bool:
        """Whether all members pass the overturning angle in a step, each once."""
        s, limit = self.sign, self.corner.limit
        begin, end = self.states.box()[0] * s, new.box()[0] * s
        return begin < limit and end > limit and bounds.rate * s > 0

    def _enclose_overturning_time(self, ground: GroundPiece, step: Ball, *, passes: bool) -> None:
        """Enclose the times at which members first reach the overturning angle, by a step's end."""
        begin, low, high = self.time, ZERO, step
        if passes:
            for _ in range(_NARROWINGS):
                middle = ((low + high) / 2).mid()
                rotation = advance(self.states, self.corner, ground, middle)[0].box()[0] * self.sign
                if rotation < self.corner.limit:
                    low = middle
                elif rotation > self.corner.limit:
                    high = middle
                else:
                    break
        earliest = begin + low if self.overturning_time is None else self.overturning_time[0]
        self.overturning_time = earliest, begin + high

    def _apply_impact(
        self, states: SetOfStates, ground: GroundPiece, step: Ball, left: Ball, *, to_end: bool
    ) -> ImpactEnclosure:
        """Enclose the set after its impacts near the end of a step."""
        following = self.problem.ground(self.interval + 1) if to_end else ground
        new = self.problem.corner(-self.sign)
        impact = enclose_impact(states, self.corner, new, ground, following)
        near = impact.at.contains(0) or abs(impact.at) < 2 * AT_INTERVAL_END * self.problem.length(
            self.interval
        )
        require(near if to_end else step + impact.at < left, "an impact at a sample of the motion")
        return impact

    def _settle_bounces(self, *, lift: bool = False) -> bool:
        """Prove that slow bounces end in rest or, if `lift`, in uplift; give whether they do.

        The set is at rest, or lifted, then.
        """
        problem, (height, speed) = self.problem, self.states.box()
        if self.last_impact is not None:
            height, speed = (
                height.union(self.last_impact.height),
                speed.union(self.last_impact.speed),
            )
        height, speed = magnitude(height), magnitude(speed)
        if float(speed) > SLOW_IMPACT * problem.frequency or self.interval >= problem.count:
            return False
        try:
            outcome = follow_bounces(problem, Instant(self.interval, self.elapsed), height, speed)
        except Undecided:  # by the motion of the ground; the course may continue without this proof
            return False
        if outcome is None or (isinstance(outcome, UpliftState) and not lift):
            return False
        if isinstance(outcome, UpliftState):
            self.sign, (self.interval, self.elapsed) = outcome.sign, outcome.instant
            self.states = SetOfStates.from_box(outcome.box, self.uncertain)
        else:
            self.sign, (self.interval, self.elapsed) = 0, outcome
            self.states = SetOfStates.from_box([ZERO, ZERO], [])
        self.last_impact, self.just_lifted = None, False
        return True

    # ---- end of the motion

    def _is_safe(self) -> bool | None:
        """Return False if it stands for ever on still ground, else None, :eq:`eq-proof-energy`."""
        problem, near, far = self.problem, self.corner, self.problem.corner(-self.sign)
        still = problem.ground(self.interval)
        rotation, rate = self.states.box()
        energy = rate * rate / 2 + _potential(rotation, near, still)
        steep = [_potential(corner.limit * corner.sign, corner, still) for corner in (near, far)]
        e, back = far.restitution, near.restitution
        lasting = energy < steep[0] and e * e * energy < steep[1] and e * back <= 1
        if lasting and rotation * self.sign < near.limit:
            return False
        tail = problem.time(self.interval, ZERO) - problem.time(problem.count, ZERO)
        if tail * problem.frequency > MAX_TIME_AFTER_MOTION:
            message = "after the motion it stays near its crest"
            raise Undecided(message)
        return None


def _potential(rotation: Ball, corner: CornerNumbers, still: GroundPiece) -> Ball:
    """Return the potential energy at a rotation on a corner less that upright, over the inertia."""
    lean = corner.angle * corner.sign
    rise = (lean - rotation).cos() - lean.cos()
    shift = (lean - rotation).sin() - lean.sin()
    return corner.ratio * (still.normal[0] * rise - still.along[0] * shift)


def prove_block(
    block: BlockOnRigidGround,
    motion: Motion,
    slope: Incline,
    limits: OverturningAngles,
    start: tuple[float, float],
    *,
    scale: float = 1.0,
    within: Tolerances = EXACT,
    callback: Callback | None = None,  # called with each enclosure
) -> Proof:
    """Prove the verdict of a block on rigid ground, from a start: rotation and angular velocity."""

    def attempt(inputs: Deviations) -> tuple[Proof, list[float]]:
        problem = Problem.of(block, motion, slope, limits, scale, inputs, STILL_STEP)
        prover = RockingProver(problem, callback, () if inputs.exact else problem.uncertain())
        prover.start(*start)
        return prove_verdict(prover, scale, _LAW), prover.states.influences()

    return prove_for_set(attempt, within)
