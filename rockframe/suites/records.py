"""Which components were recorded together, and which of them is H1, H2 or V."""

import math
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from rockframe.errors import ComponentError
from rockframe.motion import GroundMotion
from rockframe.motion.pair import HorizontalPair
from rockframe.motion.value import replaced
from rockframe.records import epoch_seconds

FIRST: Final = "H1"
SECOND: Final = "H2"
VERTICAL: Final = "V"
HORIZONTAL: Final = (FIRST, SECOND)

_SUITE_METADATA: Final = ("record", "axis")
_RSN: Final = re.compile(r"RSN(\d{1,6})_", re.IGNORECASE)
_EVENT_TIME_KEYS: Final = ("event_time", "date")
_START_KEY: Final = "record_time"
_STATION_KEYS: Final = ("network", "station", "sensor_location")
# band and instrument of a SEED channel, such as HN of HNE
_INSTRUMENT: Final = re.compile(r"(?:^|\.)([FGDCESHBML][NLGH])[A-Z0-9](?:\s|$)")


@dataclass
class RecordedComponent:
    """A component that was read and is to be put into a suite."""

    label: str  # its label in the suite
    motion: GroundMotion  # as it was read
    vertical: bool  # whether it is vertical
    file: str  # path of its file
    number: int  # of its file, among those that were read: paths of files in memory are alike
    # other metadata; added to
    added_metadata: dict[str, str | float | int] = field(default_factory=dict)

    @property
    def metadata(self) -> dict[str, Any]:
        """Metadata from the file and other sources."""
        chosen = {
            name: self.added_metadata[name]
            for name in _SUITE_METADATA
            if name in self.added_metadata
        }
        return {**self.added_metadata, **self.motion.metadata, **chosen}

    def with_metadata(self) -> GroundMotion:
        """Return the motion with its label and all metadata."""
        return replaced(self.motion, name=self.label, metadata=self.metadata)


def sequence_number_of(file: str) -> int | None:
    """Return the record sequence number that PEER writes before the names of its files."""
    match = _RSN.match(file)
    return None if match is None else int(match.group(1))


def assign_records(components: Iterable[RecordedComponent]) -> list[str]:
    """Find for each component with which others it was recorded, and along which axis.

    Components belong together if they have the same record sequence number, or the same station and
    earthquake (or times that overlap), or come from one file. Then there may be two horizontal
    ones, at a right angle, and a vertical one; if there are more, those of one instrument and one
    processing are used. H1 and H2 are in the order in which they were read, unless a table states
    it.
    """
    listed = list(components)
    remarks: list[str] = []
    names: set[str] = set()
    unpaired: list[RecordedComponent] = []
    for members in _group_by(listed, _group_key):
        for part in [members] if _fits_one_record(members) else _group_by(members, _instrument):
            record = unique = _record_name(part[0])
            if record in names:
                unique = f"{record}, {' '.join(_instrument(part[0]))}".rstrip(", ")
            count = 1
            while unique in names:
                count += 1
                unique = f"{record} ({count})"
            names.add(unique)
            for component in part:
                component.added_metadata["record"] = unique
            remarks += _assign(unique, part)
            horizontal = [component for component in part if not component.vertical]
            unpaired += horizontal if len(horizontal) == 1 else []
    for members in _group_by(unpaired, _event_and_station):
        remarks += _unpaired_remarks(members)
    return remarks


def pairs_of(
    motions: Mapping[str, GroundMotion], verticals: Mapping[str, GroundMotion]
) -> dict[str, HorizontalPair]:
    """Put the components of each record together."""
    axes: dict[str, dict[str, GroundMotion]] = {}
    for motion in (*motions.values(), *verticals.values()):
        metadata = motion.metadata
        axes.setdefault(str(metadata.get("record", "")), {})[str(metadata.get("axis", ""))] = motion
    return {
        record: HorizontalPair(held[FIRST], held[SECOND], held.get(VERTICAL))
        for record, held in axes.items()
        if record and all(axis in held for axis in HORIZONTAL)
    }


def _group_by(
    components: Iterable[RecordedComponent], key: Callable[[RecordedComponent], tuple[str, ...]]
) -> list[list[RecordedComponent]]:
    """Group components by a key, and those of known start times by overlapping times."""
    groups: dict[tuple[str, ...], list[RecordedComponent]] = {}
    for component in components:
        groups.setdefault(key(component), []).append(component)
    return [part for members in groups.values() for part in _split_by_time(members)]


def _split_by_time(members: list[RecordedComponent]) -> list[list[RecordedComponent]]:
    starts = [_start(member) for member in members]
    known = [start for start in starts if start is not None]
    if len(known) < len(members):
        return [members]
    parts: list[list[RecordedComponent]] = []
    end = -math.inf
    for start, place in sorted(zip(known, range(len(members)), strict=True)):
        if start > end:
            parts.append([])
            end = start
        parts[-1].append(members[place])
        end = max(end, start + members[place].motion.si.duration)
    for part in parts:
        part.sort(key=members.index)
    return sorted(parts, key=lambda part: members.index(part[0]))


def _start(component: RecordedComponent) -> float | None:
    """Return the start time of a component whose earthquake is not known [s], else None."""
    metadata = component.metadata
    if not _named_by_station(metadata) or any(metadata.get(key) for key in _EVENT_TIME_KEYS):
        return None
    return epoch_seconds(metadata.get(_START_KEY))


def _named_by_station(metadata: Mapping[str, Any]) -> bool:
    station = metadata.get("station") or metadata.get("station_name")
    return bool(station) and "record_sequence_number" not in metadata


def _group_key(component: RecordedComponent) -> tuple[str, ...]:
    """Return the metadata common to components that belong together."""
    metadata = component.metadata
    if "record_sequence_number" in metadata or _named_by_station(metadata):
        return _record_key(component)
    # files in two folders may have one name
    return (str(component.number),)


def _record_key(component: RecordedComponent) -> tuple[str, ...]:
    metadata = component.metadata
    if "record_sequence_number" in metadata:
        return (f"RSN{metadata['record_sequence_number']}",)
    if not _named_by_station(metadata):
        return (component.file.replace("\\", "/").rsplit("/", 1)[-1],)
    where = [metadata[key] for key in _STATION_KEYS if metadata.get(key)] or [
        metadata["station_name"]
    ]
    return (*_event(component), *map(str, where))


def _record_name(component: RecordedComponent) -> str:
    start = [] if _start(component) is None else [str(component.metadata[_START_KEY])]
    return ", ".join((*start, *_record_key(component)))


def _event(component: RecordedComponent) -> tuple[str, ...]:
    metadata = component.metadata
    when = next((metadata[key] for key in _EVENT_TIME_KEYS if metadata.get(key)), None)
    if when is None and _start(component) is None:
        when = metadata.get(_START_KEY)
    event = str(metadata.get("event", ""))
    parts = [event, "" if str(when) in event else when]
    return tuple(str(part) for part in parts if part)


def _event_and_station(component: RecordedComponent) -> tuple[str, ...]:
    metadata = component.metadata
    if not _named_by_station(metadata):
        return _group_key(component)
    station = metadata.get("station") or metadata.get("station_name")
    return (*_event(component), str(metadata.get("network", "")), str(station))


def _instrument(component: RecordedComponent) -> tuple[str, ...]:
    """Return the codes of band and instrument, and the processing, as far as they are known."""
    metadata = component.metadata
    match = _INSTRUMENT.search(str(metadata.get("component", "")))
    return ("" if match is None else match.group(1), str(metadata.get("processing", "")))


def _fits_one_record(members: list[RecordedComponent]) -> bool:
    verticals = sum(member.vertical for member in members)
    return verticals <= 1 and len(members) - verticals <= len(HORIZONTAL)


def _unpaired_remarks(members: list[RecordedComponent]) -> list[str]:
    """Return in words why components of one station and time are no pair."""
    if len(members) < len(HORIZONTAL):
        return []
    statements = {
        "sensor locations": [str(member.metadata.get("sensor_location", "")) for member in members],
        "instruments or processings": [" ".join(_instrument(member)).strip() for member in members],
    }
    apart = "; ".join(
        f"{quantity} {', '.join(repr(value) for value in values)}"
        for quantity, values in statements.items()
        if len(set(values)) > 1
    )
    labels = ", ".join(member.label for member in members)
    return [f"{labels}: of one station and time, but not put together ({apart})"]


def _assign(record: str, members: list[RecordedComponent]) -> list[str]:
    horizontal = [component for component in members if not component.vertical]
    verticals = [component for component in members if component.vertical]
    for vertical in verticals:
        vertical.added_metadata["axis"] = VERTICAL
    if not _fits_one_record(members):
        for component in horizontal:
            component.added_metadata.pop("axis", None)
        for vertical in verticals:
            vertical.added_metadata["record"] = vertical.label
        counts = f"{len(horizontal)} horizontal and {len(verticals)} vertical components"
        return [f"{record}: {counts}, which are not put together"]
    axes = sorted(str(component.added_metadata.get("axis", "")) for component in horizontal)
    if axes != list(HORIZONTAL):
        for component, axis in zip(horizontal, HORIZONTAL, strict=False):
            component.added_metadata["axis"] = axis
    if len(horizontal) < len(HORIZONTAL):
        return []
    first, second = horizontal
    try:
        HorizontalPair(first.motion, second.motion)
    except ComponentError as problem:
        for component in horizontal:
            component.added_metadata.pop("axis", None)
        return [f"{record}: {problem}"]
    try:
        HorizontalPair(first.motion, second.motion, *(vertical.motion for vertical in verticals))
    except ComponentError as problem:
        for vertical in verticals:
            vertical.added_metadata["record"] = vertical.label
        return [f"{record}, without its vertical component: {problem}"]
    return []
