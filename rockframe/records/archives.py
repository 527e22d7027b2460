"""Zip and tar archives, unpacked file by file in memory; nothing is written to the disk.

An archive may be made to harm a program that unpacks it. So it may expand, with all archives in
it, to at most a hundred times its size, and a file in it to at most the size of a record file.
Names that lead out of it, links, devices, and archives within inner archives are reported and
skipped.
"""

import gzip
import io
import re
import tarfile
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import IO, Any, Final, cast

from rockframe.errors import RecordError

MAXIMUM_BYTES: Final = 40 * 2**20
"""Largest file that is opened [byte]."""
MAX_MEMBERS: Final = 10_000
"""Most files in an archive."""
MAX_EXPANSION: Final = 100
"""Largest ratio of unpacked to packed size, in addition to one file of the largest size [1]."""

_ZIP: Final = (b"PK\x03\x04", b"PK\x05\x06")
_GZIP: Final = b"\x1f\x8b"
_TAR: Final = (257, b"ustar")
_OTHER_FORMATS: Final = {
    b"7z\xbc\xaf\x27\x1c": "a 7z archive",
    b"Rar!\x1a\x07": "a RAR archive",
    b"\xfd7zXZ\x00": "a file packed by xz",
    b"BZh": "a file packed by bzip2",
    b"PK\x07\x08": "a part of a zip archive",
}
_EXPECTED: Final = "a record file, or one in a zip, tar or gzip file"
_PACKED: Final = "a file packed inside an archive; unpack that one first"
_START: Final = 512
_DIRECTORY_END: Final = b"PK\x05\x06"
_END_LENGTH: Final = 22
_LOCATOR: Final = b"PK\x06\x07"
_MAX_DIRECTORY_LENGTH: Final = 2 * 2**20
_ENCRYPTED: Final = 0x1
_METHODS: Final = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_DRIVE: Final = re.compile(r"[A-Za-z]:")


@dataclass(frozen=True)
class ArchiveMember:
    """A file in an archive."""

    name: str  # path in the archive
    data: bytes | None  # None if it was not unpacked
    reason: str = ""  # reason why it was not

    @property
    def hidden(self) -> bool:
        """Whether it is a hidden file, or one that macOS adds."""
        parts = self.name.replace("\\", "/").split("/")
        return "__MACOSX" in parts or parts[-1].startswith(".")


def begins_like_archive(start: bytes) -> bool:
    """Tell whether a file begins like a zip or tar archive."""
    place, mark = _TAR
    return start.startswith(_ZIP) or start[place : place + len(mark)] == mark


def is_gzip(start: bytes) -> bool:
    """Tell whether a file begins like a gzip file."""
    return start.startswith(_GZIP)


def is_archive(file: IO[bytes]) -> bool:
    """Tell whether a file is a zip or tar archive, also one that is packed by gzip."""
    start = file.read(_START)
    file.seek(0)
    if is_gzip(start):
        try:
            start = gzip.GzipFile(fileobj=file).read(_START)
        except Exception:  # damaged: unpacking raises the error
            return False
        finally:
            file.seek(0)
    return begins_like_archive(start)


def check_unpackable(name: str, start: bytes) -> None:
    """Refuse a file that is packed by another program."""
    for mark, words in _OTHER_FORMATS.items():
        if start.startswith(mark):
            raise RecordError(name, found=words, expected=_EXPECTED)


def unpack_members(file: IO[bytes], name: str, size: int) -> Iterator[ArchiveMember]:
    """Unpack an archive file by file."""
    budget = _Budget(name, MAX_EXPANSION * size + MAXIMUM_BYTES, MAX_MEMBERS)
    for member in _unpacked_members(file, name, budget):
        inner = member.data
        if inner is None or not is_archive(io.BytesIO(inner)):
            yield _check_not_packed(member)
            continue
        try:
            for entry in _unpacked_members(io.BytesIO(inner), f"{name}/{member.name}", budget):
                yield _check_not_packed(replace(entry, name=f"{member.name}/{entry.name}"))
        except RecordError as problem:  # other files may be readable
            if budget.is_exceeded:
                raise
            yield ArchiveMember(member.name, None, problem.found)


def _check_not_packed(member: ArchiveMember) -> ArchiveMember:
    """Refuse a file that is itself packed."""
    if member.data is not None and (begins_like_archive(member.data) or is_gzip(member.data)):
        return ArchiveMember(member.name, None, _PACKED)
    return member


def _unpacked_members(file: IO[bytes], name: str, budget: "_Budget") -> Iterator[ArchiveMember]:
    start = file.read(_START)
    file.seek(0)
    unpack = _zip_members if start.startswith(_ZIP) else _tar_members
    try:
        for member in unpack(file, name, budget):
            budget.take_member()
            yield member
    except RecordError:
        raise
    except Exception as problem:  # damaged files raise exceptions that are not documented
        found = f"an archive that cannot be unpacked ({type(problem).__name__})"
        raise RecordError(name, found=found, expected=_EXPECTED) from problem


@dataclass
class _Budget:
    """Remaining number of bytes and files to which an archive may expand."""

    name: str
    bytes_left: int
    members_left: int

    @property
    def is_exceeded(self) -> bool:
        """Whether it has been exceeded."""
        return self.bytes_left < 0 or self.members_left < 0

    def take_bytes(self, count: int) -> None:
        self.bytes_left -= count
        if self.bytes_left < 0:
            found = f"an archive that expands to more than {MAX_EXPANSION} times its size"
            raise RecordError(self.name, found=found, expected="an archive of records")

    def take_member(self) -> None:
        self.members_left -= 1
        if self.members_left < 0:
            raise _too_many(self.name)


def _zip_members(file: IO[bytes], name: str, budget: _Budget) -> Iterator[ArchiveMember]:
    _check_directory(file, name)
    with zipfile.ZipFile(file) as archive:
        for info in archive.infolist():
            if info.is_dir():
                continue
            reason = _name_fault(info.filename) or _zip_fault(info)
            if reason:
                yield ArchiveMember(_printable(info.filename), None, reason)
                continue
            try:
                with archive.open(info) as stream:
                    data = stream.read(MAXIMUM_BYTES + 1)
            except Exception as problem:  # as above; other files may be readable
                reason = f"a file that cannot be unpacked ({type(problem).__name__})"
                yield ArchiveMember(info.filename, None, reason)
                continue
            budget.take_bytes(len(data))
            yield _member(info.filename, data)


def _check_directory(file: IO[bytes], name: str) -> None:
    """Refuse a directory that takes long to read, before it is read."""
    file.seek(0, 2)
    end = file.tell()
    file.seek(max(0, end - 2**16 - 100))
    tail = file.read()
    file.seek(0)
    place = len(tail) - _END_LENGTH  # without a comment, where the library searches first
    if not (place >= 0 and tail.startswith(_DIRECTORY_END, place) and tail.endswith(b"\x00\x00")):
        place = tail.rfind(_DIRECTORY_END)
    if place < 0:
        return  # the library raises the error
    size = tail[place + 12 : place + 16]
    if tail[place - 20 : place - 16] == _LOCATOR:  # the zip64 form, which precedes
        size = tail[place - 36 : place - 28]
    if int.from_bytes(size, "little") > _MAX_DIRECTORY_LENGTH:
        raise _too_many(name)


def _zip_fault(info: zipfile.ZipInfo) -> str:
    if info.flag_bits & _ENCRYPTED:
        return "an encrypted file"
    if info.compress_type not in _METHODS:
        return f"a file packed by a method that is not read (number {info.compress_type})"
    kind = (info.external_attr >> 16) & 0o170000
    return "a link" if kind == 0o120000 else ""


def _tar_members(file: IO[bytes], name: str, budget: _Budget) -> Iterator[ArchiveMember]:
    packed = is_gzip(file.read(len(_GZIP)))
    file.seek(0)
    stream = cast("IO[bytes]", gzip.GzipFile(fileobj=file)) if packed else file
    bounded = cast("IO[bytes]", _BoundedFile(stream, budget))
    with tarfile.open(fileobj=bounded, mode="r:") as archive:
        while (info := archive.next()) is not None:
            if info.isdir():
                continue
            reason = _name_fault(info.name) or _tar_fault(info)
            if reason:
                yield ArchiveMember(_printable(info.name), None, reason)
                continue
            inner = archive.extractfile(info)
            data = b"" if inner is None else inner.read(MAXIMUM_BYTES + 1)
            cast("Any", archive).members.clear()  # else it keeps all members in memory
            yield _member(info.name, data)


class _BoundedFile:
    """A file that stops reading beyond the budget of an archive, and limits each read."""

    def __init__(self, file: IO[bytes], budget: _Budget) -> None:
        self._file = file
        self._budget = budget
        self._furthest = 0

    def read(self, count: int = -1) -> bytes:
        if not 0 <= count <= 2 * MAXIMUM_BYTES:
            found = "an archive that announces more than a record has"
            raise RecordError(self._budget.name, found=found, expected="an archive of records")
        data = self._file.read(count)
        self._reach(self._file.tell())
        return data

    def seek(self, place: int, whence: int = 0) -> int:
        if whence == 0:  # skipped bytes are unpacked, too
            self._reach(place)
        return self._file.seek(place, whence)

    def tell(self) -> int:
        return self._file.tell()

    def _reach(self, place: int) -> None:
        self._budget.take_bytes(max(0, place - self._furthest))
        self._furthest = max(self._furthest, place)


def _tar_fault(info: tarfile.TarInfo) -> str:
    if info.issym() or info.islnk():
        return "a link"
    if not info.isreg() or info.issparse():
        return "no ordinary file"
    return f"more than {MAXIMUM_BYTES // 2**20} MiB" if info.size > MAXIMUM_BYTES else ""


def _member(name: str, data: bytes) -> ArchiveMember:
    if len(data) > MAXIMUM_BYTES:
        return ArchiveMember(name, None, f"more than {MAXIMUM_BYTES // 2**20} MiB")
    return ArchiveMember(name, data)


def _name_fault(name: str) -> str:
    """Return the fault of the name of a file in an archive, if any."""
    plain = name.replace("\\", "/")
    if plain.startswith("/") or _DRIVE.match(plain) or ".." in plain.split("/"):
        return "a name that leads out of the archive"
    return "" if name.isprintable() and plain.strip("/") else "a name that cannot be printed"


def _printable(name: str) -> str:
    return "".join(letter if letter.isprintable() else "?" for letter in name)[:200]


def _too_many(name: str) -> RecordError:
    found = f"an archive of more than {MAX_MEMBERS} files"
    return RecordError(name, found=found, expected="an archive of records")
