"""Compilation of all jobs of a call, by two processes where they are not stored.

numba compiles one function at a time. A helper process starts from the other end of the list of
jobs, and each process finds in the store what the other one has compiled. Alternatively a second
process compiles everything while this one continues in plain Python: compiled or not, a function
returns the same bits, and a long run returns from time to time (``rockframe.solve.integrate``), so
that it continues as machine code once there is some. A user thus never waits longer for a compiler
than for the run itself. When a run has taken, or is expected to take, as long as both processes
need for the remaining jobs at worst, this process compiles, too.
"""

import gc
import logging
import pickle
import subprocess
import sys
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager, suppress
from importlib import import_module
from time import thread_time
from typing import IO, Any, Final, cast

from rockframe.compiled import store
from rockframe.compiled.jobs import Job, estimate_seconds
from rockframe.compiled.language import (
    PURPOSE,
    PYTHON_SECONDS,
    REMAINING_SECONDS,
    processors,
)

_logger = logging.getLogger("rockframe")
_announced: Final[set[str]] = set()
_ANNOUNCE_EACH: Final = 2.0
"""Time of a compilation above which each one is announced, not only the first [s]."""
REPEAT_RATIO: Final = 0.45
"""Time to compile a function for a further job, over that for the first one [1].

Measured with numba 0.68 for stacks of two to five blocks, on pads and on rigid ground, with
friction and without: the processor time for all jobs of a run was 0.98 to 1.01 times the estimate.
"""


class NotCompiledError(Exception):
    """A job failed; `place` is its number in the list, `problem` the compiler's exception."""

    def __init__(self, place: int, problem: Exception) -> None:
        super().__init__(str(problem))
        self.place = place
        self.problem = problem


def compile_all(jobs: Sequence[Job]) -> list[Any]:
    """Compile jobs or load them from the store, with a helper process if that pays."""
    _announce(jobs)
    with _with_helper(jobs) as waiting, without_garbage_collection():
        return _compile_in_turn(jobs, waiting)


def _compile_in_turn(jobs: Sequence[Job], waiting: Callable[[], bool]) -> list[Any]:
    """Compile jobs; last those that other processes compile now."""
    compiled: dict[int, Any] = {}
    for now in (True, False):
        for place, job in enumerate(jobs):
            if place not in compiled and not (now and _is_compiled_elsewhere(job)):
                compiled[place] = _compile_one(place, job, waiting)
    return [compiled[place] for place in range(len(jobs))]


@contextmanager
def without_garbage_collection() -> Generator[None]:
    """Turn garbage collection off in this block: numba makes much and discards little.

    Collection takes a fifth of the time of a compilation. Afterwards the new objects are moved to
    the oldest generation, so that they are not examined at once.
    """
    collects = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collects:
            if not gc.get_freeze_count():  # else other code has frozen objects
                gc.freeze()
                gc.unfreeze()
            gc.enable()


def _is_compiled_elsewhere(job: Job) -> bool:
    """Whether another process compiles a job."""
    try:
        file = job.file
        return file is not None and not job.is_stored and store.is_compiled_elsewhere(file)
    except Exception:  # reported where it is compiled
        return False


def estimate_wall_time(jobs: Sequence[Job]) -> float:
    """Estimate how long the jobs that are not stored take to compile on an idle machine [s]."""
    try:
        missing = [job for job in jobs if not job.is_stored]
        seconds, once = [job.seconds for job in missing], estimate_seconds(missing)
        together = once + REPEAT_RATIO * (sum(seconds) - once)
        return max([*seconds, together / min(2, processors())])
    except Exception:  # reported where it is compiled
        return 0.0


def _announce(jobs: Sequence[Job]) -> None:
    """Announce a compilation: what it is for, and about how long it takes."""
    seconds = estimate_wall_time(jobs)
    if not seconds:
        return
    once = "once"
    if any(job.file is None for job in jobs):
        places = " or ".join(map(str, store.cache_folders()))
        once = (
            "and again in every process: it cannot be kept, for nothing can be written to "
            f"{places} (ROCKFRAME_CACHE_DIR names another folder), or its source has no file"
        )
    if once in _announced and seconds < _ANNOUNCE_EACH:
        return
    _announced.add(once)
    _logger.warning(
        "rockframe compiles what %s needs for this machine: about %.0f s where nothing else runs, "
        "%s", PURPOSE.get(), max(seconds, 1.0), once,
    )  # fmt: skip


def _compile_one(place: int, job: Job, waiting: Callable[[], bool]) -> Any:
    try:
        return job.make(waiting)
    except Exception as problem:  # whatever happens inside a compiler
        raise NotCompiledError(place, problem) from problem


@contextmanager
def _with_helper(jobs: Sequence[Job]) -> Generator[Callable[[], bool]]:
    """Start a process that compiles from the last job on; yield whether to wait for it."""
    helper = _start_helper(jobs)
    if helper is None:
        yield lambda: True
        return
    with helper:
        try:
            # after a normal end it has left no job unfinished: others compile what is missing
            yield lambda: not helper.poll()
        except BaseException:
            helper.kill()
            raise


def _start_helper(jobs: Sequence[Job]) -> "subprocess.Popen[bytes] | None":
    """Start a process that compiles what is missing from its end; None where there can be none."""
    if _compilers_run():
        return None
    try:
        missing = [job for job in jobs if not job.is_stored]
    except Exception:  # this process will do everything, and report what is wrong
        return None
    return _process("help_compile", [*reversed(missing)]) if len(missing) > 1 else None


def start_compiler(jobs: Sequence[Job]) -> "subprocess.Popen[bytes] | None":
    """Start a process that compiles jobs while this one continues."""
    return _process("compile_all_of", jobs)


def _process(task: str, jobs: Sequence[Job]) -> "subprocess.Popen[bytes] | None":
    if processors() < 2 or getattr(sys, "frozen", False) or not sys.executable:
        return None
    # `sys.argv` of the command line, for which the libraries of datasets and units are not imported
    name = __name__.partition(".")[0]
    program = (
        f"import gc, os, sys; gc.disable(); sys.path[:] = sys.argv[1:]; sys.argv[:] = [{name!r}]; "
        f"from {__name__} import {task}; "
        f"{task}(sys.stdin.buffer.read()); os._exit(0)"  # to tidy up takes half a second
    )
    try:
        if any(job.file is None for job in jobs):
            return None
        description = pickle.dumps([_description_of(job) for job in jobs])
        process = subprocess.Popen(
            [sys.executable, "-c", program, *sys.path], stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
        )  # fmt: skip
    except Exception:  # this process will do it all, and say what is wrong
        return None
    with suppress(OSError), cast("IO[bytes]", process.stdin) as pipe:
        pipe.write(description)
    return process


def help_compile(description: bytes) -> None:
    """Compile jobs until one is stored already or compiled by another process."""
    for job in _jobs_in(description):
        if job.is_stored or job.file is None or store.is_compiled_elsewhere(job.file):
            return
        job.make()


def compile_all_of(description: bytes) -> None:
    """Compile all jobs, with a helper process if there are more than two processors.

    From the last job on: the process that started this one begins with the first, if it compiles.
    """
    jobs = _jobs_in(description)[::-1]
    if processors() > 2:
        compile_all(jobs)
    else:
        _compile_in_turn(jobs, lambda: True)


def _jobs_in(description: bytes) -> list[Job]:
    jobs = list[Job]()
    for module, name, structure, *kind in pickle.loads(description):  # noqa: S301
        function: Any = import_module(module)
        for part in name.split("."):
            function = getattr(function, part)
        source = getattr(function, "source", function)  # of an entry
        jobs.append(Job(source, structure, *kind))
    return jobs


def _description_of(job: Job) -> tuple[Any, ...]:
    function = job.function
    return function.__module__, function.__qualname__, job.structure, job.is_bound, job.in_lanes


START_AFTER: Final = 0.25
"""Time spent in plain Python after which compilation starts: a few short runs need none [s]."""

START_AT_ONCE: Final = 1.0
"""Remaining time expected in plain Python above which compilation starts at once [s]."""

SAFETY_FACTOR: Final = 1.7
"""Factor by which compiling may take longer than estimated: machines are seldom idle."""

_compilers: Final[list["subprocess.Popen[bytes]"]] = []
"""Processes that compile in the background; they finish their jobs even if this process ends."""


def _compilers_run() -> bool:
    """Whether processes that this one started compile in the background."""
    _compilers[:] = [compiler for compiler in _compilers if compiler.poll() is None]
    return bool(_compilers)


class BackgroundCompilation:
    """The compilation of a call's jobs by another process while calls run in plain Python.

    A context manager, whose blocks are these calls. Then the other process compiles what they do
    not wait for (`later_jobs`): the entry, and the functions that they rarely call if that adds
    little.
    """

    def __init__(self, jobs: Sequence[Job], later_jobs: Sequence[Job] = ()) -> None:
        self._jobs = jobs
        self._later_jobs = later_jobs
        self._seconds = 0.0  # spent in plain Python
        self._started = 0.0
        self._compiler: subprocess.Popen[bytes] | None = None
        self._only_here = False  # no other process can compile it

    def __enter__(self) -> None:
        self._started = thread_time()

    def __exit__(self, *problem: object) -> None:
        seconds = thread_time() - self._started  # processor time: other processes may be running
        self._seconds += seconds
        PYTHON_SECONDS[0] += seconds

    def is_due(self, *, at_once: bool = False) -> bool:
        """Whether to load machine code now, or to compile it in this process, which then waits.

        This process compiles as soon as plain Python is expected to need as long as compiling
        takes at worst. Where no such time is known, it compiles as soon as plain Python has taken
        as long: that is never more than twice the shortest possible time.
        """
        if self._compiler is not None and self._compiler.poll() is None:
            return self._is_worth_compiling()
        try:
            if all(job.is_stored for job in self._jobs):
                return True
        except Exception:  # reported where it is compiled
            return True
        if self._compiler is not None:  # and it has failed
            self._compiler, self._only_here = None, True
        if self._seconds < START_AFTER and REMAINING_SECONDS.get() < START_AT_ONCE and not at_once:
            return False
        if self._has_started_compiler():
            return False
        return (at_once and self._only_here) or self._is_worth_compiling()

    def _is_worth_compiling(self) -> bool:
        at_worst = SAFETY_FACTOR * estimate_wall_time(self._jobs)
        return (REMAINING_SECONDS.get() or self._seconds) >= at_worst

    def _is_worth_adding(self, job: Job) -> bool:
        """Whether a job is an entry, or nearly all that it compiles is compiled for the others."""
        limit = estimate_seconds(self._jobs) + START_AFTER
        return not job.is_bound or estimate_seconds([*self._jobs, job]) < limit

    def _has_started_compiler(self) -> bool:
        """Start a process that compiles, unless enough of them run; whether one was started."""
        if self._only_here or (_compilers_run() and len(_compilers) >= processors() // 2):
            return False
        later = filter(self._is_worth_adding, self._later_jobs)
        self._compiler = start_compiler([*later, *self._jobs])
        self._only_here = self._compiler is None
        if self._compiler is not None:
            _compilers.append(self._compiler)
        return not self._only_here
