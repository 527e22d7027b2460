"""The cases of a job: scene, motion and plan of each, made when first asked for."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, TypeAlias

from rockframe.components import InitialState
from rockframe.errors import AssemblyError, collected_warnings
from rockframe.motion import GroundMotion
from rockframe.simulation.plan import Plan, fit_plan
from rockframe.studies.sweeps.axes import OF_SCENES, Changes
from rockframe.studies.sweeps.motions import motion_of_case
from rockframe.studies.sweeps.scenes import started
from rockframe.studies.sweeps.study import SweepJob
from rockframe.system.assembly import Assembly

Change: TypeAlias = Callable[[Assembly, Plan], Plan]
"""Changes the plan of a case."""


class CasesOfJob:
    """Scenes and motions of a job's cases."""

    def __init__(self, job: SweepJob, change: Change | None = None) -> None:
        self.job = job
        self._change = change
        axes = [(axis, each.tolist()) for axis, each in job.axes]
        self._scale = [(axis.name, each) for axis, each in axes if axis.changes is Changes.MOTION]
        self._start = [
            (axis.parameter, each) for axis, each in axes if axis.changes is Changes.START
        ]
        self._of_scene = [(axis, each) for axis, each in axes if axis.changes in OF_SCENES]
        self._scenes: dict[tuple[Any, ...], tuple[Assembly, list[str]]] = {}
        self._motion: tuple[object, GroundMotion | None] = (None, None)

    def changed(self, change: Change) -> "CasesOfJob":
        """Give the same cases with other plans; what they are made of is shared."""
        other = CasesOfJob(self.job, change)
        other._scenes = self._scenes
        return other

    def __len__(self) -> int:
        """Give the number of cases."""
        return len(self.job.motion_of_case)

    def scene_key(self, case: int) -> tuple[Any, ...]:
        """Give what cases of one scene have in common."""
        return tuple(each[case] for _, each in self._of_scene)

    def start_key(self, case: int) -> tuple[float, ...]:
        """Give what cases of one start have in common, where it is not that of all."""
        return tuple(each[case] for _, each in self._start)

    def motion_key(self, case: int) -> tuple[int, float | None]:
        """Give what cases of one motion have in common, where it is not the scene's."""
        number = int(self.job.motion_of_case[case])
        return number, (self._scale[0][1][case] if self._scale else None)

    def scene(self, case: int) -> tuple[Assembly, list[str]]:
        """Give the scene of a case, and what is warned of when it is assembled."""
        key = self.scene_key(case)
        found = self._scenes.get(key)
        if found is None:
            values = {axis: each[case] for axis, each in self._of_scene}
            with collected_warnings() as said:
                found = self._scenes[key] = (self.job.scene.assembled(values), said)
        return found

    def unscaled(self, case: int) -> GroundMotion | None:
        """Give the motion of a case before it is scaled; the scene's unless there are others."""
        motion = self.job.motions[self.job.motion_of_case[case]]
        return self.scene(case)[0].parts.motion if motion is None else motion

    def motion(self, case: int) -> GroundMotion | None:
        """Give the motion of a case; None where the ground stands still."""
        motion = self.unscaled(case)
        if not self._scale:
            return motion
        if motion is None:
            msg = "there is no motion to scale; give one"
            raise AssemblyError([msg])
        ((name, values),) = self._scale
        key = (id(motion), values[case])
        if self._motion[0] != key:
            self._motion = (key, motion_of_case(motion, name, values[case], self.job.period))
        return self._motion[1]

    def planned(self, case: int) -> tuple[Assembly, list[str], Plan]:
        """Give the scene of a case, what is warned of when it is assembled, and the plan."""
        system, said = self.scene(case)
        faults: list[str] = []
        arguments = self.job.arguments
        if self._start and isinstance(arguments.initial, InitialState):
            values = {name: each[case] for name, each in self._start}
            arguments = replace(arguments, initial=started(arguments.initial, values))
        plan = fit_plan(arguments, system, self.motion(case), faults)
        if faults:
            raise AssemblyError(faults)
        return system, said, plan if self._change is None else self._change(system, plan)
