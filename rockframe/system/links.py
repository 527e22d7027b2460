"""Links as they are in a scene: between which points, by which law, and in words."""

import math
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rockframe.components import Link, Restrainer
from rockframe.errors import AssemblyError
from rockframe.system.bodies import SupportedBody

if TYPE_CHECKING:
    from rockframe.dynamics.chain.linked import ChainLink
    from rockframe.dynamics.links import LinkNumbers


class OwnLink(Link):
    """A link by a law of your own; :func:`rockframe.register` makes its class known.

    A class derived from it declares the parameters of its law, and has the method ``law``.
    """

    @abstractmethod
    def law(self, mass: float) -> "LinkNumbers":
        """Give the law as the equations take it.

        Parameters
        ----------
        mass : float
            That all is measured by: forces, stiffness and damping are divided by it [kg].

        Returns
        -------
        LinkNumbers
        """
        raise NotImplementedError


@dataclass(frozen=True)
class PlacedLink:
    """A link between points of upright bodies."""

    part: Link  # as it was given
    name: str  # what results call it
    on: int  # bodies, counted from 0 at the top; -1 for the ground
    # from the centres of mass of their bodies to the right and up, or from the middle of the lowest
    # base [m]
    on_point: tuple[float, float]
    to: int
    to_point: tuple[float, float]
    # both points from the middle of the lowest base [m]
    ends: tuple[tuple[float, float], tuple[float, float]]

    @property
    def apart(self) -> tuple[float, float]:
        """From the second point to the first [m]."""
        (x, y), (to_x, to_y) = self.ends
        return x - to_x, y - to_y

    @property
    def length(self) -> float:
        """Distance of the points [m]."""
        return math.hypot(*self.apart)

    def numbers(self, mass: float) -> "LinkNumbers":
        """Give the law, per unit of a mass [kg]."""
        if isinstance(self.part, Restrainer):
            return tie_of(self.part, mass)
        if isinstance(self.part, OwnLink):
            return self.part.law(mass)
        raise TypeError

    def chain_link(self, mass: float) -> "ChainLink":
        """Give the link as the equations take it."""
        from rockframe.dynamics.chain.linked import ChainLink

        to_point = self.to_point if self.to >= 0 else (0.0, 0.0)
        return ChainLink(self.on, self.on_point, self.to, to_point, self.apart, self.numbers(mass))

    def words(self) -> str:
        """Tell what it links, and how."""
        (x, y), (to_x, to_y) = self.ends
        other = "the ground" if self.to < 0 else f"body {self.to + 1}"
        found = [
            f"from body {self.on + 1} at ({x:.6g}, {y:.6g}) m to {other} at ({to_x:.6g}, "
            f"{to_y:.6g}) m"
        ]
        if isinstance(self.part, Restrainer):
            given = self.part.si
            found.append(f"{given.stiffness:.6g} N/m")
            found += [
                f"{name} {value:.6g} {unit}"
                for name, value, unit in (
                    ("slack", given.slack, "m"), ("preload", given.preload, "N"),
                    ("damping", given.damping, "N s/m"),
                ) if value
            ]  # fmt: skip
            if given.strength is not None:
                verb = "breaks" if given.brittle else "yields"
                found.append(f"{verb} at {given.strength:.6g} N")
            found.append("pulls and pushes" if given.compression else "pulls only")
        return ", ".join(found)


def tie_of(part: Restrainer, mass: float) -> "LinkNumbers":
    """Give the law of a restrainer, :eq:`eq-tie`, per unit of a mass [kg]."""
    from rockframe.dynamics.links import LinkNumbers, Tie

    given = part.si
    stiffness, damping = given.stiffness / mass, (given.damping or 0.0) / mass
    free = (given.slack or 0.0) - (given.preload or 0.0) / given.stiffness
    most = math.inf if given.strength is None else given.strength / given.stiffness
    law = Tie(stiffness, damping, free, most, float(given.brittle), float(given.compression))
    size = most if math.isfinite(most) else 1.0
    return LinkNumbers(law, stiffness, damping, (size,))


def placed(
    parts: Sequence[Link],
    bodies: Sequence[SupportedBody],
    tops: Sequence[float],
    offsets: Sequence[float],
) -> tuple[PlacedLink, ...]:
    """Give links between points of bodies upon one another, from the top down."""
    names = link_labels(parts)
    faults = [f"two links are called {name!r}" for name in names if names.count(name) > 1]
    found = list[PlacedLink]()
    for part, name in zip(parts, names, strict=True):
        on, to = part.si.on_body - 1, -1 if part.si.to_body is None else part.si.to_body - 1
        missing = [k + 1 for k in (on, to) if k >= len(bodies)]
        if missing:
            faults += [
                f"{name}: there is no body {k}; bodies are counted from the top down, and there "
                f"{'is 1' if len(bodies) == 1 else f'are {len(bodies)}'}"
                for k in missing
            ]
            continue
        if on == to:
            faults.append(f"{name}: both its points are on body {on + 1}")
            continue
        ends, points = [], []
        for k, (x, y) in ((on, part.si.on), (to, part.si.to)):
            middle, base = (0.0, 0.0) if k < 0 else base_of(k, bodies, tops, offsets)
            ends.append((middle + x, base + y))
            points.append((x, y) if k < 0 else (x - bodies[k].eccentricity,
                                                y - bodies[k].centre_height))  # fmt: skip
        one = PlacedLink(part, name, on, points[0], to, points[1], (ends[0], ends[1]))
        if one.length == 0.0 and isinstance(part, Restrainer) and part.si.preload:
            faults.append(f"{name}: its points meet, so that its preload has no direction")
        found.append(one)
    if faults:
        raise AssemblyError(list(dict.fromkeys(faults)))
    return tuple(found)


def link_labels(parts: Sequence[Link]) -> list[str]:
    """Give what results call links: their names, or their numbers."""
    return [part.si.name or f"restrainer {i}" for i, part in enumerate(parts, 1)]


def base_of(
    k: int, bodies: Sequence[SupportedBody], tops: Sequence[float], offsets: Sequence[float]
) -> tuple[float, float]:
    """Give the middle of the base of an upright body from that of the lowest one."""
    below = range(k + 1, len(bodies))
    return math.fsum(offsets[k : len(bodies) - 1]), math.fsum(
        bodies[j].centre_height + tops[j] for j in below
    )
