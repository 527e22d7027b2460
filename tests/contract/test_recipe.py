"""The recipe for conda-forge has the dependencies of pyproject.toml and the current version."""

import re
import tomllib
from pathlib import Path

import pytest

from rockframe.version import __version__

pytestmark = pytest.mark.contract
ROOT = Path(__file__).resolve().parents[2]
CONDA_NAMES = {"netCDF4": "netcdf4", "matplotlib": "matplotlib-base", "dask": "dask-core"}
OPTIONAL = ("records", "progress", "proof", "distributed", "lazy")


def listed(text, head):
    """Return the entries of a list of the recipe, without its own settings."""
    block = re.search(rf"^  {head}:\n((?:    .*\n)+)", text, re.MULTILINE)[1]
    return {entry for entry in re.findall(r"^    - (.+)$", block, re.MULTILINE) if "$" not in entry}


def as_conda(dependencies):
    """Return dependencies of PyPI under their names in conda."""
    matches = [re.fullmatch(r"([\w-]+)(>=[\w.]+)", dependency) for dependency in dependencies]
    return {f"{CONDA_NAMES.get(match[1], match[1])} {match[2]}" for match in matches}


def test_conda_recipe_matches_pyproject():
    text = (ROOT / "docs/development/recipe/recipe.yaml").read_text(encoding="utf-8")
    everything = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    project = everything["project"]
    extras = project["optional-dependencies"]
    assert listed(text, "run") == as_conda([*project["dependencies"], *extras["fast"]])
    optional = [dependency for name in OPTIONAL for dependency in extras[name]]
    assert listed(text, "run_constraints") == as_conda(optional)
    assert listed(text, "host") == {"pip", *as_conda(everything["build-system"]["requires"])}
    assert f'python_min: "{project["requires-python"].removeprefix(">=")}"' in text
    assert f'version: "{__version__}"' in text
    (entry,) = project["scripts"].items()
    assert f"- {' = '.join(entry)}\n" in text
