"""The files behind a suite: in folders, in archives, in memory."""

import io
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Final, cast

from rockframe.errors import RecordError, shown
from rockframe.records.archives import check_unpackable, is_archive, members, packs_tar
from rockframe.records.received import IN_MEMORY, path_of
from rockframe.records.source import Source, read_source, source_of

MOST_FILES: Final = 20_000
"""Most files of a folder."""

_START: Final = 512
_OPEN: Final = "open file"


@dataclass(frozen=True)
class Unread:
    """A file that was not read."""

    path: str  # where it is; in an archive, with its path inside
    reason: str  # what was found, and what was expected


def files_of(given: object) -> Iterator[Source | Unread]:
    """Open all files of what a suite is read from."""
    if isinstance(given, bytes | bytearray | memoryview):
        yield from _of_open(io.BytesIO(bytes(given)), IN_MEMORY)
    elif hasattr(given, "read"):
        name = getattr(given, "name", None)
        yield from _of_open(cast("IO[bytes]", given), name if isinstance(name, str) else _OPEN)
    elif isinstance(given, Iterable) and not isinstance(given, str):
        for one in cast("Iterable[Any]", given):
            yield from files_of(one)
    else:
        path = path_of(given)
        try:
            there, folder = path.exists(), path.is_dir()
        except (OSError, ValueError):
            there = folder = False
        if not there:
            found = f"no such file or folder, {shown(given)}"
            raise RecordError(str(path), found=found, expected="records")
        yield from _of_folder(path) if folder else _of_path(path)


def _of_folder(folder: Path) -> Iterator[Source | Unread]:
    paths: list[Path] = []
    for path in folder.rglob("*"):
        inside = path.relative_to(folder).parts
        hidden = any(part.startswith(".") or part == "__MACOSX" for part in inside)
        if not hidden and path.is_file():
            paths.append(path)
        if len(paths) > MOST_FILES:
            found = f"a folder of more than {MOST_FILES} files"
            raise RecordError(str(folder), found=found, expected="a folder of records")
    for path in sorted(paths):
        yield from _of_path(path)


def _of_path(path: Path) -> Iterator[Source | Unread]:
    try:
        with path.open("rb") as file:
            start = file.read(_START)
            file.seek(0)
            if is_archive(start) or packs_tar(file):
                yield from _of_archive(file, str(path), path.stat().st_size)
                return
        yield read_source(path)
    except RecordError as problem:
        yield unread(str(path), problem)
    except OSError as problem:
        yield Unread(str(path), f"a file that cannot be read ({problem.strerror})")


def _of_open(file: IO[bytes], name: str) -> Iterator[Source | Unread]:
    try:
        size = file.seek(0, 2)
        file.seek(0)
        start: Any = file.read(_START)
        file.seek(0)
    except (OSError, ValueError, AttributeError) as problem:
        found = f"an open file that cannot be read from its start ({problem})"
        raise RecordError(name, found=found, expected="a file open for reading") from problem
    try:
        if isinstance(start, bytes) and (is_archive(start) or packs_tar(file)):
            yield from _of_archive(file, name, size)
        else:
            yield read_source(file)
    except RecordError as problem:
        yield unread(name, problem)


def _of_archive(file: IO[bytes], name: str, size: int) -> Iterator[Source | Unread]:
    for member in members(file, name, size):
        path = f"{name}/{member.name}"
        if member.hidden:
            continue
        if member.data is None:
            yield Unread(path, member.reason)
            continue
        try:
            check_unpackable(path, member.data)
        except RecordError as problem:
            yield unread(path, problem)
            continue
        yield source_of(path, member.data)


def unread(path: str, problem: RecordError) -> Unread:
    """Say of a file why it was not read."""
    where = "" if problem.line is None else f"line {problem.line}: "
    return Unread(path, f"{where}found {problem.found}; expected {problem.expected}")
