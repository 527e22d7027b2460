"""Examples in docstrings run and print what they show; every public function has one."""

import doctest
import importlib
import inspect
import pkgutil
import re
from unittest import mock

import matplotlib.pyplot as plt
import pint
import pytest
from pages import reference_names

import rockframe
from rockframe.results.diagnostics import DIAGNOSTICS
from rockframe.results.schema import SCHEMA

pytestmark = [
    pytest.mark.contract,
    pytest.mark.filterwarnings("ignore::rockframe.errors.RockframeWarning"),
]
MODULES = [
    found.name
    for found in pkgutil.walk_packages(rockframe.__path__, "rockframe.")
    if not found.name.endswith("__main__")
]
LEFT_OUT = {
    "errors": "exceptions are raised by rockframe, not called by users",
    "extension.OwnScene": "its equations fill a page, docs/guide/own_scene.md, whose code runs",
    "plot.Animation.play": "it needs a window",
    "GroundMotion.from_trace": "its example, which is not run, needs ObsPy",
}
"""What has no example that is run, and why."""


@pytest.fixture(autouse=True)
def registry():
    """Restore the registry of users for examples, since other libraries replace it."""
    before = pint.get_application_registry().get()
    pint.set_application_registry(pint.UnitRegistry())
    yield
    pint.set_application_registry(before)


def examples_in(name):
    """Return the docstrings of a module that have examples."""
    module = importlib.import_module(name)
    return [docstring for docstring in doctest.DocTestFinder().find(module) if docstring.examples]


@pytest.mark.wide
def test_examples_in_docstrings():
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    output: list[str] = []
    with mock.patch.dict(DIAGNOSTICS), mock.patch.dict(SCHEMA):
        for name in MODULES:
            for example in examples_in(name):
                runner.run(example, out=output.append)
                plt.close("all")
    assert runner.tries > 200
    assert not runner.failures, "".join(output)


def documented_object(name):
    """Return an object that the reference lists by its name below `rockframe`."""
    value = rockframe
    for part in name.split("."):
        try:
            value = getattr(value, part)
        except AttributeError:
            value = importlib.import_module(f"{value.__name__}.{part}")
    return value


def executed_code(value):
    """Return the executed code of a docstring's examples."""
    examples = doctest.DocTestParser().get_examples(inspect.getdoc(value) or "")
    return "".join(example.source for example in examples if not example.options.get(doctest.SKIP))


def methods_of(kind):
    """Return the methods of a class defined in this package, by name."""
    for name in dir(kind):
        value = inspect.getattr_static(kind, name)
        value = getattr(value, "__func__", value)
        ours = (getattr(value, "__module__", None) or "").startswith("rockframe")
        if not name.startswith("_") and inspect.isfunction(value) and ours:
            yield name, value


def is_shown(kind, method):
    """Return whether a method is in an example: its own, of an overridden method, or of the class.

    Methods that users write are shown by a class that has them.
    """
    return any(
        executed_code(vars(class_).get(method))
        or re.search(rf"\b{method}\(", executed_code(class_))
        for class_ in kind.__mro__
        if class_ is not object
    )


def test_every_public_callable_has_an_example():
    values = {name: documented_object(name) for name in reference_names()}
    lacking = [name for name, value in values.items() if not executed_code(value)]
    named, shown = {}, set()
    for name, value in values.items():
        for method, function in methods_of(value) if inspect.isclass(value) else ():
            named.setdefault(function, f"{name}.{method}")
            if is_shown(value, method):
                shown.add(function)  # for all classes that inherit it
    lacking += [name for function, name in named.items() if function not in shown]
    assert len(values) + len(named) > 290
    left_out = {
        name: [left for left in LEFT_OUT if name == left or name.startswith(f"{left}.")]
        for name in lacking
    }
    assert [name for name, reasons in left_out.items() if not reasons] == []
    assert {left for reasons in left_out.values() for left in reasons} == set(LEFT_OUT)
