"""The scene of one body on a base that gives way: its numbers, its words and its model."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from rockframe.errors import AssemblyError
from rockframe.signals.slope import Slope
from rockframe.system.angles import angle_words
from rockframe.system.bodies import Body, OverturningAngles, leaning_cautions
from rockframe.system.restraints import restraint_words
from rockframe.system.small_motion import SmallMotion
from rockframe.system.statics import Statics, contact_of, sine_cosine_rise
from rockframe.system.support import Support
from rockframe.system.words import Words

if TYPE_CHECKING:
    from rockframe.dynamics.protocol import ContactModel


@dataclass(frozen=True)
class AloneSetting:
    """A body on a base.

    Parameters
    ----------
    support : Support
        The base, with the body on it.
    cap_offset : float, optional
        Height of a cap's centre above that of the body, where a cap is part of the body [m].
    """

    support: Support
    cap_offset: float | None = None

    @property
    def model(self) -> str:
        """Name of the model."""
        return self.support.model

    @property
    def gravity(self) -> float:
        """Acceleration of gravity [m s^-2]."""
        return self.support.load.gravity

    @property
    def body(self) -> Body:
        """The body on the base."""
        return self.support.load.body

    @property
    def slope(self) -> Slope:
        """The base line in its gravity."""
        return self.support.load.slope

    @property
    def overturning_angles(self) -> OverturningAngles:
        """Rotations at which the centre of mass stands above an end of the base [rad]."""
        return self.support.load.overturning_angles

    @property
    def overturning_angle(self) -> float:
        """Theta, of the body about the end of its base, on the side that falls first [rad]."""
        return self.overturning_angles.least

    @property
    def uplift_angle(self) -> float:
        """Rotation at which contact is first lost; NaN if it never is [rad]."""
        return self.support.uplift_angle

    @property
    def settlement(self) -> float | None:
        """Settlement under the weight [m]."""
        return self.support.settlement

    def cautions(self) -> list[str]:
        """Give the warnings of the base."""
        leaning = leaning_cautions(
            self.body, self.rest_rotation, self.overturning_angles, self.slope
        )
        return [*self.support.cautions(), *leaning]

    def start_faults(self, rotation: float, has_vertical_start: bool) -> list[str]:
        """Give the faults that the base finds in an initial state."""
        return self.support.start_faults(rotation, has_vertical_start)

    def words(self) -> Words:
        """Tell the base, and what the body on it lacks."""
        base, options = self.support.words(), self.support.load.options
        return Words(
            equations=base.equations,
            restraint=restraint_words(options.restraint, options.rotation, base.end),
            uplift=[base.uplift],
            numbers=base.numbers,
            left_out=["sliding", f"elasticity of the {base.body}", *base.left_out],
        )

    def compile(self) -> "ContactModel":
        """Give the equations, ready for the integrator."""
        from rockframe.dynamics.alone_model import alone

        load = self.support.load
        own, base = load.own_law, self.support.own_law
        model = alone(self.model, own, base, load.body.mass, self.rest_rotation)
        return replace(model, rotation_limits=self.overturning_angles)

    @property
    def rest_rotation(self) -> float:
        """Rotation at rest: a body leans to the side to which its weight turns it [rad].

        At small rotation on pads or a bed that of :eq:`eq-incline-lean`.

        Raises
        ------
        AssemblyError
            The base is too soft, or too much inclined, to carry the body.
        """
        return self._leaning

    @cached_property
    def _leaning(self) -> float:
        load = self.support.load
        if load.body.eccentricity == 0.0 and self.slope.level:
            return 0.0
        from rockframe.dynamics.on_base import OnBase
        from rockframe.dynamics.rest import rest_rotation

        part = OnBase(load.own_law, self.support.own_law.law)
        found = rest_rotation(part, self.slope.along_gravity)
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
        body, law = self.support.load.body, self.support.own_law
        if body.eccentricity != 0.0 or not self.slope.level:
            return self._leaning_motion()
        springs = body.mass * np.diag([law.vertical_stiffness, law.rotational_stiffness])
        raising = self.support.load.weight * body.centre_height
        return SmallMotion(
            ("vertical_displacement", "rotation"),
            np.diag([body.mass, body.base_inertia]),
            law.damping_time * springs,
            springs - np.diag([0.0, raising]),
        )

    def _leaning_motion(self) -> SmallMotion:
        """Give the equations of small motion about a rest that is not upright."""
        from rockframe.dynamics.linear import linear_alone
        from rockframe.dynamics.on_base import OnBase

        load = self.support.load
        body = load.body
        mass = np.diag([body.mass, body.base_inertia])
        part = OnBase(load.own_law, self.support.own_law.law)
        linear = linear_alone(part, self.rest_rotation, self.slope.along_gravity)
        names = ("vertical_displacement", "rotation")
        return SmallMotion(names, mass, mass @ linear.damping, mass @ linear.stiffness)

    def statics(self, rotation: float) -> Statics:
        """Give the vertical equilibrium at a rotation, :eq:`eq-incline-held`."""
        load = self.support.load
        height, beside = load.body.centre_height, load.body.eccentricity
        sine, cosine, rise = sine_cosine_rise(height, load.options.rotation, rotation)
        held = self.support.held(sine, cosine, load.weight)
        against = load.weight * (height * sine + beside * cosine)
        if not self.slope.level:
            against -= load.body.mass * self.slope.along_gravity * self._reach(rotation)
        return Statics(
            vertical_displacement=held.rise - rise - beside * sine,
            base_moment=held.moment,
            restoring_moment=held.moment - against,
            contact_state=contact_of(held.left, held.right),
            reactions=held.reactions,
        )

    def _reach(self, rotation: float) -> float:
        """Give how the centre of mass moves along the base about the held point [m]."""
        from rockframe.dynamics.alone_model import starting_state
        from rockframe.dynamics.on_base import OnBase
        from rockframe.dynamics.protocol import Start

        body, law = self.support.load.own_law, self.support.own_law.law
        own = law.read(np.zeros(law.variables()), 0)
        _, mode = starting_state(OnBase(body, law), Start(rotation), own)
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
