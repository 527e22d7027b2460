"""The rigid cap between a building and the soil."""

from dataclasses import dataclass
from typing import ClassVar

from rockframe.components.alternatives import OneOf
from rockframe.components.base import Component
from rockframe.components.parameters import Parameter, SIValues
from rockframe.many import hypot
from rockframe.notebook import Polygon
from rockframe.units import (
    DENSITY,
    LENGTH,
    MASS,
    NOT_NEGATIVE,
    POSITIVE,
    THICKNESS,
    QuantityLike,
)


@dataclass(frozen=True)
class CushionCapSI:
    """A cap in SI units; a width of None stands for the building's."""

    width: float | None
    height: float
    mass: float | None
    mass_per_width: float | None

    def mass_at(self, width: float) -> float:
        """Give the mass of a cap of a width [kg]."""
        return self.mass if self.mass is not None else (self.mass_per_width or 0.0) * width

    def inertia_at(self, width: float) -> float:
        """Give the inertia of a solid cap about its centre [kg m^2]."""
        diagonal = hypot(width, self.height)
        return self.mass_at(width) * diagonal * diagonal / 12.0


class CushionCap(Component):
    """A rigid, solid slab that spreads a building's weight over the soil.

    Raises
    ------
    UnitsError
        A value has the wrong unit, or none.
    ComponentError
        A value is out of range, or not exactly one of `mass` and `density`
        (with `depth`) is given.

    Examples
    --------
    >>> cap = CushionCap(height="0.9 m", density="2500 kg/m^3", depth="4 m", width="5 m")
    >>> cap.si.mass_at(5.0)
    45000.0
    """

    si: CushionCapSI
    noun: ClassVar[str] = "cap"
    alternatives: ClassVar[tuple[OneOf, ...]] = (OneOf("mass", ("density", "depth")),)

    height = Parameter(THICKNESS, NOT_NEGATIVE, doc="Height H_c; zero for a thin plate.")
    mass = Parameter(
        MASS, NOT_NEGATIVE, doc="Mass m_c; zero for a plate without mass.", default=None
    )
    width = Parameter(
        LENGTH,
        POSITIVE,
        doc="Width B_c in the plane of rocking; the building's unless given.",
        default=None,
    )
    density = Parameter(
        DENSITY, POSITIVE, doc="Mass per volume, with `depth` instead of `mass`.", default=None
    )
    depth = Parameter(LENGTH, POSITIVE, doc="Size out of the plane of rocking.", default=None)

    def __init__(
        self,
        *,
        height: QuantityLike,
        mass: QuantityLike | None = None,
        width: QuantityLike | None = None,
        density: QuantityLike | None = None,
        depth: QuantityLike | None = None,
    ) -> None:
        super().__init__(height=height, mass=mass, width=width, density=density, depth=depth)

    def _shapes(self) -> list[Polygon]:
        si = self.si
        if si.width is None:
            return []
        half = 0.5 * si.width
        return [Polygon("cap", [(-half, 0.0), (half, 0.0), (half, si.height), (-half, si.height)])]

    def _numbers(self, given: SIValues) -> CushionCapSI:
        by_density = given.density is not None
        per_width = given.density * given.depth * given.height if by_density else None
        return CushionCapSI(given.width, given.height, given.mass, per_width)
