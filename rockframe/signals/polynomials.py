"""Functions of time that are a polynomial in every interval.

A row of coefficients, lowest power first, is a polynomial in x, from 0 to 1 over
one time step.
"""

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from rockframe.signals.arrays import Array

_HALVINGS: Final = 54  # to the last bit of x


def values_at(pieces: Array, place: Array | float) -> Array:
    """Evaluate every row of coefficients, shape (..., m), each at its own place x [1]."""
    values = np.zeros(pieces.shape[:-1])
    for power in reversed(range(pieces.shape[-1])):
        values = values * place + pieces[..., power]
    return values


def slopes_of(pieces: Array) -> Array:
    """Differentiate by x."""
    return pieces[:, 1:] * np.arange(1.0, pieces.shape[1])


def integral_of(pieces: Array, time_step: float) -> Array:
    """Integrate rows over time, from zero on and continuous, :eq:`eq-ground-velocity`."""
    rising = pieces * (time_step / np.arange(1.0, pieces.shape[1] + 1.0))
    start = np.concatenate([[0.0], np.cumsum(rising.sum(axis=1))[:-1]])
    return np.column_stack([start, rising])


def divided(pieces: Array, parts: int) -> Array:
    """Divide every interval into equal parts, each with its own x."""
    if parts == 1:
        return pieces
    powers = range(pieces.shape[1])
    # Taylor's expansion of every power about the start of the part
    shifts = np.zeros((parts, len(powers), len(powers)))
    starts = np.arange(parts) / parts
    for j in powers:
        for k in range(j + 1):
            shifts[:, j, k] = math.comb(j, k) * starts ** (j - k) / float(parts) ** k
    return np.einsum("nj,pjk->npk", pieces, shifts).reshape(-1, len(powers))


def knots_of(pieces: Array) -> Array:
    """Give the values at both ends of all intervals."""
    return np.append(pieces[:, 0], pieces[-1].sum())


def roots_of(pieces: Array) -> Array:
    """Find the x at which every row crosses zero; its ends have different signs [1]."""
    low, high = np.zeros(len(pieces)), np.ones(len(pieces))
    if pieces.shape[1] == 2:
        return -pieces[:, 0] / pieces[:, 1]
    rising = pieces[:, 0] < 0.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        before = (values_at(pieces, middle) < 0.0) == rising
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return 0.5 * (low + high)


def turning_points(pieces: Array) -> tuple[NDArray[np.intp], Array]:
    """Find the extrema inside the intervals at whose ends the slopes differ in sign."""
    slopes = slopes_of(pieces)
    rows = np.flatnonzero(slopes[:, 0] * slopes.sum(axis=1) < 0.0)
    return rows, values_at(pieces[rows], roots_of(slopes[rows]))


def greatest(pieces: Array) -> float:
    """Find the greatest absolute value, between the knots too."""
    _, between = turning_points(pieces)
    ends = np.concatenate([pieces[:, 0], pieces.sum(axis=1), between])
    return float(np.max(np.abs(ends)))
