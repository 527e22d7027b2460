"""Enclosures of proofs contain a 50-digit run at every sample; planted faults are caught."""

import math

import mpmath
import numpy as np
import pytest

import rockframe as rf

pytest.importorskip("flint", reason="python-flint is not installed")

from reference_models.fifty_digits import DIGITS, ExactRun

from rockframe.proof import flow
from rockframe.proof.balls import ball, magnitude, working_precision
from rockframe.proof.flow import SetOfStates
from rockframe.proof.problem import Deviations, Problem, Undecided
from rockframe.proof.rocking import RockingProver
from rockframe.signals.motion import Incline
from rockframe.system.bodies import OverturningAngles

STEP = 0.0625
BITS = 106
KNOTS = 60


def samples(seed, peak):
    rough = np.random.default_rng(seed).normal(size=KNOTS + 1)
    smooth = np.convolve(rough, [0.3, 0.6, 0.3], "same")
    return np.round(peak * smooth / np.abs(smooth).max(), 6)


SYMMETRIC = rf.Block.from_size(radius="3 m", slenderness=4, mass="20 t")
SKEW = rf.Block(width="1.2 m", height="5 m", mass="9 t", centre_of_mass=("2.6 m", "0.05 m"))
SETS = ("restitution", "scale", "angle")
ACROSS, UP = samples(3, 5.0), samples(4, 2.0)
CASES = {
    "symmetric": (SYMMETRIC, ACROSS, None),
    "another motion": (SYMMETRIC, samples(8, 4.0), None),
    "skew, with vertical motion": (SKEW, 0.8 * ACROSS, UP),
}


def block_numbers(block):
    return rf.System(block, gravity="9.81 m/s^2").assembly.model.system


@pytest.fixture(scope="module")
def exact_runs():
    return {
        name: ExactRun(block_numbers(block), a, u).run() for name, (block, a, u) in CASES.items()
    }


def enclosures(name, *, change=lambda block: block, **tolerances):
    """Return the boxes at samples, by sample number, and the prover."""
    block, across, up = CASES[name]
    vertical = {} if up is None else {"vertical": (up, "m/s^2")}
    motion = rf.GroundMotion.from_arrays((across, "m/s^2"), f"{STEP} s", **vertical)
    boxes = {}

    def callback(interval, elapsed, side, box):
        if elapsed.is_zero() and interval < KNOTS:
            boxes[interval] = side, box

    far = OverturningAngles(math.inf, math.inf)
    with working_precision(BITS):
        block = change(block_numbers(block))
        inputs = Deviations.within(*(tolerances.get(one, 0.0) for one in SETS))
        problem = Problem.of(block, motion.si, Incline(0.0, 9.81), far, 1.0, inputs, 0.05)
        prover = RockingProver(problem, callback, [] if inputs.exact else problem.uncertain())
        while prover.interval < KNOTS:
            prover._follow_rest() if prover.sign == 0 else prover._follow_rocking()
    assert boxes
    return boxes, prover


def all_enclosed(boxes, run):
    """Whether every box holds the exact state, to the digits of the balls."""
    with mpmath.workdps(DIGITS), working_precision(BITS):
        for interval, (side, box) in boxes.items():
            if side != run.sides[interval]:
                return False
            for each, exact in zip(box, run.states[interval], strict=True):
                if not each.overlaps(ball(mpmath.nstr(exact, DIGITS - 5))):
                    return False
    return True


@pytest.mark.parametrize("name", CASES)
def test_enclosures_contain_fifty_digit_run(name, exact_runs):
    boxes, prover = enclosures(name)
    assert prover.impacts == exact_runs[name].impacts > 2
    assert all_enclosed(boxes, exact_runs[name])
    assert max(float(box[0].rad()) for _, box in boxes.values()) < 1e-13
    assert DIGITS * math.log2(10.0) > BITS


def run_of_member(name, kind, by):
    """Return the run of a member of a set, with one number changed."""
    block, across, up = CASES[name]
    block = block_numbers(block)
    if kind == "scale":
        # products of floats: the scale of each sample has one more rounding error
        return ExactRun(block, *(row if row is None else row * (1.0 + by) for row in (across, up)))
    return ExactRun(with_change(block, by, kind), across, up)


@pytest.mark.parametrize("tolerance", [1e-9, pytest.param(1e-6, marks=pytest.mark.long)])
@pytest.mark.parametrize("kind", SETS)
@pytest.mark.parametrize(
    "name", [pytest.param("symmetric", marks=pytest.mark.long), "skew, with vertical motion"]
)
def test_set_enclosures_contain_run_with_perturbed_parameter(name, kind, tolerance):
    boxes, prover = enclosures(name, **{kind: tolerance})
    assert prover.impacts > 2
    for share in (-0.999, 0.6):
        assert all_enclosed(boxes, run_of_member(name, kind, share * tolerance).run())
    assert not all_enclosed(boxes, run_of_member(name, kind, 40.0 * tolerance).run())


def test_set_enclosures_contain_run_with_all_parameters_perturbed():
    by = 0.9e-7
    boxes, _ = enclosures("another motion", restitution=1e-7, scale=1e-7, angle=1e-7)
    block = with_change(with_change(block_numbers(SYMMETRIC), -by, "restitution"), by, "angle")
    assert all_enclosed(boxes, ExactRun(block, CASES["another motion"][1] * (1.0 - by)).run())


@pytest.mark.parametrize("kind", ["scale", "angle"])
def test_omitted_deviation_within_step_is_caught(kind, monkeypatch):
    right = flow.Deviations.of

    def wrong(sign, **deviations):
        return right(sign, **{name: value for name, value in deviations.items() if name != kind})

    monkeypatch.setattr(flow.Deviations, "of", wrong)
    boxes, _ = enclosures("symmetric", **{kind: 1e-7})
    assert not all_enclosed(boxes, run_of_member("symmetric", kind, 0.9e-7).run())


def test_set_enclosures_contain_members_that_uplift_early():
    # without their rise until then the set would begin at rest
    boxes, _ = enclosures("symmetric", scale=1e-4)
    first = min(boxes, key=lambda interval: (boxes[interval][0] == 0, interval))
    for share in (-0.999, 0.0, 0.999):
        run = run_of_member("symmetric", "scale", share * 1e-4).run()
        assert all_enclosed({first: boxes[first]}, run)


def test_set_enclosures_contain_impacts_on_both_sides_of_sample(monkeypatch):
    tolerance, sample, across = 1e-3, 53, (0.82 * ACROSS).round(6)
    monkeypatch.setitem(CASES, "about a sample", (SYMMETRIC, across, None))
    boxes, _ = enclosures("about a sample", restitution=tolerance)
    assert max(boxes) > sample
    struck = set()
    for share in (-0.999, -0.3, 0.3, 0.9):
        run = ExactRun(with_change(block_numbers(SYMMETRIC), share * tolerance), across, None).run()
        box = boxes.pop(sample)  # its box holds all members as if they had struck
        assert all_enclosed(boxes, run)
        boxes[sample] = box
        struck.add(run.sides[sample])
    assert struck == {-1, 1}


def with_change(block, by, number="restitution"):
    left, right = (
        corner._replace(**{number: getattr(corner, number) + by})
        for corner in (block.left, block.right)
    )
    return block._replace(left=left, right=right)


def is_caught(name, run, **changes):
    """Whether a fault is detected: the exact run is outside, or nothing is proved."""
    try:
        boxes, _ = enclosures(name, **changes)
    except Undecided:
        return True
    return not all_enclosed(boxes, run)


def test_a_restitution_that_is_a_little_wrong_is_caught(exact_runs):
    assert is_caught(
        "symmetric", exact_runs["symmetric"], change=lambda block: with_change(block, 1e-12)
    )


def test_a_wrong_sign_is_caught(exact_runs, monkeypatch):
    right = flow._series

    def wrong(*arguments):
        sine, cosine, angle = right(*arguments)
        return sine, cosine, [*angle[:5], -angle[5], *angle[6:]]

    monkeypatch.setattr(flow, "_series", wrong)
    assert is_caught("symmetric", exact_runs["symmetric"])


def test_a_remainder_that_is_left_out_is_caught(exact_runs, monkeypatch):
    right = flow.majorants

    def wrong(*arguments):
        bounds, waves, _ = right(*arguments)
        return [each * 0 for each in bounds], waves, 7

    monkeypatch.setattr(flow, "majorants", wrong)
    assert is_caught("symmetric", exact_runs["symmetric"])


def test_rounding_to_the_wrong_side_is_caught(exact_runs, monkeypatch):
    monkeypatch.setattr(flow, "magnitude", lambda one: ball(one.abs_lower()))
    too_small = lambda power: magnitude(ball(2) ** (ball(power - 8) / 4))  # noqa: E731
    monkeypatch.setattr(flow, "_root_power", too_small)
    flow.majorants.cache_clear()
    assert is_caught("symmetric", exact_runs["symmetric"])
    flow.majorants.cache_clear()


def test_radii_that_are_forgotten_are_caught(exact_runs, monkeypatch):
    right = SetOfStates.image

    def wrong(states, *arguments):
        new = right(states, *arguments)
        return new._replace(remainder=[each.mid() for each in new.remainder])

    monkeypatch.setattr(SetOfStates, "image", wrong)
    assert is_caught("symmetric", exact_runs["symmetric"])


def test_unpredicted_impact_leaves_verdict_undecided(monkeypatch):
    monkeypatch.setattr(RockingProver, "_predict_impact", lambda *arguments: None)
    with pytest.raises(Undecided):
        enclosures("symmetric")


def test_an_impact_that_is_missed_is_caught(exact_runs, monkeypatch):
    def step_without_impact(prover, ground, step, *, ends_at_impact):
        return flow.advance(prover.states, prover.corner, ground, step)

    monkeypatch.setattr(RockingProver, "_predict_impact", lambda *arguments: None)
    monkeypatch.setattr(RockingProver, "_make_step", step_without_impact)
    assert is_caught("symmetric", exact_runs["symmetric"])
