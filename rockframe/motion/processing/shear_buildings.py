"""Modes of shear buildings: storeys that deform by shear under floors that stay level."""

from __future__ import annotations

from typing import Any

import numpy as np

from rockframe.signals.arrays import Array


def uniform_modes(storeys: int, floor: int, period: float) -> tuple[Array, Array]:
    """Give the modes of equal storeys in closed form, :eq:`eq-uniform-building`."""
    angles = np.pi * np.arange(1.0, 2.0 * storeys, 2.0) / (2 * storeys + 1)
    periods = period * np.sin(0.5 * angles[0]) / np.sin(0.5 * angles)
    participations = 2.0 * np.sin(floor * angles) / ((2 * storeys + 1) * np.tan(0.5 * angles))
    return periods, participations


def building_modes(masses: Array, stiffnesses: Array, floor: int) -> tuple[Array, Array]:
    """Compute the modes of any storeys, :eq:`eq-shear-building`."""
    from scipy import linalg as module

    linalg: Any = module
    above = np.append(stiffnesses[1:], 0.0)
    stiffness = (
        np.diag(stiffnesses + above) - np.diag(above[:-1], 1) - np.diag(above[:-1], -1)
    )  # fmt: skip
    squares, shapes = linalg.eigh(stiffness, np.diag(masses))
    rounding = squares.size * np.finfo(np.float64).eps * squares.max()
    periods = 2.0 * np.pi / np.sqrt(np.where(squares > rounding, squares, np.nan))
    # shapes are of unit modal mass
    return periods, (masses @ shapes) * shapes[floor - 1]
