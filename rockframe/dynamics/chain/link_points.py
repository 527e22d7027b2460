"""Positions and velocities of the ends of links, and the elongations, :eq:`eq-link`."""

import math
from typing import Final, NamedTuple

from rockframe.compiled import Vector, inlined
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.link_rows import (
    ALONG_X,
    ALONG_Y,
    APART_X,
    APART_Y,
    GIVEN,
    GROUND,
    LIES,
    MOVED_X,
    MOVED_Y,
    NOISE,
    ON,
    ON_X,
    ON_Y,
    OWN_RATE,
    OWN_SINE,
    OWN_VERSINE,
    TO,
    TO_X,
    TO_Y,
    LinkRows,
)
from rockframe.dynamics.chain.rows import PLACES
from rockframe.dynamics.links import Stretch

MEET: Final = 1e3
"""Points of a link meet within this many times the rounding noise of its elongation."""
TINY: Final = 1e-280
"""Square of a speed below which it counts as zero [m^2 s^-2]."""


class Moved(NamedTuple):
    """Displacement of a point of a body [m], its lever arm [m], and its velocity [m s^-1]."""

    x: float
    y: float
    arm_x: float  # from the centre of mass of its body
    arm_y: float
    speed_x: float
    speed_y: float


class StretchedLink(NamedTuple):
    """Elongation of a link and its rate; unit vector from its second point to its first."""

    stretch: Stretch
    x: float
    y: float


class LinkPoints(LinkRows):
    """Kinematics of the points of links. A mixin of systems."""

    __slots__ = ()

    @inlined
    def moved(self, k: int, x: float, y: float, room: Vector) -> Moved:
        """Return displacement and velocity of a point of a body, or of the ground."""
        if k == GROUND:
            return Moved(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        lies, i, j = self.lies(), k * PLACES, k * LIES
        sine, lacks, rate = lies[j + OWN_SINE], lies[j + OWN_VERSINE], lies[j + OWN_RATE]
        turned_x, turned_y = y * sine - x * lacks, -x * sine - y * lacks
        arm_x, arm_y = x + turned_x, y + turned_y
        return Moved(
            lies[j + MOVED_X] + turned_x, lies[j + MOVED_Y] + turned_y, arm_x, arm_y,
            room[i + at.SPEED_X] + rate * arm_y, room[i + at.SPEED_Y] - rate * arm_x,
        )  # fmt: skip

    @inlined
    def upward(self, k: int) -> tuple[float, float]:
        """Return the unit vector that points up on a body, or on the ground."""
        if k == GROUND:
            return 0.0, 1.0
        lies = self.lies()
        return lies[k * LIES + OWN_SINE], 1.0 - lies[k * LIES + OWN_VERSINE]

    @inlined
    def points_of(self, row: Vector, room: Vector) -> tuple[Moved, Moved]:
        """Return displacements and velocities of both points of a link."""
        on = self.moved(int(row[ON]), row[ON_X], row[ON_Y], room)
        return on, self.moved(int(row[TO]), row[TO_X], row[TO_Y], room)

    @inlined
    def drawn(self, row: Vector, on: Moved, to: Moved) -> StretchedLink:
        """Return elongation, rate and direction of a link, :eq:`eq-link`, but no acceleration.

        Where its points meet it acts along their relative velocity, in its upward sense.
        """
        apart_x, apart_y, first_length = row[APART_X], row[APART_Y], row[GIVEN]
        moved_x, moved_y = on.x - to.x, on.y - to.y
        x, y = apart_x + moved_x, apart_y + moved_y
        speed_x, speed_y = on.speed_x - to.speed_x, on.speed_y - to.speed_y
        along_x, along_y = row[ALONG_X], row[ALONG_Y]
        if along_x != 0.0 or along_y != 0.0:
            elongation = along_x * moved_x + along_y * moved_y
            rate = along_x * speed_x + along_y * speed_y
            return StretchedLink(
                Stretch(elongation, rate, 0.0, first_length, row[NOISE]), along_x, along_y
            )
        square = x * x + y * y
        length, elongation = math.sqrt(square), 0.0
        if length + first_length > 0.0:
            elongation = (2.0 * apart_x * moved_x + moved_x * moved_x) / (length + first_length)
            elongation += (2.0 * apart_y * moved_y + moved_y * moved_y) / (length + first_length)
        if length <= MEET * row[NOISE]:
            up_x, up_y = self.upward(int(row[TO]))
            away = 1.0 if speed_x * up_x + speed_y * up_y >= 0.0 else -1.0
            x, y = away * speed_x, away * speed_y
            square = x * x + y * y
            length = math.sqrt(square)
            if square < TINY:
                still = Stretch(elongation, 0.0, 0.0, first_length, row[NOISE])
                return StretchedLink(still, up_x, up_y)
        x, y = x / length, y / length
        rate = x * speed_x + y * speed_y
        return StretchedLink(Stretch(elongation, rate, 0.0, first_length, row[NOISE]), x, y)

    @inlined
    def accelerated_point(self, k: int, point: Moved, room: Vector) -> tuple[float, float]:
        """Return the acceleration of a point of a body, or of the ground."""
        if k == GROUND:
            return 0.0, 0.0
        i, rate = k * PLACES, self.lies()[k * LIES + OWN_RATE]
        turning, square = room[i + at.ROTATION], rate * rate
        return (
            room[i + at.X] + turning * point.arm_y - square * point.arm_x,
            room[i + at.Y] - turning * point.arm_x - square * point.arm_y,
        )

    @inlined
    def watched(self, row: Vector, room: Vector, idle: bool) -> Stretch:
        """Return elongation of a link, rate and acceleration, from the accelerations of its bodies.

        The acceleration of an idle link is left 0.
        """
        on, to = self.points_of(row, room)
        found, x, y = self.drawn(row, on, to)
        if idle:
            return found
        on_x, on_y = self.accelerated_point(int(row[ON]), on, room)
        to_x, to_y = self.accelerated_point(int(row[TO]), to, room)
        speed_x, speed_y = on.speed_x - to.speed_x, on.speed_y - to.speed_y
        across = speed_x * y - speed_y * x
        length = found.given + found.elongation
        bend = across * across / length if length > 0.0 else 0.0
        acceleration = x * (on_x - to_x) + y * (on_y - to_y) + bend
        return Stretch(found.elongation, found.rate, acceleration, found.given, found.noise)
