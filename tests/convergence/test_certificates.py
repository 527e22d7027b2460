"""Certificates of verdicts, margins and errors of peaks against reference runs."""

from functools import lru_cache

import numpy as np
import pytest
from benchmarks.certificates import (
    at_the_boundary,
    clean,
    contradictions,
    flattered,
    peak_error,
    strength,
)
from benchmarks.certified_scenes import cases

import rockframe as rf
from rockframe.simulation.certify.perturbations import divide_intervals

pytestmark = pytest.mark.wide

COUNT = 3


@lru_cache
def pool():
    """Return a few random scenes, each brought to the edge of its verdict."""
    return tuple(cases(COUNT, seed=1))


@lru_cache
def certified(number, largest=np.inf):
    """Return a scene of the pool, a scale away from the boundary of its verdict, and its run."""
    case = pool()[number]
    scale = min(strength(case), largest)
    return case, scale, case.certified(scale)


def cascade(width, height, mass, cap, stiffness, ratio, amplitude, frequency):
    """Return a slender frame on a light cap, whose pads bounce under the motion of the cap."""
    system = rf.System(
        rf.Block(width=f"{width} m", height=f"{height} m", mass=f"{mass} t"),
        rf.TwoSpringSupport(frequency_ratio=ratio, damping_ratio=0.1),
        rf.CushionCap(height="0.5 m", mass=f"{cap} t"),
        rf.WinklerSoil(stiffness=f"{stiffness} MPa", damping_ratio=0.05),
        coupling="cascade",
    )
    time = 0.02 * np.arange(301)
    motion = amplitude * np.sin(2.0 * np.pi * frequency * time)
    return system, rf.GroundMotion.from_arrays((motion, "m/s^2"), "0.02 s")


def bouncing():
    """Return a block that re-engages a pad for less than a step."""
    time = 0.01 * np.arange(301)
    across, up = 3.5 * np.sin(6.0 * np.pi * time), 7.1 * np.sin(10.0 * np.pi * time)
    block = rf.Block(width="1 m", height="3 m", mass="1000 kg")
    system = rf.System(block, rf.TwoSpringSupport(frequency_ratio=15, damping_ratio=0.5))
    return system, rf.GroundMotion.from_arrays((across, "m/s^2"), "0.01 s", vertical=(up, "m/s^2"))


HARD = {
    "hand-over of a cascade, hard pads": cascade(3, 6, 40, 12, 28, 40, 8.4, 1.0),
    "hand-over of a cascade, soft soil": cascade(4, 6, 89, 29, 8, 30, 10.8, 2.5),
    "re-engagement within a step": bouncing(),
}


REST = {"free_vibration": "1 s", "outputs": None}


@lru_cache
def exact_peak(name):
    """Return the peak of a hard scene by steps far finer than those of any run."""
    system, motion = HARD[name]
    fine = rf.Accuracy(rtol=1e-12, steps_per_period=100.0)
    return float(
        system.simulate(divide_intervals(motion, 64), accuracy=fine, **REST).peak_relative_rotation
    )


@pytest.mark.parametrize(
    ("name", "accuracy"),
    # of the two cascades one by tight tolerances
    [
        ("re-engagement within a step", "standard"),
        ("re-engagement within a step", "reference"),
        pytest.param("hand-over of a cascade, hard pads", "standard", marks=pytest.mark.long),
        pytest.param("hand-over of a cascade, soft soil", "standard", marks=pytest.mark.long),
        pytest.param("hand-over of a cascade, soft soil", "reference", marks=pytest.mark.long),
    ],
)
def test_peak_error_estimate_includes_error_common_to_all_tolerances(name, accuracy):
    """A tighter tolerance alone does not change the hand-over and the record's intervals."""
    system, motion = HARD[name]
    run = system.simulate(motion, accuracy=accuracy, certify=True, **REST)
    error = abs(exact_peak(name) - float(run.peak_relative_rotation))
    estimate = float(run.peak_error_estimate) / float(run.overturning_angle)
    assert not flattered(error, estimate)


# the last scene has two bodies; its certificate takes longest
NUMBERS = [
    pytest.param(number, marks=[pytest.mark.long] * (number == COUNT - 1))
    for number in range(COUNT)
]


@pytest.mark.parametrize("number", NUMBERS)
def test_an_estimate_is_at_most_ten_times_too_small(number):
    case, scale, run = certified(number, 0.9)
    assert not bool(run.overturned)
    assert not flattered(*peak_error(case, scale, run))


@pytest.mark.parametrize("number", NUMBERS)
def test_clean_certificates_hold_within_their_margin(number):
    """Nudges and scales within the stated margins do not change the verdict."""
    case, scale, run = certified(number)
    assert clean(run)
    fell, margin = bool(run.overturned), float(run.verdict_margin)
    assert contradictions(case, scale, fell) == 0
    for change in np.linspace(-margin, margin, 102):
        assert case.summary(scale * (1.0 + change)).overturned == fell


def test_no_clean_certificate_at_overturning_boundary():
    rows = list(at_the_boundary(iter(pool())))
    assert [row.scenes for distance, row in rows if distance >= 1e-4] == [1] * COUNT
    for distance, row in rows:
        assert row.contradicted == 0
        assert row.clean == 0 or distance > 1e-4
