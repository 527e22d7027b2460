"""The examples of a base and of a scene of one's own, imported from their files."""

import importlib.util
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

from rockframe.results.diagnostics import DIAGNOSTICS
from rockframe.results.schema import SCHEMA
from rockframe.system import assembly
from rockframe.system import parts as parts_of

FOLDER = Path(__file__).parents[1] / "examples"
FILE = FOLDER / "own_base.py"
NAME = FILE.stem  # as who runs `import own_base` finds it, with the same machine code
SCENE_FILE = FOLDER / "own_scene.py"
TABLES: tuple[dict[Any, Any], ...] = (SCHEMA, DIAGNOSTICS, assembly._USER_SCENES, parts_of._KINDS)
"""What registration adds to."""


@cache
def _imported(file: Path) -> tuple[ModuleType, list[dict[Any, Any]]]:
    """Import an example, which registers what it brings; give what this added, too."""
    before = [set(table) for table in TABLES]
    spec = importlib.util.spec_from_file_location(file.stem, file)
    module = importlib.util.module_from_spec(spec)
    sys.modules[file.stem] = module
    spec.loader.exec_module(module)
    return module, [
        {key: row for key, row in table.items() if key not in old}
        for table, old in zip(TABLES, before, strict=True)
    ]


@contextmanager
def example(file: Path = FILE) -> Iterator[ModuleType]:
    """Return an example's module; the tables have what it registers as long as this lasts."""
    module, added = _imported(file)
    for table, rows in zip(TABLES, added, strict=True):
        table.update(rows)
    try:
        yield module
    finally:
        for table, rows in zip(TABLES, added, strict=True):
            for key in rows:
                table.pop(key, None)


@contextmanager
def as_before() -> Iterator[None]:
    """Take back all registrations at the end."""
    kept = [dict(table) for table in TABLES]
    try:
        yield
    finally:
        for table, was in zip(TABLES, kept, strict=True):
            table.clear()
            table.update(was)
