"""What a system knows of its bodies, and where they stand in the state.

Rotation and height of each body in turn, then the horizontal coordinate of each, which a
restraint may hold; the rates in the same order; then the variables of the bases' own.
"""

from typing import Final, Protocol

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.body import BodyState
from rockframe.dynamics.on_base import Mode, VelocityChange
from rockframe.dynamics.protocol import Ground
from rockframe.dynamics.sliding import blend

ROTATION: Final = 0
VERTICAL: Final = 1
BEFORE_HORIZONTAL: Final = 2
"""Coordinates of each body that stand before the horizontal ones of all bodies."""
DEGREES: Final = 3
"""Coordinates of a body."""


class Bodies(Protocol):
    """What a system of bodies knows of body `k`, and does to it."""

    def part_mode(self, mode: int, k: int) -> Mode:
        """Give how the body stands in a mode."""
        ...

    def with_part(self, mode: int, k: int, part: Mode) -> int:
        """Give the mode in which the body stands otherwise."""
        ...

    def state_of(self, k: int, state: Vector) -> BodyState:
        """Give placement and rates of the body relative to its base."""
        ...

    def own_place(self, k: int) -> int:
        """Give the place of the variables of its base's own in the state."""
        ...

    def place(self, k: int, mode: int, state: Vector, memory: Vector) -> float:
        """Give the horizontal place of its centre of mass, relative to its base."""
        ...

    def change(self, k: int, rise: float, speed: float, state: Vector) -> None:
        """Add to its height and to its vertical velocity."""
        ...

    def stand_upright(self, k: int, state: Vector) -> None:
        """Set its rotation to zero."""
        ...

    def set_sway(self, k: int, place: float, velocity: float, state: Vector) -> None:
        """Set its horizontal coordinate and velocity."""
        ...

    def response(
        self, k: int, mode: int, press: float, moment: float, slip: float, state: Vector
    ) -> VelocityChange:
        """Give how velocities change by an impulse of its base, or as the hold stops a slip."""
        ...

    def respond(self, k: int, mode: int, response: VelocityChange, state: Vector) -> None:
        """Change the velocities."""
        ...

    def note_blow(self, k: int, press: float, moment: float, along: float) -> None:
        """Note the impulse that a body has got from its base, as an end of it landed."""
        ...

    def velocities(self, state: Vector) -> tuple[float, ...] | Vector:
        """Give all velocities."""
        ...

    def blend_velocities(
        self, before: tuple[float, ...] | Vector, share: float, state: Vector
    ) -> None:
        """Take back all but a share of what has changed the velocities since."""
        ...

    def end_accelerations(
        self, k: int, mode: int, state: Vector, ground: Ground
    ) -> tuple[float, float]:
        """Give the accelerations of the ends of its base in a mode, upwards."""
        ...

    def tendency(self, k: int, mode: int, state: Vector, ground: Ground) -> float:
        """Give the side to which it will rotate, upright and at rest."""
        ...


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
        return BEFORE_HORIZONTAL * self.bodies() + k

    @inlined
    def state_of(self, k: int, state: Vector) -> BodyState:
        """Give placement and rates of body `k`, relative to its base."""
        i, x, n = BEFORE_HORIZONTAL * k, self.horizontal_of(k), self.coordinates()
        return BodyState(
            state[i + ROTATION], state[i + VERTICAL], state[x],
            state[n + i + ROTATION], state[n + i + VERTICAL], state[n + x],
        )  # fmt: skip

    @kernel
    def change(self, k: int, rise: float, speed: float, state: Vector) -> None:
        """Add to the height of body `k` and to its vertical velocity."""
        i = BEFORE_HORIZONTAL * k + VERTICAL
        state[i] += rise
        state[self.coordinates() + i] += speed

    @kernel
    def stand_upright(self, k: int, state: Vector) -> None:
        """Set the rotation of body `k` to zero."""
        state[BEFORE_HORIZONTAL * k + ROTATION] = 0.0

    @kernel
    def set_sway(self, k: int, place: float, velocity: float, state: Vector) -> None:
        """Set the horizontal coordinate and velocity of body `k`."""
        i = self.horizontal_of(k)
        state[i] = place
        state[self.coordinates() + i] = velocity

    @kernel
    def respond(self, k: int, mode: int, response: VelocityChange, state: Vector) -> None:
        """Change the velocities of body `k`, which alone answers."""
        i = self.coordinates() + BEFORE_HORIZONTAL * k
        state[i + ROTATION] += response.rotation
        state[i + VERTICAL] += response.vertical

    @inlined
    def note_blow(self, k: int, press: float, moment: float, along: float) -> None:
        """Note the impulse of a base on a body that has landed: none has to be taken back here."""

    @kernel
    def blend_velocities(
        self, before: tuple[float, ...] | Vector, share: float, state: Vector
    ) -> None:
        """Take back all but a share of what has changed the velocities since."""
        n = self.coordinates()
        for i in range(n):
            state[n + i] = blend(before[i], state[n + i], share)
