"""The rotation at both ends of a step, and whether its peak may lie inside."""

from typing import NamedTuple

from rockframe.compiled import Vector, inlined
from rockframe.dynamics.protocol import Equations
from rockframe.solve.guards import WEIGHTS


class RotationInStep(NamedTuple):
    """The rotation and its rate at the start and at the end of a step."""

    start: float
    start_rate: float
    end: float
    end_rate: float

    @inlined
    def largest_left(self) -> float:
        """Give the largest rotation to the left at the ends."""
        return max(-self.start, -self.end)

    @inlined
    def largest_right(self) -> float:
        """Give the largest rotation to the right at the ends."""
        return max(self.start, self.end)

    @inlined
    def may_peak(self, h: float, left: float, right: float) -> bool:
        """Whether it reverses within a step of length h, and may do so beyond its peaks so far."""
        ahead = 0.5 * h * max(abs(self.start_rate), abs(self.end_rate))
        rises_left = self.largest_left() + ahead > left
        rises_right = self.largest_right() + ahead > right
        rises = rises_right if self.start_rate > 0.0 else rises_left
        return (self.start_rate * self.end_rate < 0.0) & rises


@inlined
def rotation_in_step(
    system: Equations, limits: Vector, state: Vector, new: Vector
) -> RotationInStep:
    """Give the rotation at both ends of a step, the weighted sum of the coordinates."""
    size = system.coordinates()
    r0 = v0 = r1 = v1 = 0.0
    for i in range(size):
        r0 += limits[WEIGHTS + i] * state[i]
        v0 += limits[WEIGHTS + i] * state[size + i]
        r1 += limits[WEIGHTS + i] * new[i]
        v1 += limits[WEIGHTS + i] * new[size + i]
    return RotationInStep(r0, v0, r1, v1)
