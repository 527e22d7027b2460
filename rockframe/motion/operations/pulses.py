"""The velocity pulse of a ground motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from rockframe.errors import ComponentError
from rockframe.motion.operations.derived import (
    cleared_vertical_metadata,
    derived_motion,
    dropped_pieces_note,
    shifted_start_times,
)
from rockframe.motion.processing import velocity_pulses
from rockframe.motion.quantities import as_quantity
from rockframe.motion.value import MotionType
from rockframe.motion.velocity_pulse import VelocityPulse
from rockframe.signals import Motion
from rockframe.signals.integrals import ground_path
from rockframe.signals.motion import MAXIMUM_SAMPLES, knots_of
from rockframe.suggestions import with_hints
from rockframe.units import PERIOD, POSITIVE, TIME, VELOCITY, QuantityLike, to_si

if TYPE_CHECKING:
    from rockframe.signals import Signal
    from rockframe.signals.arrays import Array

SHORTEST_PERIOD: Final = "0.25 s"
LONGEST_PERIOD: Final = "15 s"
"""Default range of periods of the search for a pulse (Shahi and Baker 2014)."""

_STEPS_PER_PERIOD: Final = 4.0


@with_hints()
def velocity_pulse(
    motion: MotionType,
    *,
    shortest_period: QuantityLike = SHORTEST_PERIOD,
    longest_period: QuantityLike = LONGEST_PERIOD,
) -> VelocityPulse[MotionType]:
    """Find the strongest pulse in the velocity, extract it, and classify it (Baker 2007).

    Parameters
    ----------
    shortest_period, longest_period : str or Quantity, optional
        Range of periods of the search [s].

    Returns
    -------
    VelocityPulse
        Period, indicator, extracted pulse and residual motion.

    Raises
    ------
    UnitsError
        A period is not a time.
    ComponentError
        The motion has no velocity; or the shortest period is not below the longest, or shorter
        than four time steps.

    Notes
    -----
    The velocity is that of the horizontal component, from rest and without correction: in a record
    with drift the pulse is as long as the record. The criteria are those for fault-normal
    components; for other ones, :meth:`HorizontalPair.velocity_pulse` finds the direction of the
    pulse first.

    Examples
    --------
    >>> import rockframe as rf
    >>> motion = rf.GroundMotion.mavroeidis_papageorgiou_pulse("80 cm/s", "0.5 Hz", 2.2, "0 deg")
    >>> print(motion.velocity_pulse())
    velocity pulse of 2.26 s about 1.997 s, indicator 1: pulse-like
    """
    owner, si = f"{type(motion).__name__}.velocity_pulse", motion.si
    dt = si.time_step
    periods = search_periods(shortest_period, longest_period, dt, owner=owner)
    velocity = ground_velocity(si.horizontal)
    if not np.any(velocity):
        msg = f"{owner}: {motion.name!r} has no velocity, and so no pulse"
        raise ComponentError(msg)
    peak = velocity_pulses.strongest_wavelet(velocity[None, :], dt, periods)
    wavelets = velocity_pulses.extract_wavelets(velocity, dt, peak)
    wavelet = velocity_pulses.sampled_wavelet(peak.period, dt)
    pulse_velocity = velocity_pulses.sum_wavelets(wavelets, wavelet, 0, velocity.size)
    measures = velocity_pulses.pulse_measures(velocity, pulse_velocity, dt)
    # zeros before and after the motion, so that all wavelets begin and end at rest
    reach = wavelet.size // 2 + 1
    before = max(0, reach - min(middle for middle, _ in wavelets))
    after = max(0, reach + max(middle for middle, _ in wavelets) + 1 - velocity.size)
    padded_velocity = velocity_pulses.sum_wavelets(
        wavelets, wavelet, -before, before + velocity.size + after
    )
    # central differences: their integral by the trapezoidal rule is zero over the whole pulse
    pulse = np.gradient(padded_velocity, dt)
    padding = before, after
    rest = np.pad(si.horizontal.samples, padding)
    vertical = None if si.vertical is None else np.pad(si.vertical.samples, padding)
    steps = (
        *dropped_pieces_note(si),
        f"{before} samples of still ground put before and {after} after it",
        f"velocity pulse of {peak.period:.6g} s about {peak.sample * dt:.6g} s: "
        f"{len(wavelets)} Daubechies wavelets (Baker 2007)",
    )
    residual = Motion.of_samples(dt, rest - pulse, vertical)
    start = shifted_start_times(motion, -before * dt)
    return VelocityPulse(
        period=as_quantity(peak.period, TIME),
        time=as_quantity(peak.sample * dt, TIME),
        peak_velocity=as_quantity(float(np.abs(velocity).max()), VELOCITY),
        peak_ratio=measures.peak_ratio,
        energy_ratio=measures.energy_ratio,
        indicator=measures.indicator,
        pulse_start=as_quantity(measures.pulse_start, TIME),
        motion_start=as_quantity(measures.motion_start, TIME),
        extracted=derived_motion(
            motion,
            Motion.of_samples(dt, pulse),
            *steps,
            "the pulse alone",
            metadata={**start, **cleared_vertical_metadata(motion)},
        ),
        residual=derived_motion(motion, residual, *steps, "the pulse taken out", metadata=start),
        lead=as_quantity(before * dt, TIME),
    )


def search_periods(
    shortest: QuantityLike, longest: QuantityLike, dt: float, *, owner: str
) -> Array:
    """Read the range of periods, and give the periods of the search [s]."""
    first, last = (
        to_si(value, PERIOD, owner=owner, name=name, condition=POSITIVE)
        for name, value in (("shortest_period", shortest), ("longest_period", longest))
    )
    if not _STEPS_PER_PERIOD * dt <= first < last:
        msg = (
            f"{owner}: shortest_period = {first:.6g} s must be below longest_period = "
            f"{last:.6g} s and at least {_STEPS_PER_PERIOD:g} time steps, "
            f"{_STEPS_PER_PERIOD * dt:.6g} s"
        )
        raise ComponentError(msg)
    if velocity_pulses.SUPPORT * last > MAXIMUM_SAMPLES * dt:
        msg = (
            f"{owner}: a wavelet of longest_period = {last:.6g} s has more than {MAXIMUM_SAMPLES} "
            f"samples at {dt:.6g} s; give a shorter one"
        )
        raise ComponentError(msg)
    return velocity_pulses.period_range(first, last)


def ground_velocity(signal: Signal) -> Array:
    """Return the velocity of the ground at the samples, from rest [m s^-1]."""
    return knots_of(ground_path(signal)[0])
