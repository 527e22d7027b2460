"""The lists of a chain as numbers: a row for each body with its base, and room to work in.

Bodies are counted from the top down. One machine code serves all chains, whatever their length and
their bases, since it reads both from here.
"""

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from rockframe.compiled import Vector, inlined, kernel, numbers_in, part_of, stretch
from rockframe.dynamics.base_numbers import BaseNumbers
from rockframe.dynamics.bed import Bed, Rigid
from rockframe.dynamics.bodies import DEGREES, InState
from rockframe.dynamics.body import BY_CONTACT, Body, BodyState
from rockframe.dynamics.chain.any_base import BASE_NUMBERS, ON_BED, ON_PADS, ON_RIGID, AnyBase
from rockframe.dynamics.on_base import BODY_GUARDS, Mode, OnBase
from rockframe.dynamics.pads import CORNER, CORNER_GUARDS, ElasticPads
from rockframe.dynamics.point_law import Viscoelastic
from rockframe.dynamics.protocol import POWERS, CalledBySteps

# a row: the body's numbers in their order in `Body`, among them
INERTIA: Final = 3
GRAVITY: Final = 4
# then
MASS: Final = 8  # over the mass that all is measured by
TOP: Final = 9  # of the body above its centre of mass; what stands on it stands there
BESIDE: Final = 10  # of the body's centre of mass from that of the one below, upright
PER_MASS: Final = 11
PER_INERTIA: Final = 12
PLACE_VALUE: Final = 13  # of its mode in that of the chain
LAW: Final = 14  # which law its base has
FORCE_SIZE: Final = 15  # of what its corners bear, by which rounding is known
MODE_COUNT: Final = 16  # of its modes
BASE: Final = 17  # numbers of that law
ROW: Final = BASE + BASE_NUMBERS

OBSERVED: Final = 3
"""Columns of a base, of which pads have two."""

# room to work in, behind the rows, for each body: geometry and rates of its contact
SINE: Final = 0  # of the rotation of what it stands on
COSINE: Final = 1
ACROSS: Final = 2  # its centre of mass along that, from the centre of mass of the body below
ARM: Final = 3  # and normal to it
SWAY: Final = 4  # rate of the former
RISE: Final = 5  # and of the latter
REACH: Final = 6  # of its centre of mass about the held point
DRIFT: Final = 7  # what that adds to the acceleration along what it stands on
FRAME_RATE: Final = 8  # angular velocity of what it stands on
RATE: Final = 9  # its own, relative to that
HELD: Final = 10  # whether a point is held
# velocity of its centre of mass, loads, and accelerations, in the axes of the ground
SPEED_X: Final = 11
SPEED_Y: Final = 12
LOAD_X: Final = 13
LOAD_Y: Final = 14
LOAD_MOMENT: Final = 15
X: Final = 16
Y: Final = 17
ROTATION: Final = 18
# forces of its base along and normal to what it stands on
THRUST: Final = 19
PRESS: Final = 20
# constraints of the corners on a rigid base, and their impulses in an event; impulses of all such
# bases on the body; those of its own base that gives way, where an end has landed: normal to it,
# their moment, and along it
LEFT_CORNER: Final = 21
RIGHT_CORNER: Final = 22
LEFT_IMPULSE: Final = 23
RIGHT_IMPULSE: Final = 24
IMPULSE_X: Final = 25
IMPULSE_Y: Final = 26
IMPULSE_MOMENT: Final = 27
BLOW: Final = 28
BLOW_MOMENT: Final = 29
BLOW_ALONG: Final = 30
IMPULSES: Final = 8
# of bodies that may slip on rigid bases: the sense that is tried, that in which a slip starts, and
# the force along the base over that normal to it
SLIPS: Final = 31
STARTS: Final = 32
RUBS: Final = 33
# of bodies that may slip at all: their friction among the loads, on a base that gives way; and the
# constraint that holds a body along its base, as that is tried
DRAG: Final = 34
HOLDS_ALONG: Final = 35
# of the left and the right corner on a rigid base, as sets of them are tried: the lever, the
# acceleration at which it rests, or change of its speed, and both along the base, held there
LEVERS: Final = 36
RESTS: Final = 38
REACHES: Final = 40
STAYS: Final = 42
# how the body stands in the mode that was read last, and that mode, in two numbers
CONTACT: Final = 44
PIVOT: Final = 45
SLIDES: Final = 46
HIGH_BITS: Final = 47
LOW_BITS: Final = 48
# sine, cosine and rise of its rotation on its base
ATTITUDE: Final = 49
# how it is tried with a set of corners, a number, and how many constraints it and those below have
TRIED: Final = 52
CONSTRAINTS: Final = 53
# whether the forces stand that were solved for last, for a mode, a state and a ground acceleration
SOLVED: Final = 54
PLACES: Final = 55

# constraints, at most so many of each body; of each
MOST_CONSTRAINTS: Final = 3
BODY: Final = 0  # the body
VALUE: Final = 1  # what is kept
FORCE: Final = 2
KEEPS: Final = 3  # the combination of accelerations, of the body and of the one below
HOLDS: Final = 9  # that of forces
LEFT: Final = 15  # of the value, by elimination
CONSTRAINT: Final = 16
# then their matrix, slopes, guards and their rates, velocities, columns, and what was solved for

GUARDS: Final = 2 * CORNER_GUARDS + BODY_GUARDS
"""Guards of each body."""
COLUMNS: Final = 14 + OBSERVED
"""What users see of each body and its base."""

CORNERS: Final = 5
"""States of a corner on its pad."""
ENDS: Final = 4
"""States of both ends on a bed, or of both corners on a rigid base."""
PIVOTS: Final = 3
HALF_OF_BITS: Final = 32
"""Of the number of a mode, each half of which a float holds exactly."""
PAD_MODES: Final = 2 * PIVOTS * CORNERS * CORNERS
BED_MODES: Final = 2 * PIVOTS * ENDS
RIGID_MODES: Final = 2 * 2 * ENDS  # what is held follows from the corners that bear


SOLVED_FOR: Final = 4
"""Both halves of a mode, and ground acceleration, before a state."""


@kernel
def room_of(count: int) -> int:
    """Give the size of the room behind the rows of some bodies."""
    each = PLACES + MOST_CONSTRAINTS * CONSTRAINT + 4 * DEGREES + 2 * GUARDS + COLUMNS
    return count * each + POWERS + (MOST_CONSTRAINTS * count) ** 2 + SOLVED_FOR


class Lists(NamedTuple):
    """The numbers of a chain."""

    body_count: int
    rows: Vector  # of all bodies; then room to work in


class Rows(InState, CalledBySteps, Lists):
    """What stands in the lists. A mixin of systems."""

    __slots__ = ()

    @inlined
    def bodies(self) -> int:
        """Give the number of bodies."""
        return self.body_count

    @inlined
    def number(self, k: int, which: int) -> float:
        """Give a number of a body's row."""
        return float(self.rows[k * ROW + which])

    @inlined
    def places(self) -> Vector:
        """Give the room for the places and forces of all bodies."""
        return stretch(self.rows, self.body_count * ROW, self.body_count * PLACES)

    @inlined
    def constraints(self) -> Vector:
        """Give the room for constraints."""
        width = MOST_CONSTRAINTS * CONSTRAINT
        return stretch(self.rows, self.body_count * (ROW + PLACES), self.body_count * width)

    @inlined
    def slopes(self) -> Vector:
        """Give the room for accelerations and powers."""
        return stretch(self.rows, self.after_constraints(), DEGREES * self.body_count + POWERS)

    @inlined
    def after_constraints(self) -> int:
        """Give the place behind the constraints."""
        return self.body_count * (ROW + PLACES + MOST_CONSTRAINTS * CONSTRAINT)

    @inlined
    def guard_room(self, which: int) -> Vector:
        """Give the room for guards (0) or their rates (1)."""
        first = self.after_constraints() + self.body_count * (DEGREES + which * GUARDS) + POWERS
        return stretch(self.rows, first, GUARDS * self.body_count)

    @inlined
    def velocity_room(self) -> Vector:
        """Give the room for velocities."""
        first = self.after_constraints() + self.body_count * (DEGREES + 2 * GUARDS) + POWERS
        return stretch(self.rows, first, DEGREES * self.body_count)

    @inlined
    def column_room(self) -> Vector:
        """Give the room for columns."""
        first = self.after_constraints() + self.body_count * (2 * DEGREES + 2 * GUARDS) + POWERS
        return stretch(self.rows, first, COLUMNS * self.body_count)

    @inlined
    def matrix(self) -> Vector:
        """Give the room for what constraints do to one another."""
        room = 2 * DEGREES + 2 * GUARDS + COLUMNS
        first = self.after_constraints() + self.body_count * room + POWERS
        return stretch(self.rows, first, (MOST_CONSTRAINTS * self.body_count) ** 2)

    @inlined
    def solved_room(self) -> Vector:
        """Give the room for mode, ground acceleration and state that forces were solved for."""
        first = self.behind_chain() - SOLVED_FOR - 2 * DEGREES * self.body_count
        return part_of(self.rows, first)

    @inlined
    def behind_chain(self) -> int:
        """Give the place behind all these rooms."""
        return self.body_count * ROW + room_of(self.body_count)

    @inlined
    def on_base(self, k: int) -> OnBase:
        """Give a body on its base."""
        r = part_of(self.rows, k * ROW)
        body = Body(r[0], r[1], r[2], r[3], r[4], r[5], int(r[6]), r[7] != 0.0)
        n = part_of(r, BASE)
        base = AnyBase(
            int(r[LAW]), n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8], n[9], n[10], n[11],
        )  # fmt: skip
        return OnBase(body, base)

    @inlined
    def standing_state(self, k: int, standing: Mode, state: Vector) -> BodyState:
        """Give placement and rates of a body as its contacts allow them."""
        return self.state_of(k, state)

    @inlined
    def modes_of_bodies(self) -> int:
        """Give the number of modes of all bodies together."""
        k = self.body_count - 1
        return int(self.number(k, PLACE_VALUE)) * int(self.number(k, MODE_COUNT))

    @inlined
    def part_mode(self, mode: int, k: int) -> Mode:
        """Give how a body stands; divisions are slow, so what was read last is kept."""
        room, i, high = self.places(), k * PLACES, mode >> HALF_OF_BITS
        low = mode - (high << HALF_OF_BITS)
        if room[i + HIGH_BITS] != high or room[i + LOW_BITS] != low:
            found = self.read_mode(mode, k)
            room[i + CONTACT], room[i + PIVOT] = found.contact, found.pivot
            room[i + SLIDES] = 1.0 if found.slides else 0.0
            room[i + HIGH_BITS], room[i + LOW_BITS] = high, low
        return Mode(int(room[i + CONTACT]), int(room[i + PIVOT]), room[i + SLIDES] != 0.0)

    @kernel
    def read_mode(self, mode: int, k: int) -> Mode:
        """Read how a body stands from the number of a mode."""
        number = mode // int(self.number(k, PLACE_VALUE)) % int(self.number(k, MODE_COUNT))
        if self.number(k, LAW) == ON_RIGID:
            ends, rest = number % ENDS, number // ENDS
            return Mode(ends + CORNER * (rest % 2), ends % PIVOTS, rest >= 2)
        both, standing = divmod(number, 2 * PIVOTS)
        contact = both % CORNERS + CORNER * (both // CORNERS)
        return Mode(contact, standing % PIVOTS, standing >= PIVOTS)

    @kernel
    def with_part(self, mode: int, k: int, part: Mode) -> int:
        """Give the mode in which a body stands otherwise."""
        value, modes = int(self.number(k, PLACE_VALUE)), int(self.number(k, MODE_COUNT))
        low, high = part.contact % CORNER, part.contact // CORNER
        if self.number(k, LAW) == ON_RIGID:
            number = low + ENDS * (high + (2 if part.slides else 0))
        else:
            number = part.pivot + (PIVOTS if part.slides else 0)
            number += 2 * PIVOTS * (low + CORNERS * high)
        return mode + value * (number - mode // value % modes)


def row_of(body: Body, base: BaseNumbers, mass: float, top: float, beside: float) -> Vector:
    """Give a body's row."""
    if isinstance(base.law, ElasticPads) and isinstance(base.law.law, Viscoelastic):
        law = ON_PADS
    elif isinstance(base.law, Rigid):
        law = ON_RIGID
    elif isinstance(base.law, Bed):
        law = ON_BED
    else:
        name = type(base.law).__name__
        msg = f"a chain of bodies stands on pads, on a bed or on rigid bases, got {name}"
        raise TypeError(msg)
    row = np.zeros(ROW)
    # a corner that bears on a rigid base does not slide on it, whatever the rule
    row[: len(body)] = body._replace(restraint=BY_CONTACT) if law == ON_RIGID else body
    row[[MASS, TOP, BESIDE, LAW, FORCE_SIZE]] = mass, top, beside, law, mass * body.gravity
    row[MODE_COUNT] = (PAD_MODES, BED_MODES, RIGID_MODES)[law]
    row[[PER_MASS, PER_INERTIA]] = 1.0 / mass, 1.0 / body.inertia
    numbers = numbers_in(base.law)
    row[BASE : BASE + len(numbers)] = numbers
    return row


def lists_of(rows: Sequence[Vector]) -> Lists:
    """Give the lists of bodies, from the top down, with room to work in."""
    count, value = len(rows), 1
    for row in rows:
        row[PLACE_VALUE] = value
        value *= int(row[MODE_COUNT])
    return Lists(count, np.concatenate([*rows, np.zeros(room_of(count))]))
