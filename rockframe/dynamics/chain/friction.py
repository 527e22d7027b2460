"""A chain of bodies on deformable bases, all of which may slip, :eq:`eq-slip-on-base`."""

import math

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.base import Guards
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, ROTATION, VERTICAL
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.impact import NEARLY_ZERO
from rockframe.dynamics.chain.rows import BODY_STRIDE, GUARDS
from rockframe.dynamics.chain.slippery import SlipperyBases
from rockframe.dynamics.chain.slips import KINETIC, MAX_SLIP_CHANGES, OFFSET, STATIC
from rockframe.dynamics.events import IMPACT, SILENT
from rockframe.dynamics.on_base import HOLD, IDLE_GUARDS, SLIP, Mode
from rockframe.dynamics.pads import CORNER_GUARDS
from rockframe.dynamics.protocol import HELD_PLACE, LAST_EVENT, Ground, Slope
from rockframe.dynamics.switching import stop_negligible_rebound


class SlippingChain(SlipperyBases):
    """Stacked bodies that friction holds on their bases: a system."""

    __slots__ = ()

    @inlined
    def is_slippery(self, k: int) -> bool:
        """Whether a body may slip on a deformable base: all do."""
        return True

    @kernel
    def guards_on_base(
        self, k: int, slides: bool, mode: int, state: Vector, slope: Slope, ground: Ground
    ) -> Guards:
        """Return the guards of a body: of contacts, of the friction that holds it, of its slip."""
        part, body_mode, body = self.on_base(k), self.body_mode(mode, k), self.state_of(k, state)
        first = BEFORE_HORIZONTAL * k
        press = k * BODY_STRIDE + at.NORMAL_FORCE
        sliding = IDLE_GUARDS
        if k == 0:
            self.forces_from_slope(mode, state, slope, ground)
        if not part.flies(body_mode.contact):
            sliding = self.slip_guards(
                k, mode, state, slope, self.workspace()[press], part.body.gravity
            )
        bears = Mode(body_mode.contact, body_mode.pivot, False)
        return part.guards_with(
            bears, body, (), slope[first + VERTICAL], slope[first + ROTATION], sliding
        )

    @kernel
    def switch_body(
        self, mode: int, guard: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Carry out the switch that a guard of a body calls for; return the new mode."""
        k = guard // GUARDS
        which, slip = guard - k * GUARDS, guard - k * GUARDS - 2 * CORNER_GUARDS
        point = self.contact_point(k, mode, state, memory)
        self.update_peak_slips(mode, state, memory)
        memory[HELD_PLACE + self.body_count] = k + 1.0
        if slip in (HOLD, SLIP):
            new = self.release(k, mode, state, memory)
            if slip == SLIP:
                self.stop_slip(k, new, state)
        else:
            new = self.switch_with_friction(k, which, mode, state, ground, memory)
            if which < 2 * CORNER_GUARDS and memory[LAST_EVENT] == SILENT:
                return new
        memory[self.slip_memory(k) + OFFSET] += point - self.contact_point(k, new, state, memory)
        self.update_peak_slips(new, state, memory)
        new = self.resume_slips(new, state, memory)
        new = self.find_consistent_slips(k if slip == HOLD else -1, new, state, ground, memory)
        if slip in (HOLD, SLIP):
            memory[LAST_EVENT] = self.slip_event(k, mode, new)
            if new == mode:
                new = self.end_short_slips(new, state, ground, memory)
        elif which < 2 * CORNER_GUARDS:
            left = which < CORNER_GUARDS
            if memory[LAST_EVENT] == IMPACT:
                stop_negligible_rebound(self, self.on_base(k), k, left, new, state, ground, memory)
            if self.reverses_immediately(k, left, new, state, ground, memory):
                new = self.end_short_slips(new, state, ground, memory)
            new = self.with_intermediate_contact(k, left, new, state, ground, memory)
        return new

    @kernel
    def find_consistent_slips(
        self, released: int, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Return the mode in which friction can hold all held bodies, and opposes other slips.

        If there is no such mode with static friction, kinetic friction decides what is held.
        """
        most, near = MAX_SLIP_CHANGES * self.body_count, NEARLY_ZERO
        for tries in range(2 * most):
            slope = self.find_forces(mode, state, ground)
            self.forces_from_slope(mode, state, slope, ground)
            coefficient = STATIC if tries < most else KINETIC
            slipping, push = self.overloaded_hold(released, coefficient, mode)
            if slipping >= 0:
                if tries > 0:  # a body released at the limit of its friction has another force now
                    near = 0.0
                mode = self.release(slipping, mode, state, memory)
                mode = self.with_slip_sense(mode, slipping, -push)
            else:
                slipping = self.reversed_start(near, mode, state, slope)
                if slipping < 0:
                    break
                mode = self.with_slip(slipping, 0.0, mode, state, memory)
            released = -1
        return mode

    @kernel
    def end_short_slips(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Return the mode in which bodies are held whose remaining slip is negligible."""
        for k in range(self.body_count):
            mode = self.end_short_slip(k, mode, state, ground, memory)
        return self.find_consistent_slips(-1, mode, state, ground, memory)

    @kernel
    def overloaded_hold(self, released: int, coefficient: int, mode: int) -> tuple[int, float]:
        """Return a body that friction cannot hold, or -1, and the force that would hold it."""
        work = self.workspace()
        for j in range(self.body_count):
            if not self.on_base(j).is_free(self.body_mode(mode, j)):
                i, friction = j * BODY_STRIDE, self.friction_coefficient(j, coefficient)
                thrust = work[i + at.TANGENTIAL_FORCE]
                most = friction * max(work[i + at.NORMAL_FORCE], 0.0)
                if j == released or abs(thrust) > most + self.friction_noise(j, friction):
                    return j, float(thrust)
        return -1, 0.0

    @kernel
    def reversed_start(self, near: float, mode: int, state: Vector, slope: Slope) -> int:
        """Return a body at the start of a slip whose acceleration is against its sense, or -1.

        Accelerations up to `near` times gravity do not count.
        """
        for j in range(self.body_count):
            part, body_mode = self.on_base(j), self.body_mode(mode, j)
            if body_mode.slides and not part.flies(body_mode.contact):
                rate, noise = self.slip_rate(j, mode, state)
                least = near * math.sqrt(part.body.gravity / part.body.size())
                guards = self.slip_guards(j, mode, state, slope, 0.0, 1.0)
                if abs(rate) <= noise and guards.slip_rate < -least:
                    return j
        return -1
