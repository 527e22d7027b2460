"""From states to the quantities a model can be observed by."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from rockframe.compiled import (
    Bound,
    Codes,
    Integers,
    Matrix,
    Vector,
    bound,
    entry,
    kernel,
    numbers_in,
)
from rockframe.dynamics.protocol import ContactModel, System
from rockframe.solve.equations import energies, observed
from rockframe.solve.trajectory import Trajectory


class Room(NamedTuple):
    """Room for one row."""

    state: Vector
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


def _of(system: System, function: Callable[..., None]) -> OfSystem:
    return OfSystem(bound((function,), system)[0], numbers_in(system))


@entry
def observe_rows(
    observing: OfSystem,
    mode: Integers,
    state: Matrix,
    memory: Matrix,
    memory_row: Integers,
    ground: Matrix,
    room: Room,
    out: Matrix,
) -> None:
    """Fill a row of columns for each row of states."""
    for i in range(len(mode)):
        copy_row(state, i, room.state)
        copy_row(memory, memory_row[i], room.memory)
        observing.function.call(
            mode[i], room.state, ground[i, 0], ground[i, 1], room.memory, room.columns,
            observing.numbers,
        )  # fmt: skip
        for j in range(len(room.columns)):
            out[i, j] = room.columns[j]


@entry
def energy_rows(
    storing: OfSystem, mode: Integers, state: Matrix, row: Vector, stored: Vector, out: Matrix
) -> None:
    """Fill a row of energies for each row of states; `row` and `stored` are room for one."""
    for i in range(len(mode)):
        copy_row(state, i, row)
        storing.function.call(mode[i], row, stored, storing.numbers)
        for j in range(len(stored)):
            out[i, j] = stored[j]


def memory_at_outputs(trajectory: Trajectory) -> tuple[Matrix, Integers]:
    """Give the memories of a run, and which of them holds at each output time.

    Returns
    -------
    memory : ndarray, shape (events + 1, memory)
        At the start and after each event.
    row : ndarray of int64, shape (samples,)
        An output sample at the time of an event shows the state before it.
    """
    memory = np.vstack([trajectory.start_memory, trajectory.events.memory])
    row = np.searchsorted(trajectory.events.time, trajectory.time, side="left")
    return memory, row.astype(np.int64)


def observe_states(
    model: ContactModel,
    mode: Codes | Integers,
    state: Matrix,
    memory: Matrix,
    memory_row: Integers,
    ground: Matrix,
) -> dict[str, Vector]:
    """Give the model's columns for any states.

    Parameters
    ----------
    model : ContactModel
        The equations.
    mode : ndarray of int, shape (states,)
        Modes of the model.
    state : ndarray, shape (states, 2 n + variables)
        As the system has them.
    memory : ndarray, shape (memories, memory)
        Memories of the system.
    memory_row : ndarray of int, shape (states,)
        Which of them holds for each state.
    ground : ndarray, shape (states, 2)
        Horizontal and vertical ground acceleration [m s^-2].

    Returns
    -------
    dict of str to ndarray
        By the names in ``model.columns``.
    """
    out = np.empty((len(mode), len(model.columns)))
    sizes = state.shape[1], memory.shape[1], out.shape[1]
    room = Room(*(np.zeros(size) for size in sizes))
    observe_rows(
        _of(model.system, observed),
        mode.astype(np.int64),
        np.ascontiguousarray(state),
        memory,
        memory_row.astype(np.int64),
        ground,
        room,
        out,
    )
    return {
        column.name: out[:, i] * (model.mass * column.mass_ratio if column.per_mass else 1.0)
        for i, column in enumerate(model.columns)
    }


def energies_of(model: ContactModel, trajectory: Trajectory) -> Matrix:
    """Give kinetic, gravity and elastic energy, and elastic less that at rest.

    Returns
    -------
    ndarray, shape (samples, 4)
        Per unit mass [m^2 s^-2].
    """
    out = np.empty((len(trajectory.time), 4))
    energy_rows(
        _of(model.system, energies),
        trajectory.mode.astype(np.int64),
        np.ascontiguousarray(trajectory.state),
        np.zeros(trajectory.state.shape[1]),
        np.zeros(4),
        out,
    )
    return out
