"""How a system moves after it has been let go: its rotation at any time, and its peaks."""

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from rockframe.dynamics.protocol import Start
from rockframe.signals.arrays import Array
from rockframe.solve.accuracy import Accuracy
from rockframe.solve.integrate import integrate
from rockframe.system.assembly import Assembly

SAMPLES_PER_PERIOD: Final = 100
"""Samples in the shortest period of the model, between which a cubic is drawn: its error is
(2 pi / 100)^4 / 384, or 4e-8, of a vibration's amplitude."""
_DOUBLINGS: Final = 6
"""How often a run that has too few peaks is made twice as long."""


@dataclass(frozen=True)
class FreeMotion:
    """The rotation after a release; times from then on."""

    time: Array  # samples, and every event twice: before it and after it [s], [rad]
    rotation: Array
    rate: Array  # rate of the rotation, which jumps at an event [rad s^-1]

    def at(self, time: Array) -> Array:
        """Give the rotation; before the release and after the end it stays as it is [rad]."""
        inside = np.clip(time, self.time[0], self.time[-1])
        first = np.searchsorted(self.time, inside, side="right") - 1
        first = np.clip(first, 0, self.time.size - 2)
        length = self.time[first + 1] - self.time[first]
        share = (inside - self.time[first]) / np.where(length > 0.0, length, 1.0)
        start, slope, square, cube = self._cubics(first)
        return start + share * (slope + share * (square + share * cube))

    def crossing(self) -> float:
        """Give the time of the first passage through zero; that of the end if there is none [s]."""
        beyond = np.flatnonzero(self.rotation * self.rotation[0] <= 0.0)
        return float(self.time[beyond[0] if beyond.size else -1])

    def peaks(self) -> tuple[Array, Array]:
        """Give times and sizes of the largest rotation between passages through zero."""
        side = np.sign(self.rotation)
        there = np.flatnonzero(side)
        turns = there[1:][side[there[1:]] != side[there[:-1]]]
        edges = np.concatenate([there[:1], turns])
        found = [
            self._peak(first + int(np.argmax(np.abs(self.rotation[first:end]))))
            for first, end in pairwise(edges.tolist())
        ]
        times, sizes = zip(*found, strict=True) if found else ((), ())
        return np.array(times), np.array(sizes)

    def _peak(self, node: int) -> tuple[float, float]:
        """Find the turning point next to the sample that stands highest."""
        rises = self.rate[node] * self.rotation[node] > 0.0
        first = node if rises else node - 1
        if first < 0 or self.time[first + 1] <= self.time[first]:
            return float(self.time[node]), float(abs(self.rotation[node]))
        start, slope, square, cube = (float(one[0]) for one in self._cubics(np.array([first])))
        # the root of slope + 2 square s + 3 cube s^2 that is right for a small cube as well
        discriminant = max(0.0, square * square - 3.0 * cube * slope)
        divisor = -square - math.copysign(math.sqrt(discriminant), square)
        share = min(max(slope / divisor, 0.0), 1.0) if divisor != 0.0 else 0.0
        size = abs(start + share * (slope + share * (square + share * cube)))
        length = float(self.time[first + 1] - self.time[first])
        return float(self.time[first]) + share * length, size

    def _cubics(self, first: NDArray[np.intp]) -> tuple[Array, Array, Array, Array]:
        """Give the coefficients of the cubic through rotations and rates of two samples."""
        length = self.time[first + 1] - self.time[first]
        start, step = self.rotation[first], self.rotation[first + 1] - self.rotation[first]
        leaving, arriving = self.rate[first] * length, self.rate[first + 1] * length
        square = 3.0 * step - 2.0 * leaving - arriving
        return start, leaving, square, leaving + arriving - 2.0 * step


def let_go(system: Assembly, rotation: float, duration: float, accuracy: Accuracy) -> FreeMotion:
    """Let a system go from rest at a rotation, the ground still."""
    model = system.setting.compile()
    step = 2.0 * math.pi / model.fastest_frequency / SAMPLES_PER_PERIOD
    # the last sample may stand one step before the end
    run = integrate(
        model, Start(rotation), None, accuracy, duration=duration + step, output_step=step
    )
    weights, count = model.rotation_weights, len(model.rotation_weights)
    rates = slice(count, 2 * count)
    events = run.events
    time = np.concatenate([np.repeat(events.time, 2), run.time])
    turns = np.stack([events.state_before, events.state_after], axis=1)
    state = np.concatenate([turns.reshape(-1, run.state.shape[1]), run.state])
    # a sample at the instant of an event would stand on one side of its jump only
    kept = np.ones(time.size, dtype=bool)
    kept[2 * events.time.size :] = ~np.isin(run.time, events.time[events.time > 0.0])
    order = np.argsort(time[kept], kind="stable")
    state = state[kept][order]
    return FreeMotion(time[kept][order], state[:, :count] @ weights, state[:, rates] @ weights)


def first_peaks(
    system: Assembly, rotation: float, count: int, duration: float, accuracy: Accuracy
) -> tuple[Array, Array]:
    """Let a system go, and give its first peaks."""
    motion = let_go(system, rotation, duration, accuracy)
    times, sizes = motion.peaks()
    for _ in range(_DOUBLINGS):
        if times.size >= count:
            break
        duration *= 2.0
        motion = let_go(system, rotation, duration, accuracy)
        times, sizes = motion.peaks()
    missing = (0, max(0, count - times.size))
    times = np.pad(times, missing, constant_values=motion.time[-1])
    return times[:count], np.pad(sizes, missing)[:count]
