"""Ground motions in smooth pieces."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Piece:
    """A span of time with a smooth ground acceleration [m/s²]."""

    start: float
    stop: float
    across: Callable[[float], float]
    up: Callable[[float], float]
    linear: bool = False


def pieces_of(step: float, across, up=None) -> list[Piece]:
    """Return the pieces of a sampled motion, linear between samples."""
    across = np.asarray(across, dtype=float)
    up = np.zeros_like(across) if up is None else np.asarray(up, dtype=float)
    pieces = []
    for i in range(across.size - 1):
        begin = i * step
        lines = [
            lambda t, a=float(v[i]), s=float(v[i + 1] - v[i]) / step, t0=begin: a + s * (t - t0)
            for v in (across, up)
        ]
        pieces.append(Piece(begin, (i + 1) * step, *lines, linear=True))
    return pieces


def still(start: float, stop: float) -> Piece:
    """Return a span of still ground."""
    return Piece(start, stop, lambda t: 0.0, lambda t: 0.0, linear=True)


def harmonic(peak, vertical, frequency, cycles, phase=0.0, free=0.0) -> list[Piece]:
    """Return whole or half cycles of a harmonic acceleration, and still ground after them."""
    stop, turn = cycles / frequency, 2.0 * math.pi * frequency
    return [
        Piece(
            0.0, stop,
            lambda t: peak * math.sin(turn * t + phase),
            lambda t: vertical * math.sin(turn * t + phase),
        ),
        still(stop, stop + free),
    ]  # fmt: skip
