"""Cases whose runs go side by side, those that cannot one by one, and which of them run again."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final

import numpy as np

from rockframe.compiled import compiling_for
from rockframe.errors import PLEASE_REPORT, RockframeError
from rockframe.signals import Motion
from rockframe.simulation.certify.second_look import Look, is_sure, look_at, second_look
from rockframe.simulation.plan import Plan, run_length, start_of
from rockframe.simulation.run import Response, has_no_cautions, respond
from rockframe.solve.accuracy import LEVELS, AccuracyLevel
from rockframe.solve.integrate import STILL_INTERVAL, begun
from rockframe.solve.lanes.integrate import LaneRun, integrate_lanes, kind_of, lanes_compiled
from rockframe.solve.layout import Status
from rockframe.solve.trajectory import Summary, run_counts
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
class _Scene:
    """A scene under motions of one length and time step."""

    system: Assembly
    said: list[str]
    run: LaneRun
    kind: Any


@dataclass(eq=False)
class _Group:
    """Cases whose systems are of one kind."""

    scenes: list[_Scene] = field(default_factory=list)
    motions: list[Motion | None] = field(default_factory=list)
    cases: list[int] = field(default_factory=list)
    scene_of: list[int] = field(default_factory=list)
    motion_of: list[int] = field(default_factory=list)
    _scene_places: dict[int, int] = field(default_factory=dict)
    _motion_places: dict[Any, int] = field(default_factory=dict)

    def add(self, case: int, scene: _Scene, key: Any, motion: Callable[[], Motion | None]) -> None:
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


def run_side_by_side(
    cases: CasesOfJob, which: Sequence[int], stopped: Callable[[], bool], patience: float
) -> Iterator[Finished | Failed]:
    """Run what can run side by side."""
    scenes: dict[Any, _Scene | None] = {}
    kinds: dict[Any, bool] = {}

    def ready(scene: _Scene) -> bool:
        if scene.kind not in kinds:
            kinds[scene.kind] = False  # unless it can be compiled
            with compiling_for(f"a sweep in lanes ({scene.system.setting.model})"):
                kinds[scene.kind] = lanes_compiled(scene.run, patience)
        return kinds[scene.kind]

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
    scenes: dict[Any, _Scene | None],
    groups: dict[Any, _Group],
    ready: Callable[[_Scene], bool],
) -> None:
    unscaled = cases.unscaled(case)
    length = None if unscaled is None else (unscaled.si.time_step, unscaled.si.duration)
    vertical = unscaled is not None and unscaled.si.vertical is not None
    key = (cases.scene_key(case), cases.start_key(case), length, vertical)
    if key not in scenes:
        scenes[key] = None  # unless it can be prepared
        prepared = _prepared(cases, case, vertical)
        scenes[key] = prepared if prepared is not None and ready(prepared) else None
    scene = scenes[key]
    if scene is None:
        return

    def motion() -> Motion | None:
        found = cases.motion(case)
        return None if found is None else found.si

    moved = (id(unscaled), cases.motion_key(case)[1])
    groups.setdefault(scene.kind, _Group()).add(case, scene, moved, motion)


def _prepared(cases: CasesOfJob, case: int, vertical: bool) -> _Scene | None:
    """Prepare a scene for lanes; None if its runs need a closer look."""
    system, said, plan = cases.planned(case)
    if plan.output_step is not None:
        return None  # samples are looked at, for friction
    if not system.options.slope.level or (vertical and not system.setting.flies):
        return None  # the ground is another one for each scene; or a block may leave it
    if system.model.shows_bodies or system.model.links:
        return None  # its equations work in lists, for which there are no lanes
    interval = STILL_INTERVAL if plan.motion is None else plan.motion.si.time_step
    begin = begun(
        system.model, start_of(plan.initial), plan.accuracy, interval=interval,
        duration=plan.duration, output_step=None, stop_at_overturning=plan.stop_at_overturning,
    )  # fmt: skip
    run = LaneRun(system.model, begin)
    return _Scene(system, said, run, kind_of(system.model))


def _run(group: _Group) -> Iterator[Finished]:
    found = integrate_lanes(
        [scene.run for scene in group.scenes], group.motions,
        np.array(group.scene_of), np.array(group.motion_of),
    )  # fmt: skip
    for k, case in enumerate(group.cases):
        scene = group.scenes[group.scene_of[k]]
        summary = Summary(
            status=Status(int(found.status[k])),
            substeps=scene.run.begun.substeps,
            ending=found.endings[k],
            **run_counts(found.clock[k], found.counters[k]),
        )
        if has_no_cautions(scene.system, summary):
            yield Finished(case, scene.system, summary, scene.said)


def each_run(
    cases: CasesOfJob,
    which: Sequence[int],
    stopped: Callable[[], bool],
    patience: float | None,
) -> Iterator[Finished | Failed]:
    """Run cases."""
    alone = set(which)
    faults: dict[int, Exception] = {}
    if patience is not None:
        for found in run_side_by_side(cases, which, stopped, patience):
            if isinstance(found, Failed):
                faults[found.case] = found.problem
            else:
                alone.discard(found.case)
                yield found
    for case in sorted(alone):
        if stopped():
            return
        try:
            system, said, plan = cases.planned(case)
            response = respond(system, plan)
            if case in faults:  # that it alone does not have
                said = [*said, _not_beside_others(faults[case])]
            yield Finished(case, system, response.trajectory, said, response)
        except Exception as problem:  # whatever it is, it is this case's alone
            yield Failed(case, problem)


def _not_beside_others(problem: Exception) -> str:
    """Say of a case that ran alone why it did not run in a lane."""
    kind = type(problem).__name__
    return f"its run beside others failed ({kind}: {problem}), and it ran alone: {PLEASE_REPORT}"


SCREEN: Final = "screen"
"""What stands for the accuracy of screened sweeps."""
FIRST: Final = AccuracyLevel.FAST
"""Level at which all cases run."""
AGAIN: Final = AccuracyLevel.STANDARD
"""Level at which cases run again whose verdict is in doubt."""


def look_at_case(cases: CasesOfJob, run: Finished) -> Look:
    """Take from a run of a case what tells of its verdict."""
    duration = run_length(cases.job.arguments, cases.unscaled(run.case))
    return look_at(run.system.setting, run.summary, duration)


def in_doubt(
    cases: CasesOfJob, first: Mapping[int, Look], stopped: Callable[[], bool]
) -> list[int]:
    """Run cases a second time, and give those whose verdict is not sure."""
    doubtful = set(first)
    for run in each_run(cases.changed(second_look), sorted(first), stopped, cases.job.patience):
        if isinstance(run, Finished) and is_sure(first[run.case], look_at_case(cases, run)):
            doubtful.discard(run.case)
    return sorted(doubtful)


def repeated(_: Assembly, plan: Plan) -> Plan:
    """Give the same run by tolerance."""
    return replace(plan, accuracy=LEVELS[AGAIN])
