"""The building of a frame, from the dimensions of a regular one or from a list of members.

It has mass, inertia, shape factor and space proportion of its members.
"""

import json
import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Final

from rockframe.arguments import checked_choice, is_iterable
from rockframe.components.base import Component
from rockframe.components.frame_members import Member, MemberSI
from rockframe.components.frame_regular import INFILL_THICKNESS, SLAB_THICKNESS, RegularFrame
from rockframe.components.shapes.standing import (
    MIN_ECCENTRICITY,
    centre_of_mass,
    mass_weighted_mean,
)
from rockframe.errors import ComponentError, short_repr
from rockframe.units import INERTIA, LENGTH, MASS, POSITIVE, quantity_text, to_si

_ROUNDING: Final = 1e-9  # relative to the outline
_MAX_OFFSET: Final = 0.1  # offset of the centre of mass over the outline that causes a warning
_REMEDY: Final = "centre_of_mass='members' uses its real position"


class CentreOfMass(StrEnum):
    """Assumed position of the centre of mass of a frame."""

    MEMBERS = "members"
    """Centre of mass of the members."""
    MIDDLE = "middle"
    """Middle of the outline, as in Eqs. (21) and (22)."""


@dataclass(frozen=True, kw_only=True)
class Building:
    """Members in a building of some outer dimensions [m], and its arguments."""

    members: tuple[Member, ...]
    width: float
    height: float
    depth: float | None  # None if it is unknown
    arguments: dict[str, float | str]
    assumed_centre: CentreOfMass

    @property
    def radius(self) -> float:
        """R0, from the middle to a corner [m]."""
        return 0.5 * math.hypot(self.width, self.height)

    @property
    def middle(self) -> tuple[float, float]:
        """O, the middle of the outline: coordinates x, y [m]."""
        return 0.0, 0.5 * self.height

    @property
    def centre_of_mass(self) -> tuple[float, float]:
        """Coordinates x, y of the centre of mass of the members, also with "middle" [m]."""
        return centre_of_mass([member.si for member in self.members])

    @property
    def space_proportion(self) -> float | None:
        """Chi of :eq:`eq-frame-space-proportion`; None if a volume is unknown [1]."""
        shares = list[float]()
        for si in (member.si for member in self.members):
            if self.depth is None or si.width is None or si.height is None or si.depth is None:
                return None
            shares.append(
                (si.width / self.width) * (si.height / self.height) * (si.depth / self.depth)
            )
        return math.fsum(shares)

    def shape_factor(self, point: tuple[float, float], radius: float) -> float:
        """Shape factor for inertia about a point and a radius, by :eq:`eq-frame-mean` [1]."""
        inverse = mass_weighted_mean(
            [member.si for member in self.members],
            lambda si: _mean_square_distance(si, point, radius),
        )
        return 1.0 / inverse if inverse > 0.0 else math.inf

    def block_arguments(self, owner: str) -> dict[str, float | str]:
        """Return the arguments of the equivalent block."""
        mass = sum(member.si.mass for member in self.members)
        arguments: dict[str, float | str] = {
            "width": quantity_text(self.width, LENGTH),
            "height": quantity_text(self.height, LENGTH),
            "mass": quantity_text(mass, MASS),
        }
        if self.assumed_centre is CentreOfMass.MIDDLE:  # eq-frame-shape-factor
            # members may exceed the outline by rounding
            mu = max(1.0, self.shape_factor(self.middle, self.radius))
            return {**arguments, "shape_factor": mu}
        x, y = self.centre_of_mass
        if abs(x) > MIN_ECCENTRICITY * self.width:
            arguments["eccentricity"] = quantity_text(x, LENGTH)
        # eq-frame-about-centre
        about_centre = self.shape_factor((x, y), math.hypot(0.5 * self.width, y))
        if math.isinf(about_centre) and math.isfinite(mass):
            msg = f"{owner}: all mass is in one point, so that the building has no inertia"
            raise ComponentError(msg)
        centre_height = quantity_text(y, LENGTH)
        return {**arguments, "centre_height": centre_height, "shape_factor": about_centre}

    def cautions(self) -> list[str]:
        """Warn of a centre of mass far from its assumed position."""
        if self.assumed_centre is CentreOfMass.MEMBERS:
            return []
        x, y = self.centre_of_mass
        beside, above = x / self.width, y / self.height - 0.5
        cautions: list[str] = []
        if abs(above) > _MAX_OFFSET:
            cautions.append(
                f"the centre of mass lies {y:.4g} m above the base, at {0.5 + above:.3g} of the "
                "height; the model assumes half the height, and an overturning angle of "
                f"{math.atan2(self.width, self.height):.4g} rad instead of "
                f"{math.atan2(0.5 * self.width, y):.4g} rad; {_REMEDY}"
            )
        if abs(beside) > _MAX_OFFSET:
            cautions.append(
                f"the centre of mass lies {abs(x):.4g} m {'right' if x > 0.0 else 'left'} of the "
                f"middle of a base of {self.width:.4g} m; the model assumes the middle; "
                f"{_REMEDY}"
            )
        return cautions

    def check(self, owner: str) -> None:
        """Refuse members that do not form a building within this outline."""
        members = self.members
        if not 0.0 < self.radius < math.inf:
            msg = f"{owner}: {self.width} m by {self.height} m is not the size of a building"
            raise ComponentError(msg)
        if not members:
            msg = f"{owner}: members is empty; at least one is needed"
            raise ComponentError(msg)
        twice = [name for name, n in Counter(member.name for member in members).items() if n > 1]
        if twice:
            msg = f"{owner}: members need different names, got twice: {', '.join(twice)}"
            raise ComponentError(msg)
        for member in members:
            self._check_within(member, owner)
        chi = self.space_proportion
        if chi is not None and chi > 1.0 + _ROUNDING:
            msg = (
                f"{owner}: the members together fill {chi:.4g} times the building of "
                f"{self.width:.6g} m by {self.depth:.6g} m by {self.height:.6g} m; do they overlap?"
            )
            raise ComponentError(msg)
        if not any(
            _mean_square_distance(member.si, self.middle, self.radius) for member in members
        ):
            msg = f"{owner}: all mass is in the middle of the building, so that it has no inertia"
            raise ComponentError(msg)

    def _check_within(self, member: Member, owner: str) -> None:
        si = member.si
        half_width, half_height = 0.5 * (si.width or 0.0), 0.5 * (si.height or 0.0)
        ends = {
            "x": (si.x - half_width, si.x + half_width, -0.5 * self.width, 0.5 * self.width),
            "y": (si.y - half_height, si.y + half_height, 0.0, self.height),
        }
        for axis, (low, high, bottom, top) in ends.items():
            slack = _ROUNDING * (top - bottom)
            if low < bottom - slack or high > top + slack:
                msg = (
                    f"{owner}: member {member.name!r} reaches from {axis} = {low:.6g} m to "
                    f"{high:.6g} m, beyond the building, which extends from {bottom:.6g} m to "
                    f"{top:.6g} m"
                )
                raise ComponentError(msg)
        if (si.depth or 0.0) > (self.depth or math.inf) * (1.0 + _ROUNDING):
            msg = (
                f"{owner}: member {member.name!r} has a depth of {si.depth:.6g} m, more than the "
                f"building's {self.depth:.6g} m"
            )
            raise ComponentError(msg)
        if _mean_square_distance(si, self.middle, self.radius) > 1.0 + _ROUNDING:
            distance = si.distance(self.height)
            largest = si.mass * (self.radius - distance) * (self.radius + distance)
            msg = (
                f"{owner}: member {member.name!r} has an inertia of {si.inertia:.6g} "
                f"{INERTIA.unit}; with its mass and position at most {largest:.6g} "
                f"{INERTIA.unit} fit into the building"
            )
            raise ComponentError(msg)


def _mean_square_distance(si: MemberSI, point: tuple[float, float], radius: float) -> float:
    """Return the mean square distance of a member's mass from a point, over a radius squared."""
    if si.width is None or si.height is None:
        own = si.inertia / si.mass / radius / radius
    else:
        own = (math.hypot(si.width, si.height) / radius) ** 2 / 12.0
    return own + (math.hypot(si.x - point[0], si.y - point[1]) / radius) ** 2


_DEFAULTS: Final = {"slab_thickness": SLAB_THICKNESS, "infill_thickness": INFILL_THICKNESS}
_OUTLINE: Final = ("width", "height", "depth")


def make_building(
    members: object, centre_of_mass: object, dimensions: Mapping[str, Any], owner: str
) -> Building:
    """Make a building from a list of members, or from the dimensions of a regular frame."""
    default = CentreOfMass.MIDDLE if members is None else CentreOfMass.MEMBERS
    assumed_centre = default
    if centre_of_mass is not None:
        assumed_centre = checked_choice(
            CentreOfMass, centre_of_mass, owner=owner, name="centre_of_mass"
        )
    arguments: dict[str, float | str]
    if members is None:
        frame = _regular_frame(dimensions, owner)
        width, height, depth = frame.si.width, frame.si.height, frame.si.depth
        built, arguments = frame.members, _without_type(frame)
    else:
        width, height, depth = _outer_sizes(dimensions, owner)
        if isinstance(members, str | Member | Mapping) or not is_iterable(members):
            msg = f"{owner}: members must be a list of Member, got {short_repr(members)}"
            raise ComponentError(msg)
        built = tuple(_member(entry, k, owner) for k, entry in enumerate(members))
        sizes = {"width": width, "height": height, "depth": depth}
        arguments = {name: quantity_text(value, LENGTH) for name, value in sizes.items() if value}
        arguments["members"] = json.dumps([_without_type(member) for member in built])
    if assumed_centre is not default:
        arguments["centre_of_mass"] = str(assumed_centre)
    building = Building(
        members=built, width=width, height=height, depth=depth, arguments=arguments,
        assumed_centre=assumed_centre,
    )  # fmt: skip
    building.check(owner)
    return building


def _without_type(part: Component) -> dict[str, float | str]:
    """Return the description of a part without its class."""
    return {name: value for name, value in part.to_dict().items() if name != "type"}


def _regular_frame(dimensions: Mapping[str, Any], owner: str) -> RegularFrame:
    """Make a regular frame; refuse one whose dimensions are not complete."""
    needed = ["column_width", "beam_height", "beam_width", "density"]
    if dimensions.get("storey_heights") is None:
        needed = ["storeys", "height", *needed]
    missing = [name for name in needed if dimensions.get(name) is None]
    if missing:
        msg = (
            f"{owner}: give members, or the dimensions of a regular frame, of which "
            f"{', '.join(missing)} {'is' if len(missing) == 1 else 'are'} missing"
        )
        raise ComponentError(msg)
    return RegularFrame(**dimensions)


def _outer_sizes(dimensions: Mapping[str, Any], owner: str) -> tuple[float, float, float | None]:
    """Return width, height and depth of a building of members [m]; refuse other dimensions."""
    excluded = [
        name
        for name, value in dimensions.items()
        if name not in _OUTLINE
        and value is not None
        and not (isinstance(value, str) and value == _DEFAULTS.get(name))
    ]
    if excluded:
        msg = f"{owner}: give members or {', '.join(excluded)}, not both"
        raise ComponentError(msg)
    if dimensions.get("height") is None:
        msg = f"{owner}: members need the height of the building; it is missing"
        raise ComponentError(msg)

    def length(name: str) -> float:
        return to_si(dimensions.get(name), LENGTH, owner=owner, name=name, condition=POSITIVE)

    depth = None if dimensions.get("depth") is None else length("depth")
    return length("width"), length("height"), depth


def _member(entry: object, number: int, owner: str) -> Member:
    if isinstance(entry, Member):
        return entry
    if not isinstance(entry, Mapping):
        msg = f"{owner}: members[{number}] must be a Member or a mapping, got {short_repr(entry)}"
        raise ComponentError(msg)
    arguments = {str(name): value for name, value in entry.items()}
    if arguments.get("type") == Member.__name__:
        del arguments["type"]
    try:
        return Member(**arguments)
    except TypeError as problem:
        msg = (
            f"{owner}: members[{number}] does not describe a Member: {problem}; got "
            f"{short_repr(entry)}"
        )
        raise ComponentError(msg) from problem
