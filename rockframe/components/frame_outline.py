"""Members within a building's outline: what they come to, and whether they fit."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from rockframe.components.frame_members import Member, MemberSI
from rockframe.components.shapes.masses import centre_of_mass, mean_by_mass
from rockframe.errors import ComponentError
from rockframe.units import INERTIA

_ROUNDING: Final = 1e-9  # relative to the outline
_FAR: Final = 0.1  # offset of the centre of mass, relative to the outline, that is warned about
_REMEDY: Final = "centre_of_mass='members' takes it where it is"


@dataclass(frozen=True)
class Outline:
    """Outer sizes of a building [m]; the depth may be unknown."""

    width: float
    height: float
    depth: float | None

    @property
    def radius(self) -> float:
        """R0, from the middle to a corner [m]."""
        return 0.5 * math.hypot(self.width, self.height)

    @property
    def middle(self) -> tuple[float, float]:
        """O, half way up the middle: coordinates x, y [m]."""
        return 0.0, 0.5 * self.height

    def shape_factor(self, members: Sequence[Member]) -> float:
        """Mu of :eq:`eq-frame-shape-factor`, summed up as :eq:`eq-frame-mean` [1]."""
        inverse = self._mean_spread(members, self.middle, self.radius)
        # members may reach over the outline by rounding
        return max(1.0, 1.0 / inverse) if inverse > 0.0 else math.inf

    def shape_factor_about_centre(self, members: Sequence[Member]) -> float:
        """Mu of :eq:`eq-frame-about-centre`, about the members' own centre of mass [1]."""
        centre = self.centre_of_mass(members)
        radius = math.hypot(0.5 * self.width, centre[1])
        inverse = self._mean_spread(members, centre, radius)
        return 1.0 / inverse if inverse > 0.0 else math.inf

    def space_proportion(self, members: Sequence[Member]) -> float | None:
        """Chi of :eq:`eq-frame-space-proportion`; None where a volume is unknown [1]."""
        shares = [self._share(member) for member in members]
        known = [share for share in shares if share is not None]
        return math.fsum(known) if len(known) == len(shares) else None

    def centre_of_mass(self, members: Sequence[Member]) -> tuple[float, float]:
        """Coordinates x, y of the members' centre of mass [m]."""
        return centre_of_mass([member.si for member in members])

    def check(self, members: Sequence[Member], owner: str) -> None:
        """Refuse members that do not make a building of this outline."""
        if not 0.0 < self.radius < math.inf:
            msg = f"{owner}: {self.width} m by {self.height} m is no building's size"
            raise ComponentError(msg)
        if not members:
            msg = f"{owner}: members is empty; at least one is needed"
            raise ComponentError(msg)
        twice = [name for name, n in Counter(member.name for member in members).items() if n > 1]
        if twice:
            msg = f"{owner}: members need different names, found twice: {', '.join(twice)}"
            raise ComponentError(msg)
        for member in members:
            self._check_within(member, owner)
        chi = self.space_proportion(members)
        if chi is not None and chi > 1.0 + _ROUNDING:
            msg = (
                f"{owner}: the members together fill {chi:.4g} times the building of "
                f"{self.width:.6g} m by {self.depth:.6g} m by {self.height:.6g} m; do they overlap?"
            )
            raise ComponentError(msg)
        if not any(_spread(member.si, self.middle, self.radius) for member in members):
            msg = f"{owner}: all mass is in the middle of the building, so that it has no inertia"
            raise ComponentError(msg)

    def _share(self, member: Member) -> float | None:
        """Part of the building's volume that a member fills."""
        si = member.si
        if self.depth is None or si.width is None or si.height is None or si.depth is None:
            return None
        return (si.width / self.width) * (si.height / self.height) * (si.depth / self.depth)

    def _mean_spread(
        self, members: Sequence[Member], about: tuple[float, float], radius: float
    ) -> float:
        """Mean square distance of all mass from a point, over the square of a radius."""
        return mean_by_mass(
            [member.si for member in members], lambda si: _spread(si, about, radius)
        )

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
                    f"{high:.6g} m, beyond the building, which lies from {bottom:.6g} m to "
                    f"{top:.6g} m"
                )
                raise ComponentError(msg)
        if (si.depth or 0.0) > (self.depth or math.inf) * (1.0 + _ROUNDING):
            msg = (
                f"{owner}: member {member.name!r} has a depth of {si.depth:.6g} m, more than the "
                f"building's {self.depth:.6g} m"
            )
            raise ComponentError(msg)
        if _spread(si, self.middle, self.radius) > 1.0 + _ROUNDING:
            distance = si.distance(self.height)
            largest = si.mass * (self.radius - distance) * (self.radius + distance)
            msg = (
                f"{owner}: member {member.name!r} has an inertia of {si.inertia:.6g} "
                f"{INERTIA.unit}, but with its mass and place no more than {largest:.6g} "
                f"{INERTIA.unit} fits into the building"
            )
            raise ComponentError(msg)


def _spread(si: MemberSI, about: tuple[float, float], radius: float) -> float:
    """Mean square distance of a member's mass from a point, over the square of a radius."""
    if si.width is None or si.height is None:
        turning = si.inertia / si.mass / radius / radius
    else:
        turning = (math.hypot(si.width, si.height) / radius) ** 2 / 12.0
    return turning + (math.hypot(si.x - about[0], si.y - about[1]) / radius) ** 2


def outline_cautions(outline: Outline, members: Sequence[Member]) -> list[str]:
    """Say where the centre of mass is far from where the model takes it."""
    x, y = outline.centre_of_mass(members)
    beside, above = x / outline.width, y / outline.height - 0.5
    cautions: list[str] = []
    if abs(above) > _FAR:
        cautions.append(
            f"the centre of mass lies {y:.4g} m above the base, at {0.5 + above:.3g} of the "
            "height; the model takes it at half the height, and an overturning angle of "
            f"{math.atan2(outline.width, outline.height):.4g} rad instead of "
            f"{math.atan2(0.5 * outline.width, y):.4g} rad; {_REMEDY}"
        )
    if abs(beside) > _FAR:
        cautions.append(
            f"the centre of mass lies {abs(x):.4g} m {'right' if x > 0.0 else 'left'} of the "
            f"middle of a base of {outline.width:.4g} m; the model takes it in the middle; "
            f"{_REMEDY}"
        )
    return cautions
