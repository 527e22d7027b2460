"""The example of a base of one's own, imported from its file."""

import importlib.util
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import ModuleType

from rockframe.results.schema import SCHEMA
from rockframe.results.variables.variable import Variable

FILE = Path(__file__).parents[1] / "examples" / "own_base.py"
NAME = FILE.stem  # as who runs `import own_base` finds it, with the same machine code


@cache
def _imported() -> tuple[ModuleType, dict[str, Variable]]:
    """Import the example, which registers its base; give the columns that this added, too."""
    before = set(SCHEMA)
    spec = importlib.util.spec_from_file_location(NAME, FILE)
    module = importlib.util.module_from_spec(spec)
    sys.modules[NAME] = module
    spec.loader.exec_module(module)
    return module, {name: row for name, row in SCHEMA.items() if name not in before}


@contextmanager
def example() -> Iterator[ModuleType]:
    """Give the example's module; the table of variables has its columns as long as this lasts."""
    module, rows = _imported()
    SCHEMA.update(rows)
    try:
        yield module
    finally:
        for name in rows:
            del SCHEMA[name]
