"""Locks on files that end with the process that holds them, however it ends."""

import os
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Final

LONGEST: Final = 120.0
"""Age at which a mark counts as left behind by a process that was killed [s]."""

if sys.platform == "win32":
    import msvcrt

    _ELSEWHERE = PermissionError
    _BEYOND: Final = 2**30  # what is locked cannot be read: a byte behind all that is

    def _lock(number: int) -> None:
        os.lseek(number, _BEYOND, os.SEEK_SET)
        msvcrt.locking(number, msvcrt.LK_NBLCK, 1)

    def _unlock(number: int) -> None:
        os.lseek(number, _BEYOND, os.SEEK_SET)
        msvcrt.locking(number, msvcrt.LK_UNLCK, 1)

else:
    import fcntl

    _ELSEWHERE = BlockingIOError

    def _lock(number: int) -> None:
        fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def _unlock(number: int) -> None:
        fcntl.flock(number, fcntl.LOCK_UN)


def lock(file: Path) -> Callable[[], None] | None:
    """Lock a file, unless another process or thread has locked it."""
    try:
        stream = file.open("r+b")
    except OSError:  # nothing can be written: nobody waits
        return _nothing
    number = stream.fileno()
    try:
        _lock(number)
    except _ELSEWHERE:
        stream.close()
        return None
    except OSError:  # the folders of some networks know no locks
        stream.close()
        return _marked(file.with_suffix(".lock"))

    def release() -> None:
        with stream:
            _unlock(number)

    return release


def _marked(mark: Path) -> Callable[[], None] | None:
    """Make a file that stands for a lock, and outlives a process that is killed."""
    with suppress(OSError):
        if time.time() - mark.stat().st_mtime > LONGEST:
            mark.unlink()
    try:
        mark.touch(exist_ok=False)
    except FileExistsError:
        return None
    except OSError:
        return _nothing
    return partial(_removed, mark)


def _removed(mark: Path) -> None:
    with suppress(OSError):
        mark.unlink()


def _nothing() -> None:
    """Release what could not be locked."""
