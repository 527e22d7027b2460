"""A block on rigid ground with a tendon that bends over the edges of its duct.

Per unit mass of the block; the tendon has the interface of a tie. As the block rotates by alpha
about a corner at the distance e from the duct, the mouths of the duct separate by
2 e sin(alpha/2), which stretches the tendon.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from . import tied_rigid_block


@dataclass
class Tendon:
    """An elastic, unbreakable tendon with a preload."""

    to_left: float  # from the duct to the left corner
    to_right: float
    stiffness: float
    preload: float = 0.0
    state: str = "taut"
    side: int = 1  # of the corner that bears

    def begin(self, height: float, z) -> None:
        """Begin: a tendon has no state."""

    def length(self, z):
        """Return the elongation, its derivatives, and its rate."""
        alpha, rate = z[0], z[3]
        far = self.to_right if self.side > 0 else self.to_left
        way = self.side * far * math.cos(0.5 * alpha)
        return 2.0 * self.side * far * math.sin(0.5 * alpha), (way, 0.0, 0.0), way * rate, 0.0

    def tension(self, length: float, rate: float) -> float:
        """Return the force in it."""
        return self.preload + self.stiffness * length

    def guards(self, number: int) -> list:
        """Return the guards of its state: none."""
        return []

    def turned(self, z) -> bool:
        """Whether it has reversed: never."""
        return False


class Block(tied_rigid_block.Block):
    """A block with tendons."""

    def pulls(self, alpha: float, rate: float) -> tuple[float, float]:
        """Return the tendons' moment on the rotation; they exert no vertical force."""
        for one in self.ties:
            one.side = self.side
        return super().pulls(alpha, rate)
