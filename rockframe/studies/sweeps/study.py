"""A sweep that has been planned: all that its results depend on."""

from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final

import numpy as np

from rockframe.compiled import COMPILED, processors
from rockframe.errors import collected_warnings
from rockframe.motion import GroundMotion
from rockframe.signals.arrays import AnyArray
from rockframe.simulation.plan import RunRequest, default_output_step, run_length
from rockframe.studies.sweeps.axes import SYSTEM_AXES, Axis, Grid
from rockframe.studies.sweeps.identity import description_of, digest_of
from rockframe.studies.sweeps.scenes import FunctionScene, SweptScene, SystemScene
from rockframe.system.assembly import Assembly
from rockframe.version import __version__

CHUNK_TIME: Final = 1.0
"""Target time of a chunk, so that submitting it costs little [s]."""
MAX_CHUNK: Final = 10_000
MIN_CASES_IN_LANES: Final = 16
"""Number of cases below which lanes are partly empty and save almost nothing."""
MIN_CHUNK_IN_LANES: Final = 64
"""Number of cases of a chunk below which lanes are partly empty."""
COMPILING_SHARE: Final = 1.0
"""Longest time to compile what lanes need, over the time that they save in the sweep."""
LANE_TIME_RATIO: Final = 0.25
"""Time of a run in lanes, over that of a run alone [1]."""
_RUN_OVERHEAD: Final = 5e-4
"""Time for a run, without its integration [s]."""
_TIME_OF_FIXED_STEPS: Final = 4e-7
"""Time for an interval of the motion, with fixed sub-steps [s]."""
_TIME_OF_ADAPTIVE_STEPS: Final = 2e-6
"""The same at the tolerance of the level standard [s]."""
_SCREENING_RATIO: Final = 2.5
"""Time of a run and of one with 1.5 times as many steps, over that of the first."""
_PYTHON_SLOWDOWN: Final = 300.0
"""Without compilation."""
_INSPECTED_SCENES: Final = 16
"""Number of cases at which the result of a function is inspected."""
_GOLDEN_RATIO: Final = 0.6180339887498949
"""The golden section, by whose multiples these cases are spread evenly, whatever their number."""


@dataclass(frozen=True, eq=False)
class Histories:
    """The histories that are kept, on times that all cases have."""

    names: tuple[str, ...] | None  # which; all that every run has if None
    step: float  # between the times [s]
    count: int  # of the times


@dataclass(frozen=True, eq=False)
class SweepJob:
    """Some cases, with all that is needed to run them, also in another process."""

    scene: SweptScene  # what is simulated
    axes: tuple[tuple[Axis, AnyArray], ...]  # what varies, and its value in each case
    motions: tuple[GroundMotion | None, ...]  # those of the cases; None leaves it to the scene
    motion_of_case: AnyArray  # which of them each case has
    arguments: RunRequest  # of every run
    period: float | None  # of the oscillator, where spectral values are a target [s]
    histories: Histories | None  # what is kept beside scalars
    # longest time to compile what lanes need [s]; None where no cases run in lanes
    compile_timeout: float | None
    # whether each is run twice, and again by tolerance where its verdict is in doubt
    screened: bool
    restrainers: tuple[str, ...]  # names in results; empty if cases have different ones


@dataclass(frozen=True, eq=False)
class Study:
    """A scene, its axes, the motions, and the options of every run."""

    scene: SweptScene  # what is simulated
    grid: Grid  # the cases
    motions: dict[str, GroundMotion | None]  # by their names
    arguments: RunRequest  # of every run
    period: float | None = None  # of the oscillator, where spectral values are a target [s]
    histories: Histories | None = None  # what is kept beside scalars
    # whether each case is run twice, and again by tolerance where its verdict is in doubt
    screened: bool = False
    # whether that was requested but each is run by tolerance, which costs less
    screening_skipped: bool = field(default=False, compare=False)
    # whether the result is larger than the memory, which is no part of what it is
    lazy: bool = field(default=False, compare=False)

    def job(self, cases: range | AnyArray) -> SweepJob:
        """Return the job of some cases."""
        number = self.grid.motions_of(cases)
        used, place = np.unique(number, return_inverse=True)
        every = list(self.motions.values())
        return SweepJob(
            self.scene, self.grid.values_of_cases(cases), tuple(every[k] for k in used), place,
            self.arguments, self.period, self.histories, self.compile_timeout, self.screened,
            self.restrainers,
        )  # fmt: skip

    @property
    def compile_timeout(self) -> float | None:
        """Longest time that compilation for lanes may take, a share of the time that they save [s].

        None if no cases run in lanes: without compilation, with histories or points, or if there
        are too few cases. Results are the same with and without lanes.
        """
        sampled = self.histories is not None or bool(self.arguments.points)
        if not COMPILED or sampled or self.grid.count < MIN_CASES_IN_LANES:
            return None
        saved = (1.0 - LANE_TIME_RATIO) * self.grid.count * self._time_of_case() / processors()
        return COMPILING_SHARE * saved

    def to_dict(self) -> dict[str, Any]:
        """Return all that the results depend on: every field, and some scenes of a function."""
        # the source of a function need not determine its scenes
        scenes = [
            digest_of(description_of(scene))
            if isinstance(scene, Assembly)
            else type(scene).__name__
            for scene in self._inspected_scenes
        ]
        return {"rockframe_version": __version__, **description_of(self), "scenes": scenes}

    @cached_property
    def restrainers(self) -> tuple[str, ...]:
        """Names of the restrainers in results; empty if scenes have different ones."""
        if isinstance(self.scene, SystemScene):
            return self.scene.assembly.setting.link_names
        made = [
            scene.setting.link_names
            for scene in self._inspected_scenes
            if isinstance(scene, Assembly)
        ]
        return made[0] if made and len(set(made)) == 1 else ()

    @cached_property
    def _inspected_scenes(self) -> list[Assembly | Exception]:
        """Some scenes that a function makes, or why it makes none."""
        if not isinstance(self.scene, FunctionScene):
            return []
        count = self.grid.count
        spread = [int((k * _GOLDEN_RATIO) % 1.0 * count) for k in range(_INSPECTED_SCENES)]
        scenes: list[Assembly | Exception] = []
        for case in sorted({*spread, count - 1}):
            axes = self.grid.values_of_cases(range(case, case + 1))
            values = {axis: value.item() for axis, value in axes if axis.changes in SYSTEM_AXES}
            try:
                with collected_warnings():
                    scenes.append(self.scene.assembled(values))
            except Exception as problem:  # reported by the run of the case
                scenes.append(problem)
        return scenes

    @cached_property
    def digest(self) -> str:
        """The sha256 of :meth:`to_dict`."""
        return digest_of(self.to_dict())

    def time_of_case(self, *, as_python: bool) -> float:
        """Estimate the time of a case among others [s]."""
        alone = self._time_of_case()
        if as_python:
            return alone * _PYTHON_SLOWDOWN
        return alone if self.compile_timeout is None else alone * LANE_TIME_RATIO

    def chunk_size(self, workers: int, *, as_python: bool) -> int:
        """Return a chunk size that takes long enough and leaves work for all workers."""
        size = CHUNK_TIME / self.time_of_case(as_python=as_python)
        fair = -(-self.grid.count // (4 * workers))
        if self.compile_timeout is not None and not as_python:
            fair = max(fair, MIN_CHUNK_IN_LANES)
        return int(max(1, min(size, fair, MAX_CHUNK)))

    def _time_of_case(self) -> float:
        """Estimate the time of a case alone, in machine code [s]."""
        intervals = max(
            run_length(self.arguments, motion) / default_output_step(motion)
            for motion in self.motions.values()
        )
        tolerance = self.arguments.accuracy.rtol
        if tolerance is None:
            duration = _RUN_OVERHEAD + intervals * _TIME_OF_FIXED_STEPS
        else:
            duration = _RUN_OVERHEAD + intervals * _TIME_OF_ADAPTIVE_STEPS
            duration *= (2e-8 / float(tolerance)) ** 0.2
        return duration * (_SCREENING_RATIO if self.screened else 1.0)


_CACHE_SIZE: Final = 16
"""Studies of this process whose functions and motions are kept at hand."""
_cache: Final[OrderedDict[str, Study]] = OrderedDict()


def cache_study(study: Study) -> None:
    """Keep the function and the motions of a study at hand."""
    _cache[study.digest] = study
    _cache.move_to_end(study.digest)
    while len(_cache) > _CACHE_SIZE:
        _cache.popitem(last=False)


def cached_study(attributes: Mapping[str, Any]) -> Study | None:
    """Return the study of a dataset, if this process has made it."""
    return _cache.get(str(attributes.get("study_sha256")))
