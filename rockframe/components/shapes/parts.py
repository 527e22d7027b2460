"""A body composed of parts: their masses and their common base."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypedDict, cast

from rockframe.components.base import Component
from rockframe.components.block_numbers import BlockSI
from rockframe.components.shapes.outline import outline_mass
from rockframe.components.shapes.standing import (
    ROUNDING,
    BaseSegment,
    ComponentType,
    OutlineCorner,
    PlaneMass,
    PointLike,
    PointsLike,
    combined_mass,
    read_mass,
    read_point,
    shaped_body,
)
from rockframe.errors import ComponentError, short_repr
from rockframe.notebook import rectangle
from rockframe.suggestions import with_hints
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


class Part(TypedDict, total=False):
    """Description of a part of a body, see :meth:`rockframe.Block.from_parts`."""

    at: PointLike
    mass: QuantityLike
    density: QuantityLike
    depth: QuantityLike
    width: QuantityLike
    height: QuantityLike
    outline: PointsLike
    body: Component
    inertia: QuantityLike


_MASS: Final = ("mass", "density", "depth")
# the word that determines the kind of a part, and all words for this kind
_KINDS: Final = {
    "body": ("body", "at"),
    "outline": ("outline", *_MASS, "at"),
    "width": ("width", "height", *_MASS, "at"),
    "height": ("width", "height", *_MASS, "at"),
    "mass": ("mass", "inertia", "at"),
}


@dataclass(frozen=True)
class PlacedPart:
    """Mass, corners and top of a part, in the coordinates of the body."""

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


def read_part(name: str, arguments: Mapping[str, Any], owner: str) -> PlacedPart:
    """Read a part."""
    place = f"{owner}: part {name!r}"
    values = {word: value for word, value in arguments.items() if value is not None}
    kind = next((word for word in _KINDS if word in values), None)
    if kind is None:
        msg = (
            f"{place} needs width and height, an outline, a body, or its mass alone; got "
            f"{', '.join(map(short_repr, arguments)) or 'nothing'}"
        )
        raise ComponentError(msg)
    foreign = [word for word in values if word not in _KINDS[kind]]
    if foreign:
        msg = (
            f"{place} has {', '.join(map(short_repr, foreign))}, which a part with "
            f"{short_repr(kind)} does "
            f"not take; expected some of {', '.join(_KINDS[kind])}"
        )
        raise ComponentError(msg)
    x, y = (0.0, 0.0) if "at" not in values else read_point(values["at"], owner=place, name="at")
    read = {"body": _body, "outline": _outline, "mass": _point}.get(kind, _rectangle)
    mass, corners, top = read(values, place)
    return PlacedPart(
        name,
        PlaneMass(mass.mass, mass.x + x, mass.y + y, mass.inertia),
        tuple(OutlineCorner(f"{words}part {name!r}", a + x, b + y) for words, a, b in corners),
        top + y,
        stands=kind != "mass",
    )


_Shape = tuple[PlaneMass, Sequence[tuple[str, float, float]], float]
"""Mass, corners with their names, and height of the top of a part, from its own origin."""


def _rectangle(values: Mapping[str, Any], owner: str) -> _Shape:
    width, height = (_positive(values, word, LENGTH, owner=owner) for word in ("width", "height"))
    mass = read_mass(values, width * height, owner=owner)
    inertia = mass * (width * width + height * height) / 12.0
    corners = [("a corner of ", x, y) for x, y in rectangle(0.5 * width, height)]
    return PlaneMass(mass, 0.0, 0.5 * height, inertia), corners, height


def _outline(values: Mapping[str, Any], owner: str) -> _Shape:
    mass, corners = outline_mass(values["outline"], values, owner, "outline")
    named = [(f"{corner.words} of ", corner.x, corner.y) for corner in corners]
    return mass, named, max(corner.y for corner in corners)


def _body(values: Mapping[str, Any], owner: str) -> _Shape:
    si = getattr(values["body"], "si", None)
    if not isinstance(si, BlockSI):
        msg = f"{owner} needs a Block as its body, got {short_repr(values['body'])}"
        raise ComponentError(msg)
    ends = [("an end of the base of ", x, 0.0) for x in (-si.half_width, si.half_width)]
    return PlaneMass(si.mass, si.eccentricity, si.centre_height, si.inertia), ends, si.height


def _point(values: Mapping[str, Any], owner: str) -> _Shape:
    mass, inertia = _positive(values, "mass", MASS, owner=owner), 0.0
    if "inertia" in values:
        inertia = to_si(
            values["inertia"], INERTIA, owner=owner, name="inertia", condition=NOT_NEGATIVE
        )
    return PlaneMass(mass, 0.0, 0.0, inertia), [("", 0.0, 0.0)], 0.0


def _positive(values: Mapping[str, Any], name: str, measure: Measure, *, owner: str) -> float:
    if name not in values:
        msg = f"{owner} needs width and height; {name} is missing"
        raise ComponentError(msg)
    return to_si(values[name], measure, owner=owner, name=name, condition=POSITIVE)


def _read(value: object, owner: str) -> list[PlacedPart]:
    example = "{'case': {'width': '0.8 m', 'height': '1.9 m', 'mass': '60 kg'}, ...}"
    if not isinstance(value, Mapping) or not value:
        msg = f"{owner}: parts needs a mapping from names to parts, such as {example}; got "
        raise ComponentError(msg + short_repr(cast("object", value)))
    parts = cast("Mapping[object, object]", value)
    for name, part in parts.items():
        if not isinstance(part, Mapping):
            msg = f"{owner}: part {name!r} needs a mapping, as in {example}; got {short_repr(part)}"
            raise ComponentError(msg)
    return [
        read_part(str(name), cast("Mapping[str, Any]", part), owner) for name, part in parts.items()
    ]


def _common_base(
    parts: Sequence[PlacedPart], on_ground: Sequence[float], slack: float, owner: str
) -> BaseSegment:
    """Take the base between the outermost corners on the ground."""
    if not on_ground:
        lowest = min(parts, key=lambda part: part.bottom)
        msg = (
            f"{owner}: no part stands on the ground, at height zero; the lowest, "
            f"{lowest.name!r}, is {lowest.bottom:.6g} m above it. Give base=(left, right), the "
            "ends of the base, if the body stands on legs that are not among the parts"
        )
        raise ComponentError(msg)
    if on_ground[-1] - on_ground[0] <= slack:
        msg = (
            f"{owner}: the parts stand on one point, at x = {on_ground[0]:.6g} m; give "
            "base=(left, right), the ends of the base, if it is wider"
        )
        raise ComponentError(msg)
    return BaseSegment(on_ground[0], on_ground[-1], 0.0)


def _given_base(
    base: object, on_ground: Mapping[float, PlacedPart], slack: float, owner: str
) -> BaseSegment:
    left, right = read_point(base, owner=owner, name="base")
    if left >= right:
        msg = f"{owner}: base needs the left end, then the right end, got {short_repr(base)}"
        raise ComponentError(msg)
    for x, part in on_ground.items():
        if not left - slack <= x <= right + slack:
            msg = (
                f"{owner}: part {part.name!r} stands on the ground at x = {x:.6g} m, beyond the "
                f"base, which extends from {left:.6g} m to {right:.6g} m"
            )
            raise ComponentError(msg)
    return BaseSegment(left, right, 0.0)


@with_hints()
def from_parts(
    cls: type[ComponentType], parts: Mapping[str, Part], *, base: PointLike | None = None
) -> ComponentType:
    """Build a body from parts that are fixed to one another, such as a cabinet and its load.

    Parameters
    ----------
    parts : mapping of str to mapping
        The parts by name, each described by one of

        - ``width`` and ``height``, for a rectangle, with its mass;
        - ``outline``, as the points of :meth:`from_outline`, with its mass;
        - ``body``, another Block, with its own mass, centre of mass and inertia;
        - ``mass`` alone for a point, or with ``inertia`` about its centre of mass.

        The mass is ``mass``, or ``density`` with ``depth``. The position ``at=(x, y)`` is that
        of the middle of the lower edge of a rectangle or of the base of a body, of the origin
        of an outline, or of a point. x is positive to the right, y upwards from the ground;
        both are zero unless given.
    base : pair of str or Quantity, optional
        x of the left and of the right end of the base, if this differs from the parts, for
        example on legs; unless given, the base extends from the leftmost to the rightmost
        corner on the ground [m].

    Returns
    -------
    Block

    Raises
    ------
    UnitsError
        A value has no unit, or one of the wrong kind.
    ComponentError
        A part is not described as above, reaches below the ground or stands beyond the base;
        none stands on the ground and no base is given; the centre of mass is not above the
        base; or as for :class:`Block`.

    Warns
    -----
    ModelWarning
        A corner of a part beyond the base would touch the ground before the body
        overturns; the model ignores this contact.

    Notes
    -----
    Masses add up by :eq:`eq-parts-centre` and :eq:`eq-parts-inertia`. Parts may overlap, as
    books stand within a bookcase; this is not checked. Only base and height of a ``body`` are
    known, not its outline.

    Examples
    --------
    >>> from rockframe import Block
    >>> bookcase = Block.from_parts(
    ...     {
    ...         "case": {"width": "0.8 m", "height": "1.9 m", "mass": "40 kg"},
    ...         "books": {
    ...             "width": "0.4 m",
    ...             "height": "0.3 m",
    ...             "mass": "25 kg",
    ...             "at": ("0.15 m", "1.5 m"),
    ...         },
    ...         "clock": {"mass": "5 kg", "at": ("-0.3 m", "1.9 m")},
    ...     }
    ... )
    >>> print(f"{bookcase.centre_height:.4f}, {bookcase.eccentricity:.4f}")
    1.2679 meter, 0.0321 meter
    """
    owner = f"{cls.__name__}.from_parts"
    placed = _read(parts, owner)
    corners = [corner for part in placed for corner in part.corners]
    top = max(part.top for part in placed)
    reach = max(corner.x for corner in corners) - min(corner.x for corner in corners)
    slack = ROUNDING * max(top, reach)
    for part in placed:
        if part.bottom < -slack:
            msg = (
                f"{owner}: part {part.name!r} reaches {-part.bottom:.6g} m below the ground, "
                "from which heights are measured"
            )
            raise ComponentError(msg)
    on_ground = {
        corner.x: part
        for part in placed
        if part.stands
        for corner in part.corners
        if corner.y <= slack
    }
    if base is None:
        stance = _common_base(placed, sorted(on_ground), slack, owner)
    else:
        stance = _given_base(base, on_ground, slack, owner)
    body_mass = combined_mass([part.mass for part in placed])
    if not body_mass.inertia > 0.0:
        msg = f"{owner}: all mass is in one point, so that the body has no inertia"
        raise ComponentError(msg)
    return shaped_body(cls, body_mass, stance, top, corners, owner)
