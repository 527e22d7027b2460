"""Events of a body that friction holds on a deformable base, :eq:`eq-slip-on-base`.

Friction holds the point of each base that the rule of restraint names, up to its bound, and else
opposes the slip of that point. The normal force of a deformable base follows from the state, not
from the friction. It is finite, so that this friction has no impulse in an impact elsewhere.
"""

import math

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, ROTATION, VERTICAL
from rockframe.dynamics.body import REST_AMPLITUDE, with_accelerations
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.impact import LEFT_ONLY, RIGHT_ONLY
from rockframe.dynamics.chain.motion import (
    add_base_load,
    add_tangential_load,
    set_inertia_loads,
    write_kinematics,
)
from rockframe.dynamics.chain.rows import BODY_STRIDE
from rockframe.dynamics.chain.slips import IMPULSIVE, SlippingBodies
from rockframe.dynamics.coulomb import ImpulseResponse, coulomb_impulse
from rockframe.dynamics.events import IMPACT, PIVOT_CHANGE, REENGAGEMENT, SEPARATION, SILENT
from rockframe.dynamics.on_base import SPEED_ROUNDING, Mode
from rockframe.dynamics.pads import CORNER_GUARDS, ENGAGING, LEAVING
from rockframe.dynamics.protocol import IMPACT_LOSS, LAST_EVENT, Ground
from rockframe.dynamics.switching import end_speed, next_pivot


class SlipperyBases(SlippingBodies):
    """Stacked bodies, some of which slip on deformable bases. A mixin of systems."""

    __slots__ = ()

    @kernel
    def switch_with_friction(
        self, k: int, which: int, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out the switch of an end's contact, or of the held point of a body.

        In the new mode the body is released, except after a silent event.
        """
        if which < 2 * CORNER_GUARDS:
            left = which < CORNER_GUARDS
            return self.switch_end(k, left, which % CORNER_GUARDS, mode, state, memory)
        part, was = self.on_base(k), self.body_mode(mode, k)
        pivot = next_pivot(self, part, k, mode, state, ground)
        memory[LAST_EVENT] = SILENT if was.pivot == 0 else PIVOT_CHANGE
        new = self.release(k, mode, state, memory)
        self.set_upright(k, state)
        return self.with_body_mode(new, k, Mode(was.contact, pivot, True))

    @kernel
    def switch_end(
        self, k: int, left: bool, which: int, mode: int, state: Vector, memory: Vector
    ) -> int:
        """Carry out the switch of an end's contact; return the mode, with the body released."""
        part, was = self.on_base(k), self.body_mode(mode, k)
        line = part.body.base_line_at(self.state_of(k, state))
        event = part.base.switch(was.contact, left, which, line, ())
        memory[LAST_EVENT] = event.event
        if event.crossed:
            # the crossed level is set exactly, so that rounding cannot undo the switch
            self.shift_vertical(k, part.base.level(left, line, ()), 0.0, state)
        if event.event == SILENT:
            return self.with_body_mode(mode, k, Mode(event.contact, was.pivot, was.slides))
        new = self.release(k, mode, state, memory)
        new_body_mode = part.mode_for_contact(event.contact, self.state_of(k, state))
        new = self.with_body_mode(
            new,
            k,
            Mode(new_body_mode.contact, new_body_mode.pivot, not part.flies(new_body_mode.contact)),
        )
        if event.event == IMPACT and part.base.rebound(left) < 1.0:
            both = part.flies(was.contact) and part.base.is_held(new_body_mode.contact, not left)
            new = self.strike(k, left, both, new, state, memory)
        return new

    @kernel
    def strike(
        self, k: int, left: bool, both: bool, mode: int, state: Vector, memory: Vector
    ) -> int:
        """Reduce the speed of the end that lands, or of both, with friction in the impact.

        Other deformable bases act with finite forces: their friction has no impulse.
        """
        mode = self.release_all(mode, state, memory)
        for j in range(self.body_count):
            if j != k and self.is_slippery(j):
                mode = self.disturbed_mode(j, mode, state)
        before = self.energies_of_bodies(mode, state).kinetic
        alone = LEFT_ONLY if left else RIGHT_ONLY
        if both:
            alone = self.strike_ends(k, mode, state)
        if alone != 0:
            self.strike_end(k, alone == LEFT_ONLY, mode, state)
        memory[IMPACT_LOSS] += before - self.energies_of_bodies(mode, state).kinetic
        return mode

    @kernel
    def strike_end(self, k: int, left: bool, mode: int, state: Vector) -> None:
        """Reduce the speed of an end by the factor eps in an impact, :eq:`eq-slide-impact`."""
        part = self.on_base(k)
        speed, _ = end_speed(part, left, self.state_of(k, state))
        if speed >= 0.0:
            return
        line = part.body.base_line_at(self.state_of(k, state))
        lever = line.left_lever if left else line.right_lever
        slip, noise = self.slip_rate(k, mode, state)
        if abs(slip) <= noise:
            slip = 0.0
        rises, slides = self.impulse_response(k, 1.0, lever, 0.0, mode, state)
        normal_by_normal, along_by_normal = rises + lever * self.rotation_change(k), slides
        rises, slides = self.impulse_response(k, 0.0, 0.0, 1.0, mode, state)
        along, normal = coulomb_impulse(
            ImpulseResponse(
                normal_by_normal, rises + lever * self.rotation_change(k), along_by_normal, slides
            ),
            slip, (1.0 - part.base.rebound(left)) * speed, self.friction_coefficient(k, IMPULSIVE),
        )  # fmt: skip
        self.apply_base_impulses(k, normal, normal * lever, along, slip, mode, state)

    @kernel
    def strike_ends(self, k: int, mode: int, state: Vector) -> int:
        """Reduce the speeds of both ends in one impact, each by its own factor eps; return 0.

        Where friction would lift one of them, only the other has an impact: returns LEFT_ONLY or
        RIGHT_ONLY for this one, and leaves the velocities unchanged.
        """
        body, base = self.on_base(k)
        line = body.base_line_at(self.state_of(k, state))
        slip, noise = self.slip_rate(k, mode, state)
        if abs(slip) <= noise:
            slip = 0.0
        left_lever, right_lever = line.left_lever, line.right_lever
        rises, slides_left = self.impulse_response(k, 1.0, left_lever, 0.0, mode, state)
        left_left = rises + left_lever * self.rotation_change(k)
        mixed = rises + right_lever * self.rotation_change(k)
        rises, slides_right = self.impulse_response(k, 1.0, right_lever, 0.0, mode, state)
        right_right = rises + right_lever * self.rotation_change(k)
        rises, slides = self.impulse_response(k, 0.0, 0.0, 1.0, mode, state)
        left_along = rises + left_lever * self.rotation_change(k)
        right_along = rises + right_lever * self.rotation_change(k)
        gain_left = -(1.0 - base.rebound(True)) * min(line.left_speed, 0.0)
        gain_right = -(1.0 - base.rebound(False)) * min(line.right_speed, 0.0)
        determinant = left_left * right_right - mixed * mixed
        # impulses without friction, and their reduction by a unit impulse along the base
        left = (right_right * gain_left - mixed * gain_right) / determinant
        right = (left_left * gain_right - mixed * gain_left) / determinant
        left_less = (right_right * left_along - mixed * right_along) / determinant
        right_less = (left_left * right_along - mixed * left_along) / determinant
        press, less = left + right, left_less + right_less
        if press <= 0.0:
            return 0
        # both grow in one proportion, and count as one impulse, their sum
        slides_with = (slides_left * left + slides_right * right) / press
        slides += slides_with * less - slides_left * left_less - slides_right * right_less
        along, _ = coulomb_impulse(
            ImpulseResponse(1.0, less, slides_with, slides), slip, -press,
            self.friction_coefficient(k, IMPULSIVE),
        )  # fmt: skip
        left, right = left - left_less * along, right - right_less * along
        if left < 0.0:
            return RIGHT_ONLY
        if right < 0.0:
            return LEFT_ONLY
        self.apply_base_impulses(
            k, left + right, left * left_lever + right * right_lever, along, slip, mode, state
        )
        return 0

    @kernel
    def apply_base_impulses(
        self, k: int, press: float, moment: float, along: float, slip: float, mode: int,
        state: Vector,
    ) -> None:  # fmt: skip
        """Change the velocities by the impulses of a base; a slip that they end becomes zero."""
        self.impulse_response(k, press, moment, along, mode, state)
        self.apply_response(state)
        self.record_impulse(k, press, moment, along)
        after, noise = self.slip_rate(k, mode, state)
        if abs(after) <= noise + 2.0 * SPEED_ROUNDING * abs(slip):
            self.stop_slip(k, mode, state)

    @inlined
    def rotation_change(self, k: int) -> float:
        """Return the change of a body's angular velocity in the last response."""
        return float(self.slopes()[BEFORE_HORIZONTAL * k + ROTATION])

    @kernel
    def impulse_response(
        self, k: int, press: float, moment: float, along: float, mode: int, state: Vector
    ) -> tuple[float, float]:
        """Return the changes of its body's rate of rise and of slip by impulses of a base.

        The changes of all velocities are in `slopes` until the next solution.
        """
        work, out = self.workspace(), self.slopes()
        write_kinematics(self, mode, state, work)
        set_inertia_loads(self, 0.0, 0.0, work)
        add_base_load(self, k, press, moment, work)
        add_tangential_load(self, k, along, work)
        self.solve_response(k, mode, 0.0, state)
        rotation = out[BEFORE_HORIZONTAL * k + ROTATION]
        slides = out[self.horizontal_of(k)] - work[k * BODY_STRIDE + at.PIVOT_ARM] * rotation
        return out[BEFORE_HORIZONTAL * k + VERTICAL], slides

    @kernel
    def reverses_immediately(
        self, k: int, left: bool, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> bool:
        """Whether an end that has lifted off returns immediately, or one that has landed leaves."""
        event = memory[LAST_EVENT]
        speed, noise = end_speed(self.on_base(k), left, self.state_of(k, state))
        if event not in (SEPARATION, IMPACT) or abs(speed) > noise:
            return False
        rises = self.end_accelerations(k, mode, state, ground)
        rise = rises[0] if left else rises[1]
        return rise < 0.0 if event == SEPARATION else rise > 0.0

    @kernel
    def end_short_slip(
        self, k: int, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Hold a body whose decelerating slip on its deformable base is negligible.

        The rest of its slip is added to its position at once, and its velocity is set to zero.
        """
        body = self.on_base(k).body
        if not self.body_mode(mode, k).slides:
            return mode
        rate, noise = self.slip_rate(k, mode, state)
        # an impact may have reversed the slip since
        slips = self.with_slip_sense(mode, k, rate) if abs(rate) > noise else mode
        slope = self.find_forces(slips, state, ground)
        guards = self.slip_guards(k, slips, state, slope, 0.0, 1.0)
        slows = -guards.slip_rate * math.sqrt(body.gravity * body.size())
        if rate * rate >= 2.0 * slows * REST_AMPLITUDE * body.size():
            return mode
        kinetic = self.energies_of_bodies(slips, state).kinetic
        state[self.horizontal_of(k)] += 0.5 * rate * abs(rate) / slows  # the slip until it stops
        # an impulse of its base stops it, without friction of slips elsewhere
        _, slides = self.impulse_response(k, 0.0, 0.0, 1.0, slips, state)
        self.impulse_response(k, 0.0, 0.0, -rate / slides, slips, state)
        self.add_velocity_changes(state)
        new = self.with_slip(k, 0.0, slips, state, memory)
        memory[IMPACT_LOSS] += kinetic - self.energies_of_bodies(new, state).kinetic
        return new

    @kernel
    def with_intermediate_contact(
        self, k: int, left: bool, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Return the mode after an end has lifted off, or touches again, and the held point moved.

        If the new forces would reverse the switch immediately, the end gets the contact state
        between the two.
        """
        part, body_mode, event = self.on_base(k), self.body_mode(mode, k), memory[LAST_EVENT]
        if event not in (SEPARATION, REENGAGEMENT) or part.flies(body_mode.contact):
            return mode
        rises = self.end_accelerations(k, mode, state, ground)
        line = with_accelerations(
            part.body.base_line_at(self.state_of(k, state)), rises[0], rises[1]
        )
        grows = part.base.will_press(left, line, ())
        contact = body_mode.contact
        if event == SEPARATION and grows and part.base.presses(contact, left, line, ()):
            contact = part.base.with_end(contact, left, LEAVING)
        elif event == REENGAGEMENT and not grows:
            contact = part.base.with_end(contact, left, ENGAGING)
        return self.with_body_mode(mode, k, Mode(contact, body_mode.pivot, body_mode.slides))
