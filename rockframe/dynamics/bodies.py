"""Order of the state of a system of bodies, and the access of events to each body.

The state has rotation and height of each body in turn, then the horizontal coordinate of each,
which a restraint may hold; the rates in the same order; then the bases' own variables.
"""

from typing import Final, Protocol

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.body import BodyState
from rockframe.dynamics.on_base import Mode, VelocityChange, blend
from rockframe.dynamics.protocol import Ground

ROTATION: Final = 0
VERTICAL: Final = 1
BEFORE_HORIZONTAL: Final = 2
"""Coordinates of each body that come before the horizontal ones of all bodies."""
BODY_DOF: Final = 3
"""Coordinates of a body."""


class Bodies(Protocol):
    """What events need of a system of bodies: access to body `k`, and responses to impulses."""

    def body_mode(self, mode: int, k: int) -> Mode:
        """Return contact, held point and sliding of body `k` in a mode."""
        ...

    def with_body_mode(self, mode: int, k: int, part: Mode) -> int:
        """Return the system's mode with another mode of body `k`."""
        ...

    def state_of(self, k: int, state: Vector) -> BodyState:
        """Return placement and rates of body `k` relative to its base."""
        ...

    def base_variable_index(self, k: int) -> int:
        """Return the index in the state of the own variables of the base of body `k`."""
        ...

    def centre_position(self, k: int, mode: int, state: Vector, memory: Vector) -> float:
        """Return the horizontal place of the centre of mass of body `k`, relative to its base."""
        ...

    def shift_vertical(self, k: int, rise: float, speed: float, state: Vector) -> None:
        """Add to height and vertical velocity of body `k`."""
        ...

    def set_upright(self, k: int, state: Vector) -> None:
        """Set the rotation of body `k` to zero."""
        ...

    def set_horizontal(self, k: int, place: float, velocity: float, state: Vector) -> None:
        """Set horizontal coordinate and velocity of body `k`."""
        ...

    def response(
        self, k: int, mode: int, impulse: float, moment: float, slip: float, state: Vector
    ) -> VelocityChange:
        """Return changes of velocities by an impulse of a base, or by a hold that stops a slip."""
        ...

    def respond(self, k: int, mode: int, response: VelocityChange, state: Vector) -> None:
        """Change the velocities by a response."""
        ...

    def record_impulse(self, k: int, normal: float, moment: float, along: float) -> None:
        """Record the impulse of a base on body `k` as an end lands."""
        ...

    def velocities(self, state: Vector) -> tuple[float, ...] | Vector:
        """Return all velocities."""
        ...

    def blend_velocities(
        self, before: tuple[float, ...] | Vector, share: float, state: Vector
    ) -> None:
        """Reduce the changes of velocities since `before` to a share of them."""
        ...

    def end_accelerations(
        self, k: int, mode: int, state: Vector, ground: Ground
    ) -> tuple[float, float]:
        """Return the upward accelerations of the left and right end of the base of body `k`."""
        ...

    def incipient_rotation(self, k: int, mode: int, state: Vector, ground: Ground) -> float:
        """Return the sign of the rotation that begins as body `k` is upright and at rest."""
        ...


class StateAccess:
    """Access to the coordinates of bodies in the state. A mixin of named tuples."""

    __slots__ = ()

    def bodies(self) -> int:
        """Return the number of bodies."""
        raise NotImplementedError

    @inlined
    def coordinates(self) -> int:
        """Return the number of coordinates."""
        return BODY_DOF * self.bodies()

    @inlined
    def horizontal_of(self, k: int) -> int:
        """Return the index in the state of the horizontal coordinate of body `k`."""
        return BEFORE_HORIZONTAL * self.bodies() + k

    @inlined
    def state_of(self, k: int, state: Vector) -> BodyState:
        """Return placement and rates of body `k`, relative to its base."""
        i, x, n = BEFORE_HORIZONTAL * k, self.horizontal_of(k), self.coordinates()
        return BodyState(
            state[i + ROTATION], state[i + VERTICAL], state[x],
            state[n + i + ROTATION], state[n + i + VERTICAL], state[n + x],
        )  # fmt: skip

    @kernel
    def shift_vertical(self, k: int, rise: float, speed: float, state: Vector) -> None:
        """Add to the height of body `k` and to its vertical velocity."""
        i = BEFORE_HORIZONTAL * k + VERTICAL
        state[i] += rise
        state[self.coordinates() + i] += speed

    @kernel
    def set_upright(self, k: int, state: Vector) -> None:
        """Set the rotation of body `k` to zero."""
        state[BEFORE_HORIZONTAL * k + ROTATION] = 0.0

    @kernel
    def set_horizontal(self, k: int, place: float, velocity: float, state: Vector) -> None:
        """Set the horizontal coordinate and velocity of body `k`."""
        i = self.horizontal_of(k)
        state[i] = place
        state[self.coordinates() + i] = velocity

    @kernel
    def respond(self, k: int, mode: int, response: VelocityChange, state: Vector) -> None:
        """Change the velocities of body `k` by a response, in which no other body moves."""
        i = self.coordinates() + BEFORE_HORIZONTAL * k
        state[i + ROTATION] += response.rotation
        state[i + VERTICAL] += response.vertical

    @inlined
    def record_impulse(self, k: int, normal: float, moment: float, along: float) -> None:
        """Record the impulse of a base on a body that lands: it is not needed here."""

    @kernel
    def blend_velocities(
        self, before: tuple[float, ...] | Vector, share: float, state: Vector
    ) -> None:
        """Reduce the changes of velocities since `before`, and impulses, to a share of them."""
        n = self.coordinates()
        for i in range(n):
            state[n + i] = blend(before[i], state[n + i], share)
        self.scale_impulses(share)

    @inlined
    def scale_impulses(self, share: float) -> None:
        """Multiply the impulses recorded in an event by a factor: there are none here."""
