"""The scenes of stacked bodies that slip, and of a block with links on rigid ground."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

from rockframe.components import Component, RigidGround, Tendon, TwoSpringSupport
from rockframe.components.bases import Impact
from rockframe.dynamics.protocol import MAX_MODES, ContactModel, Ending
from rockframe.errors import AssemblyError
from rockframe.system.compatibility import (
    NO_SLIP,
    SLIDING_AT_SMALL_ROTATION,
    BaseFriction,
    base_friction,
)
from rockframe.system.options import Sliding
from rockframe.system.setting import (
    HELD_BY_FRICTION,
    SLIP_EQUATION,
    SlipRange,
    Words,
    chain_slips,
    sliding_words,
)
from rockframe.system.sliding_ground import (
    friction_to_roll_over,
    impact_words,
    jamming_faults,
    slide_rock_of,
    slips_on_ground,
)
from rockframe.system.stack import StackSetting

MIN_OVERHANG: Final = 0.1
"""Least overhang of a body beyond an edge that gives a warning, over half its base width.

The edge bears in place of the corner, and its lever arm is shorter by this share."""


@dataclass(frozen=True)
class SlidingStackSetting(StackSetting):
    """Stacked bodies that are held by friction, or slip, on their bases."""

    slides = True

    @property
    def model(self) -> str:
        """Name of the model."""
        return f"{super().model}-sliding"

    def words(self) -> Words:
        """Describe bodies, bases and friction."""
        return sliding_words(super().words(), *(
            friction.row(f"base {k}: ")
            for k, friction in enumerate(self.frictions, 1)
        ))  # fmt: skip

    def slips_of(self, ending: Ending) -> tuple[SlipRange, ...]:
        """Return how far each body slipped."""
        return chain_slips(self, len(self.bodies), ending)

    def beyond_edges(self, ending: Ending) -> list[str]:
        """Warn of bodies that slipped beyond an edge of the body below, which is not modelled."""
        pairs = zip(self.bodies, self.bodies[1:], self.offsets, self.slips_of(ending), strict=False)
        return [
            text
            for k, (upper, lower, offset, slips) in enumerate(pairs, 1)
            for text in overhang_cautions(
                slips, offset, upper.half_width, lower.half_width, (f"body {k}", f"body {k + 1}")
            )
        ]


def overhang_cautions(
    slips: SlipRange, offset: float, upper: float, lower: float, names: Sequence[str]
) -> list[str]:
    """Warn of a body that slipped beyond an edge of the one below; half widths of both [m]."""
    overhang = max(slips.right + offset, slips.left - offset) - (lower - upper)
    if overhang <= MIN_OVERHANG * upper:
        return []
    return [
        f"{names[0]} slides {overhang:.3g} m beyond the edge of {names[1]}, whose top goes "
        "on without end in the model: it would tip about that edge sooner"
    ]


def sliding_stack_setting(bases: Sequence[Component], held: StackSetting) -> StackSetting:
    """Return the setting of stacked bodies: one with slip where bases have friction."""
    slips = any(getattr(one.si, "friction", None) is not None for one in bases)
    _refuse_many_modes(bases, slips)
    checked = held.options.sliding is Sliding.CHECKED
    if not slips or (checked and len(held.bodies) == 1):
        return held
    frictions = [base_friction(one, held.options) for one in bases]
    faults = list[str]()
    if checked:
        faults.append("friction in a Stack is computed: give no sliding='checked', or no friction")
    elif any(held.rigid):
        faults += sheared_tendon_faults(held)
    for k, friction in enumerate(frictions):
        if friction is not None and held.rigid[k]:
            faults += [
                f"body {k + 1}: {one}" for one in jamming_faults(held.bodies[k], friction.kinetic)
            ]
    if held.options.small:
        faults.append(SLIDING_AT_SMALL_ROTATION)
    if faults:
        raise AssemblyError(faults)
    given = tuple(NO_SLIP if one is None else one for one in frictions)
    return SlidingStackSetting(**_shared_fields(held), frictions=given)


def _shared_fields(held: StackSetting) -> dict[str, Any]:
    """Return the fields that settings of the same bodies, bases and links share."""
    names = ("load", "bodies", "tops", "offsets", "bases", "links")
    return {name: getattr(held, name) for name in names}


def _refuse_many_modes(bases: Sequence[Component], slips: bool) -> None:
    """Refuse bodies whose contacts have more combinations than can be numbered."""
    from rockframe.dynamics.chain.rows import BED_MODES, PAD_MODES, RIGID_MODES

    count = 1
    for base in bases:
        if isinstance(base, RigidGround):
            modes = RIGID_MODES
        else:
            modes = PAD_MODES if isinstance(base, TwoSpringSupport) else BED_MODES
        count *= 2 * modes if slips else modes
    if count > MAX_MODES:
        raise AssemblyError([
            f"the contacts of {len(bases)} bodies on these bases have {count:.2g} combinations, "
            f"more than the {MAX_MODES:.2g} that can be numbered: give fewer bodies, or rigid "
            "joints"
        ])  # fmt: skip


def sheared_tendon_faults(setting: StackSetting) -> list[str]:
    """Return faults for tendons without depth below a joint: a slip would shear them there."""
    return [
        f"{link.name}: a Tendon without a depth is bent over the edge of its duct at the base, and "
        "a block that slides shears it there: give the depth below the base at which it is fixed"
        for link in setting.links
        if isinstance(link.part, Tendon) and link.part.si.depth == 0.0
    ]


@dataclass(frozen=True)
class RestrainedSetting(StackSetting):
    """A block with links on rigid ground, which holds it against sliding."""

    @property
    def friction(self) -> BaseFriction:
        """Friction of the ground."""
        return self.frictions[0] if self.frictions else NO_SLIP

    def contact_model(self) -> ContactModel:
        """Return the equations of slip, rotation and rise, with links."""
        from rockframe.dynamics.slide_rock import slide_rock
        from rockframe.dynamics.tied_slide_rock import tied_slide_rock

        self._rest  # noqa: B018 - refuses a block that its links tip over
        block = slide_rock_of(self.body, self.friction, self.body.maximum_restitution, self.gravity)
        if not self.chain_links:  # all links are loads that are masses
            return slide_rock(block, mass=self.body.mass)
        return tied_slide_rock(block, self.chain_links, mass=self.body.mass)


@dataclass(frozen=True)
class SlidingRestrainedSetting(RestrainedSetting):
    """A block with links on rigid ground, on which it slides."""

    impact: Impact = Impact.COULOMB  # law of its impacts
    slides = True

    @property
    def model(self) -> str:
        """Name of the model."""
        return "rigid-restrained-sliding"

    def words(self) -> Words:
        """Describe the block, its links and its friction."""
        text = super().words()
        slides = sliding_words(
            text,
            self.friction.row(),
            ("friction to land without slip", f"{friction_to_roll_over(self.body):.6g}"),
            restraint=HELD_BY_FRICTION,
        )
        return replace(
            slides,
            equations=[
                ("full", "at rest while friction holds the base, and until it tips; else it slides "
                 "on its whole base"),
                ("left, right", "it rocks about the corner that bears while friction holds that, "
                 "and slips on it otherwise"),
                SLIP_EQUATION,
                ("flight", "nothing bears: N = 0"),
                ("impact", f"{self.impact}: {impact_words(self.impact)}; restrainers, whose forces "
                 "are finite, have no part in it"),
                *(equation for equation in text.equations if equation[0] == "restrainers"),
            ],
        )  # fmt: skip

    def slips_of(self, ending: Ending) -> tuple[SlipRange, ...]:
        """Return how far the block slipped."""
        return (slips_on_ground(ending),)


def restrained_setting(ground: RigidGround, held: StackSetting) -> StackSetting:
    """Return the setting of a block with links: one with sliding where the ground has friction."""
    friction = base_friction(ground, held.options)
    if friction is None:
        return RestrainedSetting(**_shared_fields(held))
    faults = sheared_tendon_faults(held)
    faults += jamming_faults(held.body, friction.kinetic)
    if faults:
        raise AssemblyError(faults)
    return SlidingRestrainedSetting(
        **_shared_fields(held), frictions=(friction,), impact=ground.si.impact
    )
