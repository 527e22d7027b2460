"""The sampled motion in SI units, and the function of time that it stands for."""

from __future__ import annotations

import hashlib
import math
import struct
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from rockframe.errors import ComponentError
from rockframe.shaking.polynomials import greatest
from rockframe.shaking.shaking import MAXIMUM_SAMPLES as MAXIMUM_SAMPLES
from rockframe.shaking.shaking import Array as Array

_OWNER: Final = "GroundMotion"
COEFFICIENTS: Final = 6
"""Of a polynomial between two samples of an analytic motion."""
_ROUNDING: Final = 1e-14


@dataclass(frozen=True, eq=False)
class MotionSI:
    """A motion in SI units: read-only float64 arrays.

    Between two samples the motion is linear, unless `pieces` is given: then in
    interval k it is the polynomial ``sum_j pieces[k, j] u^j`` with
    ``u = (t - k dt)/dt``. Outside its duration the ground stands still.

    Parameters
    ----------
    time_step : float
        dt between samples [s].
    acceleration : ndarray, shape (n,)
        Horizontal acceleration of the ground [m s^-2].
    vertical : ndarray, shape (n,), optional
        Vertical acceleration of the ground, upwards [m s^-2].
    pieces, vertical_pieces : ndarray, shape (n - 1, 6), optional
        Polynomial coefficients per interval, lowest power first [m s^-2].

    Raises
    ------
    ComponentError
        A value is not finite, fewer than two samples, shapes that do not
        agree, or a time step that is not positive.
    """

    time_step: float
    acceleration: Array
    vertical: Array | None = None
    pieces: Array | None = None
    vertical_pieces: Array | None = None

    def __post_init__(self) -> None:
        dt = float(self.time_step)
        if not (math.isfinite(dt) and dt > 0.0):
            msg = f"{_OWNER}: time_step must be finite and greater than zero, got {dt!r} s"
            raise ComponentError(msg)
        object.__setattr__(self, "time_step", dt)
        samples = _frozen(self.acceleration, "acceleration", None)
        object.__setattr__(self, "acceleration", samples)
        if samples.size < 2:
            msg = f"{_OWNER}: acceleration needs at least two samples, got {samples.size}"
            raise ComponentError(msg)
        shapes = {
            "vertical": (samples.size,),
            "pieces": (samples.size - 1, COEFFICIENTS),
            "vertical_pieces": (samples.size - 1, COEFFICIENTS),
        }
        for name, shape in shapes.items():
            values = getattr(self, name)
            if values is not None:
                object.__setattr__(self, name, _frozen(values, name, shape))
        if self.vertical is None and self.vertical_pieces is not None:
            msg = f"{_OWNER}: vertical_pieces without vertical samples"
            raise ComponentError(msg)

    @property
    def duration(self) -> float:
        """Time from the first to the last sample [s]."""
        return (self.acceleration.size - 1) * self.time_step

    @property
    def peak(self) -> float:
        """Greatest absolute horizontal acceleration, between samples too [m s^-2]."""
        return peak_of(self.acceleration, self.pieces)

    @property
    def vertical_peak(self) -> float:
        """Greatest absolute vertical acceleration; 0 without a vertical one [m s^-2]."""
        return 0.0 if self.vertical is None else peak_of(self.vertical, self.vertical_pieces)

    def at(self, time: npt.ArrayLike) -> Array:
        """Evaluate the horizontal acceleration.

        Parameters
        ----------
        time : array_like
            Times from the start of the motion [s].

        Returns
        -------
        ndarray
            Of the shape of `time`; zero before the start and after the end [m s^-2].
        """
        return value_at(self.time_step, self.acceleration, self.pieces, time)

    def vertical_at(self, time: npt.ArrayLike) -> Array:
        """Evaluate the vertical acceleration, like :meth:`at`; zero without one."""
        if self.vertical is None:
            return np.zeros(np.shape(time))
        return value_at(self.time_step, self.vertical, self.vertical_pieces, time)

    def digest(self) -> str:
        """Give the sha256 of time step, samples and pieces: what a simulation sees."""
        total = hashlib.sha256(b"rockframe motion 1")
        total.update(struct.pack("<d", self.time_step))
        for values in (self.acceleration, self.vertical, self.pieces, self.vertical_pieces):
            total.update(struct.pack("<q", -1 if values is None else values.size))
            if values is not None:
                total.update(values.astype("<f8", copy=False).tobytes())
        return total.hexdigest()

    def __reduce__(self) -> tuple[Any, ...]:
        # through the constructor, so that an unpickled copy is read-only again
        parts = (self.acceleration, self.vertical, self.pieces, self.vertical_pieces)
        return (MotionSI, (self.time_step, *parts))


def value_at(dt: float, samples: Array, pieces: Array | None, time: npt.ArrayLike) -> Array:
    """Evaluate one component of a motion.

    Parameters
    ----------
    dt : float
        Time step [s].
    samples : ndarray, shape (n,)
        Samples [m s^-2].
    pieces : ndarray, shape (n - 1, 6), optional
        Polynomials instead of straight lines between them.
    time : array_like
        Times from the first sample [s].

    Returns
    -------
    ndarray
        Zero outside the motion [m s^-2].
    """
    place = np.asarray(time, dtype=np.float64) / dt
    last = samples.size - 1
    interval = np.clip(np.floor(place), 0, last - 1).astype(np.intp)
    u = place - interval
    if pieces is None:
        values = samples[interval] * (1.0 - u) + samples[interval + 1] * u
    else:
        values = np.zeros_like(u)
        for power in reversed(range(COEFFICIENTS)):
            values = values * u + pieces[interval, power]
    return np.where((place >= 0.0) & (place <= last * (1.0 + _ROUNDING)), values, 0.0)


def peak_of(samples: Array, pieces: Array | None) -> float:
    """Find the greatest absolute value of a component, between samples too.

    Parameters
    ----------
    samples : ndarray, shape (n,)
        Samples [m s^-2].
    pieces : ndarray, shape (n - 1, 6), optional
        Polynomials between them.

    Returns
    -------
    float
        [m s^-2]
    """
    highest = float(np.max(np.abs(samples)))
    return highest if pieces is None else max(highest, greatest(pieces))


def _frozen(values: object, name: str, shape: tuple[int, ...] | None) -> Array:
    array = np.array(values, dtype=np.float64, order="C", copy=True)
    if (array.ndim != 1) if shape is None else (array.shape != shape):
        wanted = "one dimension" if shape is None else f"the shape {shape}"
        msg = f"{_OWNER}: {name} needs {wanted}, got the shape {array.shape}"
        raise ComponentError(msg)
    wrong = np.flatnonzero(~np.isfinite(array.reshape(-1)))
    if wrong.size:
        where = int(wrong[0])
        msg = f"{_OWNER}: {name} must be finite, got {array.reshape(-1)[where]} at index {where}"
        raise ComponentError(msg)
    array.setflags(write=False)
    return array
