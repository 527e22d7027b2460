"""One part of a body: a rectangle, an outline, another body or a point, at its place."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, TypedDict

from rockframe.components.shapes.masses import PlaneMass
from rockframe.components.shapes.outline import outline_mass
from rockframe.components.shapes.reading import Place, Points, read_mass, read_place
from rockframe.components.shapes.standing import OutlineCorner
from rockframe.errors import ComponentError, shown
from rockframe.units import (
    INERTIA,
    LENGTH,
    MASS,
    NOT_NEGATIVE,
    POSITIVE,
    Measure,
    QuantityLike,
    to_si,
)

if TYPE_CHECKING:
    from rockframe.components.block import Block


class Part(TypedDict, total=False):
    """What a part of a body is told by, see :meth:`rockframe.Block.from_parts`."""

    at: Place
    mass: QuantityLike
    density: QuantityLike
    depth: QuantityLike
    width: QuantityLike
    height: QuantityLike
    outline: Points
    body: "Block"
    inertia: QuantityLike


_MASS: Final = ("mass", "density", "depth")
# what tells the kind of a part, and what else may be said of it
_KINDS: Final = {
    "body": ("body", "at"),
    "outline": ("outline", *_MASS, "at"),
    "width": ("width", "height", *_MASS, "at"),
    "height": ("width", "height", *_MASS, "at"),
    "mass": ("mass", "inertia", "at"),
}


@dataclass(frozen=True)
class PlacedPart:
    """Mass, corners and top of a part, in the coordinates of the whole."""

    name: str
    mass: PlaneMass
    corners: tuple[OutlineCorner, ...]
    top: float
    stands: bool = True
    """Whether it may stand on the ground; a point does not."""

    @property
    def bottom(self) -> float:
        """Height of its lowest point [m]."""
        return min(corner.y for corner in self.corners)


def read_part(name: str, given: Mapping[str, Any], owner: str) -> PlacedPart:
    """Read a part."""
    place = f"{owner}: part {name!r}"
    told = {word: value for word, value in given.items() if value is not None}
    kind = next((word for word in _KINDS if word in told), None)
    if kind is None:
        msg = (
            f"{place} needs width and height, an outline, a body, or its mass alone; got "
            f"{', '.join(map(shown, given)) or 'nothing'}"
        )
        raise ComponentError(msg)
    foreign = [word for word in told if word not in _KINDS[kind]]
    if foreign:
        msg = (
            f"{place} has {', '.join(map(shown, foreign))}, which says nothing of a part with "
            f"{shown(kind)}; it is told by {', '.join(_KINDS[kind])}"
        )
        raise ComponentError(msg)
    x, y = (0.0, 0.0) if "at" not in told else read_place(told["at"], owner=place, name="at")
    read = {"body": _body, "outline": _outline, "mass": _point}.get(kind, _rectangle)
    return read(name, told, (x, y), place)


def _rectangle(
    name: str, told: Mapping[str, Any], at: tuple[float, float], owner: str
) -> PlacedPart:
    width, height = (_positive(told, word, LENGTH, owner=owner) for word in ("width", "height"))
    mass = read_mass(told, width * height, owner=owner)
    (x, y), half, top = at, 0.5 * width, at[1] + height
    about = mass * (width * width + height * height) / 12.0
    ends = ((x - half, y), (x + half, y), (x + half, top), (x - half, top))
    words = f"a corner of part {name!r}"
    corners = tuple(OutlineCorner(words, *end) for end in ends)
    return PlacedPart(name, PlaneMass(mass, x, y + 0.5 * height, about), corners, top)


def _outline(name: str, told: Mapping[str, Any], at: tuple[float, float], owner: str) -> PlacedPart:
    mass, corners = outline_mass(told["outline"], told, owner, "outline")
    x, y = at
    moved = tuple(
        OutlineCorner(f"{corner.words} of part {name!r}", corner.x + x, corner.y + y)
        for corner in corners
    )
    there = PlaneMass(mass.mass, mass.x + x, mass.y + y, mass.inertia)
    return PlacedPart(name, there, moved, max(corner.y for corner in moved))


def _body(name: str, told: Mapping[str, Any], at: tuple[float, float], owner: str) -> PlacedPart:
    si = getattr(told["body"], "si", None)
    if not hasattr(si, "centre_height"):
        msg = f"{owner} needs a Block as its body, got {shown(told['body'])}"
        raise ComponentError(msg)
    block: Block = told["body"]
    (x, y), si = at, block.si
    there = PlaneMass(si.mass, x + si.eccentricity, y + si.centre_height, si.inertia)
    words = f"an end of the base of part {name!r}"
    corners = (
        OutlineCorner(words, x - si.half_width, y),
        OutlineCorner(words, x + si.half_width, y),
    )
    return PlacedPart(name, there, corners, y + si.height)


def _point(name: str, told: Mapping[str, Any], at: tuple[float, float], owner: str) -> PlacedPart:
    mass = _positive(told, "mass", MASS, owner=owner)
    about = 0.0
    if "inertia" in told:
        about = to_si(told["inertia"], INERTIA, owner=owner, name="inertia", condition=NOT_NEGATIVE)
    corner = OutlineCorner(f"part {name!r}", *at)
    return PlacedPart(name, PlaneMass(mass, *at, about), (corner,), at[1], stands=False)


def _positive(told: Mapping[str, Any], name: str, measure: Measure, *, owner: str) -> float:
    if name not in told:
        msg = f"{owner} needs width and height; {name} is missing"
        raise ComponentError(msg)
    return to_si(told[name], measure, owner=owner, name=name, condition=POSITIVE)
