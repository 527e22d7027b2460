"""Components from their descriptions, which name their classes."""

from collections.abc import Mapping
from inspect import signature
from typing import Final

from rockframe.components.base import COMPONENT_CLASSES, Component
from rockframe.errors import SchemaError, did_you_mean, short_repr

_TYPE: Final = "type"


def registered_classes() -> Mapping[str, type[Component]]:
    """Return all classes of components by name."""
    return COMPONENT_CLASSES


def component_from_dict(description: Mapping[str, float | str]) -> Component:
    """Build a component of any class from the result of :meth:`Component.to_dict`."""
    if not isinstance(description, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance]
        msg = f"found {short_repr(description)}; expected the description of a component, a mapping"
        raise SchemaError(msg)
    kind = description.get(_TYPE)
    if not isinstance(kind, str) or kind not in COMPONENT_CLASSES:
        known = ", ".join(sorted(COMPONENT_CLASSES))
        msg = (
            f"found a component of type {short_repr(kind)}{did_you_mean(kind, COMPONENT_CLASSES)}; "
            f"expected one of {known}, or of a class of your own in a module that has been imported"
        )
        raise SchemaError(msg)
    try:
        return COMPONENT_CLASSES[kind].from_dict(description)
    except TypeError as problem:
        known = [name for name in signature(COMPONENT_CLASSES[kind]).parameters if name != _TYPE]
        unknown = [
            f"{short_repr(name)} in {kind}{did_you_mean(name, known)}"
            for name in description
            if name not in (_TYPE, *known)
        ]
        if not unknown:
            raise
        msg = f"found {', '.join(unknown)}; expected some of {', '.join(known)}"
        raise SchemaError(msg) from problem
