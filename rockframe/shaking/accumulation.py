"""What accumulates while the ground shakes: Arias intensity and absolute velocity."""

import math

import numpy as np

from rockframe.shaking.polynomials import integral_of, knots_of, turning_points
from rockframe.shaking.shaking import Array, Shaking


def arias_history(shaking: Shaking, gravity: float) -> Array:
    """Compute the Arias intensity up to every sample, :eq:`eq-arias`.

    Parameters
    ----------
    shaking : Shaking
        Acceleration of the ground.
    gravity : float
        [m s^-2]

    Returns
    -------
    ndarray, shape (n,)
        Starts at zero [m s^-1].
    """
    if shaking.analytic:
        exponents = np.arange(shaking.pieces.shape[1])
        weights = 1.0 / (exponents[:, None] + exponents + 1.0)  # integral of x^j x^k
        square = ((shaking.pieces @ weights) * shaking.pieces).sum(axis=1)
    else:
        square = _trapezoids(shaking.samples**2)
    return _summed(square) * (shaking.time_step * 0.5 * math.pi / gravity)


def absolute_velocity_history(shaking: Shaking) -> Array:
    """Compute the cumulative absolute velocity up to every sample, :eq:`eq-cav`.

    Parameters
    ----------
    shaking : Shaking
        Acceleration of the ground.

    Returns
    -------
    ndarray, shape (n,)
        Starts at zero [m s^-1].
    """
    if not shaking.analytic:
        return _summed(_trapezoids(np.abs(shaking.samples))) * shaking.time_step
    # the way that the velocity goes up and down, turning included
    velocity = integral_of(shaking.pieces, shaking.time_step)
    knots = knots_of(velocity)
    ways = np.abs(np.diff(knots))
    rows, turned = turning_points(velocity)
    ways[rows] = np.abs(turned - knots[rows]) + np.abs(turned - knots[rows + 1])
    return _summed(ways)


def standardized_absolute_velocity(shaking: Shaking, threshold: float) -> float:
    """Sum the absolute velocity of the seconds whose peak reaches a threshold, :eq:`eq-cav`.

    Parameters
    ----------
    shaking : Shaking
        Acceleration of the ground.
    threshold : float
        [m s^-2]

    Returns
    -------
    float
        [m s^-1]
    """
    times = shaking.times
    seconds = np.arange(0.0, math.ceil(times[-1]) + 1.0)
    at_seconds = np.interp(seconds, times, absolute_velocity_history(shaking))
    size = np.abs(shaking.samples)
    # a sample at a full second belongs to the seconds on both its sides
    rounding = 1e-9 * shaking.time_step
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
