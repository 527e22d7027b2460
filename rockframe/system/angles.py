"""Angles in words."""

import math


def angle_words(radians: float) -> str:
    """Write an angle in radians and degrees."""
    return f"{radians:.6g} rad ({math.degrees(radians):.4g} deg)"


def uplift_words(radians: float) -> str:
    """Write the angle at which contact is first lost; NaN if it never is."""
    if math.isnan(radians):
        return "never: the base stays in contact up to overturning"
    return angle_words(radians)
