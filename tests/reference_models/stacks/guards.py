"""Guard functions, positive as long as the contact state lasts."""

import math

import numpy as np
from reference_models.maximal.compiling import compiled, within

from .contact import (
    BASE_GUARDS,
    CLEAR,
    END_GUARDS,
    ENGAGING,
    FREE,
    LEAD_GUARD,
    LEAST_LEVER,
    LEAVING,
    RELAXING,
    SLIDES,
    SLIDING,
    TOUCHING,
)
from .forces import accelerate, pad_force, stretched
from .impulses import relate, slip
from .kinematics import end, size_of, sway
from .scene import LEADING_CORNER

QUIET = 1e-11
"""Speed of an end, relative to a typical one, that counts as rounding."""


@within
def evaluate(z, gx, gy, stack, contact, room, guards):
    """Fill in the guards."""
    n = stack.mass.size
    guards[:] = 1.0
    slides = False
    for k in range(n):
        slides = slides or contact.hold[k] == SLIDING
    if slides:
        accelerate(z, gx, gy, stack, contact, room)
    else:
        relate(z, stack, room)
    nearest = 1.0
    for k in range(n):
        angle = z[3 * k + 2]
        nearest = min(nearest, 1.0 - abs(angle) / stack.limits[k, 0 if angle < 0.0 else 1])
        first = BASE_GUARDS * k
        for i in range(2):
            _of_end(k, i, stack, contact, room, guards, first + END_GUARDS * i)
        if stack.rule == LEADING_CORNER and contact.hold[k] != FREE:
            guards[first + LEAD_GUARD] = contact.lead[k] * room.rel[k, 2]
    for which in range(stack.ties.shape[0]):
        if stack.ties[which, 10] >= 0.0:
            dx, dy, _, _, rest_length = stretched(which, z, stack, np.zeros((2, 2)))
            elongation = math.sqrt(dx * dx + dy * dy) - rest_length - stack.ties[which, 10]
            guards[BASE_GUARDS * n + which] = contact.taut[which] * elongation / rest_length
    guards[guards.size - 1] = nearest


@within
def _of_end(k, i, stack, contact, room, guards, g):
    level, _, _, speed = end(k, i, stack, room)
    gap = level / stack.settlement[k] - 1.0
    state = contact.ends[k, i]
    if state == CLEAR:
        guards[g] = gap
    elif state == SLIDES:
        size = size_of(k, stack)
        lever = sway(k, contact.point[k], stack, room)[1]
        guards[g] = room.gain[k] * room.force[k] / stack.gravity
        speed = slip(k, stack, contact, room)
        guards[g + 1] = contact.sense[k] * speed / math.sqrt(stack.gravity * size)
        guards[g + 2] = abs(lever) / size - LEAST_LEVER
    elif stack.is_bed[k]:
        guards[g] = -gap
    else:
        push = pad_force(k, i, stack, room) / stack.load[k]
        if state == TOUCHING:
            guards[g] = push
        elif state in (RELAXING, ENGAGING):
            guards[g], guards[g + 1] = -push, -gap
        elif state == LEAVING:
            guards[g], guards[g + 1] = push, -gap
            guards[g + 2] = speed / math.sqrt(stack.gravity * stack.settlement[k])


@compiled
def noise_levels(z, stack, noise):
    """Fill in the rounding noise of each guard."""
    noise[:] = 1e-13
    largest = 0.0
    for k in range(stack.mass.size):
        largest = max(largest, abs(z[3 * k + 2]))
    for k in range(stack.mass.size):
        moved = size_of(k, stack) * largest + abs(z[3 * k + 1])
        level = 1e-13 + 1e-15 * moved / stack.settlement[k]
        first = BASE_GUARDS * k
        for j in range(LEAD_GUARD):
            noise[first + j] = level if stack.is_bed[k] else 4.0 * level
        noise[first + LEAD_GUARD] = 1e-14


@within
def due(stack, contact, room, guards, noise):
    """Return the guard whose switch is due at this instant, or -1.

    A switch is due if its guard is negative, or zero and falling. `room` belongs to the present
    state.
    """
    n = stack.mass.size
    for k in range(n):
        for g in range(BASE_GUARDS * k, BASE_GUARDS * k + LEAD_GUARD):
            if guards[g] < -noise[g]:
                return g
    for k in range(n):
        pace = math.sqrt(stack.gravity * stack.settlement[k])
        for i in range(2):
            g, state = BASE_GUARDS * k + END_GUARDS * i, contact.ends[k, i]
            if abs(guards[g]) <= noise[g]:
                speed = end(k, i, stack, room)[3] / pace
                if state == CLEAR and speed < -QUIET:
                    return g
                if stack.is_bed[k] and state == TOUCHING and speed > QUIET:
                    return g
    return -1
