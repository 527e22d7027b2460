"""Cases whose runs go side by side in lanes, of scenes assembled one by one, or many at once.

Values of many cases are in arrays over the cases, computed by the code of a single case,
:mod:`rockframe.case_arrays`.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from rockframe.case_arrays import (
    CaseArray,
    CaseIndices,
    SingleCaseOnly,
    run_by_branches,
    values_by_case,
)
from rockframe.compiled import compiling_for
from rockframe.errors import RockframeError
from rockframe.signals import Motion
from rockframe.signals.arrays import AnyArray
from rockframe.simulation.certify.second_look import Look, look_at
from rockframe.simulation.plan import Plan, run_length, start_of
from rockframe.simulation.run import Response, has_no_cautions, in_motion, run_scalars
from rockframe.simulation.soundness import STILL_MOVING
from rockframe.solve.equations import is_called
from rockframe.solve.integrate import run_start
from rockframe.solve.lanes.integrate import (
    LaneRun,
    Outcomes,
    batch_key,
    can_run_in_lanes,
    initial_rows,
    integrate_lanes,
    join_outcomes,
)
from rockframe.solve.trajectory import Summary
from rockframe.solve.workspace import Status
from rockframe.studies.sweeps.study import CasesOfJob
from rockframe.system.assembly import Assembly

BATCH_SIZE: Final = 512
"""Cases that are prepared together, so that their motions do not fill the memory."""


@dataclass(frozen=True)
class Finished:
    """A case that has run."""

    case: int  # its number in the job
    system: Assembly  # its scene
    summary: Summary  # the outcome
    warnings: list[str]  # of the assembly of its scene
    # with histories; None for runs in lanes, which have no warnings
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
    warnings: list[str]
    run: LaneRun
    kind: Any


def _run_in_lanes(rows: Sequence[tuple[int, LaneScene, Motion | None]]) -> Iterator[Finished]:
    """Run cases whose systems are of one kind, and give those without warnings."""
    cases, every_scene, every_motion = zip(*rows, strict=True)
    (scenes, scene_of), (motions, motion_of) = _distinct(every_scene), _distinct(every_motion)
    outcomes = integrate_lanes([scene.run for scene in scenes], motions, scene_of, motion_of)
    for k, (case, scene) in enumerate(zip(cases, every_scene, strict=True)):
        summary = outcomes.summary(k, scene.run.start.substeps)
        if has_no_cautions(scene.system, summary):
            yield Finished(case, scene.system, summary, scene.warnings)


def _distinct(objects: Sequence[Any]) -> tuple[list[Any], CaseIndices]:
    """Return each of several objects once, and the place of each among these."""
    places: dict[int, int] = {}
    place_of = np.array([places.setdefault(id(item), len(places)) for item in objects], np.intp)
    return [objects[k] for k in np.unique(place_of, return_index=True)[1]], place_of


def compilation_check(timeout: float) -> Callable[[LaneScene], bool]:
    """Return a function that says whether a scene has machine code, compiled within a time [s]."""
    kinds: dict[Any, bool] = {}

    def ready(scene: LaneScene) -> bool:
        if scene.kind not in kinds:
            kinds[scene.kind] = False  # unless it can be compiled
            with compiling_for(f"a sweep in lanes ({scene.system.setting.model})"):
                kinds[scene.kind] = can_run_in_lanes(scene.run, timeout)
        return kinds[scene.kind]

    return ready


def run_assembled_singly(
    cases: CasesOfJob,
    which: Sequence[int],
    stopped: Callable[[], bool],
    ready: Callable[[LaneScene], bool],
) -> Iterator[Finished | Failed]:
    """Run side by side the cases whose scenes allow it, assembled one by one."""
    scenes: dict[Any, LaneScene | None] = {}
    for begin in range(0, len(which), BATCH_SIZE):
        groups: dict[Any, list[tuple[int, LaneScene, Motion | None]]] = {}
        motions: dict[Any, Motion | None] = {}
        for case in which[begin : begin + BATCH_SIZE]:
            try:
                key = (cases.scene_key(case), cases.start_key(case), cases.length_key(case))
                if key not in scenes:
                    scenes[key] = None  # unless it can be prepared
                    prepared = prepare_lanes(*cases.plan(case))
                    if prepared is not None and ready(prepared):
                        scenes[key] = prepared
                if (scene := scenes[key]) is not None:
                    moved = (id(cases.unscaled_motion(case)), cases.motion_key(case)[1])
                    if moved not in motions:
                        motions[moved] = cases.ground_motion(case)  # which may fail
                    groups.setdefault(scene.kind, []).append((case, scene, motions[moved]))
            except (RockframeError, MemoryError):  # which is reported when the case runs alone
                continue
            except Exception as problem:
                yield Failed(case, problem)
        for group in groups.values():
            if stopped():
                return
            yield from _run_in_lanes(group)


def prepare_lanes(system: Assembly, messages: list[str], plan: Plan) -> LaneScene | None:
    """Prepare a scene for lanes; None if its runs must be made one by one."""
    if plan.output_step is not None:
        return None  # friction is checked at samples, which lanes do not have
    if not system.options.slope.level or (plan.has_vertical_motion and not system.setting.flies):
        return None  # the ground differs for each scene, or a block may leave it
    model = system.model
    if model.shows_bodies or model.links or is_called(model.system):
        return None  # its equations use lists, for which there are no lanes
    begin = run_start(
        system.model, start_of(plan.initial), plan.accuracy, interval=plan.interval,
        duration=plan.duration, output_step=None, stop_at_overturning=plan.stop_at_overturning,
    )  # fmt: skip
    run = LaneRun(system.model, begin)
    return LaneScene(system, messages, run, batch_key(system.model))


@dataclass(frozen=True)
class FinishedGroup:
    """Cases that have run and ended in the same way."""

    cases: CaseIndices  # their numbers in the job
    status: Status
    warnings: list[str]  # of the assembly of their scenes, and of their runs
    scalars: dict[str, AnyArray | float]  # of each, or of all
    look: Look  # indications of their verdicts, with arrays instead of numbers

    def looks(self) -> list[tuple[int, Look]]:
        """Return the indications of each verdict."""
        count = len(self.cases)
        columns = (
            [value] * count if isinstance(value, bool) else values_by_case(value, count).tolist()
            for value in vars(self.look).values()
        )
        rows = zip(*columns, strict=True)
        return [(case, Look(*row)) for case, row in zip(self.cases.tolist(), rows, strict=True)]


@dataclass(frozen=True)
class _Batch:
    """Cases whose scenes were assembled in the same way."""

    one: LaneScene  # that of the first
    cases: CaseIndices
    rows: Any


def run_assembled_together(
    cases: CasesOfJob,
    which: Sequence[int],
    stopped: Callable[[], bool],
    ready: Callable[[LaneScene], bool],
) -> Iterator[Finished | FinishedGroup]:
    """Run the cases that can be assembled together; the others must be run one by one."""
    if not cases.can_run_in_lanes:
        return
    kinds: dict[Any, list[_Batch]] = {}
    # what is no number in their scenes, and the length of their motions, is the same in all
    alike: dict[Any, list[int]] = {}
    for case in which:
        alike.setdefault((cases.word_key(case), cases.length_key(case)), []).append(case)
    for members in alike.values():
        places = np.array(members, dtype=np.intp)
        for _, group in run_by_branches(lambda some: _assemble_batch(cases, some), places):
            if ready(group.one):
                kinds.setdefault(group.one.kind, []).append(group)
    for groups in kinds.values():
        every = np.concatenate([group.cases for group in groups])
        group_of = np.repeat(np.arange(len(groups)), [len(group.cases) for group in groups])
        rows = np.concatenate([group.rows for group in groups])
        order = np.argsort(every, kind="stable")  # neighbours share their motion
        ran: list[CaseIndices] = []
        batches: list[Outcomes] = []
        for begin in range(0, len(order), BATCH_SIZE):
            if stopped():
                return
            here = order[begin : begin + BATCH_SIZE]
            run, outcomes = _integrate_batch(cases, groups[0].one, every[here], rows[here])
            ran.append(here[run])
            batches.append(outcomes)
        here = np.concatenate(ran)
        yield from _results_of_lanes(
            cases, groups, group_of[here], every[here], join_outcomes(batches)
        )


def _assemble_batch(cases: CasesOfJob, some: CaseIndices) -> _Batch:
    """Assemble the scenes of cases; give the row of each for lanes."""
    first = int(some[0])
    several, single = prepare_lanes(*cases.plan_of_many(some)), prepare_lanes(*cases.plan(first))
    if several is None or single is None:
        raise SingleCaseOnly
    rows = initial_rows(several.run.model, several.run.start, len(some))
    if rows[0].tobytes() != initial_rows(single.run.model, single.run.start).tobytes():
        raise SingleCaseOnly
    return _Batch(single, some, rows)


def _integrate_batch(
    cases: CasesOfJob, single: LaneScene, some: CaseIndices, rows: Any
) -> tuple[CaseIndices, Outcomes]:
    """Run cases whose motions are available; give which these are."""
    motions: list[Motion | None] = []
    places: dict[Any, int] = {}
    ran: list[int] = []
    motion_of: list[int] = []
    for k, case in enumerate(some.tolist()):
        key = cases.motion_key(case)
        if key not in places:
            try:
                motions.append(cases.ground_motion(case))
            except Exception:  # noqa: S112 - reported when the case runs alone
                continue
            places[key] = len(places)
        ran.append(k)
        motion_of.append(places[key])
    run = LaneRun(single.run.model, single.run.start, rows)
    which = np.array(ran, dtype=np.intp)
    return which, integrate_lanes([run], motions, which, np.array(motion_of, dtype=np.intp))


def _results_of_lanes(
    cases: CasesOfJob,
    groups: Sequence[_Batch],
    group_of: CaseIndices,
    ran: CaseIndices,
    outcomes: Outcomes,
) -> Iterator[Finished | FinishedGroup]:
    """Return the outcomes of runs, together for those that ended in the same way."""
    status, modes = outcomes.status, outcomes.modes
    # the mode determines whether a standing block may overturn later, and which slips have ended
    with_modes = (status == Status.COMPLETED) | groups[0].one.system.setting.slides
    way = np.column_stack([group_of, status, np.where(with_modes, modes, 0)])
    ways, way_of = np.unique(way, axis=0, return_inverse=True)
    alone = np.ones(len(ran), dtype=np.bool_)
    for k, (number, *_) in enumerate(ways.tolist()):
        substeps = groups[number].one.run.start.substeps

        def work(some: CaseIndices, substeps: int = substeps) -> FinishedGroup:
            return _group_result(cases, ran[some], outcomes.summary_of_many(some, substeps))

        for some, finished in run_by_branches(work, np.flatnonzero(way_of == k)):
            alone[some] = False
            yield finished
    for k in np.flatnonzero(alone).tolist():
        try:
            system, messages = cases.scene(int(ran[k]))
        except Exception:  # noqa: S112 - reported when the case runs alone
            continue
        summary = outcomes.summary(k, groups[group_of[k]].one.run.start.substeps)
        if has_no_cautions(system, summary):
            yield Finished(int(ran[k]), system, summary, messages)


def _group_result(cases: CasesOfJob, some: CaseIndices, summary: Summary) -> FinishedGroup:
    system, messages = cases.scene_of_many(some)
    missing: list[str] = []
    if not has_no_cautions(system, summary):
        raise SingleCaseOnly
    scalars = run_scalars(system, summary, missing)
    warnings = [*messages, *([STILL_MOVING] if in_motion(system, summary, missing) else [])]
    duration = run_length(cases.job.arguments, cases.unscaled_motion(int(some[0])))
    look = look_at(system.setting, summary, duration)
    if missing:
        raise SingleCaseOnly
    arrays: dict[str, AnyArray | float] = {
        name: value.values if isinstance(value, CaseArray) else value
        for name, value in scalars.items()
    }
    return FinishedGroup(some, summary.status, warnings, arrays, look)
