"""From a spectrum and a duration to an accelerogram."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, cast

import numpy as np

if TYPE_CHECKING:
    from rockframe.motion.stochastic.point_source import PointSource
    from rockframe.signals.arrays import Array

WINDOW_PEAK: Final = 0.2
"""Place of the window's peak, over its length [1] (Boore 2003)."""

WINDOW_END: Final = 0.05
"""Window at its end, over its peak [1] (Boore 2003)."""

WINDOW_LENGTH: Final = 2.12
"""Length of the window over the duration of source and path [1] (Boore and Thompson 2015)."""

SHORTEST_FADE: Final = 1.0
"""The motion takes at least so long to begin, and to end [s]."""


def accelerogram(source: PointSource, time_step: float, seed: int, stream: int = 0) -> Array:
    """Draw an accelerogram: windowed noise with the spectrum of `source`.

    :eq:`eq-noise-spectrum` and :eq:`eq-faded`.
    """
    from scipy import fft

    window = exponential_window(WINDOW_LENGTH * source.duration, time_step)
    noise = window * normal_numbers(window.size, seed, stream)
    fade = math.ceil(max(1.0 / source.lowest_corner, SHORTEST_FADE) / time_step)
    count = window.size + 2 * fade
    # twice as long as needed: what the filter spreads beyond the ends must not come round
    points = cast("int", fft.next_fast_len(2 * count, real=True))
    padded = np.zeros(points)
    padded[fade : fade + noise.size] = noise / math.sqrt(float(noise @ noise))
    frequency = np.arange(points // 2 + 1) / (points * time_step)
    # of unit mean square, times the target; the transform's sums stand for integrals over time
    spectrum = np.fft.rfft(padded) * source.displacement_spectrum(frequency) / time_step
    rate = 2j * math.pi * frequency
    displacement, velocity, acceleration = (
        np.fft.irfft(spectrum * rate**order, points)[:count] for order in range(3)
    )
    step, slope, curvature = faded(count, fade, time_step)
    return step * acceleration + 2.0 * slope * velocity + curvature * displacement


def exponential_window(length: float, time_step: float) -> Array:
    """Sample the window of Saragoni and Hart (1974), :eq:`eq-window`."""
    power = -WINDOW_PEAK * math.log(WINDOW_END)
    power /= 1.0 + WINDOW_PEAK * (math.log(WINDOW_PEAK) - 1.0)
    count = math.floor(length / time_step) + 1
    time: Array = np.arange(count, dtype=np.float64) * time_step
    over_peak = time / (WINDOW_PEAK * length)
    return (over_peak * np.exp(1.0 - over_peak)) ** power


def normal_numbers(count: int, seed: int, stream: int) -> Array:
    """Draw normally distributed numbers that are the same in every version of NumPy.

    A bit generator's raw numbers are (NEP 19); ``Generator.normal`` may change. They become
    uniform numbers, :eq:`eq-uniform`, and normal ones through the inverse of the distribution.
    """
    from scipy import special

    bits = np.random.PCG64(np.random.SeedSequence(seed, spawn_key=(stream,)))
    leading = np.right_shift(np.asarray(bits.random_raw(count), dtype=np.uint64), np.uint64(11))
    return cast("Array", special.ndtri((leading.astype(np.float64) + 0.5) * 2.0**-53))


def faded(count: int, fade: int, time_step: float) -> tuple[Array, Array, Array]:
    """Compute a smooth step up at the start and down at the end, :eq:`eq-step`."""
    x = np.minimum(np.arange(fade + 1) / fade, 1.0)
    rises = (
        x**3 * (10.0 - 15.0 * x + 6.0 * x**2),
        30.0 * x**2 * (1.0 - x) ** 2,
        60.0 * x * (1.0 - x) * (1.0 - 2.0 * x),
    )
    levels = (1.0, 0.0, 0.0)
    steps: list[Array] = []
    for order, (rise, level) in enumerate(zip(rises, levels, strict=True)):
        values = np.full(count, level)
        values[: fade + 1] = rise / (fade * time_step) ** order
        values[-fade - 1 :] = (-1.0) ** order * values[fade::-1]
        steps.append(values)
    return steps[0], steps[1], steps[2]
