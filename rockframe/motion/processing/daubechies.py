"""The Daubechies wavelet of order four."""

from __future__ import annotations

import math
from functools import cache
from typing import Final

import numpy as np

from rockframe.signals.arrays import Array

SUPPORT: Final = 7
"""Length of the wavelet, outside of which it is zero [1]."""

CENTRE_FREQUENCY: Final = 5.0 / 7.0
"""Cycles over unit length where the Fourier amplitude is greatest, in steps of one cycle over
the support: the pseudo-period is the scale over it, :eq:`eq-pseudo-period` [1]."""

_MOMENTS: Final = 4
_LEVELS: Final = 12


def mother_wavelet(place: Array) -> Array:
    """Evaluate the wavelet, :eq:`eq-two-scale`."""
    knots, values = _table()
    return np.interp(place, knots, values, left=0.0, right=0.0)


@cache
def scaling_filter() -> Array:
    """Compute the filter of the two-scale equation, :eq:`eq-daubechies-filter`, shape (8,)."""
    # |m(y)|^2 = (1 - y)^4 P(y) with y = sin^2(w/2), P(y) = sum of binomials times y^k
    binomials = [math.comb(_MOMENTS - 1 + k, k) for k in range(_MOMENTS)]
    taps = np.array([1.0])
    for root in np.roots(binomials[::-1]):
        # 2 - z - 1/z = 4 y: of the two zeros z the one within the circle
        pair = np.roots([1.0, 4.0 * root - 2.0, 1.0])
        taps = np.convolve(taps, [1.0, -pair[np.argmin(np.abs(pair))]])
    for _ in range(_MOMENTS):
        taps = np.convolve(taps, [1.0, 1.0])
    real: Array = np.real(taps)
    return real * (math.sqrt(2.0) / real.sum())


@cache
def _table() -> tuple[Array, Array]:
    """Give the wavelet at dyadic points, exactly: at whole numbers, at their halves, and on."""
    taps = math.sqrt(2.0) * scaling_filter()
    size = taps.size
    # at whole numbers the values are an eigenvector of the two-scale equation
    inner = np.arange(1, size - 1)
    index = 2 * inner[:, None] - inner[None, :]
    matrix = np.where((index >= 0) & (index < size), taps[np.clip(index, 0, size - 1)], 0.0)
    eigenvalues, vectors = np.linalg.eig(matrix)
    vector = np.real(vectors[:, np.argmin(np.abs(eigenvalues - 1.0))])
    scaling = np.concatenate([[0.0], vector / vector.sum(), [0.0]])
    for level in range(_LEVELS):
        scaling = _refined(scaling, taps, level)
    details = taps[::-1] * (-1.0) ** np.arange(size)
    # psi(x) = sum of g_k phi(2 x - k): phi on every second point, shifted by k
    wavelet = np.zeros_like(scaling)
    half = 2**_LEVELS
    places = 2 * np.arange(scaling.size)
    for k, detail in enumerate(details.tolist()):
        index = places - k * half
        inside = (index >= 0) & (index < scaling.size)
        wavelet[inside] += detail * scaling[index[inside]]
    return np.arange(scaling.size) / half, wavelet


def _refined(values: Array, taps: Array, level: int) -> Array:
    """Halve the distance of points: phi(x) = sum of h_k phi(2 x - k)."""
    spacing = 2**level
    count = (values.size - 1) * 2 + 1
    fine = np.zeros(count)
    fine[::2] = values
    places = np.arange(1, count, 2)  # place over twice the spacing is x
    for k, tap in enumerate(taps.tolist()):
        index = places - k * spacing
        inside = (index >= 0) & (index < values.size)
        fine[places[inside]] += tap * values[index[inside]]
    return fine
