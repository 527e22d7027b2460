"""One component of a ground motion as polynomials from sample to sample."""

from dataclasses import dataclass
from typing import Final, Self, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]

MAXIMUM_SAMPLES: Final = 50_000_000
"""A motion that would be longer than this is taken for a slip of the pen."""


@dataclass(frozen=True, eq=False)
class Shaking:
    """One component of a motion in SI units.

    In interval k the acceleration is ``sum_j pieces[k, j] x^j``, x from 0 to 1
    over the time step.

    Parameters
    ----------
    time_step : float
        Between samples [s].
    samples : ndarray, shape (n,)
        Acceleration at the samples [m s^-2].
    pieces : ndarray, shape (n - 1, 2) or (n - 1, 6)
        Coefficients, lowest power first [m s^-2].
    analytic : bool
        Whether the pieces are those of an analytic motion; else straight lines
        between the samples of a record.
    """

    time_step: float
    samples: Array
    pieces: Array
    analytic: bool

    @property
    def times(self) -> Array:
        """Times of the samples [s]."""
        return np.arange(float(self.samples.size)) * self.time_step

    @classmethod
    def of(cls, time_step: float, samples: Array, pieces: Array | None) -> Self:
        """Join samples by the polynomials between them, or by straight lines.

        Parameters
        ----------
        time_step : float
            Between samples [s].
        samples : ndarray, shape (n,)
            Acceleration at the samples [m s^-2].
        pieces : ndarray, shape (n - 1, 6), optional
            Polynomials of an analytic motion [m s^-2].

        Returns
        -------
        Shaking
        """
        lines = np.column_stack([samples[:-1], np.diff(samples)]) if pieces is None else pieces
        return cls(time_step, samples, lines, analytic=pieces is not None)
