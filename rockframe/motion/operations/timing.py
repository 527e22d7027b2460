"""Windows and resampling of ground motions."""

from __future__ import annotations

import math
from dataclasses import replace
from enum import StrEnum
from typing import Final

import numpy as np

from rockframe.arguments import checked_choice
from rockframe.errors import ComponentError
from rockframe.motion.operations.derived import (
    SAME_STEP,
    derived_motion,
    dropped_pieces_note,
    map_samples,
    shifted_start_times,
)
from rockframe.motion.processing.samples import (
    MAX_DIVISIONS,
    band_limited,
    division_count,
    downsampled,
    integer_ratio,
    refined,
    tapered,
)
from rockframe.motion.value import MotionType
from rockframe.signals import Signal
from rockframe.signals.arrays import Array
from rockframe.signals.motion import MAXIMUM_SAMPLES
from rockframe.suggestions import with_hints
from rockframe.units import POSITIVE, TIME, TIME_STEP, QuantityLike, to_si

_ROUNDING: Final = 1e-6


class Interpolation(StrEnum):
    """Interpolation between the samples of a record, for a finer time step."""

    BAND_LIMITED = "band-limited"
    LINEAR = "linear"


_METHOD_NOTES: Final = {
    Interpolation.BAND_LIMITED: "without anything beyond the old Nyquist frequency",
    Interpolation.LINEAR: "linear between samples",
}


@with_hints()
def window(
    motion: MotionType,
    start: QuantityLike | None = None,
    end: QuantityLike | None = None,
    *,
    taper: QuantityLike | None = None,
) -> MotionType:
    """Cut out a part of the motion, optionally with tapers; its time starts at zero.

    Parameters
    ----------
    start, end : str or Quantity, optional
        Start and end of the part, rounded to the nearest samples; those of the motion unless
        given [s].
    taper : str or Quantity, optional
        Duration of the cosine tapers at both ends, over which the acceleration grows from zero
        and decays to zero [s].

    Returns
    -------
    GroundMotion

    Raises
    ------
    UnitsError
        Not a time.
    ComponentError
        `start` or `end` is outside the motion, the part has fewer than two samples, or both
        tapers are not positive or longer than the part.

    Examples
    --------
    >>> import rockframe as rf
    >>> print(rf.GroundMotion.example("loma-prieta").window("2 s", "12 s").duration)
    10.0 second
    """
    owner, si = f"{type(motion).__name__}.window", motion.si
    ends = {
        name: own if value is None else to_si(value, TIME, owner=owner, name=name)
        for name, value, own in (("start", start, 0.0), ("end", end, si.duration))
    }
    last = len(motion) - 1
    places = {name: value / si.time_step for name, value in ends.items()}
    for name, place in places.items():
        # the length of some records is n dt, one step beyond the last sample
        if place < -_ROUNDING or place > last + 1.0 + _ROUNDING:
            msg = (
                f"{owner}: {name} = {ends[name]:.6g} s is outside the motion, "
                f"which lasts from 0 s to {si.duration:.6g} s"
            )
            raise ComponentError(msg)
    first, final = (min(max(round(places[name]), 0), last) for name in ("start", "end"))
    if final <= first:
        msg = (
            f"{owner}: end = {ends['end']:.6g} s must be at least one time step "
            f"({si.time_step:.6g} s) after start = {ends['start']:.6g} s"
        )
        raise ComponentError(msg)
    step = f"window from {first * si.time_step:.9g} s to {final * si.time_step:.9g} s"
    if any(abs(places[n] - k) > _ROUNDING for n, k in (("start", first), ("end", final))):
        step += f", the samples nearest to {ends['start']:.9g} s and {ends['end']:.9g} s"
    part = si.each(lambda signal: _sub_signal(signal, first, final))
    values = {name: f"{value!r} {TIME.unit}" for name, value in ends.items()}
    steps = [step]
    if taper is not None:
        length = to_si(taper, TIME, owner=owner, name="taper", condition=POSITIVE)
        if 2.0 * length > part.duration * (1.0 + _ROUNDING):
            msg = (
                f"{owner}: two tapers of {length:.6g} s are longer than the window, "
                f"{part.duration:.6g} s"
            )
            raise ComponentError(msg)
        values["taper"] = f"{length!r} {TIME.unit}"
        steps += [
            f"tapered over {length!r} s at both ends, half a cosine",
            *dropped_pieces_note(si),
        ]
        part = map_samples(part, lambda signal: tapered(signal.samples, length / si.time_step))
    changes = shifted_start_times(motion, first * si.time_step)
    return derived_motion(motion, part, *steps, operation={"window": values}, metadata=changes)


def _sub_signal(signal: Signal, first: int, final: int) -> Signal:
    """Cut out the part between two samples, both included."""
    samples = signal.samples[first : final + 1]
    if signal.polynomials is None:
        return replace(signal, samples=samples)
    pieces = signal.polynomials[first:final]
    # a pulse that is padded with zeros may jump here: the value before is not in the part
    samples = np.append(pieces[0, 0], samples[1:])
    return replace(signal, samples=samples, polynomials=pieces)


@with_hints()
def resampled(
    motion: MotionType,
    time_step: QuantityLike,
    *,
    interpolation: Interpolation | str = Interpolation.BAND_LIMITED,
) -> MotionType:
    """Change the time step.

    A finer motion is interpolated: band-limited, without frequencies beyond the Nyquist frequency
    of the samples, or linearly; an analytic motion is evaluated. For a coarser motion a zero-phase
    low-pass filter prevents aliasing.

    Parameters
    ----------
    time_step : str or Quantity
        New time step [s].
    interpolation : {"band-limited", "linear"}, optional
        Interpolation between the samples of a record, for a finer time step. Simulations
        interpolate linearly, so ``"linear"`` does not change their results.

    Returns
    -------
    GroundMotion

    Raises
    ------
    UnitsError
        Not a time.
    ComponentError
        The time step is not positive, longer than the motion or too short, or another
        interpolation.

    Examples
    --------
    >>> import rockframe as rf
    >>> record = rf.GroundMotion.from_arrays(([0.0, 1.0, -1.0], "m/s^2"), time_step="0.02 s")
    >>> print(record.resampled("0.01 s").acceleration.round(2))
    [0.0 0.7 1.0 0.2 -1.0] meter / second ** 2
    """
    owner, si = f"{type(motion).__name__}.resampled", motion.si
    method = checked_choice(Interpolation, interpolation, owner=owner, name="interpolation")
    step = to_si(time_step, TIME_STEP, owner=owner, name="time_step", condition=POSITIVE)
    if step > si.duration:
        msg = f"{owner}: time_step = {step:.6g} s exceeds the duration, {si.duration:.6g} s"
        raise ComponentError(msg)
    if si.duration / step > MAXIMUM_SAMPLES:
        msg = f"{owner}: time_step = {step:.6g} s would give more than {MAXIMUM_SAMPLES} samples"
        raise ComponentError(msg)
    values = {"time_step": f"{step!r} {TIME.unit}", "interpolation": str(method)}
    operation = {"resampled": values}
    if math.isclose(step, si.time_step, rel_tol=SAME_STEP):
        same = f"resampled to {step!r} s: the time step that it had"
        return derived_motion(motion, si, same, operation=operation, same_spectrum=True)
    is_finer = step < si.time_step

    def resample_signal(signal: Signal) -> Array:
        if not is_finer:
            return downsampled(si.time_step, signal.samples, step)
        if not signal.analytic and method is Interpolation.BAND_LIMITED:
            if division_count(si.time_step / step) > MAX_DIVISIONS:
                msg = (
                    f"{owner}: time_step = {step:.6g} s is too short compared with that of the "
                    f"record, {si.time_step:.6g} s; interpolation='linear' needs no filter"
                )
                raise ComponentError(msg)
            return band_limited(si.time_step, signal.samples, step)
        return refined(signal, step)

    result = map_samples(si, resample_signal, step)
    same_function = (
        not si.analytic
        and method is Interpolation.LINEAR
        and integer_ratio(si.time_step / step) is not None
    )
    how = _METHOD_NOTES[method] if is_finer else "after a zero-phase anti-alias filter"
    if is_finer and si.horizontal.analytic:
        how = "read off the analytic pieces"
    steps = [f"resampled from {si.time_step!r} s to {step!r} s, {how}"]
    rest = si.duration - result.duration
    if rest > _ROUNDING * step:
        steps.append(f"the last {rest:.6g} s, less than one new time step, are left out")
    return derived_motion(
        motion,
        result,
        *steps,
        *dropped_pieces_note(si),
        operation=operation,
        same_spectrum=same_function,
    )
