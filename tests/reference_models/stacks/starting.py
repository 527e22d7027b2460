"""Initial state of a stack: at rest, or with its top body rotated on its base."""

import math

import numpy as np
from scipy.optimize import root

from .contact import (
    CLEAR,
    HELD,
    RELAXING,
    TOUCHING,
    ContactState,
    Room,
    contacts_in_flight,
    room_of,
)
from .forces import accelerate, pad_force, stretched
from .impulses import note_places, relate
from .kinematics import end, sway
from .scene import CENTRE, LEADING_CORNER, WORKS, Scene, Stack


class NoRestError(Exception):
    """The stack falls by its own weight."""


def start(scene: Scene, stack: Stack) -> tuple[np.ndarray, ContactState, Room]:
    """Return state, contact and work arrays at the start.

    Raises
    ------
    NoRestError
    """
    angles, middles = rest_of(stack)
    rate = 0.0
    if scene.rotation is not None:
        angles[0], rate = scene.rotation, scene.rate
        middles[0] = height_over_base(stack, 0, scene.rotation)
    return state_at(stack, angles, middles, rate)


def height_over_base(stack: Stack, k: int, angle: float) -> float:
    """Return the height of the middle of a base that carries its load at a rotation."""
    raised, delta = stack.half_width[k] * abs(math.sin(angle)), stack.settlement[k]
    if raised <= delta:
        return 0.0
    return (math.sqrt(raised) - math.sqrt(delta)) ** 2 if stack.is_bed[k] else raised - delta


def rest_of(stack: Stack) -> tuple[np.ndarray, np.ndarray]:
    """Return rotations and middle heights of all bases at rest, relative to their supports.

    Raises
    ------
    NoRestError
    """
    n = stack.mass.size
    upright = np.zeros(n), np.zeros(n)
    if not (stack.across.any() or stack.eccentricity.any()):
        return upright
    sizes = np.append(stack.settlement / stack.half_width, stack.settlement)

    def residuals(shares: np.ndarray) -> np.ndarray:
        z, contact, room = state_at(stack, *np.split(shares * sizes, 2))
        accelerate(z, 0.0, 0.0, stack, contact, room)
        # forces over the loads
        residual = room.out[: 3 * n].reshape(n, 3) / stack.inverse[: 3 * n].reshape(n, 3)
        turning = residual[:, 2] / (stack.load * stack.half_width)
        return np.append(turning, residual[:, 1] / stack.load)

    solution = root(residuals, np.zeros(2 * n), tol=1e-15).x
    if not np.max(np.abs(residuals(solution))) < 1e-11:
        raise NoRestError
    angles, middles = np.split(solution * sizes, 2)
    return angles, middles


def state_at(stack: Stack, angles, middles, rate=0.0) -> tuple[np.ndarray, ContactState, Room]:
    """Return the state with all bases at given rotations and heights relative to their supports.

    Each held point is at its place along the support. The top body has a relative rate.
    """
    n, count = stack.mass.size, stack.inverse.size
    z = np.zeros(2 * count + WORKS)
    contact, room = contacts_in_flight(n, len(stack.ties)), room_of(n)
    for k in range(n - 1, -1, -1):
        angle, e = angles[k], stack.eccentricity[k]
        i, tilt, turning = 3 * k, z[3 * k + 5], rate if k == 0 else 0.0
        far = 2.0 * stack.height[k] * math.sin(0.5 * angle) ** 2
        rise = middles[k] - far - e * math.sin(angle)
        z[i + 2] = tilt + angle
        z[count + i + 2] = turning
        _put(z, k, stack, 0.0, rise)
        relate(z, stack, room)
        _stand(stack, contact, room, k)
        _lead(contact, k, angle or turning or e)
        contact.point[k] = _point(stack, contact, k)
        # sway at which the middle of the unrotated base is above its place
        off = sway(k, contact.point[k], stack, room)[0] + contact.point[k]
        _put(z, k, stack, off, rise)
        relate(z, stack, room)
        if contact.hold[k] == HELD:
            speed = sway(k, contact.point[k], stack, room)[1] * turning
            z[count + i] = math.cos(tilt) * speed
            z[count + i + 1] = -math.sin(tilt) * speed
    note_places(z, stack, contact, room)
    for which, tie in enumerate(stack.ties):
        dx, dy, _, _, rest_length = stretched(which, z, stack, np.zeros((2, 2)))
        contact.taut[which] = 1.0 if math.hypot(dx, dy) - rest_length > tie[10] else -1.0
    return z, contact, room


def _put(z: np.ndarray, k: int, stack: Stack, off: float, rise: float) -> None:
    """Move a body along and normal to its support from its position at rest."""
    i, tilt = 3 * k, z[3 * k + 5]
    sine, cosine, less = math.sin(tilt), math.cos(tilt), 2.0 * math.sin(0.5 * tilt) ** 2
    far, across = stack.apart[k] + rise, stack.across[k]
    z[i] = z[i + 3] + far * sine + off * cosine - across * less
    z[i + 1] = z[i + 4] + rise - far * less - (across + off) * sine


def _stand(stack: Stack, contact: ContactState, room: Room, k: int) -> None:
    """Let the ends of a base touch that are below the unloaded level."""
    for i in range(2):
        pressed = end(k, i, stack, room)[0] < stack.settlement[k]
        pushes = stack.is_bed[k] or pad_force(k, i, stack, room) > 0.0
        contact.ends[k, i] = (TOUCHING if pushes else RELAXING) if pressed else CLEAR
    if TOUCHING in contact.ends[k]:
        contact.hold[k] = HELD


def _lead(contact: ContactState, k: int, leans: float) -> None:
    contact.lead[k] = 1.0 if leans >= 0.0 else -1.0


def _point(stack: Stack, contact: ContactState, k: int) -> float:
    b, middle = stack.half_width[k], -stack.eccentricity[k]
    left, right = (state == TOUCHING for state in contact.ends[k])
    if stack.rule == CENTRE:
        return middle
    if stack.rule == LEADING_CORNER:
        return middle + b * contact.lead[k]
    if left == right:
        return middle
    return middle + b if right else middle - b
