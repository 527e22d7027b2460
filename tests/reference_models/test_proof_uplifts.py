"""Times of uplift, and states after it, in proofs contain those of members."""

import mpmath
import numpy as np
import pytest

import rockframe as rf

pytest.importorskip("flint", reason="python-flint is not installed")

from reference_models.fifty_digits import DIGITS, ExactRun

from rockframe.proof.balls import ball, working_precision
from rockframe.proof.problem import Deviations, Problem, Undecided
from rockframe.proof.rocking import RockingProver
from rockframe.proof.uplift import find_uplift, first_zero
from rockframe.signals.motion import Incline, Motion, Signal
from rockframe.system.bodies import OverturningAngles

GRAVITY, STEP = 9.81, 0.5
BLOCK = rf.System(
    rf.Block(width="1 m", height="4 m", mass="1 t", centre_of_mass=("2 m", "0.1 m")),
    gravity=f"{GRAVITY} m/s^2",
).assembly.model.system


def test_first_zeros_of_polynomials_are_their_first_roots():
    """With pairs of near roots, between which a guard is negative only shortly."""
    rng, found, none = np.random.default_rng(5), 0, 0
    with working_precision(106):
        for _ in range(300):
            roots = rng.uniform(-1.0, 2.0, size=rng.integers(1, 6))
            roots[1:] = np.where(
                rng.random(roots.size - 1) < 0.4, roots[:-1] + rng.choice([0.01, 0.1]), roots[1:]
            )
            roots = roots[roots != 0.0]
            row = [ball(1)]
            for root in roots:
                row = [a - b * float(root) for a, b in zip([0, *row], [*row, 0], strict=True)]
            row = row if row[0] > 0 else [-a for a in row]
            inside = [float(root) for root in roots if 0.0 < root < 1.0]
            try:
                zero = first_zero(row, ball(1))
            except Undecided:
                assert len(inside) > 1
                continue
            if not inside:
                none += 1
                assert zero is None
            else:
                found += 1
                assert zero.overlaps(ball(min(inside)))
                assert zero.rad() < 1e-6
    assert min(found, none) > 50


def problem(across, up, tolerance):
    vertical = {"vertical": (up, "m/s^2")}
    motion = rf.GroundMotion.from_arrays((across, "m/s^2"), f"{STEP} s", **vertical)
    far, inputs = OverturningAngles(1.0, 1.0), Deviations.within(0.0, tolerance, 0.0)
    return Problem.of(BLOCK, motion.si, Incline(0.0, GRAVITY), far, 1.0, inputs, 0.1)


def member_uplift(across, up, scale):
    """Return the time of uplift and its side; the guards are linear between samples."""
    for k in range(len(across) - 1):
        times = []
        for side, corner in ((1, BLOCK.right), (-1, BLOCK.left)):
            guard = (GRAVITY + scale * up) * np.tan(corner.angle) + side * scale * across
            if guard[k + 1] < 0.0:
                times.append((STEP * (k + guard[k] / (guard[k] - guard[k + 1])), side))
        if times:
            return min(times)
    return None


@pytest.mark.parametrize("tolerance", [1e-6, 1e-3, 0.05])
def test_uplifts_about_a_sample_contain_those_of_members(tolerance):
    """The guard of one side falls to nearly zero at the first sample."""
    rng, about = np.random.default_rng(7), 0
    for number in range(60):
        side = 1 if number % 2 else -1
        tangent = np.tan((BLOCK.right if side > 0 else BLOCK.left).angle)
        up = (0.5 * rng.normal(size=3)).round(3)
        at_sample = -side * (GRAVITY + up[1]) * tangent * (1.0 + tolerance * rng.uniform(-1.0, 1.0))
        across = np.array([0.3 * at_sample, at_sample, at_sample * rng.uniform(0.9, 2.0)])
        with working_precision(106):
            scene = problem(across, up, tolerance)
            start = 0.0
            for k in range(2):
                left = scene.length(k)
                try:
                    lift = find_uplift(scene, k, scene.ground(k), left)
                except Undecided:
                    break
                members = [
                    member_uplift(across, up, 1.0 + tolerance * share)
                    for share in (-0.999, -0.5, 0.0, 0.5, 0.999)
                ]
                if lift is None:
                    early = [one for one in members if one and one[0] < start + STEP - 1e-12]
                    assert not early
                    start += STEP
                    continue
                for time, member_side in members:
                    assert lift[0].overlaps(ball(time - start, 1e-12))
                    assert member_side == lift[1]
                assert not lift[0] > left
                about += bool(lift[0].overlaps(left))
                break
    assert about > 10


def test_uplift_at_a_jump_of_the_ground_is_undecided():
    """The guard is zero for some members at the end of an interval; then the ground jumps."""
    limit = GRAVITY * np.tan(BLOCK.left.angle)
    pieces = np.zeros((2, 6))
    pieces[0, :2], pieces[1, :2] = (0.5 * limit, 0.5 * limit), (0.9 * limit, limit)
    motion = Motion(Signal(STEP, np.append(pieces[:, 0], 1.9 * limit), pieces))
    far, inputs = OverturningAngles(1.0, 1.0), Deviations.within(0.0, 1e-6, 0.0)
    with working_precision(106):
        scene = Problem.of(BLOCK, motion, Incline(0.0, GRAVITY), far, 1.0, inputs, 0.1)
        with pytest.raises(Undecided):
            find_uplift(scene, 0, scene.ground(0), scene.length(0))


@pytest.mark.parametrize("tolerance", [1e-3, 0.05])
def test_states_of_members_are_enclosed_when_the_last_one_lifts(tolerance):
    """The ground acceleration rises from zero, past that of uplift to the left."""
    limit = GRAVITY * np.tan(BLOCK.left.angle)
    across = np.array([0.0, 2.0 * limit, 3.0 * limit])
    with working_precision(106), mpmath.workdps(DIGITS):
        scene = problem(across, np.zeros(3), tolerance)
        ground = scene.ground(0)
        at, side = find_uplift(scene, 0, ground, scene.length(0))
        prover = RockingProver(scene, sign=side, uncertain=scene.uncertain())
        delay = at.upper() - at.lower()
        box = prover._lifted_states(ground.at(at), delay).box()
        for share in (-0.999, 0.0, 0.999):
            scale = 1 + mpmath.mpf(share) * tolerance
            rate = scale * mpmath.mpf(float(across[1])) / STEP
            lifts = GRAVITY * mpmath.tan(mpmath.mpf(BLOCK.left.angle)) / rate
            rows = [rate * lifts, rate], [mpmath.mpf(GRAVITY), mpmath.mpf(0)]
            series = ExactRun(BLOCK, across).polynomial(side, [mpmath.mpf(0)] * 2, *rows)
            left = mpmath.mpf(at.upper().str(DIGITS, radius=False)) - lifts
            assert left > 0
            for enclosure, of in zip(box, series, strict=True):
                state = mpmath.polyval(of[::-1], left)
                assert enclosure.overlaps(ball(mpmath.nstr(state, 40)) + ball(0, 1e-30))
    assert side == -1
