"""All guards of a step: those of the system, and the limit of the rotation; its peaks."""

from typing import Final, NamedTuple

from rockframe.compiled import Vector, inlined, put
from rockframe.dynamics.protocol import Equations, Ground, Guards

LEFT_LIMIT: Final = 0
RIGHT_LIMIT: Final = 1
"""Places of the limits of the rotation; the weights of the coordinates in it stand behind, then
the same of other rotations that have limits."""
WEIGHTS: Final = 2


DIP_MARGIN: Final = 0.02
"""Share of a guard's variation in a step below which a predicted dip is looked into."""
DOUBT: Final = 1.01 * DIP_MARGIN
"""The same for a bound of the dip, with room for rounding."""
THIRD: Final = 1.0 / 3.0


@inlined
def guards_at(
    system: Equations, mode: int, state: Vector, slope: Vector, ground: Ground, limits: Vector,
    out: Vector,
) -> None:  # fmt: skip
    """Write the guards of a state, see :func:`put_guards`; of several limits the nearest."""
    put_guards(system, system.guards_in(mode, state, slope, ground), state, limits, out)
    size, last = system.coordinates(), system.guards()
    row = WEIGHTS + size
    while row < len(limits):
        rotation = rate = 0.0
        for i in range(size):
            rotation += limits[row + WEIGHTS + i] * state[i]
            rate += limits[row + WEIGHTS + i] * state[size + i]
        left = rotation <= 0.0
        apart = (
            limits[row + LEFT_LIMIT] + rotation if left else limits[row + RIGHT_LIMIT] - rotation
        )
        if apart < out[last]:
            out[last], out[2 * last + 1] = apart, rate if left else -rate
        row += WEIGHTS + size


@inlined
def put_guards(
    system: Equations, found: Guards, state: Vector, limits: Vector, out: Vector
) -> None:
    """Write guards, then their rates; the last is the distance of the rotation from its limit."""
    size, last = system.coordinates(), system.guards()
    rotation = rate = 0.0
    for i in range(size):
        rotation += limits[WEIGHTS + i] * state[i]
        rate += limits[WEIGHTS + i] * state[size + i]
    left = rotation <= 0.0
    put(found.values, 0, out)
    put(found.changes, last + 1, out)
    out[last] = limits[LEFT_LIMIT] + rotation if left else limits[RIGHT_LIMIT] - rotation
    out[2 * last + 1] = rate if left else -rate


@inlined
def may_dip(start: float, change: float, end: float, end_change: float) -> bool:
    """Whether a guard with these rates, by its step, is negative at its end or may be inside it.

    The cubic through values and rates is nowhere below its lowest Bernstein coefficient, however
    it begins and ends; divided by the place in the step, where it begins at zero, it has the
    same ones but for factors.
    """
    lowest = min(start + THIRD * change, end - THIRD * end_change)
    return (lowest < DOUBT * (abs(change) + abs(end_change))) | (end < 0.0)


@inlined
def may_fall(system: Equations, h: float, before: Vector, after: Vector) -> bool:
    """Whether some guard is negative after a step, or may have dipped below zero inside it."""
    found, guards = False, system.guards() + 1
    for i in range(guards):
        found |= may_dip(before[i], h * before[guards + i], after[i], h * after[guards + i])
    return found


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
