"""Sine and cosine as polynomials: the same bits on every machine.

An angle is reduced to at most a quarter turn from the nearest multiple of half a turn; there the
Taylor polynomials of degree 19 and 20 are exact to the last bit or two.
"""

import math
from typing import Final

from rockframe.compiled import inlined

_SINE: Final = tuple((-1.0) ** j / math.factorial(2 * j + 1) for j in range(10))
_COSINE: Final = tuple((-1.0) ** j / math.factorial(2 * j) for j in range(11))
S1, S2, S3, S4, S5, S6, S7, S8, S9 = _SINE[1:]
C1, C2, C3, C4, C5, C6, C7, C8, C9, C10 = _COSINE[1:]

QUARTER_TURN: Final = 0.5 * math.pi
HALF_TURNS_PER_RADIAN: Final = 1.0 / math.pi
HALF_TURN: Final = math.pi
PI_REMAINDER: Final = 1.2246467991473532e-16  # pi less its double, sin(math.pi)
INTEGER_SHIFT: Final = 6755399441055744.0
"""1.5 * 2^52: adding and then subtracting it rounds a number to an integer."""


@inlined
def sine_cosine(angle: float) -> tuple[float, float]:
    """Return sine and cosine of an angle [rad].

    The terms are added in pairs, so that few of them wait for another.
    """
    sign, x = 1.0, angle
    if abs(angle) > QUARTER_TURN:
        half_turns = (angle * HALF_TURNS_PER_RADIAN + INTEGER_SHIFT) - INTEGER_SHIFT
        whole_turns = (0.5 * half_turns + INTEGER_SHIFT) - INTEGER_SHIFT
        sign = 1.0 - 2.0 * abs(half_turns - 2.0 * whole_turns)
        x = (angle - half_turns * HALF_TURN) - half_turns * PI_REMAINDER
    z = x * x
    w = z * z
    v = w * w
    low = (S1 + S2 * z) + w * (S3 + S4 * z)
    high = (S5 + S6 * z) + w * (S7 + S8 * z)
    sine = x + x * (z * (low + v * (high + v * S9)))
    low = (C2 + C3 * z) + w * (C4 + C5 * z)
    high = (C6 + C7 * z) + w * (C8 + C9 * z)
    cosine = 1.0 + z * (C1 + z * (low + v * (high + v * C10)))
    return sign * sine, sign * cosine


@inlined
def versine(sine: float, cosine: float) -> float:
    """Return 1 - cos without cancellation, from sine and cosine."""
    return sine * sine / (1.0 + cosine) if cosine > 0.0 else 1.0 - cosine
