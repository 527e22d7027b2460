"""Running the chunks of a sweep, several at a time, with progress."""

import sys
import time
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ThreadPoolExecutor,
    wait,
)
from contextlib import closing, contextmanager
from functools import partial
from threading import Event, Thread
from typing import Any, Final, Protocol, runtime_checkable

from rockframe.compiled import processors
from rockframe.errors import ComponentError, RockframeError, StudyError, short_repr
from rockframe.studies.sweeps.axes import OWNER, Chunk
from rockframe.studies.sweeps.chunk import CaseResults, run_chunk
from rockframe.studies.sweeps.study import SweepJob

_DELAY: Final = 1.0
"""Least duration of work for which a bar is shown, unless one is requested [s]."""
_TOTAL_GROWS: Final = "total grows"
"""Text of a bar when further cases are to come whose number is not known yet."""


@runtime_checkable
class ProgressBar(Protocol):
    """A bar over the cases of one sweep, or of several that follow one another.

    A protocol, since that of the command line is made without the import of studies.
    """

    def name(self, part: str) -> None:
        """Say which part of the whole comes next; the number of parts is unknown."""

    def expect(self, count: int, done: int = 0) -> None:
        """Add cases to the total, of which some were done before."""

    def update(self, count: int) -> None:
        """Add cases that are done."""

    def close(self) -> None:
        """Show the total, which no longer grows."""


class _NoBar(ProgressBar):
    """A bar that shows nothing."""


class _Bar(ProgressBar):
    """A bar of tqdm, begun when the first cases are known."""

    def __init__(self, kind: Any, owner: str, unit: str, delay: float) -> None:
        self._kind = kind
        self._owner = self._words = owner
        self._unit, self._delay = unit, delay
        self._bar: Any = None

    def name(self, part: str) -> None:
        self._words = f"{self._owner}, {part} ({_TOTAL_GROWS})"
        if self._bar is not None:
            self._bar.set_description_str(self._words, refresh=False)

    def expect(self, count: int, done: int = 0) -> None:
        if self._bar is None:
            self._bar = self._kind(
                total=count, initial=done, unit=self._unit, desc=self._words, delay=self._delay
            )
            return
        self._bar.total += count
        # cases done before do not count for the rate
        self._bar.initial += done
        self._bar.n += done
        widgets = getattr(self._bar, "container", None)
        if widgets is not None:  # in notebooks the total is that of a widget too
            widgets.children[1].max = self._bar.total

    def update(self, count: int) -> None:
        self._bar.update(count)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.set_description_str(self._owner, refresh=False)
            self._bar.close()


@contextmanager
def progress_bar(value: object, *, owner: str, unit: str = "case") -> Generator[ProgressBar]:
    """Show a bar during some work."""
    if isinstance(value, ProgressBar):  # of the caller, who closes it
        yield value
        return
    with closing(_make_bar(value, owner, unit)) as bar:
        yield bar


def _make_bar(value: object, owner: str, unit: str) -> ProgressBar:
    if value is not None and not isinstance(value, bool):
        msg = f"{owner}: progress must be True, False or None, got {short_repr(value)}"
        raise ComponentError(msg)
    if value is False:
        return _NoBar()
    try:
        from tqdm import auto
    except ImportError as problem:
        if value is None:
            return _NoBar()
        msg = f"{owner}: progress=True needs tqdm (pip install 'rockframe[progress]')"
        raise ComponentError(msg) from problem
    kind: Any = auto.tqdm
    in_a_notebook = any("notebook" in base.__module__ for base in kind.__mro__)
    if value is None and not (in_a_notebook or _in_a_terminal()):
        return _NoBar()
    return _Bar(kind, owner, unit, _DELAY if value is None else 0.0)


def _in_a_terminal() -> bool:
    try:
        return sys.stderr.isatty()
    except (AttributeError, ValueError):  # there is none, or it is closed
        return False


_CHUNKS_PER_WORKER: Final = 2
"""Chunks submitted at once for each worker, so that no worker waits for its next one."""
_ASSUMED_WORKERS: Final = 128
"""Assumed number of workers of an executor that does not state it."""
_POLL_INTERVAL: Final = 0.2
"""Longest wait during which an interrupt may be delayed [s]."""


_END: Final = Chunk(-1, range(0))
"""Marks the end of the chunks."""


def workers_of_executor(executor: Executor | None) -> int:
    """Return how many chunks an executor can run at once."""
    if executor is None:
        return processors()
    for name in ("_max_workers", "num_workers"):  # of Python's own, of joblib and of mpi4py
        workers = getattr(executor, name, None)
        if isinstance(workers, int) and workers > 0:
            return workers
    client: Any = getattr(executor, "_client", None)
    if hasattr(client, "nthreads"):  # dask; one that grows with the work may have none yet
        return max(1, sum(client.nthreads().values()))
    return _ASSUMED_WORKERS


def run_chunks(
    chunks: Iterable[Chunk | None],
    job_of: Callable[[Chunk], SweepJob],
    collect: Callable[[Chunk, CaseResults], None],
    executor: Executor | None,
    on_poll: Callable[[], None] = lambda: None,
) -> bool:
    """Run chunks, several at once, and pass their results on; return whether all of them have run.

    None among the chunks means that all others are being run elsewhere; the iterator is asked
    again later. `on_poll` is called periodically.
    """
    if executor is not None and (isinstance(executor, type) or not hasattr(executor, "submit")):
        msg = f"{OWNER}: executor must be a concurrent.futures.Executor, got {short_repr(executor)}"
        raise ComponentError(msg)
    stop = Event()
    waiting = iter(chunks)
    running: dict[Future[CaseResults | None], Chunk] = {}
    pool = _thread_pool() if executor is None else executor
    interrupted = False
    run = partial(run_chunk, stopped=stop.is_set) if executor is None else run_chunk
    try:
        more_chunks = True
        while more_chunks or running:
            most = _CHUNKS_PER_WORKER * workers_of_executor(executor) if more_chunks else 0
            while more_chunks and len(running) < most:
                chunk = next(waiting, _END)
                if chunk is None:
                    break
                if chunk is _END:
                    more_chunks = False
                else:
                    running[_submit(pool, run, job_of(chunk))] = chunk
            if running:
                done, _ = wait(running, timeout=_POLL_INTERVAL, return_when=FIRST_COMPLETED)
                _collect_results(done, running, collect)
            elif more_chunks:
                time.sleep(_POLL_INTERVAL)
            on_poll()
        return True
    except BaseException as problem:
        stop.set()
        for future in running:
            future.cancel()
        interrupted = isinstance(problem, KeyboardInterrupt)
        if not interrupted:
            raise
        done = {future for future in running if future.done() and not future.cancelled()}
        succeeded = {future for future in done if future.exception() is None}
        _collect_results(succeeded, running, collect)
        return False
    finally:
        if executor is None:  # threads notice the interrupt later, as when they have compiled
            pool.shutdown(wait=not interrupted)


def _submit(
    pool: Executor, run: Callable[..., CaseResults | None], job: SweepJob
) -> Future[CaseResults | None]:
    """Submit a job, also to a pool whose workers may have died in the meantime."""
    try:
        return pool.submit(run, job)
    except BrokenExecutor as problem:
        raise _executor_error(problem) from problem
    except RuntimeError as problem:  # it has been shut down
        msg = f"the executor takes no work: {problem}; call {OWNER} inside its with block"
        raise StudyError(msg) from problem


def _executor_error(problem: Exception) -> StudyError:
    return StudyError(
        f"the executor could not run a chunk: {type(problem).__name__}: {problem}; with a process "
        "pool everything in the scene must be importable, and a worker must not have died"
    )


def _collect_results(
    done: Iterable[Future[CaseResults | None]],
    running: dict[Future[CaseResults | None], Chunk],
    collect: Callable[[Chunk, CaseResults], None],
) -> None:
    for future in done:
        try:
            rows = future.result()
        except (KeyboardInterrupt, CancelledError):
            raise KeyboardInterrupt from None
        except RockframeError:
            raise
        except MemoryError as problem:
            msg = (
                f"there is too little memory to go on ({problem}); a store keeps what is finished, "
                "and an executor with fewer workers needs less"
            )
            raise StudyError(msg) from problem
        except Exception as problem:
            raise _executor_error(problem) from problem
        chunk = running.pop(future)
        if rows is not None:
            collect(chunk, rows)


class _InlineExecutor(Executor):
    """Runs submitted work immediately, for platforms without threads."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Run it, and give its result; an interrupt is raised to the caller."""
        done: Future[Any] = Future()
        try:
            done.set_result(fn(*args, **kwargs))
        except Exception as problem:
            done.set_exception(problem)
        return done


def _thread_pool() -> Executor:
    try:
        Thread(target=int).start()
    except RuntimeError:  # as in a browser
        return _InlineExecutor()
    return ThreadPoolExecutor(processors(), thread_name_prefix="rockframe")
