"""The answer of a command: lines of text, or JSON for programs."""

import json
import math
import re
import sys
from collections.abc import Mapping
from textwrap import wrap
from typing import TYPE_CHECKING, Any, Final

from rockframe.command.streams import STREAM, is_terminal
from rockframe.errors import FileError
from rockframe.version import __version__

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

_LABEL_WIDTH: Final = 9
"""Width of the label at the head of a line [characters]."""
_MAX_ROWS: Final = 40
"""Largest number of rows of a table that is printed."""
_MAX_WIDTH: Final = 100
"""Widest table that is printed in one piece, in characters."""
_TITLE_WIDTH: Final = 14
"""Width of the heads of its columns where it is wider."""
_INPUT, _RESULT, _FILE = "input", "result", "file"
"""What a line of text is about: --quiet omits input and files, an error the input."""
_HISTORY_DIMS: Final = {"time", "event", "sample_after_end"}
"""Dimensions of histories, which only the files of results hold."""

_TEXT_ENDINGS: Final = ("at2", "csv", "html", "svg")
"""Files with these endings are text, which a terminal shows."""


class Answer:
    """The answer of a command, kept until all of its files are written."""

    def __init__(self, command: str, *, quiet: bool, verbose: bool, as_json: bool) -> None:
        self.quiet, self.as_json = quiet, as_json
        self._verbose = verbose
        self._lines: list[tuple[str, str]] = []  # what a line is about: _INPUT, _RESULT, _FILE
        self._fields: dict[str, Any] = {"command": command, "version": __version__}
        self._numbers: dict[str, Any] = {}
        self._files: dict[str, list[str]] = {}
        self._warnings: list[str] = []
        self._is_stdout_reserved = False
        self.data: bytes | None = None
        """Contents of a file that goes to the standard output."""

    def add_context(self, label: str, words: str) -> None:
        """Add a line on the input, such as the scene; --quiet omits it."""
        self._add(label, words, _INPUT)

    def add_result(self, label: str, words: str) -> None:
        """Add a line on the result."""
        self._add(label, words, _RESULT)

    def add_text(self, words: str, **named: Any) -> None:
        """Add lines of text as they are; JSON has the named values instead."""
        self._lines.append((_RESULT, words))
        self._fields |= {name: _json_value(value) for name, value in named.items()}

    def add_table(self, values: Any) -> None:
        """Add a table of pandas, unless it is long."""
        if len(values) <= _MAX_ROWS:
            self.add_text(format_table(values))

    def add_numbers(self, dataset: "xr.Dataset") -> None:
        """Add the numbers of a result with their units: all variables but histories."""
        self._numbers |= {
            str(name): _json_variable(variable)
            for name, variable in dataset.variables.items()
            if not _HISTORY_DIMS & {*variable.dims}
        }

    def add_file(self, title: str, path: object) -> None:
        """Report a file that was written."""
        self._lines.append((_FILE, f"{title}: {path}"))
        self._files.setdefault(title.lower(), []).append(str(path))

    def reserve_stdout(self, ending: str) -> None:
        """Raise an error if a file with this ending cannot go to the standard output."""
        if self.as_json or self._is_stdout_reserved:
            occupant = "the answer in JSON" if self.as_json else "another file"
            words = f"{occupant} goes to the standard output already; name a file instead of '-'"
            raise FileError(STREAM, words)
        if is_terminal(sys.stdout) and ending.lower().strip(".") not in _TEXT_ENDINGS:
            words = "the standard output is a terminal, which shows no such file; name one"
            raise FileError(STREAM, words)
        self._is_stdout_reserved = True

    def add_warning(self, words: str) -> None:
        """Keep a warning for JSON."""
        self._warnings.append(words)

    def as_text(self, error: str = "") -> str:
        """Return the lines of text; after an error without those on the input."""
        omitted = (_INPUT, _FILE) if self.quiet else (_INPUT,) if error else ()
        lines = [words for about, words in self._lines if about not in omitted]
        if self._verbose:
            lines += [
                f"  {name}: {_format_number(number)}"
                for name, number in self._numbers.items()
                if "dims" not in number and number["value"] is not None
            ]
        return "".join(f"{line}\n" for line in lines)

    def as_json_text(self, code: int, error: str = "") -> str:
        """Return the answer as a JSON object."""
        files = {
            title: paths[0] if len(paths) == 1 else paths for title, paths in self._files.items()
        }
        optional: dict[str, Any] = {
            "numbers": self._numbers, "files": files, "warnings": self._warnings, "error": error,
        }  # fmt: skip
        present = {name: value for name, value in optional.items() if value}
        fields = {**self._fields, **present, "exit_code": code}
        return json.dumps(fields, indent=2, ensure_ascii=False, allow_nan=False) + "\n"

    def _add(self, label: str, words: str, about: str) -> None:
        self._lines.append((about, f"{f'{label}:'.ljust(_LABEL_WIDTH - 1)} {words}"))
        self._fields[label.lower().replace(" ", "_")] = words


def format_table(values: "pd.DataFrame") -> str:
    """Write a table with four digits; of a wide one the last columns follow below the first."""
    options: Any = {"float_format": lambda value: f"{value:.4g}"}
    text = values.to_string(**options)
    if max(map(len, text.splitlines()), default=0) <= _MAX_WIDTH:
        return text
    titles = [_title_lines(str(column)) for column in values]
    depth = max(map(len, titles))
    lines = [tuple([""] * (depth - len(title)) + title) for title in titles]
    wrapped = values.set_axis(type(values)(lines).set_index([*range(depth)]).index, axis=1)
    wrapped = wrapped.rename_axis(columns=[None] * depth)
    text = wrapped.to_string(**options, line_width=_MAX_WIDTH, sparsify=False)
    lines_kept = (line.rstrip().removesuffix("\\").rstrip() for line in text.splitlines())
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines_kept)).strip("\n")


def _title_lines(title: str) -> list[str]:
    """Divide the head of a column into short lines, the last of which is its unit."""
    name, bracket, unit = title.partition(" [")
    lines = wrap(name.replace("_", " "), _TITLE_WIDTH, break_long_words=False)
    return [*lines, f"[{unit}"] if bracket else lines


def _json_variable(variable: "xr.Variable") -> dict[str, Any]:
    """Return a value with its unit and, of an array, its dimensions."""
    import numpy as np

    values = np.asarray(variable)
    entry: dict[str, Any] = {"value": _json_value(_flag_words(values, variable.attrs))}
    if "units" in variable.attrs:
        entry["unit"] = str(variable.attrs["units"])
    if values.ndim:
        entry["dims"] = [str(dim) for dim in variable.dims]
    return entry


def _flag_words(values: Any, attributes: Mapping[str, Any]) -> Any:
    """Replace flags by their meanings, and flags of truth by true and false."""
    import numpy as np

    from rockframe.results.variables.variable import TRUTH, flag_words

    words: dict[Any, str | bool] = {**flag_words(attributes)}
    if not words:
        return values
    if (*words.values(),) == TRUTH:
        words = {value: word == TRUTH[1] for value, word in words.items()}
    return np.vectorize(words.get, otypes=[object])(values)


def _json_value(value: Any) -> Any:
    """Return a value in the types of JSON; NaN and infinity become null."""
    if hasattr(value, "tolist"):  # of numpy
        value = value.tolist()
    if isinstance(value, list | tuple):
        return [_json_value(item) for item in value]
    if isinstance(value, Mapping):
        return {str(name): _json_value(item) for name, item in value.items()}
    if isinstance(value, float):
        return value + 0.0 if math.isfinite(value) else None  # no negative zero
    return value if isinstance(value, str | int | bool | None) else str(value)


def _format_number(entry: Mapping[str, Any]) -> str:
    value, unit = entry["value"], entry.get("unit", "1")
    number = f"{value:.6g}" if isinstance(value, float) else str(value)
    return number if unit == "1" else f"{number} {unit}"
