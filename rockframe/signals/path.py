"""Velocity and displacement of ground that starts from rest."""

from rockframe.signals.arrays import Array
from rockframe.signals.polynomials import integral_of
from rockframe.signals.signal import Signal


def ground_path(signal: Signal) -> tuple[Array, Array]:
    """Integrate the acceleration of ground that starts from rest.

    Parameters
    ----------
    signal : Signal
        The acceleration.

    Returns
    -------
    velocity : ndarray, shape (n, m + 1)
        Polynomials from sample to sample [m s^-1].
    displacement : ndarray, shape (n, m + 2)
        Polynomials from sample to sample [m].
    """
    velocity = integral_of(signal.pieces, signal.time_step)
    return velocity, integral_of(velocity, signal.time_step)
