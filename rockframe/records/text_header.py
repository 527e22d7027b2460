"""Header lines above columns: names, units, time step, peak, and marks of a spectrum."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

from rockframe.records.checks import StatedValue
from rockframe.records.components import UNKNOWN, Orientation, orientation_of
from rockframe.records.numbers import NUMBER, WHOLE_NUMBER, with_exponent_e
from rockframe.records.reader import Source, quoted_first_line
from rockframe.records.text_columns import Table, split_header
from rockframe.records.unit_names import SLASHED, STATED_UNIT, acceleration_unit, other_quantity

# with one level of inner brackets, as in [1/(s^2)]; no blank can be matched in two ways
_BRACKETED: Final = re.compile(r"[(\[{]([^()\[\]{}]*(?:\([^()]*\)[^()\[\]{}]*)?)[)\]}]")
_STATED: Final = re.compile(rf"{STATED_UNIT}[(\[]?\s*([^\s()\[\],;]+{SLASHED})", re.IGNORECASE)
_ACCELERATION_NAME: Final = re.compile(r"\W*(acc|a\b|ag\b)", re.IGNORECASE)
_TIME_NAME: Final = re.compile(r"\W*(time|t)\b", re.IGNORECASE)
_OTHER_KIND: Final = re.compile(r"(?<![a-z])(vel|disp)", re.IGNORECASE)
_LIKE_UNIT: Final = re.compile(r"\S*[/^*²]\S*|m?v(?:olts?)?|counts?|cnts?|lsb", re.IGNORECASE)
_BESIDE_A: Final = ("v", "d", "u")
_PERIOD_NAME: Final = re.compile(r"\W*(period|freq|omega|t_?n\b)", re.IGNORECASE)
_SPECTRAL_NAME: Final = re.compile(
    r"\W*(?:pseudo|p?s_?[adv](?![a-z])|f(?:ourier|as\b|ft\b))|.*spectr", re.IGNORECASE
)
_CERTAINLY_SPECTRAL: Final = re.compile(r"\W*(?:pseudo|psa\b)|.*spectr", re.IGNORECASE)
_IN_TIME: Final = re.compile(r"\W*time\b", re.IGNORECASE)
_SPECTRUM: Final = re.compile(
    r"\b(?:response|acceleration|design|target|hazard|elastic|floor|fourier)[ -]+spectr(?:um|a)\b|"
    r"\bspectral\s+acceleration",
    re.IGNORECASE,
)
_MATCHED: Final = re.compile(r"match|compatib|artificial|time", re.IGNORECASE)
_WORDS: Final = re.compile(r"[^\W_]+")
_ACCELERATION_WORD: Final = re.compile(
    r"acc(?:n|el|eleration)?s?|ground|comp(?:onent)?", re.IGNORECASE
)
_ACCELERATION_ALONG: Final = re.compile(r"a(?:cc)?([xyz])", re.IGNORECASE)
_COMPONENT_NUMBER: Final = re.compile(r"(?:^|[\W_]+)[1-9]$")


@dataclass(frozen=True)
class TextColumn:
    """A column of accelerations."""

    place: int  # index of the column, from 0
    name: str  # name in the header, without a unit; ``column 2`` if there is none
    orientation: Orientation = UNKNOWN  # positive direction, if it follows from the name
    unit: str | None = None  # unit of this column alone


def column_names(source: Source, table: Table) -> tuple[list[str], int]:
    """Find the names of the columns; refuse another quantity or a spectrum."""
    columns = table.values.shape[1]
    names, line = _names(source, table, columns)
    _check_no_spectrum(source, table, names, line)
    if not names or columns > 2:
        return names, line
    last = names[-1]
    if _is_other(last):
        raise source.refuse(
            found=f"the column {quoted_first_line(last)}", expected="an acceleration", line=line
        )
    if columns == 2 and (_ACCELERATION_NAME.match(names[0]) or _TIME_NAME.match(last)):
        are_directions = all(map(is_direction, names))
        if not are_directions or _TIME_NAME.match(last):
            found = f"the columns {names[0]!r}, {last!r}"
            expected = "the time first, then the acceleration"
            raise source.refuse(found=found, expected=expected, line=line)
    return names, line


def _names(source: Source, table: Table, columns: int) -> tuple[list[str], int]:
    for line, text in reversed(table.header):
        names = split_header(text, table.separator)
        if len(names) == columns and not all(map(_is_unit, names)):
            return names, line
        if table.separator is not None and _names_times(names[0]):
            count = len(split_header(text.rstrip(f" {table.separator}"), table.separator))
            if 1 < count != columns:
                found = f"{count} names ({quoted_first_line(text)})"
                expected = f"{columns}, as there are columns"
                raise source.refuse(found=found, expected=expected, line=line)
        if table.separator is None:  # single blanks, and units in brackets after the names
            words = _BRACKETED.sub(lambda match: match.group().replace(" ", ""), text)
            parts = re.sub(r"\s+(?=[(\[])", "", words.lstrip("#% \t")).split()
            if len(parts) == columns > 1 and not all(map(_is_unit, parts)):
                return parts, line
    return [], 1


def _names_times(name: str) -> bool:
    """Tell whether a name is only that of a column of times."""
    plain = _BRACKETED.sub("", name).strip().casefold()
    return plain in ("t", "time") or any(
        unit.casefold() in TIME_UNITS for unit in in_brackets(name)
    )


def _check_no_spectrum(source: Source, table: Table, names: list[str], line: int) -> None:
    expected = "accelerations over time"
    # next to "time" a name such as SV04 is that of a station; next to "T" it is a spectrum
    spectral = _CERTAINLY_SPECTRAL if _IN_TIME.match(names[0] if names else "") else _SPECTRAL_NAME
    if len(names) > 1 and (_PERIOD_NAME.match(names[0]) or all(map(spectral.match, names[1:]))):
        found = f"a spectrum, the columns {names[0]!r}, {names[1]!r}"
        raise source.refuse(found=found, expected=expected, line=line)
    if names and any(_TIME_NAME.match(name) or is_direction(name) for name in names):
        return
    for number, text in table.header:
        if _SPECTRUM.search(text) and not _MATCHED.search(text) and table.values.shape[1] > 1:
            raise source.refuse(
                found=f"a spectrum ({quoted_first_line(text)})", expected=expected, line=number
            )


def has_times(table: Table, names: list[str]) -> bool:
    """Tell whether the first column has times."""
    columns = table.values.shape[1]
    if columns == 1:
        return False
    if names:
        first = names[0]
        named = _TIME_NAME.match(first) is not None or first.casefold() in TIME_UNITS
        timed = any(unit.casefold() in TIME_UNITS for unit in in_brackets(first))
        directions = all(map(is_direction, names))
        return named or timed or (columns == 2 and not directions)
    return columns == 2 or is_rising(table)


def is_rising(table: Table) -> bool:
    """Tell whether the numbers of the first column increase throughout."""
    return bool((table.values[1:, 0] > table.values[:-1, 0]).all())


def is_direction(name: str) -> bool:
    """Tell whether the name of a column is a direction."""
    return _direction(name) != UNKNOWN


def acceleration_columns(
    source: Source, table: Table, names: list[str], line: int, *, timed: bool
) -> list[TextColumn]:
    """List the columns of accelerations, without those of velocities and displacements."""
    columns = table.values.shape[1]
    places = range(1 if timed else 0, columns)
    if not names or len(places) == 1:
        # for a single column the unit is searched in the whole header
        return [TextColumn(place, f"column {place + 1}") for place in places]
    units = _unit_row(table, columns)
    plain_names = [_BRACKETED.sub("", name).strip() or name for name in names]
    # next to an "a" they are velocity and displacement, not directions
    letters = _BESIDE_A if "a" in map(str.casefold, plain_names) else ()
    accelerations: list[TextColumn] = []
    stated: dict[int, str | None] = {}
    for place in places:
        candidates = [*in_brackets(names[place])[-1:], *units[place : place + 1]]
        plain = plain_names[place]
        if _IN_TIME.match(plain) or any(unit.casefold() in TIME_UNITS for unit in candidates):
            if timed:
                continue
            found_name = f"the times {names[place]!r} after another column"
            expected = "the times in the first column"
            raise source.refuse(found=found_name, expected=expected, line=line)
        if (
            _is_other(names[place])
            or any(map(other_quantity, candidates))
            or plain.casefold() in letters
        ):
            continue
        unit_name = next((unit for unit in candidates if acceleration_unit(unit) is not None), None)
        accelerations.append(TextColumn(place, plain, _direction(plain), unit_name))
        stated[place] = unit_name or next(iter(in_brackets(names[place])[-1:]), None)
    if not accelerations:
        names_found = ", ".join(names[:6])
        raise source.refuse(found=f"the columns {names_found}", expected="accelerations", line=line)
    if any(column.unit is not None for column in accelerations):
        # the unit of another column is not that of one whose own is unknown
        return [replace(column, unit=stated[column.place]) for column in accelerations]
    return accelerations


def _unit_row(table: Table, columns: int) -> list[str]:
    for _, text in reversed(table.header):
        fields = split_header(text, table.separator)
        if len(fields) == columns and all(map(_is_unit, fields)):
            return fields
    return []


def time_scale(source: Source, table: Table, names: list[str]) -> float:
    """Return the unit of the times in seconds."""
    name = names[0] if names else ""
    for unit in in_brackets(name)[:1]:
        if unit.casefold() not in TIME_UNITS:
            found, expected = f"the unit {unit!r} of the times", "seconds (s) or milliseconds (ms)"
            raise source.refuse(found=found, expected=expected, line=table.header[-1][0])
        return TIME_UNITS[unit.casefold()]
    if name.casefold() in TIME_UNITS:
        return TIME_UNITS[name.casefold()]
    units = {
        TIME_UNITS[unit.casefold()]
        for _, text in table.header
        for unit in in_brackets(text)
        if unit.casefold() in TIME_UNITS
    }
    return units.pop() if len(units) == 1 else 1.0


def unit_of_header(
    source: Source, table: Table, *, requested: bool
) -> tuple[str | None, int | None]:
    """Find the unit of the accelerations in the header."""
    unknown: tuple[str, int] | None = None
    units: list[tuple[str, int, float]] = []
    for line, name, certain in _unit_candidates(table):
        unit = acceleration_unit(name)
        if unit is not None:
            units.append((name, line, unit.factor))
        elif certain and name.casefold() not in TIME_UNITS and not units:
            if other_quantity(name) is not None or _LIKE_UNIT.fullmatch(name):
                return name, line  # not that of a line farther from the numbers
            unknown = unknown or (name, line)
    if units:
        name, line, factor = units[0]
        differing = [entry for entry in units if not math.isclose(entry[2], factor)]
        if differing and not requested:
            found = f"the units {name!r} and {differing[0][0]!r} (line {differing[0][1]})"
            raise source.refuse(found=found, expected="one unit, or the argument unit", line=line)
        return name, line
    return unknown or (None, None)


def in_brackets(text: str) -> list[str]:
    """Return the texts in brackets."""
    return [name.strip() for name in _BRACKETED.findall(text)]


def _unit_candidates(table: Table) -> Iterator[tuple[int, str, bool]]:
    # lines nearest to the numbers first; in brackets, after the word "unit", or as a separate
    # field; the last value tells whether the name must be a unit
    columns = table.values.shape[1]
    for position, (line, text) in enumerate(reversed(table.header)):
        fields = split_header(text, table.separator)
        is_unit = [_is_unit(field) for field in fields]
        for field, unit in zip(fields, is_unit, strict=True):
            if unit and ("/" in field or (all(is_unit) and len(fields) == columns)):
                yield line, field, True
        for name in _STATED.findall(text):
            yield line, name.rstrip("."), True
        bracketed = in_brackets(text)
        for name in bracketed:
            yield line, name, position == 0 and name == bracketed[-1]


def _is_other(name: str) -> bool:
    return _OTHER_KIND.search(name) is not None and _ACCELERATION_NAME.match(name) is None


def _direction(name: str) -> Orientation:
    # "Horizontal 2" is the second, not at two degrees
    plain = _COMPONENT_NUMBER.sub("", _BRACKETED.sub("", name).strip())
    along = _ACCELERATION_ALONG.fullmatch(plain)
    orientation = orientation_of(plain if along is None else along[1])
    if orientation != UNKNOWN:
        return orientation
    words = _WORDS.findall(plain)
    if len(words) < 2:
        return UNKNOWN
    orientation = orientation_of(words[-1])
    while orientation == UNKNOWN and len(words) > 1 and _ACCELERATION_WORD.fullmatch(words[-1]):
        words.pop()  # "vertical acceleration" names its direction first
        orientation = orientation_of(words[-1])
    return orientation


def _is_unit(name: str) -> bool:
    is_quantity = acceleration_unit(name) is not None or other_quantity(name) is not None
    return is_quantity or name.casefold() in TIME_UNITS


TIME_UNITS: Final = {
    **dict.fromkeys(("s", "sec", "secs", "sec.", "second", "seconds"), 1.0),
    **dict.fromkeys(("ms", "msec", "millisecond", "milliseconds"), 1e-3),
}

_OTHER_TIME_UNITS: Final = ("us", "ns", "min", "minutes", "h", "hours", "hz")

_STEP: Final = re.compile(
    rf"(?:\bd_?t|\bdelta[ _]?t|\btime[ _-]?(?:step|increment|interval)|"
    rf"\bsampl(?:ing|e)[ _-]?(?:interval|period))\s*(?:[(\[]\s*([a-z]{{1,7}})\.?\s*[)\]])?"
    rf"\s*[:=]\s*{WHOLE_NUMBER}(?!\s*/)\s*([a-z]{{0,7}})",  # 1/200 is not read as 1
    re.IGNORECASE | re.ASCII,
)
_RATE: Final = re.compile(
    rf"(?:\bsampl(?:ing|e)[ _-]?(?:rate|frequency))\s*(?:[(\[]\s*(?:hz|sps)\s*[)\]])?"
    rf"\s*[:=]\s*{WHOLE_NUMBER}(?!\s*kHz)",
    re.IGNORECASE | re.ASCII,
)
_PEAK: Final = re.compile(
    rf"\b(?:pga|peak(?: ground)? acceleration)\s*(?:[(\[]\s*([^()\[\]]{{1,12}})[)\]])?"
    rf"\s*[:=]\s*({NUMBER})\s*([a-z][a-z0-9/^*-]{{0,11}})?",
    re.IGNORECASE | re.ASCII,
)


def stated_step(header: list[tuple[int, str]]) -> tuple[float, int] | None:
    """Find a time step or a sampling rate in the header; give the step [s] and its line."""
    for line, text in header:
        step, rate = _STEP.search(text), _RATE.search(text)
        if step is not None:
            before, printed, after = step.groups()
            named = (before or after or "s").casefold()
            if named in _OTHER_TIME_UNITS:
                continue
            scale = TIME_UNITS.get(named, 1.0)  # any other word is not a unit of the step
            value = float(with_exponent_e(printed))
            return float(f"{value * scale:.15g}"), line
        if rate is not None:
            value = float(with_exponent_e(rate.group(1)))
            if 0.0 < value < math.inf:
                return 1.0 / value, line
    return None


def stated_peaks(header: list[tuple[int, str]]) -> list[StatedValue]:
    """Find the first peak with a unit in the header."""
    for line, text in header:
        match = _PEAK.search(text)
        if match is not None:
            before, printed, after = match.groups()
            unit = (before or after or "").strip()
            if unit:
                return [StatedValue(printed, unit, line)]
    return []
