"""Guard functions, positive as long as a contact state lasts."""

import math

from .bed import end_pressures, no_suction
from .compiling import compiled, within
from .forces import accelerate, corner, end, has_lower
from .impulses import lower_slip, slip
from .kinematics import is_small, limit_of, relative, sway
from .layout import (
    BED_DAMPING,
    BED_LEFT,
    BED_LEFT_GUARD,
    BED_LEVER_GUARD,
    BED_SETTLEMENT,
    BED_SLIP_GUARD,
    BED_STIFFNESS,
    CASCADE,
    CLEAR,
    CUT_END,
    CUT_GUARDS,
    CUT_START,
    ECCENTRICITY,
    ENGAGING,
    FREE,
    GRAVITY,
    HALF_HEIGHT,
    HALF_WIDTH,
    HELD,
    HOLD,
    KIND,
    LEAD,
    LEAD_GUARD,
    LEADING_CORNER,
    LEAST_LEVER,
    LEAVING,
    LEFT,
    LIMIT,
    LIMIT_GUARD,
    LOWER_HALF_WIDTH,
    LOWER_HEIGHT,
    LOWER_HOLD,
    LOWER_LEAD,
    LOWER_LEAD_GUARD,
    LOWER_POINT,
    LOWER_SENSE,
    MASS,
    POINT,
    RELAXING,
    RESTING,
    RIGID,
    RULE,
    SENSE,
    SETTLEMENT,
    SLIDES,
    SLIDING,
    TOUCHING,
)


@compiled
def total_rotation(z, p):
    """Return the rotation that decides overturning."""
    if p[MASS] <= 0.0:
        return z[2]
    return z[2] + z[5] if int(p[KIND]) == CASCADE else z[5]


@within
def evaluate(z, gx, gy, contact, held, p, room, out, guards):
    """Fill in the guards; `out` is a work array for accelerations."""
    guards[:] = 1.0
    rotation = total_rotation(z, p)
    guards[LIMIT_GUARD] = 1.0 - abs(rotation) / limit_of(p, rotation)
    if int(p[KIND]) == RIGID:
        if contact[HOLD] == RESTING:
            # ground acceleration to the right tips the block to the left
            b = p[HALF_WIDTH] + (p[ECCENTRICITY] if gx > 0.0 else -p[ECCENTRICITY])
            slope = limit_of(p, -gx) if is_small(p) else b / p[HALF_HEIGHT]
            guards[0] = ((p[GRAVITY] + gy) * slope - abs(gx)) / (p[GRAVITY] * slope)
        else:
            side = 1.0 if held[POINT] > 0.0 else -1.0
            guards[0] = side * z[5] / p[LIMIT]
        return
    slides = contact[HOLD] == SLIDING or contact[LOWER_HOLD] == SLIDING
    if slides:
        accelerate(z, gx, gy, contact, held, p, room, out)
    if p[MASS] > 0.0:
        _pads(z, contact, held, p, room, out, guards)
    if has_lower(p):
        _bed(z, contact, held, p, out, guards)


@within
def _pads(z, contact, held, p, room, out, guards):
    rel, rows = room[0], room[1]
    relative(z, p, rel, rows)
    weight, delta = p[MASS] * p[GRAVITY], p[SETTLEMENT]
    pace = math.sqrt(p[GRAVITY] * delta)
    for i in range(2):
        y, _, _, speed, force = corner(p, rel, i)
        k = 3 * i
        state = contact[LEFT + i]
        if state == TOUCHING:
            guards[k] = force / weight
        elif state == CLEAR:
            guards[k] = y / delta - 1.0
        elif state in (RELAXING, ENGAGING):
            guards[k] = -force / weight
            guards[k + 1] = 1.0 - y / delta
        elif state == LEAVING:
            guards[k] = force / weight
            guards[k + 1] = 1.0 - y / delta
            guards[k + 2] = speed / pace
        elif state == SLIDES:
            size = p[HALF_WIDTH] + p[HALF_HEIGHT]
            lever = sway(is_small(p), rel[2], p[HALF_HEIGHT], held[POINT])[1]
            guards[k] = out[9] * out[7] / p[GRAVITY]
            guards[k + 1] = held[SENSE] * slip(z, held, p, room) / math.sqrt(p[GRAVITY] * size)
            guards[k + 2] = abs(lever) / size - LEAST_LEVER
    if int(p[RULE]) == LEADING_CORNER and contact[HOLD] != FREE:
        guards[LEAD_GUARD] = held[LEAD] * rel[2] / p[LIMIT]


@within
def _bed(z, contact, held, p, out, guards):
    for i in range(2):
        w = end(p, z, i)[0] / p[BED_SETTLEMENT]
        k = BED_LEFT_GUARD + i
        state = contact[BED_LEFT + i]
        if state == TOUCHING:
            guards[k] = 1.0 - w
        elif state == CLEAR:
            guards[k] = w - 1.0
        elif state == SLIDES:
            size = p[LOWER_HALF_WIDTH] + p[LOWER_HEIGHT]
            lever = sway(is_small(p), z[2], p[LOWER_HEIGHT], held[LOWER_POINT])[1]
            guards[k] = out[8] * out[6] / p[GRAVITY]
            speed = lower_slip(z, held, p)
            guards[BED_SLIP_GUARD] = held[LOWER_SENSE] * speed / math.sqrt(p[GRAVITY] * size)
            guards[BED_LEVER_GUARD] = abs(lever) / size - LEAST_LEVER
    if no_suction(p) and contact[LOWER_HOLD] == HELD:
        first, last = end_pressures(contact, z, p)
        guards[CUT_GUARDS] = -first if contact[CUT_START] else first
        guards[CUT_GUARDS + 1] = -last if contact[CUT_END] else last
    if int(p[RULE]) == LEADING_CORNER and contact[LOWER_HOLD] != FREE:
        guards[LOWER_LEAD_GUARD] = held[LOWER_LEAD] * z[2] / p[LIMIT]


@compiled
def noise_levels(z, p, noise):
    """Fill in the rounding noise of each guard."""
    size = p[HALF_WIDTH] + p[HALF_HEIGHT]
    noise[:] = 1e-13
    if p[MASS] > 0.0 and p[SETTLEMENT] > 0.0:
        level = 1e-13 + 1e-15 * (size * abs(z[5]) + abs(z[4])) / p[SETTLEMENT]
        for k in range(6):
            noise[k] = 4.0 * level
        noise[LEAD_GUARD] = 1e-14
    if has_lower(p):
        size = p[LOWER_HALF_WIDTH] + p[LOWER_HEIGHT]
        level = 1e-13 + 1e-15 * (size * abs(z[2]) + abs(z[1])) / p[BED_SETTLEMENT]
        noise[BED_LEFT_GUARD] = noise[BED_LEFT_GUARD + 1] = level
        noise[LOWER_LEAD_GUARD] = 1e-14
        # the edge of the contact is uncertain by rounding when the base is nearly level
        blur = 1e-15 * size * abs(z[8]) / max(abs(z[2]), 1e-16)
        pressure = p[BED_DAMPING] * blur / (p[BED_STIFFNESS] * p[BED_SETTLEMENT])
        noise[CUT_GUARDS] = noise[CUT_GUARDS + 1] = min(1e-12 + pressure, 1e-6)
