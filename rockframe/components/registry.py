"""Registry of the classes of components by name, to build components from descriptions."""

from collections.abc import Mapping
from inspect import signature
from typing import TYPE_CHECKING, Final

from rockframe.errors import ComponentError, SchemaError, did_you_mean, short_repr

if TYPE_CHECKING:
    from rockframe.components.base import Component

_KINDS: Final[dict[str, "type[Component]"]] = {}
_TYPE: Final = "type"


def register_class(kind: "type[Component]") -> None:
    """Register a class by its name."""
    known = _KINDS.setdefault(kind.__name__, kind)
    if _full_name(known) != _full_name(kind):
        msg = (
            f"{_full_name(kind)}: another component has this name, {_full_name(known)}; "
            "descriptions refer to components by name, so rename one of them"
        )
        raise ComponentError(msg)
    _KINDS[kind.__name__] = kind


def registered_classes() -> Mapping[str, "type[Component]"]:
    """Return all registered classes by name."""
    return _KINDS


def component_from_dict(description: Mapping[str, float | str]) -> "Component":
    """Build a component of any class from the result of :meth:`Component.to_dict`."""
    if not isinstance(description, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance]
        msg = f"found {short_repr(description)}; expected the description of a component, a mapping"
        raise SchemaError(msg)
    kind = description.get(_TYPE)
    if not isinstance(kind, str) or kind not in _KINDS:
        known = ", ".join(sorted(_KINDS))
        msg = (
            f"found a component of type {short_repr(kind)}{did_you_mean(kind, _KINDS)}; expected "
            "one of "
            f"{known}, or of a class of your own in a module that has been imported"
        )
        raise SchemaError(msg)
    try:
        return _KINDS[kind].from_dict(description)
    except TypeError as problem:
        known = [name for name in signature(_KINDS[kind]).parameters if name != _TYPE]
        unknown = [
            f"{short_repr(name)} in {kind}{did_you_mean(name, known)}"
            for name in description
            if name not in (_TYPE, *known)
        ]
        if not unknown:
            raise
        msg = f"found {', '.join(unknown)}; expected some of {', '.join(known)}"
        raise SchemaError(msg) from problem


def _full_name(kind: type) -> str:
    return f"{kind.__module__}.{kind.__qualname__}"
