"""Vibrations in words."""

import math


def vibration_words(symbol: str, frequency: float, damping_ratio: float) -> str:
    """Write a frequency, its period and its damping ratio."""
    return (
        f"{symbol} = {frequency:.6g} rad/s (period {2.0 * math.pi / frequency:.6g} s), "
        f"damping ratio {damping_ratio:.6g}"
    )
