"""Exact integrals over a component of the ground, a polynomial in each interval.

Velocity and displacement, Arias intensity and cumulative absolute velocity, durations of strong
motion, and characteristic periods from the Fourier transform.
"""

import math
from typing import Any, Final

import numpy as np

from rockframe.errors import ComponentError
from rockframe.signals.arrays import Array
from rockframe.signals.motion import (
    MAXIMUM_SAMPLES,
    Signal,
    derivatives_of,
    extrema_of,
    integral_of,
    knots_of,
    roots_of,
    sign_changes,
    split_at,
)
from rockframe.signals.spectra import spectral_peaks


def ground_path(signal: Signal) -> tuple[Array, Array]:
    """Return velocity and displacement of ground from rest, as polynomials [m s^-1], [m]."""
    velocity = integral_of(signal.pieces, signal.time_step)
    return velocity, integral_of(velocity, signal.time_step)


def arias_path(signal: Signal, gravity: float) -> Array:
    """Return the Arias intensity along time, as polynomials, :eq:`eq-arias` [m s^-1]."""
    factor = 0.5 * math.pi / gravity
    if not signal.analytic:
        history = _cumulative(_trapezoid_means(signal.samples**2)) * (signal.time_step * factor)
        return np.column_stack([history[:-1], np.diff(history)])
    powers = signal.pieces.shape[1]
    squares = np.zeros((len(signal.pieces), 2 * powers - 1))
    for power in range(powers):
        squares[:, power : power + powers] += signal.pieces[:, power, None] * signal.pieces
    return integral_of(squares, signal.time_step * factor)


def absolute_velocity_history(signal: Signal) -> Array:
    """Return the cumulative absolute velocity up to every sample, :eq:`eq-cav` [m s^-1]."""
    if not signal.analytic:
        return _cumulative(_trapezoid_means(np.abs(signal.samples))) * signal.time_step
    # the total variation of the velocity, its extrema between samples included
    velocity = integral_of(signal.pieces, signal.time_step)
    knots = knots_of(velocity)
    variation = np.abs(np.diff(knots))
    rows, extrema = extrema_of(velocity)
    variation[rows] = np.abs(extrema - knots[rows]) + np.abs(extrema - knots[rows + 1])
    return _cumulative(variation)


def standardized_absolute_velocity(signal: Signal, threshold: float) -> float:
    """Sum the absolute velocity of the seconds whose peak reaches a threshold [m s^-1].

    By :eq:`eq-cav`.
    """
    times = signal.times
    seconds = np.arange(0.0, math.ceil(times[-1]) + 1.0)
    at_seconds = np.interp(seconds, times, absolute_velocity_history(signal))
    parts, starts, _ = _split_at_extrema(signal.pieces)
    count = len(signal.pieces)  # parts from this number on start at peaks
    times = np.concatenate([times, starts[count:] * signal.time_step, seconds])
    size = np.abs(np.concatenate([signal.samples, parts[count:, 0], signal.at(seconds)]))
    order = np.argsort(times, kind="stable")
    times, size = times[order], size[order]
    # the acceleration at a full second belongs to the seconds on both its sides
    rounding = 1e-9 * signal.time_step
    first = np.searchsorted(times, seconds[:-1] - rounding, side="left")
    last = np.searchsorted(times, seconds[1:] + rounding, side="right")
    strong = [
        bool(np.any(size[start:end] >= threshold))
        for start, end in zip(first.tolist(), last.tolist(), strict=True)
    ]
    return float(np.sum(np.diff(at_seconds)[strong]))


def _trapezoid_means(values: Array) -> Array:
    return 0.5 * (values[:-1] + values[1:])


def _cumulative(steps: Array) -> Array:
    return np.concatenate([[0.0], np.cumsum(steps)])


def time_between_shares(growing: Array, time_step: float, start: float, end: float) -> float:
    """Return the time in which growing polynomials go from one share of the last value to another.

    In seconds; zero for polynomials that are zero.
    """
    knots = knots_of(growing)
    if knots[-1] <= 0.0:
        return 0.0
    shares = np.array([start, end])
    rows = np.searchsorted(knots / knots[-1], shares) - 1
    crossing = growing[rows] / knots[-1]
    crossing[:, 0] -= shares
    return float(np.diff(rows + roots_of(crossing))[0]) * time_step


def exceedance(signal: Signal, level: float) -> tuple[float, float]:
    """Return the time from first to last exceedance of a level [m s^-2], and the total time [s]."""
    first, last, total = np.inf, -np.inf, 0.0
    pieces, starts, lengths = _split_at_extrema(signal.pieces)
    for side in (1.0, -1.0):
        above = side * pieces
        above[:, 0] -= level
        starts_above, ends_above = above[:, 0] > 0.0, above.sum(axis=1) > 0.0
        enter, leave = np.zeros(len(above)), np.ones(len(above))
        crossed = starts_above != ends_above
        at = roots_of(above[crossed])
        enter[crossed] = np.where(starts_above[crossed], 0.0, at)
        leave[crossed] = np.where(starts_above[crossed], at, 1.0)
        rows = np.flatnonzero(starts_above | ends_above)
        if rows.size:
            total += float(np.sum(lengths[rows] * (leave[rows] - enter[rows])))
            first = min(first, float(np.min(starts[rows] + lengths[rows] * enter[rows])))
            last = max(last, float(np.max(starts[rows] + lengths[rows] * leave[rows])))
    bracketed = max(0.0, last - first)
    return bracketed * signal.time_step, total * signal.time_step


def _split_at_extrema(pieces: Array) -> tuple[Array, Array, Array]:
    """Divide intervals at their extrema; give the parts, their starts and lengths in time steps.

    Each part is monotone, so that it crosses a level once at most.
    """
    starts, lengths = np.arange(float(len(pieces))), np.ones(len(pieces))
    slopes = derivatives_of(pieces)
    rows = sign_changes(slopes)
    if not rows.size:
        return pieces, starts, lengths
    at = roots_of(slopes[rows])
    parts, (before, after) = pieces.copy(), split_at(pieces[rows], at)
    parts[rows], lengths[rows] = before, at
    return (
        np.concatenate([parts, after]),
        np.concatenate([starts, rows + at]),
        np.concatenate([lengths, 1.0 - at]),
    )


_TERMS: Final = 40


def transform_of(signal: Signal, resolution: float) -> tuple[Array, Any]:
    """Compute the Fourier transform, :eq:`eq-fourier`.

    Parameters
    ----------
    signal : Signal
        Acceleration of the ground.
    resolution : float
        Greatest spacing of the frequencies; 0 for one over the duration [Hz].

    Returns
    -------
    frequency : ndarray, shape (k,)
        [Hz]
    transform : ndarray of complex, shape (k,)
        [m s^-1]

    Raises
    ------
    ComponentError
        The resolution needs too many samples.
    """
    dt, count = signal.time_step, signal.samples.size
    if resolution > 0.0:
        count = max(count, math.ceil(min(1.0 / resolution / dt, 2.0 * MAXIMUM_SAMPLES)))
    if count > MAXIMUM_SAMPLES:
        msg = (
            f"Fourier transform: a resolution of {resolution:.4g} Hz needs too many samples at "
            f"{dt:.4g} s; give a coarser one"
        )
        raise ComponentError(msg)
    frequency = np.arange(float(count // 2 + 1)) / (count * dt)
    if not signal.analytic:
        return frequency, dt * np.fft.rfft(signal.samples, count)
    by_power = np.fft.rfft(signal.pieces, count, axis=0)
    moments = _moments(2.0 * np.pi * frequency * dt, by_power.shape[1])
    return frequency, dt * (by_power * moments).sum(axis=1)


def _moments(angle: Array, powers: int) -> Any:
    """Integrate x^j exp(-i angle x) over x from 0 to 1, for j = 0, 1, ...; angle up to pi."""
    moments = np.zeros((angle.size, powers), dtype=complex)
    term = np.ones(angle.size, dtype=complex)
    for n in range(_TERMS):
        moments += term[:, None] / (n + 1 + np.arange(powers))
        term *= -1j * angle / (n + 1)
    return moments


MEAN_PERIOD_BAND: Final = (0.25, 20.0)
"""Range of frequencies of which the mean period is a mean [Hz] (Rathje et al. 1998)."""

MEAN_PERIOD_RESOLUTION: Final = 0.05
"""Greatest spacing of these frequencies [Hz] (Rathje et al. 2004)."""

HOUSNER_BAND: Final = (0.1, 2.5)
"""Periods over which the velocity spectrum is integrated [s] (Housner 1952)."""

HOUSNER_PERIODS: Final = np.linspace(*HOUSNER_BAND, 241)
"""Periods at which the velocity spectrum is computed for its integral [s]."""

PREDOMINANT_PERIODS: Final = 10.0 ** (np.arange(-100, 131) / 100.0)
"""Periods at which the peak of the velocity spectrum is looked for: 0.1 s to 20 s [s]."""


def mean_period(signal: Signal) -> float:
    """Return the mean period, :eq:`eq-mean-period`; NaN without power in its band [s]."""
    frequency, transform = transform_of(signal, MEAN_PERIOD_RESOLUTION)
    low, high = MEAN_PERIOD_BAND
    half = 0.5 * frequency[-1] / max(frequency.size - 1, 1)
    # counted whole or not at all, one at an end of the band would come and go with the time step
    share = np.minimum(frequency + half, high) - np.maximum(frequency - half, low)
    inside = share > 0.0
    power = share[inside] * np.abs(transform[inside]) ** 2
    total = float(np.sum(power))
    return float(np.sum(power / frequency[inside])) / total if total > 0.0 else math.nan


def housner_intensity(signal: Signal, damping_ratio: float) -> float:
    """Integrate the pseudo-velocity spectrum, :eq:`eq-housner-intensity` [m]."""
    from scipy.integrate import trapezoid

    velocity = _pseudo_velocity(signal, HOUSNER_PERIODS, damping_ratio)
    return float(trapezoid(velocity, HOUSNER_PERIODS))


def predominant_period(signal: Signal, damping_ratio: float) -> float:
    """Return the period of the peak of pseudo-velocity, 0.1 s to 20 s; NaN for still ground [s]."""
    velocity = _pseudo_velocity(signal, PREDOMINANT_PERIODS, damping_ratio)
    if not velocity.max() > 0.0:
        return math.nan
    top = int(np.argmax(velocity))
    if not 0 < top < velocity.size - 1:
        return float(PREDOMINANT_PERIODS[top])
    # vertex of the parabola through three points, evenly spaced in log T
    left, middle, right = velocity[top - 1 : top + 2].tolist()
    shift = 0.5 * (left - right) / (left - 2.0 * middle + right)
    return float(
        PREDOMINANT_PERIODS[top] * (PREDOMINANT_PERIODS[1] / PREDOMINANT_PERIODS[0]) ** shift
    )


def _pseudo_velocity(signal: Signal, periods: Array, damping_ratio: float) -> Array:
    peaks = spectral_peaks(signal, periods, damping_ratio)
    return 2.0 * np.pi / periods * peaks[:, 0]
