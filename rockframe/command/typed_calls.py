"""Calls of functions that were typed as a name and arguments NAME=VALUE."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from shlex import split
from typing import Any, Final, TypeVar

from rockframe.codes import CodeCheck, asce_7_22, circolare_2019
from rockframe.command.files.tables import arguments_of, read_columns
from rockframe.errors import ComponentError, FileError, did_you_mean
from rockframe.suites import TargetSpectrum

Made = TypeVar("Made")
CODES: Final[Mapping[str, Callable[..., CodeCheck]]] = {
    "circolare_2019": circolare_2019,
    "asce_7_22": asce_7_22,
}
_SPECTRA: Final = {"eurocode_8": TargetSpectrum.eurocode_8, "asce_7": TargetSpectrum.asce_7}
_COLUMN_TITLE: Final = re.compile(r"\s*(period|acceleration)\s*\[(.+)\]\s*")
_EXPECTED_COLUMNS: Final = (
    "columns 'period [s]' and 'acceleration [g_0]', with units in their heads"
)


def values_by_name(words: Iterable[str], option: str, example: str) -> dict[str, str]:
    """Read words of the form NAME=VALUE."""
    pairs = [word.partition("=") for word in words]
    for name, _, value in pairs:
        if not (name and value):
            msg = f"{option}: expected NAME=VALUE, such as {example}, got {name!r}"
            raise ComponentError(msg)
    names = [name for name, _, _ in pairs]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        msg = f"{option}: found {twice} twice; expected it once"
        raise ComponentError(msg)
    return {name: value for name, _, value in pairs}


def call_typed(
    functions: Mapping[str, Callable[..., Made]], words: Sequence[str], option: str, *before: object
) -> Made:
    """Call a function by its name, with the arguments `before` and then those that were typed."""
    function, value = parse_call(functions, words, option, len(before))
    return function(*before, **value)


def parse_call(
    functions: Mapping[str, Callable[..., Made]], words: Sequence[str], option: str, before: int
) -> tuple[Callable[..., Made], dict[str, Any]]:
    """Read a function and its typed arguments, which follow `before` others."""
    name, *typed = words
    if name not in functions:
        known = ", ".join(functions)
        msg = f"{option}: there is no {name!r}; known are {known}{did_you_mean(name, functions)}"
        raise ComponentError(msg)
    function = functions[name]
    first = tuple(arguments_of(function))[:before]
    known = arguments_of(function, without=first)
    value = values_by_name(typed, option, f"{next(iter(known))}=...")
    unknown = [key for key in value if key not in known]
    missing = [key for key, needed in known.items() if needed and key not in value]
    if unknown or missing:
        fault = f"needs {missing[0]}=..." if missing else ""
        if unknown:
            fault = f"has no {unknown[0]!r}{did_you_mean(unknown[0], known)}"
        msg = f"{option}: {name} {fault}; it takes {', '.join(known)}"
        raise ComponentError(msg)
    return function, {key: parse_value(text) for key, text in value.items()}


def parse_check(text: str, option: str) -> list[str]:
    """Split a check in a file into words as typed with --check, and raise if it is none."""
    words = split(text)
    if not words:
        msg = f"{option}: found an empty check; expected such as 'circolare_2019'"
        raise ComponentError(msg)
    parse_call(CODES, words, option, 2)  # the scene and its motions
    return words


def target_from(words: Sequence[str], option: str) -> TargetSpectrum:
    """Make the target spectrum that was typed: by a code, or from a table in a file."""
    if words[0].lower().endswith(".csv"):
        columns = _read_spectrum(words[0])
        named = [*words, f"name={Path(words[0]).stem}"]
        return call_typed({words[0]: TargetSpectrum.from_table}, named, option, *columns)
    return call_typed(_SPECTRA, words, option)


def _read_spectrum(path: str) -> tuple[tuple[Any, str], tuple[Any, str]]:
    """Read the periods and accelerations of a table, with their units."""
    columns: dict[str, tuple[Any, str]] = {}
    try:
        frame = read_columns(Path(path).expanduser())
        for head in frame.columns:
            match = _COLUMN_TITLE.fullmatch(str(head))
            if match is not None:
                columns[match[1]] = (frame[head].to_numpy(float), match[2])
    except (OSError, ValueError) as problem:
        words = f"the table cannot be read ({problem}); expected {_EXPECTED_COLUMNS}"
        raise FileError(path, words) from problem
    if len(columns) != 2:
        heads = ", ".join(map(str, frame.columns))
        raise FileError(path, [(1, f"found the columns {heads}; expected {_EXPECTED_COLUMNS}")])
    return columns["period"], columns["acceleration"]


def parse_value(text: str) -> float | str:
    """Read a pure number; a quantity with a unit, or a word, remains text."""
    try:
        return float(text)
    except ValueError:
        return text
