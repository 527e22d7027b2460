"""Atomic writing of files, which never replaces a file of another program."""

import os
import shutil
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryFile
from typing import Final, Self, TypeAlias

from rockframe.errors import ComponentError, FileError, short_repr

_MARK_SEARCH_LENGTH: Final = 65536
"""Length at both ends of a file within which the mark of rockframe is found [bytes]."""

PathLike: TypeAlias = str | os.PathLike[str]
Content: TypeAlias = str | bytes | Callable[[Path], object]
"""All text or bytes of a file, or a function that writes it to a path."""


@dataclass(frozen=True)
class FileKind:
    """A kind of file that rockframe writes."""

    name: str  # name of the kind, with an article
    suffixes: tuple[str, ...]  # endings of file names, in small letters
    # whether rockframe wrote an existing file as one of this kind
    is_own: Callable[[Path], bool]

    @classmethod
    def marked(cls, name: str, suffixes: tuple[str, ...], *marks: str) -> Self:
        """Make a kind whose files contain one of some marks near the beginning or the end."""

        def is_own(path: Path) -> bool:
            with path.open("rb") as file:
                beginning = file.read(_MARK_SEARCH_LENGTH)
                file.seek(max(0, path.stat().st_size - _MARK_SEARCH_LENGTH))
                end = file.read()
            return any(mark.encode() in beginning or mark.encode() in end for mark in marks)

        return cls(name, suffixes, is_own)


def generator_tag(what: str, version: str = "") -> str:
    """Return the HTML tag that names rockframe as the author; without a version, its beginning."""
    begun = f'<meta name="generator" content="{what} by rockframe '
    return f'{begun}{version}">' if version else begun


def checked_path(
    path: PathLike, kind: FileKind, *, overwrite: bool = False, read: Iterable[PathLike] = ()
) -> Path:
    """Raise an error if a file must not be written; called before the computation."""
    if not isinstance(overwrite, bool):  # pyright: ignore[reportUnnecessaryIsInstance]
        msg = f"overwrite must be True or False, got {short_repr(overwrite)}"
        raise ComponentError(msg)
    try:
        requested = Path(path).expanduser()
        target = Path(os.path.realpath(requested))
        fault = _path_fault(requested, target, kind)
        if fault is None and os.path.lexists(target):
            fault = _overwrite_fault(target, kind, overwrite, read)
    except (TypeError, ValueError, OSError, RuntimeError) as problem:
        words = (
            f"found {short_repr(path)}; expected the path of a file that can be written ({problem})"
        )
        raise FileError(short_repr(path), words) from problem
    fault = fault or _folder_fault(target.parent)
    if fault is not None:
        raise FileError(os.fspath(path), fault)
    return target


def write_file(
    path: PathLike,
    kind: FileKind,
    content: Content,
    *,
    overwrite: bool = False,
    read: Iterable[PathLike] = (),
) -> Path:
    """Write a file completely or not at all: under another name, then renamed."""
    target = checked_path(path, kind, overwrite=overwrite, read=read)
    part = target.with_name(f".{os.getpid()}.{os.urandom(4).hex()}{Path(path).suffix}")
    try:
        if isinstance(content, str):  # a name of a motion may have letters that cannot be written
            part.write_bytes(content.encode(errors="replace"))
        elif isinstance(content, bytes):
            part.write_bytes(content)
        else:
            content(part)
        with part.open("rb") as file:
            os.fsync(file.fileno())
        if target.exists():
            shutil.copymode(target, part)
        part.replace(target)
    except UnicodeEncodeError as problem:  # netCDF needs names of characters
        words = f"its name cannot be written as {problem.encoding}; name a file in another folder"
        raise FileError(os.fspath(path), words) from problem
    except OSError as problem:
        words = f"it cannot be written ({problem.strerror or problem})"
        raise FileError(os.fspath(path), words) from problem
    except RuntimeError as problem:  # of netCDF, which does not say why
        words = f"it cannot be written ({problem}); the disk may be full"
        raise FileError(os.fspath(path), words) from problem
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)
    return Path(path).expanduser()


def _path_fault(requested: Path, target: Path, kind: FileKind) -> str | None:
    """Say why a path cannot name such a file: a folder, another ending, or no such folder."""
    if target.is_dir():
        return "this is a folder; name a file in it"
    if requested.suffix.lower() not in kind.suffixes:
        suffixes = " or ".join(kind.suffixes)
        fault = f"ends in {requested.suffix!r}" if requested.suffix else "has no ending"
        printed = requested.suffix.lower() == ".pdf" and ".html" in kind.suffixes
        how = "; a browser prints the page into a PDF" if printed else ""
        return f"the name {fault}; that of {kind.name} ends in {suffixes}{how}"
    if not target.parent.is_dir():
        return f"there is no folder {str(requested.parent)!r}"
    return None


def _folder_fault(folder: Path) -> str | None:
    """Say why no file can be made in a folder: permissions alone do not tell."""
    try:
        TemporaryFile(dir=folder).close()
    except OSError as problem:
        return f"it cannot be written ({problem.strerror or problem})"
    return None


def _input_fault(target: Path, read: Iterable[PathLike]) -> str | None:
    for entry in read:
        source = Path(entry).expanduser()
        if source.is_dir() and source.resolve() in target.parents:
            return f"this file is in the input folder {str(entry)!r}; name another one"
        if source.exists() and source.samefile(target):
            return "this file is an input and is not overwritten; name another one"
    return None


def _overwrite_fault(
    target: Path, kind: FileKind, overwrite: bool, read: Iterable[PathLike]
) -> str | None:
    """Say why a file is not replaced: it is an input, no file, or not written by rockframe."""
    fault = _input_fault(target, read)
    if fault is not None:
        return fault
    if not target.is_file():
        return "this is not a regular file; name a regular file or a new one"
    if not overwrite and not kind.is_own(target):
        return (
            f"this file exists already and is not {kind.name} that rockframe wrote; name "
            "another one, or replace it with --overwrite (in Python overwrite=True)"
        )
    return None
