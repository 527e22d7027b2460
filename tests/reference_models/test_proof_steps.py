"""Derivatives and states at the end of single steps of a proof contain those of members.

Sets are as wide, and steps as long, as proofs take them, so that each term of the bounds counts.
"""

import mpmath
import numpy as np
import pytest

import rockframe as rf

pytest.importorskip("flint", reason="python-flint is not installed")

from reference_models.fifty_digits import DIGITS, ExactRun

from rockframe.proof.balls import ball, working_precision
from rockframe.proof.flow import SetOfStates, advance, flow, variation
from rockframe.proof.impacts import enclose_impact
from rockframe.proof.problem import Deviations, Problem
from rockframe.signals.motion import Incline, Motion, Signal
from rockframe.system.bodies import OverturningAngles

BITS, GRAVITY = 106, 9.81
BLOCK = rf.Block(width="0.6 m", height="1.7 m", mass="1 t", centre_of_mass=("0.8 m", "0.04 m"))
NUMBERS = rf.System(BLOCK, gravity=f"{GRAVITY} m/s^2").assembly.model.system
SPREADS = {
    "long step of a point": (0.06, 0.0, 0.0, 0.0),
    "wide box": (0.05, 0.05, 0.0, 0.0),
    "angles": (0.1, 0.0, 0.05, 0.0),
    "scales": (0.1, 0.0, 0.0, 0.2),
    "short step of scales": (0.02, 0.0, 0.0, 0.2),
    "all": (0.1, 0.01, 0.01, 0.05),
}
SHARES = (-0.999, 0.999)


class Case:
    """A box of states on one corner, and the ground over one interval."""

    def __init__(self, spread, seed):
        rng = np.random.default_rng(seed)
        self.step, away, self.lean, self.factor = SPREADS[spread]
        self.sign = int(rng.choice([-1, 1]))
        self.state = float(self.sign * rng.uniform(0.02, 0.4)), float(rng.normal())
        self.away = away * rng.uniform(0.3, 1.0), away * rng.uniform(0.3, 1.0) / self.step
        self.across, self.up = (rng.normal(size=2) * 6.0).round(3), rng.normal(size=2).round(3)
        self.members = rng.choice(SHARES, size=(2, 4))

    def problem(self):
        inputs = Deviations.within(0.0, self.factor, self.lean)
        vertical = {"vertical": (self.up, "m/s^2")}
        motion = rf.GroundMotion.from_arrays((self.across, "m/s^2"), f"{self.step} s", **vertical)
        far = OverturningAngles(10.0, 10.0)
        return Problem.of(NUMBERS, motion.si, Incline(0.0, GRAVITY), far, 1.0, inputs, 0.1)

    def states(self, problem):
        """Return the box as a set that does not depend on the uncertain inputs."""
        box = [ball(middle, away) for middle, away in zip(self.state, self.away, strict=True)]
        return SetOfStates.from_box(box, problem.uncertain())

    def member(self, shares):
        """Return rotation, rate, angle and scale of a member."""
        a, v, lean, scale = (mpmath.mpf(float(share)) for share in shares)
        state = [m + s * d for m, s, d in zip(self.state, (a, v), self.away, strict=True)]
        return [*state, lean * self.lean, 1 + scale * self.factor]

    def end(self, rotation, rate, lean, scale):
        """Return rotation and rate of a member at the end of the step."""
        block = NUMBERS._replace(
            left=NUMBERS.left._replace(angle=mpmath.mpf(NUMBERS.left.angle) + lean),
            right=NUMBERS.right._replace(angle=mpmath.mpf(NUMBERS.right.angle) + lean),
        )
        h, rows = mpmath.mpf(self.step), []
        for row, mean in ((self.across, 0), (self.up, mpmath.mpf(GRAVITY))):
            first, last = (scale * mpmath.mpf(float(value)) for value in row)
            rows.append([mean + first, (last - first) / h])
        run = ExactRun(block, self.across, self.up, degree=60)
        series = run.polynomial(self.sign, [rotation, rate], *rows)
        return [mpmath.polyval(of[::-1], h) for of in series]


def derivatives(of, at):
    """Return the derivatives of a function by each of its arguments, by rows of its values."""
    small = mpmath.mpf(10) ** -16
    columns = []
    for k in range(len(at)):
        ends = [of(*[x + sign * small * (j == k) for j, x in enumerate(at)]) for sign in (1, -1)]
        columns.append([(b - a) / (2 * small) for b, a in zip(*ends, strict=True)])
    return list(zip(*columns, strict=True))


def holds(enclosure, value):
    return enclosure.overlaps(ball(mpmath.nstr(value, DIGITS - 5)) + ball(0, 1e-30))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("spread", SPREADS)
def test_derivatives_over_a_step_contain_those_of_members(spread, seed):
    case = Case(spread, seed)
    with working_precision(BITS), mpmath.workdps(DIGITS):
        problem = case.problem()
        states, corner, ground = case.states(problem), problem.corner(case.sign), problem.ground(0)
        h, inputs = ball(case.step), problem.uncertain()
        during = ground.at(ball(0).union(h))
        step = flow(states.centre, states.box(), corner, ground, during, h)
        lean = inputs.angle(case.sign)
        matrix, by_scale = variation(step, states.deviations(), lean, inputs.scale)
        new, bounds = advance(states, corner, ground, h)
        for shares in ((0.0,) * 4, *case.members):
            member = case.member(shares)
            exact = derivatives(case.end, member)
            for row, scale, values in zip(matrix, by_scale, exact, strict=True):
                assert holds(row[0], values[0])
                assert holds(row[1], values[1])
                assert not case.factor or holds(scale, values[3])
            state = case.end(*member)
            for k, box in enumerate(new.box()):
                assert holds(box, state[k])
            for enclosure, value in zip(bounds[:2], member[:2], strict=True):
                assert holds(enclosure, value)
            for enclosure, value in zip(bounds[:2], state, strict=True):
                assert holds(enclosure, value)


IMPACTS = {  # half widths of rotation and rate, restitution, angles and scale
    "rotations": (1e-3, 0.0, 0.0, 0.0, 0.0),
    "rates": (1e-6, 0.1, 0.0, 0.0, 0.0),
    "restitutions": (0.0, 0.0, 1e-3, 0.0, 0.0),
    "angles": (1e-4, 0.0, 0.0, 0.01, 0.0),
    "scales": (1e-4, 0.0, 0.0, 0.0, 0.1),
    "all": (1e-4, 1e-3, 1e-3, 1e-3, 1e-2),
}
STEP = 0.05


def moved(block, side, state, ground, time):
    """Move a state on one side by a time, under ground that is linear from now."""
    (x, x_rate), (y, y_rate), scale = ground
    rows = [[scale * x, scale * x_rate], [GRAVITY + scale * y, scale * y_rate]]
    run = ExactRun(block, [0.0], [0.0], degree=24)
    return [mpmath.polyval(of[::-1], time) for of in run.polynomial(side, state, *rows)]


def impact_time(block, side, state, ground):
    """Find when a rotation is zero, near now."""
    return mpmath.findroot(lambda time: moved(block, side, state, ground, time)[0], 0.0)


@pytest.mark.parametrize("jump", [0.0, 4.0], ids=["straight lines", "jump"])
@pytest.mark.parametrize("spread", IMPACTS)
@pytest.mark.parametrize("seed", range(3))
def test_impacts_about_a_sample_contain_those_of_members(spread, seed, jump):
    rng, widths = np.random.default_rng(seed), IMPACTS[spread]
    sign, rate = int(rng.choice([-1, 1])), float(rng.uniform(0.5, 1.0))
    pieces = rng.normal(size=(2, 2, 6)).round(3) * [[[4.0, 20.0, 0.0, 0.0, 0.0, 0.0]]]
    pieces[1, :, 0] = pieces[0].sum(axis=-1) + jump
    across, up = (Signal(STEP, np.append(row[:, 0], 0.0), row) for row in pieces.transpose(1, 0, 2))
    far = OverturningAngles(10.0, 10.0)
    with working_precision(BITS), mpmath.workdps(DIGITS):
        inputs = Deviations.within(widths[2], widths[4], widths[3])
        problem = Problem.of(
            NUMBERS, Motion(across, up), Incline(0.0, GRAVITY), far, 1.0, inputs, 0.1
        )
        box = [ball(0, widths[0]), ball(-sign * rate, widths[1])]
        old, new = problem.corner(sign), problem.corner(-sign)
        before, after = problem.ground(0).at(ball(STEP)), problem.ground(1)
        states = SetOfStates.from_box(box, problem.uncertain())
        found = enclose_impact(states, old, new, before, after)
        for shares in (np.zeros(5), *rng.choice(SHARES, size=(6, 5))):
            by = [mpmath.mpf(float(a)) * b for a, b in zip(shares, widths, strict=True)]
            left, right = (
                corner._replace(
                    restitution=mpmath.mpf(corner.restitution) + by[2],
                    angle=mpmath.mpf(corner.angle) + by[3],
                )
                for corner in (NUMBERS.left, NUMBERS.right)
            )
            block, start = NUMBERS._replace(left=left, right=right), [by[0], by[1] - sign * rate]
            early = start[0] * sign < 0  # it strikes before the sample
            row = pieces[0] if early else pieces[1]
            ground = [
                (mpmath.mpf(one.sum() if early else one[0]), mpmath.mpf(one[1]) / STEP)
                for one in (row[0], row[1])
            ]
            pull = (*ground, 1 + by[4])
            at = impact_time(block, sign, start, pull)
            corner = right if sign < 0 else left
            arrived = moved(block, sign, start, pull, at)
            shifted = (*((a + b * at, b) for a, b in ground), 1 + by[4])
            rebound = [mpmath.mpf(0), arrived[1] * corner.restitution]
            end = moved(block, -sign, rebound, shifted, -at)
            assert holds(found.at, at)
            for enclosure, value in zip(found.states.box(), end, strict=True):
                assert holds(enclosure, value)
            for bound, value, image in zip(found[2:], start, end, strict=True):
                assert bound >= ball(mpmath.nstr(abs(image), 20)) - 1e-20
                assert early or bound >= ball(mpmath.nstr(abs(value), 20)) - 1e-20
