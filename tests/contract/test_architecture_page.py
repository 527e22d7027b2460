"""The page "Architecture" names all folders, and the files and names in it exist."""

import re
from pathlib import Path

import pytest
from pages import read

ROOT = Path(__file__).resolve().parents[2]
PAGE = read("development/architecture.md")
PLACE = re.compile(r"\b((?:tests|examples)/)?((?:\w+/)+\w+\.py)\b")
ROW = re.compile(r"^\| .*?\| (`.*?`) \| .*? \|$", re.MULTILINE)
ADDED = ("base", "link", "scene")


def section(title: str) -> str:
    """Return a section, to the next title of any level."""
    return re.split(r"\n##+ ", PAGE.split(f" {title}\n", 1)[1])[0]


TITLES = "A scene's way to its equations", "Adding an output", *(f"Adding a {one}" for one in ADDED)


@pytest.mark.parametrize("title", TITLES)
def test_named_files_exist(title):
    named = [match.group() for match in PLACE.finditer(section(title))]
    assert named
    for name in named:
        assert any((folder / name).is_file() for folder in (ROOT, ROOT / "rockframe")), name


@pytest.mark.parametrize("kind", ADDED)
def test_names_in_tables_occur_in_example(kind):
    text = (ROOT / "examples" / f"own_{kind}.py").read_text(encoding="utf-8")
    rows = ROW.findall(section(f"Adding a {kind}"))
    assert len(rows) >= 3
    for first in rows:
        name = first.strip("`").split("(")[0]
        assert f"class {name}(" in text or f"{name}(" in text, name


def test_the_layers_name_all_folders():
    layers = section("Layers")
    package = ROOT / "rockframe"
    folders = {path.parent.name for path in package.glob("*/__init__.py")}
    modules = {path.stem for path in package.glob("*.py") if not path.name.startswith("__")}
    for name in folders | modules:
        assert re.search(rf"\b{name}\b", layers), (
            f"{name} is in no line under Layers of docs/development/architecture.md"
        )
