"""Ground that slopes: gravity and the motion along it and normal to it, :eq:`eq-incline-ground`."""

import math
from dataclasses import dataclass

import numpy as np

from rockframe.signals.arrays import Array
from rockframe.signals.motion import Motion
from rockframe.signals.signal import COEFFICIENTS, HORIZONTAL, VERTICAL, Signal


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
