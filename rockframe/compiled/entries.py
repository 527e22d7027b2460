"""Entries: functions that Python calls and that run as machine code where numba is installed.

An entry is compiled for each structure of its arguments: the classes of its named tuples, the
types of its arrays and numbers.
"""

import logging
import os
import re
from collections.abc import Callable, Generator
from contextlib import contextmanager, nullcontext
from functools import update_wrapper, wraps
from importlib.util import find_spec
from pathlib import Path
from threading import RLock
from time import perf_counter
from typing import TYPE_CHECKING, Any, Final, ParamSpec, TypeVar, cast

import numpy as np

from rockframe.compiled.bound import Bound, Source
from rockframe.compiled.called_back import raising
from rockframe.compiled.language import AS_PYTHON, NEEDED_BY, STILL_TAKES, Vector, inlined

if TYPE_CHECKING:
    from rockframe.compiled.jobs import Job
    from rockframe.compiled.parallel import Meanwhile


def viewed(argument: Any) -> Any:
    """Return an argument of an entry with memory views in place of its arrays."""
    if isinstance(argument, np.ndarray):
        return memoryview(cast("Any", argument))
    if isinstance(argument, tuple):
        kind = type(cast("tuple[Any, ...]", argument))
        return kind(*(viewed(part) for part in cast("tuple[Any, ...]", argument)))
    return argument


Function = TypeVar("Function", bound=Callable[..., Any])
P = ParamSpec("P")

_HAS_NUMBA: Final = find_spec("numba") is not None
_ASKED: Final = os.environ.get("ROCKFRAME_COMPILE", "")
COMPILED: Final = _ASKED != "0" and _HAS_NUMBA
"""Whether functions are compiled."""
WAITS: Final = _ASKED in {"wait", "often"}
"""Whether all entries wait for their machine code; with `often`, not for what they call seldom."""
_CALLS_BACK: Final = _ASKED != "wait"
CALLED_BACK: Final = 1.0 / 3.0
"""A function called back is compiled once it has taken this share of the time to compile it.

Little time is lost if it is compiled in the end, and none if only a few short runs are made.
"""
PATIENCE: Final = 3.0
"""Time in plain Python after which a message explains why a run was slow [s]."""
_said_slow: Final[list[bool]] = []

_logger = logging.getLogger("rockframe")
_lock: Final = RLock()


def entry(function: Function) -> Function:
    """Mark a function that Python calls and that is compiled before it runs.

    Its arguments are floats, integers, arrays in C order, bound functions
    (:mod:`rockframe.compiled.bound`) and named tuples of these; its result is an integer or
    none.
    """
    return cast("Function", Entry(function) if COMPILED else _as_python(function))


def entry_at_once(function: Function) -> Function:
    """Mark an entry that runs as plain Python, with the same results, until it is compiled.

    It must return from time to time; as machine code it may call back functions in Python.
    """
    if not COMPILED:
        return cast("Function", _as_python(function))
    return cast("Function", Entry(function, WAITS, calls_back=_CALLS_BACK))


def _as_python(function: Callable[..., Any]) -> Callable[..., Any]:
    @wraps(function)
    def call(*arguments: Any) -> Any:
        return function(*map(viewed, arguments))

    return call


def table(values: Any) -> Vector:
    """Return a table of constants, of one or two dimensions, in the form that is read fastest."""
    kept = np.array(values, dtype=np.float64)
    return kept if COMPILED else viewed(kept)


_NO_REASONS: Final = ("Failed in", "- Resolution failure", "None")
_PLACE: Final = re.compile(r'File "([^"]+)", line (\d+)')


def _why(problem: Exception) -> str:
    """Return what could not be compiled, and where: the innermost reason, which comes first."""
    lines = [line.strip() for line in str(problem).splitlines() if line.strip()]
    reasons = [line for line in lines if not line.startswith(_NO_REASONS)]
    reason = " ".join(reasons[:2]) if reasons and reasons[0].endswith(":") else "".join(reasons[:1])
    place = _PLACE.search(str(problem))
    at = f"; {Path(place[1]).name}, line {place[2]}" if place else ""
    return f"{reason or 'no reason'}{at}"


def _could_not(function: Callable[..., Any], problem: Exception) -> None:
    """Warn that a function could not be compiled, with the reason; log all of it for debugging."""
    _logger.warning(
        "%s.%s could not be compiled, and runs as plain Python, some hundred times slower (%s: "
        "%s)", function.__module__, function.__qualname__, type(problem).__name__, _why(problem),
    )  # fmt: skip
    _logger.debug("%s", function.__qualname__, exc_info=problem)


def seconds_as_python() -> float:
    """Return a clock that runs only while entries run as plain Python [s]."""
    return AS_PYTHON[0] if COMPILED else perf_counter()


def warn_of_slow_run(seconds: float) -> None:
    """Warn once, after a long run in plain Python, why it was slow, and how fast others will be."""
    if seconds <= PATIENCE or _said_slow or (_HAS_NUMBA and not COMPILED):
        return
    _said_slow.append(True)
    why = (
        "while rockframe compiles what it needs, once for this machine: the next"
        if COMPILED
        else "; with numba (pip install 'rockframe[fast]')"
    )
    _logger.warning(
        "this run took %.0f s, in plain Python%s%s one like it takes some hundredth of that",
        seconds, " " if COMPILED else "", why,
    )  # fmt: skip


class Entry:
    """An entry, with its machine code for each structure of arguments."""

    def __init__(
        self, function: Callable[..., Any], waits: bool = True, calls_back: bool = False
    ) -> None:
        self.source = inlined(function)
        self._plain = _as_python(function)
        self._waits = waits
        self._calls_back = calls_back
        self._routines: dict[tuple[Any, ...], Callable[..., Any] | None] = {}
        self._awaited: dict[Any, Meanwhile] = {}
        update_wrapper(self, function)

    def __call__(self, *arguments: Any) -> Any:
        """Run the machine code, or the function itself where there is none."""
        words: list[Any] = []
        sources: list[Source] = []
        structure = tuple(_structure_of(argument, words, sources) for argument in arguments)
        routine = self._routines.get(structure)
        if routine is not None and all(source.address for source in sources):
            return routine(*words)
        needed, seldom = self._needed(sources)
        with _lock:
            meanwhile = None if self._waits else self._meanwhile(structure, needed, seldom)
            ready = meanwhile is None or meanwhile.is_over()
            routine = self._compiled(structure, needed) if ready else None
            if routine is not None:
                from rockframe.compiled.parallel import WORTHWHILE

                for source in seldom:
                    share = CALLED_BACK * source.job.seconds
                    _make_when_due(source, share if WAITS else WORTHWHILE)
        if routine is None:
            with meanwhile or nullcontext():
                return self._plain(*arguments)
        words = [
            word.address or word.called_back.address if isinstance(word, Source) else word
            for word in words
        ]
        return raising(routine, words)

    def _needed(self, sources: list[Source]) -> tuple[list[Source], list[Source]]:
        """Return the bound functions to compile before this runs, and those to call back."""
        seldom: list[Source] = []
        if self._calls_back:
            seldom = [source for source in _missing(sources) if source.is_seldom_called]
        return [source for source in sources if source not in seldom], seldom

    def is_compiled_within(self, patience: float, arguments: tuple[Any, ...]) -> bool:
        """See :func:`compiled_within`."""
        from rockframe.compiled.parallel import time_for

        sources: list[Source] = []
        structure = tuple(_structure_of(argument, [], sources) for argument in arguments)
        sources, seldom = self._needed(sources)
        with _lock:
            if time_for(self._jobs(structure, sources)) > patience:
                return False
            if not WAITS:
                meanwhile = self._meanwhile(structure, sources, seldom)
                if meanwhile is not None and not meanwhile.is_over(at_once=True):
                    return False
            return self._compiled(structure, sources) is not None

    def _meanwhile(
        self, structure: tuple[Any, ...], sources: list[Source], seldom: list[Source]
    ) -> "Meanwhile | None":
        """Return the compilation during which plain Python runs; None where that does not pay.

        It does not pay if there can be no machine code, if there is some, or if all functions that
        the entry calls are compiled and the entry itself compiles in a moment.
        """
        from rockframe.compiled.parallel import WORTHWHILE, Meanwhile, time_for

        jobs = self._jobs(structure, sources)
        is_a_moment = sources and len(jobs) == 1 and time_for(jobs) < WORTHWHILE
        if is_a_moment or self._has_failed(structure, sources):
            return None
        key = structure, *map(id, sources)
        found = self._awaited.get(key)
        if found is None:
            found = self._awaited[key] = Meanwhile(jobs, [source.job for source in seldom])
        return found

    def _has_failed(self, structure: tuple[Any, ...], sources: list[Source]) -> bool:
        failed = structure in self._routines and self._routines[structure] is None
        return failed or any(source.failed for source in sources)

    def _jobs(self, structure: tuple[Any, ...], sources: list[Source]) -> "list[Job]":
        """Return the jobs of a call: its bound functions without machine code, then the entry."""
        from rockframe.compiled.jobs import Job

        jobs = [source.job for source in _missing(sources)]
        return [*jobs, Job(self.source, structure, False)]

    def _compiled(
        self, structure: tuple[Any, ...], sources: list[Source]
    ) -> Callable[..., Any] | None:
        from rockframe.compiled.parallel import NotCompiledError, make_all

        if self._has_failed(structure, sources):
            return None
        missing, routine = _missing(sources), self._routines.get(structure)
        if routine is not None and not missing:
            return routine
        jobs = self._jobs(structure, sources)
        try:
            *codes, routine = make_all(jobs)
        except NotCompiledError as found:
            _could_not(jobs[found.place].function, found.problem)
            if found.place < len(missing):  # a bound function: other systems can use the entry
                missing[found.place].failed = True
            else:
                self._routines[structure] = None
            return None
        for source, code in zip(missing, codes, strict=True):
            source.code, source.address = code, code.address
        self._routines[structure] = routine
        return routine


_in_background: Final[dict[Source, "Meanwhile"]] = {}
"""Compilations by other processes of functions for which others stand in."""


def _make_when_due(source: Source, patience: float) -> None:
    """Compile, or load, a function for which others have stood in for some time [s].

    Where entries do not wait, another process compiles it, and this one goes on without it.
    """
    from rockframe.compiled.parallel import Meanwhile, NotCompiledError, make_all

    job = source.job
    try:
        if source.seconds_without < patience and not job.is_stored:
            return
        if not WAITS:
            meanwhile = _in_background.setdefault(source, Meanwhile([job]))
            if not meanwhile.is_over(at_once=True):
                return
        (source.code,) = make_all([job])
    except NotCompiledError as found:
        _could_not(job.function, found.problem)
        source.failed, source.is_seldom_called = True, False
    else:
        source.address = source.code.address


def is_worth_calling(one: Bound) -> bool:
    """Whether to call a function for which another one, compiled already but slower, can stand in.

    It is called if it has machine code, if nothing has, and if all is compiled before it runs. It
    is compiled when the other one has taken as long as that takes.
    """
    source = one.source
    if source.address or not COMPILED or not _CALLS_BACK:
        return True
    from rockframe.compiled.parallel import WORTHWHILE

    taken = source.seconds_without
    if source.failed or 0.0 < taken < WORTHWHILE:
        return False
    try:
        if not 0.0 < taken < source.job.seconds:
            with _lock:
                _make_when_due(source, source.job.seconds)
    except Exception:  # reported where the other one is compiled
        return False
    return bool(source.address)


def _missing(sources: list[Source]) -> list[Source]:
    return [*{id(source): source for source in sources if not source.address}.values()]


def compiled_within(
    patience: float, function: Callable[P, Any], *arguments: P.args, **_: P.kwargs
) -> bool:
    """Whether an entry has machine code, compiled now if that takes at most `patience` [s]."""
    return isinstance(function, Entry) and function.is_compiled_within(patience, arguments)


@contextmanager
def compiling_for(words: str) -> Generator[None]:
    """Set the purpose that messages about compilation in this block state."""
    before = NEEDED_BY.set(words)
    try:
        yield
    finally:
        NEEDED_BY.reset(before)


@contextmanager
def still_taking(seconds: float) -> Generator[None]:
    """Set the remaining time in plain Python that the caller of this block expects [s]."""
    before = STILL_TAKES.set(seconds)
    try:
        yield
    finally:
        STILL_TAKES.reset(before)


def _structure_of(argument: Any, words: list[Any], sources: list[Source]) -> Any:
    """Return the structure of an argument; append the words that pass it, and bound functions."""
    if isinstance(argument, tuple):
        values = cast("tuple[Any, ...]", argument)
        return (type(values), *[_structure_of(value, words, sources) for value in values])
    if isinstance(argument, Bound):
        source = argument.source
        sources.append(source)
        words.append(source.address or source)
        return ("function", source.signature)
    words.append(argument)
    if isinstance(argument, np.ndarray):
        flags = argument.flags
        if not flags.c_contiguous:
            msg = (
                f"compiled functions need arrays in C order, got one of strides {argument.strides}"
            )
            raise TypeError(msg)
        return (argument.dtype.char, argument.ndim, flags.writeable)
    if isinstance(argument, float):
        return "real"
    if isinstance(argument, int | np.integer):
        return "integer"
    msg = f"compiled functions take numbers, arrays and tuples of them, got {type(argument)}"
    raise TypeError(msg)
