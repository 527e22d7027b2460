"""The strongest velocity pulse of a motion, and whether it makes the motion pulse-like."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Generic

import numpy as np

from rockframe.errors import ComponentError
from rockframe.motion.operations.derived import (
    cleared_vertical_metadata,
    derived_motion,
    dropped_pieces_note,
    shifted_start_times,
)
from rockframe.motion.processing import velocity_pulses
from rockframe.motion.processing.velocity_pulses import MIN_INDICATOR, MIN_PEAK_VELOCITY
from rockframe.motion.value import MotionType
from rockframe.signals import Motion, Signal
from rockframe.signals.arrays import Array
from rockframe.signals.integrals import ground_path
from rockframe.signals.motion import MAXIMUM_SAMPLES, knots_of
from rockframe.suggestions import suggests_names, with_hints
from rockframe.units import (
    PERIOD,
    POSITIVE,
    TIME,
    VELOCITY,
    Quantity,
    QuantityLike,
    quantity,
    to_si,
)

SHORTEST_PERIOD: Final = "0.25 s"
LONGEST_PERIOD: Final = "15 s"
"""Default range of periods of the search for a pulse (Shahi and Baker 2014)."""

_STEPS_PER_PERIOD: Final = 4.0


@suggests_names
@dataclass(frozen=True)
class VelocityPulse(Generic[MotionType]):
    """The strongest pulse in the velocity of a motion.

    :meth:`GroundMotion.velocity_pulse` and :meth:`HorizontalPair.velocity_pulse` find it.

    Parameters
    ----------
    period : Quantity
        Pseudo-period T_p of its wavelets, :eq:`eq-pseudo-period` [s].
    time : Quantity
        Time of the middle of the strongest wavelet, from the start of the motion [s].
    peak_velocity : Quantity
        Peak velocity of the motion [m s^-1].
    peak_ratio, energy_ratio : float
        Peak of the residual velocity, and integral of its square, over those of the motion [1].
    indicator : float
        Pulse indicator, from 0 (no pulse) to 1, :eq:`eq-pulse-indicator` [1].
    pulse_start, motion_start : Quantity
        Times at which a tenth of the integral of the squared velocity of the pulse is reached,
        and a fifth of that of the motion [s].
    extracted, residual : GroundMotion
        The pulse alone, and the residual motion. Their sum is the motion, with zeros before and
        after it, so that the pulse begins and ends at rest.
    lead : Quantity
        Duration of the zeros before the motion in both of them [s].
    angle : Quantity or None
        Direction of the pulse of a pair of components, from the first towards the second [rad].

    Notes
    -----
    Its text (``str``) gives the period, the indicator, and the criteria that are not met.

    Examples
    --------
    >>> import rockframe as rf
    >>> pulse = rf.GroundMotion.type_a_pulse("0.5 m/s", "2 s").velocity_pulse()
    >>> print(pulse.period.round(2), pulse.pulse_like)
    3.91 second True
    """

    period: Quantity
    time: Quantity
    peak_velocity: Quantity
    peak_ratio: float
    energy_ratio: float
    indicator: float
    pulse_start: Quantity
    motion_start: Quantity
    extracted: MotionType
    residual: MotionType
    lead: Quantity
    angle: Quantity | None = None

    @property
    def unmet(self) -> tuple[str, ...]:
        """The criteria of a pulse-like motion that are not met, a sentence each."""
        criteria: list[str] = []
        if not self.indicator > MIN_INDICATOR:
            criteria.append(f"indicator {self.indicator:.3g} is not above {MIN_INDICATOR:g}")
        if not self.motion_start > self.pulse_start:
            criteria.append(
                f"the pulse arrives late: a tenth of it at {self.pulse_start.m_as('s'):.4g} s, a "
                f"fifth of the motion at {self.motion_start.m_as('s'):.4g} s"
            )
        peak = float(self.peak_velocity.m_as(str(VELOCITY.unit)))
        if not peak > MIN_PEAK_VELOCITY:
            criteria.append(
                f"peak velocity {peak:.3g} {VELOCITY.unit} is not above {MIN_PEAK_VELOCITY:g}"
            )
        return tuple(criteria)

    @property
    def pulse_like(self) -> bool:
        """Whether the motion is pulse-like: all three criteria of Baker (2007) are met."""
        return not self.unmet

    def __str__(self) -> str:
        verdict = "; ".join(self.unmet)
        return (
            f"velocity pulse of {self.period.m_as('s'):.4g} s about {self.time.m_as('s'):.4g} s, "
            f"indicator {self.indicator:.3g}: "
            + (f"not pulse-like ({verdict})" if verdict else "pulse-like")
        )


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
    peak, wavelet, wavelets, measures = velocity_pulses.extract_pulse(velocity, dt, periods)
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
        period=quantity(peak.period, TIME),
        time=quantity(peak.sample * dt, TIME),
        peak_velocity=quantity(float(np.abs(velocity).max()), VELOCITY),
        peak_ratio=measures.peak_ratio,
        energy_ratio=measures.energy_ratio,
        indicator=measures.indicator,
        pulse_start=quantity(measures.pulse_start, TIME),
        motion_start=quantity(measures.motion_start, TIME),
        extracted=derived_motion(
            motion,
            Motion.of_samples(dt, pulse),
            *steps,
            "the pulse alone",
            metadata={**start, **cleared_vertical_metadata(motion)},
        ),
        residual=derived_motion(motion, residual, *steps, "the pulse taken out", metadata=start),
        lead=quantity(before * dt, TIME),
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
