"""Integration of a model under a ground motion, from a start to a trajectory.

Allocates all arrays of a run and calls `advance` (`solve/driver.py`) until the run ends.
"""

import math
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from time import perf_counter, thread_time
from typing import Final

import numpy as np

from rockframe.compiled import (
    COMPILED,
    Integers,
    Matrix,
    Vector,
    after_each_call,
    expecting_remaining,
    python_seconds,
    warn_of_slow_run,
)
from rockframe.dynamics.events import FLIGHT, FULL
from rockframe.dynamics.protocol import (
    IMPACT_LOSS,
    IMPULSIVE_INPUT,
    LINK_LOSS,
    POWERS,
    REPINNING_LOSS,
    ContactModel,
    Ending,
    Start,
)
from rockframe.signals import Motion
from rockframe.solve import workspace as at
from rockframe.solve.accuracy import Accuracy, substeps_of
from rockframe.solve.bookkeeping import ROUNDING
from rockframe.solve.driver import advance
from rockframe.solve.equations import (
    BoundEquations,
    equations_of,
    runs_as_python,
    steps_are_compiled,
)
from rockframe.solve.observe import OutputRows
from rockframe.solve.schemes import STAGES
from rockframe.solve.trajectory import Events, Steps, Trajectory, steps_of, summary_fields
from rockframe.solve.workspace import (
    MAX_TERMS,
    NO_STEPS,
    ROW_CODES,
    ROW_HEADER,
    STATE_ERRORS,
    EventTable,
    Output,
    Pieces,
    Progress,
    Status,
    StepTable,
    Workspace,
    is_full,
    steps_made,
)

INITIAL_SCALE: Final = 1e-6
"""Share of its typical size that counts as a variable's size before it has moved."""
FIRST_STEP: Final = 1e-3
"""First step, as a share of the model's shortest period."""
CHATTER_SHARE: Final = 1e-6
"""Events closer than this share of the model's shortest period count as chatter."""
ENERGY_NOISE: Final = 1e-12
"""Share of the model's typical energy below which energies are rounding noise."""
NEVER: Final = 2**62
"""Number of an interval of the motion beyond the end of any run."""


@dataclass(frozen=True)
class RunStart:
    """A run before its first step."""

    mode: int  # of the model
    state: Vector  # coordinates, their rates, and variables of first order
    memory: Vector  # the system's memory, which changes in the run
    start_memory: Vector  # a copy of it, as it is at the start
    controls: Vector  # laid out in :mod:`rockframe.solve.workspace`
    clock: Vector
    counters: Integers
    reference: Vector  # largest size so far of each variable
    limits: Vector  # of the rotation, :mod:`rockframe.solve.march`
    tolerance: Vector  # rounding noise of the guards
    substeps: int  # fixed steps in each interval, 0 for steps by tolerance


def run_start(
    model: ContactModel,
    start: Start | Ending,
    accuracy: Accuracy,
    *,
    interval: float,
    duration: float,
    output_step: float | None,
    stop_at_overturning: bool,
) -> RunStart:
    """Return the arrays of a run as they are before its first step.

    Arguments as of :func:`integrate`, and the `interval` between samples of the motion [s].
    """
    if isinstance(start, Start):
        mode, state, memory = model.initial(start)
    else:
        mode, state, memory = start.mode, start.state.copy(), start.memory.copy()
        # each run counts its own losses
        memory[[IMPACT_LOSS, REPINNING_LOSS, IMPULSIVE_INPUT, LINK_LOSS]] = 0.0
    contact = model.system.contact_state_of(mode, 0)
    shortest_period = 2.0 * math.pi / model.fastest_frequency
    substeps = substeps_of(accuracy, model, interval)
    # each number may stand for many cases: collected first, then made an array
    controls = {
        at.RTOL: accuracy.rtol or at.FIXED_STEPS,
        at.FLOOR: accuracy.floor,
        at.MAX_STEP: (
            interval / substeps if substeps else shortest_period / accuracy.steps_per_period
        ),
        at.DURATION: duration,
        at.TIME_STEP: interval,
        at.OUTPUT_STEP: output_step or 1.0,
        at.CHATTER_TIME: CHATTER_SHARE * shortest_period,
    }
    rotation = model.rotation_in(state)
    noise = ENERGY_NOISE * model.energy_scale
    clock = {
        at.NEXT_STEP: controls[at.MAX_STEP] if substeps else FIRST_STEP * shortest_period,
        at.PEAK_LEFT: max(-rotation, 0.0),
        at.PEAK_RIGHT: max(rotation, 0.0),
        at.OTHER_ROTATION_RATIO: model.other_share_in(state),
        at.FIRST_UPLIFT: math.nan if contact == FULL else 0.0,
        at.OVERTURNING_TIME: math.nan,
        at.EVENT_TIME: -1.0,
        at.START_ENERGY: math.nan,
        at.GROUND_X: math.nan,
        at.GROUND_Y: math.nan,
        at.LARGEST_TERM: noise,
        at.LARGEST_ENERGY: noise,
    }
    counters = np.zeros(at.COUNTERS, dtype=np.int64)
    counters[at.MODE] = mode
    counters[at.PENDING] = -1
    counters[at.STALE] = 1
    counters[at.LAST_INTERVAL] = NEVER
    counters[at.MAX_STEPS] = counters[at.PAUSE_AT] = accuracy.max_steps
    counters[at.STOP_AT_OVERTURNING] = int(stop_at_overturning)
    counters[at.FLIGHTS] = int(contact == FLIGHT)
    return RunStart(
        mode, state, memory, memory.copy(), _filled(at.CONTROLS, controls),
        _filled(at.CLOCK, clock), counters,
        reference=_sizes(model, accuracy, state, rotation),
        limits=np.array([*model.rotation_limits, *model.rotation_weights, *model.other_limits]),
        tolerance=np.append(model.guard_tolerance, ROUNDING),
        substeps=substeps,
    )  # fmt: skip


def _filled(size: int, numbers: Mapping[int, float]) -> Vector:
    """Return an array with numbers at some places, and zeros elsewhere."""
    return np.array([numbers.get(place, 0.0) for place in range(size)])


def _sizes(model: ContactModel, accuracy: Accuracy, state: Vector, rotation: float) -> Vector:
    sizes: Vector = np.maximum(np.abs(state), INITIAL_SCALE * model.scales)
    if model.rounding is not None and accuracy.rtol is not None and accuracy.floor > 0.0:
        # no step is so short that its error is below the rounding error of the forces
        noise = model.rounding(abs(rotation))
        sizes = np.maximum(sizes, noise / (accuracy.rtol * accuracy.floor))
    return sizes


EVENT_ROWS = 256
STEP_ROWS = 1024
STEPS_PER_INTERVAL = 3.0
"""Steps for which memory is allocated, more than most runs need: unwritten memory costs nothing."""
MAX_STEPS_KEPT = 2_000_000
"""Most rows of the table of steps, some hundred megabytes: then it grows no more."""
STEPS_BETWEEN_INTERRUPTS = 2_000_000
"""Steps of machine code, a second or less, between checks for a keyboard interrupt."""
SECONDS_CALLING_BACK = 0.25
"""Time between checks whether functions in plain Python have been, or pay to be, compiled [s]."""
STEPS_IN_PYTHON = 100
"""Steps in plain Python between checks whether machine code is ready."""
ESTIMATED_AFTER = 0.1
"""Time in plain Python after which the remaining time of the run is estimated [s]."""
WITH_HISTORIES_AND_CHECK = 2.0
"""Time of a run of fixed steps with its histories and the run that checks it with half as many
steps more, over the time of the run itself. Measured for blocks on one another: 1.9.
"""
STILL_INTERVAL = 0.01
"""Interval that takes the place of the sample interval where there is no motion [s]."""


def _steps_to_pause(equations: BoundEquations) -> int:
    """Return how many steps are made before the run pauses."""
    return STEPS_BETWEEN_INTERRUPTS if steps_are_compiled(equations) else STEPS_IN_PYTHON


@contextmanager
def pausing_in_python(counters: Integers) -> Generator[None]:
    """Let the run in this block pause after some time if it calls functions in plain Python.

    One event of many bodies may take as long there as thousands of steps. It makes at least a step.
    """
    until, made = perf_counter() + SECONDS_CALLING_BACK, steps_made(counters)

    def pause_when_due() -> None:
        if perf_counter() >= until and steps_made(counters) > made:
            counters[at.PAUSE_AT] = 0

    with after_each_call(pause_when_due):
        yield


class PythonTime:
    """Time of a run in plain Python, or in steps that stand in for others not yet compiled."""

    def __init__(self, duration: float, interval: float, total_over_rest: float) -> None:
        self.seconds = 0.0  # so far [s]
        self._rest = 0.0  # what it may still take [s]
        self._duration, self._interval = duration, interval
        self._total_over_rest = total_over_rest  # the rest and what follows, over the rest

    @contextmanager
    def measured(self, equations: BoundEquations, clock: Vector) -> Generator[None]:
        """Count what some steps take, and estimate the rest from how far they come."""
        was_compiled, started_as_python = steps_are_compiled(equations), python_seconds()
        started = thread_time()
        with expecting_remaining(self._rest):
            yield
        self._rest = 0.0
        self.seconds += python_seconds() - started_as_python
        if was_compiled:  # and nothing was compiled in this time
            if equations.march.fallback_for is not None:
                replaced = equations.march.fallback_for.source
                replaced.fallback_seconds += thread_time() - started
        elif not steps_are_compiled(equations) and self.seconds > ESTIMATED_AFTER:
            parts = self._duration / max(float(clock[at.TIME]), self._interval)
            self._rest = self.seconds * (parts - 1.0) * self._total_over_rest


class Tables:
    """Tables of events and, in a number of intervals of the motion, of steps, which grow."""

    def __init__(
        self, run: RunStart, model: ContactModel, intervals: float | None, *, exact: bool
    ) -> None:
        self._width, self._exact = len(run.state), exact
        self.events = EventTable(
            np.empty((EVENT_ROWS, 1 + 2 * self._width + len(run.memory))),
            np.empty((EVENT_ROWS, 3), dtype=np.int64),
        )
        self.steps = NO_STEPS
        self._closed: Steps | None = None
        if intervals is not None:
            expected = STEPS_PER_INTERVAL * intervals * max(run.substeps, 1)
            rows = STEP_ROWS + math.ceil(min(expected, MAX_STEPS_KEPT))
            row_length = ROW_HEADER + 2 * self._width - model.system.coordinates()
            self.steps = StepTable(
                np.empty(rows * row_length), np.empty(rows * ROW_CODES, dtype=np.int64)
            )

    def enlarge(self, counters: Integers) -> bool:
        """Make tables longer that are full; whether they could, all steps being kept."""
        if counters[at.EVENTS] >= len(self.events.codes):
            self.events = EventTable(*_doubled(*self.events))
        if not is_full(self.steps.codes, counters):
            return True
        grows = bool(counters[at.STEPS_KEPT] < MAX_STEPS_KEPT)
        if grows:
            self.steps = StepTable(*_doubled(*self.steps))
        return grows

    def close(self, counters: Integers, *, complete: bool = True) -> Steps:
        """Return the steps, and keep no more; say whether they are those of the whole run."""
        if self._closed is None:
            steps = steps_of(self.steps, counters, self._width, exact=self._exact)
            self._closed, self.steps = replace(steps, complete=complete), NO_STEPS
        return self._closed

    def events_so_far(self, counters: Integers) -> Events:
        """Return the events by their columns."""
        count, width = int(counters[at.EVENTS]), self._width
        values, codes = self.events.values[:count], self.events.codes[:count]
        return Events(
            time=values[:, 0].copy(),
            kind=codes[:, 0].copy(),
            mode_before=codes[:, 1].copy(),
            mode_after=codes[:, 2].copy(),
            state_before=values[:, 1 : 1 + width].copy(),
            state_after=values[:, 1 + width : 1 + 2 * width].copy(),
            memory=values[:, 1 + 2 * width :].copy(),
        )


def _doubled(values: Matrix, codes: Integers) -> tuple[Matrix, Integers]:
    """Return the arrays of a table, twice as long."""
    return (
        np.concatenate([values, np.empty_like(values)]),
        np.concatenate([codes, np.empty_like(codes)]),
    )


def integrate(
    model: ContactModel,
    start: Start | Ending,
    motion: Motion | None,
    accuracy: Accuracy,
    *,
    duration: float,
    output_step: float | None,
    stop_at_overturning: bool = True,
    with_work: bool = False,
    keep_steps: bool = False,
) -> Trajectory:
    """Integrate a model under a ground motion; the status says whether the run was finished.

    It starts anew, or where another run of the model ended. `duration` and the `output_step` of
    the samples are in seconds; None stores no samples. Works of dashpots and ground are stored
    `with_work`, and the ends of steps with `keep_steps`: of very many only the first ones.
    """
    run = run_start(
        model, start, accuracy, interval=STILL_INTERVAL if motion is None else motion.time_step,
        duration=duration, output_step=output_step, stop_at_overturning=stop_at_overturning,
    )  # fmt: skip
    memory, clock, counters = run.memory, run.clock, run.counters
    interval, exact = float(run.controls[at.TIME_STEP]), accuracy.rtol is not None
    pieces = pieces_of(motion)
    rows = OutputRows(
        run.mode, run.state, counters,
        duration=duration, output_step=output_step, with_work=with_work,
    )  # fmt: skip
    if keep_steps:
        rows.expect_in_steps(pieces, interval)
    tables = Tables(run, model, duration / interval if keep_steps else None, exact=exact)
    equations = equations_of(model.system, fixed_steps=not exact, with_work=with_work)
    workspace = make_workspace(equations, run.state, run.reference, run.limits)
    progress = Progress(run.controls, clock, counters)
    python_time = PythonTime(duration, interval, 1.0 if exact else WITH_HISTORIES_AND_CHECK)
    while True:
        pause_at = steps_made(counters) + _steps_to_pause(equations)
        counters[at.PAUSE_AT] = min(pause_at, counters[at.MAX_STEPS])
        with python_time.measured(equations, clock), pausing_in_python(counters):
            result = advance(
                equations, run.tolerance, memory, pieces, progress,
                Output(rows.state, rows.mode, rows.work, tables.steps), tables.events, workspace,
            )  # fmt: skip
        if result not in (at.TABLE_FULL, at.PAUSED):
            break
        if not tables.enlarge(counters):
            rows.read_from_steps(tables.close(counters, complete=False))
    if not COMPILED or not runs_as_python(equations):  # else a warning has been given already
        warn_of_slow_run(python_time.seconds)
    steps = tables.close(counters) if keep_steps else None
    if steps is not None:
        rows.read_from_steps(steps)
    events = tables.events_so_far(counters)
    time = rows.end(events, clock, workspace.state, finished=result == at.COMPLETED)
    return Trajectory(
        time=time,
        stored_state=rows.state,
        mode=rows.mode,
        work=rows.work,
        start_memory=run.start_memory,
        events=events,
        status=Status(result),
        **summary_fields(clock, counters),
        substeps=run.substeps,
        ending=Ending(int(counters[at.MODE]), workspace.state.copy(), memory.copy()),
        as_python=runs_as_python(equations),
        steps=steps,
        outputs_in_steps=rows.in_steps,
    )


def make_workspace(
    equations: BoundEquations, state: Vector, reference: Vector, limits: Vector
) -> Workspace:
    """Allocate the arrays of steps, with a state as the start of the first one."""
    size = equations.coordinate_count
    slope = size + equations.variable_count + POWERS
    guards = 2 * (equations.guard_count + 1)
    parts = [len(state), len(state) + slope, len(state) + slope + guards]
    ends = np.zeros(2 * parts[-1])
    start, end = ends[: parts[-1]], ends[parts[-1] :]
    start[: parts[0]] = state
    return Workspace(
        ends=ends,
        state=start[: parts[0]],
        slope=start[parts[0] : parts[1]],
        guards=start[parts[1] :],
        new_state=end[: parts[0]],
        new_slope=end[parts[0] : parts[1]],
        new_guards=end[parts[1] :],
        stages=np.zeros(STAGES * (size + slope)),
        works=np.zeros(STATE_ERRORS + len(state)),
        reference=reference,
        limits=limits,
        inner_state=state.copy(),
        inner_slope=np.zeros(slope),
        inner_guards=np.zeros(guards),
        inner_powers=np.zeros(slope),
        ground=np.zeros(2 * MAX_TERMS),
        scratch=np.zeros(4),
    )


def pieces_of(motion: Motion | None) -> Pieces:
    """Return the polynomials of the ground acceleration in both directions."""
    if motion is None:
        return Pieces(_NO_PIECES, _NO_PIECES)
    vertical = _NO_PIECES if motion.vertical is None else motion.vertical.pieces
    return Pieces(motion.horizontal.pieces, vertical)


_NO_PIECES: Matrix = np.zeros((0, 2))
_NO_PIECES.setflags(write=False)
