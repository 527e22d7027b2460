"""Conversion of counts of a digitiser to accelerations, by the sensitivity of the instrument.

The sensitivity is read from StationXML, which is given or found in the folder of a record.

Reference: Federation of Digital Seismograph Networks, "FDSN StationXML": the element
``InstrumentSensitivity`` of a channel's response; azimuth clockwise from north, dip
positive downwards, so that -90 is a component positive upwards.
"""

import importlib
import math
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cached_property
from itertools import islice
from pathlib import Path
from typing import Any, Final

import numpy as np

from rockframe.records.components import DOWNWARDS, UNKNOWN, UPWARDS, Orientation, azimuth_of
from rockframe.records.files import read_source
from rockframe.records.reader import Metadata, Record, Request, Source, base_name
from rockframe.records.unit_names import RecordUnit, acceleration_unit
from rockframe.signals.arrays import Array

_LARGEST: Final = 8 * 2**20
_MAX_FILES: Final = 20
_MAX_LISTED: Final = 2_000
_MAX_EPOCHS: Final = 1_000
_MAX_TEXT_LENGTH: Final = 60
_ROOT: Final = "FDSNStationXML"
_SENSITIVITY: Final = "{*}Response/{*}InstrumentSensitivity"
_NO_CODE: Final = ("", "none")
_MAX_HORIZONTAL_DIP: Final = 5.0
_MIN_VERTICAL_DIP: Final = 85.0
_MISSING: Final = (
    "counts, and no response of the instrument",
    "StationXML beside the file or as the argument response, or the argument unit if the samples "
    "are accelerations",
)


@dataclass(frozen=True)
class InstrumentResponse:
    """Sensitivity of one channel, to convert counts to accelerations."""

    sensitivity: float  # counts per `unit`
    unit: RecordUnit  # unit of the acceleration
    orientation: Orientation  # direction of the channel
    file: str  # name of the StationXML file
    sha256: str  # its digest


class InstrumentResponses:
    """The responses of the instruments of one record; each file is read once.

    Unless a file is given, StationXML is searched in the folder of the record, in files with the
    extension ``.xml`` and with the same stem or with ``NET.STA`` in the name.
    """

    def __init__(self, source: Source, request: Request) -> None:
        self._source = source
        self._stated = None if request.response is None else _inventory_of(request.response)
        self._left = _LARGEST  # bytes, of all files together
        self._read: dict[Path, _Inventory | None] = {}

    def find(self, name: str, time: datetime) -> InstrumentResponse | None:
        """Find the response of a channel."""
        if self._stated is not None:
            response = self._stated.response(name, time)
            if response is None:
                expected = f"the response of {name} at {time}"
                raise self._stated.file.refuse(found="StationXML without it", expected=expected)
            return response
        station = ".".join(name.split(".")[:2])
        stem = Path(self._source.path).stem
        beside: dict[str, InstrumentResponse] = {}
        for path in self._files:
            if path.name.startswith(f"{stem}.") or station in path.name:
                inventory = self._inventory(path)
                response = None if inventory is None else inventory.response(name, time)
                if response is not None:
                    beside.setdefault(response.sha256, response)
        if len(beside) > 1:
            files = ", ".join(entry.file for entry in beside.values())
            expected = "one; name it by the argument response"
            found = f"several files with the response: {files}"
            raise self._source.refuse(found=found, expected=expected)
        return next(iter(beside.values()), None)

    @cached_property
    def _files(self) -> list[Path]:
        try:
            listed = list(islice(Path(self._source.path).parent.iterdir(), _MAX_LISTED))
        except OSError:
            return []
        return sorted(path for path in listed if path.suffix.casefold() == ".xml")

    def _inventory(self, path: Path) -> "_Inventory | None":
        if path not in self._read:
            self._read[path] = None
            if len(self._read) <= _MAX_FILES and path.is_file():
                size = path.stat().st_size
                if size <= self._left:
                    self._left -= size
                    self._read[path] = _inventory(read_source(path))
        return self._read[path]


@dataclass(frozen=True)
class _Inventory:
    """A StationXML file, and its channels by name."""

    file: Source
    channels: Mapping[str, list[Any]]

    def response(self, name: str, time: datetime) -> InstrumentResponse | None:
        epochs = self.channels.get(".".join(codes_of(name)), [])[:_MAX_EPOCHS]
        channel = next((epoch for epoch in epochs if _is_in_use(epoch, time)), None)
        return None if channel is None else _response(self.file, channel, name)


def codes_of(name: str) -> tuple[str, str, str, str]:
    """Split ``NET.STA.LOC.CHA``; missing codes are empty, and so is a location ``--``."""
    network, station, location, channel = (*name.split("."), "", "", "", "")[:4]
    return network, station, location_code(location), channel


def location_code(value: str) -> str:
    """Return the code of the location of a sensor; two hyphens or blanks mean none."""
    return value.strip(" -")


def metadata_of_codes(name: str) -> Metadata:
    """Return the codes of a channel for the metadata."""
    keys = ("network", "station", "sensor_location")
    return {key: code for key, code in zip(keys, codes_of(name), strict=False) if code}


def check_unit_or_response(source: Source, request: Request) -> None:
    """Refuse the argument unit together with the response of the instrument."""
    if request.unit is not None and request.response is not None:
        found = "the arguments unit and response"
        raise source.refuse(found=found, expected="one of them: accelerations, or counts")


def stated_unit(standard: Any) -> str | None:
    """Return the unit in the metadata that gmprocess calls standard, if there is one."""
    unit: object = standard.get("units") if hasattr(standard, "get") else None
    return unit if isinstance(unit, str) and unit.strip() else None


def check_finite(source: Source, samples: Array) -> None:
    """Refuse samples of a binary file that are not finite."""
    if not np.isfinite(samples).all():
        raise source.refuse(found="samples that are not finite", expected="finite samples")


def find_response(file: Source, name: str, time: datetime) -> InstrumentResponse | None:
    """Find the response of a channel in one StationXML file; None if it has none."""
    inventory = _inventory(file) if len(file.data) <= _LARGEST else None
    return None if inventory is None else inventory.response(name, time)


def _inventory_of(response: str) -> _Inventory:
    file = read_source(response)
    if len(file.data) > _LARGEST:
        size = f"{len(file.data) / 2**20:.3g} MiB"
        expected = f"StationXML of at most {_LARGEST // 2**20} MiB, such as of one station"
        raise file.refuse(found=size, expected=expected)
    inventory = _inventory(file)
    if inventory is None:
        raise file.refuse(found="no StationXML that can be read", expected="StationXML")
    return inventory


def _inventory(file: Source) -> _Inventory | None:
    try:
        etree = importlib.import_module("lxml.etree")
    except ImportError as problem:
        found = "StationXML, and no lxml in this Python"
        expected = "lxml to read it; install it with: pip install 'rockframe[records]'"
        raise file.refuse(found=found, expected=expected) from problem
    # entities are not resolved: no download, and no expansion in memory
    parser = etree.XMLParser(resolve_entities=False, no_network=True)
    try:
        root = etree.fromstring(file.data, parser)
    except (etree.XMLSyntaxError, ValueError):
        return None
    if etree.QName(root).localname != _ROOT:
        return None
    channels: dict[str, list[Any]] = {}
    for network in root.iterfind("{*}Network"):
        for station in network.iterfind("{*}Station"):
            for channel in station.iterfind("{*}Channel"):
                location = location_code(channel.get("locationCode", ""))
                codes = (network.get("code"), station.get("code"), location, channel.get("code"))
                channels.setdefault(".".join(map(str, codes)), []).append(channel)
    return _Inventory(file, channels)


def _response(file: Source, channel: Any, name: str) -> InstrumentResponse | None:
    sensitivity = channel.find(_SENSITIVITY)
    if sensitivity is None:
        return None
    line = int(sensitivity.sourceline)
    units = _text(sensitivity, "{*}InputUnits/{*}Name")
    unit = acceleration_unit(units)
    if unit is None:
        expected = "the response of an accelerometer (input unit M/S**2)"
        found = f"{name} with the input unit {units!r}"
        raise file.refuse(found=found, expected=expected, line=line)
    output = _text(sensitivity, "{*}OutputUnits/{*}Name").casefold()
    value = _number(sensitivity, "{*}Value")
    # some archives omit the unit of the output, or write None; an overall sensitivity is that of
    # the digital output
    counts = "count" in output or output in _NO_CODE
    if not counts or value is None or math.isclose(value, 0.0):
        found = f"{name} with a sensitivity of {_text(sensitivity, '{*}Value')} {output}"
        raise file.refuse(found=found, expected="counts per acceleration, not zero", line=line)
    return InstrumentResponse(value, unit, _orientation(channel), base_name(file.path), file.sha256)


def _is_in_use(channel: Any, time: datetime) -> bool:
    start, end = channel.get("startDate"), channel.get("endDate")
    try:
        return (start is None or _parse_time(start) <= time) and (
            end is None or time <= _parse_time(end)
        )
    except (ValueError, OverflowError):  # no dates
        return False


def _parse_time(text: str) -> datetime:
    moment = datetime.fromisoformat(text.strip()[:_MAX_TEXT_LENGTH])
    return moment if moment.tzinfo is None else moment.astimezone(UTC).replace(tzinfo=None)


def _orientation(channel: Any) -> Orientation:
    azimuth, dip = _number(channel, "{*}Azimuth"), _number(channel, "{*}Dip")
    if dip is None:
        return UNKNOWN
    if dip <= -_MIN_VERTICAL_DIP:
        return Orientation(vertical=UPWARDS)
    if dip >= _MIN_VERTICAL_DIP:
        return Orientation(vertical=DOWNWARDS)
    return (
        azimuth_of(azimuth) if azimuth is not None and abs(dip) <= _MAX_HORIZONTAL_DIP else UNKNOWN
    )


def _text(element: Any, path: str) -> str:
    return str(element.findtext(path) or "").strip()[:_MAX_TEXT_LENGTH]


def _number(element: Any, path: str) -> float | None:
    try:
        value = float(_text(element, path))
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def record_from_counts(
    source: Source,
    request: Request,
    values: Array,
    time_step: float,
    metadata: Metadata,
    response: InstrumentResponse | None,
    missing: tuple[str, str] = _MISSING,
) -> Record:
    """Make the record of one channel of a file that states no unit.

    The counts less their mean are divided by the sensitivity. The response is assumed to be flat,
    as that of an accelerometer is from zero to near its corner frequency. `missing` has the words
    found and expected of the error if there is neither a response nor the argument unit.
    """
    if request.unit is not None and request.unit_name is not None:
        described: Metadata = {**metadata, "unit_as_read": request.unit_name}
        history = (f"the samples taken as accelerations in {request.unit_name}, as requested",)
        return Record(time_step, values, request.unit, described, history)
    if response is None:
        found, expected = missing
        raise source.refuse(found=found, expected=expected)
    offset = float(math.fsum(values) / values.size)
    described = {
        **metadata,
        "unit_as_read": "counts",
        "sensitivity": response.sensitivity,
        "offset_removed": offset,
        "response_file": response.file,
        "response_sha256": response.sha256,
    }
    history = (
        f"counts less their mean of {offset:.9g}, divided by the sensitivity of "
        f"{response.sensitivity:.9g} counts per {response.unit.spelling} ({response.file}); "
        "the response of the instrument is taken as flat",
    )
    return Record(
        time_step, (values - offset) / response.sensitivity, response.unit, described, history
    )
