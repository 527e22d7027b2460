"""Motion of a point of a body on a bed: the ground of what stands on it."""

from rockframe.compiled import Vector, kernel
from rockframe.dynamics.kinematics import pinned_point, reach_and_bend, sine_cosine_rise
from rockframe.dynamics.single_body import (
    COORDINATES,
    FREE,
    HALF_HEIGHT,
    HALF_WIDTH,
    HORIZONTAL,
    ROTATION,
    SMALL,
    VERTICAL,
    horizontal_velocity,
)
from rockframe.dynamics.winkler import pivot_in


@kernel
def carried_point(mode: int, state: Vector, p: Vector, top: float, out: Vector) -> None:
    """Turn accelerations into the motion of a point, relative to the ground.

    The point lies on the body's axis, `top` above its centre of mass. `out` holds the
    accelerations of the coordinates; it is overwritten with the point's horizontal and
    vertical velocity, then its accelerations, :eq:`eq-carried`.
    """
    pivot = pivot_in(mode)
    sine, cosine, _ = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    spin = state[COORDINATES + ROTATION]
    turn = out[ROTATION]
    lift = out[VERTICAL]
    sideways = out[HORIZONTAL]
    if pivot != FREE:
        pin = pinned_point(pivot, p[HALF_WIDTH])
        reach, bend = reach_and_bend(p[HALF_HEIGHT], p[SMALL], pin, sine, cosine)
        sideways = reach * turn + bend * spin * spin
    arch = 0.0 if p[SMALL] != 0.0 else sine
    out[0] = horizontal_velocity(pivot, state, p, sine, cosine) + top * cosine * spin
    out[1] = state[COORDINATES + VERTICAL] - top * sine * spin
    out[2] = sideways + top * (cosine * turn - arch * spin * spin)
    out[3] = lift - top * (sine * turn + cosine * spin * spin)
