"""One component of a ground motion: samples, and polynomials from each to the next.

Also functions of time that are a polynomial in every interval: a row of coefficients, lowest power
first, is a polynomial in x, from 0 to 1 over one time step.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from numpy.typing import NDArray

from rockframe.errors import ComponentError
from rockframe.signals.arrays import OWNER, Array, frozen

MAXIMUM_SAMPLES: Final = 50_000_000
"""A motion that would be longer than this is taken for a slip of the pen."""

COEFFICIENTS: Final = 6
"""Of a polynomial between two samples of an analytic signal."""

HORIZONTAL: Final = "acceleration"
VERTICAL: Final = "vertical"
"""What the components are called in messages: as the arguments of constructors."""

_SAME_INSTANT: Final = 1e-9
"""Relative difference up to which a time is that of a sample."""

_ROUNDING: Final = 1e-14

_HALVINGS: Final = 54  # to the last bit of x


@dataclass(frozen=True, eq=False)
class Signal:
    """One component of a motion in SI units: read-only float64 arrays.

    In interval k the acceleration is ``sum_j pieces[k, j] u^j``, where u goes from 0
    to 1 over the time step. Before the first and after the last sample it is zero.

    Parameters
    ----------
    time_step : float
        dt between samples [s].
    samples : ndarray, shape (n,)
        Acceleration at the samples [m s^-2].
    polynomials : ndarray, shape (n - 1, 6), optional
        Coefficients between the samples of an analytic signal, lowest power first; those
        of a record are joined by straight lines [m s^-2].
    name : {"acceleration", "vertical"}, optional
        Which component it is, for messages.

    Raises
    ------
    ComponentError
        A value is not finite, fewer than two samples, shapes that do not agree, or a time
        step that is not positive.

    Examples
    --------
    >>> import numpy as np
    >>> signal = Signal(0.5, np.array([0.0, 2.0, -1.0]))
    >>> signal.at([0.25, 1.0]).tolist(), signal.at_place(np.array([0.5, 1.5])).tolist()
    ([1.0, -1.0], [1.0, 0.5])
    >>> signal.duration, signal.peak
    (1.0, 2.0)
    """

    time_step: float
    samples: Array
    polynomials: Array | None = None
    name: str = HORIZONTAL

    def __post_init__(self) -> None:
        dt = float(self.time_step)
        if not (math.isfinite(dt) and dt > 0.0):
            msg = f"{OWNER}: time_step must be finite and greater than zero, got {dt!r} s"
            raise ComponentError(msg)
        object.__setattr__(self, "time_step", dt)
        samples = frozen(self.samples, self.name)
        object.__setattr__(self, "samples", samples)
        if samples.size < 2:
            msg = f"{OWNER}: {self.name} needs at least two samples, got {samples.size}"
            raise ComponentError(msg)
        if self.polynomials is not None:
            name = "pieces" if self.name == HORIZONTAL else f"{self.name}_pieces"
            held = frozen(self.polynomials, name, (samples.size - 1, COEFFICIENTS))
            object.__setattr__(self, "polynomials", held)

    @property
    def analytic(self) -> bool:
        """Whether polynomials were given; else straight lines join the samples of a record."""
        return self.polynomials is not None

    @cached_property
    def pieces(self) -> Array:
        """The polynomials of all intervals: shape (n - 1, 6), of a record (n - 1, 2) [m s^-2]."""
        if self.polynomials is not None:
            return self.polynomials
        lines = np.column_stack([self.samples[:-1], np.diff(self.samples)])
        lines.setflags(write=False)
        return lines

    @property
    def times(self) -> Array:
        """Times of the samples, shape (n,) [s]."""
        return np.arange(float(self.samples.size)) * self.time_step

    @property
    def duration(self) -> float:
        """Time from the first to the last sample [s]."""
        return (self.samples.size - 1) * self.time_step

    @property
    def peak(self) -> float:
        """Greatest absolute acceleration, between samples too [m s^-2]."""
        highest = float(np.max(np.abs(self.samples)))
        return highest if self.polynomials is None else max(highest, greatest(self.polynomials))

    def at(self, time: npt.ArrayLike) -> Array:
        """Evaluate the acceleration.

        Parameters
        ----------
        time : array_like
            Times from the first sample [s].

        Returns
        -------
        ndarray
            Of the shape of `time`; at a sample, but for rounding of the time, the sample
            itself; zero before the start and after the end [m s^-2].
        """
        place = np.asarray(time, dtype=np.float64) / self.time_step
        last = self.samples.size - 1
        nearest = np.rint(place)
        close = np.abs(place - nearest) <= _SAME_INSTANT * np.maximum(nearest, 1.0)
        values = np.array(self.samples[np.clip(nearest, 0, last).astype(np.intp)])
        between = ~np.asarray(close & (nearest >= 0.0) & (nearest <= last))
        if between.any():
            values[between] = self.at_place(place[between])
        return values

    def at_place(self, place: Array) -> Array:
        """Evaluate the polynomials, at a sample that of the interval which begins there.

        Parameters
        ----------
        place : ndarray
            Times from the first sample over the time step [1].

        Returns
        -------
        ndarray
            Of the shape of `place`; zero outside the signal [m s^-2].
        """
        last = self.samples.size - 1
        interval = np.clip(np.floor(place), 0, last - 1).astype(np.intp)
        values = values_at(self.pieces[interval], place - interval)
        return np.where((place >= 0.0) & (place <= last * (1.0 + _ROUNDING)), values, 0.0)

    def __reduce__(self) -> tuple[Any, ...]:
        # through the constructor, so that an unpickled copy is read-only again
        return (type(self), (self.time_step, self.samples, self.polynomials, self.name))


def values_at(pieces: Array, place: Array | float) -> Array:
    """Evaluate every row of coefficients, shape (..., m), each at its own place x [1]."""
    values = np.zeros(pieces.shape[:-1])
    for power in reversed(range(pieces.shape[-1])):
        values = values * place + pieces[..., power]
    return values


def slopes_of(pieces: Array) -> Array:
    """Differentiate by x."""
    return pieces[:, 1:] * np.arange(1.0, pieces.shape[1])


def integral_of(pieces: Array, time_step: float) -> Array:
    """Integrate rows over time, from zero on and continuous, :eq:`eq-ground-velocity`."""
    rising = pieces * (time_step / np.arange(1.0, pieces.shape[1] + 1.0))
    start = np.concatenate([[0.0], np.cumsum(rising.sum(axis=1))[:-1]])
    return np.column_stack([start, rising])


def divided(pieces: Array, parts: int) -> Array:
    """Divide every interval into equal parts, each with its own x."""
    if parts == 1:
        return pieces
    powers = range(pieces.shape[1])
    # Taylor's expansion of every power about the start of the part
    shifts = np.zeros((parts, len(powers), len(powers)))
    starts = np.arange(parts) / parts
    for j in powers:
        for k in range(j + 1):
            shifts[:, j, k] = math.comb(j, k) * starts ** (j - k) / float(parts) ** k
    return np.einsum("nj,pjk->npk", pieces, shifts).reshape(-1, len(powers))


def knots_of(pieces: Array) -> Array:
    """Give the values at both ends of all intervals."""
    return np.append(pieces[:, 0], pieces[-1].sum())


def roots_of(pieces: Array) -> Array:
    """Find the x at which every row crosses zero; its ends have different signs [1]."""
    low, high = np.zeros(len(pieces)), np.ones(len(pieces))
    if pieces.shape[1] == 2:
        return -pieces[:, 0] / pieces[:, 1]
    rising = pieces[:, 0] < 0.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        before = (values_at(pieces, middle) < 0.0) == rising
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return 0.5 * (low + high)


def turning_points(pieces: Array) -> tuple[NDArray[np.intp], Array]:
    """Find the extrema inside the intervals at whose ends the slopes differ in sign."""
    slopes = slopes_of(pieces)
    rows = np.flatnonzero(slopes[:, 0] * slopes.sum(axis=1) < 0.0)
    return rows, values_at(pieces[rows], roots_of(slopes[rows]))


def greatest(pieces: Array) -> float:
    """Find the greatest absolute value, between the knots too."""
    _, between = turning_points(pieces)
    ends = np.concatenate([pieces[:, 0], pieces.sum(axis=1), between])
    return float(np.max(np.abs(ends)))
