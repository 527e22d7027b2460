"""Baselines: polynomials that fit a motion, to be taken away from it."""

from __future__ import annotations

import numpy as np

from rockframe.signals.arrays import Array


def without_baseline(samples: Array, order: int) -> Array:
    """Subtract the polynomial of degree `order` that fits best (least squares)."""
    place = np.linspace(-1.0, 1.0, samples.size)
    basis = np.polynomial.legendre.legvander(place, order)
    coefficients = np.linalg.lstsq(basis, samples, rcond=None)[0]
    return samples - basis @ coefficients


def without_drift(dt: float, samples: Array, order: int) -> Array:
    """Subtract the slope of the polynomial that fits the velocity best (least squares)."""
    slopes = np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, samples.size), order - 1)
    # integrated like the motion, so that a drift that is a polynomial goes entirely
    together = np.column_stack([slopes, samples])
    steps = 0.5 * dt * (together[1:] + together[:-1])
    path = np.concatenate([np.zeros((1, order + 1)), np.cumsum(steps, axis=0)])
    shares = np.linalg.lstsq(path[:, :-1], path[:, -1], rcond=None)[0]
    return samples - slopes @ shares
