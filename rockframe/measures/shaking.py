"""One component of a ground motion as polynomials from sample to sample."""

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from rockframe.errors import ComponentError
from rockframe.motion import GroundMotion

Array: TypeAlias = NDArray[np.float64]


class GroundComponent(StrEnum):
    """Which acceleration of a motion is looked at."""

    HORIZONTAL = "horizontal"
    VERTICAL = "vertical"


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


def shaking_of(motion: object, component: object, *, owner: str) -> Shaking:
    """Take one component of a motion.

    Parameters
    ----------
    motion : GroundMotion
        The motion.
    component : {"horizontal", "vertical"}
        Which acceleration.
    owner : str
        Function, for the message.

    Returns
    -------
    Shaking

    Raises
    ------
    ComponentError
        Not a motion, not a component, or the motion lacks it.
    """
    if not isinstance(motion, GroundMotion):
        msg = f"{owner}: motion needs a GroundMotion, got {motion!r}"
        raise ComponentError(msg)
    si = motion.si
    if component_of(component, owner=owner) is GroundComponent.HORIZONTAL:
        return _shaking(si.time_step, si.acceleration, si.pieces)
    if si.vertical is None:
        msg = f"{owner}: component='vertical', but {motion.name!r} has no vertical acceleration"
        raise ComponentError(msg)
    return _shaking(si.time_step, si.vertical, si.vertical_pieces)


def component_of(given: object, *, owner: str) -> GroundComponent:
    """Read the argument `component`.

    Parameters
    ----------
    given : {"horizontal", "vertical"}
        What the user gave.
    owner : str
        Function, for the message.

    Returns
    -------
    GroundComponent

    Raises
    ------
    ComponentError
        None of the two.
    """
    try:
        return GroundComponent(str(given))
    except ValueError:
        known = " or ".join(repr(str(one)) for one in GroundComponent)
        msg = f"{owner}: component must be {known}, got {given!r}"
        raise ComponentError(msg) from None


def _shaking(time_step: float, samples: Array, pieces: Array | None) -> Shaking:
    lines = np.column_stack([samples[:-1], np.diff(samples)]) if pieces is None else pieces
    return Shaking(time_step, samples, lines, analytic=pieces is not None)
