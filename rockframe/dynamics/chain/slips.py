"""How far and how fast the bodies of a chain slip on their bases, and what is remembered of it.

Of each base the point that the rule of restraint names, or the corner that bears, slips or is held.
Which of the two stands in the mode, with the sense of the slip.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from rockframe.compiled import Vector, inlined, kernel, stretch
from rockframe.dynamics import events
from rockframe.dynamics.chain.rows import COLUMNS, MODES
from rockframe.dynamics.chain.system import Chain
from rockframe.dynamics.events import SILENT
from rockframe.dynamics.on_base import Mode
from rockframe.dynamics.protocol import MOST_MODES, Ending
from rockframe.dynamics.sliding import NOISE

STATIC: Final = 0
KINETIC: Final = 1
IMPULSIVE: Final = 2  # in impacts
FRICTIONS: Final = 3
"""Coefficients of each body behind the lists of a chain, then its slip and the rate of that."""
SLIP_COLUMNS: Final = 2

OFFSET: Final = 0  # of the slip from the place of the point that is held
PEAK_LEFT: Final = 1
PEAK_RIGHT: Final = 2
KEPT: Final = 3
"""What is remembered of the slip of each body, behind what a chain remembers."""

ROUNDING: Final = 1e-12
"""Accelerations over gravity that are rounding."""


class SlippingBodies(Chain):
    """Bodies upon one another of which some may slip on their bases. A mixin of systems."""

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
        return self.behind_events() + KEPT * k

    @inlined
    def link_place(self) -> int:
        """Give the place of the last event's link in the memory of a chain that has links."""
        return self.kept(self.body_count)

    @inlined
    def keep_peaks(self, mode: int, state: Vector, memory: Vector) -> None:
        """Remember how far the bodies have slipped, if that is farther than before."""
        for k in range(self.body_count):
            slip, first = self.slip_of(k, mode, state, memory), self.kept(k)
            memory[first + PEAK_LEFT] = max(memory[first + PEAK_LEFT], -slip)
            memory[first + PEAK_RIGHT] = max(memory[first + PEAK_RIGHT], slip)

    @kernel
    def slip_of(self, k: int, mode: int, state: Vector, memory: Vector) -> float:
        """Give how far a body has slipped on its base."""
        return float(memory[self.kept(k) + OFFSET]) + self.point_of(k, mode, state, memory)

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


def coefficients(frictions: Sequence[tuple[float, float, float]]) -> Vector:
    """Give the coefficients of friction of all bases, and room for what is shown of their slips."""
    count = len(frictions)
    if (2 * MODES) ** count > MOST_MODES:
        msg = f"a chain of {count} bodies that slip has more modes than can be numbered"
        raise ValueError(msg)
    return np.concatenate([np.ravel(frictions), np.zeros((COLUMNS + SLIP_COLUMNS) * count)])
