"""A scene in SI units, and the arrays of the reference model's equations."""

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from . import layout as at

GRAVITY = 9.80665
KINDS = ("pads", "bed", "cascade", "coupled", "rigid")


@dataclass(frozen=True)
class Scene:
    """A body, its base and its ground motion, in SI units or ratios.

    `radius` and `slenderness` are those of a block whose centre of mass stands above the middle of
    its base; `eccentricity` then moves it to the right. `told` makes a start at rotation
    zero explicit where the block would lean at rest. The base rises to the right by
    `inclination`; rotations are relative to it.
    """

    kind: str
    rule: str = "contact-state"
    radius: float = 5.0
    slenderness: float = 4.0
    mass: float = 5e4
    shape_factor: float = 3.0
    eccentricity: float = 0.0
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
    told: bool = False
    inclination: float = 0.0
    free: float = 2.0
    motion: dict[str, Any] = field(default_factory=dict)

    @property
    def theta(self) -> float:
        """Overturning angle of the block without eccentricity."""
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
        """Return mass, inertia, half width and height of the centre of mass of block and cap."""
        m, h = self.mass, self.half_height
        if not self.has_cap:
            return m, self.inertia, self.half_width, h
        cap, thick, width = self.cap_mass, self.cap_height, self.cap_width
        total = m + cap
        level = (m * (thick + h) + 0.5 * cap * thick) / total
        inertia = self.inertia + m * (thick + h - level) ** 2 + self.cap_inertia
        inertia += cap * (level - 0.5 * thick) ** 2
        # both are eccentric to their common centre of mass, too
        inertia += m * cap / total * self.eccentricity**2
        return total, inertia, 0.5 * width, level

    @property
    def one_body_eccentricity(self) -> float:
        """Distance of the centre of mass of block and cap to the right of the cap's middle."""
        if not self.has_cap:
            return self.eccentricity
        return self.mass * self.eccentricity / (self.mass + self.cap_mass)

    @property
    def cap_inertia(self) -> float:
        """Moment of inertia of the cap about its centre."""
        return self.cap_mass * (self.cap_width**2 + self.cap_height**2) / 12.0

    @property
    def eps(self) -> float:
        """Restitution, by default that of a symmetric block."""
        if self.restitution is not None:
            return self.restitution
        mu = self.shape_factor
        return (1.0 + mu * math.cos(2.0 * self.theta)) / (1.0 + mu)

    def limits(self) -> tuple[float, float]:
        """Return the overturning angles of the block to the left and to the right."""
        if self.eccentricity == 0.0:
            return self.theta, self.theta
        b, h, e = self.half_width, self.half_height, self.eccentricity
        return math.atan((b + e) / h), math.atan((b - e) / h)

    def rebounds(self) -> tuple[float, float]:
        """Return the restitutions of impacts on the left and on the right corner.

        The default conserves angular momentum about the new corner: m v moves about the old
        corner, at a distance d from the foot of the centre of mass, when the new one at d' comes
        down.
        """
        if self.restitution is not None or self.eccentricity == 0.0:
            return self.eps, self.eps
        left, right = self.half_width + self.eccentricity, self.half_width - self.eccentricity
        base = self.inertia + self.mass * self.half_height**2
        retained = base - self.mass * left * right
        return retained / (base + self.mass * left**2), retained / (base + self.mass * right**2)


def parameters(scene: Scene, tolerance: float) -> np.ndarray:
    """Return the parameters of a scene as an array."""
    p = np.zeros(at.PARAMETERS)
    weight = GRAVITY * math.cos(scene.inclination)  # of a unit of mass, normal to the base
    p[at.GRAVITY] = weight
    p[at.RULE] = at.RULES.index(scene.rule)
    p[at.SMALL] = scene.small
    p[at.KIND] = KINDS_NUMBER[scene.kind]
    p[at.TOLERANCE] = tolerance
    p[at.LEFT_LIMIT], p[at.RIGHT_LIMIT] = scene.limits()
    p[at.NO_SUCTION] = scene.separation == "pressure"
    if scene.kind != "bed":
        p[at.MASS], p[at.INERTIA] = scene.mass, scene.inertia
        p[at.HALF_WIDTH], p[at.HALF_HEIGHT] = scene.half_width, scene.half_height
        p[at.ECCENTRICITY] = scene.eccentricity
        p[at.LEFT_RESTITUTION], p[at.RIGHT_RESTITUTION] = scene.rebounds()
    if scene.kind not in ("bed", "rigid"):
        fast = scene.beta * scene.frequency
        p[at.STIFFNESS] = 0.5 * scene.mass * fast**2
        p[at.DAMPING] = scene.xi * scene.mass * fast
        p[at.SETTLEMENT] = scene.mass * weight / (2.0 * p[at.STIFFNESS])
    if scene.kind in ("bed", "cascade", "coupled"):
        _soil(scene, p)
    # the centre of mass is above an end of the base
    p[at.LEFT_LIMIT] -= scene.inclination
    p[at.RIGHT_LIMIT] += scene.inclination
    p[at.LIMIT] = min(p[at.LEFT_LIMIT], p[at.RIGHT_LIMIT])
    return p


def _soil(scene: Scene, p: np.ndarray) -> None:
    m, inertia, b, level = scene.one_body()
    total = m
    eccentricity = scene.one_body_eccentricity
    p[at.TOP] = scene.cap_height - level
    if scene.kind == "coupled":
        m, inertia, level = scene.cap_mass, scene.cap_inertia, 0.5 * scene.cap_height
        p[at.TOP] = level
        eccentricity = 0.0
    if scene.kind == "bed":
        p[at.LEFT_LIMIT] = math.atan((b + eccentricity) / level)
        p[at.RIGHT_LIMIT] = math.atan((b - eccentricity) / level)
    p[at.LOWER_ECCENTRICITY] = eccentricity
    p[at.LOWER_MASS], p[at.LOWER_INERTIA] = m, inertia
    p[at.LOWER_HALF_WIDTH], p[at.LOWER_HEIGHT] = b, level
    p[at.BED_STIFFNESS] = scene.soil_stiffness
    p[at.BED_SETTLEMENT] = total * p[at.GRAVITY] / (2.0 * b * scene.soil_stiffness)
    bed_damping = 2.0 * scene.soil_xi * math.sqrt(2.0 * b * scene.soil_stiffness * total)
    p[at.BED_DAMPING] = bed_damping / (2.0 * b)


KINDS_NUMBER = {
    "pads": at.PADS,
    "bed": at.BED,
    "cascade": at.CASCADE,
    "coupled": at.COUPLED,
    "rigid": at.RIGID,
}


def paces(scene: Scene, p: np.ndarray) -> float:
    """Return an upper bound for the angular frequencies of the vibration."""
    rate = 4.0 * scene.frequency
    if p[at.STIFFNESS] > 0.0:
        light = 1.0 / p[at.MASS] + (1.0 / p[at.LOWER_MASS] if scene.kind == "coupled" else 0.0)
        rate = max(rate, math.sqrt(4.0 * p[at.STIFFNESS] * light) + 2.0 * p[at.DAMPING] * light)
    if p[at.BED_STIFFNESS] > 0.0:
        width = 2.0 * p[at.LOWER_HALF_WIDTH]
        k, c = p[at.BED_STIFFNESS] * width, p[at.BED_DAMPING] * width
        light = 3.0 / p[at.LOWER_MASS]
        rate = max(rate, math.sqrt(k * light) + c * light)
    return rate


def mirrored(scene: Scene) -> Scene:
    """Return the scene with left and right exchanged, for still ground."""
    return replace(
        scene,
        start=-scene.start,
        start_rate=-scene.start_rate,
        eccentricity=-scene.eccentricity,
        inclination=-scene.inclination,
    )
