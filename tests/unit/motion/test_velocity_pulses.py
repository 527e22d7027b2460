"""Velocity pulses: wavelet, detection, extraction, classification."""

import math

import matplotlib as mpl
import numpy as np
import pytest
from records import record_path

import rockframe as rf
from rockframe.errors import ComponentError, UnitsError
from rockframe.motion import GroundMotion
from rockframe.motion.processing import velocity_pulses
from rockframe.motion.processing.velocity_pulses import (
    WaveletPeak,
    extract_wavelets,
    mother_wavelet,
    pulse_measures,
    scaling_filter,
)

STEP = 0.01
# from PyWavelets 1.9, Wavelet("db4").rec_lo and .wavefun(level=14)
FILTER_VALUES = [
    *(0.2303778133088965, 0.7148465705529157, 0.6308807679298589, -0.027983769416859854),
    *(-0.18703481171909309, 0.030841381835560764, 0.0328830116668852, -0.010597401785069032),
]
WAVELET_VALUES = {
    **{0.5: -0.015094, 1.0: -0.04633, 1.75: 0.1358, 2.5: -0.046517, 3.0: -0.887239},
    **{3.25: -0.432252, 3.5: 1.043654, 4.0: -0.397541, 4.625: 0.238892, 5.5: 0.002605},
}
PUBLISHED = {
    # file, arguments, period of the component normal to the fault (Baker 2007) [s]
    "RSN763_LOMAP_GIL067.AT2": ({}, 1.8),
    "SLAMMER_CHICHI_TCU128-090.txt": ({"unit": "g", "time_step": "0.005 s"}, 9.0),
    "LGP000.AT2": ({}, 4.4),
    "RRS228.AT2": ({}, 1.2),
    "SYL360.AT2": ({}, 3.1),
}
LARGEST_INDICATORS = {"NIS090.AT2": 0.01, "PEERSMD_IMPVALL_IELC180.AT2": 0.15}


def with_velocity(velocity, step=STEP, name="made"):
    """A motion with nearly the given velocity at the samples, with a gradual start."""
    start = np.minimum(np.arange(velocity.size) * step / 0.3, 1.0) ** 3
    samples = np.gradient(start * velocity, step)
    samples[0] = 0.0
    return GroundMotion.from_arrays((samples, "m/s^2"), f"{step!r} s", name=name)


def noise(count, size, seed=3):
    """Velocity of short fluctuations, up to about half a second, that fade at both ends."""
    raw = np.convolve(np.random.default_rng(seed).normal(size=count), np.hanning(21), "same")
    raw -= np.convolve(raw, np.ones(51) / 51.0, "same")
    return size * raw / np.abs(raw).max() * np.sin(np.pi * np.arange(count) / (count - 1))


def wavelet(time, period, middle):
    """A wavelet of unit peak."""
    return mother_wavelet((time - middle) * 1.4 / period + 3.5) / 1.3592


def test_wavelet_agrees_with_independent_library():
    np.testing.assert_allclose(scaling_filter(), FILTER_VALUES, rtol=1e-13)
    values = mother_wavelet(np.array(list(WAVELET_VALUES)))
    np.testing.assert_allclose(values, list(WAVELET_VALUES.values()), atol=4e-6)
    x = np.linspace(-1.0, 8.0, 9 * 4096 + 1)
    psi = mother_wavelet(x)
    assert not psi[(x < 0.0) | (x > 7.0)].any()
    for shift in range(7):
        product = np.trapezoid(psi * mother_wavelet(x - shift), x)
        assert product == pytest.approx(float(shift == 0), abs=1e-8)
    for power in range(4):  # vanishing moments
        assert np.trapezoid(psi * (x - 3.5) ** power, x) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("period", [0.6, 1.7, 4.2])
def test_a_pulse_under_noise_is_found(period):
    time = np.arange(6001) * STEP
    pulse = 0.8 * wavelet(time, period, 12.0)
    result = with_velocity(pulse + noise(time.size, 0.1)).velocity_pulse()
    assert result.period.m_as("s") == pytest.approx(period, rel=0.02)
    assert result.time.m_as("s") == pytest.approx(12.0, abs=0.02 * period)
    assert result.pulse_like
    assert result.unmet == ()
    assert result.peak_ratio < 0.25
    assert result.indicator > 0.99
    assert "pulse-like" in str(result)


def test_pulse_has_largest_wavelet_coefficient():
    """Direct evaluation of the integral at all periods and times."""
    step, count = 0.02, 500
    time = np.arange(count) * step
    velocity = noise(count, 0.5, seed=8) + 0.3 * np.sin(time) * np.exp(-0.5 * (time - 5.0) ** 2)
    motion = with_velocity(velocity, step)
    velocity = rf.measures.velocity_and_displacement(motion).ground_velocity.values
    periods = np.geomspace(0.4, 4.0, 60)
    later = time - time[:, np.newaxis]  # than each sample
    best = max(
        (
            np.abs(np.trapezoid(velocity * mother_wavelet(later / a + 3.5), time)).max()
            / math.sqrt(a),
            T,
        )
        for T in periods.tolist()
        for a in (T / 1.4,)
    )
    result = motion.velocity_pulse(shortest_period="0.4 s", longest_period="4 s")
    assert result.period.m_as("s") == pytest.approx(best[1], rel=0.03)


def test_search_leaves_out_samples_finer_than_it_needs(monkeypatch):
    """With all samples it took seconds, and found the same wavelet."""
    time = np.arange(0.0, 10.0, 4e-4)
    one, other = (np.sin(2.0 * np.pi * time / p + p) for p in (1.3, 2.1))
    velocities = np.exp(-((time - 6.0) ** 2)) * np.array([one + 0.3 * other, 0.7 * other])
    periods = velocity_pulses.period_range(0.5, 5.0)
    steps = []

    def sampled(period, dt, original=velocity_pulses.sampled_wavelet):
        steps.append(dt)
        return original(period, dt)

    monkeypatch.setattr(velocity_pulses, "sampled_wavelet", sampled)
    found = velocity_pulses.strongest_wavelet(velocities, 4e-4, periods)
    assert sum(math.isclose(dt, 2.4e-3) for dt in steps) > periods.size
    monkeypatch.setattr(velocity_pulses, "_SEARCH_STEPS", math.inf)
    assert found == velocity_pulses.strongest_wavelet(velocities, 4e-4, periods)


def test_mirrored_velocities_have_the_same_strongest_wavelet():
    time = np.arange(2001) * STEP
    velocities = np.stack([wavelet(time, 1.03 * 1.5, 9.0), 0.4 * wavelet(time, 1.4, 9.1)])
    velocities += np.stack([noise(2001, 0.1, seed=1), noise(2001, 0.1, seed=2)])
    periods = velocity_pulses.period_range(0.5, 5.0)
    for one in (velocities, velocities[:1]):
        found = velocity_pulses.strongest_wavelet(one, STEP, periods)
        mirrored = velocity_pulses.strongest_wavelet(-one, STEP, periods)
        assert mirrored == pytest.approx(found, rel=1e-12)
        assert 0.0 <= found.direction < math.pi


def test_pulse_and_residual_sum_to_motion_without_drift():
    # the pulse begins before the record, which drifts slightly
    time = np.arange(2001) * STEP
    motion = with_velocity(wavelet(time, 2.0, 1.5) + noise(2001, 0.2) + 1e-3 * time)
    upwards = motion.scaled(0.5)
    result = motion.with_vertical(upwards).velocity_pulse()
    lead = round(result.lead.m_as("s") / STEP)
    assert lead > 0
    total = result.extracted.si.horizontal.samples + result.residual.si.horizontal.samples
    own = motion.si.horizontal.samples
    np.testing.assert_allclose(total[lead : lead + own.size], own, atol=1e-14)
    assert not np.delete(total, np.s_[lead : lead + own.size]).round(12).any()
    up = result.residual.si.vertical.samples
    np.testing.assert_array_equal(up[lead : lead + own.size], 0.5 * own)
    assert result.extracted.si.vertical is None
    path = rf.measures.velocity_and_displacement(result.extracted)
    highest = float(np.abs(path.ground_displacement).max())
    assert abs(float(path.ground_velocity[-1])) < 1e-12
    assert abs(float(path.ground_displacement[-1])) < 1e-5 * highest
    whole = rf.measures.velocity_and_displacement(motion)
    left = rf.measures.velocity_and_displacement(result.residual)
    assert float(left.ground_velocity[-1]) == pytest.approx(float(whole.ground_velocity[-1]))
    assert any("pulse taken out" in step for step in result.residual.history)


def test_criteria_follow_publication():
    """By hand, for a constant velocity of one from which a pulse is extracted."""
    velocity = np.ones(100)
    pulse = np.where(np.arange(100) < 40, 0.5, 0.0)
    result = pulse_measures(velocity, pulse, 0.5)
    energy = (40 * 0.25 + 60) / 100
    assert (result.peak_ratio, result.energy_ratio) == pytest.approx((1.0, energy))
    exact = 1.0 / (1.0 + math.exp(-23.3 + 14.6 + 20.5 * energy))
    assert result.indicator == pytest.approx(exact, rel=1e-12)
    assert (result.pulse_start, result.motion_start) == pytest.approx((0.5 * 3, 0.5 * 19))


def test_unmet_criteria_are_listed():
    time = np.arange(4001) * STEP
    pulse = 0.8 * wavelet(time, 2.0, 30.0)
    weak = with_velocity(0.1 * pulse).velocity_pulse()
    assert not weak.pulse_like
    assert [words.split()[0] for words in weak.unmet] == ["peak"]
    early = np.where(time < 10.0, 0.3 * np.sin(2.0 * np.pi * 2.5 * time), 0.0)
    late = with_velocity(pulse + early).velocity_pulse()
    assert [words.split()[2] for words in late.unmet] == ["arrives"]
    none = with_velocity(noise(4001, 1.0)).velocity_pulse()
    assert not none.pulse_like
    assert [words.split()[0] for words in none.unmet] == ["indicator", "the"]
    assert "not pulse-like (" in str(none)


@pytest.mark.parametrize(
    "angle", [20.0, *(pytest.param(angle, marks=pytest.mark.long) for angle in (90.0, 155.0))]
)
def test_the_direction_of_a_pulse_is_found(angle):
    time = np.arange(4001) * STEP
    pulse, turned = wavelet(time, 2.5, 9.0), math.radians(angle)
    pair = rf.HorizontalPair(
        with_velocity(math.cos(turned) * pulse + noise(4001, 0.05, seed=1)),
        with_velocity(math.sin(turned) * pulse + noise(4001, 0.05, seed=2)),
    )
    result = pair.velocity_pulse()
    assert result.angle.m_as("deg") == pytest.approx(angle, abs=2.0)
    assert result.period.m_as("s") == pytest.approx(2.5, rel=0.02)
    assert result.peak_velocity.m_as("m/s") == pytest.approx(1.0, rel=0.1)
    assert result.pulse_like


def test_arguments_are_checked():
    motion = with_velocity(wavelet(np.arange(2001) * STEP, 2.0, 8.0))
    with pytest.raises(ComponentError, match="shortest_period = 2 s must be below"):
        motion.velocity_pulse(shortest_period="2 s", longest_period="1 s")
    with pytest.raises(ComponentError, match="4 time steps"):
        motion.velocity_pulse(shortest_period="0.03 s")
    with pytest.raises(UnitsError, match="longest_period needs a time with a unit, got 15"):
        motion.velocity_pulse(longest_period=15)
    with pytest.raises(ComponentError, match="longest_period = 1e\\+09 s has more than"):
        motion.velocity_pulse(longest_period="1e9 s")
    still = GroundMotion.from_arrays((np.zeros(100), "m/s^2"), "0.01 s", name="still")
    with pytest.raises(ComponentError, match="'still' has no velocity"):
        still.velocity_pulse()


@pytest.mark.parametrize("name", PUBLISHED)
def test_published_periods(name):
    arguments, period = PUBLISHED[name]
    result = GroundMotion.read(record_path(name), **arguments).velocity_pulse()
    assert result.period.m_as("s") == pytest.approx(period, rel=0.1)
    assert result.pulse_like


@pytest.mark.parametrize("name", LARGEST_INDICATORS)
def test_published_records_without_a_pulse(name):
    result = GroundMotion.read(record_path(name)).velocity_pulse()
    assert result.indicator < LARGEST_INDICATORS[name]
    assert not result.pulse_like


def test_embedded_record_has_no_pulse():
    assert not GroundMotion.example("loma-prieta").velocity_pulse().pulse_like


def test_the_figure_shows_the_three_velocities():
    time = np.arange(2001) * STEP
    motion = with_velocity(wavelet(time, 2.0, 1.5) + noise(2001, 0.2))
    result = motion.velocity_pulse()
    above, below = rf.plot.velocity_pulse(result)
    velocity, pulse = above.get_lines()[:2]
    own = rf.measures.velocity_and_displacement(motion).ground_velocity.values
    plotted = np.interp(time, velocity.get_xdata(), velocity.get_ydata())
    np.testing.assert_allclose(plotted, own, atol=1e-12)
    left = below.get_lines()[0].get_ydata()
    np.testing.assert_allclose(pulse.get_ydata() + left, velocity.get_ydata(), atol=1e-12)
    assert below.get_xlabel() == "time [s]"
    figure = mpl.figure.Figure()
    panels = figure.subplots(2, 1)
    assert rf.plot.velocity_pulse(result, ax=panels) == tuple(panels)
    with pytest.raises(ComponentError, match=r"ax must be 2 Axes, .* got 1 Axes"):
        rf.plot.velocity_pulse(result, ax=[panels[0]])
    with pytest.raises(ComponentError, match="needs a VelocityPulse"):
        rf.plot.velocity_pulse(motion)


def test_wavelets_of_a_pulse_are_near_the_strongest_one():
    """Within 0.4 of their scale, the period times the centre frequency of 5/7."""
    dt, velocity = 0.01, np.random.default_rng(2).normal(size=2000)
    peak = WaveletPeak(period=2.0, sample=900, direction=0.0)
    distances = [abs(middle - 900) for middle, _ in extract_wavelets(velocity, dt, peak)]
    assert len(distances) == 10
    assert 0.5 * 58 < max(distances) <= 58  # 0.4 * 2.0 * 5/7 / 0.01 = 57.1, rounded up
