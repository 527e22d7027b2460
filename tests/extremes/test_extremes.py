"""First scenes of every subject keep the bounds; ROCKFRAME_EXTREMES=20 runs 20 times as many."""

import os

import numpy as np
import pytest
from extremes.bounds import judge
from extremes.scenes import BASES, RULES, SUBJECTS, Scene, scenes, usual
from hypothesis import given, settings
from hypothesis import strategies as st

import rockframe as rf
from rockframe.errors import SolverWarning

MORE = int(os.environ.get("ROCKFRAME_EXTREMES", "1"))
COUNT = 6 * MORE


@pytest.mark.parametrize(
    ("accuracy", "count"),
    [
        ("standard", COUNT),
        ("reference", COUNT // 2),
        pytest.param("reference", COUNT, marks=pytest.mark.long),
    ],
)
@pytest.mark.parametrize("subject", SUBJECTS)
def test_extreme_scenes_of_subject_stay_within_bounds(subject, accuracy, count):
    for number, scene in enumerate(scenes(subject, count)):
        failures = judge(scene, accuracy).failures
        assert not failures, f"scene {number}: {'; '.join(failures)}\n{scene}"


@pytest.mark.long
@given(st.integers(0, 2**32 - 1), st.sets(st.sampled_from(list(SUBJECTS)), min_size=2, max_size=3))
@settings(max_examples=25 * MORE, deadline=None)
def test_combined_extremes_stay_within_bounds(seed, subjects):
    rng = np.random.default_rng(seed)
    scene = usual(rng)
    for subject in sorted(subjects):
        scene = SUBJECTS[subject](scene, rng)
    failures = judge(scene, "standard").failures
    assert not failures, f"{'; '.join(failures)}\n{scene}"


def test_scenes_cover_all_options_and_ranges():
    drawn_scenes = [scene for subject in SUBJECTS for scene in scenes(subject, COUNT)]
    assert {scene.base for scene in drawn_scenes} == set(BASES)
    assert {scene.restraint for scene in drawn_scenes} == set(RULES)
    assert {scene.separation for scene in drawn_scenes} == {"displacement", "pressure"}
    assert {scene.rotation for scene in drawn_scenes} == {"finite", "small"}
    assert max(scene.frequency_ratio for scene in drawn_scenes) > 1e3
    assert max(scene.soil_ratio for scene in drawn_scenes) > 500.0
    assert max(scene.slenderness for scene in drawn_scenes) > 20.0


def test_verdict_lists_every_broken_bound(monkeypatch):
    """A run that exceeds its number of steps counts as a failure."""
    verdict = judge(Scene(peak=0.5), "standard")
    assert verdict.failures == []
    assert verdict.steps > 100
    run, few = Scene.run, rf.Accuracy(rtol=1e-6, max_steps=100)
    monkeypatch.setattr(Scene, "run", lambda scene, accuracy: run(scene, few))
    with pytest.warns(SolverWarning, match="the limit of steps was reached"):
        assert judge(Scene(peak=0.5), "standard").failures == ["ends as step_limit"]
    spoilt = type(verdict)("chatter", 2.0, 7, 5, finite=False)
    assert spoilt.failures == [
        "ends as chatter", "not finite", "imbalance 2 of its bound", "7 steps, 5 allowed"
    ]  # fmt: skip


@pytest.mark.parametrize("stiffness", ["2 TPa", "20 TPa", "2e15 Pa", "2e20 Pa"])
def test_statics_on_nearly_rigid_soil_match_rigid_ground(stiffness):
    """Rotations of the soil are below the rounding of those of the block."""
    block = rf.Block(width="1 m", height="4 m", mass="10 t")
    pads = rf.TwoSpringSupport(frequency_ratio=15, damping_ratio=0.05)
    soil = rf.WinklerSoil(stiffness=stiffness, damping_ratio=0.2)
    rotations = ("-0.24 rad", "-0.1 rad", "0.003 rad", "0.01 rad", "0.02 rad", "0.05 rad")
    alone, stack = (
        rf.System(block, *parts).moment_rotation(rotations).restoring_moment.to_numpy()
        for parts in ((pads,), (pads, rf.CushionCap(height="0.5 m", mass="4 t"), soil))
    )
    assert stack == pytest.approx(alone, abs=1.0)
