"""The result of an integration: plain arrays, in SI units and per unit mass.

Also the steps of a run as they were made, and the dense solution inside them.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Final, cast

import numpy as np

from rockframe.case_arrays import isnan, maximum
from rockframe.compiled import Integers, Matrix, Vector
from rockframe.dynamics.protocol import ContactModel, Ending
from rockframe.solve import workspace as at
from rockframe.solve.crossings import cubic_value_and_rate, quintic_coefficients
from rockframe.solve.workspace import ROW_CODES, ROW_HEADER, Status, StepTable

_quintic_coefficients: Final = cast(
    "Callable[..., tuple[Matrix, ...]]", quintic_coefficients
)  # of arrays too
_cubic_value_and_rate: Final = cast("Callable[..., tuple[Matrix, ...]]", cubic_value_and_rate)


@dataclass(frozen=True)
class Steps:
    """Table of steps: a row for the end of each, and for each start that is not an end."""

    # rows of :class:`rockframe.solve.workspace.StepTable`; the last one is no start
    values: Matrix
    codes: Integers
    width: int  # numbers in a state
    # whether slopes are those of the equations at the states; those of fixed steps are only near
    exact: bool
    complete: bool = True  # whether they continue to the end of the run

    # columns of these: time of each row, and length of the step that ends there, 0 in the row of a
    # start [s]; mode of the model; number of events before, which is the row of its memory; ground
    # acceleration as the equations take it, shape (rows, 2) [m s^-2]; state; accelerations, and
    # rates of variables of first order
    time: Vector = field(init=False)
    length: Vector = field(init=False)
    mode: Integers = field(init=False)
    memory_row: Integers = field(init=False)
    ground: Matrix = field(init=False)
    state: Matrix = field(init=False)
    slope: Matrix = field(init=False)

    def __post_init__(self) -> None:
        values, codes, end = self.values, self.codes, ROW_HEADER + self.width
        vars(self).update(
            time=values[:, 0], length=values[:, 1], ground=values[:, 2:ROW_HEADER],
            state=values[:, ROW_HEADER:end], slope=values[:, end:],
            mode=codes[:, 0], memory_row=codes[:, 1],
        )  # fmt: skip

    def until(self, time: float) -> "Steps":
        """Return the steps that end up to a time [s]."""
        count = int(np.searchsorted(self.time, time, side="right"))
        if count and self.length[count - 1] == 0.0:  # a start without its step
            count -= 1
        return replace(self, values=self.values[:count], codes=self.codes[:count])

    def states_inside(self, which: Integers, model: ContactModel, fraction: Vector) -> Matrix:
        """Return states inside steps by their dense solution, :eq:`eq-hermite`."""
        size, u = model.system.coordinates(), fraction[:, None]
        h = self.length[which, None, None]
        state, new, first, last = (
            values[row, None] for values in (self.state, self.slope) for row in (which - 1, which)
        )
        x, v, w = (slice(0, size), slice(size, 2 * size), slice(2 * size, None))
        rates = slice(size, None)
        c0, c1, c2, c3, c4, c5 = _quintic_coefficients(
            state[..., x], h * state[..., v], h * h * first[..., x],
            new[..., x], h * new[..., v], h * h * last[..., x],
        )  # fmt: skip
        coordinate = c0 + u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5))))
        velocity = (c1 + u * (2.0 * c2 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))) / h
        variable, _ = _cubic_value_and_rate(
            state[..., w], h * first[..., rates], new[..., w], h * last[..., rates], u
        )
        moves = np.arange(size) < model.moving(self.mode[which])[:, None, None]
        coordinate = np.where(moves, coordinate, state[..., x])
        return np.concatenate(
            [coordinate, np.where(moves, velocity, state[..., v]), variable], axis=-1
        )


def steps_of(table: StepTable, counters: Integers, width: int, *, exact: bool) -> Steps:
    """Return the steps that a run has kept, whose states have `width` numbers."""
    codes, count = table.codes.reshape(-1, ROW_CODES), int(counters[at.STEPS_KEPT])
    values = table.values.reshape(len(codes), -1)
    return Steps(values[:count], codes[:count], width, exact).until(np.inf)


@dataclass(frozen=True)
class Events:
    """Table of the events of a run."""

    time: Vector  # [s]
    # :class:`rockframe.dynamics.events.EventKind`, or ``SILENT`` for one that results leave out
    kind: Integers
    mode_before: Integers  # modes of the model
    mode_after: Integers
    state_before: Matrix  # coordinates, then their rates
    state_after: Matrix
    memory: Matrix  # the model's memory after each event


@dataclass(frozen=True, kw_only=True)
class Summary:
    """The outcome of a run."""

    status: Status  # how the run ended
    end_time: float  # [s]
    peak_left: float  # largest rotation to the left [rad]
    peak_right: float  # and to the right
    overturning_time: float  # when the overturning angle was reached, NaN if it was not [s]
    overturning_direction: int  # sign of the rotation at overturning, 0 if none
    first_uplift_time: float  # when contact was first lost, NaN if it was not [s]
    flight_time: float  # total time of flight [s]
    impact_count: int
    flight_count: int
    step_count: int
    rejected_count: int  # steps that were refused, their errors being too large
    substeps: int  # fixed steps in each interval of the motion, 0 for steps by tolerance
    energy_residual: float  # largest imbalance of the energies over the largest energy of motion
    ending: Ending  # where the run ended
    # largest ratio of another body's rotation to its overturning angle
    other_rotation_ratio: float = 0.0

    @property
    def peak_rotation(self) -> float:
        """Largest rotation to either side [rad]."""
        return maximum(self.peak_left, self.peak_right)

    @property
    def reached_limit(self) -> bool:
        """Whether the rotation reached the overturning angle."""
        return not isnan(self.overturning_time)

    @property
    def overturned(self) -> bool | None:
        """The verdict, see :attr:`rockframe.solve.workspace.Status.overturned`."""
        return self.status.overturned

    @property
    def verdict_time(self) -> float:
        """When the block overturned by the verdict; NaN if it did not [s]."""
        if self.status is Status.TOPPLED:
            return self.end_time
        return self.overturning_time if self.overturned else math.nan

    @property
    def verdict_direction(self) -> int:
        """Sign of the rotation at the time of the verdict; 0 if the block did not overturn."""
        if self.status is Status.TOPPLED:
            return 1 if self.peak_right > self.peak_left else -1
        return self.overturning_direction if self.overturned else 0


@dataclass(frozen=True, kw_only=True)
class Trajectory(Summary):
    """A run: its histories, events and, if they were kept, its steps."""

    time: Vector  # output times [s]
    # states at these, except those that `steps` has, see `outputs_in_steps`
    stored_state: Matrix
    mode: Integers  # modes of the model
    work: Matrix  # energies dissipated by dashpots and put in by the ground; no rows unless stored
    start_memory: Vector  # the model's memory at the start
    events: Events  # what happened when
    as_python: bool  # whether its system runs as plain Python for good: it cannot be compiled
    steps: Steps | None  # None if they were not kept
    # rows of `steps` at the second and following output times, if these are ends of steps
    outputs_in_steps: Integers

    @cached_property
    def state(self) -> Matrix:
        """Coordinates, then their rates, at the output times, shape (times, 2 n + variables)."""
        count = len(self.outputs_in_steps)
        if count:
            self.stored_state[1 : 1 + count] = self.kept_steps.state[self.outputs_in_steps]
        return self.stored_state

    @property
    def kept_steps(self) -> Steps:
        """The steps of the run; raises ValueError if they were not kept."""
        if self.steps is None:
            msg = "no steps were kept"
            raise ValueError(msg)
        return self.steps


def summary_fields(clock: Vector, counters: Integers) -> dict[str, Any]:
    """Return the fields of a summary that follow from the progress of a finished run."""
    reals, integers = clock.tolist(), counters.tolist()
    energy, residual = reals[at.LARGEST_ENERGY], reals[at.RESIDUAL]
    return {
        "end_time": reals[at.TIME],
        "peak_left": reals[at.PEAK_LEFT],
        "peak_right": reals[at.PEAK_RIGHT],
        "other_rotation_ratio": reals[at.OTHER_ROTATION_RATIO],
        "overturning_time": reals[at.OVERTURNING_TIME],
        "overturning_direction": int(reals[at.OVERTURNING_SIDE]),
        "first_uplift_time": reals[at.FIRST_UPLIFT],
        "flight_time": reals[at.FLIGHT_TIME],
        "impact_count": integers[at.IMPACTS],
        "flight_count": integers[at.FLIGHTS],
        "step_count": integers[at.STEPS],
        "rejected_count": integers[at.REJECTED],
        "energy_residual": residual / energy if energy > 0.0 else 0.0,
    }
