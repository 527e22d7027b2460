"""The table that comes with a download of the PEER ground-motion database."""

import csv
import math
import re
from typing import TYPE_CHECKING, Final, TypeAlias

from rockframe.errors import RecordError

if TYPE_CHECKING:
    from rockframe.records.source import Source

Known: TypeAlias = "dict[str, str | float | int]"

_MARK: Final = b"PEER Ground Motion Database"
_START: Final = 4096
_FIRST: Final = "Result ID"
_KILOMETRE: Final = 1000.0
_NUMBERS: Final = {
    # head of the column without its unit, name in the metadata, factor to SI units
    "record sequence number": ("record_sequence_number", 1.0),
    "year": ("year", 1.0),
    "magnitude": ("magnitude", 1.0),
    "rjb": ("joyner_boore_distance", _KILOMETRE),
    "rrup": ("rupture_distance", _KILOMETRE),
    "vs30": ("shear_wave_velocity_30", 1.0),
    "lowest useable frequency": ("lowest_usable_frequency", 1.0),
    "lowest usable frequency": ("lowest_usable_frequency", 1.0),
    "tp-pulse period": ("stated_pulse_period", 1.0),
}
_TEXTS: Final = {
    "earthquake name": "event",
    "station name": "station",
    "mechanism": "mechanism",
}
_FILES: Final = {
    "horizontal-1 acc. filename": "H1",
    "horizontal-2 acc. filename": "H2",
    "vertical acc. filename": "V",
}
_WHOLE: Final = ("record_sequence_number", "year")
_MOST_ROWS: Final = 10_000
_UNIT: Final = re.compile(r"\s*\([^)]*\)\s*$")


def is_peer_table(data: bytes) -> bool:
    """Tell whether a file begins as ``_SearchResults.csv`` does."""
    return _MARK in data[:_START]


def read_peer_table(source: "Source") -> dict[str, Known]:
    """Read what the table tells of each file."""
    lines = source.lines
    first = next((k for k, line in enumerate(lines) if line.startswith(_FIRST)), None)
    if first is None:
        raise source.refuse(
            found=f"no line that begins with {_FIRST!r}",
            expected="the table of a PEER download with its summary of records",
        )
    end = next((k for k in range(first, len(lines)) if not lines[k].strip()), len(lines))
    try:
        rows = list(csv.reader(lines[first : min(end, first + _MOST_ROWS)], skipinitialspace=True))
    except csv.Error as problem:
        found = f"a table that cannot be read ({problem})"
        expected = "fields between commas"
        raise source.refuse(found=found, expected=expected, line=first + 1) from problem
    heads = [_UNIT.sub("", head).strip().casefold() for head in rows[0]]
    if not any(head in _FILES for head in heads):
        found = "no column with the names of files"
        expected = "columns such as 'Horizontal-1 Acc. Filename'"
        raise source.refuse(found=found, expected=expected, line=first + 1)
    known: dict[str, Known] = {}
    for place, row in enumerate(rows[1:], start=first + 2):
        if len(row) < len(heads):
            found = f"{len(row)} fields"
            raise source.refuse(found=found, expected=f"{len(heads)}", line=place)
        fields = dict(zip(heads, (field.strip() for field in row), strict=False))
        about = _about(fields, source, place)
        for head, axis in _FILES.items():
            name = _filled(fields.get(head, ""))
            if name:
                known[name] = {**about, "axis": axis}
    return known


def _about(fields: dict[str, str], source: "Source", line: int) -> Known:
    about: Known = {name: fields[head] for head, name in _TEXTS.items() if fields.get(head)}
    for head, (name, factor) in _NUMBERS.items():
        text = _filled(fields.get(head, ""))
        if not text:
            continue
        value = _number(text, source, line, head) * factor
        if value == -999.0 * factor:  # what the databases write for unknown
            continue
        about[name] = int(value) if name in _WHOLE else value
    return about


def _filled(text: str) -> str:
    """Give a field, empty where it holds only strokes."""
    return text if text.strip("- ") else ""


def _number(text: str, source: "Source", line: int, head: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        problem: RecordError = source.refuse(
            found=f"{text[:40]!r} in the column {head!r}", expected="a number", line=line
        )
        raise problem
    return value
