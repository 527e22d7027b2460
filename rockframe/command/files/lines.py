"""On which line of a TOML file a key stands; the parser of the standard library does not tell."""

import re
import tomllib
from collections.abc import Iterator
from typing import Any, Final, TypeAlias

Place: TypeAlias = tuple[str | int, ...]
"""Keys from the outermost table inwards; a number counts the tables of an array."""

_PIECE: Final = re.compile(
    r'"""(?:\\.|[^\\])*?"""'
    r"|'''.*?'''"
    r'|"(?:\\.|[^"\\\n])*"'
    r"|'[^'\n]*'"
    r"|\#[^\n]*"
    r"|.",
    re.DOTALL,
)
"""A text, a comment, or a letter."""


def lines_of(text: str) -> dict[Place, int]:
    """Give the lines of tables and keys."""
    found: dict[Place, int] = {}
    arrays: dict[Place, int] = {}
    table: Place = ()
    for line, statement in _statements(text):
        if statement.startswith("["):
            names, several = _header(statement)
            table = _resolved(names[:-1], arrays) + names[-1:]
            if several:
                arrays[table] = arrays.get(table, -1) + 1
                found.setdefault(table, line)
                table = (*table, arrays[table])
            found[table] = line
        else:
            key = _until_equals(statement)
            names = _names(tomllib.loads(f"{key} = 0"))
            for depth in range(1, len(names) + 1):
                found.setdefault(table + names[:depth], line)
    return found


def _statements(text: str) -> Iterator[tuple[int, str]]:
    """Cut a file into headers and assignments, without comments, each with its line."""
    line, begun, depth, statement = 1, 1, 0, ""
    for match in _PIECE.finditer(text + "\n"):
        piece = match[0]
        if piece == "\n" and depth == 0:
            if statement.strip():
                yield begun, statement.strip()
            statement = ""
        elif not piece.startswith("#"):
            if not statement.strip() and piece.strip():
                begun = line
            statement += piece
            depth += (piece in "[{") - (piece in "]}")
        line += piece.count("\n")


def _header(statement: str) -> tuple[Place, bool]:
    several = statement.startswith("[[")
    return _names(tomllib.loads(statement)), several


def _names(nested: Any) -> Place:
    """Give the keys of tables of which each holds one."""
    names: list[str] = []
    while isinstance(nested, dict | list) and nested:
        if isinstance(nested, list):
            nested = nested[0]
            continue
        name, nested = next(iter(nested.items()))
        names.append(name)
    return tuple(names)


def _resolved(names: Place, arrays: dict[Place, int]) -> Place:
    """Give a path with the numbers of tables in arrays: a header speaks of the last one so far."""
    place: Place = ()
    for name in names:
        place = (*place, name)
        if place in arrays:
            place = (*place, arrays[place])
    return place


def _until_equals(statement: str) -> str:
    key = ""
    for match in _PIECE.finditer(statement):
        if match[0] == "=":
            break
        key += match[0]
    return key
