"""An elastic wall behind a gap, with the interface of a tie; a point of the rear face strikes it.

Per unit mass of the body. It presses horizontally, by spring and dashpot, while the point is
beyond the gap.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from .ties import SLACK, TAUT, Tie


@dataclass
class Wall(Tie):
    """A wall to one side: 1 for the right, -1 for the left; its anchor is not used."""

    side: float = -1.0

    def begin(self, height: float, z) -> None:
        """Set whether it is touched at the start."""
        self.set, self.loss, self.height = 0.0, 0.0, height
        self.natural, self.most = self.slack, math.inf
        self.state = TAUT if self.length(z)[0] > self.natural else SLACK

    def length(self, z, xp=math):
        """Return the displacement of the point towards the wall, in the form of a tie's length."""
        alpha, _, x, alpha_dot, _, x_dot = z[:6]
        sine, cosine = xp.sin(alpha), xp.cos(alpha)
        px, py = self.point
        across, up = px * cosine + py * sine, py * cosine - px * sine
        way = (self.side * up, 0.0, self.side)
        rate = self.side * (x_dot + up * alpha_dot)
        return self.side * (x + across - px), way, rate, -self.side * across * alpha_dot**2

    def tension(self, length, rate):
        """Return the force of the wall on the body."""
        if self.state == SLACK:
            return 0.0 * length
        return self.stiffness * (length - self.natural) + self.damping * rate

    def lost_power(self, rate: float) -> float:
        """Return the power of the dashpot."""
        return self.damping * rate * rate if self.state == TAUT else 0.0
