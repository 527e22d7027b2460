"""What a test would have shown, had the unknowns other values."""

import math
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Final

import numpy as np

from rockframe.identification.free_motion import FreeMotion, first_peaks, let_go
from rockframe.identification.measured import History, MeasuredPeaks
from rockframe.identification.unknowns import Circumstance, TrialSystems
from rockframe.signals.arrays import Array
from rockframe.solve.accuracy import Accuracy

EARLIER: Final = 0.25
"""Share of a history's length by which the release may be earlier than its first sample."""
_REMEMBERED: Final = 4
"""Runs that are kept: a change of the gauge's offset or of the release needs no new one."""


class Prediction:
    """Predicts what was measured from values of the unknowns."""

    def __init__(
        self,
        trials: TrialSystems,
        names: Sequence[str],
        known: Mapping[str, float],
        accuracy: Accuracy,
    ) -> None:
        self.trials = trials
        self.names = names
        self._known = known
        self._accuracy = accuracy
        self._for_history = lru_cache(maxsize=_REMEMBERED)(self._run_history)
        self._for_peaks = lru_cache(maxsize=_REMEMBERED)(self._run_peaks)

    def values(self, found: Array) -> dict[str, float]:
        """Give all values by their names, those that are known among them."""
        return {**self._known, **dict(zip(self.names, found.tolist(), strict=True))}

    def history(self, found: Array, measured: History) -> Array:
        """Give the rotation that a gauge would have shown at the times of a history [rad]."""
        values = self.values(found)
        motion = self._for_history(*self._key(values), (1.0 + EARLIER) * measured.span)
        since = measured.time - values[Circumstance.RELEASE_TIME]
        return values[Circumstance.GAUGE_OFFSET] + motion.at(since)

    def peaks(self, found: Array, measured: MeasuredPeaks) -> tuple[Array, Array]:
        """Give times and rotations of the peaks as a gauge would have shown them [s], [rad]."""
        values = self.values(found)
        count = measured.rotation.size
        times, sizes = self._for_peaks(*self._key(values), count, self._length(measured))
        rotation = values[Circumstance.GAUGE_OFFSET] + measured.sides * sizes
        return values[Circumstance.RELEASE_TIME] + times, rotation

    def _key(self, values: Mapping[str, float]) -> tuple[tuple[float, ...], float]:
        parameters = tuple(values[name] for name in self.trials.places)
        return parameters, values[Circumstance.INITIAL_ROTATION]

    def _named(self, parameters: tuple[float, ...]) -> dict[str, float]:
        return dict(zip(self.trials.places, parameters, strict=True))

    def _run_history(
        self, parameters: tuple[float, ...], rotation: float, duration: float
    ) -> FreeMotion:
        system = self.trials.assembly(self._named(parameters))
        return let_go(system, rotation, duration, self._accuracy)

    def _run_peaks(
        self, parameters: tuple[float, ...], rotation: float, count: int, duration: float
    ) -> tuple[Array, Array]:
        system = self.trials.assembly(self._named(parameters))
        return first_peaks(system, rotation, count, duration, self._accuracy)

    def _length(self, measured: MeasuredPeaks) -> float:
        """Give the length of a run that is likely to have all peaks [s]."""
        if measured.time is not None:
            return 1.5 * float(measured.time[-1] - np.nanmin(measured.time))
        radius, gravity = self.trials.radius, self.trials.gravity
        return 2.0 * measured.rotation.size * math.sqrt(radius / gravity)
