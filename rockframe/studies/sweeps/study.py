"""A sweep that has been planned: all that its results depend on."""

import hashlib
import json
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np

from rockframe.compiled import COMPILED
from rockframe.motion import GroundMotion
from rockframe.results.outcome import Generic
from rockframe.simulation.plan import STILL_GROUND_OUTPUT_STEP, Arguments, length_of
from rockframe.studies.sweeps.axes import Axis
from rockframe.studies.sweeps.grid import Grid
from rockframe.studies.sweeps.scenes import Scene
from rockframe.version import __version__

LONG_ENOUGH: Final = 1.0
"""What a chunk should take, so that handing it out costs little [s]."""
LARGEST_CHUNK: Final = 10_000
FEWEST_IN_LANES: Final = 500
"""Cases below which lanes, which must be compiled too, save less than a fraction of a second."""
IN_LANES: Final = 0.25
"""Of the time of a run alone."""
_OVERHEAD: Final = 5e-4
"""Of a run, beside its integration [s]."""
_FIXED: Final = 4e-7
"""Of an interval of the motion, with fixed sub-steps [s]."""
_BY_TOLERANCE: Final = 2e-6
"""The same at the tolerance of the level standard [s]."""
_SCREENED: Final = 2.5
"""Time of a run and of one with half as many steps again, over that of the first."""
_SLOWER: Final = 300.0
"""Without compilation."""


@dataclass(frozen=True, eq=False)
class Histories:
    """The histories that are kept, on times that all cases have.

    Parameters
    ----------
    names : tuple of str or None
        Which; all that every run has if None.
    step : float
        Between the times [s].
    count : int
        Of the times.
    """

    names: tuple[str, ...] | None
    step: float
    count: int

    @property
    def times(self) -> Generic:
        """The times [s]."""
        return np.arange(self.count, dtype=np.float64) * self.step


@dataclass(frozen=True, eq=False)
class Job:
    """Some cases, with all that is needed to run them, also in another process.

    Parameters
    ----------
    scene : Scene
        What is simulated.
    axes : tuple of (Axis, ndarray)
        What varies, and its value in each case.
    motions : tuple of GroundMotion or None
        Those of the cases; None leaves it to the scene.
    motion_of_case : ndarray of int
        Which of them each case has.
    arguments : Arguments
        Of every run.
    period : float or None
        Of the oscillator, where spectral values are a target [s].
    histories : Histories or None
        What is kept beside scalars.
    side_by_side : bool
        Whether cases run in lanes, as far as they can.
    screened : bool
        Whether each is run twice, and again by tolerance where its verdict is in doubt.
    """

    scene: Scene
    axes: tuple[tuple[Axis, Generic], ...]
    motions: tuple[GroundMotion | None, ...]
    motion_of_case: Generic
    arguments: Arguments
    period: float | None
    histories: Histories | None
    side_by_side: bool
    screened: bool


@dataclass(frozen=True, eq=False)
class Study:
    """A scene, what varies, the motions, and what every run is asked for.

    Parameters
    ----------
    scene : Scene
        What is simulated.
    grid : Grid
        The cases.
    motions : dict of str to GroundMotion or None
        By their names.
    arguments : Arguments
        Of every run.
    period : float or None
        Of the oscillator, where spectral values are a target [s].
    histories : Histories or None
        What is kept beside scalars.
    screened : bool
        Whether each case is run twice, and again by tolerance where its verdict is in doubt.
    """

    scene: Scene
    grid: Grid
    motions: dict[str, GroundMotion | None]
    arguments: Arguments
    period: float | None = None
    histories: Histories | None = None
    screened: bool = False

    def job(self, cases: range) -> Job:
        """Give the job of some cases."""
        number = self.grid.motions_of(cases.start, cases.stop)
        used, place = np.unique(number, return_inverse=True)
        every = list(self.motions.values())
        return Job(
            self.scene,
            self.grid.of_cases(cases.start, cases.stop),
            tuple(every[k] for k in used),
            place,
            self.arguments,
            self.period,
            self.histories,
            self.side_by_side,
            self.screened,
        )

    @property
    def side_by_side(self) -> bool:
        """Whether cases run in lanes: compiled, without samples, and many.

        Their numbers are the same either way.
        """
        sampled = self.histories is not None or bool(self.arguments.points)
        return COMPILED and not sampled and self.grid.count >= FEWEST_IN_LANES

    def to_dict(self) -> dict[str, Any]:
        """Tell all that the results depend on, long rows of numbers by their digests."""
        rows = (*self.grid.axes, *self.grid.columns)
        motions = {
            name: None if motion is None else motion.sha256 for name, motion in self.motions.items()
        }
        column = self.grid.motion_column
        return {
            "rockframe_version": __version__,
            "scene": self.scene.to_dict(),
            "axes": {axis.name: axis.to_dict() | {"values": _digest(axis.values)} for axis in rows},
            "dimensions": self.grid.sizes,
            "motions": motions,
            "motion_of_case": None if column is None else _digest(column),
            "arguments": self.arguments.to_dict(),
            "period": self.period,
            "histories": None if self.histories is None else vars(self.histories),
            "screened": self.screened,
        }

    @cached_property
    def digest(self) -> str:
        """The sha256 of :meth:`to_dict`."""
        text = json.dumps(self.to_dict(), sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()

    def chunk_size(self, workers: int) -> int:
        """Give a number of cases that takes long enough, and leaves work for all workers."""
        lengths = [self._length(motion) for motion in self.motions.values()]
        fixed = self.arguments.accuracy.rtol is None
        one = _OVERHEAD + max(lengths) * (_FIXED if fixed else _BY_TOLERANCE)
        if not fixed:
            one *= (2e-8 / float(self.arguments.accuracy.rtol or 1.0)) ** 0.2
        one *= IN_LANES if self.side_by_side else 1.0
        one *= _SCREENED if self.screened else 1.0
        size = LONG_ENOUGH / (one if COMPILED else _SLOWER * one)
        fair = -(-self.grid.count // (4 * workers))
        return int(max(1, min(size, fair, LARGEST_CHUNK)))

    def _length(self, motion: GroundMotion | None) -> float:
        """Give the number of intervals of a run."""
        step = STILL_GROUND_OUTPUT_STEP if motion is None else motion.si.time_step
        return length_of(self.arguments, motion) / step


def _digest(values: Generic) -> str:
    kept = values if values.dtype.kind == "U" else values.astype(values.dtype.newbyteorder("<"))
    data = json.dumps(kept.tolist()).encode() if kept.dtype.kind == "U" else kept.tobytes()
    return hashlib.sha256(f"{kept.dtype.kind}{kept.shape}".encode() + data).hexdigest()
