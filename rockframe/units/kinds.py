"""Units, and the kinds of quantities that arguments need."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Final


class Unit(StrEnum):
    """All units of rockframe, in a spelling that both pint and UDUNITS parse."""

    ONE = "1"
    METRE = "m"
    CUBIC_METRE = "m^3"
    SECOND = "s"
    KILOGRAM = "kg"
    RADIAN = "rad"
    HERTZ = "Hz"
    METRE_PER_SECOND = "m s^-1"
    METRE_PER_SECOND_SQUARED = "m s^-2"
    RADIAN_PER_SECOND = "rad s^-1"
    RADIAN_PER_SECOND_SQUARED = "rad s^-2"
    KILOGRAM_METRE_SQUARED = "kg m^2"
    KILOGRAM_PER_CUBIC_METRE = "kg m^-3"
    NEWTON = "N"
    NEWTON_METRE = "N m"
    NEWTON_SECOND = "N s"
    NEWTON_PER_METRE = "N m^-1"
    NEWTON_SECOND_PER_METRE = "N s m^-1"
    JOULE = "J"
    PASCAL = "Pa"
    PASCAL_SECOND = "Pa s"
    PASCAL_PER_METRE = "Pa m^-1"
    PER_YEAR = "year^-1"


@dataclass(frozen=True)
class Measure:
    """A kind of physical quantity, for arguments."""

    name: str
    unit: Unit
    example: str

    def like(self, example: str) -> "Measure":
        """Return the same kind with another example."""
        return replace(self, example=example)

    @property
    def needed(self) -> str:
        """The kind in words, with the need of a unit."""
        return self.name if self.unit == Unit.ONE else f"{self.name} with a unit"

    def example_of(self, argument: str) -> str:
        """Return an example of how to write an argument."""
        plain = self.unit == Unit.ONE or self.example.startswith("(")  # a pair
        written = self.example if plain else repr(self.example)
        return f"write for example {argument}={written}"


LENGTH: Final = Measure("a length", Unit.METRE, "4 m")
MASS: Final = Measure("a mass", Unit.KILOGRAM, "99 t")
DENSITY: Final = Measure("a density", Unit.KILOGRAM_PER_CUBIC_METRE, "2500 kg/m^3")
INERTIA: Final = Measure("a moment of inertia", Unit.KILOGRAM_METRE_SQUARED, "3e5 kg*m^2")
THICKNESS: Final = LENGTH.like("0.3 m")
TIME: Final = Measure("a time", Unit.SECOND, "20 s")
TIME_STEP: Final = TIME.like("0.01 s")
PERIOD: Final = TIME.like("0.5 s")
ANGLE: Final = Measure("an angle", Unit.RADIAN, "0.1 rad")
ANGULAR_VELOCITY: Final = Measure("an angular velocity", Unit.RADIAN_PER_SECOND, "0.2 rad/s")
VELOCITY: Final = Measure("a velocity", Unit.METRE_PER_SECOND, "0.1 m/s")
ACCELERATION: Final = Measure("an acceleration", Unit.METRE_PER_SECOND_SQUARED, "9.81 m/s^2")
FREQUENCY: Final = Measure("a cyclic frequency", Unit.HERTZ, "1 Hz")
FORCE: Final = Measure("a force", Unit.NEWTON, "100 kN")
MOMENT: Final = Measure("a moment", Unit.NEWTON_METRE, "250 kN*m")
ENERGY: Final = Measure("an energy", Unit.JOULE, "12 kJ")
STIFFNESS: Final = Measure("a stiffness", Unit.NEWTON_PER_METRE, "12 MN/m")
DAMPING: Final = Measure("a damping coefficient", Unit.NEWTON_SECOND_PER_METRE, "80 kN*s/m")
BED_STIFFNESS: Final = Measure("a stiffness per length of base", Unit.PASCAL, "9 MPa")
BED_DAMPING: Final = Measure("a damping per length of base", Unit.PASCAL_SECOND, "400 kN*s/m^2")
SUBGRADE_MODULUS: Final = Measure("a subgrade modulus", Unit.PASCAL_PER_METRE, "20 MN/m^3")


@dataclass(frozen=True)
class Condition:
    """A range in which a value must lie, with its description."""

    words: str
    holds: Callable[[float], bool]
    hint: Callable[[str], str] = lambda _: ""
    """Gives a hint, for the message, from the text of a value outside the range."""
    bounds: tuple[float, float] = (-math.inf, math.inf)
    """Lower and upper bound of the range, for searches in it."""


POSITIVE: Final = Condition("greater than zero", lambda value: value > 0.0, bounds=(0.0, math.inf))
NOT_NEGATIVE: Final = Condition("zero or more", lambda value: value >= 0.0, bounds=(0.0, math.inf))
UNIT_INTERVAL: Final = Condition(
    "above 0 and at most 1", lambda value: 0.0 < value <= 1.0, bounds=(0.0, 1.0)
)
