"""What a frame is built from: the measures of a regular one, or a list of members."""

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Final, TypeAlias

from rockframe.arguments import one_of_words
from rockframe.components.frame_members import Member
from rockframe.components.frame_outline import Outline, outline_cautions
from rockframe.components.frame_regular import INFILL_THICKNESS, SLAB_THICKNESS, RegularFrame
from rockframe.components.shapes.standing import CENTRED
from rockframe.errors import ComponentError, shown
from rockframe.units import LENGTH, MASS, POSITIVE, to_si

_DEFAULTS: Final = {"slab_thickness": SLAB_THICKNESS, "infill_thickness": INFILL_THICKNESS}
_OUTLINE: Final = ("width", "height", "depth")


class CentreOfMass(StrEnum):
    """Where the centre of mass of a frame is taken to be."""

    MEMBERS = "members"
    """Where the members have it."""
    MIDDLE = "middle"
    """In the middle of the outline, as in Eqs. (21) and (22)."""


@dataclass(frozen=True)
class Building:
    """Members, their outline, and the arguments that build them again."""

    members: tuple[Member, ...]
    outline: Outline
    arguments: Mapping[str, float | str]
    taken: CentreOfMass

    @property
    def centre_of_mass(self) -> tuple[float, float]:
        """Coordinates x, y of that of the members, wherever it is taken to be [m]."""
        return self.outline.centre_of_mass(self.members)

    def block_arguments(self, owner: str) -> dict[str, float | str]:
        """Give the arguments of the equivalent block."""
        outline, members = self.outline, self.members
        mass = sum(member.si.mass for member in members)
        arguments: dict[str, float | str] = {
            "width": f"{outline.width!r} {LENGTH.unit}",
            "height": f"{outline.height!r} {LENGTH.unit}",
            "mass": f"{mass!r} {MASS.unit}",
        }
        if self.taken is CentreOfMass.MIDDLE:
            return {**arguments, "shape_factor": outline.shape_factor(members)}
        x, y = self.centre_of_mass
        if abs(x) > CENTRED * outline.width:
            arguments["eccentricity"] = f"{x!r} {LENGTH.unit}"
        about_centre = outline.shape_factor_about_centre(members)
        if math.isinf(about_centre) and math.isfinite(mass):
            msg = f"{owner}: all mass is in one point, so that the building has no inertia"
            raise ComponentError(msg)
        centre_height = f"{y!r} {LENGTH.unit}"
        return {**arguments, "centre_height": centre_height, "shape_factor": about_centre}

    def cautions(self) -> list[str]:
        """Say where the centre of mass is far from where it is taken to be."""
        if self.taken is CentreOfMass.MEMBERS:
            return []
        return outline_cautions(self.outline, self.members)


def building_of(
    members: object, centre_of_mass: object, measures: Mapping[str, Any], owner: str
) -> Building:
    """Build a frame from a list of its members, or a regular one."""
    usual = CentreOfMass.MIDDLE if members is None else CentreOfMass.MEMBERS
    taken = usual
    if centre_of_mass is not None:
        taken = one_of_words(CentreOfMass, centre_of_mass, owner=owner, name="centre_of_mass")
    if members is None:
        found, outline, arguments = regular_members(measures, owner)
    else:
        found, outline, arguments = listed_members(members, measures, owner)
    if taken is not usual:
        arguments["centre_of_mass"] = str(taken)
    outline.check(found, owner)
    return Building(found, outline, arguments, taken)


_Found: TypeAlias = tuple[tuple[Member, ...], Outline, dict[str, float | str]]
"""Members, their outline, and the arguments that give them again."""


def regular_members(measures: Mapping[str, Any], owner: str) -> _Found:
    """Take a regular frame apart."""
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
    return frame.members, Outline(si.width, si.height, si.depth), arguments


def listed_members(members: object, measures: Mapping[str, Any], owner: str) -> _Found:
    """Read a list of members, and the sizes of their building."""
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
    return built, outline, {**arguments, "members": json.dumps(written)}


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
