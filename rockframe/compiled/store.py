"""Machine code on disk, by the sources that it was made from."""

import hashlib
import os
import sys
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Final

_ROOT: Final = Path(__file__).parent.parent
_SOURCES: Final = ("constants.py", "compiled/*.py", "signals/*.py", "dynamics/*.py", "solve/*.py")
"""Files that the machine code depends on."""

_CHECK_SIZE: Final = 32


def knows(file: str) -> bool:
    """Whether a file is one of the sources, so that code made from it is known to be fresh."""
    return Path(file) in _files()


def read(name: str, maker: str) -> bytes | None:
    """Read a function's machine code.

    Parameters
    ----------
    name : str
        Full name of the function.
    maker : str
        Compiler and processor.

    Returns
    -------
    bytes or None
        None where there is none, or it is not whole.
    """
    for folder in _folders():
        try:
            content = (folder / _file_name(name, maker)).read_bytes()
        except OSError:
            continue
        check, code = content[:_CHECK_SIZE], content[_CHECK_SIZE:]
        if _check(code) == check:
            return code
    return None


def write(name: str, maker: str, code: bytes) -> None:
    """Write a function's machine code where that can be written, and drop what is out of date.

    Parameters
    ----------
    name, maker : str
        As in :func:`read`.
    code : bytes
        What :func:`read` is to give.
    """
    for folder in _folders():
        try:
            folder.mkdir(parents=True, exist_ok=True)
            for old in folder.glob(f"{_stem(name, maker)}-*.o"):
                old.unlink(missing_ok=True)
            # other processes see the whole file or none
            file = folder / _file_name(name, maker)
            part = file.with_suffix(f".{os.getpid()}")
            part.write_bytes(_check(code) + code)
            part.replace(file)
        except OSError:
            continue
        return


def _folders() -> list[Path]:
    """Give the folders to look in, and to write to, in this order."""
    given = os.environ.get("ROCKFRAME_CACHE_DIR")
    if given:
        return [Path(given)]
    if sys.platform == "win32":
        own = os.environ.get("LOCALAPPDATA", "~/AppData/Local")
    elif sys.platform == "darwin":
        own = "~/Library/Caches"
    else:
        own = os.environ.get("XDG_CACHE_HOME", "~/.cache")
    return [_ROOT / "__pycache__", Path(own).expanduser() / "rockframe"]


def _stem(name: str, maker: str) -> str:
    """Give the part of a file's name that stays when the sources change."""
    return f"{name}-{sys.implementation.cache_tag}-{_digest(f'{_numba()} {maker}'.encode(), 6)}"


def _file_name(name: str, maker: str) -> str:
    return f"{_stem(name, maker)}-{_sources()}.o"


def _digest(content: bytes, size: int) -> str:
    return hashlib.blake2b(content, digest_size=size).hexdigest()


def _check(code: bytes) -> bytes:
    return hashlib.blake2b(code, digest_size=_CHECK_SIZE).digest()


@cache
def _sources() -> str:
    """Give a digest of the sources."""
    return _digest(b"".join(path.name.encode() + path.read_bytes() for path in _files()), 16)


@cache
def _files() -> tuple[Path, ...]:
    return tuple(path for pattern in _SOURCES for path in sorted(_ROOT.glob(pattern)))


@cache
def _numba() -> str:
    """Tell numba's version without importing it."""
    found = find_spec("numba")
    if found is None or found.origin is None:
        return ""
    version = Path(found.origin).with_name("_version.py")
    return version.read_text() if version.is_file() else ""
