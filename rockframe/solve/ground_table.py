"""The ground motion as the integrator takes it."""

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from rockframe.compiled import Matrix, Vector
from rockframe.solve.ground import TERMS

STILL_INTERVAL: Final = 0.01
"""Interval into which time is cut where the ground has no samples [s]."""


def _no_samples() -> Vector:
    return np.zeros(0)


def _no_pieces() -> Matrix:
    return np.zeros((0, TERMS))


@dataclass(frozen=True)
class Ground:
    """Samples, and polynomials in between where the motion has them.

    Parameters
    ----------
    time_step : float
        Spacing of the samples [s].
    horizontal, vertical : ndarray, shape (samples,) or (0,)
        Accelerations [m s^-2].
    horizontal_pieces, vertical_pieces : ndarray, shape (samples - 1, 6) or (0, 6)
        Coefficients, in ascending order, of polynomials in the share of the
        interval that has passed; linear where there are none.
    """

    time_step: float = 1.0
    horizontal: Vector = field(default_factory=_no_samples)
    vertical: Vector = field(default_factory=_no_samples)
    horizontal_pieces: Matrix = field(default_factory=_no_pieces)
    vertical_pieces: Matrix = field(default_factory=_no_pieces)

    def __post_init__(self) -> None:
        # views that cannot be written through: the integrator takes no others
        for name in ("horizontal", "vertical", "horizontal_pieces", "vertical_pieces"):
            view = np.ascontiguousarray(getattr(self, name), dtype=np.float64).view()
            view.flags.writeable = False
            object.__setattr__(self, name, view)

    @property
    def interval(self) -> float:
        """Spacing of the samples, or what stands for it where there are none [s]."""
        moves = len(self.horizontal) > 0 or len(self.vertical) > 0
        return self.time_step if moves else STILL_INTERVAL


def ground_at(ground: Ground, time: Vector) -> Matrix:
    """Give the ground acceleration at some times; at a sample, the sample itself.

    Parameters
    ----------
    ground : Ground
        The motion.
    time : ndarray, shape (times,)
        [s].

    Returns
    -------
    ndarray, shape (times, 2)
        Horizontal and vertical [m s^-2].
    """
    place = time / ground.time_step
    nearest = np.rint(place)
    place = np.where(np.abs(place - nearest) <= 1e-9 * np.maximum(nearest, 1.0), nearest, place)
    out = np.zeros((len(time), 2))
    directions = (
        (ground.horizontal, ground.horizontal_pieces),
        (ground.vertical, ground.vertical_pieces),
    )
    for column, (samples, pieces) in enumerate(directions):
        if len(samples) == 0:
            continue
        index = np.minimum(place.astype(np.int64), max(len(samples) - 2, 0))
        share = place - index
        if len(pieces):
            values = np.polynomial.polynomial.polyval(share, pieces[index].T, tensor=False)
        else:
            following = samples[np.minimum(index + 1, len(samples) - 1)]
            values = samples[index] + share * (following - samples[index])
        values = np.where(share == 0.0, samples[index], values)
        values = np.where(share == 1.0, samples[np.minimum(index + 1, len(samples) - 1)], values)
        out[:, column] = np.where(share <= 1.0, values, 0.0)
    return out
