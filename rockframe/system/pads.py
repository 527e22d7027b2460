"""Two pads under a block: their numbers and their equations."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rockframe.components import TwoSpringSupport
from rockframe.system.impact import Restitutions, resolve_restitution, restitution_cautions
from rockframe.system.load import Load
from rockframe.system.pads_words import pads_words
from rockframe.system.support import BaseWords, Held, Support

if TYPE_CHECKING:
    from rockframe.dynamics.base_numbers import BaseNumbers
    from rockframe.dynamics.body import Body as BodyLaw


@dataclass(frozen=True)
class PadSupport(Support):
    """Two pads, in SI units.

    Parameters
    ----------
    load : Load
        The block on them.
    stiffness, damping : float
        Of one pad [N m^-1], [N s m^-1].
    restitution : Restitutions
        eps of a landing corner [1].
    """

    stiffness: float
    damping: float
    restitution: Restitutions

    @property
    def model(self) -> str:
        """Name of the model."""
        return "two-spring"

    @property
    def settlement(self) -> float:
        """Delta = mg/2k [m]."""
        return 0.5 * self.load.weight / self.stiffness

    def cautions(self) -> list[str]:
        """Give warnings about restitution and stability."""
        found = restitution_cautions(self.restitution, self.load.body.maximum_restitution)
        if self.rocking_stiffness <= 0.0:
            found.append(
                "the pads are too soft to hold the block upright: 2 k b^2 is below m g h, so "
                "that the smallest disturbance overturns it"
            )
        return found

    def words(self) -> BaseWords:
        """Tell the pads in words."""
        return pads_words(self)

    def law(self, body: "BodyLaw", mass: float, load_mass: float) -> "BaseNumbers":
        """Give the pads as the equations take them."""
        from rockframe.dynamics.base_numbers import pads_under

        return pads_under(
            body,
            stiffness=self.stiffness / mass,
            damping=self.damping / mass,
            restitution=self.restitution,
        )

    def held(self, sine: float, cosine: float, press: float) -> Held:
        """Give the equilibrium at a rotation under a vertical force, :eq:`eq-static-pads`."""
        width, weight = self.load.body.half_width, self.load.weight
        lift = width * sine
        left = 0.5 * press - self.stiffness * lift
        right = press - left
        middle = 0.5 * (weight - press) / self.stiffness
        if left < 0.0 or right < 0.0:
            left, right = (0.0, press) if sine > 0.0 else (press, 0.0)
            middle = abs(lift) - (press - 0.5 * weight) / self.stiffness
        return Held(
            rise=middle,
            moment=(right - left) * width * cosine,
            left=left > 0.0,
            right=right > 0.0,
            reactions={"left_reaction": left, "right_reaction": right},
        )

    def at_rest(self) -> dict[str, float]:
        """Give settlement and reactions, by their names in the schema."""
        half = 0.5 * self.load.weight
        return {
            "pad_settlement": half / self.stiffness,
            "static_left_reaction": half,
            "static_right_reaction": half,
        }


def pads_under(pads: TwoSpringSupport, load: Load) -> PadSupport:
    """Give pads under a block: stiffness and damping of one pad by Eqs. (7) and (8).

    Parameters
    ----------
    pads : TwoSpringSupport
        As given by the user.
    load : Load
        The block on them.

    Returns
    -------
    PadSupport
    """
    given, body = pads.si, load.body
    if given.stiffness is not None:
        stiffness = given.stiffness
        vertical = math.sqrt(2.0 * stiffness / body.mass)
    else:
        vertical = given.frequency_ratio * body.frequency_at(load.gravity)
        stiffness = 0.5 * body.mass * vertical**2
    damping = given.damping
    if damping is None:
        damping = given.damping_ratio * body.mass * vertical
    restitution = resolve_restitution(given.restitution, body.maximum_restitution)
    return PadSupport(load, stiffness, damping, restitution)
