"""Functions that are called with a table: its keys are their arguments."""

import re
from collections.abc import Callable, Mapping
from inspect import Parameter, signature
from typing import Any, TypeVar

from rockframe.command.files.lines import Place
from rockframe.command.files.tables import TomlFile, table_title
from rockframe.components.parameters import Declared
from rockframe.errors import AssemblyError, RockframeError, StudyError

Made = TypeVar("Made")


def arguments_of(function: Callable[..., Any], *, without: tuple[str, ...] = ()) -> dict[str, bool]:
    """Give the arguments that a function takes by name, and whether each must be given."""
    named = (Parameter.POSITIONAL_OR_KEYWORD, Parameter.KEYWORD_ONLY)
    return {
        name: one.default is Parameter.empty
        for name, one in signature(function).parameters.items()
        if one.kind in named and name not in ("self", *without)
    }


def checked(
    file: TomlFile,
    where: Place,
    table: Mapping[str, Any],
    known: Mapping[str, bool],
    declared: Mapping[str, Declared[Any, Any]] | None = None,
    hints: Mapping[str, str] | None = None,
) -> bool:
    """Note keys that mean nothing, keys that are missing, and values that cannot be read."""
    sound = True
    declared = declared or {}
    for name in table:
        if name not in known:
            file.unknown(where, name, known, (hints or {}).get(name, ""))
            sound = False
    for name, required in known.items():
        if required and name not in table:
            file.fault(where, f"[{table_title(where)}] lacks {name!r}{_wanted(declared.get(name))}")
            sound = False
    for name, value in table.items():
        if name in known and name in declared:
            try:
                declared[name].accept(value, f"[{table_title(where)}]")
            except RockframeError as problem:
                file.fault((*where, name), str(problem))
                sound = False
    return sound


def made(
    file: TomlFile, where: Place, function: Callable[..., Made], table: Mapping[str, Any]
) -> Made | None:
    """Call a function with a table that has been checked; note why that cannot be done."""
    try:
        return function(**table)
    except AssemblyError as problem:
        for words in problem.faults:
            file.fault(_key_in(words, where, table), words)
    except StudyError as problem:
        for words in problem.faults:
            file.fault(_key_in(words, where, table), words)
    except (RockframeError, TypeError, ValueError) as problem:
        file.fault(_key_in(str(problem), where, table), str(problem))
    return None


def _wanted(one: Declared[Any, Any] | None) -> str:
    if one is None:
        return ""
    if one.measure is None:
        return f" ({one.words.rstrip('.')})"
    example = one.measure.example if one.unit == "1" else f'"{one.measure.example}"'
    return f" ({one.words.rstrip('.')}); write for example {one.name} = {example}"


def _key_in(words: str, where: Place, table: Mapping[str, Any]) -> Place:
    """Give the place of the first key of a table that a message names; else of the table."""
    found = {name: re.search(rf"\b{re.escape(name)}\b", words) for name in table}
    starts = {name: match.start() for name, match in found.items() if match is not None}
    return (*where, min(starts, key=lambda name: starts[name])) if starts else where
