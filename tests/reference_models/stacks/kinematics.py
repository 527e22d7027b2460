"""Position of a body relative to its support, and positions of points of its base."""

import math

from reference_models.maximal.compiling import compiled


@compiled
def relative(k, z, stack, room):
    """Find position and velocity of body k relative to its support.

    `room.rel[k]` is filled with the coordinates of its centre of mass along the base, along its
    normal from the position of rest, and the rotation, their rates, and the velocity-dependent
    parts of the first two accelerations; `room.rows[k]` with the derivatives of these coordinates
    by those of body k and of its support. The first coordinate is measured from the centre of mass
    of the support.
    """
    rel, rows = room.rel[k], room.rows[k]
    i, count = 3 * k, stack.inverse.size
    tilt = z[i + 5]
    sine, cosine, half = math.sin(tilt), math.cos(tilt), math.sin(0.5 * tilt)
    dx, dy, apart = stack.across[k] + (z[i] - z[i + 3]), z[i + 1] - z[i + 4], stack.apart[k]
    r = count + i
    vx, vy, turn = z[r] - z[r + 3], z[r + 1] - z[r + 4], z[r + 5]
    along = cosine * dx - sine * (dy + apart)
    rise = sine * dx + cosine * dy - 2.0 * apart * half * half
    far = rise + apart
    rel[0], rel[1], rel[2] = along, rise, z[i + 2] - tilt
    rel[3] = cosine * vx - sine * vy - turn * far
    rel[4] = sine * vx + cosine * vy + turn * along
    rel[5] = z[r + 2] - turn
    rel[6] = turn * (turn * along - 2.0 * rel[4])
    rel[7] = turn * (turn * far + 2.0 * rel[3])
    rows[:] = 0.0
    rows[0, 0], rows[0, 1] = cosine, -sine
    rows[0, 3], rows[0, 4], rows[0, 5] = -cosine, sine, -far
    rows[1, 0], rows[1, 1] = sine, cosine
    rows[1, 3], rows[1, 4], rows[1, 5] = -sine, -cosine, along
    rows[2, 2], rows[2, 5] = 1.0, -1.0


@compiled
def end(k, i, stack, room):
    """Return level, lever, its derivative by rotation, and speed of end i (0 left) of a base."""
    rel, level = room.rel[k], stack.height[k]
    sine, cosine, half = math.sin(rel[2]), math.cos(rel[2]), math.sin(0.5 * rel[2])
    # from the foot of the centre of mass to the left
    left = stack.eccentricity[k] + (1.0 - 2.0 * i) * stack.half_width[k]
    lever = level * sine + left * cosine
    rise = rel[1] + 2.0 * level * half * half + left * sine
    return rise, lever, level * cosine - left * sine, rel[4] + lever * rel[5]


@compiled
def sway(k, point, stack, room):
    """Return x of the centre of mass over a point of the base, and two derivatives by rotation."""
    level, angle = stack.height[k], room.rel[k, 2]
    sine, cosine = math.sin(angle), math.cos(angle)
    return (
        level * sine - point * cosine,
        level * cosine + point * sine,
        point * cosine - level * sine,
    )


@compiled
def size_of(k, stack):
    """Return a characteristic length of a body."""
    return stack.half_width[k] + stack.height[k]
