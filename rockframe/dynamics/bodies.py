"""Where bodies stand in the state, whatever their number and whatever they stand on.

Rotation and height of each body in turn, then the horizontal coordinate of each, which a
restraint may hold; the rates in the same order; then the variables of the bases' own.
"""

from typing import Final

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.body import BodyState
from rockframe.dynamics.on_base import Response
from rockframe.dynamics.sliding import blend

ROTATION: Final = 0
VERTICAL: Final = 1
HELD_LAST: Final = 2
"""Coordinates of a body that stand before all horizontal ones."""
DEGREES: Final = 3
"""Coordinates of a body."""


class InState:
    """What systems of bodies share: how the bodies stand in the state. A mixin of named tuples."""

    __slots__ = ()

    def bodies(self) -> int:
        """Give the number of bodies."""
        raise NotImplementedError

    @inlined
    def coordinates(self) -> int:
        """Give the number of coordinates."""
        return DEGREES * self.bodies()

    @inlined
    def horizontal_of(self, k: int) -> int:
        """Give the place of the horizontal coordinate of body `k`."""
        return HELD_LAST * self.bodies() + k

    @inlined
    def state_of(self, k: int, state: Vector) -> BodyState:
        """Give placement and rates of body `k`, relative to its base."""
        i, x, n = HELD_LAST * k, self.horizontal_of(k), self.coordinates()
        return BodyState(
            state[i + ROTATION], state[i + VERTICAL], state[x],
            state[n + i + ROTATION], state[n + i + VERTICAL], state[n + x],
        )  # fmt: skip

    @kernel
    def change(self, k: int, rise: float, speed: float, state: Vector) -> None:
        """Add to the height of body `k` and to its vertical velocity."""
        i = HELD_LAST * k + VERTICAL
        state[i] += rise
        state[self.coordinates() + i] += speed

    @kernel
    def stand_upright(self, k: int, state: Vector) -> None:
        """Set the rotation of body `k` to zero."""
        state[HELD_LAST * k + ROTATION] = 0.0

    @kernel
    def set_sway(self, k: int, place: float, velocity: float, state: Vector) -> None:
        """Set the horizontal coordinate and velocity of body `k`."""
        i = self.horizontal_of(k)
        state[i] = place
        state[self.coordinates() + i] = velocity

    @kernel
    def respond(self, k: int, mode: int, response: Response, state: Vector) -> None:
        """Change the velocities of body `k`, which alone answers."""
        i = self.coordinates() + HELD_LAST * k
        state[i + ROTATION] += response.rotation
        state[i + VERTICAL] += response.vertical

    @kernel
    def blend_velocities(self, before: tuple[float, ...], share: float, state: Vector) -> None:
        """Take back all but a share of what has changed the velocities since."""
        n = self.coordinates()
        for i in range(n):
            state[n + i] = blend(before[i], state[n + i], share)
