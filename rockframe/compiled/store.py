"""The store: folders of the modules that are compiled, and beside them numba's machine code."""

import ast
import hashlib
import os
import sys
import sysconfig
import time
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import cache, partial
from importlib import resources
from importlib.util import resolve_name
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Final
from zlib import crc32

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

_NAME: Final = __name__.partition(".")[0]
PACKAGE: Final["Traversable"] = resources.files(_NAME)
"""The files of the package, which may be in an archive."""
_SOURCES: Final = ("constants.py", "compiled", "signals", "dynamics", "solve",
                   "results/along_steps.py")  # fmt: skip
"""Files and folders of the package that machine code depends on."""

_INSTALLED: Final = tuple(
    Path(sysconfig.get_paths()[kind]) for kind in ("stdlib", "platstdlib", "purelib", "platlib")
)
"""Folders of the standard library and of installed packages, whose files are taken as constant."""


def digest_of_sources(function: Callable[..., Any], classes: Iterable[type]) -> str | None:
    """Return a digest of all files that the machine code of a function depends on, or None."""
    files = _own_files({function.__module__, *(kind.__module__ for kind in classes)})
    package = _package_digest()
    if files is None or package is None:
        return None
    return digest(package, *(path.read_bytes() for path in files))


def digest(*contents: bytes) -> str:
    """Return a digest of contents."""
    total = hashlib.blake2b(digest_size=12)
    for content in contents:
        total.update(len(content).to_bytes(8, "little"))
        total.update(content)
    return total.hexdigest()


@cache
def _package_digest() -> bytes | None:
    """Return a digest of the package's sources, or None: a frozen program may not have them."""
    files = [file for place in _SOURCES for file in _modules_in(PACKAGE / place)]
    parts = [part for file in files for part in (file.name.encode(), file.read_bytes())]
    return digest(*parts).encode() if files else None


def _modules_in(place: "Traversable") -> "Iterator[Traversable]":
    """Return the files of Python's source in a folder and those in it, or a file itself."""
    if place.is_dir():
        for part in sorted(place.iterdir(), key=lambda part: part.name):
            yield from _modules_in(part)
    elif place.name.endswith(".py") and place.is_file():
        yield place


def _own_files(modules: set[str]) -> list[Path] | None:
    """Return the files of modules outside of the package, and of such modules that they import."""
    files: set[Path] = set()
    seen: set[str] = set()
    while modules:
        name = modules.pop()
        if name in seen or name.partition(".")[0] == _NAME:
            continue
        seen.add(name)
        module = sys.modules.get(name)
        file = getattr(module, "__file__", None)
        if module is None or file is None or not Path(file).is_file():
            return None
        files.add(Path(file))
        if Path(file).suffix == ".py":  # a library of machine code names nothing that it imports
            modules.update(_imported(module, Path(file).read_bytes()))
    return sorted(files)


def _imported(module: ModuleType, source: bytes) -> Iterator[str]:
    """Return the names of the modules that a module imports, without installed packages."""
    for node in ast.walk(ast.parse(source)):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            home = "." * node.level + (node.module or "")
            home = resolve_name(home, module.__package__) if node.level else home
            names = [home, *(f"{home}.{alias.name}" for alias in node.names)]
        for name in names:
            file = getattr(sys.modules.get(name), "__file__", None)
            if file is not None and not any(map(Path(file).is_relative_to, _INSTALLED)):
                yield name


LOCK_TIMEOUT: Final = 120.0
"""Age after which a lock file counts as left behind by a killed process; longest wait [s]."""

if sys.platform == "win32":
    import msvcrt

    _LOCKED = PermissionError
    _LOCKED_BYTE: Final = 2**30  # locked bytes cannot be read: lock one behind the end of the file

    def _lock(number: int) -> None:
        os.lseek(number, _LOCKED_BYTE, os.SEEK_SET)
        msvcrt.locking(number, msvcrt.LK_NBLCK, 1)

    def _unlock(number: int) -> None:
        os.lseek(number, _LOCKED_BYTE, os.SEEK_SET)
        msvcrt.locking(number, msvcrt.LK_UNLCK, 1)

else:
    import fcntl

    _LOCKED = BlockingIOError

    def _lock(number: int) -> None:
        fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def _unlock(number: int) -> None:
        fcntl.flock(number, fcntl.LOCK_UN)


def lock(file: Path) -> Callable[[], None] | None:
    """Lock a file and return the function that unlocks it; None if it is locked already."""
    try:
        stream = file.open("r+b")
    except OSError:  # nothing can be written: nobody waits
        return _do_nothing
    number = stream.fileno()
    try:
        _lock(number)
    except _LOCKED:
        stream.close()
        return None
    except OSError:  # the folders of some networks know no locks
        stream.close()
        return _lock_with_file(file.with_suffix(".lock"))

    def release() -> None:
        with stream:
            _unlock(number)

    return release


def _lock_with_file(lock_file: Path) -> Callable[[], None] | None:
    """Make a lock file and return the function that removes it; None if there is one already."""
    with suppress(OSError):
        if time.time() - lock_file.stat().st_mtime > LOCK_TIMEOUT:
            lock_file.unlink()
    try:
        lock_file.touch(exist_ok=False)
    except FileExistsError:
        return None
    except OSError:
        return _do_nothing
    return partial(_remove, lock_file)


def _remove(lock_file: Path) -> None:
    with suppress(OSError):
        lock_file.unlink()


def _do_nothing() -> None:
    """Unlock nothing: no lock could be made."""


_POLL: Final = 0.05
"""Time between two checks whether another process is still compiling [s]."""

_UNUSED_AGE: Final = 30 * 24 * 3600.0
"""Age at which machine code of other sources is removed [s]."""


def module_file(function: Callable[..., Any], text: str, classes: Iterable[type]) -> Path | None:
    """Return the file of a job's module, written if it does not exist; None if it cannot be."""
    classes = list(classes)
    sources = digest_of_sources(function, classes)
    if sources is None:
        return None
    # machine code knows functions and classes by the names of their modules
    modules = sorted({function.__module__, *(kind.__module__ for kind in classes)})
    name = f"{function.__name__}_{digest(' '.join(modules).encode(), text.encode())}"
    for folder in cache_folders():
        place = folder / f"code-{sources}"
        file = place / f"{name}.py"
        try:
            if code_folder(file).is_dir():
                os.utime(place)  # it is in use
            else:
                code_folder(file).mkdir(parents=True, exist_ok=True)
                _remove_unused(folder)
            if not file.is_file():
                _write(file, text)
        except OSError:
            if not has_code(file):  # by another user: it can be read
                continue
        return file
    return None


def code_folder(file: Path) -> Path:
    """Return the folder of the machine code of a module."""
    return file.parent / "__pycache__"


def _write(file: Path, text: str) -> None:
    """Write a file, of which other processes see the whole or nothing."""
    part = file.with_suffix(f".{os.getpid()}")
    part.write_text(text)
    part.replace(file)


def has_code(file: Path) -> bool:
    """Whether machine code of a module is stored beside it, and complete."""
    return _checksum_file(file).is_file()


def check_code(file: Path) -> None:
    """Raise an error if stored machine code is damaged: it could end the process."""
    if _checksum_file(file).read_text() != _checksum(file):
        msg = f"the machine code of {file} is damaged"
        raise ValueError(msg)


def complete_code(file: Path) -> None:
    """Write the checksum of the machine code of a module, where numba has stored some."""
    if _code_files(file):
        _write(_checksum_file(file), _checksum(file))


def _checksum(file: Path) -> str:
    total = 0
    for stored in _code_files(file):
        total = crc32(stored.read_bytes(), total)
    return f"{total:08x}"


def _checksum_file(file: Path) -> Path:
    return code_folder(file) / f"{file.stem}.crc"


def _code_files(file: Path) -> list[Path]:
    return sorted(code_folder(file).glob(f"{file.stem}.*.nb[ci]"))


def is_compiled_elsewhere(file: Path) -> bool:
    """Whether another process compiles a module now."""
    release = lock(file)
    if release is None:
        return True
    release()
    return False


@contextmanager
def lock_while_compiling(file: Path, waiting: Callable[[], bool]) -> Generator[None]:
    """Wait while another process compiles a module, then lock it for this one in this block."""
    started = time.monotonic()
    release = None
    while time.monotonic() - started < LOCK_TIMEOUT and waiting():
        release = lock(file)
        if release is not None:
            break
        time.sleep(_POLL)
    try:
        yield
    finally:
        if release is not None:
            release()


def has_removed_code(file: Path) -> bool:
    """Remove the machine code of a module; return whether that is permitted."""
    try:
        for stored in (_checksum_file(file), *_code_files(file)):
            stored.unlink(missing_ok=True)
    except OSError:
        return False
    return True


def is_module(file: Path) -> bool:
    """Whether a file is a module of the store."""
    return file.parent.parent in cache_folders()


def cache_folders() -> list[Path]:
    """Return the folders that the store may be in, the preferred one first."""
    value = os.environ.get("ROCKFRAME_CACHE_DIR")
    if value:
        return [Path(value)]
    if sys.platform == "win32":
        own = os.environ.get("LOCALAPPDATA", "~/AppData/Local")
    elif sys.platform == "darwin":
        own = "~/Library/Caches"
    else:
        own = os.environ.get("XDG_CACHE_HOME", "~/.cache")
    places = [Path(str(PACKAGE)) / "__pycache__"]
    with suppress(RuntimeError):  # a user without a home, as containers make them
        places.insert(0, Path(own).expanduser() / "rockframe")
    return places


def _remove_unused(folder: Path) -> None:
    for old in folder.glob("code-*"):
        if time.time() - old.stat().st_mtime > _UNUSED_AGE:
            for file in sorted(old.rglob("*"), reverse=True):
                file.rmdir() if file.is_dir() else file.unlink(missing_ok=True)
            old.rmdir()
