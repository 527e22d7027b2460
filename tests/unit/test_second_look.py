"""Single runs at "fast" are repeated with a finer step to estimate their error."""

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

import rockframe as rf
from rockframe.simulation.certify.certificate import SAFETY
from rockframe.simulation.certify.second_look import (
    ADDED_STEPS,
    MAX_PEAK_ERROR,
    Look,
    doubts,
    is_together,
    peak_error,
    second_look,
)
from rockframe.simulation.plan import plan_run
from rockframe.simulation.run import compute_response
from rockframe.solve.workspace import Status

SYSTEM = rf.System(
    rf.Block.from_size(radius="2.5 m", slenderness=4.5, mass="20 t"),
    rf.TwoSpringSupport(frequency_ratio=10, damping_ratio=0.1),
)
PULSE = rf.GroundMotion.sine_pulse("-3 m/s^2", "1 Hz")


def fast(system=SYSTEM, motion=PULSE, **arguments):
    """Run at "fast"; return the result and its warnings."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        plan = {"free_vibration": "4 s", "outputs": None, **arguments}
        run = system.simulate(motion, accuracy="fast", **plan)
    return run, [str(one.message) for one in caught]


def noise():
    white = np.random.default_rng(8).normal(size=700)
    smooth = np.convolve(white, np.ones(6) / 6, "same")
    return rf.GroundMotion.from_arrays((6 * smooth, "m/s^2"), "0.02 s", name="noise")


def test_reliable_fast_run_is_silent_and_estimates_peak_error():
    run, messages = fast()
    assert messages == []
    substeps = run.attrs["solver_substeps"]
    finer = rf.Accuracy(substeps=substeps + math.ceil(ADDED_STEPS * substeps))
    again = SYSTEM.simulate(PULSE, free_vibration="4 s", outputs=None, accuracy=finer)
    exact = SYSTEM.simulate(PULSE, free_vibration="4 s", outputs=None, accuracy="reference")
    estimate = float(run.peak_error_estimate)
    assert estimate == SAFETY * abs(float(run.peak_rotation) - float(again.peak_rotation))
    assert abs(float(run.peak_rotation) - float(exact.peak_rotation)) <= estimate
    assert estimate < 1e-3 * float(run.peak_rotation)


@pytest.mark.parametrize(
    ("number", "ratio", "words"),
    [
        (35, 60.0, "the verdict is not sure"),
        (7, 28.0, "its peak rotation is"),
        (20, 14.0, "its peak rotation is"),
    ],
)
def test_inaccurate_fast_run_warns(number, ratio, words):
    """One verdict and two peaks among 384 scales of noise on six pads."""
    pads = rf.TwoSpringSupport(frequency_ratio=ratio, damping_ratio=0.1)
    system = rf.System(rf.Block.from_size(radius="2.5 m", slenderness=4.5, mass="20 t"), pads)
    motion = noise().scaled(float(np.linspace(0.4, 1.1, 64)[number]))
    run, messages = fast(system, motion, free_vibration=None)
    exact = system.simulate(motion, outputs=None, accuracy="reference")
    other = bool(run.overturned) != bool(exact.overturned)
    off = abs(float(run.peak_rotation) - float(exact.peak_rotation))
    assert other or off > MAX_PEAK_ERROR * float(exact.peak_rotation)
    assert other == (words == "the verdict is not sure")
    assert any(words in one for one in messages)
    assert words in run.attrs["cautions"]
    assert float(run.energy_residual) < 0.01  # which does not reveal the error
    # no warning without the second look
    _, messages = fast(system, motion, free_vibration=None, second_look=False)
    assert not any("not sure" in one for one in messages)


def test_second_look_can_be_disabled_and_applies_only_to_fast(monkeypatch):
    made = []

    def counted(system, plan):
        made.append(second_look(system, plan))
        return made[-1]

    monkeypatch.setattr("rockframe.simulation.run.second_look", counted)
    run, _ = fast(second_look=False)
    assert "peak_error_estimate" not in run
    SYSTEM.simulate(PULSE, accuracy="standard")
    SYSTEM.simulate(PULSE, accuracy=rf.Accuracy(substeps=4))
    rf.sweep(SYSTEM, PULSE, scale=[0.5, 1.0], accuracy="fast", progress=False)
    assert made == []
    fast()
    assert len(made) == 1
    assert made[0].output_step is None


@pytest.fixture(scope="module")
def base():
    plan = plan_run(SYSTEM.assembly, PULSE, free_vibration="4 s", accuracy="fast", outputs=None)
    return plan, compute_response(SYSTEM.assembly, plan).trajectory


def doubts_between(base, first, second):
    plan, run = base
    return list(doubts(SYSTEM.setting, plan, replace(run, **first), replace(run, **second)))


STANDS = {"status": Status.COMPLETED, "overturning_time": math.nan, "overturning_direction": 0}
FALLS = {"status": Status.OVERTURNED, "overturning_time": 2.0, "overturning_direction": 1}
CUT = {"status": Status.CHATTER}


def test_second_look_messages(base):
    standing = {**STANDS, "peak_left": 0.0, "peak_right": 0.1}
    angle = SYSTEM.setting.overturning_angle
    falling = {**FALLS, "peak_left": 0.0, "peak_right": angle}
    assert doubts_between(base, standing, standing) == []
    # small impacts after the peak may differ if the peak does not
    assert doubts_between(base, standing, {**standing, "impact_count": 99}) == []
    [other] = doubts_between(base, standing, {**standing, "impact_count": 99, "peak_right": 0.1006})
    assert "the verdict is not sure" in other
    assert doubts_between(base, CUT, standing) == []
    [cut] = doubts_between(base, standing, CUT)
    assert cut.startswith("with 1.5 times as many steps the run cannot be finished: the verdict")
    verdict, peak = doubts_between(base, standing, falling)
    assert "the body overturns to the right at 2.000 s: the verdict is not sure" in verdict
    assert f"its peak rotation is {angle:.4g} rad, not 0.1: it is not sure" in peak
    assert doubts_between(base, falling, falling) == []
    assert (
        doubts_between(base, falling, {**falling, "impact_count": 99, "overturning_time": 2.001})
        == []
    )
    assert doubts_between(base, falling, {**falling, "overturning_time": 2.02}) == []
    assert doubts_between(base, falling, {**falling, "impact_count": 99, "overturning_time": 2.02})
    for other in ({"overturning_time": 2.5}, {"overturning_direction": -1}):
        [late] = doubts_between(base, falling, {**falling, **other})
        assert "the verdict is not sure" in late
    near, nearer = ({**standing, "peak_right": share * angle} for share in (0.97, 0.98))
    [close] = doubts_between(base, near, nearer)
    assert "stands, its peak 98 % of the overturning angle: the verdict is not sure" in close


@pytest.mark.parametrize(
    ("off", "count"), [(0.9 * MAX_PEAK_ERROR / SAFETY, 0), (1.1 * MAX_PEAK_ERROR / SAFETY, 1)]
)
def test_large_estimated_peak_error_warns(base, off, count):
    first, second = (
        {**STANDS, "peak_left": 0.0, "peak_right": at} for at in (0.1, 0.1 + 0.1 * off)
    )
    assert len(doubts_between(base, first, second)) == count
    _, run = base
    error = peak_error(replace(run, **first), replace(run, **second))
    assert error == pytest.approx(SAFETY * 0.1 * off)
    assert math.isnan(peak_error(replace(run, **first), replace(run, **CUT)))


def test_returning_block_is_judged_by_its_margin_beyond_the_angle(base):
    angle = SYSTEM.setting.overturning_angle
    came_back = {"status": Status.COMPLETED, "overturning_time": 2.0, "peak_left": 0.0}
    beyond, farther, short = (
        {**came_back, "peak_right": share * angle} for share in (1.2, 1.201, 0.99)
    )
    assert doubts_between(base, beyond, farther) == []
    assert doubts_between(base, beyond, {**short, **STANDS})


STANDS_AT_60 = Look(
    overturned=False, share=0.6, impacts=20, time=math.nan, left=math.nan, direction=0,
    frequency=1.5,
)  # fmt: skip
FALLS_AT_8 = Look(
    overturned=True, share=1.0, impacts=20, time=8.0, left=12.0, direction=1, frequency=1.5
)


@pytest.mark.parametrize(
    ("first", "changes", "together"),
    [
        # with other impacts, peaks may differ by a third of a hundredth
        (STANDS_AT_60, {"share": 0.6019, "impacts": 99}, True),
        (STANDS_AT_60, {"share": 0.5981, "impacts": 99}, True),
        (STANDS_AT_60, {"share": 0.6021, "impacts": 99}, False),
        # and energies at overturning by a tenth: 3 times 2 omega dt
        (FALLS_AT_8, {"time": 8.0110, "impacts": 99}, True),
        (FALLS_AT_8, {"time": 8.0112, "impacts": 99}, False),
        # with a difference of impacts up to a twentieth only the verdict must be clear
        (STANDS_AT_60, {"share": 0.65, "impacts": 21}, True),
        (STANDS_AT_60, {"share": 0.65, "impacts": 19}, True),
        (STANDS_AT_60, {"share": 0.65, "impacts": 22}, False),
        (STANDS_AT_60, {"share": 0.75}, False),
        (FALLS_AT_8, {"time": 8.1}, True),
        (FALLS_AT_8, {"time": 8.12}, False),
        (FALLS_AT_8, {"direction": -1}, False),
        (FALLS_AT_8, {"overturned": None}, False),
    ],
)
def test_runs_take_one_course_with_like_peaks_energies_or_impacts(first, changes, together):
    assert is_together(first, replace(first, **changes)) is together
