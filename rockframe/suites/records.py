"""Which components were recorded together, and which of them is H1, H2 or V."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from rockframe.errors import ComponentError
from rockframe.motion import GroundMotion
from rockframe.motion.pair import HorizontalPair

FIRST: Final = "H1"
SECOND: Final = "H2"
VERTICAL: Final = "V"
HORIZONTAL: Final = (FIRST, SECOND)

_OF_THE_SUITE: Final = ("record", "axis")
_RSN: Final = re.compile(r"RSN(\d{1,6})_", re.IGNORECASE)
_WHEN: Final = ("event_time", "date", "record_time")


@dataclass
class Component:
    """A component that was read, on its way into a suite.

    Parameters
    ----------
    label : str
        What it will be called.
    motion : GroundMotion
        As it was read.
    vertical : bool
        Whether it is vertical.
    file : str
        Path of its file, for messages.
    known : dict
        What is known of it besides; added to.
    """

    label: str
    motion: GroundMotion
    vertical: bool
    file: str
    known: dict[str, str | float | int] = field(default_factory=dict)

    @property
    def about(self) -> dict[str, Any]:
        """What the file and other sources tell."""
        own = {name: self.known[name] for name in _OF_THE_SUITE if name in self.known}
        return {**self.known, **self.motion.metadata, **own}

    def finished(self) -> GroundMotion:
        """Give the motion with its label and all that is known."""
        one = self.motion
        return GroundMotion(
            one.si, name=self.label, metadata=self.about, history=one.history, recipe=one.recipe
        )


def number_in_name(file: str) -> int | None:
    """Give the record sequence number that PEER writes before the names of its files."""
    found = _RSN.match(file)
    return None if found is None else int(found.group(1))


def assign_records(components: Iterable[Component]) -> list[str]:
    """Say of each component with which others it was recorded, and along which axis.

    Parameters
    ----------
    components : iterable of Component
        In order; ``record`` and ``axis`` are added to what is known of them.

    Returns
    -------
    list of str
        Why components that belong together do not make a pair.

    Notes
    -----
    Components belong together if they have the same record sequence number, or the same station
    and earthquake (or time), or come from one file. Then there may be two horizontal ones, at a
    right angle, and a vertical one; H1 and H2 are in the order in which they were read, unless
    a table tells.
    """
    together: dict[str, list[Component]] = {}
    for component in components:
        together.setdefault(_record_of(component), []).append(component)
    remarks: list[str] = []
    for record, members in together.items():
        for component in members:
            component.known["record"] = record
        remarks += _assign(record, members)
    return remarks


def pairs_of(
    motions: Mapping[str, GroundMotion], verticals: Mapping[str, GroundMotion]
) -> dict[str, HorizontalPair]:
    """Put the components of each record together.

    Parameters
    ----------
    motions, verticals : mapping of str to GroundMotion
        With ``record`` and ``axis`` in their metadata.

    Returns
    -------
    dict of str to HorizontalPair
        By the names of the records, where both horizontal components are there.
    """
    axes: dict[str, dict[str, GroundMotion]] = {}
    for motion in (*motions.values(), *verticals.values()):
        about = motion.metadata
        axes.setdefault(str(about.get("record", "")), {})[str(about.get("axis", ""))] = motion
    return {
        record: HorizontalPair(held[FIRST], held[SECOND], held.get(VERTICAL))
        for record, held in axes.items()
        if record and all(axis in held for axis in HORIZONTAL)
    }


def _record_of(component: Component) -> str:
    about = component.about
    if "record_sequence_number" in about:
        return f"RSN{about['record_sequence_number']}"
    station = about.get("station") or about.get("station_name")
    if not station:
        # all components of one file have its path
        return component.file.replace("\\", "/").rsplit("/", 1)[-1]
    where = [about[key] for key in ("network", "station", "sensor_location") if about.get(key)]
    when = next((about[key] for key in _WHEN if about.get(key)), None)
    event = str(about.get("event", ""))
    told = [event, "" if str(when) in event else when, *(where or [station])]
    return ", ".join(str(part) for part in told if part)


def _assign(record: str, members: list[Component]) -> list[str]:
    level = [one for one in members if not one.vertical]
    upwards = [one for one in members if one.vertical]
    for one in upwards:
        one.known["axis"] = VERTICAL
    if len(level) > len(HORIZONTAL) or len(upwards) > 1:
        for one in level:
            one.known.pop("axis", None)
        found = f"{len(level)} horizontal and {len(upwards)} vertical components"
        return [f"{record}: {found}, which are not put together"]
    told = sorted(str(one.known.get("axis", "")) for one in level)
    if told != list(HORIZONTAL):
        for one, axis in zip(level, HORIZONTAL, strict=False):
            one.known["axis"] = axis
    if len(level) < len(HORIZONTAL):
        return []
    try:
        first, second = level
        HorizontalPair(first.motion, second.motion, *(one.motion for one in upwards))
    except ComponentError as problem:
        for one in level:
            one.known.pop("axis", None)
        return [f"{record}: {problem}"]
    return []
