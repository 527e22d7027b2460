"""A bed of soil under a body: its numbers and its equations."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rockframe.components import WinklerSoil
from rockframe.components.soil import Separation
from rockframe.system.load import Load
from rockframe.system.soil_words import soil_words
from rockframe.system.support import BaseWords, Held, Support

if TYPE_CHECKING:
    from rockframe.dynamics.base_numbers import BaseNumbers
    from rockframe.dynamics.body import Body as BodyLaw


@dataclass(frozen=True)
class BedSupport(Support):
    """A Winkler bed, in SI units.

    Parameters
    ----------
    load : Load
        The body on it.
    stiffness, damping : float
        k0 and c0, per length of the base [Pa], [Pa s].
    separation : Separation
        Where the base parts from the bed.
    """

    stiffness: float
    damping: float
    separation: Separation

    @property
    def model(self) -> str:
        """Name of the model."""
        return "Winkler"

    @property
    def settlement(self) -> float:
        """Delta = mg/(2 b k0) [m]."""
        return 0.5 * self.load.weight / (self.load.body.half_width * self.stiffness)

    def cautions(self) -> list[str]:
        """Give warnings about stability."""
        if self.rocking_stiffness > 0.0:
            return []
        return [
            "the soil is too soft to hold the body upright: (2/3) k0 b^3 is below m g h, so "
            "that the smallest disturbance overturns it"
        ]

    def words(self) -> BaseWords:
        """Tell the bed in words."""
        return soil_words(self)

    def law(self, body: "BodyLaw", mass: float, load_mass: float) -> "BaseNumbers":
        """Give the bed as the equations take it."""
        from rockframe.dynamics.base_numbers import bed_under

        return bed_under(
            body,
            stiffness=self.stiffness / mass,
            damping=self.damping / mass,
            by_pressure=self.separation is Separation.PRESSURE,
            load=load_mass / mass,
        )

    def held(self, sine: float, cosine: float, press: float) -> Held:
        """Give the equilibrium at a rotation under a vertical force, :eq:`eq-static-bed`."""
        width = self.load.body.half_width
        settlement = 0.5 * press / (width * self.stiffness)
        rise = self.settlement - settlement
        tilt = width * abs(sine)
        length, sunk = 2.0 * width, settlement + tilt
        if tilt <= settlement:
            moment = self.stiffness * width**3 / 1.5 * sine * cosine
        else:
            length = 2.0 * math.sqrt(width * settlement / abs(sine))
            sunk = length * abs(sine)
            rise += settlement + tilt - 2.0 * math.sqrt(tilt * settlement)
            moment = math.copysign(press * (width - length / 3.0), sine) * cosine
        whole = length >= 2.0 * width
        return Held(
            rise=rise,
            moment=moment,
            left=whole or sine < 0.0,
            right=whole or sine > 0.0,
            reactions={
                "soil_reaction": press,
                "contact_length": length,
                "toe_pressure": self.stiffness * sunk,
            },
        )

    def at_rest(self) -> dict[str, float]:
        """Give settlement and reaction, by their names in the schema."""
        return {"soil_settlement": self.settlement, "static_soil_reaction": self.load.weight}


def bed_under(soil: WinklerSoil, load: Load) -> BedSupport:
    """Give a bed under a body; a damping ratio is that of the vertical motion of all its mass.

    Parameters
    ----------
    soil : WinklerSoil
        As given by the user.
    load : Load
        All that stands on it, as one body.

    Returns
    -------
    BedSupport
    """
    given, body = soil.si, load.body
    damping = given.damping
    if damping is None:
        critical = math.sqrt(2.0 * body.half_width * given.stiffness * body.mass)
        damping = given.damping_ratio * critical / body.half_width
    return BedSupport(load, given.stiffness, damping, given.separation)
