"""Type hints of all public names, as read by notebooks and other tools."""

import inspect
from functools import cached_property
from typing import get_type_hints

import pytest

import rockframe as rf

pytestmark = pytest.mark.contract


def function_of(thing):
    """Return what stands behind a method, a property or a function."""
    for attribute in ("__func__", "fget"):
        thing = getattr(thing, attribute, thing)
    return thing.func if isinstance(thing, cached_property) else thing


def public():
    """Return each public class and function, methods and properties too, by its name."""
    for name in rf.__all__:
        one = getattr(rf, name)
        members = getattr(one, "__all__", ()) if inspect.ismodule(one) else ()
        for label, thing in [(name, one), *((f"{name}.{m}", getattr(one, m)) for m in members)]:
            yield label, thing
            if inspect.isclass(thing):
                for member in ("__init__", *(m for m in dir(thing) if not m.startswith("_"))):
                    yield f"{label}.{member}", inspect.getattr_static(thing, member)


def ours():
    """Return those that are defined here, not inherited from elsewhere."""
    for label, thing in public():
        found = function_of(thing)
        defined = inspect.isfunction(found) or inspect.isclass(found)
        if defined and found.__module__.startswith("rockframe"):
            yield label, found


def test_type_hints_resolve_at_run_time():
    found = dict(ours())
    assert len(found) > 600
    unread = {}
    for label, thing in found.items():
        try:
            get_type_hints(thing)
        except (NameError, TypeError) as error:
            unread[label] = str(error)
    assert unread == {}


def test_type_hints_are_types_not_strings():
    hints = get_type_hints(rf.System.simulate)
    assert hints["motion"] == rf.GroundMotion | None
