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
from rockframe.dynamics.chain.any_base import MAX_LAW_NUMBERS, ON_BED, ON_PADS, ON_RIGID, AnyBase
from rockframe.dynamics.chain.returned import ReturnedArrays
from rockframe.dynamics.on_base import BODY_GUARDS, BodyOnBase, Mode
from rockframe.dynamics.pads import CORNER, CORNER_GUARDS, ElasticPads
from rockframe.dynamics.point_law import Viscoelastic
from rockframe.dynamics.protocol import CalledBySteps

# columns of a row: the fields of `Body` in their order, among them
INERTIA: Final = 3  # about the centre of mass, over the reference mass [m^2]
GRAVITY: Final = 4  # g [m s^-2]
# then
MASS: Final = 8  # over the reference mass [1]
TOP: Final = 9  # height of the top, on which the next body stands, above the centre of mass [m]
UPRIGHT_OFFSET: Final = 10  # centre of mass to the right of the one below, both upright [m]
INVERSE_MASS: Final = 11  # 1/MASS
INVERSE_INERTIA: Final = 12  # 1/INERTIA
PLACE_VALUE: Final = 13  # factor of the body's mode in the number of the chain's mode
LAW: Final = 14  # law of the base: ON_PADS, ON_BED or ON_RIGID
FORCE_SCALE: Final = 15  # typical force on its corners, for rounding noise of forces [m s^-2]
MODE_COUNT: Final = 16  # number of modes of the body
LAW_NUMBERS: Final = 17  # first of the numbers of that law
ROW_STRIDE: Final = LAW_NUMBERS + MAX_LAW_NUMBERS  # length of a row

BASE_COLUMNS: Final = 3
"""Columns of a base, of which pads have two."""

# workspace behind the rows, for each body. First its frame, which rotates with the body below or
# is fixed to the ground: its axes are tangential and normal to the surface under the body
SINE: Final = 0  # of the rotation of the frame
COSINE: Final = 1
TANGENTIAL: Final = 2  # position of the centre of mass relative to that of the body below [m]
NORMAL: Final = 3
TANGENTIAL_RATE: Final = 4  # their rates [m s^-1]
NORMAL_RATE: Final = 5
PIVOT_ARM: Final = 6  # dx/da of the centre of mass about the held point of the base [m]
PIVOT_CENTRIPETAL: Final = 7  # d2x/da2 times the square of ROTATION_RATE, tangential [m s^-2]
FRAME_ROTATION_RATE: Final = 8  # angular velocity of the frame [s^-1]
ROTATION_RATE: Final = 9  # angular velocity of the body relative to the frame [s^-1]
HOLD_STATE: Final = 10  # HELD or FREE: whether a point of its base is held tangentially
# velocity of the centre of mass, loads, and accelerations, in the axes of the ground; in an event
# impulses stand for loads, and changes of velocities for accelerations
SPEED_X: Final = 11
SPEED_Y: Final = 12
LOAD_X: Final = 13
LOAD_Y: Final = 14
LOAD_MOMENT: Final = 15
ACCELERATION_X: Final = 16
ACCELERATION_Y: Final = 17
ANGULAR_ACCELERATION: Final = 18
# force of the base on the body, in the axes of the frame [m s^-2]
TANGENTIAL_FORCE: Final = 19
NORMAL_FORCE: Final = 20
# on a rigid base: numbers of the constraints of the corners, or -1, and impulses of these in an
# event; impulses of all rigid bases on the body, in the axes of the ground; impulses of a
# deformable base as an end lands on it: normal, their moment, and tangential
LEFT_CONSTRAINT: Final = 21
RIGHT_CONSTRAINT: Final = 22
LEFT_IMPULSE: Final = 23
RIGHT_IMPULSE: Final = 24
IMPULSE_X: Final = 25
IMPULSE_Y: Final = 26
IMPULSE_MOMENT: Final = 27
LANDING_NORMAL: Final = 28
LANDING_MOMENT: Final = 29
LANDING_TANGENTIAL: Final = 30
IMPULSE_COUNT: Final = 8  # numbers from LEFT_IMPULSE on
# senses of slip along the base, 1 to the right, -1 to the left, 0 for none; half without friction
SLIP_SENSE: Final = 31  # in the present trial
STARTING_SENSE: Final = 32  # in which friction that is overcome lets the body start to slip
FRICTION_RATIO: Final = 33  # friction over normal force at a corner that slips, with its sign [1]
FRICTION_LOAD: Final = 34  # friction among the loads, of a body that slips on a deformable base
TANGENTIAL_CONSTRAINT: Final = 35  # number of the constraint that holds the body along its base
# of the left, then the right corner on a rigid base, for the search for corners that bear:
# derivative of its height by the rotation, prescribed normal acceleration (or change of velocity)
# if it bears; dx/da about it, prescribed tangential acceleration (or change) if it does not slip
CORNER_LEVERS: Final = 36
NORMAL_PRESCRIBED: Final = 38
CORNER_ARMS: Final = 40
TANGENTIAL_PRESCRIBED: Final = 42
# the body's part of the mode that was unpacked last, and that mode, its bits in two halves
CONTACT: Final = 44
PIVOT: Final = 45
SLIDING_BIT: Final = 46
HIGH_BITS: Final = 47
LOW_BITS: Final = 48
ATTITUDE: Final = 49  # sine and cosine of the rotation on the base, and h(1 - cos a) [m]
TRIAL_CODE: Final = 52  # code of the constraints of the body in the last trial of corners
CONSTRAINT_COUNT: Final = 53  # how many constraints it and the bodies below have in that trial
FORCES_VALID: Final = 54  # whether the forces of the last solution are valid, see `solved_inputs`
BODY_STRIDE: Final = 55  # numbers of each body

MAX_CONSTRAINTS: Final = 3  # of each body; numbers of a constraint:
CONSTRAINED_BODY: Final = 0  # number of its body
PRESCRIBED: Final = 1  # prescribed value of the combination of accelerations that it constrains
FORCE: Final = 2  # Lagrange multiplier: its force, or its impulse in an event
# weights of the accelerations x, y and rotation of its body, then of the one below
JACOBIAN: Final = 3
# force and moment of a unit multiplier on its body, then on the one below
FORCE_DIRECTION: Final = 9
RIGHT_HAND_SIDE: Final = 15  # right-hand side of its equation, reduced by elimination
# whether the force of this constraint, or of one before it, is not along its Jacobian
UNSYMMETRIC: Final = 16
CONSTRAINT_STRIDE: Final = 17  # numbers of a constraint
# then velocities, the matrix of the constraints, and the inputs of the last solution for forces

GUARDS: Final = 2 * CORNER_GUARDS + BODY_GUARDS
"""Guards of each body."""
COLUMNS: Final = 14 + BASE_COLUMNS
"""What users see of each body and its base."""

PAD_CORNER_STATES: Final = 5
"""States of a corner on its pad."""
END_STATES: Final = 4
"""States of both ends on a bed, or of both corners on a rigid base."""
PIVOT_COUNT: Final = 3
HALF_OF_BITS: Final = 32
"""Half of the bits of a mode's number: a float holds each half exactly."""
PAD_MODES: Final = 2 * PIVOT_COUNT * PAD_CORNER_STATES * PAD_CORNER_STATES
BED_MODES: Final = 2 * PIVOT_COUNT * END_STATES
RIGID_MODES: Final = 2 * 2 * END_STATES  # what is held follows from the corners that bear


INPUTS_BEFORE_STATE: Final = 4
"""Numbers before the state in `solved_inputs`: both halves of the mode, and ground acceleration."""


class ChainNumbers(NamedTuple):
    """The numbers of a chain."""

    body_count: int
    rows: Vector  # the rows of all bodies, then the workspace


class ChainArray(StateAccess, ReturnedArrays, CalledBySteps, ChainNumbers):
    """Access to the rows and the workspace of a chain. A mixin of systems."""

    __slots__ = ()

    @inlined
    def bodies(self) -> int:
        """Return the number of bodies."""
        return self.body_count

    @inlined
    def row_value(self, k: int, column: int) -> float:
        """Return a number of a body's row, by its column."""
        return float(self.rows[k * ROW_STRIDE + column])

    @inlined
    def workspace(self) -> Vector:
        """Return the workspace of all bodies: frames, forces and accelerations."""
        return view_of(self.rows, self.body_count * ROW_STRIDE, self.body_count * BODY_STRIDE)

    @inlined
    def constraints(self) -> Vector:
        """Return the numbers of all constraints."""
        width = MAX_CONSTRAINTS * CONSTRAINT_STRIDE
        return view_of(
            self.rows, self.body_count * (ROW_STRIDE + BODY_STRIDE), self.body_count * width
        )

    @inlined
    def constraints_end(self) -> int:
        """Return the index behind the constraints."""
        return self.body_count * (ROW_STRIDE + BODY_STRIDE + MAX_CONSTRAINTS * CONSTRAINT_STRIDE)

    @inlined
    def velocity_workspace(self) -> Vector:
        """Return the workspace for velocities."""
        return view_of(self.rows, self.constraints_end(), BODY_DOF * self.body_count)

    @inlined
    def constraint_matrix(self) -> Vector:
        """Return the matrix of the constraints: responses of each to the forces of the others."""
        first = self.constraints_end() + BODY_DOF * self.body_count
        return view_of(self.rows, first, (MAX_CONSTRAINTS * self.body_count) ** 2)

    @inlined
    def solved_inputs(self) -> Vector:
        """Return the mode, ground acceleration and state of the last solution for forces."""
        first = self.workspace_end() - INPUTS_BEFORE_STATE - 2 * BODY_DOF * self.body_count
        return view_from(self.rows, first)

    @inlined
    def workspace_end(self) -> int:
        """Return the index behind rows and workspace."""
        matrix, states = (MAX_CONSTRAINTS * self.body_count) ** 2, 3 * BODY_DOF * self.body_count
        return self.constraints_end() + matrix + states + INPUTS_BEFORE_STATE

    bodies_end = workspace_end  # with friction, its coefficients follow

    @inlined
    def returned_start(self) -> int:
        """Return the index of the workspace for what the equations return."""
        return self.bodies_end()

    @inlined
    def body_column_count(self) -> int:
        """Return the number of columns of all bodies and their bases."""
        return COLUMNS * self.body_count

    @inlined
    def columns(self) -> int:
        """Return the number of columns."""
        return self.body_column_count()

    @inlined
    def on_base(self, k: int) -> BodyOnBase:
        """Return a body on its base."""
        r = view_from(self.rows, k * ROW_STRIDE)
        body = Body(r[0], r[1], r[2], r[3], r[4], r[5], int(r[6]), r[7] != 0.0)
        return BodyOnBase(body, AnyBase(int(r[LAW]), view_from(r, LAW_NUMBERS)))

    @inlined
    def constrained_state(self, k: int, body_mode: Mode, state: Vector) -> BodyState:
        """Return placement and rates of a body, without motion that its contacts exclude."""
        return self.state_of(k, state)

    @inlined
    def body_mode_count(self) -> int:
        """Return the number of modes of all bodies together; some of these numbers do not occur."""
        k = self.body_count - 1
        return int(self.row_value(k, PLACE_VALUE)) * int(self.row_value(k, MODE_COUNT))

    modes = body_mode_count

    @inlined
    def body_mode(self, mode: int, k: int) -> Mode:
        """Return the mode of a body; as divisions are slow, the one unpacked last is remembered."""
        work, i, high = self.workspace(), k * BODY_STRIDE, mode >> HALF_OF_BITS
        low = mode - (high << HALF_OF_BITS)
        if work[i + HIGH_BITS] != high or work[i + LOW_BITS] != low:
            body_mode = self.unpack_mode(mode, k)
            work[i + CONTACT], work[i + PIVOT] = body_mode.contact, body_mode.pivot
            work[i + SLIDING_BIT] = 1.0 if body_mode.slides else 0.0
            work[i + HIGH_BITS], work[i + LOW_BITS] = high, low
        return Mode(int(work[i + CONTACT]), int(work[i + PIVOT]), work[i + SLIDING_BIT] != 0.0)

    @kernel
    def unpack_mode(self, mode: int, k: int) -> Mode:
        """Unpack the mode of a body from the number of the chain's mode."""
        number = mode // int(self.row_value(k, PLACE_VALUE)) % int(self.row_value(k, MODE_COUNT))
        if self.row_value(k, LAW) == ON_RIGID:
            ends, rest = number % END_STATES, number // END_STATES
            return Mode(ends + CORNER * (rest % 2), ends % PIVOT_COUNT, rest >= 2)
        both, body_mode = divmod(number, 2 * PIVOT_COUNT)
        contact = both % PAD_CORNER_STATES + CORNER * (both // PAD_CORNER_STATES)
        return Mode(contact, body_mode % PIVOT_COUNT, body_mode >= PIVOT_COUNT)

    @kernel
    def with_body_mode(self, mode: int, k: int, part: Mode) -> int:
        """Return the chain's mode with another mode of a body."""
        value, modes = int(self.row_value(k, PLACE_VALUE)), int(self.row_value(k, MODE_COUNT))
        low, high = part.contact % CORNER, part.contact // CORNER
        if self.row_value(k, LAW) == ON_RIGID:
            number = low + END_STATES * (high + (2 if part.slides else 0))
        else:
            number = part.pivot + (PIVOT_COUNT if part.slides else 0)
            number += 2 * PIVOT_COUNT * (low + PAD_CORNER_STATES * high)
        return mode + value * (number - mode // value % modes)


def body_row(body: Body, base: BaseNumbers, mass: float, top: float, offset: float) -> Vector:
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
    row = np.zeros(ROW_STRIDE)
    # a corner that bears on a rigid base does not slide on it, whatever the rule
    row[: len(body)] = body._replace(restraint=BY_CONTACT) if law == ON_RIGID else body
    row[[MASS, TOP, UPRIGHT_OFFSET, LAW, FORCE_SCALE]] = mass, top, offset, law, mass * body.gravity
    row[MODE_COUNT] = (PAD_MODES, BED_MODES, RIGID_MODES)[law]
    row[[INVERSE_MASS, INVERSE_INERTIA]] = 1.0 / mass, 1.0 / body.inertia
    numbers = numbers_in(base.law)
    row[LAW_NUMBERS : LAW_NUMBERS + len(numbers)] = numbers
    return row


def chain_numbers(rows: Sequence[Vector]) -> ChainNumbers:
    """Return the numbers of a chain, as yet without a workspace, from the top down."""
    value = 1
    for row in rows:
        row[PLACE_VALUE] = value
        value *= int(row[MODE_COUNT])
    return ChainNumbers(len(rows), np.concatenate(rows))
