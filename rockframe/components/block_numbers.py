"""The numbers of a block in SI units, and checks whether it can rock and can exist."""

import math
from dataclasses import dataclass, field
from typing import Any, Final

from rockframe.case_arrays import atan2, cos, hypot, sqrt
from rockframe.components.parameters import SIValues
from rockframe.constants import STANDARD_GRAVITY
from rockframe.errors import ComponentError

SOLID_RECTANGLE_SHAPE_FACTOR: Final = 3.0
"""mu of a solid rectangle: I_O = m (B^2 + H^2)/12 = m R0^2/3."""
_ROUNDING: Final = 1e-9
_PERCENT: Final = 0.01


class BodyGeometry:
    """Quantities that follow from the position of the centre of mass above the base of a body."""

    half_width: float  # b, half the width of the base [m]
    centre_height: float  # h, height of the centre of mass above the base [m]
    eccentricity: float  # e_c, distance of the centre of mass to the right of the middle [m]
    shape_factor: float  # mu [1]
    # horizontal distances from the centre of mass to the ends of the base, b + e_c, b - e_c [m]
    left: float
    right: float
    radius: float  # R0, distance from an end of the base to the point h above its middle [m]

    def __post_init__(self) -> None:
        b, eccentricity = self.half_width, self.eccentricity
        vars(self).update(
            left=b + eccentricity, right=b - eccentricity, radius=hypot(b, self.centre_height)
        )

    def frequency_at(self, gravity: float) -> float:
        """Angular frequency omega of Eq. (6) at an acceleration of gravity [rad s^-1]."""
        mu = self.shape_factor
        return sqrt(mu / (1.0 + mu) * gravity / self.radius)


@dataclass(frozen=True)
class BlockSI(BodyGeometry):
    """Geometry and mass of a block in SI units, :eq:`eq-eccentric-body`.

    The centre of mass is `centre_height` above the base and `eccentricity` to the right of its
    middle. With an eccentricity, angles, radii and restitutions differ between left and right.
    """

    width: float
    height: float
    mass: float
    shape_factor: float
    centre_height: float
    eccentricity: float = 0.0
    half_width: float = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        vars(self).update(half_width=0.5 * self.width)
        super().__post_init__()

    @property
    def half_height(self) -> float:
        """Half the height [m]."""
        return 0.5 * self.height

    @property
    def overturning_angle(self) -> float:
        """Overturning angle theta = arctan(b/h), Eq. (1); the lesser of both sides [rad]."""
        return atan2(min(self.left, self.right), self.centre_height)

    @property
    def inertia(self) -> float:
        """Moment of inertia I_O about the centre of mass [kg m^2]."""
        return self.mass * self.radius * self.radius / self.shape_factor

    @property
    def frequency(self) -> float:
        """Angular frequency omega of Eq. (6) at standard gravity [rad s^-1]."""
        return self.frequency_at(STANDARD_GRAVITY)

    @property
    def maximum_restitution(self) -> float:
        """eps_max = (1 + mu cos 2 theta)/(1 + mu), Eq. (4); the lesser of both corners."""
        return min(maximum_restitutions(self))


def maximum_restitutions(body: BodyGeometry) -> tuple[float, float]:
    """Return the ratios of the angular velocities after and before impacts, left and right corner.

    For a rigid body that goes on rocking about this corner without a bounce,
    :eq:`eq-eccentric-impact`; this is Eq. (4) if the centre of mass is above the middle.
    """
    mu, e = body.shape_factor, body.eccentricity
    b, h = body.half_width, body.centre_height
    square = b * b + h * h
    ratio = 1.0 + mu * (cos(2.0 * atan2(b, h)) + e * e / square)
    onto_left = 1.0 + mu * (1.0 + e * (e + 2.0 * b) / square)
    onto_right = 1.0 + mu * (1.0 + e * (e - 2.0 * b) / square)
    return ratio / onto_left, ratio / onto_right


def block_numbers(given: SIValues, owner: str) -> BlockSI:
    """Return the numbers of a block from its parameters; refuse those of no body."""
    width, height, mass, inertia = given.width, given.height, given.mass, given.inertia
    centre = 0.5 * height if given.centre_height is None else given.centre_height
    eccentricity = 0.0 if given.eccentricity is None else given.eccentricity
    if not (centre < height and abs(eccentricity) < 0.5 * width):
        msg = (
            f"{owner}: the centre of mass, {centre:.6g} m above the base and {eccentricity:.6g} m "
            f"to the right of its middle, is not within {height:.6g} m of height and "
            f"{0.5 * width:.6g} m to both sides"
        )
        raise ComponentError(msg)
    diagonal = hypot(width, 2.0 * centre)
    mu: float = given.shape_factor or SOLID_RECTANGLE_SHAPE_FACTOR
    if inertia is not None:
        mu = mass * diagonal * (diagonal / (4.0 * inertia))
    elif given.shape_factor is None and centre != 0.5 * height:
        # the inertia of the solid rectangle by default
        mu *= (diagonal / hypot(width, height)) ** 2
    si = BlockSI(width, height, mass, mu, centre, eccentricity)
    if not (0.0 < si.inertia < math.inf and 0.0 < mu < math.inf):
        msg = (
            f"{owner}: a block of {width:.4g} m by {height:.4g} m and {mass:.4g} kg has a moment "
            "of inertia out of the range of floating-point numbers"
        )
        raise ComponentError(msg)
    return si


def squat_body_warnings(si: BlockSI, owner: str) -> list[str]:
    """Warn of a body too squat to continue rocking after an impact, Eq. (5)."""
    if si.maximum_restitution > 0.0:
        return []
    return [
        f"{owner}: a block of H/B = {si.height / si.width:.4g} with shape factor "
        f"{si.shape_factor:.4g} cannot rock: its greatest restitution, Eq. (4), is "
        f"{si.maximum_restitution:.4g}; a solid rectangle needs H/B above sqrt(2)/2 = 0.7071. On "
        "RigidGround(friction=...), or pads with friction, it slides; soil needs no restitution"
    ]


def inertia_warnings(si: BlockSI) -> list[str]:
    """Warn of an inertia that no body within the rectangle can have, :eq:`eq-greatest-inertia`."""
    radius = si.radius  # lengths are divided by it, so that squares do not overflow
    horizontal = (si.left / radius) * (si.right / radius)
    vertical = (si.centre_height / radius) * ((si.height - si.centre_height) / radius)
    least_shape_factor = 1.0 / (horizontal + vertical)  # with all mass in the corners
    if si.shape_factor >= (1.0 - _ROUNDING) * least_shape_factor:
        return []
    greatest = si.inertia * (si.shape_factor / least_shape_factor)
    words = (
        f"a shape factor of {si.shape_factor:.4g} is not physical: the moment of inertia about "
        f"the centre of mass is {si.inertia:.4g} kg m^2, that of a body within this width and "
        f"height {greatest:.4g} kg m^2 or less, and its shape factor {least_shape_factor:.4g} or "
        "more; the value is used as given"
    )
    if _is_about_corner(si):
        words += (
            ". It is, to a percent, the inertia of the solid rectangle about a corner, "
            "I_O + m R0^2; `inertia` is I_O, about the centre of mass"
        )
    return [words]


def _is_about_corner(si: BlockSI) -> bool:
    """Whether the inertia is that of the solid rectangle about an end of the base."""
    radius = si.radius
    width, height, above = si.width / radius, si.height / radius, si.centre_height / radius
    about_centre = (width * width + height * height) / 12.0 + above * above
    ratios = (
        si.shape_factor * (about_centre + x * x) for x in (si.left / radius, si.right / radius)
    )
    return any(abs(ratio - 1.0) <= _PERCENT for ratio in ratios)


def width_from_radius(owner: str, radius: Any, slenderness: Any, centre_height: Any = None) -> Any:
    """Return the width of a block [m] by R0, H/B and the height of its centre, if it is not H/2."""
    if centre_height is None:
        return 2.0 * radius / hypot(1.0, slenderness)
    if radius > centre_height:
        return 2.0 * sqrt((radius - centre_height) * (radius + centre_height))
    msg = (
        f"{owner}: radius must be larger than centre_height, which is {centre_height:.6g} m; got "
        f"{radius:.6g} m"
    )
    raise ComponentError(msg)
