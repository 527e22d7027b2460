"""Spectra and intensity measures against closed forms, brute force and another library."""

import math
import warnings
from itertools import accumulate

import numpy as np
import pytest
from records import record_path
from scipy.linalg import expm
from scipy.optimize import brentq

import rockframe as rf
from rockframe.errors import ComponentError, RockframeWarning
from rockframe.measures import (
    fourier_spectrum,
    intensity_measures,
    response_spectrum,
    velocity_and_displacement,
)

pytestmark = [
    pytest.mark.analytical,
    # the oracle takes the same straight lines
    pytest.mark.filterwarnings("ignore:.*is coarse for periods:rockframe.errors.RecordWarning"),
]

HALF = 0.8  # length of the half-sine [s]
PERIODS = np.geomspace(0.05, 10.0, 40)
RECORDS = ("PEERSMD_CHICHI_TCU128-N.AT2", "NIS090.AT2", "RSN763_LOMAP_GIL067.AT2")


def spectrum(motion, periods, damping_ratio, name):
    found = response_spectrum(motion, (periods, "s"), damping_ratio)
    return found[name].values[0]


# the half-sine, undamped ---------------------------------------------------------------------


def half_sine_factor(period):
    """Return greatest displacement over the static one (Chopra, Dynamics of Structures, 4.8)."""
    ratio = HALF / period
    if ratio == 0.5:
        return 0.5 * math.pi
    beta = 0.5 / ratio
    free = abs(2.0 * beta * math.cos(math.pi * ratio) / (beta**2 - 1.0))
    if ratio < 0.5:
        return free
    peaks = [
        abs(math.sin(2.0 * math.pi * k / (1.0 + 2.0 * ratio)) / (1.0 - beta))
        for k in range(1, math.ceil(ratio + 0.5))
    ]
    return max([*peaks, free])


@pytest.fixture(scope="module")
def half_sine():
    return rf.GroundMotion.sine_pulse("2 m/s^2", f"{0.5 / HALF!r} Hz", cycles=0.5)


def test_half_sine_on_an_undamped_oscillator(half_sine):
    periods = HALF / np.array([60.0, 20.0, 7.3, 3.0, 2.1, 1.0, 0.7, 0.5, 0.3, 0.1, 0.02])
    expected = 2.0 * np.array([half_sine_factor(period) for period in periods])
    for name in ("pseudo_spectral_acceleration", "absolute_spectral_acceleration"):
        found = spectrum(half_sine, periods, 0.0, name)
        np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_short_pulse_gives_spectral_velocity_of_its_impulse(half_sine):
    """Peak velocity of the relative motion is the ground's velocity step."""
    (found,) = spectrum(half_sine, [2000.0], 0.0, "spectral_velocity")
    assert found == pytest.approx(2.0 * 2.0 * HALF / math.pi, rel=1e-6)


# the harmonic --------------------------------------------------------------------------------


def harmonic_response(time, rate, omega, xi):
    """Return u, v and -(absolute acceleration) from rest under sin(rate t)."""
    gap, drag = omega**2 - rate**2, 2.0 * xi * omega * rate
    size = gap**2 + drag**2
    sine, cosine = -gap / size, drag / size
    damped = omega * math.sqrt(1.0 - xi**2)
    c = -cosine
    s = (xi * omega * c - rate * sine) / damped
    fade = np.exp(-xi * omega * time)
    u = (
        sine * np.sin(rate * time)
        + cosine * np.cos(rate * time)
        + fade * (c * np.cos(damped * time) + s * np.sin(damped * time))
    )
    v = rate * (sine * np.cos(rate * time) - cosine * np.sin(rate * time)) + fade * (
        (damped * s - xi * omega * c) * np.cos(damped * time)
        - (damped * c + xi * omega * s) * np.sin(damped * time)
    )
    return u, v, 2.0 * xi * omega * v + omega**2 * u


@pytest.mark.parametrize("xi", [0.0, 0.02, 0.05, 0.4])
@pytest.mark.parametrize("ratio", [0.13, 0.6, 0.9, 1.4, 3.7])
def test_harmonic_from_rest_with_its_transient(ratio, xi):
    rate = 2.0 * math.pi
    omega = rate / ratio
    motion = rf.GroundMotion.harmonic("1 m/s^2", "1 Hz", duration="12 s")
    time = np.linspace(0.0, 12.0, 200_001)
    u, v, pull = harmonic_response(time, rate, omega, xi)
    found = response_spectrum(motion, ([2.0 * math.pi / omega], "s"), xi)
    # free vibration after the motion may be larger; its energy bounds it
    energy = math.hypot(omega * u[-1], v[-1])
    for name, history, bound in (
        ("spectral_displacement", u, energy / omega),
        ("spectral_velocity", v, energy),
        ("absolute_spectral_acceleration", pull, energy * omega * math.hypot(1.0, 2.0 * xi)),
    ):
        peak = np.abs(history).max()
        value = found[name].item()
        if bound < peak:
            assert value == pytest.approx(peak, rel=2e-6), name
        else:
            assert peak * (1.0 - 2e-6) <= value <= bound * (1.0 + 2e-6), name


@pytest.mark.parametrize("xi", [0.05, 0.2])
@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0])
def test_harmonic_in_steady_state(ratio, xi):
    """Faded in and out over many cycles, so that no transient remains."""
    count, dt = 48_001, 0.0025
    time = np.arange(count) * dt
    grown = np.sin(0.5 * math.pi * np.minimum(1.0, np.minimum(time, 120.0 - time) / 35.0)) ** 2
    motion = rf.GroundMotion.from_arrays((grown * np.sin(2.0 * math.pi * time), "m/s^2"), f"{dt} s")
    omega = 2.0 * math.pi / ratio
    factor = 1.0 / math.hypot(1.0 - ratio**2, 2.0 * xi * ratio)
    found = response_spectrum(motion, ([ratio], "s"), xi)
    assert found.spectral_displacement.item() == pytest.approx(factor / omega**2, rel=1e-3)
    transmitted = factor * math.hypot(1.0, 2.0 * xi * ratio)
    assert found.absolute_spectral_acceleration.item() == pytest.approx(transmitted, rel=1e-3)


def test_resonance_grows_to_its_limit():
    motion = rf.GroundMotion.harmonic("1 m/s^2", "2 Hz", duration="30 s")
    (found,) = spectrum(motion, [0.5], 0.05, "spectral_displacement")
    assert found == pytest.approx(1.0 / (0.1 * (4.0 * math.pi) ** 2), rel=1e-6)


# straight lines ------------------------------------------------------------------------------


def brute_force(samples, dt, period, xi, fine):
    """Evaluate exact states at many points of every step, by powers of a matrix exponential."""
    omega = 2.0 * math.pi / period
    generator = np.zeros((4, 4))
    generator[0, 1] = generator[2, 3] = 1.0
    generator[1] = [-(omega**2), -2.0 * xi * omega, -1.0, 0.0]
    part = expm(generator * dt / fine)
    inside = np.array([*accumulate([part] * fine, np.matmul)])[:, :2]
    padded = np.concatenate([samples, [0.0], np.zeros(math.ceil(1.2 * period / dt))])
    slopes = np.diff(padded) / dt
    slopes[samples.size - 1] = 0.0  # the ground acceleration drops to zero after its last sample
    state, peaks = np.zeros(2), np.zeros(3)
    for k, slope in enumerate(slopes):
        start = padded[k] if k != samples.size - 1 else 0.0
        path = inside @ [*state, start, slope]
        pull = 2.0 * xi * omega * path[:, 1] + omega**2 * path[:, 0]
        peaks = np.maximum(peaks, [*np.abs(path).max(axis=0), np.abs(pull).max()])
        state = path[-1]
    return peaks


@pytest.mark.parametrize("xi", [0.0, 0.05, 0.5])
@pytest.mark.parametrize("period", [0.004, 0.011, 0.03, 0.1, 0.37, 1.3, 8.0])
def test_peaks_between_samples(period, xi):
    dt = 0.02
    samples = np.convolve(np.random.default_rng(4).normal(size=80), np.ones(3) / 2.0)
    motion = rf.GroundMotion.from_arrays((samples, "m/s^2"), f"{dt} s")
    fine = max(20, math.ceil(600 * dt / period))
    expected = brute_force(samples, dt, period, xi, fine)
    found = response_spectrum(motion, ([period], "s"), xi)
    values = [found[name].item() for name in SPECTRA]
    # brute force misses up to (2 pi/600)^2/8 between its points
    np.testing.assert_allclose(values, expected, rtol=5e-5)


SPECTRA = ("spectral_displacement", "spectral_velocity", "absolute_spectral_acceleration")


def test_peak_is_found_where_ground_reverses_within_step():
    """Value and slope at the step's end do not bound the peak: the ground reverses in the step."""
    samples = np.array([1.4485, 0.5495, -1.3558, 0.7554])
    motion = rf.GroundMotion.from_arrays((samples, "m/s^2"), "0.02 s")
    found = response_spectrum(motion, ["0.7 s"], 1.0)
    expected = brute_force(samples, 0.02, 0.7, 1.0, 400)
    values = [found[name].item() for name in SPECTRA]
    np.testing.assert_allclose(values, expected, rtol=5e-5)


def test_peak_is_found_where_velocity_chord_misleads():
    """The acceleration nearly vanishes at the zero of the chord of the velocity."""
    samples = np.array([0.94, -0.88, 1.38, -0.68, 0.78, -1.77])
    motion = rf.GroundMotion.from_arrays((samples, "m/s^2"), "0.02 s")
    found = response_spectrum(motion, ["0.24 s"], 0.7)
    expected = brute_force(samples, 0.02, 0.24, 0.7, 400)
    values = [found[name].item() for name in SPECTRA]
    np.testing.assert_allclose(values, expected, rtol=5e-5)


def test_zero_padding_does_not_change_spectra_of_jumping_pulse():
    """A pulse that jumps at its end has the same spectra when padded with zeros."""
    pulse = rf.GroundMotion.cosine_pulse("3 m/s^2", "1 Hz", cycles=0.3)
    still = rf.GroundMotion.from_arrays((np.zeros(200), "m/s^2"), (pulse.si.time_step, "s"))
    periods = (np.geomspace(0.01, 5.0, 60), "s")
    alone = response_spectrum(pulse, periods, (0.0, 0.05, 1.0))
    longer = response_spectrum(pulse.with_vertical(still), periods, (0.0, 0.05, 1.0))
    for name in SPECTRA:
        np.testing.assert_allclose(longer[name], alone[name], rtol=3e-6)


def test_limits_of_very_short_and_very_long_periods():
    rng = np.random.default_rng(1)
    samples = np.convolve(rng.normal(size=400), np.hanning(60), "same")
    samples[:60] *= np.linspace(0.0, 1.0, 60)
    motion = rf.GroundMotion.from_arrays((samples, "m/s^2"), "0.01 s")
    rigid = response_spectrum(motion, ["0 s", "0.002 s", "10000 s"], 0.05)
    measures = intensity_measures(motion)
    peak = measures.peak_ground_acceleration.item()
    for name in ("pseudo_spectral_acceleration", "absolute_spectral_acceleration"):
        assert rigid[name].values[0, 0] == peak
        assert rigid[name].values[0, 1] == pytest.approx(peak, rel=1e-2)
    for name in ("spectral_displacement", "spectral_velocity", "pseudo_spectral_velocity"):
        assert rigid[name].values[0, 0] == 0.0
    # the relative motion of a very soft oscillator is that of the ground
    speed = measures.peak_ground_velocity.item()
    assert rigid.spectral_velocity.values[0, 2] == pytest.approx(speed, rel=1e-2)


def test_path_of_the_ground_is_exact_for_straight_lines():
    samples = np.random.default_rng(2).normal(size=50)
    path = velocity_and_displacement(rf.GroundMotion.from_arrays((samples, "m/s^2"), "0.1 s"))
    velocity = displacement = 0.0
    for k in range(samples.size - 1):
        start, end = samples[k], samples[k + 1]
        displacement += 0.1 * velocity + 0.01 * (2.0 * start + end) / 6.0
        velocity += 0.05 * (start + end)
        assert path.ground_velocity.values[k + 1] == pytest.approx(velocity, abs=1e-14)
        assert path.ground_displacement.values[k + 1] == pytest.approx(displacement, abs=1e-13)


def test_peak_ground_displacement_within_first_interval_is_found():
    """a = 2 - 50 t, so that v = 2 t - 25 t^2 is zero at the start and at 0.08 s."""
    motion = rf.GroundMotion.from_arrays(([2.0, -3.0], "m/s^2"), "0.1 s")
    found = intensity_measures(motion).peak_ground_displacement.item()
    assert found == pytest.approx(0.08**2 - 25.0 / 3.0 * 0.08**3, rel=1e-12)


def test_peak_ground_displacement_between_velocity_zeros_is_found():
    samples = np.array([1.0, -2.0, 2.0, -1.0])
    motion = rf.GroundMotion.from_arrays((samples, "m/s^2"), "0.1 s")
    fine = motion.resampled("0.0001 s", interpolation="linear")
    expected = velocity_and_displacement(fine).ground_displacement
    found = intensity_measures(motion).peak_ground_displacement.item()
    assert found == pytest.approx(float(np.abs(expected).max()), rel=1e-6)


# a sine pulse --------------------------------------------------------------------------------


def test_measures_of_a_sine_pulse():
    amplitude, frequency, cycles, g = 3.0, 0.8, 2, 9.81
    rate, length = 2.0 * math.pi * frequency, cycles / frequency
    pulse = rf.GroundMotion.sine_pulse("3 m/s^2", "0.8 Hz", cycles=cycles)
    block = rf.Block(width="1 m", height="6 m", mass="5 t")
    found = intensity_measures(pulse, block=block, threshold="1 m/s^2", gravity=f"{g} m/s^2")
    tangent = 1.0 / 6.0
    uplift = g * tangent
    p = math.sqrt(0.75 * g / math.hypot(0.5, 3.0))
    below = math.asin(1.0 / amplitude) / rate
    expected = {
        "peak_ground_acceleration": amplitude,
        "peak_ground_velocity": 2.0 * amplitude / rate,
        "peak_ground_displacement": amplitude / rate * length,
        "arias_intensity": math.pi / (2.0 * g) * amplitude**2 * length / 2.0,
        "cumulative_absolute_velocity": 2.0 * amplitude / math.pi * length,
        "bracketed_duration": length - 2.0 * below,
        "uplift_acceleration": uplift,
        "uplift_duration": length * (1.0 - 2.0 * math.asin(uplift / amplitude) / math.pi),
        "relative_peak_ground_acceleration": amplitude / uplift,
        "relative_peak_ground_velocity": p * 2.0 * amplitude / rate / uplift,
        "relative_predominant_frequency": 2.0
        * math.pi
        / found.predominant_velocity_period.item()
        / p,
    }
    for name, value in expected.items():
        assert found[name].item() == pytest.approx(value, rel=1e-9), name


@pytest.mark.parametrize("period", [0.7, 1.3])
def test_cumulative_absolute_velocity_of_a_ricker_wavelet(period):
    """The acceleration changes its sign between samples."""
    pulse = rf.GroundMotion.ricker_wavelet("2 m/s^2", f"{period} s")
    highest = 2.0 * period / (math.sqrt(2.0) * math.pi) * math.exp(-0.5)
    found = intensity_measures(pulse)
    assert found.peak_ground_velocity.item() == pytest.approx(highest, rel=1e-11)
    assert found.cumulative_absolute_velocity.item() == pytest.approx(4.0 * highest, rel=1e-11)


@pytest.mark.parametrize("cycles", [0.01, 0.5, 1.7])
def test_significant_durations_of_a_sine_pulse(cycles):
    """Arias intensity grows as t - sin(2 rate t)/(2 rate), also between the samples."""
    rate, length = 2.0 * math.pi * 0.8, cycles / 0.8
    pulse = rf.GroundMotion.sine_pulse("3 m/s^2", "0.8 Hz", cycles=cycles)
    found = intensity_measures(pulse)

    def time_of(share):
        def excess(time):
            history, total = (t - math.sin(2.0 * rate * t) / (2.0 * rate) for t in (time, length))
            return history - share * total

        return brentq(excess, 0.0, length, xtol=1e-14)

    for end in (0.75, 0.95):
        name = f"significant_duration_5_{100 * end:.0f}"
        expected = time_of(end) - time_of(0.05)
        assert found[name].item() == pytest.approx(expected, rel=1e-9), name


@pytest.mark.parametrize("cycles", [0.37, 0.61, 1.13])
@pytest.mark.parametrize("level", [0.99, 0.9999, 0.99999])
def test_exceedance_between_samples_counts_in_durations(cycles, level):
    """The level is exceeded near a peak between samples, for less than an interval."""
    pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz", cycles=cycles)
    assert not (np.abs(pulse.si.horizontal.samples) == 1.0).any()
    width = 0.5 - math.asin(level) / math.pi
    found = rf.intensity_measures(pulse, threshold=(level, "m/s^2"))
    more = 0.5 * math.floor(cycles / 0.5 - 0.5)  # to the last peak
    assert found.bracketed_duration.item() == pytest.approx(more + width, abs=1e-9)
    slender = rf.Block(width=(2 * level / 9.80665, "m"), height="2 m", mass="1 t")
    uplift = rf.intensity_measures(pulse, block=slender).uplift_duration
    assert uplift.item() == pytest.approx((1.0 + more / 0.5) * width, abs=1e-9)


def test_bracketed_duration_starts_at_sample_equal_to_threshold():
    pulse = rf.GroundMotion.half_sine_pulse("2 m/s^2", "1 s")
    for place in (5, 10, 20):
        level = pulse.si.horizontal.samples[place]
        found = intensity_measures(pulse, threshold=(level, "m/s^2")).bracketed_duration
        assert found.item() == pytest.approx(1.0 - 2.0 * place / 64.0, abs=1e-12)


def test_standardized_cav_counts_exceedance_between_samples():
    pulse = rf.GroundMotion.sine_pulse((0.025 * 9.80665 * 1.0001, "m/s^2"), "1 Hz", cycles=0.37)
    found = rf.intensity_measures(pulse)
    standard = found.standardized_cumulative_absolute_velocity.item()
    assert standard == pytest.approx(found.cumulative_absolute_velocity.item(), rel=1e-12)


@pytest.mark.parametrize(("step", "lost"), [(0.01, 0.046), (0.02, 0.175)])
def test_band_limited_refinement_restores_short_periods(step, lost):
    """A burst of 12 Hz with 8.3 and 4.2 samples per period."""

    def swell(between):
        time = np.arange(0.0, 4.0 + 0.5 * between, between)
        values = np.exp(-0.5 * ((time - 2.0) / 0.25) ** 2) * np.sin(24.0 * math.pi * time + 0.4)
        return rf.GroundMotion.from_arrays((values, "m/s^2"), f"{between!r} s")

    periods = ([0.0, 0.05, 1.0 / 12.0, 0.1, 0.2], "s")
    names = ["pseudo_spectral_acceleration", "spectral_velocity", "absolute_spectral_acceleration"]
    exact = response_spectrum(swell(0.0005), periods)
    lines = response_spectrum(swell(step), periods)
    fine = response_spectrum(swell(step), periods, interpolation="band-limited")
    assert (lines.attrs["interpolation"], fine.attrs["interpolation"]) == ("linear", "band-limited")
    for name in names:
        np.testing.assert_allclose(fine[name], exact[name], rtol=0.01, atol=1e-6)
    ratio = lines.pseudo_spectral_acceleration / exact.pseudo_spectral_acceleration
    assert float(ratio[0, 2]) == pytest.approx(1.0 - lost, abs=0.005)
    few = response_spectrum(swell(step), (["2"], "s"), interpolation="band-limited")
    np.testing.assert_allclose(
        few.spectral_displacement,
        response_spectrum(swell(step), (["2"], "s")).spectral_displacement,
        rtol=1e-12,
    )
    with pytest.raises(ComponentError, match="interpolation must be 'band-limited'"):
        response_spectrum(swell(step), periods, interpolation="cubic")


def test_interpolation_does_not_change_spectrum_of_analytic_pulse():
    pulse = rf.GroundMotion.sine_pulse("2 m/s^2", "3 Hz")
    periods = (["0.05", "0.3"], "s")
    one, other = (
        response_spectrum(pulse, periods, interpolation=kind) for kind in ("linear", "band-limited")
    )
    np.testing.assert_array_equal(one.spectral_displacement, other.spectral_displacement)


def test_fourier_transform_of_a_sine_pulse():
    amplitude, own, cycles = 2.0, 1.5, 3
    pulse = rf.GroundMotion.sine_pulse("2 m/s^2", "1.5 Hz", cycles=cycles)
    found = fourier_spectrum(pulse, resolution="0.01 Hz")
    frequency = found.frequency.values
    assert frequency[1] <= 0.01
    assert frequency[-1] == pytest.approx(0.5 * 128 * own, rel=0.02)
    angle, rate = 2.0 * math.pi * frequency, 2.0 * math.pi * own
    with np.errstate(invalid="ignore", divide="ignore"):
        exact = amplitude * rate * (1.0 - np.exp(-1j * angle * cycles / own)) / (rate**2 - angle**2)
    exact[np.isclose(frequency, own, rtol=1e-12)] = -0.5j * amplitude * cycles / own
    transform = found.fourier_amplitude.values * np.exp(1j * found.fourier_phase.values)
    np.testing.assert_allclose(transform, exact, atol=1e-9)


def test_parseval_identity_of_fourier_spectrum():
    samples = np.random.default_rng(5).normal(size=512)
    motion = rf.GroundMotion.from_arrays((samples, "m/s^2"), "0.01 s")
    found = fourier_spectrum(motion)
    power = found.fourier_amplitude.values**2
    sides = 2.0 * power.sum() - power[0] - power[-1]
    spacing = found.frequency.values[1]
    assert sides * spacing == pytest.approx(0.01 * np.sum(samples**2), rel=1e-12)


def test_mean_and_predominant_period_of_a_long_harmonic():
    motion = rf.GroundMotion.harmonic("1 m/s^2", "1.25 Hz", duration="200 s")
    found = intensity_measures(motion)
    assert found.mean_period.item() == pytest.approx(0.8, rel=2e-3)
    assert found.predominant_velocity_period.item() == pytest.approx(0.8, rel=5e-3)


def test_mean_period_does_not_jump_between_nearly_equal_time_steps():
    pulse = rf.GroundMotion.sine_pulse("4 m/s^2", "1 Hz")
    steps = np.linspace(0.005, 0.0052, 5)
    found = [intensity_measures(pulse.resampled(f"{step} s")).mean_period.item() for step in steps]
    # the integrals over the band of the spectrum of one cycle
    frequency = np.linspace(0.25, 20.0, 200_001)
    power = (np.sin(math.pi * frequency) / (1.0 - frequency**2 + 1e-30)) ** 2
    exact = np.trapezoid(power / frequency, frequency) / np.trapezoid(power, frequency)
    assert found == pytest.approx([exact] * 5, rel=5e-4)


# records against another library -------------------------------------------------------------


@pytest.fixture(scope="module", params=RECORDS)
def record(request):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RockframeWarning)
        motion = rf.GroundMotion.read(record_path(request.param))
    return motion.window("20 s", "60 s") if motion.si.duration > 60.0 else motion


def test_record_intensities_match_eqsig(record):
    pytest.importorskip("eqsig")
    from eqsig import AccSignal, im

    signal = AccSignal(record.si.horizontal.samples, record.si.time_step)
    found = intensity_measures(record, gravity="9.81 m/s^2")
    assert found.arias_intensity.item() == pytest.approx(
        im.calc_arias_intensity(signal)[-1], rel=1e-12
    )
    assert found.cumulative_absolute_velocity.item() == pytest.approx(
        im.calc_cav(signal)[-1], rel=1e-12
    )
    # pyrotd counts whole samples
    within = {"abs": 3.0 * record.si.time_step}
    durations = im.calc_sig_dur_vals(record.si.horizontal.samples, record.si.time_step)
    assert found.significant_duration_5_95.item() == pytest.approx(durations, **within)
    bracketed = im.calc_brac_dur(signal, 0.05 * 9.80665)
    assert found.bracketed_duration.item() == pytest.approx(bracketed, **within)


@pytest.mark.parametrize(
    "record",
    [RECORDS[1], *(pytest.param(name, marks=pytest.mark.long) for name in RECORDS[::2])],
    indirect=True,
)
def test_record_spectra_match_eqsig(record):
    """It takes peaks at samples only, so the same straight lines are sampled eight times finer."""
    pytest.importorskip("eqsig")
    from eqsig import sdof

    fine = record.resampled(
        f"{record.si.time_step / 8.0!r} s", interpolation="linear"
    ).si.horizontal
    histories = sdof.nigam_and_jennings_response(fine.samples, fine.time_step, PERIODS, 0.05)
    found = response_spectrum(record, (PERIODS, "s"))
    for name, history in zip(
        ("spectral_displacement", "spectral_velocity", "absolute_spectral_acceleration"),
        histories,
        strict=True,
    ):
        expected = np.abs(history).max(axis=1)
        np.testing.assert_allclose(found[name].values[0], expected, rtol=1e-3, err_msg=name)
