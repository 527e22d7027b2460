"""From a model, a start and a ground motion to a trajectory."""

import math
from time import perf_counter

import numpy as np

from rockframe.compiled import COMPILED, Integers, Matrix, Vector, say_slow
from rockframe.dynamics.protocol import POWERS, ContactModel, Ending, Start
from rockframe.signals import Motion
from rockframe.solve import layout as at
from rockframe.solve.accuracy import Accuracy
from rockframe.solve.beginning import begun
from rockframe.solve.bookkeeping import ON_SAMPLE
from rockframe.solve.dormand_prince import STAGES
from rockframe.solve.driver import advance
from rockframe.solve.equations import BoundEquations, equations_of, has_machine_code, runs_as_python
from rockframe.solve.layout import Status
from rockframe.solve.trajectory import Events, Trajectory, run_counts, steps_of
from rockframe.solve.workspace import (
    BESIDE,
    CODES,
    ERRORS,
    TERMS,
    EventTable,
    Output,
    Pieces,
    Progress,
    StepTable,
    Workspace,
    has_no_room,
    no_steps,
)

EVENT_ROOM = 256
STEP_ROOM = 1024
STEPS_PER_INTERVAL = 3.0
"""Room for steps, more than most runs need: memory that is not written to costs nothing."""
STEPS_AT_ONCE = 500
"""Steps in plain Python, after which it is seen whether there is machine code by now."""
STILL_INTERVAL = 0.01
"""Interval into which time is cut where the ground has no samples [s]."""


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
    """Integrate a model under a ground motion.

    Parameters
    ----------
    model : ContactModel
        The equations.
    start : Start or Ending
        Where the run starts, or another run of the same model ended.
    motion : Motion or None
        Of the ground, which stands still beyond its last sample, or all the time.
    accuracy : Accuracy
        Settings.
    duration : float
        Length of the run [s].
    output_step : float or None
        Spacing of the output samples; None stores none [s].
    stop_at_overturning : bool
        Whether the run ends when the rotation reaches its limit.
    with_work : bool
        Whether dashpot and input work are stored at the output times.
    keep_steps : bool
        Whether both ends of all steps are kept.

    Returns
    -------
    Trajectory
        Also where the run could not be finished; see its status.
    """
    run = begun(
        model, start, accuracy, interval=STILL_INTERVAL if motion is None else motion.time_step,
        duration=duration, output_step=output_step, stop_at_overturning=stop_at_overturning,
    )  # fmt: skip
    mode, state, memory = run.mode, run.state, run.memory
    clock, counters = run.clock, run.counters
    rows = 0 if output_step is None else 1 + math.floor(duration / output_step * (1.0 + 1e-12))
    width = len(state)
    out_state = np.empty((rows, width))
    out_mode = np.empty(rows, dtype=np.int64)
    out_work = np.zeros((rows if with_work else 0, 2))
    if rows:
        out_state[0], out_mode[0] = state, mode
        counters[at.OUTPUTS] = 1

    progress = Progress(run.controls, clock, counters)
    steps = no_steps()
    if keep_steps:
        intervals = duration / run.controls[at.TIME_STEP]
        room = STEP_ROOM + math.ceil(STEPS_PER_INTERVAL * intervals * max(run.substeps, 1))
        row = BESIDE + 2 * width - model.system.coordinates()
        steps = StepTable(np.empty(room * row), np.empty(room * CODES, dtype=np.int64))
    events = EventTable(
        np.empty((EVENT_ROOM, 1 + 2 * width + len(memory))),
        np.empty((EVENT_ROOM, 3), dtype=np.int64),
    )
    pieces = pieces_of(motion)
    equations = equations_of(model.system, fixed_steps=accuracy.rtol is None)
    workspace = make_workspace(equations, state, run.reference, run.limits)
    as_python = 0.0  # time that it took in plain Python
    while True:
        began = perf_counter()
        counters[at.PAUSE_AT] = counters[at.MAX_STEPS]
        if not has_machine_code(equations):
            tried = counters[at.STEPS] + counters[at.REJECTED]
            counters[at.PAUSE_AT] = min(tried + STEPS_AT_ONCE, counters[at.MAX_STEPS])
        result = advance(
            equations,
            run.tolerance,
            memory,
            pieces,
            progress,
            Output(out_state, out_mode, out_work, steps),
            events,
            workspace,
        )
        if not has_machine_code(equations):
            as_python += perf_counter() - began
        if result not in (at.MORE_ROOM, at.PAUSED):
            break
        if counters[at.EVENTS] >= len(events.codes):
            events = EventTable(*_longer(*events))
        if has_no_room(steps.codes, counters):
            steps = StepTable(*_longer(*steps))

    if not COMPILED or not runs_as_python(equations):  # of which more has been said
        say_slow(as_python)

    stored = int(counters[at.OUTPUTS])
    time: Vector = np.arange(stored, dtype=np.float64) * (output_step or 1.0)
    end = float(clock[at.TIME])
    out_state, out_mode, out_work = out_state[:stored], out_mode[:stored], out_work[:stored]
    unfinished = result != at.COMPLETED
    if rows and unfinished and end - time[-1] > ON_SAMPLE * (output_step or 1.0):
        # the instant at which the run ended belongs to its history
        time = np.concatenate([time, np.array([end])])
        out_state = np.vstack([out_state, workspace.state])
        out_mode = np.append(out_mode, counters[at.MODE])
        if with_work:
            out_work = np.vstack([out_work, [clock[at.DISSIPATED], clock[at.SUPPLIED]]])
    return Trajectory(
        time=time,
        state=out_state,
        mode=out_mode,
        work=out_work,
        start_mode=mode,
        start_memory=run.start_memory,
        events=_events(events, int(counters[at.EVENTS]), width),
        status=Status(result),
        **run_counts(clock, counters),
        substeps=run.substeps,
        ending=Ending(int(counters[at.MODE]), workspace.state.copy(), memory.copy()),
        start_energy=float(clock[at.START_ENERGY]),
        as_python=runs_as_python(equations),
        steps=steps_of(steps, int(counters[at.STEPS_KEPT]), width, exact=accuracy.rtol is not None)
        if keep_steps
        else None,
    )


def make_workspace(
    equations: BoundEquations, state: Vector, reference: Vector, limits: Vector
) -> Workspace:
    """Allocate the arrays beside those that a run begins with."""
    size = equations.coordinate_count
    slope = size + equations.variable_count + POWERS
    guards = 2 * (equations.guard_count + 1)
    parts = [len(state), len(state) + slope, len(state) + slope + guards]
    ends = np.zeros(2 * parts[-1])
    start, end = ends[: parts[-1]], ends[parts[-1] :]
    start[: parts[0]] = state
    return Workspace(
        both_ends=ends,
        state=start[: parts[0]],
        first=start[parts[0] : parts[1]],
        before=start[parts[1] :],
        new=end[: parts[0]],
        last=end[parts[0] : parts[1]],
        after=end[parts[1] :],
        stages=np.zeros(STAGES * (size + slope)),
        works=np.zeros(ERRORS + len(state)),
        reference=reference,
        limits=limits,
        scratch=state.copy(),
        scratch_rates=np.zeros(slope),
        inside=np.zeros(guards),
        powers=np.zeros(slope),
        ground=np.zeros(2 * TERMS),
        answers=np.zeros(4),
    )


def _longer(values: Matrix, codes: Integers) -> tuple[Matrix, Integers]:
    """Give the arrays of a table with as much room again."""
    return (
        np.concatenate([values, np.empty_like(values)]),
        np.concatenate([codes, np.empty_like(codes)]),
    )


def pieces_of(motion: Motion | None) -> Pieces:
    """Give the polynomials of both directions."""
    if motion is None:
        return Pieces(_STILL, _STILL)
    vertical = _STILL if motion.vertical is None else _read_only(motion.vertical.pieces)
    return Pieces(_read_only(motion.horizontal.pieces), vertical)


def _read_only(array: Matrix) -> Matrix:
    view = array.view()
    view.flags.writeable = False
    return view


def _events(table: EventTable, count: int, width: int) -> Events:
    values, codes = table.values[:count], table.codes[:count]
    return Events(
        time=values[:, 0].copy(),
        kind=codes[:, 0].copy(),
        mode_before=codes[:, 1].copy(),
        mode_after=codes[:, 2].copy(),
        state_before=values[:, 1 : 1 + width].copy(),
        state_after=values[:, 1 + width : 1 + 2 * width].copy(),
        memory=values[:, 1 + 2 * width :].copy(),
    )


_STILL: Matrix = _read_only(np.zeros((0, 2)))
