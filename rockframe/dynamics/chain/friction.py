"""A chain of bodies on deformable bases, all of which may slip, :eq:`eq-slip-on-base`."""

import math

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics.base import Guards
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, ROTATION, VERTICAL
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.impact import NEARLY_ZERO
from rockframe.dynamics.chain.rows import GUARDS, PLACES
from rockframe.dynamics.chain.slippery import SlipperyBases
from rockframe.dynamics.chain.slips import KINETIC, OFFSET, STATIC, TRIES
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
        part, standing, body = self.on_base(k), self.body_mode(mode, k), self.state_of(k, state)
        first, press, sliding = BEFORE_HORIZONTAL * k, k * PLACES + at.PRESS, IDLE_GUARDS
        if k == 0:
            self.forces_from(mode, state, slope, ground)
        if not part.flies(standing.contact):
            sliding = self.guards_of_slip(
                k, mode, state, slope, self.places()[press], part.body.gravity
            )
        bears = Mode(standing.contact, standing.pivot, False)
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
        point = self.point_of(k, mode, state, memory)
        self.keep_peaks(mode, state, memory)
        memory[HELD_PLACE + self.body_count] = k + 1.0
        if slip in (HOLD, SLIP):
            new = self.let_go(k, mode, state, memory)
            if slip == SLIP:
                self.end_slip(k, new, state)
        else:
            new = self.switch_slippery(k, which, mode, state, ground, memory)
            if which < 2 * CORNER_GUARDS and memory[LAST_EVENT] == SILENT:
                return new
        memory[self.kept(k) + OFFSET] += point - self.point_of(k, new, state, memory)
        self.keep_peaks(new, state, memory)
        new = self.go_on(new, state, memory)
        new = self.let_slip(k if slip == HOLD else -1, new, state, ground, memory)
        if slip in (HOLD, SLIP):
            memory[LAST_EVENT] = self.kind_of(k, mode, new)
            if new == mode:
                new = self.end_short_slips(new, state, ground, memory)
        elif which < 2 * CORNER_GUARDS:
            left = which < CORNER_GUARDS
            if memory[LAST_EVENT] == IMPACT:
                stop_negligible_rebound(self, self.on_base(k), k, left, new, state, ground, memory)
            if self.reverses_at_once(k, left, new, state, ground, memory):
                new = self.end_short_slips(new, state, ground, memory)
            new = self.wait(k, left, new, state, ground, memory)
        return new

    @kernel
    def let_slip(
        self, lets_go: int, mode: int, state: Vector, ground: Ground, memory: Vector
    ) -> int:
        """Return the mode in which friction can hold all held bodies, and opposes other slips.

        Where no mode satisfies that with static friction, kinetic friction decides what is held.
        """
        most, near = TRIES * self.body_count, NEARLY_ZERO
        for tries in range(2 * most):
            slope = self.find_forces(mode, state, ground)
            self.forces_from(mode, state, slope, ground)
            holding = STATIC if tries < most else KINETIC
            found, push = self.held_in_vain(lets_go, holding, mode)
            if found >= 0:
                if tries > 0:  # a body let go at the limit of its friction has another force now
                    near = 0.0
                mode = self.let_go(found, mode, state, memory)
                mode = self.slipping(mode, found, -push)
            else:
                found = self.starts_back(near, mode, state, slope)
                if found < 0:
                    break
                mode = self.with_slip(found, 0.0, mode, state, memory)
            lets_go = -1
        return mode

    @kernel
    def end_short_slips(self, mode: int, state: Vector, ground: Ground, memory: Vector) -> int:
        """Return the mode in which bodies are held whose slip would stop after a negligible way."""
        for k in range(self.body_count):
            mode = self.end_short_slip(k, mode, state, ground, memory)
        return self.let_slip(-1, mode, state, ground, memory)

    @kernel
    def held_in_vain(self, lets_go: int, holding: int, mode: int) -> tuple[int, float]:
        """Return a body that friction `holding` cannot hold, or -1, and the force that would."""
        room = self.places()
        for j in range(self.body_count):
            if not self.on_base(j).is_free(self.body_mode(mode, j)):
                i, friction = j * PLACES, self.friction_of(j, holding)
                thrust, most = room[i + at.THRUST], friction * max(room[i + at.PRESS], 0.0)
                if j == lets_go or abs(thrust) > most + self.rounding(j, friction):
                    return j, float(thrust)
        return -1, 0.0

    @kernel
    def starts_back(self, near: float, mode: int, state: Vector, slope: Slope) -> int:
        """Return a body at the start of a slip whose acceleration is against its sense, or -1.

        Accelerations up to `near` times gravity do not count.
        """
        for j in range(self.body_count):
            part, standing = self.on_base(j), self.body_mode(mode, j)
            if standing.slides and not part.flies(standing.contact):
                rate, noise = self.slip_rate(j, mode, state)
                least = near * math.sqrt(part.body.gravity / part.body.size())
                found = self.guards_of_slip(j, mode, state, slope, 0.0, 1.0)
                if abs(rate) <= noise and found.slip_rate < -least:
                    return j
        return -1
