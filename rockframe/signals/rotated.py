"""Peaks of linear oscillators in all horizontal directions, in SI units."""

from typing import Final

import numpy as np

from rockframe.compiled import COMPILED
from rockframe.signals.arrays import Array
from rockframe.signals.oscillator import STEPS_PER_PERIOD
from rockframe.signals.polynomials import greatest
from rockframe.signals.rotated_oscillator import march_pairs
from rockframe.signals.signal import Signal

_BOTH: Final = 6
"""Displacement, velocity and acceleration of both components."""
_FEW: Final = 16
"""Directions in which bounds are looked for first."""


def unit_vectors(count: int) -> Array:
    """Give directions evenly spaced over half a circle, from the first component on."""
    angles = np.pi * np.arange(count) / count
    vectors = np.column_stack([np.cos(angles), np.sin(angles)])
    vectors[count // 2] = 0.0, 1.0
    return vectors


def rotated_displacements(
    first: Signal, second: Signal, periods: Array, damping_ratio: float, directions: Array
) -> Array:
    """Find the greatest displacement of oscillators in every direction.

    Parameters
    ----------
    first, second : Signal
        Accelerations of the ground at a right angle, of the same time step and length.
    periods : ndarray, shape (k,)
        Periods, greater than zero [s].
    damping_ratio : float
        Damping ratio [1].
    directions : ndarray, shape (d, 2)
        Cosines and sines.

    Returns
    -------
    ndarray, shape (k, d)
        Greatest relative displacement [m].
    """
    one, other = (np.ascontiguousarray(pieces) for pieces in _of_one_degree(first, second))
    powers = one.shape[1]
    if not COMPILED:
        from rockframe.signals.filtering import filter_pairs

        return filter_pairs((one, other), first.time_step, damping_ratio, periods, directions)
    found = np.empty((periods.size, len(directions)))
    march_pairs(
        one,
        other,
        np.zeros((STEPS_PER_PERIOD, powers)),
        first.time_step,
        float(damping_ratio),
        np.ascontiguousarray(periods),
        np.ascontiguousarray(directions),
        np.empty((2, 2 + powers)),
        np.empty((2, 2 + powers)),
        np.empty(powers),
        np.empty(_BOTH),
        np.empty(_BOTH),
        unit_vectors(_FEW),
        np.empty((_FEW, 3)),
        np.empty(len(directions)),
        found,
    )
    return found


def rotated_peaks(first: Signal, second: Signal, directions: Array) -> Array:
    """Find the greatest acceleration of the ground in every direction.

    Parameters
    ----------
    first, second : Signal
        Accelerations of the ground at a right angle, of the same time step and length.
    directions : ndarray, shape (d, 2)
        Cosines and sines.

    Returns
    -------
    ndarray, shape (d,)
        [m s^-2]
    """
    one, other = _of_one_degree(first, second)
    return np.array([greatest(along * one + across * other) for along, across in directions])


def _of_one_degree(first: Signal, second: Signal) -> tuple[Array, Array]:
    pieces = first.pieces, second.pieces
    powers = max(one.shape[1] for one in pieces)
    one, other = (np.pad(given, ((0, 0), (0, powers - given.shape[1]))) for given in pieces)
    return one, other
