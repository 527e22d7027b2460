"""What matching has made of a motion besides its spectrum: peaks, pulse, what lies beyond."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from rockframe.motion.processing import velocity_pulses
from rockframe.motion.velocity_pulse import LEAST_INDICATOR
from rockframe.signals.path import ground_path
from rockframe.signals.polynomials import greatest, knots_of
from rockframe.signals.spectra import spectral_peaks

if TYPE_CHECKING:
    from rockframe.motion.matching.iteration import Goal
    from rockframe.signals import Signal
    from rockframe.signals.arrays import Array

LARGEST_USUAL: Final = 1.5
"""Growth beyond which a warning is due [1]: half as much again."""

_BEYOND: Final = 5.0
_PERIODS: Final = 24
"""How far beyond the range the spectrum is looked at, times its end, and at how many periods."""

_LEAST_STEPS: Final = 4.0
_PULSES: Final = (0.25, 15.0)
"""Time steps in the shortest period; periods between which pulses are looked for [s]."""

PEAKS: Final = tuple(f"peak_ground_{what}" for what in ("acceleration", "velocity", "displacement"))
INDICATOR: Final = "pulse_indicator"
GROWTH: Final = "spectral_growth_beyond_range"
AT: Final = "period_of_spectral_growth"


def changes(before: Signal, after: Signal, goal: Goal) -> dict[str, float]:
    """Compare a motion before and after its matching."""
    found: dict[str, float] = {}
    for when, signal in (("before", before), ("after", after)):
        velocity, displacement = ground_path(signal)
        for name, pieces in zip(PEAKS, (signal.pieces, velocity, displacement), strict=True):
            found[f"{name}_{when}_matching"] = greatest(pieces)
        found[f"{INDICATOR}_{when}_matching"] = _indicator(knots_of(velocity), signal.time_step)
    periods = np.geomspace(goal.longest, _BEYOND * goal.longest, _PERIODS + 1)[1:]
    old, new = (spectral_peaks(one, periods, goal.damping_ratio)[:, 0] for one in (before, after))
    growth = new / old
    most = int(growth.argmax())
    return {**found, GROWTH: float(growth[most]), AT: float(periods[most])}


def unusual(found: dict[str, float]) -> list[str]:
    """Say what has grown more than is usual, or has become a pulse."""
    words: list[str] = []
    for name in PEAKS:
        old, new = (found[f"{name}_{when}_matching"] for when in ("before", "after"))
        if new > LARGEST_USUAL * old:
            words.append(f"{name.replace('_', ' ')} {new / old:.3g} times")
    if found[GROWTH] > LARGEST_USUAL:
        words.append(f"spectrum {found[GROWTH]:.3g} times at {found[AT]:.3g} s, beyond the range")
    old, new = (found[f"{INDICATOR}_{when}_matching"] for when in ("before", "after"))
    if new > LEAST_INDICATOR >= old:
        words.append(f"a velocity pulse where none was (indicator {old:.2g}, now {new:.2g})")
    return words


def _indicator(velocity: Array, time_step: float) -> float:
    shortest, longest = _PULSES
    periods = velocity_pulses.periods_between(max(shortest, _LEAST_STEPS * time_step), longest)
    place = velocity_pulses.strongest(velocity[None, :], time_step, periods)
    wavelets = velocity_pulses.extracted(velocity, time_step, place)
    wavelet = velocity_pulses.wavelet_of(place.period, time_step)
    within = velocity_pulses.sum_of(wavelets, wavelet, 0, velocity.size)
    return velocity_pulses.measures(velocity, within, time_step).indicator
