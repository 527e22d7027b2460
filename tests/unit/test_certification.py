"""Sentences of certificates, and runs that can be certified."""

import itertools
import math
import warnings
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from pages import numbers_in, read
from unit.certified import (
    BLOCK,
    NAMES,
    PADS,
    PULSE,
    SYSTEM,
    certificate_of,
    certified,
    edge,
    plan_of,
)

import rockframe as rf
from rockframe.dynamics.events import EventKind
from rockframe.errors import ComponentError, ModelWarning, SolverError, SolverWarning, UnitsError
from rockframe.results.outcome import verdict_of
from rockframe.simulation.certify.certificate import (
    NEAR,
    RESOLUTION,
    SAFETY,
    Certificate,
    confirms_verdict,
)
from rockframe.simulation.certify.perturbations import (
    DIVISIONS,
    SHORTER,
    divide_intervals,
    scales,
    with_shorter_steps,
)
from rockframe.simulation.certify.run_summary import RunSummary, run_summary
from rockframe.simulation.certify.scan import NOT_TRIED, Scan, Side, may_change_between, scan
from rockframe.simulation.run import compute_response
from rockframe.solve.accuracy import accuracy_of
from rockframe.solve.workspace import Status


def combinations():
    """Return certificates of all possible findings, for runs of either verdict."""
    stands, falls = RunSummary(False, 0.1, (0.5,)), RunSummary(True, 0.2, (1.0, 1.0), 1.0, 1)
    back, lost = RunSummary(False, 0.3, (0.5, 0.5)), RunSummary(None, 0.1)
    same = dict.fromkeys((-0.1, 0.1), stands)
    for course, base, moving in itertools.product(
        ("stop", "continue"), (stands, falls, back), (False, True)
    ):
        plan = replace(plan_of(), stop_at_overturning=course == "stop")
        other = stands if base.overturned else falls
        near_flip = replace(base, clearances=tuple(0.5 * one for one in base.clearances))
        finer = [base, other, lost, near_flip]
        nudged = [
            Scan(1e-3, None, None, followed=True, tried=same),
            Scan(5e-4, 5e-4, other, followed=True, tried=same),
            Scan(5e-4, None, None, followed=False, tried=same),
        ]
        along = [NOT_TRIED, Scan(0.5, None, None, followed=True, tried=same)]
        for margin, flip in itertools.product(
            (1e-4, 0.0049, 0.03, 0.3), (0.0001, 0.005, 0.012, 0.122, 0.4, None)
        ):
            size = 0.5 if flip is None else flip
            if margin <= size:
                sign = -1.0 if flip == 0.122 else 1.0
                signed = None if flip is None else sign * flip
                followed = flip is not None and size - margin <= RESOLUTION
                ended = None if flip is None else other
                along.append(Scan(margin, signed, ended, followed=followed, tried=same))
        for one, parameter, scaled in itertools.product(finer, nudged, along):
            for settings in (rf.Certification(), rf.Certification(nudge=0.1, reach=0.5)):
                yield Certificate(
                    settings, plan, replace(base, in_motion=moving), [("means", one)],
                    [("parameter", parameter)], scaled,
                )  # fmt: skip


def test_certificate_sentence_matches_its_numbers():
    """For all findings: the known flip, the margin, and whether the verdict is certain."""
    seen = set()
    for found in combinations():
        text, values, attributes = found.sentence, found.values(), found.attributes()
        flip, margin = values["verdict_flip_scale"], values["verdict_margin"]
        seen.add((found.converged, found.robust, math.isnan(flip), math.isnan(margin)))
        assert attributes["certificate"] == text
        scaled = f"scaled {'up' if flip > 1.0 else 'down'} by {100.0 * abs(flip - 1.0):.3g} %"
        nearest = f"with another verdict is {flip:.6g}."
        # a known flip is stated once, an unknown one never
        count = (scaled in text) + (nearest in text)
        assert count == (0 if math.isnan(flip) else 1), text
        assert ("another verdict is" in text) + ("scaled" in text) == count, text
        doubt = text.startswith("Near the boundary: ")
        assert doubt or (found.converged and found.robust), text
        assert doubt != (" also with " in text)
        sure = (
            found.converged and found.robust and not margin <= max(NEAR, found.certification.nudge)
        )
        assert doubt != sure, text
        if not doubt and not math.isnan(margin):
            assert f"tried from {1.0 - margin:.6g} to {1.0 + margin:.6g}" in text
            assert found.along.followed != ("were too few to extend" in text)
        if found.along.tried and margin <= max(NEAR, found.certification.nudge):
            assert found.along.followed or "to resolve the dependence" in text or scaled in text
        stops = found.plan.stop_at_overturning
        words = ("overturns", "stands") if stops else ("falls flat", "does not fall flat")
        assert f"body {words[not found.base.overturned]}" in text
        other = ("falls flat", "does not fall flat") if stops else (" overturns", " stands")
        assert not any(one in text for one in other), text
    assert {one[:3] for one in seen} == set(itertools.product((True, False), repeat=3))


def test_reach_smaller_than_the_nudge_is_sufficient():
    same = {scale: RunSummary(False, 0.1, (0.5,)) for scale in (-0.01, 0.01)}
    along = Scan(0.01, None, None, followed=True, tried=same)
    settings = rf.Certification(nudge=0.1, reach=0.01)
    found = Certificate(settings, plan_of(), same[0.01], along=along)
    assert found.robust
    assert found.sentence.startswith("The body stands also with")


def test_continued_run_is_judged_by_falling_flat():
    """Under a pulse that returns the block from up to 3.735 times the overturning angle."""
    system = rf.System(rf.Block(width="1 m", height="5 m", mass="10 t"))
    pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz").scaled(3.70)
    run = system.simulate(
        pulse, free_vibration="10 s", overturning="continue", certify=True, outputs=None
    )
    assert bool(run.overturned)  # it passed the overturning angle
    assert verdict_of(run) is False
    flip = float(run.verdict_flip_scale)
    assert flip == pytest.approx(3.736 / 3.70, abs=1e-3)
    assert float(run.verdict_margin) == pytest.approx(flip - 1.0, rel=0.01)
    assert run.attrs["certificate"].startswith("Near the boundary: the body does not fall flat")
    assert "scaled up by 0.9" in run.attrs["certificate"]


def test_margin_is_the_reach_if_no_scale_flips():
    found = certificate_of(lambda _, plan: plan.motion.si.peak > 1.6 * PULSE.si.peak)
    assert found.margin == 0.5
    assert math.isnan(found.flip)
    assert "scales of the motion tried from 0.5 to 1.5." in found.sentence


def test_a_run_that_was_cut_off_has_no_certificate():
    limit = rf.Accuracy(rtol=1e-8, max_steps=60)
    with pytest.warns(SolverWarning, match="Not finished: stopped at"):
        run = certified(PULSE.scaled(3.0 * edge()), accuracy=limit)
    assert run.attrs["certificate"] == "No certificate: the run was not finished."
    assert run.attrs["certificate_runs"] == 0
    assert not run.verdict_converged
    assert not run.verdict_robust
    assert all(math.isnan(run[name]) for name in NAMES[2:])


def test_unfinished_nearby_runs_do_not_support_the_verdict():
    tighter = certificate_of(lambda _, plan: None if plan.accuracy.rtol < 1e-5 else False)
    assert not tighter.converged
    assert math.isnan(tighter.peak_error)
    assert "a tolerance 100 times tighter the run cannot be finished" in tighter.sentence

    softer = certificate_of(
        lambda system, _: None if system.parts.pads.to_dict()["frequency_ratio"] < 19.99 else False
    )
    assert not softer.robust
    assert math.isnan(softer.peak_sensitivity)
    assert "-0.1 % the run cannot be finished" in softer.sentence

    peak = 1.005 * PULSE.si.peak
    larger = certificate_of(lambda _, plan: None if plan.motion.si.peak > peak else False)
    assert larger.margin == pytest.approx(0.005, rel=2.0 * RESOLUTION)
    assert larger.robust
    assert "scaled up by 0.501 % the run cannot be finished" in larger.sentence


def test_the_tightest_tolerance_is_not_tightened_beyond_rounding():
    seen = []
    certificate_of(lambda _, plan: seen.append(plan.accuracy.rtol) or False, rtol=1e-12)
    assert min(seen) == 1e-13


def test_fixed_steps_are_certified_by_a_tolerance():
    run = certified(accuracy="fast")
    exact = SYSTEM.simulate(PULSE, free_vibration="4 s", accuracy="standard", outputs=None)
    off = abs(float(run.peak_rotation) - float(exact.peak_rotation))
    assert float(run.peak_error_estimate) >= SAFETY * off * (1.0 - 1e-12)
    assert "with adaptive steps instead of fixed ones" in run.attrs["certificate"]


def test_sensitivity_equals_change_under_nudged_parameters():
    run = certified(certify=rf.Certification(nudge=0.02))
    peaks = [float(run.peak_rotation)]
    for part in (BLOCK, PADS):
        for name in part.parameters():
            for factor in (0.98, 1.02):
                parts = [p for p in (BLOCK, PADS) if p is not part] + [
                    part.with_scaled(name, factor)
                ]
                other = rf.System(*parts).simulate(PULSE, free_vibration="4 s", outputs=None)
                peaks.append(float(other.peak_rotation))
    expected = max(abs(peak - peaks[0]) for peak in peaks)
    # or slightly more, inside the nudge
    assert float(run.peak_sensitivity) >= expected * (1.0 - 1e-12)
    assert float(run.peak_sensitivity) == pytest.approx(expected, rel=0.05)


def test_initial_state_is_scaled_without_a_motion():
    start = rf.InitialState(rotation=f"{0.9 * BLOCK.si.overturning_angle!r} rad")
    run = certified(None, duration="20 s", initial=start)
    assert not bool(run.overturned)
    assert run.attrs["certificate"].startswith("The body stands")
    assert "of the start" in run.attrs["certificate"]


@pytest.mark.parametrize("share", [0.0, 0.3])
def test_margin_of_an_initial_state_follows_from_energy(share):
    """A rigid block overturns if its energy lifts its centre of mass above the corner."""
    block, edge = rf.Block.from_size(radius="2 m", slenderness=4, mass="1 t"), 1.1
    angle = block.si.overturning_angle
    rate = math.sqrt(1.5 * 9.80665 / 2.0 * (1.0 - math.cos((1.0 - share) * angle)))
    start = rf.InitialState(
        rotation=f"{share * angle / edge!r} rad", angular_velocity=f"{rate / edge!r} rad/s"
    )
    run = certified(None, rf.System(block), duration="20 s", initial=start)
    assert not bool(run.overturned)
    assert float(run.verdict_margin) == pytest.approx(edge - 1.0, rel=2.0 * RESOLUTION)


def test_initial_state_is_not_scaled_beyond_a_right_angle():
    low = rf.System(rf.Block(width="4 m", height="3 m", mass="1 t"))
    run = certified(
        None,
        low,
        certify=rf.Certification(reach=0.9),
        duration="1 s",
        initial=rf.InitialState(rotation="0.85 rad"),
    )
    assert not bool(run.overturned)
    assert float(run.verdict_margin) == 0.9


def test_run_at_rest_has_no_margin():
    run = certified(None, duration="1 s")
    assert math.isnan(run.verdict_margin)
    assert bool(run.verdict_robust)
    assert run.attrs["certificate"] == (
        "The body stands also with a tolerance 100 times tighter and steps 2.7 times shorter, "
        "and with every parameter up to 0.1 % larger or smaller."
    )


def test_continued_run_is_compared_with_continued_runs():
    strong = PULSE.scaled(3.0 * edge())
    run = certified(strong, overturning="continue")
    assert bool(run.overturned)
    assert float(run.peak_rotation) == pytest.approx(0.5 * math.pi)
    assert float(run.peak_error_estimate) < 1e-9
    assert float(run.peak_sensitivity) < 1e-9


def test_barely_sufficient_substeps_are_certified():
    pads = rf.TwoSpringSupport(frequency_ratio=324.57, damping_ratio=0.1)
    system = rf.System(BLOCK, pads)
    accuracy = rf.Accuracy(substeps=4)
    with pytest.raises(SolverError, match="too few"):
        rf.System(BLOCK, pads.with_scaled("frequency_ratio", 1.001)).simulate(
            PULSE, accuracy=accuracy
        )
    run = certified(system=system, accuracy=accuracy)
    assert "larger or smaller" in run.attrs["certificate"]


CAP = rf.CushionCap(height="0.5 m", mass="10 t")
SOIL = rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0.1)


@pytest.mark.wide
@pytest.mark.parametrize(
    ("parts", "coupling"),
    [
        ((BLOCK,), "coupled"),
        ((BLOCK, SOIL), "coupled"),
        ((BLOCK, PADS, CAP, SOIL), "coupled"),
        ((BLOCK, PADS, CAP, SOIL), "cascade"),
    ],
)
def test_every_scene_can_be_certified(parts, coupling, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        run = certified(system=rf.System(*parts, coupling=coupling))
    assert all(math.isfinite(float(run[name])) for name in NAMES if name != "verdict_flip_scale")
    run.to_netcdf(tmp_path / "run.nc")
    with xr.open_dataset(tmp_path / "run.nc") as stored:
        xr.testing.assert_identical(stored[list(NAMES)].drop_attrs(), run[list(NAMES)].drop_attrs())


@pytest.mark.parametrize("value", [1, "yes", None, 0.01])
def test_invalid_certify_option_is_refused(value):
    with pytest.raises(ComponentError, match="must be True, False, 'proved' or a Certification"):
        SYSTEM.simulate(PULSE, certify=value)


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({"nudge": 0.0}, ComponentError, "nudge must be above 0 and at most 0.1"),
        ({"nudge": "1 m"}, UnitsError, "nudge needs a pure ratio"),
        ({"reach": 1.0}, ComponentError, "reach must be from 0.01 to 0.9"),
        ({"runs": 10}, ComponentError, "runs must be a whole number from 60 to 100000, got 10"),
    ],
)
def test_invalid_certification_settings_are_refused(arguments, error, words):
    with pytest.raises(error, match=words):
        rf.Certification(**arguments)


def test_with_scaled_scales_one_parameter():
    pads = PADS.with_scaled("damping_ratio", 2.0)
    assert pads == rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.20)
    wide = CAP.with_scaled("mass", 0.5)
    assert wide == rf.CushionCap(height="0.5 m", mass="5 t")
    soil = rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0.1, separation="pressure")
    assert soil.parameters() == ("stiffness", "damping_ratio")
    assert soil.with_scaled("stiffness", 2.0) == rf.WinklerSoil(
        stiffness="60 MPa", damping_ratio=0.1, separation="pressure"
    )
    with pytest.raises(ComponentError, match="no parameter is called 'colour'"):
        PADS.with_scaled("colour", 2.0)


MOTIONS = {
    "record": rf.GroundMotion.from_arrays(([0.0, 1.0, -2.0, 0.5], "m/s^2"), "0.1 s"),
    "pulse": PULSE,
    "both": PULSE.with_vertical(PULSE.scaled(0.5)),
}


@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("parts", DIVISIONS)
def test_divided_motion_is_the_same_function_of_time(name, parts):
    motion = MOTIONS[name]
    finer = divide_intervals(motion, parts)
    time = np.linspace(0.0, motion.si.duration, 997)
    size = motion.si.peak
    assert finer.si.time_step == motion.si.time_step / parts
    assert np.abs(finer.si.at(time) - motion.si.at(time)).max() < 1e-12 * size
    if motion.si.vertical is not None:
        upwards = finer.si.vertical.at(time) - motion.si.vertical.at(time)
        assert np.abs(upwards).max() < 1e-12 * size
    assert finer.si.horizontal.analytic == motion.si.horizontal.analytic


@pytest.mark.parametrize("accuracy", ["fast", "standard", "reference", rf.Accuracy(substeps=3)])
def test_shorter_step_settings_take_more_steps(accuracy):
    run = SYSTEM.simulate(PULSE, free_vibration="4 s", accuracy=accuracy)
    step = run.attrs["solver_end_time"] / run.attrs["solver_steps"]
    settings = with_shorter_steps(accuracy_of(accuracy), SYSTEM.assembly, step, PULSE.si.time_step)
    finer = SYSTEM.simulate(PULSE, free_vibration="4 s", accuracy=settings)
    assert finer.attrs["solver_steps"] > 2.0 * run.attrs["solver_steps"]


def test_verdict_is_confirmed_only_if_all_clearances_agree():
    """Clearances of an overturning body: its rate at that angle, and the time left."""
    falls = RunSummary(overturned=True, peak=0.2, clearances=(1.0, 0.5), time=4.0, direction=1)
    for clearances, sure in (
        ((1.1, 0.6), True),
        ((1.4, 0.5), False),
        ((1.0, 0.7), False),
        ((0.6, 0.3), False),
    ):
        assert confirms_verdict(falls, replace(falls, clearances=clearances)) is sure
    assert not confirms_verdict(falls, replace(falls, direction=-1))


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_scan_reports_the_nearest_flip_of_both_sides(sign):
    """Both flips lie between the same changes of the first row."""
    near, far = 0.12, 0.17

    def look(change):
        reached = sign * change > near or -sign * change > far
        left = min(abs(near - sign * change), abs(far + sign * change))
        return RunSummary(overturned=reached, peak=0.1, clearances=(left,))

    row = [0.05, 0.1, 0.2]
    found = scan(look, look(0.0), row, most=100, resolution=RESOLUTION)
    assert found.flip == pytest.approx(sign * near, rel=RESOLUTION)
    assert sign * found.flip > near
    assert found.ended.overturned
    assert found.margin <= near
    assert found.margin == pytest.approx(near, rel=2.0 * RESOLUTION)


def standing(clearance):
    return RunSummary(overturned=False, peak=0.1, clearances=(clearance,))


def side_of(clearances):
    """Return runs that stand, by the clearances at their changes."""
    return Side(
        1.0, {place: standing(one) for place, one in clearances.items()}, sorted(clearances)
    )


@pytest.mark.parametrize(
    ("clearances", "number", "doubtful"),
    [
        # alone: from a to b at twice its slope it goes to zero if a + b < 2 (a - b), b < a / 3
        ({0.0: 0.9, 1.0: 0.31}, 0, False),
        ({0.0: 0.9, 1.0: 0.29}, 0, True),
        ({0.0: 0.29, 1.0: 0.9}, 0, True),
        # the slope before it counts over two lengths of its interval: 2 * 2 * 0.1 * (slope - 0.1)
        # is less than 1.9 up to a slope of 4.85
        ({0.0: 2.48, 0.1: 2.0, 1.1: 1.9}, 1, False),
        ({0.0: 2.49, 0.1: 2.0, 1.1: 1.9}, 1, True),
        # and that after it too, over no more than the interval itself
        ({0.0: 1.9, 1.0: 2.0, 1.1: 2.48}, 0, False),
        ({0.0: 1.9, 1.0: 2.0, 1.1: 2.49}, 0, True),
        ({0.0: 5.0, 0.1: 5.0, 10.0: -15.0}, 0, False),
        ({0.0: 5.0, 0.1: 5.0, 10.0: -250.0}, 0, True),
        # the last interval before another verdict, if the slopes differ by no more than twice
        ({0.0: 1.0, 1.0: 0.6, 2.0: 0.1}, 1, False),
        ({0.0: 0.86, 1.0: 0.6, 2.0: 0.1}, 1, False),
        ({0.0: 0.84, 1.0: 0.6, 2.0: 0.1}, 1, True),
        ({0.0: 1.59, 1.0: 0.6, 2.0: 0.1}, 1, False),
        ({0.0: 1.61, 1.0: 0.6, 2.0: 0.1}, 1, True),
        # but not where another interval follows
        ({0.0: 1.0, 1.0: 0.6, 2.0: 0.1, 3.0: 0.1}, 1, True),
    ],
)
def test_clearances_that_may_reach_zero_are_doubtful(clearances, number, doubtful):
    assert may_change_between(side_of(clearances), number) is doubtful


@pytest.mark.parametrize(("beyond", "doubtful"), [(1.4, False), (0.6, True)])
def test_the_first_interval_is_compared_with_that_of_the_other_sign(beyond, doubtful):
    """A clearance that falls from one sign to the other is straight; a peak at zero is bent."""
    side = side_of({0.0: 1.0, 1.0: 0.6})
    assert may_change_between(side, 0, side_of({0.0: 1.0, 1.0: beyond})) is doubtful


@pytest.mark.parametrize(
    ("place", "length", "rough"),
    [
        (1.05, 0.1, True),
        (1.84, 0.1, True),  # eight lengths away
        (0.26, 0.1, True),
        (1.86, 0.1, False),
        (0.24, 0.1, False),
        (1.05, 0.139, True),  # 1.4 times longer or shorter
        (1.05, 0.141, False),
        (1.05, 0.072, True),
        (1.05, 0.071, False),
    ],
)
def test_two_different_courses_nearby_make_an_interval_doubtful(place, length, rough):
    side = side_of({0.0: 0.5, 1.0: 0.5, 1.1: 0.5})
    side.rough = [(1.05, 0.1)]
    assert not side.is_rough(1.0, 1.1)
    side.rough.append((place, length))
    assert side.is_rough(1.0, 1.1) is rough
    assert may_change_between(side, 1) is rough


def test_intervals_between_different_courses_are_kept_by_middle_and_length():
    side = side_of({0.0: 0.5})
    side.add(1.0, standing(0.5))
    assert side.rough == []
    side.add(0.4, RunSummary(overturned=False, peak=0.3, clearances=(0.5, 0.5)))
    assert side.rough == [(0.2, 0.4), (0.7, pytest.approx(0.6))]


def test_course_weighs_events_by_their_distance_from_six_instants():
    """An event halfway between two instants counts half at either, one at an instant there only."""
    trajectory = compute_response(SYSTEM.assembly, plan_of()).trajectory
    assert not trajectory.overturned
    events = {
        "event_time": np.array([1.0, 3.0, 10.0]),
        "angular_velocity_before": np.array([-2.0, 3.0, -0.5]),
        "event_kind": np.array([EventKind.IMPACT] * 3),
    }
    still = {"in_motion": False, "slides": 0.0, "slip": 0.0}
    summary = run_summary(trajectory, events, 0.3, 10.0, **still)
    first, third = 2.0 / math.sqrt(2.0), 3.0 / math.sqrt(2.0)
    course = (first, math.hypot(first, third), third, 0.0, 0.0, 0.5)
    assert summary.course == pytest.approx(course, abs=1e-6)
    assert summary.clearances == (pytest.approx(0.7),)
    assert summary.step == trajectory.end_time / trajectory.step_count
    # one that comes back from beyond the angle, and one that overturns
    back = replace(trajectory, overturning_time=2.0, peak_right=math.pi / 8.0, peak_left=0.1)
    summary = run_summary(back, events, 1.25, 10.0, **still)
    assert summary.clearances == pytest.approx((0.25, 0.75))
    falls = replace(back, status=Status.OVERTURNED, overturning_time=7.0)
    events["event_kind"][1] = EventKind.OVERTURNING
    summary = run_summary(falls, events, 1.0, 10.0, **still)
    assert summary.clearances == pytest.approx((9.0, 3.0))


def test_courses_are_alike_within_a_fifth_of_their_largest_rate():
    stands = replace(standing(0.5), course=(1.0, 0.2))
    assert stands.alike(replace(stands, course=(1.0, 0.39)))
    assert not stands.alike(replace(stands, course=(1.0, 0.41)))
    # and overturn in the same swing if their times differ by less than a twentieth
    falls = RunSummary(overturned=True, peak=0.2, clearances=(1.0, 0.5), time=4.0, direction=1)
    for time, alike in ((4.2, True), (4.22, False), (3.81, True), (3.79, False)):
        assert falls.alike(replace(falls, time=time)) is alike
    assert not falls.alike(replace(falls, direction=-1))
    assert not stands.alike(replace(stands, clearances=(0.5, 0.5)))


def test_changes_at_the_reach_are_counted_as_tried():
    base = RunSummary(overturned=False, peak=0.1, clearances=(0.9,))
    found = scan(lambda _: base, base, [0.1, 0.2], most=100, resolution=0.5)
    assert found.margin == 0.2
    assert found.within(found.margin) == len(found.tried)
    assert found.within(0.1) == sum(abs(change) < 0.11 for change in found.tried)


@pytest.mark.parametrize(
    ("nudge", "reach", "expected"),
    [
        # a quarter and a half of the nudge, the nudge, steps of a quarter, at most 0.04 of the
        # reach; the last one but the reach is left out if it is nearer than half a step
        (0.1, 0.1175, [0.025, 0.05, 0.1, 0.1047, 0.1094, 0.1141, 0.1175]),
        (0.1, 0.12, [0.025, 0.05, 0.1, 0.1048, 0.1096, 0.1144, 0.12]),
        (0.2, 0.09, [0.05, 0.09]),
        (0.5, 0.1, [0.1]),
    ],
)
def test_first_changes_of_scale_grow_by_a_quarter_or_a_share_of_the_reach(nudge, reach, expected):
    assert scales(nudge, reach) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("step", "substeps"),
    [
        (0.002, 14),  # 2.7 times more steps than the run made: 0.01 / 0.002 * 2.7 = 13.5
        (0.01, 9),  # and than it was asked for: 3 * 2.7 = 8.1
    ],
)
def test_shorter_steps_are_2_7_times_as_many_as_made_or_asked_for(step, substeps):
    finer = with_shorter_steps(rf.Accuracy(substeps=3), SYSTEM.assembly, step, 0.01)
    assert finer.substeps == substeps


def test_documentation_matches_certification_constants():
    page = "guide/tradeoff.md"
    assert numbers_in(page, "at most `rf.Certification(runs=...)`, # unless given") == [200]
    assert numbers_in(page, "steps # times shorter than they were on average") == [SHORTER]
    assert numbers_in(
        page, "three with every interval of the motion divided into #, # and #"
    ) == list(DIVISIONS)
    assert "is three times the largest difference of their peaks" in read(page).replace("\n  ", " ")
    assert SAFETY == 3.0
    assert numbers_in(page, "down to `certificate_resolution`, # %") == [100.0 * RESOLUTION]
