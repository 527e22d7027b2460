"""The parts of a scene as the tables of a file have them."""

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Final

from rockframe.command.files.parts import CONSTRUCTOR, TYPE, constructors, inner_parts
from rockframe.components import Component
from rockframe.components.registry import registered_classes
from rockframe.system.parts import RESTRAINER, default_class, slot_of_class

_POINT: Final = re.compile(r"\((?P<numbers>[^()]+)\) (?P<unit>\S+)")
"""A point as parts write it, (-0.5, 3.0) m."""
_MEMBERS: Final = "members"
_FROM_MEMBERS: Final = "from_members"


def toml_tables(parts: Iterable[Component]) -> list[tuple[str, list[str]]]:
    """Return the tables of parts: the head of each, and its keys with their values.

    One below the other they are a file of the same parts.
    """
    found = [*parts]
    several = sum(slot_of_class(type(part)) == RESTRAINER for part in found) > 1
    return [row for part in found for row in _part_tables(part, several=several)]


def _part_tables(part: Component, *, several: bool) -> Iterator[tuple[str, list[str]]]:
    """Return the table of a part, and those of the parts of which it consists."""
    slot, inner = slot_of_class(type(part)) or type(part).__name__, inner_parts(type(part))
    values: dict[str, Any] = dict(part.to_dict())
    head = f"[[{slot}]]" if several and slot == RESTRAINER else f"[{slot}]"
    own = {name: value for name, value in values.items() if name not in inner}
    yield head, _key_lines(own, slot)
    for name, one in inner.items():
        title = f"{slot}.{name}"
        held = values[name]
        for each in held if one.several else [held]:
            yield f"[[{title}]]" if one.several else f"[{title}]", _key_lines(each, one.slots[0])


def _key_lines(values: Mapping[str, Any], slot: str) -> list[str]:
    """Write the keys of a table with their values; the class only where it is not the usual one."""
    rest = dict(values)
    kind = str(rest.pop(TYPE))
    keys: dict[str, Any] = {} if kind == default_class(slot).__name__ else {TYPE: kind}
    part = registered_classes()[kind]
    if _FROM_MEMBERS in constructors(part) and not rest.keys() <= part.declared().keys():
        keys[CONSTRUCTOR] = _FROM_MEMBERS  # the only one whose arguments a part keeps
    if _MEMBERS in rest:
        rest[_MEMBERS] = json.loads(rest[_MEMBERS])
    keys |= rest
    return [f"{name} = {_toml_value(value)}" for name, value in keys.items()]


def _toml_value(value: Any) -> str:
    if isinstance(value, Mapping):
        inner = ", ".join(f"{name} = {_toml_value(one)}" for name, one in value.items())
        return f"{{ {inner} }}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_toml_value, value))}]"
    point = _POINT.fullmatch(value) if isinstance(value, str) else None
    if point is not None:
        return _toml_value([f"{number} {point['unit']}" for number in point["numbers"].split(", ")])
    return json.dumps(value, ensure_ascii=False)
