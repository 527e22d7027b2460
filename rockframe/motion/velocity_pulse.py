"""The strongest velocity pulse of a motion, and whether it makes the motion pulse-like."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Generic

from rockframe.motion.value import Made
from rockframe.proposals import proposing
from rockframe.units import VELOCITY

if TYPE_CHECKING:
    from rockframe.units import Quantity

LEAST_INDICATOR: Final = 0.85
"""Of a motion that is pulse-like [1] (Baker 2007)."""

LEAST_PEAK_VELOCITY: Final = 0.3
"""Of a motion that is pulse-like [m s^-1] (Baker 2007)."""


@proposing
@dataclass(frozen=True)
class VelocityPulse(Generic[Made]):
    """The strongest pulse in the velocity of a motion.

    :meth:`GroundMotion.velocity_pulse` and :meth:`HorizontalPair.velocity_pulse` find it.

    Parameters
    ----------
    period : Quantity
        Tp, the pseudo-period of its wavelets, :eq:`eq-pseudo-period` [s].
    time : Quantity
        Middle of the strongest wavelet, from the start of the motion [s].
    peak_velocity : Quantity
        Of the whole motion [m s^-1].
    peak_ratio, energy_ratio : float
        Peak and integral of the square of the residual velocity, over those of the whole [1].
    indicator : float
        Pulse indicator, from 0 (no pulse) to 1, :eq:`eq-pulse-indicator` [1].
    pulse_start, motion_start : Quantity
        When a tenth of the squared velocity of the pulse is reached, and a fifth of that of the
        motion [s].
    extracted, residual : GroundMotion
        The motion of the pulse alone, and what it leaves. Together they are the motion, with
        still ground before and after it so that the pulse begins and ends at rest.
    lead : Quantity
        Length of the still ground before the motion in both of them [s].
    angle : Quantity or None
        Of a pair of components: direction of the pulse, from the first towards the
        second [rad].

    Notes
    -----
    Printed, it tells the period, the indicator, and which criteria are not met.

    Examples
    --------
    >>> import rockframe as rf
    >>> pulse = rf.GroundMotion.type_a_pulse("0.5 m/s", "2 s").velocity_pulse()
    >>> pulse.period.round(2), pulse.pulse_like
    (<Quantity(3.91, 'second')>, True)
    """

    period: Quantity
    time: Quantity
    peak_velocity: Quantity
    peak_ratio: float
    energy_ratio: float
    indicator: float
    pulse_start: Quantity
    motion_start: Quantity
    extracted: Made
    residual: Made
    lead: Quantity
    angle: Quantity | None = None

    @property
    def unmet(self) -> tuple[str, ...]:
        """What keeps the motion from being pulse-like, a sentence each."""
        found: list[str] = []
        if not self.indicator > LEAST_INDICATOR:
            found.append(f"indicator {self.indicator:.3g} is not above {LEAST_INDICATOR:g}")
        if not self.motion_start > self.pulse_start:
            found.append(
                f"the pulse arrives late: a tenth of it at {self.pulse_start.m_as('s'):.4g} s, a "
                f"fifth of the motion at {self.motion_start.m_as('s'):.4g} s"
            )
        peak = float(self.peak_velocity.m_as(str(VELOCITY.unit)))
        if not peak > LEAST_PEAK_VELOCITY:
            found.append(
                f"peak velocity {peak:.3g} {VELOCITY.unit} is not above {LEAST_PEAK_VELOCITY:g}"
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
