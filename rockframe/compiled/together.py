"""Compiling what belongs together, by two processes where nothing has been kept.

numba compiles one function at a time. A helper process starts at the other end of the list, and
both meet: each finds in the store what the other one has made.
"""

import os
import pickle
import subprocess
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Any

from rockframe.compiled import store
from rockframe.compiled.entries import Entry
from rockframe.compiled.jobs import Job


def make_all(jobs: Sequence[Job]) -> list[Any]:
    """Compile jobs, or take what was kept of them.

    Parameters
    ----------
    jobs : sequence of Job
        What is to be compiled.

    Returns
    -------
    list of callable
        In the order of the jobs.
    """
    missing = [job for job in jobs if not job.is_stored]
    helper = _helper(missing) if len(missing) > 1 else None
    if helper is None:
        return [job.make() for job in jobs]
    with helper as process:
        try:
            return [job.make(lambda: process.poll() is None) for job in jobs]
        except BaseException:
            process.kill()
            raise


def _helper(jobs: Sequence[Job]) -> "subprocess.Popen[bytes] | None":
    """Start a process that compiles jobs from the last one on; None where there can be none."""
    if _processors() < 2 or getattr(sys, "frozen", False) or not sys.executable:
        return None
    if any(job.file is None for job in jobs):
        return None
    try:
        order = pickle.dumps([_told(job) for job in reversed(jobs)])
        helper = subprocess.Popen(
            [sys.executable, "-c", _PROGRAM, *sys.path], stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        with helper.stdin:  # type: ignore[union-attr]
            helper.stdin.write(order)  # type: ignore[union-attr]
    except (OSError, pickle.PicklingError, AttributeError, TypeError):
        return None  # this process will do it all
    return helper


_PROGRAM = (
    "import sys; sys.path[:] = sys.argv[1:]; "
    f"from {__name__} import help_with; help_with(sys.stdin.buffer.read())"
)


def help_with(order: bytes) -> None:
    """Compile jobs as long as no other process has come to them.

    Parameters
    ----------
    order : bytes
        Jobs, as they are told to a helper.
    """
    for module, name, structure, bound in pickle.loads(order):  # noqa: S301
        function: Any = import_module(module)
        for part in name.split("."):
            function = getattr(function, part)
        job = Job(function.source if isinstance(function, Entry) else function, structure, bound)
        if job.is_stored or job.file is None or store.is_compiled_elsewhere(job.file):
            return
        job.make()


def _told(job: Job) -> tuple[str, str, tuple[Any, ...], bool]:
    return job.function.__module__, job.function.__qualname__, job.structure, job.bound


def _processors() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
