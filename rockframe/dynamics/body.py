"""A rigid body on a base: kinematics of its base line and of its centre of mass.

Equation :eq:`eq-kinematics`. The body need not be symmetric: its centre of mass is at a height
h above the base, b_l from its left and b_r from its right end.
"""

from typing import Final, NamedTuple

from rockframe.compiled import inlined, kernel
from rockframe.dynamics.trigonometry import sine_cosine

# rules of restraint
BY_CONTACT: Final = 0
LEADING_CORNER: Final = 1
CENTRE: Final = 2

# pivots: the point of the base that is held
PIVOT_CENTRE: Final = 0
PIVOT_RIGHT: Final = 1
PIVOT_LEFT: Final = 2

REST_AMPLITUDE: Final = 1e-10
"""Amplitude of a rebound over theta below which the body is put to rest [1]. It is far below
what any accuracy setting resolves, and ends the infinite series of ever smaller impacts."""


@kernel
def leading_pivot(rotation: float, tendency: float) -> int:
    """Return the pivot of the corner to which a body leans, or else tends to lean."""
    leading = rotation if rotation != 0.0 else tendency
    if leading == 0.0:
        return PIVOT_CENTRE
    return PIVOT_RIGHT if leading > 0.0 else PIVOT_LEFT


@kernel
def pivot_of(
    rule: int, holds_left: bool, holds_right: bool, rotation: float, angular_velocity: float
) -> int:
    """Return the pivot by a rule of restraint, for a body not in flight."""
    if rule == BY_CONTACT:
        if not holds_left:
            return PIVOT_RIGHT
        if not holds_right:
            return PIVOT_LEFT
        return PIVOT_CENTRE
    if rule == LEADING_CORNER:
        return leading_pivot(rotation, angular_velocity)
    return PIVOT_CENTRE


class BodyState(NamedTuple):
    """Rotation [rad], displacements of the centre of mass from rest [m], and rates; on its base.

    The horizontal coordinate is independent only while no point of the base is held.
    """

    rotation: float
    vertical: float
    horizontal: float
    angular_velocity: float
    vertical_velocity: float
    horizontal_velocity: float


class Attitude(NamedTuple):
    """Sine and cosine of a rotation, and h(1 - cos a) [m]; or their small-rotation forms."""

    sine: float
    cosine: float
    rise: float


class BaseLine(NamedTuple):
    """Both ends of a base: heights above their places at rest, speeds upwards, levers.

    A lever is the derivative of an end's height by the rotation. The accelerations are set for
    guards only: forces are computed before them.
    """

    left: float
    right: float
    left_speed: float
    right_speed: float
    left_lever: float
    right_lever: float
    left_acceleration: float = 0.0
    right_acceleration: float = 0.0


@inlined
def with_accelerations(line: BaseLine, left: float, right: float) -> BaseLine:
    """Return a base line with the accelerations of its ends."""
    return BaseLine(
        line.left, line.right, line.left_speed, line.right_speed, line.left_lever,
        line.right_lever, left, right,
    )  # fmt: skip


class Reach(NamedTuple):
    """Derivatives of the horizontal position x of the centre of mass by the rotation a [m]."""

    derivative: float  # dx/da
    second_derivative: float  # d2x/da2


class Body(NamedTuple):
    """Shape and inertia of a body, and how it is held; lengths in metres, per unit mass."""

    height: float  # h, of the centre of mass above the base
    left: float  # b_l, from the centre of mass to the left end
    right: float  # b_r
    inertia: float  # I_O/m
    gravity: float  # g
    angle: float  # theta, the scale of rotations
    restraint: int  # a rule of rockframe.dynamics.body
    small: bool  # whether the kinematics are expanded to second order in the rotation

    @inlined
    def attitude(self, rotation: float) -> Attitude:
        """Return sine, cosine and rise at a rotation."""
        if self.small:
            return Attitude(rotation, 1.0, 0.5 * self.height * rotation * rotation)
        sine, cosine = sine_cosine(rotation)
        # sin^2/(1 + cos) has no cancellation at small rotation, 1 - cos none past a right angle
        if cosine > 0.0:
            return Attitude(sine, cosine, self.height * sine * sine / (1.0 + cosine))
        return Attitude(sine, cosine, self.height * (1.0 - cosine))

    @inlined
    def base_line(self, state: BodyState, attitude: Attitude) -> BaseLine:
        """Return heights, speeds and levers of both ends of the base."""
        middle = state.vertical + attitude.rise
        swing = self.height * attitude.sine
        left = swing + self.left * attitude.cosine
        right = swing - self.right * attitude.cosine
        return BaseLine(
            middle + self.left * attitude.sine,
            middle - self.right * attitude.sine,
            state.vertical_velocity + left * state.angular_velocity,
            state.vertical_velocity + right * state.angular_velocity,
            left,
            right,
            0.0,
            0.0,
        )

    @kernel
    def base_line_at(self, state: BodyState) -> BaseLine:
        """Return the same as `base_line`, with the attitude computed from the state."""
        return self.base_line(state, self.attitude(state.rotation))

    @inlined
    def end_accelerations(
        self,
        attitude: Attitude,
        angular_velocity: float,
        vertical: float,
        angular: float,
    ) -> tuple[float, float]:
        """Return the vertical accelerations of the left and of the right end.

        `vertical` and `angular` are the accelerations of the centre of mass and of the rotation;
        the levers change by h cos a -/+ b sin a.
        """
        square = angular_velocity * angular_velocity
        if self.small:
            middle = vertical + self.height * (attitude.sine * angular + square)
            return (
                middle + self.left * angular,
                middle - self.right * angular,
            )
        middle = vertical + self.height * (attitude.sine * angular + attitude.cosine * square)
        tilt = attitude.cosine * angular - attitude.sine * square
        return middle + self.left * tilt, middle - self.right * tilt

    @inlined
    def pin(self, pivot: int) -> float:
        """Return e, the held point to the right of the centre of mass, upright [m]."""
        if pivot == PIVOT_RIGHT:
            return self.right
        if pivot == PIVOT_LEFT:
            return -self.left
        return 0.5 * (self.right - self.left)

    @inlined
    def reach(self, pin: float, attitude: Attitude) -> Reach:
        """Return dx/da and d2x/da2 of the centre of mass about the held point."""
        if self.small:
            return Reach(self.height, 0.0)
        return Reach(
            self.height * attitude.cosine + pin * attitude.sine,
            pin * attitude.cosine - self.height * attitude.sine,
        )

    @inlined
    def about_pin(self, pin: float, attitude: Attitude) -> float:
        """Return h sin a - e cos a, the centre of mass to the right of the held point [m]."""
        return self.height * attitude.sine - pin * attitude.cosine

    @inlined
    def reach_about(self, pivot: int, rotation: float) -> Reach:
        """Return the same as `reach`, from a pivot and a rotation."""
        return self.reach(self.pin(pivot), self.attitude(rotation))

    @inlined
    def from_pivot(self, pivot: int, rotation: float) -> float:
        """Return the same as `about_pin`, from a pivot and a rotation."""
        return self.about_pin(self.pin(pivot), self.attitude(rotation))

    @kernel
    def size(self) -> float:
        """Return half the width plus the height of the centre of mass, a scale of levers [m]."""
        return 0.5 * (self.left + self.right) + self.height

    @inlined
    def least_rise(self) -> float:
        """Return the height above which a rise of an end counts as one [m]."""
        return REST_AMPLITUDE * self.angle * self.size()

    @inlined
    def returns_at_once(self, speed: float, fall: float) -> bool:
        """Whether an end with this upward speed and downward acceleration rises negligibly."""
        return fall > 0.0 and speed * speed < 2.0 * fall * self.least_rise()
