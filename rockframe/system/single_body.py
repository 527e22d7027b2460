"""The scene of one body on a deformable base, on which it may slip: numbers, words, models."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from rockframe.case_arrays import isnan
from rockframe.dynamics.protocol import ContactModel, Ending
from rockframe.dynamics.single_body import single_body
from rockframe.dynamics.starting import AtRest
from rockframe.errors import AssemblyError
from rockframe.system.bodies import BaseFriction
from rockframe.system.options import restraint_words
from rockframe.system.setting import Setting, SlipRange, Words, chain_slips, sliding_words
from rockframe.system.statics import SmallMotion, Statics, static_values
from rockframe.system.support import Support
from rockframe.units import angle_words


@dataclass(frozen=True)
class SingleBodySetting(Setting):
    """A body on a base."""

    support: Support  # the base under it

    @property
    def model(self) -> str:
        """Name of the model."""
        return self.support.model

    @property
    def supports(self) -> tuple[Support, ...]:
        """The base under the body."""
        return (self.support,)

    def words(self) -> Words:
        """Describe the base, and what the model leaves out."""
        base = self.support.words()
        return Words(
            equations=base.equations,
            restraint=restraint_words(self.options, base.end),
            numbers=[base.uplift, *base.numbers],
            left_out=["sliding", f"elasticity of the {base.body}", *base.left_out],
        )

    def contact_model(self) -> ContactModel:
        """Return the equations of a body on its base."""
        body, base = self.load.rigid_body, self.support.base_numbers
        return single_body(self.model, body, base, self.body.mass, self.rest_rotation)

    @cached_property
    def rest_rotation(self) -> float:
        """Rotation of the body at rest under its weight; :eq:`eq-incline-lean` if small [rad]."""
        if not self.leans:
            return 0.0
        poses = self.support.standing.rest
        if poses is None:
            raise AssemblyError([self._no_equilibrium_words()])
        return poses[0].state.rotation

    def _no_equilibrium_words(self) -> str:
        """Say that the body has no equilibrium under its weight, and why."""
        slope, body = self.slope, self.body
        moment = body.eccentricity * slope.normal_gravity - body.centre_height * slope.along_gravity
        base, whose = "base is too soft", ""
        if not slope.level:
            base = (
                f"base, inclined by {angle_words(abs(slope.inclination))}, is too soft or too steep"
            )
        if body.eccentricity != 0.0:
            beside = f"{abs(body.eccentricity):.4g} m beside the middle of its base"
            whose = f" whose centre of mass is {beside}"
        side = "right" if moment > 0.0 else "left"
        return f"the {base} for a body{whose}: it falls to the {side} by its own weight"

    def small_motion(self) -> SmallMotion:
        """Return the equations of small motion about rest, in the contact of the body at rest."""
        standing = self.support.standing
        return standing.motion_of_single_body(standing.rest or [self.support.upright])

    def curve(self, rotations: Sequence[float]) -> list[Statics | None]:
        """Return the vertical equilibrium at some rotations, :eq:`eq-incline-held`."""
        return self.support.standing.held(rotations)

    def upright(self) -> dict[str, float]:
        """Return settlement, reactions and uplift moment of the upright body, by schema names."""
        uplift = self.uplift_angle
        moment = math.nan if isnan(uplift) else self.statics(uplift).base_moment
        return {"uplift_moment": moment, **self.support.at_rest()}

    def equilibrium(self) -> dict[str, float]:
        """Return settlement, reactions at rest and moment at uplift, by names in the schema."""
        values = self.upright()
        if self.rest_rotation != 0.0:
            values |= static_values(self.statics(self.rest_rotation).reactions)
        return values


@dataclass(frozen=True)
class SlidingBodySetting(SingleBodySetting):
    """A body on a base with friction."""

    friction: BaseFriction
    slides = True

    @property
    def model(self) -> str:
        """Name of the model."""
        return f"{self.support.model}-sliding"

    def words(self) -> Words:
        """Describe the base, and the friction that holds the body on it."""
        held = super().words()
        restraint = f"{held.restraint.partition(';')[0]}; as far as friction can"
        return sliding_words(held, self.friction.row(), restraint=restraint)

    def contact_model(self) -> ContactModel:
        """Return the equations of slip, rotation and rise: those of a chain of one body."""
        from rockframe.dynamics.chain.model import ChainBody, chain_model

        body, rest = self.load.rigid_body, None
        if self.leans and self.support.standing.rest is not None:
            state = self.support.standing.rest[0].state
            rest = [AtRest(state.rotation, state.vertical)]
        chain_body = ChainBody(body, self.support.base_numbers, 1.0, 0.0, 0.0)
        return chain_model([chain_body], self.body.mass, rest, frictions=[self.friction])

    def slips_of(self, ending: Ending) -> tuple[SlipRange, ...]:
        """Return how far the body slipped."""
        return chain_slips(self, 1, ending)
