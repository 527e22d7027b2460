"""A scene in SI units, and the arrays that the equations of the reference model want."""

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from . import layout as at
from .rigid_switches import place_hinged

GRAVITY = 9.80665
KINDS = ("pads", "bed", "cascade", "coupled", "rigid")


@dataclass(frozen=True)
class Scene:
    """A body, what it stands on, and how it is shaken; all in SI units or ratios."""

    kind: str
    rule: str = "contact-state"
    radius: float = 5.0
    slenderness: float = 4.0
    mass: float = 5e4
    shape_factor: float = 3.0
    beta: float = 20.0
    xi: float = 0.1
    restitution: float | None = None
    small: bool = False
    soil_stiffness: float = 0.0
    soil_xi: float = 0.1
    separation: str = "displacement"
    cap: bool = False
    cap_width: float = 0.0
    cap_height: float = 0.0
    cap_mass: float = 0.0
    start: float = 0.0
    start_rate: float = 0.0
    free: float = 2.0
    motion: dict[str, Any] = field(default_factory=dict)

    @property
    def theta(self) -> float:
        """Overturning angle of the block."""
        return math.atan(1.0 / self.slenderness)

    @property
    def half_width(self) -> float:
        """Half the width of the block."""
        return self.radius * math.sin(self.theta)

    @property
    def half_height(self) -> float:
        """Half the height of the block."""
        return self.radius * math.cos(self.theta)

    @property
    def inertia(self) -> float:
        """Moment of inertia about the centre of mass."""
        return self.mass * self.radius**2 / self.shape_factor

    @property
    def frequency(self) -> float:
        """Rocking frequency of the block."""
        mu = self.shape_factor
        return math.sqrt(mu / (1.0 + mu) * GRAVITY / self.radius)

    @property
    def has_cap(self) -> bool:
        """Whether there is a cap."""
        return self.cap or self.kind in ("cascade", "coupled")

    def one_body(self) -> tuple[float, float, float, float]:
        """Give mass, inertia, half width and height of the centre of mass of block and cap."""
        m, h = self.mass, self.half_height
        if not self.has_cap:
            return m, self.inertia, self.half_width, h
        cap, thick, width = self.cap_mass, self.cap_height, self.cap_width
        total = m + cap
        level = (m * (thick + h) + 0.5 * cap * thick) / total
        inertia = self.inertia + m * (thick + h - level) ** 2 + self.cap_inertia
        inertia += cap * (level - 0.5 * thick) ** 2
        return total, inertia, 0.5 * width, level

    @property
    def cap_inertia(self) -> float:
        """Moment of inertia of the cap about its centre."""
        return self.cap_mass * (self.cap_width**2 + self.cap_height**2) / 12.0

    @property
    def eps(self) -> float:
        """Restitution; the default is that of angular momentum kept about the new corner."""
        if self.restitution is not None:
            return self.restitution
        mu = self.shape_factor
        return (1.0 + mu * math.cos(2.0 * self.theta)) / (1.0 + mu)


def parameters(scene: Scene, tolerance: float) -> np.ndarray:
    """Give the parameters of a scene as an array."""
    p = np.zeros(at.PARAMETERS)
    p[at.GRAVITY] = GRAVITY
    p[at.RULE] = at.RULES.index(scene.rule)
    p[at.SMALL] = scene.small
    p[at.KIND] = KINDS_NUMBER[scene.kind]
    p[at.TOLERANCE] = tolerance
    p[at.LIMIT] = scene.theta
    p[at.NO_SUCTION] = scene.separation == "pressure"
    if scene.kind != "bed":
        p[at.MASS], p[at.INERTIA] = scene.mass, scene.inertia
        p[at.HALF_WIDTH], p[at.HALF_HEIGHT] = scene.half_width, scene.half_height
        p[at.RESTITUTION] = scene.eps
    if scene.kind not in ("bed", "rigid"):
        fast = scene.beta * scene.frequency
        p[at.STIFFNESS] = 0.5 * scene.mass * fast**2
        p[at.DAMPING] = scene.xi * scene.mass * fast
        p[at.SETTLEMENT] = scene.mass * GRAVITY / (2.0 * p[at.STIFFNESS])
    if scene.kind in ("bed", "cascade", "coupled"):
        _soil(scene, p)
    return p


def _soil(scene: Scene, p: np.ndarray) -> None:
    m, inertia, b, level = scene.one_body()
    total = m
    p[at.TOP] = scene.cap_height - level
    if scene.kind == "coupled":
        m, inertia, level = scene.cap_mass, scene.cap_inertia, 0.5 * scene.cap_height
        p[at.TOP] = level
    if scene.kind == "bed":
        p[at.LIMIT] = math.atan(b / level)
    p[at.LOWER_MASS], p[at.LOWER_INERTIA] = m, inertia
    p[at.LOWER_HALF_WIDTH], p[at.LOWER_HEIGHT] = b, level
    p[at.BED_STIFFNESS] = scene.soil_stiffness
    p[at.BED_SETTLEMENT] = total * GRAVITY / (2.0 * b * scene.soil_stiffness)
    whole = 2.0 * scene.soil_xi * math.sqrt(2.0 * b * scene.soil_stiffness * total)
    p[at.BED_DAMPING] = whole / (2.0 * b)


KINDS_NUMBER = {
    "pads": at.PADS,
    "bed": at.BED,
    "cascade": at.CASCADE,
    "coupled": at.COUPLED,
    "rigid": at.RIGID,
}


def start(scene: Scene, p: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Give state, contact and held points at the start, in vertical equilibrium."""
    z = np.zeros(at.STATES)
    contact = np.zeros(at.CONTACTS, dtype=np.int64)
    held = np.zeros(8)
    held[at.LOWER_LEAD] = held[at.LEAD] = 1.0
    angle = scene.start * p[at.LIMIT]
    sway = scene.start_rate * scene.frequency * p[at.LIMIT]
    bent = angle if scene.small else math.sin(angle)
    lean = math.copysign(1.0, angle if angle != 0.0 else 1.0)
    if scene.kind == "bed":
        _start_on_bed(p, z, contact, held, angle, sway, bent, lean)
        return z, contact, held
    b, h = p[at.HALF_WIDTH], p[at.HALF_HEIGHT]
    z[5], z[11] = angle, sway
    if scene.kind == "rigid":
        contact[at.HOLD] = at.RESTING
        if angle != 0.0 or sway != 0.0:
            contact[at.HOLD] = at.HELD
            held[at.POINT] = b * (lean if angle != 0.0 else math.copysign(1.0, sway))
            place_hinged(z, held, p)
        return z, contact, held
    delta = p[at.SETTLEMENT]
    middle = 0.0 if b * abs(bent) <= delta else b * abs(bent) - delta
    z[4] = middle - (0.5 * h * angle**2 if scene.small else h * (1.0 - math.cos(angle)))
    for i, side in enumerate((1.0, -1.0)):
        y = middle + side * b * bent
        lever = h * bent + side * b * (1.0 if scene.small else math.cos(angle))
        force = p[at.STIFFNESS] * (delta - y) - p[at.DAMPING] * lever * sway
        state = at.TOUCHING if force > 0.0 else at.RELAXING
        contact[at.LEFT + i] = at.CLEAR if y >= delta else state
    if contact[at.LEFT] == at.TOUCHING or contact[at.RIGHT] == at.TOUCHING:
        contact[at.HOLD] = at.HELD
    left, right = (contact[at.LEFT + i] == at.TOUCHING for i in range(2))
    held[at.POINT] = _point(scene.rule, b, left, right, angle, sway)
    held[at.LEAD] = 1.0 if (angle or sway) >= 0.0 else -1.0
    first = h if scene.small else h * math.cos(angle) + held[at.POINT] * math.sin(angle)
    # a block that starts in flight has the sway that is given, which is none
    z[9] = first * sway if contact[at.HOLD] == at.HELD else 0.0
    if scene.kind in ("cascade", "coupled"):
        contact[at.LOWER_HOLD] = at.HELD
        contact[at.BED_LEFT] = contact[at.BED_RIGHT] = at.TOUCHING
        if scene.rule == "leading-corner":
            held[at.LOWER_POINT] = p[at.LOWER_HALF_WIDTH]
        if scene.kind == "coupled":
            z[3] = _sway_to(scene, held[at.POINT], angle)
    return z, contact, held


def _sway_to(scene: Scene, point: float, angle: float) -> float:
    # the block's base stands with its middle over that of the cap
    h = scene.half_height
    if scene.small:
        return h * angle
    return h * math.sin(angle) + point * (1.0 - math.cos(angle))


def _start_on_bed(p, z, contact, held, angle, sway, bent, lean) -> None:
    b, h, delta = p[at.LOWER_HALF_WIDTH], p[at.LOWER_HEIGHT], p[at.BED_SETTLEMENT]
    small = p[at.SMALL] > 0.5
    middle = 0.0
    if b * abs(bent) > delta:
        middle = (math.sqrt(b * abs(bent)) - math.sqrt(delta)) ** 2
    z[1] = middle - (0.5 * h * angle**2 if small else h * (1.0 - math.cos(angle)))
    z[2], z[8] = angle, sway
    for i, side in enumerate((1.0, -1.0)):
        down = middle + side * b * bent < delta
        contact[at.BED_LEFT + i] = at.TOUCHING if down else at.CLEAR
    contact[at.LOWER_HOLD] = at.HELD
    rule = at.RULES[int(p[at.RULE])]
    left, right = (contact[at.BED_LEFT + i] == at.TOUCHING for i in range(2))
    held[at.LOWER_POINT] = _point(rule, b, left, right, angle, sway)
    held[at.LOWER_LEAD] = 1.0 if (angle or sway) >= 0.0 else -1.0
    first = h if small else h * math.cos(angle) + held[at.LOWER_POINT] * math.sin(angle)
    z[6] = first * sway


def _point(rule: str, b: float, left: bool, right: bool, angle: float, sway: float) -> float:
    if rule == "centre":
        return 0.0
    if rule == "leading-corner":
        return b if (angle or sway) >= 0.0 else -b
    if left == right:
        return 0.0
    return b if right else -b


def paces(scene: Scene, p: np.ndarray) -> float:
    """Give an upper bound for the angular frequencies of the vibration."""
    rate = 4.0 * scene.frequency
    if p[at.STIFFNESS] > 0.0:
        light = 1.0 / p[at.MASS] + (1.0 / p[at.LOWER_MASS] if scene.kind == "coupled" else 0.0)
        rate = max(rate, math.sqrt(4.0 * p[at.STIFFNESS] * light) + 2.0 * p[at.DAMPING] * light)
    if p[at.BED_STIFFNESS] > 0.0:
        whole = 2.0 * p[at.LOWER_HALF_WIDTH]
        k, c = p[at.BED_STIFFNESS] * whole, p[at.BED_DAMPING] * whole
        light = 3.0 / p[at.LOWER_MASS]
        rate = max(rate, math.sqrt(k * light) + c * light)
    return rate


def mirrored(scene: Scene) -> Scene:
    """Give the scene with left and right exchanged, for still ground."""
    return replace(scene, start=-scene.start, start_rate=-scene.start_rate)
