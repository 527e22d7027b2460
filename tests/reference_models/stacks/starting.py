"""Where a stack starts: at rest, or with its top body rotated on its base."""

import math

import numpy as np
from scipy.optimize import root

from .contact import (
    CLEAR,
    HELD,
    RELAXING,
    TOUCHING,
    Room,
    Standing,
    room_of,
    standing_of,
)
from .forces import accelerate, pad_force, stretched
from .impulses import note_places, relate
from .kinematics import end, sway
from .scene import CENTRE, LEADING_CORNER, WORKS, Scene, Stack


class NoRestError(Exception):
    """The stack falls by its own weight."""


def start(scene: Scene, stack: Stack) -> tuple[np.ndarray, Standing, Room]:
    """Return state, standing and room at the start.

    Raises
    ------
    NoRestError
    """
    angles, middles = rest_of(stack)
    rate = 0.0
    if scene.rotation is not None:
        angles[0], rate = scene.rotation, scene.rate
        middles[0] = height_over_base(stack, 0, scene.rotation)
    return placed(stack, angles, middles, rate)


def height_over_base(stack: Stack, k: int, angle: float) -> float:
    """Return the height of the middle of a base that carries its load at a rotation."""
    raised, delta = stack.half_width[k] * abs(math.sin(angle)), stack.settlement[k]
    if raised <= delta:
        return 0.0
    return (math.sqrt(raised) - math.sqrt(delta)) ** 2 if stack.is_bed[k] else raised - delta


def rest_of(stack: Stack) -> tuple[np.ndarray, np.ndarray]:
    """Return rotations and heights of the middles of all bases, on what carries them, at rest.

    Raises
    ------
    NoRestError
    """
    n = stack.mass.size
    upright = np.zeros(n), np.zeros(n)
    if not (stack.across.any() or stack.eccentricity.any()):
        return upright
    sizes = np.append(stack.settlement / stack.half_width, stack.settlement)

    def lacks(shares: np.ndarray) -> np.ndarray:
        z, standing, room = placed(stack, *np.split(shares * sizes, 2))
        accelerate(z, 0.0, 0.0, stack, standing, room)
        # forces over the loads
        lack = room.out[: 3 * n].reshape(n, 3) / stack.inverse[: 3 * n].reshape(n, 3)
        turning = lack[:, 2] / (stack.load * stack.half_width)
        return np.append(turning, lack[:, 1] / stack.load)

    found = root(lacks, np.zeros(2 * n), tol=1e-15).x
    if not np.max(np.abs(lacks(found))) < 1e-11:
        raise NoRestError
    angles, middles = np.split(found * sizes, 2)
    return angles, middles


def placed(stack: Stack, angles, middles, rate=0.0) -> tuple[np.ndarray, Standing, Room]:
    """Return the state with all bases at rotations and heights on what carries them.

    Each held point is at its place along that. The top body has a relative rate.
    """
    n, count = stack.mass.size, stack.inverse.size
    z = np.zeros(2 * count + WORKS)
    standing, room = standing_of(n, len(stack.ties)), room_of(n)
    for k in range(n - 1, -1, -1):
        angle, e = angles[k], stack.eccentricity[k]
        i, tilt, turning = 3 * k, z[3 * k + 5], rate if k == 0 else 0.0
        far = 2.0 * stack.height[k] * math.sin(0.5 * angle) ** 2
        rise = middles[k] - far - e * math.sin(angle)
        z[i + 2] = tilt + angle
        z[count + i + 2] = turning
        _put(z, k, stack, 0.0, rise)
        relate(z, stack, room)
        _stand(stack, standing, room, k)
        _lead(standing, k, angle or turning or e)
        standing.point[k] = _point(stack, standing, k)
        # the middle of the base, at no rotation, is above its place
        off = sway(k, standing.point[k], stack, room)[0] + standing.point[k]
        _put(z, k, stack, off, rise)
        relate(z, stack, room)
        if standing.hold[k] == HELD:
            speed = sway(k, standing.point[k], stack, room)[1] * turning
            z[count + i] = math.cos(tilt) * speed
            z[count + i + 1] = -math.sin(tilt) * speed
    note_places(z, stack, standing, room)
    for which, tie in enumerate(stack.ties):
        dx, dy, _, _, given = stretched(which, z, stack, np.zeros((2, 2)))
        standing.taut[which] = 1.0 if math.hypot(dx, dy) - given > tie[10] else -1.0
    return z, standing, room


def _put(z: np.ndarray, k: int, stack: Stack, off: float, rise: float) -> None:
    """Place a body along and above its place at rest on what carries it."""
    i, tilt = 3 * k, z[3 * k + 5]
    sine, cosine, less = math.sin(tilt), math.cos(tilt), 2.0 * math.sin(0.5 * tilt) ** 2
    far, across = stack.apart[k] + rise, stack.across[k]
    z[i] = z[i + 3] + far * sine + off * cosine - across * less
    z[i + 1] = z[i + 4] + rise - far * less - (across + off) * sine


def _stand(stack: Stack, standing: Standing, room: Room, k: int) -> None:
    """Let the ends of a base touch that are below the level of what carries them."""
    for i in range(2):
        pressed = end(k, i, stack, room)[0] < stack.settlement[k]
        pushes = stack.is_bed[k] or pad_force(k, i, stack, room) > 0.0
        standing.ends[k, i] = (TOUCHING if pushes else RELAXING) if pressed else CLEAR
    if TOUCHING in standing.ends[k]:
        standing.hold[k] = HELD


def _lead(standing: Standing, k: int, leans: float) -> None:
    standing.lead[k] = 1.0 if leans >= 0.0 else -1.0


def _point(stack: Stack, standing: Standing, k: int) -> float:
    b, middle = stack.half_width[k], -stack.eccentricity[k]
    left, right = (state == TOUCHING for state in standing.ends[k])
    if stack.rule == CENTRE:
        return middle
    if stack.rule == LEADING_CORNER:
        return middle + b * standing.lead[k]
    if left == right:
        return middle
    return middle + b if right else middle - b
