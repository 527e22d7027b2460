"""The page "The code in ten minutes" lists all rooms, and which uses which."""

import ast
import importlib
from pathlib import Path

import pytest
from pages import read, table

PACKAGE = Path(__file__).resolve().parents[2] / "rockframe"
PAGE = "development/house.md"
HEAD = "| room | what it is for | what others take from it | rooms that it uses |"
ROOMS = {path.parent.name for path in PACKAGE.glob("*/__init__.py")}


def rooms_used_by(room):
    """Return the rooms from which the files of a room import."""
    found = set()
    for file in (PACKAGE / room).rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module == "rockframe":
                found |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("rockframe."):
                found.add(node.module.split(".")[1])
            elif isinstance(node, ast.Import):
                found |= {
                    alias.name.split(".")[1] for alias in node.names if "rockframe." in alias.name
                }
    return found & ROOMS - {room}


def rows():
    return {row[0].strip("`"): row[1:] for row in table(PAGE, HEAD)}


def test_every_subpackage_is_listed_and_drawn():
    assert set(rows()) == ROOMS, f"give each room a row of the table in docs/{PAGE}, and no other"
    figure = read(PAGE).split("```text\n", 1)[1].split("```", 1)[0]
    assert set(figure.split()) >= ROOMS, f"draw each room in the figure of docs/{PAGE}"


@pytest.mark.parametrize("room", sorted(ROOMS))
def test_documented_dependencies_match_imports(room):
    written = {one.strip() for one in rows()[room][2].split(",") if one.strip()}
    assert written == rooms_used_by(room), f"write these rooms in the row of {room} in docs/{PAGE}"


@pytest.mark.parametrize("room", sorted(ROOMS))
def test_documented_exports_exist(room):
    modules = [importlib.import_module(f"rockframe.{room}"), *_files(room)]
    for name in rows()[room][1].replace("`", "").split(","):
        assert any(hasattr(module, name.strip()) for module in modules), (
            f"docs/{PAGE} says that others take {name.strip()} from {room}, which has no such name"
        )


def _files(room):
    for file in sorted((PACKAGE / room).glob("*.py")):
        if file.stem != "__init__":
            yield importlib.import_module(f"rockframe.{room}.{file.stem}")
