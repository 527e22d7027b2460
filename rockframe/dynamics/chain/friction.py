"""A chain of bodies that slip on their bases: friction where a chain without it holds.

Of each base the point that the rule of restraint names is held as long as friction can, and slips
against it otherwise, :eq:`eq-slip-on-base`. What a base presses with follows from where its body
is, so that no force waits for another.
"""

import math

from rockframe.compiled import Vector, inlined, kernel
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
from rockframe.dynamics.chain.rows import GUARDS, PLACES
from rockframe.dynamics.chain.slips import (
    IMPULSIVE,
    KINETIC,
    OFFSET,
    ROUNDING,
    STATIC,
    SlippingBodies,
)
from rockframe.dynamics.coulomb import ImpulseResponse, coulomb_impulse
from rockframe.dynamics.events import IMPACT, PIVOT_CHANGE, REENGAGEMENT, SEPARATION, SILENT
from rockframe.dynamics.on_base import HOLD, PIVOT, SLIP, Mode, SlidingGuards
from rockframe.dynamics.protocol import HELD_PLACE, IMPACT_LOSS, LAST_EVENT, Ground, Slope
from rockframe.dynamics.sliding import NOISE
from rockframe.dynamics.switching import end_speed, next_pivot


class SlippingChain(SlippingBodies):
    """Bodies upon one another that friction holds on their bases: a system."""

    __slots__ = ()

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
        self.keep_peaks(mode, state, memory)
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
            slip, (1.0 - part.base.rebound(left)) * speed, self.friction_of(k, IMPULSIVE),
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
