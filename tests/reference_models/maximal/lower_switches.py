"""Switches of the base on soil: an end uplifts, lands or slides."""

from .forces import end
from .impulses import carry_over, jump, lower_slip, note_places
from .kinematics import is_small, sway
from .layout import (
    BED_LEFT,
    BED_RIGHT,
    BED_SETTLEMENT,
    CENTRE,
    CLEAR,
    FREE,
    HELD,
    LEADING_CORNER,
    LEAST_LEVER,
    LOWER_ECCENTRICITY,
    LOWER_HALF_WIDTH,
    LOWER_HEIGHT,
    LOWER_HOLD,
    LOWER_LEAD,
    LOWER_POINT,
    LOWER_SENSE,
    RULE,
    SLIDES,
    SLIDING,
    TOUCHING,
)

SAME = 1e-9


def lower_point(z, contact, held, p):
    """Return coordinate of the point that the rule holds, from the foot of the centre of mass."""
    rule = int(p[RULE])
    b, middle = p[LOWER_HALF_WIDTH], -p[LOWER_ECCENTRICITY]
    if rule == CENTRE:
        return middle
    if rule == LEADING_CORNER:
        if z[2] != 0.0:
            held[LOWER_LEAD] = 1.0 if z[2] > 0.0 else -1.0
        elif z[8] != 0.0:
            held[LOWER_LEAD] = 1.0 if z[8] > 0.0 else -1.0
        return middle + b * held[LOWER_LEAD]
    left, right = contact[BED_LEFT] != CLEAR, contact[BED_RIGHT] != CLEAR
    if left == right:
        return middle
    return middle + b if right else middle - b


def _hold(z, contact, held, p, room):
    """Hold the body by the restraint rule and stop its slip."""
    contact[LOWER_HOLD] = HELD
    held[LOWER_POINT] = lower_point(z, contact, held, p)
    jump(z, contact, held, p, room, False, False)
    note_places(z, held, p, room)


def end_rises(i, z, contact, held, p, room):
    """An end uplifts."""
    other = 1 - i
    contact[BED_LEFT + i] = CLEAR
    w, _, _, speed = end(p, z, other)
    level = abs(w / p[BED_SETTLEMENT] - 1.0) < SAME
    if contact[BED_LEFT + other] == TOUCHING and speed > 0.0 and level:
        contact[BED_LEFT + other] = CLEAR
    if contact[BED_LEFT + other] == CLEAR:
        contact[LOWER_HOLD] = FREE
    elif contact[LOWER_HOLD] == HELD:
        _hold(z, contact, held, p, room)


def end_lands(i, z, contact, held, p, room):
    """An end lands."""
    other = 1 - i
    if contact[LOWER_HOLD] != FREE:
        contact[BED_LEFT] = contact[BED_RIGHT] = TOUCHING
        _hold(z, contact, held, p, room)
        return
    w, _, _, speed = end(p, z, other)
    if abs(w / p[BED_SETTLEMENT] - 1.0) < SAME and speed < 0.0:
        contact[BED_LEFT] = contact[BED_RIGHT] = TOUCHING
        _hold(z, contact, held, p, room)
        return
    before = z.copy()
    speed = end(p, z, i)[3]
    contact[BED_LEFT + i] = TOUCHING
    _hold(z, contact, held, p, room)
    size = p[LOWER_HALF_WIDTH] + p[LOWER_HEIGHT]
    lever = sway(is_small(p), z[2], p[LOWER_HEIGHT], held[LOWER_POINT])[1]
    after = end(p, z, i)[3]
    if after > max(0.0, speed) and abs(lever) > LEAST_LEVER * size:
        share = max(0.0, -speed / (after - speed))
        for j in range(6, 12):
            z[j] = before[j] + share * (z[j] - before[j])
        contact[BED_LEFT + i] = SLIDES
        contact[LOWER_HOLD] = SLIDING
        held[LOWER_SENSE] = 1.0 if lower_slip(z, held, p) > 0.0 else -1.0


def slide_ends(i, flies, z, contact, held, p, room):
    """The sliding end separates, or its slip ends."""
    if flies:
        contact[BED_LEFT + i] = CLEAR
        contact[LOWER_HOLD] = FREE
    else:
        contact[BED_LEFT + i] = TOUCHING
        _hold(z, contact, held, p, room)


def lower_pivot(z, contact, held, p, room):
    """The leading corner changes at rotation zero."""
    held[LOWER_LEAD] = -held[LOWER_LEAD]
    held[LOWER_POINT] = p[LOWER_HALF_WIDTH] * held[LOWER_LEAD] - p[LOWER_ECCENTRICITY]
    note_places(z, held, p, room)


def settle_lower(z, before, contact, held, p, room):
    """Pass the jump of the lower body on to the second stage of a cascade."""
    carry_over(z, before, contact, held, p, room)
