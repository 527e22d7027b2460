"""A stack of bodies in SI units, and the arrays of the equations."""

import math
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

GRAVITY = 9.80665
# restraint rules
CONTACT_STATE, LEADING_CORNER, CENTRE = 0, 1, 2
RULES = ("contact-state", "leading-corner", "centre")
# entries of a state after coordinates and rates: dissipated energy, work of the ground
WORKS = 2


@dataclass(frozen=True)
class Body:
    """A rigid body.

    `height` is that of the centre of mass above the base, `top` that of the deck above the centre
    of mass. The centre of mass is `eccentricity` to the right of the middle of the base, which is
    `offset` to the right of the middle of the base below. The run ends at a rotation of `limit`;
    None: where the common centre of mass of the body and of all upright bodies on it is above the
    end of the base.
    """

    mass: float
    inertia: float
    half_width: float
    height: float
    top: float
    offset: float = 0.0
    eccentricity: float = 0.0
    limit: float | None = None


@dataclass(frozen=True)
class Pads:
    """Two pads under the ends of a base; stiffness and damping are those of each.

    A restitution for both, or one for the left and one for the right.
    """

    stiffness: float
    damping: float
    restitution: float | tuple[float, float]


@dataclass(frozen=True)
class Bed:
    """A bed under a base; stiffness and damping per length. It parts by displacement."""

    stiffness: float
    damping: float


@dataclass(frozen=True)
class Tie:
    """A spring beside a dashpot between points of two bodies, or of one and the ground (None).

    Points are from the centres of mass, on the ground from the middle of the lowest base. It pulls
    beyond `slack`; without slack (None) it is a bar, which also pushes.
    """

    on: int
    on_point: tuple[float, float]
    to: int | None
    to_point: tuple[float, float]
    stiffness: float
    damping: float
    slack: float | None


@dataclass(frozen=True)
class Scene:
    """Bodies from the top down, their bases, and the motion of the ground.

    The stack starts at rest. If `rotation` is not None the top body is rotated by it relative to
    the body below, in vertical equilibrium on its base, with the relative rate `rate`.
    """

    bodies: tuple[Body, ...]
    bases: tuple[Pads | Bed, ...]
    rule: str = "contact-state"
    rotation: float | None = None
    rate: float = 0.0
    free: float = 2.0
    motion: dict[str, Any] = field(default_factory=dict)
    ties: tuple[Tie, ...] = ()


class Stack(NamedTuple):
    """The numbers of a scene; body k stands on body k + 1, the last one on the ground.

    The ground is a body of zero inverse mass, at rest at zero.
    """

    inverse: np.ndarray  # of masses and inertias, for each coordinate
    mass: np.ndarray
    half_width: np.ndarray
    height: np.ndarray
    eccentricity: np.ndarray
    across: np.ndarray  # from the centre of mass of the support to the body's own, at rest
    apart: np.ndarray
    is_bed: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    restitution: np.ndarray
    settlement: np.ndarray
    load: np.ndarray  # weight of a body and of all above it
    limits: np.ndarray  # to the left and to the right
    rule: int
    gravity: float
    tolerance: float
    pace: float  # upper bound for the angular frequencies
    ties: np.ndarray  # of each: bodies, points, distance at rest, stiffness, damping, slack


def stack_of(scene: Scene, tolerance: float) -> Stack:
    """Return the numbers of a scene."""
    bodies, bases = scene.bodies, scene.bases
    n = len(bodies)
    mass = np.array([body.mass for body in bodies])
    inverse = np.zeros(3 * (n + 1))
    for k, body in enumerate(bodies):
        inverse[3 * k : 3 * k + 3] = 1.0 / body.mass, 1.0 / body.mass, 1.0 / body.inertia
    carried = np.cumsum(mass)
    wide = np.array([body.half_width for body in bodies])
    beside = np.array([body.eccentricity for body in bodies])
    level = np.array([body.height for body in bodies])
    is_bed = np.array([isinstance(base, Bed) for base in bases])
    stiffness = np.array([base.stiffness for base in bases])
    damping = np.array([base.damping for base in bases])
    # ratio of a whole base to a pad, or to a unit length
    size = np.where(is_bed, 2.0 * wide, 2.0)
    offset = np.array([body.offset for body in bodies])
    return Stack(
        inverse=inverse,
        mass=mass,
        half_width=wide,
        height=level,
        eccentricity=beside,
        across=offset + beside - np.append(beside[1:], 0.0),
        apart=level + np.append([body.top for body in bodies[1:]], 0.0),
        is_bed=is_bed,
        stiffness=stiffness,
        damping=damping,
        restitution=np.array([_rebounds(base) for base in bases]),
        settlement=carried * GRAVITY / (size * stiffness),
        load=carried * GRAVITY,
        limits=np.array([_limits(bodies, k) for k in range(n)]),
        rule=RULES.index(scene.rule),
        gravity=GRAVITY,
        tolerance=tolerance,
        pace=_pace(inverse, size * stiffness, size * damping, wide) + _pace_of_ties(scene, inverse),
        ties=np.array([_tie_row(scene, tie) for tie in scene.ties]).reshape(-1, 11),
    )


def centre_of(scene: Scene, k: int) -> tuple[float, float]:
    """Return the centre of mass of an upright body from the middle of the lowest base."""
    bodies = scene.bodies
    level = sum(one.height + one.top for one in bodies[k + 1 :]) + bodies[k].height
    return sum(one.offset for one in bodies[k:-1]) + bodies[k].eccentricity, level


def apart(scene: Scene, tie: Tie) -> tuple[float, float]:
    """Return the vector from the second point of a tie to the first, upright."""
    x, y = centre_of(scene, tie.on)
    other = (0.0, 0.0) if tie.to is None else centre_of(scene, tie.to)
    return (
        x + tie.on_point[0] - other[0] - tie.to_point[0],
        y + tie.on_point[1] - other[1] - tie.to_point[1],
    )


def _tie_row(scene: Scene, tie: Tie) -> tuple[float, ...]:
    to = -1 if tie.to is None else tie.to
    slack = -math.inf if tie.slack is None else tie.slack
    return (
        tie.on, *tie.on_point, to, *tie.to_point, *apart(scene, tie), tie.stiffness, tie.damping,
        slack,
    )  # fmt: skip


def _pace_of_ties(scene: Scene, inverse: np.ndarray) -> float:
    total = 0.0
    for tie in scene.ties:
        for k, (x, y) in ((tie.on, tie.on_point), (tie.to, tie.to_point)):
            if k is not None:
                light = inverse[3 * k] + (x * x + y * y) * inverse[3 * k + 2]
                total += math.sqrt(tie.stiffness * light) + tie.damping * light
    return total


def _rebounds(base: Pads | Bed) -> tuple[float, float]:
    if isinstance(base, Bed):
        return 1.0, 1.0
    restitution = base.restitution
    return restitution if isinstance(restitution, tuple) else (restitution, restitution)


def _limits(bodies: tuple[Body, ...], k: int) -> tuple[float, float]:
    """Return the overturning angles of a body to the left and to the right."""
    body = bodies[k]
    if body.limit is not None:
        return body.limit, body.limit
    mass, moment, rise = body.mass, body.mass * body.eccentricity, body.mass * body.height
    base, place = 0.0, 0.0
    for j in range(k, 0, -1):
        below, above = bodies[j], bodies[j - 1]
        base, place = base + below.height + below.top, place + above.offset
        mass += above.mass
        moment += above.mass * (place + above.eccentricity)
        rise += above.mass * (base + above.height)
    wide, beside = body.half_width, moment / mass
    return math.atan((wide + beside) * mass / rise), math.atan((wide - beside) * mass / rise)


def _pace(inverse, stiffness, damping, wide) -> float:
    fastest = 1.0
    for k in range(wide.size):
        here, under = inverse[3 * k : 3 * k + 3], inverse[3 * k + 3 : 3 * k + 6]
        light = here[0] + under[0] + wide[k] ** 2 * (here[2] + under[2])
        fastest = max(fastest, math.sqrt(2.0 * stiffness[k] * light) + damping[k] * light)
    return fastest


def mirrored(scene: Scene) -> Scene:
    """Return the scene with left and right exchanged, for still ground."""
    return replace(
        scene,
        bodies=tuple(
            replace(body, offset=-body.offset, eccentricity=-body.eccentricity)
            for body in scene.bodies
        ),
        rotation=None if scene.rotation is None else -scene.rotation,
        rate=-scene.rate,
    )
