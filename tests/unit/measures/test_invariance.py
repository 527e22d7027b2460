"""Scaling, units, mirror images and finer sampling."""

import numpy as np
import pytest

import rockframe as rf
from rockframe.measures import (
    fourier_spectrum,
    intensity_measures,
    response_spectrum,
    velocity_and_displacement,
)

pytestmark = pytest.mark.filterwarnings(
    "ignore:.*is coarse for periods:rockframe.errors.RecordWarning"
)

BLOCK = rf.Block(width="1 m", height="4 m", mass="1 t")
PERIODS = (np.geomspace(0.02, 5.0, 30), "s")
STEP = 0.02
SAMPLES = np.convolve(np.random.default_rng(11).normal(size=400), np.hanning(7), "same")

# exponents of the acceleration in the measures
POWERS = {
    "peak_ground_acceleration": 1,
    "peak_ground_velocity": 1,
    "peak_ground_displacement": 1,
    "arias_intensity": 2,
    "cumulative_absolute_velocity": 1,
    "significant_duration_5_75": 0,
    "significant_duration_5_95": 0,
    "housner_spectrum_intensity": 1,
    "mean_period": 0,
    "predominant_velocity_period": 0,
    "relative_peak_ground_acceleration": 1,
    "relative_peak_ground_velocity": 1,
    "relative_predominant_frequency": 0,
}


def motion(samples=SAMPLES, unit="m/s^2", step=f"{STEP} s"):
    return rf.GroundMotion.from_arrays((samples, unit), step)


def spectra(record):
    return response_spectrum(record, PERIODS, (0.0, 0.05))


@pytest.mark.parametrize("factor", [3.0, 1e-6])
def test_measures_scale_with_motion(factor):
    one, record = intensity_measures(motion(), block=BLOCK), motion().scaled(factor)
    scaled = intensity_measures(record, block=BLOCK)
    for name, power in POWERS.items():
        expected = pytest.approx(factor**power * one[name].item(), rel=1e-12, abs=0.0)
        assert scaled[name].item() == expected, name
    rescaled = intensity_measures(record, block=BLOCK, threshold=f"{0.05 * factor} g_0")
    assert rescaled.bracketed_duration.item() == pytest.approx(
        one.bracketed_duration.item(), rel=1e-12
    )


def test_spectra_scale_with_motion():
    one, threefold = spectra(motion()), spectra(motion().scaled(3.0))
    for name in one.data_vars:
        np.testing.assert_allclose(threefold[name], 3.0 * one[name], rtol=1e-12)
    one, threefold = fourier_spectrum(motion()), fourier_spectrum(motion().scaled(3.0))
    np.testing.assert_allclose(
        threefold.fourier_amplitude, 3.0 * one.fourier_amplitude, rtol=1e-12, atol=1e-14
    )


def test_absolute_acceleration_is_at_least_pseudo_acceleration():
    result = spectra(motion())
    pseudo, absolute = result.pseudo_spectral_acceleration, result.absolute_spectral_acceleration
    np.testing.assert_allclose(absolute[0], pseudo[0], rtol=1e-12)
    assert (absolute[1] >= pseudo[1] * (1.0 - 1e-6)).all()


def test_mirrored_motion_has_equal_measures():
    mirrored = motion(-SAMPLES)
    one, other = (intensity_measures(record, block=BLOCK) for record in (motion(), mirrored))
    for name in one.data_vars:
        assert one[name].item() == other[name].item(), name
    one, other = spectra(motion()), spectra(mirrored)
    for name in one.data_vars:
        np.testing.assert_array_equal(one[name].values, other[name].values)
    one, other = (velocity_and_displacement(record) for record in (motion(), mirrored))
    for name in one.data_vars:
        np.testing.assert_array_equal(one[name].values, -other[name].values)


@pytest.mark.parametrize(("unit", "size"), [("cm/s^2", 0.01), ("g_0", 9.80665), ("ft/s^2", 0.3048)])
def test_units_make_no_difference(unit, size):
    other = motion(SAMPLES / size, unit, f"{1000.0 * STEP} ms")
    one, same = (
        intensity_measures(record, block=BLOCK, threshold=threshold)
        for record, threshold in ((motion(), "0.5 m/s^2"), (other, "50 cm/s^2"))
    )
    for name in one.data_vars:
        assert same[name].item() == pytest.approx(one[name].item(), rel=1e-10), name
    one, same = spectra(motion()), spectra(other)
    for name in one.data_vars:
        np.testing.assert_allclose(same[name], one[name], rtol=1e-11)


def test_relative_measures_are_invariant_to_time_and_size_scaling():
    """Same shape, time stretched by 2, block four times as large."""
    slow = motion(step=f"{2.0 * STEP} s")
    large = rf.Block(width="4 m", height="16 m", mass="1 t")
    one = intensity_measures(motion(), block=BLOCK)
    other = intensity_measures(slow, block=large)
    for name in ("relative_peak_ground_acceleration", "relative_peak_ground_velocity"):
        assert other[name].item() == pytest.approx(one[name].item(), rel=1e-12)
    # the period is found on a grid
    assert other.relative_predominant_frequency.item() == pytest.approx(
        one.relative_predominant_frequency.item(), rel=2e-2
    )


def test_linear_refining_preserves_measures():
    coarse, fine = motion(), motion().resampled(f"{STEP / 7.0!r} s", interpolation="linear")
    one, other = spectra(coarse), spectra(fine)
    for name in one.data_vars:
        np.testing.assert_allclose(other[name], one[name], rtol=3e-6)
    one, other = (intensity_measures(record, block=BLOCK) for record in (coarse, fine))
    for name in (
        "peak_ground_acceleration",
        "peak_ground_velocity",
        "peak_ground_displacement",
        "bracketed_duration",
        "uplift_duration",
    ):
        assert other[name].item() == pytest.approx(one[name].item(), rel=1e-9), name


def test_leading_zeros_do_not_change_spectra():
    late = motion(np.concatenate([np.zeros(100), SAMPLES]))
    one, other = spectra(motion(np.concatenate([[0.0], SAMPLES]))), spectra(late)
    for name in one.data_vars:
        np.testing.assert_allclose(other[name], one[name], rtol=1e-12)


def test_trailing_zeros_do_not_change_spectra():
    """The free vibration after the motion is part of the response."""
    ended = motion(np.append(SAMPLES, 0.0))
    longer = motion(np.concatenate([SAMPLES, np.zeros(500)]))
    one, other = spectra(ended), spectra(longer)
    for name in one.data_vars:
        np.testing.assert_allclose(other[name], one[name], rtol=3e-6)
