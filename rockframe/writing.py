"""Files that are written: whole or not at all, and never over what somebody else has written."""

import os
import shutil
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Self, TypeAlias

from rockframe.errors import ComponentError, FileError, shown

_MARKED_WITHIN: Final = 65536
"""Part of a file, from either end, in which its mark stands [bytes]."""

PathLike: TypeAlias = str | os.PathLike[str]
Content: TypeAlias = bytes | Callable[[Path], object]
"""All bytes of a file, or what writes it to a path."""


@dataclass(frozen=True)
class FileKind:
    """A kind of file that rockframe writes."""

    words: str  # what it is, with its article
    endings: tuple[str, ...]  # of names of such files, in small letters
    # whether a file that is there was written by rockframe as one of this kind
    is_own: Callable[[Path], bool]

    @classmethod
    def marked(cls, words: str, endings: tuple[str, ...], *marks: str) -> Self:
        """Make a kind of which each file has one of some marks near its beginning or its end."""

        def is_own(path: Path) -> bool:
            with path.open("rb") as file:
                beginning = file.read(_MARKED_WITHIN)
                file.seek(max(0, path.stat().st_size - _MARKED_WITHIN))
                end = file.read()
            return any(mark.encode() in beginning or mark.encode() in end for mark in marks)

        return cls(words, endings, is_own)


def generator(what: str, version: str = "") -> str:
    """Give the tag by which a page says what wrote it; without a version, how it begins."""
    begun = f'<meta name="generator" content="{what} by rockframe '
    return f'{begun}{version}">' if version else begun


def checked_path(
    path: PathLike, kind: FileKind, *, overwrite: bool = False, read: Iterable[PathLike] = ()
) -> Path:
    """Refuse a file that must not be written; to be asked before the work."""
    if not isinstance(overwrite, bool):  # pyright: ignore[reportUnnecessaryIsInstance]
        msg = f"overwrite must be True or False, got {shown(overwrite)}"
        raise ComponentError(msg)
    try:
        named = Path(path).expanduser()
        place = Path(os.path.realpath(named))
        fault = _fault_of_place(named, place, kind)
        if fault is None and os.path.lexists(place):
            fault = _fault_of_present(place, kind, overwrite, read)
    except (TypeError, ValueError, OSError, RuntimeError) as problem:
        words = f"found {shown(path)}; expected the path of a file that can be written ({problem})"
        raise FileError(shown(path), [(None, words)]) from problem
    if fault is not None:
        raise FileError(os.fspath(path), [(None, fault)])
    return place


def write_file(
    path: PathLike,
    kind: FileKind,
    content: Content,
    *,
    overwrite: bool = False,
    read: Iterable[PathLike] = (),
) -> Path:
    """Write a file whole or not at all: beside its place, and then moved there."""
    place = checked_path(path, kind, overwrite=overwrite, read=read)
    part = place.with_name(f".{os.getpid()}.{os.urandom(4).hex()}{Path(path).suffix}")
    try:
        if isinstance(content, bytes):
            part.write_bytes(content)
        else:
            content(part)
        with part.open("rb") as file:
            os.fsync(file.fileno())
        if place.exists():
            shutil.copymode(place, part)
        part.replace(place)
    except OSError as problem:
        words = f"it cannot be written ({problem.strerror or problem})"
        raise FileError(os.fspath(path), [(None, words)]) from problem
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)
    return Path(path).expanduser()


def _fault_of_place(named: Path, place: Path, kind: FileKind) -> str | None:
    """Say why that cannot be the name of such a file: a folder, another ending, or no folder."""
    if place.is_dir():
        return "this is a folder; name a file in it"
    if named.suffix.lower() not in kind.endings:
        endings = " or ".join(kind.endings)
        found = f"ends in {named.suffix!r}" if named.suffix else "has no ending"
        printed = named.suffix.lower() == ".pdf" and ".html" in kind.endings
        how = "; a browser prints the page into a PDF" if printed else ""
        return f"the name {found}; that of {kind.words} ends in {endings}{how}"
    if not place.parent.is_dir():
        return f"there is no folder {str(named.parent)!r}"
    return None


def check_not_read(path: PathLike, read: Iterable[PathLike]) -> None:
    """Refuse to write over a file that is read, or in a folder that is."""
    place = Path(os.path.realpath(Path(path).expanduser()))
    fault = _fault_of_read(place, read) if os.path.lexists(place) else None
    if fault is not None:
        raise FileError(os.fspath(path), [(None, fault)])


def _fault_of_read(place: Path, read: Iterable[PathLike]) -> str | None:
    for one in read:
        source = Path(one).expanduser()
        if source.is_dir() and source.resolve() in place.parents:
            return f"this is a file in {str(one)!r}, which is read; name another one"
        if source.exists() and source.samefile(place):
            return "this file is read, and so is not written over; name another one"
    return None


def _fault_of_present(
    place: Path, kind: FileKind, overwrite: bool, read: Iterable[PathLike]
) -> str | None:
    """Say why a file is not replaced: it is read, it is no file, or it is somebody else's."""
    fault = _fault_of_read(place, read)
    if fault is not None:
        return fault
    if not place.is_file():
        return "this is no file; name one that is, or a new one"
    if not overwrite and not kind.is_own(place):
        return (
            f"this file is there already, and is not {kind.words} that rockframe wrote; name "
            "another one, or have it replaced by --overwrite (in Python overwrite=True)"
        )
    return None
