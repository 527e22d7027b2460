"""Fourier transform of a ground motion."""

import math
from typing import Any, Final

import numpy as np

from rockframe.errors import ComponentError
from rockframe.signals.arrays import Array
from rockframe.signals.signal import MAXIMUM_SAMPLES, Signal

_TERMS: Final = 40


def transform_of(signal: Signal, resolution: float) -> tuple[Array, Any]:
    """Compute the Fourier transform, :eq:`eq-fourier`.

    Parameters
    ----------
    signal : Signal
        Acceleration of the ground.
    resolution : float
        Greatest distance between frequencies; 0 for one over the length [Hz].

    Returns
    -------
    frequency : ndarray, shape (k,)
        [Hz]
    transform : ndarray of complex, shape (k,)
        [m s^-1]

    Raises
    ------
    ComponentError
        A resolution that needs too many samples.
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
    """Integrate x^j exp(-i angle x) from 0 to 1, for j = 0, 1, ...; angle up to pi."""
    moments = np.zeros((angle.size, powers), dtype=complex)
    term = np.ones(angle.size, dtype=complex)
    for n in range(_TERMS):
        moments += term[:, None] / (n + 1 + np.arange(powers))
        term *= -1j * angle / (n + 1)
    return moments
