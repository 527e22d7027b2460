"""Design spectra of codes: their arguments, and their shapes."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Final, TypeAlias

import numpy as np

from rockframe.arguments import checked_choice, checked_integer
from rockframe.errors import ComponentError
from rockframe.signals.arrays import Array
from rockframe.signals.spectra import DAMPING_RATIO
from rockframe.units import (
    ACCELERATION,
    PERIOD,
    POSITIVE,
    QuantityLike,
    RatioLike,
    to_ratio,
    to_si,
    to_si_values,
)

Shape: TypeAlias = Callable[[Array], Array]
"""Accelerations [m s^-2] at periods [s]."""

_PLATEAU_AMPLIFICATION: Final = 2.5
_MIN_DAMPING_CORRECTION: Final = 0.55


class GroundType(StrEnum):
    """Ground types of Eurocode 8."""

    A = "A"
    B = "B"
    C = "C"
    D = "D"
    E = "E"


_EUROCODE: Final = {
    # EN 1998-1:2004, Tables 3.2 and 3.3: S, T_B, T_C, T_D [1, s]
    1: {
        GroundType.A: (1.0, 0.15, 0.4, 2.0),
        GroundType.B: (1.2, 0.15, 0.5, 2.0),
        GroundType.C: (1.15, 0.20, 0.6, 2.0),
        GroundType.D: (1.35, 0.20, 0.8, 2.0),
        GroundType.E: (1.4, 0.15, 0.5, 2.0),
    },
    2: {
        GroundType.A: (1.0, 0.05, 0.25, 1.2),
        GroundType.B: (1.35, 0.05, 0.25, 1.2),
        GroundType.C: (1.5, 0.10, 0.25, 1.2),
        GroundType.D: (1.8, 0.10, 0.30, 1.2),
        GroundType.E: (1.6, 0.05, 0.25, 1.2),
    },
}


@dataclass(frozen=True)
class _Eurocode8:
    """The elastic spectrum: a_g [m s^-2], S [1], T_B, T_C, T_D [s] and eta [1]."""

    ground_acceleration: float
    soil_factor: float
    corner_b: float
    corner_c: float
    corner_d: float
    damping_correction: float

    def __call__(self, at: Array) -> Array:
        """Compute :eq:`eq-eurocode-8`."""
        plateau = _PLATEAU_AMPLIFICATION * self.damping_correction
        longer = np.maximum(at, self.corner_c)
        rising = 1.0 + np.minimum(at, self.corner_b) / self.corner_b * (plateau - 1.0)
        falling = plateau * self.corner_c / longer * np.minimum(1.0, self.corner_d / longer)
        return (
            self.ground_acceleration
            * self.soil_factor
            * np.where(at < self.corner_b, rising, falling)
        )


@dataclass(frozen=True)
class _ASCE7:
    """The design spectrum: S_DS, S_D1 [m s^-2], the corner between them and T_L [s]."""

    short_period: float
    one_second: float
    corner: float
    long_period: float

    def __call__(self, at: Array) -> Array:
        """Compute :eq:`eq-asce-7`."""
        longer = np.maximum(at, self.corner)
        rising = self.short_period * (0.4 + 0.6 * at / (0.2 * self.corner))
        falling = self.one_second / longer * np.minimum(1.0, self.long_period / longer)
        return np.where(at < 0.2 * self.corner, rising, falling)


def eurocode_8(
    ground_acceleration: QuantityLike,
    ground_type: str,
    spectrum_type: int,
    soil_factor: RatioLike | None,
    corner_periods: Sequence[QuantityLike] | None,
    damping_ratio: RatioLike,
    *,
    owner: str,
) -> tuple[str, Shape, float]:
    """Return name, shape and damping ratio of the horizontal elastic spectrum of Eurocode 8."""
    peak = to_si(
        ground_acceleration,
        ACCELERATION,
        owner=owner,
        name="ground_acceleration",
        condition=POSITIVE,
    )
    kind = checked_choice(GroundType, ground_type, owner=owner, name="ground_type")
    number = checked_integer(spectrum_type, owner=owner, name="spectrum_type", lowest=1, highest=2)
    soil, *corners = _EUROCODE[number][kind]
    if soil_factor is not None:
        soil = to_ratio(soil_factor, owner=owner, name="soil_factor", condition=POSITIVE)
    if corner_periods is not None:
        corners = to_si_values(corner_periods, PERIOD, owner=owner, name="corner_periods")
    if len(corners) != 3 or not 0.0 < corners[0] < corners[1] < corners[2]:
        msg = f"{owner}: corner_periods must be T_B, T_C and T_D, increasing"
        raise ComponentError(msg)
    damping = to_ratio(damping_ratio, owner=owner, name="damping_ratio", condition=DAMPING_RATIO)
    correction = max(math.sqrt(10.0 / (5.0 + 100.0 * damping)), _MIN_DAMPING_CORRECTION)

    first, second, third = corners
    words = f"Eurocode 8, type {number}, ground {kind}, {peak:.4g} m/s^2"
    return words, _Eurocode8(peak, soil, first, second, third, correction), damping


def asce_7(
    short_period_acceleration: QuantityLike,
    one_second_acceleration: QuantityLike,
    long_period: QuantityLike,
    *,
    owner: str,
) -> tuple[str, Shape]:
    """Return name and shape of the design response spectrum of ASCE 7."""
    named = {
        "short_period_acceleration": short_period_acceleration,
        "one_second_acceleration": one_second_acceleration,
    }
    short, long = (
        to_si(value, ACCELERATION, owner=owner, name=name, condition=POSITIVE)
        for name, value in named.items()
    )
    last = to_si(long_period, PERIOD, owner=owner, name="long_period", condition=POSITIVE)
    corner = long / short  # [s], as S_D1 is the acceleration at 1 s
    if last <= corner:
        msg = f"{owner}: long_period must exceed S_D1/S_DS, {corner:.4g} s"
        raise ComponentError(msg)

    words = f"ASCE 7, S_DS {short:.4g} m/s^2, S_D1 {long:.4g} m/s^2"
    return words, _ASCE7(short, long, corner, last)
