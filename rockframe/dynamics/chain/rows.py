"""The array of a chain of bodies: a row of data for each body with its base, and a workspace.

Bodies are counted from the top down. The same machine code serves all chains, whatever their
number of bodies and their bases, since it reads both from this array. Masses, inertias and forces
are over the reference mass of the model, the one that "per unit mass" means.
"""

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from rockframe.compiled import Vector, inlined, kernel, numbers_in, view_from, view_of
from rockframe.dynamics.base_numbers import BaseNumbers
from rockframe.dynamics.bed import Bed, Rigid
from rockframe.dynamics.bodies import BODY_DOF, StateAccess
from rockframe.dynamics.body import BY_CONTACT, Body, BodyState
from rockframe.dynamics.chain.any_base import BASE_NUMBERS, ON_BED, ON_PADS, ON_RIGID, AnyBase
from rockframe.dynamics.on_base import BODY_GUARDS, BodyOnBase, Mode
from rockframe.dynamics.pads import CORNER, CORNER_GUARDS, ElasticPads
from rockframe.dynamics.point_law import Viscoelastic
from rockframe.dynamics.protocol import POWERS, CalledBySteps

# columns of a row: the fields of `Body` in their order, among them
INERTIA: Final = 3  # about the centre of mass, over the reference mass [m^2]
GRAVITY: Final = 4  # g [m s^-2]
# then
MASS: Final = 8  # over the reference mass [1]
TOP: Final = 9  # height of the top, on which the next body stands, above the centre of mass [m]
BESIDE: Final = 10  # centre of mass to the right of that of the body below, both upright [m]
PER_MASS: Final = 11  # 1/MASS
PER_INERTIA: Final = 12  # 1/INERTIA
PLACE_VALUE: Final = 13  # factor of the body's mode in the number of the chain's mode
LAW: Final = 14  # law of the base: ON_PADS, ON_BED or ON_RIGID
FORCE_SIZE: Final = 15  # typical force on its corners, for rounding noise of forces [m s^-2]
MODE_COUNT: Final = 16  # number of modes of the body
BASE: Final = 17  # first of the numbers of that law
ROW: Final = BASE + BASE_NUMBERS  # length of a row

OBSERVED: Final = 3
"""Columns of a base, of which pads have two."""

# workspace behind the rows, for each body. First its frame, which rotates with the body below or
# rests with the ground: its axes lie along and normal to the surface that the body stands on
SINE: Final = 0  # of the rotation of the frame
COSINE: Final = 1
ACROSS: Final = 2  # centre of mass from that of the body below, along the frame [m]
ARM: Final = 3  # the same, normal to it [m]
SWAY: Final = 4  # rate of ACROSS [m s^-1]
RISE: Final = 5  # rate of ARM [m s^-1]
REACH: Final = 6  # dx/da of the centre of mass about the point of the base that is held [m]
DRIFT: Final = 7  # d2x/da2 times the square of RATE, an acceleration along the frame [m s^-2]
FRAME_RATE: Final = 8  # angular velocity of the frame [s^-1]
RATE: Final = 9  # angular velocity of the body relative to the frame [s^-1]
HELD: Final = 10  # whether a point of its base is held along the frame
# velocity of the centre of mass, loads, and accelerations, in the axes of the ground; in an event
# impulses stand for loads, and changes of velocities for accelerations
SPEED_X: Final = 11
SPEED_Y: Final = 12
LOAD_X: Final = 13
LOAD_Y: Final = 14
LOAD_MOMENT: Final = 15
X: Final = 16
Y: Final = 17
ROTATION: Final = 18
# force of the base on the body, along and normal to the frame [m s^-2]
THRUST: Final = 19
PRESS: Final = 20
# on a rigid base: numbers of the constraints of the corners, or -1, and impulses of these in an
# event; impulses of all rigid bases on the body, in the axes of the ground; impulses of a base that
# is not rigid as an end lands on it: normal to the base, their moment, and along it
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
IMPULSES: Final = 8  # numbers from LEFT_IMPULSE on
# senses of slip along the base, 1 to the right, -1 to the left, 0 for none; half without friction
SLIPS: Final = 31  # in the present trial
STARTS: Final = 32  # in which friction that is overcome lets the body start to slip
RUBS: Final = 33  # friction over normal force at a corner that slips, with its sign [1]
DRAG: Final = 34  # friction among the loads, of a body that slips on a base that is not rigid
HOLDS_ALONG: Final = 35  # number of the constraint that holds the body along its base
# of the left, then the right corner on a rigid base, for the search for corners that bear: rate of
# its height with the rotation, the normal acceleration (or change of velocity) by which it rests on
# the base; dx/da about it, and the tangential acceleration (or change) by which it does not slip
LEVERS: Final = 36
RESTS: Final = 38
REACHES: Final = 40
STAYS: Final = 42
# the body's part of the mode that was unpacked last, and that mode, its bits in two halves
CONTACT: Final = 44
PIVOT: Final = 45
SLIDING_BIT: Final = 46
HIGH_BITS: Final = 47
LOW_BITS: Final = 48
ATTITUDE: Final = 49  # sine and cosine of the rotation on the base, and h(1 - cos a) [m]
TRIED: Final = 52  # code of the constraints of the body in the last trial of corners
CONSTRAINTS: Final = 53  # how many constraints it and the bodies below have in that trial
SOLVED: Final = 54  # whether the forces of the last solution are valid, see `solved_room`
PLACES: Final = 55  # numbers of each body

MOST_CONSTRAINTS: Final = 3  # of each body; the numbers of a constraint are
BODY: Final = 0  # number of its body
VALUE: Final = 1  # prescribed value of the combination of accelerations that it constrains
FORCE: Final = 2  # Lagrange multiplier: its force, or its impulse in an event
KEEPS: Final = 3  # that combination: weights of X, Y, ROTATION of its body, then of the one below
HOLDS: Final = 9  # force and moment of a unit multiplier on its body, then on the one below
LEFT: Final = 15  # right-hand side of its equation, reduced by elimination
UNSYMMETRIC: Final = 16  # whether its force, or that of one before it, acts elsewhere than it keeps
CONSTRAINT: Final = 17  # numbers of a constraint
# then slopes, guards and their rates, velocities, columns, the matrix of the constraints, and what
# the forces were solved for

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
"""Half of the bits of a mode's number: a float holds each half exactly."""
PAD_MODES: Final = 2 * PIVOTS * CORNERS * CORNERS
BED_MODES: Final = 2 * PIVOTS * ENDS
RIGID_MODES: Final = 2 * 2 * ENDS  # what is held follows from the corners that bear


SOLVED_FOR: Final = 4
"""Numbers before the state in `solved_room`: both halves of the mode, and ground acceleration."""


@kernel
def room_of(count: int) -> int:
    """Return the length of the workspace behind the rows, for a number of bodies."""
    each = PLACES + MOST_CONSTRAINTS * CONSTRAINT + 4 * BODY_DOF + 2 * GUARDS + COLUMNS
    return count * each + POWERS + (MOST_CONSTRAINTS * count) ** 2 + SOLVED_FOR


class Lists(NamedTuple):
    """The numbers of a chain."""

    body_count: int
    rows: Vector  # the rows of all bodies, then the workspace


class Rows(StateAccess, CalledBySteps, Lists):
    """Access to the rows and the workspace of a chain. A mixin of systems."""

    __slots__ = ()

    @inlined
    def bodies(self) -> int:
        """Return the number of bodies."""
        return self.body_count

    @inlined
    def number(self, k: int, which: int) -> float:
        """Return a number of a body's row, by its column."""
        return float(self.rows[k * ROW + which])

    @inlined
    def places(self) -> Vector:
        """Return the workspace of all bodies: frames, forces and accelerations."""
        return view_of(self.rows, self.body_count * ROW, self.body_count * PLACES)

    @inlined
    def constraints(self) -> Vector:
        """Return the room for constraints."""
        width = MOST_CONSTRAINTS * CONSTRAINT
        return view_of(self.rows, self.body_count * (ROW + PLACES), self.body_count * width)

    @inlined
    def slopes(self) -> Vector:
        """Return the room for accelerations and powers."""
        return view_of(self.rows, self.after_constraints(), BODY_DOF * self.body_count + POWERS)

    @inlined
    def after_constraints(self) -> int:
        """Return the index behind the constraints."""
        return self.body_count * (ROW + PLACES + MOST_CONSTRAINTS * CONSTRAINT)

    @inlined
    def guard_room(self, which: int) -> Vector:
        """Return the room for guards (0) or their rates (1)."""
        first = self.after_constraints() + self.body_count * (BODY_DOF + which * GUARDS) + POWERS
        return view_of(self.rows, first, GUARDS * self.body_count)

    @inlined
    def velocity_room(self) -> Vector:
        """Return the room for velocities."""
        first = self.after_constraints() + self.body_count * (BODY_DOF + 2 * GUARDS) + POWERS
        return view_of(self.rows, first, BODY_DOF * self.body_count)

    @inlined
    def column_room(self) -> Vector:
        """Return the room for columns."""
        first = self.after_constraints() + self.body_count * (2 * BODY_DOF + 2 * GUARDS) + POWERS
        return view_of(self.rows, first, COLUMNS * self.body_count)

    @inlined
    def matrix(self) -> Vector:
        """Return the room for the matrix of the constraints: what each does to each other one."""
        room = 2 * BODY_DOF + 2 * GUARDS + COLUMNS
        first = self.after_constraints() + self.body_count * room + POWERS
        return view_of(self.rows, first, (MOST_CONSTRAINTS * self.body_count) ** 2)

    @inlined
    def solved_room(self) -> Vector:
        """Return the room for the mode, ground acceleration and state of the last solution."""
        first = self.behind_chain() - SOLVED_FOR - 2 * BODY_DOF * self.body_count
        return view_from(self.rows, first)

    @inlined
    def behind_chain(self) -> int:
        """Return the index behind rows and workspace."""
        return self.body_count * ROW + room_of(self.body_count)

    @inlined
    def on_base(self, k: int) -> BodyOnBase:
        """Return a body on its base."""
        r = view_from(self.rows, k * ROW)
        body = Body(r[0], r[1], r[2], r[3], r[4], r[5], int(r[6]), r[7] != 0.0)
        n = view_from(r, BASE)
        base = AnyBase(
            int(r[LAW]), n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8], n[9], n[10], n[11],
        )  # fmt: skip
        return BodyOnBase(body, base)

    @inlined
    def standing_state(self, k: int, standing: Mode, state: Vector) -> BodyState:
        """Return placement and rates of a body, without motion that its contacts exclude."""
        return self.state_of(k, state)

    @inlined
    def modes_of_bodies(self) -> int:
        """Return the number of modes of all bodies together."""
        k = self.body_count - 1
        return int(self.number(k, PLACE_VALUE)) * int(self.number(k, MODE_COUNT))

    @inlined
    def body_mode(self, mode: int, k: int) -> Mode:
        """Return the mode of a body; as divisions are slow, the one unpacked last is remembered."""
        room, i, high = self.places(), k * PLACES, mode >> HALF_OF_BITS
        low = mode - (high << HALF_OF_BITS)
        if room[i + HIGH_BITS] != high or room[i + LOW_BITS] != low:
            found = self.read_mode(mode, k)
            room[i + CONTACT], room[i + PIVOT] = found.contact, found.pivot
            room[i + SLIDING_BIT] = 1.0 if found.slides else 0.0
            room[i + HIGH_BITS], room[i + LOW_BITS] = high, low
        return Mode(int(room[i + CONTACT]), int(room[i + PIVOT]), room[i + SLIDING_BIT] != 0.0)

    @kernel
    def read_mode(self, mode: int, k: int) -> Mode:
        """Unpack the mode of a body from the number of the chain's mode."""
        number = mode // int(self.number(k, PLACE_VALUE)) % int(self.number(k, MODE_COUNT))
        if self.number(k, LAW) == ON_RIGID:
            ends, rest = number % ENDS, number // ENDS
            return Mode(ends + CORNER * (rest % 2), ends % PIVOTS, rest >= 2)
        both, standing = divmod(number, 2 * PIVOTS)
        contact = both % CORNERS + CORNER * (both // CORNERS)
        return Mode(contact, standing % PIVOTS, standing >= PIVOTS)

    @kernel
    def with_body_mode(self, mode: int, k: int, part: Mode) -> int:
        """Return the chain's mode with another mode of a body."""
        value, modes = int(self.number(k, PLACE_VALUE)), int(self.number(k, MODE_COUNT))
        low, high = part.contact % CORNER, part.contact // CORNER
        if self.number(k, LAW) == ON_RIGID:
            number = low + ENDS * (high + (2 if part.slides else 0))
        else:
            number = part.pivot + (PIVOTS if part.slides else 0)
            number += 2 * PIVOTS * (low + CORNERS * high)
        return mode + value * (number - mode // value % modes)


def row_of(body: Body, base: BaseNumbers, mass: float, top: float, beside: float) -> Vector:
    """Return a body's row, from its lengths [m] and its mass over the reference mass [1]."""
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
    """Return the array of a chain from the rows of its bodies, from the top down."""
    count, value = len(rows), 1
    for row in rows:
        row[PLACE_VALUE] = value
        value *= int(row[MODE_COUNT])
    return Lists(count, np.concatenate([*rows, np.zeros(room_of(count))]))
