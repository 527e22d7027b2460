"""Switches of an end of a base: it separates, lands, re-engages or slides.

:func:`fire` maps a guard that has fallen through zero to its switch. These functions run once for
each event and are not compiled.
"""

import math

from .contact import (
    BASE_GUARDS,
    CLEAR,
    END_GUARDS,
    ENGAGING,
    FREE,
    HELD,
    LEAD_GUARD,
    LEAST_LEVER,
    LEAVING,
    RELAXING,
    SLIDES,
    SLIDING,
    TOUCHING,
)
from .forces import accelerate, pad_force, yielding_rate
from .guards import QUIET
from .impulses import jump, note_places, project, relate, slip
from .kinematics import end, size_of, sway
from .scene import CENTRE, LEADING_CORNER

SAME = 1e-9
"""Share of the settlement within which both ends land, or leave, together."""


class Events:
    """Switches of one stack, at one instant.

    Parameters
    ----------
    z : ndarray
        State, changed.
    ground : tuple of float
        Acceleration of the ground.
    stack, standing, room
        Arguments of the equations of motion; `contact` is changed.
    noise : ndarray
        Rounding noise of the guards.
    """

    def __init__(self, z, ground, stack, contact, room, noise):
        self.z, self.ground, self.stack, self.room = z, ground, stack, room
        self.ends, self.contact, self.noise = contact.ends, contact, noise
        relate(z, stack, room)

    def fire(self, slot: int) -> str:
        """Carry out the switch of a guard and return its name."""
        k, which = divmod(slot, BASE_GUARDS)
        if which == LEAD_GUARD:
            self._change_lead(k)
            name = "pivot"
        else:
            name = self._switch(k, *divmod(which, END_GUARDS))
        relate(self.z, self.stack, self.room)
        for above in range(k):
            self.ends[above][self.ends[above] == LEAVING] = RELAXING
        for other in range(self.stack.mass.size):
            self._check_sliding(other)
        return name

    def _switch(self, k: int, i: int, which: int) -> str:
        state = self.ends[k, i]
        if state == TOUCHING:
            return self._leaves(k, i)
        if state == CLEAR:
            return self._lands(k, i)
        if state == SLIDES:
            return self._slide_ends(k, i, which == 0)
        if which == 1:
            return self._clears(k, i)
        if state == RELAXING:
            return self._caught_up(k, i)
        if state == LEAVING and which == 0:
            self.ends[k, i] = RELAXING
            return "relaxing"
        if state == LEAVING:
            return self._touches_again(k, i)
        self.ends[k, i] = TOUCHING
        return "touching"

    # quantities of an end

    def _speed(self, k: int, i: int) -> float:
        return end(k, i, self.stack, self.room)[3]

    def _gap(self, k: int, i: int) -> float:
        return end(k, i, self.stack, self.room)[0] / self.stack.settlement[k] - 1.0

    def _push(self, k: int, i: int) -> float:
        """Return the force law of a pad over the load."""
        return pad_force(k, i, self.stack, self.room) / self.stack.load[k]

    def _tiny(self, k: int) -> float:
        return self.noise[BASE_GUARDS * k]

    def _following(self, k: int, i: int) -> float:
        """Return the speed of an end that follows its unloaded pad."""
        return -yielding_rate(k, self.stack) * self.stack.settlement[k] * self._gap(k, i)

    def _bears(self, k: int, i: int) -> bool:
        """Tell whether an end bears in the sense of the restraint rule."""
        return self.ends[k, i] in (TOUCHING, ENGAGING, SLIDES)

    def _apart(self, k: int, i: int) -> None:
        """Let an end be free of its base."""
        viscous = yielding_rate(k, self.stack) > 0.0
        below = self._gap(k, i) < -self._tiny(k)
        self.ends[k, i] = RELAXING if viscous and below else CLEAR

    # holds of a body

    def _rule(self, k: int) -> float:
        """Return the point that the rule holds, from the foot of the centre of mass."""
        stack, contact = self.stack, self.contact
        b, middle = stack.half_width[k], -stack.eccentricity[k]
        if stack.rule == CENTRE:
            return middle
        if stack.rule == LEADING_CORNER:
            leans = self.room.rel[k, 2] or self.room.rel[k, 5]
            if leans != 0.0:
                contact.lead[k] = math.copysign(1.0, leans)
            return middle + b * contact.lead[k]
        left, right = self._bears(k, 0), self._bears(k, 1)
        if left == right:
            return middle
        return middle + b if right else middle - b

    def _hold(self, k: int) -> None:
        """Hold a body by the restraint rule and stop its slip."""
        self.contact.hold[k] = HELD
        self.contact.point[k] = self._rule(k)
        project(self.z, self.stack, self.contact, self.room)
        self._note()

    def _note(self) -> None:
        note_places(self.z, self.stack, self.contact, self.room)

    def _has_lever(self, k: int) -> bool:
        lever = sway(k, self.contact.point[k], self.stack, self.room)[1]
        return abs(lever) > LEAST_LEVER * size_of(k, self.stack)

    # separation

    def _leaves(self, k: int, i: int) -> str:
        other = 1 - i
        gradual = not self.stack.is_bed[k] and abs(self._push(k, i)) <= self._tiny(k)
        touched = self.ends[k, other] == TOUCHING
        before = self.z.copy(), self.ends[k].copy(), self.contact.point[k]
        self._apart(k, i)
        if touched and self._leaves_too(k, other):
            self._apart(k, other)
        elif self.ends[k, other] in (LEAVING, ENGAGING):
            self.ends[k, other] = RELAXING
        if self.ends[k, other] == TOUCHING:
            self._leaves_one(k, i, before)
            return "separation"
        self.contact.hold[k] = FREE
        if touched or not gradual or self.ends[k, i] != RELAXING or not self._has_lever(k):
            return "separation"
        if self._push_rises(k, i):
            # in flight the pad would press it at once
            self.ends[k, i], self.contact.hold[k] = SLIDES, SLIDING
            accelerate(self.z, *self.ground, self.stack, self.contact, self.room)
            self.contact.sense[k] = 1.0 if self.room.force[k] < 0.0 else -1.0
            return "sliding"
        return "separation"

    def _leaves_too(self, k: int, i: int) -> bool:
        if self.stack.is_bed[k]:
            return self._speed(k, i) > 0.0 and abs(self._gap(k, i)) < SAME
        return self._push(k, i) <= self._tiny(k) and self._speed(k, i) >= 0.0

    def _leaves_one(self, k: int, i: int, before) -> None:
        """Hold a body by the remaining end, unless that stops the rise of the separating one."""
        z, ends, point = before
        self._hold(k)
        if self.contact.point[k] == point:
            return
        presses = self.ends[k, i] == RELAXING and self._push(k, i) >= -self._tiny(k)
        if self._speed(k, i) <= 0.0:
            self.z[:], self.contact.point[k] = z, point
            self._note()
            if presses:
                self.ends[k] = ends
                self.ends[k, i] = ENGAGING
        elif presses:
            self.ends[k, i] = LEAVING

    def _push_rises(self, k: int, i: int) -> bool:
        """Tell whether the force law of a pad rises in the motion of the present state."""
        stack, room = self.stack, self.room
        accelerate(self.z, *self.ground, stack, self.contact, room)
        _, lever, bend, speed = end(k, i, stack, room)
        lift = room.rel[k, 7] + bend * room.rel[k, 5] ** 2
        for j in range(6):
            row = room.rows[k, 1, j] + lever * room.rows[k, 2, j]
            lift += row * room.out[3 * k + j]
        return stack.stiffness[k] * speed + stack.damping[k] * lift < 0.0

    def _clears(self, k: int, i: int) -> str:
        """Let an end rise through the unloaded level of its pad."""
        if self.ends[k, i] == ENGAGING:
            return self._leaves(k, i)
        self.ends[k, i] = CLEAR
        return "clear"

    # landing and re-engagement

    def _lands(self, k: int, i: int) -> str:
        other = 1 - i
        both = self.ends[k, other] == CLEAR and self._speed(k, other) < 0.0
        both = both and abs(self._gap(k, other)) < SAME
        if self.contact.hold[k] == FREE and not both:
            if not self._out_of_flight(k, i, 0.0):
                return "sliding"
        else:
            self.ends[k, i] = TOUCHING
            if both or self.ends[k, other] == SLIDES:
                self.ends[k, other] = TOUCHING
            self._hold(k)
        if self.stack.is_bed[k]:
            return "landing"
        down = [self._speed(k, j) < 0.0 and (j == i or both) for j in range(2)]
        jump(self.z, self.stack, self.contact, self.room, k, *down)
        if self.ends[k, other] == LEAVING:
            self.ends[k, other] = RELAXING
        return "landing"

    def _out_of_flight(self, k: int, i: int, limit: float) -> bool:
        """Hold the body at one end unless its speed would pass `limit`; tell whether it is held."""
        before, speed = self.z.copy(), self._speed(k, i)
        self.ends[k, i] = TOUCHING
        self._hold(k)
        after = self._speed(k, i)
        if after <= max(limit, speed) or not self._has_lever(k):
            return True
        share = max(0.0, (limit - speed) / (after - speed))
        self.z[:] = before + share * (self.z - before)
        relate(self.z, self.stack, self.room)
        self.ends[k, i], self.contact.hold[k] = SLIDES, SLIDING
        positive = slip(k, self.stack, self.contact, self.room) > 0.0
        self.contact.sense[k] = 1.0 if positive else -1.0
        return False

    def _caught_up(self, k: int, i: int) -> str:
        """Let a relaxing end touch again, without an impact."""
        if self.contact.hold[k] == FREE:
            held = self._out_of_flight(k, i, self._following(k, i))
            return "re-engagement" if held else "sliding"
        return self._touches_again(k, i)

    def _touches_again(self, k: int, i: int) -> str:
        other = 1 - i
        self.ends[k, i] = TOUCHING
        if self.ends[k, other] == SLIDES:
            self.ends[k, other] = TOUCHING
        if self.ends[k, other] == LEAVING:
            self.ends[k, other] = RELAXING
        self._hold(k)
        if self._push(k, i) < -self._tiny(k):
            self.ends[k, i] = ENGAGING
        return "re-engagement"

    # sliding, and the leading corner

    def _slide_ends(self, k: int, i: int, flies: bool) -> str:
        if flies:
            self._flies(k, i)
            return "separation"
        self.ends[k, i] = TOUCHING
        self._hold(k)
        return "held"

    def _flies(self, k: int, i: int) -> None:
        self._apart(k, i)
        self.contact.hold[k] = FREE

    def _check_sliding(self, k: int) -> None:
        """Let a sliding end fly if an impulse has changed its speed."""
        if self.contact.hold[k] != SLIDING:
            return
        i = 0 if self.ends[k, 0] == SLIDES else 1
        off = self._speed(k, i) - self._following(k, i)
        if abs(off) > QUIET * math.sqrt(self.stack.gravity * self.stack.height[k]):
            self._flies(k, i)

    def _change_lead(self, k: int) -> None:
        lead = self.contact.lead
        lead[k] = -lead[k]
        self.contact.point[k] = lead[k] * self.stack.half_width[k] - self.stack.eccentricity[k]
        self._note()
