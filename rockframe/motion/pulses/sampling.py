"""From a function of time to samples, with a quintic polynomial between each two."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from rockframe.errors import ComponentError
from rockframe.signals import Motion, Signal
from rockframe.signals.arrays import Array
from rockframe.signals.signal import MAXIMUM_SAMPLES

Shape: TypeAlias = Callable[[Array, float], tuple[Array, Array, Array]]
"""Gives a, a' h and a'' h^2 [m s^-2] at some places, and for the step h between them.

Places and step count periods; the derivatives are those by the place.
"""


def sampled(shape: Shape, *, length: float, frequency: float, intervals: int, owner: str) -> Motion:
    """Sample a function that is smooth from the start to the end of the motion."""
    if length * intervals > MAXIMUM_SAMPLES:
        msg = f"{owner}: {length:.6g} cycles are more than can be sampled; shorten the motion"
        raise ComponentError(msg)
    count = max(1, math.ceil(length * intervals))
    step = length / count
    time_step = step / frequency
    if not (math.isfinite(time_step) and time_step > 0.0):
        msg = f"{owner}: a frequency of {frequency!r} Hz is outside what can be sampled"
        raise ComponentError(msg)
    places = np.arange(count + 1) * length / count
    with np.errstate(over="ignore", invalid="ignore"):
        value, slope, curvature = shape(places, step)
        pieces = hermite_pieces(value, slope, curvature)
    return Motion(Signal(time_step, value, pieces))


def hermite_pieces(value: Array, slope: Array, curvature: Array) -> Array:
    """Compute quintic Hermite polynomials from nodal values and derivatives."""
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
