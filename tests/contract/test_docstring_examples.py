"""The examples in docstrings run as they stand, and show what they give."""

import doctest
import importlib
import pkgutil

import pint
import pytest

import rockframe

pytestmark = [
    pytest.mark.contract,
    pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning"),
]
MODULES = [
    found.name
    for found in pkgutil.walk_packages(rockframe.__path__, "rockframe.")
    if not found.name.endswith("__main__")
]


@pytest.fixture(autouse=True)
def registry():
    """Give examples the registry that users have: other libraries put theirs in its place."""
    before = pint.get_application_registry().get()
    pint.set_application_registry(pint.UnitRegistry())
    yield
    pint.set_application_registry(before)


def examples_in(name):
    """Give the docstrings of a module that have examples."""
    module = importlib.import_module(name)
    return [one for one in doctest.DocTestFinder().find(module) if one.examples]


def test_examples_in_docstrings():
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    told: list[str] = []
    for name in MODULES:
        for example in examples_in(name):
            runner.run(example, out=told.append)
    assert runner.tries > 200
    assert not runner.failures, "".join(told)
