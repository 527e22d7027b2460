"""A TOML file with what is wrong in it, each fault with its line."""

import re
import tomllib
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Final, Self

from rockframe.command.files.lines import Place, lines_of
from rockframe.errors import FileError, shown

_WHERE: Final = re.compile(r"\s*\(at line (\d+), column \d+\)")
_NO_TEXT: Final = (
    "this is no text; expected a scene or a study in TOML, as 'rockframe template' prints it. "
    "Results (.nc) are for 'rockframe plot' and for 'rockframe report', which certifies them"
)


class TomlFile:
    """What stands in a file, and the faults found so far."""

    def __init__(self, path: Path, values: Mapping[str, Any], lines: Mapping[Place, int]) -> None:
        self.path = path
        self.values = dict(values)
        self._lines = lines
        self._faults: list[tuple[int | None, str]] = []
        self.files: list[Path] = [path]
        """This one, and those that were read because they are named in it."""

    @classmethod
    def read(cls, path: str | Path) -> Self:
        """Read a file."""
        place = Path(path).expanduser()
        try:
            text = place.read_text(encoding="utf-8")
        except FileNotFoundError as problem:
            raise FileError(str(path), [(None, "there is no such file")]) from problem
        except UnicodeDecodeError as problem:
            raise FileError(str(path), [(None, _NO_TEXT)]) from problem
        except (OSError, ValueError) as problem:  # or a name that no file can have
            raise FileError(str(path), [(None, f"it cannot be read ({problem})")]) from problem
        # TOML ends lines by \n or \r\n, which read_text makes alike
        try:
            values = tomllib.loads(text)
        except tomllib.TOMLDecodeError as problem:
            found = _WHERE.search(str(problem))
            line = int(found[1]) if found else None
            words = f"this is no TOML: {_WHERE.sub('', str(problem))}"
            hint = '; a text stands in quotation marks, as in width = "1 m"'
            raise FileError(str(path), [(line, words + hint)]) from problem
        return cls(place, values, lines_of(text))

    def beside(self, name: str) -> Path:
        """Give the path of a file to be read, which is named relative to the folder of this one."""
        self.files.append(self.path_of(name))
        return self.files[-1]

    def path_of(self, name: str) -> Path:
        """Give a path that is named in this file, relative to its folder."""
        return self.path.parent / Path(name).expanduser()

    def fault(self, where: Place, words: str) -> None:
        """Note what is wrong, at the line of a place or of the table around it."""
        depths = range(len(where), 0, -1)
        lines = [self._lines[where[:depth]] for depth in depths if where[:depth] in self._lines]
        self._faults.append((lines[0] if lines else None, words))

    @property
    def sound(self) -> bool:
        """Whether no fault has been found."""
        return not self._faults

    def check(self) -> None:
        """Refuse the file if a fault has been found."""
        if self._faults:
            ordered = sorted(self._faults, key=lambda fault: fault[0] or 0)
            raise FileError(str(self.path), ordered)

    def table(self, where: Place, given: object) -> dict[str, Any] | None:
        """Give a value that must be a table, or note that it is none."""
        if isinstance(given, dict):
            return {str(name): value for name, value in given.items()}  # pyright: ignore[reportUnknownVariableType]
        self.fault(
            where,
            f"{where[-1]} must be a table, [{table_title(where)}] with its keys below it, "
            f"got {shown(given)}",
        )
        return None

    def unknown(self, where: Place, name: str, known: Iterable[str], hint: str = "") -> None:
        """Note a key that means nothing, and which one may have been meant."""
        known = list(known)
        if hint:
            self.fault((*where, name), f"unknown key {name!r}: {hint}")
            return
        near = get_close_matches(name.casefold(), known, n=1, cutoff=0.6)
        meant = f"; was {near[0]!r} meant?" if near else ";"
        inside = f"[{table_title(where)}] takes" if where else "there are"
        self.fault((*where, name), f"unknown key {name!r}{meant} {inside} {', '.join(known)}")


def table_title(where: Place) -> str:
    """Name a table as its header does."""
    return ".".join(name for name in where if isinstance(name, str))
