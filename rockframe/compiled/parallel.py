"""Compilation of all jobs of a call, by two processes where they are not stored.

numba compiles one function at a time. A helper process starts from the other end of the list of
jobs, and each process finds in the store what the other one has compiled. Alternatively a second
process compiles everything while this one continues in plain Python: compiled or not, a function
returns the same bits, and a long run returns from time to time (``rockframe.solve.integrate``), so
that it continues as machine code once there is some. A user thus never waits longer for a compiler
than for the run itself. When a run has taken, or is expected to take, as long as both processes
need for the remaining jobs, this process compiles, too.
"""

import gc
import logging
import os
import pickle
import subprocess
import sys
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager, suppress
from importlib import import_module
from time import thread_time
from typing import IO, Any, Final, cast

from rockframe.compiled import store
from rockframe.compiled.jobs import Job, seconds_of
from rockframe.compiled.language import AS_PYTHON, NEEDED_BY, STILL_TAKES

_logger = logging.getLogger("rockframe")
_announced: Final[set[str]] = set()
_FREEZE: Final = 2.0
"""Time of a compilation above which each one is announced, not only the first [s]."""
AGAIN: Final = 0.45
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


def make_all(jobs: Sequence[Job]) -> list[Any]:
    """Compile jobs or load them from the store; last those that other processes compile now."""
    _tell(jobs)
    made: dict[int, Any] = {}
    with _helped(jobs) as waiting, without_collection():
        for now in (True, False):
            for place, job in enumerate(jobs):
                if place not in made and not (now and _is_at_work_on(job)):
                    made[place] = _made(place, job, waiting)
    return [made[place] for place in range(len(jobs))]


@contextmanager
def without_collection() -> Generator[None]:
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


def _is_at_work_on(job: Job) -> bool:
    """Whether another process compiles a job."""
    try:
        file = job.file
        return file is not None and not job.is_stored and store.is_compiled_elsewhere(file)
    except Exception:  # reported where it is compiled
        return False


def time_for(jobs: Sequence[Job]) -> float:
    """Estimate how long the jobs that are not stored take to compile on an idle machine [s]."""
    try:
        missing = [job for job in jobs if not job.is_stored]
        seconds, once = [job.seconds for job in missing], seconds_of(missing)
        together = once + AGAIN * (sum(seconds) - once)
        return max([*seconds, together / min(2, processors())])
    except Exception:  # reported where it is compiled
        return 0.0


def _tell(jobs: Sequence[Job]) -> None:
    """Announce a compilation: what it is for, and about how long it takes."""
    seconds = time_for(jobs)
    if not seconds:
        return
    once = "once"
    if any(job.file is None for job in jobs):
        places = " or ".join(map(str, store.folders()))
        once = (
            "and again in every process: it cannot be kept, for nothing can be written to "
            f"{places} (ROCKFRAME_CACHE_DIR names another folder), or its source has no file"
        )
    if once in _announced and seconds < _FREEZE:
        return
    _announced.add(once)
    _logger.warning(
        "rockframe compiles what %s needs for this machine: about %.0f s where nothing else runs, "
        "%s", NEEDED_BY.get(), max(seconds, 1.0), once,
    )  # fmt: skip


def _made(place: int, job: Job, waiting: Callable[[], bool]) -> Any:
    try:
        return job.make(waiting)
    except Exception as problem:  # whatever happens inside a compiler
        raise NotCompiledError(place, problem) from problem


@contextmanager
def _helped(jobs: Sequence[Job]) -> Generator[Callable[[], bool]]:
    """Start a process that compiles from the last job on; yield whether to wait for it."""
    helper = _helper(jobs)
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


def _helper(jobs: Sequence[Job]) -> "subprocess.Popen[bytes] | None":
    """Start a process that compiles what is missing from its end; None where there can be none."""
    if _are_at_work():
        return None
    try:
        missing = [job for job in jobs if not job.is_stored]
    except Exception:  # this process will do everything, and report what is wrong
        return None
    return _process("help_with", [*reversed(missing)]) if len(missing) > 1 else None


def start_compiler(jobs: Sequence[Job]) -> "subprocess.Popen[bytes] | None":
    """Start a process that compiles jobs while this one continues."""
    return _process("make_all_of", jobs)


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
        order = pickle.dumps([_description_of(job) for job in jobs])
        process = subprocess.Popen(
            [sys.executable, "-c", program, *sys.path], stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
        )  # fmt: skip
    except Exception:  # this process will do it all, and say what is wrong
        return None
    with suppress(OSError), cast("IO[bytes]", process.stdin) as pipe:
        pipe.write(order)
    return process


def help_with(order: bytes) -> None:
    """Compile jobs until one is stored already or compiled by another process."""
    for job in _jobs_in(order):
        if job.is_stored or job.file is None or store.is_compiled_elsewhere(job.file):
            return
        job.make()


def make_all_of(order: bytes) -> None:
    """Compile all jobs, with a helper process if there are more than two processors.

    From the last job on: the process that started this one begins with the first, if it compiles.
    """
    jobs = _jobs_in(order)[::-1]
    if processors() > 2:
        make_all(jobs)
        return
    for job in jobs:
        job.make()


def _jobs_in(order: bytes) -> list[Job]:
    found = list[Job]()
    for module, name, structure, *kind in pickle.loads(order):  # noqa: S301
        function: Any = import_module(module)
        for part in name.split("."):
            function = getattr(function, part)
        source = getattr(function, "source", function)  # of an entry
        found.append(Job(source, structure, *kind))
    return found


def _description_of(job: Job) -> tuple[Any, ...]:
    function = job.function
    return function.__module__, function.__qualname__, job.structure, job.bound, job.in_lanes


def processors() -> int:
    """Return the number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


WORTHWHILE: Final = 0.25
"""Time spent in plain Python after which compilation starts: a few short runs need none [s]."""

LONG: Final = 1.0
"""Remaining time expected in plain Python above which compilation starts at once [s]."""

PRUDENCE: Final = 1.7
"""Factor by which compiling may take longer than estimated: machines are seldom idle."""

_compilers: Final[list["subprocess.Popen[bytes]"]] = []
"""Processes that compile in the background; they finish their jobs even if this process ends."""


def _are_at_work() -> bool:
    """Whether processes that this one started compile in the background."""
    _compilers[:] = [one for one in _compilers if one.poll() is None]
    return bool(_compilers)


class Meanwhile:
    """The compilation of a call's jobs by another process while calls run in plain Python.

    A context manager, whose blocks are these calls. The other process also compiles functions that
    the calls need seldom (`later`), if that adds little.
    """

    def __init__(self, jobs: Sequence[Job], later: Sequence[Job] = ()) -> None:
        self._jobs = jobs
        self._later = later
        self._seconds = 0.0  # spent in plain Python
        self._begun = 0.0
        self._compiler: subprocess.Popen[bytes] | None = None
        self._alone = False  # no other process can compile it

    def __enter__(self) -> None:
        self._begun = thread_time()

    def __exit__(self, *problem: object) -> None:
        seconds = thread_time() - self._begun  # processor time: other processes may be running
        self._seconds += seconds
        AS_PYTHON[0] += seconds

    def is_over(self, *, at_once: bool = False) -> bool:
        """Whether to load machine code now, or to compile it in this process, which then waits.

        This process compiles as soon as plain Python is expected to need as long as compiling
        would. Where no such time is known, it compiles as soon as plain Python has taken as long as
        compiling takes at worst: that is never more than twice the shortest possible time.
        """
        if self._compiler is not None and self._compiler.poll() is None:
            return self._is_worth_compiling()
        try:
            if all(job.is_stored for job in self._jobs):
                return True
        except Exception:  # reported where it is compiled
            return True
        if self._compiler is not None:  # and it has failed
            self._compiler, self._alone = None, True
        if self._seconds < WORTHWHILE and STILL_TAKES.get() < LONG and not at_once:
            return False
        if self._has_started_compiler():
            return False
        return (at_once and self._alone) or self._is_worth_compiling()

    def _is_worth_compiling(self) -> bool:
        rest, needed = STILL_TAKES.get(), time_for(self._jobs)
        return rest >= needed if rest else self._seconds >= PRUDENCE * needed

    def _adds_little(self, job: Job) -> bool:
        """Whether nearly all functions that a job compiles are compiled for the others anyway."""
        return seconds_of([*self._jobs, job]) < seconds_of(self._jobs) + WORTHWHILE

    def _has_started_compiler(self) -> bool:
        """Start a process that compiles, unless enough of them run; whether one was started."""
        if self._alone or (_are_at_work() and len(_compilers) >= processors() // 2):
            return False
        self._compiler = start_compiler([*filter(self._adds_little, self._later), *self._jobs])
        self._alone = self._compiler is None
        if self._compiler is not None:
            _compilers.append(self._compiler)
        return not self._alone
