"""Positions and velocities of the ends of links, and the elongations, :eq:`eq-link`."""

import math
from typing import Final, NamedTuple

from rockframe.compiled import Vector, inlined
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.link_rows import (
    BODY_ROTATION_RATE,
    BODY_SINE,
    BODY_VERSINE,
    DIRECTION_X,
    DIRECTION_Y,
    DISPLACEMENT_X,
    DISPLACEMENT_Y,
    FIRST_BODY,
    FIRST_X,
    FIRST_Y,
    GROUND,
    INITIAL_LENGTH,
    NOISE,
    POSE_STRIDE,
    SECOND_BODY,
    SECOND_X,
    SECOND_Y,
    SEPARATION_X,
    SEPARATION_Y,
    LinkRows,
)
from rockframe.dynamics.chain.rows import BODY_STRIDE
from rockframe.dynamics.links import Stretch
from rockframe.dynamics.pads import ROUNDING

COINCIDENCE: Final = 1e3
"""Points of a link meet within this many times the rounding noise of its elongation, and part if
their relative velocity exceeds as many times its own."""
TINY: Final = 1e-140
"""Speed below which it counts as zero [m s^-1]."""


class DisplacedPoint(NamedTuple):
    """Displacement of a point of a body [m], its lever arm [m], and its velocity [m s^-1]."""

    x: float
    y: float
    arm_x: float  # from the centre of mass of its body
    arm_y: float
    speed_x: float
    speed_y: float


class LinkMotion(NamedTuple):
    """Elongation of a link and its rate; unit vector from its second point to its first."""

    stretch: Stretch
    x: float
    y: float


class LinkPoints(LinkRows):
    """Kinematics of the points of links. A mixin of systems."""

    __slots__ = ()

    @inlined
    def displaced_point(self, k: int, x: float, y: float, work: Vector) -> DisplacedPoint:
        """Return displacement and velocity of a point of a body, or of the ground."""
        if k == GROUND:
            return DisplacedPoint(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        poses, i, j = self.poses(), k * BODY_STRIDE, k * POSE_STRIDE
        sine, versine = poses[j + BODY_SINE], poses[j + BODY_VERSINE]
        rate = poses[j + BODY_ROTATION_RATE]
        rotated_x, rotated_y = y * sine - x * versine, -x * sine - y * versine
        arm_x, arm_y = x + rotated_x, y + rotated_y
        return DisplacedPoint(
            poses[j + DISPLACEMENT_X] + rotated_x, poses[j + DISPLACEMENT_Y] + rotated_y, arm_x,
            arm_y, work[i + at.SPEED_X] + rate * arm_y, work[i + at.SPEED_Y] - rate * arm_x,
        )  # fmt: skip

    @inlined
    def up_direction(self, k: int) -> tuple[float, float]:
        """Return the unit vector that points up on a body, or on the ground."""
        if k == GROUND:
            return 0.0, 1.0
        poses = self.poses()
        return poses[k * POSE_STRIDE + BODY_SINE], 1.0 - poses[k * POSE_STRIDE + BODY_VERSINE]

    @inlined
    def end_points(self, row: Vector, work: Vector) -> tuple[DisplacedPoint, DisplacedPoint]:
        """Return displacements and velocities of both points of a link."""
        first = self.displaced_point(int(row[FIRST_BODY]), row[FIRST_X], row[FIRST_Y], work)
        return first, self.displaced_point(
            int(row[SECOND_BODY]), row[SECOND_X], row[SECOND_Y], work
        )

    @inlined
    def speed_noise(self, k: int, point: DisplacedPoint) -> float:
        """Return the rounding noise of the velocity of a point of a body, or of the ground."""
        if k == GROUND:
            return 0.0
        rate = self.poses()[k * POSE_STRIDE + BODY_ROTATION_RATE]
        about_centre = abs(rate) * (abs(point.arm_x) + abs(point.arm_y))
        return ROUNDING * (abs(point.speed_x) + abs(point.speed_y) + about_centre)

    @inlined
    def link_kinematics(
        self, row: Vector, first: DisplacedPoint, second: DisplacedPoint
    ) -> LinkMotion:
        """Return elongation, rate and direction of a link, :eq:`eq-link`, but no acceleration.

        Where its points meet it acts along their relative velocity, in its upward sense, and
        upwards where they move together.
        """
        separation_x, separation_y = row[SEPARATION_X], row[SEPARATION_Y]
        initial_length = row[INITIAL_LENGTH]
        shift_x, shift_y = first.x - second.x, first.y - second.y
        x, y = separation_x + shift_x, separation_y + shift_y
        speed_x, speed_y = first.speed_x - second.speed_x, first.speed_y - second.speed_y
        direction_x, direction_y = row[DIRECTION_X], row[DIRECTION_Y]
        if direction_x != 0.0 or direction_y != 0.0:
            elongation = direction_x * shift_x + direction_y * shift_y
            rate = direction_x * speed_x + direction_y * speed_y
            return LinkMotion(
                Stretch(elongation, rate, 0.0, initial_length, row[NOISE]), direction_x, direction_y
            )
        square = x * x + y * y
        length, elongation = math.sqrt(square), 0.0
        if length + initial_length > 0.0:
            elongation = (2.0 * separation_x * shift_x + shift_x * shift_x) / (
                length + initial_length
            )
            elongation += (2.0 * separation_y * shift_y + shift_y * shift_y) / (
                length + initial_length
            )
        if length <= COINCIDENCE * row[NOISE]:
            up_x, up_y = self.up_direction(int(row[SECOND_BODY]))
            away = 1.0 if speed_x * up_x + speed_y * up_y >= 0.0 else -1.0
            x, y = away * speed_x, away * speed_y
            length = math.sqrt(x * x + y * y)
            noise = self.speed_noise(int(row[FIRST_BODY]), first)
            noise += self.speed_noise(int(row[SECOND_BODY]), second)
            if length <= max(COINCIDENCE * noise, TINY):
                still = Stretch(elongation, 0.0, 0.0, initial_length, row[NOISE])
                return LinkMotion(still, up_x, up_y)
        x, y = x / length, y / length
        rate = x * speed_x + y * speed_y
        return LinkMotion(Stretch(elongation, rate, 0.0, initial_length, row[NOISE]), x, y)

    @inlined
    def stretch_now(self, row: Vector, work: Vector) -> Stretch:
        """Return elongation and rate of a link."""
        first, second = self.end_points(row, work)
        return self.link_kinematics(row, first, second).stretch

    @inlined
    def point_acceleration(
        self, k: int, point: DisplacedPoint, work: Vector
    ) -> tuple[float, float]:
        """Return the acceleration of a point of a body, or of the ground."""
        if k == GROUND:
            return 0.0, 0.0
        i, rate = k * BODY_STRIDE, self.poses()[k * POSE_STRIDE + BODY_ROTATION_RATE]
        angular, square = work[i + at.ANGULAR_ACCELERATION], rate * rate
        return (
            work[i + at.ACCELERATION_X] + angular * point.arm_y - square * point.arm_x,
            work[i + at.ACCELERATION_Y] - angular * point.arm_x - square * point.arm_y,
        )

    @inlined
    def link_stretch(self, row: Vector, work: Vector, idle: bool) -> Stretch:
        """Return a link's elongation, rate and, unless idle, acceleration from its bodies'."""
        first, second = self.end_points(row, work)
        stretch, x, y = self.link_kinematics(row, first, second)
        if idle:
            return stretch
        on_x, on_y = self.point_acceleration(int(row[FIRST_BODY]), first, work)
        to_x, to_y = self.point_acceleration(int(row[SECOND_BODY]), second, work)
        speed_x, speed_y = first.speed_x - second.speed_x, first.speed_y - second.speed_y
        across = speed_x * y - speed_y * x
        length = stretch.given + stretch.elongation
        centripetal = across * across / length if length > 0.0 else 0.0
        acceleration = x * (on_x - to_x) + y * (on_y - to_y) + centripetal
        return Stretch(stretch.elongation, stretch.rate, acceleration, stretch.given, stretch.noise)
