"""The standard streams: instead of files, coloured messages and a progress bar."""

import os
import shutil
import sys
from io import BytesIO
from pathlib import Path
from time import monotonic
from typing import IO, Final

from rockframe.errors import FileError

STREAM: Final = "-"
"""Typed instead of the name of a file for the standard input or output."""
STANDARD_INPUT_NAME: Final = "standard input"
"""Name of the standard input in messages."""

_COLOURS: Final = {"error": "1;31", "warning": "33", "label": "1"}
_CLEAR_LINE: Final = "\r\x1b[K"
_DELAY: Final = 1.0
"""Time before a bar is shown [s]."""
_UPDATE_INTERVAL: Final = 0.1
"""Shortest time between two updates of the bar [s]."""


class StandardInput(BytesIO):
    """The contents of the standard input, as an open file with a name."""

    name = STANDARD_INPUT_NAME
    read_as = ""
    """What was read from the standard input, which can be read only once."""

    @classmethod
    def read_for(cls, content: str) -> "StandardInput":
        """Read the whole standard input."""
        if cls.read_as:
            words = (
                f"{cls.read_as} is read from it already, and {content} cannot be too; name a file "
                "for one of them"
            )
            raise FileError(STANDARD_INPUT_NAME, words)
        if sys.stdin is None or sys.stdin.closed:
            raise FileError(
                STANDARD_INPUT_NAME, f"it is closed; name the file of {content} instead of '-'"
            )
        cls.read_as = content
        return cls(sys.stdin.buffer.read())

    def __repr__(self) -> str:
        return self.name


def open_input(path: str, content: str) -> "str | IO[bytes]":
    """Return a path, or the standard input where it is ``-``."""
    return StandardInput.read_for(content) if path == STREAM else path


def replace_closed_streams() -> None:
    """Write nowhere instead of to closed streams: messages would go to the other stream or a file.

    Python prints to the standard output where there is no standard error, and the next file that
    is opened has the number of the closed stream, to which libraries write.
    """
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            nowhere = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115 - kept open
            setattr(sys, name, nowhere)


def print_message(program: str, words: str, kind: str = "error") -> None:
    """Write a message to the standard error, after the name of the command."""
    # without colours if the user wants none, https://no-color.org
    plain = os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb"
    head = f"{program}:"
    if not plain and is_terminal(sys.stderr):
        head = f"\x1b[{_COLOURS[kind]}m{head}\x1b[0m"
    print(f"{head} {words}", file=sys.stderr)


def is_terminal(stream: object) -> bool:
    """Whether a stream is a terminal."""
    try:
        return bool(stream.isatty())  # type: ignore[attr-defined]
    except (AttributeError, ValueError):  # there is none, or it is closed
        return False


class TerminalProgressBar:
    """Progress in one line of the standard error, if that is a terminal."""

    def __init__(self, what: str, *, enabled: bool) -> None:
        self._shown = enabled and is_terminal(sys.stderr) and os.environ.get("TERM") != "dumb"
        self._what, self._part = what, ""
        self._total = self._done = 0
        self._started, self._last = monotonic(), 0.0

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
        if self._shown and now - self._started > _DELAY and now - self._last > _UPDATE_INTERVAL:
            self._last = now
            share = 100.0 * self._done / max(self._total, 1)
            words = (
                f"{self._what}{self._part}: {self._done} of {self._total} runs ({share:.0f} %), "
                f"{now - self._started:.0f} s"
            )
            width = shutil.get_terminal_size().columns
            print(f"{_CLEAR_LINE}{words[: width - 1]}", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        """Clear the line."""
        if self._last > 0.0:
            print(_CLEAR_LINE, end="", file=sys.stderr, flush=True)
