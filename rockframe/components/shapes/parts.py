"""A body put together from parts: their masses, and the base they stand on together."""

from collections.abc import Mapping, Sequence
from typing import Any, cast

from rockframe.components.shapes.masses import combined_mass
from rockframe.components.shapes.part import PlacedPart, read_part
from rockframe.components.shapes.reading import read_place
from rockframe.components.shapes.standing import ROUNDING, ShapedBody, Stance, shaped_body
from rockframe.errors import ComponentError, shown


def body_of_parts(given: object, base: object, owner: str) -> ShapedBody:
    """Find how parts stand that are fixed to one another."""
    parts = _read(given, owner)
    corners = [corner for part in parts for corner in part.corners]
    top = max(part.top for part in parts)
    reach = max(corner.x for corner in corners) - min(corner.x for corner in corners)
    slack = ROUNDING * max(top, reach)
    _check_above(parts, slack, owner)
    on_ground = {
        corner.x: part
        for part in parts
        if part.stands
        for corner in part.corners
        if corner.y <= slack
    }
    if base is None:
        stance = _common_base(parts, sorted(on_ground), slack, owner)
    else:
        stance = _given_base(base, on_ground, slack, owner)
    whole = combined_mass([part.mass for part in parts])
    if not whole.inertia > 0.0:
        msg = f"{owner}: all mass is in one point, so that the body has no inertia"
        raise ComponentError(msg)
    return shaped_body(whole, stance, top, corners, owner)


def _read(given: object, owner: str) -> list[PlacedPart]:
    example = "{'case': {'width': '0.8 m', 'height': '1.9 m', 'mass': '60 kg'}, ...}"
    if not isinstance(given, Mapping) or not given:
        msg = f"{owner}: parts needs a mapping from names to parts, such as {example}; got "
        raise ComponentError(msg + shown(cast("object", given)))
    parts = cast("Mapping[object, object]", given)
    for name, part in parts.items():
        if not isinstance(part, Mapping):
            msg = f"{owner}: part {name!r} needs a mapping, as in {example}; got {shown(part)}"
            raise ComponentError(msg)
    return [
        read_part(str(name), cast("Mapping[str, Any]", part), owner) for name, part in parts.items()
    ]


def _check_above(parts: Sequence[PlacedPart], slack: float, owner: str) -> None:
    for part in parts:
        if part.bottom < -slack:
            msg = (
                f"{owner}: part {part.name!r} reaches {-part.bottom:.6g} m below the ground; "
                "heights count from there"
            )
            raise ComponentError(msg)


def _common_base(
    parts: Sequence[PlacedPart], on_ground: Sequence[float], slack: float, owner: str
) -> Stance:
    """Take the base from the outermost corners at the ground."""
    if not on_ground:
        lowest = min(parts, key=lambda part: part.bottom)
        msg = (
            f"{owner}: no part stands on the ground, at height zero; the lowest, "
            f"{lowest.name!r}, is {lowest.bottom:.6g} m above it. Give base=(left, right), the "
            "ends of the base, if it stands on legs that are no part"
        )
        raise ComponentError(msg)
    if on_ground[-1] - on_ground[0] <= slack:
        msg = (
            f"{owner}: the parts stand on one point, at x = {on_ground[0]:.6g} m; give "
            "base=(left, right), the ends of the base, if there is more"
        )
        raise ComponentError(msg)
    return Stance(on_ground[0], on_ground[-1], 0.0)


def _given_base(
    base: object, on_ground: Mapping[float, PlacedPart], slack: float, owner: str
) -> Stance:
    left, right = read_place(base, owner=owner, name="base")
    if left >= right:
        msg = f"{owner}: base needs its left end and then its right one, got {shown(base)}"
        raise ComponentError(msg)
    for x, part in on_ground.items():
        if not left - slack <= x <= right + slack:
            msg = (
                f"{owner}: part {part.name!r} stands on the ground at x = {x:.6g} m, beyond the "
                f"base, which goes from {left:.6g} m to {right:.6g} m"
            )
            raise ComponentError(msg)
    return Stance(left, right, 0.0)
