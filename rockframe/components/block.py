"""The rigid block."""

import math
from dataclasses import dataclass
from typing import ClassVar, Self

from rockframe.components.alternatives import OneOf
from rockframe.components.base import Component
from rockframe.components.parameters import DERIVED, Parameter, Ratio
from rockframe.components.values import SIProperty, SIValues
from rockframe.constants import STANDARD_GRAVITY
from rockframe.errors import ComponentError
from rockframe.units import (
    ANGLE,
    ANGULAR_VELOCITY,
    DENSITY,
    INERTIA,
    LENGTH,
    MASS,
    POSITIVE,
    QuantityLike,
    RatioLike,
    to_ratio,
    to_si,
)

SOLID_RECTANGLE_SHAPE_FACTOR = 3.0
"""mu of a solid rectangle: I_O = m (B^2 + H^2)/12 = m R0^2/3."""


@dataclass(frozen=True)
class BlockSI:
    """Geometry and mass of a block in SI units."""

    width: float
    height: float
    mass: float
    shape_factor: float

    @property
    def half_width(self) -> float:
        """Half the width, b [m]."""
        return 0.5 * self.width

    @property
    def half_height(self) -> float:
        """Half the height, h [m]."""
        return 0.5 * self.height

    @property
    def radius(self) -> float:
        """R0, from a corner to the centre of mass [m]."""
        return math.hypot(self.half_width, self.half_height)

    @property
    def overturning_angle(self) -> float:
        """Overturning angle theta = arctan(b/h) [rad], Eq. (1)."""
        return math.atan2(self.width, self.height)

    @property
    def inertia(self) -> float:
        """I_O about the centre of mass [kg m^2]."""
        return self.mass * self.radius * self.radius / self.shape_factor

    def frequency_at(self, gravity: float) -> float:
        """Angular frequency omega of Eq. (6) under a given gravity [rad s^-1]."""
        mu = self.shape_factor
        return math.sqrt(mu / (1.0 + mu) * gravity / self.radius)

    @property
    def frequency(self) -> float:
        """Omega of Eq. (6) under standard gravity [rad s^-1]."""
        return self.frequency_at(STANDARD_GRAVITY)

    @property
    def maximum_restitution(self) -> float:
        """eps_max = (1 + mu cos 2 theta)/(1 + mu), Eq. (4)."""
        mu = self.shape_factor
        return (1.0 + mu * math.cos(2.0 * self.overturning_angle)) / (1.0 + mu)


class Block(Component):
    """A rigid rectangular block, or a body that rocks like one.

    Raises
    ------
    UnitsError
        A dimensional argument has no unit or a unit of the wrong kind.
    ComponentError
        A value is not finite or not positive, both `shape_factor` and
        `inertia` are given, or the block is so squat that it cannot rock.

    Notes
    -----
    A block rocks only while the greatest restitution, Eq. (4), is positive; for
    a solid rectangle that is H/B > sqrt(2)/2, Eq. (5).

    Examples
    --------
    >>> block = Block(width="2.4254 m", height="9.7014 m", mass="50 t")
    >>> round(block.overturning_angle.m_as("rad"), 4)
    0.245
    >>> block.replace(mass="60 t").mass.to("t")
    <Quantity(60.0, 'metric_ton')>
    """

    si: BlockSI
    noun: ClassVar[str] = "superstructure"
    alternatives: ClassVar[tuple[OneOf, ...]] = (OneOf("shape_factor", "inertia", required=False),)

    width = Parameter(LENGTH, POSITIVE, doc="Base width B.")
    height = Parameter(LENGTH, POSITIVE, doc="Height H; the centre of mass stands at H/2.")
    mass = Parameter(MASS, POSITIVE, doc="Mass m.")
    shape_factor = Ratio(
        POSITIVE,
        doc="mu = m R0^2 / I_O; 3, the solid rectangle's, unless given.",
        default=DERIVED,
        example="3",
    )
    inertia = Parameter(
        INERTIA,
        POSITIVE,
        doc="Moment of inertia about the centre of mass I_O, instead of `shape_factor`.",
        default=DERIVED,
    )
    radius = SIProperty(LENGTH, "R0, distance from a corner to the centre of mass.")
    overturning_angle = SIProperty(ANGLE, "theta = arctan(B/H), Eq. (1).")
    frequency = SIProperty(
        ANGULAR_VELOCITY, "Angular frequency omega under standard gravity, Eq. (6)."
    )

    def __init__(
        self,
        *,
        width: QuantityLike,
        height: QuantityLike,
        mass: QuantityLike,
        shape_factor: RatioLike | None = None,
        inertia: QuantityLike | None = None,
    ) -> None:
        super().__init__(
            width=width, height=height, mass=mass, shape_factor=shape_factor, inertia=inertia
        )

    def _numbers(self, given: SIValues) -> BlockSI:
        mu: float = given.shape_factor or SOLID_RECTANGLE_SHAPE_FACTOR
        if given.inertia is not None:
            diagonal = math.hypot(given.width, given.height)
            mu = given.mass * diagonal * (diagonal / (4.0 * given.inertia))
        si = BlockSI(given.width, given.height, given.mass, mu)
        _check_representable(si, type(self).__name__)
        _check_rocks(si, type(self).__name__)
        return si

    @classmethod
    def from_density(
        cls,
        *,
        width: QuantityLike,
        height: QuantityLike,
        depth: QuantityLike,
        density: QuantityLike,
        shape_factor: RatioLike | None = None,
    ) -> Self:
        """Build a solid block from its size and density.

        Parameters
        ----------
        width, height, depth : str or Quantity
            Size; `depth` is perpendicular to the plane of rocking [m].
        density : str or Quantity
            Mass per volume [kg m^-3].
        shape_factor : float, optional
            mu; 3 unless given [1].

        Returns
        -------
        Block

        Raises
        ------
        UnitsError, ComponentError
            As for :class:`Block`.
        """
        owner = f"{cls.__name__}.from_density"
        volume = 1.0
        for name, value in (("width", width), ("height", height), ("depth", depth)):
            volume *= to_si(value, LENGTH, owner=owner, name=name, condition=POSITIVE)
        per_volume = to_si(density, DENSITY, owner=owner, name="density", condition=POSITIVE)
        mass = f"{per_volume * volume!r} {MASS.unit}"
        return cls(width=width, height=height, mass=mass, shape_factor=shape_factor)

    @classmethod
    def from_size(
        cls,
        *,
        radius: QuantityLike,
        slenderness: RatioLike,
        mass: QuantityLike,
        shape_factor: RatioLike | None = None,
    ) -> Self:
        """Build a block from the paper's parameters R0 and H/B.

        Parameters
        ----------
        radius : str or Quantity
            R0, distance from a corner to the centre of mass [m].
        slenderness : float
            Height over width, H/B [1].
        mass : str or Quantity
            Mass [kg].
        shape_factor : float, optional
            mu; 3 unless given [1].

        Returns
        -------
        Block

        Raises
        ------
        UnitsError, ComponentError
            As for :class:`Block`.
        """
        owner = f"{cls.__name__}.from_size"
        metres = to_si(radius, LENGTH, owner=owner, name="radius", condition=POSITIVE)
        ratio = to_ratio(
            slenderness, owner=owner, name="slenderness", condition=POSITIVE, example="4"
        )
        width = 2.0 * metres / math.hypot(1.0, ratio)
        return cls(
            width=f"{width!r} {LENGTH.unit}",
            height=f"{width * ratio!r} {LENGTH.unit}",
            mass=mass,
            shape_factor=shape_factor,
        )

    @property
    def slenderness(self) -> float:
        """Height over width, H/B [1]."""
        return self.si.height / self.si.width

    @property
    def maximum_restitution(self) -> float:
        """eps_max of Eq. (4) [1]."""
        return self.si.maximum_restitution


def _check_representable(si: BlockSI, owner: str) -> None:
    if 0.0 < si.inertia < math.inf and 0.0 < si.shape_factor < math.inf:
        return
    msg = (
        f"{owner}: a block of {si.width:.4g} m by {si.height:.4g} m and {si.mass:.4g} kg has a "
        "moment of inertia that a computer's numbers cannot hold"
    )
    raise ComponentError(msg)


def _check_rocks(si: BlockSI, owner: str) -> None:
    if si.maximum_restitution > 0.0:
        return
    msg = (
        f"{owner}: a block of H/B = {si.height / si.width:.4g} with shape factor "
        f"{si.shape_factor:.4g} cannot rock: its greatest restitution, Eq. (4), is "
        f"{si.maximum_restitution:.4g}; a solid rectangle needs H/B above sqrt(2)/2 = 0.7071"
    )
    raise ComponentError(msg)
