"""What a run shows at its output times: states, modes and work, stored or read from its steps."""

import math

import numpy as np

from rockframe.compiled import Integers, Matrix, Vector
from rockframe.solve import workspace as at
from rockframe.solve.bookkeeping import ROUNDING, SAMPLE_TOLERANCE
from rockframe.solve.trajectory import Events, Steps
from rockframe.solve.workspace import Output, Pieces, StepTable


class OutputRows:
    """Rows of state, mode and work, one for each output time; none without an output step [s]."""

    def __init__(
        self, mode: int, state: Vector, counters: Integers, *,
        duration: float, output_step: float | None, with_work: bool,
    ) -> None:  # fmt: skip
        rows = 0 if output_step is None else 1 + math.floor(duration / output_step * (1.0 + 1e-12))
        self.step = output_step or 1.0
        self.state: Matrix = np.empty((rows, len(state)))
        self.mode: Integers = np.empty(rows, dtype=np.int64)
        self.work: Matrix = np.zeros((rows if with_work else 0, 2))
        self.in_steps: Integers = np.empty(0, dtype=np.int64)
        """Rows of the table of steps that hold the states of the first output times."""
        self._expected = 0  # output times at which steps end
        self._counters = counters
        if rows:
            self.state[0], self.mode[0] = state, mode
            counters[at.OUTPUTS] = 1

    def output(self, steps: StepTable) -> Output:
        """Return the arrays that the steps fill."""
        return Output(self.state, self.mode, self.work, steps)

    def expect_in_steps(self, pieces: Pieces, interval: float) -> None:
        """Leave out what the table of steps will hold: output times that are samples."""
        if len(self.mode):
            self._expected = self._count_on_samples(max(map(len, pieces)), interval)
            self._counters[at.OUTPUTS] += self._expected

    def _count_on_samples(self, intervals: int, interval: float) -> int:
        """Count the output times behind the start that are samples of the motion."""
        intervals_per_output = round(self.step / interval)
        if intervals_per_output < 1:
            return 0
        count = min(len(self.mode) - 1, intervals // intervals_per_output)
        last = count * self.step
        difference = abs(last - count * intervals_per_output * interval) + ROUNDING * last
        return count if difference <= 0.5 * SAMPLE_TOLERANCE * self.step else 0

    def read_from_steps(self, steps: Steps) -> None:
        """Find the expected output times that the run reached in its steps, and their modes."""
        if not self._expected:
            return
        # the first row at, or just before, each multiple of the output step
        reached = np.floor(steps.time / self.step + SAMPLE_TOLERANCE)
        self.in_steps = 1 + np.flatnonzero(reached[1:] > reached[:-1])[: self._expected]
        count = 1 + len(self.in_steps)
        self.mode[1:count] = steps.mode[self.in_steps]
        if count <= self._expected:  # the run ended before
            self._counters[at.OUTPUTS] = count
        self._expected = 0

    def end(self, events: Events, clock: Vector, state: Vector, *, finished: bool) -> Vector:
        """Return the output times [s], and drop the rows behind the end of the run.

        The history of an unfinished run includes the instant at which it ended.
        """
        stored = int(self._counters[at.OUTPUTS])
        self.state, self.mode = self.state[:stored], self.mode[:stored]
        self.work = self.work[:stored]
        time: Vector = np.arange(stored, dtype=np.float64) * self.step
        at_start = int(np.count_nonzero(events.time == 0.0))
        if stored and at_start:  # the first sample shows the state after the events at the start
            self.state[0] = events.state_after[at_start - 1]
            self.mode[0] = events.mode_after[at_start - 1]
        end = float(clock[at.TIME])
        if stored and not finished and end - time[-1] > SAMPLE_TOLERANCE * self.step:
            time = np.append(time, end)
            self.state = np.vstack([self.state, state])
            self.mode = np.append(self.mode, self._counters[at.MODE])
            if len(self.work):
                self.work = np.vstack([self.work, clock[[at.DISSIPATED, at.SUPPLIED]]])
        return time
