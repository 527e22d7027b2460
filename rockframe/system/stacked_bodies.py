"""Stacked bodies on their bases, with links: their numbers for equations and statics."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from rockframe.dynamics.base_numbers import BaseNumbers
from rockframe.dynamics.body_statics import StandingBody, standing_body
from rockframe.dynamics.chain.link_rows import ChainLink
from rockframe.dynamics.link_statics import LinkForce, links_at_rest
from rockframe.dynamics.on_base import BodyOnBase
from rockframe.dynamics.statics import StandingChain
from rockframe.dynamics.vibrations import ChainBody
from rockframe.system.bodies import BaseLoad, SupportedBody, combine_masses
from rockframe.system.compatibility import BaseFriction
from rockframe.system.links import PlacedLink, base_of
from rockframe.system.setting import Setting
from rockframe.system.statics import StandingBodies
from rockframe.system.support import RigidBase, Support


@dataclass(frozen=True)
class StackedBodies(Setting):
    """Stacked bodies: the part of their setting from which statics and equations follow."""

    bodies: tuple[SupportedBody, ...]  # all bodies, from the top down
    tops: tuple[float, ...]  # height of the top of each above its centre of mass [m]
    # how far the middle of each base is to the right of that of the body below [m]
    offsets: tuple[float, ...]
    bases: tuple[Support, ...]  # base under each body, with all bodies above it as its load
    links: tuple[PlacedLink, ...] = ()  # links between points
    frictions: tuple[BaseFriction, ...] = ()  # friction of each base; empty where all bases hold

    def __post_init__(self) -> None:
        super().__post_init__()
        # bodies, offsets, links or a slope make left and right differ
        eccentric = any(body.eccentricity != 0.0 for body in self.bodies)
        upright = self.slope.level and not (eccentric or any(self.offsets) or self.links)
        vars(self).update(leans=not upright)

    @cached_property
    def joined_bodies(self) -> tuple[SupportedBody, ...]:
        """Bodies under the highest, each joined with all above it to one upright body."""
        return tuple(
            combined_body(self.bodies[: k + 1], self.tops, self.offsets)
            for k in range(1, len(self.bodies))
        )

    @property
    def supports(self) -> tuple[Support, ...]:
        """All bases."""
        return self.bases

    @cached_property
    def settlement(self) -> float | None:
        """Settlement of the base of the highest body; None for a rigid base [m]."""
        return None if self.rigid[0] else self.bases[0].settlement

    @property
    def rigid(self) -> tuple[bool, ...]:
        """Whether each base is rigid, from the top down."""
        return tuple(isinstance(base, RigidBase) for base in self.bases)

    @cached_property
    def groups(self) -> tuple[range, ...]:
        """Ranges of bodies that rigid bases join at rest, one above each deformable base."""
        groups, first = list[range](), 0
        for k, rigid in enumerate(self.rigid):
            if not rigid:
                groups.append(range(first, k + 1))
                first = k + 1
        return tuple(groups)

    @cached_property
    def chain_bodies(self) -> tuple[ChainBody, ...]:
        """The bodies as the equations take them, per unit mass of the highest one."""
        chain_bodies, carried, mass = list[ChainBody](), 0.0, self.body.mass
        below = (*(body.eccentricity for body in self.bodies[1:]), 0.0)
        for body, top, offset, base, lower in zip(
            self.bodies, self.tops, self.offsets, self.bases, below, strict=True
        ):
            carried += body.mass
            beside = offset + body.eccentricity - lower
            law = BaseLoad(body, self.options).law(mass)
            numbers = base.law(law, mass, carried)
            chain_bodies.append(ChainBody(law, numbers, body.mass / mass, top, beside))
        return tuple(chain_bodies)

    @cached_property
    def chain_links(self) -> tuple[ChainLink, ...]:
        """The links as the equations take them."""
        return tuple(link.chain_link(self.body.mass) for link in self.links)

    @cached_property
    def links_at_rest(self) -> list[LinkForce]:
        """Elongations and forces of the links at rest."""
        if not self.groups:
            return links_at_rest(self.chain_links)
        return self.standing.chain.link_forces(self.standing.rest or [])

    @cached_property
    def standing(self) -> StandingBodies:
        """Statics of the bodies: those that rigid bases join are one body on a deformable base."""
        return self.statics_of_groups(self.groups)

    def statics_of_groups(
        self, groups: Sequence[range], lifted: int = -1, side: int = 0
    ) -> StandingBodies:
        """Return the statics of groups of joined bodies; one may have lifted from a rigid base.

        `lifted` is the lowest body of that group, -1 for none; `side` is the side of its corner.
        """
        standing_groups, numbers = list[StandingBody](), list[BaseNumbers]()
        mass = self.body.mass
        for group in groups:
            body, lowest = self._combined_group(group), group[-1]
            # how far its centre of mass is beside that of what it stands on
            beside = self.offsets[lowest] + body.eccentricity
            for below in groups:
                if below[0] == lowest + 1:
                    shift = math.fsum(self.offsets[below[0] : below[-1]])
                    beside += shift - self._combined_group(below).eccentricity
            height = math.fsum(self.bodies[k].centre_height + self.tops[k] for k in group)
            law = BaseLoad(body, self.options).law(mass)
            carried = math.fsum(member.mass for member in self.bodies[: lowest + 1])
            numbers.append(self.bases[lowest].law(law, mass, carried))
            part = BodyOnBase(law, numbers[-1].law)
            link = standing_body(part, body.mass / mass, height - body.centre_height, beside)
            if lowest == lifted:
                small = min(member.settlement for member in self.standing.chain.bodies)
                link = link._replace(corner=side, settlement=small)
            standing_groups.append(link)
        links = tuple(self._link_between_groups(link, groups) for link in self.links)
        chain = StandingChain(tuple(standing_groups), self.slope.along_gravity, links)
        return StandingBodies(chain, mass, tuple(numbers))

    def _link_between_groups(self, link: PlacedLink, groups: Sequence[range]) -> ChainLink:
        """Return a link between groups of joined bodies; a point on the ground stays there."""
        chain_link = link.chain_link(self.body.mass)
        if not any(self.rigid):
            return chain_link
        which, points = [-1, -1], [(0.0, 0.0), (0.0, 0.0)]
        for i, (body, (x, y)) in enumerate(zip((link.on, link.to), link.ends, strict=True)):
            for number, group in enumerate(groups):
                if body in group:
                    group_body, (place, level) = (
                        self._combined_group(group),
                        self.base_of(group[-1]),
                    )
                    which[i] = number
                    points[i] = (
                        x - place - group_body.eccentricity,
                        y - level - group_body.centre_height,
                    )
        return chain_link._replace(on=which[0], on_point=points[0], to=which[1], to_point=points[1])

    def base_of(self, k: int) -> tuple[float, float]:
        """Return the middle of the base of upright body `k`, from that of the lowest one [m]."""
        return base_of(k, self.bodies, self.tops, self.offsets)

    def _combined_group(self, group: range) -> SupportedBody:
        """Return a range of joined bodies as one body."""
        first, last = group[0], group[-1] + 1
        if len(group) == 1:
            return self.bodies[first]
        return combined_body(
            self.bodies[first:last], self.tops[first:last], self.offsets[first:last]
        )


def combined_body(
    bodies: Sequence[SupportedBody], tops: Sequence[float], offsets: Sequence[float]
) -> SupportedBody:
    """Return stacked bodies, listed from the top down, as one body on the base of the lowest."""
    masses, base, beside = [bodies[-1].mass_at()], 0.0, 0.0
    for k in range(len(bodies) - 2, -1, -1):
        base += bodies[k + 1].centre_height + tops[k + 1]
        beside += offsets[k]
        masses.append(bodies[k].mass_at(beside, base))
    return combine_masses(bodies[-1].half_width, masses)
