"""A scene in words, and how its numbers are written."""

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Words:
    """What a scene is said to be.

    Parameters
    ----------
    equations : list of (str, str)
        Each contact state with the equation that governs it.
    restraint : str
        Which point of the base is held horizontally.
    numbers : list of (str, str)
        The numbers that a reader wants to see, with their names, first those of uplift.
    left_out : list of str
        What the model does not have.
    """

    equations: list[tuple[str, str]]
    restraint: str
    numbers: list[tuple[str, str]]
    left_out: list[str]


def angle_words(radians: float) -> str:
    """Write an angle in radians and degrees."""
    return f"{radians:.6g} rad ({math.degrees(radians):.4g} deg)"


def uplift_words(radians: float) -> str:
    """Write the angle at which contact is first lost; NaN if it never is."""
    if math.isnan(radians):
        return "never: the base stays in contact up to overturning"
    return angle_words(radians)


def vibration_words(symbol: str, frequency: float, damping_ratio: float) -> str:
    """Write a frequency, its period and its damping ratio."""
    return (
        f"{symbol} = {frequency:.6g} rad/s (period {2.0 * math.pi / frequency:.6g} s), "
        f"damping ratio {damping_ratio:.6g}"
    )
