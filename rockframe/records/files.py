"""Bytes of record files: from a path, a folder, an archive, memory or an open file."""

import gzip
import io
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Final, TypeAlias, cast

from rockframe.arguments import is_iterable
from rockframe.errors import RecordError, short_repr
from rockframe.records.archives import (
    MAXIMUM_BYTES,
    begins_like_archive,
    check_unpackable,
    is_archive,
    is_gzip,
    unpack_members,
)
from rockframe.records.reader import Source, base_name, check_size, source_of

PathLike: TypeAlias = str | os.PathLike[str]
RecordLike: TypeAlias = PathLike | bytes | IO[bytes] | IO[str]
"""The path of a file, its bytes, or an open file."""

IN_MEMORY: Final = "bytes"
"""Name of bytes without a file, in messages."""
_OPEN: Final = "open file"


def read_source(given: RecordLike) -> Source:
    """Read the bytes of one record file, and unpack them if needed."""
    name, data = name_and_bytes(given)
    check_unpackable(name, data)
    if is_archive(io.BytesIO(data)):
        name, data = _only_member(name, data)
    elif is_gzip(data):
        base = base_name(name)
        inner = base[:-3] if base.casefold().endswith(".gz") and len(base) > 3 else base
        name, data = f"{name}/{inner}", decompressed(name, data)
    return source_of(name, data)


def name_and_bytes(value: object) -> tuple[str, bytes]:
    """Return name and bytes of an argument, without unpacking."""
    if isinstance(value, bytes | bytearray | memoryview):
        data = bytes(value)
        check_size(IN_MEMORY, len(data), MAXIMUM_BYTES)
        return IN_MEMORY, data
    if hasattr(value, "read"):
        return _read_open_file(cast("IO[bytes]", value))
    path = path_of(value)
    return str(path), _read_path(path)


def path_of(value: object) -> Path:
    """Read an argument that is the path of a file or a folder."""
    try:
        return Path(cast("str", value)).expanduser()
    except (TypeError, ValueError, RuntimeError) as problem:
        raise _no_name(value) from problem


def decompressed(name: str, data: bytes) -> bytes:
    """Unpack a gzip file."""
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(data)) as file:
            unpacked = file.read(MAXIMUM_BYTES + 1)
    except Exception as problem:  # damaged files raise exceptions that are not documented
        found = f"a gzip file that cannot be unpacked ({type(problem).__name__})"
        raise RecordError(name, found=found, expected="a record file") from problem
    check_size(name, len(unpacked), MAXIMUM_BYTES)
    if begins_like_archive(unpacked) or is_gzip(unpacked):
        found = "a file that is packed twice"
        raise RecordError(name, found=found, expected="a record file")
    return unpacked


def _only_member(name: str, data: bytes) -> tuple[str, bytes]:
    files: list[tuple[str, bytes]] = []
    for member in unpack_members(io.BytesIO(data), name, len(data)):
        if member.hidden:
            continue
        if member.data is None:
            path = f"{name}/{member.name}"
            raise RecordError(path, found=member.reason, expected="a record file")
        files.append((f"{name}/{member.name}", member.data))
        if len(files) > 1:
            held = (
                "an archive of several files, "
                f"{', '.join(file.split('/')[-1] for file, _ in files)}"
            )
            expected = "one record; rockframe.read_suite reads all that are in an archive"
            raise RecordError(name, found=held, expected=expected)
    if not files:
        raise RecordError(name, found="an archive without files", expected="a record file")
    return files[0]


def _read_open_file(file: IO[bytes]) -> tuple[str, bytes]:
    stated_name = getattr(file, "name", None)
    name = stated_name if isinstance(stated_name, str) and stated_name else _OPEN
    try:
        data: Any = file.read(MAXIMUM_BYTES + 1)
    except (OSError, ValueError) as problem:  # closed, or not open for reading
        found = f"an open file that cannot be read ({problem})"
        raise RecordError(name, found=found, expected="a file open for reading") from problem
    if isinstance(data, str):
        data = data.encode()
    if not isinstance(data, bytes):
        found = f"a file object that gives {type(data).__name__}"
        raise RecordError(name, found=found, expected="bytes")
    check_size(name, len(data), MAXIMUM_BYTES)
    return name, data


def _read_path(path: Path) -> bytes:
    name = str(path)
    try:
        if path.is_dir():
            expected = "a record file; rockframe.read_suite reads folders"
            raise RecordError(name, found="a directory", expected=expected)
        if path.exists() and not path.is_file():
            raise RecordError(name, found="no ordinary file", expected="a record file")
        check_size(name, path.stat().st_size, MAXIMUM_BYTES)
        return path.read_bytes()
    except FileNotFoundError as problem:
        raise RecordError(name, found="no such file", expected="a record file") from problem
    except OSError as problem:
        found = f"a file that cannot be read ({problem.strerror})"
        raise RecordError(name, found=found, expected="a readable record file") from problem
    except ValueError as problem:
        if isinstance(problem, RecordError):
            raise
        raise _no_name(name) from problem


def _no_name(value: object) -> RecordError:
    found = f"{value!r}, which names no file"
    return RecordError(str(value), found=found, expected="the path of a record file")


MAX_FILES: Final = 20_000
"""Most files in a folder."""


@dataclass(frozen=True)
class Unread:
    """A file that was not read."""

    path: str  # path; for a file in an archive, with its path inside
    reason: str  # found and expected contents

    @classmethod
    def of(cls, path: str, problem: RecordError) -> "Unread":
        """Return the reason from an error."""
        where = "" if problem.line is None else f"line {problem.line}: "
        return cls(path, f"{where}found {problem.found}; expected {problem.expected}")


def files_of(given: object) -> Iterator[Source | Unread]:
    """Open all files from which a suite is read: a folder, an archive, a file, or several."""
    if isinstance(given, bytes | bytearray | memoryview):
        yield from _files_in_open_file(io.BytesIO(bytes(given)), IN_MEMORY)
    elif hasattr(given, "read"):
        name = getattr(given, "name", None)
        yield from _files_in_open_file(
            cast("IO[bytes]", given), name if isinstance(name, str) else _OPEN
        )
    elif is_iterable(given) and not isinstance(given, str):
        for record in given:
            yield from files_of(record)
    else:
        path = path_of(given)
        try:
            exists, folder = path.exists(), path.is_dir()
        except (OSError, ValueError):
            exists = folder = False
        if not exists:
            found = f"no such file or folder, {short_repr(given)}"
            raise RecordError(str(path), found=found, expected="records")
        yield from _files_in_folder(path) if folder else _files_at_path(path)


def _files_in_folder(folder: Path) -> Iterator[Source | Unread]:
    paths: list[Path] = []
    for path in folder.rglob("*"):
        inside = path.relative_to(folder).parts
        hidden = any(part.startswith(".") or part == "__MACOSX" for part in inside)
        if not hidden and path.is_file():
            paths.append(path)
        if len(paths) > MAX_FILES:
            found = f"a folder of more than {MAX_FILES} files"
            raise RecordError(str(folder), found=found, expected="a folder of records")
    for path in sorted(paths):
        yield from _files_at_path(path)


def _files_at_path(path: Path) -> Iterator[Source | Unread]:
    try:
        with path.open("rb") as file:
            if is_archive(file):
                yield from _files_in_archive(file, str(path), path.stat().st_size)
                return
        yield read_source(path)
    except RecordError as problem:
        yield Unread.of(str(path), problem)
    except OSError as problem:
        yield Unread(str(path), f"a file that cannot be read ({problem.strerror})")


def _files_in_open_file(file: IO[bytes], name: str) -> Iterator[Source | Unread]:
    try:
        size = file.seek(0, 2)
        file.seek(0)
        nothing: Any = file.read(0)  # a text where the file is open as text
        packed = isinstance(nothing, bytes) and is_archive(file)
    except (OSError, ValueError, AttributeError) as problem:
        found = f"an open file that cannot be read from its start ({problem})"
        raise RecordError(name, found=found, expected="a file open for reading") from problem
    try:
        if packed:
            yield from _files_in_archive(file, name, size)
        else:
            yield read_source(file)
    except RecordError as problem:
        yield Unread.of(name, problem)


def _files_in_archive(file: IO[bytes], name: str, size: int) -> Iterator[Source | Unread]:
    for member in unpack_members(file, name, size):
        path = f"{name}/{member.name}"
        if member.hidden:
            continue
        if member.data is None:
            yield Unread(path, member.reason)
            continue
        try:
            check_unpackable(path, member.data)
        except RecordError as problem:
            yield Unread.of(path, problem)
            continue
        yield source_of(path, member.data)
