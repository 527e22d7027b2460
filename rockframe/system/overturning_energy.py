"""The energy that it takes to overturn a body, :eq:`eq-overturning-energy`."""

from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from rockframe.system.setting import Setting

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_PLACES: Final[list[tuple[float, float]]] = [
    (0.5 + 0.5 * float(point), 0.5 * float(weight))
    for point, weight in zip(_POINTS, _WEIGHTS, strict=True)
]
"""Gauss-Legendre rule on (0, 1)."""


def stored_energy(setting: "Setting", rotation: float) -> float:
    """Give the work that slowly brings a body from upright to a rotation [J].

    Parameters
    ----------
    setting : Setting
        The scene.
    rotation : float
        [rad].

    Returns
    -------
    float
    """
    return rotation * sum(of * moment for of, moment in _moments(setting, rotation))


def least_overturning_energy(setting: "Setting") -> float:
    """Give the work against the restoring moment up to where that ends, on the weaker side [J]."""
    return min(_work_against(setting, end) for end in setting.overturning_rotations)


def _work_against(setting: "Setting", end: float) -> float:
    return sum(of * max(end * moment, 0.0) for of, moment in _moments(setting, end))


def _moments(setting: "Setting", end: float) -> list[tuple[float, float]]:
    """Give weights and what holds a body back: nothing where its base gives way altogether."""
    states = setting.curve([at * end for at, _ in _PLACES])
    moments = (0.0 if state is None else state.restoring_moment for state in states)
    return [(of, moment) for (_, of), moment in zip(_PLACES, moments, strict=True)]
