"""Integration of many runs of one kind of system in lanes, the counterpart of integrate.py above.

Puts each run into a row, makes batches of rows, and reads the outcomes from the rows.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from rockframe.case_arrays import CaseArray
from rockframe.compiled import LANES, Matrix, bind_in_lanes, compiled_within
from rockframe.compiled.bound import elements_of, structure_of
from rockframe.dynamics.protocol import ContactModel, Ending
from rockframe.signals import Motion
from rockframe.solve import workspace as at
from rockframe.solve.equations import BoundEquations, equations_of
from rockframe.solve.integrate import EVENT_ROWS, RunStart, make_workspace, pieces_of
from rockframe.solve.lanes import fields
from rockframe.solve.lanes.batch import Batch, BatchSizes, advance_batch
from rockframe.solve.lanes.fields import FieldIndices, field_indices
from rockframe.solve.lanes.steps import steps_in_lanes
from rockframe.solve.trajectory import Summary, summary_fields
from rockframe.solve.workspace import NO_STEPS, EventTable, Output, Pieces, Status, Workspace

MAX_COEFFICIENTS: Final = 4_000_000
"""Most coefficients of ground motions in a batch, so that they stay in a processor's caches."""

IntegerArray = NDArray[np.int64]


@dataclass(frozen=True)
class LaneRun:
    """A run to make under one or more motions; or many runs of systems that differ in numbers."""

    model: ContactModel  # the equations; those of one of many runs
    start: RunStart  # its start, without outputs; in one batch steps are all fixed, or all are not
    # the row of each of many runs; None for a single run, whose row is made from the above
    rows: Matrix | None = None


@dataclass(frozen=True)
class Outcomes:
    """How runs ended: arrays with a row, or a number, for each run."""

    clock: Matrix  # laid out in :mod:`rockframe.solve.workspace`
    counters: IntegerArray  # likewise
    status: IntegerArray  # :class:`rockframe.solve.workspace.Status`
    modes: IntegerArray  # modes of the model in which they ended
    states: Matrix  # states at the end
    memories: Matrix  # memories at the end

    def summary(self, k: int, substeps: int) -> Summary:
        """Return the summary of run `k`, made in steps by tolerance (0 substeps) or fixed steps."""
        ending = Ending(int(self.modes[k]), self.states[k].copy(), self.memories[k].copy())
        return Summary(
            status=Status(int(self.status[k])),
            substeps=substeps,
            ending=ending,
            **summary_fields(self.clock[k], self.counters[k]),
        )

    def summary_of_many(self, some: IntegerArray, substeps: int) -> Summary:
        """Return one summary of runs that ended in the same way, whose numbers are `CaseArray`."""

        def each(rows: Any) -> Any:
            return np.array(
                [CaseArray(row[some].astype(np.float64)) for row in rows.T], dtype=object
            )

        mode = int(self.modes[some[0]])
        return Summary(
            status=Status(int(self.status[some[0]])),
            substeps=substeps,
            ending=Ending(mode, each(self.states), each(self.memories)),
            **summary_fields(each(self.clock), each(self.counters)),
        )


def join_outcomes(several: Sequence[Outcomes]) -> Outcomes:
    """Join outcomes, one below the other."""
    columns = [vars(outcomes).values() for outcomes in several]
    return Outcomes(*(np.concatenate(column) for column in zip(*columns, strict=True)))


def batch_key(model: ContactModel) -> Any:
    """Return a key that is equal for models that can run side by side."""
    return structure_of(model.system), len(model.memory)


def can_run_in_lanes(run: LaneRun, patience: float) -> bool:
    """Whether runs of the kind of `run` can be made in lanes.

    Compiles what they need if that takes at most `patience` [s]. There are no lanes in plain
    Python.
    """
    rows, first = _Rows([run]), np.zeros(1, dtype=np.int64)
    return compiled_within(patience, advance_batch, rows.batch([None], first, first), rows.steps)


def integrate_lanes(
    runs: Sequence[LaneRun],
    motions: Sequence[Motion | None],
    run_of: IntegerArray,
    motion_of: IntegerArray,
) -> Outcomes:
    """Make many runs of systems of one kind.

    Case i is run `run_of[i]`, counted over all rows of `runs`, under motion `motion_of[i]`.
    """
    made, outcomes = _Rows(runs), list[Outcomes]()
    for some in _batches(motions, motion_of):
        used, place = np.unique(motion_of[some], return_inverse=True)
        batch = made.batch([motions[k] for k in used.tolist()], run_of[some], place)
        advance_batch(batch, made.steps)
        outcomes.append(made.outcomes(batch.rows.reshape(len(place), -1)))
    return join_outcomes(outcomes)


def _batches(motions: Sequence[Motion | None], motion_of: IntegerArray) -> list[slice]:
    """Divide cases into batches whose motions fit into the caches."""
    sizes = np.array(
        [0 if motion is None else motion.horizontal.samples.size * 2 for motion in motions]
    )
    batches: list[slice] = []
    begin, seen, total = 0, set[int](), 0
    for case, k in enumerate(motion_of.tolist()):
        if k not in seen and total + sizes[k] > MAX_COEFFICIENTS and case > begin:
            batches.append(slice(begin, case))
            begin, seen, total = case, set(), 0
        if k not in seen:
            seen.add(k)
            total += int(sizes[k])
    return [*batches, slice(begin, len(motion_of))]


def initial_rows(model: ContactModel, start: RunStart, count: int = 1) -> Matrix:
    """Return the row of a run, or the rows of many runs, whose numbers are :class:`CaseArray`."""
    indices, numbers = field_indices(model.system), list(elements_of(model.system))
    memory = indices.numbers + len(numbers)
    tolerance = memory + len(start.memory)
    rows = np.zeros((count, tolerance + len(start.tolerance)))
    integers = rows.view(np.int64)
    for first, row in (
        (fields.CLOCK, start.clock),
        (fields.CONTROLS, start.controls),
        (fields.LIMITS, start.limits),
        (indices.reference, start.reference),
        (indices.state, start.state),
        (indices.numbers, numbers),
        (memory, start.memory),
        (tolerance, start.tolerance),
    ):
        for place, number in enumerate(row, start=first):
            rows[:, place] = number.values if isinstance(number, CaseArray) else number
    integers[:, fields.COUNTERS : fields.COUNTERS + at.COUNTERS] = start.counters
    integers[:, fields.OWN_INTEGERS + fields.BUSY] = 1
    return rows


class _Rows:
    """Rows of runs, which are copied for each of their cases."""

    def __init__(self, runs: Sequence[LaneRun]) -> None:
        model, first = runs[0].model, runs[0].start
        self._indices = field_indices(model.system)
        fixed = first.substeps > 0
        self._equations = equations_of(model.system, fixed_steps=fixed)
        self.steps = bind_in_lanes(steps_in_lanes(model.system, fixed_steps=fixed), model.system)
        self._count = len(self._equations.numbers)
        self._memory = len(first.memory)
        self._rows = np.concatenate([
            initial_rows(run.model, run.start) if run.rows is None else run.rows for run in runs
        ])  # fmt: skip

    def outcomes(self, rows: Matrix) -> Outcomes:
        """Return how runs ended, from their rows, whose memory can be freed then."""
        indices, behind = self._indices, self._indices.numbers + self._count
        integers = rows.view(np.int64)
        counters = integers[:, fields.COUNTERS : fields.COUNTERS + at.COUNTERS]
        return Outcomes(
            clock=rows[:, fields.CLOCK : fields.CLOCK + at.CLOCK].copy(),
            counters=counters.copy(),
            status=integers[:, fields.OWN_INTEGERS + fields.STATUS].copy(),
            modes=counters[:, at.MODE].copy(),
            states=rows[:, indices.state : indices.slope].copy(),
            memories=rows[:, behind : behind + self._memory].copy(),
        )

    def batch(
        self, motions: Sequence[Motion | None], run_of: IntegerArray, motion_of: IntegerArray
    ) -> Batch:
        """Return the batch of some cases: their rows, and all else that `advance_batch` needs."""
        rows = self._rows[run_of]
        own = rows.view(np.int64)[:, fields.OWN_INTEGERS : fields.OWN_INTEGERS + fields.INTEGERS]
        both = [pieces_of(motion) for motion in motions]
        x, own[:, fields.FIRST_X], own[:, fields.COUNT_X] = _stacked(
            [pieces.x for pieces in both], motion_of
        )
        y, own[:, fields.FIRST_Y], own[:, fields.COUNT_Y] = _stacked(
            [pieces.y for pieces in both], motion_of
        )
        indices = self._indices
        shape = BatchSizes(
            rows=len(rows), width=rows.shape[1], state=indices.state,
            half=indices.new_state - indices.state, numbers=indices.numbers,
            number_count=self._count, memory=self._memory,
        )  # fmt: skip
        return Batch(
            shape, rows.reshape(-1), np.zeros((indices.numbers + self._count) * LANES),
            np.zeros(LANES + 1, dtype=np.int64), Pieces(x, y), self._equations,
            *_scratch(self._equations, indices, self._memory),
        )  # fmt: skip


def _scratch(
    equations: BoundEquations, indices: FieldIndices, memory: int
) -> tuple[Output, EventTable, Workspace]:
    """Return scratch for a single run: no outputs, events that are not kept, a step."""
    width = indices.slope - indices.state
    output = Output(np.empty((0, width)), np.empty(0, dtype=np.int64), np.empty((0, 2)), NO_STEPS)
    events = EventTable(
        np.empty((EVENT_ROWS, 1 + 2 * width + memory)), np.empty((EVENT_ROWS, 3), dtype=np.int64)
    )
    none = np.zeros(width)
    workspace = make_workspace(
        equations, none, none.copy(), np.zeros(indices.reference - fields.LIMITS)
    )
    return output, events, workspace


def _stacked(
    pieces: Sequence[Matrix], motion_of: IntegerArray
) -> tuple[Matrix, IntegerArray, IntegerArray]:
    """Join polynomials of motions, one below the other; give first row and count of each case."""
    terms = max(polynomials.shape[1] for polynomials in pieces)
    counts = np.array([len(polynomials) for polynomials in pieces], dtype=np.int64)
    # -0 + x is x, whatever the sign of x
    stacked = np.full((int(counts.sum()), terms), -0.0)
    first = np.concatenate([[0], np.cumsum(counts)])[:-1]
    for begin, polynomials in zip(first.tolist(), pieces, strict=True):
        stacked[begin : begin + len(polynomials), : polynomials.shape[1]] = polynomials
    stacked.setflags(write=False)
    return stacked, first[motion_of], counts[motion_of]
