"""The scene of a block with links on rigid ground, which holds it or on which it slides."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from rockframe.components import RigidGround
from rockframe.components.ground import Impact
from rockframe.errors import AssemblyError
from rockframe.system.fitting import HELD, BaseFriction, friction_under
from rockframe.system.setting import SlipRange
from rockframe.system.sliding_ground import (
    friction_to_roll_over,
    ill_posed,
    impact_words,
    slide_rock_of,
    slips_on_ground,
)
from rockframe.system.sliding_stack import sheared
from rockframe.system.stack import StackSetting
from rockframe.system.words import SLIPS, Words

if TYPE_CHECKING:
    from rockframe.dynamics.protocol import ContactModel, Ending


@dataclass(frozen=True)
class TiedSetting(StackSetting):
    """A block with links on rigid ground, which holds it."""

    @property
    def friction(self) -> BaseFriction:
        """Friction of the ground."""
        return self.frictions[0] if self.frictions else HELD

    @cached_property
    def _model(self) -> "ContactModel":
        """The equations of slip, rotation and rise, with links."""
        from rockframe.dynamics.slide_rock_model import slide_rock
        from rockframe.dynamics.tied_slide_rock import tied_slide_rock

        self._rest  # noqa: B018 - refuses a block that its links tip over
        bare = slide_rock_of(self.body, self.friction, self.body.maximum_restitution, self.gravity)
        if not self.chain_ties:  # of loads that are masses
            return slide_rock(bare, mass=self.body.mass)
        return tied_slide_rock(bare, self.chain_ties, mass=self.body.mass)

    def contact_model(self) -> "ContactModel":
        """Give the equations of slip, rotation and rise, with links."""
        return self._model


@dataclass(frozen=True)
class TiedSlidingSetting(TiedSetting):
    """A block with links on rigid ground, on which it slides."""

    impact: Impact = Impact.COULOMB  # law of its impacts
    slides = True

    @property
    def model(self) -> str:
        """Name of the model."""
        return "rigid-restrained-sliding"

    def cautions(self) -> list[str]:
        """Give warnings, also of a block that its restrainers move at once."""
        return [*super().cautions(), *self.slides_at_rest("the block")]

    def words(self) -> Words:
        """Tell the block, its links and its friction."""
        told = super().words()
        return Words(
            equations=[
                ("full", "at rest while friction holds the base, and until it tips; else it slides "
                 "on its whole base"),
                ("left, right", "it rocks about the corner that bears while friction holds that, "
                 "and slips on it otherwise"),
                SLIPS,
                ("flight", "nothing bears: N = 0"),
                ("impact", f"{self.impact}: {impact_words(self.impact)}; restrainers, whose forces "
                 "are finite, have no part in it"),
                *(one for one in told.equations if one[0] == "restrainers"),
            ],
            restraint="friction at the corner that bears, or on the whole base (the restraint "
            "options make no difference)",
            numbers=[
                *told.numbers,
                ("friction at rest, and of slip", self.friction.words()),
                ("friction to land without slip", f"{friction_to_roll_over(self.body):.6g}"),
            ],
            left_out=[one for one in told.left_out if one != "sliding"],
        )  # fmt: skip

    def slips_of(self, ending: "Ending") -> tuple[SlipRange, ...]:
        """Tell how far the block slipped."""
        return (slips_on_ground(ending),)


def tied_on_ground(ground: RigidGround, held: StackSetting) -> StackSetting:
    """Give the setting of a block with links: of one that slides where the ground has friction."""
    found = friction_under(ground, held.options)
    if found is None:
        return TiedSetting(held.load, held.bodies, held.tops, held.offsets, held.bases, held.ties)
    faults = sheared(held)
    faults += ill_posed(held.body, found.kinetic)
    if faults:
        raise AssemblyError(faults)
    return TiedSlidingSetting(
        held.load, held.bodies, held.tops, held.offsets, held.bases, held.ties, (found,),
        impact=ground.si.impact,
    )  # fmt: skip
