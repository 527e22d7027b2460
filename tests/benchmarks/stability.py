"""The longest stable step of the Dormand-Prince pair."""

import math

import numpy as np

# the fifth-order solution of a linear equation z' = s z is multiplied by this in a step, x = h s
_POLYNOMIAL = np.array([1 / 600, 1 / 120, 1 / 24, 1 / 6, 1 / 2, 1.0, 1.0])
_FINE = np.linspace(1e-3, 4.0, 4000)


def limit(rate: complex) -> float:
    """Return the largest h |s| at which a decaying motion of the rate s does not grow."""
    direction = rate / abs(rate)
    growth = np.abs(np.polyval(_POLYNOMIAL, _FINE * direction))
    beyond = np.nonzero(growth > 1.0 + 1e-9)[0]
    return float(_FINE[max(int(beyond[0]) - 1, 0)]) if beyond.size else float(_FINE[-1])


def longest_step(rates: list[complex]) -> float:
    """Return the longest step that is stable for all of these rates [s]."""
    return min(limit(rate) / abs(rate) for rate in rates if rate.real <= 0.0 and rate != 0.0)


def rates_on_pads(
    *,
    half_width: float,
    half_height: float,
    frequency_ratio: float,
    damping_ratio: float,
    gravity: float,
) -> list[complex]:
    """Return the rates of a rectangular block's small motion on two pads, per unit of mass.

    Of the vertical and the rocking motion in full contact, and of a corner that bears alone.
    """  # fmt: skip
    b, h = half_width, half_height
    radius = math.hypot(b, h)
    vertical = frequency_ratio * math.sqrt(0.75 * gravity / radius)
    k, c = 0.5 * vertical**2, damping_ratio * vertical
    inertia = radius**2 / 3.0 + h**2
    mobility = 1.0 + b**2 / inertia
    return [
        complex(rate)
        for equation in (
            (1.0, 2.0 * c, 2.0 * k),
            (inertia, 2.0 * c * b**2, 2.0 * k * b**2 - gravity * h),
            (1.0, c * mobility, k * mobility),
        )
        for rate in np.roots(equation)
    ]
