"""The files that machine code comes from: when one of them changes, it is made anew."""

import ast
import hashlib
import sys
import sysconfig
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from importlib.util import resolve_name
from pathlib import Path
from types import ModuleType
from typing import Any, Final

PACKAGE: Final = Path(__file__).parent.parent
_SOURCES: Final = ("constants.py", "compiled/*.py", "signals/*.py",
                   "dynamics/**/*.py", "solve/**/*.py")  # fmt: skip
"""Files of the package that machine code depends on."""

_NAME: Final = __name__.partition(".")[0]
_INSTALLED: Final = tuple(
    Path(sysconfig.get_paths()[kind]) for kind in ("stdlib", "platstdlib", "purelib", "platlib")
)
"""Folders of what does not change while one works."""


def digest_of_sources(function: Callable[..., Any], classes: Iterable[type]) -> str | None:
    """Give a name for the contents of all files that a function's machine code comes from."""
    files = _own_files({function.__module__, *(kind.__module__ for kind in classes)})
    if files is None:
        return None
    return digest(_package_digest(), *(path.read_bytes() for path in files))


def digest(*contents: bytes) -> str:
    """Give a name for contents."""
    total = hashlib.blake2b(digest_size=12)
    for content in contents:
        total.update(len(content).to_bytes(8, "little"))
        total.update(content)
    return total.hexdigest()


@cache
def _package_digest() -> bytes:
    files = sorted(path for pattern in _SOURCES for path in PACKAGE.glob(pattern))
    parts = [part for path in files for part in (path.name.encode(), path.read_bytes())]
    return digest(*parts).encode()


def _own_files(modules: set[str]) -> list[Path] | None:
    """Give the files of modules outside of the package, and of what they import of their kind."""
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
        modules.update(_imported(module, Path(file).read_bytes()))
    return sorted(files)


def _imported(module: ModuleType, source: bytes) -> Iterator[str]:
    """Name the modules that a module imports and that are no installed packages."""
    for node in ast.walk(ast.parse(source)):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [each.name for each in node.names]
        elif isinstance(node, ast.ImportFrom):
            home = "." * node.level + (node.module or "")
            home = resolve_name(home, module.__package__) if node.level else home
            names = [home, *(f"{home}.{each.name}" for each in node.names)]
        for name in names:
            file = getattr(sys.modules.get(name), "__file__", None)
            if file is not None and not any(map(Path(file).is_relative_to, _INSTALLED)):
                yield name
