"""Contacts of the bodies: their kinematics in the six coordinates, and their friction."""

import math
from typing import NamedTuple

import numpy as np
from reference_models.rigid_pair.pair import ENDS, SIGN, Pair, turned

INTERFACES = ("ground", "joint")


class Friction(NamedTuple):
    """Static and kinetic coefficients; infinite ones hold. ``stick``: impacts never slip."""

    static: float = math.inf
    kinetic: float = math.inf
    stick: bool = False

    @property
    def holds(self) -> bool:
        """Whether slip is impossible."""
        return math.isinf(self.static)

    @property
    def sticks(self) -> bool:
        """Whether an impact never slips."""
        return self.stick or self.holds


class Bearing(NamedTuple):
    """The bearing ends of an interface, and the sense of its slip: 1 to the right, 0 held."""

    ends: tuple[str, ...] = ()
    slip: int = 0


class Pattern(NamedTuple):
    """Bearing and slip of the lower body on the ground and of the upper one on the lower one."""

    ground: Bearing
    joint: Bearing


STANDING = Pattern(Bearing(ENDS), Bearing(ENDS))


class Contact(NamedTuple):
    """An end of a base, at one instant.

    ``along`` and ``normal`` map the six velocities to those along and away from the surface;
    ``turns`` are the accelerations of both at constant rates.
    """

    along: list[float]
    normal: list[float]
    turns: tuple[float, float]


def upper_end(pair: Pair, end: str) -> tuple[float, float]:
    """Return an end of the upper base relative to the upper centre of mass."""
    return pair.upper.from_centre(SIGN[end] * pair.upper.half_width, -pair.upper.below)


def lower_end(pair: Pair, end: str) -> tuple[float, float]:
    """Return an end of the lower base relative to the lower centre of mass."""
    return pair.lower.from_centre(SIGN[end] * pair.lower.half_width, -pair.lower.below)


def upright_places(pair: Pair) -> np.ndarray:
    """Return the six coordinates of upright bodies."""
    lower, upper = pair.lower, pair.upper
    level = lower.below + lower.above + upper.below
    return np.array([lower.beside, lower.below, 0.0, pair.offset + upper.beside, level, 0.0])


def contact(pair: Pair, place, speed, key: str, end: str) -> Contact:
    """Describe an end of the lower base on the ground, or of the upper base on the lower top."""
    x1, y1, a1, x2, y2, a2 = place
    u1, v1, w1, u2, v2, w2 = speed
    if key == "ground":
        x, y = turned(a1, *lower_end(pair, end))
        return Contact(
            [1.0, 0.0, y, 0.0, 0.0, 0.0], [0.0, 1.0, -x, 0.0, 0.0, 0.0],
            (-w1 * w1 * x, -w1 * w1 * y),
        )  # fmt: skip
    cx, cy = turned(a2, *upper_end(pair, end))
    rx, ry = x2 + cx - x1, y2 + cy - y1
    # velocity relative to the lower body; Coriolis' acceleration is normal to it
    qx, qy = u2 + w2 * cy - u1 - w1 * ry, v2 - w2 * cx - v1 + w1 * rx
    bx = -w2 * w2 * cx + w1 * w1 * rx - 2.0 * w1 * qy
    by = -w2 * w2 * cy + w1 * w1 * ry + 2.0 * w1 * qx
    rows, turns = [], []
    for dx, dy in (turned(a1, 1.0, 0.0), turned(a1, 0.0, 1.0)):
        rows.append([-dx, -dy, dy * rx - dx * ry, dx, dy, dx * cy - dy * cx])
        turns.append(dx * bx + dy * by)
    return Contact(rows[0], rows[1], (turns[0], turns[1]))


def on_top(pair: Pair, place, end: str) -> tuple[float, float]:
    """Return an end of the upper base: along the lower top from its middle, and above it."""
    x1, y1, a1, x2, y2, a2 = place
    cx, cy = turned(a2, *upper_end(pair, end))
    x, y = turned(-a1, x2 + cx - x1, y2 + cy - y1)
    return x + pair.lower.beside, y - pair.lower.above


def height(pair: Pair, place, end: str) -> float:
    """Return the height of an end of the lower base."""
    return place[1] + turned(place[2], *lower_end(pair, end))[1]


def tidied(pair: Pair, pattern: Pattern, place) -> np.ndarray:
    """Move bearing ends back on their surfaces, which steps leave by rounding."""
    place = np.array(place, dtype=float)
    ends = pattern.ground.ends
    if len(ends) == 2:
        place[2] = 0.0
    if ends:
        place[1] -= height(pair, place, ends[0])
    ends = pattern.joint.ends
    if ends:
        at = [on_top(pair, place, end)[0] for end in ends]
        if len(ends) == 2:
            place[5] = place[2]
        along = sum(at) / len(at) - sum(on_top(pair, place, end)[0] for end in ends) / len(at)
        above = on_top(pair, place, ends[0])[1]
        x, y = turned(place[2], along, -above)
        place[3] += x
        place[4] += y
    return place


def middle_slips(pair: Pair, place, speed) -> tuple[float, float]:
    """Return the velocities of the middles of both bases along the surfaces under them."""
    slips = []
    for key in INTERFACES:
        rows = [contact(pair, place, speed, key, end).along for end in ENDS]
        slips.append(0.5 * sum(float(np.dot(row, speed)) for row in rows))
    return slips[0], slips[1]
