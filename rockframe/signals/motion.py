"""Ground motions: their components, resolved along an inclined base, and piecewise polynomials.

A component consists of samples, and of a polynomial from each sample to the next. A row of
coefficients, lowest power first, is a polynomial in x, which goes from 0 to 1 over one time step.
"""

from __future__ import annotations

import hashlib
import math
import struct
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, Self

import numpy as np

from rockframe.errors import ComponentError
from rockframe.signals.arrays import OWNER, Array, readonly_array

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy.typing as npt
    from numpy.typing import NDArray

MAXIMUM_SAMPLES: Final = 50_000_000
"""Most samples of a motion; more are taken for a mistake."""

COEFFICIENTS: Final = 6
"""Coefficients of a polynomial between two samples of an analytic signal."""

HORIZONTAL: Final = "acceleration"
VERTICAL: Final = "vertical"
"""Names of the components in messages: as the arguments of constructors."""

_SAME_INSTANT: Final = 1e-9
"""Relative difference up to which a time is taken for that of a sample."""

_ROUNDING: Final = 1e-14

_HALVINGS: Final = 54  # bisections that find x to its last bit


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
        samples = readonly_array(self.samples, self.name)
        object.__setattr__(self, "samples", samples)
        if samples.size < 2:
            msg = f"{OWNER}: {self.name} needs at least two samples, got {samples.size}"
            raise ComponentError(msg)
        if self.polynomials is not None:
            name = "pieces" if self.name == HORIZONTAL else f"{self.name}_pieces"
            held = readonly_array(self.polynomials, name, (samples.size - 1, COEFFICIENTS))
            object.__setattr__(self, "polynomials", held)

    @property
    def analytic(self) -> bool:
        """Whether polynomials were given; else straight lines join the samples of a record."""
        return self.polynomials is not None

    @cached_property
    def pieces(self) -> Array:
        """The polynomials of all intervals, shape (n - 1, 6); (n - 1, 2) for a record [m s^-2]."""
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
        if self.polynomials is None:
            return highest
        return max(highest, absolute_peak(self.polynomials))

    def at(self, time: npt.ArrayLike) -> Array:
        """Evaluate the acceleration.

        Parameters
        ----------
        time : array_like
            Times from the first sample [s].

        Returns
        -------
        ndarray
            Accelerations, in the shape of `time`: exactly a sample if the time is that of the
            sample up to rounding; zero before the start and after the end [m s^-2].
        """
        place = np.asarray(time, dtype=np.float64) / self.time_step
        if np.isnan(place).any():
            msg = f"{OWNER}: times must be numbers, got nan"
            raise ComponentError(msg)
        last = self.samples.size - 1
        nearest = np.rint(place)
        close = np.abs(place - nearest) <= _SAME_INSTANT * np.maximum(nearest, 1.0)
        values = np.array(self.samples[np.clip(nearest, 0, last).astype(np.intp)])
        between = ~np.asarray(close & (nearest >= 0.0) & (nearest <= last))
        if between.any():
            values[between] = self.at_place(place[between])
        return values

    def at_place(self, place: Array) -> Array:
        """Evaluate the polynomials; at a sample, the polynomial of the interval that begins there.

        Parameters
        ----------
        place : ndarray
            Times from the first sample over the time step [1].

        Returns
        -------
        ndarray
            Accelerations, in the shape of `place`; zero outside the signal [m s^-2].
        """
        last = self.samples.size - 1
        interval = np.clip(np.floor(place), 0, last - 1).astype(np.intp)
        values = values_at(self.pieces[interval], place - interval)
        return np.where((place >= 0.0) & (place <= last * (1.0 + _ROUNDING)), values, 0.0)

    def __reduce__(self) -> tuple[Any, ...]:
        # through the constructor, so that an unpickled copy is read-only again
        return (type(self), (self.time_step, self.samples, self.polynomials, self.name))


@dataclass(frozen=True, eq=False)
class Motion:
    """The accelerations of the ground, from file or formula to integrator.

    Parameters
    ----------
    horizontal : Signal
        Horizontal acceleration.
    vertical : Signal, optional
        Vertical acceleration, upwards; of the same time step and length.

    Raises
    ------
    ComponentError
        The components differ in time step or length.

    Examples
    --------
    >>> import numpy as np
    >>> motion = Motion.of_samples(0.5, np.array([0.0, 2.0, -1.0]))
    >>> twice = motion.each(lambda signal: Signal(signal.time_step, 2.0 * signal.samples))
    >>> motion.at(0.25).item(), twice.at(0.25).item()
    (1.0, 2.0)
    """

    horizontal: Signal
    vertical: Signal | None = None
    time_step: float = field(init=False, repr=False, compare=False)  # between samples [s]

    def __post_init__(self) -> None:
        object.__setattr__(self, "time_step", self.horizontal.time_step)
        vertical = self.vertical
        if vertical is None:
            return
        expected, found = self.horizontal.samples.shape, vertical.samples.shape
        if found != expected:
            msg = f"{OWNER}: vertical needs the shape {expected}, got the shape {found}"
            raise ComponentError(msg)
        if vertical.time_step != self.time_step:
            msg = (
                f"{OWNER}: vertical needs the time step {self.time_step!r} s, "
                f"got {vertical.time_step!r} s"
            )
            raise ComponentError(msg)

    @classmethod
    def of_samples(cls, time_step: float, horizontal: Array, vertical: Array | None = None) -> Self:
        """Return the motion of a record, whose samples are joined by straight lines.

        Parameters
        ----------
        time_step : float
            dt between samples [s].
        horizontal, vertical : ndarray, shape (n,)
            Accelerations at the samples; None for no vertical component [m s^-2].

        Returns
        -------
        Motion
        """
        across = Signal(time_step, horizontal)
        if vertical is None:
            return cls(across)
        return cls(across, Signal(time_step, vertical, name=VERTICAL))

    @property
    def duration(self) -> float:
        """Time from the first to the last sample [s]."""
        return self.horizontal.duration

    @property
    def peak(self) -> float:
        """Greatest absolute horizontal acceleration, between samples too [m s^-2]."""
        return self.horizontal.peak

    @property
    def analytic(self) -> bool:
        """Whether a component has polynomials between its samples."""
        return self.horizontal.analytic or (self.vertical is not None and self.vertical.analytic)

    def at(self, time: npt.ArrayLike) -> Array:
        """Evaluate the horizontal acceleration, as :meth:`Signal.at` does."""
        return self.horizontal.at(time)

    def each(self, change: Callable[[Signal], Signal]) -> Motion:
        """Change both components alike.

        Parameters
        ----------
        change : callable
            Function that gives the new component from the old one.

        Returns
        -------
        Motion
        """
        horizontal = change(self.horizontal)
        return Motion(horizontal, None if self.vertical is None else change(self.vertical))

    @cached_property
    def digest(self) -> str:
        """The sha256 of time step, samples and polynomials: what a simulation sees."""
        total = hashlib.sha256(b"rockframe motion 1")
        total.update(struct.pack("<d", self.time_step))
        samples = (self.horizontal.samples, self.vertical and self.vertical.samples)
        polynomials = (self.horizontal.polynomials, self.vertical and self.vertical.polynomials)
        for values in (*samples, *polynomials):
            total.update(struct.pack("<q", -1 if values is None else values.size))
            if values is not None:
                total.update(values.astype("<f8", copy=False).tobytes())
        return total.hexdigest()


@dataclass(frozen=True)
class Incline:
    """The inclination of a base line, which rises to the right, and the gravity on it."""

    inclination: float  # i [rad]
    gravity: float  # g [m s^-2]

    level: bool = field(init=False, repr=False, compare=False)  # whether the base does not rise
    # ground accelerations that are equivalent to gravity: along the base g sin i, normal g cos i
    along_gravity: float = field(init=False, repr=False, compare=False)  # [m s^-2]
    normal_gravity: float = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        i, g = self.inclination, self.gravity
        vars(self).update(
            level=i == 0.0, along_gravity=g * math.sin(i), normal_gravity=g * math.cos(i)
        )

    def rotated(self, across: Array, up: Array) -> tuple[Array, Array]:
        """Return the components along and normal to the base of horizontal and vertical ones."""
        sine, cosine = math.sin(self.inclination), math.cos(self.inclination)
        return across * cosine + up * sine, up * cosine - across * sine

    def resolved(self, motion: Motion | None, *, duration: float, interval: float) -> Motion:
        """Return the motion along and normal to the base, with the part of gravity along it.

        Parameters
        ----------
        motion : Motion or None
            Horizontal and vertical motion of the ground; None for still ground.
        duration : float
            Duration of the run, in which gravity acts throughout [s].
        interval : float
            Interval between samples where there is no motion [s].

        Returns
        -------
        Motion
            Its horizontal component is along the base, its vertical one normal to it.
        """
        step = interval if motion is None else motion.time_step
        moving = 0 if motion is None else motion.horizontal.samples.size - 1
        shape = max(moving, math.ceil(duration / step) + 1), COEFFICIENTS
        across, up = np.zeros(shape), np.zeros(shape)
        if motion is not None:
            pieces = motion.horizontal.pieces
            across[:moving, : pieces.shape[1]] = pieces
            if motion.vertical is not None:
                pieces = motion.vertical.pieces
                up[:moving, : pieces.shape[1]] = pieces
        along, normal = self.rotated(across, up)
        along[:, 0] += self.along_gravity
        return Motion(_signal(step, along, HORIZONTAL), _signal(step, normal, VERTICAL))


def _signal(step: float, pieces: Array, name: str) -> Signal:
    """Return a component that may jump between its intervals."""
    return Signal(step, np.append(pieces[:, 0], pieces[-1].sum()), pieces, name)


def values_at(pieces: Array, x: Array | float) -> Array:
    """Evaluate rows of coefficients, shape (..., m), each at its own x, from 0 to 1."""
    values = np.zeros(pieces.shape[:-1])
    for power in reversed(range(pieces.shape[-1])):
        values = values * x + pieces[..., power]
    return values


def derivatives_of(pieces: Array) -> Array:
    """Return the coefficients of the derivatives by x."""
    return pieces[:, 1:] * np.arange(1.0, pieces.shape[1])


def integral_of(pieces: Array, time_step: float) -> Array:
    """Return the integral over time, continuous and zero at the start, :eq:`eq-ground-velocity`."""
    rising = pieces * (time_step / np.arange(1.0, pieces.shape[1] + 1.0))
    start = np.concatenate([[0.0], np.cumsum(rising.sum(axis=1))[:-1]])
    return np.column_stack([start, rising])


def subdivided(pieces: Array, parts: int) -> Array:
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
    """Return values at the starts of all intervals and at the end of the last, shape (n + 1,)."""
    return np.append(pieces[:, 0], pieces[-1].sum())


def roots_of(pieces: Array) -> Array:
    """Return the x at which each row crosses zero; the signs at its ends must differ [1]."""
    low, high = np.zeros(len(pieces)), np.ones(len(pieces))
    if pieces.shape[1] == 2:
        return -pieces[:, 0] / pieces[:, 1]
    rising = pieces[:, 0] < pieces.sum(axis=1)  # a start may be zero
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        before = (values_at(pieces, middle) < 0.0) == rising
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return 0.5 * (low + high)


def split_at(pieces: Array, x: Array) -> tuple[Array, Array]:
    """Divide each row at its x, into the polynomials before and after, each with its own x."""
    powers = range(pieces.shape[1])
    after = [  # Taylor's expansion about x
        sum(math.comb(j, k) * pieces[:, j] * x ** (j - k) for j in powers[k:]) * (1.0 - x) ** k
        for k in powers
    ]
    return pieces * x[:, None] ** np.arange(len(powers)), np.stack(after, axis=1)


def extrema_of(pieces: Array) -> tuple[NDArray[np.intp], Array]:
    """Return the intervals whose slopes at both ends differ in sign, and the extrema in them."""
    slopes = derivatives_of(pieces)
    rows = sign_changes(slopes)
    return rows, values_at(pieces[rows], roots_of(slopes[rows]))


def sign_changes(values: Array) -> NDArray[np.intp]:
    """Return the intervals at whose ends values differ in sign."""
    return np.flatnonzero(values[:, 0] * values.sum(axis=1) < 0.0)


def absolute_peak(pieces: Array) -> float:
    """Return the greatest absolute value, also between the ends of intervals."""
    values = [pieces[:, 0], pieces.sum(axis=1), extrema_of(pieces)[1]]
    if pieces.shape[1] > 3:
        # the slope may be zero twice, or once and at an end: once on each side of its extremum
        second_derivatives = derivatives_of(derivatives_of(pieces))
        rows = sign_changes(second_derivatives)
        halves = split_at(pieces[rows], roots_of(second_derivatives[rows]))
        values += [extrema_of(half)[1] for half in halves]
    return float(np.max(np.abs(np.concatenate(values))))
