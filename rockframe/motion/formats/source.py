"""A record file as text with line numbers, and what every reader hands back."""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeAlias

from rockframe.errors import RecordError

if TYPE_CHECKING:
    from rockframe.motion.samples import Array
    from rockframe.motion.unit_names import RecordUnit

Metadata: TypeAlias = "dict[str, str | float | int]"
PathLike: TypeAlias = "str | os.PathLike[str]"

MAXIMUM_BYTES: Final = 512 * 2**20
_SHOWN: Final = 60
_RECORD: Final = "a ground-motion record as text"
_MARKUP: Final = ("<!doctype", "<html", "<head", "<?xml", "<body", "<!--")
_TEXT_CONTROLS: Final = frozenset("\t\n\r\f\v\x1a")


@dataclass(frozen=True)
class Source:
    r"""The text of a record file.

    Parameters
    ----------
    path : str
        As given, for messages.
    text : str
        Without byte-order mark, line ends as ``\n``.
    sha256 : str
        Of the bytes of the file.
    """

    path: str
    text: str
    sha256: str
    lines: tuple[str, ...] = field(repr=False)

    @property
    def suffix(self) -> str:
        """Extension in lower case, with its dot."""
        return Path(self.path).suffix.lower()

    def refuse(self, *, found: str, expected: str, line: int | None = None) -> RecordError:
        """Build the error for something found in this file.

        Parameters
        ----------
        found, expected : str
            What stands there, and what should.
        line : int, optional
            Counted from 1.

        Returns
        -------
        RecordError
            To be raised.
        """
        return RecordError(self.path, found=found, expected=expected, line=line)


@dataclass(frozen=True)
class Request:
    """What the caller asked of a reader, already checked.

    Parameters
    ----------
    unit : RecordUnit, optional
        Unit of the samples.
    unit_name : str, optional
        As the caller spelt it.
    time_step : float, optional
        [s]
    component : str, optional
        Component to read.
    """

    unit: RecordUnit | None = None
    unit_name: str | None = None
    time_step: float | None = None
    component: str | None = None


@dataclass(frozen=True)
class Record:
    """One component of a record, as read.

    Parameters
    ----------
    time_step : float
        [s]
    samples : ndarray, shape (n,)
        In `unit`.
    unit : RecordUnit
        Unit of the samples.
    metadata : dict
        What the file says about itself.
    history : tuple of str
        Sentences about the reading.
    warnings : tuple of str
        What disagrees, but not so that the file had to be refused.
    """

    time_step: float
    samples: Array
    unit: RecordUnit
    metadata: Metadata
    history: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()


def load(path: PathLike) -> Source:
    """Read a file as text, or refuse it.

    Parameters
    ----------
    path : str or path-like
        File.

    Returns
    -------
    Source

    Raises
    ------
    RecordError
        Missing, a directory, not readable, empty, too large, binary or markup.
    """
    name = str(path)
    data = _bytes(path, name)
    text = _decoded(data, name)
    source = Source(
        path=name,
        text=text,
        sha256=hashlib.sha256(data).hexdigest(),
        lines=tuple(text.split("\n")),
    )
    start = text[:4096].lstrip()
    if not text.strip():
        raise source.refuse(found="an empty file", expected=_RECORD)
    if start.lower().startswith(_MARKUP):
        line = 1 + text.count("\n", 0, text.index(start[0]))
        found = f"a web page or other markup, {shown(start)}"
        raise source.refuse(
            found=found, expected=f"{_RECORD}; was an error page downloaded?", line=line
        )
    return source


def shown(text: str) -> str:
    """Quote the first line of a text, shortened, for a message."""
    line = text.strip().split("\n", 1)[0].strip()
    return repr(line if len(line) <= _SHOWN else line[:_SHOWN] + "...")


def _bytes(path: PathLike, name: str) -> bytes:
    try:
        place = Path(path)
        if place.is_dir():
            raise RecordError(name, found="a directory", expected="a record file")
        if place.exists() and not place.is_file():
            raise RecordError(name, found="no ordinary file", expected="a record file")
        size = place.stat().st_size
        if size > MAXIMUM_BYTES:
            raise RecordError(
                name,
                found=f"{size / 2**20:.0f} MiB",
                expected=f"a record of at most {MAXIMUM_BYTES // 2**20} MiB",
            )
        return place.read_bytes()
    except FileNotFoundError as problem:
        raise RecordError(name, found="no such file", expected="a record file") from problem
    except OSError as problem:
        found = f"a file that cannot be read ({problem.strerror})"
        raise RecordError(name, found=found, expected="a readable record file") from problem
    except (TypeError, ValueError) as problem:
        if isinstance(problem, RecordError):
            raise
        found = f"{path!r}, which names no file"
        raise RecordError(name, found=found, expected="the path of a record file") from problem


def _decoded(data: bytes, name: str) -> str:
    if b"\x00" in data:
        kind = "UTF-16 text" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "binary data"
        raise RecordError(name, found=kind, expected=f"{_RECORD} (ASCII or UTF-8)")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    start = text[:4096]
    controls = sum(not c.isprintable() and c not in _TEXT_CONTROLS for c in start)
    if controls > 0.02 * len(start):
        raise RecordError(name, found="binary data", expected=_RECORD)
    return text.replace("\r\n", "\n").replace("\r", "\n").rstrip("\x1a")
