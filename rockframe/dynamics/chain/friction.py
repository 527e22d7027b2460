"""A chain of bodies that slip on their bases: friction where a chain without it holds.

Of each base the point that the rule of restraint names is held as long as friction can, and slips
against it otherwise, :eq:`eq-slip-on-base`. What a base presses with follows from where its body
is, so that no force waits for another. Which of the points slips stands in the mode, as the end
that slides in :mod:`rockframe.dynamics.sliding`, with the sense of the slip.
"""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from rockframe.compiled import Vector, inlined, kernel, stretch
from rockframe.dynamics import events
from rockframe.dynamics.base import Guards, Variables
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, ROTATION, VERTICAL
from rockframe.dynamics.body import BodyState, accelerated
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.motion import (
    FREE,
    add_constraint,
    coriolis_along,
    load_along,
    load_bodies,
    place_bodies,
    press_at,
)
from rockframe.dynamics.chain.rows import COLUMNS, GUARDS, MODES, PLACES, Lists
from rockframe.dynamics.chain.system import Chain
from rockframe.dynamics.coulomb import ImpulseResponse, coulomb_impulse
from rockframe.dynamics.events import IMPACT, PIVOT_CHANGE, REENGAGEMENT, SEPARATION, SILENT
from rockframe.dynamics.on_base import HOLD, PIVOT, SLIP, Mode, SlidingGuards
from rockframe.dynamics.protocol import (
    HELD_PLACE,
    IMPACT_LOSS,
    LAST_EVENT,
    Ending,
    Ground,
    Slope,
)
from rockframe.dynamics.sliding import NOISE
from rockframe.dynamics.switching import end_speed, next_pivot

STATIC: Final = 0
KINETIC: Final = 1
FRICTIONS: Final = 2
"""Numbers of each body behind the lists of a chain, then its slip and the rate of that."""
SLIP_COLUMNS: Final = 2

OFFSET: Final = 0  # of the slip from the place of the point that is held
PEAK_LEFT: Final = 1
PEAK_RIGHT: Final = 2
KEPT: Final = 3
"""What is remembered of the slip of each body, behind what a chain remembers."""

ROUNDING: Final = 1e-12
"""Accelerations over gravity that are rounding."""


class SlippingChain(Chain):
    """Bodies upon one another that friction holds on their bases: a system."""

    __slots__ = ()

    @inlined
    def friction_of(self, k: int, which: int) -> float:
        """Give a coefficient of friction under a body."""
        return float(self.rows[self.behind_chain() + FRICTIONS * k + which])

    @inlined
    def column_room(self) -> Vector:
        """Give the room for columns."""
        first = self.behind_chain() + FRICTIONS * self.body_count
        return stretch(self.rows, first, (COLUMNS + SLIP_COLUMNS) * self.body_count)

    @inlined
    def behind_friction(self) -> int:
        """Give the place behind all these rooms."""
        count = self.body_count
        return self.behind_chain() + (FRICTIONS + COLUMNS + SLIP_COLUMNS) * count

    @kernel
    def modes(self) -> int:
        """Give the number of modes: of contacts and pivots, and of the senses of slips."""
        return (2 * MODES) ** self.body_count

    @inlined
    def sense(self, mode: int, k: int) -> float:
        """Give the sense of the slip of a body that slips."""
        return -1.0 if mode // MODES**self.body_count // 2**k % 2 == 1 else 1.0

    @inlined
    def slipping(self, mode: int, k: int, sense: float) -> int:
        """Give the mode in which a body slips in a sense."""
        was, value = self.part_mode(mode, k), MODES**self.body_count * 2**k
        new = self.with_part(mode, k, Mode(was.contact, was.pivot, True))
        new -= new // value % 2 * value
        return new + value if sense < 0.0 else new

    @kernel
    def relaxation_in(self, mode: int) -> float:
        """Give 0: no constraint decays."""
        return 0.0

    @inlined
    def contact_with_force(self, k: int, mode: int) -> int:
        """Give the contact of a body with its base, which presses whether it slips or not."""
        return self.part_mode(mode, k).contact

    @inlined
    def observed_base(self, k: int, standing: Mode, body: BodyState) -> Variables:
        """Give what users see of a base."""
        part = self.on_base(k)
        return part.base.observed(standing.contact, part.body.base_line_at(body), ())

    @kernel
    def constrain(self, mode: int, state: Vector, room: Vector) -> int:
        """Write the constraints of points that are held, and load the others by their friction."""
        count, rows = 0, self.constraints()
        for k in range(self.body_count):
            i, pressed = k * PLACES, room[k * PLACES + at.PRESS]
            room[i + at.THRUST] = 0.0
            if room[i + at.HELD] != FREE:
                wanted = coriolis_along(i, room) + room[i + at.DRIFT]
                add_constraint(self, count, k, 1.0, 0.0, -room[i + at.REACH], wanted, room, rows)
                count += 1
            elif self.part_mode(mode, k).slides:
                thrust = -self.sense(mode, k) * self.friction_of(k, KINETIC) * max(pressed, 0.0)
                load_along(self, k, thrust, room)
                room[i + at.THRUST] = thrust
        return count

    @inlined
    def slip_rate(self, k: int, mode: int, state: Vector) -> tuple[float, float]:
        """Give the velocity at which the point that would be held slips, and its noise."""
        part, body = self.on_base(k), self.state_of(k, state)
        pin = part.body.pin(self.part_mode(mode, k).pivot)
        turning = part.body.reach(pin, part.body.attitude(body.rotation)).rate
        turning *= body.angular_velocity
        sway = body.horizontal_velocity
        return sway - turning, NOISE * (abs(sway) + abs(turning))

    @inlined
    def point_of(self, k: int, mode: int, state: Vector, memory: Vector) -> float:
        """Give the place of the point that is held, or would be."""
        part, body = self.on_base(k), self.state_of(k, state)
        pin = part.body.pin(self.part_mode(mode, k).pivot)
        return self.place(k, mode, state, memory) - part.body.about_pin(pin, body.rotation)

    @inlined
    def kept(self, k: int) -> int:
        """Give where the memory of a body's slip begins."""
        return HELD_PLACE + self.body_count + 1 + KEPT * k

    @kernel
    def slip_of(self, k: int, mode: int, state: Vector, memory: Vector) -> float:
        """Give how far a body has slipped on its base."""
        return float(memory[self.kept(k) + OFFSET]) + self.point_of(k, mode, state, memory)

    @kernel
    def guards_on_base(
        self, k: int, slides: bool, mode: int, state: Vector, slope: Slope, ground: Ground
    ) -> Guards:
        """Give the guards of a body, among them of the friction that holds it and of its slip."""
        part, standing, body = self.on_base(k), self.part_mode(mode, k), self.state_of(k, state)
        first, room, i = BEFORE_HORIZONTAL * k, self.places(), k * PLACES
        if k == 0:
            self.forces_from(mode, state, slope, ground)
        angular, rate = slope[first + ROTATION], body.angular_velocity
        hold, slip, change = 1.0, 1.0, 0.0
        if standing.slides:
            reach = part.body.reach(
                part.body.pin(standing.pivot), part.body.attitude(body.rotation)
            )
            sense, scale = (
                self.sense(mode, k),
                1.0 / math.sqrt(part.body.gravity * part.body.size()),
            )
            slip = scale * sense * (body.horizontal_velocity - reach.rate * rate)
            change = slope[self.horizontal_of(k)] - reach.rate * angular - reach.bend * rate * rate
            # a slip that starts is not stopped by rounding
            change = scale * (sense * change + ROUNDING * part.body.gravity)
        elif not part.flies(standing.contact):
            most = self.friction_of(k, STATIC) * max(room[i + at.PRESS], 0.0)
            hold = (most - abs(room[i + at.THRUST])) / part.body.gravity
        bears = Mode(standing.contact, standing.pivot, False)
        sliding = SlidingGuards(hold, slip, change)
        return part.guards_with(bears, body, (), slope[first + VERTICAL], angular, sliding)

    @kernel
    def switch_body(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out the switch that a guard of a body calls for; give the new mode."""
        k = guard // GUARDS
        which, part, was = guard - k * GUARDS, self.on_base(k), self.part_mode(mode, k)
        count, point = part.base.end_guards(), self.point_of(k, mode, state, memory)
        for j in range(self.body_count):
            slip = self.slip_of(j, mode, state, memory)
            memory[self.kept(j) + PEAK_LEFT] = max(memory[self.kept(j) + PEAK_LEFT], -slip)
            memory[self.kept(j) + PEAK_RIGHT] = max(memory[self.kept(j) + PEAK_RIGHT], slip)
        memory[HELD_PLACE + self.body_count] = k + 1.0
        if which < 2 * count:
            new = self.switch_end(k, which < count, which % count, mode, state, ground, memory)
            if memory[LAST_EVENT] == SILENT:
                return new
        elif which == 2 * count + PIVOT:
            pivot = next_pivot(self, part, k, mode, state, ground)
            memory[LAST_EVENT] = SILENT if was.pivot == 0 else PIVOT_CHANGE
            new = self.let_go(k, mode, state, memory)
            self.stand_upright(k, state)
            new = self.with_part(new, k, Mode(was.contact, pivot, True))
        else:
            new = self.let_go(k, mode, state, memory)
            if which == 2 * count + SLIP:
                self.end_slip(k, new, state)
        memory[self.kept(k) + OFFSET] += point - self.point_of(k, new, state, memory)
        lets_go = k if which == 2 * count + HOLD else -1
        new = self.go_on(k, lets_go, new, state, ground, memory)
        if which in (2 * count + HOLD, 2 * count + SLIP):
            memory[LAST_EVENT] = self.kind_of(k, mode, new)
        elif which < 2 * count:
            new = self.wait(k, which < count, new, state, ground, memory)
        return new

    @inlined
    def kind_of(self, k: int, old: int, new: int) -> int:
        """Give the kind of event between slipping, in either sense, and holding."""
        slipped, slips = self.part_mode(old, k).slides, self.part_mode(new, k).slides
        if not slips:
            return events.STICK if slipped else SILENT
        if not slipped:
            return events.SLIP
        return SILENT if self.sense(old, k) == self.sense(new, k) else events.REVERSAL

    @kernel
    def let_go(self, k: int, mode: int, state: Vector, memory: Vector) -> int:
        """Let a body that is held move along its base; give the mode in which it may."""
        part, was = self.on_base(k), self.part_mode(mode, k)
        if part.is_free(was):
            return mode
        place, body = self.place(k, mode, state, memory), self.state_of(k, state)
        self.set_sway(k, place, part.sway(was, body, part.body.attitude(body.rotation)), state)
        return self.with_part(mode, k, Mode(was.contact, was.pivot, True))

    @kernel
    def end_slip(self, k: int, mode: int, state: Vector) -> None:
        """Set the velocity of a body so that its point does not slip."""
        rate, _ = self.slip_rate(k, mode, state)
        state[self.coordinates() + self.horizontal_of(k)] -= rate

    @kernel
    def switch_end(
        self, k: int, left: bool, which: int, mode: int, state: Vector, ground: Ground,
        memory: Vector,
    ) -> int:  # fmt: skip
        """Carry out the switch of an end's contact; give the mode in which the body is let go."""
        part, was = self.on_base(k), self.part_mode(mode, k)
        line = part.body.base_line_at(self.state_of(k, state))
        found = part.base.switch(was.contact, left, which, line, ())
        memory[LAST_EVENT] = found.event
        if found.crossed:
            # the crossed level is set exactly, so that rounding cannot undo the switch
            self.change(k, part.base.level(left, line, ()), 0.0, state)
        if found.event == SILENT:
            return self.with_part(mode, k, Mode(found.contact, was.pivot, was.slides))
        new = self.let_go(k, mode, state, memory)
        now = part.standing(found.contact, self.state_of(k, state))
        new = self.with_part(new, k, Mode(now.contact, now.pivot, not part.flies(now.contact)))
        if found.event == IMPACT and part.base.rebound(left) < 1.0:
            both = part.flies(was.contact) and part.base.is_held(now.contact, not left)
            new = self.strike(k, left, both, new, state, memory)
        return new

    @kernel
    def strike(
        self, k: int, left: bool, both: bool, mode: int, state: Vector, memory: Vector
    ) -> int:
        """Reduce the speed of the end that lands, or of both, with friction in the impact.

        The bases of the bodies above and below press with forces, which hold nothing in an impact.
        """
        for j in range(max(k - 1, 0), min(k + 2, self.body_count)):
            mode = self.let_go(j, mode, state, memory)
            if j != k:
                beside = self.part_mode(mode, j)
                contact = self.on_base(j).base.disturbed(beside.contact)
                mode = self.with_part(mode, j, Mode(contact, beside.pivot, beside.slides))
        before = self.energies_of_bodies(mode, state).kinetic
        rate, noise = self.slip_rate(k, mode, state)
        if both and abs(rate) > noise:  # the end that leads comes first
            left = rate < 0.0
        self.strike_end(k, left, mode, state)
        if both:
            self.strike_end(k, not left, mode, state)
        memory[IMPACT_LOSS] += before - self.energies_of_bodies(mode, state).kinetic
        return mode

    @kernel
    def strike_end(self, k: int, left: bool, mode: int, state: Vector) -> None:
        """Reduce the speed of an end to eps times what it was, :eq:`eq-slide-impact`."""
        part = self.on_base(k)
        speed, _ = end_speed(part, left, self.state_of(k, state))
        if speed >= 0.0:
            return
        line = part.body.base_line_at(self.state_of(k, state))
        lever = line.left_lever if left else line.right_lever
        slip, noise = self.slip_rate(k, mode, state)
        if abs(slip) <= noise:
            slip = 0.0
        rises, slides = self.answers(k, 1.0, lever, 0.0, mode, state)
        normal_by_normal, along_by_normal = rises + lever * self.turned(k), slides
        rises, slides = self.answers(k, 0.0, 0.0, 1.0, mode, state)
        along, normal = coulomb_impulse(
            ImpulseResponse(
                normal_by_normal, rises + lever * self.turned(k), along_by_normal, slides
            ),
            slip, (1.0 - part.base.rebound(left)) * speed, self.friction_of(k, KINETIC),
        )  # fmt: skip
        self.answers(k, normal, normal * lever, along, mode, state)
        self.add_slopes(state)
        after, noise = self.slip_rate(k, mode, state)
        if abs(after) <= noise + 2.0 * NOISE * abs(slip):
            self.end_slip(k, mode, state)

    @inlined
    def turned(self, k: int) -> float:
        """Give the change of a body's angular velocity in the last answer."""
        return float(self.slopes()[BEFORE_HORIZONTAL * k + ROTATION])

    @kernel
    def answers(
        self, k: int, press: float, moment: float, along: float, mode: int, state: Vector
    ) -> tuple[float, float]:
        """Give what impulses of a base change of its body's rise and of the slip.

        The changes of all velocities stand in the room for slopes until the next ones.
        """
        room, out = self.places(), self.slopes()
        place_bodies(self, mode, state, room)
        load_bodies(self, 0.0, 0.0, room)
        press_at(self, k, press, moment, room)
        load_along(self, k, along, room)
        for j in range(self.body_count):
            i = j * PLACES
            room[i + at.RISE] = room[i + at.SWAY] = room[i + at.FRAME_RATE] = 0.0
        self.solve(0, room)
        turned = out[BEFORE_HORIZONTAL * k + ROTATION]
        slides = out[self.horizontal_of(k)] - room[k * PLACES + at.REACH] * turned
        return out[BEFORE_HORIZONTAL * k + VERTICAL], slides

    @kernel
    def go_on(
        self, k: int, lets_go: int, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Give the mode after an event: hold what does not slip, as far as friction can.

        Friction that `lets_go` does not hold that body.
        """
        for j in range(max(k - 1, 0), min(k + 2, self.body_count)):
            standing = self.part_mode(mode, j)
            if standing.slides:
                rate, noise = self.slip_rate(j, mode, state)
                if abs(rate) > noise:
                    mode = self.slipping(mode, j, rate)
                else:
                    self.end_slip(j, mode, state)
                    point = self.point_of(j, mode, state, memory)
                    mode = self.with_part(mode, j, Mode(standing.contact, standing.pivot, False))
                    memory[HELD_PLACE + j] = point
        return self.let_slip(lets_go, mode, state, ground, memory)

    @kernel
    def let_slip(
        self, lets_go: int, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Give the mode in which no body is held that friction cannot hold."""
        for _ in range(self.body_count):
            self.forces_from(mode, state, self.accelerate(mode, state, ground), ground)
            room, found, push = self.places(), -1, 0.0
            for j in range(self.body_count):
                if not self.on_base(j).is_free(self.part_mode(mode, j)):
                    i, static = j * PLACES, self.friction_of(j, STATIC)
                    thrust, most = room[i + at.THRUST], static * max(room[i + at.PRESS], 0.0)
                    if j == lets_go or abs(thrust) > most + ROUNDING * self.number(j, at.GRAVITY):
                        found, push = j, thrust
                        break
            if found < 0:
                break
            lets_go = -1
            mode = self.let_go(found, mode, state, memory)
            mode = self.slipping(mode, found, -push)
        return mode

    @kernel
    def wait(
        self, k: int, left: bool, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Let an end that the change of the held point would send back at once wait.

        One that has left and would be pressed again, and one that presses and would let go.
        """
        part, now, event = self.on_base(k), self.part_mode(mode, k), memory[LAST_EVENT]
        if event not in (SEPARATION, REENGAGEMENT) or part.flies(now.contact):
            return mode
        rises = self.end_accelerations(k, mode, state, ground)
        line = accelerated(part.body.base_line_at(self.state_of(k, state)), rises[0], rises[1])
        grows = part.base.will_press(left, line, ())
        contact = now.contact
        if event == SEPARATION and grows and part.base.presses(contact, left, line, ()):
            contact = part.base.waiting(contact, left)
        elif event == REENGAGEMENT and not grows:
            contact = part.base.unpressed(contact, left)
        return self.with_part(mode, k, Mode(contact, now.pivot, now.slides))

    @inlined
    def observe_slip(self, k: int, mode: int, state: Vector, memory: Vector, out: Vector) -> None:
        """Write slip and rate of slip of a body, behind the columns of all bodies."""
        j = COLUMNS * self.body_count + SLIP_COLUMNS * k
        out[j] = self.slip_of(k, mode, state, memory)
        moves = self.on_base(k).is_free(self.part_mode(mode, k))
        out[j + 1] = self.slip_rate(k, mode, state)[0] if moves else 0.0

    def slips(self, k: int, ending: Ending) -> tuple[float, float, float]:
        """Give the slip of a body at the end of a run, and the most to the left and right."""
        mode, state, memory = ending.mode, ending.state, ending.memory
        residual, kept = self.slip_of(k, mode, state, memory), memory[self.kept(k) :]
        return (
            residual,
            max(float(kept[PEAK_LEFT]), -residual),
            max(float(kept[PEAK_RIGHT]), residual),
        )


def with_friction(lists: Lists, frictions: Sequence[tuple[float, float]]) -> SlippingChain:
    """Give a chain whose bases have coefficients of friction, at rest and of slip."""
    room = np.zeros((COLUMNS + SLIP_COLUMNS) * lists.body_count)
    return SlippingChain(lists.body_count, np.concatenate([lists.rows, np.ravel(frictions), room]))
