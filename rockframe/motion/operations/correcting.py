"""Filters and baseline correction of ground motions."""

from __future__ import annotations

from enum import StrEnum
from typing import Final

from rockframe.arguments import checked_bool, checked_choice, checked_integer
from rockframe.errors import ComponentError
from rockframe.motion.operations.derived import (
    derived_motion,
    dropped_pieces_note,
    map_samples,
    shifted_start_times,
)
from rockframe.motion.processing.samples import (
    butterworth,
    padding_samples,
    without_baseline,
    without_drift,
)
from rockframe.motion.value import MotionType
from rockframe.signals.motion import MAXIMUM_SAMPLES
from rockframe.suggestions import with_hints
from rockframe.units import FREQUENCY, POSITIVE, QuantityLike, to_si

_HIGHEST_ORDER: Final = 12
_HIGHEST_DEGREE: Final = 20


class Baseline(StrEnum):
    """The history to which a baseline is fitted."""

    ACCELERATION = "acceleration"
    VELOCITY = "velocity"


@with_hints()
def filtered(
    motion: MotionType,
    low: QuantityLike | None = None,
    high: QuantityLike | None = None,
    *,
    order: int = 4,
    causal: bool = False,
    keep_padding: bool = False,
) -> MotionType:
    """Apply a Butterworth filter, zero-phase by default.

    Parameters
    ----------
    low : str or Quantity, optional
        Corner of the high-pass filter, below which frequencies are removed [Hz].
    high : str or Quantity, optional
        Corner of the low-pass filter, above which frequencies are removed [Hz].
    order : int, optional
        Order of each pass. A zero-phase filter has two passes, forwards and backwards, and halves
        the amplitude at a corner.
    causal : bool, optional
        Run the filter forwards only: it has no precursors, but shifts phases, and divides the
        amplitude at a corner by the square root of 2.
    keep_padding : bool, optional
        Keep the filtered zeros before and after the motion, which becomes longer. This is needed
        where velocity or displacement matter: a filter extends the motion beyond both ends, and
        without these tails the ground does not return to rest.

    Returns
    -------
    GroundMotion

    Raises
    ------
    UnitsError
        Not a frequency.
    ComponentError
        No corner, corners in the wrong order or beyond the Nyquist frequency, an order outside
        1 to 12, or `causal` or `keep_padding` is neither True nor False.

    Notes
    -----
    For a zero-phase filter the motion is padded with zeros at both ends, 1.5 order/f, and
    afterwards cut to its length unless `keep_padding` is set. f is the lowest corner, or less:
    half the width of the band, or the distance of the highest corner from the Nyquist frequency.
    A causal filter starts from rest; its padding is one zero before the motion and the rest
    after it.

    After a filter with ``low``, the velocity and displacement of a motion that was cut have a
    drift, as the tails are missing. With the padding both return to zero.

    Examples
    --------
    >>> import rockframe as rf
    >>> record = rf.GroundMotion.example("loma-prieta")
    >>> record.filtered(low="0.1 Hz", high="20 Hz").history[-1].split(",")[0]
    'Butterworth filter of order 4'
    """
    owner, si = f"{type(motion).__name__}.filtered", motion.si
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
    order = checked_integer(order, owner=owner, name="order", lowest=1, highest=_HIGHEST_ORDER)
    causal = checked_bool(causal, owner=owner, name="causal")
    keep_padding = checked_bool(keep_padding, owner=owner, name="keep_padding")
    padding = padding_samples(si.time_step, lower, upper, order)
    band = ", ".join(f"{name} corner {value:.9g} Hz" for name, value in corners.items())
    if padding > MAXIMUM_SAMPLES:
        msg = (
            f"{owner}: {band} would need {padding:.3g} zeros at each end; a corner is too low, or "
            f"too close to the other one or to the Nyquist frequency, {nyquist:.6g} Hz"
        )
        raise ComponentError(msg)
    result = map_samples(
        si,
        lambda signal: butterworth(
            si.time_step,
            signal.samples,
            low=lower,
            high=upper,
            order=order,
            causal=causal,
            keep_padding=keep_padding,
        ),
    )
    way = (
        f"forwards only, {band}, from rest"
        if causal
        else f"forwards and backwards, {band}, padded with {padding} zeros at both ends"
    )
    before = 1 if causal else padding
    kept = f", padding kept: {before} samples before and {padding} after" if keep_padding else ""
    step = f"Butterworth filter of order {order}, {way}{kept}"
    named = {name: f"{value!r} {FREQUENCY.unit}" for name, value in corners.items()}
    operation = {
        "filtered": {**named, "order": order, "causal": causal, "keep_padding": keep_padding}
    }
    start = shifted_start_times(motion, -before * si.time_step if keep_padding else 0.0)
    return derived_motion(
        motion, result, step, *dropped_pieces_note(si), operation=operation, metadata=start
    )


@with_hints()
def baseline_corrected(
    motion: MotionType, order: int = 1, *, fit: Baseline | str = Baseline.ACCELERATION
) -> MotionType:
    """Subtract a polynomial baseline, fitted to the acceleration or the velocity.

    Parameters
    ----------
    order : int, optional
        Degree of the polynomial. For the acceleration, 0 subtracts the mean and 1 a straight
        line. A polynomial of the velocity is zero at the start, so its degree is 1 or more.
    fit : {"acceleration", "velocity"}, optional
        History to which the polynomial is fitted by least squares. The derivative of a polynomial
        of the velocity is subtracted from the acceleration.

    Returns
    -------
    GroundMotion

    Raises
    ------
    ComponentError
        `order` is not a whole number up to 20, or not below the number of samples; or another
        `fit`.

    Examples
    --------
    >>> import rockframe as rf
    >>> record = rf.GroundMotion.from_arrays(([0.1, 1.1, -0.9, 0.1], "m/s^2"), time_step="0.02 s")
    >>> print(record.baseline_corrected().acceleration.round(6))
    [-0.3  0.9 -0.9  0.3] meter / second ** 2
    """
    owner, si = f"{type(motion).__name__}.baseline_corrected", motion.si
    fitted = checked_choice(Baseline, fit, owner=owner, name="fit")
    lowest = 1 if fitted is Baseline.VELOCITY else 0
    highest = min(_HIGHEST_DEGREE, len(motion) - 1)
    order = checked_integer(order, owner=owner, name="order", lowest=lowest, highest=highest)
    if fitted is Baseline.VELOCITY:
        result = map_samples(si, lambda signal: without_drift(signal.samples, order))
        step = (
            f"baseline corrected: slope of the polynomial of degree {order} through the "
            "velocity subtracted (least squares)"
        )
    else:
        result = map_samples(si, lambda signal: without_baseline(signal.samples, order))
        step = f"baseline corrected: polynomial of degree {order} subtracted (least squares)"
    operation = {"baseline_corrected": {"order": order, "fit": str(fitted)}}
    return derived_motion(motion, result, step, *dropped_pieces_note(si), operation=operation)
