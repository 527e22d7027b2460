"""The cases of a job: scene, motion and plan of each, made when first requested."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, TypeAlias

from rockframe.case_arrays import CaseArray, CaseIndices
from rockframe.components import InitialState
from rockframe.errors import AssemblyError, collected_warnings
from rockframe.motion import GroundMotion
from rockframe.motion.operations.scaling import scaled_components
from rockframe.signals import Motion
from rockframe.simulation.plan import Plan, resolve_plan
from rockframe.studies.sweeps.axes import SYSTEM_AXES, Axis, Changes
from rockframe.studies.sweeps.motions import SCALE, motion_of_case
from rockframe.studies.sweeps.scenes import SystemScene
from rockframe.studies.sweeps.study import SweepJob
from rockframe.system.assembly import Assembly

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
        assembled = self._scenes.get(key)
        if assembled is None:
            values = {axis: column[case] for axis, column in self._of_scene}
            with collected_warnings() as warned:
                assembled = self._scenes[key] = (self.job.scene.assembled(values), warned)
        return assembled

    @property
    def can_run_in_lanes(self) -> bool:
        """Whether scenes of many cases can be assembled at once: of parameters, not by a user."""
        return isinstance(self.job.scene, SystemScene)

    def word_key(self, case: int) -> tuple[Any, ...]:
        """Return the differences between cases that are words or counts."""
        return tuple(
            column[case] for axis, column in self._of_scene if axis.name not in self._numbers
        )

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
        start = {
            axis.parameter: self._values_of(axis, column, which) for axis, column in self._start
        }
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
