"""The strongest velocity pulse of a motion, and whether it makes the motion pulse-like."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Generic

from rockframe.motion.value import MotionType
from rockframe.suggestions import suggests_names
from rockframe.units import VELOCITY

if TYPE_CHECKING:
    from rockframe.units import Quantity

MIN_INDICATOR: Final = 0.85
"""Least pulse indicator of a pulse-like motion [1] (Baker 2007)."""

MIN_PEAK_VELOCITY: Final = 0.3
"""Least peak velocity of a pulse-like motion [m s^-1] (Baker 2007)."""


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
        found: list[str] = []
        if not self.indicator > MIN_INDICATOR:
            found.append(f"indicator {self.indicator:.3g} is not above {MIN_INDICATOR:g}")
        if not self.motion_start > self.pulse_start:
            found.append(
                f"the pulse arrives late: a tenth of it at {self.pulse_start.m_as('s'):.4g} s, a "
                f"fifth of the motion at {self.motion_start.m_as('s'):.4g} s"
            )
        peak = float(self.peak_velocity.m_as(str(VELOCITY.unit)))
        if not peak > MIN_PEAK_VELOCITY:
            found.append(
                f"peak velocity {peak:.3g} {VELOCITY.unit} is not above {MIN_PEAK_VELOCITY:g}"
            )
        return tuple(found)

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
