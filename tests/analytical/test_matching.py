"""Spectral matching in time: wavelets and matrix against closed forms and other integrators."""

from functools import cache

import numpy as np
import pytest
from scipy import integrate, signal

import rockframe as rf
from rockframe.motion.matching.adjustment import (
    OscillatorPeaks,
    Oscillators,
    make_adjustment,
    taper_width,
    wavelet_at,
    wavelet_lead,
)
from rockframe.signals.spectra import spectral_peaks

STEP = 0.01
COUNT = 3001
LENGTH = (COUNT - 1) * STEP
PERIODS = np.geomspace(0.1, 2.0, 12)


def exact_history(samples, step, period, damping, parts=1):
    """Pseudo-acceleration under straight lines between samples, by SciPy's first-order hold."""
    frequency = 2.0 * np.pi / period
    fine = np.interp(
        np.arange((samples.size - 1) * parts + 1) / parts, np.arange(samples.size), samples
    )
    still = np.zeros(round(period * parts / step) + 1)
    matrices = (
        np.array([[0.0, 1.0], [-(frequency**2), -2.0 * damping * frequency]]),
        np.array([[0.0], [-1.0]]),
        np.array([[frequency**2, 0.0]]),
        np.zeros((1, 1)),
    )
    *discrete, _ = signal.cont2discrete(matrices, step / parts, "foh")
    numerator, denominator = signal.ss2tf(*discrete)
    return signal.lfilter(numerator[0], denominator, np.concatenate([fine, still]))


def pseudo_spectrum(samples, step, periods, damping):
    parts = int(np.ceil(50.0 * step / periods.min()))
    return np.array(
        [np.abs(exact_history(samples, step, one, damping, parts)).max() for one in periods]
    )


@pytest.mark.parametrize("period", [0.1, 0.5, 2.0])
@pytest.mark.parametrize("damping", [0.01, 0.05, 0.3])
def test_wavelet_is_tapered_cosine_without_its_mean(period, damping):
    """A Gaussian cancels the integral of the cosine; both are known in closed form."""
    share = np.sqrt(1.0 - damping**2)
    frequency = 2.0 * np.pi / period * share
    lead = np.arctan(share / damping) / frequency
    assert wavelet_lead(period, damping) == pytest.approx(lead, rel=1e-12)
    width = 1.178 * period**0.93
    assert taper_width(period) == pytest.approx(width, rel=1e-12)
    mean = np.exp(-((frequency * width) ** 2) / 4.0)

    def continuous(time):
        place = time - 15.0 + lead
        return (np.cos(frequency * place) - mean) * np.exp(-((place / width) ** 2))

    one = wavelet_at(15.0, period, damping, time_step=STEP, count=COUNT)
    times = np.arange(COUNT)[one.samples] * STEP
    np.testing.assert_allclose(one.values, continuous(times), atol=2e-7)
    ends = 15.0 - lead + 8.0 * width * np.array([-1.0, 1.0])
    nodes = np.linspace(*ends, 40_001)
    for weight in (1.0, nodes[-1] - nodes):  # final velocity, final displacement
        found = integrate.simpson(weight * continuous(nodes), x=nodes)
        assert abs(found) < 1e-12 * nodes[-1]


@pytest.mark.parametrize("peak_time", [0.0, 0.3, 2.0, 15.0, 29.5, 31.0])
@pytest.mark.parametrize("period", [0.05, 0.7, 3.0, 10.0])
def test_wavelets_leave_no_permanent_ground_displacement(peak_time, period):
    """Linear interpolation of samples has exact integrals."""
    one = wavelet_at(peak_time, period, 0.05, time_step=STEP, count=COUNT)
    samples = np.zeros(COUNT)
    samples[one.samples] = one.values
    assert samples[0] == samples[-1] == 0.0
    assert 0.5 < np.abs(samples).max() < 2.5
    acceleration = integrate.cumulative_trapezoid(samples, dx=STEP, initial=0.0)
    assert abs(acceleration[-1]) < 1e-12
    # the displacement of a hat at time t is its area times the remaining time
    assert abs(((LENGTH - np.arange(COUNT) * STEP) * samples).sum() * STEP) < 1e-10
    path = rf.GroundMotion.from_arrays((samples, "m/s^2"), f"{STEP} s")
    moved = rf.measures.velocity_and_displacement(path)
    assert abs(moved.ground_velocity[-1]) < 1e-12
    assert abs(moved.ground_displacement[-1]) < 1e-10


def noise(seed=3):
    """Return noise that is resolved by its samples, as records are."""
    white = np.random.default_rng(seed).normal(size=COUNT)
    return 2.0 * np.convolve(white, np.hanning(9) / 2.0, "same") * np.hanning(COUNT)


@pytest.mark.parametrize("damping", [0.01, 0.05, 0.5])
def test_oscillator_peaks_match_response_spectrum(damping):
    samples = noise()
    oscillators = Oscillators(PERIODS, damping, STEP)
    histories = oscillators.histories(samples)
    for place, period in enumerate(PERIODS):
        exact = exact_history(samples, STEP, period, damping)
        assert np.abs(histories[place, : exact.size] - exact).max() < 1e-8 * np.abs(exact).max()
    peaks = oscillators.peaks(samples, histories)
    signal = rf.GroundMotion.from_arrays((samples, "m/s^2"), f"{STEP} s").si.horizontal
    displacement = spectral_peaks(signal, PERIODS, damping)[:, 0]
    np.testing.assert_allclose(
        peaks.spectrum, (2.0 * np.pi / PERIODS) ** 2 * displacement, rtol=1e-4
    )
    # largest first, each where its history is close to that value
    assert (np.diff(peaks.oscillators) >= 0).all()
    for place in range(0, PERIODS.size, 3):
        exact = exact_history(samples, STEP, PERIODS[place], damping, parts=50)
        own = peaks.oscillators == place
        for value, time in zip(peaks.values[own], peaks.times[own], strict=True):
            assert exact[round(50 * time / STEP)] == pytest.approx(value, rel=3e-3)


def test_oscillator_peak_after_end_of_motion_is_found():
    samples = np.sin(2.0 * np.pi * np.arange(400) * STEP / 2.0)[:60]
    oscillators = Oscillators(np.array([3.0]), 0.05, STEP)
    peaks = oscillators.peaks(samples, oscillators.histories(samples))
    assert peaks.times[0] > 0.6
    signal = rf.GroundMotion.from_arrays((samples, "m/s^2"), f"{STEP} s").si.horizontal
    expected = spectral_peaks(signal, oscillators.periods, 0.05)[0, 0] * (2.0 * np.pi / 3.0) ** 2
    assert peaks.spectrum[0] == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("damping", [0.01, 0.05, 0.4])
def test_sample_influences_reproduce_response(damping):
    """The response to a motion is the sum of the responses to its samples."""
    samples = noise(4)
    oscillators = Oscillators(PERIODS, damping, STEP)
    times = (np.linspace(200, 3100, PERIODS.size).round() + 0.37) * STEP
    which = np.arange(PERIODS.size)
    peaks = OscillatorPeaks(which, np.ones(PERIODS.size), times, np.zeros(PERIODS.size, dtype=int))
    influences = oscillators.influences(peaks, COUNT)
    parts = 100
    for place, (period, time) in enumerate(zip(PERIODS, times, strict=True)):
        history = exact_history(samples, STEP, period, damping, parts)
        at = round(time * parts / STEP)
        if at >= history.size:
            continue
        scale = np.abs(history).max()
        assert abs(influences[place] @ samples - history[at]) < 1e-7 * scale


def test_wavelet_effects_match_finite_differences():
    """By finite differences, with SciPy's integrator, at the times of the peaks."""
    samples, damping, parts = noise(5), 0.05, 50
    oscillators = Oscillators(PERIODS, damping, STEP)
    peaks = oscillators.peaks(samples, oscillators.histories(samples))
    targets = np.full(PERIODS.size, 3.0)
    adjustment = make_adjustment(oscillators, peaks, targets, COUNT)
    assert adjustment.effects.shape == (peaks.values.size, peaks.values.size)
    small = 1e-3

    @cache
    def response(oscillator, column=None):
        changed = samples if column is None else samples + small * adjustment.wavelets[:, column]
        return exact_history(changed, STEP, PERIODS[oscillator], damping, parts)

    for column in range(0, peaks.values.size, 9):
        for row in range(0, peaks.values.size, 6):
            which = int(peaks.oscillators[row])
            at = np.rint(peaks.times[row] * parts / STEP).astype(int)
            change = response(which, column)[at] - response(which)[at]
            slope = np.sign(peaks.values[row]) * change / small / 3.0
            assert adjustment.effects[row, column] == pytest.approx(slope, abs=2e-3)


def test_wavelet_amplitude_brings_peak_to_target():
    """Linear theory is exact for one oscillator and one wavelet while peak times do not change."""
    samples = noise(6)
    oscillators = Oscillators(np.array([0.5]), 0.05, STEP)
    histories = oscillators.histories(samples)
    peaks = oscillators.peaks(samples, histories)
    target = np.array([1.01 * peaks.spectrum[0]])
    alone = OscillatorPeaks(*(values[:1] for values in peaks))
    adjustment = make_adjustment(oscillators, alone, target, COUNT)
    changed = samples + adjustment.wavelets @ adjustment.amplitudes(1e-12)
    at = np.interp(
        peaks.times[0] / STEP,
        np.arange(histories.shape[1]),
        oscillators.histories(changed)[0] - histories[0],
    )
    assert np.sign(peaks.values[0]) * at == pytest.approx(0.01 * peaks.spectrum[0], rel=2e-3)


def test_second_peak_does_not_exceed_target():
    """Of two peaks of one oscillator the greatest matches the target, the other stays below it."""
    samples = noise(7)
    oscillators = Oscillators(np.array([0.5]), 0.05, STEP)
    peaks = oscillators.peaks(samples, oscillators.histories(samples))
    assert peaks.values.size > 1
    adjustment = make_adjustment(oscillators, peaks, np.array([0.9 * peaks.spectrum[0]]), COUNT)
    found = adjustment.amplitudes(1e-8)
    left = adjustment.misfits - adjustment.effects @ found
    assert abs(left[0]) < 1e-3
    assert (left > -0.006).all()
