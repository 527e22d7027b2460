"""Where the modules of entries are written, and with them, by numba, their machine code."""

import os
import sys
import time
from collections.abc import Callable, Generator, Iterable
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Final

from rockframe.compiled.locks import LONGEST, lock
from rockframe.compiled.sources import PACKAGE, digest, digest_of_sources

_POLL: Final = 0.05
"""Between two looks at whether another process is still compiling [s]."""

_UNUSED: Final = 30 * 24 * 3600.0
"""Age at which machine code of other sources is removed [s]."""


def file_of(function: Callable[..., Any], text: str, classes: Iterable[type]) -> Path | None:
    """Give the file of an entry's module, written if it is not there."""
    classes = list(classes)
    sources = digest_of_sources(function, classes)
    if sources is None:
        return None
    # machine code knows functions and classes by the names of their modules
    modules = sorted({function.__module__, *(kind.__module__ for kind in classes)})
    name = f"{function.__name__}_{digest(' '.join(modules).encode(), text.encode())}"
    for folder in folders():
        try:
            place = folder / f"code-{sources}"
            if place.is_dir():
                os.utime(place)  # it is in use
            else:
                place.mkdir(parents=True, exist_ok=True)
                _remove_unused(folder)
            file = place / f"{name}.py"
            if not file.is_file():  # other processes see the whole file or none
                part = file.with_suffix(f".{os.getpid()}")
                part.write_text(text)
                part.replace(file)
        except OSError:
            continue
        return file
    return None


def has_code(file: Path) -> bool:
    """Whether machine code of a module has been kept beside it."""
    return any((file.parent / "__pycache__").glob(f"{file.stem}.*.nbc"))


def is_compiled_elsewhere(file: Path) -> bool:
    """Whether another process compiles a module now."""
    release = lock(file)
    if release is None:
        return True
    release()
    return False


@contextmanager
def compiling(file: Path, waiting: Callable[[], bool]) -> Generator[None]:
    """Wait as long as another process compiles a module; then let others wait for this one."""
    begun = time.monotonic()
    release = None
    while time.monotonic() - begun < LONGEST and waiting():
        release = lock(file)
        if release is not None:
            break
        time.sleep(_POLL)
    try:
        yield
    finally:
        if release is not None:
            release()


def forget_code(file: Path) -> None:
    """Remove the machine code of a module."""
    for kept in (file.parent / "__pycache__").glob(f"{file.stem}.*.nb[ci]"):
        kept.unlink(missing_ok=True)


def folders() -> list[Path]:
    """Give the folders to write to, in this order."""
    given = os.environ.get("ROCKFRAME_CACHE_DIR")
    if given:
        return [Path(given)]
    if sys.platform == "win32":
        own = os.environ.get("LOCALAPPDATA", "~/AppData/Local")
    elif sys.platform == "darwin":
        own = "~/Library/Caches"
    else:
        own = os.environ.get("XDG_CACHE_HOME", "~/.cache")
    places = [PACKAGE / "__pycache__"]
    with suppress(RuntimeError):  # a user without a home, as containers make them
        places.insert(0, Path(own).expanduser() / "rockframe")
    return places


def _remove_unused(folder: Path) -> None:
    for old in folder.glob("code-*"):
        if time.time() - old.stat().st_mtime > _UNUSED:
            for file in sorted(old.rglob("*"), reverse=True):
                file.rmdir() if file.is_dir() else file.unlink(missing_ok=True)
            old.rmdir()
