"""Ground acceleration: linear between samples, or an analytic pulse.

On an inclined base the axes are along it and normal to it, and gravity along it acts as a constant
ground acceleration.
"""

import math

from .compiling import compiled, within

STILL, RECORD, HARMONIC, RICKER, RICKER_ODD = 0, 1, 2, 3, 4
COSINE, SINE, PULL = 5, 6, 7


@compiled
def ground(t, piece, shape, across, upwards):
    """Return the acceleration of the ground along the base and normal to it, see `_level`."""
    gx, gy = _level(t, piece, shape, across, upwards)
    cosine, sine = shape[COSINE], shape[SINE]
    return gx * cosine + gy * sine + shape[PULL], gy * cosine - gx * sine


@within
def _level(t, piece, shape, across, upwards):
    """Return the horizontal and vertical acceleration of the ground.

    Parameters
    ----------
    t : float
        Time.
    piece : int
        Index of the interval between samples; -1 where the ground is still.
    shape : ndarray
        Kind; for a record its time step; for a pulse frequency or period, phase, and the
        amplitudes of both components; then cosine and sine of the inclination of the base, and
        the part of gravity along it.
    across, upwards : ndarray
        Samples of a record.
    """
    kind = int(shape[0])
    if piece < 0 or kind == STILL:
        return 0.0, 0.0
    if kind == RECORD:
        u = t / shape[1] - piece
        return (
            across[piece] * (1.0 - u) + across[piece + 1] * u,
            upwards[piece] * (1.0 - u) + upwards[piece + 1] * u,
        )
    if kind == HARMONIC:
        unit = math.sin(2.0 * math.pi * shape[1] * t + shape[2])
    elif kind == RICKER:
        x = math.sqrt(2.0) * math.pi * (t / shape[1] - 2.5)
        unit = (1.0 - x * x) * math.exp(-0.5 * x * x)
    else:
        x = 2.0 * math.pi / math.sqrt(3.0) * (t / shape[1] - 2.5)
        root = 3.0 - math.sqrt(6.0)
        unit = x * (x * x - 3.0) * math.exp(-0.5 * x * x)
        unit /= math.sqrt(6.0 * root) * math.exp(-0.5 * root)
    return shape[3] * unit, shape[4] * unit
