"""The page "The code in ten minutes" lists all packages, and which uses which."""

import ast
import importlib
from pathlib import Path

import pytest
from pages import read, table

PACKAGE = Path(__file__).resolve().parents[2] / "rockframe"
PAGE = "development/house.md"
HEAD = "| package | what it is for | what others take from it | packages that it uses |"
PACKAGES = {path.parent.name for path in PACKAGE.glob("*/__init__.py")}


def packages_used_by(package):
    """Return the packages from which the files of a package import."""
    found = set()
    for file in (PACKAGE / package).rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module == "rockframe":
                found |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("rockframe."):
                found.add(node.module.split(".")[1])
            elif isinstance(node, ast.Import):
                found |= {
                    alias.name.split(".")[1] for alias in node.names if "rockframe." in alias.name
                }
    return found & PACKAGES - {package}


def rows():
    return {row[0].strip("`"): row[1:] for row in table(PAGE, HEAD)}


def test_every_subpackage_is_listed_and_drawn():
    assert set(rows()) == PACKAGES, f"list these packages in docs/{PAGE}, and no others"
    figure = read(PAGE).split("```text\n", 1)[1].split("```", 1)[0]
    assert set(figure.split()) >= PACKAGES, f"draw each package in the figure of docs/{PAGE}"


@pytest.mark.parametrize("package", sorted(PACKAGES))
def test_documented_dependencies_match_imports(package):
    written = {one.strip() for one in rows()[package][2].split(",") if one.strip()}
    assert written == packages_used_by(package), f"correct the row of {package} in docs/{PAGE}"


@pytest.mark.parametrize("package", sorted(PACKAGES))
def test_documented_exports_exist(package):
    modules = [importlib.import_module(f"rockframe.{package}"), *_files(package)]
    for name in rows()[package][1].replace("`", "").split(","):
        assert any(hasattr(module, name.strip()) for module in modules), (
            f"docs/{PAGE}: {package} has no {name.strip()}"
        )


def _files(package):
    for file in sorted((PACKAGE / package).glob("*.py")):
        if file.stem != "__init__":
            yield importlib.import_module(f"rockframe.{package}.{file.stem}")
