"""The rigid cap between a building and the soil."""

import math
from dataclasses import dataclass
from typing import ClassVar

from rockframe.components.base import Component, with_unit
from rockframe.components.pads import one_of
from rockframe.errors import ComponentError
from rockframe.units import (
    DENSITY,
    LENGTH,
    MASS,
    NOT_NEGATIVE,
    POSITIVE,
    THICKNESS,
    QuantityLike,
    to_si,
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
        diagonal = math.hypot(width, self.height)
        return self.mass_at(width) * diagonal * diagonal / 12.0


class CushionCap(Component[CushionCapSI]):
    """A rigid, solid slab that spreads a building's weight over the soil.

    Parameters
    ----------
    height : str or Quantity
        Height H_c; zero for a thin plate [m].
    mass : str or Quantity, optional
        Mass m_c; zero for a plate without mass [kg].
    width : str or Quantity, optional
        Width B_c in the plane of rocking; the building's unless given [m].
    density, depth : str or Quantity, optional
        Mass per volume, and size out of the plane of rocking, instead of
        `mass` [kg m^-3], [m].

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

    noun: ClassVar[str] = "cap"

    def __init__(
        self,
        *,
        height: QuantityLike,
        mass: QuantityLike | None = None,
        width: QuantityLike | None = None,
        density: QuantityLike | None = None,
        depth: QuantityLike | None = None,
    ) -> None:
        owner = "CushionCap"
        one_of(owner, mass=mass, density=density)
        if (density is None) != (depth is None):
            msg = f"{owner}: density and depth go together; {_given(density=density, depth=depth)}"
            raise ComponentError(msg)
        tall = to_si(height, THICKNESS, owner=owner, name="height", condition=NOT_NEGATIVE)
        wide = m = rho = deep = per_width = None
        if width is not None:
            wide = to_si(width, LENGTH, owner=owner, name="width", condition=POSITIVE)
        if mass is not None:
            m = to_si(mass, MASS, owner=owner, name="mass", condition=NOT_NEGATIVE)
        if density is not None and depth is not None:
            rho = to_si(density, DENSITY, owner=owner, name="density", condition=POSITIVE)
            deep = to_si(depth, LENGTH, owner=owner, name="depth", condition=POSITIVE)
            per_width = rho * deep * tall
        self._freeze(
            CushionCapSI(wide, tall, m, per_width),
            {
                "height": with_unit(tall, LENGTH),
                "mass": with_unit(m, MASS),
                "width": with_unit(wide, LENGTH),
                "density": with_unit(rho, DENSITY),
                "depth": with_unit(deep, LENGTH),
            },
        )


def _given(**pair: object) -> str:
    return "only " + next(name for name, value in pair.items() if value is not None) + " was given"
