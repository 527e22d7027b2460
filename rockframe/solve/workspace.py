"""The arrays of a run, and what stands where in them: read, worked on and filled by the integrator.

The integrator can stop (for want of room for events) and go on; everything it must remember stands
in three small arrays, :class:`Progress`. Also the ground acceleration inside one interval of the
motion, a polynomial.
"""

from enum import IntEnum
from typing import Final, NamedTuple

import numpy as np

from rockframe.compiled import (
    IntegerMatrix,
    Integers,
    Matrix,
    ReadOnlyMatrix,
    Vector,
    inlined,
)
from rockframe.dynamics.protocol import Ground


class Status(IntEnum):
    """How a run ended."""

    COMPLETED = 0
    OVERTURNED = 1
    TOPPLED = 2
    STEP_LIMIT = 3
    STEP_TOO_SMALL = 4
    CHATTER = 5

    @property
    def finished(self) -> bool:
        """Whether the run went as far as it was asked to."""
        return self <= Status.TOPPLED

    @property
    def overturned(self) -> bool | None:
        """Whether the block overturned; None if the run was cut off before it could tell.

        This is the verdict of a run, in the sense in which it was asked: one that ends at the
        overturning angle has reached it; one that goes on beyond it has fallen flat.
        """
        return self is not Status.COMPLETED if self.finished else None


# Results of the integrator: a Status, or one of these.
MORE_ROOM: Final = -1
PAUSED: Final = -2

COMPLETED: Final = int(Status.COMPLETED)
OVERTURNED: Final = int(Status.OVERTURNED)
FELL: Final = int(Status.TOPPLED)
STEP_LIMIT: Final = int(Status.STEP_LIMIT)
STEP_TOO_SMALL: Final = int(Status.STEP_TOO_SMALL)
CHATTER: Final = int(Status.CHATTER)

# controls: real settings
RTOL: Final = 0
FLOOR: Final = 1
MAX_STEP: Final = 2
DURATION: Final = 3
TIME_STEP: Final = 4
OUTPUT_STEP: Final = 5
CHATTER_TIME: Final = 6
CONTROLS: Final = 7

FIXED_STEPS: Final = 0.0
"""Stands for the tolerance of a run with fixed sub-steps."""

# clock: real progress; what a step changes stands first
INTO_INTERVAL: Final = 0
NEXT_STEP: Final = 1
FLIGHT_TIME: Final = 2
PEAK_LEFT: Final = 3
PEAK_RIGHT: Final = 4
DISSIPATED: Final = 5
SUPPLIED: Final = 6
LARGEST_MOVED: Final = 7
GROUND_X: Final = 8
GROUND_Y: Final = 9
OF_STEPS: Final = 10
FIRST_UPLIFT: Final = 10
OVERTURNING_TIME: Final = 11
OVERTURNING_SIDE: Final = 12
RESIDUAL: Final = 13
LARGEST_TERM: Final = 14
START_ENERGY: Final = 15
EVENT_TIME: Final = 16
TIME: Final = 17
STEP: Final = 18
ASKED: Final = 19
EXCESS: Final = 20
NEXT_OUTPUT: Final = 21
OTHER_SHARE: Final = 22  # largest of another rotation in its limit
CLOCK: Final = 23

# counters: integer progress and switches
MODE: Final = 0
INTERVAL: Final = 1
OUTPUTS: Final = 2
EVENTS: Final = 3
STEPS: Final = 4
REJECTED: Final = 5
IMPACTS: Final = 6
FLIGHTS: Final = 7
PENDING: Final = 8
CLOSE_EVENTS: Final = 9
MAX_STEPS: Final = 10
STOP_AT_OVERTURNING: Final = 11
HALF: Final = 12
DEGREE_X: Final = 13
DEGREE_Y: Final = 14
STALE: Final = 15  # whether slope and guards at the state are to be evaluated anew
LAST_INTERVAL: Final = 16  # at whose end the run pauses
STEPS_KEPT: Final = 17
PAUSE_AT: Final = 18  # steps, tried ones too, after which the run pauses
COUNTERS: Final = 19

CLOSE_EVENTS_LIMIT: Final = 1000
"""Events in a row, each within CHATTER_TIME of the one before, that end a run as chatter."""

TERMS: Final = 6
"""Most coefficients per direction and interval; a record needs two, an analytic pulse six."""

BESIDE: Final = 4
"""Numbers of a row of steps before its state."""
CODES: Final = 2
"""Whole numbers of such a row."""

ERRORS: Final = 3
"""Place of the errors of the state behind the works of a step."""


class Pieces(NamedTuple):
    """Ground acceleration as polynomials, a row for each interval; none where it stands still."""

    x: ReadOnlyMatrix
    y: ReadOnlyMatrix


class Progress(NamedTuple):
    """Settings and progress, by the indices above."""

    controls: Vector
    clock: Vector
    counters: Integers


class StepTable(NamedTuple):
    """Ends of steps, each the start of the step in the next row; or no rows.

    Time, length of the step, both directions of the ground's acceleration, state, and slope
    without powers; mode and number of events before. A start that is not the end of the row
    before it has a row of its own, of length 0. Row follows row: the functions that are compiled
    for a system take vectors.
    """

    values: Vector
    codes: Integers


class Output(NamedTuple):
    """Samples at the output times; `work` may have no rows."""

    state: Matrix
    mode: Integers
    work: Matrix
    steps: StepTable


class EventTable(NamedTuple):
    """Events: time, states before and after and memory; kind and modes."""

    values: Matrix
    codes: IntegerMatrix


class Workspace(NamedTuple):
    """Arrays of one step.

    A *slope* holds accelerations, rates of variables of first order, and powers.
    """

    both_ends: Vector  # both ends of a step, of which the next six are parts
    state: Vector  # at its start
    first: Vector  # slope
    before: Vector  # guards and their rates
    new: Vector  # state at its end
    last: Vector  # slope
    after: Vector  # guards and their rates
    stages: Vector  # room for stages
    works: Vector  # energies dissipated and put in, the error of their difference, other errors
    reference: Vector  # largest size so far of each variable
    limits: Vector  # of the rotation, see rockframe.solve.march
    scratch: Vector  # state and its slope in between
    scratch_rates: Vector
    inside: Vector  # guards in between
    powers: Vector  # another slope in between
    ground: Vector  # coefficients of the ground motion in this interval
    answers: Vector  # room for a few numbers that the system gives


NO_STEPS: Final = StepTable(np.empty(0), np.empty(0, dtype=np.int64))
"""The table of a run whose steps are not kept."""


@inlined
def keep_row(
    time: float, length: float, mode: int, ground: Ground, width: int, slopes: int, state: Vector,
    slope: Vector, counters: Integers, values: Vector, codes: Integers,
) -> None:  # fmt: skip
    """Fill a row of the table of steps with `width` and `slopes` numbers of state and slope."""
    row = counters[STEPS_KEPT]
    begin = row * (BESIDE + width + slopes)
    values[begin], values[begin + 1] = time, length
    values[begin + 2], values[begin + 3] = ground.x, ground.y
    for i in range(width):
        values[begin + BESIDE + i] = state[i]
    for i in range(slopes):
        values[begin + BESIDE + width + i] = slope[i]
    codes[CODES * row], codes[CODES * row + 1] = mode, counters[EVENTS]
    counters[STEPS_KEPT] = row + 1


@inlined
def has_no_room(codes: Integers, counters: Integers) -> bool:
    """Whether a table of steps that are kept has no room for a start and the step from it."""
    return CODES * (counters[STEPS_KEPT] + 2) > len(codes) > 0


@inlined
def swapped(w: Workspace) -> Workspace:
    """Give the workspace in which a step's end is the start of the next."""
    return Workspace(
        w.both_ends, w.new, w.last, w.after, w.state, w.first, w.before, w.stages, w.works,
        w.reference,
        w.limits, w.scratch, w.scratch_rates, w.inside, w.powers, w.ground, w.answers,
    )  # fmt: skip


class Span(NamedTuple):
    """One step: its length, and where it lies in its interval of the motion."""

    h: float
    u: float
    du: float
    degree_x: int
    degree_y: int


class Work(NamedTuple):
    """Energies that dashpots have dissipated and that the ground has put in."""

    dissipated: float
    supplied: float


@inlined
def load_interval(index: int, pieces: ReadOnlyMatrix, first: int, coefficients: Vector) -> int:
    """Write the polynomial of one direction in interval `index`; give its degree.

    The polynomial is in u, from 0 to 1 over the interval. A direction without
    samples, and the time after the last sample, have a ground that stands still.
    """
    if index >= len(pieces):
        coefficients[first] = 0.0
        return 0
    coefficients[first] = pieces[index, 0]
    coefficients[first + 1] = pieces[index, 1]
    for j in range(2, pieces.shape[1]):
        coefficients[first + j] = pieces[index, j]
    return pieces.shape[1] - 1


@inlined
def polynomial(u: float, degree: int, first: int, coefficients: Vector) -> float:
    """Give a polynomial, of which the coefficients stand from index `first` on."""
    value = coefficients[first + degree]
    for j in range(degree - 1, -1, -1):
        value = value * u + coefficients[first + j]
    return value


@inlined
def ground_in(fraction: float, span: Span, coefficients: Vector) -> Ground:
    """Give the ground acceleration at a fraction of a step."""
    u = span.u + fraction * span.du
    return Ground(
        polynomial(u, span.degree_x, 0, coefficients),
        polynomial(u, span.degree_y, TERMS, coefficients),
    )
