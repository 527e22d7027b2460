"""Stacked bodies on their bases, with links: their numbers, and statics with lifted corners."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple, cast

from rockframe.dynamics.base_numbers import BaseNumbers
from rockframe.dynamics.body_statics import Pose, StandingBody, standing_body
from rockframe.dynamics.chain.link_rows import ChainLink
from rockframe.dynamics.equilibrium import ChainEquilibrium, EquilibriumPath
from rockframe.dynamics.link_statics import LinkForce, links_at_rest, links_of_rocking_bodies
from rockframe.dynamics.on_base import BodyOnBase
from rockframe.dynamics.statics import StandingChain
from rockframe.dynamics.vibrations import ChainBody
from rockframe.system.bodies import BaseFriction, BaseLoad, SupportedBody, combine_masses
from rockframe.system.links import PlacedLink, base_of
from rockframe.system.setting import Setting
from rockframe.system.statics import StandingBodies, Statics, work_against
from rockframe.system.support import RigidBase, Support, corner_reactions


class RigidBaseLoad(NamedTuple):
    """The load on a rigid base in full contact, and the couples at which a corner lifts."""

    normal: float  # normal force [N]
    left_limit: float  # couple to the left, on the bodies above, that lifts the right corner [N m]
    right_limit: float  # couple to the right that lifts the left corner [N m]
    shear: float  # force of links on the bodies above, to the right, that the base must resist [N]


class UpliftLimits(NamedTuple):
    """Limits at which all bodies above a rigid base begin to rock as one."""

    to_left: float  # ground acceleration, to the right, that tips them to the left [m s^-2]
    to_right: float  # ground acceleration, to the left, that tips them to the right [m s^-2]
    friction: float  # coefficient below which they slide before a corner lifts [1]

    def words(self) -> str:
        """Write the accelerations; one if both sides are equal."""
        left, right = (f"{acceleration:.4g} m s^-2" for acceleration in self[:2])
        if left == right:
            return left
        return f"{left} to the right, which tips it to the left, or {right} to the left"


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
                    whole, (place, level) = self._combined_group(group), self.base_of(group[-1])
                    which[i] = number
                    points[i] = x - place - whole.eccentricity, y - level - whole.centre_height
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

    def rigid_base_load(self, k: int) -> RigidBaseLoad:
        """Return the load of bodies and links above on rigid base `k`, :eq:`eq-link-rest`."""
        load = self.bases[k].load
        normal, couple, shear = load.weight, 0.0, 0.0
        x_base, y_base = self.base_of(k)
        x_centre = x_base + load.body.eccentricity
        for link, pull in zip(self.links, self.links_at_rest, strict=True):
            for body, end, sign in ((link.on, link.ends[0], -1.0), (link.to, link.ends[1], 1.0)):
                if 0 <= body <= k:
                    x, y = sign * self.body.mass * pull.force * pull.direction
                    normal, shear = normal - y, shear + x
                    couple += x * (end[1] - y_base) - y * (end[0] - x_centre)
        limits = normal * load.body.left + couple, normal * load.body.right - couple
        return RigidBaseLoad(normal, *limits, shear)

    def uplift_limits(self, k: int) -> UpliftLimits:
        """Return the limits of rigid base `k`; without links it is :eq:`eq-rigid-together`."""
        load, body = self.rigid_base_load(k), self.bases[k].load.body
        left, right = load.left_limit / body.centre_height, load.right_limit / body.centre_height
        needed = min(abs(left - load.shear), abs(right + load.shear))
        return UpliftLimits(left / body.mass, right / body.mass, needed / load.normal)

    def rocking_moment(self, k: int, rotation: float) -> tuple[float, list[LinkForce]]:
        """Return the restoring moment [N m] of all above base `k` that rotate as one; the links."""
        load, (middle, level) = self.bases[k].load, self.base_of(k)
        side, half = (1.0, load.body.right) if rotation > 0.0 else (-1.0, load.body.left)
        sine, versine = math.sin(abs(rotation)), 2.0 * math.sin(0.5 * rotation) ** 2
        arm = half * (1.0 - versine) - load.body.centre_height * sine
        ends = [link.ends for link in self.links]
        pivot = (middle + side * load.body.half_width, level)
        tied = links_of_rocking_bodies(self.chain_links, ends, k, pivot, rotation)
        pull = sum(float(link.loads[0]) for link in tied)
        return side * load.weight * arm - self.body.mass * pull, tied

    def rocking_energy(self, k: int) -> float:
        """Return the energy that overturns all above the base of body `k` as one [J]."""
        left, right = self.bases[k].load.body.overturning_angles
        return min(
            work_against(lambda angles: [self.rocking_moment(k, a)[0] for a in angles], end)
            for end in (-left, right)
        )

    def rocking_statics(self, rotation: float) -> Statics:
        """Return the equilibrium on rigid bases only: all bodies above the weakest base rock."""
        right, mass = rotation > 0.0, self.body.mass
        side = 1.0 if right else -1.0
        capacities = [
            load.right_limit if right else load.left_limit
            for load in (self.rigid_base_load(j) for j in range(len(self.bases)))
        ]
        k = capacities.index(min(capacities))
        (middle, pivot_level), half_width = self.base_of(k), self.bases[k].load.body.half_width
        corner = middle + side * half_width
        sine, versine = math.sin(abs(rotation)), 2.0 * math.sin(0.5 * rotation) ** 2
        moment, tied = 0.0, self.links_at_rest
        if rotation != 0.0:
            moment, tied = self.rocking_moment(k, rotation)
        # rise of the highest centre of mass; moment of weights about the middle of the lowest base
        rise, base_moment = 0.0, moment
        for j in range(len(self.bodies) - 1, -1, -1):
            body, (place, level) = self.bodies[j], self.base_of(j)
            across, up = place + body.eccentricity, level + body.centre_height
            if j <= k and rotation != 0.0:
                away, above = side * (corner - across), up - pivot_level
                across = corner - side * (away * (1.0 - versine) - above * sine)
                rise = away * sine - above * versine
            base_moment += self.gravity * body.mass * across
        down = math.fsum(self.gravity * body.mass for body in self.bodies)
        for link, pull in zip(self.links, tied, strict=True):  # links to the ground are external
            if link.to < 0:
                x, y = -mass * pull.force * pull.direction
                across, up = link.ends[0] + pull.displacement
                base_moment += x * up - y * across
                down -= y
        single = len(self.bodies) == 1
        state = "full" if rotation == 0.0 or k > 0 else "right" if right else "left"
        shift = base_moment / self.bodies[-1].half_width
        reactions = (0.5 * (down - shift), 0.5 * (down + shift))
        if rotation != 0.0:
            reactions = (0.0, down) if right else (down, 0.0)
        shown = corner_reactions(*map(float, reactions)) if single else {}
        return Statics(rise, float(base_moment), float(moment), state, shown)

    def statics_beyond_uplift(
        self, rotations: Sequence[float], closed: Sequence[Statics | None]
    ) -> list[Statics | None]:
        """Return the equilibria with the highest body held at rotations, with uplift of joints.

        `closed` are those with all rigid bases in full contact. To either side of rest, beyond the
        rotation at which a corner first lifts from a rigid base, all bodies above rotate about the
        other corner.
        """
        states: list[Statics | None] = [None] * len(rotations)
        rest = self.rest_rotation
        from_rest = [rotation - rest for rotation in rotations]
        for side in (1, -1):
            before, lifted, path = rest, None, None
            joints = [_Joint(self, k, side) for k, rigid in enumerate(self.rigid) if rigid]
            here = [i for i, angle in enumerate(from_rest) if math.copysign(1.0, angle) == side]
            for i in sorted(here, key=lambda i: abs(from_rest[i])):
                if lifted is None:
                    lifted = _first_uplift(joints, before, rotations[i])
                    if lifted is None:
                        before, states[i] = rotations[i], self._joined_highest(closed[i])
                        continue
                    path = EquilibriumPath(lifted.rotation, lifted.equilibrium)
                if path is None:
                    break
                path, poses = lifted.bodies.chain.held_at(path, rotations[i])
                state = None if poses is None else lifted.bodies.statics_of(poses)
                states[i] = state if lifted.base == 0 else self._joined_highest(state)
        return states

    def _joined_highest(self, state: Statics | None) -> Statics | None:
        """Return a state in which the base of the highest body is closed if it is rigid."""
        if state is None or not self.rigid[0]:
            return state
        return replace(state, contact_state="full")


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


class _Uplift(NamedTuple):
    """The state at which a corner lifts from a rigid base."""

    base: int  # number of the base
    bodies: StandingBodies  # all bodies, those above the base on its other corner
    rotation: float  # rotation of the highest body [rad]
    equilibrium: ChainEquilibrium  # of the bodies


def _first_uplift(joints: "Sequence[_Joint]", before: float, rotation: float) -> _Uplift | None:
    """Return the first lift between two rotations of the highest body, if there is one."""
    from scipy.optimize import brentq

    first: _Uplift | None = None
    for joint in joints:
        if joint.uplift_margin(rotation) >= 0.0:
            continue
        at = before
        if joint.uplift_margin(before) > 0.0:
            at = cast("float", brentq(joint.uplift_margin, before, rotation))
        if first is None or joint.side * (at - first.rotation) < 0.0:
            first = _Uplift(joint.base, joint.bodies, at, joint.equilibrium_at_uplift(at))
    return first


class _Joint:
    """A rigid base in full contact, in a stack with deformable bases."""

    def __init__(self, setting: StackedBodies, k: int, side: int) -> None:
        self.closed = setting.standing.chain
        groups = [*setting.groups]
        self.index = next((i for i, group in enumerate(groups) if k in group), len(groups))
        if self.index == len(groups):  # the bodies below stand on rigid ground
            groups.append(range(groups[-1][-1] + 1, k + 1))
        else:
            first, last = groups[self.index][0], groups[self.index][-1]
            groups[self.index : self.index + 1] = [range(first, k + 1), range(k + 1, last + 1)]
        self.bodies = setting.statics_of_groups(groups, k, side)
        self.base, self.side = k, side

    def rotations(self, poses: Sequence[Pose]) -> list[float]:
        """Return the rotations of all bodies on their bases; 0 for the body on this base."""
        rotations = [pose.state.rotation for pose in poses]
        return [*rotations[: self.index], 0.0, *rotations[self.index :]]

    def equilibrium_at_uplift(self, rotation: float) -> ChainEquilibrium:
        """Return the equilibrium in which the corner lifts."""
        chain, (poses,) = self.bodies.chain, self.closed.curve([rotation])
        poses_at_uplift = chain.poses_at(self.rotations(poses or [])) or []
        return ChainEquilibrium.from_poses(chain, poses_at_uplift)

    def uplift_margin(self, rotation: float) -> float:
        """Return by how much the couple on the highest body is below that which lifts a corner."""
        (poses,) = self.closed.curve([rotation])
        if poses is None:
            return math.inf  # there is no equilibrium with this joint closed
        here = self.bodies.chain.poses_at(self.rotations(poses))
        if here is None:
            return math.inf
        lifts = self.bodies.chain.moments(here)[self.index]
        return self.side * (self.closed.moments(poses)[0] - lifts)
