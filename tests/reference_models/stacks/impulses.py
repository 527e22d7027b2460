"""Impulses: jumps of velocity when a point becomes held or an end lands on its pad."""

import numpy as np
from reference_models.maximal.compiling import compiled
from reference_models.maximal.impulses import solve_dense

from .contact import HELD
from .forces import end_row, hold_row, product
from .kinematics import end, relative, sway


@compiled
def relate(z, stack, room):
    """Find positions and velocities of all bodies relative to their supports."""
    for k in range(stack.mass.size):
        relative(k, z, stack, room)


@compiled
def slip(k, stack, contact, room):
    """Return the speed of the held point of a body along its base."""
    _, first, _ = sway(k, contact.point[k], stack, room)
    return room.rel[k, 3] - first * room.rel[k, 5]


@compiled
def jump(z, stack, contact, room, struck, left, right):
    """Change the velocities by impulses of all holds and of the landing ends of one body.

    Every held point is brought to rest on its support; a landing end of the body `struck`
    keeps a share of its speed. Impulses act on all bodies that are joined.
    """
    n, count, inverse = stack.mass.size, stack.inverse.size, stack.inverse
    relate(z, stack, room)
    rows, of, wanted = np.zeros((n + 2, 6)), np.zeros(n + 2, dtype=np.int64), room.right
    m = 0
    for k in range(n):
        if contact.hold[k] == HELD:
            hold_row(k, contact, stack, room, rows[m])
            of[m], wanted[m] = k, 0.0
            m += 1
    for i in range(2):
        if (i == 0 and left) or (i == 1 and right):
            _, lever, _, speed = end(struck, i, stack, room)
            end_row(struck, lever, room, rows[m])
            of[m], wanted[m] = struck, stack.restitution[struck, i] * speed
            m += 1
    for i in range(m):
        for j in range(m):
            room.matrix[i, j] = product(rows[i], of[i], rows[j], of[j], inverse)
        for j in range(6):
            wanted[i] -= rows[i, j] * z[count + 3 * of[i] + j]
    solve_dense(room.matrix, wanted, m)
    for i in range(m):
        for j in range(6):
            g = 3 * of[i] + j
            z[count + g] += inverse[g] * rows[i, j] * wanted[i]
    relate(z, stack, room)


@compiled
def project(z, stack, contact, room):
    """Bring all held points to rest on their supports."""
    jump(z, stack, contact, room, 0, False, False)


@compiled
def note_places(z, stack, contact, room):
    """Store the positions of the held points, for the correction of drift."""
    relate(z, stack, room)
    for k in range(stack.mass.size):
        contact.place[k] = room.rel[k, 0] - sway(k, contact.point[k], stack, room)[0]


@compiled
def tidy(z, stack, contact, room):
    """Remove the drift of held points from positions and speeds."""
    for k in range(stack.mass.size - 1, -1, -1):
        if contact.hold[k] == HELD:
            relative(k, z, stack, room)
            place = contact.place[k] + sway(k, contact.point[k], stack, room)[0]
            off = place - room.rel[k, 0]
            # along the support, together with all bodies above
            dx, dy = room.rows[k, 0, 0] * off, room.rows[k, 0, 1] * off
            for j in range(k + 1):
                z[3 * j] += dx
                z[3 * j + 1] += dy
    project(z, stack, contact, room)


@compiled
def kinetic(z, stack):
    """Return the kinetic energy relative to the ground."""
    count, energy = stack.inverse.size, 0.0
    for j in range(count - 3):
        energy += 0.5 * z[count + j] * z[count + j] / stack.inverse[j]
    return energy
