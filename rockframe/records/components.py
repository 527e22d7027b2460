"""Choice of the component of a file, and its direction; the same for all formats."""

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal, cast

import numpy as np

from rockframe.errors import ComponentError, RecordError
from rockframe.records.numbers import same_start
from rockframe.records.reader import Metadata, Record, Request, Source

UPWARDS: Final = "up"
DOWNWARDS: Final = "down"
VERTICAL: Final = "vertical"

_FULL_CIRCLE: Final = 360.0
_DEGREES: Final = re.compile(r"(\d{1,3}(?:\.\d{0,3})?)\s*(?:deg(?:rees?)?\.?)?", re.ASCII)
_QUADRANT: Final = re.compile(r"([ns])\s*(\d{1,2})\s*([ew])", re.ASCII)
# band code, N for an accelerometer (or L, G, H: a mass or a seismometer), orientation; in some
# files the code of the location of the sensor follows
_SEED_CODE: Final = re.compile(r"[fgdceshbml][nlgh]([nez])(?:[. _-]?(?:\d0|0\d|--))?", re.ASCII)
_NUMBERED: Final = re.compile(r"([a-z-]+?)[. _-]?\d{1,2}", re.ASCII)


@dataclass(frozen=True)
class Orientation:
    """Positive direction of a component."""

    azimuth: float | None = None  # azimuth of a horizontal component, clockwise from north [degree]
    # ``"up"``, ``"down"`` or, if the file does not state which, ``"vertical"``
    vertical: Literal["up", "down", "vertical"] | None = None

    def matches(self, other: "Orientation") -> bool:
        """Tell whether two directions are the same, or both vertical."""
        if self.vertical is not None and other.vertical is not None:
            return True
        if self.azimuth is None or other.azimuth is None:
            return False
        turn = (self.azimuth - other.azimuth) % _FULL_CIRCLE
        return min(turn, _FULL_CIRCLE - turn) < 1e-6

    def reversed(self) -> "Orientation":
        """Return the opposite direction, for a minus before a name; downwards if it is vertical."""
        if self.vertical is not None:
            return Orientation(vertical=DOWNWARDS)
        return self if self.azimuth is None else azimuth_of((self.azimuth + 180.0) % _FULL_CIRCLE)

    def __str__(self) -> str:
        if self.vertical is not None:
            return self.vertical
        return "" if self.azimuth is None else f"{self.azimuth:g}°"


UNKNOWN: Final = Orientation()
_WORDS: Final = {
    **dict.fromkeys(("n", "ns", "n-s", "sn", "north"), Orientation(azimuth=0.0)),
    **dict.fromkeys(("e", "ew", "e-w", "we", "east"), Orientation(azimuth=90.0)),
    **dict.fromkeys(("s", "south"), Orientation(azimuth=180.0)),
    **dict.fromkeys(("w", "west"), Orientation(azimuth=270.0)),
    **dict.fromkeys(
        ("u", "up", "ud", "u-d", "updo", "updn", "updown", "up-down", "z"),
        Orientation(vertical=UPWARDS),
    ),
    **dict.fromkeys(("d", "down", "dwn", "dn"), Orientation(vertical=DOWNWARDS)),
    **dict.fromkeys(("v", "vert", "ver", "vertical", "vrt"), Orientation(vertical=VERTICAL)),
}
"""Directions by the words and letters for them."""


def orientation_of(name: str) -> Orientation:
    """Read a direction from the name of a component.

    Parameters
    ----------
    name : str
        ``N``, ``E-W``, ``UP``, ``V1``, ``090``, ``360 DEG``, ``S16W``, ``HNE``, ``HNZ.00``, ...

    Returns
    -------
    Orientation
        Without azimuth and vertical if the name has no direction.

    Notes
    -----
    Azimuths run clockwise from north; ``S16W`` is 16 degrees from south towards
    west, 196. In a SEED channel code the third letter is the direction, and Z is
    positive upwards (SEED Reference Manual 2.4, appendix A).

    Examples
    --------
    >>> orientation_of("S16W").azimuth, str(orientation_of("UP"))
    (196.0, 'up')
    """
    text = name.strip().casefold()
    if text in _WORDS:
        return _WORDS[text]
    degrees = _DEGREES.fullmatch(text)
    if degrees is not None:
        return azimuth_of(float(degrees.group(1)))
    quadrant = _QUADRANT.fullmatch(text)
    if quadrant is not None:
        from_pole, angle, towards = quadrant.groups()
        turn = float(angle) if (from_pole == "n") == (towards == "e") else -float(angle)
        return azimuth_of(((0.0 if from_pole == "n" else 180.0) + turn) % _FULL_CIRCLE)
    seed = _SEED_CODE.fullmatch(text)
    if seed is not None:
        return orientation_of(seed.group(1))
    numbered = _NUMBERED.fullmatch(text)
    base = text.lstrip("-").strip() if numbered is None else numbered.group(1)
    named = _WORDS.get(base, UNKNOWN)
    if named.vertical not in (UPWARDS, VERTICAL):
        return UNKNOWN
    # a hyphen before the name separates it from another name, or reverses the direction
    return Orientation(vertical=VERTICAL) if text.startswith("-") else named


def azimuth_of(degrees: float) -> Orientation:
    """Return a horizontal direction; unknown if the angle is not from 0 to 360 degrees."""
    if not (math.isfinite(degrees) and 0.0 <= degrees <= _FULL_CIRCLE):
        return UNKNOWN
    return Orientation(azimuth=degrees)


SENSE: Final = "positive"
"""Key of the metadata for the positive direction of a vertical component."""

_CHANNEL: Final = re.compile(r"(?:channel|chan|ch)?\.?\s*#?(\d{1,4})", re.ASCII)
_ROUNDING: Final = 1e-6
_MAX_LISTED: Final = 40


@dataclass(frozen=True)
class FileComponent:
    """A component of a file that is not read yet.

    Parameters
    ----------
    name : str or None
        Name in the file; None if it has no name.
    read : callable
        Function that reads its samples.
    orientation : Orientation
        Positive direction, as far as known.
    channel : int, optional
        Channel number in the file.
    aliases : tuple of str
        Other names of the component.
    line : int, optional
        Line with its name, from 1.

    Examples
    --------
    >>> from rockframe.records import Record, Request, Source, choose_unit
    >>> unit = choose_unit(Source("a.sim", b"SIMPLE", ""), Request(), "gal", None)[0]
    >>> north = FileComponent("N", lambda: Record(0.01, [0.0, 2.0], unit, {}), orientation_of("N"))
    >>> north.label, north.read().samples
    ("'N' (0°)", [0.0, 2.0])
    """

    name: str | None
    read: Callable[[], Record]
    orientation: Orientation = UNKNOWN
    channel: int | None = None
    aliases: tuple[str, ...] = ()
    line: int | None = None

    @property
    def label(self) -> str:
        """Name, channel and direction, for messages."""
        where = "" if self.channel is None else f"channel {self.channel}"
        direction = str(self.orientation)
        details = ", ".join(part for part in (where, direction) if part and part != self.name)
        name = repr(self.name or "")
        return f"{name} ({details})" if details else name


class EveryComponentError(RecordError):
    """All components of a file are requested, not one of them."""

    def __init__(self, path: str, components: Sequence[FileComponent]) -> None:
        self.components = tuple(components)
        super().__init__(
            path, found=_component_list(components), expected="one component at a time"
        )


def requested_components(value: object, *, owner: str) -> tuple[str | None, str | None]:
    """Check the argument ``component``; give the horizontal and the vertical name."""
    if value is None:
        return None, None
    if isinstance(value, str) and value.strip():
        return value, None
    if isinstance(value, tuple | list):
        names = cast("Sequence[object]", value)
        if len(names) == 2 and all(isinstance(name, str) and name.strip() for name in names):
            return str(names[0]), str(names[1])
    msg = (
        f"{owner}: component needs a name such as component='N', or a horizontal and a "
        f"vertical one such as component=('N', 'U'), got {value!r}"
    )
    raise ComponentError(msg)


def choose_component(
    source: Source, request: Request, components: Sequence[FileComponent]
) -> Record:
    """Read the requested component, or the only possible one.

    Parameters
    ----------
    source : Source
        File.
    request : Request
        Arguments of the caller.
    components : sequence of FileComponent
        Components of the file; at least one.

    Returns
    -------
    Record

    Raises
    ------
    RecordError
        There is no such component, there are several, or one of a pair is not horizontal or
        vertical as it must be; also errors of the reader of the component.

    Notes
    -----
    A name is searched among the names in the file, then among the directions, then among the
    channel numbers. Without a name, the only component is read, or the only one that is not
    vertical.

    Examples
    --------
    >>> from rockframe.records import Record, Request, Source, choose_unit
    >>> source, request = Source("a.sim", b"SIMPLE", ""), Request(component="E")
    >>> unit = choose_unit(source, request, "gal", None)[0]
    >>> def component(name, peak):
    ...     record = Record(0.01, [0.0, peak], unit, {})
    ...     return FileComponent(name, lambda: record, orientation_of(name))
    >>> held = [component("N", 1.0), component("E", 2.0)]
    >>> choose_component(source, request, held).samples
    [0.0, 2.0]
    """
    if request.every:
        raise EveryComponentError(source.path, components)
    if request.vertical is not None and len(components) == 1:
        raise source.refuse(
            found=f"one component, {components[0].label}",
            expected="a horizontal and a vertical one; where each has its own file, read both "
            "and join them with with_vertical",
            line=components[0].line,
        )
    chosen = _horizontal_components(source, request, components)
    if request.vertical is None:
        return _single_component(source, request, chosen, components)
    upwards = _find_component(source, request.vertical, components)
    if chosen.orientation.vertical is not None or chosen is upwards:
        raise source.refuse(
            found=f"the component {chosen.label}, requested as the horizontal one",
            expected="a horizontal component first, then the vertical one",
            line=chosen.line,
        )
    if upwards.orientation.vertical is None:
        raise source.refuse(
            found=f"the component {upwards.label}, requested as the vertical one",
            expected="a vertical component",
            line=upwards.line,
        )
    return _with_vertical(source, chosen, upwards)


def read_component_named(source: Source, component: FileComponent) -> Record:
    """Read a component, a vertical one positive upwards, with its name in the metadata."""
    record = _vertical_upwards(source, component.read(), component)
    return replace(record, metadata={**record.metadata, **_metadata_of(component)})


def _horizontal_components(
    source: Source, request: Request, components: Sequence[FileComponent]
) -> FileComponent:
    if request.component is not None:
        return _find_component(source, request.component, components)
    if len(components) == 1:
        return components[0]
    level = [entry for entry in components if entry.orientation.vertical is None]
    if len(level) == 1:
        return level[0]
    raise source.refuse(found=_component_list(components), expected=_example_argument(components))


def _single_component(
    source: Source, request: Request, chosen: FileComponent, components: Sequence[FileComponent]
) -> Record:
    record = chosen.read()
    metadata: Metadata = {**record.metadata, **_metadata_of(chosen)}
    if len(components) > 1:
        names = ", ".join(str(entry.name) for entry in components[:_MAX_LISTED])
        choice = f"component {chosen.name} taken (of {names})"
        record = replace(record, history=(*record.history, choice))
    requested = request.component
    if chosen.orientation.vertical is not None and requested is None:
        words = (
            f"{source.path}: the component {chosen.name} is vertical, and is read as if it "
            f"were horizontal; give component={chosen.name!r} if that is meant, and "
            "use with_vertical to combine it with a horizontal one"
        )
        record = replace(record, warnings=(*record.warnings, words))
    # requested as upwards, not by its name in the file
    by_direction = requested is not None and not _has_name(requested, chosen)
    sense = chosen.orientation.vertical
    if by_direction and orientation_of(requested or "").vertical == UPWARDS:
        record, sense = _vertical_upwards(source, record, chosen), UPWARDS
    if sense is not None:
        metadata[SENSE] = sense
    return replace(record, metadata=metadata)


def _with_vertical(source: Source, across: FileComponent, upwards: FileComponent) -> Record:
    level, raised = across.read(), upwards.read()
    if not math.isclose(level.time_step, raised.time_step, rel_tol=_ROUNDING):
        found = f"time steps of {level.time_step!r} s and {raised.time_step!r} s"
        expected = f"one time step for {across.label} and {upwards.label}"
        raise source.refuse(found=found, expected=expected, line=upwards.line)
    starts = [record.metadata.get("record_time") for record in (level, raised)]
    if not same_start(starts[0], starts[1], level.time_step):
        raise source.refuse(
            found=f"components that start at {starts[0]} and at {starts[1]}",
            expected="one start time for both",
            line=upwards.line,
        )
    turned = _vertical_upwards(source, raised, upwards)
    vertical = turned.samples
    if not math.isclose(raised.unit.factor, level.unit.factor):
        vertical = vertical * (raised.unit.factor / level.unit.factor)
    count = max(level.samples.size, vertical.size)
    steps: list[str] = []
    for label, samples in (("horizontal", level.samples), ("vertical", vertical)):
        if samples.size < count:
            steps.append(f"{label} component padded with {count - samples.size} zeros")
    metadata: Metadata = {
        **level.metadata,
        **_metadata_of(across),
        "vertical_component": upwards.name or "",
    }
    additional = tuple(sentence for sentence in raised.history if sentence not in level.history)
    return replace(
        level,
        samples=np.pad(level.samples, (0, count - level.samples.size)),
        vertical=np.pad(vertical, (0, count - vertical.size)),
        metadata=metadata,
        history=(
            *level.history,
            *(f"vertical component: {sentence}" for sentence in additional),
            f"component {across.name} taken as horizontal, {upwards.name} as vertical",
            *turned.history[len(raised.history) :],
            *steps,
        ),
        warnings=tuple(dict.fromkeys((*level.warnings, *turned.warnings))),
    )


def _vertical_upwards(source: Source, record: Record, component: FileComponent) -> Record:
    """Reverse a vertical component that is positive downwards, and add this to the history."""
    sense = component.orientation.vertical
    if sense == DOWNWARDS:
        sentence = f"component {component.name} turned over: positive upwards"
        return replace(record, samples=-record.samples, history=(*record.history, sentence))
    if sense == VERTICAL:
        words = (
            f"{source.path}: the file does not say whether {component.name} is positive "
            "upwards or downwards; upwards is assumed"
        )
        return replace(record, warnings=(*record.warnings, words))
    return record


def _metadata_of(component: FileComponent) -> Metadata:
    metadata: Metadata = {}
    if component.name is not None:
        metadata["component"] = component.name
    if component.orientation.azimuth is not None:
        metadata["azimuth"] = component.orientation.azimuth
    if component.channel is not None:
        metadata["channel"] = component.channel
    return metadata


def _find_component(
    source: Source, requested: str, components: Sequence[FileComponent]
) -> FileComponent:
    direction = orientation_of(requested)
    number = _CHANNEL.fullmatch(requested.strip().casefold())
    channel = None if number is None else int(number.group(1))
    tiers: tuple[Callable[[FileComponent], bool], ...] = (
        lambda entry: _has_name(requested, entry),
        lambda entry: entry.orientation.matches(direction),
        lambda entry: channel is not None and entry.channel == channel,
    )
    for fits in tiers:
        matching = [entry for entry in components if fits(entry)]
        if len(matching) == 1:
            return matching[0]
        if matching:
            raise source.refuse(
                found=f"{len(matching)} components that match {requested!r}: {_labels(matching)}",
                expected="one; give its channel number",
            )
    raise _missing_component_error(source, requested, components)


def _missing_component_error(
    source: Source, requested: str, components: Sequence[FileComponent]
) -> RecordError:
    expected = f"the component {requested!r}"
    if len(components) > 1:
        return source.refuse(found=_component_list(components), expected=expected)
    only = components[0]
    if only.name is None:
        return source.refuse(found="no name of the component", expected=expected)
    return source.refuse(found=f"the component {only.name!r}", expected=expected, line=only.line)


def _has_name(requested: str, component: FileComponent) -> bool:
    names = [name for name in (component.name, *component.aliases) if name is not None]
    return _normalised_name(requested) in map(_normalised_name, names)


def _normalised_name(name: str) -> str:
    key = name.split("(")[0].strip().casefold()
    return key.lstrip("0") or "0" if key.isdigit() else key


def _labels(components: Sequence[FileComponent]) -> str:
    listed = ", ".join(entry.label for entry in components[:_MAX_LISTED])
    return listed if len(components) <= _MAX_LISTED else f"{listed}, ..."


def _component_list(components: Sequence[FileComponent]) -> str:
    return f"{len(components)} components: {_labels(components)}"


def _example_argument(components: Sequence[FileComponent]) -> str:
    level = [entry for entry in components if entry.orientation.vertical is None]
    upwards = [entry for entry in components if entry.orientation.vertical is not None]
    names = [entry.name for entry in components]
    first = (level or list(components))[0]
    # if names are not unique, only the channel number identifies a component
    unique = names.count(first.name) == 1
    requested = first.name if unique or first.channel is None else f"channel {first.channel}"
    text = f"the argument component, such as component={requested!r}"
    if level and len(upwards) == 1:
        text += f", or component=({requested!r}, {upwards[0].name!r}) with the vertical one"
    return text
