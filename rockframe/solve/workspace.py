"""The arrays of a run, in named tuples: what the integrator reads, works on and fills."""

from typing import NamedTuple

import numpy as np

from rockframe.compiled import (
    Codes,
    FrozenMatrix,
    FrozenVector,
    IntegerMatrix,
    Integers,
    Matrix,
    Vector,
)
from rockframe.solve.dormand_prince_tableau import STAGES
from rockframe.solve.ground import TERMS


class Tables(NamedTuple):
    """A model's tables, see :class:`rockframe.dynamics.protocol.ContactModel`."""

    active: Integers
    contact: Integers
    longest: Vector
    tolerance: Vector
    weights: Vector


class MotionTables(NamedTuple):
    """Ground motion: samples, and polynomials in between where it has them."""

    samples_x: FrozenVector
    samples_y: FrozenVector
    pieces_x: FrozenMatrix
    pieces_y: FrozenMatrix


class Progress(NamedTuple):
    """Settings and progress, laid out in :mod:`rockframe.solve.layout`."""

    controls: Vector
    clock: Vector
    counters: Integers


class Output(NamedTuple):
    """Samples at the output times; `work` may have no rows."""

    state: Matrix
    mode: Codes
    work: Matrix


class EventTable(NamedTuple):
    """Events: time, states before and after and memory; kind and modes."""

    values: Matrix
    codes: IntegerMatrix


class Workspace(NamedTuple):
    """Arrays of one step."""

    state: Vector  # at its start
    new: Vector  # at its end
    reference: Vector  # largest size so far of each variable
    stage: Vector
    slope: Vector  # accelerations and powers of the stage at hand
    error: Vector
    slopes: Matrix  # accelerations and powers of all stages
    speeds: Matrix  # rates of all stages
    before: Vector  # guards and their rates at the start
    after: Vector  # at the end
    inside: Vector  # and in between
    scratch: Vector  # state and accelerations in between
    scratch_rates: Vector
    powers: Vector  # accelerations and powers in between
    ground: Vector  # coefficients of the ground motion in this interval
    energies: Vector


class Span(NamedTuple):
    """One step: its length, and where it lies in its interval of the motion."""

    h: float
    u: float
    du: float
    degree_x: int
    degree_y: int


def make_workspace(state: Vector, reference: Vector, guards: int) -> Workspace:
    """Allocate the arrays beside the state and the reference sizes of a run.

    Parameters
    ----------
    state, reference : ndarray, shape (2 n,)
        State vector, changed in place; largest size so far of each variable.
    guards : int
        Number of guards.

    Returns
    -------
    Workspace
    """
    width = len(state)
    size = width // 2
    return Workspace(
        state=state,
        new=state.copy(),
        reference=reference,
        stage=np.zeros(width),
        slope=np.zeros(size + 2),
        error=np.zeros(width),
        slopes=np.zeros((STAGES, size + 2)),
        speeds=np.zeros((STAGES, size)),
        before=np.zeros(2 * guards),
        after=np.zeros(2 * guards),
        inside=np.zeros(2 * guards),
        scratch=np.zeros(width),
        scratch_rates=np.zeros(size),
        powers=np.zeros(size + 2),
        ground=np.zeros(2 * TERMS),
        energies=np.zeros(4),
    )
