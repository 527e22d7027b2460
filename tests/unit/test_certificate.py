"""Certificates: how sure a verdict is."""

import itertools
import math
import re
import warnings
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import xarray as xr
from pages import read, said

import rockframe as rf
from rockframe.errors import ComponentError, ModelWarning, SolverError, SolverWarning, UnitsError
from rockframe.results.outcome import verdict_of
from rockframe.simulation.certify.certificate import (
    NEAR,
    RESOLUTION,
    SAFETY,
    Certificate,
    certify,
    settles,
)
from rockframe.simulation.certify.perturbations import CUTS, SHORTER, cut, parameters, shortened
from rockframe.simulation.certify.run_summary import RunSummary
from rockframe.simulation.certify.scan import NOT_TRIED, Scan, scan
from rockframe.simulation.plan import plan_run
from rockframe.solve.accuracy import accuracy_of

BLOCK = rf.Block.from_size(radius="5 m", slenderness=5, mass="50 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
SYSTEM = rf.System(BLOCK, PADS)
PULSE = rf.GroundMotion.sine_pulse("-3 m/s^2", "1 Hz")
NAMES = (
    "verdict_converged",
    "verdict_robust",
    "verdict_margin",
    "verdict_flip_scale",
    "peak_error_estimate",
    "peak_sensitivity",
)


def certified(motion=PULSE, system=SYSTEM, certify=True, **arguments):
    arguments = {"free_vibration": "4 s", **arguments} if motion is not None else arguments
    return system.simulate(motion, certify=certify, **arguments)


def falls(scale, system=SYSTEM):
    run = system.simulate(PULSE.scaled(scale), free_vibration="4 s", outputs=None)
    return bool(run.overturned)


@cache
def edge(low=1.0, high=8.0):
    """Find the scale at which the verdict changes."""
    assert falls(high)
    assert not falls(low)
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if falls(middle) else (middle, high)
    return 0.5 * (low + high)


def test_a_run_without_a_certificate_has_none():
    run = SYSTEM.simulate(PULSE, free_vibration="4 s")
    assert not set(NAMES) & set(run)
    assert "certificate" not in run.attrs


def test_far_from_the_boundary():
    run = certified()
    assert bool(run.verdict_converged)
    assert bool(run.verdict_robust)
    assert float(run.verdict_margin) > 0.01
    assert 0.0 < float(run.peak_error_estimate) < 1e-6 * float(run.peak_rotation)
    assert run.attrs["certificate"].startswith("The body stands also with a tolerance 100 times")
    assert run.attrs["certificate_nudge"] == 1e-3
    assert run.attrs["certificate_resolution"] == RESOLUTION
    assert 60 <= run.attrs["certificate_runs"] <= 200


def test_the_run_itself_is_the_same():
    plain = SYSTEM.simulate(PULSE, free_vibration="4 s")
    xr.testing.assert_identical(certified()[list(plain)].drop_attrs(), plain.drop_attrs())


@pytest.mark.parametrize("off", [0.03, 0.2])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_the_margin_is_the_distance_to_the_boundary(off, side):
    """Up to the resolution: the bisection of an interval of a geometric row."""
    scale = edge() / (1.0 + side * off)
    run = certified(PULSE.scaled(scale))
    assert bool(run.overturned) == (side < 0.0)
    found, flip = float(run.verdict_margin), float(run.verdict_flip_scale)
    assert off * (1.0 - 2.0 * RESOLUTION) <= found <= off
    # the verdict does change there, and not at the margin
    assert falls(scale * flip) != bool(run.overturned)
    assert falls(scale * (1.0 + side * found)) == bool(run.overturned)
    assert abs(flip - 1.0) - found <= 1.01 * RESOLUTION * abs(flip - 1.0)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_near_the_boundary_it_says_so(side):
    run = certified(PULSE.scaled(edge() * (1.0 - side * 1e-4)))
    assert bool(run.overturned) == (side < 0.0)
    assert not bool(run.verdict_robust)
    assert float(run.verdict_margin) < 1.1e-3
    text = run.attrs["certificate"]
    assert text.startswith("Near the boundary: the body")
    assert "of the body" in text
    assert f"scaled {'up' if side > 0.0 else 'down'} by 0.0" in text


def pretended(overturns):
    """Give a run that overturns where a rule of scene and plan says so; None: is cut off."""

    def run(system, plan):
        verdict = overturns(system, plan)
        clearances = (1.0, 1.0) if verdict else (0.5,)
        return RunSummary(verdict, 0.1 + plan.accuracy.rtol, clearances, 1.0, 0, 0.001)

    return run


def planned(rtol=1e-4):
    return plan_run(
        SYSTEM.assembly,
        PULSE,
        duration=None,
        free_vibration=None,
        initial=None,
        accuracy=rf.Accuracy(rtol=rtol),
        output_step=None,
        outputs=(),
        overturning="stop",
    )


def certificate_of(overturns, rtol=1e-4):
    run, plan = pretended(overturns), planned(rtol)
    return certify(SYSTEM.assembly, plan, run(SYSTEM.assembly, plan), rf.Certification(), run)


def test_a_verdict_that_hangs_on_the_tolerance_is_not_converged():
    found = certificate_of(lambda _, plan: plan.accuracy.rtol > 1e-5)
    assert not found.converged
    assert found.robust
    assert found.peak_error == pytest.approx(SAFETY * 0.99e-4)
    assert found.sentence == (
        "Near the boundary: the body overturns, but with a tolerance 100 times tighter it stands."
    )


def test_a_verdict_that_only_a_tighter_tolerance_overturns_is_not_converged():
    found = certificate_of(lambda _, plan: plan.accuracy.rtol < 1e-5)
    assert not found.converged
    assert "the body stands, but with a tolerance 100 times tighter it overturns" in found.sentence


def test_a_verdict_that_hangs_on_one_parameter_is_not_robust():
    stiffer = 20.01
    found = certificate_of(
        lambda system, _: system.parts.pads.to_dict()["frequency_ratio"] > stiffer
    )
    assert found.converged
    assert not found.robust
    assert "with the frequency ratio of the base +0.1 % it overturns" in found.sentence


def test_parameters_that_change_the_verdict_are_counted():
    found = certificate_of(lambda system, _: system.to_dict() != SYSTEM.to_dict())
    changes = sum(len(part.parameters()) for part in (BLOCK, PADS))
    assert f"(and {changes - 1} more) it overturns" in found.sentence


def test_a_peak_that_a_parameter_lowers_counts_as_one_that_it_raises():
    run, plan = pretended(lambda *_: False), planned()

    def lower(system, plan):
        peak = 0.02 if system.parts.pads.to_dict()["frequency_ratio"] > 20.01 else 0.1001
        return replace(run(system, plan), peak=peak)

    found = certify(SYSTEM.assembly, plan, lower(SYSTEM.assembly, plan), rf.Certification(), lower)
    assert found.peak_sensitivity == pytest.approx(0.0801)


def test_nudged_scenes_keep_their_options():
    cap, soil = (
        rf.CushionCap(height="0.5 m", mass="10 t"),
        rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0.1),
    )
    options = {
        "restraint": "leading-corner",
        "rotation": "small",
        "coupling": "cascade",
        "gravity": "3.7 m/s^2",
    }
    system = rf.System(BLOCK, PADS, cap, soil, **options)
    kept = {name: value for name, value in system.to_dict().items() if name != "parts"}
    for words, scene_at in parameters(system.assembly):
        assert kept.items() <= scene_at(1e-3).to_dict().items(), words


def test_a_nudge_that_makes_parts_misfit_is_left_out():
    """A cap as wide as the block can be no narrower, nor the block any wider."""
    block = rf.Block(width="2 m", height="8 m", mass="50 t")
    cap = rf.CushionCap(width="2 m", height="0.5 m", mass="10 t")
    system = rf.System(block, cap, rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0.1))
    at = dict(parameters(system.assembly))
    assert at["width of the cap"](0.001) is not None
    assert at["width of the cap"](-0.001) is None
    assert at["width of the body"](-0.001) is not None
    assert at["width of the body"](0.001) is None


def test_what_a_scene_has_warned_of_its_certificate_does_not_repeat():
    with pytest.warns(ModelWarning, match="restitution"):
        system = rf.System(BLOCK, rf.RigidGround(restitution=1.0))
    assert "certificate" in certified(system=system).attrs


def test_the_runs_beside_are_counted():
    made = []
    found = certificate_of(lambda _, plan: made.append(plan) or False)
    assert found.runs == len(made) - 1  # the first is the run itself


@pytest.mark.parametrize("edge", [0.6, 0.97, 1.004, 1.2])
def test_the_nearest_scale_is_found(edge):
    peak = edge * PULSE.si.peak

    def overturns(_, plan):
        return plan.motion.si.peak > peak

    found = certificate_of(overturns)
    assert abs(edge - 1.0) * (1.0 - 2.0 * RESOLUTION) <= found.margin <= abs(edge - 1.0)
    assert found.flip == pytest.approx(edge, abs=2.0 * RESOLUTION * abs(edge - 1.0))


@pytest.mark.parametrize("edge", [1e-3, 1e-6, 1e-10])
def test_a_margin_has_no_floor(edge):
    found = certificate_of(lambda _, plan: plan.motion.si.peak / PULSE.si.peak > 1.0 + edge)
    assert edge * (1.0 - 2.0 * RESOLUTION) <= found.margin <= edge
    assert not found.robust or edge == 1e-3


def test_a_peak_that_comes_near_to_overturning_is_looked_into():
    """An island of overturning between two scales of the first row, told by the peaks about it."""
    middle, half = 0.3172, 0.0008

    def run(_, plan):
        off = plan.motion.si.peak / PULSE.si.peak - 1.0 - middle
        left = abs(off) - half
        fell = left < 0.0
        return RunSummary(fell, 0.1, (1.0, 1.0) if fell else (5.0 * left,), 1.0, 0, 0.001)

    plan = planned()
    found = certify(SYSTEM.assembly, plan, run(SYSTEM.assembly, plan), rf.Certification(), run)
    assert found.margin == pytest.approx(middle - half, rel=2.0 * RESOLUTION)
    assert found.margin <= middle - half


def test_a_course_that_cannot_be_followed_ends_the_margin():
    """Runs that all stand, each on a course of its own beyond a certain scale."""
    rng = np.random.default_rng(0)

    def run(_, plan):
        off = abs(plan.motion.si.peak / PULSE.si.peak - 1.0)
        course = (1.0, rng.uniform(0.0, 1.0) if off > 0.1 else 0.5)
        return RunSummary(False, 0.1, (0.5,), math.nan, 0, 0.001, course)

    plan = planned()
    found = certify(SYSTEM.assembly, plan, run(SYSTEM.assembly, plan), rf.Certification(), run)
    assert 0.09 < found.margin < 0.12
    assert math.isnan(found.flip)
    assert found.robust
    assert "200 runs were too few to extend this range" in found.sentence
    assert found.runs <= 200
    more = certify(
        SYSTEM.assembly, plan, run(SYSTEM.assembly, plan), rf.Certification(runs=400), run
    )
    assert 200 < more.runs <= 400
    assert more.margin >= found.margin


def test_a_course_that_is_lost_beside_the_run_says_how_many_runs_lost_it():
    rng = np.random.default_rng(0)

    def run(_, plan):
        off = abs(plan.motion.si.peak / PULSE.si.peak - 1.0)
        course = (1.0, rng.uniform(0.0, 1.0) if off > 0.004 else 0.5)
        return RunSummary(False, 0.1, (0.5,), math.nan, 0, 0.001, course)

    plan = planned()
    found = certify(SYSTEM.assembly, plan, run(SYSTEM.assembly, plan), rf.Certification(), run)
    assert found.margin < 0.01
    told = "Near the boundary: the body stands, but 200 runs were too few to resolve"
    assert told in found.sentence


def test_the_peak_of_a_standing_body_must_be_sure_to_stay_below():
    def run(_, plan):
        left = 0.01 if plan.accuracy.rtol > 1e-5 else 0.004
        return RunSummary(False, 0.1, (left,), math.nan, 0, 0.001)

    plan = planned()
    found = certify(SYSTEM.assembly, plan, run(SYSTEM.assembly, plan), rf.Certification(), run)
    assert not found.converged
    assert "its peak rotation is uncertain by" in found.sentence


def test_parameters_are_tried_inside_the_nudge():
    """A band of overturning well inside, with the nudge itself beyond it."""
    found = certificate_of(
        lambda system, _: 20.009 < system.parts.pads.to_dict()["frequency_ratio"] < 20.011
    )
    assert not found.robust
    assert "frequency ratio of the base +0.05 % it overturns" in found.sentence


@pytest.mark.parametrize(("lower", "upper"), [(0.98, 1.027), (0.973, 1.02)])
def test_of_two_changes_the_nearer_counts(lower, upper):
    """Both within one interval of the geometric row."""
    found = certificate_of(lambda _, plan: not lower < plan.motion.si.peak / PULSE.si.peak < upper)
    assert 0.02 * (1.0 - 2.0 * RESOLUTION) <= found.margin <= 0.02


@pytest.mark.parametrize(
    ("edge", "words"),
    [
        (1.008, "Near the boundary: .* scaled up by 0.8 %"),
        (0.992, "Near the boundary: .* scaled down by 0.8 %"),
        (1.02, "The body stands also .* No other verdict .* another verdict is 1.020"),
        (0.98, "The body stands also .* No other verdict .* another verdict is 0.979"),
    ],
)
def test_a_margin_of_more_than_a_hundredth_is_not_near(edge, words):
    found = certificate_of(
        lambda _, plan: (plan.motion.si.peak / PULSE.si.peak - edge) * (edge - 1.0) > 0.0
    )
    assert re.match(words, found.sentence)


def combinations():
    """Give certificates of all that may be found, in the runs of either sense."""
    stands, falls = RunSummary(False, 0.1, (0.5,)), RunSummary(True, 0.2, (1.0, 1.0), 1.0, 1)
    back, lost = RunSummary(False, 0.3, (0.5, 0.5)), RunSummary(None, 0.1)
    same = dict.fromkeys((-0.1, 0.1), stands)
    for course, base, moving in itertools.product(
        ("stop", "continue"), (stands, falls, back), (False, True)
    ):
        plan = replace(planned(), stop_at_overturning=course == "stop")
        other = stands if base.overturned else falls
        near_it = replace(base, clearances=tuple(0.5 * one for one in base.clearances))
        finer = [base, other, lost, near_it]
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
            for wanted in (rf.Certification(), rf.Certification(nudge=0.1, reach=0.5)):
                yield Certificate(
                    wanted, plan, replace(base, in_motion=moving), [("means", one)],
                    [("parameter", parameter)], scaled,
                )  # fmt: skip


def test_the_sentence_says_what_the_numbers_say():
    """Whatever was found: the flip that is known, the margin, and whether the verdict is sure."""
    seen = set()
    for found in combinations():
        text, values, attributes = found.sentence, found.values(), found.attributes()
        flip, margin = values["verdict_flip_scale"], values["verdict_margin"]
        seen.add((found.converged, found.robust, math.isnan(flip), math.isnan(margin)))
        assert attributes["certificate"] == text
        scaled = f"scaled {'up' if flip > 1.0 else 'down'} by {100.0 * abs(flip - 1.0):.3g} %"
        nearest = f"with another verdict is {flip:.6g}."
        # the flip is said once, wherever it is known, and none where it is not
        said = (scaled in text) + (nearest in text)
        assert said == (0 if math.isnan(flip) else 1), text
        assert ("another verdict is" in text) + ("scaled" in text) == said, text
        doubt = text.startswith("Near the boundary: ")
        assert doubt or (found.converged and found.robust), text
        assert doubt != (" also with " in text)
        sure = found.converged and found.robust and not margin <= max(NEAR, found.wanted.nudge)
        assert doubt != sure, text
        if not doubt and not math.isnan(margin):
            assert f"tried from {1.0 - margin:.6g} to {1.0 + margin:.6g}" in text
            assert found.along.followed != ("were too few to extend" in text)
        if found.along.tried and margin <= max(NEAR, found.wanted.nudge):
            assert found.along.followed or "to resolve the dependence" in text or scaled in text
        stops = found.plan.stop_at_overturning
        words = ("overturns", "stands") if stops else ("falls flat", "does not fall flat")
        assert f"body {words[not found.base.overturned]}" in text
        other = ("falls flat", "does not fall flat") if stops else (" overturns", " stands")
        assert not any(one in text for one in other), text
    assert {one[:3] for one in seen} == set(itertools.product((True, False), repeat=3))


def test_a_reach_within_the_nudge_is_all_that_is_asked():
    same = {scale: RunSummary(False, 0.1, (0.5,)) for scale in (-0.01, 0.01)}
    along = Scan(0.01, None, None, followed=True, tried=same)
    wanted = rf.Certification(nudge=0.1, reach=0.01)
    found = Certificate(wanted, planned(), same[0.01], along=along)
    assert found.robust
    assert found.sentence.startswith("The body stands also with")


def test_a_run_that_goes_on_is_judged_by_whether_it_falls_flat():
    """Under a pulse that brings the block back from beyond the angle, up to 3.735 of it."""
    system = rf.System(rf.Block(width="1 m", height="5 m", mass="10 t"))
    pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz").scaled(3.70)
    run = system.simulate(
        pulse, free_vibration="10 s", overturning="continue", certify=True, outputs=None
    )
    assert bool(run.overturned)  # it passed the angle
    assert verdict_of(run) is False
    flip = float(run.verdict_flip_scale)
    assert flip == pytest.approx(3.736 / 3.70, abs=1e-3)
    assert float(run.verdict_margin) == pytest.approx(flip - 1.0, rel=0.01)
    assert run.attrs["certificate"].startswith("Near the boundary: the body does not fall flat")
    assert "scaled up by 0.9" in run.attrs["certificate"]


def test_no_scale_within_reach():
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


def test_runs_beside_that_are_cut_off_are_no_support():
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


def test_the_sensitivity_is_that_of_nudged_parameters():
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
    # or a little more, somewhere inside the nudge
    assert float(run.peak_sensitivity) >= expected * (1.0 - 1e-12)
    assert float(run.peak_sensitivity) == pytest.approx(expected, rel=0.05)


def test_without_a_motion_the_start_is_scaled():
    start = rf.InitialState(rotation=f"{0.9 * BLOCK.si.overturning_angle!r} rad")
    run = certified(None, duration="20 s", initial=start)
    assert not bool(run.overturned)
    assert run.attrs["certificate"].startswith("The body stands")
    assert "of the start" in run.attrs["certificate"]


@pytest.mark.parametrize("share", [0.0, 0.3])
def test_the_margin_of_a_start_is_that_of_its_energy(share):
    """A rigid block overturns if it can lift its centre of mass above the corner."""
    block, edge = rf.Block.from_size(radius="2 m", slenderness=4, mass="1 t"), 1.1
    angle = block.si.overturning_angle
    rate = math.sqrt(1.5 * 9.80665 / 2.0 * (1.0 - math.cos((1.0 - share) * angle)))
    start = rf.InitialState(
        rotation=f"{share * angle / edge!r} rad", angular_velocity=f"{rate / edge!r} rad/s"
    )
    run = certified(None, rf.System(block), duration="20 s", initial=start)
    assert not bool(run.overturned)
    assert float(run.verdict_margin) == pytest.approx(edge - 1.0, rel=2.0 * RESOLUTION)


def test_a_start_is_not_scaled_beyond_a_right_angle():
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


def test_at_rest_nothing_can_be_scaled():
    run = certified(None, duration="1 s")
    assert math.isnan(run.verdict_margin)
    assert bool(run.verdict_robust)
    assert run.attrs["certificate"] == (
        "The body stands also with a tolerance 100 times tighter and steps 2.7 times shorter, "
        "and with every parameter up to 0.1 % larger or smaller."
    )


def test_a_run_that_goes_on_is_compared_with_runs_that_go_on():
    strong = PULSE.scaled(3.0 * edge())
    run = certified(strong, overturning="continue")
    assert bool(run.overturned)
    assert float(run.peak_rotation) == pytest.approx(0.5 * math.pi)
    assert float(run.peak_error_estimate) < 1e-9
    assert float(run.peak_sensitivity) < 1e-9


def test_sub_steps_that_just_do_for_the_run_are_certified():
    pads = rf.TwoSpringSupport(frequency_ratio=324.57, damping_ratio=0.1)
    system = rf.System(BLOCK, pads)
    given = rf.Accuracy(substeps=4)
    with pytest.raises(SolverError, match="too few"):
        rf.System(BLOCK, pads.with_scaled("frequency_ratio", 1.001)).simulate(PULSE, accuracy=given)
    run = certified(system=system, accuracy=given)
    assert "larger or smaller" in run.attrs["certificate"]


@pytest.mark.wide
@pytest.mark.parametrize(
    "parts",
    [
        (BLOCK,),
        (BLOCK, rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0.1)),
        (
            BLOCK,
            PADS,
            rf.CushionCap(height="0.5 m", mass="10 t"),
            rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0.1),
        ),
    ],
)
@pytest.mark.parametrize("coupling", ["coupled", "cascade"])
def test_every_scene_can_be_certified(parts, coupling, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        run = certified(system=rf.System(*parts, coupling=coupling))
    assert all(math.isfinite(float(run[name])) for name in NAMES if name != "verdict_flip_scale")
    run.to_netcdf(tmp_path / "run.nc")
    with xr.open_dataset(tmp_path / "run.nc") as stored:
        xr.testing.assert_identical(stored[list(NAMES)].drop_attrs(), run[list(NAMES)].drop_attrs())


@pytest.mark.parametrize("given", [1, "yes", None, 0.01])
def test_what_is_no_certification_is_refused(given):
    with pytest.raises(ComponentError, match="must be True, False, 'proved' or a Certification"):
        SYSTEM.simulate(PULSE, certify=given)


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({"nudge": 0.0}, ComponentError, "nudge must be above 0 and at most 0.1"),
        ({"nudge": "1 m"}, UnitsError, "nudge needs a pure ratio"),
        ({"reach": 1.0}, ComponentError, "reach must be from 0.01 to 0.9"),
        ({"runs": 10}, ComponentError, "runs must be a whole number from 60 to 100000, got 10"),
    ],
)
def test_certifications_that_are_refused(arguments, error, words):
    with pytest.raises(error, match=words):
        rf.Certification(**arguments)


def test_a_part_with_a_scaled_parameter():
    pads = PADS.with_scaled("damping_ratio", 2.0)
    assert pads == rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.20)
    wide = rf.CushionCap(height="0.5 m", mass="10 t").with_scaled("mass", 0.5)
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
@pytest.mark.parametrize("parts", CUTS)
def test_a_motion_cut_finer_is_the_same_function_of_time(name, parts):
    motion = MOTIONS[name]
    finer = cut(motion, parts)
    time = np.linspace(0.0, motion.si.duration, 997)
    size = motion.si.peak
    assert finer.si.time_step == motion.si.time_step / parts
    assert np.abs(finer.si.at(time) - motion.si.at(time)).max() < 1e-12 * size
    if motion.si.vertical is not None:
        upwards = finer.si.vertical.at(time) - motion.si.vertical.at(time)
        assert np.abs(upwards).max() < 1e-12 * size
    assert finer.si.horizontal.analytic == motion.si.horizontal.analytic


@pytest.mark.parametrize("accuracy", ["fast", "standard", "reference", rf.Accuracy(substeps=3)])
def test_shorter_steps_are_shorter(accuracy):
    run = SYSTEM.simulate(PULSE, free_vibration="4 s", accuracy=accuracy)
    step = run.attrs["solver_end_time"] / run.attrs["solver_steps"]
    settings = shortened(accuracy_of(accuracy), SYSTEM.assembly, step, PULSE.si.time_step)
    finer = SYSTEM.simulate(PULSE, free_vibration="4 s", accuracy=settings)
    assert finer.attrs["solver_steps"] > 2.0 * run.attrs["solver_steps"]


def test_a_verdict_is_settled_only_if_all_that_it_hangs_on_is():
    """Of a body that overturns: its rate at that angle, and the time that was left."""
    falls = RunSummary(overturned=True, peak=0.2, clearances=(1.0, 0.5), time=4.0, direction=1)
    for clearances, sure in (
        ((1.1, 0.6), True),
        ((1.4, 0.5), False),
        ((1.0, 0.7), False),
        ((0.6, 0.3), False),
    ):
        assert settles(falls, replace(falls, clearances=clearances)) is sure
    assert not settles(falls, replace(falls, direction=-1))


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_of_flips_to_both_sides_the_nearest_is_told(sign):
    """Both lie between the same changes of the first row."""
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


def test_changes_at_the_reach_itself_were_tried():
    base = RunSummary(overturned=False, peak=0.1, clearances=(0.9,))
    found = scan(lambda _: base, base, [0.1, 0.2], most=100, resolution=0.5)
    assert found.margin == 0.2
    assert found.within(found.margin) == len(found.tried)
    assert found.within(0.1) == sum(abs(change) < 0.11 for change in found.tried)


def test_the_page_says_what_is_done():
    page = "guide/tradeoff.md"
    assert said(page, "at most `rf.Certification(runs=...)`, # unless given") == [200]
    assert said(page, "steps # times shorter than they were on average") == [SHORTER]
    assert said(page, "three with every interval of the motion divided into #, # and #") == list(
        CUTS
    )
    assert "is three times the largest difference of their peaks" in read(page).replace("\n  ", " ")
    assert SAFETY == 3.0
    assert said(page, "down to `certificate_resolution`, # %") == [100.0 * RESOLUTION]
