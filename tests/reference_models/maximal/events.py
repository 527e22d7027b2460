"""Maps a guard that has fallen through zero to its switch."""

import math

from .compiling import within
from .forces import corner, end, has_lower
from .kinematics import relative
from .layout import (
    BED_LEFT,
    BED_LEFT_GUARD,
    BED_LEVER_GUARD,
    BED_SETTLEMENT,
    BED_SLIP_GUARD,
    CLEAR,
    CUT_GUARDS,
    CUT_START,
    DAMPING,
    FREE,
    GRAVITY,
    HALF_HEIGHT,
    HOLD,
    KIND,
    LEAD_GUARD,
    LEAVING,
    LEFT,
    LOWER_HOLD,
    LOWER_LEAD_GUARD,
    MASS,
    RELAXING,
    RESTING,
    RIGID,
    SETTLEMENT,
    SLIDES,
    SLIDING,
    STIFFNESS,
    TOUCHING,
)
from .lower_switches import end_lands, end_rises, lower_pivot, settle_lower, slide_ends
from .pad_switches import (
    caught_up,
    clears,
    hold,
    lands,
    leaves,
    pad_pivot,
    slide_stops,
)
from .rigid_switches import impact, start_rocking

QUIET = 1e-11


def fire(slot, z, gx, gy, contact, held, p, room, out, noise):
    """Carry out the switch of a guard."""
    if int(p[KIND]) == RIGID:
        if contact[HOLD] == RESTING:
            start_rocking(z, gx, contact, held, p)
        else:
            impact(z, gx, gy, contact, held, p)
        return
    if slot >= CUT_GUARDS:
        contact[CUT_START + slot - CUT_GUARDS] ^= 1
        return
    if slot == LEAD_GUARD:
        pad_pivot(z, contact, held, p, room)
    elif slot == LOWER_LEAD_GUARD:
        lower_pivot(z, contact, held, p, room)
    elif slot < LEAD_GUARD:
        _pad_event(slot // 3, slot % 3, z, gx, gy, contact, held, p, room, out, noise)
    else:
        _bed_event(slot, z, contact, held, p, room)
    _disturbed(z, contact, p, room, noise)


def _pad_event(i, which, z, gx, gy, contact, held, p, room, out, noise):
    state = contact[LEFT + i]
    tiny = noise[3 * i]
    if state == TOUCHING:
        leaves(i, z, gx, gy, contact, held, p, room, out, tiny)
    elif state == CLEAR:
        lands(i, z, contact, held, p, room)
    elif state == SLIDES:
        slide_stops(i, which == 0, z, contact, held, p, room, tiny)
    elif which == 1:
        clears(i, z, contact, held, p, room)
    elif state == RELAXING:
        caught_up(i, z, contact, held, p, room, tiny)
    elif state == LEAVING and which == 0:
        contact[LEFT + i] = RELAXING
    elif state == LEAVING:
        contact[LEFT + i] = TOUCHING
        hold(z, contact, held, p, room)
    else:
        contact[LEFT + i] = TOUCHING


def _bed_event(slot, z, contact, held, p, room):
    before = z.copy()
    if slot in (BED_SLIP_GUARD, BED_LEVER_GUARD):
        i = 0 if contact[BED_LEFT] == SLIDES else 1
        slide_ends(i, False, z, contact, held, p, room)
    else:
        i = slot - BED_LEFT_GUARD
        state = contact[BED_LEFT + i]
        if state == TOUCHING:
            end_rises(i, z, contact, held, p, room)
        elif state == CLEAR:
            end_lands(i, z, contact, held, p, room)
        else:
            slide_ends(i, True, z, contact, held, p, room)
    settle_lower(z, before, contact, held, p, room)
    for i in range(2):
        if contact[LEFT + i] == LEAVING:
            contact[LEFT + i] = RELAXING


def _disturbed(z, contact, p, room, noise):
    """Let a sliding corner or end fly if an impulse has changed its speed."""
    if p[MASS] > 0.0 and contact[HOLD] == SLIDING:
        i = 0 if contact[LEFT] == SLIDES else 1
        relative(z, p, room[0], room[1])
        y, _, _, speed, _ = corner(p, room[0], i)
        wanted = p[STIFFNESS] / p[DAMPING] * (p[SETTLEMENT] - y) if p[DAMPING] > 0.0 else 0.0
        if abs(speed - wanted) > QUIET * math.sqrt(p[GRAVITY] * p[HALF_HEIGHT]):
            off = p[DAMPING] == 0.0 or y / p[SETTLEMENT] - 1.0 >= -noise[3 * i]
            contact[LEFT + i] = CLEAR if off else RELAXING
            contact[HOLD] = FREE
    if has_lower(p) and contact[LOWER_HOLD] == SLIDING:
        i = 0 if contact[BED_LEFT] == SLIDES else 1
        speed = end(p, z, i)[3]
        if abs(speed) > QUIET * math.sqrt(p[GRAVITY]):
            contact[BED_LEFT + i] = CLEAR
            contact[LOWER_HOLD] = FREE


@within
def due(z, contact, p, room, guards, noise):
    """Return the guard whose switch is due at this instant, or -1.

    A switch is due if its guard is negative, or zero and falling.
    """
    for k in range(LEAD_GUARD):
        if guards[k] < -noise[k]:
            return k
    for k in range(BED_LEFT_GUARD, BED_LEVER_GUARD + 1):
        if guards[k] < -noise[k]:
            return k
    if int(p[KIND]) == RIGID:
        return -1
    if p[MASS] > 0.0:
        relative(z, p, room[0], room[1])
        for i in range(2):
            if contact[LEFT + i] == CLEAR and abs(guards[3 * i]) <= noise[3 * i]:
                speed = corner(p, room[0], i)[3]
                if speed < -QUIET * math.sqrt(p[GRAVITY] * p[SETTLEMENT]):
                    return 3 * i
    if has_lower(p):
        for i in range(2):
            k = BED_LEFT_GUARD + i
            if abs(guards[k]) <= noise[k] and contact[BED_LEFT + i] != SLIDES:
                speed = end(p, z, i)[3] / math.sqrt(p[GRAVITY] * p[BED_SETTLEMENT])
                if speed < -QUIET and contact[BED_LEFT + i] == CLEAR:
                    return k
                if speed > QUIET and contact[BED_LEFT + i] == TOUCHING:
                    return k
    return -1
