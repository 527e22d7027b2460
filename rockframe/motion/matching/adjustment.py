"""One adjustment of a motion: wavelets that bring the peaks of its oscillators to the target."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockframe.motion.matching.oscillators import OscillatorPeaks, Oscillators
from rockframe.motion.matching.wavelets import wavelet_at
from rockframe.signals.arrays import Array

_ROUNDS: Final = 4
"""Rounds in which rivals of the greatest peaks come to be held down."""

_EXCESS: Final = 0.005
"""Share of the target by which a rival may exceed it before it is held down [1]."""

_LEAST_WEIGHT: Final = 0.02
"""Of a peak that is on the target, beside the misfits, which are the weights of the others [1]."""


class Adjustment(NamedTuple):
    """Wavelets, and what each of them does to each peak."""

    # one for each peak, of the height that adds its target to the peak that it moves most [m s^-2]
    wavelets: Array
    # what a wavelet, by column, adds to a peak, by row, over its target and in the peak's own
    # direction [1]
    effects: Array
    missing: Array  # what the peaks lack, over their targets [1]
    greatest: NDArray[np.bool_]  # peaks that are to come to the target; others are not to exceed it

    def amplitudes(self, regularisation: float) -> Array:
        """Compute the amplitudes of all wavelets, :eq:`eq-matching-step`."""
        from scipy import linalg as module

        linalg: Any = module
        weights = np.abs(self.missing) + _LEAST_WEIGHT
        weights = weights / np.sqrt((weights[self.greatest] ** 2).mean())
        weights[~self.greatest] = np.maximum(weights[~self.greatest], 1.0)
        held = self.greatest | (self.missing < 0.0)
        found = np.zeros(self.missing.size)
        for _ in range(_ROUNDS):
            rows = weights[held, None] * self.effects[held]
            # as many equations as peaks that are held: no more than there are wavelets
            square = rows @ rows.T
            square[np.diag_indices_from(square)] += regularisation
            driven = weights[held] * self.missing[held]
            found = rows.T @ linalg.solve(square, driven, assume_a="pos")
            exceeding = self.effects @ found > self.missing + _EXCESS
            if not (exceeding & ~held).any():
                break
            held = held | exceeding
        return found


def adjustment_of(
    oscillators: Oscillators, peaks: OscillatorPeaks, targets: Array, count: int
) -> Adjustment:
    """Make the wavelets of all peaks, and the matrix of what they do, :eq:`eq-matching-matrix`."""
    wanted = targets[peaks.oscillators]
    scaled = oscillators.influences(peaks, count) * (np.sign(peaks.values) / wanted)[:, None]
    periods = oscillators.periods[peaks.oscillators]
    wavelets = np.zeros((count, wanted.size))
    both = zip(peaks.times.tolist(), periods.tolist(), strict=True)
    for column, (time, period) in enumerate(both):
        one = wavelet_at(
            time,
            period,
            oscillators.damping_ratio,
            time_step=oscillators.time_step,
            count=count,
        )
        wavelets[one.samples, column] = one.values
    effects = scaled @ wavelets
    heights = 1.0 / np.abs(effects).max(axis=0)
    missing = 1.0 - np.abs(peaks.values) / wanted
    return Adjustment(wavelets * heights, effects * heights, missing, peaks.greatest)
