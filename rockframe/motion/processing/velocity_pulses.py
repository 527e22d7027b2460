"""The strongest pulse in a velocity history: search, extraction, classification (Baker 2007)."""

from __future__ import annotations

import math
from functools import cache
from typing import Final, NamedTuple

import numpy as np

from rockframe.signals.arrays import Array

SUPPORT: Final = 7
"""Length of the support of the wavelet [1]."""

CENTRE_FREQUENCY: Final = 5.0 / 7.0
"""Frequency of the greatest Fourier amplitude, in cycles per unit length, rounded to a multiple of
one cycle over the support. The pseudo-period is the scale over it, :eq:`eq-pseudo-period` [1]."""

_MOMENTS: Final = 4
_LEVELS: Final = 12


def mother_wavelet(place: Array) -> Array:
    """Evaluate the wavelet, :eq:`eq-two-scale`."""
    knots, values = _table()
    return np.interp(place, knots, values, left=0.0, right=0.0)


@cache
def scaling_filter() -> Array:
    """Compute the filter of the two-scale equation, :eq:`eq-daubechies-filter`, shape (8,)."""
    # |m(y)|^2 = (1 - y)^4 P(y) with y = sin^2(w/2), P(y) = sum of binomials times y^k
    binomials = [math.comb(_MOMENTS - 1 + k, k) for k in range(_MOMENTS)]
    taps = np.array([1.0])
    for root in np.roots(binomials[::-1]):
        # 2 - z - 1/z = 4 y: of the two zeros z the one inside the unit circle
        pair = np.roots([1.0, 4.0 * root - 2.0, 1.0])
        taps = np.convolve(taps, [1.0, -pair[np.argmin(np.abs(pair))]])
    for _ in range(_MOMENTS):
        taps = np.convolve(taps, [1.0, 1.0])
    real: Array = np.real(taps)
    return real * (math.sqrt(2.0) / real.sum())


@cache
def _table() -> tuple[Array, Array]:
    """Return exact values of the wavelet at dyadic points: integers, halves, quarters and so on."""
    taps = math.sqrt(2.0) * scaling_filter()
    size = taps.size
    # the values at integers are an eigenvector of the two-scale equation
    inner = np.arange(1, size - 1)
    index = 2 * inner[:, None] - inner[None, :]
    matrix = np.where((index >= 0) & (index < size), taps[np.clip(index, 0, size - 1)], 0.0)
    eigenvalues, vectors = np.linalg.eig(matrix)
    vector = np.real(vectors[:, np.argmin(np.abs(eigenvalues - 1.0))])
    scaling = np.concatenate([[0.0], vector / vector.sum(), [0.0]])
    for level in range(_LEVELS):
        scaling = _halve_spacing(scaling, taps, level)
    details = taps[::-1] * (-1.0) ** np.arange(size)
    # psi(x) = sum of g_k phi(2 x - k): phi on every second point, shifted by k
    wavelet = np.zeros_like(scaling)
    half = 2**_LEVELS
    places = 2 * np.arange(scaling.size)
    for k, detail in enumerate(details.tolist()):
        index = places - k * half
        inside = (index >= 0) & (index < scaling.size)
        wavelet[inside] += detail * scaling[index[inside]]
    return np.arange(scaling.size) / half, wavelet


def _halve_spacing(values: Array, taps: Array, level: int) -> Array:
    """Halve the distance of points by phi(x) = sum of h_k phi(2 x - k)."""
    spacing = 2**level
    count = (values.size - 1) * 2 + 1
    fine = np.zeros(count)
    fine[::2] = values
    places = np.arange(1, count, 2)  # place over twice the spacing is x
    for k, tap in enumerate(taps.tolist()):
        index = places - k * spacing
        inside = (index >= 0) & (index < values.size)
        fine[places[inside]] += tap * values[index[inside]]
    return fine


PERIOD_RATIO: Final = 1.02
"""Ratio of successive periods of the wavelet transform [1]."""

WAVELET_COUNT: Final = 10
"""Number of wavelets in a pulse (Baker 2007)."""

REACH: Final = 0.4
"""Greatest distance of wavelets from the first one, over their scale [1] (Shahi and Baker 2014)."""

INDICATOR_COEFFICIENTS: Final = (-23.3, 14.6, 20.5)
"""Constant, and coefficients of the ratios of peak velocities and energies [1] (Baker 2007)."""

MIN_INDICATOR: Final = 0.85
"""Least pulse indicator of a pulse-like motion [1] (Baker 2007)."""

MIN_PEAK_VELOCITY: Final = 0.3
"""Least peak velocity of a pulse-like motion [m s^-1] (Baker 2007)."""

PULSE_SHARE: Final = 0.1
MOTION_SHARE: Final = 0.2
"""Fractions of the cumulative squared velocity that define the starts of pulse and motion (Baker
2007)."""

_REFINEMENT: Final = 10
_SEARCH_STEPS: Final = 200
"""Samples in the shortest period that are enough for the search; finer ones are left out."""


class WaveletPeak(NamedTuple):
    """The wavelet with the greatest coefficient."""

    period: float  # pseudo-period of the wavelet [s]
    sample: int  # index of the sample at its middle
    direction: float  # from the first component towards the second; zero for one component [rad]


class PulseMeasures(NamedTuple):
    """Quantities by which a motion is classified as pulse-like or not."""

    # peak and sum of squares of the residual velocity, over those of the motion [1]
    peak_ratio: float
    energy_ratio: float
    indicator: float  # from 0, no pulse, to 1 [1]
    # times of a tenth of the cumulative squares of the pulse, and of a fifth of the motion [s]
    pulse_start: float
    motion_start: float


def period_range(shortest: float, longest: float) -> Array:
    """Return the periods of the search for a pulse [s]."""
    count = math.ceil(math.log(longest / shortest) / math.log(PERIOD_RATIO)) + 1
    return np.geomspace(shortest, longest, max(count, 2))


def strongest_wavelet(velocities: Array, dt: float, periods: Array) -> WaveletPeak:
    """Find where :eq:`eq-wavelet-coefficient` is greatest, by :eq:`eq-pulse-direction`."""
    from scipy import fft

    every = max(1, int(periods[0] / (_SEARCH_STEPS * dt)))
    searched, step = velocities[:, ::every], every * dt
    count = searched.shape[1]
    reach = sampled_wavelet(float(periods[-1]), step).size
    size = fft.next_fast_len(count + reach, real=True)
    transforms = np.fft.rfft(searched, size)
    greatest, period, sample = -1.0, 0.0, 0
    for trial_period in periods.tolist():
        wavelet = sampled_wavelet(trial_period, step)
        transform = np.conj(np.fft.rfft(wavelet, size))
        products = np.fft.irfft(transforms * transform, size)
        # the velocity is zero before and after; a wavelet may extend beyond both ends
        coefficients = np.roll(products, wavelet.size // 2, axis=1)[:, :count]
        squares: Array = np.sum(coefficients**2, axis=0)
        top = int(np.argmax(squares))
        if squares[top] > greatest:
            greatest, period, sample = float(squares[top]), trial_period, top * every
    if every > 1:
        last, wavelet = velocities.shape[1] - 1, sampled_wavelet(period, dt)
        around = range(max(0, sample - every), min(last, sample + every) + 1)
        found = [_coefficients_near(velocity, around, wavelet) for velocity in velocities]
        sample = around[int(np.argmax(np.sum(np.square(found), axis=0)))]
    near = np.geomspace(period / PERIOD_RATIO, period * PERIOD_RATIO, 2 * _REFINEMENT + 1)
    near = near[(near >= periods[0]) & (near <= periods[-1])]
    refined = np.array(
        [
            _coefficients_at(velocities, sample, sampled_wavelet(trial_period, dt))
            for trial_period in near.tolist()
        ]
    )
    best = int(np.argmax(np.sum(refined**2, axis=1)))
    direction = math.atan2(refined[best, 1], refined[best, 0]) if len(velocities) == 2 else 0.0
    return WaveletPeak(float(near[best]), sample, direction % math.pi)


def extract_pulse(
    velocity: Array, dt: float, periods: Array
) -> tuple[WaveletPeak, Array, list[tuple[int, float]], PulseMeasures]:
    """Find the strongest wavelet, its samples, the wavelets of the pulse, and its measures."""
    peak = strongest_wavelet(velocity[None, :], dt, periods)
    wavelet = sampled_wavelet(peak.period, dt)
    wavelets = extract_wavelets(velocity, dt, peak)
    pulse = sum_wavelets(wavelets, wavelet, 0, velocity.size)
    return peak, wavelet, wavelets, pulse_measures(velocity, pulse, dt)


def extract_wavelets(velocity: Array, dt: float, peak: WaveletPeak) -> list[tuple[int, float]]:
    """Extract the strongest wavelets near a place from a velocity, :eq:`eq-extracted-pulse`."""
    wavelet = sampled_wavelet(peak.period, dt)
    reach = math.ceil(REACH * peak.period * CENTRE_FREQUENCY / dt)
    around = range(max(0, peak.sample - reach), min(velocity.size - 1, peak.sample + reach) + 1)
    residual = velocity.copy()
    wavelets: list[tuple[int, float]] = []
    for _ in range(WAVELET_COUNT):
        coefficients = _coefficients_near(residual, around, wavelet)
        top = int(np.argmax(np.abs(coefficients)))
        wavelets.append((around[top], float(coefficients[top])))
        residual -= sum_wavelets([wavelets[-1]], wavelet, 0, velocity.size)
    return wavelets


def sum_wavelets(
    wavelets: list[tuple[int, float]], wavelet: Array, start: int, count: int
) -> Array:
    """Return the sum of wavelets at some samples."""
    total = np.zeros(count)
    for middle, coefficient in wavelets:
        begin = middle - wavelet.size // 2 - start
        first, last = max(0, begin), min(count, begin + wavelet.size)
        total[first:last] += coefficient * wavelet[first - begin : last - begin]
    return total


def pulse_measures(velocity: Array, pulse: Array, dt: float) -> PulseMeasures:
    """Compare the residual velocity with the velocity, :eq:`eq-pulse-indicator`."""
    residual = velocity - pulse
    peak_ratio = float(np.abs(residual).max() / np.abs(velocity).max())
    energy_ratio = float(residual @ residual / (velocity @ velocity))
    constant, of_peak, of_energy = INDICATOR_COEFFICIENTS
    exponent = constant + of_peak * peak_ratio + of_energy * energy_ratio
    return PulseMeasures(
        peak_ratio,
        energy_ratio,
        1.0 / (1.0 + math.exp(exponent)),
        _samples_to_fraction(pulse, PULSE_SHARE) * dt,
        _samples_to_fraction(velocity, MOTION_SHARE) * dt,
    )


def sampled_wavelet(period: float, dt: float) -> Array:
    """Sample the wavelet of a period, :eq:`eq-pseudo-period`, symmetrically to its middle."""
    scale = period * CENTRE_FREQUENCY / dt
    half = math.ceil(0.5 * SUPPORT * scale)
    wavelet = mother_wavelet(np.arange(-half, half + 1) / scale + 0.5 * SUPPORT)
    return wavelet / math.sqrt(float(wavelet @ wavelet))


def _samples_to_fraction(velocity: Array, fraction: float) -> int:
    """Count the samples until the sum of squares has reached a fraction of the total."""
    cumulative = np.cumsum(velocity**2)
    return int(np.searchsorted(cumulative, fraction * cumulative[-1]))


def _coefficients_near(velocity: Array, samples: range, wavelet: Array) -> Array:
    """Return the coefficients of a wavelet centred at consecutive samples."""
    from scipy import signal

    half = wavelet.size // 2
    zeros = np.zeros(half)
    window = np.concatenate([zeros, velocity, zeros])[samples[0] : samples[-1] + wavelet.size]
    return signal.correlate(window, wavelet, mode="valid")


def _coefficients_at(velocities: Array, sample: int, wavelet: Array) -> Array:
    """Return the coefficient of a wavelet centred at a sample, for each component."""
    return np.array(
        [
            _coefficients_near(velocity, range(sample, sample + 1), wavelet)[0]
            for velocity in velocities
        ]
    )
