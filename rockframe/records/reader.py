"""Interface of readers: a file as bytes and lines, the request of the caller, the record."""

import hashlib
import math
import warnings
from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Final, Protocol, TypeAlias

from rockframe.errors import RecordError, SchemaError
from rockframe.records.unit_names import RecordUnit, acceleration_unit, other_quantity
from rockframe.signals import Motion
from rockframe.signals.arrays import Array

Metadata: TypeAlias = dict[str, str | float | int]

# These limits and MAXIMUM_BYTES bound time and memory: no file takes more than about a second
# or 200 MB, whatever its contents.
MAXIMUM_TEXT: Final = 16 * 2**20
"""Largest file that is read as text [byte]."""
MAXIMUM_LINES: Final = 350_000
"""Most lines of a text."""
MAXIMUM_LINE: Final = 2**20
"""Longest line of a text [character]."""
MAXIMUM_SAMPLES: Final = 300_000
"""Most samples of one component."""
HEADER_WIDTH: Final = 400
"""Number of characters of a header line that are searched."""

_SHOWN: Final = 60
_RECORD: Final = "a ground-motion record as text"
_MARKUP: Final = ("<!doctype", "<html", "<head", "<?xml", "<body", "<!--")
_STATION_XML: Final = "<FDSNStationXML"
_TEXT_CONTROLS: Final = frozenset("\t\n\r\f\v\x1a")
_START: Final = 4096
_MAX_TEXT_LENGTH: Final = 600


@dataclass(frozen=True)
class Source:
    r"""A record file: its bytes, and, if it is text, its lines.

    Parameters
    ----------
    path : str
        Path as given, for messages; for a packed file, with its name inside.
    data : bytes
        All bytes of the file, unpacked.
    sha256 : str
        Digest of the bytes.

    Examples
    --------
    >>> import hashlib
    >>> from rockframe.records import Source
    >>> data = b"SIMPLE" + bytes([10]) + b"0.1"
    >>> source = Source("a.sim", data, hashlib.sha256(data).hexdigest())
    >>> source.lines, source.top(1), source.suffix
    (('SIMPLE', '0.1'), ['SIMPLE'], '.sim')
    >>> source.refuse(found="no unit", expected="one in the header", line=1)
    RecordError('a.sim, line 1: found no unit; expected one in the header')
    """

    path: str
    data: bytes = field(repr=False)
    sha256: str

    @cached_property
    def lines(self) -> tuple[str, ...]:
        """Lines without line ends; the last one is empty if the file ends with a line end.

        Raises
        ------
        RecordError
            The file is empty, binary, markup, or too long to be a record.
        """
        return _lines(self)

    def top(self, count: int, first: int = 0) -> list[str]:
        """Return lines of a header, cut to `HEADER_WIDTH` characters.

        Parameters
        ----------
        count : int
            Number of lines.
        first : int, optional
            Index of the first line, from 0.

        Returns
        -------
        list of str
        """
        return [line[:HEADER_WIDTH] for line in self.lines[first : first + count]]

    @property
    def start(self) -> str:
        """The first lines, for messages."""
        return "\n".join(self.top(20))

    @property
    def suffix(self) -> str:
        """Extension in lower case, with its dot."""
        return Path(self.path).suffix.lower()

    @property
    def last_line(self) -> int:
        """Number of the last line that is not blank, from 1."""
        count = len(self.lines)
        while count > 1 and not self.lines[count - 1].strip():
            count -= 1
        return count

    def refuse(self, *, found: str, expected: str, line: int | None = None) -> RecordError:
        """Build the error for a fault in this file.

        Parameters
        ----------
        found, expected : str
            Contents of the file at the fault, and the contents that were expected.
        line : int, optional
            Line number from 1; at most that of the last line.

        Returns
        -------
        RecordError
            The caller raises it.
        """
        lines = self.__dict__.get("lines")  # present after their first use
        if line is not None and lines is not None:
            # a header may announce lines beyond the end of the file
            line = min(max(line, 1), len(lines))
        found = found if len(found) <= _MAX_TEXT_LENGTH else f"{found[:_MAX_TEXT_LENGTH]}..."
        return RecordError(self.path, found=found, expected=expected, line=line)


@dataclass(frozen=True)
class Request:
    """Arguments of the caller for a reader, already checked.

    Parameters
    ----------
    unit : RecordUnit, optional
        Unit of the samples.
    unit_name : str, optional
        Its name as the caller spelt it.
    time_step : float, optional
        Time step [s].
    component : str, optional
        Component to read.
    vertical : str, optional
        Component to read with it, as the vertical one.
    response : str, optional
        File with the response of the instrument.
    every : bool
        Whether all components are requested; an `EveryComponentError` returns them.

    Examples
    --------
    >>> Request(component="N").component
    'N'
    """

    unit: RecordUnit | None = None
    unit_name: str | None = None
    time_step: float | None = None
    component: str | None = None
    vertical: str | None = None
    response: str | None = None
    every: bool = False


@dataclass(frozen=True)
class Record:
    """A record as read: one component, optionally with the vertical one.

    Parameters
    ----------
    time_step : float
        Time step [s].
    samples : ndarray, shape (n,)
        Samples in `unit`.
    unit : RecordUnit
        Unit of the samples.
    metadata : dict
        Contents of the header.
    history : tuple of str
        Sentences about the reading.
    warnings : tuple of str
        Contradictions in the file that do not prevent its reading.
    vertical : ndarray, shape (n,), optional
        Vertical component, upwards, in `unit`.

    Examples
    --------
    >>> from rockframe.records import Request, Source, choose_unit
    >>> source = Source("a.sim", b"SIMPLE", "")
    >>> unit, name, warnings = choose_unit(source, Request(), "gal", None)
    >>> Record(0.01, [0.0, 2.0, -1.0], unit, {"unit_as_read": name}).metadata
    {'unit_as_read': 'gal'}
    """

    time_step: float
    samples: Array
    unit: RecordUnit
    metadata: Metadata
    history: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    vertical: Array | None = None


@dataclass(frozen=True)
class StoredMotion:
    """A motion that this package has stored, read without loss."""

    si: Motion  # the motion in SI units
    name: str | None  # name of the motion
    metadata: Metadata  # metadata as written
    history: tuple[str, ...]
    recipe: Mapping[str, Any] | None  # constructor and arguments of an analytic motion


class Reader(Protocol):
    """Interface of a reader: a module or any other object with these names.

    Attributes
    ----------
    NAME : str
        Value of the argument ``format``: small letters, digits and hyphens.
    TITLE : str
        Description of the format in words.
    SUFFIXES : tuple of str
        Usual extensions, in small letters, with their dot.

    Examples
    --------
    >>> from rockframe.records import Record, Request, Source, choose_unit
    >>> class Simple:
    ...     NAME, TITLE, SUFFIXES = "simple", "file of the simple format", (".sim",)
    ...
    ...     def recognises(self, source):
    ...         return source.lines[0] == "SIMPLE"
    ...
    ...     def read(self, source, request):
    ...         unit, _, _ = choose_unit(source, request, "gal", None)
    ...         return Record(0.01, [float(line) for line in source.lines[1:]], unit, {})
    >>> source = Source("a.sim", bytes([10]).join([b"SIMPLE", b"0", b"2"]), "")
    >>> Simple().recognises(source), Simple().read(source, Request()).samples
    (True, [0.0, 2.0])
    """

    NAME: str
    TITLE: str
    SUFFIXES: tuple[str, ...]

    def recognises(self, source: Source, /) -> bool:
        """Tell whether a file looks like this format."""
        ...

    def read(self, source: Source, request: Request, /) -> Record:
        """Read the record, or raise the error that ``source.refuse`` builds."""
        ...


@dataclass(frozen=True)
class Format:
    """A file format of records.

    Parameters
    ----------
    name : str
        Value of the argument ``format``.
    title : str
        Description in words.
    suffixes : tuple of str
        Usual extensions.
    recognises : callable
        Function that tells whether a file looks like this format.
    read : callable
        Function that reads a file.
    binary : bool
        Whether it reads bytes (``source.data``) instead of lines.
    own : bool
        Whether it is part of this package.
    holds, unit : str
        Number of components in a file, and source of the unit of its samples, in words.

    Examples
    --------
    >>> from rockframe.motion import formats
    >>> peer = formats()[0]
    >>> peer.name, peer.suffixes
    ('peer-at2', ('.at2',))
    """

    name: str
    title: str
    suffixes: tuple[str, ...]
    recognises: Callable[[Source], bool] = field(repr=False)
    read: Callable[[Source, Request], Record | StoredMotion] = field(repr=False)
    binary: bool = field(default=False, repr=False)
    own: bool = field(default=True, repr=False)
    holds: str = field(default="", repr=False)
    unit: str = field(default="", repr=False)


def source_of(name: str, data: bytes) -> Source:
    """Make a source from bytes, with their name and digest."""
    return Source(path=name, data=data, sha256=hashlib.sha256(data).hexdigest())


def wrong_beginning_error(source: Source, expected: str) -> RecordError:
    """Build the error for a binary file with another beginning."""
    return source.refuse(found=f"a file that begins with {source.data[:8]!r}", expected=expected)


@contextmanager
def damaged_file_errors(source: Source, kind: str, expected: str) -> Generator[None]:
    """Convert exceptions of a library to the error of a damaged file; ignore its warnings."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except (RecordError, SchemaError):
        raise
    except Exception as problem:
        # damaged files raise exceptions that are not documented
        found = f"{kind} that cannot be read ({type(problem).__name__})"
        raise source.refuse(found=found, expected=expected) from problem


def base_name(path: str) -> str:
    """Return the file name of a path with slashes or backslashes."""
    return path.replace("\\", "/").rstrip("/").rsplit("/", 1)[-1]


def quoted_first_line(text: str) -> str:
    """Quote the first line of a text, shortened, for a message."""
    line = text.strip().split("\n", 1)[0].strip()
    return repr(line if len(line) <= _SHOWN else line[:_SHOWN] + "...")


def check_size(name: str, size: int, limit: int) -> None:
    """Refuse a file that is larger than any record."""
    if size > limit:
        found = f"{size / 2**20:.3g} MiB"
        raise RecordError(name, found=found, expected=f"a record of at most {limit // 2**20} MiB")


def _lines(source: Source) -> tuple[str, ...]:
    data, name = source.data, source.path
    if b"\x00" in data:
        kind = "UTF-16 text" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "binary data"
        raise RecordError(name, found=kind, expected=f"{_RECORD} (ASCII or UTF-8)")
    check_size(name, len(data), MAXIMUM_TEXT)
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    count = data.count(b"\n")
    if count > MAXIMUM_LINES:
        expected = f"a record of at most {MAXIMUM_LINES} lines"
        raise RecordError(name, found=f"{count} lines", expected=expected)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    del data
    start = text[:_START]
    controls = sum(not c.isprintable() and c not in _TEXT_CONTROLS for c in start)
    if controls > 0.02 * len(start):
        raise RecordError(name, found="binary data", expected=_RECORD)
    _check_text(text, start, source)
    lines = tuple(text.rstrip("\x1a").split("\n"))
    longest = max(map(len, lines))
    if longest > MAXIMUM_LINE:
        line = next(k for k, text in enumerate(lines, start=1) if len(text) == longest)
        found = f"{longest} characters in one line"
        expected = f"lines of at most {MAXIMUM_LINE} characters"
        raise source.refuse(found=found, expected=expected, line=line)
    return lines


def _check_text(text: str, start: str, source: Source) -> None:
    if not text.strip("\x1a").strip():
        raise source.refuse(found="an empty file", expected=_RECORD)
    shown_start = start.lstrip()
    if not shown_start.lower().startswith(_MARKUP):
        return
    line = 1 + start.count("\n", 0, start.index(shown_start[0]))
    if _STATION_XML in shown_start:
        found = "StationXML, which describes an instrument and holds no motion"
        expected = "the miniSEED file itself; give this one as the argument response"
        raise source.refuse(found=found, expected=expected, line=line)
    found = f"a web page or other markup, {quoted_first_line(shown_start)}"
    expected = f"{_RECORD}; was an error page downloaded?"
    raise source.refuse(found=found, expected=expected, line=line)


def choose_unit(
    source: Source, request: Request, name: str | None, line: int | None
) -> tuple[RecordUnit, str, list[str]]:
    """Choose the unit of the samples from the file and the ``unit=`` argument.

    Parameters
    ----------
    source : Source
        File.
    request : Request
        Arguments of the caller.
    name : str or None
        Unit in the file, if any.
    line : int or None
        Its line number, from 1.

    Returns
    -------
    tuple of RecordUnit, str, list of str
        Unit, its name as read, warnings.

    Raises
    ------
    RecordError
        The unit of the file is unknown or not an acceleration, or there is none.

    Examples
    --------
    >>> from rockframe.records import Request, Source
    >>> unit, name, warnings = choose_unit(Source("a.sim", b"SIMPLE", ""), Request(), "gal", None)
    >>> unit.factor, name, warnings
    (0.01, 'gal', [])
    """
    stated = None if name is None else acceleration_unit(name)
    if name is not None and stated is None:
        quantity = other_quantity(name)
        if quantity is not None:
            raise source.refuse(
                found=f"{quantity} in {name}", expected="an acceleration", line=line
            )
    if request.unit is not None and request.unit_name is not None:
        warnings: list[str] = []
        if stated is not None and not math.isclose(stated.factor, request.unit.factor):
            where = source.path if line is None else f"{source.path}, line {line}"
            warnings.append(
                f"{where}: the unit of the file is {name!r}, but "
                f"unit={request.unit_name!r} was requested and is used"
            )
        return request.unit, request.unit_name, warnings
    if name is None:
        raise source.refuse(
            found="no unit of the samples",
            expected="a unit in the header, or the argument unit, for example unit='g'",
        )
    if stated is None:
        expected = "an acceleration unit such as g, gal, cm/s^2 or m/s^2 (or the argument unit)"
        raise source.refuse(found=f"the unknown unit {name!r}", expected=expected, line=line)
    return stated, name, []
