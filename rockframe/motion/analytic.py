"""All constructors of analytic motions."""

from __future__ import annotations

from typing import Final

from rockframe.motion.cycloidal import CycloidalMotions
from rockframe.motion.wavelets import WaveletMotions

ANALYTIC: Final = (
    "sine_pulse",
    "cosine_pulse",
    "half_sine_pulse",
    "harmonic",
    "type_a_pulse",
    "type_b_pulse",
    "type_c_pulse",
    "ricker_wavelet",
    "mavroeidis_papageorgiou_pulse",
    "double_impulse",
)
"""Constructors that a recipe may name."""


class AnalyticMotions(CycloidalMotions, WaveletMotions):
    """A motion that can be built from a formula."""

    __slots__ = ()
