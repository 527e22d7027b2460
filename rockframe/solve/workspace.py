"""The arrays of a run, and the index of each number in them.

The integrator can pause, for example when its table of events is full, and continue later: its
progress is in three small arrays, :class:`Progress`. This module also evaluates the polynomial of
the ground acceleration in an interval of the motion. Energies are per unit mass [m^2 s^-2].
"""

from enum import IntEnum
from typing import Final, NamedTuple

import numpy as np

from rockframe.compiled import IntegerMatrix, Integers, Matrix, ReadOnlyMatrix, Vector, inlined
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
        """Whether the run went to its end, or to the overturning that ends it."""
        return self <= Status.TOPPLED

    @property
    def overturned(self) -> bool | None:
        """Whether the block overturned; None if the run was cut off before that was known.

        This is the verdict of a run. In a run that stops at overturning, the block overturns when
        it reaches the overturning angle; in a run that continues, only when it falls flat.
        """
        return self is not Status.COMPLETED if self.finished else None


# Results of the integrator: a Status, or one of these.
TABLE_FULL: Final = -1
PAUSED: Final = -2

COMPLETED: Final = int(Status.COMPLETED)
OVERTURNED: Final = int(Status.OVERTURNED)
TOPPLED: Final = int(Status.TOPPLED)
STEP_LIMIT: Final = int(Status.STEP_LIMIT)
STEP_TOO_SMALL: Final = int(Status.STEP_TOO_SMALL)
CHATTER: Final = int(Status.CHATTER)

# controls: real settings
RTOL: Final = 0  # relative tolerance of a step [1], or FIXED_STEPS
FLOOR: Final = 1  # see `floor` of :class:`rockframe.solve.accuracy.Accuracy` [1]
MAX_STEP: Final = 2  # longest step; for fixed steps, their length [s]
DURATION: Final = 3  # of the run [s]
TIME_STEP: Final = 4  # interval between samples of the motion [s]
OUTPUT_STEP: Final = 5  # between output samples [s]
CHATTER_TIME: Final = 6  # time between events below which they count as chatter [s]
CONTROLS: Final = 7

FIXED_STEPS: Final = 0.0
"""Value of RTOL that means fixed sub-steps."""

# clock: real progress; first the numbers that every step changes, OF_STEPS in all
INTO_INTERVAL: Final = 0  # time since the start of the interval of the motion [s]
NEXT_STEP: Final = 1  # length that is planned for the next step [s]
FLIGHT_TIME: Final = 2  # total time of flight [s]
PEAK_LEFT: Final = 3  # largest rotation of the block to the left [rad]
PEAK_RIGHT: Final = 4  # and to the right
DISSIPATED: Final = 5  # work of dashpots
SUPPLIED: Final = 6  # work of the ground
LARGEST_ENERGY: Final = 7  # largest energy of the motion so far
GROUND_X: Final = 8  # ground acceleration at the end of the last step [m s^-2]
GROUND_Y: Final = 9
STEP_CLOCK: Final = 10
FIRST_UPLIFT: Final = 10  # time of the first loss of contact, or NaN [s]
OVERTURNING_TIME: Final = 11  # or NaN [s]
OVERTURNING_SIDE: Final = 12  # sign of the rotation then
RESIDUAL: Final = 13  # largest imbalance of the energies
LARGEST_TERM: Final = 14  # largest term of their balance, energies at rest included
START_ENERGY: Final = 15  # energy at the start, or NaN before it is known
EVENT_TIME: Final = 16  # time of the last event [s]
TIME: Final = 17  # time that the run has reached, written when the driver returns [s]
STEP: Final = 18  # length of the last step, where the march leaves it to the driver [s]
REQUESTED: Final = 19  # length of the sub-step that it is, or is a part of [s]
ERROR_NORM: Final = 20  # its error over the error allowed
NEXT_OUTPUT: Final = 21  # next output time, less a margin for rounding [s]
OTHER_ROTATION_RATIO: Final = 22  # largest ratio of another body's rotation to its limit
CLOCK: Final = 23

# counters: integer progress and switches
MODE: Final = 0  # present mode
INTERVAL: Final = 1  # number of the present interval of the motion
OUTPUTS: Final = 2  # output samples stored
EVENTS: Final = 3  # rows in the table of events
STEPS: Final = 4  # accepted steps
REJECTED: Final = 5  # refused steps
IMPACTS: Final = 6
FLIGHTS: Final = 7
PENDING: Final = 8  # guard that has fallen and whose event is still to be carried out, or -1
CLOSE_EVENTS: Final = 9  # events in a row that count as chatter
MAX_STEPS: Final = 10
STOP_AT_OVERTURNING: Final = 11  # 1 if the run ends there
HALF: Final = 12  # half of `ends` that is the start of the next step
DEGREE_X: Final = 13  # degree of the ground's polynomial in the present interval
DEGREE_Y: Final = 14
STALE: Final = 15  # whether slope and guards at the state must be evaluated again
LAST_INTERVAL: Final = 16  # interval at whose end the run pauses
STEPS_KEPT: Final = 17  # rows in the table of steps
PAUSE_AT: Final = 18  # number of steps, refused ones included, after which the run pauses
COUNTERS: Final = 19

CLOSE_EVENTS_LIMIT: Final = 1000
"""Most events in a row, each within CHATTER_TIME of the one before; more end a run as chatter."""

MAX_TERMS: Final = 6
"""Most coefficients per direction and interval; a record needs two, an analytic pulse six."""

ROW_HEADER: Final = 4
"""Numbers before the state in a row of :class:`StepTable`."""
ROW_CODES: Final = 2
"""Whole numbers in such a row."""

STATE_ERRORS: Final = 3
"""Index in `works` of the first error of the state."""


class UnpackedMode(NamedTuple):
    """A mode, and what it means for steps: unpacked when it begins."""

    mode: int
    moving: int  # leading coordinates that move
    contact: int  # rockframe.dynamics.events.ContactState of the body that the scene is about
    longest_step: float  # longest fixed step that is stable for the relaxation of a constraint [s]


class Pieces(NamedTuple):
    """Ground acceleration as polynomials, a row for each interval; no rows for still ground."""

    x: ReadOnlyMatrix
    y: ReadOnlyMatrix


class Progress(NamedTuple):
    """Settings and progress, by the indices above."""

    controls: Vector
    clock: Vector
    counters: Integers


class StepTable(NamedTuple):
    """Ends of steps, each the start of the step in the next row; or no rows.

    A start that is not the end of the row before it has a row of its own, of length 0. Rows follow
    one another in vectors, which compiled functions of a system can take.
    """

    # time, length of the step, ground acceleration in x and y, state, and slope without powers
    values: Vector
    codes: Integers  # mode, and number of events before


class Output(NamedTuple):
    """Samples at the output times (`work` may have no rows), and the table of steps."""

    state: Matrix
    mode: Integers
    work: Matrix
    steps: StepTable


class EventTable(NamedTuple):
    """Events: time, states before and after and memory; kind and modes."""

    values: Matrix
    codes: IntegerMatrix


class StepArrays(NamedTuple):
    """Those arrays of a :class:`Workspace` that the loop of steps reads and writes."""

    ends: Vector
    stages: Vector
    works: Vector
    reference: Vector
    limits: Vector
    ground: Vector


class Workspace(NamedTuple):
    """Arrays of a step; a slope holds accelerations, rates of first-order variables and powers."""

    ends: Vector  # memory of both ends of a step: of the next six arrays
    state: Vector  # state at the start
    slope: Vector  # slope at the start
    guards: Vector  # guards and their rates at the start
    new_state: Vector  # state at the end
    new_slope: Vector  # slope at the end
    new_guards: Vector  # guards and their rates at the end
    stages: Vector  # velocities and slopes of the stages
    works: Vector  # energies dissipated and put in, error of their difference, errors of the state
    reference: Vector  # largest size so far of each element of the state
    limits: Vector  # limits of rotations, see LEFT_LIMIT
    inner_state: Vector  # a state inside the step
    inner_slope: Vector  # its slope
    inner_guards: Vector  # guards and their rates inside the step
    inner_powers: Vector  # a slope inside the step, evaluated for its powers
    ground: Vector  # coefficients of the ground acceleration in the present interval
    scratch: Vector  # scratch for a few numbers that the system gives


LEFT_LIMIT: Final = 0
RIGHT_LIMIT: Final = 1
"""Indices in `limits` of the largest rotations to either side [rad]. The weights of the coordinates
in the rotation follow, then limits and weights of other bodies that may overturn."""
WEIGHTS: Final = 2

NO_STEPS: Final = StepTable(np.empty(0), np.empty(0, dtype=np.int64))
"""The table of a run whose steps are not kept."""


@inlined
def append_row(
    time: float, length: float, mode: int, ground: Ground, width: int, slopes: int, state: Vector,
    slope: Vector, counters: Integers, values: Vector, codes: Integers,
) -> None:  # fmt: skip
    """Fill a row of the table of steps with `width` and `slopes` numbers of state and slope."""
    row = counters[STEPS_KEPT]
    begin = row * (ROW_HEADER + width + slopes)
    values[begin], values[begin + 1] = time, length
    values[begin + 2], values[begin + 3] = ground.x, ground.y
    for i in range(width):
        values[begin + ROW_HEADER + i] = state[i]
    for i in range(slopes):
        values[begin + ROW_HEADER + width + i] = slope[i]
    codes[ROW_CODES * row], codes[ROW_CODES * row + 1] = mode, counters[EVENTS]
    counters[STEPS_KEPT] = row + 1


@inlined
def steps_made(counters: Integers) -> int:
    """Return the number of steps of a run, refused ones included."""
    return counters[STEPS] + counters[REJECTED]


@inlined
def is_full(codes: Integers, counters: Integers) -> bool:
    """Whether a table of steps, if one is kept, has no room for a start and a step from it."""
    return ROW_CODES * (counters[STEPS_KEPT] + 2) > len(codes) > 0


@inlined
def with_ends_swapped(w: Workspace) -> Workspace:
    """Return the workspace with both ends exchanged: the end of a step is the start of the next."""
    return Workspace(
        w.ends, w.new_state, w.new_slope, w.new_guards, w.state, w.slope, w.guards, w.stages,
        w.works, w.reference, w.limits, w.inner_state, w.inner_slope, w.inner_guards,
        w.inner_powers, w.ground, w.scratch,
    )  # fmt: skip


class Span(NamedTuple):
    """One step: its length, and where it lies in its interval of the motion."""

    h: float  # length [s]
    u: float  # where it starts in the interval, from 0 to 1
    du: float  # its length over that of the interval
    degree_x: int  # degree of the ground's polynomial
    degree_y: int


class Work(NamedTuple):
    """Energies that dashpots have dissipated and that the ground has put in [m^2 s^-2]."""

    dissipated: float
    supplied: float


@inlined
def load_interval(index: int, pieces: ReadOnlyMatrix, first: int, coefficients: Vector) -> int:
    """Write the polynomial of one direction in interval `index`; return its degree.

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
def polynomial_value(u: float, degree: int, first: int, coefficients: Vector) -> float:
    """Evaluate at u the polynomial whose coefficients begin at index `first`."""
    value = coefficients[first + degree]
    for j in range(degree - 1, -1, -1):
        value = value * u + coefficients[first + j]
    return value


@inlined
def ground_may_peak(degree_x: int, degree_y: int, coefficients: Vector) -> bool:
    """Whether the ground acceleration may have a peak inside an interval, not at its ends.

    Of two directions that bend, or of one that bends and another that changes, some sum may have
    one. A direction by itself has none where its linear term exceeds all others.
    """
    if max(degree_x, degree_y) <= 1:
        return False
    if min(degree_x, degree_y) > 0:
        return True
    first, degree = (0, degree_x) if degree_x > degree_y else (MAX_TERMS, degree_y)
    higher_terms = 0.0
    for j in range(2, degree + 1):
        higher_terms += j * abs(coefficients[first + j])
    return abs(coefficients[first + 1]) <= higher_terms


@inlined
def ground_in_step(fraction: float, span: Span, coefficients: Vector) -> Ground:
    """Return the ground acceleration at a fraction of a step."""
    u = span.u + fraction * span.du
    return Ground(
        polynomial_value(u, span.degree_x, 0, coefficients),
        polynomial_value(u, span.degree_y, MAX_TERMS, coefficients),
    )
