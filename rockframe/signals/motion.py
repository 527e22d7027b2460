"""Both components of a motion, and what is left of it and of gravity along an inclined base."""

from __future__ import annotations

import hashlib
import math
import struct
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Self

import numpy as np

from rockframe.errors import ComponentError
from rockframe.signals.arrays import OWNER, Array
from rockframe.signals.signal import COEFFICIENTS, HORIZONTAL, VERTICAL, Signal

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy.typing as npt

    from rockframe.signals.arrays import Array


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

    def __post_init__(self) -> None:
        vertical = self.vertical
        if vertical is None:
            return
        wanted, found = self.horizontal.samples.shape, vertical.samples.shape
        if found != wanted:
            msg = f"{OWNER}: vertical needs the shape {wanted}, got the shape {found}"
            raise ComponentError(msg)
        if vertical.time_step != self.time_step:
            msg = (
                f"{OWNER}: vertical needs the time step {self.time_step!r} s, "
                f"got {vertical.time_step!r} s"
            )
            raise ComponentError(msg)

    @classmethod
    def of_samples(cls, time_step: float, horizontal: Array, vertical: Array | None = None) -> Self:
        """Join the samples of a record by straight lines.

        Parameters
        ----------
        time_step : float
            dt between samples [s].
        horizontal, vertical : ndarray, shape (n,)
            Accelerations at the samples, if there are vertical ones [m s^-2].

        Returns
        -------
        Motion
        """
        across = Signal(time_step, horizontal)
        if vertical is None:
            return cls(across)
        return cls(across, Signal(time_step, vertical, name=VERTICAL))

    @property
    def time_step(self) -> float:
        """Time between samples [s]."""
        return self.horizontal.time_step

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
            New component from old one.

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
class Slope:
    """A base line that rises to the right, and the gravity that it stands in."""

    inclination: float  # i [rad]
    gravity: float  # g [m s^-2]

    @property
    def level(self) -> bool:
        """Whether the base does not rise."""
        return self.inclination == 0.0

    @property
    def along_gravity(self) -> float:
        """Acceleration that stands for gravity along the base, g sin i [m s^-2]."""
        return self.gravity * math.sin(self.inclination)

    @property
    def normal_gravity(self) -> float:
        """Gravity normal to the base, g cos i [m s^-2]."""
        return self.gravity * math.cos(self.inclination)

    def turned(self, across: Array, up: Array) -> tuple[Array, Array]:
        """Give along and normal components of horizontal and vertical ones."""
        sine, cosine = math.sin(self.inclination), math.cos(self.inclination)
        return across * cosine + up * sine, up * cosine - across * sine

    def resolved(self, motion: Motion | None, *, duration: float, interval: float) -> Motion:
        """Give the motion along and normal to the base, with the part of gravity along it.

        Parameters
        ----------
        motion : Motion or None
            Of the ground, horizontal and vertical.
        duration : float
            Of the run, all of which gravity lasts [s].
        interval : float
            Between samples, where there is no motion [s].

        Returns
        -------
        Motion
            Along the base, and normal to it.
        """
        step = interval if motion is None else motion.time_step
        moving = 0 if motion is None else motion.horizontal.samples.size - 1
        shape = max(moving, math.ceil(duration / step) + 1), COEFFICIENTS
        across, up = np.zeros(shape), np.zeros(shape)
        if motion is not None:
            given = motion.horizontal.pieces
            across[:moving, : given.shape[1]] = given
            if motion.vertical is not None:
                given = motion.vertical.pieces
                up[:moving, : given.shape[1]] = given
        along, normal = self.turned(across, up)
        along[:, 0] += self.along_gravity
        return Motion(_signal(step, along, HORIZONTAL), _signal(step, normal, VERTICAL))


def _signal(step: float, pieces: Array, name: str) -> Signal:
    """Give a component that may jump between its intervals."""
    return Signal(step, np.append(pieces[:, 0], pieces[-1].sum()), pieces, name)
