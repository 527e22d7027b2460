"""The scene of one body on a base that gives way: its numbers, its words and its model."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from rockframe.errors import AssemblyError
from rockframe.system.restraints import restraint_words
from rockframe.system.setting import Setting
from rockframe.system.small_motion import SmallMotion
from rockframe.system.statics import Statics, sine_cosine_rise
from rockframe.system.support import Support
from rockframe.system.words import Words, angle_words

if TYPE_CHECKING:
    from rockframe.dynamics.on_base import OnBase
    from rockframe.dynamics.protocol import ContactModel


@dataclass(frozen=True)
class AloneSetting(Setting):
    """A body on a base.

    Parameters
    ----------
    load : Load
        The body, with the options of its system.
    support : Support
        The base under it.
    cap_offset : float, optional
        Height of a cap's centre above that of the body, where a cap is part of the body [m].
    """

    support: Support

    @property
    def model(self) -> str:
        """Name of the model."""
        return self.support.model

    @property
    def supports(self) -> tuple[Support, ...]:
        """The one base."""
        return (self.support,)

    def words(self) -> Words:
        """Tell the base, and what the body on it lacks."""
        base = self.support.words()
        return Words(
            equations=base.equations,
            restraint=restraint_words(self.options, base.end),
            numbers=[base.uplift, *base.numbers],
            left_out=["sliding", f"elasticity of the {base.body}", *base.left_out],
        )

    def _contact_model(self) -> "ContactModel":
        from rockframe.dynamics.alone_model import alone

        body, base = self.load.own_law, self.support.own_law
        return alone(self.model, body, base, self.body.mass, self.rest_rotation)

    def _part(self) -> "OnBase":
        """Give body and base as the equations take them, per unit mass."""
        from rockframe.dynamics.on_base import OnBase

        return OnBase(self.load.own_law, self.support.own_law.law)

    @cached_property
    def rest_rotation(self) -> float:
        """Rotation at rest: a body leans to the side to which its weight turns it [rad].

        At small rotation on pads or a bed that of :eq:`eq-incline-lean`.

        Raises
        ------
        AssemblyError
            The base is too soft, or too much inclined, to carry the body.
        """
        if not self.leans:
            return 0.0
        from rockframe.dynamics.rest import rest_rotation

        found = rest_rotation(self._part(), self.slope.along_gravity)
        if math.isnan(found):
            raise AssemblyError([self._falling_words()])
        return found

    def _falling_words(self) -> str:
        """Say that the body finds no rest, and why."""
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
        """Give the equations of small motion in full contact, to first order."""
        body, law = self.body, self.support.own_law
        mass = np.diag([body.mass, body.base_inertia])
        springs = body.mass * np.diag([law.vertical_stiffness, law.rotational_stiffness])
        damping = law.damping_time * springs
        stiffness = springs - np.diag([0.0, self.load.weight * body.centre_height])
        if self.leans:
            from rockframe.dynamics.linear import linear_alone

            linear = linear_alone(self._part(), self.rest_rotation, self.slope.along_gravity)
            damping, stiffness = mass @ linear.damping, mass @ linear.stiffness
        return SmallMotion(("vertical_displacement", "rotation"), mass, damping, stiffness)

    def statics(self, rotation: float) -> Statics:
        """Give the vertical equilibrium at a rotation, :eq:`eq-incline-held`."""
        height, beside, weight = self.body.centre_height, self.body.eccentricity, self.load.weight
        sine, cosine, rise = sine_cosine_rise(height, self.options.rotation, rotation)
        held = self.support.held(sine, cosine, weight)
        against = weight * (height * sine + beside * cosine)
        if not self.slope.level:
            against -= self.load.thrust * self._reach(rotation)
        return Statics(
            vertical_displacement=held.rise - rise - beside * sine,
            base_moment=held.moment,
            restoring_moment=held.moment - against,
            contact_state=held.contact,
            reactions=held.reactions,
        )

    def _reach(self, rotation: float) -> float:
        """Give how the centre of mass moves along the base about the held point [m]."""
        from rockframe.dynamics.alone_model import starting_state
        from rockframe.dynamics.protocol import Start

        part = self._part()
        body, law = part.body, part.base
        own = law.read(np.zeros(law.variables()), 0)
        _, mode = starting_state(part, Start(rotation), own)
        return body.reach(body.pin(mode.pivot), body.attitude(rotation)).rate

    def upright(self) -> dict[str, float]:
        """Give settlement, reactions and moment at uplift, as of a body that stands upright."""
        uplift = self.uplift_angle
        moment = math.nan if math.isnan(uplift) else self.statics(uplift).base_moment
        return {"uplift_moment": moment, **self.support.at_rest()}

    def equilibrium(self) -> dict[str, float]:
        """Give settlement, reactions and moment at uplift, by their names in the schema."""
        found = self.upright()
        if self.rest_rotation != 0.0:
            shown = self.statics(self.rest_rotation).reactions
            found |= {f"static_{name}": value for name, value in shown.items()}
        return found
