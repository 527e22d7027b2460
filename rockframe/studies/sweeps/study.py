"""A sweep that has been planned: all that its results depend on, and the cases of its jobs."""

from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Final, TypeAlias

import numpy as np

from rockframe.case_arrays import CaseArray, CaseIndices
from rockframe.compiled import COMPILED, processors
from rockframe.components import InitialState
from rockframe.errors import AssemblyError, collected_warnings
from rockframe.motion import GroundMotion
from rockframe.motion.operations.scaling import scaled_components
from rockframe.signals import Motion
from rockframe.signals.arrays import AnyArray
from rockframe.simulation.plan import (
    Plan,
    RunRequest,
    default_output_step,
    resolve_plan,
    run_length,
)
from rockframe.studies.sweeps.axes import SYSTEM_AXES, Axis, Changes, Grid
from rockframe.studies.sweeps.identity import description_of, digest_of
from rockframe.studies.sweeps.motions import SCALE, motion_of_case
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
        """Longest time that compilation for lanes may take [s]; None if no cases run in lanes."""
        sampled = self.histories is not None or bool(self.arguments.points)
        if not COMPILED or sampled or self.grid.count < MIN_CASES_IN_LANES:
            return None
        saved = (1.0 - LANE_TIME_RATIO) * self.grid.count * self._time_of_case() / processors()
        return COMPILING_SHARE * saved

    def to_dict(self) -> dict[str, Any]:
        """Return all that the results depend on: every field, and some scenes of a function."""
        # the source of a function need not determine its scenes
        scenes = [
            digest_of(description_of(made)) if isinstance(made, Assembly) else type(made).__name__
            for made in self._inspected_scenes
        ]
        return {"rockframe_version": __version__, **description_of(self), "scenes": scenes}

    @cached_property
    def restrainers(self) -> tuple[str, ...]:
        """Names of the restrainers in results; empty if scenes have different ones."""
        if isinstance(self.scene, SystemScene):
            return self.scene.assembly.setting.link_names
        made = [made for made in self._inspected_scenes if isinstance(made, Assembly)]
        names = {scene.setting.link_names for scene in made}
        return names.pop() if len(names) == 1 else ()

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


Change: TypeAlias = Callable[[Assembly, Plan], Plan]
"""Changes the plan of a case."""


class CasesOfJob:
    """Scenes and motions of a job's cases."""

    def __init__(self, job: SweepJob, change: Change | None = None) -> None:
        self.job = job
        self._change = change
        axes = [(axis, column.tolist()) for axis, column in job.axes]
        self._numbers = {axis.name: column for axis, column in job.axes if column.dtype.kind == "f"}
        self._scale, self._start, self._of_scene = (
            [(axis, column) for axis, column in axes if axis.changes in kinds]
            for kinds in ((Changes.MOTION,), (Changes.START,), SYSTEM_AXES)
        )
        self._scenes: dict[tuple[Any, ...], tuple[Assembly, list[str]]] = {}
        self._motion: tuple[object, GroundMotion | None] = (None, None)

    def with_change(self, change: Change) -> "CasesOfJob":
        """Return the same cases with other plans; their parts are shared."""
        changed = CasesOfJob(self.job, change)
        changed._scenes = self._scenes
        return changed

    def __len__(self) -> int:
        """Return the number of cases."""
        return len(self.job.motion_of_case)

    def scene_key(self, case: int) -> tuple[Any, ...]:
        """Return what cases of one scene have in common."""
        return tuple(column[case] for _, column in self._of_scene)

    def start_key(self, case: int) -> tuple[float, ...]:
        """Return what cases of one start have in common, if starts differ."""
        return tuple(column[case] for _, column in self._start)

    def motion_key(self, case: int) -> tuple[int, float | None]:
        """Return what cases of one motion have in common, if it is not that of the scene."""
        number = int(self.job.motion_of_case[case])
        return number, (self._scale[0][1][case] if self._scale else None)

    def scene(self, case: int) -> tuple[Assembly, list[str]]:
        """Return the scene of a case, and the warnings of its assembly."""
        key = self.scene_key(case)
        if key not in self._scenes:
            values = {axis: column[case] for axis, column in self._of_scene}
            with collected_warnings() as warned:
                self._scenes[key] = self.job.scene.assembled(values), warned
        return self._scenes[key]

    @property
    def can_run_in_lanes(self) -> bool:
        """Whether scenes of many cases can be assembled at once: of parameters, not by a user."""
        return isinstance(self.job.scene, SystemScene)

    def word_key(self, case: int) -> tuple[Any, ...]:
        """Return the differences between cases that are words or counts."""
        words = [column for axis, column in self._of_scene if axis.name not in self._numbers]
        return tuple(column[case] for column in words)

    def _values_of(self, axis: Axis, values: list[Any], which: CaseIndices) -> Any:
        """Return the value of an axis in many cases, which agree where it is no number."""
        numbers = self._numbers.get(axis.name)
        return values[which[0]] if numbers is None else CaseArray(numbers[which])

    def scene_of_many(self, which: CaseIndices) -> tuple[Assembly, list[str]]:
        """Return the scene of many cases; the warnings are the same for all."""
        values = {axis: self._values_of(axis, column, which) for axis, column in self._of_scene}
        with collected_warnings() as warned:
            return self.job.scene.assembled(values), warned

    def unscaled_motion(self, case: int) -> GroundMotion | None:
        """Return the motion of a case before it is scaled; the scene's unless there are others."""
        motion = self.job.motions[self.job.motion_of_case[case]]
        if motion is None and not self.can_run_in_lanes:  # a function adds it to its systems
            motion = self.scene(case)[0].parts.motion
        return motion

    def length_key(self, case: int) -> tuple[float, float, bool] | None:
        """Return time step and the length of the motion of a case, and whether it is vertical."""
        motion = self.unscaled_motion(case)
        if motion is None:
            return None
        return motion.si.time_step, motion.si.duration, motion.si.vertical is not None

    def ground_motion(self, case: int) -> Motion | None:
        """Return the motion of a case only as numbers, which is cheaper."""
        motion = self.unscaled_motion(case)
        if motion is None or [axis.name for axis, _ in self._scale] != [SCALE]:
            case_motion = self.motion(case)
            return None if case_motion is None else case_motion.si
        return scaled_components(motion.si, self._scale[0][1][case])

    def motion(self, case: int) -> GroundMotion | None:
        """Return the motion of a case; None where the ground stands still."""
        motion = self.unscaled_motion(case)
        if not self._scale:
            return motion
        if motion is None:
            msg = "there is no motion to scale; give one"
            raise AssemblyError([msg])
        ((axis, values),) = self._scale
        key = (id(motion), values[case])
        if self._motion[0] != key:
            self._motion = (key, motion_of_case(motion, axis.name, values[case], self.job.period))
        return self._motion[1]

    def plan(self, case: int) -> tuple[Assembly, list[str], Plan]:
        """Return the scene of a case, the warnings of its assembly, and the plan."""
        system, messages = self.scene(case)
        start = {axis.parameter: column[case] for axis, column in self._start}
        return system, messages, self._plan(system, start, self.motion(case))

    def plan_of_many(self, which: CaseIndices) -> tuple[Assembly, list[str], Plan]:
        """Return the same of many cases, with the motion of the first before it is scaled."""
        system, messages = self.scene_of_many(which)
        start = {one.parameter: self._values_of(one, column, which) for one, column in self._start}
        return system, messages, self._plan(system, start, self.unscaled_motion(int(which[0])))

    def _plan(
        self, system: Assembly, start: Mapping[str, float], motion: GroundMotion | None
    ) -> Plan:
        faults: list[str] = []
        arguments = self.job.arguments
        if start and isinstance(arguments.initial, InitialState):
            arguments = replace(arguments, initial=arguments.initial.with_si(start))
        plan = resolve_plan(arguments, system, motion, faults)
        if faults:
            raise AssemblyError(faults)
        return plan if self._change is None else self._change(system, plan)
