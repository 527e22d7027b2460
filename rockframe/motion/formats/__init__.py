"""Record formats: one module per format, listed here."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from rockframe.errors import ComponentError
from rockframe.motion.formats import peer_at2, text
from rockframe.motion.formats.checks import check_time_step, plausibility
from rockframe.motion.formats.foreign import foreign_format
from rockframe.motion.formats.source import (
    Metadata,
    PathLike,
    Record,
    Request,
    Source,
    load,
    shown,
)
from rockframe.motion.samples import MotionSI


@dataclass(frozen=True)
class Format:
    """A file format that records can be read from.

    Parameters
    ----------
    name : str
        What the argument ``format`` takes.
    title : str
        In words.
    suffixes : tuple of str
        Usual extensions.
    recognises : callable
        Whether a file looks like this format.
    read : callable
        The reader.
    """

    name: str
    title: str
    suffixes: tuple[str, ...]
    recognises: Callable[[Source], bool]
    read: Callable[[Source, Request], Record]


_FORMATS: Final = tuple(
    Format(module.NAME, module.TITLE, module.SUFFIXES, module.recognises, module.read)
    for module in (peer_at2, text)  # text takes what no other format recognises: last
)


@dataclass(frozen=True)
class Reading:
    """A record that was read, converted and checked.

    Parameters
    ----------
    si : MotionSI
        In SI units.
    metadata : dict
        What the file says about itself, and which file it was.
    history : tuple of str
        One sentence.
    warnings : tuple of str
        To be issued by the caller.
    """

    si: MotionSI
    metadata: Metadata
    history: tuple[str, ...]
    warnings: tuple[str, ...]


def formats() -> dict[str, str]:
    """List the formats that records can be read from.

    Returns
    -------
    dict
        Name, as the argument ``format`` takes it, and description.
    """
    return {entry.name: entry.title for entry in _FORMATS}


def read_record(path: PathLike, format_name: str | None, request: Request) -> Reading:
    """Read a record file.

    Parameters
    ----------
    path : str or path-like
        File.
    format_name : str or None
        A name of :func:`formats`; recognised from the file if None.
    request : Request
        What the caller asked for.

    Returns
    -------
    Reading

    Raises
    ------
    RecordError
        The file cannot be read as a ground-motion record.
    ComponentError
        No such format.
    """
    chosen = None if format_name is None else _by_name(str(format_name))
    source = load(path)
    entry = chosen or _recognised(source)
    record = entry.read(source, request)
    check_time_step(source, record.time_step, None)
    with np.errstate(over="ignore"):
        acceleration = record.samples * record.unit.factor
    if not np.isfinite(acceleration).all():
        raise source.refuse(found="accelerations that overflow", expected="finite accelerations")
    si = MotionSI(time_step=record.time_step, acceleration=acceleration)
    base = _base_name(source.path)
    metadata = {
        **record.metadata,
        "format": entry.name,
        "source_file": base,
        "source_sha256": source.sha256,
    }
    step = (
        f"read {base} ({entry.title}, unit {record.metadata.get('unit_as_read', '')}): "
        f"{record.samples.size} samples at {record.time_step!r} s"
    )
    usual = plausibility(source, record.time_step, record.samples, record.unit)
    return Reading(si, metadata, (step, *record.history), (*record.warnings, *usual))


def _by_name(name: str) -> Format:
    for entry in _FORMATS:
        if entry.name == name.casefold().replace("_", "-"):
            return entry
    known = ", ".join(repr(entry.name) for entry in _FORMATS)
    msg = f"GroundMotion.read: format must be one of {known}, got {name!r}"
    raise ComponentError(msg)


def _recognised(source: Source) -> Format:
    known = "; ".join(entry.title for entry in _FORMATS)
    foreign = foreign_format(source)
    if foreign is not None:
        expected = f"one of the formats that can be read: {known}"
        raise source.refuse(found=foreign, expected=expected, line=1)
    for entry in _FORMATS:
        if entry.recognises(source):
            return entry
    raise source.refuse(
        found=f"{shown(source.text)}, which no format recognises", expected=known, line=1
    )


def _base_name(path: str) -> str:
    return path.replace("\\", "/").rstrip("/").rsplit("/", 1)[-1]
