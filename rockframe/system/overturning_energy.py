"""The energy that it takes to overturn a body, :eq:`eq-overturning-energy`."""

from typing import TYPE_CHECKING, Final

import numpy as np

from rockframe.errors import SolverError

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
    moments = ((_restoring_moment(setting, at * rotation), of) for at, of in _PLACES)
    return rotation * sum(of * moment for moment, of in moments)


def least_overturning_energy(setting: "Setting") -> float:
    """Give the work against the restoring moment up to where that ends, on the weaker side [J].

    Parameters
    ----------
    setting : Setting
        The scene.

    Returns
    -------
    float
        0 where nothing holds the body upright.
    """
    left, right = setting.overturning_angles
    ends = [right, -left] if setting.leans else [right]
    return min(_work_against(setting, end) for end in ends)


def _work_against(setting: "Setting", end: float) -> float:
    moments = ((end * _restoring_moment(setting, at * end), of) for at, of in _PLACES)
    return sum(of * max(moment, 0.0) for moment, of in moments)


def _restoring_moment(setting: "Setting", rotation: float) -> float:
    """Give what holds a body back at a rotation: nothing where its base gives way altogether."""
    try:
        return setting.statics(rotation).restoring_moment
    except SolverError:
        return 0.0
