"""The standard streams: instead of files, coloured messages and a progress bar."""

import os
import shutil
import sys
from collections.abc import Generator
from contextlib import contextmanager
from io import BytesIO
from time import monotonic
from typing import IO, Final

from rockframe.errors import FileError

STREAM: Final = "-"
"""Typed instead of the name of a file for the standard input or output."""
INPUT: Final = "standard input"
"""Name of the standard input in messages."""

_COLOURS: Final = {"error": "1;31", "warning": "33", "label": "1"}
_CLEAR: Final = "\r\x1b[K"
_DELAY: Final = 1.0
"""Time before a bar is shown [s]."""
_BETWEEN: Final = 0.1
"""Shortest time between two updates of the bar [s]."""


class StandardInput(BytesIO):
    """The contents of the standard input, as an open file with a name."""

    name = INPUT
    taken_by = ""
    """What was read from the standard input, which can be read only once."""

    @classmethod
    def read_for(cls, what: str) -> "StandardInput":
        """Read the whole standard input."""
        if cls.taken_by:
            words = (
                f"{cls.taken_by} is read from it already, and {what} cannot be too; name a file "
                "for one of them"
            )
            raise FileError(INPUT, words)
        if sys.stdin is None or sys.stdin.closed:
            raise FileError(INPUT, f"it is closed; name the file of {what} instead of '-'")
        cls.taken_by = what
        return cls(sys.stdin.buffer.read())

    def __repr__(self) -> str:
        return self.name


def opened(path: str, what: str) -> "str | IO[bytes]":
    """Return a path, or the standard input where it is ``-``."""
    return StandardInput.read_for(what) if path == STREAM else path


def tell(who: str, words: str, kind: str = "error") -> None:
    """Write a message to the standard error, after the name of the command."""
    # without colours if the user wants none, https://no-color.org
    plain = os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb"
    head = f"{who}:"
    if not plain and is_terminal(sys.stderr):
        head = f"\x1b[{_COLOURS[kind]}m{head}\x1b[0m"
    print(f"{head} {words}", file=sys.stderr)


def is_terminal(stream: object) -> bool:
    """Whether a stream is a terminal."""
    try:
        return bool(stream.isatty())  # type: ignore[attr-defined]
    except (AttributeError, ValueError):  # there is none, or it is closed
        return False


class Bar:
    """Progress in one line of the standard error, if that is a terminal."""

    def __init__(self, what: str, *, wanted: bool) -> None:
        self._shown = wanted and is_terminal(sys.stderr) and os.environ.get("TERM") != "dumb"
        self._what, self._part = what, ""
        self._total = self._done = 0
        self._begun, self._last = monotonic(), 0.0

    def name(self, part: str) -> None:
        """Set the name of the part that comes next."""
        self._part = f", {part}"

    def expect(self, count: int, done: int = 0) -> None:
        """Add cases to the total, some of which may be done already."""
        self._total += count
        self._done += done

    def update(self, count: int) -> None:
        """Add finished cases, and show the bar."""
        self._done += count
        now = monotonic()
        if self._shown and now - self._begun > _DELAY and now - self._last > _BETWEEN:
            self._last = now
            share = 100.0 * self._done / max(self._total, 1)
            words = (
                f"{self._what}{self._part}: {self._done} of {self._total} runs ({share:.0f} %), "
                f"{now - self._begun:.0f} s"
            )
            width = shutil.get_terminal_size().columns
            print(f"{_CLEAR}{words[: width - 1]}", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        """Clear the line."""
        if self._last > 0.0:
            print(_CLEAR, end="", file=sys.stderr, flush=True)


@contextmanager
def bar_for(what: str, *, quiet: bool) -> Generator[Bar]:
    """Show a progress bar during an analysis."""
    bar = Bar(what, wanted=not quiet)
    try:
        yield bar
    finally:
        bar.close()
