"""Characteristic periods of a motion, and the intensity of its velocity spectrum."""

import math
from typing import Final

import numpy as np

from rockframe.signals.arrays import Array
from rockframe.signals.fourier import transform_of
from rockframe.signals.signal import Signal
from rockframe.signals.spectra import spectral_peaks

MEAN_PERIOD_BAND: Final = (0.25, 20.0)
"""Frequencies that the mean period looks at [Hz] (Rathje et al. 1998)."""

MEAN_PERIOD_RESOLUTION: Final = 0.05
"""Greatest distance between them [Hz] (Rathje et al. 2004)."""

HOUSNER_BAND: Final = (0.1, 2.5)
"""Periods over which the velocity spectrum is integrated [s] (Housner 1952)."""

HOUSNER_PERIODS: Final = np.linspace(*HOUSNER_BAND, 241)
"""Where the velocity spectrum is computed for its integral [s]."""

PREDOMINANT_PERIODS: Final = 10.0 ** (np.arange(-100, 131) / 100.0)
"""Where the peak of the velocity spectrum is looked for: 0.1 s to 20 s [s]."""


def mean_period(signal: Signal) -> float:
    """Compute the mean period, :eq:`eq-mean-period`.

    Parameters
    ----------
    signal : Signal
        Acceleration of the ground.

    Returns
    -------
    float
        NaN for ground that stands still in this band [s].
    """
    frequency, transform = transform_of(signal, MEAN_PERIOD_RESOLUTION)
    low, high = MEAN_PERIOD_BAND
    inside = (frequency >= low) & (frequency <= high)
    power = np.abs(transform[inside]) ** 2
    total = float(np.sum(power))
    return float(np.sum(power / frequency[inside])) / total if total > 0.0 else math.nan


def housner_intensity(signal: Signal, damping_ratio: float) -> float:
    """Integrate the pseudo-velocity spectrum, :eq:`eq-housner-intensity`.

    Parameters
    ----------
    signal : Signal
        Acceleration of the ground.
    damping_ratio : float
        Damping ratio [1].

    Returns
    -------
    float
        [m]
    """
    from scipy.integrate import trapezoid

    velocity = _pseudo_velocity(signal, HOUSNER_PERIODS, damping_ratio)
    return float(trapezoid(velocity, HOUSNER_PERIODS))


def predominant_period(signal: Signal, damping_ratio: float) -> float:
    """Find the period where the pseudo-velocity spectrum has its peak.

    Parameters
    ----------
    signal : Signal
        Acceleration of the ground.
    damping_ratio : float
        Damping ratio [1].

    Returns
    -------
    float
        Between 0.1 s and 20 s; NaN for ground that stands still [s].
    """
    velocity = _pseudo_velocity(signal, PREDOMINANT_PERIODS, damping_ratio)
    if not velocity.max() > 0.0:
        return math.nan
    top = int(np.argmax(velocity))
    if not 0 < top < velocity.size - 1:
        return float(PREDOMINANT_PERIODS[top])
    # vertex of the parabola through three points, evenly spaced in log T
    left, middle, right = velocity[top - 1 : top + 2].tolist()
    shift = 0.5 * (left - right) / (left - 2.0 * middle + right)
    return float(
        PREDOMINANT_PERIODS[top] * (PREDOMINANT_PERIODS[1] / PREDOMINANT_PERIODS[0]) ** shift
    )


def _pseudo_velocity(signal: Signal, periods: Array, damping_ratio: float) -> Array:
    peaks = spectral_peaks(signal, periods, damping_ratio)
    return 2.0 * np.pi / periods * peaks[:, 0]
