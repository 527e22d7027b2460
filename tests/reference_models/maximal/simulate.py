"""Run a scene with the reference model."""

from dataclasses import dataclass, replace

import numpy as np

from . import excitation
from . import layout as at
from .running import run
from .scene import GRAVITY, Scene, paces, parameters
from .starting import start

TOLERANCE = 1e-13


@dataclass(frozen=True)
class Excitation:
    """A ground motion in the form of the equations."""

    step: float
    intervals: int
    shape: np.ndarray
    across: np.ndarray
    upwards: np.ndarray
    longest: float

    @classmethod
    def still(cls, step: float = 0.01) -> "Excitation":
        """Return still ground."""
        return cls(step, 0, _shape(), np.zeros(2), np.zeros(2), np.inf)

    @classmethod
    def record(cls, step: float, across, upwards=None) -> "Excitation":
        """Return a motion that is linear between samples."""
        across = np.array(across, dtype=np.float64)
        upwards = np.zeros_like(across) if upwards is None else np.array(upwards, dtype=np.float64)
        shape = _shape(excitation.RECORD, step)
        return cls(step, across.size - 1, shape, across, upwards, np.inf)

    @classmethod
    def pulse(cls, kind, step, intervals, scale, phase, peak, vertical) -> "Excitation":
        """Return an analytic pulse; `scale` is its frequency, or a wavelet's period."""
        shape = _shape(kind, scale, phase, peak, vertical)
        longest = 0.02 / scale if kind == excitation.HARMONIC else 0.01 * scale
        return cls(step, intervals, shape, np.zeros(2), np.zeros(2), longest)

    def along(self, inclination: float) -> "Excitation":
        """Return the same motion on a base that rises to the right."""
        shape = self.shape.copy()
        sine = np.sin(inclination)
        shape[[excitation.COSINE, excitation.SINE]] = np.cos(inclination), sine
        shape[excitation.PULL] = GRAVITY * sine
        return replace(self, shape=shape)


def _shape(*values: float) -> np.ndarray:
    """Return the numbers of a motion on a level base, see `excitation.ground`."""
    shape = np.zeros(8)
    shape[: len(values)] = values
    shape[excitation.COSINE] = 1.0
    return shape


@dataclass(frozen=True)
class History:
    """Histories at the output times, up to the end of the run."""

    time: np.ndarray
    states: np.ndarray
    rotation: np.ndarray
    rise: np.ndarray
    status: int
    end: float
    events: np.ndarray


def simulate(scene: Scene, motion: Excitation, tolerance: float = TOLERANCE) -> History:
    """Run a scene.

    Parameters
    ----------
    scene : Scene
    motion : Excitation
    tolerance : float
        Of one step, relative to the largest value so far.

    Returns
    -------
    History
    """
    p = parameters(scene, tolerance)
    motion = motion.along(scene.inclination)
    z, contact, held = start(scene, p)
    total = motion.intervals * motion.step + scene.free
    count = int(np.ceil(total / motion.step * (1.0 - 1e-12)))
    stops = motion.step * np.arange(count + 1)
    stops[-1] = total
    pieces = np.arange(count)
    if int(motion.shape[0]) != excitation.RECORD:
        pieces = np.zeros(count, dtype=np.int64)
    pieces[motion.intervals :] = -1
    status, end, states, reached, events = run(
        stops,
        pieces,
        (motion.shape, motion.across, motion.upwards),
        z,
        contact,
        held,
        p,
        paces(scene, p),
        motion.longest,
    )
    states = states[:reached]
    if scene.kind == "bed":
        rotation, rise = states[:, 2], states[:, 1]
    elif scene.kind == "cascade":
        rotation, rise = states[:, 2] + states[:, 5], states[:, 1] + states[:, 4]
    else:
        rotation, rise = states[:, 5], states[:, 4]
    return History(stops[:reached], states, rotation, rise, status, end, events)


def reached_limit(history: History) -> bool:
    """Tell whether the body overturned."""
    return history.status == at.OVERTURNED
