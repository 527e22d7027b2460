"""No module needs one that needs it, by whatever import.

Imports inside functions and imports for type checkers count, too: import-linter checks layers of
packages, and Python itself only what is imported when a module is loaded.
"""

import ast
from collections.abc import Iterator
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import rockframe as rf

pytestmark = pytest.mark.contract

ROOT = Path(rf.__file__).parents[1]


def module_name(file: Path) -> str:
    """Return the name of a module by its file."""
    parts = file.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


FILES = {module_name(file): file for file in (ROOT / "rockframe").rglob("*.py")}


def imported_modules(source: str) -> Iterator[str]:
    """Return the modules of the package that a source imports anywhere."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                name = f"{node.module}.{alias.name}"
                yield name if name in FILES else node.module


def test_every_form_of_import_is_found():
    source = (
        "import rockframe.errors\nfrom rockframe.units import reading\n"
        "if TYPE_CHECKING:\n    from rockframe.motion.value import MotionValue\n"
        "def f():\n    from rockframe.solve import driver\n"
    )
    assert set(imported_modules(source)) == {
        "rockframe.errors", "rockframe.units.reading", "rockframe.motion.value",
        "rockframe.solve.driver",
    }  # fmt: skip


def test_imports_form_no_cycle():
    graph = {
        name: (set(imported_modules(file.read_text("utf-8"))) & FILES.keys()) - {name}
        for name, file in FILES.items()
    }
    # raises CycleError, which names the modules of the cycle
    order = list(TopologicalSorter(graph).static_order())
    assert len(order) == len(FILES) > 300
    assert sum(map(len, graph.values())) > 2000
