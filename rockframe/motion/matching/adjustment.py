"""One adjustment of a motion: wavelets that move the peaks of oscillators to the target."""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockframe.motion.processing.floors import interval_matrix
from rockframe.signals.arrays import Array
from rockframe.signals.oscillator import step_extremum

TAPER_WIDTH: Final = 1.178
"""Width of the taper at a period of one second [s] (Al Atik and Abrahamson 2010)."""

TAPER_WIDTH_EXPONENT: Final = 0.93
"""Exponent of the period in this width [1] (Al Atik and Abrahamson 2010)."""

HALF_LENGTH: Final = 4.0
"""Half the length of a wavelet over its width; there it has 10^-7 of its height [1]."""

_END_DISTANCE: Final = 3.0
"""Least distance of the wavelet from both ends over its width, which is reduced if needed [1]."""

_MIN_WIDTH: Final = 0.5
"""Least width over the period, with which the wavelet still has a full cycle [1]."""

_FADE_DURATION: Final = 0.25
"""Duration over the period in which a wavelet fades at an end of the motion [1]."""


class Wavelet(NamedTuple):
    """A wavelet at the samples of a motion."""

    first: int  # index of its first sample
    values: Array  # values from there on; zero elsewhere [1]

    @property
    def samples(self) -> slice:
        """The samples where it is not zero."""
        return slice(self.first, self.first + self.values.size)


def taper_width(period: float) -> float:
    """Compute the width of the taper, :eq:`eq-taper-width` [s]."""
    return TAPER_WIDTH * period**TAPER_WIDTH_EXPONENT


def wavelet_lead(period: float, damping_ratio: float) -> float:
    """Compute the time from the wavelet's peak to the oscillator's, :eq:`eq-wavelet-lead` [s]."""
    share = math.sqrt(1.0 - damping_ratio**2)
    return math.atan2(share, damping_ratio) * period / (2.0 * math.pi * share)


def wavelet_at(
    peak_time: float, period: float, damping_ratio: float, *, time_step: float, count: int
) -> Wavelet:
    """Make the wavelet by which an oscillator peaks at a given time, :eq:`eq-tapered-cosine`."""
    duration = (count - 1) * time_step
    edge = _MIN_WIDTH * period
    centre = min(max(peak_time - wavelet_lead(period, damping_ratio), edge), duration - edge)
    end_distance = min(centre, duration - centre)
    width = max(min(taper_width(period), end_distance / _END_DISTANCE), edge)
    first = max(math.ceil((centre - HALF_LENGTH * width) / time_step), 0)
    last = min(math.floor((centre + HALF_LENGTH * width) / time_step), count - 1)
    times = np.arange(first, last + 1) * time_step
    place = (times - centre) / width
    from_end = np.minimum(times, duration - times) / (_FADE_DURATION * period)
    taper = np.exp(-(place**2)) * np.sin(0.5 * math.pi * np.clip(from_end, 0.0, 1.0)) ** 2
    frequency = 2.0 * math.pi / period * math.sqrt(1.0 - damping_ratio**2)
    cosine = np.cos(frequency * (times - centre))
    uneven = taper * place
    zeroth, first_moment, second = taper.sum(), uneven.sum(), uneven @ place
    driven, driven_unevenly = taper @ cosine, uneven @ cosine
    determinant = zeroth * second - first_moment**2
    mean = (second * driven - first_moment * driven_unevenly) / determinant
    slope = (zeroth * driven_unevenly - first_moment * driven) / determinant
    return Wavelet(first, taper * (cosine - mean - slope * place))


_MIN_PEAK_RATIO: Final = 0.75
"""Ratio to the greatest peak from which on other peaks may come to exceed it [1]."""

_PEAKS_ALWAYS_KEPT: Final = 3
"""Number of peaks of an oscillator that are always considered."""

_MAX_PEAKS: Final = 10
"""Number of peaks of an oscillator that are considered if they exceed its target."""


class OscillatorPeaks(NamedTuple):
    """The greatest peaks of oscillators."""

    oscillators: NDArray[np.intp]  # index of the oscillator
    values: Array  # pseudo-acceleration, with its sign [m s^-2]
    times: Array  # time from the first sample [s]
    ranks: NDArray[np.intp]  # zero for the greatest of its oscillator, one for the next

    @property
    def greatest(self) -> NDArray[np.bool_]:
        """Whether each peak is the greatest of its oscillator, shape (m,)."""
        return self.ranks == 0

    @property
    def spectrum(self) -> Array:
        """The greatest pseudo-acceleration of each oscillator, shape (k,) [m s^-2]."""
        return np.abs(self.values[self.greatest])

    def select(self, chosen: NDArray[np.bool_], targets: Array) -> OscillatorPeaks:
        """Keep the greatest peaks of some oscillators, and those that exceed the target."""
        exceeding = np.abs(self.values) > targets[self.oscillators]
        selected = chosen[self.oscillators] & (exceeding | (self.ranks < _PEAKS_ALWAYS_KEPT))
        return OscillatorPeaks(
            self.oscillators[selected],
            self.values[selected],
            self.times[selected],
            self.ranks[selected],
        )


class Oscillators:
    """Linear oscillators under a ground acceleration that is linear between samples."""

    def __init__(self, periods: Array, damping_ratio: float, time_step: float) -> None:
        self.periods = periods
        self.damping_ratio = damping_ratio
        self.time_step = time_step
        self._intervals = np.array(
            [interval_matrix(time_step, period, damping_ratio, 2) for period in periods.tolist()]
        )
        # one period of free vibration after the motion, as for response spectra
        self._after = math.ceil(float(periods.max()) / time_step) + 2

    def histories(self, samples: Array) -> Array:
        """Compute the pseudo-accelerations of all oscillators, from rest, also after the motion."""
        from scipy import signal

        start, rise = self._lines(samples)
        histories = np.zeros((len(self._intervals), start.size + 1))
        for row, (interval, period) in enumerate(
            zip(self._intervals.tolist(), self.periods.tolist(), strict=True)
        ):
            (uu, uv, up, uq), (vu, vv, vp, vq) = interval
            # by the Cayley-Hamilton theorem the displacement alone obeys a recurrence of order 2
            driven = up * start + uq * rise
            driven[1:] += (uv * vp - vv * up) * start[:-1] + (uv * vq - vv * uq) * rise[:-1]
            history = signal.lfilter([1.0], [1.0, -(uu + vv), uu * vv - uv * vu], driven)
            histories[row, 1:] = (2.0 * math.pi / period) ** 2 * history
        return histories

    def peaks(self, samples: Array, histories: Array) -> OscillatorPeaks:
        """Find the greatest peaks of all oscillators, also between the samples."""
        size = np.abs(histories)
        top = size.max(axis=1, keepdims=True)
        inner = size[:, 1:-2]
        maxima = (
            (inner >= size[:, :-3]) & (inner > size[:, 2:-1]) & (inner >= _MIN_PEAK_RATIO * top)
        )
        without_maximum = np.flatnonzero(~maxima.any(axis=1))  # greatest at the end of the history
        maxima[
            without_maximum,
            np.clip(size[without_maximum].argmax(axis=1) - 1, 0, maxima.shape[1] - 1),
        ] = True
        which, places = np.nonzero(maxima)
        values, times = self._extrema(samples, histories, which, places + 1)
        order = np.lexsort((-np.abs(values), which))
        first = np.searchsorted(which, np.arange(len(histories)))
        rank = np.arange(which.size) - first[which]
        few = rank < _MAX_PEAKS
        greatest = order[few]
        return OscillatorPeaks(which[greatest], values[greatest], times[greatest], rank[few])

    def influences(self, peaks: OscillatorPeaks, count: int) -> Array:
        """Compute the contribution of each sample to each peak, :eq:`eq-sample-influence`."""
        influences = np.zeros((peaks.values.size, count))
        for place, period in enumerate(self.periods.tolist()):
            rows = np.flatnonzero(peaks.oscillators == place)
            if rows.size:
                influences[rows] = self._influences_of(period, peaks.times[rows], count)
        influences[:, [0, -1]] = 0.0
        return influences

    def _influences_of(self, period: float, times: Array, count: int) -> Array:
        step, damping = self.time_step, self.damping_ratio
        frequency = 2.0 * math.pi / period
        damped = frequency * math.sqrt(1.0 - damping**2)
        root = complex(-damping * frequency, damped)
        # complex amplitude of the oscillation under a ramp of unit slope; `line` is added below
        swing = 1j / (root**2 * damped)
        knots = np.floor(times / step).astype(int)
        decays = np.exp(root * step * np.arange(knots.max() + 1))
        kink = swing * 4.0 * np.sinh(0.5 * root * step) ** 2 / step * frequency**2

        def under_a_ramp(since: Array) -> Array:
            after = np.maximum(since, 0.0)
            line = 2.0 * damping / frequency - after
            return line + frequency**2 * np.real(swing * np.exp(root * after))

        influences = np.zeros((times.size, count))
        for row, (knot, time) in enumerate(zip(knots.tolist(), times.tolist(), strict=True)):
            early = min(knot, count)  # samples whose hat functions end before the peak
            offset = np.exp(root * (time - knot * step))
            influences[row, :early] = np.real(kink * offset * decays[knot : knot - early : -1])
            ramps = under_a_ramp(time - (knot + np.arange(-1, 3)) * step)
            for place, hat in enumerate(np.diff(ramps, 2).tolist(), start=knot):
                if place < count:
                    influences[row, place] = hat / step
        return influences

    def _lines(self, samples: Array) -> tuple[Array, Array]:
        """Return start and rise of the lines between the samples, and of zeros after the motion."""
        still = np.zeros(self._after)
        return np.append(samples[:-1], still), np.append(np.diff(samples), still)

    def _extrema(
        self,
        samples: Array,
        histories: Array,
        which: NDArray[np.intp],
        knots: NDArray[np.intp],
    ) -> tuple[Array, Array]:
        """Find values and times of the extrema next to given samples of given oscillators."""
        start, rise = self._lines(samples)
        (uu, uv, up, uq), _ = self._intervals[which].transpose(1, 2, 0)
        kappa = 2.0 * math.pi * self.time_step / self.periods[which]
        square = (kappa / self.time_step) ** 2

        def slope(at: NDArray[np.intp]) -> Array:
            driven = square * (up * start[at] + uq * rise[at])
            return kappa / uv * (histories[which, at + 1] - uu * histories[which, at] - driven)

        rows = np.where(slope(knots) * histories[which, knots] > 0.0, knots, knots - 1)
        value, end_value = histories[which, rows], histories[which, rows + 1]
        first, last = slope(rows), slope(rows + 1)
        drag, stiffness = 2.0 * self.damping_ratio * kappa, kappa**2
        second = -drag * first - stiffness * (value + start[rows])
        end_second = -drag * last - stiffness * (end_value + start[rows] + rise[rows])
        values: Any = step_extremum(value, first, second, end_value, last, end_second)
        change = first - last
        inside = np.divide(first, change, out=np.zeros_like(first), where=change != 0.0)
        return values, (rows + np.clip(inside, 0.0, 1.0)) * self.time_step


_ITERATIONS: Final = 4
"""Iterations in which lesser peaks that exceed the target are constrained, too."""

_TOLERATED_EXCESS: Final = 0.005
"""Relative excess of a lesser peak over the target up to which it is not constrained [1]."""

_MIN_WEIGHT: Final = 0.02
"""Weight of a peak without misfit; each misfit is added to it [1]."""


class Adjustment(NamedTuple):
    """Wavelets, and the effect of each of them on each peak."""

    # one for each peak, scaled so that its greatest effect is 1 [m s^-2]
    wavelets: Array
    # change of a peak (row) by a wavelet (column), over its target, positive if the peak grows [1]
    effects: Array
    misfits: Array  # target less peak, over the target [1]
    greatest: NDArray[np.bool_]  # peaks to bring to the target; others must not exceed it

    def amplitudes(self, regularisation: float) -> Array:
        """Compute the amplitudes of all wavelets, :eq:`eq-matching-step`."""
        from scipy import linalg

        weights = np.abs(self.misfits) + _MIN_WEIGHT
        weights = weights / np.sqrt((weights[self.greatest] ** 2).mean())
        weights[~self.greatest] = np.maximum(weights[~self.greatest], 1.0)
        constrained = self.greatest | (self.misfits < 0.0)
        amplitudes = np.zeros(self.misfits.size)
        for _ in range(_ITERATIONS):
            rows = weights[constrained, None] * self.effects[constrained]
            # one equation for each constrained peak, which are no more than wavelets
            square = rows @ rows.T
            square[np.diag_indices_from(square)] += regularisation
            driven = weights[constrained] * self.misfits[constrained]
            amplitudes = rows.T @ linalg.solve(square, driven, assume_a="pos")
            exceeding = self.effects @ amplitudes > self.misfits + _TOLERATED_EXCESS
            if not (exceeding & ~constrained).any():
                break
            constrained = constrained | exceeding
        return amplitudes


def make_adjustment(
    oscillators: Oscillators, peaks: OscillatorPeaks, targets: Array, count: int
) -> Adjustment:
    """Make the wavelets of all peaks, and the matrix of their effects, :eq:`eq-matching-matrix`."""
    target_values = targets[peaks.oscillators]
    scaled = oscillators.influences(peaks, count) * (np.sign(peaks.values) / target_values)[:, None]
    periods = oscillators.periods[peaks.oscillators]
    wavelets = np.zeros((count, target_values.size))
    both = zip(peaks.times.tolist(), periods.tolist(), strict=True)
    for column, (time, period) in enumerate(both):
        wavelet = wavelet_at(
            time,
            period,
            oscillators.damping_ratio,
            time_step=oscillators.time_step,
            count=count,
        )
        wavelets[wavelet.samples, column] = wavelet.values
    effects = scaled @ wavelets
    heights = 1.0 / np.abs(effects).max(axis=0)
    misfits = 1.0 - np.abs(peaks.values) / target_values
    return Adjustment(wavelets * heights, effects * heights, misfits, peaks.greatest)
