"""Which chunks of a kept study are being run, and by which job: several jobs share the work.

A claim is a file that only one job can make. It names its job, which renews the modification time
while it is alive. Claims only save work: a chunk appears whole and is the same whichever job runs
it, so that a lost or damaged claim costs time but no result.
"""

import json
import os
import platform
import time
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from rockframe.errors import StudyError

_CLAIMS: Final = "claims"
"""Folder of claims, in that of a study."""
_RENEWAL_INTERVAL: Final = 10.0
"""Time after which a running job renews its claims [s]."""
_TIMEOUT: Final = 150.0
"""Time without renewal after which a job counts as dead; longer than shared file systems cache
modification times [s]."""
_PROC: Final = Path("/proc")


class Claims:
    """The claims on chunks of a study in a folder, as one job sees and makes them."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder / _CLAIMS
        self._own: dict[int, Path] = {}
        # when a claim of another job was last changed by its machine's clock, and since when this
        # one has seen no other change, by its own clock
        self._last_changes: dict[Path, tuple[int, float]] = {}
        self._renewed = time.monotonic()

    def take(self, number: int) -> bool:
        """Claim a chunk, unless a living job has it; of several that try at once, one gets it."""
        claims = [*self._folder.glob(f"{number:06d}-*")]
        last = max(claims, key=_generation, default=None)
        if last is not None and not self._is_dead(last):
            return False
        # the claim of a dead job stays: a file that is never removed cannot be removed twice
        path = self._folder / f"{number:06d}-{0 if last is None else _generation(last) + 1:03d}"
        try:
            self._folder.mkdir(exist_ok=True)
            return self._make(number, path)
        except OSError as problem:
            msg = f"{path} cannot be written: {problem}; the same call continues from what is kept"
            raise StudyError(msg) from problem

    def _make(self, number: int, path: Path) -> bool:
        # linked only when it is complete: a killed job leaves no empty claim
        part = path.with_name(f".{path.name}.{os.urandom(8).hex()}.part")
        try:
            part.write_text(json.dumps(_this_job()), encoding="utf-8")
            _link_or_copy(part, path)
        except (FileExistsError, FileNotFoundError):  # another job was faster, or has tidied up
            return False
        finally:
            part.unlink(missing_ok=True)
        self._own[number] = path
        return True

    def release(self, number: int) -> None:
        """Give up a chunk that has been run, or will not be."""
        path = self._own.pop(number, None)
        if path is not None:
            with suppress(OSError):  # what stays is the claim of a dead job
                path.unlink(missing_ok=True)

    def release_all(self) -> None:
        """Give up all chunks."""
        for number in [*self._own]:
            self.release(number)

    def renew(self) -> None:
        """Signal that this job is alive, if it has not done so for a while."""
        now = time.monotonic()
        if now - self._renewed < _RENEWAL_INTERVAL:
            return
        self._renewed = now
        for path in self._own.values():
            with suppress(OSError):
                os.utime(path)

    def clear(self) -> None:
        """Remove all claims, once all chunks are there."""
        with suppress(OSError):
            for path in [*self._folder.glob("*")]:
                path.unlink(missing_ok=True)
            self._folder.rmdir()

    def _is_dead(self, claim: Path) -> bool:
        """Whether the job that made a claim no longer exists."""
        with suppress(OSError):  # of a claim that cannot be read, its age decides
            if _has_ended(claim.read_bytes()):
                return True
        try:
            changed = claim.stat().st_mtime_ns
        except OSError:  # given up at this moment
            return False
        now = time.monotonic()
        before, since = self._last_changes.get(claim, (changed, now))
        if before != changed:
            since = now
        self._last_changes[claim] = changed, since
        return now - since > _TIMEOUT


def _link_or_copy(part: Path, path: Path) -> None:
    """Give a file its name, unless another has it, also where files cannot have two names."""
    try:
        path.hardlink_to(part)
    except FileExistsError:
        raise
    except (OSError, NotImplementedError):
        with path.open("x", encoding="utf-8") as file:
            file.write(part.read_text(encoding="utf-8"))


def _generation(claim: Path) -> int:
    """Return how many jobs had a chunk before the one that made a claim; -1 of a foreign file."""
    try:
        return int(claim.name.partition("-")[2])
    except ValueError:
        return -1


def _this_job() -> dict[str, Any]:
    """Describe this process, so that others on its machine can check whether it is alive."""
    return {"machine": _machine(), "process": os.getpid(), "begun": _start_of_process(os.getpid())}


def _has_ended(content: bytes) -> bool:
    """Whether a claim is that of a process of this machine that has ended."""
    try:
        job = json.loads(content)
        machine, process, begun = job["machine"], int(job["process"]), job["begun"]
    except (ValueError, TypeError, KeyError, OverflowError):  # damaged: its age decides
        return False
    return begun is not None and machine == _machine() and _start_of_process(process) != begun


def _machine() -> list[str]:
    """Describe where process numbers mean the same: a machine since its start, or a container."""
    identifiers = [platform.node()]
    for path in ("sys/kernel/random/boot_id", "self/ns/pid"):
        with suppress(OSError):
            place = _PROC / path
            identifiers.append(
                os.readlink(place) if place.is_symlink() else place.read_text().strip()
            )
    return identifiers


def _start_of_process(process: int) -> str | None:
    """Return the start of a process of this machine; None if there is none or it is unknown."""
    with suppress(OSError, IndexError):
        status = (_PROC / str(process) / "stat").read_text()
        state, *fields = status.rpartition(")")[2].split()  # numbered from the third field on
        return None if state == "Z" else fields[18]
    return None
