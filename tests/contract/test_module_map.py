"""The page "Architecture" names every module and folder, and none that is not there."""

import re
from pathlib import Path

import pytest
from pages import read

PACKAGE = Path(__file__).resolve().parents[2] / "rockframe"
ENTRY = re.compile(r"^(`.*)\n: ((?:.*\n(?!\n))*.*)\n", re.MULTILINE)
NAME = re.compile(r"`(\w+(?:\.py|/))`")


def module_map() -> dict[str, set[str]]:
    """Give what the map names, by folder; modules of the package itself under ''."""
    text = read("development/architecture.md")
    section = text.split("## Module map")[1].split("\n## ")[0]
    named: dict[str, set[str]] = {"": set()}
    for head, body in ENTRY.findall(section):
        names = NAME.findall(head)
        named[""] |= set(names)
        for name in names:
            if name.endswith("/"):
                named[name] = set(NAME.findall(body))
    return named


def contents(folder: Path) -> set[str]:
    """Give the names of modules and folders of a folder, folders with a stroke."""
    modules = {path.name for path in folder.glob("*.py") if not path.name.startswith("__")}
    folders = {f"{path.parent.name}/" for path in folder.glob("*/__init__.py")}
    return modules | folders


MAP = module_map()
FOLDERS = [name for name in contents(PACKAGE) if name.endswith("/")]


@pytest.mark.parametrize("folder", ["", *sorted(FOLDERS)])
def test_all_modules_are_on_the_map(folder):
    missing, gone = (
        contents(PACKAGE / folder) - MAP[folder],
        MAP[folder] - contents(PACKAGE / folder),
    )
    words = "in the entry of {} in the module map of docs/development/architecture.md"
    assert not missing, f"name {missing} {words.format(folder or 'the package')}"
    assert not gone, f"no longer name {gone} {words.format(folder or 'the package')}"


def test_the_layers_name_all_folders():
    text = read("development/architecture.md")
    layers = text.split("## Layers")[1].split("\n## ")[0]
    for name in contents(PACKAGE):
        assert re.search(rf"\b{re.sub(r'/|[.]py', '', name)}\b", layers), (
            f"{name} is in no line under Layers of docs/development/architecture.md"
        )
