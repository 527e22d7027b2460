"""A base of which only the law is known: rest and held rotations are found by numbers."""

import math

import numpy as np

from rockframe.dynamics.body import BaseLine
from rockframe.system.support import Held, Support

HALVINGS = 60
"""Halvings of the rotation at which contact is first lost."""


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
        swing, beside = body.height * sine, self.load.body.eccentricity
        levers = swing + body.left * cosine, swing - body.right * cosine

        def line_at(middle: float) -> BaseLine:
            return BaseLine(
                middle + body.left * sine, middle - body.right * sine, 0.0, 0.0, *levers
            )

        def excess(middle: float) -> float:
            line = line_at(middle)
            return mass * law.force(law.starting(line, own), line, own).upward - press

        high = numbers.settlement + (body.left + body.right) * abs(sine)
        depth = numbers.settlement
        while excess(high - depth) <= 0.0:
            depth *= 2.0
        middle = root_scalar(excess, bracket=(high - depth, high), xtol=1e-15, rtol=1e-14).root
        line = line_at(middle)
        contact = law.starting(line, own)
        shown = law.observed(contact, line, own)
        return Held(
            rise=middle + beside * sine,
            moment=press * (swing + beside * cosine) - mass * law.force(contact, line, own).moment,
            left=law.is_held(contact, True),
            right=law.is_held(contact, False),
            reactions={
                column.name: (mass if column.per_mass else 1.0) * value
                for column, value in zip(numbers.columns, shown, strict=True)
            },
        )
