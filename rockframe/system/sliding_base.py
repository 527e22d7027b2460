"""The scene of one body that slips on a base that gives way: its numbers, words and model."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from rockframe.components import Component
from rockframe.errors import AssemblyError
from rockframe.system.alone import AloneSetting
from rockframe.system.fitting import SMALL_SLIDING, friction_under
from rockframe.system.setting import SlipRange
from rockframe.system.words import Words

if TYPE_CHECKING:
    from rockframe.dynamics.protocol import ContactModel, Ending


@dataclass(frozen=True)
class SlidingAloneSetting(AloneSetting):
    """A body on a base with friction."""

    static: float  # coefficients of friction [1]
    kinetic: float
    slides = True

    @property
    def model(self) -> str:
        """Name of the model."""
        return f"{self.support.model}-sliding"

    def words(self) -> Words:
        """Tell the base, and the friction that holds the body on it."""
        base = super().words()
        return Words(
            equations=[
                *base.equations,
                ("slip", "H = -s mu_k N at the point that would be held, s = sgn(slip'); "
                 "held while |H| <= mu_s N"),
            ],
            restraint=f"{base.restraint.partition(';')[0]}; as far as friction can",
            numbers=[
                *base.numbers,
                ("friction at rest, and of slip", f"{self.static:.6g}, {self.kinetic:.6g}"),
            ],
            left_out=[one for one in base.left_out if one != "sliding"],
        )  # fmt: skip

    @cached_property
    def _model(self) -> "ContactModel":
        """The equations of a body that slips on its base: those of a chain of one."""
        from rockframe.dynamics.chain.model import AtRest, ChainBody, chain

        body, rest = self.load.rigid_body, None
        if self.leans and self.support.standing.rest is not None:
            stands = self.support.standing.rest[0].state
            rest = [AtRest(stands.rotation, stands.vertical)]
        one = ChainBody(body, self.support.base_numbers, 1.0, 0.0, 0.0)
        return chain([one], self.body.mass, rest, frictions=[(self.static, self.kinetic)])

    def contact_model(self) -> "ContactModel":
        """Give the equations of slip, rotation and rise."""
        return self._model

    def slips_of(self, ending: "Ending") -> SlipRange:
        """Tell how far the body slipped."""
        return SlipRange(*self._model.system.slips(0, ending))  # type: ignore[attr-defined]


def alone_on(part: Component, held: AloneSetting) -> AloneSetting:
    """Give the setting of a body on a base: of one that slips on it where that has friction."""
    found = friction_under(part, held.options)
    if found is None:
        return held
    if held.options.small:
        raise AssemblyError([SMALL_SLIDING])
    return SlidingAloneSetting(held.load, held.support, *found, cap_offset=held.cap_offset)
