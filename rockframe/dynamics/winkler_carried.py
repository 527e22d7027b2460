"""Motion of a point of a body on a bed: the ground of what stands on it."""

from typing import NamedTuple

from rockframe.compiled import Vector, inlined
from rockframe.dynamics.kinematics import pinned_point, reach_and_bend, sine_cosine_rise
from rockframe.dynamics.single_body import (
    COORDINATES,
    FREE,
    HALF_HEIGHT,
    HALF_WIDTH,
    ROTATION,
    SMALL,
    VERTICAL,
    horizontal_velocity,
)
from rockframe.dynamics.winkler import pivot_in


class PointMotion(NamedTuple):
    """Velocity and acceleration of a point, relative to the ground."""

    velocity_x: float
    velocity_y: float
    acceleration_x: float
    acceleration_y: float


@inlined
def carried_point(
    mode: int, state: Vector, turn: float, lift: float, sideways: float, p: Vector, top: float
) -> PointMotion:
    """Give the motion of a point on the body's axis, `top` above its centre of mass.

    `turn`, `lift` and `sideways` are the accelerations of the body's coordinates,
    :eq:`eq-carried`.
    """
    pivot = pivot_in(mode)
    sine, cosine, _ = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    spin = state[COORDINATES + ROTATION]
    if pivot != FREE:
        pin = pinned_point(pivot, p[HALF_WIDTH])
        reach, bend = reach_and_bend(p[HALF_HEIGHT], p[SMALL], pin, sine, cosine)
        sideways = reach * turn + bend * spin * spin
    arch = 0.0 if p[SMALL] != 0.0 else sine
    return PointMotion(
        horizontal_velocity(pivot, state, p, sine, cosine) + top * cosine * spin,
        state[COORDINATES + VERTICAL] - top * sine * spin,
        sideways + top * (cosine * turn - arch * spin * spin),
        lift - top * (sine * turn + cosine * spin * spin),
    )
