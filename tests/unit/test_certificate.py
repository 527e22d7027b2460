"""Certificates: how certain a verdict is."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from unit.certified import (
    BLOCK,
    NAMES,
    PADS,
    PULSE,
    SYSTEM,
    artificial_run,
    certificate_of,
    certified,
    edge,
    falls,
    plan_of,
)

import rockframe as rf
from rockframe.errors import ModelWarning
from rockframe.simulation.certify.certificate import (
    RESOLUTION,
    SAFETY,
    certify,
)
from rockframe.simulation.certify.perturbations import parameters
from rockframe.simulation.certify.run_summary import RunSummary


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


def test_certification_does_not_change_the_run():
    plain = SYSTEM.simulate(PULSE, free_vibration="4 s")
    xr.testing.assert_identical(certified()[list(plain)].drop_attrs(), plain.drop_attrs())


@pytest.mark.parametrize(
    ("side", "off"),
    [
        (-1.0, 0.03),
        (1.0, 0.2),
        pytest.param(-1.0, 0.2, marks=pytest.mark.long),
        pytest.param(1.0, 0.03, marks=pytest.mark.long),
    ],
)
def test_the_margin_is_the_distance_to_the_boundary(off, side):
    """Up to the resolution of a bisection within an interval of the geometric row."""
    scale = edge() / (1.0 + side * off)
    run = certified(PULSE.scaled(scale))
    assert bool(run.overturned) == (side < 0.0)
    found, flip = float(run.verdict_margin), float(run.verdict_flip_scale)
    assert off * (1.0 - 2.0 * RESOLUTION) <= found <= off
    # the verdict changes there, and not at the margin
    assert falls(scale * flip) != bool(run.overturned)
    assert falls(scale * (1.0 + side * found)) == bool(run.overturned)
    assert abs(flip - 1.0) - found <= 1.01 * RESOLUTION * abs(flip - 1.0)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_certificate_near_the_boundary(side):
    run = certified(PULSE.scaled(edge() * (1.0 - side * 1e-4)))
    assert bool(run.overturned) == (side < 0.0)
    assert not bool(run.verdict_robust)
    assert float(run.verdict_margin) < 1.1e-3
    text = run.attrs["certificate"]
    assert text.startswith("Near the boundary: the body")
    assert "of the body" in text
    assert f"scaled {'up' if side > 0.0 else 'down'} by 0.0" in text


def test_tolerance_dependent_verdict_is_not_converged():
    found = certificate_of(lambda _, plan: plan.accuracy.rtol > 1e-5)
    assert not found.converged
    assert found.robust
    assert found.peak_error == pytest.approx(SAFETY * 0.99e-4)
    assert found.sentence == (
        "Near the boundary: the body overturns, but with a tolerance 100 times tighter it stands."
    )


def test_overturning_only_at_tighter_tolerance_is_not_converged():
    found = certificate_of(lambda _, plan: plan.accuracy.rtol < 1e-5)
    assert not found.converged
    assert "the body stands, but with a tolerance 100 times tighter it overturns" in found.sentence


def test_parameter_dependent_verdict_is_not_robust():
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


def test_sensitivity_counts_lowered_and_raised_peaks():
    run, plan = artificial_run(lambda *_: False), plan_of()

    def lower(system, plan):
        peak = 0.02 if system.parts.pads.to_dict()["frequency_ratio"] > 20.01 else 0.1001
        return replace(run(system, plan), peak=peak)

    found = certify(SYSTEM.assembly, plan, lower(SYSTEM.assembly, plan), rf.Certification(), lower)
    assert found.peak_sensitivity == pytest.approx(0.0801)


def test_nudged_scenes_preserve_options():
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
    preserved = {name: value for name, value in system.to_dict().items() if name != "parts"}
    for words, scene_at in parameters(system.assembly):
        assert preserved.items() <= scene_at(1e-3).to_dict().items(), words


def test_nudges_that_make_parts_incompatible_are_skipped():
    """A cap as wide as the block cannot be narrower, nor the block wider."""
    block = rf.Block(width="2 m", height="8 m", mass="50 t")
    cap = rf.CushionCap(width="2 m", height="0.5 m", mass="10 t")
    system = rf.System(block, cap, rf.WinklerSoil(stiffness="30 MPa", damping_ratio=0.1))
    at = dict(parameters(system.assembly))
    assert at["width of the cap"](0.001) is not None
    assert at["width of the cap"](-0.001) is None
    assert at["width of the body"](-0.001) is not None
    assert at["width of the body"](0.001) is None


def test_certificate_does_not_repeat_warnings_of_the_scene():
    with pytest.warns(ModelWarning, match="restitution"):
        system = rf.System(BLOCK, rf.RigidGround(restitution=1.0))
    assert "certificate" in certified(system=system).attrs


def test_certificate_counts_its_runs():
    made = []
    found = certificate_of(lambda _, plan: made.append(plan) or False)
    assert found.runs == len(made) - 1  # the first is the certified run


@pytest.mark.parametrize(
    "edge",
    [
        0.6,
        pytest.param(0.97, marks=pytest.mark.long),
        1.004,
        pytest.param(1.2, marks=pytest.mark.long),
    ],
)
def test_the_nearest_scale_is_found(edge):
    peak = edge * PULSE.si.peak

    def overturns(_, plan):
        return plan.motion.si.peak > peak

    found = certificate_of(overturns)
    assert abs(edge - 1.0) * (1.0 - 2.0 * RESOLUTION) <= found.margin <= abs(edge - 1.0)
    assert found.flip == pytest.approx(edge, abs=2.0 * RESOLUTION * abs(edge - 1.0))


@pytest.mark.parametrize(
    "edge", [*(pytest.param(one, marks=pytest.mark.long) for one in (1e-3, 1e-6)), 1e-10]
)
def test_a_margin_has_no_floor(edge):
    found = certificate_of(lambda _, plan: plan.motion.si.peak / PULSE.si.peak > 1.0 + edge)
    assert edge * (1.0 - 2.0 * RESOLUTION) <= found.margin <= edge
    assert found.robust == (edge == 1e-3)


def test_overturning_island_near_high_peaks_is_found():
    """An island of overturning between two scales of the first row, indicated by nearby peaks."""
    middle, half = 0.3172, 0.0008

    def run(_, plan):
        off = plan.motion.si.peak / PULSE.si.peak - 1.0 - middle
        left = abs(off) - half
        fell = left < 0.0
        return RunSummary(fell, 0.1, (1.0, 1.0) if fell else (5.0 * left,), 1.0, 0, 0.001)

    plan = plan_of()
    found = certify(SYSTEM.assembly, plan, run(SYSTEM.assembly, plan), rf.Certification(), run)
    assert found.margin == pytest.approx(middle - half, rel=2.0 * RESOLUTION)
    assert found.margin <= middle - half


def certified_on_diverging_courses(**options):
    """Certify standing runs, each of which takes a different course beyond a certain scale."""
    rng = np.random.default_rng(0)

    def run(_, plan):
        off = abs(plan.motion.si.peak / PULSE.si.peak - 1.0)
        course = (1.0, rng.uniform(0.0, 1.0) if off > 0.1 else 0.5)
        return RunSummary(False, 0.1, (0.5,), math.nan, 0, 0.001, course)

    plan, settings = plan_of(), rf.Certification(**options)
    return certify(SYSTEM.assembly, plan, run(SYSTEM.assembly, plan), settings, run)


def test_margin_ends_where_the_course_is_unresolved():
    found = certified_on_diverging_courses()
    assert 0.09 < found.margin < 0.12
    assert math.isnan(found.flip)
    assert found.robust
    assert "200 runs were too few to extend this range" in found.sentence
    assert found.runs <= 200


@pytest.mark.long
def test_more_runs_do_not_reduce_the_margin():
    found, more = certified_on_diverging_courses(), certified_on_diverging_courses(runs=400)
    assert 200 < more.runs <= 400
    assert more.margin >= found.margin


def test_unresolved_course_near_the_run_reports_number_of_runs():
    rng = np.random.default_rng(0)

    def run(_, plan):
        off = abs(plan.motion.si.peak / PULSE.si.peak - 1.0)
        course = (1.0, rng.uniform(0.0, 1.0) if off > 0.004 else 0.5)
        return RunSummary(False, 0.1, (0.5,), math.nan, 0, 0.001, course)

    plan = plan_of()
    found = certify(SYSTEM.assembly, plan, run(SYSTEM.assembly, plan), rf.Certification(), run)
    assert found.margin < 0.01
    sentence = "Near the boundary: the body stands, but 200 runs were too few to resolve"
    assert sentence in found.sentence


def test_uncertain_peak_near_overturning_is_not_converged():
    def run(_, plan):
        left = 0.01 if plan.accuracy.rtol > 1e-5 else 0.004
        return RunSummary(False, 0.1, (left,), math.nan, 0, 0.001)

    plan = plan_of()
    found = certify(SYSTEM.assembly, plan, run(SYSTEM.assembly, plan), rf.Certification(), run)
    assert not found.converged
    assert "its peak rotation is uncertain by" in found.sentence


def test_parameters_are_also_varied_within_the_nudge():
    """A band of overturning inside the nudge, which itself lies beyond it."""
    found = certificate_of(
        lambda system, _: 20.009 < system.parts.pads.to_dict()["frequency_ratio"] < 20.011
    )
    assert not found.robust
    assert "frequency ratio of the base +0.05 % it overturns" in found.sentence


@pytest.mark.parametrize(("lower", "upper"), [(0.98, 1.027), (0.973, 1.02)])
def test_margin_uses_the_nearer_of_two_flips(lower, upper):
    """Both flips lie within one interval of the geometric row."""
    found = certificate_of(lambda _, plan: not lower < plan.motion.si.peak / PULSE.si.peak < upper)
    assert 0.02 * (1.0 - 2.0 * RESOLUTION) <= found.margin <= 0.02


@pytest.mark.parametrize(
    ("edge", "words"),
    [
        (1.008, "Near the boundary: .* scaled up by 0.8 %"),
        pytest.param(0.992, "Near the boundary: .* scaled down by 0.8 %", marks=pytest.mark.long),
        pytest.param(
            1.02,
            "The body stands also .* No other verdict .* another verdict is 1.020",
            marks=pytest.mark.long,
        ),
        (0.98, "The body stands also .* No other verdict .* another verdict is 0.979"),
    ],
)
def test_margin_above_one_percent_is_not_near_the_boundary(edge, words):
    found = certificate_of(
        lambda _, plan: (plan.motion.si.peak / PULSE.si.peak - edge) * (edge - 1.0) > 0.0
    )
    assert re.match(words, found.sentence)
