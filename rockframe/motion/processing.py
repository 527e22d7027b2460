"""Processing of sampled motions: plain functions on SI arrays."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from rockframe.motion.samples import Array, value_at

_INTEGER_RATIO: Final = 1e-9
_PADDING_PERIODS: Final = 1.5
_ANTI_ALIAS_ORDER: Final = 8
_ANTI_ALIAS_RIPPLE: Final = 0.05
_ANTI_ALIAS_EDGE: Final = 0.8


def sample_count(duration: float, time_step: float) -> int:
    """Count the samples of step `time_step` that fit into `duration`, both ends included."""
    return math.floor(duration / time_step * (1.0 + 1e-12) + _INTEGER_RATIO) + 1


def refined(dt: float, samples: Array, pieces: Array | None, time_step: float) -> Array:
    """Sample the same function of time more finely.

    Parameters
    ----------
    dt : float
        Present time step [s].
    samples : ndarray, shape (n,)
        Present samples [m s^-2].
    pieces : ndarray, shape (n - 1, 6), optional
        Polynomials between them.
    time_step : float
        New, smaller time step [s].

    Returns
    -------
    ndarray
        The old samples are among the new ones if the ratio is an integer.
    """
    ratio = dt / time_step
    times = round(ratio)
    if pieces is None and abs(ratio - times) <= _INTEGER_RATIO * ratio:
        share = np.arange(times) / times
        between = samples[:-1, None] * (1.0 - share) + samples[1:, None] * share
        return np.append(between.reshape(-1), samples[-1])
    duration = (samples.size - 1) * dt
    instants = np.minimum(np.arange(sample_count(duration, time_step)) * time_step, duration)
    return value_at(dt, samples, pieces, instants)


def coarsened(dt: float, samples: Array, time_step: float) -> Array:
    """Sample more coarsely, after a zero-phase low-pass filter against aliasing.

    Parameters
    ----------
    dt : float
        Present time step [s].
    samples : ndarray, shape (n,)
        Present samples [m s^-2].
    time_step : float
        New, greater time step [s].

    Returns
    -------
    ndarray

    Notes
    -----
    Chebyshev filter of order 8 and 0.05 dB ripple up to 0.8 of the new Nyquist
    frequency, run forwards and backwards; a ratio that is not an integer is
    then read off a cubic spline.
    """
    from scipy import signal as module

    signal: Any = module
    edge = _ANTI_ALIAS_EDGE * dt / time_step
    sos = signal.cheby1(_ANTI_ALIAS_ORDER, _ANTI_ALIAS_RIPPLE, edge, output="sos")
    padding = min(samples.size - 1, math.ceil(10.0 * time_step / dt) + 27)
    smooth: Array = signal.sosfiltfilt(sos, samples, padtype="odd", padlen=padding)
    ratio = time_step / dt
    times = round(ratio)
    if abs(ratio - times) <= _INTEGER_RATIO * ratio:
        return smooth[::times]
    from scipy import interpolate as splines

    spline: Any = splines
    duration = (samples.size - 1) * dt
    instants = np.arange(sample_count(duration, time_step)) * time_step
    degree = min(3, samples.size - 1)
    return spline.make_interp_spline(np.arange(samples.size) * dt, smooth, k=degree)(instants)


def filtered(
    dt: float, samples: Array, *, low: float | None, high: float | None, order: int
) -> Array:
    """Run a Butterworth filter forwards and backwards over the zero-padded samples.

    Parameters
    ----------
    dt : float
        Time step [s].
    samples : ndarray, shape (n,)
        Samples [m s^-2].
    low, high : float or None
        Corners of the pass band; at least one [Hz].
    order : int
        Of each of the two passes.

    Returns
    -------
    ndarray, shape (n,)
        Padding removed.
    """
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
    lowest = min(corner for corner in (low, high) if corner is not None)
    padding = padding_samples(dt, lowest, order)
    rest = np.zeros(padding)
    padded = np.concatenate([rest, samples, rest])
    result: Array = signal.sosfiltfilt(sos, padded, padtype=None)
    return result[padding : padding + samples.size]


def padding_samples(dt: float, lowest: float, order: int) -> int:
    """Count the zeros to put at each end: 1.5 order/f of the lowest corner."""
    return math.ceil(_PADDING_PERIODS * order / (lowest * dt))


def without_baseline(samples: Array, order: int) -> Array:
    """Subtract the polynomial of degree `order` that fits best (least squares).

    Parameters
    ----------
    samples : ndarray, shape (n,)
        Samples [m s^-2].
    order : int
        Degree; 0 takes the mean away.

    Returns
    -------
    ndarray, shape (n,)
    """
    place = np.linspace(-1.0, 1.0, samples.size)
    basis = np.polynomial.legendre.legvander(place, order)
    coefficients = np.linalg.lstsq(basis, samples, rcond=None)[0]
    return samples - basis @ coefficients


def padded(samples: Array, pieces: Array | None, count: int) -> tuple[Array, Array | None]:
    """Append zeros (a still ground) up to `count` samples.

    Parameters
    ----------
    samples : ndarray, shape (n,)
        Samples [m s^-2].
    pieces : ndarray, shape (n - 1, 6), optional
        Polynomials between them.
    count : int
        Length wanted, at least n.

    Returns
    -------
    tuple of ndarray
        Samples and pieces.
    """
    missing = count - samples.size
    longer = np.concatenate([samples, np.zeros(missing)])
    if pieces is None or missing == 0:
        return longer, pieces
    rest = np.zeros((missing, pieces.shape[1]))
    rest[0, :2] = samples[-1], -samples[-1]
    return longer, np.concatenate([pieces, rest])
