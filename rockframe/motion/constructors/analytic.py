"""Constructors of analytic motions, each with title, formula, parameters, units and source."""

from __future__ import annotations

import math
from functools import partial
from typing import Final, Self

from rockframe.motion.constructors.analytic_arguments import PULSES as PULSES
from rockframe.motion.constructors.analytic_arguments import pulse_constructor
from rockframe.motion.pulses import (
    QUARTER_TURN,
    mavroeidis_papageorgiou,
    opposite_impulses,
    ricker,
    sine,
    type_c,
)
from rockframe.motion.value import MotionValue
from rockframe.units import Condition, QuantityLike, RatioLike

_AT_LEAST_ONE: Final = Condition("at least 1", lambda value: value >= 1.0)


class AnalyticMotion(MotionValue):
    """Motions in closed form, one constructor for each kind."""

    __slots__ = ()

    @classmethod
    @pulse_constructor("sine pulse", sine)
    def sine_pulse(
        cls,
        amplitude: QuantityLike = "-9.81 m/s^2",
        frequency: QuantityLike = "1 Hz",
        cycles: RatioLike = 1,
    ) -> Self:
        """Build ``amplitude sin(2 pi frequency t)`` over some cycles.

        Parameters
        ----------
        amplitude : str or Quantity, optional
            Amplitude; the defaults are those of Eq. (17) [m s^-2].
        frequency : str or Quantity, optional
            Cyclic frequency [Hz].
        cycles : float, optional
            Duration over the period [1].

        Returns
        -------
        GroundMotion
            With polynomial pieces between samples: exact to 3e-13 of the amplitude.

        Examples
        --------
        >>> import rockframe as rf
        >>> print(rf.GroundMotion.sine_pulse("3 m/s^2", "2 Hz", cycles=3).duration)
        1.5 second
        """
        ...

    @classmethod
    @pulse_constructor("cosine pulse", partial(sine, phase=QUARTER_TURN))
    def cosine_pulse(
        cls, amplitude: QuantityLike, frequency: QuantityLike, cycles: RatioLike = 1
    ) -> Self:
        """Build ``amplitude cos(2 pi frequency t)`` over some cycles.

        Parameters
        ----------
        amplitude : str or Quantity
            Amplitude, to which the acceleration jumps at the start [m s^-2].
        frequency : str or Quantity
            Cyclic frequency [Hz].
        cycles : float, optional
            Duration over the period [1].

        Returns
        -------
        GroundMotion
            It jumps at the start and, unless its last value is zero, at the end.

        See Also
        --------
        type_b_pulse : One cycle, given by its velocity.

        Examples
        --------
        >>> import rockframe as rf
        >>> print(rf.GroundMotion.cosine_pulse("3 m/s^2", "2 Hz").acceleration[0])
        3.0 meter / second ** 2
        """
        ...

    @classmethod
    @pulse_constructor(
        "half-sine pulse",
        lambda owner, amplitude, duration: sine(owner, amplitude, 0.5 / duration, 0.5),
    )
    def half_sine_pulse(cls, amplitude: QuantityLike, duration: QuantityLike) -> Self:
        """Build ``amplitude sin(pi t/duration)``, half a cycle.

        Parameters
        ----------
        amplitude : str or Quantity
            Peak [m s^-2].
        duration : str or Quantity
            Duration, half the period [s].

        Returns
        -------
        GroundMotion
            The ground has a residual velocity of ``2 amplitude duration/pi`` at the end.

        Examples
        --------
        >>> import rockframe as rf
        >>> print(rf.GroundMotion.half_sine_pulse("3 m/s^2", "0.5 s").velocity[-1].round(4))
        0.9549 meter / second
        """
        ...

    @classmethod
    @pulse_constructor(
        "harmonic motion",
        lambda owner, amplitude, frequency, duration, phase=0.0: sine(
            owner, amplitude, frequency, duration * frequency, phase
        ),
    )
    def harmonic(
        cls,
        amplitude: QuantityLike,
        frequency: QuantityLike,
        duration: QuantityLike,
        phase: QuantityLike | None = None,
    ) -> Self:
        """Build ``amplitude sin(2 pi frequency t + phase)`` of some duration.

        Parameters
        ----------
        amplitude : str or Quantity
            Amplitude [m s^-2].
        frequency : str or Quantity
            Cyclic frequency [Hz].
        duration : str or Quantity
            Duration [s].
        phase : str or Quantity, optional
            Phase at the start; zero by default [rad].

        Returns
        -------
        GroundMotion
            With polynomial pieces between samples: exact to 3e-13 of the amplitude.

        Examples
        --------
        >>> import rockframe as rf
        >>> rf.GroundMotion.harmonic("3 m/s^2", "2 Hz", "10 s", phase="90 deg").name
        'harmonic motion, 3 m/s^2, 2 Hz, 10 s, phase 1.5708 rad'
        """
        ...

    @classmethod
    @pulse_constructor(
        "type A pulse",
        lambda owner, velocity, period: sine(owner, math.pi * velocity / period, 1.0 / period, 1.0),
    )
    def type_a_pulse(cls, velocity: QuantityLike, period: QuantityLike) -> Self:
        """Build the forward pulse, one sine: ``pi velocity/period sin(2 pi t/period)``.

        Parameters
        ----------
        velocity : str or Quantity
            Peak velocity v_p of the ground, at half the period [m s^-1].
        period : str or Quantity
            Period T_p, the duration of the pulse [s].

        Returns
        -------
        GroundMotion
            The ground comes to rest with a residual displacement of ``velocity period/2``.

        Notes
        -----
        Type A of Makris and Chang (2000), :eq:`eq-type-a`.

        Examples
        --------
        >>> import rockframe as rf
        >>> print(rf.GroundMotion.type_a_pulse("0.5 m/s", "0.8 s").displacement[-1].round(4))
        0.2 meter
        """
        ...

    @classmethod
    @pulse_constructor(
        "type B pulse",
        lambda owner, velocity, period: sine(
            owner, 2.0 * math.pi * velocity / period, 1.0 / period, 1.0, QUARTER_TURN
        ),
    )
    def type_b_pulse(cls, velocity: QuantityLike, period: QuantityLike) -> Self:
        """Build the forward-and-back pulse: ``2 pi velocity/period cos(2 pi t/period)``.

        Parameters
        ----------
        velocity : str or Quantity
            Peak velocity v_p of the ground, at a quarter of the period [m s^-1].
        period : str or Quantity
            Period T_p, the duration of the pulse [s].

        Returns
        -------
        GroundMotion
            The ground comes to rest without residual displacement. The acceleration jumps at
            both ends.

        Notes
        -----
        Type B of Makris and Chang (2000), :eq:`eq-type-b`.

        Examples
        --------
        >>> import rockframe as rf
        >>> print(rf.GroundMotion.type_b_pulse("0.5 m/s", "0.8 s").velocity.max().round(4))
        0.5 meter / second
        """
        ...

    @classmethod
    @pulse_constructor("type C pulse", type_c)
    def type_c_pulse(cls, velocity: QuantityLike, period: QuantityLike, order: int = 1) -> Self:
        """Build a pulse of `order` cycles in the displacement of the ground.

        Parameters
        ----------
        velocity : str or Quantity
            Amplitude v_p of the harmonic part of the velocity. The greatest velocity, in the
            opposite direction, is ``1 + sin(phi)`` times as large: 1.217 for order 1, 1.128 for
            order 2 [m s^-1].
        period : str or Quantity
            Period T_p; the duration is 1.430 T_p for order 1, 2.459 T_p for order 2 [s].
        order : int, optional
            Order n of the type C_n [1].

        Returns
        -------
        GroundMotion
            The ground comes to rest without residual displacement. The acceleration jumps at
            both ends.

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

        Examples
        --------
        >>> import rockframe as rf
        >>> print(rf.GroundMotion.type_c_pulse("0.5 m/s", "0.8 s", order=2).duration.round(4))
        1.9672 second
        """
        ...

    @classmethod
    @pulse_constructor("Ricker wavelet", ricker)
    def ricker_wavelet(
        cls, amplitude: QuantityLike, period: QuantityLike, *, antisymmetric: bool = False
    ) -> Self:
        """Build a Ricker wavelet: the second or third derivative of a Gaussian.

        Parameters
        ----------
        amplitude : str or Quantity
            Peak a_p, in the middle of the symmetric wavelet. In the antisymmetric one it is
            0.205 periods before the middle, and the opposite peak follows [m s^-2].
        period : str or Quantity
            Period T_p, one over the frequency of the greatest Fourier amplitude [s].
        antisymmetric : bool, optional
            True for the third derivative, False for the second, the "Mexican hat".

        Returns
        -------
        GroundMotion
            Five periods long; it has 7e-16 of its amplitude at both ends. It is exact to 2e-13
            of the amplitude. The ground comes to rest without residual displacement.

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

        Examples
        --------
        >>> import rockframe as rf
        >>> print(rf.GroundMotion.ricker_wavelet("3 m/s^2", "0.8 s").peak_acceleration.round(9))
        3.0 meter / second ** 2
        """
        ...

    @classmethod
    @pulse_constructor(
        "pulse of Mavroeidis and Papageorgiou", mavroeidis_papageorgiou, cycles=_AT_LEAST_ONE
    )
    def mavroeidis_papageorgiou_pulse(
        cls,
        velocity: QuantityLike,
        frequency: QuantityLike,
        cycles: RatioLike,
        phase: QuantityLike | None = None,
    ) -> Self:
        """Build a harmonic velocity under an envelope of one cosine.

        Parameters
        ----------
        velocity : str or Quantity
            Amplitude A of the velocity, reached in the middle if `phase` is
            zero [m s^-1].
        frequency : str or Quantity
            Prevailing frequency f_p [Hz].
        cycles : float
            gamma, the duration over the prevailing period; at least 1 [1].
        phase : str or Quantity, optional
            Phase nu of the velocity in the middle; zero by default [rad].

        Returns
        -------
        GroundMotion
            Exact to 1e-12 of its peak. The ground comes to rest, without residual displacement
            for a phase of 90 degrees or if `cycles` is a whole number above 1.

        Raises
        ------
        UnitsError
            A wrong unit, or none.
        ComponentError
            Not finite, a frequency that is not positive, or fewer cycles than one.

        Notes
        -----
        Pulse of Mavroeidis and Papageorgiou (2003), :eq:`eq-mp-velocity` and
        :eq:`eq-mp-acceleration`. The residual displacement is :eq:`eq-mp-offset`.

        Examples
        --------
        >>> import rockframe as rf
        >>> pulse = rf.GroundMotion.mavroeidis_papageorgiou_pulse("0.5 m/s", "1 Hz", 2)
        >>> print(pulse.velocity.max().round(4))
        0.5 meter / second
        """
        ...

    @classmethod
    @pulse_constructor("double impulse", opposite_impulses)
    def double_impulse(
        cls,
        velocity: QuantityLike,
        interval: QuantityLike,
        pulse_duration: QuantityLike | None = None,
    ) -> Self:
        """Build two opposite impulses: the ground starts to move, and stops.

        Parameters
        ----------
        velocity : str or Quantity
            V, the exact change of velocity by the first impulse; that by the second is the
            opposite [m s^-1].
        interval : str or Quantity
            Time t_0 from impulse to impulse [s].
        pulse_duration : str or Quantity, optional
            Longest duration of an impulse; it is reduced until `interval` is a whole multiple of
            it. By default a hundredth of `interval` [s].

        Returns
        -------
        GroundMotion
            It ends with the second impulse. The ground comes to rest with a residual
            displacement of ``velocity interval``.

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
        the shape :eq:`eq-impulse`, with a peak of 1.875 V over its duration. The effect on an
        oscillator of the angular frequency omega is less than that of ideal impulses, by
        ``(omega pulse_duration)^2/56`` of it as long as this is small.

        Examples
        --------
        >>> import rockframe as rf
        >>> print(rf.GroundMotion.double_impulse("0.5 m/s", "0.8 s").displacement[-1].round(3))
        0.4 meter
        """
        ...
