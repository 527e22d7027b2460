"""Forces on the bodies, constraint multipliers and accelerations."""

import math

import numpy as np

from .bed import resultants
from .compiling import compiled, within
from .kinematics import height, is_small, limit_of, relative, sway
from .layout import (
    BED_LEFT,
    CASCADE,
    DAMPING,
    ECCENTRICITY,
    FREE,
    GRAVITY,
    HALF_HEIGHT,
    HALF_WIDTH,
    HELD,
    HOLD,
    INERTIA,
    KIND,
    LEFT,
    LOWER_ECCENTRICITY,
    LOWER_HALF_WIDTH,
    LOWER_HEIGHT,
    LOWER_HOLD,
    LOWER_INERTIA,
    LOWER_MASS,
    LOWER_POINT,
    MASS,
    PADS,
    POINT,
    RESTING,
    RIGID,
    SETTLEMENT,
    SLIDES,
    STIFFNESS,
    TOP,
    TOUCHING,
)


@compiled
def has_lower(p):
    """Tell whether there is a body on soil."""
    return int(p[KIND]) != PADS and int(p[KIND]) != RIGID


@compiled
def corner(p, rel, i):
    """Return level, lever, its derivative, speed and the pad's force law at corner i (0 left)."""
    side = 1.0 - 2.0 * i
    distance = p[HALF_WIDTH] + side * p[ECCENTRICITY]
    y, lever, bend = height(is_small(p), rel[1], rel[2], distance, p[HALF_HEIGHT], side)
    speed = rel[4] + lever * rel[5]
    return y, lever, bend, speed, p[STIFFNESS] * (p[SETTLEMENT] - y) - p[DAMPING] * speed


@compiled
def end(p, z, i):
    """Return level, lever, its derivative and speed of end i (0 left) of the base on soil."""
    side = 1.0 - 2.0 * i
    distance = p[LOWER_HALF_WIDTH] + side * p[LOWER_ECCENTRICITY]
    w, lever, bend = height(is_small(p), z[1], z[2], distance, p[LOWER_HEIGHT], side)
    return w, lever, bend, z[7] + lever * z[8]


@compiled
def inverse_masses(p, inverse):
    """Fill in the inverse of the diagonal mass matrix."""
    lower = has_lower(p)
    inverse[0] = inverse[1] = 1.0 / p[LOWER_MASS] if lower else 0.0
    inverse[2] = 1.0 / p[LOWER_INERTIA] if lower else 0.0
    inverse[3] = inverse[4] = 1.0 / p[MASS] if p[MASS] > 0.0 else 0.0
    inverse[5] = 1.0 / p[INERTIA] if p[INERTIA] > 0.0 else 0.0


def rooms(p: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return the work arrays of the compiled functions."""
    room = (
        np.zeros(8),
        np.zeros((3, 6)),
        np.zeros(6),
        np.zeros((2, 6)),
        np.zeros((2, 6)),
        np.zeros(6),
    )
    inverse_masses(p, room[2])
    return room


@within
def top_acceleration(p, z, out):
    """Return the acceleration, relative to the ground, of the middle of the lower body's top."""
    far, aside, a, rate = p[TOP], p[LOWER_ECCENTRICITY], z[2], z[8]
    if is_small(p):
        return (
            out[0] + far * out[2],
            out[1] - far * (a * out[2] + rate * rate) + aside * out[2],
        )
    sine, cosine = math.sin(a), math.cos(a)
    # the middle of the top, from the centre of mass: `far` up, `aside` to the left
    return (
        out[0] + far * (cosine * out[2] - sine * rate * rate)
        + aside * (sine * out[2] + cosine * rate * rate),
        out[1] - far * (sine * out[2] + cosine * rate * rate)
        + aside * (cosine * out[2] - sine * rate * rate),
    )  # fmt: skip


@within
def top_velocity(p, z):
    """Return the velocity, relative to the ground, of the middle of the lower body's top."""
    aside = p[LOWER_ECCENTRICITY]
    if is_small(p):
        return z[6] + p[TOP] * z[8], z[7] - p[TOP] * z[2] * z[8] + aside * z[8]
    sine, cosine = math.sin(z[2]), math.cos(z[2])
    return (
        z[6] + p[TOP] * cosine * z[8] + aside * sine * z[8],
        z[7] - p[TOP] * sine * z[8] + aside * cosine * z[8],
    )


@compiled
def accelerate(z, gx, gy, contact, held, p, room, out):
    """Fill `out` with six accelerations, the two constraint forces and their gains.

    A gain is the acceleration that a unit force gives to the constrained point. Force times gain
    says how much a sliding corner would be pressed without the force.

    Each multiplier is a horizontal force at a held point. It keeps the slip's acceleration at
    zero where the point is held; where a corner slides it keeps the force on the corner at zero.
    """
    rel, rows, _, hold, keep, load = room
    small = is_small(p)
    kind = int(p[KIND])
    out[:] = 0.0
    if kind == RIGID:
        _hinged(z, gx, gy, contact, held, p, out)
        return
    down0 = down1 = 0.0  # right-hand sides
    active0 = active1 = False
    load[:] = 0.0
    hold[:] = 0.0
    keep[:] = 0.0
    if has_lower(p):
        load[0] = -p[LOWER_MASS] * gx
        load[1] = -p[LOWER_MASS] * (p[GRAVITY] + gy)
        mode = contact[LOWER_HOLD]
        if mode == HELD:
            force, moment = resultants(contact, z, p)
            load[1] += force
            load[2] += moment
        if mode != FREE:
            _, first, second = sway(small, z[2], p[LOWER_HEIGHT], held[LOWER_POINT])
            hold[0, 0], hold[0, 2] = 1.0, -first
            active0 = True
            if mode == HELD:
                keep[0, 0], keep[0, 2] = 1.0, -first
                down0 = second * z[8] * z[8]
            else:
                i = 0 if contact[BED_LEFT] == SLIDES else 1
                _, lever, bend, _ = end(p, z, i)
                keep[0, 1], keep[0, 2] = 1.0, lever
                down0 = -bend * z[8] * z[8]
    if kind == CASCADE:
        _lower_alone(active0, down0, room, out)
        ax, ay = top_acceleration(p, z, out)
        gx, gy = gx + ax, gy + ay
        active0 = False
    if p[MASS] > 0.0:
        load[3] = -p[MASS] * gx
        load[4] = -p[MASS] * (p[GRAVITY] + gy)
        relative(z, p, rel, rows)
        for i in range(2):
            if contact[LEFT + i] == TOUCHING:
                _, lever, _, _, force = corner(p, rel, i)
                for j in range(6):
                    load[j] += force * (rows[1, j] + lever * rows[2, j])
        if contact[HOLD] != FREE:
            active1 = True
            _, first, second = sway(small, rel[2], p[HALF_HEIGHT], held[POINT])
            for j in range(6):
                hold[1, j] = rows[0, j] - first * rows[2, j]
            if contact[HOLD] == HELD:
                keep[1] = hold[1]
                down1 = second * rel[5] * rel[5] - rel[6]
            else:
                i = 0 if contact[LEFT] == SLIDES else 1
                _, lever, bend, speed, _ = corner(p, rel, i)
                for j in range(6):
                    keep[1, j] = rows[1, j] + lever * rows[2, j]
                sink = p[STIFFNESS] / p[DAMPING] * speed if p[DAMPING] > 0.0 else 0.0
                down1 = -sink - bend * rel[5] * rel[5] - rel[7]
    _solve(active0, active1, down0, down1, kind == CASCADE, room, out)


@within
def _lower_alone(active, wanted, room, out):
    _, _, inverse, hold, keep, load = room
    force = 0.0
    if active:
        matrix, left = 0.0, wanted
        for j in range(3):
            matrix += keep[0, j] * inverse[j] * hold[0, j]
            left -= keep[0, j] * inverse[j] * load[j]
        force = left / matrix
        out[8] = matrix
    for j in range(3):
        out[j] = inverse[j] * (load[j] + hold[0, j] * force)
    out[6] = force


@within
def _solve(active0, active1, wanted0, wanted1, upper_only, room, out):
    _, _, inverse, hold, keep, load = room
    a00 = a01 = a10 = a11 = 0.0
    for j in range(6):
        a00 += keep[0, j] * inverse[j] * hold[0, j]
        a01 += keep[0, j] * inverse[j] * hold[1, j]
        a10 += keep[1, j] * inverse[j] * hold[0, j]
        a11 += keep[1, j] * inverse[j] * hold[1, j]
        wanted0 -= keep[0, j] * inverse[j] * load[j]
        wanted1 -= keep[1, j] * inverse[j] * load[j]
    force0 = force1 = 0.0
    if active0 and active1:
        determinant = a00 * a11 - a01 * a10
        force0 = (wanted0 * a11 - a01 * wanted1) / determinant
        force1 = (a00 * wanted1 - a10 * wanted0) / determinant
        out[8], out[9] = a00 - a01 * a10 / a11, a11 - a01 * a10 / a00
    elif active0:
        force0 = wanted0 / a00
        out[8] = a00
    elif active1:
        force1 = wanted1 / a11
        out[9] = a11
    for j in range(3 if upper_only else 0, 6):
        out[j] = inverse[j] * (load[j] + hold[0, j] * force0 + hold[1, j] * force1)
    if not upper_only:
        out[6] = force0
    out[7] = force1


@within
def _hinged(z, gx, gy, contact, held, p, out):
    if contact[HOLD] == RESTING:
        return
    m, inertia, h = p[MASS], p[INERTIA], p[HALF_HEIGHT]
    side = 1.0 if held[POINT] > 0.0 else -1.0
    b = side * held[POINT]
    if is_small(p):
        theta = limit_of(p, side)
        frequency2 = m * p[GRAVITY] * math.hypot(b, h) / (inertia + m * (b * b + h * h))
        lean = theta * side - z[5]
        out[5] = -frequency2 * ((1.0 + gy / p[GRAVITY]) * lean + gx / p[GRAVITY])
        out[3], out[4] = h * out[5], side * b * out[5]
        return
    _, first, second = sway(False, z[5], h, held[POINT])
    _, lever, bend = height(False, z[4], z[5], b, h, -side)
    # two rows of constraints: the hinge moves neither across nor up
    rate2 = z[11] * z[11]
    across = second * rate2 + gx
    up = -bend * rate2 + p[GRAVITY] + gy
    a00, a01, a11 = 1.0 / m + first * first / inertia, -first * lever / inertia, 0.0
    a11 = 1.0 / m + lever * lever / inertia
    determinant = a00 * a11 - a01 * a01
    force = (across * a11 - a01 * up) / determinant
    reaction = (a00 * up - a01 * across) / determinant
    out[3] = -gx + force / m
    out[4] = -p[GRAVITY] - gy + reaction / m
    out[5] = (-first * force + lever * reaction) / inertia
    out[6], out[7] = reaction, force
