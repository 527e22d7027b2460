"""Two pads under a block: their numbers, their equations and their words."""

from dataclasses import dataclass

from rockframe.components import TwoSpringSupport
from rockframe.dynamics.base_numbers import BaseNumbers
from rockframe.dynamics.body import Body
from rockframe.many import sqrt
from rockframe.system.bodies import (
    BaseLoad,
    Restitutions,
    resolve_restitution,
    restitution_cautions,
)
from rockframe.system.support import BaseWords, Support
from rockframe.system.words import uplift_words


@dataclass(frozen=True)
class PadSupport(Support):
    """Two pads, in SI units.

    Parameters
    ----------
    load : BaseLoad
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

    def cautions(self) -> list[str]:
        """Give warnings about restitution and stability."""
        found = restitution_cautions(self.restitution, self.load.body.maximum_restitution)
        if self.rocking_stiffness <= 0.0:
            found.append(
                "the pads are too soft to hold the block upright: 2 k b^2 is below m g h, so "
                "that the smallest disturbance overturns it"
            )
        return found

    def law(self, body: Body, mass: float, load_mass: float) -> BaseNumbers:
        """Give the pads as the equations take them."""
        from rockframe.dynamics.base_numbers import pads_numbers

        return pads_numbers(
            body,
            stiffness=self.stiffness / mass,
            damping=self.damping / mass,
            restitution=self.restitution,
            load=load_mass / mass,
        )

    def words(self) -> BaseWords:
        """Tell the pads in words."""
        omega = self.load.body.frequency_at(self.load.options.gravity)
        return BaseWords(
            law="pad forces as in Eqs. (12) and (15)",
            equations=[
                ("full", "Eq. (12), corrected: 2 zeta sin(a)/(beta omega) in (12a); sin(2a)/2, "
                 "beta^2 omega^4/g and 2 zeta/(beta omega) in (12b)"),
                ("left", "Eq. (15), upper signs, corrected: [cos(theta) - cos(theta + a) + ...] in "
                 "(15a); the sign of the bearing corner and omega^4 in (15b)"),
                ("right", "Eq. (15), lower signs, with the same corrections"),
                ("flight", "free fall and constant rotation rate (left out by the paper)"),
                ("impact", f"a landing corner keeps {self.restitution.words()} of its speed, "
                 "Eqs. (2)-(4) with the corner inertia for the printed I_O"),
            ],
            uplift=("uplift angle, Eq. (16)", uplift_words(self.uplift_angle)),
            numbers=[
                ("rocking frequency omega, Eq. (6)", f"{omega:.6g} rad/s"),
                ("frequency ratio beta, Eq. (8)", f"{self.vertical_frequency / omega:.6g}"),
                ("pad stiffness k, damping c",
                 f"{self.stiffness:.6g} N/m, {self.damping:.6g} N s/m"),
                ("settlement delta", f"{self.settlement:.6g} m"),
                *self.vibrations("vertical vibration", "rocking vibration in full contact"),
                ("restitution eps", self.restitution.words()),
            ],
            left_out=["tension in the pads"],
        )  # fmt: skip


def pads_under(pads: TwoSpringSupport, load: BaseLoad) -> PadSupport:
    """Give pads under a block: stiffness and damping of one pad by Eqs. (7) and (8)."""
    given, body = pads.si, load.body
    if given.stiffness is not None:
        stiffness = given.stiffness
        vertical = sqrt(2.0 * stiffness / body.mass)
    else:
        vertical = given.frequency_ratio * body.frequency_at(load.options.gravity)
        stiffness = 0.5 * body.mass * vertical**2
    damping = given.damping
    if damping is None:
        damping = given.damping_ratio * body.mass * vertical
    restitution = resolve_restitution(given.restitution, body.maximum_restitution)
    return PadSupport(load, stiffness, damping, restitution)
