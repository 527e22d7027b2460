"""Events and steps that change nothing."""

from types import SimpleNamespace

import numpy as np
import pytest

from rockframe.dynamics.events import SILENT, ContactState
from rockframe.solve import workspace as at
from rockframe.solve.bookkeeping import record_event, update_peaks
from rockframe.solve.workspace import EventTable, Progress, Status, UnpackedMode

STATE = (0.1, -0.2)


def recorded(rows, modes=(3, 3), memory=(0.0,)):
    """Return the status after a series of events, given by time and state before."""
    progress = Progress(np.zeros(at.CONTROLS), np.zeros(at.CLOCK), np.zeros(at.COUNTERS, int))
    events = EventTable(np.zeros((9, 6)), np.zeros((9, 3), dtype=np.int64))
    before, after = (UnpackedMode(mode, 1, int(ContactState.FULL), 1.0) for mode in modes)
    place, status = SimpleNamespace(state=np.array(STATE)), 0
    for row, (time, state) in enumerate(rows):
        events.values[row, 1:3] = state
        status = record_event(
            time, SILENT, before, after, np.array(memory), progress, events, place
        )
    return Status(status)


def test_an_event_that_repeats_itself_is_chatter():
    assert recorded([(1.0, STATE), (1.0, STATE)]) == Status.CHATTER


@pytest.mark.parametrize(
    ("rows", "modes"),
    [
        ([(1.0, STATE)], (3, 3)),
        ([(1.0, STATE), (1.5, STATE)], (3, 3)),
        ([(1.0, (0.0, 0.0)), (1.0, STATE)], (3, 3)),
        ([(1.0, STATE), (1.0, STATE)], (3, 4)),
    ],
    ids=["the first one", "later", "from another state", "to another mode"],
)
def test_other_events_are_not_chatter(rows, modes):
    assert recorded(rows, modes) == Status.COMPLETED


def test_steps_at_rest_do_not_change_peak_rotation_ratio():
    """Each output ends such a step."""
    rows = [[0.2, 0.2, 1.0], [0.11, 0.39, 1.0]]  # of the highest and of a lower body
    rest = {name: np.zeros(2) for name in ("state", "new_state", "slope", "new_slope")}
    place, clock = SimpleNamespace(limits=np.ravel(rows), **rest), np.zeros(at.CLOCK)
    for share in np.linspace(0.01, 0.9, 50):
        clock[at.OTHER_ROTATION_RATIO] = share
        update_peaks(SimpleNamespace(coordinate_count=1), 1, 0.1, clock, place)
        assert clock[at.OTHER_ROTATION_RATIO] == share
