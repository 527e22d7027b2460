"""Slip of the bodies of a chain on their bases: its rate, guards, memory and columns.

The point of a base that the rule of restraint names, or the corner that bears, slips or is held.
The mode says which, and the sense of the slip.
"""

import math
from typing import Final

from rockframe.compiled import Vector, inlined, kernel
from rockframe.dynamics import events
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, ROTATION
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.impact import ROUNDING
from rockframe.dynamics.chain.motion import add_tangential_load
from rockframe.dynamics.chain.rows import BODY_STRIDE, COLUMNS
from rockframe.dynamics.chain.system import Chain
from rockframe.dynamics.events import SILENT
from rockframe.dynamics.on_base import SPEED_ROUNDING, Mode, SlidingGuards
from rockframe.dynamics.protocol import HELD_PLACE, Ending, Slope

# coefficients of friction [1]
STATIC: Final = 0
KINETIC: Final = 1
IMPULSIVE: Final = 2  # in impacts
FRICTION_STRIDE: Final = 3
"""Coefficients of each body, behind the array of the chain."""
SLIP_COLUMNS: Final = 2  # slip and its rate

OFFSET: Final = 0  # slip less the place of the held point [m]
PEAK_LEFT: Final = 1  # largest slip so far [m]
PEAK_RIGHT: Final = 2
SLIP_MEMORY: Final = 3
"""Numbers of the slip of each body in the memory, behind those of the chain."""

MAX_SLIP_CHANGES: Final = 6
"""Changes of the slips, for each body, after which a search changes its method or stops."""


class SlippingBodies(Chain):
    """Stacked bodies, some of which may slip on their bases. A mixin of systems."""

    __slots__ = ()

    @inlined
    def friction_coefficient(self, k: int, which: int) -> float:
        """Return a coefficient of friction under a body."""
        return float(self.rows[self.workspace_end() + FRICTION_STRIDE * k + which])

    @inlined
    def bodies_end(self) -> int:
        """Return the index behind all that belongs to the bodies."""
        return self.workspace_end() + FRICTION_STRIDE * self.body_count

    @inlined
    def body_column_count(self) -> int:
        """Return the number of columns of all bodies, their bases and slips."""
        return (COLUMNS + SLIP_COLUMNS) * self.body_count

    @kernel
    def modes(self) -> int:
        """Return the number of modes: of contacts and pivots, and of the senses of slips."""
        return int(self.body_mode_count() * 2**self.body_count)

    @inlined
    def sense(self, mode: int, k: int) -> float:
        """Return the sense of the slip of a body that slips."""
        return -1.0 if mode // self.body_mode_count() // 2**k % 2 == 1 else 1.0

    @inlined
    def with_slip_sense(self, mode: int, k: int, sense: float) -> int:
        """Return the mode in which a body slips to the right (1) or left (-1)."""
        was, value = self.body_mode(mode, k), self.body_mode_count() * 2**k
        new = self.with_body_mode(mode, k, Mode(was.contact, was.pivot, True))
        new -= new // value % 2 * value
        return new + value if sense < 0.0 else new

    @inlined
    def slip_rate(self, k: int, mode: int, state: Vector) -> tuple[float, float]:
        """Return the velocity of slip of the point named by the mode, and its rounding noise."""
        return self.pivot_slip_rate(k, self.body_mode(mode, k).pivot, state)

    @kernel
    def pivot_slip_rate(self, k: int, pivot: int, state: Vector) -> tuple[float, float]:
        """Return the velocity of slip of a point of a base, and its rounding noise."""
        law, body = self.on_base(k).body, self.state_of(k, state)
        about = law.reach_about(pivot, body.rotation).derivative * body.angular_velocity
        sway = body.horizontal_velocity
        return sway - about, SPEED_ROUNDING * (abs(sway) + abs(about))

    @inlined
    def contact_point(self, k: int, mode: int, state: Vector, memory: Vector) -> float:
        """Return the place along the base of the point that is held, or slips."""
        law, rotation = self.on_base(k).body, self.state_of(k, state).rotation
        away = law.from_pivot(self.body_mode(mode, k).pivot, rotation)
        return self.centre_position(k, mode, state, memory) - away

    @inlined
    def slip_memory(self, k: int) -> int:
        """Return the index in the memory of the first number of a body's slip."""
        return self.event_memory_end() + SLIP_MEMORY * k

    @inlined
    def update_peak_slips(self, mode: int, state: Vector, memory: Vector) -> None:
        """Update the largest slips of all bodies in contact."""
        for k in range(self.body_count):
            if self.on_base(k).flies(self.body_mode(mode, k).contact):
                continue
            slip, first = self.slip_of(k, mode, state, memory), self.slip_memory(k)
            memory[first + PEAK_LEFT] = max(memory[first + PEAK_LEFT], -slip)
            memory[first + PEAK_RIGHT] = max(memory[first + PEAK_RIGHT], slip)

    @kernel
    def slip_of(self, k: int, mode: int, state: Vector, memory: Vector) -> float:
        """Return the slip of a body on its base [m]."""
        offset = float(memory[self.slip_memory(k) + OFFSET])
        return offset + self.contact_point(k, mode, state, memory)

    @inlined
    def slip_event(self, k: int, old: int, new: int) -> int:
        """Return the kind of event by which a body's slip changes, or its contact by friction."""
        part, old_mode, new_mode = self.on_base(k), self.body_mode(old, k), self.body_mode(new, k)
        if part.flies(new_mode.contact):
            return events.SEPARATION
        if old_mode.slides != new_mode.slides:
            return events.SLIP if new_mode.slides else events.STICK
        if new_mode.slides and self.sense(old, k) != self.sense(new, k):
            return events.REVERSAL
        stands = part.contact_state(old_mode) == part.contact_state(new_mode)
        return SILENT if stands else events.UPLIFT

    @inlined
    def is_slippery(self, k: int) -> bool:
        """Whether a body may slip on a deformable base."""
        return not self.is_rigid(k) and self.friction_coefficient(k, STATIC) < math.inf

    @inlined
    def apply_friction_load(self, k: int, mode: int, work: Vector) -> None:
        """Load a body that slips on a deformable base by its friction."""
        if self.is_slippery(k) and self.body_mode(mode, k).slides:
            self.set_friction_load(k, self.sense(mode, k), work)

    @kernel
    def set_friction_load(self, k: int, sense: float, work: Vector) -> None:
        """Set the kinetic friction among a body's loads, for a sense of slip.

        The normal force of springs and dashpots is known, so is friction, :eq:`eq-mixed-slips`.
        """
        i = k * BODY_STRIDE
        drag = -sense * self.friction_coefficient(k, KINETIC) * max(work[i + at.NORMAL_FORCE], 0.0)
        add_tangential_load(self, k, drag - work[i + at.FRICTION_LOAD], work)
        work[i + at.FRICTION_LOAD] = drag

    @kernel
    def slip_guards(
        self, k: int, mode: int, state: Vector, slope: Slope, press: float, size: float
    ) -> SlidingGuards:
        """Return the guards of a body's friction, over the force `size`, and of its slip."""
        body_mode, body = self.body_mode(mode, k), self.state_of(k, state)
        if not body_mode.slides:
            hold = self.friction_coefficient(k, STATIC) * max(press, 0.0)
            hold -= abs(self.workspace()[k * BODY_STRIDE + at.TANGENTIAL_FORCE])
            return SlidingGuards(hold / size, 1.0, 0.0)
        law, sense, rate = self.on_base(k).body, self.sense(mode, k), body.angular_velocity
        reach = law.reach_about(body_mode.pivot, body.rotation)
        scale = 1.0 / math.sqrt(law.gravity * law.size())
        change = slope[self.horizontal_of(k)] - reach.second_derivative * rate * rate
        change -= reach.derivative * slope[BEFORE_HORIZONTAL * k + ROTATION]
        sway, rotating = body.horizontal_velocity, reach.derivative * rate
        # rounding must not stop a slip that starts or is very slow
        slip = scale * (sense * (sway - rotating) + SPEED_ROUNDING * (abs(sway) + abs(rotating)))
        noise = self.friction_noise(k, self.friction_coefficient(k, KINETIC))
        least = noise / self.row_value(k, at.MASS)
        return SlidingGuards(1.0, slip, scale * (sense * change + least))

    @inlined
    def friction_noise(self, k: int, friction: float) -> float:
        """Return the rounding noise of the friction force of a base.

        It comes from forces of the size of the weight above, and from the friction force itself.
        """
        mass = 0.0
        for j in range(k + 1):
            mass += self.row_value(j, at.MASS)
        thrust = abs(self.workspace()[k * BODY_STRIDE + at.TANGENTIAL_FORCE])
        weight = mass * self.row_value(k, at.GRAVITY)
        return ROUNDING * thrust + (ROUNDING + SPEED_ROUNDING * friction) * weight

    @kernel
    def resume_slips(self, mode: int, state: Vector, memory: Vector) -> int:
        """Return the mode in which released bodies on deformable bases slip, or are held again.

        Those without velocity of slip are held; the bound of friction is not checked here.
        """
        for k in range(self.body_count):
            if self.is_slippery(k) and self.body_mode(mode, k).slides:
                rate, noise = self.slip_rate(k, mode, state)
                sense = math.copysign(1.0, rate) if abs(rate) > noise else 0.0
                mode = self.with_slip(k, sense, mode, state, memory)
        return mode

    @kernel
    def with_slip(self, k: int, sense: float, mode: int, state: Vector, memory: Vector) -> int:
        """Return the mode in which a body slips in a sense, or is held if the sense is 0."""
        body_mode = self.body_mode(mode, k)
        if sense != 0.0:
            return self.with_slip_sense(self.release(k, mode, state, memory), k, sense)
        if body_mode.slides:
            self.stop_slip(k, mode, state)
            point = self.contact_point(k, mode, state, memory)
            mode = self.with_body_mode(mode, k, Mode(body_mode.contact, body_mode.pivot, False))
            memory[HELD_PLACE + k] = point
        return mode

    @kernel
    def release_all(self, mode: int, state: Vector, memory: Vector) -> int:
        """Release bodies that friction holds on deformable bases; return the new mode.

        Their friction is finite, and has no impulse in an impact elsewhere.
        """
        for k in range(self.body_count):
            if self.is_slippery(k):
                mode = self.release(k, mode, state, memory)
        return mode

    @kernel
    def release(self, k: int, mode: int, state: Vector, memory: Vector) -> int:
        """Release a held body along its base; return the mode in which it may move."""
        part, was = self.on_base(k), self.body_mode(mode, k)
        if part.is_free(was):
            return mode
        place, body = self.centre_position(k, mode, state, memory), self.state_of(k, state)
        self.set_horizontal(
            k, place, part.horizontal_velocity(was, body, part.body.attitude(body.rotation)), state
        )
        return self.with_body_mode(mode, k, Mode(was.contact, was.pivot, True))

    @kernel
    def stop_slip(self, k: int, mode: int, state: Vector) -> None:
        """Set the velocity of a body so that its point does not slip."""
        rate, _ = self.slip_rate(k, mode, state)
        state[self.coordinates() + self.horizontal_of(k)] -= rate

    @inlined
    def write_slip_columns(
        self, k: int, mode: int, state: Vector, memory: Vector, out: Vector
    ) -> None:
        """Write slip and rate of slip of a body, behind the columns of all bodies."""
        j = COLUMNS * self.body_count + SLIP_COLUMNS * k
        out[j] = self.slip_of(k, mode, state, memory)
        moves = self.on_base(k).is_free(self.body_mode(mode, k))
        out[j + 1] = self.slip_rate(k, mode, state)[0] if moves else 0.0

    def slip_range(self, k: int, ending: Ending) -> tuple[float, float, float]:
        """Return slip at the end of a run, and largest slips to the left and right [m]."""
        mode, state, memory = ending.mode, ending.state, ending.memory.copy()
        self.update_peak_slips(mode, state, memory)
        slips = memory[self.slip_memory(k) :]
        residual = self.slip_of(k, mode, state, memory)
        return residual, float(slips[PEAK_LEFT]), float(slips[PEAK_RIGHT])
