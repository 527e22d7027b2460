"""Histories of a release between their samples, against polynomials in closed form."""

import math

import numpy as np
import pytest

from rockframe.identification.prediction import FreeMotion

CUBIC = np.polynomial.Polynomial.fromroots([1.0, 3.0, 6.0])
EXTREMA = [(10.0 - math.sqrt(19.0)) / 3.0, (10.0 + math.sqrt(19.0)) / 3.0]


def motion_of(curve, *times):
    time = np.array(times)
    return FreeMotion(time, curve(time), curve.deriv()(time))


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("times", [(0.0, 1.5, 2.0, 3.5, 5.0, 7.0), (0.0, 1.5, 4.0, 6.5, 7.0)])
def test_cubics_between_samples_are_exact(side, times):
    """The sample of largest rotation is after the extremum, or before it."""
    motion = motion_of(side * CUBIC, *times)
    inside = np.linspace(times[0], times[-1], 29)
    np.testing.assert_allclose(motion.at(inside), side * CUBIC(inside), rtol=0.0, atol=1e-13)
    outside = np.array([-1.0, 8.0])
    np.testing.assert_allclose(motion.at(outside), side * CUBIC(np.array([0.0, 7.0])))
    # the release, from which the rotation falls, and both extrema
    when, size = motion.peaks()
    np.testing.assert_allclose(when, [0.0, *EXTREMA], rtol=1e-14)
    np.testing.assert_allclose(size, np.abs(CUBIC(np.array([0.0, *EXTREMA]))), rtol=1e-14)
    assert motion.first_crossing() == times[1]


def test_peaks_at_jumps_of_the_rate_are_those_of_samples():
    """The rate is reversed at an event, which has two samples; nothing is beyond its rotation."""
    time = np.array([0.0, 1.0, 2.0, 2.0, 3.0, 4.0])
    rotation = np.array([1.0, -1.0, -3.0, -3.0, -1.0, 1.0])
    rate = np.array([-2.0, -2.0, -2.0, 2.0, 2.0, 2.0])
    when, size = FreeMotion(time, rotation, rate).peaks()
    assert (when.tolist(), size.tolist()) == ([0.0, 2.0], [1.0, 3.0])


def test_rotation_that_never_passes_zero_has_no_peak_and_crosses_at_the_end():
    motion = motion_of(np.polynomial.Polynomial([2.0, -0.1]), 0.0, 4.0)
    assert [len(each) for each in motion.peaks()] == [0, 0]
    assert motion.first_crossing() == 4.0
