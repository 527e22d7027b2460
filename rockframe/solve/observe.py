"""Columns of the results from states: of a run's samples, events and steps."""

from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

import numpy as np

from rockframe.compiled import (
    Bound,
    IntegerMatrix,
    Integers,
    Matrix,
    Vector,
    bound,
    entry_at_once,
    kernel,
    numbers_in,
)
from rockframe.dynamics.protocol import POWERS, Column, ContactModel, Equations
from rockframe.solve.equations import energies, observed, slope
from rockframe.solve.trajectory import Trajectory
from rockframe.solve.workspace import BESIDE

MANY: Final = 500
"""Number of rows without slopes from which compiling the slope pays."""
NO_SAMPLES: Final = np.zeros(0, dtype=np.int64)
NO_COLUMNS: Final = np.zeros((0, 0))


class Room(NamedTuple):
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


class OfSystem(NamedTuple):
    """A function of a system, and the system's numbers."""

    function: Bound
    numbers: Vector


def _of(system: Equations, function: Callable[..., None], *, seldom: bool = False) -> OfSystem:
    (one,) = bound((function,), system, seldom=seldom)
    return OfSystem(one, numbers_in(system))


@entry_at_once
def observe_rows(
    sloping: OfSystem,
    observing: OfSystem,
    exact: int,
    values: Matrix,
    codes: IntegerMatrix,
    memory: Matrix,
    wanted: Integers,
    samples: Integers,
    room: Room,
    out: Matrix,
    shown: Matrix,
) -> None:
    """Fill the columns `wanted` of `out` for each row of the table of steps.

    Slopes are taken from the table if they are `exact`, else evaluated. For the rows `samples`,
    all columns are filled in `shown` as well, from its second place on.
    """
    sample = 0
    width, slopes = len(room.state), values.shape[1] - BESIDE - len(room.state)
    for i in range(len(codes)):
        for j in range(width):
            room.state[j] = values[i, BESIDE + j]
        mode, x, y = codes[i, 0], values[i, 2], values[i, 3]
        if exact:
            for j in range(slopes):
                room.slope[j] = values[i, BESIDE + width + j]
        else:
            sloping.function.call(mode, room.state, x, y, room.slope, sloping.numbers)
        copy_row(memory, codes[i, 1], room.memory)
        observing.function.call(
            mode, room.state, room.slope, x, y, room.memory, room.columns, observing.numbers
        )
        for j in range(len(wanted)):
            out[j, i] = room.columns[wanted[j]]
        if sample < len(samples) and samples[sample] == i:
            sample += 1
            for j in range(len(room.columns)):
                shown[j, sample] = room.columns[j]


@entry_at_once
def energy_rows(
    storing: OfSystem, mode: Integers, state: Matrix, row: Vector, stored: Vector, out: Matrix
) -> None:
    """Fill a row of energies for each row of states; `row` and `stored` are scratch."""
    for i in range(len(mode)):
        copy_row(state, i, row)
        storing.function.call(mode[i], row, stored, storing.numbers)
        for j in range(len(stored)):
            out[i, j] = stored[j]


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
    """Return the model's columns for any states.

    Parameters
    ----------
    model : ContactModel
        The equations.
    mode : ndarray of int64, shape (states,)
        Modes of the model.
    state : ndarray, shape (states, 2 n + variables)
        States of the system.
    memory : ndarray, shape (memories, memory)
        Memories of the system.
    memory_row : ndarray of int, shape (states,)
        Row of `memory` that belongs to each state.
    ground : ndarray, shape (states, 2)
        Horizontal and vertical ground acceleration [m s^-2].

    Returns
    -------
    dict of str to ndarray
        By the names in ``model.columns``.
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
    place = np.zeros((len(mode), BESIDE))
    place[:, 2:] = ground
    _observe(
        model, np.hstack([place, state]), np.stack([mode, memory_row], 1).astype(np.int64), memory,
        np.arange(len(out)), out,
    )  # fmt: skip
    return out


def _observe(
    model: ContactModel, values: Matrix, codes: IntegerMatrix, memory: Matrix, wanted: Integers,
    out: Matrix, exact: bool = False, samples: Integers = NO_SAMPLES, shown: Matrix = NO_COLUMNS,
) -> None:  # fmt: skip
    moves = _of(model.system, slope, seldom=exact or len(codes) < MANY)
    observe_rows(
        moves, _of(model.system, observed), int(exact), values, codes, memory, wanted, samples,
        _room(model, memory), out, shown,
    )  # fmt: skip


def observe_run(
    model: ContactModel, run: Trajectory, names: tuple[str, ...] | None, ground: Matrix
) -> tuple[dict[str, Vector], dict[str, Vector]]:
    """Return some columns along the steps of a run, and all columns at its samples and events.

    Parameters
    ----------
    model : ContactModel
        The equations.
    run : Trajectory
        A run that kept its steps.
    names : tuple of str or None
        Columns to give along the steps; None for all.
    ground : ndarray, shape (samples + 2 events, 2)
        Horizontal and vertical ground acceleration at the output times, and twice at the events
        [m s^-2].

    Returns
    -------
    along : dict of str to ndarray, shape (rows,)
        Values at the rows of the table of steps.
    shown : dict of str to ndarray, shape (samples + 2 events,)
        Values at the output times, then before all events, then after all events.

    Raises
    ------
    ValueError
        The run has not kept its steps.
    """
    steps, events, in_steps = run.kept_steps, run.events, run.outputs_in_steps
    memory, row = memory_at_outputs(run)
    before, samples = np.arange(len(events.time)), np.arange(len(run.time))
    apart = np.delete(samples, slice(1, 1 + len(in_steps)))
    places = np.concatenate([apart, np.arange(len(samples), len(ground))])
    shown = np.empty((len(model.columns), len(ground)))
    shown[:, places] = _rows(
        model,
        np.concatenate([run.mode[apart], events.mode_before, events.mode_after]),
        np.concatenate([run.other_state[apart], events.state_before, events.state_after]),
        memory,
        np.concatenate([row[apart], before, before + 1]),
        ground[places],
    )
    chosen = [i for i, one in enumerate(model.columns) if names is None or one.name in names]
    out = np.empty((len(chosen), len(steps.time)))
    _observe(
        model, steps.values, steps.codes, memory, np.array(chosen, dtype=np.int64), out,
        steps.exact, in_steps, shown,
    )  # fmt: skip
    along = _named(model, [model.columns[i] for i in chosen], out)
    return along, _named(model, model.columns, shown)


def _room(model: ContactModel, memory: Matrix) -> Room:
    size, variables = model.system.coordinates(), model.system.variables()
    slopes = size + variables
    sizes = size + slopes, slopes + POWERS, memory.shape[1], len(model.columns)
    return Room(*(np.zeros(size) for size in sizes))


def _named(model: ContactModel, columns: Sequence[Column], out: Matrix) -> dict[str, Vector]:
    """Return columns by their names, in the units of the schema: multiplied by masses."""
    found: dict[str, Vector] = {}
    for column, values in zip(columns, out, strict=True):
        if column.per_mass:
            values *= model.mass * column.mass_ratio
        found[column.name] = values
    return found


def energies_of(model: ContactModel, trajectory: Trajectory) -> Matrix:
    """Return kinetic, gravity and elastic energy, and elastic energy less that at rest.

    Returns
    -------
    ndarray, shape (samples, 4)
        Per unit mass [m^2 s^-2].
    """
    out = np.empty((len(trajectory.time), 4))
    energy_rows(
        _of(model.system, energies),
        trajectory.mode,
        np.ascontiguousarray(trajectory.state),
        np.zeros(trajectory.state.shape[1]),
        np.zeros(4),
        out,
    )
    return out
