"""The parts of a scene as the tables of a TOML file, with inner tables for their bodies."""

import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from inspect import getmembers, ismethod
from typing import Any, Final

from rockframe.command.files.tables import (
    KeyPath,
    TomlFile,
    arguments_of,
    call_with_table,
    check_table,
    table_title,
)
from rockframe.components import Component, RockingFrame, Stack
from rockframe.components.registry import registered_classes
from rockframe.errors import did_you_mean, short_repr
from rockframe.suggestions import hints_of
from rockframe.system.parts import SLOTS_OF_SEVERAL, default_class, slot_of_class, slots

TYPE: Final = "type"
CONSTRUCTOR: Final = "constructor"
MODULES: Final = "modules"
_COMMON_METHODS: Final = ("from_dict", "declared")
"""Class methods of all components that are not constructors for users."""
_BODIES: Final = "bodies"
_MOTION: Final = "motion"


@dataclass(frozen=True)
class InnerParts:
    """Parts of which another part consists."""

    slots: tuple[str, ...]  # their kinds, the usual one first
    several: bool  # whether they are an array of tables
    or_one: bool = False  # whether a single table may stand for equal ones


_INNER_PARTS: Final[Mapping[type, Mapping[str, InnerParts]]] = {
    Stack: {
        _BODIES: InnerParts(("block",), several=True),
        "interfaces": InnerParts(("pads", "soil", "ground"), several=True, or_one=True),
    },
    RockingFrame: {"column": InnerParts(("block",), several=False)},
}


def part_slots() -> tuple[str, ...]:
    """Return the tables of parts."""
    return tuple(slot for slot in slots() if slot != _MOTION)


def build_parts(file: TomlFile, slot: str, value: object) -> list[Component | None]:
    """Build the part that a table describes, or those of an array of tables."""
    several = slot in SLOTS_OF_SEVERAL and isinstance(value, list)
    return _build_each(file, (slot,), classes_in(slot), value, several=several)


def _build_each(
    file: TomlFile,
    where: KeyPath,
    known: Mapping[str, type[Component]],
    value: Any,
    *,
    several: bool,
) -> list[Component | None]:
    """Build the part of a table, or those of several; parts with faults are None."""
    items: list[Any] = value if several else [value]
    parts: list[Component | None] = []
    for number, item in enumerate(items):
        place = (*where, number) if several else where
        table = file.table(place, item)
        parts.append(None if table is None else _build_part(file, place, known, table))
    return parts


def inner_parts(kind: type[Component]) -> Mapping[str, InnerParts]:
    """Return the parts of which a part consists, by the keys of their tables."""
    return next((inner for of, inner in _INNER_PARTS.items() if issubclass(kind, of)), {})


def _build_part(
    file: TomlFile, where: KeyPath, known: Mapping[str, type[Component]], table: dict[str, Any]
) -> Component | None:
    """Build a part, of one of the known classes, after the parts of which it consists."""
    kind = _class_of(file, where, known, table.pop(TYPE, None))
    if kind is None:
        return None
    constructor = table.pop(CONSTRUCTOR, None)
    if constructor is None:
        function: Callable[..., Component] = kind
        declared = kind.declared()
    else:
        ways = constructors(kind)
        if constructor not in ways:
            listed = ", ".join(ways) or "none but the usual one"
            near = did_you_mean(str(constructor), ways)
            file.add_fault(
                (*where, CONSTRUCTOR),
                f"constructors of {kind.__name__} are {listed}; got "
                f"{short_repr(constructor)}{near}",
            )
            return None
        function, declared = ways[constructor], {}
    inner = inner_parts(kind)
    known_keys = {**dict.fromkeys(inner, True), **arguments_of(function)}
    faulty = [
        name for name in inner
        if name in table and not _build_inner(file, (*where, name), inner[name], table)
    ]  # fmt: skip
    unknown = [name for name in table if name not in known_keys]
    declared = {name: field for name, field in declared.items() if name not in inner}
    if not check_table(file, where, table, known_keys, declared, hints_of(kind.__init__)):
        _note_constructors(file, where, kind, unknown)
        return None
    if faulty:
        return None
    bodies = table.pop(_BODIES, ()) if _BODIES in inner else ()
    return call_with_table(file, where, lambda **values: function(*bodies, **values), table)


def _build_inner(file: TomlFile, where: KeyPath, inner: InnerParts, table: dict[str, Any]) -> bool:
    """Build the parts of an inner table; false if one of them has faults."""
    name = str(where[-1])
    value = table[name]
    several = inner.several and not (inner.or_one and isinstance(value, Mapping))
    if several and not isinstance(value, list):
        header = f"[[{table_title(where)}]]"
        words = f"{name} must be an array of tables, {header} above each, got {short_repr(value)}"
        file.add_fault(where, words)
        return False
    known = {key: kind for slot in inner.slots for key, kind in classes_in(slot).items()}
    parts = _build_each(file, where, known, value, several=several)
    table[name] = parts if several else parts[0]
    return None not in parts


def classes_in(slot: str) -> dict[str, type[Component]]:
    """Return the classes of parts that a table may describe, the usual one first."""
    usual = default_class(slot)
    fitting = {
        name: kind for name, kind in registered_classes().items() if slot_of_class(kind) == slot
    }
    return {usual.__name__: fitting[usual.__name__], **fitting}


def constructors(kind: type[Component]) -> dict[str, Callable[..., Component]]:
    """Return the named constructors of a component, besides its class itself."""
    return {
        name: method
        for name, method in getmembers(kind, ismethod)
        if not name.startswith("_") and name not in _COMMON_METHODS
    }


def _class_of(
    file: TomlFile, where: KeyPath, known: Mapping[str, type[Component]], name: object
) -> type[Component] | None:
    if name is None:
        return next(iter(known.values()))
    if isinstance(name, str) and name in known:
        return known[name]
    of_own = (
        f'; a class of your own is found once its file is named at the top, {MODULES} = ["mine.py"]'
    )
    near = did_you_mean(str(name), known)
    words = f"type must be {' or '.join(known)}, got {short_repr(name)}{near or of_own}"
    file.add_fault((*where, TYPE), words)
    return None


def _note_constructors(
    file: TomlFile, where: KeyPath, kind: type[Component], unknown: list[str]
) -> None:
    """Note which other constructors take the keys that this one does not know."""
    for name in unknown:
        ways = " or ".join(
            f'"{way}"'
            for way, constructor in constructors(kind).items()
            if name in arguments_of(constructor)
        )
        if ways:
            file.add_fault((*where, name), f'"{name}" goes with {CONSTRUCTOR} = {ways}')


_POINT: Final = re.compile(r"\((?P<numbers>[^()]+)\) (?P<unit>\S+)")
"""A point as parts write it, (-0.5, 3.0) m."""
_MEMBERS: Final = "members"
_FROM_MEMBERS: Final = "from_members"


def toml_tables(parts: Iterable[Component]) -> list[tuple[str, list[str]]]:
    """Return the tables of parts, each with its head and keys; together they are a file."""
    listed = [*parts]
    slots_filled = [slot_of_class(type(part)) for part in listed]
    return [
        row
        for part, slot in zip(listed, slots_filled, strict=True)
        for row in _part_tables(part, several=slots_filled.count(slot) > 1)
    ]


def _part_tables(part: Component, *, several: bool) -> Iterator[tuple[str, list[str]]]:
    """Return the table of a part, and those of the parts of which it consists."""
    slot, inner = slot_of_class(type(part)) or type(part).__name__, inner_parts(type(part))
    values: dict[str, Any] = dict(part.to_dict())
    head = f"[[{slot}]]" if several else f"[{slot}]"
    plain = {name: value for name, value in values.items() if name not in inner}
    yield head, _key_lines(plain, slot)
    for name, form in inner.items():
        title = f"{slot}.{name}"
        held = values[name]
        for item in held if form.several else [held]:
            yield f"[[{title}]]" if form.several else f"[{title}]", _key_lines(item, form.slots[0])


def _key_lines(values: Mapping[str, Any], slot: str) -> list[str]:
    """Write the keys of a table with their values; the class only where it is not the usual one."""
    remaining = dict(values)
    kind = str(remaining.pop(TYPE))
    keys: dict[str, Any] = {} if kind == default_class(slot).__name__ else {TYPE: kind}
    part = registered_classes()[kind]
    if _FROM_MEMBERS in constructors(part) and not remaining.keys() <= part.declared().keys():
        keys[CONSTRUCTOR] = _FROM_MEMBERS  # the only one whose arguments a part keeps
    if _MEMBERS in remaining:
        remaining[_MEMBERS] = json.loads(remaining[_MEMBERS])
    keys |= remaining
    return [f"{name} = {toml_value(value)}" for name, value in keys.items()]


def toml_value(value: Any) -> str:
    """Write a value; a point in brackets."""
    if isinstance(value, Mapping):
        inner = ", ".join(f"{name} = {toml_value(item)}" for name, item in value.items())
        return f"{{ {inner} }}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(toml_value, value))}]"
    point = _POINT.fullmatch(value) if isinstance(value, str) else None
    if point is not None:
        return toml_value([f"{number} {point['unit']}" for number in point["numbers"].split(", ")])
    return json.dumps(value, ensure_ascii=False)
