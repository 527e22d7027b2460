"""Ricker wavelets: the second and third derivative of a Gaussian."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from rockframe.motion.pulses.sampling import sampled
from rockframe.signals import Motion
from rockframe.signals.arrays import Array

INTERVALS_PER_PERIOD: Final = 256
"""Quintic pieces per period: 6e-14 of the amplitude at most, 105 h^6/(64 * 720)."""

PERIODS_PER_SIDE: Final = 2.5
"""Periods from the centre to both ends, where 7e-16 of the amplitude is left."""

_LEFT_ROOT: Final = 3.0 - math.sqrt(6.0)
"""Square of the place where He_3(x) exp(-x^2/2) is greatest."""


class _Derivative(NamedTuple):
    """``sign He_n(x) exp(-x^2/2) / peak``, He_n the Hermite polynomial of degree n."""

    degree: int
    sign: float
    peak: float


SYMMETRIC: Final = _Derivative(2, -1.0, 1.0)
ANTISYMMETRIC: Final = _Derivative(
    3, 1.0, math.sqrt(6.0 * _LEFT_ROOT) * math.exp(-0.5 * _LEFT_ROOT)
)


def ricker(*, amplitude: float, period: float, antisymmetric: bool, owner: str) -> Motion:
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

    return sampled(
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
