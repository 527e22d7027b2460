"""A bed of soil under a body: its numbers, its equations and its words."""

from dataclasses import dataclass
from typing import ClassVar

from rockframe.components import WinklerSoil
from rockframe.components.soil import Separation
from rockframe.dynamics.base_numbers import BaseNumbers
from rockframe.dynamics.body import Body
from rockframe.many import sqrt
from rockframe.system.bodies import BaseLoad
from rockframe.system.support import BaseWords, Support
from rockframe.system.words import uplift_words

_SEPARATION = {
    Separation.DISPLACEMENT: "above the level of the unloaded bed",
    Separation.PRESSURE: "above the level of the unloaded bed, and where the dashpots would pull",
}


@dataclass(frozen=True)
class BedSupport(Support):
    """A Winkler bed, in SI units.

    Parameters
    ----------
    load : BaseLoad
        The body on it.
    stiffness, damping : float
        k0 and c0, per length of the base [Pa], [Pa s].
    separation : Separation
        Where the base parts from the bed.
    """

    stiffness: float
    damping: float
    separation: Separation
    settlement_name: ClassVar[str] = "soil_settlement"

    @property
    def model(self) -> str:
        """Name of the model."""
        return "Winkler"

    def cautions(self) -> list[str]:
        """Give warnings about stability."""
        if self.rocking_stiffness > 0.0:
            return []
        return [
            "the soil is too soft to hold the body upright: (2/3) k0 b^3 is below m g h, so "
            "that the smallest disturbance overturns it"
        ]

    def law(self, body: Body, mass: float, load_mass: float) -> BaseNumbers:
        """Give the bed as the equations take it."""
        from rockframe.dynamics.base_numbers import bed_numbers

        return bed_numbers(
            body,
            stiffness=self.stiffness / mass,
            damping=self.damping / mass,
            by_pressure=self.separation is Separation.PRESSURE,
            load=load_mass / mass,
        )

    def words(self) -> BaseWords:
        """Tell the bed in words."""
        one_sided = (
            "Eq. (19), corrected: inertia I_O + m (h + b a)^2 and its a'^2 term in (19b), (19e), "
            "(19f), (19h); resultants over the part in contact"
        )
        if self.load.options.small:
            one_sided = (
                "Eq. (19), corrected: (19e), (19f), (19h); inertia I_M and heights to second "
                "order, so that energies balance"
            )
        return BaseWords(
            law="soil's resultants as in Eqs. (18) and (19)",
            equations=[
                ("full", "Eq. (18) at small rotation; at finite rotation the same bed with "
                 "x' = h cos(a), and its resultants over the whole base"),
                ("left, right", one_sided),
                ("flight", "free fall and constant rotation rate"),
                ("contact", f"without impact law; the base parts from the bed "
                 f"{_SEPARATION[self.separation]}"),
            ],
            uplift=("uplift angle, arcsin(delta/b)", uplift_words(self.uplift_angle)),
            numbers=self._numbers(),
            left_out=["yielding of the soil", "impact on the soil"],
            body="body",
            end="end",
        )  # fmt: skip

    def _numbers(self) -> list[tuple[str, str]]:
        body = self.load.body
        return [
            ("mass on the soil", f"{body.mass:.6g} kg, centre {body.centre_height:.6g} m above it"),
            ("soil stiffness k0, damping c0", f"{self.stiffness:.6g} Pa, {self.damping:.6g} Pa s"),
            ("settlement delta", f"{self.settlement:.6g} m"),
            *self.vibrations("vertical vibration, Eq. (18a)", "rocking in full contact, Eq. (18b)"),
        ]


def bed_under(soil: WinklerSoil, load: BaseLoad) -> BedSupport:
    """Give a bed under a body; a damping ratio is that of the vertical motion of all its mass.

    Parameters
    ----------
    soil : WinklerSoil
        As given by the user.
    load : BaseLoad
        All that stands on it, as one body.

    Returns
    -------
    BedSupport
    """
    given, body = soil.si, load.body
    damping = given.damping
    if damping is None:
        critical = sqrt(2.0 * body.half_width * given.stiffness * body.mass)
        damping = given.damping_ratio * critical / body.half_width
    return BedSupport(load, given.stiffness, damping, given.separation)
