"""What a frame is built from: the measures of a regular one, or a list of members."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final

from rockframe.components.frame_members import Member
from rockframe.components.frame_outline import Outline
from rockframe.components.frame_regular import INFILL_THICKNESS, SLAB_THICKNESS, RegularFrame
from rockframe.errors import ComponentError, shown
from rockframe.units import LENGTH, POSITIVE, to_si

_DEFAULTS: Final = {"slab_thickness": SLAB_THICKNESS, "infill_thickness": INFILL_THICKNESS}
_OUTLINE: Final = ("width", "height", "depth")


@dataclass(frozen=True)
class Building:
    """Members, their outline, and the arguments that build them again."""

    members: tuple[Member, ...]
    outline: Outline
    arguments: Mapping[str, float | str]

    @property
    def centre_of_mass(self) -> tuple[float, float]:
        """Coordinates x, y [m]."""
        return self.outline.centre_of_mass(self.members)


def regular_building(measures: Mapping[str, Any], owner: str) -> Building:
    """Build a regular frame.

    Parameters
    ----------
    measures : mapping
        Arguments of :class:`RegularFrame`; None for those not given.
    owner : str
        For the message.

    Returns
    -------
    Building

    Raises
    ------
    UnitsError, ComponentError
        As for :class:`RegularFrame`.
    """
    needed = ["column_width", "beam_height", "beam_width", "density"]
    if measures.get("storey_heights") is None:
        needed = ["storeys", "height", *needed]
    missing = [name for name in needed if measures.get(name) is None]
    if missing:
        msg = (
            f"{owner}: give members, or the measures of a regular frame, of which "
            f"{', '.join(missing)} {'is' if len(missing) == 1 else 'are'} missing"
        )
        raise ComponentError(msg)
    frame = RegularFrame(**measures)
    si = frame.si
    arguments = {name: value for name, value in frame.to_dict().items() if name != "type"}
    return Building(frame.members, Outline(si.width, si.height, si.depth), arguments)


def listed_building(members: object, measures: Mapping[str, Any], owner: str) -> Building:
    """Build a frame from a list of its members.

    Parameters
    ----------
    members : iterable of Member or of mappings
        All members.
    measures : mapping
        Width, height and perhaps depth; None for all others.
    owner : str
        For the message.

    Returns
    -------
    Building

    Raises
    ------
    UnitsError, ComponentError
        As for :class:`Member` and :class:`FrameEquivalent`.
    """
    foreign = [
        name
        for name, value in measures.items()
        if name not in _OUTLINE
        and value is not None
        and not (isinstance(value, str) and value == _DEFAULTS.get(name))
    ]
    if foreign:
        msg = f"{owner}: give members or {', '.join(foreign)}, not both; members need none of them"
        raise ComponentError(msg)
    if measures.get("height") is None:
        msg = f"{owner}: members need the height of the building; it is missing"
        raise ComponentError(msg)

    def length(name: str) -> float:
        return to_si(measures.get(name), LENGTH, owner=owner, name=name, condition=POSITIVE)

    depth = None if measures.get("depth") is None else length("depth")
    outline = Outline(length("width"), length("height"), depth)
    if isinstance(members, str | Member | Mapping) or not isinstance(members, Iterable):
        msg = f"{owner}: members must be a list of Member, got {shown(members)}"
        raise ComponentError(msg)
    built = tuple(_member(entry, k, owner) for k, entry in enumerate(members))
    written = [
        {word: value for word, value in member.to_dict().items() if word != "type"}
        for member in built
    ]
    arguments = {name: f"{value!r} {LENGTH.unit}" for name, value in vars(outline).items() if value}
    return Building(built, outline, {**arguments, "members": json.dumps(written)})


def _member(entry: object, number: int, owner: str) -> Member:
    if isinstance(entry, Member):
        return entry
    if not isinstance(entry, Mapping):
        msg = f"{owner}: members[{number}] must be a Member or a mapping, got {shown(entry)}"
        raise ComponentError(msg)
    arguments = {str(name): value for name, value in entry.items()}
    if arguments.get("type") == Member.__name__:
        del arguments["type"]
    try:
        return Member(**arguments)
    except TypeError as problem:
        msg = (
            f"{owner}: members[{number}] does not describe a Member: {problem}; got {shown(entry)}"
        )
        raise ComponentError(msg) from problem
