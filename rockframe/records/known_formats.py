"""The list of formats, and functions to add formats."""

import re
from typing import Any, Final, cast

from rockframe.arguments import call_signature
from rockframe.errors import ComponentError, RecordError, did_you_mean, short_repr
from rockframe.records.asdf import ASDF
from rockframe.records.cosmos import COSMOS
from rockframe.records.csmip import CSMIP
from rockframe.records.cwa import CWA
from rockframe.records.keyed import AFAD, CSMNC, ESM, RESORCE
from rockframe.records.knet import KNET
from rockframe.records.miniseed import MINISEED
from rockframe.records.netcdf import NETCDF
from rockframe.records.peer import PEER_AT2
from rockframe.records.reader import Format, Reader, Source, quoted_first_line
from rockframe.records.sac import SAC
from rockframe.records.smc import SMC
from rockframe.records.text import TEXT
from rockframe.records.unam import UNAM
from rockframe.records.volumes import BHRC, GEONET

_NAME: Final = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
_SUFFIX: Final = re.compile(r"\.[a-z0-9]+")
_OWNER: Final = "rockframe.motion.register"

# tried in this order; text accepts any column of numbers, so it is last
_BUILT_IN: Final = (
    *(PEER_AT2, COSMOS, CSMIP, SMC, ESM, KNET, GEONET, CWA),
    *(AFAD, BHRC, CSMNC, RESORCE, UNAM),
    *(ASDF, NETCDF, MINISEED, SAC),
)
WITH_RESPONSE: Final = (MINISEED.name, SAC.name, ASDF.name)
"""Formats that may have counts, which the response of the instrument converts to accelerations."""
_registered: list[Format] = []


def formats() -> tuple[Format, ...]:
    """List the formats of records that can be read.

    Returns
    -------
    tuple of Format
        Formats in the order in which they are tried, each with its ``name`` for the argument
        ``format``, its ``title`` and its ``suffixes``.

    Examples
    --------
    >>> [entry.name for entry in formats()][:3]
    ['peer-at2', 'cosmos', 'csmip']
    """
    return (*_BUILT_IN, *_registered, TEXT)


def register(reader: Reader) -> None:
    """Add a format, so that ``GroundMotion.read`` can read it.

    It is tried after the formats of this package and before plain text. If its ``read`` raises an
    exception that is not of this package, or does not return a record, a `RecordError` is raised.

    Parameters
    ----------
    reader : Reader
        Module or object with ``NAME``, ``TITLE``, ``SUFFIXES``,
        ``recognises(source)`` and ``read(source, request)``; with
        ``BINARY = True`` if it reads ``source.data``, not ``source.lines``.

    Raises
    ------
    ComponentError
        One of these is missing or wrong (the message lists all faults), or the name is in use.

    Examples
    --------
    >>> from rockframe.records import Record, choose_unit
    >>> class Simple:
    ...     NAME = "simple"
    ...     TITLE = "file of the simple format"
    ...     SUFFIXES = (".sim",)
    ...
    ...     @staticmethod
    ...     def recognises(source):
    ...         return source.lines[0] == "SIMPLE"
    ...
    ...     @staticmethod
    ...     def read(source, request):
    ...         unit, name, warnings = choose_unit(source, request, "gal", None)
    ...         samples = [float(line) for line in source.lines[1:] if line]
    ...         return Record(0.01, samples, unit, {"unit_as_read": name})
    >>> register(Simple)
    >>> "simple" in [entry.name for entry in formats()]
    True
    >>> unregister("simple")
    """
    faults = _faults(reader)
    if faults:
        msg = f"{_OWNER}: {'; '.join(faults)}"
        raise ComponentError(msg)
    if reader.NAME in {entry.name for entry in formats()}:
        msg = f"{_OWNER}: the format {reader.NAME!r} exists already; unregister it or rename yours"
        raise ComponentError(msg)
    binary = bool(getattr(reader, "BINARY", False))
    functions = reader.recognises, reader.read
    _registered.append(
        Format(reader.NAME, reader.TITLE, reader.SUFFIXES, *functions, binary=binary, own=False)
    )


def unregister(name: str) -> None:
    """Remove a format that was added with :func:`register`.

    Parameters
    ----------
    name : str
        Name of the format.

    Raises
    ------
    ComponentError
        No format of that name was added.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> reader = SimpleNamespace(
    ...     NAME="mine",
    ...     TITLE="file of mine",
    ...     SUFFIXES=(".my",),
    ...     recognises=lambda source: source.lines[0] == "MINE",
    ...     read=lambda source, request: None,
    ... )
    >>> register(reader)
    >>> unregister("mine")
    >>> "mine" in [entry.name for entry in formats()]
    False
    """
    for entry in _registered:
        if entry.name == name:
            _registered.remove(entry)
            return
    known = ", ".join(repr(entry.name) for entry in _registered) or "none"
    msg = f"{_OWNER}: no added format is called {name!r} (added: {known})"
    raise ComponentError(msg)


def format_by_name(name: str) -> Format:
    """Find a format by its name; the error lists all names."""
    normalised = name.casefold().replace("_", "-") if isinstance(cast("Any", name), str) else ""
    for entry in formats():
        if entry.name == normalised:
            return entry
    names = [entry.name for entry in formats()]
    known, near = ", ".join(map(repr, names)), did_you_mean(name, names)
    msg = f"the format of a record must be one of {known}, got {short_repr(name)}{near}"
    raise ComponentError(msg)


def recognised_format(source: Source) -> Format:
    """Find the format of a file from its content."""
    known = formats()
    for entry in known:
        if entry.binary and _looks_like(source, entry):
            return entry
    top = quoted_first_line(source.start)  # raises an error if the file is not text
    for entry in known:
        if not entry.binary and _looks_like(source, entry):
            return entry
    titles = "; ".join(entry.title for entry in known)
    raise source.refuse(found=f"{top}, which no format recognises", expected=titles, line=1)


def _looks_like(source: Source, entry: Format) -> bool:
    if entry.own:
        return entry.recognises(source)
    try:
        return bool(entry.recognises(source))
    except RecordError:
        raise
    except Exception as problem:
        raise added_reader_error(source, entry, problem) from problem


def added_reader_error(source: Source, entry: Format, problem: Exception) -> RecordError:
    """Build the error for an exception in an added reader."""
    found = f"a failure of the added reader {entry.name!r} ({type(problem).__name__}: {problem})"
    return source.refuse(found=found, expected=entry.title)


def _faults(reader: object) -> list[str]:
    faults: list[str] = []
    name = getattr(reader, "NAME", None)
    if not (isinstance(name, str) and _NAME.fullmatch(name)):
        faults.append(f"NAME must be small letters, digits and hyphens, got {name!r}")
    title = getattr(reader, "TITLE", None)
    if not (isinstance(title, str) and title.strip() and title.isprintable()):
        faults.append(f"TITLE must be one line of words, got {title!r}")
    suffixes = getattr(reader, "SUFFIXES", None)
    listed = cast("tuple[object, ...]", suffixes) if isinstance(suffixes, tuple) else None
    if listed is None or not all(isinstance(s, str) and _SUFFIX.fullmatch(s) for s in listed):
        faults.append(f"SUFFIXES must be a tuple such as ('.abc',), got {suffixes!r}")
    for method, arguments in (("recognises", ("source",)), ("read", ("source", "request"))):
        call = getattr(reader, method, None)
        expected = f"{method} must be a function of {' and '.join(arguments)}"
        if not callable(call):
            faults.append(f"{expected}, got {call!r}")
            continue
        try:
            call_signature(call).bind(*arguments)
        except TypeError:
            faults.append(f"{expected}, got the arguments {call_signature(call)}")
        except ValueError:  # a built-in without a signature; the call will show
            continue
    if not isinstance(getattr(reader, "BINARY", False), bool):
        faults.append("BINARY must be True or False")
    return faults
