"""Velocity and displacement of ground that starts from rest."""

from rockframe.shaking.polynomials import integral_of
from rockframe.shaking.shaking import Array, Shaking


def ground_path(shaking: Shaking) -> tuple[Array, Array]:
    """Integrate the acceleration of ground that starts from rest.

    Parameters
    ----------
    shaking : Shaking
        The acceleration.

    Returns
    -------
    velocity : ndarray, shape (n, m + 1)
        Polynomials from sample to sample [m s^-1].
    displacement : ndarray, shape (n, m + 2)
        Polynomials from sample to sample [m].
    """
    velocity = integral_of(shaking.pieces, shaking.time_step)
    return velocity, integral_of(velocity, shaking.time_step)
