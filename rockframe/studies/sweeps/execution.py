"""Running the chunks of a sweep, several at a time."""

from collections.abc import Callable, Generator, Iterable
from concurrent.futures import (
    FIRST_COMPLETED,
    CancelledError,
    Executor,
    Future,
    ThreadPoolExecutor,
    wait,
)
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import islice
from threading import Event
from typing import Final

from rockframe.errors import ComponentError, RockframeError, StudyError, shown
from rockframe.studies.sweeps.axes import OWNER
from rockframe.studies.sweeps.chunk import CaseResults, run_chunk
from rockframe.studies.sweeps.study import SweepJob, worker_count

IN_FLIGHT: Final = 256
"""Most chunks that are handed out at once; their jobs have to be held meanwhile."""
_GLANCE: Final = 0.2
"""Longest wait in which an interrupt might go unheard [s]."""


@dataclass(frozen=True)
class Chunk:
    """Some cases, by their numbers in the order of running."""

    number: int
    cases: range


def run_chunks(
    chunks: Iterable[Chunk],
    job_of: Callable[[Chunk], SweepJob],
    take: Callable[[Chunk, CaseResults], None],
    executor: Executor | None,
) -> bool:
    """Run chunks, and hand on what they showed as they are done."""
    if executor is not None and not hasattr(executor, "submit"):
        msg = f"{OWNER}: executor must be a concurrent.futures.Executor, got {shown(executor)}"
        raise ComponentError(msg)
    stop = Event()
    waiting = iter(chunks)
    going: dict[Future[CaseResults | None], Chunk] = {}
    with _own_threads() if executor is None else _of_the_user(executor) as pool:
        run = partial(run_chunk, stopped=stop.is_set) if executor is None else run_chunk
        try:
            while True:
                for chunk in islice(waiting, IN_FLIGHT - len(going)):
                    going[pool.submit(run, job_of(chunk))] = chunk
                if not going:
                    return True
                done, _ = wait(going, timeout=_GLANCE, return_when=FIRST_COMPLETED)
                _take_all(done, going, take)
        except KeyboardInterrupt:
            stop.set()
            for one in going:
                one.cancel()
            done = {one for one in going if one.done() and not one.cancelled()}
            _take_all({one for one in done if one.exception() is None}, going, take)
            return False
        finally:
            stop.set()
            for one in going:
                one.cancel()


def _take_all(
    done: Iterable[Future[CaseResults | None]],
    going: dict[Future[CaseResults | None], Chunk],
    take: Callable[[Chunk, CaseResults], None],
) -> None:
    for one in done:
        try:
            rows = one.result()
        except (KeyboardInterrupt, CancelledError):
            raise KeyboardInterrupt from None
        except RockframeError:
            raise
        except Exception as problem:
            msg = (
                f"the executor could not run a chunk: {type(problem).__name__}: {problem}; with a "
                "process pool everything in the scene must be importable, and a worker must not "
                "have died"
            )
            raise StudyError(msg) from problem
        chunk = going.pop(one)
        if rows is not None:
            take(chunk, rows)


@contextmanager
def _own_threads() -> Generator[Executor]:
    with ThreadPoolExecutor(worker_count(), thread_name_prefix="rockframe") as pool:
        yield pool


@contextmanager
def _of_the_user(executor: Executor) -> Generator[Executor]:
    yield executor
