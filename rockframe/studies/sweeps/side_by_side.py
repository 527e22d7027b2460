"""Cases whose scenes are assembled one by one, and whose runs go side by side."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from rockframe.compiled import compiling_for
from rockframe.errors import RockframeError
from rockframe.signals import Motion
from rockframe.simulation.plan import Plan, start_of
from rockframe.simulation.run import Response, has_no_cautions
from rockframe.solve.integrate import begun
from rockframe.solve.lanes.integrate import (
    LaneRun,
    integrate_lanes,
    kind_of,
    lanes_compiled,
)
from rockframe.solve.trajectory import Summary
from rockframe.studies.sweeps.cases_of_job import CasesOfJob
from rockframe.system.assembly import Assembly

TOGETHER: Final = 512
"""Cases that are prepared together, so that their motions do not fill the memory."""


@dataclass(frozen=True)
class Finished:
    """A case that has run."""

    case: int  # its number in the job
    system: Assembly  # its scene
    summary: Summary  # what became of it
    said: list[str]  # what was warned of when its scene was assembled
    # with the histories; of runs side by side, of which there is nothing to be warned, None
    response: Response | None = None


@dataclass(frozen=True)
class Failed:
    """A case without a run."""

    case: int  # its number in the job
    problem: Exception  # why


@dataclass(frozen=True)
class LaneScene:
    """A scene under motions of one length and time step, ready for lanes."""

    system: Assembly
    said: list[str]
    run: LaneRun
    kind: Any


@dataclass(eq=False)
class _Group:
    """Cases whose systems are of one kind."""

    scenes: list[LaneScene] = field(default_factory=list)
    motions: list[Motion | None] = field(default_factory=list)
    cases: list[int] = field(default_factory=list)
    scene_of: list[int] = field(default_factory=list)
    motion_of: list[int] = field(default_factory=list)
    _scene_places: dict[int, int] = field(default_factory=dict)
    _motion_places: dict[Any, int] = field(default_factory=dict)

    def add(
        self, case: int, scene: LaneScene, key: Any, motion: Callable[[], Motion | None]
    ) -> None:
        """Take a case up."""
        place = self._scene_places.setdefault(id(scene), len(self.scenes))
        if place == len(self.scenes):
            self.scenes.append(scene)
        if key not in self._motion_places:
            found = motion()  # which may fail
            self._motion_places[key] = len(self.motions)
            self.motions.append(found)
        self.cases.append(case)
        self.scene_of.append(place)
        self.motion_of.append(self._motion_places[key])


def when_compiled(patience: float) -> Callable[[LaneScene], bool]:
    """Tell of scenes whether there is machine code for them, compiled within some time [s]."""
    kinds: dict[Any, bool] = {}

    def ready(scene: LaneScene) -> bool:
        if scene.kind not in kinds:
            kinds[scene.kind] = False  # unless it can be compiled
            with compiling_for(f"a sweep in lanes ({scene.system.setting.model})"):
                kinds[scene.kind] = lanes_compiled(scene.run, patience)
        return kinds[scene.kind]

    return ready


def run_side_by_side(
    cases: CasesOfJob,
    which: Sequence[int],
    stopped: Callable[[], bool],
    ready: Callable[[LaneScene], bool],
) -> Iterator[Finished | Failed]:
    """Run what can run side by side."""
    scenes: dict[Any, LaneScene | None] = {}
    for begin in range(0, len(which), TOGETHER):
        groups: dict[Any, _Group] = {}
        for case in which[begin : begin + TOGETHER]:
            try:
                _take_up(cases, case, scenes, groups, ready)
            except RockframeError:  # which is told of where the case runs alone
                continue
            except Exception as problem:
                yield Failed(case, problem)
        for group in groups.values():
            if stopped():
                return
            yield from _run(group)


def _take_up(
    cases: CasesOfJob,
    case: int,
    scenes: dict[Any, LaneScene | None],
    groups: dict[Any, _Group],
    ready: Callable[[LaneScene], bool],
) -> None:
    key = (cases.scene_key(case), cases.start_key(case), cases.length_key(case))
    if key not in scenes:
        scenes[key] = None  # unless it can be prepared
        found = prepared(*cases.planned(case))
        scenes[key] = found if found is not None and ready(found) else None
    scene = scenes[key]
    if scene is None:
        return

    def motion() -> Motion | None:
        found = cases.motion(case)
        return None if found is None else found.si

    moved = (id(cases.unscaled(case)), cases.motion_key(case)[1])
    groups.setdefault(scene.kind, _Group()).add(case, scene, moved, motion)


def prepared(system: Assembly, said: list[str], plan: Plan) -> LaneScene | None:
    """Prepare a scene for lanes; None if its runs need a closer look."""
    if plan.output_step is not None:
        return None  # samples are looked at, for friction
    if not system.options.slope.level or (plan.has_vertical_motion and not system.setting.flies):
        return None  # the ground is another one for each scene; or a block may leave it
    if system.model.shows_bodies or system.model.links:
        return None  # its equations work in lists, for which there are no lanes
    begin = begun(
        system.model, start_of(plan.initial), plan.accuracy, interval=plan.interval,
        duration=plan.duration, output_step=None, stop_at_overturning=plan.stop_at_overturning,
    )  # fmt: skip
    run = LaneRun(system.model, begin)
    return LaneScene(system, said, run, kind_of(system.model))


def _run(group: _Group) -> Iterator[Finished]:
    found = integrate_lanes(
        [scene.run for scene in group.scenes], group.motions,
        np.array(group.scene_of), np.array(group.motion_of),
    )  # fmt: skip
    for k, case in enumerate(group.cases):
        scene = group.scenes[group.scene_of[k]]
        summary = found.summary(k, scene.run.begun.substeps)
        if has_no_cautions(scene.system, summary):
            yield Finished(case, scene.system, summary, scene.said)
