"""Peaks of linear oscillators without compiled code: their recurrence as a digital filter.

The matrices of a step and the extremum inside it come from :mod:`rockframe.signals.oscillator`,
the compiled counterpart; the recurrence from step to step is done by SciPy.
"""

from typing import Any, Final

import numpy as np
from scipy import signal

from rockframe.signals.arrays import Array
from rockframe.signals.motion import derivatives_of, subdivided
from rockframe.signals.oscillator import (
    QUANTITIES,
    STEPS_PER_PERIOD,
    extremum_bound,
    fill_step,
    step_extremum,
)

_STEPS_IN_PART: Final = 250_000
_STEPS_IN_BLOCK: Final = 4096


class _Steps:
    """The ground in steps of equal length, as all oscillators need it."""

    def __init__(self, length: float, pieces: Array) -> None:
        self.length = length
        self.pieces = pieces
        # at starts and ends of the steps, shape (2, n): the ground may jump between them
        self.ground, self.slopes = (
            length**2 * np.array([intervals[:, 0], intervals.sum(axis=1)])
            for intervals in (pieces, derivatives_of(pieces))
        )


def filter_all(pieces: Array, time_step: float, damping: float, periods: Array) -> Array:
    """Find the peaks of all oscillators, as `oscillator.march_all` does."""
    peaks = np.zeros((periods.size, QUANTITIES))
    state = np.zeros((periods.size, 2))
    parts = np.ceil(STEPS_PER_PERIOD * time_step / periods).astype(int)
    for count in np.unique(parts).tolist():
        oscillators = np.flatnonzero(parts == count).tolist()
        rows = max(1, _STEPS_IN_PART // count)
        for first in range(0, len(pieces), rows):
            steps = _Steps(time_step / count, subdivided(pieces[first : first + rows], count))
            for k in oscillators:
                _update_peaks(steps, float(periods[k]), damping, state[k], peaks[k])
    still = np.zeros((STEPS_PER_PERIOD, pieces.shape[1]))
    for k in np.flatnonzero(_may_exceed_peaks(periods, damping, state, peaks)).tolist():
        rest = _Steps(float(periods[k]) / STEPS_PER_PERIOD, still)
        _update_peaks(rest, float(periods[k]), damping, state[k], peaks[k])
    return peaks


def filter_pairs(
    pieces: tuple[Array, Array],
    time_step: float,
    damping: float,
    periods: Array,
    directions: Array,
) -> Array:
    """Find the peaks of all oscillators in all directions, as `oscillator.march_pairs` does."""
    peaks = np.zeros((periods.size, len(directions)))
    still = np.zeros((STEPS_PER_PERIOD, pieces[0].shape[1]))
    for k, period in enumerate(periods.tolist()):
        state = np.zeros((2, 2))
        parts = int(np.ceil(STEPS_PER_PERIOD * time_step / period))
        rows = max(1, _STEPS_IN_PART // parts)
        for first in range(0, len(pieces[0]), rows):
            steps = [
                _Steps(time_step / parts, subdivided(samples[first : first + rows], parts))
                for samples in pieces
            ]
            _update_direction_peaks(steps, period, damping, state, directions, peaks[k])
        rest = _Steps(period / STEPS_PER_PERIOD, still)
        _update_direction_peaks([rest, rest], period, damping, state, directions, peaks[k])
    return peaks


def _update_direction_peaks(
    steps: list[_Steps],
    period: float,
    damping: float,
    state: Array,
    directions: Array,
    peaks: Array,
) -> None:
    """Follow an oscillator under both components; update `state` and peaks of displacement (SI)."""
    states = np.array(
        [
            _states(component, period, damping, start)
            for component, start in zip(steps, state, strict=True)
        ]
    )
    for first in range(0, states.shape[3], _STEPS_IN_BLOCK):
        block = states[..., first : first + _STEPS_IN_BLOCK]
        (_, size), (_, speed), second = np.hypot(*block)
        # no direction has a larger peak in a step
        steps_of_peaks = np.flatnonzero(extremum_bound(size, speed, *second) > peaks.min())
        if steps_of_peaks.size == 0:
            continue
        u, v, w = np.einsum("dc,cqen->qedn", directions, block[..., steps_of_peaks])
        peaks[:] = np.maximum(peaks, np.abs(u[1]).max(axis=1))
        d, n = np.nonzero((v[0] * v[1] < 0.0) & (extremum_bound(u[1], v[1], *w) > peaks[:, None]))
        np.maximum.at(peaks, d, np.abs(_extrema(u[:, d, n], v[:, d, n], w[:, d, n])))


def _may_exceed_peaks(periods: Array, damping: float, state: Array, peaks: Array) -> Any:
    """Tell which oscillators may pass their peaks in free vibration: their energy only falls."""
    frequency = 2.0 * np.pi / periods
    speed = np.hypot(frequency * state[:, 0], state[:, 1])
    bounds = speed[:, None] * np.column_stack(
        [1.0 / frequency, np.ones_like(frequency), (1.0 + 2.0 * damping) * frequency]
    )
    return (bounds > peaks).any(axis=1)


def _update_peaks(steps: _Steps, period: float, damping: float, state: Array, peaks: Array) -> None:
    """Follow one oscillator; update `state` and its peaks in `peaks` (SI)."""
    kappa = 2.0 * np.pi * steps.length / period
    stiffness, drag = kappa**2, 2.0 * damping * kappa
    u, v, w = _states(steps, period, damping, state)
    rate = drag * w + stiffness * v
    jerk = -rate - steps.slopes
    extremes = (
        _peak(u, v, w),
        _peak(v, w, jerk),
        _peak(drag * v + stiffness * u, rate, drag * jerk + stiffness * w),
    )
    peaks[:] = np.maximum(peaks, extremes / steps.length ** np.arange(QUANTITIES))


def _states(steps: _Steps, period: float, damping: float, state: Array) -> Array:
    """Return u, V and W at starts and ends of steps, shape (3, 2, n); update `state` (SI)."""
    length = steps.length
    kappa = 2.0 * np.pi * length / period
    step = np.empty((2, 2 + steps.pieces.shape[1]))
    fill_step(kappa, damping, step)
    knots = _march(step, length**2 * step[:, 2:] @ steps.pieces.T, state * [1.0, length])
    state[:] = knots[:, -1] / [1.0, length]
    u, v = np.stack([knots[:, :-1], knots[:, 1:]], axis=1)
    return np.array([u, v, -2.0 * damping * kappa * v - kappa**2 * u - steps.ground])


def _march(step: Array, driven: Array, start: Array) -> Array:
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
    return np.concatenate([start[:, None], lines], axis=1)


def _peak(value: Array, slope: Array, second: Array) -> float:
    """Return the greatest absolute value in all steps, from arrays of shape (2, n)."""
    peak = float(np.abs(value).max())
    which = (slope[0] * slope[1] < 0.0) & (extremum_bound(value[1], slope[1], *second) > peak)
    inside = np.abs(_extrema(value[:, which], slope[:, which], second[:, which]))
    return float(inside.max(initial=peak))


def _extrema(value: Array, slope: Array, second: Array) -> Any:
    return step_extremum(value[0], slope[0], second[0], value[1], slope[1], second[1])
