"""From the arguments of a sweep to the study that they describe; all faults are told at once.

Also which histories are kept, and whether there is memory for them.
"""

import math
import os
import re
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, TypeVar, cast

import numpy as np
import xarray as xr

from rockframe.errors import RecordWarning, RockframeError, SolverWarning, StudyError, shown, warn
from rockframe.motion import GroundMotion
from rockframe.results.outcome import Generic
from rockframe.results.schema import GROUPS, SCHEMA
from rockframe.results.variables.requests import (
    ACCELERATIONS,
    FORCE_SCALARS,
    OTHERS,
    POINT_PEAKS,
    POINT_TIME,
    POINTS,
    REACTIONS,
)
from rockframe.results.variables.runs import ENERGY_HISTORIES, EVENTS_AND_SCALARS, HISTORIES
from rockframe.results.variables.studies import MOTION, SWEEP
from rockframe.results.variables.variable import EVENT, TIME
from rockframe.simulation.plan import (
    RunRequest,
    listed,
    read_arguments,
    run_length,
    usual_output_step,
)
from rockframe.studies.sweeps.axes import MOST_CASES, OWNER, Axis, Changes, Grid, faults_of_values
from rockframe.studies.sweeps.chunk import AGAIN, FIRST, SCREEN
from rockframe.studies.sweeps.motions import NO_MOTION, OF_THE_SCENE, SPECTRAL, motion_number
from rockframe.studies.sweeps.scenes import (
    FunctionScene,
    SweptScene,
    SystemScene,
    motions_of_study,
    scene_of,
)
from rockframe.studies.sweeps.study import Histories, Study
from rockframe.system.alone import AloneSetting
from rockframe.system.assembly import Assembly
from rockframe.units import PERIOD, POSITIVE, QuantityLike, own_unit, to_si

_FLOAT: Final = 8.0
"""Size of a number [bytes]."""
_COPIES: Final = 2.5
"""How often a number is there at once: of its chunk, of all, some in the order of the axes too."""
_LAZILY: Final = "they are read from the store as they are used (rf.open_study, lazy=True)"
_TOLD: Final = 0.5
"""Share of what there is from which on it is told what a study needs."""
_MEMORY: Final = Path("/proc/meminfo")
_GROUPS: Final = (
    # most, and now, of a container or a job: control groups of both versions
    (Path("/sys/fs/cgroup/memory.max"), Path("/sys/fs/cgroup/memory.current")),
    (
        Path("/sys/fs/cgroup/memory/memory.limit_in_bytes"),
        Path("/sys/fs/cgroup/memory/memory.usage_in_bytes"),
    ),
)


def check_memory(
    numbers: Mapping[str, float], cases: int, remedies: str, *, owner: str
) -> list[str]:
    """Tell what cases need, and whether it is there."""
    sizes = {what: _FLOAT * _COPIES * each * cases for what, each in numbers.items()}
    needed, there = sum(sizes.values()), available()
    parts = ", ".join(f"{what} {_shown(size)}" for what, size in sizes.items())
    told = (
        f"{cases} cases need about {_shown(needed)} of memory ({parts}); {_shown(there)} are "
        "available"
    )
    if needed > there:
        return [f"{told}; {remedies}"]
    if needed > _TOLD * there:
        warn(f"{owner}: {told}", SolverWarning)
    return []


def available() -> float:
    """Give what this process may still use; infinite where the system does not tell [bytes]."""
    found = [math.inf]
    with suppress(OSError, ValueError, IndexError):
        (line,) = (one for one in _MEMORY.read_text().splitlines() if "MemAvailable" in one)
        found.append(1024.0 * float(line.split()[1]))
    if len(found) == 1 and hasattr(os, "sysconf"):
        with suppress(OSError, ValueError):
            found.append(float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE"))
    for most, now in _GROUPS:
        with suppress(OSError, ValueError):  # "max" where there is no limit
            found.append(max(float(most.read_text()) - float(now.read_text()), 0.0))
    return min(found)


def _shown(size: float) -> str:
    """Show a size as people do."""
    for unit, large in (("TB", 1e12), ("GB", 1e9)):
        if size >= large:
            return f"{size / large:.3g} {unit}"
    return f"{size / 1e6:.3g} MB"


def numbers_of_case(
    arguments: RunRequest, kept: Histories | None, *, screened: bool
) -> dict[str, float]:
    """Tell how many numbers are kept of a case, by what they are."""
    points = len(arguments.points)
    every = [*EVENTS_AND_SCALARS, *FORCE_SCALARS, *(SWEEP if screened else ())]
    numbers = {"scalars": float(sum(not row.dims for row in every))}
    if points:
        numbers[f"peaks at {points} points"] = float(len(POINT_PEAKS) * points)
    if kept is not None:
        names = kept.names or [row.name for row in (*HISTORIES, *POINTS) if TIME[0] in row.dims]
        several = sum(points if SCHEMA[name].dims == POINT_TIME else 1 for name in names)
        numbers[f"{several} histories of {kept.count} times"] = float(several * kept.count)
    return numbers


def kept_histories(
    scene: SweptScene,
    motions: Mapping[str, GroundMotion | None],
    arguments: RunRequest,
    outputs: object,
) -> Histories | None:
    """Find the histories that are kept, and the times that those of all cases have."""
    if not arguments.histories:
        return None
    named = [str(name) for name in listed(outputs)]
    names = tuple(dict.fromkeys(one for name in named for one in GROUPS.get(name, (name,))))
    wrong = [name for name in names if SCHEMA[name].dims not in (TIME, POINT_TIME)]
    if wrong:
        msg = f"outputs: {', '.join(wrong)} are no histories, which a sweep could keep"
        raise StudyError(msg)
    own = isinstance(scene, FunctionScene) and None in motions.values()
    if own and (arguments.duration is None or arguments.output_step is None):
        msg = "histories of motions that the function makes need a duration and an output_step"
        raise StudyError(msg)
    step = arguments.output_step
    if step is None:
        steps = {usual_output_step(motion) for motion in motions.values()}
        step = min(steps)
        if len(steps) > 1:
            msg = (
                f"{OWNER}: the motions have time steps from {step:g} s to {max(steps):g} s; "
                f"histories are kept every {step:g} s for all of them, unless output_step gives "
                "another spacing"
            )
            warn(msg, RecordWarning)
    longest = max(run_length(arguments, motion) for motion in motions.values())
    return Histories(names or None, step, 1 + int(longest / step * (1.0 + 1e-12)))


Read = TypeVar("Read")

_TAKEN: Final = {*TIME, *EVENT} | {
    row.name
    for table in (
        HISTORIES, ENERGY_HISTORIES, ACCELERATIONS, REACTIONS, OTHERS, EVENTS_AND_SCALARS,
        FORCE_SCALARS, POINTS, POINT_PEAKS, SWEEP,
    )
    for row in table
}  # fmt: skip
"""Names that are not left for axes."""


def plan_study(
    scene: object,
    motions: object,
    axes: Mapping[str, object],
    cases: object,
    *,
    period: QuantityLike | None = None,
    kept: bool | None = None,
    **asked: Any,
) -> Study:
    """Check the arguments of a sweep.

    `kept` tells whether there is a store, from which a result that is larger than the memory
    can be read lazily; None where the whole result is needed at once.
    """
    faults: list[str] = []

    def tried(read: Callable[[], Read], otherwise: Read) -> Read:
        try:
            return read()
        except StudyError as problem:
            faults.extend(problem.faults)
        except RockframeError as problem:
            faults.append(str(problem).removeprefix(f"{OWNER}: "))
        return otherwise

    made = scene_of(scene)  # without it nothing else can be checked
    if isinstance(asked.get("initial"), xr.Dataset):
        faults.append(
            "initial cannot be the end of another run, whose system is one only; "
            "give an InitialState"
        )
        del asked["initial"]
    level = asked.get("accuracy")
    screened = isinstance(level, str) and level == SCREEN
    if screened:
        asked["accuracy"] = FIRST
    outputs = asked.setdefault("outputs", None)
    arguments = tried(lambda: read_arguments(faults, **asked), None)
    nothing = OF_THE_SCENE if isinstance(made, FunctionScene) else NO_MOTION
    none: dict[str, GroundMotion | None] = {nothing: None}
    given = {**tried(lambda: motions_of_study(motions, made) or none, none)}
    of_case: Generic | None = None
    table = tried(lambda: _table(cases), {})
    if MOTION in table:
        column, names = np.asarray(table.pop(MOTION)).tolist(), list(given)
        of_case = tried(
            lambda: np.array([motion_number(one, names, owner="cases") for one in column], np.intp),
            None,
        )
    rows = _read(made, table, faults, tried, repeats=True)
    grid_axes = _read(made, axes, faults, tried, repeats=False)
    faults += _twice(rows, grid_axes)
    faults += made.faults([*rows, *grid_axes])
    lengths = {axis.name: len(axis.values) for axis in rows}
    lengths |= {} if of_case is None else {MOTION: len(of_case)}
    if len(set(lengths.values())) > 1:
        told = ", ".join(f"{name} {length}" for name, length in lengths.items())
        faults.append(f"the columns of cases differ in length: {told}")
    if isinstance(made, SystemScene):
        made = made.with_parts_of([*rows, *grid_axes])
    seconds = tried(lambda: _period(period, [*rows, *grid_axes]), None)
    if arguments is None or faults:
        raise StudyError(*faults)
    handed_over = False
    if screened and isinstance(made, SystemScene):
        handed_over = not _pays_to_screen(made.assembly, given.values())
        screened = not handed_over
    if handed_over:
        asked["accuracy"] = AGAIN
        arguments = read_arguments(faults, **asked)
    grid = Grid(tuple(grid_axes), tuple(rows), len(given), of_case)
    if not 0 < grid.count <= MOST_CASES:
        faults.append(f"there are {grid.count} cases; expected 1 to {MOST_CASES}")
    if isinstance(made, SystemScene) and arguments.duration is None and None in given.values():
        faults.append("nothing to simulate: give motions, or a duration for a still ground")
    histories = tried(lambda: kept_histories(made, given, arguments, outputs), None)
    of_runs = arguments
    if histories is not None and len({*map(usual_output_step, given.values())}) > 1:
        of_runs = replace(arguments, output_step=histories.step)  # all at the times that are kept
    numbers = numbers_of_case(of_runs, histories, screened=screened)
    way_out = _LAZILY if kept else _remedies(of_runs, histories, may_be_kept=kept is False)
    too_large = check_memory(numbers, grid.count, way_out, owner=OWNER)
    if kept and not faults:
        for told in too_large:
            warn(f"{OWNER}: {told}", SolverWarning)
    else:
        faults += too_large
    if faults:
        raise StudyError(*faults)
    return Study(
        made, grid, given, of_runs, seconds, histories, screened=screened,
        handed_over=handed_over, lazy=bool(too_large),
    )  # fmt: skip


def _pays_to_screen(system: Assembly, motions: Iterable[GroundMotion | None]) -> bool:
    """Tell whether two runs by fixed steps cost less than one by tolerance.

    On rigid ground there are no more steps by tolerance. Under pulses in closed form there are
    few of either kind, so that a second run costs what surrounds the steps; those of several
    bodies are dear enough.
    """
    if not system.setting.steps_cost_most:
        return False
    return not isinstance(system.setting, AloneSetting) or any(
        one is None or one.recipe is None for one in motions
    )


def _remedies(arguments: RunRequest, histories: Histories | None, *, may_be_kept: bool) -> str:
    """Say what would need less memory."""
    ways = ["run fewer cases"]
    ways += ["give a store, from which they are read as they are used"] if may_be_kept else []
    ways += ["name fewer points"] if arguments.points else []
    if histories is not None:
        ways += ["name fewer outputs", "give a longer output_step", "keep none: outputs=None"]
    return f"{', '.join(ways[:-1])} or {ways[-1]}" if len(ways) > 1 else ways[0]


def _table(cases: object) -> dict[str, object]:
    """Read the table of cases: its columns by their names, with the units in their heads."""
    if cases is None:
        return {}
    columns = cast("Any", cases)
    if hasattr(cases, "to_dict") and hasattr(cases, "columns"):  # a DataFrame
        columns = {name: columns[name] for name in columns.columns}
    if not isinstance(columns, Mapping) or not columns:
        msg = f"cases must be a DataFrame, or columns by their names, got {shown(cases)}"
        raise StudyError(msg)
    table: dict[str, object] = {}
    for head, values in cast("Mapping[Any, Any]", columns).items():
        name, bracket, unit = str(head).partition(" [")
        name = name.strip()
        if name in table:
            msg = f"column {name!r} is given twice in cases"
            raise StudyError(msg)
        plain = values if own_unit(values) else np.asanyarray(values)  # masks stay
        table[name] = (plain, unit.removesuffix("]")) if bracket else values
    return table


def _read(
    scene: SweptScene,
    given: Mapping[str, object],
    faults: list[str],
    tried: Callable[..., Any],
    *,
    repeats: bool,
) -> list[Axis]:
    """Read axes, or columns; note what is wrong."""
    found: list[Axis] = []
    for name, values in given.items():
        fault = _name_fault(name)
        if fault:
            faults.append(fault)
            continue
        axis: Axis | None = tried(lambda name=name, values=values: scene.axis(name, values), None)
        if axis is None:
            continue
        found.append(axis)
        if not repeats or not len(axis.values):
            faults += faults_of_values(name, axis.values)
    return found


def _name_fault(name: object) -> str | None:
    if not isinstance(name, str) or not all(part.isidentifier() for part in name.split(".")):
        written = re.sub(r"[^\w.]", "_", name) if isinstance(name, str) else ""
        way = f"; write {written!r} for what is called so" if "." in written else ""
        return f"{shown(name)} cannot be the name of an axis{way}"
    if name in _TAKEN:
        way = "; write 'System.rotation' for the option" if name == "rotation" else ""
        return f"axis {name!r} has the name of a result, or of one of its dimensions{way}"
    return None


def _twice(rows: Iterable[Axis], axes: Iterable[Axis]) -> list[str]:
    """Tell what is both a column and an axis, and motions that are scaled in two ways."""
    columns = [axis.name for axis in rows]
    along = [axis.name for axis in axes]
    both = [name for name in along if name in columns]
    faults = [f"{name!r} is both an axis and a column of cases" for name in both]
    faults += [
        f"{name!r} is given twice, once by its abbreviation"
        for names in (columns, along)
        for name in dict.fromkeys(names)
        if names.count(name) > 1
    ]
    scales = [axis.name for axis in (*rows, *axes) if axis.changes is Changes.MOTION]
    if len(set(scales)) > 1:
        faults.append(f"{' and '.join(map(repr, scales))} all scale the motion; give one of them")
    return faults


def _period(given: QuantityLike | None, axes: Iterable[Axis]) -> float | None:
    needed = any(axis.changes is Changes.MOTION and axis.name == SPECTRAL for axis in axes)
    if needed != (given is not None):
        msg = (
            f"{SPECTRAL} needs the period of its oscillator, for example period='0.5 s'"
            if needed
            else f"period is that of {SPECTRAL}, which is no axis"
        )
        raise StudyError(msg)
    if given is None:
        return None
    return to_si(given, PERIOD, owner=OWNER, name="period", condition=POSITIVE)
