"""Scaling of ground motions."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from rockframe.errors import ComponentError
from rockframe.motion.operations.derived import VERTICAL_PREFIX, derived_motion
from rockframe.motion.processing.samples import warn_of_coarse_samples
from rockframe.motion.value import MotionType
from rockframe.records import DOWNWARDS, SENSE, UPWARDS
from rockframe.signals import Motion, Signal
from rockframe.signals.integrals import ground_path
from rockframe.signals.motion import absolute_peak
from rockframe.signals.spectra import DAMPING_RATIO, check_cost, pseudo_spectra, spectral_peaks
from rockframe.suggestions import with_hints
from rockframe.units import (
    ACCELERATION,
    PERIOD,
    POSITIVE,
    TIME,
    VELOCITY,
    QuantityLike,
    RatioLike,
    to_ratio,
    to_si,
)

_OPPOSITE: Final = {UPWARDS: DOWNWARDS, DOWNWARDS: UPWARDS}
_USUAL_DAMPING: Final = 0.05
_TARGETS: Final = {
    "peak": ("a peak", ACCELERATION),
    "peak_velocity": ("a peak velocity", VELOCITY),
    "spectral_acceleration": ("a pseudo-spectral acceleration", ACCELERATION),
}


@with_hints()
def scaled(
    motion: MotionType,
    factor: RatioLike | None = None,
    *,
    peak: QuantityLike | None = None,
    peak_velocity: QuantityLike | None = None,
    spectral_acceleration: QuantityLike | None = None,
    period: QuantityLike | None = None,
    damping_ratio: RatioLike | None = None,
) -> MotionType:
    """Multiply both components of the motion by a factor.

    Give one of `factor`, `peak`, `peak_velocity` and `spectral_acceleration`.

    Parameters
    ----------
    factor : float, optional
        Factor; a negative one reverses the motion [1].
    peak : str or Quantity, optional
        Peak horizontal acceleration of the scaled motion [m s^-2].
    peak_velocity : str or Quantity, optional
        Peak horizontal velocity of the scaled motion, from rest at the start [m s^-1].
    spectral_acceleration : str or Quantity, optional
        Horizontal pseudo-spectral acceleration of the scaled motion at `period` [m s^-2].
    period : str or Quantity, optional
        Period of the oscillator for `spectral_acceleration` [s].
    damping_ratio : float, optional
        Damping ratio of this oscillator; 0.05 by default [1].

    Returns
    -------
    GroundMotion

    Raises
    ------
    UnitsError
        Not a ratio, an acceleration, a velocity or a time.
    ComponentError
        None or several of the targets are given; `period` or `damping_ratio` is given without
        `spectral_acceleration`, or that without `period`; a value out of range; or a motion without
        acceleration, which cannot be scaled to a target.

    Warns
    -----
    RecordWarning
        `period` is shorter than ten time steps of a record.

    Examples
    --------
    >>> import rockframe as rf
    >>> pulse = rf.GroundMotion.sine_pulse("3 m/s^2", "2 Hz")
    >>> print(pulse.scaled(2).peak_acceleration.round(9))
    6.0 meter / second ** 2
    >>> print(pulse.scaled(peak="0.5 g_0").peak_acceleration.to("g_0").round(9))
    0.5 standard_gravity
    """
    owner = f"{type(motion).__name__}.scaled"
    targets = {
        "factor": factor,
        "peak": peak,
        "peak_velocity": peak_velocity,
        "spectral_acceleration": spectral_acceleration,
    }
    values = {name: value for name, value in targets.items() if value is not None}
    if len(values) != 1:
        msg = f"{owner}: give one of {', '.join(targets)}, for example peak='0.3 g_0'"
        raise ComponentError(msg)
    if (period is None) != (spectral_acceleration is None) or (
        damping_ratio is not None and spectral_acceleration is None
    ):
        msg = f"{owner}: give spectral_acceleration and period together (damping_ratio is optional)"
        raise ComponentError(msg)
    if factor is not None:
        ratio = to_ratio(factor, owner=owner, name="factor", example="2, or peak='0.3 g_0'")
        return _scale_motion(motion, ratio, f"scaled by {ratio!r}", {"factor": ratio})
    ((name, value),) = values.items()
    what, measure = _TARGETS[name]
    target = to_si(value, measure, owner=owner, name=name, condition=POSITIVE)
    words = f"{what} of {target:.9g} {measure.unit}"
    arguments: dict[str, float | str] = {name: f"{target!r} {measure.unit}"}
    horizontal = motion.si.horizontal
    if peak is not None:
        current = absolute_peak(horizontal.pieces)
    elif peak_velocity is not None:
        current = absolute_peak(ground_path(horizontal)[0])
    else:
        seconds = to_si(period, PERIOD, owner=owner, name="period", condition=POSITIVE)
        given_damping = _USUAL_DAMPING if damping_ratio is None else damping_ratio
        damping = to_ratio(
            given_damping, owner=owner, name="damping_ratio", condition=DAMPING_RATIO
        )
        current = _pseudo_acceleration(horizontal, seconds, damping, owner)
        words += f" at {seconds:.9g} s, damping ratio {damping:.9g}"
        arguments |= {"period": f"{seconds!r} {TIME.unit}", "damping_ratio": damping}
    if current <= 0.0:
        msg = f"{owner}: the motion has no horizontal acceleration that could be scaled"
        raise ComponentError(msg)
    ratio = target / current
    return _scale_motion(motion, ratio, f"scaled by {ratio!r} to {words}", arguments)


def scaled_components(motion: Motion, ratio: float) -> Motion:
    """Multiply the accelerations of both components."""
    return motion.each(lambda signal: scaled_signal(signal, ratio))


def scaled_signal(signal: Signal, ratio: float) -> Signal:
    """Multiply the accelerations of one component."""
    with np.errstate(over="ignore"):
        pieces = None if signal.polynomials is None else signal.polynomials * ratio
        return replace(signal, samples=signal.samples * ratio, polynomials=pieces)


def _scale_motion(
    motion: MotionType, ratio: float, step: str, values: dict[str, float | str]
) -> MotionType:
    added: dict[str, str | float] = {}
    known = motion.metadata
    sense, azimuth, component = (known.get(key) for key in (SENSE, "azimuth", "component"))
    # a negative factor reverses the positive direction
    if ratio < 0.0 and sense in _OPPOSITE:
        added[SENSE] = _OPPOSITE[str(sense)]
    if ratio < 0.0 and isinstance(azimuth, int | float):
        added["azimuth"] = (azimuth + 180.0) % 360.0
    if ratio < 0.0 and component is not None:  # no name from which the old direction is read
        name = str(component)
        added["component"] = name[1:] if name.startswith("-") else f"-{name}"
    prefixes = ("",) if motion.si.vertical is None else ("", VERTICAL_PREFIX)
    for name in (f"{prefix}scale_factor" for prefix in prefixes):
        factor = known.get(name)
        added[name] = ratio * (factor if isinstance(factor, int | float) else 1.0)
    return derived_motion(
        motion, scaled_components(motion.si, ratio), step, operation={"scaled": values},
        metadata=added, same_spectrum=abs(ratio) == 1.0,
    )  # fmt: skip


def _pseudo_acceleration(signal: Signal, seconds: float, damping: float, owner: str) -> float:
    periods = np.array([seconds])
    check_cost(signal, periods, owner=owner)
    warn_of_coarse_samples([signal], seconds, owner=owner)
    displacement = spectral_peaks(signal, periods, damping)[:, 0]
    return float(pseudo_spectra(signal, periods, displacement)[1][0])
