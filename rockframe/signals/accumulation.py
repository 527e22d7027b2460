"""What accumulates in the course of a ground motion: Arias intensity and absolute velocity."""

import math

import numpy as np

from rockframe.signals.arrays import Array
from rockframe.signals.polynomials import integral_of, knots_of, turning_points
from rockframe.signals.signal import Signal


def arias_history(signal: Signal, gravity: float) -> Array:
    """Compute the Arias intensity up to every sample, :eq:`eq-arias`.

    Parameters
    ----------
    signal : Signal
        Acceleration of the ground.
    gravity : float
        [m s^-2]

    Returns
    -------
    ndarray, shape (n,)
        Starts at zero [m s^-1].
    """
    if signal.analytic:
        exponents = np.arange(signal.pieces.shape[1])
        weights = 1.0 / (exponents[:, None] + exponents + 1.0)  # integral of x^j x^k
        square = ((signal.pieces @ weights) * signal.pieces).sum(axis=1)
    else:
        square = _trapezoids(signal.samples**2)
    return _summed(square) * (signal.time_step * 0.5 * math.pi / gravity)


def absolute_velocity_history(signal: Signal) -> Array:
    """Compute the cumulative absolute velocity up to every sample, :eq:`eq-cav`.

    Parameters
    ----------
    signal : Signal
        Acceleration of the ground.

    Returns
    -------
    ndarray, shape (n,)
        Starts at zero [m s^-1].
    """
    if not signal.analytic:
        return _summed(_trapezoids(np.abs(signal.samples))) * signal.time_step
    # the way that the velocity goes up and down, turning included
    velocity = integral_of(signal.pieces, signal.time_step)
    knots = knots_of(velocity)
    ways = np.abs(np.diff(knots))
    rows, turned = turning_points(velocity)
    ways[rows] = np.abs(turned - knots[rows]) + np.abs(turned - knots[rows + 1])
    return _summed(ways)


def standardized_absolute_velocity(signal: Signal, threshold: float) -> float:
    """Sum the absolute velocity of the seconds whose peak reaches a threshold, :eq:`eq-cav`.

    Parameters
    ----------
    signal : Signal
        Acceleration of the ground.
    threshold : float
        [m s^-2]

    Returns
    -------
    float
        [m s^-1]
    """
    times = signal.times
    seconds = np.arange(0.0, math.ceil(times[-1]) + 1.0)
    at_seconds = np.interp(seconds, times, absolute_velocity_history(signal))
    size = np.abs(signal.samples)
    # a sample at a full second belongs to the seconds on both its sides
    rounding = 1e-9 * signal.time_step
    first = np.searchsorted(times, seconds[:-1] - rounding, side="left")
    last = np.searchsorted(times, seconds[1:] + rounding, side="right")
    strong = [
        bool(np.any(size[start:end] >= threshold))
        for start, end in zip(first.tolist(), last.tolist(), strict=True)
    ]
    return float(np.sum(np.diff(at_seconds)[strong]))


def _trapezoids(values: Array) -> Array:
    return 0.5 * (values[:-1] + values[1:])


def _summed(steps: Array) -> Array:
    return np.concatenate([[0.0], np.cumsum(steps)])
