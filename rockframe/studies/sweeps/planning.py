"""From the arguments of a sweep to the study that they describe; reports all faults at once.

Also which histories are kept, and the memory that results need.
"""

import math
import os
import re
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, Final, TypeVar, cast

import numpy as np
import xarray as xr

from rockframe.errors import (
    RecordWarning,
    RockframeError,
    SolverWarning,
    StudyError,
    short_repr,
    warn,
)
from rockframe.motion import GroundMotion
from rockframe.results.outcome import enumeration
from rockframe.results.schema import GROUPS, SCHEMA
from rockframe.results.variables import analyses, bodies, requests, runs
from rockframe.results.variables.requests import FORCE_SCALARS, POINT_PEAKS, POINT_TIME, POINTS
from rockframe.results.variables.runs import EVENTS_AND_SCALARS, HISTORIES
from rockframe.results.variables.studies import MOTION, SWEEP
from rockframe.results.variables.variable import EVENT, FLIP, TIME
from rockframe.signals.arrays import AnyArray
from rockframe.simulation.plan import (
    RunRequest,
    default_output_step,
    outputs_as_list,
    read_arguments,
    run_length,
)
from rockframe.studies.sweeps.axes import MAX_CASES, OWNER, Axis, Changes, Grid, faults_of_values
from rockframe.studies.sweeps.chunk import FIRST_LEVEL, REPEATED_LEVEL, SCREEN
from rockframe.studies.sweeps.motions import (
    MOTION_OF_SCENE,
    NO_MOTION,
    SPECTRAL_ACCELERATION,
    motion_number,
)
from rockframe.studies.sweeps.scenes import (
    FunctionScene,
    SweptScene,
    SystemScene,
    motions_of_study,
    scene_of,
)
from rockframe.studies.sweeps.study import Histories, Study
from rockframe.system.single_body import SingleBodySetting
from rockframe.units import PERIOD, POSITIVE, QuantityLike, attached_unit, to_si


def kept_histories(
    scene: SweptScene,
    motions: Mapping[str, GroundMotion | None],
    arguments: RunRequest,
    outputs: object,
) -> Histories | None:
    """Find the histories that are kept, and the times that those of all cases have."""
    if not arguments.histories:
        return None
    named = [str(name) for name in outputs_as_list(outputs)]
    every = (variable for name in named for variable in GROUPS.get(name, (name,)))
    names = tuple(dict.fromkeys(every))
    wrong = [name for name in names if SCHEMA[name].dims not in (TIME, POINT_TIME)]
    if wrong:
        msg = f"outputs: {', '.join(wrong)} are no histories, which a sweep could keep"
        raise StudyError(msg)
    from_function = isinstance(scene, FunctionScene) and None in motions.values()
    if from_function and (arguments.duration is None or arguments.output_step is None):
        msg = "histories of motions that the function makes need a duration and an output_step"
        raise StudyError(msg)
    step = arguments.output_step
    if step is None:
        steps = {default_output_step(motion) for motion in motions.values()}
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

_RESERVED_NAMES: Final = {
    *TIME, *EVENT, *bodies.BODY, *bodies.RESTRAINER,
    *analyses.LIMIT_STATE, *analyses.STRIPE, *FLIP, *analyses.QUANTILE,  # in which axes stay
} | {
    row.name
    for table in (
        HISTORIES, runs.ENERGY_HISTORIES, EVENTS_AND_SCALARS, requests.ACCELERATIONS,
        requests.REACTIONS, requests.OTHERS, FORCE_SCALARS, POINTS,
        POINT_PEAKS, requests.SLIPS, bodies.BODIES, bodies.RESTRAINERS,
        bodies.RESTRAINER_SCALARS, SWEEP,
    )
    for row in table
}  # fmt: skip
"""Names of results and of their dimensions, which axes cannot have."""


class Faults:
    """The faults in the arguments of a sweep, all of which are reported at once."""

    def __init__(self) -> None:
        self.found: list[str] = []

    def attempt(self, read: Callable[[], Read], otherwise: Read) -> Read:
        """Return what is read, or another value where that fails, and note why."""
        try:
            return read()
        except StudyError as problem:
            self.found.extend(problem.faults)
        except RockframeError as problem:
            self.found.append(str(problem).removeprefix(f"{OWNER}: "))
        return otherwise


def plan_study(
    scene: object,
    motions: object,
    axes: Mapping[str, object],
    cases: object,
    *,
    period: QuantityLike | None = None,
    stored: bool | None = None,
    **requested: Any,
) -> Study:
    """Check the arguments of a sweep.

    `stored` tells whether there is a store, from which a result that is larger than the memory
    can be read lazily; None where the whole result is needed at once.
    """
    faults = Faults()
    swept = scene_of(scene)  # without it nothing else can be checked
    if isinstance(requested.get("initial"), xr.Dataset):
        faults.found.append(
            "initial cannot be the end of another run, whose system is one only; "
            "give an InitialState"
        )
        del requested["initial"]
    level = requested.get("accuracy")
    screened = isinstance(level, str) and level == SCREEN
    if screened:
        requested["accuracy"] = FIRST_LEVEL
    outputs = requested.setdefault("outputs", None)
    arguments = faults.attempt(lambda: read_arguments(faults.found, **requested), None)
    nothing = MOTION_OF_SCENE if isinstance(swept, FunctionScene) else NO_MOTION
    none: dict[str, GroundMotion | None] = {nothing: None}
    named = {**faults.attempt(lambda: motions_of_study(motions, swept) or none, none)}
    grid = _read_grid(swept, axes, cases, list(named), faults)
    every = [*grid.columns, *grid.axes]
    swept = swept.with_parts_of(every) if isinstance(swept, SystemScene) else swept
    seconds = faults.attempt(lambda: _read_period(period, every), None)
    if arguments is None or faults.found:
        raise StudyError(*faults.found)
    if screening_skipped := screened and not _is_screening_cheaper(swept, named.values()):
        screened, requested["accuracy"] = False, REPEATED_LEVEL
        arguments = read_arguments(faults.found, **requested)
    if not 0 < grid.count <= MAX_CASES:
        faults.found.append(f"there are {grid.count} cases; expected 1 to {MAX_CASES}")
    if isinstance(swept, SystemScene) and arguments.duration is None and None in named.values():
        faults.found.append("nothing to simulate: give motions, or a duration for a still ground")
    of_runs = arguments
    histories = faults.attempt(lambda: kept_histories(swept, named, of_runs, outputs), None)
    if histories is not None and len({*map(default_output_step, named.values())}) > 1:
        arguments = replace(arguments, output_step=histories.step)  # at the times that are kept
    numbers = numbers_per_case(arguments, histories, screened=screened)
    remedies = memory_remedies(arguments, histories, may_be_kept=stored is False)
    advice = LAZY_ADVICE if stored else remedies
    too_large = check_memory(numbers, grid.count, advice, owner=OWNER)
    if stored and not faults.found:
        for text in too_large:
            warn(f"{OWNER}: {text}", SolverWarning)
    else:
        faults.found += too_large
    if faults.found:
        raise StudyError(*faults.found)
    return Study(
        swept, grid, named, arguments, seconds, histories, screened=screened,
        screening_skipped=screening_skipped, lazy=bool(too_large),
    )  # fmt: skip


def _read_grid(
    scene: SweptScene, axes: Mapping[str, object], cases: object, motions: list[str], faults: Faults
) -> Grid:
    """Read the axes and the table of cases, and give all cases under the motions of these names."""
    of_case: AnyArray | None = None
    table = faults.attempt(lambda: _read_table(cases), {})
    if MOTION in table:
        number_of = partial(motion_number, names=motions, owner="cases")
        column = np.asarray(table.pop(MOTION)).tolist()
        of_case = faults.attempt(lambda: np.array([*map(number_of, column)], np.intp), None)
    rows = _read_axes(scene, table, faults, repeats=True)
    grid_axes = _read_axes(scene, axes, faults, repeats=False)
    faults.found += _duplicate_faults(rows, grid_axes)
    faults.found += scene.faults([*rows, *grid_axes])
    lengths = {axis.name: len(axis.values) for axis in rows}
    lengths |= {} if of_case is None else {MOTION: len(of_case)}
    if len(set(lengths.values())) > 1:
        text = ", ".join(f"{name} {length}" for name, length in lengths.items())
        faults.found.append(f"the columns of cases differ in length: {text}")
    return Grid(tuple(grid_axes), tuple(rows), len(motions), of_case)


def _is_screening_cheaper(scene: SweptScene, motions: Iterable[GroundMotion | None]) -> bool:
    """Say whether two runs by fixed steps cost less than one by tolerance, as far as is known."""
    if not isinstance(scene, SystemScene):
        return True
    # on rigid ground there are no more steps by tolerance; under pulses in closed form there are
    # few of either kind, and a second run costs what surrounds them, unless bodies are several
    setting = scene.assembly.setting
    sampled = any(motion is None or motion.recipe is None for motion in motions)
    return setting.steps_cost_most and (sampled or not isinstance(setting, SingleBodySetting))


def _read_table(cases: object) -> dict[str, object]:
    """Read the table of cases: its columns by their names, with the units in their heads."""
    if cases is None:
        return {}
    columns = cast("Any", cases)
    if hasattr(cases, "to_dict") and hasattr(cases, "columns"):  # a DataFrame
        columns = {name: columns[name] for name in columns.columns}
    if not isinstance(columns, Mapping) or not columns:
        msg = f"cases must be a DataFrame, or columns by their names, got {short_repr(cases)}"
        raise StudyError(msg)
    table: dict[str, object] = {}
    for head, values in cast("Mapping[Any, Any]", columns).items():
        name, bracket, unit = str(head).partition(" [")
        name = name.strip()
        if name in table:
            msg = f"column {name!r} is given twice in cases"
            raise StudyError(msg)
        plain = values
        if not (attached_unit(values) or isinstance(values, list | tuple)):
            plain = np.asanyarray(values)  # masks stay
        table[name] = (plain, unit.removesuffix("]")) if bracket else values
    return table


def _read_axes(
    scene: SweptScene, arguments: Mapping[str, object], faults: Faults, *, repeats: bool
) -> list[Axis]:
    """Read axes, or columns; note what is wrong."""
    axes: list[Axis] = []
    for name, values in arguments.items():
        if (fault := _name_fault(name)) is not None:
            faults.found.append(fault)
            continue
        axis = faults.attempt(partial(scene.axis, name, values), None)
        if axis is not None:
            axes.append(axis)
            if not repeats or not len(axis.values):
                faults.found += faults_of_values(name, axis.values)
    return axes


def _name_fault(name: object) -> str | None:
    if not isinstance(name, str) or not all(part.isidentifier() for part in name.split(".")):
        written = re.sub(r"[^\w.]", "_", name) if isinstance(name, str) else ""
        way = f"; write {written!r} for what is called so" if "." in written else ""
        return f"{short_repr(name)} cannot be the name of an axis{way}"
    if name in _RESERVED_NAMES:
        way = "; write 'System.rotation' for the option" if name == "rotation" else ""
        return f"axis {name!r} has the name of a result, or of a dimension of results{way}"
    return None


def _duplicate_faults(rows: Iterable[Axis], axes: Iterable[Axis]) -> list[str]:
    """Tell what is both a column and an axis, and motions that are scaled in two ways."""
    columns, along = ([axis.name for axis in some] for some in (rows, axes))
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


def _read_period(value: QuantityLike | None, axes: Iterable[Axis]) -> float | None:
    needed = (Changes.MOTION, SPECTRAL_ACCELERATION) in ((one.changes, one.name) for one in axes)
    if value is None and needed:
        msg = f"{SPECTRAL_ACCELERATION} needs the period of its oscillator, such as period='0.5 s'"
        raise StudyError(msg)
    if value is None:
        return None
    if not needed:
        msg = f"period is that of {SPECTRAL_ACCELERATION}, which is no axis"
        raise StudyError(msg)
    return to_si(value, PERIOD, owner=OWNER, name="period", condition=POSITIVE)


_FLOAT: Final = 8.0
"""Size of a number [bytes]."""
_COPY_FACTOR: Final = 2.5
"""Copies of a number in memory at once: in its chunk, in all, and partly in axis order."""
LAZY_ADVICE: Final = "they are read from the store as they are used (rf.open_study, lazy=True)"
_WARNING_SHARE: Final = 0.5
"""Share of the available memory above which the memory that a study needs is reported."""
_MEMINFO: Final = Path("/proc/meminfo")
_CGROUP_FILES: Final = tuple(
    # limit, usage and its parts, of a container or a job: control groups of both versions
    tuple(Path("/sys/fs/cgroup", name) for name in names)
    for names in (
        ("memory.max", "memory.current", "memory.stat"),
        ("memory/memory.limit_in_bytes", "memory/memory.usage_in_bytes", "memory/memory.stat"),
    )
)


def check_memory(
    numbers: Mapping[str, float], cases: int, remedies: str, *, owner: str
) -> list[str]:
    """Say how much memory cases need, and whether it is available."""
    sizes = {what: _FLOAT * _COPY_FACTOR * count * cases for what, count in numbers.items()}
    needed, free = sum(sizes.values()), available_memory()
    parts = ", ".join(f"{what} {_size_words(size)}" for what, size in sizes.items())
    text = (
        f"{cases} cases need about {_size_words(needed)} of memory ({parts}); {_size_words(free)} "
        "are available"
    )
    if needed > free:
        return [f"{text}; {remedies}"]
    if needed > _WARNING_SHARE * free:
        warn(f"{owner}: {text}", SolverWarning)
    return []


def available_memory() -> float:
    """Return what this process may still use; infinite if unknown [bytes]."""
    limits = [math.inf]
    with suppress(OSError, ValueError, IndexError):
        (line,) = (row for row in _MEMINFO.read_text().splitlines() if "MemAvailable" in row)
        limits.append(1024.0 * float(line.split()[1]))
    if len(limits) == 1 and hasattr(os, "sysconf"):
        with suppress(OSError, ValueError):
            limits.append(float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE"))
    for most, usage, parts in _CGROUP_FILES:
        with suppress(OSError, ValueError):  # "max" where there is no limit
            used = float(usage.read_text()) - _reclaimable(parts)
            limits.append(max(float(most.read_text()) - used, 0.0))
    return min(limits)


def _reclaimable(parts: Path) -> float:
    """Return the memory with contents of files that were not used lately, which can be freed."""
    with suppress(OSError, ValueError):
        sizes = dict(line.split() for line in parts.read_text().splitlines())
        return float(sizes.get("total_inactive_file", sizes.get("inactive_file", 0.0)))
    return 0.0


def _size_words(size: float) -> str:
    """Write a size in a readable unit."""
    for unit, large in (("TB", 1e12), ("GB", 1e9)):
        if size >= large:
            return f"{size / large:.3g} {unit}"
    return f"{size / 1e6:.3g} MB"


def numbers_per_case(
    arguments: RunRequest, histories: Histories | None, *, screened: bool
) -> dict[str, float]:
    """Return how many numbers of each kind are kept for a case."""
    points = len(arguments.points)
    every = [*EVENTS_AND_SCALARS, *FORCE_SCALARS, *(SWEEP if screened else ())]
    numbers = {"scalars": float(sum(not row.dims for row in every))}
    if points:
        numbers[f"peaks at {points} points"] = float(len(POINT_PEAKS) * points)
    if histories is not None:
        every = [row.name for row in (*HISTORIES, *POINTS) if TIME[0] in row.dims]
        names = histories.names or every
        several = sum(points if SCHEMA[name].dims == POINT_TIME else 1 for name in names)
        what = f"{several} histories of {histories.count} times"
        numbers[what] = float(several * histories.count)
    return numbers


def memory_remedies(
    arguments: RunRequest, histories: Histories | None, *, may_be_kept: bool
) -> str:
    """Say what would need less memory."""
    ways = ["run fewer cases"]
    ways += ["give a store, from which they are read as they are used"] if may_be_kept else []
    ways += ["name fewer points"] if arguments.points else []
    if histories is not None:
        ways += ["name fewer outputs", "give a longer output_step", "keep none: outputs=None"]
    return enumeration(ways, "or")
