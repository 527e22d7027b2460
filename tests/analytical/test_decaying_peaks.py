"""Peaks of free rocking on rigid ground in closed form, and parameters identified from them."""

import itertools
import math

import numpy as np
import pytest
from analytical.rigid import P, rigid_block

import rockframe as rf

pytestmark = pytest.mark.analytical


def decayed(first, restitution, count, theta, rotation):
    """Return peaks by energy, of which each impact retains the square of the restitution."""
    left = restitution ** (2 * np.arange(count))
    if rotation == "small":
        share = left * (1.0 - (1.0 - first / theta) ** 2)
        return theta * (1.0 - np.sqrt(1.0 - share))
    height = math.cos(theta - first) - math.cos(theta)
    return theta - np.arccos(math.cos(theta) + left * height)


def times_of(peaks, theta):
    """Return times of the peaks of the linearised block after its release."""
    quarters = np.arccosh(1.0 / (1.0 - peaks / theta)) / P
    return np.concatenate([[0.0], np.cumsum(quarters[:-1] + quarters[1:])])


@pytest.mark.parametrize(
    ("restitution", "theta", "rotation"),
    [
        pytest.param(*one, marks=[pytest.mark.long] * (number % 3 > 0))
        for number, one in enumerate(
            itertools.product((0.7, 0.85), (0.1, 0.3), ("finite", "small"))
        )
    ],
)
def test_restitution_is_recovered_from_exact_peaks(restitution, theta, rotation):
    system = rigid_block(theta, rotation=rotation)
    for share, signs in itertools.product((0.3, 0.9), (1.0, -1.0)):
        peaks = decayed(share * theta, restitution, 6, theta, rotation)
        peaks = peaks * signs ** np.arange(6)
        found = rf.fit_free_decay(system, peaks=(np.degrees(peaks), "deg"))
        assert float(found.fitted_value[0]) == pytest.approx(restitution, rel=1e-6)
        assert float(found.initial_rotation) == pytest.approx(share * theta, rel=1e-6)
        np.testing.assert_allclose(found.fitted_peak_rotation, peaks, atol=1e-7 * theta)
        assert "release_time" in found
        assert math.isnan(float(found.release_time_error))


def test_restitution_is_recovered_from_peaks_with_times():
    theta, restitution = 0.2, 0.8
    peaks = decayed(0.5 * theta, restitution, 6, theta, "small")
    times = 3.0 + times_of(peaks, theta)
    system = rigid_block(theta, rotation="small")
    found = rf.fit_free_decay(system, peaks=((1e3 * times, "ms"), (peaks, "rad")))
    assert float(found.fitted_value[0]) == pytest.approx(restitution, rel=1e-6)
    assert float(found.release_time) == pytest.approx(3.0, abs=1e-6)
    np.testing.assert_allclose(found.fitted_peak_time, times, atol=1e-6)


@pytest.mark.long
def test_confidence_intervals_from_noisy_peaks_cover_restitution():
    theta, restitution = 0.2, 0.8
    peaks = decayed(0.5 * theta, restitution, 7, theta, "small")
    times = times_of(peaks, theta)
    system = rigid_block(theta, rotation="small")
    inside = []
    for seed in range(12):
        random = np.random.default_rng(seed)
        noisy = peaks + 1e-3 * theta * random.normal(size=7)
        measured = (noisy, "rad")
        if seed % 2:
            measured = ((times + 0.02 * random.normal(size=7), "s"), measured)
        found = rf.fit_free_decay(system, peaks=measured)
        bounds = found.lower_confidence_bound[0], found.upper_confidence_bound[0]
        inside.append(float(bounds[0]) < restitution < float(bounds[1]))
    assert np.mean(inside) >= 0.83


def test_gauge_offset_is_recovered_from_signed_peaks():
    theta, offset = 0.2, 0.004
    peaks = decayed(0.5 * theta, 0.8, 6, theta, "finite") * (-1.0) ** np.arange(6) + offset
    found = rf.fit_free_decay(
        rigid_block(theta),
        peaks=(peaks, "rad"),
        circumstances=("initial_rotation", "gauge_offset"),
    )
    assert float(found.fitted_value[0]) == pytest.approx(0.8, rel=1e-6)
    assert float(found.gauge_offset) == pytest.approx(offset, rel=1e-5)
