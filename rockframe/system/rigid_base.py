"""Rigid bases in a stack: their loads, their uplift, and statics with corners that have lifted."""

import math
from collections.abc import Sequence
from typing import NamedTuple, cast

from rockframe.dynamics.body_statics import Pose
from rockframe.dynamics.equilibrium import ChainEquilibrium, EquilibriumPath
from rockframe.dynamics.link_statics import LinkForce, links_of_rocking_bodies
from rockframe.system.stacked_bodies import StackedBodies
from rockframe.system.statics import StandingBodies, Statics, work_against
from rockframe.system.support import corner_reactions


class RigidBaseLoad(NamedTuple):
    """The load on a rigid base in full contact, and the couples at which a corner lifts."""

    normal: float  # normal force [N]
    left_limit: float  # couple to the left, on the bodies above, that lifts the right corner [N m]
    right_limit: float  # couple to the right that lifts the left corner [N m]
    shear: float  # force of links on the bodies above, to the right, that the base must resist [N]


def rigid_base_load(setting: StackedBodies, k: int) -> RigidBaseLoad:
    """Return the load on the rigid base under body `k`, :eq:`eq-link-rest`.

    It carries all bodies above it, and the forces of links on them in the upright position.
    """
    load = setting.bases[k].load
    normal, couple, shear = load.weight, 0.0, 0.0
    x_base, y_base = setting.base_of(k)
    x_centre = x_base + load.body.eccentricity
    for link, pull in zip(setting.links, setting.links_at_rest, strict=True):
        for body, end, sign in ((link.on, link.ends[0], -1.0), (link.to, link.ends[1], 1.0)):
            if 0 <= body <= k:
                x, y = sign * setting.body.mass * pull.force * pull.direction
                normal, shear = normal - y, shear + x
                couple += x * (end[1] - y_base) - y * (end[0] - x_centre)
    limits = normal * load.body.left + couple, normal * load.body.right - couple
    return RigidBaseLoad(normal, *limits, shear)


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


def uplift_limits(setting: StackedBodies, k: int) -> UpliftLimits:
    """Return the uplift limits of the rigid base under body `k`, with link forces at rest.

    Without links it is :eq:`eq-rigid-together`, and the friction b/h.
    """
    load, body = rigid_base_load(setting, k), setting.bases[k].load.body
    left, right = load.left_limit / body.centre_height, load.right_limit / body.centre_height
    needed = min(abs(left - load.shear), abs(right + load.shear))
    return UpliftLimits(left / body.mass, right / body.mass, needed / load.normal)


def rocking_moment(
    setting: StackedBodies, k: int, rotation: float
) -> tuple[float, list[LinkForce]]:
    """Return the restoring moment [N m] of all above base `k`, rotated as one, and the links."""
    load, (middle, level) = setting.bases[k].load, setting.base_of(k)
    side, half = (1.0, load.body.right) if rotation > 0.0 else (-1.0, load.body.left)
    sine, versine = math.sin(abs(rotation)), 2.0 * math.sin(0.5 * rotation) ** 2
    arm = half * (1.0 - versine) - load.body.centre_height * sine
    ends = [link.ends for link in setting.links]
    pivot = (middle + side * load.body.half_width, level)
    tied = links_of_rocking_bodies(setting.chain_links, ends, k, pivot, rotation)
    pull = sum(float(link.loads[0]) for link in tied)
    return side * load.weight * arm - setting.body.mass * pull, tied


def rocking_energy(setting: StackedBodies, k: int) -> float:
    """Return the energy that overturns all above the base of body `k` as one [J]."""
    left, right = setting.bases[k].load.body.overturning_angles
    return min(
        work_against(lambda angles: [rocking_moment(setting, k, a)[0] for a in angles], end)
        for end in (-left, right)
    )


def rocking_statics(setting: StackedBodies, rotation: float) -> Statics:
    """Return the equilibrium on rigid bases only: all bodies above the weakest base rock."""
    right, mass = rotation > 0.0, setting.body.mass
    side = 1.0 if right else -1.0
    capacities = [
        load.right_limit if right else load.left_limit
        for load in (rigid_base_load(setting, j) for j in range(len(setting.bases)))
    ]
    k = capacities.index(min(capacities))
    (middle, pivot_level), half_width = setting.base_of(k), setting.bases[k].load.body.half_width
    corner = middle + side * half_width
    sine, versine = math.sin(abs(rotation)), 2.0 * math.sin(0.5 * rotation) ** 2
    moment, tied = 0.0, setting.links_at_rest
    if rotation != 0.0:
        moment, tied = rocking_moment(setting, k, rotation)
    # rise of the highest centre of mass; moment of all weights about the middle of the lowest base
    rise, base_moment = 0.0, moment
    for j in range(len(setting.bodies) - 1, -1, -1):
        body, (place, level) = setting.bodies[j], setting.base_of(j)
        across, up = place + body.eccentricity, level + body.centre_height
        if j <= k and rotation != 0.0:
            away, above = side * (corner - across), up - pivot_level
            across = corner - side * (away * (1.0 - versine) - above * sine)
            rise = away * sine - above * versine
        base_moment += setting.gravity * body.mass * across
    down = math.fsum(setting.gravity * body.mass for body in setting.bodies)
    for link, pull in zip(setting.links, tied, strict=True):  # links to the ground are external
        if link.to < 0:
            x, y = -mass * pull.force * pull.direction
            across, up = link.ends[0] + pull.displacement
            base_moment += x * up - y * across
            down -= y
    single = len(setting.bodies) == 1
    state = "full" if rotation == 0.0 or k > 0 else "right" if right else "left"
    shift = base_moment / setting.bodies[-1].half_width
    reactions = (0.5 * (down - shift), 0.5 * (down + shift))
    if rotation != 0.0:
        reactions = (0.0, down) if right else (down, 0.0)
    shown = corner_reactions(*map(float, reactions)) if single else {}
    return Statics(rise, float(base_moment), float(moment), state, shown)


def statics_beyond_uplift(
    setting: StackedBodies, rotations: Sequence[float], closed: Sequence[Statics | None]
) -> list[Statics | None]:
    """Return the equilibria with the highest body held at rotations, with uplift of joints.

    `closed` are the equilibria with all rigid bases in full contact. Beyond the rotation at which
    a corner first lifts from a rigid base, all bodies above rotate about the other corner.
    """
    states: list[Statics | None] = [None] * len(rotations)
    for side in (1, -1):
        before, lifted, path = 0.0, None, None
        joints = [_Joint(setting, k, side) for k, rigid in enumerate(setting.rigid) if rigid]
        here = [i for i, rotation in enumerate(rotations) if math.copysign(1.0, rotation) == side]
        for i in sorted(here, key=lambda i: abs(rotations[i])):
            if lifted is None:
                lifted = _first_uplift(joints, before, rotations[i])
                if lifted is None:
                    before, states[i] = rotations[i], closed[i]
                    continue
                path = EquilibriumPath(lifted.rotation, lifted.equilibrium)
            if path is None:
                break
            path, poses = lifted.bodies.chain.held_at(path, rotations[i])
            states[i] = None if poses is None else lifted.bodies.statics_of(poses)
    return states


class _Uplift(NamedTuple):
    """The state at which a corner lifts from a rigid base."""

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
        if first is None or abs(at) < abs(first.rotation):
            first = _Uplift(joint.bodies, at, joint.equilibrium_at_uplift(at))
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
        self.side = side

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
