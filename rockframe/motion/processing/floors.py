"""The acceleration of a floor by superposition of the modes of a building."""

from __future__ import annotations

import math
from itertools import accumulate, chain
from typing import Final, NamedTuple

import numpy as np

from rockframe.signals.arrays import Array
from rockframe.signals.oscillator import STEPS_PER_PERIOD, fill_step

DECAY_RATIO: Final = 0.01
"""Ratio to its initial amplitude at which a free vibration ends by default [1]."""


class FloorModes(NamedTuple):
    """Modes of vibration of a building, with their participation at one floor."""

    periods: Array  # undamped periods; zero for a rigid mode [s]
    damping_ratios: Array  # damping ratios, from 0 to 1 [1]
    # participation factors times the displacement of the floor in the mode shape [1]
    participations: Array

    @property
    def participating(self) -> FloorModes:
        """The modes that are not rigid and have a participation at the floor."""
        participates = (self.periods > 0.0) & (self.participations != 0.0)
        return FloorModes(*(values[participates] for values in self))

    @property
    def rigid_participation(self) -> float:
        """Participation of the rigid motion with the ground [1]."""
        return 1.0 - math.fsum(self.participating.participations)


def interval_matrix(time_step: float, period: float, damping: float, powers: int) -> Array:
    """Compute the transition matrix of an oscillator over an interval, :eq:`eq-interval-matrix`."""
    from scipy import linalg

    parts = math.ceil(STEPS_PER_PERIOD * time_step / period)
    kappa = 2.0 * math.pi * time_step / (parts * period)
    step = np.empty((2, 2 + powers))
    fill_step(kappa, damping, step)
    both = np.zeros((2 + powers, 2 + powers))
    both[:2] = step
    both[:2, 2:] *= (time_step / parts) ** 2
    both[2:, 2:] = linalg.pascal(powers, kind="upper", exact=False)
    matrix: Array = np.linalg.matrix_power(both, parts)[:2]
    matrix[:, 2:] /= float(parts) ** np.arange(powers)
    matrix[1] /= kappa
    matrix[:, 1] *= kappa
    return matrix


def modal_acceleration(pieces: Array, time_step: float, modes: FloorModes) -> Array:
    """Compute the sum of the modes in the floor acceleration, :eq:`eq-floor-acceleration`."""
    total = np.zeros(len(pieces) + 1)
    for period, damping, participation in np.column_stack(modes).tolist():
        total += participation * _oscillator(pieces, time_step, period, damping)
    return total


def decay_time(modes: FloorModes) -> float:
    """Return the time in which all modes decay, :eq:`eq-floor-decay` [s]."""
    with np.errstate(divide="ignore"):
        periods = 1.0 - math.log(DECAY_RATIO) / (2.0 * math.pi * modes.damping_ratios)
    return max((modes.periods * periods).tolist(), default=0.0)


def _oscillator(pieces: Array, time_step: float, period: float, damping: float) -> Array:
    """Return the absolute acceleration of one oscillator, :eq:`eq-oscillator-acceleration`."""
    matrix = interval_matrix(time_step, period, damping, pieces.shape[1])
    (uu, uv), (vu, vv) = matrix[:, :2].tolist()
    driven = matrix[:, 2:] @ pieces.T

    def next_state(state: tuple[float, float], force: tuple[float, float]) -> tuple[float, float]:
        u, v = state
        return uu * u + uv * v + force[0], vu * u + vv * v + force[1]

    forces = zip(*driven.tolist(), strict=True)
    # the displacement alone, by a recursive filter, would lose digits for long periods
    states = accumulate(forces, next_state, initial=(0.0, 0.0))
    numbers = np.fromiter(chain.from_iterable(states), np.float64, 2 * len(pieces) + 2)
    frequency = 2.0 * math.pi / period
    return -(frequency**2) * (numbers[::2] + 2.0 * damping * numbers[1::2])


def uniform_modes(storeys: int, floor: int, period: float) -> tuple[Array, Array]:
    """Return the modes of equal storeys in closed form, :eq:`eq-uniform-building`."""
    angles = np.pi * np.arange(1.0, 2.0 * storeys, 2.0) / (2 * storeys + 1)
    periods = period * np.sin(0.5 * angles[0]) / np.sin(0.5 * angles)
    participations = 2.0 * np.sin(floor * angles) / ((2 * storeys + 1) * np.tan(0.5 * angles))
    return periods, participations


def building_modes(masses: Array, stiffnesses: Array, floor: int) -> tuple[Array, Array]:
    """Compute the modes of a shear building, :eq:`eq-shear-building`."""
    from scipy import linalg

    above = np.append(stiffnesses[1:], 0.0)
    stiffness = (
        np.diag(stiffnesses + above) - np.diag(above[:-1], 1) - np.diag(above[:-1], -1)
    )  # fmt: skip
    squares, shapes = linalg.eigh(stiffness, np.diag(masses))
    rounding = squares.size * np.finfo(np.float64).eps * squares.max()
    periods = 2.0 * np.pi / np.sqrt(np.where(squares > rounding, squares, np.nan))
    # shapes are of unit modal mass
    return periods, (masses @ shapes) * shapes[floor - 1]
