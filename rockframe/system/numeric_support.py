"""A base of which only the law is known: rest and held rotations are found by numbers."""

import math
from typing import Final

import numpy as np

from rockframe.dynamics.body import BaseLine
from rockframe.dynamics.body import Body as BodyLaw
from rockframe.system.statics import sine_cosine_rise
from rockframe.system.support import Held, Support

HALVINGS: Final = 60
"""Halvings of the rotation at which contact is first lost."""
COMPARED: Final = (0.0, 0.02, 0.5, -0.5)
"""Rotations, over the overturning angle, at which the answers of a support are compared with its
law: at rest, before and after most bases lose full contact, and on the other side."""
AGREEMENT: Final = 1e-6
"""Differences that are rounding, over the weight and its moment about an end of the base; of pads
as hard as rock they are below 1e-9."""


def line_at(body: BodyLaw, sine: float, cosine: float, middle: float) -> BaseLine:
    """Give the base line of a body that is held at a rotation, beneath its centre of mass."""
    swing = body.height * sine
    levers = swing + body.left * cosine, swing - body.right * cosine
    return BaseLine(middle + body.left * sine, middle - body.right * sine, 0.0, 0.0, *levers)


def disagreement(support: Support) -> str | None:
    """Say where a support and its law hold a body by other forces.

    Parameters
    ----------
    support : Support
        A base under a body.

    Returns
    -------
    str or None
        What both give at a rotation; None where they agree.
    """
    load, law = support.load, support.own_law.law
    weight, mass, beside = load.weight, load.body.mass, load.body.eccentricity
    own = law.read(np.zeros(law.variables()), 0)
    for share in COMPARED:
        rotation = share * load.overturning_angles.least
        sine, cosine, _ = sine_cosine_rise(load.own_law.height, load.options.rotation, rotation)
        held = support.held(sine, cosine, weight)
        line = line_at(load.own_law, sine, cosine, held.rise - beside * sine)
        force = law.force(law.starting(line, own), line, own)
        moment = weight * (load.own_law.height * sine + beside * cosine) - mass * force.moment
        apart = abs(mass * force.upward - weight), abs(moment - held.moment)
        if not (
            apart[0] <= AGREEMENT * weight and apart[1] <= AGREEMENT * weight * load.body.half_width
        ):
            return (
                f"held at {rotation:.4g} rad under {weight:.6g} N the support "
                f"{type(support).__name__} answers with a moment of {held.moment:.6g} N m, its law "
                f"with {moment:.6g} N m under {mass * force.upward:.6g} N"
            )
    return None


class NumericSupport(Support):
    """A base whose equilibrium is found from its law; its own variables as at the start.

    A subclass gives ``model``, ``law`` and ``words``.
    """

    @property
    def settlement(self) -> float:
        """Settlement under the weight [m]."""
        return self.own_law.settlement

    @property
    def uplift_angle(self) -> float:
        """Rotation at which contact is first lost; NaN if it is not up to a right angle [rad]."""

        def is_full(rotation: float) -> bool:
            held = self.held_at(rotation)
            return held.left and held.right

        low, high = 0.0, 0.5 * math.pi
        if self.load.options.small:
            while is_full(high):
                high *= 2.0
        elif is_full(high):
            return math.nan
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if is_full(middle) else (low, middle)
        return high

    def held(self, sine: float, cosine: float, press: float) -> Held:
        """Give the equilibrium at a rotation under a vertical force."""
        from scipy.optimize import root_scalar

        mass = self.load.body.mass
        body, numbers = self.load.law(mass), self.own_law
        law = numbers.law
        own = law.read(np.zeros(law.variables()), 0)
        beside = self.load.body.eccentricity

        def excess(middle: float) -> float:
            line = line_at(body, sine, cosine, middle)
            return mass * law.force(law.starting(line, own), line, own).upward - press

        high = numbers.settlement + (body.left + body.right) * abs(sine)
        depth = numbers.settlement
        while excess(high - depth) <= 0.0:
            depth *= 2.0
        middle = root_scalar(excess, bracket=(high - depth, high), xtol=1e-15, rtol=1e-14).root
        line = line_at(body, sine, cosine, middle)
        contact = law.starting(line, own)
        shown = law.observed(contact, line, own)
        return Held(
            rise=middle + beside * sine,
            moment=press * (body.height * sine + beside * cosine)
            - mass * law.force(contact, line, own).moment,
            left=law.is_held(contact, True),
            right=law.is_held(contact, False),
            reactions={
                column.name: (mass if column.per_mass else 1.0) * value
                for column, value in zip(numbers.columns, shown, strict=True)
            },
        )
