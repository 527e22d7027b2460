"""The processing steps of a ground motion; each returns a new one and says what it did."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, Self, cast

import numpy as np

from rockframe.errors import ComponentError
from rockframe.motion import processing
from rockframe.motion.samples import MAXIMUM_SAMPLES, Array, MotionSI
from rockframe.motion.value import MotionValue
from rockframe.units import ACCELERATION, FREQUENCY, POSITIVE, TIME, to_ratio, to_si

if TYPE_CHECKING:
    from collections.abc import Callable

    from rockframe.motion.quantities import QuantityLike, RatioLike

_SAME_STEP: Final = 1e-9
_SNAP: Final = 1e-6
_HIGHEST_ORDER: Final = 12
_HIGHEST_DEGREE: Final = 20
_DROPPED: Final = "the analytic pieces between samples are replaced by straight lines"


class MotionOperations(MotionValue):
    """A motion that can be cut, scaled, resampled, filtered and combined."""

    __slots__ = ()

    def window(self, start: QuantityLike, end: QuantityLike) -> Self:
        """Cut a part out; its time starts at zero.

        Parameters
        ----------
        start, end : str or Quantity
            Snapped to the nearest samples [s].

        Returns
        -------
        GroundMotion

        Raises
        ------
        UnitsError
            Not a time.
        ComponentError
            Outside the motion, or fewer than two samples.
        """
        owner, si = f"{type(self).__name__}.window", self.si
        asked = {
            name: to_si(value, TIME, owner=owner, name=name)
            for name, value in (("start", start), ("end", end))
        }
        last = len(self) - 1
        places = {name: value / si.time_step for name, value in asked.items()}
        for name, place in places.items():
            # some records count their length as n dt, one step beyond the last sample
            if place < -_SNAP or place > last + 1.0 + _SNAP:
                msg = (
                    f"{owner}: {name} = {asked[name]:.6g} s is outside the motion, "
                    f"which lasts from 0 s to {si.duration:.6g} s"
                )
                raise ComponentError(msg)
        first, final = (min(max(round(places[name]), 0), last) for name in ("start", "end"))
        if final <= first:
            msg = (
                f"{owner}: end = {asked['end']:.6g} s must be at least one time step "
                f"({si.time_step:.6g} s) after start = {asked['start']:.6g} s"
            )
            raise ComponentError(msg)
        step = f"window from {first * si.time_step:.9g} s to {final * si.time_step:.9g} s"
        if any(abs(places[n] - k) > _SNAP for n, k in (("start", first), ("end", final))):
            step += f", the samples nearest to {asked['start']:.9g} s and {asked['end']:.9g} s"
        samples, between = slice(first, final + 1), slice(first, final)
        part = MotionSI(
            time_step=si.time_step,
            acceleration=si.acceleration[samples],
            vertical=None if si.vertical is None else si.vertical[samples],
            pieces=None if si.pieces is None else si.pieces[between],
            vertical_pieces=None if si.vertical_pieces is None else si.vertical_pieces[between],
        )
        operation = {
            "window": {
                name: f"{place * si.time_step!r} {TIME.unit}"
                for name, place in (("start", first), ("end", final))
            }
        }
        return self._next(part, step, operation=operation)

    def scaled(self, factor: RatioLike | None = None, *, peak: QuantityLike | None = None) -> Self:
        """Multiply the motion, both components alike.

        Parameters
        ----------
        factor : float, optional
            Factor; negative mirrors the motion [1].
        peak : str or Quantity, optional
            Instead of `factor`: the peak horizontal acceleration to reach [m s^-2].

        Returns
        -------
        GroundMotion

        Raises
        ------
        UnitsError
            Not a ratio, or not an acceleration.
        ComponentError
            Both or neither given, or a motion without any acceleration has no
            peak to scale.
        """
        owner, si = f"{type(self).__name__}.scaled", self.si
        if (factor is None) == (peak is None):
            msg = f"{owner}: give either factor or peak, for example peak='0.3 g_0'"
            raise ComponentError(msg)
        if peak is not None:
            target = to_si(peak, ACCELERATION, owner=owner, name="peak", condition=POSITIVE)
            if si.peak <= 0.0:
                msg = f"{owner}: the motion has no horizontal acceleration, so no peak to scale"
                raise ComponentError(msg)
            ratio = target / si.peak
            step = f"scaled by {ratio!r} to a peak of {target:.9g} m/s^2"
            given: dict[str, float | str] = {"peak": f"{target!r} {ACCELERATION.unit}"}
        else:
            ratio = to_ratio(factor, owner=owner, name="factor")
            step = f"scaled by {ratio!r}"
            given = {"factor": ratio}

        def times(values: Array | None) -> Array | None:
            with np.errstate(over="ignore"):
                return None if values is None else values * ratio

        with np.errstate(over="ignore"):
            larger = si.acceleration * ratio
        pieces = times(si.pieces), times(si.vertical_pieces)
        result = MotionSI(si.time_step, larger, times(si.vertical), *pieces)
        return self._next(result, step, operation={"scaled": given})

    def resampled(self, time_step: QuantityLike) -> Self:
        """Change the time step.

        Finer: read off the motion as it stands, so that the same function of
        time results where the ratio is an integer. Coarser: after a zero-phase
        low-pass filter against aliasing.

        Parameters
        ----------
        time_step : str or Quantity
            New time step [s].

        Returns
        -------
        GroundMotion

        Raises
        ------
        UnitsError
            Not a time.
        ComponentError
            Not positive, longer than the motion, or too short to be meant.
        """
        owner, si = f"{type(self).__name__}.resampled", self.si
        step = to_si(time_step, TIME, owner=owner, name="time_step", condition=POSITIVE)
        if step > si.duration:
            msg = f"{owner}: time_step = {step:.6g} s exceeds the duration, {si.duration:.6g} s"
            raise ComponentError(msg)
        if si.duration / step > MAXIMUM_SAMPLES:
            msg = (
                f"{owner}: time_step = {step:.6g} s would give more than {MAXIMUM_SAMPLES} samples"
            )
            raise ComponentError(msg)
        operation = {"resampled": {"time_step": f"{step!r} {TIME.unit}"}}
        if math.isclose(step, si.time_step, rel_tol=_SAME_STEP):
            same = f"resampled to {step!r} s: the time step that it had"
            return self._next(si, same, operation=operation)
        finer = step < si.time_step

        def anew(samples: Array, pieces: Array | None) -> Array:
            if finer:
                return processing.refined(si.time_step, samples, pieces, step)
            return processing.coarsened(si.time_step, samples, step)

        result = self._replaced(anew, step)
        how = "linear between samples" if finer else "after a zero-phase anti-alias filter"
        if finer and si.pieces is not None:
            how = "read off the analytic pieces"
        steps = [f"resampled from {si.time_step!r} s to {step!r} s, {how}"]
        rest = si.duration - result.duration
        if rest > _SNAP * step:
            steps.append(f"the last {rest:.6g} s, less than one new time step, are left out")
        return self._next(result, *steps, *self._drop_note(), operation=operation)

    def filtered(
        self,
        *,
        low: QuantityLike | None = None,
        high: QuantityLike | None = None,
        order: int = 4,
    ) -> Self:
        """Apply a zero-phase Butterworth filter.

        Parameters
        ----------
        low : str or Quantity, optional
            Frequencies below are taken out [Hz].
        high : str or Quantity, optional
            Frequencies above are taken out [Hz].
        order : int, optional
            Of each of the two passes, forwards and backwards; the amplitude at
            a corner is halved.

        Returns
        -------
        GroundMotion

        Raises
        ------
        UnitsError
            Not a frequency.
        ComponentError
            No corner, corners in the wrong order or beyond the Nyquist
            frequency, or an order outside 1 to 12.

        Notes
        -----
        The motion is padded with zeros at both ends, 1.5 order/f of the lowest
        corner f, and cut back to its length afterwards.
        """
        owner, si = f"{type(self).__name__}.filtered", self.si
        corners = {
            name: to_si(value, FREQUENCY, owner=owner, name=name, condition=POSITIVE)
            for name, value in (("low", low), ("high", high))
            if value is not None
        }
        nyquist = 0.5 / si.time_step
        lower, upper = corners.get("low"), corners.get("high")
        if not corners:
            msg = f"{owner}: give low, high or both, for example low='0.1 Hz'"
            raise ComponentError(msg)
        if lower is not None and upper is not None and lower >= upper:
            msg = f"{owner}: low = {lower:.6g} Hz must be below high = {upper:.6g} Hz"
            raise ComponentError(msg)
        for name, corner in corners.items():
            if corner >= nyquist:
                msg = (
                    f"{owner}: {name} = {corner:.6g} Hz must be below the Nyquist "
                    f"frequency, {nyquist:.6g} Hz"
                )
                raise ComponentError(msg)
        _check_whole(order, "order", 1, _HIGHEST_ORDER, owner)
        padding = processing.padding_samples(si.time_step, min(corners.values()), order)
        if padding > MAXIMUM_SAMPLES:
            msg = f"{owner}: a corner of {min(corners.values()):.6g} Hz is too low for this motion"
            raise ComponentError(msg)
        result = self._replaced(
            lambda samples, _: processing.filtered(
                si.time_step, samples, low=lower, high=upper, order=order
            )
        )
        band = ", ".join(f"{name} corner {value:.9g} Hz" for name, value in corners.items())
        step = (
            f"Butterworth filter of order {order}, forwards and backwards, {band}, "
            f"padded with {padding} zeros at both ends"
        )
        given = {name: f"{value!r} {FREQUENCY.unit}" for name, value in corners.items()}
        operation = {"filtered": {**given, "order": order}}
        return self._next(result, step, *self._drop_note(), operation=operation)

    def baseline_corrected(self, order: int = 1) -> Self:
        """Subtract the polynomial of degree `order` that fits the acceleration best.

        Parameters
        ----------
        order : int, optional
            Degree; 0 takes the mean away, 1 a straight line.

        Returns
        -------
        GroundMotion

        Raises
        ------
        ComponentError
            Not a whole number from 0 to 20, or not below the number of samples.
        """
        owner = f"{type(self).__name__}.baseline_corrected"
        _check_whole(order, "order", 0, min(_HIGHEST_DEGREE, len(self) - 1), owner)
        result = self._replaced(lambda samples, _: processing.without_baseline(samples, order))
        step = f"baseline corrected: polynomial of degree {order} subtracted (least squares)"
        operation = {"baseline_corrected": {"order": order}}
        return self._next(result, step, *self._drop_note(), operation=operation)

    def with_vertical(self, other: MotionValue) -> Self:
        """Add a vertical motion: the horizontal component of another one, upwards.

        Parameters
        ----------
        other : GroundMotion
            Of the same time step; the shorter of the two is padded with zeros.

        Returns
        -------
        GroundMotion

        Raises
        ------
        ComponentError
            Not a motion, or another time step.
        """
        owner, si = f"{type(self).__name__}.with_vertical", self.si
        given = cast("object", other)
        if not isinstance(given, MotionValue):
            msg = f"{owner}: other needs a GroundMotion, got {type(given).__name__}"
            raise ComponentError(msg)
        theirs = other.si
        if not math.isclose(theirs.time_step, si.time_step, rel_tol=_SAME_STEP):
            msg = (
                f"{owner}: time steps differ, {si.time_step!r} s and {theirs.time_step!r} s; "
                f"resample one, for example other.resampled('{si.time_step!r} s')"
            )
            raise ComponentError(msg)
        count = max(len(self), len(other))
        across, pieces = processing.padded(si.acceleration, si.pieces, count)
        upwards, vertical_pieces = processing.padded(theirs.acceleration, theirs.pieces, count)
        verb = "vertical component" if si.vertical is None else "vertical component replaced:"
        steps = [f"{verb} {other.name} (sha256 {other.sha256[:12]})"]
        for label, motion in (("horizontal", self), ("vertical", other)):
            if len(motion) < count:
                steps.append(f"{label} component padded with {count - len(motion)} zeros")
        result = MotionSI(si.time_step, across, upwards, pieces, vertical_pieces)
        about = {f"vertical_{key}": value for key, value in other.metadata.items()}
        known = None if other._recipe is None else dict(other._recipe)
        operation = None if known is None else {"with_vertical": {"other": known}}
        return self._next(result, *steps, operation=operation, metadata=about)

    def _replaced(
        self, change: Callable[[Array, Array | None], Array], time_step: float | None = None
    ) -> MotionSI:
        si = self.si
        vertical = None if si.vertical is None else change(si.vertical, si.vertical_pieces)
        step = si.time_step if time_step is None else time_step
        return MotionSI(step, change(si.acceleration, si.pieces), vertical)

    def _drop_note(self) -> tuple[str, ...]:
        analytic = self.si.pieces is not None or self.si.vertical_pieces is not None
        return (_DROPPED,) if analytic else ()


def _check_whole(value: object, name: str, lowest: int, highest: int, owner: str) -> None:
    if isinstance(value, bool) or not isinstance(value, int) or not lowest <= value <= highest:
        msg = f"{owner}: {name} must be a whole number from {lowest} to {highest}, got {value!r}"
        raise ComponentError(msg)
