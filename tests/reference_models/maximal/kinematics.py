"""Positions of points of a base, and coordinates of a block relative to its cap."""

import math

from .compiling import compiled
from .layout import (
    COUPLED,
    ECCENTRICITY,
    HALF_HEIGHT,
    KIND,
    LEFT_LIMIT,
    RIGHT_LIMIT,
    SMALL,
    TOP,
)


@compiled
def height(small, r, angle, distance, level, side):
    """Return the height of a point of the base and its first two derivatives by the angle.

    Parameters
    ----------
    small : bool
        Small rotation.
    r, angle : float
        Displacement of the centre of mass along the normal of the ground under it, and rotation.
    distance, level, side : float
        Distance of the point from the foot of the centre of mass, and the height of that above the
        base; 1 for a point on the left, -1 on the right.
    """
    if small:
        return (
            r + 0.5 * level * angle * angle + side * distance * angle,
            level * angle + side * distance,
            level,
        )
    sine, cosine = math.sin(angle), math.cos(angle)
    half = math.sin(0.5 * angle)
    return (
        r + 2.0 * level * half * half + side * distance * sine,
        level * sine + side * distance * cosine,
        level * cosine - side * distance * sine,
    )


@compiled
def sway(small, angle, level, point):
    """Return x of the centre of mass over the held point and its two derivatives by the angle.

    `point` is the place of the held point along the base, from the foot of the centre of mass.
    """
    if small:
        return level * angle, level, 0.0
    sine, cosine = math.sin(angle), math.cos(angle)
    return (
        level * sine - point * cosine,
        level * cosine + point * sine,
        point * cosine - level * sine,
    )


@compiled
def relative(z, p, rel, rows):
    """Find position and velocity of the block relative to its base.

    Parameters
    ----------
    z : ndarray
        State.
    p : ndarray
        Parameters.
    rel : ndarray, shape (8,)
        Filled with the coordinates along the base, along its normal and the rotation, their
        rates, and the velocity-dependent parts of the first two accelerations. The first
        is measured from the middle of the cap.
    rows : ndarray, shape (3, 6)
        Filled with the derivatives of these coordinates by those of both bodies.
    """
    rows[:] = 0.0
    rows[0, 3] = rows[1, 4] = rows[2, 5] = 1.0
    rel[0], rel[1], rel[2] = p[ECCENTRICITY] + z[3], z[4], z[5]
    rel[3], rel[4], rel[5] = z[9], z[10], z[11]
    rel[6] = rel[7] = 0.0
    if int(p[KIND]) != COUPLED:
        return
    sine, cosine = math.sin(z[2]), math.cos(z[2])
    half = math.sin(0.5 * z[2])
    apart = p[TOP] + p[HALF_HEIGHT]
    dx, dy = p[ECCENTRICITY] + (z[3] - z[0]), z[4] - z[1]
    vx, vy, turn = z[9] - z[6], z[10] - z[7], z[8]
    along = cosine * dx - sine * (dy + apart)
    rise = sine * dx + cosine * dy - 2.0 * apart * half * half
    far = rise + apart
    rel[0], rel[1], rel[2] = along, rise, z[5] - z[2]
    rel[3] = cosine * vx - sine * vy - turn * far
    rel[4] = sine * vx + cosine * vy + turn * along
    rel[5] = z[11] - z[8]
    rel[6] = -2.0 * turn * rel[4] + turn * turn * along
    rel[7] = 2.0 * turn * rel[3] + turn * turn * far
    rows[0, 0], rows[0, 1], rows[0, 2] = -cosine, sine, -far
    rows[0, 3], rows[0, 4] = cosine, -sine
    rows[1, 0], rows[1, 1], rows[1, 2] = -sine, -cosine, along
    rows[1, 3], rows[1, 4] = sine, cosine
    rows[2, 2] = -1.0


@compiled
def is_small(p):
    """Tell whether the kinematics are those of small rotation."""
    return p[SMALL] > 0.5


@compiled
def limit_of(p, rotation):
    """Return the overturning angle to the side of a rotation."""
    return p[LEFT_LIMIT] if rotation < 0.0 else p[RIGHT_LIMIT]
