"""Switches of a corner on its pad: it separates, lands, re-engages or slides."""

from .forces import accelerate, corner
from .impulses import jump, note_places, slip
from .kinematics import is_small, relative, sway
from .layout import (
    CENTRE,
    CLEAR,
    DAMPING,
    ECCENTRICITY,
    ENGAGING,
    FREE,
    GRAVITY,
    HALF_HEIGHT,
    HALF_WIDTH,
    HELD,
    HOLD,
    LEAD,
    LEADING_CORNER,
    LEAST_LEVER,
    LEAVING,
    LEFT,
    MASS,
    POINT,
    RELAXING,
    RIGHT,
    RULE,
    SENSE,
    SETTLEMENT,
    SLIDES,
    SLIDING,
    STIFFNESS,
    TOUCHING,
)

SAME = 1e-9


def bears(state):
    """Tell whether a corner bears in the sense of the restraint rule."""
    return state in (TOUCHING, ENGAGING, SLIDES)


def pad_point(z, contact, held, p, room):
    """Return coordinate of the point that the rule holds, from the foot of the centre of mass."""
    rule = int(p[RULE])
    b, middle = p[HALF_WIDTH], -p[ECCENTRICITY]
    if rule == CENTRE:
        return middle
    if rule == LEADING_CORNER:
        rel = room[0]
        relative(z, p, rel, room[1])
        if rel[2] != 0.0:
            held[LEAD] = 1.0 if rel[2] > 0.0 else -1.0
        elif rel[5] != 0.0:
            held[LEAD] = 1.0 if rel[5] > 0.0 else -1.0
        return middle + b * held[LEAD]
    left, right = bears(contact[LEFT]), bears(contact[RIGHT])
    if left == right:
        return middle
    return middle + b if right else middle - b


def corner_state(i, z, p, room):
    """Return level, speed and the force law at a corner."""
    relative(z, p, room[0], room[1])
    y, _, _, speed, force = corner(p, room[0], i)
    return y, speed, force / (p[MASS] * p[GRAVITY])


def force_rises(i, z, gx, gy, contact, held, p, room, out):
    """Tell whether the force law at a corner rises in the motion of the present state."""
    accelerate(z, gx, gy, contact, held, p, room, out)
    rel, rows = room[0], room[1]
    relative(z, p, rel, rows)
    _, lever, bend, speed, _ = corner(p, rel, i)
    lift = rel[7] + bend * rel[5] * rel[5]
    for j in range(6):
        lift += (rows[1, j] + lever * rows[2, j]) * out[j]
    return -p[STIFFNESS] * speed - p[DAMPING] * lift > 0.0


def hold(z, contact, held, p, room):
    """Hold the block by the restraint rule and stop its slip."""
    contact[HOLD] = HELD
    held[POINT] = pad_point(z, contact, held, p, room)
    jump(z, contact, held, p, room, False, False)
    note_places(z, held, p, room)


def _apart(i, z, contact, p, room, noise):
    y = corner_state(i, z, p, room)[0]
    off = p[DAMPING] == 0.0 or y / p[SETTLEMENT] - 1.0 >= -noise
    contact[LEFT + i] = CLEAR if off else RELAXING


def leaves(i, z, gx, gy, contact, held, p, room, out, noise):
    """A touching corner leaves its pad."""
    other = 1 - i
    gradual = abs(corner_state(i, z, p, room)[2]) <= noise
    _apart(i, z, contact, p, room, noise)
    if contact[LEFT + other] == TOUCHING:
        _, speed, force = corner_state(other, z, p, room)
        if force <= noise and speed >= 0.0:
            _apart(other, z, contact, p, room, noise)
            contact[HOLD] = FREE
            return
    if contact[LEFT + other] == LEAVING:
        contact[LEFT + other] = RELAXING
    if contact[LEFT + other] == ENGAGING:
        # no corner presses any more: no point is held
        contact[LEFT + other] = RELAXING
    if contact[LEFT + other] == TOUCHING:
        hold(z, contact, held, p, room)
        force = corner_state(i, z, p, room)[2]
        if contact[LEFT + i] == RELAXING and (
            force > noise
            or (
                gradual
                and force >= -noise
                and force_rises(i, z, gx, gy, contact, held, p, room, out)
            )
        ):
            contact[LEFT + i] = LEAVING
        return
    contact[HOLD] = FREE
    if not gradual or p[DAMPING] == 0.0:
        return
    lever = sway(is_small(p), room[0][2], p[HALF_HEIGHT], held[POINT])[1]
    if abs(lever) <= LEAST_LEVER * (p[HALF_WIDTH] + p[HALF_HEIGHT]):
        return
    if force_rises(i, z, gx, gy, contact, held, p, room, out):
        contact[LEFT + i] = SLIDES
        contact[HOLD] = SLIDING
        accelerate(z, gx, gy, contact, held, p, room, out)
        held[SENSE] = 1.0 if out[7] < 0.0 else -1.0


def _out_of_flight(i, limit, z, contact, held, p, room):
    """Hold the block at one corner unless its speed would pass `limit`; tell whether it is held."""
    before = z.copy()
    speed = corner_state(i, z, p, room)[1]
    contact[LEFT + i] = TOUCHING
    hold(z, contact, held, p, room)
    after = corner_state(i, z, p, room)[1]
    lever = sway(is_small(p), room[0][2], p[HALF_HEIGHT], held[POINT])[1]
    size = p[HALF_WIDTH] + p[HALF_HEIGHT]
    if after <= max(limit, speed) or abs(lever) <= LEAST_LEVER * size:
        return True
    share = max(0.0, (limit - speed) / (after - speed))
    for j in range(6, 12):
        z[j] = before[j] + share * (z[j] - before[j])
    contact[LEFT + i] = SLIDES
    contact[HOLD] = SLIDING
    held[SENSE] = 1.0 if slip(z, held, p, room) > 0.0 else -1.0
    return False


def lands(i, z, contact, held, p, room):
    """A clear corner lands on its pad."""
    other = 1 - i
    y, speed, _ = corner_state(other, z, p, room)
    both = contact[LEFT + other] == CLEAR and speed < 0.0
    both = both and abs(y / p[SETTLEMENT] - 1.0) < SAME
    if contact[HOLD] == FREE and not both:
        if not _out_of_flight(i, 0.0, z, contact, held, p, room):
            return
    else:
        contact[LEFT + i] = TOUCHING
        if both or contact[LEFT + other] == SLIDES:
            contact[LEFT + other] = TOUCHING
        hold(z, contact, held, p, room)
    down = corner_state(i, z, p, room)[1] < 0.0
    other_down = both and corner_state(other, z, p, room)[1] < 0.0
    jump(
        z,
        contact,
        held,
        p,
        room,
        (i == 0 and down) or (other == 0 and other_down),
        (i == 1 and down) or (other == 1 and other_down),
    )
    if contact[LEFT + other] == LEAVING:
        contact[LEFT + other] = RELAXING


def caught_up(i, z, contact, held, p, room, noise):
    """A relaxing corner touches again, without an impact."""
    other = 1 - i
    if contact[HOLD] == FREE:
        y = corner_state(i, z, p, room)[0]
        limit = p[STIFFNESS] / p[DAMPING] * (p[SETTLEMENT] - y) if p[DAMPING] > 0.0 else 0.0
        _out_of_flight(i, limit, z, contact, held, p, room)
        return
    contact[LEFT + i] = TOUCHING
    if contact[LEFT + other] == SLIDES:
        contact[LEFT + other] = TOUCHING
    if contact[LEFT + other] == LEAVING:
        contact[LEFT + other] = RELAXING
    hold(z, contact, held, p, room)
    if corner_state(i, z, p, room)[2] < -noise:
        contact[LEFT + i] = ENGAGING


def clears(i, z, contact, held, p, room):
    """A corner rises through the unloaded level of its pad."""
    other = 1 - i
    engaged = contact[LEFT + i] == ENGAGING
    contact[LEFT + i] = CLEAR
    if engaged:
        if contact[LEFT + other] == TOUCHING:
            hold(z, contact, held, p, room)
        else:
            if contact[LEFT + other] == ENGAGING:
                contact[LEFT + other] = RELAXING
            contact[HOLD] = FREE


def slide_stops(i, flies, z, contact, held, p, room, noise):
    """The sliding corner separates, or its slip ends."""
    if flies:
        _apart(i, z, contact, p, room, noise)
        contact[HOLD] = FREE
    else:
        contact[LEFT + i] = TOUCHING
        hold(z, contact, held, p, room)


def pad_pivot(z, contact, held, p, room):
    """The leading corner changes at rotation zero."""
    held[LEAD] = -held[LEAD]
    held[POINT] = p[HALF_WIDTH] * held[LEAD] - p[ECCENTRICITY]
    note_places(z, held, p, room)
