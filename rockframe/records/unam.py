"""Mexico's standard acceleration file (archivo estandar de aceleracion, ASA).

The header has Spanish keys and values. Values of single channels are a list after slashes. The
columns, one for each channel, follow below their names::

    ORIENTACION C1-C6 (rumbo;orientacion)  : /V/N90E/N00E
    INTERVALO DE MUESTREO, C1-C6 (s)       : /0.004/0.004/0.004
    NUM. TOTAL DE MUESTRAS, C1-C6          : /17500/17500/17500
    ACEL. MAX.(Gal), C1-C6                 : /0.47/-1.19/1.22
    UNIDADES DE LOS DATOS                  : Gal (cm/s/s)
    FORMATO DATOS (FORTRAN,10 campos/dato) : 3F10.3

Reference: Instituto de Ingenieria, UNAM, "Archivo estandar de aceleracion", version 2.0.
"""

import re
from functools import cache, partial
from typing import Final

from rockframe.records.checks import LENGTH, StatedValue, checked_time_step, make_record
from rockframe.records.components import (
    UPWARDS,
    VERTICAL,
    FileComponent,
    Orientation,
    choose_component,
    orientation_of,
)
from rockframe.records.headers import (
    Keys,
    read_keys,
    renamed_keys,
    required_value,
    value_or_empty,
    whole_number,
    without_empty_values,
)
from rockframe.records.numbers import FixedWidth, required_number, rows_below
from rockframe.records.reader import (
    Format,
    Metadata,
    Record,
    Request,
    Source,
    choose_unit,
    quoted_first_line,
)
from rockframe.signals.arrays import Array

_TITLE: Final = re.compile(r"ARCHIVO ESTANDAR DE ACELERACION", re.IGNORECASE)
_DATA: Final = re.compile(r"^\s*DATOS DE ACELERACION", re.IGNORECASE)
_UNITS: Final = "UNIDADES DE LOS DATOS"
_LAYOUT_KEY: Final = "FORMATO DATOS (FORTRAN,10 campos/dato)"
_LAYOUT: Final = re.compile(r"(\d{1,2})F(\d{1,2})\.\d", re.IGNORECASE)
# keys of values for each channel
_DIRECTIONS: Final = "ORIENTACION"
_STEPS: Final = "INTERVALO DE MUESTREO"
_COUNTS: Final = "NUM. TOTAL DE MUESTRAS"
_PEAKS: Final = "ACEL. MAX.(Gal)"
_LENGTHS: Final = "DURACION DEL REGISTRO"
_PEAK_UNIT: Final = "gal"
_METADATA_KEYS: Final = {
    "CLAVE DE LA ESTACION": "station",
    "NOMBRE DE LA ESTACION": "station_name",
    "MODELO DEL ACELEROGRAFO": "instrument",
}
_MAX_HEADER_LINES: Final = 160
_MAX_CHANNELS: Final = 12


def _recognises(source: Source) -> bool:
    return any(map(_TITLE.search, source.top(20)))


def _read(source: Source, request: Request) -> Record:
    top = source.top(_MAX_HEADER_LINES)
    header = read_keys(top)
    directions = _list(header, _DIRECTIONS)
    layout = _layout(source, header)
    first = _first_row(source, top)
    channels = min(len(directions), layout.per_line)
    if not 1 <= channels <= _MAX_CHANNELS:
        found = f"the orientations of {channels} channels"
        raise source.refuse(found=found, expected="one to twelve, such as '/V/N90E/N00E'", line=1)

    @cache
    def table() -> Array:
        rows = rows_below(source, first)
        values = layout.read(source, first, rows * layout.per_line)
        return values.reshape(rows, layout.per_line)

    def samples(place: int) -> Record:
        values = table()[:, place].copy()
        text, unit_line = required_value(source, header, _UNITS)
        chosen = choose_unit(source, request, text.split()[0], unit_line)
        printed, line = _entry(source, header, _STEPS, place, "sampling interval")
        time_step = required_number(printed, source, line)
        checked_time_step(source, request, time_step, line)
        announced, count_line = _entry(source, header, _COUNTS, place, "number of samples")
        found = f"{quoted_first_line(announced)} samples"
        count = whole_number(source, announced, found, count_line), _COUNTS, count_line
        stated = [
            StatedValue(text, unit, line)
            for key, unit in ((_PEAKS, _PEAK_UNIT), (_LENGTHS, LENGTH))
            for text, line in _list(header, key)[place : place + 1]
        ]
        metadata = _description(header)
        return make_record(source, values, time_step, chosen, metadata, count=count, stated=stated)

    components: list[FileComponent] = []
    for place, (stated, line) in enumerate(directions[:channels]):
        name, direction = _direction(stated)
        name = name or f"channel {place + 1}"
        read = partial(samples, place)
        components.append(FileComponent(name, read, direction, channel=place + 1, line=line))
    return choose_component(source, request, components)


def _list(header: Keys, start: str) -> list[tuple[str, int]]:
    """Return the entries of a list, which may continue in a second line for channels 7 to 12."""
    entries: list[tuple[str, int]] = []
    for key, (text, line) in header.items():
        if key.startswith(start) and "MUESTRA" not in key.removeprefix(start):
            entries += [(part.strip(), line) for part in text.split("/")[1:]]
    return entries


def _entry(source: Source, header: Keys, key: str, place: int, what: str) -> tuple[str, int]:
    entries = _list(header, key)
    if place >= len(entries):
        found = f"no {what} of channel {place + 1}"
        raise source.refuse(found=found, expected=f"the {what} of each channel", line=1)
    return entries[place]


def _layout(source: Source, header: Keys) -> FixedWidth:
    text, line = required_value(source, header, _LAYOUT_KEY)
    match = _LAYOUT.match(text)
    if match is None or int(match.group(1)) < 1 or int(match.group(2)) < 1:
        expected = "a layout such as '3F10.3'"
        raise source.refuse(
            found=f"the layout {quoted_first_line(text)}", expected=expected, line=line
        )
    return FixedWidth(int(match.group(2)), int(match.group(1)))


def _first_row(source: Source, top: list[str]) -> int:
    title = next((k for k, text in enumerate(top) if _DATA.match(text)), len(top))
    rules = [k for k in range(title, len(top)) if top[k].startswith("-----")]
    if len(rules) < 2:
        expected = "'DATOS DE ACELERACION', and the names of the channels between two rules"
        raise source.refuse(found="no data", expected=expected, line=source.last_line)
    return rules[1] + 1


def _direction(text: str) -> tuple[str, Orientation]:
    name = text.split(";")[0].strip()
    plain = name.lstrip("+-").strip()
    direction = orientation_of(plain)
    if direction.vertical == VERTICAL and name.startswith("+"):
        return plain, Orientation(vertical=UPWARDS)
    return (name, direction.reversed()) if name.startswith("-") else (plain, direction)


def _description(header: Keys) -> Metadata:
    day = value_or_empty(header, "FECHA DEL SISMO [GMT]")
    clock = value_or_empty(header, "HORA EPICENTRO (GMT)")
    time = f"{day} {clock} GMT" if day and clock else day
    start = value_or_empty(header, "HORA DE LA PRIMERA MUESTRA (GMT)")
    times = {
        "event_time": time,
        "event": time and f"earthquake of {time}",
        "record_time": start and f"{start} GMT",
    }
    return renamed_keys(header, _METADATA_KEYS) | without_empty_values(times)


UNAM: Final = Format(
    "unam",
    "standard acceleration file (ASA), Mexico",
    (".asa",),
    _recognises,
    _read,
    holds="up to twelve",
    unit="in the header",
)
