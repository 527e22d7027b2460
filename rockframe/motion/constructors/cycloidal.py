"""Constructors of motions that are sines and cosines."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from rockframe.motion.pulses.arguments import ArgumentReader
from rockframe.motion.pulses.harmonics import sine, type_c_phase
from rockframe.units import ACCELERATION, FREQUENCY, PERIOD, POSITIVE, VELOCITY

if TYPE_CHECKING:
    from rockframe.motion.value import Made
    from rockframe.units import QuantityLike, RatioLike

_QUARTER_TURN: Final = 0.5 * math.pi
_HIGHEST_ORDER: Final = 1000


def sine_pulse(
    kind: type[Made],
    amplitude: QuantityLike = "-9.81 m/s^2",
    frequency: QuantityLike = "1 Hz",
    cycles: RatioLike = 1,
) -> Made:
    """Build ``amplitude sin(2 pi frequency t)`` over some cycles, then nothing.

    Parameters
    ----------
    amplitude : str or Quantity, optional
        Amplitude; the defaults are those of Eq. (17) [m s^-2].
    frequency : str or Quantity, optional
        Cyclic frequency [Hz].
    cycles : float, optional
        Length over the period [1].

    Returns
    -------
    GroundMotion
        With polynomial pieces between samples: exact to 3e-13 of the amplitude.

    Raises
    ------
    UnitsError
        A wrong unit, or none.
    ComponentError
        Not finite, or a frequency or length that is not positive.
    """
    given = ArgumentReader(kind, "sine_pulse", "sine pulse")
    si = sine(
        amplitude=given.quantity("amplitude", amplitude, ACCELERATION),
        frequency=given.quantity("frequency", frequency, FREQUENCY, POSITIVE),
        cycles=given.ratio("cycles", cycles, POSITIVE),
        owner=given.owner,
    )
    return kind(si, **given.labels())


def cosine_pulse(
    kind: type[Made], amplitude: QuantityLike, frequency: QuantityLike, cycles: RatioLike = 1
) -> Made:
    """Build ``amplitude cos(2 pi frequency t)`` over some cycles, then nothing.

    Parameters
    ----------
    amplitude : str or Quantity
        Amplitude, with which the pulse begins at once [m s^-2].
    frequency : str or Quantity
        Cyclic frequency [Hz].
    cycles : float, optional
        Length over the period [1].

    Returns
    -------
    GroundMotion
        It jumps where it begins and, unless its last value is zero, where it ends.

    Raises
    ------
    UnitsError
        A wrong unit, or none.
    ComponentError
        Not finite, or a frequency or length that is not positive.

    See Also
    --------
    type_b_pulse : One cycle, given by its velocity.
    """
    given = ArgumentReader(kind, "cosine_pulse", "cosine pulse")
    si = sine(
        amplitude=given.quantity("amplitude", amplitude, ACCELERATION),
        frequency=given.quantity("frequency", frequency, FREQUENCY, POSITIVE),
        cycles=given.ratio("cycles", cycles, POSITIVE),
        phase=_QUARTER_TURN,
        owner=given.owner,
    )
    return kind(si, **given.labels())


def half_sine_pulse(kind: type[Made], amplitude: QuantityLike, duration: QuantityLike) -> Made:
    """Build ``amplitude sin(pi t/duration)``, half a cycle, then nothing.

    Parameters
    ----------
    amplitude : str or Quantity
        Peak [m s^-2].
    duration : str or Quantity
        Length, half the period [s].

    Returns
    -------
    GroundMotion
        Its ground does not stop: the velocity at the end is
        ``2 amplitude duration/pi``.

    Raises
    ------
    UnitsError
        A wrong unit, or none.
    ComponentError
        Not finite, or a duration that is not positive.
    """
    given = ArgumentReader(kind, "half_sine_pulse", "half-sine pulse")
    peak = given.quantity("amplitude", amplitude, ACCELERATION)
    length = given.quantity("duration", duration, PERIOD, POSITIVE)
    si = sine(amplitude=peak, frequency=0.5 / length, cycles=0.5, owner=given.owner)
    return kind(si, **given.labels())


def harmonic(
    kind: type[Made],
    amplitude: QuantityLike,
    frequency: QuantityLike,
    duration: QuantityLike,
    phase: QuantityLike | None = None,
) -> Made:
    """Build ``amplitude sin(2 pi frequency t + phase)`` for some time.

    Parameters
    ----------
    amplitude : str or Quantity
        Amplitude [m s^-2].
    frequency : str or Quantity
        Cyclic frequency [Hz].
    duration : str or Quantity
        Length [s].
    phase : str or Quantity, optional
        Phase at the start; zero unless given [rad].

    Returns
    -------
    GroundMotion
        With polynomial pieces between samples: exact to 3e-13 of the amplitude.

    Raises
    ------
    UnitsError
        A wrong unit, or none.
    ComponentError
        Not finite, or a frequency or duration that is not positive.
    """
    given = ArgumentReader(kind, "harmonic", "harmonic motion")
    peak = given.quantity("amplitude", amplitude, ACCELERATION)
    hertz = given.quantity("frequency", frequency, FREQUENCY, POSITIVE)
    length = given.quantity("duration", duration, PERIOD, POSITIVE)
    si = sine(
        amplitude=peak,
        frequency=hertz,
        cycles=length * hertz,
        phase=given.phase(phase),
        owner=given.owner,
    )
    return kind(si, **given.labels())


def type_a_pulse(kind: type[Made], velocity: QuantityLike, period: QuantityLike) -> Made:
    """Build the forward pulse, one sine: ``pi velocity/period sin(2 pi t/period)``.

    Parameters
    ----------
    velocity : str or Quantity
        Peak velocity v_p of the ground, at half the period [m s^-1].
    period : str or Quantity
        Period T_p, the length of the pulse [s].

    Returns
    -------
    GroundMotion
        The ground comes to rest ``velocity period/2`` ahead of where it was.

    Raises
    ------
    UnitsError
        A wrong unit, or none.
    ComponentError
        Not finite, or a period that is not positive.

    Notes
    -----
    Type A of Makris and Chang (2000), :eq:`eq-type-a`.
    """
    given = ArgumentReader(kind, "type_a_pulse", "type A pulse")
    peak = given.quantity("velocity", velocity, VELOCITY)
    length = given.quantity("period", period, PERIOD, POSITIVE)
    si = sine(
        amplitude=math.pi * peak / length,
        frequency=1.0 / length,
        cycles=1.0,
        owner=given.owner,
    )
    return kind(si, **given.labels())


def type_b_pulse(kind: type[Made], velocity: QuantityLike, period: QuantityLike) -> Made:
    """Build the forward-and-back pulse: ``2 pi velocity/period cos(2 pi t/period)``.

    Parameters
    ----------
    velocity : str or Quantity
        Peak velocity v_p of the ground, at a quarter of the period [m s^-1].
    period : str or Quantity
        Period T_p, the length of the pulse [s].

    Returns
    -------
    GroundMotion
        The ground comes to rest where it was. The acceleration jumps at both ends.

    Raises
    ------
    UnitsError
        A wrong unit, or none.
    ComponentError
        Not finite, or a period that is not positive.

    Notes
    -----
    Type B of Makris and Chang (2000), :eq:`eq-type-b`.
    """
    given = ArgumentReader(kind, "type_b_pulse", "type B pulse")
    peak = given.quantity("velocity", velocity, VELOCITY)
    length = given.quantity("period", period, PERIOD, POSITIVE)
    si = sine(
        amplitude=2.0 * math.pi * peak / length,
        frequency=1.0 / length,
        cycles=1.0,
        phase=_QUARTER_TURN,
        owner=given.owner,
    )
    return kind(si, **given.labels())


def type_c_pulse(
    kind: type[Made], velocity: QuantityLike, period: QuantityLike, order: int = 1
) -> Made:
    """Build a pulse of `order` cycles in the displacement of the ground.

    Parameters
    ----------
    velocity : str or Quantity
        v_p, the amplitude with which the velocity swings; its greatest value, backwards,
        is ``1 + sin(phi)`` times as much: 1.217 for order 1, 1.128 for order 2 [m s^-1].
    period : str or Quantity
        Period T_p; the pulse is 1.430 T_p long for order 1, 2.459 T_p for order 2 [s].
    order : int, optional
        n of the type C_n [1].

    Returns
    -------
    GroundMotion
        The ground comes to rest where it was. The acceleration jumps at both ends.

    Raises
    ------
    UnitsError
        A wrong unit, or none.
    ComponentError
        Not finite, a period that is not positive, or an order that is not a whole
        number from 1 to 1000.

    Notes
    -----
    Type C_n of Makris and Chang (2000), :eq:`eq-type-c`, with the phase phi of
    :eq:`eq-type-c-phase`.
    """
    given = ArgumentReader(kind, "type_c_pulse", "type C pulse")
    peak = given.quantity("velocity", velocity, VELOCITY)
    length = given.quantity("period", period, PERIOD, POSITIVE)
    number = given.whole("order", order, _HIGHEST_ORDER)
    phase = type_c_phase(number)
    si = sine(
        amplitude=2.0 * math.pi * peak / length,
        frequency=1.0 / length,
        cycles=number + 0.5 - phase / math.pi,
        phase=phase + _QUARTER_TURN,
        owner=given.owner,
    )
    return kind(si, **given.labels())
