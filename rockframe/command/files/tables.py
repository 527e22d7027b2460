"""TOML files whose faults are collected with their lines, and calls of functions with a table.

Hints of messages, which are in the notation of Python, are rewritten in that of a file.
"""

import re
import tomllib
from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Callable, Iterable, Iterator, Mapping
from inspect import Parameter, signature
from itertools import takewhile
from pathlib import Path
from typing import Any, Final, Self, TypeAlias, TypeVar, cast

import pandas as pd

from rockframe.command.streams import STANDARD_INPUT_NAME, STREAM, StandardInput
from rockframe.components.parameters import Declared
from rockframe.components.registry import registered_classes
from rockframe.errors import (
    AssemblyError,
    FileError,
    RockframeError,
    RockframeWarning,
    StudyError,
    did_you_mean,
    short_repr,
    warn,
)
from rockframe.results.variables.studies import MOTION
from rockframe.system.parts import default_class, slot_of_class

KeyPath: TypeAlias = tuple[str | int, ...]
"""Keys from the outermost table inwards; a number counts the tables of an array."""

_TOKEN: Final = re.compile(
    r'"""(?:\\.|[^\\])*?"""'
    r"|'''.*?'''"
    r'|"(?:\\.|[^"\\\n])*"'
    r"|'[^'\n]*'"
    r"|\#[^\n]*"
    r"|.",
    re.DOTALL,
)
"""A text in quotation marks, a comment, or a single character."""


def lines_of(text: str) -> dict[KeyPath, int]:
    """Return the lines of tables and keys."""
    lines: dict[KeyPath, int] = {}
    arrays: dict[KeyPath, int] = {}
    table: KeyPath = ()
    for line, statement in _statements(text):
        if statement.startswith("["):
            names, several = _nested_keys(tomllib.loads(statement)), statement.startswith("[[")
            table = _with_array_numbers(names[:-1], arrays) + names[-1:]
            if several:
                arrays[table] = arrays.get(table, -1) + 1
                lines.setdefault(table, line)
                table = (*table, arrays[table])
            lines[table] = line
        else:
            pieces = (match[0] for match in _TOKEN.finditer(statement))
            key = "".join(takewhile(lambda piece: piece != "=", pieces))
            names = _nested_keys(tomllib.loads(f"{key} = 0"))
            for depth in range(1, len(names) + 1):
                lines.setdefault(table + names[:depth], line)
    return lines


def _statements(text: str) -> Iterator[tuple[int, str]]:
    """Cut a file into headers and assignments, without comments, each with its line."""
    line, begun, depth, statement = 1, 1, 0, ""
    for match in _TOKEN.finditer(text + "\n"):
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


def _nested_keys(nested: Any) -> KeyPath:
    """Return the keys of nested tables that have one key each."""
    names: list[str] = []
    while isinstance(nested, dict | list) and nested:
        if isinstance(nested, list):
            nested = nested[0]
            continue
        name, nested = next(iter(nested.items()))
        names.append(name)
    return tuple(names)


def _with_array_numbers(names: KeyPath, arrays: dict[KeyPath, int]) -> KeyPath:
    """Return a path with numbers of tables in arrays: a header refers to the last one so far."""
    place: KeyPath = ()
    for name in names:
        place = (*place, name)
        if place in arrays:
            place = (*place, arrays[place])
    return place


_TOML_POSITION: Final = re.compile(r"\s*\(at line (\d+), column \d+\)")
_CONTROL: Final = re.compile(r"[\x00-\x08\x0e-\x1f\ufffd]")
"""Characters that do not occur in text."""
_NOT_TEXT: Final = (
    "this is no text; expected a scene or a study in TOML, as 'rockframe template' prints it. "
    "Results (.nc) are for 'rockframe plot' and for 'rockframe report', which certifies them"
)


class TomlFile:
    """The contents of a file, and the faults found so far."""

    def __init__(self, path: Path, values: Mapping[str, Any], lines: Mapping[KeyPath, int]) -> None:
        self.path = path
        self.values = dict(values)
        self._lines = lines
        self._faults: list[tuple[int | None, str]] = []
        self.files: list[Path] = [path]
        """This file, and those that were read because it names them."""

    @classmethod
    def read(cls, path: str | Path) -> Self:
        """Read a file."""
        place, data = _read_bytes(path)
        text = _decoded_text(str(place), data)
        try:
            values = tomllib.loads(text)
        except tomllib.TOMLDecodeError as problem:
            match = _TOML_POSITION.search(str(problem))
            line = int(match[1]) if match else None
            words = f"this is no TOML: {_TOML_POSITION.sub('', str(problem))}"
            hint = '; write text in quotation marks, as in width = "1 m"'
            raise FileError(str(place), [(line, words + hint)]) from problem
        return cls(place, values, lines_of(text))

    def path_relative_to(self, name: str) -> Path:
        """Return the path of a file to be read, named relative to the folder of this file."""
        self.files.append(self.path_of(name))
        return self.files[-1]

    def path_of(self, name: str) -> Path:
        """Return the path of a name in this file, relative to its folder."""
        return self.path.parent / Path(name).expanduser()

    def add_fault(self, where: KeyPath, words: str) -> None:
        """Note a fault, with the line of a place or else of the table around it."""
        depths = range(len(where), 0, -1)
        lines = [self._lines[where[:depth]] for depth in depths if where[:depth] in self._lines]
        self._faults.append((lines[0] if lines else None, in_toml(words)))

    @property
    def is_valid(self) -> bool:
        """Whether no fault has been found."""
        return not self._faults

    def error(self) -> FileError:
        """Return the error with all faults, in the order of their lines."""
        return FileError(str(self.path), sorted(self._faults, key=lambda fault: fault[0] or 0))

    def table(self, where: KeyPath, argument: object) -> dict[str, Any] | None:
        """Return a value that must be a table, or note a fault."""
        if isinstance(argument, dict):
            return {str(name): value for name, value in argument.items()}
        self.add_fault(
            where,
            f"{where[-1]} must be a table, [{table_title(where)}] with its keys below it, "
            f"got {short_repr(argument)}",
        )
        return None

    def add_unknown_key(
        self, where: KeyPath, name: str, known: Iterable[str], hint: str = ""
    ) -> None:
        """Note an unknown key, and the one that may have been meant."""
        known = list(known)
        if hint:
            self.add_fault((*where, name), f"unknown key {name!r}: {hint}")
            return
        meant = did_you_mean(name, known) or ";"
        inside = f"[{table_title(where)}] takes" if where else "there are"
        self.add_fault((*where, name), f"unknown key {name!r}{meant} {inside} {', '.join(known)}")


def _read_bytes(path: str | Path) -> tuple[Path, bytes]:
    """Read a file, or the standard input, whose folder is the current one."""
    if str(path) == STREAM:
        return Path(STANDARD_INPUT_NAME), StandardInput.read_for("a scene").getvalue()
    try:
        place = Path(path).expanduser()
        return place, place.read_bytes()
    except FileNotFoundError as problem:
        raise FileError(str(path), "there is no such file") from problem
    except IsADirectoryError as problem:
        words = "this is a folder; expected the file of a scene or a study"
        raise FileError(str(path), words) from problem
    except (OSError, ValueError, RuntimeError) as problem:  # also names that no file can have
        raise FileError(str(path), f"it cannot be read ({problem})") from problem


def _decoded_text(name: str, data: bytes) -> str:
    r"""Read the text of a file in any usual encoding, with ``\n`` at the end of lines."""
    try:
        marked = data.startswith((BOM_UTF16_LE, BOM_UTF16_BE))
        text = data.decode("utf-16" if marked else "utf-8-sig")
    except UnicodeDecodeError as problem:
        text = data.decode("cp1252", "replace")
        if _CONTROL.search(text):
            raise FileError(name, _NOT_TEXT) from problem
        line = data[: problem.start].count(b"\n") + 1
        sign = data[problem.start : problem.start + 1].decode("cp1252", "replace")
        words = (
            f"{name}, line {line}: found {sign!r} in the old encoding of Windows (Latin-1), in "
            "which the whole file is read; save it as UTF-8, the encoding of TOML"
        )
        warn(words, RockframeWarning)
    return text.replace("\r\n", "\n")


def read_columns(path: str | Path) -> pd.DataFrame:
    """Read a table in CSV whose rows have as many values as heads; OSError, ValueError."""
    # motions stay text, since the names 01 and 1 differ
    table = pd.read_csv(path, comment="#", skipinitialspace=True, dtype={MOTION: str})
    if not isinstance(table.index, pd.RangeIndex):  # pandas takes superfluous values as labels
        count = len(table.columns)
        msg = f"its rows have {count + table.index.nlevels} values, but there are {count} heads"
        raise ValueError(msg)
    return table


def table_title(where: KeyPath) -> str:
    """Name a table as in its header."""
    return ".".join(name for name in where if isinstance(name, str))


Result = TypeVar("Result")


def arguments_of(function: Callable[..., Any], *, without: tuple[str, ...] = ()) -> dict[str, bool]:
    """Return the arguments that a function takes by name, and whether each must be given."""
    named = (Parameter.POSITIONAL_OR_KEYWORD, Parameter.KEYWORD_ONLY)
    return {
        name: parameter.default is Parameter.empty
        for name, parameter in signature(function).parameters.items()
        if parameter.kind in named and name not in ("self", *without)
    }


def check_table(
    file: TomlFile,
    where: KeyPath,
    table: Mapping[str, Any],
    known: Mapping[str, bool],
    declared: Mapping[str, Declared[Any, Any, Any]] | None = None,
    hints: Mapping[str, str] | None = None,
) -> bool:
    """Note unknown keys, missing keys and values that cannot be read; false if there are any."""
    sound = True
    declared = declared or {}
    for name in table:
        if name not in known:
            file.add_unknown_key(where, name, known, (hints or {}).get(name, ""))
            sound = False
    for name, required in known.items():
        if required and name not in table:
            note = _missing_key_note(declared.get(name))
            file.add_fault(where, f"[{table_title(where)}] lacks {name!r}{note}")
            sound = False
    for name, value in table.items():
        if name in known and name in declared:
            try:
                declared[name].accept(value, f"[{table_title(where)}]")
            except RockframeError as problem:
                file.add_fault((*where, name), str(problem))
                sound = False
    return sound


def call_with_table(
    file: TomlFile, where: KeyPath, function: Callable[..., Result], table: Mapping[str, Any]
) -> Result | None:
    """Call a function with a checked table, or note why this fails."""
    try:
        return function(**table)
    except (AssemblyError, StudyError) as problem:
        for words in problem.faults:
            file.add_fault(key_in_message(words, where, table), words)
    except (RockframeError, TypeError, ValueError) as problem:
        file.add_fault(key_in_message(str(problem), where, table), str(problem))
    return None


def _missing_key_note(field: Declared[Any, Any, Any] | None) -> str:
    if field is None:
        return ""
    if field.measure is None:
        return f" ({field.words.rstrip('.')})"
    example = field.measure.example if field.unit == "1" else f'"{field.measure.example}"'
    return f" ({field.words.rstrip('.')}); write for example {field.name} = {example}"


def key_in_message(words: str, where: KeyPath, table: Mapping[str, Any]) -> KeyPath:
    """Return the place of the first key of a table that a message names, else of the table."""
    matches = {name: re.search(rf"\b{re.escape(name)}\b", words) for name in table}
    starts = {name: match.start() for name, match in matches.items() if match is not None}
    if starts:
        first = min(starts, key=lambda name: starts[name])
        return _innermost_key(words, (*where, first), table[first])
    for name, inner in table.items():
        place = _innermost_key(words, (*where, name), inner)
        if len(place) > len(where) + 1:
            return place
    return where


def _innermost_key(words: str, where: KeyPath, inner: object) -> KeyPath:
    """Follow the keys of inner tables that a message has in quotation marks, to the innermost."""
    if not isinstance(inner, dict):
        return where
    table = cast("dict[str, object]", inner)
    named = [name for name in table if repr(name) in words]
    if not named:
        return where
    first = min(named, key=lambda name: words.index(repr(name)))
    return _innermost_key(words, (*where, first), table[first])


_TEXT: Final = r"(?:'[^']*'|\"[^\"]*\")"
_TUPLE: Final = re.compile(rf"(?<!\w)\((?P<values>{_TEXT}(?:, {_TEXT})+)\)")
_VALUE: Final = re.compile(rf"\b(?P<name>[a-z]\w*)=(?P<value>{_TEXT}|\[)")
_CALL: Final = re.compile(r"\b(?:an? )?(?P<kind>[A-Z]\w+)(?:\.(?P<way>\w+))?\((?P<values>[^()]*)\)")
_GIVEN: Final = re.compile(rf"\b(?P<name>[a-z]\w*) ?= ?(?P<value>{_TEXT}|\[[^\]]*\]|[^,\s]+)")
_OPERATION: Final = re.compile(r"simulate\(motion\.(?P<name>\w+)\((?P<value>[\d.]+)\)\)")
_OBJECTS: Final = {"InitialState": "initial", "Accuracy": "accuracy"}
"""Keys of the run whose values are tables, by the class of the objects."""
_ONE_FILE_EACH: Final = "no file of a study varies it: write a scene for each of its values"
_SYSTEM: Final = {"System": "system"}


def in_toml(words: str) -> str:
    """Rewrite arguments, points, parts and operations in a message as a file has them."""
    from rockframe.studies.sweeps.scenes import FUNCTION_ADVICE, IN_AXES  # where there is a message

    words = words.replace(FUNCTION_ADVICE, _ONE_FILE_EACH).replace(IN_AXES, "")
    words = _OPERATION.sub(
        r"operations = [{ \g<name> = { factor = \g<value> } }] in [motion]", words
    )
    words = _TUPLE.sub(lambda match: f"[{_quoted(match['values'])}]", words)
    words = _VALUE.sub(lambda match: f"{match['name']} = {_quoted(match['value'])}", words)
    return _CALL.sub(_rewritten_call, words)


def _quoted(text: str) -> str:
    return text.replace("'", '"')


def _rewritten_call(call: re.Match[str]) -> str:
    """Rewrite a call of the class of a part, of a system, or of an object of the run."""
    kind = call["kind"]
    given = [f"{match['name']} = {match['value']}" for match in _GIVEN.finditer(call["values"])]
    if kind in _OBJECTS:
        return f"{_OBJECTS[kind]} = {{ {', '.join(given) or '...'} }}"
    slot = _SYSTEM.get(kind)
    if kind in registered_classes():
        slot = slot_of_class(registered_classes()[kind])
    if slot is None:
        return call[0]
    if call["way"] is not None:
        given.insert(0, f'constructor = "{call["way"]}"')
    if kind in registered_classes() and default_class(slot).__name__ != kind:
        given.insert(0, f'type = "{kind}"')
    return f"[{slot}] with {', '.join(given)}" if given else f"[{slot}]"
