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
    """Return the entries of a list of the recipe, without what is a setting of its own."""
    block = re.search(rf"^  {head}:\n((?:    .*\n)+)", text, re.MULTILINE)[1]
    return {entry for entry in re.findall(r"^    - (.+)$", block, re.MULTILINE) if "$" not in entry}


def as_conda(dependencies):
    """Write dependencies of PyPI as conda has them."""
    found = [re.fullmatch(r"([\w-]+)(>=[\w.]+)", one) for one in dependencies]
    return {f"{CONDA_NAMES.get(one[1], one[1])} {one[2]}" for one in found}


def test_conda_recipe_matches_pyproject():
    text = (ROOT / "docs/development/recipe/recipe.yaml").read_text(encoding="utf-8")
    everything = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    project = everything["project"]
    extras = project["optional-dependencies"]
    assert listed(text, "run") == as_conda([*project["dependencies"], *extras["fast"]])
    optional = [one for name in OPTIONAL for one in extras[name]]
    assert listed(text, "run_constraints") == as_conda(optional)
    assert listed(text, "host") == {"pip", *as_conda(everything["build-system"]["requires"])}
    assert f'python_min: "{project["requires-python"].removeprefix(">=")}"' in text
    assert f'version: "{__version__}"' in text
    (entry,) = project["scripts"].items()
    assert f"- {' = '.join(entry)}\n" in text
