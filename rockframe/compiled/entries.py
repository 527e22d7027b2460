"""Entries: functions that Python calls and that run as machine code where numba is installed.

An entry is compiled for each structure of its arguments: the classes of its named tuples, the
types of its arrays and numbers.
"""

import logging
import os
import re
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from functools import cache, update_wrapper, wraps
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from threading import RLock
from time import perf_counter, thread_time
from typing import TYPE_CHECKING, Any, Final, ParamSpec, TypeVar, cast

import numpy as np

from rockframe.compiled.bound import BoundFunction
from rockframe.compiled.callbacks import python_callback, run_and_raise
from rockframe.compiled.language import (
    AFTER_CALL,
    PURPOSE,
    PYTHON_SECONDS,
    REMAINING_SECONDS,
    Vector,
    inlined,
)
from rockframe.compiled.sources import BoundSource, CompilationUnit

if TYPE_CHECKING:
    from rockframe.compiled.parallel import BackgroundCompilation


def as_memoryviews(argument: Any) -> Any:
    """Return an argument of an entry with memory views in place of its arrays."""
    if isinstance(argument, np.ndarray):
        return memoryview(cast("Any", argument))
    if isinstance(argument, tuple):
        kind = type(cast("tuple[Any, ...]", argument))
        return kind(*(as_memoryviews(part) for part in cast("tuple[Any, ...]", argument)))
    return argument


Function = TypeVar("Function", bound=Callable[..., Any])
P = ParamSpec("P")

_HAS_NUMBA: Final = find_spec("numba") is not None
_REQUESTED: Final = os.environ.get("ROCKFRAME_COMPILE", "")
COMPILED: Final = _REQUESTED != "0" and _HAS_NUMBA
"""Whether functions are compiled."""
WAITS: Final = _REQUESTED in {"wait", "often"}
"""Whether all entries wait for their machine code; with `often`, not for what they rarely call."""
_CALLS_BACK: Final = _REQUESTED != "wait"
CALLBACK_SHARE: Final = 1.0 / 3.0
"""A function called back is compiled once it has taken this share of the time to compile it.

Little time is lost if it is compiled in the end, and none if only a few short runs are made.
"""
SLOW_RUN: Final = 3.0
"""Time in plain Python after which a message explains why a run was slow [s]."""
_warned_slow: Final[list[bool]] = []

_logger = logging.getLogger("rockframe")
_lock: Final = RLock()


def entry(function: Function) -> Function:
    """Mark a function that Python calls and that is compiled before it runs.

    Its arguments are floats, integers, arrays in C order, bound functions
    (:mod:`rockframe.compiled.bound`) and named tuples of these; its result is an integer or
    none.
    """
    return cast("Function", Entry(function) if COMPILED else _as_python(function))


def background_entry(function: Function) -> Function:
    """Mark an entry that runs as plain Python, with the same results, until it is compiled.

    It must return from time to time; as machine code it may call back functions in Python.
    """
    if not COMPILED:
        return cast("Function", _as_python(function))
    return cast("Function", Entry(function, WAITS, calls_back=_CALLS_BACK))


def _as_python(function: Callable[..., Any]) -> Callable[..., Any]:
    @wraps(function)
    def call(*arguments: Any) -> Any:
        return function(*map(as_memoryviews, arguments))

    return call


@cache
def _can_compile() -> bool:
    """Whether numba can be imported and is not disabled; tried when the first entry is called."""
    try:
        numba: Any = import_module("numba")
    except Exception as problem:  # damaged, or for other versions of what it needs
        _logger.warning(
            "numba cannot be imported, and rockframe runs as plain Python, some hundred times "
            "slower (%s: %s)", type(problem).__name__, problem,
        )  # fmt: skip
        return False
    return not numba.config.DISABLE_JIT


def table(values: Any) -> Vector:
    """Return a table of constants, of one or two dimensions, in the form that is read fastest."""
    array = np.array(values, dtype=np.float64)
    return array if COMPILED else as_memoryviews(array)


_NO_REASONS: Final = ("Failed in", "- Resolution failure", "None")
_PLACE: Final = re.compile(r'File "([^"]+)", line (\d+)')


def _reason_of(problem: Exception) -> str:
    """Return what could not be compiled, and where: the innermost reason, which comes first."""
    lines = [line.strip() for line in str(problem).splitlines() if line.strip()]
    reasons = [line for line in lines if not line.startswith(_NO_REASONS)]
    reason = " ".join(reasons[:2]) if reasons and reasons[0].endswith(":") else "".join(reasons[:1])
    place = _PLACE.search(str(problem))
    at = f"; {Path(place[1]).name}, line {place[2]}" if place else ""
    return f"{reason or 'no reason'}{at}"


def _warn_not_compiled(function: Callable[..., Any], problem: Exception) -> None:
    """Warn that a function could not be compiled, with the reason; log all of it for debugging."""
    _logger.warning(
        "%s.%s could not be compiled, and runs as plain Python, some hundred times slower (%s: "
        "%s)", function.__module__, function.__qualname__, type(problem).__name__,
        _reason_of(problem),
    )  # fmt: skip
    _logger.debug("%s", function.__qualname__, exc_info=problem)


def python_seconds() -> float:
    """Return a clock that runs only while entries or what they call back run as Python [s]."""
    return PYTHON_SECONDS[0] if COMPILED else perf_counter()


def warn_of_slow_run(seconds: float) -> None:
    """Warn once, after a long run in plain Python, why it was slow, and how fast others will be."""
    if seconds <= SLOW_RUN or _warned_slow or (_HAS_NUMBA and not COMPILED):
        return
    _warned_slow.append(True)
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
        self._routines: dict[tuple[Any, ...], CompilationUnit] = {}
        self._compilations: dict[Any, BackgroundCompilation] = {}
        update_wrapper(self, function)

    def __call__(self, *arguments: Any) -> Any:
        """Run the machine code, or the function itself where there is none."""
        if not _can_compile():
            return self._plain(*arguments)
        words: list[Any] = []
        sources: list[BoundSource] = []
        structure = tuple(_structure_of(argument, words, sources) for argument in arguments)
        routine = self._routine(structure)
        if routine.code is not None and all(source.address for source in sources):
            return routine.code(*words)
        needed, later = self._needed(routine, sources)
        with _lock:
            compilation = None
            if not self._waits:
                compilation = self._background_compilation(sources, needed, later)
            ready = compilation is None or compilation.is_due()
            if ready and _all_compiled(needed):
                from rockframe.compiled.parallel import START_AFTER

                for rest in later:
                    share = CALLBACK_SHARE * rest.job.seconds
                    _compile_when_due(rest, share if WAITS else START_AFTER)
        if routine.code is None or any(unit.code is None for unit in needed):
            with compilation or _standing_in_for(routine):
                return self._plain(*arguments)
        words = [
            word.address or python_callback(word).address if isinstance(word, BoundSource) else word
            for word in words
        ]
        return run_and_raise(routine.code, words)

    def _routine(self, structure: tuple[Any, ...]) -> CompilationUnit:
        routine = self._routines.get(structure)
        if routine is None:
            routine = self._routines.setdefault(structure, CompilationUnit(self.source, structure))
        return routine

    def _needed(
        self, routine: CompilationUnit, sources: list[BoundSource]
    ) -> tuple[list[CompilationUnit], list[CompilationUnit]]:
        """Return what to compile before this runs as machine code, and what may wait.

        An entry in the background waits for the functions that are often called, but runs as
        Python around them until the entry itself is compiled, if that takes more than a moment.
        """
        missing = _missing([*sources, routine])
        if not self._calls_back:
            return missing, []
        later = [unit for unit in missing if self._may_wait(unit)]
        return [unit for unit in missing if unit not in later], later

    def _may_wait(self, unit: CompilationUnit) -> bool:
        from rockframe.compiled.parallel import START_AFTER

        if isinstance(unit, BoundSource):
            return unit.is_rarely_called
        return not self._waits and unit.job.seconds >= START_AFTER

    def is_compiled_within(self, patience: float, arguments: tuple[Any, ...]) -> bool:
        """See :func:`compiled_within`."""
        if not _can_compile():
            return False
        from rockframe.compiled.parallel import estimate_wall_time

        sources: list[BoundSource] = []
        structure = tuple(_structure_of(argument, [], sources) for argument in arguments)
        missing = _missing([*sources, self._routine(structure)])
        with _lock:
            if estimate_wall_time([unit.job for unit in missing]) > patience:
                return False
            if not WAITS:
                compilation = self._background_compilation(sources, missing, [])
                if compilation is not None and not compilation.is_due(at_once=True):
                    return False
            return _all_compiled(missing)

    def _background_compilation(
        self,
        sources: list[BoundSource],
        needed: list[CompilationUnit],
        later: list[CompilationUnit],
    ) -> "BackgroundCompilation | None":
        """Return the compilation during which plain Python runs; None where that does not pay.

        It does not pay if there can be no machine code, if there is all that is needed, or if all
        functions that the entry calls are compiled and the entry itself compiles in a moment.
        """
        from rockframe.compiled.parallel import START_AFTER, BackgroundCompilation

        if not needed or any(unit.failed for unit in needed):
            return None
        entries = [unit for unit in needed if not isinstance(unit, BoundSource)]
        if sources and entries == needed and entries[0].job.seconds < START_AFTER:
            return None
        key = tuple(map(id, needed))
        compilation = self._compilations.get(key)
        if compilation is None:
            compilation = self._compilations[key] = BackgroundCompilation(
                [unit.job for unit in needed], [unit.job for unit in later]
            )
        return compilation


def _all_compiled(units: Sequence[CompilationUnit]) -> bool:
    """Compile units, or load their machine code; whether all of them have some then."""
    from rockframe.compiled.parallel import NotCompiledError, compile_all

    if any(unit.failed for unit in units):
        return False
    if not units:
        return True
    jobs = [unit.job for unit in units]
    try:
        codes = compile_all(jobs)
    except NotCompiledError as error:
        _warn_not_compiled(jobs[error.place].function, error.problem)
        units[error.place].failed = True  # of a bound function: other systems can use the entry
        return False
    for unit, code in zip(units, codes, strict=True):
        unit.take(code)
    return True


@contextmanager
def _standing_in_for(routine: CompilationUnit) -> Generator[None]:
    """Count the time of this block as that of plain Python in place of a routine."""
    started = thread_time()
    try:
        yield
    finally:
        routine.fallback_seconds += thread_time() - started


_in_background: Final[dict[CompilationUnit, "BackgroundCompilation"]] = {}
"""Compilations by other processes of functions for which others stand in."""


def _compile_when_due(unit: CompilationUnit, patience: float) -> None:
    """Compile, or load, a function for which others have stood in for some time [s].

    Where entries do not wait, another process compiles it, and this one goes on without it.
    """
    from rockframe.compiled.parallel import BackgroundCompilation, NotCompiledError, compile_all

    if unit.failed:
        return
    job = unit.job
    try:
        if unit.fallback_seconds < patience and not job.is_stored:
            return
        if not WAITS:
            compilation = _in_background.setdefault(unit, BackgroundCompilation([job]))
            if not compilation.is_due(at_once=True):
                return
        (code,) = compile_all([job])
    except NotCompiledError as error:
        _warn_not_compiled(job.function, error.problem)
        unit.failed = True
        if isinstance(unit, BoundSource):
            unit.is_rarely_called = False
    else:
        unit.take(code)


def is_worth_calling(function: BoundFunction) -> bool:
    """Whether to call a function for which another one, compiled already but slower, can stand in.

    It is called if it has machine code, if nothing has, and if all is compiled before it runs. It
    is compiled when the other one has taken as long as that takes.
    """
    source = function.source
    if source.address or not COMPILED or not _CALLS_BACK or not _can_compile():
        return True
    from rockframe.compiled.parallel import START_AFTER

    taken = source.fallback_seconds
    if source.failed or 0.0 < taken < START_AFTER:
        return False
    try:
        if not 0.0 < taken < source.job.seconds:
            with _lock:
                _compile_when_due(source, source.job.seconds)
    except Exception:  # reported where the other one is compiled
        return False
    return bool(source.address)


def _missing(units: Sequence[CompilationUnit]) -> list[CompilationUnit]:
    return [*{id(unit): unit for unit in units if unit.code is None}.values()]


def compiled_within(
    patience: float, function: Callable[P, Any], *arguments: P.args, **_: P.kwargs
) -> bool:
    """Whether an entry has machine code, compiled now if that takes at most `patience` [s]."""
    return isinstance(function, Entry) and function.is_compiled_within(patience, arguments)


@contextmanager
def compiling_for(words: str) -> Generator[None]:
    """Set the purpose that messages about compilation in this block state."""
    before = PURPOSE.set(words)
    try:
        yield
    finally:
        PURPOSE.reset(before)


@contextmanager
def after_each_call(action: Callable[[], None]) -> Generator[None]:
    """Set what is called after each bound function that is called in, or as, plain Python."""
    before = AFTER_CALL.set(action)
    try:
        yield
    finally:
        AFTER_CALL.reset(before)


@contextmanager
def expecting_remaining(seconds: float) -> Generator[None]:
    """Set the remaining time in plain Python that the caller of this block expects [s]."""
    before = REMAINING_SECONDS.set(seconds)
    try:
        yield
    finally:
        REMAINING_SECONDS.reset(before)


def _structure_of(argument: Any, words: list[Any], sources: list[BoundSource]) -> Any:
    """Return the structure of an argument; append the words that pass it, and bound functions."""
    if isinstance(argument, tuple):
        values = cast("tuple[Any, ...]", argument)
        return (type(values), *[_structure_of(value, words, sources) for value in values])
    if isinstance(argument, BoundFunction):
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
