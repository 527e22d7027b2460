"""Peaks of linear oscillators without compiled code: their recurrence as a digital filter.

The matrices of a step and the extremum inside it come from :mod:`rockframe.signals.oscillator`,
the compiled counterpart; the recurrence from step to step is done by SciPy.
"""

from collections.abc import Callable
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy import signal

from rockframe.signals.arrays import Array
from rockframe.signals.motion import divided, knots_of, slopes_of
from rockframe.signals.oscillator import (
    QUANTITIES,
    STEPS_PER_PERIOD,
    fill_step,
    turning_value,
)

Rows: TypeAlias = NDArray[np.intp]


_STEPS_AT_ONCE: Final = 250_000
_KNOTS_AT_ONCE: Final = 4096


class _Steps:
    """The ground in steps of equal length, as all oscillators need it."""

    def __init__(self, length: float, pieces: Array) -> None:
        self.length = length
        self.pieces = pieces
        self.knots = length**2 * knots_of(pieces)
        slopes = slopes_of(pieces)
        self.slopes = length**2 * slopes[:, 0], length**2 * slopes.sum(axis=1)


def filter_all(pieces: Array, time_step: float, damping: float, periods: Array) -> Array:
    """Find the peaks of all oscillators, as `oscillator.march_all` does."""
    found = np.zeros((periods.size, QUANTITIES))
    state = np.zeros((periods.size, 2))
    parts = np.ceil(STEPS_PER_PERIOD * time_step / periods).astype(int)
    for count in np.unique(parts).tolist():
        oscillators = np.flatnonzero(parts == count).tolist()
        rows = max(1, _STEPS_AT_ONCE // count)
        for first in range(0, len(pieces), rows):
            steps = _Steps(time_step / count, divided(pieces[first : first + rows], count))
            for k in oscillators:
                _follow(steps, float(periods[k]), damping, state[k], found[k])
    still = np.zeros((STEPS_PER_PERIOD, pieces.shape[1]))
    for k in np.flatnonzero(_may_swing_higher(periods, damping, state, found)).tolist():
        rest = _Steps(float(periods[k]) / STEPS_PER_PERIOD, still)
        _follow(rest, float(periods[k]), damping, state[k], found[k])
    return found


def filter_pairs(
    pieces: tuple[Array, Array],
    time_step: float,
    damping: float,
    periods: Array,
    directions: Array,
) -> Array:
    """Find the peaks of all oscillators in all directions, as `oscillator.march_pairs` does."""
    found = np.zeros((periods.size, len(directions)))
    still = np.zeros((STEPS_PER_PERIOD, pieces[0].shape[1]))
    for k, period in enumerate(periods.tolist()):
        state = np.zeros((2, 2))
        parts = int(np.ceil(STEPS_PER_PERIOD * time_step / period))
        rows = max(1, _STEPS_AT_ONCE // parts)
        for first in range(0, len(pieces[0]), rows):
            steps = [
                _Steps(time_step / parts, divided(one[first : first + rows], parts))
                for one in pieces
            ]
            _follow_pair(steps, period, damping, state, directions, found[k])
        rest = _Steps(period / STEPS_PER_PERIOD, still)
        _follow_pair([rest, rest], period, damping, state, directions, found[k])
    return found


def _follow_pair(
    steps: list[_Steps],
    period: float,
    damping: float,
    state: Array,
    directions: Array,
    most: Array,
) -> None:
    """Follow an oscillator under both components; update `state` and `most`, displacements (SI)."""
    histories = np.array(
        [_histories(one, period, damping, start) for one, start in zip(steps, state, strict=True)]
    )
    state[:] = histories[:, :2, -1] / [1.0, steps[0].length]
    for first in range(0, histories.shape[2] - 1, _KNOTS_AT_ONCE):
        knots = histories[:, :, first : first + _KNOTS_AT_ONCE + 1]
        size = np.hypot(knots[0], knots[1])
        # no direction has a peak in a step above displacement plus velocity V at its end
        reach = np.flatnonzero(size[0, 1:] + size[1, 1:] > most.min())
        if reach.size == 0:
            continue
        u, v, w = np.einsum("dc,cqn->qdn", directions, knots[:, :, reach])
        next_u, next_v, next_w = np.einsum("dc,cqn->qdn", directions, knots[:, :, reach + 1])
        most[:] = np.maximum(most, np.abs(next_u).max(axis=1))
        d, n = np.nonzero((v * next_v < 0.0) & (np.abs(next_u) + np.abs(next_v) > most[:, None]))
        inside: Any = turning_value(
            u[d, n], v[d, n], w[d, n], next_u[d, n], next_v[d, n], next_w[d, n]
        )
        np.maximum.at(most, d, np.abs(inside))


def _may_swing_higher(periods: Array, damping: float, state: Array, found: Array) -> Any:
    """Tell which oscillators may pass their peaks in free vibration: their energy only falls."""
    frequency = 2.0 * np.pi / periods
    speed = np.hypot(frequency * state[:, 0], state[:, 1])
    bounds = speed[:, None] * np.column_stack(
        [1.0 / frequency, np.ones_like(frequency), (1.0 + 2.0 * damping) * frequency]
    )
    return (bounds > found).any(axis=1)


def _follow(steps: _Steps, period: float, damping: float, state: Array, greatest: Array) -> None:
    """Follow one oscillator; update `state` and its peaks in `greatest` (SI)."""
    length = steps.length
    kappa = 2.0 * np.pi * length / period
    u, v, w = _histories(steps, period, damping, state)
    stiffness, drag = kappa**2, 2.0 * damping * kappa
    pull = drag * v + stiffness * u
    rate = drag * w + stiffness * v

    def jerk(rows: Rows) -> tuple[Array, Array]:
        start, end = steps.slopes
        return -rate[rows] - start[rows], -rate[rows + 1] - end[rows]

    def bend(rows: Rows) -> tuple[Array, Array]:
        start, end = jerk(rows)
        return drag * start + stiffness * w[rows], drag * end + stiffness * w[rows + 1]

    found = (
        _peak(u, v, lambda rows: (w[rows], w[rows + 1])),
        _peak(v, w, jerk),
        _peak(pull, rate, bend),
    )
    greatest[:] = np.maximum(greatest, found / length ** np.arange(QUANTITIES))
    state[:] = u[-1], v[-1] / length


def _histories(steps: _Steps, period: float, damping: float, state: Array) -> Array:
    """Give u, V and W at the knots, shape (3, n + 1), from displacement and velocity (SI)."""
    length = steps.length
    kappa = 2.0 * np.pi * length / period
    step = np.empty((2, 2 + steps.pieces.shape[1]))
    fill_step(kappa, damping, step)
    u, v = _march(step, length**2 * step[:, 2:] @ steps.pieces.T, state * [1.0, length])
    return np.array([u, v, -2.0 * damping * kappa * v - kappa**2 * u - steps.knots])


def _march(step: Array, driven: Array, start: Array) -> tuple[Array, Array]:
    """Solve the two-by-two recurrence z(k+1) = A z(k) + d(k), one row at a time."""
    (uu, uv), (vu, vv) = step[:, :2].tolist()
    # decoupled by the theorem of Cayley and Hamilton: z(k+2) = tr A z(k+1) - det A z(k) + ...
    denominator = [1.0, -(uu + vv), uu * vv - uv * vu]
    crossed = np.array([[-vv, uv], [vu, -uu]])
    inputs = driven.copy()
    inputs[:, 1:] += crossed @ driven[:, :-1]
    first = step[:, :2] @ start
    inputs[:, 0] += first
    inputs[:, 1:2] += (crossed @ first)[:, None]
    lines: Any = signal.lfilter([1.0], denominator, inputs)
    u, v = np.concatenate([start[:, None], lines], axis=1)
    return u, v


def _peak(value: Array, slope: Array, bends: Callable[[Rows], tuple[Array, Array]]) -> float:
    """Give the greatest absolute value, at the knots and between them."""
    peak = max(float(value.max()), -float(value.min()))
    rows = np.flatnonzero(slope[:-1] * slope[1:] < 0.0)
    rows = rows[np.abs(value[rows + 1]) + np.abs(slope[rows + 1]) > peak]
    if rows.size == 0:
        return peak
    start, end = bends(rows)
    inside: Any = turning_value(
        value[rows], slope[rows], start, value[rows + 1], slope[rows + 1], end
    )
    return max(peak, float(np.max(np.abs(inside))))
