"""Processing of the samples of a motion: resampling, filters, baselines and tapers.

Also a check whether time steps are short enough for given periods.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Any, Final

import numpy as np

from rockframe.errors import RecordWarning, warn
from rockframe.signals import Signal
from rockframe.signals.arrays import Array
from rockframe.signals.motion import subdivided

_INTEGER_RATIO: Final = 1e-9
_ANTI_ALIAS_ORDER: Final = 9  # an even order would lower low frequencies by 0.1 dB
_ANTI_ALIAS_RIPPLE: Final = 0.05
_ANTI_ALIAS_EDGE: Final = 0.8
_SINC_HALF_WIDTH: Final = 64
MAX_DIVISIONS: Final = 200_000
"""Most parts of a time step; with more the filter alone would take gigabytes."""
_SINC_WINDOW: Final = 12.0
_OVERSAMPLING: Final = 8


def sample_count(duration: float, time_step: float) -> int:
    """Count the samples of step `time_step` that fit into `duration`, both ends included."""
    return math.floor(duration / time_step * (1.0 + 1e-12) + _INTEGER_RATIO) + 1


def integer_ratio(ratio: float) -> int | None:
    """Return a ratio of time steps as a whole number; None if it is not whole."""
    nearest = round(ratio)
    return nearest if abs(ratio - nearest) <= _INTEGER_RATIO * ratio else None


def sample_times(duration: float, time_step: float) -> Array:
    """Return the times of the samples of step `time_step` within `duration` [s]."""
    return np.minimum(np.arange(sample_count(duration, time_step)) * time_step, duration)


def refined(signal: Signal, time_step: float) -> Array:
    """Sample the same function of time, linear or polynomial between samples, more finely."""
    place = sample_times(signal.duration, time_step) / signal.time_step
    if signal.analytic:
        return signal.at_place(place)
    samples = signal.samples
    ratio = integer_ratio(signal.time_step / time_step)
    if ratio is not None:
        share = np.arange(ratio) / ratio
        between = samples[:-1, None] * (1.0 - share) + samples[1:, None] * share
        return np.append(between.reshape(-1), samples[-1])
    interval = np.minimum(place.astype(np.intp), samples.size - 2)
    share = place - interval
    return samples[interval] * (1.0 - share) + samples[interval + 1] * share


def band_limited(dt: float, samples: Array, time_step: float) -> Array:
    """Sample at another step, by band-limited interpolation up to the old Nyquist frequency.

    The interpolation kernel is a sinc function with a Kaiser window, over 64 old samples to each
    side; its zeros are at the old samples. Beyond both ends the motion is continued by the
    straight line through its first and last sample. For a ratio that is not an integer, a quintic
    spline through samples at least eight times finer is evaluated.
    """
    from scipy import interpolate as splines_module
    from scipy import signal as module

    signal: Any = module
    splines: Any = splines_module
    integer = integer_ratio(dt / time_step)
    divisions = division_count(dt / time_step)
    sinc = np.sinc(
        np.arange(-_SINC_HALF_WIDTH * divisions, _SINC_HALF_WIDTH * divisions + 1) / divisions
    )
    taps = sinc * signal.windows.kaiser(sinc.size, _SINC_WINDOW)
    # not divided by the sum of the coefficients, so that the old samples do not change
    fine: Array = signal.resample_poly(
        samples, divisions, 1, window=taps / divisions, padtype="line"
    )
    fine = fine[: (samples.size - 1) * divisions + 1]
    if integer is not None:
        fine[::divisions] = samples
        return fine
    instants = sample_times((samples.size - 1) * dt, time_step)
    times = np.arange(fine.size) * (dt / divisions)
    return splines.make_interp_spline(times, fine, k=5)(instants)


def division_count(ratio: float) -> int:
    """Count the parts into which band-limited samples are divided for a ratio of time steps."""
    return integer_ratio(ratio) or math.ceil(_OVERSAMPLING * ratio)


def downsampled(dt: float, samples: Array, time_step: float) -> Array:
    """Sample more coarsely, after a zero-phase low-pass filter against aliasing.

    The filter is a Chebyshev filter of order 9 with a ripple of 0.05 dB up to 0.8 of the new
    Nyquist frequency, run forwards and backwards. For a ratio that is not an integer, the result
    is then interpolated like a finer one.
    """
    from scipy import signal as module

    signal: Any = module
    edge = _ANTI_ALIAS_EDGE * dt / time_step
    sos = signal.cheby1(_ANTI_ALIAS_ORDER, _ANTI_ALIAS_RIPPLE, edge, output="sos")
    padding = min(samples.size - 1, math.ceil(10.0 * time_step / dt) + 27)
    smooth: Array = signal.sosfiltfilt(sos, samples, padtype="odd", padlen=padding)
    factor = integer_ratio(time_step / dt)
    if factor is not None:
        return smooth[::factor]
    return band_limited(dt, smooth, time_step)


def padded(signal: Signal, count: int) -> Signal:
    """Append zeros up to `count` samples."""
    missing = count - signal.samples.size
    if missing == 0:
        return signal
    pieces = signal.polynomials
    if pieces is not None:
        pieces = np.pad(pieces, ((0, missing), (0, 0)))
    return replace(signal, samples=np.pad(signal.samples, (0, missing)), polynomials=pieces)


def divided_signal(signal: Signal, parts: int) -> Signal:
    """Divide every interval into equal parts."""
    if parts == 1:
        return signal
    step = signal.time_step / parts
    if signal.polynomials is None:
        return replace(signal, time_step=step, samples=refined(signal, step))
    pieces = subdivided(signal.polynomials, parts)
    samples = np.append(pieces[:, 0], signal.samples[-1])
    samples[::parts] = signal.samples
    return replace(signal, time_step=step, samples=samples, polynomials=pieces)


_PADDING_PERIODS: Final = 1.5


def butterworth(
    dt: float,
    samples: Array,
    *,
    low: float | None,
    high: float | None,
    order: int,
    causal: bool = False,
    keep_padding: bool = False,
) -> Array:
    """Apply a Butterworth filter to the zero-padded samples."""
    from scipy import signal as module

    signal: Any = module
    if low is None:
        corners: Any = high
        kind = "lowpass"
    elif high is None:
        corners, kind = low, "highpass"
    else:
        corners, kind = [low, high], "bandpass"
    sos = signal.butter(order, corners, btype=kind, fs=1.0 / dt, output="sos")
    padding = padding_samples(dt, low, high, order)
    rest = np.zeros(padding)
    if causal:
        # at rest before the motion; one zero shows the rise to a first sample that is not zero
        filtered: Array = signal.sosfilt(sos, np.concatenate([[0.0], samples, rest]))
        return filtered if keep_padding else filtered[1 : samples.size + 1]
    padded = np.concatenate([rest, samples, rest])
    result: Array = signal.sosfiltfilt(sos, padded, padtype=None)
    return result if keep_padding else result[padding : padding + samples.size]


def padding_samples(dt: float, low: float | None, high: float | None, order: int) -> int:
    """Count the zeros to put at each end: 1.5 order/f of the frequency f that decays most slowly.

    It is the lowest corner, the distance of the highest from the Nyquist frequency, or half the
    width of the band.
    """
    corners = [corner for corner in (low, high) if corner is not None]
    slowest = min(corners[0], 0.5 / dt - corners[-1])
    if low is not None and high is not None:
        slowest = min(slowest, 0.5 * (high - low))
    return math.ceil(_PADDING_PERIODS * order / (slowest * dt))


def without_baseline(samples: Array, order: int) -> Array:
    """Subtract the polynomial of degree `order` that fits best (least squares)."""
    place = np.linspace(-1.0, 1.0, samples.size)
    basis = np.polynomial.legendre.legvander(place, order)
    coefficients = np.linalg.lstsq(basis, samples, rcond=None)[0]
    return samples - basis @ coefficients


def without_drift(samples: Array, order: int) -> Array:
    """Subtract the slope of the polynomial that fits the velocity best (least squares)."""
    slopes = np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, samples.size), order - 1)
    # integrated like the motion, so that a polynomial drift is removed exactly; in units in which
    # half a time step is 1, which changes no coefficient
    columns = np.column_stack([slopes, samples])
    steps = columns[1:] + columns[:-1]
    path = np.concatenate([np.zeros((1, order + 1)), np.cumsum(steps, axis=0)])
    coefficients = np.linalg.lstsq(path[:, :-1], path[:, -1], rcond=None)[0]
    return samples - slopes @ coefficients


def tapered(samples: Array, intervals: float) -> Array:
    """Apply cosine tapers at both ends."""
    place = np.arange(samples.size)
    from_end = np.minimum(place, samples.size - 1 - place)
    share = np.minimum(from_end / intervals, 1.0)
    return samples * np.sin(0.5 * np.pi * share) ** 2


MIN_SAMPLES_PER_PERIOD: Final = 10
"""Samples per period below which linear interpolation lowers an ordinate by more than 3 %."""

_ROUNDING: Final = 1e-9


def warn_of_coarse_samples(
    signals: Iterable[Signal], shortest: float, *, owner: str, remedy: str | None = None
) -> None:
    """Warn of records that are sampled too coarsely for the shortest period."""
    steps = [signal.time_step for signal in signals if not signal.analytic]
    coarse = [
        step for step in steps if shortest < MIN_SAMPLES_PER_PERIOD * step * (1.0 - _ROUNDING)
    ]
    if not coarse:
        return
    which = f"{len(coarse)} of {len(steps)} records are" if len(steps) > 1 else "the record is"
    least, most = (f"{step:.4g} s" for step in (min(coarse), max(coarse)))
    spaced = most if least == most else f"{least} to {most}"
    helps = (
        remedy
        or f"resampled('{time_step_for_period(max(coarse), shortest):.4g} s') refines a record"
    )
    msg = (
        f"{owner}: {which} sampled every {spaced}, which is coarse for periods "
        f"from {shortest:.4g} s: straight lines between samples lower ordinates by 3 % at ten "
        f"samples per period and 13 % at five; {helps}"
    )
    warn(msg, RecordWarning)


def time_step_for_period(time_step: float, shortest: float) -> float:
    """Return a time step, divided into equal parts, that is short enough for a period [s]."""
    return time_step / math.ceil(MIN_SAMPLES_PER_PERIOD * time_step / shortest * (1.0 - _ROUNDING))
