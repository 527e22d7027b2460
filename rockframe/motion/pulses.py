"""Analytic motions, sampled so finely that a simulation cannot tell the difference."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from rockframe.errors import ComponentError
from rockframe.motion.samples import MAXIMUM_SAMPLES, Array, MotionSI

INTERVALS_PER_CYCLE: Final = 128
"""Quintic pieces per cycle: (2 pi/128)^6/(64 * 720) = 3.0e-13 of the amplitude."""

_HALF: Final = 0.5
_QUARTER: Final = 0.25


def sine(
    *, amplitude: float, frequency: float, cycles: float, phase: float = 0.0, owner: str
) -> MotionSI:
    """Build ``a(t) = amplitude sin(2 pi frequency t + phase)``.

    Parameters
    ----------
    amplitude : float
        [m s^-2]
    frequency : float
        Cyclic frequency f [Hz].
    cycles : float
        Length over the period [1].
    phase : float, optional
        Phase at the start [rad].
    owner : str
        Constructor, for the message.

    Returns
    -------
    MotionSI
        With quintic Hermite pieces: value, slope and curvature are right at
        every sample.

    Raises
    ------
    ComponentError
        More samples than can be meant.
    """
    if cycles * INTERVALS_PER_CYCLE > MAXIMUM_SAMPLES:
        msg = f"{owner}: {cycles:.6g} cycles are more than can be sampled; shorten the motion"
        raise ComponentError(msg)
    count = max(1, math.ceil(cycles * INTERVALS_PER_CYCLE))
    turns_per_step = cycles / count
    time_step = turns_per_step / frequency
    if not (math.isfinite(time_step) and time_step > 0.0):
        msg = f"{owner}: a frequency of {frequency!r} Hz is outside what can be sampled"
        raise ComponentError(msg)
    turns = np.arange(count + 1) * cycles / count + phase / (2.0 * math.pi)
    with np.errstate(over="ignore", invalid="ignore"):
        value = amplitude * sine_of_turns(turns)
        angle = 2.0 * math.pi * turns_per_step  # omega dt
        slope = amplitude * sine_of_turns(turns + _QUARTER) * angle
        curvature = -value * angle**2
        pieces = hermite_pieces(value, slope, curvature)
    return MotionSI(time_step=time_step, acceleration=value, pieces=pieces)


def sine_of_turns(turns: Array) -> Array:
    """Compute sin(2 pi x), exactly zero at every half turn.

    Parameters
    ----------
    turns : ndarray
        x, in full turns [1].

    Returns
    -------
    ndarray
    """
    rest = turns - np.round(turns)
    folded = np.where(np.abs(rest) > _QUARTER, np.copysign(_HALF, rest) - rest, rest)
    return np.sin(2.0 * math.pi * folded)


def hermite_pieces(value: Array, slope: Array, curvature: Array) -> Array:
    """Compute quintic Hermite polynomials from nodal values and derivatives.

    Parameters
    ----------
    value, slope, curvature : ndarray, shape (n,)
        a, a' dt and a'' dt^2 at the samples [m s^-2].

    Returns
    -------
    ndarray, shape (n - 1, 6)
        Coefficients in u, lowest power first [m s^-2].
    """
    start, s0, c0 = value[:-1], slope[:-1], curvature[:-1]
    rise = value[1:] - start - s0 - 0.5 * c0
    turn = slope[1:] - s0 - c0
    bend = curvature[1:] - c0
    return np.column_stack(
        [
            start,
            s0,
            0.5 * c0,
            10.0 * rise - 4.0 * turn + 0.5 * bend,
            -15.0 * rise + 7.0 * turn - bend,
            6.0 * rise - 3.0 * turn + 0.5 * bend,
        ]
    )
