"""Forces on the bodies, constraint multipliers and accelerations."""

import math

import numpy as np
from reference_models.maximal.compiling import compiled, within
from reference_models.maximal.impulses import solve_dense

from .contact import FREE, HELD, SLIDES, SLIDING, TOUCHING
from .kinematics import end, relative, sway


@compiled
def pad_force(k, i, stack, room):
    """Return the force law of the pad under end i."""
    level, _, _, speed = end(k, i, stack, room)
    return stack.stiffness[k] * (stack.settlement[k] - level) - stack.damping[k] * speed


@within
def mean_product(f0, f1, g0, g1):
    """Return the mean of the product of two linear functions from their values at both ends."""
    return (f0 * g0 + f1 * g1) / 3.0 + (f0 * g1 + f1 * g0) / 6.0


@within
def bed(k, stack, ends, room):
    """Return force, generalised force on the rotation, power of dashpots and energy of a bed."""
    w0, l0, _, v0 = end(k, 0, stack, room)
    w1, l1, _, v1 = end(k, 1, stack, room)
    u0, u1 = stack.settlement[k] - w0, stack.settlement[k] - w1
    left, right = ends[k, 0] == TOUCHING, ends[k, 1] == TOUCHING
    first, last = 0.0, 1.0
    if not (left or right):
        return 0.0, 0.0, 0.0, 0.0
    if not left:
        first = u0 / (u0 - u1) if u1 > u0 else 1.0
    if not right:
        last = u0 / (u0 - u1) if u0 > u1 else 0.0
    length = 2.0 * stack.half_width[k] * (last - first)
    ua, ub = u0 + first * (u1 - u0), u0 + last * (u1 - u0)
    va, vb = v0 + first * (v1 - v0), v0 + last * (v1 - v0)
    la, lb = l0 + first * (l1 - l0), l0 + last * (l1 - l0)
    stiffness, damping = stack.stiffness[k], stack.damping[k]
    pa, pb = stiffness * ua - damping * va, stiffness * ub - damping * vb
    return (
        0.5 * length * (pa + pb),
        length * mean_product(pa, pb, la, lb),
        damping * length * mean_product(va, vb, va, vb),
        0.5 * stiffness * length * mean_product(ua, ub, ua, ub),
    )


@compiled
def base_force(k, stack, ends, room):
    """Return force and generalised force of a base, the power it loses and the energy it stores."""
    if stack.is_bed[k]:
        return bed(k, stack, ends, room)
    force = moment = power = energy = 0.0
    for i in range(2):
        level, lever, _, speed = end(k, i, stack, room)
        pressed = stack.settlement[k] - level
        if ends[k, i] == TOUCHING:
            push = stack.stiffness[k] * pressed - stack.damping[k] * speed
            force += push
            moment += push * lever
            power += stack.damping[k] * speed * speed
        elif pressed > 0.0:  # the free spring moves its own dashpot
            power += stack.stiffness[k] * pressed * speed
        if pressed > 0.0:
            energy += 0.5 * stack.stiffness[k] * pressed * pressed
    return force, moment, power, energy


@compiled
def yielding_rate(k, stack):
    """Return k/c, the rate at which an unloaded pad returns; 0 without a dashpot and on a bed."""
    if stack.is_bed[k] or stack.damping[k] == 0.0:
        return 0.0
    return stack.stiffness[k] / stack.damping[k]


@within
def hold_row(k, contact, stack, room, row):
    """Fill in the derivatives of the slip of the held point."""
    _, first, _ = sway(k, contact.point[k], stack, room)
    for j in range(6):
        row[j] = room.rows[k, 0, j] - first * room.rows[k, 2, j]


@within
def end_row(k, lever, room, row):
    """Fill in the derivatives of the level of an end with a lever."""
    for j in range(6):
        row[j] = room.rows[k, 1, j] + lever * room.rows[k, 2, j]


@within
def product(one, i, other, j, inverse):
    """Return the product of the rows of bodies i and j, weighted by inverse masses."""
    total = 0.0
    low, high = 3 * max(i, j), 3 * min(i, j) + 6
    for g in range(low, high):
        total += one[g - 3 * i] * inverse[g] * other[g - 3 * j]
    return total


@compiled
def stretched(which, z, stack, arms):
    """Return the vector between a tie's points, its rate, and its length at rest; fill `arms`."""
    count, row = stack.inverse.size, stack.ties[which]
    dx, dy, vx, vy = row[6], row[7], 0.0, 0.0
    rest_length = math.sqrt(dx * dx + dy * dy)
    for side in range(2):
        k, sign = int(row[3 * side]), 1.0 - 2.0 * side
        if k < 0:
            continue
        sine, cosine, r = math.sin(z[3 * k + 2]), math.cos(z[3 * k + 2]), count + 3 * k
        x, y = row[3 * side + 1], row[3 * side + 2]
        arms[side, 0], arms[side, 1] = x * cosine + y * sine, y * cosine - x * sine
        dx += sign * (z[3 * k] + arms[side, 0] - x)
        dy += sign * (z[3 * k + 1] + arms[side, 1] - y)
        vx += sign * (z[r] + z[r + 2] * arms[side, 1])
        vy += sign * (z[r + 1] - z[r + 2] * arms[side, 0])
    return dx, dy, vx, vy, rest_length


@within
def pull_ties(z, stack, load):
    """Add the forces of ties to `load`; return the power of their dashpots."""
    lost = 0.0
    for which in range(stack.ties.shape[0]):
        row, arms = stack.ties[which], np.zeros((2, 2))
        dx, dy, vx, vy, rest_length = stretched(which, z, stack, arms)
        length = math.sqrt(dx * dx + dy * dy)
        rate, slack = (dx * vx + dy * vy) / length, row[10]
        force = row[9] * rate
        if slack < 0.0:
            force += row[8] * (length - rest_length)
        elif length - rest_length > slack:
            force += row[8] * (length - rest_length - slack)
        lost += row[9] * rate * rate
        for side in range(2):
            k, sign = int(row[3 * side]), 2.0 * side - 1.0
            if k >= 0:
                fx, fy = sign * force * dx / length, sign * force * dy / length
                load[3 * k] += fx
                load[3 * k + 1] += fy
                load[3 * k + 2] += fx * arms[side, 1] - fy * arms[side, 0]
    return lost


@compiled
def accelerate(z, gx, gy, stack, contact, room):
    """Fill `room` with the accelerations, the constraint forces and their gains.

    Each multiplier is a force at a held point along what carries the body. It keeps the slip's
    acceleration at zero where the point is held, and a sliding end on the level of its
    relaxing pad.
    """
    n, load, inverse = stack.mass.size, room.load, stack.inverse
    load[:] = 0.0
    for k in range(n):
        load[3 * k] = -stack.mass[k] * gx
        load[3 * k + 1] = -stack.mass[k] * (stack.gravity + gy)
    for k in range(n):
        relative(k, z, stack, room)
        force, moment, _, _ = base_force(k, stack, contact.ends, room)
        for j in range(6):
            load[3 * k + j] += force * room.rows[k, 1, j] + moment * room.rows[k, 2, j]
    pull_ties(z, stack, load)
    slides = False
    matrix, right = room.matrix, room.right
    for k in range(n):
        right[k] = 0.0
        room.across[k] = 0.0
        room.keep[k] = 0.0
        room.gain[k] = 0.0
        rel = room.rel[k]
        if contact.hold[k] == FREE:
            continue
        hold_row(k, contact, stack, room, room.across[k])
        if contact.hold[k] == HELD:
            room.keep[k] = room.across[k]
            _, _, second = sway(k, contact.point[k], stack, room)
            right[k] = second * rel[5] * rel[5] - rel[6]
        else:
            slides = True
            i = 0 if contact.ends[k, 0] == SLIDES else 1
            _, lever, bend, speed = end(k, i, stack, room)
            end_row(k, lever, room, room.keep[k])
            right[k] = -yielding_rate(k, stack) * speed - bend * rel[5] * rel[5] - rel[7]
        for j in range(6):
            right[k] -= room.keep[k, j] * inverse[3 * k + j] * load[3 * k + j]
    _fill(stack, contact, room)
    if slides:
        _find_gains(stack, contact, room)
    solve_dense(matrix, right, n)
    for k in range(n):
        room.force[k] = right[k]
        for j in range(6):
            load[3 * k + j] += room.across[k, j] * right[k]
    for j in range(inverse.size):
        room.out[j] = inverse[j] * load[j]


@within
def _fill(stack, contact, room):
    n = stack.mass.size
    for i in range(n):
        for j in range(n):
            room.matrix[i, j] = 0.0
            if abs(i - j) <= 1:
                room.matrix[i, j] = product(room.keep[i], i, room.across[j], j, stack.inverse)
        if contact.hold[i] == FREE:
            room.matrix[i, i] = 1.0


@within
def _find_gains(stack, contact, room):
    """Find the effect of a unit constraint force on a sliding end under all other constraints."""
    n = stack.mass.size
    for k in range(n):
        if contact.hold[k] == SLIDING:
            unit = room.right * 0.0
            unit[k] = 1.0
            solve_dense(room.matrix.copy(), unit, n)
            room.gain[k] = 1.0 / unit[k]


@within
def powers(z, gx, gy, stack, contact, room):
    """Return dissipated power and power of the ground, after `accelerate` for the state."""
    count = stack.inverse.size
    supplied, lost = 0.0, pull_ties(z, stack, room.load * 0.0)
    for k in range(stack.mass.size):
        lost += base_force(k, stack, contact.ends, room)[2]
        if contact.hold[k] == SLIDING:
            _, first, _ = sway(k, contact.point[k], stack, room)
            lost -= room.force[k] * (room.rel[k, 3] - first * room.rel[k, 5])
        r = count + 3 * k
        supplied -= stack.mass[k] * (gx * z[r] + gy * z[r + 1])
    return lost, supplied
