"""Slip of the bodies of a chain on their bases: its rate, guards, memory and columns.

The point of a base that the rule of restraint names, or the corner that bears, slips or is held.
The mode says which, and the sense of the slip.
"""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from rockframe.compiled import Vector, inlined, kernel, view_of
from rockframe.dynamics import events
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, ROTATION
from rockframe.dynamics.chain import rows as at
from rockframe.dynamics.chain.motion import load_along
from rockframe.dynamics.chain.rows import COLUMNS, PLACES
from rockframe.dynamics.chain.system import Chain
from rockframe.dynamics.events import SILENT
from rockframe.dynamics.on_base import Mode, SlidingGuards
from rockframe.dynamics.protocol import HELD_PLACE, Ending, Slope
from rockframe.dynamics.sliding import SPEED_ROUNDING

# coefficients of friction [1]
STATIC: Final = 0
KINETIC: Final = 1
IMPULSIVE: Final = 2  # in impacts
FRICTIONS: Final = 3
"""Coefficients of each body, behind the array of the chain; the room for columns follows."""
SLIP_COLUMNS: Final = 2  # slip and its rate

OFFSET: Final = 0  # slip less the place of the held point [m]
PEAK_LEFT: Final = 1  # largest slip so far [m]
PEAK_RIGHT: Final = 2
KEPT: Final = 3
"""Numbers of the slip of each body in the memory, behind those of the chain."""

ROUNDING: Final = 1e-12
"""Rounding noise of accelerations over gravity [1]."""
TRIES: Final = 6
"""Changes of the slips, for each body, after which a search changes its method or stops."""


class SlippingBodies(Chain):
    """Stacked bodies, some of which may slip on their bases. A mixin of systems."""

    __slots__ = ()

    @inlined
    def friction_of(self, k: int, which: int) -> float:
        """Return a coefficient of friction under a body."""
        return float(self.rows[self.behind_chain() + FRICTIONS * k + which])

    @inlined
    def column_room(self) -> Vector:
        """Return the room for columns."""
        first = self.behind_chain() + FRICTIONS * self.body_count
        return view_of(self.rows, first, (COLUMNS + SLIP_COLUMNS) * self.body_count)

    @inlined
    def behind_friction(self) -> int:
        """Return the index behind the coefficients of friction and the columns."""
        count = self.body_count
        return self.behind_chain() + (FRICTIONS + COLUMNS + SLIP_COLUMNS) * count

    @kernel
    def modes(self) -> int:
        """Return the number of modes: of contacts and pivots, and of the senses of slips."""
        return int(self.modes_of_bodies() * 2**self.body_count)

    @inlined
    def sense(self, mode: int, k: int) -> float:
        """Return the sense of the slip of a body that slips."""
        return -1.0 if mode // self.modes_of_bodies() // 2**k % 2 == 1 else 1.0

    @inlined
    def slipping(self, mode: int, k: int, sense: float) -> int:
        """Return the mode in which a body slips in a sense."""
        was, value = self.body_mode(mode, k), self.modes_of_bodies() * 2**k
        new = self.with_body_mode(mode, k, Mode(was.contact, was.pivot, True))
        new -= new // value % 2 * value
        return new + value if sense < 0.0 else new

    @inlined
    def slip_rate(self, k: int, mode: int, state: Vector) -> tuple[float, float]:
        """Return the velocity of slip of the point named by the mode, and its rounding noise."""
        return self.slip_on(k, self.body_mode(mode, k).pivot, state)

    @kernel
    def slip_on(self, k: int, pivot: int, state: Vector) -> tuple[float, float]:
        """Return the velocity of slip of a point of a base, and its rounding noise."""
        part, body = self.on_base(k), self.state_of(k, state)
        pin = part.body.pin(pivot)
        about = (
            part.body.reach(pin, part.body.attitude(body.rotation)).derivative
            * body.angular_velocity
        )
        sway = body.horizontal_velocity
        return sway - about, SPEED_ROUNDING * (abs(sway) + abs(about))

    @inlined
    def point_of(self, k: int, mode: int, state: Vector, memory: Vector) -> float:
        """Return the place along the base of the point that is held, or slips."""
        part, body = self.on_base(k), self.state_of(k, state)
        pin = part.body.pin(self.body_mode(mode, k).pivot)
        attitude = part.body.attitude(body.rotation)
        return self.centre_position(k, mode, state, memory) - part.body.about_pin(pin, attitude)

    @inlined
    def kept(self, k: int) -> int:
        """Return the index in the memory of the first number of a body's slip."""
        return self.behind_events() + KEPT * k

    @inlined
    def link_place(self) -> int:
        """Return the index in the memory of the last event's link, in a chain with links."""
        return self.kept(self.body_count)

    @inlined
    def keep_peaks(self, mode: int, state: Vector, memory: Vector) -> None:
        """Update the largest slips of all bodies in contact."""
        for k in range(self.body_count):
            if self.on_base(k).flies(self.body_mode(mode, k).contact):
                continue
            slip, first = self.slip_of(k, mode, state, memory), self.kept(k)
            memory[first + PEAK_LEFT] = max(memory[first + PEAK_LEFT], -slip)
            memory[first + PEAK_RIGHT] = max(memory[first + PEAK_RIGHT], slip)

    @kernel
    def slip_of(self, k: int, mode: int, state: Vector, memory: Vector) -> float:
        """Return the slip of a body on its base [m]."""
        return float(memory[self.kept(k) + OFFSET]) + self.point_of(k, mode, state, memory)

    @inlined
    def kind_of(self, k: int, old: int, new: int) -> int:
        """Return the kind of event by which a body starts, stops or reverses its slip."""
        slipped, slips = self.body_mode(old, k).slides, self.body_mode(new, k).slides
        if not slips:
            return events.STICK if slipped else SILENT
        if not slipped:
            return events.SLIP
        return SILENT if self.sense(old, k) == self.sense(new, k) else events.REVERSAL

    @inlined
    def is_slippery(self, k: int) -> bool:
        """Whether a body may slip on a deformable base."""
        return not self.is_rigid(k) and self.friction_of(k, STATIC) < math.inf

    @inlined
    def load_by_friction(self, k: int, mode: int, room: Vector) -> None:
        """Load a body that slips on a deformable base by its friction."""
        if self.is_slippery(k) and self.body_mode(mode, k).slides:
            self.drag(k, self.sense(mode, k), room)

    @kernel
    def drag(self, k: int, sense: float, room: Vector) -> None:
        """Replace the friction among a body's loads by that of a slip in a sense.

        The normal force of springs and dashpots is known, so is friction, :eq:`eq-mixed-slips`.
        """
        i = k * PLACES
        drag = -sense * self.friction_of(k, KINETIC) * max(room[i + at.PRESS], 0.0)
        load_along(self, k, drag - room[i + at.DRAG], room)
        room[i + at.DRAG] = drag

    @kernel
    def guards_of_slip(
        self, k: int, mode: int, state: Vector, slope: Slope, press: float, size: float
    ) -> SlidingGuards:
        """Return the guards of a body's friction, over the force `size`, and of its slip."""
        standing, body = self.body_mode(mode, k), self.state_of(k, state)
        if not standing.slides:
            hold = self.friction_of(k, STATIC) * max(press, 0.0)
            hold -= abs(self.places()[k * PLACES + at.THRUST])
            return SlidingGuards(hold / size, 1.0, 0.0)
        law, sense, rate = self.on_base(k).body, self.sense(mode, k), body.angular_velocity
        reach = law.reach(law.pin(standing.pivot), law.attitude(body.rotation))
        scale = 1.0 / math.sqrt(law.gravity * law.size())
        change = slope[self.horizontal_of(k)] - reach.second_derivative * rate * rate
        change -= reach.derivative * slope[BEFORE_HORIZONTAL * k + ROTATION]
        sway, rotating = body.horizontal_velocity, reach.derivative * rate
        # rounding must not stop a slip that starts or is very slow
        slip = scale * (sense * (sway - rotating) + SPEED_ROUNDING * (abs(sway) + abs(rotating)))
        least = self.rounding(k, self.friction_of(k, KINETIC)) / self.number(k, at.MASS)
        return SlidingGuards(1.0, slip, scale * (sense * change + least))

    @inlined
    def rounding(self, k: int, friction: float) -> float:
        """Return the rounding noise of the friction force of a base.

        It comes from forces of the size of the weight above, and from the friction force itself.
        """
        mass = 0.0
        for j in range(k + 1):
            mass += self.number(j, at.MASS)
        thrust = abs(self.places()[k * PLACES + at.THRUST])
        weight = mass * self.number(k, at.GRAVITY)
        return ROUNDING * thrust + (ROUNDING + SPEED_ROUNDING * friction) * weight

    @kernel
    def go_on(self, mode: int, state: Vector, memory: Vector) -> int:
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
        """Return the mode in which a body slips in a sense, or, with 0, is held."""
        standing = self.body_mode(mode, k)
        if sense != 0.0:
            return self.slipping(self.let_go(k, mode, state, memory), k, sense)
        if standing.slides:
            self.end_slip(k, mode, state)
            point = self.point_of(k, mode, state, memory)
            mode = self.with_body_mode(mode, k, Mode(standing.contact, standing.pivot, False))
            memory[HELD_PLACE + k] = point
        return mode

    @kernel
    def let_all_go(self, mode: int, state: Vector, memory: Vector) -> int:
        """Release bodies that friction holds on deformable bases; return the new mode.

        Their friction is finite, and has no impulse in an impact elsewhere.
        """
        for k in range(self.body_count):
            if self.is_slippery(k):
                mode = self.let_go(k, mode, state, memory)
        return mode

    @kernel
    def let_go(self, k: int, mode: int, state: Vector, memory: Vector) -> int:
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
    def end_slip(self, k: int, mode: int, state: Vector) -> None:
        """Set the velocity of a body so that its point does not slip."""
        rate, _ = self.slip_rate(k, mode, state)
        state[self.coordinates() + self.horizontal_of(k)] -= rate

    @inlined
    def observe_slip(self, k: int, mode: int, state: Vector, memory: Vector, out: Vector) -> None:
        """Write slip and rate of slip of a body, behind the columns of all bodies."""
        j = COLUMNS * self.body_count + SLIP_COLUMNS * k
        out[j] = self.slip_of(k, mode, state, memory)
        moves = self.on_base(k).is_free(self.body_mode(mode, k))
        out[j + 1] = self.slip_rate(k, mode, state)[0] if moves else 0.0

    def slips(self, k: int, ending: Ending) -> tuple[float, float, float]:
        """Return slip at the end of a run, and largest slips to the left and right [m]."""
        mode, state, memory = ending.mode, ending.state, ending.memory.copy()
        self.keep_peaks(mode, state, memory)
        kept = memory[self.kept(k) :]
        residual = self.slip_of(k, mode, state, memory)
        return residual, float(kept[PEAK_LEFT]), float(kept[PEAK_RIGHT])


def coefficients(frictions: Sequence[tuple[float, float, float]]) -> Vector:
    """Return the coefficients of friction of all bases, then the room for columns."""
    room = (COLUMNS + SLIP_COLUMNS) * len(frictions)
    return np.concatenate([np.ravel(frictions), np.zeros(room)])
