"""Figures of results and motions; matplotlib is imported when the first is drawn."""

from typing import TYPE_CHECKING

from rockframe.plot._animation import Animation, animation
from rockframe.plot._diagrams import energies, moment_rotation, phase
from rockframe.plot._dynamic_analysis import (
    annual_rate,
    cloud,
    dynamic_analysis,
    fractile_curves,
)
from rockframe.plot._ensembles import ensemble, fragility, probability, subset_simulation
from rockframe.plot._motion import motion, velocity_pulse
from rockframe.plot._overturning import overturning_map, overturning_spectrum, rocking_spectrum
from rockframe.plot._panels import Panels
from rockframe.plot._player import Player, player
from rockframe.plot._response import response
from rockframe.plot._scene import scene, state
from rockframe.plot._spectra import selection, spectra, suite
from rockframe.plot._studies import critical_scale, free_decay, sweep
from rockframe.plot._tradeoff import tradeoff
from rockframe.suggestions import public_names

__all__ = [
    "Animation",
    "Panels",
    "Player",
    "animation",
    "annual_rate",
    "cloud",
    "critical_scale",
    "dynamic_analysis",
    "energies",
    "ensemble",
    "fractile_curves",
    "fragility",
    "free_decay",
    "moment_rotation",
    "motion",
    "overturning_map",
    "overturning_spectrum",
    "phase",
    "player",
    "probability",
    "response",
    "rocking_spectrum",
    "scene",
    "selection",
    "spectra",
    "state",
    "subset_simulation",
    "suite",
    "sweep",
    "tradeoff",
    "velocity_pulse",
]

if not TYPE_CHECKING:  # otherwise type checkers would accept any name
    __getattr__, __dir__ = public_names(__name__, __all__)
