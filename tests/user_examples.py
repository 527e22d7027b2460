"""Imports the examples of a user's base and scene from their files."""

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
NAME = FILE.stem  # as by `import own_base`, with the same machine code
SCENE_FILE = FOLDER / "own_scene.py"
TABLES: tuple[dict[Any, Any], ...] = (SCHEMA, DIAGNOSTICS, assembly._USER_SCENES, parts_of._KINDS)
"""The tables that registration extends."""


@cache
def _imported(file: Path) -> tuple[ModuleType, list[dict[Any, Any]]]:
    """Import an example, which registers its parts; return the module and the added rows."""
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
    """Return an example's module; its registrations last as long as this context."""
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
def restored_registrations() -> Iterator[None]:
    """Undo all registrations at the end."""
    saved = [dict(table) for table in TABLES]
    try:
        yield
    finally:
        for table, rows_before in zip(TABLES, saved, strict=True):
            table.clear()
            table.update(rows_before)
