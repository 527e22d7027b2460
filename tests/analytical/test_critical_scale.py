"""Critical scales of pulses on rigid ground, linearised, in closed form."""

import math

import numpy as np
import pytest
from analytical.rigid import (
    BANDS,
    GRAVITY,
    P,
    half_sine_threshold,
    one_sine_threshold,
    rigid_block,
)

import rockframe as rf

pytestmark = pytest.mark.analytical

THETA = 0.1
UPLIFT = f"{GRAVITY * THETA!r} m/s^2"
"""Acceleration of uplift: scales of a motion with this peak are amplitudes over g theta."""


def critical(motion, *, restitution=None, **options):
    return rf.critical_scale(
        rigid_block(THETA, restitution=restitution, rotation="small"),
        motion,
        free_vibration=f"{60.0 / P!r} s",
        accuracy="reference",
        **options,
    )


def brackets(found, flip, threshold, *, within):
    """Return whether the bracket of a flip contains a threshold of limited precision."""
    below, above = found.scale_below[flip].item(), found.scale_above[flip].item()
    return below - within <= threshold <= above + within


def test_critical_scale_of_rectangular_pulse():
    for length in (0.5, 1.0, 3.0):  # p t1
        samples = np.full(2, GRAVITY * THETA)
        pulse = rf.GroundMotion.from_arrays((samples, "m/s^2"), f"{length / P!r} s")
        found = critical(pulse, bracket_width=1e-9)
        # (A - 1)(exp(p t1) - 1) = 1: the free motion ends in unstable equilibrium
        threshold = 1.0 / (1.0 - math.exp(-length))
        assert found.uplift_scale.item() == pytest.approx(1.0, rel=1e-12)
        assert found.flip.size == 1
        assert found.critical_scale.item() == found.scale_above[0].item()
        assert found.critical_scale.item() == pytest.approx(threshold, rel=2e-9)


@pytest.mark.long
def test_critical_scale_of_half_sine_pulse():
    for ratio in (1, 4, 10):
        pulse = rf.GroundMotion.half_sine_pulse(UPLIFT, f"{math.pi / (ratio * P)!r} s")
        found = critical(pulse, largest=8.0, bracket_width=1e-9)
        threshold = half_sine_threshold(ratio)
        assert found.critical_scale.item() == pytest.approx(threshold, rel=2e-9)
        assert brackets(found, 0, threshold, within=1e-9)


@pytest.mark.parametrize(
    "ratio",
    [next(iter(BANDS)), *(pytest.param(one, marks=pytest.mark.long) for one in list(BANDS)[1:])],
)
def test_one_sine_pulse_has_safe_gap_between_overturning_modes(ratio):
    for lower, upper in BANDS[ratio]:
        threshold = one_sine_threshold(ratio)
        pulse = rf.GroundMotion.sine_pulse(UPLIFT, f"{ratio * P / (2.0 * math.pi)!r} Hz")
        options = {"restitution": 0.9, "largest": 1.2 * threshold, "bracket_width": 1e-8}
        found = critical(pulse, overturning="continue", **options)
        assert found.overturns_above.values.tolist() == [True, False, True], found.verdict
        assert brackets(found, 0, lower, within=1e-6)
        assert brackets(found, 1, upper, within=1e-6)
        assert brackets(found, 2, threshold, within=1e-8)
        assert found.followed_scale.item() >= found.critical_scale.item()
        # in the gap the second half of the sine returns the block from beyond theta
        standing = found.outcome == found.outcome.flag_meanings.split().index("stands")
        gap = standing & (found.scale > upper) & (found.scale < threshold)
        assert gap.any()
        assert (found.peak_rotation[gap] > THETA).all()
        reached = critical(pulse, **options)
        assert reached.overturns_above.values.tolist() == [True]
        assert brackets(reached, 0, lower, within=1e-6)
