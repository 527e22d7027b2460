"""Files with a header of keys and values above one component or a table.

These are the formats of ESM and ITACA, RESORCE, AFAD and CSMNC.

References: Engineering Strong-Motion Database (ESM) and Italian Accelerometric Archive (ITACA),
ASCII format ``HEADER_FORMAT: DYNA 1.2``; for the others, the headers of the files themselves.
"""

import re
from functools import cache, partial
from typing import Final

from rockframe.records.checks import (
    LENGTH,
    NUMBERS_ONLY,
    StatedValue,
    checked_time_step,
    make_record,
    surplus_rows_warning,
)
from rockframe.records.components import UNKNOWN, FileComponent, choose_component, orientation_of
from rockframe.records.headers import (
    MISSING_KEY,
    Keys,
    first_match,
    read_keys,
    renamed_keys,
    required_count,
    required_match,
    required_step,
    value_or_empty,
    without_empty_values,
)
from rockframe.records.numbers import (
    NUMBER,
    FixedWidth,
    all_numbers,
    check_end,
    free_format,
    last_fields,
    required_number,
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
from rockframe.signals.arrays import Array

_MAX_HEADER_LINES: Final = 40

# ESM and ITACA: lines ``KEY: value``, then one number per line. The header of DYNA 1.0 to 1.2 has
# at most 64 lines. The earlier header of ITACA 1.1 has ``COMPONENT`` instead of ``STREAM``,
# ``DATA_VERSION`` for the version, and ``UNPROCESSED`` or ``PROCESSED ACCELERATION`` for the data.

_ESM_KEY: Final = re.compile(r"^([A-Z][A-Z0-9_/^ ]{2,60}?)\s*:\s*(.*?)\s*$")
_ESM_MARKS: Final = frozenset(
    ("SAMPLING_INTERVAL_S", "NDATA", "STREAM", "DATABASE_VERSION", "DATA_VERSION")
)
_ESM_MAX_HEADER_LINES: Final = 120
_ESM_PEAK_UNIT: Final = "cm/s^2"  # by its key, whatever the unit of the samples
_ESM_METADATA: Final = {
    "EVENT_NAME": "event",
    "EVENT_ID": "event_id",
    "NETWORK": "network",
    "STATION_CODE": "station",
    "STATION_NAME": "station_name",
    "DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS": "record_time",
    "BASELINE_CORRECTION": "baseline_correction",
    "PROCESSING": "processing",
}


def _is_esm(source: Source) -> bool:
    top = source.top(_ESM_MAX_HEADER_LINES)
    return len(_ESM_MARKS & {match[1] for line in top if (match := _ESM_KEY.match(line))}) >= 2


def _read_esm(source: Source, request: Request) -> Record:
    header, first = _esm_header(source)
    kind, kind_line = header.get("DATA_TYPE", MISSING_KEY)
    if kind and kind.casefold().removeprefix("un").removeprefix("processed ") != "acceleration":
        found = f"DATA_TYPE {quoted_first_line(kind)}"
        raise source.refuse(found=found, expected="an acceleration", line=kind_line)
    time_step = required_step(source, request, header, "SAMPLING_INTERVAL_S")
    unit_name, unit_line = header.get("UNITS", MISSING_KEY)
    chosen = choose_unit(source, request, unit_name or None, unit_line or None)
    count = required_count(source, header, "NDATA")
    metadata = renamed_keys(header, _ESM_METADATA)
    day, clock = (
        value_or_empty(header, f"EVENT_{key}") for key in ("DATE_YYYYMMDD", "TIME_HHMMSS")
    )
    if day:
        metadata["event_time"] = f"{day}_{clock}" if clock else day
    name, name_line = header.get("STREAM", header.get("COMPONENT", MISSING_KEY))
    peak, peak_line = header.get("PGA_CM/S^2", MISSING_KEY)
    length, length_line = header.get("DURATION_S", MISSING_KEY)

    def samples() -> Record:
        values = all_numbers(source, first, of=count[0])
        stated = (
            StatedValue(peak, _ESM_PEAK_UNIT, peak_line),
            StatedValue(length, LENGTH, length_line),
        )
        return make_record(source, values, time_step, chosen, metadata, count=count, stated=stated)

    component = FileComponent(name or None, samples, orientation_of(name), line=name_line or None)
    return choose_component(source, request, [component])


def _esm_header(source: Source) -> tuple[Keys, int]:
    header: Keys = {}
    for line, text in enumerate(source.top(_ESM_MAX_HEADER_LINES), start=1):
        match = _ESM_KEY.match(text)
        if match is not None:
            header.setdefault(match[1], (match[2], line))
        elif text.strip():
            return header, line - 1
    found = f"no data in the first {_ESM_MAX_HEADER_LINES} lines"
    expected = "numbers below a header of 64 lines"
    raise source.refuse(found=found, expected=expected, line=source.last_line)


ESM: Final = Format(
    "esm",
    "ESM or ITACA file (DYNA ASCII)",
    (".asc", ".dat"),
    _is_esm,
    _read_esm,
    holds="one",
    unit="in the header",
)


# RESORCE and SIGMA: lines ``KEY : value``, then five numbers in a line. Negative numbers fill their
# whole width, so that there is no blank before them. The files misspell "acceleration":
#
#     Time Increment (s)            : 0.005
#     Number of Data                : 12400
#     PGA (m/s/s)                   : 1.0022000E-02
#     Accelaration time series in m/s/s
#      4.1965000E-05 4.1963000E-05 4.1971000E-05 4.1993000E-05 4.2032000E-05

_RESORCE_STEP: Final = "Time Increment (s)"
_RESORCE_COUNT: Final = "Number of Data"
_SERIES: Final = re.compile(r"^\s*acc?el\w{3,10} time series in (\S{1,20})", re.IGNORECASE)
_RESORCE_PEAK: Final = re.compile(r"^PGA \((\S{1,20})\)$", re.IGNORECASE)
_RESORCE_LAYOUT: Final = FixedWidth(14, 5)
_RESORCE_METADATA: Final = {
    "Event Date & Time": "event_time",
    "Network": "network",
    "Processing Info": "processing",
}


def _is_resorce(source: Source) -> bool:
    return {_RESORCE_STEP, _RESORCE_COUNT} <= set(read_keys(source.top(_MAX_HEADER_LINES)))


def _read_resorce(source: Source, request: Request) -> Record:
    header = read_keys(source.top(_MAX_HEADER_LINES))
    time_step = required_step(source, request, header, _RESORCE_STEP)
    count, *_ = required_count(source, header, _RESORCE_COUNT)
    series = first_match(_SERIES, source.top(_MAX_HEADER_LINES))
    if series is None:
        found = f"no line with the unit below {quoted_first_line(source.start)}"
        expected = "'Accelaration time series in m/s/s' above the numbers"
        raise source.refuse(found=found, expected=expected, line=1)
    unit_match, line = series
    chosen = choose_unit(source, request, unit_match[1], line)
    metadata: Metadata = {**renamed_keys(header, _RESORCE_METADATA), "unit_as_read": chosen[1]}
    code, _, place = value_or_empty(header, "Station Code / Name").partition("/")
    metadata |= without_empty_values({"station": code.strip(), "station_name": place.strip()})
    if "event_time" in metadata:
        metadata["event"] = f"earthquake of {metadata['event_time']}"
    name, name_line = header.get("Orientation", MISSING_KEY)
    stated = [
        StatedValue(printed, match[1], peak_line)
        for key, (printed, peak_line) in header.items()
        if (match := _RESORCE_PEAK.match(key)) is not None
    ]

    def samples() -> Record:
        values = _RESORCE_LAYOUT.read(source, line, count)
        end = line + _RESORCE_LAYOUT.rows(count)
        warnings = surplus_rows_warning(source, end, _RESORCE_COUNT, len(source.lines))
        return make_record(
            source, values, time_step, chosen, metadata, warnings_before=warnings, stated=stated
        )

    component = FileComponent(name or None, samples, orientation_of(name), line=name_line or None)
    return choose_component(source, request, [component])


RESORCE: Final = Format(
    "resorce",
    "RESORCE file (.cor.acc)",
    (".acc",),
    _is_resorce,
    _read_resorce,
    holds="one",
    unit="in the header",
)


# Turkey's Disaster and Emergency Management Presidency (AFAD), until 2018: lines ``KEY : value``,
# then the names of three columns, then the columns, in the unit of the peaks. Later files have the
# format of ESM.
#
#     NUMBER OF DATA          : 13494
#     SAMPLING INTERVAL (sec) : 0.01
#     RAW PGA VALUES (gal)    : (N-S) 21.838512 (E-W) 26.042589 (U-D) 9.799439
#            N-S          E-W          U-D

_AFAD_STEP: Final = "SAMPLING INTERVAL (sec)"
_AFAD_COUNT: Final = "NUMBER OF DATA"
_AFAD_PEAKS: Final = re.compile(r"^RAW PGA VALUES? \((\S{1,12})\)$", re.IGNORECASE)
_AFAD_PEAK: Final = re.compile(rf"\(\s*([A-Z-]{{1,6}})\s*\)\s*({NUMBER})", re.IGNORECASE | re.ASCII)
_AFAD_METADATA: Final = {
    "STATION ID": "station",
    "PLACE": "station_name",
    "EARTHQUAKE DATE": "event_time",
    "RECORD TIME": "record_time",
    "RECORDER TYPE": "instrument",
}


def _is_afad(source: Source) -> bool:
    return {_AFAD_STEP, _AFAD_COUNT} <= set(read_keys(source.top(_MAX_HEADER_LINES)))


def _read_afad(source: Source, request: Request) -> Record:
    header = read_keys(source.top(_MAX_HEADER_LINES))
    time_step = required_step(source, request, header, _AFAD_STEP)
    count = required_count(source, header, _AFAD_COUNT)
    names, first = _afad_columns(source)
    peaks, unit_name, peaks_line = _afad_peaks(header)
    chosen = choose_unit(source, request, unit_name, peaks_line)
    metadata: Metadata = {**renamed_keys(header, _AFAD_METADATA), "unit_as_read": chosen[1]}
    if "event_time" in metadata:
        metadata["event"] = f"earthquake of {metadata['event_time']}"

    table = cache(partial(_afad_table, source, first, len(names)))

    def samples(place: int) -> Record:
        values = table()[:, place].copy()
        stated = [StatedValue(peaks.get(names[place], ""), unit_name or "", peaks_line or 1)]
        return make_record(source, values, time_step, chosen, metadata, count=count, stated=stated)

    components = [
        FileComponent(name, partial(samples, place), orientation_of(name), line=first)
        for place, name in enumerate(names)
    ]
    return choose_component(source, request, components)


def _afad_columns(source: Source) -> tuple[list[str], int]:
    for line, text in enumerate(source.top(_MAX_HEADER_LINES), start=1):
        names = text.split()
        if len(names) > 1 and all(orientation_of(name) != UNKNOWN for name in names):
            return names, line
    found = f"no columns below {quoted_first_line(source.start)}"
    expected = "a line with the names of the columns, such as 'N-S E-W U-D'"
    raise source.refuse(found=found, expected=expected, line=1)


def _afad_peaks(header: Keys) -> tuple[dict[str, str], str | None, int | None]:
    for key, (text, line) in header.items():
        match = _AFAD_PEAKS.match(key)
        if match is not None:
            return dict(_AFAD_PEAK.findall(text)), match[1], line
    return {}, None, None


def _afad_table(source: Source, first: int, columns: int) -> Array:
    for index in range(first, source.last_line):
        fields = len(source.lines[index].split())
        if fields != columns:
            found, expected = f"{fields} fields", f"{columns}, one for each component"
            raise source.refuse(found=found, expected=expected, line=index + 1)
    values = free_format(source, first)
    if values.size % columns or values.size < columns:
        found, expected = f"{values.size} numbers", f"{columns} in each line"
        raise source.refuse(found=found, expected=expected, line=source.last_line)
    last = last_fields(source, first)[columns - 1 :: columns]
    check_end(source, last, f"{values.size // columns} samples")
    return values.reshape(-1, columns)


AFAD: Final = Format(
    "afad",
    "AFAD file, Turkey, in three columns",
    (".txt",),
    _is_afad,
    _read_afad,
    holds="three",
    unit="that of the peaks in the header",
)


# China Strong Motion Networks Centre: one component below sixteen lines such as
#
#     COMP. EW
#     UNCORRECTED ACCELERATION          UNIT: CM/SEC/SEC
#     NO. OF POINTS:  12800  EQUALLY SPACED INTERVALS OF:  0.005  SEC
#     PEAK VALUE:    -16.986   AT   27.06 SEC    DURATION:  64 SEC

_KIND: Final = re.compile(
    r"^\s*(?:UN)?(?:CORRECTED|PROCESSED) (ACCELERATION|VELOCITY|DISPLACEMENT)\s+UNIT:\s*(\S{1,20})",
    re.IGNORECASE,
)
_POINTS: Final = re.compile(
    rf"^\s*NO\. OF POINTS:\s*(\d{{1,9}})\s+EQUALLY SPACED INTERVALS OF:\s*({NUMBER})\s*SEC",
    re.IGNORECASE | re.ASCII,
)
_PEAK: Final = re.compile(rf"^\s*PEAK VALUE:\s*({NUMBER})", re.IGNORECASE | re.ASCII)
_LENGTH: Final = re.compile(rf"\bDURATION:\s*({NUMBER})\s*SEC", re.IGNORECASE | re.ASCII)
_COMPONENT: Final = re.compile(r"^\s*COMP\.?\s*(\S{1,12})", re.IGNORECASE)
_STATION: Final = re.compile(r"^\s*STATION:\s*(\S{1,12})", re.IGNORECASE)
_TIME: Final = re.compile(r"\b(\d{4}-\d{1,2}-\d{1,2} \d{1,2}:\d{2}:[\d.]{2,8}(?: [A-Z]{2,4})?)")


def _is_csmnc(source: Source) -> bool:
    top = source.top(_MAX_HEADER_LINES)
    return any(map(_KIND.match, top)) and any(map(_POINTS.match, top))


def _read_csmnc(source: Source, request: Request) -> Record:
    top = source.top(_MAX_HEADER_LINES)
    such_as = "UNCORRECTED ACCELERATION   UNIT: CM/SEC/SEC"
    kind, kind_line = required_match(source, _KIND, top, such_as)
    such_as = "NO. OF POINTS: 12800 EQUALLY SPACED INTERVALS OF: ..."
    points, line = required_match(source, _POINTS, top, such_as)
    if kind[1].upper() != "ACCELERATION":
        found = f"a {kind[1].lower()}"
        raise source.refuse(found=found, expected="an acceleration", line=kind_line)
    time_step = required_number(points[2], source, line)
    checked_time_step(source, request, time_step, line)
    chosen = choose_unit(source, request, kind[2], kind_line)
    first = next((k for k in range(line, len(top)) if NUMBERS_ONLY.fullmatch(top[k])), len(top))
    metadata = _csmnc_description(top)
    named = first_match(_COMPONENT, top)
    stated: list[StatedValue] = []
    for place, text in enumerate(top, start=1):
        peak, length = _PEAK.match(text), _LENGTH.search(text)
        if peak is not None:
            stated.append(StatedValue(peak[1], kind[2], place))
        if length is not None:
            stated.append(StatedValue(length[1], LENGTH, place))

    def samples() -> Record:
        values = all_numbers(source, first)
        count = (int(points[1]), "NO. OF POINTS", line)
        return make_record(source, values, time_step, chosen, metadata, count=count, stated=stated)

    name, name_line = (None, None) if named is None else (named[0][1], named[1])
    component = FileComponent(name, samples, orientation_of(name or ""), line=name_line)
    return choose_component(source, request, [component])


def _csmnc_description(top: list[str]) -> Metadata:
    metadata: Metadata = {}
    if len(top) > 2 and re.search("[A-Za-z]", top[2]):
        metadata["event"] = top[2].strip()
    time = _TIME.search(top[1]) if len(top) > 1 else None
    if time is not None:
        metadata["event_time"] = time[1]
    for text in top:
        station = _STATION.match(text)
        start = _TIME.search(text) if "RECORDER TIME" in text.upper() else None
        if station is not None:
            metadata["station"] = station[1]
        if start is not None:
            metadata["record_time"] = start[1]
        if _KIND.match(text):
            metadata["description"] = text.split("UNIT")[0].strip().lower()
    return metadata


CSMNC: Final = Format(
    "csmnc",
    "file of the China Strong Motion Networks Centre",
    (".dat",),
    _is_csmnc,
    _read_csmnc,
    holds="one",
    unit="in the header",
)
