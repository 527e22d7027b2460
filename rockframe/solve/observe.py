"""States at the output times of a run, and columns from states: of samples, events and steps."""

import math
from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

import numpy as np

from rockframe.compiled import (
    BoundFunction,
    IntegerMatrix,
    Integers,
    Matrix,
    Vector,
    background_entry,
    bind,
    kernel,
    numbers_in,
)
from rockframe.dynamics.protocol import POWERS, Column, ContactModel, Equations
from rockframe.solve import workspace as at
from rockframe.solve.bookkeeping import ROUNDING, SAMPLE_TOLERANCE
from rockframe.solve.equations import evaluate_columns, evaluate_energies
from rockframe.solve.evaluation import evaluate_slope
from rockframe.solve.trajectory import Events, Steps, Trajectory
from rockframe.solve.workspace import ROW_HEADER, Pieces

MANY_ROWS: Final = 500
"""Number of rows without slopes from which compiling the slope pays."""
NO_SAMPLES: Final = np.zeros(0, dtype=np.int64)
NO_COLUMNS: Final = np.zeros((0, 0))


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

    def expect_in_steps(self, pieces: Pieces, interval: float) -> None:
        """Leave out what the table of steps will hold: output times that are samples.

        With works, which it does not hold, their rows are filled, too.
        """
        if len(self.mode):
            self._expected = self._count_on_samples(max(map(len, pieces)), interval)
            if not len(self.work):
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
        if count <= self._expected and not len(self.work):  # the run ended before
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


class RowWorkspace(NamedTuple):
    """Scratch for one row."""

    state: Vector
    slope: Vector
    memory: Vector
    columns: Vector


@kernel
def copy_row(rows: Matrix, i: int, out: Vector) -> None:
    """Copy a row of a matrix."""
    for j in range(len(out)):
        out[j] = rows[i, j]


class SystemFunction(NamedTuple):
    """A function of a system, and the system's numbers."""

    function: BoundFunction
    numbers: Vector


def _system_function(
    system: Equations, function: Callable[..., None], *, rarely_called: bool = False
) -> SystemFunction:
    (bound,) = bind((function,), system, rarely_called=rarely_called)
    return SystemFunction(bound, numbers_in(system))


@background_entry
def observe_rows(
    slope_function: SystemFunction,
    column_function: SystemFunction,
    exact: int,
    values: Matrix,
    codes: IntegerMatrix,
    memory: Matrix,
    requested: Integers,
    samples: Integers,
    workspace: RowWorkspace,
    out: Matrix,
    at_samples: Matrix,
) -> None:
    """Fill the columns `requested` of `out` for each row of the table of steps.

    Slopes are taken from the table if they are `exact`, else evaluated. For the rows `samples`,
    all columns are filled in `at_samples` as well, from its second place on.
    """
    sample = 0
    width, slopes = len(workspace.state), values.shape[1] - ROW_HEADER - len(workspace.state)
    for i in range(len(codes)):
        for j in range(width):
            workspace.state[j] = values[i, ROW_HEADER + j]
        mode, x, y = codes[i, 0], values[i, 2], values[i, 3]
        if exact:
            for j in range(slopes):
                workspace.slope[j] = values[i, ROW_HEADER + width + j]
        else:
            slope_function.function.call(
                mode, workspace.state, x, y, workspace.slope, slope_function.numbers
            )
        copy_row(memory, codes[i, 1], workspace.memory)
        column_function.function.call(
            mode,
            workspace.state,
            workspace.slope,
            x,
            y,
            workspace.memory,
            workspace.columns,
            column_function.numbers,
        )
        for j in range(len(requested)):
            out[j, i] = workspace.columns[requested[j]]
        if sample < len(samples) and samples[sample] == i:
            sample += 1
            for j in range(len(workspace.columns)):
                at_samples[j, sample] = workspace.columns[j]


@background_entry
def energy_rows(
    energy_function: SystemFunction,
    mode: Integers,
    state: Matrix,
    row: Vector,
    energies: Vector,
    out: Matrix,
) -> None:
    """Fill a row of energies for each row of states; `row` and `energies` are scratch."""
    for i in range(len(mode)):
        copy_row(state, i, row)
        energy_function.function.call(mode[i], row, energies, energy_function.numbers)
        for j in range(len(energies)):
            out[i, j] = energies[j]


def memory_at_outputs(trajectory: Trajectory) -> tuple[Matrix, Integers]:
    """Return the memories of a run, and for each output time the number of the one that is valid.

    At the time of an event it is the memory before the event; at the start of the run, the one
    after all events at the start.
    """
    events = trajectory.events
    memory = np.vstack([trajectory.start_memory, events.memory])
    # search the few events among the many times, not the other way round
    behind = np.searchsorted(trajectory.time, events.time, side="right")
    behind[events.time == 0.0] = 0
    counts = np.diff(behind, prepend=0, append=len(trajectory.time))
    return memory, np.repeat(np.arange(len(memory)), counts)


def observe_states(
    model: ContactModel,
    mode: Integers,
    state: Matrix,
    memory: Matrix,
    memory_row: Integers,
    ground: Matrix,
) -> dict[str, Vector]:
    """Return the model's columns by their names for any states, one in each row of `state`.

    `memory_row` is the row of `memory` that belongs to each state, `ground` the horizontal and
    vertical ground acceleration, shape (states, 2) [m s^-2].
    """
    return _named(model, model.columns, _rows(model, mode, state, memory, memory_row, ground))


def _rows(
    model: ContactModel,
    mode: Integers,
    state: Matrix,
    memory: Matrix,
    memory_row: Integers,
    ground: Matrix,
) -> Matrix:
    out = np.empty((len(model.columns), len(mode)))
    place = np.zeros((len(mode), ROW_HEADER))
    place[:, 2:] = ground
    _observe(
        model, np.hstack([place, state]), np.stack([mode, memory_row], 1).astype(np.int64), memory,
        np.arange(len(out)), out,
    )  # fmt: skip
    return out


def _observe(
    model: ContactModel, values: Matrix, codes: IntegerMatrix, memory: Matrix, requested: Integers,
    out: Matrix, exact: bool = False, samples: Integers = NO_SAMPLES,
    at_samples: Matrix = NO_COLUMNS,
) -> None:  # fmt: skip
    system = model.system
    slope_function = _system_function(
        system, evaluate_slope, rarely_called=exact or len(codes) < MANY_ROWS
    )
    size, slopes = system.coordinates(), system.coordinates() + system.variables()
    sizes = size + slopes, slopes + POWERS, memory.shape[1], len(model.columns)
    observe_rows(
        slope_function, _system_function(system, evaluate_columns), int(exact), values, codes,
        memory, requested, samples, RowWorkspace(*map(np.zeros, sizes)), out, at_samples,
    )  # fmt: skip


def observe_run(
    model: ContactModel, run: Trajectory, names: tuple[str, ...] | None, ground: Matrix
) -> tuple[dict[str, Vector], dict[str, Vector]]:
    """Return some columns along the steps of a run, and all columns at its samples and events.

    The first are those of `names`, or all for None, at the rows of the table of steps. The others
    are at the output times, then before all events, then after them; so is `ground`, the horizontal
    and vertical ground acceleration, shape (samples + 2 events, 2) [m s^-2].
    """
    steps, events, in_steps = run.kept_steps, run.events, run.outputs_in_steps
    memory, row = memory_at_outputs(run)
    before, samples = np.arange(len(events.time)), np.arange(len(run.time))
    not_in_steps = np.delete(samples, slice(1, 1 + len(in_steps)))
    places = np.concatenate([not_in_steps, np.arange(len(samples), len(ground))])
    at_samples = np.empty((len(model.columns), len(ground)))
    at_samples[:, places] = _rows(
        model,
        np.concatenate([run.mode[not_in_steps], events.mode_before, events.mode_after]),
        np.concatenate([run.stored_state[not_in_steps], events.state_before, events.state_after]),
        memory,
        np.concatenate([row[not_in_steps], before, before + 1]),
        ground[places],
    )
    chosen = [i for i, column in enumerate(model.columns) if names is None or column.name in names]
    out = np.empty((len(chosen), len(steps.time)))
    _observe(
        model, steps.values, steps.codes, memory, np.array(chosen, dtype=np.int64), out,
        steps.exact, in_steps, at_samples,
    )  # fmt: skip
    along = _named(model, [model.columns[i] for i in chosen], out)
    return along, _named(model, model.columns, at_samples)


def _named(model: ContactModel, columns: Sequence[Column], out: Matrix) -> dict[str, Vector]:
    """Return columns by their names, in the units of the schema: multiplied by masses."""
    named: dict[str, Vector] = {}
    for column, values in zip(columns, out, strict=True):
        if column.per_mass:
            values *= model.mass * column.mass_ratio
        named[column.name] = values
    return named


def energies_of(model: ContactModel, trajectory: Trajectory) -> Matrix:
    """Return kinetic, gravity, elastic energy, and elastic less at rest, by columns [m^2 s^-2]."""
    out = np.empty((len(trajectory.time), 4))
    energy_rows(
        _system_function(model.system, evaluate_energies),
        trajectory.mode,
        np.ascontiguousarray(trajectory.state),
        np.zeros(trajectory.state.shape[1]),
        np.zeros(4),
        out,
    )
    return out
