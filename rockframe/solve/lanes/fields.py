"""What is kept of each of many runs: the fields of a row, and of a lane.

A row holds a whole run, one number after the other, so that the driver of single runs works
on it as it stands. A lane holds the same fields between those of its neighbours.
"""

from typing import Final, NamedTuple

from rockframe.compiled import inlined
from rockframe.dynamics.protocol import POWERS, Equations
from rockframe.solve import layout as at
from rockframe.solve.dormand_prince_tableau import STAGES
from rockframe.solve.guards import WEIGHTS
from rockframe.solve.workspace import ERRORS, TERMS

# what lanes need beside the clock, controls and counters of a run
LENGTH: Final = 0  # of the interval
LONGEST: Final = 1  # stable step in the mode
STEP: Final = 2  # length of the step
PLACE: Final = 3  # in the interval, from 0 to 1, at which the ground is evaluated
MIDDLE_X: Final = 4  # ground acceleration in the middle of a step of fixed length
MIDDLE_Y: Final = 5
NOW_X: Final = 6  # at a stage; at last at the end of the step
NOW_Y: Final = 7
REALS: Final = 8

# the same in whole numbers
BUSY: Final = 0  # whether the lane has a run
ACTIVE: Final = 1  # leading coordinates that move
FLIES: Final = 2
ASKS: Final = 3  # whether the last step is for the driver of single runs
FIRST_X: Final = 4  # row of the first interval in the polynomials of all motions
COUNT_X: Final = 5  # intervals of the motion
FIRST_Y: Final = 6
COUNT_Y: Final = 7
STATUS: Final = 8
TAKEN: Final = 9  # all bits where the last step is taken, none where not
ENTERS: Final = 10  # whether the lane comes to its next interval
REFUSED: Final = 11  # whether the error of the last step was too large
WHOLES: Final = 12

# what a step in all lanes has found
ALL_QUIET: Final = 0
SOME_ASK: Final = 1  # the step of some lane is for the driver of single runs
SOME_WAIT: Final = 2  # some lane is at an end that is not just that of an interval; no step is made

CLOCK: Final = 0
COUNTERS: Final = CLOCK + at.CLOCK
CONTROLS: Final = COUNTERS + at.COUNTERS
OWN: Final = CONTROLS + at.CONTROLS
OWN_WHOLE: Final = OWN + REALS
GROUND: Final = OWN_WHOLE + WHOLES
LIMITS: Final = GROUND + 2 * TERMS
"""Places of what every system has; the rest depends on its size."""


class Places(NamedTuple):
    """Places of fields that depend on the size of a system."""

    reference: int  # largest size so far of each variable
    state: int  # at the start of a step; both ends of a step stand together
    first: int
    before: int
    new: int
    last: int
    after: int
    end: int  # of both
    stages: int
    works: int
    clock: int  # at the end of a step, as far as steps change it
    numbers: int  # of the system; behind them memory and tolerances, which only rows have


@inlined
def places_of(system: Equations) -> Places:
    """Give where the fields of a system are."""
    size, variables, guards = system.coordinates(), system.variables(), system.guards() + 1
    width, slope = 2 * size + variables, size + variables + POWERS
    reference = LIMITS + WEIGHTS + size
    state = reference + width
    half = width + slope + 2 * guards
    new, stages = state + half, state + 2 * half
    works = stages + STAGES * (size + slope)
    clock = works + ERRORS + width
    return Places(
        reference, state, state + width, state + width + slope, new, new + width,
        new + width + slope, stages, stages, works, clock, clock + at.OF_STEPS,
    )  # fmt: skip
