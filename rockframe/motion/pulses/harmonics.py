"""Motions that are sums of sines: the cycloidal pulses, and the one of Mavroeidis."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from rockframe.motion.pulses.sampling import Shape, sampled
from rockframe.signals import Motion
from rockframe.signals.arrays import Array

INTERVALS_PER_CYCLE: Final = 128
"""Quintic pieces per cycle: (2 pi/128)^6/(64 * 720) = 3.0e-13 of the amplitude."""

_HALF: Final = 0.5
_QUARTER: Final = 0.25
_ROUNDS: Final = 20


class _Sine(NamedTuple):
    """``amplitude sin(2 pi (ratio x + start))`` over the place x, in periods."""

    amplitude: float
    ratio: float
    start: float


def sine(
    *, amplitude: float, frequency: float, cycles: float, phase: float = 0.0, owner: str
) -> Motion:
    """Build ``a(t) = amplitude sin(2 pi frequency t + phase)``."""
    return sampled(
        _sum_of([_Sine(amplitude, 1.0, phase / (2.0 * math.pi))]),
        length=cycles,
        frequency=frequency,
        intervals=INTERVALS_PER_CYCLE,
        owner=owner,
    )


def type_c_phase(order: int) -> float:
    """Find the phase with which a type C pulse brings the ground back to its place.

    It is the root of :eq:`eq-type-c-phase` in (0, pi/2).
    """
    phase = 0.0
    for _ in range(_ROUNDS):  # each shrinks the error at least 21 times
        phase = math.atan(1.0 / ((order + _HALF) * math.pi - phase))
    return phase


def mavroeidis_papageorgiou(
    *, velocity: float, frequency: float, phase: float, cycles: float, owner: str
) -> Motion:
    """Build the pulse of Mavroeidis and Papageorgiou as its three sines, :eq:`eq-mp-sines`."""
    amplitude = -math.pi * frequency * velocity
    start = phase / (2.0 * math.pi)

    def part(share: float, ratio: float) -> _Sine:
        return _Sine(share * ratio * amplitude, ratio, start - _HALF * cycles * ratio)

    faster, slower = 1.0 + 1.0 / cycles, 1.0 - 1.0 / cycles
    return sampled(
        _sum_of([part(1.0, 1.0), part(_HALF, faster), part(_HALF, slower)]),
        length=cycles,
        frequency=frequency,
        intervals=math.ceil(faster * INTERVALS_PER_CYCLE),
        owner=owner,
    )


def sine_of_turns(turns: Array) -> Array:
    """Compute sin(2 pi x), exactly zero at every half turn."""
    rest = turns - np.round(turns)
    folded = np.where(np.abs(rest) > _QUARTER, np.copysign(_HALF, rest) - rest, rest)
    return np.sin(2.0 * math.pi * folded)


def _sum_of(parts: Sequence[_Sine]) -> Shape:
    def shape(places: Array, step: float) -> tuple[Array, Array, Array]:
        value, slope, curvature = _along(parts[0], places, step)
        for part in parts[1:]:
            more = _along(part, places, step)
            value, slope, curvature = value + more[0], slope + more[1], curvature + more[2]
        return value, slope, curvature

    return shape


def _along(part: _Sine, places: Array, step: float) -> tuple[Array, Array, Array]:
    turns = part.ratio * places + part.start
    value = part.amplitude * sine_of_turns(turns)
    angle = 2.0 * math.pi * part.ratio * step  # omega dt
    slope = part.amplitude * sine_of_turns(turns + _QUARTER) * angle
    return value, slope, -value * angle**2
