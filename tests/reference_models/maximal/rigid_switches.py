"""Impact, rest and start of a block on rigid ground."""

import math

from .compiling import compiled
from .kinematics import is_small, limit_of
from .layout import (
    ECCENTRICITY,
    GRAVITY,
    HALF_HEIGHT,
    HALF_WIDTH,
    HELD,
    HOLD,
    INERTIA,
    LEFT_RESTITUTION,
    LIMIT,
    MASS,
    PLACE,
    POINT,
    RESTING,
    RIGHT_RESTITUTION,
)

LEAST_REBOUND = 1e-10


@compiled
def place_hinged(z, held, p):
    """Place the centre of mass by the hinge; remove drift."""
    h = p[HALF_HEIGHT]
    side = 1.0 if held[POINT] > 0.0 else -1.0
    b = side * held[POINT]
    a, rate = z[5], z[11]
    if is_small(p):
        z[3], z[4] = held[PLACE] + h * a, side * b * a
        z[9], z[10] = h * rate, side * b * rate
        return
    half = math.sin(0.5 * a)
    sine, cosine = math.sin(a), math.cos(a)
    rise = side * b * sine - 2.0 * h * half * half
    z[3] = held[PLACE] + h * sine + 2.0 * side * b * half * half
    z[4] = rise
    z[9] = (h * cosine + side * b * sine) * rate
    z[10] = (side * b * cosine - h * sine) * rate


@compiled
def corner_place(p, side):
    """Return the place of a corner, 1 right and -1 left, from the foot of the centre of mass."""
    return side * p[HALF_WIDTH] - p[ECCENTRICITY]


def _holding(p, side, gx, gy):
    """Return the restoring moment per mass about a corner."""
    b, h = side * corner_place(p, side), p[HALF_HEIGHT]
    if is_small(p):
        lean = (p[GRAVITY] + gy) * limit_of(p, side) + side * gx
        return lean * math.hypot(b, h)
    return (p[GRAVITY] + gy) * b + side * gx * h


def start_rocking(z, gx, contact, held, p):
    """The ground acceleration tips the block about its trailing corner."""
    contact[HOLD] = HELD
    held[POINT] = corner_place(p, 1.0 if gx < 0.0 else -1.0)
    z[5] = z[11] = 0.0
    place_hinged(z, held, p)


def impact(z, gx, gy, contact, held, p):
    """The block changes its corner, or comes to rest."""
    h = p[HALF_HEIGHT]
    side = -1.0 if held[POINT] > 0.0 else 1.0
    held[POINT] = corner_place(p, side)
    b = side * held[POINT]
    z[5] = 0.0
    z[11] *= p[RIGHT_RESTITUTION] if side > 0.0 else p[LEFT_RESTITUTION]
    inertia = p[INERTIA] + p[MASS] * (b * b + h * h)
    back = p[MASS] * _holding(p, side, gx, gy) / inertia
    rests = _holding(p, -side, gx, gy) >= 0.0  # else the next bounce is about the other corner
    if rests and back > 0.0 and 0.5 * z[11] * z[11] / back < LEAST_REBOUND * p[LIMIT]:
        contact[HOLD] = RESTING
        z[11] = 0.0
        z[4] = z[9] = z[10] = 0.0
        return
    place_hinged(z, held, p)
