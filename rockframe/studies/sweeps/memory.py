"""The memory that a study needs, and the available memory."""

import math
import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Final

from rockframe.errors import SolverWarning, warn
from rockframe.results.outcome import enumeration
from rockframe.results.schema import SCHEMA
from rockframe.results.variables.requests import FORCE_SCALARS, POINT_PEAKS, POINT_TIME, POINTS
from rockframe.results.variables.runs import EVENTS_AND_SCALARS, HISTORIES
from rockframe.results.variables.studies import SWEEP
from rockframe.results.variables.variable import TIME
from rockframe.simulation.plan import RunRequest
from rockframe.studies.sweeps.study import Histories

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
        names = histories.names or [
            row.name for row in (*HISTORIES, *POINTS) if TIME[0] in row.dims
        ]
        several = sum(points if SCHEMA[name].dims == POINT_TIME else 1 for name in names)
        numbers[f"{several} histories of {histories.count} times"] = float(
            several * histories.count
        )
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
