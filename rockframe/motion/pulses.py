"""Analytic motions as samples with quintic polynomials between them.

Sines and their sums, Ricker wavelets, and impulses of short duration. The samples are so dense
that the interpolation error is negligible in simulations.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Final, NamedTuple, TypeAlias

import numpy as np

from rockframe.errors import ComponentError
from rockframe.signals import Motion, Signal
from rockframe.signals.arrays import Array
from rockframe.signals.motion import MAXIMUM_SAMPLES

Shape: TypeAlias = Callable[[Array, float], tuple[Array, Array, Array]]
"""Function of places x and their step h: gives a, a' h and a'' h^2 at these places [m s^-2].

Places and step are times over the period; derivatives are by x.
"""


def sampled_motion(
    shape: Shape, *, length: float, frequency: float, intervals: int, owner: str
) -> Motion:
    """Sample a function that is smooth from the start to the end of the motion."""
    if length * intervals > MAXIMUM_SAMPLES:
        msg = f"{owner}: {length:.6g} cycles are more than can be sampled; shorten the motion"
        raise ComponentError(msg)
    count = max(1, math.ceil(length * intervals))
    step = length / count
    time_step = step / frequency
    if not (math.isfinite(time_step) and time_step > 0.0):
        msg = f"{owner}: a frequency of {frequency!r} Hz is outside what can be sampled"
        raise ComponentError(msg)
    places = np.arange(count + 1) * length / count
    with np.errstate(over="ignore", invalid="ignore"):
        value, slope, curvature = shape(places, step)
        pieces = hermite_pieces(value, slope, curvature)
    return Motion(Signal(time_step, value, pieces))


def hermite_pieces(value: Array, slope: Array, curvature: Array) -> Array:
    """Compute quintic Hermite polynomials from nodal values and derivatives."""
    start, s0, c0 = value[:-1], slope[:-1], curvature[:-1]
    rise = value[1:] - start - s0 - 0.5 * c0
    slope_change = slope[1:] - s0 - c0
    curvature_change = curvature[1:] - c0
    return np.column_stack(
        [
            start,
            s0,
            0.5 * c0,
            10.0 * rise - 4.0 * slope_change + 0.5 * curvature_change,
            -15.0 * rise + 7.0 * slope_change - curvature_change,
            6.0 * rise - 3.0 * slope_change + 0.5 * curvature_change,
        ]
    )


INTERVALS_PER_CYCLE: Final = 128
"""Quintic pieces per cycle; the error is (2 pi/128)^6/(64 * 720) = 3.0e-13 of the amplitude."""

QUARTER_TURN: Final = 0.5 * math.pi
_HALF: Final = 0.5
_QUARTER: Final = 0.25
_PHASE_ITERATIONS: Final = 20


class _Sine(NamedTuple):
    """``amplitude sin(2 pi (ratio x + start))``; x is the time over the period."""

    amplitude: float
    ratio: float
    start: float


def sine(
    owner: str, amplitude: float, frequency: float, cycles: float, phase: float = 0.0
) -> Motion:
    """Build ``a(t) = amplitude sin(2 pi frequency t + phase)``."""
    return sampled_motion(
        _sine_sum([_Sine(amplitude, 1.0, phase / (2.0 * math.pi))]),
        length=cycles,
        frequency=frequency,
        intervals=INTERVALS_PER_CYCLE,
        owner=owner,
    )


def type_c(owner: str, velocity: float, period: float, order: int) -> Motion:
    """Build ``a(t)`` of a pulse of type C_n, :eq:`eq-type-c`."""
    phase = type_c_phase(order)
    cycles = order + _HALF - phase / math.pi
    amplitude = 2.0 * math.pi * velocity / period
    return sine(owner, amplitude, 1.0 / period, cycles, phase + QUARTER_TURN)


def type_c_phase(order: int) -> float:
    """Find the phase of a type C pulse after which the ground has no residual displacement.

    It is the root of :eq:`eq-type-c-phase` in (0, pi/2).
    """
    phase = 0.0
    for _ in range(_PHASE_ITERATIONS):  # each reduces the error at least by a factor of 21
        phase = math.atan(1.0 / ((order + _HALF) * math.pi - phase))
    return phase


def mavroeidis_papageorgiou(
    owner: str, velocity: float, frequency: float, cycles: float, phase: float = 0.0
) -> Motion:
    """Build the pulse of Mavroeidis and Papageorgiou as a sum of three sines, :eq:`eq-mp-sines`."""
    amplitude = -math.pi * frequency * velocity
    start = phase / (2.0 * math.pi)

    def part(share: float, ratio: float) -> _Sine:
        return _Sine(share * ratio * amplitude, ratio, start - _HALF * cycles * ratio)

    faster, slower = 1.0 + 1.0 / cycles, 1.0 - 1.0 / cycles
    return sampled_motion(
        _sine_sum([part(1.0, 1.0), part(_HALF, faster), part(_HALF, slower)]),
        length=cycles,
        frequency=frequency,
        intervals=math.ceil(faster * INTERVALS_PER_CYCLE),
        owner=owner,
    )


def sine_of_cycles(cycles: Array) -> Array:
    """Compute sin(2 pi x), exactly zero at multiples of one half."""
    rest = cycles - np.round(cycles)
    folded = np.where(np.abs(rest) > _QUARTER, np.copysign(_HALF, rest) - rest, rest)
    return np.sin(2.0 * math.pi * folded)


def _sine_sum(parts: Sequence[_Sine]) -> Shape:
    def shape(places: Array, step: float) -> tuple[Array, Array, Array]:
        value, slope, curvature = _sine_samples(parts[0], places, step)
        for part in parts[1:]:
            more = _sine_samples(part, places, step)
            value, slope, curvature = value + more[0], slope + more[1], curvature + more[2]
        return value, slope, curvature

    return shape


def _sine_samples(part: _Sine, places: Array, step: float) -> tuple[Array, Array, Array]:
    cycles = part.ratio * places + part.start
    value = part.amplitude * sine_of_cycles(cycles)
    angle = 2.0 * math.pi * part.ratio * step  # omega dt
    slope = part.amplitude * sine_of_cycles(cycles + _QUARTER) * angle
    return value, slope, -value * angle**2


INTERVALS_PER_PERIOD: Final = 256
"""Quintic pieces per period; the error is at most 6e-14 of the amplitude, 105 h^6/(64 * 720)."""

PERIODS_PER_SIDE: Final = 2.5
"""Periods from the centre to both ends, where the wavelet has 7e-16 of its amplitude."""

_SQUARED_PEAK_PLACE: Final = 3.0 - math.sqrt(6.0)
"""Square of the x at which the magnitude of He_3(x) exp(-x^2/2) is greatest."""


class _GaussianDerivative(NamedTuple):
    """``sign He_n(x) exp(-x^2/2) / peak``, He_n the Hermite polynomial of degree n."""

    degree: int
    sign: float
    peak: float


SYMMETRIC: Final = _GaussianDerivative(2, -1.0, 1.0)
ANTISYMMETRIC: Final = _GaussianDerivative(
    3, 1.0, math.sqrt(6.0 * _SQUARED_PEAK_PLACE) * math.exp(-0.5 * _SQUARED_PEAK_PLACE)
)


def ricker(owner: str, amplitude: float, period: float, antisymmetric: bool) -> Motion:
    """Build a Ricker wavelet, :eq:`eq-ricker-symmetric` or :eq:`eq-ricker-antisymmetric`."""
    kind = ANTISYMMETRIC if antisymmetric else SYMMETRIC
    scale = 2.0 * math.pi / math.sqrt(kind.degree)  # x over t/T_p
    height = kind.sign * amplitude / kind.peak

    def shape(places: Array, step: float) -> tuple[Array, Array, Array]:
        place = scale * (places - PERIODS_PER_SIDE)
        bell = np.exp(-0.5 * place**2)
        value, slope, curvature = (
            height * _hermite(kind.degree + times, place) * bell * (-scale * step) ** times
            for times in range(3)
        )
        return value, slope, curvature

    return sampled_motion(
        shape,
        length=2.0 * PERIODS_PER_SIDE,
        frequency=1.0 / period,
        intervals=INTERVALS_PER_PERIOD,
        owner=owner,
    )


def _hermite(degree: int, place: Array) -> Array:
    """Compute He_n by its recurrence, He_{n+1} = x He_n - n He_{n-1}."""
    before, value = np.zeros_like(place), np.ones_like(place)
    for n in range(degree):
        before, value = value, place * value - n * before
    return value


INTERVALS_PER_IMPULSE: Final = 16
"""Pieces per impulse. One would be exact, but the samples should show the impulse, too."""

_ROUNDING: Final = 1e-9
_DURATION_RATIO: Final = 0.01
"""Default duration of an impulse over the time between two [1]."""


def impulse_duration(owner: str, longest: float | None, interval: float) -> float:
    """Return the longest duration up to `longest` of which `interval` is a whole multiple."""
    if longest is None:
        longest = _DURATION_RATIO * interval
    if longest > interval:
        msg = (
            f"{owner}: pulse_duration = {longest:.6g} s must not exceed "
            f"interval = {interval:.6g} s; the impulses would overlap"
        )
        raise ComponentError(msg)
    if interval / longest * INTERVALS_PER_IMPULSE > MAXIMUM_SAMPLES:
        msg = (
            f"{owner}: pulse_duration = {longest:.6g} s is too short to be sampled over "
            f"interval = {interval:.6g} s"
        )
        raise ComponentError(msg)
    return interval / math.ceil(interval / longest * (1.0 - _ROUNDING))


def opposite_impulses(_: str, velocity: float, interval: float, pulse_duration: float) -> Motion:
    """Build two opposite impulses of the shape :eq:`eq-impulse`."""
    gap = (round(interval / pulse_duration) - 1) * INTERVALS_PER_IMPULSE
    step = 1.0 / INTERVALS_PER_IMPULSE
    u = np.arange(INTERVALS_PER_IMPULSE + 1) * step
    height = 30.0 * velocity / pulse_duration
    with np.errstate(over="ignore", invalid="ignore"):
        value = height * (u * (1.0 - u)) ** 2
        slope = height * 2.0 * u * (1.0 - u) * (1.0 - 2.0 * u) * step
        curvature = height * 2.0 * (1.0 - 6.0 * u * (1.0 - u)) * step**2
        pieces = hermite_pieces(value, slope, curvature)
    rest = np.zeros((gap, pieces.shape[1]))
    samples = np.concatenate([value[:-1], np.zeros(gap + 1), -value[1:]])
    return Motion(Signal(pulse_duration * step, samples, np.concatenate([pieces, rest, -pieces])))
