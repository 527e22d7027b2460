"""Rigid bases under bodies of a stack: their words, law and statics, with joints that may lift."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, cast

from rockframe.dynamics.base_numbers import BaseNumbers, rigid_numbers
from rockframe.dynamics.body import Body
from rockframe.dynamics.body_statics import Pose
from rockframe.dynamics.equilibrium import ChainEquilibrium, EquilibriumPath
from rockframe.dynamics.link_statics import LinkForce, links_at_rest, links_of_rocking_bodies
from rockframe.system.statics import Statics, work_against
from rockframe.system.support import BaseWords, StandingBodies, Support
from rockframe.system.words import uplift_words

if TYPE_CHECKING:
    from rockframe.system.stack import StackSetting

NO_VERTICAL_START = (
    "InitialState: vertical_displacement and vertical_velocity need a base that gives way; on "
    "rigid ground they follow from the rotation"
)


@dataclass(frozen=True)
class RigidBase(Support):
    """A rigid base."""

    @property
    def model(self) -> str:
        """Name of the model."""
        return "rigid"

    @property
    def settlement(self) -> float:
        """Settlement: zero [m]."""
        return 0.0

    @property
    def uplift_angle(self) -> float:  # type: ignore[override]
        """Rotation of uplift: zero, as any rotation lifts a corner [rad]."""
        return 0.0

    def law(self, body: Body, mass: float, load_mass: float) -> BaseNumbers:
        """Return the base as the equations take it."""
        return rigid_numbers(body)

    def start_faults(self, rotation: float, has_vertical_start: bool) -> list[str]:
        """Refuse a vertical start: the base allows no vertical motion."""
        return [NO_VERTICAL_START] if has_vertical_start else []

    def words(self) -> BaseWords:
        """Describe the base."""
        return BaseWords(
            law="corners held by forces on rigid bases",
            equations=[],
            uplift=("uplift angle", uplift_words(self.uplift_angle)),
            numbers=[],
            left_out=["elasticity of the contacts"],
        )


REACTIONS: tuple[str, ...] = ("left_reaction", "right_reaction")


class Pressed(NamedTuple):
    """The load on a rigid base in full contact, and the couples at which a corner lifts."""

    force: float  # normal force [N]
    to_left: float  # couple on the bodies above, to the left, at which the right corner lifts [N m]
    to_right: float  # likewise to the right
    along: float  # force of links on the bodies above, to the right, which the base must hold [N]

    def bears(self, couple: float) -> bool:
        """Whether both corners press under a couple to the right [N m]."""
        return -self.to_left <= couple <= self.to_right


def pressed(setting: "StackSetting", k: int, tied: Sequence[LinkForce]) -> Pressed:
    """Return the load on the rigid base under body `k`, :eq:`eq-link-rest`.

    It carries all bodies above it, and the forces of links on them in the upright position.
    """
    load = setting.bases[k].load
    force, couple, along = load.weight, 0.0, 0.0
    level = setting.base_of(k)
    foot = level[0] + load.body.eccentricity  # below the centre of mass
    for one, pull in zip(setting.ties, tied, strict=True):
        for body, end, sign in ((one.on, one.ends[0], -1.0), (one.to, one.ends[1], 1.0)):
            if 0 <= body <= k:
                x, y = sign * setting.body.mass * pull.force * pull.direction
                force, along = force - y, along + x
                couple += x * (end[1] - level[1]) - y * (end[0] - foot)
    lifts = force * load.body.left + couple, force * load.body.right - couple
    return Pressed(force, *lifts, along)


class Lifting(NamedTuple):
    """What lifts a corner of a rigid base, on which everything above then rocks as one."""

    tipping_left: float  # ground acceleration, to the right, that tips it to the left [m s^-2]
    tipping_right: float  # likewise to the left [m s^-2]
    friction: float  # below which it slides before either corner lifts [1]

    def words(self) -> str:
        """Write the accelerations; one if both sides are equal."""
        left, right = (f"{one:.4g} m s^-2" for one in self[:2])
        if left == right:
            return left
        return f"{left} to the right, which tips it to the left, or {right} to the left"


def lifting(setting: "StackSetting", k: int, tied: Sequence[LinkForce]) -> Lifting:
    """Return what lifts a corner of the rigid base under body `k`, with link forces at rest.

    Without links it is :eq:`eq-rigid-together`, and the friction b/h.
    """
    carried, body = pressed(setting, k, tied), setting.bases[k].load.body
    shears = carried.to_left / body.centre_height, carried.to_right / body.centre_height
    needed = min(abs(shears[0] - carried.along), abs(shears[1] + carried.along))
    return Lifting(shears[0] / body.mass, shears[1] / body.mass, needed / carried.force)


def rocking_moment(
    setting: "StackSetting", k: int, rotation: float
) -> tuple[float, list[LinkForce]]:
    """Return the restoring moment [N m] of all above base `k`, rotated as one, and its ties."""
    load, (middle, foot) = setting.bases[k].load, setting.base_of(k)
    side, half = (1.0, load.body.right) if rotation > 0.0 else (-1.0, load.body.left)
    sine, versine = math.sin(abs(rotation)), 2.0 * math.sin(0.5 * rotation) ** 2
    arm = half * (1.0 - versine) - load.body.centre_height * sine
    ends = [one.ends for one in setting.ties]
    pivot = (middle + side * load.body.half_width, foot)
    tied = links_of_rocking_bodies(setting.chain_ties, ends, k, pivot, rotation)
    pull = sum(float(one.loads[0]) for one in tied)
    return side * load.weight * arm - setting.body.mass * pull, tied


def rocking_energy(setting: "StackSetting", k: int) -> float:
    """Return the energy that overturns all above the base of body `k` as one [J]."""
    left, right = setting.bases[k].load.body.overturning_angles
    return min(
        work_against(lambda some: [rocking_moment(setting, k, one)[0] for one in some], end)
        for end in (-left, right)
    )


def rocked_statics(setting: "StackSetting", rotation: float) -> Statics:
    """Return the equilibrium on rigid bases only: everything above the weakest one rocks."""
    right, mass = rotation > 0.0, setting.body.mass
    side = 1.0 if right else -1.0
    tied = links_at_rest(setting.chain_ties)
    capacities = [
        of.to_right if right else of.to_left
        for of in (pressed(setting, j, tied) for j in range(len(setting.bases)))
    ]
    k = capacities.index(min(capacities))
    (middle, foot), half_width = setting.base_of(k), setting.bases[k].load.body.half_width
    corner = middle + side * half_width
    sine, versine = math.sin(abs(rotation)), 2.0 * math.sin(0.5 * rotation) ** 2
    moment = 0.0
    if rotation != 0.0:
        moment, tied = rocking_moment(setting, k, rotation)
    # rise of the highest centre of mass; moment of all weights about the middle of the lowest base
    rise, base_moment = 0.0, moment
    for j in range(len(setting.bodies) - 1, -1, -1):
        one, (place, level) = setting.bodies[j], setting.base_of(j)
        across, up = place + one.eccentricity, level + one.centre_height
        if j <= k and rotation != 0.0:
            away, above = side * (corner - across), up - foot
            across = corner - side * (away * (1.0 - versine) - above * sine)
            rise = away * sine - above * versine
        base_moment += setting.gravity * one.mass * across
    down = math.fsum(setting.gravity * one.mass for one in setting.bodies)
    for one, pull in zip(setting.ties, tied, strict=True):  # ties to the ground act from outside
        if one.to < 0:
            x, y = -mass * pull.force * pull.direction
            across, up = one.ends[0] + pull.displacement
            base_moment += x * up - y * across
            down -= y
    alone = len(setting.bodies) == 1
    state = "full" if rotation == 0.0 or k > 0 else "right" if right else "left"
    shift = base_moment / setting.bodies[-1].half_width
    reactions = (0.5 * (down - shift), 0.5 * (down + shift))
    if rotation != 0.0:
        reactions = (0.0, down) if right else (down, 0.0)
    shown: dict[str, float] = dict(zip(REACTIONS, map(float, reactions), strict=True))
    return Statics(rise, float(base_moment), float(moment), state, shown if alone else {})


def beyond_lift(
    setting: "StackSetting", rotations: Sequence[float], closed: Sequence[Statics | None]
) -> list[Statics | None]:
    """Return the equilibria with the highest body held at rotations, where joints may lift.

    `closed` are the equilibria with all rigid bases in full contact. Beyond the rotation at which
    a corner first lifts from a rigid base, all bodies above rotate about the other corner.
    """
    found: list[Statics | None] = [None] * len(rotations)
    for side in (1, -1):
        before, lifted, path = 0.0, None, None
        joints = [_Joint(setting, k, side) for k, rigid in enumerate(setting.rigid) if rigid]
        here = [i for i, each in enumerate(rotations) if math.copysign(1.0, each) == side]
        for i in sorted(here, key=lambda i: abs(rotations[i])):
            if lifted is None:
                lifted = _first_lift(joints, before, rotations[i])
                if lifted is None:
                    before, found[i] = rotations[i], closed[i]
                    continue
                path = EquilibriumPath(lifted.rotation, lifted.place)
            if path is None:
                break
            path, poses = lifted.bodies.chain.held_at(path, rotations[i])
            found[i] = None if poses is None else lifted.bodies.statics_of(poses)
    return found


class _Lift(NamedTuple):
    """The state at which a corner lifts from a rigid base."""

    bodies: StandingBodies  # all bodies, those above the base on its other corner
    rotation: float  # rotation of the highest body [rad]
    place: ChainEquilibrium  # equilibrium of the bodies


def _first_lift(joints: "Sequence[_Joint]", before: float, rotation: float) -> _Lift | None:
    """Return the first lift between two rotations of the highest body, if there is one."""
    from scipy.optimize import brentq

    first: _Lift | None = None
    for joint in joints:
        if joint.spare(rotation) >= 0.0:
            continue
        at = before
        if joint.spare(before) > 0.0:
            at = cast("float", brentq(joint.spare, before, rotation))
        if first is None or abs(at) < abs(first.rotation):
            first = _Lift(joint.bodies, at, joint.lifted_from(at))
    return first


class _Joint:
    """A rigid base in full contact, in a stack with deformable bases."""

    def __init__(self, setting: "StackSetting", k: int, side: int) -> None:
        self.closed = setting.standing.chain
        whole = [*setting.groups]
        self.place = next((i for i, some in enumerate(whole) if k in some), len(whole))
        if self.place == len(whole):  # the bodies below rest on rigid ground
            whole.append(range(whole[-1][-1] + 1, k + 1))
        else:
            some = whole[self.place]
            whole[self.place : self.place + 1] = [range(some[0], k + 1), range(k + 1, some[-1] + 1)]
        self.bodies = setting.standing_in(whole, k, side)
        self.side = side

    def rotations(self, poses: Sequence[Pose]) -> list[float]:
        """Return the rotations of all bodies on their bases; 0 for the body on this base."""
        found = [one.state.rotation for one in poses]
        return [*found[: self.place], 0.0, *found[self.place :]]

    def lifted_from(self, rotation: float) -> ChainEquilibrium:
        """Return the equilibrium in which the corner lifts."""
        chain, (poses,) = self.bodies.chain, self.closed.curve([rotation])
        found = chain.poses_at(self.rotations(poses or [])) or []
        return ChainEquilibrium.from_poses(chain, found)

    def spare(self, rotation: float) -> float:
        """Return how much the couple that holds the highest body lacks to lift a corner."""
        (poses,) = self.closed.curve([rotation])
        if poses is None:
            return math.inf  # there is no equilibrium with this joint closed
        here = self.bodies.chain.poses_at(self.rotations(poses))
        if here is None:
            return math.inf
        lifts = self.bodies.chain.moments(here)[self.place]
        return self.side * (self.closed.moments(poses)[0] - lifts)
