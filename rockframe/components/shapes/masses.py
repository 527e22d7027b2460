"""Masses in the plane of rocking, put together."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeVar


class Placed(Protocol):
    """A mass, where its centre is, and its moment of inertia about that."""

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        ...

    @property
    def x(self) -> float:
        """Horizontal position of its centre, to the right [m]."""
        ...

    @property
    def y(self) -> float:
        """Height of its centre [m]."""
        ...

    @property
    def inertia(self) -> float:
        """About its own centre [kg m^2]."""
        ...


Mass = TypeVar("Mass", bound=Placed)


@dataclass(frozen=True)
class PlaneMass:
    """A mass in SI units, with its moment of inertia about its own centre."""

    mass: float
    x: float
    y: float
    inertia: float


def mean_by_mass(masses: Sequence[Mass], value: Callable[[Mass], float]) -> float:
    """Give the mean of a value, weighted by mass."""
    # every share is at most 1: masses of any magnitude stay representable
    total = sum(one.mass for one in masses)
    return math.fsum(value(one) * (one.mass / total) for one in masses)


def centre_of_mass(masses: Sequence[Placed]) -> tuple[float, float]:
    """Give the common centre of masses, :eq:`eq-parts-centre`.

    Parameters
    ----------
    masses : sequence
        One or more.

    Returns
    -------
    tuple of float
        Coordinates x, y [m].
    """
    return mean_by_mass(masses, lambda one: one.x), mean_by_mass(masses, lambda one: one.y)


def combined_mass(masses: Sequence[Placed]) -> PlaneMass:
    """Make one mass of many, by the parallel-axis theorem, :eq:`eq-parts-inertia`."""
    x, y = centre_of_mass(masses)
    total = sum(one.mass for one in masses)
    squares = mean_by_mass(
        masses, lambda one: one.inertia / one.mass + math.hypot(one.x - x, one.y - y) ** 2
    )
    return PlaneMass(total, x, y, total * squares)
