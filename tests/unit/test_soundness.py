"""Warnings of runs whose energies do not balance."""

from dataclasses import replace

import pytest
from extremes.scenes import Scene, scenes

import rockframe as rf
from rockframe.errors import SolverWarning
from rockframe.simulation import soundness
from rockframe.simulation.certify.run_summary import RunSummary
from rockframe.simulation.plan import plan_run
from rockframe.simulation.run import compute_response
from rockframe.simulation.soundness import (
    DOUBTFUL_RESIDUAL,
    DOUBTFUL_RESIDUAL_ON_SPRINGS,
    MAX_ADAPTIVE_RESIDUAL,
    MAX_FIXED_STEP_RESIDUAL,
    energy_caution,
)

SYSTEM, MOTION = Scene().system, Scene().motion
STOOD = RunSummary(False, 0.1, (0.5,), course=(1.0, 0.2))


def caution_of(accuracy, residual, other=STOOD, base=STOOD, system=SYSTEM):
    plan = plan_run(
        system.assembly,
        MOTION,
        duration=None,
        free_vibration=None,
        initial=None,
        accuracy=accuracy,
        output_step=None,
        outputs=None,
        overturning="stop",
    )
    summary = replace(compute_response(system.assembly, plan).trajectory, energy_residual=residual)
    tried = []

    def run(neighbour):
        tried.append(neighbour.accuracy)
        return other

    return energy_caution(system.assembly, plan, summary, lambda: base, run), tried


@pytest.mark.parametrize("accuracy", ["standard", "reference", 1e-6])
def test_adaptive_runs_are_judged_by_energy_balance(accuracy):
    assert caution_of(accuracy, 0.5 * MAX_ADAPTIVE_RESIDUAL) == (None, [])
    text, tried = caution_of(accuracy, 2.0 * MAX_ADAPTIVE_RESIDUAL)
    assert "out of balance by 0.002 of the largest" in text
    assert "this is no solution; repeat the run with a tighter tolerance" in text
    assert not tried


@pytest.mark.parametrize("accuracy", ["fast", rf.Accuracy(substeps=20)])
def test_doubtful_fixed_step_runs_are_compared_with_an_adaptive_run(accuracy):
    standard = rf.Accuracy(rtol=2e-8)
    rigid = rf.System(SYSTEM.parts.block)
    for system, limit in ((SYSTEM, DOUBTFUL_RESIDUAL_ON_SPRINGS), (rigid, DOUBTFUL_RESIDUAL)):
        assert caution_of(accuracy, 0.5 * limit, system=system) == (None, [])
        assert caution_of(accuracy, 2.0 * limit, system=system) == (None, [standard])
    text, tried = caution_of(accuracy, 2.0 * MAX_FIXED_STEP_RESIDUAL)
    assert text.endswith("this is no solution; repeat the run with accuracy='standard'")
    assert not tried


@pytest.mark.parametrize(
    ("other", "words"),
    [
        (replace(STOOD, peak=0.102), "a peak rotation of 0.102 rad"),
        (replace(STOOD, course=(1.0, 0.5)), "a peak rotation of 0.1 rad"),
        (RunSummary(True, 0.1, (0.5, 1.0), 2.0, 1, course=(1.0, 0.2)), "which overturns"),
    ],
)
def test_different_adaptive_course_is_reported(other, words):
    text, _ = caution_of("fast", 2.0 * DOUBTFUL_RESIDUAL_ON_SPRINGS, other)
    assert words in text
    assert "repeat the run with accuracy='standard'" in text


def test_unfinished_run_is_not_judged():
    cut_off = RunSummary(None, 0.1)
    assert caution_of("fast", 1.0, base=cut_off) == (None, [])
    assert caution_of("fast", 2.0 * DOUBTFUL_RESIDUAL_ON_SPRINGS, other=cut_off)[0] is None


def test_run_out_of_balance_warns_and_has_a_caution(monkeypatch):
    monkeypatch.setattr(soundness, "MAX_ADAPTIVE_RESIDUAL", 1e-30)
    with pytest.warns(SolverWarning, match="out of balance"):
        run = SYSTEM.simulate(MOTION)
    assert "this is no solution" in run.attrs["cautions"]


def test_fast_run_with_wrong_course_warns():
    """Sub-steps of a tenth of the period, in a scene whose impacts multiply errors."""
    *_, scene = scenes("restraint and separation rules, finite and small", 4)
    with pytest.warns(SolverWarning, match="another course, which"):
        fast = scene.run("fast")
    exact = scene.run("reference")
    peak, right = float(fast.peak_rotation), float(exact.peak_rotation)
    assert abs(peak - right) > 0.01 * right
    assert "repeat the run with accuracy='standard'" in fast.attrs["cautions"]


@pytest.mark.parametrize("scale", [1.00001, 1.001, 1.01])
def test_barely_rocking_block_does_not_warn(scale):
    """Just beyond g b/h all motion takes place within a few fixed steps."""
    system = rf.System(rf.Block(width="1 m", height="4 m", mass="10 t"))
    motion = rf.GroundMotion.sine_pulse(f"{scale * 9.80665 / 4} m/s^2", "1 Hz")
    run = system.simulate(motion, free_vibration="2 s", accuracy="fast", outputs=None)
    assert run.peak_relative_rotation < 1e-4
    assert run.attrs["cautions"] == "none"


def test_imperceptible_motion_is_still_compared():
    still = replace(STOOD, peak=1e-6, peak_share=1e-5)
    assert caution_of("standard", 2.0 * MAX_ADAPTIVE_RESIDUAL, base=still) == (None, [])
    assert (
        caution_of(
            "fast", 2.0 * MAX_FIXED_STEP_RESIDUAL, base=still, other=replace(still, peak=2e-6)
        )[0]
        is None
    )
    for other in (STOOD, replace(STOOD, overturned=True, time=1.0)):
        text, tried = caution_of("fast", 2.0 * MAX_FIXED_STEP_RESIDUAL, base=still, other=other)
        assert "adaptive steps give another course" in text
        assert len(tried) == 1


@pytest.mark.parametrize("start", ["0.1 rad", "-0.1 rad"])
def test_kinetic_energy_at_the_end_is_that_about_the_corner(start):
    """Housner's block: 4/3 m R^2 about either corner."""
    system = rf.System(rf.Block(width="1 m", height="4 m", mass="10 t"))
    initial = rf.InitialState(rotation=start)
    plan = plan_run(system.assembly, None, duration="0.3 s", initial=initial, outputs=None)
    ending = compute_response(system.assembly, plan).trajectory.ending
    rate = ending.state[1]
    assert abs(rate) > 0.1
    expected = 0.5 * (4.0 / 3.0) * 10e3 * (0.5**2 + 2.0**2) * rate**2
    assert soundness._kinetic_energy(system.assembly, ending) == pytest.approx(expected, rel=1e-12)
