"""Initial state of a scene: at rest, or at a rotation in vertical equilibrium."""

import math

import numpy as np
from scipy.optimize import root

from . import layout as at
from .forces import accelerate, rooms
from .rest import NoRestError, Rest, lowered, rest_of
from .rigid_switches import place_hinged
from .scene import GRAVITY, Scene


def start(scene: Scene, p: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return state, contact and held points at the start."""
    z = np.zeros(at.STATES)
    contact = np.zeros(at.CONTACTS, dtype=np.int64)
    held = np.zeros(8)
    held[at.LOWER_LEAD] = held[at.LEAD] = 1.0
    angle, rate = scene.start * p[at.LIMIT], scene.start_rate * scene.frequency * p[at.LIMIT]
    if scene.kind == "rigid":
        _on_rigid_ground(p, z, contact, held, angle, rate)
        return z, contact, held
    rest = rest_on_slope(scene, p) if scene.inclination else rest_of(scene, p)
    explicit_start = scene.told or angle != 0.0
    if scene.kind == "bed":
        height = _height_over_bed(p, angle) if explicit_start else rest.lower_height
        _lower(
            scene, p, z, contact, held, angle if explicit_start else rest.lower_angle, height, rate
        )
        return z, contact, held
    if scene.kind in ("cascade", "coupled"):
        _lower(scene, p, z, contact, held, rest.lower_angle, rest.lower_height, 0.0)
    on_base, height = rest.angle, rest.height
    if explicit_start:
        on_base = angle - rest.lower_angle
        height = _height_over_pads(p, on_base)
    _upper(scene, p, z, contact, held, on_base, height, rate)
    return z, contact, held


def rest_on_slope(scene: Scene, p: np.ndarray) -> Rest:
    """Return the position of rest on an inclined base, with all bases in full contact.

    All accelerations of the equations of motion vanish there.

    Raises
    ------
    NoRestError
        There is none, or a part of a base has no contact in it.
    """
    lower, upper = scene.kind != "pads", scene.kind != "bed"
    places = [1, 2] * lower + [4, 5] * upper
    pull, room, out = GRAVITY * math.sin(scene.inclination), rooms(p), np.zeros(10)
    sizes = [p[at.LIMIT], p[at.BED_SETTLEMENT]] * lower + [p[at.LIMIT], p[at.SETTLEMENT]] * upper

    def state_at(shares: np.ndarray) -> tuple[Rest, np.ndarray, np.ndarray, np.ndarray]:
        values = [float(value) for value in shares * np.array(sizes)]
        rest = Rest(*values) if lower else Rest(0.0, 0.0, *values)
        z, contact, held = np.zeros(at.STATES), np.zeros(at.CONTACTS, dtype=np.int64), np.zeros(8)
        if lower:
            _lower(scene, p, z, contact, held, rest.lower_angle, rest.lower_height, 0.0)
        if upper:
            _upper(scene, p, z, contact, held, rest.angle, rest.height, 0.0)
        return rest, z, contact, held

    def residuals(shares: np.ndarray) -> np.ndarray:
        accelerate(state_at(shares)[1], pull, 0.0, *state_at(shares)[2:], p, room, out)
        return out[places]

    solution = root(residuals, np.full(len(sizes), -1e-6 * np.sign(scene.inclination)), tol=1e-15).x
    rest, _, contact, _ = state_at(solution)
    bases = [at.BED_LEFT, at.BED_RIGHT] * lower + [at.LEFT, at.RIGHT] * upper
    pressed = all(contact[base] == at.TOUCHING for base in bases)
    if not (pressed and np.max(np.abs(residuals(solution))) < 1e-9 * GRAVITY):
        raise NoRestError
    return rest


def _on_rigid_ground(p, z, contact, held, angle: float, rate: float) -> None:
    z[5], z[11] = angle, rate
    contact[at.HOLD] = at.RESTING
    if angle != 0.0 or rate != 0.0:
        contact[at.HOLD] = at.HELD
        lean = math.copysign(1.0, angle if angle != 0.0 else rate)
        held[at.POINT] = p[at.HALF_WIDTH] * lean - p[at.ECCENTRICITY]
        place_hinged(z, held, p)


def _bent(p: np.ndarray, angle: float) -> float:
    return angle if p[at.SMALL] > 0.5 else math.sin(angle)


def _height_over_pads(p: np.ndarray, angle: float) -> float:
    # of the middle of the base, where the pads carry the weight
    raised = p[at.HALF_WIDTH] * abs(_bent(p, angle))
    return 0.0 if raised <= p[at.SETTLEMENT] else raised - p[at.SETTLEMENT]


def _height_over_bed(p: np.ndarray, angle: float) -> float:
    raised, delta = p[at.LOWER_HALF_WIDTH] * abs(_bent(p, angle)), p[at.BED_SETTLEMENT]
    return (math.sqrt(raised) - math.sqrt(delta)) ** 2 if raised > delta else 0.0


def _upper(scene: Scene, p, z, contact, held, angle, middle, rate) -> None:
    b, h, e, delta = p[at.HALF_WIDTH], p[at.HALF_HEIGHT], p[at.ECCENTRICITY], p[at.SETTLEMENT]
    bent = _bent(p, angle)
    cosine = 1.0 if scene.small else math.cos(angle)
    for i, side in enumerate((1.0, -1.0)):
        y = middle + side * b * bent
        lever = h * bent + (side * b + e) * cosine
        force = p[at.STIFFNESS] * (delta - y) - p[at.DAMPING] * lever * rate
        state = at.TOUCHING if force > 0.0 else at.RELAXING
        contact[at.LEFT + i] = at.CLEAR if y >= delta else state
    if contact[at.LEFT] == at.TOUCHING or contact[at.RIGHT] == at.TOUCHING:
        contact[at.HOLD] = at.HELD
    left, right = (contact[at.LEFT + i] == at.TOUCHING for i in range(2))
    held[at.LEAD] = _lead(angle, rate, e)
    held[at.POINT] = _point(scene.rule, b, left, right, held[at.LEAD]) - e
    sway = lowered(scene.small, held[at.POINT], h, angle)
    rise = middle - (0.5 * h * angle**2 if scene.small else h * (1.0 - math.cos(angle))) - e * bent
    first = h if scene.small else h * math.cos(angle) + held[at.POINT] * math.sin(angle)
    # a block that starts in flight has no sway
    speed = first * rate if contact[at.HOLD] == at.HELD else 0.0
    z[4], z[5], z[9], z[11] = rise, angle, speed, rate
    if scene.kind != "coupled":
        return
    # in the rotated frame of the cap
    tilt, far = z[2], p[at.TOP] + h + rise
    sine, cosine, less = math.sin(tilt), math.cos(tilt), 2.0 * math.sin(0.5 * tilt) ** 2
    z[3] = z[0] + far * sine + sway * cosine - e * less
    z[4] = z[1] + rise - far * less - (e + sway) * sine
    z[5] = tilt + angle
    z[9], z[10] = cosine * speed, -sine * speed


def _lower(scene: Scene, p, z, contact, held, angle, middle, rate) -> None:
    b, h, delta = p[at.LOWER_HALF_WIDTH], p[at.LOWER_HEIGHT], p[at.BED_SETTLEMENT]
    e, bent = p[at.LOWER_ECCENTRICITY], _bent(p, angle)
    z[1] = middle - (0.5 * h * angle**2 if scene.small else h * (1.0 - math.cos(angle))) - e * bent
    z[2], z[8] = angle, rate
    for i, side in enumerate((1.0, -1.0)):
        down = middle + side * b * bent < delta
        contact[at.BED_LEFT + i] = at.TOUCHING if down else at.CLEAR
    contact[at.LOWER_HOLD] = at.HELD
    left, right = (contact[at.BED_LEFT + i] == at.TOUCHING for i in range(2))
    held[at.LOWER_LEAD] = _lead(angle, rate, e)
    held[at.LOWER_POINT] = _point(scene.rule, b, left, right, held[at.LOWER_LEAD]) - e
    if scene.eccentricity != 0.0 or scene.inclination != 0.0:
        z[0] = lowered(scene.small, held[at.LOWER_POINT], h, angle)
    first = h if scene.small else h * math.cos(angle) + held[at.LOWER_POINT] * math.sin(angle)
    z[6] = first * rate


def _lead(angle: float, rate: float, eccentricity: float) -> float:
    return 1.0 if (angle or rate or eccentricity) >= 0.0 else -1.0


def _point(rule: str, b: float, left: bool, right: bool, lead: float) -> float:
    if rule == "centre":
        return 0.0
    if rule == "leading-corner":
        return b * lead
    if left == right:
        return 0.0
    return b if right else -b
