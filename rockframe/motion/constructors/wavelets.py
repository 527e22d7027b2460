"""Constructors of wavelets, and of impulses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from rockframe.motion.pulses.arguments import ArgumentReader
from rockframe.motion.pulses.harmonics import mavroeidis_papageorgiou
from rockframe.motion.pulses.impulses import impulse_duration, opposite_impulses
from rockframe.motion.pulses.wavelets import ricker
from rockframe.units import ACCELERATION, FREQUENCY, PERIOD, POSITIVE, VELOCITY, Condition, to_si

if TYPE_CHECKING:
    from rockframe.motion.value import Made
    from rockframe.units import QuantityLike, RatioLike

_AT_LEAST_ONE: Final = Condition("at least 1", lambda value: value >= 1.0)
_SHORT: Final = 0.01
"""Length of an impulse over the time between two, unless told otherwise."""


def ricker_wavelet(
    kind: type[Made], amplitude: QuantityLike, period: QuantityLike, *, antisymmetric: bool = False
) -> Made:
    """Build a Ricker wavelet: the second or third derivative of a Gaussian.

    Parameters
    ----------
    amplitude : str or Quantity
        Peak a_p: of the symmetric wavelet in its middle, of the antisymmetric one
        0.205 periods before it, followed by the opposite peak [m s^-2].
    period : str or Quantity
        T_p, one over the frequency at which its Fourier amplitude is greatest [s].
    antisymmetric : bool, optional
        The third derivative. Otherwise the second, the "Mexican hat".

    Returns
    -------
    GroundMotion
        Five periods long; at both ends 7e-16 of the amplitude is left. Exact to
        2e-13 of the amplitude. The ground comes to rest where it was.

    Raises
    ------
    UnitsError
        A wrong unit, or none.
    ComponentError
        Not finite, a period that is not positive, or `antisymmetric` is not a bool.

    Notes
    -----
    Wavelets of Ricker (1943) with the parameters of Vassiliou and Makris (2011),
    :eq:`eq-ricker-symmetric` and :eq:`eq-ricker-antisymmetric`; its velocity and
    displacement are :eq:`eq-ricker-path`.
    """
    given = ArgumentReader(kind, "ricker_wavelet", "Ricker wavelet")
    si = ricker(
        amplitude=given.quantity("amplitude", amplitude, ACCELERATION),
        period=given.quantity("period", period, PERIOD, POSITIVE),
        antisymmetric=given.switch("antisymmetric", antisymmetric),
        owner=given.owner,
    )
    return kind(si, **given.labels())


def mavroeidis_papageorgiou_pulse(
    kind: type[Made],
    velocity: QuantityLike,
    frequency: QuantityLike,
    cycles: RatioLike,
    phase: QuantityLike | None = None,
) -> Made:
    """Build a harmonic velocity under an envelope of one cosine.

    Parameters
    ----------
    velocity : str or Quantity
        Amplitude A of the velocity, reached in the middle if `phase` is
        zero [m s^-1].
    frequency : str or Quantity
        Prevailing frequency f_p [Hz].
    cycles : float
        gamma, the length over the prevailing period; at least 1 [1].
    phase : str or Quantity, optional
        Phase nu of the velocity in the middle; zero unless given [rad].

    Returns
    -------
    GroundMotion
        Exact to 1e-12 of its peak. The ground comes to rest: where it was for a
        phase of 90 degrees, or if `cycles` is a whole number beyond 1.

    Raises
    ------
    UnitsError
        A wrong unit, or none.
    ComponentError
        Not finite, a frequency that is not positive, or fewer cycles than one.

    Notes
    -----
    Pulse of Mavroeidis and Papageorgiou (2003), :eq:`eq-mp-velocity` and
    :eq:`eq-mp-acceleration`. It leaves the ground at :eq:`eq-mp-offset`.
    """
    given = ArgumentReader(
        kind, "mavroeidis_papageorgiou_pulse", "pulse of Mavroeidis and Papageorgiou"
    )
    si = mavroeidis_papageorgiou(
        velocity=given.quantity("velocity", velocity, VELOCITY),
        frequency=given.quantity("frequency", frequency, FREQUENCY, POSITIVE),
        cycles=given.ratio("cycles", cycles, _AT_LEAST_ONE),
        phase=given.phase(phase),
        owner=given.owner,
    )
    return kind(si, **given.labels())


def double_impulse(
    kind: type[Made],
    velocity: QuantityLike,
    interval: QuantityLike,
    pulse_duration: QuantityLike | None = None,
) -> Made:
    """Build two impulses: the ground starts at a velocity, and stops again.

    Parameters
    ----------
    velocity : str or Quantity
        V, exactly the change of velocity by the first impulse; the second takes it
        back [m s^-1].
    interval : str or Quantity
        Time t_0 from impulse to impulse [s].
    pulse_duration : str or Quantity, optional
        Longest length of an impulse; shortened until `interval` is a whole multiple
        of it. A hundredth of `interval` unless given [s].

    Returns
    -------
    GroundMotion
        It ends with the second impulse. The ground comes to rest
        ``velocity interval`` ahead of where it was.

    Raises
    ------
    UnitsError
        A wrong unit, or none.
    ComponentError
        Not finite, times that are not positive, impulses that overlap, or impulses
        too short to be sampled.

    Notes
    -----
    Double impulse of Kojima and Takewaki (2015), :eq:`eq-double-impulse`. Each has
    the shape :eq:`eq-impulse`, with a peak of 1.875 V over its length. An oscillator
    of the angular frequency omega takes the impulses for weaker by
    ``(omega pulse_duration)^2/56``, as long as that is small.
    """
    given = ArgumentReader(kind, "double_impulse", "double impulse")
    speed = given.quantity("velocity", velocity, VELOCITY)
    apart = given.quantity("interval", interval, PERIOD, POSITIVE, label="interval")
    longest = _SHORT * apart
    if pulse_duration is not None:
        longest = to_si(
            pulse_duration, PERIOD, owner=given.owner, name="pulse_duration", condition=POSITIVE
        )
    length = given.settled(
        "pulse_duration",
        impulse_duration(interval=apart, longest=longest, owner=given.owner),
        PERIOD,
        label="impulses of",
    )
    si = opposite_impulses(velocity=speed, interval=apart, duration=length)
    return kind(si, **given.labels())
