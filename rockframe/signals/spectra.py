"""Response spectra: peaks of linear oscillators, for one component or in all directions (SI)."""

from typing import Final

import numpy as np

from rockframe.compiled import COMPILED
from rockframe.errors import ComponentError
from rockframe.signals.arrays import Array
from rockframe.signals.motion import Signal, absolute_peak
from rockframe.signals.oscillator import QUANTITIES, STEPS_PER_PERIOD, march_all, march_pairs
from rockframe.units import Condition

DAMPING_RATIO: Final = Condition("from 0 to 1", lambda value: 0.0 <= value <= 1.0)
"""Range of the damping ratio of an oscillator."""

MAXIMUM_STEPS: Final = 2_000_000_000
"""Steps of all oscillators together beyond which a spectrum is refused."""

MAXIMUM_PARTS: Final = 1_000_000
"""Steps in one interval of the motion beyond which a period is refused."""


def check_cost(signal: Signal, periods: Array, *, owner: str) -> None:
    """Refuse a spectrum that would take minutes."""
    moving = periods[periods > 0.0]
    if moving.size == 0:
        return
    count = len(signal.pieces)
    parts = np.ceil(STEPS_PER_PERIOD * signal.time_step / moving)
    if parts.max() > MAXIMUM_PARTS or parts.sum() * count > MAXIMUM_STEPS:
        msg = (
            f"{owner}: {moving.size} periods from {moving.min():.4g} s on need "
            f"{parts.sum() * count:.2g} steps on a motion of {count} intervals of "
            f"{signal.time_step:.4g} s; give fewer or longer periods, or a shorter motion"
        )
        raise ComponentError(msg)


def spectral_peaks(signal: Signal, periods: Array, damping_ratio: float) -> Array:
    """Find the peaks of oscillators of one damping ratio.

    Parameters
    ----------
    signal : Signal
        Acceleration of the ground.
    periods : ndarray, shape (k,)
        Periods, zero or more [s].
    damping_ratio : float
        Damping ratio [1].

    Returns
    -------
    ndarray, shape (k, 3)
        Greatest relative displacement [m], relative velocity [m s^-1] and absolute
        acceleration [m s^-2].
    """
    peaks = np.zeros((periods.size, 3))
    peaks[:, 2] = absolute_peak(signal.pieces)  # a rigid oscillator moves with the ground
    moving = np.flatnonzero(periods > 0.0)
    if COMPILED:
        peaks[moving] = _march(signal, periods[moving], damping_ratio)
    else:
        from rockframe.signals.filtering import filter_all

        peaks[moving] = filter_all(signal.pieces, signal.time_step, damping_ratio, periods[moving])
    return peaks


def pseudo_spectra(
    signal: Signal, periods: Array, spectral_displacement: Array
) -> tuple[Array, Array]:
    """Return pseudo-velocity [m s^-1] and pseudo-acceleration [m s^-2], :eq:`eq-pseudo-spectra`."""
    rigid = periods == 0.0
    frequency = 2.0 * np.pi / np.where(rigid, 1.0, periods)
    velocity = np.where(rigid, 0.0, frequency * spectral_displacement)
    acceleration = np.where(rigid, absolute_peak(signal.pieces), frequency * velocity)
    return velocity, acceleration


def _march(signal: Signal, periods: Array, damping_ratio: float) -> Array:
    pieces = np.ascontiguousarray(signal.pieces)
    powers = pieces.shape[1]
    peaks = np.empty((periods.size, QUANTITIES))
    march_all(
        pieces,
        np.zeros((STEPS_PER_PERIOD, powers)),
        signal.time_step,
        float(damping_ratio),
        periods,
        np.empty((2, 2 + powers)),
        np.empty((2, 2 + powers)),
        np.empty(powers),
        np.empty(2),
        np.empty(QUANTITIES),
        peaks,
    )
    return peaks


_BOTH_COMPONENTS: Final = 6
"""Number of displacements, velocities and accelerations under both components."""
_SAMPLE_DIRECTIONS: Final = 16
"""Number of directions in which the peaks are first bounded from below."""


def unit_vectors(count: int) -> Array:
    """Return directions evenly spaced over half a circle, from the first component on."""
    angles = np.pi * np.arange(count) / count
    vectors = np.column_stack([np.cos(angles), np.sin(angles)])
    vectors[count // 2] = 0.0, 1.0
    return vectors


def rotated_displacements(
    first: Signal, second: Signal, periods: Array, damping_ratio: float, directions: Array
) -> Array:
    """Find the greatest displacement of oscillators in each direction: shape (k, d) [m].

    `directions` are cosines and sines, shape (d, 2); both signals have one time step and length.
    """
    first_pieces, second_pieces = (
        np.ascontiguousarray(pieces) for pieces in _same_degree(first, second)
    )
    powers = first_pieces.shape[1]
    if not COMPILED:
        from rockframe.signals.filtering import filter_pairs

        return filter_pairs(
            (first_pieces, second_pieces), first.time_step, damping_ratio, periods, directions
        )
    displacements = np.empty((periods.size, len(directions)))
    march_pairs(
        first_pieces,
        second_pieces,
        np.zeros((STEPS_PER_PERIOD, powers)),
        first.time_step,
        float(damping_ratio),
        np.ascontiguousarray(periods),
        np.ascontiguousarray(directions),
        np.empty((2, 2 + powers)),
        np.empty((2, 2 + powers)),
        np.empty(powers),
        np.empty(_BOTH_COMPONENTS),
        np.empty(_BOTH_COMPONENTS),
        unit_vectors(_SAMPLE_DIRECTIONS),
        np.empty((_SAMPLE_DIRECTIONS, 3)),
        np.empty(len(directions)),
        displacements,
    )
    return displacements


def rotated_peaks(first: Signal, second: Signal, directions: Array) -> Array:
    """Find the greatest acceleration of the ground in each direction: shape (d,) [m s^-2]."""
    first_pieces, second_pieces = _same_degree(first, second)
    return np.array(
        [absolute_peak(cosine * first_pieces + sine * second_pieces) for cosine, sine in directions]
    )


def _same_degree(first: Signal, second: Signal) -> tuple[Array, Array]:
    pieces = first.pieces, second.pieces
    powers = max(each.shape[1] for each in pieces)
    padded = [np.pad(each, ((0, 0), (0, powers - each.shape[1]))) for each in pieces]
    return padded[0], padded[1]
