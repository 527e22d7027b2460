"""Resampling by straight lines or band-limited interpolation, and coarsening."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rockframe.errors import ComponentError, UnitsError
from rockframe.motion import GroundMotion
from rockframe.motion.processing.samples import divided_signal

RNG = np.random.default_rng(20)
NOISE = RNG.normal(size=400)
STEP = 0.01


def motion(values=NOISE, step=STEP):
    return GroundMotion.from_arrays((values, "m/s^2"), f"{step!r} s", name="noise")


def tone(frequency, step=STEP, count=4001):
    """A tone with a smooth envelope, so that end effects vanish."""
    time = np.arange(count) * step
    swell = np.sin(np.pi * time / time[-1]) ** 2
    return swell * np.sin(2.0 * np.pi * frequency * time)


@pytest.mark.parametrize("times", [2, 3, 5, 16])
def test_refining_by_a_whole_number_keeps_the_function(times):
    fine = motion().resampled(f"{STEP / times!r} s", interpolation="linear")
    assert len(fine) == 399 * times + 1
    assert fine.si.horizontal.samples[::times].tolist() == NOISE.tolist()
    time = RNG.uniform(0.0, 3.99, 2000)
    assert fine.si.at(time) == pytest.approx(motion().si.at(time), abs=1e-12)


def test_step_ratio_is_rounded_to_integer():
    assert 0.15 / 0.05 < 3.0
    fine = motion(step=0.15).resampled("0.05 s")
    assert len(fine) == 399 * 3 + 1
    assert fine.si.horizontal.samples[::3].tolist() == NOISE.tolist()


@pytest.mark.parametrize("step", [0.003, 0.003332])
def test_refining_by_another_number_reads_off_the_straight_lines(step):
    fine = motion().resampled(f"{step} s", interpolation="linear")
    time = np.arange(len(fine)) * step
    assert 3.99 - step < time[-1] < 3.99 + 1e-9
    expected = np.interp(time, np.arange(400) * STEP, NOISE)
    assert fine.si.horizontal.samples == pytest.approx(expected, abs=1e-12)


def test_refining_records_interpolation_in_history():
    pulse = GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    for refined, description in (
        (motion().resampled("0.005 s"), "without anything beyond the old Nyquist frequency"),
        (motion().resampled("0.005 s", interpolation="linear"), "linear between samples"),
        (pulse.resampled("0.005 s"), "read off the analytic pieces"),
    ):
        assert any(sentence.endswith(f"to 0.005 s, {description}") for sentence in refined.history)


def test_refining_records_omitted_end_in_history():
    fine = motion().resampled("0.007 s")
    assert fine.si.duration == pytest.approx(570 * 0.007)
    assert motion().resampled("0.0071 s").history[-1] == (
        "the last 0.0069 s, less than one new time step, are left out"
    )


def test_resampling_to_the_same_step_changes_nothing():
    assert motion().resampled("10 ms").sha256 == motion().sha256


@pytest.mark.parametrize("step", [0.02, 0.05, 0.025, 0.0333])
def test_coarsening_keeps_slow_and_removes_fast_motion_without_delay(step):
    slow, fast = tone(0.1 / step), tone(0.7 / step)  # 0.2 and 1.4 of the new Nyquist frequency
    coarse = motion(slow).resampled(f"{step} s")
    assert coarse.si.time_step == step
    time = np.arange(len(coarse)) * step
    swell = np.sin(np.pi * time / 40.0) ** 2
    exact = swell * np.sin(2.0 * np.pi * 0.1 / step * time)
    assert coarse.si.horizontal.samples == pytest.approx(exact, abs=0.02)
    assert motion(fast).resampled(f"{step} s").si.peak < 1e-3
    assert "anti-alias" in " ".join(coarse.history[-2:])


@pytest.mark.parametrize("step", [0.0101, 0.0137, 0.02, 0.025, 0.0333])
def test_coarsening_cuts_close_to_the_new_nyquist_frequency(step):
    # 0.7 and 1.1 of the new Nyquist frequency
    passed, removed = tone(0.35 / step), tone(0.55 / step)
    coarse = motion(passed).resampled(f"{step} s")
    time = np.arange(len(coarse)) * step
    exact = np.sin(np.pi * time / 40.0) ** 2 * np.sin(2.0 * np.pi * 0.35 / step * time)
    assert coarse.si.horizontal.samples == pytest.approx(exact, abs=0.03)
    assert motion(removed).resampled(f"{step} s").si.peak < 0.01


def test_coarsening_keeps_the_ends_of_a_straight_line():
    coarse = motion(np.arange(401.0)).resampled("0.04 s").si.horizontal.samples
    assert coarse == pytest.approx(np.arange(0.0, 401.0, 4.0), rel=0.02, abs=0.01)


@pytest.mark.parametrize("step", ["0.02 s", "0.03 s"])
def test_coarsening_keeps_a_constant(step):
    """All of it away from the ends, beyond which nothing is known."""
    coarse = motion(np.full(2000, 2.0)).resampled(step).si.horizontal.samples
    np.testing.assert_allclose(coarse, 2.0, rtol=0.02)
    np.testing.assert_allclose(coarse[100:-100], 2.0, rtol=1e-9)


@pytest.mark.parametrize(
    ("step", "error", "words"),
    [
        ("0 s", ComponentError, "greater than zero"),
        ("-1 s", ComponentError, "greater than zero"),
        ("4 s", ComponentError, "exceeds the duration"),
        ("1e-9 s", ComponentError, "more than 50000000 samples"),
        (0.01, UnitsError, "time_step needs a time"),
    ],
)
def test_resampling_that_is_refused(step, error, words):
    with pytest.raises(error, match=words):
        motion().resampled(step)


@pytest.mark.parametrize("count", [2, 3, 5, 12])
def test_short_motions_can_be_coarsened(count):
    coarse = motion(NOISE[:count]).resampled(f"{STEP * (count - 1)!r} s")
    assert len(coarse) == 2
    assert np.isfinite(coarse.si.horizontal.samples).all()


@pytest.mark.parametrize("times", [2, 5, 16])
def test_band_limited_samples_keep_the_old_ones(times):
    fine = motion().resampled(f"{STEP / times!r} s")
    assert fine.si.horizontal.samples[::times].tolist() == NOISE.tolist()


@pytest.mark.parametrize(
    "step", [0.005, 0.0071, *(pytest.param(s, marks=pytest.mark.long) for s in (0.001, 0.003))]
)
@pytest.mark.parametrize("frequency", [1.0, 20.0, 40.0])
def test_band_limited_refining_follows_tone(step, frequency):
    """Up to 0.8 of the Nyquist frequency, where straight lines are inaccurate."""
    fine = motion(tone(frequency)).resampled(f"{step} s")
    time = np.arange(len(fine)) * step
    swell = np.sin(np.pi * time / 40.0) ** 2
    exact = swell * np.sin(2.0 * np.pi * frequency * time)
    assert fine.si.horizontal.samples == pytest.approx(exact, abs=3e-5)
    if frequency > 10.0:
        lines = motion(tone(frequency)).resampled(f"{step} s", interpolation="linear")
        assert np.abs(lines.si.horizontal.samples - exact).max() > 0.1


def test_band_limited_samples_of_a_straight_line_are_on_it():
    line = np.linspace(2.0, 5.0, 301)
    fine = motion(line).resampled("0.002 s")
    assert fine.si.horizontal.samples == pytest.approx(np.linspace(2.0, 5.0, 1501), abs=1e-5)


def test_fine_samples_have_nothing_beyond_the_old_nyquist_frequency():
    steep = RNG.normal(size=4000) * np.sin(np.pi * np.arange(4000) / 3999.0) ** 2
    fine = motion(steep).resampled("0.0025 s").si.horizontal.samples
    power = np.abs(np.fft.rfft(fine)) ** 2
    frequency = np.fft.rfftfreq(fine.size, 0.0025)
    assert power[frequency > 56.0].sum() < 1e-10 * power.sum()


def test_an_unknown_interpolation_is_refused():
    with pytest.raises(ComponentError, match="interpolation must be 'band-limited' or 'linear'"):
        motion().resampled("0.005 s", interpolation="cubic")


def test_refined_pulse_is_sampled_from_the_function():
    fine = GroundMotion.sine_pulse("1 m/s^2", "1 Hz").resampled("0.001 s")
    exact = np.sin(2.0 * np.pi * 0.001 * np.arange(1001))
    assert fine.si.horizontal.samples == pytest.approx(exact, abs=1e-12)


@pytest.mark.parametrize("parts", [1, 2, 3, 8])
@pytest.mark.parametrize("record", [motion(), GroundMotion.cosine_pulse("1 m/s^2", "1 Hz")])
def test_divided_signals_are_the_same_function(record, parts):
    signal = record.si.horizontal
    divided = divided_signal(signal, parts)
    assert divided.analytic == signal.analytic
    assert divided.samples[::parts].tolist() == signal.samples.tolist()
    assert divided.samples == pytest.approx(signal.at(divided.times), rel=1e-12, abs=1e-12)
    time = np.linspace(0.0, signal.duration, 997)
    assert divided.at(time) == pytest.approx(signal.at(time), rel=1e-12, abs=1e-12)


@settings(max_examples=60, deadline=None)
@given(
    values=st.lists(st.floats(-50.0, 50.0), min_size=2, max_size=40),
    times=st.integers(1, 6),
)
def test_refining_never_changes_the_function(values, times):
    coarse = motion(values)
    fine = coarse.resampled(f"{STEP / times!r} s", interpolation="linear")
    time = np.linspace(0.0, coarse.si.duration, 97)
    assert fine.si.at(time) == pytest.approx(coarse.si.at(time), abs=1e-9)
    assert fine.si.peak == pytest.approx(coarse.si.peak, rel=1e-14, abs=1e-300)


def test_time_step_that_needs_oversized_filter_is_refused():
    record = GroundMotion.from_arrays(([0.0, 1.0, -1.0], "m/s^2"), time_step="0.01 s")
    with pytest.raises(
        ComponentError, match=r"too short compared with that of the record, 0\.01 s"
    ):
        record.resampled("1e-9 s")
    assert len(record.resampled("1e-6 s", interpolation="linear")) == 20_001
