"""Impulses: jumps of velocity when a point becomes held or a corner lands."""

import numpy as np

from .compiling import compiled, within
from .forces import corner, has_lower, top_velocity
from .kinematics import is_small, relative, sway
from .layout import (
    CASCADE,
    COUPLED,
    HALF_HEIGHT,
    HELD,
    HOLD,
    KIND,
    LEFT_RESTITUTION,
    LOWER_HEIGHT,
    LOWER_HOLD,
    LOWER_PLACE,
    LOWER_POINT,
    MASS,
    PLACE,
    POINT,
)


@within
def solve_dense(matrix, right, n):
    """Solve a small dense system in place; `right` becomes the solution."""
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        for j in range(n):
            matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
        right[k], right[best] = right[best], right[k]
        for i in range(k + 1, n):
            factor = matrix[i, k] / matrix[k, k]
            for j in range(k, n):
                matrix[i, j] -= factor * matrix[k, j]
            right[i] -= factor * right[k]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            right[k] -= matrix[k, j] * right[j]
        right[k] /= matrix[k, k]


@compiled
def jump(z, contact, held, p, room, left_lands, right_lands):
    """Change the velocities by the impulses of all holds and of the corners that land.

    Every held point is brought to rest; a landing corner keeps a share of its speed. Impulses
    act on all bodies that are joined.
    """
    rel, rows, inverse = room[0], room[1], room[2]
    apply = np.zeros((4, 6))
    wanted = np.zeros(4)
    n = 0
    small = is_small(p)
    if has_lower(p) and contact[LOWER_HOLD] == HELD:
        _, first, _ = sway(small, z[2], p[LOWER_HEIGHT], held[LOWER_POINT])
        apply[n, 0], apply[n, 2] = 1.0, -first
        n += 1
    if p[MASS] > 0.0:
        relative(z, p, rel, rows)
        if contact[HOLD] == HELD:
            _, first, _ = sway(small, rel[2], p[HALF_HEIGHT], held[POINT])
            for j in range(6):
                apply[n, j] = rows[0, j] - first * rows[2, j]
            n += 1
        for i in range(2):
            if (i == 0 and left_lands) or (i == 1 and right_lands):
                _, lever, _, speed, _ = corner(p, rel, i)
                for j in range(6):
                    apply[n, j] = rows[1, j] + lever * rows[2, j]
                wanted[n] = p[LEFT_RESTITUTION + i] * speed
                n += 1
    matrix = np.zeros((4, 4))
    for i in range(n):
        for j in range(n):
            for k in range(6):
                matrix[i, j] += apply[i, k] * inverse[k] * apply[j, k]
        for k in range(6):
            wanted[i] -= apply[i, k] * z[6 + k]
    solve_dense(matrix, wanted, n)
    for i in range(n):
        for k in range(6):
            z[6 + k] += inverse[k] * apply[i, k] * wanted[i]


@compiled
def carry_over(z, before, contact, held, p, room):
    """Add the velocity jump of the first stage's top to the second stage of a cascade."""
    if int(p[KIND]) != CASCADE:
        return
    vx, vy = top_velocity(p, z)
    ux, uy = top_velocity(p, before)
    z[9] -= vx - ux
    z[10] -= vy - uy
    jump(z, contact, held, p, room, False, False)


@compiled
def slip(z, held, p, room):
    """Return the speed of the block's held point along its base."""
    rel, rows = room[0], room[1]
    relative(z, p, rel, rows)
    _, first, _ = sway(is_small(p), rel[2], p[HALF_HEIGHT], held[POINT])
    return rel[3] - first * rel[5]


@compiled
def lower_slip(z, held, p):
    """Return the horizontal speed of the held point of the body on soil."""
    _, first, _ = sway(is_small(p), z[2], p[LOWER_HEIGHT], held[LOWER_POINT])
    return z[6] - first * z[8]


@compiled
def note_places(z, held, p, room):
    """Store the positions of the held points, for the correction of drift."""
    rel, rows = room[0], room[1]
    small = is_small(p)
    held[LOWER_PLACE] = z[0] - sway(small, z[2], p[LOWER_HEIGHT], held[LOWER_POINT])[0]
    relative(z, p, rel, rows)
    held[PLACE] = rel[0] - sway(small, rel[2], p[HALF_HEIGHT], held[POINT])[0]


@compiled
def tidy(z, contact, held, p, room):
    """Remove the drift of held points from positions and speeds."""
    rel, rows = room[0], room[1]
    small = is_small(p)
    coupled = int(p[KIND]) == COUPLED
    if has_lower(p) and contact[LOWER_HOLD] == HELD:
        place = sway(small, z[2], p[LOWER_HEIGHT], held[LOWER_POINT])[0]
        off = held[LOWER_PLACE] + place - z[0]
        z[0] += off
        if coupled:
            z[3] += off
    if p[MASS] > 0.0 and contact[HOLD] == HELD:
        relative(z, p, rel, rows)
        off = held[PLACE] + sway(small, rel[2], p[HALF_HEIGHT], held[POINT])[0] - rel[0]
        z[3] += rows[0, 3] * off
        z[4] += rows[0, 4] * off
    jump(z, contact, held, p, room, False, False)
