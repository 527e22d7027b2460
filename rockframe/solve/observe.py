"""From states to the quantities a model can be observed by."""

from collections.abc import Callable

import numpy as np

from rockframe.compiled import Integers, Matrix, Vector, entry
from rockframe.dynamics.protocol import ENERGY, OBSERVE, ContactModel
from rockframe.solve.trajectory import Trajectory


@entry("none", OBSERVE, "integers", "matrix", "matrix", "integers", "matrix", "vector", "matrix")
def _observe_rows(
    observe: Callable[..., None],
    mode: Integers,
    state: Matrix,
    memory: Matrix,
    memory_row: Integers,
    ground: Matrix,
    p: Vector,
    out: Matrix,
) -> None:
    for i in range(len(mode)):
        observe(mode[i], state[i], memory[memory_row[i]], ground[i, 0], ground[i, 1], p, out[i])


@entry("none", ENERGY, "integers", "matrix", "vector", "matrix")
def _energy_rows(
    energy: Callable[..., None], mode: Integers, state: Matrix, p: Vector, out: Matrix
) -> None:
    for i in range(len(mode)):
        energy(mode[i], state[i], p, out[i])


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


def observe_trajectory(
    model: ContactModel, trajectory: Trajectory, ground: Matrix
) -> dict[str, Vector]:
    """Give the model's columns at the output times.

    Parameters
    ----------
    model : ContactModel
        The equations.
    trajectory : Trajectory
        A run of the model.
    ground : ndarray, shape (samples, 2)
        Horizontal and vertical ground acceleration at the output times [m s^-2].

    Returns
    -------
    dict of str to ndarray
        By the names in ``model.columns``; forces per unit mass.
    """
    out = np.empty((len(trajectory.time), len(model.columns)))
    memory, row = memory_at_outputs(trajectory)
    _observe_rows(
        model.observe,
        trajectory.mode.astype(np.int64),
        np.ascontiguousarray(trajectory.state),
        memory,
        row,
        ground,
        model.parameters,
        out,
    )
    return {name: np.ascontiguousarray(out[:, i]) for i, name in enumerate(model.columns)}


def energies_of(model: ContactModel, trajectory: Trajectory) -> Matrix:
    """Give kinetic, gravity and elastic energy, and elastic less that at rest.

    Returns
    -------
    ndarray, shape (samples, 4)
        Per unit mass [m^2 s^-2].
    """
    out = np.empty((len(trajectory.time), 4))
    _energy_rows(
        model.energy,
        trajectory.mode.astype(np.int64),
        np.ascontiguousarray(trajectory.state),
        model.parameters,
        out,
    )
    return out
