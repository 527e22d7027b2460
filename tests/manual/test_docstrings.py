"""Every public name documents its arguments, results and exceptions."""

import inspect

import pytest
from pages import reference_names

import rockframe as rf

FunctionDoc = pytest.importorskip("numpydoc.docscrape").FunctionDoc

CLASSES = [name for name in rf.__all__ if inspect.isclass(getattr(rf, name))]
FUNCTIONS = [name for name in rf.__all__ if inspect.isfunction(getattr(rf, name))]
PLOTS = [name for name in rf.plot.__all__ if inspect.isfunction(getattr(rf.plot, name))]


PACKAGES = [name for name in rf.__all__ if inspect.ismodule(getattr(rf, name))]


def public_functions():
    """Return all public functions and methods by their names."""
    for name in FUNCTIONS:
        yield name, getattr(rf, name)
    for name in PLOTS:
        yield f"plot.{name}", getattr(rf.plot, name)
    for name in CLASSES:
        kind = getattr(rf, name)
        for attribute in dir(kind):
            value = inspect.getattr_static(kind, attribute)
            value = getattr(value, "__func__", value)
            ours = (getattr(value, "__module__", None) or "").startswith("rockframe")
            if not attribute.startswith("_") and inspect.isfunction(value) and ours:
                yield f"{name}.{attribute}", value


ALL = dict(public_functions())


def test_public_functions_are_found():
    assert len(ALL) > 80


@pytest.mark.parametrize("name", sorted(rf.__all__))
def test_every_public_name_is_documented(name):
    value = getattr(rf, name)
    if name != "__version__":
        assert inspect.getdoc(value)


def test_every_public_name_has_a_page():
    """The reference lists each public name exactly once."""
    shown = reference_names()
    assert len(shown) == len(set(shown)) > 100
    public = {name for name in rf.__all__ if name not in (*PACKAGES, "__version__")}
    for package in ("plot", "export", "codes", "errors", "measures"):
        module = getattr(rf, package)
        names = getattr(module, "__all__", None) or [
            name for name, value in vars(module).items()
            if inspect.isclass(value) and value.__module__ == module.__name__ and name[0] != "_"
        ]  # fmt: skip
        public |= {
            f"{package}.{name}"
            for name in names
            if not name.isupper()
            and not (name in rf.__all__ and getattr(rf, name) is getattr(module, name))
        }
    assert public - set(shown) == set()


def test_parameters_are_described():
    missing = []
    classes = {name: getattr(rf, name) for name in CLASSES}
    for name, function in {**ALL, **classes}.items():
        sections = FunctionDoc(function, doc=inspect.getdoc(function))
        described = {
            word.strip().lstrip("*")
            for one in (*sections["Parameters"], *sections["Other Parameters"])
            for word in one.name.split(",")
        }
        taken = list(inspect.signature(function).parameters.values())
        own = [one.name for one in taken[inherits(function) :] if one.name != "self"]
        missing += [f"{name}({one})" for one in own if one not in described]
    assert missing == []


def inherits(function):
    """Return the number of leading arguments that are the object or the class."""
    first = next(iter(inspect.signature(function).parameters), "")
    return int(first in ("self", "cls", "kind", "motion", "made", "suite"))


def test_return_values_are_described():
    missing = [
        name
        for name, function in ALL.items()
        if inspect.signature(function).return_annotation
        not in (None, "None", inspect.Signature.empty)
        and not FunctionDoc(function)["Returns"]
    ]
    assert missing == []


def test_array_docs_state_their_shape():
    """Array arguments and results state their shapes; datasets state their dimensions."""
    missing = [
        f"{name}: {one.name} : {one.type}"
        for name, function in ALL.items()
        for part in ("Parameters", "Returns")
        for one in FunctionDoc(function)[part]
        if "ndarray" in one.type and "shape" not in one.type
    ]
    assert missing == []


def test_functions_with_quantities_document_raises():
    """Functions with a quantity argument refuse quantities of another kind."""
    missing = [
        name
        for name, function in ALL.items()
        if any("Quantity" in one.type for one in FunctionDoc(function)["Parameters"])
        and not FunctionDoc(function)["Raises"]
    ]
    assert missing == []
