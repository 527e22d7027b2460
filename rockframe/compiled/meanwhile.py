"""Runs in plain Python while their machine code is compiled by another process.

Compiled or not, a function gives the same numbers to the last bit, and a long run comes back now
and then (``rockframe.solve.integrate``): so nobody waits for a compiler longer than for the run
itself, and the run goes on as machine code as soon as there is some.
"""

import subprocess
from collections.abc import Sequence
from time import perf_counter
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from rockframe.compiled.jobs import Job

WORTHWHILE: Final = 0.25
"""Time in plain Python from which on something is compiled: a few short runs need none [s]."""

_compilers: Final[list["subprocess.Popen[bytes]"]] = []
"""Processes that compile; they end what they have begun though this one has ended."""


class Meanwhile:
    """What goes on until there is machine code for a call.

    A context manager, whose blocks are the calls that run in plain Python.
    """

    def __init__(self, jobs: "Sequence[Job]") -> None:
        self._jobs = jobs
        self._seconds = 0.0  # spent in plain Python
        self._begun = 0.0
        self._compiler: subprocess.Popen[bytes] | None = None
        self._alone = False  # no other process can compile it

    def __enter__(self) -> None:
        self._begun = perf_counter()

    def __exit__(self, *problem: object) -> None:
        self._seconds += perf_counter() - self._begun

    def is_over(self, *, at_once: bool = False) -> bool:
        """Whether machine code is to be loaded, or compiled by this process, which then waits.

        By this process where no other one can, or those that may are at work, as soon as plain
        Python has taken as long as compiling will: that is never more than twice the shortest time.
        """
        if self._compiler is not None and self._compiler.poll() is None:
            return False
        try:
            if all(job.is_stored for job in self._jobs):
                return True
        except Exception:  # said where it is compiled
            return True
        if self._compiler is not None:  # and it has failed
            self._compiler, self._alone = None, True
        if self._seconds < WORTHWHILE and not at_once:
            return False
        if self._has_started_compiler():
            return False
        return (at_once and self._alone) or self._seconds >= self._seconds_to_compile()

    def _has_started_compiler(self) -> bool:
        """Start one, unless others are at work; whether that has been done."""
        from rockframe.compiled.parallel import processors, start_compiler

        _compilers[:] = [one for one in _compilers if one.poll() is None]
        if self._alone or len(_compilers) >= max(1, processors() // 2):
            return False
        self._compiler = start_compiler(self._jobs)
        self._alone = self._compiler is None
        if self._compiler is not None:
            _compilers.append(self._compiler)
        return not self._alone

    def _seconds_to_compile(self) -> float:
        from rockframe.compiled.parallel import time_for

        return time_for(self._jobs)
