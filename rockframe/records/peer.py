"""Files of PEER: accelerations (AT2), and the table of a download.

An AT2 file has four header lines, then numbers in free format. The line with the number of points
has several forms::

    4096    0.0100    NPTS, DT                  NGA-West1
    NPTS=  18000, DT= .00500 SEC                strong-motion database
    NPTS=   7999, DT=   .0050 SEC,              NGA-West2
    NPTS=3930,DT=.005                           no blanks, also dt= in lower case

Some files have marks around header and data: ``*** Begin data ***`` above that line, and
``*** End Data ***`` below the last number.
"""

import csv
import math
import re
from pathlib import PurePath
from typing import Final, TypeAlias

from rockframe.records.checks import checked_time_step, make_record
from rockframe.records.components import (
    UNKNOWN,
    FileComponent,
    Orientation,
    choose_component,
    orientation_of,
)
from rockframe.records.headers import first_match
from rockframe.records.numbers import (
    NUMBER,
    WHOLE_NUMBER,
    all_numbers,
    integer_or_none,
    with_exponent_e,
)
from rockframe.records.reader import (
    Format,
    Metadata,
    Record,
    Request,
    Source,
    choose_unit,
    quoted_first_line,
)
from rockframe.records.unit_names import SLASHED, STATED_UNIT

_SUFFIX: Final = ".at2"

HEADER_LINES: Final = 20
_POINTS: Final = re.compile(r"NPTS\s*[=:]\s*([-+]?[\d.]+)", re.IGNORECASE)
# a text on records may quote such a line, as this one does
_POINTS_LINE: Final = re.compile(rf"[\s#%*]*{_POINTS.pattern}", re.IGNORECASE)
# neither a fraction nor milliseconds are read as so many seconds
_STEP: Final = re.compile(rf"\bDT\s*[=:]\s*{WHOLE_NUMBER}(?!\s*(?:/|m(?:illi)?s))", re.IGNORECASE)
_WEST1: Final = re.compile(rf"^\s*([-+]?\d+)\s+({NUMBER})\s+NPTS\b", re.IGNORECASE)
_UNIT: Final = re.compile(rf"{STATED_UNIT}\(?\s*([^\s(),;]+{SLASHED})", re.IGNORECASE)
_OTHER_KIND: Final = re.compile(r"\b(VELOCITY|DISPLACEMENT)\b", re.IGNORECASE)
_END_MARK: Final = re.compile(r"\*{2,}\s*END\b.{0,20}", re.IGNORECASE)
_LAST_LINES: Final = 50
_SHOWN_DIGITS: Final = 40
_UPRIGHT: Final = re.compile(r"[-_](UP|UPDO|DWN|DN|VER|VRT|VERT)$", re.IGNORECASE)
_DATE: Final = re.compile(r"\d{1,4}[/-]\d{1,2}[/-]\d{1,4}")


def _recognises(source: Source) -> bool:
    top = source.top(HEADER_LINES)
    other_motion = source.suffix in {_SUFFIX, ".vt2", ".dt2"}
    return other_motion or any(_POINTS_LINE.match(line) or _WEST1.match(line) for line in top)


def _read(source: Source, request: Request) -> Record:
    index = _points_line(source)
    declared, time_step = _points_and_step(source, index)
    checked_time_step(source, request, time_step, index + 1)
    _check_kind(source, index)
    stated = first_match(_UNIT, source.top(index))
    unit_name, unit_line = (None, None) if stated is None else (stated[0][1].rstrip("."), stated[1])
    chosen = choose_unit(source, request, unit_name, unit_line)
    metadata = _description(source, index)
    value = metadata.get("component")
    name = None if value is None else str(value)

    def samples() -> Record:
        values = all_numbers(source, index + 1, _end_mark(source), of=declared)
        count = (declared, "NPTS", index + 1)
        return make_record(source, values, time_step, chosen, metadata, count=count)

    direction = _by_file_name(source) if name is None else orientation_of(name)
    return choose_component(source, request, [FileComponent(name, samples, direction)])


def _by_file_name(source: Source) -> Orientation:
    """Recognise a vertical component by the end of the file name, if not by the header."""
    end = _UPRIGHT.search(PurePath(source.path).stem)
    return UNKNOWN if end is None else orientation_of(end.group(1))


def _points_line(source: Source) -> int:
    for index, line in enumerate(source.top(HEADER_LINES)):
        if "NPTS" in line.upper():
            return index
    raise source.refuse(
        found=f"no number of points (NPTS) in the first {HEADER_LINES} lines, "
        f"which begin with {quoted_first_line(source.start)}",
        expected="a PEER header with a line such as 'NPTS=  7999, DT=   .0050 SEC'",
        line=1,
    )


def _end_mark(source: Source) -> int | None:
    """Find the mark below the last number; nothing but blank lines may follow it."""
    for index in range(len(source.lines) - 1, max(len(source.lines) - _LAST_LINES, 0), -1):
        text = source.lines[index].strip()
        if text:
            return index if _END_MARK.match(text) else None
    return None


def _points_and_step(source: Source, index: int) -> tuple[int, float]:
    line = source.top(1, index)[0]
    west1 = _WEST1.match(line)
    points, step = _POINTS.search(line), _STEP.search(line)
    if points is not None and step is not None:
        count_text, step_text = points.group(1), step.group(1)
    elif west1 is not None:
        count_text, step_text = west1.groups()
    else:
        expected = "'NPTS= <count>, DT= <seconds> SEC' or '<count> <seconds> NPTS, DT'"
        raise source.refuse(found=quoted_first_line(line), expected=expected, line=index + 1)
    count = integer_or_none(count_text.rstrip("."))
    if count is None or count < 1:
        found = f"a number of points of {count_text[:_SHOWN_DIGITS]}"
        raise source.refuse(
            found=found, expected="a whole number of points above zero", line=index + 1
        )
    return count, float(with_exponent_e(step_text))


def _check_kind(source: Source, index: int) -> None:
    for number, line in enumerate(source.top(index), start=1):
        kind = _OTHER_KIND.search(line)
        if kind is not None and "ACCELERATION" not in line.upper():
            found = f"a {kind.group(1).lower()} ({quoted_first_line(line)})"
            raise source.refuse(
                found=found, expected="an acceleration (the .AT2 file of the set)", line=number
            )


def _description(source: Source, index: int) -> Metadata:
    header = [line.strip() for line in source.top(index) if line.strip()]
    if not header:
        return {}
    if "PEER" not in header[0].upper() or len(header) < 3:
        return {"description": header[0]}
    metadata: Metadata = {"description": header[1]}
    fields = [part.strip() for part in header[1].split(",")]
    if len(fields) < 3:
        return metadata
    event, *middle, component = fields
    if len(middle) > 1 and _DATE.fullmatch(middle[0]):
        metadata["date"] = middle.pop(0)
    metadata |= {"event": event, "station": ", ".join(middle)}
    if component:
        metadata["component"] = component.split("(")[0].strip() or component
    return metadata


PEER_AT2: Final = Format(
    "peer-at2",
    "PEER acceleration file (AT2)",
    (_SUFFIX,),
    _recognises,
    _read,
    holds="one",
    unit="in the header",
)

Known: TypeAlias = dict[str, str | float | int]

_MARK: Final = b"PEER Ground Motion Database"
_START: Final = 4096
_FIRST: Final = "Result ID"
_KILOMETRE: Final = 1000.0
_NUMBERS: Final = {
    # title of the column without its unit: name in the metadata, factor to SI units
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
_MAX_ROWS: Final = 10_000
_HEAD_UNIT: Final = re.compile(r"\s*\([^)]*\)\s*$")


def peer_table(source: Source) -> dict[str, Known] | None:
    """Read the table of a download, by file names; None if a file is not such a table."""
    if _MARK not in source.data[:_START]:
        return None
    lines = source.lines
    first = next((k for k, line in enumerate(lines) if line.startswith(_FIRST)), None)
    if first is None:
        raise source.refuse(
            found=f"no line that begins with {_FIRST!r}",
            expected="the table of a PEER download with its summary of records",
        )
    end = next((k for k in range(first, len(lines)) if not lines[k].strip()), len(lines))
    try:
        rows = list(csv.reader(lines[first : min(end, first + _MAX_ROWS)], skipinitialspace=True))
    except csv.Error as problem:
        found = f"a table that cannot be read ({problem})"
        expected = "fields between commas"
        raise source.refuse(found=found, expected=expected, line=first + 1) from problem
    heads = [_HEAD_UNIT.sub("", head).strip().casefold() for head in rows[0]]
    if not any(head in _FILES for head in heads):
        found = "no column with the names of files"
        expected = "columns such as 'Horizontal-1 Acc. Filename'"
        raise source.refuse(found=found, expected=expected, line=first + 1)
    entries: dict[str, Known] = {}
    for place, row in enumerate(rows[1:], start=first + 2):
        # a comma inside a name would shift all fields after it
        if len(row) < len(heads) or any(field.strip() for field in row[len(heads) :]):
            found = f"{len(row)} fields"
            raise source.refuse(found=found, expected=f"{len(heads)}", line=place)
        fields = dict(zip(heads, (field.strip() for field in row), strict=False))
        metadata = _metadata_from_row(fields, source, place)
        for head, axis in _FILES.items():
            name = _field_or_empty(fields.get(head, ""))
            if name:
                entries[name] = {**metadata, "axis": axis}
    return entries


def _metadata_from_row(fields: dict[str, str], source: Source, line: int) -> Known:
    metadata: Known = {name: fields[head] for head, name in _TEXTS.items() if fields.get(head)}
    for head, (name, factor) in _NUMBERS.items():
        text = _field_or_empty(fields.get(head, ""))
        if not text:
            continue
        value = _number(text, source, line, head) * factor
        if value == -999.0 * factor:  # mark of an unknown value in the databases
            continue
        metadata[name] = int(value) if name in _WHOLE else value
    return metadata


def _field_or_empty(text: str) -> str:
    """Return a field, empty if it has only hyphens."""
    return text if text.strip("- ") else ""


def _number(text: str, source: Source, line: int, head: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        found = f"{text[:40]!r} in the column {head!r}"
        raise source.refuse(found=found, expected="a number", line=line)
    return value
