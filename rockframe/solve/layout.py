"""Where the integrator keeps its numbers: indices into its arrays.

The integrator can stop (for want of room for events) and go on; everything it
must remember stands in three small arrays.
"""

from enum import IntEnum
from typing import Final


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
