"""Other time steps and lengths for the same motion."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, Final

import numpy as np

from rockframe.signals import polynomials
from rockframe.signals.arrays import Array
from rockframe.signals.signal import Signal

_INTEGER_RATIO: Final = 1e-9
_ANTI_ALIAS_ORDER: Final = 9  # of even order it would take 0.1 dB from the slowest motion
_ANTI_ALIAS_RIPPLE: Final = 0.05
_ANTI_ALIAS_EDGE: Final = 0.8
_SINC_REACH: Final = 64
_SINC_WINDOW: Final = 12.0
_OVERSAMPLING: Final = 8


def sample_count(duration: float, time_step: float) -> int:
    """Count the samples of step `time_step` that fit into `duration`, both ends included."""
    return math.floor(duration / time_step * (1.0 + 1e-12) + _INTEGER_RATIO) + 1


def whole_ratio(ratio: float) -> int | None:
    """Give the whole number that a ratio of time steps is, or None."""
    times = round(ratio)
    return times if abs(ratio - times) <= _INTEGER_RATIO * ratio else None


def instants_of(duration: float, time_step: float) -> Array:
    """Give the times of the samples of step `time_step` within `duration` [s]."""
    return np.minimum(np.arange(sample_count(duration, time_step)) * time_step, duration)


def refined(signal: Signal, time_step: float) -> Array:
    """Sample the same function of time more finely."""
    place = instants_of(signal.duration, time_step) / signal.time_step
    if signal.analytic:
        return signal.at_place(place)
    samples = signal.samples
    times = whole_ratio(signal.time_step / time_step)
    if times is not None:
        share = np.arange(times) / times
        between = samples[:-1, None] * (1.0 - share) + samples[1:, None] * share
        return np.append(between.reshape(-1), samples[-1])
    interval = np.minimum(place.astype(np.intp), samples.size - 2)
    share = place - interval
    return samples[interval] * (1.0 - share) + samples[interval + 1] * share


def band_limited(dt: float, samples: Array, time_step: float) -> Array:
    """Sample more finely the motion without frequencies beyond the old Nyquist frequency.

    A sinc of 64 old samples to each side under a Kaiser window, whose zeros fall on the old
    samples. Beyond its ends the motion is taken to go on along the straight line
    through its first and last sample, from which it differs by nothing there. A ratio that
    is no integer is read off a quintic spline through samples at least eight times finer.
    """
    from scipy import signal as module

    signal: Any = module
    ratio = dt / time_step
    whole = whole_ratio(ratio)
    times = math.ceil(_OVERSAMPLING * ratio) if whole is None else whole
    sinc = np.sinc(np.arange(-_SINC_REACH * times, _SINC_REACH * times + 1) / times)
    taps = sinc * signal.windows.kaiser(sinc.size, _SINC_WINDOW)
    # without division by the sum, so that the old samples stay as they are
    fine: Array = signal.resample_poly(samples, times, 1, window=taps / times, padtype="line")
    fine = fine[: (samples.size - 1) * times + 1]
    if whole is not None:
        fine[::times] = samples
        return fine
    from scipy import interpolate as splines

    spline: Any = splines
    instants = instants_of((samples.size - 1) * dt, time_step)
    return spline.make_interp_spline(np.arange(fine.size) * (dt / times), fine, k=5)(instants)


def coarsened(dt: float, samples: Array, time_step: float) -> Array:
    """Sample more coarsely, after a zero-phase low-pass filter against aliasing.

    Chebyshev filter of order 9 and 0.05 dB ripple up to 0.8 of the new Nyquist
    frequency, run forwards and backwards; a ratio that is not an integer is
    then read off a cubic spline.
    """
    from scipy import signal as module

    signal: Any = module
    edge = _ANTI_ALIAS_EDGE * dt / time_step
    sos = signal.cheby1(_ANTI_ALIAS_ORDER, _ANTI_ALIAS_RIPPLE, edge, output="sos")
    padding = min(samples.size - 1, math.ceil(10.0 * time_step / dt) + 27)
    smooth: Array = signal.sosfiltfilt(sos, samples, padtype="odd", padlen=padding)
    times = whole_ratio(time_step / dt)
    if times is not None:
        return smooth[::times]
    from scipy import interpolate as splines

    spline: Any = splines
    instants = instants_of((samples.size - 1) * dt, time_step)
    degree = min(3, samples.size - 1)
    return spline.make_interp_spline(np.arange(samples.size) * dt, smooth, k=degree)(instants)


def padded(signal: Signal, count: int) -> Signal:
    """Append zeros (a still ground) up to `count` samples."""
    missing = count - signal.samples.size
    if missing == 0:
        return signal
    pieces = signal.polynomials
    if pieces is not None:
        pieces = np.concatenate([pieces, np.zeros((missing, pieces.shape[1]))])
    samples = np.concatenate([signal.samples, np.zeros(missing)])
    return replace(signal, samples=samples, polynomials=pieces)


def divided_signal(signal: Signal, parts: int) -> Signal:
    """Divide every interval into equal parts."""
    if parts == 1:
        return signal
    step = signal.time_step / parts
    if signal.polynomials is None:
        return replace(signal, time_step=step, samples=refined(signal, step))
    pieces = polynomials.divided(signal.polynomials, parts)
    samples = np.append(pieces[:, 0], signal.samples[-1])
    samples[::parts] = signal.samples
    return replace(signal, time_step=step, samples=samples, polynomials=pieces)
